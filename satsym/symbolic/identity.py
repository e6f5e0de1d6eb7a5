"""Whether two problems state the same, across processes: a digest of everything that is declared."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from satsym.symbolic.model import Model, Problem

_OURS = ("satsym.", "sympy.")


class _Unknown(Exception):
    """Something whose content does not tell what it does: a function, or a class of the user's own."""


def identity(subject: Problem | Model) -> str:
    """The digest; empty where what is stated holds code of its own, which no digest of values covers."""
    try:
        parts = "\n".join(_parts(subject))
    except _Unknown:
        return ""
    return hashlib.blake2b(parts.encode(), digest_size=16).hexdigest()


def _parts(value: Any) -> Iterator[str]:
    """A line for each thing that is stated, in order; what is nested lies between brackets."""
    kind = type(value)
    if value is None or kind in (bool, int, float, str):
        yield repr(value)
    elif isinstance(value, sp.Basic | sp.MatrixBase):
        yield from _expression(value)
    elif isinstance(value, Enum) and kind.__module__.startswith(_OURS):
        yield f"{kind.__qualname__}.{value.name}"
    elif kind in (tuple, list):
        yield from ("(", *(part for each in value for part in _parts(each)), ")")
    elif isinstance(value, Mapping):
        yield from ("{", *(part for pair in value.items() for each in pair for part in _parts(each)), "}")
    elif is_dataclass(value) and kind.__module__.startswith(_OURS):
        yield f"{kind.__qualname__}("
        for field in fields(value):
            yield field.name
            yield from _parts(getattr(value, field.name))
        yield ")"
    else:
        raise _Unknown


def _expression(value: sp.Basic | sp.MatrixBase) -> Iterator[str]:
    yield sp.srepr(value)
    entries = [value] if isinstance(value, sp.Basic) else list(value)
    for node in (node for entry in entries for node in sp.preorder_traversal(entry)):
        if isinstance(node, AppliedUndef):
            yield repr((node.func.__name__, sorted(node.func._kwargs.items())))
        elif isinstance(node, sp.Basic) and not type(node).__module__.startswith(_OURS):
            raise _Unknown
