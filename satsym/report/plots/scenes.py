"""Pictures of the path in space, and relative to the reference."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from satsym.arrays import Array
from satsym.report.display import engineering, formula, labelled, length_scale, length_unit, number, plain, unit_text
from satsym.report.plots import curves, legend, series, style
from satsym.report.plots.reading import BURIED, ROUNDING, box
from satsym.report.plots.scene import Scene
from satsym.report.plots.space import surroundings
from satsym.report.plots.space.surroundings import NOTHING, Surroundings
from satsym.report.plots.space.views import View, few_ticks, from_aside, views
from satsym.report.said import say

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ARROWS = 32
MOST_VIEWS = 4
LENGTH = 0.4
"""Largest length of the axes of space, relative to half the size of the picture."""
LONGEST_ARROW = 0.13
"""Length of the longest arrow, relative to the size of the picture."""
CLOSED = 0.05
"""Distance between the ends of a curve, relative to its size, up to which the curve counts as closed."""
NEIGHBOURHOOD = 0.3
"""Largest distance from the reference, relative to the orbit, for which the path is also shown relative to it."""
MOVED = 1e-4
"""Relative change of a state for testing whether the position depends on it."""


@dataclass(frozen=True, eq=False)
class Orbit:
    """Curves in space, shape (2 or 3, N+1) each, and the path relative to the reference."""

    unit: str
    labels: tuple[str, ...]
    path: Array
    reference: Array | None
    free: Array | None
    thrust: Array | None
    relative: curves.Relative | None
    free_relative: curves.Relative | None
    ends_there: bool
    """Whether the motion is required to end at the position of the reference."""
    central: bool = True
    """Whether the motion is about the origin."""
    by_states: bool = False
    """Whether the position follows from the states, without a position vector."""
    target: Array | None = None
    """Required final position, shape (2 or 3, 1)."""
    around: Surroundings = NOTHING
    thrusts: bool = True
    """Whether the controls are called thrust."""

    @classmethod
    def of(cls, scene: Scene) -> Orbit | None:
        """Return the curves of a scene; ``None`` if neither model nor states give a place in a plane or in space."""
        if not scene.drawable:
            return None
        return cls._of_position(scene) if len(scene.spec.position) in (2, 3) else cls._of_states(scene)

    @classmethod
    def _of_states(cls, scene: Scene) -> Orbit | None:
        """Return a path whose coordinates are states."""
        states = scene.spec.states
        if (about := curves.polar(states)) is not None:
            return cls._of_polar(scene, *about)
        if swept := curves.Swept.of(scene.instance.model, scene.nodes, scene.x, scene.u, scene.instance.parameters):
            ways, unit = ("$x$", "$y$"), states[swept.distance].unit
            around = Surroundings(other=swept.circle)
            known = swept.path, None, None, swept.thrust, None, None, False
            return cls(unit, ways, *known, by_states=True, around=around, thrusts=_thrusts(scene))
        found = curves.places(states, scene.rated)
        if not found:
            return None
        model, p = scene.instance.model, scene.instance.parameters
        places = list(curves.level(model, scene.nodes, scene.x, scene.u, p, found))
        ends = [series.target(scene, i) for i in places]
        unit, thrust = states[places[0]].unit, _added(scene, lambda x: x[places])
        return cls(
            unit,
            tuple(formula(states[i].latex, states[i].symbol) for i in places),
            scene.x[places],
            None,
            None if scene.free is None else scene.free[places],
            thrust,
            None,
            None,
            False,
            central=False,
            by_states=True,
            target=None if any(end is None for end in ends) else np.array([ends], dtype=float).T,
            around=Surroundings.of(scene, lambda x: x[places], unit, thrust, None, places),
            thrusts=_thrusts(scene),
        )

    @classmethod
    def _of_polar(cls, scene: Scene, distance: int, angle: int) -> Orbit:
        """Return a path by a distance and an angle, which are states."""

        def path(x: Array) -> Array:
            return np.array([x[distance] * np.cos(x[angle]), x[distance] * np.sin(x[angle])])

        given = [series.target(scene, i) for i in (distance, angle)]
        unit, thrust = scene.spec.states[distance].unit, _added(scene, path)
        r, theta = (formula(scene.spec.states[i].latex, scene.spec.states[i].symbol) for i in (distance, angle))
        return cls(
            unit,
            (rf"{r}$\,\cos\,${theta}", rf"{r}$\,\sin\,${theta}"),
            path(scene.x),
            None if scene.reference is None else path(scene.reference),
            None if scene.free is None else path(scene.free),
            thrust,
            None,
            None,
            False,
            by_states=True,
            target=_point(*given),
            around=Surroundings.of(scene, path, unit, thrust, (distance, angle)),
            thrusts=_thrusts(scene),
        )

    @classmethod
    def _of_position(cls, scene: Scene) -> Orbit:
        """Return a path by the position vector of the model."""
        position = scene.spec.position
        model, p = scene.instance.model, scene.instance.parameters

        def path(x: Array) -> Array:
            return curves.path(model, scene.nodes, x, p)

        own = path(scene.x)
        reference, free = (None if x is None else path(x) for x in (scene.reference, scene.free))
        unit = position[0].unit if position[0].unit != "1" else length_unit(v.unit for v in scene.spec.states)
        seen = None if reference is None else curves.relative(own, reference)
        thrust = curves.thrust(model, scene.nodes, scene.x, scene.u, p) if not scene.coasting else None
        return cls(
            unit,
            tuple(formula(v.latex, v.symbol) for v in position),
            own,
            reference,
            free,
            thrust,
            seen if _near(seen, reference) else None,
            curves.relative(free, reference) if free is not None and reference is not None else None,
            seen is not None and _on_reference(scene) and _placed(scene, path),
            around=Surroundings.of(scene, path, unit, thrust, _polar(scene, own)),
        )

    @property
    def views(self) -> list[View]:
        """Return the views, the most informative first; a path in no plane of coordinates has an oblique one."""
        found = views([c for c in (self.path, self.reference, self.free) if c is not None], self.labels)
        return found if len(found) == 1 else [from_aside(self.labels), *found[: MOST_VIEWS - 1]]


def entries(orbit: Orbit) -> list[legend.Entry]:
    """Return the entries of a legend that only pictures in space have."""
    arrow = legend.line(
        color=style.VERMILION, marker=r"$\rightarrow$", markersize=15.0, markeredgewidth=0.2, linestyle="none"
    )
    found = [(arrow, say("thrust" if orbit.thrusts else "control"))] if orbit.thrust is not None else []
    found.append((legend.line(color=style.STATE, **style.START), say("start")))
    found.append((legend.line(color=style.STATE, **style.END), say("end")))
    if orbit.target is not None or (orbit.ends_there and orbit.relative is not None):
        found.append((legend.line(**style.TARGET), say("final condition")))
    if orbit.central and not orbit.around.radius:
        found.append((legend.line(**style.ORIGIN), plain(say(orbit.around.body or "origin"))))
    return found + surroundings.entries(orbit.around)


def in_space(axes: Axes, orbit: Orbit, view: View) -> None:
    """Draw the path in a plane, at equal scales."""
    seen, around = view.axes, orbit.around
    curve = seen @ orbit.path
    others = [seen @ c for c in (orbit.reference, around.other, around.other_start) if c is not None]
    fixed = [np.zeros((2, 1))] if orbit.central else [seen @ orbit.target] if orbit.target is not None else []
    low, high = box(curve, [*others, *fixed], None if orbit.free is None else seen @ orbit.free)
    centre, half = 0.5 * (low + high), 0.5 * float((high - low).max())
    names = list(view.labels)
    datum: Array = np.zeros((2, 1))
    if half < BURIED * np.abs(centre).max():
        # far from the origin ticks would need many digits
        datum = curve[:, np.isfinite(curve).all(axis=0)][:, :1]
        names = [f"{name}$\\,-\\,${name}$(t_0)$" for name in names]
    centre, curve = centre - datum[:, 0], curve - datum
    furthest = float(np.abs(centre).max()) + half
    factor, unit = length_scale(orbit.unit, furthest)
    measure = engineering(unit, furthest / factor)
    scale = 1.0 / (measure.divisor * factor)
    axes.set_aspect("equal")
    axes.set_title(view.title)
    axes.set_xlim((centre[0] - half) * scale, (centre[0] + half) * scale)
    axes.set_ylim((centre[1] - half) * scale, (centre[1] + half) * scale)
    surroundings.draw(axes, around, view, datum, scale)
    if orbit.reference is not None:
        axes.plot(*((_once(seen @ orbit.reference) - datum) * scale), **style.REFERENCE)
    if orbit.free is not None:
        axes.plot(*((seen @ orbit.free - datum) * scale), **style.FREE)
    if orbit.thrust is not None:
        _arrows(axes, curve * scale, seen @ orbit.thrust, LONGEST_ARROW * 2.0 * half * scale)
    drawn_curve = surroundings.before(around, view, orbit.path) - datum
    axes.plot(*(drawn_curve * scale), color=style.STATE, **style.MAIN)
    if orbit.central and not datum.any() and not around.radius:
        axes.plot([0.0], [0.0], **style.ORIGIN)
    if orbit.target is not None:
        axes.plot(*((seen @ orbit.target - datum) * scale), **style.TARGET)
    _ends(axes, *(curve * scale))
    if view.spatial:
        _without_ticks(axes, orbit, view, half * scale, measure.unit)
        return
    axes.set_xlabel(labelled(names[0], measure.unit))
    axes.set_ylabel(labelled(names[1], measure.unit))
    few_ticks(axes)


def _without_ticks(axes: Axes, orbit: Orbit, view: View, half: float, unit: str) -> None:
    """Draw the axes of space, of a round length, at the lower left in place of ticks."""
    length = _round_below(LENGTH * half)
    corner = np.array([axes.get_xlim()[0], axes.get_ylim()[0]]) + half * np.array([0.25, 0.12])
    for label, way in zip(orbit.labels, view.axes.T, strict=True):
        tip = corner + length * way
        arrow = {"arrowstyle": "-|>", "color": style.SOFT, "linewidth": 0.9, "shrinkA": 0.0, "shrinkB": 0.0}
        axes.annotate("", xy=tuple(tip), xytext=tuple(corner), arrowprops=arrow)
        place = corner + (length + 0.06 * half) * way
        axes.text(place[0], place[1], label, ha="center", va="center", color=style.SOFT, fontsize=style.points(9.5))
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_xlabel(say("arrows of <length>", length=f"{number(length)} {unit_text(unit)}".rstrip()))
    for spine in axes.spines.values():
        spine.set_visible(False)


def _round_below(size: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is not larger."""
    power = 10.0 ** math.floor(math.log10(size))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= size)


