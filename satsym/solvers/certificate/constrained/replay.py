"""Repeated integration of an extremal with boundary arcs from its initial costates, junction times and jumps.

The integration uses extrapolation, independently of the solver's collocation; on boundaries it uses the derived
expression of the multiplier.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.end_form import fixed_states
from satsym.solvers.certificate.reintegration.flow import FAINT_COSTATE, TOLERANCE, Flow, typical
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.constrained.active import field_and_control
from satsym.solvers.constrained.arcs import conditions, gradient
from satsym.solvers.constrained.structure import Active, pressing, stated_arcs, within
from satsym.solvers.failures import FAILURES
from satsym.solvers.simulation.extrapolation import integrate_each, leap

INDEPENDENT = 1e-9
"""Minimum part of a constraint's gradient, relative, that is independent of given states and terminal constraints.
Below it the constraint has no multiplier at the final time."""

SEGMENTS = 32
"""Number of segments into which a motion is cut at nodes, as well as at junctions, for an integration part by part."""

BETWEEN = 4
"""Number of points evaluated between two neighbouring nodes, the second node included."""


@dataclass(frozen=True, eq=False)
class Piece:
    """One arc of the repeated integration."""

    active: Active
    """Constraints that are active on the arc."""
    nodes: slice
    """Indices of the solution's nodes on the arc."""
    z: Array
    """States and costates at the solution's nodes on the arc, shape (2n, N)."""
    times: Array
    dense: Array
    """Times at and between the nodes, shape (M,), and states and costates there, shape (2n, M)."""


@dataclass(frozen=True, eq=False)
class Replay:
    """The extremal as integrated again."""

    pieces: list[Piece]
    jumps: list[dict[int, float]]
    """Multipliers at each junction of arcs, by the index of the constraint."""
    pressed: dict[int, float]
    """Multipliers at the final time, by the index of the constraint that is active there."""
    off_gradient: float
    """Largest part of a jump of the costates that is no linear combination of constraint gradients, relative to the
    costates."""
    z: Array
    """States and costates at the solution's nodes, shape (2n, N)."""
    cost: float
    """Total cost, terminal cost included."""
    end: Array
    """States and costates at the final time, the costates after a jump there."""
    gap: float = 0.0
    """Largest distance between the end of a segment and the node at which the next one begins, relative to the typical
    magnitudes."""

    def meets_a_boundary(self, solution: Solution) -> bool:
        """Return whether a path constraint is active on an arc or at a time; conditions at waypoints do not count."""
        points = {k for point in conditions(solution.instance) for k in point}
        return (
            bool(self.pressed) or any(jump.keys() - points for jump in self.jumps) or any(p.active for p in self.pieces)
        )

    def flow(self, solution: Solution) -> Flow:
        """Return states and costates as a flow, with the costates at the final time after a jump there."""
        z, n = np.column_stack([self.z[:, :-1], self.end]), len(solution.x)
        return Flow(solution.times, z[:n], z[n:], self.cost)


