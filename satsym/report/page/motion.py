"""The motion as a small animation in SVG and CSS alone, with a pause; still where animations are not wanted."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from satsym.arrays import Array
from satsym.report.display import number, unit_text
from satsym.report.html.markup import Markup, joined, tag
from satsym.report.plots.reading import box
from satsym.report.plots.scene import Scene
from satsym.report.plots.scenes import Orbit
from satsym.report.plots.space.attitudes import Attitude
from satsym.report.plots.space.views import from_aside
from satsym.report.said import decimal
from satsym.report.texts import Texts

SIDE = 400.0
"""Side of the picture, in its own units."""
FRAMES = 120
UNSEEN = 0.02
"""Largest distance from the reference, relative to the orbit, that is hardly visible in the picture."""
TURNS, SECONDS = 40, 10.0
"""Number of pictures of a rotating body, and duration of the animation in seconds, as in the style sheet."""
BODY = 0.55, 0.4, 0.28
"""Half the lengths of the box's sides."""
_SIGNS = (-1.0, 1.0)
_CORNERS = [np.array([x * BODY[0], y * BODY[1], z * BODY[2]]) for x in _SIGNS for y in _SIGNS for z in _SIGNS]
EDGES = [
    np.column_stack([one, other])
    for k, one in enumerate(_CORNERS)
    for other in _CORNERS[k + 1 :]
    if np.count_nonzero(one != other) == 1
]
"""Edges of the box, shape (3, 2) each."""

GRID = 81
"""Number of points along each side of the grid on which forbidden regions are computed."""
CAPTIONED = ("reference", "other", "met", "free", "burns", "target", "passed")
"""Parts of a picture that its caption explains where they are drawn; the path is always explained."""
MARKED = {"target": "9", "passed": "5"}
"""Radii of the marks of the final condition, and of waypoints."""

Placing: TypeAlias = Callable[[Array], Array]
"""A function from points of a plane to points of the picture, shapes (2, N)."""


def motion(scene: Scene, texts: Texts, driven: bool = False) -> Markup:
    """Return a figure: the path in space, else the body that turns; empty where states give neither.

    Parameters
    ----------
    driven
        Whether the page has a slider, which sets the time of the animation.
    """
    orbit = Orbit.of(scene)
    if orbit is None:
        attitude = Attitude.of(scene)
        return Markup() if attitude is None else _turning(scene, attitude, texts, driven)
    if (drawn := _from_reference(scene, orbit, texts, driven)) is not None:
        return drawn
    view, known = orbit.views[0].axes, np.isfinite(orbit.path).all(axis=0)
    around = orbit.around
    curves = {"reference": orbit.reference, "free": orbit.free, "path": orbit.path}
    seen = {name: view @ curve[:, known] for name, curve in curves.items() if curve is not None}
    if around.other is not None:
        seen["other"] = view @ around.other
    if around.burns is not None:
        seen["burns"] = view @ around.burns[:, known]
    moving: dict[str, tuple[Array, Array]] = {}
    moving |= {name: (scene.nodes[known], seen[name]) for name in ("reference", "path") if name in seen}
    if around.moving is not None:
        moving["met"] = np.linspace(scene.nodes[0], scene.nodes[-1], around.moving.shape[1]), view @ around.moving
    points = {"target": orbit.target, "passed": around.passed}
    marked = {name: view @ places for name, places in points.items() if places is not None}
    walls = [one.in_plane for one in around.forbidden if one.in_plane is not None and view.shape == (2, 2)]
    fields = [lambda seen, wall=wall: wall(view.T @ seen) for wall in walls]
    inside = _moving(seen, moving, orbit.central, marked, fields)
    captions = ["path", *(name for name in CAPTIONED if name in seen or name in moving or name in marked)]
    if marked.get("passed", np.zeros((2, 1))).shape[1] > 1:
        captions[captions.index("passed")] = "passed_many"
    captions += ["inside"] if fields else []
    return _figure(scene, inside, texts, "motion", [texts.get("page", f"motion_{name}") for name in captions], driven)


