"""Neighbours that are simulated side by side are those that are simulated one after the other."""

from __future__ import annotations

import numpy as np
import pytest

from satsym.arrays import Array
from satsym.grid import Grid
from satsym.instance import load
from satsym.solvers import solve
from satsym.solvers.certificate.competitors import accessory
from satsym.solvers.certificate.competitors.neighbours import neighbours
from satsym.solvers.certificate.competitors.side_by_side import SideBySide
from satsym.solvers.certificate.reintegration.chain import Chain


@pytest.mark.parametrize("name", ["return-to-orbit", "soft-return", "return-to-orbit-ball", "hypersensitive"])
def test_they_cost_what_each_costs_by_itself(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    solution = solve(load(name), examined=False)
    own, found = SideBySide.costs, list[Array | None]()

    def watched(self: SideBySide, changes: Array, end: Array, missed: float) -> Array | None:
        found.append(own(self, changes, end, missed))
        return found[-1]

    monkeypatch.setattr(SideBySide, "costs", watched)
    together = neighbours(solution)
    monkeypatch.setattr(SideBySide, "costs", lambda *_: None)
    apart = neighbours(solution)
    assert found[0] is not None
    assert len(found[0]) == together.competitors.solved == apart.competitors.solved == 4
    # the one after the other may miss the end by what counts as none
    assert together.competitors.cheapest == pytest.approx(apart.competitors.cheapest, rel=2e-9)
    assert together.margin == pytest.approx(apart.margin, rel=1e-4, abs=1e-12)


def test_controls_that_act_apart_need_no_decompositions(monkeypatch: pytest.MonkeyPatch) -> None:
    solution, own, found = solve(load("return-to-orbit"), examined=False), accessory._diagonal, list[Array | None]()

    def watched(matrices: Array) -> Array | None:
        found.append(own(matrices))
        return found[-1]

    grid = Grid.uniform(float(solution.times[0]), float(solution.times[-1]), 200)
    monkeypatch.setattr(accessory, "_diagonal", watched)
    apart = accessory.accessory(solution, grid)
    monkeypatch.setattr(accessory, "_diagonal", lambda _: None)
    decomposed = accessory.accessory(solution, grid)
    assert [one is None for one in found] == [False, False]
    assert apart is not None
    assert decomposed is not None
    np.testing.assert_allclose(apart.form, decomposed.form, rtol=1e-12, atol=1e-12)
    assert own(np.array([np.eye(2), [[1.0, 0.0], [1e-9, 1.0]]])) is None


def test_those_that_do_not_settle_are_simulated_one_after_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    solution = solve(load("return-to-orbit"), examined=False)
    expected = neighbours(solution)
    monkeypatch.setattr("satsym.solvers.certificate.competitors.side_by_side.SHRINKING", 1e-9)
    assert neighbours(solution).competitors.cheapest == pytest.approx(expected.competitors.cheapest, rel=2e-9)


def test_a_chain_carries_gaps_on() -> None:
    rng = np.random.default_rng(3)
    transition, gaps = rng.normal(size=(7, 4, 4)), rng.normal(size=(7, 4, 2))
    now = np.zeros((4, 2))
    for matrix, gap, found in zip(transition, gaps, Chain(transition).carried(gaps), strict=True):
        now = matrix @ now + gap
        assert np.abs(found - now).max() < 1e-12 * max(1.0, np.abs(now).max())
