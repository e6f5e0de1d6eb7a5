"""Measured values taken apart: ``TERM = VALUE (MEMBER); TERM = VALUE`` as terms with their values."""

from __future__ import annotations

import ast
from collections.abc import Iterator

_OPENS, _CLOSES = "([{", ")]}"


class Unsaid(Exception):
    """A measurement has no sentence."""


def bound(measured: str, tested: str) -> list[tuple[ast.expr, str]]:
    """Return the measured terms with their values, with members in the place of a bound variable."""
    parts = [_taken_apart(part) for part in divided(measured, "; ")]
    groups = sum(bool(remark) for *_, remark in parts)
    if not groups:
        return [(tree(term), value) for term, value, _ in parts]
    name, members = _members(tested)
    if groups != len(members) or not parts[-1][2]:
        raise Unsaid
    found, k = [], 0
    for term, value, remark in parts:
        found.append((_Member(name, members[k]).visit(tree(term)), value))
        k += bool(remark)
    return found


def _members(tested: str) -> tuple[str, list[ast.expr]]:
    """Return the only bound variable of a proposition and the members that it lists."""
    parts = [node for node in ast.walk(tree(tested)) if isinstance(node, ast.comprehension)]
    if len(parts) != 1 or not isinstance(parts[0].iter, ast.List) or not isinstance(parts[0].target, ast.Name):
        raise Unsaid
    return parts[0].target.id, parts[0].iter.elts


class _Member(ast.NodeTransformer):
    """Replacement of a bound variable by a member."""

    def __init__(self, name: str, member: ast.expr) -> None:
        self._name, self._member = name, member

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """Return the member in the place of the variable."""
        return self._member if node.id == self._name else node


def tree(term: str) -> ast.expr:
    """Return the syntax tree of a term."""
    return ast.parse(term, mode="eval").body


def _taken_apart(part: str) -> tuple[str, str, str]:
    """Split a measured term into the term, its value and the remark after it."""
    places = [k for k in outside(part) if part.startswith(" = ", k) or part.startswith(" is ", k)]
    if not places:
        raise Unsaid
    k = places[-1] if part.startswith(" is ", places[-1]) else places[0]
    gap = 3 if part.startswith(" = ", k) else 4
    value, remark = part[k + gap :], ""
    if value.endswith(")") and " (" in value:
        value, _, remark = value.partition(" (")
        remark = remark[:-1]
    return part[:k], value, remark


def divided(text: str, by: str) -> Iterator[str]:
    """Return the pieces of a text between separators that are outside brackets and quotes."""
    begin = 0
    for k in outside(text):
        if text.startswith(by, k) and k >= begin:
            yield text[begin:k]
            begin = k + len(by)
    if text[begin:].strip():
        yield text[begin:]


def outside(text: str) -> Iterator[int]:
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
