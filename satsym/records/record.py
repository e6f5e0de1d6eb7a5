"""A derivation as data, ``NAME.derivation.json``: every step with its equations, and every name with its unit.

Formulas are texts of the safe language. So documents can be compared with a derivation without executing the file that
states it.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import TypeAlias

import msgspec

from satsym.formula import reading
from satsym.formula.tree import Node, Sym
from satsym.formula.values import Matrix
from satsym.source_files import digest_of
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

FORMAT = 1
SUFFIX = ".derivation.json"
DECLARED = "declared"
_MOST_BYTES = 20_000_000
"""Largest size of a record, in bytes; shipped ones have up to 60 thousand."""
VARIABLES = ("state", "control", "output")
"""Kinds of names that rows and columns of matrices have."""

Text: TypeAlias = str | None
"""A formula as text; ``None`` for an expression that printed formulas cannot represent."""


class Name(msgspec.Struct, frozen=True, omit_defaults=True):
    """A name in a derivation: its kind (empty for derived ones), LaTeX, unit, dimension and meaning."""

    latex: str = ""
    kind: str = ""
    unit: str = ""
    dimension: dict[str, str] | None = None
    positive: bool = False
    meaning: str = ""


class Stated(msgspec.Struct, frozen=True, omit_defaults=True):
    """A recorded equation, whose right-hand side may be a matrix."""

    name: str
    lhs: Text
    rhs: Text | list[list[Text]]


class RecordedStep(msgspec.Struct, frozen=True):
    """A recorded step: its rule, its sources, and its equations."""

    name: str
    rule: str
    follows_from: list[str]
    equations: list[Stated]


class Record(msgspec.Struct, frozen=True):
    """A recorded derivation: its names, named constants with their values, declarations, and steps.

    ``sources`` are the files that state the derivation, relative to the record, with their digests.
    """

    written: str
    format: int
    name: str
    title: str
    sources: dict[str, str]
    names: dict[str, Name]
    definitions: dict[str, str]
    declared: dict[str, Text | list[list[Text]]]
    steps: list[RecordedStep]


@dataclass(frozen=True)
class Equated:
    """The equation at an address; the right-hand side may be a matrix."""

    lhs: Node
    rhs: Node | Matrix[Node]


@dataclass(frozen=True)
class Family:
    """A matrix whose entries are equations, with the names of its rows and columns."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    entries: tuple[tuple[Node, ...], ...]


Found: TypeAlias = Equated | Family | Node


@lru_cache(maxsize=64)
def _decoded(path: Path, _: int, __: int) -> Record:
    try:
        found = msgspec.json.decode(path.read_bytes(), type=Record)
    except (OSError, ValueError, msgspec.MsgspecError, RecursionError) as error:
        why = printable(" ".join(str(error).split()))
        raise BadInput(
            f"{printable(str(path), 200)}: this is not the record of a derivation ({why}); derive the model again"
        ) from None
    if found.format != FORMAT:
        raise BadInput(f"{printable(str(path), 200)}: was written by another version of satsym; derive the model again")
    return found


def load(path: Path) -> Record:
    """Read a record from a file.

    Raises
    ------
    BadInput
        If it is none, or a file that states the derivation is not what it was when this was derived.
    """
    try:
        status = path.stat()
    except (OSError, ValueError):
        raise BadInput(f"{printable(str(path), 200)}: no such file; write it with `satsym derive`") from None
    if status.st_size > _MOST_BYTES:
        raise BadInput(
            f"{printable(str(path), 200)}: larger than {_MOST_BYTES:,} bytes; "
            "the record of a derivation cannot be this large"
        )
    found = _decoded(path, status.st_mtime_ns, status.st_size)
    for place, digest in found.sources.items():
        if digest_of(path.parent / place) not in ("", digest):
            older = f"is older than {printable(place, 200)}; run satsym derive on this file again"
            raise BadInput(f"{printable(str(path), 200)}: {older}")
    return found


def with_sources(found: Record, folder: Path, stating: Mapping[Path, str]) -> Record:
    """Return the record with its source files, relative to the folder where the record will be."""
    sources = {}
    for path, digest in stating.items():
        try:
            sources[Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()] = digest
        except ValueError:  # another drive
            continue
    return msgspec.structs.replace(found, sources=sources)


def text_of(found: Record) -> str:
    """Return the record as text: a line for each name and each equation."""

    def line(value: object) -> str:
        return msgspec.json.encode(value).decode()

    def table(entries: Mapping[str, object]) -> str:
        return ",\n".join(f"  {line(name)}: {line(value)}" for name, value in entries.items())

    head = [f" {line(key)}: {line(getattr(found, key))}" for key in ("written", "format", "name", "title", "sources")]
    tables = [f" {line(key)}: {{\n{table(getattr(found, key))}\n }}" for key in ("names", "definitions", "declared")]
    steps = []
    for step in found.steps:
        said = line({"name": step.name, "rule": step.rule, "follows_from": step.follows_from})[:-1]
        equations = ",\n".join(f"   {line(equation)}" for equation in step.equations)
        steps.append(f'  {said}, "equations": [\n{equations}\n  ]}}')
    return "{\n" + ",\n".join([*head, *tables, ' "steps": [\n' + ",\n".join(steps) + "\n ]"]) + "\n}\n"


