r"""Macros of common LaTeX packages, such as ``\dv{x}{t}``, ``\norm{x}`` or ``\cross``, and their replacement."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from satsym.auditing.latex.letters import GREEK
from satsym.auditing.latex.tokens import END, Token, braced, end_of, environment, group_at, group_end
from satsym.auditing.latex.words import OPTIMA, RELATIONS, SIGNS, STYLES, UNITS

_OTHER_NAMES = {"cross": "times", "crossproduct": "times", "vdot": "cdot", "dotproduct": "cdot", "bigcdot": "cdot"}
_OTHER_NAMES |= {"centerdot": "cdot", "grad": "nabla", "vb": "mathbf", "vectorbold": "mathbf", "va": "vec"}
_OTHER_NAMES |= {name.capitalize(): name for name in ("dot", "ddot", "hat", "bar", "tilde", "check", "breve", "vec")}
_UNITS = {"meter": "m", "metre": "m", "second": "s", "gram": "g", "newton": "N", "radian": "rad", "degree": "deg"}
_UNITS |= {
    "kilo": "k",
    "milli": "m",
    "mega": "M",
    "giga": "G",
    "centi": "c",
    "per": "/",
    "squared": "^2",
    "cubed": "^3",
}
_UNITS |= {"kilogram": "kg", "kelvin": "K", "watt": "W", "joule": "J", "hertz": "Hz", "pascal": "Pa", "volt": "V"}
_UNITS |= {"ampere": "A", "square": "", "hour": "h", "minute": "min", "cdot": " ", ".": " "}
"""Units and prefixes of the package siunitx -> how they are printed."""
_BARS = {"norm": ("lVert", "rVert"), "abs": ("lvert", "rvert")}
_DERIVATIVES = {"dv": "d", "pdv": "partial", "derivative": "d", "partialderivative": "partial", "odv": "d"}
_DERIVATIVES |= {"diff": "d", "diffp": "partial"}
_PLACED = ("aligned", "gathered", "alignedat", "array")
"""Environments with an option in square brackets that says with which line they stand at the height of the text."""
_BOLD = ("boldsymbol", "bm", "mathbf", "pmb", "symbf")
_QUANTITIES = {"SI": 2, "qty": 2, "si": 1, "num": 1, "unit": 1}
"""Macros of the package siunitx -> their numbers of arguments."""


def put_in(found: Sequence[Token]) -> list[Token]:
    """Return the tokens with macros of packages replaced; the document's own macros were replaced before."""
    done: list[Token] = []
    i = 0
    while i < len(found):
        token = found[i]
        i += 1
        name = token.text if token.kind == "macro" else ""
        after = [t.text for t in found[i : i + 3]]
        first = found[i] if i < len(found) else END
        if name in STYLES and (after[:1] == ["nabla"] or after == ["{", "nabla", "}"]):
            done.append(Token("macro", "nabla", token.at))
            i += 1 if after[0] == "nabla" else 3
        elif name == "qty" and first.text in "([":
            continue
        elif token.kind == "open" and first.is_macro(("rm", "it", "sf")):
            done += [replace(first, text="mathrm"), token]
            i += 1
        elif token.kind == "begin" and token.text in _PLACED and after[:1] == ["["] and after[2:] == ["]"]:
            done.append(token)
            i += 3
        elif name in _BOLD and first.kind == "open":
            inside, i = group_at(found, i)
            sign = len(inside) == 1 and inside[0].text in SIGNS
            done += inside if sign else _bold(token, inside)
        elif name in _QUANTITIES and first.text in ("{", "["):
            inside, i = _quantity(token, found, i)
            done += inside
        elif name in ("stackrel", "underset", "overset") and (rows := _stacked(found, i)):
            done += put_in(rows)
            i = group_end(found, group_end(found, i))
        elif name in ("{", "lbrace") and (rows := _values_in_cases(done, found, i)):
            done = done[:-1] if done[-1].text == "left" else done
            done += put_in(rows)
            i = end_of(found, i, environment)
            i += 2 if [t.text for t in found[i : i + 2]] == ["right", "."] else 0
        elif name == "substack" and first.kind == "open":
            inside, i = group_at(found, i)
            done += [Token("sign", ",", t.at) if t.is_macro("\\") else t for t in put_in(inside)]
        elif name == "operatorname" and first.text == "*":
            inside, end = group_at(found, i + 1)
            said = "".join(t.text for t in inside if t.kind == "letter")
            optimum = said in ("argmin", "argmax")
            done.append(replace(token, text=said) if optimum else token)
            i = end if optimum else i + 1
        elif name == "degree":
            done += [Token("sign", "^", token.at), Token("macro", "circ", token.at)]
        elif name == "arg" and first.text in ("min", "max"):
            done.append(Token("macro", f"arg{first.text}", token.at))
            i += 1
        elif name in _OTHER_NAMES:
            done.append(Token("macro", _OTHER_NAMES[name], token.at))
        elif name in _BARS and first.text in ("*", "{"):
            inside, i = group_at(found, i + (first.text == "*"))
            opening, closing = (Token("macro", bar, token.at) for bar in _BARS[name])
            done += [opening, *put_in(inside), closing]
        elif name in _DERIVATIVES and (first.kind == "open" or first.text == "["):
            order, i = _order(found, i)
            groups, i = _groups(found, i, 2)
            done += _quotient(_DERIVATIVES[name], order, [put_in(group) for group in groups], token.at)
        else:
            done.append(token)
    return done


