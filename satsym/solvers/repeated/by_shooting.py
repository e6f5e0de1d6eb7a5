"""Repeated solution by compiled shooting: Newton's method on the arcs of the last solution."""

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
"""Continuous arcs, with their error and the number of iterations."""

MOST_CORRECTIONS = 12
"""Largest number of corrections from one initial guess."""

LOST = 30.0
"""Size of a correction above which Newton's method is abandoned."""

NEAR_CORRECTION = 1e-2
"""Size of a correction down to which fewer integration steps suffice, because their error is smaller."""

FEWER = 4
"""Factor by which the number of integration steps is reduced for large corrections."""

CLOSE_CORRECTION = 3e-5
"""Size of a correction below which the number of steps is doubled to estimate the error.

The remaining correction is about its square.
"""


class ByShooting:
    """Repeated solution by shooting for compiled models; see :class:`satsym.solvers.repeated.Means`."""

    name = "shooting"

    def __init__(self) -> None:
        self._good: Arcs | None = None
        self._steps = 1

    def near(self, case: Instance, limits: Limits) -> Extremal | None:
        """Return the extremal near the last successful one, with bounds imposed at once."""
        if self._good is None:
            return None
        return self._kept(self._shot(replace(self._good.problem, instance=case), self._good))

    def straight(self, case: Instance, limits: Limits) -> Extremal | None:
        """Return the extremal found from the straight line, first without bounds, then within them."""
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
        """Return the result of a cold start; if it fails, that of a search for a guess.

        Arcs and steps are chosen anew.
        """
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
        """Return the result of Newton's method from the arcs of a neighbouring problem; ``None`` if it fails."""
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
    """Return whether an extremal is a strict local minimum without bounds."""
    try:
        return negative_directions(arcs.problem, arcs, linearised(arcs)[0]) == 0
    except np.linalg.LinAlgError:
        return False


def _quick_newton(arcs: Arcs, tolerance: float) -> tuple[Arcs, float, int]:
    """Return the result of undamped Newton's method on compiled arcs, for good initial guesses.

    The corrections of all nodes follow from those of the initial costates and of the extra unknowns (condensing), which
    leaves a system of the size of the boundary conditions (Bock and Plitt, A Multiple Shooting Algorithm for Direct
    Solution of Optimal Control Problems, 1984).

    Parameters
    ----------
    arcs
        Initial guess, with a sufficient number of steps.
    tolerance
        Largest error, estimated from twice as many steps (Richardson).

    Returns
    -------
    arcs, error, iterations
        The last arcs, with twice as many steps; their estimated error, infinite if Newton's method failed; and the
        number of corrections.
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
    """Return corrections of nodes, shape (N+1, 2n), and of extra unknowns, and the transition matrices of the arcs.

    Parameters
    ----------
    arcs
        The arcs to be corrected.
    transition
        The transition matrices, shape (N, 2n, 2n), if they are known accurately enough; their integration takes several
        times as long as that of the arcs.
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
    """Return a function that expresses all nodes by the initial unknowns if the arcs are to be continuous.

    ``(nodes, initial, mesh, times, ends, transition, p, bounds, scale) -> field`` is compiled at its first call.
    Variables are scaled, except the ends of arcs and their transition matrices. The columns of the field, shape (N+1,
    2n, k), are the effects of each initial costate, of a free duration, and of closing the gaps between arcs and at the
    initial state.
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
