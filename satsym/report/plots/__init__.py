"""Pictures of a solution or a simulation, for any model: PNG files, and on request PDF and SVG.

matplotlib is imported when the first picture is drawn, without pyplot.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from satsym.report.look import SCREEN, Look
from satsym.report.results import files
from satsym.solution import Simulation, Solution

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def pictures(result: Solution | Simulation, look: Look = SCREEN) -> dict[str, files.Content]:
    """Draw a result.

    Parameters
    ----------
    result
        Also one that did not converge, as far as there is something to draw.
    look
        As which files, and whether with titles.

    Returns
    -------
    dict
        Name -> content of each file, the overview first. A picture that would show nothing is left out: ``orbit`` where
        the model has no position vector, ``path`` where no states are its components or there is an ``orbit``,
        ``attitude`` where no states are a quaternion or there is either of these,
        ``phase`` where there is either of these or no state with its rate, ``controls`` where a simulation has none,
        ``constraints`` where the model has no path constraints, ``costates`` for a simulation, ``invariants`` where
        the model has none, ``convergence`` for fewer than three iterations, and all but that where there is no
        trajectory.
    """
    from satsym.report.plots import style

    drawn: dict[str, files.Content] = {}
    with style.applied(look):
        for name, page in _pages(result):
            drawn |= style.contents(name, page)
    return drawn


def overview(result: Solution | Simulation, look: Look = SCREEN) -> files.Content | None:
    """Draw the overview alone, in the first format of a look; nothing without a trajectory."""
    from satsym.report.plots import pages, style
    from satsym.report.plots.scene import Scene

    with style.applied(look):
        page = pages.overview(Scene.of(result))
        return None if page is None else next(iter(style.contents("overview", page).values()))


def figures(result: Solution | Simulation, look: Look = SCREEN) -> dict[str, Figure]:
    """Return the pictures as figures of matplotlib, by name, for people who go on drawing."""
    from satsym.report.plots import style

    with style.applied(look):
        return {name: style.finished(page) for name, page in _pages(result)}


def _pages(result: Solution | Simulation) -> Iterator[tuple[str, Figure]]:
    from satsym.report.plots import pages
    from satsym.report.plots.pages import convergence
    from satsym.report.plots.scene import Scene

    scene = Scene.of(result)
    planes, over_time = (
        (pages.orbit, pages.path, pages.attitude, pages.phase),
        (pages.states, pages.controls, pages.constraints),
    )
    motion = (*planes, *over_time, pages.costates, pages.invariants)
    for picture in (pages.overview, *motion, convergence):
        page = picture(scene)
        if page is not None:
            yield picture.__name__, page
