"""What is tried after what: starts one after the other, each on finer meshes, its arcs, and Newton's method.

1. A fixed list of starts (:mod:`~satsym.solvers.search.starts`) is gone through, each solved on a coarse mesh.
2. What a start came to is solved on finer meshes until its cost settles. Its arcs are read after each mesh
   (:mod:`~satsym.solvers.search.reading`).
3. The first arcs that Newton's method makes exact are the answer: :func:`searched`.
4. The starts that are left are competitors of an answer, whoever found it: :func:`others`. They end when a number of
   them in turn has shown nothing new; that number grows with the number of different costs that were found.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.iteration import Limits
from satsym.solvers.search import nlp, starts
from satsym.solvers.search.controls import controls_of
from satsym.solvers.search.durations import first_duration
from satsym.solvers.search.mesh import graded, refined
from satsym.solvers.search.motion import Motion, motion
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import sizes_of
from satsym.solvers.search.starts import Plan

Answer = TypeVar("Answer")

INTERVALS, SHORTEST = 40, 8
"""Number of intervals of the coarse mesh, and the least number in a phase."""

STARTS, FAILING, CONVEX = 48, 8, 2
"""Starts that are tried at most, and in turn after which it ends where none has come to anything, in general and where
the problem is convex, so that all starts come to one motion.
"""

QUIET, FURTHER, PATIENCE = 4, 6, 24
"""Competitors in turn that show nothing new, after which it ends, and by how many more for each further cost; and in
turn where ends are drawn, or path constraints part the ways."""

PROBE, AROUND = 160_000, 600_000
"""Unknowns times iterations after which they end that all came to one cost, two at least, and where there are path
constraints."""

ITERATIONS, BESIDE, AGAIN = 300, 120, 200
"""Iterations of the interior-point code for a start, for a start beside an answer, and for a finer mesh."""

SAME = 1e-4
"""Relative difference of costs on a coarse mesh that may be of one motion."""

MESHES, SETTLED, SMOOTHINGS = 5, 1e-6, (1e-3, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4)
"""Finer meshes at most, the change of cost from one to the next that is none, and smoothings of norms on each."""

FIRST_SMOOTHINGS = (1e-1, 1e-2, 1e-3)
"""Smoothings of norms on the coarse mesh: fuel alone decides little between bounds, and effort much."""

CHEAPER = 1e-9
"""Relative difference of exact costs that is one."""

OTHERS, SHOWN, ALIKE = 3, 41, 0.05
"""Motions at the cost of an answer that are made exact at most, the times at which ways are looked at, and the share of
the range of a state by which those differ that are another way."""

FALLING = 1e-2
"""Share of its cost by which what costs more than an answer becomes cheaper from one mesh to the next, to be followed.
"""

TRIED = 3
"""Different costs of which none is made exact, after which it ends."""

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
    starts: int = STARTS,
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
    starts
        How many are tried at most.
    """
    costs: list[float] = []
    failing = CONVEX if convex(instance) else FAILING
    for number, (_, found) in enumerate(_started(instance, limits, loose)):
        if found.solved and not any(_same(found.objective, cost) for cost in costs):
            one = replace(limits, work=min(limits.work, limits.meter.spent + FINER * limits.work))
            for at in _finer(found, one):
                answer = exact(at, one)
                if answer is not None or limits.expired:
                    return answer
            costs.append(found.objective)
        if len(costs) >= TRIED or (not costs and number + 1 >= failing) or number + 1 >= starts:
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
    parted = bool(instance.model.spec.path_constraints)
    probe = AROUND if parted else PROBE
    for number, (plan, found) in enumerate(_started(instance, limits, loose, BESIDE, way)):
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
        elif (known := next((came for coarse, came in seen if _same(found.objective, coarse)), None)) is not None:
            yield Tried(plan, known)
        else:
            quiet = 0
            came, answer = _followed(found, limits, cost, lambda at: _costing(exact(at, limits), cost_of))
            seen.append((found.objective, came))
            yield Tried(plan, came, answer if came < cost - CHEAPER * abs(cost) else None)
        alone = len(seen) == 1 and solved > 1 and plan.turns is None and limits.meter.spent - begun > probe
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
    if not 0 < len(shapes) <= OTHERS or abs(found.objective - cost) > SAME * abs(cost):
        return False
    at = motion(found)
    shape = _shape(at.times, at.x)
    if any(np.abs(shape - other).max() < ALIKE for other in shapes):
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
        if came < cost - SAME * abs(cost):
            answer = exact(at)
            if answer is not None:
                return answer
        elif came <= cost + SAME * abs(cost):
            return cost, None
        elif not came < before - FALLING * abs(before):
            return came, None
        before = came
    return (float("nan") if came < cost else came), None


