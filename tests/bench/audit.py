"""Slips planted in what the documents print rightly, and harmless rewritings: how many the audit sees, and names.

Slips are drawn here, on the printed trees, by rules of their own: not by the edits that the diagnosis tries. A slip
counts as *named* where the correction is what was printed before; a claim is named by its row. Changes after which a
claim is still true are no slips: they are listed in ``equivalent.toml``, each with the reason. The documents are judged
in two processes. Usage: ``python -m tests.bench.audit [N]``, for N slips in formulas of each document.
"""

from __future__ import annotations

import ast
import random
import sys
import tomllib
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from satsym.auditing import quantities
from satsym.auditing.comparison.bench import Bench
from satsym.auditing.judge import formula as formulas
from satsym.auditing.judge import value
from satsym.auditing.judged import Judged
from satsym.auditing.ledger.contents import Ledger, Row
from satsym.auditing.outcome import Outcome
from satsym.auditing.propositions.relations import Fit, fit_of_range
from satsym.auditing.run import audit
from satsym.formula import field
from satsym.formula.functions import row_key
from satsym.formula.tree import (
    Add,
    Call,
    Div,
    Equality,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    Text,
    each,
    names_in,
    number,
    replaced,
    substituted,
    symbols,
    walk,
)  # fmt: skip
from satsym.formula.tree import Path as Place
from satsym.formula.writing import written
from satsym.status import BadInput
from tests.support.claims import DOCUMENTS, bench, changes, claims, judged, other_digit, turns

SEED = 7
ALIAS = "_again"
"""Ends the second name of a letter."""
LABELS = {
    "claim: all for any": "claim: universal quantifier instead of existential",
    "formula: factor": "formula: added factor",
    "formula: inverted": "formula: inverted fraction",
    "formula: letter": "formula: replaced letter",
    "formula: lost": "formula: dropped term or factor",
    "reference: row": "reference: cited item",
    "rewriting: letter": "rewriting: equivalent letter",
    "rewriting: order": "rewriting: order of terms and factors",
}
"""Rows of the table whose names in this file are too short for readers."""
EQUIVALENT: dict[str, list[list[str]]] = {
    document: [[row, text] for row, texts in rows.items() for text in texts]
    for document, rows in tomllib.loads(Path(__file__).with_name("equivalent.toml").read_text(encoding="utf-8")).items()
}


@dataclass(frozen=True)
class Trial:
    """One change of what is printed.

    Attributes
    ----------
    kind
        What was done.
    caught, named
        Whether the row is no longer confirmed, and whether the correction is what was printed.
    text
        The row and what it prints now.
    """

    kind: str
    caught: bool
    named: bool
    text: str


def sign(rng: random.Random, part: Node, _: list[str]) -> Node | None:
    return part.operand if isinstance(part, Neg) else Neg(part) if isinstance(part, Sym | Mul | Div | Pow) else None


def letter(rng: random.Random, part: Node, known: list[str]) -> Node | None:
    if not isinstance(part, Sym):
        return None
    others = [name for name in known if name != part.name]
    return Sym(rng.choice(others)) if others else None


def factor(rng: random.Random, part: Node, _: list[str]) -> Node | None:
    if isinstance(part, Num) and part.value:
        return Num(part.value * rng.choice([2, 3, Fraction(1, 2)]))
    return Mul((number(Fraction(rng.choice([2, 3]))), part)) if isinstance(part, Sym | Pow) else None


def exponent(rng: random.Random, part: Node, _: list[str]) -> Node | None:
    if isinstance(part, Pow) and isinstance(part.exponent, Num):
        return Pow(part.base, Num(part.exponent.value + 1)) if part.exponent.value != -1 else None
    return Pow(part, number(Fraction(2))) if isinstance(part, Sym) else None


def lost(rng: random.Random, part: Node, _: list[str]) -> Node | None:
    for kind in (Add, Mul):
        if isinstance(part, kind):
            entries = part.terms if isinstance(part, Add) else part.factors
            k = rng.randrange(len(entries))
            rest = entries[:k] + entries[k + 1 :]
            return rest[0] if len(rest) == 1 else kind(rest)
    return None


def inverted(rng: random.Random, part: Node, _: list[str]) -> Node | None:
    return Div(part.denominator, part.numerator) if isinstance(part, Div) else None


