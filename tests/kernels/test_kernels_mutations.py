"""Whatever passes the check of files loaded by path is harmless: shown on mutations of a legal module."""

from __future__ import annotations

import ast
import copy
import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

from satsym.kernels.bodies import Unexpected
from satsym.kernels.checking import check
from tests.support.derived import derived
from tests.support.examples import examples


@pytest.fixture(scope="module")
def legal() -> str:
    """A pendulum in a box: small, because every mutation is checked as a whole."""
    from sympy import sin

    from satsym.codegen.module import render
    from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

    states, controls, parameters = (
        (Variable("y", "y"), Variable("v", "v")),
        (Variable("a", "a"),),
        (Variable("k", "k"),),
    )
    (y, v), (a,), (k,) = symbols_of(states), symbols_of(controls), symbols_of(parameters)
    model = FirstOrder(
        name="motion",
        title="A motion",
        states=states,
        controls=controls,
        parameters=parameters,
        rates={y: v, v: a - k * sin(y)},
    )
    problem = Problem(name="problem", title="A problem", model=model, running_cost=a**2 / 2, control_set="box")
    return render(derived(problem), "mine.py")


# Whatever passes the check holds nothing but these. This list is written independently of the checker.
HARMLESS = (
    *(ast.Module, ast.Import, ast.alias, ast.FunctionDef, ast.arguments, ast.arg, ast.Return, ast.Assign, ast.For),
    *(ast.If, ast.Is, ast.Expr, ast.Constant, ast.Name, ast.Load, ast.Store, ast.Tuple, ast.Starred, ast.Dict),
    *(ast.BinOp, ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.UnaryOp, ast.USub, ast.Call, ast.Attribute),
    *(ast.Subscript, ast.IfExp, ast.Compare, ast.Lt, ast.LtE, ast.Gt, ast.GtE),
)
NUMPY = "abs arccos arcsin arctan arctan2 cos cosh exp heaviside log maximum minimum pi sin sinh sqrt tan tanh"
MATH = "acos asin atan atan2 cos cosh exp fabs log pi sin sinh sqrt tan tanh"
ATTRIBUTES = {"np": {*NUMPY.split(), *"broadcast_shapes empty result_type shape".split()}, "math": {*MATH.split()}}
HOSTILE = [
    *("9**9", "'a'", "10**8", "x[99]", "eval('1')", "__import__('os')", "math.sin", "np.load('a')", "y.real", "[y]"),
    *("(lambda: 1)()", "y if y else y", "dynamics(t, x, u, p)", "-7", "i + 7", "f'{y}'", "(w := 1.0)", "...", "1e999"),
    *("len(x)", "range(9)", "x", "times", "out", "y_at[i + 9]", "None", "(1.0, 2.0)", "math", "{}", "*x", "i", "steps"),
]


def assert_harmless(tree: ast.Module) -> None:
    for node in ast.walk(tree):
        assert isinstance(node, HARMLESS), ast.dump(node)
        if isinstance(node, ast.Attribute):
            assert isinstance(node.value, ast.Name)
            assert node.attr in ATTRIBUTES[node.value.id]
        if isinstance(node, ast.Call):
            plain = isinstance(node.func, ast.Name) and node.func.id in ("len", "range")
            assert plain or isinstance(node.func, ast.Attribute)
            assert not node.keywords
        if isinstance(node, ast.FunctionDef):
            assert not node.decorator_list
            assert not node.returns
            assert [ast.unparse(default) for default in node.args.defaults] in ([], ["None"])
        if isinstance(node, ast.Constant) and isinstance(node.value, int):
            assert abs(node.value) <= 10**6
        if isinstance(node, ast.Name | ast.arg):
            assert "__" not in (node.id if isinstance(node, ast.Name) else node.arg)
        if isinstance(node, ast.For):
            assert ast.unparse(node.iter) in ("range(steps)", "range(steps - 1, -1, -1)")
            assert not any(isinstance(inner, ast.For) for statement in node.body for inner in ast.walk(statement))


def test_the_legal_module_is_harmless(legal: str):
    assert_harmless(ast.parse(legal))


