"""The direct search: derivatives against differences, extremals against those of other methods, answers against CasADi.

The costs of strangers' problems are from CasADi with Ipopt, from many starts on two meshes.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.sparse import csc_matrix, csr_matrix, tril
from sympy import cos, sin, sqrt

import satsym
from satsym import instance as instances
from satsym import solvers
from satsym.instance import Instance
from satsym.solvers import by_search, improving
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.iteration import MOST_ITERATIONS, Limits, Meter
from satsym.solvers.multipoint import equations, laws, newton
from satsym.solvers.search import following, mesh, motion, nlp, order, solving
from satsym.solvers.search.coarse import at_edge
from satsym.solvers.search.controls import controls_of, rates
from satsym.solvers.search.durations import first_duration
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.reading import extremals, levels
from satsym.solvers.search.sizes import sizes_of
from satsym.solvers.search.starts import planning
from satsym.solvers.search.tried import Past
from satsym.status import Status, Verdict
from satsym.symbolic import Angle, Ball, Box, FirstOrder, Problem, Variable, symbols_of, t

SHIPPED = (
    "soft-return",  # free controls
    "return-to-orbit",  # a terminal cost or constraints
    "bryson-denham",  # a path constraint
    "transfer-fuel",  # the norm of a vector
    "double-integrator-fuel",  # a magnitude
    "reorientation",  # a free time
    "transfer-time",
    "ends-3-given-time",
)
LIMITS = Limits(MOST_ITERATIONS, np.inf)


def programme_of(case: Instance, intervals: int = 12) -> Programme:
    controls = controls_of(case)
    assert controls is not None
    with np.errstate(all="ignore"):
        duration = first_duration(case, controls)
        return Programme(case, controls, [np.linspace(0.0, 1.0, intervals + 1)], sizes_of(case, controls, duration))


def begun_near(programme: Programme, seed: int) -> np.ndarray:
    with np.errstate(all="ignore"):
        w = planning.begun(programme, planning.Plan(noise=0.05, seed=seed))
    w = w + 1e-2 * np.random.default_rng(seed).normal(size=len(w))
    return np.clip(w, *programme.bounds)


@pytest.mark.parametrize("name", SHIPPED)
def test_derivatives_are_those_of_values(name: str) -> None:
    programme = programme_of(instances.load(name))
    rng, h = np.random.default_rng(3), 1e-6
    w, ahead, multipliers = (
        begun_near(programme, 1),
        rng.normal(size=programme.unknowns),
        rng.normal(size=programme.rows),
    )

    def jacobian(at: np.ndarray) -> csr_matrix:
        shape = programme.rows, programme.unknowns
        return csr_matrix((programme.jacobian(at), programme.jacobian_places), shape=shape)

    def slope(at: np.ndarray) -> np.ndarray:
        return 0.7 * programme.gradient(at) + jacobian(at).T @ multipliers

    lower = csr_matrix((programme.hessian(w, multipliers, 0.7), programme.hessian_places), shape=(len(w), len(w)))
    whole = lower + tril(lower, -1).T
    for exact, function in (
        (jacobian(w) @ ahead, programme.values),
        (whole @ ahead, slope),
        (np.array([programme.gradient(w) @ ahead]), lambda at: np.array([programme.objective(at)])),
    ):
        difference = (function(w + h * ahead) - function(w - h * ahead)) / (2.0 * h)
        assert np.abs(exact - difference).max() <= 1e-6 * max(np.abs(difference).max(), 1e-6)


PLANE = (*(Variable(name, name) for name in ("x", "y", "vx", "vy")), Variable("m", "m", positive=True))
PX, PY, PVX, PVY, PM = symbols_of(PLANE)


def thrust(names: tuple[str, str], pushes: tuple, flow: object, sets: dict) -> Problem:
    controls = tuple(Variable(name, name, kind="angle" if name == "b" else "real") for name in names)
    ax, ay = pushes
    moving = FirstOrder(
        name="plane",
        title="P",
        states=PLANE,
        controls=controls,
        parameters=(),
        rates={PX: PVX, PY: PVY, PVX: ax / PM - PX, PVY: ay / PM, PM: -flow},
    )
    return Problem(name="thrusting", title="T", model=moving, running_cost=flow, control_sets=sets)


U, V, T, B = (Variable(name, name) for name in ("U", "V", "T", "b"))
(u, v, throttle), (b,) = symbols_of((U, V, T)), symbols_of((Variable("b", "b", kind="angle"),))
VECTOR = thrust(("U", "V"), (u, v), sqrt(u**2 + v**2) / 3, {"engine": Ball("U", "V")})
STEERED = thrust(
    ("T", "b"), (throttle * cos(b), throttle * sin(b)), throttle / 3, {"force": Box("T"), "way": Angle("b")}
)
BEGUN = {"x": 1.0, "y": 0.0, "vx": 0.1, "vy": 0.2, "m": 1.0}


@pytest.mark.parametrize(
    ("problem", "control"), [(VECTOR, {"engine": (0.0, 0.8)}), (STEERED, {"T": (0.0, 0.8)})], ids=["norm", "angle"]
)
def test_rates_by_nodes_are_rates(problem: Problem, control: dict) -> None:
    given = {"max_norm": 0.8} if "engine" in control else control
    case = satsym.Instance.of(problem, initial=BEGUN, final={"x": 0.0, "y": 0.5}, tf=2.0, control=given).case
    controls = controls_of(case)
    assert controls is not None
    assert controls.lifts
    rng = np.random.default_rng(5)
    x, many = np.array(case.initial)[:, None] * rng.uniform(0.5, 2.0, (5, 20)), rng.uniform(-0.5, 0.5, (2, 20))
    t = np.zeros(20)
    by_nodes = sum(weight * rates(case, t, x, node, ()) for node, weight in controls.nodes(controls.variables(many)))
    np.testing.assert_allclose(by_nodes, rates(case, t, x, many, ()), atol=1e-13)


@pytest.mark.parametrize(
    ("name", "error"), [("soft-return", 1e-12), ("return-to-orbit", 1e-12), ("ends-3-given-time", 1e-11)]
)
def test_extremals_are_those_of_collocation(name: str, error: float) -> None:
    case = instances.load(name)
    known = solvers.solve(case, examined=False)
    found = order.searched(case, LIMITS, partial(extremals.exact, case))
    assert found is not None
    assert found.cost == pytest.approx(known.objective, rel=error, abs=1e-15)
    assert solving.answered(case, found).lam[:, 0] == pytest.approx(known.lam[:, 0], rel=1e-7, abs=1e-10)


def pendulum() -> Problem:
    states, (force,) = (Variable("x", "x"), Variable("v", "v")), (Variable("u", "u"),)
    (angle, speed), (torque,) = symbols_of(states), symbols_of((force,))
    moving = FirstOrder(
        name="swing",
        title="S",
        states=states,
        controls=(force,),
        parameters=(),
        rates={angle: speed, speed: torque - sin(angle) / 2},
    )
    return Problem(name="swung", title="S", model=moving, running_cost=torque**2 / 2)


def test_a_free_initial_velocity_is_looked_for_far_from_its_guess() -> None:
    start, end = {"x": 1.3, "v": "free"}, {"x": -1.3, "v": -0.8}
    found = satsym.solve(satsym.Instance.of(pendulum(), initial=start, final=end, tf=9.0))
    assert found.status is Status.CONVERGED
    assert found.objective <= 0.00983
    given = satsym.Instance.of(pendulum(), initial={"x": 1.3, "v": found.x[1, 0]}, final=end, tf=9.0)
    alone = solvers.solve(given.case, examined=False)
    assert alone.objective >= found.objective - 1e-12


def three_bodies() -> Problem:
    states = tuple(Variable(name, name) for name in ("x", "y", "vx", "vy"))
    controls, mu = (Variable("ax", "ax"), Variable("ay", "ay")), 0.01215
    (px, py, vx, vy), (ax, ay) = symbols_of(states), symbols_of(controls)
    near, far = sqrt((px + mu) ** 2 + py**2), sqrt((px - 1 + mu) ** 2 + py**2)
    along = 2 * vy + px - (1 - mu) * (px + mu) / near**3 - mu * (px - 1 + mu) / far**3 + ax
    across = -2 * vx + py - (1 - mu) * py / near**3 - mu * py / far**3 + ay
    moving = FirstOrder(
        name="bodies",
        title="B",
        states=states,
        controls=controls,
        parameters=(),
        rates={px: vx, py: vy, vx: along, vy: across},
    )
    return Problem(name="passing", title="P", model=moving, running_cost=(ax**2 + ay**2) / 2)


@pytest.mark.slow
def test_a_passage_between_libration_points_is_the_cheaper_one() -> None:
    given = instances_of_libration()
    found = satsym.solve(given)
    assert found.status is Status.CONVERGED
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    assert found.objective <= 0.04169


def instances_of_libration() -> satsym.Instance:
    start = {"x": 0.835, "y": 0.043, "vx": -0.04, "vy": 0.007}
    end = {"x": 1.15568, "y": 0.0, "vx": 0.0, "vy": 0.0}
    return satsym.Instance.of(three_bodies(), initial=start, final=end, tf=2.7)


def relative() -> Problem:
    """Relative motion on a circular orbit by a thrust of a size that is looked for: the least that arrives."""
    states = tuple(Variable(name, name) for name in ("x", "y", "z", "vx", "vy", "vz"))
    controls = tuple(Variable(name, name) for name in ("ux", "uy", "uz"))
    largest = Variable("am", "a", default=0.03, positive=True)
    (px, py, pz, vx, vy, vz), (ux, uy, uz), (a,) = symbols_of(states), symbols_of(controls), symbols_of((largest,))
    n = 0.001078007015452326
    pushed = {vx: 3 * n**2 * px + 2 * n * vy + a * ux, vy: -2 * n * vx + a * uy, vz: -(n**2) * pz + a * uz}
    moving = FirstOrder(
        name="relative",
        title="R",
        states=states,
        controls=controls,
        parameters=(largest,),
        rates={px: vx, py: vy, pz: vz, **pushed},
    )
    sets = {"engine": Ball("ux", "uy", "uz")}
    return Problem(name="smallest", title="S", model=moving, running_cost=0, terminal_cost=a, control_sets=sets)


def elements() -> Problem:
    """Thrust of full size on a body whose orbit is described by modified equinoctial elements, in least time."""
    names = ("p", "ex", "ey", "hx", "hy", "longitude")
    states = tuple(Variable(name, name, positive=name == "p") for name in names)
    controls = tuple(Variable(name, name) for name in ("radial", "along", "across"))
    (p, ex, ey, hx, hy, angle), (radial, along, across) = symbols_of(states), symbols_of(controls)
    mu, thrust, flow, mass = 5165.8620912, 777.6, 1.42e-2, 1500.0
    push, per_speed = thrust / (mass - flow * thrust * t), sqrt(p / mu)
    w = 1 + ex * cos(angle) + ey * sin(angle)
    tilt, turned = hx * sin(angle) - hy * cos(angle), per_speed / w
    rates = {
        p: push * along * 2 * p * turned,
        ex: push
        * (
            per_speed * (radial * sin(angle) + along * (cos(angle) + (ex + cos(angle)) / w))
            - across * turned * tilt * ey
        ),
        ey: push
        * (
            per_speed * (along * (sin(angle) + (ey + sin(angle)) / w) - radial * cos(angle))
            + across * turned * tilt * ex
        ),
        hx: push * across * turned * (1 + hx**2 + hy**2) / 2 * cos(angle),
        hy: push * across * turned * (1 + hx**2 + hy**2) / 2 * sin(angle),
        angle: w**2 / (p * per_speed) + push * across * turned * tilt,
    }
    moving = FirstOrder(name="elements", title="E", states=states, controls=controls, parameters=(), rates=rates)
    return Problem(
        name="to_geo",
        title="T",
        model=moving,
        running_cost=1,
        control_sets={"thrust": Ball("radial", "along", "across")},
    )


@pytest.mark.slow
def test_the_quickest_way_from_a_transfer_orbit_to_the_geostationary_one_is_certified() -> None:
    """By a thrust of 60 N, in hours and thousands of kilometres: CasADi with Ipopt comes to 14.80036 h.

    Nothing moves by ey at the apogee but through the sine of half a turn, which is rounded to 1e-16: that is no scale.
    """
    start = {"p": 11.625, "ex": 0.75, "ey": 0.0, "hx": 0.0612, "hy": 0.0, "longitude": np.pi}
    end = {"p": 42.165, "ex": 0.0, "ey": 0.0, "hx": 0.0, "hy": 0.0}
    given = satsym.Instance.of(elements(), initial=start, final=end, tf="free", control={"max_norm": 1.0})
    assert (two_point(given.case, 15.0).scale.state <= 100.0).all()
    found = satsym.solve(given)
    assert found.objective == pytest.approx(14.80036435, rel=1e-8)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_the_smallest_engine_that_arrives_is_found_with_its_parameter() -> None:
    start = {"x": 0.0, "y": 0.0, "z": -20.0, "vx": 0.0, "vy": 0.0, "vz": 0.0}
    end = {"x": 100.0, "y": 0.0, "z": 20.0, "vx": 0.0, "vy": -0.21560140309046522, "vz": 0.0}
    given = {"parameters": {"am": "free"}, "guess": {"parameter": {"am": 0.002}}, "control": {"max_norm": 1.0}}
    case = satsym.Instance.of(relative(), initial=start, final=end, tf=800.0, **given).case
    found = order.searched(case, LIMITS, partial(extremals.exact, case))
    assert found is not None
    solution = solving.answered(case, found)
    assert solution.objective == pytest.approx(8.1526e-4, rel=1e-4)
    assert solution.instance.parameters[0] == pytest.approx(solution.objective, rel=1e-12)


def test_arcs_at_bounds_that_are_read_are_those_of_the_switching_solver() -> None:
    for name, cost, switches in (
        ("double-integrator-time", 2.0, [1.0]),
        ("double-integrator-fuel", None, None),  # rest between two bounds
        ("catalyst", None, None),  # a singular arc
    ):
        case = instances.load(name)
        found = order.searched(case, LIMITS, partial(levels.exact, case))
        assert found is not None
        known = solvers.solve(case, examined=False)
        assert found.objective == pytest.approx(cost or known.objective, rel=1e-12)
        assert found.switching_times[0] == pytest.approx(switches or known.switching_times[0], rel=1e-8)


@pytest.mark.parametrize(
    ("name", "cost"), [("bryson-denham", 4.0), ("breakwell", 40.0 / 9.0), ("rayleigh-mixed", None)]
)
def test_boundary_arcs_that_are_read_are_those_of_the_solver_of_path_constraints(name: str, cost: float | None) -> None:
    case = instances.load(name)
    assert solving.applies(case)
    found = order.searched(case, LIMITS, partial(solving.exact, case))
    assert found is not None
    known = solvers.solve(case, examined=False)
    assert found.objective == pytest.approx(cost or known.objective, rel=1e-12)
    assert [one.kind for one in found.events] == [one.kind for one in known.events]


def test_a_final_state_that_follows_from_others_only_keeps_its_sign() -> None:
    programme = replace(programme_of(instances.load("ends-1-given")), loose="r")
    low, high = (programme.unpacked(bound)[0][:, -1] for bound in programme.bounds)
    given = programme.instance.final["r"]
    assert isinstance(given, float)
    assert 0.0 < low[0] < given < high[0]
    assert low[1] == high[1]


def test_the_first_duration_is_of_the_size_of_the_least() -> None:
    for name, least in (("double-integrator-time", 2.0), ("lapan-minimum-time", 115.5), ("brachistochrone", 1.80)):
        case = instances.load(name)
        controls = controls_of(case)
        assert controls is not None
        duration = first_duration(case, controls)
        assert 0.1 * least < duration < 20.0 * least
        assert (sizes_of(case, controls, duration).states > 1e-6).all()


def test_states_set_equal_at_the_end_have_scales_alike() -> None:
    states = tuple(Variable(name, name, "1") for name in ("x", "v", "X"))
    controls = (Variable("u", "u", "1"),)
    x, v, target = symbols_of(states)
    (u,) = symbols_of(controls)
    model = FirstOrder(
        name="pursuit",
        title="P",
        states=states,
        controls=controls,
        parameters=(),
        rates={x: v, v: u, target: 1},
    )
    problem = Problem(name="pursued", title="P", model=model, running_cost=u**2 / 2, terminal_constraints=(x - target,))
    case = satsym.Instance.of(problem, initial={"x": 1e-6, "v": 0.0, "X": 2.0}, tf=1.0).case
    assert programme_of(case).sizes.states[0] == pytest.approx(2.0)
    steep = replace(problem, name="rooted", terminal_constraints=(sqrt(v) - target,))  # without bound at the start
    case = satsym.Instance.of(steep, initial={"x": 1.0, "v": 0.0, "X": 2.0}, tf=1.0).case
    assert programme_of(case).sizes.states[2] == pytest.approx(2.0)


def test_the_least_thrust_is_zero_only_where_engines_may_be_off() -> None:
    case = instances.load("transfer-fuel")
    names = [extremals._kept(case, norm, label).name for norm, label in ((1.0, 1), (0.1, 0), (0.0, 0))]
    assert names == ["+", "-", "0"]


def test_what_fails_its_certificate_is_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    case = instances.load("double-integrator-time")
    found = by_search.instead(case, None, certified=True)
    assert found is not None
    assert found.certificate is not None
    failed = replace(found.certificate, checks=(), verdict=Verdict.FAILED)
    monkeypatch.setattr(improving, "examined", lambda *_: (failed, None))
    assert by_search.instead(case, None, certified=True) is None


def test_corners_next_to_a_node_of_every_mesh_are_junctions() -> None:
    """The control leaves its bound at 0.8003, next to a node of meshes of 40 and of 80 intervals of two."""
    states, controls = (Variable("s", "s"),), (Variable("w", "w"),)
    (s,), (w,) = symbols_of(states), symbols_of(controls)
    model = FirstOrder(name="rate", title="R", states=states, controls=controls, parameters=(), rates={s: w})
    held = Problem(name="held", title="H", model=model, running_cost=(w**2 + s**2) / 2, control_set="box")
    case = satsym.Instance.of(held, initial={"s": 2.0}, tf=2.0, control={"w": [-1.0, 1.0]}).case
    left = brentq(lambda at: at * np.tanh(at) - 1.0, 0.5, 2.0, xtol=1e-15)  # how much time is left, and the state then
    found = order.searched(case, LIMITS, partial(extremals.exact, case))
    assert found is not None
    assert found.times == pytest.approx([0.0, 2.0 - left, 2.0], abs=1e-12)
    box = ((8.0 - left**3) / 3.0 + 2.0 - left) / 2.0 + np.tanh(left) * left**2 / 2.0
    assert found.cost == pytest.approx(box, rel=1e-12)


def test_derivatives_on_uneven_intervals_are_those_of_residuals() -> None:
    """Two arcs of which the junction's time is unknown, the final time, and a free parameter."""
    case = replace(instances.load("soft-return"), tf=None)
    law, n = laws.derived(case, case.control_set.arguments), len(case.initial)
    junction = laws.Junction(lambda t, z, p: z[0] - t)
    meshes = np.array([0.0, 0.1, 0.4, 1.0]), np.array([0.0, 0.7, 1.0])
    problem = equations.Problem(case, (law, law), (junction,), meshes, (np.ones(2 * n), 1.0, np.ones(0)))
    rng, times = np.random.default_rng(5), np.linspace(0.0, 1.3, 30)
    z = rng.uniform(0.5, 1.0, (2 * n, 1)) + 0.1 * np.sin(times)
    v = equations.begun(problem, times, z, np.array([0.0, 0.4, 1.3]), np.zeros(0), np.zeros(0))
    along, step = rng.normal(size=len(v)), 1e-6
    ahead, behind = (equations.system(problem, v + sign * step * along, sloped=False)[0] for sign in (1.0, -1.0))
    assert equations.system(problem, v)[1] @ along == pytest.approx((ahead - behind) / (2.0 * step), rel=1e-6, abs=1e-7)


