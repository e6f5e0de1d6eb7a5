"""The least effort round a disc: steady speed along a taut string, on either side of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from satsym.solvers import solve
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES, CONTROLS = (Variable("a", "a"), Variable("b", "b")), (Variable("v", "v"), Variable("w", "w"))
PARAMETERS = (Variable("r", "r", positive=True),)
(a, b), (v, w), (r,) = symbols_of(STATES), symbols_of(CONTROLS), symbols_of(PARAMETERS)

ROUND = Problem(
    name="round_a_disc",
    title="Least effort round a disc",
    model=FirstOrder(
        name="point",
        title="A point",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={a: v, b: w},
    ),
    running_cost=(v**2 + w**2) / 2,
    path_constraints={"disc": r**2 - a**2 - b**2},
)


def taut(start: tuple[float, float], end: tuple[float, float], radius: float) -> float:
    """The length of the shorter string: two tangents, and the arc between them."""
    distances = [float(np.hypot(*point)) for point in (start, end)]
    turned = (np.arctan2(end[1], end[0]) - np.arctan2(start[1], start[0])) % (2.0 * np.pi)
    arc = min(turned, 2.0 * np.pi - turned) - sum(np.arccos(radius / d) for d in distances)
    return sum(np.sqrt(d**2 - radius**2) for d in distances) + radius * arc


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "end", "radius"),
    [
        ((-1.0, 0.0), (1.0, 0.2), 0.5),
        ((-2.0, 0.1), (1.0, 0.0), 0.3),
        ((-1.0, -1.2), (1.5, 1.3), 0.7),
        ((-1.0, 0.0), (1.0, 0.0), 0.5),
    ],
    ids=["near the middle", "small", "large", "through the middle"],
)
def test_the_path_round_a_disc_is_a_taut_string(
    tmp_path: Path, start: tuple[float, float], end: tuple[float, float], radius: float
) -> None:
    ends = "".join(f"[{key}]\na = {x}\nb = {y}\n" for key, (x, y) in (("initial", start), ("final", end)))
    found = solve(build(tmp_path, ROUND, f"[parameters]\nr = {radius}\n{ends}[time]\ntf = 1.0\n"))
    assert found.objective == pytest.approx(taut(start, end, radius) ** 2 / 2.0, rel=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
