"""The closed form: against classical elements at 50 digits, on every conic, and its refusals."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from satsym.analysis.orbits import kepler
from satsym.status import BadInput
from tests.support.conics import Conic, errors, exact, half_ulp, random_conics

ALLOWED = 1e-13
ULPS = 50.0
"""A result may be off by ALLOWED, relatively, or by so many times the effect of half a unit in the last place."""


def assert_as_good_as_its_input(conic: Conic, position: np.ndarray, velocity: np.ndarray) -> None:
    found = errors(conic, position, velocity)
    if max(found) > ALLOWED:
        for error, effect in zip(found, half_ulp(conic), strict=True):
            assert error <= max(ALLOWED, ULPS * effect), conic


def assert_exact(position: tuple, velocity: tuple, mu: float, duration: float) -> None:
    conic = Conic("", position, velocity, mu, duration)
    assert_as_good_as_its_input(conic, *kepler.propagate(position, velocity, mu, duration))


def test_on_a_thousand_random_conics_the_closed_form_is_as_good_as_its_input():
    conics = random_conics(1001, seed=6)
    assert len({conic.kind for conic in conics}) == 7
    found = kepler.propagate(
        np.array([c.position for c in conics]).T,
        np.array([c.velocity for c in conics]).T,
        np.array([c.mu for c in conics]),
        np.array([c.duration for c in conics]),
    )
    for conic, position, velocity in zip(conics, *(rows.T for rows in found), strict=True):
        assert_as_good_as_its_input(conic, position, velocity)


def test_the_parabolas_among_them_are_exactly_so():
    parabolas = [conic for conic in random_conics(70, seed=6) if conic.kind == "parabola"]
    assert parabolas
    for conic in parabolas:
        with mp.workdps(50):
            speed = sum(mp.mpf(v) ** 2 for v in conic.velocity)
            assert speed == 2 * mp.mpf(conic.mu) / mp.sqrt(sum(mp.mpf(x) ** 2 for x in conic.position))


@pytest.mark.parametrize(
    ("velocity", "duration"),
    [((0.1, 1.0, 0.2), 0.7), ((-1.2, 0.7, 0.4), 0.6), ((0.0, 0.8, -1.9), -0.6)],
    ids=["ellipse", "hyperbola", "backwards"],
)
def test_the_reference_agrees_with_taylor_series_of_newtons_law(velocity: tuple, duration: float):
    start = (1.0, 0.1, -0.2)
    with mp.workdps(17):

        def rates(_: object, y: list) -> list:
            cube = mp.sqrt(y[0] ** 2 + y[1] ** 2 + y[2] ** 2) ** 3
            return [*y[3:], *(-y[k] / cube for k in range(3))]

        sense = 1 if duration > 0 else -1  # odefun goes forwards: backwards is the reversed velocity
        y = mp.odefun(rates, 0, [*map(mp.mpf, start), *(sense * mp.mpf(v) for v in velocity)])(abs(duration))
        place, pace = exact(start, velocity, 1.0, duration)
        for a, b in zip((*place, *pace), (*y[:3], *(sense * v for v in y[3:])), strict=True):
            assert abs(a - b) <= mp.mpf(10) ** -14


@pytest.mark.parametrize("tilt", [1e-6, 1e-12, 1e-20, 1e-150, 1e-300])
@pytest.mark.parametrize("speed", [0.3, 1.0, 2.0**0.5, 2.0])
@pytest.mark.parametrize("duration", [1e-10, 0.5, -3.3, 50.0])
def test_hardly_any_angular_momentum_costs_no_digit_that_the_input_has(tilt: float, speed: float, duration: float):
    assert_exact((1.0, 0.0, 0.0), (-speed, tilt, 0.0), 1.0, duration)


def test_motion_that_is_radial_but_for_a_squared_rounding_is_no_collision():
    tick = 2.0**-52  # the products of the vector product round to the same float; their difference is its square
    position, velocity = (1.0 + tick, 1.0, 0.0), (-1.0 - 2.0 * tick, -1.0 - tick, 0.0)
    assert position[0] * velocity[1] - position[1] * velocity[0] == 0.0
    for duration in (0.1, 1.5, 20.0):
        assert_exact(position, velocity, 1.0, duration)


@pytest.mark.parametrize("turns", [1e4, -1e6, 1e9])
def test_whole_revolutions_cost_nothing(turns: float):
    start = Conic("", (1.0, 0.0, 0.1), (0.1, 1.1, 0.2), 1.0, turns * 10.7)
    found = kepler.propagate(start.position, start.velocity, start.mu, start.duration)
    assert max(errors(start, *found)) <= 1e-14


@pytest.mark.parametrize("scale", [1e-200, 1e-9, 1e11, 1e200])
def test_units_do_not_matter_nor_does_their_square_overflow(scale: float):
    mu = scale**0.2  # then speeds are about scale^-0.4 and times scale^1.4
    assert_exact((scale, 0.0, 0.0), (scale**-0.4 / 10.0, scale**-0.4, 0.0), mu, scale**1.4)


def test_no_time_changes_nothing():
    position, velocity = (0.1, 0.7, -0.3), (0.3, -1e-9, 1.7)
    assert np.array_equal(kepler.propagate(position, velocity, 0.3, 0.0), (position, velocity))


def test_shapes_are_broadcast():
    rng = np.random.default_rng(1)
    position, velocity = rng.normal(size=(3, 4, 1)), rng.normal(size=(3,))
    mu, duration = rng.uniform(1.0, 2.0, size=(4, 5)), np.linspace(-1.0, 1.0, 5)
    places, paces = kepler.propagate(position, velocity, mu, duration)
    assert places.shape == paces.shape == (3, 4, 5)
    for i, j in ((0, 0), (3, 4), (2, 1)):
        alone = kepler.propagate(position[:, i, 0], velocity, mu[i, j], duration[j])
        assert np.array_equal(alone, (places[:, i, j], paces[:, i, j]))


def test_thousands_at_once_are_what_each_is_alone():
    rng = np.random.default_rng(2)
    position, velocity = rng.normal(size=(2, 3, 2 * kepler.BLOCK + 3))
    places, paces = kepler.propagate(position, velocity, 1.0, 7.0)
    for k in (0, kepler.BLOCK - 1, kepler.BLOCK, 2 * kepler.BLOCK + 2):
        assert np.allclose(
            kepler.propagate(position[:, k], velocity[:, k], 1.0, 7.0), (places[:, k], paces[:, k]), 1e-14
        )


directions = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1)


@settings(max_examples=25, deadline=None)
@given(directions, directions, st.floats(0.1, 3.0), st.floats(-30.0, 30.0), st.floats(-30.0, 30.0))
def test_the_way_in_two_parts_is_the_whole_and_keeps_energy_and_momentum(position, velocity, mu, first, second):
    r, v = np.array(position), np.array(velocity)
    if np.linalg.norm(np.cross(r, v)) < 1e-3:
        return
    halfway = kepler.propagate(r, v, mu, first)
    both, whole = kepler.propagate(*halfway, mu, second), kepler.propagate(r, v, mu, first + second)
    momentum, energy = np.cross(r, v), v @ v / 2.0 - mu / np.linalg.norm(r)
    for place, pace in (halfway, both, whole):
        kinetic = pace @ pace / 2.0
        assert np.linalg.norm(np.cross(place, pace) - momentum) <= 1e-13 * np.linalg.norm(place) * np.linalg.norm(pace)
        assert abs(kinetic - mu / np.linalg.norm(place) - energy) <= 1e-13 * (kinetic + mu / np.linalg.norm(r))
    # what is left is the effect of rounding halfway, which grows like time and with the depth of periapsis
    conic = Conic("", tuple(halfway[0].tolist()), tuple(halfway[1].tolist()), mu, second)
    effect = half_ulp(conic)[0] + half_ulp(Conic("", tuple(r.tolist()), tuple(v.tolist()), mu, first + second))[0]
    assert np.linalg.norm(both[0] - whole[0]) <= (1e-12 + 500.0 * effect) * np.linalg.norm(whole[0])


def test_a_radial_motion_that_stays_clear_of_the_centre_is_followed():
    # straight up at escape speed: r^(3/2) = 1 + 3/2 sqrt(2) t
    place, pace = kepler.propagate((0.0, 0.0, 1.0), (0.0, 0.0, np.sqrt(2.0)), 1.0, 10.0)
    known = (1.0 + 1.5 * np.sqrt(2.0) * 10.0) ** (2.0 / 3.0)
    assert place == pytest.approx((0.0, 0.0, known), rel=1e-14)
    assert pace == pytest.approx((0.0, 0.0, np.sqrt(2.0 / known)), rel=1e-14)
    # dropped from rest at 1: after the time to reach 1/2, pi/2 + 1 over 2 sqrt(2)
    half = (np.pi / 2.0 + 1.0) / (2.0 * np.sqrt(2.0))
    place, pace = kepler.propagate((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0, half)
    assert place == pytest.approx((0.5, 0.0, 0.0), rel=1e-14)
    assert pace == pytest.approx((-np.sqrt(2.0), 0.0, 0.0), rel=1e-14)


FALL = np.pi / (2.0 * np.sqrt(2.0))
"""Time to fall from rest at distance 1 into the centre, mu = 1."""


@pytest.mark.parametrize(
    ("position", "velocity", "duration", "collides"),
    [
        ((1.0, 2.0, -2.0), (0.0, 0.0, 0.0), 0.999 * FALL * 27.0**0.5, False),
        ((1.0, 2.0, -2.0), (0.0, 0.0, 0.0), 1.001 * FALL * 27.0**0.5, True),
        ((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), -0.999 * FALL, False),
        ((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), -1.001 * FALL, True),
        ((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1e5, True),
        ((2.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 2.0 * 0.999 * 2.0 / 3.0, False),  # parabola: 2 r / (3 v)
        ((2.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 2.0 * 1.001 * 2.0 / 3.0, True),
        ((2.0, 0.0, 0.0), (1.0, 0.0, 0.0), 1e9, False),
        ((2.0, 0.0, 0.0), (1.0, 0.0, 0.0), -2.0 * 1.001 * 2.0 / 3.0, True),
        ((1e3, 0.0, 0.0), (-3.0, 0.0, 0.0), 300.0, False),
        ((1e3, 0.0, 0.0), (-3.0, 0.0, 0.0), 340.0, True),
        ((1e3, 0.0, 0.0), (-3.0, 0.0, 0.0), -1e9, False),
        ((0.5, 0.0, 0.0), (1.0, 0.0, 0.0), 0.1, False),
        ((0.5, 0.0, 0.0), (1.0, 0.0, 0.0), 3.0, True),  # up, and down again
    ],
)
def test_a_collision_is_refused_and_nothing_short_of_it(position, velocity, duration, collides):
    if not collides:
        place, pace = kepler.propagate(position, velocity, 1.0, duration)
        back, _ = kepler.propagate(place, pace, 1.0, -duration)
        assert back == pytest.approx(position, rel=1e-6, abs=1e-9)
        return
    with pytest.raises(BadInput, match=r"^the motion is radial and meets the centre; shorten the duration$"):
        kepler.propagate(position, velocity, 1.0, duration)


ONE = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), 1.0, 1.0)


@pytest.mark.parametrize(
    ("which", "value", "message"),
    [
        (0, (0.0, 0.0, 0.0), "the position is the centre itself; start elsewhere"),
        (0, (1.0, float("nan"), 0.0), "position is not finite; give numbers"),
        (1, (1.0, float("inf"), 0.0), "velocity is not finite; give numbers"),
        (
            1,
            (1.0, 0.0),
            r"velocity: has shape \(2,\); give an array whose first axis has length 3, one entry for each component",
        ),
        (
            0,
            1.0,
            r"position: has shape \(\); give an array whose first axis has length 3, one entry for each component",
        ),
        (2, 0.0, "mu is not positive; give the gravitational parameter of the centre"),
        (2, -1.0, "mu is not positive; give the gravitational parameter of the centre"),
        (2, float("nan"), "mu is not finite; give numbers"),
        (3, float("inf"), "duration is not finite; give numbers"),
        (3, "a day", "duration: the value is not an array of real numbers; give real numbers"),
        (3, 1j, "duration: the value is not an array of real numbers; give real numbers"),
        (
            0,
            (1e308, 1e308, 0.0),
            "the motion exceeds the range of floating-point numbers; check the units and the duration",
        ),
    ],
)
def test_bad_input_is_refused_in_one_line(which: int, value: object, message: str):
    given = list(ONE)
    given[which] = value
    with pytest.raises(BadInput, match=f"^{message}$"):
        kepler.propagate(*given)


def test_of_many_the_first_bad_one_is_named():
    mu = np.ones((2, 3))
    mu[1, 0] = mu[1, 2] = -1.0
    with pytest.raises(BadInput, match=r"^index \(1, 0\): mu is not positive"):
        kepler.propagate(*ONE[:2], mu, 1.0)
    with pytest.raises(BadInput, match=r"^index 2: duration is not finite"):
        kepler.propagate(*ONE[:3], [1.0, 2.0, float("nan")])
    with pytest.raises(BadInput, match=r"^index 1: the motion is radial and meets the centre"):
        kepler.propagate((1.0, 0.0, 0.0), np.array([[0.0, 0.0], [0.1, 0.0], [0.0, 0.0]]), 1.0, 9.0)
    with pytest.raises(BadInput, match="cannot be broadcast"):
        kepler.propagate(np.ones((3, 2)), np.ones((3, 3)), 1.0, 1.0)
