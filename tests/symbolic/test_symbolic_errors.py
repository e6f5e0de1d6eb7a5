"""A derivation file with a mistake is answered in one line that says what is wrong and where."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
import sympy as sp
from sympy import Matrix, cos, sin

from satsym.symbolic import (
    Definition,
    DerivationError,
    FirstOrder,
    Model,
    Newton,
    Problem,
    Variable,
    derive,
    symbols_of,
    t,
)

STATES = (Variable("q1", "q"), Variable("v1", "v"))
CONTROLS = (Variable("u1", "u_1"), Variable("u2", "u_2"))
PARAMETERS = (Variable("k", "k", positive=True), Variable("c", "c"))
q1, v1 = symbols_of(STATES)
u1, u2 = symbols_of(CONTROLS)
k, c = symbols_of(PARAMETERS)
ghost = sp.Symbol("ghost", real=True)
EFFORT = (u1**2 + u2**2) / 2


def first_order(**changes: Any) -> FirstOrder:
    fields: dict[str, Any] = {
        "name": "small",
        "title": "A small model",
        "states": STATES,
        "controls": CONTROLS,
        "parameters": PARAMETERS,
        "rates": {q1: v1 + u2, v1: -k * q1 + u1},
    }
    return FirstOrder(**(fields | changes))


def plane(**changes: Any) -> Newton:
    """A point in the plane, Cartesian."""
    states = tuple(Variable(name, name) for name in ("a", "b", "a_dot", "b_dot"))
    a, b, a_dot, b_dot = symbols_of(states)
    fields: dict[str, Any] = {
        "name": "plane",
        "title": "Motion in the plane",
        "states": states,
        "controls": CONTROLS,
        "parameters": PARAMETERS,
        "coordinates": {a: a_dot, b: b_dot},
        "directions": {"e_a": Matrix([1, 0]), "e_b": Matrix([0, 1])},
        "position": Matrix([a, b]),
        "forces": {"thrust": Matrix([u1, u2])},
    }
    return Newton(**(fields | changes))


a, b, a_dot, b_dot = symbols_of(plane().states)


def problem(model: Model | None = None, **changes: Any) -> Problem:
    fields: dict[str, Any] = {"name": "task", "title": "", "model": model or first_order(), "running_cost": EFFORT}
    return Problem(**(fields | changes))


def complaint(subject: Problem | Model) -> str:
    """The one line in which a subject is refused."""
    with pytest.raises(DerivationError) as caught:
        derive(subject)
    text = str(caught.value)
    assert text
    assert "\n" not in text
    assert len(text) < 250
    return text


@pytest.mark.slow
@pytest.mark.parametrize(
    "subject",
    [first_order(), plane(), problem(), problem(plane())],
    ids=lambda s: s.name + type(s).__name__ + str(bool(getattr(s, "model", None)) and s.model.name),
)
def test_the_models_that_the_mistakes_are_planted_in_are_sound(subject: Problem | Model) -> None:
    assert derive(subject).steps


# Names.


@pytest.mark.parametrize(
    "twice",
    [
        {"parameters": (*PARAMETERS, Variable("q1", "q"))},
        {"controls": (*CONTROLS, Variable("u1", "u"))},
        {"definitions": (Definition(Variable("k", "k"), sp.Integer(2)),)},
    ],
    ids=["state and parameter", "two controls", "parameter and definition"],
)
def test_a_name_may_be_used_once(twice: Mapping[str, Any]) -> None:
    assert "is used twice" in complaint(first_order(**twice))


@pytest.mark.parametrize(
    "name",
    [
        "t",
        "t_f",
        "H",
        "H_star",
        "L",
        "S",
        "energy",
        "d_q1",
        "q1_0",
        "u1_star",
        "u1_hat",
        "A_q1_v1",
        "B_q1_u1",
        "H_u1_u2",
    ],
)
def test_a_name_of_something_derived_may_not_be_declared(name: str) -> None:
    text = complaint(first_order(parameters=(*PARAMETERS, Variable(name, name))))
    assert f"{name!r}" in text
    assert "derived" in text


@pytest.mark.parametrize("name", ["lambda_q1", "d_lambda_v1"])
def test_costates_reserve_their_names_where_there_is_a_cost(name: str) -> None:
    model = first_order(parameters=(*PARAMETERS, Variable(name, name)))
    assert derive(model).steps
    assert f"{name!r}" in complaint(problem(model))


@pytest.mark.parametrize("name", ["e_a", "d_e_b", "a_ddot", "r_vector"])
def test_vectors_and_accelerations_reserve_their_names(name: str) -> None:
    assert f"{name!r}" in complaint(plane(parameters=(*PARAMETERS, Variable(name, name))))


@pytest.mark.parametrize(("control_set", "name"), [("box", "u1_min"), ("box", "u2_max"), ("ball", "u_max")])
def test_bounds_reserve_their_names(control_set: str, name: str) -> None:
    model = first_order(parameters=(*PARAMETERS, Variable(name, name)))
    assert derive(problem(model)).steps
    assert f"{name!r} is used twice" in complaint(problem(model, control_set=control_set))


def test_a_direction_may_not_have_the_name_of_a_state() -> None:
    assert "'a'" in complaint(plane(directions={"a": Matrix([1, 0]), "e_b": Matrix([0, 1])}))


@pytest.mark.parametrize("name", ["2r", "r__dot", "", "r dot", "r;import os"])
def test_a_variable_needs_a_name_that_is_one(name: str) -> None:
    with pytest.raises(ValueError, match="use a letter"):
        Variable(name, "r")


# Symbols.


@pytest.mark.parametrize(
    ("subject", "where"),
    [
        (first_order(rates={q1: v1 + ghost, v1: u1}), "small: the rate of q1"),
        (problem(running_cost=EFFORT + ghost**2), "task: the running cost"),
        (problem(terminal_cost=ghost * q1), "task: the terminal cost"),
        (plane(forces={"pull": Matrix([-ghost * a, 0])}), "plane: the force 'pull'"),
        (plane(position=Matrix([a + ghost, b])), "plane: the position"),
        (plane(directions={"e_a": Matrix([1, 0]), "e_b": Matrix([0, ghost])}), "plane: the direction e_b"),
        (problem(terminal_constraints=(ghost - q1,)), "task: a terminal constraint"),
        (first_order(definitions=(Definition(Variable("g", "g"), ghost),)), "small: the value of g"),
        (first_order(reference={q1: ghost, v1: 0}), "small: the reference of q1"),
    ],
    ids=lambda value: value.partition(": ")[2] if isinstance(value, str) else "",
)
def test_undeclared_symbols_are_named_with_the_place(subject: Problem | Model, where: str) -> None:
    assert complaint(subject) == f"{where} uses undeclared symbols: ghost"


@pytest.mark.parametrize(
    "subject",
    [
        first_order(rates={q1: sp.Symbol("v1"), v1: u1}),
        problem(running_cost=EFFORT + sp.Symbol("q1") ** 2),
        plane(forces={"pull": Matrix([-sp.Symbol("k") * a, 0])}),
    ],
    ids=["rate", "cost", "force"],
)
def test_a_symbol_with_the_right_name_and_other_assumptions_is_refused(subject: Problem | Model) -> None:
    """It would count as a constant, and every derivative by it would silently be zero."""
    said = complaint(subject)
    assert "take the symbols from symbols_of, or write symbols(" in said
    assert ('("k", positive=True)' in said) == (subject.name == "plane")


@pytest.mark.parametrize(
    ("subject", "message"),
    [
        (problem(terminal_cost=q1 * u1), "task: the terminal cost cannot depend on u1"),
        (first_order(reference={q1: v1, v1: 0}), "small: the reference of q1 cannot depend on v1"),
        (first_order(definitions=(Definition(Variable("g", "g"), k * t),)), "small: the value of g cannot depend on t"),
        (plane(position=Matrix([a, b + a_dot])), "plane: the position cannot depend on a_dot"),
    ],
    ids=["terminal cost", "reference", "definition", "position"],
)
def test_symbols_out_of_place_are_refused(subject: Problem | Model, message: str) -> None:
    assert complaint(subject) == message


# Mechanics.


@pytest.mark.parametrize(
    "directions",
    [
        {"e_a": Matrix([1, 0]), "e_b": Matrix([1, 1])},
        {"e_a": Matrix([1, 0]), "e_b": Matrix([0, 2])},
        {"e_a": Matrix([cos(a), sin(a)]), "e_b": Matrix([sin(a), cos(a)])},
    ],
    ids=["oblique", "too long", "sign"],
)
def test_directions_must_be_orthonormal(directions: Mapping[str, Matrix]) -> None:
    assert complaint(plane(directions=directions)) == ("plane: the directions must be orthonormal")


@pytest.mark.parametrize(
    "changes",
    [
        {"directions": {"e_a": Matrix([1, 0])}},
        {"directions": {"e_a": Matrix([1, 0, 0]), "e_b": Matrix([0, 1, 0])}},
        {"position": Matrix([a, b, 0])},
        {"forces": {"thrust": Matrix([u1, u2, 0])}},
    ],
    ids=["one missing", "three components", "position", "force"],
)
def test_vectors_need_as_many_components_as_there_are_directions(changes: Mapping[str, Any]) -> None:
    assert "one component for each direction" in complaint(plane(**changes))


def test_what_is_no_vector_is_named() -> None:
    said = "must be a vector, such as Matrix([x, y])"
    assert complaint(plane(position=a)) == f"plane: the position {said}"
    assert complaint(plane(forces={"thrust": u1})) == f"plane: the force 'thrust' {said}"


def test_newtons_law_has_to_determine_the_accelerations() -> None:
    for position in (Matrix([a + b, 2 * a + 2 * b]), Matrix([cos(a + b), sin(a + b)])):
        assert complaint(plane(position=position)) == "plane: Newton's law does not determine a_ddot, b_ddot"
    short = plane(coordinates={a: a_dot}, states=plane().states[::2], position=Matrix([a, a]))
    assert complaint(short) == "plane: Newton's law does not determine a_ddot"


def test_states_are_the_coordinates_and_their_rates() -> None:
    mass = Variable("m", "m", positive=True)
    assert complaint(plane(states=(*plane().states, mass))) == (
        "plane: the states must be the coordinates and their rates, each once; neither coordinate nor rate: m"
    )
    shared = plane(coordinates={a: a_dot, b: a_dot})
    assert "the states must be the coordinates and their rates" in complaint(shared)


def test_every_state_needs_one_rate() -> None:
    said = {"without a rate: v1": {q1: v1}, "no state: k": {q1: v1, v1: u1, k: u2}}
    said["without a rate: v1; no state: k"] = {q1: v1, k: u2}
    said["take the symbols from symbols_of"] = {sp.Symbol("q1"): v1, v1: u1}
    for odd, rates in said.items():
        assert complaint(first_order(rates=rates)) == f"small: give one rate for each state; {odd}"


def test_a_reference_names_every_state() -> None:
    start = "small: the reference must have one curve for each state; look at"
    assert complaint(first_order(reference={q1: sp.Integer(0)})) == f"{start} v1"
    assert complaint(first_order(reference={q1: sp.Integer(0), v1: sp.Integer(0), k: sp.Integer(1)})) == f"{start} k"


def test_a_reference_has_to_satisfy_the_equations() -> None:
    assert complaint(first_order(reference={q1: cos(t), v1: -sin(t)})) == (
        "small: the reference does not satisfy the equations of motion"
    )
    assert "reference" in derive(
        first_order(reference={q1: cos(sp.sqrt(k) * t), v1: -sp.sqrt(k) * sin(sp.sqrt(k) * t)})
    )


def test_a_kind_of_model_without_steps_is_refused() -> None:
    fields = {name: getattr(first_order(), name) for name in ("name", "title", "states", "controls", "parameters")}
    assert complaint(Model(**fields)).startswith("small: ")


# Cost and control.

PRODUCTS = "an H that contains products of u1, u2 but is not quadratic in them is not supported"


@pytest.mark.parametrize(
    ("cost", "reason"),
    [
        (sp.Abs(u1) + u2**2, "H is not quadratic in the controls, so H_u = 0 is not linear"),
        (sp.sqrt(1 + u1**2 + u2**2), PRODUCTS),
        (EFFORT + u1**2 * u2, PRODUCTS),
    ],
    ids=str,
)
def test_hamiltonians_that_are_not_quadratic_are_refused(cost: sp.Expr, reason: str) -> None:
    assert complaint(problem(running_cost=cost)) == f"task: {reason}"


@pytest.mark.parametrize("cost", [u1**4 + u2**2, EFFORT + sp.exp(u1)], ids=str)
def test_hamiltonians_that_are_convex_in_each_control_have_a_law(cost: sp.Expr) -> None:
    assert "control_law" in derive(problem(running_cost=cost))


@pytest.mark.parametrize("cost", [u1**2, (u1 * sin(q1)) ** 2 + (u1 * cos(q1)) ** 2], ids=str)
def test_a_control_that_is_linear_beside_others_is_refused_where_nothing_limits_it(cost: sp.Expr) -> None:
    said = "task: H is linear in u2, which has no bounds; use a Box or a Ball"
    assert complaint(problem(running_cost=cost)) == said


def test_a_singular_second_derivative_is_refused() -> None:
    assert complaint(problem(running_cost=(u1 + u2) ** 2)) == (
        "task: H_uu of u1, u2 is singular, so H_u = 0 does not determine them; add the square of each of these "
        "controls to the cost"
    )


@pytest.mark.parametrize(
    "cost", [u1**2 - u2**2, -EFFORT, u1**2 + 3 * u1 * u2 + u2**2, c * u1**2 + u2**2, q1 * EFFORT, k * u1 * u2], ids=str
)
def test_an_indefinite_second_derivative_is_refused(cost: sp.Expr) -> None:
    text = complaint(problem(running_cost=cost))
    assert text.startswith("task: H_uu is not positive definite, so H has no minimum in the controls")


def test_a_second_derivative_of_decimals_with_hundreds_of_digits_is_definite() -> None:
    """Sympy's question for its sign overflows."""
    weight = sp.Float("1.6", 480) * (1 + k**-3)
    assert "second_derivative" in derive(problem(running_cost=weight * EFFORT))


