"""Exact analysis of linear systems: held against systems built with known answers, and against numeric libraries."""

from __future__ import annotations

import json
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import control
import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from satsym.symbolic import Derivation, DerivationError, FirstOrder, Variable, derive, symbols_of, t
from satsym.symbolic.analysis import (
    NotExact,
    analyse,
    companion_form,
    companion_matrix,
    controllability,
    exact_object,
    jordan_form,
    linear_system,
    matrix_exponential,
    observability,
    routh,
    spectrum,
    stability,
)
from satsym.symbolic.analysis.field import certain_rank, never_zero, sign_of
from satsym.symbolic.analysis.stability import Cause
from satsym.symbolic.linear import properties
from satsym.symbolic.linear import regulator as lqr
from satsym.symbolic.linear.matrices import system_of
from tests.support.deviations import satellite, small
from tests.support.examples import examples

s = sp.Symbol("s")
omega, k, c = sp.symbols("omega k c", positive=True)
b = sp.Symbol("b", real=True)
SATELLITE = sp.Matrix([[0, 1, 0, 0], [3 * omega**2, 0, 0, 2 * omega], [0, 0, 0, 1], [0, -2 * omega, 0, 0]])
THRUST = sp.Matrix([[0, 0], [1, 0], [0, 0], [0, 1]])
MEASURED = sp.Matrix([[1, 0, 0, 0], [0, 0, 1, 0]])


# Systems whose structure is known, because they were built from it.


@st.composite
def unimodular(draw: Callable[..., Any], size: int) -> sp.Matrix:
    """A whole-numbered change of basis with a whole-numbered inverse."""
    found = sp.eye(size)
    for _ in range(draw(st.integers(0, 2 * size))):
        i, j = draw(st.integers(0, size - 1)), draw(st.integers(0, size - 1))
        if i != j:
            found = found.elementary_row_op("n->n+km", row1=i, row2=j, k=draw(st.sampled_from([-1, 1])))
    return found


@st.composite
def structured(draw: Callable[..., Any]) -> tuple[sp.Matrix, Counter]:
    """A matrix, and its Jordan blocks (eigenvalue, size), each with how often it occurs."""
    blocks: list[sp.Matrix] = []
    known: Counter = Counter()
    size = draw(st.integers(1, 5))
    while (room := size - sum(block.rows for block in blocks)) > 0:
        length = draw(st.integers(1, min(3, room)))
        real = draw(st.integers(-2, 2))
        if room >= 2 * length and draw(st.booleans()):
            imaginary = draw(st.integers(1, 2))
            pair = sp.Matrix([[real, imaginary], [-imaginary, real]])
            block = sp.kronecker_product(sp.eye(length), pair) + sp.kronecker_product(
                sp.Matrix(length, length, lambda i, j: int(j == i + 1)), sp.eye(2)
            )
            known.update({(real + imaginary * sp.I, length): 1, (real - imaginary * sp.I, length): 1})
        else:
            block = sp.eye(length) * real + sp.Matrix(length, length, lambda i, j: int(j == i + 1))
            known.update({(sp.Integer(real), length): 1})
        blocks.append(sp.Matrix(block))
    basis = draw(unimodular(size))
    return basis * sp.diag(*blocks) * basis.inv(), known


@examples(25)
@given(structured())
def test_jordan_blocks_are_those_that_the_matrix_was_built_from(built: tuple[sp.Matrix, Counter]):
    matrix, known = built
    of = spectrum(matrix)
    form = jordan_form(of)
    assert form is not None
    assert Counter((block.eigenvalue, block.size) for block in form.blocks) == known
    assert (matrix * form.basis - form.basis * form.form).applyfunc(sp.expand).is_zero_matrix
    assert sp.expand(form.basis.det()) != 0
    for e in of.eigenvalues:
        sizes = [size for (value, size), times in known.items() for _ in range(times) if value == e.value]
        assert (e.algebraic, e.geometric) == (sum(sizes), len(sizes))
    assert (
        sp.expand(of.polynomial.subs(of.polynomial.free_symbols.pop(), s) - (s * sp.eye(matrix.rows) - matrix).det())
        == 0
    )


