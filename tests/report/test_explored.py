"""The interactive part of a page: what it shows is what was found, and the page needs nothing but itself."""

from __future__ import annotations

import json
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from satsym import instance
from satsym.analysis.regulator.feedback import simulate
from satsym.report.html.markup import Markup
from satsym.report.page import explored as shown_as
from satsym.report.page import run as run_page
from satsym.report.page.explore import explored
from satsym.report.page.explored import Answer, data, shown, switching_functions
from satsym.report.page.run import Given, render
from satsym.report.plots.scene import Scene
from satsym.report.plots.space.attitudes import Attitude, about, turned_by
from satsym.report.texts import load
from satsym.solution import Solution
from satsym.status import BadInput
from tests.cli.test_cli import Run, run
from tests.support.solved import solve

__all__ = ["run"]

LARGEST = 8_000_000
"""Bytes of a page."""


@pytest.fixture(scope="module")
def quickest() -> Solution:
    return solve(instance.load("double-integrator-time"))


@pytest.fixture(scope="module")
def returned() -> Solution:
    return solve(instance.load("return-to-orbit"))


def test_panels_hold_the_states_controls_and_costates_of_the_answer(returned: Solution) -> None:
    (answer,) = data([Answer(returned)])["answers"]
    assert answer["t"][0] == 0.0
    assert answer["t"][-1] == pytest.approx(2.0 * np.pi, rel=1e-5)
    groups = [panel["group"] for panel in answer["panels"]]
    assert groups == ["state"] * 4 + ["control"] * 2 + ["costate"] * 5, "with H"
    for panel, row in zip(answer["panels"], returned.x, strict=False):
        np.testing.assert_allclose(panel["values"], np.interp(answer["t"], returned.times, row), atol=2e-5)
    assert answer["panels"][0]["label"] == "r"
    assert answer["panels"][3]["label"] == "θ\N{COMBINING DOT ABOVE}"
    assert answer["cost"].startswith("0.00319465"), "as satsym solve has it"


def test_the_switching_function_stands_below_its_control_and_vanishes_where_that_switches(quickest: Solution) -> None:
    (answer,) = data([Answer(quickest)])["answers"]
    groups = [panel["group"] for panel in answer["panels"]]
    place = groups.index("switching")
    assert groups[place - 1] == "control"
    function, control = answer["panels"][place], answer["panels"][place - 1]
    (mark,) = control["marks"]
    assert mark == pytest.approx(1.0)
    assert np.interp(mark, answer["t"], function["values"]) == pytest.approx(0.0, abs=1e-3)
    before = np.array(answer["t"]) < 0.99
    assert (np.array(function["values"])[before] > 0.0).all(), "the lower bound is best"
    assert (np.array(control["values"])[before] == -1.0).all()


def test_a_switching_function_is_the_slope_of_the_hamiltonian(quickest: Solution) -> None:
    """Of a body on a line it is the costate of its velocity."""
    (one,) = switching_functions(Scene.of(quickest))
    assert one.controls == (0,)
    np.testing.assert_allclose(one.values, quickest.lam[1], atol=1e-12)


def test_controls_that_cost_a_square_have_none(returned: Solution) -> None:
    case = replace(returned.instance, lower=(-1.0, -1.0), upper=(1.0, 1.0))
    assert switching_functions(Scene.of(replace(returned, instance=case))) == []


def test_nodes_at_which_a_control_jumps_are_kept_among_few(monkeypatch: pytest.MonkeyPatch, quickest: Solution) -> None:
    monkeypatch.setattr(shown_as, "NODES", 5)
    (answer,) = data([Answer(quickest)])["answers"]
    assert len(answer["t"]) <= 8
    control = next(panel for panel in answer["panels"] if panel["group"] == "control")
    assert set(control["values"]) == {-1.0, 1.0}


def test_quaternions_turn_as_their_rates_say() -> None:
    """R' = R [w]x for body rates w, with the quaternion integrated here in small steps."""
    model = instance.load("reorientation").model
    p = instance.load("reorientation").parameters
    w = np.array([0.3, -0.2, 0.5])
    x = np.array([0.1, 0.2, 0.3, np.sqrt(1.0 - 0.14), *w])
    step = 1e-6
    rate = np.array(model.dynamics(0.0, tuple(x), (0.0, 0.0, 0.0), p))
    both = np.column_stack([x - step * rate, x + step * rate])
    before, after = turned_by(both[:4])
    (middle,) = turned_by(x[:4, None])
    cross = np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])
    np.testing.assert_allclose((after - before) / (2.0 * step), middle @ cross, atol=1e-8)
    np.testing.assert_allclose(middle @ middle.T, np.eye(3), atol=1e-14)


