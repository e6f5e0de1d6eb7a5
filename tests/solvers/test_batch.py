"""Many problems at once: what is solved is what the single solver finds, and what is not says so."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from satsym import instance
from satsym.instance import Instance
from satsym.kernels import load
from satsym.solvers import linear
from satsym.solvers.batch.certificate import minima
from satsym.solvers.batch.corners import positive
from satsym.solvers.batch.many import Many
from satsym.solvers.batch.motion import motion
from satsym.solvers.batch.newton import Nodes, Outcome, transitions
from satsym.solvers.batch.solving import has_closed_form, in_closed_form, solved, solved_together
from satsym.solvers.by_search import collocation as solve
from tests.certificate.test_certificate import oscillator

BACKENDS = [False, pytest.param(True, marks=pytest.mark.slow)]
"""On arrays, and compiled, which takes half a minute where nothing was kept."""


def returns(count: int, width: float = 0.1, seed: int = 1) -> list[Instance]:
    """Returns to the orbit, with other weights of the controls."""
    case, rng = instance.load("return-to-orbit"), np.random.default_rng(seed)
    found = []
    for _ in range(count):
        initial = tuple(np.array([1.0, 0.0, 0.0, 1.0]) + width * rng.uniform(-1.0, 1.0, 4))
        parameters = list(case.parameters)
        parameters[case.model.spec.parameter_names.index("c1")] = 10.0 ** rng.uniform(-1.0, 1.0)
        found.append(replace(case, initial=initial, parameters=tuple(parameters)))
    return found


def together(cases: list[Instance], compiled: bool = False) -> tuple[Many, Nodes]:
    many = Many.of(cases[0], cases, compiled)
    return many, solved_together(many).nodes


@pytest.mark.parametrize("compiled", BACKENDS)
def test_answers_are_those_of_the_single_solver(compiled: bool) -> None:
    if compiled:
        pytest.importorskip("numba")
    cases = returns(40)
    many, nodes = together(cases, compiled)
    assert nodes.solved.mean() >= 0.95
    assert minima(many, nodes)[nodes.solved].all()
    for k in np.flatnonzero(nodes.solved)[::5]:
        single = solve(cases[k])
        size = np.abs(single.lam[:, 0]).max()
        assert np.abs(nodes.z[4:, 0, k] - single.lam[:, 0]).max() <= 1e-9 * size
        assert nodes.cost[k] == pytest.approx(single.objective, rel=1e-9)


def test_nothing_is_wrong_without_saying_so() -> None:
    """Far from the orbit steps are too long at first: they are made shorter until the error is small, or it is said."""
    cases = returns(60, width=0.35, seed=7)
    many, nodes = together(cases)
    fine = minima(many, nodes)
    assert (nodes.error[nodes.solved] <= 1e-12).all()
    for k in np.flatnonzero(fine)[::6]:
        single = solve(cases[k])
        size = np.abs(single.lam[:, 0]).max()
        same = np.abs(nodes.z[4:, 0, k] - single.lam[:, 0]).max() <= 1e-9 * size
        assert same or abs(single.objective - nodes.cost[k]) > 1e-6 * nodes.cost[k], "an extremal, but another one"


def test_each_has_its_own_status_and_does_nothing_to_others() -> None:
    cases = returns(10)
    hopeless = replace(cases[3], initial=(1e-6, 40.0, 900.0, -70.0))
    alone = Many.of(cases[0], cases, False)
    spoilt = Many.of(cases[0], [*cases[:3], hopeless, *cases[4:]], False)
    expected, found = solved(alone, alone.line), solved(spoilt, spoilt.line)
    others = np.arange(10) != 3
    assert not found.solved[3]
    assert not minima(spoilt, found)[3]
    assert (found.outcome == expected.outcome)[others].all()
    both = others & expected.solved
    assert np.array_equal(found.z[:, :, both], expected.z[:, :, both])


def test_bounds_that_are_met_are_left_to_others() -> None:
    case = instance.load("return-to-orbit")
    _, free = together([case, case])
    assert free.solved.all()
    for bound, met in ((10.0, False), (0.02, True)):
        many, nodes = together([replace(case, lower=(-bound,) * 2, upper=(bound,) * 2)] * 2)
        assert (nodes.outcome == (Outcome.BOUNDS if met else Outcome.SOLVED)).all()
        assert minima(many, nodes).all() == (not met)


@pytest.mark.parametrize(
    ("tf", "minimum"), [(0.5, True), (2.5, True), (3.0, True), (3.2, False), (4.0, False), (7.0, False)]
)
def test_no_extremal_beyond_its_conjugate_time_is_a_minimum(tf: float, minimum: bool, tmp_path: Path) -> None:
    case = oscillator(tf, {"y": float(np.cos(tf) + 0.3 * np.sin(tf))}, tmp_path / "oscillator.toml")
    many, nodes = together([case, replace(case, initial=(1.2,))])
    assert nodes.solved.all()
    assert -nodes.z[1, 0, 0] == pytest.approx(0.3, abs=1e-10)
    assert (minima(many, nodes) == minimum).all()
    units = (many.units / many.units[:, None])[:, :, None, None]
    assert (positive(transitions(many, nodes.z) * units) == minimum).all()


@pytest.mark.slow
@pytest.mark.parametrize("row", range(8))
def test_a_single_node_that_is_off_is_no_minimum(row: int) -> None:
    many, nodes = together(returns(3))
    assert minima(many, nodes).all()
    z = nodes.z.copy()
    z[row, 7, 1] += 1e-5 * np.abs(z[row, :, 1]).max()
    found = minima(many, replace(nodes, z=z))
    # the costate of an angle that nothing depends on is off by as much as that costate's own size
    assert found.tolist() == [True, False, True]


@pytest.mark.parametrize("factor", [1.0 + 1e-6, 0.9])
def test_a_cost_that_is_not_that_of_the_motion_is_no_minimum(factor: float) -> None:
    many, nodes = together(returns(3))
    cost = nodes.cost * np.array([1.0, factor, 1.0])
    assert minima(many, replace(nodes, cost=cost)).tolist() == [True, False, True]


@pytest.mark.slow
def test_compiled_steps_are_those_on_arrays() -> None:
    pytest.importorskip("numba")
    kernels = load("polar_orbit")
    bounds = (-np.inf, -np.inf, np.inf, np.inf)
    plain, quick = (motion(kernels, bounds, compiled) for compiled in (False, True))
    rng, count = np.random.default_rng(2), 37
    z, h, t = 1.0 + 0.2 * rng.uniform(-1.0, 1.0, (8, count)), rng.uniform(0.1, 0.4, count), rng.uniform(0, 1, count)
    p = np.ones((8, count))
    costing = np.concatenate([z, np.zeros((1, count))])
    pairs = [
        (one.rough(t, z, h, p, 2), one.accurate(t, z, h, p, 3), one.leap(t, costing, h, p, 6)) for one in (plain, quick)
    ]
    for a, b in zip(*(np.concatenate([row.ravel() for row in (*x, y, *w)]) for x, y, w in pairs), strict=True):
        assert abs(a - b) <= 1e-12 * max(abs(a), 1.0)
    for a, b in zip(plain.leap_varied(t, z, h, p, 5)[:2], quick.leap_varied(t, z, h, p, 5)[:2], strict=True):
        assert np.abs(a - b).max() <= 1e-12


@pytest.mark.parametrize(("method", "order", "parts"), [("rough", 4, 4), ("accurate", 8, 1)])
def test_steps_have_their_order(method: str, order: int, parts: int) -> None:
    kernels = load("polar_orbit")
    plain = motion(kernels, (-np.inf, -np.inf, np.inf, np.inf), False)
    z, p, t, h = 1.0 + 0.1 * np.arange(8.0)[:, None] / 8.0, np.ones((8, 1)), np.zeros(1), np.full(1, 0.8)
    exact = plain.accurate(t, z, h, p, 64)[:8]

    def error(count: int) -> float:
        found = plain.rough(t, z, h, p, count)[0] if method == "rough" else plain.accurate(t, z, h, p, count)[:8]
        return float(np.abs(found - exact).max())

    assert np.log2(error(parts) / error(2 * parts)) == pytest.approx(order, abs=0.7)


def test_where_nothing_is_solved_nobody_stumbles() -> None:
    case = replace(instance.load("return-to-orbit"), lower=(-0.1,) * 2, upper=(0.1,) * 2)
    many, nodes = together([replace(case, initial=(1e-6, 40.0 + k, 900.0, -70.0)) for k in range(3)])
    assert not nodes.solved.any()
    assert not minima(many, nodes).any()


def test_linear_problems_have_a_closed_form() -> None:
    """Against the single one; with bounds that some meet, and one whose end cannot be told apart from others."""
    case, rng = instance.load("double-integrator-energy"), np.random.default_rng(2)
    cases = [replace(case, initial=tuple(rng.uniform(-1.0, 1.0, 2).tolist()), tf=2.0) for _ in range(12)]
    many = Many.of(cases[0], cases, False)
    assert has_closed_form(many)
    nodes = in_closed_form(many)
    bound = nodes.outcome == Outcome.BOUNDS
    assert 0 < bound.sum() < 12
    fine = minima(many, nodes)
    assert (fine == nodes.solved).all()
    for k in np.flatnonzero(nodes.solved):
        single = linear.solve(cases[k])
        assert nodes.cost[k] == pytest.approx(single.objective, rel=1e-13)
        assert np.abs(nodes.z[2:, 0, k] - single.lam[:, 0]).max() <= 1e-13 * np.abs(single.lam[:, 0]).max()
        assert not len(single.switching_times[0])


def test_what_is_no_linear_problem_is_left_to_shooting() -> None:
    assert not has_closed_form(Many.of(returns(2)[0], returns(2), False))
