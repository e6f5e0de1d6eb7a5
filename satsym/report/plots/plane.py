"""Eigenvalues in the complex plane, of the open and the closed loop, and at a point of an orbit."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.report import display
from satsym.report.display import number
from satsym.report.plots import legend, style
from satsym.report.said import decimal, message, say
from satsym.spec import ProblemSpec

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from satsym.analysis.linear.spectrum import Eigenvalue
    from satsym.analysis.regulator.feedback import Design
    from satsym.analysis.subject import Analysis, Survey


OPEN: dict[str, Any] = {
    "color": style.BLUE,
    "marker": "o",
    "markersize": 10.0,
    "markerfacecolor": "none",
    "markeredgewidth": 1.6,
    "linestyle": "none",
    "zorder": 3.0,
    "clip_on": False,
}
CLOSED: dict[str, Any] = {
    "color": style.VERMILION,
    "marker": "X",
    "markersize": 9.0,
    "markeredgecolor": "white",
    "markeredgewidth": 0.7,
    "linestyle": "none",
    "zorder": 3.5,
    "clip_on": False,
}
EXACT: dict[str, Any] = {
    "color": style.VERMILION,
    "marker": "+",
    "markersize": 14.0,
    "linestyle": "none",
    "zorder": 3.5,
}
MARGIN = 1.25
"""Half the width of the axes, relative to the farthest eigenvalue."""
SIDE = 6.6
"""Side of the page, in inches."""
FURTHEST_ON_A_SCALE, NOUGHT = 100.0, 1e-8
"""Ratio of the largest to the smallest eigenvalue above which the scale is logarithmic, and threshold of zero.

The threshold is the fraction of the largest eigenvalue below which others count as zero.
"""
MARKED = 3
"""Largest number of labelled decades on each side of zero."""


def of_analysis(found: Analysis) -> Figure:
    """Draw the eigenvalues of a model, with their multiplicities."""
    spec = found.about.model.spec
    page = style.titled(spec.title, SIDE, SIDE)
    axes = page.subplots()
    axes.set_title(say("eigenvalues: <verdict>", verdict=message(found.stability.verdict or "undecided")))
    factor = _plane(axes, spec, [each.value for each in found.eigenvalues])
    _open_loop(axes, found.eigenvalues, factor)
    return page


def of_design(design: Design) -> Figure:
    """Draw the eigenvalues of the open and the closed loop."""
    page = style.titled(design.title, SIDE, SIDE + 0.3)
    axes = page.subplots()
    axes.set_title(say("eigenvalues"))
    loops(axes, design)
    entries = [
        (legend.line(**OPEN), say("uncontrolled")),
        (legend.line(**CLOSED), say("with <law>", law="$u = -K\\,x$")),
    ]
    legend.below(page, entries)
    return page


def loops(axes: Axes, design: Design, with_notes: bool = True) -> None:
    """Draw the eigenvalues of the open and the closed loop, with notes on multiple ones where there is room."""
    from satsym.analysis.linear.spectrum import spectrum

    before, after = spectrum(design.about.system.A), design.regulator.eigenvalues
    factor = _plane(axes, design.about.model.spec, [*(each.value for each in before), *after.tolist()])
    _open_loop(axes, before, factor, with_notes)
    axes.plot(after.real * factor, after.imag * factor, **CLOSED)


def of_point(found: Survey) -> Figure:
    """Draw the eigenvalues at the start of an orbit, with their closed form and the verdict of the sign rule."""
    case, point = found.case, found.point
    page = style.titled(case.title or case.name, SIDE, SIDE + 0.5)
    axes = page.subplots()
    says = 'the rule calls every orbit "<verdict>", although no point of an orbit is an equilibrium'
    axes.set_title(say(says, verdict=message(point.rule_verdict)))
    factor = _plane(axes, case.model.spec, point.closed_form.tolist(), say('the rule: "stable"'))
    axes.plot(point.eigenvalues.real * factor, point.eigenvalues.imag * factor, **OPEN)
    axes.plot(point.closed_form.real * factor, point.closed_form.imag * factor, **EXACT)
    for value in (point.closed_form[1], point.closed_form[3]):
        axes.annotate(
            say("multiplicity <n>", n=2),
            (0.0, value.imag * factor),
            (12.0, -3.0),
            textcoords="offset points",
            color=style.SOFT,
        )
    closed_form = say(r"$\pm\sqrt{2\mu/r^3}$ and twice $\pm i\sqrt{\mu/r^3}$")
    legend.below(page, [(legend.line(**OPEN), say("computed")), (legend.line(**EXACT), closed_form)])
    return page


def _plane(axes: Axes, spec: ProblemSpec, values: list[complex], left: str = "") -> float:
    """Draw the plane with its left half named; return the model's unit of time in that of the axes."""
    furthest = float(np.abs(values).max()) or 1.0
    units = (v.unit for v in (*spec.states, *spec.controls, *spec.parameters))
    factor, unit = display.time_scale(units, 2.0 * np.pi / furthest)
    reach = MARGIN * furthest * factor
    sizes = np.abs(values)[np.abs(values) > NOUGHT * furthest]
    if furthest > FURTHEST_ON_A_SCALE * min(sizes, default=furthest):
        reach = _decades(axes, float(sizes.min()) * factor, furthest * factor)
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    axes.set_aspect("equal")
    axes.axvspan(-reach, 0.0, color=style.GREEN, alpha=0.07, linewidth=0.0, zorder=1.0)
    axes.axvline(0.0, color=style.INK, linewidth=1.1, zorder=2.0)
    axes.axhline(0.0, color=style.GREY, linewidth=0.8, zorder=1.9)
    place: dict[str, Any] = {"transform": axes.transAxes, "fontsize": style.points(10.0)}
    axes.text(0.015, 0.015, left or say("stable"), color=style.GREEN, **place)
    per_time = "" if unit == "1" else f"1/{unit}"
    axes.set_xlabel(display.labelled(r"$\mathrm{Re}\,s$", per_time or "1"))
    axes.set_ylabel(display.labelled(r"$\mathrm{Im}\,s$", per_time or "1"))
    return factor


