"""Deriving ends in time, whatever algebra does, and says where it was."""

from __future__ import annotations

import re
import signal
import threading
import time
from contextlib import suppress
from pathlib import Path

import pytest

from satsym.cli import main
from satsym.symbolic import time_limit
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.time_limit import SIGNAL_INTERVAL, entering, within

SLOW = """
import sympy as sp
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = tuple(Variable(f"x{i}", f"x_{i}") for i in range(6))
CONTROLS = tuple(Variable(f"u{i}", f"u_{i}") for i in range(3))
x, u = symbols_of(STATES), symbols_of(CONTROLS)
size = (1 + sum(a**2 for a in x)) ** sp.Rational(3, 2)
rates = {
    x[i]: sp.sin(sum(x) * x[i] ** 2 + sp.exp(x[i] * sp.cos(x[(i + 1) % 6]))) ** 3 / size
    + (u[i] if i < 3 else x[i - 1]) * sp.tanh(x[0] * x[5] + sum(x))
    for i in range(6)
}
motion = FirstOrder(name="tangle", title="", states=STATES, controls=CONTROLS, parameters=(), rates=rates)
PROBLEMS = (Problem(name="tangled", title="", model=motion, running_cost=sum(a**2 for a in u)),)
"""


@pytest.mark.parametrize(
    ("text", "named"),
    [
        (SLOW, "tangled: the derivation exceeded 0.5 s in the step [a-z ]+;"),
        ("while True: pass", "reading the file"),
    ],
)
def test_the_command_line_names_the_model_and_the_step(
    text: str, named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, out = tmp_path / "mine.py", tmp_path / "out"
    file.write_text(text, encoding="utf-8")
    began = time.monotonic()
    assert main(["derive", str(file), "--out", str(out), "--max-seconds", "0.5"]) == 3
    assert time.monotonic() - began < 20.0
    (line,) = capsys.readouterr().err.splitlines()
    assert re.search(named, line)
    assert "--max-seconds" in line
    assert not out.exists() or not list(out.iterdir())


def test_what_swallows_errors_ends_as_well() -> None:
    def stubborn() -> None:
        with within(0.1, "mine"):
            entering("model", "of patience")
            while True:
                with suppress(Exception):
                    time.sleep(0.01)

    with pytest.raises(DerivationError, match=r"^model: the derivation exceeded 0.1 s in the step of patience;"):
        stubborn()


def test_nothing_is_left_of_a_limit_that_was_kept() -> None:
    with within(0.2, "mine"):
        entering("model", "first")
        assert signal.getitimer(signal.ITIMER_REAL)[0] > 0.0
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
    assert signal.getsignal(signal.SIGALRM) is signal.SIG_DFL
    time.sleep(0.3)
    entering("model", "second")  # raises what ends a derivation if the deadline still counts


def test_a_signal_that_comes_while_the_timer_is_stopped_leaves_no_timer_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    def late() -> None:
        monkeypatch.undo()
        signal.raise_signal(signal.SIGALRM)

    monkeypatch.setattr(time_limit, "_disarm", late)
    with pytest.raises(DerivationError), within(0.05, "mine"):
        time.sleep(5.0)
    time.sleep(2.0 * SIGNAL_INTERVAL)
    assert signal.getsignal(signal.SIGALRM) is signal.SIG_DFL
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


def test_a_thread_looks_at_the_time_between_steps() -> None:
    said: list[str] = []

    def derive() -> None:
        try:
            with within(0.05, "mine"):
                time.sleep(0.1)
                entering("model", "next")
        except DerivationError as error:
            said.append(str(error))

    one = threading.Thread(target=derive)
    one.start()
    one.join()
    assert said
    assert said[0].startswith("model: the derivation exceeded 0.05 s in the step next;")
