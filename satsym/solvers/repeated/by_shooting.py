"""Again and again by compiled shooting: Newton's method on the arcs of the last answer."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.lapack import lapack
from satsym.solvers.cold_start import paths
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.iteration import Limits
from satsym.solvers.search.solving import guessed
from satsym.solvers.shooting.arcs import MOST_STEPS, Arcs
from satsym.solvers.shooting.compiled import Compiled, Numbers, integrator, njit, packed
from satsym.solvers.shooting.newton import linearised, within_domain
from satsym.solvers.shooting.runge_kutta import ORDER
from satsym.solvers.shooting.solving import ACCURACY, converged, extremal, without_guess
from satsym.status import Status

Shot = tuple[Arcs, float, int]
"""Arcs that meet, with their error and the iterations."""

MOST_CORRECTIONS = 12
"""Most corrections until a start is given up."""

LOST = 30.0
"""Size of a correction that leads nowhere."""

NEAR_CORRECTION = 1e-2
"""Size of a correction down to which few steps do: their error is below what is left to correct."""

FEWER = 4
"""Factor by which those steps are fewer than the given ones."""

CLOSE_CORRECTION = 3e-5
"""Size of a correction after which twice as many steps show the error: what is left to correct is about its square."""


class ByShooting:
    """See :class:`satsym.solvers.repeated.Means`; for instances whose model is compiled."""

    name = "shooting"

    def __init__(self) -> None:
        self._good: Arcs | None = None
        self._steps = 1

    def near(self, case: Instance, limits: Limits) -> Extremal | None:
        """The extremal near the last good one, within the bounds at once."""
        if self._good is None:
            return None
        return self._kept(self._shot(replace(self._good.problem, instance=case), self._good))

    def straight(self, case: Instance, limits: Limits) -> Extremal | None:
        """First without bounds, then within them."""
        if self._good is None or case.tf is None:
            return None
        problem, like = replace(self._good.problem, instance=case), self._good
        free = problem.relaxed(float("inf"))
        states = paths.first(free)(like.mesh)
        found = self._shot(
            free, replace(like, nodes=np.append(states, np.zeros_like(states), axis=0), theta=free.theta)
        )
        if found is None or not _minimum(found[0]):
            return None
        return self._kept(self._shot(problem, found[0]) if problem.control_set.bounded else found)

    def cold(self, case: Instance, limits: Limits) -> Extremal:
        """A cold start, which also decides on arcs and steps; from the search where that leads nowhere."""
        found = without_guess(case, limits)
        if found.status is Status.NOT_CONVERGED:
            found = without_guess(guessed(case, limits), limits)
        if found.status.answered and isinstance(found.path, Arcs):
            self._good, self._steps = found.path, max(found.path.steps // 2, 1)
        return found

    def full(self, found: Extremal, limits: Limits) -> Extremal:
        """Compute an extremal again so that the times at which it meets bounds are among its nodes.

        Compiled arcs step onto these times, but do not return them.
        """
        if not found.problem.control_set.bounded:
            return found
        return extremal(found.problem, found.path, limits)

    def _shot(self, problem: TwoPoint, start: Arcs) -> Shot | None:
        """Newton on arcs of a neighbouring problem."""
        tolerance = min(ACCURACY, problem.instance.solver.tolerance)
        arcs, error, iterations = _quick_newton(replace(start, problem=problem, steps=self._steps), tolerance)
        sound = error <= tolerance and (arcs.nodes[list(problem.positive)] > 0.0).all()
        return (arcs, error, iterations) if sound else None

    def _kept(self, found: Shot | None) -> Extremal | None:
        if found is None:
            return None
        self._good = found[0]
        return converged(*found)


def _minimum(arcs: Arcs) -> bool:
    """Whether an extremal is a strict local minimum without bounds."""
    try:
        return negative_directions(arcs.problem, arcs, linearised(arcs)[0]) == 0
    except np.linalg.LinAlgError:
        return False


def _quick_newton(arcs: Arcs, tolerance: float) -> tuple[Arcs, float, int]:
    """Newton's method for good starts, undamped, on compiled arcs; quick to say that a start was not good enough.

    The corrections of all nodes follow from those of the initial costates and of the extra unknowns (condensing), which
    leaves a system as small as the boundary (Bock and Plitt, A Multiple Shooting Algorithm for Direct Solution of
    Optimal Control Problems, 1984).

    Parameters
    ----------
    arcs
        Where to start, with enough steps.
    tolerance
        Largest error, estimated from twice as many steps (Richardson).

    Returns
    -------
    arcs, error, iterations
        The last arcs, with twice as many steps; their estimated error, infinite where Newton failed; corrections.
    """
    enough, shown, transition = arcs.steps, False, None
    arcs = arcs.with_steps(max(enough // FEWER, 1))
    for iteration in range(1, MOST_CORRECTIONS + 1):
        try:
            # what twice as many steps would say of the arcs' derivatives changes a correction that is next to nothing
            nodes, theta, transition = _correction(arcs, transition if shown else None)
        except np.linalg.LinAlgError:
            break
        arcs = arcs.moved(nodes, theta, within_domain(arcs, nodes, theta))
        size = arcs.size(nodes, theta)
        error = size / (2**ORDER - 1)
        if not size < LOST or arcs.steps > 2 * MOST_STEPS:
            break
        if shown and error <= tolerance:
            return arcs, error, iteration
        if arcs.steps < enough and size < NEAR_CORRECTION:
            arcs = arcs.with_steps(enough)
            continue
        shown = arcs.steps >= enough and size < CLOSE_CORRECTION
        if shown:
            arcs = arcs.with_steps(2 * arcs.steps)
    return arcs, float("inf"), iteration


def _correction(arcs: Arcs, transition: Array | None) -> tuple[Array, Array, Array]:
    """Corrections of the nodes, shape (N+1, 2n), and of the extra unknowns; how arcs end by where they begin.

    Parameters
    ----------
    transition
        The latter, (N, 2n, 2n), if it is known well enough: integrating it takes several times as long as the arcs.
    """
    problem, case, n = arcs.problem, arcs.problem.instance, arcs.problem.states
    nodes, scale = np.ascontiguousarray(arcs.nodes.T), problem.scale.both[:, 0]
    times = case.t0 + problem.elapsed(arcs.theta) * arcs.mesh
    given = case.parameters, problem.control_set.arguments
    ends, _, varied = integrator(case.model, transition is None)(times, nodes * scale, arcs.steps, *given)
    transition = varied if transition is None else transition
    field = _spread(case.model, problem.free_time)(
        nodes, problem.initial, arcs.mesh, times, ends, transition, *given, scale
    )
    residual, by_end, by_theta = problem.ending(arcs.nodes[:, -1], arcs.theta)
    slopes = by_end @ field[-1]
    matrix = np.concatenate([slopes[:, :n], by_theta], axis=1)
    matrix[:, len(matrix) - problem.free_time :] += slopes[:, n:-1]
    *_, found, singular = lapack().dgesv(matrix, -residual - slopes[:, -1])
    if singular:
        raise np.linalg.LinAlgError("singular")
    start = np.concatenate([found[:n], found[len(found) - problem.free_time :], [1.0]])
    return field @ start, found[n:], transition


@lru_cache(maxsize=16)
def _spread(model: Kernels, free_time: bool) -> Compiled:
    """How nodes follow what is unknown at the start if all arcs are to meet, compiled at its first call.

    ``(nodes, initial, mesh, times, ends, transition, p, bounds, scale) -> field`` in scaled variables, but for the ends
    of arcs and how these follow their beginnings: the columns of the field, shape (N+1, 2n, k), are what each initial
    costate does, what the duration does where it is free, and what closes the gaps between the arcs and at the start.
    """
    n = len(model.spec.states)
    rows, last = 2 * n, n + free_time
    vector, rates = packed(n), model.functions["canonical"]

    @njit()
    def field(
        nodes: Array,
        initial: Array,
        mesh: Array,
        times: Array,
        ends: Array,
        transition: Array,
        p: Numbers,
        bounds: Numbers,
        scale: Array,
    ) -> Array:
        found, begun = np.zeros((len(mesh), rows, last + 1)), np.zeros(rows)
        for j in range(n):
            found[0, n + j, j] = 1.0
            found[0, j, last] = initial[j] - nodes[0, j]
        for i in range(len(mesh) - 1):
            if free_time:
                there = nodes[i] * scale
                now = rates(times[i], vector(there, 0, 1), vector(there, n, 1), p, bounds)
                then = rates(times[i + 1], vector(ends[i], 0, 1), vector(ends[i], n, 1), p, bounds)
                for j in range(rows):
                    begun[j] = mesh[i] * now[j] / scale[j]
                    found[i + 1, j, n] = mesh[i + 1] * then[j] / scale[j]
            for j in range(rows):
                found[i + 1, j, last] = ends[i, j] / scale[j] - nodes[i + 1, j]
                for m in range(rows):
                    slope = transition[i, j, m] * scale[m] / scale[j]
                    for k in range(last + 1):
                        found[i + 1, j, k] += slope * found[i, m, k]
                    if free_time:
                        found[i + 1, j, n] -= slope * begun[m]
        return found

    return field
