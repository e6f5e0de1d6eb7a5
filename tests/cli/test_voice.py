"""How much a command says: nothing but what goes wrong, or every step of it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from satsym.cli import output
from tests.cli.test_cli import Run, run

__all__ = ["run"]

SOLVE = ("solve", "double-integrator-energy")


@pytest.mark.parametrize("command", [SOLVE, ("analyse", "double-integrator-energy"), ("models",)], ids=" ".join)
def test_who_wants_no_words_has_none(run: Run, command: tuple[str, ...]) -> None:
    assert run(*command, "--quiet") == (0, "", "")
    assert run(*command)[1] != ""


def test_what_is_wrong_is_said_in_any_case_and_json_and_files_come(run: Run, tmp_path: Path) -> None:
    code, out, err = run("solve", "nothing-like-it", "-q")
    assert (code, out, err.count("\n")) == (3, "", 1)
    code, out, err = run(*SOLVE, "-q", "--json", "--out", "there")
    assert (code, err, json.loads(out)["status"]) == (0, "", "converged")
    assert (tmp_path / "there" / "result.json").exists()


def test_who_wants_every_word_has_each_on_a_line_also_in_a_pipe(run: Run) -> None:
    _, out, err = run(*SOLVE, "--verbose")
    assert out
    assert any(line.startswith("iteration ") for line in err.splitlines())
    assert "\r" not in err
    assert run(*SOLVE)[2] == ""


def test_long_work_has_a_line_now_and_then_where_no_line_can_change(monkeypatch: pytest.MonkeyPatch) -> None:
    written: list[str] = []
    clock = [0.0]
    monkeypatch.setattr(output, "_write", lambda _stream, text: written.append(text))
    monkeypatch.setattr(output, "_is_terminal", lambda _stream: False)
    monkeypatch.setattr(output.time, "monotonic", lambda: clock[0])
    with output.live() as line:
        for row in range(1, 1001):  # a row a second: a line each minute, for tenths take longer
            clock[0] += 1.0
            line.report(f"{row} rows", row / 1000)
    assert 10 <= len(written) <= 1000 / 50
    assert written[0] == "60 rows\n"
    written.clear()
    with output.live() as line:
        for row in range(1, 1001):  # ten times as quick: a line each tenth
            clock[0] += 0.1
            line.report(f"{row} rows", row / 1000)
    assert [int(text.split()[0]) for text in written] == list(range(100, 1001, 100))
    written.clear()
    with output.live() as line:
        for row in range(1, 1001):  # over in a second
            clock[0] += 1e-3
            line.report(f"{row} rows", row / 1000)
    assert written == []
