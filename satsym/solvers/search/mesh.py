"""Mesh refinement where the equations of motion have residuals between the points, and where controls jump."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.transcription import DEGREE, NODES, RADAU, basis

TOLERANCE, MOST_PIECES = 1e-5, 6
"""Residual, relative to the magnitudes of states, below which an interval is not divided; maximum number of parts of an
interval."""

UNRESOLVED, HALVES = 1.0, 2
"""Residual, relative to the magnitudes of states, above which a mesh does not resolve its motion, and maximum number of
parts of an interval in this case. On a much finer mesh the motion would be a different one."""

JUMP, PIECES = 0.15, 4
"""Change of a control within an interval, relative to its range, that counts as a jump; number of parts of such an
interval."""

EVENLY = 0.5
"""Fraction of the points of a graded mesh that are even in time; the others are even along the path of the states."""

MIDDLES = 0.5 * (NODES[:-1] + NODES[1:])
STATES = np.array([[one(tau) for one in basis(NODES)] for tau in MIDDLES])
RISES = np.array([[one.deriv()(tau) for one in basis(NODES)] for tau in MIDDLES])
VARIABLES = np.array([[one(tau) for one in basis(RADAU)] for tau in MIDDLES])


def graded(times: Array, x: Array, intervals: int) -> Array:
    """Return edges of intervals from 0 to 1 that are short where the states of a motion change fast.

    Parameters
    ----------
    times, x
        Increasing times (N,) and states (n, N) of the motion; each state counts relative to its range.
    """
    span = np.ptp(x, axis=1, keepdims=True)
    steps = np.diff(x, axis=1) / np.where(span > 0.0, span, 1.0)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(steps, axis=0))])
    share = (times - times[0]) / (times[-1] - times[0])
    laid = EVENLY * share + (1.0 - EVENLY) * (way / way[-1] if way[-1] > 0.0 else share)
    edges = np.interp(np.linspace(0.0, 1.0, intervals + 1), laid, share)
    edges[0], edges[-1] = 0.0, 1.0
    return np.asarray(edges)


def refined(found: Found) -> tuple[list[Array], float]:
    """Return edges of finer intervals for each phase, and the largest residual of the equations of motion."""
    programme = found.programme
    errors, jumps = _residuals(found), _jumps(found)
    most = MOST_PIECES if errors.max() < UNRESOLVED else HALVES
    pieces = np.clip(np.ceil((errors / TOLERANCE) ** (1.0 / (DEGREE + 1))), 1, most).astype(int)
    pieces = np.where(jumps, np.maximum(pieces, PIECES), pieces)
    meshes, k = [], 0
    for mesh in programme.meshes:
        edges = [mesh[:1]]
        for low, high in pairwise(mesh):
            edges.append(np.linspace(low, high, pieces[k] + 1)[1:])
            k += 1
        meshes.append(np.concatenate(edges))
    return meshes, float(errors.max())


def _residuals(found: Found) -> Array:
    """Return the largest residual of the equations of motion between the points of each interval."""
    programme = found.programme
    x, v, durations, free, start = programme.unpacked(found.unknown)
    k, d = programme.intervals, DEGREE
    nodes = np.arange(k)[:, None] * d + np.arange(d + 1)
    states, slopes = (np.einsum("pj,nkj->nkp", table, x[:, nodes]) for table in (STATES, RISES))
    variables = np.einsum("pj,nkj->nkp", VARIABLES, v[:, nodes[:, 1:] - 1])
    low, high = (row[:, None, None] for row in (programme.controls.lower, programme.controls.upper))
    variables = np.clip(variables, low, high)
    times = programme.times(durations, start)
    steps = (programme.steps @ durations)[::d]
    t = times[nodes[:, :1]] + steps[:, None] * MIDDLES
    y = np.concatenate([states, variables, t[None], np.broadcast_to(free[:, None, None], (len(free), *t.shape))])
    with np.errstate(all="ignore"):
        f = programme.points.rates(y.reshape(len(y), -1))[:-1].reshape(states.shape)
    error = np.abs(slopes - steps[:, None] * f) / programme.sizes.states[:, None, None]
    return np.asarray(np.nan_to_num(error, nan=1.0).max(axis=(0, 2)))


def _jumps(found: Found) -> Array:
    """Return the intervals in which a bounded control changes strongly."""
    programme: Programme = found.programme
    v = programme.unpacked(found.unknown)[1]
    span = programme.controls.upper - programme.controls.lower
    span = np.where(np.isfinite(span) & (span > 0.0), span, np.inf)
    k, d = programme.intervals, DEGREE
    around = np.clip(np.arange(k)[:, None] * d + np.arange(-1, d + 1), 0, programme.count - 1)
    return np.asarray((np.ptp(v[:, around], axis=2) / span[:, None]).max(axis=0) > JUMP)
