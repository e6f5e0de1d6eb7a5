"""Results are shown in the model's units, and without any where the numbers are those of no real orbit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import satsym
from satsym import instance
from satsym.analysis.comparison import compare
from satsym.instance.shown import spec_of
from satsym.report.plots.scene import Scene
from satsym.report.results.objects import cost_per
from satsym.report.results.objects import units as units_object
from satsym.report.results.studies import numbers
from satsym.report.results.study_table import path_of
from satsym.report.terminal.comparison import comparison_text, specs_of
from satsym.report.terminal.solution import solution_text
from satsym.report.terminal.study import study_text
from tests.support.solved import solve

KILOMETRES = ("km", "km/s", "rad", "rad/s")


def units(name: str, **changed: float) -> tuple[str, ...]:
    case = instance.load(name)
    values = dict(zip(case.model.spec.parameter_names, case.parameters, strict=True)) | changed
    return tuple(v.unit for v in spec_of(replace(case, parameters=tuple(values.values()))).states)


@pytest.mark.parametrize("name", ["return-to-orbit", "its-thesis", "return-to-orbit-ball", "ends-2-given-state"])
def test_an_orbit_of_radius_one_about_a_centre_of_attraction_one_has_no_units(name: str) -> None:
    assert units(name) == ("1", "1", "1", "1")
    assert spec_of(instance.load(name)).objective_unit in ("1", "")


@pytest.mark.parametrize("name", ["return-to-geo", "soft-return-geo", "return-to-geo-window"])
def test_a_geostationary_orbit_is_in_kilometres_and_seconds(name: str) -> None:
    assert units(name) == KILOMETRES


def test_the_product_of_radius_and_rate_decides_and_not_one_of_them() -> None:
    assert units("return-to-orbit", sigma=4.0, omega=0.125) == ("1", "1", "1", "1")
    assert units("return-to-orbit", sigma=2.0) == KILOMETRES


@pytest.mark.parametrize("name", ["cart-pole", "lapan-minimum-time", "shuttle", "goddard"])
def test_models_without_a_centre_of_attraction_keep_their_units(name: str) -> None:
    case = instance.load(name)
    assert spec_of(case) is case.model.spec


def test_motion_near_an_orbit_of_radius_and_rate_one_has_no_units() -> None:
    assert set(units("inspection")) == set(units("approach-cone")) == {"1"}
    assert units("inspection", sigma=7000.0) == units("inspection", omega=0.001) == ("km", "km/s", "km", "km/s")


def test_tables_and_pictures_leave_the_units_out_and_programs_read_them() -> None:
    found = solve(instance.load("return-to-orbit"))
    assert "km" not in solution_text(found)
    assert cost_per("1", Scene.of(found).spec) == "1"
    assert units_object(found.instance.model.spec)["r"] == "km"


def test_comparisons_leave_units_out_where_the_results_do() -> None:
    found = [compare([instance.load(name)])[0] for name in ("return-to-orbit", "soft-return")]
    assert "km" not in comparison_text(found)
    assert [v.unit for v in specs_of(found)[0].states] == ["1", "1", "1", "1"]


@pytest.mark.parametrize(
    ("varied", "unit"), [({"initial.r": (1.0, 1.1, 2)}, ""), ({"parameters.sigma": (1.0, 1.01, 2)}, " [km**2/s**3]")]
)
def test_the_worst_cases_have_a_unit_only_where_a_solution_has_one(
    varied: dict[str, tuple[float, float, int]], unit: str, tmp_path: Path
) -> None:
    found = satsym.study("return-to-orbit", tmp_path / "study", vary=varied, certificate="none")
    head = next(line for line in study_text(found.summary).splitlines() if "command" in line)
    assert head.split("  ")[-2].strip() == f"objective{unit}"


@pytest.mark.parametrize(
    ("name", "varied", "shown"), [("initial.r", (1.0, 1.1, 2), ""), ("parameters.sigma", (1.0, 1.01, 2), " [km]")]
)
def test_studies_leave_units_out_where_all_cases_are_multiples(
    name: str, varied: tuple[float, float, int], shown: str, tmp_path: Path
) -> None:
    found = satsym.study("return-to-orbit", tmp_path / "study", vary={name: varied}, command="simulate")
    drawn = numbers(path_of(found.folder), found.summary)
    assert list(drawn.varied) == [f"{name}{shown}"]
    assert "x_final.r [km]" in (found.folder / "table.csv").read_text("utf-8")
