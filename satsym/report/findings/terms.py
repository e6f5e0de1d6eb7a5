"""Measured values of propositions in words and mathematics: ``len(meanings['x']) = 2`` as a sentence."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from satsym.report.texts import Texts
from satsym.wording import printable

_CONVENTION = re.compile(r"\b(?:NEAR|OFTEN|EPSILONS|DELTAS)\b")
_PROGRAM = re.compile(r"\bmatlab\(")
_NAMED = re.compile(r"\b(\w+)=(-?\d[\d.e-]*)")
_HOLE = re.compile(r"<(\d)>")
_SIGNS = {ast.Add: " + ", ast.Sub: " - ", ast.Mult: " × ", ast.Div: "/", ast.Pow: "^"}
_BINDING = {ast.Add: 1, ast.Sub: 1, ast.Mult: 2, ast.Div: 2, ast.Pow: 3}
_OPENS, _CLOSES = "([{", ")]}"
_LONGEST_TERM = 240
"""Largest number of characters of a computed term that is expressed in words."""


def sentences(measured: str, texts: Texts) -> str:
    """Return measured values as sentences in the language of the texts.

    Parameters
    ----------
    measured
        Terms with their values, ``TERM = VALUE``, divided by semicolons; a remark may follow in brackets.
    """
    return " ".join(_sentence(part, texts) for part in _divided(measured, "; "))


def chosen(code: str, texts: Texts) -> list[str]:
    """Return the numbers in a proposition that the document does not print, but the auditor chose.

    Printed numbers are in quotes in a proposition; the others are conventions, such as limits of nearness, and numbers
    that are given by name, such as the initial guess of a printed program.
    """
    found = {_word(name, texts): texts.get("conventions", name) for name in _CONVENTION.findall(code)}
    for match in _PROGRAM.finditer(code):
        inside = code[match.end() :]
        end = next((k for k in _outside(f"({inside}") if k and inside[k - 1] == ")"), len(inside))
        found |= dict(_NAMED.findall(inside[:end]))
    return [f"{name}: {value}" for name, value in found.items()]


def _sentence(part: str, texts: Texts) -> str:
    term, value, remark = _taken_apart(part)
    if not term:
        return f"`{part}`."
    said = term_in_words(term, texts)
    ending = f" ({remark})" if remark else ""
    if value in ("true", "false"):
        return f"{_filled(value, [said], texts)}{ending}."
    begin = said[:1].upper() if said[1:2].islower() else said[:1]
    return f"{begin}{said[1:]} = {value}{ending}."


def term_in_words(term: str, texts: Texts) -> str:
    """Return a term of a proposition in words, or unchanged where no words are known."""
    if len(term) > _LONGEST_TERM:
        return texts.get("terms", "long")
    try:
        return _said(ast.parse(term, mode="eval").body, texts)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return printable(term)


def _taken_apart(part: str) -> tuple[str, str, str]:
    """Split a measured term into the term, its value and the remark after it."""
    places = [k for k in _outside(part) if part.startswith(" = ", k) or part.startswith(" is ", k)]
    if not places:
        return "", "", ""
    k = places[-1] if part.startswith(" is ", places[-1]) else places[0]
    gap = 3 if part.startswith(" = ", k) else 4
    value, remark = part[k + gap :], ""
    if value.endswith(")") and " (" in value:
        value, _, remark = value.partition(" (")
        remark = remark[:-1]
    return part[:k], value, remark


def _divided(text: str, by: str) -> Iterator[str]:
    begin = 0
    for k in _outside(text):
        if text.startswith(by, k) and k >= begin:
            yield text[begin:k]
            begin = k + len(by)
    if text[begin:].strip():
        yield text[begin:]


def _outside(text: str) -> Iterator[int]:
    """Return the places outside brackets and quotes."""
    depth, quote = 0, ""
    for k, character in enumerate(text):
        if quote:
            quote = "" if character == quote else quote
        elif character in "'\"":
            quote = character
        elif character in _OPENS:
            depth += 1
        elif character in _CLOSES:
            depth -= 1
        if depth == 0 and not quote:
            yield k


def _said(node: ast.expr, texts: Texts) -> str:
    if isinstance(node, ast.Constant):
        return str(node.value)
    if isinstance(node, ast.Name):
        return _word(node.id, texts)
    if isinstance(node, ast.Attribute):
        if isinstance(node.value, ast.Name) and node.value.id.islower():
            return f"{node.attr}({node.value.id})"
        return _filled("part", [_word(node.attr, texts), _said(node.value, texts)], texts)
    if isinstance(node, ast.Subscript):
        return _entry(node, texts)
    if isinstance(node, ast.Call):
        return _call(node, texts)
    if isinstance(node, ast.List | ast.Tuple):
        return ", ".join(_said(part, texts) for part in node.elts)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return f"-{_said(node.operand, texts)}"
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add) and _is_unit(node.right):
        return f"{_said(node.left, texts)} {_said(node.right, texts).strip()}"
    if isinstance(node, ast.BinOp) and type(node.op) in _SIGNS:
        here = _BINDING[type(node.op)]
        sides = [
            f"({_said(side, texts)})"
            if (isinstance(side, ast.BinOp) and _BINDING.get(type(side.op), 0) < here) or isinstance(side, ast.Call)
            else _said(side, texts)
            for side in (node.left, node.right)
        ]
        return _SIGNS[type(node.op)].join(sides)
    return ast.unparse(node)


def _is_unit(node: ast.expr) -> bool:
    """Tell whether a term is a text, such as a unit that is appended to a printed number."""
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _entry(node: ast.Subscript, texts: Texts) -> str:
    keys = [_said(part, texts) for part in (node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice])]
    name = node.value.id if isinstance(node.value, ast.Name) else ""
    if name in ("row", "text"):
        return f"({' '.join(keys)})"
    if name == "meanings":
        return _filled(name, keys, texts)
    return f"{_said(node.value, texts)}[{', '.join(keys)}]"


def _call(node: ast.Call, texts: Texts) -> str:
    name = node.func.id if isinstance(node.func, ast.Name) else ""
    arguments = [_said(part, texts) for part in node.args]
    given = [f"{word.arg} = {_said(word.value, texts)}" for word in node.keywords if word.arg]
    if texts.find("terms", name):
        said = _filled(name, arguments, texts)
    elif name:
        said = _filled("other", [name.replace("_", " "), texts.listed(arguments)], texts)
    else:
        said = ast.unparse(node)
    return _filled("with", [said, ", ".join(given)], texts) if given else said


def _word(name: str, texts: Texts) -> str:
    return texts.find("terms", name) or (name.lower().replace("_", " ") if name.isupper() and len(name) > 2 else name)


def _filled(key: str, parts: list[str], texts: Texts) -> str:
    return _HOLE.sub(lambda hole: parts[int(hole[1])] if int(hole[1]) < len(parts) else "", texts.get("terms", key))