def from_reference(axes: Axes, orbit: Orbit) -> None:
    """Draw the path relative to the reference: ahead to the right, outwards up."""
    assert orbit.relative is not None
    curve = np.vstack([orbit.relative.along, orbit.relative.radial])
    others: list[Array] = [np.zeros((2, 1))]
    if orbit.free_relative is not None:
        others.append(np.vstack([orbit.free_relative.along, orbit.free_relative.radial]))
    low, high = box(curve, others)
    measure = engineering(orbit.unit, float(np.abs([low, high]).max()))
    scale = 1.0 / measure.divisor
    axes.set_xlim(low[0] * scale, high[0] * scale)
    axes.set_ylim(low[1] * scale, high[1] * scale)
    axes.set_title(say("relative to the reference"))
    surroundings.draw_from_reference(axes, orbit.around, scale)
    axes.axhline(0.0, **style.REFERENCE)
    if orbit.free_relative is not None:
        axes.plot(*(others[1] * scale), **style.FREE)
    axes.plot(*(curve * scale), color=style.STATE, **style.MAIN)
    if orbit.ends_there:
        axes.plot([0.0], [0.0], **style.TARGET)
    _ends(axes, *(curve * scale))
    axes.set_xlabel(labelled(say("along-track"), measure.unit))
    axes.set_ylabel(labelled(say("radial"), measure.unit))
    few_ticks(axes)


