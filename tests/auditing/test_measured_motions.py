"""What claims measure of orbits, equilibria and a reaction wheel, against closed forms and independent routes."""

from __future__ import annotations

import math

import numpy as np
import pytest
import sympy as sp

from satsym.auditing.measurements import equilibria, linear, linear_motions, orbits, wheel
from satsym.auditing.propositions.values import Record
from satsym.status import BadInput

SATELLITE = "lapan-classical"
I_Y, I_WY, E, P_C = 678.0, 0.09, 0.01, 0.025


def member(name: str) -> Record:
    return next(o for o in orbits.motions() if o.name == name)


def test_orbits_are_told_by_their_energy_and_eccentricity():
    for o in orbits.motions():
        r, v, mu = o.part("position"), o.part("velocity"), o.part("mu")
        energy = v @ v / 2.0 - mu / np.linalg.norm(r)
        towards = np.cross(v, np.cross(r, v)) / mu - r / np.linalg.norm(r)
        found = orbits.orbit(o)
        assert found.part("energy") == pytest.approx(energy, abs=1e-12)
        assert found.part("eccentricity") == pytest.approx(np.linalg.norm(towards), abs=1e-9)
        assert ("period" in found.parts) == (energy < -1e-12)
    kinds = {orbits.orbit(o).part("conic") for o in orbits.motions()}
    assert kinds == {"circle", "ellipse", "parabola", "hyperbola"}


def test_a_circle_is_coasted_along_at_a_constant_rate():
    circle, t = member("circle"), 0.7
    place = [math.cos(t), math.sin(t), 0.0, -math.sin(t), math.cos(t), 0.0]
    np.testing.assert_allclose(orbits.coasted(circle, t), place, atol=1e-14)
    np.testing.assert_allclose(orbits.coasted(circle, np.array([0.0, t]))[:, 1], place, atol=1e-14)
    assert orbits.turned(circle, 3.0) == pytest.approx(3.0)
    assert orbits.turned(member("retrograde ellipse"), 1.0) > 0.0


def test_what_moves_about_no_centre_has_no_orbit():
    with pytest.raises(BadInput, match="not a motion about a centre"):
        orbits.orbit("double-integrator-time")


def test_rates_and_their_jacobian_are_those_of_newtons_law():
    x = np.array([0.3, -0.4, 1.2, 0.1, 0.2, -0.3])
    np.testing.assert_allclose(orbits.rates_at("two_body", x, mu=2.0), [*x[3:], *(-2.0 * x[:3] / 1.3**3)], rtol=1e-14)
    shifted = x.astype(float)
    columns = []
    for k in range(6):
        h = np.eye(6)[k] * 1e-6
        columns.append((orbits.rates_at("two_body", shifted + h) - orbits.rates_at("two_body", shifted - h)) / 2e-6)
    np.testing.assert_allclose(orbits.jacobian_at("two_body", x), np.array(columns).T, atol=1e-8)
    with pytest.raises(BadInput, match="no parameter"):
        orbits.rates_at("two_body", x, nu=1.0)


def test_equilibria_behave_as_textbooks_prove_it():
    for e in equilibria.equilibria():
        size = equilibria.followed(e).part("size")
        near, gone = size.max() <= 0.05, size[-1] <= 0.05 * size[0]
        assert near == (e.part("stability") != "unstable"), e.name
        assert (near and gone) == (e.part("stability") == "asymptotically stable"), e.name


def test_their_linear_parts_are_exact_and_decide_where_they_can():
    for e in equilibria.equilibria():
        exact = np.array(e.part("A").tolist(), dtype=float)
        np.testing.assert_allclose(orbits.jacobian_at(e, e.part("rest")), exact, atol=1e-12)
        np.testing.assert_allclose(orbits.rates_at(e, e.part("rest")), 0.0, atol=1e-15)
        largest = max(complex(v).real for v in linear.eigenvalues(e))
        if abs(largest) > 1e-9:
            assert (largest > 0.0) == (e.part("stability") == "unstable"), e.name


def test_linear_motions_and_their_stability_are_those_of_the_exponential():
    turn = sp.Matrix([[0, 1], [-1, 0]]).as_immutable()
    found = equilibria.followed(turn, [1.0, 0.0])
    np.testing.assert_allclose(found.part("x1"), np.cos(found.part("t")), atol=1e-9)
    np.testing.assert_allclose(found.part("size"), 1.0, atol=1e-9)
    for rate in ("1/4", "-1/2", "0"):
        alone = sp.Matrix([[sp.Rational(rate)]]).as_immutable()
        assert linear_motions.stable(alone) == (sp.Rational(rate) <= 0)
        assert linear_motions.asymptotically_stable(alone) == (sp.Rational(rate) < 0)


