"""Floquet multipliers of an orbit: their exact values, the accuracy of computed ones, and stability.

All six multipliers of a closed orbit are exactly 1, with one Jordan block of size 2 (see
:mod:`satsym.analysis.orbits.monodromy`). An eigenvalue with such a block moves by the square root of a change of its
matrix, so computed multipliers scatter about 1 by some 1e-6, and may fall outside the unit circle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym import kernels
from satsym.analysis.linear.equilibrium import jacobians
from satsym.analysis.linear.spectrum import Eigenvalue, spectrum
from satsym.analysis.linear.system import LinearSystem, system
from satsym.analysis.orbits.elements import Conic, Elements
from satsym.analysis.orbits.monodromy import Monodromy, monodromy
from satsym.analysis.orbits.point import Complex
from satsym.solvers.simulation.extrapolation import NotFinite

COMPUTED, NO_PERIOD, COLLISION, NOT_RESOLVED = "computed", "no period", "collision", "not resolved"
VERDICT = "Lyapunov unstable, orbitally stable"
FASTER = 1e-6
"""Relative difference of speed of the neighbour in the notes."""
LOST = 1e-3
"""Largest error of a monodromy matrix, relative to its growth, from which multipliers are computed."""
_LEAVING = (
    "Neighbouring orbits depart in other directions and at other speeds, so the distances between them grow in "
    "proportion to time."
)
_ON_THE_BORDER = (
    "Neighbouring orbits are either ellipses, which return, or hyperbolas, which depart faster: the distances "
    "between them grow without bound."
)


@dataclass(frozen=True, eq=False)
class Floquet:
    """The Floquet multipliers of an orbit, or the reason why it has none."""

    status: str
    """``"computed"``, or the reason why there are no multipliers: ``"no period"``, ``"collision"``, ``"not resolved"``.
    """
    orbit: Elements
    """Closed orbit whose neighbours the multipliers describe."""
    monodromy: Monodromy | None
    """The monodromy matrix; ``None`` unless computed, as are all other numbers of this record."""
    multipliers: Complex | None
    """Floquet multipliers: eigenvalues of the monodromy matrix, shape (6,)."""
    turning: HillEquations | None
    """Hill's equations, where the orbit is nearly circular."""

    @property
    def verdict(self) -> str | None:
        """Return the stability verdict of a closed orbit, from the closed form without computed multipliers."""
        return None if self.orbit.period is None else VERDICT

    @property
    def scatter(self) -> float | None:
        """Return the largest distance of a computed multiplier from 1."""
        return None if self.multipliers is None else float(np.abs(self.multipliers - 1.0).max())

    @property
    def expected_scatter(self) -> float | None:
        """Return the scatter that the error of the matrix may cause: the root of error times growth."""
        return None if self.monodromy is None else float(np.sqrt(self.monodromy.error * self.monodromy.growth))

    @property
    def lag(self) -> float | None:
        """Return the distance by which a neighbour, faster at the start by ``FASTER``, falls behind in a revolution."""
        orbit = self.orbit
        if orbit.period is None or orbit.semi_major_axis is None:
            return None
        speed = float(np.linalg.norm(orbit.velocity))
        return FASTER * speed**3 * 3.0 * orbit.period * orbit.semi_major_axis / orbit.mu

    @property
    def note(self) -> str:
        """Explain what the verdict means and what the numbers cannot show, or why there are no multipliers."""
        if self.status == COLLISION:
            return (
                "The motion is along a line and reaches the centre, where its equations are singular: the "
                "motion has no period, hence no monodromy matrix and no multipliers."
            )
        if self.status == NO_PERIOD:
            return (
                f"{_called(self.orbit)} does not close: it has no period, and therefore neither a monodromy matrix "
                f"nor multipliers. {_LEAVING if self.orbit.excess_speed else _ON_THE_BORDER}"
            )
        closed = (
            "All six multipliers of a closed orbit are exactly 1, because the neighbouring orbits are closed "
            "as well: M - I = -(dT/dE) f (grad E)' has rank one and its square is zero, so M has one Jordan "
            "block of size 2 and four of size 1."
        )
        return f"{closed} {self._resolved} {self._meaning}"

    @property
    def _resolved(self) -> str:
        if self.scatter is None or self.expected_scatter is None or self.monodromy is None:
            return (
                f"The orbit passes the centre so closely (at {self._fraction:.3g} of its semi-major axis) that "
                "rounding errors dominate an integrated M, which is therefore not shown."
            )
        return (
            "The computed multipliers of such a block scatter by the square root of the error of M: here by "
            f"{self.scatter:.2g}, where an error of {self.monodromy.error:.2g} allows "
            f"{self.expected_scatter:.2g}. The computation therefore does not show on which side of the unit "
            "circle the multipliers lie; that they lie on the circle follows from the structure of M."
        )

    @property
    def _fraction(self) -> float:
        assert self.orbit.semi_major_axis is not None
        return self.orbit.periapsis / self.orbit.semi_major_axis

    @property
    def _meaning(self) -> str:
        return (
            "The block of size 2 means that a neighbouring motion with another energy has another period and "
            "falls behind or gets ahead by the same amount in each revolution. In Lyapunov's sense the orbit "
            "is therefore unstable, although distances grow only along the track and in proportion to time, "
            "not exponentially as a positive eigenvalue would imply. As a curve, the neighbouring "
            "orbit stays as close as it was initially: the orbit is orbitally stable."
        )