@examples(25)
@given(structured())
def test_the_exponential_is_that_of_scipy_and_real(built: tuple[sp.Matrix, Counter]):
    matrix, _ = built
    found = matrix_exponential(spectrum(matrix))
    assert found is not None
    assert not found.has(sp.I)
    numbers = np.array(matrix, dtype=float)
    for instant in (0.0, 0.7):
        expected = expm(numbers * instant)
        np.testing.assert_allclose(
            np.array(found.subs(t, instant), dtype=float), expected, atol=1e-9 * np.abs(expected).max()
        )


@examples(25)
@given(structured())
def test_the_verdict_is_that_of_the_blocks(built: tuple[sp.Matrix, Counter]):
    matrix, known = built
    found = stability(spectrum(matrix))
    real = {sp.re(value) for value, _ in known}
    largest = max((size for value, size in known if sp.re(value) == 0), default=0)
    if max(real) > 0:
        expected = "unstable", "right"
    elif largest > 1:
        expected = "unstable", "block on the axis"
    elif largest:
        expected = "marginally stable", "bounded on the axis"
    else:
        expected = "asymptotically stable", "all left"
    assert (found.verdict, found.cause.value) == expected
    assert found.block == largest
    assert found.reason


# The Routh array.


@st.composite
def polynomials(draw: Callable[..., Any]) -> tuple[list[sp.Expr], int, int]:
    """Coefficients, and the numbers of roots in the right half-plane and on the imaginary axis."""
    found, right, axis = sp.Integer(draw(st.sampled_from([-2, 1, 3]))), 0, 0
    for _ in range(draw(st.integers(1, 4))):
        kind = draw(st.sampled_from(["real", "pair", "axis", "zero", "symmetric", "quadruple"]))
        a, square = draw(st.integers(-2, 2)), draw(st.integers(1, 3))
        if kind == "real":
            found, right, axis = found * (s - a), right + (a > 0), axis + (a == 0)
        elif kind == "pair":
            found, right, axis = found * ((s - a) ** 2 + square), right + 2 * (a > 0), axis + 2 * (a == 0)
        elif kind == "axis":
            found, axis = found * (s**2 + square), axis + 2
        elif kind == "zero":
            found, axis = found * s, axis + 1
        elif kind == "symmetric":
            found, right = found * (s**2 - square**2), right + 1
        else:
            found, right = found * (s**4 + square), right + 2
    return sp.Poly(found, s).all_coeffs(), right, axis


@examples(60)
@given(polynomials())
def test_routh_counts_right_half_plane_and_axis_whatever_special_cases_occur(built: tuple[list[sp.Expr], int, int]):
    coefficients, right, axis = built
    found = routh(coefficients)
    assert (found.sign_changes, found.right, found.axis) == (right, right, axis)
    assert found.left == len(coefficients) - 1 - right - axis
    assert len(found.rows) == len(coefficients)


@examples(40)
@given(st.lists(st.integers(-4, 4), min_size=2, max_size=7).filter(lambda row: row[0] != 0))
def test_routh_counts_the_roots_of_any_polynomial(row: list[int]):
    """Against the eigenvalues of its companion matrix, with many digits; multiple roots are known to 1e-10."""
    found = routh(row)
    with mp.workdps(60):
        trimmed = row[: max(i for i, value in enumerate(row) if value) + 1]
        roots = mp.polyroots(trimmed, maxsteps=400, extraprec=400) if len(trimmed) > 1 else []
    reals = [mp.re(root) for root in roots]
    assert found.right == sum(x > 1e-10 for x in reals)
    assert found.axis == sum(abs(x) <= 1e-10 for x in reals) + len(row) - len(trimmed)


