"""Instances side by side on one page: their common quantities over time, their totals, and the law's range."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.arrays import Array
from satsym.report import display
from satsym.report.look import SCREEN, Look
from satsym.report.plots import legend, style
from satsym.report.plots.reading import ROUNDING, SMALL_DEVIATION
from satsym.report.results import files
from satsym.report.said import decimal, say
from satsym.report.terminal.comparison import specs_of, unit_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from satsym.analysis.comparison import Case
    from satsym.spec import Variable

COLOURS = (style.INK, style.BLUE, style.VERMILION, style.GREEN, style.PURPLE, style.GREY)
DASHES: tuple[Any, ...] = ("-", "-", (0, (6, 2)), (0, (3, 1.5)), (0, (1, 1.2)), "-.")
SHOWN = 1.12
"""Displayed duration, relative to the longest transition."""
NEAR_ZERO = 0.5
"""Distance of zero from a curve, relative to the range of the curve, up to which the line of zero is drawn."""
ROOM = 2.8
"""Largest displayed damping, relative to the largest computed one, which leaves room for the labels of the lines."""
COMMANDS = (0.25, 0.5, 1.0, 2.0, 4.0)
DAMPINGS = (0.2, 5.0)
"""Smallest and largest damping of the displayed range, relative to that of the instance."""


def pictures(cases: Sequence[Case], look: Look = SCREEN) -> dict[str, files.Content]:
    """Draw the page ``comparison``; map file names to contents, empty without answers."""
    with style.applied(look):
        drawn = page(cases)
        return {} if drawn is None else style.contents("comparison", drawn)


def page(cases: Sequence[Case]) -> Figure | None:
    """Draw the comparison of the cases that have answers; ``None`` where there are none."""
    answered = [case for case in cases if case.answered]
    if not answered:
        return None
    shared = _shared(answered)
    panels = [(variable, dict[int, Array]()) for variable in shared]
    panels += [(variable, apart) for variable in shared if (apart := _differences(answered, variable))]
    law = next((case for case in answered if case.instance.classical and case.instance.classical.damping), None)
    columns = style.across(2)
    several = len(answered) > 1
    below = -(-len(panels) // columns)
    pairs = 2 // columns
    rows = below + pairs * (several + (law is not None))
    own = len(cases) == 1 or all(case.instance.driven for case in cases)
    title = (
        cases[0].instance.title
        if own
        else display.capitalised(say("comparison of <number> instances", number=len(cases)))
    )
    figure = style.titled(title, style.WIDTH, 0.9 + 2.35 * rows)
    grid = figure.add_gridspec(rows, columns)
    measures = _measures(answered, panels)
    for k, (variable, apart) in enumerate(panels):
        last = k == len(panels) - 1 and k % columns == 0
        place = grid[k // columns, :] if last else grid[k // columns, k % columns]
        _over_time(figure.add_subplot(place), answered, variable, apart, measures[k])
    lower = [figure.add_subplot(grid[below + k // columns, k % columns]) for k in range((rows - below) * columns)]
    if several:
        _totals(lower[:2], answered, style.room(figure, columns))
    if law is not None:
        _range(lower[-2:], law)
    entries = [
        (legend.line(color=COLOURS[k % 6], linestyle=DASHES[k % 6], linewidth=2.0), case.instance.name)
        for k, case in enumerate(answered)
    ]
    legend.below(figure, entries)
    return figure


def panel(axes: Axes, cases: Sequence[Case]) -> None:
    """Draw one quantity that the cases share.

    It is the first in which their curves differ too little to be distinguished; else the first of all.
    """
    shared = _shared(cases)
    hidden = ((variable, apart) for variable in shared if (apart := _differences(cases, variable)))
    shown: tuple[Variable, Mapping[int, Array]] = next(hidden, (shared[0], {}))
    _over_time(axes, cases, *shown, _measures(cases, [shown])[0])


def _shared(cases: Sequence[Case]) -> list[Variable]:
    """Return common states, used controls and limited quantities; those with a command or a limit come first."""
    specs = specs_of(cases)
    every = [{v.symbol: v for v in (*one.states, *one.controls, *one.quantities)} for one in specs]
    spec = specs[0]
    limited = [name for case in cases for name in case.instance.limits]
    wanted = dict.fromkeys([spec.states[0].symbol, *spec.control_names, *(v.symbol for v in spec.states), *limited])
    idle = {name for name in spec.control_names if not any(case.signal(name).any() for case in cases)}
    return [every[0][name] for name in wanted if name not in idle and all(name in each for each in every)]


def _differences(cases: Sequence[Case], variable: Variable) -> dict[int, Array]:
    """Return differences from the first case, by case number, where one curve would hide another."""
    first, found = cases[0], {}
    values, times = first.signal(variable.symbol), first.times - first.times[0]
    for k, case in enumerate(cases[1:], start=1):
        own = case.times - case.times[0]
        apart = np.where(own <= times[-1], case.signal(variable.symbol) - np.interp(own, times, values), np.nan)
        if ROUNDING * np.ptp(values) < np.nanmax(np.abs(apart)) < SMALL_DEVIATION * np.ptp(values):
            found[k] = apart
    return found


def _drawn(cases: Sequence[Case], variable: Variable, apart: Mapping[int, Array]) -> Mapping[int, Array]:
    """Return the differences of some cases, or the variable itself, by case number."""
    return apart or {k: case.signal(variable.symbol) for k, case in enumerate(cases)}


def _measures(cases: Sequence[Case], panels: Sequence[tuple[Variable, Mapping[int, Array]]]) -> list[display.Scale]:
    """Return the unit of each panel; values share one, and so do differences."""
    found: dict[int, display.Scale] = {}
    for kind in (False, True):
        own = [k for k, (_, apart) in enumerate(panels) if bool(apart) is kind]
        sizes = [(panels[k][0].unit, _largest(_drawn(cases, *panels[k]).values())) for k in own]
        found |= dict(zip(own, display.together(sizes), strict=True))
    return [found[k] for k in range(len(panels))]


def _largest(rows: Iterable[Array]) -> float:
    return max(float(np.nanmax(np.abs(values))) for values in rows)


def _over_time(
    axes: Axes, cases: Sequence[Case], variable: Variable, apart: Mapping[int, Array], measure: display.Scale
) -> None:
    """Draw a variable of all cases, or the differences of some from the first."""
    end = SHOWN * max(_until(case) for case in cases)
    spec = specs_of(cases)[0]
    factor, unit = display.time_scale([v.unit for v in (*spec.states, *spec.controls)], end)
    drawn = _drawn(cases, variable, apart)
    most = _largest(drawn.values())
    for k, values in drawn.items():
        axes.plot(
            (cases[k].times - cases[k].times[0]) / factor,
            values / measure.divisor,
            color=COLOURS[k % 6],
            linestyle=DASHES[k % 6],
            linewidth=1.8,
            zorder=3.0 + 0.1 * k,
        )
    limit = max((case.instance.limits.get(variable.symbol, 0.0) for case in cases), default=0.0)
    if not apart and 0.0 < limit < 2.0 * most:
        for edge in (-limit, limit):
            axes.axhline(edge / measure.divisor, **style.BOUND)
    low, high = (float(of([of(row[np.isfinite(row)]) for row in drawn.values()])) for of in (np.min, np.max))
    if low - NEAR_ZERO * (high - low) <= 0.0 <= high + NEAR_ZERO * (high - low):
        axes.axhline(0.0, color=style.GREY, linewidth=0.8, zorder=1.9)
    axes.set_xlim(0.0, end / factor)
    meaning = display.plain(say(variable.meaning))
    axes.set_title(say("difference from <name>", name=cases[0].instance.name) if apart else meaning)
    sudden = [(case.instance.name, case.metrics.get("impulse", 0.0)) for case in cases]
    if not apart and variable in spec.controls and any(impulse for _, impulse in sudden):
        # an impulse has no height; an arrow stands for it, and its size is said
        for k, (_, impulse) in enumerate(sudden):
            if impulse:
                look = {"color": COLOURS[k % 6], "arrowstyle": "-|>", "shrinkA": 0.0, "shrinkB": 0.0, "linewidth": 1.8}
                ends: dict[str, Any] = {
                    "xy": (0.0, float(np.sign(impulse)) * most / measure.divisor),
                    "xytext": (0.0, 0.0),
                }
                axes.annotate("", arrowprops=look, annotation_clip=False, zorder=4.0, **ends)
                axes.update_datalim([ends["xy"]])
        axes.autoscale_view()
        of = display.unit_text(unit_of(cases, "impulse"))
        said = [
            say("<name> begins with an impulse of <size>", name=name, size=f"{decimal(f'{impulse:.3g}')} {of}".rstrip())
            for name, impulse in sudden
            if impulse
        ]
        axes.set_title("\n".join([meaning, *said]))
    axes.set_xlabel(display.labelled("$t$", unit))
    symbol = display.formula(variable.latex, variable.symbol)
    axes.set_ylabel(display.labelled(rf"$\Delta${symbol}" if apart else symbol, measure.unit))


def _until(case: Case) -> float:
    """Return the duration of a case's transition, or its whole time where that is not known, or shorter."""
    found, whole = case.metrics["transition_time"], float(case.times[-1] - case.times[0])
    return min(found, whole) if np.isfinite(found) else whole


