"""Sets of files: whoever stops a replacement, and whenever, a reader finds all of the old set or all of the new one."""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

import pytest

from satsym.report.results import files, set_list, sets
from satsym.status import BadInput
from tests.support.damage import signed

OLD = {"a": "old a", "b": "old b", "only": "old only"}
NEW = {"a": "new a", "b": "new b", "fresh": "new fresh"}


class Killed(BaseException):
    """Stands for a kill: nothing is cleaned up after it, because every later step raises it too."""


def write(folder: Path, content: dict[str, str], **result: Any) -> list[Path]:
    return sets.write(folder, result, {name: files.text(one) for name, one in content.items()})


def seen(folder: Path) -> dict[str, str]:
    """What a reader finds."""
    return {name: content.decode() for name, content in sets.read(folder, [*OLD, *NEW]).contents.items()}


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


STEPS = {
    "mkdir": (Path, "mkdir"),
    "store": (sets, "store"),
    "rename": (Path, "rename"),
    "unlink": (Path, "unlink"),
    "replace": (Path, "replace"),
    "rmtree": (shutil, "rmtree"),
}


@pytest.fixture
def killed_at(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], list[int]]:
    """Kill the process, as it were, before a step that changes the file system; counts these steps."""

    def arm(number: int) -> list[int]:
        count = [0]

        def wrapped(step: Callable[..., Any]) -> Callable[..., Any]:
            def run(*arguments: Any, **options: Any) -> Any:
                count[0] += 1
                if count[0] > number:
                    raise Killed
                return step(*arguments, **options)

            return run

        for place, name in STEPS.values():
            monkeypatch.setattr(place, name, wrapped(getattr(place, name)))
        return count

    return arm


@pytest.mark.parametrize("number", range(14))
def test_a_kill_before_any_step_leaves_the_old_set_or_the_new(
    tmp_path: Path, killed_at: Callable[[int], list[int]], monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    write(tmp_path, OLD)
    (tmp_path / "mine").touch()
    count = killed_at(number)
    try:
        write(tmp_path, NEW)
        finished = True
    except Killed:
        finished = False
    monkeypatch.undo()
    assert finished == (count[0] <= number)
    found = seen(tmp_path)
    assert found == NEW if finished else found in (OLD, NEW)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert seen(tmp_path) == found
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before  # reading changes none
    write(tmp_path, {"a": "last"})
    assert names(tmp_path) == {"a", "mine", "result.json"}
    assert seen(tmp_path) == {"a": "last"}


def test_kills_were_tried_at_every_step(tmp_path: Path, killed_at: Callable[[int], list[int]]) -> None:
    """The test above ends after the last of them: old, both and new results of a kill are among its cases."""
    write(tmp_path, OLD)
    count = killed_at(1000)
    write(tmp_path, NEW)
    assert count[0] == 13


def breaking(stream: IO[bytes]) -> None:
    stream.write(b"half")
    raise OSError(28, "No space left on device")


def interrupted(stream: IO[bytes]) -> None:
    stream.write(b"half")
    raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("content", "error"), [(breaking, BadInput), (interrupted, KeyboardInterrupt)], ids=["disk full", "interrupted"]
)
def test_files_that_cannot_be_finished_leave_the_old_ones(
    tmp_path: Path, content: files.Content, error: type[BaseException]
) -> None:
    write(tmp_path, OLD)
    with pytest.raises(error):
        sets.write(tmp_path, {}, {"a": files.text("new"), "b": content})
    assert seen(tmp_path) == OLD
    assert names(tmp_path) == {*OLD, "result.json"}


def test_files_are_as_readable_as_any_other(tmp_path: Path) -> None:
    (tmp_path / "plain").touch()
    write(tmp_path, OLD)
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_only_what_an_earlier_list_names_is_removed(tmp_path: Path) -> None:
    write(tmp_path, OLD)
    (tmp_path / "notes").write_text("mine")
    (tmp_path / "only").write_text("written over by its user, hence theirs")
    write(tmp_path, NEW)
    assert names(tmp_path) == {*NEW, "only", "notes", "result.json"}


@pytest.mark.parametrize(
    "name", ["../outside", "/etc/passwd", "", ".", "..", ".hidden", "a\\b", "result.json", "x" * 101]
)
def test_a_list_reaches_nothing_outside_its_folder(tmp_path: Path, name: str) -> None:
    (tmp_path / "outside").write_text("theirs")
    folder = tmp_path / "folder"
    write(folder, OLD)
    listed = json.loads((folder / "result.json").read_text())
    listed["files"] = {name: {"bytes": 6, "sha256": set_list.listed_as(tmp_path / "outside").sha256}}
    (folder / "result.json").write_text(json.dumps(listed))
    with pytest.raises(BadInput, match="lists files that are not part of a result"):
        sets.read(folder)
    write(folder, NEW)
    assert (tmp_path / "outside").read_text() == "theirs"


def made_pipe(path: Path) -> None:
    path.unlink(missing_ok=True)
    os.mkfifo(path)


@pytest.mark.parametrize(
    "damage",
    [
        lambda path: path.unlink(),
        lambda path: path.write_text("other"),
        lambda path: path.write_text("old A"),
        lambda path: (path.unlink(), path.mkdir()),
        made_pipe,
        lambda path: (path.unlink(), path.symlink_to("/dev/zero")),
        lambda path: (path.unlink(), path.symlink_to(path)),
    ],
    ids=["missing", "longer", "of the same size", "a folder", "a pipe", "a device", "a loop"],
)
def test_a_set_that_does_not_match_its_list_is_refused(tmp_path: Path, damage: Callable[[Path], object]) -> None:
    write(tmp_path, OLD)
    damage(tmp_path / "a")
    with pytest.raises(BadInput, match=r"a: is listed in result\.json, but is missing or has changed"):
        sets.read(tmp_path)


