"""Free initial states beside path constraints and waypoints: closed forms, and independent direct solutions."""

from __future__ import annotations

import pytest
from scipy.optimize import minimize_scalar

import satsym
from satsym.status import Verdict


def test_the_best_initial_velocity_below_a_wall_is_that_of_the_closed_form() -> None:
    """With a free initial velocity its costate vanishes, so the control grows from zero up to the touch point.

    Up to the touch point at t the body moves by 1/9 with u = -a s, which costs 1 / (54 t^3); the rest is the cubic from
    rest at 1/9 to the given end in the time that is left.
    """

    def cost(t: float) -> float:
        rest = 1.0 - t
        return 1.0 / (54.0 * t**3) + 2.0 / rest**3 * (3.0 / 81.0 - rest / 3.0 + rest**2)

    known = minimize_scalar(cost, bounds=(0.3, 0.95), method="bounded", options={"xatol": 1e-12})
    found = satsym.solve(
        satsym.Instance.of("bryson_denham", initial={"x": 0.0, "v": "free"}, final={"x": 0.0, "v": -1.0}, tf=1.0)
    )
    assert found.objective == pytest.approx(known.fun, rel=1e-9)
    assert found.events[0].t == pytest.approx(known.x, abs=1e-6)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_the_best_start_beside_obstacles_is_found_on_the_other_side() -> None:
    """Above the discs 8.9309 and 10.8884 are other strict minima over the start.

    Ipopt, 100 Hermite-Simpson steps with the constraints at nodes and midpoints, 24 starts: 6.7389 at y = -0.328.
    """
    free = {"x": 0.0, "y": "free", "vx": 0.0, "vy": 0.0}
    end = {"x": 1.0, "y": 0.0, "vx": 0.0, "vy": 0.0}
    found = satsym.solve(satsym.Instance.of("obstacle", initial=free, final=end, tf=1.0))
    assert found.objective == pytest.approx(6.7389, rel=1e-4)
    assert found.x[1, 0] == pytest.approx(-0.328, abs=1e-3)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_the_best_place_before_a_waypoint_costs_less_than_places_beside_it() -> None:
    def solved(along: float | str) -> satsym.Solution:
        initial = {"x1": 0.0, "x2": along, "x3": -0.1, "x4": 0.0}
        return satsym.solve(satsym.load("inspection").with_(initial=initial))

    found = solved("free")
    place = float(found.x[1, 0])
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    assert all(solved(place + step).objective > found.objective for step in (-1e-3, 1e-3))
