"""An extremal with boundary arcs, integrated again from its initial costates, its junctions and its jumps alone.

By extrapolation, of which the solver's collocation knows nothing; on boundaries with the multiplier as it was derived.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.certificate.end_form import fixed_states
from satsym.solvers.certificate.flow import FAINT, TOLERANCE, Flow, typical
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.constrained.arcs import control, field, gradient, holds_control
from satsym.solvers.constrained.structure import FREE, pressing, stated_arcs, within
from satsym.solvers.failures import FAILURES
from satsym.solvers.simulation.extrapolation import integrate, leap

INDEPENDENT = 1e-9
"""Least share of a constraint's gradient that neither given states nor terminal constraints make up."""

BETWEEN = 4
"""Places looked at between two nodes, the second of these included."""


@dataclass(frozen=True, eq=False)
class Piece:
    """An arc of the replay."""

    constraint: int
    """On whose boundary it runs, or that it runs on none."""
    nodes: slice
    """The solution's nodes on it."""
    z: Array
    """States and costates at these, shape (2n, N)."""
    times: Array
    dense: Array
    """Places between nodes, shape (M,), and values there, shape (2n, M)."""


@dataclass(frozen=True, eq=False)
class Replay:
    """The extremal again."""

    pieces: list[Piece]
    jumps: Array
    """Multipliers at the events before the end, shape (E,)."""
    pressed: float | None
    """The multiplier at the end, where a constraint may push there."""
    off_gradient: float
    """Largest part of a jump that no multiple of the constraint's gradient makes up, relative to the costates."""
    z: Array
    """At the solution's nodes, shape (2n, N)."""
    cost: float
    """Of the whole motion, the terminal cost included."""
    end: Array
    """States and costates at the end, the latter after a jump there."""

    def flow(self, solution: Solution) -> Flow:
        """As conditions at the end have it."""
        z, n = np.column_stack([self.z[:, :-1], self.end]), len(solution.x)
        return Flow(solution.times, z[:n], z[n:], self.cost)


def replay(solution: Solution) -> Replay | None:
    """Integrate again; ``None`` where the motion is not finite, or events do not fit the nodes."""
    instance, n, arcs = solution.instance, len(solution.x), stated_arcs(solution)
    breaks = np.flatnonzero(np.diff(solution.times) == 0.0)
    if len(breaks) != len(events := within(solution)):
        return None
    edges = [0, *(breaks + 1).tolist(), len(solution.times)]
    sizes = np.concatenate(typical(solution, FAINT))
    value, cost, pieces, jumps, off = np.concatenate([solution.x[:, 0], solution.lam[:, 0]]), 0.0, [], [], 0.0
    try:
        for k, constraint in enumerate(arcs):
            nodes = slice(edges[k], edges[k + 1])
            piece, spent = _piece(instance, constraint, solution.times[nodes], value, sizes, nodes)
            pieces.append(piece)
            cost += spent
            value = piece.z[:, -1].copy()
            if k < len(events):
                zeta, left = _jump(solution, k, int(breaks[k]), sizes)
                jumps.append(zeta)
                off = max(off, left)
                which = _of_event(solution, k)
                t = np.array([events[k].t])
                value[n:] -= zeta * gradient(instance, which, t, value[:n, None])[:, 0]
    except FAILURES:
        return None
    last, end = pressing(solution), value.copy()
    pressed = None if last == FREE else _pressed(solution, last, value)
    if pressed is not None:
        end[n:] -= pressed * gradient(instance, last, solution.times[-1:], end[:n, None])[:, 0]
    final = float(solution.times[-1])
    total = cost + float(instance.model.terminal_cost(final, tuple(end[:n].tolist()), instance.parameters))
    return Replay(pieces, np.array(jumps), pressed, off, np.concatenate([p.z for p in pieces], axis=1), total, end)


