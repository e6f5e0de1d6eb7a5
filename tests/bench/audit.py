"""Slips planted in what the documents print rightly, and harmless rewritings: how many the audit sees, and names.

Slips are drawn here, on the printed trees, by rules of their own: not by the edits that the diagnosis tries. A slip
counts as *named* where the correction is what was printed before; a claim is named by its row. Changes after which a
claim is still true are no slips: they are listed in ``equivalent.toml``, each with the reason. The documents are judged
in two processes. Usage: ``python -m tests.bench.audit [N]``, for N slips in formulas of each document.
"""

from __future__ import annotations

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
from satsym.auditing.judge import formula as formulas
from satsym.auditing.judge import value
from satsym.auditing.judge.bench import Bench
from satsym.auditing.ledger.contents import Row
from satsym.auditing.outcome import Outcome
from satsym.auditing.propositions.relations import Fit, fit_of_range
from satsym.formula import field
from satsym.formula.tree import Add, Div, Equality, Mul, Neg, Node, Num, Pow, Sym, number, replaced, symbols, walk
from satsym.formula.writing import written
from satsym.status import BadInput
from tests.support.claims import DOCUMENTS, bench, changes, claims, judged, other_digit, turns

SEED = 7
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
    """A harmless change of a formula row; caught means a false alarm."""
    cells, put = _cells(row)
    k = rng.randrange(len(cells))
    changed = reordered(rng, cells[k])
    if changed == cells[k]:
        return None
    found = _judged(ready, replace(row, printed=put(k, changed)))
    if found is None:
        return None
    return Trial("rewriting: order", not found.right, True, f"{row.key}: {written(changed)}")


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
    """Every confirmed claim with one leaf changed."""
    for row in claims(document):
        before = judged(document, row, str(row.table.printed))
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
    for make, wanted in ((planted, count), (rewritten, count // 4)):
        done = 0
        for _ in range(20 * wanted):
            trial = make(ready, rng.choice(right), rng)
            if trial is not None:
                done += 1
                yield trial
            if done == wanted:
                break
    for row in ready.ledger.rows:
        numeric = row.table.kind == "number" and row.table.legible and row.holds is not None
        if numeric and value.number(ready, row).right and (other := digits(ready, row)) is not None:
            yield other
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
    for document, trial in ((name, trial) for name, each in found.items() for trial in each):
        tally[trial.kind].update(tried=1, caught=int(trial.caught), named=int(trial.caught and trial.named))
        if trial.caught == trial.kind.startswith("rewriting"):
            missed.append(f"{document}: {trial.kind}: {trial.text}")
        elif trial.caught and not trial.named:
            missed.append(f"not named: {document}: {trial.kind}: {trial.text}")
    print("| what is changed | tried | caught | named exactly |\n| --- | ---: | ---: | ---: |")
    for kind in sorted(tally):
        print(f"| {kind} | {tally[kind]['tried']} | {tally[kind]['caught']} | {tally[kind]['named']} |")
    total = sum((Counter(tally[kind]) for kind in tally if not kind.startswith("rewriting")), Counter())
    print(f"| all slips | {total['tried']} | {total['caught']} | {total['named']} |")
    print("\n".join(["", *missed]))
    return 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 400))
