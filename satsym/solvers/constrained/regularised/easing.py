"""Regularised paths from starts that violate constraints by much: these are eased first, and tightened step by step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.solvers.constrained.regularised.interior_point import Path, regularised
from satsym.solvers.constrained.regularised.transcription import Point, Program
from satsym.solvers.iteration import Limits

TRIES, SMALLEST = 12, 1e-2
"""Paths that are tried at most, and the least share of a violation by which constraints are tightened at once."""


def tightened(program: Program, start: Point, worth: float, limits: Limits) -> Path:
    """A path from a start at which constraints are violated, eased by that to begin with.

    Each path begins where the last one is; where it is not found, constraints are tightened by half as much.
    """
    over = np.maximum(program.constraints(start).max(axis=1, keepdims=True), 0.0)
    path = regularised(replace(program, eased=over), start, worth, limits)
    share, wanted = 1.0, 0.0
    for _ in range(TRIES):
        if not path.solved or share == 0.0 or share - wanted < SMALLEST or limits.expired:
            break
        found = regularised(replace(program, eased=wanted * over), path.at, worth, limits)
        if found.solved:
            path, share, wanted = found, wanted, 0.0
        else:
            wanted = (share + wanted) / 2
    return path if share == 0.0 else replace(path, solved=False)
