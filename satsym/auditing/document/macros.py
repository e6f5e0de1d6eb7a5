"""The macros that a document defines, and those among them that begin or end displays."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field

from satsym.auditing.latex.tokens import UNKNOWN, Macro, Unread, tokens
from satsym.auditing.latex.words import ACCENTS, KEPT_GROUPS, MARKS, STYLES

_MACRO = re.compile(
    r"\\(?:(?:re)?newcommand|providecommand|DeclareRobustCommand)\s*\*?\s*\{?\s*\\(?P<name>[A-Za-z@]+)\s*\}?"
    r"\s*(?:\[(?P<count>[0-9])\])?\s*(?:\[(?P<default>[^\[\]\n]*)\])?"
    r"|\\[gex]?def\s*\\(?P<def>[A-Za-z@]+)(?P<args>[^{}\\\n]*)(?=\{)"
    r"|\\DeclareMathOperator\s*\*?\s*\{?\s*\\(?P<operator>[A-Za-z@]+)\s*\}?"
    r"|\\let\s*\\(?P<let>[A-Za-z@]+)\s*=?\s*(?P<same>\\[A-Za-z@]+|[A-Za-z])"
    r"|\\DeclarePairedDelimiter\s*\{?\s*\\(?P<pair>[A-Za-z@]+)\s*\}?\s*\{(?P<left>[^{}]*)\}\s*\{(?P<right>[^{}]*)\}"
    r"|\\(?:New|Renew|Provide|Declare)DocumentCommand\s*\{?\s*\\(?P<document>[A-Za-z@]+)\s*\}?"
    r"\s*\{(?P<kinds>(?:[^{}]|\{[^{}]*\})*)\}"
)
_ENVIRONMENTS = re.compile(r"\{\s*(?:\\(?:begin|end)\s*\{[A-Za-z]+\*?\}\s*)+\}")
"""Pattern of the body of a macro that only begins or ends environments."""
_KNOWN = frozenset((*ACCENTS, *MARKS, *STYLES, *KEPT_GROUPS))
"""Macros of LaTeX that satsym reads itself; a redefinition in the document changes only the look, and is ignored."""
_SET = re.compile(r"\\(?:text|textrm|mathrm)\s*\{([^{}]*)\}")


@dataclass
class Definitions:
    """What a document defines."""

    macros: dict[str, Macro] = field(default_factory=dict)
    environments: dict[str, str] = field(default_factory=dict)
    """The macros that begin or end displays, and what they stand for."""
    unread: list[tuple[str, str]] = field(default_factory=list)
    """The parts of the document that could not be read: place and reason of each."""


def enter_macros(defined: Definitions, text: str, place: Callable[[int], str] | None) -> str:
    """Record the macros that a text defines, and return the text without the definitions.

    A macro whose definition cannot be read is refused only where it is used.
    """
    for match in _MACRO.finditer(text):
        name = next(match[kind] for kind in ("name", "def", "operator", "let", "pair", "document") if match[kind])
        end = match.end()
        if not match["let"] and not match["pair"]:
            opening = text.find("{", match.end())
            if opening < 0 or text[match.end() : opening].strip():
                defined.macros.setdefault(name, UNKNOWN)
                continue
            end = _closing(text, opening) + 1
        group = text[match.end() : end].strip()
        if _ENVIRONMENTS.fullmatch(group) and not match["count"]:
            defined.environments[name] = group[1:-1].strip()
        elif name not in _KNOWN:
            try:
                defined.macros[name] = _macro(match, group, match.end())
            except Unread as error:
                defined.macros[name] = UNKNOWN
                if place:  # a package of the document's own may hold anything
                    defined.unread.append((place(match.start()), f"the macro \\{name}: {error.message}"))
        text = text[: match.start()] + re.sub(r"[^\n]", " ", text[match.start() : end]) + text[end:]
    return text


def _macro(match: re.Match[str], group: str, at: int) -> Macro:
    """Return the macro that a definition defines."""
    body, count, default = group[1:-1], int(match["count"] or 0), match["default"]
    if match["let"]:
        body = match["same"]
    elif match["pair"]:
        body, count, default = f"{match['left']} #2 {match['right']}", 2, ""
    elif match["operator"]:
        body = rf"\operatorname{{{_SET.sub(lambda upright: upright[1], body)}}}"
    elif match["document"]:
        kinds = re.fullmatch(r"\s*(?:O\s*\{([^{}]*)\})?([\sm]*)", match["kinds"])
        if kinds is None:
            return UNKNOWN
        count, default = kinds[2].count("m") + (kinds[1] is not None), kinds[1]
    elif match["def"]:
        count = len(match["args"].split("#")) - 1
        if match["args"].strip() != "".join(f"#{k + 1}" for k in range(count)):
            return UNKNOWN
    given = None if default is None else tuple(tokens(default, None, at))
    return Macro(count, tuple(tokens(body, None, at)), given, starred=bool(match["pair"]))


def _closing(text: str, opening: int) -> int:
    """Return the position of the brace that closes the given one, or of the end of the text if none does."""
    depth = 0
    for match in re.finditer(r"\\.|[{}]", text[opening : opening + 20_000], re.DOTALL):
        depth += {"{": 1, "}": -1}.get(match[0], 0)
        if depth == 0:
            return opening + match.start()
    return min(len(text) - 1, opening + 20_000)


def with_environments(defined: Definitions, text: str) -> tuple[str, Callable[[int], int]]:
    """Return the text with macros that begin or end displays replaced, and a function that moves positions to it."""
    if not defined.environments:
        return text, lambda position: position
    done, last, moved = "", 0, dict[int, int]()
    for match in re.finditer(rf"\\({'|'.join(map(re.escape, defined.environments))})(?![A-Za-z@])", text):
        done += text[last : match.start()] + defined.environments[match[1]]
        last = match.end()
        moved[last] = len(done) - last
    places = [0, *moved]

    def at(position: int) -> int:
        return position + moved.get(places[bisect_right(places, position) - 1], 0)

    return done + text[last:], at
