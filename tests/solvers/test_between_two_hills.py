"""A body pushed past hills of cost to a line across its way: it may pass on either side, and ends where it likes.

The truth is by scipy's solve_bvp, from guesses that go round either way.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_bvp
from sympy import exp

import satsym
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = tuple(Variable(name, name) for name in ("x", "y", "vx", "vy"))
CONTROLS = (Variable("ux", "u_x"), Variable("uy", "u_y"))
(x, y, vx, vy), (ux, uy) = symbols_of(STATES), symbols_of(CONTROLS)
HILLS = ((2.3209, 0.6438, 0.0062, 0.1799), (1.6496, 1.1265, -0.6505, 0.1437))
"""Height, place and width of each."""
DURATION = 1.6813
MODEL = FirstOrder(
    name="pushed_past_hills",
    title="A body in a plane",
    states=STATES,
    controls=CONTROLS,
    parameters=(),
    rates={x: vx, y: vy, vx: ux, vy: uy},
)
PAST = Problem(
    name="past_hills",
    title="Past two hills",
    model=MODEL,
    running_cost=(ux**2 + uy**2) / 2
    + sum(h * exp(-((x - a) ** 2 + (y - b) ** 2) / (2 * w**2)) for h, a, b, w in HILLS),
)

Rows = NDArray[np.float64]


def hills(z: Rows) -> tuple[Rows, Rows, Rows]:
    """Their cost and its slopes by x and y."""
    each = [h * np.exp(-((z[0] - a) ** 2 + (z[1] - b) ** 2) / (2 * w**2)) for h, a, b, w in HILLS]
    slopes = [
        sum(-cost * (z[k] - hill[1 + k]) / hill[3] ** 2 for cost, hill in zip(each, HILLS, strict=True)) for k in (0, 1)
    ]
    return np.asarray(sum(each)), np.asarray(slopes[0]), np.asarray(slopes[1])


def moved(t: Rows, z: Rows) -> Rows:
    """States, costates and the cost so far, with u = -lambda_v."""
    cost, by_x, by_y = hills(z)
    return np.array([z[2], z[3], -z[6], -z[7], -by_x, -by_y, -z[4], -z[5], (z[6] ** 2 + z[7] ** 2) / 2 + cost])


def ends(a: Rows, b: Rows) -> Rows:
    return np.array([*a[:4], b[0] - 2.0, *b[5:8], a[8]])


def cost_of(bend: float) -> float:
    t = np.linspace(0.0, DURATION, 101)
    guess = np.zeros((9, len(t)))
    guess[0], guess[1] = 2.0 * (t / DURATION) ** 2, bend * t / DURATION
    found = solve_bvp(moved, ends, t, guess, tol=1e-8, max_nodes=20_000)
    assert found.success
    return float(found.y[8, -1])


def test_the_cheaper_side_is_found_although_the_first_starts_go_round_the_other() -> None:
    one, other = cost_of(0.8), cost_of(-0.5)
    assert one < other - 0.05
    initial = dict.fromkeys(("x", "y", "vx", "vy"), 0.0)
    found = satsym.solve(satsym.Instance.of(PAST, initial=initial, final={"x": 2.0}, tf=DURATION)).to_dict()
    assert found["certificate"]["verdict"] == "certified"
    assert found["objective"] == pytest.approx(one, rel=1e-6)
