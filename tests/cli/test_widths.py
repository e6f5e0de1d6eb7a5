"""What every command says fits 80 and 60 columns, in both languages, also where a terminal has no more than ASCII."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from satsym.cli.app import program
from tests.cli.test_cli import Run, case, run

__all__ = ["case", "run"]

ANSWERS = (
    *("models", "instances", "models gimballed_wheel", "instances --keys", "doctor"),
    *("solve soft-return", "simulate its-thesis", "simulate lapan-classical", "lqr uny-lqr", "lqr lapan-roll-yaw-lqr"),
    *("analyse molniya", "analyse clohessy_wiltshire", "audit its_paper --item 9"),
    *("compare lapan-classical", "compare lapan-classical --range"),
)
SLOW = (
    *(
        "solve goddard",
        "solve approach-cone",
        "solve inspection",
        "audit its_paper",
        "analyse gyrostat-equilibria",
        "bench polar_orbit --quick",
    ),
    *("compare lapan-classical lapan-minimum-time", "study return-to-orbit --vary initial.r=1.05:1.1:2 --out there"),
    "derive mine/mine.py --out there",
)
COPIED = re.compile(r"\s*(satsym|source) |.*https?://|.*\S{50}")
"""Commands in examples, which are copied, and words that are longer than there is room for, such as paths."""


def too_wide(text: str, columns: int) -> list[str]:
    return [line for line in text.splitlines() if len(line) > columns and not COPIED.match(line)]


@pytest.mark.parametrize(("columns", "language"), [(80, "en"), (60, "id"), (60, "en"), (80, "id")])
def test_help_fits(monkeypatch: pytest.MonkeyPatch, run: Run, columns: int, language: str) -> None:
    """An example is one line as it is copied, and what is said of it stands beside or below it."""
    monkeypatch.setenv("COLUMNS", str(columns))
    for name in ("", *program.commands):
        code, out, _ = run(*filter(None, ("--lang", language, name)), "--help")
        assert code == 0
        assert too_wide(out, columns) == [], name
        wide = [line for line in out.splitlines() if len(line) > columns]
        assert not [line for line in wide if re.search(r"\S  +\S", line)], name


@pytest.mark.parametrize("command", [*ANSWERS, *(pytest.param(each, marks=pytest.mark.slow) for each in SLOW)])
def test_answers_fit(monkeypatch: pytest.MonkeyPatch, run: Run, command: str) -> None:
    if "mine" in command:
        assert run("new", "mine")[0] == 0
    for columns, language in ((60, "id"), (80, "en")):
        monkeypatch.setenv("COLUMNS", str(columns))
        code, out, err = run(
            "--lang", language, *command.split(), *(["--resume"] if command.startswith("study") else [])
        )
        assert code in (0, 3 if "--item" in command else 0), err
        assert too_wide(out, columns) == []


def test_signs_of_ours_are_spelt_where_a_terminal_has_only_ascii(tmp_path: Path) -> None:
    environment = os.environ | {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    shown = subprocess.run(
        [sys.executable, "-m", "satsym", "analyse", "molniya"],
        capture_output=True,
        env=environment,
        cwd=tmp_path,
        check=True,
    ).stdout
    assert shown.isascii()
    assert b"+-sqrt(2 mu/r^3)" in shown
    assert b"\\x" not in shown
