"""Instances that are refused: one line that names the key, whatever the file holds."""

from __future__ import annotations

import dataclasses
import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satsym import instance, kernels
from satsym.spec import ProblemSpec
from satsym.status import BadInput
from tests.support.examples import examples

GOOD = {
    "model": '"polar_orbit"',
    "initial.r": "1.1",
    "initial.r_dot": "0.0",
    "initial.theta": "0.0",
    "initial.theta_dot": "0.9",
    "time.tf": "6.0",
}


def refusal(path: Path | str) -> str:
    """The one line that an instance is refused with."""
    with pytest.raises(BadInput) as error:
        instance.load(path)
    message = str(error.value)
    assert message.isprintable()
    assert len(message) < 600
    assert not any(word in message for word in ("Traceback", "Error", "<class", "object at", "msgspec", "pint", "$"))
    assert "; " in message, "it says what to do"
    return message


def written(folder: Path, **changes: str | None) -> Path:
    """A good instance with some of its lines changed, added (`time_t0` for `time.t0`) or left out."""
    lines = GOOD | changes
    file = folder / "case.toml"
    file.write_text("\n".join(f"{key} = {value}" for key, value in lines.items() if value is not None), "utf-8")
    return file


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        # tables and keys
        ("speling", "1", ["speling: unknown key"]),
        ("titel", '"x"', ["titel: unknown key", 'did you mean "title"?']),
        ("tf", "1", ["tf: unknown key", "belongs in the table [time]"]),
        ("steps", "1", ["steps: unknown key", "belongs in the table [solver]"]),
        ("solver.tolerence", "1", ["[solver] tolerence: unknown key", 'did you mean "tolerance"?']),
        ("parameters.sigme", "1", ["[parameters] sigme", 'did you mean "sigma"?']),
        ("initial.rdot", "1", ["[initial] rdot", 'did you mean "r_dot"?']),
        ("final.phi", "1", ["[final] phi", "available: r, r_dot, theta, theta_dot"]),
        ("control.u3", "[0, 1]", ["[control] u3", "available: u1, u2"]),
        ("guess.state.rr", "[1]", ["[guess.state] rr", "no such state"]),
        ("guess.states.r", "[1]", ["[guess] states", 'did you mean "state"?']),
        ('"a\\nb\\u001b[31m\\u202e"', "1", ["a\\nb\\x1b[31m\\u202e: unknown key"]),
        (f'"{"k" * 9999}"', "1", ["kkk...kkk", "unknown key"]),
        ("model", None, ["model: missing"]),
        ("initial.r_dot", None, ["[initial] r_dot: missing", "km/s"]),
        ("time.tf", None, ["time: missing", "[time]"]),
        ("solver", "[]", ["solver: got a list of 0", "[solver]"]),
        ("guess.state", "1", ["[guess] state: got 1", "[guess.state]"]),
        # types
        ("model", "1", ["model: got 1", "quotes"]),
        ("model", '""', ["model", "not a name"]),
        ("model", '"a\\nb"', ["model", "a\\nb"]),
        ("model", '"polar_orbt"', ["model", "polar_orbt"]),
        ("model", '"../../etc/passwd"', ["model"]),
        ("model", '"' + "m" * 5000 + '"', ["model"]),
        ("title", "1", ["title: got 1"]),
        ("title", '"two\\nlines"', ["title", "two\\nlines"]),
        ("title", '"' + "t" * 201 + '"', ["title", "single short line"]),
        ("initial.r", "true", ["[initial] r: got true", "a number"]),
        ("initial.r", "[1.0]", ["[initial] r: got a list of 1"]),
        ("initial.r", "{a = 1}", ["[initial] r: got a table"]),
        ("initial.r", "1979-05-27", ["[initial] r: got a date"]),
        ("parameters.c1", "false", ["[parameters] c1: got false"]),
        ("solver.steps", "true", ["[solver] steps: got true"]),
        ("solver.steps", "1000.5", ["[solver] steps: got 1000.5", "whole number"]),
        ("solver.tolerance", '"1e-9"', ["[solver] tolerance", "positive number"]),
        ("control.u1", "[0, true]", ["[control] u1"]),
        ("lqr", "{Q = [1, 1, 1, true], R = [1, 1]}", ["[lqr] Q"]),
        # numbers
        ("initial.r", "nan", ["[initial] r", "nan"]),
        ("initial.r", "-inf", ["[initial] r", "-inf"]),
        ("initial.r", "1e400", ["[initial] r", "inf"]),
        ("control.u1", "[-inf, inf]", ["[control] u1", "-inf"]),
        ("guess.costate.r", "[1, [nan]]", ["[guess.costate] r", "nan"]),
        ("solver.tolerance", "nan", ["[solver] tolerance", "nan"]),
        ("initial.r", "1" * 400, ["[initial] r", "too large"]),
        ("initial.r", "1" * 6000, ["[initial] r", "too large"]),
        ("initial.r", "1" + "_1" * 6000, ["[initial] r", "too large"]),
        ("initial.r", "0x" + "f" * 6000, ["[initial] r", "too large"]),
        ("initial.r", "1" * 6000 + ".0", ["[initial] r", "inf"]),
        ("solver.steps", "99999999999999999999999", ["[solver] steps", "more than 64 bits"]),
        # values
        ("initial.r", "0", ["[initial] r: 0", "domain"]),
        ("initial.r", '"-5 km"', ["[initial] r", "-5 km", "domain"]),
        ("initial.theta", '"reference"', ["[initial] theta", "[final] only", "rad"]),
        ("initial.theta", '"5 km"', ["[initial] theta", "5 km", '"rad"']),
        ("initial.theta", '"1 + 1"', ["[initial] theta"]),
        ("initial.theta", "\"__import__('os').system('true')\"", ["[initial] theta"]),
        ("final.r", "-1", ["[final] r", "domain"]),
        ("parameters.sigma", "0", ["[parameters] sigma", "positive"]),
        ("parameters.omega", '"-1 rad/s"', ["[parameters] omega", "positive"]),
        ("time.tf", "0", ["[time] tf: 0 is not after t0 = 0;"]),
        ("time.tf", '"-1 day"', ["[time] tf", "-1 day", "not after"]),
        ("time.tf", '"5 km"', ["[time] tf", "5 km", '"s"']),
        ("time.tf", '"fre"', ["[time] tf", "fre"]),
        ("time.t0", "6.0", ["[time] tf: 6 is not after t0 = 6"]),
        ("time.tf_guess", "3", ["[time] tf_guess", "remove"]),
        ("control.u1", "[1, 0]", ["[control] u1", "lower bound 1", "exceeds", "0"]),
        ("control.u1", '["1 km/s^2", "5 m/s^2"]', ["[control] u1", "1 km/s^2", "5 m/s^2"]),
        ("control.u1", '["1 km", "5 m/s^2"]', ["[control] u1", "1 km", "km/s**2"]),
        ("control.u1", "[0, 1, 2]", ["[control] u1", "[-0.2, 0.2]"]),
        ("control.u1", "1", ["[control] u1", "both bounds"]),
        ("control.max_norm", "1", ["[control] max_norm", "one by one"]),
        ("solver.method", '"magic"', ["[solver] method", "magic", '"bang-bang"']),
        ("solver.backend", '"cuda"', ["[solver] backend", '"numba"']),
        ("solver.tolerance", "0", ["[solver] tolerance: got 0", "positive"]),
        ("solver.tolerance", "-1e-9", ["[solver] tolerance: got -1e-09", "positive"]),
        ("solver.steps", "1", ["[solver] steps: got 1", "from 2"]),
        ("solver.steps", "10000001", ["[solver] steps", "10000000"]),
        ("solver.max_seconds", "0", ["[solver] max_seconds"]),
        ("solver.max_iterations", "0", ["[solver] max_iterations"]),
        ("solver.relaxation", "0", ["[solver] relaxation"]),
        ("solver.relaxation", "1.1", ["[solver] relaxation", "at most 1"]),
        ("solver", '{method = "shooting", relaxation = 0.5}', ["[solver] relaxation", "sweep"]),
        ("solver.free_angles", '["r"]', ["[solver] free_angles", '"r"', "theta"]),
        ("solver.free_angles", '["theta", "theta"]', ["[solver] free_angles", "twice"]),
        ("solver.free_angles", '"theta"', ["[solver] free_angles", "list of names"]),
        ("lqr", "{Q = [1, 1, 1, 1]}", ["[lqr] R: missing"]),
        ("lqr", "{Q = [1, 1, 1], R = [1, 1]}", ["[lqr] Q", "4 numbers"]),
        ("lqr", "{Q = [], R = [1, 1]}", ["[lqr] Q"]),
        ("lqr", "{Q = [1, 1, 1, [1]], R = [1, 1]}", ["[lqr] Q"]),
        ("lqr", "{Q = [1, 1, 1, 1], R = [[1, 0], [0]]}", ["[lqr] R: row 2"]),
        ("lqr", "{Q = [1, 1, 1, 1], R = [[1, 2], [0, 1]]}", ["[lqr] R", "not symmetric", "row 2"]),
        ("lqr", "{Q = [1, 1, 1, 1], R = [1, 1], N = [[1, 0]]}", ["[lqr] N", "each state (4)", "each active input (2)"]),
        ("lqr", "{Q = [1, 1, 1, 1], R = [1, 0]}", ["[lqr] R", "definite"]),
        ("lqr", "{Q = [1, 1, 1, 1], R = [[1, 2], [2, 1]]}", ["[lqr] R", "definite"]),
        ("lqr", '{Q = [1, 1, 1, 1], R = [1], inputs = ["u"]}', ["[lqr] inputs", '"u"', "u1, u2"]),
        ("lqr", '{Q = [1, 1, 1, 1], R = [1, 1], inputs = ["u1", "u1"]}', ["[lqr] inputs", "twice"]),
        ("lqr", "{Q = [1, 1, 1, 1], R = [], inputs = []}", ["[lqr] inputs"]),
        ("lqr", "{Q = [1, 1, 1, 1], R = [1, 1], horizon = 0}", ["[lqr] horizon", "positive"]),
        ("guess.state.r", "[]", ["[guess.state] r", "empty"]),
        ("guess.state.r", "[1, -1]", ["[guess.state] r", "domain"]),
        ("guess.costate.r", '["1 km"]', ["[guess.costate] r", "a number without a unit"]),
        ("guess.control.u1", '["1 km"]', ["[guess.control] u1", "1 km"]),
    ],
)
def test_a_bad_line_is_named(tmp_path: Path, key: str, value: str | None, words: list[str]) -> None:
    message = refusal(written(tmp_path, **{key: value}))
    assert message.startswith(f"{tmp_path}/case.toml: ")
    for word in words:
        assert word in message, message