def _of_event(solution: Solution, k: int) -> int:
    names = [one.name for one in solution.instance.model.spec.path_constraints]
    return names.index(within(solution)[k].name)


def _jump(solution: Solution, event: int, node: int, sizes: Array) -> tuple[float, float]:
    """The multiplier of the solution's jump, and what of the jump it leaves; none where the order is one."""
    instance, n, which = solution.instance, len(solution.x), _of_event(solution, event)
    change = solution.lam[:, node] - solution.lam[:, node + 1]
    if holds_control(instance, which):
        return 0.0, float((np.abs(change) / sizes[n:]).max())
    g_x = gradient(instance, which, solution.times[node : node + 1], solution.x[:, node : node + 1])[:, 0]
    lasts = instance.model.spec.path_constraints[which].order > 1 or within(solution)[event].kind == "touch"
    zeta = float(change @ g_x / (g_x @ g_x)) if lasts else 0.0
    return zeta, float((np.abs(change - zeta * g_x) / sizes[n:]).max())


def _pressed(solution: Solution, constraint: int, value: Array) -> float | None:
    """The multiplier with which a constraint pushes at the end, by what transversality lacks.

    Multipliers of terminal constraints make up what they can; where they, or given states, could make up all that the
    constraint brings about, there is none.
    """
    instance, n, t = solution.instance, len(solution.x), float(solution.times[-1])
    final, free, x = final_argument(instance), ~fixed_states(instance), tuple(value[:n].tolist())
    count, bounds = len(instance.model.spec.multipliers), instance.control_set.arguments

    def lacking(lam: Array, nu: Array) -> Array:
        found = instance.model.boundary(t, x, tuple(lam), tuple(nu), instance.parameters, bounds, final)
        return np.array(found)[:n][free]

    none, g_x = np.zeros(count), gradient(instance, constraint, np.array([t]), value[:n, None])[:, 0]
    begun = lacking(value[n:], none)
    tied = np.reshape([lacking(value[n:], one) - begun for one in np.eye(count)], (count, len(begun))).T
    pushed = lacking(value[n:] - g_x, none) - begun
    own = pushed - tied @ np.linalg.lstsq(tied, pushed, rcond=None)[0] if count else pushed
    if not np.linalg.norm(own) > INDEPENDENT * np.linalg.norm(g_x):
        return None
    return float(-(own @ begun) / (own @ own))


def _piece(
    instance: Instance, constraint: int, nodes: Array, start: Array, sizes: Array, place: slice
) -> tuple[Piece, float]:
    """Integrate an arc, and leap from its steps to the nodes and between them."""
    n, model, p = len(instance.initial), instance.model, instance.parameters

    def rates(t: Array, y: Array) -> Array:
        z = y[:-1]
        u = control(instance, constraint, t, z)
        cost = np.broadcast_to(model.running_cost_batch(t, z[:n], u, p), t.shape)
        return np.concatenate([field(instance, constraint, t, z), cost[None]])

    scale = np.append(sizes, sizes[:n] @ sizes[n:])
    one = _single(rates)
    (found,) = integrate(one, np.array([nodes[0], nodes[-1]]), np.append(start, 0.0), TOLERANCE, scale)
    inner = nodes[:-1, None] + np.diff(nodes)[:, None] * np.arange(1, BETWEEN + 1) / BETWEEN
    wanted = np.concatenate([[nodes[0]], inner.ravel()])
    step = np.clip(np.searchsorted(found.times, wanted, side="right") - 1, 0, len(found.times) - 2)
    values = leap(rates, found.times[step], found.values[step].T, wanted - found.times[step])
    values[:, -1] = found.end
    piece = Piece(constraint, place, values[:-1, ::BETWEEN], wanted, values[:-1])
    return piece, float(found.end[-1])


def _single(rates: Callable[[Array, Array], Array]) -> Callable[[float, Array], Array]:
    """Rates at one time."""
    return lambda t, y: rates(np.array([t]), y[:, None])[:, 0]
