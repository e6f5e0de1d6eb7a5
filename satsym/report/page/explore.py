"""The interactive part of a page: sliders over time and over answers, with plotly inside the page."""

from __future__ import annotations

import json
from collections.abc import Sequence
from importlib.resources import files

from satsym.report.extra import library
from satsym.report.html.markup import Markup, joined, tag
from satsym.report.page.explored import Answer, data
from satsym.report.said import decimal, say
from satsym.report.texts import Texts

WORDS = {
    "path": "solution",
    "reference": "reference",
    "free": "uncontrolled",
    "other": "target orbit",
    "moving": "target",
    "burns": "burn",
    "target": "final condition",
    "passed": "point on the way",
    "inadmissible": "inadmissible",
    "origin": "origin",
    "body_called": "body",
    "torque": "torque",
    "fixed": "fixed axes",
    "magnified": "angles <times> times as large",
    "play": "Play",
    "pause": "Pause",
}
"""What the script says, in English."""


def explore(answers: Sequence[Answer], texts: Texts) -> Markup:
    """The controls, empty places for pictures, and a table of values; all of it hidden where scripts do not run.

    Parameters
    ----------
    answers
        One, or those of a study, which have a slider of their own.
    """
    several = len(answers) > 1

    def slider(key: str, name: str, last: int) -> Markup:
        return joined(
            tag("label", texts.get("page", name), for_=key),
            tag("input", type="range", id=key, min="0", max=str(last), value="0", step="1" if last < 1000 else "any"),
        )

    controls = [
        tag("button", say(WORDS["play"]), type="button", id="explore-play", aria_pressed="false"),
        slider("explore-time", "time", 1000),
        tag("output", id="explore-stated", for_="explore-time"),
        *([slider("explore-answer", "which", len(answers) - 1)] if several else []),
        tag("output", id="explore-cost"),
    ]
    heads = [
        tag("th", texts.get(*key), scope="col")
        for key in (("words", "symbol"), ("page", "value"), ("words", "meaning"))
    ]
    table = tag(
        "table",
        tag("caption", texts.get("page", "reading")),
        tag("thead", tag("tr", *heads)),
        tag("tbody"),
        class_="facts",
    )
    return tag(
        "div",
        tag("p", texts.get("page", "explore_about")),
        tag("div", *controls, class_="controls"),
        tag("div", id="explore-scenes"),
        tag("div", id="explore-panels"),
        tag("div", table, class_="wide", id="explore-reading", tabindex="0"),
        class_="explorer",
        hidden=True,
    )


def scripts(answers: Sequence[Answer]) -> Markup:
    """The data, the library and the script, for the end of a page.

    Raises
    ------
    BadInput
        If plotly is not installed.
    """
    offline = library("plotly.offline", "plotly", "interactive")
    words = {key: say(text) for key, text in WORDS.items()}
    content = json.dumps(
        data(answers) | {"words": words, "decimal": decimal(".")}, ensure_ascii=False, separators=(",", ":")
    )
    own = files("satsym.report").joinpath("page", "explore.js").read_text(encoding="utf-8")
    return joined(
        tag("script", Markup(content.replace("<", "\\u003c")), type="application/json", id="explore-data"),
        tag("script", Markup(offline.get_plotlyjs())),
        tag("script", Markup(own)),
    )
