"""What is typeset is read back, as a person would, and has the value of what it was typeset from."""

from __future__ import annotations

import math
import operator
import random
import re
from collections.abc import Mapping

import pytest
import sympy as sp
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

from satsym.symbolic import Derivation, FirstOrder, Problem, Variable, derive, symbols_of
from satsym.symbolic.functions.minimisers import by_signs
from satsym.symbolic.latex.typeset import Typesetter
from satsym.symbolic.principle import control_sets
from tests.support.derived import each, shipped
from tests.support.examples import examples

FUNCTIONS = {r"\cos": math.cos, r"\sin": math.sin, r"\tan": math.tan, r"\ln": math.log}
LAYOUT = re.compile(r"\\(?:[bB]igg?[lr]|left|right|,|;)(?![A-Za-z])|\s+|&|\{\}(?=[+-])")
RELATIONS = {">": operator.gt, "<": operator.lt, r"\ge": operator.ge, r"\le": operator.le, "=": operator.eq}
BARS = {"|": "|", r"\lvert": r"\rvert"}
ENDS = (r"\end{cases}",)


def without_layout(tex: str) -> str:
    """What is read, without sizes of parentheses and spaces of certain widths."""
    tex = tex.replace(r"\left|", r"\lvert ").replace(r"\right|", r"\rvert ")
    return LAYOUT.sub(lambda m: " " if m[0].isspace() else "", tex)


class Reader:
    """Values of the LaTeX that satsym writes, by the rules of school."""

    def __init__(self, values: Mapping[str, float]) -> None:
        """Take the value of each symbol, by its LaTeX."""
        values = {"e": math.e} | {without_layout(name): value for name, value in values.items()}
        names = "|".join(re.escape(name) + r"(?![A-Za-z])" for name in sorted(values, key=len, reverse=True))
        commands = (
            r"\\(?:[td]?frac|sqrt|cos|sin|tan|ln|cdot|max|min|lvert|rvert|ge|le|text)(?![A-Za-z])|\\[{}]|\\\\"
            r"|\\operatorname\{(?:sgn|atan2)\}|\\mathcal\{S\}_|\\(?:begin|end)\{cases\}"
        )
        self._token = re.compile(rf"({names or '(?!)'})|({commands})|(\d+(?:\.\d+)?)|([-+/^(){{}},<>|=])")
        self._values = values

    def read(self, tex: str) -> float:
        """The value of an expression."""
        text = without_layout(tex)
        self._tokens = [m[0] for m in self._token.finditer(text)]
        assert "".join(self._tokens).replace(" ", "") == text.replace(" ", ""), tex
        self._next = 0
        value = self._sum()
        assert self._next == len(self._tokens), (tex, self._tokens[self._next :])
        return value

    def _peek(self) -> str:
        return self._tokens[self._next] if self._next < len(self._tokens) else ""

    def _take(self, wanted: str = "") -> str:
        token = self._peek()
        assert not wanted or token == wanted, (wanted, token)
        self._next += 1
        return token

    def _sum(self) -> float:
        negative = self._peek() == "-"
        if negative:
            self._take()
        total = -self._product() if negative else self._product()
        while self._peek() in ("+", "-"):
            total += self._product() if self._take() == "+" else -self._product()
        return total

    def _product(self) -> float:
        value = self._power()
        while self._peek() not in ("", "+", "-", ")", "}", r"\}", ",", "|", r"\rvert", "\\\\", *ENDS, *RELATIONS):
            if self._peek() == "/":
                self._take()
                value /= self._power()
            else:
                if self._peek() == r"\cdot":
                    self._take()
                value *= self._power()
        return value

    def _power(self) -> float:
        base = self._atom()
        if self._peek() == "^":
            self._take()
            base = base ** self._group()
        return base

    def _group(self) -> float:
        self._take("{")
        value = self._sum()
        self._take("}")
        return value

    def _atom(self) -> float:
        token = self._take()
        if token in (r"\frac", r"\tfrac", r"\dfrac"):
            return self._group() / self._group()
        if token == r"\sqrt":
            return math.sqrt(self._group())
        if token in (r"\max", r"\min"):
            self._take(r"\{")
            first = self._sum()
            self._take(",")
            second = self._sum()
            self._take(r"\}")
            return max(first, second) if token == r"\max" else min(first, second)
        if token in BARS:
            size = abs(self._sum())
            self._take(BARS[token])
            return size
        if token == r"\operatorname{sgn}":
            self._take("(")
            argument = self._sum()
            self._take(")")
            return math.copysign(1.0, argument) if argument else 0.0
        if token == r"\operatorname{atan2}":
            self._take("(")
            across = self._sum()
            self._take(",")
            along = self._sum()
            self._take(")")
            return math.atan2(across, along)
        if token == r"\mathcal{S}_":
            width = self._group()
            self._take("(")
            argument = self._sum()
            self._take(")")
            return math.copysign(max(abs(argument) - width, 0.0), argument)
        if token == r"\begin{cases}":
            return self._cases()
        if token in FUNCTIONS:
            exponent = 1.0
            if self._peek() == "^":
                self._take()
                exponent = self._group()
            bare = self._peek() != "("
            argument = self._atom()
            assert not bare or self._peek() != "(", "whether the parentheses belong to the argument is a guess"
            return FUNCTIONS[token](argument) ** exponent
        if token in ("(", "{"):
            value = self._sum()
            self._take({"(": ")", "{": "}"}[token])
            return value
        return self._values[token] if token in self._values else float(token)

    def _cases(self) -> float:
        """The value beside the first condition that holds."""
        found: list[float] = []
        while True:
            value = self._sum()
            self._take(",")
            left = self._sum()
            holds = RELATIONS[self._take()]
            found += [value] if holds(left, self._sum()) else []
            if self._take() == ENDS[0]:
                return found[0]


