"""The second variation with fixed active arcs: whether it is positive for all variations that keep these arcs.

Variations keep the given ends, and g_x dx = 0 along boundary arcs of constraints on states and at touch points; while a
constraint that involves the control is active, the control follows from it. A touch point of order two adds - zeta
(d/dt g_x dx)^2 / g'' with g'' < 0 to the quadratic form (Bonnans and Hermant, No-gap second-order optimality
conditions, Mathematical Programming 117, 2009), since its time moves with the variation. Boundary arcs and junctions,
also one at the final time, add the curvature of g times its multiplier. Time is stretched between waypoints and, if the
final time is free and no constraint is active there, over the whole motion; a waypoint adds the curvature of its
conditions times their multipliers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solution import Solution
from satsym.solvers.certificate.constrained.passing import places
from satsym.solvers.certificate.constrained.replay import Piece, Replay
from satsym.solvers.certificate.second_variation import Arc, Met, quadratic, scaled_units
from satsym.solvers.constrained.active import control, field, multipliers
from satsym.solvers.constrained.arcs import conditions, gradient, holds_control, missed
from satsym.solvers.constrained.equations import hamiltonian
from satsym.solvers.constrained.structure import FREE, within

MESH, FEWEST = 160, 4
"""Number of intervals on which variations of the controls are constant, and minimum number of intervals of an arc."""

DIFFERENCE = 1e-5
"""Step of the finite difference with respect to time, as a fraction of the length of an arc."""


def curvature(solution: Solution, again: Replay) -> float:
    """Return the smallest eigenvalue of the second variation relative to the form of the control cost alone.

    The latter also has a unit term for a variation of the final time by the duration.
    """
    state, cost = scaled_units(solution)
    passed, arcs, groups = places(solution), list[Arc](), list[int]()
    for k, piece in enumerate(again.pieces):
        arcs.append(_arc(solution.instance, piece, _met_at_end(solution, again, k), state, cost))
        groups.append(sum(place < k for place in passed))
    pushed = np.column_stack([solution.lam[:, :-1], again.end[len(solution.x) :]])  # after the jump at the end
    return quadratic(replace(solution, lam=pushed), arcs, state, cost, groups).steepest()[0]


def _arc(instance: Instance, piece: Piece, at_end: list[tuple[Array, Array]], state: Array, cost: float) -> Arc:
    n, lasting = len(instance.initial), float(piece.times[-1] - piece.times[0])
    count = max(FEWEST, int(np.ceil(MESH * lasting / state[-1])))
    t = np.linspace(piece.times[0], piece.times[-1], 2 * count + 1)
    z = np.array([np.interp(t, piece.times, row) for row in piece.dense])
    held = tuple(k for k in piece.active if holds_control(instance, k))
    eta = dict(zip(piece.active, multipliers(instance, piece.active, t, z), strict=True))
    kept = {k: push for k, push in eta.items() if k not in held}

    def rates(v: NDArray[Any]) -> NDArray[Any]:
        """Return rates of states and costates with fixed multipliers of the constraints on states."""
        found = np.array(field(instance, held, v[-1], v[:-1]))
        for k, push in kept.items():
            found[n:] -= push * gradient(instance, k, v[-1], v[:n])
        return found

    here, step = np.concatenate([z, t[None]]), DIFFERENCE * lasting
    h: list[Array] = [np.zeros(len(t))] * 3
    if not instance.model.spec.autonomous:
        h = [_by_time(instance, piece, t + k * step, z) for k in (-1, 0, 1)]
    rows = {k: gradient(instance, k, t, z[:n]) for k in kept}
    met = {
        place: Met(np.array([np.append(row[:, 2 * place], 0.0) for row in rows.values()]) * state)
        for place in (range(1, count + 1) if rows else ())
    }
    if at_end:
        along = met[count].kept if count in met else np.zeros((0, n + 1))
        ties = np.concatenate([along, *(row * state for row, _ in at_end)])
        met[count] = Met(ties, sum(curved for _, curved in at_end) * state[:, None] * state / cost)
    slopes, by_time = np.moveaxis(_slopes(rates, here), -1, 0), (h[1], (h[2] - h[0]) / (2.0 * step))
    controls = len(instance.model.spec.controls)
    return Arc.of(t, slopes, np.real(rates(here)), by_time, state, cost, count, met, controls)


def _by_time(instance: Instance, piece: Piece, t: Array, z: Array) -> Array:
    """Return the partial derivative of H with respect to explicit time along an arc, shape (N,)."""
    ahead: NDArray[Any] = t + 1j * COMPLEX_STEP
    return np.broadcast_to(np.imag(hamiltonian(instance, piece.active, ahead, z)) / COMPLEX_STEP, t.shape)


def _met_at_end(solution: Solution, again: Replay, arc: int) -> list[tuple[Array, Array]]:
    """Return the linear conditions and quadratic forms, in states and time, at the end of an arc.

    At the final time these come from the constraints that are active there.
    """
    instance, spec = solution.instance, solution.instance.model.spec.path_constraints
    names, piece, n = [one.name for one in spec], again.pieces[arc], len(solution.x)
    if arc == len(again.pieces) - 1:
        end = piece.times[-1:], again.end[:, None]
        return [_met(instance, k, *end, zeta, touches=False) for k, zeta in again.pressed.items()]
    group, jumps = within(solution)[arc], again.jumps[arc]
    at, touched = (piece.times[-1:], piece.z[:, -1:]), {event.name for event in group if event.kind == "touch"}
    # what holds a control is kept by its control alone
    own = {names.index(event.name) for event in group if event.kind != "interior"} | {k for k in jumps if k < len(spec)}
    met = [_met(instance, k, *at, jumps.get(k, 0.0), names[k] in touched) for k in sorted(own) if spec[k].order > 0]
    if arc in (passed := places(solution)):
        which = conditions(instance)[passed.index(arc)]

        def slopes(y: NDArray[Any]) -> NDArray[Any]:
            by_x = [gradient(instance, k, y[-1], y[:-1]) for k in which]
            by_t = missed(instance, which, y[-1], y[:-1])[1]
            return np.concatenate([np.array(by_x), by_t[:, None]], axis=1)

        here = np.concatenate([at[1][:n], at[0][None]])
        pi = np.array([jumps[k] for k in which])
        curved = _slopes(lambda y: np.einsum("c,cjN->jN", pi, slopes(y)), here)[..., 0]
        met.append((np.real(slopes(here))[..., 0], (curved + curved.T) / 2.0))
    return met


def _met(instance: Instance, constraint: int, t: Array, z: Array, zeta: float, touches: bool) -> tuple[Array, Array]:
    """Return g_x at the junction of a constraint, and the quadratic form that the junction adds."""
    model, p, n = instance.model, instance.parameters, len(instance.initial)
    x, found = z[:n], np.zeros((n + 1, n + 1))
    u = control(instance, FREE, t, z)

    def rates(y: Array) -> Array:
        return np.asarray(model.path_rates_batch(t, y, u.astype(y.dtype), p)).reshape(-1, 2, 1)[constraint]

    found[:n, :n] = zeta * _slopes(lambda y: gradient(instance, constraint, t, y), x)[..., 0]
    if touches:
        second, rate = float(rates(x)[1, 0]), _slopes(lambda y: rates(y)[:1], x)[0, :, 0]
        found[:n, :n] += np.outer(rate, rate) * (-zeta / second if second < 0.0 else -np.inf)
    return np.append(gradient(instance, constraint, t, x)[:, 0], 0.0)[None], found


def _slopes(function: Callable[[Any], NDArray[Any]], at: Array) -> Array:
    """Return derivatives of a function by every component of its argument, shape (rows, d, N), by complex steps."""
    columns = []
    for j in range(len(at)):
        moved = at.astype(complex)
        moved[j] += 1j * COMPLEX_STEP
        columns.append(np.imag(function(moved)) / COMPLEX_STEP)
    return np.stack(columns, axis=1)
