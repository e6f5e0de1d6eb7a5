"""A round through what satsym does, each step with a known answer; for environments other than the tests' own."""

from __future__ import annotations

import contextlib
import io
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import sympy

from satsym import instance
from satsym.analysis.linear.equilibrium import linearise
from satsym.cli import main
from satsym.cli.requirements import requirements
from satsym.kernels import load

CASE = """
model = "double_integrator_energy"
title = "With units"
[initial]
q = "100 cm"
q_dot = "0 cm/s"
[final]
q = 0.0
q_dot = 0.0
[time]
tf = "1000 ms"
"""


OWN = """
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("q", "q", "m", "place"), Variable("q_dot", "v", "m/s", "speed"))
CONTROLS = (Variable("u", "u", "m/s^2", "push"),)
(q, q_dot), (u,) = symbols_of(STATES), symbols_of(CONTROLS)
cart = FirstOrder(
    name="cart", title="A cart", states=STATES, controls=CONTROLS, parameters=(), rates={q: q_dot, q_dot: u}
)
PROBLEMS = (Problem(name="own", title="Own", model=cart, running_cost=u**2 / 2),)
"""


def quietly(*words: str) -> int:
    """The exit code of a command; what it prints is not what is looked at."""
    with contextlib.redirect_stdout(io.TextIOWrapper(io.BytesIO(), encoding="utf-8")):
        return main(list(words))


def run(*words: str) -> dict[str, Any]:
    """What a command writes into result.json."""
    out = Path("out", words[0])
    code = quietly(*words, "--out", str(out))
    if code:
        sys.exit(f"satsym {' '.join(words)}: exit {code}")
    found: dict[str, Any] = json.loads((out / "result.json").read_text(encoding="utf-8"))
    return found


def expect(what: str, true: bool) -> None:
    """End here unless that is so."""
    if not true:
        sys.exit(f"{what}: not so")


def check() -> None:
    """Solve, simulate, analyse, regulate, draw, read units, compile, hand over to python-control."""
    Path("case.toml").write_text(CASE, encoding="utf-8")
    solved = run("solve", "case.toml", "--plot")
    expect("from rest to rest costs 6", abs(solved["objective"] - 6.0) < 1e-8)
    expect("certified", solved["certificate"]["verdict"] == "certified")
    expect("pictures", any(Path("out/solve").glob("*.png")))
    expect("simulated", abs(run("simulate", "return-to-orbit")["t_final"] - 2.0 * np.pi) < 1e-9)
    verdict = run("analyse", "polar_orbit")["stability"]["verdict"]
    expect("the orbit's linearisation is unstable, its double zero growing like t", verdict == "unstable")
    gain = np.array(run("lqr", "uny-lqr")["K"])
    expect("the printed gain", np.allclose(gain, [[10.2210, 4.2841, -1.0, 4.0170]], atol=1e-4))
    found = linearise(load("polar_orbit")).system
    poles = np.sort_complex(found.to_control().poles())
    expect("python-control has the same poles", np.allclose(poles, np.sort_complex(np.linalg.eigvals(found.A))))
    case = instance.load("return-to-orbit")
    nodes, rest = np.linspace(0.0, 1.0, 50), np.zeros((2, 50))
    ours, compiled = (
        k.forward(nodes, case.initial, rest, rest[:, 1:], case.parameters) for k in (case.model, case.model.compiled())
    )
    expect("compiled code computes the same", np.allclose(ours[0], compiled[0], rtol=1e-12))
    Path("own.py").write_text(OWN, encoding="utf-8")
    expect("own models are derived", not quietly("derive", "own.py", "--out", "made"))
    Path("own.toml").write_text(CASE.replace("double_integrator_energy", "made/own"), encoding="utf-8")
    expect("they are solved", abs(run("solve", "own.toml")["objective"] - 6.0) < 1e-8)
    pinned = next(r for r in requirements() if r.extra == "derive" and r.name == "sympy")
    if not pinned.allows(sympy.__version__):
        with contextlib.redirect_stderr(io.StringIO()) as said:
            expect("what is checked in is not written with another sympy", quietly("derive", "--check") == 3)
        expect("and the one that it is written with is named", pinned.versions in said.getvalue())
    expect("LaTeX", not quietly("latex", "polar_orbit"))


if __name__ == "__main__":
    check()
