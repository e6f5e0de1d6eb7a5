"""The shortest path of bounded curvature that turns all the way round on itself: no short start arrives.

Of two turns to the right with one to the left between them the lengths are known in closed form (Dubins, On curves of
minimal length with a constraint on average curvature, 1957).
"""

from __future__ import annotations

import math

import pytest
from sympy import cos, sin

import satsym
from satsym import solvers
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES, CONTROLS = tuple(Variable(name, name) for name in ("x", "y", "h")), (Variable("u", "u"),)
(x, y, h), (u,) = symbols_of(STATES), symbols_of(CONTROLS)
MODEL = FirstOrder(
    name="turning",
    title="A path with a heading",
    states=STATES,
    controls=CONTROLS,
    parameters=(),
    rates={x: cos(h), y: sin(h), h: u},
)
SHORTEST = Problem(name="shortest", title="The shortest path", model=MODEL, running_cost=1, control_set="box")
BEGIN, END = (0.0, 0.0, 0.2873), (-0.9216, 2.5217, 0.992)


def right_left_right() -> tuple[float, float, float]:
    """How long the three turns are, from the centres of their circles of radius one."""
    (x0, y0, h0), (x1, y1, h1) = BEGIN, END
    first, last = (x0 + math.sin(h0), y0 - math.cos(h0)), (x1 + math.sin(h1), y1 - math.cos(h1))
    apart = math.dist(first, last)
    towards = math.atan2(last[1] - first[1], last[0] - first[0])
    middle = 2.0 * math.pi - 2.0 * math.asin(apart / 4.0)  # the longer way round the circle that touches both
    leaving = towards - math.acos(apart / 4.0) - math.pi / 2.0
    begin = (h0 - leaving) % (2.0 * math.pi)
    return begin, middle, (leaving + middle - h1) % (2.0 * math.pi)


def ended(turns: tuple[float, float, float]) -> tuple[float, float, float]:
    """Where these turns lead."""
    px, py, heading = BEGIN
    for turn, sign in zip(turns, (-1.0, 1.0, -1.0), strict=True):
        after = heading + sign * turn
        px, py = px + sign * (math.sin(after) - math.sin(heading)), py - sign * (math.cos(after) - math.cos(heading))
        heading = after
    return px, py, heading


@pytest.mark.slow
def test_a_path_is_found_to_a_place_so_near_that_it_turns_round_on_itself() -> None:
    turns = right_left_right()
    assert ended(turns) == pytest.approx(END, abs=1e-12)
    case = satsym.Instance.of(
        SHORTEST,
        initial=dict(zip("xyh", BEGIN, strict=True)),
        final=dict(zip("xyh", END, strict=True)),
        tf="free",
        control={"u": [-1.0, 1.0]},
    )
    found = solvers.solve(case.case, examined=False)
    assert found.objective == pytest.approx(sum(turns), rel=1e-9)
    assert found.switching_times[0] == pytest.approx((turns[0], turns[0] + turns[1]), rel=1e-8)
