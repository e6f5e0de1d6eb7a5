"""Quantities in text: what is read, what is refused, and that nothing is ever evaluated."""

from __future__ import annotations

import math
import subprocess
import sys
import time
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satsym.status import BadInput
from satsym.units import dimension, parse_quantity, time_unit

UNITS = ["1", "m", "km", "s", "day", "rad", "deg", "rad/s", "km/s^2", "km**2/s**3", "1/s**3", "kg*m/s^2", "percent"]


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("0 deg", "rad", 0.0),
        ("42164.17 km", "km", 42164.17),
        ("1 day", "s", 86400.0),
        ("7.2921159e-5 rad/s", "rad/s", 7.2921159e-5),
        ("0.02 deg", "rad", math.radians(0.02)),
        ("4e-8 km/s^2", "km/s**2", 4e-8),
        ("40 um / s ** 2", "km/s^2", 4e-8),
        ("-5 m", "km", -0.005),
        ("+.5km", "km", 0.5),
        ("1 turn/day", "rad/s", 2 * math.pi / 86400),
        ("2 km/s*s", "km", 2.0),
        ("3 1/s^3", "1/s**3", 3.0),
        ("1 (m)", "m", 1.0),
        ("5 kg/(m*s^2)", "Pa", 5.0),
        ("2 1/(N*m)**2", "1/J**2", 2.0),
        ("4 ((km/s)^2/(1/kg))^-1", "1/(kg*m**2/s**2)", 4e-6),
        ("3 s^-3", "1/s**3", 3.0),
        ("25 percent", "1", 0.25),
        ("1 eV", "J", 1.602176634e-19),
    ],
)
def test_a_quantity_is_converted_to_the_unit_of_the_model(text: str, unit: str, value: float) -> None:
    assert parse_quantity(text, unit) == pytest.approx(value, rel=1e-15, abs=0)


@pytest.mark.parametrize(
    ("text", "unit", "words"),
    [
        ("5 km", "rad", ["5 km", "rad", "dimension"]),
        ("5 km/s", "km", ["5 km/s", '"km"', "dimension"]),
        ("5 s", "1", ["dimension"]),
        ("5", "km", ["no unit", "without quotes"]),
        ("1 Hz", "rad/s", ["Hz", "angle"]),
        ("50 percent", "rad", ["angle"]),
        ("20 degC", "kelvin", ["degC", "zero"]),
        ("20 dB", "1", ["dB", "zero"]),
        ("5 parrots", "km", ["parrots", "unknown"]),
        ("5 kg/(m*s", "Pa", ["kg/(m*s", "cannot be read"]),
        ("5 (kg)m", "Pa", ["(kg)m", "cannot be read"]),
        ("5 ()", "Pa", ["()", "cannot be read"]),
        ("5 ((m)^9)^9", "m", ["cannot be read", "exponents up to 9"]),
        ("5 nan", "km", ["unknown"]),
        ("1e400 km", "km", ["out of range"]),
        ("1e308 km", "mm", ["out of range"]),
        ("nan km", "km", ["number with a unit"]),
        ("inf km", "km", ["number with a unit"]),
        ("", "km", ["number with a unit"]),
        ("reference", "km", ["number with a unit"]),
        ("1.2.3 km", "km", ["number with a unit"]),
        ("٣ km", "km", ["number with a unit"]),
        ("1 km\n", "km", ["cannot be read"]),
        ("1 km s", "km", ["cannot be read"]),
        ("1 km^10", "km", ["cannot be read"]),
        ("1 km^5*km^5", "km", ["cannot be read"]),
        ("1 m**9**9**9", "m", ["cannot be read"]),
        ("1 m*", "m", ["cannot be read"]),
        ("1 2*m", "m", ["cannot be read"]),
        ("1 __class__", "m", ["cannot be read"]),
        ("__import__('os').getcwd()", "m", ["number with a unit"]),
        ("1" * 6000 + " m", "m", ["number with a unit", "..."]),
        ("1 m" + "*m" * 6000, "m", ["number with a unit"]),
    ],
)
def test_what_is_no_such_quantity_is_refused_in_one_line(text: str, unit: str, words: list[str]) -> None:
    with pytest.raises(BadInput) as refusal:
        parse_quantity(text, unit)
    message = str(refusal.value)
    assert message.isprintable()
    assert len(message) < 250
    for word in words:
        assert word in message


quantity_like = st.lists(
    st.sampled_from([*"0123456789.+-eE*/^ ()_", "**", "**9", "km", "s", "deg", "rad", "1e9", "__", "\n", "µ", "lambda"])
    | st.text(max_size=3),
    max_size=12,
).map("".join)


@given(text=quantity_like, unit=st.sampled_from(UNITS))
def test_any_text_gives_a_finite_number_or_one_line(text: str, unit: str) -> None:
    parse_quantity("1 m", "m")  # the first one loads the units
    start = time.thread_time()
    value, message = 0.0, ""
    try:
        value = parse_quantity(text, unit)
    except BadInput as error:
        message = str(error)
    assert math.isfinite(value)
    assert message.isprintable()
    assert time.thread_time() - start < 1.0


@given(number=st.floats(allow_nan=False, allow_infinity=False), unit=st.sampled_from(UNITS[1:]))
def test_a_number_in_the_unit_of_the_model_comes_back_bit_for_bit(number: float, unit: str) -> None:
    assert parse_quantity(f"{number!r} {unit}", unit) == number


@given(
    number=st.floats(1e-100, 1e100),
    pair=st.sampled_from([("km", "mile"), ("s", "day"), ("rad/s", "rpm"), ("rad", "deg")]),
)
def test_there_and_back_again_is_the_same_number(number: float, pair: tuple[str, str]) -> None:
    here, there = pair
    assert parse_quantity(f"{parse_quantity(f'{number!r} {here}', there)!r} {there}", here) == pytest.approx(
        number, 1e-14
    )


@pytest.mark.parametrize(
    ("unit", "exponents"),
    [
        ("1", {}),
        ("rad", {}),
        ("deg", {}),
        ("rad/s", {"[time]": -1}),
        ("km/s**2", {"[length]": 1, "[time]": -2}),
        ("km/m", {}),
        ("N", {"[length]": 1, "[mass]": 1, "[time]": -2}),
        ("statcoulomb", {"[length]": Fraction(3, 2), "[mass]": Fraction(1, 2), "[time]": -1}),
    ],
)
def test_dimension_counts_base_dimensions(unit: str, exponents: dict[str, int]) -> None:
    found = dimension(unit)
    assert found == exponents
    assert list(found) == sorted(exponents)
    assert all(isinstance(n, int | Fraction) for n in found.values())


def test_dimension_refuses_what_is_no_unit() -> None:
    for unit in ("parrot", "", "km//s", "degC"):
        with pytest.raises(BadInput):
            dimension(unit)


def test_the_unit_of_time_is_the_one_that_the_variables_use() -> None:
    assert time_unit(["km", "km/s", "rad/s", "1/second**3"]) == "s"
    assert time_unit(["au", "au/day"]) == "day"
    assert time_unit(["1", "1"]) == "s"
    with pytest.raises(BadInput, match="plain numbers, without units"):
        time_unit(["km/s", "km/hour"])


def test_pint_is_loaded_with_the_first_quantity_only() -> None:
    code = (
        "import sys, satsym.units as u; assert 'pint' not in sys.modules; "
        "u.parse_quantity('1 km', 'm'); assert 'pint' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