def test_a_number_in_place_of_a_table_is_named(tmp_path: Path) -> None:
    assert "time: got 5; give a table, [time]" in refusal(written(tmp_path, **{"time.tf": None, "time": "5"}))


def test_a_time_that_is_not_reachable_is_named(tmp_path: Path) -> None:
    times = {"time.tf": "'free'", "time.t0": "-1.7e308", "time.tf_guess": "1.7e308"}
    assert "[time] tf_guess: 1.7e+308 is too far from t0" in refusal(written(tmp_path, **times))


@pytest.mark.parametrize(
    ("changes", "key", "value", "words"),
    [
        ({"control_set": "ball"}, "control.u1", "[0, 1]", ["[control] u1", "max_norm"]),
        ({"control_set": "ball"}, "control.max_norm", "0", ["[control] max_norm", "positive"]),
        ({"control_set": "ball"}, "control.max_norm", "[0, 1]", ["[control] max_norm", "one positive number"]),
        ({"control_set": "free"}, "control.u1", "[0, 1]", ["[control] u1", "free"]),
        ({"control_set": None, "has_cost": False}, "control.u1", "[0, 1]", ["[control] u1", "no cost"]),
        ({"control_set": None, "has_cost": False}, "time.tf", '"free"', ["[time] tf", "no cost"]),
        ({"has_reference": False}, "final.theta", '"reference"', ["[final] theta", "no reference", "rad"]),
    ],
)
def test_what_the_model_cannot_take_is_named(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    changes: dict[str, object],
    key: str,
    value: str,
    words: list[str],
) -> None:
    _change_model(monkeypatch, lambda spec: dataclasses.replace(spec, **changes))
    message = refusal(written(tmp_path, **{key: value}))
    for word in words:
        assert word in message, message


