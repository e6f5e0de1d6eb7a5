"""Points that are passed at free times: the times are found from a cold start, optima are known by other routes.

With the times given, a least effort is a quadratic form in the states between which it is spent, by exponentials of
matrices; of that form the velocities at the points, and then the times, are minimised.
"""

from __future__ import annotations

import itertools
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import minimize, minimize_scalar

import satsym
from satsym.arrays import Array
from satsym.front.solution import Solution
from satsym.solvers.certificate import certify
from satsym.solvers.constrained.newton import begun as unknowns
from satsym.solvers.constrained.newton import solved
from satsym.solvers.constrained.solving import answered
from satsym.solvers.constrained.structure import Passage, Structure
from satsym.solvers.iteration import watched
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from satsym.symbolic.model import t

KNOWN = tomllib.loads((Path(__file__).parents[1] / "bench" / "optima.toml").read_text(encoding="utf-8"))
STATES = tuple(Variable(name, name) for name in ("x", "v", "y", "w"))
CONTROLS = (Variable("f", "f"), Variable("g", "g"))
PARAMETERS = (Variable("k", "k", default=0.0), Variable("c", "c", default=0.0), Variable("z", "z", default=0.0))
x, v, y, w = symbols_of(STATES)
f, g = symbols_of(CONTROLS)
k, c, z = symbols_of(PARAMETERS)


def plane(name: str, cost: Any = (f**2 + g**2) / 2, **more: Any) -> Problem:
    """A body in a plane, drawn to the origin by springs of stiffness k."""
    model = FirstOrder(
        name=f"body_of_{name}",
        title="a body",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={x: v, v: f - k * x, y: w, w: g - k * y},
    )
    return Problem(name=name, title=name, model=model, running_cost=cost, **more)


def solution(of: Problem, initial: Any, final: Any, tf: Any, **given: Any) -> Solution:
    names = ("x", "v", "y", "w")
    ends = {"initial": dict(zip(names, initial, strict=True)), "final": dict(zip(names, final, strict=True))}
    return satsym.solve(satsym.Instance.of(of, **ends, time={"tf": tf}, **given))


def certified(found: Solution) -> list[float]:
    """Times of the points."""
    said = found.to_dict()
    assert said["status"] == "converged", said["message"]
    assert said["certificate"]["verdict"] == "certified", said["certificate"]["checks"]
    return [one.t for one in found.events if one.kind == "interior"]


def effort(matrix: Array, inputs: Array, states: list[Array], durations: Array) -> float:
    """Least half the integral of u'u through states; what of these is NaN is left to be best."""
    return best(matrix, inputs, states, durations)[0]


def best(matrix: Array, inputs: Array, states: list[Array], durations: Array) -> tuple[float, Array]:
    """The least effort, and the states row by row where it is least."""
    n, free = len(matrix), np.isnan(np.concatenate(states))
    form, z = np.zeros((len(free), len(free))), np.where(free, 0.0, np.concatenate(states))
    for place, lasting in enumerate(durations):
        table = expm(np.block([[-matrix, inputs @ inputs.T], [0 * matrix, matrix.T]]) * lasting)
        flow = table[n:, n:].T
        both = np.concatenate([-flow, np.eye(n)], axis=1)
        part = slice(n * place, n * (place + 2))
        form[part, part] += both.T @ np.linalg.solve(flow @ table[:n, n:], both)
    z[free] = -np.linalg.solve(form[np.ix_(free, free)], form[free] @ z)
    return float(z @ form @ z / 2), z.reshape(-1, n)


def along(matrix: Array, inputs: Array, states: Array, durations: Array) -> tuple[Array, Array]:
    """Times, and states with costates (2n, N), of the motion of least effort through states that are all given."""
    n, whole = len(matrix), np.block([[matrix, -inputs @ inputs.T], [0 * matrix, -matrix.T]])
    times, columns, begin = list[float](), list[Array](), 0.0
    for (one, other), lasting in zip(itertools.pairwise(states), durations, strict=True):
        flow = expm(whole * lasting)
        z = np.concatenate([one, np.linalg.solve(flow[:n, n:], other - flow[:n, :n] @ one)])
        for share in np.linspace(0.01, 0.99, 40):
            times.append(begin + share * lasting)
            columns.append(expm(whole * share * lasting) @ z)
        begin += lasting
    return np.array(times), np.array(columns).T


def springs(stiffness: float) -> tuple[Array, Array]:
    one = np.array([[0.0, 1.0], [-stiffness, 0.0]])
    return np.kron(np.eye(2), one), np.kron(np.eye(2), np.array([[0.0], [1.0]]))


NAN = float("nan")
PLACE = np.array([1.0, NAN, 1.0, NAN])


ON_BOUNDARIES = {
    "distance from the boundary on a boundary arc",
    "negative multiplier",
    "a multiplier vanishes on a boundary arc",
}
"""What only a motion that meets a boundary is checked for."""


