"""Generated functions with any number of digits: their very text, with mpmath in the place of ``math`` and ``np``.

A constant is the number that the generator wrote down, of which the text has the first 17 digits, or the decimal that
stands there.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any

import mpmath as mp

from satsym.agreement import MOST

Function = Callable[..., Any]


def functions_of(text: str, written: Mapping[float, Any]) -> dict[str, Function]:
    """The functions of a module by name, in the working precision of mpmath.

    Parameters
    ----------
    text
        Of a module that :func:`satsym.kernels.from_text` has accepted.
    written
        Floats -> the numbers that they are the nearest ones of, where these are known.
    """
    constants = _Constants(written)
    body = [constants.visit(node) for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)]
    module = ast.fix_missing_locations(ast.Module(body, []))
    names: dict[str, Any] = {
        "__builtins__": {"len": len, "range": range},
        "math": SimpleNamespace(**_SHARED, **_OF_FLOATS),
        "np": SimpleNamespace(**_SHARED, **_OF_ARRAYS),
        **constants.values,
    }
    exec(compile(module, "<generated>", "exec"), names)  # noqa: S102 - definitions only, each of them checked
    return {node.name: names[node.name] for node in body}


class _Constants(ast.NodeTransformer):
    """Gives floats in a text names, by which they are found with all their digits."""

    def __init__(self, written: Mapping[float, Any]) -> None:
        self.written = written
        self.values: dict[str, Any] = {}

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        """A name in the place of a float."""
        if not isinstance(node.value, float):
            return node
        name = f"_number_{node.value!r}".replace(".", "_").replace("-", "_minus_").replace("+", "")
        if name not in self.values:
            with mp.workdps(2 * MOST):
                self.values[name] = self.written.get(node.value, mp.mpf(repr(node.value)))
        return ast.copy_location(ast.Name(name, ast.Load()), node)


def _real(function: Function) -> Function:
    """No number where the function has no real one."""

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
