"""Numbers for people: labels, units, powers of ten and readable times. This module draws nothing."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

from satsym import units
from satsym.status import BadInput

_SECONDS = {"ms": 1e-3, "s": 1.0, "sec": 1.0, "second": 1.0, "min": 60.0, "minute": 60.0, "h": 3600.0, "hour": 3600.0}
_SECONDS |= {"d": 86400.0, "day": 86400.0, "year": 31557600.0, "yr": 31557600.0}
_READABLE = (("s", 600.0), ("min", 7200.0), ("h", 4 * 86400.0), ("day", 3 * 31557600.0), ("year", math.inf))
"""Units of time, each with the duration in seconds above which the next unit is easier to read."""
_LENGTHS = frozenset("m km cm mm au AU astronomical_unit ft mile nautical_mile".split())
ASTRONOMICAL_UNIT = 149_597_870_700.0
"""The astronomical unit in metres, by definition (IAU 2012, resolution B2)."""
COMPARABLE = 1e-3
"""Fraction of a vector's largest component above which another component is shown in the same unit."""
_RAISED = str.maketrans("+-0123456789", "⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_PREFIXES = {-12: "p", -9: "n", -6: "\N{MICRO SIGN}", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
_PREFIXED = {"km": ("m", 3), "mm": ("m", -3), "kg": ("g", 3), "kN": ("N", 3), "ms": ("s", -3)}
"""Unit with a prefix -> the unit without prefix, and the power of ten of the prefix."""
_LARGEST_POWERS = {"m": 3, "g": 3, "s": 0, "rad": 0, "deg": 0} | dict.fromkeys(("N", "W", "J", "V", "A"), 9)
"""Unit that takes prefixes -> the largest power of ten in common use."""
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_ONE = r"(?:km|m|cm|mm|kg|g|s|min|h|N|kN|J|W|V|A|rad|deg|kelvin)\b(?:(?:\*\*|\^)-?\d+)?"
_MEASURED = re.compile(rf"(?<=\d ){_ONE}(?:[*/]{_ONE})*")
"""Unit after a number and a space."""
_POWER = re.compile(r"(?:\*\*|\^)\s*([+-]?\d+)")
_TEN = re.compile(r"(?<![\w.])(\d[\d.,]*)e([-+]\d+)(?![\w.]\d)")


@lru_cache(maxsize=512)
def formula(latex: str, fallback: str) -> str:
    """Return a formula as matplotlib sets it, or the plain text where it cannot."""
    from matplotlib.mathtext import MathTextParser

    text = f"${latex}$"
    try:
        MathTextParser("path").parse(text)
    except (ValueError, RuntimeError):
        return plain(fallback)
    return text


def norm_latex(components: Sequence[str]) -> str:
    """Return the Euclidean norm of a vector as a formula in its components."""
    squares = " + ".join(f"({one})^2" if "^" in one else f"{one}^2" for one in components)
    return rf"\sqrt{{{squares}}}"


def norm_text(components: Sequence[str]) -> str:
    """Return the Euclidean norm of a vector in the names of its components: ``sqrt(u1^2 + u2^2)``."""
    return f"sqrt({' + '.join(f'{one}^2' for one in components)})"


def radical(text: str) -> str:
    """Write roots and powers in a text with their signs: ``sqrt(u1^2 + u2^2)`` as √(u1² + u2²)."""
    return raised(text.replace("sqrt(", "\N{SQUARE ROOT}("))


def plain(text: str) -> str:
    """Escape a text so that matplotlib takes nothing in it for a formula."""
    return text.replace("$", r"\$")


def unit_text(unit: str) -> str:
    """Write a unit for people: ``km/s**2`` as km/s², ``km/s/rad`` as km/(s·rad). Empty for a plain number."""
    written = raised("" if unit == "1" else unit).replace("*", "·")
    above, *below = written.split("/")
    return f"{above}/({'·'.join(below)})" if len(below) > 1 else written


def raised(text: str) -> str:
    """Write powers in a text with superscripts: ``4e-8 km/s^2`` as 4e-8 km/s²."""
    return _POWER.sub(lambda power: power[1].translate(_RAISED), text)


def with_raised_units(text: str) -> str:
    """Write the units after numbers in a sentence as people do: ``0.22 m/s^2`` as 0.22 m/s²; all else unchanged."""
    return _MEASURED.sub(lambda unit: unit_text(unit[0]), text)


def capitalised(text: str) -> str:
    """Return a sentence with a capital letter at its start and all other letters unchanged."""
    return text[:1].upper() + text[1:]


def labelled(symbol: str, unit: str) -> str:
    """Return the label of an axis: symbol, and the unit in brackets where there is one."""
    bracket = unit_text(unit)
    return f"{symbol} [{bracket}]" if bracket else symbol


@dataclass(frozen=True)
class Scale:
    """A readable unit, and its ratio to the given unit as a power of ten."""

    exponent: int
    unit: str

    @property
    def divisor(self) -> float:
        """Return the number that values are divided by."""
        return float(f"1e{self.exponent}")


@lru_cache(maxsize=512)
def engineering(unit: str, size: float) -> Scale:
    """Return the unit with the prefix that makes numbers up to ``size`` short.

    An example is um/s**2 (with the micro sign) for 1e-8 km/s**2. The first name above the fraction line that takes
    prefixes gets it. Where none does, the unit is unchanged.
    """
    stays = Scale(0, unit)
    if not math.isfinite(size) or size == 0.0 or 1e-3 <= size < 1e4:
        return stays
    try:
        factors = units.factors(unit)
    except BadInput:
        return stays
    plain_names = {name: _PREFIXED.get(name, (name, 0)) for name in factors}
    first = next(
        (name for name, (base, _) in plain_names.items() if base in _LARGEST_POWERS and factors[name] > 0), None
    )
    if first is None:
        return stays
    base, power = plain_names[first]
    allowed = {(p - power) * factors[first]: p for p in _PREFIXES if p <= max(_LARGEST_POWERS[base], power)}
    exponent = min(allowed, key=lambda e: abs(math.log10(size) - e - 1.0))
    name = _PREFIXES[allowed[exponent]] + base
    return Scale(exponent, units.expression({name if one == first else one: n for one, n in factors.items()}))


def together(quantities: Sequence[tuple[str, float]]) -> list[Scale]:
    """Return readable units for quantities with a unit and a size; components of a vector share one.

    A quantity that is far smaller than the largest with its unit has a unit of its own, since its ticks would be long
    numbers.
    """
    largest: dict[str, float] = {}
    for unit, size in quantities:
        largest[unit] = max(largest.get(unit, 0.0), size)
    far = ((unit, size, 0.0 < size < COMPARABLE * largest[unit]) for unit, size in quantities)
    return [engineering(unit, size if apart else largest[unit]) for unit, size, apart in far]


def number(value: float, digits: int = 6) -> str:
    """Write a number for a sentence, such as 42164.2 or 1.6 × 10⁻⁸."""
    mantissa, e, exponent = f"{value:.{digits}g}".partition("e")
    return mantissa.replace("-", "\N{MINUS SIGN}") + (times_ten_to(int(exponent)) if e else "")


def times_ten_to(exponent: int) -> str:
    """Return the text after a number that is to be multiplied by a power of ten."""
    return f" × 10{str(exponent).translate(_RAISED)}"


def with_powers(text: str) -> str:
    """Write powers of ten in a sentence as in print: ``error 4e-15`` as error 4 × 10⁻¹⁵."""
    return _TEN.sub(lambda found: f"{found[1]}{times_ten_to(int(found[2]))}", text)


def time_scale(units: Iterable[str], span: float) -> tuple[float, str]:
    """Return the readable unit for a length of time, and how many model units of time it has.

    Parameters
    ----------
    units
        Units of the model's variables; what counts time in them is taken for the model's unit of time.
    span
        In that unit.

    Returns
    -------
    (1.0, "1") where the model counts time in no unit that is known here, or in several.
    """
    own = time_unit(units)
    if own == "1":
        return 1.0, "1"
    readable = next(unit for unit, limit in _READABLE if span * _SECONDS[own] < limit or limit == math.inf)
    return _SECONDS[readable] / _SECONDS[own], own if _SECONDS[own] == _SECONDS[readable] else readable


def time_unit(units: Iterable[str]) -> str:
    """Return the only unit of time in the units of a model's variables, ``"1"`` where it is not clear."""
    found = {name for unit in units for name in _NAME.findall(unit) if name in _SECONDS}
    return found.pop() if len(found) == 1 else "1"


def length_unit(units: Iterable[str]) -> str:
    """Return the only unit of length among the units of a model's states, ``"1"`` where it is not clear."""
    found = _LENGTHS.intersection(units)
    return next(iter(found)) if len(found) == 1 else "1"


def length_scale(unit: str, size: float) -> tuple[float, str]:
    """Return the readable unit of length for a size, and how many given units it has: AU between planets."""
    metres = {"m": 1.0, "km": 1e3}.get(unit)
    if metres is None or not math.isfinite(size) or size * metres < 0.1 * ASTRONOMICAL_UNIT:
        return 1.0, unit
    return ASTRONOMICAL_UNIT / metres, "AU"