SLIPS: tuple[Callable[[random.Random, Node, list[str]], Node | None], ...] = (
    sign, letter, factor, exponent, lost, inverted,
)  # fmt: skip


def reordered(rng: random.Random, tree: Node) -> Node:
    """The same formula with the terms of its sums and the factors of its products in another order."""
    for path, part in list(walk(tree)):
        if isinstance(part, Add | Mul):
            entries = list(part.terms if isinstance(part, Add) else part.factors)
            rng.shuffle(entries)
            tree = replaced(tree, path, Add(tuple(entries)) if isinstance(part, Add) else Mul(tuple(entries)))
            break
    return tree


def planted(ready: Bench, row: Row, rng: random.Random) -> Trial | None:
    """A slip in a formula row; ``None`` where the drawn change does not change it."""
    cells, put = _cells(row)
    k = rng.randrange(len(cells))
    path, part = rng.choice(list(walk(cells[k])))
    slip = rng.choice(SLIPS)
    new = slip(rng, part, sorted(ready.scope(row).meanings))
    if new is None:
        return None
    changed = replaced(cells[k], path, new)
    if not _differs(ready, row, cells[k], changed):
        return None
    found = _judged(ready, replace(row, printed=put(k, changed)))
    if found is None:
        return None
    texts = [written(c) for c in found.remedy.cells] if found.remedy else []
    named = not found.right and any(written(cell) in texts for cell in (cells[k], *_same(ready, row, cells[k], found)))
    return Trial(f"formula: {slip.__name__}", not found.right or found.unit, named, f"{row.key}: {written(changed)}")


def rewritten(ready: Bench, row: Row, rng: random.Random) -> Trial | None:
    """A formula row with terms and factors in another order; caught means a false alarm."""
    cells, put = _cells(row)
    k = rng.randrange(len(cells))
    changed = reordered(rng, cells[k])
    if changed == cells[k]:
        return None
    found = _judged(ready, replace(row, printed=put(k, changed)))
    return None if found is None else Trial("rewriting: order", not found.right, True, f"{row.key}: {written(changed)}")


def relettered(ready: Bench, row: Row, rng: random.Random) -> Trial | None:
    """A formula row with another letter that means the same throughout; caught means a false alarm."""
    letters = sorted(name for name in names_in(row.printed) if name + ALIAS in ready.scope(row).meanings)
    if row.printed is None or not letters:
        return None
    old = rng.choice(letters)
    changed = each(row.printed, lambda cell: substituted(cell, {old: Sym(old + ALIAS)}))
    found = _judged(ready, replace(row, printed=changed))
    return None if found is None else Trial("rewriting: letter", not found.right, True, f"{row.key}: {old}")


def with_aliases(ledger: Ledger) -> Bench:
    """A ledger in whose notations every letter has a second one that means the same."""
    scopes = {
        name: replace(scope, meanings={**scope.meanings, **{n + ALIAS: m for n, m in scope.meanings.items()}})
        for name, scope in ledger.scopes.items()
    }
    return Bench(replace(ledger, scopes=scopes))


def rerounded(ready: Bench, row: Row) -> Iterator[Trial]:
    """A number with fewer or more digits, as recomputed; caught means a false alarm."""
    found, before = value.number(ready, row), quantities.printed_number(str(row.table.printed))
    exact = found.evidence.get("recomputed")
    for figures in range(2, 7) if isinstance(exact, float) else ():
        text = f"{exact:.{figures}g}" + ("" if before.unit == "1" else f" {before.unit}")
        right = value.number(ready, replace_table(row, text)).right
        yield Trial("rewriting: rounding", not right, True, f"{row.key}: {text}")


def exchanged(text: str) -> Iterator[str]:
    """A proposition with the sides of its relations exchanged, and its conjunctions and disjunctions read backwards."""
    tree = ast.parse(text, mode="eval")
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _MIRRORED:
            node.left, node.comparators = node.comparators[0], [node.left]
            node.ops = [_MIRRORED[type(node.ops[0])]()]
        elif isinstance(node, ast.BoolOp):
            node.values.reverse()
    changed = ast.unparse(tree)
    if changed != ast.unparse(ast.parse(text, mode="eval")):
        yield changed


