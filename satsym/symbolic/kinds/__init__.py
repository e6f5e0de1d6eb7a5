"""Kinds of models: each owns its declarations, steps, names, dimensions and statement, which no other module knows."""

from __future__ import annotations

from typing import TypeVar

from satsym.symbolic.derivation import Derivation
from satsym.symbolic.model import Model

Kind = TypeVar("Kind", bound=Model)


def stated_as(kind: type[Kind], so_far: Derivation) -> Kind:
    """Return the model of a derivation whose steps belong to this kind."""
    if not isinstance(so_far.model, kind):
        raise TypeError(f"{so_far.model.name} is not stated as {kind.__name__}")
    return so_far.model
