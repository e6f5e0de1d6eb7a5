"""From where paths in space are looked at, and the unit that their size is given in."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from satsym import instance
from satsym.report import display
from satsym.report.plots.scene import Scene
from satsym.report.plots.scenes import Orbit
from satsym.report.plots.space.views import views
from satsym.solvers import simulate

LABELS = ("x", "y", "z")
ANGLES = np.linspace(0.0, 6.0, 200)


def ellipse(eccentricity: float) -> np.ndarray:
    """About its focus, the nearest point ahead on the first axis, against the clock; shape (3, 200)."""
    distance = (1.0 - eccentricity**2) / (1.0 + eccentricity * np.cos(ANGLES))
    return np.array([distance * np.cos(ANGLES), distance * np.sin(ANGLES), np.zeros_like(ANGLES)])


@given(turn=st.tuples(*[st.floats(-3.0, 3.0)] * 3), eccentricity=st.floats(0.1, 0.9), size=st.floats(1e-3, 1e9))
def test_an_inclined_ellipse_is_shown_in_its_own_plane(
    turn: tuple[float, float, float], eccentricity: float, size: float
) -> None:
    """Its true shape, whatever the inclination: the nearest point to the right, the motion against the clock."""
    flat = ellipse(eccentricity)
    path = size * Rotation.from_rotvec(turn).as_matrix() @ flat
    first = views([path], LABELS)[0]
    drawn = first.axes @ path / size
    np.testing.assert_allclose(first.axes @ first.axes.T, np.eye(2), atol=1e-12)
    if first.title:
        np.testing.assert_allclose(drawn, flat[:2], atol=1e-6)
    else:  # turned into a plane of coordinates, nearly
        np.testing.assert_allclose(np.linalg.norm(drawn, axis=0), np.linalg.norm(flat, axis=0), rtol=1e-4)


@pytest.mark.parametrize("normal", [0, 1, 2])
def test_a_path_in_a_plane_of_coordinates_needs_no_other_picture(normal: int) -> None:
    path = np.insert(ellipse(0.3)[:2], normal, 0.0, axis=0)
    (only,) = views([path], LABELS)
    assert only.labels == tuple(label for k, label in enumerate(LABELS) if k != normal)
    assert not only.title


def test_a_path_out_of_any_plane_is_shown_along_the_three_axes() -> None:
    path = ellipse(0.3) + np.array([[0.0], [0.0], [1.0]]) * np.sin(3.0 * ANGLES)
    assert [view.labels for view in views([path], LABELS)] == [("x", "y"), ("x", "z"), ("y", "z")]


def test_what_is_drawn_beside_a_flat_path_counts() -> None:
    beside = np.roll(ellipse(0.3), 1, axis=0)
    assert len(views([ellipse(0.3), beside], LABELS)) == 3


def test_points_that_are_not_finite_do_not_count() -> None:
    path = ellipse(0.3)
    path[2, 7] = math.nan
    assert len(views([path], LABELS)) == 1


def test_a_straight_path_has_no_plane_of_its_own() -> None:
    path = np.array([[1.0], [2.0], [3.0]]) * np.linspace(0.1, 1.0, 50)
    assert [view.title for view in views([path], LABELS)] == ["", "", ""]


def test_a_circle_is_turned_to_its_start() -> None:
    path = Rotation.from_rotvec([0.7, 0.2, 0.4]).as_matrix() @ ellipse(0.0)
    first = views([path], LABELS)[0]
    np.testing.assert_allclose(first.axes @ path, ellipse(0.0)[:2], atol=1e-12)


def test_distances_between_planets_are_in_astronomical_units() -> None:
    assert display.length_scale("km", 1.5e8) == (149_597_870.7, "AU")
    assert display.length_scale("m", 1.5e11) == (149_597_870_700.0, "AU")
    for unit, size in (("km", 4e5), ("m", 1e7), ("1", 1e12), ("km", math.nan)):
        assert display.length_scale(unit, size) == (1.0, unit)


@pytest.mark.parametrize(("name", "count"), [("itb-earth", 1), ("molniya", 4)])
def test_shipped_orbits_are_shown_as_they_lie(name: str, count: int) -> None:
    shown = Orbit.of(Scene.of(simulate(instance.load(name))))
    assert shown is not None
    assert len(shown.views) == count
    assert [view.spatial for view in shown.views] == [name == "molniya", *[False] * (count - 1)]
    extent = np.ptp(shown.views[min(1, count - 1)].axes @ shown.path, axis=1)
    if name == "molniya":  # 2a along the line of apsides, 2b across
        np.testing.assert_allclose(extent, [2 * 26561.762, 2 * 26561.762 * math.sqrt(1 - 0.74**2)], rtol=1e-4)


@pytest.mark.parametrize(("name", "asked"), [("return-to-geo", True), ("its-thesis-return", False)])
def test_an_end_has_a_ring_seen_from_the_reference_only_where_its_place_is_given(name: str, asked: bool) -> None:
    """The second one leaves its angle free, and is on the reference in all else."""
    case = instance.load(name)
    shown = Orbit.of(Scene.of(simulate(case)))
    assert shown is not None
    assert shown.ends_there is asked
    assert set(case.final.values()) == {"reference"}
    assert ("theta" in case.final) is asked
