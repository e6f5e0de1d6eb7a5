"""Responses to a disturbance as small multiples, and from how far the linear law works."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.report import display
from satsym.report.plots import curves, legend, style
from satsym.report.results.unit_names import COST, of_regulator
from satsym.report.said import say
from satsym.spec import Variable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from satsym.analysis.regulator.feedback import Design

LINEAR: dict[str, Any] = {"linewidth": 2.0, "zorder": 3.0}
NONLINEAR: dict[str, Any] = {"color": style.INK, "linewidth": 1.2, "linestyle": (0, (4, 2)), "zorder": 3.2}
BEYOND = 1.5
"""How far beyond the linear response a nonlinear one is shown, relative to its width."""


def page(design: Design, case: Instance) -> Figure:
    """Each state without control and with the gain, side by side; below them the inputs, and what they cost."""
    from satsym.analysis.regulator.responses import responses

    found, spec = responses(design, case), design.about.model.spec
    units = (v.unit for v in (*spec.states, *spec.controls, *spec.parameters))
    factor, unit = display.time_scale(units, float(np.ptp(found.times)))
    times, inputs = found.times / factor, [v for v in spec.controls if v.symbol in design.regulator.system.inputs]
    inputs.sort(key=lambda v: design.regulator.system.inputs.index(v.symbol))
    n, m = len(spec.states), len(inputs)
    wide = style.across(2) == 2
    figure = style.titled(design.title, style.WIDTH, 1.4 + 1.6 * (n + m) * (1 if wide else 2))
    grid = figure.add_gridspec(n + m, 2) if wide else figure.add_gridspec(2 * (n + m), 1)
    delta = _delta(design)
    columns = [
        (say("uncontrolled"), style.BLUE, found.free.x, found.exact_free),
        (say("with <law>", law="$u = -K\\,x$"), style.GREEN, found.steered.x, found.exact_steered),
    ]
    for j, (title, colour, linear, exact) in enumerate(columns):
        for i, state in enumerate(spec.states):
            axes = figure.add_subplot(grid[i, j] if wide else grid[(n + m) * j + i, 0])
            _curve(axes, times, state, linear[i], None if exact is None else exact.x[i], colour, delta)
            axes.tick_params(labelbottom=False)
            if i == 0:
                axes.set_title(title)
    for i, control in enumerate(inputs):
        axes = figure.add_subplot(grid[n + i, 1] if wide else grid[2 * n + m + i, 0])
        exact_u = None if found.exact_steered is None else found.exact_steered.u[i]
        _curve(axes, times, control, found.steered.u[i], exact_u, style.CONTROL)
        axes.tick_params(labelbottom=i == m - 1)
    axes.set_xlabel(display.labelled("$t$", unit))
    axes = figure.add_subplot(grid[n:, 0] if wide else grid[n : n + m, 0])
    measure = of_regulator(spec, design.regulator.system.inputs, design.relative)
    cost = Variable("J", "J", "1" if measure == COST else measure, "accumulated cost")
    exact_cost = None if found.exact_steered is None else found.exact_steered.cost(design.regulator, found.times)
    linear_cost = found.steered.cost(design.regulator, found.times)
    _curve(axes, times, cost, linear_cost, exact_cost, style.PURPLE)
    axes.set_title(say("accumulated cost, with <law>", law="$u = -K\\,x$"))
    axes.set_xlabel(display.labelled("$t$", unit))
    figure.align_ylabels()
    if found.exact_free is not None:
        entries = [
            (legend.line(color=style.SOFT, **LINEAR), say("linear")),
            (legend.line(**NONLINEAR), say("nonlinear")),
        ]
        legend.below(figure, entries)
    return figure


def _curve(
    axes: Axes, times: Array, what: Variable, linear: Array, exact: Array | None, colour: str, prefix: str = ""
) -> None:
    """A quantity by the linear system, and by the exact motion as far as it is near that."""
    low, high = min(float(linear.min()), 0.0), max(float(linear.max()), 0.0)
    width = high - low or 1.0
    if exact is not None:
        near = curves.clean(exact)
        if np.isfinite(near).any():
            low = max(min(low, float(np.nanmin(near))), low - BEYOND * width)
            high = min(max(high, float(np.nanmax(near))), high + BEYOND * width)
    measure = display.engineering(what.unit, max(abs(low), abs(high)))
    scale = measure.divisor
    margin = 0.06 * (high - low or 1.0)
    axes.set_xlim(times[0], times[-1])
    axes.set_ylim((low - margin) / scale, (high + margin) / scale)
    axes.axhline(0.0, color=style.GREY, linewidth=0.8, zorder=1.9)
    axes.plot(times, linear / scale, color=colour, **LINEAR)
    if exact is not None:
        axes.plot(times, curves.clean(exact) / scale, **NONLINEAR)
    symbol = display.formula(prefix + what.latex, what.symbol)
    axes.set_ylabel(display.labelled(symbol, measure.unit))
    axes.locator_params(axis="y", nbins=4)


def reach(design: Design, case: Instance) -> Figure | None:
    """How far each state alone may be off for the exact motion to return; nothing where only a linear one is known."""
    from satsym.analysis.regulator.region_of_attraction import region_of_attraction

    if not design.about.nonlinear or design.regulator.horizon is not None:
        return None
    found, start = region_of_attraction(design.about, design.regulator, case), design.deviation
    assert start is not None
    states = design.about.model.spec.states
    figure = style.titled(design.title, 0.8 * style.WIDTH, 1.2 + 0.85 * len(states))
    for axes, state, initial in zip(np.atleast_1d(figure.subplots(len(states), 1)), states, start, strict=True):
        _interval(axes, state, found.extents[state.symbol], float(initial), _delta(design))
    axes.set_xlabel(
        say("region of attraction, for a deviation of one state alone")
        + "\n"
        + say("the dot is the initial state of the instance")
    )
    return figure


def _delta(design: Design) -> str:
    """What marks a deviation; the states of a linear model are deviations themselves."""
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
    axes.spines["left"].set_visible(False)
    symbol = display.formula(prefix + state.latex, state.symbol)
    axes.set_ylabel(display.labelled(symbol, measure.unit), rotation=0, ha="right", va="center")
    axes.grid(axis="y", visible=False)
