"""The type of arrays of numbers: their shapes stand in docstrings, their last axis counts times or instances."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.floating[Any]]
T = TypeVar("T")


def distinct(values: ArrayLike) -> NDArray[Any]:
    """The different ones of some numbers, none of them nan, in order; unlike NumPy's, loading no masked arrays."""
    ordered = np.sort(values, axis=None, kind="stable")  # which is quick where most are in order
    return ordered[np.append(True, ordered[1:] != ordered[:-1])[: ordered.size]]


def kept(function: Callable[..., T]) -> Callable[..., T]:
    """Keep what a function of arrays, and other values, has given, by what is in them."""
    known: dict[Any, T] = {}

    @wraps(function)
    def asked(*arguments: Any, **named: Any) -> T:
        key = (*map(_key, arguments), *((name, _key(argument)) for name, argument in named.items()))
        if key not in known:
            known[key] = function(*arguments, **named)
        return known[key]

    return asked


def _key(argument: Any) -> Any:
    if isinstance(argument, np.ndarray):
        return argument.tobytes(), argument.shape, argument.dtype.str
    return tuple(map(_key, argument)) if isinstance(argument, list) else argument
