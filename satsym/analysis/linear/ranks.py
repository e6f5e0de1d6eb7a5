"""Controllability and observability: ranks, and what is out of reach.

Rational systems are decided exactly (:mod:`satsym.analysis.linear.rational`). Else ranks are decided on the system in
units that suit it (:mod:`satsym.analysis.linear.system`), by the staircase of singular value decompositions, which
never forms A^k B: what the inputs move directly, what that moves, and so on. A singular value below ``TOLERANCE`` times
the size of the system is zero. So the ranks are exactly those of a system that differs from the given one by less than
that.

Sources: R. E. Kalman, Mathematical description of linear dynamical systems, SIAM J. Control 1 (1963);
P. M. Van Dooren, The generalized eigenstructure problem in linear system theory, IEEE TAC 26 (1981);
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
    """How much of a system its inputs move, or how much of it its outputs show."""

    matrix: Array
    """Kalman's matrix, in the system's units: (B, AB, ...), shape (n, n m), or C over CA over ..., shape (n k, n)."""
    rank: int
    """Dimension of what is moved or shown."""
    lost: tuple[Eigenvalue, ...]
    """The modes that are not moved, or do not show."""
    alone: Mapping[str, Reach]
    """Reach of each input or output by itself, by name; empty where this is already the reach of a single one."""

    @property
    def complete(self) -> bool:
        """Whether the system is controllable, or observable."""
        return not self.lost


def controllability(given: LinearSystem) -> Reach:
    """What the inputs move, all together and each alone."""
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
    """What the outputs show, as what would move if the system ran along transposed arrows."""
    return _dual(controllability(transposed(given)), len(given.states))


def _dual(found: Reach, n: int) -> Reach:
    """The blocks of the matrix below one another, each transposed."""
    stacked = found.matrix.reshape(n, n, -1).transpose(1, 2, 0).reshape(-1, n)
    return Reach(stacked, found.rank, found.lost, {name: _dual(each, n) for name, each in found.alone.items()})


def transposed(given: LinearSystem) -> LinearSystem:
    """The dual system: A', with outputs for inputs."""
    exact = given.exact and given.exact.transposed()
    return LinearSystem(
        given.A.T, given.C.T, given.B.T, given.D.T, given.states, given.outputs, given.inputs, given.name, exact
    )


def staircase(A: Array, B: Array) -> tuple[int, Array, Array]:
    """Orthogonal coordinates in which what the inputs reach comes first.

    Parameters
    ----------
    A, B
        Of a scaled system.

    Returns
    -------
    rank : int
        Number r of coordinates that are reached.
    basis : array of shape (n, n)
        The coordinates, as columns.
    form : array of shape (n, n)
        A in them; below its first r rows the first r columns vanish.
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
