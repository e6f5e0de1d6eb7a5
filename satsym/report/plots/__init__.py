"""Pictures of a solution or a flight, for any model: PNG files, and on request PDF.

matplotlib is imported when the first picture is drawn, without pyplot.
"""

from __future__ import annotations

from collections.abc import Sequence

from satsym.report.results import files
from satsym.solution import Flight, Solution


def pictures(result: Solution | Flight, formats: Sequence[str] = ("png",)) -> dict[str, files.Content]:
    """Draw a result.

    Parameters
    ----------
    result
        Also one that did not converge, as far as there is something to draw.
    formats
        Of ``png`` and ``pdf``.

    Returns
    -------
    dict
        Name -> content of each file, the overview first. A picture that would show nothing is left out: ``orbit`` where
        the model has no position vector, ``controls`` where a flight has none, ``costates`` for a flight,
        ``invariants`` where the model has none, ``convergence`` for fewer than three iterations, and all but that where
        there is no trajectory.
    """
    from satsym.report.plots import pages, style
    from satsym.report.plots.convergence import convergence
    from satsym.report.plots.overview import overview
    from satsym.report.plots.scene import Scene

    pages_of = (overview, pages.orbit, pages.states, pages.controls, pages.costates, pages.invariants, convergence)
    scene = Scene.of(result)
    drawn: dict[str, files.Content] = {}
    with style.applied():
        for picture in pages_of:
            page = picture(scene)
            if page is not None:
                drawn |= {f"{picture.__name__}.{kind}": files.binary(style.rendered(page, kind)) for kind in formats}
    return drawn
