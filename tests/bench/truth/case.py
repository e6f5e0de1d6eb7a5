"""One random instance as plain data: what satsym reads as text, and what the independent side reads as numbers."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

POLAR_UNITS = {
    "r": (1, 0),
    "r_dot": (1, -1),
    "theta": (0, 0),
    "theta_dot": (0, -1),
    "u1": (1, -2),
    "u2": (1, -2),
    "sigma": (1, 0),
    "omega": (0, -1),
    "c0": (2, -4),
    "c1": (0, 0),
    "c2": (0, 0),
    "k1": (0, -3),
    "k2": (0, -1),
    "k3": (2, -3),
    "k4": (2, -1),
}
"""Powers of length and time in the unit of each quantity of the orbits in polar coordinates."""
POLAR_COST = (2, -3)

OWN = ("chain", "oscillator", "rendezvous", "transfer", "bump", "conjugate", "end", "kept")
"""How the names of models begin that are derived from ``models/``."""


@dataclass(frozen=True)
class Case:
    """An instance of a class.

    Parameters
    ----------
    family, number
        Class, and which of its instances; both together seed the generator.
    model
        Name of the model, shipped or in ``models/``.
    initial, final
        By state; final states left out are free, ``"reference"`` stands for the model's reference.
    tf
        ``None`` where it is free.
    bounds, max_norm
        Of the controls; infinite ones are written as such.
    free_angles
        Final angles that count modulo a turn.
    length, time
        Units that satsym is given the numbers in; here they are those of the reference orbit. Polar orbits only.
    """

    family: str
    number: int
    model: str
    initial: Mapping[str, float]
    final: Mapping[str, float | Literal["reference"]] = field(default_factory=dict)
    tf: float | None = None
    t0: float = 0.0
    parameters: Mapping[str, float] = field(default_factory=dict)
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    max_norm: float | None = None
    free_angles: tuple[str, ...] = ()
    length: float = 1.0
    time: float = 1.0

    @classmethod
    def of(cls, fields: Mapping[str, Any]) -> Case:
        """From what JSON makes of its fields."""
        pairs = {name: tuple(pair) for name, pair in fields["bounds"].items()}
        return cls(**{**fields, "bounds": pairs, "free_angles": tuple(fields["free_angles"])})

    @property
    def key(self) -> str:
        """What names it in records."""
        return f"{self.family}:{self.number}"

    @property
    def cost_unit(self) -> float:
        """What one of the costs here is in the units satsym is given."""
        return self.length ** POLAR_COST[0] * self.time ** POLAR_COST[1]

    def unit(self, name: str) -> float:
        """The same of a named quantity."""
        if self.length == self.time == 1.0:
            return 1.0
        a, b = POLAR_UNITS[name]
        return float(self.length**a * self.time**b)

    def text(self, own: bool, seconds: float | None = None) -> str:
        """The instance file, perhaps with a time limit; ``own`` models lie in a folder ``models`` beside it."""
        lines = [f'model = "{"models/" if own else ""}{self.model}"']
        for section in ("parameters", "initial", "final"):
            values: Mapping[str, Any] = getattr(self, section)
            if values:
                lines += ["", f"[{section}]", *(f"{k} = {self._written(k, v)}" for k, v in values.items())]
        end = '"free"' if self.tf is None else repr(self.tf * self.time)
        lines += ["", "[time]", f"t0 = {self.t0 * self.time!r}", f"tf = {end}"]
        if self.bounds or self.max_norm is not None:
            lines += ["", "[control]"]
            lines += [f"{k} = [{', '.join(repr(v * self.unit(k)) for v in pair)}]" for k, pair in self.bounds.items()]
        if self.max_norm is not None:
            lines.append(f"max_norm = {self.max_norm * self.unit('u1')!r}")
        options = [f"free_angles = {json.dumps(self.free_angles)}"] if self.free_angles else []
        options += [] if seconds is None else [f"max_seconds = {seconds!r}"]
        if options:
            lines += ["", "[solver]", *options]
        return "\n".join(lines) + "\n"

    def _written(self, name: str, value: float | str) -> str:
        return json.dumps(value) if isinstance(value, str) else repr(float(value) * self.unit(name))
