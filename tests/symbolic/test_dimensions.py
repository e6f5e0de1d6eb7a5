"""Homogeneity: what is derived survives a change of units, and what is declared wrongly is refused by name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import hypothesis
import hypothesis.strategies as some
import mpmath as mp
import pytest
import sympy as sp

from satsym.symbolic import (
    Definition,
    Derivation,
    DerivationError,
    Equation,
    FirstOrder,
    Newton,
    Problem,
    Step,
    Variable,
    derive,
    dimensions,
    loader,
    notation,
    symbols_of,
    t,
)
from satsym.symbolic.checks import numeric
from satsym.symbolic.functions.minimisers import Clip, Shorten
from tests.support.derived import derived
from tests.support.examples import examples

POLAR, *_ = loader.load(Path(__file__).resolve().parents[2] / "derivations" / "polar_orbit.py")
BY_NAME = {v.symbol: v for v in (*POLAR.model.states, *POLAR.model.controls, *POLAR.model.parameters)}


def dim(length: Any = 0, time: Any = 0) -> dict[str, sp.Expr]:
    return {base: sp.sympify(n) for base, n in (("[length]", length), ("[time]", time)) if n != 0}


@pytest.fixture(scope="module")
def polar() -> Derivation:
    return derived(POLAR)


@pytest.fixture(scope="module")
def known(polar: Derivation) -> dimensions.Known:
    found = dimensions.declared(replace(polar, steps=()))
    for step in polar.steps:
        found = dimensions.extended(found, step)
    return found


# What is derived.


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("t", dim(0, 1)),
        ("mu", dim(3, -2)),
        ("theta", dim()),
        ("d_r_dot", dim(1, -2)),
        ("theta_ddot", dim(0, -2)),
        ("L", dim(2, -4)),
        ("H", dim(2, -4)),
        ("H_star", dim(2, -4)),
        ("S", dim(2, -3)),
        ("lambda_r", dim(1, -3)),
        ("lambda_r_dot", dim(1, -2)),
        ("lambda_theta", dim(2, -3)),
        ("lambda_theta_dot", dim(2, -2)),
        ("d_lambda_theta_dot", dim(2, -3)),
        ("u1_hat", dim(1, -2)),
        ("u2_max", dim(1, -2)),
        ("r_0", dim(1)),
        ("e_r", dim()),
        ("d_e_r", dim(0, -1)),
        ("r_vector", dim(1)),
        ("F_vector", dim(1, -2)),
        ("A_r_dot_r", dim(0, -2)),
        ("A_theta_dot_r_dot", dim(-1, -1)),
        ("B_theta_dot_u2", dim(-1)),
        ("H_u1_u1", dim()),
        ("energy", dim(2, -2)),
        ("angular_momentum", dim(2, -1)),
    ],
)
def test_derived_symbols_have_the_dimension_of_the_textbook(
    known: dimensions.Known, name: str, expected: dict[str, sp.Expr]
) -> None:
    assert known[name] == expected


def test_every_step_carries_the_check(polar: Derivation) -> None:
    assert all(step.checks[-1].claim == "dimensions agree" for step in polar.steps)


def test_every_equation_survives_a_change_of_units(polar: Derivation, known: dimensions.Known) -> None:
    """The other route: numbers in other units, on both sides, differ by the factor of one and the same dimension."""
    factor = {"[length]": mp.mpf("1.7"), "[time]": mp.mpf("0.6")}

    def scale(dimension: dimensions.Dimension | None) -> mp.mpf:
        return mp.fprod(factor[base] ** int(power) for base, power in (dimension or {}).items())

    with mp.workdps(30):
        for step in polar.steps:
            for equation in step.equations:
                symbols = sorted((equation.lhs.free_symbols | equation.rhs.free_symbols), key=lambda s: s.name)
                before = {s: mp.mpf(k + 2) / 7 for k, s in enumerate(symbols)}
                after = {s: value * scale(known[s.name]) for s, value in before.items()}
                values = numeric([equation.lhs, equation.rhs])
                for small, large in zip(values(before), values(after), strict=True):
                    shared = scale(dimensions.dimension_of(equation.lhs, known) or known_of(equation, known))
                    assert mp.almosteq(large, small * shared, 1e-25), f"{step.name}.{equation.name}"


def known_of(equation: Equation, known: dimensions.Known) -> dimensions.Dimension | None:
    return dimensions.dimension_of(equation.rhs, known)


@pytest.mark.parametrize(
    ("address", "falsify"),
    [
        ("equations_of_motion.r", lambda e: e + sp.Symbol("r", positive=True)),
        ("equations_of_motion.r", lambda e: e * sp.Symbol("theta_dot")),
        ("costate_equations.r_dot", lambda e: e.subs(sp.Symbol("r", positive=True), 1)),
        ("linearisation.A_r_dot_r", lambda e: e - e.subs(sp.Symbol("theta_dot", real=True), 0) + 1),
        ("conserved.energy", lambda e: e + 1),
        ("control_law.u1", lambda e: e.func(*e.args[:2], sp.Symbol("r"))),
        ("boundary_conditions.final_time", lambda e: e + sp.Symbol("lambda_r")),
    ],
    ids="sum product exponent entry constant bound transversality".split(),
)
def test_an_inhomogeneous_equation_is_counted(
    polar: Derivation, known: dimensions.Known, address: str, falsify: Any
) -> None:
    step = polar.step(address.partition(".")[0])
    wrong = [replace(e, rhs=falsify(e.rhs)) if e is polar.equation(address) else e for e in step.equations]
    assert dimensions.agreement(known, replace(step, equations=tuple(wrong))).error == 1


# What is declared.


def unit(name: str, other: str) -> Problem:
    """The polar problem with one variable in another unit."""

    def changed(variables: tuple[Variable, ...]) -> tuple[Variable, ...]:
        return tuple(replace(v, unit=other) if v.symbol == name else v for v in variables)

    model = POLAR.model
    definitions = tuple(replace(d, variable=changed((d.variable,))[0]) for d in model.definitions)
    return replace(
        POLAR,
        model=replace(
            model,
            states=changed(model.states),
            controls=changed(model.controls),
            parameters=changed(model.parameters),
            definitions=definitions,
        ),
    )


def force(expression: Any) -> Problem:
    r, *_ = symbols_of(POLAR.model.states)
    direction = POLAR.model.directions["e_r"]
    return replace(POLAR, model=replace(POLAR.model, forces={**POLAR.model.forces, "drag": expression(r) * direction}))


r, r_dot, theta, theta_dot = symbols_of(POLAR.model.states)
u1, u2 = symbols_of(POLAR.model.controls)
sigma, omega, c1, c2, k1, *_ = symbols_of(POLAR.model.parameters)


@pytest.mark.parametrize(
    ("problem", "parts"),
    [
        (unit("r_dot", "km"), ("r_dot, the rate of r, has the dimension [length], but needs [length]/[time]",)),
        (unit("mu", "km**3"), ("the value of mu has the dimension [length]^3/[time]^2, but needs [length]^3",)),
        (unit("sigma", "s"), ("the value of mu has the dimension [time], but needs [length]^3/[time]^2",)),
        (
            unit("k1", "1"),
            (
                "the terminal cost",
                "of dimension [length]^2/[time]^3",
                "k1*(r - sigma)**2/2, of dimension [length]^2",
            ),
        ),
        (
            unit("c1", "km"),
            (
                "the running cost adds or compares",
                "c2*u2**2/2, of dimension [length]^2/[time]^4",
                "c1*u1**2/2, of dimension [length]^3/[time]^4",
            ),
        ),
        (
            unit("u1", "km"),
            ("the force 'radial thrust', per unit mass, has the dimension [length], but needs [length]/[time]^2",),
        ),
        (unit("theta", "km"), ("the reference of theta has the dimension 1, but needs [length]",)),
        (force(lambda r: sp.sin(r) * u1), ("applies sin to r, of dimension",)),
        (force(lambda r: 2**r * u1), ("exponents must be dimensionless",)),
        (
            force(lambda r: (r + r_dot) * u1),
            (
                "r_dot, of dimension [length]/[time]",
                "r, of dimension [length]",
            ),
        ),
        (
            force(lambda r: -k1 * r),
            ("the force 'drag', per unit mass, has the dimension [length]/[time]^3, but needs [length]/[time]^2",),
        ),
        (
            replace(POLAR, terminal_cost=r),
            (
                "the terminal cost, beside the integral of the running cost, has the dimension [length], "
                "but needs [length]^2/[time]^3",
            ),
        ),
        (replace(POLAR, running_cost=1 + u1**2 + u2**2), ("the running cost adds or compares 1, of dimension 1, and",)),
        (
            replace(POLAR, model=replace(POLAR.model, reference={**POLAR.model.reference, r: sigma * t})),
            ("the reference of r has the dimension [length]*[time], but needs [length]",),
        ),
        (
            replace(POLAR, model=replace(POLAR.model, position=POLAR.model.position + sp.Matrix([1, 0]))),
            ("the position adds or compares",),
        ),
        (unit("r", "parsnip"), ('unit "parsnip" is unknown',)),
        (unit("r", "km**"), ("cannot be read",)),
    ],
    ids=[
        "rate",
        "definition",
        "value of a definition",
        "terminal weight",
        "running weight",
        "thrust",
        "angle",
        "sine",
        "exponent",
        "sum",
        "force",
        "terminal cost",
        "cost of time",
        "reference",
        "position",
        "unknown unit",
        "unreadable unit",
    ],
)
def test_what_is_declared_wrongly_is_refused_in_one_line(problem: Problem, parts: tuple[str, ...]) -> None:
    with pytest.raises(DerivationError) as caught:
        derive(problem)
    text = str(caught.value)
    assert all(part in text for part in parts), text
    assert text.startswith("polar_orbit: ")
    assert "\n" not in text


# Models without units, and what expressions may hold.

PLAIN = (Variable("q1", "q"), Variable("v1", "v"))
PUSH = (Variable("u1", "u_1"),)
q1, v1 = symbols_of(PLAIN)


def oscillator(units: tuple[str, str, str], weight: str, rate: sp.Expr, cost: sp.Expr) -> Problem:
    q, v, u = units
    model = FirstOrder(
        name="oscillator",
        title="Oscillator",
        states=(replace(PLAIN[0], unit=q), replace(PLAIN[1], unit=v)),
        controls=(replace(PUSH[0], unit=u),),
        parameters=(Variable("w", "w", weight, positive=True),),
        rates={q1: v1, v1: rate},
    )
    return Problem(name="oscillator", title="", model=model, running_cost=cost)


w = sp.Symbol("w", real=True, positive=True)


def test_a_model_of_plain_numbers_counts_time_in_plain_numbers() -> None:
    found = derive(oscillator(("1", "rad", "1"), "1", -q1 + sp.sin(t) + u1, 1 + q1**2 + u1**2))
    assert dimensions.declared(replace(found, steps=()))["t"] == {}
    assert all(step.checks[-1].error == 0 for step in found.steps)


def test_a_model_with_units_may_not_take_the_sine_of_time() -> None:
    units = ("m", "m/s", "m/s^2")
    with pytest.raises(DerivationError, match="the rate of v1 applies sin to t, of dimension"):
        derive(oscillator(units, "1/s", -(w**2) * q1 + sp.sin(t) * u1, u1**2))
    assert derive(oscillator(units, "1/s", -(w**2) * q1 + sp.sin(w * t) * u1, u1**2)).steps


def test_cost_of_time_needs_the_unit_of_the_other_cost() -> None:
    units = ("m", "m/s", "m/s^2")
    with pytest.raises(DerivationError, match="the running cost adds or compares"):
        derive(oscillator(units, "1", u1, 1 + u1**2))
    assert derive(oscillator(units, "m^2/s^4", u1, w + u1**2)).steps


def test_logarithms_of_ratios_stay_whole() -> None:
    """Expanding log(q/w) gives the logarithms of two lengths, which mean nothing."""
    states = (Variable("q1", "q", "m", positive=True), Variable("v1", "v", "m/s"))
    q, v = symbols_of(states)
    model = FirstOrder(
        name="gas",
        title="",
        states=states,
        controls=(Variable("u1", "u_1", "m/s^2"),),
        parameters=(Variable("w", "w", "m", positive=True), Variable("g", "g", "m/s^2")),
        rates={q: v, v: sp.Symbol("g", real=True) * sp.log(q / w) + u1},
    )
    found = derive(Problem(name="gas", title="", model=model, running_cost=u1**2))
    assert sp.log(q / w) in found.equation("minimised_hamiltonian.H_star").rhs.atoms(sp.log)


def test_the_unit_in_the_logarithm_of_a_potential_is_a_constant() -> None:
    """A force k/q has the potential -k log q: changing the unit of q shifts the energy, which is free to shift."""
    states = (Variable("q1", "q", "m", positive=True), Variable("v1", "v", "m/s"))
    q, v = symbols_of(states)
    model = Newton(
        name="line_charge",
        title="",
        states=states,
        controls=(),
        parameters=(Variable("w", "w", "m^2/s^2", positive=True),),
        coordinates={q: v},
        directions={"e_1": sp.Matrix([1])},
        position=sp.Matrix([q]),
        forces={"charge": sp.Matrix([w / q])},
    )
    assert sp.expand(derive(model).equation("conserved.energy").rhs - v**2 / 2 + w * sp.log(q)) == 0


a, b, m, n = sp.symbols("a b m n", positive=True)
KNOWN = {"a": dim(1), "b": dim(2, -1), "m": dim(), "n": dim()}


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (0, None),
        (0.0 * a, None),
        (sp.pi, dim()),
        (2.5 * a, dim(1)),
        (sp.sqrt(a) * b**2, dim(sp.Rational(9, 2), -2)),
        (a**0.5, dim(sp.Rational(1, 2))),
        ((a / 2 + 3 * a) ** -2, dim(-2)),
        (sp.Abs(b), dim(2, -1)),
        (sp.Max(a, 2 * a), dim(1)),
        (sp.atan2(a, 3 * a) + m, dim()),
        (sp.sign(b) * a, dim(1)),
        (sp.exp(a**2 / (a * a)) * a, dim(1)),
        (sp.cos(a * b / (a * b + 1 * a * b)), dim()),
        (Clip(a, -a, 2 * a), dim(1)),
        (Shorten(a**2, a) * b, dim(2, -1)),
        (sp.Piecewise((a, b > 2 * b * m), (3 * a, True)), dim(1)),
        (a**n * (2 * a) ** (1 - n), dim(1)),
        (b ** (m + n), dim(2 * m + 2 * n, -m - n)),
    ],
)
def test_dimension_of_expressions(expression: Any, expected: dict[str, sp.Expr] | None) -> None:
    assert dimensions.dimension_of(expression, KNOWN) == expected


@pytest.mark.parametrize(
    "expression",
    [
        a + b,
        a + 1,
        sp.exp(a),
        sp.log(a),
        m**a,
        sp.Max(a, b),
        sp.atan2(a, b),
        Clip(a, -b, b),
        Clip(a, -1, 1),
        Shorten(a, a),
        sp.Piecewise((a, m > n), (b, True)),
        sp.Piecewise((a, a > b), (2 * a, True)),
        a * (b + m),
        sp.Symbol("unknown"),
    ],
    ids=str,
)
def test_mixed_dimensions_are_noticed(expression: sp.Expr) -> None:
    with pytest.raises(dimensions.Disagreement):
        dimensions.dimension_of(expression, KNOWN)


exponents = some.integers(-4, 4)


@hypothesis.given(some.lists(some.tuples(some.sampled_from("abm"), exponents, exponents), min_size=1, max_size=6))
@examples(50)
def test_dimensions_of_products_add_up(factors: list[tuple[str, int, int]]) -> None:
    """Against plain integer arithmetic."""
    product, length, time = sp.Integer(1), 0, 0
    size = {"a": (1, 0), "b": (2, -1), "m": (0, 0)}
    for name, power, extra in factors:
        product *= sp.Symbol(name, positive=True) ** (power + extra)
        length += size[name][0] * (power + extra)
        time += size[name][1] * (power + extra)
    assert dimensions.dimension_of(product, KNOWN) == dim(length, time)


@pytest.mark.parametrize(
    ("dimension", "text"),
    [
        (None, "1"),
        (dim(), "1"),
        (dim(2, -1), "[length]^2/[time]"),
        (dim(0, -2), "1/[time]^2"),
        (dim(1, 1), "[length]*[time]"),
        (dim(sp.Rational(1, 2), -n), "[length]^(1/2)/[time]^(n)"),
    ],
)
def test_dimensions_are_written_for_people(dimension: dict[str, sp.Expr] | None, text: str) -> None:
    assert dimensions.written(dimension) == text


def test_a_step_with_unknown_symbols_fails_the_check(known: dimensions.Known) -> None:
    equation = Equation("e", notation.HAMILTONIAN, sp.Symbol("nowhere"))
    assert dimensions.agreement(known, Step("s", "r", (equation,), (), ())).error == 1


def test_new_symbols_are_defined_by_the_step_that_brings_them(known: dimensions.Known) -> None:
    step = Step("s", "r", (Equation("e", sp.Symbol("speed"), r * theta_dot),), (), ())
    assert dimensions.extended(known, step)["speed"] == dim(1, -1)


def test_a_wrong_definition_of_gravity_is_a_matter_of_units_first() -> None:
    (definition,) = POLAR.model.definitions
    model = replace(POLAR.model, definitions=(Definition(definition.variable, sigma**2 * omega**2),))
    with pytest.raises(DerivationError, match="the value of mu has the dimension"):
        derive(model)
