"""Pictures show the problem: constraints where their states are on the axes, burns, the target, points, the body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from sympy import Symbol

from satsym import instance
from satsym.analysis.regulator.feedback import simulate
from satsym.report import plots
from satsym.report.plots import curves, phase_planes, series
from satsym.report.plots.reading import read
from satsym.report.plots.scene import Scene
from satsym.report.plots.scenes import Orbit
from satsym.report.plots.space import surroundings
from satsym.report.plots.space.views import from_aside
from satsym.report.results import restrictions
from satsym.solution import Event, Simulation
from satsym.symbolic import loader
from tests.support.solved import solve

CONSTRAINED = (
    "bryson-denham beam approach-cone return-above return-in-slot obstacle goddard-pressure rayleigh-mixed "
    "shuttle-heating"
).split()


def coasting(name: str) -> Simulation:
    """The uncontrolled motion of an instance, for a while where its final time is free."""
    case = instance.load(name)
    return simulate(replace(case, tf=case.tf or 0.1), None)


def driven(name: str, *controls: float) -> Simulation:
    """The uncontrolled motion of an instance, with controls beside it that did not bring it about."""
    found = coasting(name)
    u = np.array(controls)[:, None] * np.ones_like(found.u)
    return replace(found, u=u)


def around(found: Simulation) -> Orbit:
    shown = Orbit.of(Scene.of(found))
    assert shown is not None
    return shown


@pytest.mark.parametrize("name", CONSTRAINED)
def test_it_is_known_what_states_each_constraint_is_about(name: str) -> None:
    """As the symbols say that stand in it, control by control left out."""
    found = coasting(name)
    spec = found.instance.model.spec
    problem, _ = loader.problem(spec.name)
    names = {one.name: one for one in Scene.of(found).restrictions}
    for constraint, expression in problem.path_constraints.items():
        inside = {symbol.name for symbol in expression.free_symbols if isinstance(symbol, Symbol)}
        for definition in problem.model.definitions:
            if definition.variable.symbol in inside:
                inside |= {symbol.name for symbol in definition.value.free_symbols}
        if inside & set(spec.control_names):
            assert constraint not in names
        else:
            states = {spec.state_names[i] for i in names[constraint].states}
            assert states == inside & set(spec.state_names)
            assert names[constraint].timed == ("t" in inside)


def test_the_wall_is_on_the_axis_of_the_state_that_it_stops() -> None:
    scene = Scene.of(solve(instance.load("bryson-denham")))
    place, velocity = series.states(scene)
    (wall,) = place.forbidden
    assert not velocity.forbidden
    levels = np.array([[0.1], [1.0 / 9.0], [0.12]]) + np.zeros_like(scene.times)
    np.testing.assert_allclose(wall(levels)[:, 0], [0.1 - 1.0 / 9.0, 0.0, 0.12 - 1.0 / 9.0], atol=1e-15)
    assert read([place])[0].high > 0.115


def test_a_wall_that_is_far_off_squashes_nothing() -> None:
    case = instance.load("bryson-denham")
    far = replace(case, parameters=(100.0,) * len(case.parameters))
    place = series.states(Scene.of(simulate(far, None)))[0]
    assert read([place])[0].high < 2.0


def test_a_slot_of_angle_is_a_band_seen_from_the_reference_that_moves_with_it() -> None:
    found = simulate(instance.load("return-in-slot"), None)
    slot = dict(zip(found.instance.model.spec.parameter_names, found.instance.parameters, strict=True))
    width = slot["slot"] * slot["sigma"]
    fields = [one.from_reference for one in around(found).around.forbidden]
    assert len(fields) == 2
    along = np.array([-1.01, -0.99, 0.0, 0.99, 1.01]) * width
    bad = np.any([field(np.vstack([along, 0.0 * along])) > 0.0 for field in fields if field], axis=0)
    assert bad.tolist() == [True, False, False, False, True]
    assert all(one.in_plane is None for one in around(found).around.forbidden), "in fixed axes it moves"


def test_a_least_radius_is_a_disc_in_the_plane() -> None:
    found = simulate(instance.load("return-above"), None)
    floor = dict(zip(found.instance.model.spec.parameter_names, found.instance.parameters, strict=True))["r_min"]
    (one,) = around(found).around.forbidden
    assert one.in_plane is not None
    angle = np.linspace(0.0, 6.0, 7)
    for size, bad in ((0.999, True), (1.001, False)):
        circle = size * floor * np.array([np.cos(angle), np.sin(angle)])
        assert ((one.in_plane(circle) > 0.0) == bad).all()


def test_discs_in_the_way_are_forbidden_where_they_are() -> None:
    shown = around(driven("obstacle", 1.0, 1.0))
    first, second = (one.in_plane for one in shown.around.forbidden)
    assert first is not None
    assert second is not None
    np.testing.assert_allclose(first(np.array([[0.3, 0.5], [-0.05, -0.05]])), [0.04, 0.0], atol=1e-15)
    np.testing.assert_allclose(second(np.array([[0.7], [0.25]])), [0.0], atol=1e-15)


def test_along_the_track_is_across_the_picture_and_up_is_up() -> None:
    for name, wanted in (("approach-cone", (2, 0)), ("obstacle", (0, 1)), ("brachistochrone", (0, 1))):
        case = instance.load(name)
        model = case.model
        x = np.array(case.initial)[:, None] + np.random.default_rng(1).uniform(0.1, 0.9, (len(case.initial), 20))
        u = np.random.default_rng(2).uniform(-1.0, 1.0, (len(model.spec.controls), 20))
        given = model, np.linspace(0.0, 1.0, 20), x, u, case.parameters
        found = curves.places(model.spec.states, curves.pairs(*given))
        assert curves.level(*given, found) == wanted, name


def test_the_orbit_that_is_to_be_joined_is_drawn_with_where_its_satellite_is_at_the_start() -> None:
    """A circle of 1.5, on which an angle of 1.5**-1.5 is passed in a unit of time."""
    found = around(driven("transfer-fuel", 0.01, 0.02)).around
    assert found.other is not None
    assert found.other_start is not None
    np.testing.assert_allclose(np.linalg.norm(found.other, axis=0), 1.5, rtol=1e-6)
    angle = 8.5 - 9.0 * 1.5**-1.5
    np.testing.assert_allclose(found.other_start[:, 0], 1.5 * np.array([np.cos(angle), np.sin(angle)]), rtol=1e-5)
    swept = np.unwrap(np.arctan2(found.other[1], found.other[0]))
    assert abs(swept[-1] - swept[0]) >= 6.27


def test_thrust_of_a_satellite_whose_states_tell_where_it_is() -> None:
    found = driven("transfer-fuel", 0.01, 0.02)
    shown = around(found)
    theta, m = found.x[1], found.x[4]
    exact = np.array([0.01 * np.cos(theta) - 0.02 * np.sin(theta), 0.01 * np.sin(theta) + 0.02 * np.cos(theta)]) / m
    assert shown.thrust is not None
    np.testing.assert_allclose(shown.thrust, exact, atol=1e-9)
    assert shown.thrusts, "the model calls it so"
    assert not around(driven("obstacle", 1.0, 1.0)).thrusts


def test_a_heading_is_no_thrust() -> None:
    assert around(driven("zermelo", 0.3)).thrust is None


def test_burns_are_drawn_apart_from_coasts() -> None:
    found = driven("transfer-fuel", 0.01, 0.02)
    assert around(found).around.burns is None, "it burns all the time"
    on = found.times < 0.3 * found.times[-1]
    burns = around(replace(found, u=found.u * on)).around.burns
    assert burns is not None
    np.testing.assert_array_equal(np.isfinite(burns[0]), on)


@pytest.mark.slow
def test_points_on_the_way_are_marked_where_they_are_passed() -> None:
    found = solve(instance.load("inspection"))
    shown = Orbit.of(Scene.of(found))
    assert shown is not None
    assert shown.around.passed is not None
    np.testing.assert_allclose(shown.around.passed[:, 0], [0.03, 0.02], atol=1e-6)
    assert any(isinstance(event, Event) and event.kind == "interior" for event in found.events)


def test_the_body_is_drawn_to_scale_where_it_can_be_seen() -> None:
    assert around(simulate(instance.load("molniya"), None)).around.radius == pytest.approx(6378.1, abs=0.1)
    assert around(simulate(instance.load("itb-earth"), None)).around.radius == 0.0, "the Sun is a dot there"
    assert around(simulate(instance.load("return-to-orbit"), None)).around.radius == 0.0


def test_what_is_behind_the_body_is_not_seen() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    view = from_aside(("x", "y", "z"))
    ring = 1.2 * np.array([np.cos(angle), np.sin(angle), 0.0 * angle])
    seen = surroundings.before(surroundings.Surroundings(radius=1.0), view, ring)
    hidden = np.isnan(seen[0])
    towards = np.cross(*view.axes)
    assert hidden.any()
    assert (towards @ ring[:, hidden] < 0.0).all(), "only of the half that is away from us"
    assert (np.linalg.norm(view.axes @ ring[:, hidden], axis=0) < 1.0).all()
    np.testing.assert_allclose(view.axes @ view.axes.T, np.eye(2), atol=1e-15)


def test_the_switching_curve_of_a_body_on_a_line_is_a_parabola() -> None:
    found = simulate(replace(instance.load("double-integrator-time"), tf=1.0), None)
    (plane,) = phase_planes.of(Scene.of(found))
    assert plane.switching is not None
    rate = np.array([[-1.0, -0.4, 0.3]])
    np.testing.assert_allclose(plane.switching(-0.5 * rate * np.abs(rate), rate), 0.0, atol=1e-12)
    assert (plane.switching(0.1 - 0.5 * rate * np.abs(rate), rate) > 0.0).all()


@pytest.mark.parametrize("name", ["approach-cone", "return-in-slot", "transfer-fuel", "molniya", "shuttle-heating"])
def test_all_of_it_can_be_drawn(name: str) -> None:
    controls = [0.01] * len(instance.load(name).model.spec.controls)
    found = simulate(instance.load(name), None) if name == "molniya" else driven(name, *controls)
    assert plots.figures(found)


def test_restrictions_are_those_of_given_states_alone() -> None:
    found = Scene.of(simulate(instance.load("return-in-slot"), None)).restrictions
    assert {one.name for one in restrictions.within(found, [2], timed=True)} == {"ahead", "behind"}
    assert restrictions.within(found, [2]) == []
    assert restrictions.within(found, [0, 1], timed=True) == []


@pytest.mark.slow
def test_a_motion_that_tells_its_angle_by_a_rate_alone_is_drawn_in_its_plane() -> None:
    """From the Earth's orbit to that of Mars: the angle is the integral of the transverse velocity over the radius."""
    scene = Scene.of(solve(instance.load("transfer-time")))
    shown = Orbit.of(scene)
    assert shown is not None
    assert shown.thrust is not None
    assert shown.around.other is not None
    np.testing.assert_allclose(np.hypot(*shown.path), scene.x[0], rtol=1e-12)
    np.testing.assert_allclose(np.hypot(*shown.around.other), 1.525, rtol=1e-8)
    velocity = np.gradient(shown.path, scene.nodes, axis=1, edge_order=2)
    np.testing.assert_allclose(np.hypot(*velocity), np.hypot(scene.x[1], scene.x[2]), atol=2e-3)
    push = 0.1405 / (1.0 - 0.07487 * scene.nodes)
    np.testing.assert_allclose(np.hypot(*shown.thrust), push, rtol=1e-9)
