"""The command line as its users meet it: outputs, exit codes, one line for each complaint."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import satsym
from satsym import activity, kernels
from satsym.cli import main, output
from satsym.cli.output import live
from satsym.instance import SolverOptions
from satsym.report.results.files import to_json
from tests.support import solved

Run = Callable[..., tuple[int, str, str]]
COMMANDS = [
    *(
        "models",
        "instances",
        "new",
        "solve",
        "certify",
        "prove",
        "simulate",
        "study",
        "plot",
        "compare",
        "analyse",
        "lqr",
    ),
    *("derive", "latex", "report", "export", "check", "read", "audit", "completion", "doctor", "bench"),
]
HEAD = "satsym schema command model instance status units instance_file".split()
SOLUTION_KEYS = (
    "satsym schema command model instance status units instance_file method message boundary_type objective t_final "
    "x_final costate_initial switching_times iterations wall_s certificate x_initial t_initial parameters_found events"
).split()

INSTANCE = """
model = "polar_orbit"
title = "A case of one's own"
[initial]
r = 1.1
r_dot = 0.0
theta = 0.0
theta_dot = 0.9
[time]
tf = 1.0
"""

DERIVATION = """
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("place", "s", "m", "place on the road"),)
CONTROLS = (Variable("speed", "v", "m/s", "speed"),)
WEIGHTS = (Variable("weight", "w", "1/s", "weight of the final place", 1.0),)
(place,), (speed,), (weight,) = map(symbols_of, (STATES, CONTROLS, WEIGHTS))
walk = FirstOrder(
    name="walk", title="A walk", states=STATES, controls=CONTROLS, parameters=WEIGHTS, rates={place: speed}
)
PROBLEMS = (
    Problem(
        name="short_walk",
        title="A short walk",
        model=walk,
        running_cost=speed**2,
        terminal_cost=weight * place**2,
    ),
)
"""


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Exit code, stdout and stderr of a command, run in an empty folder of its own; no instance is solved twice."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SATSYM_DEBUG", raising=False)
    monkeypatch.setattr("satsym.solvers.solve", solved.solve)

    def run(*arguments: str | Path) -> tuple[int, str, str]:
        code = main([str(argument) for argument in arguments])
        return code, *capsys.readouterr()

    return run


@pytest.fixture
def case(tmp_path: Path) -> Path:
    path = tmp_path / "case.toml"
    path.write_text(INSTANCE, encoding="utf-8")
    return path


@pytest.fixture
def derivation(tmp_path: Path) -> Path:
    path = tmp_path / "walking.py"
    path.write_text(DERIVATION, encoding="utf-8")
    return path


def program(*arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    return subprocess.run(
        [sys.executable, "-m", "satsym", *arguments],
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
        **options,
    )


def printed(folder: Path) -> str:
    """What a result.json holds, as --json prints it: all but the list of files."""
    found = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    assert set(found.pop("files")) == {path.name for path in folder.iterdir()} - {"result.json"}
    return to_json(found)


def one_line(text: str) -> bool:
    return text.startswith("satsym: ") and text.endswith("\n") and text.count("\n") == 1


# Help and usage


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_every_command_has_an_example(run: Run, command: str) -> None:
    code, out, err = run(command, "--help")
    assert (code, err) == (0, "")
    assert f"satsym {command}" in out.partition("Example")[2]


def test_help_lists_every_command_and_exit_code(run: Run) -> None:
    code, out, _ = run("--help")
    assert code == 0
    assert [line.split()[0] for line in out.partition("Commands:\n")[2].splitlines()[: len(COMMANDS)]] == COMMANDS
    assert "6 generated files are stale" in out


def test_version_is_told(run: Run) -> None:
    assert run("--version") == (0, f"satsym {satsym.__version__}\n", "")


@pytest.mark.parametrize("arguments", [["slove"], ["solve"], ["solve", "its-thesis", "--jsn"], ["derive", "--out"]])
def test_wrong_usage_is_2_and_on_stderr(run: Run, arguments: list[str]) -> None:
    code, out, err = run(*arguments)
    assert (code, out) == (2, "")
    assert "Error: " in err


def test_near_misses_are_suggested(run: Run) -> None:
    assert "'solve'" in run("slove")[2]
    assert "--json" in run("solve", "its-thesis", "--jsn")[2]
    assert '"its-thesis"' in run("solve", "its-theses")[2]


@pytest.mark.parametrize("value", ["0", "-1", "nan", "inf", "x"])
def test_tolerance_is_a_positive_number(run: Run, value: str) -> None:
    assert run("solve", "its-thesis", f"--tolerance={value}")[:2] == (2, "")


# Lists


def test_models_are_listed(run: Run) -> None:
    code, out, _ = run("models", "--json")
    assert code == 0
    assert [model["name"] for model in json.loads(out)["models"]] == kernels.shipped()
    assert "polar_orbit" in run("models")[1]


def test_one_model_is_described_in_full(run: Run) -> None:
    code, out, _ = run("models", "polar_orbit")
    assert code == 0
    assert "weight of the radial thrust" in out


def test_unknown_model_is_bad_input(run: Run) -> None:
    code, out, err = run("models", "polar_orbits", "--json")
    assert (code, out) == (3, "")
    assert one_line(err)


def test_instances_are_listed(run: Run) -> None:
    code, out, _ = run("instances", "--json")
    (thesis,) = [each for each in json.loads(out)["instances"] if each["name"] == "its-thesis"]
    assert code == 0
    assert thesis == {
        "name": "its-thesis",
        "title": "ITS thesis, weights 10 and 10, as printed",
        "model": "polar_orbit",
        "boundary_type": 3,
        "t0": 0.0,
        "tf": 60.0,
        "bounded": True,
    }
    assert "its-thesis" in run("instances")[1]


# Solve and simulate


def test_solve_prints_the_object_of_the_contract_and_writes_nothing(run: Run, tmp_path: Path) -> None:
    code, out, err = run("solve", "its-thesis", "--json")
    found = json.loads(out)
    assert (code, err) == (0, "")
    assert list(found) == SOLUTION_KEYS
    assert found["status"] == "converged"
    assert found["objective"] == 0.0
    assert found["certificate"]["verdict"] == "certified"
    assert not list(tmp_path.iterdir())


def test_solve_summarises_for_people(run: Run) -> None:
    code, out, err = run("solve", "its-thesis")
    assert (code, err) == (0, "")
    assert "converged" in out
    assert "\x1b" not in out


def test_solve_takes_a_file(run: Run, case: Path) -> None:
    code, out, _ = run("solve", case, "--json")
    assert code == 0
    assert json.loads(out)["instance"] == "case"


def test_solve_writes_results_where_it_is_told(run: Run, case: Path, tmp_path: Path) -> None:
    code, out, _ = run("solve", case, "--json", "--out", tmp_path / "new" / "folder")
    assert code == 0
    folder = tmp_path / "new" / "folder"
    assert {path.name for path in folder.iterdir()} == {
        "trajectory.npz",
        "trajectory.csv",
        "instance.toml",
        "result.json",
    }
    assert printed(folder) == out


@pytest.mark.parametrize("command", ["solve", "simulate"])
def test_pictures_go_to_results_by_default(
    run: Run, case: Path, tmp_path: Path, command: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("satsym.report.plots.pictures", lambda _result, _look: {"picture.png": lambda stream: None})
    code, out, _ = run(command, case, "--plot")
    assert code == 0
    assert (
        f"{Path('results', 'case', command)}: trajectory.npz, trajectory.csv, instance.toml, picture.png, result.json"
        in " ".join(out.split())
    )
    assert (tmp_path / "results" / "case" / command / "picture.png").is_file()


def test_options_replace_those_of_the_instance(run: Run, case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[SolverOptions] = []

    def solve(case: Any, progress: object) -> None:
        given.append(case.solver)
        raise KeyboardInterrupt

    monkeypatch.setattr("satsym.solvers.solve", solve)
    run("solve", case, "--steps", "77", "--tolerance", "1e-5", "--method", "sweep")
    run("solve", case)
    assert given == [SolverOptions(steps=77, tolerance=1e-5, method="sweep"), SolverOptions()]


@pytest.mark.slow
def test_no_answer_is_4_and_prints_the_object_all_the_same(run: Run, case: Path, tmp_path: Path) -> None:
    hopeless = INSTANCE.replace("r = 1.1", "r = 1e-3") + "[solver]\nmax_seconds = 0.5\n"
    case.write_text(hopeless, encoding="utf-8")
    code, out, err = run("solve", case, "--json", "--out", tmp_path / "out")
    found = json.loads(out)
    assert (code, err) == (4, "")
    assert list(found) == SOLUTION_KEYS
    assert found["status"] != "converged"
    assert printed(tmp_path / "out") == out
    code, out, _ = run("solve", case)
    assert code == 4
    assert found["status"] in out


def test_simulate_prints_the_object_of_the_contract(run: Run) -> None:
    code, out, err = run("simulate", "soft-return", "--json")
    found = json.loads(out)
    assert (code, err) == (0, "")
    assert list(found) == [*HEAD, *"feedback t_final x_final invariants metrics".split()]
    assert found["feedback"] == "none"
    assert found["invariants"]["energy"]["drift"] < 1e-9


def test_simulation_without_answer_says_why_on_stderr(run: Run, case: Path) -> None:
    case.write_text(INSTANCE.replace("r = 1.1", "r = 1e-3"), encoding="utf-8")
    code, out, err = run("simulate", case, "--json")
    assert code == 4
    assert json.loads(out)["instance"] == "case"
    assert one_line(err)


# Complaints


@pytest.mark.parametrize(
    "text",
    [INSTANCE + "tf = 2\n", INSTANCE.replace("tf = 1.0", "tf = nan"), INSTANCE.replace("polar", "bipolar"), "\0"],
)
@pytest.mark.parametrize("command", ["solve", "simulate"])
def test_bad_instance_is_3_with_one_line_and_nothing_written(run: Run, case: Path, command: str, text: str) -> None:
    case.write_text(text, encoding="utf-8")
    code, out, err = run(command, case, "--json", "--plot")
    assert (code, out) == (3, "")
    assert one_line(err)
    assert "case.toml" in err
    assert list(case.parent.iterdir()) == [case]


def test_folder_that_cannot_be_written_is_refused_before_solving(
    run: Run, case: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("satsym.solvers.solve", lambda *_arguments, **_options: pytest.fail("solved in vain"))
    code, out, err = run("solve", case, "--out", case)
    assert (code, out) == (3, "")
    assert one_line(err)


@pytest.mark.parametrize(
    ("error", "expected"), [(KeyboardInterrupt(), 130), (ZeroDivisionError("a\nb"), 1), (RecursionError(), 1)]
)
def test_whatever_happens_is_one_line(
    run: Run, case: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, expected: int
) -> None:
    def solve(*_arguments: object, **_options: object) -> None:
        raise error

    monkeypatch.setattr("satsym.solvers.solve", solve)
    code, out, err = run("solve", case, "--json")
    assert (code, out) == (expected, "")
    assert one_line(err)


def test_debugging_shows_the_traceback(run: Run, case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("satsym.solvers.solve", lambda *_arguments, **_options: 1 / 0)
    assert "Traceback" not in run("solve", case)[2]
    monkeypatch.setenv("SATSYM_DEBUG", "1")
    code, _, err = run("solve", case)
    assert code == 1
    assert "Traceback" in err


def test_reader_that_leaves_is_no_error(tmp_path: Path) -> None:
    """As with ``satsym models --json | head -1``."""
    reading, writing = os.pipe()
    os.close(reading)
    try:
        done = subprocess.run(
            [sys.executable, "-m", "satsym", "instances", "--json"],
            env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            stdout=writing,
            stderr=subprocess.PIPE,
            check=False,
            cwd=tmp_path,
        )
    finally:
        os.close(writing)
    assert done.stderr == b""
    assert done.returncode == 141


def test_terminal_without_the_letters_still_gets_the_text(monkeypatch: pytest.MonkeyPatch) -> None:
    plain = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", plain)
    output.emit("θ")
    assert plain.buffer.getvalue() == b"\\u03b8\n"  # type: ignore[attr-defined]


# Progress and colour


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    for name in ("NO_COLOR", "TERM"):
        monkeypatch.delenv(name, raising=False)
    return Terminal()


def test_progress_is_one_line_that_is_gone_at_the_end(
    run: Run, case: Path, terminal: Terminal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stderr", terminal)
    assert run("solve", case, "--json")[0] == 0
    shown = terminal.getvalue()
    assert "iteration 0" in shown
    assert "\n" not in shown
    assert shown.endswith("\r\x1b[K")


def test_progress_is_throttled(terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal)
    with output.live() as line:
        for number in range(1000):
            line.show(f"number {number}")
    assert terminal.getvalue().count("number") < 100


def test_nothing_is_erased_where_nothing_was_shown(terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal)
    with output.live():
        pass
    assert terminal.getvalue() == ""


def test_colour_is_for_terminals_whose_user_wants_it(terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    assert not output.in_colour()
    monkeypatch.setattr(sys, "stdout", terminal)
    assert output.in_colour()
    monkeypatch.setenv("NO_COLOR", "1")
    assert not output.in_colour()


# Deriving and typesetting


@pytest.fixture
def derived(run: Run, derivation: Path, tmp_path: Path) -> Iterator[Path]:
    assert run("derive", derivation, "--out", tmp_path / "made")[0] == 0
    return tmp_path / "made"


def test_own_derivation_becomes_a_model_that_solves(run: Run, derived: Path, case: Path) -> None:
    kinds = ("py", "tex", "derivation.json")
    assert {path.name for path in derived.iterdir()} == {f"short_walk.{kind}" for kind in kinds}
    case.write_text('model = "made/short_walk"\n[initial]\nplace = 1.0\n[time]\ntf = 1.0\n', encoding="utf-8")
    code, out, _ = run("solve", case, "--json")
    # J = u^2 tf + (x0 + u tf)^2 is least at u = -x0 / (1 + tf)
    assert code == 0
    assert json.loads(out)["objective"] == pytest.approx(0.5, abs=1e-9)
    assert "short_walk" in run("models", "made/short_walk")[1]


def test_derived_anew_nothing_changes(run: Run, derivation: Path, derived: Path) -> None:
    code, out, _ = run("derive", derivation, "--out", derived)
    assert code == 0
    assert out.count("unchanged") == 3
    assert run("derive", derivation, "--out", derived, "--check")[0] == 0


def test_stale_files_are_6_with_a_diff_and_the_command_that_mends_them(
    run: Run, derivation: Path, derived: Path
) -> None:
    module = derived / "short_walk.py"
    fresh = module.read_text(encoding="utf-8")
    module.write_text(fresh + "# edited\n", encoding="utf-8")
    code, out, err = run("derive", derivation, "--out", derived, "--check")
    assert code == 6
    assert "-# edited" in out
    assert one_line(err)
    command = err.strip().partition("run: satsym ")[2]
    assert run(*command.split())[0] == 0
    assert module.read_text(encoding="utf-8") == fresh


def test_missing_files_are_stale_and_check_writes_nothing(run: Run, derivation: Path, tmp_path: Path) -> None:
    assert run("derive", derivation, "--out", tmp_path / "none", "--check")[0] == 6
    assert not (tmp_path / "none").exists()


def test_no_file_of_others_is_overwritten(run: Run, derivation: Path, tmp_path: Path) -> None:
    """Not the model itself, either, where the problem has its name."""
    model = derivation.rename(tmp_path / "short_walk.py")
    text = model.read_text(encoding="utf-8")
    code, out, err = run("derive", model, "--out", tmp_path)
    assert (code, out) == (3, "")
    assert one_line(err)
    assert "short_walk.py: this file exists and was not written by satsym; give another folder" in err
    assert [path.name for path in tmp_path.glob("short_walk*")] == ["short_walk.py"]
    assert model.read_text(encoding="utf-8") == text


def test_own_derivation_needs_a_folder(run: Run, derivation: Path) -> None:
    code, out, err = run("derive", derivation)
    assert (code, out) == (2, "")
    assert "--out" in err


def test_checkout_is_derived_whole_and_leftovers_go(
    run: Run, derivation: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder in ("derivations", "generated"):
        (tmp_path / folder).mkdir()
    moved = derivation.rename(tmp_path / "derivations" / derivation.name)
    monkeypatch.setattr("satsym.cli.commands.derive.checkout", lambda: tmp_path)
    monkeypatch.setattr("satsym.source_files.shipped", lambda: [moved])
    generated = tmp_path / "generated"
    (generated / "__init__.py").touch()
    for name in ("old.py", "old.tex"):
        (generated / name).write_text("# Written by satsym from derivations/old.py.\n", encoding="utf-8")
    (generated / "notes.tex").write_text("mine", encoding="utf-8")
    assert run("derive", "--check")[0] == 6
    code, out, _ = run("derive")
    assert code == 0
    assert {path.name for path in generated.iterdir()} == {
        "__init__.py",
        "notes.tex",
        "short_walk.derivation.json",
        "short_walk.py",
        "short_walk.tex",
    }
    assert "notes.tex  was not written by satsym; remove this file" in out
    (generated / "notes.tex").unlink()
    assert run("derive", "--check")[0] == 0
    assert "derivations/walking.py" in (generated / "short_walk.py").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("PROBLEMS = ", "NOTHING = "),
        ("rates={place: speed}", "rates={place: speed"),
        ("rates={place: speed}", "rates={place: nonsense}"),
        ("running_cost=speed**2", "running_cost=-speed**2"),
    ],
    ids=["states nothing", "no Python", "unknown name", "cannot be derived"],
)
def test_bad_derivation_is_3_with_one_line(run: Run, derivation: Path, tmp_path: Path, old: str, new: str) -> None:
    derivation.write_text(DERIVATION.replace(old, new), encoding="utf-8")
    code, out, err = run("derive", derivation, "--out", tmp_path / "made")
    assert (code, out) == (3, "")
    assert one_line(err)
    assert not (tmp_path / "made").exists()


def test_derivation_is_typeset(run: Run, derivation: Path, tmp_path: Path) -> None:
    code, out, err = run("latex", derivation)
    assert (code, err) == (0, "")
    assert "\\begin{document}" in out
    assert run("latex", f"{derivation}:short_walk", "-o", tmp_path / "walk.tex") == (0, "", "")
    assert (tmp_path / "walk.tex").read_text(encoding="utf-8") == out
    assert "\\begin{document}" not in run("latex", derivation, "--fragment")[1]
    assert run("latex", derivation, "--lang", "id")[1] != out
    assert "- L$" in run("latex", derivation, "--convention", "maximum")[1]


@pytest.mark.parametrize("name", ["polar_orbits", "none.py", "walking.py:none"])
def test_unknown_derivation_is_bad_input(run: Run, derivation: Path, name: str) -> None:
    code, out, err = run("latex", name)
    assert (code, out) == (3, "")
    assert one_line(err)


# Doctor


def test_doctor_finds_everything_that_is_required(run: Run) -> None:
    code, out, _ = run("doctor", "--json")
    found = json.loads(out)
    assert code == 0
    assert found["healthy"] is True
    assert {"Python", "numpy", "sympy", "pdflatex", "models", "solve soft-return"} <= {
        finding["name"] for finding in found["findings"]
    }


def test_doctor_names_what_is_broken(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "satsym.cli.requirements._stated", lambda: ["no-such-thing>=1", "numpy<2", 'x; extra == "fast"']
    )
    code, out, _ = run("doctor")
    assert code == 1
    assert "no-such-thing BROKEN not installed" in " ".join(out.split())
    assert "needs numpy <2" in out


# What is loaded, which is most of the time of a short command

HEAVY = {"scipy", "pint", "rich", "typer", "pydantic", "sympy", "matplotlib", "numba"}


@pytest.mark.parametrize(
    ("arguments", "needless"),
    [(["--help"], HEAVY | {"numpy"}), (["solve", "--help"], HEAVY | {"numpy"}), (["solve", "its-thesis"], HEAVY)],
    ids=["--help", "solve --help", "solve"],
)
def test_no_library_is_loaded_that_a_command_does_not_need(
    arguments: list[str], needless: set[str], tmp_path: Path
) -> None:
    code = f"""
