"""The subject of an analysis, an instance or a model with its default parameters, and all numeric results on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from satsym import instance, kernels
from satsym.analysis.linear import rational
from satsym.analysis.linear.equilibrium import Linearisation, linearise
from satsym.analysis.linear.modes import Mode, modes
from satsym.analysis.linear.ranks import Reach, controllability, observability
from satsym.analysis.linear.routh import Routh, routh
from satsym.analysis.linear.spectrum import Eigenvalue, Stability, characteristic, spectra, stability
from satsym.analysis.linear.system import LinearSystem
from satsym.analysis.orbits.elements import Elements, elements
from satsym.analysis.orbits.floquet import Floquet, floquet
from satsym.analysis.orbits.point import Point, at_start
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.status import BadInput
from satsym.wording import printable, suggestion


def find(name: str) -> Instance | Kernels:
    """Return the instance, or else the model, of this name or at this path.

    Raises
    ------
    BadInput
        If there is neither, or it cannot be read.
    """
    if name in instance.shipped() or name.endswith(".toml"):
        found = instance.load(name)
        found.require_numbers()
        return found
    if name in kernels.shipped() or Path(f"{name}.py").is_file():
        return kernels.load(name)
    instead = suggestion(name, [*instance.shipped(), *kernels.shipped()])
    raise BadInput(
        f"{printable(name)}: there is no instance or model of this name; {instead} (`satsym instances` and `satsym "
        "models` list all; or give the path of a TOML file)"
    )


def examined(given: Instance | Kernels) -> tuple[Analysis | None, Survey | None]:
    """Analyse the linear system and the orbit of a subject; one of the two may be missing.

    A body under a central force alone has no equilibrium, so that without a reference it cannot be linearised.

    Raises
    ------
    BadInput
        If neither analysis is possible.
    """
    spec = given.spec if isinstance(given, Kernels) else given.model.spec
    if isinstance(given, Kernels):
        if spec.keplerian and not spec.has_reference:
            raise BadInput(
                f"{spec.name}: the model has neither an equilibrium nor a reference, and without an instance "
                "there is no initial state of an orbit; create an instance with an initial state"
            )
        return analyse(given), None
    orbit = survey(given) if spec.keplerian else None
    return analyse(given) if orbit is None or spec.has_reference else None, orbit


@dataclass(frozen=True, eq=False)
class Analysis:
    """The results on the linear system of a model."""

    about: Linearisation
    """The linear system, and the linearisation it comes from."""
    eigenvalues: tuple[Eigenvalue, ...]
    modes: tuple[Mode, ...]
    polynomial: Array
    routh: Routh
    stability: Stability
    """Stability of A, with its characteristic polynomial: monic, highest power first."""
    controllability: Reach | None
    observability: Reach | None
    """Controllability and observability; ``None`` where there are no inputs, or no outputs."""


def analyse(subject: Kernels | Instance) -> Analysis:
    """Analyse a linearised model, or instance; see :func:`satsym.analysis.linear.equilibrium.linearise`.

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
    """Return characteristic polynomial and Routh array, exact where the system is, and then rounded."""
    if given.exact is None:
        polynomial = characteristic(given.A)
        return polynomial, routh(
            polynomial.tolist(), [each.value for each in eigenvalues for _ in range(each.algebraic)]
        )
    coefficients = rational.characteristic(given.exact.A)
    return np.array(coefficients, dtype=float), routh(coefficients).rounded


def _verdict(about: Linearisation, possible: Sequence[Sequence[Eigenvalue]]) -> Stability:
    """Return the verdict of the eigenvalues, unless they leave it undecided."""
    if not about.constant:
        reason = "the coefficients depend on time, so the eigenvalues at one time do not decide the stability"
        return Stability(None, reason, False)
    found = stability(*possible)
    if found.decides or not about.nonlinear:
        return found
    reason = f"{found.reason}; the linearisation alone does not decide the stability of the nonlinear motion"
    return Stability(found.verdict, reason, False)


@dataclass(frozen=True, eq=False)
class Survey:
    """The orbit of an instance of a Keplerian model: its elements, the Jacobian at its start, one revolution."""

    case: Instance
    elements: Elements
    point: Point
    floquet: Floquet


def survey(case: Instance) -> Survey:
    """Analyse the uncontrolled orbit from the initial state of an instance.

    Parameters
    ----------
    case
        An instance of a model whose specification says ``keplerian``.

    Raises
    ------
    BadInput
        If the initial position is the centre, or numbers are beyond the range of floats.
    """
    try:
        state = case.model.inertial_state(case.t0, case.initial, case.parameters)
        found = elements(state[:3], state[3:6], state[6])
    except ArithmeticError:
        raise BadInput(
            f"{case.called}: [initial]: a result exceeds the range of floating-point numbers; check the units"
        ) from None
    except BadInput as error:
        raise BadInput(f"{case.called}: [initial]: {error}") from None
    return Survey(case, found, at_start(case, found), floquet(found))
