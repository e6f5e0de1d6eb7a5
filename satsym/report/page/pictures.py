"""Pictures of a result inside a page: SVG whose names do not meet those of another picture."""

from __future__ import annotations

import io
import re

from satsym.report import plots
from satsym.report.html.markup import Markup, tag
from satsym.report.look import Look
from satsym.report.plots import style
from satsym.report.texts import Texts
from satsym.solution import Solution

_NAMED = re.compile(r'(\bid="|href="#|url\(#)')
_BEFORE = re.compile(r"^.*?(?=<svg)", re.DOTALL)
_ABOUT = re.compile(r"<metadata>.*?</metadata>", re.DOTALL)
_COLOURS = {
    **dict.fromkeys((style.INK.lower(), "#000000"), "ink"),
    **dict.fromkeys((style.SOFT.lower(), style.GREY.lower(), "#777777", "#9a9a9a"), "faint"),
    **dict.fromkeys((style.FAINT.lower(), "#c4c4c4", "#c8c8c8"), "line"),
    "#ffffff": "card",
    **{
        getattr(style, name).lower(): name.lower()
        for name in ("BLUE", "VERMILION", "GREEN", "PURPLE", "ALARM", "GLOBE", "RIM")
    },
}
"""What each colour of a picture is on a page, where it depends on whether that is light or dark."""
_COLOUR = re.compile("|".join(_COLOURS))
OVERVIEW = "overview"
"""Shows what the others show, too."""


def pictures(solution: Solution, texts: Texts) -> list[Markup]:
    """A figure for each picture but the overview."""
    found = []
    for file, content in plots.pictures(solution, Look(("svg",), titled=False)).items():
        name = file.removesuffix(".svg")
        if name == OVERVIEW:
            continue
        stream = io.BytesIO()
        content(stream)
        said = texts.get("pictures", name)
        drawing = _inline(stream.getvalue().decode("utf-8"), name, said)
        found.append(tag("figure", drawing, tag("figcaption", said), class_="picture"))
    return found


def themed(svg: str) -> str:
    """The element ``svg`` alone, its colours being those that the style sheets of a page name."""
    body = _ABOUT.sub("", _BEFORE.sub("", svg)).strip()
    return _COLOUR.sub(lambda found: f"var(--{_COLOURS[found[0]]})", body)


def _inline(svg: str, name: str, said: str) -> Markup:
    """The element alone, with names of its own, and with words for those who do not see it."""
    body = _NAMED.sub(rf"\g<1>{name}-", themed(svg))
    return Markup(body.replace("<svg ", str(tag("svg", role="img", aria_label=said))[: -len("></svg>")] + " ", 1))
