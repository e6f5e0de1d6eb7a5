"""The record of a proof, as plain data."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from satsym.status import BadInput


class Outcome(str, Enum):
    """The outcome of an attempt to prove."""

    PROVED = "proved"
    NOT_PROVED = "not proved"
    BEYOND = "beyond this proof"


@dataclass(frozen=True)
class Enclosure:
    """A number and the largest distance of the exact one from it, both as decimals."""

    centre: str
    radius: str

    @classmethod
    def of(cls, ball: Any, digits: int) -> Enclosure:
        """Return a ball with the wanted number of digits; the rounding error is part of the radius.

        Parameters
        ----------
        ball
            An ``arb``.
        """
        from flint import arb

        middle = "0" if abs(ball.mid()) <= ball.rad() else ball.mid().str(digits, radius=False)
        distance = abs(ball - arb(middle)).abs_upper()
        return cls(middle, _rounded_up(distance))

    @property
    def text(self) -> str:
        """Write the number and its radius for people."""
        return f"{self.centre} +/- {self.radius}"


def _rounded_up(distance: Any) -> str:
    """Return a decimal of two digits that is not smaller than a distance."""
    from flint import arb

    if distance == 0:
        return "0"
    found = (distance * arb("1.06")).mid().str(2, radius=False)
    while not arb(found).abs_lower() >= distance:
        distance = distance * 2
        found = distance.mid().str(2, radius=False)
    return str(found)


@dataclass(frozen=True)
class Theorem:
    """The theorem that follows from the hypotheses.

    Attributes
    ----------
    name, source
        What it is called, and where it stands.
    claims
        What is claimed of this problem, a sentence each.
    """

    name: str
    source: str
    claims: tuple[str, ...]


@dataclass(frozen=True)
class Hypothesis:
    """One of the hypotheses of a theorem.

    Attributes
    ----------
    name
        What must hold.
    shown
        How it was shown.
    value
        The number that says so, as text.
    """

    name: str
    shown: str
    value: str


@dataclass(frozen=True)
class Node:
    """States and costates at a time."""

    t: Enclosure
    x: dict[str, Enclosure]
    costates: dict[str, Enclosure]


@dataclass(frozen=True)
class Proof:
    """An attempt to prove that an answer is an optimum.

    Attributes
    ----------
    model, instance, status, reason
        What was proved, and where it ended: which step fails or which feature is not covered; empty where it is proved.
    theorem, hypotheses
        ``None`` and those that were shown so far, where it is not proved.
    costate_initial, x_final, t_final, objective, switching_times
        Enclosures; empty or ``None`` where there is no extremal.
    nodes
        Along the extremal.
    scope
        In words: which problem, and among which motions it is best.
    numbers
        The numbers of the problem as they were read, by name.
    unique_within
        How far from the located one, relative to the sizes, there is no other extremal of this structure.
    digits, wall_s
        How many digits were asked for, and how many seconds the proof took.
    """

    model: str
    instance: str
    status: Outcome
    reason: str = ""
    theorem: Theorem | None = None
    hypotheses: tuple[Hypothesis, ...] = ()
    costate_initial: dict[str, Enclosure] = field(default_factory=dict)
    nodes: tuple[Node, ...] = ()
    x_final: dict[str, Enclosure] = field(default_factory=dict)
    t_final: Enclosure | None = None
    objective: Enclosure | None = None
    switching_times: tuple[Enclosure, ...] = ()
    scope: str = ""
    numbers: dict[str, str] = field(default_factory=dict)
    unique_within: float | None = None
    digits: int = 20
    wall_s: float = 0.0

    def to_dict(self) -> dict[str, Any]:
        """Return the object that ``satsym prove --json`` prints."""

        def one(v: Enclosure | None) -> dict[str, str] | None:
            return None if v is None else {"centre": v.centre, "radius": v.radius}

        def row(values: dict[str, Enclosure]) -> dict[str, Any]:
            return {name: one(v) for name, v in values.items()}

        theorem = self.theorem and {
            "name": self.theorem.name,
            "source": self.theorem.source,
            "claims": list(self.theorem.claims),
        }
        return {
            "status": self.status.value,
            "reason": self.reason,
            "theorem": theorem,
            "hypotheses": [{"name": h.name, "shown": h.shown, "value": h.value} for h in self.hypotheses],
            "costate_initial": row(self.costate_initial),
            "nodes": [{"t": one(v.t), "x": row(v.x), "costates": row(v.costates)} for v in self.nodes],
            "x_final": row(self.x_final),
            "t_final": one(self.t_final),
            "objective": one(self.objective),
            "switching_times": [one(v) for v in self.switching_times],
            "scope": self.scope,
            "numbers": self.numbers,
            "unique_within": self.unique_within,
            "digits": self.digits,
            "wall_s": self.wall_s,
        }


FEWEST_DIGITS, MOST_DIGITS = 6, 60


def check_digits(digits: int) -> None:
    """Refuse a number of digits that is not supported.

    Raises
    ------
    BadInput
        With those that are.
    """
    if not FEWEST_DIGITS <= digits <= MOST_DIGITS:
        raise BadInput(f"digits: got {digits}; give a whole number from {FEWEST_DIGITS} to {MOST_DIGITS}")
