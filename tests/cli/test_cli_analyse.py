"""``satsym analyse``, ``satsym lqr`` and ``simulate --feedback lqr`` as their users meet them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy

from satsym import instance, kernels
from satsym.analysis.linear.equilibrium import linearise
from satsym.analysis.regulator.feedback import designed
from satsym.analysis.regulator.feedback import responses as linear_and_exact
from satsym.analysis.subject import analyse
from satsym.cli import main
from satsym.report.plots import plane, responses, style, systems
from satsym.report.results.linear import analysis_object, exact, regulator_object
from satsym.report.results.objects import of_regulator
from satsym.report.terminal.linear import analysis_text, regulator_text
from tests.house.test_floors import run_satsym

Run = Callable[..., tuple[int, str, str]]

HEAD = "satsym schema command model instance status units instance_file "
ANALYSIS_KEYS = (
    HEAD
    + "equilibrium A B C eigenvalues modes jordan_blocks characteristic_polynomial routh stability controllability "
    "observability exact exact_omitted orbit point floquet"
).split()
REGULATOR_KEYS = (
    HEAD + "inputs K P riccati_residual riccati_error closed_loop_eigenvalues characteristic_polynomial routh "
    "cost_from_initial"
).split()

WEIGHTED = """
model = "polar_orbit"
[initial]
r = 1.001
r_dot = 0.0
theta = 0.0
theta_dot = 1.0
[time]
tf = 5.0
[lqr]
Q = {Q}
R = {R}
inputs = {inputs}
"""


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Exit code, stdout and stderr of a command, run in an empty folder of its own."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str | Path) -> tuple[int, str, str]:
        code = main([str(argument) for argument in arguments])
        return code, *capsys.readouterr()

    return run


def weighted(folder: Path, Q: str = "[1, 1, 1, 1]", R: str = "[1]", inputs: str = '["u2"]') -> Path:
    path = folder / "weighted.toml"
    path.write_text(WEIGHTED.format(Q=Q, R=R, inputs=inputs), encoding="utf-8")
    return path


def leaves(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return [leaf for entry in value.values() for leaf in leaves(entry)]
    return [leaf for entry in value for leaf in leaves(entry)] if isinstance(value, list) else [value]


def test_analyse_prints_the_agreed_object(run: Run) -> None:
    code, out, err = run("analyse", "soft-return-geo", "--json")
    found = json.loads(out)
    assert (code, err, list(found)) == (0, "", ANALYSIS_KEYS)
    assert list(found["equilibrium"]) == ["r", "r_dot", "theta", "theta_dot"]
    assert [list(each) for each in found["eigenvalues"]] == [["value", "algebraic", "geometric"]] * 3
    assert found["eigenvalues"][0] == {"value": {"re": 0.0, "im": 0.0}, "algebraic": 2, "geometric": 1}
    assert found["jordan_blocks"][0] == {"eigenvalue": {"re": 0.0, "im": 0.0}, "size": 2}
    assert list(found["routh"]) == ["column", "sign_changes", "special_case"]
    assert found["routh"]["special_case"] == "row of zeros"
    assert found["characteristic_polynomial"][0] == 1.0
    assert found["stability"]["verdict"] == "unstable"
    assert found["controllability"] == {"rank": 4, "by_input": {"u1": 3, "u2": 4}}
    assert found["observability"] is None  # this model declares no outputs


def test_the_exact_part_says_the_same_as_the_numbers() -> None:
    found = analyse(instance.load("uny-lqr"))
    result = analysis_object(found, *exact(found.about))
    strings = result["exact"]
    assert strings is not None
    assert all(not isinstance(leaf, float) for leaf in leaves({k: strings[k] for k in ("A", "B", "C", "eigenvalues")}))
    values = {complex(sympy.sympify(each["value"]).subs("omega", 1)): each for each in strings["eigenvalues"]}
    for each in result["eigenvalues"]:
        value = complex(each["value"]["re"], each["value"]["im"])
        nearest = min(values, key=lambda exactly: abs(exactly - value))
        assert abs(nearest - value) < 1e-12
        assert [each[k] for k in ("algebraic", "geometric")] == [values[nearest][k] for k in ("algebraic", "geometric")]
    assert strings["stability"]["verdict"] == result["stability"]["verdict"]
    assert strings["routh"]["sign_changes"] == result["routh"]["sign_changes"]
    assert strings["controllability"]["by_input"] == result["controllability"]["by_input"]
    assert strings["observability"]["by_output"] == result["observability"]["by_output"]
    assert result["observability"] == {"rank": 4, "by_output": {"y1": 3, "y2": 4}}


def test_models_that_are_not_linear_have_no_exact_part() -> None:
    assert exact(linearise(kernels.load("polar_orbit"))) == (None, "")


def test_an_exact_part_that_is_left_out_is_said_to_be_so(run: Run) -> None:
    code, out, _ = run("analyse", "roll_yaw", "--json")
    found = json.loads(out)
    assert (code, found["exact"]) == (0, None)
    assert "12 states and 17 parameters" in found["exact_omitted"]
    assert "17 parameters" in " ".join(run("analyse", "roll_yaw")[1].split())
    assert "letters" not in run("analyse", "clohessy_wiltshire")[1]


def test_lqr_prints_the_agreed_object(run: Run) -> None:
    code, out, err = run("lqr", "uny-lqr", "--json")
    found = json.loads(out)
    assert (code, err, list(found)) == (0, "", REGULATOR_KEYS)
    assert found["inputs"] == ["u2"]
    assert np.shape(found["K"]) == (1, 4)
    assert np.shape(found["P"]) == (4, 4)
    assert found["riccati_residual"] < 1e-12
    assert [list(value) for value in found["closed_loop_eigenvalues"]] == [["re", "im"]] * 4
    assert found["characteristic_polynomial"][0] == 1.0
    assert found["routh"]["sign_changes"] == 0
    assert found["cost_from_initial"] == pytest.approx(94.732181355, rel=1e-9)  # pinned; see test_lqr for its truth


def test_a_model_has_all_weights_1_and_no_initial_cost(run: Run) -> None:
    code, out, _ = run("lqr", "clohessy_wiltshire", "--json")
    found = json.loads(out)
    assert (code, found["inputs"], found["cost_from_initial"]) == (0, ["u1", "u2"], None)
    assert found["K"] == regulator_object(designed(instance.load("uny-lqr-both")))["K"]


@pytest.mark.parametrize("subject", ["uny-lqr", "geo-lqr"])
def test_people_get_a_summary(run: Run, subject: str) -> None:
    code, out, err = run("lqr", subject)
    assert (code, err) == (0, "")
    assert "u = -K x for an infinite horizon" in out
    assert "Riccati residual" in out
    assert max(map(len, out.splitlines())) <= 100
    code, out, err = run("analyse", subject)
    assert (code, err) == (0, "")
    assert "Jordan block of size 2" in out
    assert "u1 alone: 3 (without the mode s = 0)" in " ".join(out.split())
    assert max(map(len, out.splitlines())) <= 100


def test_summaries_of_other_kinds_of_systems() -> None:
    saddle = analysis_text(analyse(kernels.load("saddle")), colour=True)
    assert "\x1b[31munstable\x1b[0m" in saddle
    assert "controllability: there are no inputs" in saddle
    horizon = designed(instance.load("uny-lqr"))
    assert "cost from the initial state" in regulator_text(horizon)


@pytest.mark.parametrize(
    ("weights", "complaint"),
    [
        ({"Q": "[1, 1, -0.1, 1]"}, "[lqr] Q: the cost has no lower bound, because at the frequency 0 "),
        ({"Q": "[[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"}, "[lqr] Q: not symmetric"),
        ({"R": "[0]"}, "[lqr] R: not positive definite"),
        ({"inputs": '["u1"]'}, "[lqr] inputs: not stabilisable, the inputs u1 cannot control the mode s = 0"),
        ({"Q": "[1, 1, 0, 1]"}, "[lqr] Q: not detectable, the mode s = 0"),
    ],
)
@pytest.mark.parametrize("command", [["lqr"], ["simulate", "--feedback", "lqr"]], ids=" ".join)
def test_bad_weights_end_with_exit_3_and_the_reason(run: Run, tmp_path: Path, command, weights, complaint) -> None:
    code, out, err = run(*command, weighted(tmp_path, **weights))
    assert (code, out) == (3, "")
    assert complaint in err
    assert err.count("\n") == 1


@pytest.mark.parametrize("command", ["analyse", "lqr"])
def test_unknown_subjects_are_told_apart_from_near_ones(run: Run, command: str) -> None:
    code, out, err = run(command, "uny-lrq")
    assert (code, out) == (3, "")
    assert 'did you mean "uny-lqr"?' in err
    assert run(command, "no_such.toml")[0] == 3


def test_an_instance_without_weights_is_told_what_to_add(run: Run) -> None:
    assert run("lqr", "its-thesis") == (
        3,
        "",
        "satsym: its-thesis: [lqr]: missing; add a table with the weights Q and R\n",
    )


def test_simulate_follows_the_law(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("simulate", weighted(tmp_path), "--feedback", "lqr", "--json")
    found = json.loads(out)
    assert (code, found["feedback"], found["invariants"]) == (0, "lqr", {})
    assert found["metrics"]["lqr_cost"] > 0.0


@pytest.mark.slow
def test_files_and_pictures_go_where_they_are_asked_for(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("lqr", weighted(tmp_path), "--plot", "--out", "there")
    assert code == 0
    assert sorted(path.name for path in (tmp_path / "there").iterdir()) == [
        "basin.png",
        "differences.png",
        "eigenvalues.png",
        "responses.png",
        "result.json",
    ]
    assert "written to there: eigenvalues.png" in out
    assert list(json.loads((tmp_path / "there/result.json").read_text())) == [*REGULATOR_KEYS, "files"]
    code, _, _ = run("analyse", "saddle", "--plot")
    assert code == 0
    assert sorted(path.name for path in (tmp_path / "results/saddle/analyse").iterdir()) == [
        "eigenvalues.png",
        "phase.png",
        "result.json",
    ]


def test_the_nine_figures_of_the_thesis_are_on_the_page() -> None:
    """Each state without control and with the gain, the exact motion beside the linear one, the input and the cost."""
    case = instance.load("uny-lqr")
    with style.applied():
        page = responses.page(design := designed(case), responses.Responded.of(design, case))
        labels = [axes.get_ylabel() for axes in page.axes]
        assert labels == [*(f"$x_{i}$ [{u}]" for i, u in enumerate(["km", "km/s"] * 2, start=1))] * 2 + [
            "$u_2$ [km/s²]",
            "$J$ [km²/s³]",
        ]
        assert [len(axes.get_lines()) for axes in page.axes] == [3] * 10  # zero, linear, nonlinear
        left, right = page.axes[2].get_lines()[1].get_ydata(), page.axes[6].get_lines()[1].get_ydata()
        assert np.abs(left[-1]) > 100.0
        assert np.abs(right[-1]) < 1e-9


def test_where_linear_and_exact_response_are_one_curve_their_difference_is_drawn() -> None:
    """In the unit that its label says; an exact motion that is seen beside the linear one needs no such page."""
    design = designed(instance.load("geo-lqr"))
    found = linear_and_exact(design, design.instance)
    with style.applied():
        drawn = responses.differences(design, responses.Responded.of(design, design.instance))
        assert drawn is not None
        by_label = {axes.get_ylabel(): axes.get_lines()[1].get_ydata() for axes in drawn.axes}
        far = designed(instance.load("uny-lqr"))
        assert responses.differences(far, responses.Responded.of(far, far.instance)) is None
    assert len(drawn.axes) == 4 + 4 + 2 + 1
    apart = found.exact_steered.x[2] - found.steered.x[2]
    assert np.allclose(by_label[r"$\delta\,$$\Delta \theta$ [nrad]"], apart * 1e9)
    assert 0.0 < np.abs(apart).max() < 1e-3 * np.abs(found.steered.x[2]).max()


def test_eigenvalues_are_drawn_where_they_are() -> None:
    design = designed(instance.load("geo-lqr"))
    with style.applied():
        axes = plane.of_design(design).axes[0]
        assert axes.get_xlabel().endswith("[1/h]")
        drawn = axes.get_lines()[-1]
        assert np.allclose(drawn.get_xdata(), design.regulator.eigenvalues.real * 3600.0)
        assert np.allclose(drawn.get_ydata(), design.regulator.eigenvalues.imag * 3600.0)
        assert systems.portrait(analyse(kernels.load("three_modes"))) is None


def test_a_regulator_needs_neither_sympy_nor_matplotlib(tmp_path: Path) -> None:
    loaded = run_satsym(["lqr", "uny-lqr", "--json"], tmp_path)
    assert "numpy" in loaded
    assert not loaded & {"sympy", "matplotlib", "numba", "control"}


@pytest.mark.parametrize(("name", "unit"), [("geo-lqr", "s"), ("uny-lqr", "km**2/s**3"), ("lapan-roll-yaw-lqr", "s")])
def test_what_a_regulator_minimises_has_a_unit(name: str, unit: str) -> None:
    """R is for plain numbers, or what is allowed makes them plain."""
    design = designed(instance.load(name))
    assert of_regulator(design.about.model.spec, design.regulator.system.inputs, design.relative) == unit
    assert regulator_text(design).rstrip().endswith(f" {unit}")
