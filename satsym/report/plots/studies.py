"""Pictures of a study: maps over a grid, curves over one axis, histograms of a sample, and failed rows."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.formula.writing import GREEK
from satsym.instance.numbers import SIDES, Table
from satsym.report import display
from satsym.report.display import labelled, plain
from satsym.report.look import SCREEN, Look
from satsym.report.plots import legend, style
from satsym.report.results import files
from satsym.report.results.studies import Numbers
from satsym.report.said import decimal, message, say
from satsym.report.said import numbers as numbers_said
from satsym.status import Status
from satsym.studies.rows import Column

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANEL, HISTOGRAM, CURVE = 3.6, 2.8, 2.3
"""Heights of a map, of a histogram, and of a curve over one number, in inches on a screen."""
SHORT_RANGE = 1e3
"""Ratio of the last to the first value up to which a logarithmic axis has plain numbers."""
GREYS = ("#D9D9D9", "#A6A6A6", "#737373", "#F0F0F0", "#BFBFBF", "#8C8C8C")
"""Shades of grey for cells without a number, one for each status."""
FEWEST, LEVELS = 4, 8
"""Smallest number of rows and columns of a map with contours of the cost, and approximate number of contours."""
OUTER = (0.01, 0.99)
"""Quantiles outside which values may be outliers."""

MARKS = ("x", "v", "s", "^", "P", "D", "*", "o")
COLOURS = (style.VERMILION, style.PURPLE, style.INK, style.GREEN, style.BLUE, style.GREY)


def figures(numbers: Numbers) -> dict[str, Figure]:
    """Return figures by name: the quantities, and the failed rows if there are any."""
    found = {"overview": _overview(numbers)}
    if any(one != Status.CONVERGED.value for one in numbers.status):
        found["failures"] = _failures(numbers)
    return found


def pictures(numbers: Numbers, look: Look = SCREEN) -> dict[str, files.Content]:
    """Map file names to contents, each figure in each format."""
    with style.applied(look):
        return {
            file: content
            for name, page in figures(numbers).items()
            for file, content in style.contents(name, page).items()
        }


def _overview(numbers: Numbers) -> Figure:
    named = numbers.quantities
    count = max(1, len(named))
    axes = [label for label, values in numbers.varied.items() if np.ptp(values) > 0.0] or list(numbers.varied)[:1]
    curves = numbers.shape is not None and len(axes) == 1
    panel = CURVE if curves else PANEL if numbers.shape is not None else HISTOGRAM
    columns = style.columns(count, 1, panel, 0.5)
    rows = -(-count // columns)
    page = style.titled(numbers.title, style.WIDTH, panel * rows + 0.8)
    places = page.subplots(rows, columns, squeeze=False, sharex=curves).flat
    lacking: list[legend.Entry] = []
    for k, (place, (name, values)) in enumerate(zip(places, named.items(), strict=False)):
        if curves:
            _curve(place, numbers.varied[axes[0]], values, numbers.branch)
            _scale(place, "x", numbers.varied[axes[0]])
            place.set_xlabel(on_axis(axes[0]) if k + columns >= count else "")
            place.tick_params(labelbottom=k + columns >= count)
            place.set_ylabel(on_axis(name))
        elif numbers.shape is not None:
            lacking = _map(page, place, numbers, name, values)
        else:
            _histogram(place, name, values)
    for place in list(places)[len(named) :]:
        place.set_axis_off()
    page.align_ylabels()
    _noted(page, lacking)
    return page


def _noted(page: Figure, entries: Sequence[legend.Entry]) -> None:
    """Add a legend of cells without a number, also for a single kind of them."""
    if entries:
        page.legend(*zip(*entries, strict=True), loc="outside lower center", ncols=style.across(3))


def _map(page: Figure, place: Axes, numbers: Numbers, name: str, values: Array) -> list[legend.Entry]:
    """Draw a map over the first two axes that vary; further ones are at their middle values, as a note says.

    The function returns how the rows ended whose cells have no number.
    """
    assert numbers.shape is not None
    varying = [k for k, count in enumerate(numbers.shape) if count > 1][:2]
    labels = list(numbers.varied)
    table = values.reshape(numbers.shape)
    grids = [numbers.varied[labels[k]].reshape(numbers.shape) for k in varying]
    fixed = tuple(slice(None) if k in varying else count // 2 for k, count in enumerate(numbers.shape))
    x, y = grids[0][fixed], grids[1][fixed]
    cells = np.ma.masked_invalid(table[fixed])
    drawn = place.pcolormesh(x, y, cells, shading="nearest", **_colours(cells))
    if name.startswith(Column.OBJECTIVE) and min(x.shape) >= FEWEST and np.ptp(cells.compressed()) > 0.0:
        lines = place.contour(x, y, cells, levels=LEVELS, colors="white", linewidths=0.8, alpha=0.8)
        place.clabel(lines, fontsize=style.points(7.5), fmt=lambda value: decimal(display.number(value, 4)))
    status = np.array(numbers.status).reshape(numbers.shape)[fixed]
    lacking = _without_numbers(place, x, y, np.where(np.isfinite(table[fixed]), Status.CONVERGED.value, status))
    for axis, k, low in (("x", varying[0], x), ("y", varying[1], y)):
        _scale(place, axis, low)
        getattr(place, f"set_{axis}label")(on_axis(labels[k]))
    if numbers.branch is not None:
        _borders(place, x, y, numbers.branch.reshape(numbers.shape)[fixed])
    page.colorbar(drawn, ax=place, label=on_axis(name))
    values_of = [values.reshape(numbers.shape)[fixed].flat[0] for values in numbers.varied.values()]
    others = [
        f"{on_axis(labels[k])} = {decimal(display.number(float(values_of[k])))}"
        for k, count in enumerate(numbers.shape)
        if k not in varying and count > 1
    ]
    place.set_title(", ".join(others))
    return lacking


def _colours(values: Any) -> dict[str, Any]:
    """Return the colours of a map: from white to either side where values have both signs."""
    known = values.compressed()
    if not known.size or not known.min() < 0.0 < known.max():
        return {"cmap": "viridis"}
    largest = float(np.abs(known).max())
    return {"cmap": "RdBu_r", "vmin": -largest, "vmax": largest}


def _without_numbers(place: Axes, x: Array, y: Array, status: NDArray[np.str_]) -> list[legend.Entry]:
    """Fill the cells of rows without an answer, in a grey for each status; return the statuses."""
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    found: list[legend.Entry] = []
    for kind, grey in zip(sorted(set(status.flat) - {Status.CONVERGED.value}), GREYS, strict=False):
        own = status == kind
        cells = np.ma.masked_array(np.ones(own.shape), ~own)
        place.pcolormesh(x, y, cells, shading="nearest", cmap=ListedColormap([grey]))
        found.append((Patch(color=grey), f"{message(str(kind))}: {int(own.sum())}"))
    return found


def _scale(place: Axes, axis: str, values: Array) -> None:
    """Set a logarithmic axis for values of equal ratio, with plain numbers where it is short."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    if not _logarithmic(values):
        return
    getattr(place, f"set_{axis}scale")("log")
    own = getattr(place, f"{axis}axis")
    if values.max() < SHORT_RANGE * values.min():
        own.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        own.set_major_formatter(FuncFormatter(lambda value, _: decimal(display.number(value, 4))))
        own.set_minor_formatter(NullFormatter())


