"""Modules and functions that a printed program may use, and limits on the size of its values.

A small part of NumPy, SciPy and matplotlib is supported; drawing is only recorded. Sizes are checked before values are
created.
"""

from __future__ import annotations

import ast
import math
import operator
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from satsym.formula import budget
from satsym.formula.budget import OverBudget
from satsym.status import BadInput
from satsym.wording import shown

MAX_SIZE = 100_000
"""Largest number of entries of an array or list, or of characters of a text.

The shipped programs have arrays of up to 3000 entries.
"""


def made(count: int) -> None:
    """Count the entries of a value that is about to be created by a printed program.

    Raises
    ------
    OverBudget
        If the value has too many entries.
    """
    if count > MAX_SIZE:
        raise OverBudget(f"an array, a list or a text of more than {MAX_SIZE:,} entries")
    budget.charge(numbers=count)


def broadcast(one: Any, other: Any) -> None:
    """Count the entries of the result of an operation on arrays or numbers, as a limit on the work of a program."""
    made(math.prod(np.broadcast_shapes(np.shape(one), np.shape(other))))


def indexed(owner: Any, place: Any) -> None:
    """Count the entries that lists of indices select from an array of a program; slices count nothing."""
    parts = place if isinstance(place, tuple) else (place,)
    picked = math.prod(max(1, extent(part)) for part in parts if isinstance(part, list | np.ndarray))
    if picked > 1:
        made(picked * (owner.size // max(1, owner.shape[0]) if len(parts) == 1 and owner.ndim else owner.size))


def formatted(parts: Sequence[str]) -> str:
    """Return texts joined to one text, after its length is counted."""
    made(sum(map(len, parts)))
    return "".join(parts)


def numeric(value: Any) -> Any:
    """Return numbers, or nested lists of numbers, as an array."""
    if not isinstance(value, np.ndarray):
        _refuse_others(value)
        made(extent(value))
    return np.asarray(value)


def extent(value: Any, known: dict[int, int] | None = None) -> int:
    """Return the number of entries of a value including nested values, each counted as often as it occurs."""
    if isinstance(value, np.ndarray):
        return int(value.size)
    if isinstance(value, str):
        return len(value)
    if not isinstance(value, list | tuple):
        return 1
    sizes = {} if known is None else known
    if id(value) not in sizes:
        sizes[id(value)] = 1 + sum(extent(entry, sizes) for entry in value)
    return sizes[id(value)]


def _refuse_others(value: Any) -> None:
    if isinstance(value, list | tuple):
        for entry in value:
            _refuse_others(entry)
    elif not isinstance(value, int | float | complex | np.number | np.ndarray):
        raise BadInput(f"the entries of an array must be numbers, not {type(value).__name__}")


MAX_STATES = 100
"""Largest number of states of an initial value problem.

Implicit methods solve linear equations of that size in each step.
"""
DRAWING = frozenset("figure plot scatter title xlabel ylabel legend grid axis show savefig".split())
BINARY: Mapping[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
COMPARED: Mapping[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.LtE: operator.le,
    ast.Lt: operator.lt,
    ast.GtE: operator.ge,
    ast.Gt: operator.gt,
    ast.Eq: operator.eq,
}
_KEYWORDS = frozenset({"t_eval", "rtol", "atol", "method"})


@dataclass(frozen=True)
class Drawing:
    """A call of a function of matplotlib with its arguments."""

    name: str
    arguments: tuple[Any, ...]
    named: Mapping[str, Any]


@dataclass(frozen=True)
class Module:
    """A module, or the result of ``solve_ivp``: attributes by name."""

    name: str
    attributes: Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class Run:
    """Result of a program: its variables, printed lines and drawings."""

    values: dict[str, Any]
    said: list[str] = field(default_factory=list)
    drawn: list[Drawing] = field(default_factory=list)


def modules(left: Run) -> Mapping[str, Module]:
    """Return the modules that a program may import, by their full names."""
    numpy = Module(
        "numpy",
        {
            "sqrt": _sqrt,
            "array": _array,
            "hstack": _hstack,
            "linspace": lambda first, last, number: np.linspace(first, last, _shape(number)[0]),
            "zeros": lambda shape: np.zeros(_shape(shape)),
            "eye": lambda n: np.eye(_shape((n, n))[0]),
            "linalg": Module("numpy.linalg", {"norm": lambda a: np.linalg.norm(numeric(a))}),
            "pi": math.pi,
        },
    )
    draw = {name: _noted(left, name) for name in DRAWING}
    return {
        "numpy": numpy,
        "matplotlib.pyplot": Module("matplotlib.pyplot", draw),
        "scipy.integrate": Module("scipy.integrate", {"solve_ivp": _solve_ivp}),
        "scipy.linalg": Module("scipy.linalg", {"eig": _eig}),
    }


def builtins(left: Run) -> Mapping[str, Any]:
    """Return the functions that are available without import."""
    return {
        "all": all,
        "any": any,
        "abs": abs,
        "len": len,
        "print": lambda *a: left.said.append(formatted([" ".join(map(str, a))])),
    }


def _shape(shape: object) -> tuple[int, ...]:
    sizes = shape if isinstance(shape, tuple) else (shape,)
    if not all(isinstance(n, int) and 0 <= n <= MAX_SIZE for n in sizes) or math.prod(sizes) > MAX_SIZE:
        if not all(isinstance(n, int) for n in sizes):
            raise TypeError(f"an array of the size {shown(shape)}")
        made(max([0, *sizes]) if min([0, *sizes]) < 0 else math.prod(sizes))
        raise ValueError("an array of a negative size")
    made(math.prod(sizes))
    return sizes


def _array(entries: object) -> Any:
    found = numeric(entries)
    return np.asarray(found, dtype=np.result_type(found, float))


def _sqrt(*arguments: Any, **named: Any) -> Any:
    if len(arguments) != 1 or named:
        raise BadInput("np.sqrt is supported with one positional argument only")
    return np.sqrt(numeric(arguments[0]))


def _hstack(parts: Sequence[Any]) -> Any:
    found = [numeric(part) for part in parts]
    made(sum(part.size for part in found))
    return np.hstack(found)


def _noted(left: Run, name: str) -> Callable[..., None]:
    def note(*arguments: Any, **named: Any) -> None:
        left.drawn.append(Drawing(name, arguments, named))

    return note


def _eig(matrix: Any) -> tuple[Any, Any]:
    from scipy import linalg

    found = numeric(matrix)
    budget.charge(numbers=max((0, *found.shape)) ** 3)
    values, vectors = linalg.eig(found)
    return values, vectors


def _solve_ivp(rates: Callable[..., Any], span: Any, start: Any, **named: Any) -> Module:
    from scipy import integrate

    if unknown := set(named) - _KEYWORDS:
        raise BadInput(
            f"solve_ivp is not supported with {', '.join(sorted(unknown))}; supported arguments are "
            f"{', '.join(sorted(_KEYWORDS))}"
        )
    count = numeric(start).size
    if count > MAX_STATES:
        raise OverBudget(f"solve_ivp with more than {MAX_STATES} states")
    made(count * numeric(named.get("t_eval", ())).size)

    def counted(t: float, y: Any) -> Any:
        budget.charge(numbers=10 * count)
        return rates(t, y)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # such as a tolerance that is raised to what is possible
        done = integrate.solve_ivp(counted, span, start, **named)
    if not done.success:
        raise BadInput(f"solve_ivp: {done.message}")
    return Module("solution", {"t": done.t, "y": done.y})
