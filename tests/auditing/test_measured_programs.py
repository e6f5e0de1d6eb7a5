"""What claims measure of printed programs and formulas: as Python, and sympy, would have it."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

from satsym.auditing.measurements import formulas, programs
from satsym.auditing.propositions.values import Undecided
from satsym.status import BadInput

PROGRAM = [
    "import numpy as np",
    "import matplotlib.pyplot as plt",
    "a = 2.0",
    "def f(x, y):",
    "    return [a * x[0], y]",
    "b = np.array([a, 3.0])",
    "c = f(b, 1)",
    'print(f"c ends with {c[1]}")',
    'plt.plot(b / 10, b, label="line")',
    'plt.xlabel("x (km)")',
]


def test_values_functions_output_and_pictures_are_those_of_the_lines():
    found = programs.values(PROGRAM)
    assert found.part("c") == [4.0, 1]
    np.testing.assert_array_equal(programs.called(PROGRAM, "f", [3.0, 0.0], 5.0), [6.0, 5.0])
    assert programs.output(PROGRAM) == ["c ends with 1"]
    (line,) = programs.drawn(PROGRAM, "plot")
    assert line.part("label") == "line"
    np.testing.assert_array_equal(line.part("x"), [0.2, 0.3])
    assert programs.unit_in(programs.drawn(PROGRAM, "xlabel")[0].part("x")) == 1000.0


def test_given_values_take_the_place_of_assigned_ones_and_of_missing_ones():
    assert programs.values(PROGRAM, a=5).part("c") == [25.0, 1]
    assert programs.output(["print(n)"], n=[1, 2]) == ["[1 2]"]
    assert programs.values(["y = x.real"], x=sp.Rational(1, 2) + sp.I).part("y") == 0.5


def test_lines_at_the_end_are_tried_in_the_world_of_the_program():
    assert programs.values([*PROGRAM, "d = f(c, 0)"]).part("d") == [8.0, 0]


def test_names_are_followed():
    assert programs.assigned(PROGRAM) == ["np", "plt", "a", "f", "b", "c"]
    assert programs.sources(PROGRAM, "c") == ["a", "b", "f", "np"]
    assert "plt" in programs.used(PROGRAM)
    assert programs.unassigned(PROGRAM) == []
    assert sorted(programs.unassigned(PROGRAM[3:])) == ["a", "np", "plt"]


def test_a_program_that_stops_says_why_and_has_no_values():
    assert programs.stops(PROGRAM) == []
    (why,) = programs.stops([*PROGRAM, "d = e"])
    assert "has no value" in why
    for work in (programs.values, programs.output):
        with pytest.raises(Undecided, match="has no value"):
            work([*PROGRAM, "d = e"])
    with pytest.raises(Undecided, match="is not supported"):
        programs.stops(["import os"])
    with pytest.raises(Undecided, match="not Python"):
        programs.values(["a = ("])
    with pytest.raises(BadInput, match="no function"):
        programs.called(PROGRAM, "g")
    with pytest.raises(BadInput, match="no unit"):
        programs.unit_in("x")


def test_formulas_are_differentiated_filled_in_integrated_and_solved():
    x, k = sp.Symbol("x", real=True), sp.Symbol("k", positive=True)
    assert formulas.diff(k * x**3, "x", 2) == 6 * k * x
    assert formulas.diff(sp.Integer(3), x) == 0
    assert formulas.subs(k * x, k=2, x=k) == 2 * k
    assert formulas.integral(sp.exp(-k * x), x, 0, float("inf")) == 1 / k
    assert formulas.solutions(x**2 - k**2, x) == [-k, k]
    assert formulas.solutions(x**2 + 1, x) == []
    assert formulas.left("a*b = c") == ["a", "b"]
    assert formulas.left("c") == []
    assert formulas.blocks([[sp.eye(1), sp.zeros(1)], [sp.zeros(1), sp.eye(1)]]) == sp.eye(2)
    with pytest.raises(BadInput, match="not a symbol"):
        formulas.diff(x, x + k)
