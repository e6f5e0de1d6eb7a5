"""A few random extremals of each kind; ``make bench-proof`` tries a hundred.

How often they are conjugate to their start is counted by other code, see tests/bench/extremals.py.
"""

from __future__ import annotations

import numpy as np
import pytest

from satsym.proof.proving import prove
from satsym.proof.record import Outcome
from tests.bench.extremals import KINDS, drawn

SEED, DRAWN = 38, 2


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_random_extremals_are_proved_where_they_have_no_conjugate_point(kind: str) -> None:
    rng = np.random.default_rng(SEED)
    for _ in range(DRAWN):
        one = drawn(kind, rng)
        proof = prove(one.case, lambda one=one: one.found, 10)
        assert (proof.status is Outcome.PROVED) is (one.conjugate == 0), proof.reason
        if one.conjugate:
            assert "conjugate" in proof.reason
