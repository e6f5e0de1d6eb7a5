"""Measurements: functions for propositions about models, instances, motions, families and printed programs.

A measurement returns a number, list, matrix, record (e.g. a state or trajectory), or a property with a textbook name.
It never sees what is printed, and gives no verdict. Each public function in a module of this package is a measurement;
a function without parameters is a family, convention or constant and is evaluated once.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Callable, Collection
from functools import cache
from typing import Any

from satsym.auditing.propositions.reading import Words

_FUNCTIONS: dict[str, Callable[..., Any]] = {}
_VALUES: dict[str, Callable[[], Any]] = {}


def words(symbols: Collection[str] = ()) -> Words:
    """Return the words that a proposition may use in a notation with the given symbols."""
    _load()
    return Words(_FUNCTIONS, _VALUES, symbols)


def enter(function: Callable[..., Any]) -> None:
    """Register a measurement by its name without trailing underscore; a function without parameters in capitals."""
    if inspect.signature(function).parameters:
        name, registry = function.__name__.rstrip("_"), _FUNCTIONS
    else:
        name, registry, function = function.__name__.upper(), _VALUES, cache(function)
    if name in registry:
        raise ValueError(f"two measurements are called {name}")
    registry[name] = function


@cache
def _load() -> None:
    for found in pkgutil.iter_modules(__path__):
        module = importlib.import_module(f"{__name__}.{found.name}")
        for name, member in vars(module).items():
            own = callable(member) and getattr(member, "__module__", "") == module.__name__
            if own and not name.startswith("_") and not isinstance(member, type):
                enter(member)
