"""Ends that only pushes in time with a swing reach: found, compared, and not called out of reach."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sympy import Expr, sin

from satsym.instance import Instance
from satsym.solvers import solve
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.drawn_motions import motions
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES, CONTROLS = (Variable("a", "a"), Variable("b", "b")), (Variable("w", "w"),)
(a, b), (w,) = symbols_of(STATES), symbols_of(CONTROLS)


def _swing(name: str, force: Expr) -> Problem:
    model = FirstOrder(
        name=f"{name}_motion",
        title="A swing",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={a: b, b: force + w},
    )
    return Problem(name=name, title="Least effort", model=model, running_cost=w**2 / 2, control_set="box")


PENDULUM, OSCILLATOR = _swing("pendulum", -sin(a)), _swing("oscillator", -a)


def _case(folder: Path, problem: Problem, end: float, duration: float, bounds: tuple[float, float]) -> Instance:
    ends = f"[initial]\na = 0\nb = 0\n[final]\na = {end}\nb = 0\n"
    return build(folder, problem, f"{ends}[time]\ntf = {duration}\n[control]\nw = {list(bounds)}\n")


@pytest.mark.slow(in_turn=True)
@pytest.mark.parametrize(
    ("torque", "duration", "cost"),
    # Radau collocation with CasADi and Ipopt on 120 intervals, the best of starts from motions that were simulated
    [(0.12, 40.0, 0.1171811), (0.12, 36.0, 0.1328416)],
)
def test_a_pendulum_is_swung_up_by_a_torque_that_cannot_lift_it(
    tmp_path: Path, torque: float, duration: float, cost: float
) -> None:
    found = solve(_case(tmp_path, PENDULUM, np.pi, duration, (-torque, torque)))
    assert found.objective == pytest.approx(cost, rel=5e-5)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow(in_turn=True)
def test_where_starts_lead_to_several_swings_further_ones_find_the_cheapest(tmp_path: Path) -> None:
    """With any torque; the first swing that is found costs 0.58805, a strict minimum, but not the least.

    Ipopt, 200 steps of constant torque, the best of twelve drawn starts: 0.5806762, above the least by its steps.
    """
    swing, ends = replace(PENDULUM, name="lifted", control_set="free"), f"[final]\na = {np.pi}\nb = 0\n"
    found = solve(build(tmp_path, swing, f"[initial]\na = 0\nb = 0\n{ends}[time]\ntf = 10\n"))
    assert 0.5806762 * (1.0 - 1e-3) < found.objective < 0.5806762
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


def test_an_end_that_one_control_alone_reaches_is_not_called_out_of_reach(tmp_path: Path) -> None:
    """Pushes to one side, none longer than half a swing: they add up to two units, all of them at the bound."""
    found = solve(_case(tmp_path, OSCILLATOR, -1.0, 8.0, (0.0, 0.5)))
    assert found.status is not Status.INFEASIBLE
    beyond = solve(_case(tmp_path, OSCILLATOR, -1.05, 8.0, (0.0, 0.5)))
    assert beyond.status is Status.INFEASIBLE


def test_motions_that_are_drawn_obey_their_controls_and_come_nearer_than_a_steady_push(tmp_path: Path) -> None:
    case = _case(tmp_path, PENDULUM, np.pi, 40.0, (-0.12, 0.12))
    problem = two_point(case, 40.0)
    found = motions(problem, np.random.default_rng(0))
    assert len(found) == 4
    again = motions(problem, np.random.default_rng(0))
    for one, same in zip(found, again, strict=True):
        assert (one.states == same.states).all()
        assert (np.abs(one.control) <= 0.12).all()
        rates = case.model.dynamics_batch(0.0, one.states * problem.scale.state[:, None], one.control, ())
        middles = (np.asarray(rates)[0, 1:] + np.asarray(rates)[0, :-1]) / 2.0
        moved = np.diff(one.states[0]) * problem.scale.state[0]
        assert moved == pytest.approx(middles * 0.2, abs=2e-3)
    highest = max(np.abs(one.states[0]).max() * problem.scale.state[0] for one in found)
    assert highest > 0.75, "a steady push of 0.12 lifts it by a quarter of a radian"
