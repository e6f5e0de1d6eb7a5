"""The first arrival of linear motions under saturated controls, one motion after the other: text that is compiled.

As :mod:`satsym.solvers.switching.linear.by_reach` has it: as long as a plane tells the given end from all that is
reached nothing arrives, and there another plane is looked for (Neustadt; Eaton). Newton's method makes switching times
and costates exact; an arrival counts if its own plane shows that nothing arrives between the known bound and it.
Motions are stated as in :mod:`satsym.solvers.batch.switching.planes`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.solvers.batch.switching.arcs import exact
from satsym.solvers.batch.switching.planes import THERE, at, nearest, passed, powers_of, put

Array = NDArray[np.float64]
Places = NDArray[np.int64]

FEWEST, SHOWN, MOST_STEPS = 16, 64, 4096
"""Steps in which a duration shows at least, as planned, and at most."""

SHORT_STEP = 0.125
"""Largest product of a step and the motion's rates."""

ROUNDS = 40
"""Planes at most."""

SWITCHES = 24
"""Switches of all controls at most."""

TIGHT, PRECISE = 0.1, 1e-3
"""Shares of its distance by which a plane may be nearer than the set."""

BACK = 4
"""Steps back at which costates of an arrival are looked for: where the end is reached no plane tells them."""

BEFORE = 1e-3
"""Share of a duration before it, in which it is not looked whether anything arrives."""


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
    """The first arrival; costates at the end, which begin as a guess, and at the start are put in place, as are times.

    Costates are those of a cost of one for each unit of time.

    Returns
    -------
    tuple
        How many switches, -1 where nothing is found, or not beyond doubt; and the duration.
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
    """First arrivals of many motions, each from its neighbour's costates, or else from its own guess.

    Parameters
    ----------
    rates, x, end, boxes, scales
        Shapes (M, n, n + m + 1), (M, n), (M, n), (M, 2, m) and (M,).
    costates
        Guesses at the end, shape (M, n); in their place those that are found.
    begins, counts, durations, times, controls
        What is found: costates at the start, shape (M, n); shapes (M,), (M,), (M, SWITCHES), (M, SWITCHES).
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
