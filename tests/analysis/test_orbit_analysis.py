"""Elements, kinds of orbits and eigenvalues at a point, against 50 digits, geometry, and the code of the paper."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import eig

from satsym import instance
from satsym.analysis.orbits.elements import TOLERANCE, Conic, Elements, elements
from satsym.analysis.orbits.kepler import propagate
from satsym.analysis.orbits.point import at_start, rule, rule_of_the_conclusion
from satsym.analysis.subject import survey
from satsym.status import BadInput
from tests.support import conics

G, M_SUN = 6.67430e-11, 1.989e30  # as the paper prints them, in SI units
PRINTED = {"itb-earth": 29.78e3, "itb-earth-kicked": 29.78e3 + 5e3, "itb-earth-escape": 29.78e3 + 12.6e3}
R0 = 1.496e11


def turned(node: float, inclination: float, argument: float) -> np.ndarray:
    """Perifocal axes as columns, by three rotations."""

    def about_z(a: float) -> np.ndarray:
        return np.array([[math.cos(a), -math.sin(a), 0.0], [math.sin(a), math.cos(a), 0.0], [0.0, 0.0, 1.0]])

    c, s = math.cos(inclination), math.sin(inclination)
    return about_z(node) @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]) @ about_z(argument)


def state_of(found: Elements) -> tuple[np.ndarray, np.ndarray]:
    """Position and velocity from size, shape and angles alone."""
    assert found.inclination is not None
    assert found.true_anomaly is not None
    axes = turned(found.node or 0.0, found.inclination, found.periapsis_argument or 0.0)
    cosine, sine = math.cos(found.true_anomaly), math.sin(found.true_anomaly)
    r = found.parameter / (1.0 + found.eccentricity * cosine) * np.array([cosine, sine, 0.0])
    v = math.sqrt(found.mu / found.parameter) * np.array([-sine, found.eccentricity + cosine, 0.0])
    return axes @ r, axes @ v


def started(e: float, anomaly: float, attitude: np.ndarray | None = None, parameter: float = 1.0) -> Elements:
    """Elements of a start in the plane, turned."""
    axes = np.eye(3) if attitude is None else attitude
    cosine, sine = math.cos(anomaly), math.sin(anomaly)
    r = parameter / (1.0 + e * cosine) * np.array([cosine, sine, 0.0])
    v = np.array([-sine, e + cosine, 0.0]) / math.sqrt(parameter)
    return elements(axes @ r, axes @ v, 1.0)


def test_elements_agree_with_50_digits_on_random_conics() -> None:
    for conic in conics.random_conics(210, seed=11):
        found = elements(conic.position, conic.velocity, conic.mu)
        with mp.workdps(50):
            r, v = [mp.mpf(x) for x in conic.position], [mp.mpf(x) for x in conic.velocity]
            mu, radius = mp.mpf(conic.mu), mp.sqrt(sum(x * x for x in r))
            h = [r[1] * v[2] - r[2] * v[1], r[2] * v[0] - r[0] * v[2], r[0] * v[1] - r[1] * v[0]]
            momentum = mp.sqrt(sum(x * x for x in h))
            energy = sum(x * x for x in v) / 2 - mu / radius
            across = [v[1] * h[2] - v[2] * h[1], v[2] * h[0] - v[0] * h[2], v[0] * h[1] - v[1] * h[0]]
            e = mp.sqrt(sum((a / mu - b / radius) ** 2 for a, b in zip(across, r, strict=True)))
            fraction = float(abs(energy) / (mu / radius))
            assert abs(found.eccentricity - e) <= 1e-15 * (1 + e)
            assert abs(found.energy - energy) <= 1e-14 * abs(energy)  # also where it is a small difference
            assert abs(found.parameter - momentum**2 / mu) <= 1e-14 * momentum**2 / mu
            assert abs(found.periapsis - momentum**2 / mu / (1 + e)) <= 1e-14 * found.periapsis
            kind = "parabola" if fraction <= TOLERANCE else "ellipse" if energy < 0 else "hyperbola"
            assert found.conic.value == ("circle" if kind == "ellipse" and e <= TOLERANCE else kind)
            assert (found.semi_major_axis is None) == (kind == "parabola")
            if found.semi_major_axis is not None:
                assert abs(found.semi_major_axis + mu / (2 * energy)) <= 1e-14 * abs(found.semi_major_axis)
            if found.period is not None:
                assert abs(found.period - 2 * mp.pi * mp.sqrt(-(mu**2) / (8 * energy**3))) <= 1e-14 * found.period
            else:
                assert kind in ("parabola", "hyperbola")


@given(
    e=st.sampled_from([0.0, 1e-14, 1e-9, 0.0167, 0.74, 0.999, 1.0, 1.001, 5.0]),
    anomaly=st.floats(-1.7, 1.7),
    node=st.sampled_from([0.0, 0.7, 3.0, 6.0]),
    inclination=st.sampled_from([0.0, 1e-9, 0.4, math.pi / 2, 2.5, math.pi - 1e-9, math.pi]),
    argument=st.sampled_from([0.0, 1.0, 4.0]),
)
def test_the_elements_lead_back_to_the_start(e, anomaly, node, inclination, argument) -> None:
    found = started(e, anomaly, turned(node, inclination, argument))
    r, v = state_of(found)
    slack = 1e-14 if found.conic is not Conic.CIRCLE else 3.0 * TOLERANCE  # a circle forgets its eccentricity
    assert np.linalg.norm(r - found.position) <= slack * np.linalg.norm(found.position) / (1.0 - min(e, 0.999))
    assert np.linalg.norm(v - found.velocity) <= slack * np.linalg.norm(found.velocity) / (1.0 - min(e, 0.999))
    assert found.inclination == pytest.approx(inclination, abs=1e-14)
    axes = np.array([found.towards, found.ahead, found.normal])
    assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_angles_that_mean_nothing_are_none() -> None:
    tilt = turned(1.0, 0.5, 2.0)
    assert started(0.1, 1.0).node is None
    assert started(0.1, 1.0, turned(0.0, math.pi, 0.5)).node is None
    assert started(0.1, 1.0, turned(0.0, math.pi, 0.5)).inclination == pytest.approx(math.pi, abs=1e-15)
    assert started(0.1, 1.0, tilt).node == pytest.approx(1.0)
    assert started(0.1, 1.0, tilt).periapsis_argument == pytest.approx(2.0)
    assert started(0.0, 1.0, tilt).periapsis_argument is None
    assert started(0.0, 1.0, tilt).true_anomaly == pytest.approx(3.0)  # counted from the node
    falling = elements((1.0, 2.0, 3.0), (0.1, 0.2, 0.3), 1.0)
    assert (falling.inclination, falling.node, falling.periapsis_argument, falling.true_anomaly) == (None,) * 4
    assert (falling.periapsis, falling.eccentricity, falling.period) == (0.0, 1.0, None)


@pytest.mark.parametrize(
    ("velocity", "kind", "bound"),
    [
        ((0.0, 1.0, 0.0), Conic.CIRCLE, True),
        ((0.0, 1.0 + 0.3 * TOLERANCE, 0.0), Conic.CIRCLE, True),
        ((0.0, 1.0 + 3.0 * TOLERANCE, 0.0), Conic.ELLIPSE, True),  # e is twice that
        ((1e-9, 1.0, 0.0), Conic.ELLIPSE, True),
        ((0.0, math.sqrt(1.0167), 0.0), Conic.ELLIPSE, True),
        ((0.0, math.sqrt(2.0) * (1.0 - 3.0 * TOLERANCE), 0.0), Conic.ELLIPSE, True),
        ((0.0, math.sqrt(2.0), 0.0), Conic.PARABOLA, False),
        ((1.0, 0.6, 0.8), Conic.PARABOLA, False),
        ((0.0, math.sqrt(2.0) * (1.0 + 3.0 * TOLERANCE), 0.0), Conic.HYPERBOLA, False),
        ((0.0, 0.0, 0.0), Conic.RECTILINEAR, True),
        ((1.0, 0.0, 0.0), Conic.RECTILINEAR, True),
        ((-2.0, 0.0, 0.0), Conic.RECTILINEAR, False),
        ((1.0, 0.3 * TOLERANCE, 0.0), Conic.RECTILINEAR, True),
        ((1.0, 3.0 * TOLERANCE, 0.0), Conic.ELLIPSE, True),
    ],
)
def test_kinds_change_at_the_stated_tolerances(velocity, kind, bound) -> None:
    found = elements((1.0, 0.0, 0.0), velocity, 1.0)
    assert (found.conic, found.bound) == (kind, bound)
    assert (found.period is None) == (kind not in (Conic.CIRCLE, Conic.ELLIPSE))
    assert (found.excess_speed is None) == bound


@given(exponent=st.integers(-40, 40), gravity=st.integers(-40, 40))
def test_units_change_nothing_but_numbers(exponent: int, gravity: int) -> None:
    length, mu = 10.0**exponent, 10.0**gravity
    speed = math.sqrt(mu / length)
    found = elements((0.8 * length, 0.1 * length, -0.3 * length), (0.2 * speed, 1.1 * speed, 0.1 * speed), mu)
    same = elements((0.8, 0.1, -0.3), (0.2, 1.1, 0.1), 1.0)
    assert found.eccentricity == pytest.approx(same.eccentricity, rel=1e-13)
    assert found.semi_major_axis == pytest.approx(same.semi_major_axis * length, rel=1e-13)
    assert found.period == pytest.approx(same.period * length / speed, rel=1e-13)
    assert found.node == pytest.approx(same.node, rel=1e-13)


@pytest.mark.parametrize(
    ("position", "velocity", "mu", "complaint"),
    [
        ((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 1.0, "the centre itself"),
        ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.0, "mu is not positive"),
        ((1.0, 0.0, math.nan), (0.0, 1.0, 0.0), 1.0, "position is not finite"),
        ((1.0, 0.0, 0.0), (0.0, math.inf, 0.0), 1.0, "velocity is not finite"),
        ((1e300, 0.0, 0.0), (0.0, 1.0, 0.0), 1.0, "a result exceeds the range of floating-point numbers"),
        ((1e-300, 0.0, 0.0), (0.0, 1.0, 0.0), 1.0, "a result exceeds the range of floating-point numbers"),
        ((1.0, 0.0, 0.0), (0.0, 1e200, 0.0), 1.0, "a result exceeds the range of floating-point numbers"),
        (np.ones((3, 2)), np.ones((3, 2)), 1.0, "2 orbits, but only one is allowed; give a single orbit"),
    ],
)
def test_what_is_no_orbit_is_refused_in_a_line(position, velocity, mu, complaint) -> None:
    with pytest.raises(BadInput, match=complaint) as refusal:
        elements(position, velocity, mu)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("name", PRINTED)
def test_the_three_orbits_of_the_paper_are_what_they_are(name: str) -> None:
    """By the energy of the printed numbers, and by the nearest and farthest point of the paper's own integration."""
    found = survey(instance.load(name)).elements
    with mp.workdps(50):
        mu, r, v = mp.mpf(6.67430) * mp.mpf(10) ** -11 * mp.mpf(1.989e30), mp.mpf(R0), mp.mpf(PRINTED[name])
        energy, e = v**2 / 2 - mu / r, abs(r * v**2 / mu - 1)  # the start is an apse
        assert found.conic.value == ("hyperbola" if energy > 0 else "ellipse")
        assert found.eccentricity == pytest.approx(float(e), abs=1e-14)
        assert found.energy == pytest.approx(float(energy) / 1e6, rel=1e-12)  # km^2/s^2
    mu_si = G * M_SUN

    def orbital_equation(t: float, y: np.ndarray) -> list[float]:
        x, y_, z, vx, vy, vz = y
        r = np.sqrt(x**2 + y_**2 + z**2)
        return [vx, vy, vz, -mu_si * x / r**3, -mu_si * y_ / r**3, -mu_si * z / r**3]

    years = 3.154e7 * (30.0 if found.period is None else 2.5)
    start = [R0, 0.0, 0.0, 0.0, PRINTED[name], 0.0]
    simulated = solve_ivp(
        orbital_equation, (0.0, years), start, rtol=1e-9, atol=1e-3, method="DOP853", dense_output=True
    )
    distance = np.linalg.norm(simulated.sol(np.linspace(0.0, years, 4001))[:3], axis=0) / 1e3
    if found.period is None:
        assert (np.diff(distance) > 0.0).all()
        left = simulated.y[3:, -1] @ simulated.y[3:, -1] - 2.0 * mu_si / np.linalg.norm(simulated.y[:3, -1])
        assert math.sqrt(left) / 1e3 == pytest.approx(found.excess_speed, rel=1e-6)
    else:
        assert distance.min() == pytest.approx(found.periapsis, rel=1e-6)
        assert distance.max() == pytest.approx(found.apoapsis, rel=1e-6)
        assert simulated.sol(found.period * 1.0)[:3] == pytest.approx([R0, 0.0, 0.0], abs=1e-6 * R0)


