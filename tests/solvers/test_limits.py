"""Limits are kept: memory is told before it is taken, and long grids do not outlast the time that is given."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest

from satsym import instance
from satsym.analysis.regulator.feedback import simulate
from satsym.instance import Instance
from satsym.instance.options import MOST_BYTES, needed_memory, solver
from satsym.solvers import iteration, solve
from satsym.solvers.iteration import BLOCK, Limits, TimeUp, watched
from satsym.solvers.search import coarse
from satsym.solvers.simulation import blocks
from satsym.status import BadInput, Status


def asked(name: str, **options: object) -> Instance:
    case = instance.load(name)
    return replace(case, solver=msgspec.structs.replace(case.solver, **options))


def test_steps_that_take_too_much_memory_are_refused_with_steps_estimate_and_limit() -> None:
    case = asked("soft-return", steps=10**7)
    with pytest.raises(
        BadInput, match=r"\[solver\] steps: 10000000 steps of polar_orbit need about 36\.8 GB .* 2\.15 GB"
    ):
        solver(case.solver, case.model.spec)


@pytest.mark.parametrize("name", ["soft-return", "lapan-minimum-time", "molniya"])
def test_as_many_steps_as_the_refusal_says_are_taken(name: str) -> None:
    case = asked(name, steps=10**7)
    with pytest.raises(BadInput) as refused:
        solver(case.solver, case.model.spec)
    most = int(str(refused.value).rpartition(" ")[2])
    options = msgspec.structs.replace(case.solver, steps=most)
    assert solver(options, case.model.spec) is options
    assert MOST_BYTES * 0.99 < needed_memory(options, case.model.spec) <= MOST_BYTES
    with pytest.raises(BadInput):
        solver(msgspec.structs.replace(case.solver, steps=most + 1), case.model.spec)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], list[int]]:
    """A clock that is at the end of all time after so many looks at it; counts them."""

    def arm(looks: int) -> list[int]:
        seen = [0]

        def check(_: Limits) -> bool:
            seen[0] += 1
            return seen[0] > looks

        monkeypatch.setattr(Limits, "expired", property(check))
        return seen

    return arm


@pytest.mark.parametrize("method", ["collocation", "shooting", "sweep"])
def test_a_long_trajectory_that_is_not_done_in_time_is_a_time_limit(
    method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def check(_: Limits) -> None:
        raise TimeUp

    monkeypatch.setattr(Limits, "check", check)  # between blocks of steps, and nowhere else
    found = solve(asked("soft-return", steps=BLOCK + 1, method=method, backend="python"))
    assert (found.status, found.method, found.certificate) == (Status.TIME_LIMIT, method, None)
    assert "time limit reached while 10001 steps were computed" in found.message
    assert not np.isfinite(found.objective)


def test_a_sweep_whose_time_is_over_within_an_iteration_has_the_one_before(monkeypatch: pytest.MonkeyPatch) -> None:
    looks: list[bool] = []

    def expired(_: Limits) -> bool:
        looks.append(bool(reached))
        return sum(looks) > 1  # not between two iterations, but within the one after the first

    reached: list[int] = []
    monkeypatch.setattr(Limits, "expired", property(expired))
    case = asked("soft-return", steps=BLOCK + 1, method="sweep", backend="python")
    found = solve(case, lambda iteration: reached.append(1) if iteration.number == 1 else None)
    assert (found.status, found.iterations) == (Status.TIME_LIMIT, 1)
    assert np.isfinite(found.x).all()
    assert np.isfinite(found.objective)


@pytest.mark.parametrize(
    ("name", "feedback"), [("soft-return", "none"), ("geo-lqr", "lqr"), ("lapan-classical", "classical")]
)
@pytest.mark.parametrize("looks", [0, 3])
def test_a_simulation_that_is_not_done_in_time_is_a_time_limit(
    name: str, feedback: str, looks: int, clock: Callable[[int], list[int]]
) -> None:
    clock(looks)
    found = simulate(asked(name, steps=2 * BLOCK), feedback)
    assert found.status is Status.TIME_LIMIT
    assert "time limit reached" in found.message
    assert len(found.times) == found.x.shape[1] == found.u.shape[1]


def test_time_that_passes_is_seen_in_the_midst_of_a_grid() -> None:
    began = time.process_time()
    found = simulate(asked("soft-return", steps=400_000, max_seconds=0.3))
    assert found.status is Status.TIME_LIMIT
    assert time.process_time() - began < 2.0


def test_blocks_show_in_nothing_but_the_last_digits_of_the_cost(monkeypatch: pytest.MonkeyPatch) -> None:
    case = instance.load("soft-return")
    nodes, u = np.linspace(0.0, 3.0, 101), np.random.default_rng(1).normal(size=(2, 201)) * 0.01
    arguments = (case.model, nodes, case.initial, u[:, ::2], u[:, 1::2], case.parameters)
    limits = Limits(1, float("inf"))
    x, mid, cost = blocks.forward(*arguments, limits)
    control = (u[:, ::2], u[:, 1::2])
    lam = blocks.backward(case.model, nodes, (1.0, 2.0, 3.0, 4.0), (x, mid), control, case.parameters, limits)
    for size in (7, 50, 100):
        monkeypatch.setattr(blocks, "BLOCK", size)
        again = blocks.forward(*arguments, limits)
        np.testing.assert_array_equal(again[0], x)
        np.testing.assert_array_equal(again[1], mid)
        assert again[2] == pytest.approx(cost, rel=1e-14)
        other = blocks.backward(case.model, nodes, (1.0, 2.0, 3.0, 4.0), (x, mid), control, case.parameters, limits)
        np.testing.assert_array_equal(other[0], lam[0])
        np.testing.assert_array_equal(other[1], lam[1])
        with pytest.raises(TimeUp) if size < 100 else pytest.MonkeyPatch.context():
            blocks.forward(*arguments, Limits(1, 0.0))


def test_few_places_are_never_too_late(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(iteration, "BLOCK", 10)
    late = Limits(1, 0.0)
    np.testing.assert_array_equal(late.in_blocks(np.sin, np.arange(10.0)), np.sin(np.arange(10.0)))
    with pytest.raises(TimeUp):
        late.in_blocks(np.sin, np.arange(11.0))
    np.testing.assert_array_equal(Limits(1, float("inf")).in_blocks(np.sin, np.arange(25.0)), np.sin(np.arange(25.0)))


def test_what_else_a_machine_does_uses_up_no_time() -> None:
    limits, _ = watched(asked("soft-return", max_seconds=0.05), None)
    time.sleep(0.1)
    assert not limits.late
    began = time.thread_time()
    while not limits.late:
        pass
    assert time.thread_time() - began < 0.06


def test_no_solver_counts_its_time_on_another_clock(repository: Path) -> None:
    """Limits are on that of the processor: a deadline on another one would never come."""
    files = (repository / "satsym" / "solvers").rglob("*.py")
    assert {path.name for path in files if "+ instance.solver.max_seconds" in path.read_text("utf-8")} == {
        "iteration.py"
    }


def test_what_threads_of_the_interior_point_code_compute_counts() -> None:
    """Matrices are factored in other threads than the one that asks; a limit of time is for both."""
    case = instance.load("hypersensitive")
    begun, all_threads = iteration.computed(), time.process_time()
    assert coarse.first_motion(case, Limits(iteration.MOST_ITERATIONS, np.inf)) is not None
    spent, all_threads = iteration.computed() - begun, time.process_time() - all_threads
    assert 0.7 * all_threads < spent < 1.05 * all_threads