def test_values_between_points_of_uneven_intervals_are_those_of_the_motion() -> None:
    case = instances.load("soft-return")
    law, n, edges = laws.derived(case, case.control_set.arguments), len(case.initial), np.array([0.0, 0.05, 0.3, 1.0])
    problem = equations.Problem(case, (law,), (), (edges,), (np.ones(2 * n), 1.0, np.ones(0)))
    times = np.linspace(0.0, case.tf, 4001)
    z = np.array([np.sin(k + times / case.tf) for k in range(2 * n)])
    v = equations.begun(problem, times, z, times[[0, -1]], np.zeros(0), np.zeros(0))
    shares = np.array([0.0, 0.02, 0.05, 0.17, 0.8, 1.0])
    known = np.array([np.sin(k + shares) for k in range(2 * n)])
    assert equations.between(problem, v, 0, shares) == pytest.approx(known, abs=1e-5)


def test_singular_derivatives_end_an_attempt(monkeypatch: pytest.MonkeyPatch) -> None:
    case = instances.load("soft-return")
    law, n = laws.derived(case, case.control_set.arguments), len(case.initial)
    problem = equations.Problem(case, (law,), (), (np.linspace(0.0, 1.0, 5),), (np.ones(2 * n), 1.0, np.ones(0)))
    count = problem.layout.count
    monkeypatch.setattr(newton, "system", lambda *_, **__: (np.ones(count), csc_matrix((count, count))))
    assert newton.newton(problem, np.zeros(count), LIMITS) is None


