"""What a referee says about a row: every sentence of the audit, in one place. What is right comes first."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from satsym.auditing.diagnosis.edits import Change, Edit
from satsym.formula.tree import Add, Neg, Node
from satsym.formula.writing import GREEK, written

if TYPE_CHECKING:
    from satsym.auditing.diagnosis.smallest_edit import Remedy

_EDITS = {
    Change.SIGN: "the sign of `{old}` is reversed",
    Change.INDEX: "`{old}` should be `{new}`",
    Change.FACTOR: "`{old}` should be `{new}`, a matter of a factor",
    Change.EXPONENT: "`{old}` should be `{new}`, a matter of an exponent",
    Change.FUNCTION: "`{old}` should be `{new}`",
    Change.BRACKET: "the brackets of `{old}` are misplaced: it should be `{new}`",
    Change.SYMBOL: "`{old}` should be `{new}`",
    Change.DROPPED_FACTOR: "`{old}` should be `{new}`: a factor too many",
    Change.DROPPED_TERM: "`{old}` has a term too many: it should be `{new}`",
    Change.INVERTED: "`{old}` is upside down",
    Change.MISSING_FACTOR: "`{old}` lacks a factor: it should be `{new}`",
    Change.MISSING_TERM: "the term `{term}` is missing",
    Change.TERM: "the term `{old}` should be `{new}`",
    Change.ENTRY: "`{old}` should be `{new}`",
}
_WORD = re.compile(r"(?:a|[a-z]{2,})(?=[,:;]? (?![=<>+*/]))")
"""A word that begins a clause; single letters, names with digits and what is called or compared are symbols."""
_MANY = {Change.INDEX: "`{old}` should be `{new}`", Change.DROPPED_FACTOR: "`{old}` is a factor too many"}


def wrong_formula(labels: Sequence[str], remedy: Remedy | None, difference: str, why: str, derived: str) -> str:
    """What is wrong with a formula; where no edit tells, what it lacks, or what it should be."""
    if why:
        return f"The size does not fit: {why}."
    if remedy is None:
        lacking = f"lacks `{difference}`" if difference else f"should be `{derived}`"
        return f"No small edit puts it right; it {lacking}."
    if remedy.exchange:
        return sentence(remedy.exchange)
    return sentence("; ".join(f"{_place(labels[cell])}{edit_in_words(edit)}" for cell, edit in remedy.edits))


def edit_in_words(edit: Edit) -> str:
    """One edit, as a clause."""
    old, new = edit.old, edit.new
    if edit.change is Change.SIGN:
        old = old.operand if isinstance(old, Neg) else old
    if edit.times > 1:
        clause = _MANY[edit.change].format(old=written(old), new=written(new))
        return f"{clause} at {edit.times} places"
    term = new.terms[-1] if edit.change is Change.MISSING_TERM and isinstance(new, Add) else new
    return _EDITS[edit.change].format(old=written(old), new=written(new), term=_signed(term))


def inhomogeneous(fault: str) -> str:
    """A formula is right once numbers are put in, but its dimensions are not."""
    return f"The formula is right as numbers, but not in its dimensions: it {fault}."


def also_inhomogeneous(fault: str) -> str:
    """Its dimensions alone show that a formula is wrong."""
    return f" Its dimensions show it, too: it {fault}."


def takes_over(keys: Sequence[str]) -> str:
    """A row goes wrong by what it is taken from alone."""
    return f"It follows from {_listed(keys)} as printed, and nothing else is wrong with it."


def right_elsewhere(items: Sequence[str]) -> str:
    """The document has the same thing right in another place."""
    return f"The document has it right in {_listed(items)}."


def carried_on(items: Sequence[str]) -> str:
    """Later formulas follow from the wrong one."""
    return f"The error is carried on into {_listed(items)}."


def not_carried_on(items: Sequence[str]) -> str:
    """Later formulas follow from the right one only."""
    return f"{_listed(items)} {'follows' if len(items) == 1 else 'follow'} from the right formula, not from this one."


def same_slip(items: Sequence[str]) -> str:
    """The same is printed wrong in other places."""
    return f"The same slip is in {_listed(items)}."


def follows_from_wrong(items: Sequence[str]) -> str:
    """It follows correctly from what is itself wrong."""
    return f"It does follow from {_listed(items)} as printed, which is where the error comes from."


def unsound(items: Sequence[str]) -> str:
    """The result is right, but not for the reason given."""
    return f"The result is right, but it does not follow from {_listed(items)} in the way that is said."


def wrong_number(derived: str, custom: str = "") -> str:
    """A number differs from the one computed; with a customary value of a constant it would not."""
    return f"It is {derived}{f'; the printed digits come out with the customary {custom}' if custom else ''}."


def number_of(unit: str, derived: str) -> str:
    """A number is right in another unit."""
    return f"The number is that of {unit}; it should be {derived}."


def misprinted_claim(derived: str) -> str:
    """A false statement that is plainly a slip in print."""
    return f"A slip in print: {derived}."


def wrong_unit(printed: str, derived: str) -> str:
    """The dimension of a unit is another one."""
    return f"The unit is of dimension {printed}; it should be {derived}."


def false_claim(derived: str) -> str:
    """A predicate does not hold."""
    return f"It does not hold: {derived}." if derived else "It does not hold."


def unsound_claim(derived: str) -> str:
    """A conclusion is right, the reason given for it is not."""
    return f"The conclusion is right, but the reason given does not lead there: {derived}."


def artefact(derived: str) -> str:
    """What is printed comes from the algorithm."""
    return f"This is what the printed algorithm produces, not what the problem asks for: {derived}."


def undecided(derived: str) -> str:
    """A predicate could not decide."""
    return f"It cannot be decided: {derived}."


def illegible(reason: str) -> str:
    """A row cannot be read."""
    return f"It cannot be read in the copy at hand{': ' + reason if reason else ''}."


def one_letter(symbol: str, meanings: Sequence[str]) -> str:
    """A symbol has several meanings."""
    return f"{symbol} stands for {_listed(meanings)}"


def _place(label: str) -> str:
    if not label:
        return ""
    return (
        f"in the {label} " if label.endswith("side") else f"entry ({label}): " if label[0].isdigit() else f"{label}: "
    )


def _signed(term: Node) -> str:
    return written(term) if isinstance(term, Neg) else f"+{written(term)}"


def sentence(clause: str) -> str:
    """A clause as a sentence of its own, where it does not begin with a symbol; nothing for none."""
    clause = clause.strip().rstrip(".")
    first = _WORD.match(clause)
    if first and first[0].lower() not in GREEK:
        clause = f"{clause[:1].upper()}{clause[1:]}"
    return f"{clause}." if clause else ""


def _listed(items: Sequence[str]) -> str:
    if len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])} and {items[-1]}"
