"""All that can be said of a model near its reference or an equilibrium, by numbers."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.analysis.linear.equilibrium import Linearisation, linearise
from satsym.analysis.linear.modes import Mode, modes
from satsym.analysis.linear.polynomials import characteristic
from satsym.analysis.linear.ranks import Reach, controllability, observability
from satsym.analysis.linear.routh import Routh, routh
from satsym.analysis.linear.spectrum import Eigenvalue, spectrum
from satsym.analysis.linear.stability import Stability, stability
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
    """Of A; the polynomial is monic, highest power first."""
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
    eigenvalues, polynomial = spectrum(system.A), characteristic(system.A)
    return Analysis(
        about=about,
        eigenvalues=eigenvalues,
        modes=modes(about, eigenvalues),
        polynomial=polynomial,
        routh=routh(polynomial.tolist(), [each.value for each in eigenvalues for _ in range(each.algebraic)]),
        stability=_verdict(about, eigenvalues),
        controllability=controllability(system) if system.inputs else None,
        observability=observability(system) if system.outputs else None,
    )


def _verdict(about: Linearisation, eigenvalues: tuple[Eigenvalue, ...]) -> Stability:
    """The verdict of the eigenvalues, unless they decide nothing."""
    if not about.constant:
        reason = "the coefficients depend on time, and eigenvalues at one time decide nothing"
        return Stability(None, reason, False)
    found = stability(eigenvalues)
    if found.decides or not about.nonlinear:
        return found
    reason = f"{found.reason}; of the nonlinear motion the linearisation alone decides nothing"
    return Stability(found.verdict, reason, False)
