"""What is said of linear systems does not depend on units, and agrees with closed forms and with python-control."""

from __future__ import annotations

import sys
from dataclasses import replace

import control
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from satsym import instance, kernels
from satsym.analysis.linear.equilibrium import equilibrium, linearise
from satsym.analysis.linear.ranks import TOLERANCE, controllability, observability, staircase
from satsym.analysis.linear.spectrum import characteristic, companion_matrix, spectrum, stability
from satsym.analysis.linear.system import scaled, system
from satsym.analysis.subject import analyse
from satsym.status import BadInput
from tests.support.linear_models import OMEGA, in_other_units, pendulum, satellite

SEEDS = st.integers(0, 2**32 - 1)
BLOCKS = st.lists(st.tuples(st.integers(-2, 2), st.integers(1, 3)), min_size=1, max_size=4)


def jordan(blocks) -> np.ndarray:
    """A block-diagonal matrix of Jordan blocks (eigenvalue, size)."""
    n = sum(size for _, size in blocks)
    found, at = np.zeros((n, n)), 0
    for value, size in blocks:
        found[at : at + size, at : at + size] = value * np.eye(size) + np.eye(size, k=1)
        at += size
    return found


def well_conditioned(n: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    turned = [np.linalg.qr(rng.normal(size=(n, n)))[0] for _ in range(2)]
    return turned[0] @ np.diag(rng.uniform(0.5, 2.0, n)) @ turned[1]


@settings(max_examples=60)
@given(BLOCKS, SEEDS)
def test_jordan_blocks_are_found_in_any_basis(blocks, seed):
    T = well_conditioned(sum(size for _, size in blocks), seed)
    expected: dict[int, list[int]] = {}
    for value, size in blocks:
        expected.setdefault(value, []).append(size)
    found = spectrum(T @ jordan(blocks) @ np.linalg.inv(T))
    assert {round(e.value.real): list(e.blocks) for e in found} == {
        value: sorted(sizes, reverse=True) for value, sizes in expected.items()
    }
    assert max(abs(e.value - round(e.value.real)) for e in found) < 1e-6


@pytest.mark.parametrize(
    ("A", "blocks"),
    [
        ([[1.0 + 2e-16, -1e-16], [0.0, 1.0 - 1e-16]], (1, 1)),
        ([[1.0, 1e-16], [0.0, 1.0]], (1, 1)),
        ([[0.0, 1.0], [1e-16, 0.0]], (1,)),
        ([[1.0, 1e-10], [0.0, 1.0]], (2,)),
    ],
)
def test_what_rounding_may_have_left_is_told_from_small_entries(A, blocks):
    """An entry between much larger ones of the diagonal may be rounding; a slow motion, or a small entry, is not."""
    assert spectrum(np.array(A))[0].blocks == blocks


def test_a_mode_out_of_reach_that_rests_is_exactly_zero():
    """The torque of a wheel moves satellite and wheel one against the other; together they turn on, or rest."""
    found = controllability(linearise(instance.load("lapan-classical")).system)
    assert found.rank == 2
    assert [each.value for each in found.lost] == [0.0]


@settings(max_examples=25)
@given(SEEDS)
def test_units_change_eigenvalues_by_the_unit_of_time_alone_and_no_rank_at_all(seed):
    usual, other = satellite(), in_other_units(satellite(), seed)
    rate = np.sqrt(abs(np.linalg.det(other.A[:2, :2]) / np.linalg.det(usual.A[:2, :2])))
    assert [e.blocks for e in spectrum(other.A)] == [(2,), (1,), (1,)]
    assert np.allclose([e.value / rate for e in spectrum(other.A)], [0.0, 1j, -1j], atol=1e-9)
    for analysis, alone in ((controllability, {"u1": 3, "u2": 4}), (observability, {"y1": 3, "y2": 4})):
        found = analysis(other)
        assert (found.rank, {name: each.rank for name, each in found.alone.items()}) == (4, alone)


def test_naive_ranks_would_be_fooled_by_kilometres_and_seconds():
    """The reason for scaling, near an orbit about the Sun at the Earth's distance."""
    found = controllability(satellite(1.99e-7).with_inputs(["u2"]))
    assert found.rank == 4
    assert np.linalg.matrix_rank(found.matrix) == 3


@settings(max_examples=40)
@given(st.integers(1, 4), st.integers(0, 3), st.integers(1, 2), SEEDS)
def test_what_is_out_of_reach_is_told_with_its_eigenvalues(moved, stuck, inputs, seed):
    rng = np.random.default_rng(seed)
    n = moved + stuck
    A, B = np.zeros((n, n)), np.zeros((n, inputs))
    # a chain that the first input drives, and below it what goes its own way
    A[:moved, :moved] = np.eye(moved, k=-1) + np.diag(rng.uniform(-1.0, 1.0, moved))
    A[:moved, moved:] = rng.normal(size=(moved, stuck))
    own = np.sort(rng.uniform(-3.0, 3.0, stuck) + 4.0 * np.arange(stuck))
    A[moved:, moved:] = np.diag(own)
    B[0] = 1.0
    T = well_conditioned(n, seed)
    given_system = system(T @ A @ np.linalg.inv(T), T @ B)
    found = controllability(given_system)
    assert found.rank == moved
    assert np.allclose(sorted(each.value.real for each in found.lost), own, atol=1e-6)
    assert found.complete == (stuck == 0)
    assert np.allclose(found.matrix, control.ctrb(given_system.A, given_system.B), atol=1e-8)


@settings(max_examples=25)
@given(SEEDS)
def test_the_ranks_are_those_of_popov_belevitch_and_hautus(seed):
    """At each eigenvalue s inputs move all modes if (A - s, B) has full rank."""
    for inputs, ranks in (["u1"], [3, 4, 4]), (["u2"], [4, 4, 4]):
        given_system = in_other_units(satellite().with_inputs(inputs), seed)
        fitted = scaled(given_system)
        pencils = [
            np.hstack([fitted.A - each.value / fitted.rate * np.eye(len(fitted.A)), fitted.B])
            for each in spectrum(given_system.A)
        ]
        assert [np.linalg.matrix_rank(pencil, TOLERANCE * fitted.size) for pencil in pencils] == ranks
        assert controllability(given_system).rank == min(ranks)


def test_observability_is_that_of_python_control():
    found = observability(satellite(OMEGA))
    assert np.allclose(found.matrix, control.obsv(satellite(OMEGA).A, satellite(OMEGA).C), rtol=1e-15, atol=0.0)


@given(st.integers(1, 5), st.integers(1, 2), SEEDS)
def test_staircases_are_orthogonal_and_hide_what_is_out_of_reach(n, inputs, seed):
    rng = np.random.default_rng(seed)
    A, B = rng.integers(-1, 2, (n, n)).astype(float), rng.integers(-1, 2, (n, inputs)).astype(float)
    rank, basis, form = staircase(A, B)
    assert np.allclose(basis.T @ basis, np.eye(n), atol=1e-12)
    assert np.allclose(basis.T @ A @ basis, form, atol=1e-12)
    assert np.abs(form[rank:, :rank]).max(initial=0.0) < 1e-12
    assert np.abs(basis[:, rank:].T @ B).max(initial=0.0) < 1e-12
    exact = control.ctrb(A, B)
    assert rank == np.linalg.matrix_rank(exact)


@pytest.mark.parametrize(
    ("matrix", "verdict", "reason"),
    [
        ([[-1.0, 5.0], [0.0, -2.0]], "asymptotically stable", "the largest is -1"),
        ([[0.0, 1.0], [-4.0, 0.0]], "marginally stable", "±2i"),
        ([[0.0, 0.0], [0.0, -1.0]], "marginally stable", "axis contains 0, in Jordan blocks of size 1 only"),
        ([[0.0, 1.0], [0.0, 0.0]], "unstable", "Jordan block of size 2"),
        ([[3.0, 0.0], [0.0, -2.0]], "unstable", "eigenvalue 3 has a positive real part"),
        (jordan([(0, 3)]), "unstable", "like t^2"),
    ],
)
def test_the_verdict_comes_with_its_reason(matrix, verdict, reason):
    found = stability(spectrum(np.array(matrix)))
    assert found.verdict == verdict
    assert reason in found.reason


def test_the_satellite_is_unstable_because_of_its_jordan_block_not_of_a_real_part():
    found = stability(spectrum(satellite(OMEGA).A))
    assert found.verdict == "unstable"
    assert "Jordan block of size 2" in found.reason
    assert not found.decides


def test_characteristic_polynomials_are_monic_with_exact_zeros():
    assert characteristic(satellite().A).tolist() == pytest.approx([1.0, 0.0, 1.0, 0.0, 0.0], abs=1e-14)
    assert characteristic(satellite(OMEGA).A)[[1, 3, 4]].tolist() == [0.0, 0.0, 0.0]
    assert characteristic(satellite(OMEGA).A)[2] == pytest.approx(OMEGA**2, rel=1e-13)


@given(st.lists(st.integers(-6, 6).map(lambda half: half / 2), min_size=1, max_size=5))
def test_companion_matrices_have_the_polynomial_they_are_made_of(rest):
    assert np.allclose(characteristic(companion_matrix([1.0, *rest])), [1.0, *rest], atol=1e-11)


@pytest.mark.parametrize("time", [0.1, 2.0, 50.0])
def test_the_exponential_is_the_known_motion_near_a_circular_orbit(time: float):
    """The closed form of Clohessy and Wiltshire's equations in the plane."""
    s, c = np.sin(time), np.cos(time)
    closed = [
        [4 - 3 * c, s, 0, 2 * (1 - c)],
        [3 * s, c, 0, 2 * s],
        [6 * (s - time), 2 * (c - 1), 1, 4 * s - 3 * time],
        [6 * (c - 1), -2 * s, 0, 4 * c - 3],
    ]
    assert np.allclose(satellite().transition(time), closed, rtol=1e-12, atol=1e-11)


def test_the_reference_of_the_polar_orbit_is_where_it_is_linearised():
    found = linearise(instance.load("soft-return-geo"))
    sigma, omega = found.parameters[:2]
    units = np.array([1.0, 1.0, sigma, sigma])
    assert found.constant
    assert found.nonlinear
    assert found.on_reference
    assert np.allclose(found.system.A * units[:, None] / units, satellite(omega).A, rtol=1e-13, atol=0.0)
    assert np.allclose(found.system.B * units[:, None], satellite(omega).B, rtol=1e-13)
    assert found.point.tolist() == [sigma, 0.0, 0.0, omega]


def test_a_model_alone_takes_its_defaults():
    found = analyse(kernels.load("polar_orbit"))
    assert np.array_equal(found.about.system.A, satellite().A)
    assert "nonlinear motion" in found.stability.reason
    assert found.observability is None


def test_equilibria_are_found_from_where_one_looks():
    model = pendulum()
    for start, expected, verdict in ((0.3, 0.0, "asymptotically stable"), (3.0, np.pi, "unstable")):
        point = equilibrium(model, (0.5,), np.array([start, 0.1]))
        assert np.allclose(point, [expected, 0.0], atol=1e-9)
        slopes = np.array(model.jacobian_x(0.0, point, (0.0,), (0.5,))).reshape(2, 2)
        assert stability(spectrum(slopes)).verdict == verdict


def test_a_model_without_an_equilibrium_says_so():
    model = pendulum()
    falling = replace(model, functions=model.functions | {"dynamics": lambda t, x, u, p: (x[1], -1.0)})
    with pytest.raises(BadInput, match=r"no equilibrium of pendulum was found from the initial point \(0, 0\)"):
        linearise(falling)


def test_a_model_that_rests_for_an_instant_has_no_equilibrium():
    model = pendulum()
    forced = {"dynamics": lambda t, x, u, p: (x[1], -np.sin(x[0]) + np.sin(t) + (u[0] if u else 0.0))}
    only_then = r"vanish at \(0, 0\) only at t = 0, so this point is not an equilibrium; declare a reference"
    with pytest.raises(BadInput, match=only_then):
        linearise(replace(model, functions=model.functions | forced))


def test_coefficients_that_depend_on_time_decide_nothing():
    model = pendulum()
    swinging = {"jacobian_x": lambda t, x, u, p: (0.0, 1.0, -1.0 - 0.5 * np.sin(t), 0.0)}
    found = analyse(replace(model, functions=model.functions | swinging))
    assert not found.about.constant
    assert found.stability.verdict is None
    assert "depend on time" in found.stability.reason


def test_python_control_gets_the_system_with_its_names():
    theirs = satellite(OMEGA).to_control()
    assert (theirs.state_labels, theirs.input_labels) == (["x1", "x2", "x3", "x4"], ["u1", "u2"])
    assert (theirs.output_labels, theirs.name) == (["y1", "y2"], "satellite")
    assert np.array_equal(theirs.A, satellite(OMEGA).A)
    assert np.array_equal(theirs.C, satellite(OMEGA).C)


def test_python_control_is_asked_for_where_it_is_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "control", None)
    with pytest.raises(BadInput, match=r"satsym\[control\]"):
        satellite().to_control()


@pytest.mark.parametrize(
    ("matrices", "complaint"),
    [
        (([[1.0, 2.0]],), r"A: the shape \(1, 2\) does not fit"),
        (([[1.0]], [[1.0], [2.0]]), r"B: the shape \(2, 1\) does not fit"),
        (([[np.nan]],), "A: has an entry that is not finite"),
        (([[1.0]], [[1.0]], [[1.0, 2.0]]), r"C: the shape \(1, 2\) does not fit"),
    ],
)
def test_matrices_that_do_not_fit_are_refused(matrices, complaint: str):
    with pytest.raises(BadInput, match=complaint):
        system(*matrices)


def test_unknown_inputs_are_refused():
    with pytest.raises(BadInput, match=r'"u3".*u1'):
        satellite().with_inputs(["u3"])
