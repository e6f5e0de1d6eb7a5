"""Singular arcs: their feedback, its slope, and the bounds of the control on them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.optimize import minimize
from sympy import cos, sin, sqrt

from satsym import solvers as solve
from satsym.instance import Instance
from satsym.solvers import certificate, iteration
from satsym.solvers.by_search import bang_bang
from satsym.solvers.certificate.switching import conditions as certifying
from satsym.solvers.certificate.switching import replay as replaying
from satsym.solvers.certificate.switching.integration import Integration, OutOfTime
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.structure import SINGULAR
from satsym.status import Status
from satsym.symbolic import Problem, t
from tests.support.switching_closed_forms import TIME
from tests.support.switching_closed_forms import case as shipped_case
from tests.switching.test_switching_models import case, problem, v, w, x, y

VAN_DER_POL = problem("van_der_pol", {x: y, y: -x + y * (1 - x**2) + v}, (x**2 + y**2) / 2, ("v",))
TWISTED = problem("twisted", {x: y + w * x, y: x**3 + v * (1 + x**2)}, x**4 + y**2, ("v", "w"))
TIMED = problem("timed", {x: y * cos(t), y: v * (1 + sin(t) / 2) - x * t}, x**2 * (1 + t) + y**2, ("v",))


def instance(folder: Path, one: Problem, start: tuple[float, ...], tf: float) -> Instance:
    return case(folder, one, start, None, str(tf))


@pytest.mark.slow
@pytest.mark.parametrize("one", [VAN_DER_POL, TWISTED, TIMED], ids=lambda one: one.name)
def test_a_singular_feedback_and_its_slope_are_those_of_the_formulas(tmp_path: Path, one: Problem) -> None:
    # The control that keeps the second derivative of the switching function at zero, by symbolic differentiation.
    held = instance(tmp_path, one, (0.3, -0.7), 3.0)
    states, controls = (x, y), (v, w)[: len(one.model.controls)]
    lam = sp.symbols("l1 l2")
    rates = [one.model.rates[s] for s in states]
    h = one.running_cost + sum(a * b for a, b in zip(lam, rates, strict=True))
    z, flow = (*states, *lam), [*rates, *(-sp.diff(h, s) for s in states)]

    def along(f: sp.Expr) -> sp.Expr:
        return sp.diff(f, t) + sum(sp.diff(f, s) * r for s, r in zip(z, flow, strict=True))

    level = dict.fromkeys(controls[1:], -1)
    flow = [sp.sympify(f).subs(level) for f in flow]
    (law,) = sp.solve(along(along(sp.diff(h, controls[0]))), controls[0])
    at, here = (0.4, 0.3, -0.7, 0.5, 0.2), (t, *z)
    field = Field(held, (SINGULAR, *(-1 for _ in controls[1:])))
    known = [float(sp.sympify(f).subs(dict(zip(here, at, strict=True)))) for f in (law, *(sp.diff(law, s) for s in z))]
    full = [f.subs(controls[0], law) for f in flow]
    slopes = [[float(sp.diff(f, s).subs(dict(zip(here, at, strict=True)))) for s in z] for f in full]
    now, matrix = field.linearised(at[0], list(at[1:]))
    assert field.control(at[0], list(at[1:]))[0] == pytest.approx(known[0], rel=1e-13)
    assert now == pytest.approx(field.rates(at[0], list(at[1:])), rel=1e-14)
    size = max(map(max, slopes))
    assert matrix == pytest.approx(np.array(slopes), rel=1e-11 if one is TIMED else 1e-13, abs=1e-13 * size)


def test_a_singular_arc_of_the_largest_cost_fails_the_legendre_clebsch_condition(tmp_path: Path) -> None:
    """At rest in the origin the costs x^2 / 2 and -x^2 / 2 have the same extremal: a minimum and a maximum."""
    least, largest = (
        instance(tmp_path, problem(name, {x: v}, cost, ("v",)), (0.0,), 3.0)
        for name, cost in (("regulator", x**2 / 2), ("reward", -(x**2) / 2))
    )
    found = solve.solve(least, examined=False)
    again = certificate.certify(replace(found, instance=largest), compared=False)
    assert again is not None
    assert (again.verdict, again.legendre_clebsch) == ("extremal only", pytest.approx(-1.0))
    assert "generalised legendre-clebsch" in [check.name for check in again.checks if not check.passed]


def cost_of(start: tuple[float, float], tf: float, signs: tuple[float, float], times: np.ndarray) -> float:
    """Of two full arcs and the singular feedback: there the costate of y vanishes and that of x is -y, so y' = x."""
    state, begin, edges = np.array([*start, 0.0]), 0.0, [*times, tf]
    if not 0.0 < edges[0] < edges[1] < tf:
        return 1e3
    for sign, end in zip((*signs, None), edges, strict=True):

        def rates(_t: float, z: np.ndarray, sign: float | None = sign) -> list[float]:
            damped = -z[0] + z[1] * (1.0 - z[0] ** 2)
            return [z[1], z[0] if sign is None else damped + sign, (z[0] ** 2 + z[1] ** 2) / 2.0]

        state = solve_ivp(rates, (begin, end), state, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        begin = end
    return float(state[2])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "tf", "signs", "about"),
    [((-1.0, 0.3), 3.0, (1.0, -1.0), (0.1, 1.9))],
)
def test_van_der_pols_oscillator_ends_in_a_singular_arc_within_its_bounds(
    tmp_path: Path, start: tuple[float, float], tf: float, signs: tuple[float, float], about: tuple[float, float]
) -> None:
    # In the second case the feedback alone would ask for u = -1.9: there the control stays on its bound for longer.
    found = solve.solve(instance(tmp_path, VAN_DER_POL, start, tf))
    known = minimize(
        lambda times: cost_of(start, tf, signs, times), about, method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 0}
    )
    assert found.status is Status.CONVERGED, found.message
    assert np.abs(found.u).max() <= 1.0 + 1e-9
    assert found.objective == pytest.approx(known.fun, abs=1e-10)
    assert found.switching_times[0] == pytest.approx(known.x, abs=1e-5)
    assert found.certificate is not None
    assert found.certificate.verdict == "certified"
    assert "Goh" in found.certificate.because


