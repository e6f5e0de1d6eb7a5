"""What bounds RK4 on arrays: its calls of NumPy, one by one, and what they cost where there is next to nothing to do.

A step of the polar orbit is 86 calls, which are 94 % of its time, and a quarter of it is what calls cost besides. To be
12 % of C it would have to be 78 of them; with states and slopes as one array each there are 65, but these no longer
stay in the cache, and take a sixth longer (22.8 instead of 19.7 ns). Nor does BLAS help, which sums the four slopes of
a state at once, for 66 calls and 4 such sums: with slopes in rows side by side hardly a call works in place any more,
and all take as long as before (20.2 and 20.3 ns; the 66 alone 17.1). Twice as fast as plain expressions would be 65.
"""

from __future__ import annotations

from collections.abc import Callable
from time import process_time

import numpy as np
from rows import Row, Table

COLUMNS, FEW = 4096, 8
LASTING = 0.002
"""Seconds for which each call is repeated."""


def numpy_calls(rounds: int = 9) -> Table:
    """A step for many motions of the polar orbit, the sum of its calls, and of the same calls on a few columns."""
    from satsym.kernels import load
    from satsym.kernels.blocks import OnTape

    kernels, sums = load("polar_orbit"), {}
    tape = OnTape(kernels)
    counts = tuple(len(names) for names in (kernels.spec.states, kernels.spec.controls, kernels.spec.parameters))
    calls = 0
    with np.errstate(all="ignore"):
        for columns in (COLUMNS, FEW):
            given, made = tape.arranged(columns, *counts)
            for row in given.values():
                row[...] = 1.0
            made.begin()
            calls = len(made.each)
            sums[columns] = np.sum([_lasting(*call, rounds) for call in made.each], axis=0)
        y, u, p = (np.ones((count, COLUMNS)) for count in counts)
        steps = 50
        whole = [_once(lambda: tape.advance(0.0, 0.01, steps, y.copy(), u, p)) / steps for _ in range(rounds)]
    unit = 1e9 / COLUMNS
    found = {
        "a step, with what it takes to begin and end": whole,
        f"its {calls} calls, each by itself": sums[COLUMNS],
        f"the same on {FEW} columns: what calls cost besides": sums[FEW],
    }
    made_rows = tuple(Row(k, min(v) * unit, float(np.median(v)) * unit, min(v) / min(whole)) for k, v in found.items())
    title = f"12. What bounds RK4 on arrays: {COLUMNS} motions of the polar orbit"
    return Table(title, "nanoseconds a step of one", made_rows)


def _lasting(function: np.ufunc, arguments: tuple[np.ndarray, ...], rounds: int) -> list[float]:
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
