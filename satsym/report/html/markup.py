"""HTML built from pieces; text that is not markup is escaped, whoever wrote it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from html import escape, unescape
from itertools import pairwise
from xml.etree import ElementTree as Xml

_VOID = frozenset({"meta", "input"})


class Markup(str):
    """A text that is HTML."""

    __slots__ = ()


def tag(name: str, /, *inside: str, **attributes: str | bool) -> Markup:
    """Return an element; false attributes are left out, and underscores in names are adapted from Python."""
    given = "".join(_attribute(key, value) for key, value in attributes.items() if value is not False)
    if name in _VOID:
        return Markup(f"<{name}{given}>")
    return Markup(f"<{name}{given}>{joined(*inside)}</{name}>")


def joined(*pieces: str, by: str = "") -> Markup:
    """Join pieces of HTML."""
    return Markup(by.join(piece if isinstance(piece, Markup) else escape(piece) for piece in pieces))


def _attribute(key: str, value: str | bool) -> str:
    name = key.rstrip("_").replace("_", "-")
    return f" {name}" if value is True else f' {name}="{escape(str(value))}"'


_UPRIGHT = re.compile(r"\\mathrm\{([^{}\\]*)\}")
_BRACKET = re.compile(r"\\[bB]igg?([lr])(?![A-Za-z])")
_BEFORE_A_SIGN = frozenset("=,([{<>≤≥|")
_FUNCTIONS = frozenset("sin cos tan arcsin arccos arctan sinh cosh tanh exp log ln sgn det rank".split())
_ACCENTS = {"˙": "\N{COMBINING DOT ABOVE}", "¨": "\N{COMBINING DIAERESIS}", "¯": "\N{COMBINING MACRON}"}
_ACCENTS |= {"^": "\N{COMBINING CIRCUMFLEX ACCENT}", "~": "\N{COMBINING TILDE}"}
_BETWEEN = frozenset("+−-=")
_OPERATOR = re.compile(r"\\operatorname\{([^{}\\]*)\}")


@cache
def math(tex: str, *, block: bool = False) -> Markup:
    """Return a formula; names of several letters are set as words.

    A formula that the converter cannot read is shown as its LaTeX code.
    """
    element = _converted(tex, block)
    return tag("code", tex) if element is None else Markup(Xml.tostring(element, encoding="unicode"))


def indexed(tex: str) -> Markup:
    """Return a formula as text with the tags ``sub`` and ``sup``, for places that show no other markup."""
    element = _converted(tex, block=False)
    return joined(tex) if element is None else _indexed(element)


def _indexed(element: Xml.Element) -> Markup:
    inside = [_between(part) if k and part.text in _BETWEEN else _indexed(part) for k, part in enumerate(element)]
    match element.tag:
        case "msub" | "msup" | "msubsup":
            names = {"msub": ("sub",), "msup": ("sup",), "msubsup": ("sub", "sup")}[element.tag]
            return joined(inside[0], *(tag(name, part) for name, part in zip(names, inside[1:], strict=True)))
        case "mover":
            return joined(inside[0], _ACCENTS.get(inside[1], inside[1]))
        case "msqrt":
            return joined("\N{SQUARE ROOT}(", *inside, ")")
        case "mfrac":
            return joined(*inside, by="/")
        case "mspace":
            return Markup("\N{THIN SPACE}")
    return joined(element.text or "", *inside)


def _between(sign: Xml.Element) -> Markup:
    """Return a sign with spaces around it if it stands between two terms."""
    return joined(sign.text or "") if sign.get("form") == "prefix" else joined(" ", sign.text or "", " ")


def _converted(tex: str, block: bool) -> Xml.Element | None:
    """Return a formula as MathML; ``None`` if the converter cannot read it."""
    from latex2mathml import exceptions
    from latex2mathml.converter import convert_to_element

    named = (one for one in vars(exceptions).values() if isinstance(one, type) and issubclass(one, Exception))
    refusals: tuple[type[Exception], ...] = (*named, IndexError, ValueError)
    plain = _OPERATOR.sub(r"\\text{\1}\\,", _UPRIGHT.sub(r"\\text{\1}", tex))
    plain = _BRACKET.sub(lambda side: r"\left" if side[1] == "l" else r"\right", plain)
    try:
        element = convert_to_element(plain, display="block" if block else "inline")
    except refusals:
        return None
    element.attrib.pop("xmlns", None)
    for part in element.iter():
        # characters come as references; serialising escapes whatever they stand for
        part.text, part.tail = (unescape(text) if text else text for text in (part.text, part.tail))
    for word in element.iter("mi"):
        if word.text in _FUNCTIONS:  # as an identifier it would touch what stands beside it
            word.tag, word.attrib = "mo", {"form": "prefix", "lspace": "0.17em", "rspace": "0.17em"}
    for bracket in element.iter("mo"):
        if bracket.get("fence") == "true":  # browsers leave space around brackets of adjustable height
            bracket.attrib |= {"lspace": "0", "rspace": "0"}
    for parent in element.iter():
        for before, sign in pairwise(parent):
            if (
                sign.tag == "mo"
                and sign.text in ("-", "−", "+")
                and before.tag == "mo"
                and before.text in _BEFORE_A_SIGN
            ):
                sign.set("form", "prefix")  # else it is set as between two terms
    return element


_PIECES = re.compile(r"\$([^$]+)\$|\\\[(.+?)\\\]|\\(?:eq)?ref\{([^{}]*)\}", re.DOTALL)


def prose(text: str, numbers: Mapping[str, str]) -> Markup:
    """Return a sentence of :mod:`satsym.report.texts` as HTML.

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
    """Return contents that may be wider than the page and can be scrolled by keyboard, too."""
    return tag("div", *inside, class_="wide", tabindex="0")


def _plain(text: str) -> str:
    text = text.replace(r"\mbox{--}", "--")  # which keeps both ends on one line there
    return text.replace("~", "\N{NO-BREAK SPACE}").replace("--", "\N{EN DASH}").replace(r"\,", "\N{THIN SPACE}")
