"""Search for the smallest edit that corrects a printed formula.

Edits are tried at two random points in a prime field, and those that pass are proved by both engines. The order is:
exchanges of rows and columns, single edits by increasing size, a missing term, and pairs of small edits. If no edit is
found, only the difference to the target can be reported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from satsym.auditing.comparison.equations import Equal
from satsym.auditing.comparison.plan import BoundPoint, Never, Plan
from satsym.auditing.diagnosis.edits import (
    Change,
    Edit,
    mean_edits,
    over_symbol,
    repeated_edits,
    single_edits,
    times_symbol,
)
from satsym.auditing.diagnosis.lacking import mended_terms
from satsym.auditing.sentences import Said, joined, say, sentence, tables
from satsym.formula import field
from satsym.formula.tree import Add, Neg, Node, Sym, replaced, size
from satsym.formula.writing import written
from satsym.symbolic.lookup.formulas import NotAFormula

PAIRS = 50
"""Number of pairs of edits that are proved, out of those that pass at two random points."""
_MOST_ENTRIES = 6


@dataclass(frozen=True)
class Remedy:
    """Edits that together correct what is printed."""

    edits: tuple[tuple[int, Edit], ...]
    """The edits, each with the index of its cell."""
    cells: tuple[Node, ...]
    """All cells after the edits."""
    exchange: Said | None = None
    """Description of the rows, columns or entries that are exchanged, if the correction is an exchange."""


def remedy(plan: Plan) -> Remedy | None:
    """Return the smallest edits that correct what is printed; ``None`` if none were found."""
    if isinstance(plan, Never):
        return None
    try:
        return _remedy(plan)
    except NotAFormula:
        return None


def first_remedy(ways: Sequence[Plan]) -> tuple[Plan, Remedy | None]:
    """Return the first of several plans for which edits were found, and the edits; otherwise the first plan."""
    return next(((way, found) for way in ways if (found := remedy(way)) is not None), (ways[0], None))


def _remedy(plan: Plan) -> Remedy | None:
    wrong = _wrong_cells(plan)
    if len(wrong) > 1:
        found = _exchanged(plan)
        if found is not None:
            return found
        if isinstance(plan, Equal):
            return _entry_by_entry(plan, wrong)
    cells = wrong if isinstance(plan, Equal) else range(len(plan.printed))
    return (
        _single(plan, cells)
        or _first(plan, mended_terms(plan, cells))
        or _entry(plan, cells)
        or _repeated(plan, cells)
        or _pair(plan, cells)
        or _edit_and_factor(plan, cells)
        or _means(plan, cells)
    )


def _wrong_cells(plan: Plan) -> list[int]:
    if isinstance(plan, Equal):
        return [i for i, cell in enumerate(plan.printed) if not plan.cell_holds(i, cell)]
    return list(range(len(plan.printed)))


def _with(plan: Plan, index: int, node: Node) -> tuple[Node, ...]:
    return (*plan.printed[:index], node, *plan.printed[index + 1 :])


def _edits(plan: Plan, index: int) -> list[Edit]:
    return single_edits(plan.printed[index], plan.bench.scope(plan.row), plan.useful.__contains__)


def _first(plan: Plan, edits: Iterable[tuple[int, Edit]]) -> Remedy | None:
    """Return the first edit that corrects all cells; ``None`` if no edit does."""
    for i, edit in edits:
        cells = _with(plan, i, edit.result)
        if plan.may_hold(cells) and plan.is_right(cells):
            return Remedy(((i, edit),), cells)
    return None


def _single(plan: Plan, indices: Sequence[int]) -> Remedy | None:
    edits = [(i, edit) for i in indices for edit in _edits(plan, i)]
    return _first(plan, sorted(edits, key=lambda entry: (entry[1].change, size(entry[1].result))))


def _repeated(plan: Plan, indices: Sequence[int]) -> Remedy | None:
    """Return the correction that repeats one slip at several places of one cell; ``None`` if there is none."""
    letters, usable = plan.bench.scope(plan.row), plan.useful.__contains__
    return _first(plan, ((i, edit) for i in indices for edit in repeated_edits(plan.printed[i], letters, usable)))


def _entry(plan: Plan, indices: Sequence[int]) -> Remedy | None:
    """Return the correction that replaces the only wrong entry of a matrix; ``None`` if several entries are wrong."""
    if not isinstance(plan, Equal) or not isinstance(plan.row.printed, tuple) or len(indices) != 1:
        return None
    edit = _whole(plan, indices[0])
    return Remedy(((indices[0], edit),), _with(plan, indices[0], edit.result))


def _whole(plan: Equal, index: int) -> Edit:
    aim = plan.bench.theirs(plan.row, plan.targets[index])
    return Edit(Change.ENTRY, (), plan.printed[index], aim, aim)


def _pair(plan: Plan, indices: Sequence[int]) -> Remedy | None:
    """Return a correction by two edits whose effects on the difference add up; ``None`` if there is none.

    The effect of each edit is computed separately, so that its partner is looked up instead of found by trial.
    """
    try:
        points = plan.points
        lacking = [
            [-values[0] for values in plan.residuals(point, plan.printed) if len(values) == 1] for point in points
        ]
    except (field.NoValue, field.Undecided):
        return None
    if not lacking[0]:
        return None
    effects: list[tuple[int, Edit, tuple[int, ...]]] = []
    for i in indices:
        for edit in _edits(plan, i):
            effect = _effect(plan, points, lacking, _with(plan, i, edit.result))
            if effect is not None and any(effect):
                effects.append((i, edit, effect))
    partners: dict[tuple[int, ...], list[tuple[int, Edit]]] = {}
    for i, edit, effect in effects:
        partners.setdefault(effect, []).append((i, edit))
    found: list[tuple[int, tuple[tuple[int, Edit], tuple[int, Edit]]]] = []
    for wanted in zip(*lacking, strict=True):
        for i, first, effect in effects:
            missing = tuple((w - e) % field.PRIME for w, e in zip(wanted, effect, strict=True))
            for k, second in partners.get(missing, ()):
                if (i, first.path) < (k, second.path) and (i != k or second.path[: len(first.path)] != first.path):
                    found.append((first.change + second.change, ((i, first), (k, second))))
    for _, pair in sorted(found, key=lambda entry: entry[0])[:PAIRS]:
        cells = plan.printed
        for i, edit in pair:
            cells = (*cells[:i], replaced(cells[i], edit.path, edit.new), *cells[i + 1 :])
        if plan.may_hold(cells) and plan.is_right(cells):
            return Remedy(pair, cells)
    return None


def _effect(
    plan: Plan, points: Sequence[BoundPoint], lacking: Sequence[Sequence[int]], cells: Sequence[Node]
) -> tuple[int, ...] | None:
    """Return by how much an edit changes the residual at each point.

    Return ``None`` if the edited formula has no value there.
    """
    try:
        return tuple(
            (next(plan.residuals(point, cells))[0] + before[0]) % field.PRIME
            for point, before in zip(points, lacking, strict=True)
        )
    except field.NoValue:
        return None


def _means(plan: Plan, indices: Sequence[int]) -> Remedy | None:
    """Return the correction that replaces means of two symbols by one of the symbols; ``None`` if there is none.

    A superfluous factor may be removed at the same time.
    """
    for i in indices:
        for end in mean_edits(plan.printed[i]):
            if found := _first(plan, [(i, end)]):
                return found
        for dropped in (*repeated_edits(plan.printed[i], plan.bench.scope(plan.row)), *_edits(plan, i)):
            if dropped.change is Change.DROPPED_FACTOR:
                for end in mean_edits(dropped.result):
                    if found := _first(plan, [(i, end)]):
                        return Remedy(((i, dropped), *found.edits), found.cells)
    return None


def _edit_and_factor(plan: Plan, indices: Sequence[int]) -> Remedy | None:
    """Return a correction by an edit and one missing symbol, as a factor or in the denominator.

    Return ``None`` if there is none.

    The symbol is found from the quotient of the target and the edited cell.
    """
    if not isinstance(plan, Equal) or len(indices) != 1:
        return None
    (i,) = indices
    try:
        aims = [point.base.value(plan.targets[i]) for point in plan.points]
        known = {name: [point.symbol(name) for point in plan.points] for name in sorted(plan.useful)}
    except (field.NoValue, field.Undecided):
        return None
    for edit in sorted(_edits(plan, i), key=lambda edit: edit.change):
        try:
            values = [point.value(edit.result) for point in plan.points]
        except field.NoValue:
            continue
        for name, sizes in known.items():
            factored = _missing_factor(aims, values, sizes)
            right = factored(edit.result, Sym(name)) if factored else edit.result
            cells = _with(plan, i, right)
            if factored and plan.is_right(cells):
                second = Edit(Change.MISSING_FACTOR, (), edit.result, right, right)
                return Remedy(((i, edit), (i, second)), cells)
    return None


def _missing_factor(
    aims: Sequence[int], values: Sequence[int], sizes: Sequence[int]
) -> Callable[[Node, Sym], Node] | None:
    """Return the function that inserts a missing factor as a factor or denominator.

    Return ``None`` if neither gives the aims.
    """
    found = list(zip(aims, values, sizes, strict=True))
    if all((aim - value * factor) % field.PRIME == 0 for aim, value, factor in found):
        return times_symbol
    if all((aim * factor - value) % field.PRIME == 0 for aim, value, factor in found):
        return over_symbol
    return None


def _entry_by_entry(plan: Equal, wrong: Sequence[int]) -> Remedy | None:
    """Return the correction of several wrong entries, each by its own edit or by its target."""
    if len(wrong) > _MOST_ENTRIES:
        return None
    edits: list[tuple[int, Edit]] = []
    for i in wrong:
        alone = plan.alone(i)
        right = (e for e in _edits(plan, i) if alone.may_hold((e.result,)) and alone.cell_holds(0, e.result))
        edits.append((i, next(right, None) or _whole(plan, i)))
    fixed = dict(edits)
    return Remedy(tuple(edits), tuple(fixed[i].result if i in fixed else cell for i, cell in enumerate(plan.printed)))


def _exchanged(plan: Plan) -> Remedy | None:
    """Return the correction by an exchange of two rows, columns or entries, or by transposition; otherwise ``None``."""
    printed = plan.row.printed
    if not isinstance(printed, tuple):
        return None
    m, n = len(printed), len(printed[0])
    for said, order in _exchanges(m, n):
        cells = tuple(plan.printed[k] for k in order)
        if cells != plan.printed and plan.may_hold(cells) and plan.is_right(cells):
            return Remedy((), cells, said)
    return None


def _exchanges(m: int, n: int) -> Iterator[tuple[Said, list[int]]]:
    """Yield the possible exchanges in an m by n matrix: a description, and the new order of the entries."""
    place = np.arange(m * n).reshape(m, n)
    for axis, lines in enumerate(("rows", "columns")):
        for i, k in combinations(range(place.shape[axis]), 2):
            order = np.arange(place.shape[axis])
            order[[i, k]] = k, i
            yield say(lines, str(i + 1), str(k + 1), table="exchanges"), place.take(order, axis).ravel().tolist()
    if m == n:
        yield say("transposed", table="exchanges"), place.T.ravel().tolist()
    for a, b in combinations(range(m * n), 2):
        order = np.arange(m * n)
        order[[a, b]] = b, a
        one, other = (f"({k // n + 1}, {k % n + 1})" for k in (a, b))
        yield say("entries", one, other, table="exchanges"), order.tolist()


def wrong_formula(
    labels: Sequence[str],
    remedy: Remedy | None,
    difference: str,
    why: str,
    derived: str,
    writer: Callable[[Node], str] = written,
) -> Said:
    """Return a sentence that says what is wrong: the edits, or otherwise the lacking term, or the right formula."""
    if why:
        return say("wrong_size", why)
    if remedy is None:
        return (
            say("lacking", difference) if difference else say("no_edit", derived) if derived else say("no_small_edit")
        )
    if remedy.exchange:
        return sentence(remedy.exchange)
    return sentence(joined((joined([_place(labels[i]), in_words(edit, writer)], "") for i, edit in remedy.edits), "; "))


def in_words(edit: Edit, writer: Callable[[Node], str] = written) -> Said:
    """Return one edit described in words, with formulas written by `writer`."""
    old, new = edit.old, edit.new
    if edit.change is Change.SIGN:
        old = old.operand if isinstance(old, Neg) else old
    term = new.terms[-1] if edit.change is Change.MISSING_TERM and isinstance(new, Add) else new
    table, kind = "repeated_edits" if edit.times > 1 else "edits", edit.change.name.lower()
    known = kind if kind in tables()[table] else "other"
    return say(known, writer(old), writer(new), _signed(term, writer), str(edit.times), table=table)


def _place(label: str) -> Said:
    if not label:
        return Said("")
    if label.endswith("side"):
        side = "kiri" if label.startswith("left") else "kanan"
        return Said(f"in the {label} ", f"di ruas {side} ")
    return Said(f"entry ({label}): ", f"entri ({label}): ") if label[0].isdigit() else Said(f"{label}: ")


def _signed(term: Node, writer: Callable[[Node], str]) -> str:
    return writer(term) if isinstance(term, Neg) else f"+{writer(term)}"
