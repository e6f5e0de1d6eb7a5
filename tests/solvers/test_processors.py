"""Verdicts do not depend on the processor: a sample of `make test-processors`, and that it sees a difference."""

from __future__ import annotations

import pytest

from tests.bench import processors


def test_verdicts_are_the_same_with_other_kernels(capsys: pytest.CaptureFixture[str]) -> None:
    assert processors.run(list(processors.SAMPLE)) == 0
    assert "no difference" in capsys.readouterr().out


def test_every_case_that_is_sampled_is_one() -> None:
    assert set(processors.SAMPLE) <= processors.cases().keys()
    assert len(processors.cases()) >= 70


def test_a_difference_is_seen() -> None:
    one = {"status": "converged", "verdict": "certified", "objective": 2.0}
    assert processors.differs(one, dict(one)) == []
    assert processors.differs(one, {**one, "objective": 2.0 * (1.0 + 1e-9)}) == []
    for key, value in (("status", "infeasible"), ("verdict", "extremal only"), ("objective", 2.0000004)):
        assert len(processors.differs(one, {**one, key: value})) == 1, key
    assert len(processors.differs(one, {**one, "objective": float("nan")})) == 1