def _curve(place: Axes, x: Array, values: Array, branch: Array | None) -> None:
    """Draw a curve, joined within a branch, in the order of the rows."""
    parts = np.zeros(len(x)) if branch is None else np.nan_to_num(branch)
    for first, last in pairwise([0, *(np.flatnonzero(np.diff(parts)) + 1).tolist(), len(x)]):
        place.plot(x[first:last], values[first:last], ".-", color=style.BLUE, markersize=4.0)


def _borders(place: Axes, x: Array, y: Array, branch: Array) -> None:
    """Draw white crosses between neighbours of different branches."""
    for axis in (0, 1):
        before, after = (np.delete(np.arange(branch.shape[axis]), k) for k in (-1, 0))
        one, other = (np.take(branch, places, axis) for places in (before, after))
        apart = (one != other) & np.isfinite(one) & np.isfinite(other)
        between = [(np.take(each, before, axis) + np.take(each, after, axis))[apart] / 2.0 for each in (x, y)]
        place.plot(*between, "x", color="white", markersize=4.0, markeredgewidth=1.2)


def _logarithmic(values: Array) -> bool:
    """Tell whether values are spaced evenly in their logarithms rather than evenly."""
    own = np.unique(values)
    if len(own) < 3 or own[0] <= 0.0:
        return False
    return bool(np.ptp(np.diff(np.log(own))) < np.ptp(np.diff(own)) / own[0])


