"""Pages of pictures, of a motion and of the iterations to an answer; none where there is nothing to show."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from satsym.arrays import Array
from satsym.report.display import labelled, number, unit_text
from satsym.report.plots import legend, phase_planes, series, style
from satsym.report.plots import scenes as space
from satsym.report.plots.curves import clean
from satsym.report.plots.panels import small_multiples
from satsym.report.plots.scene import Scene
from satsym.report.plots.series import Series
from satsym.report.plots.space import attitudes
from satsym.report.said import counted, decimal, message, say
from satsym.solution import Solution
from satsym.status import Status

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure


ROW, PLANE = 2.2, 4.4
"""Height of a row of panels, and of phase planes, in inches on a screen."""


def orbit(scene: Scene) -> Figure | None:
    """Draw the path in space; if it stays near the reference, also relative to that."""
    shown = space.Orbit.of(scene)
    return None if shown is None or shown.by_states else _in_space(scene, shown)


def path(scene: Scene) -> Figure | None:
    """Draw the path whose coordinates are states, for a model without a position vector."""
    shown = space.Orbit.of(scene)
    return None if shown is None or not shown.by_states else _in_space(scene, shown)


def _in_space(scene: Scene, shown: space.Orbit) -> Figure:
    views = shown.views
    panels = len(views) + (shown.relative is not None)
    columns = style.across(min(panels, 2))
    rows = -(-panels // columns)
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


def phase(scene: Scene) -> Figure | None:
    """Draw the phase planes of a motion that is neither in a plane nor in space."""
    drawn = phase_planes.of(scene)
    if not drawn or space.Orbit.of(scene) is not None:
        return None
    wide = 1 if len(drawn) == 1 else 2
    columns = style.columns(len(drawn), wide, PLANE)
    rows = -(-len(drawn) // columns)
    page = style.titled(scene.title, style.WIDTH if columns > 1 else 0.72 * style.WIDTH, 1.2 + PLANE * rows)
    grid = page.add_gridspec(rows, columns)
    for i, pair in enumerate(drawn):
        phase_planes.draw(page.add_subplot(grid[i]), pair)
    legend.below(page, legend.motion(scene, style.STATE) + phase_planes.entries(drawn))
    return page


def attitude(scene: Scene) -> Figure | None:
    """Draw the attitude on a sphere, where states give it completely and the motion has no path."""
    found = _attitude(scene)
    if found is None:
        return None
    page = style.titled(scene.title, 0.72 * style.WIDTH, 7.2)
    attitudes.on_sphere(page.subplots(), found)
    legend.below(page, attitudes.entries())
    return page


def _attitude(scene: Scene) -> attitudes.Attitude | None:
    found = attitudes.Attitude.of(scene)
    return found if found is not None and found.complete and space.Orbit.of(scene) is None else None


def states(scene: Scene) -> Figure | None:
    """Draw every state, with the reference and the uncontrolled motion."""
    return _multiples(scene, series.states(scene), style.STATE)


def controls(scene: Scene) -> Figure | None:
    """Draw every control, with its bounds and switching times."""
    return _multiples(scene, series.controls(scene), style.CONTROL, columns=1)


def constraints(scene: Scene) -> Figure | None:
    """Draw every path constraint, with the time on its boundary and its entries and exits."""
    return _multiples(scene, series.constraints(scene), style.INVARIANT, columns=1)


def costates(scene: Scene) -> Figure | None:
    """Draw every costate, and the Hamiltonian."""
    return _multiples(scene, series.costates(scene), style.COSTATE)


def invariants(scene: Scene) -> Figure | None:
    """Draw the invariants of the uncontrolled motion, which the control changes."""
    return _multiples(scene, series.invariants(scene), style.INVARIANT, columns=1)


def _multiples(scene: Scene, quantities: Sequence[Series], colour: str, columns: int = 2) -> Figure | None:
    if not quantities or not scene.drawable:
        return None
    wanted = 1 if len(quantities) <= 2 else columns if len(quantities) <= 8 else 3
    columns = style.columns(len(quantities), wanted, ROW)
    rows = -(-len(quantities) // columns)
    page = style.titled(scene.title, style.WIDTH if columns > 1 else 0.8 * style.WIDTH, 1.2 + ROW * rows)
    panels = [(quantity, colour) for quantity in quantities]
    small_multiples(page, scene, panels, columns, title=style.room(page, columns), whole=style.room(page, 1))
    beside = any(q.free is not None or q.reference is not None for q in quantities)
    entries = legend.motion(scene, colour) if beside else []
    legend.below(page, entries + legend.on_axes(quantities, colour))
    return page


MOST_PANELS = 8
"""Largest number of states, and of controls, on the overview; the other pages show all of them."""
TALL = 4
"""Rows of panels from which the legend has room below the picture in space beside them."""


def overview(scene: Scene) -> Figure | None:
    """Draw path, states and controls on one page under a line of facts; nothing without a trajectory."""
    if not scene.drawable:
        return None
    shown, turning = space.Orbit.of(scene), _attitude(scene)
    beside = shown is not None or turning is not None
    states, controls = series.states(scene)[:MOST_PANELS], series.controls(scene)[:MOST_PANELS]
    limits = series.unseen(scene, shown is not None and bool(shown.around.forbidden))[:MOST_PANELS]
    groups = (states, style.STATE), (controls, style.CONTROL), (limits, style.INVARIANT)
    columns = style.across(1 if len(states) == 1 else 2)
    narrow = style.across(2) == 1
    rows = sum(-(-len(quantities) // columns) for quantities, _ in groups)
    height = max(1.0 + 1.55 * rows, 6.2 if beside and not narrow else 4.2)
    height += 6.0 if narrow and beside else 0.0
    page = style.figure(style.WIDTH, height)
    right: Figure | SubFigure = page
    if style.with_titles() or not scene.result.status.answered:
        heading = _Heading.of(page, scene)
        head, right = _split(page, (2, 1), height_ratios=[heading.height, height - heading.height])
        heading.write(head, scene.result.status)
    left = None
    if beside:
        apart: dict[str, Any] = {"height_ratios": [6.0, height - 6.75]} if narrow else {"width_ratios": [1.0, 1.12]}
        left, right = _split(right, (2, 1) if narrow else (1, 2), **apart)
        if shown is not None:
            _space(left, shown)
        elif turning is not None:
            attitudes.on_sphere(left.subplots(), turning)
    small_multiples(right, scene, [(q, colour) for quantities, colour in groups for q in quantities], columns)
    # an axis of a body on the sphere has the colour of states, whose panels need no entry
    entries = legend.motion(scene, style.STATE)[int(shown is None and turning is not None) :]
    entries += space.entries(shown) if shown is not None else attitudes.entries() if turning is not None else []
    entries += legend.on_axes([*states, *controls], style.CONTROL)
    entries += legend.on_axes(limits, style.INVARIANT)
    if left is not None and not narrow and rows >= TALL:
        legend.below(page, entries, left, 1.0 / 2.12)
    else:
        legend.below(page, entries)
    return page


def _split(part: Figure | SubFigure, shape: tuple[int, int], **ratios: Any) -> tuple[SubFigure, SubFigure]:
    parts: Any = part.subfigures(*shape, **ratios)
    return parts[0], parts[1]


def _space(part: SubFigure, shown: space.Orbit) -> None:
    if shown.relative is None:
        space.in_space(part.subplots(), shown, shown.views[0])
        return
    above, below = part.subplots(2, 1, height_ratios=[1.75, 1.0])
    space.in_space(above, shown, shown.views[0])
    space.from_reference(below, shown)


@dataclass(frozen=True)
class _Heading:
    """The title of the instance, and below it the facts of the result, on as many lines as the page needs."""

    title: str
    facts: str

    @classmethod
    def of(cls, page: Figure, scene: Scene) -> _Heading:
        fit = style.on_screen(page) / style.WIDTH
        title = textwrap.fill(scene.title, int(86 * fit), max_lines=3, placeholder="\N{HORIZONTAL ELLIPSIS}")
        first, *others = _facts(scene)
        facts = [first]
        for fact in others:
            longer = f"{facts[-1]}     {fact}"
            facts[-1:] = [longer] if len(longer) <= 130 * fit else [facts[-1], fact]
        return cls(title if style.with_titles() else "", "\n".join(facts))

    @property
    def height(self) -> float:
        """Return the height in inches on a screen."""
        return 0.75 + 0.3 * (self.title.count("\n") + self.facts.count("\n"))

    def write(self, part: SubFigure, status: Status) -> None:
        """Write the heading on its part of a page, with the status of an unsuccessful run."""
        edge = 0.12 / self.height
        bold: dict[str, Any] = {"fontweight": "bold"}
        part.text(0.012, 1.0 - edge, self.title, va="top", fontsize=style.points(14.0), parse_math=False, **bold)
        part.text(0.012, edge, self.facts, va="bottom", fontsize=style.points(10.5), color=style.SOFT)
        if not status.answered:
            said = message(status.value)
            part.text(0.988, 1.0 - edge, said, ha="right", va="top", color=style.ALARM, **bold)


def _facts(scene: Scene) -> list[str]:
    result = scene.result
    found = [say("model <name>", name=scene.spec.name)]
    if isinstance(result, Solution):
        found.append(say("by <method>, <effort>", method=result.method, effort=counted(result.iterations, "iteration")))
        if math.isfinite(result.objective):
            value = decimal(number(scene.spec.objective(result.objective), 7))
            found.append(f"$J$ = {value} {unit_text(scene.spec.objective_unit)}".rstrip())
    elif scene.spec.controls:
        found.append(scene.name)
    if np.isfinite(scene.times[-1]):
        found.append(f"$t_f$ = {decimal(number(float(scene.times[-1])))} {unit_text(scene.time_unit)}".rstrip())
    return found


ANEW = 100.0
"""Ratio of a residual to the one before above which a new phase of the iteration begins."""
MOST_DRAWN, FEWEST_DRAWN = 80, 4
"""Largest number of iterations that are drawn, and smallest number of values in the drawn phases."""
EXACT = 1e-16
"""Smallest displayed value relative to the largest; smaller values are due to rounding."""
ELSEWHERE = 0.05
"""Relative difference from the cost of the solution above which iterations ended at another solution."""


def convergence(scene: Scene) -> Figure | None:
    """Draw the distance of the cost from the final one, and the residual, over the iterations.

    Nothing is drawn for fewer than three iterations.

    A quantity that has fewer than two values above rounding has no panel, nor has the cost where a competitor became
    the answer, to which these iterations did not lead.
    """
    history = scene.history
    if len(history) < 3:
        return None
    assert isinstance(scene.result, Solution)  # nothing else has a history
    at = np.array([entry.number for entry in history], dtype=float)
    residuals = np.abs(clean(np.array([entry.residual for entry in history])))
    last = scene.spec.objective(scene.result.objective)
    costs = clean(np.array([scene.spec.objective(entry.objective) for entry in history]))
    saturated = _largest(_saturated(scene))
    near = abs(costs[-1] - last) <= ELSEWHERE * max(_largest([costs[-1], last]), saturated)
    distances = np.abs(costs - last) if scene.result.status.answered and near else np.full_like(costs, np.nan)
    panels = [
        (_above_rounding(distances, max(_largest([*costs, last]), saturated)), style.PURPLE),
        (_above_rounding(residuals, _largest(residuals)), style.GREEN),
    ]
    # Solved without bounds first, then within them, say: each phase begins with a residual of its own.
    begun = np.flatnonzero(residuals[1:] > ANEW * residuals[:-1]) + 1
    first = _last_phases(begun, panels[1][0])
    at, begun = at[first:], begun[begun > first] - first
    panels = [(values[first:], colour) for values, colour in panels]
    drawn = [int(np.isfinite(values).sum()) > 1 for values, _ in panels]
    if not any(drawn):
        return None
    columns = style.across(sum(drawn))
    rows = sum(drawn) // columns
    page = style.titled(scene.title, style.WIDTH if columns > 1 else 0.8 * style.WIDTH, 4.1 if rows == 1 else 6.6)
    places = iter(page.subplots(rows, columns, squeeze=False).flat)
    saying = [_of_cost(scene, last, drawn[0]), _of_residual(bool(begun.size))]
    if first:
        said = say("the last <shown> of <whole> iterations", shown=len(at), whole=len(history))
        saying[1] = f"{saying[1][0]}\n{said}", saying[1][1]
    if not drawn[0]:  # the cost is said all the same
        saying[1] = f"{saying[0][0]}\n{saying[1][0]}", saying[1][1]
    for (values, colour), (title, label), has_values in zip(panels, saying, drawn, strict=True):
        if has_values:
            axes = next(places)
            axes.set_title(title)
            axes.set_ylabel(label)
            _decades(axes, at, values, begun, colour)
    return page


def _last_phases(begun: NDArray[np.intp], residuals: Array) -> int:
    """Return the first iteration that is drawn: of long histories, only the last phases are.

    At least a few values of them are above rounding.
    """
    whole = len(residuals)
    if whole <= MOST_DRAWN:
        return 0
    far = [int(k) for k in begun if k >= whole - MOST_DRAWN and np.isfinite(residuals[k:]).sum() >= FEWEST_DRAWN]
    return far[0] if far else whole - MOST_DRAWN


def _of_cost(scene: Scene, last: float, drawn: bool) -> tuple[str, str]:
    """Return title and label of the panel on the cost, or of the cost alone where no panel is drawn."""
    unit, status = scene.spec.objective_unit or "1", scene.result.status
    if status.answered:
        final = f"{decimal(number(last, 10))} {unit_text(unit)}".rstrip()
        if scene.spec.maximise:
            said = "distance from the final objective <value>" if drawn else "final objective <value>"
        else:
            said = "distance from the final cost <value>" if drawn else "final cost <value>"
        title = say(said, value=final)
    else:
        nothing = "no objective: <status>" if scene.spec.maximise else "no cost: <status>"
        title = say(nothing, status=message(status.value))
    return title, labelled(say(r"$|J - J_{\mathrm{last}}|$"), unit)


def _of_residual(phases: bool) -> tuple[str, str]:
    """Return title and label of the panel on the residual."""
    whole, parts = "residual of the optimality conditions", "residual of the optimality conditions, phase by phase"
    return say(parts if phases else whole), say("residual")


def _saturated(scene: Scene) -> Array:
    """Return the cost of saturated controls along the trajectory, at each node: the scale of a zero cost."""
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
    """Return values with NaN for those that are rounding errors of something of this size."""
    with np.errstate(invalid="ignore"):
        return np.where(values > EXACT * size, values, np.nan)


def _decades(axes: Axes, at: Array, values: Array, begun: NDArray[np.intp], colour: str) -> None:
    """Draw positive values on a logarithmic axis, joined within a phase, without values that are not finite."""
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
