"""Instances made in Python."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
import sympy

import satsym
from satsym import instance
from satsym.front import tables
from tests.support.front import PUSH, pushed, q, v


def test_numbers_of_any_library_symbols_and_units_are_understood() -> None:
    plain = satsym.Instance.of(PUSH, initial={"q": 1.0, "v": 2.0}, tf=3.0, control={"a": [-1.0, 1.0]})
    other = satsym.Instance.of(
        PUSH,
        initial={q: np.float32(1.0), v: sympy.Integer(2)},
        tf="3000 ms",
        control={"a": np.array([-1, 1])},
        final=None,
    )
    for name in ("initial", "final", "t0", "tf", "lower", "upper", "parameters"):
        assert getattr(other.case, name) == getattr(plain.case, name)


def test_changes_are_merged_and_none_takes_away() -> None:
    case = pushed()
    changed = case.with_(initial={"v": 0.5}, final={v: None}, tf=3, solver={"steps": 20}, control=None)
    assert changed.case.initial == (0.0, 0.5)
    assert dict(changed.case.final) == {"q": 1.0}
    assert (changed.case.tf, changed.case.solver.steps) == (3.0, 20)
    assert np.isinf(changed.case.upper).all()
    assert case.case.final.keys() == {"q", "v"}
    freed = case.with_(tf="free", tf_guess=2, t0=1.0)
    assert (freed.case.tf, freed.case.tf_guess, freed.case.t0) == (None, 2.0, 1.0)
    assert changed.case.model is case.case.model


def test_another_model_may_be_put_in() -> None:
    from dataclasses import replace

    other = replace(PUSH, name="sled_free", control_set="free")
    changed = pushed().with_(model=other, control=None, name="again")
    assert (changed.model, changed.name) == ("sled_free", "again")
    assert "sled_free" in changed.to_toml()


@pytest.mark.parametrize("name", instance.shipped())
def test_every_shipped_instance_survives_being_written_anew(name: str, tmp_path: Path) -> None:
    given = satsym.load(name)
    path = tmp_path / f"{name}.toml"
    path.write_text(given.to_toml(), encoding="utf-8")
    again = instance.load(path)
    fields = [field for field in again.__dataclass_fields__ if field not in ("path", "model")]
    assert {f: getattr(again, f) for f in fields} == {f: getattr(given.case, f) for f in fields}
    assert again.model is given.case.model


def test_texts_with_quotes_backslashes_and_letters_of_any_script_are_written_soundly(tmp_path: Path) -> None:
    title = 'a "quoted" \\ backslash, θ̇ → \U0001f6f0'
    path = tmp_path / "case.toml"
    path.write_text(satsym.load("soft-return").with_(title=title).to_toml(), encoding="utf-8")
    assert instance.load(path).title == title


def test_instances_of_ones_own_problem_reach_other_processes() -> None:
    case = pickle.loads(pickle.dumps(pushed()))
    state = (0.0, (0.1, 0.2), (0.3,), (0.1,))
    assert case.case.model.dynamics(*state) == pushed().case.model.dynamics(*state)
    assert case.case.initial == pushed().case.initial


def test_what_is_no_value_of_a_file_stays_to_be_refused() -> None:
    assert tables.plain({"q": 1j, "v": b"1", "w": None}) == {"q": 1j, "v": b"1"}
    assert tables.plain(np.bool_(True)) is True
    assert tables.plain((np.float64(1.5), [np.int8(2)])) == [1.5, [2]]


def test_it_is_solved_again_and_again() -> None:
    repeated = satsym.load("return-to-orbit").repeated(compiled=False)
    answer = repeated.solve(initial=(1.12, 0.0, 0.0, 0.9))
    alone = satsym.solve(satsym.load("return-to-orbit").with_(initial={"r": 1.12}))
    assert answer.objective == pytest.approx(alone.objective, rel=1e-9)