@pytest.mark.parametrize("smoothing", [1e-1, 1e-2, 1e-3])
def test_what_smoothing_adds_to_a_cost_is_taken_from_it(smoothing: float) -> None:
    """Two burns that last b with b (T - b) = 1 are cheapest, and cost 2 b."""
    case, least = instances.load("double-integrator-fuel"), 3.0 - np.sqrt(5.0)
    even = programme_of(case, 80)
    programme = Programme(case, even.controls, even.meshes, even.sizes, smoothing)
    found = nlp.solve(programme, planning.begun(programme, planning.Plan()))
    assert found.solved
    plain = programme.objective(found.unknown) * programme.sizes.cost
    assert plain - least > 10.0 * abs(found.objective - least)
    assert found.objective == pytest.approx(least, rel=max(2.0 * smoothing**2, 3e-5))


def test_no_smoothing_takes_anything_from_the_largest_norm() -> None:
    """In the least time thrust is full all along, which a norm that is rounded off would not reach."""
    case = replace(instances.load("double-integrator-fuel"), tf=2.0 + 1e-9)
    even = programme_of(case)
    programme = Programme(case, even.controls, even.meshes, even.sizes, 1e-1)
    found = nlp.solve(programme, planning.begun(programme, planning.Plan()))
    assert found.solved
    u = programme.controls.controls(programme.unpacked(found.unknown)[1])
    assert np.abs(u).min() > 0.999


