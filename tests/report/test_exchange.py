"""Exported motions, read back by readers of the published formats: where the satellite is, and when it burns."""

from __future__ import annotations

import csv
import io
import sys
from dataclasses import replace
from datetime import UTC, datetime
from itertools import pairwise

import numpy as np
import pytest

import satsym
from satsym import instance
from satsym.analysis.orbits.elements import elements
from satsym.analysis.orbits.kepler import propagate
from satsym.analysis.regulator.feedback import simulate
from satsym.instance.orbit import BODIES
from satsym.report.exchange import FORMATS, exported
from satsym.report.exchange.ephemeris import Ephemeris
from satsym.solution import Simulation
from satsym.status import BadInput
from tests.cli.test_cli import Run, run
from tests.support import exchange
from tests.support.solved import solve

__all__ = ["run"]

METRE = 1e-3


@pytest.fixture(scope="module")
def molniya() -> Simulation:
    return simulate(instance.load("molniya"), None)


def coasting(times: np.ndarray) -> np.ndarray:
    """Where the satellite of molniya is, by the closed form of Kepler's motion."""
    case = instance.load("molniya")
    start = np.array(case.initial)
    return propagate(start[:3, None], start[3:, None], case.parameters[0], times)[0]


def burning() -> Simulation:
    """A geostationary satellite that burns twice along its way, with a pause: thrust that jumps four times.

    The motion is integrated here, by RK4 in small steps.
    """
    case = instance.load("return-to-geo")
    model, p = case.model, case.parameters
    spans = [(0.0, 3600.0, 3e-8), (3600.0, 40000.0, 0.0), (40000.0, 43600.0, -2e-8), (43600.0, 60000.0, 0.0)]
    x, times, states, controls = np.array(case.initial), [], [], []
    for first, last, thrust in spans:
        grid, u = np.linspace(first, last, 121), (0.0, thrust)
        for k, t in enumerate(grid):
            times.append(t)
            states.append(x)
            controls.append(u)
            if k < 120:
                x = runge_kutta(lambda t, x, u=u: np.array(model.dynamics(t, tuple(x), u, p)), t, x, grid[1] - grid[0])
    found = simulate(case, None)
    return replace(found, times=np.array(times), x=np.array(states).T, u=np.array(controls).T)


def runge_kutta(rates, t: float, x: np.ndarray, step: float) -> np.ndarray:
    a = rates(t, x)
    b = rates(t + step / 2, x + step / 2 * a)
    c = rates(t + step / 2, x + step / 2 * b)
    d = rates(t + step, x + step * c)
    return x + step / 6 * (a + 2 * b + 2 * c + d)


def test_an_ephemeris_message_between_its_points_is_where_kepler_has_the_satellite(molniya: Simulation) -> None:
    (segment,) = exchange.oem(exported(molniya, "oem"))
    assert segment.keys["CENTER_NAME"] == "EARTH"
    assert segment.keys["REF_FRAME"] == "EME2000"
    assert segment.start == datetime(2026, 3, 20, tzinfo=UTC)
    middle = 0.5 * (segment.times[1:] + segment.times[:-1])
    exact = coasting(middle)
    assert max(np.linalg.norm(segment.at(t) - exact[:, k]) for k, t in enumerate(middle)) < METRE
    start = np.array(instance.load("molniya").initial)[:, None]
    _, pace = propagate(start[:3], start[3:], 398600.4418, segment.times)
    np.testing.assert_allclose(segment.paces, pace, atol=1e-7)


def test_libraries_of_others_read_the_message_alike(molniya: Simulation, tmp_path) -> None:
    from ccsds_ndm.ndm_io import NdmIo

    path = tmp_path / "molniya.oem"
    path.write_text(exported(molniya, "oem"), encoding="utf-8")
    (ours,) = exchange.oem(path.read_text(encoding="utf-8"))
    (theirs,) = NdmIo().from_path(path).body.segment
    rows = [[float(getattr(s, axis).value) for axis in "xyz"] for s in theirs.data.state_vector]
    np.testing.assert_array_equal(np.array(rows).T, ours.places)
    assert theirs.metadata.center_name == "EARTH"