def _decades(axes: Axes, nearest: float, furthest: float) -> float:
    """Scale both axes by decades from the nearest eigenvalue on, so that none overlap; return the range."""
    first, last = (int(np.floor(np.log10(size))) for size in (nearest, furthest))
    shown = range(last, first - 1, -max(1, -(-(last - first) // MARKED)))
    ticks = [sign * 10.0**power for sign in (-1.0, 1.0) for power in shown]
    names = [f"${'-' if tick < 0.0 else ''}10^{{{round(np.log10(abs(tick)))}}}$" for tick in ticks]
    for axis, scaled in ((axes.xaxis, axes.set_xscale), (axes.yaxis, axes.set_yscale)):
        scaled("symlog", linthresh=10.0**first)
        axis.set_ticks([*ticks, 0.0], [*names, "0"])
        axis.set_ticks([], minor=True)
    said = say("linear within <limits>", limits=rf"$\pm 10^{{{first}}}$")
    axes.text(0.985, 0.015, said, transform=axes.transAxes, ha="right", color=style.SOFT, fontsize=style.points(9.0))
    return 10.0 * furthest


def _open_loop(axes: Axes, found: Iterable[Eigenvalue], factor: float, with_notes: bool = True) -> None:
    """Draw open-loop eigenvalues as circles, with the sizes of Jordan blocks beside multiple ones."""
    for each in found:
        at = (each.value.real * factor, each.value.imag * factor)
        axes.plot([at[0]], [at[1]], **OPEN)
        if with_notes and each.algebraic > 1:
            blocks = "Jordan block <sizes>" if each.geometric == 1 else "Jordan blocks <sizes>"
            sizes = say(blocks, sizes=" + ".join(map(str, each.blocks)))
            said = f"{say('multiplicity <n>', n=each.algebraic)}, {sizes}"
            axes.annotate(
                said, at, (9.0, 8.0), textcoords="offset points", fontsize=style.points(9.0), color=style.SOFT
            )


COMPUTED: dict[str, Any] = {
    "color": style.BLUE,
    "marker": "o",
    "markersize": 8.0,
    "markerfacecolor": "none",
    "markeredgewidth": 1.5,
    "linestyle": "none",
    "zorder": 3.5,
}
ONE: dict[str, Any] = {
    "color": style.VERMILION,
    "marker": "+",
    "markersize": 13.0,
    "linestyle": "none",
    "zorder": 3.6,
}
CIRCLE: dict[str, Any] = {"color": style.INK, "linewidth": 1.1, "zorder": 2.0}
SCATTER: dict[str, Any] = {"color": style.GREEN, "linewidth": 1.2, "linestyle": (0, (4, 3)), "zorder": 2.2}
ROOM = 1.35
"""Half the width of a panel, relative to the circle in it."""
TURN = np.linspace(0.0, 2.0 * np.pi, 721)


def of_multipliers(found: Survey) -> Figure | None:
    """Draw the unit circle, and beside it the neighbourhood of 1; nothing without multipliers."""
    floquet = found.floquet
    if floquet.multipliers is None or floquet.scatter is None or floquet.expected_scatter is None:
        return None
    across = style.across(2)
    sheet = style.titled(
        found.case.title or found.case.name, style.WIDTH, 0.5 * style.WIDTH * (2 if across == 1 else 1) + 0.6
    )
    whole, near = sheet.subplots(2 // across, across)
    _whole(whole, floquet.multipliers)
    _near(near, floquet.multipliers, floquet.expected_scatter, ROOM * max(floquet.scatter, floquet.expected_scatter))
    entries = [
        (legend.line(**COMPUTED), say("computed multipliers")),
        (legend.line(**ONE), say("exact: 1, multiplicity 6, Jordan blocks 2 + 1 + 1 + 1 + 1")),
        (legend.line(**CIRCLE), say("unit circle")),
        (legend.line(**SCATTER), say("expected scatter")),
    ]
    legend.below(sheet, entries)
    return sheet


def _whole(axes: Axes, multipliers: Any) -> None:
    furthest = ROOM * max(1.0, float(np.abs(multipliers).max()))
    _square(axes, furthest)
    axes.plot(np.cos(TURN), np.sin(TURN), **CIRCLE)
    axes.plot(multipliers.real, multipliers.imag, **COMPUTED)
    axes.plot([1.0], [0.0], **ONE)
    axes.set_title(say("Floquet multipliers"))
    axes.set_xlabel(r"$\mathrm{Re}\,\mu$")
    axes.set_ylabel(r"$\mathrm{Im}\,\mu$")


def _near(axes: Axes, multipliers: Any, expected: float, reach: float) -> None:
    """Draw distances from 1; the unit circle is a straight line at this scale unless errors are large."""
    _square(axes, reach)
    # 1 - cos without cancellation; the part of the circle within reach
    angle = np.linspace(-1.0, 1.0, 401) * min(np.pi, 2.0 * reach)
    axes.plot(-2.0 * np.sin(0.5 * angle) ** 2, np.sin(angle), **CIRCLE)
    axes.plot(expected * np.cos(TURN), expected * np.sin(TURN), **SCATTER)
    away = multipliers - 1.0
    axes.plot(away.real, away.imag, **COMPUTED)
    axes.plot([0.0], [0.0], **ONE)
    axes.locator_params(axis="x", nbins=2)  # each tick carries its power of ten
    furthest, likely = (decimal(number(value, 2)) for value in (float(np.abs(away).max()), expected))
    axes.set_title(say("near 1: at most <furthest> from 1 (<likely> expected)", furthest=furthest, likely=likely))
    axes.set_xlabel(r"$\mathrm{Re}\,\mu - 1$")
    axes.set_ylabel(r"$\mathrm{Im}\,\mu$")


def _square(axes: Axes, half: float) -> None:
    axes.set_aspect("equal")
    axes.set_xlim(-half, half)
    axes.set_ylim(-half, half)
    axes.axhline(0.0, color=style.GREY, linewidth=0.8, zorder=1.9)
