"""Studies: what is asked, what comes of it, and that a row is what its command computes."""

from __future__ import annotations

import json
import math
import shlex
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satsym import instance, solvers
from satsym.cli import main
from satsym.cli.saving import study_folder
from satsym.front.analysing import lqr
from satsym.front.instance import Instance, load
from satsym.front.solution import Trajectory
from satsym.front.studies import study
from satsym.instance import numbers
from satsym.instance.schema import StudyTable
from satsym.report.results import trajectory
from satsym.report.results.studies import distinguishing
from satsym.report.results.study_table import header
from satsym.solution import CostInterval
from satsym.solvers.improving import goes_on
from satsym.status import BadInput, Verdict
from satsym.studies import reading, rows, solving
from satsym.studies.asking import asked
from satsym.studies.reading import Axis, Grid, Sample
from tests.support.chunks import Here, failing

NAME = "return-to-orbit"


def here() -> Here:
    """Rows are computed in this process, which is quicker to begin."""
    return Here(None)


@pytest.mark.slow
def test_each_row_is_what_solving_it_alone_gives(tmp_path: Path) -> None:
    vary = {"initial.r": (0.95, 1.1, 2), "parameters.c1": "log:1:10:2"}
    found = study(NAME, tmp_path, vary=vary, executor=here, workers=1)
    assert len(found["row"]) == 4
    assert set(found["verdict"]) == {"local minimum"}
    assert found["message"].tolist() == [""] * 4
    assert np.allclose(found["parameters.c1"], [1.0, 10.0] * 2, rtol=1e-15)
    for k in (0, 3):
        case = load(NAME).with_(initial={"r": found["initial.r"][k]}, parameters={"c1": found["parameters.c1"][k]})
        alone = solvers.solve(case.case)
        assert found["objective"][k] == pytest.approx(alone.objective, rel=1e-9)
        for i, name in enumerate(case.case.model.spec.state_names):
            assert found[f"costate_initial.{name}"][k] == pytest.approx(alone.lam[i, 0], abs=1e-9)
    first = (tmp_path / "table.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "initial.r [km],parameters.c1,status" in first


@pytest.mark.slow
def test_some_rows_are_compared_with_competitors_and_the_others_stay_as_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(solving, "ROWS_PER_COMPARISON", 4)
    vary = {"initial.r": (1.0, 1.1, 48)}
    some, none = (
        study(NAME, tmp_path / kind, vary=vary, certificate=kind, executor=here, workers=1)
        for kind in ("sample", "local")
    )
    drawn = np.array([int(key, 16) % 4 == 0 for key in some["key"]])
    assert 0 < drawn.sum() < 48
    assert set(some["verdict"][drawn]) == {"certified"}
    assert set(some["verdict"][~drawn]) == set(none["verdict"]) == {"local minimum"}
    assert (some["objective"][~drawn] == none["objective"][~drawn]).all()
    assert np.allclose(some["objective"], none["objective"], rtol=1e-9)


def test_competitors_are_compared_only_where_that_is_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = study(NAME, tmp_path / "a", vary={"initial.r": (1.1, 1.1, 1)}, certificate="full", executor=here)
    assert found["verdict"].tolist() == ["certified"]
    assert solvers.solve(instance.load(NAME), examined=False).certificate is None
    solve, times = solvers.solve, list[bool]()

    def counting(*args: Any, **options: Any) -> Any:
        times.append(options.get("examined", True))
        return solve(*args, **options)

    monkeypatch.setattr(solvers, "solve", counting)
    one = study("breakwell", tmp_path / "b", vary={"parameters.l": (0.12, 0.12, 1)}, executor=here)
    assert one["verdict"].tolist() == ["local minimum"]
    assert one["events"][0] == 2.0
    assert times == [False]


def test_only_extremals_that_are_departed_from_are_solved_again() -> None:
    solution = solvers.solve(instance.load("soft-return"))
    assert solution.certificate is not None
    for verdict in Verdict:
        one = replace(solution, certificate=replace(solution.certificate, verdict=verdict))
        assert goes_on(one) == (verdict is Verdict.EXTREMAL_ONLY)
        assert not any(goes_on(replace(one, method=method)) for method in ("boundary-arcs", "bang-bang"))


def test_a_row_says_what_the_best_objective_lies_between() -> None:
    solution = solvers.solve(instance.load("soft-return"), examined=False)
    between = replace(solution, interval=CostInterval(1.0, 2.0, 0.1))
    assert rows.of_solution("", between, "", kept=False).numbers["cost_interval.lower"] == 1.0
    assert rows.of_solution("", between, "", kept=False).numbers["cost_interval.upper"] == 2.0
    assert "cost_interval.lower" not in rows.of_solution("", solution, "", kept=False).numbers


def test_simulations_and_regulators_are_rows_too_and_failures_say_why(tmp_path: Path) -> None:
    drawn = {"sample": 3, "normal": {"initial.r": (1.1, 0.6)}, "seed": 18}
    found = study(NAME, tmp_path / "s", **drawn, command="simulate", executor=here)  # type: ignore[arg-type]
    bad = found["status"] == "bad input"
    assert bad.any()
    assert not bad.all()
    assert all("outside the domain" in said for said in found["message"][bad])
    assert np.isnan(found["t_final"][bad]).all()
    said = next(one["reproduce"] for one in found.summary["failures"])
    assert main(shlex.split(said)[1:]) == 3
    vary = {"initial.r": ("42000 km", "42200 km", 2)}
    one = study("geo-lqr", tmp_path / "l", vary=vary, command="lqr", executor=here)
    gain = lqr("geo-lqr").K
    assert one["K.u2.theta_dot"][0] == pytest.approx(gain[1, 3], rel=1e-12)


def test_every_column_that_has_a_unit_says_it() -> None:
    spec = instance.load("geo-lqr").model.spec
    names = [
        "cost_from_initial",
        "K.u1.r",
        "K.u1.theta",
        "eigenvalue_1.re",
        "metrics.r_min",
        "metrics.steps",
        "t_final",
    ]
    assert header(spec, names) == [
        "cost_from_initial [cost]",
        "K.u1.r [1/s**2]",
        f"K.u1.theta [{spec.controls[0].unit}/rad]",
        "eigenvalue_1.re [1/s]",
        "metrics.r_min [km]",
        "metrics.steps",
        "t_final [s]",
    ]


@pytest.mark.parametrize(
    ("said", "line"),
    [
        ({}, "the study varies no key"),
        ({"vary": {"initial.q": "1:2:3"}}, "initial.q: return-to-orbit has no numerical quantity of this name"),
        ({"vary": {"r": "1:2:3"}}, 'did you mean "initial.r"'),
        ({"vary": {"initial.r": "-1:2:3"}}, "outside the domain"),
        ({"vary": {"initial.r": "1:2"}}, "is not a range"),
        ({"vary": {"initial.r": "1:2:0"}}, "the number of values must be"),
        ({"vary": {"initial.r": "1:1:2"}}, "LOW and HIGH must differ"),
        ({"vary": {"initial.r": "1:inf:2"}}, "not finite"),
        ({"vary": {"initial.r_dot": "log:0:1:3"}}, "the logarithm of"),
        ({"vary": {"parameters.c1": "1:2:3", "c1": "1:2:3"}}, "parameters.c1: is varied twice"),
        ({"vary": {"initial": {"r": "1:2:3"}, "initial.r": "1:2:3"}}, "is varied twice"),
        ({"vary": {"initial.r": "1:2:3", "initial.r_dot": "1:2:9999999"}}, "at most 10000000"),
        ({"vary": {"initial.r": "1:2:3"}, "sample": 3}, "not both"),
        ({"vary": {"initial.r": "1:2:3"}, "method": "lhs"}, "applies to samples only"),
        ({"vary": {"time.tf": "-1:2:3"}}, "is not after t0"),
        ({"vary": {"final.theta": "1:2:3"}}, "gives no numerical value for this key"),
        ({"uniform": {"initial.r": "1,2"}}, "--sample N"),
        ({"uniform": {"initial.r": "2,1"}, "sample": 3}, "LOW must be less than HIGH"),
        ({"normal": {"initial.r": "1,-1"}, "sample": 3}, "not a standard deviation"),
    ],
)
def test_what_cannot_be_varied_is_one_line(said: dict[str, Any], line: str) -> None:
    with pytest.raises(BadInput) as caught:
        reading.design(StudyTable(**said), instance.load(NAME))
    assert line in str(caught.value)
    assert "\n" not in str(caught.value)


GRID = {"vary": {"initial.r": (0.9, 1.1, 2)}}
DRAWN = {"normal": {"initial.r": (1.0, 0.1)}}


@pytest.mark.parametrize(
    ("said", "line"),
    [
        ({"vary": {"initial.r": 42000.0}}, "initial.r: got 42000; give text such as"),
        ({"vary": [("initial.r", (1, 2, 3))]}, "vary: got"),
        ({"vary": {"initial.r": (0.9, None, 2)}}, "initial.r: "),
        (DRAWN | {"sample": 2.5}, "sample: got 2.5; give a whole number"),
        (DRAWN | {"sample": "2"}, "sample: got"),
        (DRAWN | {"sample": 0}, "give a whole number"),
        (DRAWN | {"sample": 3, "method": "qmc"}, '"sobol", "lhs", "random"'),
        (DRAWN | {"sample": 3, "seed": 1.5}, "seed: got 1.5"),
        (GRID | {"command": 3}, '"solve", "simulate", "lqr"'),
        (GRID | {"command": "drive"}, '"solve", "simulate", "lqr"'),
        (GRID | {"workers": -1}, "must be positive, not -1"),
        (GRID | {"workers": 0}, "must be positive, not 0"),
        (GRID | {"command": "simulate", "certificate": "full"}, 'certificate: applies to "solve"'),
        (GRID | {"command": "simulate", "feedback": "magic"}, "feedback: "),
        (GRID | {"feedback": "none"}, 'feedback: applies to "simulate"'),
    ],
)
def test_what_cannot_be_asked_for_is_one_line_and_writes_nothing(said: Any, line: str, tmp_path: Path) -> None:
    with pytest.raises(BadInput) as caught:
        study(NAME, tmp_path / "out", executor=Here, **said)
    assert line in str(caught.value)
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "out").exists()


