"""Where a minimum is global, and where that must not be claimed; angles that count modulo a turn."""

from __future__ import annotations

from functools import cache
from typing import Any

import mpmath
import pytest
import sympy

import satsym
from satsym.front.proving import Proof
from satsym.proof.record import Outcome


@cache
def sled(drift: float = 0.0) -> Any:
    """A body on a line, in least time; it drifts without control where a force acts."""
    q, v, u = sympy.symbols("q v u", real=True)
    motion = satsym.FirstOrder(
        name="sled_motion",
        title="A sled",
        states=(satsym.Variable("q", "q"), satsym.Variable("v", "v")),
        controls=(satsym.Variable("u", "u"),),
        parameters=(),
        rates={q: v, v: u - sympy.nsimplify(drift)},
    )
    return satsym.Problem(name="sled", title="Quickly", model=motion, running_cost=1, control_set="box")


def proved(drift: float, speed: float, lower: float = -1.0) -> Proof:
    case = satsym.Instance.of(
        sled(drift),
        initial={"q": 0.0, "v": 0.0},
        final={"q": 1.0, "v": speed},
        tf="free",
        control={"u": [lower, 1.0]},
    )
    return satsym.prove(case)


def claims_global(proof: Proof) -> bool:
    assert proof.status is Outcome.PROVED, proof.reason
    assert proof.theorem is not None
    return any("global" in claim for claim in proof.theorem.claims)


@pytest.mark.slow
def test_least_time_is_global_where_one_can_wait_at_the_end() -> None:
    assert claims_global(proved(0.0, 0.0))
    assert not claims_global(proved(0.0, 0.5))  # one passes the end
    assert not claims_global(proved(0.25, 0.0))  # without control one leaves it


@pytest.mark.slow
def test_an_angle_modulo_a_turn_ends_at_the_nearest_one() -> None:
    """A wheel turns from 4 to 0 modulo a turn, at rest, in time 1: ahead, by 2 pi - 4, at the cost 6 (2 pi - 4)^2."""
    q, v, u = sympy.symbols("q v u", real=True)
    motion = satsym.FirstOrder(
        name="wheel_motion",
        title="A wheel",
        states=(satsym.Variable("q", "q", kind="angle"), satsym.Variable("v", "v")),
        controls=(satsym.Variable("u", "u"),),
        parameters=(),
        rates={q: v, v: u},
    )
    problem = satsym.Problem(name="wheel", title="Turn", model=motion, running_cost=u**2 / 2)
    case = satsym.Instance.of(problem, initial={"q": 4.0, "v": 0.0}, final={"q": 0.0, "v": 0.0}, tf=1.0)
    proof = satsym.prove(case.with_(solver={"free_angles": ["q"]}))
    assert not claims_global(proof)
    assert claims_global(satsym.prove(case))
    assert proof.objective is not None
    with mpmath.workdps(30):
        exact = 6 * (2 * mpmath.pi - 4) ** 2
        assert abs(mpmath.mpf(proof.objective.centre) - exact) <= mpmath.mpf(proof.objective.radius)
