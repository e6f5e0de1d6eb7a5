"""What is measured of satellites of the Earth, of sweeps and of what can be reached, against geometry and solutions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satsym.auditing import measurements
from satsym.auditing.propositions.values import Undecided
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas

WORDS = measurements.words()
MEASURE, GEO = WORDS.functions, WORDS.values["GEOSTATIONARY"]()
ORBITS = WORDS.values["ORBITS"]()


def test_the_geostationary_orbit_is_where_it_is_known_to_be():
    assert GEO.part("altitude").value == pytest.approx(35_786e3, abs=1e3)
    assert MEASURE["gravity"](GEO).value == pytest.approx(0.2242, abs=1e-4)
    assert MEASURE["circular"]("35786 km").part("period").value == pytest.approx(86_164.0, abs=1.0)


def test_satellites_stand_still_on_the_geostationary_orbit_alone():
    for orbit in ORBITS:
        still = MEASURE["ground_swing"](orbit) < 1e-9
        assert still == (MEASURE["antenna_swing"](orbit) < 1e-9)
        plain = orbit.part("eccentricity") == 0.0 and orbit.part("inclination") == 0.0
        assert still == (plain and orbit.part("period").value == GEO.part("period").value)


def test_an_inclined_synchronous_satellite_goes_as_far_as_its_inclination():
    inclined = [o for o in ORBITS if o.part("inclination") == 28.5 and o.part("eccentricity") == 0.0]
    day = next(o for o in inclined if o.part("period").value == GEO.part("period").value)
    assert MEASURE["ground_swing"](day) == pytest.approx(28.5, abs=0.1)


def test_signals_take_as_long_as_light_does():
    light, radius, ground = 299_792_458.0, GEO.part("axis").value, 6_378_137.0
    assert MEASURE["signal_time"](GEO, 2, 90).value == pytest.approx(2.0 * (radius - ground) / light)
    assert MEASURE["signal_time"](GEO, 1, 0).value == pytest.approx(math.sqrt(radius**2 - ground**2) / light)
    assert MEASURE["seen_latitude"](GEO) == pytest.approx(81.3, abs=0.01)


def test_a_constant_that_is_not_published_is_refused():
    with pytest.raises(BadInput, match="mu_earth"):
        MEASURE["constant"]("mu_eart")


def test_what_is_given_at_the_ends_is_what_the_boundary_type_says():
    states = ["r", "r_dot", "theta", "theta_dot"]
    assert MEASURE["given_at_end"]("its-thesis") == [f"lambda_{name}" for name in states]
    assert MEASURE["given_at_end"]("soft-return") == ["lambda_theta"]  # the others depend on where it ends
    assert MEASURE["given_at_end"]("return-to-orbit") == states


def test_sweeps_end_where_no_control_is_needed_whatever_they_begin_with():
    found = MEASURE["swept"]("its-thesis", 0.4)
    assert found.part("J") == 0.0
    assert not found.part("u1").any()


def test_sweeps_that_do_not_settle_are_undecided():
    with pytest.raises(Undecided, match="still change"):
        MEASURE["swept"]("soft-return")


def test_the_cost_of_an_optimum_is_its_terminal_cost_and_the_area_below_the_running_one():
    found = MEASURE["least_cost"]("soft-return")
    running = MEASURE["area"](found.part("V"), found.part("t"))
    assert found.part("J") == pytest.approx(found.part("S") + running, rel=1e-6)
    np.testing.assert_allclose(found.part("V"), 0.5 * (found.part("u1") ** 2 + found.part("u2") ** 2))


def test_a_satellite_stays_on_its_orbit_until_it_is_displaced():
    aim = MEASURE["reference"]("return-to-orbit")
    assert MEASURE["distance"](MEASURE["displaced"]("return-to-orbit").part("end"), aim) < 1e-9
    moved = MEASURE["displaced"]("return-to-orbit", r=0.01).part("end")
    assert MEASURE["distance"](moved, aim) > 1e-3


def test_a_formula_is_not_defined_where_it_divides_zero_by_zero():
    x, y = formulas.symbol("x"), formulas.symbol("y")
    assert MEASURE["defined"](x / y, x=0) is True
    assert MEASURE["defined"](x / y, x=0, y=0) is False
    bounded = formulas.function("min", [x / y, y])
    assert MEASURE["defined"](bounded, x=0, y=0) is False
    assert MEASURE["defined"](bounded, x=0, y=2) is True


def test_parts_of_a_curve():
    curve = np.arange(100.0)
    assert MEASURE["mean"](MEASURE["early"](curve)) == 4.5
    assert MEASURE["mean"](MEASURE["late"](curve)) == 94.5
    t = np.linspace(0.0, math.pi, 60)
    assert MEASURE["area"](np.sin(t), t) == pytest.approx(2.0, abs=1e-6)
