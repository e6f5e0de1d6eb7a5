"""Necessary conditions and the Legendre-Clebsch condition, measured along the canonical flow."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Check, Solution
from satsym.solvers.certificate.conclusion import BOUNDARY, HAMILTONIAN, OF_FLOW, STATIONARITY
from satsym.solvers.certificate.end_form import final_values, fixed_states, multipliers
from satsym.solvers.certificate.reintegration.flow import (
    FAINT_COSTATE,
    NEGLIGIBLE,
    Flow,
    costing,
    products,
    typical,
    undriven,
    unit_sizes,
)
from satsym.solvers.certificate.reintegration.segments import Segments, values
from satsym.solvers.collocation.elimination import Matching
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.control.slopes import undecided
from satsym.solvers.failures import FAILURES
from satsym.solvers.simulation.extrapolation import leap

RESIDUAL, DEFECT, STATIONARY, DRIFT, COST = 1e-9, 1e-7, 1e-8, 1e-9, 1e-8
"""Largest admissible boundary residual, defect, violation of stationarity, change of H and error of the stated cost,
all relative."""

CANCELLED = 1e-5
"""Fraction of the products of states and costates below which a cost counts as a difference of larger terms, or as
rounding, and is compared with these products instead."""

STRICT = 1e-12
"""Minimum slope of H beyond an active control bound, relative to the largest slope with respect to this control, for
which the control counts as strictly held at the bound."""


def boundary_residual(solution: Solution, flow: Flow, more: float = 0.0) -> float:
    """Return the largest residual of the final conditions along the flow, each relative to its typical magnitude.

    A given final state is compared with its typical magnitude or, if the control moves the final state by less, with
    that amount, but not with less than rounding allows. A costate is compared with its typical magnitude and with the
    terms of the gradient of the terminal cost, which may nearly cancel: an error of the state then counts alike in
    both. A terminal constraint is compared with the terms that the states contribute to it, and H with its terms for
    costates of typical magnitude, since at the top of an ascent each term of H vanishes.

    Parameters
    ----------
    more
        Excess of H at the final time over its value under the control law.
    """
    instance, model = solution.instance, solution.instance.model
    n = len(instance.initial)
    tf, x, lam = float(flow.times[-1]), tuple(flow.x[:, -1].tolist()), tuple(flow.lam[:, -1].tolist())
    final = final_argument(instance)
    nu, residual = multipliers(instance, tf, x, lam)
    fixed, (state, costate) = fixed_states(instance), typical(solution)
    slopes = np.array(
        model.boundary_jacobian(tf, x, lam, nu, instance.parameters, instance.control_set.arguments, final)
    )
    gradient = np.abs(slopes.reshape(len(residual), -1)[:-1, :n]) @ state
    smallest = np.minimum(state, NEGLIGIBLE * unit_sizes(solution)[:n])
    moved = _moved(flow, state, undriven(solution))
    rows = np.where(fixed, np.maximum(state * moved, smallest), np.maximum(costate, gradient[:n]))
    found = np.abs(residual[:n]) / rows
    constraints = np.abs(residual[n:-1]) / np.maximum(gradient[n:], 1e-300)
    parts = [*found, *constraints]
    if instance.tf is None:
        rates = np.array(model.canonical(tf, x, lam, instance.parameters, instance.control_set.arguments))
        parts.append(abs(residual[-1] + more) / max(float(costate @ np.abs(rates[:n])), 1e-300))
    return float(max(parts))


def _moved(flow: Flow, state: Array, without: Array | None) -> float:
    """Return how far the control moves the final state, relative to the magnitudes of the states, at most 1."""
    if without is None:
        return 1.0
    return float(np.minimum((np.abs(flow.x[:, -1] - without) / state).max(), 1.0))


def dynamics_defect(solution: Solution, flow: Flow) -> float:
    """Return the largest distance of the solver's states and costates from the flow, relative to their magnitudes.

    Magnitudes as returned by :func:`typical`. Only those nodes are compared that are stations of the flow, and both
    ends.
    """
    here = np.clip(np.searchsorted(flow.times, solution.times), 1, len(flow.times) - 1)
    here -= solution.times - flow.times[here - 1] < flow.times[here] - solution.times
    again = np.append(False, np.diff(solution.times) == 0.0)  # the second of two nodes at one time: after a jump
    here[again] = np.searchsorted(flow.times, flow.times[here[again]], side="right") - 1
    same = np.abs(flow.times[here] - solution.times) <= 1e-12 * max(abs(float(flow.times[-1])), 1e-300)
    state, costate = typical(solution, FAINT_COSTATE)
    parts = [
        (np.abs(mine[:, here[same]] - theirs[:, same]).max(axis=1) / size).max()
        for mine, theirs, size in ((flow.x, solution.x, state), (flow.lam, solution.lam, costate))
    ]
    return float(max(parts))


def off_cost(solution: Solution, flow: Flow) -> float:
    """Return the relative difference of the stated cost from the cost along the flow.

    A cost that is a small difference of large terms is compared with a fraction of these terms instead.
    """
    size = max(abs(flow.cost), CANCELLED * products(solution), 1e-300)
    return float(abs(flow.cost - solution.objective) / size)


def stationarity(solution: Solution) -> float:
    """Return the largest difference of the control from the minimiser of H, relative to the largest control.

    Where H does not determine the direction of a control, every direction counts as a minimiser.
    """
    instance = solution.instance
    law = instance.model.control_law_batch(
        solution.times, solution.x, solution.lam, instance.parameters, instance.control_set.arguments
    )
    law = np.where(undecided(instance, solution.times, solution.x, solution.lam), solution.u, law)
    size = max(float(np.abs(solution.u).max()), float(np.abs(law).max()))
    apart = np.abs(instance.control_set.apart(law, solution.u))
    return float(apart.max() / size) if size > 0.0 else 0.0


def hamiltonian_drift(solution: Solution, flow: Flow, u: Array | None = None) -> float:
    """Return the largest change of H along the flow, relative to the terms that it consists of.

    Costates near zero count as a fraction of their unit, since a costate that consists of rounding does not keep H
    constant.

    Parameters
    ----------
    u
        Controls along the flow, ``None`` if the control law determines them.
    """
    instance, model = solution.instance, solution.instance.model
    t, x, lam, p = flow.times, flow.x, flow.lam, instance.parameters
    u = model.control_law_batch(t, x, lam, p, instance.control_set.arguments) if u is None else u
    h = np.broadcast_to(model.hamiltonian_batch(t, x, u, lam, p), t.shape)
    rates = np.abs(model.dynamics_batch(t, x, u, p))
    unit, n = unit_sizes(solution), len(solution.x)
    slowest = NEGLIGIBLE * unit[:n] / float(solution.times[-1] - solution.times[0])
    faint = FAINT_COSTATE * unit[n:] @ np.maximum(np.broadcast_to(rates, x.shape).max(axis=1), slowest)
    terms = (np.abs(lam) * rates).sum(axis=0).max()
    return float(np.abs(h - h[0]).max() / max(terms, np.abs(h).max(), faint, 1e-300))


def first_order(
    solution: Solution,
    flow: Flow,
    defect: str = OF_FLOW,
    *,
    off_law: float | None = None,
    u: Array | None = None,
    constant: bool = True,
    more: float = 0.0,
) -> list[Check]:
    """Return checks of the first-order conditions along a flow; constancy of H comes last.

    Parameters
    ----------
    defect
        Name of the check that compares the solution with the flow.
    off_law
        Violation of the minimum condition by the controls, ``None`` if it is their difference from the control law.
    u
        Controls along the flow, ``None`` if the control law determines them.
    constant
        Whether to check that H is constant in a model without explicit time.
    more
        Excess of H at the final time, see :func:`boundary_residual`.
    """
    checks = [
        Check(BOUNDARY, boundary_residual(solution, flow, more), RESIDUAL),
        Check(defect, dynamics_defect(solution, flow), DEFECT),
        Check(STATIONARITY, stationarity(solution) if off_law is None else off_law, STATIONARY),
        Check("cost", off_cost(solution, flow), COST),
        Check("domain violation", float(not solution.instance.model.in_domain(flow.x)), 0.0),
    ]
    if constant and solution.instance.model.spec.autonomous:
        checks.append(Check(HAMILTONIAN, hamiltonian_drift(solution, flow, u), DRIFT))
    return checks


def legendre_clebsch(solution: Solution) -> float:
    """Return the smallest eigenvalue of H_uu along the trajectory; positive where the strict condition holds.

    For a control vector of fixed magnitude on which H depends linearly, it is the eigenvalue of H on the sphere: the
    magnitude of the gradient divided by that of the vector. It may vanish at isolated times, such as at a final time at
    which velocities are free. Components that H holds strictly at a bound are left out.
    """
    instance, model = solution.instance, solution.instance.model
    along = solution.times, solution.x, solution.u, solution.lam, instance.parameters
    hessian = np.array(model.control_hessian_batch(*along))
    for places, part in instance.control_set.parts:
        if part.directed and part.kind not in ("angle", "box"):
            rows = list(places)
            slope, u = np.asarray(model.stationarity_batch(*along))[rows], solution.u[rows]
            hessian[rows, rows] -= (slope * u).sum(axis=0) / np.maximum((u * u).sum(axis=0), 1e-300)
    if model.spec.stationary and instance.lower:
        slope = np.broadcast_to(model.stationarity_batch(*along), solution.u.shape)
        low, high = (np.array(ends)[:, None] for ends in (instance.lower, instance.upper))
        outwards = np.where(solution.u >= high, -slope, np.where(solution.u <= low, slope, 0.0))
        free = ~(outwards > STRICT * np.abs(slope).max(axis=1, keepdims=True))
        hessian = hessian * (free[:, None] & free) + np.eye(len(free))[:, :, None] * ~free * np.abs(hessian).max()
    smallest = np.linalg.eigvalsh(hessian.transpose(2, 0, 1)).min(axis=1) if len(hessian) else np.full(1, np.inf)
    open_ones = np.atleast_1d(undecided(instance, solution.times, solution.x, solution.lam).any(axis=0))
    beside = np.append(open_ones[1:], False) | np.append(False, open_ones[:-1])
    for_long = np.atleast_1d(np.logical_not(open_ones) | beside)[: len(smallest)]
    return float(smallest[for_long].min(initial=np.inf))


def node_by_node(solution: Solution, along: Segments) -> Flow | None:
    """Integrate the canonical equations from the beginning of each segment to its nodes and to the next segment.

    The flow from the initial costates alone is unreliable where neighbouring extremals diverge quickly: it amplifies
    rounding of the costates beyond the tolerance. From node to node it stays accurate. Two measures are used: the
    distance of the end of each segment from the next node, and the amount by which all nodes together would have to
    move for segments to meet (:func:`correction`), since many small gaps in one direction are no extremal.

    Returns a flow to be compared with the solution, ``None`` if it is not finite.
    """
    instance, model, n = solution.instance, solution.instance.model, len(solution.x)
    times = solution.times
    begins = along.nodes[np.searchsorted(along.nodes, np.arange(1, len(times))) - 1]
    start, h = values(solution), (times[1:] - times[begins]) / along.steps
    rates, found = costing(solution), np.append(start[:, begins], np.zeros((1, len(h))), axis=0)
    try:
        for step in range(along.steps):
            found = leap(rates, times[begins] + step * h, found, h)
        ends = np.column_stack([start[:, 0], found[:-1]])
        terminal = model.terminal_cost(float(times[-1]), tuple(ends[:n, -1].tolist()), instance.parameters)
    except FAILURES:
        return None
    return Flow(times, ends[:n], ends[n:], float(found[-1, along.nodes[1:] - 1].sum()) + float(terminal))


def correction(solution: Solution, along: Segments, reached: Flow) -> float:
    """Return by how much nodes would have to move, to first order, for segments to meet and end conditions to hold.

    The amount is relative to the magnitudes of states and costates; infinite if the linear system is singular.

    Parameters
    ----------
    solution, along
        The solution, and its segments.
    reached
        States and costates at the ends of segments, as returned by :func:`node_by_node`.
    """
    size, scale = len(along.scale), along.scale[:, None]
    gaps = (np.concatenate([reached.x, reached.lam]) - values(solution))[:, along.nodes] / scale
    finish, by_end, by_rest = _finish(solution, along.scale)
    transition = along.transition.reshape(-1, along.steps, size, size)
    whole = transition[:, 0]
    for step in range(1, along.steps):
        whole = transition[:, step] @ whole
    try:
        matching = Matching(whole, np.zeros((*whole.shape[:2], by_rest.shape[1])), by_end, by_rest)
        moved, _ = matching.correction(gaps[:, 1:].T, np.zeros(size // 2), finish)
    except np.linalg.LinAlgError:
        return float("inf")
    sizes = np.concatenate(typical(solution, FAINT_COSTATE))
    return float((np.abs(moved.T * scale) / sizes[:, None]).max())


def _finish(solution: Solution, scale: Array) -> tuple[Array, Array, Array]:
    """Return scaled residuals at the last node and their derivatives.

    The first derivatives are with respect to states and costates there, the second ones with respect to multipliers
    and, if free, the final time.
    """
    instance, (tf, x, lam) = solution.instance, final_values(solution)
    nu, residual = multipliers(instance, tf, x, lam)
    arguments = instance.parameters, instance.control_set.arguments, final_argument(instance)
    table = np.array(instance.model.boundary_jacobian(tf, x, lam, nu, *arguments)).reshape(len(residual), -1)
    rates = np.array(instance.model.canonical(tf, x, lam, *arguments[:-1]))
    by_end, by_rest = table[:, : len(scale)], table[:, len(scale) :]
    by_rest = np.column_stack([by_rest[:, :-1], by_end @ rates + by_rest[:, -1]])
    rows = len(residual) - (instance.tf is not None)
    shown = by_end[:rows] * scale
    unit = np.maximum(np.abs(shown).max(axis=1), 1e-300)
    columns = len(nu) + (instance.tf is None)
    return residual[:rows] / unit, shown / unit[:, None], by_rest[:rows, :columns] / unit[:, None]
