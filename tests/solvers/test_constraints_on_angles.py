"""Path constraints where H is not quadratic in the controls: optima are those of closed forms."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest
import sympy as sp
from scipy.integrate import quad
from scipy.optimize import brentq, root

import satsym
from satsym import instance
from satsym.front.solution import Solution
from satsym.solvers import solve
from satsym.status import BadInput, Status, Verdict
from satsym.symbolic import Angle, Box, FirstOrder, Problem, Variable, symbols_of
from satsym.symbolic.model import t

STATES, COURSE = (Variable("x", "x"), Variable("y", "y")), (Variable("beta", r"\beta", kind="angle"),)
PARAMETERS = (Variable("w", "w", default=2.0, positive=True), Variable("c", "c", default=0.2, positive=True))
(x, y), (beta,), (w, c) = symbols_of(STATES), symbols_of(COURSE), symbols_of(PARAMETERS)
u = sp.Symbol("u", real=True)


def boat(name: str, control_set: Any = None, **constraints: Any) -> Problem:
    """Along a bank at y = 0, from which the current grows."""
    rates = {x: w * y + sp.cos(beta), y: sp.sin(beta)}
    model = FirstOrder(name="boat", title="a boat", states=STATES, controls=COURSE, parameters=PARAMETERS, rates=rates)
    sets = {"course": control_set or Angle("beta")}
    return Problem(name=name, title=name, model=model, running_cost=1, control_sets=sets, path_constraints=constraints)


def moved(name: str, cost: Any, second: bool = False, **constraints: Any) -> Problem:
    """A body whose velocity, or whose acceleration, is the control."""
    states, controls = STATES if second else STATES[:1], (Variable("u", "u"),)
    rates = {x: y, y: u} if second else {x: u}
    model = FirstOrder(
        name="body", title="a body", states=states, controls=controls, parameters=PARAMETERS, rates=rates
    )
    return Problem(name=name, title=name, model=model, running_cost=cost, path_constraints=constraints)


def certified(of: Problem, but: tuple[str, ...] = (), **given: Any) -> Solution:
    """With all checks passed but these."""
    found = satsym.solve(satsym.Instance.of(of, **given))
    said = found.to_dict()
    assert said["status"] == "converged", said["message"]
    assert tuple(one["name"] for one in said["certificate"]["checks"] if not one["passed"]) == but
    assert said["certificate"]["verdict"] == ("extremal only" if but else "certified")
    return found


def kinds(found: Solution) -> list[tuple[str, str]]:
    return [(one.kind, one.name) for one in found.events]


def channel(current: float, width: float, length: float) -> tuple[float, bool]:
    """How long a boat takes to a place on its own bank, and whether it comes to the other one.

    The tangent of its course falls by w a unit of time, and w y + 1 / cos is the same all along.
    """

    def across(slope: float) -> float:
        """The way in the time in which the course turns to that of the bank."""
        return (slope * math.sqrt(1 + slope**2) + math.asinh(slope)) / (2 * current)

    steepest = math.sqrt((1 + current * width) ** 2 - 1)
    if 2 * across(steepest) < length:
        return 2 * steepest / current + (length - 2 * across(steepest)) / (1 + current * width), True
    return 2 * brentq(lambda slope: 2 * across(slope) - length, 0.0, steepest) / current, False


@pytest.mark.slow
@pytest.mark.parametrize("kind", [Angle("beta"), Box("beta")])
@pytest.mark.parametrize(("current", "width", "length"), [(2.0, 0.2, 2.0), (0.5, 1.0, 6.0)])
def test_a_boat_in_a_channel_goes_along_its_far_bank(kind: Any, current: float, width: float, length: float):
    """Which is also what bounds of the course do not change that are never met."""
    slope, (lasting, _) = math.sqrt((1 + current * width) ** 2 - 1), channel(current, width, length)
    found = certified(
        boat("channel", kind, bank=y - c),
        parameters={"w": current, "c": width},
        initial={"x": 0.0, "y": 0.0},
        final={"x": length, "y": 0.0},
        tf="free",
        **({"control": {"beta": [-1.5, 1.5]}} if kind.kind == "box" else {}),
    )
    assert found.objective == pytest.approx(lasting, rel=1e-10)
    assert kinds(found) == [("entry", "bank"), ("exit", "bank")]
    assert [one.t for one in found.events] == pytest.approx([slope / current, lasting - slope / current], abs=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_channels_at_random(seed: int):
    """Wherever the far bank is met it is followed, and else only the current decides."""
    rng = random.Random(seed)
    current, width, length = rng.uniform(0.2, 3.0), rng.uniform(0.1, 0.8), rng.uniform(1.0, 5.0)
    lasting, met = channel(current, width, length)
    found = certified(
        boat("channel", bank=y - c),
        parameters={"w": current, "c": width},
        initial={"x": 0.0, "y": 0.0},
        final={"x": length, "y": 0.0},
        tf="free",
    )
    assert found.objective == pytest.approx(lasting, rel=1e-9)
    assert kinds(found) == ([("entry", "bank"), ("exit", "bank")] if met else [])


@pytest.mark.slow
def test_a_boat_that_may_not_steer_far_out_does_so_longer():
    """The costates do not know of the bound: the course is that without it, or the largest that is allowed."""
    current, steepest, length = 2.0, 0.5, 3.0

    def course(time: float, first: float) -> float:
        return math.atan(min(first - current * time, steepest / math.sqrt(1 - steepest**2)))

    def end(unknown: Any) -> list[float]:
        first, lasting = unknown
        corner = [(first - steepest / math.sqrt(1 - steepest**2)) / current]

        def forward(s: float) -> float:
            """With what the current carries, which is the area below y, by parts."""
            return math.cos(course(s, first)) + current * (lasting - s) * math.sin(course(s, first))

        rise = quad(lambda s: math.sin(course(s, first)), 0.0, lasting, points=corner, epsabs=1e-13)[0]
        return [rise, quad(forward, 0.0, lasting, points=corner, epsabs=1e-13)[0] - length]

    first, lasting = root(end, [1.5, 1.7], tol=1e-13).x
    found = certified(
        boat("bounded", course=sp.sin(beta) - c),
        parameters={"w": current, "c": steepest},
        initial={"x": 0.0, "y": 0.0},
        final={"x": length, "y": 0.0},
        tf="free",
    )
    assert found.objective == pytest.approx(lasting, rel=1e-9)
    assert kinds(found)[:2] == [("entry", "course"), ("exit", "course")]
    assert found.events[1].t == pytest.approx((first - math.tan(math.asin(steepest))) / current, abs=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("height", [0.2, 0.6])
def test_the_shortest_way_over_a_hill_leaves_on_tangents(height: float):
    """x' = u, the length as the cost, over h (1 - (2 t - 1)^2) from a level of h / 2."""
    hill = height * (1 - (2 * t - 1) ** 2)
    touch = math.sqrt(1 / 8)  # where the hill is as high above the start as its slope leads there
    slope = 4 * height * (1 - 2 * touch)
    over = quad(lambda s: math.sqrt(1 + (4 * height * (1 - 2 * s)) ** 2), touch, 1 - touch, epsabs=1e-13)[0]
    found = certified(
        moved("hill", sp.sqrt(1 + u**2), ground=hill - x),
        initial={"x": height / 2},
        final={"x": height / 2},
        tf=1.0,
    )
    assert found.objective == pytest.approx(2 * touch * math.sqrt(1 + slope**2) + over, rel=1e-10)
    assert [one.t for one in found.events] == pytest.approx([touch, 1 - touch], abs=1e-7)


