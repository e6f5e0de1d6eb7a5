"""A product of boxes is a box: stated either way it is the same problem, with the same law and the same search."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve
from sympy import Abs, Expr, sin, sqrt

import satsym
from satsym.status import Verdict
from satsym.symbolic import Box, FirstOrder, Free, Problem, Variable, symbols_of
from satsym.symbolic.pipeline import derive

STATES = tuple(Variable(name, name) for name in "qv")
q, v = symbols_of(STATES)
CONTROLS = tuple(Variable(name, name) for name in "uw")
u, w = symbols_of(CONTROLS)
WEIGHT = Variable("k", "k", default=1.0)
(k,) = symbols_of((WEIGHT,))
EACH: dict[str, Any] = {"control_sets": {"torque": Box("u"), "push": Box("w")}}
BOX: dict[str, Any] = {"control_set": "box"}


def stated(cost: Expr | int, **kinds: Any) -> Problem:
    moving = FirstOrder(
        name="moving", title="M", states=STATES, controls=CONTROLS, parameters=(WEIGHT,), rates={q: v + w, v: u - q}
    )
    return Problem(name="moved", title="M", model=moving, running_cost=cost, **kinds)


@pytest.mark.parametrize(
    "cost",
    [1, 1 + Abs(u) + Abs(w), u**2 + w**2],
    ids=["switching", "with magnitudes", "quadratic"],
)
def test_boxes_for_each_control_are_one_box(cost: Expr | int):
    each, one = derive(stated(cost, **EACH)), derive(stated(cost, **BOX))
    assert each.problem == one.problem
    assert [step.name for step in each.steps] == [step.name for step in one.steps]
    assert each.step("control_law").equations == one.step("control_law").equations


def test_sets_that_nothing_limits_are_none():
    free = derive(stated(u**2 + w**2 + u * w, control_sets={"torque": Free("u"), "push": Free("w")}))
    assert free.problem == derive(stated(u**2 + w**2 + u * w)).problem


@pytest.mark.parametrize("cost", [k * u**2 + w**2, sqrt(1 + u**2) + w**2], ids=["of either sign", "not quadratic"])
def test_a_set_by_itself_stays_so_where_that_says_more(cost: Expr):
    each = derive(stated(cost, **EACH))
    assert [one.name for one in each.steps if one.name == "control_parts"]
    assert each.problem is not None
    assert set(each.problem.control_sets) == {"torque", "push"}


def test_a_weight_that_a_state_turns_is_derived_in_a_box_too():
    """H is a parabola in u that opens downwards where q is negative: the better end is the minimiser."""
    each, one = (derive(stated(q * u**2 + w**2, **kinds)) for kinds in (EACH, BOX))
    assert "Vertex" in str(one.equation("control_law.u").rhs)
    assert "Vertex" in str(each.equation("control_law.u").rhs)


@pytest.mark.slow
def test_a_pendulum_swings_up_as_soon_whatever_its_torque_is_called():
    torque = (Variable("u", "u"),)
    moving = FirstOrder(
        name="pendulum", title="P", states=STATES, controls=torque, parameters=(), rates={q: v, v: u - sin(q)}
    )
    swing = Problem(name="swing", title="S", model=moving, running_cost=1, control_sets={"torque": Box("u")})
    ends = {"initial": {"q": 0.0, "v": 0.0}, "final": {"q": math.pi, "v": 0.0}}
    found = satsym.solve(satsym.Instance.of(swing, **ends, tf="free", control={"u": (-0.4, 0.4)}))

    def missed(unknown: np.ndarray) -> list[float]:
        """Three switches and the end, from costates (a, b) with H = 1 + a v + b (u - sin q) = 0 at rest."""
        a, *durations = unknown
        z, out = np.array([0.0, 0.0, a, -1.0 / 0.4]), list[float]()
        for push, duration in zip((0.4, -0.4, 0.4, -0.4), durations, strict=True):

            def rates(_: float, z: np.ndarray, push: float = push) -> list[float]:
                return [z[1], push - np.sin(z[0]), z[3] * np.cos(z[0]), -z[2]]

            z = solve_ivp(rates, (0, duration), z, rtol=1e-11, atol=1e-12).y[:, -1]
            out.append(z[3])
        return [*out[:3], z[0] - math.pi, z[1]]

    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    times = [0.0, *found.switching_times["u"], found.objective]
    exact = fsolve(missed, [float(found.lam(0.0)[0]), *np.diff(times)], xtol=1e-12)
    assert np.abs(missed(exact)).max() < 1e-8
    assert found.objective == pytest.approx(sum(exact[1:]), abs=1e-8)
