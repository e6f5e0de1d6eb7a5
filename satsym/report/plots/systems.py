"""Pictures of an analysis, an orbit and a regulator: eigenvalues, phase portraits, responses, how far a law works."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

from satsym.report.plots import style
from satsym.report.results import files

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from satsym.analysis.linear.structure import Analysis
    from satsym.analysis.orbits.survey import Survey
    from satsym.analysis.regulator.feedback import Design

Pictures: TypeAlias = dict[str, files.Content]
"""Name -> content of each file."""


def of_analysis(found: Analysis, formats: Sequence[str] = ("png",)) -> Pictures:
    """Draw an analysis: ``eigenvalues``, and ``phase`` where there are two states.

    Parameters
    ----------
    formats
        Of ``png`` and ``pdf``.

    Returns
    -------
    dict
        Name -> content of each file.
    """
    from satsym.report.plots import phase
    from satsym.report.plots.orbits import plane

    return _drawn({"eigenvalues": lambda: plane.of_analysis(found), "phase": lambda: phase.portrait(found)}, formats)


def of_orbit(found: Survey, formats: Sequence[str] = ("png",)) -> Pictures:
    """Draw an orbit: ``orbit``, ``point`` (eigenvalues at its start) and, of a closed one, ``multipliers``."""
    from satsym.report.plots.orbits import conics, plane, unit_circle

    pictures: dict[str, Callable[[], Figure | None]] = {
        "orbit": lambda: conics.page(found),
        "point": lambda: plane.of_point(found),
        "multipliers": lambda: unit_circle.page(found),
    }
    return _drawn(pictures, formats)


def of_design(design: Design, formats: Sequence[str] = ("png",)) -> Pictures:
    """Draw a regulator: ``eigenvalues``; of an instance also ``responses``; of a nonlinear model also ``basin``."""
    from satsym.report.plots import responses
    from satsym.report.plots.orbits import plane

    pictures: dict[str, Callable[[], Figure | None]] = {"eigenvalues": lambda: plane.of_design(design)}
    if design.instance is not None and design.instance.tf is not None:
        case = design.instance
        pictures["responses"] = lambda: responses.page(design, case)
        pictures["basin"] = lambda: responses.reach(design, case)
    return _drawn(pictures, formats)


def _drawn(pictures: Mapping[str, Callable[[], Figure | None]], formats: Sequence[str]) -> Pictures:
    drawn: Pictures = {}
    with style.applied():
        for name, picture in pictures.items():
            page = picture()
            if page is not None:
                drawn |= {f"{name}.{kind}": files.binary(style.rendered(page, kind)) for kind in formats}
    return drawn
