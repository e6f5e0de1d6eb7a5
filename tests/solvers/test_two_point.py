"""Given ends, free ends and free final times by collocation, held against independent routes."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
import pytest
from scipy.integrate import solve_bvp, solve_ivp
from scipy.optimize import root

from satsym import instance
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import by_search, solve
from satsym.solvers.iteration import Limits, computed
from satsym.solvers.revolutions import with_cheapest_turns
from satsym.solvers.search.nearest import nearest
from satsym.status import BadInput, Status
from tests.support.canonical import Orbit, _fly
from tests.support.cases import with_parameters

TURN = 2.0 * math.pi
STATES = ("r", "r_dot", "theta", "theta_dot")
ENDS = ("ends-1-given", "ends-2-given-state", "ends-3-given-time", "ends-4-rendezvous", "ends-5-free")


def options(case: Instance, **changed: Any) -> Instance:
    return replace(case, solver=msgspec.structs.replace(case.solver, **changed))


def numbers(case: Instance) -> dict[str, float]:
    return {"c0": 0.0} | dict(zip(case.model.spec.parameter_names, case.parameters, strict=True))


def rates(case: Instance, y: np.ndarray) -> np.ndarray:
    """The canonical equations by hand, shape (8, ...), with controls clipped to the box."""
    p = numbers(case)
    mu = p["sigma"] ** 3 * p["omega"] ** 2
    r, v, _, w, l1, l2, l3, l4 = y
    u1, u2 = controls(case, y)
    turning = (u2 - 2.0 * v * w) / r
    return np.array(
        [
            v,
            r * w**2 - mu / r**2 + u1,
            w,
            turning,
            -l2 * (w**2 + 2.0 * mu / r**3) + l4 * turning / r,
            -l1 + 2.0 * l4 * w / r,
            0.0 * r,
            -2.0 * l2 * r * w - l3 + 2.0 * l4 * v / r,
        ]
    )


def controls(case: Instance, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    p = numbers(case)
    wanted = (-y[5] / p["c1"], -y[7] / (p["c2"] * y[0]))
    return tuple(np.clip(u, a, b) for u, a, b in zip(wanted, case.lower, case.upper, strict=True))


def hamiltonian(case: Instance, y: np.ndarray) -> float:
    p, (u1, u2) = numbers(case), controls(case, y)
    return p["c0"] + 0.5 * (p["c1"] * u1**2 + p["c2"] * u2**2) + float(y[4:] @ rates(case, y)[:4])


def simulated(found: Solution) -> np.ndarray:
    """States and costates at the end, integrated again from the start, stopping at each switching time."""
    case = found.instance
    y = np.concatenate([case.initial, found.lam[:, 0]])
    size = np.concatenate([np.abs(found.x).max(axis=1), np.abs(found.lam).max(axis=1)])
    size = np.where(size > 0.0, size, 1.0)
    stops = sorted({t for times in found.switching_times for t in times})
    for a, b in zip([found.times[0], *stops], [*stops, found.times[-1]], strict=True):
        arc = solve_ivp(lambda _, z: rates(case, z), (a, b), y, method="DOP853", rtol=1e-12, atol=1e-13 * size)
        assert arc.success
        y = arc.y[:, -1]
    return y


def wanted(found: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Which final states are given, and all of the reference with what is given put in."""
    case, p, tf = found.instance, numbers(found.instance), found.times[-1]
    goal = np.array([p["sigma"], 0.0, p["omega"] * tf, p["omega"]])
    given = np.array([name in case.final for name in STATES])
    for i, name in enumerate(STATES):
        value = case.final.get(name)
        goal[i] = value if isinstance(value, float) else goal[i]
    return given, goal


def missed(found: Solution) -> float:
    """Largest relative miss of given final states by the flow from the initial costates."""
    given, goal = wanted(found)
    size = np.maximum(np.abs(found.x).max(axis=1), 1e-300)
    return float((np.abs(simulated(found)[:4] - goal) / size)[given].max(initial=0.0))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "cost"),
    [
        ("return-to-orbit", 0.0031946551089),
        ("return-to-orbit-006", 0.0032333506505),
        ("return-to-orbit-005", 0.0033636292587),
        ("return-to-geo-wide", 1.596891241789e-11),
        ("return-to-geo", 1.615321738196e-11),
    ],
)
def test_costs_are_what_other_programs_find(name, cost):
    found = solve(instance.load(name))
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(cost, rel=1e-8)
    assert missed(found) < 1e-9


