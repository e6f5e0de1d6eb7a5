"""Matrices with a known Jordan form: rational ones are decided and right, rounded ones right or undecided."""

from __future__ import annotations

import numpy as np
import pytest

from satsym.analysis.linear import rational
from satsym.analysis.linear.spectrum import Eigenvalue, spectra
from satsym.analysis.linear.stability import UNDECIDED, stability
from satsym.analysis.linear.system import LinearSystem, system
from tests.support.known_jordan_forms import Known, known

COUNT, SAMPLE = 3000, 150


def exactly(case: Known) -> LinearSystem:
    A = rational.matrix(case.rows)
    n = A.nrows()
    return system(
        case.floats, exact=rational.Rational(A, rational.matrix(np.zeros((n, 0))), rational.matrix(np.zeros((0, n))))
    )


def upper(found: tuple[Eigenvalue, ...]) -> list[tuple[complex, tuple[int, ...]]]:
    return sorted(((e.value, e.blocks) for e in found if e.value.imag >= 0.0), key=lambda e: (e[0].real, e[0].imag))


def check(seeds: range) -> tuple[int, int]:
    """The number of rounded matrices whose verdict is undecided, and of those whose Jordan blocks are others."""
    undecided = others = 0
    for seed in seeds:
        case = known(seed)
        (found,) = spectra(exactly(case))
        right = sorted(case.blocks.items(), key=lambda e: (e[0].real, e[0].imag))
        assert upper(found) == right, seed
        assert stability(found).verdict == case.verdict, seed
        possible = spectra(system(case.floats))
        verdict = stability(*possible)
        if verdict.verdict == UNDECIDED:
            assert any(stability(one).verdict == case.verdict for one in possible), seed
            undecided += 1
        else:
            assert verdict.verdict == case.verdict, (seed, verdict)
        others += all([b for _, b in upper(one)] != [b for _, b in right] for one in possible)
    return undecided, others


def test_rational_matrices_are_decided_and_rounded_ones_never_wrong() -> None:
    undecided, others = check(range(SAMPLE))
    assert undecided <= 0.02 * SAMPLE
    assert others <= 0.02 * SAMPLE


@pytest.mark.study
@pytest.mark.slow
def test_three_thousand_matrices_over_ten_decades() -> None:
    undecided, others = check(range(SAMPLE, SAMPLE + COUNT))
    assert undecided <= 0.02 * COUNT
    assert others <= 0.02 * COUNT
