"""The worked example of CONTRIBUTING: a measurement is one function, and claims may speak of it at once."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import pytest

from satsym.auditing import measurements
from satsym.auditing.measurements.linear import eigenvalues
from satsym.auditing.propositions.evaluation import Answer, Evaluation
from satsym.auditing.propositions.reading import proposition
from satsym.auditing.propositions.values import Undecided
from satsym.status import BadInput
from tests.support.contributing import example


@pytest.fixture
def half_life() -> Iterator[None]:
    """The measurement as CONTRIBUTING prints it."""
    scope: dict[str, Any] = {"Any": Any, "Undecided": Undecided, "eigenvalues": eigenvalues, "math": math}
    exec(example("A measurement", "python"), scope)  # noqa: S102
    measurements.enter(scope["half_life"])
    yield
    del measurements.words().functions["half_life"]  # type: ignore[attr-defined]


def answer(text: str) -> Answer:
    words = measurements.words()
    return Evaluation(words).answer(proposition(text, words))


def test_claims_speak_of_it_and_quantify_over_it(half_life: None) -> None:
    assert answer("all(implies(asymptotically_stable(S), half_life(S) > 0) for S in LINEAR)").truth is True
    assert answer("any(half_life(S) == '1.39' for S in LINEAR if asymptotically_stable(S))").truth is True
    assert answer("all(half_life(S) == '1.39' for S in LINEAR if asymptotically_stable(S))").truth is True


def test_where_it_has_no_answer_a_claim_is_undecided(half_life: None) -> None:
    found = answer("all(half_life(S) > 0 for S in LINEAR)")
    assert found.truth is None
    assert "do not die out" in found.reasons[0]


def test_without_it_the_claim_is_refused() -> None:
    with pytest.raises(BadInput, match="half_life"):
        answer("half_life('clohessy_wiltshire') < 3")