def test_a_row_of_zeros_is_replaced_by_the_derivative_of_the_auxiliary_polynomial():
    """Example 2.9 of uny_thesis: its table ends with the row of zeros."""
    found = routh([1, -2, -1, 2])
    assert found.rows == ((1, -1), (-2, 2), (-4, 0), (2, 0))
    assert found.auxiliary == ((-2, 0, 2),)
    assert found.special_case == "row of zeros"
    assert found.sign_changes == 2


def test_a_zero_in_the_first_column_is_replaced_by_a_small_number():
    """By hand: 2 - 5/epsilon is negative for small epsilon, which makes two changes of sign."""
    found = routh([1, 1, 2, 2, 5])
    epsilon = next(iter(found.column[2].free_symbols))
    assert found.column == (1, 1, epsilon, 2 - 5 / epsilon, 5)
    assert found.special_case == "zero in the first column"
    assert found.sign_changes == 2


def test_the_textbook_remedy_alone_would_count_wrongly_here():
    """A zero element and then a row of zeros: roots at +-i, and two in the right half-plane (Gantmacher, XV)."""
    found = routh([1, 1, 3, 3, 3, 2, 1])
    assert found.special_case == "zero in the first column and row of zeros"
    assert (found.right, found.axis, found.left) == (2, 2, 2)


def test_a_symbolic_array_has_the_determinants_of_hurwitz():
    """The elements of the first column are ratios of successive Hurwitz determinants."""
    a = sp.symbols("a0:5", positive=True)
    hurwitz = sp.Matrix(4, 4, lambda i, j: a[2 * (j + 1) - (i + 1)] if 0 <= 2 * (j + 1) - (i + 1) <= 4 else 0)
    minors = [sp.Integer(1), *(hurwitz[:n, :n].det() for n in range(1, 5))]
    ratios = [a[0], *(minors[n] / minors[n - 1] for n in range(1, 5))]
    found = routh(a)
    assert all(sp.simplify(x - y) == 0 for x, y in zip(found.column, ratios, strict=True))
    assert found.sign_changes is None
    assert found.right is None


def test_a_symbolic_array_decides_where_signs_are_certain():
    assert routh([1, c, k]).right == 0
    assert routh([1, -c, k]).right == 2
    assert routh([1, 0, k]).axis == 2
    assert routh([1, b, k]).right is None


def test_routh_with_a_small_number_beside_a_parameter():
    found = routh([1, 0, 0, 0, -(sp.Symbol("k", positive=True) ** 2)])  # roots of k, i times it, and minus both
    assert (found.right, found.axis, found.left) == (1, 2, 1)


def test_no_routh_array_without_a_first_coefficient():
    with pytest.raises(ValueError, match="first coefficient is not zero"):
        routh([0, 1, 2])


# Structure.


def random_system(rng: np.random.Generator, reached: int, size: int, inputs: int) -> tuple[sp.Matrix, sp.Matrix]:
    """A system of which the inputs reach a subspace of known dimension, in a whole-numbered basis."""
    a = sp.Matrix(rng.integers(-2, 3, (size, size)).tolist())
    a[reached:, :reached] = sp.zeros(size - reached, reached)
    b_ = sp.zeros(size, inputs)
    b_[:reached, :] = sp.Matrix(rng.integers(-2, 3, (reached, inputs)).tolist())
    basis = sp.eye(size)
    for _ in range(6):
        i, j = rng.choice(size, 2, replace=False)
        basis = basis.elementary_row_op("n->n+km", row1=int(i), row2=int(j), k=int(rng.choice([-1, 1])))
    return basis * a * basis.inv(), basis * b_


def as_numbers(vector: sp.MatrixBase) -> np.ndarray:
    return np.array([complex(e) for e in vector])


