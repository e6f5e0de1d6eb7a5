"""|u| in the motion: thrusters that burn their fuel, thrust that drags, and heat that comes of any push."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq
from sympy import Abs, Expr, Integer

import satsym
from satsym.report.latex.document import render
from satsym.solution import Solution
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.pipeline import derive
from tests.support.models import build

NAMES = ("x", "v", "m")
x, v, m = symbols_of(tuple(Variable(name, name, positive=name == "m") for name in NAMES))
u, c = symbols_of((Variable("u", "u"), Variable("c", "c")))
FLOW, LASTING = 0.4, 3.0


def problem(name: str, rates: dict[Expr, Expr], cost: Expr, end: Expr = Integer(0), **more: object) -> Problem:
    states = tuple(Variable(s, s, positive=s == "m") for s in NAMES[: len(rates)])
    parameters = (Variable("c", "c", default=FLOW),)
    moving = FirstOrder(
        name="body", title="B", states=states, controls=(Variable("u", "u"),), parameters=parameters, rates=rates
    )
    stated = {"control_set": "box"} | more
    return Problem(name=name, title="B", model=moving, running_cost=cost, terminal_cost=end, **stated)


BURNING = {x: v, v: u / m, m: -c * Abs(u)}
LEAST_FUEL = problem("least_fuel", BURNING, Integer(0), m, maximise=True)
SOONEST = problem("soonest", BURNING, Integer(1))
DRAGGED = {x: v, v: u - c * Abs(u)}


def solved(one: Problem, final: dict[str, float], tf: float | str, bounds: tuple[float, float] = (-1, 1)) -> Solution:
    initial = {s.symbol: 1.0 if s.symbol == "m" else 0.0 for s in one.model.states}
    case = satsym.Instance.of(one, initial=initial, final=final, tf=tf, control={"u": bounds})
    found = satsym.solve(case)
    assert found.status is Status.CONVERGED, found.message
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate
    return found


def gone(time: float, mass: float) -> tuple[float, float]:
    """Speed and way that full thrust from rest gives a body of this mass, by the rocket equation."""
    left = 1.0 - FLOW * time / mass
    return -math.log(left) / FLOW, mass * (left * math.log(left) + 1.0 - left) / FLOW**2


def braking(time: float) -> tuple[float, float, float]:
    """After a first thrust: for how long thrust brings the body to rest, and the way during both."""
    mass = 1.0 - FLOW * time
    speed, way = gone(time, 1.0)
    lasting = mass * (1.0 - math.exp(-FLOW * speed)) / FLOW
    return lasting, way, speed * lasting - gone(lasting, mass)[1]


@pytest.mark.slow
def test_fuel_that_is_burnt_lightens_the_body():
    """Thrust, coast, thrust: by the rocket equation, without costates."""

    def missing(time: float) -> float:
        lasting, *ways = braking(time)
        return sum(ways) + gone(time, 1.0)[0] * (LASTING - time - lasting) - 1.0

    first = brentq(missing, 0.1, 0.8, xtol=1e-15)
    last = braking(first)[0]
    found = solved(LEAST_FUEL, {"x": 1.0, "v": 0.0}, LASTING)
    assert found.switching_times["u"] == pytest.approx((first, LASTING - last), rel=1e-9)
    assert found.objective == pytest.approx(1.0 - FLOW * (first + last), rel=1e-10)


@pytest.mark.slow
def test_fuel_that_weighs_is_better_burnt_than_carried():
    """In least time the weight of |u| is negative: a law that knows only thresholds would rest, or thrust both ways."""
    first = brentq(lambda time: sum(braking(time)[1:]) - 1.0, 0.1, 2.0, xtol=1e-15)
    found = solved(SOONEST, {"x": 1.0, "v": 0.0}, "free")
    model, p = found.instance.case.model, found.instance.case.parameters
    weights = model.magnitude_weight_batch(found.times, found.x[:], found.lam[:], p)
    assert weights[0, : len(found.times) // 2].max() < 0.0
    assert found.switching_times["u"] == pytest.approx((first,), rel=1e-9)
    assert found.objective == pytest.approx(first + braking(first)[0], rel=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("bounds", [(-1.0, 1.0), (-0.5, 2.0)])
@pytest.mark.parametrize(("cost", "tf"), [(Integer(1), "free"), (Abs(u), LASTING)], ids=["time", "fuel"])
def test_thrust_that_drags_is_worth_less_forwards(cost: Expr, tf: float | str, bounds: tuple[float, float]):
    """Two constant accelerations, a coast between them where fuel is what counts."""
    name = f"dragged_{'time' if tf == 'free' else 'fuel'}"
    low, high = bounds
    ahead, back = high * (1.0 - FLOW), -low * (1.0 + FLOW)
    share = ahead / back
    if tf == "free":
        first = math.sqrt(2.0 / (ahead * (1.0 + share)))
        expected, switches = first * (1.0 + share), (first,)
    else:  # ahead * first * (LASTING - first * (1 + share) / 2) = 1
        half = ahead * (1.0 + share) / 2.0
        first = (ahead * LASTING - math.sqrt((ahead * LASTING) ** 2 - 4.0 * half)) / (2.0 * half)
        expected, switches = first * (high - low * share), (first, LASTING - first * share)
    found = solved(problem(name, DRAGGED, cost), {"x": 1.0, "v": 0.0}, tf, bounds)
    assert found.objective == pytest.approx(expected, rel=1e-10)
    assert found.switching_times["u"] == pytest.approx(switches, rel=1e-9)


@pytest.mark.slow
def test_heat_that_any_push_makes_takes_its_time():
    """A given sum of |u|, half of it to speed up and half to brake: the coast between makes up the way."""
    heated = problem("heated", {x: v, v: u, m: c * Abs(u)}, Integer(1))
    found = solved(heated, {"x": 1.0, "v": 0.0, "m": 1.0 + 1.5 * FLOW}, "free")
    assert found.objective == pytest.approx(0.75 + 1.0 / 0.75, rel=1e-10)


@pytest.mark.slow
def test_of_many_ways_to_make_heat_none_is_certified():
    """Any control that is at a bound all the time makes the most heat: the best control is not determined."""
    most = problem("most_heat", {x: v, v: u, m: c * Abs(u)}, Integer(0), m, maximise=True)
    case = satsym.Instance.of(most, initial={x: 0, v: 0, m: 1}, final={x: 1, v: 0}, tf=3.0, control={u: [-1, 1]})
    found = satsym.solve(case)
    assert found.certificate is None or found.certificate.verdict is not Verdict.CERTIFIED


@pytest.mark.parametrize("bounds", [(-1.0, 1.0), (-0.4, 1.5), (-2.0, 0.3), (0.2, 1.0), (-1.5, -0.3), (0.0, 1.0)])
def test_no_admissible_control_is_better_whatever_the_sign_of_the_weight(tmp_path: Path, bounds: tuple[float, float]):
    text = f"[initial]\nx = 0\nv = 0\nm = 1\n[time]\ntf = 1.0\n[control]\nu = [{bounds[0]}, {bounds[1]}]\n"
    case, rng, count = build(tmp_path, SOONEST, text), np.random.default_rng(2), 400
    model, p = case.model, case.parameters
    state = rng.normal(size=(2, 1, count)), rng.uniform(0.2, 3.0, (1, count))
    at, lam, t = np.concatenate([*state[0], state[1]]), rng.normal(size=(3, count)), np.zeros(count)
    signs = np.sign(model.magnitude_weight_batch(t, at, lam, p))
    assert {-1.0, 1.0} == set(signs.ravel())

    def value(control: np.ndarray) -> np.ndarray:
        return model.hamiltonian_batch(t, at, control, lam, p)

    law = model.control_law_batch(t, at, lam, p, case.control_set.arguments)
    assert case.control_set.violation(law) <= 0.0
    others = [value(np.full((1, count), one)) for one in np.linspace(*bounds, 101)]
    assert (value(law) <= np.min(others, axis=0) + 1e-12).all()


@pytest.mark.parametrize(("side", "value"), [("minimum", r"\sigma z"), ("maximum", r"-\sigma z")])
def test_the_law_is_typeset_as_a_comparison_of_three_values(side: str, value: str):
    """No letter stands for two things: the velocity is v here, so that the control that is compared is not."""
    text = render(derive(problem("fuel", BURNING, Integer(0), -m, convention=side)))
    among = r"z \in \{u^{\min},\, \max\{u^{\min},\, \min\{u^{\max},\, 0\}\},\, u^{\max}\}"
    assert rf"{{{among}}} ({value} + w |z|)" in text
    assert f"the one with the {'smallest' if side == 'minimum' else 'largest'} $H$ is taken" in text


@pytest.mark.parametrize(
    ("cost", "more", "message"),
    [
        (u**2, {}, "only if the cost and the motion are linear in the controls"),
        (Integer(1), {"control_set": "free"}, 'this requires control_set = "box"'),
        (Integer(1), {"path_constraints": {"slow": v - 1}}, "not supported together with .u."),
    ],
)
def test_what_has_no_law_is_refused(cost: Expr, more: dict[str, object], message: str):
    with pytest.raises(DerivationError, match=message):
        derive(problem("refused", DRAGGED, cost, **more))
