"""Throttled vectors in a given time: exact arcs where larger norms are admissible, which are then brought down.

Where little time is to spare, a vector has its full norm nearly all the time, and smoothed problems, which have more
than one extremal there, lead nowhere. With larger norms there is time to spare; exact arcs are followed from there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

from satsym.instance import Instance
from satsym.solvers.cold_start.directions import directed
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.arcs_of_norms import arcs
from satsym.solvers.switching.structure import UPPER, Guess

LARGER = (1.3, 1.7, 2.5, 4.0)
"""Factors of the largest norms with which exact arcs are looked for."""

STEP, SMALLEST = 0.85, 0.9995
"""By so much norms are made smaller at first, and by how much at least."""

BOLDER, CALMER = 1.5, 0.4
"""Powers of that after a step that succeeded and after one that failed."""

BRIEF = 0.03
"""Share of the time off the largest norms below which next to none is left where following ends."""


@dataclass(frozen=True, eq=False)
class Followed:
    """How far exact arcs were followed towards the norms that are admissible."""

    exact: Exact
    factor: float
    """The last ones, and of the largest norms there; one where they arrive."""

    @property
    def arrives(self) -> bool:
        """Whether these are the norms of the problem."""
        return self.factor == 1.0

    @property
    def least(self) -> bool:
        """Whether hardly any time is left off the largest norms: smaller ones do not arrive near there."""
        at, structure, start = self.exact.refined.at, self.exact.refined.structure, self.exact.trajectory.arcs[0].start
        lengths = structure.durations(at.times, start, at.end)
        off = (
            float(own[[level != UPPER for level in row]].sum())
            for own, row in zip(lengths, structure.levels, strict=True)
        )
        return max(off) <= BRIEF * (at.end - start)


def followed(instance: Instance, limits: Limits) -> Followed | None:
    """Exact arcs of larger norms, followed to those of an instance as far as that goes; ``None`` where there are none.

    Parameters
    ----------
    instance
        With a given final time.
    """
    for factor in LARGER:
        found = tried(partial(directed, _larger(instance, factor), limits, False, arcs))
        if isinstance(found, Exact):
            return _brought_down(instance, Followed(found, factor), limits)
        if limits.expired:
            break
    return None


def _brought_down(instance: Instance, here: Followed, limits: Limits) -> Followed:
    """To the norms of the instance, in steps as long as they succeed."""
    ratio = STEP
    while not here.arrives and ratio < SMALLEST and not limits.expired:
        factor, at = max(here.factor * ratio, 1.0), here.exact.refined.at
        start = Guess(here.exact.refined.structure, at.times, at.costates, at.end)
        near = attempt(_larger(instance, factor), start, limits)
        ratio **= CALMER if near is None else BOLDER
        if near is not None:
            here = Followed(replace(near, origin=Origin.LARGER_NORMS), factor)
    return here


def _larger(instance: Instance, factor: float) -> Instance:
    """An instance with larger norms of vectors that are throttled."""
    throttled = {part.name for part in instance.model.spec.control_parts if part.branch == "throttled"}
    norms = {name: (low, high * factor if name in throttled else high) for name, (low, high) in instance.norms.items()}
    return replace(instance, norms=norms)