def test_a_weight_has_to_be_declared_positive() -> None:
    assert '; declare c positive: Variable("c", ..., positive=True)' in complaint(
        problem(running_cost=c * u1**2 + u2**2)
    )
    assert derive(problem(running_cost=k * u1**2 + u2**2)).steps


def test_a_box_needs_uncoupled_controls() -> None:
    coupled = EFFORT + u1 * u2 / 4
    assert complaint(problem(running_cost=coupled, control_set="box")) == (
        "task: if the control set is a box, H_uu must be diagonal, "
        "because only then does clipping each control minimise H"
    )
    assert derive(problem(running_cost=coupled)).steps


def test_a_ball_needs_equal_weights() -> None:
    for cost in (u1**2 + 2 * u2**2, EFFORT + u1 * u2 / 4, k * u1**2 + u2**2):
        assert complaint(problem(running_cost=cost, control_set="ball")) == (
            "task: in a ball, the squares of all controls must have the same weight in the cost, because only then "
            "does shortening the control vector minimise H"
        )
        assert derive(problem(running_cost=cost)).steps


def test_a_problem_needs_a_control() -> None:
    model = first_order(controls=(), rates={q1: v1, v1: -q1})
    assert derive(model).steps
    assert complaint(problem(model, running_cost=q1**2)) == (
        "task: the model has no controls, so there is nothing to optimise"
    )


def test_a_control_set_is_one_of_three() -> None:
    assert complaint(problem(control_set="boxx")) == ('task: control_set: got "boxx"; give "free" or "box" or "ball"')


def test_roots_of_states_need_positive_states() -> None:
    level = Variable("q1", "q", positive=True)
    (positive,) = symbols_of((level,))

    def tank(state: Variable, q: sp.Symbol) -> Problem:
        model = first_order(states=(state,), controls=CONTROLS[:1], rates={q: -k * sp.sqrt(q) + u1})
        return problem(model, running_cost=u1**2, control_set="box")

    assert derive(tank(level, positive)).steps
    assert "declare positive variables as positive" in complaint(tank(STATES[0], q1))
