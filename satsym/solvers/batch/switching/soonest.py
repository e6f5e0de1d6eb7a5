"""Minimum arrival times of linear motions under saturated controls, one after the other; this source is compiled.

The method is that of :mod:`satsym.solvers.switching.linear.by_reach`: as long as a plane separates the final state from
the reachable set, it is not reached, and at the end of this time another plane is searched (Neustadt; Eaton). Newton's
method makes switching times and costates exact. An arrival is accepted if its own plane shows that there is no earlier
arrival after the known lower bound. Motions are given as in :mod:`satsym.solvers.batch.switching.planes`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.solvers.batch.switching.arcs import exact
from satsym.solvers.batch.switching.planes import THERE, at, nearest, passed, powers_of, put

Array = NDArray[np.float64]
Places = NDArray[np.int64]

FEWEST, SHOWN, MOST_STEPS = 16, 64, 4096
"""Smallest, intended and largest number of steps into which a duration is divided."""

SHORT_STEP = 0.125
"""Largest product of a step and the motion's rates (norm of A)."""

ROUNDS = 40
"""Largest number of planes that are tried."""

SWITCHES = 24
"""Largest number of switching times of all controls."""

TIGHT, PRECISE = 0.1, 1e-3
"""Relative tolerances of the distance of a plane from the set: usual, and for the planes of an arrival."""

BACK = 4
"""Number of steps backwards in which costates of an arrival are searched, since no plane exists at the arrival
itself."""

BEFORE = 1e-3
"""Fraction of a duration before an arrival in which no earlier arrival is excluded."""


def first_arrival(
    costate: Array,
    begin: Array,
    scale: float,
    rates: Array,
    x: Array,
    end: Array,
    box: Array,
    times: Array,
    controls: Places,
) -> tuple[int, float]:
    """Compute the minimum arrival time from a guess of the final costates.

    The final costates, the initial costates and the switching times are written in place. Costates belong to a cost of
    one per unit of time.

    Returns
    -------
    tuple
        Number of switching times, -1 if no arrival is found with certainty; and the duration.
    """
    n, since, fastest = len(x), 0.0, 0.0
    for i in range(n):
        row = 0.0
        for j in range(n):
            row += abs(rates[i, j])
        fastest = max(fastest, row)
    length = min(scale / SHOWN, SHORT_STEP / max(fastest, 1e-300))
    powers = powers_of(rates, length, 3 * SHOWN)
    plane, trial = np.zeros(n), np.zeros(n)
    put(plane, costate)
    for _ in range(ROUNDS):
        later = passed(plane, rates, powers, length, x, end, box, since)
        if later < 0.0:
            coarse = 4.0 * length * fastest <= SHORT_STEP
            if not coarse and len(powers) > MOST_STEPS:
                return -1, since
            length *= 4.0 if coarse else 1.0
            powers = powers_of(rates, length, 3 * SHOWN if coarse else 4 * (len(powers) - 1))
            continue
        if 0.0 < later < FEWEST * length:
            length = later / SHOWN
            powers = powers_of(rates, length, 3 * SHOWN)
            continue
        since = max(since, later)
        steps = max(SHOWN, int(np.ceil(since * fastest / SHORT_STEP)))
        if not since > 0.0 or steps > MOST_STEPS:
            return -1, since
        length = since / steps
        powers = powers_of(rates, length, 2 * steps)
        for back in range(BACK):
            if back and nearest(powers, steps - back, x, end, box, PRECISE, plane) <= 0.0:
                break
            put(trial, plane)
            count, duration = exact(trial, since, rates, powers, length, x, end, box, times, controls)
            if count >= 0 and duration >= since * (1.0 - BEFORE):
                bound = passed(trial, rates, powers, length, x, end, box, since)
                if bound < 0.0 or bound >= duration * (1.0 - BEFORE):
                    put(costate, trial)
                    whole = at(rates, powers, length, duration)
                    for i in range(n):
                        begin[i] = 0.0
                        for j in range(n):
                            begin[i] += trial[j] * whole[j, i]
                    return count, duration
            if not back and nearest(powers, steps, x, end, box, TIGHT, plane) > THERE:
                break
        else:
            return -1, since
    return -1, since


def many(
    rates: Array,
    x: Array,
    end: Array,
    boxes: Array,
    scales: Array,
    costates: Array,
    begins: Array,
    counts: Places,
    durations: Array,
    times: Array,
    controls: Places,
) -> None:
    """Compute the minimum arrival times of many motions, each from the costates of its neighbour or its own guess.

    Parameters
    ----------
    rates, x, end, boxes, scales
        Shapes (M, n, n + m + 1), (M, n), (M, n), (M, 2, m) and (M,).
    costates
        Guesses of the final costates, shape (M, n); replaced by the computed ones.
    begins, counts, durations, times, controls
        Results: initial costates, shape (M, n); numbers of switching times, durations, switching times and indices of
        the switched controls, shapes (M,), (M,), (M, SWITCHES), (M, SWITCHES).
    """
    known, guess = -1, np.zeros(x.shape[1])
    for k in range(len(x)):
        put(guess, costates[k])
        counts[k] = -1
        for near in range(1, -1, -1):
            if counts[k] < 0 and (known >= 0 or not near):
                put(costates[k], costates[known] if near else guess)
                counts[k], durations[k] = first_arrival(
                    costates[k],
                    begins[k],
                    durations[known] if near else scales[k],
                    rates[k],
                    x[k],
                    end[k],
                    boxes[k],
                    times[k],
                    controls[k],
                )
        if counts[k] >= 0:
            known = k
