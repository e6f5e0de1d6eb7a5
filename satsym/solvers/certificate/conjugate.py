"""The second-order conditions of a solution whose controls follow from states and costates."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.solution import Check, Solution
from satsym.solvers.certificate.end_form import end_form
from satsym.solvers.certificate.jacobi import end_curvature, first_passage, followed
from satsym.solvers.certificate.segments import Segments, between

FLAT = 1e-9
"""Relative curvature in the free end below which nobody can tell whether there is any."""

NOT_STRICT = "not strict: other controls cost the same"


@dataclass(frozen=True)
class Conjugate:
    """What neighbouring extremals from the same initial state say."""

    resolved: bool
    """Whether they could be followed."""
    passed: int = 0
    """Conjugate times after the start, with their multiplicity."""
    time: float | None = None
    """The first of these, or ``None``."""
    touching: bool = False
    """Whether the final time may be one, as far as can be told."""
    curvature: float = float("inf")
    """Least one of the cost in what is free at the end, relative; infinite where nothing is."""

    @property
    def checks(self) -> list[Check]:
        """Each is a deficit that must not be positive."""
        if not self.resolved:
            return [Check("conjugate points not resolved", 1.0, 0.0)]
        found = [Check("conjugate points: none", float(self.passed), 0.0)]
        if self.curvature < float("inf"):
            found.append(Check("second-order condition at the free endpoint", float(not self.curvature > -FLAT), 0.0))
        if self.passed == 0 and (self.touching or abs(self.curvature) <= FLAT):
            found.append(Check(NOT_STRICT, 1.0, 0.0))
        return found


def conjugate(solution: Solution, along: Segments | None) -> Conjugate:
    """Count conjugate times, and measure the curvature in the free end.

    Parameters
    ----------
    solution
        An extremal.
    along
        Its linearisation, or ``None`` where there is none.
    """
    phases = None if along is None else followed(along.transition)
    if along is None or phases is None:
        return Conjugate(resolved=False)
    time = first_passage(along.times, phases, lambda station, t: between(solution, along, station, t))
    curvature = end_curvature(phases.frames[-1], end_form(solution, along.scale))
    passed = int(phases.passed[-1])
    return Conjugate(curvature == curvature, passed, time, phases.touching, curvature)