@pytest.mark.slow
@settings(max_examples=10)
@given(st.integers(0, 10**6), st.integers(1, 3), st.integers(1, 2))
def test_ranks_modes_and_kalman_forms_agree_with_each_other_and_with_numeric_ones(seed: int, reached: int, inputs: int):
    a, b_ = random_system(np.random.default_rng(seed), reached, 4, inputs)
    of = spectrum(a)
    found = controllability(of, b_)
    numbers = np.array(a, dtype=float), np.array(b_, dtype=float)
    np.testing.assert_allclose(np.array(found.matrix, dtype=float), control.ctrb(*numbers))
    assert found.rank == np.linalg.matrix_rank(control.ctrb(*numbers), tol=1e-8) <= reached
    values = np.linalg.eigvals(numbers[0])
    for value, rank in found.pbh:
        assert np.abs(values - complex(value)).min() < 1e-3
        pencil = np.hstack([complex(value) * np.eye(4) - numbers[0], numbers[1]])
        assert rank == np.linalg.matrix_rank(pencil, tol=1e-8)
    assert found.full == (found.rank == 4) == all(rank == 4 for _, rank in found.pbh)
    for mode in found.lost:
        vector = as_numbers(mode.vector)
        np.testing.assert_allclose(numbers[0].T @ vector, complex(mode.eigenvalue) * vector, atol=1e-9)
        np.testing.assert_allclose(numbers[1].T @ vector, 0, atol=1e-9)
        assert np.abs(vector).max() > 0.1
    if found.kalman:
        form, r = found.kalman, found.rank
        assert (a * form.basis - form.basis * form.state).is_zero_matrix
        assert (b_ - form.basis * form.port).is_zero_matrix
        assert form.state[r:, :r].is_zero_matrix
        assert form.port[r:, :].is_zero_matrix
        assert controllability(spectrum(form.state[:r, :r]), form.port[:r, :]).full if r else True


@settings(max_examples=8)
@given(st.integers(0, 10**6), st.integers(1, 3))
def test_observability_is_that_of_python_control(seed: int, shown: int):
    a, c_ = (m.T for m in random_system(np.random.default_rng(seed), shown, 4, 1))
    found = observability(spectrum(a), c_)
    numbers = np.array(a, dtype=float), np.array(c_, dtype=float)
    np.testing.assert_allclose(np.array(found.matrix, dtype=float), control.obsv(*numbers))
    assert found.rank == np.linalg.matrix_rank(control.obsv(*numbers), tol=1e-8)
    for mode in found.lost:
        vector = as_numbers(mode.vector)
        np.testing.assert_allclose(numbers[0] @ vector, complex(mode.eigenvalue) * vector, atol=1e-9)
        np.testing.assert_allclose(numbers[1] @ vector, 0, atol=1e-9)
    if found.kalman:
        form, r = found.kalman, found.rank
        assert (a * form.basis - form.basis * form.state).is_zero_matrix
        assert (c_ * form.basis - form.port).is_zero_matrix
        assert form.state[:r, r:].is_zero_matrix
        assert form.port[:, r:].is_zero_matrix


def test_a_companion_form_is_one_and_has_the_same_polynomial():
    of = spectrum(SATELLITE)
    form = companion_form(of, THRUST[:, 1])
    assert form is not None
    assert (SATELLITE * form.basis - form.basis * form.matrix).is_zero_matrix
    assert (form.basis * sp.eye(4)[:, 3] - THRUST[:, 1]).is_zero_matrix
    assert spectrum(form.matrix).coefficients == of.coefficients
    assert companion_form(of, THRUST[:, 0]) is None
    assert companion_matrix([1, 5, 6]).tolist() == [[0, 1], [-6, -5]]


# Parameters.


