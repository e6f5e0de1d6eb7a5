"""Free initial values: L = (u^2 - q^2)/2, q'' = u, from q = 1 with any velocity to rest at the origin.

The second variation is that of a beam which is pinned at one end and clamped at the other; it is positive until the
first positive zero of tan T = tanh T, 3.9266.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy

import satsym
from satsym.instance import Instance
from satsym.proof.proving import prove
from satsym.proof.record import Outcome
from satsym.solution import Solution
from tests.proof.closed_forms import answer


@cache
def problem() -> Any:
    q, v, u = sympy.symbols("q v u", real=True)
    motion = satsym.FirstOrder(
        name="thrown_motion",
        title="A point that is thrown",
        states=(satsym.Variable("q", "q"), satsym.Variable("v", "v")),
        controls=(satsym.Variable("u", "u"),),
        parameters=(),
        rates={q: v, v: u},
    )
    return satsym.Problem(name="thrown", title="Thrown", model=motion, running_cost=(u**2 - q**2) / 2)


def coefficients(tf: Any) -> list[Any]:
    """Those of cos, sin, cosh and sinh in q, by q(0) = 1, q''(0) = 0, q(T) = q'(T) = 0."""
    c, s, ch, sh = mpmath.cos(tf), mpmath.sin(tf), mpmath.cosh(tf), mpmath.sinh(tf)
    rows = mpmath.matrix([[1, 0, 1, 0], [-1, 0, 1, 0], [c, s, ch, sh], [-s, c, sh, ch]])
    return list(mpmath.lu_solve(rows, mpmath.matrix([1, 0, 0, 0])))


def extremal(tf: float) -> tuple[Instance, Solution]:
    case = satsym.Instance.of(problem(), initial={"q": 1.0, "v": "free"}, final={"q": 0.0, "v": 0.0}, tf=tf).case
    a, b, c, d = map(float, coefficients(tf))
    t = np.linspace(0.0, tf, 201)
    q, v, u, rate = (
        a * k + b * s + c * ch + d * sh
        for k, s, ch, sh in (
            (np.cos(t), np.sin(t), np.cosh(t), np.sinh(t)),
            (-np.sin(t), np.cos(t), np.sinh(t), np.cosh(t)),
            (-np.cos(t), -np.sin(t), np.cosh(t), np.sinh(t)),
            (np.sin(t), -np.cos(t), np.sinh(t), np.cosh(t)),
        )
    )
    return case, answer(case, t, np.array([q, v]), u[None], np.array([rate, -u]))


@pytest.mark.parametrize(
    ("tf", "wanted"),
    [(2.0, Outcome.PROVED), (3.75, Outcome.PROVED), (3.9375, Outcome.NOT_PROVED), (5.0, Outcome.NOT_PROVED)],
)
def test_a_free_velocity_is_found_and_proved_until_the_focal_time(tf: float, wanted: Outcome) -> None:
    case, found = extremal(tf)
    proof = prove(case, lambda: found)
    assert proof.status is wanted, proof.reason
    assert proof.numbers["initial.v"] == "free"
    with mpmath.workdps(40):
        _, b, _, d = coefficients(mpmath.mpf(tf))
        speed = proof.nodes[0].x["v"]
        assert abs(mpmath.mpf(speed.centre) - (b + d)) <= mpmath.mpf(speed.radius)
    assert float(proof.costate_initial["v"].centre) == 0.0
