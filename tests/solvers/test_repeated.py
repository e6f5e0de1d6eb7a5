"""An instance solved again and again: the same answers as from nothing, by both means, whichever way they are found."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from pathlib import Path

import msgspec
import numpy as np
import pytest

from satsym import instance
from satsym.solution import Solution
from satsym.solvers import by_search
from satsym.solvers.certificate import certify
from satsym.solvers.repeated import Answer, Repeated
from satsym.status import BadInput, Status
from tests.house.test_floors import imported_by
from tests.support.cases import with_parameters

MEANS = ("shooting", "collocation")
OTHER = {"shooting": by_search.collocation, "collocation": by_search.shooting}
"""By what the answers of each means are checked."""


class Pair:
    """Two machines of one means: without and with bounds that bind."""

    def __init__(self, means: str) -> None:
        self.solve = OTHER[means]
        self.compiled = means == "shooting"

    @cached_property
    def plain(self) -> Repeated:
        return Repeated(instance.load("return-to-orbit"), self.compiled)

    @cached_property
    def bounded(self) -> Repeated:
        return Repeated(instance.load("return-to-orbit-005"), self.compiled)


@pytest.fixture(scope="module", params=MEANS)
def pair(request: pytest.FixtureRequest) -> Pair:
    if request.param == "shooting":
        pytest.importorskip("numba")
    return Pair(request.param)


def matches(answer: Answer, other: Solution) -> None:
    assert answer.status is Status.CONVERGED, answer.message
    assert answer.objective == pytest.approx(other.objective, rel=1e-10)
    assert answer.lam[:, 0] == pytest.approx(other.lam[:, 0], abs=1e-10 * np.abs(other.lam[:, 0]).max())
    assert answer.times[-1] == pytest.approx(other.times[-1], rel=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("cold", [False, True])
def test_the_same_again_with_other_initial_states(pair: Pair, cold: bool):
    rng = np.random.default_rng(7)
    for machine, name, size in ((pair.plain, "return-to-orbit", 0.05), (pair.bounded, "return-to-orbit-005", 0.005)):
        case = instance.load(name)
        for _ in range(3):
            initial = tuple((np.array(case.initial) + size * rng.uniform(-1.0, 1.0, 4)).tolist())
            answer = machine.solve(initial=initial, cold=cold)
            assert answer.origin == ("straight line" if cold else "last solution")
            matches(answer, pair.solve(replace(case, initial=initial)))


@pytest.mark.slow
def test_the_same_again_with_other_parameters(pair: Pair):
    case = with_parameters(instance.load("return-to-orbit"), c2=3.0)
    matches(pair.plain.solve(parameters=case.parameters), pair.solve(case))


@pytest.mark.slow
def test_an_answer_can_be_had_in_full(pair: Pair):
    answer = pair.bounded.solve(initial=(1.101, 0.0, 0.0, 0.901))
    found = pair.bounded.solution(answer)
    assert found.objective == pytest.approx(answer.objective, rel=1e-11)
    assert len(found.switching_times[1]) == 1
    certificate = certify(found)
    assert certificate is not None
    assert certificate.verdict == "certified"


@pytest.mark.slow
def test_a_start_too_far_away_is_no_reason_to_fail(pair: Pair):
    far = (2.2, 0.2, -1.0, 0.25)
    answer = pair.plain.solve(initial=far)
    matches(answer, pair.solve(replace(instance.load("return-to-orbit"), initial=far)))
    assert answer.origin in ("straight line", "cold start")
    assert pair.plain.solve().status is Status.CONVERGED


@pytest.mark.study
def test_no_answer_is_none(pair: Pair):
    answer = pair.bounded.solve(initial=(1.3, 0.0, 0.0, 0.9))
    assert not answer.status.answered
    assert np.isnan(answer.objective)
    with pytest.raises(ValueError, match="no solution"):
        pair.bounded.solution(answer)
    assert pair.bounded.solve().status is Status.CONVERGED


def test_numbers_must_be_as_many_as_the_model_has(pair: Pair):
    with pytest.raises(ValueError, match="initial must hold 4 numbers, not 3"):
        pair.plain.solve(initial=(1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("initial", "complaint"),
    [
        ((-1.0, 0.0, 0.0, 1.0), r"\[initial\] r: .* outside the domain"),
        ((0.0, 0.0, 0.0, 1.0), r"\[initial\] r: .* outside the domain"),
        ((1.0, 0.0, float("nan"), 1.0), r"\[initial\] theta: nan is not finite"),
        ((1.0, 0.0, 0.0, float("inf")), r"\[initial\] theta_dot: inf is not finite"),
    ],
)
def test_numbers_that_are_none_are_refused_and_leave_the_machine_as_it_was(
    pair: Pair, initial: tuple[float, ...], complaint: str
):
    before = pair.plain.solve()
    with pytest.raises(BadInput, match=complaint):
        pair.plain.solve(initial=initial)
    matches(pair.plain.solve(), pair.solve(instance.load("return-to-orbit")))
    assert before.objective == pytest.approx(pair.plain.answer.objective, rel=1e-12)


def test_numbers_beyond_arithmetic_are_an_answer_with_a_status(pair: Pair):
    answer = pair.plain.solve(initial=(1e30, 0.0, 0.0, 1.0))
    assert answer.status is Status.NON_FINITE
    assert pair.plain.solve().status is Status.CONVERGED


@pytest.mark.parametrize("name", ["double-integrator-time", "double-integrator-fuel", "lapan-minimum-time"])
def test_controls_that_switch_are_refused(name: str):
    with pytest.raises(BadInput, match="switch"):
        Repeated(instance.load(name))


def test_turns_are_not_looked_for_again_and_again():
    case = instance.load("return-to-orbit")
    with pytest.raises(BadInput, match="free_angles"):
        Repeated(replace(case, solver=msgspec.structs.replace(case.solver, free_angles=("theta",))))


def test_without_a_compiler_nothing_heavy_is_loaded(tmp_path: Path):
    code = (
        "from satsym import instance; from satsym.solvers.repeated import Repeated;"
        "Repeated(instance.load('return-to-orbit'), compiled=False).solve()"
    )
    assert not imported_by(code, tmp_path) & {"numba", "scipy", "sympy", "matplotlib"}


@pytest.mark.slow
@pytest.mark.parametrize("means", MEANS)
@pytest.mark.parametrize(
    ("name", "nudge"), [("return-to-orbit-ball", 0.002), ("ends-4-rendezvous", 0.05), ("return-to-geo", 0.1)]
)
def test_other_models_as_well(name: str, nudge: float, means: str):
    if means == "shooting":
        pytest.importorskip("numba")
    case = instance.load(name)
    machine = Repeated(case, means == "shooting")
    for sign in (1.0, -1.0):
        initial = (case.initial[0] + sign * nudge, *case.initial[1:])
        answer = machine.solve(initial=initial)
        assert answer.origin == "last solution"
        matches(answer, by_search.collocation(replace(case, initial=initial)))
