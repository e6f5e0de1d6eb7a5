"""Eigenvalues of the Jacobian at a point of an orbit, a rule on their signs, and what that rule can decide.

The rule is that of a paper (the ledger ``itb_eigen``): its program calls an orbit stable if
``all(e.real <= 0 for e in eigenvalues)``, its conclusion if all real parts are negative, and unstable if one is
positive. A point of an orbit is no equilibrium, so neither has a ground; both are computed here to be looked at.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym import kernels
from satsym.analysis.linear.equilibrium import jacobians
from satsym.analysis.orbits.elements import Elements
from satsym.analysis.orbits.states import checked
from satsym.arrays import Array
from satsym.instance import Instance

Complex = NDArray[np.complex128]
STABLE, UNSTABLE = "stable", "unstable"
CARTESIAN = "two_body"
"""The model whose generated Jacobian is that of the paper."""


@dataclass(frozen=True, eq=False)
class Point:
    """The eigenvalues of the Jacobian at a point of an orbit, and the verdicts drawn from them."""

    distance: float
    """Distance of the point from the centre of attraction."""
    eigenvalues: Complex
    """Computed eigenvalues of the generated Jacobian in Cartesian coordinates, shape (6,)."""
    closed_form: Complex
    """Eigenvalues by the closed form, exact up to rounding: sqrt(2 mu/r^3), minus that, and sqrt(-mu/r^3) of either
    sign, twice."""
    own: Complex | None
    """Eigenvalues of the model's Jacobian in its own coordinates, where they are not Cartesian; else ``None``."""

    @property
    def deviation(self) -> float:
        """Return the largest distance of computed eigenvalues from the closed form, relative to the largest."""
        return float(np.abs(self.eigenvalues - self.closed_form).max() / np.abs(self.closed_form).max())

    @property
    def rule_verdict(self) -> str:
        """Return ``"stable"`` or ``"unstable"`` by the rule of the paper's program."""
        return rule(self.eigenvalues)

    @property
    def conclusion_verdict(self) -> str | None:
        """Return the stability verdict by the paper's conclusion, ``None`` where that decides nothing."""
        return rule_of_the_conclusion(self.eigenvalues)

    @property
    def own_verdict(self) -> str | None:
        """Return the verdict of the program's rule for the model's own coordinates."""
        return None if self.own is None else rule(self.own)

    @property
    def note(self) -> str:
        """Explain what the eigenvalues can tell about the orbit, and what they cannot."""
        found = (
            "The eigenvalues are ±sqrt(2 mu/r^3) and, twice, ±i sqrt(mu/r^3): they depend on the distance r "
            "alone, not on the velocity. One of them is positive at every distance, so by this rule every orbit is "
            "unstable, whether circle, ellipse, parabola or hyperbola: the rule does not distinguish between orbits. "
            "The sum "
            "of the eigenvalues is zero, so they are never all negative, as asymptotic stability would "
            "require. No point of an orbit is an equilibrium, so the theorems about eigenvalues at equilibria "
            "do not apply."
        )
        if self.own is None:
            return found
        same = "calls the same orbit stable" if self.own_verdict == STABLE else "happens to give the same result"
        return (
            f"{found} In the model's own coordinates, the eigenvalues at this point are different, and the "
            f"rule {same}: away from equilibria, eigenvalues depend on the choice of coordinates, but "
            "stability does not."
        )


def rule(eigenvalues: Iterable[complex]) -> str:
    """Return the verdict of the paper's program on eigenvalues."""
    return STABLE if all(e.real <= 0 for e in eigenvalues) else UNSTABLE


def rule_of_the_conclusion(eigenvalues: Iterable[complex]) -> str | None:
    """Return the verdict of the paper's conclusion, which omits a largest real part of zero."""
    largest = max(e.real for e in eigenvalues)
    return UNSTABLE if largest > 0 else STABLE if largest < 0 else None


def at_start(case: Instance, orbit: Elements) -> Point:
    """Analyse the initial state of an instance of a Keplerian model.

    Parameters
    ----------
    case
        The instance; the Jacobian of its model in its own coordinates is analysed as well.
    orbit
        The orbit of the instance, whose start is the initial state in Cartesian coordinates.
    """
    scaled, (length,), (speed,) = checked(orbit.position, orbit.velocity, orbit.mu, 0.0).scaled()
    start = np.concatenate([scaled.position[:, 0], scaled.velocity[:, 0]])
    A, _ = jacobians(kernels.load(CARTESIAN), (float(scaled.mu[0]),), 0.0, start)
    pull = scaled.mu[0] / np.linalg.norm(scaled.position[:, 0]) ** 3
    rate = speed / length
    own = None
    cartesian = (*orbit.position, *orbit.velocity), (*orbit.position[:2], *orbit.velocity[:2])
    if case.initial not in cartesian:
        at = np.array(case.initial)
        own = _eigenvalues(jacobians(case.model, case.parameters, case.t0, at)[0])
    swing = np.sqrt(pull) * 1j
    closed_form = np.array([np.sqrt(2.0 * pull), swing, swing, -swing, -swing, -np.sqrt(2.0 * pull)])
    return Point(orbit.distance, _eigenvalues(A) * rate, closed_form * rate, own)


def _eigenvalues(A: Array) -> Complex:
    """Return the eigenvalues of a matrix, the largest real part first, then the largest imaginary part."""
    values = np.linalg.eigvals(A).astype(complex)
    size = np.abs(values).max() or 1.0
    return np.asarray(values[np.lexsort((-values.imag, -np.round(values.real / size, 9)))])