def test_a_parameter_without_a_default_is_required(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def without_default(spec: ProblemSpec) -> ProblemSpec:
        first, *others = spec.parameters
        return dataclasses.replace(spec, parameters=(dataclasses.replace(first, default=None), *others))

    _change_model(monkeypatch, without_default)
    assert "[parameters] sigma: missing" in refusal(written(tmp_path))


def _change_model(monkeypatch: pytest.MonkeyPatch, change: Callable[[ProblemSpec], ProblemSpec]) -> None:
    real = kernels.load
    monkeypatch.setattr(
        kernels, "load", lambda *given: dataclasses.replace(real(*given), spec=change(real(*given).spec))
    )


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", ["model: missing"]),
        (b"model = ", ["not valid TOML"]),
        (b"model = 'a'\nmodel = 'b'", ["not valid TOML"]),
        (b"model = 'a'\n= 1", ["not valid TOML", "line 2"]),
        (b"x = " + b"[" * 5000 + b"]" * 5000, ["nested too deeply"]),
        (b"x = " + b"{a = " * 5000, ["nested too deeply"]),
        (b".".join([b"a"] * 400_000) + b" = 1", ["joined by dots"]),
        (b"[" + b" . ".join([b'"a"'] * 150_000) + b"]", ["joined by dots"]),
        (b"\0" * 100, ["NUL"]),
        (b"\x7fELF\x02\x01\x01\0\0\0", ["NUL"]),
        (b"\x89PNG\r\n\x1a\n\xff", ["UTF-8"]),
        ('model = "é"'.encode("latin-1"), ["UTF-8", "byte 9"]),
        ('model = "a"'.encode("utf-16"), ["UTF-8"]),
        (b"#" * 1_000_001, ["larger than 1000000 bytes"]),
        (b"'\x1b[31m' = 1", ["TOML"]),
        (b"x = 1" + b"1" * 900_000, ["x: the number is too large"]),
    ],
)
def test_a_file_that_is_no_instance_is_refused_quickly(tmp_path: Path, content: bytes, words: list[str]) -> None:
    file = tmp_path / "case.toml"
    file.write_bytes(content)
    start = time.thread_time()
    message = refusal(file)
    assert time.thread_time() - start < 5.0
    for word in words:
        assert word in message, message


