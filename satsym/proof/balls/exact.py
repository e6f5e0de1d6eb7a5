"""Exact numbers as they were written: decimals are rational, quantities have units, degrees are multiples of pi."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

from flint import arb

from satsym import units
from satsym.instance import Instance, files
from satsym.proof.balls.arithmetic import Ball, BeyondProof
from satsym.proof.balls.kernel import exactly
from satsym.status import BadInput
from satsym.wording import printable

_ANGLES = {
    **dict.fromkeys(("rad", "radian", "radians"), None),
    **dict.fromkeys(("deg", "degree", "degrees"), Fraction(1, 180)),
    **dict.fromkeys(("turn", "turns", "revolution"), Fraction(2)),
    **dict.fromkeys(("arcmin", "arcminute"), Fraction(1, 10800)),
    **dict.fromkeys(("arcsec", "arcsecond"), Fraction(1, 648000)),
}
"""Units of angles -> their value as a multiple of pi; ``None`` for radians."""


@dataclass(frozen=True)
class Number:
    """An exact number in the statement of a problem.

    Attributes
    ----------
    rational
        The number, or what multiplies a power of pi.
    turns
        The exponent of that power.
    stated
        The number as the record of a proof shows it.
    """

    rational: Fraction
    turns: int
    stated: str

    @property
    def ball(self) -> Ball:
        """Return the number as a ball, to the present precision."""
        return exactly(self.rational) * arb.pi() ** self.turns


class Source:
    """The numbers of an instance, each as the text of its file states it.

    Where the instance has another number than its file, its float is taken as the binary fraction that it is; so is
    every number of an instance that was made in Python.
    """

    def __init__(self, instance: Instance) -> None:
        self._tree: Mapping[str, Any] = {}
        self.path = ""
        if instance.path.is_file():
            try:
                self._tree = tomllib.loads(files.text(instance.path), parse_float=Fraction)
                self.path = instance.path.name
            except (tomllib.TOMLDecodeError, ValueError, BadInput):
                self._tree = {}
        self.stated: dict[str, str] = {}
        """Name -> the value as it was read: a decimal, a quantity or a binary fraction."""

    def number(self, value: float, unit: str, *key: str | int) -> Ball:
        """Return the exact number of an instance that its file states under these keys.

        Parameters
        ----------
        value
            The float with which solvers compute.
        unit
            The unit of `value`; a text may carry another one.
        """
        written: Any = self._tree
        for part in key:
            try:
                written = written[part]
            except (KeyError, IndexError, TypeError):
                written = None
                break
        if isinstance(written, list) and written:  # a range of no width
            written = written[0]
        found = _read(written, unit, value) or _dyadic(value)
        self.stated[_named(key)] = found.stated
        return found.ball

    def default(self, value: float, *key: str) -> Ball:
        """Return the default of a parameter, whose decimal is in the generated module."""
        found = Number(Fraction(repr(float(value))), 0, repr(float(value)))
        self.stated[_named(key)] = found.stated
        return found.ball

    def free(self, value: float, *key: str) -> Ball:
        """Return the initial guess of a number that is to be found."""
        self.stated[_named(key)] = "free"
        return arb(value)

    def has_units(self, table: str) -> bool:
        """Tell whether a table of the file contains a quantity with its unit."""
        return any(isinstance(v, str) for v in self._tree.get(table, {}).values())

    def gives(self, *key: str) -> bool:
        """Tell whether the file has an entry under these keys."""
        written: Any = self._tree
        for part in key:
            if not isinstance(written, Mapping) or part not in written:
                return False
            written = written[part]
        return True


def _named(key: tuple[str | int, ...]) -> str:
    return ".".join(("lower", "upper")[part] if isinstance(part, int) else part for part in key)


def _read(written: Any, unit: str, value: float) -> Number | None:
    """Return the exact number in a file, if the instance's number is its nearest float."""
    if isinstance(written, bool):
        return None
    if isinstance(written, int | Fraction):
        return Number(Fraction(written), 0, _decimal(Fraction(written))) if float(written) == value else None
    if not isinstance(written, str):
        return None
    try:
        if units.parse_quantity(written, unit) != value:
            return None
        number, given = units.split_quantity(written)
    except BadInput:
        return None
    factor, turns = _factor(given, unit)
    return Number(Fraction(number) * factor, turns, printable(written))


def _decimal(number: Fraction) -> str:
    """Return a decimal fraction as it is usually written."""
    places = 0
    while (number * 10**places).denominator != 1 and places < 400:
        places += 1
    digits = f"{abs(int(number * 10**places)):0{places + 1}d}"
    sign = "-" if number < 0 else ""
    return sign + (f"{digits[:-places]}.{digits[-places:]}" if places else digits)


def _dyadic(value: float) -> Number:
    exact = Fraction(value)
    whole = exact == Fraction(repr(value))
    return Number(exact, 0, repr(value) if whole else f"{value!r} as a binary fraction, {value.hex()}")


def _factor(given: str, wanted: str) -> tuple[Fraction, int]:
    """Return the ratio of two units: a rational number, times a power of pi."""
    factor, turns = Fraction(1), 0
    for unit, sign in ((given, 1), (wanted, -1)):
        for name, exponent in units.factors(unit).items():
            n = sign * exponent
            if name in _ANGLES:
                half = _ANGLES[name]
                factor, turns = (factor * half**n, turns + n) if half else (factor, turns)
            else:
                factor *= _in_base_units(name) ** n
    return factor, turns


@cache
def _in_base_units(name: str) -> Fraction:
    """Return the exact factor from a named unit to base units.

    Raises
    ------
    BeyondProof
        If it is not defined by a rational number.
    """
    import pint

    registry: Any = _registry()
    try:
        found = registry.Quantity(Fraction(1), name).to_base_units()
    except (pint.PintError, ArithmeticError, TypeError):
        raise BeyondProof(f"a number in {printable(name)}") from None
    if not isinstance(found.magnitude, Fraction) or "radian" in str(found.units):
        raise BeyondProof(f"a number in {printable(name)}")
    if not math.isclose(float(found.magnitude), units.in_base_units(name), rel_tol=1e-12):
        raise BeyondProof(f"a number in {printable(name)}")
    return found.magnitude


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)
