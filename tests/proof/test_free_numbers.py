"""Free parameters and a free initial time, against functions of these numbers alone, whose minima are known."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy

import satsym
from satsym import solvers
from satsym.instance import Instance
from satsym.instance.unknowns import Place, Unknown
from satsym.proof.proving import prove
from satsym.proof.record import Outcome, Proof
from satsym.solution import Solution
from satsym.spec import Condition
from satsym.symbolic import t
from tests.proof.closed_forms import answer

q, v, u, a, c = sympy.symbols("q v u a c", real=True)
A, C = satsym.Variable("a", "a", default=0.0), satsym.Variable("c", "c", default=0.0)


@cache
def problem(kind: str) -> Any:
    moving: Any = {"drifting": u + a, "windy": u + a * t, "soft": u + a, "caught": u - a * sympy.sin(t)}
    rates = {q: moving.get(kind, u)}
    ending: dict[str, Any] = {}
    if kind == "aimed":
        ending = {"terminal_constraints": (q - a,), "terminal_cost": 2 * sympy.sin(3 * a)}
    if kind == "caught":
        ending = {"terminal_cost": 2 * sympy.sin(3 * a)}
    motion = satsym.FirstOrder(
        name="drift_motion",
        title="A point in a drift",
        states=(satsym.Variable("q", "q"),),
        controls=(satsym.Variable("u", "u"),),
        parameters=() if kind == "dated" else (A, C),
        rates=rates,
        reference={q: a * sympy.cos(t)} if kind == "caught" else {},
    )
    cost = {
        "dated": 3 * sympy.sin(4 * t),
        "drifting": sympy.sin(3 * a),
        "windy": a**2 / 2,
        "soft": (c * a**2 - q**2) / 2,
    }.get(kind, 0)
    return satsym.Problem(name="drift", title="In a drift", model=motion, running_cost=u**2 / 2 + cost, **ending)


def drifting(kind: str, **given: Any) -> Instance:
    return satsym.Instance.of(problem(kind), **given).case


def found_of(case: Instance, times: Any, states: Any, controls: Any, parameters: tuple[float, ...] = ()) -> Solution:
    begun = replace(case, t0=float(times[0]), parameters=parameters)
    return answer(begun, times, states[None], controls[None], -controls[None])


def number(proof: Proof, name: str) -> tuple[Any, Any]:
    centre, radius = proof.numbers[name].removeprefix("free; ").removesuffix(" is best").split(" +/- ")
    return mpmath.mpf(centre), mpmath.mpf(radius)


def roots(slope: Any, low: Any, high: Any) -> list[Any]:
    grid = [mpmath.mpf(low) + (mpmath.mpf(high) - low) * k / 200 for k in range(201)]
    return [
        mpmath.findroot(slope, pair, solver="anderson")
        for pair in pairwise(grid)
        if slope(pair[0]) * slope(pair[1]) < 0
    ]


def holds(proof: Proof, exact: Any) -> bool:
    assert proof.objective is not None
    return bool(abs(mpmath.mpf(proof.objective.centre) - exact) <= mpmath.mpf(proof.objective.radius))


def test_of_all_stationary_drifts_minima_are_proved() -> None:
    """From 0 to 1 in time 1: (1 - a)^2/2 + sin(3 a)."""
    case = drifting("drifting", initial={"q": 0.0}, final={"q": 1.0}, tf=1.0, parameters={"a": "free"})
    seen = set()
    with mpmath.workdps(40):

        def cost(drift: Any) -> Any:
            return (1 - drift) ** 2 / 2 + mpmath.sin(3 * drift)

        for drift in roots(lambda s: mpmath.diff(cost, s), -3, 3):
            times = np.linspace(0.0, 1.0, 21)
            given = found_of(case, times, times, np.full(21, float(1 - drift)), (float(drift), 0.0))
            proof = prove(case, lambda given=given: given)
            least = mpmath.diff(cost, drift, 2) > 0
            assert proof.status is (Outcome.PROVED if least else Outcome.NOT_PROVED), proof.reason
            assert holds(proof, cost(drift))
            centre, radius = number(proof, "parameters.a")
            assert abs(centre - drift) <= radius < mpmath.mpf(10) ** -18
            seen.add(bool(least))
    assert seen == {True, False}


@pytest.mark.parametrize("kind", ["aimed", "caught"])
def test_of_all_stationary_aims_minima_are_proved(kind: str) -> None:
    """From 1 to a parameter, at which the motion must end: (1 - a)^2/2 + 2 sin(3 a).

    So it is where the end is on a reference, a cos(t), with which the drift goes.
    """
    final = {"q": "reference"} if kind == "caught" else {}
    case = drifting(kind, initial={"q": 1.0}, final=final, tf=1.0, parameters={"a": "free"})
    seen = set()
    with mpmath.workdps(40):

        def cost(aim: Any) -> Any:
            return (1 - aim) ** 2 / 2 + 2 * mpmath.sin(3 * aim)

        for aim in roots(lambda s: mpmath.diff(cost, s), -3, 4):
            times, pace = np.linspace(0.0, 1.0, 21), float(aim - 1)
            turning = float(aim) * (np.cos(times) - 1) if kind == "caught" else 0.0
            given = found_of(case, times, 1 + pace * times + turning, np.full(21, pace), (float(aim), 0.0))
            proof = prove(case, lambda given=given: given)
            least = mpmath.diff(cost, aim, 2) > 0
            assert proof.status is (Outcome.PROVED if least else Outcome.NOT_PROVED), proof.reason
            assert holds(proof, cost(aim))
            seen.add(bool(least))
    assert seen == {True, False}


def test_of_all_stationary_initial_times_minima_are_proved() -> None:
    """From 1 to 0 until t = 3: 1/(2 (3 - t0)), and the integral of 3 sin(4 t) from t0 on."""
    case = drifting("dated", initial={"q": 1.0}, final={"q": 0.0}, tf=3.0, t0="free")
    seen = set()
    with mpmath.workdps(40):

        def cost(begin: Any) -> Any:
            return 1 / (2 * (3 - begin)) + 3 * (mpmath.cos(4 * begin) - mpmath.cos(12)) / 4

        for begin in roots(lambda s: mpmath.diff(cost, s), -1, 2.5):
            times = np.linspace(float(begin), 3.0, 21)
            pace = -1 / float(3 - begin)
            given = found_of(case, times, 1 + pace * (times - times[0]), np.full(21, pace))
            proof = prove(case, lambda given=given: given)
            least = mpmath.diff(cost, begin, 2) > 0
            assert proof.status is (Outcome.PROVED if least else Outcome.NOT_PROVED), proof.reason
            assert holds(proof, cost(begin))
            centre, radius = number(proof, "time.t0")
            assert abs(centre - begin) <= radius < mpmath.mpf(10) ** -18
            assert proof.nodes[0].t.text == proof.numbers["time.t0"].removeprefix("free; ").removesuffix(" is best")
            assert proof.t_final is not None
            assert float(proof.t_final.centre) == 3.0
            seen.add(bool(least))
    assert seen == {True, False}


@pytest.mark.parametrize(
    ("weight", "tf", "wanted"),
    [
        (0.5, 2.0, Outcome.PROVED),
        (-0.5, 3.0, Outcome.PROVED),
        (-0.9375, 2.0, Outcome.PROVED),
        (-1.0625, 2.0, Outcome.NOT_PROVED),
        (-1.5, 3.0, Outcome.NOT_PROVED),
        (0.5, 3.25, Outcome.NOT_PROVED),
    ],
)
def test_a_drift_may_be_rewarded_as_long_as_the_second_variation_is_positive(
    weight: float, tf: float, wanted: Outcome
) -> None:
    """With v = dq', the integral of v^2 - dq^2, and (1 + c) T da^2: positive for T < pi and c > -1."""
    case = drifting("soft", initial={"q": 1.0}, final={"q": 0.0}, tf=tf, parameters={"a": "free", "c": weight})
    with mpmath.workdps(40):
        end, sharp = mpmath.mpf(tf), mpmath.mpf(weight)
        drift, slope = -1 / ((1 + sharp) * end), -mpmath.cot(end)
        times = np.linspace(0.0, tf, 201)
        states = np.cos(times) + float(slope) * np.sin(times)
        controls = -np.sin(times) + float(slope) * np.cos(times) - float(drift)
        given = found_of(case, times, states, controls, (float(drift), weight))
        proof = prove(case, lambda: given)
        assert proof.status is wanted, proof.reason

        def rate(s: Any) -> Any:
            place, pace = mpmath.cos(s) + slope * mpmath.sin(s), slope * mpmath.cos(s) - mpmath.sin(s) - drift
            return (pace**2 + sharp * drift**2 - place**2) / 2

        assert holds(proof, mpmath.quad(rate, [0, end]))
        centre, radius = number(proof, "parameters.a")
        assert abs(centre - drift) <= radius


