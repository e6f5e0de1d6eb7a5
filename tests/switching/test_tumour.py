"""A tumour and the vessels that feed it, with a given amount of an inhibitor: a singular arc between bounds.

The model of Hahnfeldt, Panigrahy, Folkman and Hlatky (1999) as Ledzewicz and Schaettler treat it (2007).
"""

from __future__ import annotations

from pathlib import Path

import pytest
from sympy import Rational, log

from satsym.solvers import solve
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

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
        rates={p: -xi * p * log(p / q), q: b * p - (mu + d * p ** Rational(2, 3)) * q - kill * u * q, y: u},
    ),
    running_cost=0,
    terminal_cost=p,
    control_set="box",
)


@pytest.mark.parametrize(
    ("vessels", "amount", "structure", "least", "duration"),
    [
        # by CasADi and Ipopt, Runge-Kutta steps 3000 between piecewise constant controls
        (4314.410609539558, 15.0, "-s-", 8458.1560731, 0.4470414),
        pytest.param(8000.0, 15.0, "+s-", None, None, marks=pytest.mark.study),
    ],
)
def test_a_singular_dose_ends_in_rest(
    tmp_path: Path, vessels: float, amount: float, structure: str, least: float | None, duration: float | None
) -> None:
    """Where the switching function leaves its double zero no sign tells at once which way it goes."""
    text = f"""
        [initial]
        p = 8628.821219079116
        q = {vessels}
        y = 0.0
        [final]
        y = {amount}
        [time]
        tf = "free"
        [control]
        u = [0.0, 75.0]
        """
    found = solve(build(tmp_path, TUMOUR, text))
    assert found.status is Status.CONVERGED, found.message
    assert f"structure {structure}," in found.message
    if least is not None:
        assert least * (1.0 - 3e-9) < found.objective < least
        assert found.times[-1] == pytest.approx(duration, abs=1e-6)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.EXTREMAL_ONLY
    assert [check.name for check in found.certificate.checks if not check.passed] == [
        "no proof of a minimum along singular arcs: not convex"
    ]
