"""Checks whether the body of a function is one that the generator writes.

A body unpacks its arguments, assigns numbers to names, and returns numbers or stores them. A pointwise function is
straight-line, except for iterations of a stated number of steps; a loop has one ``for`` over the steps. Whole numbers
occur only as indices, in the few forms that stay within nodes and midpoints: compiled code does not check them again.
No function of the file is called, so code that passes takes time in proportion to its length and to the number of
nodes.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import product
from math import prod
from typing import NoReturn

from satsym.kernels.contract import GROUPS, TUPLES, Signature

_GROUPS = GROUPS | {"x0": "n", "x_mid": "n", "lam_f": "n", "lam_mid": "n", "u_mid": "m"}
_NODES, _MIDPOINTS = ("times", "x", "lam", "u"), ("x_mid", "lam_mid", "u_mid")
_KEPT = {"math", "np", "len", "range", "float", "out", "shape"}
_UNARY = ("sqrt", "sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log")
_FUNCTIONS = {
    "math": dict.fromkeys((*_UNARY, "asin", "acos", "atan", "fabs"), 1) | {"atan2": 2},
    "np": dict.fromkeys((*_UNARY, "arcsin", "arccos", "arctan", "abs", "real"), 1)
    | dict.fromkeys(("arctan2", "heaviside", "minimum", "maximum"), 2),
}


MOST_REPEATED = 60
"""Largest number of steps of an iteration in generated code."""

CALLS_PER_LEVEL = 6
"""Number of nested calls that a visitor of syntax trees may need for each level of a tree."""


class Unexpected(Exception):
    """A line of a module is not one that the generator writes.

    Parameters
    ----------
    line
        Number of the line, counted from 1.
    reason
        What is wrong with it, in a few words.
    """

    def __init__(self, line: int, reason: str) -> None:
        super().__init__(line, reason)
        self.line, self.reason = line, reason


def refuse(node: ast.AST, reason: str) -> NoReturn:
    """Refuse the line of a syntax node."""
    raise Unexpected(getattr(node, "lineno", 1), reason)


def text_of(node: ast.AST) -> str:
    """Return a node in Python's own layout: two nodes with the same text are the same code."""
    try:
        return ast.unparse(node)
    except ValueError:  # an int of thousands of digits, some f-strings
        refuse(node, "has a value that cannot be written down")


@contextmanager
def recursing_through(*trees: ast.AST) -> Iterator[None]:
    """Allow functions to recurse through syntax trees, in which a long sum is nested once for each of its terms."""
    deepest, level = 0, list(trees)
    while level:
        deepest, level = deepest + 1, [child for node in level for child in ast.iter_child_nodes(node)]
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(before + CALLS_PER_LEVEL * deepest)
    try:
        yield
    finally:
        sys.setrecursionlimit(before)


