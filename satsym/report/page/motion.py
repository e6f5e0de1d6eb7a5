"""The motion in space as a small animation: SVG and CSS alone, with a pause, still where motion is not wanted."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from satsym.arrays import Array
from satsym.report.display import number, unit_text
from satsym.report.html.markup import Markup, joined, tag
from satsym.report.plots.orbits.scenes import Orbit, box
from satsym.report.plots.scene import Scene
from satsym.report.said import decimal
from satsym.report.texts import Texts

SIDE = 400.0
"""Of the picture, in its own units."""
FRAMES = 120

Placing: TypeAlias = Callable[[Array], Array]
"""From points of a plane to points of the picture, shapes (2, N)."""


def motion(scene: Scene, texts: Texts) -> Markup:
    """A figure; nothing where the model has no position in space."""
    orbit = Orbit.of(scene)
    if orbit is None:
        return Markup()
    view, known = orbit.views[0].axes, np.isfinite(orbit.path).all(axis=0)
    curves = {"reference": orbit.reference, "free": orbit.free, "path": orbit.path}
    seen = {name: view @ curve[:, known] for name, curve in curves.items() if curve is not None}
    to = _placing(
        *box(seen["path"], [np.zeros((2, 1)), *(seen[name] for name in ("reference", "free") if name in seen)])
    )
    drawn = {name: to(curve) for name, curve in seen.items()}
    evenly = {name: _evenly(scene.nodes[known], drawn[name]) for name in ("reference", "path") if name in drawn}
    x, y = to(np.zeros((2, 1)))[:, 0]
    inside = [
        tag("style", *(_keyframes(name, places) for name, places in evenly.items())),
        *(tag("path", d="M" + "L".join(_points(curve)), class_=name) for name, curve in drawn.items()),
        tag("path", d=f"M{x - 6:.1f} {y:.1f}h12M{x:.1f} {y - 6:.1f}v12", class_="origin"),
        *(_body(name, places) for name, places in evenly.items()),
    ]
    span = f"{decimal(number(float(scene.times[-1] - scene.times[0])))} {unit_text(scene.time_unit)}".strip()
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
        tag("figcaption", texts.get("page", "motion_about", span=span)),
        class_="motion",
    )


def _placing(low: Array, high: Array) -> Placing:
    """What puts a plane into the picture as far as these corners, at equal scales, upwards up."""
    half = 0.5 * float((high - low).max()) or 1.0
    scale = 0.5 * SIDE / half
    centre = 0.5 * (low + high)[:, None]
    return lambda curve: 0.5 * SIDE + np.array([[scale], [-scale]]) * (curve - centre)


def _evenly(times: Array, curve: Array) -> Array:
    """Places at times that are evenly apart, shape (2, FRAMES + 1)."""
    ticks = np.linspace(times[0], times[-1], FRAMES + 1)
    return np.vstack([np.interp(ticks, times, row) for row in curve])


def _points(curve: Array) -> list[str]:
    """Coordinates as text, without what lies where the point before does."""
    found = [f"{x:.1f} {y:.1f}" for x, y in curve.T]
    return [one for k, one in enumerate(found) if k == 0 or one != found[k - 1]]


def _keyframes(name: str, places: Array) -> Markup:
    frames = (
        f"{100.0 * k / FRAMES:.4g}%{{transform:translate({x:.1f}px,{y:.1f}px)}}" for k, (x, y) in enumerate(places.T)
    )
    return Markup(f"@keyframes {name}{{{''.join(frames)}}}")


def _body(name: str, places: Array) -> Markup:
    """A disc that moves; where nothing may move it stands at the end."""
    x, y = places[:, -1]
    still = f"animation-name:{name};transform:translate({x:.1f}px,{y:.1f}px)"
    return tag("circle", r="6", class_=joined("body of-", name), style=still)