def test_what_a_command_has_not_is_refused_unless_the_table_says_it_of_another(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="trajectories: applies to"):
        study("geo-lqr", tmp_path, vary={"initial.r": (42000, 42200, 2)}, command="lqr", trajectories=True)
    with pytest.raises(BadInput, match="folder: "):
        study(NAME, None, **GRID)  # type: ignore[arg-type]
    table = {"command": "simulate", "feedback": "none", "vary": {"initial.r": "0.9:1.1:2"}}
    written = load(NAME).with_(study=table).written
    assert asked(written, written.instance(), {}).feedback == "none"
    assert asked(written, written.instance(), {"command": "solve"}).feedback is None
    with pytest.raises(BadInput, match="one of"):
        load(NAME).with_(study={"command": "drive"})
    with pytest.raises(BadInput, match=r"initial\.q: .* has no numerical quantity of this name"):
        load(NAME).with_(study={"vary": {"initial.q": "1:2:3"}})


def test_bad_input_writes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    varied = ["--vary", "initial.r=1:2:3"]
    for wrong in (["--vary", "initial.q=1:2:3"], [*varied, "--command", "drive"], ["--seed", "1"], varied * 2):
        assert main(["study", NAME, *wrong, "--out", str(out)]) == 3
        assert len(capsys.readouterr().err.splitlines()) == 1
        assert not out.exists()