class Body:
    """Checker of a function's body, statement by statement.

    Parameters
    ----------
    signature
        Arguments of the function and shape of its result.
    sizes
        Number behind each letter, see :func:`satsym.kernels.contract.sizes`.
    form
        ``"math"`` for a pointwise function on floats, ``"np"`` for one on arrays, ``"loop"``.
    returns
        Whether it returns something; only a loop may not.
    """

    def __init__(self, signature: Signature, sizes: Mapping[str, int], form: str, returns: bool) -> None:
        self.signature, self.form, self.returns = signature, form, returns
        self.module = "np" if form == "np" else "math"
        self.shape = tuple(sizes[letter] for letter in signature.shape)
        self.packed = {a: prod(sizes[c] for c in _GROUPS[a]) for a in signature.arguments if a in _GROUPS}
        self.numbers = {a for a in signature.arguments if a == "t"}
        self.nodes = {a for a in signature.arguments if a == "times"}
        self.midpoints: set[str] = set()
        self.stored: set[tuple[object, ...]] = set()
        self.taken = _KEPT | set(signature.arguments)
        self.steps = self.index = ""
        self.looped = self.allocated = self.repeated = False

    def check(self, statements: list[ast.stmt]) -> None:
        """Check the statements after the docstring."""
        last = statements[-1] if statements else None
        if self.returns and not isinstance(last, ast.Return):
            raise Unexpected(getattr(last, "lineno", 1), "ends without a return statement")
        for statement in statements:
            if statement is last and self.returns:
                self._result(statement)
            else:
                self._statement(statement)

    def _statement(self, node: ast.stmt) -> None:
        match node:
            case ast.Assign(targets=[ast.Tuple(elts=targets)], value=ast.Name(id=group)) if group in self.packed:
                self._unpack(node, targets, group)
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.BinOp(left=ast.Call(), right=ast.Constant())) if (
                self.form == "loop" and text_of(node.value) == "len(times) - 1"
            ):
                self.steps = self._new(node, name)
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                self._number(value)
                self.numbers.add(name if name in self.numbers else self._new(node, name))
            case ast.Assign(
                targets=[ast.Subscript(value=ast.Name(id="out"), slice=ast.Constant(value=place))],
                value=ast.Constant(value=float(number)),
            ) if self.allocated and not self.stored and place is ... and number == 0.0 and len(self.shape) == 2:
                self.stored |= {*product(*map(range, self.shape))}  # of a matrix that is zero for the most part
            case ast.Assign(targets=[ast.Subscript(value=ast.Name(id="out"), slice=place)], value=value) if (
                self.allocated
            ):
                self._number(value)
                self._store(place)
            case ast.Assign(targets=[ast.Subscript() as target], value=value):
                self._number(value)
                self._element(target)
            case ast.For(target=ast.Name(id=name), orelse=[]) if self.form == "loop" and not self.index:
                self._for(node, name)
            case ast.For(target=ast.Name(id="_"), orelse=[]) if self.form != "loop" and not self.repeated:
                self._repeat(node)
            case ast.If() if self.form == "np" and not self.allocated and text_of(node) == self._allocation():
                self.allocated = True
            case _:
                refuse(node, f"has a statement of an unsupported kind ({_kind(node)})")

    def _unpack(self, node: ast.stmt, targets: list[ast.expr], group: str) -> None:
        if len(targets) != self.packed[group]:
            refuse(node, f"unpacks {len(targets)} numbers from {group}, which has {self.packed[group]}")
        for target in targets:
            if not isinstance(target, ast.Name):
                refuse(node, "unpacks into something other than names")
            if self.form == "loop" and group in _NODES:
                self.nodes.add(self._new(node, target.id))
            elif self.form == "loop" and group in _MIDPOINTS:
                self.midpoints.add(self._new(node, target.id))
            else:
                self.numbers.add(self._new(node, target.id))

    def _new(self, node: ast.AST, name: str) -> str:
        """Give a name its one meaning."""
        if name in self.taken or "__" in name or not name.isascii():
            refuse(node, "gives a name another meaning")
        self.taken.add(name)
        return name

    def _for(self, node: ast.For, name: str) -> None:
        whole = (f"range({self.steps})", f"range({self.steps} - 1, -1, -1)")
        if self.looped or not self.steps or text_of(node.iter) not in whole:
            refuse(node, "has a loop other than the one over the steps")
        before = set(self.numbers)
        self.index = self._new(node, name)
        for statement in node.body:
            self._statement(statement)
        self.looped, self.index, self.numbers = True, "", before

    def _repeat(self, node: ast.For) -> None:
        """Check an iteration, in which numbers get names and new values."""
        match node.iter:
            case ast.Call(func=ast.Name(id="range"), args=[ast.Constant(value=int() as steps)], keywords=[]):
                if not 0 < steps <= MOST_REPEATED:
                    refuse(node, f"repeats more than {MOST_REPEATED} times")
            case _:
                refuse(node, "has a loop without a fixed number of steps")
        self.repeated = True
        for statement in node.body:
            if not (isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name)):
                refuse(statement, f"has a statement of an unsupported kind ({_kind(statement)})")
            self._statement(statement)
        self.repeated = False

    def _allocation(self) -> str:
        """Check how a batch form allocates its result."""
        arguments = self.signature.arguments
        sized = [a for a in arguments if a not in TUPLES and self.packed.get(a) != 0]
        parts = [f"np.shape({a}[0])" if a in self.packed else f"np.shape({a})" for a in sized]
        parts += [f"np.shape(p[{k}])" for k in range(self.packed["p"])] if self.signature.over_parameters else []
        types = [f"*{a}" if a in TUPLES else a for a in arguments]
        shape = f"({', '.join(map(str, self.shape))}, *shape)" if self.shape else "shape"
        return (
            f"if out is None:\n    shape = np.broadcast_shapes({', '.join(parts)})\n"
            f"    out = np.empty({shape}, np.result_type(float, {', '.join(types)}))"
        )

    def _store(self, place: ast.expr) -> None:
        """Check a store into an entry of the result of a batch form."""
        match place:
            case ast.Constant(value=value) if value is ...:
                entry: tuple[object, ...] = ()
            case ast.Constant(value=value):
                entry = (value,)
            case ast.Tuple(elts=[ast.Constant(value=row), ast.Constant(value=column)]):
                entry = (row, column)
            case _:
                refuse(place, "assigns to something other than an entry of the result")
        inside = (type(k) is int and 0 <= k < size for k, size in zip(entry, self.shape, strict=False))
        if len(entry) != len(self.shape) or not all(inside):
            refuse(place, "assigns to something other than an entry of the result")
        self.stored.add(entry)

    def _result(self, node: ast.stmt) -> None:
        assert isinstance(node, ast.Return)
        match node.value:
            case ast.Name(id="out") if self.allocated and len(self.stored) == prod(self.shape):
                pass
            case ast.Tuple(elts=entries) if self.form == "math" and self.shape and len(entries) == prod(self.shape):
                for entry in entries:
                    self._number(entry)
            case ast.expr() as value if self.form != "np" and not self.shape:
                self._number(value)
            case _:
                refuse(node, "returns a result of another shape")

    def _number(self, node: ast.expr) -> None:
        """Check an expression: a float, or an array of floats in a batch form.

        It loops instead of using generators: one frame a level.
        """
        match node:
            case ast.Constant(value=float()):
                pass
            case ast.Name(id=name) if name in self.numbers:
                pass
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                self._number(operand)
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div() | ast.Pow(), right=right):
                self._number(left)
                self._number(right)
            case ast.Subscript():
                self._element(node)
            case ast.Attribute(value=ast.Name(id=module), attr="pi") if module == self.module:
                pass
            case ast.Call(func=ast.Attribute(value=ast.Name(id=module), attr=name), args=arguments, keywords=[]) if (
                module == self.module and _FUNCTIONS[module].get(name) == len(arguments)
            ):
                for argument in arguments:
                    self._number(argument)
            case ast.Call(func=ast.Attribute(value=ast.Name(id="np"), attr="where"), args=arguments, keywords=[]) if (
                self.form == "np" and len(arguments) == 3
            ):
                match arguments[0]:
                    case ast.Compare(left=left, ops=[ast.Lt() | ast.LtE()], comparators=[right]):
                        for part in (left, right, *arguments[1:]):
                            self._number(part)
                    case _:
                        refuse(node, "has a comparison of an unsupported kind")
            case ast.IfExp(
                test=ast.Compare(left=left, ops=[ast.Lt() | ast.LtE() | ast.Gt() | ast.GtE()], comparators=[right])
            ) if self.form != "np":
                for part in (left, right, node.body, node.orelse):
                    self._number(part)
            case _:
                refuse(node, f"has an expression of an unsupported kind ({_kind(node)})")

    def _element(self, node: ast.Subscript) -> None:
        """Check an element of a sequence over nodes or midpoints, whose index must be inside."""
        inside: set[str] = set()
        if isinstance(node.value, ast.Name):
            if node.value.id in self.nodes:
                inside = {self.index, f"{self.index} + 1"} if self.index else {"0", self.steps}
            elif node.value.id in self.midpoints and self.index:
                inside = {self.index}
        if text_of(node.slice) not in inside:
            refuse(node, "has an index of an unsupported kind")


def _kind(node: ast.AST) -> str:
    """Return the common name of a syntax node, as far as Python has one."""
    if isinstance(node, ast.Constant):
        return f"a constant that is not a float, but {type(node.value).__name__}"
    if isinstance(node, ast.Name):
        return "a name without a value here"
    return type(node).__name__
