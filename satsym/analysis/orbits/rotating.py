"""Motion near a circular orbit, in axes that turn with it: the tie between an orbit and the linear analysis.

In turning axes a circle is an equilibrium, where eigenvalues do decide. Hill's equations are the linearisation there.
Over one revolution, exp(A T) is the monodromy matrix in these axes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym import kernels
from satsym.analysis.linear.equilibrium import jacobians
from satsym.analysis.linear.spectrum import Eigenvalue, spectrum
from satsym.analysis.linear.system import LinearSystem, system
from satsym.analysis.orbits.elements import Elements

MODEL = "hill"
NEARLY_CIRCULAR = 0.1
"""Up to this eccentricity Hill's equations say something of an orbit: they leave out what is of its order."""


@dataclass(frozen=True, eq=False)
class TurningAxes:
    """Hill's equations about the circle of an orbit's semi-major axis, with its eigenvalues and Jordan blocks."""

    system: LinearSystem
    eigenvalues: tuple[Eigenvalue, ...]


def turning_axes(orbit: Elements) -> TurningAxes | None:
    """The linearisation in turning axes; ``None`` unless the orbit is nearly circular."""
    if orbit.mean_motion is None or orbit.semi_major_axis is None or orbit.eccentricity > NEARLY_CIRCULAR:
        return None
    model = kernels.load(MODEL)
    A, B = jacobians(model, (orbit.semi_major_axis, orbit.mean_motion), 0.0, np.zeros(len(model.spec.states)))
    found = system(A, B, states=model.spec.state_names, inputs=model.spec.control_names, name=MODEL)
    return TurningAxes(found, spectrum(A))
