"""What bounds RK4 on arrays: its calls, one by one, and what they cost where there is next to nothing to do.

As it is generated, a step of the polar orbit is 86 calls of NumPy. Here it is 50: slopes are in half steps and
quotients in multiples that spare products, the last stage is added in place by BLAS, and all sums of the end are one
product of matrices, which takes as long as five calls and replaces 24. What is left are the products and quotients of
the rates themselves; blocks of other sizes gain nothing: on fewer columns what calls cost besides counts more, on more
columns the cache holds less.
"""

from __future__ import annotations

from collections.abc import Callable
from time import process_time
from typing import Any

import numpy as np
from rows import Row, Table

COLUMNS, FEW = 4096, 8
LASTING = 0.002
"""Seconds for which each call is repeated."""
HALF = 0.005
"""Of a step."""


def numpy_calls(rounds: int = 9) -> Table:
    """A step for many motions of the polar orbit, the sum of its calls, and of the same calls on a few columns."""
    from satsym.kernels import load
    from satsym.kernels.batch.runge_kutta import OnTape

    kernels, sums = load("polar_orbit"), {}
    tape, calls = OnTape(kernels), 0
    with np.errstate(all="ignore"):
        for columns in (COLUMNS, FEW):
            arranged = tape.arranged(columns)
            for row in (*arranged.given.values(), *arranged.states(0)):
                row[...] = 1.0
            arranged.begin(tape.step.ends(HALF), HALF)
            each = arranged.turns[0].each
            calls = len(each)
            sums[columns] = np.sum([_lasting(*call, rounds) for call in each], axis=0)
        counts = tuple(len(names) for names in (kernels.spec.states, kernels.spec.controls, kernels.spec.parameters))
        y, u, p = (np.ones((count, COLUMNS)) for count in counts)
        steps = 50
        whole = [_once(lambda: tape.advance(0.0, 2.0 * HALF, steps, y.copy(), u, p)) / steps for _ in range(rounds)]
    unit = 1e9 / COLUMNS
    found = {
        "a step, with what it takes to begin and end": whole,
        f"its {calls} calls, each by itself": sums[COLUMNS],
        f"the same on {FEW} columns: what calls cost besides": sums[FEW],
    }
    made_rows = tuple(Row(k, min(v) * unit, float(np.median(v)) * unit, min(v) / min(whole)) for k, v in found.items())
    title = f"12. What bounds RK4 on arrays: {COLUMNS} motions of the polar orbit"
    return Table(title, "nanoseconds a step of one", made_rows)


def _lasting(function: Callable[..., object], arguments: tuple[Any, ...], rounds: int) -> list[float]:
    """Seconds a call, in each round."""
    repeats = max(1, int(LASTING / max(_once(lambda: function(*arguments)), 1e-7)))

    def many() -> None:
        for _ in range(repeats):
            function(*arguments)

    return [_once(many) / repeats for _ in range(rounds)]


def _once(action: Callable[[], object]) -> float:
    began = process_time()
    action()
    return process_time() - began
