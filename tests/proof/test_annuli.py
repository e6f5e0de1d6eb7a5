"""A vector between two norms: in least time it is as long as may be, at least thrust it switches between both."""

from __future__ import annotations

from typing import Any

import pytest
import sympy

import satsym
from satsym.front.proving import Proof
from satsym.proof.record import Outcome
from satsym.symbolic import Annulus, Ball

a, b, c, d, u, w = sympy.symbols("a b c d u w", real=True)
STATES, CONTROLS = (a, b, c, d), (u, w)
START, REST = {"a": 1.0, "b": 0.3, "c": 0.5, "d": -0.2}, {"a": 0.0, "b": 0.0, "c": 0.0, "d": 0.0}


def proved(cost: Any, kind: Any, tf: Any, **norms: float) -> Proof:
    motion = satsym.FirstOrder(
        name="planar_motion",
        title="A body in a plane",
        states=tuple(satsym.Variable(str(s), str(s)) for s in STATES),
        controls=tuple(satsym.Variable(str(s), str(s)) for s in CONTROLS),
        parameters=(),
        rates={a: b, b: u, c: d, d: w},
    )
    problem = satsym.Problem(
        name="planar", title="Planar", model=motion, running_cost=cost, control_sets={"thrust": kind("u", "w")}
    )
    proof = satsym.prove(satsym.Instance.of(problem, initial=START, final=REST, tf=tf, control=norms))
    assert proof.status is Outcome.PROVED, proof.reason
    return proof


def objective(proof: Proof) -> float:
    assert proof.objective is not None
    return float(proof.objective.centre)


@pytest.mark.slow
def test_in_least_time_the_least_norm_says_nothing() -> None:
    ring = proved(sympy.Integer(1), Annulus, "free", min_norm=0.5, max_norm=1.0)
    disc = proved(sympy.Integer(1), Ball, "free", max_norm=1.0)
    assert objective(ring) == pytest.approx(objective(disc), rel=1e-15)


@pytest.mark.slow
def test_at_least_thrust_a_coast_becomes_an_arc_of_least_norm() -> None:
    thrust = sympy.sqrt(u**2 + w**2)
    ring = proved(thrust, Annulus, 4.0, min_norm=0.1, max_norm=1.0)
    disc = proved(thrust, Ball, 4.0, max_norm=1.0)
    assert len(ring.switching_times) == len(disc.switching_times) == 2
    assert objective(ring) > objective(disc)
    first, second = (float(t.centre) for t in ring.switching_times)
    assert objective(ring) == pytest.approx(first + 4.0 - second + 0.1 * (second - first), rel=1e-15)
