"""How numbers are put before people: labels, units, powers of ten and readable times. Draws nothing."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from functools import lru_cache

_SECONDS = {"ms": 1e-3, "s": 1.0, "sec": 1.0, "second": 1.0, "min": 60.0, "minute": 60.0, "h": 3600.0, "hour": 3600.0}
_SECONDS |= {"d": 86400.0, "day": 86400.0, "year": 31557600.0, "yr": 31557600.0}
_READABLE = (("s", 600.0), ("min", 7200.0), ("h", 4 * 86400.0), ("day", 3 * 31557600.0), ("year", math.inf))
"""Units of time, and the length in seconds from which the next one reads better."""
_LENGTHS = frozenset("m km cm mm au AU astronomical_unit ft mile nautical_mile".split())
ASTRONOMICAL_UNIT = 149_597_870_700.0
"""In metres, by definition (IAU 2012, resolution B2)."""
_RAISED = str.maketrans("+-0123456789", "⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_POWER = re.compile(r"(?:\*\*|\^)\s*([+-]?\d+)")


@lru_cache(maxsize=512)
def formula(latex: str, fallback: str) -> str:
    """A formula as matplotlib sets it, or the plain text where it cannot."""
    from matplotlib.mathtext import MathTextParser

    text = f"${latex}$"
    try:
        MathTextParser("path").parse(text)
    except (ValueError, RuntimeError):
        return plain(fallback)
    return text


def plain(text: str) -> str:
    """Text as matplotlib must be given it so that nothing in it is taken for a formula."""
    return text.replace("$", r"\$")


def unit_text(unit: str, exponent: int = 0) -> str:
    """A unit, such as ``km/s**2``, after a power of ten: 10⁻⁹ km/s². Empty for a plain number."""
    factor = f"10{str(exponent).translate(_RAISED)}" if exponent else ""
    raised = _POWER.sub(lambda power: power[1].translate(_RAISED), "" if unit == "1" else unit)
    return f"{factor} {raised.replace('*', '·')}".strip()


def labelled(symbol: str, unit: str, exponent: int = 0) -> str:
    """A label of an axis: symbol, and the unit in brackets where there is one."""
    bracket = unit_text(unit, exponent)
    return f"{symbol} [{bracket}]" if bracket else symbol


def exponent_for(size: float) -> int:
    """The power of ten (a multiple of 3) to divide by so that numbers up to ``size`` are short; mostly 0."""
    if not math.isfinite(size) or size == 0.0 or 1e-2 <= size < 1e4:
        return 0
    return 3 * math.floor(math.log10(size) / 3.0)


def number(value: float, digits: int = 6) -> str:
    """A number in a sentence, such as 42164.2 or 1.6 × 10⁻⁸."""
    mantissa, e, exponent = f"{value:.{digits}g}".partition("e")
    return mantissa.replace("-", "\N{MINUS SIGN}") + (_times_ten_to(int(exponent)) if e else "")


def on_axis(value: float, exponent: int, digits: int) -> str:
    """A number as its axis shows it, with the power of ten that the axis is divided by: -770.67 × 10⁻¹⁵.

    Parameters
    ----------
    value
        Divided by that power.
    """
    text = number(value, digits)
    if not exponent or value == 0.0:
        return text
    return number(value * 10.0**exponent, digits) if "×" in text else text + _times_ten_to(exponent)


def _times_ten_to(exponent: int) -> str:
    return f" × 10{str(exponent).translate(_RAISED)}"


def time_scale(units: Iterable[str], span: float) -> tuple[float, str]:
    """Number of model units of time in the unit that reads best for a length of time, and that unit.

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
    """The one unit of time in the units of a model's variables, ``"1"`` where it is not clear."""
    found = {name for unit in units for name in _NAME.findall(unit) if name in _SECONDS}
    return found.pop() if len(found) == 1 else "1"


def length_unit(units: Iterable[str]) -> str:
    """The one unit of length among the units of a model's states, ``"1"`` where it is not clear."""
    found = _LENGTHS.intersection(units)
    return next(iter(found)) if len(found) == 1 else "1"


def length_scale(unit: str, size: float) -> tuple[float, str]:
    """Number of units of length in the unit that reads best for a size, and that unit: AU between planets."""
    metres = {"m": 1.0, "km": 1e3}.get(unit)
    if metres is None or not math.isfinite(size) or size * metres < 0.1 * ASTRONOMICAL_UNIT:
        return 1.0, unit
    return ASTRONOMICAL_UNIT / metres, "AU"


def shortened(text: str, limit: int) -> str:
    """The text, cut at a word so that it has at most ``limit`` characters."""
    if len(text) <= limit:
        return text
    return text[: limit - 1].rsplit(" ", 1)[0].rstrip(" ,;:") + "\N{HORIZONTAL ELLIPSIS}"
