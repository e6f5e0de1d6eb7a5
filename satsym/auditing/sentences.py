"""What a referee says about a row: every sentence of the audit, in one place. What is right comes first."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
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


_SHOULD = ("`{old}` should be `{new}`", "`{old}` seharusnya `{new}`")
_EDITS = {
    Change.SIGN: ("the sign of `{old}` is reversed", "tanda `{old}` terbalik"),
    Change.INDEX: _SHOULD,
    Change.FACTOR: ("`{old}` should be `{new}`, a matter of a factor", "`{old}` seharusnya `{new}`, soal faktor"),
    Change.EXPONENT: ("`{old}` should be `{new}`, a matter of an exponent", "`{old}` seharusnya `{new}`, soal pangkat"),
    Change.FUNCTION: _SHOULD,
    Change.BRACKET: (
        "the brackets of `{old}` are misplaced: it should be `{new}`",
        "kurung pada `{old}` salah tempat: seharusnya `{new}`",
    ),
    Change.SYMBOL: _SHOULD,
    Change.DROPPED_FACTOR: (
        "`{old}` should be `{new}`: a factor too many",
        "`{old}` seharusnya `{new}`: kelebihan satu faktor",
    ),
    Change.DROPPED_TERM: (
        "`{old}` has a term too many: it should be `{new}`",
        "`{old}` kelebihan satu suku: seharusnya `{new}`",
    ),
    Change.INVERTED: ("`{old}` is upside down", "`{old}` terbalik pembilang dan penyebutnya"),
    Change.MISSING_FACTOR: (
        "`{old}` lacks a factor: it should be `{new}`",
        "`{old}` kekurangan satu faktor: seharusnya `{new}`",
    ),
    Change.MISSING_TERM: ("the term `{term}` is missing", "suku `{term}` tidak ada"),
    Change.TERM: ("the term `{old}` should be `{new}`", "suku `{old}` seharusnya `{new}`"),
    Change.MEAN: (
        "`{old}` should be `{new}`, the value at that end",
        "`{old}` seharusnya `{new}`, nilai di ujung itu",
    ),
    Change.ENTRY: _SHOULD,
}
_WORD = re.compile(r"(?:a|[a-z]{2,})(?=[,:;]? (?![=<>+*/]))")
"""A word that begins a clause; single letters, names with digits and what is called or compared are symbols."""
_MANY = {
    Change.INDEX: ("`{old}` should be `{new}` at {times} places", "`{old}` seharusnya `{new}` di {times} tempat"),
    Change.DROPPED_FACTOR: (
        "`{old}` is a factor too many at {times} places",
        "`{old}` kelebihan sebagai faktor di {times} tempat",
    ),
    Change.MEAN: (
        "`{old}` should be `{new}`, the value at that end, and so at {times} places",
        "`{old}` seharusnya `{new}`, nilai di ujung itu, demikian pula di {times} tempat",
    ),
}
DENIED = Said("It does not hold", "Tidak benar demikian")


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
        return _said("The size does not fit: {why}.", "Ukurannya tidak cocok: {why}.", why=why)
    if remedy is None and difference:
        return _said(
            "No small edit puts it right; it lacks `{difference}`.",
            "Tidak ada suntingan kecil yang membetulkannya; yang kurang `{difference}`.",
            difference=difference,
        )
    if remedy is None and not derived:
        return Said("No small edit puts it right.", "Tidak ada suntingan kecil yang membetulkannya.")
    if remedy is None:
        return _said(
            "No small edit puts it right; it should be `{derived}`.",
            "Tidak ada suntingan kecil yang membetulkannya; seharusnya `{derived}`.",
            derived=derived,
        )
    if remedy.exchange:
        return sentence(remedy.exchange)
    clauses = (joined([_place(labels[cell]), edit_in_words(edit)], "") for cell, edit in remedy.edits)
    return sentence(joined(clauses, "; "))


def edit_in_words(edit: Edit) -> Said:
    """One edit, as a clause."""
    old, new = edit.old, edit.new
    if edit.change is Change.SIGN:
        old = old.operand if isinstance(old, Neg) else old
    term = new.terms[-1] if edit.change is Change.MISSING_TERM and isinstance(new, Add) else new
    texts = _MANY[edit.change] if edit.times > 1 else _EDITS[edit.change]
    return _said(*texts, old=written(old), new=written(new), term=_signed(term), times=str(edit.times))


def inhomogeneous(fault: str) -> Said:
    """A formula is right once numbers are put in, but its dimensions are not."""
    return _said(
        "The formula is right as numbers, but not in its dimensions: it {fault}.",
        "Sebagai angka rumusnya benar, tetapi dimensinya tidak: it {fault}.",
        fault=fault,
    )


def also_inhomogeneous(fault: str) -> Said:
    """Its dimensions alone show that a formula is wrong."""
    return _said("Its dimensions show it, too: it {fault}.", "Dimensinya juga menunjukkannya: it {fault}.", fault=fault)


def takes_over(keys: Sequence[str]) -> Said:
    """A row goes wrong by what it is taken from alone."""
    return _said(
        "It follows from {keys} as printed, and nothing else is wrong with it.",
        "Ini mengikuti {keys} seperti tercetak, dan selain itu tidak ada yang salah.",
        keys=keys,
    )


def right_elsewhere(items: Sequence[str]) -> Said:
    """The document has the same thing right in another place."""
    return _said("The document has it right in {items}.", "Dokumen menulisnya dengan benar di {items}.", items=items)


def carried_on(items: Sequence[str]) -> Said:
    """Later formulas follow from the wrong one."""
    return _said("The error is carried on into {items}.", "Kekeliruan ini terbawa ke {items}.", items=items)


def not_carried_on(items: Sequence[str]) -> Said:
    """Later formulas follow from the right one only."""
    follow = "follows" if len(items) == 1 else "follow"
    return _said(
        f"{{items}} {follow} from the right formula, not from this one.",
        "{items} mengikuti rumus yang benar, bukan rumus ini.",
        items=items,
    )


def same_slip(items: Sequence[str]) -> Said:
    """The same is printed wrong in other places."""
    return _said("The same slip is in {items}.", "Kekeliruan yang sama ada di {items}.", items=items)


def follows_from_wrong(items: Sequence[str]) -> Said:
    """It follows correctly from what is itself wrong."""
    return _said(
        "It does follow from {items} as printed, which is where the error comes from.",
        "Ini memang mengikuti {items} seperti tercetak; dari sanalah kekeliruannya.",
        items=items,
    )


def unsound(items: Sequence[str], instead: str = "") -> Said:
    """The result is right, but not for the reason given; what follows instead."""
    said = _said(
        "The result is right, but it does not follow from {items} in the way that is said",
        "Hasilnya benar, tetapi tidak mengikuti {items} dengan cara yang dikatakan",
        items=items,
    )
    gives = _said(": that gives `{instead}`", ": hasilnya `{instead}`", instead=instead) if instead else Said("")
    return joined([said, gives, Said(".")], "")


def wrong_number(derived: str, custom: str = "") -> Said:
    """A number differs from the one computed; with a customary value of a constant it would not."""
    if not custom:
        return _said("It is {derived}.", "Nilainya {derived}.", derived=derived)
    return _said(
        "It is {derived}; the printed digits come out with the customary {custom}.",
        "Nilainya {derived}; angka yang tercetak diperoleh dengan nilai lazim {custom}.",
        derived=derived,
        custom=custom,
    )


def number_of(unit: str, derived: str) -> Said:
    """A number is right in another unit."""
    return _said(
        "The number is that of {unit}; it should be {derived}.",
        "Angkanya untuk satuan {unit}; seharusnya {derived}.",
        unit=unit,
        derived=derived,
    )


def wrong_unit(printed: str, derived: str) -> Said:
    """The dimension of a unit is another one."""
    return _said(
        "The unit is of dimension {printed}; it should be {derived}.",
        "Satuannya berdimensi {printed}; seharusnya {derived}.",
        printed=printed,
        derived=derived,
    )


def false_claim(derived: str) -> Said:
    """A claim does not hold."""
    return joined([DENIED, Said(f": {derived}." if derived else ".")], "")


def unsound_claim(derived: str) -> Said:
    """A conclusion is right, the reason given for it is not."""
    return _said(
        "The conclusion is right, but the reason given does not lead there: {derived}.",
        "Kesimpulannya benar, tetapi alasan yang diberikan tidak menuju ke sana: {derived}.",
        derived=derived,
    )


def vacuous_claim(derived: str) -> Said:
    """A rule is true of nothing."""
    return _said(
        "It is true of nothing: {derived}.", "Ini berlaku untuk sesuatu yang tidak ada: {derived}.", derived=derived
    )


def artefact(derived: str) -> Said:
    """What is printed comes from the algorithm."""
    return _said(
        "This is what the printed algorithm produces, not what the problem asks for: {derived}.",
        "Ini dihasilkan oleh algoritma yang tercetak, bukan yang diminta masalahnya: {derived}.",
        derived=derived,
    )


def undecided(derived: str) -> Said:
    """A claim could not be decided."""
    return _said("It cannot be decided: {derived}.", "Tidak dapat diputuskan: {derived}.", derived=derived)


def illegible(reason: str) -> Said:
    """A row cannot be read."""
    copy = _said("It cannot be read in the copy at hand", "Tidak terbaca pada salinan yang ada")
    return joined([copy, f": {reason}." if reason else "."], "")


def one_letter(symbol: str, meanings: Sequence[str]) -> str:
    """A symbol has several meanings."""
    return f"{symbol} stands for {_listed(meanings)}"


def _place(label: str) -> Said:
    if not label:
        return Said("")
    if label.endswith("side"):
        side = "kiri" if label.startswith("left") else "kanan"
        return Said(f"in the {label} ", f"di ruas {side} ")
    return Said(f"entry ({label}): ", f"entri ({label}): ") if label[0].isdigit() else Said(f"{label}: ")


def _signed(term: Node) -> str:
    return written(term) if isinstance(term, Neg) else f"+{written(term)}"


def sentence(clause: str) -> Said:
    """A clause as a sentence of its own, where it does not begin with a symbol; nothing for none."""
    return Said(*map(_with_capital, (clause, in_indonesian(clause))))


def _with_capital(clause: str) -> str:
    clause = clause.strip().rstrip(".")
    first = _WORD.match(clause)
    if first and first[0].lower() not in GREEK:
        clause = f"{clause[:1].upper()}{clause[1:]}"
    return f"{clause}." if clause else ""


def _said(english: str, indonesian: str, **fill: str | Sequence[str]) -> Said:
    """A text in both languages, with its places filled in."""
    return Said(
        *(
            text.format(**{k: v if isinstance(v, str) else _listed(v, last) for k, v in fill.items()})
            for text, last in ((english, " and "), (indonesian, " dan "))
        )
    )


def _listed(items: Sequence[str], last: str = " and ") -> str:
    if len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])}{last}{items[-1]}"
