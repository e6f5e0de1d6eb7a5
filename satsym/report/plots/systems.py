"""Pictures of an analysis, an orbit and a regulator: eigenvalues, phase portraits, responses, how far a law works."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from satsym.report import files
from satsym.report.plots import style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from satsym.analysis.feedback import Design
    from satsym.analysis.orbits.survey import Survey
    from satsym.analysis.structure import Analysis


def save_analysis(found: Analysis, folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Draw an analysis: ``eigenvalues``, and ``phase`` where there are two states.

    Parameters
    ----------
    folder
        Made if it is not there.
    formats
        Of ``png`` and ``pdf``.

    Raises
    ------
    BadInput
        If the folder cannot be written to.
    """
    from satsym.report.plots import phase, plane

    return _save(
        {"eigenvalues": lambda: plane.of_analysis(found), "phase": lambda: phase.portrait(found)}, folder, formats
    )


def save_orbit(found: Survey, folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Draw an orbit: ``orbit``, ``point`` (eigenvalues at its start) and, of a closed one, ``multipliers``."""
    from satsym.report.plots import conics, plane, unit_circle

    pictures: dict[str, Callable[[], Figure | None]] = {
        "orbit": lambda: conics.page(found),
        "point": lambda: plane.of_point(found),
        "multipliers": lambda: unit_circle.page(found),
    }
    return _save(pictures, folder, formats)


def save_design(design: Design, folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Draw a regulator: ``eigenvalues``; of an instance also ``responses``; of a nonlinear model also ``basin``."""
    from satsym.report.plots import plane, responses

    pictures: dict[str, Callable[[], Figure | None]] = {"eigenvalues": lambda: plane.of_design(design)}
    if design.instance is not None and design.instance.tf is not None:
        case = design.instance
        pictures["responses"] = lambda: responses.page(design, case)
        pictures["basin"] = lambda: responses.reach(design, case)
    return _save(pictures, folder, formats)


def _save(pictures: Mapping[str, Callable[[], Figure | None]], folder: Path, formats: Sequence[str]) -> list[Path]:
    drawn: dict[str, files.Content] = {}
    with style.applied():
        for name, picture in pictures.items():
            page = picture()
            if page is not None:
                drawn |= {f"{name}.{kind}": files.binary(style.rendered(page, kind)) for kind in formats}
    return files.write(folder, drawn) if drawn else []
