"""References from a document to its own equations: whether what is referred to has what is taken from it."""

from __future__ import annotations

from satsym.auditing.predicates import Finding, Question, predicate
from satsym.formula import reading
from satsym.formula.tree import Equality, symbols
from satsym.status import BadInput


@predicate
def cites(row: Question, numbers: tuple[str, ...], letters: tuple[str, ...]) -> Finding:
    """Whether the equations of these numbers, one after the other, have on their left the letters taken from them.

    Parameters
    ----------
    numbers
        What is referred to, such as ``"18"``.
    letters
        For each, a letter that the equation has to give: it stands on its left-hand side, alone or in a quotient.
    """
    if len(numbers) != len(letters):
        raise BadInput("cites: write a letter for each number")
    known = {str(key).partition(" ")[0] for key in row.document}
    missing = [number for number in numbers if number not in known]
    given = {letter: _giving(row, letter) for letter in letters}
    right = [number in given[letter] for number, letter in zip(numbers, letters, strict=True)]
    where = ", ".join(f"{letter} stands on the left of ({' and '.join(given[letter])})" for letter in letters)
    return Finding(
        all(right) and not missing,
        where,
        {"references": len(numbers), "of them right": sum(right)},
        slip=True,
    )


def _giving(row: Question, letter: str) -> list[str]:
    """Numbers of equations that have a letter on the left."""
    found: dict[str, None] = {}
    for key, printed in row.document.items():
        number = str(key).partition(" ")[0]
        if not number.isdigit() or not isinstance(printed, str) or "=" not in printed:
            continue
        try:
            formula = reading.statement(printed)
        except BadInput:
            continue  # words, as of a claim
        if isinstance(formula, Equality) and letter in symbols(formula.lhs):
            found[number] = None
    return list(found)
