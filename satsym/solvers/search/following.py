"""Refinement of motions from a coarse mesh on finer meshes, until their costs converge or exceed that of an answer."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import islice
from typing import TypeVar

import numpy as np

from satsym.arrays import Array
from satsym.solvers.iteration import Limits, Meter
from satsym.solvers.search import nlp
from satsym.solvers.search.coarse import BESIDE, FIRST_SMOOTHINGS, ITERATIONS, SIMILAR
from satsym.solvers.search.mesh import UNRESOLVED, graded, refined
from satsym.solvers.search.motion import Motion, motion, violates
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.starts import planning

Answer = TypeVar("Answer")

ON_FINER_MESH = 200
"""Maximum number of iterations of the interior-point code on a finer mesh."""

FINER, SETTLED_COST, SMOOTHINGS = 0.1, 1e-6, (1e-3, 1e-4, 1e-4, 1e-4, 1e-4)
"""``FINER`` is the fraction of the work that the finer meshes of one start may take; ``SETTLED_COST`` the relative
change of the cost between meshes below which refinement ends; ``SMOOTHINGS`` are the smoothing parameters of norms on
each finer mesh."""

RESOLVED, LOST, UNCERTAIN = 1e-2, 50.0, 10.0
"""A motion that costs more than an answer is refined unless the residual on its coarse mesh, relative to the magnitudes
of states, is at most ``RESOLVED``, and as long as its cost would come down to that of the answer if each of the meshes
that are left lowered it as much as the last one did. A motion whose residual exceeds ``LOST`` on a finer mesh is not
refined: it steps over a singularity, such as the centre of a planet. The error of a cost is estimated as ``UNCERTAIN``
times its last change."""

MOVES, FALLING_RESIDUAL, MOVED = (1, 1, 1, 2, 2, 3), 0.9, 1_000_000
"""The mesh of a motion that seems cheaper than an answer, but has no extremal on finer meshes, is laid anew along the
motion up to ``len(MOVES)`` times, with these numbers of intervals relative to the coarse mesh, as long as the
residual falls by the factor ``FALLING_RESIDUAL`` each time. ``MOVED`` is the work that all motions beside an answer may
take for that, in unknowns times iterations. A close passage, as of a moon, becomes closer with each mesh: a much finer
mesh fails at once where meshes that follow the motion lead to its extremal."""


def part(limits: Limits) -> Limits:
    """Return limits for the finer meshes of one start, which leave work for the other starts."""
    return replace(limits, work=min(limits.work, limits.meter.spent + FINER * limits.work))


def followed(
    found: Found, limits: Limits, cost: float, exact: Callable[[Motion], tuple[float, Answer] | None], moving: Meter
) -> tuple[float, Answer | None, bool]:
    """Return the refined cost of a motion from a coarse mesh, and an extremal near it if it seems cheaper.

    A motion that costs more than the answer is refined as long as finer meshes lower its cost enough. One that costs
    less, with a cost that hardly changes on finer meshes, is cheaper even if no extremal is found near it.

    Parameters
    ----------
    moving
        Meter of the work for meshes that follow motions.

    Returns
    -------
    float
        The cost. NaN if the motion seems cheaper, but its cost does not converge.
    Answer
        The extremal, ``None`` if none was looked for or found.
    bool
        Whether the cost is NaN although the last mesh resolves the motion. A motion that no mesh resolves does not obey
        its equations, and is no evidence of a lower cost.
    """
    margin, costs, last = SIMILAR * abs(cost), list[float](), found
    meshes, _ = refined(found)
    for left, last in zip(range(len(SMOOTHINGS), -1, -1), finer(found, part(limits)), strict=False):
        at, residual = motion(last), refined(last)[1]
        falling = (costs[-1] - at.cost) * left >= at.cost - cost if costs else residual > RESOLVED
        costs.append(at.cost)
        if at.cost < cost - margin:
            answer = exact(at) if residual <= LOST else None
            if answer is not None:
                return *answer, False
        elif at.cost <= cost + margin:
            return cost, None, False
        elif not falling:
            return at.cost, None, False
        if len(costs) > 1 and residual > LOST:
            break
    finest = sum(len(mesh) - 1 for mesh in meshes) == found.programme.intervals
    change = abs(costs[-1] - costs[-2]) if len(costs) > 1 else 0.0 if finest else np.inf
    resolved = refined(last)[1] < UNRESOLVED
    surely = resolved and costs[-1] + UNCERTAIN * change < cost - margin and not violates(motion(last))
    if surely:  # it deserves as much work as its extremal needs
        further = islice(finer(last, limits, SMOOTHINGS[-1:] * len(SMOOTHINGS)), 1, None)
        answer = next(filter(None, (exact(motion(one)) for one in further)), None)
        return (costs[-1], None, False) if answer is None else (*answer, False)
    if costs[-1] >= cost or not resolved:
        return (costs[-1] if costs[-1] >= cost else float("nan")), None, False
    for moved in _moved(found, replace(limits, work=MOVED, meter=moving), cost - margin):
        answer = exact(motion(moved))
        if answer is not None and answer[0] < cost - margin:
            return *answer, False
    return float("nan"), None, True


def _moved(found: Found, limits: Limits, below: float) -> Iterator[Found]:
    """Yield a solution on meshes that follow its motion, as long as it costs less than a bound."""
    residual, intervals = refined(found)[1], found.programme.intervals
    for factor in MOVES:
        if found.objective >= below or residual <= RESOLVED or found.programme.phases > 1:
            return
        at = motion(found)
        mesh = graded(at.times, at.x, factor * intervals)
        with np.errstate(all="ignore"):
            one = _again(found, [mesh], found.programme.smoothing, limits)
        before, residual = residual, refined(one)[1]
        if not one.solved or not residual < FALLING_RESIDUAL * before:
            return
        found = one
        yield found


def finer(found: Found, limits: Limits, smoothings: Sequence[float] = SMOOTHINGS) -> Iterator[Found]:
    """Yield a solution, and its refinements on successively finer meshes, one for each smoothing of norms."""
    yield found
    for smoothing in smoothings:
        meshes, _ = refined(found)
        if sum(len(mesh) - 1 for mesh in meshes) == found.programme.intervals:
            return
        with np.errstate(all="ignore"):
            one = _again(found, meshes, smoothing, limits)
        if not one.solved:
            return
        settled = abs(one.objective - found.objective) <= SETTLED_COST * abs(one.objective)
        found = one
        yield found
        if settled:
            return


def _again(found: Found, meshes: list[Array], smoothing: float, limits: Limits) -> Found:
    """Solve a programme again on other meshes, starting from a given solution.

    If the given solution was reached from a smoother problem, so is the new one: near bounds, controls with little
    smoothing jump from point to point and are poor starts for finer meshes.
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
    """Solve a programme on other meshes, starting directly from a given solution."""
    old = found.programme
    programme = Programme(old.instance, old.controls, meshes, old.sizes, smoothing, old.loose)
    start = planning.carried(programme, old, found.unknown)
    one = nlp.solve(programme, start, limits, ON_FINER_MESH, near=True)
    return one if one.solved or limits.expired else nlp.solve(programme, start, limits, ITERATIONS)
