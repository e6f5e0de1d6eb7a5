"""What ``satsym analyse --json`` prints: all of it, and what it has of an orbit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from satsym.analysis.orbits.conic import TOLERANCE
from satsym.report.display import length_unit, time_unit
from satsym.report.results.linear import analysis_object, complex_object, eigenvalue_object, numbers, rows
from satsym.report.results.objects import head_about, number
from satsym.status import Status

if TYPE_CHECKING:
    from satsym.analysis.linear.structure import Analysis
    from satsym.analysis.orbits.elements import Elements
    from satsym.analysis.orbits.floquet import Floquet
    from satsym.analysis.orbits.point import Point
    from satsym.analysis.orbits.survey import Survey
    from satsym.instance import Instance
    from satsym.kernels import Kernels
    from satsym.spec import ProblemSpec
    from satsym.symbolic import Derivation


def examination_object(
    given: Instance | Kernels, found: Analysis | None, orbit: Survey | None, derivation: Derivation | None = None
) -> dict[str, Any]:
    """What ``satsym analyse --json`` prints.

    Parameters
    ----------
    given, found, orbit
        What was examined, and the two parts of what was found; see :func:`satsym.analysis.subject.examined`.
    derivation
        Of the model, where it is at hand; a shipped one is looked for.
    """
    algebra = exact(found.about.model, derivation) if found else None
    return head_about("analyse", given, Status.CONVERGED) | analysis_object(found, algebra) | orbit_object(orbit)


def orbit_object(found: Survey | None) -> dict[str, Any]:
    """The keys ``orbit``, ``point`` and ``floquet``, each ``None`` for what is no orbit.

    Lengths and times are in the units of the model, angles in radians. ``status`` of ``floquet`` tells why there are no
    multipliers. ``matrix`` belongs to positions and velocities along inertial axes. ``lag`` is the distance by which a
    neighbour that is faster by a millionth at the start falls behind in a revolution.
    """
    if found is None:
        return {"orbit": None, "point": None, "floquet": None}
    return {
        "orbit": _orbit(found.elements, found.case.model.spec),
        "point": _point(found.point),
        "floquet": _floquet(found.floquet),
    }


def units(spec: ProblemSpec) -> tuple[str, str]:
    """The model's units of length and time, each ``"1"`` where it is not clear."""
    return length_unit(v.unit for v in spec.states), time_unit(v.unit for v in (*spec.states, *spec.controls))


def _orbit(found: Elements, spec: ProblemSpec) -> dict[str, Any]:
    length, time = units(spec)
    momentum = found.angular_momentum
    return {
        "conic": found.conic.value,
        "eccentricity": number(found.eccentricity),
        "semi_major_axis": number(found.semi_major_axis),
        "period": number(found.period),
        "energy": number(found.energy),
        "angular_momentum": number(float(momentum @ momentum) ** 0.5),
        "angular_momentum_vector": numbers(momentum),
        "semi_latus_rectum": number(found.parameter),
        "periapsis": number(found.periapsis),
        "apoapsis": number(found.apoapsis),
        "excess_speed": number(found.excess_speed),
        "inclination": number(found.inclination),
        "node": number(found.node),
        "periapsis_argument": number(found.periapsis_argument),
        "true_anomaly": number(found.true_anomaly),
        "tolerance": TOLERANCE,
        "units": {"length": length, "time": time},
    }


def _point(found: Point) -> dict[str, Any]:
    own = None
    if found.own is not None:
        own = {"eigenvalues": [complex_object(value) for value in found.own], "rule_verdict": found.own_verdict}
    return {
        "eigenvalues": [complex_object(value) for value in found.eigenvalues],
        "closed_form": [complex_object(value) for value in found.closed_form],
        "deviation": number(found.deviation),
        "rule_verdict": found.rule_verdict,
        "conclusion_verdict": found.conclusion_verdict,
        "own_coordinates": own,
        "note": found.note,
    }


def _floquet(found: Floquet) -> dict[str, Any]:
    matrix, turning = found.monodromy, found.turning
    return {
        "status": found.status,
        "multipliers": None if found.multipliers is None else [complex_object(value) for value in found.multipliers],
        "determinant": None if matrix is None else number(matrix.determinant),
        "verdict": found.verdict,
        "note": found.note,
        "scatter": number(found.scatter),
        "expected_scatter": number(found.expected_scatter),
        "lag": number(found.lag),
        "growth": None if matrix is None else number(matrix.growth),
        "error": None if matrix is None else number(matrix.error),
        "symplectic_defect": None if matrix is None else number(matrix.symplectic_defect),
        "second_singular": None if matrix is None else number(matrix.second_singular),
        "square": None if matrix is None else number(matrix.square),
        "start": None if matrix is None else numbers(matrix.start),
        "matrix": None if matrix is None else rows(matrix.original),
        "turning_axes": None
        if turning is None
        else {"model": turning.system.name, "eigenvalues": [eigenvalue_object(each) for each in turning.eigenvalues]},
    }


def exact(model: Kernels, derivation: Derivation | None = None) -> dict[str, Any] | None:
    """What sympy finds about a linear model, as ``satsym analyse --json`` prints it.

    Parameters
    ----------
    derivation
        Of the model; by default that of a shipped one.

    Returns
    -------
    dict or None
        ``None`` for a model whose derivation is not at hand, because it was loaded by path, that is not linear with
        constant coefficients, or whose entries are beyond exact linear algebra.
    """
    shipped = model.origin is not None and model.origin[1] is None
    if not model.spec.linear or not (shipped or derivation):
        return None
    from satsym.status import BadInput
    from satsym.symbolic import DerivationError
    from satsym.symbolic.analysis import NotExact, analyse
    from satsym.symbolic.analysis.listing import exact_object
    from satsym.symbolic.linear.matrices import system_of
    from satsym.symbolic.lookup import library

    try:
        return exact_object(analyse(system_of(derivation or library.derivation(model.spec.name))))
    except (BadInput, DerivationError, NotExact):
        return None
