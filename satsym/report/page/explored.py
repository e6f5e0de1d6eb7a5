"""The contents of the interactive part of a page, as plain data: panels over time, and moving objects.

Where H is linear in a control, the sign of a switching function determines at which bound the control is. Panels of
such controls contain these functions, which are computed here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.report.display import engineering, labelled, length_scale, norm_text, number, plain, unit_text
from satsym.report.html.markup import indexed
from satsym.report.plots import series, style
from satsym.report.plots.reading import Reading, box, read
from satsym.report.plots.scene import Scene
from satsym.report.plots.scenes import Orbit
from satsym.report.plots.series import Series
from satsym.report.plots.space.attitudes import Attitude
from satsym.report.plots.space.surroundings import Surroundings
from satsym.report.results.objects import cost_per
from satsym.report.said import decimal, say
from satsym.solution import Solution

Data: TypeAlias = dict[str, Any]
"""Object with names and values that is written as JSON."""
NODES, FEWER = 1200, 200
"""Largest number of nodes that are kept of a single solution, and of each of several solutions."""
DIGITS = 6
GRID = 61
"""Number of points along each axis of the grid of forbidden regions."""
THRUST = 0.2
"""Length of the longest thrust arrow, relative to half the size of the picture."""

LINEAR = 1e-9
"""Largest deviation of H from a straight line, relative to its change, at which H counts as linear in a control."""
STEP = 1e-6
"""Size of test controls that show in which direction H decreases, relative to the largest norm."""


@dataclass(frozen=True, eq=False)
class Answer:
    """An answer of the interactive part, with its label.

    Attributes
    ----------
    label
        Such as ``initial.r = 1.05``; empty where there is but one.
    """

    solution: Solution
    label: str = ""
    own: bool = False
    """Whether this is the solution of the page itself, at which the slider starts."""


def data(answers: Sequence[Answer]) -> Data:
    """Return the data of some answers, one of which is chosen by a slider."""
    most = NODES if len(answers) == 1 else FEWER
    shown_ones = [(one, found) for one in answers if (found := _answer(one, most))["t"]]
    begin = next((k for k, (one, _) in enumerate(shown_ones) if one.own), 0)
    return {"answers": [found for _, found in shown_ones], "begin": begin}


def _answer(answer: Answer, most: int) -> Data:
    scene = Scene.of(answer.solution)
    if not scene.drawable:
        return {"label": answer.label, "t": []}
    kept = _kept(scene, most)
    spec = scene.spec
    cost = f"{number(spec.objective(answer.solution.objective), 8)} {unit_text(spec.objective_unit)}".strip()
    return {
        "label": answer.label,
        "cost": decimal(cost) if math.isfinite(answer.solution.objective) else "",
        "time": shown(labelled("$t$", scene.time_unit)),
        "t": _numbers(scene.times[kept]),
        "panels": _panels(scene, kept),
        "scenes": _scenes(scene, kept),
    }


def _kept(scene: Scene, most: int) -> NDArray[np.intp]:
    """Return the nodes that are kept: evenly spaced ones, and all at which a time occurs twice."""
    known = np.flatnonzero(np.isfinite(scene.x).all(axis=0))
    jumps = np.flatnonzero(np.diff(scene.times) <= 0.0)
    even = np.linspace(0, len(known) - 1, min(most, len(known))).round().astype(int)
    return np.unique(np.concatenate([known[even], jumps, jumps + 1]))


def _panels(scene: Scene, kept: NDArray[np.intp]) -> list[Data]:
    """Return panels of states at the left; at the right controls, their switching functions, and costates."""
    groups: tuple[tuple[str, list[Series], str], ...] = (
        ("state", series.states(scene), style.STATE),
        ("control", series.controls(scene), style.CONTROL),
        ("costate", series.costates(scene), style.COSTATE),
    )
    found: list[Data] = []
    for group, quantities, colour in groups:
        for quantity, reading in zip(quantities, read(quantities), strict=True):
            found.append(_panel(group, quantity, reading, colour, kept))
            if group == "control":
                found += _switching(scene, quantity, kept)
    return found


def _panel(group: str, quantity: Series, reading: Reading, colour: str, kept: NDArray[np.intp]) -> Data:
    own: Data = {
        "group": group,
        "label": shown(reading.label),
        "meaning": shown(quantity.meaning.replace(r"\$", "$")),
        "colour": colour,
        "values": _numbers(reading.values[kept]),
        "low": _digits(reading.low),
        "high": _digits(reading.high),
        "marks": [_digits(time) for time in quantity.switching],
        "marked": say("waypoint" if quantity.said == series.PASSED else "switching time"),
    }
    for name, values in (("reference", reading.reference), ("free", reading.free)):
        if values is not None:
            own[name] = _numbers(values[kept])
    for name in ("lower", "upper"):
        if math.isfinite(bound := getattr(reading, name)):
            own[name] = _digits(bound)
    if reading.target is not None:
        own["target"] = _digits(reading.target)
    return own


def _switching(scene: Scene, control: Series, kept: NDArray[np.intp]) -> list[Data]:
    """Return the switching function of a control, or of a norm, if it has one."""
    spec, found = scene.spec, []
    names = [v.symbol for v in spec.controls]
    for one in switching_functions(scene):
        alone = len(one.controls) == 1 and control.name == names[one.controls[0]]
        together = len(one.controls) > 1 and control.name == norm_text([names[i] for i in one.controls])
        if alone or together:
            unit = cost_per(control.unit, spec)
            latex = rf"S_{{{control.latex}}}" if alone else "S"
            quantity = Series(latex, "S", unit, say("switching function"), one.values, plain_unit=True, from_zero=True)
            found.append(_panel("switching", quantity, read([quantity])[0], style.PURPLE, kept))
    return found


@dataclass(frozen=True, eq=False)
class SwitchingFunction:
    """The switching function of a control, or of a norm.

    Attributes
    ----------
    controls
        Places of the controls that it is about.
    values
        At the nodes, the slope of H: where it is negative the upper bound is best, where it is positive the lower.
    """

    controls: tuple[int, ...]
    values: Array


def switching_functions(scene: Scene) -> list[SwitchingFunction]:
    """Return the switching functions of a solution: of controls bounded on both sides, and of bounded norms."""
    if scene.lam is None:
        return []
    case = scene.instance
    found = []
    for i in range(len(scene.u)):
        if math.isfinite(case.lower[i]) and math.isfinite(case.upper[i]) and case.lower[i] < case.upper[i]:
            ends = [_with(scene, i, value) for value in (case.lower[i], case.upper[i])]
            found.append(_slope(scene, (i,), ends[0], ends[1], case.upper[i] - case.lower[i]))
    for norm in case.bounded_norms:
        places = list(norm.places)
        way = _downhill(scene, places, norm.upper)
        if way is not None:
            none, full = scene.u.copy(), scene.u.copy()
            none[places], full[places] = norm.lower * way, norm.upper * way
            found.append(_slope(scene, tuple(places), none, full, norm.upper - norm.lower))
    return [one for one in found if one is not None]


def _with(scene: Scene, i: int, value: float) -> Array:
    u = scene.u.copy()
    u[i] = value
    return u


def _slope(scene: Scene, places: tuple[int, ...], low: Array, high: Array, width: float) -> SwitchingFunction | None:
    """Return the slope of H from one value to another, if H is linear between them."""
    if not width > 0.0:
        return None
    first, middle, last = (_hamiltonian(scene, u) for u in (low, 0.5 * (low + high), high))
    bent = np.nanmax(np.abs(middle - 0.5 * (first + last)), initial=0.0)
    if not bent <= LINEAR * np.nanmax(np.abs(np.concatenate([first, last])), initial=1e-300):
        return None
    return SwitchingFunction(places, (last - first) / width)


def _downhill(scene: Scene, places: list[int], largest: float) -> Array | None:
    """Return the direction in which H falls most quickly from zero control, shape (k, N+1); zero without one."""
    slopes = []
    for i in places:
        step = np.zeros_like(scene.u)
        step[i] = STEP * largest
        rest = scene.u.copy()
        rest[places] = 0.0
        slopes.append(_hamiltonian(scene, rest + step) - _hamiltonian(scene, rest - step))
    gradient = np.array(slopes)
    size = np.linalg.norm(gradient, axis=0)
    if not (size[np.isfinite(size)] > 0.0).any():
        return None
    with np.errstate(all="ignore"):
        return np.where(size > 0.0, -gradient / size, 0.0)


def _hamiltonian(scene: Scene, u: Array) -> Array:
    assert scene.lam is not None
    with np.errstate(all="ignore"):
        return np.asarray(
            scene.instance.model.hamiltonian_batch(scene.nodes, scene.x, u, scene.lam, scene.instance.parameters)
        )


def _scenes(scene: Scene, kept: NDArray[np.intp]) -> list[Data]:
    """Return the moving objects: the path in space, the path relative to the reference, the body that turns."""
    found = []
    orbit = Orbit.of(scene)
    if orbit is not None:
        found.append(_path(scene, orbit, kept))
        if orbit.relative is not None:
            found.append(_relative(orbit, kept))
    attitude = Attitude.of(scene)
    if attitude is not None:
        found.append(_attitude(attitude, kept))
    return found


def _path(scene: Scene, orbit: Orbit, kept: NDArray[np.intp]) -> Data:
    spatial = len(orbit.path) == 3 and len(orbit.views) > 1
    axes = np.eye(3) if spatial else orbit.views[0].axes
    labels = orbit.labels if spatial else orbit.views[0].labels
    path = axes @ orbit.path
    around = orbit.around
    beside = [axes @ c for c in (orbit.reference, around.other, orbit.target) if c is not None]
    free = None if orbit.free is None else axes @ orbit.free
    low, high = box(path, [*beside, *([np.zeros((len(path), 1))] if orbit.central else [])], free)
    furthest = float(np.abs([low, high]).max())
    factor, unit = length_scale(orbit.unit, furthest)
    measure = engineering(unit, furthest / factor)
    scale = 1.0 / (measure.divisor * factor)
    half = 0.5 * float((high - low).max()) * scale

    def curve(values: Array | None) -> list[list[float | None]] | None:
        return None if values is None else [_numbers(row) for row in axes @ values * scale]

    own: Data = {
        "kind": "space" if spatial else "plane",
        "title": shown(plain(say("the path"))),
        "labels": [shown(labelled(label, measure.unit)) for label in labels],
        "low": _numbers((0.5 * (low + high)) * scale - half),
        "high": _numbers((0.5 * (low + high)) * scale + half),
        "path": curve(orbit.path[:, kept]),
        "central": orbit.central,
        "burns": curve(None if around.burns is None else around.burns[:, kept]),
        "other": curve(around.other),
        "target": curve(orbit.target),
        "passed": curve(around.passed),
        "radius": _digits(around.radius * scale),
        "body": say(around.body) if around.body else "",
        "forbidden": [] if spatial else _forbidden(around, axes, low, high, scale),
    }
    for name, values in (("reference", orbit.reference), ("free", orbit.free), ("moving", _moving(scene, around))):
        if values is not None:
            own[name] = curve(values[:, kept])
    if orbit.thrust is not None and (most := np.nanmax(np.linalg.norm(orbit.thrust, axis=0))) > 0.0:
        own["thrust"] = [_numbers(row) for row in axes @ orbit.thrust[:, kept] * (THRUST * half / most)]
        own["thrust_called"] = say("thrust" if orbit.thrusts else "control")
    return own


def _moving(scene: Scene, around: Surroundings) -> Array | None:
    """Return the places at the nodes of what is met at the end."""
    if around.moving is None:
        return None
    even = np.linspace(scene.nodes[0], scene.nodes[-1], around.moving.shape[1])
    return np.vstack([np.interp(scene.nodes, even, row) for row in around.moving])


def _relative(orbit: Orbit, kept: NDArray[np.intp]) -> Data:
    assert orbit.relative is not None
    curve = np.vstack([orbit.relative.along, orbit.relative.radial])
    low, high = box(curve, [np.zeros((2, 1))])
    measure = engineering(orbit.unit, float(np.abs([low, high]).max()))
    scale = 1.0 / measure.divisor
    own: Data = {
        "kind": "plane",
        "free_aspect": True,
        "title": say("relative to the reference"),
        "labels": [shown(labelled(say(name), measure.unit)) for name in ("along-track", "radial")],
        "low": _numbers(low * scale),
        "high": _numbers(high * scale),
        "path": [_numbers(row) for row in curve[:, kept] * scale],
        "central": False,
        "target": [[0.0], [0.0]] if orbit.ends_there else None,
        "radius": 0.0,
        "forbidden": [],
    }
    if orbit.free_relative is not None:
        free = np.vstack([orbit.free_relative.along, orbit.free_relative.radial])[:, kept] * scale
        own["free"] = [_numbers(row) for row in free]
    return own


def _forbidden(around: Surroundings, axes: Array, low: Array, high: Array, scale: float) -> list[Data]:
    """Return grids of the regions that path constraints forbid, within the picture."""
    half, middle = 0.5 * float((high - low).max()), 0.5 * (low + high)
    across, up = (np.linspace(centre - half, centre + half, GRID) for centre in middle)
    grid = axes.T @ np.array(np.meshgrid(across, up)).reshape(2, -1)
    found = []
    for one in around.forbidden:
        if one.in_plane is not None and len(grid) == 2:
            rows = one.in_plane(grid).reshape(GRID, GRID)
            found.append({"x": _numbers(across * scale), "y": _numbers(up * scale), "z": [_numbers(r) for r in rows]})
    return found


def _attitude(attitude: Attitude, kept: NDArray[np.intp]) -> Data:
    own: Data = {
        "kind": "attitude",
        "title": say("attitude"),
        "turns": [_numbers(turn.ravel()) for turn in attitude.turns[kept]],
        "magnified": decimal(number(attitude.magnified)) if attitude.magnified != 1.0 else "",
    }
    if attitude.torque is not None and (most := np.nanmax(np.linalg.norm(attitude.torque, axis=0), initial=0.0)) > 0.0:
        own["torque"] = [_numbers(row) for row in attitude.torque[:, kept] / most]
    return own


def _numbers(values: Array) -> list[float | None]:
    """Return shortened numbers; ``None`` where there is nothing to draw."""
    return [_digits(value) if math.isfinite(value) else None for value in values.tolist()]


def _digits(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def shown(label: str) -> str:
    r"""Return a label such as ``$\dot\theta$ [rad/s]`` as HTML with the tags ``sub`` and ``sup``."""
    pieces = label.split("$")
    return " ".join(
        "".join(indexed(piece) if k % 2 else escape(piece, quote=False) for k, piece in enumerate(pieces)).split()
    )
