"""Printed programs are parsed and walked through, never executed."""

from __future__ import annotations

import time

import numpy as np
import pytest

from satsym.auditing.program import run as program_run
from satsym.auditing.program import text as program
from satsym.formula import reading
from satsym.formula.calculus import Calculus
from satsym.formula.tree import Sym
from satsym.formula.values import Matrix, Sources
from satsym.formula.writing import written
from satsym.status import BadInput
from tests.support.ledgers import HEAD, judged, row


def run(*lines: str) -> program_run.Run:
    return program_run.run(program.read(lines))


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
    assert found.said == ["n is 3, low"]


def test_names_are_followed():
    read = program.read(["a = 1", "def f(x):", "    return x + b", "c = f(a)", "b = 2", "d = e"])
    assert program.loose_names(read) == ["e"]
    assert program.sources(read, ["c"]) == {"a", "b", "c", "f"}


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
    assert "should be `g*m/x1**2`: a factor is missing" in found["1"].diagnosis
    assert found["2"].derived
