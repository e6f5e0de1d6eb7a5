"""Steps with the variations of many starts at once are the steps by themselves, and their derivatives."""

from __future__ import annotations

import numpy as np
import pytest

from satsym.arrays import Array
from satsym.instance import load
from satsym.solvers import solve
from satsym.solvers.certificate.reintegration import segments as module
from satsym.solvers.certificate.reintegration.segments import segments
from satsym.solvers.simulation.extrapolation import SUBSTEPS, leap, leap_and_error, leap_varied, leaps

RNG = np.random.default_rng(7)
STARTS, TIMES, WIDTHS = RNG.uniform(-1.0, 1.0, (2, 5)), RNG.uniform(0.0, 1.0, 5), RNG.uniform(0.05, 0.3, 5)


def swing(t: Array, y: Array) -> Array:
    """A pendulum that is shaken."""
    return np.array([y[1], -np.sin(y[0]) + 0.3 * np.cos(2.0 * t) * y[0] ** 2])


def slopes(t: Array, y: Array) -> Array:
    """Its rates by its states, shape (K, 2, 2)."""
    none, one = np.zeros_like(t), np.ones_like(t)
    return np.array([[none, one], [-np.cos(y[0]) + 0.6 * np.cos(2.0 * t) * y[0], none]]).transpose(2, 0, 1)


@pytest.mark.parametrize("columns", [1, 3, 5, len(SUBSTEPS)])
def test_columns_side_by_side_are_the_columns_one_by_one(columns: int) -> None:
    for k, (one, other) in enumerate(
        zip(leaps(swing, TIMES, STARTS, WIDTHS), leaps(swing, TIMES, STARTS, WIDTHS, columns), strict=True)
    ):
        assert (one[0] == other[0]).all()
        assert (one[1] == other[1]).all() or k == 0


def test_a_linear_motion_has_its_exponential() -> None:
    def turning(t: Array, y: Array) -> Array:
        return np.array([2.0 * y[1], -2.0 * y[0]])

    table = np.array([[0.0, 2.0], [-2.0, 0.0]])

    def its_slopes(t: Array, _: Array) -> Array:
        return np.repeat(table[None], len(t), axis=0)

    ends, whole, _ = leap_varied(turning, its_slopes, TIMES, STARTS, WIDTHS)
    cosine, sine = np.cos(2.0 * WIDTHS), np.sin(2.0 * WIDTHS)
    expected = np.array([[cosine, sine], [-sine, cosine]]).transpose(2, 0, 1)
    assert np.abs(whole - expected).max() < 1e-13
    assert np.abs(ends.T - (expected @ STARTS.T[:, :, None])[:, :, 0]).max() < 1e-13
    for columns in (2, 3, 4):
        error = leap_varied(turning, its_slopes, TIMES, STARTS, WIDTHS, columns)[2]
        for i, unit in enumerate(np.eye(2)):
            start = np.repeat(unit[:, None], len(TIMES), axis=1)
            assert np.abs(error[:, :, i].T - leap_and_error(turning, TIMES, start, WIDTHS, columns)[1]).max() < 1e-14


def test_transitions_are_accurate_where_few_columns_are_not_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    solution, found = solve(load("return-to-orbit"), examined=False), []
    for columns in (module.COLUMNS, (2, 5), (len(SUBSTEPS), len(SUBSTEPS))):
        monkeypatch.setattr(module, "COLUMNS", columns)
        one = segments(solution)
        assert one is not None
        found.append(one.transition)
    for one in found[:2]:
        assert np.abs(one - found[2]).max() < 1e-9


@pytest.mark.parametrize("columns", [4, 6])
def test_variations_are_the_derivatives_of_the_step_itself(columns: int) -> None:
    ends, whole, _ = leap_varied(swing, slopes, TIMES, STARTS, WIDTHS, columns)
    assert (ends == leap(swing, TIMES, STARTS, WIDTHS, columns)).all()
    for i in range(2):
        moved = STARTS.astype(complex)
        moved[i] += 1e-30j
        derivative = np.imag(leap(swing, TIMES, moved, WIDTHS, columns)) / 1e-30  # type: ignore[arg-type]
        assert np.abs(whole[:, :, i].T - derivative).max() < 1e-13
