"""How a body is turned at each node, where states tell: a quaternion, or angles. Draws nothing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.report.plots.scene import Scene

SAME = 1e-6
"""How far from one the norm of a quaternion may be."""
ANGLES = {"yaw": 2, "roll": 0, "pitch": 1}
"""The axis about which each angle turns, in the order in which they do."""
SMALL, SEEN = 0.1, 0.5
"""Angles of which none is larger, in rad, are magnified so that the largest is as large as the latter."""


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
    """

    turns: Array
    torque: Array | None
    magnified: float = 1.0

    @classmethod
    def of(cls, scene: Scene) -> Attitude | None:
        """The attitude of a scene; nothing where no states tell one."""
        if not scene.drawable:
            return None
        torque = scene.u if len(scene.u) == 3 and _about_axes(scene) else None
        if (quaternion := _quaternion(scene)) is not None:
            return cls(turned_by(quaternion), torque)
        if (angles := _angles(scene)) is None:
            return None
        largest = float(np.nanmax(np.abs(list(angles.values()))))
        magnified = max(1.0, float(f"{SEEN / largest:.1g}")) if 0.0 < largest < SMALL else 1.0
        turns = np.broadcast_to(np.eye(3), (len(scene.times), 3, 3))
        for name, axis in ANGLES.items():
            if name in angles:
                turns = turns @ about(axis, magnified * angles[name])
        return cls(turns, torque, magnified)


def turned_by(q: Array) -> Array:
    """Rotation matrices of unit quaternions, their scalar part last, shape (4, N) to (N, 3, 3)."""
    x, y, z, w = q / np.linalg.norm(q, axis=0)
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def about(axis: int, angle: Array) -> Array:
    """Rotation matrices about an axis by angles (N,), shape (N, 3, 3)."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    found = np.zeros((len(angle), 3, 3))
    found[:, axis, axis] = 1.0
    found[:, i, i] = found[:, j, j] = np.cos(angle)
    found[:, j, i], found[:, i, j] = np.sin(angle), -np.sin(angle)
    return found


def _quaternion(scene: Scene) -> Array | None:
    """Four states q1 to q4 of norm one whose rates are those of a quaternion, its scalar part last; or none."""
    names = scene.spec.state_names
    wanted = [f"q{k}" for k in (1, 2, 3, 4)]
    if not set(wanted) <= set(names):
        return None
    q = scene.x[[names.index(name) for name in wanted]]
    if np.nanmax(np.abs((q * q).sum(axis=0) - 1.0)) > SAME:
        return None
    return q


def _angles(scene: Scene) -> dict[str, Array] | None:
    """The states whose meaning begins with roll, pitch or yaw angle, in rad; or none."""
    found = {}
    for variable, values in zip(scene.spec.states, scene.x, strict=True):
        name = variable.meaning.partition(" angle")[0]
        if name in ANGLES and variable.meaning.startswith(f"{name} angle"):
            found[name] = np.radians(values) if variable.unit.startswith("deg") else values
    return found or None


def _about_axes(scene: Scene) -> bool:
    """Whether the controls are torques."""
    return all("torque" in control.meaning for control in scene.spec.controls)