def test_the_inclined_orbit_is_a_molniya_orbit() -> None:
    found = survey(instance.load("molniya")).elements
    assert found.conic is Conic.ELLIPSE
    assert found.eccentricity == pytest.approx(0.74, abs=1e-6)
    assert math.degrees(found.inclination or 0.0) == pytest.approx(63.4349488, abs=1e-6)  # tan i = 2
    assert math.degrees(found.periapsis_argument or 0.0) == pytest.approx(270.0)
    assert found.period == pytest.approx(86164.0905 / 2.0, rel=1e-6)  # half a sidereal day


def jacobian_of_the_paper(r: np.ndarray, mu: float) -> np.ndarray:
    """``calculateJacobi`` as printed, for any mu."""
    x, y, z = r
    n = np.linalg.norm(r)
    found = np.zeros((6, 6))
    found[:3, 3:] = np.eye(3)
    found[3:, :3] = [
        [-mu / n**3 + 3 * mu * x**2 / n**5, 3 * mu * x * y / n**5, 3 * mu * x * z / n**5],
        [3 * mu * x * y / n**5, -mu / n**3 + 3 * mu * y**2 / n**5, 3 * mu * y * z / n**5],
        [3 * mu * x * z / n**5, 3 * mu * y * z / n**5, -mu / n**3 + 3 * mu * z**2 / n**5],
    ]
    return found