def _started(
    instance: Instance,
    limits: Limits,
    loose: str,
    most: int = ITERATIONS,
    way: tuple[Array, Array] | None = None,
) -> Iterator[tuple[Plan, Found]]:
    """What starts come to on a coarse mesh, which is even unless the way of a motion is known."""
    controls = controls_of(instance)
    if controls is None:
        return
    phases = len(instance.model.spec.interior) + 1
    meshes: list[Array] = [np.linspace(0.0, 1.0, max(INTERVALS // phases, SHORTEST) + 1)] * phases
    if way is not None and phases == 1:
        meshes = [graded(*way, INTERVALS)]
    with np.errstate(all="ignore"):
        duration = first_duration(instance, controls)
        sizes = sizes_of(instance, controls, duration)
        plans = starts.plans(instance, controls, duration)[:STARTS]
    normed = any(norm.spot is not None for norm in controls.norms)
    smoothings = FIRST_SMOOTHINGS if normed else FIRST_SMOOTHINGS[-1:]
    programmes = [Programme(instance, controls, meshes, sizes, by, loose) for by in smoothings]
    known = list[tuple[float, Found]]()
    for number, plan in enumerate(plans):
        if limits.expired:
            return
        with np.errstate(all="ignore"):
            found = _less_smoothed(programmes, plan, limits, most if number else ITERATIONS, known)
        yield plan, found


def _less_smoothed(
    programmes: Sequence[Programme], plan: Plan, limits: Limits, most: int, known: list[tuple[float, Found]]
) -> Found:
    """The solution of the last of several programmes that differ in smoothing, each begun at that of the one before.

    Of the last that is solved: next to bounds, what is hardly smoothed may take very many iterations.

    Parameters
    ----------
    known
        Costs of the first programme and what they led to; what is found is added.
    """
    start = starts.begun(programmes[0], plan)
    first = found = nlp.solve(programmes[0], start, limits, most, near=plan.at_bound is not None)
    if len(programmes) > 1 and first.solved:
        before = next((last for cost, last in known if _same(cost, first.objective)), None)
        if before is not None:
            return before
    for programme in programmes[1:]:
        one = nlp.solve(programme, found.unknown, limits, most, near=True) if found.solved else found
        if not one.solved:
            break
        found = replace(one, smoother=found)
    known.append((first.objective, found))
    return found


def costs_by_duration(instance: Instance, limits: Limits, shares: Sequence[float]) -> list[tuple[float, float]]:
    """Durations and what a motion costs on a coarse mesh that lasts as long, those that are solved.

    Parameters
    ----------
    shares
        Of the first guess of the duration.
    """
    controls = controls_of(instance)
    if controls is None:
        return []
    with np.errstate(all="ignore"):
        first, found = first_duration(instance, controls), list[tuple[float, float]]()
    for share in shares:
        given = replace(instance, tf=instance.t0 + share * first, tf_guess=None)
        one = next((one for _, one in _started(given, limits, "") if one.solved), None)
        found += [] if one is None else [(share * first, one.objective)]
    return found


def first_motion(instance: Instance, limits: Limits) -> Motion | None:
    """What the first start that is solved comes to, on a coarse mesh."""
    found = next((one for _, one in _started(instance, limits, "") if one.solved), None)
    return None if found is None else motion(found)


def _same(one: float, other: float) -> bool:
    return abs(one - other) <= SAME * max(abs(one), abs(other))


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
        settled = abs(one.objective - found.objective) <= SETTLED * abs(one.objective)
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
    one = nlp.solve(programme, start, limits, AGAIN, near=True)
    return one if one.solved or limits.expired else nlp.solve(programme, start, limits, ITERATIONS)
