"""LaTeX of formulas as MathML, which browsers show without any help."""

from __future__ import annotations

import re
from functools import cache
from html import unescape
from itertools import pairwise
from xml.etree import ElementTree as Xml

from satsym.report.html.markup import Markup

_UPRIGHT = re.compile(r"\\mathrm\{([^{}\\]*)\}")
_BRACKET = re.compile(r"\\[bB]igg?([lr])(?![A-Za-z])")
_BEFORE_A_SIGN = frozenset("=,([{<>≤≥|")
_FUNCTIONS = frozenset("sin cos tan arcsin arccos arctan sinh cosh tanh exp log ln sgn det rank".split())
_OPERATOR = re.compile(r"\\operatorname\{([^{}\\]*)\}")


@cache
def math(tex: str, *, block: bool = False) -> Markup:
    """A formula; names of several letters are words, so that they are read as such."""
    from latex2mathml.converter import convert_to_element

    plain = _OPERATOR.sub(r"\\text{\1}\\,", _UPRIGHT.sub(r"\\text{\1}", tex))
    plain = _BRACKET.sub(lambda side: r"\left" if side[1] == "l" else r"\right", plain)
    element = convert_to_element(plain, display="block" if block else "inline")
    element.attrib.pop("xmlns", None)
    for part in element.iter():
        # characters come as references; serialising escapes whatever they stand for
        part.text, part.tail = (unescape(text) if text else text for text in (part.text, part.tail))
    for word in element.iter("mi"):
        if word.text in _FUNCTIONS:  # as an identifier it would touch what stands beside it
            word.tag, word.attrib = "mo", {"form": "prefix", "lspace": "0.17em", "rspace": "0.17em"}
    for parent in element.iter():
        for before, sign in pairwise(parent):
            if (
                sign.tag == "mo"
                and sign.text in ("-", "−", "+")
                and before.tag == "mo"
                and before.text in _BEFORE_A_SIGN
            ):
                sign.set("form", "prefix")  # else it is set as between two terms
    return Markup(Xml.tostring(element, encoding="unicode"))
