"""What is tried after what: starts one after the other, each on finer meshes, its arcs, and Newton's method.

1. A fixed list of starts (:mod:`~satsym.solvers.search.starts`) is gone through, each solved on a coarse mesh.
2. What a start came to is solved on finer meshes until its cost settles. Its arcs are read after each mesh
   (:mod:`~satsym.solvers.search.reading`).
3. The first arcs that Newton's method makes exact are the answer: :func:`searched`.
4. The starts that are left are competitors of an answer, whoever found it: :func:`others`. They end when a number of
   them in turn has shown nothing new; that number grows with the number of different costs that were found.
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
from satsym.solvers.search.motion import Motion, motion
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.starts import Plan

Answer = TypeVar("Answer")

FAILING, CONVEX = 8, 2
"""Starts in turn after which it ends where none has come to anything, in general and where the problem is convex: there
all starts come to one motion."""

DOUBTFUL = 3
"""Starts in turn that come to nothing, after which it is asked whether any motion arrives."""

QUIET, FURTHER, PATIENCE = 4, 6, 24
"""Competitors in turn that show nothing new, after which it ends, and by how many more for each further cost; and in
turn where ends are drawn, or path constraints part the ways."""

PROBE, AROUND = 160_000, 600_000
"""Unknowns times iterations after which they end that all came to one cost, two at least, and where there are path
constraints."""

BESIDE, ON_FINER_MESH = 120, 200
"""Iterations of the interior-point code for a start beside an answer, and for a finer mesh."""

MESHES, SETTLED_COST, SMOOTHINGS = 5, 1e-6, (1e-3, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4)
"""Finer meshes at most, the change of cost from one to the next that is none, and smoothings of norms on each."""

CHEAPER = 1e-9
"""Relative difference of exact costs that is one."""

OTHERS, SHOWN, ALIKE_RANGE = 3, 41, 0.05
"""Motions at the cost of an answer that are made exact at most, the times at which ways are looked at, and the share of
the range of a state by which those differ that are another way."""

FALLING = 1e-2
"""Share of its cost by which what costs more than an answer becomes cheaper from one mesh to the next, to be followed.
"""

TRIED = 3
"""Different costs of which none is made exact, after which it ends."""

ENDLESS = 2
"""Starts after which it ends whose duration grows or shrinks as far as it may."""

FINER = 0.2
"""Fraction of the work that the finer meshes of one start may take: a wild motion needs ever more intervals."""


@dataclass(frozen=True)
class Tried(Generic[Answer]):
    """What a start came to beside an answer.

    Attributes
    ----------
    plan
        How it began.
    cost
        NaN where it came to nothing.
    exact
        The extremal where that costs less.
    """

    plan: Plan
    cost: float
    exact: Answer | None = None


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
        A state whose given end follows from those of the others.
    hopeless
        Asked after a few starts that come to nothing: whether none will.
    """
    costs: list[float] = []
    failing, failed, endless = CONVEX if convex(instance) else FAILING, 0, 0
    for number, (plan, found) in enumerate(started(instance, limits, loose, weak=True)):
        if found.solved and at_edge(found):
            endless += 1
            if endless >= ENDLESS:
                break
        elif found.solved and not any(same(found.objective, cost) for cost in costs):
            one = replace(limits, work=min(limits.work, limits.meter.spent + FINER * limits.work))
            for at in _finer(found, one):
                answer = exact(at, one)
                if answer is not None or limits.expired:
                    return answer
            costs.append(found.objective)
        failed = 0 if costs else failed + (not plan.loosened)
        if len(costs) >= TRIED or failed >= failing or number + 1 >= STARTS:
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
) -> Iterator[Tried[Answer]]:
    """What starts come to beside an answer; those that seem to cost less are made exact.

    Parameters
    ----------
    cost
        Of the answer.
    cost_of
        That of an extremal.
    way
        Times and states of the answer, for the coarse mesh.
    hidden
        The difference of costs that the tolerance of the interior-point code hides.
    """
    seen: list[tuple[float, float]] = []  # on the coarse mesh, and what each came to
    shapes = [] if way is None else [_shape(*way)]  # of the answer, and of others at its cost
    quiet, solved, begun = 0, 0, limits.meter.spent
    spent = begun
    parted = bool(instance.model.spec.path_constraints)
    probe = AROUND if parted else PROBE
    for number, (plan, found) in enumerate(started(instance, limits, loose, BESIDE, way)):
        if plan.arriving:  # these are further starts, not in place of others
            begun += limits.meter.spent - spent
        else:
            quiet, solved = quiet + 1, solved + found.solved
        if not found.solved:
            yield Tried(plan, float("nan"))
        elif abs(found.objective - cost) <= hidden:
            seen = seen or [(found.objective, cost)]
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
            came, answer = _followed(found, limits, cost, lambda at: _costing(exact(at, limits), cost_of))
            seen.append((found.objective, came))
            yield Tried(plan, came, answer if came < cost - CHEAPER * abs(cost) else None)
        spent = limits.meter.spent
        # other ways and durations are asked, whatever the first starts come to
        further = plan.turns is not None or plan.timed or plan.arriving
        alone = len(seen) == 1 and solved > 1 and not further and limits.meter.spent - begun > probe
        parted = parted or bool(plan.drawn)
        enough = (PATIENCE if parted else QUIET + FURTHER * (len(seen) - 1)) if seen else FAILING
        if alone or quiet >= enough or number + 1 >= STARTS or limits.expired:
            break


def _shape(times: Array, x: Array) -> Array:
    """States (n, M) of a motion at even shares of its time, each as a share of its range."""
    even = np.linspace(times[0], times[-1], SHOWN)
    span = np.ptp(x, axis=1, keepdims=True)
    return np.array([np.interp(even, times, row) for row in x]) / np.where(span > 0.0, span, 1.0)


def _another_way(found: Found, cost: float, shapes: list[Array]) -> bool:
    """Whether a motion costs about as much as an answer, but goes another way than it and others before; it is added.

    On a coarse mesh nobody can tell which of the two is cheaper.
    """
    if not 0 < len(shapes) <= OTHERS or abs(found.objective - cost) > SIMILAR * abs(cost):
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
    """What a motion on a coarse mesh comes to beside an answer of some cost, and the extremal if that costs less.

    What costs more is solved on finer meshes as long as these make it cheaper: a coarse mesh may be all that is dear.
    """
    before, came = float("inf"), found.objective
    for at in _finer(found, limits):
        came = at.cost
        if came < cost - SIMILAR * abs(cost):
            answer = exact(at)
            if answer is not None:
                return answer
        elif came <= cost + SIMILAR * abs(cost):
            return cost, None
        elif not came < before - FALLING * abs(before):
            return came, None
        before = came
    return (float("nan") if came < cost else came), None


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
    """The solution on other meshes that is near one that was found.

    Where that began at a smoother one, so does this: next to bounds, controls that are hardly smoothed jump from point
    to point, and are no start for finer meshes.
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
    """The solution on other meshes to which one leads directly."""
    old = found.programme
    programme = Programme(old.instance, old.controls, meshes, old.sizes, smoothing, old.loose)
    start = starts.carried(programme, old, found.unknown)
    one = nlp.solve(programme, start, limits, ON_FINER_MESH, near=True)
    return one if one.solved or limits.expired else nlp.solve(programme, start, limits, ITERATIONS)