def replay(solution: Solution, in_segments: bool = False, most: float = np.inf) -> Replay | None:
    """Integrate an extremal again; ``None`` if the motion is not finite or its events do not match its nodes.

    Parameters
    ----------
    in_segments
        Whether arcs, and segments of arcs, begin at the solution's nodes instead of at the ends of the preceding ones,
        so that rounding errors do not grow along the whole motion.
    most
        Distance from the solution at the nodes, relative to the typical magnitudes, beyond which the integration stops
        at the end of an arc and ``None`` is returned.
    """
    n, arcs = len(solution.x), stated_arcs(solution)
    breaks = np.flatnonzero(np.diff(solution.times) == 0.0)
    if len(breaks) != len(within(solution)):
        return None
    edges = [0, *(breaks + 1).tolist(), len(solution.times)]
    sizes, known = np.concatenate(typical(solution, FAINT_COSTATE)), np.concatenate([solution.x, solution.lam])
    value, cost, pieces, jumps, off, gap = known[:, 0], 0.0, [], [], 0.0, 0.0
    try:
        for k, active in enumerate(arcs):
            nodes = slice(edges[k], edges[k + 1])
            parts = _parts(nodes, solution.times) if in_segments else [nodes]
            starts = np.column_stack([value, *(known[:, part.start] for part in parts[1:])])
            if in_segments and k > 0:
                gap = max(gap, float((np.abs(value - known[:, nodes.start]) / sizes).max()))
                starts[:, 0] = known[:, nodes.start]
            found, spent = _integrated(solution, active, parts, starts, sizes)
            for one, after in zip(found, starts.T[1:], strict=False):
                gap = max(gap, float((np.abs(one.z[:, -1] - after) / sizes).max()))
            pieces.append(_joined(found, nodes))
            if float((np.abs(pieces[-1].z - known[:, nodes]).max(axis=1) / sizes).max()) > most:
                return None
            cost += spent
            value = pieces[-1].z[:, -1].copy()
            if k < len(breaks):
                along = jumping(solution, k, active, arcs[k + 1])
                jump, left = _jump(solution, along, int(breaks[k]), sizes)
                jumps.append(jump)
                off = max(off, left)
                value[n:] -= _push(solution, jump, float(solution.times[breaks[k]]), value)
    except (*FAILURES, np.linalg.LinAlgError):
        return None
    pressed, end = _pressed(solution, pressing(solution), value), value.copy()
    end[n:] -= _push(solution, pressed, float(solution.times[-1]), end)
    last = float(solution.times[-1]), tuple(end[:n].tolist()), solution.instance.parameters
    total, z = cost + float(solution.instance.model.terminal_cost(*last)), np.concatenate([p.z for p in pieces], axis=1)
    return Replay(pieces, jumps, pressed, off, z, total, end, gap)


def _parts(nodes: slice, times: Array) -> list[slice]:
    """Divide an arc at nodes into parts; each part includes the node at which it ends."""
    whole, lasting = times[-1] - times[0], times[nodes.stop - 1] - times[nodes.start]
    count = min(max(1, round(SEGMENTS * lasting / whole)), nodes.stop - nodes.start - 1)
    edges = np.linspace(nodes.start, nodes.stop - 1, count + 1).round().astype(int).tolist()
    return [slice(a, b + 1) for a, b in pairwise(edges)]


def _joined(parts: list[Piece], nodes: slice) -> Piece:
    """Join parts of an arc; where two parts meet, the end of the earlier one is kept."""
    first, *others = parts
    z = np.concatenate([first.z, *(part.z[:, 1:] for part in others)], axis=1)
    times = np.concatenate([first.times, *(part.times[1:] for part in others)])
    dense = np.concatenate([first.dense, *(part.dense[:, 1:] for part in others)], axis=1)
    return Piece(first.active, nodes, z, times, dense)


def jumping(solution: Solution, junction: int, before: Active, after: Active) -> list[int]:
    """Return the indices of the constraints along whose gradients costates may jump at a junction of two arcs.

    These are constraints of order two or more that are active there, and conditions of a waypoint that is passed there.
    """
    spec = solution.instance.model.spec.path_constraints
    names, names_of = ([one.name for one in ones] for ones in (spec, solution.instance.model.spec.interior))
    met = within(solution)[junction]
    passed = [names_of.index(one.name) for one in met if one.kind == "interior"]
    if passed:
        return list(conditions(solution.instance)[passed[0]])
    own = {names.index(one.name) for one in met if one.kind == "touch" or spec[names.index(one.name)].order > 1}
    return sorted(own.union(k for k in before if k in after and spec[k].order > 1))


def _jump(solution: Solution, along: list[int], node: int, sizes: Array) -> tuple[dict[int, float], float]:
    """Return the multipliers that best fit the jump of the solution's costates, and the relative remainder."""
    n, place = len(solution.x), slice(node, node + 1)
    change = solution.lam[:, node] - solution.lam[:, node + 1]
    here = solution.times[place], solution.x[:, place], solution.u[:, place]
    push = np.array([gradient(solution.instance, k, *here)[:, 0] for k in along])
    zeta = np.linalg.lstsq(push.T, change, rcond=None)[0] if along else np.zeros(0)
    left = float((np.abs(change - zeta @ push) / sizes[n:]).max())
    return dict(zip(along, zeta.tolist(), strict=True)), left


def _push(solution: Solution, multipliers: dict[int, float], time: float, value: Array) -> Array:
    """Return the change of the costates, shape (n,), caused by given multipliers at one time."""
    n, t = len(solution.x), np.array([time])
    parts = [zeta * gradient(solution.instance, k, t, value[:n, None])[:, 0] for k, zeta in multipliers.items()]
    return np.asarray(sum(parts, np.zeros(n)))


