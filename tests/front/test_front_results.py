"""Solutions and trajectories as users meet them: at any time, as arrays, in notebooks, in folders."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy

import satsym
from satsym.cli import main
from satsym.front import html
from satsym.front.between import Motion
from satsym.front.solution import Trajectory
from satsym.instance.files import SHIPPED
from satsym.kernels.digest import sealed
from satsym.status import BadInput
from tests.support import solved as known
from tests.support.front import PUSH, pushed
from tests.support.switching_models import DAMPER, OSCILLATOR


@pytest.fixture(autouse=True)
def _solved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Equal instances are solved once, whichever way they come: these tests compare what becomes of the answers."""
    monkeypatch.setattr("satsym.solvers.solve", known.solve)


@cache
def solved(name: str, **options: Any) -> satsym.Solution:
    case = {
        "sled": pushed,
        "singular": lambda: ending_in_a_singular_arc(OSCILLATOR, {"x1": 0, "x2": 1}),
        "damper": lambda: ending_in_a_singular_arc(DAMPER, {"x1": 1, "x2": 0.5}),
    }.get(name, lambda: satsym.load(name))()
    return satsym.solve(case, **options)


def ending_in_a_singular_arc(problem: satsym.Problem, initial: dict[str, float]) -> satsym.Instance:
    return satsym.Instance.of(problem, initial=initial, tf=4, control={"u1": [-1, 1]}, name="singular")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "steps", "limit"),
    [
        ("soft-return", 20, 1e-10),
        ("sled", 23, 1e-10),  # both bounds, between nodes
        ("return-to-orbit-ball", 37, 1e-10),
        ("lapan-minimum-time", 37, 1e-12),
        ("double-integrator-fuel", 37, 1e-12),
        ("ends-4-rendezvous", 37, 1e-10),
        ("damper", 100, 1e-9),
        pytest.param("singular", 100, 1e-9, marks=pytest.mark.study),
    ],
)
def test_between_few_nodes_it_is_what_it_is_at_many(name: str, steps: int, limit: float) -> None:
    few, many = solved(name, steps=steps), solved(name)
    t = many.times[(many.times <= few.times[-1]) & np.concatenate([[True], np.diff(many.times) > 0])][:-1]
    at = np.searchsorted(many.times, t, side="right") - 1
    for kind in ("x", "u", "lam"):
        seen, known = getattr(few, kind)(t), np.asarray(getattr(many, kind))[:, at]
        assert np.abs(seen - known).max() <= limit * np.abs(known).max(), kind


def test_a_corner_between_nodes_is_integrated_from_both_sides() -> None:
    corner = 0.3

    def rates(t: Any, z: Any, _: Any) -> Any:
        return np.maximum(t - corner, 0.0)[None] + 0.0 * z

    end = 0.5 * (1.0 - corner) ** 2
    motion = Motion(np.array([0.0, 1.0]), np.array([[0.0, end]]), rates, np.array([corner]), 1e-9)
    t = np.linspace(0.0, 1.0, 101)
    assert motion(t)[0] == pytest.approx(0.5 * np.maximum(t - corner, 0.0) ** 2, abs=1e-13)  # rounding of 64 steps


def test_controls_jump_where_they_switch_and_keep_their_bounds() -> None:
    found = solved("double-integrator-time", steps=11)
    ((switch,),) = found.switching_times.values()
    before, after = found.u(switch - 1e-9), found.u(switch)
    assert before == pytest.approx(-after)
    sled = solved("sled", steps=23)
    thrust = sled.u(np.linspace(0.0, 2.2, 4001))
    assert np.abs(thrust).max() == 1.2
    first, last = sled.switching_times["a"]
    assert sled.u["a"](0.5 * first) == 1.2
    assert sled.u["a"](first + 1e-6) < 1.2
    assert sled.u["a"](0.5 * (last + 2.2)) == -1.2


def test_at_nodes_it_is_what_it_is_there_and_it_indexes_like_an_array() -> None:
    found = solved("soft-return")
    for kind in ("x", "u", "lam"):
        curve, stored = getattr(found, kind), getattr(found.found, kind)
        assert np.array_equal(curve(found.times), stored)
        assert np.asarray(curve) is stored
        assert curve[0, -1] == stored[0, -1]
    assert found.x["theta"][3] == found.found.x[2, 3]
    assert found.x["theta"](1.0) == found.x(1.0)[2]
    assert isinstance(found.x["r"](1.0), float)
    assert found.x([[0.0, 1.0, 2.0]]).shape == (4, 1, 3)
    assert found.u([]).shape == (2, 0)
    assert (found.x.shape, len(found.x), found.x.max()) == (found.found.x.shape, 4, found.found.x.max())
    assert np.array_equal(2 * found.x - found.x, found.found.x)
    assert np.array_equal(np.maximum(found.u, 0.0), np.maximum(found.found.u, 0.0))
    assert [len(row) for row in found.lam] == [len(found.times)] * 4


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (lambda s: s.x(6.3), "x: the time 6.3 does not lie between 0 and 6.283185307"),
        (lambda s: s.u["u1"]([1.0, -0.5]), 'u["u1"]: the time -0.5 does not lie between 0 and'),
        (lambda s: s.lam(float("nan")), "lam: the time nan does not lie between 0 and"),
        (lambda s: s.x("soon"), 'x: "soon" is not a time'),
        (lambda s: s.x["q"], 'x: has no "q"; available: r, r_dot'),
        (lambda s: s.plot()["orbits"], 'there is no picture "orbits"; did you mean "orbit"'),
    ],
)
def test_what_cannot_be_asked_is_refused_in_a_line(asked: Any, line: str) -> None:
    with pytest.raises(BadInput) as found:
        asked(solved("soft-return"))
    assert str(found.value).startswith(line)