def _totals(panels: Sequence[Axes], cases: Sequence[Case], room: float) -> None:
    """Draw bars, with their sizes beside them; ``room`` is the length of an axis in inches."""
    from satsym.analysis.classical.signals import SETTLING_BAND

    controls = cases[0].instance.model.spec.controls
    used = (c for c in controls if any(case.metrics.get(f"{c.symbol}_total") for case in cases))
    control = next(used, controls[0])
    bars = (("transition_time", say("transition time")), (f"{control.symbol}_total", say("total impulse")))
    for axes, (key, title) in zip(panels, bars, strict=True):
        unit, far = unit_of(cases, key), [1e-300]
        values, shown_unit = [case.metrics[key] for case in cases], display.unit_text(unit)
        places = np.arange(len(cases))[::-1]
        axes.barh(
            places, np.nan_to_num(values), height=0.62, color=[COLOURS[k % 6] for k in range(len(cases))], zorder=2.5
        )
        for place, value, case in zip(places, values, cases, strict=True):
            sudden = abs(case.metrics.get("impulse", 0.0)) if key != "transition_time" else 0.0
            said = f"{decimal(f'{value:.4g}')} {shown_unit}".rstrip()
            if sudden:
                part = f"{decimal(f'{sudden:.4g}')} {shown_unit}".rstrip()
                said = say("<total>, of which <sudden> as an impulse", total=said, sudden=part)
            if key == "transition_time" and case.how == "classical":
                settled = say("settled to within <share> after <time>", time=said, share=f"{SETTLING_BAND:.0%}")
                said = settled if np.isfinite(value) else say("not settled")
            # the text beside a bar is inside the axes, too
            far.append(float(np.nan_to_num(value)) / (1.0 - min(0.8, (style.length(said, 9.0) + 0.15) / room)))
            axes.text(
                np.nan_to_num(value),
                place,
                f" {said}",
                va="center",
                ha="left",
                fontsize=style.points(9.0),
                color=style.INK,
            )
        axes.set_yticks([])
        axes.set_xlim(0.0, max(far) if max(far) > 1e-300 else 1.0)
        axes.grid(axis="y", visible=False)
        axes.set_title(title)
        axes.set_xlabel(display.labelled(title, unit))


