"""Derivations that tests share come back as they were made, and only from the engine that made them."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp

from satsym.report import stamps
from tests.support import derived as shared
from tests.support.switching_models import MINIMUM_TIME, ROCKET

x, y = sp.symbols("x y")


@pytest.fixture
def engine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """No derivation is kept yet, neither here nor in this process; and what counts how often one is made."""
    monkeypatch.setattr(shared, "_HOME", tmp_path)
    forget(monkeypatch)
    return monkeypatch


def forget(patch: pytest.MonkeyPatch) -> None:
    """As in another process."""
    patch.setattr(shared, "_KNOWN", {})
    shared._folder.cache_clear()


def test_what_is_kept_is_found_again_until_the_engine_changes(engine: pytest.MonkeyPatch) -> None:
    made = shared.derived(ROCKET)
    forget(engine)
    with engine.context() as patch:
        patch.setattr(shared, "derive", lambda _: pytest.fail("derived once more"))
        assert shared.derived(ROCKET) == made
        with pytest.raises(pytest.fail.Exception):
            shared.derived(replace(ROCKET, running_cost=2 * ROCKET.running_cost))
        patch.setattr(stamps, "engine", lambda: "another")
        forget(patch)
        with pytest.raises(pytest.fail.Exception):
            shared.derived(ROCKET)
    shared._folder.cache_clear()


def test_expressions_come_back_as_they_stand(engine: pytest.MonkeyPatch) -> None:
    whole = sp.Mul(2, x + y, evaluate=False)
    assert pickle.loads(pickle.dumps(whole)) != whole  # sympy's own way
    made = shared.derived(MINIMUM_TIME)
    (first, *rest), step = made.steps[0].equations, made.steps[0]
    odd = replace(made, steps=(replace(step, equations=(replace(first, rhs=whole), *rest)), *made.steps[1:]))
    shared._keep("odd", odd)
    found = shared._kept("odd")
    assert found == odd
    assert found.steps[0].equations[0].rhs.args == (2, x + y)
