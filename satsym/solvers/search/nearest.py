"""Smallest distance from the given final state that admissible motions reach: evidence that an instance is infeasible.

Only the distance is minimised, not the cost, from several starts. If the smallest distance is not zero and most
searches lead to it, no nearby motion reaches the final state; this is evidence, not a proof, and the motion is never
returned as a solution.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from satsym import activity
from satsym.instance import Instance
from satsym.instance.shown import spec_of
from satsym.solvers.iteration import Limits
from satsym.solvers.search.arriving import ARRIVED, Missing, arrived, arriving, distance, missed
from satsym.solvers.search.controls import controls_of
from satsym.solvers.search.durations import first_duration
from satsym.solvers.search.mesh import refined
from satsym.solvers.search.motion import motion
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.starts.planning import Plan

INTERVALS = 40
"""Number of intervals of the mesh."""

PLANS = (
    Plan(arriving=True),
    Plan(arriving=True, noise=0.1, seed=1),
    Plan(arriving=True, at_bound=0.96),
    Plan(arriving=True, at_bound=-0.96),
    Plan(arriving=True, noise=0.3, seed=2),
    Plan(),
    Plan(coasting=True),
    Plan(noise=0.3, seed=3),
)
"""Starts from which the distance is minimised."""

CLOSE_MISS = 5e-3
"""Relative distance below which infeasibility is not claimed: controls that switch within an interval may reach the
end."""

SIMILAR, AGREEING = 0.1, 0.5
"""Relative difference of distances that count as equal, and minimum fraction of the searches that have to find the
smallest distance for it to be evidence."""

RESIDUAL = 1.0
"""Largest residual of the equations of motion between the points of an interval, relative to the magnitudes of states.
Above it the points do not represent a motion: near a singularity a coarse mesh steps over it."""

FEWEST = 2
"""Minimum number of searches that have to find a motion for the smallest distance to be evidence."""


@dataclass(frozen=True, eq=False)
class Nearest:
    """The motion with the smallest distance from the given final state.

    Attributes
    ----------
    missed
        Deviation from each given final state, in the model's units, by its name, and from each terminal constraint, by
        the name of its multiplier.
    units
        Units of the states, by their names.
    distance
        Largest deviation, relative to the magnitude of its state along the motion.
    starts, agreeing
        Number of searches for the smallest distance, and number of searches that led to this motion.
    """

    missed: dict[str, float]
    units: dict[str, str]
    distance: float
    starts: int
    agreeing: int

    @property
    def arrives(self) -> bool:
        """Return whether the motion reaches the end within rounding."""
        return self.distance <= ARRIVED

    @property
    def undecided(self) -> bool:
        """Return whether the motion may reach the end, or too few searches led to the same distance."""
        return self.distance <= CLOSE_MISS or self.agreeing < AGREEING * self.starts

    @property
    def message(self) -> str:
        """Return the distance as a message of one line."""
        misses = ", ".join(
            " ".join(filter(None, [f"{name} by {abs(value):.3g}", self.units.get(name)]))
            for name, value in self.missed.items()
        )
        return (
            f"no control within the bounds was found that reaches the given final state: the best of {self.starts} "
            f"local searches misses {misses}"
        )


def nearest(instance: Instance, limits: Limits) -> Nearest | None:
    """Minimise the distance from the given final state; ``None`` if too few of the starts lead to a motion.

    Parameters
    ----------
    instance
        Instance with a given final time.
    """
    tried, found = 0, list[Found]()
    for one in _solved(instance, limits):
        if one.solved and refined(one)[1] > RESIDUAL:
            continue
        tried += 1
        found += [one] if one.solved else []
        if limits.expired or arrived(one):
            break
    best = min(found, key=distance, default=None)
    if best is None or (len(found) < max(FEWEST, tried / 2) and not arrived(best)):
        return None
    least = distance(best)
    programme, spec = best.programme, instance.model.spec
    assert isinstance(programme, Missing)
    by = missed(best)
    places = [*programme.given.tolist(), *programme.on_reference]
    names = [*(spec.state_names[i] for i in places), *(f"the constraint of {v.symbol}" for v in spec.multipliers)]
    units = [*programme.sizes.states[places], *(1.0 for _ in spec.multipliers)]
    given = {v.symbol: v.unit for v in spec_of(instance).states if v.unit != "1"}
    by_name = dict(zip(names, (by * np.array(units)).tolist(), strict=True))
    agreeing = sum(distance(one) <= (1.0 + SIMILAR) * least for one in found)
    return Nearest(by_name, given, least, len(found), agreeing)


def reaching(instance: Instance, limits: Limits) -> Instance | None:
    """Return the instance with values of its free quantities that reach its end; ``None`` if none are found."""
    for one in _solved(instance, limits):
        if arrived(one):
            return motion(one).instance
    return None


def _solved(instance: Instance, limits: Limits) -> Iterator[Found]:
    """Yield the results of searches for the smallest distance, one after the other."""
    controls = controls_of(instance)
    if controls is None:
        return
    mesh = np.linspace(0.0, 1.0, INTERVALS + 1)
    with np.errstate(all="ignore"):
        duration = first_duration(instance, controls)
    for number, plan in enumerate(PLANS, 1):
        if limits.expired:
            return
        activity.tell(f"checking whether the final state can be reached: search {number} of {len(PLANS)} ...")
        with np.errstate(all="ignore"):
            found = arriving(instance, controls, [mesh], plan, duration, limits)
        yield found
