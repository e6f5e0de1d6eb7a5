"""Attitudes: read from the states, and drawn as the paths of the axes of the body on a sphere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.arrays import Array
from satsym.report.plots import legend, style
from satsym.report.plots.scene import Scene
from satsym.report.plots.space.views import from_aside
from satsym.report.said import say

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AXES = (style.VERMILION, style.GREEN, style.BLUE)
"""Colours of the axes of a body, as in the animation of a page."""
ROOM = 1.18
"""Half the side of the picture, relative to the radius of the sphere."""
BEHIND = {"linewidth": 1.2, "alpha": 0.45, "linestyle": (0, (1.5, 1.5)), "zorder": 2.6}
CIRCLE = {"color": style.RIM, "linewidth": 0.7}
POINTS = 181
"""Number of points of a circle."""

UNIT_TOLERANCE = 1e-6
"""Largest deviation of a quaternion's norm from one."""
ANGLES = {"yaw": 2, "roll": 0, "pitch": 1}
"""Euler angles -> their axes, in the order of the rotations."""
SMALL_TURN, SEEN = 0.1, 0.5
"""Largest angle in rad that is magnified, and the angle to which it is magnified."""


@dataclass(frozen=True, eq=False)
class Attitude:
    """The attitude over time.

    Attributes
    ----------
    turns
        From the axes of the body to those that it is turned against, shape (N+1, 3, 3).
    torque
        The controls where there is one about each axis of the body, shape (3, N+1); ``None`` elsewhere.
    magnified
        How many times larger angles are shown than they are.
    complete
        Whether states give the attitude completely, as a quaternion does.
    """

    turns: Array
    torque: Array | None
    magnified: float = 1.0
    complete: bool = False

    @classmethod
    def of(cls, scene: Scene) -> Attitude | None:
        """Return the attitude of a scene; ``None`` where no states describe one."""
        if not scene.drawable:
            return None
        torque = scene.u if len(scene.u) == 3 and _about_axes(scene) else None
        if (quaternion := _quaternion(scene)) is not None:
            return cls(turned_by(quaternion), torque, complete=True)
        if (angles := _angles(scene)) is None:
            return None
        largest = float(np.nanmax(np.abs(list(angles.values()))))
        magnified = max(1.0, float(f"{SEEN / largest:.1g}")) if 0.0 < largest < SMALL_TURN else 1.0
        turns = np.broadcast_to(np.eye(3), (len(scene.times), 3, 3))
        for name, axis in ANGLES.items():
            if name in angles:
                turns = turns @ about(axis, magnified * angles[name])
        return cls(turns, torque, magnified)


def turned_by(q: Array) -> Array:
    """Return rotation matrices of unit quaternions with scalar part last, shape (4, N) to (N, 3, 3)."""
    x, y, z, w = q / np.linalg.norm(q, axis=0)
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def about(axis: int, angle: Array) -> Array:
    """Return rotation matrices about an axis by angles (N,), shape (N, 3, 3)."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    found = np.zeros((len(angle), 3, 3))
    found[:, axis, axis] = 1.0
    found[:, i, i] = found[:, j, j] = np.cos(angle)
    found[:, j, i], found[:, i, j] = np.sin(angle), -np.sin(angle)
    return found


def _quaternion(scene: Scene) -> Array | None:
    """Return four states q1 to q4 of norm one with the rates of a quaternion, scalar part last; or ``None``."""
    names = scene.spec.state_names
    wanted = [f"q{k}" for k in (1, 2, 3, 4)]
    if not set(wanted) <= set(names):
        return None
    q = scene.x[[names.index(name) for name in wanted]]
    if np.nanmax(np.abs((q * q).sum(axis=0) - 1.0)) > UNIT_TOLERANCE:
        return None
    return q


def _angles(scene: Scene) -> dict[str, Array] | None:
    """Return the states whose meaning begins with roll, pitch or yaw angle, in rad; or ``None``."""
    found = {}
    for variable, values in zip(scene.spec.states, scene.x, strict=True):
        name = variable.meaning.partition(" angle")[0]
        if name in ANGLES and variable.meaning.startswith(f"{name} angle"):
            found[name] = np.radians(values) if variable.unit.startswith("deg") else values
    return found or None


def _about_axes(scene: Scene) -> bool:
    """Tell whether the controls are torques about the axes of the body."""
    return all("torque" in control.meaning for control in scene.spec.controls)


def entries() -> list[legend.Entry]:
    """Return the entries of a legend for the paths on the sphere."""
    return [
        *(
            (legend.line(color=colour, **style.MAIN), say("body axis <number>", number=k))
            for k, colour in enumerate(AXES, 1)
        ),
        (legend.line(color=style.INK, **BEHIND), say("behind the sphere")),
        (legend.line(color=style.INK, **style.START), say("start")),
        (legend.line(color=style.INK, **style.END), say("end")),
    ]


def on_sphere(axes: Axes, attitude: Attitude) -> None:
    """Draw the paths of the tips of the body's axes on a sphere about the body, seen from aside."""
    from matplotlib.patches import Circle
    from matplotlib.patheffects import withStroke

    right, up = from_aside(("1", "2", "3")).axes
    towards = np.cross(right, up)
    axes.set_aspect("equal")
    axes.set_xlim(-ROOM, ROOM)
    axes.set_ylim(-ROOM, ROOM)
    axes.set_axis_off()
    axes.add_patch(Circle((0.0, 0.0), 1.0, facecolor=style.GLOBE, alpha=0.25, linewidth=0.0, zorder=1.4))
    axes.add_patch(Circle((0.0, 0.0), 1.0, fill=False, edgecolor=style.RIM, linewidth=0.9, zorder=1.5))

    def draw(path: Array, behind: dict[str, Any], before: dict[str, Any]) -> None:
        across, height, depth = right @ path, up @ path, towards @ path
        for hidden, look in ((True, behind), (False, before)):
            seen = (depth < 0.0) == hidden
            axes.plot(np.where(seen, across, np.nan), np.where(seen, height, np.nan), **look)

    angle = np.linspace(0.0, 2.0 * np.pi, POINTS)
    for normal in range(3):
        circle = np.insert(np.array([np.cos(angle), np.sin(angle)]), normal, 0.0, axis=0)
        draw(circle, CIRCLE | {"linestyle": (0, (1, 2))}, CIRCLE)
    turns = attitude.turns[np.isfinite(attitude.turns).all(axis=(1, 2))]
    for axis, colour in enumerate(AXES):
        path = turns[:, :, axis].T
        draw(path, BEHIND | {"color": colour}, style.MAIN | {"color": colour})
        for place, mark in ((path[:, 0], style.START), (path[:, -1], style.END)):
            opaque = 1.0 if towards @ place >= 0.0 else BEHIND["alpha"]
            axes.plot([right @ place], [up @ place], color=colour, alpha=opaque, **mark)
        first = 1.1 * path[:, 0]
        axes.text(
            right @ first,
            up @ first,
            str(axis + 1),
            ha="center",
            va="center",
            color=colour,
            fontsize=style.points(10.5),
            path_effects=[withStroke(linewidth=3.0, foreground="white")],
            zorder=6.0,
        )
