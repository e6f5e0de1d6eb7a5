"""Where collocation finds an extremal but cannot make it accurate, multiple shooting is tried in its place."""

from __future__ import annotations

import pytest
from sympy import cos, sin

import satsym
from satsym.status import Status
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (*(Variable(name, name) for name in ("x", "vx", "z", "vz")), Variable("theta", "theta", kind="angle"))
CONTROLS = (Variable("F", "F"), Variable("w", "w"))
GRAVITY = 9.81


@pytest.mark.slow
def test_a_quadrotor_climbs_five_metres_though_its_pitch_rate_leaves_a_bound_for_a_moment() -> None:
    """A pitch rate within its bounds for 0.0025 of 1.5 seconds only, between the lower and the upper one.

    Pinned: CasADi and Ipopt, 32.243.
    """
    x, vx, z, vz, theta = symbols_of(STATES)
    force, rate = symbols_of(CONTROLS)
    rates = {x: vx, vx: force * sin(theta), z: vz, vz: force * cos(theta) - GRAVITY, theta: rate}
    model = FirstOrder(name="quad", title="A quadrotor", states=STATES, controls=CONTROLS, parameters=(), rates=rates)
    cost = ((force - GRAVITY) ** 2 + rate**2 / 100) / 2
    climb = Problem(name="quad_climb", title="Least effort", model=model, running_cost=cost, control_set="box")
    rest = dict.fromkeys((v.symbol for v in STATES), 0.0)
    bounds = {"F": (1.0, 20.0), "w": (-10.0, 10.0)}
    found = satsym.solve(satsym.Instance.of(climb, initial=rest, final={**rest, "z": 5.0}, tf=1.5, control=bounds))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(32.243, rel=5e-4)
