"""Behaviour of printed programs in Python, or in MATLAB and Maple transcribed to Python syntax.

A program is a list of lines, as in ``text['program', 'lines']``, or several lists joined by ``+``. It is interpreted,
not executed. Values that are given by name replace the values that the lines assign. A line appended to a program is
evaluated with the variables of the program.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from satsym.auditing import quantities
from satsym.auditing.program import text as programs
from satsym.auditing.program.library import Module, Run
from satsym.auditing.program.run import run
from satsym.auditing.program.text import Program, Stops
from satsym.auditing.propositions.values import Family, Record, is_exact, measured, undecided_if_refused
from satsym.status import BadInput
from satsym.wording import shown, suggestion

_BRACKET = re.compile(r"\(([^)]*)\)")
_MAIN = ("x", "y", "z")


def values(program: Sequence[str], **given: Any) -> Record:
    """Return the variables of a program by name after it has run."""
    found = _walked(program, given)
    return Record("the program", {name: _plain(value) for name, value in found.values.items()})


def called(program: Sequence[str], name: str, *arguments: Any, **given: Any) -> Any:
    """Return what a function of a program returns."""
    found = _walked(program, given).values.get(name)
    if not callable(found):
        raise BadInput(
            f"the program has no function {shown(name)}; {suggestion(name, list(_assigned(_read(program))))}"
        )
    with undecided_if_refused():
        return np.asarray(found(*(np.asarray(a) if isinstance(a, list) else a for a in arguments)))


def output(program: Sequence[str], **given: Any) -> list[str]:
    """Return the lines that a program prints."""
    return list(_walked(program, given).said)


def drawn(program: Sequence[str], call: str, **given: Any) -> list[Record]:
    """Return the calls of one function of matplotlib: arguments x, y, ... in order, and keyword arguments."""
    return [
        Record(call, {"arguments": list(d.arguments), **dict(zip(_MAIN, d.arguments, strict=False)), **d.named})
        for d in _walked(program, given).drawn
        if d.name == call
    ]


def stops(program: Sequence[str]) -> list[str]:
    """Return why a program would stop with an error in Python; empty if it runs to its end."""
    with undecided_if_refused():
        try:
            _run(_read(program).text, ())
        except Stops as error:
            return [str(error)]
    return []


def unassigned(program: Sequence[str]) -> list[str]:
    """Return the names that have no value when a line uses them."""
    return list(dict.fromkeys(programs.loose_names(_read(program))))


def assigned(program: Sequence[str]) -> list[str]:
    """Return the names to which the lines assign a value, including imports and functions."""
    return list(_assigned(_read(program)))


def used(program: Sequence[str]) -> list[str]:
    """Return the names that the lines use."""
    return sorted({name for statement in _read(program).statements for name in programs.names_in(statement)})


def sources(program: Sequence[str], name: str) -> list[str]:
    """Return the names on which a value depends, directly or through other names."""
    return sorted(programs.sources(_read(program), [name]) - {name})


def unit_in(label: str) -> float:
    """Return the value in base units of the unit that a label contains in brackets."""
    found = _BRACKET.search(label)
    if found is None:
        raise BadInput(f"{shown(label)} has no unit in brackets")
    return quantities.one(found[1].lower() if found[1].isupper() and len(found[1]) > 1 else found[1]).value


def _read(program: Sequence[str]) -> Program:
    with undecided_if_refused():
        return programs.read([program] if isinstance(program, str) else program)


def _assigned(program: Program) -> dict[str, None]:
    return dict.fromkeys(name for statement in program.statements for name in programs.given_names(statement))


def _walked(program: Sequence[str], given: Mapping[str, Any]) -> Run:
    found = _read(program)
    first = [f"{name} = 0.0" for name in given if name not in _assigned(found)]
    numbers = {name: np.asarray(_numeric(value)) for name, value in given.items()}
    frozen = tuple((name, value.shape, tuple(value.ravel().tolist())) for name, value in numbers.items())
    with undecided_if_refused():
        return _run("\n".join([*first, found.text]), frozen)


@lru_cache(maxsize=512)
def _run(text: str, given: tuple[tuple[str, tuple[int, ...], tuple[Any, ...]], ...]) -> Run:
    values = {name: np.array(entries).reshape(shape) if shape else entries[0] for name, shape, entries in given}
    return run(programs.read(text.splitlines()), values)


def _numeric(value: Any) -> Any:
    """Return exact numbers as floats, also within lists."""
    if isinstance(value, list):
        return [_numeric(entry) for entry in value]
    return measured(value)[()] if is_exact(value) else value


def _plain(value: Any) -> Any:
    return Record(value.name, value.attributes) if isinstance(value, Module) else value


_LOOP = re.compile(r"while\((.*)\)")
_COUNTED = re.compile(r"^for +\w+=\w+:\w+")
_ENTRY = re.compile(r"\(([ij](?:\+1)?)\)")
"""Pattern of an index in MATLAB, which selects an entry, while other brackets call a function."""
_SEED = 11


def matlab(lines: str | Sequence[str], **given: Any) -> Record:
    """Return the values that lines assign; ``again`` states whether a loop ``while(...)`` would be repeated."""
    world = {name: np.array(v, dtype=float) if isinstance(v, list) else v for name, v in given.items()}
    program = _program(lines)
    with undecided_if_refused():
        found = run(program, world={**_FUNCTIONS, **world})
    return Record("the lines", {name: value for name, value in found.values.items() if name not in _FUNCTIONS})


def iterates() -> Family:
    """Return a family of controls before and after an iteration, with relative changes between zero and one."""
    rng, members = np.random.default_rng(_SEED), []
    for share in (0.0, 0.001, 0.003, 0.009, 0.011, 0.03, 0.1, 0.5, 1.0):
        new = rng.uniform(0.1, 1.0, 20)
        old = new + share * new * rng.choice([-1.0, 1.0], 20)
        members.append(Record(f"a change by {100 * share:g} %", {"old": old, "new": new, "share": share}))
    return Family("ITERATES", "iterations", tuple(members))


def count(text: str, sign: str) -> int:
    """Return how often a sign occurs in a text."""
    return text.count(sign)


def used_early(lines: str | Sequence[str]) -> list[str]:
    """Return the names that are used before a later line assigns their value."""
    program = _program(lines)
    given = {name for statement in program.statements for name in programs.given_names(statement)}
    return sorted(given & {*programs.loose_names(program)})


def _program(lines: str | Sequence[str]) -> Program:
    """Return lines in Python syntax; ``/`` becomes the matrix quotient of MATLAB, ``./`` the elementwise quotient."""
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
    """Replacement of the quotient of two rows by a function call."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        if not isinstance(node.op, ast.FloorDiv):
            return node
        return ast.Call(ast.Name("mrdivide", ast.Load()), [node.left, node.right], [])


def _quotient(one: Any, other: Any) -> Any:
    """Return q such that q times the other row is closest to the one row; for numbers, the ordinary quotient."""
    rows = np.ndim(one) and np.ndim(other)
    return np.array([np.dot(one, other) / np.dot(other, other)]) if rows else one / other


_FUNCTIONS: Mapping[str, Callable[..., Any]] = {"sum": np.sum, "mrdivide": _quotient}
