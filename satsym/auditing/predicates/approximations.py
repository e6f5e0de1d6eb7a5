"""Formulas that a document prints as exact and that are nearly so."""

from __future__ import annotations

from satsym.auditing.predicates import Finding, Question, exact, predicate
from satsym.auditing.predicates.pitch_axis import numbers


@predicate
def nearly(row: Question, address: str, meanings: tuple[str, ...], within: str) -> Finding:
    """Whether a printed formula is, with the document's numbers, a derived one; unsound where it is not so exactly.

    Parameters
    ----------
    address
        Of what is derived.
    meanings
        What its letters, or those of the formula, stand for: ``"wheel_torque = I_wy*d_Omega"``.
    within
        The largest relative difference that the numbers of the document do not show.
    """
    from satsym.symbolic.lookup.library import derivation

    name, _, where = address.partition(":")
    put_in = {text.partition("=")[0].strip(): exact.expression(text.partition("=")[2]) for text in meanings}
    target = derivation(name).equation(where).rhs
    both = [_named(e, put_in) for e in (target, exact.expression(str(row.printed)))]
    ratio = both[1] / both[0]
    values = numbers(row)
    gap = float(ratio.xreplace({s: values.get(s.name, 1.0) for s in ratio.free_symbols})) - 1.0
    same = exact.same(*both)
    return Finding(
        abs(gap) <= exact.share(within),
        f"exactly it is {both[0].factor()}" + ("" if same else f", less by {gap:.2g} of it"),
        {"relative difference": gap},
        sound=same,
        remark="" if same else "what is left out is small enough for what follows, but it is printed as an equation",
    )


def _named(found: exact.Expression, put_in: dict[str, exact.Expression]) -> exact.Expression:
    from satsym.symbolic.lookup import formulas

    return found.xreplace({s: put_in.get(s.name, formulas.symbol(s.name)) for s in found.free_symbols})
