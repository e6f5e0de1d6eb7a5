"""What a referee says about a row, in the sentences of ``sentences.toml``. What is right comes first."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Sequence
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

from satsym.auditing.diagnosis.edits import Change, Edit
from satsym.formula.tree import Add, Neg, Node
from satsym.formula.writing import GREEK, written

if TYPE_CHECKING:
    from satsym.auditing.diagnosis.smallest_edit import Remedy


class Said(str):
    """What is said in English, with the same in Indonesian."""

    __slots__ = ("indonesian",)
    indonesian: str

    def __new__(cls, english: str, indonesian: str = "") -> Said:
        """In English alone where there is nothing else."""
        found = super().__new__(cls, english)
        found.indonesian = str(indonesian or english)
        return found


def say(key: str, *fill: str | Sequence[str], table: str = "rows") -> Said:
    """A sentence of ``sentences.toml`` in both languages, its places filled in with texts, or lists of them."""
    texts = _tables()[table][key]
    return Said(
        *(
            texts[lang].format(*(_listed(part, last) for part in fill))
            for lang, last in (("en", " and "), ("id", " dan "))
        )
    )


@cache
def _tables() -> dict[str, dict[str, dict[str, str]]]:
    return tomllib.loads(files("satsym.auditing").joinpath("sentences.toml").read_text(encoding="utf-8"))


_WORD = re.compile(r"(?:a|[a-z]{2,})(?=[,:;]? (?![=<>+*/]))")
"""A word that begins a clause; single letters, names with digits and what is called or compared are symbols."""


def joined(parts: Iterable[str], by: str = " ") -> Said:
    """Sentences, or clauses, one after the other."""
    given = [part for part in parts if part]
    return Said(by.join(given), by.join(in_indonesian(part) for part in given))


def in_indonesian(text: str) -> str:
    """The same in Indonesian, if it is known."""
    return text.indonesian if isinstance(text, Said) else text


def wrong_formula(labels: Sequence[str], remedy: Remedy | None, difference: str, why: str, derived: str) -> Said:
    """What is wrong with a formula; where no edit tells, what it lacks, or what it should be."""
    if why:
        return say("wrong_size", why)
    if remedy is None:
        return (
            say("lacking", difference) if difference else say("no_edit", derived) if derived else say("no_small_edit")
        )
    if remedy.exchange:
        return sentence(remedy.exchange)
    return sentence(joined((joined([_place(labels[i]), in_words(edit)], "") for i, edit in remedy.edits), "; "))


def in_words(edit: Edit) -> Said:
    """One edit, as a clause."""
    old, new = edit.old, edit.new
    if edit.change is Change.SIGN:
        old = old.operand if isinstance(old, Neg) else old
    term = new.terms[-1] if edit.change is Change.MISSING_TERM and isinstance(new, Add) else new
    table, kind = "repeated_edits" if edit.times > 1 else "edits", edit.change.name.lower()
    known = kind if kind in _tables()[table] else "other"
    return say(known, written(old), written(new), _signed(term), str(edit.times), table=table)


def stated(said: Said, what: str = "") -> Said:
    """A sentence without its full stop, and after a colon what there is to it."""
    return joined([said, f": {what}." if what else "."], "")


def sentence(clause: str) -> Said:
    """A clause as a sentence of its own, where it does not begin with a symbol; nothing for none."""
    return Said(*map(_with_capital, (clause, in_indonesian(clause))))


def _place(label: str) -> Said:
    if not label:
        return Said("")
    if label.endswith("side"):
        side = "kiri" if label.startswith("left") else "kanan"
        return Said(f"in the {label} ", f"di ruas {side} ")
    return Said(f"entry ({label}): ", f"entri ({label}): ") if label[0].isdigit() else Said(f"{label}: ")


def _signed(term: Node) -> str:
    return written(term) if isinstance(term, Neg) else f"+{written(term)}"


def _with_capital(clause: str) -> str:
    clause = clause.strip().rstrip(".")
    first = _WORD.match(clause)
    if first and first[0].lower() not in GREEK:
        clause = f"{clause[:1].upper()}{clause[1:]}"
    return f"{clause}." if clause else ""


def _listed(items: str | Sequence[str], last: str) -> str:
    if isinstance(items, str) or len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])}{last}{items[-1]}"
