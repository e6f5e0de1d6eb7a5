"""The Routh array counts the roots on the right and on the axis in every case, special ones included."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from satsym.analysis.linear.routh import ZERO_ELEMENT, ZERO_ROW, routh
from satsym.analysis.linear.spectrum import characteristic, companion_matrix, spectrum
from satsym.status import BadInput

SMALL = st.integers(-3, 3)
REAL = SMALL.map(lambda a: ([1, -a], int(a > 0), int(a == 0)))
PAIR = st.tuples(SMALL, st.integers(1, 3)).map(
    lambda ab: ([1, -2 * ab[0], ab[0] ** 2 + ab[1] ** 2], 2 * (ab[0] > 0), 2 * (ab[0] == 0))
)
SYMMETRIC = st.tuples(st.integers(1, 3), st.integers(1, 3)).map(
    lambda ab: (np.convolve([1, -2 * ab[0], sum(v * v for v in ab)], [1, 2 * ab[0], sum(v * v for v in ab)]), 2, 0)
)
"""Factors with whole coefficients: coefficients, roots on the right, roots on the axis."""

FACTORS = st.lists(st.one_of(REAL, PAIR, SYMMETRIC), min_size=1, max_size=4)


def product(factors) -> list[int]:
    found = np.array([1])
    for coefficients, *_ in factors:
        found = np.convolve(found, coefficients)
    return [int(c) for c in found]


@given(FACTORS)
def test_signs_count_the_roots_on_the_right_and_the_rest_of_a_zero_row_those_on_the_axis(factors):
    found = routh(product(factors))
    assert found.sign_changes == sum(right for _, right, _ in factors)
    assert found.on_axis == sum(axis for *_, axis in factors)


@given(st.lists(st.integers(-4, 4), min_size=1, max_size=7))
def test_whole_polynomials_have_as_many_roots_on_the_right_as_numpy_finds(rest):
    roots = np.roots([1, *rest])
    assume(not roots.size or np.abs(roots.real).min() > 1e-3)  # nearer to the axis numpy cannot tell
    assert routh([1, *rest]).sign_changes == (roots.real > 0).sum()


@given(st.integers(1, 6), st.integers(0, 2**32 - 1))
def test_floats_count_as_the_eigenvalues_of_their_companion_matrix(n, seed):
    coefficients = np.random.default_rng(seed).normal(size=n)
    matrix = companion_matrix([1.0, *coefficients])
    assert np.allclose(characteristic(matrix)[1:], coefficients, atol=1e-12)
    right = sum(each.algebraic for each in spectrum(matrix) if each.value.real > 0.0)
    assert routh([1.0, *coefficients.tolist()]).sign_changes == right


@given(st.integers(1, 5), st.integers(0, 2**32 - 1))
def test_matrices_of_whole_numbers_count_as_their_eigenvalues(n, seed):
    """These meet every special case; the polynomial goes through floats."""
    matrix = np.random.default_rng(seed).integers(-2, 3, size=(n, n)).astype(float)
    found, values = routh(characteristic(matrix).tolist()), spectrum(matrix)
    near = [each for each in values if 0.0 < abs(each.value.real) < 1e-6]
    assume(not near)
    assert found.sign_changes == sum(each.algebraic for each in values if each.value.real > 0.0)
    assert found.on_axis == sum(each.algebraic for each in values if each.value.real == 0.0)


def test_an_array_without_special_cases_is_the_textbooks():
    found = routh([1, 2, 3, 4, 5])
    assert found.rows == ((1, 3, 5), (2, 4, 0), (1, 5, 0), (-6, 0, 0), (5, 0, 0))
    assert (found.sign_changes, found.on_axis, found.special_case) == (2, 0, None)


def test_a_zero_in_the_first_column_is_told():
    """s^4 + s^3 + 2 s^2 + 2 s + 3: numpy finds two roots on the right."""
    found = routh([1, 1, 2, 2, 3])
    assert (np.roots([1, 1, 2, 2, 3]).real > 0.0).sum() == found.sign_changes == 2
    assert found.special_cases == (ZERO_ELEMENT,)


def test_a_row_of_zeros_is_told_and_its_roots_are_counted():
    """(s^2 + 1)^2 (s + 1): a double pair on the axis."""
    found = routh(np.poly([1j, 1j, -1j, -1j, -1]).real.round().astype(int).tolist())
    assert (found.sign_changes, found.on_axis) == (0, 4)
    assert found.special_cases == (ZERO_ROW, ZERO_ROW)
    assert found.special_case == ZERO_ROW


def test_both_special_cases_at_once():
    """s^4 - 1: a row of zeros, then a zero in the first column."""
    found = routh([1, 0, 0, 0, -1])
    assert (found.sign_changes, found.on_axis) == (1, 2)
    assert found.special_case == f"{ZERO_ROW} and {ZERO_ELEMENT}"


def test_fractions_stay_exact_where_floats_cannot_tell():
    """The third row begins with 1e-30: too little for floats beside 1."""
    tiny = Fraction(1, 10**30)
    assert routh([1, 1, 1 + tiny, 1, Fraction(1, 3)]).column[2] == tiny


def test_the_satellite_has_all_its_roots_on_the_axis():
    found = routh([1, 0, 1, 0, 0])
    assert (found.sign_changes, found.on_axis, found.special_case) == (0, 4, ZERO_ROW)


@pytest.mark.parametrize("coefficients", [[], [0, 1]])
def test_a_polynomial_needs_a_leading_coefficient(coefficients):
    with pytest.raises(BadInput, match="leading coefficient"):
        routh(coefficients)