def test_a_damped_oscillator_is_stable_for_all_parameters_but_its_form_is_not_the_same_for_all():
    found = analyse(linear_system(sp.Matrix([[0, 1], [-k, -c]])))
    assert found.stability.verdict == "asymptotically stable"
    assert found.assumed == (c**2 - 4 * k,)
    for stiff in (sp.Rational(1, 8), 2):
        values = {k: stiff, c: 1}
        expected = expm(np.array([[0, 1], [-float(stiff), -1]]) * 0.7)
        exponential = found.exponential.subs(values).subs(t, sp.Rational(7, 10)).evalf()
        np.testing.assert_allclose(np.array(exponential.applyfunc(sp.re), dtype=float), expected, atol=1e-12)


def test_a_parameter_of_either_sign_decides_on_stability():
    found = stability(spectrum(sp.Matrix([[0, 1], [-k, -b]])))
    assert found.verdict == "depends on the parameters"
    assert found.conditions == (b, k)


def test_ranks_say_where_they_may_not_hold():
    a, b_ = sp.diag(k, c), sp.Matrix([1, 1])
    found = controllability(spectrum(a), b_)
    assert found.rank == 2
    assert len(found.assumed) == 1
    assert found.assumed[0].subs(k, c) == 0
    assert controllability(spectrum(SATELLITE), THRUST).assumed == ()


def test_roots_of_parameters_are_exact():
    a = sp.Matrix([[0, sp.sqrt(k)], [-sp.sqrt(k), 0]])
    assert [e.value for e in spectrum(a).eigenvalues] == [sp.I * sp.sqrt(k), -sp.I * sp.sqrt(k)]
    assert spectrum(sp.Matrix([[sp.sqrt(2), 1], [0, 1]])).coefficients == (1, -1 - sp.sqrt(2), sp.sqrt(2))


def test_decimal_numbers_count_as_the_fractions_they_are_written_as():
    assert [e.value for e in spectrum(sp.Matrix([[0.1, 0], [0, 0.3]])).eigenvalues] == [
        sp.Rational(3, 10),
        sp.Rational(1, 10),
    ]


def test_coupled_oscillators_have_four_frequencies_in_closed_form():
    """s^4 + 4k s^2 + 3k^2: frequencies sqrt(k) and sqrt(3k)."""
    a = sp.Matrix([[0, 1, 0, 0], [-2 * k, 0, k, 0], [0, 0, 0, 1], [k, 0, -2 * k, 0]])
    values = {sp.simplify(e.value**2) for e in spectrum(a).eigenvalues}
    assert values == {-k, -3 * k}
    assert stability(spectrum(a)).verdict == "marginally stable"


@pytest.mark.parametrize("p", [-3, -1, 0, 1, 5])
def test_biquadratic_polynomials_have_closed_forms(p: int):
    matrix = companion_matrix([sp.Integer(1), sp.Integer(0), sp.Integer(p), sp.Integer(0), sp.Integer(1)])
    of = spectrum(matrix)
    assert of.closed_form
    found = matrix_exponential(of)
    assert found is not None
    expected = expm(np.array(matrix, dtype=float) * 0.7)
    np.testing.assert_allclose(np.array(found.subs(t, 0.7).evalf(), dtype=float), expected, atol=1e-10)


def test_a_cubic_without_radicals_is_decided_without_them():
    of = spectrum(companion_matrix([sp.Integer(1), sp.Integer(5), sp.Integer(2), sp.Integer(1)]))
    assert not of.closed_form
    assert jordan_form(of) is matrix_exponential(of) is None
    assert stability(of).verdict == "asymptotically stable"
    unknown = spectrum(companion_matrix([sp.Integer(1), c, k, omega]))
    assert unknown.eigenvalues == ()
    assert stability(unknown).verdict == "depends on the parameters"


def test_entries_beyond_exact_elimination_are_named():
    with pytest.raises(NotExact, match="sin"):
        spectrum(sp.Matrix([[sp.sin(omega)]]))
    with pytest.raises(NotExact):
        spectrum(sp.Matrix([[sp.I]]))


