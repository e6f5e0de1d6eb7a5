"""Judgement of equations and matrices: comparison with what is derived, diagnosis, and check of dimensions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from satsym.auditing.comparison.bench import Bench
from satsym.auditing.comparison.compare import plans
from satsym.auditing.comparison.equations import Equal, Multiple
from satsym.auditing.comparison.plan import Never, Plan
from satsym.auditing.diagnosis.smallest_edit import first_remedy, wrong_formula
from satsym.auditing.ledger.contents import Row
from satsym.auditing.outcome import Outcome
from satsym.auditing.sentences import Said, joined, say
from satsym.formula.tree import Equality, Formula, Node, cells, grid, names_in, shaped, symbols
from satsym.formula.values import Relation
from satsym.formula.writing import written
from satsym.symbolic.lookup import formulas, library


def judge(bench: Bench, row: Row) -> Outcome:
    """Return the outcome of an equation or matrix, without regard to the rows that it follows from."""
    assert row.printed is not None
    ways = plans(bench, row, row.printed, bench.target(row))
    fault = dimension_fault(bench, row)
    for compared in (*ways, *_plans_along_the_motion(bench, row)):
        if compared.is_right(compared.printed):
            derived = shown(compared, compared.printed)
            if fault and not _target_fault(bench, compared):
                return Outcome(row, True, derived, compared, unit=True, remark=say("inhomogeneous", fault))
            return Outcome(row, True, derived, compared)
    compared, found = first_remedy(ways)
    derived = shown(compared, found.cells if found else None)
    why = compared.why if isinstance(compared, Never) else Said("")
    remark = wrong_formula(compared.labels, found, "" if found else compared.difference(), why, derived)
    if fault:
        remark = joined([remark, say("also_inhomogeneous", fault)])
    return Outcome(row, False, derived, compared, found, remark=remark)


def _plans_along_the_motion(bench: Bench, row: Row) -> Iterator[Plan]:
    """Yield plans in which rates of states are functions of the states, unless the target says no more then.

    They are the last to be tried, since a row may be about the name of a rate itself.
    """
    assert row.printed is not None
    if not any(name.startswith("d_") for name in _names_meant(bench, row)):
        return
    bench = bench.along_the_motion
    target = bench.target(row)
    if isinstance(target.exact, Relation) and formulas.is_zero(target.exact.lhs - target.exact.rhs):
        return
    yield from plans(bench, row, row.printed, target)


def _names_meant(bench: Bench, row: Row) -> set[str]:
    """Return the names of the models that the symbols of a row and its target mean."""
    meanings, target = bench.meanings(row), bench.target(row).trees
    sides = (target.lhs, target.rhs) if isinstance(target, Relation) else (target,)
    trees = [*(meanings[name] for name in names_in(row.printed) if name in meanings), *sides]
    return {name for tree in trees if isinstance(tree, Node) for name in symbols(tree)}


def shown(compared: Plan, cells: tuple[Node, ...] | None) -> str:
    """Return the right formula as text, composed of the given cells or otherwise of the targets."""
    row = compared.row
    if cells is None:
        cells = tuple(compared.bench.theirs(row, target) for target in compared.targets)
        if len(cells) != len(compared.printed):
            return ", ".join(map(written, cells))
    if isinstance(row.printed, tuple):
        return in_rows(shaped(cells, len(row.printed[0])))
    texts = [written(cell) for cell in cells]
    if isinstance(row.printed, Equality) and len(texts) == 1:
        sides = row.printed
        reversed_ = texts and sides.rhs not in compared.printed
        return f"{texts[0]} = {written(sides.rhs)}" if reversed_ else f"{written(sides.lhs)} = {texts[0]}"
    return " = ".join(texts)


def in_rows(lines: Iterable[tuple[Node, ...]]) -> str:
    """Return the rows of a matrix as text."""
    return written(grid(lines))


def corrected(outcome: Outcome) -> Formula:
    """Return the formula that the row ought to print, in the names of the models."""
    compared, row = outcome.plan, outcome.row
    assert compared is not None
    scope = compared.bench.scope(row)
    cells = tuple(map(scope.ours, outcome.remedy.cells)) if outcome.remedy else tuple(compared.targets)
    if isinstance(row.printed, tuple):
        return shaped(cells, len(row.printed[0]))
    if isinstance(row.printed, Equality):
        if isinstance(compared, Multiple):
            return Equality(cells[0], cells[1])
        return Equality(scope.ours(row.printed.lhs), cells[0])
    return cells[0]


def dimension_fault(bench: Bench, row: Row) -> Said:
    """Return why a printed formula is not dimensionally homogeneous; empty if it is, or if that is not known."""
    if isinstance(row.printed, tuple):
        return Said("")  # the entries of a matrix have dimensions of their own
    try:
        exact = [bench.plain_expression(side) for side in cells(bench.in_ours(row))]
    except library.NotAFormula:
        return Said("")
    fault = library.inhomogeneity(exact, bench.dimensions)
    return say(*fault, table="dimensions") if fault else Said("")


def _target_fault(bench: Bench, compared: Plan) -> bool:
    """Return whether the target is not homogeneous either, e.g. because a length was set to one."""
    if not isinstance(compared, Equal | Multiple):
        return True
    exact = [bench.plain_expression(target) for target in compared.targets]
    return any(library.inhomogeneity([side], bench.dimensions) for side in exact) or bool(
        isinstance(compared, Multiple) and library.inhomogeneity(exact, bench.dimensions)
    )
