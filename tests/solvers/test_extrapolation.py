"""Integration by extrapolation: many motions at once, each over its own time, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from satsym.arrays import Array
from satsym.solvers.simulation.extrapolation import NotFinite, integrate, integrate_each

RATES = np.array([0.3, 2.0, 11.0])


def rates(t: Array, y: Array) -> Array:
    """Return the rates of oscillators whose third component is their frequency."""
    return np.array([y[1], -(y[2] ** 2) * y[0] + 0.0 * t, np.zeros_like(t)])


def test_each_motion_ends_at_its_own_time_on_its_closed_form() -> None:
    begins, ends = np.array([0.0, 1.0, 4.0]), np.array([7.0, 3.5, 1.0])  # the last one backwards
    starts = np.array([[1.0, 1.0, 1.0], [0.0, 0.0, 0.0], RATES])
    found = integrate_each(rates, begins, ends, starts, 1e-13, np.array([1.0, 11.0, 11.0]))
    for one, begin, end, rate in zip(found, begins, ends, RATES, strict=True):
        assert (one.times[0], one.times[-1]) == (begin, end)
        phase = rate * (one.times - begin)
        np.testing.assert_allclose(one.values[:, 0], np.cos(phase), rtol=0.0, atol=1e-11)
        np.testing.assert_allclose(one.values[:, 1], -rate * np.sin(phase), rtol=0.0, atol=1e-10)


def test_a_fast_motion_does_not_change_a_slow_one() -> None:
    size = np.array([1.0, 11.0, 11.0])
    slow = np.array([1.0, 0.0, 0.3])
    (alone,) = integrate(rates, np.array([0.0, 7.0]), slow, 1e-13, size)
    both = integrate_each(rates, np.zeros(2), np.full(2, 7.0), np.array([slow, [1.0, 0.0, 11.0]]).T, 1e-13, size)
    np.testing.assert_allclose(both[0].end, alone.end, rtol=0.0, atol=1e-12)
    assert len(both[1].times) > len(both[0].times)


def test_a_motion_that_becomes_infinite_is_an_error() -> None:
    """The solution of y' = y^2 from 1 is 1/(1 - t)."""
    begins, ends = np.zeros(2), np.array([0.5, 1.5])
    with np.errstate(all="ignore"), pytest.raises(NotFinite):
        integrate_each(lambda t, y: y**2, begins, ends, np.ones((1, 2)), 1e-12, np.ones(1))
    (found,) = integrate_each(lambda t, y: y**2, begins[:1], ends[:1], np.ones((1, 1)), 1e-12, np.ones(1))
    assert found.end[0] == pytest.approx(2.0, rel=1e-11)