@pytest.mark.parametrize(
    ("expression", "sign"),
    [(omega, 1), (-omega * k, -1), (omega + k, 1), (omega - k, None), (b, None), (b**2 + 1, 1), (sp.Integer(0), 0)],
)
def test_signs_are_certain_or_unknown(expression: sp.Expr, sign: int | None):
    assert sign_of(expression) == sign
    assert never_zero(expression) == bool(sign)


def test_elimination_prefers_pivots_that_cannot_vanish():
    assert certain_rank(sp.Matrix([[b, 1], [1, 0]])) == (2, ())
    assert certain_rank(sp.Matrix([[b, 0], [0, 1]])) == (2, (b,))


# The satellite.


def test_a_satellite_drifts_because_of_a_jordan_block_and_not_of_an_eigenvalue():
    found = analyse(linear_system(SATELLITE, THRUST, MEASURED))
    assert [(e.value, e.algebraic, e.geometric) for e in found.eigenvalues] == [
        (0, 2, 1),
        (sp.I * omega, 1, 1),
        (-sp.I * omega, 1, 1),
    ]
    assert found.stability.verdict == "unstable"
    assert found.stability.reason == (
        "the double eigenvalue 0 has a Jordan block of size 2: deviations grow linearly with time"
    )
    assert (found.routh.right, found.routh.axis) == (0, 4)
    assert found.assumed == ()


def test_radial_thrust_alone_leaves_the_angular_momentum_as_it_is():
    """To first order, r^2 theta_dot changes by sigma (2 omega x1 + x4)."""
    found = analyse(linear_system(SATELLITE, THRUST, MEASURED))
    assert {name: reach.rank for name, reach in found.by_input.items()} == {"u1": 3, "u2": 4}
    (mode,) = found.by_input["u1"].lost
    assert mode.eigenvalue == 0
    assert list(mode.vector) == [2 * omega, 0, 0, 1]
    assert {name: reach.rank for name, reach in found.by_output.items()} == {"y1": 3, "y2": 4}
    (mode,) = found.by_output["y1"].lost
    assert list(mode.vector) == [0, 0, 1, 0]
    assert list(found.companion_forms) == ["u2"]


def test_the_free_motion_is_that_of_clohessy_and_wiltshire():
    """The textbook closed form, column by column."""
    found = analyse(linear_system(SATELLITE)).exponential
    assert found is not None
    sine, cosine = sp.sin(omega * t), sp.cos(omega * t)
    known = [
        [4 - 3 * cosine, sine / omega, 0, 2 * (1 - cosine) / omega],
        [3 * omega * sine, cosine, 0, 2 * sine],
        [6 * (sine - omega * t), 2 * (cosine - 1) / omega, 1, 4 * sine / omega - 3 * t],
        [6 * omega * (cosine - 1), -2 * sine, 0, 4 * cosine - 3],
    ]
    assert (found - sp.Matrix(known)).applyfunc(sp.expand).is_zero_matrix


def test_systems_of_models_and_matrices_can_be_analysed():
    found = analyse(system_of(small("stable_node")))
    assert analyse(linear_system(found.system.a)).stability == found.stability


@pytest.mark.slow
def test_the_analysis_is_quick_and_can_be_printed():
    system = system_of(satellite())
    began = time.process_time()
    found = exact_object(analyse(system))
    assert time.process_time() - began < 3
    assert json.loads(json.dumps(found)) == found
    assert found["controllability"]["by_input"] == {"u1": 3, "u2": 4}
    assert found["routh"]["special_case"] == "row of zeros"
    assert found["stability"]["verdict"] == "unstable"


@pytest.mark.parametrize(
    ("name", "eigenvalues", "verdict"),
    [
        ("saddle", {3, -2}, "right"),
        ("stable_node", {-5, -2}, "all left"),
        ("three_modes", {1, 2, -1}, "right"),
    ],
)
def test_small_systems_of_the_thesis(name: str, eigenvalues: set[int], verdict: str):
    found = small(name).step("stability")
    assert set(small(name).equation("stability.eigenvalues").rhs) == eigenvalues
    assert found.conclusions[0].key == verdict


