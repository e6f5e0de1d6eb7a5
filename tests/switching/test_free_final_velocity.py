"""Throttled fuel to a place that may be passed at any velocity: nothing decides a direction at the very end.

Costates of velocities vanish there, exactly, and with them the slope of H by the direction.
"""

from __future__ import annotations

import numpy as np
import pytest
from sympy import sqrt

import satsym
from satsym.symbolic import Ball, FirstOrder, Problem, Variable, symbols_of

STATES, CONTROLS = (
    tuple(Variable(name, name) for name in ("x", "y", "vx", "vy")),
    (Variable("u", "u"), Variable("w", "w")),
)
(x, y, vx, vy), (u, w) = symbols_of(STATES), symbols_of(CONTROLS)
MODEL = FirstOrder(
    name="near_orbit",
    title="Motion near a circular orbit",
    states=STATES,
    controls=CONTROLS,
    parameters=(),
    rates={x: vx, y: vy, vx: 3 * x + 2 * vy + u, vy: -2 * vx + w},
)
FUEL = Problem(
    name="near_orbit_fuel",
    title="Least fuel",
    model=MODEL,
    running_cost=sqrt(u**2 + w**2),
    control_sets={"engine": Ball("u", "w")},
)


def test_an_end_at_any_velocity_is_no_failure() -> None:
    """Radau collocation with CasADi and Ipopt has 0.602363 from 30 starts, on 90 intervals."""
    case = satsym.Instance.of(
        FUEL,
        initial={"x": 0.33, "y": 0.9006, "vx": -0.0401, "vy": 0.0},
        final={"x": 0.0, "y": 0.0},
        tf=3.6212,
        control={"max_norm": 1.1917},
    )
    found = satsym.solve(case)
    assert np.isfinite(np.asarray(found.u)).all()
    assert found.to_dict()["certificate"]["verdict"] == "certified"
    assert found.objective == pytest.approx(0.602363, rel=1e-4)
