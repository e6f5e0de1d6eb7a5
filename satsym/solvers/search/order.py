"""The order of the search: starts one after the other, each on finer meshes, then its arcs, then Newton's method.

1. A fixed list of starts (:mod:`~satsym.solvers.search.starts`) is gone through. Each is solved on a coarse mesh.
2. The arcs of a solution are read on the coarse mesh, then on finer ones until its cost settles
   (:mod:`~satsym.solvers.search.reading`).
3. The first arcs that Newton's method makes exact are the answer: :func:`searched`. The search ends without one after
   so many starts that fail, or so many costs of which none could be made exact.
4. The same starts give competitors of an answer, whichever method found it, until nothing new shows: :func:`others`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.iteration import Limits
from satsym.solvers.search import nlp, starts
from satsym.solvers.search.coarse import FIRST_SMOOTHINGS, ITERATIONS, SIMILAR, STARTS, at_edge, same, started
from satsym.solvers.search.mesh import refined
from satsym.solvers.search.motion import Motion, motion, violates
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.starts import Plan

Answer = TypeVar("Answer")

FAILING, ANY_DURATION, CONVEX, DOUBTFUL = 8, 12, 2, 3
"""Number of failing starts that end the search as long as none has succeeded: FAILING, ANY_DURATION where the duration
is free, and CONVEX where the problem is convex, because all starts lead to one motion then. After DOUBTFUL of them the
search asks whether any motion reaches the end."""

QUIET, FURTHER, PATIENCE = 4, 6, 24
"""The list of competitors ends after QUIET of them in a row that show nothing new, and FURTHER more for each further
cost that was found. Where ends are drawn, or path constraints separate the ways, it ends after PATIENCE in a row."""

PROBE, AROUND = 160_000, 600_000
"""Unknowns times iterations after which the list ends if at least two starts were solved and all led to one cost, but
for starts with other turns or durations. With path constraints it is AROUND."""

BESIDE, ON_FINER_MESH = 120, 200
"""Iterations of the interior-point code for a competitor, and for a finer mesh."""

MESHES, FINER, SETTLED_COST, SMOOTHINGS = 5, 0.2, 1e-6, (1e-3, 1e-4, 1e-4, 1e-4, 1e-4)
"""Number of finer meshes at most, share of the work that those of one start may take, relative change of cost from one
to the next at which they end, and smoothings of norms on each."""

CHEAPER = 1e-9
"""Relative difference from which one exact cost is less than another."""

PARALLELS, SHOWN, ALIKE_RANGE = 3, 41, 0.05
"""At most so many motions at the cost of an answer that take another way are made exact. Ways are compared at SHOWN
times, and differ where a state does by ALIKE_RANGE of its range."""

FALLING, RESOLVED, UNCERTAIN = 1e-2, 1e-2, 10.0
"""A motion that costs more than an answer is followed as long as each finer mesh makes it cheaper by the share FALLING,
but not where the residual of its coarse mesh, relative to the sizes of states, is at most RESOLVED. A cost is uncertain
by UNCERTAIN times its last change."""

MOST_COSTS, KEPT_COST, ENDLESS = 3, 0.5, 2
"""The search ends after MOST_COSTS different costs of motions that could not be made exact; after twice as many if
finer meshes change some by more than KEPT_COST, as the coarse mesh stepped over something there; and after ENDLESS
motions with the shortest or the longest duration allowed."""


@dataclass(frozen=True)
class Tried(Generic[Answer]):
    """What a start came to beside an answer.

    Attributes
    ----------
    plan
        How it began.
    cost
        That of the answer where both seem to be one. NaN where the start was not solved, and where neither an extremal
        nor finer meshes confirm that its motion is cheaper.
    exact
        The extremal, if it costs less than the answer.
    unsettled
        Whether its motion seems to cost less, but no mesh settles that.
    """

    plan: Plan
    cost: float
    exact: Answer | None = None
    unsettled: bool = False


def searched(
    instance: Instance,
    limits: Limits,
    exact: Callable[[Motion, Limits], Answer | None],
    loose: str = "",
    hopeless: Callable[[], bool] = lambda: False,
) -> Answer | None:
    """The first extremal that a start leads to; ``None`` without one.

    Parameters
    ----------
    limits
        Work is counted in unknowns times iterations.
    exact
        Makes a motion an exact extremal, where it can.
    loose
        A state whose given final value follows from those of the others.
    hopeless
        Tells whether no start will lead to an extremal; it is asked after a few that fail.
    """
    costs: list[float] = []
    patience = FAILING if instance.tf is not None else ANY_DURATION
    failing, failed, endless, stable = CONVEX if convex(instance) else patience, 0, 0, 0
    for number, (plan, found) in enumerate(started(instance, limits, loose, weak=True)):
        if found.solved and at_edge(found):
            endless += 1
            if endless >= ENDLESS:
                break
        elif found.solved and not any(same(found.objective, cost) for cost in costs):
            one, last = _part(limits), found.objective
            for at in _finer(found, one):
                answer, last = exact(at, one), at.cost
                if answer is not None or limits.expired:
                    return answer
            costs.append(found.objective)
            stable += abs(last - found.objective) <= KEPT_COST * abs(found.objective)
        failed = 0 if costs else failed + (not plan.loosened)
        if stable >= MOST_COSTS or len(costs) >= 2 * MOST_COSTS or failed >= failing or number + 1 >= STARTS:
            break
        if failed == DOUBTFUL and hopeless():
            break
    return None


def others(
    instance: Instance,
    limits: Limits,
    exact: Callable[[Motion, Limits], Answer | None],
    cost: float,
    cost_of: Callable[[Answer], float],
    loose: str = "",
    way: tuple[Array, Array] | None = None,
    hidden: float = 0.0,
    known_costs: int = 0,
) -> Iterator[Tried[Answer]]:
    """Competitors of an answer: what each start leads to. Those that seem to cost less are made exact.

    Parameters
    ----------
    cost
        Of the answer.
    cost_of
        That of an extremal.
    way
        Times and states of the answer, for the coarse mesh.
    hidden
        Difference up to which costs count as one, because the interior-point code tells no better.
    known_costs
        How many other costs are known already.
    """
    seen: list[tuple[float, float]] = []  # costs on the coarse mesh, and the cost that each came to
    shapes = [] if way is None else [_shape(*way)]  # of the answer, and of others at its cost
    quiet, solved, begun = 0, 0, (spent := limits.meter.spent)
    constrained = bool(instance.model.spec.path_constraints)
    patient, probe = constrained or starts.draws_ends(instance), AROUND if constrained else PROBE
    for number, (plan, found) in enumerate(started(instance, limits, loose, BESIDE, way)):
        if plan.arriving:  # such starts come in addition: they do not count against the others
            begun += limits.meter.spent - spent
        else:
            quiet, solved = quiet + 1, solved + found.solved
        if not found.solved:
            yield Tried(plan, float("nan"))
        elif abs(found.objective - cost) <= hidden:
            seen = seen or [(found.objective, cost)]  # so that the cost of the answer is among them
            yield Tried(plan, cost)
        elif _another_way(found, cost, shapes):
            answer = next(filter(None, (exact(at, limits) for at in _finer(found, limits))), None)
            came = cost if answer is None else cost_of(answer)
            seen.append((found.objective, came))
            yield Tried(plan, came, answer if came < cost - CHEAPER * abs(cost) else None)
        elif (known := next((came for coarse, came in seen if same(found.objective, coarse)), None)) is not None:
            yield Tried(plan, known)
        else:
            quiet = 0
            came, answer = _followed(found, _part(limits), cost, lambda at: _costing(exact(at, limits), cost_of))
            seen.append((found.objective, came))
            unsettled = not constrained and bool(np.isnan(came))  # with constraints it steps over one, mostly
            yield Tried(plan, came, answer if came < cost - CHEAPER * abs(cost) else None, unsettled)
        spent = limits.meter.spent
        # starts with other turns and durations are tried whatever the first ones lead to
        further = plan.turns is not None or plan.timed or plan.arriving
        alone = len(seen) == 1 and solved > 1 and not further and limits.meter.spent - begun > probe
        enough = (PATIENCE if patient else QUIET + FURTHER * (len(seen) - 1 + known_costs)) if seen else FAILING
        if alone or quiet >= enough or number + 1 >= STARTS or limits.expired:
            break


def _part(limits: Limits) -> Limits:
    """Limits for the finer meshes of one start, which leave work for the others."""
    return replace(limits, work=min(limits.work, limits.meter.spent + FINER * limits.work))


def _shape(times: Array, x: Array) -> Array:
    """States (n, M) of a motion at even shares of its time, each as a share of its range."""
    even = np.linspace(times[0], times[-1], SHOWN)
    span = np.ptp(x, axis=1, keepdims=True)
    return np.array([np.interp(even, times, row) for row in x]) / np.where(span > 0.0, span, 1.0)


def _another_way(found: Found, cost: float, shapes: list[Array]) -> bool:
    """Whether a motion costs about as much as an answer but goes another way; its shape is added to those known then.

    On a coarse mesh nobody can tell which of the two is cheaper.
    """
    if not 0 < len(shapes) <= PARALLELS or abs(found.objective - cost) > SIMILAR * abs(cost):
        return False
    at = motion(found)
    shape = _shape(at.times, at.x)
    if any(np.abs(shape - other).max() < ALIKE_RANGE for other in shapes):
        return False
    shapes.append(shape)
    return True


def _costing(answer: Answer | None, cost_of: Callable[[Answer], float]) -> tuple[float, Answer] | None:
    return None if answer is None else (cost_of(answer), answer)


def _followed(
    found: Found, limits: Limits, cost: float, exact: Callable[[Motion], tuple[float, Answer] | None]
) -> tuple[float, Answer | None]:
    """What a motion on a coarse mesh comes to beside an answer, and an extremal near it if it seems cheaper.

    A motion that costs more is solved on finer meshes as long as these make it much cheaper. One that costs less, and
    whose cost finer meshes hardly change, is cheaper even if no extremal is found near it.
    """
    margin, costs = SIMILAR * abs(cost), list[float]()
    meshes, residual = refined(found)
    for at in _finer(found, limits):
        falling = at.cost < costs[-1] - FALLING * abs(costs[-1]) if costs else residual > RESOLVED
        costs.append(at.cost)
        if at.cost < cost - margin:
            answer = exact(at)
            if answer is not None:
                return answer
        elif at.cost <= cost + margin:
            return cost, None
        elif not falling:
            return at.cost, None
    finest = sum(len(mesh) - 1 for mesh in meshes) == found.programme.intervals
    change = abs(costs[-1] - costs[-2]) if len(costs) > 1 else 0.0 if finest else np.inf
    surely = costs[-1] + UNCERTAIN * change < cost - margin and not violates(at)
    return (costs[-1] if surely or costs[-1] >= cost else float("nan")), None


def _finer(found: Found, limits: Limits) -> Iterator[Motion]:
    """What was found, on meshes that are ever finer."""
    yield motion(found)
    for number in range(MESHES):
        meshes, _ = refined(found)
        if sum(len(mesh) - 1 for mesh in meshes) == found.programme.intervals:
            return
        with np.errstate(all="ignore"):
            one = _again(found, meshes, SMOOTHINGS[number], limits)
        if not one.solved:
            return
        settled = abs(one.objective - found.objective) <= SETTLED_COST * abs(one.objective)
        found = one
        yield motion(found)
        if settled:
            return


def _again(found: Found, meshes: list[Array], smoothing: float, limits: Limits) -> Found:
    """Solve a programme again on other meshes, from a solution on its own.

    If the solution was reached from a smoother problem, so is the new one: next to bounds, controls that are hardly
    smoothed jump from point to point, and are no start for finer meshes.
    """
    begun = found if found.programme.smoothing > FIRST_SMOOTHINGS[-1] else found.smoother
    smoother = None if begun is None else _carried(begun, meshes, begun.programme.smoothing, limits)
    if smoother is not None and smoother.solved:
        one = nlp.solve(
            replace(smoother.programme, smoothing=smoothing, kinds={}), smoother.unknown, limits, BESIDE, True
        )
        return replace(one, smoother=smoother) if one.solved else smoother
    return _carried(found, meshes, smoothing, limits)


def _carried(found: Found, meshes: list[Array], smoothing: float, limits: Limits) -> Found:
    """Solve a programme on other meshes directly from a solution on its own."""
    old = found.programme
    programme = Programme(old.instance, old.controls, meshes, old.sizes, smoothing, old.loose)
    start = starts.carried(programme, old, found.unknown)
    one = nlp.solve(programme, start, limits, ON_FINER_MESH, near=True)
    return one if one.solved or limits.expired else nlp.solve(programme, start, limits, ITERATIONS)
