"""The machine checks can fail: errors planted in what a step derives are caught by that very step."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

from satsym.symbolic import (
    Check,
    Derivation,
    DerivationError,
    FirstOrder,
    Problem,
    Step,
    Variable,
    derive,
    dimensions,
    loader,
    pipeline,
    symbols_of,
)
from satsym.symbolic.kinds import newton as mechanics
from satsym.symbolic.motion import steps as motion
from satsym.symbolic.principle import control_sets, pontryagin
from tests.support.derived import derived, shipped

POLAR, *_ = loader.load(Path(__file__).resolve().parents[2] / "derivations" / "polar_orbit.py")
STEPS = {f.__name__: f for f in (*POLAR.model.steps(), *pipeline.MINIMUM_PRINCIPLE)}


@pytest.fixture(scope="module")
def polar() -> Derivation:
    return derived(POLAR)


@pytest.fixture(scope="module")
def walled() -> Derivation:
    """A body whose distance is bounded."""
    return shipped("bryson_denham")


@pytest.fixture(scope="module")
def held() -> Derivation:
    """A control that a state bounds."""
    return shipped("rayleigh_mixed")


@pytest.fixture(scope="module")
def passing() -> Derivation:
    """A point that is passed on the way."""
    return shipped("inspection")


@pytest.fixture(scope="module")
def ball() -> Derivation:
    """Two controls of equal weight, their norm bounded."""
    states, controls = ((Variable("x1", "x_1"), Variable("x2", "x_2")), (Variable("u1", "u_1"), Variable("u2", "u_2")))
    (x1, x2), (u1, u2) = symbols_of(states), symbols_of(controls)
    rates = {x1: x2 + u1, x2: -x1 + u2}
    model = FirstOrder(name="m", title="", states=states, controls=controls, parameters=(), rates=rates)
    return derive(Problem(name="p", title="", model=model, running_cost=u1**2 + u2**2, control_set="ball"))


def redo(derivation: Derivation, name: str) -> Step:
    """Take one step again, from what had been derived before it."""
    index = [s.name for s in derivation.steps].index(name)
    before = replace(derivation, steps=derivation.steps[:index])
    step = STEPS[name](before)
    if name == "conserved":  # a constant more is conserved as well, and only its dimension gives it away
        step = replace(step, checks=(*step.checks, dimensions.agreement(dimensions.declared(before), step)))
    return before.extended(step).steps[-1]


class Planted:
    """A function that returns what another one does, except for one planted error."""

    def __init__(self, function: Callable[..., Any], right: sp.Expr, wrong: sp.Expr) -> None:
        self.function, self.right, self.wrong, self.hits = function, right, wrong, 0

    def __call__(self, *arguments: Any) -> Any:
        result = self.function(*arguments)
        found = result == self.right if isinstance(result, sp.MatrixBase) else sp.expand(result - self.right) == 0
        self.hits += found
        return self.wrong if found else result


MUTANTS = [
    # step, module, function whose result is falsified, right, wrong
    ("unit_vectors", mechanics, "tidy", "theta_dot", "-theta_dot"),
    ("position", mechanics, "tidy", "r", "2*r"),
    ("velocity", mechanics, "tidy", "r*theta_dot", "theta_dot"),
    ("acceleration", mechanics, "tidy", "r_ddot - r*theta_dot**2", "r_ddot + r*theta_dot**2"),
    ("acceleration", mechanics, "tidy", "r_ddot - r*theta_dot**2", "r_ddot"),
    ("acceleration", mechanics, "tidy", "r*theta_ddot + 2*r_dot*theta_dot", "r*theta_ddot + r_dot*theta_dot"),
    ("forces", mechanics, "tidy", "-mu/r**2", "mu/r**2"),
    ("forces", mechanics, "tidy", "-mu/r**2", "-mu/r**3"),
    ("forces", mechanics, "tidy", "u2", "u1"),
    ("equations_of_motion", mechanics, "tidy", "u1 + r*theta_dot**2 - mu/r**2", "u1 - mu/r**2"),
    ("equations_of_motion", mechanics, "tidy", "(u2 - 2*r_dot*theta_dot)/r", "(u2 + 2*r_dot*theta_dot)/r"),
    ("conserved", motion, "tidy", "(r_dot**2 + r**2*theta_dot**2)/2", "r_dot**2 + r**2*theta_dot**2"),
    ("conserved", motion, "potential", "-mu/r", "mu/r"),
    ("conserved", motion, "potential", "-mu/r", "-mu/(2*r)"),
    ("linearisation", motion, "tidy", "2*mu/r**3 + theta_dot**2", "-2*mu/r**3 + theta_dot**2"),
    ("linearisation", motion, "tidy", "2*mu/r**3 + theta_dot**2", "2*mu/r**2 + theta_dot**2"),
    ("linearisation", motion, "tidy", "-2*r_dot/r", "-2*r_dot/r**2"),
    ("hamiltonian", pontryagin, "tidy", "(c1*u1**2 + c2*u2**2)/2", "c1*u1**2 + c2*u2**2"),
    ("stationarity", pontryagin, "tidy", "c1*u1 + lambda_r_dot", "c1*u1 - lambda_r_dot"),
    ("stationarity", pontryagin, "tidy", "-lambda_r_dot/c1", "lambda_r_dot/c1"),
    ("stationarity", pontryagin, "tidy", "-lambda_theta_dot/(c2*r)", "-lambda_theta_dot/c2"),
    ("second_derivative", pontryagin, "_hessian", "diag(c1, c2)", "diag(c1, 2*c2)"),
    ("second_derivative", pontryagin, "_hessian", "diag(c1, c2)", "-diag(c1, c2)"),
    (
        "costate_equations",
        pontryagin,
        "tidy",
        "-lambda_r + 2*lambda_theta_dot*theta_dot/r",
        "lambda_r - 2*lambda_theta_dot*theta_dot/r",
    ),
    ("boundary_conditions", pontryagin, "tidy", "k1*(r - sigma)", "k1*(sigma - r)"),
    ("boundary_conditions", pontryagin, "tidy", "k3*omega*(omega*t - theta)", "k3*omega*(theta - omega*t)"),
]


@pytest.mark.parametrize(("step", "module", "function", "right", "wrong"), MUTANTS)
def test_a_planted_error_is_caught(
    polar: Derivation,
    monkeypatch: pytest.MonkeyPatch,
    step: str,
    module: Any,
    function: str,
    right: str,
    wrong: str,
) -> None:
    names = {s.name: s for e in polar.steps for q in e.equations for s in (q.lhs + q.rhs).free_symbols}
    planted = Planted(getattr(module, function), *(sp.sympify(text, locals=names) for text in (right, wrong)))
    monkeypatch.setattr(module, function, planted)
    with pytest.raises(DerivationError, match=r"failed its check|not positive definite"):
        redo(polar, step)
    assert planted.hits


def test_slopes_of_h_that_are_not_the_rates_are_caught(polar: Derivation, monkeypatch: pytest.MonkeyPatch) -> None:
    gradient = pontryagin.gradient
    assert redo(polar, "state_equations").equations == polar.step("state_equations").equations
    monkeypatch.setattr(pontryagin, "gradient", lambda h, by: [*list(gradient(h, by))[:-1], sp.Integer(0)])
    with pytest.raises(DerivationError, match="failed its check"):
        redo(polar, "state_equations")


def test_both_forms_of_h_at_the_minimiser_are_checked(polar: Derivation, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two forms the shorter one stands; a falsified one is longer, so that only both at once show."""
    tidy = pontryagin.tidy
    monkeypatch.setattr(pontryagin, "tidy", lambda *arguments: 1 - tidy(*arguments))
    with pytest.raises(DerivationError, match="failed its check"):
        redo(polar, "minimised_hamiltonian")