@pytest.mark.parametrize(
    "damage",
    [
        lambda path: path.mkdir(),
        made_pipe,
        lambda path: path.symlink_to("/dev/zero"),
        lambda path: path.write_text('{"model": "x"}'),
        lambda path: path.write_bytes(b" " * (2**24 + 1)),
        lambda path: path.write_text("[" * 100_000),
        lambda path: path.write_text('{"files": {"a": {"bytes": 1e99, "sha256": ""}}}'),
    ],
    ids=["a folder", "a pipe", "a device", "no list", "endless", "deep", "huge"],
)
def test_a_list_that_is_none_is_refused(tmp_path: Path, damage: Callable[[Path], object]) -> None:
    damage(tmp_path / "result.json")
    with pytest.raises(BadInput, match=r"result\.json: "):
        sets.read(tmp_path)


def test_a_folder_in_the_place_of_a_file_is_refused_before_anything_changes(tmp_path: Path) -> None:
    write(tmp_path, OLD)
    (tmp_path / "fresh").mkdir()
    with pytest.raises(BadInput, match="fresh: is a folder"):
        write(tmp_path, NEW)
    assert seen(tmp_path) == OLD
    assert names(tmp_path) == {*OLD, "fresh", "result.json"}


def test_a_set_that_is_added_to_keeps_its_files_and_its_time(tmp_path: Path) -> None:
    write(tmp_path, OLD, status="converged")
    os.utime(tmp_path / "result.json", ns=(10**18, 10**18))
    written = sets.extend(sets.read(tmp_path), {"b": files.text("other"), "fresh": files.text("new fresh")})
    assert [path.name for path in written] == ["b", "fresh"]
    assert seen(tmp_path) == OLD | {"b": "other", "fresh": "new fresh"}
    assert sets.written_at(tmp_path) == 10**18
    assert json.loads((tmp_path / "result.json").read_text())["status"] == "converged"


def test_nothing_is_added_to_a_set_that_was_replaced_meanwhile(tmp_path: Path) -> None:
    write(tmp_path, OLD)
    found = sets.read(tmp_path)
    write(tmp_path, NEW)
    with pytest.raises(BadInput, match="was rewritten in the meantime"):
        sets.extend(found, {"fresh": files.text("late")})
    assert seen(tmp_path) == NEW


def test_who_finds_a_folder_in_use_waits_and_then_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path, OLD)
    monkeypatch.setattr(sets, "PATIENCE", 0.1)
    with sets.locked(tmp_path):
        with pytest.raises(BadInput, match="is in use by another process"):
            write(tmp_path, NEW)
        with pytest.raises(BadInput, match="is in use by another process"):
            seen(tmp_path)
    with sets.locked(tmp_path, shared=True):
        assert seen(tmp_path) == OLD


WRITER = """
import sys, time
from pathlib import Path
from satsym.report.results import files, sets
print(flush=True)
while True:
    time.sleep(0.03)  # so that the other has its turn
    sets.write(Path(sys.argv[1]), {}, {name: files.text(sys.argv[2] * 9999) for name in "abcdefgh"[: int(sys.argv[3])]})
"""


def test_a_reader_beside_two_writers_always_finds_one_whole_set(tmp_path: Path) -> None:
    write(tmp_path, OLD)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    commands = [[sys.executable, "-c", WRITER, str(tmp_path), *each] for each in (("1", "5"), ("2", "8"))]
    writers = [subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL) for command in commands]
    try:
        found: set[frozenset[str]] = set()
        until = time.monotonic() + 20.0
        while time.monotonic() < until and len(found) < 2:
            contents = sets.read(tmp_path, "abcdefgh").contents
            if contents.keys() != OLD.keys() & set("ab"):
                assert (len(contents), {one[:1] for one in contents.values()}) in ((5, {b"1"}), (8, {b"2"}))
                found.add(frozenset(contents))
        assert all(writer.poll() is None for writer in writers)
    finally:
        for writer in writers:
            writer.kill()
            writer.wait()
    assert len(found) == 2


def kinds_after_kills(folder: Path, kills: int) -> list[int]:
    """Kill processes that replace sets without end, at random moments; how many files were found each time."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    rng, found = random.Random(1), []
    for number in range(kills):
        command = [sys.executable, "-c", WRITER, str(folder), "12"[number % 2], "58"[number % 2]]
        with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE) as writer:
            assert writer.stdout is not None
            writer.stdout.readline()
            time.sleep(rng.uniform(0.0, 0.1))
            writer.kill()
        contents = sets.read(folder, "abcdefgh").contents
        kind = (len(contents), {one[:1] for one in contents.values()})
        assert kind in ((2, {b"o"}), (5, {b"1"}), (8, {b"2"})), number
        found.append(len(contents))
    return found


def test_a_kill_at_any_moment_of_writing_leaves_one_whole_set(tmp_path: Path) -> None:
    """Whole runs are killed in tests/bench/kills.py."""
    write(tmp_path, OLD)
    (tmp_path / "mine").touch()
    assert len(kinds_after_kills(tmp_path, 8)) == 8  # how far each came is the machine's
    write(tmp_path, NEW)
    assert names(tmp_path) == {*NEW, "mine", "result.json"}


def test_a_place_that_cannot_be_written_to_is_a_clear_line(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(BadInput, match=r"cannot be written \(Not a directory\)"):
        write(tmp_path / "file" / "folder", NEW)


def test_a_signed_set_is_read(tmp_path: Path) -> None:
    write(tmp_path, OLD)
    (tmp_path / "a").write_text("changed, and signed")
    signed(tmp_path)
    assert seen(tmp_path)["a"] == "changed, and signed"
