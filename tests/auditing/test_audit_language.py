"""The safe language, its trees, and the engine that evaluates them in a prime field."""

from __future__ import annotations

import time
from fractions import Fraction

import hypothesis.strategies as st
import pytest
import sympy as sp
from hypothesis import assume, given

from satsym.formula import field
from satsym.formula.calculus import Calculus, derivative
from satsym.formula.functions import classical_weights
from satsym.formula.reading import expression, statement
from satsym.formula.tree import (
    Add,
    Call,
    Div,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    number,
    replaced,
    substituted,
    symbols,
    walk,
)
from satsym.formula.values import Matrix, Sources
from satsym.formula.writing import written
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas

NAMES = ("x", "y", "z")
POSITIVE = frozenset({"x"})
SYMBOLS = {name: sp.Symbol(name, real=True, positive=True if name in POSITIVE else None) for name in NAMES}

leaves = st.one_of(
    st.sampled_from(NAMES).map(Sym), st.integers(1, 9).map(number), st.sampled_from([Num(Fraction(1, 2))])
)
trees = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.lists(inner, min_size=2, max_size=3).map(lambda terms: Add(tuple(terms))),
        st.lists(inner, min_size=2, max_size=3).map(lambda factors: Mul(tuple(factors))),
        inner.map(Neg),
        st.tuples(inner, inner).map(lambda pair: Div(*pair)),
        st.tuples(inner, st.integers(2, 3)).map(lambda pair: Pow(pair[0], number(pair[1]))),
        st.tuples(st.sampled_from(["sin", "cos"]), st.sampled_from(NAMES)).map(lambda f: Call(f[0], (Sym(f[1]),))),
    ),
    max_leaves=8,
)


def in_sympy(tree: Node) -> sp.Expr:
    return formulas.from_tree(tree, SYMBOLS.__getitem__)


@given(trees)
def test_what_is_written_reads_as_the_same_value(tree: Node) -> None:
    try:
        again = expression(written(tree))
    except BadInput:  # a division by zero, or too large
        assume(False)
    assert written(again) == written(expression(written(again)))
    assert sp.simplify(in_sympy(tree) - in_sympy(again)) in (0, sp.nan)


@pytest.mark.parametrize(
    "text",
    [
        "-(2*x2*x4 + u2)/x1",
        "a/b*c - (d - e)",
        "-a*b/c",
        "2**(-1/2)*x",
        "(-x)**2",
        "0.5*h*(a - (b + c))",
        "min(1, max(0, -l2/c1))",
        "d_x4 = lambda**2",
        "a - -b + 1.25",
    ],
)
def test_a_formula_is_kept_as_it_is_printed(text: str) -> None:
    tree = statement(text)
    assert statement(written(tree)) == tree


def test_numbers_are_exact() -> None:
    assert expression("0.1") == Num(Fraction(1, 10))
    assert expression("2.50e-3") == Num(Fraction(1, 400))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("__import__('os').system('true')", "not allowed"),
        ("__import__", "not a name"),
        ("x.real", "attribute"),
        ("x.__class__", "attribute"),
        ("9**9**9", "exponent"),
        ("x**y", "exponent"),
        ("x**21", "out of range"),
        ("(((9**20)**20)**20)", "too large"),
        ("(a + b + c + d)**20", "too large"),
        ("*".join(["(a + b)"] * 30), "too large"),
        ("(" * 60 + "x" + ")" * 60, "nested"),
        ("(" * 10_000 + "x" + ")" * 10_000, "longer than"),
        ("-" * 500 + "x", "nested"),
        ("x = y = z", "more than one equals sign"),
        ("x == y", "more than one equals sign"),
        ("\\theta", "not allowed here"),
        ("x if y else z", "not allowed"),
        ("lambda x: x", "not a formula"),
        ("(lambda_ := 3)", "not allowed|not a formula"),
        ("[x for x in y]", "comprehension"),
        ("{1}", "not allowed here"),
        ("f'{x}'", "not allowed here"),
        ("'text'", "not a plain decimal number"),
        ("x[0]", "index"),
        ("x(y)", "unknown"),
        ("sin(x, y)", "takes 1 arguments"),
        ("sin(x=1)", "keyword arguments"),
        ("1j", "not a plain decimal number"),
        ("0x10", "not a plain decimal number"),
        ("1_000", "not a plain decimal number"),
        ("True", "not a plain decimal number"),
        ("x @ y", "only"),
        ("x // y", "only"),
        ("~x", "not allowed here"),
        ("x y", "not a formula"),
        ("x +", "not a formula"),
        ("x__y", "not a name"),
        ("a" * 50, "longer than"),
        ("1" * 40, "digits"),
        ("x/0", "division by zero"),
        ("x/(2 - 2)", "division by zero"),
        ("0**-1", "zero to the power"),
        ("", "empty"),
        ("x\n\0y", "not allowed here"),
    ],
)
def test_anything_else_is_refused_with_the_reason_and_at_once(text: str, reason: str) -> None:
    begun = time.thread_time()
    with pytest.raises(BadInput, match=reason) as refusal:
        statement(text)
    assert time.thread_time() - begun < 0.5
    assert "\n" not in str(refusal.value)
    assert len(str(refusal.value)) < 400


