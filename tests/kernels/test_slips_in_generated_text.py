"""A slip in the least term of a generated function is seen; rounding in one that is right is not taken for a slip."""

from __future__ import annotations

import ast
import math
from functools import cache

import pytest
import sympy as sp

from satsym import kernels
from satsym.codegen import module, verify
from satsym.report.artefacts import generated
from satsym.spec import ControlSetKind, Variable
from satsym.symbolic import Derivation, DerivationError, FirstOrder, Problem, derive, symbols_of

STATES = (Variable("x", "x"), Variable("y", "y"))
CONTROLS = (Variable("u", "u"),)
(x, y), (u,) = symbols_of(STATES), symbols_of(CONTROLS)
v = sp.Symbol("v", real=True)
SMALL = sp.Rational(1, 10**8)


def problem(rate: sp.Expr, cost: sp.Expr = x**2) -> Problem:
    model = FirstOrder(name="m", title="M", states=STATES, controls=CONTROLS, parameters=(), rates={x: y, y: rate})
    return Problem(name="task", title="Task", model=model, running_cost=cost + u**2 / 2, control_set="box")


@cache
def case() -> tuple[Derivation, str]:
    derivation = derive(problem(u - 3 * x**3 + SMALL * sp.sin(y) + sp.Float("0.0317") * sp.Float("1.7") * x * y))
    return derivation, module.render(derivation, "task.py")


def of_function(text: str, name: str) -> ast.FunctionDef:
    return next(n for n in ast.parse(text).body if isinstance(n, ast.FunctionDef) and n.name == name)


@pytest.mark.parametrize(
    "name", ["dynamics", "dynamics_batch", "hamiltonian_batch", "canonical", "forward", "backward"]
)
def test_a_millionth_of_a_term_of_a_hundred_millionth_is_seen(name: str) -> None:
    derivation, text = case()
    node = of_function(text, name)
    lines = text.splitlines()
    place = next(
        k for k in range(node.lineno, node.end_lineno or 0) if "1e-08" in lines[k] or "/100000000.0" in lines[k]
    )
    wrong = lines[place].replace("1e-08", "1.000001e-08").replace("/100000000.0", "/99999900.0")
    assert wrong != lines[place]
    verify.verify(derivation, kernels.from_text(text, "task.py"))
    changed = "\n".join([*lines[:place], wrong, *lines[place + 1 :]]) + "\n"
    with pytest.raises(DerivationError, match=f"generated {name} deviates by .* from the derivation"):
        verify.verify(derivation, kernels.from_text(changed, "task.py"))


@pytest.mark.parametrize(
    "rate",
    [
        u + sp.Integer(10) ** 9 * ((x + y) ** 5 - x**5),
        u - sp.Float("1e6") * sp.tanh(x) + sp.Float("1.234567e-6") * sp.exp(-x) * sp.Float("0.1") ** 3,
        u + 10**7 * sp.cos(10**4 * x) * y,
        u + sp.exp(25 * x) - y**9 / 7,
        u + sp.Integer(10) ** 9 * x,
    ],
)
def test_right_functions_with_numbers_of_any_size_are_generated(rate: sp.Expr) -> None:
    _, found = generated(derive(problem(rate)), "task.py")
    at = {x: 0.3, y: -0.7, u: 0.2}
    exact = float(rate.subs({name: sp.Rational(str(value)) for name, value in at.items()}).evalf(60))
    assert found.dynamics(0.0, (at[x], at[y]), (at[u],), ()) == pytest.approx((at[y], exact), rel=1e-12)


def test_a_motion_that_leaves_the_domain_in_a_step_is_followed_in_shorter_ones() -> None:
    above = Variable("a", "a", positive=True)
    (a,) = symbols_of((above,))
    rates = {a: -(10**4) * (1 + x**2), x: u + sp.sin(a ** sp.Rational(1, 3)), y: x}
    model = FirstOrder(name="m", title="M", states=(above, *STATES), controls=CONTROLS, parameters=(), rates=rates)
    _, found = generated(derive(Problem(name="root", title="Root", model=model, running_cost=u**2 / 2)), "root.py")
    assert found.dynamics(0.0, (8.0, 3.0, 0.0), (0.5,), ()) == pytest.approx((-(10.0**5), 0.5 + math.sin(2.0), 3.0))


@pytest.mark.parametrize(
    ("control_set", "cost", "right", "wrong"),
    [
        ("ball", 50 * u**2 + 50 * v**2, "(1.0/10000.0)*lambda_x*", "(1.000001/10000.0)*lambda_x*"),
        ("box", sp.Integer(1), "0.5*(u_min + u_max)", "0.5*(u_min + 1.000001*u_max)"),
    ],
)
def test_a_slip_is_seen_that_only_bounds_beyond_all_controls_show_or_vanishing_costates(
    control_set: ControlSetKind, cost: sp.Expr, right: str, wrong: str
) -> None:
    controls = (*CONTROLS, Variable("v", "v"))
    model = FirstOrder(name="m", title="M", states=STATES, controls=controls, parameters=(), rates={x: u + y, y: v - x})
    stated = Problem(name="law", title="Law", model=model, running_cost=cost, control_set=control_set)
    derivation = derive(stated)
    text = module.render(derivation, "law.py")
    head, law = text.split("def control_law(t", 1)
    assert right in law
    verify.verify(derivation, kernels.from_text(text, "law.py"))
    changed = f"{head}def control_law(t{law.replace(right, wrong, 1)}"
    with pytest.raises(DerivationError, match="generated control_law deviates"):
        verify.verify(derivation, kernels.from_text(changed, "law.py"))


def refuse(derivation: Derivation, text: str, function: str, right: str, wrong: str) -> None:
    """Accept a text as it is, and refuse it for that function with one part of it changed."""
    head, name, tail = text.partition(f"def {function}(")
    assert right in tail.split("\ndef ", 1)[0]
    verify.verify(derivation, kernels.from_text(text, "task.py"))
    with pytest.raises(DerivationError, match=f"generated {function} deviates"):
        verify.verify(derivation, kernels.from_text(head + name + tail.replace(right, wrong, 1), "task.py"))


@pytest.mark.parametrize("share", [1e-6, -1e-6, 1e-3])
@pytest.mark.parametrize("step", ["(w_3 - u_min, 1.0)", "(u_max - w_3, 1.0)"])
def test_a_threshold_that_is_wrong_by_little_is_seen(step: str, share: float) -> None:
    refuse(*case(), "canonical_jacobian_batch", step, step.replace("u_m", f"{1.0 + share!r}*u_m"))


def test_a_slip_that_acts_on_the_result_by_its_square_is_seen() -> None:
    """The control minimises the Hamiltonian, which does not change to first order where the control is wrong."""
    derivation = derive(problem(u / 1250 - 3 * x, u * sp.sqrt(1 + x**2) * y**2 / 6131 + 10**9))
    right = "w_3 = -1.0/1250.0*lambda_y - w_2\n"
    text = module.render(derivation, "task.py")
    refuse(derivation, text, "boundary", right, right.replace("w_2", "1.000001*w_2"))
