"""The sentences of reports: one TOML file for each language, with the same keys in all of them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from satsym.status import BadInput
from satsym.wording import shown

_FOLDER = Path(__file__).parent
PHRASES = "phrases"
"""Name of the table of translated words of models, which is separate from the texts."""

_HOLE = re.compile(r"<([a-z_]+)>")


class MissingText(LookupError):
    """A language lacks a text that a report needs."""

    def __str__(self) -> str:
        return str(self.args[0])


@dataclass(frozen=True)
class Texts:
    """The texts of one language, in LaTeX for derivations, with ``<name>`` where something is filled in."""

    language: str
    tables: Mapping[str, Mapping[str, str]]

    def get(self, table: str, key: str, **fill: str) -> str:
        """Return the text at a key of a table, with its places filled in.

        Raises
        ------
        MissingText
            If there is none, or a place in it is left open.
        """
        text = self.find(table, key)
        if text is None:
            raise MissingText(f'{self.language}.toml: there is no text for "{key}" in [{table}]')
        return _HOLE.sub(lambda hole: fill.get(hole[1], hole[0]), text)

    def counted(self, table: str, key: str, number: int, **fill: str) -> str:
        """Return a text that speaks of one or, after a bar, of many, with ``<number>`` filled in."""
        one, _, many = self.get(table, key).partition("|")
        text = many if many and number != 1 else one
        return _HOLE.sub(lambda hole: {"number": str(number), **fill}.get(hole[1], hole[0]), text)

    def find(self, table: str, key: str) -> str | None:
        """Return the text at a key of a table, unfilled; ``None`` if there is none."""
        return self.tables.get(table, {}).get(key)

    def phrase(self, text: str) -> str:
        """Return a title or meaning in this language, if its author has translated it."""
        return self.find(PHRASES, text) or text

    def with_own(self, own: Mapping[str, Mapping[str, str]]) -> Texts:
        """Add texts of one's own, table by table; where both have a key, the added ones count."""
        merged = {name: {**self.tables.get(name, {}), **table} for name, table in own.items()}
        return Texts(self.language, {**self.tables, **merged})

    def listed(self, items: list[str]) -> str:
        """Write items as an enumeration: a, b and c."""
        if len(items) < 2:
            return "".join(items)
        last = f"{' ' if len(items) == 2 else self.get('words', 'comma')}{self.get('words', 'and')} "
        return ", ".join(items[:-1]) + last + items[-1]


def languages() -> list[str]:
    """Return the languages that have texts."""
    return sorted(file.stem for file in _FOLDER.glob("*.toml"))


@cache
def load(language: str) -> Texts:
    """Return the texts of a language.

    Raises
    ------
    BadInput
        If there are none.
    """
    import tomllib

    if language not in languages():
        raise BadInput(
            f"there is no translation into the language {shown(language)}; there are {', '.join(languages())}"
        )
    tables: dict[str, Any] = tomllib.loads((_FOLDER / f"{language}.toml").read_text(encoding="utf-8"))
    return Texts(language, tables)
