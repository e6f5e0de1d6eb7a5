"""Instance files that went wrong: every command does its work with them, or says in a line why not.

`python tests/bench/fuzz_instances.py` tries 2,000, each by a seed of its own; `fuzz_instances.py 40 5000` forty from
the five thousandth on.
"""

from __future__ import annotations

import os
import random
import sys
import tempfile
from collections import Counter
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.support.fuzzing import faults, ran
from tests.support.mutations import mutated

CASES = 2000
COMMANDS = ("solve", "solve", "solve", "simulate", "simulate", "analyse", "lqr")
ALLOWED = (0, 3, 4, 5)
LONG = 20.0
"""Seconds that are told of."""


def tried(seed: int, work: Path) -> tuple[str, int, float, list[str]]:
    """Kind of case, exit code, seconds and faults."""
    folder, rng = work / f"case-{seed}", random.Random(seed)
    folder.mkdir()
    path, kind = mutated(rng, folder)
    command = rng.choice(COMMANDS)
    found = ran([command, str(path), *rng.choice([["--json"], []])])
    return f"{command} {kind}", found.code, found.seconds, list(faults(found, ALLOWED))


def main(count: int = CASES, first: int = 0) -> int:
    """Try them, and print what came of them."""
    codes: Counter[int] = Counter()
    wrong, longest = 0, 0.0
    with tempfile.TemporaryDirectory() as work:
        for seed in range(first, first + count):
            kind, code, seconds, found = tried(seed, Path(work))
            codes[code] += 1
            wrong += bool(found)
            longest = max(longest, seconds)
            if seconds > LONG:
                print(f"{seed} {kind}: {seconds:.0f} s", flush=True)
            for fault in found:
                print(f"{seed} {kind}: {fault}", flush=True)
    print("; ".join(f"exit {code}: {number}" for code, number in sorted(codes.items())))
    print(f"{count} instances, {wrong} with faults, the longest {longest:.1f} s")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
