"""Costs of the competitors of each kind, and the checks that certificates derive from these costs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from satsym.instance import Instance
from satsym.solution import Check, Competitors, Kind, Solution
from satsym.solvers.certificate.reintegration.flow import products

HIDDEN = 1e-14
"""Relative rounding error of the final states. Differences of costs that such an error explains count as zero."""

COST_MARGIN = 1e-9
"""Relative amount by which a competitor may be cheaper without refuting the solution: the error of its own cost."""

SAME_COST = 1e-9
"""Relative error of refined costs. Costs that differ by less count as equal."""

FEWEST_STARTS, SAME_MOTION = 10, 1e-4
"""Number of starts below which nothing is estimated from their costs; relative difference of costs, some of them from
coarse meshes, up to which two motions count as the same."""

UNCOMPARED = "no comparison: no competitor was solved"
"""Name of the check that fails if no competitor was solved."""

LARGEST_MARGIN = 1e300
"""Magnitude to which finite margins are clipped. Larger, infinite margins mean that there is nothing to compare."""


@dataclass(frozen=True, eq=False)
class Compared:
    """Comparison of a solution with the competitors of one kind."""

    summary: Competitors
    """Counts and cheapest cost, in the form that the certificate reports."""
    margin: float
    """Excess cost of the cheapest competitor relative to the cost of the solution. Negative if it is cheaper than the
    solution, infinite if no competitor has a cost."""
    interrupted: bool
    """Whether the time limit was reached before all competitors were tried."""
    enough: bool = False
    """Whether the comparison is conclusive even if no competitor was solved: controls were drawn, or the motion is
    linear."""

    @property
    def checks(self) -> list[Check]:
        """Return the checks that no competitor is cheaper, if one has a cost, and that the time limit was kept."""
        cheaper = Check(f"cheaper by: {self.summary.kind.value}", max(0.0, -self.margin), COST_MARGIN)
        late = Check(f"not checked within the time limit: {self.summary.kind.value}", 1.0, 0.0)
        return [*([cheaper] if math.isfinite(self.margin) else []), *([late] if self.interrupted else [])]

    def joined(self, other: Compared) -> Compared:
        """Return this comparison combined with another comparison of the same kind."""
        least = min(self, other, key=lambda one: one.margin)
        count, solved = (getattr(self.summary, name) + getattr(other.summary, name) for name in ("tried", "solved"))
        summary = Competitors(self.summary.kind, count, solved, least.summary.cheapest)
        return Compared(summary, least.margin, self.interrupted or other.interrupted)


@dataclass(frozen=True, eq=False)
class Comparison:
    """Comparisons of a solution with the competitors of all kinds that its problem allows."""

    kinds: tuple[Compared, ...] = ()
    """Results of the comparisons, one for each kind of competitor."""
    not_checked: tuple[Kind, ...] = ()
    """Kinds of competitors that were not tried, of which none was solved, or for which the time limit was reached."""
    better: Solution | None = None
    """Cheaper extremal of full accuracy, ``None`` if none was found."""
    proved: tuple[Check, ...] = ()
    """Checks that replace the comparison if it is known that no cheaper motion exists."""

    def joined(self, other: Comparison) -> Comparison:
        """Return this comparison combined with another comparison of the same solution."""
        kinds, missing = self.kinds + other.kinds, self.not_checked + other.not_checked
        return Comparison(kinds, missing, self.better or other.better, self.proved + other.proved)

    @property
    def checks(self) -> list[Check]:
        """Return the checks of all kinds, and one that fails if no competitor has a cost (nothing was compared)."""
        none = not any(kind.summary.solved or kind.interrupted or kind.enough for kind in self.kinds)
        found = [*self.proved, *(check for kind in self.kinds for check in kind.checks)]
        return [*found, Check(UNCOMPARED, 1.0, 0.0)] if self.kinds and none else found


def unseen(costs: Sequence[float]) -> float:
    """Return the estimated probability that a further start would lead to a motion to which none has led.

    It is the share of the starts whose cost no other start has led to (Good, The population frequencies of species and
    the estimation of population parameters, Biometrika 40, 1953); zero for fewer than ``FEWEST_STARTS`` starts, which
    say little.

    Parameters
    ----------
    costs
        Costs to which starts have led, NaN for those that were not solved.
    """
    found = np.sort([cost for cost in costs if math.isfinite(cost)])
    if len(found) < FEWEST_STARTS:
        return 0.0
    apart = np.concatenate([[True], np.diff(found) > SAME_MOTION * np.abs(found[1:]), [True]])
    return float((apart[1:] & apart[:-1]).mean())


def going_round(instance: Instance) -> list[Kind]:
    """Return the kind "revolutions" if the uncontrolled motion has a rotational symmetry, else an empty list.

    With this symmetry other numbers of revolutions may lead to the same final state.
    """
    from satsym.solvers.symmetry import symmetric

    return [Kind.REVOLUTIONS] if symmetric(instance) else []


def summed(
    solution: Solution, kind: Kind, count: int, costs: Sequence[float], interrupted: bool, coarse: float = SAME_COST
) -> Compared:
    """Summarise the attempts to find competitors of one kind.

    Parameters
    ----------
    coarse
        Relative difference of costs below which two costs count as equal.
    """
    cheapest = min(costs, default=float("nan"))
    excess = margin(cheapest, solution.objective, coarse=coarse, hidden=hidden(solution))
    return Compared(Competitors(kind, count, len(costs), cheapest), excess, interrupted)


def hidden(solution: Solution) -> float:
    """Return the difference of costs that rounding of the final states may cause."""
    return HIDDEN * products(solution)


def margin(competitor: float, cost: float, coarse: float = 0.0, hidden: float = 0.0) -> float:
    """Return the excess cost of a competitor relative to the cost of the solution.

    Relative differences below ``coarse`` and absolute differences below ``hidden`` count as zero, because they are
    within the error of the competitor.
    """
    if not np.isfinite(competitor):
        return float("inf")
    margin = float(np.clip((competitor - cost) / max(abs(cost), 1e-300), -LARGEST_MARGIN, LARGEST_MARGIN))
    return 0.0 if abs(margin) < coarse or abs(competitor - cost) < hidden else margin
