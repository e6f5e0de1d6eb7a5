"""Damaged results: `satsym plot` draws them or says in a line why not, whatever they hold.

`python tests/bench/fuzz_results.py` damages 200, each by a seed of its own; `fuzz_results.py 20 1000` twenty from the
thousandth on.
"""

from __future__ import annotations

import os
import random
import shutil
import sys
import tempfile
from collections import Counter
from dataclasses import replace
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import msgspec

from satsym import instance
from satsym.cli.saving import trajectory_files
from satsym.report.results import sets
from satsym.report.results.objects import solution_object
from satsym.solvers import solve
from tests.support.damage import damaged
from tests.support.fuzzing import faults, ran

NAME = "return-to-orbit-006"
CASES = 200
ALLOWED = (0, 3)


def made(folder: Path) -> Path:
    """A sound result, of few steps."""
    case = instance.load(NAME)
    found = solve(replace(case, solver=msgspec.structs.replace(case.solver, steps=40)))
    sets.write(folder, solution_object(found), trajectory_files(folder, found, look=None))
    return folder


def tried(sound: Path, seed: int, work: Path) -> tuple[str, int, list[str]]:
    """Kind of damage, exit code and faults of one case."""
    folder = work / f"case-{seed}"
    shutil.copytree(sound, folder)
    try:
        kind = damaged(random.Random(seed), folder)
        found = ran(["plot", NAME, "--from", str(folder), "--out", str(work / "pictures"), "--json"])
        return kind, found.code, list(faults(found, ALLOWED))
    finally:
        shutil.rmtree(folder)


def main(count: int = CASES, first: int = 0) -> int:
    """Try them, and print what came of them."""
    codes: Counter[tuple[str, int]] = Counter()
    wrong = 0
    with tempfile.TemporaryDirectory() as work:
        sound = made(Path(work) / "sound")
        for seed in range(first, first + count):
            kind, code, found = tried(sound, seed, Path(work))
            codes[kind, code] += 1
            wrong += bool(found)
            for fault in found:
                print(f"{seed} {kind}: {fault}", flush=True)
    for (kind, code), number in sorted(codes.items()):
        print(f"{kind:32} exit {code}  {number}")
    print(f"{count} damaged results, {wrong} with faults")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
