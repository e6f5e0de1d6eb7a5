"""How an answer was come to: cost and residual over the iterations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from satsym.arrays import Array
from satsym.report.display import labelled, number, unit_text
from satsym.report.plots import style
from satsym.report.plots.curves import clean
from satsym.report.plots.scene import Scene
from satsym.report.said import decimal, message, say
from satsym.solution import Solution

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ANEW = 100.0
"""A residual this many times the one before begins another phase."""
EXACT = 1e-16
"""Relative to the largest: what is smaller is rounding, and fills no axis."""


def convergence(scene: Scene) -> Figure | None:
    """Distance of the cost from the answer's, and the residual, over the iterations; nothing for fewer than three.

    A quantity that has fewer than two values above rounding has no panel.
    """
    history = scene.history
    if len(history) < 3:
        return None
    assert isinstance(scene.result, Solution)  # nothing else has a history
    at = np.array([entry.number for entry in history], dtype=float)
    residuals = np.abs(clean(np.array([entry.residual for entry in history])))
    last = scene.spec.objective(scene.result.objective)
    costs = clean(np.array([scene.spec.objective(entry.objective) for entry in history]))
    distances = np.abs(costs - last) if scene.result.status.answered else np.full_like(costs, np.nan)
    panels = [
        (_above_rounding(distances, max(_largest([*costs, last]), _largest(_saturated(scene)))), style.PURPLE),
        (_above_rounding(residuals, _largest(residuals)), style.GREEN),
    ]
    drawn = [int(np.isfinite(values).sum()) > 1 for values, _ in panels]
    if not any(drawn):
        return None
    # Solved without bounds first, then within them, say: each phase begins with a residual of its own.
    begun = np.flatnonzero(residuals[1:] > ANEW * residuals[:-1]) + 1
    columns = style.across(sum(drawn))
    rows = sum(drawn) // columns
    page = style.titled(scene.title, style.WIDTH if columns > 1 else 0.8 * style.WIDTH, 4.1 if rows == 1 else 6.6)
    places = iter(page.subplots(rows, columns, squeeze=False).flat)
    saying = [_of_cost(scene, last), _of_residual(bool(begun.size))]
    if not drawn[0]:  # the cost is said all the same
        saying[1] = f"{saying[0][0]}\n{saying[1][0]}", saying[1][1]
    for (values, colour), (title, label), has_values in zip(panels, saying, drawn, strict=True):
        if has_values:
            axes = next(places)
            axes.set_title(title)
            axes.set_ylabel(label)
            _decades(axes, at, values, begun, colour)
    return page


def _of_cost(scene: Scene, last: float) -> tuple[str, str]:
    """Title and label."""
    unit, status = scene.spec.objective_unit or "1", scene.result.status
    if status.answered:
        final = f"{decimal(number(last, 10))} {unit_text(unit)}".rstrip()
        title = say("final objective <value>" if scene.spec.maximise else "final cost <value>", value=final)
    else:
        nothing = "no objective: <status>" if scene.spec.maximise else "no cost: <status>"
        title = say(nothing, status=message(status.value))
    return title, labelled(say(r"$|J - J_{\mathrm{last}}|$"), unit)


def _of_residual(phases: bool) -> tuple[str, str]:
    """Title and label."""
    whole, parts = "residual of the optimality conditions", "residual of the optimality conditions, phase by phase"
    return say(parts if phases else whole), say("residual")


def _saturated(scene: Scene) -> Array:
    """What controls on their bounds would cost along the trajectory, at each node: the scale of a cost that is zero."""
    ends = np.array([scene.instance.lower, scene.instance.upper])
    most = np.abs(np.where(np.isfinite(ends), ends, 0.0)).max(axis=0)
    if not len(scene.nodes):
        return np.zeros(0)
    u = np.tile(most[:, None], (1, len(scene.nodes)))
    with np.errstate(all="ignore"):
        rates = scene.instance.model.running_cost_batch(scene.nodes, scene.x, u, scene.instance.parameters)
    return clean(rates * np.ptp(scene.nodes))


def _largest(values: ArrayLike) -> float:
    return float(np.nanmax(np.abs(values), initial=0.0))


def _above_rounding(values: Array, size: float) -> Array:
    """Values with NaN for those that are nothing but rounding errors of something so large."""
    with np.errstate(invalid="ignore"):
        return np.where(values > EXACT * size, values, np.nan)


def _decades(axes: Axes, at: Array, values: Array, begun: NDArray[np.intp], colour: str) -> None:
    """Positive values on a logarithmic axis, joined within a phase; what is not finite is left out."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator

    axes.set_yscale("log")
    axes.set_ylim(float(np.nanmin(values)) / 3.0, float(np.nanmax(values)) * 3.0)
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlim(at[0] - 0.3, at[-1] + 0.3)
    axes.xaxis.set_major_locator(MaxNLocator(8, integer=True))
    for steps, phase in zip(np.split(at, begun), np.split(values, begun), strict=True):
        drawn = np.isfinite(phase)
        axes.plot(steps[drawn], phase[drawn], color=colour, marker="o", markersize=4.5, linewidth=1.4)
    axes.set_xlabel(say("iteration"))