def test_the_reader_of_the_package_oem_reads_it_too(molniya: Simulation, tmp_path) -> None:
    oem = pytest.importorskip("oem", reason="oem needs astropy, which is large; pip install oem")
    path = tmp_path / "molniya.oem"
    path.write_text(exported(molniya, "oem"), encoding="utf-8")
    (ours,) = exchange.oem(path.read_text(encoding="utf-8"))
    states = list(oem.OrbitEphemerisMessage.open(path).states)
    np.testing.assert_array_equal(np.array([state.position for state in states]).T, ours.places)


def test_an_ephemeris_of_stk_is_the_same_motion_in_metres(molniya: Simulation) -> None:
    segment, boundaries = exchange.stk(exported(molniya, "stk"))
    assert not boundaries
    assert segment.start == datetime(2026, 3, 20, tzinfo=UTC)
    assert (segment.keys["centralbody"], segment.keys["coordinatesystem"]) == ("Earth", "J2000")
    np.testing.assert_allclose(segment.places, coasting(segment.times), atol=1e-5)


def test_readers_are_given_ninety_points_a_revolution_at_least(molniya: Simulation) -> None:
    case = instance.load("molniya")
    coarse = simulate(replace(case, solver=replace_steps(case, 700)), None)
    segment, _ = exchange.stk(exported(coarse, "stk"))
    places = segment.places / np.linalg.norm(segment.places, axis=0)
    turned = np.degrees(np.arccos(np.clip((places[:, 1:] * places[:, :-1]).sum(axis=0), -1.0, 1.0)))
    assert turned.max() < 360.0 / 90.0
    assert len(segment.times) > len(coarse.times)
    np.testing.assert_allclose(segment.places, coasting(segment.times), atol=1e-4)


def replace_steps(case: instance.Instance, steps: int):
    import msgspec

    return msgspec.structs.replace(case.solver, steps=steps)


def test_nodes_that_are_too_far_apart_are_refused() -> None:
    case = instance.load("molniya")
    coarse = simulate(replace(case, solver=replace_steps(case, 60)), None)
    with pytest.raises(BadInput, match=r"^molniya: neighbouring nodes are up to \d+ degrees of the orbit apart"):
        exported(coarse, "csv")


def test_a_scene_for_cesium_holds_the_satellite_and_the_reference() -> None:
    found = solve(instance.load("return-to-geo"))
    packets = exchange.czml(exported(found, "czml"))
    satellite, reference = packets["satellite"], packets["reference"]
    assert satellite["position"]["referenceFrame"] == "INERTIAL"
    assert satellite["end"] - satellite["start"] == datetime(2026, 3, 21) - datetime(2026, 3, 20)
    r, theta = found.x[0], found.x[2]
    exact = np.array([r * np.cos(theta), r * np.sin(theta), 0.0 * r])
    np.testing.assert_allclose(satellite["places"], exact, atol=1e-6)
    turned = 7.2921159e-5 * reference["times"]
    circle = 42164.17 * np.array([np.cos(turned), np.sin(turned), 0.0 * turned])
    np.testing.assert_allclose(reference["places"], circle, atol=1e-5)
    np.testing.assert_allclose(satellite["places"][:, -1], reference["places"][:, -1], atol=1e-3)


def test_the_plane_of_a_planar_model_lies_as_stated() -> None:
    angles = {"inclination": "51.6 deg", "node": "40 deg", "argument": "25 deg"}
    case = satsym.load("return-to-geo").with_(orbit=angles, initial={"theta": 0.0, "r": "42000 km"})
    motion = Ephemeris.of(simulate(case.case, None))
    found = elements(motion.position[:, 0], motion.velocity[:, 0], BODIES["Earth"].mu)
    assert found.inclination is not None
    np.testing.assert_allclose(np.degrees(found.inclination), 51.6, atol=1e-9)
    ahead = np.array([np.cos(np.radians(40.0)), np.sin(np.radians(40.0)), 0.0])
    assert np.degrees(np.arccos(ahead @ motion.position[:, 0] / 42000.0)) == pytest.approx(25.0)
    assert motion.position[2, 0] > 0.0, "past the ascending node"


