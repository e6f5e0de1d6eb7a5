"""Schedules and tables of time in a model: their values, derivatives, generated code, typesetting and answers."""

from __future__ import annotations

import math

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import quad
from scipy.interpolate import make_interp_spline

import satsym
from satsym.front.instance import as_case
from satsym.solvers.control.breaks import find_breaks
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of, t
from satsym.symbolic.checks import numeric
from satsym.symbolic.functions.pieces import Until, breaks, in_pieces

STATES = (Variable("x", "x"), Variable("v", "v"))
(x, v), u = symbols_of(STATES), sp.Symbol("u", real=True)
Q = Variable("q", "q", default=1.3, positive=True)
(q,) = symbols_of((Q,))
TIMES, VALUES = [0, 1, 2, 3, 4], [0.5, 1.0, -0.25, 2.0, 1.5]
STATED = [
    sp.Piecewise((1, t < 1), (-2 * t, t < 2), (0, True)),
    sp.Piecewise((1, t >= 2), (t**2, t > sp.Rational(1, 2)), (sp.sin(t), True)),
    sp.Piecewise((2, (t > 1) & (t <= 3)), (t, True)),
    sp.Piecewise((2, (t < 1) | (t > 3)), (t, True)),
    sp.Piecewise((q, t < q), (t**2, 2 * t < 5 * q), (q * t, True)),
    sp.Piecewise((q, (t > q) & (t < 2 * q)), (t, True)),
    sp.Max(0, 1 - t, t - 3),
    sp.Min(t, q, 3 - t),
    sp.Abs(t - q) + sp.sign(t - 2) * sp.Heaviside(t - 1),
    sp.Max(0, sp.sin(3 * t)),
    sp.Piecewise((sp.Abs(t - 2), t < 3), (sp.Max(t, 4), True)),
    sp.interpolating_spline(3, t, TIMES, VALUES),
    sp.interpolating_spline(1, t, TIMES, VALUES),
]


def drifting(force: sp.Expr, cost: sp.Expr = u**2, **fields: object) -> Problem:
    model = FirstOrder(
        name="cart",
        title="C",
        states=STATES,
        controls=(Variable("u", "u"),),
        parameters=(Q,) if force.has(q) else (),
        rates={x: v, v: u + force},
    )
    return Problem(name="drift", title="D", model=model, running_cost=cost, **fields)


@pytest.mark.parametrize("stated", STATED, ids=range(len(STATED)))
def test_values_and_derivatives_are_those_of_what_is_stated(stated: sp.Expr) -> None:
    found = in_pieces(stated, t, ())
    assert found.has(Until)
    assert not found.has(sp.Piecewise, sp.Max, sp.Min, sp.Abs, sp.sign, sp.Heaviside)
    value, slope = numeric([found]), numeric([sp.diff(found, t)])
    known = sp.lambdify((t, q), stated, "mpmath")
    for at in np.linspace(0.013, 3.987, 60):
        point = {t: at, q: 1.3}
        near = [float(known(at + h, 1.3)) for h in (-1e-6, 1e-6)]
        assert float(value(point)[0]) == pytest.approx(float(known(at, 1.3)), abs=1e-13)
        assert float(slope(point)[0]) == pytest.approx((near[1] - near[0]) / 2e-6, abs=1e-5)


@pytest.mark.parametrize("at", [0.0, 1.0, 2.0, 3.0])
def test_an_instant_between_pieces_belongs_to_the_one_that_is_stated_to_have_it(at: float) -> None:
    stated = sp.Piecewise((1 + t, t < 1), (2 + 2 * t, t <= 2), (3 * t, t < 3), (4 * t, True))
    assert float(numeric([in_pieces(stated, t, ())])({t: at})[0]) == stated.subs(t, at)


def test_a_step_at_the_initial_time_is_on() -> None:
    assert numeric([in_pieces(sp.Heaviside(t), t, ()) + t])({t: 0})[0] == 1


def test_what_a_state_enters_is_left_as_it_is() -> None:
    assert in_pieces(sp.Max(t, x), t, {"x"}) == sp.Max(t, x)


def test_the_breaks_are_known() -> None:
    assert breaks([in_pieces(sp.interpolating_spline(3, t, TIMES, VALUES), t, ())], t) == [2.0]
    assert breaks([in_pieces(sp.interpolating_spline(1, t, TIMES, VALUES), t, ())], t) == [1.0, 2.0, 3.0]