def _added(scene: Scene, place: Callable[[Array], Array]) -> Array | None:
    """Return the acceleration that the controls add to a motion whose states are places; ``None`` without one."""
    if scene.coasting:
        return None
    model, p = scene.instance.model, scene.instance.parameters
    found = curves.thrust(model, scene.nodes, scene.x, scene.u, p, place)
    return found if np.nanmax(np.abs(found), initial=0.0) > 0.0 else None


def _thrusts(scene: Scene) -> bool:
    """Tell whether the model calls a control thrust."""
    return any("thrust" in control.meaning for control in scene.spec.controls)


def _polar(scene: Scene, path: Array) -> tuple[int, int] | None:
    """Return the states that are a distance and an angle of the position vector, if any are."""
    found = curves.polar(scene.spec.states)
    if found is None or len(path) != 2:
        return None
    r, theta = (scene.x[i] for i in found)
    same = np.allclose(path, [r * np.cos(theta), r * np.sin(theta)], rtol=ROUNDING, equal_nan=True)
    return found if same else None


def _on_reference(scene: Scene) -> bool:
    """Tell whether all given final states, at least one, are those of the reference."""
    if scene.reference is None or not scene.instance.final:
        return False
    given = [(v, series.target(scene, i)) for i, v in enumerate(scene.reference[:, -1])]
    return all(value is None or abs(value - v) <= ROUNDING * max(1.0, abs(v)) for v, value in given)


