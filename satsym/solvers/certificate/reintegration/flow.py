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
"""Error tolerance of a step, relative to the magnitude of each component."""

FINEST = 4.0 * np.finfo(float).eps
"""Rounding error of a rate, relative to the sum of the magnitudes of its terms."""

ROUGHLY = 1e-9
"""Error tolerance of a step, relative, if only an order of magnitude is needed."""

IDLE_STEPS, IDLE_ERROR = (100, 200), 1e-4
"""Two numbers of RK4 steps for the uncontrolled motion, and the largest change between their final states, relative to
the distance from the solution's final state, at which the result is accurate enough for an order of magnitude."""

NEGLIGIBLE = 1e-3
"""Minimum magnitude that is attributed to a small state, relative to its unit, and to a small costate, relative to the
largest product of state and costate."""

ROUNDED = 1e-13
"""Magnitude of a costate, relative to its unit, below which it may consist of rounding."""

SMALL_COSTATE, FAINT_COSTATE = 1e-4, 1e-6
"""Minimum magnitudes that are attributed to a small costate, relative to its unit: in conditions at the final time,
where rounding of the states matters, and along the flow, where it matters less."""

BREAK_WIDTH = 1e-15
"""Largest distance, relative to the time, between the last instant before a break of a schedule and the first after
it."""

STATIONS = 64
"""Number of intervals at whose ends the flow is compared with the solver's trajectory."""


@dataclass(frozen=True, eq=False)
class Flow:
    """States and costates along the canonical equations."""

    times: Array
    """Times of the stations, shape (K,), switching times included."""
    x: Array
    lam: Array
    """States and costates at the stations, shapes (n, K)."""
    cost: float
    """Total cost of the motion, terminal cost included."""


def flow(solution: Solution) -> Flow | None:
    """Integrate from the initial state and costates; ``None`` if the flow is not finite."""
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
    """Return stations grouped at jumps of the control, each group with the control that is held near a jump.

    Between the nodes on both sides of a jump the control stays near its value before and after the jump; otherwise the
    control law determines it (``None``).
    """
    found: list[tuple[Array | None, Array]] = []
    for one in (one for one in passages(solution) if one.located and not one.last):
        before, after = solution.times[one.node : one.node + 2]
        found += [(None, np.append(stations[stations < before], before))] if before > stations[0] else []
        found.append((one.jump.before, np.array([before, one.jump.time])))
        found.append((one.jump.after, np.array([one.jump.time, after])))
        stations = np.append(after, stations[stations > after])
    return [*found, (None, stations)] if len(stations) > 1 else found


def undriven(solution: Solution) -> Array | None:
    """Return the final state of the uncontrolled motion, shape (n,); ``None`` if it cannot be computed."""
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
    """Return a function that gives canonical rates and running cost from times (M,) and values (2n + 1, M)."""
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
    """Return the magnitudes that error tolerances of steps are relative to, shape (2n,)."""
    return np.maximum(np.concatenate(typical(solution, FAINT_COSTATE)), _resolved(solution) / STATIONS)


def _resolved(solution: Solution) -> Array:
    """Return magnitudes below which a tolerance would be smaller than the rounding of the rates, shape (2n,).

    A rate may be a small difference of large terms; with a smaller tolerance steps would shrink without limit.
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
    """Return the units of states and costates in the scaled problem, shape (2n,)."""
    found: Array = two_point(solution.instance, float(solution.times[-1] - solution.times[0])).scale.both[:, 0]
    found.flags.writeable = False  # what several conditions ask for is computed once
    return found


@lru_cache(maxsize=256)
def _largest(solution: Solution) -> tuple[Array, Array]:
    """Return the largest magnitudes of states and costates along the motion, shapes (n,)."""
    state, costate = (np.abs(rows).max(axis=1) for rows in (solution.x, solution.lam))
    state.flags.writeable = costate.flags.writeable = False
    return state, costate


def products(solution: Solution) -> float:
    """Return the sum of the products of the largest states and costates, a scale of the cost."""
    state, costate = typical(solution, ROUNDED)
    return float(state @ costate)


def typical(solution: Solution, faint: float = SMALL_COSTATE) -> tuple[Array, Array]:
    """Return the magnitudes that errors of states and costates are compared with, shapes (n,).

    Each is the largest magnitude along the motion, but at least a fraction of its unit, since states are rounded. A
    costate also has at least the magnitude that the largest product of state and costate implies.

    Parameters
    ----------
    solution
        The solution.
    faint
        Minimum magnitude of a costate, as a fraction of its unit.
    """
    n, unit = len(solution.x), unit_sizes(solution)
    largest, costate = _largest(solution)
    state = np.maximum(largest, NEGLIGIBLE * unit[:n])
    product = float((state * costate).max())
    return state, np.maximum(np.maximum(costate, faint * unit[n:]), NEGLIGIBLE * product / state)
