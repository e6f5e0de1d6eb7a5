"""What propositions measure: quantities of models, instances, motions, families and printed programs, by name.

A measurement is a function that returns a number, a list, a matrix, a record (a state, a trajectory), or a property
that textbooks name, of what it is given. It never sees what is printed and gives no verdict. Each public function of a
module of this package is one; without parameters it is a family, a convention or a constant, made once.
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
    """What a proposition may name, in a notation with these symbols."""
    _load()
    return Words(_FUNCTIONS, _VALUES, symbols)


def enter(function: Callable[..., Any]) -> None:
    """Enter a measurement under its name, without the underscore of one that Python has; a value in capitals."""
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
