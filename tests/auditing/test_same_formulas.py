"""What two documents print alike is judged alike; where the verdicts differ, what each document adds says why."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

import pytest

from satsym.auditing import Judged, cache
from satsym.auditing.judge.bench import in_ours
from satsym.auditing.ledger.contents import Row
from satsym.formula.tree import Equality, Node
from satsym.formula.writing import written
from tests.support.claims import DOCUMENTS, bench

pytestmark = pytest.mark.slow  # all ledgers are judged, unless they are in the cache
Entry = tuple[str, Row, Judged]


def letters(formula: Node | Equality | tuple[tuple[Node, ...], ...]) -> str:
    if isinstance(formula, tuple):
        return str([[written(entry) for entry in line] for line in formula])
    if isinstance(formula, Equality):
        return f"{written(formula.lhs)} = {written(formula.rhs)}"
    return written(formula)


def content(document: str, row: Row) -> tuple[str, ...] | None:
    """What a row prints and is held against, in names that no document owns; nothing where it speaks of its own."""
    if not row.table.legible:
        return None
    if row.claims is not None:
        names = [name for name in row.claims.symbols if name != "printed"]
        return None if row.claims.rows or names else ("claim", row.claims.text, str(row.table.printed))
    if row.printed is None:
        return ("value", str(row.table.printed), row.table.holds)
    assert row.holds is not None
    return ("formula", letters(in_ours(row.printed, bench(document).scope(row))), letters(row.holds))


@pytest.fixture(scope="module")
def shared() -> list[list[Entry]]:
    """Rows of the same content that stand in more than one document."""
    groups: dict[tuple[str, ...], list[Entry]] = defaultdict(list)
    for document in DOCUMENTS:
        ledger = bench(document).ledger
        found = {row.key: row for row in cache.audit(ledger)}
        for row in ledger.rows:
            key = content(document, row)
            if key is not None:
                groups[key].append((document, row, found[row.key]))
    return [group for group in groups.values() if len({document for document, _, _ in group}) > 1]


def pairs(shared: list[list[Entry]]) -> Iterator[tuple[Entry, Entry]]:
    for group in shared:
        yield from ((group[0], other) for other in group[1:])


def truth(entry: Entry) -> bool:
    return entry[2].verdict in ("confirmed", "unsound")


def test_documents_share_formulas_of_every_kind(shared: list[list[Entry]]) -> None:
    assert len(shared) > 100
    assert {row.table.kind for group in shared for _, row, _ in group} >= {"equation", "matrix", "claim", "table"}


def test_what_is_true_in_one_document_is_true_in_the_other(shared: list[list[Entry]]) -> None:
    for one, other in pairs(shared):
        assert truth(one) is truth(other), (one[:2], other[:2])


def test_verdicts_that_differ_have_their_reason_in_what_one_document_adds(shared: list[list[Entry]]) -> None:
    differing = 0
    for group in shared:
        verdicts = {judged.verdict for _, _, judged in group}
        for document, row, judged in group:
            others = [entry for entry in group if entry[2].verdict != judged.verdict]
            differing += bool(others)
            if judged.verdict == "unsound" and others:  # it gives a reason of its own, or says how it follows
                assert row.because is not None or row.follows is not None, row.key
                assert all(entry[1].table.because != row.table.because or row.uses != entry[1].uses for entry in others)
            elif judged.verdict == "artefact":  # its program does it; the others print no such program
                assert row.produced is not None
                for elsewhere, _, _ in others:
                    assert elsewhere != document
                    assert row.produced.rows, row.key
                    assert not set(row.produced.rows) & set(bench(elsewhere).rows), (row.key, elsewhere)
            elif verdicts == {"wrong", "misprint"} and judged.verdict == "wrong":  # what follows uses it
                assert "carried on" in judged.diagnosis, row.key
            else:
                settled = {"artefact", "unsound", "wrong"} if truth((document, row, judged)) is False else {"unsound"}
                assert all(entry[2].verdict in settled for entry in others), (document, row.key, verdicts)
    assert differing
