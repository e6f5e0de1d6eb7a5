"""A direction as a vector of bounded norm: the same optimum as by its angle."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest
import sympy

import satsym
from satsym.proof.record import Outcome
from satsym.symbolic import Ball


@cache
def crossing() -> Any:
    """Zermelo's problem of the shipped instance, with the velocity through the water as a vector."""
    x, y, u, w = sympy.symbols("x y u w", real=True)
    motion = satsym.FirstOrder(
        name="crossing_motion",
        title="A boat in a current",
        states=(satsym.Variable("x", "x"), satsym.Variable("y", "y")),
        controls=(satsym.Variable("u", "u"), satsym.Variable("w", "w")),
        parameters=(),
        rates={x: u - y, y: w},
    )
    return satsym.Problem(
        name="crossing", title="Crossing", model=motion, running_cost=1, control_sets={"speed": Ball("u", "w")}
    )


@pytest.mark.slow
def test_a_direction_is_proved_as_a_vector_and_as_an_angle() -> None:
    start = {"x": 3.66, "y": -1.86}
    case = satsym.Instance.of(
        crossing(), initial=start, final={"x": 0.0, "y": 0.0}, tf="free", control={"max_norm": 1.0}
    )
    vector, angle = satsym.prove(case), satsym.prove("zermelo")
    assert vector.status is angle.status is Outcome.PROVED
    assert vector.objective is not None
    assert angle.objective is not None
    # the start of the one is a binary fraction, that of the other a decimal
    assert float(vector.objective.centre) == pytest.approx(float(angle.objective.centre), rel=1e-14)
    assert any(
        "H is linear in the controls, and its coefficients do not all vanish" in one.shown for one in vector.hypotheses
    )
