"""Path constraints where H is linear in a control: boundary arcs between bounds, from a cold start, in closed form."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.optimize import brentq

import satsym
from satsym.front.solution import Solution
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.certificate.second_variation import units
from satsym.solvers.certificate.switching.integration import Integration
from satsym.solvers.certificate.switching.replay import replay
from satsym.solvers.certificate.switching.second_variation import form_of
from satsym.solvers.iteration import Limits
from satsym.status import BadInput, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, derive, symbols_of
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.model import t
from satsym.symbolic.principle.path import path_constraints as steps
from tests.support.derived import derived

STATES, CONTROLS = tuple(Variable(name, name) for name in ("x", "v", "a")), (Variable("u", "u"),)
PARAMETERS = tuple(Variable(name, name, default=1.0) for name in ("v_top", "a_top"))
(x, v, a), (u,), (v_top, a_top) = symbols_of(STATES), symbols_of(CONTROLS), symbols_of(PARAMETERS)


def line(rates: dict[sp.Symbol, Any], **more: Any) -> Problem:
    """The least time of a motion along a line, by default."""
    model = FirstOrder(
        name="line", title="", states=STATES[: len(rates)], controls=CONTROLS, parameters=PARAMETERS, rates=rates
    )
    stated = {"name": "line", "title": "", "running_cost": 1, "control_set": "box"} | more
    return Problem(model=model, **stated)


CAR = line({x: v, v: u}, path_constraints={"limit": v - v_top})
LIFT = line({x: v, v: a, a: u}, path_constraints={"push": a - a_top, "brake": -a - a_top})
ACROSS = {"final": {"x": 3.0, "v": 0.0}, "initial": {"x": 0.0, "v": 0.0}, "tf": "free", "control": {"u": [-1.0, 1.0]}}


def solved(of: Problem, **given: Any) -> Solution:
    found = satsym.solve(satsym.Instance.of(of, **given))
    assert found.status == "converged", found.message
    assert all(one.passed for one in found.certificate.checks if one.name.startswith("path constraint"))
    return found


@pytest.mark.slow
@pytest.mark.parametrize(("top", "braking"), [(0.3, 1.0), (1.0, 1.0), (1.2, 2.0), (0.5, 0.25)])
def test_a_car_goes_as_fast_as_it_may_and_brakes(top: float, braking: float):
    found = solved(CAR, **(ACROSS | {"control": {"u": [-braking, 1.0]}, "parameters": {"v_top": top}}))
    begins, slowing = top, top / braking
    cruise = (3.0 - top * (begins + slowing) / 2.0) / top
    assert found.objective == pytest.approx(begins + cruise + slowing, rel=1e-12)
    assert found.certificate.verdict == "certified"
    assert [(one.kind, one.name) for one in found.events] == [("entry", "limit"), ("exit", "limit")]
    assert [one.t for one in found.events] == pytest.approx([begins, begins + cruise], rel=1e-10)


@pytest.mark.slow
def test_a_limit_that_is_never_met_changes_nothing():
    found = solved(CAR, **(ACROSS | {"parameters": {"v_top": 2.0}}))
    assert found.objective == pytest.approx(2.0 * np.sqrt(3.0), rel=1e-12)
    assert "no path constraint is ever active" in found.message
    assert found.certificate.verdict == "certified"


@pytest.mark.slow
@pytest.mark.parametrize(("top", "distance"), [(1.0, 10.0), (0.7, 4.0)])
def test_a_lift_keeps_to_the_acceleration_that_its_passengers_bear(top: float, distance: float):
    """Jerk one: up to the acceleration and down again twice, the second half mirrored."""
    rest = {"x": 0.0, "v": 0.0, "a": 0.0}
    given = ACROSS | {"initial": rest, "final": rest | {"x": distance}, "parameters": {"a_top": top}}
    found = solved(LIFT, **given)
    fastest = (-(top**2) + np.sqrt(top**4 + 4.0 * top * distance)) / 2.0
    assert found.objective == pytest.approx(2.0 * (fastest / top + top), rel=1e-11)
    assert [one.name for one in found.events] == ["push", "push", "brake", "brake"]


@pytest.mark.slow
@pytest.mark.parametrize(("fast", "hard", "distance"), [(1.0, 1.0, 10.0), (1.5, 0.8, 6.0), (0.7, 2.0, 4.0)])
def test_limits_of_speed_and_acceleration_make_an_s_curve(fast: float, hard: float, distance: float):
    """Rest to rest with jerk one (order two: costates jump): up to the speed, along it, and down again."""
    curve = replace(LIFT, path_constraints={**LIFT.path_constraints, "limit": v - v_top})
    rest = {"x": 0.0, "v": 0.0, "a": 0.0}
    given = {"initial": rest, "final": rest | {"x": distance}, "parameters": {"v_top": fast, "a_top": hard}}
    found = solved(curve, **(ACROSS | given))
    speeding = fast / hard + hard if fast >= hard**2 else 2.0 * np.sqrt(fast)
    assert found.objective == pytest.approx(distance / fast + speeding, rel=1e-11)
    failed = [one.name for one in found.certificate.checks if not one.passed]
    assert failed == ["not resolved: second variation where costates jump"]


@pytest.mark.slow
def test_a_limit_may_rise_while_it_is_kept():
    """To v = 1 + t / 10 with the control one, along that, and with minus one to rest."""
    found = solved(line({x: v, v: u}, path_constraints={"limit": v - v_top - t / 10}), **ACROSS)

    def distance(brake: float) -> float:
        met, top = 1.0 / 0.9, 1.0 + brake / 10.0
        return met**2 / 2.0 + (brake - met) * (1.0 + (brake + met) / 20.0) + top**2 / 2.0

    brake = brentq(lambda time: distance(time) - 3.0, 1.2, 3.0, xtol=1e-15)
    assert found.objective == pytest.approx(brake + 1.0 + brake / 10.0, rel=1e-12)
    assert found.certificate.verdict == "certified"


@pytest.mark.slow
@pytest.mark.parametrize("start", [0.7, -0.3])
def test_a_motion_may_end_and_begin_on_a_boundary(start: float):
    given = ACROSS | {"initial": {"x": 0.0, "v": start}, "final": {"x": 3.0, "v": 0.7}, "parameters": {"v_top": 0.7}}
    found = solved(CAR, **given)
    speeding = 0.7 - start
    assert found.objective == pytest.approx(speeding + (3.0 - (0.7 + start) / 2.0 * speeding) / 0.7, rel=1e-12)


@pytest.mark.slow
def test_an_arc_too_brief_to_be_seen_leads_to_the_boundary():
    """A start next to a boundary is not on it: no arc there begins with the motion."""
    box, start = {"u": [-1.0, 1.0]}, {"x": 0.0, "v": 0.65}
    found = solved(
        CAR,
        **(ACROSS | {"initial": start, "final": {"x": 20.0, "v": 0.0}, "control": box, "parameters": {"v_top": 0.7}}),
    )
    away = 0.05 * (0.65 + 0.7) / 2.0 + 0.7**2 / 2.0
    assert found.objective == pytest.approx(0.05 + (20.0 - away) / 0.7 + 0.7, rel=1e-12)
    assert found.events[0].t == pytest.approx(0.05, rel=1e-9)


@pytest.mark.slow
def test_an_arc_beside_its_boundary_fails_the_certificate():
    """At a higher limit the same motion keeps to none."""
    found = solved(CAR, **ACROSS).found
    higher = replace(found, instance=replace(found.instance, parameters=(1.1, 1.0)))
    checks = {one.name: one.passed for one in certify(higher).checks}
    assert not checks["off the boundary on its arcs"]
    assert certify(higher).verdict is Verdict.FAILED


@pytest.mark.slow
def test_the_second_variation_is_that_of_the_top_where_all_else_is_given():
    """Below a pressure of 8 no arc is singular: entry and fuel fix all times but the last, at which h'' = -1/h^2."""
    case = satsym.load("goddard-pressure").with_(parameters={"q_max": 5.0})
    found = satsym.solve(case)
    assert found.certificate.verdict == "certified"
    answer = found.found
    by = Integration(np.concatenate(typical(answer)), Limits(10**6, math.inf))
    second = form_of(answer, replay(answer), by, 20)
    (direction,), lasting = second.reduced()[1].T, float(np.ptp(answer.times))
    unit = units(answer, typical(answer)[0])[1] / (lasting * direction.sum()) ** 2
    assert 2.0 * unit * (direction @ second.form @ direction) == pytest.approx(1.0 / answer.x[0, -1] ** 2, rel=1e-6)


def test_the_multiplier_keeps_the_switching_function_zero():
    found = derived(CAR)
    lam = sp.Symbol("lambda_x", real=True)
    multiplier = {e.name: e.rhs for e in found.step("constraint_multiplier").equations}
    assert multiplier == {"limit_vanishing": sp.Symbol("lambda_v", real=True), "limit_eta": -lam}
    assert found.equation("boundary_control.limit_u").rhs == 0


@pytest.mark.parametrize("convention", ["minimum", "maximum"])
def test_costates_on_the_boundary_are_right_by_either_convention(convention: Any):
    drag = line({x: v, v: u - v**2}, path_constraints={"limit": v * x - v_top}, convention=convention)
    found = derived(drag)
    eta, side = sp.Symbol("eta_limit", real=True), 1 if convention == "minimum" else -1
    pushed = {e.name: e.rhs for e in found.step("constrained_costates").equations}["limit_lambda_x"]
    assert sp.simplify(pushed + side * eta * v) == 0


@pytest.mark.parametrize("wrong", ["sign", "rate"])
def test_a_wrong_multiplier_fails_its_check(wrong: str, monkeypatch: pytest.MonkeyPatch):
    if wrong == "sign":
        true = steps.canonical
        monkeypatch.setattr(steps, "canonical", lambda *of: {z: -rate for z, rate in true(*of).items()})
    else:
        true_rate = steps.total_derivative
        monkeypatch.setattr(steps, "total_derivative", lambda e, rates: true_rate(e, rates) + v)
    with pytest.raises(DerivationError, match="failed its check"):
        derive(CAR)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"path_constraints": {"mixed": u + v - 1}}, "mixed: H is linear in the controls, so a constraint"),
        (
            {"path_constraints": {"limit": v - 1}, "running_cost": sp.Abs(u)},
            "not supported together with .u.",
        ),
    ],
)
def test_what_cannot_be_derived_is_refused(more: dict[str, Any], message: str):
    with pytest.raises(DerivationError, match=message):
        derive(line({x: v, v: u}, **more))


def test_two_controls_that_move_a_constraint_together_are_refused():
    controls = (Variable("u", "u"), Variable("w", "w"))
    other = symbols_of(controls)[1]
    model = FirstOrder(
        name="pair", title="", states=STATES[:2], controls=controls, parameters=(), rates={x: v, v: u + other}
    )
    pair = Problem(
        name="pair", title="", model=model, running_cost=1, control_set="box", path_constraints={"limit": v - 1}
    )
    with pytest.raises(DerivationError, match="u, w act on it together"):
        derive(pair)


def test_a_start_beyond_the_limit_is_refused():
    with pytest.raises(
        BadInput, match=r"initial: path constraint limit has the value 0\.5 at that point, but must not be"
    ):
        satsym.solve(satsym.Instance.of(CAR, **(ACROSS | {"initial": {"x": 0.0, "v": 1.5}})))


@pytest.mark.slow
def test_a_certificate_sees_a_limit_that_is_broken_and_a_boundary_that_pulls():
    """The answer of one limit held against a lower one, and against one whose motion would rather be faster still."""
    found = solved(CAR, **ACROSS).found
    model = found.instance
    lower = replace(found, instance=replace(model, parameters=(0.9, 1.0)))
    checks = {one.name: one.passed for one in certify(lower).checks}
    assert not checks["path constraint violated"]
    pulled = replace(found, lam=-found.lam)
    assert certify(pulled).verdict is Verdict.FAILED
