"""Random motions as starts of the search: they obey their equations, keep within bounds, and come close to the end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import sympy
from scipy.integrate import solve_ivp

import satsym
from satsym import instance as instances
from satsym.instance import Instance
from satsym.solvers.search.controls import controls_of
from satsym.solvers.search.durations import first_duration
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import sizes_of
from satsym.solvers.search.starts import planning, sampling
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of, t

SHIPPED = (
    "linear-tangent",
    "transfer-fuel",
    "reorientation",
    "ends-3-given-time",
    "double-integrator-fuel",
    "catalyst",
)


def sampled(case: Instance, group: int = 1) -> tuple[Programme, list[sampling.Sample]]:
    controls = controls_of(case)
    assert controls is not None
    duration = first_duration(case, controls)
    programme = Programme(case, controls, [np.linspace(0.0, 1.0, 41)], sizes_of(case, controls, duration))
    return programme, sampling.sampled(programme, group)


@pytest.mark.parametrize("name", SHIPPED)
def test_they_obey_the_equations_of_motion(name: str) -> None:
    case = instances.load(name)
    programme, found = sampled(case)
    assert len(found) > 1
    for one in found:
        u = programme.controls.controls(one.v)

        def rates(t: float, x: np.ndarray, times: np.ndarray = one.times, u: np.ndarray = u) -> np.ndarray:
            at = np.array([np.interp(t, times, row) for row in u])
            return np.ravel(case.model.dynamics_batch(np.array([t]), x[:, None], at[:, None], case.parameters))

        run = solve_ivp(rates, one.times[[0, -1]], case.initial, rtol=1e-9, atol=1e-12, max_step=np.diff(one.times)[0])
        size = np.ptp(one.x, axis=1) + 1e-9
        np.testing.assert_allclose(one.x[:, -1] / size, run.y[:, -1] / size, atol=1e-3)


@pytest.mark.parametrize("name", SHIPPED)
def test_their_controls_are_admissible_and_their_durations_are_as_asked(name: str) -> None:
    case = instances.load(name)
    programme, found = sampled(case)
    assert found
    for one in found:
        u = programme.controls.controls(one.v)
        np.testing.assert_allclose(case.control_set.project(u), u, atol=1e-12)
        lasting = one.times[-1] - one.times[0]
        if case.tf is not None:
            assert lasting == pytest.approx(case.tf - case.t0)
        else:
            assert sampling.SHORTEST_SAMPLE <= lasting / programme.sizes.duration <= sampling.LONGEST_SAMPLE


def test_the_closest_come_first_and_no_two_are_alike() -> None:
    """With one final condition the distance from it needs no weights."""
    case = instances.load("transfer-fuel")
    name = case.model.spec.state_names[0]
    _, found = sampled(replace(case, final={name: case.final[name]}))
    missed = [abs(one.x[0, -1] - float(case.final[name])) for one in found]
    assert missed == sorted(missed)
    for k, one in enumerate(found):
        assert all(np.abs(one.x - other.x).max() > 0.0 for other in found[:k])


def test_a_start_from_one_is_the_motion_itself() -> None:
    programme, found = sampled(instances.load("reorientation"))
    x, v, durations, _, start = programme.unpacked(sampling.begun_from(programme, found[0]))
    times = programme.times(durations, start)
    assert times[[0, -1]] == pytest.approx(found[0].times[[0, -1]])
    for rows, known, at in ((x, found[0].x, times), (v, found[0].v, times[1:])):
        for row, own in zip(rows, known, strict=True):
            np.testing.assert_allclose(row, np.interp(at, found[0].times, own), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(("name", "any_"), [("linear-tangent", True), ("catalyst", True), ("inspection", False)])
def test_they_are_tried_where_nothing_is_asked_on_the_way(name: str, any_: bool) -> None:
    case = instances.load(name)
    controls = controls_of(case)
    assert controls is not None
    plans = planning.plans(case, controls, first_duration(case, controls))
    assert any(plan.sampled for plan in plans) is any_


@pytest.mark.slow
def test_from_a_free_end_the_cheapest_of_several_wells_is_found() -> None:
    """Waves on straight lines lead to motions that cost 0.158 and -0.109. The value is that of a direct method."""
    states = (Variable("x", "x", "1"), Variable("v", "v", "1"))
    controls = (Variable("u", "u", "1"),)
    x, v = symbols_of(states)
    (u,) = symbols_of(controls)
    rates = {x: v, v: u + x - x**3 + 0.0839 * sympy.cos(t)}
    model = FirstOrder(name="duffing", title="D", states=states, controls=controls, parameters=(), rates=rates)
    wells = 1.4216 * ((x**2 - 1) ** 2 - x / 9)
    problem = Problem(name="wells", title="W", model=model, running_cost=u**2 / 2, terminal_cost=wells)
    found = satsym.solve(satsym.Instance.of(problem, initial={"x": 0.4379, "v": 0.3009}, tf=7.2568))
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    assert found.objective == pytest.approx(-0.15394299405, rel=1e-9)