def test_a_free_parameter_of_a_motion_that_depends_on_time() -> None:
    """From 0 to 1 between 1/2 and 3/2: u + a = 1, at (u^2 + a^2)/2 in time 1."""
    case = drifting("windy", initial={"q": 0.0}, final={"q": 1.0}, t0=0.5, tf=1.5, parameters={"a": "free"})
    times = np.linspace(0.5, 1.5, 41)
    states = 0.5 * (times - 0.5) + 0.25 * (times**2 - 0.25)
    proof = prove(case, lambda: found_of(case, times, states, np.full(41, 0.5), (0.5, 0.0)))
    assert proof.status is Outcome.PROVED, proof.reason
    assert holds(proof, mpmath.mpf(1) / 4)
    assert proof.nodes[0].t.text == "0.50000000000000000000 +/- 0"
    assert set(proof.x_final) == {"q"}


def test_an_initial_time_before_a_given_end_is_the_least_duration_away() -> None:
    case = satsym.load("double-integrator-time").case
    case = replace(case, tf=5.0, free=(Unknown(Place.TIME, "t0", 0, positive=False),))
    times = np.concatenate([np.linspace(3.0, 4.0, 21), np.linspace(4.0, 5.0, 21)])
    first = times - 3.0
    rates = np.where(first <= 1.0, -first, first - 2.0)
    places = np.where(first <= 1.0, 1 - first**2 / 2, (2.0 - first) ** 2 / 2)
    controls = np.repeat([-1.0, 1.0], 21)[None]
    costates = np.array([np.ones(42), 4.0 - times])
    given = answer(replace(case, t0=3.0), times, np.array([places, rates]), controls, costates)
    proof = prove(case, lambda: replace(given, switching_times=((4.0,),)))
    assert proof.status is Outcome.PROVED, proof.reason
    assert holds(proof, 2)
    centre, radius = number(proof, "time.t0")
    assert abs(centre - 3) <= radius
    (switch,) = proof.switching_times
    assert abs(mpmath.mpf(switch.centre) - 4) <= mpmath.mpf(switch.radius)