@pytest.mark.parametrize("name", PRINTED)
def test_the_rule_of_the_paper_calls_its_own_stable_orbit_unstable_and_tells_nothing_apart(name: str) -> None:
    point = survey(instance.load(name)).point
    eigenvalues, _ = eig(jacobian_of_the_paper(np.array([R0, 0.0, 0.0]), G * M_SUN))
    assert not all(e.real <= 0 for e in eigenvalues)  # it prints "No", for its "Stable Orbit" as well
    assert (point.rule_verdict, point.conclusion_verdict) == ("unstable", "unstable")
    assert np.sort(eigenvalues.real) == pytest.approx(np.sort(point.eigenvalues.real), rel=1e-12, abs=1e-18)
    assert np.sort(eigenvalues.imag) == pytest.approx(np.sort(point.eigenvalues.imag), rel=1e-12, abs=1e-18)
    assert point.own is None
    assert point.eigenvalues.tolist() == survey(instance.load("itb-earth")).point.eigenvalues.tolist()


@settings(max_examples=40)
@given(
    place=st.tuples(*[st.floats(-5.0, 5.0)] * 3).filter(lambda r: math.hypot(*r) > 0.1),
    speed=st.floats(0.0, 3.0),
    mu=st.floats(1e-3, 1e3),
)
def test_the_eigenvalues_at_a_point_have_the_closed_form_whatever_the_velocity(place, speed, mu) -> None:
    case = instance.load("molniya")
    found = []
    for way in ((speed, 0.0, 0.0), (0.0, -0.5 * speed, 2.0)):
        moved = replace(case, initial=(*place, *way), parameters=(mu,))
        found.append(at_start(moved, elements(place, way, mu)))
    r = math.hypot(*place)
    rate = math.sqrt(mu / r**3)
    expected = [math.sqrt(2.0) * rate, 1j * rate, 1j * rate, -1j * rate, -1j * rate, -math.sqrt(2.0) * rate]
    for point in found:
        assert np.abs(point.closed_form - expected).max() <= 1e-14 * rate
        assert point.deviation <= 1e-13
        assert abs(point.eigenvalues.sum()) <= 1e-13 * rate
        assert point.rule_verdict == "unstable"
    exact = np.linalg.eigvals(jacobian_of_the_paper(np.array(place), mu))
    assert np.sort(exact.real) == pytest.approx(np.sort(found[0].eigenvalues.real), abs=1e-12 * rate)


