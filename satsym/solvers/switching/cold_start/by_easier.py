"""Throttled vectors in a given time: exact arcs of an easier problem, which are followed to the one that is asked.

Where little time is to spare, a vector has its full norm nearly all the time, and smoothed problems, which have more
than one extremal there, lead nowhere: with larger norms there is time to spare. Where there is much of it, motions with
hardly any control lie far from all straight lines: in a shorter time they do not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

from satsym.control_part import SWITCHED
from satsym.instance import Instance
from satsym.solvers.cold_start.directions import directed
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.arcs_of_norms import arcs
from satsym.solvers.switching.structure import UPPER, Guess

STEP, SMALLEST = 0.35, 1e-3
"""Share of the way that is taken at first, and the least at which following ends."""

BOLDER, CALMER = 1.5, 0.4
"""Factors of that after a step that succeeded and after one that failed."""

BRIEF = 0.03
"""Share of the time off the largest norms below which next to none is left where following ends."""


@dataclass(frozen=True)
class Easier:
    """How a problem is made easier: by which factors the largest norms, or single controls, and the time differ."""

    norms: float = 1.0
    duration: float = 1.0

    def of(self, instance: Instance, fraction: float) -> Instance:
        """The problem that is easier by a fraction of these, from none to one, of their logarithms."""
        assert instance.tf is not None
        spec, larger = instance.model.spec, self.norms**fraction
        switched = [part for part in spec.control_parts if part.branch in SWITCHED]
        sets, single = {part.name for part in switched}, {c for part in switched for c in part.controls}
        norms = {name: (low, high * larger if name in sets else high) for name, (low, high) in instance.norms.items()}
        each = list(zip(spec.control_names, instance.lower, instance.upper, strict=True))
        end = instance.t0 + (instance.tf - instance.t0) * self.duration**fraction
        return replace(
            instance,
            norms=norms,
            lower=tuple(low * larger if name in single and low < 0.0 else low for name, low, _ in each),
            upper=tuple(high * larger if name in single and high > 0.0 else high for name, _, high in each),
            tf=end if fraction else instance.tf,
        )


EASIER = (*(Easier(norms=by) for by in (1.3, 1.7, 2.5, 4.0)), *(Easier(duration=by) for by in (0.6, 0.3)))
"""What is tried, one after the other."""


@dataclass(frozen=True, eq=False)
class Followed:
    """How far exact arcs were followed."""

    exact: Exact
    easier: Easier
    fraction: float
    """The last ones, and those of which problem they are."""

    @property
    def norms(self) -> float:
        """How many times as large the largest norms are."""
        return self.easier.norms**self.fraction

    @property
    def saturated(self) -> bool:
        """Whether hardly any time is left off the largest norms: smaller ones do not arrive near there."""
        at, structure, start = self.exact.refined.at, self.exact.refined.structure, self.exact.trajectory.arcs[0].start
        lengths = structure.durations(at.times, start, at.end)
        off = [
            sum(length for length, level in zip(own.tolist(), row, strict=True) if level != UPPER)
            for own, row in zip(lengths, structure.levels, strict=True)
        ]
        return self.norms > 1.0 and max(off) <= BRIEF * (at.end - start)


def followed(instance: Instance, limits: Limits) -> Followed | None:
    """Exact arcs of an easier problem, followed as far as that goes; ``None`` where there are none.

    Parameters
    ----------
    instance
        With a given final time.
    """
    far: Followed | None = None
    for easier in EASIER:
        found = tried(partial(directed, easier.of(instance, 1.0), limits, False, arcs))
        if isinstance(found, Exact):
            far = _back(instance, Followed(found, easier, 1.0), limits)
        if limits.expired or (far and (not far.fraction or far.saturated)):
            break
    return far


def _back(instance: Instance, here: Followed, limits: Limits) -> Followed:
    """To the problem itself, in steps as long as they succeed."""
    step = STEP
    while here.fraction and step > SMALLEST and not limits.expired:
        fraction, at = max(here.fraction - step, 0.0), here.exact.refined.at
        start = Guess(here.exact.refined.structure, at.times, at.costates, at.end)
        near = attempt(
            here.easier.of(instance, fraction), replace(start, end=_end(instance, here.easier, fraction)), limits
        )
        step *= CALMER if near is None else BOLDER
        if near is not None:
            here = replace(here, exact=replace(near, origin=Origin.EASIER), fraction=fraction)
    return here


def _end(instance: Instance, easier: Easier, fraction: float) -> float:
    end = easier.of(instance, fraction).tf
    assert end is not None
    return end
