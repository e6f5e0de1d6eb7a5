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
        Name of the theorem, and the publication that contains it.
    claims
        Sentences that state what follows for this problem.
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
        Statement of the hypothesis.
    shown
        Method by which it was shown.
    value
        Figures that support it, as text.
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
        Names of the model and the instance, the outcome, and the reason why nothing is proved: the step that fails, or
        the feature that is not covered.
    theorem, hypotheses
        The theorem, ``None`` if nothing is proved, and the hypotheses that were shown.
    costate_initial, x_final, t_final, objective, switching_times
        Enclosures; empty or ``None`` where there is no extremal.
    nodes
        States and costates at some times along the extremal.
    scope
        Sentences that state the problem, and the motions among which the extremal is the best.
    numbers
        The numbers of the problem as they were read, by name.
    unique_within
        Distance from the extremal, relative to the sizes of its components, within which there is no other extremal of
        this structure.
    digits, wall_s
        The number of digits that was requested, and the seconds that the proof took.
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
