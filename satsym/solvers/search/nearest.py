"""How near to the given end a motion within its bounds can come: evidence that an instance is infeasible.

The miss is minimised alone, whatever the motion costs, from several starts. Where the least miss is not zero, and most
searches end there, no motion near these arrives; that is evidence, not a proof, and the distance itself is never called
a solution.
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
from satsym.solvers.search.mesh import refined
from satsym.solvers.search.motion import motion
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.starts import Plan

INTERVALS = 40
"""Intervals of the mesh."""

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
"""Starts from which the miss is minimised."""

CLOSE_MISS = 5e-3
"""Relative miss below which nobody can tell: controls that switch within an interval may do better."""

SIMILAR, AGREEING = 0.1, 0.5
"""Relative difference of misses that are the same, and the share of the searches that have to find the least one: where
fewer do, others may arrive."""

RESIDUAL = 1.0
"""Largest residual of the equations between the points of an interval, relative to the sizes of states, with which
these points still show a motion: next to a singularity a coarse mesh steps over what cannot be passed."""

FEWEST = 2
"""Searches that have to end at a motion, for the least miss to be evidence."""


@dataclass(frozen=True, eq=False)
class Nearest:
    """The nearest end that was found.

    Attributes
    ----------
    missed
        By how much each given final state is missed, in the model's units, by its name, and each terminal constraint,
        by its multiplier's.
    units
        Of states, by their names.
    distance
        The largest miss, relative to the size of its state along the way.
    starts, agreeing
        Searches in which the miss was minimised, and how many of them led to this one.
    """

    missed: dict[str, float]
    units: dict[str, str]
    distance: float
    starts: int
    agreeing: int

    @property
    def arrives(self) -> bool:
        """Whether the motion reaches the end to within rounding."""
        return self.distance <= ARRIVED

    @property
    def undecided(self) -> bool:
        """Whether the motion may reach the end, or too few starts led to the same distance from it."""
        return self.distance <= CLOSE_MISS or self.agreeing < AGREEING * self.starts

    @property
    def message(self) -> str:
        """One line."""
        misses = ", ".join(
            " ".join(filter(None, [f"{name} by {value:.3g}", self.units.get(name)]))
            for name, value in self.missed.items()
        )
        return (
            f"no control within the bounds was found that reaches the given final state: the best of {self.starts} "
            f"local searches misses {misses}"
        )


def nearest(instance: Instance, limits: Limits) -> Nearest | None:
    """Minimise the miss of the given end; ``None`` where few of the starts lead to a motion: they say nothing.

    Parameters
    ----------
    instance
        With a given final time.
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
    """The instance with values for what it leaves free with which its end is reached; ``None`` where none are found."""
    for one in _solved(instance, limits):
        if arrived(one):
            return motion(one).instance
    return None


def _solved(instance: Instance, limits: Limits) -> Iterator[Found]:
    """Where searches for the least miss end, one after the other."""
    controls = controls_of(instance)
    if controls is None:
        return
    mesh = np.linspace(0.0, 1.0, INTERVALS + 1)
    for number, plan in enumerate(PLANS, 1):
        if limits.expired:
            return
        activity.tell(f"checking whether the final state can be reached: search {number} of {len(PLANS)} ...")
        with np.errstate(all="ignore"):
            found = arriving(instance, controls, [mesh], plan, limits)
        yield found