def test_burns_are_said_with_their_times_and_their_change_of_velocity() -> None:
    found = burning()
    segments = exchange.oem(exported(found, "oem"))
    assert [len(segment.comments) for segment in segments] == [1, 0, 1, 0]
    assert (
        segments[0]
        .comments[0]
        .startswith("MANOEUVRE 1: 2026-03-20T00:00:00.000000000 to 2026-03-20T01:00:00.000000000")
    )
    assert "delta-v 0.108 m/s" in segments[0].comments[0], "3e-5 m/s**2 for an hour"
    assert "delta-v 0.072 m/s" in segments[2].comments[0]
    for one, other in pairwise(segments):
        np.testing.assert_array_equal(one.places[:, -1], other.places[:, 0])
    _, boundaries = exchange.stk(exported(found, "stk"))
    assert boundaries == [3600.0, 40000.0, 43600.0]
    packets = exchange.czml(exported(found, "czml"))
    assert [(packets[name]["start"], packets[name]["end"]) for name in ("burn-1", "burn-2")] == [
        (datetime(2026, 3, 20, tzinfo=UTC), datetime(2026, 3, 20, 1, tzinfo=UTC)),
        (datetime(2026, 3, 20, 11, 6, 40, tzinfo=UTC), datetime(2026, 3, 20, 12, 6, 40, tzinfo=UTC)),
    ]


def test_a_table_has_position_velocity_and_thrust_in_the_frame() -> None:
    found = burning()
    rows = list(csv.DictReader(io.StringIO(exported(found, "csv"))))
    assert rows[0]["utc"] == "2026-03-20T00:00:00.000000000Z"
    place, pace, thrust = (
        np.array([float(rows[3][f"{name}{axis}_{unit}"]) for axis in "xyz"])
        for name, unit in (("", "km"), ("v", "km_s"), ("thrust_", "km_s2"))
    )
    np.testing.assert_allclose(np.linalg.norm(thrust), 3e-8, rtol=1e-6)
    assert abs(thrust @ place) < 1e-6 * np.linalg.norm(thrust) * np.linalg.norm(place), "it is tangential"
    assert thrust @ pace > 0.0


def test_metres_and_years_become_kilometres_and_seconds() -> None:
    motion = Ephemeris.of(simulate(instance.load("itb-earth"), None))
    np.testing.assert_allclose(motion.position[:, 0], [1.496e8, 0.0, 0.0])
    np.testing.assert_allclose(motion.velocity[:, 0], [0.0, 29.78, 0.0])
    (segment,) = exchange.oem(exported(simulate(instance.load("itb-earth"), None), "oem"))
    assert segment.keys["CENTER_NAME"] == "SUN"
    assert segment.keys["REF_FRAME"] == "ICRF"


def test_the_centre_of_a_scene_is_the_earth() -> None:
    with pytest.raises(BadInput, match="Cesium shows motions about the Earth, not Sun"):
        exported(simulate(instance.load("itb-earth"), None), "czml")


