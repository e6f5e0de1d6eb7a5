"""A generated module run on balls: its own text, with decimals read as exact numbers."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from flint import arb, fmpq

from satsym.kernels import Kernels
from satsym.kernels.bodies import Unexpected, recursing_through
from satsym.kernels.checking import check
from satsym.kernels.loading import shipped_text
from satsym.proof.balls.arithmetic import Answers, BeyondProof, constant, mathematics

CONSTRAINTS = "terminal_constraints"
"""Name of the kernel function of the terminal constraints."""
ROUNDED = 15
"""Number of digits of a number in generated code from which it may be a rounded value."""


class BallKernel:
    """The functions of a generated module on power series of balls, as attributes.

    Parameters
    ----------
    model
        The kernels that floats are computed with.

    Raises
    ------
    BeyondProof
        If the module holds something that this does not run.
    """

    def __init__(self, model: Kernels) -> None:
        self.spec, self.answers = model.spec, Answers()
        self._definitions = _definitions(model)
        self._functions: dict[str, Callable[..., Any]] = {}
        self.timed = {name for name, node in self._definitions.items() if _reads_time(node)}
        """Names of the functions that depend on time."""

    def __getattr__(self, name: str) -> Callable[..., Any]:
        if name.startswith("_") or name not in self._definitions:
            raise AttributeError(name)
        if name not in self._functions:
            self._functions[name] = self._compiled(name)
        return self._functions[name]

    def cases(self, name: str) -> list[str]:
        """Return what a function compares or takes the absolute value of, as its text has it."""
        found = []
        for node in ast.walk(self._definitions[name]):
            if isinstance(node, ast.Compare):
                found.append(ast.unparse(node))
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "fabs":
                found.append(ast.unparse(node.args[0]))
        return found

    def _compiled(self, name: str) -> Callable[..., Any]:
        exact = _Exact(name)
        with recursing_through(self._definitions[name]):
            node = exact.visit(ast.parse(ast.unparse(self._definitions[name])).body[0])
            code = compile(ast.fix_missing_locations(ast.Module([node], [])), f"<{name} on balls>", "exec")
        namespace: dict[str, Any] = {
            "__builtins__": {},
            "math": mathematics(),
            "_below": lambda *args: self.answers.below(*args),
            "_magnitude": lambda *args: self.answers.magnitude(*args),
            **{key: constant(exactly(number)) for key, number in exact.numbers.items()},
        }
        exec(code, namespace)  # noqa: S102 - a function of a module that was checked node by node
        return namespace[name]


def exactly(number: Fraction) -> Any:
    """Return a rational number as a ball."""
    return arb(fmpq(number.numerator, number.denominator))


def _definitions(model: Kernels) -> Mapping[str, ast.FunctionDef]:
    """Return the pointwise functions of a module by name."""
    text = model.text
    if text is None and model.origin is not None and model.origin[1] is None:
        text = shipped_text(model.origin[0])
    if not text:
        raise BeyondProof("kernels without the text of a generated module")
    try:
        spec, functions = check(text)
    except Unexpected as error:
        raise BeyondProof(f"a generated module whose line {error.line} {error.reason}") from None
    if spec != model.spec:
        raise BeyondProof("a model whose terminal constraints were changed")
    found = {node.name: node for node in functions if not node.name.endswith("_batch")}
    if spec.multipliers:
        found[CONSTRAINTS] = _constraints(found["boundary"], len(spec.states), len(spec.multipliers))
    return found


def _constraints(boundary: ast.FunctionDef, first: int, count: int) -> ast.FunctionDef:
    """Return the function of time, states and parameters that has only the constraints at the end.

    A module states them together with transversality in one function of residuals. Their expressions are taken from it,
    which may depend on nothing else.
    """
    *body, last = boundary.body
    if not (isinstance(last, ast.Return) and isinstance(last.value, ast.Tuple)):
        raise BeyondProof("terminal constraints in a function of an unsupported form")
    wanted = ast.Tuple(last.value.elts[first : first + count], ast.Load())
    needed = _names(wanted, ast.Load)
    kept: list[ast.stmt] = [ast.Return(wanted)]
    for node in reversed(body):
        if not _names(node, ast.Store) & needed:
            continue
        if not isinstance(node, ast.Assign):
            raise BeyondProof("terminal constraints that are defined piecewise")
        kept.insert(0, node)
        needed |= _names(node.value, ast.Load)
    if needed & {"lam", "nu", "bounds", "final"}:
        raise BeyondProof("terminal constraints that depend on more than states, time and parameters")
    made = ast.parse(f"def {CONSTRAINTS}(t, x, p): pass").body[0]
    assert isinstance(made, ast.FunctionDef)
    made.body = kept
    return ast.fix_missing_locations(made)


def _names(node: ast.AST, use: type[ast.expr_context]) -> set[str]:
    return {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, use)}


def _reads_time(node: ast.FunctionDef) -> bool:
    return any(isinstance(n, ast.Name) and n.id == "t" and isinstance(n.ctx, ast.Load) for n in ast.walk(node))


class _Exact(ast.NodeTransformer):
    """Replaces numbers by names of exact constants, and comparisons and absolute values by calls that note them."""

    def __init__(self, function: str) -> None:
        self.function, self.compared = function, 0
        self.numbers: dict[str, Fraction] = {}

    def _key(self) -> ast.Tuple:
        self.compared += 1
        return ast.Tuple([ast.Constant(self.function), ast.Constant(self.compared)], ast.Load())

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        if not isinstance(node.value, int | float):
            return node  # a docstring
        number = Fraction(repr(node.value))
        digits = repr(node.value).partition("e")[0].replace(".", "").strip("0")
        if number != Fraction(node.value) and len(digits) >= ROUNDED:
            raise BeyondProof(f"a constant in the equations of motion that might be rounded, {node.value!r}")
        name = f"_number_{len(self.numbers)}"
        self.numbers[name] = number
        return ast.Name(name, ast.Load())

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        a, b = (self.visit(side) for side in (node.left, node.comparators[0]))
        match node.ops:
            case [ast.Lt() | ast.LtE()]:
                pair = [a, b]
            case [ast.Gt() | ast.GtE()]:
                pair = [b, a]
            case _:
                raise BeyondProof("a comparison of an unsupported kind")
        return ast.Call(ast.Name("_below", ast.Load()), [self._key(), *pair], [])

    def visit_Call(self, node: ast.Call) -> ast.AST:
        self.generic_visit(node)
        if isinstance(node.func, ast.Attribute) and node.func.attr == "fabs":
            return ast.Call(ast.Name("_magnitude", ast.Load()), [self._key(), *node.args], [])
        return node

    def visit_For(self, node: ast.For) -> ast.AST:
        raise BeyondProof("a control law that is evaluated by iteration")