@pytest.mark.slow
@examples(80, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_whatever_mutation_passes_the_check_is_harmless(legal: str, data: st.DataObject):
    definitions = [node for node in ast.parse(legal).body if isinstance(node, ast.FunctionDef)]
    function = data.draw(st.sampled_from(definitions))
    for _ in range(data.draw(st.integers(1, 3))):
        mutate(function, data)
    lines = legal.splitlines(keepends=True)
    try:
        lines[function.lineno - 1 : function.end_lineno] = ast.unparse(ast.fix_missing_locations(function)) + "\n"
        _, functions = check("".join(lines))
    except (Unexpected, ValueError):
        return
    assert_harmless(ast.parse("".join(lines)))
    run(functions, function.name)


def run(functions: list[ast.FunctionDef], name: str) -> None:
    """Call a function with legal arguments: only arithmetic may fail, never a name, an index or a shape."""
    namespace = {"__builtins__": {"float": float, "len": len, "range": range}, "math": math, "np": np}
    exec(compile(ast.Module(list(functions), []), "mutant", "exec", dont_inherit=True), namespace)  # noqa: S102
    state, tables = (1.1, 0.1), {"x": 2, "lam": 2, "u": 1}
    simple = {"t": 0.5, "x": state, "u": (0.1,), "lam": state, "p": (1.2,), "bounds": (-1.0, 1.0)}
    simple |= {"nu": (), "final": (0.5,) * 6}
    loop = {"times": [0.0, 0.1, 0.2, 0.4], "x0": state, "lam_f": state, "p": (1.2,)}
    loop |= {a: tuple([0.5] * 4 for _ in range(rows)) for a, rows in tables.items()}
    loop |= {f"{a}_mid": tuple([0.5] * 3 for _ in range(rows)) for a, rows in tables.items()}
    function = namespace[name]
    arguments = function.__code__.co_varnames[: function.__code__.co_argcount]
    given_arguments = loop if name in ("forward", "backward") else simple
    if name.endswith("_batch"):
        given_arguments = {a: np.array(v)[..., None] if a in ("x", "u", "lam") else v for a, v in simple.items()}
    try:
        with np.errstate(all="ignore"):
            function(*(given_arguments[a] for a in arguments if a != "out"))
    except (ZeroDivisionError, OverflowError):
        pass
    except (ValueError, TypeError) as error:
        assert any(word in str(error) for word in ("math", "complex")), error  # noqa: PT017


def mutate(function: ast.FunctionDef, data: st.DataObject) -> None:
    """Put an expression or a statement where another one was."""
    nodes = list(ast.walk(function))
    places = [
        (node, name, k)
        for node in nodes
        for name, value in ast.iter_fields(node)
        for k, old in (enumerate(value) if isinstance(value, list) else [(None, value)])
        if isinstance(old, ast.expr | ast.stmt)
    ]
    node, name, k = data.draw(st.sampled_from(places))
    old = getattr(node, name) if k is None else getattr(node, name)[k]
    if isinstance(old, ast.expr):
        foreign = st.sampled_from(HOSTILE).map(lambda text: ast.parse(f"({text},)", mode="eval").body.elts[0])
        new = copy.deepcopy(data.draw(st.sampled_from([n for n in nodes if isinstance(n, ast.expr)]) | foreign))
    else:
        new = copy.deepcopy(
            data.draw(st.sampled_from([n for n in nodes if isinstance(n, ast.stmt) and n is not function]))
        )
    if k is None:
        setattr(node, name, new)
    else:
        getattr(node, name)[k] = new


@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::SyntaxWarning")  # escapes in docstrings
@examples(80, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    place=st.floats(0, 1),
    length=st.integers(0, 12),
    instead=st.text(st.sampled_from("abirx_.,:;=+-*/()[]{}'\"\\@# \n\t01e\0"), max_size=8),
)
def test_whatever_edited_text_passes_the_check_is_harmless(legal: str, place: float, length: int, instead: str):
    start = int(place * len(legal))
    text = legal[:start] + instead + legal[start + length :]
    try:
        check(text)
    except Unexpected:
        return
    assert_harmless(ast.parse(text))
