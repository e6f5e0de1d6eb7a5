"""Multiple shooting: the same answers as collocation by another route, and what its parts promise."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from satsym import instance
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import by_search, shooting, solve
from satsym.solvers.certificate.conditions import boundary_residual
from satsym.solvers.certificate.reintegration.flow import flow
from satsym.solvers.cold_start import paths
from satsym.solvers.collocation.scaling import two_point as scaled
from satsym.solvers.iteration import Limits
from satsym.solvers.revolutions import with_cheapest_turns
from satsym.solvers.shooting.arcs import Arcs
from satsym.solvers.shooting.newton import doubled, newton
from satsym.solvers.shooting.solving import without_guess
from satsym.status import Status
from tests.house.test_floors import run_satsym
from tests.solvers.test_two_point import missed
from tests.support.samples import EASY, HARD, Population

TURN = 2.0 * np.pi
LIMITS = Limits(500, float("inf"))
ORBIT = ("return-to-orbit", "return-to-orbit-006", "return-to-orbit-005", "return-to-orbit-ball")
GEO = ("return-to-geo-wide", "return-to-geo")
ENDS = ("ends-1-given", "ends-2-given-state", "ends-3-given-time", "ends-4-rendezvous", "ends-5-free")
COSTATES = np.array([0.13817547355, 0.02984866111, -0.00567694889, 0.08773937141])
"""Of return-to-orbit. Pinned: computed by other programs, to the digits given."""


def options(case: Instance, **changed: Any) -> Instance:
    return replace(case, solver=msgspec.structs.replace(case.solver, **changed))


def shot(case: Instance) -> Solution:
    found = by_search.shooting(case)
    assert found.status is Status.CONVERGED, found.message
    assert found.method == "shooting"
    return found


def again(found: Solution) -> float:
    """Boundary residual of the flow from the initial costates, integrated by other means."""
    there = flow(found)
    assert there is not None
    return boundary_residual(found, there)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*ORBIT, *GEO, *ENDS])
def test_it_finds_what_collocation_finds(name: str):
    """The rounding of 42164 km is 1e-12 of the 5 km that the geostationary satellite is off."""
    mine, other = shot(instance.load(name)), by_search.collocation(instance.load(name))
    assert mine.objective == pytest.approx(other.objective, rel=1e-10)
    assert mine.lam[:, 0] == pytest.approx(other.lam[:, 0], rel=1e-10, abs=1e-10 * np.abs(other.lam[:, 0]).max())
    assert mine.times[-1] == pytest.approx(other.times[-1], rel=1e-12)
    assert again(mine) < (1e-9 if name in GEO else 1e-11)
    for times, others in zip(mine.switching_times, other.switching_times, strict=True):
        assert times == pytest.approx(others, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "cost"), [(ORBIT[0], 0.0031946551089), (ORBIT[1], 0.0032333506505), (ORBIT[2], 0.0033636292587)]
)
def test_costs_are_what_other_programs_find(name: str, cost: float):
    """Pinned."""
    assert shot(instance.load(name)).objective == pytest.approx(cost, rel=2e-11)


def test_its_answers_are_certified():
    found = solve(options(instance.load("return-to-orbit-006"), method="shooting"))
    assert found.method == "shooting"
    assert found.certificate is not None
    assert found.certificate.verdict == "certified"
    assert found.certificate.dynamics_defect < 1e-11


def straight(name: str, arcs: int, steps: int, compiled: bool = False) -> Arcs:
    """Arcs of a shipped instance on a straight line, without costates."""
    case = instance.load(name)
    case = replace(case, model=case.model.compiled()) if compiled else case
    problem = scaled(case, case.tf or 5.0)
    mesh = np.linspace(0.0, 1.0, arcs + 1)
    states = paths.first(problem)(mesh)
    return Arcs(problem, mesh, np.append(states, np.zeros_like(states), axis=0), problem.theta, steps)


def test_newton_comes_from_a_straight_line():
    outcome = newton(straight("return-to-orbit", 6, 4), LIMITS)
    assert outcome.matching is not None
    arcs, error = doubled(outcome.arcs, outcome.matching)
    assert error < 1e-12
    assert (arcs.nodes[4:, 0] * arcs.problem.scale.both[4:, 0]) == pytest.approx(COSTATES, abs=2e-11)
    assert arcs.cost() * arcs.problem.scale.cost == pytest.approx(0.0031946551089, rel=2e-11)


def held(compiled: bool) -> Arcs:
    """Solved arcs along which the second control is at its bound for a while, which a node ends."""
    problem = straight("return-to-orbit-005", 6, 3, compiled).problem
    found = without_guess(instance.load("return-to-orbit-005"), LIMITS).path
    assert isinstance(found, Arcs)
    return replace(found, problem=replace(found.problem, instance=problem.instance), steps=3)


@pytest.mark.parametrize("arcs", [lambda: straight("return-to-orbit", 5, 3), lambda: held(False)], ids=["free", "held"])
def test_variations_are_the_derivatives_of_the_flow(arcs: Callable[[], Arcs]):
    """By complex steps, which have no rounding."""
    here = arcs()
    ends, transition = here.variations()
    assert np.abs(ends - here.ends()).max() < 1e-14
    for j in range(8):
        moved = here.nodes.astype(complex)
        moved[j] += 1e-30j
        slopes = replace(here, nodes=moved).ends().imag / 1e-30
        assert np.abs(transition[:, :, j].T - slopes).max() < 1e-12 * np.abs(transition).max()


def test_ends_follow_a_free_duration():
    arcs = straight("ends-4-rendezvous", 4, 6)
    arcs = replace(arcs, nodes=arcs.nodes + 0.1)
    found = arcs.by_theta(*arcs.variations())[:, :, 0]
    nudge = 1e-5
    later, sooner = (replace(arcs, theta=arcs.theta + s * nudge).ends() for s in (1.0, -1.0))
    assert np.abs(found.T - (later - sooner) / (2.0 * nudge)).max() < 1e-8


@pytest.mark.parametrize(
    ("arcs", "steps"),
    [(lambda: straight("return-to-orbit", 2, 1), (3, 6, 12)), (lambda: held(False), (1, 2, 4))],
    ids=["free", "held"],
)
def test_the_integration_is_of_order_eight(arcs: Callable[[], Arcs], steps: tuple[int, ...]):
    """Also where a bound holds a control, if a node is where it begins or ends to do so."""
    here = arcs()
    exact = here.with_steps(60).ends()
    errors = np.array([np.abs(here.with_steps(count).ends() - exact).max() for count in steps])
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(8.0, abs=0.3)


def test_the_path_between_the_nodes_is_as_accurate():
    found = shot(instance.load("return-to-orbit-005"))
    there = flow(found)
    assert there is not None
    fine = shot(options(instance.load("return-to-orbit-005"), steps=64))
    assert np.abs(fine.x[:, np.searchsorted(fine.times, there.times - 1e-12)] - there.x).max() < 1e-11


@pytest.mark.parametrize(("population", "numbers"), [(EASY, (3, 14, 15)), (HARD, (9,))], ids=["easy", "hard"])
def test_random_returns_are_solved_to_the_last_digits(population: Population, numbers: tuple[int, ...]):
    for number in numbers:
        assert missed(shot(population.case(number))) < 1e-10


def test_a_final_angle_may_count_modulo_a_turn():
    case = instance.load("ends-1-given")
    stated = {**case.final, "theta": float(case.final["theta"]) - TURN}
    found = with_cheapest_turns(shooting.solve, options(replace(case, final=stated), free_angles=("theta",)), None)
    assert found.objective == pytest.approx(shot(case).objective, rel=1e-12)
    assert found.x[2, -1] == pytest.approx(case.final["theta"], rel=1e-13)
    assert "theta ends 1 turn above what is stated; a turn less costs" in found.message


def test_bounds_and_a_free_final_time_go_together():
    found = shot(replace(instance.load("ends-4-rendezvous"), lower=(-0.08, -0.08), upper=(0.08, 0.08)))
    assert np.abs(found.u).max() <= 0.08
    assert found.switching_times[1]
    assert again(found) < 1e-11


@pytest.mark.parametrize("displaced", [1e-5, 1e-7, 1e-9])
def test_a_return_from_nearby_is_a_small_problem_not_a_hard_one(displaced: float):
    """The cost is quadratic in the displacement; its costates are as accurate as the states' rounding allows."""
    found = shot(replace(instance.load("return-to-orbit"), initial=(1.0 + displaced, 0.0, 0.0, 1.0)))
    larger = shot(replace(instance.load("return-to-orbit"), initial=(1.0 + 1e-4, 0.0, 0.0, 1.0)))
    assert found.objective == pytest.approx(larger.objective * (displaced / 1e-4) ** 2, rel=1e-3)


