"""Regulators against python-control, SciPy and an integrator; what keeps one from existing is told."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import control
import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from satsym import instance
from satsym.analysis.linear.equilibrium import linearise
from satsym.analysis.linear.system import LinearSystem, system
from satsym.analysis.regulator import many, riccati
from satsym.analysis.regulator.feedback import designed, region_of_attraction, responses, simulate
from satsym.analysis.regulator.lqr import flow, lqr, regulator
from satsym.solvers import simulate as fly
from satsym.solvers.simulation.closed_loop import Law
from satsym.status import BadInput, Status
from tests.support.linear_models import OMEGA, in_other_units, pendulum, satellite

SEEDS = st.integers(0, 2**32 - 1)
THESIS = satellite().with_inputs(["u2"])

CASE = """
model = "polar_orbit"
title = "A regulator for the nonlinear satellite"
[initial]
r = {r}
r_dot = 0.0
theta = 0.0
theta_dot = 1.0
[time]
tf = {tf}
[lqr]
Q = [1, 1, 1, 1]
R = [1]
inputs = ["u2"]
"""


LAG = system([[-1.0]], [[1.0]])


def case(folder: Path, r: float = 1.01, tf: float = 20.0, more: str = "") -> instance.Instance:
    path = folder / "case.toml"
    path.write_text(CASE.format(r=r, tf=tf) + more, encoding="utf-8")
    return instance.load(path)


def spd(rng: np.random.Generator, n: int) -> np.ndarray:
    root = rng.normal(size=(n, n))
    return root @ root.T + 0.1 * np.eye(n)


def test_the_regulator_of_the_thesis_is_that_of_python_control_and_scipy():
    found = lqr(THESIS, np.eye(4), [1.0])
    K, P, poles = control.lqr(THESIS.A, THESIS.B, np.eye(4), np.eye(1))
    theirs = scipy.linalg.solve_continuous_are(THESIS.A, THESIS.B, np.eye(4), np.eye(1))
    assert np.abs(found.K - K).max() < 1e-10
    assert max(np.abs(found.P - P).max(), np.abs(found.P - theirs).max()) < 1e-10
    assert np.abs(np.sort_complex(found.eigenvalues) - np.sort_complex(poles)).max() < 1e-10
    assert np.abs(found.polynomial - np.poly(THESIS.A - THESIS.B @ K)).max() < 1e-10
    assert found.residual < 1e-12
    assert found.routh.sign_changes == 0


def test_the_shipped_instance_of_the_thesis_is_that_regulator():
    design, by_hand = designed(instance.load("uny-lqr")), lqr(THESIS, np.eye(4), [1.0])
    assert np.abs(design.regulator.K - by_hand.K).max() < 1e-12
    assert design.regulator.system.inputs == ("u2",)
    assert design.deviation is not None
    assert design.regulator.cost(design.deviation) == pytest.approx(np.ones(4) @ by_hand.P @ np.ones(4), rel=1e-13)
    assert designed(instance.load("uny-lqr-both")).regulator.system.inputs == ("u1", "u2")


def test_the_thesis_s_law_does_not_bring_the_satellite_back_from_the_disturbance_it_shows():
    """The linear deviations decay, as its figures show; those of the exact motion, from the same start, do not."""
    given_case = instance.load("uny-lqr")
    found = responses(designed(given_case), given_case)
    assert found.exact_steered is not None
    assert np.abs(found.steered.x[:, -1]).max() < 1e-10
    assert np.abs(found.free.x[2]).max() > 300.0  # the angle drifts away, as in its figure 3.6
    assert np.abs(found.exact_steered.x[0, -1]) > 1e6


def test_the_thesis_printed_the_right_gain_and_riccati_solution():
    """Pinned: its equations (3.34) and (3.35), to the digits that it prints."""
    found = lqr(THESIS, np.eye(4), [1.0])
    assert np.round(found.K, 4).tolist() == [[10.2210, 4.2841, -1.0, 4.0170]]
    assert np.round(found.P[0], 4).tolist() == [36.5859, 17.2448, -6.2841, 10.2210]


@settings(max_examples=30)
@given(SEEDS)
def test_units_do_not_change_a_regulator(seed):
    """P and K in other units are the same costs and controls; SciPy's own solver loses them there."""
    rng = np.random.default_rng(seed)
    Q, R = spd(rng, 4), spd(rng, 2)
    usual, x, u, rate = satellite(), *(10.0 ** rng.uniform(-5, 5, n) for n in (4, 2)), 10.0 ** rng.uniform(-5, 5)
    A, B = usual.A * x / x[:, None] * rate, usual.B * u / x[:, None] * rate
    other = lqr(system(A, B), Q * np.outer(x, x), R * np.outer(u, u))
    one = lqr(usual, Q, R)
    assert max(other.residual, one.residual) < 1e-12
    assert np.allclose(other.P * rate / np.outer(x, x), one.P, rtol=1e-9, atol=1e-9 * np.abs(one.P).max())
    assert np.allclose(other.K * u[:, None] / x, one.K, rtol=1e-8, atol=1e-8 * np.abs(one.K).max())


