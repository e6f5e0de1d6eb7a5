"""The pages after the overview: each takes a scene and gives a figure, or nothing where there is nothing to show."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from satsym.report.plots import legend, series, style
from satsym.report.plots.orbits import scenes as space
from satsym.report.plots.panels import small_multiples
from satsym.report.plots.scene import Scene
from satsym.report.plots.series import Series

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def orbit(scene: Scene) -> Figure | None:
    """The path in space; beside it, where it stays near the reference, the path seen from there."""
    shown = space.Orbit.of(scene)
    if shown is None:
        return None
    views = shown.views
    panels = len(views) + (shown.relative is not None)
    rows, columns = -(-panels // 2), min(panels, 2)
    page = style.titled(
        scene.title, 0.72 * style.WIDTH if columns == 1 else style.WIDTH, 1.2 + (6.0 if columns == 1 else 4.6) * rows
    )
    grid = page.add_gridspec(rows, columns)
    for i, view in enumerate(views):
        space.in_space(page.add_subplot(grid[i]), shown, view)
    if shown.relative is not None:
        beside = page.add_subplot(grid[panels - 1])
        beside.set_box_aspect(1.0)
        space.from_reference(beside, shown)
    legend.below(page, legend.motion(scene, style.STATE) + space.entries(shown))
    return page


def states(scene: Scene) -> Figure | None:
    """Every state, with the reference and the motion without control."""
    return _multiples(scene, series.states(scene), style.STATE)


def controls(scene: Scene) -> Figure | None:
    """Every control, with its bounds and switching times."""
    return _multiples(scene, series.controls(scene), style.CONTROL, columns=1)


def costates(scene: Scene) -> Figure | None:
    """Every costate, and the Hamiltonian."""
    return _multiples(scene, series.costates(scene), style.COSTATE)


def invariants(scene: Scene) -> Figure | None:
    """What the motion without control keeps constant, and the control changes."""
    return _multiples(scene, series.invariants(scene), style.INVARIANT, columns=1)


def _multiples(scene: Scene, quantities: Sequence[Series], colour: str, columns: int = 2) -> Figure | None:
    if not quantities or not scene.drawable:
        return None
    columns = 1 if len(quantities) <= 2 else columns if len(quantities) <= 8 else 3
    rows = -(-len(quantities) // columns)
    page = style.titled(scene.title, style.WIDTH if columns > 1 else 0.8 * style.WIDTH, 1.2 + 2.2 * rows)
    small_multiples(
        page, scene, [(quantity, colour) for quantity in quantities], columns, title={1: 60, 2: 40}.get(columns, 24)
    )
    beside = any(q.free is not None or q.reference is not None for q in quantities)
    entries = legend.motion(scene, colour) if beside else []
    legend.below(page, entries + legend.on_axes(quantities, colour))
    return page
