"""Whether the segments between a solution's nodes meet: where one flow over the whole time can tell nothing.

The flow from the initial costates alone is worth little where neighbouring extremals part quickly: it multiplies the
last digit of these beyond what may be missed. From node to node it is as good as ever. How far each segment ends from
the next node is one measure, by how much all nodes together would have to move for them to meet another: many small
gaps that lean to one side are no extremal.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.end_form import final_values, multipliers
from satsym.solvers.certificate.flow import FAINT, Flow, typical
from satsym.solvers.certificate.segments import Segments, values
from satsym.solvers.collocation.matching import Matching
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.failures import FAILURES
from satsym.solvers.simulation.extrapolation import leap


def node_by_node(solution: Solution, along: Segments) -> Flow | None:
    """Where the canonical equations lead from the beginnings of segments to all nodes in these and the next.

    To be compared with the solution; ``None`` where it is not finite.
    """
    instance, model, n = solution.instance, solution.instance.model, len(solution.x)
    p, bounds, times = instance.parameters, instance.control_set.arguments, solution.times
    begins = along.nodes[np.searchsorted(along.nodes, np.arange(1, len(times))) - 1]
    start, h = values(solution), (times[1:] - times[begins]) / along.steps

    def rates(t: Array, y: Array) -> Array:
        x, lam = y[:n], y[n:-1]
        cost = model.running_cost_batch(t, x, model.control_law_batch(t, x, lam, p, bounds), p)
        return np.concatenate([model.canonical_batch(t, x, lam, p, bounds), np.broadcast_to(cost, t.shape)[None]])

    found = np.append(start[:, begins], np.zeros((1, len(h))), axis=0)
    try:
        for step in range(along.steps):
            found = leap(rates, times[begins] + step * h, found, h)
        ends = np.column_stack([start[:, 0], found[:-1]])
        terminal = float(model.terminal_cost(float(times[-1]), tuple(ends[:n, -1].tolist()), p))
    except FAILURES:
        return None
    return Flow(times, ends[:n], ends[n:], float(found[-1, along.nodes[1:] - 1].sum()) + terminal)


def correction(solution: Solution, along: Segments, reached: Flow) -> float:
    """By how much nodes would have to move, to first order, for segments to meet and to end as they should.

    Relative to the sizes of states and costates; infinite where nothing determines it.

    Parameters
    ----------
    solution, along
        Whose nodes, and how segments follow them.
    reached
        Where they end, as :func:`node_by_node` has it.
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
    sizes = np.concatenate(typical(solution, FAINT))
    return float((np.abs(moved.T * scale) / sizes[:, None]).max())


def _finish(solution: Solution, scale: Array) -> tuple[Array, Array, Array]:
    """Residuals at the last node, and their derivatives by what is there, scaled, and by multipliers and final time."""
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
