"""Controls that are directions: shipped examples against closed forms, and laws that say what they must."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root
from sympy import Expr, Symbol, atan2, cos, sin, sympify

from satsym import instance
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import BadInput, Status, Verdict
from satsym.symbolic import Angle, Ball, DerivationError, FirstOrder, Problem, Variable, derive, symbols_of
from satsym.symbolic.principle import branches, product
from tests.support.derived import derived
from tests.support.models import build

PLACE = tuple(Variable(name, name) for name in ("x", "y", "vx", "vy"))
x, y, vx, vy = symbols_of(PLACE)
beta, ux, uy = symbols_of(Variable(name, name) for name in ("beta", "ux", "uy"))
SIZE = Variable("a", "a", default=1.0, positive=True)
(a,) = symbols_of((SIZE,))


def certified(name: str) -> Solution:
    found = solve(instance.load(name))
    assert found.status is Status.CONVERGED
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate
    return found


@pytest.mark.slow
def test_the_bead_slides_along_a_cycloid():
    """x = a (phi - sin phi), y = 10 - a (1 - cos phi), in the time phi sqrt(a / g)."""
    phi = brentq(lambda p: (p - math.sin(p)) / (1.0 - math.cos(p)) - 2.0, 1.0, 6.0, xtol=1e-15)
    size = 5.0 / (1.0 - math.cos(phi))
    found = certified("brachistochrone")
    assert found.objective == pytest.approx(phi * math.sqrt(size / 9.80665), rel=1e-9)
    turned = found.times * math.sqrt(9.80665 / size)
    assert np.abs(found.x[0] - size * (turned - np.sin(turned))).max() < 1e-7


def test_steering_follows_the_linear_tangent_law():
    """tan beta = tan b - c t with the height given: three conditions on b, c and the time, in closed form."""

    def missed(unknown: np.ndarray) -> list[float]:
        start, end, tf = unknown

        def integral(power: str) -> float:
            nodes, weights = np.polynomial.legendre.leggauss(60)
            t = tf * (nodes + 1.0) / 2.0
            angle = np.arctan(np.tan(start) + (np.tan(end) - np.tan(start)) * t / tf)
            value = {"vx": np.cos(angle), "vy": np.sin(angle), "y": (tf - t) * np.sin(angle)}[power]
            return float(100.0 * tf / 2.0 * weights @ value)

        return [integral("vx") - 45.0, integral("vy"), integral("y") - 5.0]

    expected = root(missed, [0.9, -0.9, 0.55], tol=1e-14).x
    assert expected[2] == pytest.approx(0.5545709, abs=5e-8)
    found = certified("linear-tangent")
    assert found.objective == pytest.approx(expected[2], rel=1e-9)
    assert found.u[0, [0, -1]] == pytest.approx(expected[:2], abs=1e-7)


@pytest.mark.slow
def test_the_ship_turns_as_the_current_asks():
    """Bryson and Ho, (2.7.25): y and x in terms of the headings, here at the start and at the end."""
    found = certified("zermelo")
    first, last = found.u[0, [0, -1]]
    assert (math.degrees(first), math.degrees(last)) == pytest.approx((105.0, 240.0), abs=0.05)

    def place(heading: float) -> tuple[float, float]:
        def sec(angle: float) -> float:
            return 1.0 / math.cos(angle)

        tangent, ratio = math.tan(last), (math.tan(last) + sec(last)) / (math.tan(heading) + sec(heading))
        across = sec(heading) - sec(last)
        along = sec(last) * (tangent - math.tan(heading)) - math.tan(heading) * (sec(last) - sec(heading))
        return -(along + math.log(ratio)) / 2.0, across

    def missed(unknown: np.ndarray) -> list[float]:
        nonlocal first, last
        first, last = unknown
        along, across = place(first)
        return [abs(along) - 3.66, abs(across) - 1.86]

    expected = root(missed, [first, last], tol=1e-13).x
    assert found.objective == pytest.approx(abs(math.tan(expected[1]) - math.tan(expected[0])), rel=1e-8)


def steered(cost: Expr, rates: dict[object, Expr], name: str = "steered", **fields: object) -> Problem:
    model = FirstOrder(
        name=f"{name}_point",
        title="A point",
        states=PLACE,
        controls=(Variable("beta", "beta", kind="angle"),),
        parameters=(SIZE,),
        rates=rates,
    )
    return Problem(
        name=name, title="Steered", model=model, running_cost=cost, **{"control_sets": {"way": Angle("beta")}, **fields}
    )


PUSHED = {x: vx, y: vy, vx: a * cos(beta), vy: a * sin(beta)}


def test_an_angle_may_be_measured_from_anywhere():
    turned = {**PUSHED, vx: a * cos(beta + y), vy: a * sin(beta + y)}
    derivation = derived(steered(sympify(1), turned))
    slope = {name: derivation.equation(f"control_parts.{name}_of_beta").rhs for name in ("cosine", "sine")}
    law = derivation.equation("control_law.beta").rhs
    assert isinstance(law, atan2)
    point = {"y": 0.3, "a": 2.0, "lambda_vx": 0.7, "lambda_vy": -0.4}
    numbers = {s: point[s.name] for e in slope.values() for s in e.free_symbols}
    cosine, sine = (float(e.xreplace(numbers)) for e in slope.values())
    best = math.atan2(-sine, -cosine)
    values = [0.7 * math.cos(b + 0.3) - 0.4 * math.sin(b + 0.3) for b in (best, best + 1e-3, best - 1e-3)]
    assert min(values) == values[0]


@pytest.mark.parametrize(
    ("problem", "complaint"),
    [
        (steered(beta**2, PUSHED), "H does not have the form a cos(beta) + b sin(beta) + c"),
        (steered(cos(beta) ** 2, PUSHED), "H does not have the form a cos(beta) + b sin(beta) + c"),
        (steered(sympify(1), PUSHED, control_sets={"way": Angle("bet")}), "'bet' is not a control; there are beta"),
        (steered(sympify(1), PUSHED, control_sets={"way": Angle()}), 'name one control, as in Angle("beta")'),
        (steered(sympify(1), PUSHED, control_sets={"a": Angle("beta"), "b": Ball("beta")}), "'beta' is in several"),
        (
            steered(sympify(1), PUSHED, control_set="box"),
            "control_set: control_sets already defines each control set; leave it out",
        ),
        (steered(sympify(1), {**PUSHED, vx: a, vy: a}), "beta enters neither the motion nor the cost"),
    ],
)
def test_what_no_angle_minimises_is_refused(problem: Problem, complaint: str):
    with pytest.raises(DerivationError, match=re.escape(complaint)):
        derived(problem)


def test_an_angle_takes_no_bounds(tmp_path: Path):
    with pytest.raises(BadInput, match=r"\[control\] beta: the model takes no bound of the angle beta"):
        build(tmp_path, steered(sympify(1), PUSHED), START + "[control]\nbeta = [0, 1]\n")


START = """
[initial]
x = 0.0
y = 0.0
vx = 0.0
vy = 0.0
[final]
x = 1.0
y = 0.0
[time]
tf = "free"
"""


@pytest.mark.slow
def test_a_straight_run_is_steered_straight(tmp_path: Path):
    """From rest over a distance of one at acceleration one: sqrt(2), along x all the time."""
    found = solve(build(tmp_path, steered(sympify(1), PUSHED), START))
    assert found.objective == pytest.approx(math.sqrt(2.0), rel=1e-10)
    assert np.abs(found.u).max() < 1e-8


def test_the_transfer_takes_as_long_as_by_shooting():
    """Costates by Runge-Kutta from the start, tan beta = lambda_u / lambda_v: the orbit of Mars in minimum time."""

    def rates(t: float, z: np.ndarray) -> list[float]:
        r, u, v, a, b, c = z
        push, size = 0.1405 / (1.0 - 0.07487 * t), math.hypot(b, c)
        return [
            u,
            v * v / r - 1.0 / r**2 - push * b / size,
            -u * v / r - push * c / size,
            b * (v * v / r**2 - 2.0 / r**3) - c * u * v / r**2,
            -a + c * v / r,
            -2.0 * b * v / r + c * u / r,
        ]

    def missed(unknown: np.ndarray) -> np.ndarray:
        end = solve_ivp(
            rates, (0.0, unknown[3]), [1.0, 0.0, 1.0, *unknown[:3]], rtol=1e-12, atol=1e-13, method="DOP853"
        ).y[:, -1]
        growth = 1.0 + float(end[3:] @ rates(unknown[3], end)[:3])
        return np.array([end[0] - 1.525, end[1], end[2] - 1.525**-0.5, growth])

    expected = root(missed, [-5.0, -2.5, -5.5, 3.3], tol=1e-10)
    assert np.abs(missed(expected.x)).max() < 1e-10
    assert certified("transfer-time").objective == pytest.approx(expected.x[3], rel=1e-9)


def test_a_law_that_turns_the_wrong_way_is_refused(monkeypatch: pytest.MonkeyPatch):
    right = product.law_of
    monkeypatch.setattr(product, "law_of", lambda problem, one: [v + 1 for v in right(problem, one)])
    with pytest.raises(DerivationError, match="failed its check 'cheapest of all'"):
        derive(steered(sympify(1), PUSHED, name="turned"))


def test_a_slope_that_is_not_that_of_the_hamiltonian_is_refused(monkeypatch: pytest.MonkeyPatch):
    def wrong(h: Expr, angle: Symbol) -> tuple[Expr, ...] | None:
        found = by_circle(h, angle)
        return found and (found[0], found[1], 2 * found[2])

    by_circle = branches.by_circle
    monkeypatch.setattr(branches, "by_circle", wrong)
    with pytest.raises(DerivationError, match="failed its check 'adds up to H'"):
        derive(steered(sympify(1), PUSHED, name="doubled"))
