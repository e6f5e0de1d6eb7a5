"""What a printed program may import and call: a little of NumPy, SciPy and matplotlib; drawing is only noted down."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from satsym.status import BadInput
from satsym.wording import shown

MAX_SIZE = 100_000
"""Entries of an array."""
DRAWING = frozenset("figure plot scatter title xlabel ylabel legend grid axis show savefig".split())
_KEYWORDS = frozenset({"t_eval", "rtol", "atol", "method"})


@dataclass(frozen=True)
class Drawing:
    """A call of matplotlib's: what was called, with which arguments."""

    name: str
    arguments: tuple[Any, ...]
    named: Mapping[str, Any]


@dataclass(frozen=True)
class Module:
    """A module, or what ``solve_ivp`` returns: attributes by name."""

    name: str
    attributes: Mapping[str, Any]


@dataclass
class Outside:
    """What a program leaves behind beside its variables: printed lines, drawings, and how often rates were asked."""

    said: list[str] = field(default_factory=list)
    drawn: list[Drawing] = field(default_factory=list)
    evaluations: list[int] = field(default_factory=list)


def modules(outside: Outside) -> Mapping[str, Module]:
    """The modules that a program may import, by their full names."""
    numpy = Module(
        "numpy",
        {
            "sqrt": np.sqrt,
            "array": _array,
            "hstack": _hstack,
            "linspace": _linspace,
            "zeros": lambda shape: np.zeros(_shape(shape)),
            "eye": lambda n: np.eye(_shape((n, n))[0]),
            "linalg": Module("numpy.linalg", {"norm": lambda a: np.linalg.norm(np.asarray(a))}),
            "pi": math.pi,
        },
    )
    draw = {name: _noted(outside, name) for name in DRAWING}
    return {
        "numpy": numpy,
        "matplotlib.pyplot": Module("matplotlib.pyplot", draw),
        "scipy.integrate": Module("scipy.integrate", {"solve_ivp": _solver(outside)}),
        "scipy.linalg": Module("scipy.linalg", {"eig": _eig}),
    }


def builtins(outside: Outside) -> Mapping[str, Any]:
    """Functions that need no import."""
    return {
        "all": all,
        "any": any,
        "abs": abs,
        "len": len,
        "print": lambda *a: outside.said.append(" ".join(map(str, a))),
    }


def _shape(shape: object) -> tuple[int, ...]:
    sizes = shape if isinstance(shape, tuple) else (shape,)
    if not all(isinstance(n, int) and 0 <= n <= MAX_SIZE for n in sizes) or math.prod(sizes) > MAX_SIZE:
        raise BadInput(f"an array of the size {shown(shape)}; at most {MAX_SIZE} entries are read")
    return sizes


def _array(entries: object) -> Any:
    return np.asarray(entries, dtype=np.result_type(np.asarray(entries), float))


def _hstack(parts: Sequence[Any]) -> Any:
    if sum(np.size(part) for part in parts) > MAX_SIZE:
        raise BadInput(f"an array of more than {MAX_SIZE} entries")
    return np.hstack(parts)


def _linspace(first: float, last: float, number: int) -> Any:
    return np.linspace(first, last, _shape(number)[0])


def _noted(outside: Outside, name: str) -> Callable[..., None]:
    def note(*arguments: Any, **named: Any) -> None:
        outside.drawn.append(Drawing(name, arguments, named))

    return note


def _eig(matrix: Any) -> tuple[Any, Any]:
    from scipy import linalg

    values, vectors = linalg.eig(np.asarray(matrix))
    return values, vectors


def _solver(outside: Outside) -> Callable[..., Module]:
    def solve_ivp(rates: Callable[..., Any], span: Any, start: Any, **named: Any) -> Module:
        from scipy import integrate

        if unknown := set(named) - _KEYWORDS:
            raise BadInput(f"solve_ivp with {', '.join(sorted(unknown))}; known are {', '.join(sorted(_KEYWORDS))}")
        done = integrate.solve_ivp(rates, span, start, **named)
        if not done.success:
            raise BadInput(f"solve_ivp: {done.message}")
        outside.evaluations.append(int(done.nfev))
        return Module("solution", {"t": done.t, "y": done.y})

    return solve_ivp
