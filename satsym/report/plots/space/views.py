"""Views of a path in space: along the axes, and at right angles to the plane of the path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from satsym.arrays import Array
from satsym.report.said import say

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FLAT = 1e-6
"""Largest distance from a plane through the origin, relative to the size of a path, at which it counts as plane."""
AZIMUTH, ELEVATION = 35.0, 25.0
"""Direction of an oblique view in degrees: about the third axis, and above the plane of the others."""
ROUND = 1e-3
"""Relative variation of the distance below which no nearest point is marked."""


@dataclass(frozen=True, eq=False)
class View:
    """A picture plane, by its directions."""

    axes: Array
    """Two orthonormal vectors, rightwards and upwards in the picture, shape (2, 2 or 3)."""
    labels: tuple[str, str]
    """Labels of the two axes."""
    title: str = ""
    """Title of the picture, if the labels do not say what it shows."""
    spatial: bool = False
    """Whether the view is oblique, so that its axes are not those of the motion."""


def views(curves: Sequence[Array], labels: Sequence[str]) -> list[View]:
    """Return the views that show some curves fully, the most informative first.

    Parameters
    ----------
    curves
        Shape (2 or 3, N) each, the path first; columns that are not finite do not count.
    labels
        Names of the components.

    Returns
    -------
    For curves in a plane of two coordinates that plane alone; for those in another plane through the origin that
    plane, and then, as for all others, the three planes of coordinates.
    """
    size = len(labels)
    unit = np.eye(size)
    pairs = [(0, 1)] if size == 2 else [(0, 1), (0, 2), (1, 2)]
    planes = [View(unit[list(pair)], (labels[pair[0]], labels[pair[1]])) for pair in pairs]
    path = curves[0][:, np.isfinite(curves[0]).all(axis=0)]
    points = np.hstack([curve[:, np.isfinite(curve).all(axis=0)] for curve in curves])
    whole = float(np.abs(points).max(initial=0.0))
    if size == 2 or whole == 0.0:
        return planes[:1]
    for plane in planes:
        if np.abs(points - plane.axes.T @ plane.axes @ points).max() <= FLAT * whole:
            return [plane]
    _, spread, directions = np.linalg.svd(points @ points.T / whole**2)
    depth = float(np.abs(directions[2] @ points).max())
    if depth > FLAT * whole or spread[1] <= FLAT**2 * spread[0]:
        return planes
    return [_along_normal(path, directions[2]), *planes]


def from_aside(labels: Sequence[str]) -> View:
    """Return an oblique view from far away, a bit above the plane of the first two axes, the third one upwards."""
    turn, height = np.radians(AZIMUTH), np.radians(ELEVATION)
    right = np.array([-np.sin(turn), np.cos(turn), 0.0])
    up = np.array([-np.sin(height) * np.cos(turn), -np.sin(height) * np.sin(turn), np.cos(height)])
    return View(np.vstack([right, up]), (labels[0], labels[1]), say("in space"), spatial=True)


def few_ticks(axes: Axes) -> None:
    """Set few ticks, so that the long numbers of the horizontal axis do not touch each other."""
    from matplotlib.ticker import MaxNLocator

    long = max(map(abs, axes.get_xlim())) >= 1e4
    axes.xaxis.set_major_locator(MaxNLocator(3 if long else 5))
    axes.yaxis.set_major_locator(MaxNLocator(5))


def _along_normal(path: Array, normal: Array) -> View:
    """Return the view of a path's plane, in which the motion runs counterclockwise."""
    turning = np.cross(path[:, :-1], path[:, 1:], axis=0) @ np.ones(path.shape[1] - 1)
    normal = normal if turning @ normal >= 0.0 else -normal
    distance = np.linalg.norm(path, axis=0)
    near = bool(distance.max() - distance.min() > ROUND * distance.max())
    first = path[:, int(distance.argmin()) if near else 0]
    first = first - (first @ normal) * normal
    first = first / np.linalg.norm(first)
    towards, name = (
        (say("towards periapsis"), say("perifocal axes"))
        if near
        else (say("towards the initial point"), say("in the plane of the motion"))
    )
    return View(np.vstack([first, np.cross(normal, first)]), (towards, say("perpendicular to it")), name)
