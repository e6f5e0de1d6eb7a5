"""What the analysis of an orbit says to people, as plain text."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from satsym.analysis.orbits.conic import TOLERANCE, Conic
from satsym.analysis.orbits.floquet import FASTER
from satsym.report.display import time_scale
from satsym.report.results.orbit import units
from satsym.report.terminal.linear import complex_number
from satsym.report.terminal.solution import joined
from satsym.report.terminal.table import figure, table, wrapped

if TYPE_CHECKING:
    from satsym.analysis.orbits.floquet import Floquet
    from satsym.analysis.orbits.monodromy import Monodromy
    from satsym.analysis.orbits.point import Point
    from satsym.analysis.orbits.survey import Survey

DIGITS = 10


def orbit_text(found: Survey, colour: bool = False) -> str:
    """Summary of an orbit.

    Parameters
    ----------
    colour
        Whether the kind of orbit is coloured: green where it closes.
    """
    case, orbit = found.case, found.elements
    kind = orbit.conic.value
    if colour:
        kind = f"\x1b[{31 if orbit.period is None else 32}m{kind}\x1b[0m"
    length, time = units(case.model.spec)
    says = found.floquet.verdict or found.floquet.status
    return joined(
        [
            [*filter(None, [case.title]), f"{case.name}, model {case.model.spec.name}: {kind} ({says})"],
            _elements(found, length, time),
            wrapped(_tolerances(orbit.conic)),
            _point(found.point, length, time),
            wrapped(found.point.note),
            _revolution(found.floquet, length),
            wrapped(found.floquet.note),
            _turning(found.floquet, time),
        ]
    )


def _elements(found: Survey, length: str, time: str) -> list[str]:
    orbit = found.elements
    spec = found.case.model.spec
    own = orbit.period or 0.0
    factor, readable = time_scale((v.unit for v in spec.states), own)
    speed = _per(length, time)
    momentum = float(orbit.angular_momentum @ orbit.angular_momentum) ** 0.5
    rows = [
        ("eccentricity", orbit.eccentricity, ""),
        ("semi-major axis", orbit.semi_major_axis, length),
        ("semi-latus rectum", orbit.parameter, length),
        ("periapsis distance", orbit.periapsis, length),
        ("apoapsis distance", orbit.apoapsis, length),
        ("period", orbit.period, time),
        ("", None if readable in (time, "1") or orbit.period is None else own / factor, readable),
        ("energy", orbit.energy, _squared(length, time)),
        ("angular momentum", momentum, _per(f"{length}^2" if length != "1" else "1", time)),
        ("speed at infinity", orbit.excess_speed, speed),
        ("inclination", _degrees(orbit.inclination), "deg"),
        ("longitude of the node", _degrees(orbit.node), "deg"),
        ("argument of periapsis", _degrees(orbit.periapsis_argument), "deg"),
        ("true anomaly at the start", _degrees(orbit.true_anomaly), "deg"),
    ]
    shown = [
        (name, figure(value, DIGITS), unit if unit != "1" else "") for name, value, unit in rows if value is not None
    ]
    return table([("orbit", orbit.conic.value, "unit"), *shown], right=(1,))


def _tolerances(conic: Conic) -> str:
    border = {
        Conic.CIRCLE: f"a circle: the eccentricity is at most {TOLERANCE:g}",
        Conic.ELLIPSE: f"an ellipse: the eccentricity is above {TOLERANCE:g}, up to which it would be a circle, and "
        f"the square of the speed falls short of that of escape by more than a relative tolerance of {TOLERANCE:g}",
        Conic.PARABOLA: f"a parabola: the square of the speed is that of escape within a relative tolerance of "
        f"{TOLERANCE:g}",
        Conic.HYPERBOLA: f"a hyperbola: the square of the speed exceeds that of escape by more than a relative "
        f"tolerance of {TOLERANCE:g}",
        Conic.RECTILINEAR: f"rectilinear: the velocity is along the radius within {TOLERANCE:g} rad",
    }
    return f"called {border[conic]}"


def _point(found: Point, length: str, time: str) -> list[str]:
    at = f"{figure(found.distance, DIGITS)} {length}".removesuffix(" 1")
    header = ("eigenvalue", "closed form", "unit")
    pairs = zip(found.eigenvalues.tolist(), found.closed_form.tolist(), strict=True)
    unit = _per("1", time)
    rows = [(_rounded(value, found.deviation), complex_number(exact), unit) for value, exact in pairs]
    negative = f'"if all are negative": {found.conclusion_verdict or "undecided"}'
    own = []
    if found.own is not None:
        listed = ", ".join(_rounded(value, 1e-16) for value in found.own.tolist())
        own = wrapped(f"the same rule in the model's own coordinates: {found.own_verdict}, from {listed}")
    return [
        *wrapped(f"the Jacobian at the start, {at} from the centre:"),
        *table([header, *rows], right=(0, 1)),
        *wrapped(f'rule of the signs, "stable if all(e.real <= 0)": {found.rule_verdict}; {negative}'),
        *own,
    ]


def _revolution(found: Floquet, length: str) -> list[str]:
    matrix = found.monodromy
    if matrix is None or found.multipliers is None:
        return [f"  Floquet multipliers: {found.status}"]
    header = ("Floquet multipliers, computed", "distance from 1")
    rows = [(_rounded(value, 1e-12), figure(abs(value - 1.0), 2)) for value in found.multipliers.tolist()]
    return [*table([header, *rows], right=(0, 1)), "", *_checks(found, matrix, length)]


def _checks(found: Floquet, matrix: Monodromy, length: str) -> list[str]:
    unit = "" if length == "1" else f" {length}"
    at = "the start" if found.orbit.conic is Conic.CIRCLE else "apoapsis"
    rows = [
        ("exact multipliers", "6 times 1", "Jordan blocks 2, 1, 1, 1, 1"),
        (
            "scatter of the computed ones",
            figure(found.scatter or 0.0, 2),
            f"up to {figure(found.expected_scatter or 0.0, 2)} expected",
        ),
        ("det M - 1", figure(matrix.determinant - 1.0, 2), f"of the revolution from {at}"),
        ("M'JM - J", figure(matrix.symplectic_defect, 2), "relative: M is symplectic"),
        ("second singular value of M - I", figure(matrix.second_singular, 2), "relative: its rank is one"),
        ("(M - I)^2", figure(matrix.square, 2), "relative: it is nilpotent"),
        (
            "lag after a revolution",
            figure(found.lag or 0.0) + unit,
            f"if faster by {FASTER:g}; as much in each more",
        ),
    ]
    return table([("", "", ""), *rows], right=(1,))[1:]


def _turning(found: Floquet, time: str) -> list[str]:
    if found.turning is None:
        return []
    unit = _per("1", time)
    header = ("eigenvalue", "algebraic", "Jordan blocks", "unit")
    rows = [
        (complex_number(each.value), str(each.algebraic), ", ".join(map(str, each.blocks)), unit if each.value else "")
        for each in found.turning.eigenvalues
    ]
    says = (
        "These are Hill's equations (model hill) about the circle with this semi-major axis. There a circle is an "
        "equilibrium, where eigenvalues mean something: oscillations once a revolution, in and out of the plane, and "
        "a drift along the track from the block of size 2. Over a revolution each of them becomes exp(s T) = 1: the "
        "multipliers above. What they leave out is of the order of the eccentricity."
    )
    return [*wrapped("in axes that rotate with the orbit:"), *table([header, *rows], right=(0, 1)), "", *wrapped(says)]


def _rounded(value: complex, error: float) -> str:
    """The value without parts that its error may have made of zero."""
    limit = 10.0 * max(error, 1e-16) * abs(value)
    real, imag = (part if abs(part) > limit else 0.0 for part in (value.real, value.imag))
    return complex_number(complex(real, imag))


def _degrees(angle: float | None) -> float | None:
    return None if angle is None else math.degrees(angle)


def _per(length: str, time: str) -> str:
    return length if time == "1" else f"{length}/{time}"


def _squared(length: str, time: str) -> str:
    return "" if length == "1" else f"{length}^2" if time == "1" else f"{length}^2/{time}^2"
