"""A body on a line, from 1,000 random starts to rest in the least time: exact switching times against the closed form.

`python tests/bench/switching.py` solves them all; with a number, so many; with `certify` as well, certifies them.
"""

from __future__ import annotations

import os
import sys
import time
from dataclasses import replace
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import numpy as np
from machine import described
from switching_closed_forms import minimum_time

from satsym import instance
from satsym.solvers.by_search import bang_bang
from satsym.solvers.certificate import certify


def main(count: int, certified: bool) -> None:
    """Solve so many and print how far off the worst is, and how long one takes."""
    base = instance.load("double-integrator-time")
    starts = np.random.default_rng(7).uniform(-5.0, 5.0, (1000, 2))[:count]
    seconds, worst, unsolved, uncertified = [], np.zeros(2), 0, 0
    for q, v in starts.tolist():
        begun = time.process_time()
        found = bang_bang(replace(base, initial=(q, v)))
        seconds.append(time.process_time() - begun)
        known = minimum_time(q, v)
        if not found.status.answered or len(found.switching_times[0]) != 1:
            unsolved += 1
            continue
        off = (found.objective - known.cost, found.switching_times[0][0] - known.switches[0])
        worst = np.maximum(worst, np.abs(off))
        if certified:
            verdict = certify(found)
            uncertified += verdict is None or verdict.verdict != "certified"
    print(described())
    print(f"{count} starts, {unsolved} not solved, {uncertified if certified else '-'} not certified")
    print(f"largest error: final time {worst[0]:.1e}, switching time {worst[1]:.1e}")
    print(f"processor time each: median {np.median(seconds) * 1e3:.1f} ms, longest {max(seconds) * 1e3:.0f} ms")


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:] if word.isdigit()]
    main(numbers[0] if numbers else 1000, "certify" in sys.argv[1:])
