"""The orbit of a motion, to scale: the whole conic with its foci and apses, and the part that is covered."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.analysis.orbits.kepler import propagate
from satsym.arrays import Array
from satsym.report import display
from satsym.report.plots import legend, style
from satsym.report.plots.space.views import View, few_ticks, views
from satsym.report.said import decimal, message, say
from satsym.report.terminal.table import figure
from satsym.status import BadInput

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from satsym.analysis.orbits.elements import Elements
    from satsym.analysis.subject import Survey

POINTS = 2000
ROUND_ECCENTRICITY = 0.02
"""Eccentricity above which the two foci can be distinguished in the picture."""
SMALLEST_REACH, MOST_REACH = 5.0, 40.0
"""Smallest and largest radius to which an open orbit is drawn, as multiples of periapsis and of the initial radius."""
CENTRE: dict[str, Any] = {"marker": "o", "markersize": 9.0, "color": "#E0A800", "linestyle": "none", "zorder": 3.9}
EMPTY: dict[str, Any] = {"marker": "x", "markersize": 7.0, "color": style.GREY, "linestyle": "none", "zorder": 3.8}
NEAREST: dict[str, Any] = {
    "marker": "v",
    "markersize": 7.0,
    "color": style.VERMILION,
    "linestyle": "none",
    "zorder": 4.0,
}
FARTHEST: dict[str, Any] = {"marker": "^", "markersize": 7.0, "color": style.GREEN, "linestyle": "none", "zorder": 4.0}
CONIC: dict[str, Any] = {"color": style.GREY, "linewidth": 1.1, "linestyle": (0, (5, 3)), "zorder": 2.1}
ASYMPTOTE: dict[str, Any] = {"color": style.GREY, "linewidth": 0.9, "linestyle": ":", "zorder": 1.9}
RING: dict[str, Any] = {"color": style.STATE, "markerfacecolor": "none", **style.START, "markersize": 11.0}
SIDE = 5.4
"""Side of a panel, in inches."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """The parts of a drawn orbit in the model's unit of length; curves have shape (3, N), points (3,)."""

    curve: Array
    """The whole conic, or the part of an open conic that fits into the picture."""
    travelled: Array | None
    """The motion of the instance, at most one revolution; ``None`` if its time is free or it meets the centre."""
    start: Array
    nearest: Array | None
    farthest: Array | None
    empty: Array | None
    """Nearest point, farthest point and empty focus; each is ``None`` if it does not exist."""
    asymptotes: tuple[Array, ...]
    """The two asymptotes of a hyperbola as rays from their intersection, shape (3, 2) each; otherwise empty."""

    @classmethod
    def of(cls, found: Survey) -> Drawn:
        """Sample the curves of an orbit."""
        orbit, travelled = found.elements, _travelled(found)
        axis, e = orbit.semi_major_axis, orbit.eccentricity
        start = orbit.position
        if orbit.parameter == 0.0 or orbit.inclination is None:
            end = orbit.towards * (orbit.apoapsis or SMALLEST_REACH * orbit.distance)
            return cls(np.vstack([np.zeros(3), end]).T, travelled, start, None, None, None, ())
        reach = max(SMALLEST_REACH * orbit.periapsis, orbit.distance)
        if travelled is not None:
            reach = max(reach, float(np.linalg.norm(travelled, axis=0).max()))
        reach = min(reach, MOST_REACH * max(orbit.periapsis, orbit.distance))
        nearest = orbit.periapsis * orbit.towards
        closed = orbit.period is not None and axis is not None
        return cls(
            curve=_ellipse(orbit) if closed else _open(orbit, reach),
            travelled=travelled,
            start=start,
            nearest=None if orbit.periapsis_argument is None else nearest,
            farthest=-orbit.apoapsis * orbit.towards
            if orbit.apoapsis and orbit.periapsis_argument is not None
            else None,
            empty=-2.0 * axis * e * orbit.towards if closed and axis and e > ROUND_ECCENTRICITY else None,
            asymptotes=_asymptotes(orbit, reach) if axis is not None and not closed and -axis * e < reach else (),
        )