import atexit, sys
from satsym.cli import main
atexit.register(lambda: print(*sys.modules, file=sys.stderr))
sys.exit(main({arguments}))
"""
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        capture_output=True,
        text=True,
        check=True,
        cwd=tmp_path,
    )
    loaded = set(done.stderr.split())
    assert "satsym.cli" in loaded
    assert not loaded & needless


def test_what_takes_long_is_said_at_once_and_to_nobody_else(monkeypatch: pytest.MonkeyPatch) -> None:
    written: list[str] = []
    monkeypatch.setattr("satsym.cli.output._is_terminal", lambda _stream: True)
    monkeypatch.setattr("satsym.cli.output._write", lambda _stream, text: written.append(text))
    activity.tell("nobody hears this")
    with live() as line:
        line.show("iteration 1")
        line.show("iteration 2, a moment later")
        activity.tell("compiling ...")
    activity.tell("nobody hears this either")
    assert [text.removeprefix("\r\x1b[K") for text in written] == ["iteration 1", "compiling ...", ""]


def test_ranges_are_refused_on_the_command_line_with_the_place_where_they_stand(run: Run) -> None:
    for given in ("[1,2]", " [0.9, 1.1]"):
        code, _, err = run("solve", "soft-return", "--set", f"initial.r={given}")
        assert code == 3
        assert err.count("\n") == 1
        assert "is not a number; ranges and bounds can be set only in the instance file" in err
