"""A crane that moves a container (Sakawa and Shindo 1982), with the data of Augustin and Maurer 2001, by shooting."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import root

from satsym.solvers import solve
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES, CONTROLS = (tuple(Variable(f"{s}{k}", f"{s}_{k}") for k in range(1, n + 1)) for s, n in (("x", 6), ("u", 2)))
x1, x2, x3, x4, x5, x6 = symbols_of(STATES)
u1, u2 = symbols_of(CONTROLS)

CRANE = Problem(
    name="crane",
    title="Moving a container with little swing",
    model=FirstOrder(
        name="hanging",
        title="A trolley with a rope",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={
            x1: x4,
            x2: x5,
            x3: x6,
            x4: u1 + 17.2656 * x3,
            x5: u2,
            x6: -(u1 + 27.0756 * x3 + 2 * x5 * x6) / x2,
        },
    ),
    running_cost=(x3**2 + x6**2 + (u1**2 + u2**2) / 100) / 2,
    path_constraints={"fast": x4 - 2.5, "back": -x4 - 2.5, "hoisting": x5 - 1, "lowering": -x5 - 1},
    control_set="box",
)
GIVEN = """
    [initial]
    x1 = 0.0
    x2 = 22.0
    x3 = 0.0
    x4 = 0.0
    x5 = -1.0
    x6 = 0.0
    [final]
    x1 = 10.0
    x2 = 14.0
    x3 = 0.0
    x4 = 2.5
    x5 = 0.0
    x6 = 0.0
    [time]
    tf = 9.0
    [control]
    u1 = [-2.83374, 2.83374]
    u2 = [-0.80865, 0.71265]
    """


def motion(_: float, z: NDArray[np.float64], lowering: bool) -> list[float]:
    """States, costates and cost, by hand; as long as the rope is let out at the largest speed it does not cost."""
    x2, x3, x4, x5, x6, _, l2, l3, l4, l5, l6 = z[1:12]
    u1, u2 = -100.0 * (l4 - l6 / x2), 0.0 if lowering else -100.0 * l5
    pulled = u1 + 27.0756 * x3 + 2.0 * x5 * x6
    states = [x4, x5, x6, u1 + 17.2656 * x3, u2, -pulled / x2]
    rope = 0.0 if lowering else -l2 + 2.0 * x6 * l6 / x2
    third = -x3 - 17.2656 * l4 + 27.0756 * l6 / x2
    costates = [0.0, -l6 * pulled / x2**2, third, -z[6], rope, -x6 - l3 + 2.0 * x5 * l6 / x2]
    return [*states, *costates, (x3**2 + x6**2 + (u1**2 + u2**2) / 100.0) / 2.0]


def moved(unknown: NDArray[np.float64]) -> NDArray[np.float64]:
    """The end, from five costates and the time until which the rope is let out at the largest speed."""
    z = np.array([0.0, 22.0, 0.0, 0.0, -1.0, 0.0, *unknown[:4], 0.0, unknown[4], 0.0])
    for start, end, lowering in ((0.0, unknown[5], True), (unknown[5], 9.0, False)):
        z = solve_ivp(motion, (start, end), z, "DOP853", args=(lowering,), rtol=1e-12, atol=1e-14).y[:, -1]
    return z


@pytest.mark.slow
def test_the_container_is_lowered_at_the_largest_speed_first(tmp_path: Path) -> None:
    """What no bound holds is stationary beside a bound of another control, but for rounding of its terms."""
    found = solve(build(tmp_path, CRANE, GIVEN))
    assert found.status is Status.CONVERGED, found.message
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    assert [(one.kind, one.name) for one in found.events] == [("entry", "lowering"), ("exit", "lowering")]
    near = np.round([*found.lam[:4, 0], found.lam[5, 0], found.events[1].t], 3)
    known = root(lambda unknown: moved(unknown)[:6] - [10.0, 14.0, 0.0, 2.5, 0.0, 0.0], near, tol=1e-13)
    assert known.success
    assert found.objective == pytest.approx(moved(known.x)[-1], rel=1e-10)
    assert found.events[1].t == pytest.approx(known.x[5], rel=1e-8)
