"""The phase portrait of a linear system with two states."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from satsym.report import display
from satsym.report.plots import style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from satsym.analysis.linear.structure import Analysis

POINTS = 41
"""Of the grid on which directions are computed, along each axis."""


def portrait(found: Analysis) -> Figure | None:
    """Streamlines, and the straight motions along real eigenvectors; nothing for other than two states."""
    A, states = found.about.system.A, found.about.model.spec.states
    if len(A) != 2 or not found.about.constant:
        return None
    page = style.titled(found.about.model.spec.title, 5.6, 5.6)
    axes = page.subplots()
    axes.set_title(f"phase portrait: {found.stability.verdict}")
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, POINTS), np.linspace(-1.0, 1.0, POINTS))
    u, v = (row[0] * x + row[1] * y for row in A)
    if np.hypot(u, v).any():
        axes.streamplot(x, y, u, v, color=style.BLUE, linewidth=1.0, density=1.1, arrowsize=1.1)
    values, vectors = np.linalg.eig(A)
    for value, (a, b) in zip(values, vectors.T, strict=True):
        if value.imag == 0.0:
            far = 1.0 / max(abs(a), abs(b))
            colour = style.VERMILION if value.real > 0.0 else style.GREEN
            axes.plot(
                [-a.real * far, a.real * far], [-b.real * far, b.real * far], color=colour, linewidth=2.2, zorder=1.5
            )
    axes.plot([0.0], [0.0], **(style.ORIGIN | {"marker": "o", "markersize": 6.0}))
    axes.set_xlim(-1.0, 1.0)
    axes.set_ylim(-1.0, 1.0)
    axes.set_aspect("equal")
    first, second = (display.labelled(display.formula(state.latex, state.symbol), state.unit) for state in states)
    axes.set_xlabel(first)
    axes.set_ylabel(second)
    return page
