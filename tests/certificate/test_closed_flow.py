"""The flow out of motions from all stations at once is the flow that is followed step by step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from satsym import instance, solvers
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.closed_flow import carried, closed_flow
from satsym.solvers.certificate.reintegration.flow import Flow, flow, typical
from satsym.solvers.certificate.reintegration.segments import segments


def both(solution: Solution) -> tuple[Flow, Flow]:
    """Closed, and step by step."""
    along = segments(solution)
    assert along is not None
    closed, followed = closed_flow(solution, along), flow(solution)
    assert closed is not None
    assert followed is not None
    return closed, followed


def apart(solution: Solution, one: Flow, other: Flow) -> float:
    """At the end, relative to the sizes of states and costates; and the costs."""
    state, costate = typical(solution)
    ends = np.abs(one.x - other.x[:, -1:])[:, -1] / state, np.abs(one.lam - other.lam[:, -1:])[:, -1] / costate
    return float(max(ends[0].max(), ends[1].max(), abs(one.cost - other.cost) / abs(other.cost)))


@pytest.mark.parametrize("name", ["return-to-orbit", "soft-return", "transfer-time", "brachistochrone"])
def test_it_is_the_flow_step_by_step(name: str) -> None:
    solution = solvers.solve(instance.load(name), examined=False)
    assert apart(solution, *both(solution)) < 1e-11


def test_stations_that_are_off_change_nothing() -> None:
    solution = solvers.solve(instance.load("return-to-orbit"), examined=False)
    rng = np.random.default_rng(0)
    x, lam = (rows * (1.0 + 1e-6 * rng.uniform(-1.0, 1.0, rows.shape)) for rows in (solution.x, solution.lam))
    lam[:, 0] = solution.lam[:, 0]
    off = replace(solution, x=x, lam=lam)
    assert apart(solution, *both(off)) < 1e-11


def test_costates_that_are_off_lead_elsewhere() -> None:
    solution = solvers.solve(instance.load("return-to-orbit"), examined=False)
    lam = solution.lam.copy()
    lam[:, 0] *= 1.00001
    closed, followed = both(replace(solution, lam=lam))
    assert apart(solution, closed, followed) < 1e-11
    assert np.abs(closed.x[:, -1] - solution.x[:, -1]).max() > 1e-6


def test_what_does_not_settle_is_left_to_steps() -> None:
    solution = solvers.solve(instance.load("return-to-orbit"), examined=False)
    along = segments(solution)
    assert along is not None
    begins = along.begins * 1.3
    assert closed_flow(solution, replace(along, begins=begins, transition=0.9 * along.transition)) is None


def test_gaps_are_carried_on_by_the_steps_after_them() -> None:
    rng = np.random.default_rng(3)
    transition, gaps = rng.normal(size=(7, 4, 4)), rng.normal(size=(7, 4))
    now = np.zeros(4)
    for matrix, gap, found in zip(transition, gaps, carried(transition, gaps), strict=True):
        now = matrix @ now + gap
        assert np.abs(found - now).max() < 1e-12 * max(1.0, np.abs(now).max())