def _pressed(solution: Solution, may: Active, value: Array) -> dict[int, float]:
    """Return multipliers of constraints active at the final time, by the residual of the transversality condition.

    Multipliers of terminal constraints take up as much of the residual as they can. A constraint whose effect terminal
    constraints or given states could produce as well has no multiplier here.
    """
    instance, n, t = solution.instance, len(solution.x), float(solution.times[-1])
    final, free, x = final_argument(instance), ~fixed_states(instance), tuple(value[:n].tolist())
    count, bounds = len(instance.model.spec.multipliers), instance.control_set.arguments

    def lacking(lam: Array, nu: Array) -> Array:
        found = instance.model.boundary(t, x, tuple(lam), tuple(nu), instance.parameters, bounds, final)
        return np.array(found)[:n][free]

    none, begun = np.zeros(count), lacking(value[n:], np.zeros(count))
    tied = np.reshape([lacking(value[n:], one) - begun for one in np.eye(count)], (count, len(begun))).T
    found, rows = [], []
    for constraint in may:
        g_x = gradient(instance, constraint, np.array([t]), value[:n, None])[:, 0]
        pushed = lacking(value[n:] - g_x, none) - begun
        own = pushed - tied @ np.linalg.lstsq(tied, pushed, rcond=None)[0] if count else pushed
        if np.linalg.norm(own) > INDEPENDENT * np.linalg.norm(g_x):
            found.append(constraint)
            rows.append(own)
    if not found:
        return {}
    zeta = np.linalg.lstsq(np.array(rows).T, -begun, rcond=None)[0]
    return dict(zip(found, zeta.tolist(), strict=True))


def _integrated(
    solution: Solution, active: Active, parts: list[slice], starts: Array, sizes: Array
) -> tuple[list[Piece], float]:
    """Integrate over parts of an arc, each from its own start, and return them with the running cost of all.

    Parameters
    ----------
    parts
        Indices of the nodes of each part.
    starts
        States and costates at the beginning of each part, shape (2n, M).
    """
    instance, n, times = solution.instance, len(solution.x), solution.times
    model, p = instance.model, instance.parameters

    def rates(t: Array, y: Array) -> Array:
        z = y[:-1]
        along, u = field_and_control(instance, active, t, z)
        cost = np.broadcast_to(model.running_cost_batch(t, z[:n], u, p), t.shape)
        return np.concatenate([along, cost[None]])

    scale = np.append(sizes, sizes[:n] @ sizes[n:])
    begins, ends = (np.array([times[place] for place in places]) for places in _edges(parts))
    passed = integrate_each(rates, begins, ends, np.vstack([starts, np.zeros(len(parts))]), TOLERANCE, scale)
    wanted, known = list[Array](), list[tuple[Array, Array]]()
    for part, motion in zip(parts, passed, strict=True):
        nodes = times[part]
        inner = nodes[:-1, None] + np.diff(nodes)[:, None] * np.arange(1, BETWEEN + 1) / BETWEEN
        wanted.append(np.concatenate([[nodes[0]], inner.ravel()]))
        step = np.clip(np.searchsorted(motion.times, wanted[-1], side="right") - 1, 0, len(motion.times) - 2)
        known.append((motion.times[step], motion.values[step].T))
    before, values = (np.concatenate(rows, axis=-1) for rows in zip(*known, strict=True))
    dense = leap(rates, before, values, np.concatenate(wanted) - before)[:-1]
    found = list[Piece]()
    for part, own, at, motion in zip(parts, _split(dense, wanted), wanted, passed, strict=True):
        own[:, -1] = motion.end[:-1]
        found.append(Piece(active, part, own[:, ::BETWEEN], at, own))
    return found, float(sum(motion.end[-1] for motion in passed))


def _edges(parts: list[slice]) -> tuple[list[int], list[int]]:
    """Return the first and the last node of each part."""
    return [part.start for part in parts], [part.stop - 1 for part in parts]


def _split(dense: Array, wanted: list[Array]) -> list[Array]:
    """Divide the values (2n, K) at all times into those of each part."""
    return np.split(dense, np.cumsum([len(times) for times in wanted])[:-1], axis=1)
