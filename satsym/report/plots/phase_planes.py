"""A state against its rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from satsym.report.plots import legend, series, style
from satsym.report.plots.panels import ticks
from satsym.report.plots.reading import Reading, read
from satsym.report.plots.scene import Scene
from satsym.report.said import say

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST = 4
"""Planes that are drawn; states over time show more than a page of many of them."""


@dataclass(frozen=True, eq=False)
class Plane:
    """Two states, as they are shown."""

    across: Reading
    up: Reading

    @property
    def target(self) -> tuple[float, float] | None:
        """Where the motion has to end, if both are given."""
        if self.across.target is None or self.up.target is None:
            return None
        return self.across.target, self.up.target


def of(scene: Scene) -> list[Plane]:
    """Of each state that another one is the rate of; of a system with two states these, whatever they are."""
    if not scene.drawable:
        return []
    states, rated = series.states(scene), scene.rated or ([(0, 1)] if len(scene.spec.states) == 2 else [])
    return [Plane(*read([states[i]]), *read([states[j]])) for i, j in rated] if len(rated) <= MOST else []


def entries(planes: list[Plane]) -> list[legend.Entry]:
    """Of a legend: what only these pictures have."""
    found = [(legend.line(color=style.STATE, **style.START), say("start"))]
    found.append((legend.line(color=style.STATE, **style.END), say("end")))
    if any(plane.target is not None for plane in planes):
        found.append((legend.line(**style.TARGET), say("final condition")))
    return found


def draw(axes: Axes, plane: Plane) -> None:
    """Draw a plane."""
    across, up = plane.across, plane.up
    axes.set_xlim(across.low, across.high)
    axes.set_ylim(up.low, up.high)
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