@cache
def engine() -> Any:
    a = sympy.Symbol("a", positive=True)
    motion = satsym.FirstOrder(
        name="engine_motion",
        title="A body with an engine to be chosen",
        states=(satsym.Variable("q", "q"), satsym.Variable("v", "v")),
        controls=(satsym.Variable("u", "u"),),
        parameters=(satsym.Variable("a", "a", default=1.0, positive=True),),
        rates={q: v, v: a * u},
    )
    return satsym.Problem(
        name="engine", title="Soon, by an engine", model=motion, running_cost=1 + a / 4, control_set="box"
    )


def test_the_best_engine_of_a_motion_with_a_switch() -> None:
    """From rest at 1 to rest at 0 with |u| < 1 takes 2/sqrt(a): 2/sqrt(a) + sqrt(a)/2 is least, 2, at a = 4."""
    case = satsym.Instance.of(
        engine(),
        initial={"q": 1.0, "v": 0.0},
        final={"q": 0.0, "v": 0.0},
        tf="free",
        tf_guess=1.0,
        control={"u": [-1.0, 1.0]},
        parameters={"a": "free"},
    ).case
    proof = prove(case, lambda: solvers.solve(case))
    assert proof.status is Outcome.PROVED, proof.reason
    assert holds(proof, 2)
    centre, radius = number(proof, "parameters.a")
    assert abs(centre - 4) <= radius


def test_conditions_on_a_free_parameter_are_refused() -> None:
    case = drifting("drifting", initial={"q": 0.0}, final={"q": 1.0}, tf=1.0, parameters={"a": "free"})
    spec = replace(case.model.spec, conditions=(Condition((("a", 1.0), ("c", 1.0)), True, "a test"),))
    proof = prove(replace(case, model=replace(case.model, spec=spec)), lambda: pytest.fail("nothing need be solved"))
    assert proof.status is Outcome.BEYOND
    assert "obey conditions" in proof.reason


def test_of_all_stationary_initial_times_before_a_reference_minima_are_proved() -> None:
    """From 2 to cos(t) at t = 3, in a drift of -sin(t): (2 - cos t0)^2/(2 (3 - t0)), and what the parameter costs."""
    case = drifting("caught", initial={"q": 2.0}, final={"q": "reference"}, tf=3.0, t0="free", parameters={"a": 1.0})
    seen = set()
    with mpmath.workdps(40):

        def cost(begin: Any) -> Any:
            return (2 - mpmath.cos(begin)) ** 2 / (2 * (3 - begin)) + 2 * mpmath.sin(3)

        for begin in roots(lambda s: mpmath.diff(cost, s), -7, 2.5):
            times = np.linspace(float(begin), 3.0, 41)
            pace = float((mpmath.cos(begin) - 2) / (3 - begin))
            states = 2 + pace * (times - times[0]) + np.cos(times) - np.cos(times[0])
            given = found_of(case, times, states, np.full(41, pace), (1.0, 0.0))
            proof = prove(case, lambda given=given: given)
            least = mpmath.diff(cost, begin, 2) > 0
            assert proof.status is (Outcome.PROVED if least else Outcome.NOT_PROVED), proof.reason
            assert holds(proof, cost(begin))
            centre, radius = number(proof, "time.t0")
            assert abs(centre - begin) <= radius
            seen.add(bool(least))
    assert seen == {True, False}
