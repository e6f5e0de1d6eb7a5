"""Matrices with a known Jordan form: rational ones are decided and right, rounded ones right or undecided."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from satsym.analysis.linear import rational
from satsym.analysis.linear.spectrum import MARGINAL, UNDECIDED, Eigenvalue, spectra, stability
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


@pytest.mark.parametrize("a", [100, 1000, 2000, 3000, 5000, 10_000, 1_000_000])
def test_an_eigenvalue_that_is_zero_whatever_the_entries_are_stays_apart_from_a_slow_one(a: float) -> None:
    found = spectra(system([[-a, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]))
    assert [(e.value == 0.0, e.blocks) for e in found[0]] == [(True, (1,)), (False, (1,)), (False, (1,))]
    assert stability(*found).verdict == MARGINAL
    assert found[0][1].value == pytest.approx(-2.0 / (a + math.sqrt(a * a - 4.0)), rel=1e-15)


def test_what_rounding_may_have_left_of_zero_is_undecided_and_both_possibilities_are_told() -> None:
    found = stability(*spectra(system([[0.0, 1.0], [-1.0, 1e-17]])))
    assert found.verdict == UNDECIDED
    assert "Either marginally stable: the imaginary axis contains ±1i, in Jordan blocks of size 1 only" in found.reason
    assert "or unstable: the eigenvalue 5e-18 ± 1i has a positive real part" in found.reason


def test_a_double_zero_in_rounded_entries_is_recognised_and_has_its_block() -> None:
    """Hill's equations in turning axes, in coordinates without zeros."""
    n = 1.1e-3
    hill = np.array([[0, 1, 0, 0], [3 * n**2, 0, 0, 2 * n], [0, 0, 0, 1], [0, -2 * n, 0, 0]])
    turned = np.linalg.qr(np.random.default_rng(3).normal(size=(4, 4)))[0]
    for A in (hill, turned @ hill @ turned.T):
        found = spectra(system(A))
        assert [e.blocks for e in found[0]] == [(2,), (1,), (1,)]
        assert found[0][0].value == 0.0


@pytest.mark.parametrize("seed", range(20))
def test_exact_ranks_and_lost_modes_are_those_that_were_built(seed: int) -> None:
    """What n - r states make of themselves moves the others, and no input moves it; entries over ten decades."""
    rng = np.random.default_rng(seed)
    n, r = 5, int(rng.integers(1, 5))
    A = rng.integers(-3, 4, (n, n)) + np.eye(n, k=-1, dtype=int) * 5
    B = np.zeros((n, 1), dtype=int)
    A[r:, :r], B[0, 0], A[:r, :r] = 0, 1, np.eye(r, k=-1, dtype=int)
    T = np.tril(rng.integers(-3, 4, (n, n)), -1) + np.eye(n, dtype=int)
    units = [Fraction(10) ** int(k) for k in rng.integers(-5, 6, n)]
    inverse = np.linalg.inv(T).round().astype(int)
    a, b = T @ A @ inverse, T @ B
    exact = rational.Rational(
        rational.matrix([[int(a[i, j]) * units[j] / units[i] for j in range(n)] for i in range(n)]),
        rational.matrix([[int(b[i, 0]) / units[i]] for i in range(n)]),
        rational.matrix(np.zeros((0, n))),
    )
    rank, lost = rational.reached(exact.A, exact.B)
    assert rank == r
    values = sorted((x.rounded for x in lost for _ in range(sum(x.blocks))), key=lambda s: (s.real, s.imag))
    expected = sorted(np.linalg.eigvals(A[r:, r:]).astype(complex), key=lambda s: (round(s.real, 6), s.imag))
    assert np.poly(values) == pytest.approx(np.poly(expected), abs=1e-7)


@pytest.mark.study
def test_three_thousand_matrices_over_ten_decades() -> None:
    undecided, others = check(range(SAMPLE, SAMPLE + COUNT))
    assert undecided <= 0.02 * COUNT
    assert others <= 0.02 * COUNT
