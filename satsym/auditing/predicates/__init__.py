"""Claims, tables and algorithms: predicates that compute whether what is printed holds. A registry by name.

A predicate is a function of keyword arguments, which a row writes as ``holds = "name(key='value', ...)"``; if it has
a parameter ``row``, it is given the printed row itself (:class:`Question`). It lives in a module of this package
and is entered by the decorator :func:`predicate`.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias, TypeVar

from satsym.auditing.ledger.scopes import Scope
from satsym.status import BadInput
from satsym.wording import shown, suggestion


@dataclass(frozen=True)
class Finding:
    """What a predicate found.

    Attributes
    ----------
    holds
        Whether what is printed is true; ``None`` where that cannot be decided.
    derived
        What is true instead, or what confirms it, in a few words and numbers.
    evidence
        Measured numbers by name, or a short proof.
    command
        A command that recomputes it; by default the audit of the row alone.
    sound
        Whether the reason that is given leads there; a true conclusion with a false reason is unsound.
    artefact
        Whether what is printed is produced by the printed algorithm, and not by the problem.
    unit
        Whether the printed number is right and only its unit is wrong.
    slip
        Whether a false statement is plainly a slip in print, such as a reference to a number that does not exist.
    remark
        A sentence for the diagnosis, where there is more to say than what is true instead.
    """

    holds: bool | None
    derived: str
    evidence: Mapping[str, float | int | bool | str] = field(default_factory=dict)
    command: str = ""
    sound: bool = True
    artefact: bool = False
    unit: bool = False
    slip: bool = False
    remark: str = ""


class Told(dict[str, Any]):
    """What a document tells, by name; to ask for something else is a mistake of the ledger, told in a line."""

    def __init__(self, what: str, values: Mapping[str, Any]) -> None:
        super().__init__(values)
        self.what = what

    def __missing__(self, name: str) -> Any:
        raise BadInput(f"there is no {self.what} called {shown(name)}; {suggestion(name, self)}")


@dataclass(frozen=True)
class Question:
    """The row that asks.

    Attributes
    ----------
    item, kind, printed, columns
        As the ledger has them; a table is a tuple of rows.
    inputs
        Numbers with their units that the document, or the row, states.
    scope, scopes
        Name of the notation of the row, and all of them.
    document
        What each row of the document prints, by its key.
    """

    item: str
    kind: str
    printed: Any
    columns: tuple[str, ...]
    inputs: Mapping[str, str]
    scope: str
    scopes: Mapping[str, Scope]
    document: Mapping[str, Any] = field(default_factory=dict)


Predicate: TypeAlias = Callable[..., Finding]
P = TypeVar("P", bound=Predicate)
_REGISTRY: dict[str, Predicate] = {}


def predicate(function: P) -> P:
    """Enter a function into the registry under its own name."""
    if function.__name__ in _REGISTRY:
        raise ValueError(f"two predicates are called {function.__name__}")
    _REGISTRY[function.__name__] = function
    return function


def registry() -> Mapping[str, Predicate]:
    """All predicates by name."""
    for module in pkgutil.iter_modules(__path__):
        importlib.import_module(f"{__name__}.{module.name}")
    return _REGISTRY


def bound(name: str, arguments: Mapping[str, Any]) -> Callable[[Question], Finding]:
    """The predicate with its arguments, waiting for the row.

    Raises
    ------
    BadInput
        If there is no such predicate, or the arguments do not fit it.
    """
    known = registry()
    if name not in known:
        raise BadInput(f'no predicate "{name}"; {suggestion(name, known)}')
    signature = inspect.signature(known[name])
    wants_row = "row" in signature.parameters
    if wants_row and "row" in arguments:
        raise BadInput(f"{name} is given the row itself; leave row=... out")
    try:
        signature.bind(**({"row": None} if wants_row else {}), **arguments)
    except TypeError as error:
        wanted = ", ".join(parameter for parameter in signature.parameters if parameter != "row")
        raise BadInput(f"{name}: {error}; its arguments are {wanted or 'none'}") from None
    return lambda row: known[name](**({"row": row} if wants_row else {}), **arguments)