def _from_reference(scene: Scene, orbit: Orbit, texts: Texts, driven: bool) -> Markup | None:
    """Draw the path relative to the reference if the two could not be distinguished in space."""
    if orbit.relative is None or orbit.reference is None:
        return None
    seen = {"free": orbit.free_relative, "path": orbit.relative}
    curves = {name: np.vstack([one.along, one.radial]) for name, one in seen.items() if one is not None}
    known = np.isfinite(curves["path"]).all(axis=0)
    curves = {name: curve[:, known] for name, curve in curves.items()}
    if np.abs(curves["path"]).max() >= UNSEEN * np.linalg.norm(orbit.reference, axis=0).max():
        return None
    inside = _moving(curves, {"path": (scene.nodes[known], curves["path"])}, True)
    captions = ["seen", "path", *(["free"] if "free" in curves else [])]
    return _figure(scene, inside, texts, "motion", [texts.get("page", f"motion_{name}") for name in captions], driven)


def _moving(
    seen: Mapping[str, Array],
    moving: Mapping[str, tuple[Array, Array]],
    origin: bool,
    marked: Mapping[str, Array] = MappingProxyType({}),
    fields: Sequence[Placing] = (),
) -> list[Markup]:
    """Curves, a cross at the origin if that is wanted, and a disc for each that moves, given with its times.

    Parameters
    ----------
    marked
        Points that do not move, shape (2, N).
    fields
        From places in the plane to what is positive where the motion must not be.
    """
    centre = [np.zeros((2, 1))] if origin else []
    beside = [*centre, *marked.values(), *(seen[name] for name in ("reference", "other") if name in seen)]
    low, high = box(seen["path"], beside, seen.get("free"))
    to = _placing(low, high)
    evenly = {name: _evenly(times, to(curve)) for name, (times, curve) in moving.items()}
    x, y = to(np.zeros((2, 1)))[:, 0]
    return [
        tag("style", *(_keyframes(name, places) for name, places in evenly.items())),
        *(tag("path", d=_region(field, low, high, to), class_="forbidden") for field in fields),
        *(tag("path", d=_line(to(curve)), class_=name) for name, curve in seen.items()),
        *([tag("path", d=f"M{x - 6:.1f} {y:.1f}h12M{x:.1f} {y - 6:.1f}v12", class_="origin")] if origin else []),
        *(
            tag("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r=MARKED[name], class_=name)
            for name, places in marked.items()
            for x, y in to(places).T
        ),
        *(_body(name, places) for name, places in evenly.items()),
    ]


def _figure(scene: Scene, inside: list[Markup], texts: Texts, kind: str, about: Sequence[str], driven: bool) -> Markup:
    """Return the picture with a button to stop it, and its description: what moves, and what else is seen."""
    unit = unit_text(scene.time_unit) or texts.get("page", "units_of_time")
    span = f"{decimal(number(float(scene.times[-1] - scene.times[0])))} {unit}"
    begin = texts.get("page", f"{kind}_driven" if driven else f"{kind}_over", span=span)
    return tag(
        "figure",
        tag("input", type="checkbox", id="pause"),
        tag("label", texts.get("page", "pause"), for_="pause"),
        tag(
            "svg",
            *inside,
            viewBox=f"0 0 {SIDE:g} {SIDE:g}",
            role="img",
            aria_label=texts.get("page", "motion_alt", span=span),
        ),
        tag("figcaption", " ".join([begin, *about, texts.get("page", f"{kind}_still")])),
        class_="motion",
    )


def _turning(scene: Scene, attitude: Attitude, texts: Texts, driven: bool) -> Markup:
    """Return a box with its axes, one picture after the other; the last one for readers without animation."""
    known = np.flatnonzero(np.isfinite(scene.x).all(axis=0))
    ticks = np.linspace(scene.nodes[known[0]], scene.nodes[known[-1]], TURNS)
    shown = known[np.searchsorted(scene.nodes[known], ticks).clip(0, len(known) - 1)]
    view = from_aside(("1", "2", "3")).axes
    half = 0.5 * SIDE

    def placed(points: Array) -> Array:
        return half + 0.3 * SIDE * np.array([[1.0], [-1.0]]) * (view @ points)

    fixed = [_line(placed(np.column_stack([np.zeros(3), 1.4 * axis]))) for axis in np.eye(3)]
    inside = [tag("path", d="".join(fixed), class_="free")]
    for k, turn in enumerate(attitude.turns[shown]):
        edges = "".join(_line(placed(turn @ edge)) for edge in EDGES)
        axes = [
            tag("path", d=_line(placed(turn @ np.column_stack([np.zeros(3), 1.15 * axis]))), class_=f"axis-{i}")
            for i, axis in enumerate(np.eye(3), 1)
        ]
        delay = f"animation-delay:{SECONDS * (k / TURNS - 1.0):.3f}s"
        inside.append(
            tag("g", tag("path", d=edges), *axes, class_="frame last" if k == TURNS - 1 else "frame", style=delay)
        )
    magnified = decimal(number(attitude.magnified))
    about = [texts.get("page", "turning_axes")]
    about += [texts.get("page", "turning_magnified", times=magnified)] if attitude.magnified != 1.0 else []
    return _figure(scene, inside, texts, "turning", about, driven)


def _region(field: Placing, low: Array, high: Array, to: Placing) -> str:
    """Return the outline of the region of the picture in which a field is positive."""
    from contourpy import FillType, contour_generator

    half, middle = 0.5 * float((high - low).max()), 0.5 * (low + high)
    across, up = (np.linspace(centre - half, centre + half, GRID) for centre in middle)
    values = field(np.array(np.meshgrid(across, up)).reshape(2, -1)).reshape(GRID, GRID)
    drawn = contour_generator(across, up, values, fill_type=FillType.OuterOffset).filled(0.0, np.inf)
    rings = (points[begin:end] for points, offsets in zip(*drawn, strict=True) for begin, end in pairwise(offsets))
    return "".join(f"{_line(to(ring.T))}Z" for ring in rings)


def _line(points: Array) -> str:
    """Return a path through points of the picture, in pieces where some are unknown, without repeated points."""
    found, before = "", ""
    for x, y in points.T:
        place = f"{x:.1f} {y:.1f}" if np.isfinite(x) and np.isfinite(y) else ""
        if place and place != before:
            found += ("L" if before else "M") + place
        before = place
    return found


def _placing(low: Array, high: Array) -> Placing:
    """Return the transformation of a plane to the picture with these corners, at equal scales."""
    half = 0.5 * float((high - low).max()) or 1.0
    scale = 0.5 * SIDE / half
    centre = 0.5 * (low + high)[:, None]
    return lambda curve: 0.5 * SIDE + np.array([[scale], [-scale]]) * (curve - centre)


def _evenly(times: Array, curve: Array) -> Array:
    """Return places at evenly spaced times, shape (2, FRAMES + 1)."""
    ticks = np.linspace(times[0], times[-1], FRAMES + 1)
    return np.vstack([np.interp(ticks, times, row) for row in curve])


def _keyframes(name: str, places: Array) -> Markup:
    frames = (
        f"{100.0 * k / FRAMES:.4g}%{{transform:translate({x:.1f}px,{y:.1f}px)}}" for k, (x, y) in enumerate(places.T)
    )
    return Markup(f"@keyframes {name}{{{''.join(frames)}}}")


def _body(name: str, places: Array) -> Markup:
    """Return a moving disc; without animation, it is at the end."""
    x, y = places[:, -1]
    still = f"animation-name:{name};transform:translate({x:.1f}px,{y:.1f}px)"
    return tag("circle", r="6", class_=joined("body of-", name), style=still)
