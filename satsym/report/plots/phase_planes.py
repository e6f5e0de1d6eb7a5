"""Phase planes: a state against its rate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from satsym.arrays import Array
from satsym.report.plots import legend, series, style
from satsym.report.plots.panels import ticks
from satsym.report.plots.reading import Reading, read
from satsym.report.plots.scene import Scene
from satsym.report.results.restrictions import Restriction, within
from satsym.report.said import say
from satsym.solvers.collocation.scaling import final_argument

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROOM = 0.15
"""Margin beside a path, relative to its width, into which the switching curve is continued."""
MOST_PLANES = 4
"""Largest number of phase planes that are drawn."""


Field: TypeAlias = Callable[[Array, Array], Array]
"""A function of the values of the two states."""


@dataclass(frozen=True, eq=False)
class Plane:
    """A phase plane of two states, as they are shown."""

    across: Reading
    up: Reading
    forbidden: tuple[Field, ...] = ()
    """Path constraints that depend only on the two states of the plane."""
    switching: Field | None = None
    """Function that vanishes on the known switching curve of a minimum-time problem, otherwise ``None``."""
    passed: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    """Waypoints as displayed."""

    @property
    def target(self) -> tuple[float, float] | None:
        """Return the final point of the motion, if both values are given."""
        if self.across.target is None or self.up.target is None:
            return None
        return self.across.target, self.up.target


def of(scene: Scene) -> list[Plane]:
    """Return a plane for each state and its rate; for a system with two states theirs, whatever they are."""
    if not scene.drawable:
        return []
    states, rated = series.states(scene), scene.rated or ([(0, 1)] if len(scene.spec.states) == 2 else [])
    if len(rated) > MOST_PLANES:
        return []
    return [_plane(scene, i, j, *read([states[i]]), *read([states[j]])) for i, j in rated]


def _plane(scene: Scene, i: int, j: int, across: Reading, up: Reading) -> Plane:
    """Return the plane of two states, with what is drawn behind their path."""
    if isinstance(across.datum, np.ndarray) or isinstance(up.datum, np.ndarray):
        return Plane(across, up)  # deviations from a reference that moves

    def field(one: Restriction) -> Field:
        return lambda first, second: one.values({i: first, j: second})

    forbidden = tuple(field(one) for one in within(scene.restrictions, [i, j]))
    passed = [tuple(np.interp(scene.passed, scene.nodes, row.values).tolist()) for row in (across, up)]
    return Plane(across, up, forbidden, _switching(scene, i, j), (passed[0], passed[1]))


def _switching(scene: Scene, i: int, j: int) -> Field | None:
    """Return how far a position lies beyond the switching curve, by position and rate."""
    case, spec = scene.instance, scene.spec
    if tuple(spec.switching_curve) != (spec.states[i].symbol, spec.states[j].symbol):
        return None
    if any(not isinstance(case.final.get(name), float) for name in spec.switching_curve):
        return None
    if not (np.isfinite(case.lower).all() and np.isfinite(case.upper).all()):
        return None
    final, start = final_argument(case), np.array(case.initial)

    def beyond(first: Array, second: Array) -> Array:
        x = np.tile(start[:, None], first.size)
        x[i], x[j] = first.ravel(), second.ravel()
        t, bounds = np.full(first.size, case.t0), case.control_set.arguments
        found = case.model.beyond_switching_curve_batch(t, x, case.parameters, bounds, final)
        return np.asarray(found).reshape(first.shape)

    return beyond


def entries(planes: list[Plane]) -> list[legend.Entry]:
    """Return the entries of a legend that only these pictures have."""
    from matplotlib.patches import Patch

    found: list[legend.Entry] = [(legend.line(color=style.STATE, **style.START), say("start"))]
    found.append((legend.line(color=style.STATE, **style.END), say("end")))
    if any(plane.target is not None for plane in planes):
        found.append((legend.line(**style.TARGET), say("final condition")))
    if any(plane.switching is not None for plane in planes):
        found.append((legend.line(**style.CURVE), say("switching curve")))
    if any(plane.forbidden for plane in planes):
        found.append((Patch(**style.FORBIDDEN), say("inadmissible")))
    if any(plane.passed[0] for plane in planes):
        found.append((legend.line(**style.PASSED), say("waypoint")))
    return found


def draw(axes: Axes, plane: Plane) -> None:
    """Draw a phase plane."""
    across, up = plane.across, plane.up
    for limits, one in ((axes.set_xlim, across), (axes.set_ylim, up)):
        room = ROOM * (one.high - one.low) if plane.switching is not None else 0.0
        limits(one.low - room, one.high + room)
    _behind(axes, plane)
    for look, first, second in (
        (style.REFERENCE, across.reference, up.reference),
        (style.FREE, across.free, up.free),
        (style.MAIN | {"color": style.STATE}, across.values, up.values),
    ):
        if first is not None and second is not None:
            axes.plot(first, second, **look)
    if plane.target is not None:
        axes.plot(*plane.target, **style.TARGET)
    known = np.flatnonzero(np.isfinite(across.values) & np.isfinite(up.values))
    for place, look in ((known[:1], style.START), (known[-1:], style.END)):
        axes.plot(across.values[place], up.values[place], color=style.STATE, **look)
    ticks(axes.xaxis, across)
    ticks(axes.yaxis, up)
    axes.set_xlabel(across.label)
    axes.set_ylabel(up.label)


def _behind(axes: Axes, plane: Plane) -> None:
    """Draw what is forbidden, the switching curve and points on the way."""
    across, up = plane.across, plane.up
    places = [np.linspace(*limits, style.GRID) for limits in (axes.get_xlim(), axes.get_ylim())]
    grid = np.meshgrid(*places)
    values = across.value(grid[0]), up.value(grid[1])
    for forbidden in plane.forbidden:
        style.hatch(axes, places[0], places[1], forbidden(*values))
    if plane.switching is not None:
        look = style.CURVE
        axes.contour(
            *places,
            plane.switching(*values),
            levels=[0.0],
            colors=[look["color"]],
            linewidths=[style.points(look["linewidth"])],
            linestyles=[look["linestyle"]],
            zorder=look["zorder"],
        )
    axes.plot(*plane.passed, **style.PASSED)
