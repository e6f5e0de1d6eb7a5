"""What must not be proved: kernels that contradict themselves, laws without a bound, features beyond all theorems."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from satsym import instance, kernels, solvers
from satsym.instance import Instance
from satsym.kernels.loading import shipped_text
from satsym.proof.proving import prove
from satsym.proof.record import Outcome
from satsym.solution import Solution

Solved = Callable[[str], Solution]


@pytest.fixture(scope="module")
def solved() -> Solved:
    found: dict[str, Solution] = {}

    def solve(name: str) -> Solution:
        if name not in found:
            found[name] = solvers.solve(instance.load(name))
        return found[name]

    return solve


def altered(name: str, function: str, old: str, new: str) -> Instance:
    """A shipped instance whose model differs in one term of one function."""
    case = instance.load(name)
    text = shipped_text(case.model.spec.name)
    begin = text.index(f"def {function}(")
    end = text.index("\n\n\n", begin)
    body = text[begin:end]
    assert old in body
    changed = text[:begin] + body.replace(old, new) + text[end:]
    return replace(case, model=kernels.loading.from_text(changed, case.model.spec.name))


ALTERED = [
    ("canonical", "        w_2,\n", "        w_2 - q,\n"),
    ("canonical", "-lambda_q,", "-2.0*lambda_q,"),
    ("canonical", "-lambda_q,", "-lambda_q - 1.0e-27*q,"),
    ("canonical_jacobian", "        -w_2,\n", "        w_2,\n"),
    ("control_law", "w = -lambda_q_dot", "w = -0.999*lambda_q_dot"),
    ("running_cost", "0.5*u1*u1", "0.5*u1*u1 + q"),
    ("dynamics", "        u1,\n", "        u1 - 0.1*q_dot,\n"),
    ("control_hessian", "1.0", "2.0"),
]


@pytest.mark.parametrize(("function", "old", "new"), ALTERED)
def test_a_kernel_with_one_altered_term_is_not_proved(solved: Solved, function: str, old: str, new: str) -> None:
    proof = prove(altered("double-integrator-energy", function, old, new), lambda: solved("double-integrator-energy"))
    assert proof.status is Outcome.NOT_PROVED
    assert "contradicts" in proof.reason or "no extremal" in proof.reason


def test_a_law_that_leaves_out_a_bound_is_not_proved() -> None:
    name = "double-integrator-energy"
    case = replace(instance.load(name), lower=(-float("inf"),), upper=(float("inf"),))
    without = solvers.solve(case)
    assert abs(without.u).max() > 1.0
    limited = instance.load(name)
    proof = prove(limited, lambda: replace(without, instance=limited))
    assert proof.status is Outcome.NOT_PROVED
    changed = altered(
        name, "canonical", "u1_min if w < u1_min else u1_max if w > u1_max else w", "u1_max if w > u1_max else w"
    )
    law = "u1_min if w < u1_min else u1_max if w > u1_max else w"
    text = changed.model.text
    assert text is not None
    text = text.replace(f"u1 = {law}", "u1 = u1_max if w > u1_max else w")
    text = text.replace("w_2 = 0.0 if w < u1_min else 0.0 if w > u1_max else 1.0", "w_2 = 0.0 if w > u1_max else 1.0")
    unbounded = replace(limited, model=kernels.loading.from_text(text, limited.model.spec.name))
    proof = prove(unbounded, lambda: replace(without, instance=limited))
    assert proof.status is Outcome.NOT_PROVED


@pytest.mark.parametrize(
    ("name", "feature"),
    [
        ("return-above", "path constraints of a problem that is not convex"),
        ("goddard-pressure", "path constraints together with bounds of the controls"),
        ("inspection", "path constraints"),
        ("fuller", "chatter"),
        ("chain", "free with a law of the kind stationary"),
        ("shuttle", "several control sets"),
    ],
)
def test_a_feature_that_no_theorem_covers_is_named_before_anything_is_solved(name: str, feature: str) -> None:
    def never() -> Solution:
        raise AssertionError

    proof = prove(instance.load(name), never)
    assert proof.status is Outcome.BEYOND
    assert feature in proof.reason


def test_an_angle_on_the_reference_modulo_a_turn_is_refused() -> None:
    case = instance.load("return-to-orbit")
    turning = replace(case, solver=type(case.solver)(free_angles=("theta",)))
    assert prove(turning, lambda: pytest.fail("nothing need be solved")).status is Outcome.BEYOND


def test_a_wall_that_is_left_out_is_not_proved() -> None:
    """Without its wall the parabola passes it; with a multiplier that pulls, nothing is proved either."""
    case = instance.load("bryson-denham")
    far = replace(case, parameters=(0.3,))
    without = solvers.solve(far)
    assert without.events == ()
    proof = prove(case, lambda: replace(without, instance=case))
    assert proof.status is Outcome.NOT_PROVED
    assert "path_constraints" in proof.reason
    with_wall = solvers.solve(case)
    pulled = replace(with_wall, lam=with_wall.lam * 1.5)
    proof = prove(case, lambda: pulled)
    assert proof.status is Outcome.NOT_PROVED