@pytest.mark.parametrize(
    ("name", "changes", "complaint"),
    [
        ("lapan-minimum-time", {}, r"the motion of the model pitch_minimum_time is not an orbit about a central body"),
        ("return-to-orbit", {}, r"\[orbit\] epoch: missing; add a table \[orbit\]"),
        ("return-to-orbit", {"orbit": {"epoch": "2026-01-01T00:00:00Z"}}, r"the model has mu = 1 km\*\*3/s\*\*2, but"),
        ("molniya", {"orbit": {"centre": "Mars"}}, r"the body Mars has mu = 42828.38"),
    ],
)
def test_what_has_no_place_in_the_sky_is_refused_in_a_line(name: str, changes: dict, complaint: str) -> None:
    case = satsym.load(name).with_(**changes).case
    with pytest.raises(BadInput, match=complaint) as refused:
        Ephemeris.of(replace(simulate(instance.load("molniya"), None), instance=case))
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("orbit", "complaint"),
    [
        ({}, r"\[orbit\] epoch: missing"),
        ({"epoch": "yesterday"}, r'\[orbit\] epoch: got "yesterday"; give a date and a time in UTC'),
        ({"epoch": "1066-10-14T09:00:00Z"}, r"\[orbit\] epoch: the year 1066 does not lie between 1900 and 2199"),
        ({"epoch": "2026-01-01T00:00:00Z", "centre": "Terra"}, r'\[orbit\] centre: "Terra" is not supported'),
        ({"epoch": "2026-01-01T00:00:00Z", "frame": "ECEF"}, r'\[orbit\] frame: "ECEF" is not supported'),
        (
            {"epoch": "2026-01-01T00:00:00Z", "node": 1.0},
            r"\[orbit\] node: the model two_body is not planar; leave out this key",
        ),
        ({"epoch": "2026-01-01T00:00:00Z", "moon": 1.0}, r"\[orbit\] moon: unknown key"),
    ],
)
def test_a_table_orbit_that_makes_no_sense_is_refused(orbit: dict, complaint: str) -> None:
    given = satsym.load("molniya").with_(orbit=None)
    with pytest.raises(BadInput, match=complaint):
        given.with_(orbit=orbit)


@pytest.mark.parametrize(("kind", "module", "named"), [("oem", "ccsds_ndm", "ccsds-ndm"), ("czml", "czml3", "czml3")])
def test_without_its_library_a_format_says_what_to_install(
    molniya: Simulation, monkeypatch: pytest.MonkeyPatch, kind: str, module: str, named: str
) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == module]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(BadInput, match=rf"^{named} is not installed; run pip install 'satsym\[exchange\]'"):
        exported(molniya, kind)


def test_an_instance_in_python_writes_its_orbit_into_a_file(tmp_path) -> None:
    given = satsym.load("molniya").with_(orbit={"epoch": datetime(2030, 1, 2, 3, 4, 5, tzinfo=UTC)})
    path = tmp_path / "case.toml"
    path.write_text(given.to_toml(), encoding="utf-8")
    orbit = instance.load(str(path)).orbit
    assert orbit is not None
    assert orbit.epoch == datetime(2030, 1, 2, 3, 4, 5, tzinfo=UTC)


def test_the_command_writes_to_stdout_or_into_a_file(run: Run, tmp_path) -> None:
    code, out, err = run("export", "molniya", "--format", "csv")
    assert (code, err) == (0, "")
    assert out.startswith("utc,time_s,x_km")
    for kind, ending in FORMATS.items():
        path = tmp_path / f"molniya{ending}"
        assert run("export", "molniya", "--format", kind, "--out", str(path))[0] == 0
        assert path.stat().st_size > 1000
    assert (tmp_path / "molniya.e").read_text(encoding="utf-8").startswith("stk.v.11.0")


def test_the_command_exports_a_saved_result(run: Run, tmp_path) -> None:
    folder = tmp_path / "saved"
    assert run("simulate", "return-to-geo", "--out", str(folder))[0] == 0
    code, out, _ = run("export", "return-to-geo", "--format", "csv", "--from", str(folder))
    assert code == 0
    rows = list(csv.DictReader(io.StringIO(out)))
    assert {row["thrust_x_km_s2"] for row in rows} == {"0.0"}, "simulated, not solved"


def test_the_command_refuses_before_it_solves(run: Run) -> None:
    code, out, err = run("export", "soft-return", "--format", "oem")
    assert (code, out) == (3, "")
    assert err.count("\n") == 1


def test_python_exports_what_it_solved(tmp_path) -> None:
    motion = satsym.simulate("molniya")
    text = satsym.export(motion, "stk", tmp_path / "molniya.e")
    assert (tmp_path / "molniya.e").read_text(encoding="utf-8") == text
    with pytest.raises(BadInput, match='there is no export format "gpx"; available: oem, czml, stk, csv'):
        satsym.export(motion, "gpx")
