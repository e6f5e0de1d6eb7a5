"""The canonical flow, integrated again from the initial state and costates of a solution."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np

from satsym.arrays import Array, distinct
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.passages import passages
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.control.breaks import find_breaks
from satsym.solvers.control.jumps import beside
from satsym.solvers.failures import FAILURES
from satsym.solvers.simulation.extrapolation import integrate

TOLERANCE = 1e-13
"""Error of a step, relative to the size of each component."""

FINEST = 4.0 * np.finfo(float).eps
"""Share of the terms of a rate below which a step cannot tell what they add up to."""

ROUGHLY = 1e-9
"""Error of a step where only the size of what is found matters."""

IDLE_STEPS, IDLE_ERROR = (100, 200), 1e-4
"""RK4 steps of the uncontrolled motion, and what the fewer may change of its distance from the end of the solution,
relative to that: it tells a size."""

NEGLIGIBLE = 1e-3
"""Share of its unit, or of the largest product with its partner, at which something small counts."""

ROUNDED = 1e-13
"""Share of its unit up to which a costate may be made of rounding."""

SMALL_COSTATE, FAINT_COSTATE = 1e-4, 1e-6
"""Share of its unit at which a smaller costate counts: states are rounded, and with them what a costate must be at
the end; the flow from the initial costates is not, but that it depends on the states."""

BREAK_WIDTH = 1e-15
"""Share of the time between the last instant before a break of a schedule and the first one after it, at most."""

STATIONS = 64
"""Times at which the flow is compared with the solver's trajectory."""


@dataclass(frozen=True, eq=False)
class Flow:
    """States and costates along the canonical equations."""

    times: Array
    """Stations, shape (K,), switching times among them."""
    x: Array
    lam: Array
    """States and costates there, shapes (n, K)."""
    cost: float
    """What the whole motion costs, its end included."""


def flow(solution: Solution) -> Flow | None:
    """Integrate from the initial state and costates; ``None`` where the flow is not finite."""
    instance, model = solution.instance, solution.instance.model
    n, p, bounds = len(instance.initial), instance.parameters, instance.control_set.arguments
    start, end = float(solution.times[0]), float(solution.times[-1])
    corners = [t for times in solution.switching_times for t in times if start < t < end]
    scheduled = (start + (end - start) * find_breaks(instance)).ravel()
    stations = distinct(np.concatenate([np.linspace(start, end, STATIONS + 1), corners, scheduled]))
    size = sizes(solution)

    def rates(t: float, y: Array, held: Array | None) -> Array:
        x, lam = tuple(y[:n].tolist()), tuple(y[n : 2 * n].tolist())
        if held is None:
            cost = model.running_cost(t, x, model.control_law(t, x, lam, p, bounds), p)
            return np.array([*model.canonical(t, x, lam, p, bounds), cost])
        u = tuple(beside(instance, t, y[:-1], held).tolist())
        return np.array(
            [*model.dynamics(t, x, u, p), *model.costate_rate(t, x, u, lam, p), model.running_cost(t, x, u, p)]
        )

    values = np.concatenate([instance.initial, solution.lam[:, 0], [0.0]])
    scale = np.append(size, size[:n] @ size[n:])
    found = [values]
    try:
        for held, part in _parts(solution, stations):
            beside_breaks = np.flatnonzero(np.diff(part) <= BREAK_WIDTH * np.abs(part).max()) + 1
            for number, unbroken in enumerate(np.split(part, beside_breaks)):
                found += [found[-1]] if number else []
                if len(unbroken) > 1:
                    pieces = integrate(partial(rates, held=held), unbroken, found[-1], TOLERANCE, scale)
                    found += [piece.end for piece in pieces]
    except FAILURES:
        return None
    stations = distinct(np.concatenate([part for _, part in _parts(solution, stations)]))
    table = np.array(found)
    x, lam = table[:, :n].T, table[:, n : 2 * n].T
    cost = float(table[-1, -1]) + float(model.terminal_cost(end, tuple(x[:, -1].tolist()), p))
    return Flow(stations, x, lam, cost)


def _parts(solution: Solution, stations: Array) -> list[tuple[Array | None, Array]]:
    """Stations up to and from the nodes beside each jump, and between these the control near which H is held least."""
    found: list[tuple[Array | None, Array]] = []
    for one in (one for one in passages(solution) if one.located and not one.last):
        before, after = solution.times[one.node : one.node + 2]
        found += [(None, np.append(stations[stations < before], before))] if before > stations[0] else []
        found.append((one.jump.before, np.array([before, one.jump.time])))
        found.append((one.jump.after, np.array([one.jump.time, after])))
        stations = np.append(after, stations[stations > after])
    return [*found, (None, stations)] if len(stations) > 1 else found


