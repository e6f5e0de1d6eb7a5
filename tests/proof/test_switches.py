"""Extremals that switch, of which it is known which is best: L = -q^2/2, q' = u, |u| <= 1, q(0) = q(T) = 0.

Up and down is best. Up, down and up again is an extremal as well, but of all motions with two switches it costs most.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any

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
    q, u = sympy.symbols("q u", real=True)
    motion = satsym.FirstOrder(
        name="far_motion",
        title="A point that is moved at bounded speed",
        states=(satsym.Variable("q", "q"),),
        controls=(satsym.Variable("u", "u"),),
        parameters=(),
        rates={q: u},
    )
    return satsym.Problem(
        name="far", title="As far away as can be", model=motion, running_cost=-(q**2) / 2, control_set="box"
    )


def case(final: float) -> Instance:
    return satsym.Instance.of(
        problem(), initial={"q": 0.0}, final={"q": final}, tf=4.0, control={"u": [-1.0, 1.0]}
    ).case


def zigzag(given: Instance, switches: list[float], first: float, costate: float) -> Solution:
    """The extremal with these switches; its costate grows at the rate q."""
    edges = [0.0, *switches, 4.0]
    t, x, u, lam, q, speed = [], [], [], [], 0.0, first
    for a, b in pairwise(edges):
        s = np.linspace(0.0, b - a, 21)
        t.append(a + s)
        x.append(q + speed * s)
        u.append(np.full(len(s), speed))
        lam.append(costate + q * s + speed * s**2 / 2)
        q, costate, speed = x[-1][-1], lam[-1][-1], -speed
    rows = [np.concatenate(one) for one in (t, x, u, lam)]
    return answer(given, rows[0], rows[1][None], rows[2][None], rows[3][None])


def test_the_best_of_two_extremals_is_proved() -> None:
    given = case(0.0)
    proof = prove(given, lambda: zigzag(given, [2.0], 1.0, -2.0))
    assert (proof.status, proof.reason) == (Outcome.PROVED, "")
    assert proof.objective is not None
    assert float(proof.objective.centre) == pytest.approx(-8.0 / 3.0, rel=1e-15)


def test_one_that_costs_most_among_its_neighbours_is_not() -> None:
    given = case(0.0)
    proof = prove(given, lambda: zigzag(given, [1.0, 3.0], 1.0, -0.5))
    assert proof.status is Outcome.NOT_PROVED
    assert "det X of the field changes sign at the switch at t =" in proof.reason
    assert len(proof.switching_times) == 2  # it is an extremal nevertheless


def test_controls_on_the_wrong_side_of_their_switching_function_are_not() -> None:
    given = case(0.0)
    proof = prove(given, lambda: zigzag(given, [2.0], -1.0, -2.0))
    assert proof.status is Outcome.NOT_PROVED


def test_an_arc_of_negative_length_is_none() -> None:
    """From q = 0 to q = 4.5 in the time 4: at unit speed the equations hold with a second arc that runs backwards."""
    given = case(4.5)
    proof = prove(given, lambda: zigzag(given, [3.9], 1.0, -(4.25**2) / 2))
    assert proof.status is Outcome.NOT_PROVED
    assert proof.reason == "an arc has no positive length"
