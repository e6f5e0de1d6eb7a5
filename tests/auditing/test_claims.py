"""What the documents claim: the verdict depends on what is printed, and turns when that is turned."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import pytest

from tests.support.claims import DOCUMENTS, bench, changes, claims, judged, turns

VARIANTS = Path(__file__).parent / "variants"


@pytest.mark.parametrize("document", DOCUMENTS)
def test_each_claim_denied_has_the_other_truth(document: str, sample: Callable[[Iterable[Any]], list[Any]]) -> None:
    open_ = []
    for row in sample(claims(document)):
        before = judged(document, row, str(row.table.printed))
        after = judged(document, row, f"not ({row.table.printed})")
        if before.truth is None:
            open_.append(row.key)
            assert after.truth is None, row.key
        else:
            assert after.truth is not before.truth, row.key
            assert after.truth is not None, row.key
    assert not open_


@pytest.mark.parametrize("document", DOCUMENTS)
def test_for_each_claim_that_falls_a_true_sentence_of_its_form_is_confirmed(document: str) -> None:
    path = VARIANTS / f"{document}.toml"
    variants = tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    for row in claims(document):
        if judged(document, row, str(row.table.printed)).truth is not True:
            assert row.key in variants, f"{row.key}: no true sentence of this form"
            found = judged(document, row, variants[row.key])
            assert found.truth is True, f"{row.key}: {found.reasons}"
            assert not found.vacuous, row.key


@pytest.mark.slow
@pytest.mark.parametrize("document", DOCUMENTS)
def test_confirmed_claims_with_one_leaf_changed_are_not_confirmed(document: str) -> None:
    turned, stayed = 0, []
    for row in claims(document):
        before = judged(document, row, str(row.table.printed))
        if before.truth and not before.vacuous:
            for changed in changes(str(row.table.printed)):
                if changed.kind == "any for all":
                    continue  # what holds of all holds of some
                if turns(document, row, changed, before):
                    turned += 1
                else:
                    stayed.append(f"{row.key}: {changed.kind}: {changed.text}")
    assert turned >= 0.95 * (turned + len(stayed)), "\n".join(stayed)


@pytest.mark.parametrize("document", DOCUMENTS)
def test_each_claim_says_what_it_is_drawn_from_and_quotes_the_document(document: str) -> None:
    for row in claims(document):
        assert not isinstance(row.table.follows, str), f"{row.key}: no list of rows in `from`"
        assert row.table.original or row.table.role == "notation", row.key
        assert not row.table.says, f"{row.key}: a third paraphrase"
    assert bench(document).ledger.rows
