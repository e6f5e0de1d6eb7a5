"""Each node of a solution is held against the motion from the one before it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from satsym import instance
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.reintegration.node_defect import node_defect


@pytest.fixture(scope="module")
def returned() -> Solution:
    return solve(instance.load("return-to-orbit"), examined=False)


@pytest.mark.parametrize(("place", "row", "node"), [("x", 0, 503), ("x", 3, 977), ("lam", 1, 20), ("x", 1, -2)])
def test_a_single_node_that_is_off_is_seen(returned: Solution, place: str, row: int, node: int) -> None:
    """Whichever it is: one that no station of the flow coincides with, too."""
    values = getattr(returned, place).copy()
    values[row, node] += 1e-5 * np.abs(values[row]).max()
    spoilt = replace(returned, **{place: values})
    if place == "lam":  # the control as the law has it, so that stationarity does not tell
        case = spoilt.instance
        law = case.model.control_law_batch
        u = law(spoilt.times, spoilt.x, spoilt.lam, case.parameters, case.control_set.arguments)
        spoilt = replace(spoilt, u=np.asarray(u))
    found = certify(spoilt, compared=False)
    assert found is not None
    assert found.verdict == "failed"
    assert "node defect" in [check.name for check in found.checks if not check.passed]


def test_nodes_far_apart_are_integrated_in_parts_until_errors_are_small(returned: Solution) -> None:
    """Every fiftieth node alone: two columns of extrapolation are not enough between these."""
    kept = slice(None, None, 50)
    sparse = replace(
        returned,
        times=returned.times[kept],
        x=returned.x[:, kept],
        u=returned.u[:, kept],
        lam=returned.lam[:, kept],
    )
    assert node_defect(sparse) < 1e-10


def test_what_is_not_finite_is_infinitely_far(returned: Solution) -> None:
    lam = returned.lam.copy()
    lam[0, 7] = np.nan
    assert node_defect(replace(returned, lam=lam)) == np.inf