def test_programmes_end_with_the_work_that_is_allowed() -> None:
    programme = programme_of(instances.load("reorientation"))
    limits = Limits(MOST_ITERATIONS, np.inf, work=3.5 * programme.unknowns)
    with np.errstate(all="ignore"):
        start = planning.begun(programme, planning.Plan())
    found = nlp.solve(programme, start, limits)
    assert not found.solved
    assert found.iterations <= 5


@pytest.mark.parametrize(
    ("residual", "costs", "came"),
    [
        (0.5, [3.0, 2.0, 0.9], (0.9, "exact")),
        (0.5, [3.0, 2.99, 0.9], (2.99, None)),
        (1e-3, [3.0, 2.0, 0.9], (3.0, None)),
        (0.5, [3.0, 1.0], (1.0, None)),
    ],
    ids=["falls below", "stays dear", "is resolved", "falls to the same"],
)
def test_a_motion_that_only_a_coarse_mesh_makes_dear_is_followed(
    monkeypatch: pytest.MonkeyPatch, residual: float, costs: list[float], came: tuple[float, str | None]
) -> None:
    """Beside an answer of cost 1; the first of the costs is on a mesh with that residual."""
    found: Any = SimpleNamespace(objective=costs[0])
    monkeypatch.setattr(following, "finer", lambda *_: (SimpleNamespace(cost=cost) for cost in costs))
    monkeypatch.setattr(following, "motion", lambda one: one)
    monkeypatch.setattr(following, "refined", lambda _: ([], residual))
    assert following.followed(found, LIMITS, 1.0, lambda at: (at.cost, "exact"), Meter()) == (*came, False)


