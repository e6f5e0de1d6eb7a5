"""Dubins' car, stated as a motion of one's own: two turns and a straight line, against the closed form.

L. E. Dubins, On curves of minimal length with a constraint on average curvature, American Journal of Mathematics 79,
1957; the lengths are those of Shkel and Lumelsky, Robotics and Autonomous Systems 34, 2001.
"""

from __future__ import annotations

from math import acos, atan2, cos, hypot, pi, sin, sqrt
from pathlib import Path

import pytest
import sympy as sp

from satsym.solvers import solve
from satsym.status import Status
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES = tuple(Variable(name, name) for name in ("x", "y", "th"))
CONTROLS = (Variable("u", "u"),)
x, y, th = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)

DUBINS = Problem(
    name="dubins",
    title="The shortest way of a car that turns left or right",
    model=FirstOrder(
        name="car",
        title="A car",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={x: sp.cos(th), y: sp.sin(th), th: u},
    ),
    running_cost=1,
    control_set="box",
)


def turns_alike(x: float, y: float, heading: float) -> float:
    """Left, straight, left, from the origin along the x-axis: the line is as long as the centres are apart."""
    across, along = x - sin(heading), y + cos(heading) - 1.0
    line = atan2(along, across)
    return hypot(across, along) + line % (2.0 * pi) + (heading - line) % (2.0 * pi)


def turns_opposed(x: float, y: float, heading: float) -> float:
    """Left, straight, right: the line crosses between the two circles."""
    across, along = x + sin(heading), y - cos(heading) - 1.0
    apart = hypot(across, along)
    line = atan2(along, across) + pi / 2.0 - acos(2.0 / apart)
    return sqrt(apart**2 - 4.0) + line % (2.0 * pi) + (line - heading) % (2.0 * pi)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("end", "structure", "length"),
    [
        ((4.0, 3.0, 1.0), "+s+", turns_alike(4.0, 3.0, 1.0)),
        pytest.param((4.0, -3.0, -1.0), "-s-", turns_alike(4.0, 3.0, 1.0), marks=pytest.mark.study),
        pytest.param((5.0, 2.0, -1.0), "+s-", turns_opposed(5.0, 2.0, -1.0), marks=pytest.mark.study),
        ((5.0, 0.0, 0.0), "s", 5.0),  # here the switching function vanishes all along
    ],
)
def test_the_shortest_way_is_that_of_the_closed_form(
    tmp_path: Path, end: tuple[float, float, float], structure: str, length: float
) -> None:
    text = f"""
        [initial]
        x = 0.0
        y = 0.0
        th = 0.0
        [final]
        x = {end[0]}
        y = {end[1]}
        th = {end[2]}
        [time]
        t0 = 3.0
        tf = "free"
        [control]
        u = [-1.0, 1.0]
        """
    found = solve(build(tmp_path, DUBINS, text))
    assert found.status is Status.CONVERGED, found.message
    assert f"structure {structure}," in found.message
    assert found.objective == pytest.approx(length, rel=1e-11)
    assert found.certificate is not None
    missing = {check.name for check in found.certificate.checks if not check.passed}
    # every search may lead back to the answer, as where it is a straight line
    assert missing <= {"no comparison: no competitor was solved"}
