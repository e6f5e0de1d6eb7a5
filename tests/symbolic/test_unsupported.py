"""What is not derived is refused in one line that says what, where and what to do; a terminal cost alone is enough."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
import sympy as sp

import satsym
from satsym.status import BadInput, Status
from satsym.symbolic import FirstOrder, Newton, Problem, Variable, symbols_of, t

STATES = (Variable("x", "x"), Variable("v", "v"))
(x, v), u = symbols_of(STATES), sp.Symbol("u", real=True)
X, G = sp.Function("x"), sp.Function("g")
DELAYED, GIVEN, UNKNOWN = "x(t - 1), a value at another time", "contains x(t); write x", "g(x), an unknown"
JUMPS = "whose derivatives jump"

SAID: list[tuple[sp.Basic, str]] = [
    (X(t - 1), DELAYED),
    (X(t), GIVEN),
    (G(x), UNKNOWN),
    (sp.Derivative(X(t), t), "an unevaluated derivative"),
    (sp.Derivative(G(x), x), "an unevaluated derivative"),
    (sp.Integral(sp.exp(-t * x * t), (t, 0, 1)), ", which has no closed form"),
    (sp.Piecewise((x, x > 0), (0, True)), JUMPS),
    (sp.Heaviside(x), JUMPS),
    (sp.Max(x, t), JUMPS),
    (sp.sign(x), JUMPS),
    (sp.erf(x), "the function erf, which is not supported"),
    (sp.floor(t), "the function floor, which is not supported"),
    (sp.Piecewise((1, sp.Eq(t, 1)), (0, True)), "whose conditions do not cover all times"),
    (x > 0, "is the condition x > 0"),
]


def stated(place: str = "", what: sp.Basic = sp.Integer(0), **fields: object) -> Problem:
    rates = {x: v, v: u}
    if place == "rate of v":
        rates[v] = u + what if not isinstance(what, sp.logic.boolalg.Boolean) else what
    model = FirstOrder(name="m", title="M", states=STATES, controls=(Variable("u", "u"),), parameters=(), rates=rates)
    given: dict[str, object] = {"running_cost": u**2}
    given |= {
        "running cost": {"running_cost": u**2 + what} if place == "running cost" else {},
        "terminal cost": {"terminal_cost": what},
        "terminal constraint": {"terminal_constraints": (what,)},
        "terminal inequality late": {"terminal_inequalities": {"late": what}},
        "path constraint low": {"path_constraints": {"low": what}},
        "interior point gate": {"interior": {"gate": (what,)}},
    }.get(place, {})
    return Problem(name="task", title="T", model=model, **{**given, **fields})


@pytest.mark.parametrize(("what", "said"), SAID, ids=[str(what) for what, _ in SAID])
def test_it_is_refused_in_a_rate(what: sp.Basic, said: str) -> None:
    with pytest.raises(BadInput) as caught:
        satsym.derive(stated("rate of v", what))
    assert str(caught.value).startswith("task: the rate of v ")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "place",
    [
        *("running cost", "terminal cost", "terminal constraint", "terminal inequality late", "path constraint low"),
        "interior point gate",
    ],
)
def test_it_is_said_where_it_stands(place: str) -> None:
    with pytest.raises(BadInput, match=f"task: (the|a) {place} contains x[(]t - 1[)]"):
        satsym.derive(stated(place, X(t - 1)))


def test_a_force_is_refused_by_its_name() -> None:
    model = Newton(
        name="bead",
        title="B",
        states=STATES,
        controls=(Variable("u", "u"),),
        parameters=(),
        coordinates={x: v},
        position=sp.Matrix([x]),
        forces={"drag": sp.Matrix([u - X(t - 1)])},
        directions={"along": sp.Matrix([1])},
    )
    with pytest.raises(BadInput, match=r"the force 'drag' contains x[(]t - 1[)], a value at another time"):
        satsym.derive(Problem(name="slide", title="S", model=model, running_cost=u**2))


def test_a_file_is_refused_in_one_line_and_with_exit_code_3(tmp_path: Path) -> None:
    path = tmp_path / "late.py"
    path.write_text(
        "from sympy import Function\n"
        "from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of, t\n"
        "X, U = (Variable('x', 'x'),), (Variable('u', 'u'),)\n"
        "(x,), (u,) = symbols_of(X), symbols_of(U)\n"
        "m = FirstOrder(name='m', title='', states=X, controls=U, parameters=(), rates={x: u - Function('x')(t - 1)})\n"
        "PROBLEMS = (Problem(name='late', title='L', model=m, running_cost=u**2),)\n"
    )
    asked = [sys.executable, "-m", "satsym", "derive", str(path), "--out", str(tmp_path / "out")]
    found = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert found.returncode == 3
    assert "delays are not supported" in found.stderr
    assert len(found.stderr.strip().splitlines()) == 1


def test_a_terminal_cost_alone_makes_a_problem() -> None:
    # as far to the right as goes: u = 1 throughout, x(2) = 2
    problem = stated(running_cost=sp.Integer(0), terminal_cost=-x, control_set="box")
    bare = Problem(name="task", title="T", model=problem.model, terminal_cost=-x, control_set="box")
    assert bare == problem
    given = {"initial": {"x": 0, "v": 0}, "final": {"v": (-3.0, 3.0)}, "tf": 2, "control": {"u": [-1, 1]}}
    found = satsym.solve(satsym.Instance.of(bare, **given))
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(-2.0, rel=1e-10)


def test_neither_cost_is_refused_with_what_least_time_needs() -> None:
    with pytest.raises(BadInput, match=r"no objective; give a running_cost [(]1 for minimum time[)] or"):
        satsym.derive(stated(running_cost=sp.Integer(0), control_set="box"))


def test_a_terminal_cost_alone_needs_bounds_of_what_enters_linearly() -> None:
    with pytest.raises(
        BadInput, match=r'H is linear in the controls, .* this requires control_set = "box", not "free"'
    ):
        satsym.derive(stated(running_cost=sp.Integer(0), terminal_cost=x**2))


def test_a_terminal_cost_alone_may_be_of_a_state_that_bends() -> None:
    # the rate of v has -u^2 + u in it: H = lambda_v (u - u^2) has its minimum where lambda_v is negative at u = 1/2
    model = stated().model
    bent = FirstOrder(
        name="m", title="M", states=STATES, controls=model.controls, parameters=(), rates={x: v, v: u - u**2}
    )
    problem = Problem(name="task", title="T", model=bent, terminal_cost=-v, control_set="box")
    given = {"initial": {"x": 0, "v": 0}, "tf": 2, "control": {"u": [-1, 1]}}
    found = satsym.solve(satsym.Instance.of(problem, **given))
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(-0.5, rel=1e-10)
