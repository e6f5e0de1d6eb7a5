"""The switching curve of least time: derived, and generated as functions of the state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from hypothesis import assume, given

from derivations.double_integrator import double_integrator_fuel
from derivations.pitch_wheel import pitch_minimum_time
from satsym.symbolic import Problem, Variable, derive, symbols_of
from satsym.symbolic.switching import curve as step
from satsym.symbolic.switching.curve import arrives, between_rests, extremal
from satsym.symbolic.switching.notation import ON_CURVE, SIDE
from tests.support.body_on_a_line import BOUNDS, SPEED, case, generated, least
from tests.support.switching_models import CHAIN, MINIMUM_TIME, derived, switching, u1, x1, x2

GAIN = Variable("c", "c", default=1.0)
(c,) = symbols_of((GAIN,))

# what is derived


def test_the_curve_is_the_known_parabola_for_symmetric_bounds_and_rest() -> None:
    found = derived(MINIMUM_TIME)
    low, high, target = *sp.symbols("u1_min u1_max", real=True), sp.Symbol("target_x2", real=True)
    special = {low: -1, high: 1, target: 0, sp.Symbol("target_x1", real=True): 0}
    on_curve = found.equation("switching_curve.curve").rhs.xreplace(special)
    assert sp.simplify(on_curve + x2 * sp.Abs(x2) / 2) == 0
    duration = found.equation("rest_to_rest.duration").rhs.xreplace(special)
    assert sp.simplify(duration - 2 * sp.sqrt(sp.Abs(x1))) == 0
    assert found.equation("switching_feedback.beyond").rhs == x1 - ON_CURVE


def test_the_pulses_of_the_pitch_axis_last_as_the_paper_has_them() -> None:
    found, theta, inertia = derive(pitch_minimum_time), sp.Symbol("theta", real=True), sp.Symbol("I_y", positive=True)
    limit = sp.Symbol("T", positive=True)
    special = dict(zip(sp.symbols("wheel_torque_min wheel_torque_max", real=True), (-limit, limit), strict=True))
    duration = found.equation("rest_to_rest.duration").rhs.xreplace(special)
    error = sp.Abs(theta - sp.Symbol("target_theta", real=True))
    assert sp.simplify(duration**2 - 4 * error * inertia / limit) == 0


def test_both_conventions_have_the_same_curve_and_law() -> None:
    one, other = (derived(MINIMUM_TIME, convention) for convention in ("minimum", "maximum"))
    for name in (step.CURVE, step.FEEDBACK, step.RESTS):
        assert one.step(name).equations == other.step(name).equations


def test_a_control_that_pushes_the_other_way_swaps_the_bounds() -> None:
    pushes, pulls = derived(MINIMUM_TIME), derive(switching({x1: x2, x2: -u1}, 1))
    laws = [found.equation("switching_feedback.u1").rhs for found in (pushes, pulls)]
    assert [law.args[0] for law in laws] == [SIDE, SIDE]
    assert laws[0].args[2:] == laws[1].args[:1:-1]


@pytest.mark.parametrize(
    "problem",
    [
        double_integrator_fuel,
        switching({x1: x2, x2: u1 - x2}, 1),
        switching({x1: x2 + x1**2, x2: u1}, 1),
        switching(CHAIN, x1**2),
        switching(CHAIN, 1, terminal_cost=x1**2),
        switching(CHAIN, 1, terminal_constraints=(x1 - 1,)),
        replace(MINIMUM_TIME, model=replace(MINIMUM_TIME.model, parameters=(GAIN,), rates={x1: x2, x2: u1 * c})),
    ],
    ids=["fuel", "drag", "nonlinear", "cost of states", "terminal cost", "terminal constraint", "sign not known"],
)
def test_other_problems_have_no_such_step(problem: Problem) -> None:
    assert "switching_curve" not in derive(problem)


def test_the_checks_catch_a_wrong_curve_law_and_duration() -> None:
    found = derived(MINIMUM_TIME)
    chain = step.chain_of(found)
    assert chain is not None
    steps = (step.CURVE, step.FEEDBACK, step.RESTS)
    stated = {e.name: e.rhs for name in steps for e in found.step(name).equations}
    q_f, curve = chain.target[0], stated["curve"] - chain.target[0]
    law = stated["u1"].xreplace({SIDE: stated["side"]})
    reversed_law, beyond = stated["u1"].xreplace({SIDE: -stated["side"]}), x1 - q_f - curve
    assert arrives(found, chain, curve, law).passed
    assert not arrives(found, chain, 2 * curve, law).passed
    assert not arrives(found, chain, curve, reversed_law).passed
    assert not extremal(found, chain, beyond - curve, law).passed
    duration, first = stated["duration"], stated["first"]
    assert not between_rests(found, chain, law, 2 * duration, first).passed
    assert not between_rests(found, chain, reversed_law, duration, first).passed


# what is generated


@given(q=SPEED, v=SPEED, q_f=SPEED, v_f=SPEED, bounds=BOUNDS)
def test_the_generated_law_is_that_of_least_time(
    q: float, v: float, q_f: float, v_f: float, bounds: tuple[float, float]
) -> None:
    of = case((q, v), (q_f, v_f), bounds)
    assume(abs(generated("beyond_switching_curve", (q, v), of)) > 1e-6)
    assert generated("feedback_law", (q, v), of)[0] == least((q, v), (q_f, v_f), bounds)[1]


@given(v=SPEED, q_f=SPEED, v_f=SPEED, bounds=BOUNDS)
def test_on_the_curve_one_arc_arrives(v: float, q_f: float, v_f: float, bounds: tuple[float, float]) -> None:
    assume(abs(v - v_f) > 1e-3)
    of = case((0.0, v), (q_f, v_f), bounds)
    q = -generated("beyond_switching_curve", (0.0, v), of)
    u = bounds[1] if v < v_f else bounds[0]
    time = (v_f - v) / u
    assert q + v * time + u * time**2 / 2 == pytest.approx(q_f, abs=1e-9)


def test_the_batch_form_agrees_on_both_sides() -> None:
    rng, of = np.random.default_rng(7), case(bounds=(-0.5, 2.0))
    x = rng.uniform(-2.0, 2.0, (2, 200))
    final = (1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    batch = of.model.feedback_law_batch(0.0, x, (), of.control_set.arguments, final)[0]
    single = [generated("feedback_law", tuple(column), of)[0] for column in x.T]
    assert batch.tolist() == single
    assert {*single} == {-0.5, 2.0}