# Steps.


def test_results_have_addresses():
    found = satellite()
    address = "clohessy_wiltshire"
    assert list(found.equation(f"{address}:stability.eigenvalues").rhs)[:2] == [0, 0]
    assert found.equation(f"{address}:controllability.u2").rhs.shape == (4, 4)
    assert found.equation(f"{address}:controllability.rank_u1").rhs == 3
    assert found.equation(f"{address}:observability.all").rhs.shape == (8, 4)
    assert found.equation(f"{address}:matrix_exponential.transition").rhs.shape == (4, 4)
    assert found.equation(f"{address}:lqr.riccati").rhs.shape == (4, 4)
    assert found.equation(f"{address}:lqr.gain").rhs.shape == (2, 4)


def test_models_with_a_cost_or_with_varying_coefficients_are_not_analysed():
    assert "stability" not in small("time_varying")
    assert "stability" not in small("explicit_time")
    with pytest.raises(DerivationError, match="the system is not linear with constant coefficients"):
        system_of(small("time_varying"))


def test_a_model_whose_variable_has_the_name_of_a_result_is_derived_without_the_results():
    states = (Variable("x1", "x_1"), Variable("jordan_form", "J"))
    x1, other = symbols_of(states)
    rates = {x1: other, other: -x1}
    found = derive(FirstOrder(name="m", title="", states=states, controls=(), parameters=(), rates=rates))
    assert "linearisation" in found
    assert "stability" not in found


STEPS = {
    f.__name__: f
    for f in (
        properties.stability,
        properties.jordan_form,
        properties.matrix_exponential,
        properties.routh,
        properties.controllability,
        properties.observability,
        properties.companion_form,
        lqr.lqr_hamiltonian_matrix,
        lqr.lqr_differential_riccati,
        lqr.lqr,
    )
}


def redo(derivation: Derivation, name: str) -> None:
    index = [step.name for step in derivation.steps].index(name)
    before = replace(derivation, steps=derivation.steps[:index])
    before.extended(STEPS[name](before))


def shifted(matrix: sp.MatrixBase, row: int = 0, column: int = 0) -> sp.ImmutableMatrix:
    """A matrix with one entry that is wrong by one."""
    wrong = sp.Matrix(matrix)
    wrong[row, column] += 1
    return sp.ImmutableMatrix(wrong)


def with_wrong_kalman_form(found: Any) -> Any:
    if found.kalman is None:
        return found
    return replace(found, kalman=replace(found.kalman, state=shifted(found.kalman.state)))


FALSIFIED = {
    "no block": ("stability", "stability_of", lambda found: replace(found, block=1)),
    "exponential growth": ("stability", "stability_of", lambda found: replace(found, cause=Cause.RIGHT)),
    "decay": ("stability", "stability_of", lambda found: replace(found, cause=Cause.LEFT)),
    "another form": ("jordan_form", "jordan_of", lambda found: replace(found, form=shifted(found.form))),
    "no basis": ("jordan_form", "jordan_of", lambda found: replace(found, basis=0 * found.basis)),
    "another exponential": ("matrix_exponential", "exponential_of", lambda found: shifted(found, 2, 3)),
    "a root too many": ("routh", "routh_of", lambda found: replace(found, right=1)),
    "roots off the axis": ("routh", "routh_of", lambda found: replace(found, axis=2)),
    "a rank too low": ("controllability", "controllability_of", lambda found: replace(found, rank=found.rank - 1)),
    "no matrix": ("controllability", "controllability_of", lambda found: replace(found, matrix=0 * found.matrix)),
    "another mode": (
        "controllability",
        "controllability_of",
        lambda found: replace(found, lost=tuple(replace(m, eigenvalue=m.eigenvalue + 1) for m in found.lost)),
    ),
    "another Kalman form": ("observability", "observability_of", with_wrong_kalman_form),
    "another basis": (
        "companion_form",
        "companion_of",
        lambda found: found and replace(found, basis=shifted(found.basis)),
    ),
    "coupling doubled": ("lqr_hamiltonian_matrix", "_named_coupling", lambda found: 2 * found),
    "an entry off": ("lqr_differential_riccati", "riccati_operator", lambda found: shifted(found)),
    "a factor of two": ("lqr_differential_riccati", "riccati_operator", lambda found: 2 * found),
    "gain doubled": ("lqr", "inverse", lambda found: 2 * found),
}
"""What is wrong -> the step that must notice, the function whose result is falsified, and how."""


