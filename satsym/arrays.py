"""The type of arrays of numbers: shapes are stated in docstrings, the last axis counts times or instances."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.floating[Any]]
T = TypeVar("T")


def distinct(values: ArrayLike) -> NDArray[Any]:
    """Return the distinct numbers of some, none of them nan, in order; unlike NumPy's, without masked arrays."""
    ordered = np.sort(values, axis=None, kind="stable")  # which is quick where most are in order
    return ordered[np.append(True, ordered[1:] != ordered[:-1])[: ordered.size]]


def kept(function: Callable[..., T]) -> Callable[..., T]:
    """Cache the results of a function of arrays and other values, by their contents."""
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