UNTIDIED = {"control_rates", "newton", "first_order", "reference", "second_derivative", "control_law"}
"""Steps that tidy nothing, next to others that do in one module."""

UNTIDIED |= {"state_equations", "minimised_hamiltonian"}  # these have tests of their own


@pytest.mark.slow
@pytest.mark.parametrize(
    "step", [name for name, f in STEPS.items() if hasattr(sys.modules[f.__module__], "tidy") and name not in UNTIDIED]
)
def test_no_expression_of_a_step_can_be_falsified(
    polar: Derivation,
    walled: Derivation,
    held: Derivation,
    passing: Derivation,
    monkeypatch: pytest.MonkeyPatch,
    step: str,
) -> None:
    """Every single expression e that a step tidies is made 1 - e in turn: caught, or without any effect."""
    module = sys.modules[STEPS[step].__module__]
    derivation = next(one for one in (polar, walled, held, passing) if step in {known.name for known in one.steps})
    tidy, right = module.tidy, derivation.step(step).equations
    calls = caught = index = 0

    def falsified(*arguments: Any) -> sp.Expr:
        nonlocal calls
        calls += 1
        return 1 - tidy(*arguments) if calls == index else tidy(*arguments)

    monkeypatch.setattr(module, "tidy", falsified)
    redo(derivation, step)
    total = calls
    for index in range(1, total + 1):  # noqa: B007 -- falsified() reads it
        calls = 0
        try:
            assert redo(derivation, step).equations == right
        except DerivationError:
            caught += 1
    assert total
    assert caught


