"""Controllability and observability: ranks, and modes that are uncontrollable or unobservable.

Rational systems are decided exactly (:mod:`satsym.analysis.linear.rational`). Otherwise ranks are decided on the system
in suitable units (:mod:`satsym.analysis.linear.system`), by the staircase of singular value decompositions, which never
forms A^k B: the states that inputs move directly, those that these move, and so on. A singular value below
``TOLERANCE`` times the size of the system is zero. So the ranks are exactly those of a system that differs from the
given one by less than that. Sources: R. E. Kalman, Mathematical description of linear dynamical systems, SIAM J.
Control 1 (1963); P. M. Van Dooren, The generalized eigenstructure problem in linear system theory, IEEE TAC 26 (1981);
M. L. J. Hautus, Controllability and observability conditions, Indagationes Mathematicae 31 (1969).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from satsym.analysis.linear import rational
from satsym.analysis.linear.spectrum import Eigenvalue, of_roots, spectrum
from satsym.analysis.linear.system import LinearSystem, scaled
from satsym.arrays import Array

TOLERANCE = 1e-10

ROUNDING = 1e-15
"""Entries of the staircase form below this for each state, relative to the size of the matrix, count as zero."""


@dataclass(frozen=True, eq=False)
class Reach:
    """The controllability of a system by its inputs, or its observability by its outputs."""

    matrix: Array
    """The Kalman matrix in the system's units: (B, AB, ...), shape (n, n m), or C over CA over ..., shape (n k, n)."""
    rank: int
    """Dimension of the controllable, or observable, subspace."""
    lost: tuple[Eigenvalue, ...]
    """The uncontrollable, or unobservable, modes."""
    alone: Mapping[str, Reach]
    """The results for each single input or output, by name; empty if this one is for a single one."""

    @property
    def complete(self) -> bool:
        """Tell whether the system is controllable, or observable."""
        return not self.lost


def controllability(given: LinearSystem) -> Reach:
    """Analyse controllability by all inputs together and by each alone."""
    fitted, power = scaled(given), given.B
    blocks = [power]
    for _ in given.states[1:]:
        power = given.A @ power
        blocks.append(power)

    def reach(inputs: list[int], alone: Mapping[str, Reach]) -> Reach:
        matrix = np.hstack([block[:, inputs] for block in blocks])
        if given.exact is not None:
            rank, roots = rational.reached(given.exact.A, given.exact.with_inputs(inputs).B)
            return Reach(matrix, rank, of_roots(roots), alone)
        rank, _, form = staircase(fitted.A, fitted.B[:, inputs])
        noise = ROUNDING * len(form) * float(np.linalg.norm(fitted.A, 2))
        lost = spectrum(form[rank:, rank:] * fitted.rate, noise * fitted.rate) if rank < len(form) else ()
        return Reach(matrix, rank, lost, alone)

    alone = {name: reach([j], {}) for j, name in enumerate(given.inputs)}
    return reach(list(range(len(given.inputs))), alone)


def observability(given: LinearSystem) -> Reach:
    """Analyse observability by the outputs, as the controllability of the dual system."""
    return _dual(controllability(transposed(given)), len(given.states))


def _dual(found: Reach, n: int) -> Reach:
    """Transpose each of the blocks that are stacked in a matrix."""
    stacked = found.matrix.reshape(n, n, -1).transpose(1, 2, 0).reshape(-1, n)
    return Reach(stacked, found.rank, found.lost, {name: _dual(each, n) for name, each in found.alone.items()})


def transposed(given: LinearSystem) -> LinearSystem:
    """Return the dual system: A', with outputs in place of inputs."""
    exact = given.exact and given.exact.transposed()
    return LinearSystem(
        given.A.T, given.C.T, given.B.T, given.D.T, given.states, given.outputs, given.inputs, given.name, exact
    )


def staircase(A: Array, B: Array) -> tuple[int, Array, Array]:
    """Return orthogonal coordinates of which the first span the controllable subspace.

    Parameters
    ----------
    A, B
        Matrices of a system in suitable units, shapes (n, n) and (n, m).

    Returns
    -------
    rank : int
        Number r of coordinates that are reached.
    basis : array of shape (n, n)
        The coordinates, as columns.
    form : array of shape (n, n)
        The matrix A in these coordinates; below the first r rows, its first r columns vanish.
    """
    n = len(A)
    basis, form, block, reached = np.eye(n), A.copy(), B, 0
    limit = TOLERANCE * (float(np.linalg.norm(np.hstack([A, B]), 2)) or 1.0)
    while reached < n and block.size:
        left, singular, _ = np.linalg.svd(block)
        rank = int((singular > limit).sum())
        if rank == 0:
            break
        basis[:, reached:] = basis[:, reached:] @ left
        form[:, reached:] = form[:, reached:] @ left
        form[reached:] = left.T @ form[reached:]
        block = form[reached + rank :, reached : reached + rank]
        reached += rank
    return reached, basis, form
