"""Whatever is in a result or an instance, a command does its work or says in a line why not; samples of tests/bench."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import pytest

from tests.support.damage import DAMAGES

Bench = Callable[[str], ModuleType]


@pytest.fixture(scope="module")
def bench(repository: Path) -> Iterator[Bench]:
    """A module of tests/bench, which is no package."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(repository / "tests/bench")
        yield importlib.import_module


@pytest.fixture(scope="module")
def sound(bench: Bench, tmp_path_factory: pytest.TempPathFactory) -> Path:
    found: Path = bench("fuzz_results").made(tmp_path_factory.mktemp("sound"))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 20, 10))
def test_damaged_results_are_drawn_or_refused_in_a_line(
    bench: Bench, sound: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, first: int
) -> None:
    monkeypatch.setattr("satsym.report.plots.pictures", lambda *_: {})  # drawing takes long; tests/bench does draw
    tried = [bench("fuzz_results").tried(sound, seed, tmp_path) for seed in range(first, first + 10)]
    assert [faults for *_, faults in tried if faults] == []
    assert {code for _, code, _ in tried} >= {3}


def test_damages_are_refused_but_for_those_that_change_nothing_that_is_read(
    bench: Bench, sound: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("satsym.report.plots.pictures", lambda *_: {})
    always = {"bomb", "encrypted", "header_forged", "sparse_and_listed", "another_archive", "members_without_end"}
    assert always < {damage.__name__ for damage in DAMAGES}
    for name in sorted(always):
        damage = next(one for one in DAMAGES if one.__name__ == name)
        monkeypatch.setattr(bench("fuzz_results"), "damaged", lambda rng, folder, own=damage: own(rng, folder))
        assert bench("fuzz_results").tried(sound, 1, tmp_path)[1:] == (3, []), name


def test_what_a_bomb_promises_is_never_taken(sound: Path, tmp_path: Path) -> None:
    """By Python's own count: an array of 8 TB, and 30 MB of zeros in 30 kB."""
    import random
    import shutil
    import tracemalloc

    from satsym import instance
    from satsym.report.results import trajectory
    from satsym.status import BadInput
    from tests.support import damage

    case = instance.load("return-to-orbit-006")
    trajectory.read(case, sound)
    for one in (damage.bomb, damage.header_forged, damage.sparse_and_listed):
        folder = tmp_path / one.__name__
        shutil.copytree(sound, folder)
        one(random.Random(2), folder)
        tracemalloc.start()
        try:
            with pytest.raises(BadInput):
                trajectory.read(case, folder)
            assert tracemalloc.get_traced_memory()[1] < 2**24, one.__name__
        finally:
            tracemalloc.stop()


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 40, 20))
def test_instances_that_went_wrong_are_used_or_refused_in_a_line(bench: Bench, tmp_path: Path, first: int) -> None:
    tried = [bench("fuzz_instances").tried(seed, tmp_path) for seed in range(first, first + 20)]
    assert [(kind, faults) for kind, _, _, faults in tried if faults] == []


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, pytest.param(10, marks=pytest.mark.study)])
def test_kills_leave_the_old_result_or_the_new_one_and_nothing_for_long(bench: Bench, count: int) -> None:
    assert bench("kills").main(count, 3, draw=count > 1) == 0
