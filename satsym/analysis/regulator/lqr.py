"""Linear-quadratic regulators: the gain K that minimises the integral of x'Qx + 2x'Nu + u'Ru (no 1/2) with u = -K x."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from satsym.analysis.linear.equilibrium import Linearisation
from satsym.analysis.linear.ranks import controllability, observability
from satsym.analysis.linear.routh import Routh, routh
from satsym.analysis.linear.spectrum import Eigenvalue, characteristic, shown
from satsym.analysis.linear.system import LinearSystem, scaled, system
from satsym.analysis.regulator import riccati
from satsym.analysis.regulator.refinement import Refined
from satsym.analysis.regulator.riccati import balancing, hamiltonian
from satsym.arrays import Array
from satsym.instance import Instance, LqrOptions, weights
from satsym.status import BadInput

NOTHING = 1e-9
"""Cost of a motion of some frequency, relative to the effort of its inputs, up to which it may be zero."""

DOUBTFUL = 1e-6
"""Slowest decay of a closed loop, relative to the fastest eigenvalue of either loop, that is no rounding error."""


@dataclass(frozen=True, eq=False)
class Regulator:
    """An optimal gain with its Riccati solution and the properties of its closed loop."""

    system: LinearSystem
    """The linear system with its active inputs alone."""
    Q: Array
    R: Array
    N: Array
    """The weights Q, R and N, shapes (n, n), (m, m) and (n, m)."""
    horizon: float | None
    """Length of time of the cost; ``None`` where it is infinite. For a finite one, K and P are those at the beginning.
    """
    K: Array
    P: Array
    """The gain K, shape (m, n), and the Riccati solution P, shape (n, n); x'Px is the cost to go."""
    eigenvalues: NDArray[np.complexfloating]
    """Eigenvalues of A - B K, the largest real part first, shape (n,)."""
    residual: float
    """Residual of the algebraic Riccati equation, relative to its terms; of the differential one for a finite horizon.
    """
    error: float | None = None
    """Estimated error of P, relative to P in units in which its diagonal elements are 1: the change by another Newton
    step with residuals in twice the precision. ``None`` where the horizon is finite."""

    @cached_property
    def positive(self) -> bool:
        """Tell whether the cost to go from every deviation is positive."""
        return weights.smallest_eigenvalue(self.P.tolist()) > 0.0

    @cached_property
    def closed_loop(self) -> LinearSystem:
        """Return the system under u = -K x."""
        return self.system.with_feedback(self.K)

    @cached_property
    def polynomial(self) -> Array:
        """Return the characteristic polynomial of the closed loop, monic, highest power first."""
        return characteristic(self.closed_loop.A)

    @cached_property
    def routh(self) -> Routh:
        """Return the Routh array of the closed loop."""
        return routh(self.polynomial.tolist(), self.eigenvalues.tolist())

    def cost(self, deviation: ArrayLike) -> float:
        """Return the minimum cost from a deviation of shape (n,)."""
        x = np.asarray(deviation, dtype=float)
        return float(x @ self.P @ x)

    def gains(self, steps: int) -> Array:
        """Return K at evenly spaced times of a finite horizon, both ends included; shape (steps + 1, m, n)."""
        if self.horizon is None:
            return np.broadcast_to(self.K, (steps + 1, *self.K.shape))
        A, Q, ahead = riccati.without_cross(self.system.A, self.system.B, self.Q, self.R, self.N)
        step = flow(A, riccati.cost_of_control(self.system.B, self.R), Q, self.horizon / steps)
        P = [np.zeros_like(self.P)]
        for _ in range(steps):
            P.append(step.before(P[-1]))
        return np.linalg.solve(self.R, self.system.B.T @ np.array(P[::-1])) + ahead