def undriven(solution: Solution) -> Array | None:
    """Where the motion would end without any control, shape (n,); ``None`` where that is nowhere."""
    instance, model = solution.instance, solution.instance.model
    none, p, size = (0.0,) * len(model.spec.controls), instance.parameters, typical(solution)[0]
    start, tf = solution.times[[0, -1]]
    grids = [np.linspace(start, tf, steps + 1) for steps in IDLE_STEPS]
    rest = [np.zeros((len(none), len(nodes))) for nodes in grids]
    moved = [model.forward(t, instance.initial, u, u[:, 1:], p)[0] for t, u in zip(grids, rest, strict=True)]
    ends = [x[:, -1] for x in moved]
    coarse, fine = (np.abs(end - solution.x[:, -1]) / size for end in ends)
    if (np.abs(fine - coarse) <= IDLE_ERROR * fine.max()).all():
        return ends[-1]

    def rates(t: float, x: Array) -> Array:
        return np.array(model.dynamics(t, tuple(x.tolist()), none, p))

    times = np.array([float(solution.times[0]), float(solution.times[-1])])
    try:
        return integrate(rates, times, np.array(instance.initial), ROUGHLY, size)[0].end
    except FAILURES:
        return None


def costing(solution: Solution) -> Callable[[Array, Array], Array]:
    """The canonical rates with that of the cost, functions of times (M,) and values (2n + 1, M)."""
    instance, model, n, m = solution.instance, solution.instance.model, len(solution.x), len(solution.u)
    p, bounds = instance.parameters, instance.control_set.arguments

    def rates(t: Array, y: Array) -> Array:
        x, lam, found = y[:n], y[n:-1], np.empty_like(y)  # given, so that kernels need not find out shapes and types
        u = np.empty((m, *t.shape))
        model.control_law_batch(t, x, lam, p, bounds, out=u)
        model.canonical_batch(t, x, lam, p, bounds, out=found[:-1])
        model.running_cost_batch(t, x, u, p, out=found[-1])
        return found

    return rates


def sizes(solution: Solution) -> Array:
    """Sizes to which errors of steps are held, shape (2n,)."""
    return np.maximum(np.concatenate(typical(solution, FAINT_COSTATE)), _resolved(solution) / STATIONS)


def _resolved(solution: Solution) -> Array:
    """Sizes below which errors would be held to less than the rates are rounded by over the whole time, shape (2n,).

    Steps would shrink for ever in vain: a rate may be a small difference of large terms.
    """
    instance, model = solution.instance, solution.instance.model
    z = np.abs(np.concatenate([solution.x, solution.lam]))
    slopes = model.canonical_jacobian_batch(
        solution.times, solution.x, solution.lam, instance.parameters, instance.control_set.arguments
    )
    terms = np.einsum("ijk,jk->ik", np.abs(slopes), z).max(axis=1)
    found: Array = FINEST / TOLERANCE * abs(float(solution.times[-1] - solution.times[0])) * terms
    return found


@lru_cache(maxsize=256)
def unit_sizes(solution: Solution) -> Array:
    """Units of states and costates, those of the scaled problem, shape (2n,)."""
    found: Array = two_point(solution.instance, float(solution.times[-1] - solution.times[0])).scale.both[:, 0]
    found.flags.writeable = False  # what several conditions ask for is computed once
    return found


@lru_cache(maxsize=256)
def _largest(solution: Solution) -> tuple[Array, Array]:
    """Magnitudes of states and costates along the way, shapes (n,)."""
    state, costate = (np.abs(rows).max(axis=1) for rows in (solution.x, solution.lam))
    state.flags.writeable = costate.flags.writeable = False
    return state, costate


def products(solution: Solution) -> float:
    """The sum of the products of states and costates at their largest: what a share of the states is worth."""
    state, costate = typical(solution, ROUNDED)
    return float(state @ costate)


def typical(solution: Solution, faint: float = SMALL_COSTATE) -> tuple[Array, Array]:
    """Sizes to which errors of states and costates are held, shapes (n,).

    Each its largest magnitude along the way, but what is far below its unit counts as a share of that: states are
    rounded, and what they move is no better. A costate also counts as a share of what the largest product of state
    and costate makes of it.

    Parameters
    ----------
    solution
        Whose.
    faint
        The share of their unit at which smaller costates count.
    """
    n, unit = len(solution.x), unit_sizes(solution)
    largest, costate = _largest(solution)
    state = np.maximum(largest, NEGLIGIBLE * unit[:n])
    product = float((state * costate).max())
    return state, np.maximum(np.maximum(costate, faint * unit[n:]), NEGLIGIBLE * product / state)
