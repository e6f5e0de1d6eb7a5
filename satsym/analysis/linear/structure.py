"""All that can be said of a model near its reference or an equilibrium, by numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from satsym.analysis.linear import rational
from satsym.analysis.linear.equilibrium import Linearisation, linearise
from satsym.analysis.linear.modes import Mode, modes
from satsym.analysis.linear.ranks import Reach, controllability, observability
from satsym.analysis.linear.routh import Routh, routh
from satsym.analysis.linear.spectrum import Eigenvalue, Stability, characteristic, spectra, stability
from satsym.analysis.linear.system import LinearSystem
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels import Kernels


@dataclass(frozen=True, eq=False)
class Analysis:
    """The structure of a linear system."""

    about: Linearisation
    """The system, and what it is the linearisation of."""
    eigenvalues: tuple[Eigenvalue, ...]
    modes: tuple[Mode, ...]
    polynomial: Array
    routh: Routh
    stability: Stability
    """Stability of A, with its characteristic polynomial: monic, highest power first."""
    controllability: Reach | None
    observability: Reach | None
    """``None`` where there are no inputs, or no outputs."""


def analyse(subject: Kernels | Instance) -> Analysis:
    """Analyse a model, or an instance of one; see :func:`satsym.analysis.linear.equilibrium.linearise`.

    Raises
    ------
    BadInput
        If there is nothing to linearise it about.
    """
    about = linearise(subject)
    system = about.system
    possible = spectra(system)
    eigenvalues = possible[0]
    polynomial, array = _polynomial(system, eigenvalues)
    return Analysis(
        about=about,
        eigenvalues=eigenvalues,
        modes=modes(about, eigenvalues),
        polynomial=polynomial,
        routh=array,
        stability=_verdict(about, possible),
        controllability=controllability(system) if system.inputs else None,
        observability=observability(system) if system.outputs else None,
    )


def _polynomial(given: LinearSystem, eigenvalues: Sequence[Eigenvalue]) -> tuple[Array, Routh]:
    """Characteristic polynomial and Routh array, both exact and then rounded where the system is known exactly."""
    if given.exact is None:
        polynomial = characteristic(given.A)
        return polynomial, routh(
            polynomial.tolist(), [each.value for each in eigenvalues for _ in range(each.algebraic)]
        )
    coefficients = rational.characteristic(given.exact.A)
    return np.array(coefficients, dtype=float), routh(coefficients).rounded


def _verdict(about: Linearisation, possible: Sequence[Sequence[Eigenvalue]]) -> Stability:
    """The verdict of the eigenvalues, unless they decide nothing."""
    if not about.constant:
        reason = "the coefficients depend on time, and eigenvalues at one time decide nothing"
        return Stability(None, reason, False)
    found = stability(*possible)
    if found.decides or not about.nonlinear:
        return found
    reason = f"{found.reason}; for the nonlinear motion, the linearisation alone decides nothing"
    return Stability(found.verdict, reason, False)