@pytest.mark.parametrize(
    "falsify",
    [
        lambda laws, hats, limits: hats,
        lambda laws, hats, limits: [-u for u in laws],
        lambda laws, hats, limits: laws[::-1],
        lambda laws, hats, limits: [control_sets.Clip(hats[0], *limits[1::2]), *laws[1:]],
        lambda laws, hats, limits: [limits[0], *laws[1:]],
    ],
    ids=["not clipped", "sign", "swapped", "another's bounds", "always the bound"],
)
def test_a_wrong_clipped_law_is_caught(polar: Derivation, monkeypatch: pytest.MonkeyPatch, falsify: Any) -> None:
    _expect_law_caught(polar, monkeypatch, falsify)


@pytest.mark.parametrize(
    "falsify",
    [
        lambda laws, hats, limits: hats,
        lambda laws, hats, limits: [u * limits[0] for u in hats],
        lambda laws, hats, limits: [control_sets.Clip(u, -limits[0], limits[0]) for u in hats],
        lambda laws, hats, limits: [u / 2 for u in laws],
    ],
    ids=["not shortened", "scaled", "clipped instead", "too short"],
)
def test_a_wrong_shortened_law_is_caught(ball: Derivation, monkeypatch: pytest.MonkeyPatch, falsify: Any) -> None:
    _expect_law_caught(ball, monkeypatch, falsify)


def _expect_law_caught(derivation: Derivation, monkeypatch: pytest.MonkeyPatch, falsify: Any) -> None:
    project = control_sets.project
    monkeypatch.setattr(
        control_sets,
        "project",
        lambda kind, hats, limits, hessian: falsify(project(kind, hats, limits, hessian), hats, limits),
    )
    with pytest.raises(DerivationError, match="cheapest admissible"):
        redo(derivation, "control_law")


def test_swapped_components_of_newtons_law_are_caught(polar: Derivation, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sp.Expr, "coeff", lambda self, direction: sp.Integer(0))
    with pytest.raises(DerivationError, match="components add up"):
        redo(polar, "newton")


def test_derive_stops_at_the_step_with_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    tidy = pontryagin.tidy
    monkeypatch.setattr(pontryagin, "tidy", lambda e, by=(): -tidy(e, by))
    with pytest.raises(DerivationError, match="polar_orbit:hamiltonian failed its check"):
        derive(POLAR)


def test_not_a_number_is_no_agreement(polar: Derivation) -> None:
    for check in (Check("c", float("nan"), 1.0), Check("c", 2.0, 1.0)):
        with pytest.raises(DerivationError, match="failed its check 'c'"):
            polar.extended(Step("s", "r", (), (), (check,)))
    with pytest.raises(DerivationError, match="has no machine check"):
        polar.extended(Step("s", "r", (), (), ()))


def test_a_comparison_with_not_a_number_fails() -> None:
    from satsym.symbolic import checks

    x = sp.Symbol("x", real=True)
    for values in ([float("nan"), 1.0], [1.0, float("nan")]):
        assert not checks.compare("claim", [x], lambda point, v=values: (v, [1.0, 1.0])).passed
        assert not checks.never_below("claim", [x], lambda point, rng, v=values: v).passed
