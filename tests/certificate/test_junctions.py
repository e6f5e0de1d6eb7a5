"""Flows that lose every digit are compared node by node, and gaps that lean to one side are no extremal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sympy import sympify

from satsym.solution import Solution
from satsym.solvers import linear
from satsym.solvers.certificate import certify
from tests.support.models import build, q, scalar, w

TEXT = "[initial]\nq = 1.0\n[final]\nq = 0.5\n[time]\nt0 = 2.0\ntf = 42.0\n"


@pytest.fixture(scope="module")
def unstable(tmp_path_factory: pytest.TempPathFactory) -> Solution:
    """q' = q + w for 40 units of time: the last digit of a costate becomes e^40 as large."""
    problem = scalar("unstable", q + w, w**2 / 2, sympify(0), "free")
    return linear.solve(build(tmp_path_factory.mktemp("junctions"), problem, TEXT))


def measured(solution: Solution) -> tuple[str, dict[str, bool]]:
    certificate = certify(solution)
    assert certificate is not None
    return certificate.verdict.value, {check.name: check.passed for check in certificate.checks}


def test_a_long_unstable_motion_is_certified_node_by_node_and_says_so(unstable: Solution) -> None:
    verdict, passed = measured(unstable)
    assert verdict == "certified"
    assert {"junction defect", "correction of the nodes"} <= passed.keys()
    assert "dynamics defect" not in passed


def test_small_gaps_that_all_lean_to_one_side_are_noticed(unstable: Solution) -> None:
    leaning = 1.0 + 1e-9 * np.arange(len(unstable.times))
    tampered = replace(unstable, x=unstable.x * leaning, lam=unstable.lam * leaning, u=unstable.u * leaning)
    verdict, passed = measured(tampered)
    assert verdict == "failed"
    assert passed["junction defect"]
    assert not passed["correction of the nodes"]


@pytest.mark.parametrize("place", [0, 301, -1])
def test_a_single_node_that_is_off_is_noticed(unstable: Solution, place: int) -> None:
    lam = unstable.lam.copy()
    lam[0, place] *= 1.0 + 1e-5
    lam[0, place] += 1e-6 * np.abs(lam).max()
    assert measured(replace(unstable, lam=lam))[0] == "failed"
