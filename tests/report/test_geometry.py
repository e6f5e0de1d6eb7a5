"""The picture of a model shows what the model declares, and models that declare no geometry have none."""

from __future__ import annotations

from math import atan2, cos, hypot, isclose, sin

import pytest
from sympy import symbols

from satsym.report.latex.figure import figure
from satsym.report.texts import load
from satsym.symbolic import Model, Problem
from satsym.symbolic.motion.geometry import ROUND, Arrow
from tests.support.derived import stated


def model(name: str) -> Model:
    subject = stated(name)
    return subject.model if isinstance(subject, Problem) else subject


def turn(arrow: Arrow) -> float:
    """Direction of an arrow, as an angle."""
    return atan2(arrow.end[1] - arrow.start[1], arrow.end[0] - arrow.start[0])


def named(name: str) -> dict[str, Arrow]:
    found = model(name).picture()
    assert found
    return {label: arrow for arrow in found.arrows for label in arrow.labels}


def test_thrust_points_along_the_unit_vectors_and_gravity_to_the_centre() -> None:
    arrows, found = named("polar_orbit"), model("polar_orbit").picture()
    place = arrows["r"].end
    seen = atan2(place[1], place[0])
    assert found
    assert found.angle == (seen, r"\theta")
    assert isclose(turn(arrows[r"\mathbf{e}_{r}"]), seen, rel_tol=1e-5)
    assert arrows["u_1"] == arrows[r"\mathbf{e}_{r}"]
    assert isclose(turn(arrows["u_2"]) - seen, 1.5707963, rel_tol=1e-5)
    pull = arrows[r"\mathbf{F}_{\text{gravity}}"]
    assert hypot(*pull.end) < hypot(*place)
    assert isclose(pull.end[0] * place[1], pull.end[1] * place[0], rel_tol=1e-5)


@pytest.mark.parametrize(
    ("name", "outwards", "ahead"), [("clohessy_wiltshire", "x_1", "x_3"), ("hill", r"\xi", r"\eta")]
)
def test_deviations_move_the_body_outwards_and_ahead(name: str, outwards: str, ahead: str) -> None:
    arrows = named(name)
    assert set(arrows) == {outwards, ahead}
    place = arrows[outwards].start
    assert isclose(turn(arrows[outwards]), atan2(place[1], place[0]))
    assert isclose(turn(arrows[ahead]) - turn(arrows[outwards]), 1.5707963, rel_tol=1e-5)


def test_the_reference_passes_where_deviations_begin() -> None:
    found = model("clohessy_wiltshire").picture()
    assert found
    assert all(isclose(hypot(*place), 1) for place in (*found.path, found.arrows[1].start))


def test_words_are_those_of_the_language() -> None:
    assert "gravitasi" in figure(model("polar_orbit"), load("id").with_own({"phrases": {"gravity": "gravitasi"}}), "it")


def test_a_body_in_space_is_drawn_with_its_depth() -> None:
    arrows, found = named("two_body"), model("two_body").picture()
    assert found
    assert len(found.axes) == 3
    place = arrows[r"\mathbf{r}"].end
    for k, name in enumerate("xyz"):
        arrow = arrows[rf"\mathbf{{e}}_{{{name}}}"]
        along = found.axes[k]
        assert isclose(turn(arrow), atan2(along[1], along[0]), abs_tol=1e-6)
    pull = arrows[r"\mathbf{F}_{\text{gravity}}"]
    assert hypot(*pull.end) < hypot(*place)
    assert isclose(pull.end[0] * place[1], pull.end[1] * place[0], rel_tol=1e-5)
    (_, below), (_, centre) = found.guides
    assert below[0] == place[0]
    assert centre == (0, 0)


@pytest.mark.parametrize("name", ["van_der_pol", "goddard", "cart_pole"])
def test_no_geometry_is_invented(name: str) -> None:
    assert figure(model(name), load("en"), "it") == ""


@pytest.mark.parametrize(
    ("name", "angles"), [("gyrostat", (r"\phi", r"\psi", r"\theta")), ("roll_yaw", (r"\phi", r"\psi"))]
)
def test_a_body_in_space_has_its_axes_and_the_sense_of_each_angle_that_turns_it(
    name: str, angles: tuple[str, ...]
) -> None:
    found = model(name).picture()
    assert found
    assert tuple(label for _, label in found.turns) == angles
    assert [arrow.labels[0] for arrow in found.arrows] == ["x_0", "y_0", "z_0", "x", "y", "z"]


def test_the_arrow_about_the_pitch_axis_turns_the_way_that_pitch_does() -> None:
    found, bodies = model("gyrostat").picture(), model("gyrostat")
    assert found
    ((points, _),) = [turn for turn in found.turns if turn[1] == r"\theta"]
    forward, towards_reader, down = (arrow.end for arrow in found.arrows[:3])
    seen = [tuple((p - 1.1 * c) / 0.14 for p, c in zip(place, towards_reader, strict=True)) for place in points]
    theta, rest = symbols("theta", real=True), dict.fromkeys(symbols("phi psi theta", real=True), 0)
    assert tuple(bodies.attitude.subs(bodies.named).diff(theta).subs(rest)[:, 2]) == (1, 0, 0)  # down goes forward
    at = {round(angle, 6): place for angle, place in zip(ROUND, seen, strict=True)}
    assert isclose(at[-0.1][0] + at[0.1][0], 2 * cos(0.1) * down[0], abs_tol=1e-9)
    assert isclose(at[-0.1][1] + at[0.1][1], 2 * cos(0.1) * down[1])
    assert isclose(at[0.1][0] - at[-0.1][0], 2 * sin(0.1) * forward[0])
