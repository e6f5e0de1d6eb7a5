"""The case everyone integrates: the polar orbit under a smooth thrust, tabulated at nodes and midpoints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

START = (1.1, 0.02, -0.1, 0.9)
COSTATE = (0.1, -0.2, 0.3, 0.4)
PARAMETERS = (1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
"""sigma, omega, c1, c2 and the terminal weights k1 ... k4."""
T_FINAL = 6.0


def thrust(t: Array | float) -> Array:
    """Radial and tangential thrust, shape (2,) or (2, N)."""
    return np.array([0.1 * np.sin(3.0 * t), 0.05 * np.cos(t)])


@dataclass(frozen=True)
class Case:
    """Nodes and the control on them.

    Attributes
    ----------
    times
        Nodes, shape (N+1,).
    u, u_mid
        Control at nodes and midpoints, shapes (2, N+1) and (2, N).
    """

    times: Array
    u: Array
    u_mid: Array

    @property
    def steps(self) -> int:
        """Number of steps N."""
        return len(self.times) - 1


def case(steps: int = 1000) -> Case:
    """The case on a uniform grid."""
    times = np.linspace(0.0, T_FINAL, steps + 1)
    return Case(times, thrust(times), thrust(0.5 * (times[1:] + times[:-1])))
