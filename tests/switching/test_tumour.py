"""A tumour and the vessels that feed it, with a given amount of an inhibitor: a singular arc between bounds.

The model of Hahnfeldt, Panigrahy, Folkman and Hlatky (1999) as Ledzewicz and Schaettler treat it (2007).
"""

from __future__ import annotations

from collections.abc import Callable
from math import log
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from sympy import Rational

from satsym.solvers import solve
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

Law = Callable[[np.ndarray], float]

STATES = tuple(
    Variable(name, name, positive=positive, typical=typical)
    for name, positive, typical in (("p", True, (5e3, 1.2e4)), ("q", True, (2e3, 1.2e4)), ("y", False, (0.0, 15.0)))
)
CONTROLS = (Variable("u", "u", typical=(0.0, 75.0)),)
p, q, y = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)
xi, b, d, mu, kill = (Rational(value) for value in ("0.084", "5.85", "0.00873", "0.02", "0.15"))

TUMOUR = Problem(
    name="tumour",
    title="Least tumour for a given amount of inhibitor",
    model=FirstOrder(
        name="growth",
        title="Growth",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={p: -xi * p * sp.log(p / q), q: b * p - (mu + d * p ** Rational(2, 3)) * q - kill * u * q, y: u},
    ),
    running_cost=0,
    terminal_cost=p,
    control_set="box",
)


def followed(tumour: float, vessels: float, amount: float, first: float) -> tuple[float, list[float]]:
    """The least tumour by events alone: to the singular curve, along it until all is given, and at rest to p = q.

    The curve is b x (1 - ln x) = mu + d p^(2/3) with x = p / q, as Ledzewicz and Schaettler have it.
    """

    def rates(y: np.ndarray, dose: float) -> np.ndarray:
        p, q, _ = y
        return np.array(
            [-0.084 * p * log(p / q), 5.85 * p - (0.02 + 0.00873 * p ** (2 / 3)) * q - 0.15 * q * dose, dose]
        )

    def off(y: np.ndarray) -> float:
        p, q, _ = y
        return 5.85 * p / q * (1.0 - log(p / q)) - 0.02 - 0.00873 * p ** (2 / 3)

    def staying(y: np.ndarray) -> float:
        p, q, _ = y
        by_ratio = -5.85 * log(p / q)
        slope = np.array([by_ratio / q - 0.00582 * p ** (-1 / 3), -by_ratio * p / q**2, 0.0])
        still, moved = (float(slope @ rates(y, dose)) for dose in (0.0, 1.0))
        return still / (still - moved)

    y, t, times = np.array([tumour, vessels, 0.0]), 0.0, []
    legs: tuple[tuple[Law, Law], ...] = (
        (lambda y: first, off),
        (staying, lambda y: y[2] - amount),
        (lambda y: 0.0, lambda y: y[0] - y[1]),
    )
    for dose, until in legs:

        def met(t: float, y: np.ndarray, until: Law = until) -> float:
            return until(y)

        met.terminal = True  # type: ignore[attr-defined]
        found = solve_ivp(
            lambda t, y, dose=dose: rates(y, dose(y)), (t, t + 50.0), y, "DOP853", events=met, rtol=1e-13, atol=1e-9
        )
        y, t = found.y[:, -1], float(found.t[-1])
        times.append(t)
    return float(y[0]), times


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tumour", "vessels", "amount", "structure"),
    [
        (8628.821219079116, 4314.410609539558, 15.0, "-s-"),
        (12000.0, 15000.0, 300.0, "+s-"),  # deviations grow a thousandfold along the singular arc
        pytest.param(8628.821219079116, 8000.0, 15.0, "+s-", marks=pytest.mark.study),
        pytest.param(5000.0, 12000.0, 200.0, "+s-", marks=pytest.mark.study),
    ],
)
def test_a_singular_dose_ends_in_rest(
    tmp_path: Path, tumour: float, vessels: float, amount: float, structure: str
) -> None:
    """Where the switching function leaves its double zero no sign tells at once which way it goes."""
    text = f"""
        [initial]
        p = {tumour}
        q = {vessels}
        y = 0.0
        [final]
        y = {amount}
        [time]
        t0 = 2.0
        tf = "free"
        [control]
        u = [0.0, 75.0]
        """
    found = solve(build(tmp_path, TUMOUR, text))
    least, times = followed(tumour, vessels, amount, 75.0 * (structure[0] == "+"))
    assert found.status is Status.CONVERGED, found.message
    assert f"structure {structure}," in found.message
    assert found.objective == pytest.approx(least, rel=1e-11)
    assert (*found.switching_times[0], found.times[-1]) == pytest.approx([2.0 + t for t in times], abs=1e-8)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    assert "Goh" in found.certificate.because