TRIES = 1000


def values_of(expression: sp.Expr, rng: random.Random) -> dict[sp.Symbol, float]:
    return {s: rng.uniform(0.5, 1.5) for s in sorted(expression.free_symbols, key=lambda s: s.name)}


def value(expression: sp.Expr, point: Mapping[sp.Symbol, float]) -> float:
    plain = by_signs(expression)
    plain = plain.replace(lambda e: e.func.__name__ == "Clip", lambda e: sp.Max(e.args[1], sp.Min(*e.args[::2])))
    plain = plain.replace(lambda e: e.func.__name__ == "Shorten", lambda e: sp.Min(1, e.args[1] / sp.sqrt(e.args[0])))
    plain = plain.replace(
        lambda e: e.func.__name__ == "Stretch", lambda e: sp.Min(1 / e.args[1], e.args[2] / sp.sqrt(e.args[0]))
    )
    plain = plain.replace(
        lambda e: e.func.__name__ == "Choice", lambda e: sp.Piecewise((e.args[1], e.args[0] <= 0), (e.args[2], True))
    )
    plain = plain.replace(lambda e: e.func.__name__ == "Middle", lambda e: (e.args[0] + e.args[1]) / 2)
    plain = plain.replace(lambda e: e.func.__name__ == "Convex", lambda e: e.args[0])  # only where it is convex
    return float(plain.subs(point))


def real_point(expression: sp.Expr, rng: random.Random) -> tuple[dict[sp.Expr, float], float]:
    """Where no root is taken of a negative number, with the value there; a factor i is read as any other factor."""
    for _ in range(TRIES):
        point = values_of(expression, rng) | {sp.I: 0.7}
        try:
            return point, value(expression, point)
        except TypeError:
            continue
    raise AssertionError(f"no numbers for {expression}")


def assert_reads_back(derivation: Derivation, expression: sp.Expr) -> None:
    """In one piece, in terms, and in the pieces that lines may be broken between."""
    typeset, rng = Typesetter(derivation), random.Random(1)
    expression = sp.sympify(expression)
    point, real = real_point(expression, rng)
    reader = Reader({"i": 0.7} | {typeset.symbol(s.name): v for s, v in point.items() if s.is_Symbol})
    expected = pytest.approx(real, rel=1e-9, abs=1e-9)
    assert reader.read(typeset.tex(expression)) == expected
    for plus_first in (True, False):
        terms = typeset.terms(expression, plus_first=plus_first)
        assert reader.read(" ".join(t.signed(first=k == 0) for k, t in enumerate(terms))) == expected
        pieces = [p.tex for k, t in enumerate(terms) for p in t.signed_pieces(first=k == 0)]
        assert reader.read(" ".join(pieces)) == expected


@pytest.mark.parametrize("name", each())
def test_every_shipped_equation_reads_back_as_what_was_derived(name: str) -> None:
    derivation = shipped(name)
    for step in derivation.steps:
        for equation in step.equations:
            assert_reads_back(derivation, equation.lhs)
            for expression in equation.rhs if equation.rhs.is_Matrix else (equation.rhs,):
                assert_reads_back(derivation, expression)