@pytest.mark.parametrize(
    ("residuals", "meshes", "unsettled"),
    [([60.0, 70.0, 1e-3], 2, False), ([60.0, 0.5, 0.4], 3, True), ([60.0, 3.0, 2.0], 3, False)],
    ids=["steps over something", "is resolved, but settles nowhere", "is not resolved"],
)
def test_a_motion_that_no_mesh_resolves_is_no_evidence_of_a_cheaper_one(
    monkeypatch: pytest.MonkeyPatch, residuals: list[float], meshes: int, unsettled: bool
) -> None:
    """Beside an answer of cost 1; costs change so much from mesh to mesh that nothing follows from the last."""
    made = [SimpleNamespace(cost=cost, residual=one) for cost, one in zip((0.5, 0.9, 0.6), residuals, strict=True)]
    looked: list[Any] = []
    monkeypatch.setattr(following, "finer", lambda *_: iter(made))
    monkeypatch.setattr(following, "motion", lambda one: looked.append(one) or one)
    monkeypatch.setattr(following, "refined", lambda one: ([], one.residual))
    monkeypatch.setattr(following, "_moved", lambda *_: iter(()))
    found: Any = SimpleNamespace(objective=0.5, residual=60.0, programme=SimpleNamespace(intervals=40))
    cost, answer, left = following.followed(found, LIMITS, 1.0, lambda at: None, Meter())
    assert np.isnan(cost)
    assert answer is None
    assert left is unsettled
    assert looked[:meshes] == made[:meshes]
    assert made[meshes:] == [one for one in made if one not in looked]