def test_a_turn_about_an_axis_turns_the_next_axis_to_the_one_after() -> None:
    for axis in range(3):
        (turn,) = about(axis, np.array([np.pi / 2.0]))
        unit = np.eye(3)
        np.testing.assert_allclose(turn @ unit[axis], unit[axis], atol=1e-15)
        np.testing.assert_allclose(turn @ unit[(axis + 1) % 3], unit[(axis + 2) % 3], atol=1e-15)


def test_small_angles_are_magnified_and_it_is_said_by_how_much() -> None:
    found = Attitude.of(Scene.of(simulate(instance.load("gravity-gradient"), None)))
    assert found is not None
    assert found.magnified > 1.0
    (answer,) = data([Answer(replace(solve(instance.load("lapan-minimum-time"))))])["answers"]
    (scene,) = answer["scenes"]
    assert scene["kind"] == "attitude"
    turn = np.array(scene["turns"]).reshape(-1, 3, 3)
    np.testing.assert_allclose(turn[:, 1, 1], 1.0, atol=1e-9)
    pitch = np.arctan2(turn[-1, 0, 2], turn[-1, 0, 0])
    assert pitch == pytest.approx(0.025 * float(scene["magnified"]), rel=1e-4)


def test_what_is_met_moves_along_its_orbit_and_ends_at_the_final_condition() -> None:
    case = instance.load("transfer-fuel")
    found = simulate(case, None)
    fake = Solution(
        case, "none", found.status, "", 0.0, found.times, found.x, found.u + 0.01, 0.0 * found.x, ((), ()), 0, (), 0.0
    )
    (answer,) = data([Answer(fake)])["answers"]
    (scene,) = answer["scenes"]
    moving = np.array(scene["moving"])
    np.testing.assert_allclose(np.hypot(*moving), 1.5, rtol=1e-4)
    np.testing.assert_allclose(moving[:, -1], 1.5 * np.array([np.cos(8.5), np.sin(8.5)]), rtol=1e-3)
    np.testing.assert_allclose(np.array(scene["target"])[:, 0], moving[:, -1], rtol=1e-3)
    assert scene["thrust"]


def test_a_path_in_space_has_three_coordinates() -> None:
    case = instance.load("molniya")
    found = simulate(case, None)
    rest = np.zeros((3, len(found.times)))
    fake = Solution(case, "none", found.status, "", 0.0, found.times, found.x, rest, found.x, ((),) * 3, 0, (), 0.0)
    scene = data([Answer(fake)])["answers"][0]["scenes"][0]
    assert scene["kind"] == "space"
    assert len(scene["path"]) == 3
    assert scene["body"] == "Earth"
    largest = max(abs(value) for row in scene["path"] for value in row)
    assert scene["radius"] / largest == pytest.approx(6378.1366 / np.abs(found.x[:3]).max(), rel=1e-3)


