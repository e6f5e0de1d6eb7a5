"""Printed listings in MATLAB and Maple: what lines do, put into Python's syntax and walked through."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from satsym.auditing.program import text as programs
from satsym.auditing.program.run import run
from satsym.auditing.program.text import Program
from satsym.auditing.propositions.values import Family, Record, undecided_if_refused

_LOOP = re.compile(r"while\((.*)\)")
_COUNTED = re.compile(r"^for +\w+=\w+:\w+")
_ENTRY = re.compile(r"\(([ij](?:\+1)?)\)")
"""An index, which picks an entry where brackets else call a function."""
_SEED = 11


def matlab(lines: str | Sequence[str], **given: Any) -> Record:
    """The values that lines give to names; ``again`` tells whether a loop ``while(...)`` goes round once more."""
    world = {name: np.array(v, dtype=float) if isinstance(v, list) else v for name, v in given.items()}
    program = _program(lines)
    with undecided_if_refused():
        found = run(program, world={**_FUNCTIONS, **world})
    return Record("the lines", {name: value for name, value in found.values.items() if name not in _FUNCTIONS})


def iterates() -> Family:
    """Controls before and after an iteration, which changed by shares of their size between none and all of it."""
    rng, members = np.random.default_rng(_SEED), []
    for share in (0.0, 0.001, 0.003, 0.009, 0.011, 0.03, 0.1, 0.5, 1.0):
        new = rng.uniform(0.1, 1.0, 20)
        old = new + share * new * rng.choice([-1.0, 1.0], 20)
        members.append(Record(f"a change by {100 * share:g} %", {"old": old, "new": new, "share": share}))
    return Family("ITERATES", "iterations", tuple(members))


def count(text: str, sign: str) -> int:
    """How often a sign stands in a text."""
    return text.count(sign)


def used_early(lines: str | Sequence[str]) -> list[str]:
    """Names that some line gives a value, but that another line uses before."""
    program = _program(lines)
    given = {name for statement in program.statements for name in programs.given_names(statement)}
    return sorted(given & {*programs.loose_names(program)})


def _program(lines: str | Sequence[str]) -> Program:
    """Lines in Python's syntax; ``/`` becomes the quotient that MATLAB takes of arrays, ``./`` goes entry by entry."""
    found = []
    for line in [lines] if isinstance(lines, str) else lines:
        text = _COUNTED.sub("", line.strip()).replace(" ", "").rstrip(";")
        loop = _LOOP.fullmatch(text)
        text = f"again=all([{loop[1].replace('&&', ',')}])" if loop else text
        text = re.sub(r"(?<!\.)/", "//", text).replace("./", "/").replace(".*", "*").replace(".^", "**")
        found.append(_ENTRY.sub(r"[\1]", text.replace("^", "**")))
    read = programs.read(found)
    return Program(read.text, tuple(ast.fix_missing_locations(_Quotients().visit(s)) for s in read.statements))


class _Quotients(ast.NodeTransformer):
    """Puts a function in the place of the quotient of two rows."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        if not isinstance(node.op, ast.FloorDiv):
            return node
        return ast.Call(ast.Name("mrdivide", ast.Load()), [node.left, node.right], [])


def _quotient(one: Any, other: Any) -> Any:
    """The q for which q times the other row comes closest to the one; of numbers, what divides entry by entry."""
    rows = np.ndim(one) and np.ndim(other)
    return np.array([np.dot(one, other) / np.dot(other, other)]) if rows else one / other


_FUNCTIONS: Mapping[str, Callable[..., Any]] = {"sum": np.sum, "mrdivide": _quotient}