def from_text(text: str) -> Record:
    """Return the record from a text that :func:`text_of` wrote."""
    return msgspec.json.decode(text, type=Record)


@lru_cache(maxsize=20_000)
def formula(text: str) -> Node:
    """Return a formula of a record as a tree.

    Raises
    ------
    BadInput
        If it is none.
    """
    return reading.expression(text)


def look_up(found: Record, address: str) -> Found:
    """Return what is at ``model:step.equation``, ``model:step.A`` or ``model:declared.name``.

    Raises
    ------
    BadInput
        If there is none.
    """
    step_name, _, name = address.partition(":")[2].partition(".")
    if step_name == DECLARED:
        return _declared(found, name, address)
    step = next((step for step in found.steps if step.name == step_name), None)
    if step is None:
        known = [DECLARED, *(step.name for step in found.steps)]
        raise BadInput(f"{shown(address)}: there is no step {shown(step_name)}; {suggestion(step_name, known)}")
    for equation in step.equations:
        if equation.name == name:
            return _equated(equation, address)
    family = _family(found, step, name)
    if family is None:
        known = [equation.name for equation in step.equations]
        raise BadInput(f"{shown(address)}: the step has no {shown(name)}; {suggestion(name, known)}")
    return family


def variables(found: Record, kind: str) -> tuple[str, ...]:
    """Return the names of a kind, in the order of the model."""
    return tuple(name for name, entry in found.names.items() if entry.kind == kind)


def rates(found: Record) -> dict[str, str]:
    """Map states or costates to the names of their rates, which may be other states."""
    states = variables(found, "state")
    names = {name: f"d_{name}" for name in (*states, *(f"lambda_{state}" for state in states)) if name in found.names}
    for step in found.steps:
        for equation in step.equations if step.name == "first_order" else ():
            if isinstance(equation.rhs, str) and equation.rhs in states:
                names[equation.name] = equation.rhs
    return names


def dimensions(found: Record) -> dict[str, dict[str, Fraction]]:
    """Return the dimensions of all names that have one."""
    return {
        name: {base: Fraction(power) for base, power in entry.dimension.items()}
        for name, entry in found.names.items()
        if entry.dimension is not None
    }


def _equated(equation: Stated, address: str) -> Equated:
    return Equated(_tree(equation.lhs, address), _trees(equation.rhs, address))


def _tree(text: Text, address: str) -> Node:
    if text is None:
        raise BadInput(f"{shown(address)}: has no counterpart in printed formulas")
    return formula(text)


def _trees(value: Text | list[list[Text]], address: str) -> Node | Matrix[Node]:
    if isinstance(value, list):
        return Matrix(tuple(tuple(_tree(entry, address) for entry in row) for row in value))
    return _tree(value, address)


def _declared(found: Record, name: str, address: str) -> Found:
    if name not in found.declared:
        raise BadInput(f"{shown(address)}: no declared variable has this name; {suggestion(name, found.declared)}")
    value = _trees(found.declared[name], address)
    if isinstance(value, Matrix):
        rows, columns = value.shape
        return Family(_counted(rows), _counted(columns), value.rows)
    return value


def _family(found: Record, step: RecordedStep, prefix: str) -> Family | None:
    """Return the entries named ``prefix_row_column``, with declared variables as rows and columns."""
    values: dict[str, Stated] = {e.name: e for e in step.equations}
    for equation in step.equations:
        if equation.lhs is not None and isinstance(left := formula(equation.lhs), Sym):
            values[left.name] = equation
    family = {
        name: _tree(e.rhs, name)
        for name, e in values.items()
        if name.startswith(f"{prefix}_") and not isinstance(e.rhs, list)
    }
    if not family:
        return None
    groups = [variables(found, kind) for kind in VARIABLES]
    return _by_names(family, prefix, groups) or _by_numbers(family, prefix)


def _by_names(family: Mapping[str, Node], prefix: str, groups: list[tuple[str, ...]]) -> Family | None:
    for rows in groups:
        for columns in groups:
            places = {f"{prefix}_{row}_{column}" for row in rows for column in columns}
            if set(family) <= places:
                return _entries(family, prefix, rows, columns)
    return None


def _by_numbers(family: Mapping[str, Node], prefix: str) -> Family | None:
    """Return the entries named ``prefix_1_2`` of a family."""
    places = [tuple(name.removeprefix(f"{prefix}_").split("_")) for name in family]
    if any(len(place) != 2 or not all(part.isdigit() for part in place) for place in places):
        return None
    m, n = (max(int(place[k]) for place in places) for k in (0, 1))
    return _entries(family, prefix, _counted(m), _counted(n))


def _entries(family: Mapping[str, Node], prefix: str, rows: tuple[str, ...], columns: tuple[str, ...]) -> Family:
    zero = formula("0")
    entries = tuple(tuple(family.get(f"{prefix}_{row}_{column}", zero) for column in columns) for row in rows)
    return Family(rows, columns, entries)


def _counted(n: int) -> tuple[str, ...]:
    return tuple(str(i) for i in range(1, n + 1))