@pytest.mark.slow
@pytest.mark.parametrize("wrong", FALSIFIED)
def test_falsified_results_are_caught(wrong: str, monkeypatch: pytest.MonkeyPatch):
    step, function, falsify = FALSIFIED[wrong]
    source = sys.modules[STEPS[step].__module__]
    original = getattr(source, function)
    monkeypatch.setattr(source, function, lambda *arguments: falsify(original(*arguments)))
    with pytest.raises(DerivationError, match="failed its check"):
        redo(satellite(), step)


def test_a_riccati_equation_with_a_factor_too_many_is_caught():
    """As with a cost of one half: lambda = P x belongs to that one, lambda = 2 P x to ours."""
    steps = []
    for step in satellite().steps:
        if step.name == "lqr_differential_riccati":
            (equation,) = step.equations
            weights = {x: x / 2 for x in equation.rhs.free_symbols if x.name.startswith("S_")}
            step = replace(step, equations=(replace(equation, rhs=equation.rhs.xreplace(weights)),))
        steps.append(step)
    with pytest.raises(DerivationError, match="failed its check 'invariant subspace'"):
        redo(replace(satellite(), steps=tuple(steps)), "lqr")


def test_models_that_no_input_can_stabilise_have_no_algebraic_riccati_equation():
    states, controls = (Variable("x1", "x_1"), Variable("x2", "x_2")), (Variable("u1", "u_1"),)
    (x1, x2), (u1,) = symbols_of(states), symbols_of(controls)
    for growth, expected in ((1, False), (-1, True)):
        rates = {x1: growth * x1, x2: u1}
        found = derive(FirstOrder(name="m", title="", states=states, controls=controls, parameters=(), rates=rates))
        assert ("lqr" in found) == expected
        assert "lqr_differential_riccati" in found


def test_the_regulator_of_a_double_integrator_is_the_known_one():
    """x'' = u, Q = diag(q, 0), R = 1: K = (sqrt q, sqrt(2 sqrt q)) (Bryson and Ho)."""
    states, controls = (Variable("x1", "x_1"), Variable("x2", "x_2")), (Variable("u1", "u_1"),)
    (x1, x2), (u1,) = symbols_of(states), symbols_of(controls)
    found = derive(
        FirstOrder(name="m", title="", states=states, controls=controls, parameters=(), rates={x1: x2, x2: u1})
    )
    q = sp.Rational(16)
    p12, p22 = sp.sqrt(q), sp.sqrt(2 * sp.sqrt(q))
    values = {"Q_x1_x1": q, "Q_x1_x2": 0, "Q_x2_x2": 0, "R_u1_u1": 1, "S_x2_x2": 1}
    values |= {"P_x1_x2": p12, "P_x2_x2": p22, "P_x1_x1": p12 * p22}

    def at(address: str) -> sp.Matrix:
        rhs = found.equation(address).rhs
        return rhs.subs({x: values[x.name] for x in rhs.free_symbols})

    assert at("lqr.riccati").applyfunc(sp.simplify).is_zero_matrix
    assert list(at("lqr.gain")) == [sp.sqrt(q), sp.sqrt(2 * sp.sqrt(q))]