def test_the_classical_law_answers_a_step_in_closed_form():
    found = wheel.classical(SATELLITE)
    t = found.part("t")
    np.testing.assert_allclose(found.part("angle"), P_C * (1.0 - np.exp(-E * t) * (1.0 - E * t)), atol=1e-10)
    assert found.part("impulse")[0] == pytest.approx(2.0 * E * I_Y * P_C)
    assert abs(found.part("torque")[0]) == pytest.approx(3.0 * P_C * I_Y * E**2)
    np.testing.assert_allclose(found.part("speed"), I_Y * found.part("rate") / I_WY, atol=1e-9)
    settled = wheel.settled(found, P_C, 0.02)
    assert abs(np.exp(-E * settled) * (E * settled - 1.0)) == pytest.approx(0.02, rel=0.02)


def test_a_real_differentiator_has_a_torque_that_goes_with_its_speed():
    for constant in (1.0, 0.1):
        largest = np.abs(wheel.classical(SATELLITE, constant).part("torque")).max()
        assert largest == pytest.approx((E**2 + 2.0 * E / constant) * I_Y * P_C, rel=1e-3)


def test_switching_and_the_gentle_law_end_at_rest_at_the_command():
    for found in (wheel.switched(SATELLITE, duration=100.0), wheel.gentle(SATELLITE, 100.0)):
        assert found.part("angle")[-1] == pytest.approx(P_C, rel=1e-9)
        assert abs(found.part("rate")[-1]) < 1e-12
        assert abs(found.part("speed")[-1]) < 1e-8
    torque = 4.0 * I_Y * P_C / 100.0**2
    one, other = wheel.switched(SATELLITE, torque=torque), wheel.gentle(SATELLITE, 100.0)
    assert one.part("duration") == pytest.approx(100.0)
    assert one.part("impulse")[-1] == pytest.approx(100.0 * torque)
    assert one.part("heat") == pytest.approx(100.0 * torque**2)
    assert other.part("heat") == pytest.approx(12.0 * (I_Y * P_C) ** 2 / 100.0**3)
    assert wheel.gentle(SATELLITE, 200.0).part("heat") == pytest.approx(other.part("heat") / 8.0)
    kept = wheel.switched(SATELLITE, torque=torque, share=0.2)
    assert kept.part("angle")[-1] == pytest.approx(1.4 * P_C)
    with pytest.raises(BadInput, match="the torque, or the duration"):
        wheel.switched(SATELLITE)


def test_what_is_left_swinging_is_the_transform_of_the_torque():
    """Of a square wave it is torque/w times |1 - 2 e^(-iwT/2) + e^(-iwT)| = 4 sin^2(wT/4), times w."""
    found = wheel.switched(SATELLITE, duration=100.0)
    assert wheel.swinging(found) == pytest.approx(4.0 * 4.0 * P_C / 100.0**2, rel=1e-7)


def test_an_impulse_at_the_start_swings_panels_too():
    """A critically damped law: the transform of its acceleration, the impulse included, is that of its closed loop."""
    found = wheel.classical(SATELLITE)
    w = np.linspace(4.0, 200.0, 800) / found.part("duration")
    s, damping = 1j * w, 0.01
    swing = w * abs(P_C * s * (2.0 * damping * s + damping**2) / (s + damping) ** 2)
    assert wheel.swinging(found) == pytest.approx(swing.max(), rel=1e-3)


def test_forces_that_jump_are_quickest():
    assert wheel.crossing_time([0.0, 0.5, 0.5, 1.0], [1.0, 1.0, -1.0, -1.0]) == pytest.approx(2.0)
    assert wheel.crossing_time([0.0, 1.0], [1.0, -1.0]) == pytest.approx(math.sqrt(6.0), rel=1e-6)
    with pytest.raises(BadInput, match="must end at rest"):
        wheel.crossing_time([0.0, 1.0], [1.0, 1.0])


@pytest.mark.parametrize("pace", [1e-6, 1e-3, 1.0, 1e3, 1e6])
@pytest.mark.parametrize(
    ("a", "verdict"),
    [
        ([[0, 1], [-1, 0]], (True, False)),
        ([[0, 1], [0, 0]], (False, False)),
        ([[0.01]], (False, False)),
        ([[-0.01]], (True, True)),
        ([[0, 1], [-1, -0.02]], (True, True)),
        ([[0, 1], [-1, 0.02]], (False, False)),
        ([[0, 0], [0, -1]], (True, False)),
        ([[-1000, 0], [0, 0.01]], (False, False)),
        ([[-1000, 0], [0, -0.01]], (True, True)),
    ],
)
def test_stability_is_seen_in_motions_of_any_pace(
    a: list[list[float]], verdict: tuple[bool, bool], pace: float
) -> None:
    matrix = pace * np.array(a, dtype=float)
    assert (linear_motions.stable(matrix), linear_motions.asymptotically_stable(matrix)) == verdict
