"""Claims about Routh arrays: formulas, printed tables, and what is concluded from them."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np

from satsym.analysis.linear.routh import routh
from satsym.auditing import quantities
from satsym.auditing.predicates import Finding, Question, exact, predicate
from satsym.formula import reading
from satsym.formula.tree import symbols

_SEED = 17
_POINTS = 8
_POLYNOMIALS = 200


def _numbers(texts: Sequence[str]) -> list[Fraction]:
    return [Fraction(text) for text in texts]


def _is_number(text: str) -> bool:
    return not symbols(reading.expression(text))


def _points(coefficients: Sequence[str]) -> list[dict[str, Fraction]]:
    """Numbers for coefficients that are letters; none are needed where they are numbers."""
    if all(map(_is_number, coefficients)):
        return [{}]
    rng = np.random.default_rng(_SEED)
    return [
        {name: Fraction(int(value), 16) for name, value in zip(coefficients, line, strict=True)}
        for line in rng.integers(8, 64, (_POINTS, len(coefficients)))
    ]


def _value(text: str, values: dict[str, Fraction]) -> Fraction:
    """A printed formula at numbers for its letters, exactly."""
    from satsym.symbolic.lookup import formulas

    found = exact.expression(text)
    found = found.xreplace({s: formulas.rational(values[s.name]) for s in found.free_symbols})
    return Fraction(int(found.p), int(found.q))


@predicate
def characteristic_form() -> Finding:
    """Whether det(s - A) has n + 1 coefficients, the first of which never vanishes: it is 1."""
    found = np.array([np.poly(np.random.default_rng(k).uniform(-1.0, 1.0, (4, 4))) for k in range(_POINTS)])
    leading = float(np.abs(found[:, 0] - 1.0).max())
    return Finding(
        found.shape[1] == 5 and leading == 0.0, "the leading coefficient is 1", {"coefficients for n = 4": 5}
    )


@predicate
def routh_row(row: Question, coefficients: tuple[str, ...], line: int) -> Finding:
    """Whether a printed row is the one of that number, counted from one."""
    (printed,) = row.printed
    agree = total = 0
    for values in _points(coefficients):
        array = routh([_value(text, values) for text in coefficients]).rows[line - 1]
        total += 1
        agree += all(_value(text, values) == entry for text, entry in zip(printed, array, strict=True))
    return Finding(
        agree == total, f"the same at {agree} of {total} polynomials", {"polynomials": total, "agree": agree}
    )


@predicate
def routh_entry(
    row: Question, coefficients: tuple[str, ...], line: int, column: int, third: tuple[str, ...] = ()
) -> Finding:
    """Whether a printed formula or number is an entry of the array.

    Parameters
    ----------
    coefficients
        Highest power first; letters are tried with random fractions.
    line, column
        Where the entry stands, counted from one.
    third
        Names that the formula uses for entries of the third row.
    """
    if row.kind == "number":
        (values,) = _points(coefficients)
        entry = routh(_numbers(coefficients)).rows[line - 1][column - 1]
        printed = quantities.printed_number(str(row.printed))
        return Finding(abs(entry - printed.value) <= printed.half_unit, f"{float(entry):.6g}", {"entry": float(entry)})
    agree = total = 0
    example = ""
    for values in _points(coefficients):
        array = routh([_value(text, values) for text in coefficients]).rows
        named = values | dict(zip(third, array[2], strict=False))
        said, entry = _value(str(row.printed), named), array[line - 1][column - 1]
        total += 1
        agree += said == entry
        example = f"{float(entry):.6g}, the formula gives {float(said):.6g}"
    derived = example if total == 1 else f"the same at {agree} of {total} polynomials"
    return Finding(agree == total, derived, {"polynomials": total, "agree": agree})


@predicate
def routh_rule() -> Finding:
    """Whether one sign in the first column means that all roots have negative real parts: on random polynomials."""
    rng, agree, stable = np.random.default_rng(_SEED), 0, 0
    for _ in range(_POLYNOMIALS):
        coefficients = [1.0, *rng.uniform(-0.5, 4.0, int(rng.integers(2, 6)))]
        one_sign = routh(coefficients).sign_changes == 0
        left = bool(np.roots(coefficients).real.max() < 0.0)
        agree += one_sign == left
        stable += left
    return Finding(
        agree == _POLYNOMIALS,
        f"so for {agree} of {_POLYNOMIALS} polynomials",
        {"polynomials": _POLYNOMIALS, "agree": agree, "stable": stable},
    )


def _following(above: Sequence[Fraction], line: Sequence[Fraction]) -> list[Fraction] | None:
    """The row that the rule makes of two, special cases left as they are; ``None`` if it divides by zero."""
    if not line[0]:
        return None
    after = [(line[0] * a - above[0] * b) / line[0] for a, b in zip(above[1:], line[1:], strict=True)]
    return [*after, Fraction(0)]


@predicate
def routh_table(row: Question, coefficients: tuple[str, ...]) -> Finding:
    """Whether a printed table has the rows that the rule gives, and whether it goes on to the end.

    A row of zeros is what the rule gives where roots lie symmetrically to zero; the array then goes on with the
    derivative of the polynomial in the row above. A table that stops there is no basis for a count of roots.
    """
    array = routh(_numbers(coefficients))
    printed = [_numbers(line) for line in row.printed]
    width = max(len(array.rows[0]), len(printed[0]))
    padded = [[*line, *[Fraction(0)] * (width - len(line))] for line in array.rows]
    lines = [[*line, *[Fraction(0)] * (width - len(line))] for line in printed]
    wrong = []
    for i, line in enumerate(lines):
        by_rule = _following(lines[i - 2], lines[i - 1]) if i >= 2 else None
        if line not in (by_rule, padded[i] if i < len(padded) else None):
            wrong.append(i + 1)
    whole = len(lines) == len(padded) and any(lines[-1])
    column = ", ".join(str(line[0]) for line in padded)
    return Finding(
        not wrong,
        f"the whole array has the first column {column}, which changes its sign {array.sign_changes} times"
        if array.sign_changes != 1
        else f"the whole array has the first column {column}, which changes its sign once",
        {"rows that differ": ", ".join(map(str, wrong)) or "none", "special cases": array.special_case or "none"},
        sound=whole,
        remark=""
        if whole
        else "a row of zeros is a special case: the derivative of the row above takes its place, "
        f"and the array has {len(padded)} rows, not {len(lines)}",
    )


@predicate
def routh_conclusion(coefficients: tuple[str, ...], column: tuple[str, ...], stable: bool) -> Finding:
    """Whether the roots lie as is concluded from a printed first column, and whether that column is right."""
    array, printed = routh(_numbers(coefficients)), [quantities.printed_number(text) for text in column]
    found = array.sign_changes == 0 and array.on_axis == 0
    right = len(printed) == len(array.column) and all(
        abs(entry - number.value) <= number.half_unit for entry, number in zip(array.column, printed, strict=False)
    )
    signs = [number.value > 0 for number in printed]
    concluded = not any(a != b for a, b in pairwise(signs))
    written = ", ".join(f"{float(entry):.5g}" for entry in array.column)
    return Finding(
        found == stable == concluded,
        f"the first column is {written}: {array.sign_changes} changes of sign",
        {"changes of sign": array.sign_changes, "printed entries": len(printed), "rows": len(array.column)},
        sound=right,
        remark="" if right else "so the conclusion stands, but not on the printed numbers",
    )