def test_initial_costates_are_what_other_programs_find():
    found = by_search.collocation(instance.load("return-to-orbit"))
    known = [0.13817547355, 0.02984866111, -0.00567694889, 0.08773937141]
    assert found.lam[:, 0] == pytest.approx(known, abs=2e-11)


def by_scipy(found: Solution, tf_free: bool = False) -> tuple[np.ndarray, float, float]:
    """Initial costates, cost and final time by solve_bvp, from a disturbed copy."""
    case, p = found.instance, numbers(found.instance)
    given, _ = wanted(found)
    tau = (found.times - found.times[0]) / (found.times[-1] - found.times[0])

    def slopes(_, y, q):
        u1, u2 = controls(case, y[:8])
        running = p["c0"] + 0.5 * (p["c1"] * u1**2 + p["c2"] * u2**2)
        return q[0] * np.vstack([rates(case, y[:8]), running])

    def residual(a, b, q):
        goal = np.array([p["sigma"], 0.0, p["omega"] * q[0], p["omega"]])
        miss = b[:4] - goal
        for i, name in enumerate(STATES):
            if isinstance(case.final.get(name), float):
                miss[i] = b[i] - case.final[name]
        weights = np.array([p["k1"], p["k2"], p["k3"], p["k4"]])
        ends = np.where(given, miss, b[4:8] - weights * (b[:4] - goal))
        last = q[0] - found.times[-1] if not tf_free else hamiltonian(case, b[:8]) - p["omega"] * b[6]
        return np.concatenate([a[:4] - case.initial, a[8:], ends, [last]])

    nodes = np.linspace(0.0, 1.0, 51)
    disturbed = np.vstack([found.x * (1.0 + 1e-3 * np.sin(3.0 * tau)), 0.9 * found.lam, 0.0 * tau])
    y = np.array([np.interp(nodes, tau, row) for row in disturbed])
    solved = solve_bvp(slopes, residual, nodes, y, [1.01 * found.times[-1]], tol=1e-10, max_nodes=50_000)
    assert solved.success
    goal = np.array([p["sigma"], 0.0, p["omega"] * solved.p[0], p["omega"]])
    weights = np.array([p["k1"], p["k2"], p["k3"], p["k4"]])
    terminal = 0.5 * float(weights @ (solved.y[:4, -1] - goal) ** 2)
    return solved.y[4:8, 0], solved.y[8, -1] + terminal, float(solved.p[0])


@pytest.mark.parametrize("name", ["return-to-orbit", "ends-3-given-time", "ends-4-rendezvous"])
def test_scipy_agrees(name):
    found = by_search.collocation(instance.load(name))
    costates, cost, tf = by_scipy(found, tf_free=found.instance.tf is None)
    assert found.lam[:, 0] == pytest.approx(costates, abs=1e-8)
    assert found.objective == pytest.approx(cost, rel=1e-8)
    assert found.times[-1] == pytest.approx(tf, rel=1e-8)


def test_switching_times_are_what_arcs_with_events_give():
    found = by_search.collocation(instance.load("return-to-orbit-005"))
    orbit = Orbit(k=(0.0, 0.0, 0.0, 0.0), lower=(-0.05, -0.05), upper=(0.05, 0.05))
    goal = np.array([1.0, 0.0, TURN, 1.0])
    start = found.lam[:, 0] * 1.001
    shot = root(lambda costate: _fly(orbit, costate).at(np.array([TURN]))[:4, 0] - goal, start, tol=1e-13)
    other = _fly(orbit, shot.x)
    for mine, theirs in zip(found.switching_times, other.switches, strict=True):
        assert mine == pytest.approx(theirs, abs=1e-9)
    assert found.objective == pytest.approx(other.cost, rel=1e-9)
    assert found.lam[:, 0] == pytest.approx(other.costate, abs=1e-9)


def test_units_do_not_matter():
    geo = instance.load("return-to-geo")
    p = numbers(geo)
    length, omega = p["sigma"], p["omega"]
    unit = length * np.array([1.0, omega, 1.0 / length, omega / length])
    thrust = length * omega**2
    scaled = replace(
        with_parameters(geo, sigma=1.0, omega=1.0),
        initial=tuple((np.array(geo.initial) / unit).tolist()),
        tf=geo.tf * omega,
        lower=tuple(u / thrust for u in geo.lower),
        upper=tuple(u / thrust for u in geo.upper),
    )
    mine, theirs = by_search.collocation(geo), by_search.collocation(scaled)
    cost = thrust**2 / omega
    assert mine.objective == pytest.approx(theirs.objective * cost, rel=1e-8)
    assert mine.lam[:, 0] == pytest.approx(theirs.lam[:, 0] * cost / unit, rel=1e-6)
    assert mine.switching_times[1] == pytest.approx([t / omega for t in theirs.switching_times[1]], rel=1e-7)


