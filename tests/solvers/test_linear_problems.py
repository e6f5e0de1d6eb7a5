"""Linear problems: closed forms, the controllability Gramian by another route, and what is not linear."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad_vec
from scipy.linalg import expm
from sympy import Expr, exp, sin, sympify

from satsym import instance
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import by_search, solve
from satsym.solvers import linear as closed_form
from satsym.spec import ControlSetKind, Variable
from satsym.status import BadInput, Status
from satsym.symbolic import FirstOrder, Problem, symbols_of, t
from tests.support.models import build, k, q, scalar, w

place, speed, push = symbols_of(Variable(name, name) for name in ("place", "speed", "push"))
UNITS = st.integers(-2000, 2000).map(lambda value: value / 1000.0)


def moving(name: str, force: Expr, constraints: tuple[Expr, ...] = (), control_set: ControlSetKind = "free") -> Problem:
    """A place, a speed whose rate is the force, and a push that costs half its square."""
    return Problem(
        name=name,
        title=f"speed' = {force}",
        model=FirstOrder(
            name=f"{name}_motion",
            title="A point on a line",
            states=(Variable("place", "q"), Variable("speed", "v")),
            controls=(Variable("push", "w"),),
            parameters=(),
            rates={place: speed, speed: force},
        ),
        running_cost=push**2 / 2,
        terminal_constraints=constraints,
        control_set=control_set,
    )


def linear(case: Instance) -> Solution:
    """The instance solved in closed form."""
    solution = solve(replace(case, solver=msgspec.structs.replace(case.solver, method="linear")))
    assert solution.status is Status.CONVERGED, solution.message
    assert solution.method == "linear"
    assert solution.certificate is not None
    assert solution.certificate.verdict == "certified"
    return solution


def from_to(case: Instance, initial: Any, final: dict[str, float], tf: float | None) -> Instance:
    return replace(case, initial=tuple(map(float, initial)), final=final, tf=tf)


TEXT = "[initial]\nplace = 0.0\nspeed = 0.0\n[final]\nplace = 1.0\nspeed = 0.0\n[time]\ntf = 2.0\n"


@pytest.fixture(scope="module")
def integrator(tmp_path_factory: pytest.TempPathFactory) -> Instance:
    return build(tmp_path_factory.mktemp("linear"), moving("integrator", push, control_set="box"), TEXT)


@pytest.fixture(scope="module")
def oscillator(tmp_path_factory: pytest.TempPathFactory) -> Instance:
    return build(tmp_path_factory.mktemp("linear"), moving("oscillator", -4 * place + push), TEXT)


def test_a_point_is_moved_with_the_least_effort(integrator: Instance):
    """u = 6/T^2 - 12 t/T^3 and J = 6/T^3."""
    found = linear(integrator)
    assert np.abs(found.u[0] - (1.5 - 1.5 * found.times)).max() < 1e-13
    assert np.abs(found.x[0] - found.times**2 * (3.0 - found.times) / 4.0).max() < 1e-13
    assert found.lam[:, 0] == pytest.approx([-1.5, -1.5], rel=1e-13)
    assert found.objective == pytest.approx(0.75, rel=1e-13)


def test_where_the_velocity_is_free_its_costate_ends_at_zero(integrator: Instance):
    """J = 3 / (2 T^3)."""
    found = linear(from_to(integrator, (0.0, 0.0), {"place": 1.0}, 2.0))
    assert found.objective == pytest.approx(1.5 / 8.0, rel=1e-13)
    assert abs(found.lam[1, -1]) < 1e-14


def gramian_solution(matrix: np.ndarray, d: Any, final: Any, tf: float) -> tuple[float, np.ndarray]:
    """Cost and initial costates of the least effort to get from one state to another, through the Gramian."""
    b = np.array([[0.0], [1.0]])
    gramian = quad_vec(lambda s: expm(matrix * s) @ b @ b.T @ expm(matrix.T * s), 0.0, tf, epsabs=1e-14)[0]
    missing = np.asarray(final) - expm(matrix * tf) @ np.asarray(d)
    weights = np.linalg.solve(gramian, missing)
    return 0.5 * float(missing @ weights), -expm(matrix.T * tf) @ weights


@settings(max_examples=25)
@given(start=st.tuples(UNITS, UNITS), end=st.tuples(UNITS, UNITS), tf=st.floats(0.5, 5.0))
def test_the_gramian_says_the_same(oscillator: Instance, start: Any, end: Any, tf: float):
    cost, costates = gramian_solution(np.array([[0.0, 1.0], [-4.0, 0.0]]), start, end, tf)
    case = from_to(oscillator, start, {"place": end[0], "speed": end[1]}, tf)
    found = closed_form.solve(replace(case, solver=msgspec.structs.replace(case.solver, steps=20)))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(cost, rel=1e-9, abs=1e-12)
    assert found.lam[:, 0] == pytest.approx(costates, rel=1e-9, abs=1e-10)
    assert found.x[:, -1] == pytest.approx(end, abs=1e-11)


def test_collocation_agrees(oscillator: Instance):
    mine, other = linear(oscillator), by_search.collocation(oscillator)
    assert mine.objective == pytest.approx(other.objective, rel=1e-10)
    assert mine.lam[:, 0] == pytest.approx(other.lam[:, 0], rel=1e-10)


@pytest.mark.parametrize("horizon", [2.0, 300.0])
def test_the_regulator_follows_riccatis_equation(tmp_path: Path, horizon: float):
    """P' = P^2 - 1, P(T) = 0: w = -tanh(T - t) q. Modes that grow by e^300 do no harm."""
    problem = scalar("regulator", w, (q**2 + w**2) / 2, sympify(0), "free")
    found = closed_form.solve(build(tmp_path, problem, f"[initial]\nq = 2.0\n[time]\ntf = {horizon}\n"))
    expected = 2.0 * (np.exp(-found.times) + np.exp(found.times - 2.0 * horizon)) / (1.0 + math.exp(-2.0 * horizon))
    assert np.abs(found.x[0] - expected).max() < 1e-12
    assert np.abs(found.u[0] + np.tanh(horizon - found.times) * expected).max() < 1e-12
    assert found.objective == pytest.approx(2.0 * math.tanh(horizon), rel=1e-12)


