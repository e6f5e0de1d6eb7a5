"""Test whether an extremal is a minimum: the number of directions with negative second variation.

The states are eliminated node by node from the quadratic form of the discretised second variation; its pivots are
matrices between the fields of extremals from the left and through the right neighbour. A negative pivot before the end
is a conjugate time (Jacobi); free final states add their own pivots. For costates that are the gradient of the cost to
go, as here, the field from a fixed start gives the left part -Lambda X^-1.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.lapack import lapack
from satsym.solvers.collocation.curve import Path
from satsym.solvers.collocation.elimination import Matching
from satsym.solvers.collocation.problem import TwoPoint

TIED, LOOSE = 1e-11, 1e-6
"""Relative response of the states to the controls, in some direction, that counts as zero; and the response that
replaces it."""


def negative_directions(problem: TwoPoint, path: Path, matching: Matching) -> int:
    """Return the number of negative eigenvalues of the discretised second variation; 0 at a strict local minimum.

    Raises
    ------
    numpy.linalg.LinAlgError
        If a field of extremals is singular at a node.
    """
    try:
        count = _counted(problem, path, matching, matching.transition)
    except np.linalg.LinAlgError:
        if not _tied(problem, matching):
            raise
        count = 1
    if count and _tied(problem, matching):
        return _counted(problem, path, matching, _loosened(matching.transition))
    return count


def _counted(problem: TwoPoint, path: Path, matching: Matching, transition: Array) -> int:
    """Return the number of negative eigenvalues of the second variation, for states controllable in all directions."""
    n = problem.states
    # The field of extremals from the start, by its costates as a function of its states: Lambda X^-1.
    slope = _right_divided(transition[0][n:, n:], transition[0][:n, n:])
    left = np.empty((len(transition) - 1, n, n))
    for i, matrix in enumerate(transition[1:]):
        arrived = matrix[:, :n] + matrix[:, n:] @ slope
        left[i], slope = arrived[:n], _right_divided(arrived[n:], arrived[:n])
    pivots = np.linalg.solve(-transition[1:, :n, n:], left)
    count = _negative(pivots)
    return count + _at_the_end(problem, path, slope) + _of_the_duration(problem, matching)


def _tied(problem: TwoPoint, matching: Matching) -> bool:
    """Return whether the states are not controllable in all directions, because a quantity is conserved."""
    n, field = problem.states, np.eye(2 * problem.states)[:, problem.states :]
    for matrix in matching.transition:
        field = matrix @ field
        field = field / max(float(np.abs(field).max()), 1e-300)
    sizes = np.linalg.svd(field[:n], compute_uv=False)
    return bool(sizes[-1] <= TIED * sizes[0])


def _loosened(transition: Array) -> Array:
    """Return transition matrices with additional controls that move every state slightly, at a high cost."""
    n = transition.shape[1] // 2
    shear = np.repeat(np.eye(2 * n)[None], len(transition), axis=0)
    response = np.abs(transition[:, :n, n:]).max(axis=(1, 2))
    shear[:, np.arange(n), np.arange(n, 2 * n)] = -LOOSE * response[:, None]
    return np.asarray(shear @ transition)


def _right_divided(a: Array, b: Array) -> Array:
    """Return the matrix a b^-1."""
    _, _, found, singular = lapack().dgesv(b.T, a.T)
    if singular:
        raise np.linalg.LinAlgError("singular")
    return np.asarray(found.T)


def _at_the_end(problem: TwoPoint, path: Path, slope: Array) -> int:
    """Return the number of negative pivots of the free final states, within the terminal constraints."""
    n = problem.states
    free = np.flatnonzero(~problem.fixed)
    if not len(free):
        return 0
    by_end, _ = problem.boundary_slopes(path.nodes[:, -1], path.theta)
    # Rows of free states read lambda - S_x - nu' psi_x, so minus their derivative is the Hessian of S + nu' psi.
    pivot = (-by_end[:n, :n] - slope)[np.ix_(free, free)]
    constraints = problem.unknowns - problem.free_time
    if constraints:
        slopes = by_end[n : n + constraints, :n][:, free]
        within = np.linalg.svd(slopes)[2][np.linalg.matrix_rank(slopes) :].T
        pivot = within.T @ pivot @ within
    return _negative(pivot[None])


def _of_the_duration(problem: TwoPoint, matching: Matching) -> int:
    """Return 1 if the second derivative of the cost with respect to the free duration is negative, otherwise 0."""
    if not problem.free_time:
        return 0
    reduced = matching.reduced()
    # With the multipliers eliminated first, the pivot of the duration is a ratio of determinants.
    rest = reduced[:-1, :-1]
    pivot = np.linalg.det(reduced) / (np.linalg.det(rest) if len(rest) else 1.0)
    return int(pivot < 0.0)


def _negative(matrices: Array) -> int:
    """Return the number of negative eigenvalues of the symmetric parts of a stack of matrices."""
    if not matrices.size:
        return 0
    return int((np.linalg.eigvalsh(matrices + matrices.transpose(0, 2, 1)) < 0.0).sum())
