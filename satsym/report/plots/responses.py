"""Responses to a disturbance as small multiples, and the distances from which the linear law works."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.analysis.regulator.feedback import Design, region_of_attraction, responses
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.report import display
from satsym.report.plots import curves, legend, style
from satsym.report.plots.reading import ROUNDING, SMALL_DEVIATION
from satsym.report.results.objects import COST, of_regulator
from satsym.report.said import say
from satsym.spec import Variable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LINEAR: dict[str, Any] = {"linewidth": 2.0, "zorder": 3.0}
NONLINEAR: dict[str, Any] = {"color": style.INK, "linewidth": 1.2, "linestyle": (0, (4, 2)), "zorder": 3.2}
SMALL_ROW = 1.7
"""Height in inches on a screen of a row of panels on a page of fixed height."""
ROOM_BEYOND = 1.5
"""Displayed width beyond the linear response for a nonlinear response, relative to the width of the former."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A quantity by the linear system, and by the exact motion where that differs."""

    what: Variable
    linear: Array
    exact: Array | None
    colour: str
    title: str
    """The control law of the curve."""
    prefix: str = ""
    """Prefix of the symbol of the curve."""

    @property
    def ends(self) -> tuple[float, float]:
        """Return the ends of the axis without a margin: zero, the linear response, and the exact one where near."""
        low, high = min(float(self.linear.min()), 0.0), max(float(self.linear.max()), 0.0)
        width = high - low or 1.0
        exact = np.zeros(1) if self.exact is None else curves.clean(self.exact)
        if np.isfinite(exact).any():
            low = max(min(low, float(np.nanmin(exact))), low - ROOM_BEYOND * width)
            high = min(max(high, float(np.nanmax(exact))), high + ROOM_BEYOND * width)
        return low, high

    @property
    def apart(self) -> Array | None:
        """Return the difference of the exact motion, where one curve hides the other; else ``None``."""
        if self.exact is None:
            return None
        found, width = curves.clean(self.exact - self.linear), float(np.ptp(self.linear))
        most = float(np.abs(found).max()) if np.isfinite(found).all() else np.inf
        return found if ROUNDING * width < most < SMALL_DEVIATION * width else None


@dataclass(frozen=True, eq=False)
class Responded:
    """The responses of each quantity to a disturbance, with times in a readable unit."""

    times: Array
    unit: str
    free: tuple[Curve, ...]
    steered: tuple[Curve, ...]
    inputs: tuple[Curve, ...]
    cost: Curve

    @classmethod
    def of(cls, design: Design, case: Instance) -> Responded:
        """Return the states without control and with the gain, the inputs, and the cost."""
        found, spec, names = responses(design, case), design.about.model.spec, design.regulator.system.inputs
        units = (v.unit for v in (*spec.states, *spec.controls, *spec.parameters))
        factor, unit = display.time_scale(units, float(np.ptp(found.times)))
        delta, steered = _delta(design), say("with <law>", law="$u = -K\\,x$")
        by_name = {v.symbol: v for v in spec.controls}
        measure = of_regulator(spec, names, design.relative)
        exact_cost = None if found.exact_steered is None else found.exact_steered.cost(design.regulator, found.times)

        def curves_of(what: Sequence[Variable], linear: Array, exact: Array | None, *look: str) -> tuple[Curve, ...]:
            rows = [None] * len(what) if exact is None else list(exact)
            return tuple(Curve(v, a, b, *look) for v, a, b in zip(what, linear, rows, strict=True))

        free, exact = found.exact_free, found.exact_steered
        return cls(
            found.times / factor,
            unit,
            curves_of(spec.states, found.free.x, free.x if free else None, style.BLUE, say("uncontrolled"), delta),
            curves_of(spec.states, found.steered.x, exact.x if exact else None, style.GREEN, steered, delta),
            curves_of([by_name[n] for n in names], found.steered.u, exact.u if exact else None, style.CONTROL, steered),
            Curve(
                Variable("J", "J", "1" if measure == COST else measure, "accumulated cost"),
                found.steered.cost(design.regulator, found.times),
                exact_cost,
                style.PURPLE,
                say("accumulated cost, with <law>", law="$u = -K\\,x$"),
            ),
        )


