"""Tables of an instance from Python values: conversion, merging, and writing as TOML."""

from __future__ import annotations

import json
import numbers
from collections.abc import Mapping
from datetime import datetime
from typing import Any

DEEPEST = 6
"""Largest depth of nested lists and tables that is converted; no instance has deeper ones."""


def plain(value: Any, levels: int = DEEPEST) -> Any:
    """Convert a value to the types of TOML: numbers of any library, arrays, tuples, tables whose keys are symbols.

    Any other value is kept, so that it is refused later with its key.
    """
    if value is None or isinstance(value, bool | str | bytes | datetime) or not levels:
        return value
    if isinstance(value, Mapping):
        return {name_of(key): plain(entry, levels - 1) for key, entry in value.items() if entry is not None}
    if isinstance(value, list | tuple):
        return [plain(entry, levels - 1) for entry in value]
    if isinstance(value, numbers.Integral):
        return int(value)
    if hasattr(value, "tolist"):  # of arrays, and of their numbers
        return plain(value.tolist(), levels - 1)
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        return value


def merged(tree: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return a tree with changes: tables are merged, other values replaced, and ``None`` removes a key."""
    found = dict(tree)
    for key, value in changes.items():
        name = name_of(key)
        if value is None:
            found.pop(name, None)
        elif isinstance(value, Mapping):
            before = found.get(name, {})
            found[name] = merged(before if isinstance(before, Mapping) else {}, value)
        else:
            found[name] = plain(value)
    return found


def toml(tree: Mapping[str, Any], table: str = "") -> str:
    """Return the text of an instance file with the given tables.

    Parameters
    ----------
    tree
        Texts, numbers, lists of them, and tables of these.
    table
        Name of the table that contains `tree`, empty for the whole file.
    """
    inner = {name: value for name, value in tree.items() if isinstance(value, Mapping)}
    lines = [f"{name} = {_written(value)}" for name, value in tree.items() if name not in inner]
    head = [f"[{table}]"] if table and (lines or not inner) else []
    parts = ["\n".join([*head, *lines, ""])] if head or lines else []
    return "\n".join([*parts, *(toml(value, f"{table}.{name}" if table else name) for name, value in inner.items())])


def name_of(key: Any) -> str:
    """Return a key as text; a symbol or a variable is represented by its name."""
    for attribute in ("symbol", "name"):
        if isinstance(found := getattr(key, attribute, None), str):
            return found
    return str(key)


def _written(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, datetime):
        return value.isoformat()
    # JSON's texts and numbers are TOML's too; but TOML knows no surrogates, so that other letters stand as they are
    return json.dumps(value, ensure_ascii=False)
