"""Problems whose cheapest motion few starts lead to; another strict minimum is found first in each."""

from __future__ import annotations

from dataclasses import replace

import pytest
from sympy import Expr, Integer, Symbol, cos, sin, sqrt

import satsym
from satsym.status import Verdict
from satsym.symbolic import Angle, FirstOrder, Problem, Variable, symbols_of, t


def _problem(name: str, rates: dict[Symbol, Expr], controls: tuple[Variable, ...], cost: Expr) -> Problem:
    states = tuple(Variable(str(symbol), str(symbol)) for symbol in rates)
    model = FirstOrder(
        name=f"{name}_motion", title="A motion", states=states, controls=controls, parameters=(), rates=rates
    )
    return Problem(name=name, title="Least effort", model=model, running_cost=cost)


X, Y, VX, VY, A, W = symbols_of(tuple(Variable(name, name) for name in ("x", "y", "vx", "vy", "a", "w")))
CONTROL, PUSHES = (Variable("u", "u"),), (Variable("ux", "ux"), Variable("uy", "uy"))
(U,), (UX, UY) = symbols_of(CONTROL), symbols_of(PUSHES)
PULL = sqrt(X**2 + Y**2) ** 3
LIBRATION = _problem("libration", {A: W, W: U - 0.9898 * sin(2 * A) + 0.0593 * sin(t)}, CONTROL, U**2 / 2)
ORBIT = _problem("orbit", {X: VX, Y: VY, VX: UX - X / PULL, VY: UY - Y / PULL}, PUSHES, (UX**2 + UY**2) / 2)


@pytest.mark.slow
def test_starts_of_a_small_programme_are_tried_until_they_have_cost_something() -> None:
    """The first four starts of a turn by gravity gradient lead to 0.225602.

    Ipopt, 210 Hermite-Simpson steps, the best of twelve drawn starts: 0.17599886, which three of them led to.
    """
    found = satsym.solve(
        satsym.Instance.of(LIBRATION, initial={"a": -0.2893, "w": 0.6472}, final={"a": 0.4948, "w": 0.6629}, tf=8.5691)
    )
    assert found.objective == pytest.approx(0.17599886, rel=1e-6)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_a_transfer_with_a_free_initial_velocity_may_go_round() -> None:
    """The initial speed is free; 0.045395 and 0.020068 are other strict minima.

    Ipopt, 90 Hermite-Simpson steps: 0.0064404, the same on twice as many to 3e-6.
    """
    found = satsym.solve(
        satsym.Instance.of(
            ORBIT,
            initial={"x": 1.0, "y": 0.0, "vx": 0.0, "vy": "free"},
            final={"x": -0.7399, "y": 1.4712, "vy": -0.3501},
            tf=8.8354,
        )
    )
    assert found.objective == pytest.approx(0.0064404, rel=1e-4)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_programmes_that_stall_leave_time_for_those_that_do_not() -> None:
    """Thrust of a fixed magnitude reaches the end after a whole turn, but not on shorter ways.

    Ipopt finds none of twelve drawn starts; without the limits on programmes that stall, neither did the search.
    """
    angle = (Variable("b", "b"),)
    (b,) = symbols_of(angle)
    rates = {X: VX, Y: VY, VX: 0.2375 * cos(b) - X / PULL, VY: 0.2375 * sin(b) - Y / PULL}
    sooner = replace(_problem("sooner", rates, angle, Integer(1)), control_sets={"b": Angle("b")})
    found = satsym.solve(
        satsym.Instance.of(
            sooner,
            initial={"x": 1.0, "y": 0.0, "vx": 0.0, "vy": 1.0},
            final={"x": 0.3438, "y": 1.403, "vx": -0.8081, "vy": 0.198},
            tf="free",
            solver={"max_seconds": 300},
        )
    )
    assert found.objective == pytest.approx(4.876925, rel=1e-6)


@pytest.mark.slow
def test_a_free_start_from_which_nothing_needs_to_be_done_is_certified() -> None:
    """The uncontrolled motion backwards from the end is optimal: cost and costates consist of rounding."""
    found = satsym.solve(
        satsym.Instance.of(LIBRATION, initial={"a": "free", "w": "free"}, final={"a": -1.0275, "w": -0.5277}, tf=7.5777)
    )
    assert found.objective == pytest.approx(0.0, abs=1e-30)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_a_singular_arc_may_be_left_shortly_before_the_end() -> None:
    """The last arc lasts 0.003 of 4.7, because the singular arc misses the final velocity by little.

    Ipopt, 200 steps of constant control: 0.0304586, above the least by its steps.
    """
    rates = {X: VX, VX: U - 0.5732 * X - 0.0907 * X**3}
    problem = replace(_problem("spring", rates, CONTROL, (X**2 + VX**2) / 2), control_set="box")
    found = satsym.solve(
        satsym.Instance.of(
            problem,
            initial={"x": 0.2468, "vx": -0.2068},
            final={"vx": -0.0031},
            tf=4.7481,
            control={"u": [-1.0, 1.0]},
        )
    )
    assert 0.0304586 * (1.0 - 1e-4) < found.objective < 0.0304586
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
