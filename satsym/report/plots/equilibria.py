"""Equilibria of an attitude in orbit over a parameter: their number, and where they point."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.report import display
from satsym.report.plots import legend, style
from satsym.report.said import message, say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from satsym.symbolic.equilibria.survey import Attitudes

LOOKS: dict[str, dict[str, Any]] = {
    "stable": {"color": style.GREEN, "marker": "o", "markersize": 4.5},
    "gyroscopically stabilised": {"color": style.BLUE, "marker": "s", "markersize": 3.8},
    "unstable": {"color": style.VERMILION, "marker": ".", "markersize": 3.0},
    "degenerate": {"color": style.INK, "marker": "x", "markersize": 5.0},
}


def page(found: Attitudes, title: str, unit: str = "") -> Figure | None:
    """Number above, angle between the y of body and orbit below; nothing where they are not finite.

    Parameters
    ----------
    unit
        Of the parameter over which they are followed.
    """
    if found.followed is None:
        return None
    values, sets = found.followed.values, found.followed.equilibria
    sheet = style.titled(title, style.WIDTH, 0.9 * style.WIDTH)
    above, below = sheet.subplots(2, 1, sharex=True, height_ratios=(1, 2))
    edges = [float(values[0]), *((c.below + c.above) / 2 for c in found.followed.changes), float(values[-1])]
    counts = [len(sets[0]), *(c.counts[1] for c in found.followed.changes)]
    above.stairs(counts, edges, baseline=None, color=style.INK, linewidth=1.4)
    above.set_ylabel(textwrap.fill(say("number of equilibria"), 20))
    above.set_ylim(0, 1.08 * max(counts))
    above.set_yticks(sorted({0, *counts}))
    seen = []
    for kind, look in LOOKS.items():
        points = [
            (value, np.degrees(np.arccos(np.clip(each.cosines[1, 1], -1.0, 1.0))))
            for value, group in zip(values, sets, strict=True)
            for each in group
            if each.kind.value == kind
        ]
        if points:
            below.plot(*np.array(points).T, linestyle="none", **look)
            seen.append((legend.line(linestyle="none", **look), message(kind)))
    dotted: dict[str, Any] = {"color": style.INK, "linewidth": 0.6, "linestyle": (0, (2, 3))}
    for axes in (above, below):
        for change in found.followed.changes:
            axes.axvline((change.below + change.above) / 2, **dotted)
    if found.followed.changes:
        seen.append((legend.line(**dotted), say("number or kinds change")))
    below.set_ylabel(say("from the orbit's y to the body's [deg]"))
    below.set_xlabel(display.labelled(found.parameter, unit))
    below.set_yticks(range(0, 181, 30))
    legend.below(sheet, seen)
    return sheet
