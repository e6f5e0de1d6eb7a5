"""Methods are listed in one place, from which instance files, the command line and what is called are made."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import msgspec
import pytest

from satsym import instance, methods
from satsym.instance import Instance
from satsym.instance.schema import check
from satsym.methods import Method
from satsym.solvers import solve
from satsym.status import BadInput, Status
from tests.support.contributing import example

SOLVER = '''
import numpy as np

from satsym.solution import Solution
from satsym.solvers.simulation.simulating import simulate
from satsym.status import Status


def solve(instance, progress=None):
    """The motion without control, whatever it costs."""
    free = simulate(instance)
    cost = instance.model.terminal_cost(instance.tf, tuple(free.x[:, -1]), instance.parameters)
    return Solution(
        instance=instance, method="coasting", status=Status.CONVERGED, message="nothing was done", objective=cost,
        times=free.times, x=free.x, u=free.u, lam=np.zeros_like(free.x), switching_times=((), ()),
        iterations=0, history=(), wall_s=0.0,
    )
'''

RECORD = example("A solution method", "python").replace("satsym.solvers.", "")


@pytest.fixture
def coasting(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Method:
    """A method of one's own: a function and a record."""
    (tmp_path / "coasting.py").write_text(SOLVER, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    method: Method = eval(RECORD, {"Method": Method})  # noqa: S307
    monkeypatch.setitem(methods.METHODS, method.name, method)
    return method


def case(folder: Path, method: str, tf: str = "1.0") -> Path:
    path = folder / "case.toml"
    states = "r = 1.1\nr_dot = 0.0\ntheta = 0.0\ntheta_dot = 0.9"
    text = f'model = "polar_orbit"\n[initial]\n{states}\n[time]\ntf = {tf}\n[solver]\nmethod = "{method}"\n'
    path.write_text(text, encoding="utf-8")
    return path


def test_adding_a_method_is_one_record(coasting: Method, tmp_path: Path) -> None:
    asked = instance.load(str(case(tmp_path, "coasting")))
    found = solve(asked)
    assert (found.status, found.method, found.certificate) == (Status.CONVERGED, coasting.name, None)
    assert not found.u.any()
    with pytest.raises(BadInput, match=r"case\.toml: time\.tf: coasting never ends"):
        solve(instance.load(str(case(tmp_path, "coasting", tf='"free"'))))
    with pytest.raises(BadInput, match=r'\[solver\] method: got "gliding"; give one of "auto", .*, "coasting"'):
        instance.load(str(case(tmp_path, "gliding")))


def test_the_command_line_lists_and_takes_a_method_that_was_added(coasting: Method, tmp_path: Path) -> None:
    added = f"from satsym.methods import METHODS, Method; METHODS['coasting'] = {RECORD.strip()}"

    def run(*arguments: str) -> str:
        code = f"import sys\nsys.path.insert(0, {str(tmp_path)!r})\n{added}\nfrom satsym.cli import main\n"
        code += f"sys.argv[1:] = {list(arguments)!r}\nsys.exit(main())"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert re.search(rf"coasting +{coasting.title}", run("solve", "--help"))
    answer = json.loads(run("solve", str(case(tmp_path, "auto")), "--method", "coasting", "--json"))
    assert (answer["method"], answer["message"]) == ("coasting", "nothing was done")


def test_without_the_record_there_is_no_such_method(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r'\[solver\] method: got "coasting"; give one of "auto", "sweep", "colloc'):
        instance.load(str(case(tmp_path, "coasting")))


@pytest.mark.parametrize("name", methods.METHODS)
def test_every_method_has_its_function_and_a_line(name: str) -> None:
    method = methods.METHODS[name]
    module, _, function = method.solver.partition(":")
    assert callable(getattr(import_module(module), function))
    assert method.name == name
    assert method.title
    assert len(method.title) < 64
    tree = {"model": "m", "initial": {}, "time": {"tf": 1.0}, "solver": {"method": name}}
    assert check(tree).solver.method == name


def test_every_kind_of_controls_has_one_method_to_begin_with() -> None:
    assert [(m.switching, m.constrained) for m in methods.METHODS.values() if m.automatic] == [
        (False, False),
        (True, False),
        (False, True),
    ]
    shown = ("soft-return", "lapan-minimum-time", "bryson-denham")
    chosen = [methods.automatic(instance.load(name).model.spec).name for name in shown]
    assert chosen == ["collocation", "bang-bang", "boundary-arcs"]


@pytest.mark.parametrize(
    ("name", "method", "line"),
    [
        (
            "soft-return",
            "bang-bang",
            'solver.method: "bang-bang" is for controls whose squares do not enter the cost; use ',
        ),
        (
            "return-to-orbit",
            "sweep",
            "a given final r, r_dot, theta, theta_dot is not supported by the sweep method; leave it",
        ),
        ("double-integrator-time", "linear", 'which "linear" does not support; use "bang-bang"'),
        ("ends-5-free", "sweep", "time.tf: the sweep method does not support a free final time; use method "),
    ],
)
def test_what_a_method_cannot_solve_is_refused_in_a_line(name: str, method: str, line: str) -> None:
    with pytest.raises(BadInput) as refused:
        solve(naming(instance.load(name), method))
    assert str(refused.value).startswith(f"{name}: ")
    assert line in str(refused.value)


def naming(asked: Instance, method: str) -> Instance:
    return replace(asked, solver=msgspec.structs.replace(asked.solver, method=method))
