"""Judgement of numbers with units: recomputed from the values in the document, compared with the printed digits."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction

from satsym import units
from satsym.auditing import quantities
from satsym.auditing.comparison.bench import Bench
from satsym.auditing.constants import CUSTOMARY
from satsym.auditing.ledger.contents import Row
from satsym.auditing.outcome import Outcome
from satsym.auditing.propositions.relations import Fit, fit_of_range
from satsym.auditing.sentences import say
from satsym.formula.tree import Equality, Node, symbols
from satsym.formula.values import Kernel, Matrix, Relation, Roots
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas, library

_CGS = {"N": "dyn", "J": "erg", "m": "cm", "kg": "g"}
"""Names of SI units -> the corresponding units of the centimetre-gram-second system."""
_CGS_NAMES = re.compile(rf"\b({'|'.join(_CGS)})\b")
_ZEROS = 6
"""Number of zeros up to which a number is written out rather than with a power of ten, though zeros claim nothing."""


def number(bench: Bench, row: Row) -> Outcome:
    """Return the outcome of a row that prints a number."""
    printed = quantities.printed_number(str(row.table.printed))
    tree = row.holds
    assert tree is not None
    if quantities.is_numeric(tree):
        return _measured(bench, row, printed, tree)
    return _exact(bench, row, printed)


def _measured(bench: Bench, row: Row, printed: quantities.PrintedNumber, tree: Node | Equality) -> Outcome:
    assert not isinstance(tree, Equality)
    inputs = {**bench.ledger.inputs, **row.table.inputs}
    found = quantities.evaluated(tree, inputs)
    stated = quantities.one(printed.unit)
    if dict(stated.dimension) != dict(found.dimension):
        wanted = library.written_dimension(found.dimension)
        derived = f"{found.value:.6g} {quantities.readable_unit(found.dimension)}"
        remark: str = say("wrong_unit", library.written_dimension(stated.dimension), wanted)
        return Outcome(row, False, derived, unit=True, remark=remark)
    scale = stated.value
    value, (low, high) = found.value / scale, (bound / scale for bound in quantities.bounds(tree, inputs))
    unit = "" if printed.unit == "1" else f" {printed.unit}"
    derived = f"{_rounded(value, printed)}{unit}"
    evidence: dict[str, object] = {"recomputed": value, "a unit of the last digit": 2.0 * float(printed.half_unit)}
    if high > low:
        evidence |= {"with rounded inputs, from": low, "to": high}
    how, custom = fit_of_range(low, high, printed), ""
    if how is not Fit.INSIDE:
        custom = _customary(printed, tree, inputs, scale)
        cgs = _CGS_NAMES.sub(lambda name: _CGS[name[0]], printed.unit)
        if not custom and cgs != printed.unit and _comes_out_in(cgs, printed, tree, inputs):
            return Outcome(row, False, derived, unit=True, remark=say("number_of", cgs, derived), evidence=evidence)
    if how is Fit.INSIDE:
        return Outcome(row, True, derived, evidence=evidence)
    said = say("customary_number", derived, custom) if custom else say("wrong_number", derived)
    return Outcome(row, False, derived, near=how is Fit.NEAR or bool(custom), remark=said, evidence=evidence)


def _customary(printed: quantities.PrintedNumber, tree: Node, inputs: Mapping[str, str], scale: float) -> str:
    """Return the customary value of a constant that reproduces the printed digits, in words; empty if none does."""
    for name in sorted(symbols(tree) - inputs.keys()):
        for text in CUSTOMARY.get(name, ()):
            found = quantities.evaluated(tree, {**inputs, name: text}).value / scale
            if fit_of_range(found, found, printed) is Fit.INSIDE:
                return f"{name} = {text}"
    return ""


def _comes_out_in(unit: str, printed: quantities.PrintedNumber, tree: Node, inputs: Mapping[str, str]) -> bool:
    """Return whether the printed digits are correct in another unit."""
    scale = quantities.one(unit).value
    found = quantities.evaluated(tree, inputs).value / scale
    return fit_of_range(found, found, printed) is Fit.INSIDE or bool(_customary(printed, tree, inputs, scale))


def _exact(bench: Bench, row: Row, printed: quantities.PrintedNumber) -> Outcome:
    target = bench.target(row)
    if isinstance(target.exact, Matrix | Relation | Roots | Kernel):
        raise BadInput("a number cannot be compared with a matrix or an equation; compare it with an expression")
    by_sympy, by_trees = (
        formulas.as_number(value) for value in (target.exact, formulas.from_tree(target.trees, bench.names.expression))
    )
    if by_sympy is None or by_sympy != by_trees:
        raise BadInput(f"a number cannot be compared with {formulas.text(target.exact)}, which is not a number")
    how, derived = fit_of_range(float(by_sympy), float(by_sympy), printed), str(by_sympy)
    right = how is Fit.INSIDE if by_sympy.denominator != 1 else by_sympy == printed.value
    remark = "" if right else say("wrong_number", derived)
    return Outcome(row, right, derived, near=how is Fit.NEAR and by_sympy.denominator != 1, remark=remark)


def _rounded(value: float, printed: quantities.PrintedNumber) -> str:
    """Return the value as text, with one digit more than is printed."""
    step = printed.half_unit * 2 / 10
    if step >= 1:
        digits = len(str(int(abs(value) / step)))
        return f"{value:.0f}" if digits + _ZEROS >= len(str(int(abs(value)))) else f"{value:.{digits}g}"
    places = 0
    while Fraction(1, 10**places) > step:
        places += 1
    return f"{value:.{places}f}" if places < 12 else f"{value:.6g}"


def unit(bench: Bench, row: Row) -> Outcome:
    """Return the outcome of a row that prints a unit, judged by its dimension."""
    text = str(row.table.printed).strip()
    printed = {base: Fraction(power) for base, power in units.dimension(text).items()} if text not in ("", "1") else {}
    assert row.holds is not None
    assert not isinstance(row.holds, Equality)
    found = library.dimension(bench.plain_expression(row.holds), bench.dimensions) or {}
    derived = library.written_dimension(found)
    right = printed == found
    remark = "" if right else say("wrong_unit", library.written_dimension(printed), derived)
    gaps = {base: found.get(base, Fraction(0)) - printed.get(base, Fraction(0)) for base in {**found, **printed}}
    lacks = library.written_dimension({base: power for base, power in gaps.items() if power})
    return Outcome(row, right, derived, unit=not right, remark=remark, lacks=lacks)
