"""Kept machine code: what was used longest ago goes, and never what is made."""

from __future__ import annotations

import os
from pathlib import Path

from satsym import user_cache


def folders(parent: Path, count: int) -> list[Path]:
    """Of a thousand bytes each, the first used longest ago."""
    made = []
    for k in range(count):
        (one := parent / f"model-{k}").mkdir(parents=True)
        (one / "columns.py").write_bytes(b" " * 1000)
        os.utime(one, (k + 1.0, k + 1.0))
        made.append(one)
    return made


def test_what_was_used_longest_ago_is_removed(tmp_path: Path) -> None:
    made = folders(tmp_path, 5)
    user_cache.used(made[0])
    user_cache.prune(tmp_path, 3500, made[4])
    assert [one.exists() for one in made] == [True, False, False, True, True]


def test_what_is_made_stays_however_large(tmp_path: Path) -> None:
    made = folders(tmp_path, 3)
    user_cache.prune(tmp_path, 10, made[0])
    assert [one.exists() for one in made] == [True, False, False]
    user_cache.prune(tmp_path / "nowhere", 10, made[0])