def _groups(found: Sequence[Token], i: int, most: int) -> tuple[list[Sequence[Token]], int]:
    """Return the contents of the groups that follow each other at a position, and the position after them."""
    groups: list[Sequence[Token]] = []
    while i < len(found) and found[i].kind == "open" and len(groups) < most:
        inside, i = group_at(found, i)
        groups.append(inside)
    return groups, i


def _values_in_cases(done: Sequence[Token], found: Sequence[Token], i: int) -> list[Token]:
    """Return the rows after a brace behind an equals sign as cases; empty if they are anything else."""
    before = [t.text for t in done if t.text not in ("left", "&", "\\,")][-1:]
    if before != ["="] or i >= len(found) or found[i].kind != "begin" or found[i].text not in ("array", "aligned"):
        return []
    end = end_of(found, i, environment)
    begin = group_end(found, i + 1) if found[i].text == "array" and found[i + 1].kind == "open" else i + 1
    closing = [t.text for t in found[end : end + 2]]
    if closing[:1] == ["}"] or (closing[:1] == ["right"] and closing != ["right", "."]):
        return []
    first, last = replace(found[i], text="cases"), replace(found[end - 1], text="cases")
    return [first, *found[begin : end - 1], last]


def _stacked(found: Sequence[Token], i: int) -> list[Token]:
    """Return two relations that are set above each other as a list; empty for anything else."""
    rows, _ = _groups(found, i, 2)
    if len(rows) < 2 or not all(any(t.text == "=" or t.text in RELATIONS for t in row[1:-1]) for row in rows):
        return []
    return [*rows[0], Token("sign", ",", found[i].at), *rows[1]]


def _quantity(macro: Token, found: Sequence[Token], i: int) -> tuple[list[Token], int]:
    """Return the tokens of a number with its unit in the notation of siunitx, and the position after it."""
    if found[i].text == "[":
        i = _square_end(found, i) + 1
    groups, i = _groups(found, i, _QUANTITIES[macro.text])
    number = groups.pop(0) if groups and macro.text in ("SI", "num", "qty") else ()
    if not groups:
        return list(number), i
    said = "".join(_UNITS.get(t.text, t.text) for t in groups[0])
    if not all(part in UNITS for part in re.findall(r"[A-Za-z]+", said)):
        return [macro], i
    letters = [Token("letter" if c.isalpha() else "sign", c, macro.at) for c in said.strip()]
    return [*number, Token("macro", "mathrm", macro.at), *braced(letters, macro.at)], i


def _bold(macro: Token, inside: Sequence[Token]) -> list[Token]:
    """Return the tokens of a bold group, in which each letter of a formula is set bold on its own."""
    alone = [k for k, t in enumerate(inside) if t.kind == "letter" or t.is_macro(GREEK)]
    alone = [k for k in alone if not (k and inside[k - 1].text in "^_") and not _within_script(inside, k)]
    if len(alone) < 2 and not any(t.is_sign("=+-()^") for t in inside):
        return [macro, *braced(inside, macro.at)]
    done: list[Token] = []
    for k, token in enumerate(inside):
        done += [replace(macro, at=token.at), *braced([token], token.at)] if k in alone else [token]
    return done


def _within_script(inside: Sequence[Token], k: int) -> bool:
    """Return whether a token is inside a subscript or superscript."""
    depth = 0
    for place in range(k - 1, -1, -1):
        depth += (inside[place].kind == "close") - (inside[place].kind == "open")
        if depth < 0:
            return place > 0 and inside[place - 1].text in ("^", "_")
    return False


def _order(found: Sequence[Token], i: int) -> tuple[list[Token], int]:
    """Return the order of a derivative in square brackets, empty for the first order, and the position after it."""
    if found[i].text != "[":
        return [], i
    end = _square_end(found, i)
    at = found[i].at
    return [Token("sign", "^", at), *braced(found[i + 1 : end], at)], end + 1


def _square_end(found: Sequence[Token], i: int) -> int:
    """Return the position of the next square bracket that closes."""
    return next((k for k in range(i, len(found)) if found[k].text == "]"), len(found) - 1)


def _quotient(sign: str, order: list[Token], groups: list[list[Token]], at: int) -> list[Token]:
    """Return the tokens of a quotient of differentials, or of a derivative operator if there is only one group."""
    of, by = groups if len(groups) == 2 else ([], groups[0] if groups else [])
    mark = Token("letter" if sign == "d" else "macro", sign, at)
    return [Token("macro", "frac", at), *braced([mark, *order, *of], at), *braced([mark, *by, *order], at)]


def underset(found: Sequence[Token], i: int) -> list[Token]:
    """Return an operator such as min with the text below it as its subscript; empty for other words."""
    end = group_end(found, i)
    if end >= len(found) or found[i].kind != "open":
        return []
    above = found[end : group_end(found, end)]
    word = "".join(t.text for t in above if t.kind == "letter" or t.text in OPTIMA)
    if word.removeprefix("operatorname") not in OPTIMA:
        return []
    at = found[i].at
    return [Token("macro", word, at), Token("sign", "_", at), *found[i:end]]


def height(found: Sequence[Token], i: int) -> int:
    """Return the position after the line height in brackets that follows a line break; 0 if there is none."""
    if i >= len(found) or found[i].text != "[":
        return 0
    end = next((k for k in range(i, min(i + 8, len(found))) if found[k].text == "]"), i)
    inside = [t for t in found[i + 1 : end] if t.text != "-"]
    unit = "".join(t.text for t in inside[1:])
    return end + 1 if inside and inside[0].kind == "number" and unit in ("em", "ex", "pt", "mm", "cm") else 0