def test_the_page_loads_nothing_and_is_the_static_one_but_for_what_scripts_show(
    returned: Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("overview", "pictures"):  # of the same solution: they are drawn once
        drawn = getattr(run_page, name)(returned, load("en"))
        monkeypatch.setattr(run_page, name, lambda solution, _, drawn=drawn: drawn if solution is returned else None)
    static = render(returned, None, Given("return-to-orbit"))
    page = render(returned, None, Given("return-to-orbit"), "en", [Answer(returned)])
    assert len(page.encode("utf-8")) <= LARGEST
    assert not re.search(r"<(script|link|img|iframe)\b[^>]*\b(src|href)=", page)
    assert page.count("<script") >= 3
    without = re.sub(r"<(script|noscript).*?</\1>", "", page, flags=re.S)
    without = re.sub(r'<section id="explore">.*?</section>', "", without, flags=re.S)
    without = without.replace('<li><a href="#explore">Explore</a></li>', "")
    driven = ". The slider of the section Explore sets its time; without scripts, it is shown at a constant rate. "
    assert without.count(driven) == 1
    assert without.replace(driven, ", shown at a constant rate. ") == static
    section = re.search(r'<section id="explore">(.*?)</section>', page, re.S)
    assert section is not None
    assert 'class="explorer" hidden' in section[1], "nothing is to be seen of it where no script runs"


def test_what_authors_write_ends_no_script(returned: Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_page, "pictures", lambda _solution, _texts: [])  # which have no titles
    monkeypatch.setattr(run_page, "overview", lambda _solution, _texts: Markup())
    case = replace(returned.instance, title="</script><b>")
    page = render(replace(returned, instance=case), None, Given("x"), "en", [Answer(returned, "</script><i>")])
    inside = re.search(r'<script type="application/json" id="explore-data">(.*?)</script>', page, re.S)
    assert inside is not None
    assert json.loads(inside[1])["answers"][0]["label"] == "</script><i>"


@pytest.mark.parametrize(
    ("label", "html"),
    [
        (r"$\dot\theta$ [rad/s]", "θ\N{COMBINING DOT ABOVE} [rad/s]"),
        (r"$u_1$ [km/s²]", "u<sub>1</sub> [km/s²]"),
        (r"$\lambda_{\dot r}$", "λ<sub>r\N{COMBINING DOT ABOVE}</sub>"),
        (r"$\Delta$$r$ [km]", "Δr [km]"),
        ("a < b & c", "a &lt; b &amp; c"),
        (r"$r$$\,\cos\,$$\theta$", "r cos θ"),
        (r"$\lambda_{q_{\max}}$", "λ<sub>q<sub>max</sub></sub>"),
        (r"$\ell - \ell(t_0)$", "ℓ \N{MINUS SIGN} ℓ(t<sub>0</sub>)"),
        (r"$10^{-3}$", "10<sup>\N{MINUS SIGN}3</sup>"),
        (r"$\sqrt{u_1^2 + u_2^2}$", "√(u<sub>1</sub><sup>2</sup> + u<sub>2</sub><sup>2</sup>)"),
        (r"$\mathcal{E}$", "\N{SCRIPT CAPITAL E}"),
    ],
)
def test_labels_are_shown_without_scripts(label: str, html: str) -> None:
    assert shown(label) == html


def test_without_its_library_the_command_says_what_to_install(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "plotly"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "plotly", None)
    code, _, err = run("report", "soft-return", "--html", "page.html", "--interactive")
    assert code == 3
    assert "pip install 'satsym[interactive]'" in err
    assert err.count("\n") == 1
    assert not Path("page.html").exists()


@pytest.mark.slow
def test_the_answers_of_a_study_are_chosen_by_what_it_varies(run: Run, returned: Solution, tmp_path: Path) -> None:
    vary = ("--vary", "initial.r=1.1:1.2:3", "--workers", "1")
    assert run("study", "return-to-orbit", *vary, "--trajectories", "--out", str(tmp_path / "kept"))[0] == 0
    answers = explored(returned, tmp_path / "kept")
    assert [answer.label for answer in answers] == [f"initial.r = {value}" for value in ("1.1", "1.15", "1.2")]
    assert [answer.solution.x[0, 0] for answer in answers] == pytest.approx([1.1, 1.15, 1.2])
    assert [answer.solution.instance.initial[0] for answer in answers] == pytest.approx([1.1, 1.15, 1.2])
    assert answers[0].solution.objective == pytest.approx(returned.objective)
    assert [answer.own for answer in answers] == [True, False, False], "the instance begins at 1.1"
    assert data([answers[2], answers[0]])["begin"] == 1
    with pytest.raises(BadInput, match="belongs to return-to-orbit, not to soft-return"):
        explored(solve(instance.load("soft-return")), tmp_path / "kept")
    assert run("study", "return-to-orbit", *vary, "--out", str(tmp_path / "bare"))[0] == 0
    with pytest.raises(BadInput, match="contains no trajectories; run the study again with --trajectories"):
        explored(returned, tmp_path / "bare")
    assert run("solve", "return-to-orbit", "--out", str(tmp_path / "one"))[0] == 0
    with pytest.raises(BadInput, match="contains no study made by `satsym study`"):
        explored(returned, tmp_path / "one")


def test_a_study_is_shown_on_interactive_pages_alone(run: Run) -> None:
    assert run("report", "soft-return", "--html", "page.html", "--study", "x")[0] == 2
