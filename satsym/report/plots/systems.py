"""Pictures of an analysis, an orbit and a regulator: eigenvalues, phase portraits, responses, how far a law works."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from satsym.report import display
from satsym.report.look import SCREEN, Look
from satsym.report.plots import style
from satsym.report.results import files
from satsym.report.said import message, say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from satsym.analysis.linear.structure import Analysis
    from satsym.analysis.orbits.survey import Survey
    from satsym.analysis.regulator.feedback import Design
    from satsym.instance import Instance
    from satsym.kernels import Kernels
    from satsym.symbolic.equilibria.survey import Attitudes

Pictures: TypeAlias = dict[str, files.Content]
"""Name -> content of each file."""


def of_subject(
    given: Instance | Kernels, found: Analysis | None, orbit: Survey | None, resting: Attitudes | None, look: Look
) -> Pictures:
    """Draw what was found of an instance or a model: near rest, of its orbit, of all attitudes at rest."""
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
    from satsym.report.plots.orbits import plane

    return _drawn({"eigenvalues": lambda: plane.of_analysis(found), "phase": lambda: portrait(found)}, look)


def of_orbit(found: Survey, look: Look = SCREEN) -> Pictures:
    """Draw an orbit: ``orbit``, ``point`` (eigenvalues at its start) and, of a closed one, ``multipliers``."""
    from satsym.report.plots.orbits import conics, plane, unit_circle

    pictures: dict[str, Callable[[], Figure | None]] = {
        "orbit": lambda: conics.page(found),
        "point": lambda: plane.of_point(found),
        "multipliers": lambda: unit_circle.page(found),
    }
    return _drawn(pictures, look)


def of_attitudes(found: Attitudes, title: str, unit: str = "", look: Look = SCREEN) -> Pictures:
    """Draw the equilibria of an attitude in orbit over a parameter with a unit: ``equilibria``."""
    from satsym.report.plots import equilibria

    return _drawn({"equilibria": lambda: equilibria.page(found, title, unit)}, look)


def of_design(design: Design, look: Look = SCREEN) -> Pictures:
    """Draw a regulator: ``eigenvalues``; of an instance also ``responses``; of a nonlinear model also ``basin``.

    Where the linear and the exact response are one curve, ``differences`` shows by how much they are not.
    """
    from satsym.report.plots import responses
    from satsym.report.plots.orbits import plane

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
"""Points along each axis of the grid on which directions are computed."""


def portrait(found: Analysis) -> Figure | None:
    """Streamlines, and the straight motions along real eigenvectors; nothing for other than two states."""
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
