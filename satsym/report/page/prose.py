"""Sentences of derivations, which are LaTeX, as HTML: formulas as MathML, numbers of equations as links."""

from __future__ import annotations

import re
from collections.abc import Mapping

from satsym.report.html.markup import Markup, joined, tag
from satsym.report.html.mathml import math

_PIECES = re.compile(r"\$([^$]+)\$|\\\[(.+?)\\\]|\\(?:eq)?ref\{([^{}]*)\}", re.DOTALL)


def prose(text: str, numbers: Mapping[str, str]) -> Markup:
    """A sentence.

    Parameters
    ----------
    text
        Of :mod:`satsym.report.texts`, filled in.
    numbers
        Label of an equation or step -> what it is called where it is referred to.
    """
    found, end = [], 0
    for match in _PIECES.finditer(text):
        found.append(joined(_plain(text[end : match.start()])))
        inline, display, label = match.groups()
        if label is not None:
            found.append(tag("a", numbers[label], href=f"#{label}") if label in numbers else Markup(""))
        else:
            found.append(scrolled(math(display, block=True)) if display else math(inline))
        end = match.end()
    return joined(*found, _plain(text[end:]))


def scrolled(*inside: Markup) -> Markup:
    """What may be wider than the page, and can then be scrolled with the keyboard, too."""
    return tag("div", *inside, class_="wide", tabindex="0")


def _plain(text: str) -> str:
    text = text.replace(r"\mbox{--}", "--")  # which keeps both ends on one line there
    return text.replace("~", "\N{NO-BREAK SPACE}").replace("--", "\N{EN DASH}").replace(r"\,", "\N{THIN SPACE}")