_MIRRORED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Eq: ast.Eq, ast.NotEq: ast.NotEq, ast.Lt: ast.Gt, ast.Gt: ast.Lt, ast.LtE: ast.GtE, ast.GtE: ast.LtE
}  # fmt: skip


def references(document: str, rng: random.Random) -> Iterator[Trial]:
    """A row that follows from others, with another row of the document named in the place of one of these.

    Named where the diagnosis gives the row that was put in. Rows that print the same are no slip.
    """
    ready = bench(document)
    formulas_of = {row.key: row for row in ready.ledger.rows if row.printed is not None and row.holds is not None}
    for row in ready.ledger.rows:
        if row.follows is None or _verdict(ready.ledger, row).verdict != "confirmed":
            continue
        named = [(at, part) for at, part in _walked(row.follows) if isinstance(part, Call) and part.function == "row"]
        (side, path), call = rng.choice(named)
        old = formulas_of.get(row_key(call))
        others = [
            key for key, candidate in formulas_of.items() if old and key != row.key and _alike(ready, candidate, old)
        ]
        if old is None or not others:
            continue
        other = formulas_of[rng.choice(others)]
        new = Call("row", tuple(Text(t) for t in (other.table.item, other.table.part) if t))
        changed = replace(row, follows=_put(row.follows, side, path, new))
        rows = tuple(changed if entry.key == row.key else entry for entry in ready.ledger.rows)
        try:
            found = _verdict(replace(ready.ledger, rows=rows), row)
        except BadInput:  # what it names cannot be put in there
            continue
        caught = found.verdict != "confirmed"
        yield Trial("reference: row", caught, other.key in found.diagnosis, f"{row.key}: {other.key} for {old.key}")


def _verdict(ledger: Ledger, row: Row) -> Judged:
    return next(found for found in audit(ledger, [row.key]) if found.key == row.key)


def _walked(formula: Node | Equality) -> Iterator[tuple[tuple[int, Place], Node]]:
    sides = (formula.lhs, formula.rhs) if isinstance(formula, Equality) else (formula,)
    for k, side in enumerate(sides):
        for path, part in walk(side):
            yield (k, path), part


def _put(formula: Node | Equality, side: int, path: Place, new: Node) -> Node | Equality:
    if not isinstance(formula, Equality):
        return replaced(formula, path, new)
    sides = [formula.lhs, formula.rhs]
    sides[side] = replaced(sides[side], path, new)
    return Equality(*sides)


def _alike(ready: Bench, one: Row, other: Row) -> bool:
    """Whether two rows print formulas of one kind in one notation, and not the same."""
    same_kind = one.table.scope == other.table.scope and type(one.printed) is type(other.printed)
    return same_kind and one.table.holds != other.table.holds and bool(ready.of_row(one) != ready.of_row(other))


def digits(ready: Bench, row: Row) -> Trial | None:
    """A number with another first digit; named where what is right lies inside what was printed before."""
    text = str(row.table.printed)
    if not any(c in "123456789" for c in text):
        return None
    changed = replace_table(row, other_digit(text))
    found, before = value.number(ready, changed), quantities.printed_number(text)
    derived, _, unit = found.derived.partition(" ")
    right = float(Fraction(derived))
    named = (unit or "1") == before.unit and fit_of_range(right, right, before) is Fit.INSIDE
    return Trial("number: digit", not found.right, named, f"{row.key}: {changed.table.printed}")


def replace_table(row: Row, printed: str) -> Row:
    """A row that prints something else."""
    import msgspec

    return replace(row, table=msgspec.structs.replace(row.table, printed=printed))


def of_claims(document: str) -> Iterator[Trial]:
    """Every confirmed claim with one leaf changed; and each claim, its sides exchanged, which has to stay as it is."""
    for row in claims(document):
        before = judged(document, row, str(row.table.printed))
        for text in exchanged(" ".join(str(row.table.printed).split())):
            other = judged(document, row, text).truth is not before.truth
            yield Trial("rewriting: sides of a claim", other, True, f"{row.key}: {text}")
        for changed in changes(str(row.table.printed)) if before.truth else ():
            if changed.kind != "any for all" and [row.key, changed.text] not in EQUIVALENT.get(document, []):
                turned = turns(document, row, changed, before)
                yield Trial(f"claim: {changed.kind}", turned, turned, f"{row.key}: {changed.text}")