@pytest.mark.slow
def test_what_cannot_be_done_is_never_called_converged():
    quick = replace(instance.load("return-to-orbit"), lower=(-0.03, -0.03), upper=(0.03, 0.03), tf=3.0)
    found = shooting.solve(options(quick, max_seconds=1.0))
    assert not found.status.answered
    assert np.isnan(found.objective)


@pytest.mark.parametrize("name", ["return-to-orbit", "ends-2-given-state"])
def test_the_time_limit_is_kept(name: str):
    began = time.thread_time()
    found = by_search.shooting(options(instance.load(name), max_seconds=1e-3))
    assert time.thread_time() - began < 2.0
    assert found.status is Status.TIME_LIMIT


def test_no_compiler_is_started_for_one_solve(tmp_path: Path):
    loaded = run_satsym(["solve", "return-to-orbit", "--method", "shooting", "--json"], tmp_path)
    assert "scipy" in loaded
    assert not loaded & {"numba", "sympy", "matplotlib"}


@pytest.mark.slow
def test_compiled_arcs_are_the_same_arcs():
    """On a corner the law has two derivatives, and which of them a first stage takes is a matter of rounding."""
    pytest.importorskip("numba")
    cases = [straight("return-to-orbit", 5, 3, compiled) for compiled in (False, True)]
    for (plain, fast), close in ((cases, 1e-12), ([held(compiled) for compiled in (False, True)], 1e-4)):
        (ends, transition), (others, other_transition) = plain.variations(), fast.variations()
        assert np.abs(ends - others).max() < 1e-13 * np.abs(ends).max()
        assert np.abs(transition - other_transition).max() < close * np.abs(transition).max()
        assert fast.cost() == pytest.approx(plain.cost(), rel=1e-12)


def test_compiled_arcs_need_no_node_where_a_bound_is_met():
    """A step ends at the corner, so the order is kept; the other arcs lose it."""
    pytest.importorskip("numba")
    solved = held(False)
    whole = {"mesh": solved.mesh[[0, -1]], "nodes": solved.nodes[:, [0, -1]], "steps": 40}
    size = np.abs(solved.nodes).max(axis=1)
    off = [np.abs(replace(held(compiled), **whole).ends()[:, 0] - solved.nodes[:, -1]) / size for compiled in (0, 1)]
    assert off[1].max() < 1e-10
    assert off[0].max() > 1e-7


def test_an_instance_may_ask_for_compiled_kernels():
    pytest.importorskip("numba")
    case = instance.load("return-to-orbit-006")
    plain, fast = shot(case), shot(options(case, backend="numba"))
    assert fast.objective == pytest.approx(plain.objective, rel=1e-12)
    assert fast.lam[:, 0] == pytest.approx(plain.lam[:, 0], abs=1e-11)
