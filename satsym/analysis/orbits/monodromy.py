"""The monodromy matrix of a closed orbit: the effect of a revolution on small deviations.

In Cartesian coordinates, with f the rates of change and E the energy per unit mass, it is exactly

    M = I - (dT/dE) f (grad E)',    T = 2 pi sqrt(a^3/mu),    dT/dE = 3 T a/mu,

for every neighbour is closed too and merely comes too early or too late (differentiate phi(T(E(x)), x) = x). The matrix
M - I has rank one, and because E is conserved, (grad E)' f = 0, its square is zero. Here M is integrated; the formula
tells its error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from satsym import kernels
from satsym.analysis.orbits.elements import Conic, Elements
from satsym.analysis.orbits.point import CARTESIAN
from satsym.arrays import Array
from satsym.kernels import Kernels
from satsym.solvers.simulation.extrapolation import integrate

SYMPLECTIC = np.block([[np.zeros((3, 3)), np.eye(3)], [-np.eye(3), np.zeros((3, 3))]])
"""The matrix J of the symplectic form: positions and velocities per unit mass are canonical."""


@dataclass(frozen=True, eq=False)
class Monodromy:
    """An integrated monodromy matrix, in units of length and speed in which the orbit is of size one."""

    start: Array
    """The initial and final state of the revolution, shape (6,)."""
    matrix: Array
    """The integrated matrix, shape (6, 6)."""
    exact: Array
    """The matrix by the closed formula."""
    units: Array
    """Units of the three positions and the three velocities, powers of two, shape (6,)."""

    @property
    def original(self) -> Array:
        """Return the matrix in the units of the orbit."""
        return np.asarray(self.matrix * self.units[:, None] / self.units)

    @property
    def determinant(self) -> float:
        """Return the determinant, which is 1 for a motion whose rates have no divergence."""
        return float(np.linalg.det(self.matrix))

    @property
    def symplectic_defect(self) -> float:
        """Return the largest entry of M'JM - J, relative to the square of the largest of M.

        It is zero for a Hamiltonian motion.
        """
        left = self.matrix.T @ SYMPLECTIC @ self.matrix - SYMPLECTIC
        return float(np.abs(left).max() / np.abs(self.matrix).max() ** 2)

    @property
    def growth(self) -> float:
        """Return the norm of M - I: how much a deviation grows in each revolution."""
        return _norm(self.exact - np.eye(6))

    @property
    def error(self) -> float:
        """Return the norm of the difference between the integrated matrix and the formula."""
        return _norm(self.matrix - self.exact)

    @property
    def second_singular(self) -> float:
        """Return the second singular value of M - I relative to the first: zero where the rank is one."""
        values = np.linalg.svd(self.matrix - np.eye(6), compute_uv=False)
        return float(values[1] / values[0])

    @property
    def square(self) -> float:
        """Return the norm of (M - I)^2 relative to the squared norm of M - I: zero where it is nilpotent."""
        rest = self.matrix - np.eye(6)
        return _norm(rest @ rest) / _norm(rest) ** 2


def monodromy(orbit: Elements, from_apoapsis: bool = True) -> Monodromy:
    """Integrate the variational equations of a closed orbit over one revolution.

    Parameters
    ----------
    orbit
        A circle or an ellipse.
    from_apoapsis
        Whether the revolution starts at the apoapsis and not at the orbit's own start. The matrices are similar; at
        apoapsis deviations grow least, so that least is lost in rounding. A circle has no apoapsis.

    Raises
    ------
    ValueError
        If the orbit is not closed.
    satsym.solvers.simulation.extrapolation.NotFinite
        If it passes the centre too closely to be integrated.
    """
    if orbit.period is None or orbit.semi_major_axis is None:
        raise ValueError(f"a {orbit.conic.value} has no monodromy matrix")
    length = float(np.exp2(np.rint(np.log2(orbit.semi_major_axis))))
    speed = float(np.exp2(np.rint(0.5 * np.log2(orbit.mu / orbit.semi_major_axis))))
    units = np.repeat([length, speed], 3)
    apoapsis = from_apoapsis and orbit.conic is not Conic.CIRCLE
    start = (_at_apoapsis(orbit) if apoapsis else np.concatenate([orbit.position, orbit.velocity])) / units
    mu, period = orbit.mu / length / speed**2, orbit.period * (speed / length)
    _, matrix = transition(kernels.load(CARTESIAN), (mu,), start, period)
    return Monodromy(start * units, matrix, _exact(start, mu, period, orbit.semi_major_axis / length), units)


def _exact(start: Array, mu: float, period: float, axis: float) -> Array:
    pull = mu * start[:3] / np.linalg.norm(start[:3]) ** 3
    rates, gradient = np.concatenate([start[3:], -pull]), np.concatenate([pull, start[3:]])
    return np.asarray(np.eye(6) - 3.0 * period * axis / mu * np.outer(rates, gradient))


def _at_apoapsis(orbit: Elements) -> Array:
    assert orbit.apoapsis is not None
    speed = np.linalg.norm(orbit.angular_momentum) / orbit.apoapsis
    return np.concatenate([-orbit.apoapsis * orbit.towards, -speed * orbit.ahead])


def _norm(matrix: Array) -> float:
    return float(np.linalg.norm(matrix, 2))


ACCURACY = 1e-14
"""Largest error of an integration step, relative to the size of the states; smaller errors are rounding."""


def transition(
    model: Kernels, p: Sequence[float], start: Array, duration: float, t0: float = 0.0, size: Array | None = None
) -> tuple[Array, Array]:
    """Integrate a state over a time without control, together with its derivative by the initial state.

    Both are integrated together with the generated ``dynamics`` and ``jacobian_x``, to the last digits.

    Parameters
    ----------
    model, p
        The model and its parameters.
    start
        State at t0, shape (n,).
    duration
        Length of time; negative to integrate backward.
    t0
        Initial time, for models that depend on time.
    size
        Typical sizes of the states, shape (n,); 1 by default. Errors are counted in them.

    Returns
    -------
    end : array of shape (n,)
    Phi : array of shape (n, n)
        d(end)/d(start).

    Raises
    ------
    satsym.solvers.simulation.extrapolation.NotFinite
        If the motion does not last as long.
    """
    n, rest = len(start), (0.0,) * len(model.spec.controls)
    unit = np.ones(n) if size is None else np.asarray(size, dtype=float)

    def rates(t: float, y: Array) -> Array:
        x = (y[:n] * unit).tolist()
        try:
            slope, A = model.dynamics(t, x, rest, p), model.jacobian_x(t, x, rest, p)
        except ArithmeticError:
            return np.full_like(y, np.nan)
        # the matrix is carried in the units as well, and so of size one
        scaled = np.array(A).reshape(n, n) * unit / unit[:, None]
        return np.concatenate([slope / unit, (scaled @ y[n:].reshape(n, n)).ravel()])

    begin = np.concatenate([np.asarray(start, dtype=float) / unit, np.eye(n).ravel()])
    (piece,) = integrate(rates, np.array([t0, t0 + duration]), begin, ACCURACY, np.ones(n + n * n))
    return piece.end[:n] * unit, piece.end[n:].reshape(n, n) * unit[:, None] / unit
