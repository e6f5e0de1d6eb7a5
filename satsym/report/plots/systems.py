"""Pictures of an analysis, an orbit and a regulator: eigenvalues, phase portraits, responses, region of attraction."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from satsym.report import display
from satsym.report.look import SCREEN, Look
from satsym.report.plots import legend, style
from satsym.report.results import files
from satsym.report.said import message, say

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from satsym.analysis.regulator.feedback import Design
    from satsym.analysis.subject import Analysis, Survey
    from satsym.instance import Instance
    from satsym.kernels import Kernels
    from satsym.symbolic.equilibria.momenta import Attitudes


Pictures: TypeAlias = dict[str, files.Content]
"""Name of a picture -> content of its file."""


def of_subject(
    given: Instance | Kernels, found: Analysis | None, orbit: Survey | None, resting: Attitudes | None, look: Look
) -> Pictures:
    """Draw the results on an instance or a model: near rest, of its orbit, of all attitudes at rest."""
    from satsym.instance import Instance

    pictures = (of_analysis(found, look) if found else {}) | (of_orbit(orbit, look) if orbit else {})
    if resting is None:
        return pictures
    spec = given.model.spec if isinstance(given, Instance) else given.spec
    title = (given.title if isinstance(given, Instance) else "") or spec.title
    unit = next(v.unit for v in spec.parameters if v.symbol == resting.parameter)
    return pictures | of_attitudes(resting, title, unit, look)


def of_analysis(found: Analysis, look: Look = SCREEN) -> Pictures:
    """Draw an analysis: ``eigenvalues``, and ``phase`` where there are two states.

    Parameters
    ----------
    look
        As which files, and whether with titles.

    Returns
    -------
    dict
        Name -> content of each file.
    """
    from satsym.report.plots import plane

    return _drawn({"eigenvalues": lambda: plane.of_analysis(found), "phase": lambda: portrait(found)}, look)


def of_orbit(found: Survey, look: Look = SCREEN) -> Pictures:
    """Draw an orbit: ``orbit``, ``point`` (eigenvalues at its start) and, of a closed one, ``multipliers``."""
    from satsym.report.plots import plane
    from satsym.report.plots.space import conics

    pictures: dict[str, Callable[[], Figure | None]] = {
        "orbit": lambda: conics.page(found),
        "point": lambda: plane.of_point(found),
        "multipliers": lambda: plane.of_multipliers(found),
    }
    return _drawn(pictures, look)


def of_attitudes(found: Attitudes, title: str, unit: str = "", look: Look = SCREEN) -> Pictures:
    """Draw the equilibria of an attitude in orbit over a parameter with a unit: ``equilibria``."""
    return _drawn({"equilibria": lambda: page(found, title, unit)}, look)


def of_design(design: Design, look: Look = SCREEN) -> Pictures:
    """Draw a regulator: ``eigenvalues``; of an instance also ``responses``; of a nonlinear model also ``basin``.

    Where the linear and the exact response coincide, ``differences`` shows how they differ.
    """
    from satsym.report.plots import plane, responses

    pictures: dict[str, Callable[[], Figure | None]] = {"eigenvalues": lambda: plane.of_design(design)}
    if design.instance is not None and design.instance.tf is not None:
        case = design.instance
        seen = cache(lambda: responses.Responded.of(design, case))
        pictures["responses"] = lambda: responses.page(design, seen())
        pictures["differences"] = lambda: responses.differences(design, seen())
        pictures["basin"] = lambda: responses.reach(design, case)
    return _drawn(pictures, look)


def _drawn(pictures: Mapping[str, Callable[[], Figure | None]], look: Look) -> Pictures:
    drawn: Pictures = {}
    with style.applied(look):
        for name, picture in pictures.items():
            page = picture()
            if page is not None:
                drawn |= style.contents(name, page)
    return drawn


POINTS = 41
"""Number of points along each axis of the grid of directions."""


def portrait(found: Analysis) -> Figure | None:
    """Draw streamlines, and straight motions along real eigenvectors; nothing for other than two states."""
    A, states = found.about.system.A, found.about.model.spec.states
    if len(A) != 2 or not found.about.constant:
        return None
    page = style.titled(found.about.model.spec.title, 5.6, 5.6)
    axes = page.subplots()
    axes.set_title(say("phase portrait: <verdict>", verdict=message(found.stability.verdict or "undecided")))
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


LOOKS: dict[str, dict[str, Any]] = {
    "stable": {"color": style.GREEN, "marker": "o", "markersize": 4.5},
    "gyroscopically stabilised": {"color": style.BLUE, "marker": "s", "markersize": 3.8},
    "unstable": {"color": style.VERMILION, "marker": ".", "markersize": 3.0},
    "degenerate": {"color": style.INK, "marker": "x", "markersize": 5.0},
}
DOTTED: dict[str, Any] = {"color": style.INK, "linewidth": 0.6, "linestyle": (0, (2, 3))}


def page(found: Attitudes, title: str, unit: str = "") -> Figure | None:
    """Draw numbers of equilibria above, angles between body and orbit below; nothing where they are not finite.

    Parameters
    ----------
    unit
        Of the parameter over which they are followed.
    """
    if found.followed is None:
        return None
    values, sets = found.followed.values, found.followed.equilibria
    sheet = style.titled(title, style.WIDTH, 0.9 * style.WIDTH)
    above, below = sheet.subplots(2, 1, sharex=True, height_ratios=(1, 2))
    edges = [float(values[0]), *((c.below + c.above) / 2 for c in found.followed.changes), float(values[-1])]
    counts = [len(sets[0]), *(c.counts[1] for c in found.followed.changes)]
    above.stairs(counts, edges, baseline=None, color=style.INK, linewidth=1.4)
    above.set_ylabel(textwrap.fill(say("number of equilibria"), 20))
    above.set_ylim(0, 1.08 * max(counts))
    above.set_yticks(sorted({0, *counts}))
    seen = angles(below, found, unit)
    for change in found.followed.changes:
        above.axvline((change.below + change.above) / 2, **DOTTED)
    legend.below(sheet, seen)
    return sheet


def angles(axes: Axes, found: Attitudes, unit: str = "") -> list[tuple[Any, str]]:
    """Draw the angle between the y of body and orbit over the parameter, and return what a legend needs."""
    if found.followed is None:
        return []
    seen = []
    for kind, look in LOOKS.items():
        points = [
            (value, np.degrees(np.arccos(np.clip(each.cosines[1, 1], -1.0, 1.0))))
            for value, group in zip(found.followed.values, found.followed.equilibria, strict=True)
            for each in group
            if each.kind.value == kind
        ]
        if points:
            axes.plot(*np.array(points).T, linestyle="none", **look)
            seen.append((legend.line(linestyle="none", **look), message(kind)))
    for change in found.followed.changes:
        axes.axvline((change.below + change.above) / 2, **DOTTED)
    if found.followed.changes:
        seen.append((legend.line(**DOTTED), say("number or kinds of equilibria change")))
    axes.set_ylabel(say("angle from orbit y to body y [deg]"))
    axes.set_xlabel(display.labelled(found.parameter, unit))
    axes.set_yticks(range(0, 181, 30))
    return seen