def page(design: Design, seen: Responded) -> Figure:
    """Draw each state without control and with the gain, side by side; below them inputs and cost."""
    n, m = len(seen.free), len(seen.inputs)
    if style.sheet().highest < style.HIGHEST:
        return _beside(design, seen)
    wide = style.across(2) == 2
    figure = style.titled(design.title, style.WIDTH, 1.4 + 1.6 * (n + m) * (1 if wide else 2))
    grid = figure.add_gridspec(n + m, 2) if wide else figure.add_gridspec(2 * (n + m), 1)
    for j, column in enumerate((seen.free, seen.steered)):
        for i, (curve, measure) in enumerate(zip(column, _measures(column), strict=True)):
            axes = figure.add_subplot(grid[i, j] if wide else grid[(n + m) * j + i, 0])
            _draw(axes, seen.times, curve, measure)
            axes.tick_params(labelbottom=False)
            if i == 0:
                axes.set_title(curve.title)
    for i, (curve, measure) in enumerate(zip(seen.inputs, _measures(seen.inputs), strict=True)):
        axes = figure.add_subplot(grid[n + i, 1] if wide else grid[2 * n + m + i, 0])
        _draw(axes, seen.times, curve, measure)
        axes.tick_params(labelbottom=i == m - 1)
    axes.set_xlabel(display.labelled("$t$", seen.unit))
    axes = figure.add_subplot(grid[n:, 0] if wide else grid[n : n + m, 0])
    _draw(axes, seen.times, seen.cost, _measures([seen.cost])[0])
    axes.set_title(seen.cost.title)
    axes.set_xlabel(display.labelled("$t$", seen.unit))
    figure.align_ylabels()
    _told_apart(figure, seen)
    return figure


