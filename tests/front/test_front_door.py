"""The names of ``satsym`` itself: loaded when they are used, the same numbers and messages as the command line."""

from __future__ import annotations

import ast
import importlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import satsym
from satsym import instance
from satsym.cli import main
from satsym.status import BadInput
from tests.house.test_floors import imported_by
from tests.support.front import PUSH, SLED, TOML, a, pushed, q, v

HEAVY = {"numpy", "scipy", "sympy", "matplotlib", "numba", "pint", "msgspec"}


def printed(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    assert main([*arguments, "--json"]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def without_time(result: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in result.items() if name != "wall_s"}


def test_its_names_are_listed_and_the_list_loads_nothing(tmp_path: Path) -> None:
    code = "import satsym; assert set(satsym.__all__) <= set(dir(satsym)); hasattr(satsym, 'nothing')"
    assert not imported_by(code, tmp_path) & HEAVY
    assert len(satsym.__all__) == 22
    assert all(getattr(satsym, name) is not None for name in satsym.__all__)
    with pytest.raises(AttributeError, match="'nothing'"):
        satsym.nothing  # noqa: B018


def test_solving_through_it_loads_no_sympy_and_no_matplotlib(tmp_path: Path) -> None:
    code = "import satsym; s = satsym.solve('soft-return'); s.x(1.0); repr(s); s._repr_html_(); s.save('there')"
    assert not imported_by(code, tmp_path) & {"sympy", "matplotlib", "numba"}


def test_type_checkers_are_told_the_same_names_from_the_same_places() -> None:
    tree = ast.parse(Path(satsym.__file__).read_text(encoding="utf-8"))
    (told,) = (node for node in tree.body if isinstance(node, ast.If))
    assert isinstance(told.test, ast.Name)
    assert told.test.id == "TYPE_CHECKING"
    homes = {alias.name: node.module for node in told.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    assert homes.keys() == set(satsym.__all__)
    for name, home in homes.items():
        assert getattr(importlib.import_module(str(home)), name) is getattr(satsym, name)


@pytest.mark.slow
def test_solutions_are_those_of_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    theirs = printed(capsys, "solve", "return-to-orbit", "--steps", "50")
    ours = satsym.solve(satsym.load("return-to-orbit"), steps=50).to_dict()
    assert without_time(json.loads(json.dumps(ours))) == without_time(theirs)


def test_passed_limits_are_noted_as_on_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    theirs = printed(capsys, "solve", "lapan-minimum-energy")
    assert satsym.solve("lapan-minimum-energy").to_dict()["message"] == theirs["message"]


@pytest.mark.parametrize(
    ("command", "subject", "asked"),
    [
        ("analyse", "clohessy_wiltshire", satsym.analyse),
        ("analyse", "itb-earth", satsym.analyse),
        ("lqr", "geo-lqr", satsym.lqr),
        ("lqr", "clohessy_wiltshire", satsym.lqr),
        ("simulate", "its-thesis", satsym.simulate),
    ],
)
def test_other_objects_are_those_of_the_command_line(
    command: str, subject: str, asked: Callable[[str], Any], capsys: pytest.CaptureFixture[str]
) -> None:
    found = asked(subject)
    assert json.loads(found.to_json()) == printed(capsys, command, subject)
    assert main([command, subject]) == 0
    assert capsys.readouterr().out.strip() == repr(found).strip()


@pytest.mark.slow
def test_an_audit_is_that_of_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    found = satsym.audit("its_thesis", items=["4.27"])
    assert found.to_dict() == printed(capsys, "audit", "its_thesis", "--item", "4.27")
    assert found.html("id").startswith('<!doctype html>\n<html lang="id">')
    assert found.latex("id").startswith("% Written by satsym audit.")
    assert len(found) == sum(found.counts.values()) > 0
    with pytest.raises(BadInput, match="no row"):
        satsym.audit("its_thesis", items=["77.7"])


@pytest.mark.slow
def test_a_problem_in_memory_is_the_one_that_is_generated_into_files(tmp_path: Path) -> None:
    satsym.derive(PUSH).save(tmp_path)
    (tmp_path / "sled.toml").write_text(TOML)
    there, here = satsym.load(tmp_path / "sled.toml"), pushed()
    assert (tmp_path / "sled.py").read_text() == here.case.model.text
    ours, theirs = satsym.solve(here), satsym.solve(there)
    assert without_time(ours.to_dict()) == without_time(theirs.to_dict()) | {"instance_file": None}
    assert ours.status.answered
    assert np.array_equal(ours.x, theirs.x)


def test_a_problem_is_derived_once_and_anew_when_it_changes() -> None:
    from dataclasses import replace

    rates = dict(SLED.rates)
    moving = replace(PUSH, model=replace(SLED, rates=rates))
    first = satsym.derive(moving)
    assert satsym.derive(replace(moving)) is first
    rates[v] = a
    assert satsym.derive(moving)["first_order.v"].rhs == a
    assert first["first_order.v"].rhs != a


def test_a_model_of_ones_own_is_analysed_exactly() -> None:
    from dataclasses import replace

    found = satsym.analyse(replace(SLED, rates={q: v, v: a}))
    assert found["stability"]["verdict"] == "unstable"
    gain = satsym.lqr(replace(SLED, rates={q: v, v: a})).K
    assert gain == pytest.approx(np.array([[1.0, 3.0**0.5]]))


@pytest.mark.parametrize(
    ("changes", "toml"),
    [
        ({"initial": {"q": 0.0}}, "[initial]\nq = 0.0\n[time]\ntf = 1.0"),
        ({"initial": {"q": 0.0, "v": "1 kg"}}, '[initial]\nq = 0.0\nv = "1 kg"\n[time]\ntf = 1.0'),
        ({"initial": {"q": 0.0, "w": 0.0}}, "[initial]\nq = 0.0\nw = 0.0\n[time]\ntf = 1.0"),
        ({"tf": -1.0}, "[initial]\nq = 0.0\nv = 0.0\n[time]\ntf = -1.0"),
        ({"tf": float("nan")}, "[initial]\nq = 0.0\nv = 0.0\n[time]\ntf = nan"),
        ({"control": {"a": [1.0, -1.0]}}, "[initial]\nq = 0.0\nv = 0.0\n[time]\ntf = 1.0\n[control]\na = [1.0, -1.0]"),
        ({"solver": {"steps": 0}}, "[initial]\nq = 0.0\nv = 0.0\n[time]\ntf = 1.0\n[solver]\nsteps = 0"),
        ({"inital": {"q": 1.0}}, "[initial]\nq = 0.0\nv = 0.0\n[inital]\nq = 1.0\n[time]\ntf = 1.0"),
        ({"final": {"q": "reference"}}, '[initial]\nq=0\nv=0\n[final]\nq="reference"\n[time]\ntf = 1.0'),
        ({"guess": {"state": {"q": []}}}, "[initial]\nq=0\nv=0\n[guess.state]\nq=[]\n[time]\ntf = 1.0"),
    ],
)
def test_what_is_refused_in_a_file_is_refused_in_python_by_the_same_line(
    changes: dict[str, Any], toml: str, tmp_path: Path
) -> None:
    satsym.derive(PUSH).save(tmp_path)
    path = tmp_path / "case.toml"
    path.write_text(f'model = "./sled"\n{toml}\n')
    with pytest.raises(BadInput) as theirs:
        instance.load(path)
    with pytest.raises(BadInput) as ours:
        satsym.Instance.of(PUSH, **{"initial": {"q": 0.0, "v": 0.0}, "tf": 1.0, "name": "case"} | changes)
    assert str(ours.value) == "case: " + str(theirs.value).removeprefix(f"{path}: ")


@pytest.mark.parametrize(
    ("refused", "line"),
    [
        (lambda: satsym.solve("soft-retur"), 'soft-retur: there is no instance of this name; did you mean "soft'),
        (lambda: satsym.solve(PUSH), "a Problem is not an instance; make one with Instance.of"),
        (lambda: satsym.Instance.of(3), "nothing can be derived from 3; give a Problem"),
        (
            lambda: satsym.Instance.of("polar_orbi", initial={}, tf=1),
            'model: "polar_orbi" is not a shipped model; did you mean',
        ),
        (lambda: pushed().with_(name="../a"), "is not a valid name of an instance"),
        (lambda: pushed().with_(initial=3), "initial: got 3; give a table"),
        (lambda: satsym.derive("polar"), 'did you mean "polar_orbit"'),
        (lambda: satsym.derive(PUSH)["costates.q"], 'no step "costates"; did you mean "costate_equations"'),
        (lambda: satsym.derive(PUSH)["costate_equations.w"], 'the step has no "w"'),
        (lambda: satsym.derive(PUSH)[1], 'write "step.equation"'),
        (lambda: satsym.derive(PUSH, "least"), '"least" is neither'),
    ],
)
def test_bad_input_is_one_line_that_says_what_to_do(refused: Callable[[], Any], line: str) -> None:
    with pytest.raises(BadInput) as found:
        refused()
    assert line in str(found.value)
    assert "\n" not in str(found.value)
    assert len(found.traceback) <= 4  # this test, what it calls, and where that ends


def test_a_name_that_no_module_can_have_is_refused_before_anything_is_solved() -> None:
    from dataclasses import replace

    with pytest.raises(BadInput, match="the name of a model must be a lower-case letter"):
        satsym.Instance.of(replace(PUSH, name="Sled"), initial={"q": 0, "v": 0}, tf=1)