@pytest.mark.parametrize(
    ("residuals", "moves"),
    [([0.5, 0.3, 0.2, 1e-3, 0.0], 3), ([0.5, 0.3, 0.29], 1), ([1e-3], 0)],
    ids=["is resolved in the end", "falls no further", "is resolved"],
)
def test_a_mesh_follows_a_motion_while_its_residual_falls(
    monkeypatch: pytest.MonkeyPatch, residuals: list[float], moves: int
) -> None:
    programme = SimpleNamespace(intervals=40, phases=1, smoothing=1e-3)
    made = [SimpleNamespace(objective=0.5, residual=one, programme=programme, solved=True) for one in residuals]
    laid, left = list[int](), iter(made[1:])
    monkeypatch.setattr(following, "refined", lambda one: ([], one.residual))
    monkeypatch.setattr(following, "motion", lambda one: SimpleNamespace(times=None, x=None))
    monkeypatch.setattr(following, "graded", lambda times, x, count: laid.append(count))
    monkeypatch.setattr(following, "_again", lambda *_: next(left))
    found: Any = made[0]
    assert list(following._moved(found, LIMITS, 1.0)) == made[1 : moves + 1]
    assert laid == [40, 40, 40, 80][: len(laid)]
    assert not list(following._moved(found, LIMITS, 0.4))  # it is not cheaper


