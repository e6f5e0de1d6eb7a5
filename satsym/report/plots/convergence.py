"""How the iterations of a solver came to their end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from satsym.report.display import number
from satsym.report.plots import style
from satsym.report.plots.curves import clean
from satsym.report.plots.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


ANEW = 100.0
"""A residual this many times the one before begins another phase."""


def convergence(scene: Scene) -> Figure | None:
    """Distance of the cost from its last value, and the residual, over the iterations; nothing for fewer than three."""
    history = scene.history
    if len(history) < 3:
        return None
    page = style.titled(scene.title, style.WIDTH, 4.1)
    left, right = page.subplots(1, 2)
    at = np.array([entry.number for entry in history], dtype=float)
    costs = clean(np.array([entry.objective for entry in history]))
    residuals = clean(np.array([entry.residual for entry in history]))
    known = costs[np.isfinite(costs)]
    last = float(known[-1]) if known.size else 0.0
    _decades(left, at, np.abs(costs - last), style.PURPLE)
    left.set_ylabel(r"$|J - J_{\mathrm{last}}|$")
    left.set_title(f"final cost {number(last, 10)}" if known.size else "cost")
    _decades(right, at, np.abs(residuals), style.GREEN)
    right.set_ylabel("residual")
    # Solved without bounds first, then within them, say: each phase begins with a residual of its own.
    begun = (residuals[1:] > ANEW * residuals[:-1]).any()
    right.set_title("residual of the optimality conditions" + (", phase by phase" if begun else ""))
    return page


def _decades(axes: Axes, at: np.ndarray, values: np.ndarray, colour: str) -> None:
    """Positive values on a logarithmic axis; zeros and what is not finite are left out."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator

    positive = np.where(values > 0.0, values, np.nan)
    if np.isfinite(positive).any():
        low, high = np.nanmin(positive), np.nanmax(positive)
        axes.set_yscale("log")
        axes.set_ylim(low / 3.0, high * 3.0)
        axes.yaxis.set_major_locator(LogLocator(numticks=6))
        axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlim(at[0] - 0.3, at[-1] + 0.3)
    axes.xaxis.set_major_locator(MaxNLocator(8, integer=True))
    drawn = np.isfinite(positive)
    axes.plot(at[drawn], positive[drawn], color=colour, marker="o", markersize=4.5, linewidth=1.4)
    axes.set_xlabel("iteration")