def _histogram(place: Axes, name: str, values: Array) -> None:
    finite = values[np.isfinite(values)]
    shown = _without_outliers(finite)
    place.hist(shown, bins=min(60, max(5, int(np.sqrt(len(shown))))), color=style.BLUE)
    place.set_xlabel(on_axis(name))
    place.set_ylabel(say("cases"))
    if len(finite):
        low, middle, high = np.quantile(finite, [0.05, 0.5, 0.95])
        said = numbers_said(display.number(float(one), 4) for one in (low, middle, high))
        title = say("5 %, 50 % and 95 % quantiles: <values>", values=said)
        beyond = np.setdiff1d(finite, shown)
        if len(beyond):
            low, high = (decimal(display.number(float(one), 4)) for one in (beyond[0], beyond[-1]))
            counts = {"count": len(finite) - len(shown), "rows": len(finite)}
            said = (
                say("not shown: <count> of <rows> cases, far from the others, at <value>", **counts, value=low)
                if low == high
                else say(
                    "not shown: <count> of <rows> cases, far from the others, with values between <low> and <high>",
                    **counts,
                    low=low,
                    high=high,
                )
            )
            title += f"\n{said}"
        place.set_title(title)


def _without_outliers(values: Array) -> Array:
    """Return values within the quantiles of 1 and 99 %, extended by their distance: else few bars hold all."""
    if not len(values):
        return values
    low, high = np.quantile(values, OUTER)
    return values[(values >= low - (high - low)) & (values <= high + (high - low))]


def _failures(numbers: Numbers) -> Figure:
    """Draw each row by its first two varied numbers, with the status in which it ended."""
    page = style.titled(numbers.title, style.WIDTH, 0.6 * style.WIDTH)
    place = page.subplots()
    labels = [label for label, values in numbers.varied.items() if np.ptp(values) > 0.0] or list(numbers.varied)
    x = numbers.varied[labels[0]]
    y = numbers.varied[labels[1]] if len(labels) > 1 else np.zeros_like(x)
    status, seen = np.array(numbers.status), []
    looks: list[dict[str, Any]] = [{"marker": ".", "markersize": 3.0, "color": style.GREY}]
    pairs = zip(MARKS, COLOURS * 2, strict=False)
    looks += [{"marker": mark, "markersize": 5.0, "color": colour} for mark, colour in pairs]
    kinds = [Status.CONVERGED.value, *sorted(set(numbers.status) - {Status.CONVERGED.value})]
    for kind, look in zip(kinds, looks, strict=False):
        own = status == kind
        if own.any():
            place.plot(x[own], y[own], linestyle="none", **look)
            seen.append((legend.line(linestyle="none", **look), f"{message(kind)}: {int(own.sum())}"))
    place.set_xlabel(on_axis(labels[0]))
    if len(labels) > 1:
        place.set_ylabel(on_axis(labels[1]))
    else:
        place.set_yticks([])
    legend.below(page, seen)
    return page


_NAME = re.compile(rf"({'|'.join(sorted(GREEK))}|[A-Za-z])_?(\d+|[A-Za-z])?((?:_d?dot)?)")
_AT = {
    Table.INITIAL.value: "(t_0)",
    Table.FINAL.value: "(t_f)",
    "x_final": "(t_f)",
    "found": "",
    Table.PARAMETERS.value: "",
}
_TIMES = {
    f"{Table.TIME.value}.tf": "t_f",
    f"{Table.TIME.value}.t0": "t_0",
    Column.T_FINAL.value: "t_f",
    Column.T_INITIAL.value: "t_0",
}


def on_axis(column: str) -> str:
    """Return a column with its unit for an axis; unknown units are unchanged."""
    name, bracket, unit = column.partition(" [")
    said = _said(name)
    return labelled(said, unit.removesuffix("]")) if bracket else said


def _said(name: str) -> str:
    if name == Column.OBJECTIVE:
        return "$J$"
    if name in _TIMES:
        return f"${_TIMES[name]}$"
    place, _, rest = name.partition(".")
    if place in _AT and (symbol := latex(rest)):
        return f"${symbol}{_AT[place]}$"
    if place == "costate_initial" and (symbol := latex(rest)):
        return rf"$\lambda_{{{symbol}}}(t_0)$"
    if place == Table.CONTROL.value:
        if rest == "max_norm":
            return say("largest norm of the control")
        control, _, side = rest.rpartition(".")
        if side in SIDES and (symbol := latex(control)):
            return say("upper bound of <name>" if side == SIDES[1] else "lower bound of <name>", name=f"${symbol}$")
    return plain(name)


def latex(name: str) -> str:
    """Return a name of a model as a formula, if its form allows; empty for others.

    Parameters
    ----------
    name
        Such as ``theta_dot``, ``u1`` or ``w_x``.
    """
    found = _NAME.fullmatch(name)
    if not found:
        return ""
    letter = rf"\{found[1]}" if found[1] in GREEK else found[1]
    dotted = {"": letter, "_dot": rf"\dot{{{letter}}}", "_ddot": rf"\ddot{{{letter}}}"}[found[3]]
    return f"{dotted}_{{{found[2]}}}" if found[2] else dotted