def lqr(
    given: LinearSystem, Q: ArrayLike, R: ArrayLike, horizon: float | None = None, N: ArrayLike | None = None
) -> Regulator:
    """Design the regulator of a linear system, all of whose inputs are active.

    Parameters
    ----------
    given
        See :meth:`LinearSystem.with_inputs` for choosing inputs.
    Q, R
        Weights, shapes (n, n) and (m, m), or the diagonals; symmetric, R positive definite.
    horizon
        Length of time, infinite by default; nothing is paid at its end but what was paid until then.
    N
        Cross weights, shape (n, m); zero by default.

    Raises
    ------
    BadInput
        If the weights are not such, or the cost has no lower bound; or, for an infinite horizon, if the inputs cannot
        steady a mode that does not decay, or the weights do not see one on the imaginary axis.
    """
    n, m = len(given.states), len(given.inputs)
    rows, costs = (np.asarray(part, dtype=float).tolist() for part in (Q, R))
    found = weights.checked(rows, costs, None if N is None else np.asarray(N, dtype=float).tolist(), n, m)
    q, r, cross = np.array(found[0]), np.array(found[1]), np.zeros((n, m)) if found[2] is None else np.array(found[2])
    # from here on for v = u + R^-1 N'x, so that there is no cross weight any more
    A, weight, ahead = riccati.without_cross(given.A, given.B, q, r, cross)
    G = riccati.cost_of_control(given.B, r)
    rate: Array | float = 0.0
    error: float | None = None
    if horizon is None:
        solved = _stabilising(given, A, weight, r)
        P, eigenvalues, error = solved.P, solved.eigenvalues, solved.error
    else:
        try:
            run = flow(A, G, weight, horizon)
        except NoLowerBound:
            raise BadInput(
                "[lqr] horizon: over so long a horizon the cost has no lower bound, because the negative "
                "weights exceed the cost of the inputs; shorten the horizon, or use larger weights"
            ) from None
        P, rate = run.T, run.E.T @ weight @ run.E
        eigenvalues = np.linalg.eigvals(A - G @ P).astype(complex)
    order = np.lexsort((-eigenvalues.imag, np.abs(eigenvalues.imag), -eigenvalues.real))
    return Regulator(
        system=given,
        Q=q,
        R=r,
        N=cross,
        horizon=horizon,
        K=np.linalg.solve(r, given.B.T @ P) + ahead,
        P=P,
        eigenvalues=eigenvalues[order],
        residual=riccati.residual(A, G, weight, P, rate),
        error=error,
    )


def regulator(about: Linearisation, options: LqrOptions | None = None) -> Regulator:
    """Design the regulator of a linearised model.

    Parameters
    ----------
    about
        The linearisation, whose coefficients must be constant.
    options
        The table [lqr] of an instance; by default all inputs are active, and all weights are 1.

    Raises
    ------
    BadInput
        As :func:`lqr`; or if the coefficients depend on time, or there is no control.
    """
    given = about.system
    if not given.inputs:
        raise BadInput(f"model {given.name} has no control, so there is nothing to regulate it with")
    if not about.constant:
        raise BadInput(
            f"the linearisation of {given.name} depends on time, so no constant gain is optimal; linearise "
            "about another motion"
        )
    if options is None:
        return lqr(given, np.ones(len(given.states)), np.ones(len(given.inputs)))
    return lqr(given.with_inputs(options.inputs), options.Q, options.R, options.horizon, options.N)


def required(case: Instance) -> LqrOptions:
    """Return the [lqr] table of an instance, which must have one.

    Raises
    ------
    BadInput
        If it has none.
    """
    if case.lqr is None:
        raise BadInput(f"{case.called}: [lqr]: missing; add a table with the weights Q and R")
    return case.lqr


def _stabilising(given: LinearSystem, A: Array, Q: Array, R: Array) -> Refined:
    """Return the stabilising Riccati solution, or raise with the reason why there is none."""
    try:
        found = riccati.stabilising(A, given.B, Q, R)
    except riccati.NoSolution:
        why = _obstacle(given, A, Q, R) or "[lqr] Q, R: no accurate gain was found; choose weights of more similar size"
        raise BadInput(why) from None
    slowest, all_values = found.eigenvalues.real.max(), np.concatenate([found.eigenvalues, np.linalg.eigvals(A)])
    if slowest > -DOUBTFUL * np.abs(all_values).max() and (why := _obstacle(given, A, Q, R)):
        raise BadInput(why)
    return found


def _obstacle(given: LinearSystem, A: Array, Q: Array, R: Array) -> str:
    """Explain why no gain is optimal; empty if there is one."""
    stuck = [each for each in controllability(given).lost if each.value.real >= 0.0]
    if stuck:
        return (
            f"[lqr] inputs: not stabilisable, the inputs {' and '.join(given.inputs)} cannot control the mode "
            f"s = {_listed(stuck)}, which does not decay; add an input"
        )
    if not weights.semidefinite(Q.tolist()):
        return _at_a_frequency(A, given.B, Q, R)
    seen = system(A, given.B, Q, states=given.states, inputs=given.inputs)
    unseen = [each for each in observability(seen).lost if each.value.real == 0.0]
    if unseen:
        return (
            f"[lqr] Q: not detectable, the mode s = {_listed(unseen)} on the imaginary axis costs nothing, so no gain "
            "is optimal; weigh a state that takes part in it"
        )
    return ""