@pytest.mark.parametrize("stated", STATED, ids=range(len(STATED)))
def test_generated_functions_have_the_same_values(stated: sp.Expr) -> None:
    kernels = satsym.derive(drifting(stated * (1 + x))).kernels
    known = sp.lambdify((t, q), stated)
    times = np.linspace(0.06, 3.97, 23)
    p = (1.3,) if stated.has(q) else ()
    wanted = [float(known(at, 1.3)) * 1.5 + 0.25 for at in times]
    single = [kernels.dynamics(at, (0.5, 1.0), (0.25,), p)[1] for at in times]
    rows = np.ones((1, 23))
    together = kernels.dynamics_batch(times, np.vstack([0.5 * rows, rows]), 0.25 * rows, p)[1]
    assert single == pytest.approx(wanted, abs=1e-12)  # sympy gives the table 15 digits
    assert together.tolist() == pytest.approx(wanted, abs=1e-12)


def test_a_table_is_typeset_by_cases_in_the_order_of_time() -> None:
    stated = sp.Piecewise((1, t < 1), (-2, t < 2), (0, True))
    text = satsym.derive(drifting(stated * x)).latex()
    assert r"\begin{cases} 1, & t < 1 \\ -2, & 1 \le t < 2 \\ 0, & t \ge 2 \end{cases}" in text


def least(force: sp.Expr, ends: list[float]) -> float:
    """Minimum effort from rest at 0 to rest at 1 in 3, by the Gramian of the double integrator."""
    value = sp.lambdify(t, force)
    pushed = [quad(lambda s, k=k: (3 - s) ** k * value(s), 0, 3, points=ends, epsabs=1e-13)[0] for k in (1, 0)]
    miss = np.array([1.0, 0.0]) - pushed
    return float(miss @ np.linalg.solve([[9.0, 4.5], [4.5, 3.0]], miss))


@pytest.mark.parametrize(
    ("force", "ends"),
    [
        (sp.Piecewise((1, t < 1), (-2, t < 2), (0, True)), [1, 2]),
        (sp.interpolating_spline(3, t, TIMES, VALUES), [2]),
        (sp.Max(0, sp.sin(3 * t)), [math.pi / 3, 2 * math.pi / 3]),
    ],
    ids=["steps", "spline", "half a wave"],
)
def test_a_cart_that_is_pushed_by_a_schedule_is_brought_to_rest_with_least_effort(force, ends) -> None:
    asked = satsym.Instance.of(drifting(force), initial={"x": 0, "v": 0}, final={"x": 1, "v": 0}, tf=3)
    found = satsym.solve(asked)
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(least(force, ends), rel=1e-11)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate.checks


def test_breaks_of_schedules_are_found_to_the_last_digit() -> None:
    """Jumps and corners are breaks, and neither a zero of what is smooth nor one at either end is."""
    jumps, wave = sp.Piecewise((1, t < sp.Rational(1, 3)), (-2, t < 2), (0, True)), sp.Max(0, sp.sin(3 * t))
    wanted = {jumps: [1.0 / 3.0, 2.0], wave: [math.pi / 3, 2 * math.pi / 3], sp.sin(3 * t): [], sp.Abs(t - 3): []}
    for force, times in wanted.items():
        asked = satsym.Instance.of(drifting(force), initial={"x": 0, "v": 0}, final={"x": 1, "v": 0}, tf=3)
        before, after = 3.0 * find_breaks(as_case(asked).case)
        assert before == pytest.approx(times, rel=4e-16)
        assert after == pytest.approx(times, rel=4e-16)


def test_a_spline_is_the_natural_reading_of_its_points() -> None:
    found = numeric([in_pieces(sp.interpolating_spline(3, t, TIMES, VALUES), t, ())])
    known = make_interp_spline(TIMES, VALUES, k=3)
    for at in (-0.5, 0.3, 1.9, 2.0, 2.1, 3.7, 4.5):  # also beyond its ends, where the last piece goes on
        assert float(found({t: at})[0]) == pytest.approx(float(known(at)), abs=1e-12)


def test_controls_switch_beside_a_schedule() -> None:
    steps = sp.Piecewise((sp.Rational(1, 2), t < 1), (0, True))
    found = satsym.derive(drifting(steps * x, cost=sp.Integer(1), control_set="box")).derived
    assert found.equation("control_law.u").rhs.func.__name__ == "Switch"
    slope = found.equation("costate_equations.x").rhs
    for at, wanted in ((0.5, -0.5), (1.5, 0.0)):
        assert numeric([slope])({t: at, sp.Symbol("lambda_v", real=True): 1})[0] == wanted