@pytest.mark.parametrize(("noise", "converges"), [(0.0, True), (1e-10, True), (1e-6, False)])
def test_rounding_that_the_equations_amplify_ends_the_iteration(
    monkeypatch: pytest.MonkeyPatch, noise: float, converges: bool
) -> None:
    """The residual of v^2 = 2 has an error that is different at each call."""
    rng = np.random.default_rng(0)

    def system(_: Any, v: np.ndarray, sloped: bool = True) -> tuple[np.ndarray, Any]:
        return v**2 - 2.0 + noise * rng.normal(), csc_matrix(np.diag(2.0 * v)) if sloped else None

    monkeypatch.setattr(newton, "system", system)
    problem: Any = SimpleNamespace(units=lambda: np.ones(1), n=1)
    found = newton.newton(problem, np.array([1.5]), LIMITS)
    assert (found is not None) is converges
    if found is not None:
        assert found.unknown[0] == pytest.approx(np.sqrt(2.0), abs=max(newton.SOLVED, 3.0 * noise))
        assert found.step <= max(newton.SOLVED, 3.0 * noise)


def test_a_comparison_goes_on_where_the_one_with_a_dearer_answer_ended() -> None:
    case, past = instances.load("return-to-orbit"), Past()
    exact = partial(solving.exact, case)

    def beside(cost: float) -> Any:
        work = replace(LIMITS, work=solving.WORK)
        return order.others(case, work, exact, cost, lambda one: one.objective, past=past)

    cheaper = next(beside(1e3))
    assert cheaper.exact is not None
    again = list(beside(cheaper.exact.objective))
    plans = [one.plan for one in again]
    assert again[0].plan == cheaper.plan
    assert again[0].exact is None
    assert len(plans) == len(set(plans)) > 3
    assert [one.plan for one in past.tried] == plans


