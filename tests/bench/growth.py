"""How times grow with the number of states, of segments and of instances: exponents, and a picture of the lines.

The number of states is that of regulators of random systems; segments are those of shooting, whose steps stay of the
same order; instances are returns to the orbit and bodies on a line, in chunks as studies have them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from rows import Goal, Row, Table
from timing import interleaved

PICTURE = Path(__file__).parents[2] / "results" / "bench-batch" / "growth.png"
STATES, SEGMENTS, INSTANCES = (2, 4, 8, 16), (1, 2, 4, 8), (500, 1000, 2000, 4000)
CHUNK = 250
"""Instances at a time."""

Works = dict[str, tuple[Sequence[int], Callable[[int], Callable[[], object]], float]]
"""By name: sizes, what is timed for a size, and the largest exponent that is expected."""


def regulators(states: int) -> Callable[[], object]:
    """Riccati equations of random systems with half as many inputs."""
    from satsym.analysis.regulator import many

    rng, inputs = np.random.default_rng(0), states // 2
    A, B = rng.normal(size=(CHUNK, states, states)) / states**0.5, rng.normal(size=(CHUNK, states, inputs))
    return lambda: many.solve(A, B, np.eye(states), np.eye(inputs))


def segments(times: int) -> Callable[[], object]:
    """Returns to the orbit on a mesh with so many times the segments."""
    from batch import population

    from satsym.solvers.batch.many import Many
    from satsym.solvers.batch.solving import solved_together

    cases = population(CHUNK)
    many = Many.of(cases[0], cases, True)
    points, mesh = np.linspace(0.0, len(many.mesh) - 1.0, times * (len(many.mesh) - 1) + 1), many.mesh[:, 0]
    finer = replace(many, mesh=np.interp(points, np.arange(len(mesh)), mesh)[:, None])
    return lambda: solved_together(finer)


def returns(count: int) -> Callable[[], object]:
    """So many returns to the orbit."""
    from batch import population

    from satsym.solvers.batch.many import Many
    from satsym.solvers.batch.solving import solved_together

    cases = population(count)
    parts = [Many.of(cases[0], cases[at : at + CHUNK], True) for at in range(0, count, CHUNK)]
    return lambda: [solved_together(part) for part in parts]


def bodies(count: int) -> Callable[[], object]:
    """So many least times of a body on a line."""
    import batch

    from satsym.solvers.batch.switching.arrivals import first_arrivals

    cases = batch.bodies(count)[0]
    return lambda: [first_arrivals(cases[at : at + CHUNK], True) for at in range(0, count, CHUNK)]


WORKS: Works = {
    "regulators, states": (STATES, regulators, 3.3),
    "returns, segments": (SEGMENTS, segments, 1.2),
    "returns, instances": (INSTANCES, returns, 1.15),
    "bodies on a line, instances": (INSTANCES, bodies, 1.15),
}


def growth(rounds: int = 3) -> Table:
    """The exponent of each line, by least squares in logarithms."""
    found, made = {}, []
    for name, (sizes, work, most) in WORKS.items():
        taken = interleaved({str(size): work(size) for size in sizes}, rounds, least=0.0)
        seconds = [taken[str(size)].least for size in sizes]
        exponent = float(np.polyfit(np.log(sizes), np.log(seconds), 1)[0])
        found[name] = sizes, seconds, exponent
        last = taken[str(sizes[-1])]
        made.append(Row(name, last.least, last.middle, None, (Goal("exponent", exponent, most),), f"to {sizes[-1]}"))
    _draw(found)
    return Table(
        f"8. Growth (picture: {PICTURE.relative_to(PICTURE.parents[2])})", "seconds of the largest", tuple(made)
    )


def _draw(found: dict[str, tuple[Sequence[int], list[float], float]]) -> None:
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
    for name, (sizes, seconds, exponent) in found.items():
        relative = np.array(sizes) / sizes[0]
        axes.loglog(relative, np.array(seconds) / seconds[0], "o-", label=f"{name}: exponent {exponent:.2f}")
    axes.set(xlabel="number, of the first", ylabel="time, of the first")
    axes.legend()
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE, dpi=150)
    plt.close(figure)
