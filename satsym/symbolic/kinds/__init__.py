"""Kinds of models: each owns what it may state, its steps, names, dimensions and statement; nobody else knows of it."""

from __future__ import annotations

from typing import TypeVar

from satsym.symbolic.derivation import Derivation
from satsym.symbolic.model import Model

Kind = TypeVar("Kind", bound=Model)


def stated_as(kind: type[Kind], so_far: Derivation) -> Kind:
    """The model of a derivation whose steps are those of this kind."""
    if not isinstance(so_far.model, kind):
        raise TypeError(f"{so_far.model.name} is not stated as {kind.__name__}")
    return so_far.model
