"""Diagnosis of a wrong equation: the smallest edit that corrects it, searched in the same way as in an audit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

from satsym.auditing.ledger.contents import Ledger, Row
from satsym.auditing.ledger.schema import DocumentTable, RowTable
from satsym.auditing.ledger.scopes import Scope
from satsym.auditing.sentences import Said, in_indonesian
from satsym.formula import budget
from satsym.formula.tree import ZERO, Call, Equality, Node, Sym, cells, each, mapped, names_in, size, substituted
from satsym.formula.weight import Scales
from satsym.formula.writing import written
from satsym.status import BadInput

if TYPE_CHECKING:
    from satsym.auditing.check.answer import Subject
    from satsym.auditing.check.answers import Fit
    from satsym.auditing.comparison.bench import Bench
    from satsym.auditing.comparison.plan import Plan
    from satsym.auditing.diagnosis.smallest_edit import Remedy

NO_EDIT = 60.0
"""Cost of an equation for which no edit was found; for comparison, a single edit costs at most about 20."""


_LIMIT = budget.Limit(3_000_000)
"""Limit of work for the search for one edit; a few seconds."""
_SHORT_EQUATION = 80
"""Number of parts of the two equations together, up to which the search is quick without counting its work."""


@dataclass(frozen=True)
class Found:
    """The result of a search for an edit: whether the equation holds, what is wrong, the correction, and the cost."""

    right: bool
    diagnosis: str
    correct: Node | Equality | None
    cost: float


def with_names(statement: Node | Equality, subject: Subject) -> tuple[Node | Equality, dict[str, Node]]:
    """Return the statement with each unevaluated derivative replaced by a letter, and what these letters stand for."""
    found: dict[str, Node] = {}
    taken = set(subject.reading.letters)
    names = (name for k in count(1) if (name := f"D{k}") not in taken)

    def named(part: Node) -> Node | None:
        if not isinstance(part, Call) or part.function not in ("diff", "d"):
            return None
        name = next((known for known, tree in found.items() if tree == part), None) or next(names)
        found[name] = part
        return Sym(name)

    return each(statement, lambda side: mapped(side, named)), found


def sought(named: Node | Equality, derivatives: Mapping[str, Node], fit: Fit, subject: Subject) -> Found:
    """Return the smallest edit that turns the statement into the similar equation of the model."""
    assert fit.target is not None
    bench, row = _bench(named, derivatives, fit, subject)
    try:
        long = sum(size(side) for tree in (named, fit.target.equation) for side in cells(tree)) > _SHORT_EQUATION
        return budget.within(_LIMIT, lambda: _sought(bench, row, derivatives, subject), calls=long)
    except budget.OverBudget:
        return Found(False, "it is too long to search for the error in it", None, NO_EDIT)


def _sought(bench: Bench, row: Row, derivatives: Mapping[str, Node], subject: Subject) -> Found:
    assert row.printed is not None
    from satsym.auditing.comparison.compare import plans
    from satsym.auditing.diagnosis.smallest_edit import first_remedy, wrong_formula

    ways = plans(bench, row, row.printed, bench.target(row))
    if any(way.is_right(way.printed) for way in ways):
        return Found(True, "", None, 0.0)
    compared, fix = first_remedy(ways)
    write = subject.writer(subject.latex, subject.derivatives(subject.latex, derivatives))
    correct = _correct(bench, row, compared, fix)
    said = wrong_formula([""] * len(compared.labels), fix, "", "", write(correct) if correct else "", write)
    diagnosis = Said(*(_clause(text) for text in (str(said), in_indonesian(said))))
    return Found(False, diagnosis, correct, _cost(fix))


def _clause(text: str) -> str:
    """Return a sentence as a clause: without a capital, full stop, or quotation marks around formulas."""
    text = text.replace("`", "").rstrip(".")
    return text[:1].lower() + text[1:] if text[:2].istitle() and text[1:2].islower() else text


def _cost(fix: Remedy | None) -> float:
    if fix is None:
        return NO_EDIT
    return sum(int(edit.change) for _, edit in fix.edits) + 12.0 * (len(fix.edits) - 1) if fix.edits else 3.0


def _correct(bench: Bench, row: Row, compared: Plan, fix: Remedy | None) -> Node | Equality | None:
    """Return the correct equation in the symbols of the printed one."""
    if fix is not None:
        cells: tuple[Node, ...] = fix.cells
    else:
        cells = tuple(bench.theirs(row, target) for target in compared.targets)
    if not isinstance(row.printed, Equality):
        return cells[0] if len(cells) == 1 else None
    if len(cells) == 2:
        return Equality(cells[0], cells[1])
    if len(cells) != 1:
        return None
    sides = row.printed
    return Equality(cells[0], sides.rhs) if sides.rhs not in compared.printed else Equality(sides.lhs, cells[0])


def _bench(named: Node | Equality, derivatives: Mapping[str, Node], fit: Fit, subject: Subject) -> tuple[Bench, Row]:
    """Return a ledger whose only row is the statement, with the tools to judge it, and the row."""
    from satsym.auditing.comparison.bench import Bench

    derived = subject.derived
    assert fit.target is not None
    known = subject.meant(named, derivatives, fit.guess)
    for name, tree in _others(fit, subject).items():
        known.setdefault(name, tree)
    lacking = sorted(names_in(named) - {*known, "I", "pi"})
    if lacking:
        raise BadInput(f"{', '.join(lacking)} might have no meaning in {derived.record.name}")
    besides = dict.fromkeys(derived.controls, ZERO) if fit.free else {}
    equation = fit.target.equation
    held = equation if isinstance(named, Equality) else equation.rhs
    holds = each(held, lambda side: substituted(side, besides))
    scales = Scales()
    table = RowTable(item="1", kind="equation", printed=written(named), holds="1")
    row = Row(table, "1", "formula", printed=scales.checked(named), holds=scales.checked(holds))
    ledger = Ledger(
        Path("formula"),
        "formula",
        DocumentTable(key="formula", title="formula"),
        {"main": Scope("main", known, {})},
        {},
        {},
        (row,),
        derived.record.name,
        None,
    )
    return Bench(ledger), row


def _others(fit: Fit, subject: Subject) -> dict[str, Node]:
    """Return letters that an edit may insert, with their meanings: the model's own, and those of guessed families.

    A family is, e.g., x1, x2, x3: if one member is printed, the edit may need another.
    """
    meanings = subject.meanings
    found: dict[str, Node] = {}
    taken = set(fit.guess.meaning.values())
    guessed = dict(fit.guess.meaning)
    families = {letter.base for letter in guessed if letter.index}
    states, costates, controls = subject.derived.states, subject.derived.costates, subject.derived.controls
    for letter, name in guessed.items():
        group = next((g for g in (states, costates, controls) if name in g), ())
        if (
            letter.base in families
            and letter.index.isdigit()
            and name in group
            and group.index(name) + 1 == int(letter.index)
        ):
            for k, other in enumerate(group, start=1):
                guessed = {**guessed, replace(letter, index=str(k), foot=str(k)): other}
    if not families:
        for k, base in enumerate("xyz"):
            places = [x for x in states if x in subject.derived.speeds]
            if k < len(places) and any(letter.base in "xyz" for letter in fit.guess.meaning) and places[k] not in taken:
                guessed = {**guessed, type(next(iter(guessed)))(base): places[k]}
    for letter, name in guessed.items():
        for dots in range(3):
            dotted = replace(letter, dots=dots)
            tree = meanings.tree(dotted, guessed)
            if tree is not None and isinstance(tree, Sym) and (dots == 0 or name in (*states, *costates)):
                subject.letters.setdefault(dotted.name, dotted)
                found[dotted.name] = tree
    used = {tree.name for tree in found.values() if isinstance(tree, Sym)}
    for letter in meanings.known:
        tree = meanings.tree(letter, {})
        if isinstance(tree, Sym) and tree.name not in used and tree.name in subject.derived.base | _rates(subject):
            found.setdefault(letter.name, tree)
    return found


def _rates(subject: Subject) -> set[str]:
    return {f"d_{name}" for name in (*subject.derived.states, *subject.derived.costates)} | {"H"}