def _beside(design: Design, seen: Responded) -> Figure:
    """Draw the responses side by side on a page that cannot grow downwards."""
    shown = [*seen.free, *seen.steered, *seen.inputs, seen.cost]
    columns = style.columns(len(shown), 2, SMALL_ROW, 1.4)
    rows = -(-len(shown) // columns)
    figure = style.titled(design.title, style.WIDTH, 1.4 + SMALL_ROW * rows)
    grid = figure.add_gridspec(rows, columns)
    for k, (curve, measure) in enumerate(zip(shown, _measures(shown), strict=True)):
        axes = figure.add_subplot(grid[k])
        _draw(axes, seen.times, curve, measure)
        axes.set_title(curve.title)
        axes.tick_params(labelbottom=k + columns >= len(shown))
        if k + columns >= len(shown):
            axes.set_xlabel(display.labelled("$t$", seen.unit))
    figure.align_ylabels()
    _told_apart(figure, seen)
    return figure


def _told_apart(figure: Figure, seen: Responded) -> None:
    """Draw a legend, where there is more than the linear response."""
    if seen.cost.exact is not None:
        entries = [
            (legend.line(color=style.SOFT, **LINEAR), say("linear")),
            (legend.line(**NONLINEAR), say("nonlinear")),
        ]
        legend.below(figure, entries)


def differences(design: Design, seen: Responded) -> Figure | None:
    """Draw the differences of the exact from the linear motion, where their curves coincide."""
    sides = [[*seen.free, seen.cost], [*seen.steered, *seen.inputs]]
    hidden = [[(one, apart) for one in side if (apart := one.apart) is not None] for side in sides]
    columns = [side for side in hidden if side] if style.across(2) == 2 else [[*hidden[0], *hidden[1]]]
    rows = max(map(len, columns), default=0)
    if not rows:
        return None
    figure = style.titled(design.title, style.WIDTH, 1.2 + 1.9 * rows)
    grid = figure.add_gridspec(rows, len(columns))
    for j, column in enumerate(columns):
        differing = [replace(one, linear=apart, exact=None) for one, apart in column]
        for i, (one, measure) in enumerate(zip(differing, _measures(differing), strict=True)):
            axes = figure.add_subplot(grid[i, j])
            _draw(axes, seen.times, one, measure, apart=True)
            axes.set_title(f"{say('nonlinear minus linear')}: {one.title}")
            axes.tick_params(labelbottom=i == len(column) - 1)
        axes.set_xlabel(display.labelled("$t$", seen.unit))
    figure.align_ylabels()
    return figure


def _measures(shown: Sequence[Curve]) -> list[display.Scale]:
    """Return the unit of each curve; those of one colour, which are states or inputs, have the same unit."""
    found: dict[int, display.Scale] = {}
    for colour in dict.fromkeys(curve.colour for curve in shown):
        own = [k for k, curve in enumerate(shown) if curve.colour == colour]
        sizes = [(shown[k].what.unit, max(map(abs, shown[k].ends))) for k in own]
        found |= dict(zip(own, display.together(sizes), strict=True))
    return [found[k] for k in range(len(shown))]


def _draw(axes: Axes, times: Array, curve: Curve, measure: display.Scale, apart: bool = False) -> None:
    """Draw a quantity by the linear system, and by the exact motion while it is near; or their difference."""
    what, (low, high) = curve.what, curve.ends
    exact = None if curve.exact is None else curves.clean(curve.exact)
    scale = measure.divisor
    margin = 0.06 * (high - low or 1.0)
    axes.set_xlim(times[0], times[-1])
    axes.set_ylim((low - margin) / scale, (high + margin) / scale)
    axes.axhline(0.0, color=style.GREY, linewidth=0.8, zorder=1.9)
    axes.plot(times, curve.linear / scale, color=curve.colour, **LINEAR)
    if exact is not None:
        axes.plot(times, exact / scale, **NONLINEAR)
    symbol = display.formula(curve.prefix + what.latex, what.symbol)
    axes.set_ylabel(display.labelled(rf"$\delta\,${symbol}" if apart else symbol, measure.unit))
    axes.locator_params(axis="y", nbins=4)


def reach(design: Design, case: Instance) -> Figure | None:
    """Draw how far each state alone may deviate so that the exact motion returns; nothing for linear models."""
    regulator = design.regulator
    if not design.about.nonlinear or regulator.horizon is not None or not regulator.positive:
        return None
    found, start = region_of_attraction(design.about, design.regulator, case), design.deviation
    assert start is not None
    states = design.about.model.spec.states
    figure = style.titled(design.title, 0.8 * style.WIDTH, 1.2 + 0.85 * len(states))
    for axes, state, initial in zip(np.atleast_1d(figure.subplots(len(states), 1)), states, start, strict=True):
        _interval(axes, state, found.extents[state.symbol], float(initial), _delta(design))
    axes.set_xlabel(
        say("region of attraction, for deviations of a single state")
        + "\n"
        + say("the dot is the initial state of the instance")
    )
    return figure


def _delta(design: Design) -> str:
    """Return the mark of a deviation; the states of a linear model are deviations themselves."""
    return "" if design.about.model.spec.linear else r"\Delta "


def _interval(axes: Axes, state: Variable, extent: tuple[float, float], start: float, prefix: str) -> None:
    finite = [abs(v) for v in (*extent, start) if math.isfinite(v) and v]
    largest = max(finite, default=1.0)
    measure = display.engineering(state.unit, largest)
    scale = measure.divisor
    edge = 1.25 * largest / scale
    low, high = (np.clip(value / scale, -edge, edge) for value in extent)
    axes.set_xlim(-edge, edge)
    axes.set_ylim(-1.0, 1.0)
    axes.barh([0.0], [high - low], left=low, height=0.9, color=style.GREEN, alpha=0.25, linewidth=0.0, zorder=2.0)
    axes.axvline(0.0, color=style.GREY, linewidth=0.8, zorder=2.1)
    axes.plot([start / scale], [0.0], color=style.BLUE, **style.START)
    axes.set_yticks([])
    axes.locator_params(axis="x", nbins=9 if style.across(2) == 2 else 4)
    axes.spines["left"].set_visible(False)
    symbol = display.formula(prefix + state.latex, state.symbol)
    axes.set_ylabel(display.labelled(symbol, measure.unit), rotation=0, ha="right", va="center")
    axes.grid(axis="y", visible=False)
