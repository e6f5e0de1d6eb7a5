"""Least times of many linear motions: none is wrong, and the certificate sees what is not right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satsym import instance, solvers
from satsym.codegen import module
from satsym.instance import Instance
from satsym.kernels.loading import from_text
from satsym.solvers.batch.switching.arrivals import Arrivals, applies, first_arrivals
from satsym.solvers.batch.switching.certificate import minima, positive_across
from satsym.solvers.certificate import certify
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of, t
from tests.bench.truth.models import chain, oscillator
from tests.support.body_on_a_line import case
from tests.support.derived import derived
from tests.support.switching_closed_forms import minimum_time, moving_arrivals

BACKENDS = [False, pytest.param(True, marks=pytest.mark.slow)]


def bodies(count: int, seed: int) -> list[Instance]:
    """On a line, from anywhere to anywhere at any rate, bounds mostly not symmetric."""
    rng, found = np.random.default_rng(seed), []
    for _ in range(count):
        start, end = rng.uniform(-3.0, 3.0, 2), rng.uniform(-2.0, 2.0, 2)
        bounds = -(10 ** rng.uniform(-0.5, 0.5)), 10 ** rng.uniform(-0.5, 0.5)
        found.append(case(tuple(start.tolist()), tuple(end.tolist()), bounds))
    return found


def of_model(problem: Problem, base: dict[str, Any]) -> Instance:
    """An instance of a model of these tests."""
    kernels = from_text(module.render(derived(problem), "own.py"), "own.py")
    return replace(instance.load("double-integrator-time"), path=Path("own.toml"), model=kernels, **base)


def known(one: Instance) -> list[float]:
    return moving_arrivals(one.initial, tuple(one.final.values()), one.lower[0], one.upper[0])


@pytest.mark.parametrize(("compiled", "count"), [(False, 60), pytest.param(True, 10_000, marks=pytest.mark.slow)])
def test_all_least_times_of_a_body_on_a_line_are_those_of_the_closed_form(compiled: bool, count: int) -> None:
    if compiled:
        pytest.importorskip("numba")
    cases = bodies(count, 20)
    found = first_arrivals(cases, compiled)
    assert found.solved.mean() >= 0.999
    ends = [known(one) for one in cases]
    least = np.array([one[0] for one in ends])
    assert any(len(one) > 1 for one in ends), "some ends are reached, then not, then again"
    assert np.abs(found.durations / least - 1.0)[found.solved].max() <= 1e-11
    assert minima(found)[found.solved].mean() >= 0.999


def test_what_is_reached_for_a_moment_only_is_not_missed() -> None:
    """From 0.18958 to 0.18969, and next at 6: between steps that show a duration."""
    short = case((1.30409702, 1.28138663), (1.55915681, 1.40865176), (-1.2725520289656465, 0.6748818762940169))
    first, second, third = known(short)
    assert second - first < 1e-3 * first < third
    found = first_arrivals([short], False)
    assert found.durations[0] == pytest.approx(first, rel=1e-11)


def test_a_target_that_moves_is_met_soonest() -> None:
    places = (Variable("q", "q", "m"), Variable("w", "w", "m/s"))
    push, speed = Variable("u1", "u_1", "m/s**2"), Variable("v", "v", "m/s", default=0.3)
    (q, w), (u,), (v,) = symbols_of(places), symbols_of((push,)), symbols_of((speed,))
    rail = FirstOrder(
        name="rail",
        title="A target passes",
        states=places,
        controls=(push,),
        parameters=(speed,),
        rates={q: w, w: u},
        reference={q: v * t, w: v},
    )
    problem = Problem(name="rail_time", title="Meeting", model=rail, running_cost=1, control_set="box")
    case = of_model(problem, {"final": {"q": "reference", "w": "reference"}, "parameters": (0.3,)})
    rng, cases = np.random.default_rng(3), []
    for _ in range(20):
        q_0, w_0, speed_0 = rng.uniform(-2.0, 2.0, 3).tolist()
        cases.append(replace(case, initial=(q_0, w_0), parameters=(speed_0,)))
    found = first_arrivals(cases, False)
    for k, one in enumerate(cases):
        (q_0, w_0), (speed_0,) = one.initial, one.parameters
        assert found.durations[k] == pytest.approx(minimum_time(q_0, w_0 - speed_0).duration, rel=1e-11)
        assert found.ends[:, k] == pytest.approx([speed_0 * found.durations[k], speed_0])
    assert minima(found).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("problems", "size"), [(chain.PROBLEMS, 1.0), (oscillator.PROBLEMS, 6.0)], ids=["chain", "spring"]
)
def test_other_linear_motions_are_those_of_the_single_solver(problems: Sequence[Problem], size: float) -> None:
    """Three integrators with two switches each, and springs with any number."""
    (problem,) = (one for one in problems if one.name.endswith("_time"))
    names = [str(one.symbol) for one in problem.model.states]
    parameters = tuple(one.default for one in problem.model.parameters)
    base = of_model(problem, {"final": dict.fromkeys(names, 0.0), "parameters": parameters})
    rng = np.random.default_rng(4)
    cases = [replace(base, initial=tuple(rng.uniform(-size, size, len(names)).tolist())) for _ in range(5)]
    found = first_arrivals(cases, False)
    assert found.solved.all()
    fine = minima(found)
    for k in range(len(cases)):
        single = solvers.solve(cases[k], examined=False)
        assert found.durations[k] == pytest.approx(single.objective, rel=1e-10)
        assert np.abs(found.costates[:, k] - single.lam[:, 0]).max() <= 1e-8 * np.abs(single.lam[:, 0]).max()
        certificate = certify(single, compared=False)
        assert certificate is not None
        assert fine[k] == (certificate.verdict is Verdict.LOCAL_MINIMUM)
    assert fine.all()
    assert ((found.controls >= 0).sum(axis=0) >= len(names)).any() == (len(names) == 2), "more times than given states"


def test_forms_are_positive_only_where_every_direction_that_is_left_is() -> None:
    saddle = np.diag([1.0, 1.0, -1.0])
    along, across = np.array([[0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]])
    by, hessian = np.stack([along, across, across, 0.0 * along]), np.stack([saddle, saddle, abs(saddle), abs(saddle)])
    assert positive_across(by, hessian).tolist() == [True, False, True, False]
    whole = np.stack([np.eye(3), np.diag([1.0, 1.0, 0.0]), np.diag([1.0, 1.0, np.nan])])
    assert positive_across(whole, np.stack([saddle] * 3)).tolist() == [True, False, False]


def test_a_switch_at_the_very_end_is_left_to_the_single_solver() -> None:
    """Where a start lies on the switching curve there is an arc of no length; a little beside it there is none."""
    starts = [(0.5, -1.0), (0.5 + 1e-13, -1.0), (0.6, -1.0)]
    assert minima(first_arrivals([case(start, (0.0, 0.0)) for start in starts], False)).tolist() == [False, False, True]


@pytest.mark.parametrize("what", ["durations", "costates", "times"])
def test_an_extremal_that_is_hardly_wrong_is_not_confirmed(what: str) -> None:
    found = first_arrivals(bodies(6, 5), False)
    assert minima(found).all()
    wrong: Arrivals = replace(found, **{what: getattr(found, what) * (1.0 + 1e-7)})
    if what == "costates":  # a factor alone shows in H
        assert not minima(wrong).any()
        wrong.costates[1] *= 1.0 + 1e-7
    assert not minima(wrong).any()


def test_a_later_arrival_with_the_controls_of_a_maximum_is_not_confirmed() -> None:
    """The last moment at which an end is reached meets all conditions but the sign of the costates."""
    found = first_arrivals(bodies(4, 6), False)
    assert not minima(replace(found, costates=-found.costates)).any()


def test_others_are_left_to_the_single_solver() -> None:
    fuel, given = instance.load("double-integrator-fuel"), instance.load("double-integrator-time")
    assert applies(given)
    assert not applies(replace(given, tf=3.0))
    assert not applies(replace(given, final={"q": 0.0}))
    assert not applies(instance.load("return-to-orbit"))
    assert not first_arrivals([replace(fuel, tf=None)], False).solved.any(), "thrust costs as well"
    at_rest = replace(given, initial=(0.0, 0.0))
    assert first_arrivals([given, at_rest], False).solved.tolist() == [True, False]
    spin = instance.load("double-integrator-time")
    bent = replace(spin, upper=(float("inf"),))
    assert not applies(bent)
