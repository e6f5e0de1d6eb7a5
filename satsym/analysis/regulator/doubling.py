"""Structured doubling: what a linear-quadratic problem does over a length of time, from what it does over half of it.

Over a time h the Hamiltonian system maps the state at the beginning and the costate at the end, x and mu, to
E x - S mu at the end and T x + E' mu at the beginning. Two such steps in a row are one, with

    E <- E W E,    S <- S + E W S E',    T <- T + E' T W E,    W = (1 + S T)^-1.

Nothing grows here however long the time: E tends to zero and T to the solution of the algebraic Riccati equation,
with an error that is squared in every step (E. K.-W. Chu, H.-Y. Fan and W.-W. Lin, A structure-preserving doubling
algorithm for continuous-time algebraic Riccati equations, Linear Algebra and its Applications 396, 2005).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from satsym.analysis.regulator.riccati import balancing, hamiltonian
from satsym.arrays import Array

FIRST_STEP = 0.5
"""The first step times the size of the Hamiltonian matrix."""


class NoLowerBound(ArithmeticError):
    """The cost has no lower bound over this length of time."""


class Flow(NamedTuple):
    """E, S and T of some length of time, shape (n, n) each."""

    E: Array
    S: Array
    T: Array

    def then(self, later: Flow) -> Flow:
        """This length of time followed by another.

        Raises
        ------
        NoLowerBound
            If some state between the two makes the cost as small as one likes: S^-1 + T is not positive definite.
        """
        if np.linalg.eigvals(np.eye(len(self.E)) + self.S @ later.T).real.min() <= 0.0:
            raise NoLowerBound
        both = np.linalg.solve(np.eye(len(self.E)) + self.S @ later.T, np.hstack([self.E, self.S @ later.E.T]))
        onward, across = np.hsplit(both, 2)
        return Flow(
            later.E @ onward,
            _symmetric(later.S + later.E @ across),
            _symmetric(self.T + self.E.T @ later.T @ onward),
        )

    def before(self, P: Array) -> Array:
        """Cost to go at the beginning, x'Px, from that at the end."""
        return _symmetric(self.T + self.E.T @ P @ np.linalg.solve(np.eye(len(P)) + self.S @ P, self.E))

    def closed(self, P: Array) -> Array:
        """The state at the end from that at the beginning, under the best control where x'Px is paid at the end."""
        return np.linalg.solve(np.eye(len(P)) + self.S @ P, self.E)


def flow(A: Array, G: Array, Q: Array, length: float) -> Flow:
    """The flow over a length of time.

    Raises
    ------
    NoLowerBound
        If the cost has none, which takes weights that are not positive semidefinite.
    """
    from scipy.linalg import expm

    n, units = len(A), balancing(hamiltonian(A, G, Q))
    weight = np.outer(units, units)
    matrix = hamiltonian(A * (units / units[:, None]), G / weight, Q * weight)
    doublings = max(0, int(np.ceil(np.log2(length * np.linalg.norm(matrix, 1) / FIRST_STEP))))
    step = expm(matrix * (length / 2.0**doublings))
    # x(h) and lambda(h) from x(0) and lambda(0), solved for what is wanted
    last = np.linalg.inv(step[n:, n:])
    found = Flow(last.T, _symmetric(-step[:n, n:] @ last), _symmetric(-last @ step[n:, :n]))
    for _ in range(doublings):
        found = found.then(found)
    return Flow(found.E * (units[:, None] / units), found.S * weight, found.T / weight)


def _symmetric(matrix: Array) -> Array:
    return 0.5 * (matrix + matrix.T)
