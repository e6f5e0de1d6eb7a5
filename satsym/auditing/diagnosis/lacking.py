"""Search for one short term that a formula lacks, computed from the difference to the target instead of by trial."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from satsym.auditing.comparison.plan import Plan
from satsym.auditing.diagnosis.edits import Change, Edit
from satsym.auditing.ledger.scopes import CONSTANTS
from satsym.formula.angles import Terms, TooManyTerms, terms_of
from satsym.formula.calculus import product, raised
from satsym.formula.reading import NAME
from satsym.formula.tree import ONE, Add, Div, Mul, Neg, Node, Num, Path, Sym, children, number, replaced, size, symbols

_NOTHING = number(0)
_LARGEST_TERM = 14
"""Number of nodes up to which a term is short enough to be reported."""


def mended_terms(plan: Plan, indices: Sequence[int]) -> list[tuple[int, Edit]]:
    """Return edits of one term that correct the difference to the target, with the index of the cell, ordered by size.

    An edit adds a term to a sum, or replaces one term of a sum by another.
    """
    found: list[tuple[int, int, int, int, Edit]] = []
    for i in indices:
        for gap in () if isinstance(plan.printed[i], Num) else plan.gaps(i):
            for path, node, slope in _linear_places(plan.printed[i]):
                for change, at, old, new, term in _mended(plan, gap, path, node, slope):
                    edit = Edit(change, at, old, new, replaced(plan.printed[i], at, new))
                    found.append((change, size(term), -_alike(old, term), i, edit))
    return [(i, edit) for *_, i, edit in sorted(found, key=lambda entry: entry[:4])]


def _alike(one: Node, other: Node) -> int:
    """Return how many letters two terms share, without dots and hats; a typical slip keeps most letters."""
    stems = [{name.removeprefix("d_").removesuffix("_hat") for name in symbols(term)} for term in (one, other)]
    return len(stems[0] & stems[1])


def _mended(
    plan: Plan, gap: Node, path: Path, node: Node, slope: Node
) -> Iterator[tuple[Change, Path, Node, Node, Node]]:
    """Yield edits that add a term to a sum or replace one term of it, with the new term."""
    terms = node.terms if isinstance(node, Add) else () if node == _NOTHING else (node,)
    try:
        lacking = terms_of(Div(gap, plan.normal(slope)))
    except TooManyTerms:
        return
    term = _single_term(plan, lacking)
    if term is not None:
        yield Change.MISSING_TERM, path, node, Add((*terms, term)) if terms else term, term
    for k, other in enumerate(node.terms if isinstance(node, Add) else ()):
        term = _single_term(plan, lacking, other)
        if term is not None:
            change = Change.FACTOR if _is_multiple(term, other) else Change.TERM
            yield change, (*path, k), other, term, term


def _is_multiple(term: Node, other: Node) -> bool:
    """Return whether two terms differ by a numeric factor only."""
    try:
        return list(terms_of(Div(term, other)).coefficients) == [()]
    except TooManyTerms:
        return False


def _linear_places(formula: Node) -> Iterator[tuple[Path, Node, Node]]:
    """Yield the sums on which a formula depends linearly, and the formula itself, each with its path and its factor."""

    def places(node: Node, path: Path, slope: Node) -> Iterator[tuple[Path, Node, Node]]:
        if isinstance(node, Add) or not path:
            yield path, node, slope
        for k, child in enumerate(children(node)):
            if isinstance(node, Add):
                yield from places(child, (*path, k), slope)
            elif isinstance(node, Neg):
                yield from places(child, (*path, k), Neg(slope))
            elif isinstance(node, Div) and k == 0:
                yield from places(child, (*path, k), Div(slope, node.denominator))
            elif isinstance(node, Mul):
                rest = (*node.factors[:k], *node.factors[k + 1 :])
                yield from places(child, (*path, k), Mul((slope, *rest)))

    yield from places(formula, (), ONE)


def _single_term(plan: Plan, lacking: Terms, beside: Node = _NOTHING) -> Node | None:
    """Return the sum of lacking terms and `beside` if it is one short term in the document's symbols, else ``None``."""
    try:
        terms = lacking.plus(terms_of(plan.normal(beside))).coefficients
    except TooManyTerms:
        return None
    if len(terms) != 1:
        return None
    ((key, (real, imaginary)),) = terms.items()
    if imaginary or not all(NAME.match(name) for name, _ in key):
        return None
    above = [raised(Sym(name), power) for name, power in key if power > 0]
    below = [raised(Sym(name), -power) for name, power in key if power < 0]
    top = product([number(abs(real).numerator), *above])
    bottom = product([number(real.denominator), *below])
    term = top if bottom == ONE else Div(top, bottom)
    printed = plan.bench.theirs(plan.row, Neg(term) if real < 0 else term)
    known = {*plan.meanings, *CONSTANTS}
    return printed if size(printed) <= _LARGEST_TERM and symbols(printed) <= known else None
