"""The surroundings of a path in a plane or in space: forbidden regions, points on the way, other orbits, the body."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from satsym import units
from satsym.arrays import Array
from satsym.report.display import plain
from satsym.report.plots import curves, legend, series, style
from satsym.report.plots.scene import Scene
from satsym.report.plots.space.views import View
from satsym.report.results import restrictions
from satsym.report.said import say

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Placing: TypeAlias = Callable[[Array], Array]
"""Function from states (n, N) to positions (2 or 3, N)."""
IDLE = 1e-6
"""Fraction of the largest thrust below which thrust counts as zero."""
BURNING = 0.02, 0.98
"""Range of the fraction of time with thrust within which burns are distinguished from coasting."""
UNMOVED_TOLERANCE = 1e-9
"""Relative change of values up to which a forbidden region counts as fixed."""
MOST_TURNS = 20
"""Largest number of durations for which another orbit is followed until it closes."""
STEPS = 720
"""Number of integration steps in each duration."""
SMALLEST_BODY = 0.02
"""Smallest radius of a body that is drawn to scale, relative to the size of the path."""


@dataclass(frozen=True, eq=False)
class Forbidden:
    """A region that path constraints forbid, in the plane of the picture.

    Attributes
    ----------
    in_plane
        From places (2, N) to the constraint, positive where it is violated.
    from_reference
        The same from distances along and above the circle of the reference; ``None`` where that changes with time.
    """

    in_plane: Placing | None
    from_reference: Placing | None


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Curves and points drawn beside the path, in the model's unit of length, shape (2 or 3, N)."""

    forbidden: tuple[Forbidden, ...] = ()
    passed: Array | None = None
    """Positions of the waypoints."""
    other: Array | None = None
    """The uncontrolled motion that the final state has to join, over one revolution."""
    other_start: Array | None = None
    """Initial position of the target on the uncontrolled motion that the final state has to join."""
    moving: Array | None = None
    """Positions of the target at equidistant times from the initial to the final time."""
    burns: Array | None = None
    """The path where there is thrust, NaN elsewhere; ``None`` if there is thrust everywhere."""
    radius: float = 0.0
    """Radius of the body at the origin; 0 if it is unknown or too small to be visible."""
    body: str = ""

    @classmethod
    def of(
        cls,
        scene: Scene,
        place: Placing,
        unit: str,
        thrust: Array | None,
        polar: tuple[int, int] | None,
        places: Sequence[int] = (),
    ) -> Surroundings:
        """Return the surroundings of the path of a scene.

        Parameters
        ----------
        place
            From states to places, at the nodes.
        unit
            Of length.
        thrust
            What the controls add, shape (2 or 3, N+1).
        polar, places
            States that are a distance and an angle; or those that are coordinates.
        """
        path, orbit = place(scene.x), scene.instance.orbit
        times = scene.passed
        passed = np.array([np.interp(times, scene.nodes, row) for row in path]) if times else None
        other = _joined(scene, place, polar) if polar else None
        return cls(
            tuple(_forbidden(scene, polar, places)),
            passed,
            other[0] if other else None,
            other[1][:, :1] if other and other[1] is not None else None,
            other[1] if other else None,
            _burns(scene, path, thrust),
            _radius(orbit.body.radius * 1e3 / units.in_base_units(unit), path) if orbit and unit != "1" else 0.0,
            orbit.centre if orbit and unit != "1" else "",
        )


NOTHING = Surroundings()
"""The surroundings of a path without any such objects."""


def draw(axes: Axes, around: Surroundings, view: View, datum: Array, scale: float) -> None:
    """Draw the surroundings in the plane of a view, whose limits are set.

    Parameters
    ----------
    datum, scale
        What is counted from, shape (2, 1), and the unit of the axes in that of the model.
    """
    seen = view.axes
    if around.radius:
        disc = _circle(around.radius) - datum
        axes.fill(*(disc * scale), **style.BODY)
    if view.axes.shape == (2, 2):
        across, up = (np.linspace(*limits, style.GRID) for limits in (axes.get_xlim(), axes.get_ylim()))
        grid = np.array(np.meshgrid(across, up)).reshape(2, -1) / scale + datum
        for one in around.forbidden:
            if one.in_plane is not None:
                style.hatch(axes, across, up, one.in_plane(seen.T @ grid).reshape(style.GRID, style.GRID))
    if around.other is not None:
        axes.plot(*((seen @ around.other - datum) * scale), **style.REFERENCE)
    if around.other_start is not None:
        axes.plot(*((seen @ around.other_start - datum) * scale), **style.OTHER)
    if around.burns is not None:
        axes.plot(*((seen @ around.burns - datum) * scale), **style.BURN)
    if around.passed is not None:
        axes.plot(*((seen @ around.passed - datum) * scale), **style.PASSED)


def before(around: Surroundings, view: View, curve: Array) -> Array:
    """Return a curve in the plane of a view, shape (2, N), NaN where it is behind the body."""
    seen = np.asarray(view.axes @ curve)
    if len(curve) < 3 or not around.radius:
        return seen
    behind = (np.cross(*view.axes) @ curve < 0.0) & (np.hypot(*seen) < around.radius)
    return np.where(behind, np.nan, seen)


def draw_from_reference(axes: Axes, around: Surroundings, scale: float) -> None:
    """Draw forbidden regions in the picture relative to the reference, whose limits are set."""
    across, up = (np.linspace(*limits, style.GRID) for limits in (axes.get_xlim(), axes.get_ylim()))
    grid = np.array(np.meshgrid(across, up)).reshape(2, -1) / scale
    for one in around.forbidden:
        if one.from_reference is not None:
            style.hatch(axes, across, up, one.from_reference(grid).reshape(style.GRID, style.GRID))


