"""The stub by which kernels are typed, against the contract and against what generated modules hold."""

from __future__ import annotations

import ast
import subprocess
import sys
from inspect import signature
from pathlib import Path

import pytest

from satsym import kernels
from satsym.codegen import protocol
from satsym.kernels import contract


def test_the_types_of_kernels_are_those_of_the_contract() -> None:
    assert protocol.FILE.read_text() == protocol.text(), "write it anew: python -m satsym.codegen.protocol"


@pytest.mark.parametrize("name", ["polar_orbit", "clohessy_wiltshire", "pitch_minimum_time", "explicit_time"])
def test_what_is_typed_is_what_generated_modules_hold(name: str) -> None:
    """Names, arguments in their order, and whether there is one number or several."""
    of = kernels.load(name)
    (functions,) = (one for one in ast.parse(protocol.FILE.read_text()).body if isinstance(one, ast.ClassDef))
    typed = {one.name: one for one in functions.body if isinstance(one, ast.FunctionDef)}
    assert of.functions.keys() - contract.LOOPS.keys() <= typed.keys()
    for key, function in of.functions.items():
        if key not in contract.LOOPS:
            assert [a.arg for a in typed[key].args.args][1:] == list(signature(function).parameters), key


WRONG = {
    "p left out": "model.dynamics(0.0, (1.0,), (0.0,))",
    "a function that no model has": "model.dynamic(0.0, (1.0,), (0.0,), ())",
    "a name for a time": 'model.dynamics("tf", (1.0,), (0.0,), ())',
    "arrays at one point": "sum(model.running_cost(np.zeros(3), (1.0,), (0.0,), ()))",
}


@pytest.mark.slow
def test_mypy_sees_wrong_calls_of_kernels(tmp_path: Path) -> None:
    lines = ["import numpy as np", "from satsym import kernels", 'model = kernels.load("hill")', *WRONG.values()]
    right = "rates: tuple[float, ...] = model.dynamics(0.0, [1.0], (0.0,), ())"
    (tmp_path / "calls.py").write_text("\n".join([*lines, right, ""]))
    command = [sys.executable, "-m", "mypy", "--num-workers=0", "--no-error-summary", str(tmp_path / "calls.py")]
    found = subprocess.run(command, capture_output=True, text=True)
    wrong = {int(line.split(":")[1]) for line in found.stdout.splitlines() if "error" in line}
    assert wrong == set(range(4, 4 + len(WRONG))), found.stdout