@pytest.mark.slow
def test_a_point_on_a_line_is_where_it_turns():
    """From rest at 0 to rest at 0 by way of 1: u = 6 - 12 t and back, each at half the effort of 12."""
    found = solution(plane("turning", interior={"mark": (x - 1,)}), [0] * 4, [0] * 4, 2.0)
    assert certified(found) == pytest.approx([1.0], abs=1e-9)
    assert found.objective == pytest.approx(12.0, rel=1e-10)


@pytest.mark.slow
def test_a_point_that_lies_on_the_way_costs_nothing():
    found = solution(plane("straight_on", interior={"mark": (x - 1,)}), [0] * 4, [2, 0, 0, 0], 2.0)
    certified(found)
    assert found.objective == pytest.approx(3.0, rel=1e-10)


@pytest.mark.slow
def test_a_spline_through_a_point_at_its_best_time():
    found = solution(plane("spline", interior={"mark": (x - 1, y - 1)}), [0] * 4, [3, 0, 0, 0], 2.0)
    ends = np.zeros(4), np.array([3.0, 0.0, 0.0, 0.0])

    def cost(time: float) -> float:
        return effort(*springs(0.0), [ends[0], PLACE, ends[1]], np.array([time, 2.0 - time]))

    best = minimize_scalar(cost, bounds=(0.1, 1.9), options={"xatol": 1e-9})
    assert certified(found) == pytest.approx([best.x], abs=1e-6)
    assert found.objective == pytest.approx(best.fun, rel=1e-10)


@pytest.mark.slow
def test_two_points_are_passed_in_order():
    problem = plane("two_points", interior={"first": (x - 1, y - 1), "second": (x + 1, y - 2)})
    found = solution(problem, [0] * 4, [3, 0, 0, 0], 2.0)
    states = [np.zeros(4), PLACE, np.array([-1.0, NAN, 2.0, NAN]), np.array([3.0, 0.0, 0.0, 0.0])]

    def cost(times: Array) -> float:
        edges = np.array([0.0, *times, 2.0])
        return effort(*springs(0.0), states, np.diff(edges)) if np.diff(edges).min() > 0.05 else np.inf

    best = minimize(cost, [0.5, 1.2], method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-12})
    assert certified(found) == pytest.approx(best.x, abs=1e-5)
    assert found.objective == pytest.approx(best.fun, rel=1e-10)


@pytest.mark.slow
def test_the_best_of_many_times_on_a_long_way():
    """Springs bring a body to the point again and again."""
    problem, begun = plane("swinging", interior={"mark": (x - 1, y - 1)}), [0.5, 0.0, 0.0, 0.3]
    found = solution(problem, begun, [0] * 4, 12.0, parameters={"k": 1.0})

    def cost(time: float) -> float:
        return effort(*springs(1.0), [np.array(begun), PLACE, np.zeros(4)], np.array([time, 12.0 - time]))

    tried = np.linspace(0.2, 11.8, 300)
    near = tried[np.argmin([cost(time) for time in tried])]
    best = minimize_scalar(cost, bounds=(near - 0.05, near + 0.05), options={"xatol": 1e-9})
    assert certified(found) == pytest.approx([best.x], abs=1e-5)
    assert found.objective == pytest.approx(best.fun, rel=1e-10)


@pytest.mark.slow
def test_a_point_that_moves_lets_h_jump():
    problem = plane("chasing", interior={"mark": (x - 1 - t / 2, y - 1)})
    found = solution(problem, [0] * 4, [3, 0, 0, 0], 2.0)

    def cost(time: float) -> float:
        place = np.array([1.0 + time / 2, NAN, 1.0, NAN])
        states = [np.zeros(4), place, np.array([3.0, 0.0, 0.0, 0.0])]
        return effort(*springs(0.0), states, np.array([time, 2.0 - time]))

    best = minimize_scalar(cost, bounds=(0.1, 1.9), options={"xatol": 1e-9})
    assert certified(found) == pytest.approx([best.x], abs=1e-6)
    assert found.objective == pytest.approx(best.fun, rel=1e-10)


@pytest.mark.slow
def test_a_free_final_time_is_found_beside():
    found = solution(
        plane("paid", 1 + (f**2 + g**2) / 2, interior={"mark": (x - 1, y - 1)}), [0] * 4, [3, 0, 0, 0], "free"
    )

    def cost(durations: Array) -> float:
        if min(durations) < 0.1:
            return np.inf
        return effort(*springs(0.0), [np.zeros(4), PLACE, np.array([3.0, 0.0, 0.0, 0.0])], durations) + sum(durations)

    best = minimize(cost, [2.0, 2.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-13})
    assert certified(found) == pytest.approx([best.x[0]], abs=1e-5)
    assert found.objective == pytest.approx(best.fun, rel=1e-10)


