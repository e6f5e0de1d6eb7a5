"""A hill that is climbed between two path constraints: a saddle lies in the middle, and minima to either side."""

from __future__ import annotations

import math

import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import satsym
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES, CONTROLS = (Variable("x", "x"),), (Variable("u", "u"),)
(x,), (u,) = symbols_of(STATES), symbols_of(CONTROLS)
HILL = Problem(
    name="hill",
    title="down a hill",
    model=FirstOrder(name="climber", title="x' = u", states=STATES, controls=CONTROLS, parameters=(), rates={x: u}),
    running_cost=u**2 / 2 - 8 * x**2,
    path_constraints={"up": u - 0.3 * x - 1, "down": -u + 0.3 * x - 1},
)


@pytest.mark.slow
@pytest.mark.parametrize("begun", [0.0, 0.05, -0.2, 0.4])
def test_a_saddle_is_left(begun: float):
    """Uphill as fast as allowed, x' = 1 + 0.3 x to the side of the start, then x = a cos 4 (1 - t)."""
    start = abs(begun)

    def on_bound(time: float) -> float:
        return (start + 1 / 0.3) * math.exp(0.3 * time) - 1 / 0.3

    def corner(time: float) -> float:
        return 4 * math.tan(4 * (1 - time)) * on_bound(time) - (1 + 0.3 * on_bound(time))

    left = brentq(corner, 1 - math.pi / 8 + 1e-6, 1.0, xtol=1e-15)
    size = on_bound(left) / math.cos(4 * (1 - left))
    first = quad(lambda s: (1 + 0.3 * on_bound(s)) ** 2 / 2 - 8 * on_bound(s) ** 2, 0.0, left, epsabs=1e-13)[0]
    then = quad(lambda s: 8 * size**2 * (math.sin(4 * s) ** 2 - math.cos(4 * s) ** 2), 0.0, 1 - left, epsabs=1e-13)[0]
    found = satsym.solve(satsym.Instance.of(HILL, initial={"x": begun}, tf=1.0))
    said = found.to_dict()
    assert said["certificate"]["verdict"] == "certified", said["certificate"]
    assert found.objective == pytest.approx(first + then, rel=1e-9)
    assert [(one.kind, one.t) for one in found.events] == [("entry", 0.0), ("exit", pytest.approx(left, abs=1e-8))]
