"""The type of arrays of numbers: their shapes stand in docstrings, their last axis counts times or instances."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.floating[Any]]
T = TypeVar("T")


def kept(function: Callable[..., T]) -> Callable[..., T]:
    """Keep what a function of arrays, and other values, has given, by what is in them."""
    known: dict[Any, T] = {}

    @wraps(function)
    def asked(*arguments: Any) -> T:
        key = tuple((a.tobytes(), a.shape) if isinstance(a, np.ndarray) else a for a in arguments)
        if key not in known:
            known[key] = function(*arguments)
        return known[key]

    return asked
