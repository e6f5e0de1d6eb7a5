"""Where an extremal is integrated again from values of its solution, as one flow from the start would lose its digits.

What is left between what was reached and where it begins anew is a check of its own: an extremal has no gaps.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.certificate.switching.stated_arcs import Stated
from satsym.solvers.switching.stops import stops
from satsym.solvers.switching.structure import SINGULAR, Course, Guess, Structure


def restarts(solution: Solution, stated: Stated) -> list[tuple[float, Array]]:
    """Times of nodes and values (2n,) there: within arcs whose flow grows, and where singular ones of these end.

    Parameters
    ----------
    stated
        Arcs of each control.
    """
    times, z = solution.times, np.concatenate([solution.x, solution.lam])
    structure = Structure(tuple(tuple(level for *_, level in row) for row in stated))
    switches, end = np.array([end for row in stated for _, end, _ in row[:-1]]), float(times[-1])
    course = Course(times, z)
    inside = stops(
        solution.instance,
        Guess(structure, switches, solution.lam[:, 0], end),
        course,
        np.concatenate(typical(solution)),
    )[1]
    ends = {
        until
        for row in stated
        for start, until, level in row
        if level >= SINGULAR and until < end and any(start < time < until for time in inside)
    }
    near = {int(np.abs(times - time).argmin()) for time in (*inside, *ends)}
    return [(float(times[k]), z[:, k]) for k in sorted(near)]
