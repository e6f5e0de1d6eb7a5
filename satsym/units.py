"""Quantities written as text, such as ``"42164.17 km"``, in the unit that a model wants.

The text comes from a file, so it is read by a small grammar of our own: a number, then unit names with
``*``, ``/``, parentheses and small whole exponents. pint is asked about single names only. It would evaluate
anything it is given, powers included, and ``"1 m**9**9**9"`` is a quantity too. It costs half a second to load,
hence is imported where the first quantity is read and nowhere else.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import cache, lru_cache
from typing import Any

from satsym.status import BadInput
from satsym.wording import shown

MAX_LENGTH = 100
MAX_EXPONENT = 9

_NUMBER = re.compile(r" *([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?)(?![0-9.]) *")
_EXPONENT = r"(?:(?:\^|\*\*) *([+-]?[0-9])(?![0-9.]))? *"
_FACTOR = re.compile(r" *(1(?![0-9.])|[A-Za-z][A-Za-z0-9_]*) *" + _EXPONENT)
_OPENED, _CLOSED = re.compile(r" *\("), re.compile(r"\) *" + _EXPONENT)
_OPERATOR = re.compile(r"\*|/")


def parse_quantity(text: str, unit: str) -> float:
    """Read a number with a unit, and give it in another unit.

    Parameters
    ----------
    text
        A number, then a unit expression: names, ``*``, ``/``, ``^`` or ``**`` with a whole exponent from -9 to
        9, parentheses, spaces. ``a/b*c`` is ``(a/b)*c``.
    unit
        The unit wanted, in the same notation; ``"1"`` where there is none.

    Returns
    -------
    float
        The finite value in `unit`.

    Raises
    ------
    BadInput
        If the text is not such a quantity, a unit is unknown or has an offset (degC), the dimensions differ, an
        angle is wanted and the text has no angle unit, or the value is out of range.
    """
    match = _NUMBER.match(text) if len(text) <= MAX_LENGTH else None
    if match is None:
        raise BadInput(f'{shown(text)} is not a number with a unit; write, for instance, "5 {_example(unit)}"')
    if match.end() == len(text):
        raise BadInput(f"{shown(text)} has no unit; write {match[1]} without quotes, or add a unit after it")
    given, wanted = _unit(text[match.end() :]), _unit(unit)
    if given.dimensionality != wanted.dimensionality:
        raise BadInput(
            f'{shown(text)} does not have the required dimension, that of "{unit}"; write it in a unit of this '
            "dimension"
        )
    if _has_angle(wanted) and not _has_angle(given):
        # pint counts radians as plain numbers, so that 1 Hz would silently become 1 rad/s
        raise BadInput(
            f'{shown(text)} is not an angle, but the model requires "{unit}"; write it with rad, deg or turn'
        )
    value = _convert(float(match[1]), given, wanted)
    if not math.isfinite(value):
        raise BadInput(f'{shown(text)} is out of range in "{unit}"; give a smaller number')
    return value


def split_quantity(text: str) -> tuple[str, str]:
    """Split a quantity that :func:`parse_quantity` reads into its number and its unit, as written."""
    match = _NUMBER.match(text)
    assert match is not None
    return match[1], text[match.end() :]


def dimension(unit: str) -> Mapping[str, int | Fraction]:
    """Return the exponents of the base dimensions of a unit; empty for a plain number and for an angle.

    Parameters
    ----------
    unit
        A unit expression as in `parse_quantity`, for instance ``"km/s^2"``.

    Returns
    -------
    Mapping
        For instance ``{"[length]": 1, "[time]": -2}``, sorted by name.

    Raises
    ------
    BadInput
        If the unit is not readable or unknown.
    """
    exponents = _unit(unit).dimensionality
    return {name: _exact(exponents[name]) for name in sorted(exponents) if exponents[name] != 0}


def factors(unit: str) -> dict[str, int]:
    """Return the names in a unit expression with their exponents; empty for a plain number.

    Raises
    ------
    BadInput
        If it is not readable. That a name is known is not looked at, which would load pint.
    """
    return {name: exponent for name, exponent in _factors(unit).items() if exponent}


def expression(factors: Mapping[str, int]) -> str:
    """Write a unit expression such as ``km**2/kg/s**3`` from names with exponents; ``"1"`` without any."""
    above, below = (
        [name if abs(n) == 1 else f"{name}**{abs(n)}" for name, n in factors.items() if n * sign > 0]
        for sign in (1, -1)
    )
    return "/".join(["*".join(above) or "1", *below])


def in_base_units(name: str) -> float:
    """Return how many base units, such as metres, a unit of one name is.

    Raises
    ------
    BadInput
        If it is unknown.
    """
    return _convert(1.0, _named(name), _registry().get_base_units(_named(name))[1])


def time_unit(units: Iterable[str]) -> str:
    """Return the unit in which a model counts time, determined from the units of its variables.

    Parameters
    ----------
    units
        Unit expressions as in `parse_quantity`.

    Returns
    -------
    str
        The name that stands for time in them, ``"s"`` where none does.

    Raises
    ------
    BadInput
        If they use several units of time.
    """
    found: dict[Any, str] = {}
    for expression in units:
        for name in _factors(expression):
            if dict(_named(name).dimensionality) == {"[time]": 1}:
                found.setdefault(_named(name), name)
    if len(found) > 1:
        several = '" and "'.join(sorted(found.values()))
        raise BadInput(f'the model measures time in "{several}"; give times as plain numbers, without units')
    return next(iter(found.values()), "s")


def _example(unit: str) -> str:
    return unit if unit != "1" else "percent"


def _exact(exponent: float) -> int | Fraction:
    fraction = Fraction(exponent).limit_denominator(12)
    return int(fraction) if fraction.denominator == 1 else fraction


@lru_cache(maxsize=256)
def _unit(expression: str) -> Any:
    """Return the pint unit of an expression."""
    unit = _registry().Unit("dimensionless")
    for name, exponent in _factors(expression).items():
        unit *= _named(name) ** exponent
    return unit


def _factors(expression: str) -> dict[str, int]:
    """Return the names in a unit expression and their exponents, by our grammar alone."""
    found = _product(expression, 0) if len(expression) <= MAX_LENGTH else None
    if found is None or found[1] != len(expression) or any(abs(n) > MAX_EXPONENT for n in found[0].values()):
        raise BadInput(
            f"the unit {shown(expression)} cannot be read; write names joined by * or /, with exponents up to "
            f'{MAX_EXPONENT}, for instance "km/s^2"'
        )
    return found[0]


_Read = tuple[dict[str, int], int]
"""Names with their exponents, and the position after the parsed text."""


def _product(text: str, position: int) -> _Read | None:
    """Parse powers joined by ``*`` and ``/``, from a position on; ``None`` where there are none."""
    factors: dict[str, int] = {}
    sign = 1
    while (one := _power(text, position)) is not None:
        names, position = one
        for name, exponent in names.items():
            factors[name] = factors.get(name, 0) + sign * exponent
        operator = _OPERATOR.match(text, position)
        if operator is None:
            return factors, position
        position, sign = operator.end(), -1 if operator[0] == "/" else 1
    return None


def _power(text: str, position: int) -> _Read | None:
    """Parse a name, a one or a product in parentheses, with its exponent."""
    if match := _FACTOR.match(text, position):
        return ({} if match[1] == "1" else {match[1]: int(match[2] or 1)}), match.end()
    opened = _OPENED.match(text, position)
    inner = _product(text, opened.end()) if opened else None
    closed = _CLOSED.match(text, inner[1]) if inner else None
    if inner is None or closed is None:
        return None
    return {name: exponent * int(closed[1] or 1) for name, exponent in inner[0].items()}, closed.end()


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


@lru_cache(maxsize=256)
def _named(name: str) -> Any:
    """Return the pint unit of a single name; units with an offset or a logarithm are refused."""
    import pint

    registry = _registry()
    try:
        unit = registry.Unit(name)
        zero = registry.Quantity(0.0, unit).to_base_units().magnitude
    except (pint.PintError, ArithmeticError, AttributeError, TypeError, ValueError):
        raise BadInput(f'unit "{name}" is unknown; use a name such as km, s, rad, deg, day') from None
    if zero != 0.0:
        raise BadInput(
            f'the scale of the unit "{name}" does not start at zero; give the quantity in an absolute unit such '
            "as kelvin"
        )
    return unit


def _has_angle(unit: Any) -> bool:
    return "radian" in str(_registry().get_base_units(unit)[1])


def _convert(value: float, given: Any, wanted: Any) -> float:
    try:
        return float(_registry().Quantity(value, given).to(wanted).magnitude)
    except ArithmeticError:
        return math.inf