def trials(document: str, count: int) -> Iterator[Trial]:
    """Slips and rewritings of a document."""
    rng, ready = random.Random(f"{SEED} {document}"), bench(document)
    right = [row for row in ready.ledger.rows if row.printed is not None and row.holds is not None]
    right = [row for row in right if row.table.kind in ("equation", "matrix", "algorithm")]
    right = [row for row in right if (found := _judged(ready, row)) is not None and found.right and not found.unit]
    aliased = with_aliases(ready.ledger)
    for make, desk, wanted in (
        (planted, ready, count),
        (rewritten, ready, count // 4),
        (relettered, aliased, count // 4),
    ):
        done = 0
        for _ in range(20 * wanted):
            trial = make(desk, rng.choice(right), rng)
            if trial is not None:
                done += 1
                yield trial
            if done == wanted:
                break
    for row in ready.ledger.rows:
        numeric = row.table.kind == "number" and row.table.legible and row.holds is not None
        if numeric and value.number(ready, row).right:
            yield from filter(None, [digits(ready, row)])
            yield from rerounded(ready, row)
    yield from references(document, rng)
    yield from of_claims(document)


def _cells(row: Row) -> tuple[list[Node], Callable[[int, Node], Any]]:
    """The printed cells of a row that may be changed, and what puts one back."""
    printed = row.printed
    if isinstance(printed, tuple):
        flat, columns = [entry for line in printed for entry in line], len(printed[0])

        def into_matrix(k: int, cell: Node) -> Any:
            new = [*flat[:k], cell, *flat[k + 1 :]]
            return tuple(tuple(new[i : i + columns]) for i in range(0, len(new), columns))

        return flat, into_matrix
    if isinstance(printed, Equality):
        return [printed.rhs], lambda _, cell: Equality(printed.lhs, cell)
    assert printed is not None
    return [printed], lambda _, cell: cell


def _judged(ready: Bench, row: Row) -> Outcome | None:
    try:
        return formulas.judge(ready, row)
    except (BadInput, field.Undecided):
        return None


def _differs(ready: Bench, row: Row, one: Node, other: Node) -> bool:
    try:
        difference = ready.printed(row, Add((one, Neg(other)))).trees
        return not field.vanishes(difference, "planted", ready.names.positive)
    except (BadInput, field.Undecided, AssertionError, TypeError, AttributeError):
        return bool(symbols(one) ^ symbols(other))


def _same(ready: Bench, row: Row, cell: Node, found: Outcome) -> list[Node]:
    """Corrections that are the printed cell, written in another way."""
    cells = found.remedy.cells if found.remedy else ()
    return [other for other in cells if not _differs(ready, row, cell, other)]


def _all_trials(document: str, count: int) -> list[Trial]:
    return list(trials(document, count))


def main(count: int) -> int:
    """Print the table, and what was missed or not named."""
    tally: dict[str, Counter[str]] = defaultdict(Counter)
    missed = []
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        found = dict(zip(DOCUMENTS, pool.map(partial(_all_trials, count=count), DOCUMENTS), strict=True))
    for document, trial in ((name, trial) for name, made in found.items() for trial in made):
        tally[trial.kind].update(tried=1, caught=int(trial.caught), named=int(trial.caught and trial.named))
        if trial.caught == trial.kind.startswith("rewriting"):
            missed.append(f"{document}: {trial.kind}: {trial.text}")
        elif trial.caught and not trial.named:
            missed.append(f"not named: {document}: {trial.kind}: {trial.text}")
    print("| what is changed | tried | caught | named exactly |\n| --- | ---: | ---: | ---: |")
    for kind in sorted(tally):
        name = LABELS.get(kind, kind)
        print(f"| {name} | {tally[kind]['tried']} | {tally[kind]['caught']} | {tally[kind]['named']} |")
    total = sum((Counter(tally[kind]) for kind in tally if not kind.startswith("rewriting")), Counter())
    print(f"| all errors | {total['tried']} | {total['caught']} | {total['named']} |")
    print("\n".join(["", *missed]))
    return 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 400))