@pytest.mark.parametrize(("name", "cost"), [("return-to-orbit", None), ("bryson-denham", 4.0)])
def test_a_motion_that_costs_less_counts_even_if_no_extremal_is_found_near_it(name: str, cost: float | None) -> None:
    """Bryson and Ho, 3.11: 4/(9 l), with l = 1/9."""
    case = instances.load(name)
    cost = solvers.solve(case).objective if cost is None else cost
    work = replace(LIMITS, work=solving.WORK)
    dear = order.others(case, work, lambda at, limits: None, 2.0 * cost, lambda one: one)
    assert next(dear).cost == pytest.approx(cost, rel=1e-4)
    near = order.others(case, work, lambda at, limits: None, cost * (1.0 + 3e-5), lambda one: one)
    assert next(near).cost == cost * (1.0 + 3e-5)


@pytest.mark.parametrize(("name", "unsettled"), [("return-to-orbit", True), ("bryson-denham", False)])
def test_a_cheaper_motion_is_unsettled_where_no_mesh_decides(
    monkeypatch: pytest.MonkeyPatch, name: str, unsettled: bool
) -> None:
    """With path constraints it steps over one, mostly."""
    monkeypatch.setattr(order, "followed", lambda *_: (np.nan, None, True))
    one = next(order.others(instances.load(name), replace(LIMITS, work=solving.WORK), lambda *_: None, 1e3, float))
    assert np.isnan(one.cost)
    assert one.unsettled is unsettled


@pytest.mark.parametrize(("residual", "pieces"), [(0.9, mesh.MOST_PIECES), (1.1, mesh.HALVES)])
def test_intervals_are_halved_at_most_where_a_mesh_does_not_resolve_its_motion(
    monkeypatch: pytest.MonkeyPatch, residual: float, pieces: int
) -> None:
    programme = programme_of(instances.load("return-to-orbit"))
    with np.errstate(all="ignore"):
        found = nlp.solve(programme, planning.begun(programme, planning.Plan()))
    monkeypatch.setattr(mesh, "_residuals", lambda _: np.where(np.arange(programme.intervals) == 3, residual, 0.0))
    (edges,), largest = mesh.refined(found)
    assert largest == residual
    assert len(edges) - 1 == programme.intervals - 1 + pieces


def test_a_motion_that_steps_over_a_constraint_is_seen_to_violate_it() -> None:
    case = instances.load("bryson-denham")
    *_, found = next(order.started(case, replace(LIMITS, work=solving.WORK), ""))
    at = motion.motion(found)
    assert not motion.violates(at)
    over = np.array(at.x)
    over[0, 1::2], over[0, 2::2] = 0.0, 0.3  # the wall is at 1/9
    assert motion.violates(replace(at, x=over))


def test_a_free_duration_at_either_limit_is_at_the_edge() -> None:
    programme = programme_of(instances.load("double-integrator-time"))
    at = programme.first_duration
    shortest, longest = (float(w[at]) for w in programme.bounds)
    for duration, edge in ((shortest, True), (longest, True), (1.5 * shortest, False), (0.5 * longest, False)):
        w = programme.bounds[0].copy()
        w[at] = duration
        assert at_edge(SimpleNamespace(programme=programme, unknown=w)) is edge  # type: ignore[arg-type]