def entries(around: Surroundings) -> list[legend.Entry]:
    """Return the entries of a legend."""
    from matplotlib.patches import Patch

    found: list[legend.Entry] = []
    if around.burns is not None:
        found.append((legend.line(**style.BURN), say("burn")))
    if around.other is not None:
        found.append((legend.line(**style.REFERENCE), say("target orbit")))
    if around.other_start is not None:
        found.append((legend.line(**style.OTHER), say("target at the start")))
    if around.passed is not None:
        found.append((legend.line(**style.PASSED), say("waypoint")))
    if around.forbidden:
        found.append((Patch(**style.FORBIDDEN), say("inadmissible")))
    if around.radius:
        found.append((Patch(**style.BODY), plain(say(around.body))))
    return found


def _radius(radius: float, path: Array) -> float:
    """Return the radius of a body, or 0 where it would be a mere dot beside the path."""
    return radius if radius > SMALLEST_BODY * float(np.nanmax(np.abs(path))) else 0.0


def _circle(radius: float) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    return radius * np.array([np.cos(angle), np.sin(angle)])


def _forbidden(scene: Scene, polar: tuple[int, int] | None, places: Sequence[int]) -> list[Forbidden]:
    """Return the path constraints on coordinates alone."""
    if polar is None and len(places) != 2:
        return []
    coordinates = list(polar or places)
    found = []
    for one in restrictions.within(scene.restrictions, coordinates, timed=True):
        own = None if one.timed else _over_plane(one, coordinates, polar is not None)
        beside = _beside_reference(scene, one, polar) if polar and scene.reference is not None else None
        if own or beside:
            found.append(Forbidden(own, beside))
    return found


def _over_plane(one: restrictions.Restriction, coordinates: list[int], polar: bool) -> Placing:
    first, second = coordinates

    def field(points: Array) -> Array:
        if not polar:
            return one.values({first: points[0], second: points[1]})
        return one.values({first: np.hypot(*points), second: np.arctan2(points[1], points[0])})

    return field


def _beside_reference(scene: Scene, one: restrictions.Restriction, polar: tuple[int, int]) -> Placing | None:
    """Return the constraint over distances from the reference, if it is equal at start and end."""
    distance, angle = polar
    assert scene.reference is not None

    def at(node: int) -> Placing:
        r, theta = (float(scene.reference[i, node]) for i in polar)  # type: ignore[index]

        def field(points: Array) -> Array:
            along, above = points
            return one.values({distance: r + above, angle: theta + along / r}, float(scene.nodes[node]))

        return field

    size = float(np.abs(scene.x[distance][np.isfinite(scene.x[distance])]).max())
    probes = size * np.random.default_rng(0).uniform(-0.5, 0.5, (2, restrictions.PROBES))
    first, last = at(0)(probes), at(-1)(probes)
    unmoved = np.allclose(first, last, rtol=UNMOVED_TOLERANCE, atol=UNMOVED_TOLERANCE * np.abs(first).max())
    return at(0) if unmoved else None


def _burns(scene: Scene, path: Array, thrust: Array | None) -> Array | None:
    """Return the path where there is thrust, if there is none for some of the time."""
    if thrust is None:
        return None
    size = np.nan_to_num(np.linalg.norm(thrust, axis=0))
    on = size > IDLE * size.max(initial=0.0)
    spans = np.diff(scene.nodes)
    share = float((spans * (on[1:] & on[:-1])).sum() / spans.sum())
    return np.where(on, path, np.nan) if BURNING[0] < share < BURNING[1] else None


def _joined(scene: Scene, place: Placing, polar: tuple[int, int]) -> tuple[Array, Array | None] | None:
    """Return the uncontrolled motion that a final condition requires, or from start to end with a given angle.

    Every state must be given at the end except the angle, and those that do not change without control, such as a mass.
    """
    if scene.reference is not None or scene.coasting or not np.isfinite(scene.x[:, -1]).all():
        return None
    model, p = scene.instance.model, scene.instance.parameters
    _, angle = polar
    given = [series.target(scene, i) for i in range(len(scene.x))]
    at_rest = model.dynamics_batch(scene.nodes[-1:], scene.x[:, -1:], 0.0 * scene.u[:, -1:], p)[:, 0]
    if any(value is None and i != angle and at_rest[i] != 0.0 for i, value in enumerate(given)):
        return None
    end = np.array([x if value is None else value for x, value in zip(scene.x[:, -1], given, strict=True)])
    first, last = float(scene.nodes[0]), float(scene.nodes[-1])
    turned, whole, state = 0.0, [place(end[:, None])], end
    for _ in range(MOST_TURNS):
        x = curves.uncontrolled(model, np.linspace(last, 2.0 * last - first, STEPS), state.tolist(), p)
        if not np.isfinite(x).all():
            return None
        beyond = np.flatnonzero(np.abs(x[angle] - end[angle]) >= 2.0 * np.pi)
        whole.append(place(x[:, : beyond[0] + 1] if beyond.size else x))
        turned, state = abs(float(x[angle, -1] - end[angle])), x[:, -1]
        if beyond.size:
            break
    if turned == 0.0:
        return None
    back = curves.uncontrolled(model, np.linspace(last, first, STEPS), end.tolist(), p)
    until = place(back[:, ::-1]) if given[angle] is not None and np.isfinite(back).all() else None
    return np.hstack(whole), until