def _range(panels: Sequence[Axes], case: Case) -> None:
    """Draw largest torque and largest limited signal over damping, a line for each command."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    from satsym.analysis.comparison import ranged

    options, spec = case.instance.classical, case.instance.model.spec
    assert options is not None
    assert options.damping is not None
    dampings = options.damping * np.geomspace(*DAMPINGS, 25)
    commands = [fraction * options.command for fraction in COMMANDS]
    over = ranged(case.instance, dampings.tolist(), commands)
    control = spec.controls[0]
    name = next((n for n in case.instance.limits if n in over.peaks), spec.state_names[-1])
    watched = next(v for v in spec.states if v.symbol == name)
    shades = np.linspace(0.25, 1.0, len(commands))
    shown = (
        (over.control_peak, control, "largest <name> after the step, by damping and command"),
        (over.peaks[name], watched, "largest <name>, by damping and command"),
    )
    of_command = display.unit_text(next(v.unit for v in spec.states if v.symbol == options.follows))
    for axes, (values, variable, title) in zip(panels, shown, strict=True):
        for j, (command, shade) in enumerate(zip(commands, shades, strict=True)):
            axes.loglog(over.dampings, values[:, j], color=style.BLUE, alpha=float(shade), linewidth=1.6)
            axes.annotate(
                f"{decimal(f'{command:.3g}')} {of_command}".rstrip(),
                (over.dampings[-1], values[-1, j]),
                fontsize=style.points(8.0),
                va="center",
                xytext=(3, 0),
                textcoords="offset points",
                color=style.SOFT,
                annotation_clip=False,
            )
        limit = case.instance.limits.get(variable.symbol)
        if limit:
            ends = [over.dampings[0], over.dampings[-1]]
            axes.plot(ends, [limit, limit], color=style.ALARM, linewidth=1.2, linestyle=(0, (4, 2)))
            axes.annotate(
                say("limit of <name>", name=display.formula(variable.latex, variable.symbol)),
                (over.dampings[0], limit),
                fontsize=style.points(8.0),
                xytext=(2, 2),
                textcoords="offset points",
                color=style.ALARM,
            )
        axes.set_xlim(over.dampings[0], ROOM * over.dampings[-1])
        here = list(COMMANDS).index(1.0)
        value = float(np.interp(options.damping, over.dampings, values[:, here]))
        axes.plot([options.damping], [value], color=style.INK, **style.START)
        axes.set_title(say(title, name=display.formula(variable.latex, variable.symbol)))
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: decimal(f"{value:g}")))
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xlabel(display.labelled(say("damping"), "1/s"))
        axes.set_ylabel(display.labelled(display.formula(variable.latex, variable.symbol), variable.unit))
