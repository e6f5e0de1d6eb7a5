"""Motions that escape to infinity within their time: x' = x^2 + u from rest does under a constant u of (pi/2)^2."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import satsym
from satsym.solvers.search.escaping import escape
from satsym.status import Status
from satsym.symbolic import Box, FirstOrder, Problem, Variable, symbols_of

STATE, CONTROL = (Variable("x", "x", meaning="place"),), (Variable("u", "u", meaning="push"),)
(x,), (u,) = symbols_of(STATE), symbols_of(CONTROL)


def growing(power: int, reward: Any) -> Problem:
    moving = FirstOrder(
        name="growing", title="G", states=STATE, controls=CONTROL, parameters=(), rates={x: x**power + u}
    )
    return Problem(
        name="grown", title="G", model=moving, running_cost=u**2 / 2, terminal_cost=reward, control_sets={"u": Box("u")}
    )


def stated(problem: Problem, **more: Any) -> satsym.Instance:
    return satsym.Instance.of(problem, initial={"x": 0.0}, tf=1.0, **more)


def test_controls_come_near_to_the_one_that_is_infinite_in_time() -> None:
    message = escape(stated(growing(2, -(x**2))).case)
    sizes, costs = (
        [float(one) for one in row.split(", ")]
        for row in re.fullmatch(r".*up to ([-+e\d., ]*) have the costs ([-+e\d., ]*)", message).groups()  # type: ignore[union-attr]
    )
    assert sizes[-1] == pytest.approx(np.pi**2 / 4.0, rel=1e-3)
    assert costs[0] > costs[1] > costs[2]
    size = sizes[0]  # of which the end is known
    assert costs[0] == pytest.approx(size**2 / 2.0 - size * np.tan(np.sqrt(size)) ** 2, rel=0.05)


@pytest.mark.parametrize(("power", "reward"), [(2, x**2), (1, -(x**2))], ids=["dear", "slow"])
def test_no_escape_where_far_motions_are_dear_or_take_for_ever(power: int, reward: Any) -> None:
    assert not escape(stated(growing(power, reward)).case)


@pytest.mark.parametrize("more", [{"final": {"x": 1.0}}, {"control": {"u": [-3.0, 3.0]}}], ids=["end", "bounds"])
def test_nothing_is_said_where_not_every_control_is_admissible(more: dict[str, Any]) -> None:
    assert not escape(stated(growing(2, -(x**2)), **more).case)


def test_an_instance_of_which_motions_escape_has_no_minimiser() -> None:
    """Its cost has a strict local minimum, -0.1108, which is stationary and found at first."""
    found = satsym.solve(stated(growing(2, -(x**2))))
    assert found.status is Status.NO_MINIMISER, found.message
    assert found.message.endswith("constrain the final state, or bound the control")
