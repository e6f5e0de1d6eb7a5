"""The analysis of an orbit as plain text."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from satsym.analysis.orbits.elements import TOLERANCE, Conic
from satsym.analysis.orbits.floquet import FASTER
from satsym.report.display import time_scale
from satsym.report.results.orbit import units
from satsym.report.said import each, message, say
from satsym.report.terminal.linear import complex_number
from satsym.report.terminal.table import figure, joined, table, wrapped

if TYPE_CHECKING:
    from satsym.analysis.orbits.floquet import Floquet
    from satsym.analysis.orbits.monodromy import Monodromy
    from satsym.analysis.orbits.point import Point
    from satsym.analysis.subject import Survey

DIGITS = 10


def orbit_text(found: Survey, colour: bool = False) -> str:
    """Summarise an orbit.

    Parameters
    ----------
    colour
        Whether the kind of orbit is coloured: green where it closes.
    """
    case, orbit = found.case, found.elements
    kind = message(orbit.conic.value)
    if colour:
        kind = f"\x1b[{31 if orbit.period is None else 32}m{kind}\x1b[0m"
    length, time = units(case.model.spec)
    says = message(found.floquet.verdict or found.floquet.status)
    return joined(
        [
            [
                *filter(None, [say(case.title)]),
                f"{say('<name>, model <model>', name=case.name, model=case.model.spec.name)}: {kind} ({says})",
            ],
            _elements(found, length, time),
            wrapped(say(_BORDERS[orbit.conic], tolerance=f"{TOLERANCE:g}")),
            _point(found.point, length, time),
            wrapped(message(found.point.note)),
            _revolution(found.floquet, length),
            wrapped(message(found.floquet.note)),
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
        (say("eccentricity"), orbit.eccentricity, ""),
        (say("semi-major axis"), orbit.semi_major_axis, length),
        (say("semi-latus rectum"), orbit.parameter, length),
        (say("periapsis distance"), orbit.periapsis, length),
        (say("apoapsis distance"), orbit.apoapsis, length),
        (say("period"), orbit.period, time),
        ("", None if readable in (time, "1") or orbit.period is None else own / factor, readable),
        (say("energy"), orbit.energy, _squared(length, time)),
        (say("angular momentum"), momentum, _per(f"{length}**2" if length != "1" else "1", time)),
        (say("hyperbolic excess speed"), orbit.excess_speed, speed),
        (say("inclination"), _degrees(orbit.inclination), "deg"),
        (say("longitude of the node"), _degrees(orbit.node), "deg"),
        (say("argument of periapsis"), _degrees(orbit.periapsis_argument), "deg"),
        (say("initial true anomaly"), _degrees(orbit.true_anomaly), "deg"),
    ]
    shown = [
        (name, figure(value, DIGITS), unit if unit != "1" else "") for name, value, unit in rows if value is not None
    ]
    return table([(say("orbit"), message(orbit.conic.value), say("unit")), *shown], right=(1,))


_BORDERS = {
    Conic.CIRCLE: "classified as a circle: the eccentricity is at most <tolerance>",
    Conic.ELLIPSE: "classified as an ellipse: the eccentricity exceeds <tolerance>, the limit for a circle, and the "
    "squared speed is below the squared escape speed by more than a relative <tolerance>",
    Conic.PARABOLA: "classified as a parabola: the squared speed equals the squared escape speed within a relative "
    "tolerance of <tolerance>",
    Conic.HYPERBOLA: "classified as a hyperbola: the squared speed exceeds the squared escape speed by more than a "
    "relative <tolerance>",
    Conic.RECTILINEAR: "classified as rectilinear: the velocity is along the radius within <tolerance> rad",
}


def _point(found: Point, length: str, time: str) -> list[str]:
    at = f"{figure(found.distance, DIGITS)} {length}".removesuffix(" 1")
    header = each("eigenvalue", "closed form", "unit")
    pairs = zip(found.eigenvalues.tolist(), found.closed_form.tolist(), strict=True)
    unit = _per("1", time)
    rows = [(_rounded(value, found.deviation), complex_number(exact), unit) for value, exact in pairs]
    rule = 'sign rule, "stable if all(e.real <= 0)": <verdict>; "if all are negative": <other>'
    verdict, other = message(found.rule_verdict), message(found.conclusion_verdict or "undecided")
    own = []
    if found.own is not None:
        listed = ", ".join(_rounded(value, 1e-16) for value in found.own.tolist())
        text = "the same rule in the model's own coordinates: <verdict>, from <eigenvalues>"
        own = wrapped(say(text, verdict=message(found.own_verdict or "undecided"), eigenvalues=listed))
    return [
        *wrapped(say("the Jacobian at the initial point, <distance> from the centre:", distance=at)),
        *table([header, *rows], right=(0, 1)),
        *wrapped(say(rule, verdict=verdict, other=other)),
        *own,
    ]


def _revolution(found: Floquet, length: str) -> list[str]:
    matrix = found.monodromy
    if matrix is None or found.multipliers is None:
        return wrapped(say("Floquet multipliers: <status>", status=message(found.status)))
    header = each("Floquet multipliers, computed", "distance from 1")
    rows = [(_rounded(value, 1e-12), figure(abs(value - 1.0), 2)) for value in found.multipliers.tolist()]
    return [*table([header, *rows], right=(0, 1)), "", *_checks(found, matrix, length)]


def _checks(found: Floquet, matrix: Monodromy, length: str) -> list[str]:
    unit = "" if length == "1" else f" {length}"
    circle = found.orbit.conic is Conic.CIRCLE
    rows = [
        (say("exact multipliers"), say("6 times 1"), say("Jordan blocks <sizes>", sizes="2, 1, 1, 1, 1")),
        (
            say("scatter of the computed multipliers"),
            figure(found.scatter or 0.0, 2),
            say("up to <scatter> expected", scatter=figure(found.expected_scatter or 0.0, 2)),
        ),
        (
            "det M - 1",
            figure(matrix.determinant - 1.0, 2),
            say("over one revolution from the initial point" if circle else "over one revolution from apoapsis"),
        ),
        ("M'JM - J", figure(matrix.symplectic_defect, 2), say("relative; 0 for a symplectic M")),
        (
            say("second singular value of M - I"),
            figure(matrix.second_singular, 2),
            say("relative; 0 for a matrix of rank one"),
        ),
        ("(M - I)^2", figure(matrix.square, 2), say("relative; 0 for a nilpotent M - I")),
        (
            say("lag per revolution"),
            figure(found.lag or 0.0) + unit,
            say("if the speed is <share> higher", share=f"{FASTER:g}"),
        ),
    ]
    return table([("", "", ""), *rows], right=(1,))[1:]


def _turning(found: Floquet, time: str) -> list[str]:
    if found.turning is None:
        return []
    unit = _per("1", time)
    header = each("eigenvalue", "algebraic", "Jordan blocks", "unit")
    rows = [
        (complex_number(one.value), str(one.algebraic), ", ".join(map(str, one.blocks)), unit if one.value else "")
        for one in found.turning.eigenvalues
    ]
    says = say(
        "These are Hill's equations (model hill) about the circular orbit with this semi-major axis. In these "
        "axes a circular orbit is an equilibrium, so the eigenvalues are meaningful: oscillations once per "
        "revolution, in the plane and out of it, and a drift along the track from the block of size 2. Over "
        "one revolution, each eigenvalue s gives exp(s T) = 1: these are the multipliers above. Terms of the "
        "order of the eccentricity are neglected."
    )
    return [
        *wrapped(say("in axes that rotate with the orbit:")),
        *table([header, *rows], right=(0, 1)),
        "",
        *wrapped(says),
    ]


def _rounded(value: complex, error: float) -> str:
    """Return the value without parts that its error may have caused instead of zero."""
    limit = 10.0 * max(error, 1e-16) * abs(value)
    real, imag = (part if abs(part) > limit else 0.0 for part in (value.real, value.imag))
    return complex_number(complex(real, imag))


def _degrees(angle: float | None) -> float | None:
    return None if angle is None else math.degrees(angle)


def _per(length: str, time: str) -> str:
    return length if time == "1" else f"{length}/{time}"


def _squared(length: str, time: str) -> str:
    return "" if length == "1" else f"{length}**2" if time == "1" else f"{length}**2/{time}**2"
