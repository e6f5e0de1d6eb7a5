"""Printed programs are parsed and walked through, never executed; and what is found of them can be yes and no."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest

from satsym.auditing.predicates import Finding, Question, registry
from satsym.auditing.program import run as program_run
from satsym.auditing.program import text as program
from satsym.formula import reading
from satsym.formula.calculus import Calculus
from satsym.formula.tree import Sym
from satsym.formula.values import Matrix, Sources
from satsym.formula.writing import written
from satsym.status import BadInput
from tests.support import itb_routes as routes
from tests.support.ledgers import HEAD, judged, row

WHOLE = tuple(routes.whole(routes.rows()))
RATES = WHOLE[7:14]
JACOBIAN = WHOLE[14:34]
PLOT = next(line for line in WHOLE if line.startswith("plt.plot"))
ROW = Question("row", "claim", "", (), {}, "main", {}, {"whole": WHOLE})
FASTER = ["34.78e3 m/s", "42.38e3 m/s"]


def run(*lines: str) -> program_run.Run:
    return program_run.run(program.read(lines))


def ask(name: str, lines: object = "", /, **arguments: object) -> Finding:
    """What a predicate finds, given a row if it wants one."""
    found = registry()[name]
    if "row" in found.__code__.co_varnames[: found.__code__.co_argcount]:
        arguments["row"] = replace(ROW, printed=lines)
    return found(**arguments)


def changed(old: str, new: str, lines: tuple[str, ...] = WHOLE) -> tuple[str, ...]:
    """Lines with a slip in them."""
    assert any(old in line for line in lines)
    return tuple(line.replace(old, new) for line in lines)


@pytest.mark.parametrize(
    "lines",
    [
        ("__import__('os').system('true')",),
        ("x = (1).__class__",),
        ("x = ().__class__.__bases__",),
        ("x = open('/etc/passwd')",),
        ("import os",),
        ("import numpy as np", "x = np.load('file')"),
        ("import numpy as np", "x = np.linalg.norm.__globals__"),
        ("from scipy.integrate import quad",),
        ("x = 'a'*1000000000",),
        ("x = [0]*1000000000",),
        ("x = 9**9**9**9",),
        ("x = 1" + "0" * 400,),
        ("import numpy as np", "x = np.zeros(1000000000)"),
        ("import numpy as np", "x = np.eye(100000)"),
        ("import numpy as np", "a = np.zeros((1, 90000))", "b = np.zeros((90000, 1))", "x = a + b"),
        ("while True:", "    x = 1"),
        ("def f(n):", "    return f(n)", "x = f(1)"),
        ("f = lambda x: x",),
        ("x = [i for i in y]",),
        ("exec('x = 1')",),
        ("x = eval('1')",),
        ("x = f'{1:>1000000000}'",),
        ("def f(*a):", "    return a", "x = f(1)"),
        ("x = y",),
        ("x = 1/0",),
        ("a, b = 1, 2, 3",),
        ("x = (",),
        ("x = " + "(" * 1000 + "1" + ")" * 1000,),
        ("x" * 30_000,),
        ("print(print)", "x = 1 +"),
    ],
)
def test_what_is_not_known_is_refused_in_a_line_and_at_once(lines):
    begun = time.process_time()
    with pytest.raises(BadInput) as told:
        run(*lines)
    assert "\n" not in str(told.value)
    assert time.process_time() - begun < 1.0


def test_what_a_program_does_is_what_python_would_do():
    found = run(
        "import numpy as np",
        "def f(a, b):",
        "    c, d = a",
        "    return [c - d, b**2 / -4]",
        "x = f((3, 5), 6)",
        "m = np.zeros((2, 3))",
        "m[:1, 1:] = np.array([[1, 2.5]])",
        "n = len(m[0])",
        "low = any(e < 0 for e in x)",
        "print(f\"n is {n}, {'low' if low else 'high'}\")",
    )
    assert found.values["x"] == [-2, -9.0]
    np.testing.assert_array_equal(found.values["m"], [[0.0, 1.0, 2.5], [0.0, 0.0, 0.0]])
    assert found.said == ("n is 3, low",)


def test_names_are_followed():
    read = program.read(["a = 1", "def f(x):", "    return x + b", "c = f(a)", "b = 2", "d = e"])
    assert [(loose.line, loose.name) for loose in program.loose_names(read)] == [("d = e", "e")]
    assert program.sources(read, ["c"]) == {"a", "b", "c", "f"}


@pytest.mark.parametrize(
    ("name", "lines", "arguments"),
    [
        ("listed_rates", changed("r**3", "r**2", RATES), {"name": "orbitalEquation"}),
        ("listed_rates", changed("ay = -mu", "ay = mu", RATES), {"name": "orbitalEquation"}),
        ("listed_rates", changed("[vx, vy", "[vy, vx", RATES), {"name": "orbitalEquation"}),
        ("listed_jacobian", changed("* z**2", "* y**2", JACOBIAN), {"name": "calculateJacobi"}),
        ("listed_jacobian", changed("jacobian[:3, 3:]", "jacobian[3:, 3:]", JACOBIAN), {"name": "calculateJacobi"}),
        ("listed_jacobian", changed("d2z_dx = d2x_dz", "d2z_dx = d2x_dy", JACOBIAN), {"name": "calculateJacobi"}),
    ],
)
def test_a_slip_in_a_function_is_found(name, lines, arguments):
    right = {"listed_rates": RATES, "listed_jacobian": JACOBIAN}[name]
    assert ask(name, right, model="two_body", **arguments).holds
    assert ask(name, lines, model="two_body", **arguments).holds is False


@pytest.mark.parametrize(
    ("name", "yes", "no", "arguments"),
    [
        ("axis_unit", [PLOT.replace("1e11", "1.496e11"), 'plt.xlabel("x (AU)")'],
         [PLOT, 'plt.xlabel("x (AU)")'], {"name": "x"}),
        ("axis_unit", [PLOT.replace("1e11", "1e3"), 'plt.ylabel("y (km)")'],
         [PLOT, 'plt.ylabel("y (km)")'], {"name": "y"}),
        ("draws_undistorted", ["plt.grid()", 'plt.axis("equal")'], ["plt.grid()"], {}),
        ("marks_the_centre", "plt.scatter([0], [0])", "plt.scatter([1e11], [0])",
         {"program": "whole", "rates": "orbitalEquation"}),
        ("one_year", "3.156e7 s", "3.17e7 s", {}),
        ("one_year", "365 d", "360. d", {}),
        ("stands_in", ["mu = G * M_sun"], ["mu = G + M_sun"], {"program": "whole"}),
        ("imports_are_used", ["import numpy as np"], ["from scipy.linalg import eig", "import numpy as xp"],
         {"program": "whole"}),
        ("runs_through", WHOLE, changed("eig(jacobian)", "eig(jacob)"), {}),
        ("runs_through", WHOLE[:7], changed("mu = G *", "mu = H *", WHOLE[:7]), {}),
        ("blocks_make_jacobian", [["r by r", "r by v"], ["v by r", "v by v"]],
         [["r by r", "r by v"], ["v by v", "v by r"]], {"model": "two_body"}),
        ("derivative_is", ["v_dot", "r", "mu*(3*rrT/r**5 - one/r**3)"], ["v_dot", "r", "mu*(3*rrT/r**5 + one/r**3)"],
         {"model": "two_body"}),
    ],
)  # fmt: skip
def test_a_predicate_says_yes_and_no(name, yes, no, arguments):
    assert ask(name, yes, **arguments).holds
    assert ask(name, no, **arguments).holds is False


@pytest.mark.parametrize(
    ("name", "yes", "no"),
    [
        ("says", {"program": "whole", "answer": "No"}, {"program": "whole", "answer": "Yes"}),
        ("picture_depends_on", {"program": "whole", "name": "v0"}, {"program": "whole", "name": "eigenvalues"}),
        (
            "made_from",
            {"program": "whole", "name": "stability", "of": "jacobian", "without": "solution"},
            {"program": "whole", "name": "stability", "of": "jacobian", "without": "r0"},
        ),
        (
            "becomes_unbound",
            {"program": "whole", "readings": ["12.6e3 m/s"]},
            {"program": "whole", "readings": ["0.5e3 m/s", "5e3 m/s"]},
        ),
        ("samples_evenly", {"program": "whole", "points": 1000}, {"program": "whole", "points": 999}),
        ("goes_round", {"name": "itb-earth-kicked"}, {"name": "itb-earth-escape"}),
        ("start_decides_kind", {"instances": ["itb-earth", "itb-earth-escape"]}, {"instances": ["itb-earth"]}),
        (
            "rule_tells_apart",
            {"instances": ["itb-earth-escape"], "rule": "not positive"},
            {"instances": ["itb-earth", "itb-earth-escape"], "rule": "not positive"},
        ),
        (
            "block_is",
            {"model": "two_body", "of": "r", "by": "v", "printed": "identity"},
            {"model": "two_body", "of": "v", "by": "r", "printed": "zeros"},
        ),
    ],
)
def test_a_predicate_says_yes_and_no_by_its_arguments(name, yes, no):
    assert ask(name, **yes).holds
    assert ask(name, **no).holds is False


@pytest.mark.parametrize(
    ("name", "old", "new", "arguments"),
    [
        ("integrates", "rtol=1e-9", "rtol=1e-1", {}),
        ("starts_from", "hstack((r0, v0))", "hstack((v0, r0))", {"rates": "orbitalEquation"}),
        ("turns_once", "(0, 3.154e7)", "(0, 3.1e7)", {}),
        ("unpacks", "x, y, z = solution.y[:3]", "x, z, y = solution.y[:3]",
         {"source": "solution", "target": ("x", "y", "z")}),
        ("only_attraction", "ax = -mu * x / r**3", "ax = -mu * x / r**3 - 1e-12 * vx",
         {"rates": "orbitalEquation", "model": "two_body"}),
        ("linearises", "3 * mu * x * y", "2 * mu * x * y", {"jacobian": "calculateJacobi", "rates": "orbitalEquation"}),
        ("prints_lines", 'f"Eigenvalues:', 'f"Roots:', {"begins": "Eigenvalues:"}),
    ],
)  # fmt: skip
def test_a_slip_in_the_program_is_found(name, old, new, arguments):
    for lines, holds in ((WHOLE, True), (changed(old, new), False)):
        asked = replace(ROW, printed="solution = solve_ivp(rtol=1, atol=1)", document={"whole": lines})
        assert registry()[name](row=asked, program="whole", **arguments).holds is holds


def test_a_program_that_asks_for_the_energy_tells_bound_orbits():
    line = next(line for line in WHOLE if line.startswith("stability"))
    for lines, holds in ((WHOLE, False), (changed(line, "stability = v0[1]**2 / 2 - mu / r0[0] < 0"), True)):
        asked = replace(ROW, document={"whole": lines})
        assert registry()["tells_bound_orbits"](row=asked, program="whole", speeds=FASTER).holds is holds


@pytest.mark.parametrize(("rule", "holds"), [("negative", False), ("not positive", True)])
def test_the_rule_of_the_program_is_told_from_another(rule, holds):
    asked = replace(ROW, document={"line": "stability = all(e.real <= 0 for e in eigenvalues)"})
    assert registry()["rule_is_that_of"](row=asked, rule=rule, line="line").holds is holds


def test_a_name_typed_in_two_ways_is_a_slip_and_a_missing_one_is_not():
    document = {"whole": WHOLE, "twice": changed("def calculateJacobi", "def calculate_jacobian"), "bare": WHOLE[41:]}
    line = "jacobian = calculateJacobi(r0, v0)"
    asked = replace(ROW, printed=line, document=document)
    typed = registry()["has_value"](row=asked, program="twice", names=["calculateJacobi"], elsewhere="whole")
    absent = registry()["has_value"](row=asked, program="bare", names=["calculateJacobi"], elsewhere="whole")
    assert (typed.holds, typed.slip) == (False, True)
    assert (absent.holds, absent.slip) == (False, False)


def test_a_label_that_claims_nothing_is_not_false():
    honest = changed('label="Stable Orbit"', 'label="Orbit"')
    asked = replace(ROW, printed=PLOT.replace("Stable ", ""), document={"honest": honest})
    assert registry()["label_is_true"](row=asked, program="honest", word="Stable", velocities=FASTER).holds


@pytest.mark.parametrize(
    "line", ["stability = all(e.real < 0 for e in eigenvalues)", "stability = all(e.real <= 1 for e in eigenvalues)"]
)
def test_no_rule_of_signs_alone_is_right(line):
    assert ask("rule_decides", line).holds is False


def test_functions_of_numpy_are_read_as_ours():
    column = Matrix(((Sym("x"),), (Sym("y"),)))
    engine = Calculus(Sources({"r": column, "x": Sym("x")}.__getitem__, str, str), ())
    assert written(engine.value(reading.expression("np.linalg.norm(r)"))) == "(x**2 + y**2)**0.5"
    assert written(reading.expression("np.sqrt(x)")) == "sqrt(x)"
    for text in ("np.load(x)", "np.sqrt.x(x)", "os.sqrt(x)"):
        with pytest.raises(BadInput):
            reading.expression(text)


def test_a_wrong_exponent_and_a_missing_factor_are_found_together(tmp_path):
    """Two slips in one term, where effects do not add up."""
    rows = [row("1", "g/x1**3", "m*mu/r**2"), row("2", "-m*g*x1**2", "-mu*r**3")]
    found = judged(tmp_path, rows, HEAD)
    assert "`x1**3` should be `x1**2`" in found["1"].diagnosis
    assert "lacks a factor: it should be `g*m/x1**2`" in found["1"].diagnosis
    assert found["2"].derived
