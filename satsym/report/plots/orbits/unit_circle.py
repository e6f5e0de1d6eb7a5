"""Floquet multipliers on the unit circle, and how far computed ones scatter about where they belong."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.report.plots import legend, style
from satsym.report.said import decimal, say
from satsym.report.terminal.table import figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from satsym.analysis.orbits.survey import Survey

COMPUTED: dict[str, Any] = {
    "color": style.BLUE,
    "marker": "o",
    "markersize": 8.0,
    "markerfacecolor": "none",
    "markeredgewidth": 1.5,
    "linestyle": "none",
    "zorder": 3.5,
}
EXACT: dict[str, Any] = {
    "color": style.VERMILION,
    "marker": "+",
    "markersize": 13.0,
    "linestyle": "none",
    "zorder": 3.6,
}
CIRCLE: dict[str, Any] = {"color": style.INK, "linewidth": 1.1, "zorder": 2.0}
SCATTER: dict[str, Any] = {"color": style.GREEN, "linewidth": 1.2, "linestyle": (0, (4, 3)), "zorder": 2.2}
ROOM = 1.35
"""Half the width of a panel, relative to the circle in it."""
TURN = np.linspace(0.0, 2.0 * np.pi, 721)


def page(found: Survey) -> Figure | None:
    """All of the unit circle, and beside it what there is to see at 1; nothing where there are no multipliers."""
    floquet = found.floquet
    if floquet.multipliers is None or floquet.scatter is None or floquet.expected_scatter is None:
        return None
    across = style.across(2)
    sheet = style.titled(
        found.case.title or found.case.name, style.WIDTH, 0.5 * style.WIDTH * (2 if across == 1 else 1) + 0.6
    )
    whole, near = sheet.subplots(2 // across, across)
    _whole(whole, floquet.multipliers)
    _near(near, floquet.multipliers, floquet.expected_scatter, ROOM * max(floquet.scatter, floquet.expected_scatter))
    entries = [
        (legend.line(**COMPUTED), say("computed multipliers")),
        (legend.line(**EXACT), say("exact: 1, multiplicity 6, Jordan blocks 2 + 1 + 1 + 1 + 1")),
        (legend.line(**CIRCLE), say("unit circle")),
        (legend.line(**SCATTER), say("scatter expected")),
    ]
    legend.below(sheet, entries)
    return sheet


def _whole(axes: Axes, multipliers: Any) -> None:
    furthest = ROOM * max(1.0, float(np.abs(multipliers).max()))
    _square(axes, furthest)
    axes.plot(np.cos(TURN), np.sin(TURN), **CIRCLE)
    axes.plot(multipliers.real, multipliers.imag, **COMPUTED)
    axes.plot([1.0], [0.0], **EXACT)
    axes.set_title(say("Floquet multipliers"))
    axes.set_xlabel(r"$\mathrm{Re}\,\mu$")
    axes.set_ylabel(r"$\mathrm{Im}\,\mu$")


def _near(axes: Axes, multipliers: Any, expected: float, reach: float) -> None:
    """Distances from 1; the unit circle is a straight line at this scale unless errors are large."""
    _square(axes, reach)
    # 1 - cos without cancellation; the part of the circle within reach
    angle = np.linspace(-1.0, 1.0, 401) * min(np.pi, 2.0 * reach)
    axes.plot(-2.0 * np.sin(0.5 * angle) ** 2, np.sin(angle), **CIRCLE)
    axes.plot(expected * np.cos(TURN), expected * np.sin(TURN), **SCATTER)
    away = multipliers - 1.0
    axes.plot(away.real, away.imag, **COMPUTED)
    axes.plot([0.0], [0.0], **EXACT)
    axes.locator_params(axis="x", nbins=2)  # each tick carries its power of ten
    furthest, likely = (decimal(figure(value, 2)) for value in (float(np.abs(away).max()), expected))
    axes.set_title(say("near 1: up to <furthest> from it, <likely> expected", furthest=furthest, likely=likely))
    axes.set_xlabel(r"$\mathrm{Re}\,\mu - 1$")
    axes.set_ylabel(r"$\mathrm{Im}\,\mu$")


def _square(axes: Axes, half: float) -> None:
    axes.set_aspect("equal")
    axes.set_xlim(-half, half)
    axes.set_ylim(-half, half)
    axes.axhline(0.0, color=style.GREY, linewidth=0.8, zorder=1.9)
