"""Studies that are interrupted, resumed, or meet others: nothing that was computed is lost, mixed up, or differs."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from satsym import instance
from satsym.cli import main
from satsym.cli.saving import study_folder
from satsym.front.solution import simulate
from satsym.report import study as reports
from satsym.report.results import set_list, sets, studies
from satsym.report.results.files import text
from satsym.status import BadInput
from satsym.studies import parts, running, workers
from satsym.studies.asked import Study
from satsym.studies.asking import asked as asking
from satsym.studies.parts import Parts
from satsym.studies.rows import Row
from satsym.studies.running import Advance
from satsym.studies.workers import Workers
from tests.support.chunks import Backwards, Deadly, Here, failing, made, raising

NAME = "return-to-orbit"


def asked(rows: int = 6, high: float = 6.0, name: str = NAME, **more: Any) -> Study:
    written = instance.read(name)
    return asking(written, written.instance(), {"vary": {"initial.r": f"1:{high}:{rows}"}, **more}, name)


@contextmanager
def kept_in(folder: Path, study: Study | None = None) -> Iterator[Parts]:
    with parts.opened(folder, (study or asked()).digest) as kept:
        yield kept


def interrupted(folder: Path, study: Study, after: int) -> None:
    """A study that is broken off after so many chunks."""

    def stop(advance: Advance) -> None:
        if advance.done - advance.begun >= after * study.size:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        reports.carry_out(study, folder, lambda: Here(made), 1, resume=True, watch=stop)


def test_interruptions_and_the_order_of_chunks_change_no_byte(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "PAUSE", 0.0)
    study = asked(20, trajectories=True)
    reports.carry_out(study, tmp_path / "whole", Here, 1)
    for after in (1, 2):
        interrupted(tmp_path / "cut", study, after)
    with (tmp_path / "cut" / parts.LINES).open("ab") as stream:
        stream.write(b"0123456789abcdef {half a line")
    backwards, order = Backwards(), list[int]()
    append = Parts.append

    def noted(self: Parts, number: int, *more: Any) -> None:
        order.append(number)
        append(self, number, *more)

    monkeypatch.setattr(Parts, "append", noted)
    reports.carry_out(study, tmp_path / "cut", lambda: backwards, 9, resume=True, watch=backwards.release)
    assert order == [6, 5, 4, 3]
    for name in ("table.csv", "result.json", "study.json", "trajectories-000.npz"):
        assert (tmp_path / "cut" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes(), name
    left = {path.name for path in (tmp_path / "cut").iterdir()}
    assert left == {"table.csv", "result.json", "study.json", "trajectories-000.npz", "times.log"}
    with np.load(tmp_path / "cut/trajectories-000.npz") as stored:
        assert stored["19.x"][0, 0] == 6.0
        assert len(stored.files) == 20 * 4


def test_what_is_done_is_not_computed_again(tmp_path: Path) -> None:
    interrupted(tmp_path, asked(), 4)
    again, never = Here(), Here()
    before = reports.carry_out(asked(), tmp_path, lambda: again, 1, resume=True)
    assert again.given == [4, 5]
    assert reports.carry_out(asked(), tmp_path, lambda: never, 1, resume=True) == before
    assert not never.given
    (tmp_path / "result.json").write_text("{", encoding="utf-8")
    with pytest.raises(BadInput, match="`satsym study X --resume --out"):
        reports.draw(tmp_path)
    reports.carry_out(asked(), tmp_path, Here, 1, resume=True)
    (tmp_path / "table.csv").unlink()
    assert study_folder(str(tmp_path), None) == tmp_path
    with pytest.raises(BadInput, match="`satsym study X --resume --out"):
        reports.draw(tmp_path)
    assert reports.carry_out(asked(), tmp_path, lambda: never, 1, resume=True) == before
    assert len(never.given) == 6


def test_a_changed_study_is_refused_with_the_difference(tmp_path: Path) -> None:
    reports.carry_out(asked(2), tmp_path, Here, 1)
    before = (tmp_path / "result.json").read_bytes()
    with pytest.raises(BadInput, match=r"rows was 2 and is 3; vary initial.r was 1.0:6.0:2 and is 1.0:6.0:3"):
        reports.carry_out(asked(3), tmp_path, Here, 1, resume=True)
    with pytest.raises(BadInput, match="--resume"):
        reports.carry_out(asked(2), tmp_path, Here, 1)
    assert (tmp_path / "result.json").read_bytes() == before


def test_rows_of_another_study_are_never_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted(tmp_path / "a", asked(6), 4)
    (tmp_path / "a/study.json").unlink()
    before = (tmp_path / "a" / parts.LINES).read_bytes()
    with pytest.raises(BadInput, match="cases of another study"):
        reports.carry_out(asked(6, high=7.0), tmp_path / "a", Here, 1)
    assert (tmp_path / "a" / parts.LINES).read_bytes() == before
    opened = parts.opened

    def later(folder: Path, study: str) -> Any:
        """Another process comes in between the first look and the lock."""
        monkeypatch.undo()
        reports.carry_out(asked(6, high=7.0), folder, Here, 1)
        return opened(folder, study)

    monkeypatch.setattr(parts, "opened", later)
    with pytest.raises(BadInput, match="contains a study"):
        reports.carry_out(asked(6), tmp_path / "b", Here, 1)
    assert "7.0" in (tmp_path / "b/table.csv").read_text(encoding="utf-8")


def test_a_study_and_another_result_leave_each_other_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    solved, studied = tmp_path / "solved", tmp_path / "studied"
    sets.write(solved, {"command": "solve"}, {"trajectory.npz": text("t"), "case.toml": text("c")})
    never = Here()
    with pytest.raises(BadInput, match="contains the result of solve"):
        reports.carry_out(asked(), solved, lambda: never, 1, resume=True)
    assert not never.given
    assert {path.name for path in solved.iterdir()} == {"trajectory.npz", "case.toml", "result.json"}
    reports.carry_out(asked(), studied, Here, 1)
    for command in (["simulate", NAME], ["lqr", "geo-lqr"], ["solve", NAME]):
        assert main([*command, "--out", str(studied)]) == 3
        assert "contains the result of study" in capsys.readouterr().err
    assert sets.read(studied).command == "study"
    with pytest.raises(BadInput, match="contains the result of study"):
        simulate(NAME).save(studied)


@pytest.mark.parametrize("name", ["table.csv", "result.json"])
def test_a_file_of_somebody_else_is_not_written_over(name: str, tmp_path: Path) -> None:
    (tmp_path / "main.py").write_text("mine", encoding="utf-8")
    (tmp_path / name).write_text("mine", encoding="utf-8")
    never = Here()
    with pytest.raises(
        BadInput, match=f"contains {name}, which does not belong to a study; give another folder, or remove it"
    ):
        reports.carry_out(asked(), tmp_path, lambda: never, 1, resume=True)
    assert not never.given
    assert {path.name: path.read_text(encoding="utf-8") for path in tmp_path.iterdir()} == dict.fromkeys(
        ("main.py", name), "mine"
    )
    (tmp_path / name).unlink()
    reports.carry_out(asked(), tmp_path, Here, 1)
    assert (tmp_path / "main.py").read_text(encoding="utf-8") == "mine"


def test_a_damaged_line_is_computed_again(tmp_path: Path) -> None:
    interrupted(tmp_path, asked(), 5)
    lines = (tmp_path / parts.LINES).read_bytes().splitlines(keepends=True)
    lines[2] = lines[2].replace(b"converged", b"convergeD")
    (tmp_path / parts.LINES).write_bytes(b"".join(lines))
    with kept_in(tmp_path) as kept:
        assert sorted(kept.done) == [0, 1]


def test_only_the_row_that_kills_its_workers_is_lost_and_tried_again_by_resuming(tmp_path: Path) -> None:
    study, lines = asked(24, high=24.0), list[str]()
    assert study.size == 3
    with kept_in(tmp_path, study) as kept:
        running.run(study, kept, Deadly(), 2, log=lines.append)
        found = [row for number in range(study.chunks) for row in kept.read(number).rows]
    assert [k for k, row in enumerate(found) if row.status == "worker died"] == [4]
    assert [row.numbers["objective"] for row in found[:4]] == [2.0, 4.0, 6.0, 8.0]
    assert sum("died" in line for line in lines) == 2 * running.MOST_DEATHS
    again = Here()
    whole = reports.carry_out(study, tmp_path, lambda: again, 1, resume=True)
    assert again.given == [1]
    assert whole["statuses"] == {"converged": 24}


def test_processes_that_die_are_replaced_whether_they_are_at_something_or_not() -> None:
    def broken(*_: object) -> None:
        raise BrokenExecutor  # as a pool does that has seen its process die

    with Workers(1) as workers:
        first, pool = workers.submit(os.getpid).result(), workers._all[0].pool
        workers._all[0] = replace(workers._all[0], pool=SimpleNamespace(submit=broken))
        second = workers.submit(os.getpid).result()
        assert isinstance(workers.submit(os._exit, 9).exception(), BrokenExecutor)
        third = workers.submit(os.getpid).result()
        pool.shutdown()
    assert len({first, second, third, os.getpid()}) == 4


def test_processes_give_the_bytes_that_this_one_gives(tmp_path: Path) -> None:
    vary = ["--vary", "initial.r=42000:42200:4"]
    assert main(["study", "geo-lqr", "--command", "lqr", *vary, "--out", str(tmp_path / "a"), "--workers", "2"]) == 0
    written = instance.read("geo-lqr")
    said = {"command": "lqr", "vary": {"initial.r": "42000:42200:4"}}
    study = asking(written, written.instance(), said, "geo-lqr")
    reports.carry_out(study, tmp_path / "b", lambda: Here(None), 1)
    for name in ("table.csv", "result.json", "study.json"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name


@pytest.mark.parametrize("status", ["worker died", "time limit"])
def test_rows_that_another_run_may_answer_are_tried_again_though_the_study_was_done(
    tmp_path: Path, status: str
) -> None:
    study, lost = asked(), [Row("", status, "")]
    found = reports.carry_out(study, tmp_path, lambda: Here(lambda _, c: lost if c.number == 2 else made(_, c)), 1)
    assert found["statuses"] == {"converged": 5, status: 1}
    again = Here()
    assert reports.carry_out(study, tmp_path, lambda: again, 1, resume=True)["statuses"] == {"converged": 6}
    assert again.given == [2]
    assert not (tmp_path / parts.LINES).exists()


def test_a_mistake_of_ours_ends_the_study(tmp_path: Path) -> None:
    with kept_in(tmp_path) as kept, pytest.raises(RuntimeError, match="a mistake"):
        running.run(asked(), kept, Here(raising), 1)


def test_a_full_disk_is_one_line_and_what_was_written_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real, count = os.fsync, iter(range(100))

    def full(handle: int) -> None:
        if next(count) == 5:
            raise OSError(28, "No space left on device")
        real(handle)

    monkeypatch.setattr(parts.os, "fsync", full)
    with pytest.raises(BadInput, match=r"No space left on device.*--resume"):
        reports.carry_out(asked(), tmp_path, Here, 1)
    monkeypatch.undo()
    with kept_in(tmp_path) as kept:
        assert 1 <= len(kept.done) < 6
    assert reports.carry_out(asked(), tmp_path, Here, 1, resume=True)["statuses"] == {"converged": 6}


def test_trajectories_go_into_files_of_a_size_and_none_is_begun_without_room(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = asked(24, trajectories=True)
    monkeypatch.setattr(studies, "FILES", 4)
    monkeypatch.setattr(studies, "LARGEST_FILE", 1)
    reports.carry_out(study, tmp_path / "a", Here, 1)
    files = sorted((tmp_path / "a").glob("trajectories-*.npz"))
    assert [path.name for path in files] == [f"trajectories-00{k}.npz" for k in range(4)]
    assert sorted(k for path in files for k in _rows(path)) == list(range(24))
    monkeypatch.setattr(reports.shutil, "disk_usage", lambda _: SimpleNamespace(free=10**6))
    with pytest.raises(BadInput, match=r"trajectories of 24 cases need .* GB"):
        reports.carry_out(study, tmp_path / "b", Here, 1)
    assert not (tmp_path / "b").exists()
    listing = {"command": "study", "files": {"table.csv": {"bytes": 2**40, "sha256": "0"}}}
    (tmp_path / "result.json").write_text(json.dumps(listing), encoding="utf-8")
    assert set_list.decoded(tmp_path / "result.json")[2]["table.csv"].bytes == 2**40


def _rows(path: Path) -> set[int]:
    with np.load(path) as stored:
        return {int(name.partition(".")[0]) for name in stored.files}


def test_two_processes_cannot_be_at_one_study(tmp_path: Path) -> None:
    with kept_in(tmp_path), pytest.raises(BadInput, match="is in use by another process"), kept_in(tmp_path):
        pass


def test_a_study_that_is_interrupted_says_how_to_go_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(reports, "carry_out", interrupt)
    assert main(["study", NAME, "--vary", "initial.r=0.9:1.1:4", "--out", str(tmp_path)]) == 130
    assert capsys.readouterr().err.splitlines() == ["satsym: interrupted; repeat the command with --resume to continue"]


def test_it_is_said_how_far_a_study_is(tmp_path: Path) -> None:
    seen: list[Advance] = []
    with kept_in(tmp_path) as kept:
        running.run(asked(4), kept, Here(failing), 1, seen.append)
    assert [(one.done, one.failures) for one in seen] == [(k, k) for k in range(5)]
    assert seen[-1].left == 0.0
    assert Advance(2, 0, 6, 1, 0.5).rate == 2.0
    assert Advance(2, 0, 6, 1, 0.5).left == 2.0


KILLED = """
import os, signal, sys
from pathlib import Path
from satsym.report import study as reports
from satsym.studies import parts
from tests.studies.test_interruptions import asked
from tests.support.chunks import Here
write, left = parts._write, iter(range(int(sys.argv[2])))
def dying(stream, content):
    if next(left, None) is None:
        stream.write(content[: len(content) // 2])
        stream.flush()
        os.kill(os.getpid(), signal.SIGKILL)
    write(stream, content)
parts._write = dying
reports.carry_out(asked(40, trajectories=True), Path(sys.argv[1]), Here, 1, resume=True)
"""
"""Ends itself in the middle of one of its writes, of which there are two for each chunk."""


@pytest.mark.parametrize(
    "moments", [[5], pytest.param([0, 1, 2, 3, 2, 0, 1, 2, 1, 0, 3, 1], marks=pytest.mark.study)], ids=["once", "often"]
)
def test_killed_in_the_middle_of_writing_no_finished_chunk_is_lost(tmp_path: Path, moments: list[int]) -> None:
    study, expected = asked(40, trajectories=True), 0
    for moment in moments:
        command = [sys.executable, "-c", KILLED, str(tmp_path / "cut"), str(moment)]
        assert subprocess.run(command, check=False).returncode == -signal.SIGKILL
        expected += moment // 2
        with kept_in(tmp_path / "cut", study) as kept:
            assert sorted(kept.done) == list(range(expected))
    reports.carry_out(study, tmp_path / "cut", Here, 1, resume=True)
    reports.carry_out(study, tmp_path / "whole", Here, 1)
    for name in ("table.csv", "result.json", "trajectories-000.npz"):
        assert (tmp_path / "cut" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes(), name


ORPHANED = """
import os, signal
from satsym.studies.workers import Workers
workers = Workers(2)
assert workers.submit(abs, -1).result() == 1
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.slow
def test_a_study_that_is_killed_says_nothing_of_what_is_cleaned_up_behind_it() -> None:
    done = subprocess.run([sys.executable, "-c", ORPHANED], capture_output=True, check=False, timeout=60)
    assert (done.returncode, done.stderr) == (-signal.SIGKILL, b"")


class Client:
    """Of a cluster that does not answer as one does, or has no workers."""

    def __init__(self, address: str, **_: Any) -> None:
        if "idle" not in address:
            raise OSError

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None: ...

    def nthreads(self) -> dict[str, int]:
        return {}


def test_a_scheduler_is_asked_for_only_where_something_listens() -> None:
    """For the client of Dask that waits in vain complains again when it is removed."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert all(workers._listens(one) for one in (f"tcp://127.0.0.1:{port}", f"127.0.0.1:{port}"))
    assert not workers._listens(f"tcp://127.0.0.1:{port}")


@pytest.mark.parametrize(
    ("address", "line"),
    [
        ("", "pip install 'satsym[cluster]'"),
        ("nowhere", "no Dask scheduler answers there"),
        ("tcp://127.0.0.1:99999", "no Dask scheduler answers there"),
        ("inproc://another", "no Dask scheduler answers there"),
        ("inproc://idle", "has no workers"),
    ],
)
def test_no_cluster_is_one_line_and_writes_nothing(
    address: str, line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def imported(_: str) -> Any:
        if not address:
            raise ImportError
        return SimpleNamespace(Client=Client)

    monkeypatch.setattr(workers, "import_module", imported)
    out = tmp_path / "out"
    wanted = ["study", NAME, "--vary", "initial.r=0.9:1.1:4", "--out", str(out), "--scheduler", address or "any"]
    assert main(wanted) == 3
    said = capsys.readouterr().err
    assert line in said
    assert len(said.splitlines()) == 1
    assert not out.exists()


@pytest.mark.study
def test_a_cluster_whose_worker_is_killed_gives_the_same_bytes(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    more = {"command": "lqr", "name": "geo-lqr", "high": 2.0}
    reports.carry_out(asked(24, **more), tmp_path / "here", lambda: Here(None), 1)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as local,
        workers.cluster(local.scheduler_address) as (executor, at_once),
    ):
        killed: list[int] = []

        def kill(advance: Advance) -> None:
            if advance.done >= 3 and not killed:
                killed.append(next(iter(local.workers.values())).process.pid)
                os.kill(killed[0], signal.SIGKILL)

        reports.carry_out(asked(24, **more), tmp_path / "there", lambda: executor, at_once, watch=kill)
    assert killed
    assert (tmp_path / "there/table.csv").read_bytes() == (tmp_path / "here/table.csv").read_bytes()