def page(found: Survey) -> Figure:
    """Draw the orbit at equal scales, in its plane, and along the axes unless it lies in a plane of coordinates."""
    drawn, case = Drawn.of(found), found.case
    planes = views([drawn.curve], (r"$x$", r"$y$", r"$z$"))
    columns = style.across(min(2, len(planes)))
    rows = -(-len(planes) // columns)
    title = case.title or case.name
    sheet = style.titled(title, SIDE * columns + (1.6 if columns == 1 else 0.0), (SIDE - 0.2) * rows + 1.2)
    grid = sheet.add_gridspec(rows, columns)
    unit = display.length_unit(v.unit for v in case.model.spec.states)
    for i, view in enumerate(planes):
        axes = sheet.add_subplot(grid[i])
        factor, readable = panel(axes, drawn, view, unit)
        if i == 0:
            axes.set_title(", ".join(filter(None, [view.title, _caption(found.elements, factor, readable)])))
    legend.below(sheet, _entries(found, drawn))
    return sheet


def panel(axes: Axes, drawn: Drawn, view: View, unit: str) -> tuple[float, str]:
    """Draw a panel; return the unit of its axes in that of the model, and its name."""
    curves = [c for c in (drawn.curve, drawn.travelled) if c is not None]
    seen = np.hstack([view.axes @ curve for curve in curves] + [np.zeros((2, 1))])
    low, high = seen.min(axis=1), seen.max(axis=1)
    centre, half = 0.5 * (low + high), 0.54 * float((high - low).max())
    furthest = float(np.abs(centre).max()) + half
    factor, readable = display.length_scale(unit, furthest)
    measure = display.engineering(readable, furthest / factor)
    scale = 1.0 / (measure.divisor * factor)
    axes.set_aspect("equal")
    axes.set_xlim((centre[0] - half) * scale, (centre[0] + half) * scale)
    axes.set_ylim((centre[1] - half) * scale, (centre[1] + half) * scale)
    few_ticks(axes)
    for ray in drawn.asymptotes:
        axes.plot(*(view.axes @ ray * scale), **ASYMPTOTE)
    axes.plot(*(view.axes @ drawn.curve * scale), **CONIC)
    if drawn.travelled is not None:
        axes.plot(*(view.axes @ drawn.travelled * scale), color=style.STATE, **style.MAIN)
    marks = (
        (np.zeros(3), CENTRE),
        (drawn.empty, EMPTY),
        (drawn.nearest, NEAREST),
        (drawn.farthest, FARTHEST),
        (drawn.start, RING),
    )
    for point, look in marks:
        if point is not None:
            axes.plot(*(view.axes @ point[:, None] * scale), **look)
    axes.set_xlabel(display.labelled(view.labels[0], measure.unit))
    axes.set_ylabel(display.labelled(view.labels[1], measure.unit))
    return factor, readable


def _caption(orbit: Elements, factor: float, unit: str) -> str:
    """State the kind of orbit, and the numbers of its shape."""
    called = "" if unit == "1" else f" {unit}"
    apses = [(orbit.periapsis, say("periapsis")), (orbit.apoapsis, say("apoapsis"))]
    shown = [f"{what} {decimal(figure(value / factor))}{called}" for value, what in apses if value]
    return ", ".join([f"{message(orbit.conic.value)}: e = {decimal(figure(orbit.eccentricity))}", *shown])


def _entries(found: Survey, drawn: Drawn) -> list[legend.Entry]:
    orbit = found.elements
    once_round = found.case.tf is not None and found.case.tf - found.case.t0 >= (orbit.period or np.inf)
    entries: list[legend.Entry] = [] if once_round else [(legend.line(**CONIC), message(orbit.conic.value))]
    if drawn.travelled is not None:
        entries.append((legend.line(color=style.STATE, **style.MAIN), _flight(found)))
    entries += [(legend.line(**RING), say("start")), (legend.line(**CENTRE), say("centre, a focus"))]
    if drawn.empty is not None:
        entries.append((legend.line(**EMPTY), say("empty focus")))
    if drawn.nearest is not None:
        entries.append((legend.line(**NEAREST), say("periapsis")))
    if drawn.farthest is not None:
        entries.append((legend.line(**FARTHEST), say("apoapsis")))
    if drawn.asymptotes:
        entries.append((legend.line(**ASYMPTOTE), say("asymptotes")))
    return entries


def _flight(found: Survey) -> str:
    case = found.case
    assert case.tf is not None
    span = case.tf - case.t0
    factor, unit = display.time_scale((v.unit for v in case.model.spec.states), span)
    return say("trajectory, <span>", span=f"{decimal(figure(span / factor, 4))} {unit}".removesuffix(" 1"))


def _travelled(found: Survey) -> Array | None:
    """Return the uncontrolled motion from the start to the final time, at most once round."""
    orbit, case = found.elements, found.case
    if case.tf is None:
        return None
    duration = min(case.tf - case.t0, orbit.period or np.inf)
    try:
        places, _ = propagate(
            orbit.position[:, None], orbit.velocity[:, None], orbit.mu, np.linspace(0.0, duration, POINTS)
        )
    except BadInput:
        return None
    return places


def _ellipse(orbit: Elements) -> Array:
    """Return points of an ellipse, evenly in the eccentric anomaly, so that both ends are smooth."""
    assert orbit.semi_major_axis is not None
    angle = np.linspace(0.0, 2.0 * np.pi, POINTS)
    across = np.sqrt(orbit.semi_major_axis * orbit.parameter)
    return np.asarray(
        np.outer(orbit.towards, orbit.semi_major_axis * (np.cos(angle) - orbit.eccentricity))
        + np.outer(orbit.ahead, across * np.sin(angle))
    )


def _open(orbit: Elements, reach: float) -> Array:
    """Return points of a parabola or hyperbola up to a distance, evenly in the tangent of half the true anomaly."""
    e = orbit.eccentricity
    cosine = (orbit.parameter / reach - 1.0) / e
    last = np.sqrt(max(0.0, 1.0 - cosine) / (1.0 + cosine))
    tangent = np.linspace(-last, last, POINTS)
    angle = 2.0 * np.arctan(tangent)
    radius = orbit.parameter / (1.0 + e * np.cos(angle))
    return np.asarray(np.outer(orbit.towards, radius * np.cos(angle)) + np.outer(orbit.ahead, radius * np.sin(angle)))


def _asymptotes(orbit: Elements, reach: float) -> tuple[Array, ...]:
    """Return rays from the centre of a hyperbola, which lies beyond its periapsis."""
    assert orbit.semi_major_axis is not None
    e, middle = orbit.eccentricity, -orbit.semi_major_axis * orbit.eccentricity * orbit.towards
    rays = []
    for side in (-1.0, 1.0):
        away = (-orbit.towards + side * np.sqrt(e * e - 1.0) * orbit.ahead) / e
        rays.append(np.vstack([middle, middle + away * (reach + np.linalg.norm(middle))]).T)
    return tuple(rays)