def test_rounding_of_the_final_time_is_no_time_outside() -> None:
    found = solved("soft-return")
    assert np.array_equal(found.x(float(found.times[-1]) * (1 + 1e-15)), found.found.x[:, -1])


def test_without_an_answer_it_says_so_and_has_no_trajectory() -> None:
    found = satsym.solve(pushed().with_(control={"a": (-0.5, 0.5)}))
    assert found.status == "infeasible"
    assert "infeasible" in repr(found)
    assert found.to_dict()["objective"] is None
    with pytest.raises(BadInput, match="there is no trajectory"):
        found.x(0.0)
    assert "infeasible" in found._repr_html_()


def test_a_simulated_motion_is_as_accurate_between_its_nodes() -> None:
    few, many = (satsym.simulate(satsym.load("geo-lqr").with_(solver={"steps": n}), "lqr") for n in (500, 2000))
    assert few.status.answered
    for kind, limit in (("x", 1e-8), ("u", 1e-6)):
        seen, known = getattr(few, kind)(many.times), np.asarray(getattr(many, kind))
        assert (np.abs(seen - known).max(axis=1) <= limit * np.abs(known).max(axis=1)).all(), kind


def test_what_is_saved_comes_back_with_its_certificate_and_instance(tmp_path: Path) -> None:
    for found in (solved("soft-return"), solved("sled", steps=23)):
        folder = tmp_path / found.instance.name
        paths = found.save(folder)
        again = satsym.Solution.load(folder)
        # the file of the instance is now the one beside the result
        assert again.to_dict() == found.to_dict() | {"instance_file": again.to_dict()["instance_file"]}
        assert again.instance.to_dict() == found.instance.to_dict()
        t = np.linspace(0.0, float(found.times[-1]), 77)
        assert np.array_equal(again.x(t), found.x(t))
        assert np.array_equal(again.u(t), found.u(t))
        assert {path.name for path in paths} >= {"trajectory.npz", "trajectory.csv", "result.json"}
        assert set(paths) == set(folder.iterdir())
    assert main(["solve", str(tmp_path / "sled" / "sled.toml"), "--json"]) == 0


def test_a_model_of_ones_own_comes_back_though_a_shipped_one_has_its_name(tmp_path: Path) -> None:
    ours = pushed().with_(model=replace(PUSH, name="polar_orbit"), solver={"steps": 20})
    satsym.simulate(ours).save(tmp_path)
    assert Trajectory.load(tmp_path).instance.case.model.spec.state_names == ("q", "v")


def test_what_the_command_line_saved_comes_back_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "soft-return", "--out", str(tmp_path / "a")]) == 0
    assert satsym.Solution.load(tmp_path / "a").objective == solved("soft-return").objective
    assert main(["simulate", "soft-return", "--out", str(tmp_path / "b")]) == 0
    assert Trajectory.load(tmp_path / "b").x(0.0)[0] == 1.1
    with pytest.raises(BadInput, match="contains the result of simulate, not of solve"):
        satsym.Solution.load(tmp_path / "b")
    with pytest.raises(BadInput, match="to soft-return"):
        satsym.Solution.load(tmp_path / "a", "its-thesis")
    capsys.readouterr()


def test_a_file_with_the_name_of_a_shipped_instance_gets_its_own_result(tmp_path: Path) -> None:
    own = tmp_path / "soft-return.toml"
    own.write_text(satsym.load("soft-return").with_(tf=7.0).to_toml(), encoding="utf-8")
    assert main(["simulate", str(own), "--out", str(tmp_path / "a")]) == 0
    assert Trajectory.load(tmp_path / "a", own).times[-1] == 7.0


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"tf": 7.0}, "tf"),
        ({"final": {"r": 1.01}}, "final"),
        ({"parameters": {"c1": 2.0}}, "parameters"),
        ({"control": {"u1": [-5.0, 5.0]}}, "lower, upper"),
        ({"limits": {"r": 5.0}}, "limits"),
    ],
)
def test_a_result_is_not_loaded_for_an_instance_that_has_changed(
    tmp_path: Path, changes: dict[str, Any], what: str
) -> None:
    solution = solved("soft-return")
    solution.save(tmp_path)
    assert satsym.Solution.load(tmp_path, solution.instance.with_(title="anew", solver={"steps": 7}))
    with pytest.raises(BadInput, match=f"was computed from a different soft-return: {what} differ"):
        satsym.Solution.load(tmp_path, solution.instance.with_(**changes))


