"""Panels of one quantity against time, of which most pictures consist."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from satsym.report.display import labelled, number, unit_text
from satsym.report.plots import style
from satsym.report.plots.reading import ROUNDING, Reading, read
from satsym.report.plots.scene import Scene
from satsym.report.plots.series import Series
from satsym.report.said import decimal, numbers, say

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure, SubFigure

MOST_TIMES = 4
ROUND = [1, 2, 5, 10]
"""Leading digits of the distances between ticks."""


def small_multiples(
    part: Figure | SubFigure,
    scene: Scene,
    quantities: Sequence[tuple[Series, str]],
    columns: int,
    title: float = 0.0,
    whole: float = 0.0,
) -> None:
    """Draw quantities, each in its colour, in rows over a common time; a single last one fills its row.

    Parameters
    ----------
    title, whole
        Inches on a screen above a panel for its title, and above a panel that fills its row; 0 for no titles.
    """
    rows = -(-len(quantities) // columns)
    grid = part.add_gridspec(rows, columns)
    shown = _read(quantities)
    for i, (quantity, colour) in enumerate(quantities):
        row, column = divmod(i, columns)
        alone = i == len(quantities) - 1 and column == 0
        axes = part.add_subplot(grid[row, :] if alone else grid[row, column])
        against_time(axes, scene, quantity, shown[i], colour, whole if alone and columns > 1 else title)
        if row == rows - 1:
            axes.set_xlabel(labelled("$t$", scene.time_unit))
        elif i + columns < len(quantities) and (row < rows - 2 or len(quantities) % columns != 1 or columns == 1):
            axes.tick_params(labelbottom=False)  # the axes below have the same ticks at the same places
    part.align_ylabels()


def _read(quantities: Sequence[tuple[Series, str]]) -> list[Reading]:
    """Return readings in which quantities of one colour share a unit, where they can."""
    shown: dict[int, Reading] = {}
    for colour in dict.fromkeys(colour for _, colour in quantities):
        places = [i for i, (_, own) in enumerate(quantities) if own == colour]
        shown |= dict(zip(places, read([quantities[i][0] for i in places]), strict=True))
    return [shown[i] for i in range(len(quantities))]


def against_time(axes: Axes, scene: Scene, series: Series, shown: Reading, colour: str, title: float = 0.0) -> None:
    """Draw a quantity against time.

    Parameters
    ----------
    shown
        The quantity as it is shown.
    title
        Inches on a screen that its meaning and a remark beside it have above the axes; 0 leaves them out.
    """
    from matplotlib.ticker import MaxNLocator

    times = scene.times
    axes.set_xlim(times[0], times[-1])
    axes.set_ylim(shown.low, shown.high)
    _bounds(axes, scene, series, shown, colour)
    if shown.reference is not None:
        axes.plot(times, shown.reference, **style.REFERENCE)
    if shown.free is not None:
        axes.plot(times, shown.free, **style.FREE)
    axes.plot(times, shown.values, color=colour, **style.MAIN)
    if shown.target is not None:
        axes.plot(times[-1:], [shown.target], **style.TARGET)
    axes.set_ylabel(shown.label, fontsize="large" if series.unit == "1" else None)
    hours = scene.time_unit == "h"
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 3, 6, 10] if hours else ROUND))
    ticks(axes.yaxis, shown)
    if title:
        remark = _remark(scene, series, shown)
        room = title - style.length(f"{remark}  ", style.TITLE)
        if room < style.SHORTEST:
            remark, room = "", title
        axes.set_title(style.broken(series.meaning, room, most=2))
        axes.set_title(remark, loc="right")


def ticks(axis: Axis, shown: Reading) -> None:
    """Set few, round ticks; multiples of pi for an angle that turns."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator, MultipleLocator

    if not shown.turns:
        axis.set_major_locator(MaxNLocator(5, steps=ROUND, min_n_ticks=3))
        return
    step = 0.25
    while (shown.high - shown.low) / (step * math.pi) > 5.0:
        step *= 2.0
    axis.set_major_locator(MultipleLocator(step * math.pi))
    axis.set_major_formatter(FuncFormatter(lambda value, _: _of_pi(value / math.pi)))


def _remark(scene: Scene, series: Series, shown: Reading) -> str:
    """Return the remark on a quantity: its switching times, or its final value."""
    if series.switching:
        times = [number(time, 4) for time in series.switching[:MOST_TIMES]]
        more = ", \N{HORIZONTAL ELLIPSIS}" if len(series.switching) > MOST_TIMES else ""
        return say(series.said, times=f"{numbers(times)}{more} {unit_text(scene.time_unit)}".rstrip())
    known = shown.values[np.isfinite(shown.values)]
    if not known.size:
        return ""
    last = float(known[-1])
    last = last if abs(last) > ROUNDING * (shown.high - shown.low) else 0.0
    return say("final value <value>", value=f"{decimal(number(last, 5))} {unit_text(shown.unit)}".rstrip())


def _of_pi(multiple: float) -> str:
    quarters = round(4.0 * multiple)
    divisor = math.gcd(quarters, 4)
    top, bottom = quarters // divisor, 4 // divisor
    if top == 0:
        return "0"
    text = {1: "", -1: "-"}.get(top, str(top)) + r"\pi"
    return f"${text}/{bottom}$" if bottom > 1 else f"${text}$"


def _bounds(axes: Axes, scene: Scene, series: Series, shown: Reading, colour: str) -> None:
    """Hatch what is not admissible, shade the time spent at a bound, mark the switching times."""
    for bound, beyond in ((shown.lower, shown.low), (shown.upper, shown.high)):
        if shown.low <= bound <= shown.high:
            axes.axhspan(bound, beyond, **style.FORBIDDEN)
            axes.axhline(bound, **style.BOUND)
    forbidden(axes, scene, series, shown)
    if series.active is not None:
        for first, last in _runs(series.active):
            axes.axvspan(
                scene.times[first], scene.times[last], color=colour, alpha=style.SHADE, linewidth=0.0, zorder=1.0
            )
    for time in series.switching:
        axes.axvline(time, color=colour, **style.SWITCHING)


def forbidden(axes: Axes, scene: Scene, series: Series, shown: Reading) -> None:
    """Hatch what path constraints forbid, over time."""
    if not series.forbidden:
        return
    rows = np.linspace(shown.low, shown.high, style.GRID)[:, None] + np.zeros_like(scene.times)
    for field in series.forbidden:
        style.hatch(axes, scene.times, rows[:, 0], field(shown.value(rows)))


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first and last index of each run of at least two true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a > 1]
