"""An extremal that is a maximum in the free final state: q' = u, J = k cos q(1) + the integral of u^2/2, from q = 0.

To stay is an extremal. Its second variation is that of v^2/2 - k v^2/2 over the final states v, positive where k < 1.
"""

from __future__ import annotations

import numpy as np
import pytest
import sympy

import satsym
from satsym.proof.proving import prove
from satsym.proof.record import Outcome
from tests.proof.closed_forms import answer


@pytest.mark.parametrize(("k", "wanted"), [("1/2", Outcome.PROVED), ("2", Outcome.NOT_PROVED)])
def test_a_maximum_in_the_final_state_is_not_proved(k: str, wanted: Outcome) -> None:
    q, u = sympy.symbols("q u", real=True)
    motion = satsym.FirstOrder(
        name="turned_motion",
        title="A body that is turned",
        states=(satsym.Variable("q", "q", kind="angle"),),
        controls=(satsym.Variable("u", "u"),),
        parameters=(),
        rates={q: u},
    )
    problem = satsym.Problem(
        name="turned",
        title="Turned",
        model=motion,
        running_cost=u**2 / 2,
        terminal_cost=sympy.Rational(k) * sympy.cos(q),
    )
    case = satsym.Instance.of(problem, initial={"q": 0.0}, tf=1.0).case
    t = np.linspace(0.0, 1.0, 21)
    zero = np.zeros((1, 21))
    proof = prove(case, lambda: answer(case, t, zero, zero, zero))
    assert proof.status is wanted, proof.reason
    assert ("focal" in proof.reason) is (wanted is Outcome.NOT_PROVED)