@pytest.mark.parametrize("name", ENDS)
def test_each_kind_of_end_is_transversal(name):
    found = by_search.collocation(instance.load(name))
    case, p, tf = found.instance, numbers(found.instance), found.times[-1]
    assert found.status is Status.CONVERGED
    assert case.boundary_type == int(name[5])
    assert missed(found) < 1e-9
    y = simulated(found)
    given, _ = wanted(found)
    error = y[:4] - np.array([p["sigma"], 0.0, p["omega"] * tf, p["omega"]])
    weights = np.array([p["k1"], p["k2"], p["k3"], p["k4"]])
    gradient = weights * error
    assert y[4:][~given] == pytest.approx(gradient[~given], abs=1e-9)
    if case.tf is None:
        by_time = -p["omega"] * (p["k3"] * error[2])  # of S, explicitly
        curve = np.array([0.0, 0.0, p["omega"], 0.0])  # c'
        follows = np.array([case.final.get(state) == "reference" for state in STATES])
        assert hamiltonian(case, y) + by_time + (gradient - y[4:])[follows] @ curve[follows] == pytest.approx(
            0.0, abs=1e-9
        )


@pytest.mark.parametrize("name", ["ends-2-given-state", "ends-4-rendezvous", "ends-5-free"])
def test_the_free_final_time_is_the_cheapest(name):
    found = by_search.collocation(instance.load(name))
    for fraction in (0.5, 0.7, 0.97, 1.03, 1.4, 2.0):
        there = replace(found.instance, tf=float(found.times[-1]) * fraction)
        other = by_search.collocation(there)
        assert other.status is not Status.CONVERGED or other.objective > found.objective


@pytest.mark.parametrize("guess", [1.0, 4.0, 9.0])
def test_the_guess_of_the_final_time_hardly_matters(guess):
    found = by_search.collocation(replace(instance.load("ends-4-rendezvous"), tf_guess=guess))
    assert found.times[-1] == pytest.approx(5.213428793, rel=1e-8)


def test_a_bounded_control_may_come_with_a_free_final_time():
    case = replace(instance.load("ends-4-rendezvous"), lower=(-0.08, -0.08), upper=(0.08, 0.08))
    found = by_search.collocation(case)
    assert found.status is Status.CONVERGED
    assert np.abs(found.u).max() <= 0.08 + 1e-12
    assert found.switching_times[1]
    assert missed(found) < 1e-9
    y = simulated(found)
    assert hamiltonian(case, y) - y[6] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("free", [(), ("theta",)])
def test_without_a_weight_on_time_there_is_no_minimiser(free):
    case = with_parameters(instance.load("ends-4-rendezvous"), c0=0.0)
    case = replace(case, final={name: value for name, value in case.final.items() if name not in free})
    began = time.thread_time()
    found = solve(case)
    assert found.status is Status.NO_MINIMISER
    assert time.thread_time() - began < 10.0
    assert "a longer duration is always cheaper: cost" in found.message
    costs, durations = (
        [float(v) for v in part.split(",")]
        for part in found.message.split("cheaper: cost ")[1].split(";")[0].split(" at durations ")
    )
    assert sorted(costs, reverse=True) == costs
    assert sorted(durations) == durations
    assert len(costs) >= 3
    given = by_search.collocation(replace(case, tf=durations[0]))
    assert given.objective == pytest.approx(costs[0], rel=1e-3)
    assert found.certificate is None
    assert math.isnan(found.objective)


@pytest.mark.slow
def test_where_nothing_depends_on_the_final_time_that_is_said():
    case = replace(with_parameters(instance.load("ends-5-free"), c0=0.0, k1=0.0, k2=0.0, k4=0.0))
    found = solve(case)
    assert found.status is Status.NO_MINIMISER
    assert "nothing determines the final time" in found.message


def test_where_only_time_costs_the_shortest_would_be_best():
    case = replace(with_parameters(instance.load("ends-5-free"), k1=0.0, k2=0.0, k4=0.0))
    found = solve(case)
    assert found.status is Status.NO_MINIMISER
    assert "shorter duration is always cheaper" in found.message


