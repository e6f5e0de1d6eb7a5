"""``satsym analyse`` of orbits as its users meet it: JSON, text, pictures, and what is refused."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from satsym import instance
from satsym.analysis.subject import survey
from satsym.cli import main
from satsym.report.plots import plane, style
from satsym.report.plots.space import conics
from satsym.report.results.linear import ANALYSIS
from satsym.report.terminal.orbit import orbit_text
from tests.house.test_floors import run_satsym
from tests.support.cases import two_body_case

HEAD = "satsym schema command model instance status units instance_file".split()
ORBIT = "conic eccentricity semi_major_axis period energy angular_momentum".split()
POINT = "eigenvalues rule_verdict note".split()
FLOQUET = "multipliers determinant verdict note".split()
ASTRONOMICAL_UNIT = 149_597_870.7  # km


def analysed(subject: str | Path, capsys: pytest.CaptureFixture[str], *options: str) -> tuple[int, str, str]:
    code = main(["analyse", str(subject), *options])
    return code, *capsys.readouterr()


@pytest.mark.parametrize(
    ("name", "conic", "status"),
    [
        ("itb-earth", "ellipse", "computed"),
        ("itb-earth-kicked", "ellipse", "computed"),
        ("itb-earth-escape", "hyperbola", "no period"),
        ("molniya", "ellipse", "computed"),
    ],
)
def test_an_orbit_has_the_agreed_keys(name: str, conic: str, status: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = analysed(name, capsys, "--json")
    found = json.loads(out)
    assert (code, err, list(found)) == (0, "", [*HEAD, *ANALYSIS, "orbit", "point", "floquet"])
    assert all(found[key] is None for key in ANALYSIS)  # nothing rests anywhere
    assert [key for key in ORBIT if key in found["orbit"]] == ORBIT
    assert [key for key in POINT if key in found["point"]] == POINT
    assert [key for key in FLOQUET if key in found["floquet"]] == FLOQUET
    assert (found["orbit"]["conic"], found["floquet"]["status"]) == (conic, status)
    assert found["orbit"]["units"] == {"length": "km", "time": "s"}
    assert found["orbit"]["tolerance"] == 1e-12
    assert found["point"]["rule_verdict"] == "unstable"
    assert [list(value) for value in found["point"]["eigenvalues"]] == [["re", "im"]] * 6
    assert (found["point"]["deviation"] < 1e-14, found["point"]["own_coordinates"]) == (True, None)
    floquet = found["floquet"]
    if status == "no period":
        assert (floquet["multipliers"], floquet["determinant"], floquet["verdict"], floquet["matrix"]) == (None,) * 4
        assert "does not close" in floquet["note"]
        assert (found["orbit"]["period"], found["orbit"]["apoapsis"]) == (None, None)
    else:
        assert len(floquet["multipliers"]) == 6
        assert abs(floquet["determinant"] - 1.0) < 1e-10
        assert floquet["verdict"] == "Lyapunov unstable, orbitally stable"
        assert np.shape(floquet["matrix"]) == (6, 6)
        worst = max(math.hypot(value["re"] - 1.0, value["im"]) for value in floquet["multipliers"])
        assert worst == pytest.approx(floquet["scatter"], rel=1e-6)


def test_the_multipliers_are_those_of_the_matrix_that_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    floquet = json.loads(analysed("molniya", capsys, "--json")[1])["floquet"]
    M = np.array(floquet["matrix"])
    size = np.repeat([2.0**15, 4.0], 3)  # in km and km/s the matrix is badly scaled
    found = np.linalg.eigvals(M * size / size[:, None])
    assert np.abs(found - 1.0).max() < 1.1 * floquet["expected_scatter"]
    assert np.linalg.norm(floquet["start"][:3]) == pytest.approx(46217.46, rel=1e-6)  # apoapsis: a (1 + e)


def test_an_orbit_in_polar_coordinates_has_both_analyses(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = analysed("soft-return-geo", capsys, "--json")
    found = json.loads(out)
    assert code == 0
    assert found["stability"]["verdict"] == "unstable"
    assert found["orbit"]["conic"] == "ellipse"
    # 5 km too high with the angular velocity of the slot: e = 1 - mu / (r^3 omega^2), at perigee
    radius = 42169.17
    e = (radius / 42164.17) ** 3 - 1.0
    assert found["orbit"]["eccentricity"] == pytest.approx(e, rel=1e-9)
    assert found["orbit"]["periapsis"] == pytest.approx(radius)
    assert len(found["floquet"]["multipliers"]) == 6
    assert len(found["point"]["own_coordinates"]["eigenvalues"]) == 4
    text = analysed("soft-return-geo", capsys)[1]
    assert "the same rule in the model's own coordinates" in text
    assert max(map(len, text.splitlines())) <= 100


def test_what_is_no_orbit_has_nothing_under_these_keys(capsys: pytest.CaptureFixture[str]) -> None:
    found = json.loads(analysed("saddle", capsys, "--json")[1])
    assert (found["orbit"], found["point"], found["floquet"]) == (None, None, None)
    assert list(found)[: len(HEAD) + len(ANALYSIS)] == [*HEAD, *ANALYSIS]
    assert found["stability"]["verdict"] == "unstable"


@pytest.mark.parametrize("name", ["itb-earth", "itb-earth-kicked", "itb-earth-escape", "molniya"])
def test_people_get_the_facts_and_what_they_mean(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = analysed(name, capsys)
    assert (code, err) == (0, "")
    assert max(map(len, out.splitlines())) <= 100
    words = " ".join(out.split())
    assert "the rule does not distinguish between orbits" in words
    assert 'sign rule, "stable if all(e.real <= 0)": unstable' in words
    if name == "itb-earth-escape":
        assert "classified as a hyperbola" in words
        assert "Floquet multipliers: no period" in words
        assert "turning" not in words
    else:
        assert "classified as an ellipse: the eccentricity exceeds 1e-12" in words
        assert "In Lyapunov's sense the orbit is therefore unstable" in words
        assert "orbitally stable" in words
        assert ("Hill's equations" in words) == (name == "itb-earth")


def test_the_kind_is_coloured_by_whether_it_closes() -> None:
    assert "\x1b[32mellipse\x1b[0m" in orbit_text(survey(instance.load("itb-earth")), colour=True)
    assert "\x1b[31mhyperbola\x1b[0m" in orbit_text(survey(instance.load("itb-earth-escape")), colour=True)


@pytest.mark.parametrize(
    ("changed", "complaint"),
    [
        ({"x": "0.0"}, "case.toml: [initial]: the position is the centre itself; start elsewhere"),
        ({"mu": "0.0"}, "[parameters] mu: 0 is outside the domain of mu"),
        ({"mu": "-1.0"}, "[parameters] mu: -1 is outside the domain of mu"),
        ({"x": "nan"}, "[initial] x: the number is nan"),
        ({"v_y": "inf"}, "[initial] v_y: the number is inf"),
        ({"x": "1e300"}, "a result exceeds the range of floating-point numbers; check the units"),
        ({"x": "1e-300"}, "a result exceeds the range of floating-point numbers; check the units"),
    ],
)
def test_bad_input_ends_with_exit_3_and_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], changed: dict[str, str], complaint: str
) -> None:
    code, out, err = analysed(two_body_case(tmp_path, tf=20.0, **changed), capsys)
    assert (code, out) == (3, "")
    assert complaint in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("changed", "conic", "status"),
    [
        ({"v_y": "0.0"}, "rectilinear", "collision"),
        ({"v_y": "0.0", "v_x": "5.0"}, "rectilinear", "no period"),
        ({"v_x": "1.0", "v_y": "1.0"}, "parabola", "no period"),
        ({"v_y": "1e-7"}, "ellipse", "not resolved"),
        ({}, "circle", "computed"),
    ],
)
def test_borders_and_collisions_are_answers_not_errors(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], changed: dict[str, str], conic: str, status: str
) -> None:
    path = two_body_case(tmp_path, tf=20.0, **changed)
    code, out, err = analysed(path, capsys, "--json")
    found = json.loads(out)
    assert (code, err) == (0, "")
    assert (found["orbit"]["conic"], found["floquet"]["status"]) == (conic, status)
    assert (found["floquet"]["multipliers"] is None) == (status != "computed")
    assert max(map(len, orbit_text(survey(instance.load(path))).splitlines())) <= 100


@pytest.mark.parametrize("v_y", ["0.0", "1.0"])
def test_pictures_go_where_they_are_asked_for(v_y: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = analysed(
        two_body_case(tmp_path, tf=20.0, v_y=v_y), capsys, "--plot", "--out", str(tmp_path / "out")
    )
    assert (code, err) == (0, "")
    closes = {"multipliers.png"} if v_y == "1.0" else set()
    assert {file.name for file in (tmp_path / "out").iterdir()} == {"orbit.png", "point.png", "result.json"} | closes
    assert "orbit.png" in out


def test_a_model_as_such_starts_on_no_orbit(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = analysed("two_body", capsys)
    assert (code, out) == (3, "")
    assert "create an instance with an initial state" in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(("name", "unit", "factor"), [("itb-earth", "AU", ASTRONOMICAL_UNIT), ("molniya", "km", 1.0)])
def test_the_orbit_is_drawn_to_scale_in_the_unit_on_its_axes(name: str, unit: str, factor: float) -> None:
    found = survey(instance.load(name))
    with style.applied():
        panels = conics.page(found).axes
        assert len(panels) == (1 if name == "itb-earth" else 4)
        for axes in panels:
            assert axes.get_xlabel().endswith(f"[{unit}]")
            assert axes.get_ylabel().endswith(f"[{unit}]")
            assert axes.get_aspect() == 1.0
        apses = [found.elements.periapsis / factor, found.elements.apoapsis / factor]  # type: ignore[operator]
        curve = np.array(next(line.get_xydata() for line in panels[0].get_lines() if len(line.get_xdata()) > 100))
        distance = np.linalg.norm(curve, axis=1)
        assert [distance.min(), distance.max()] == pytest.approx(apses, rel=1e-5)
        points = [line.get_xydata()[0] for line in panels[0].get_lines() if len(line.get_xdata()) == 1]
        assert [0.0, 0.0] in [point.tolist() for point in points]  # the focus
        for apse in apses:
            assert any(math.hypot(*point) == pytest.approx(apse) for point in points)


def test_an_escape_is_drawn_with_what_is_simulated_of_it() -> None:
    found = survey(instance.load("itb-earth-escape"))
    drawn = conics.Drawn.of(found)
    assert drawn.travelled is not None
    assert (drawn.farthest, drawn.empty) == (None, None)
    assert drawn.travelled[:, 0] == pytest.approx(found.elements.position)
    # every point is on the conic: r (1 + e cos) = p
    for curve in (drawn.curve, drawn.travelled):
        radius, along = np.linalg.norm(curve, axis=0), found.elements.towards @ curve
        assert radius + found.elements.eccentricity * along == pytest.approx(found.elements.parameter, rel=1e-9)


def test_asymptotes_are_where_the_hyperbola_goes(tmp_path: Path) -> None:
    found = survey(instance.load(two_body_case(tmp_path, tf=20.0, v_y="2.0")))
    rays = conics.Drawn.of(found).asymptotes
    far = 1e6 * found.elements.periapsis
    curve = conics._open(found.elements, far)
    for ray, end in zip(rays, (curve[:, 0], curve[:, -1]), strict=True):
        way = (ray[:, 1] - ray[:, 0]) / np.linalg.norm(ray[:, 1] - ray[:, 0])
        off = end - ray[:, 0]
        assert np.linalg.norm(off - (off @ way) * way) < 1e-3 * found.elements.periapsis


def test_eigenvalues_and_multipliers_are_drawn_where_they_are() -> None:
    found = survey(instance.load("itb-earth"))
    with style.applied():
        axes = plane.of_point(found).axes[0]
        assert axes.get_xlabel().endswith("[1/day]")
        computed, closed_form = axes.get_lines()[-2:]
        assert np.allclose(computed.get_xdata(), found.point.eigenvalues.real * 86400.0)
        assert np.allclose(closed_form.get_ydata(), found.point.closed_form.imag * 86400.0)
        page = plane.of_multipliers(found)
        assert page is not None
        whole, near = page.axes
        circle = max(whole.get_lines(), key=lambda line: len(line.get_xdata()))
        assert np.allclose(np.hypot(circle.get_xdata(), circle.get_ydata()), 1.0)
        assert found.floquet.multipliers is not None
        assert np.allclose(whole.get_lines()[-2].get_xdata(), found.floquet.multipliers.real)
        assert np.allclose(near.get_lines()[-2].get_xdata(), (found.floquet.multipliers - 1.0).real, rtol=1e-12, atol=0)
        assert near.get_xlabel() == r"$\mathrm{Re}\,\mu - 1$"
        assert plane.of_multipliers(survey(instance.load("itb-earth-escape"))) is None


@pytest.mark.slow
def test_an_orbit_needs_neither_sympy_nor_matplotlib(tmp_path: Path) -> None:
    loaded = run_satsym(["analyse", "itb-earth", "--json"], tmp_path)
    assert "numpy" in loaded
    assert not loaded & {"sympy", "matplotlib", "numba", "control"}