@settings(max_examples=60)
@given(st.integers(1, 6), st.integers(1, 3), SEEDS)
def test_regulators_agree_with_scipy_and_are_stable(n, m, seed):
    rng = np.random.default_rng(seed)
    given_system = system(rng.normal(size=(n, n)), rng.normal(size=(n, m)))
    Q, R = spd(rng, n), spd(rng, m)
    found = lqr(given_system, Q, R)
    theirs = scipy.linalg.solve_continuous_are(given_system.A, given_system.B, Q, R)
    assert np.allclose(found.P, theirs, rtol=1e-7, atol=1e-8 * np.abs(theirs).max())
    G = given_system.B @ np.linalg.solve(R, given_system.B.T)
    # where the problem is badly conditioned, nobody gets below 1e-12
    assert found.residual < max(1e-12, 2.0 * riccati.residual(given_system.A, G, Q, theirs))
    assert found.eigenvalues.real.max() < 0.0
    assert found.routh.sign_changes == 0
    assert (np.linalg.eigvalsh(found.P) > 0.0).all()


def test_a_negative_weight_has_a_regulator_where_the_riccati_equation_has_a_stabilising_solution():
    found = lqr(LAG, [-0.5], [1.0])
    assert found.P[0, 0] == pytest.approx(np.sqrt(0.5) - 1.0, rel=1e-15)
    assert found.eigenvalues == pytest.approx(-np.sqrt(0.5), rel=1e-15)
    assert found.residual < 1e-15
    K, P, _ = many.solve(LAG.A, LAG.B, [[-0.5]], [[1.0]])
    np.testing.assert_allclose([K, P], [found.K, found.P], rtol=1e-9)
    for Q in ([1.0, 1.0, 1.0, -1.0], [[1, 2, 0, 0], [2, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]):
        weight = np.diag(Q) if np.ndim(Q) == 1 else np.array(Q)
        P = scipy.linalg.solve_continuous_are(satellite().A, satellite().B, weight, np.eye(2))
        np.testing.assert_allclose(lqr(satellite(), Q, [1, 1]).P, P, rtol=1e-9, atol=1e-9)


@settings(max_examples=60)
@given(st.integers(1, 6), st.integers(1, 3), SEEDS)
def test_cross_weights_agree_with_scipy_and_python_control(n, m, seed):
    rng = np.random.default_rng(seed)
    A, B = rng.normal(size=(n, n)), rng.normal(size=(n, m))
    joint = spd(rng, n + m)
    Q, R, N = joint[:n, :n], joint[n:, n:], joint[:n, n:]
    found = lqr(system(A, B), Q, R, None, N)
    P = scipy.linalg.solve_continuous_are(A, B, Q, R, s=N)
    assert np.linalg.norm(found.P - P) <= 1e-6 * np.linalg.norm(P)
    assert np.linalg.norm(found.K - control.lqr(A, B, Q, R, N)[0]) <= 1e-6 * np.linalg.norm(found.K)
    assert np.sort(found.eigenvalues.real) == pytest.approx(np.sort(np.linalg.eigvals(A - B @ found.K).real), rel=1e-6)
    K, again, _ = many.solve(A, B, Q, R, N)
    assert np.linalg.norm(K - found.K) <= 1e-6 * np.linalg.norm(found.K)
    assert np.linalg.norm(again - found.P) <= 1e-6 * np.linalg.norm(P)


@settings(max_examples=60)
@given(st.integers(1, 4), st.integers(1, 2), SEEDS)
def test_indefinite_weights_are_refused_where_the_hamiltonian_matrix_has_imaginary_eigenvalues(n, m, seed):
    rng = np.random.default_rng(seed)
    A, B, root, N = (rng.normal(size=shape) for shape in ((n, n), (n, m), (n, n), (n, m)))
    Q, R = root + root.T + rng.uniform(0.0, 2.0) * np.eye(n), spd(rng, m) + np.eye(m)
    free, weight, _ = riccati.without_cross(A, B, Q, R, 0.5 * N)
    values = np.linalg.eigvals(riccati.hamiltonian(free, riccati.cost_of_control(B, R), weight))
    clear = np.abs(values.real).min() / np.abs(values).max()
    if clear < 1e-8:
        with pytest.raises(BadInput, match="Q: the cost has no"):
            lqr(system(A, B), Q, R, None, 0.5 * N)
        return
    found = lqr(system(A, B), Q, R, None, 0.5 * N)
    P = scipy.linalg.solve_continuous_are(A, B, Q, R, s=0.5 * N)
    assert np.linalg.norm(found.P - P) <= 1e-6 * np.linalg.norm(P)


def test_a_finite_horizon_with_a_negative_weight_ends_before_the_cost_escapes():
    """x' = u, -x^2 + u^2: P = -tan(T)."""
    chain = system([[0.0]], [[1.0]])
    assert lqr(chain, [-1.0], [1.0], 1.5).P[0, 0] == pytest.approx(-np.tan(1.5), rel=1e-12)
    for horizon in (1.6, 3.0, 4.0, 5.0, 100.0):
        with pytest.raises(BadInput, match=r"\[lqr\] horizon: over so long a horizon the cost has no lower bound"):
            lqr(chain, [-1.0], [1.0], horizon)


def test_a_finite_horizon_with_a_cross_weight_agrees_with_integration():
    rng = np.random.default_rng(5)
    A, B, joint = rng.normal(size=(3, 3)), rng.normal(size=(3, 2)), spd(rng, 5)
    Q, R, N = joint[:3, :3], joint[3:, 3:], joint[:3, 3:]

    def rate(_, flat):
        P = flat.reshape(3, 3)
        gain = np.linalg.solve(R, B.T @ P + N.T)
        return (A.T @ P + P @ A - gain.T @ R @ gain + Q).ravel()

    P = solve_ivp(rate, (0.0, 2.0), np.zeros(9), method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1].reshape(3, 3)
    found = lqr(system(A, B), Q, R, 2.0, N)
    np.testing.assert_allclose(found.P, P, rtol=1e-9)
    np.testing.assert_allclose(found.K, np.linalg.solve(R, B.T @ P + N.T), rtol=1e-9)
    np.testing.assert_allclose(found.gains(4)[[0, -1]], [found.K, np.linalg.solve(R, N.T)], rtol=1e-9)


@given(SEEDS)
@settings(max_examples=20)
def test_no_other_gain_costs_less(seed):
    """The cost x'Xx of any stabilising gain solves a Lyapunov equation."""
    rng = np.random.default_rng(seed)
    best = lqr(satellite(), np.eye(4), np.eye(2))
    K = best.K + 0.1 * rng.normal(size=best.K.shape)
    closed = satellite().with_feedback(K)
    assert np.linalg.eigvals(closed.A).real.max() < 0.0
    X = scipy.linalg.solve_continuous_lyapunov(closed.A.T, -(np.eye(4) + K.T @ K))
    assert np.linalg.eigvalsh(X - best.P).min() > -1e-12


STUCK = system([[1.0, 0.0], [0.0, -1.0]], [[0.0], [1.0]])


@pytest.mark.parametrize(
    ("given_system", "Q", "R", "complaint"),
    [
        (satellite(), [1, 1, -0.1, 1], [1, 1], r"\[lqr\] Q: the cost has no lower bound, because at the frequency 0 "),
        (LAG, [-1.5], [1], r"\[lqr\] Q: the cost has no lower bound, because at the frequency 0 .* exceed the cost"),
        (LAG, [-1.0], [1], r"\[lqr\] Q: the cost has no minimum, because at the frequency 0 .* balance the cost"),
        (satellite(), [[1, 2, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], [1, 1], "Q: not symmetric at row 2"),
        (satellite(), [1, 1, 1, 1], [1, 0], r"\[lqr\] R: not positive definite"),
        (satellite(), [1, 1, 1, 1], [[1, 1], [1, 1]], r"\[lqr\] R: not positive definite"),
        (satellite(), [1, 1, 1], [1, 1], r"\[lqr\] Q: .* 4 numbers"),
        (
            satellite().with_inputs(["u1"]),
            [1, 1, 1, 1],
            [1],
            "not stabilisable, the inputs u1 cannot control the mode s = 0",
        ),
        (
            satellite(OMEGA).with_inputs(["u1"]),
            [1, 1, 1, 1],
            [1],
            "not stabilisable, the inputs u1 cannot control the mode s = 0",
        ),
        (STUCK, [1, 1], [1], "not stabilisable, the inputs u1 cannot control the mode s = 1"),
        (satellite(), [1, 1, 0, 1], [1, 1], "not detectable, the mode s = 0 on the imaginary axis"),
        (satellite(OMEGA), [1, 1e8, 0, 1e8], [1e14, 1e14], "not detectable, the mode s = 0 on the imaginary axis"),
        (satellite(), [0, 0, 0, 0], [1, 1], "not detectable, the mode s = 0, ±1i"),
    ],
)
def test_what_keeps_a_regulator_from_existing_is_told(given_system: LinearSystem, Q, R, complaint: str):
    with pytest.raises(BadInput, match=complaint):
        lqr(given_system, Q, R)


def test_modes_that_decay_by_themselves_need_neither_inputs_nor_weights():
    given_system = system([[-1.0, 0.0], [0.0, 1.0]], [[0.0], [1.0]])
    found = lqr(given_system, [0.0, 1.0], [1.0])
    assert found.eigenvalues.real.max() == pytest.approx(-1.0)
    assert found.P[1, 1] == pytest.approx(1.0 + np.sqrt(2.0), rel=1e-14)


def riccati_by_integration(given_system: LinearSystem, Q: np.ndarray, R: np.ndarray, length: float) -> np.ndarray:
    G, n = given_system.B @ np.linalg.solve(R, given_system.B.T), len(Q)

    def rate(_, p):
        P = p.reshape(n, n)
        return (given_system.A.T @ P + P @ given_system.A - P @ G @ P + Q).ravel()

    found = solve_ivp(rate, (0.0, length), np.zeros(n * n), method="DOP853", rtol=1e-12, atol=1e-12)
    return found.y[:, -1].reshape(n, n)


@pytest.mark.parametrize("horizon", [0.01, 0.5, 3.0, 10.0])
def test_a_finite_horizon_agrees_with_integration(horizon: float):
    found = lqr(THESIS, np.eye(4), [1.0], horizon)
    assert np.abs(found.P - riccati_by_integration(THESIS, np.eye(4), np.eye(1), horizon)).max() < 1e-10
    assert found.residual < 1e-12


@pytest.mark.parametrize("horizon", [40.0, 1e3, 1e12])
def test_a_long_horizon_becomes_the_infinite_one_without_blowing_up(horizon: float):
    found, limit = lqr(THESIS, np.eye(4), [1.0], horizon), lqr(THESIS, np.eye(4), [1.0])
    assert np.abs(found.P - limit.P).max() < 1e-11
    assert found.residual < 1e-12


def test_a_finite_horizon_needs_no_stability():
    """x1' = x1 is out of reach and costs infinitely much in the long run, but (e^4 - 1)/2 until t = 2."""
    found = lqr(STUCK, [1.0, 0.0], [1.0], horizon=2.0)
    assert found.cost([1.0, 0.0]) == pytest.approx((np.exp(4.0) - 1.0) / 2.0, rel=1e-13)
    assert found.residual < 1e-12


def test_gains_along_a_horizon_begin_with_its_own_and_end_with_none():
    found = lqr(THESIS, np.eye(4), [1.0], 3.0)
    gains = found.gains(30)
    assert np.allclose(gains[0], found.K, atol=1e-12)
    assert not gains[-1].any()
    assert np.allclose(gains[20], lqr(THESIS, np.eye(4), [1.0], 1.0).K, atol=1e-12)


def test_flows_compose():
    A, G = THESIS.A, THESIS.B @ THESIS.B.T
    whole, parts = flow(A, G, np.eye(4), 1.0), flow(A, G, np.eye(4), 0.3).then(flow(A, G, np.eye(4), 0.7))
    for one, other in zip(whole, parts, strict=True):
        assert np.abs(one - other).max() < 1e-13


def weights(rng: np.random.Generator, count: int, n: int) -> np.ndarray:
    return np.exp(rng.uniform(-2.0, 2.0, (count, n)))[:, :, None] * np.eye(n)


def satellites(rng: np.random.Generator, count: int) -> np.ndarray:
    return np.array([satellite(omega).A for omega in np.exp(rng.uniform(-1.0, 1.0, count))])


def test_many_regulators_at_once_are_those_one_by_one():
    rng = np.random.default_rng(1)
    A, Q, R = satellites(rng, 200), weights(rng, 200, 4), weights(rng, 200, 2)
    K, P, residual = many.solve(A, satellite().B, Q, R)
    assert residual.max() < 1e-12
    for i in range(0, 200, 10):
        one = lqr(system(A[i], satellite().B), Q[i], R[i])
        assert np.allclose(P[i], one.P, rtol=1e-10, atol=1e-12)
        assert np.allclose(K[i], one.K, rtol=1e-10, atol=1e-12)
        G = satellite().B @ np.linalg.solve(R[i], satellite().B.T)
        assert residual[i] == pytest.approx(riccati.residual(A[i], G, Q[i], P[i]), abs=1e-14)


def test_ten_thousand_regulators_keep_their_residual():
    rng = np.random.default_rng(2)
    K, P, residual = many.solve(satellites(rng, 10_000), THESIS.B, weights(rng, 10_000, 4), weights(rng, 10_000, 1))
    assert (K.shape, P.shape) == ((10_000, 1, 4), (10_000, 4, 4))
    assert residual.max() < 1e-12


@settings(max_examples=15)
@given(st.integers(1, 5), st.integers(1, 2), SEEDS)
def test_batches_of_any_matrices_keep_their_residual_where_single_ones_do(n, m, seed):
    rng = np.random.default_rng(seed)
    A, B = rng.normal(size=(40, n, n)), rng.normal(size=(40, n, m))
    Q = np.array([spd(rng, n) for _ in A])
    _, P, residual = many.solve(A, B, Q, np.eye(m))
    singles = [lqr(system(a, b), q, np.eye(m)) for a, b, q in zip(A, B, Q, strict=True)]
    assert all(mine < max(1e-12, 10.0 * one.residual) for mine, one in zip(residual, singles, strict=True))
    for mine, one in zip(P, singles, strict=True):
        assert np.allclose(mine, one.P, rtol=1e-6, atol=1e-7 * np.abs(one.P).max())


def test_problems_of_a_batch_without_a_solution_are_marked_and_harm_no_others():
    A = np.array([satellite().A, np.diag([1.0, -1.0, -2.0, -3.0])])
    B = np.array([THESIS.B, [[0.0], [1.0], [1.0], [1.0]]])
    K, P, residual = many.solve(A, B, np.eye(4), np.eye(1))
    assert np.isnan([K[1].sum(), P[1].sum(), residual[1]]).all()
    assert np.allclose(K[0], lqr(THESIS, np.eye(4), [1.0]).K, rtol=1e-12)


def test_leading_axes_are_broadcast():
    rng = np.random.default_rng(3)
    K, P, residual = many.solve(satellites(rng, 3)[:, None], THESIS.B, weights(rng, 5, 4), np.eye(1))
    assert (K.shape, P.shape, residual.shape) == ((3, 5, 1, 4), (3, 5, 4, 4), (3, 5))


def test_batches_do_not_depend_on_units():
    rng = np.random.default_rng(4)
    A = satellites(rng, 50) * OMEGA
    A[:, [0, 2], [1, 3]] = 1.0
    A[:, 1, 0] *= OMEGA
    _, _, residual = many.solve(A, satellite().B, weights(rng, 50, 4) * [1.0, 1e8, 1.0, 1e8], 1e14 * np.eye(2))
    assert residual.max() < 1e-12


def test_the_nonlinear_motion_costs_nearly_what_the_linear_one_would(tmp_path: Path):
    simulated = simulate(case(tmp_path, r=1.001), "lqr")
    assert simulated.status is Status.CONVERGED
    assert simulated.feedback == "lqr"
    assert simulated.metrics["lqr_cost"] == pytest.approx(simulated.metrics["lqr_cost_linear"], rel=0.01)
    assert np.abs(simulated.x[[0, 1, 3], -1] - [1.0, 0.0, 1.0]).max() < 1e-6
    assert not simulated.u[0].any()
    assert simulated.u[1].any()


def test_the_error_of_a_simulation_under_a_law_is_below_its_tolerance(tmp_path: Path):
    """Against SciPy's Radau, from the same law written out by hand."""
    given_case = case(tmp_path, r=1.1, tf=5.0)
    simulated, K = simulate(given_case, "lqr"), lqr(THESIS, np.eye(4), [1.0]).K[0]

    def rates(t, x):
        r, v, theta, w = x
        u2 = -K @ [r - 1.0, v, theta - t, w - 1.0]
        return [v, r * w * w - 1.0 / r**2, w, (u2 - 2.0 * v * w) / r]

    theirs = solve_ivp(rates, (0.0, 5.0), given_case.initial, method="Radau", rtol=1e-11, atol=1e-12).y[:, -1]
    assert np.abs(simulated.x[:, -1] - theirs).max() < 1e-8


def test_bounds_hold_under_the_law(tmp_path: Path):
    simulated = simulate(case(tmp_path, r=1.1, more="[control]\nu2 = [-0.1, 0.05]\n"), "lqr")
    assert (simulated.u[1].min(), simulated.u[1].max()) == (-0.1, 0.05)
    assert simulated.status is Status.CONVERGED


def test_a_law_drives_the_motion_out_of_its_basin_too_and_says_so(tmp_path: Path):
    """From r = 2, further out than the basin, the thesis's law throws the nonlinear satellite out."""
    simulated = simulate(case(tmp_path, r=2.0, tf=45.0), "lqr")
    assert simulated.metrics["r_max"] > 1e6


def test_a_motion_that_leaves_its_domain_under_a_law_ends_there(tmp_path: Path):
    """Gravity is switched off, so that nothing keeps the law from pulling the satellite through the centre."""
    given_case = case(tmp_path, r=1.0, tf=2.0)
    straight = given_case.model.functions | {"dynamics": lambda t, x, u, p: (x[1], u[0], 0.0, 0.0)}
    falling = replace(given_case, model=replace(given_case.model, functions=straight))
    simulated = fly(falling, Law("inwards", lambda t, x: (-2.0, 0.0)))
    assert simulated.status is Status.LEFT_DOMAIN
    last = np.flatnonzero(np.isfinite(simulated.x[0]))[-1]
    assert simulated.times[last] == pytest.approx(1.0, abs=0.01)  # 1 - t^2
    assert np.abs(simulated.x[0, :last] - (1.0 - simulated.times[:last] ** 2)).max() < 1e-9


def test_a_finite_horizon_pays_what_it_predicts(tmp_path: Path):
    simulated = simulate(case(tmp_path, r=1.0001, tf=3.0, more="horizon = 3.0\n"), "lqr")
    assert simulated.metrics["lqr_cost"] == pytest.approx(simulated.metrics["lqr_cost_linear"], rel=1e-3)
    assert np.abs(simulated.u[:, -1]).max() < 1e-12


@pytest.mark.parametrize("more", ["", "horizon = 10.0\n"])
def test_responses_are_the_same_where_deviations_are_small(tmp_path: Path, more: str):
    given_case = case(tmp_path, r=1.0 + 1e-5, tf=10.0, more=more)
    found = responses(designed(given_case), given_case)
    assert found.exact_free is not None
    assert found.exact_steered is not None
    for linear, exact in ((found.free, found.exact_free), (found.steered, found.exact_steered)):
        assert np.abs(linear.x - exact.x).max() < 1e-4 * np.abs(linear.x).max()
    cost = found.steered.cost(designed(given_case).regulator, found.times)
    assert cost[-1] == pytest.approx(designed(given_case).regulator.cost([1e-5, 0.0, 0.0, 0.0]), rel=1e-3)


def test_the_basin_holds_what_it_promises(tmp_path: Path):
    """Just inside its extents the nonlinear motion returns, just outside it does not."""
    given_case = case(tmp_path, tf=45.0)
    design = designed(given_case)
    found = region_of_attraction(design.about, design.regulator, given_case)
    low, high = found.extents["r"]
    K = design.regulator.K[0]

    def rates(t, x):
        r, v, theta, w = x
        return [v, r * w * w - 1.0 / r**2, w, (-K @ [r - 1.0, v, theta - t, w - 1.0] - 2.0 * v * w) / r]

    def collision(t, x):
        return x[0] - 0.01

    collision.terminal = True
    for fraction, returns in ((0.97 * low, True), (0.97 * high, True), (1.03 * high, False)):
        start = [1.0 + fraction, 0.0, 0.0, 1.0]
        end = solve_ivp(rates, (0.0, 45.0), start, rtol=1e-6, events=collision).y[:, -1]
        assert (np.abs(end[[0, 3]] - 1.0).max() < 1e-2) == returns
    assert 0.0 < found.level <= design.regulator.cost([high, 0.0, 0.0, 0.0])


def test_a_linear_motion_returns_from_everywhere():
    model = pendulum()
    linear = replace(
        model,
        functions=model.functions
        | {"dynamics": lambda t, x, u, p: (x[1], x[0] + u[0]), "jacobian_x": lambda t, x, u, p: (0.0, 1.0, 1.0, 0.0)},
    )
    about = linearise(linear)
    assert not about.nonlinear
    assert region_of_attraction(about, regulator(about)).extents == {"q": (-np.inf, np.inf), "w": (-np.inf, np.inf)}


def test_a_standing_pendulum_is_held_up_from_nearby_only():
    model = pendulum()
    about = replace(linearise(model), point=np.array([np.pi, 0.0]))
    about = replace(
        about, system=system([[0.0, 1.0], [1.0, -0.5]], [[0.0], [1.0]], states=("q", "w"), inputs=("torque",))
    )
    found = region_of_attraction(about, regulator(about))
    low, high = found.extents["q"]
    assert -low == pytest.approx(high, rel=1e-6)  # the pendulum is the same to both sides
    assert high > 1.0


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("[lqr.allowed]\nr = 0.1\nu1 = 1.0\nu2 = 1.0\n", None),
        ("[lqr.allowed]\nr = 0.1\nu1 = 1.0\n", r"\[lqr.allowed\] u2: missing"),
        ("[lqr.allowed]\nu1 = 1.0\nu2 = 1.0\n", "no state has an allowed deviation"),
        ("[lqr.allowed]\nr = 0.0\nu1 = 1.0\nu2 = 1.0\n", r"\[lqr.allowed\] r: an allowed deviation must be positive"),
        ('[lqr.allowed]\nr = "1 s"\nu1 = 1.0\nu2 = 1.0\n', r"\[lqr.allowed\] r:"),
        ("[lqr.allowed]\nx = 0.1\nu1 = 1.0\nu2 = 1.0\n", r"\[lqr.allowed\] x: the model has no such state or active"),
        ("[lqr]\nR = [1]\n[lqr.allowed]\nr = 0.1\nu1 = 1.0\nu2 = 1.0\n", r"\[lqr\] R: \[lqr.allowed\] already gives"),
        ("[lqr]\n", r"\[lqr\] Q: missing"),
    ],
)
def test_weights_come_from_allowed_deviations(tmp_path: Path, text: str, complaint: str | None):
    path = tmp_path / "case.toml"
    path.write_text(CASE.format(r=1.1, tf=1.0).partition("[lqr]")[0] + text, encoding="utf-8")
    if complaint:
        with pytest.raises(BadInput, match=complaint):
            instance.load(path)
        return
    options = instance.load(path).lqr
    assert options is not None
    assert np.allclose(options.Q, np.diag([100.0, 0.0, 0.0, 0.0]))
    assert np.allclose(options.R, np.eye(2))