def test_a_changed_instance_does_not_come_back_as_the_shipped_one(tmp_path: Path) -> None:
    found = satsym.solve(satsym.load("soft-return").with_(initial={"r": 1.05}), steps=20)
    found.save(tmp_path)
    assert satsym.Solution.load(tmp_path).instance.case.initial[0] == 1.05
    with pytest.raises(BadInput, match="does not start from the initial state of"):
        satsym.Solution.load(tmp_path, "soft-return")


def test_damaged_results_are_refused(tmp_path: Path) -> None:
    solved("sled", steps=23).save(tmp_path)
    text = (tmp_path / "sled.toml").read_text()
    (tmp_path / "sled.toml").write_text(text.replace("2.2", "2.3"))
    with pytest.raises(BadInput, match=r"sled\.toml: is listed in result\.json, but is missing or has changed"):
        satsym.Solution.load(tmp_path)
    with pytest.raises(BadInput):
        satsym.Solution.load(tmp_path / "nowhere")


def test_what_the_command_line_wrote_of_an_instance_elsewhere_is_loaded_with_its_file(tmp_path: Path) -> None:
    mine = tmp_path / "mine.toml"
    mine.write_text((SHIPPED / "soft-return.toml").read_text())
    assert main(["solve", str(mine), "--out", str(tmp_path / "out"), "--json"]) == 0
    with pytest.raises(BadInput, match=r'give its file as well, as in Solution.load\(FOLDER, "mine.toml"\)'):
        satsym.Solution.load(tmp_path / "out")
    assert satsym.Solution.load(tmp_path / "out", mine).objective == pytest.approx(4.26589411e-4, rel=1e-8)


def test_html_holds_no_foreign_markup_and_nothing_from_elsewhere() -> None:
    found = solved("soft-return")
    evil = replace(found.found, message="<script>alert(1)</script>")
    named = satsym.Solution(found.instance.with_(title="<b>&"), evil)
    for page in (
        named._repr_html_(),
        named.instance.to_toml() and satsym.derive("double_integrator_time")._repr_html_(),
    ):
        assert "<script" not in page
        assert "http" not in page
    assert "&lt;b&gt;&amp;" in named._repr_html_()
    assert "&lt;script&gt;" in named._repr_html_()
    assert "certified" in named._repr_html_()


def test_numbers_in_tables_stay_in_one_line_and_words_do_not() -> None:
    shown = html.table(("condition", "measured", "limit"), [("boundary conditions satisfied", -4e-13, 1e-9)])
    assert shown.count("white-space: nowrap") == 2
    assert "<td>boundary conditions satisfied</td>" in shown
    assert "nowrap" not in html.facts({"method": "collocation, 4 iterations"})


@pytest.mark.slow
def test_pictures_are_figures_files_and_html(tmp_path: Path) -> None:
    pictures = solved("double-integrator-time", steps=11).plot(tmp_path / "there", formats=("pdf",))
    assert next(iter(pictures)) == "overview"
    assert pictures["overview"].axes
    assert {path.name for path in (tmp_path / "there").iterdir()} == {f"{name}.pdf" for name in pictures}
    assert pictures._repr_html_().count("data:image/png;base64,") == len(pictures)
    with pytest.raises(BadInput, match='there is no picture format "jpg"'):
        pictures.save(tmp_path, ("jpg",))


def test_a_derivation_shows_its_equations() -> None:
    derivation = satsym.derive("polar_orbit")
    equation = derivation["costate_equations.r"]
    assert isinstance(equation.latex, str)
    assert equation == derivation["polar_orbit:costate_equations.r"] == derivation["costate_equations"]["r"]
    assert equation.rhs == derivation.derived.equation("costate_equations.r").rhs
    assert equation._repr_latex_().startswith("$")
    assert derivation["linearisation.A"].shape == (4, 4)
    assert "costate_equations.r" in derivation
    assert "costate_equations.q" not in derivation
    assert r"\lambda" in derivation._repr_latex_()
    assert len(list(derivation)) > 50
    assert len(repr(derivation).splitlines()) == 1 + len(derivation.derived.steps)
    assert derivation.latex("id", fragment=True) != derivation.latex()


def test_kernels_are_those_of_the_minimum_convention(repository: Path) -> None:
    derivation = satsym.derive("double_integrator_time", "maximum")
    assert derivation.kernels.text == sealed((repository / "generated" / "double_integrator_time.py").read_text())
    assert derivation["hamiltonian.H"].rhs != satsym.derive("double_integrator_time")["hamiltonian.H"].rhs


def test_symbols_name_what_they_are_symbols_of() -> None:
    found = solved("soft-return")
    assert found.x[sympy.Symbol("r", positive=True)](0.0) == found.x["r"](0.0)
    with pytest.raises(BadInput, match="has no"):
        found.x[sympy.Symbol("rr")]
