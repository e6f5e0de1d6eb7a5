"""Studies: what is asked, what is kept, and that nothing that was computed is lost or differs."""

from __future__ import annotations

import csv
import json
import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satsym import instance, solvers
from satsym.cli import main
from satsym.front.analysing import lqr
from satsym.front.instance import load
from satsym.front.studies import study
from satsym.report import study as reports
from satsym.report.results.studies import telling
from satsym.status import BadInput
from satsym.studies import cluster, parts, reading, running
from satsym.studies.asked import Checked, Study
from satsym.studies.design import Grid, Sample
from satsym.studies.reading import Written
from satsym.studies.workers import Workers
from tests.support.chunks import deadly_in_one, quick, raising

NAME = "return-to-orbit"


def asked(rows: int = 6, **more: Any) -> Study:
    case = instance.load(NAME)
    design = reading.design(Written(vary=[("initial.r", f"0.9:1.1:{rows}")]), case)
    return Study(case, design, checked=Checked.NONE, **more)


def threads() -> ThreadPoolExecutor:
    """In this process, which is quicker to begin."""
    return ThreadPoolExecutor(1)


def table(folder: Path) -> list[dict[str, str]]:
    with (folder / "table.csv").open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_each_row_is_what_solving_it_alone_gives(tmp_path: Path) -> None:
    vary = {"initial.r": (0.95, 1.1, 3), "parameters.c1": "log:1:10:2"}
    found = study(NAME, tmp_path, vary=vary, executor=threads, workers=1)
    assert len(found["row"]) == 6
    assert set(found["verdict"]) == {"local minimum"}
    assert np.allclose(found["parameters.c1"], [1.0, 10.0] * 3, rtol=1e-15)
    for k in (0, 3, 5):
        case = load(NAME).with_(initial={"r": found["initial.r"][k]}, parameters={"c1": found["parameters.c1"][k]})
        alone = solvers.solve(case.case)
        assert found["objective"][k] == pytest.approx(alone.objective, rel=1e-9)
        for i, name in enumerate(case.case.model.spec.state_names):
            assert found[f"costate_initial.{name}"][k] == pytest.approx(alone.lam[i, 0], abs=1e-9)
    header = (tmp_path / "table.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "initial.r [km],parameters.c1,status" in header


def test_competitors_are_compared_only_where_that_is_asked_for(tmp_path: Path) -> None:
    found = study(NAME, tmp_path, vary={"initial.r": (1.1, 1.1, 1)}, certificate="full", executor=threads, workers=1)
    assert found["verdict"].tolist() == ["certified"]
    assert solvers.solve(instance.load(NAME), examined=False).certificate is None


def test_simulations_and_regulators_are_rows_too_and_failures_say_why(tmp_path: Path) -> None:
    drawn = {"sample": 3, "normal": {"initial.r": (1.1, 0.6)}, "seed": 18}
    found = study(NAME, tmp_path / "s", **drawn, command="simulate", executor=threads)  # type: ignore[arg-type]
    bad = found["status"] == "bad input"
    assert bad.any()
    assert not bad.all()
    assert all("outside the domain" in said for said in found["message"][bad])
    assert np.isnan(found["t_final"][bad]).all()
    one = study("geo-lqr", tmp_path / "l", vary={"initial.r": (42000.0, 42200.0, 2)}, command="lqr", executor=threads)
    gain = lqr("geo-lqr").K
    assert one["K.u2.theta_dot"][0] == pytest.approx(gain[1, 3], rel=1e-12)


@pytest.mark.parametrize(
    ("said", "line"),
    [
        ({}, "nothing varies"),
        ({"vary": [("initial.q", "1:2:3")]}, "initial.q: return-to-orbit has no such number"),
        ({"vary": [("r", "1:2:3")]}, 'did you mean "initial.r"'),
        ({"vary": [("initial.r", "-1:2:3")]}, "outside the domain"),
        ({"vary": [("initial.r", "1:2")]}, "is no range"),
        ({"vary": [("initial.r", "1:2:0")]}, "no number of values"),
        ({"vary": [("initial.r", "1:inf:2")]}, "not finite"),
        ({"vary": [("initial.r_dot", "log:0:1:3")]}, "no logarithm"),
        ({"vary": [("initial.r", "1:2:3"), ("initial.r", "1:2:3")]}, "varies twice"),
        ({"vary": [("initial.r", "1:2:3"), ("initial.r_dot", "1:2:9999999")]}, "more than 10000000"),
        ({"vary": [("initial.r", "1:2:3")], "sample": 3}, "not both"),
        ({"vary": [("initial.r", "1:2:3")], "method": "lhs"}, "is for a sample"),
        ({"vary": [("time.tf", "-1:2:3")]}, "is not after t0"),
        ({"vary": [("final.theta", "1:2:3")]}, "gives no number for it"),
        ({"uniform": [("initial.r", "1,2")]}, "--sample N"),
        ({"uniform": [("initial.r", "2,1")], "sample": 3}, "does not go up"),
        ({"normal": [("initial.r", "1,-1")], "sample": 3}, "no standard deviation"),
        ({"normal": [("initial.r", "1,1")], "sample": 0}, "are none"),
        ({"normal": [("initial.r", "1,1")], "sample": 3, "method": "qmc"}, "sobol"),
    ],
)
def test_what_cannot_be_varied_is_one_line(said: dict[str, Any], line: str) -> None:
    with pytest.raises(BadInput) as caught:
        reading.design(Written(**said), instance.load(NAME))
    assert line in str(caught.value)
    assert "\n" not in str(caught.value)


def test_bad_input_writes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    for wrong in (["--vary", "initial.q=1:2:3"], ["--vary", "initial.r=1:2:3", "--command", "fly"], ["--seed", "1"]):
        assert main(["study", NAME, *wrong, "--out", str(out)]) == 3
        assert len(capsys.readouterr().err.splitlines()) == 1
        assert not out.exists()


def test_the_table_of_an_instance_asks_for_the_same_as_the_command_line(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    text = (Path(instance.files.SHIPPED) / f"{NAME}.toml").read_text(encoding="utf-8")
    said = '[study]\ncertificate = "none"\n[study.vary]\n"initial.r" = "0.9:1.1:2"\nparameters.c1 = "log:1:100:3"\n'
    path.write_text(f"{text}\n{said}", encoding="utf-8")
    study(path, tmp_path / "a", executor=threads)
    vary = {"initial.r": "0.9:1.1:2", "parameters.c1": "log:1:100:3"}
    study(NAME, tmp_path / "b", vary=vary, certificate="none", executor=threads)
    assert (tmp_path / "a/table.csv").read_bytes() == (tmp_path / "b/table.csv").read_bytes()
    path.write_text(f"{text}\n[study]\nvary = 3\n", encoding="utf-8")
    with pytest.raises(BadInput, match="study"):
        load(path)


def test_samples_follow_their_distributions_and_their_seed() -> None:
    case = instance.load(NAME)
    said: dict[str, Any] = {"normal": [("initial.r", "1.1,0.01")], "uniform": [("initial.theta_dot", "0.9,1.1")]}
    for method in ("sobol", "lhs", "random"):
        designs = [reading.design(Written(**said, sample=1000, method=method, seed=s), case) for s in (1, 1, 2)]
        one, again, other = (each.rows(0, 1000) for each in designs)
        assert np.array_equal(one, again)
        assert not np.array_equal(one, other)
        assert isinstance(designs[0], Sample)
        assert np.array_equal(designs[0].rows(10, 20), one[10:20])
        assert one[:, 0].mean() == pytest.approx(1.1, abs=0.002)
        assert one[:, 0].std() == pytest.approx(0.01, rel=0.1)
        assert one[:, 1].min() >= 0.9
        assert np.histogram(one[:, 1], 4)[0].min() > 200


def test_a_grid_has_every_combination_and_exact_ends() -> None:
    case = instance.load(NAME)
    grid = reading.design(Written(vary=[("initial.r", "0.9:1.1:3"), ("parameters.c1", "log:1:100:3")]), case)
    assert isinstance(grid, Grid)
    rows = grid.rows(0, grid.count)
    assert rows[0].tolist() == [0.9, 1.0]
    assert rows[-1].tolist() == [1.1, 100.0]
    assert len({tuple(row) for row in rows.tolist()}) == 9
    assert np.array_equal(rows[4:6], grid.rows(4, 6))


class Shuffled(ThreadPoolExecutor):
    """Chunks that are done in another order than they are given out, and are broken off after some."""

    def __init__(self, most: int = 10**9) -> None:
        super().__init__(1)
        self.most, self.given = most, 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.given += 1
        if self.given > self.most:
            raise KeyboardInterrupt
        return super().submit(fn, *args, **kwargs)


def test_interruptions_and_workers_change_no_byte(tmp_path: Path) -> None:
    wanted = asked(8, trajectories=True)
    reports.carry_out(wanted, tmp_path / "whole", threads, 1)
    for most in (1, 3, 4):
        with pytest.raises(KeyboardInterrupt):
            reports.carry_out(asked(8, trajectories=True), tmp_path / "cut", lambda m=most: Shuffled(m), 2, resume=True)
    with (tmp_path / "cut" / parts.LINES).open("ab") as stream:
        stream.write(b"0123456789abcdef {half a line")
    reports.carry_out(asked(8, trajectories=True), tmp_path / "cut", threads, 3, resume=True)
    for name in ("table.csv", "result.json", "study.json", "trajectories-000.npz"):
        assert (tmp_path / "cut" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes(), name
    left = {path.name for path in (tmp_path / "cut").iterdir()}
    assert left == {"table.csv", "result.json", "study.json", "trajectories-000.npz", "times.log"}
    with np.load(tmp_path / "cut/trajectories-000.npz") as kept:
        assert kept["7.x"][0, 0] == 1.1
        assert len(kept.files) == 8 * 4


def test_what_is_done_is_not_computed_again(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        reports.carry_out(asked(), tmp_path, lambda: Shuffled(4), 1)
    with parts.opened(tmp_path) as kept:
        done = len(kept.done)
    assert done == 4
    again = Shuffled()
    before = reports.carry_out(asked(), tmp_path, lambda: again, 1, resume=True)
    assert again.given == 2
    never = Shuffled(0)
    assert reports.carry_out(asked(), tmp_path, lambda: never, 1, resume=True) == before


def test_a_changed_study_is_refused_with_the_difference(tmp_path: Path) -> None:
    reports.carry_out(asked(2), tmp_path, threads, 1)
    before = (tmp_path / "result.json").read_bytes()
    with pytest.raises(BadInput, match=r"rows was 2 and is 3; vary initial.r was 0.9:1.1:2 and is 0.9:1.1:3"):
        reports.carry_out(asked(3), tmp_path, threads, 1, resume=True)
    with pytest.raises(BadInput, match="--resume"):
        reports.carry_out(asked(2), tmp_path, threads, 1)
    assert (tmp_path / "result.json").read_bytes() == before


def test_a_damaged_line_is_computed_again(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        reports.carry_out(asked(), tmp_path, lambda: Shuffled(5), 1)
    lines = (tmp_path / parts.LINES).read_bytes().splitlines(keepends=True)
    lines[2] = lines[2].replace(b"converged", b"convergeD")
    (tmp_path / parts.LINES).write_bytes(b"".join(lines))
    with parts.opened(tmp_path) as kept:
        assert sorted(kept.done) == [0, 1]


def test_a_chunk_that_kills_three_workers_is_said_to_and_takes_no_other_with_it(tmp_path: Path) -> None:
    wanted = asked(4)
    said: list[str] = []
    with Workers(2) as workers, parts.opened(tmp_path) as kept:
        running.run(wanted, kept, workers, 2, work=deadly_in_one, log=said.append)
        rows = [kept.read(number).rows[0] for number in range(4)]
    assert [row.status for row in rows] == ["converged", "worker died", "converged", "converged"]
    assert rows[3].numbers == {"twice": 2.2}
    assert sum("died" in line for line in said) == 3


def test_a_mistake_of_ours_ends_the_study(tmp_path: Path) -> None:
    with parts.opened(tmp_path) as kept, threads() as workers, pytest.raises(RuntimeError, match="a mistake"):
        running.run(asked(2), kept, workers, 1, work=raising)


def test_a_full_disk_is_one_line_and_what_was_written_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real, count = os.fsync, iter(range(100))

    def full(handle: int) -> None:
        if next(count) == 5:
            raise OSError(28, "No space left on device")
        real(handle)

    monkeypatch.setattr(parts.os, "fsync", full)
    with pytest.raises(BadInput, match=r"No space left on device.*--resume"):
        reports.carry_out(asked(), tmp_path, threads, 1)
    monkeypatch.undo()
    with parts.opened(tmp_path) as kept:
        assert 1 <= len(kept.done) < 6
    assert reports.carry_out(asked(), tmp_path, threads, 1, resume=True)["statuses"] == {"converged": 6}


def test_two_processes_cannot_be_at_one_study(tmp_path: Path) -> None:
    with parts.opened(tmp_path), pytest.raises(BadInput, match="another process"), parts.opened(tmp_path):
        pass


def test_how_far_a_study_is_is_told(tmp_path: Path) -> None:
    seen: list[running.Advance] = []
    with parts.opened(tmp_path) as kept, threads() as workers:
        running.run(asked(4), kept, workers, 1, seen.append, work=quick)
    assert [(one.done, one.failures) for one in seen] == [(k, k) for k in range(5)]
    assert seen[-1].left == 0.0
    assert seen[2].left > 0.0


@pytest.mark.slow
def test_killed_at_any_moment_no_finished_chunk_is_lost(tmp_path: Path) -> None:
    killed(tmp_path, [0.0, 0.1], rows=1600)


@pytest.mark.study
def test_killed_twenty_times_no_finished_chunk_is_lost(tmp_path: Path) -> None:
    killed(tmp_path, np.random.default_rng(1).uniform(0.0, 0.5, 20).tolist(), rows=40000)


def killed(folder: Path, moments: list[float], rows: int) -> None:
    """A study that is killed after each of these seconds, counted from its first chunk; then it is the same."""
    options = f"--command lqr --vary initial.r=42000:42300:{rows} --workers 2 --resume --out"
    command = [sys.executable, "-m", "satsym", "study", "geo-lqr", *options.split()]
    lines, done = folder / "cut" / parts.LINES, set[int]()
    for moment in moments:
        before = lines.stat().st_size if lines.exists() else 0
        silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with subprocess.Popen([*command, str(folder / "cut")], **silent) as process:
            until = time.monotonic() + 60.0
            while process.poll() is None and time.monotonic() < until:
                if lines.exists() and lines.stat().st_size > before:
                    time.sleep(moment)
                    break
                time.sleep(0.005)
            process.kill()
        assert lines.exists(), "done before it could be killed"
        with parts.opened(folder / "cut") as kept:
            assert done <= set(kept.done), "a chunk was lost"
            done = set(kept.done)
    assert done
    subprocess.run([*command, str(folder / "cut")], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([*command, str(folder / "whole")], check=True, stdout=subprocess.DEVNULL)
    for name in ("table.csv", "result.json"):
        assert (folder / "cut" / name).read_bytes() == (folder / "whole" / name).read_bytes(), name


def test_pictures_are_drawn_from_the_table_whenever_they_are_wanted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    vary = {"initial.r": (0.95, 1.1, 3), "parameters.c1": "log:1:10:3"}
    study(NAME, tmp_path / "grid", vary=vary, certificate="none", executor=threads)
    drawn = {"sample": 3, "normal": {"initial.r": (1.1, 0.6)}, "seed": 18}
    study(NAME, tmp_path / "s", **drawn, command="simulate", executor=threads)  # type: ignore[arg-type]
    assert main(["plot", str(tmp_path / "grid"), "--json"]) == 0
    assert [Path(p).name for p in json.loads(capsys.readouterr().out)["pictures"]] == ["overview.png"]
    assert main(["plot", str(tmp_path / "s"), "--format", "pdf"]) == 0
    assert {"overview.pdf", "failures.pdf"} <= {path.name for path in (tmp_path / "s").iterdir()}


def test_the_command_of_a_worst_row_solves_that_row(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    vary = {"initial.r": (0.95, 1.1, 2)}
    found = study(NAME, tmp_path, vary=vary, certificate="none", executor=threads)
    worst = found.summary["worst"][0]
    assert worst["objective"] == found["objective"].max()
    assert main([*worst["reproduce"].split()[1:], "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["objective"] == pytest.approx(worst["objective"], rel=1e-9)
    assert main(["simulate", NAME, "--set", "initial.q=1"]) == 3
    assert main(["lqr", "clohessy_wiltshire", "--set", "initial.q=1"]) == 3


def test_no_cluster_is_one_line_and_writes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    wanted = ["study", NAME, "--vary", "initial.r=0.9:1.1:4", "--out", str(out), "--scheduler", "nowhere"]
    assert main(wanted) == 3
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert not out.exists()


@pytest.mark.study
def test_a_cluster_whose_worker_is_killed_gives_the_same_bytes(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    reports.carry_out(asked(24), tmp_path / "here", threads, 1)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as local,
        cluster.cluster(local.scheduler_address) as (executor, at_once),
    ):
        killed: list[int] = []

        def kill(advance: running.Advance) -> None:
            if advance.done >= 3 and not killed:
                killed.append(next(iter(local.workers.values())).process.pid)
                os.kill(killed[0], signal.SIGKILL)

        reports.carry_out(asked(24), tmp_path / "there", lambda: executor, at_once, watch=kill)
    assert killed
    assert (tmp_path / "there/table.csv").read_bytes() == (tmp_path / "here/table.csv").read_bytes()


def test_what_is_rounding_or_the_same_in_each_row_is_not_drawn() -> None:
    rounding, steady = np.array([1e-14, -3e-15, 0.0]), np.full(3, 6.28)
    given = {
        "t_final": steady,
        "x_final.v": rounding,
        "objective": np.array([1e-12, 2e-12, math.nan]),
        "none": rounding * math.nan,
    }
    assert list(telling(given)) == ["objective"]
    assert list(telling({"t_final": steady, "x_final.v": rounding})) == ["t_final"]
    assert list(telling({name: np.arange(3.0) for name in "abcd"})) == ["a", "b", "c"]
