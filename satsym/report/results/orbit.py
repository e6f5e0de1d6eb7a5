"""The object of ``satsym analyse --json`` as a whole, and its part on an orbit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from satsym.analysis.orbits.elements import TOLERANCE
from satsym.report.display import length_unit, time_unit
from satsym.report.results.certificate import plain
from satsym.report.results.linear import analysis_object, attitudes_object, eigenvalue_object, exact
from satsym.report.results.objects import head_about
from satsym.status import Status

if TYPE_CHECKING:
    from satsym.analysis.orbits.elements import Elements
    from satsym.analysis.orbits.floquet import Floquet
    from satsym.analysis.orbits.point import Point
    from satsym.analysis.subject import Analysis, Survey
    from satsym.instance import Instance
    from satsym.kernels import Kernels
    from satsym.spec import ProblemSpec
    from satsym.symbolic import Derivation
    from satsym.symbolic.equilibria.momenta import Attitudes


def examination_object(
    given: Instance | Kernels,
    found: Analysis | None,
    orbit: Survey | None,
    derivation: Derivation | None = None,
    attitudes: Attitudes | None = None,
) -> dict[str, Any]:
    """Return the object of ``satsym analyse --json``.

    Parameters
    ----------
    given, found, orbit
        What was examined, and the two parts of what was found; see :func:`satsym.analysis.subject.examined`.
    derivation
        Of the model, where it is at hand; a shipped one is looked for.
    attitudes
        Its equilibria, where it is one attitude in orbit.
    """
    algebra, omitted = exact(found.about, derivation) if found else (None, "")
    linear = analysis_object(found, algebra, omitted)
    whole = head_about("analyse", given, Status.CONVERGED) | linear | orbit_object(orbit)
    return whole | ({"equilibria": attitudes_object(attitudes)} if attitudes else {})


def orbit_object(found: Survey | None) -> dict[str, Any]:
    """Return the keys ``orbit``, ``point`` and ``floquet``, each ``None`` where there is no orbit.

    Lengths and times are in the units of the model, angles in radians. ``status`` of ``floquet`` tells why there are no
    multipliers. ``matrix`` belongs to positions and velocities along inertial axes. ``lag`` is the distance by which a
    neighbour that is faster by a millionth at the start falls behind in a revolution.
    """
    if found is None:
        return {"orbit": None, "point": None, "floquet": None}
    orbit = _orbit(found.elements, found.case.model.spec)
    return plain({"orbit": orbit, "point": _point(found.point), "floquet": _floquet(found.floquet)})


def units(spec: ProblemSpec) -> tuple[str, str]:
    """Return the model's units of length and time, each ``"1"`` where it is not clear."""
    return length_unit(v.unit for v in spec.states), time_unit(v.unit for v in (*spec.states, *spec.controls))


def _orbit(found: Elements, spec: ProblemSpec) -> dict[str, Any]:
    length, time = units(spec)
    momentum = found.angular_momentum
    return (
        _named(found, "conic", "eccentricity", "semi_major_axis", "period", "energy")
        | {"angular_momentum": float(momentum @ momentum) ** 0.5, "angular_momentum_vector": momentum}
        | {"semi_latus_rectum": found.parameter}
        | _named(found, "periapsis", "apoapsis", "excess_speed", "inclination", "node", "periapsis_argument")
        | {"true_anomaly": found.true_anomaly, "tolerance": TOLERANCE, "units": {"length": length, "time": time}}
    )


def _point(found: Point) -> dict[str, Any]:
    own = None if found.own is None else {"eigenvalues": found.own, "rule_verdict": found.own_verdict}
    return (
        _named(found, "eigenvalues", "closed_form", "deviation", "rule_verdict", "conclusion_verdict")
        | {"own_coordinates": own}
        | _named(found, "note")
    )


def _floquet(found: Floquet) -> dict[str, Any]:
    matrix, axes = found.monodromy, found.turning
    turning = None
    if axes is not None:
        turning = {"model": axes.system.name, "eigenvalues": [eigenvalue_object(each) for each in axes.eigenvalues]}
    return (
        _named(found, "status", "multipliers")
        | _named(matrix, "determinant")
        | _named(found, "verdict", "note", "scatter", "expected_scatter", "lag")
        | _named(matrix, "growth", "error", "symplectic_defect", "second_singular", "square", "start")
        | {"matrix": None if matrix is None else matrix.original, "turning_axes": turning}
    )


def _named(record: object, *names: str) -> dict[str, Any]:
    """Return the named fields of a record; ``None`` for each where there is no record."""
    return {name: None if record is None else getattr(record, name) for name in names}
