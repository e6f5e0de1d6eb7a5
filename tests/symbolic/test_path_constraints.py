"""What is derived of path constraints: orders, boundary controls, multipliers, junctions; and what is refused."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
import sympy as sp

from satsym.report.latex.document import render
from satsym.symbolic import Angle, Ball, Box, FirstOrder, Problem, Variable, derive, symbols_of
from satsym.symbolic.derivation import DerivationError, Step
from satsym.symbolic.model import Convention, t
from satsym.symbolic.principle.path import mixed_constraints
from satsym.symbolic.principle.path import path_constraints as steps
from tests.support.derived import derived, document, shipped, stated

STATES = tuple(Variable(name, name) for name in ("a", "b", "d", "e"))
(a, b, d, e), (u,) = symbols_of(STATES), symbols_of((Variable("u", "u"),))
CHAIN = FirstOrder(
    name="chain_of_three",
    title="Three integrators, and a state that nothing moves",
    states=STATES,
    controls=(Variable("u", "u"),),
    parameters=(),
    rates={a: b, b: d, d: u, e: -e},
)


TWO = FirstOrder(
    name="two_of_two",
    title="Two integrators",
    states=(Variable("x", "x"), Variable("y", "y")),
    controls=(Variable("v", "v"), Variable("w", "w")),
    parameters=(),
    rates=dict(zip(sp.symbols("x y", real=True), sp.symbols("v w", real=True), strict=True)),
)


def kept(constraint: sp.Expr, **more: Any) -> Problem:
    stated = {"name": "kept", "title": "", "model": CHAIN, "running_cost": u**2 / 2} | more
    return Problem(**{"path_constraints": {"bound": constraint}, **stated})


def values(step: Step) -> dict[str, sp.Expr]:
    return {equation.name: equation.rhs for equation in step.equations}


def test_the_control_on_a_floor_balances_weight_and_centrifugal_force():
    found = shipped("return_above")
    r, o, mu = (sp.Symbol(name, real=True, positive=name != "theta_dot" or None) for name in ("r", "theta_dot", "mu"))
    assert [one.order for one in steps.constraints(found)] == [2]
    control = values(found.step("boundary_control"))
    assert sp.simplify(control["floor_u1"] - (mu / r**2 - r * o**2)) == 0
    assert sp.simplify(control["floor_u2"] - found.equation("stationarity.u2_hat").rhs) == 0
    jumps = values(found.step("junction_conditions"))
    assert jumps["floor_lambda_r"] == -sp.Symbol("zeta_floor", real=True)
    assert jumps["floor_H"] == 0


def test_a_constraint_of_order_one_has_a_multiplier_and_no_jump():
    found = derived(kept(d - 1))
    assert [one.order for one in steps.constraints(found)] == [1]
    lam = sp.Symbol("lambda_b", real=True)
    assert values(found.step("constraint_multiplier"))["bound_eta"] == -lam
    assert values(found.step("junction_conditions"))["bound_jump"] == 0


def test_with_the_maximum_convention_costates_change_their_sign_and_multipliers_do_not():
    problem = stated("bryson_denham")
    assert isinstance(problem, Problem)
    found = derived(replace(problem, convention="maximum"))
    zeta = sp.Symbol("zeta_wall", real=True)
    assert values(found.step("junction_conditions"))["wall_lambda_x"] == -zeta
    assert values(found.step("constrained_costates"))["wall_lambda_x"] == sp.Symbol("eta_wall", real=True)


@pytest.mark.parametrize(("weight", "alike"), [(1, True), (1 - t, False)])
def test_weights_that_depend_on_time_are_not_said_to_be_convex(weight: sp.Expr, alike: bool):
    """However often they are looked at, they may be negative in between."""
    problem = kept(d - t, running_cost=(u**2 + weight * a**2) / 2)
    assert mixed_constraints.linear_quadratic(derived(problem)) == alike


@pytest.mark.parametrize("direction", ["minimum", "maximum"])
def test_a_constraint_that_holds_a_control_decides_it_where_the_law_would_violate_it(direction: Convention):
    """With both controls in it they share what is too much by their weights."""
    states, controls = symbols_of(TWO.states), symbols_of(TWO.controls)
    (x, y), (v, w) = states, controls
    found = derived(
        Problem(
            name="shared",
            title="",
            model=TWO,
            running_cost=v**2 / 2 + w**2,
            path_constraints={"cap": v + 2 * w + x * y - 1},
            convention=direction,
        )
    )
    step, sign = values(found.step("mixed_constraints")), 1 if direction == "minimum" else -1
    by_x, by_y = (sp.Symbol(f"lambda_{name}", real=True) * sign for name in ("x", "y"))
    free = -by_x - by_y + x * y - 1
    wanted = {"cap_vanishing": free, "cap_eta": free / 3, "cap_v": -by_x - free / 3, "cap_w": -by_y / 2 - free / 3}
    assert {name: sp.simplify(step[name] - value) for name, value in wanted.items()} == dict.fromkeys(wanted, 0)
    pushed = values(found.step("mixed_costates"))["cap_lambda_x"]
    assert sp.simplify(pushed + sign * y * sp.Symbol("eta_cap", real=True)) == 0


def test_bounds_of_a_box_are_constraints_like_others():
    found = derived(kept(d - 1, control_set="box"))
    step, top = values(found.step("mixed_constraints")), sp.Symbol("u_max", real=True)
    assert step["u_max"] == sp.Symbol("u", real=True) - top
    assert step["u_max_u"] == top
    assert sp.simplify(step["u_max_eta"] - step["u_max_vanishing"]) == 0
    assert r"u^{\max}" in render(found, "en")


@pytest.mark.parametrize("convention", ["minimum", "maximum"])
def test_controls_that_are_not_in_closed_form_stay_symbols_with_rates(convention: Convention):
    """With the cost cosh u: cosh(u) u' = -lambda_d', which is lambda_b; on d <= 1 it vanishes with u."""
    found = derived(kept(d - 1, running_cost=sp.cosh(u), convention=convention))
    eta, lam = sp.Symbol("eta_bound", real=True), sp.Symbol("lambda_b", real=True)
    side = 1 if convention == "minimum" else -1
    assert sp.simplify(values(found.step("control_rates"))["bound_u"] - (side * lam + eta) / sp.cosh(u)) == 0
    assert values(found.step("constraint_multiplier")) == {"bound_vanishing": u, "bound_eta": -side * lam}
    assert values(found.step("junction_conditions"))["bound_jump"] == 0
    assert "boundary_control" not in found


def test_a_constraint_in_which_controls_stand_otherwise_than_linearly_has_conditions_for_them():
    found = derived(kept(u**2 + b**2 - 1))
    step, eta = values(found.step("mixed_constraints")), sp.Symbol("eta_bound", real=True)
    assert sp.simplify(step["bound_u"] - (u + sp.Symbol("lambda_d", real=True) + 2 * eta * u)) == 0
    pushed = values(found.step("mixed_costates"))["bound_lambda_b"]
    assert sp.simplify(pushed + 2 * b * eta + sp.Symbol("lambda_a", real=True)) == 0


@pytest.mark.parametrize("language", ["en", "id"])
def test_laws_near_the_boundary_of_an_angle_are_typeset(language: str):
    stirred = replace(CHAIN, rates={a: b, b: d, d: sp.sin(u), e: -e}, controls=(Variable("u", "u", kind="angle"),))
    problem = kept(b - 1, model=stirred, running_cost=1, control_sets={"push": Angle("u")})
    with_mixed = replace(problem, path_constraints={"bound": b - 1, "push": sp.cos(u) - d})
    text = render(derived(with_mixed), language).replace("\n", " ")
    assert r"\frac{d u}{dt}" in text
    assert r"\eta_{2}" in text


@pytest.mark.parametrize("language", ["en", "id"])
def test_it_is_typeset(language: str):
    text = document("return_in_slot", language)
    assert r"\theta - \Delta - \omega t \le 0" in text.replace("\n", " ")
    assert r"\eta_{1}" in text
    assert r"\zeta_{2}" in text


WAY = Variable("w", "w", kind="angle")
TURNED = replace(CHAIN, rates={a: b, b: d, d: u, e: sp.cos(symbols_of((WAY,))[0])}, controls=(*CHAIN.controls, WAY))


@pytest.mark.parametrize(
    ("problem", "message"),
    [
        (kept(e - 1), "no control influences it, so it cannot be enforced"),
        (kept(a - 1), "its order exceeds 2"),
        (
            kept(b - 1, model=TURNED, running_cost=a**2, control_sets={"push": Box("u"), "way": Angle("w")}),
            "H is linear in u; path constraints are derived only where",
        ),
        (kept(b - 1, running_cost=a * u**2, control_sets={"push": Box("u")}), "not always convex in u, which may"),
        (kept(b - 1, control_sets={"push": Ball("u")}), "bounds on the norm of controls are not supported"),
        (kept(b - sp.Symbol("q", real=True)), "uses undeclared symbols: q"),
        (kept(b - 1, control_set="ball"), "bounds on the norm of controls are not supported"),
        (replace(kept(b - 1, control_set="box"), path_constraints={"u_max": b - 1}), "is the name of a bound"),
        (kept(b - 1, control_sets={"p": Box("u")}, path_constraints={"u_max": b - 1}), "is the name of a bound"),
        (replace(kept(b - 1), path_constraints={"no name": b - 1}), "the name of a constraint must be"),
        (replace(kept(b - 1), path_constraints=(b - 1,)), "write a name for each"),  # type: ignore[arg-type]
    ],
)
def test_what_cannot_be_derived_is_refused(problem: Problem, message: str):
    with pytest.raises(DerivationError, match=message):
        derive(problem)


def test_a_wrong_rate_of_a_control_fails_its_check(monkeypatch: pytest.MonkeyPatch):
    true = steps.rates_of_controls
    monkeypatch.setattr(steps, "rates_of_controls", lambda *of: {u: true(*of)[u] + b / 8})
    with pytest.raises(DerivationError, match="failed its check"):
        derive(kept(d - 1, running_cost=sp.cosh(u)))


@pytest.mark.parametrize("wrong", ["multiplier", "rate", "costate", "control"])
def test_a_wrong_equation_fails_its_check(wrong: str, monkeypatch: pytest.MonkeyPatch):
    """Mutations of what the steps are made of: none passes."""
    if wrong == "multiplier":
        monkeypatch.setattr(steps, "canonical", _with_sign(steps.canonical))
    elif wrong == "rate":
        true = steps.total_derivative
        monkeypatch.setattr(steps, "total_derivative", lambda e, rates: true(e, rates) + a)
    elif wrong == "costate":
        true_change = steps.sign
        monkeypatch.setattr(steps, "sign", lambda problem: 2 * true_change(problem))
    else:
        true_law = steps.affine
        monkeypatch.setattr(steps, "affine", lambda *of: (true_law(*of)[0], sp.Integer(1)))
    with pytest.raises(DerivationError, match="failed its check"):
        derive(kept(d - a**2))


def _with_sign(true: Any) -> Any:
    """Costate equations with a wrong term."""

    def canonical(so_far: Any, found: Any) -> Any:
        moving = true(so_far, found)
        return {symbol: rate + (b if symbol.name == "lambda_b" else 0) for symbol, rate in moving.items()}

    return canonical
