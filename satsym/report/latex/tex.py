"""Text, units and numbers from outside, escaped and well set for LaTeX."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from fractions import Fraction

from satsym.formula.writing import GREEK

_SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "`": r"\textasciigrave{}",
}
_SYMBOLS = {
    "–": r"\textendash{}",
    "—": r"\textemdash{}",
    "‘": "`",
    "’": "'",
    "“": "``",
    "”": "''",
    "…": r"\ldots{}",
    "€": r"\texteuro{}",
    "°": r"\textdegree{}",
    "×": r"\ensuremath{\times}",
    "·": r"\ensuremath{\cdot}",
    "±": r"\ensuremath{\pm}",
    "−": r"\ensuremath{-}",
    "²": r"\ensuremath{^2}",
    "³": r"\ensuremath{^3}",
    "\N{NO-BREAK SPACE}": "~",
}
LARGEST_DENOMINATOR, LARGEST_DIGITS = 100, 12
"""Largest denominator of a fraction that replaces a decimal, and the number of digits above which it is replaced."""
GREEK_CAPITALS = frozenset("gamma delta theta lambda xi pi sigma upsilon phi psi omega".split())
_ACCENTS = {"\u0300", "\u0301", "\u0302", "\u0303", "\u0308", "\u030a", "\u030b", "\u030c", "\u0327", "\u0328"}
_NAME = re.compile(
    r"(?P<space>^| )(?P<before>\(?)(?P<sign>\\ensuremath\{-\})?"
    r"(?P<name>[B-HJ-Zb-z]|[a-z]{2,}|[0-9]+)(?=[,;:.)]*(?: |$))"
)
"""Pattern of a word that may be a name or number in escaped text; "a" and "I" are words."""
_UNIT = re.compile(r"(?P<operator>[*/]?)(?P<name>[A-Za-zµ%]+|1)(?:(?:\*\*|\^)(?P<power>-?[0-9]+))?")


def escape(text: str) -> str:
    """Escape any text so that LaTeX prints it; characters that its fonts lack appear as code points."""
    escaped = "".join(map(_character, unicodedata.normalize("NFC", " ".join(text.split()))))
    # hyphens stay hyphens: TeX would join them to a dash; before a name or number alone they are signs
    return re.sub(r"(?<=\s)-(?=\w)", r"\\ensuremath{-}", re.sub("-(?=-)", "-{}", escaped))


def worded(text: str, notation: Mapping[str, str]) -> str:
    """Typeset a phrase about quantities, with names as in formulas, and numbers kept with their words.

    Parameters
    ----------
    notation
        Name of a symbol -> its LaTeX; a name that is no single letter and not Greek is a word like any other.
    """

    def shown(found: re.Match[str]) -> str:
        name, start = found["name"], f"{'~' if found['space'] else ''}{found['before']}"
        if name.isdigit():
            return f"{start}{found['sign'] or ''}{name}"
        if len(name) > 1 and name not in GREEK:
            return found[0]
        letter = notation.get(name, rf"\{name}" if name in GREEK else name)
        return f"{start}${'-' if found['sign'] else ''}{letter}$"

    return _NAME.sub(shown, escape(text))


def bookmark(text: str) -> str:
    """Return a text for places without mathematics, with symbols spelt out."""
    return re.sub(r"\\ensuremath\{[\\^]*(\w+|-)\}", r"\1", escape(text))


def _character(c: str) -> str:
    if c in _SPECIAL:
        return _SPECIAL[c]
    if c.isascii():
        return c if c.isprintable() else ""
    if c in _SYMBOLS:
        return _SYMBOLS[c]
    name = unicodedata.name(c, "")
    if name.startswith("GREEK") and (letter := name.split()[-1].lower().replace("lamda", "lambda")) in GREEK:
        if name.startswith("GREEK SMALL LETTER"):
            return rf"\ensuremath{{\{letter}}}"
        if letter in GREEK_CAPITALS:
            return rf"\ensuremath{{\{letter.capitalize()}}}"
    plain, mark = unicodedata.normalize("NFD", c)[:1], unicodedata.normalize("NFD", c)[1:]
    if plain.isascii() and plain.isalpha() and mark in _ACCENTS and ord(c) < 0x180:
        return c
    return c if c in "ßæÆøØœŒłŁðÐþÞđĐı" else rf"\texttt{{U+{ord(c):04X}}}"


def unit(text: str) -> str:
    """Typeset a unit such as ``km**3/s**2``, upright; an en dash for a pure number."""
    if text.strip() in ("", "1"):
        return "--"
    compact = text.replace(" ", "")
    factors = list(_UNIT.finditer(compact))
    if "".join(f[0] for f in factors) != compact:
        return rf"\texttt{{{escape(text)}}}"
    above, below = ([_factor(f) for f in factors if (f["operator"] == "/") is under] for under in (False, True))
    written, under = r"\,".join(above), r"\,".join(below)
    line = f"/({under})" if len(below) > 1 else f"/{under}" if below else ""
    return rf"$\mathrm{{{written}{line}}}$"


def _factor(unit: re.Match[str]) -> str:
    name = {"ohm": r"\Omega"}.get(unit["name"], unit["name"].replace("%", r"\%").replace("µ", "\N{MICRO SIGN}"))
    return f"{name}^{{{unit['power']}}}" if unit["power"] else name


def number(value: float | None, point: str = ".") -> str:
    """Write a number with a decimal point or its replacement; an en dash for none."""
    if value is None:
        return "--"
    ratio = Fraction(value).limit_denominator(LARGEST_DENOMINATOR)
    if float(ratio) == value and ratio.denominator > 1 and len(f"{value:.12g}") > LARGEST_DIGITS:
        return f"${ratio}$"
    digits, _, exponent = f"{value:.12g}".replace(".", point).partition("e")
    if not exponent:
        return f"${digits}$"
    power = f"10^{{{int(exponent)}}}"
    return f"${power}$" if digits == "1" else rf"${digits} \times {power}$"


def name(identifier: str) -> str:
    """Typeset a name as it is typed in files."""
    return rf"\texttt{{{escape(identifier)}}}"


def label(address: str) -> str:
    """Return an address as a LaTeX label."""
    return re.sub(r"[^A-Za-z0-9_.:+-]", "-", address)
