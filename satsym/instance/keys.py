"""The keys of instance files, as lists for people and as a JSON schema for editors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import msgspec

from satsym.instance.schema import InstanceFile, Key, apart, entries_of, inner_table, names_of, wanted

DIALECT = "https://json-schema.org/draft/2020-12/schema"


@dataclass(frozen=True)
class Entry:
    """A key of an instance file, or the common entry of a table whose keys are names of the model."""

    table: str
    """The table of the key; empty for keys above all tables."""
    name: str
    """The key, or in capitals the kind of name that is the key."""
    kind: str
    """The type of the value, in words."""
    required: bool
    default: str
    """The default as TOML; empty where there is none."""
    key: Key


def entries() -> list[Entry]:
    """Return all keys, table by table, those of a table before its subtables."""
    return list(_entries(InstanceFile, ""))


def _entries(table: type[Any], section: str) -> Iterator[Entry]:
    tables = []
    for field in msgspec.structs.fields(table):
        kind, key = apart(field.type)
        if inner_table(kind) or entries_of(kind):
            tables.append((field, kind, key))
            continue
        default = "" if field.required else _written(field.default)
        yield Entry(section, field.name, wanted(kind, section, field.name), field.required, default, key)
    for field, kind, key in tables:
        below = f"{section}.{field.name}" if section else field.name
        if inner := inner_table(kind):
            yield from _entries(inner, below)
        else:
            yield Entry(below, key.names, wanted(entries_of(kind), below, ""), field.required, "", key)


def _written(value: Any) -> str:
    """Write a default value in TOML; empty where there is none."""
    if value is None or value == ():
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else repr(value)


def json_schema() -> dict[str, Any]:
    """Return the JSON schema of instance files, for editors."""
    return {"$schema": DIALECT, "title": "satsym instance", **_object(InstanceFile)}


def _object(table: type[Any]) -> dict[str, Any]:
    fields = msgspec.structs.fields(table)
    return {
        "type": "object",
        "additionalProperties": False,
        "required": [field.name for field in fields if field.required],
        "properties": {field.name: _property(field) for field in fields},
    }


def _property(field: Any) -> dict[str, Any]:
    kind, key = apart(field.type)
    said = key.meaning + (f" ({key.unit})" if key.unit else "")
    if inner := inner_table(kind):
        return {**_object(inner), "description": said}
    if values := entries_of(kind):
        return {"type": "object", "additionalProperties": _of_type(values), "description": said}
    default = {} if field.required or field.default is None else {"default": field.default}
    return {**_of_type(kind), "description": said, **default}


def _of_type(kind: Any) -> dict[str, Any]:
    """Return the schema of a value, which may have to be one of some names."""
    found = {k: v for k, v in msgspec.json.schema(kind).items() if k != "description"}
    if {"type": "null"} in found.get("anyOf", ()):  # which TOML has not
        found = {k: v for k, v in found["anyOf"][0].items() if k != "description"}
    return found | ({"enum": list(names)} if (names := names_of(kind)) else {})