def test_a_final_angle_may_count_modulo_a_turn():
    plain = by_search.collocation(instance.load("ends-1-given"))
    case = instance.load("ends-1-given")
    stated = {**case.final, "theta": case.final["theta"] - 2.0 * TURN}
    found = with_cheapest_turns(
        by_search.collocation, options(replace(case, final=stated), free_angles=("theta",)), None
    )
    assert found.objective == pytest.approx(plain.objective, rel=1e-9)
    assert found.x[:, 0] == pytest.approx(case.initial, abs=1e-12)
    assert found.x[2, -1] == pytest.approx(case.final["theta"], rel=1e-12)
    assert "theta ends 2 turns above what is stated; a turn less costs" in found.message
    beside = [{**case.final, "theta": case.final["theta"] + k * TURN} for k in (-1, 1)]
    less, more = (by_search.collocation(replace(case, final=final)) for final in beside)
    assert min(less.objective, more.objective) > found.objective
    assert f"a turn less costs {less.objective:.6g}, a turn more costs {more.objective:.6g}" in found.message


def test_an_angle_that_follows_the_reference_may_lose_turns():
    case = replace(instance.load("return-to-orbit"), initial=(1.1, 0.0, TURN, 0.9))
    plain = by_search.collocation(instance.load("return-to-orbit"))
    found = with_cheapest_turns(by_search.collocation, options(case, free_angles=("theta",)), None)
    assert found.objective == pytest.approx(plain.objective, rel=1e-9)
    assert "theta ends 1 turn above" in found.message


@pytest.mark.study
def test_the_thesis_can_be_answered_with_thrusts_both_ways():
    found = by_search.collocation(instance.load("its-thesis-return-two-sided"))
    assert found.status is Status.CONVERGED
    assert missed(found) < 1e-8
    assert found.objective < 0.08


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "changed"),
    [
        pytest.param("its-thesis-return", {}, marks=pytest.mark.study),
        pytest.param("return-to-orbit", {"lower": (-0.02,) * 2, "upper": (0.02,) * 2}, marks=pytest.mark.study),
        ("return-to-orbit-ball", {"max_norm": 0.02}),
        ("return-to-orbit", {"lower": (-0.06,) * 2, "upper": (0.06,) * 2, "tf": 2.0}),
    ],
    ids=["thesis", "weak", "weak ball", "hasty"],
)
def test_what_cannot_be_done_is_infeasible_and_the_message_says_how_near_one_comes(name, changed):
    found = solve(replace(options(instance.load(name), max_seconds=120.0), **changed))
    assert found.status is Status.INFEASIBLE
    assert "local searches misses r by" in found.message
    assert math.isnan(found.objective)
    assert found.certificate is None


@pytest.mark.parametrize(
    ("name", "bounds"),
    [
        ("return-to-orbit", {"lower": (-0.05, -0.05), "upper": (0.05, 0.05)}),
        ("return-to-orbit-ball", {}),
        ("return-to-geo", {}),
    ],
)
def test_what_can_be_done_is_reached_by_the_search_for_the_nearest_end(name, bounds):
    case = replace(instance.load(name), **bounds)
    found = nearest(case, Limits(500, computed() + 60.0))
    assert found is not None
    assert found.arrives


@pytest.mark.slow
def test_the_time_limit_ends_the_search_for_the_nearest_end():
    case = options(instance.load("its-thesis-return"), max_seconds=5.0)
    began = time.thread_time()
    assert not solve(case).status.answered
    assert time.thread_time() - began < 8.0


@pytest.mark.parametrize("seconds", [0.001, 0.5])
@pytest.mark.parametrize("name", ["its-thesis-return", "ends-2-given-state"])
def test_the_time_limit_is_kept(name, seconds):
    began = time.thread_time()
    found = by_search.collocation(options(instance.load(name), max_seconds=seconds))
    assert time.thread_time() - began < seconds + 2.0
    assert found.status.answered or found.status is Status.TIME_LIMIT


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"method": "sweep"}, "the sweep method does not support a free final time"),
        ({"method": "bang-bang"}, "is for controls whose squares do not enter the cost"),
    ],
)
def test_methods_that_do_not_fit_are_refused(changed, words):
    with pytest.raises(BadInput, match=words):
        solve(options(instance.load("ends-5-free"), **changed))


def test_the_ball_is_kept_and_left_in_time():
    found = by_search.collocation(instance.load("return-to-orbit-ball"))
    assert found.status is Status.CONVERGED
    norm = np.hypot(*found.u)
    assert norm.max() <= 0.05 * (1.0 + 1e-12)
    at = [np.interp(t, found.times, norm) for t in found.switching_times[0]]
    assert at == pytest.approx([0.05, 0.05], rel=1e-4)
    assert found.switching_times[0] == found.switching_times[1]
