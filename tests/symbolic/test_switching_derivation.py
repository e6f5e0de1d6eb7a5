"""Problems that are linear in the controls: what is derived is right, and errors in it would be caught."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import mpmath as mp
import pytest
import sympy as sp

from satsym.symbolic import (
    Ball,
    Box,
    Derivation,
    DerivationError,
    FirstOrder,
    Problem,
    Step,
    Variable,
    derive,
    pipeline,
    symbols_of,
)
from satsym.symbolic.checks import numeric, points
from satsym.symbolic.functions.minimisers import Shrink, Side, Switch
from satsym.symbolic.lookup.formulas import plain, to_tree
from satsym.symbolic.switching import functions as steps
from satsym.symbolic.switching import singular, singular_search
from tests.support.distance import deviation
from tests.support.switching_models import (
    CATALYST,
    FULLER,
    LEAST_FUEL,
    MINIMUM_TIME,
    OSCILLATOR,
    REGULATOR,
    ROCKET,
    TWO_ENGINES,
    WORST,
    a,
    derived,
    switching,
    u1,
    u2,
    x1,
    x2,
    x3,
)

LAMBDA = sp.symbols("lambda_x1:4", real=True)
l1, l2, l3 = LAMBDA


def said(step: Step) -> dict[str, Any]:
    """Conclusions by their keys."""
    return {c.key: c.values for c in step.conclusions}


def test_what_multiplies_the_control_is_its_switching_function() -> None:
    time, engines = derived(MINIMUM_TIME), derived(TWO_ENGINES)
    assert time.equation("switching_function.u1").rhs == l2
    assert time.equation("switching_function.H_0").rhs == 1 + l1 * x2
    assert [e.name for e in time.step("switching_function").equations] == ["H_0", "u1"]
    assert engines.equation("switching_function.u1").rhs == l1 * x2 + l2
    assert engines.equation("switching_function.weight_u1").rhs == a
    assert sp.expand(engines.equation("switching_function.weight_u2").rhs - 1 - x1**2) == 0


def test_brackets_of_switching_functions_that_do_not_commute_are_in_the_rates() -> None:
    engines = derived(TWO_ENGINES)
    # {sigma_2, sigma_1} = d sigma_1/dx . d sigma_2/d lambda - ... = 0, since sigma_2 = lambda_1 and sigma_1 has no x1;
    # {w_2, sigma_1} = -(dw_2/dx1) dsigma_1/dlambda_1 = -2 x1 x2
    names = [e.name for e in engines.step("switching_rate").equations]
    assert "bracket_u2_u1" not in names
    assert engines.equation("switching_rate.bracket_weight_u2_u1").rhs == -2 * x1 * x2
    crossed = derive(switching({x1: u1, x2: x1 * u2}, 1))
    assert crossed.equation("switching_rate.bracket_u1_u2").rhs == l2
    assert crossed.equation("switching_rate.bracket_u2_u1").rhs == -l2
    assert sp.expand(crossed.equation("switching_rate.u1").rhs + l2 * u2) == 0


def test_an_arc_without_costates_is_excluded_where_time_is_free_and_costs() -> None:
    found = said(derived(MINIMUM_TIME).step("singular_arcs"))
    surface = found["singular arc without the control"]["surface"]
    assert {(e.lhs, e.rhs) for e in surface} == {(l1, 0), (l2, 0)}
    assert found["singular arc excluded by H"]["value"] == 1
    assert "generalised_legendre_clebsch" not in derived(MINIMUM_TIME)


def test_fuel_alone_leaves_the_control_undetermined_at_either_threshold() -> None:
    step = derived(LEAST_FUEL).step("singular_arcs")
    arcs = [c.values["surface"] for c in step.conclusions if c.key == "singular arc without the control"]
    assert [{e.lhs: e.rhs for e in surface} for surface in arcs] == [{l2: -1, l1: 0}, {l2: 1, l1: 0}]
    assert sum(c.key == "singular arc undetermined" for c in step.conclusions) == 2


@pytest.mark.parametrize(
    ("problem", "order", "control", "kelley"),
    [
        (REGULATOR, 2, sp.Integer(0), 1),
        (WORST, 2, sp.Integer(0), -1),
        (FULLER, 4, sp.Integer(0), 1),
        # the control that keeps x2' = x1, as lambda_2 = 0 and lambda_1 = -x2 demand
        (OSCILLATOR, 2, 2 * x1 - x2 * (1 - x1**2), 1),
        # the control that keeps the arc m = (thrust that holds D(v) + v D'(v) against weight): here m (1 + v^2)
        (ROCKET, 2, x3 * (1 + x2**2), -2 * l2 / x3**2),
    ],
    ids=["regulator", "worst", "Fuller", "oscillator", "rocket"],
)
def test_singular_arcs_have_their_known_order_control_and_sign(
    problem: Problem, order: int, control: sp.Expr, kelley: sp.Expr
) -> None:
    found = derived(problem)
    assert said(found.step("singular_arcs"))["singular arc"]["order"] == order
    assert sp.simplify(found.equation("singular_arcs.u1").rhs - control) == 0
    assert sp.simplify(found.equation("generalised_legendre_clebsch.u1").rhs - kelley) == 0
    verdict = {1: "satisfied", -1: "violated"}.get(kelley, "open")
    assert list(said(found.step("generalised_legendre_clebsch"))) == [f"Legendre-Clebsch {verdict}"]


@pytest.mark.slow
def test_decimals_neither_hide_nor_slow_down_a_singular_arc() -> None:
    """Along F-8's own motion, whose decimals have tens of digits once they are multiplied."""

    def rates(number: Callable[[str], sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
        k1, k2, k3, k4, k5 = map(number, ("0.877", "3.846", "0.47", "4.208", "20.967"))
        return {x1: -k1 * x1 + x3 - k3 * x1**2 * x3 + k2 * x1**3, x2: x3, x3: -k4 * x1 - k3 * x1**2 - k5 * u1}

    decimal, exact = (derive(switching(rates(kind), 1)) for kind in (lambda s: sp.Float(s, 60), sp.Rational))
    name = "singular_arcs.u1"
    with mp.workdps(30):
        pair = numeric([d.equation(name).rhs for d in (decimal, exact)])
        symbols = exact.equation(name).rhs.free_symbols
        assert symbols
        assert all(deviation(*([value] for value in pair(p))) < 1e-25 for p in points(symbols, name))


def test_two_catalysts_are_mixed_as_jackson_found() -> None:
    """All costates zero is no arc of a problem without running cost; what is left fixes the ratio of the states."""
    found = derived(CATALYST)
    (ratio,) = [e.lhs for e in said(found.step("singular_arcs"))["singular arc"]["surface"] if not e.lhs.is_Symbol]
    alpha = 1 / math.sqrt(10)
    fraction = alpha * (1 + alpha) / (0.1 + (1 + alpha) ** 2)
    mixes = [
        float(found.equation("singular_arcs.u1").rhs.subs({x1: root, x2: 1}))
        for root in sp.solve(ratio.subs(x2, 1), x1)
    ]
    assert min(abs(mix - fraction) for mix in mixes) < 1e-14


def test_a_derivative_that_cannot_vanish_excludes_the_arc() -> None:
    ramp = derive(switching({x1: u1}, x1))
    assert said(ramp.step("singular_arcs"))["singular arc impossible"]["value"] == -1


def test_no_surface_is_sought_where_what_is_positive_would_vanish() -> None:
    """A condition is costate times root of a positive state: the costate vanishes, and the root does not."""
    states, controls = (Variable("a", "a"), Variable("b", "b", positive=True)), (Variable("u", "u"), Variable("v", "v"))
    (a, b), (u, v) = symbols_of(states), symbols_of(controls)
    rates = {a: b, b: 3600 / b**3 + sp.sqrt(b) * u + v}
    model = FirstOrder(name="m", title="M", states=states, controls=controls, parameters=(), rates=rates)
    stated = Problem(name="root", title="Root", model=model, running_cost=a**2 / 7 + 2, control_set="box")
    found = singular_search.searches(derive(stated))
    assert [search.outcome for search in found] == ["impossible", "impossible"]
    assert not any(b in search.surface.solved for search in found)


def test_what_vanishes_twice_is_no_condition_that_later_ones_follow_from() -> None:
    """The rate of lambda_b x^2 vanishes with x, and the rate of that only where the control keeps x at zero."""
    states, controls = (Variable("x", "x"), Variable("b", "b")), (Variable("u", "u"),)
    (x, b), (u,) = symbols_of(states), symbols_of(controls)
    model = FirstOrder(name="m", title="M", states=states, controls=controls, parameters=(), rates={x: u, b: -3 * x**3})
    stated = Problem(name="twice", title="Twice", model=model, running_cost=0, terminal_cost=b**2, control_set="box")
    (found,) = singular_search.searches(derive(stated))
    assert found.outcome == "open"


def test_a_control_with_a_weight_is_singular_on_either_side() -> None:
    found = derived(TWO_ENGINES)
    names = [e.name for e in found.step("generalised_legendre_clebsch").equations]
    assert names == ["u1_positive", "u1_negative", "u2_positive", "u2_negative"]


# What the machinery cannot do.


@pytest.mark.parametrize(
    ("problem", "complaint"),
    [
        (switching({x1: u1}, 1, control_set="ball"), 'this requires control_set = "box", not "ball"'),
        (switching({x1: u1}, 1, control_set="free"), 'this requires control_set = "box", not "free"'),
        (switching({x1: u1}, -sp.Abs(u1)), "the weight of |u1| in the cost, -1, might be negative"),
        (switching({x1: u1}, x1 * sp.Abs(u1)), "the weight of |u1| in the cost, x1, might be negative"),
        (
            switching({x1: -sp.Abs(u1)}, u1**2),
            'Abs(u1) in the equations of motion is supported only with control_set = "box", and only if the cost and',
        ),
        (switching({x1: sp.Abs(x2), x2: u1}, 1), "the rate of x1 contains Abs(x2), whose derivatives jump"),
        (switching({x1: sp.sign(x2), x2: u1}, 1), "the rate of x1 contains sign(x2), whose derivatives jump"),
        (switching({x1: u1}, sp.Abs(u1) + sp.Max(x1, 0)), "the running cost contains Max(0, x1)"),
        (
            switching({x1: u1 + u2}, sp.Abs(u1), control_set="free", control_sets={"a": Box("u1"), "b": Ball("u2")}),
            "|u1| is not supported together with control_sets",
        ),
        (switching({x1: u1, x2: x1}, u2**2 + x2, control_set="free"), "H is linear in u1, which has no bounds"),
        (switching({x1: u1}, sp.Abs(u1) + u1**2), "H is not quadratic in the controls"),
    ],
    ids=[
        *("ball", "free", "minus |u|", "weight of either sign", "|u| in the motion", "|x| in the motion", "a sign"),
        *("a maximum", "|u| among sets", "mixed", "|u| and u^2"),
    ],
)
def test_what_has_no_law_here_is_refused_in_one_line(problem: Problem, complaint: str) -> None:
    with pytest.raises(DerivationError) as caught:
        derive(problem)
    assert complaint in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_control_that_does_nothing_is_refused() -> None:
    idle = switching({x1: u1 + u2}, 1)
    idle = replace(idle, model=replace(idle.model, rates={x1: u1}))
    with pytest.raises(DerivationError, match="u2 enters neither the motion nor the cost"):
        derive(idle)


# Checks that can fail.

bracket = steps.poisson
STEPS = {f.__name__: f for f in pipeline.SWITCHING_PRINCIPLE}


def redo(derivation: Derivation, name: str) -> Step:
    index = [s.name for s in derivation.steps].index(name)
    before = replace(derivation, steps=derivation.steps[:index])
    found = STEPS[name](before)
    assert found is not None
    return before.extended(found).steps[-1]


@pytest.mark.parametrize(
    ("step", "function", "wrong"),
    [
        ("switching_function", "tidy", lambda e, *by: -e),
        ("control_law", "Switch", lambda s, w, low, high: Switch(-s, w, low, high)),
        ("control_law", "Switch", lambda s, w, low, high: Switch(s, 2 * w, low, high)),
        ("control_law", "Switch", lambda s, w, low, high: Switch(s, w, low, 2 * high)),
        ("smoothed_law", "Shrink", lambda s, w: Shrink(-s, w)),
        ("smoothed_law", "Shrink", lambda s, w: s),
        ("switching_rate", "poisson", lambda d, by, of: -bracket(d, by, of)),
        ("switching_rate", "poisson", lambda d, by, of: bracket(d, by, of) * (1 if by.has(x2) else 2)),
    ],
    ids=["sign", "turned", "wide", "far", "Shrink turned", "not shrunk", "bracket turned", "one bracket twice"],
)
def test_a_planted_error_is_caught(
    monkeypatch: pytest.MonkeyPatch,
    step: str,
    function: str,
    wrong: Callable[..., Any],
) -> None:
    found = derived(TWO_ENGINES)
    assert redo(found, step).equations == found.step(step).equations
    monkeypatch.setattr(steps, function, wrong)
    with pytest.raises(DerivationError, match="failed its check"):
        redo(found, step)


@pytest.mark.parametrize(
    ("problem", "step"),
    [(TWO_ENGINES, "switching_function"), (TWO_ENGINES, "switching_rate"), (OSCILLATOR, "singular_arcs")],
    ids=["switching_function", "switching_rate", "singular_arcs"],
)
def test_no_expression_of_a_step_can_be_falsified(monkeypatch: pytest.MonkeyPatch, problem: Problem, step: str) -> None:
    """Every single expression e that a step tidies is made 1 - e in turn: caught, or without any effect."""
    found = derived(problem)
    place = singular_search if step == "singular_arcs" else steps
    tidy, right, calls, caught, index = place.tidy, found.step(step).equations, 0, 0, 0

    def falsified(*arguments: Any) -> sp.Expr:
        nonlocal calls
        calls += 1
        return 1 - tidy(*arguments) if calls == index else tidy(*arguments)

    monkeypatch.setattr(place, "tidy", falsified)
    singular_search._search.cache_clear()
    redo(found, step)
    total = calls
    for index in range(1, total + 1):  # noqa: B007 -- falsified() reads it
        calls = 0
        singular_search._search.cache_clear()
        try:
            assert redo(found, step).equations == right
        except DerivationError:
            caught += 1
    singular_search._search.cache_clear()
    assert caught > 2


@pytest.mark.parametrize(
    ("problem", "field"),
    [(ROCKET, "singular"), (ROCKET, "slope"), (ROCKET, "derivatives"), (CATALYST, "singular")],
    ids=["singular", "slope", "derivatives", "where a condition is not solved"],
)
def test_a_wrong_singular_arc_is_caught(monkeypatch: pytest.MonkeyPatch, problem: Problem, field: str) -> None:
    found = derived(problem)
    (search,) = singular.searches(found)
    right = getattr(search, field)
    wrong = (*right[:-1], 2 * right[-1]) if field == "derivatives" else 2 * right
    monkeypatch.setattr(singular, "searches", lambda so_far: [replace(search, **{field: wrong})])
    with pytest.raises(DerivationError, match="failed its check"):
        redo(found, "generalised_legendre_clebsch" if field == "slope" else "singular_arcs")


@pytest.mark.parametrize("more", [-1, 1])
def test_a_search_that_ends_elsewhere_than_in_the_step_before_is_caught(
    monkeypatch: pytest.MonkeyPatch, more: int
) -> None:
    """With an odd number of derivatives, nothing would be said of the control at all."""
    found = derived(ROCKET)
    (search,) = singular.searches(found)
    taken = search.derivatives[:-1] if more < 0 else (*search.derivatives, search.derivatives[-1])
    monkeypatch.setattr(singular, "searches", lambda so_far: [replace(search, derivatives=taken)])
    with pytest.raises(DerivationError, match="failed its check"):
        redo(found, "generalised_legendre_clebsch")


def test_derivatives_of_the_functions_of_switches() -> None:
    value, width = sp.symbols("value width", real=True)
    assert sp.diff(Shrink(value, width), value) == Side(value, width) ** 2
    assert sp.diff(Shrink(value, width), width) == -Side(value, width)
    assert Shrink(value, 0) == value
    assert sp.diff(Switch(value, width, 0, 1), value) == 0


def test_laws_can_be_written_as_people_print_them() -> None:
    """With signs, minima and maxima, which ledgers of printed claims can be held against; the values are the same."""
    law, smoothed = (derived(LEAST_FUEL).equation(f"{step}.u1").rhs for step in ("control_law", "smoothed_law"))
    bang = derived(MINIMUM_TIME).equation("control_law.u1").rhs
    low, high = bang.args[2:]
    unit = {low: -1, high: 1}
    assert sp.simplify(plain(bang).xreplace(unit) + sp.sign(sp.Symbol("switching_u1", real=True))) == 0
    for expression in (law, smoothed, bang):
        printed = plain(expression)
        assert not printed.atoms(Switch, Shrink)
        assert to_tree(expression)
        for point in points(expression.free_symbols, "printed", 40):
            point |= {low: -abs(point[low]), high: abs(point[high])}
            point |= {s: abs(v) for s, v in point.items() if "weight" in s.name or "share" in s.name}
            assert deviation(numeric([printed])(point), numeric([expression])(point)) < 1e-14


@pytest.mark.parametrize("sets", [{}, {"push": Box("a"), "torque": Box("b")}], ids=["one box", "a box for each"])
def test_controls_of_several_units_switch_beside_each_other(sets: dict[str, Box]):
    """One number smooths them all, so that it has no dimension that would suit them all."""
    states = (Variable("x", "x", "m"), Variable("q", "q", "rad"))
    controls = (Variable("a", "a", "m/s"), Variable("b", "b", "rad*kg/s"))
    weight = Variable("m", "m", "kg", default=1.0, positive=True)
    (x, q), (push, torque), (m,) = symbols_of(states), symbols_of(controls), symbols_of((weight,))
    moving = FirstOrder(
        name="arm", title="A", states=states, controls=controls, parameters=(weight,), rates={x: push, q: torque / m}
    )
    kind = {"control_sets": sets} if sets else {"control_set": "box"}
    found = derive(Problem(name="armed", title="A", model=moving, running_cost=1, **kind))
    effort = found.equation("smoothed_law.H").rhs
    smoothing = sp.Symbol("smoothing", positive=True)
    assert sp.expand(effort - effort.subs(smoothing, 0)) == sp.expand(smoothing * (push**2 + torque**2) / 2)