def test_a_square_of_the_control_may_be_bounded():
    """With x itself in the cost, u = -(1 - t), or -1/2 where that is less."""
    found = certified(moved("slow", u**2 / 2 + x, power=u**2 - c), parameters={"c": 0.25}, initial={"x": 0.0}, tf=1.0)
    optimum = quad(lambda s: min(0.5, 1 - s) ** 2 / 2 - (1 - s) * min(0.5, 1 - s), 0.0, 1.0, points=[0.5])[0]
    assert found.objective == pytest.approx(optimum, rel=1e-10)
    assert [one.t for one in found.events] == pytest.approx([0.0, 0.5], abs=1e-8)


@pytest.mark.study
def test_before_a_wall_with_a_cost_that_grows_exponentially():
    """Towards the rest at the wall u = -4 asinh(k s), s being the time until then; there nothing pushes."""
    wall = 0.1

    def way(k: float, lasting: float) -> tuple[float, float]:
        change = lasting * math.asinh(k * lasting) - (math.sqrt(1 + (k * lasting) ** 2) - 1) / k
        return 1.0 - 4 * change, 4 * quad(lambda s: math.asinh(k * s) * (lasting - s), 0.0, lasting, epsabs=1e-14)[
            0
        ] - wall

    k, lasting = root(lambda v: way(*v), [5.0, 0.3], tol=1e-14).x
    cost = 2 * quad(lambda s: 2 * math.sqrt(1 + (k * s) ** 2), 0.0, lasting, epsabs=1e-14)[0] + 2 * (1 - 2 * lasting)
    found = certified(
        moved("dear", sp.exp(u / 4) + sp.exp(-u / 4), second=True, wall=x - c),
        but=("a multiplier vanishes on a boundary arc",),
        parameters={"c": wall},
        initial={"x": 0.0, "y": 1.0},
        final={"x": 0.0, "y": -1.0},
        tf=1.0,
    )
    assert found.objective == pytest.approx(cost, rel=1e-9)
    assert [one.t for one in found.events] == pytest.approx([lasting, 1 - lasting], abs=1e-7)


@pytest.mark.study
def test_the_shuttle_that_may_not_be_heated_too_much_glides_as_far_as_by_direct_collocation():
    """CasADi and Ipopt, Legendre points of degree 5 in three phases with free junctions.

    On 29, 58 and 116 intervals 30.62548227, 30.62547391 and 30.62547383 degrees.
    """
    found = solve(instance.load("shuttle-heating"))
    assert math.degrees(-found.objective) == pytest.approx(30.62547383, rel=1e-9)
    assert [(one.kind, one.name) for one in found.events] == [("entry", "heating"), ("exit", "heating")]
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate


@pytest.mark.slow
def test_an_end_beyond_a_bank_is_refused_whenever_it_is_reached_unless_the_bank_moves():
    given = {"parameters": {"c": 0.2}, "initial": {"x": 0.0, "y": 0.0}, "final": {"x": 2.0, "y": 0.5}, "tf": "free"}
    with pytest.raises(
        BadInput, match=r"final: path constraint bank has the value 0\.3 at that point, but must not be positive"
    ):
        satsym.solve(satsym.Instance.of(boat("beyond", bank=y - c), **given))
    assert satsym.solve(satsym.Instance.of(boat("moving", bank=y - c - t), **given)).status is Status.CONVERGED