def test_time_may_enter_everywhere(tmp_path: Path):
    """q' = t w + 1, L = e^t w^2/2, S = k (q - sin t)^2 / 2: lambda is constant and w = -lambda t e^(-t)."""
    problem = scalar("in_time", t * w + 1, exp(t) * w**2 / 2, k * (q - sin(t)) ** 2 / 2, "free")
    case = build(tmp_path, problem, "[parameters]\nk = 3.0\n[initial]\nq = -0.5\n[time]\nt0 = 0.5\ntf = 2.0\n")
    assert not case.model.spec.autonomous
    found = linear(case)
    reach = sum(s * (b**2 + 2.0 * b + 2.0) * math.exp(-b) for s, b in ((1.0, 0.5), (-1.0, 2.0)))
    lam = 3.0 * (1.0 - math.sin(2.0)) / (1.0 + 3.0 * reach)
    assert np.abs(found.lam - lam).max() < 1e-12
    assert np.abs(found.u[0] + lam * found.times * np.exp(-found.times)).max() < 1e-12
    assert found.objective == pytest.approx(lam**2 * reach / 2.0 + lam**2 / 6.0, rel=1e-12)


def test_a_terminal_constraint_has_its_multiplier(tmp_path: Path):
    """To place + speed = 1 from rest: J = 1 / (2 c'Wc) with c = (1, 1) and the Gramian W of the double integrator."""
    case = build(tmp_path, moving("onto_a_line", push, (place + speed - 1,)), TEXT)
    found = closed_form.solve(from_to(case, (0.0, 0.0), {}, 2.0))
    reach = 8.0 / 3.0 + 2.0 * 2.0 + 2.0
    assert found.objective == pytest.approx(0.5 / reach, rel=1e-12)
    assert found.x[:, -1].sum() == pytest.approx(1.0, rel=1e-13)
    assert found.lam[:, -1] == pytest.approx([-1.0 / reach] * 2, rel=1e-12)


def asked(case: Instance) -> Instance:
    return replace(case, solver=msgspec.structs.replace(case.solver, method="linear"))


def test_orbits_are_not_linear_and_it_says_where():
    with pytest.raises(BadInput, match="polar_orbit is not linear: the rate of r_dot is not linear in r"):
        solve(asked(instance.load("return-to-orbit")))


def test_numbers_too_small_to_be_scaled_are_said_not_to_be_finite(oscillator: Instance):
    found = solve(asked(from_to(oscillator, (0.0, 5e-324), {"place": 0.0, "speed": 0.0}, 2.0)))
    assert found.status is Status.NON_FINITE


def test_a_free_final_time_is_not_linear(integrator: Instance):
    with pytest.raises(BadInput, match="not linear: its final time is free"):
        solve(asked(from_to(integrator, (0.0, 0.0), {"place": 1.0, "speed": 0.0}, None)))


@pytest.mark.parametrize(("limit", "fits"), [(1.4, False), (1.6, True)])
def test_bounds_must_not_be_met(integrator: Instance, limit: float, fits: bool):
    """The control goes from 1.5 to -1.5."""
    case = asked(replace(integrator, lower=(-limit,), upper=(limit,)))
    if fits:
        assert solve(case).status is Status.CONVERGED
    else:
        with pytest.raises(BadInput, match="the bounds of its control are active"):
            solve(case)


def test_a_terminal_cost_must_be_quadratic(tmp_path: Path):
    case = build(tmp_path, scalar("quartic", w, w**2 / 2, q**4, "free"), "[initial]\nq = 1.0\n[time]\ntf = 1.0\n")
    with pytest.raises(BadInput, match="its terminal cost is not quadratic"):
        solve(asked(case))


def test_what_the_control_does_not_reach_is_not_answered(tmp_path: Path):
    """The push does nothing."""
    case = build(tmp_path, moving("coasting", speed), TEXT)
    found = solve(asked(case))
    assert not found.status.answered
    assert "it might be impossible to reach the final state" in found.message