@pytest.mark.slow
def test_bounds_on_both_sides_of_a_point_have_arcs():
    """From rest to rest in unit time within |u| <= 5: saturated arcs last s, with 6 / (1 + 2 s - 2 s^2) = 5."""
    problem = plane("within", interior={"mark": (x - 1,)}, control_set="box")
    found = solution(problem, [0] * 4, [0] * 4, 2.0, control={"f": [-5.0, 5.0]})
    s = 0.5 * (1.0 - np.sqrt(3.0 * (1.0 - 4.0 / 5.0)))
    assert certified(found) == pytest.approx([1.0], abs=1e-9)
    assert {check.name for check in found.certificate.checks} >= ON_BOUNDARIES
    exits = [one.t for one in found.events if one.kind == "exit"]
    assert exits == pytest.approx([s, 1.0 + s], abs=1e-9)
    free = 25.0 * (1.0 - 2.0 * s) / 3.0
    assert found.objective == pytest.approx(25.0 * 2.0 * s + free, rel=1e-10)


@pytest.mark.slow
def test_controls_jump_from_bound_to_bound_where_a_velocity_is_to_be_met():
    problem = plane("met", interior={"mark": (x - 1, v)}, control_set="box")
    found = solution(problem, [0] * 4, [-1, 0, 0, 0], 2.5, control={"f": [-5.2, 5.2]})
    (time,) = certified(found)
    assert found.found.x[:2, np.searchsorted(found.found.times, time)] == pytest.approx([1.0, 0.0], abs=1e-9)


@pytest.mark.slow
def test_the_inspection_is_that_of_the_table():
    matrix = np.array([[0, 1, 0, 0], [3, 0, 0, 2], [0, 0, 0, 1], [0, -2, 0, 0.0]])
    inputs = np.array([[0, 0], [1, 0], [0, 0], [0, 1.0]])
    states = [np.array([0.0, 0.0, -0.1, 0.0]), np.array([0.02, NAN, 0.03, NAN]), np.zeros(4)]

    def cost(time: float) -> float:
        return effort(matrix, inputs, states, np.array([time, 2.0 * np.pi - time]))

    best = minimize_scalar(cost, bounds=(3.5, 5.5), options={"xatol": 1e-10})
    found = satsym.solve("inspection")
    assert certified(found) == pytest.approx([best.x], abs=1e-5)
    assert found.objective == pytest.approx(best.fun, rel=1e-9)
    assert not ON_BOUNDARIES & {check.name for check in found.certificate.checks}
    assert KNOWN["inspection"]["optimum"] == pytest.approx(best.fun, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("stiffness", [0.6, 1.7])
def test_a_time_at_which_the_cost_is_largest_is_no_minimum(stiffness: float):
    """Stationary times of a swinging body alternate: the certificate tells which are minima, as the cost does."""
    problem, begun = plane("stationary", interior={"mark": (x - 1, y - 1)}), [0.5, 0.0, 0.0, 0.3]
    ends = dict.fromkeys(("x", "v", "y", "w"), 0.0)
    initial = dict(zip(ends, begun, strict=True))
    given = {"initial": initial, "final": ends, "time": {"tf": 9.0}, "parameters": {"k": stiffness}}
    case = satsym.Instance.of(problem, **given).case

    def least(time: float) -> tuple[float, Array]:
        return best(*springs(stiffness), [np.array(begun), PLACE, np.zeros(4)], np.array([time, 9.0 - time]))

    limits = watched(case, None)[0]
    times = np.linspace(0.4, 8.6, 200)
    costs = np.array([least(time)[0] for time in times])
    turns = np.flatnonzero(np.diff(np.sign(np.diff(costs)))) + 1
    seen = set()
    for turn in turns:
        parts = np.array([times[turn], 9.0 - times[turn]])
        near = along(*springs(stiffness), least(times[turn])[1], parts)
        structure = Structure((), (Passage(times[turn], ((0, 0.0), (1, 0.0))),))
        found = solved(unknowns(case, structure, (*near, np.empty(0)), 9.0), limits)
        assert found is not None
        assert found.times[1] == pytest.approx(times[turn], abs=0.1)
        minimum = bool(costs[turn] < costs[turn - 1])
        verdict = certify(answered(case, found, 0.0, "here"), compared=False)
        assert verdict is not None
        assert (verdict.verdict is Verdict.LOCAL_MINIMUM) == minimum, verdict
        seen.add(minimum)
    assert seen == {True, False}


@pytest.mark.slow
def test_a_point_that_is_best_passed_at_once_has_no_answer():
    found = solution(plane("at_once", interior={"mark": (x - 2, y + 0)}), [2, 0, 0, 0], [0, 0, 1, 0], 2.0)
    assert found.to_dict()["status"] == "not converged"
