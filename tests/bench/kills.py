"""Kills at random moments of a run that replaces a result: what is found afterwards is the old one or the new one.

`python tests/bench/kills.py` kills 100 times, `kills.py 10 7` ten times by another seed; SIGKILL and SIGTERM in turn.
Half of the kills come at any time of the run, half while it writes.
"""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from satsym.report.results import sets
from satsym.report.results.set_list import LIST
from satsym.status import BadInput

KILLS = 100
OLD = ("simulate", "soft-return")
NEW = ("solve", "soft-return")
NEXT = ("simulate", "soft-return")
NOTES = "notes.txt"
"""A file of the user's in the same folder."""
PATIENCE = 120.0


def started(command: tuple[str, ...], folder: Path) -> subprocess.Popen[bytes]:
    """A run of satsym that writes into a folder."""
    return subprocess.Popen(
        [sys.executable, "-m", "satsym", *command, "--out", str(folder)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        cwd=Path(__file__).resolve().parents[2],
    )


def finished(command: tuple[str, ...], folder: Path) -> None:
    """A run to its end, which must be a good one."""
    _, said = (run := started(command, folder)).communicate(timeout=PATIENCE)
    if run.returncode:
        raise RuntimeError(f"{' '.join(command)}: exit {run.returncode}: {said.decode()}")


def killed(
    command: tuple[str, ...], sound: Path, folder: Path, rng: random.Random, sign: signal.Signals, length: float
) -> Iterator[str]:
    """Replace a sound old set, kill that, and look: first what was found, then what is wrong."""
    shutil.copytree(sound, folder)
    run, writing = started(command, folder), rng.random() < 0.5
    moment = time.monotonic() + rng.uniform(0.0, length)
    while run.poll() is None and (not _writes(folder) if writing else time.monotonic() < moment):
        time.sleep(0.0005)
    if writing:
        time.sleep(rng.choice([0.0, rng.uniform(0.0, 0.1)]))
    run.send_signal(sign)
    _, said = run.communicate(timeout=PATIENCE)
    try:
        found = sets.read(folder)
        yield f"{sign.name}, {'writing' if writing else 'any time'}: {found.command}"
        expected = {"simulate": names(sound) - {LIST, NOTES}, "solve": NEW_NAMES}[found.command]
        if found.listed.keys() != expected:
            yield f"lists {sorted(found.listed)}"
    except (BadInput, KeyError) as error:
        yield "neither"
        yield f"neither the old set nor the new one: {error}"
    if sign is signal.SIGTERM and run.returncode not in (0, 143, -signal.SIGTERM):
        yield f"exit {run.returncode}"
    if b"Traceback" in said:
        yield f"a traceback: {said.decode()[-300:]}"


def followed(folder: Path) -> Iterator[str]:
    """Run something else, to the end, and say what is left that should not be."""
    finished(NEXT, folder)
    if names(folder) != {*sets.read(folder).listed, LIST, NOTES}:
        yield f"left over: {sorted(names(folder) - {*sets.read(folder).listed, LIST, NOTES})}"
    if names(folder) != {"instance.toml", "trajectory.npz", "trajectory.csv", LIST, NOTES}:
        yield f"after the next run: {sorted(names(folder))}"


def names(folder: Path) -> set[str]:
    """Of all files in a folder, hidden ones, too."""
    return {path.name for path in folder.iterdir()}


def _writes(folder: Path) -> bool:
    """Whether a run has begun to write."""
    return any(name.startswith(".satsym") for name in names(folder))


NEW_NAMES: set[str] = set()


def main(count: int = KILLS, seed: int = 1, *, draw: bool = True) -> int:
    """Kill so many times, with all pictures or none, and print what was found."""
    old, new = ((*command, *["--plot"] * draw) for command in (OLD, NEW))
    rng, outcomes, wrong = random.Random(seed), Counter[str](), 0
    with tempfile.TemporaryDirectory() as work:
        sound, fresh = Path(work) / "sound", Path(work) / "fresh"
        finished(old, sound)
        (sound / NOTES).write_text("mine", encoding="utf-8")
        began = time.monotonic()
        finished(new, fresh)
        length = 1.1 * (time.monotonic() - began)
        NEW_NAMES.update(json.loads((fresh / LIST).read_text(encoding="utf-8"))["files"])
        for number in range(count):
            folder = Path(work) / f"kill-{number}"
            outcome, *faults = killed(new, sound, folder, rng, (signal.SIGKILL, signal.SIGTERM)[number % 2], length)
            faults += followed(folder)
            outcomes[outcome] += 1
            wrong += bool(faults)
            for fault in faults:
                print(f"{number}: {fault}", flush=True)
            shutil.rmtree(folder)
    for outcome, number in sorted(outcomes.items()):
        print(f"{outcome:32} {number}")
    print(f"{count} kills, {wrong} with faults")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