def _at_a_frequency(A: Array, B: Array, Q: Array, R: Array) -> str:
    """Explain why no gain exists where Q is indefinite: a motion of some frequency costs nothing, or less.

    There is a stabilising solution if and only if a motion of any frequency costs a positive amount (J. C. Willems).
    This is evaluated under a stabilising gain, which does not change the sign.
    """
    gain = np.linalg.solve(R, B.T @ riccati.stabilising(A, B, np.diag(1.0 / scaled(system(A, B)).states ** 2), R).P)
    closed, across = A - B @ gain, -gain.T @ R
    weight = Q + gain.T @ R @ gain
    axis = np.abs(np.linalg.eigvals(riccati.hamiltonian(A, riccati.cost_of_control(B, R), Q)).imag)
    size = float(np.abs(np.linalg.eigvals(closed)).max())
    tried = np.unique(np.concatenate([axis, [0.0], np.geomspace(1e-4 * size, 1e2 * size, 400)]))
    least, worst = np.inf, 0.0
    scale = np.linalg.cholesky(R)
    for frequency in np.sort(np.concatenate([tried, 0.5 * (tried[1:] + tried[:-1])])):
        x = np.linalg.solve(1j * frequency * np.eye(len(A)) - closed, B.astype(complex))
        cost = x.conj().T @ weight @ x + x.conj().T @ across + across.T @ x + R
        relative = np.linalg.solve(scale, np.linalg.solve(scale, cost).conj().T)
        lowest = float(np.linalg.eigvalsh(0.5 * (relative + relative.conj().T))[0])
        if lowest < least:
            least, worst = lowest, float(frequency)
    if least > NOTHING:
        return ""
    if least < -NOTHING:
        return (
            f"[lqr] Q: the cost has no lower bound, because at the frequency {worst:.6g} the negative weights "
            "exceed the cost of the inputs; use larger weights"
        )
    return (
        f"[lqr] Q: the cost has no minimum, because at the frequency {worst:.6g} the negative weights balance "
        "the cost of the inputs; use larger weights"
    )


def _listed(modes: list[Eigenvalue]) -> str:
    return ", ".join(shown(each.value) for each in modes if each.value.imag >= 0.0)


FIRST_STEP = 0.5
"""First step of doubling times the size of the Hamiltonian matrix."""


class NoLowerBound(ArithmeticError):
    """The cost has no lower bound over this length of time."""


class Flow(NamedTuple):
    """The matrices E, S and T, shape (n, n) each, of a linear-quadratic problem over a length of time.

    Over a time h the Hamiltonian system maps the state at the beginning and the costate at the end, x and mu, to
    E x - S mu at the end and T x + E' mu at the beginning. Two such steps in a row are one, with

        E <- E W E,    S <- S + E W S E',    T <- T + E' T W E,    W = (1 + S T)^-1.

    Nothing grows here however long the time: E tends to zero and T to the solution of the algebraic Riccati equation,
    with an error that is squared in every step (E. K.-W. Chu, H.-Y. Fan and W.-W. Lin, A structure-preserving doubling
    algorithm for continuous-time algebraic Riccati equations, Linear Algebra and its Applications 396, 2005).
    """

    E: Array
    S: Array
    T: Array

    def then(self, later: Flow) -> Flow:
        """Return the flow over this length of time followed by another.

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
        """Return the cost to go x'Px at the beginning, from the one at the end."""
        return _symmetric(self.T + self.E.T @ P @ np.linalg.solve(np.eye(len(P)) + self.S @ P, self.E))

    def closed(self, P: Array) -> Array:
        """Map the state at the beginning to that at the end under the optimal control, with final cost x'Px."""
        return np.linalg.solve(np.eye(len(P)) + self.S @ P, self.E)


def flow(A: Array, G: Array, Q: Array, length: float) -> Flow:
    """Return the flow of a linear-quadratic problem over a length of time.

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
