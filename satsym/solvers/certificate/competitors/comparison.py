"""What competitors of each kind came to, and what certificates make of that."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from satsym.instance import Instance
from satsym.solution import Check, Competitors, Kind, Solution
from satsym.solvers.certificate.reintegration.flow import products

HIDDEN = 1e-14
"""Share of their size by which states are rounded in the end: costs differ by what that is worth, whatever they are."""

COST_MARGIN = 1e-9
"""Relative margin by which a competitor may seem cheaper: its own error."""

SAME_COST = 1e-9
"""Relative error of refined costs; it makes no difference."""

UNCOMPARED = "no comparison: no competitor was solved"
"""The check that fails where that is so."""

LARGEST_MARGIN = 1e300
"""Beyond this no margin is: one that is infinite has nothing to compare."""


@dataclass(frozen=True, eq=False)
class Compared:
    """What competitors of one kind came to."""

    summary: Competitors
    """As the certificate has it."""
    margin: float
    """Excess of the cheapest, relative to the cost; negative where it is cheaper, infinite without any."""
    interrupted: bool
    """Whether time was up before all were tried."""
    enough: bool = False
    """Whether it says something even where none was solved: controls were drawn, or the motion is linear."""

    @property
    def checks(self) -> list[Check]:
        """Checks that no competitor is cheaper, if one has a cost, and that there was time for all."""
        cheaper = Check(f"cheaper by: {self.summary.kind.value}", max(0.0, -self.margin), COST_MARGIN)
        late = Check(f"not checked within the time limit: {self.summary.kind.value}", 1.0, 0.0)
        return [*([cheaper] if math.isfinite(self.margin) else []), *([late] if self.interrupted else [])]

    def joined(self, other: Compared) -> Compared:
        """This comparison with what others of the kind came to."""
        least = min(self, other, key=lambda one: one.margin)
        count, solved = (getattr(self.summary, name) + getattr(other.summary, name) for name in ("tried", "solved"))
        summary = Competitors(self.summary.kind, count, solved, least.summary.cheapest)
        return Compared(summary, least.margin, self.interrupted or other.interrupted)


@dataclass(frozen=True, eq=False)
class Comparison:
    """All kinds that a problem allows."""

    kinds: tuple[Compared, ...] = ()
    """What was compared, kind by kind."""
    not_checked: tuple[Kind, ...] = ()
    """Kinds that nobody tried, of which nothing was solved, or for which time was up."""
    better: Solution | None = None
    """A cheaper extremal that is exact."""
    proved: tuple[Check, ...] = ()
    """Why there are no others, where that is known."""

    def joined(self, other: Comparison) -> Comparison:
        """This comparison with what another has compared."""
        kinds, missing = self.kinds + other.kinds, self.not_checked + other.not_checked
        return Comparison(kinds, missing, self.better or other.better, self.proved + other.proved)

    @property
    def checks(self) -> list[Check]:
        """Checks of all kinds, and that any competitor has a cost: else a solution was compared with nothing."""
        none = not any(kind.summary.solved or kind.interrupted or kind.enough for kind in self.kinds)
        found = [*self.proved, *(check for kind in self.kinds for check in kind.checks)]
        return [*found, Check(UNCOMPARED, 1.0, 0.0)] if self.kinds and none else found


def going_round(instance: Instance) -> list[Kind]:
    """Revolutions, where the uncontrolled motion looks the same when it is turned: then other numbers may do."""
    from satsym.solvers.symmetry import symmetric

    return [Kind.REVOLUTIONS] if symmetric(instance) else []


def summed(
    solution: Solution, kind: Kind, count: int, costs: Sequence[float], interrupted: bool, coarse: float = SAME_COST
) -> Compared:
    """What so many attempts at a kind came to, of which some have costs.

    Parameters
    ----------
    coarse
        Relative difference of costs that is none.
    """
    cheapest = min(costs, default=float("nan"))
    excess = margin(cheapest, solution.objective, coarse=coarse, hidden=hidden(solution))
    return Compared(Competitors(kind, count, len(costs), cheapest), excess, interrupted)


def hidden(solution: Solution) -> float:
    """The difference of costs that rounding hides."""
    return HIDDEN * products(solution)


def margin(competitor: float, cost: float, coarse: float = 0.0, hidden: float = 0.0) -> float:
    """Excess of a competitor, relative to the cost.

    Differences below ``coarse``, or of costs below ``hidden``, are its own error.
    """
    if not np.isfinite(competitor):
        return float("inf")
    margin = float(np.clip((competitor - cost) / max(abs(cost), 1e-300), -LARGEST_MARGIN, LARGEST_MARGIN))
    return 0.0 if abs(margin) < coarse or abs(competitor - cost) < hidden else margin