def test_cartesian_coordinates_in_the_plane_are_no_other_coordinates() -> None:
    case = replace(instance.load("itb-earth"), initial=(1.0, 0.5, -0.2, 0.9))
    assert at_start(case, elements((1.0, 0.5, 0.0), (-0.2, 0.9, 0.0), 1.0)).own is None


def test_the_rules_are_those_of_the_program_and_of_the_conclusion() -> None:
    assert rule([0j, -1 + 0j, 2j]) == "stable"
    assert rule([1e-30 + 0j]) == "unstable"
    assert rule_of_the_conclusion([-1.0 + 0j, -2.0 + 1j]) == "stable"
    assert rule_of_the_conclusion([0j, -1 + 0j]) is None
    assert rule_of_the_conclusion([1.0 + 0j, -1 + 0j]) == "unstable"


def test_the_verdict_of_the_rule_depends_on_the_coordinates() -> None:
    """A circle in polar coordinates: the same orbit, the same rule, another verdict."""
    case, r = instance.load("its-thesis"), 2.0
    mu = np.prod(np.power(case.parameters[:2], (3, 2)))  # sigma^3 omega^2
    start = (r, 0.0, 0.3, math.sqrt(mu / r**3))
    circle = replace(case, initial=start)
    found = survey(circle)
    assert found.elements.conic is Conic.CIRCLE
    assert found.point.own is not None
    # 0 is double there, with one eigenvector: computed ones are off by the root of a rounding
    assert np.sort(found.point.own.imag) == pytest.approx([-start[3], 0.0, 0.0, start[3]], abs=1e-7)
    assert found.point.rule_verdict == "unstable"
    assert found.point.own.real.max() < 1e-7 < found.point.eigenvalues.real.max()
    assert "coordinates" in found.point.note


def test_elements_do_not_change_along_the_orbit() -> None:
    for name in (*PRINTED, "molniya"):
        found = survey(instance.load(name)).elements
        times = np.linspace(0.0, 3.0 * (found.period or 1e8), 25)
        r, v = propagate(found.position[:, None], found.velocity[:, None], found.mu, times)
        for i in range(len(times)):
            later = elements(r[:, i], v[:, i], found.mu)
            assert later.conic is found.conic
            assert later.eccentricity == pytest.approx(found.eccentricity, abs=1e-13)
            assert later.semi_major_axis == pytest.approx(found.semi_major_axis, rel=1e-11)
            assert later.towards == pytest.approx(found.towards, abs=1e-11 / found.eccentricity)
