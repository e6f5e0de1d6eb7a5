"""A limit of the speed: at the cost of u^2/2 from rest to rest over the distance 1 in time 1, with v < w.

The speed rises by a parabola to w until t1 = 3/2 (1 - 1/w), stays and falls in the same way; the cost is 4 w^2/(3 t1).
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import mpmath
import pytest
import sympy

import satsym
from satsym import kernels, solvers
from satsym.instance import Instance
from satsym.proof.proving import prove
from satsym.proof.record import Outcome, Proof
from satsym.solution import Solution


@cache
def problem(tied: bool = False) -> Any:
    q, v, u, w = sympy.symbols("q v u w", real=True)
    motion = satsym.FirstOrder(
        name="limited_motion",
        title="A body on a line",
        states=(satsym.Variable("q", "q"), satsym.Variable("v", "v")),
        controls=(satsym.Variable("u", "u"),),
        parameters=(satsym.Variable("w", "w", default=1.25),),
        rates={q: v, v: u},
    )
    return satsym.Problem(
        name="limited",
        title="A limit of the speed",
        model=motion,
        running_cost=u**2 / 2,
        path_constraints={"speed": v - w},
        terminal_constraints=(q + v - 1, 2 * v - q + 1) if tied else (),
    )


@cache
def solved(w: float) -> tuple[Instance, Solution]:
    ends = {"initial": {"q": 0.0, "v": 0.0}, "final": {"q": 1.0, "v": 0.0}}
    case = satsym.Instance.of(problem(), **ends, tf=1.0, parameters={"w": w}).case
    return case, solvers.solve(case)


def holds(found: Any, exact: Any) -> bool:
    return bool(abs(mpmath.mpf(found.centre) - exact) <= mpmath.mpf(found.radius) < mpmath.mpf(10) ** -18)


@pytest.mark.parametrize("w", [1.25, 1.0625, 1.4375])
def test_a_limited_speed_is_kept_at_least_cost(w: float) -> None:
    case, found = solved(w)
    proof = prove(case, lambda: found)
    assert proof.status is Outcome.PROVED, proof.reason
    with mpmath.workdps(40):
        limit = mpmath.mpf(w)
        rising = 3 * (1 - 1 / limit) / 2
        assert holds(proof.objective, 4 * limit**2 / (3 * rising))
        entered, left = proof.switching_times
        assert holds(entered, rising)
        assert holds(left, 1 - rising)
    assert proof.theorem is not None
    assert "global" in proof.theorem.claims[-1]


def test_a_wall_beside_constraints_that_give_the_same_end() -> None:
    _, found = solved(1.25)
    case = satsym.Instance.of(problem(tied=True), initial={"q": 0.0, "v": 0.0}, final={}, tf=1.0).case
    proof = prove(case, lambda: replace(found, instance=case))
    assert proof.status is Outcome.PROVED, proof.reason
    assert holds(proof.objective, mpmath.mpf(125) / 18)
    assert proof.theorem is not None
    assert "global" in proof.theorem.claims[-1]


def test_a_limit_that_is_not_met_changes_nothing() -> None:
    case, found = solved(1.75)
    proof = prove(case, lambda: found)
    assert proof.status is Outcome.PROVED, proof.reason
    assert holds(proof.objective, 6)


def not_proved(case: Instance, found: Solution) -> Proof:
    proof = prove(case, lambda: found)
    assert proof.status is Outcome.NOT_PROVED
    return proof


def test_a_limit_that_is_left_out_is_not_proved() -> None:
    case, _ = solved(1.25)
    _, without = solved(1.75)
    assert "path_constraints" in not_proved(case, replace(without, instance=case)).reason


def test_a_kernel_with_another_boundary_is_not_proved() -> None:
    case, found = solved(1.25)
    text = case.model.text
    assert text
    for name, old, new in (
        ("path_multiplier", "-lambda_q", "lambda_q"),
        ("path_multiplier", "-lambda_q", "-2.0*lambda_q"),
        ("path_gradient", "1.0,", "-1.0,"),
        ("path_vanishing", "-lambda_v", "-lambda_v - 1.0e-20"),
        ("boundary_control", "0.0,", "0.001,"),
    ):
        begin = text.index(f"def {name}(")
        end = text.index("\n\n\n", begin)
        assert old in text[begin:end], text[begin:end]
        altered = text[:begin] + text[begin:end].replace(old, new) + text[end:]
        other = replace(case, model=kernels.loading.from_text(altered, "limited"))
        not_proved(other, found)
