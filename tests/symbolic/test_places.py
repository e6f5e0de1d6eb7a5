"""What is refused of a model names the author's file and line."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from satsym.cli import main

MODEL = """
from sympy import Symbol
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("x", "x", "m"), Variable("v", "v", "m/s"))
CONTROLS = (Variable("u", "u", "m/s^2"),)
PARAMETERS = (Variable("k", "k", "1/s", default=1.0),)
x, v = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)
(k,) = symbols_of(PARAMETERS)

motion = FirstOrder(
    name="cart",
    title="A cart",
    states=STATES,
    controls=CONTROLS,
    parameters=PARAMETERS,
    rates={
        x: v,
        v: u - k * v,
    },
)
effort = Problem(
    name="effort",
    title="Effort",
    model=motion,
    running_cost=u**2,
    terminal_cost=0 * x,
)
PROBLEMS = (effort,)
"""


@pytest.mark.parametrize(
    ("right", "wrong", "line", "message"),
    [
        ("running_cost=u**2", 'running_cost=u**2 + Symbol("w")', "running_cost", "uses undeclared symbols: w"),
        ("v: u - k * v", "v: u - k * x", "v: u", "the rate of v .*dimension"),
        ("x: v,", 'x: v + Symbol("gust"),', "x: v", "uses undeclared symbols: gust"),
        ("terminal_cost=0 * x", "terminal_cost=x", "terminal_cost", "the terminal cost, .* has the dimension"),
        ("terminal_cost=0 * x", "terminal_cost=u", "terminal_cost", "the terminal cost cannot depend on u"),
        ("terminal_cost=0 * x", "maximise=1", "maximise", "maximise: got 1; write True or False"),
        ("terminal_cost=0 * x", 'control_set="disc"', "control_set", "control_set: got"),
        ("running_cost=u**2", "running_cost=u**4 / (k**4 * x**2) - u**2", "effort = ", "several local"),
        ('"u", "u", "m/s^2"', '"u", "u", "m/s^^2"', None, "unit"),
        ('"u", "u", "m/s^2"', '"u", -1, "m/s^2"', "CONTROLS", "got -1 for latex; write text in quotes"),
        (
            '"u", "u", "m/s^2"',
            '"u", "u", "m/s^2", kind="turn"',
            "CONTROLS",
            'got the kind .turn.; write "real" or "angle"',
        ),
        ('"u", "u", "m/s^2"', '"u", " ", "m/s^2"', "CONTROLS", "latex is ' '; write its LaTeX with matching braces"),
        ('"u", "u", "m/s^2"', '"u", "u}{", "m/s^2"', "CONTROLS", "latex is 'u}{'; write its LaTeX"),
        ("u - k * v", "u - 'k'(v)", "v: u", "not callable"),
    ],
)
def test_the_message_names_file_and_line(
    right: str, wrong: str, line: str | None, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert right in MODEL
    text, file = MODEL.replace(right, wrong), tmp_path / "mine.py"
    file.write_text(text, encoding="utf-8")
    assert main(["derive", str(file), "--out", str(tmp_path / "out")]) == 3
    (said,) = capsys.readouterr().err.splitlines()
    assert re.search(message, said)
    found = re.search(r"mine\.py:(\d+): ", said)
    assert found
    if line is not None:
        assert line in text.splitlines()[int(found[1]) - 1]