def _placed(scene: Scene, path: Callable[[Array], Array]) -> bool:
    """Tell whether no free final state moves the end along the reference or away from its centre."""
    assert scene.reference is not None
    place = path(scene.reference)
    for i in range(len(scene.reference)):
        if series.target(scene, i) is None:
            moved = scene.reference.copy()
            moved[i] += MOVED * np.maximum(1.0, np.abs(moved[i]))
            seen = curves.relative(path(moved), place)
            if seen is None or np.hypot(seen.along[-1], seen.radial[-1]) > ROUNDING * np.linalg.norm(place[:, -1]):
                return False
    return True


def _point(distance: float | None, angle: float | None) -> Array | None:
    """Return a place from polar coordinates."""
    if distance is None or angle is None:
        return None
    return distance * np.array([[math.cos(angle)], [math.sin(angle)]])


def _near(seen: curves.Relative | None, reference: Array | None) -> bool:
    if seen is None or reference is None:
        return False
    furthest = np.nanmax(np.abs([seen.along, seen.radial]))
    return bool(0.0 < furthest < NEIGHBOURHOOD * np.linalg.norm(reference, axis=0).max())


def _once(curve: Array) -> Array:
    """Return a closed curve up to its return to the start: overlapping dashes would look solid."""
    from_start = np.linalg.norm(curve - curve[:, :1], axis=0)
    away = np.flatnonzero(from_start > 0.5 * np.nanmax(from_start))
    if not away.size:
        return curve
    coming = from_start[away[0] :]
    back = np.flatnonzero(coming < CLOSED * np.nanmax(from_start))
    if not back.size:
        return curve
    gone = np.flatnonzero(coming[back[0] :] >= coming[back[0]])[1:]
    until = back[0] + (gone[0] if gone.size else len(coming))
    return curve[:, : away[0] + back[0] + int(np.nanargmin(coming[back[0] : until])) + 1]


def _arrows(axes: Axes, curve: Array, thrust: Array, longest: float) -> None:
    length = np.linalg.norm(thrust, axis=0)
    if not np.nanmax(length, initial=0.0) > 0.0:
        return
    thrust = thrust * (longest / np.nanmax(length))
    chosen = np.unique(np.linspace(0, curve.shape[1] - 1, ARROWS).round().astype(int))
    chosen = chosen[np.isfinite(curve[:, chosen]).all(axis=0) & np.isfinite(thrust[:, chosen]).all(axis=0)]
    axes.quiver(*curve[:, chosen], *thrust[:, chosen], **style.ARROW)


def _ends(axes: Axes, across: Array, up: Array) -> None:
    known = np.flatnonzero(np.isfinite(across) & np.isfinite(up))
    axes.plot(across[known[:1]], up[known[:1]], color=style.STATE, **style.START)
    axes.plot(across[known[-1:]], up[known[-1:]], color=style.STATE, **style.END)