def test_a_model_in_place_of_an_instance_is_told_what_to_do(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("PROBLEMS = ()\n")
    assert "mine.py: is a Python file, but a TOML file is needed; derive a model with" in refusal(file)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("its-thesi", ["its-thesi:", "no instance of this name", '"its-thesis']),
        ("zzz", ["no instance of this name", "bryson-denham"]),
        ("nowhere.toml", ["nowhere.toml: no such file"]),
        ("nowhere/case", ["no such file"]),
        ("a\nb\x1b[0m.toml", ["a\\nb\\x1b[0m.toml: no such file"]),
        ("a\0b.toml", ["a\\x00b.toml"]),
        ("", ["directory"]),
        (".", ["directory"]),
        ("x" * 5000, ["xxx...xxx"]),
        ("x" * 5000 + ".toml", ["xxx...xxx"]),
    ],
)
def test_what_is_no_file_is_named(name: str, words: list[str]) -> None:
    message = refusal(name)
    for word in words:
        assert word in message, message


def test_a_directory_and_a_pipe_are_no_instances(tmp_path: Path) -> None:
    assert "is a directory" in refusal(tmp_path)
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.toml")
        assert "not a regular file" in refusal(tmp_path / "pipe.toml")


def test_an_unreadable_file_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = written(tmp_path)

    def denied(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", denied)  # chmod does not stop root
    assert "cannot be read (Permission denied)" in refusal(file)


keys = st.sampled_from(
    [*GOOD, "title", "time.t0", "final.r", "control.u1", "solver.steps", "lqr.Q", "lqr.R", "guess.state.r", "x", '""']
)
values = st.recursive(
    st.sampled_from(["1", "-1", "0.5", "nan", "1e400", "true", '"free"', '"5 km"', '"1 deg"', "1979-05-27", "9" * 400])
    | st.floats().map(repr)
    | st.text(max_size=5).map(lambda text: f'"{text}"'),
    lambda inner: (
        st.lists(inner, max_size=4).map(lambda items: f"[{', '.join(items)}]")
        | inner.map(lambda value: f"{{a = {value}}}")
    ),
    max_leaves=6,
)


@examples(300)
@given(lines=st.lists(st.tuples(keys, values), max_size=4), whole=st.booleans())
def test_any_text_loads_or_is_refused_in_one_line(
    tmp_path_factory: pytest.TempPathFactory, lines: list[tuple[str, str]], whole: bool
) -> None:
    file = tmp_path_factory.mktemp("cases") / "case.toml"
    table = (GOOD if whole else {}) | dict(lines)
    file.write_text("\n".join(f"{key} = {value}" for key, value in table.items()), "utf-8", errors="replace")
    try:
        message = instance.load(file).title
    except BadInput as error:
        message = str(error)
    assert message.isprintable()