def floquet(orbit: Elements) -> Floquet:
    """Compute the Floquet multipliers of an orbit, or find why it has none; see :class:`Floquet`."""
    if orbit.period is None:
        falls = orbit.conic is Conic.RECTILINEAR and (orbit.bound or float(orbit.position @ orbit.velocity) < 0.0)
        return Floquet(COLLISION if falls else NO_PERIOD, orbit, None, None, None)
    turning = hill_equations(orbit)
    try:
        found = monodromy(orbit)
    except NotFinite:
        return Floquet(NOT_RESOLVED, orbit, None, None, turning)
    if not found.error <= LOST * found.growth:
        return Floquet(NOT_RESOLVED, orbit, None, None, turning)
    return Floquet(COMPUTED, orbit, found, _in_order(np.linalg.eigvals(found.matrix).astype(complex)), turning)


def _in_order(values: Complex) -> Complex:
    """Sort multipliers, farthest outside the unit circle first, conjugates together."""
    order = sorted(values.tolist(), key=lambda value: (-abs(value), value.real, -value.imag))
    return np.array(order)


def _called(orbit: Elements) -> str:
    return f"A {orbit.conic.value} orbit" if orbit.conic is Conic.RECTILINEAR else f"A {orbit.conic.value}"


MODEL = "hill"
NEARLY_CIRCULAR = 0.1
"""Largest eccentricity for which Hill's equations are compared; they neglect terms of this order."""


@dataclass(frozen=True, eq=False)
class HillEquations:
    """Hill's equations about the circle of an orbit's semi-major axis, with its eigenvalues and Jordan blocks.

    In axes that rotate with it a circle is an equilibrium, where eigenvalues do decide; over one revolution exp(A T) is
    the monodromy matrix in these axes.
    """

    system: LinearSystem
    eigenvalues: tuple[Eigenvalue, ...]


def hill_equations(orbit: Elements) -> HillEquations | None:
    """Return Hill's equations about an orbit; ``None`` unless the orbit is nearly circular."""
    if orbit.mean_motion is None or orbit.semi_major_axis is None or orbit.eccentricity > NEARLY_CIRCULAR:
        return None
    model = kernels.load(MODEL)
    A, B = jacobians(model, (orbit.semi_major_axis, orbit.mean_motion), 0.0, np.zeros(len(model.spec.states)))
    found = system(A, B, states=model.spec.state_names, inputs=model.spec.control_names, name=MODEL)
    return HillEquations(found, spectrum(A))
