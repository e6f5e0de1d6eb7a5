"""Subject 3: what somebody at a terminal waits for."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from rows import Goal, Row, Table, missing
from timing import Action, interleaved

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Command:
    """Arguments, and how many seconds it may take (None: no goal)."""

    arguments: tuple[str, ...]
    allowed: float | None


@dataclass(frozen=True)
class Trial:
    """Why a command fails, or nothing, and the seconds of processor time it took."""

    failure: str
    processor: float


def commands(rounds: int = 3, long: bool = True) -> Table:
    """Wall time of the command line, interpreter and all; with or without what takes many seconds."""
    satsym = Path(sysconfig.get_path("scripts")) / "satsym"
    title = "3. The command line, wall time; the fastest run counts, for other programs can only add to it"
    if not satsym.exists():
        return Table(title, "seconds", (missing("satsym", "not installed in this environment"),))
    with tempfile.TemporaryDirectory() as folder:
        listed = {
            "satsym --help": Command((str(satsym), "--help"), 0.2),
            "satsym solve its-thesis": Command((str(satsym), "solve", "its-thesis"), 0.6),
            "satsym solve soft-return": Command((str(satsym), "solve", "soft-return"), None),
            "satsym derive --out FOLDER": Command((str(satsym), "derive", "--out", folder), 10.0),
            "python -c pass (for comparison)": Command((sys.executable, "-c", "pass"), None),
        }
        if not long:
            listed = {name: command for name, command in listed.items() if "derive" not in name}
        tried = {name: _tried(command.arguments) for name, command in listed.items()}
        actions = {name: _action(command.arguments) for name, command in listed.items() if not tried[name].failure}
        samples = interleaved(actions, rounds, least=0.0, clock=perf_counter)
    rows = []
    for name, command in listed.items():
        if name not in samples:
            rows.append(missing(name, tried[name].failure))
            continue
        least, allowed = samples[name].least, command.allowed
        goals = () if allowed is None else (Goal(f"at most {allowed:g} s", least, allowed),)
        note = f"{tried[name].processor:.2f} s of processor time"
        rows.append(Row(name, least, samples[name].middle, goals=goals, note=note))
    return Table(title, "seconds", tuple(rows))


def _run(arguments: Sequence[str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(arguments, cwd=ROOT, capture_output=True, text=True)


def _action(arguments: Sequence[str]) -> Action:
    return lambda: _run(arguments)


def _tried(arguments: Sequence[str]) -> Trial:
    before = os.times()
    done = _run(arguments)
    after = os.times()
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    said = (done.stderr or done.stdout).strip().splitlines()
    return Trial(f"exit {done.returncode}, {said[-1] if said else 'nothing said'}" if done.returncode else "", spent)