def test_a_certificate_that_takes_too_much_work_fails_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = bang_bang(instance(tmp_path, problem("regulator", {x: v}, x**2 / 2, ("v",)), (1.2,), 3.0))
    monkeypatch.setattr(replaying, "EVALUATIONS", 50)
    monkeypatch.setattr(certifying, "EVALUATIONS", 50)
    verdict = certificate.certify(found)
    assert verdict is not None
    assert verdict.verdict == "failed"
    failed = [c.name for c in verdict.checks if not c.passed]
    assert failed == ["flow from the initial costates is integrated within 50 evaluations"]


def test_time_that_ends_while_checks_are_made_neither_certifies_nor_fails() -> None:
    found = bang_bang(shipped_case(TIME))
    for seconds in (0.0, 0.02):
        hurried = replace(found.instance, solver=msgspec.structs.replace(found.instance.solver, max_seconds=seconds))
        verdict = certificate.certify(replace(found, instance=hurried, wall_s=0.0))
        assert verdict is not None
        assert verdict.verdict == "extremal only"
        assert verdict.not_checked
        assert all(c.name.startswith("not checked within the time limit: ") for c in verdict.checks if not c.passed)


@pytest.mark.parametrize("looks", range(1, 7))
def test_time_that_ends_between_two_looks_at_the_clock_is_no_excess_of_work(
    looks: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = iter([0.0] * looks + [2.0] * 100)
    monkeypatch.setattr(iteration, "computed", lambda: next(clock))
    by = Integration(np.ones(2), iteration.Limits(iteration.MOST_ITERATIONS, deadline=1.0))
    with pytest.raises(OutOfTime):
        by.solved(lambda t, y: -y, SimpleNamespace(start=0.0, end=1.0, lasting=1.0), np.ones(1), np.ones(1))


HUMP = problem("hump", {x: v}, x**2 / (1 + x**4), ("v",))
"""Back to zero over the hump at x = 1, or away from it for good: either is an extremal."""


@pytest.mark.slow
def test_a_cheaper_arc_at_rest_is_found_beside_a_control_held_at_a_bound(tmp_path: Path) -> None:
    found = solve.solve(instance(tmp_path, HUMP, (1.2,), 10.0))
    known = float(sp.Integral(HUMP.running_cost, (x, 0, 1.2)).evalf())
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(known, abs=1e-10)
    assert found.switching_times[0] == pytest.approx((1.2,), abs=1e-9)


@pytest.mark.slow
def test_running_away_is_not_certified_where_coming_to_rest_is_cheaper(tmp_path: Path) -> None:
    base = bang_bang(instance(tmp_path, HUMP, (1.2,), 10.0))
    cost = sp.lambdify(x, HUMP.running_cost)
    times = np.linspace(0.0, 10.0, 201)
    away = replace(
        base,
        times=times,
        x=1.2 + times[None],
        u=np.ones((1, 201)),
        lam=cost(11.2) - cost(1.2 + times[None]),  # as x' = 1, the costate is what the cost has yet to grow
        objective=float(sp.Integral(HUMP.running_cost, (x, 1.2, 11.2)).evalf()),
        switching_times=((),),
    )
    verdict = certificate.certify(away)
    assert verdict is not None
    assert verdict.verdict == "extremal only", verdict.checks
    assert [c.name for c in verdict.checks if not c.passed] == ["cheaper by: seeded starts"]


def test_a_corner_beyond_the_domain_of_the_cost_does_not_end_the_search(tmp_path: Path) -> None:
    # Held at -1 the motion ends at x = -1/2, where the root has no value.
    one = replace(problem("root", {x: v}, sp.Integer(0), ("v",)), terminal_cost=-sqrt(x))
    found = solve.solve(instance(tmp_path, one, (0.5,), 1.0))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(-(1.5**0.5), abs=1e-12)


def test_a_replay_sees_two_changes_of_sign_within_one_step(tmp_path: Path) -> None:
    # Held at its bound, the switching function would dip below zero for a moment only.
    wide = replace(instance(tmp_path, VAN_DER_POL, (1.45, 1.03), 1.26), lower=(-2.0,), upper=(2.0,))
    found = bang_bang(wide)
    assert found.status is Status.CONVERGED, found.message
    again = replaying.replay(found)
    assert again is not None
    assert again.switching_times(0) == pytest.approx(found.switching_times[0], abs=1e-10)
