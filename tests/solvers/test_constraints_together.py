"""Several constraints active at once: in corners of walls, beside limits of speeds and bounds of controls."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from sympy import Rational

import satsym
from satsym.front.solution import Solution
from satsym.solvers.constrained.active import Together, field
from satsym.solvers.constrained.arcs import multiplier
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = tuple(Variable(name, name) for name in ("x", "y", "vx", "vy"))
CONTROLS = tuple(Variable(name, name) for name in ("ux", "uy"))
PARAMETERS = tuple(Variable(name, name, default=1.0) for name in ("a", "b"))
(x, y, vx, vy), (ux, uy), (a, b) = symbols_of(STATES), symbols_of(CONTROLS), symbols_of(PARAMETERS)
PLANE = FirstOrder(
    name="plane",
    title="a point in the plane",
    states=STATES,
    controls=CONTROLS,
    parameters=PARAMETERS,
    rates={x: vx, y: vy, vx: ux, vy: uy},
)
APART = (ux**2 + uy**2) / 2
COUPLED = APART + Rational(3, 10) * ux * uy


def problem(name: str, cost: Any, constraints: dict[str, Any], **more: Any) -> Problem:
    return Problem(name=name, title=name, model=PLANE, running_cost=cost, path_constraints=constraints, **more)


CORNER = problem("corner", APART, {"right": x - a, "top": y - b})
OBLIQUE = problem("oblique", COUPLED, {"right": x + Rational(3, 10) * y - a, "top": y - b})
SPEEDS = problem("speeds", COUPLED, {"fast": vx - a, "quick": vy - b})
BESIDE = problem("beside", COUPLED, {"fast": vx - a, "top": y - b})
BOXED = problem("boxed", APART, {"top": y - b}, control_set="box")
BOUNCE = {"x": 0.0, "y": 0.0, "vx": 1.0, "vy": 1.0}, {"x": 0.0, "y": 0.0, "vx": -1.0, "vy": -1.0}


def certified(of: Problem, begin: dict[str, float], end: dict[str, float], **more: Any) -> Solution:
    found = satsym.solve(satsym.Instance.of(of, initial=begin, final=end, tf=1.0, **more))
    said = found.to_dict()
    assert said["status"] == "converged", said["message"]
    assert said["certificate"]["verdict"] == "certified", said["certificate"]["checks"]
    return found


def bounced(wall: float) -> float:
    """Least 1/2 int u^2 from (0, 1) to (0, -1) in unit time before a wall (Bryson and Ho, 3.11): arcs, or a touch."""
    return 4 / (9 * wall) if wall <= 1 / 6 else 2.0 if wall >= 1 / 4 else 2 + 6 * (1 - 4 * wall) ** 2


@settings(max_examples=6, deadline=None)
@given(st.integers(8, 24), st.integers(8, 24))
@example(8, 8)
@example(8, 9)  # here a touch point of one wall, and an arc on it, were found with a free arc that lies on the wall
@pytest.mark.slow
def test_in_a_corner_each_wall_costs_what_it_costs_alone(right: int, top: int):
    found = certified(CORNER, *BOUNCE, parameters={"a": right / 100, "b": top / 100})
    assert found.objective == pytest.approx(bounced(right / 100) + bounced(top / 100), rel=1e-9)


def test_in_a_symmetric_corner_both_walls_are_met_at_one_time():
    found = certified(CORNER, *BOUNCE, parameters={"a": 0.1, "b": 0.1})
    assert found.objective == pytest.approx(2 * bounced(0.1), rel=1e-10)
    times = sorted(one.t for one in found.events)
    assert times == pytest.approx([0.3, 0.3, 0.7, 0.7], abs=1e-9)
    assert times[0] == times[1]
    assert times[2] == times[3]


def least(of: Problem, begin: dict[str, float], end: dict[str, float], numbers: dict[str, float], bounds: Any) -> float:
    """By a direct method with exact motions under controls constant between nodes: its limit on ever finer meshes."""
    import casadi as ca
    from sympy import lambdify

    symbols = (x, y, vx, vy, ux, uy, a, b)
    cost = lambdify(symbols, of.running_cost)
    constraints = [lambdify(symbols, g) for g in of.path_constraints.values()]

    def on(count: int) -> float:
        h, opti = 1.0 / count, ca.Opti()
        z, u, total = opti.variable(4, count + 1), opti.variable(2, count), 0
        for k in range(count):
            moved = z[:2, k] + h * z[2:, k] + h * h / 2 * u[:, k]
            opti.subject_to(z[:, k + 1] == ca.vertcat(moved, z[2:, k] + h * u[:, k]))
            there = (*ca.vertsplit(z[:, k + 1]), *ca.vertsplit(u[:, k]), *numbers.values())
            total += h * cost(*there)
            for g in constraints:
                opti.subject_to(g(*there) <= 0)
            for row, limits in enumerate(bounds):
                opti.subject_to(opti.bounded(limits[0], u[row, k], limits[1]))
        opti.subject_to(z[:, 0] == list(begin.values()))
        opti.subject_to(z[:, count] == list(end.values()))
        opti.minimize(total)
        options = {"print_level": 0, "tol": 1e-11, "bound_relax_factor": 0.0, "sb": "yes"}
        opti.solver("ipopt", {"print_time": False}, options)
        return float(opti.solve().value(total))

    coarse, fine = on(200), on(400)
    return fine + (fine - coarse) / 3  # errors of second order


MOVED = {"x": 0.0, "y": 0.0, "vx": 0.0, "vy": 1.0}, {"x": 1.0, "y": 0.0, "vx": 0.0, "vy": -1.0}
ACROSS = {"x": 0.0, "y": 0.0, "vx": 0.0, "vy": 0.0}, {"x": 1.0, "y": 0.95, "vx": 0.0, "vy": 0.0}
CASES = [
    (OBLIQUE, BOUNCE, {"a": 1 / 9, "b": 0.1}, {}, {"right + top"}),
    (SPEEDS, ACROSS, {"a": 1.2, "b": 1.25}, {}, {"fast + quick"}),
    (BESIDE, MOVED, {"a": 1.2, "b": 0.11}, {}, {"fast + top"}),
    (BOXED, MOVED, {"a": 1.0, "b": 0.1}, {"ux": [-5.0, 5.0], "uy": [-5.5, 6.0]}, {"uy_min + ux_max"}),
]


@pytest.mark.slow
@pytest.mark.parametrize(("of", "ends", "numbers", "bounds", "together"), CASES, ids=[case[0].name for case in CASES])
def test_what_is_active_at_once_agrees_with_a_direct_method(
    of: Problem, ends: Any, numbers: dict[str, float], bounds: Any, together: set[str]
):
    """Walls that are not at right angles, speeds, a speed and a wall, bounds of both controls, coupled by costs."""
    pytest.importorskip("casadi")
    found = certified(of, *ends, parameters=numbers, **({"control": bounds} if bounds else {}))
    assert found.objective == pytest.approx(least(of, *ends, numbers, bounds.values()), rel=3e-7)
    arcs = found.found.message.split("structure ")[1].split(" (")[0].split(", ")
    assert together <= set(arcs)
    assert all(before != after for before, after in pairwise(arcs))


def test_multipliers_of_several_keep_all_last_rates_zero():
    """A speed beside a wall: with the multipliers that are found the second rate of y stays zero, by differences."""
    case = satsym.Instance.of(BESIDE, initial=MOVED[0], final=MOVED[1], parameters={"a": 1.2, "b": 0.11}, tf=1.0).case
    rng, active, t = np.random.default_rng(1), (0, 1), np.array([0.3])
    z = rng.normal(size=(8, 1))

    def rate(z: np.ndarray) -> np.ndarray:
        return Together(case, active, t, z).vanishing(1)[1]

    step, moved = 1e-4, field(case, active, t, z)
    change = (rate(z + step * moved) - rate(z - step * moved)) / (2 * step)
    assert change == pytest.approx(0.0, abs=1e-7)
    alone = multiplier(case, 1, t, z)
    assert abs(Together(case, active, t, z).multipliers[1] - alone) < 1e3