def test_an_edit_changes_one_place() -> None:
    tree = expression("a*(b + c) - b/d")
    paths = [path for path, node in walk(tree) if node == Sym("b")]
    assert len(paths) == 2
    for path in paths:
        assert symbols(replaced(tree, path, Sym("e"))) == symbols(tree) | {"e"}


IDENTITIES = [
    "sin(x)**2 + cos(x)**2 - 1",
    "cos(y + z) - cos(y)*cos(z) + sin(y)*sin(z)",
    "sin(2*(y - z*x)) - 2*sin(y - x*z)*cos(y - z*x)",
    "sqrt(x**2) - x",
    "sqrt(y**2) - abs(y)",
    "sqrt(-x**2) - I*x",
    "sqrt(12) - 2*sqrt(3)",
    "sqrt(y**2 + z**2)**2 - y**2 - z**2",
    "x**(1/3)*x**(2/3) - x",
    "exp(-y*z)*exp(z*y) - 1",
    "exp(I*y) - cos(y) - I*sin(y)",
    "cosh(y)**2 - sinh(y)**2 - 1",
    "tan(y)*cos(y) - sin(y)",
    "min(y, z) + max(y, z) - y - z",
    "sign(y)*abs(y) - y",
    "cos(pi - y) + cos(y)",
    "sin(y + pi/2) - cos(y)",
    "(y + z)**3 - y**3 - 3*y**2*z - 3*y*z**2 - z**3",
    "atan2(y + y, z) - atan2(2*y, z)",
]
FALSE = [
    "sin(y) - y",
    "sqrt(y**2) - y",
    "sin(y + z) - sin(y) - sin(z)",
    "exp(y + z) - exp(y) - exp(z)",
    "min(y, z) - y",
    "sqrt(y + z) - sqrt(y) - sqrt(z)",
    "y/z - z/y",
    "cos(2*y) - 2*cos(y)",
    "log(y) - log(z)",
]


@pytest.mark.parametrize("text", IDENTITIES)
def test_the_field_confirms_identities(text: str) -> None:
    assert field.vanishes(expression(text), "a test", POSITIVE)


@pytest.mark.parametrize("text", FALSE)
def test_the_field_refutes_what_is_no_identity(text: str) -> None:
    assert not field.vanishes(expression(text), "a test", POSITIVE)


def test_what_has_no_value_is_told_apart_from_zero() -> None:
    with pytest.raises(field.Undecided):
        field.vanishes(expression("1/(y - y)"), "a test")


def test_the_prime_is_prime_and_minus_one_has_a_root() -> None:
    assert sp.isprime(field.PRIME)
    assert field.IMAGINARY**2 % field.PRIME == field.PRIME - 1


@given(trees)
def test_both_engines_agree_whether_a_difference_vanishes(tree: Node) -> None:
    shuffled = sp.expand(in_sympy(tree))
    assume(not shuffled.has(sp.zoo, sp.nan))
    difference = Add((tree, Neg(formulas.to_tree(shuffled))))
    assert field.vanishes(difference, "a test", POSITIVE)
    assert formulas.is_zero(in_sympy(difference))
    moved = Add((difference, Mul((Sym("x"), Num(Fraction(1, 7))))))
    assert not field.vanishes(moved, "a test", POSITIVE)
    assert formulas.differs_somewhere(in_sympy(moved))


@pytest.mark.parametrize("bound", ["2", "1.01", "0.5", "30"])
def test_bounds_that_differ_are_told_apart(bound: str) -> None:
    of = f"min({bound}, max(0, -x/(y*z))) - min(1, max(0, -x/(y*z)))"
    assert formulas.differs_somewhere(in_sympy(expression(of)))


@given(trees)
def test_our_derivatives_are_those_of_sympy(tree: Node) -> None:
    by_sympy = sp.diff(in_sympy(tree), SYMBOLS["x"])
    assume(not by_sympy.has(sp.zoo, sp.nan))
    difference = Add((derivative(tree, "x"), Neg(formulas.to_tree(by_sympy))))
    assert field.vanishes(difference, "a test", POSITIVE)


def test_rank_and_determinant_without_sympy() -> None:
    engine = Calculus(Sources(Sym, Sym, Sym), POSITIVE)
    rows = tuple(
        tuple(map(expression, line)) for line in (("x", "y", "x + y"), ("1", "z", "1 + z"), ("z", "x", "z + x"))
    )
    matrix = Matrix(rows)
    assert engine.rank(matrix) == 2
    assert field.vanishes(engine.determinant(matrix), "a test")
    square = Matrix(tuple(line[:2] for line in rows[:2]))
    assert field.vanishes(Add((engine.determinant(square), Neg(expression("x*z - y")))), "a test")


def test_weights_of_the_classical_method_follow_from_its_order() -> None:
    assert classical_weights() == (Fraction(1, 6), Fraction(1, 3), Fraction(1, 3), Fraction(1, 6))


def test_symbols_are_replaced_all_at_once() -> None:
    swapped = substituted(expression("x - y"), {"x": Sym("y"), "y": Sym("x")})
    assert written(swapped) == "y - x"
