"""What a referee says about a row: every sentence of the audit, in one place. What is right comes first."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Sentence:
    """A sentence in both languages, with numbered places; called with texts, or lists of them, to be filled in."""

    english: str
    indonesian: str

    def __call__(self, *fill: str | Sequence[str]) -> Said:
        """The sentence with its places filled in."""
        ways = ((self.english, " and "), (self.indonesian, " dan "))
        return Said(*(text.format(*(_listed(part, last) for part in fill)) for text, last in ways))


# what is wrong with a formula
wrong_size = Sentence("The size does not fit: {0}.", "Ukurannya tidak cocok: {0}.")
lacking = Sentence(
    "No small edit puts it right; it lacks `{0}`.",
    "Tidak ada suntingan kecil yang membetulkannya; yang kurang `{0}`.",
)
no_edit = Sentence(
    "No small edit puts it right; it should be `{0}`.",
    "Tidak ada suntingan kecil yang membetulkannya; seharusnya `{0}`.",
)
inhomogeneous = Sentence(
    "The formula is right as numbers, but not in its dimensions: it {0}.",
    "Sebagai angka rumusnya benar, tetapi dimensinya tidak: rumus ini {0}.",
)
also_inhomogeneous = Sentence("Its dimensions show it, too: it {0}.", "Dimensinya juga menunjukkannya: rumus ini {0}.")

# how rows bear on each other
takes_over = Sentence(
    "It follows from {0} as printed, and nothing else is wrong with it.",
    "Ini mengikuti {0} seperti tercetak, dan selain itu tidak ada yang salah.",
)
right_elsewhere = Sentence("The document has it right in {0}.", "Dokumen menulisnya dengan benar di {0}.")
carried_on = Sentence("The error is carried on into {0}.", "Kekeliruan ini terbawa ke {0}.")
not_carried_on = Sentence(
    "The right formula, not this one, leads to {0}.", "Rumus yang benar, bukan rumus ini, membawa ke {0}."
)
same_slip = Sentence("The same slip is in {0}.", "Kekeliruan yang sama ada di {0}.")
follows_from_wrong = Sentence(
    "It does follow from {0} as printed, which is where the error comes from.",
    "Ini memang mengikuti {0} seperti tercetak; dari sanalah kekeliruannya.",
)
unsound = Sentence(
    "The result is right, but it does not follow from {0} in the way that is said.",
    "Hasilnya benar, tetapi tidak mengikuti {0} dengan cara yang dikatakan.",
)

# numbers and units
wrong_number = Sentence("It is {0}.", "Nilainya {0}.")
customary_number = Sentence(
    "It is {0}; the printed digits come out with the customary {1}.",
    "Nilainya {0}; angka yang tercetak diperoleh dengan nilai lazim {1}.",
)
number_of = Sentence("The number is that of {0}; it should be {1}.", "Angkanya untuk satuan {0}; seharusnya {1}.")
wrong_unit = Sentence("The unit is of dimension {0}; it should be {1}.", "Satuannya berdimensi {0}; seharusnya {1}.")

# claims
denied = Sentence("It does not hold", "Tidak benar demikian")
unsound_claim = Sentence(
    "The conclusion is right, but the reason given does not lead there: {0}.",
    "Kesimpulannya benar, tetapi alasan yang diberikan tidak menuju ke sana: {0}.",
)
artefact = Sentence(
    "This is what the printed algorithm produces, not what the problem asks for: {0}.",
    "Ini dihasilkan oleh algoritma yang tercetak, bukan yang diminta masalahnya: {0}.",
)
undecided = Sentence("It cannot be decided: {0}.", "Tidak dapat diputuskan: {0}.")
unread = Sentence("It cannot be read in the copy at hand", "Tidak terbaca pada salinan yang ada")

_SHOULD = Sentence("`{0}` should be `{1}`", "`{0}` seharusnya `{1}`")
_EDITS = {
    Change.SIGN: Sentence("the sign of `{0}` is reversed", "tanda `{0}` terbalik"),
    Change.FACTOR: Sentence("`{0}` should be `{1}`, a matter of a factor", "`{0}` seharusnya `{1}`, soal faktor"),
    Change.EXPONENT: Sentence("`{0}` should be `{1}`, a matter of an exponent", "`{0}` seharusnya `{1}`, soal pangkat"),
    Change.BRACKET: Sentence(
        "the brackets of `{0}` are misplaced: it should be `{1}`",
        "kurung pada `{0}` salah tempat: seharusnya `{1}`",
    ),
    Change.DROPPED_FACTOR: Sentence(
        "`{0}` should be `{1}`: a factor too many", "`{0}` seharusnya `{1}`: kelebihan satu faktor"
    ),
    Change.DROPPED_TERM: Sentence(
        "`{0}` has a term too many: it should be `{1}`", "`{0}` kelebihan satu suku: seharusnya `{1}`"
    ),
    Change.INVERTED: Sentence("`{0}` is upside down", "`{0}` terbalik pembilang dan penyebutnya"),
    Change.MISSING_FACTOR: Sentence(
        "`{0}` lacks a factor: it should be `{1}`", "`{0}` kekurangan satu faktor: seharusnya `{1}`"
    ),
    Change.MISSING_TERM: Sentence("the term `{2}` is missing", "suku `{2}` tidak ada"),
    Change.TERM: Sentence("the term `{0}` should be `{1}`", "suku `{0}` seharusnya `{1}`"),
    Change.MEAN: Sentence("`{0}` should be `{1}`, the value at that end", "`{0}` seharusnya `{1}`, nilai di ujung itu"),
}
_MANY = {
    Change.INDEX: Sentence("`{0}` should be `{1}` at {3} places", "`{0}` seharusnya `{1}` di {3} tempat"),
    Change.DROPPED_FACTOR: Sentence(
        "`{0}` is a factor too many at {3} places", "`{0}` kelebihan sebagai faktor di {3} tempat"
    ),
    Change.MEAN: Sentence(
        "`{0}` should be `{1}`, the value at that end, and so at {3} places",
        "`{0}` seharusnya `{1}`, nilai di ujung itu, demikian pula di {3} tempat",
    ),
}
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
        return wrong_size(why)
    if remedy is None:
        return lacking(difference) if difference else no_edit(derived)
    if remedy.exchange:
        return sentence(remedy.exchange)
    return sentence(joined((joined([_place(labels[i]), in_words(edit)], "") for i, edit in remedy.edits), "; "))


def in_words(edit: Edit) -> Said:
    """One edit, as a clause."""
    old, new = edit.old, edit.new
    if edit.change is Change.SIGN:
        old = old.operand if isinstance(old, Neg) else old
    term = new.terms[-1] if edit.change is Change.MISSING_TERM and isinstance(new, Add) else new
    said = _MANY[edit.change] if edit.times > 1 else _EDITS.get(edit.change, _SHOULD)
    return said(written(old), written(new), _signed(term), str(edit.times))


def false_claim(derived: str) -> Said:
    """A claim does not hold."""
    return joined([denied(), f": {derived}." if derived else "."], "")


def illegible(reason: str) -> Said:
    """A row cannot be read."""
    return joined([unread(), f": {reason}." if reason else "."], "")


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
