"""What is known is not evaluated again, and what leads nowhere is given up: counted, not timed."""

from __future__ import annotations

from itertools import accumulate, repeat

import numpy as np
import pytest

from satsym.solvers.control.corners import enclosed
from satsym.solvers.switching.newton import MOST_STEPS, SETTLED_CORRECTION, _too_slow


def test_zeros_are_enclosed_to_the_last_digits_in_few_evaluations():
    calls = []

    def values(times):
        calls.append(times)
        return np.array([np.cos(times[0]), np.exp(times[1]) - 2.0, (times[2] - 0.1) ** 3])

    low, high = np.array([1.0, 0.0, 0.0]), np.array([2.0, 1.0, 1.0])
    at_low, at_high = values(low), values(high)
    calls.clear()
    found = enclosed(values, low, high, at_low, at_high)
    assert found[:2] == pytest.approx([np.pi / 2.0, np.log(2.0)], rel=1e-15)
    assert found[2] == pytest.approx(0.1, abs=1e-5)  # a triple zero is known to a third of the digits
    calls.clear()
    enclosed(lambda times: values(np.append(times, 0.5))[:2], low[:2], high[:2], at_low[:2], at_high[:2])
    assert len(calls) <= 9


def test_fewer_evaluations_find_rougher_zeros():
    calls = []

    def values(times):
        calls.append(times)
        return np.cos(times)

    ends = np.array([1.0]), np.array([2.0])
    found = enclosed(values, *ends, *map(np.cos, ends), within=1e-3)
    rough = len(calls)
    enclosed(values, *ends, *map(np.cos, ends))
    assert found == pytest.approx(np.pi / 2.0, abs=1e-3)
    assert rough < len(calls) - rough


def test_corrections_that_shrink_too_slowly_to_settle_are_given_up_early_and_faster_ones_never():
    slow = list(accumulate(repeat(0.6, MOST_STEPS), lambda size, factor: size * factor, initial=8e-3))
    assert any(_too_slow([np.inf, *slow[:k]]) for k in range(4, 7))
    enough = (SETTLED_CORRECTION / 8e-3) ** (1.0 / MOST_STEPS) / 2.0
    evenly = [8e-3 * enough**k for k in range(MOST_STEPS)]
    squared = [5e-3, 2.5e-3, 6e-4, 4e-5, 1.6e-7]
    for fast in (evenly, squared):
        assert not any(_too_slow([np.inf, *fast[:k]]) for k in range(1, len(fast) + 1))
