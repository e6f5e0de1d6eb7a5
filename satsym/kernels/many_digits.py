"""Generated functions with any number of digits: their own text, with mpmath in place of ``math`` and ``np``.

Where terms cancel, floats keep nothing but rounding errors, which differ between two forms of a function and are not
the derivative of anything. The text of the functions shows their values without rounding. A constant is the number that
the generator wrote down, of which the text has the first 17 digits, or the decimal in the text.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from types import SimpleNamespace
from typing import Any

import mpmath as mp
import numpy as np

from satsym.agreement import MOST_DIGITS, NEGLIGIBLE_FRACTION, Sides, slopes
from satsym.arrays import Array
from satsym.kernels import plain
from satsym.kernels.bodies import recursing_through
from satsym.kernels.contract import BATCH
from satsym.kernels.core import Function
from satsym.kernels.evaluation import Evaluation, Relation
from satsym.spec import ProblemSpec

DIGITS = 60
"""Number of digits of derivatives; values are computed with twice as many."""

NO_NUMBERS = (ArithmeticError, ValueError, TypeError)
"""Errors that functions raise outside their domain."""

Place = Mapping[str, Any]
"""Arguments by name: numbers, and tuples of numbers."""


def functions_of(text: str, written: Mapping[float, Any]) -> dict[str, Function]:
    """Return the functions of a module by name, in the working precision of mpmath.

    Parameters
    ----------
    text
        Text of a module that :func:`satsym.kernels.from_text` has accepted.
    written
        Floats -> the numbers that they are the nearest ones of, where these are known.
    """
    return _defined([node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)], written, {})


def watched(text: str, written: Mapping[float, Any]) -> dict[str, tuple[Function, dict[int, Any]]]:
    """Return the functions of a module that have conditions, each with the record that its calls fill.

    The record contains, by the number of a condition in the function, the difference of the two sides of the condition.
    Conditions are comparisons, steps, choices of the smaller or larger number, and zero times a root, which is
    undefined where the law is. Conditions within an iteration are left out, and so are statements on which no condition
    depends: the functions serve to evaluate conditions and return nothing.
    """
    found = {}
    for node in ast.parse(text).body:
        if isinstance(node, ast.FunctionDef):
            watching = _Watched()
            with recursing_through(node):
                changed, seen = watching.visit(node), dict[int, Any]()
            if watching.count:
                note = {_Watched.NOTE: _noting(seen)}
                changed.body = _needed(changed.body)
                found[node.name] = _defined([changed], written, note)[node.name], seen
    return found


def _needed(body: Sequence[ast.stmt]) -> list[ast.stmt]:
    """Return the statements that evaluate a watched condition, and those on which they depend."""
    kept: list[ast.stmt] = []
    names: set[str] = set()
    for statement in reversed(body):
        assigned = {name.id for node in ast.walk(statement) for name in _assigned(node)}
        used = {node.id for node in ast.walk(statement) if isinstance(node, ast.Name)}
        if _Watched.NOTE in used or assigned & names:
            kept.append(statement)
            names |= used - (assigned - names)
    return kept[::-1]


def _assigned(node: ast.AST) -> Iterator[ast.Name]:
    """Return the name that a node assigns to, or to an element of which it assigns."""
    if isinstance(node, ast.Name | ast.Subscript) and isinstance(node.ctx, ast.Store):
        named = node.value if isinstance(node, ast.Subscript) else node
        if isinstance(named, ast.Name):
            yield named


def _noting(seen: dict[int, Any]) -> Function:
    """Return a function that records the difference of two numbers and returns the first."""

    def note(number: int, left: Any, right: Any) -> Any:
        seen[number] = left - right
        return left

    return note


def _defined(
    body: list[ast.FunctionDef], written: Mapping[float, Any], besides: Mapping[str, Any]
) -> dict[str, Function]:
    """Return the functions of syntax trees by name, in the working precision of mpmath."""
    constants = _Constants(written)
    with recursing_through(*body):
        body = [constants.visit(node) for node in body]
    names: dict[str, Any] = {
        "__builtins__": {"len": len, "range": range},
        "math": SimpleNamespace(**_SHARED, **_OF_FLOATS),
        "np": SimpleNamespace(**_SHARED, **_OF_ARRAYS),
        **constants.values,
        **besides,
    }
    module = ast.Module(list(body), [])
    with recursing_through(module):
        code = compile(ast.fix_missing_locations(module), "<generated>", "exec")
    exec(code, names)  # noqa: S102 - definitions only, each of them checked
    return {node.name: names[node.name] for node in body}


@dataclass(frozen=True, eq=False)
class LongEvaluation(Evaluation):
    """An evaluation whose values and derivatives are computed with many digits and then rounded.

    Floats are kept where the text has no numbers: arrays may compute, beyond a condition, values that are not used.
    """

    @cached_property
    def text(self) -> dict[str, Function]:
        """Return the functions by name, in the working precision of mpmath."""
        return functions_of(self.kernels.text or "", {})

    def single(self, name: str) -> Function:
        """Return the form on floats of a function."""

        def function(*given: Any) -> tuple[float, ...]:
            with mp.workdps(2 * DIGITS):
                found = self.text[name](*map(exactly, given))
            return tuple(_rounded(found if isinstance(found, tuple) else (found,)))

        return function

    def _value(self, name: str, at: Mapping[str, Any], columns: int) -> Array:
        found = super()._value(name, at, columns)
        for k in range(columns):
            self._put(found[..., k], 2 * DIGITS, partial(self._numbers, name, self._place(name, at, k, columns)))
        return found

    def _slopes(self, name: str, by: Sequence[str], instead: Mapping[str, Any]) -> dict[str, Array]:
        found = super()._slopes(name, by, instead)
        columns = len(self.at["t"])
        for k in range(columns):
            place = self._place(name, {**self.at, **instead}, k, columns)
            for argument, table in found.items():
                for component in range(table.shape[-2]):
                    moved = partial(self._moved, name, place, argument, component)
                    self._put(table[..., component, k], DIGITS, partial(slopes, moved))
        return found

    def _place(self, name: str, at: Mapping[str, Any], column: int, columns: int) -> dict[str, Any]:
        """Return the arguments of a function in one column as numbers of mpmath."""
        found: dict[str, Any] = {}
        for a in self.signatures[name].arguments:
            table = np.asarray(at[a], dtype=float).reshape(-1, columns)[:, column]
            found[a] = mp.mpf(table[0]) if a == "t" else tuple(map(mp.mpf, table))
        return found

    def _numbers(self, name: str, place: Place) -> list[Any]:
        out = np.empty(self._shapes[name], dtype=object)
        self.text[name + BATCH](*place.values(), out)
        return out.ravel().tolist()

    def _moved(self, name: str, place: Place, argument: str, component: int, by: Any) -> list[Any]:
        """Return the values of a function where one component of an argument is changed."""
        value = place[argument]
        if isinstance(value, tuple):
            moved: Any = tuple(v + by if i == component else v for i, v in enumerate(value))
        else:
            moved = value + by
        return self._numbers(name, {**place, argument: moved})

    @staticmethod
    def _put(into: Array, digits: int, numbers: Callable[[], Sequence[Any]]) -> None:
        """Round numbers into a part of a table, if they exist."""
        try:
            with mp.workdps(digits):
                found = _rounded(numbers())
        except NO_NUMBERS:
            return
        if not any(map(np.isnan, found)):
            into[...] = np.reshape(found, into.shape)


def of_loops(of: LongEvaluation, place: Place, along: tuple[Array, Array, Array]) -> Iterator[Relation]:
    """Return generated and plain loops, as :func:`loops`, where the rates have numbers."""
    for name, sides in loops(of.kernels.spec, of.text, place, along).items():
        try:
            left, right = (np.array([_rounded(side)]).T for side in sides(2 * DIGITS))
        except NO_NUMBERS:
            continue
        yield Relation(name, "the loop of textbooks", left, right)


def loops(
    spec: ProblemSpec, text: Mapping[str, Function], place: Place, along: tuple[Array, Array, Array]
) -> dict[str, Callable[[int], Sides]]:
    """Return, by name of the loop, functions from digits to results of the generated and of a plain loop.

    Parameters
    ----------
    text
        The functions by name, as :func:`functions_of` makes them.
    place
        Initial states, final costates, and parameters.
    along
        Times, and controls at these and between them, shapes (N+1,), (m, N+1) and (m, N).
    """
    one: Any = SimpleNamespace(spec=spec, **text)
    n, steps = len(spec.states), len(along[0]) - 1

    def blank() -> tuple[Any, Any]:
        return tuple([mp.nan] * (steps + 1) for _ in range(n)), tuple([mp.nan] * steps for _ in range(n))

    def rows(table: Array) -> tuple[list[Any], ...]:
        return tuple(row.tolist() for row in table)

    def given() -> tuple[Any, ...]:
        return *(_to_objects(values) for values in along), *(exactly(place[a]) for a in ("x", "lam", "p"))

    def forward(count: int) -> Sides:
        with mp.workdps(count):
            times, u, u_mid, x0, _, p = given()
            x, x_mid = blank()
            cost = text["forward"](times.tolist(), x0, rows(u), rows(u_mid), p, x, x_mid)
            exact, exact_mid, total = plain.forward(one, times, x0, u, u_mid, p)
            found = [v for row in (*x, *x_mid) for v in row]
            return [*found, cost or 0], [*exact.flat, *exact_mid.flat, total]

    def backward(count: int) -> Sides:
        with mp.workdps(count):
            times, u, u_mid, x0, lam_f, p = given()
            x, x_mid, _ = plain.forward(one, times, x0, u, u_mid, p)
            lam, lam_mid = blank()
            text["backward"](times.tolist(), lam_f, *map(rows, (x, x_mid, u, u_mid)), p, lam, lam_mid)
            exact = plain.backward(one, times, lam_f, x, x_mid, u, u_mid, p)
            return [v for row in (*lam, *lam_mid) for v in row], [v for table in exact for v in table.flat]

    def symplectic(count: int) -> Sides:
        with mp.workdps(count):
            times, *_, x0, _, p = given()
            x, _ = blank()
            text["symplectic"](times.tolist(), x0, p, x)
            return [v for row in x for v in row], [*plain.symplectic(one, times, x0, p).flat]

    found = {"forward": forward, "backward": backward, "symplectic": symplectic}
    return {name: loop for name, loop in found.items() if name in text}


def exactly(value: Any) -> Any:
    """Convert a value, or several, to numbers of mpmath."""
    return tuple(map(mp.mpf, value)) if isinstance(value, tuple) else mp.mpf(value)


def _to_objects(values: Array) -> Any:
    """Return an array of mpmath numbers."""
    found = np.empty(values.size, dtype=object)
    found[:] = [mp.mpf(float(v)) for v in values.flat]
    return found.reshape(values.shape)


def _rounded(values: Sequence[Any]) -> list[float]:
    """Round numbers to floats; numbers that are negligible because terms cancelled become zero."""
    faint = NEGLIGIBLE_FRACTION * max((abs(v) for v in values if abs(v) < mp.inf), default=1)
    return [0.0 if abs(v) <= max(faint, NEGLIGIBLE_FRACTION) else float(v) for v in values]


class _Constants(ast.NodeTransformer):
    """Gives the floats in a text names, by which they are found with all their digits."""

    def __init__(self, written: Mapping[float, Any]) -> None:
        self.written = written
        self.values: dict[str, Any] = {}

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        """Replace a float by a name."""
        if not isinstance(node.value, float):
            return node
        name = f"_number_{node.value!r}".replace(".", "_").replace("-", "_minus_").replace("+", "")
        if name not in self.values:
            with mp.workdps(2 * MOST_DIGITS):
                self.values[name] = self.written.get(node.value, mp.mpf(repr(node.value)))
        return ast.copy_location(ast.Name(name, ast.Load()), node)


class _Watched(ast.NodeTransformer):
    """Passes the left side of each condition through a function that records the difference of both sides."""

    NOTE = "_note_condition"
    CHOICES = frozenset({"np.minimum", "np.maximum"})

    def __init__(self) -> None:
        self.count = 0

    def visit_For(self, node: ast.For) -> ast.AST:
        """Leave a loop as it is: nothing in an iteration is watched."""
        return node

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        """Watch a comparison of numbers."""
        self.generic_visit(node)
        if not isinstance(node.ops[0], ast.Is):
            node.left = self._noted(node.left, node.comparators[0])
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """Watch a step, or a choice of the smaller or larger number."""
        self.generic_visit(node)
        function = ast.unparse(node.func)
        if function == "np.heaviside":
            node.args[0] = self._noted(node.args[0], ast.Constant(0))
        elif function in self.CHOICES:
            node.args[0] = self._noted(*node.args)
        return node

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """Watch a value that is undefined where it is negative: ``0.0*sqrt(...)``."""
        self.generic_visit(node)
        root = node.right
        nothing = isinstance(node.left, ast.Constant) and node.left.value == 0.0
        if nothing and isinstance(root, ast.Call) and ast.unparse(root.func).endswith(".sqrt"):
            root.args[0] = self._noted(root.args[0], ast.Constant(0))
        return node

    def _noted(self, left: ast.expr, right: ast.expr) -> ast.expr:
        self.count += 1
        return ast.Call(ast.Name(self.NOTE, ast.Load()), [ast.Constant(self.count - 1), left, right], [])


def _real(function: Function) -> Function:
    """Return a real function whose value is NaN where the function has no real one."""

    def value(*arguments: Any) -> Any:
        found = function(*arguments)
        return mp.nan if mp.im(found) else mp.re(found)

    return value


def _heaviside(value: Any, at_zero: Any) -> Any:
    return at_zero if value == 0 else mp.nan if value != value else mp.mpf(value > 0)


_SHARED = {name: _real(getattr(mp, name)) for name in "sin cos tan sinh cosh tanh exp log sqrt".split()}
_SHARED["pi"] = mp.pi
_OF_FLOATS = {
    "asin": _real(mp.asin),
    "acos": _real(mp.acos),
    "atan": mp.atan,
    "atan2": mp.atan2,
    "fabs": abs,
}
_OF_ARRAYS = {
    "arcsin": _real(mp.asin),
    "arccos": _real(mp.acos),
    "arctan": mp.atan,
    "arctan2": mp.atan2,
    "abs": abs,
    "real": mp.re,
    "minimum": lambda a, b: b if b < a or b != b else a,
    "maximum": lambda a, b: b if b > a or b != b else a,
    "where": lambda condition, one, other: one if condition else other,
    "heaviside": _heaviside,
}
