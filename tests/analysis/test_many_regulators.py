"""Many regulators at once are those of the design of one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from satsym import instance
from satsym.analysis.regulator import many
from satsym.analysis.regulator.feedback import designed
from satsym.instance import Instance

NAMES = ("geo-lqr", "uny-lqr", "uny-lqr-both")


def varied(name: str, count: int, width: float = 0.3) -> list[Instance]:
    """An instance with other parameters and initial states."""
    case, rng = instance.load(name), np.random.default_rng(1)
    found = []
    for _ in range(count):
        numbers = (
            np.array(row) * rng.uniform(1.0 - width, 1.0 + width, len(row)) for row in (case.parameters, case.initial)
        )
        parameters, initial = (tuple(row.tolist()) for row in numbers)
        found.append(replace(case, parameters=parameters, initial=initial))
    return found


@pytest.mark.parametrize("name", NAMES)
def test_gains_eigenvalues_and_costs_are_those_of_one(name: str) -> None:
    cases = varied(name, 12)
    found = many.regulators(cases)
    assert found is not None
    assert found.clear.all()
    for k, case in enumerate(cases):
        design = designed(case)
        one, deviation = design.regulator, design.deviation
        assert deviation is not None
        assert np.abs(found.K[k] - one.K).max() <= 1e-8 * np.abs(one.K).max()
        assert found.eigenvalues[k] == pytest.approx(one.eigenvalues, rel=1e-6)
        assert found.cost[k] == pytest.approx(one.cost(deviation), rel=1e-8)


def test_a_gain_that_is_hardly_wrong_is_not_clear(monkeypatch: pytest.MonkeyPatch) -> None:
    right = many.solve
    monkeypatch.setattr(many, "solve", lambda *given: (1.0001 * (found := right(*given))[0], *found[1:]))
    found = many.regulators(varied("uny-lqr", 3))
    assert found is not None
    assert not found.clear.any()


def test_what_has_no_regulator_is_left_to_the_design_of_one_and_spoils_no_other() -> None:
    cases = varied("geo-lqr", 4)
    spoilt = replace(cases[1], parameters=(float("nan"),) * len(cases[1].parameters))
    found = many.regulators([cases[0], spoilt, *cases[2:]])
    assert found is not None
    assert found.clear.tolist() == [True, False, True, True]
    case = instance.load("geo-lqr")
    assert case.lqr is not None
    finite = replace(case, lqr=replace(case.lqr, horizon=100.0))
    assert many.regulators([finite]) is None
    assert many.regulators([replace(case, lqr=None)]) is None