def test_kilometres_and_seconds_are_no_trouble():
    found = designed(instance.load("geo-lqr")).regulator
    assert found.residual < 1e-13
    theirs = scipy.linalg.solve_continuous_are(found.system.A, found.system.B, found.Q, found.R)
    G = found.system.B @ np.linalg.solve(found.R, found.system.B.T)
    assert riccati.residual(found.system.A, G, found.Q, theirs) > 1e3 * found.residual  # SciPy's scaling is not enough
    assert in_other_units(found.system, 1).states == found.system.states


def test_instances_without_a_table_and_models_without_controls_are_refused(tmp_path: Path):
    with pytest.raises(BadInput, match=r"soft-return: \[lqr\]: missing"):
        designed(instance.load("soft-return"))
    model = pendulum()
    bare = replace(
        model, spec=replace(model.spec, controls=()), functions=model.functions | {"jacobian_u": lambda *_: ()}
    )
    with pytest.raises(BadInput, match="has no control"):
        designed(replace(bare, functions=bare.functions | {"dynamics": lambda t, x, u, p: (x[1], -x[0])}))


def test_a_feedback_that_does_not_exist_is_refused(tmp_path: Path):
    with pytest.raises(BadInput, match="the control laws of this model are none, lqr"):
        simulate(case(tmp_path), "telepathy")
