"""What propositions measure: quantities of models, instances, motions, families and printed programs, by name.

A measurement is a function that returns a number, a list, a matrix, a record (a state, a trajectory), or a property
that textbooks name, of what it is given. It never sees what is printed and gives no verdict. It lives in a module of
this package and is entered by the decorator :func:`measurement`; :func:`value` enters a family or a convention.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Collection
from functools import cache
from typing import Any, TypeVar

from satsym.auditing.propositions.reading import Words

F = TypeVar("F", bound=Callable[..., Any])
_FUNCTIONS: dict[str, Callable[..., Any]] = {}
_VALUES: dict[str, Callable[[], Any]] = {}


def measurement(function: F) -> F:
    """Enter a measurement under its own name; a name that Python has already ends with an underscore."""
    _entered(function, function.__name__.rstrip("_"), _FUNCTIONS)
    return function


def value(function: F) -> F:
    """Enter a family, a convention or a constant, under its name in capitals."""
    _entered(cache(function), function.__name__.upper(), _VALUES)
    return function


def words(symbols: Collection[str] = ()) -> Words:
    """What a proposition may name, in a notation with these symbols."""
    _load()
    return Words(_FUNCTIONS, _VALUES, symbols)


@cache
def _load() -> None:
    for module in pkgutil.iter_modules(__path__):
        importlib.import_module(f"{__name__}.{module.name}")


def _entered(function: Callable[..., Any], name: str, registry: dict[str, Any]) -> None:
    if name in registry:
        raise ValueError(f"two measurements are called {name}")
    registry[name] = function
