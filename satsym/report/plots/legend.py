"""One legend for a whole page, with the kinds of lines that occur on it."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from satsym.report.plots import style
from satsym.report.plots.reading import read
from satsym.report.plots.scene import Scene
from satsym.report.plots.series import PASSED, REACHED, SWITCHED, Series
from satsym.report.said import say

if TYPE_CHECKING:
    from matplotlib.figure import Figure, SubFigure

HANDLE, CHARACTER = 0.62, 0.08
"""Width in inches on a screen of the sample of an entry, and of an average character of its label."""
PER_INCH = 0.71
"""Number of entries side by side for each inch of a page."""
Entry = tuple[Any, str]


def motion(scene: Scene, colour: str) -> list[Entry]:
    """Return entries for the path itself, the reference and the uncontrolled motion."""
    found = [(line(color=colour, **style.MAIN), scene.name)]
    if scene.reference is not None:
        found.append((line(**style.REFERENCE), say("reference")))
    if scene.free is not None:
        found.append((line(**style.FREE), say("uncontrolled")))
    return found


def on_axes(quantities: Iterable[Series], colour: str) -> list[Entry]:
    """Return entries for references, required ends, bounds and the time spent at bounds."""
    from matplotlib.patches import Patch

    quantities, found = list(quantities), []
    if any(each.deviation for each in read(quantities)):
        found.append((line(linestyle="none"), say(r"$\Delta$: deviation from the reference")))
    if any(q.target is not None for q in quantities):
        found.append((line(**style.TARGET), say("final condition")))
    if any(q.active is not None or q.forbidden for q in quantities):
        found.append((Patch(**style.FORBIDDEN), say("inadmissible")))
    shaded = [q for q in quantities if q.active is not None and q.active.any()]
    for limited, said in ((False, say("saturated")), (True, say("constraint active"))):
        if any((q.said == REACHED) is limited for q in shaded):
            found.append((Patch(color=colour, alpha=style.SHADE, linewidth=0.0), said))
    found += [(line(color=shade, **style.SWITCHING), text) for shade, text in _marked(quantities, colour)]
    return found


def _marked(quantities: Iterable[Series], colour: str) -> list[tuple[str, str]]:
    """Return entries for horizontal lines, which have the colours of their curves."""
    meant = {q.said for q in quantities if q.switching}
    return [
        *([(style.STATE, say("waypoint"))] if PASSED in meant else []),
        *([(colour, say("switching time"))] if SWITCHED in meant else []),
    ]


def below(page: Figure, entries: list[Entry], part: SubFigure | None = None, share: float = 1.0) -> None:
    """Put the legend below the axes; a single entry is left out, since the page says as much.

    Parameters
    ----------
    part
        The part of the page below whose axes it stands, if not below those of the whole page.
    share
        Width of that part as a fraction of the width of the page.
    """
    entries = list({label: (handle, label) for handle, label in entries}.values())
    if len(entries) > 1:
        handles, labels = zip(*entries, strict=True)
        width = style.on_screen(page) * share
        most = -(-len(entries) // math.ceil(len(entries) / (PER_INCH * width)))
        across = next((n for n in range(most, 1, -1) if _width(labels, n) <= width), 1)
        room = int((width - HANDLE) / CHARACTER)
        shown = [textwrap.fill(label, room) if across == 1 else label for label in labels]
        (part or page).legend(handles, shown, loc="outside lower center", ncols=across)


def _width(labels: Sequence[str], across: int) -> float:
    """Return the width of entries in a number of columns, filled one after the other, in inches on a screen."""
    rows = -(-len(labels) // across)
    columns = (labels[k : k + rows] for k in range(0, len(labels), rows))
    return sum(HANDLE + CHARACTER * max(map(_length, column)) for column in columns)


def _length(label: str) -> int:
    """Count the visible characters of a label; a sign in a formula counts as one."""
    return len(re.sub(r"\\[a-zA-Z]+|[${}^_\\]", "", label))


def line(**look: Any) -> Any:
    """Return the sample of a line or a marker in a legend."""
    from matplotlib.lines import Line2D

    return Line2D([], [], **(look | {"clip_on": True}))