STATES = tuple(Variable(name, latex) for name, latex in (("a", "a"), ("a_dot", r"\dot a"), ("b", r"\beta_1")))
PUSH = (Variable("push", "w"),)
SYMBOLS = symbols_of((*STATES, *PUSH))


@pytest.fixture(scope="module")
def toy() -> Derivation:
    a, a_dot, _, push = SYMBOLS
    model = FirstOrder(
        name="toy",
        title="",
        states=STATES,
        controls=PUSH,
        parameters=(),
        rates=dict(zip(SYMBOLS[:3], (a_dot, push - a, a), strict=True)),
    )
    return derive(Problem(name="toy", title="", model=model, running_cost=push**2, control_set="ball"))


def expressions() -> st.SearchStrategy[sp.Expr]:
    """Sums of products of numbers, powers, sums and functions, over products of the same."""
    symbol = st.sampled_from((*SYMBOLS, sp.Symbol("lambda_a_dot", real=True)))
    number = st.sampled_from([sp.Integer(k) for k in (1, 1, -1, 2, -3)] + [sp.Rational(1, 2), sp.Rational(-3, 2)])
    number |= st.sampled_from([sp.sqrt(2), sp.Float(1.5)])

    def larger(inner: st.SearchStrategy[sp.Expr]) -> st.SearchStrategy[sp.Expr]:
        plain = st.lists(symbol | st.builds(sp.Pow, symbol, st.sampled_from([2, 3])), max_size=2)
        bracket = st.one_of(inner, st.builds(sp.cos, inner), st.builds(lambda e: sp.sqrt(e**2 + 1), inner))
        powers = st.builds(sp.Pow, inner, st.sampled_from([2, 3]))
        below = plain | st.builds(lambda e, p: [(e**2 + 1) ** p], inner, st.sampled_from([1, sp.Rational(3, 2)]))
        products = st.builds(
            lambda c, over, brackets, under: sp.Mul(c, *over, *brackets, *(1 / u for u in under), evaluate=False),
            number,
            plain,
            st.lists(bracket | powers, max_size=2),
            below,
        )
        return st.lists(products, min_size=1, max_size=3).map(lambda terms: sp.Add(*terms))

    return larger(st.lists(st.builds(sp.Mul, number, symbol), min_size=1, max_size=3).map(lambda t: sp.Add(*t)))


def awkward() -> list[sp.Expr]:
    a, b, c, w = SYMBOLS
    lam = sp.Symbol("lambda_a_dot", real=True)
    distance = sp.sqrt(a**2 + b**2 + c**2)
    return [
        -2 * w * (a * distance**3 - 3 * b) / distance**3,
        sp.sqrt(1 + a / (b * c)),
        sp.sqrt(1 + a / (b + c)),
        sp.sqrt(1 + 3 * a / 2 + sp.Rational(1, 3)),
        sp.sqrt(1 + sp.Mul(sp.Rational(3, 2), a + b, evaluate=False)) * c,
        -a / 2 - 3 * b / 2,
        w - a**2 / 2 - 3 * b**2 / 2,
        sp.Mul(sp.Rational(-1, 2), a**2 + b**2, evaluate=False) - lam / 2,
        sp.cos(a) * (a + b),
        sp.cos(a) ** 2 * (a + b) * sp.sin(b) / c**2,
        lam * (w - 2 * a * b) / c - lam**2 / (2 * c**2),
        -lam * (-a - b / c) ** 3 * (-b - 1),
        sp.exp(-a * b) * 2 ** (a / 2) / 3**b,
        (a / b) ** c,
        sp.log(1 + a**2) ** 2 / 2,
        control_sets.Clip(-lam / (2 * c), -w, w + a / b),
        -lam * control_sets.Shorten(lam**2 + a**2, w),
    ]


@pytest.mark.parametrize("expression", awkward(), ids=str)
def test_awkward_expressions_read_back(toy: Derivation, expression: sp.Expr) -> None:
    assert_reads_back(toy, expression)


@pytest.mark.slow
@examples(300, suppress_health_check=[HealthCheck.too_slow])
@given(expressions())
def test_any_expression_reads_back(toy: Derivation, expression: sp.Expr) -> None:
    assert_reads_back(toy, expression)