def test_the_table_of_an_instance_asks_for_the_same_as_the_command_line(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    text = (Path(instance.files.SHIPPED) / f"{NAME}.toml").read_text(encoding="utf-8")
    said = '[study]\ncertificate = "none"\n[study.vary]\n"initial.r" = "0.9:1.1:2"\nparameters.c1 = "log:1:100:3"\n'
    path.write_text(f"{text}\n{said}", encoding="utf-8")
    study(path, tmp_path / "a", executor=Here)
    vary = {"initial.r": "0.9:1.1:2", "parameters.c1": "log:1:100:3"}
    study(NAME, tmp_path / "b", vary=vary, certificate="none", executor=Here)
    one, other = (json.loads((tmp_path / k / "study.json").read_text(encoding="utf-8"))["asked"] for k in "ab")
    assert one == other
    assert (tmp_path / "a/table.csv").read_bytes() == (tmp_path / "b/table.csv").read_bytes()
    path.write_text(f"{text}\n[study]\nvary = 3\n", encoding="utf-8")
    with pytest.raises(BadInput, match="study"):
        load(path)


def test_samples_follow_their_distributions_and_their_seed() -> None:
    case = instance.load(NAME)
    said: dict[str, Any] = {"normal": {"initial.r": "1.1,0.01"}, "uniform": {"initial.theta_dot": "0.9,1.1"}}
    for method in ("sobol", "lhs", "random"):
        designs = [reading.design(StudyTable(**said, sample=1000, method=method, seed=s), case) for s in (1, 1, 2)]
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
    grid = reading.design(StudyTable(vary={"initial.r": "0.9:1.1:3", "parameters.c1": "log:1:100:3"}), case)
    assert isinstance(grid, Grid)
    found = grid.rows(0, grid.count)
    assert found[0].tolist() == [0.9, 1.0]
    assert found[-1].tolist() == [1.1, 100.0]
    assert len({tuple(row) for row in found.tolist()}) == 9
    assert np.array_equal(found[4:6], grid.rows(4, 6))


def test_a_continuation_ends_where_a_row_says() -> None:
    case = load(NAME).with_(continuation={"c1": [1.0, 100.0], "tf": [3.0, 6.0]}).case
    c1 = case.model.spec.parameter_names.index("c1")
    row = numbers.changed(case, {"parameters.c1": 5.0})
    assert [(one.key.text, one.begin, one.end) for one in row.continuation] == [
        ("parameters.c1", 1.0, 5.0),
        ("time.tf", 3.0, 6.0),
    ]
    assert row.parameters[c1] == row.continuation[0].at(row, 1.0).parameters[c1] == 5.0
    assert [one.key.short for one in numbers.changed(case, {"parameters.c1": 1.0}).continuation] == ["tf"]
    with pytest.raises(BadInput, match="is not after"):
        numbers.changed(case, {"time.t0": 3.5})  # which is after the duration with which the way begins
    with pytest.raises(BadInput, match="outside the domain"):
        numbers.changed(case, {"initial.r": -1.0})


def test_pictures_are_drawn_from_the_table_whenever_they_are_wanted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    vary = {"initial.r": (0.95, 1.1, 3), "parameters.c1": "log:1:10:3"}
    drawn = study(NAME, "grid", vary=vary, executor=Here)
    study(NAME, f"results/{NAME}/study", sample=3, normal={"initial.r": (1.1, 0.6)}, executor=lambda: Here(failing))
    assert study_folder(f"{NAME}/study", None) == study_folder(f"results/{NAME}/study", None)
    assert main(["plot", f"results/{NAME}/study", "--format", "svg", "--no-title"]) == 0
    names = {path.name for path in Path(f"results/{NAME}/study").iterdir()}
    assert {"overview.svg", "failures.svg"} <= names
    with pytest.raises(BadInput, match="there is no picture format"):
        drawn.plot(("jpg",))
    again = ["study", NAME, "--vary", "initial.r=0.95:1.1:3", "--vary", "parameters.c1=log:1:10:3", "--out", "grid"]
    capsys.readouterr()
    assert main([*again, "--resume", "--plot", "--json"]) == 0
    assert [Path(p).name for p in json.loads(capsys.readouterr().out)["pictures"]] == ["overview.png"]


@pytest.mark.parametrize("origin", ["shipped", "own file of that name", "changed in Python"])
def test_the_command_of_a_row_computes_that_row(
    origin: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    given: str | Path | Instance = NAME
    if origin == "own file of that name":
        given = Path(f"my files/{NAME}.toml")
        given.parent.mkdir()
        given.write_text(load(NAME).with_(tf=3.0).to_toml(), encoding="utf-8")
    elif origin == "changed in Python":
        given = load(NAME).with_(parameters={"c1": 50.0})
    found = study(given, "out dir", vary={"initial.r": (0.95, 1.1, 2)}, certificate="none", executor=here)
    worst = found.summary["worst"][0]
    assert worst["objective"] == found["objective"].max()
    assert main([*shlex.split(worst["reproduce"])[1:], "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["objective"] == pytest.approx(worst["objective"], rel=1e-9)


def test_a_study_takes_numbers_that_all_rows_have(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    varied = ["--vary", "initial.r=0.95:1.1:2", "--certificate", "none", "--workers", "1", "--json"]
    out = str(tmp_path / "out")
    assert main(["study", NAME, *varied, "--set", "parameters.c1=50", "--out", out]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["set"] == {"parameters.c1": 50.0}
    worst = said["worst"][0]
    assert "--set parameters.c1=50.0 --set initial.r=" in worst["reproduce"]
    assert main([*shlex.split(worst["reproduce"])[1:], "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["objective"] == pytest.approx(worst["objective"], rel=1e-9)
    assert json.loads((tmp_path / "out/study.json").read_text(encoding="utf-8"))["set"] == said["set"]
    for other, line in (
        (["--set", "parameters.c1=7"], "instance parameters was"),
        (
            ["--set", "parameters.c1=50", "--set", "initial.r=1"],
            "--set initial.r: is varied in this study, so it cannot be set as well",
        ),
        (["--set", "c1=50", "--set", "parameters.c1=50"], "is given twice"),
        (["--set", "initial.q=1"], "has no numerical quantity of this name"),
    ):
        assert main(["study", NAME, *varied, *other, "--resume", "--out", out]) == 3
        assert line in capsys.readouterr().err


def test_numbers_that_were_set_come_back_with_the_result(tmp_path: Path) -> None:
    place = str(tmp_path / "out")
    given = ["--set", "initial.r=1.05", "--set", "parameters.c1=7"]
    assert main(["simulate", NAME, *given, "--out", place]) == 0
    result = json.loads((tmp_path / "out/result.json").read_text(encoding="utf-8"))
    assert result["set"] == {"initial.r": 1.05, "parameters.c1": 7.0}
    drawn, _ = trajectory.read(instance.load(NAME), tmp_path / "out")
    back = Trajectory.load(place)
    spec = back.instance.case.model.spec
    for case in (drawn.instance, back.instance.case, back.found.instance):
        assert dict(zip(spec.parameter_names, case.parameters, strict=True))["c1"] == 7.0
        assert case.initial[0] == 1.05
    with pytest.raises(BadInput, match=r"--set initial\.r=1\.05 --set parameters\.c1=7\.0 --out"):
        trajectory.read(replace(instance.load(NAME), continuation=(), initial=(1.0,) * 4), tmp_path / "out")
    assert main(["simulate", NAME, "--set", "initial.q=1"]) == 3
    assert main(["lqr", "clohessy_wiltshire", "--set", "initial.q=1"]) == 3


def test_what_is_rounding_or_the_same_in_each_row_is_not_drawn() -> None:
    rounding, steady = np.array([1e-14, -3e-15, 0.0]), np.full(3, 6.28)
    given = {
        "t_final": steady,
        "x_final.v": rounding,
        "objective": np.array([1e-12, 2e-12, math.nan]),
        "none": rounding * math.nan,
    }
    assert list(distinguishing(given, {})) == ["objective"]
    assert list(distinguishing({"t_final": steady, "x_final.v": rounding}, {})) == ["t_final"]
    assert list(distinguishing({name: np.arange(3.0) ** k for k, name in enumerate("abcd", 1)}, {})) == ["a", "b", "c"]


def test_values_of_a_grid_are_the_decimals_that_they_are_meant_to_be() -> None:
    key = numbers.Key(numbers.Table.INITIAL, "r")
    assert Axis(key, 0.9, 1.1, 9).values.tolist() == [0.9, 0.925, 0.95, 0.975, 1.0, 1.025, 1.05, 1.075, 1.1]
    assert Axis(key, 0.0, 1.0, 4).values[1] == 1 / 3
    assert Axis(key, -1e-5, 2e-5, 7).values.tolist() == [-1e-5, -5e-6, 0.0, 5e-6, 1e-5, 1.5e-5, 2e-5]
