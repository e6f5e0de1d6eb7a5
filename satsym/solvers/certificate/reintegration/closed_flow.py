"""The flow from the initial costates, computed from simultaneous integrations from all stations.

Arrays make this many times faster than one integration. The stations of a solution deviate only slightly from the flow.
To first order the deviation follows from the end of each integration and its derivative; unless it is negligible, the
stations are corrected and integrated from again. The result has the errors of these integrations only, whatever the
initial stations were.
"""

from __future__ import annotations

from itertools import islice

import numpy as np

from satsym.arrays import Array
from satsym.lapack import lapack
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.flow import FAINT_COSTATE, TOLERANCE, Flow, costing, sizes, typical
from satsym.solvers.certificate.reintegration.segments import Segments
from satsym.solvers.failures import FAILURES
from satsym.solvers.simulation.extrapolation import leaps

FEWEST = 5
"""Minimum number of columns of the extrapolation table."""

SETTLED_CORRECTION = 1e-11
"""Relative correction of the stations below which iteration stops, since its square is negligible."""

ROUNDS = 3
"""Maximum number of corrections. If more would be needed, the flow is integrated step by step instead."""


def closed_flow(solution: Solution, along: Segments) -> Flow | None:
    """Return the flow at all stations; ``None`` if steps between them are too long or corrections do not converge.

    Parameters
    ----------
    along
        Stations, and derivatives of the motions between them with respect to their initial values.
    """
    n, times, widths = len(solution.x), along.times, np.diff(along.times)
    last = np.concatenate([solution.x[:, -1:], solution.lam[:, -1:]])
    z = np.concatenate([along.begins, last], axis=1)
    z[:n, 0] = solution.instance.initial
    faint, size = np.concatenate(typical(solution, FAINT_COSTATE))[:, None], sizes(solution)[:, None]
    rates, scale = costing(solution), np.append(size, size[:n].T @ size[n:], axis=0)
    for _ in range(ROUNDS):
        start = np.append(z[:, :-1], np.zeros((1, len(widths))), axis=0)
        try:
            for ends, error in islice(leaps(rates, times[:-1], start, widths, FEWEST), FEWEST - 1, None):
                if (error <= TOLERANCE * np.maximum(scale, np.abs(ends))).all():
                    break
            else:
                return None
        except FAILURES:
            return None
        moved = _moved(along, ends[:-1] - z[:, 1:])
        z[:, 1:] += moved
        if (np.abs(moved) <= SETTLED_CORRECTION * faint).all():
            end = tuple(z[:n, -1].tolist())
            terminal = solution.instance.model.terminal_cost(float(times[-1]), end, solution.instance.parameters)
            return Flow(times, z[:n], z[n:], float(ends[-1].sum()) + float(terminal))
    return None


def _moved(along: Segments, gaps: Array) -> Array:
    """Return corrections of all stations but the first that close the gaps to first order, shape (2n, K-1)."""
    return carried(along.transition, (gaps / along.scale[:, None]).T).T * along.scale[:, None]


def carried(transition: Array, gaps: Array) -> Array:
    """Return sums of gaps up to each station but the first, each propagated by the later steps, shape (K, s).

    Parameters
    ----------
    transition
        Transition matrices from each station to the next, shape (K, s, s).
    gaps
        Gaps at the ends of the steps, shape (K, s).
    """
    count, size = transition.shape[:2]
    band = np.zeros((count, size, 2 * size))  # below the diagonal, column by column, as LAPACK has it
    for k in range(size):
        np.negative(transition[1:, :, k], out=band[:-1, k, size - k : 2 * size - k])
    found, _ = lapack().dtbtrs(band.reshape(-1, 2 * size).T, gaps.reshape(-1, 1), uplo="L", diag="U")
    return np.asarray(found.reshape(gaps.shape))
