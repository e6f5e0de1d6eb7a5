"""Sentences about a row in the report of a referee, from ``sentences.toml``, with what is right stated first."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from importlib.resources import files

from satsym.formula.writing import GREEK


class Said(str):
    """A text in English that contains its Indonesian translation."""

    __slots__ = ("indonesian",)
    indonesian: str

    def __new__(cls, english: str, indonesian: str = "") -> Said:
        """Create a text; without a translation the English text is used for both."""
        found = super().__new__(cls, english)
        found.indonesian = str(indonesian or english)
        return found


def say(key: str, *fill: str | Sequence[str], table: str = "rows") -> Said:
    """Return a sentence of ``sentences.toml`` in both languages, with its gaps filled by texts or lists of texts."""
    texts = tables()[table][key]
    return Said(
        *(
            texts[lang].format(*(_listed(part, last, written) for part in fill))
            for lang, last, written in (("en", " and ", str), ("id", " dan ", in_indonesian))
        )
    )


@cache
def tables() -> dict[str, dict[str, dict[str, str]]]:
    """Return all sentences by table, key and language."""
    return tomllib.loads(files("satsym.auditing").joinpath("sentences.toml").read_text(encoding="utf-8"))


_WORD = re.compile(r"(?:a|[a-z]{2,}(?:-[a-z]{2,})*)(?=[,:;]? (?![=<>+*/]))")
"""Pattern of the first word of a clause; single letters, names with digits and compared names are symbols."""


def joined(parts: Iterable[str], by: str = " ") -> Said:
    """Return sentences or clauses joined to one text in both languages."""
    given = [part for part in parts if part]
    return Said(by.join(given), by.join(in_indonesian(part) for part in given))


_DIMENSION = re.compile(r"(?<=\[)\w+(?=\])")


def in_indonesian(text: str) -> str:
    """Return the Indonesian translation of a text; in a formula, only names of dimensions are translated."""
    if isinstance(text, Said):
        return text.indonesian
    known = tables()["dimension_names"]
    return _DIMENSION.sub(lambda name: known[name[0]]["id"] if name[0] in known else name[0], text)


def property_in_indonesian(value: str) -> str:
    """Translate a property that textbooks name in Indonesian; return any other value as it is."""
    return _pairs("properties").get(value, value)


def _pairs(table: str) -> dict[str, str]:
    return {text["en"]: text["id"] for text in tables()[table].values()}


def stated(said: Said, what: str = "") -> Said:
    """Return a sentence without its full stop, followed by a colon and further text."""
    return joined([said, *([": ", what] if what else []), "."], "")


def sentence(clause: str) -> Said:
    """Return a clause as a sentence, with a capital unless it begins with a symbol; empty for an empty clause."""
    return Said(*map(_with_capital, (clause, in_indonesian(clause))))


def _with_capital(clause: str) -> str:
    clause = clause.strip().rstrip(".")
    first = _WORD.match(clause)
    if first and first[0].lower() not in GREEK:
        clause = f"{clause[:1].upper()}{clause[1:]}"
    return f"{clause}." if clause else ""


def _listed(items: str | Sequence[str], last: str, written: Callable[[str], str]) -> str:
    parts = [written(item) for item in ([items] if isinstance(items, str) else items)]
    return f"{', '.join(parts[:-1])}{last}{parts[-1]}" if len(parts) > 1 else "".join(parts)
