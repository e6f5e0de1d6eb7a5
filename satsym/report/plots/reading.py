"""Readable numbers on axes for quantities of any size and offset. This module draws nothing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.report.display import Scale, labelled, together
from satsym.report.plots.series import Series

SMALL_DEVIATION = 0.02
"""Ratio of deviation to value below which the deviation is plotted, since it would be invisible in the value."""
BURIED = 1e-3
"""Ratio of variation to value below which values are plotted relative to the first, since ticks need many digits."""
FURTHEST, GLIMPSE = 3.0, 0.4
"""Distance beside the main curve, in widths of it, within which other curves are shown completely, and displayed width
of curves that are farther away."""
FREE = 1.5
"""Distance beside a path, in widths of the path, within which the uncontrolled motion is shown completely."""
IN_SIGHT = 2.0
"""Largest distance at which a bound is shown, in widths of everything else."""
LEVELS = 400
"""Number of values at which the boundary of a forbidden region is searched."""
ROUNDING = 1e-9
"""Variation relative to the magnitude of a quantity below which it counts as zero."""


@dataclass(frozen=True, eq=False)
class Reading:
    """A quantity in the form in which it is shown."""

    label: str
    unit: str
    """Symbol with the unit of all numbers, and this unit."""
    values: Array
    reference: Array | None
    free: Array | None
    target: float | None
    lower: float
    upper: float
    """Values and bounds of :class:`~satsym.report.plots.series.Series`, in the displayed unit and relative to the
    datum."""
    low: float
    high: float
    """Lower and upper end of the axis."""
    deviation: bool
    """Whether the reading is the deviation from the reference."""
    turns: bool
    """Whether multiples of pi are marked."""
    scale: float
    datum: Array | float
    """The shown value is the scale times the difference of value and datum."""

    def value(self, shown: Array) -> Array:
        """Return the quantity of a shown value; the last axis counts nodes if the datum does."""
        return shown / self.scale + self.datum


@dataclass(frozen=True, eq=False)
class _Counted:
    """A quantity in the unit of its series or in degrees, relative to its datum."""

    series: Series
    symbol: str
    unit: str
    factor: float
    """Ratio of the series' unit to the shown unit."""
    datum: Array | float
    low: float
    high: float
    deviation: bool
    turns: bool

    @classmethod
    def of(cls, series: Series) -> _Counted:
        size = max(_size(series.values), series.size)
        datum, deviation = _datum(series, size)
        symbol, unit, factor = series.symbol, series.unit, 1.0
        if deviation:
            symbol = rf"$\Delta${symbol}"
        elif np.any(datum):
            symbol = rf"{symbol}$\,-\,${symbol}$(t_0)$"
        radians = series.angle and unit == "rad"
        if radians and deviation:
            unit, factor = "deg", 180.0 / math.pi
        turns = radians and not deviation and _width(series.values - datum) > 0.5 * math.pi
        shown = (series.values - datum) * factor
        low, high = _ends(series, shown, datum, factor, size * factor)
        return cls(series, symbol, unit, factor, datum, low, high, deviation, turns)

    @property
    def from_datum(self) -> bool:
        """Tell whether the reading is relative to a value other than zero."""
        return self.deviation or bool(np.any(self.datum))

    @property
    def furthest(self) -> float:
        """Return the end of the axis farther from zero; none for a quantity of rounding errors only."""
        series = self.series
        flat = _size((series.values - self.datum) * self.factor) <= ROUNDING * series.size * self.factor
        return 0.0 if flat else max(abs(self.low), abs(self.high))

    def shown(self, measure: Scale) -> Reading:
        """Return the series in a unit, as it is shown."""
        scale, series, datum = 1.0 / measure.divisor, self.series, self.datum

        def placed(values: Array | None) -> Array | None:
            return None if values is None else (values - datum) * self.factor * scale

        last = datum if isinstance(datum, float) else float(datum[-1])
        return Reading(
            label=labelled(self.symbol, measure.unit),
            unit=measure.unit,
            values=(series.values - datum) * self.factor * scale,
            reference=placed(series.reference),
            free=placed(series.free),
            target=None if series.target is None else (series.target - last) * self.factor * scale,
            lower=series.lower * scale,
            upper=series.upper * scale,
            low=self.low * scale,
            high=self.high * scale,
            deviation=self.deviation,
            turns=self.turns,
            scale=self.factor * scale,
            datum=datum,
        )


def read(quantities: Sequence[Series]) -> list[Reading]:
    """Choose what is shown: the deviation where the value hides it, its unit, and the ends of the axis.

    Quantities with one unit keep a common one, so that the components of a vector can be compared.
    """
    counted = [_Counted.of(each) for each in quantities]
    measures: dict[int, Scale] = {}
    for apart in (False, True):
        own = [k for k, each in enumerate(counted) if each.from_datum is apart and not each.series.plain_unit]
        measures |= dict(zip(own, together([(counted[k].unit, counted[k].furthest) for k in own]), strict=True))
    return [
        each.shown(Scale(0, each.unit) if each.turns or each.series.plain_unit else measures[k])
        for k, each in enumerate(counted)
    ]


def within_reach(excess: float, width: float, furthest: float = FURTHEST) -> float:
    """Return how far an axis is extended for what is drawn beside the main curve: fully, or a little if that is far.

    Parameters
    ----------
    excess
        What it would take to show all.
    width
        Of the main curve.
    furthest
        How many of these widths all is shown up to.
    """
    return excess if excess <= furthest * width else GLIMPSE * width


def _datum(series: Series, size: float) -> tuple[Array | float, bool]:
    """Return the value that a series is relative to: the reference, the first value, or zero."""
    reference, known = series.reference, _known(series.values)
    if series.from_first:
        return float(known[0]), False
    if reference is not None and np.isfinite(reference).all():
        hidden = ROUNDING * size < _size(series.values - reference) < SMALL_DEVIATION * _size(known)
        return (reference, True) if hidden else (0.0, False)
    hidden = ROUNDING * size < _width(known) < BURIED * _size(known)
    return (float(known[0]), False) if hidden else (0.0, False)


def _ends(series: Series, shown: Array, datum: Array | float, factor: float, size: float) -> tuple[float, float]:
    """Return the ends of the axis: all of the values, and of the rest as much as leaves them readable."""
    core = _known(shown)
    low, high = float(core.min()), float(core.max())
    if series.target is not None:
        wanted = (series.target - (datum if isinstance(datum, float) else float(datum[-1]))) * factor
        low, high = min(low, wanted), max(high, wanted)
    if series.from_zero:
        low, high = min(low, 0.0), max(high, 0.0)
    flat = high - low <= ROUNDING * size
    reach = math.inf if flat else high - low
    lowest, highest = low, high
    for curve in (series.reference, series.free):
        if curve is not None and np.isfinite(curve).any():
            beside = _known((curve - datum) * factor)
            low = min(low, lowest - within_reach(lowest - float(beside.min()), reach))
            high = max(high, highest + within_reach(float(beside.max()) - highest, reach))
    for bound in (series.lower, series.upper):
        if math.isfinite(bound) and low - IN_SIGHT * reach <= bound <= high + IN_SIGHT * reach:
            low, high = min(low, bound), max(high, bound)
    for edge in _edges(series, low, high, reach, datum, factor):
        low, high = min(low, edge), max(high, edge)
    if high - low <= max(ROUNDING, series.steady) * size or high == low:
        room = 0.1 * max(abs(low), size) or 1.0
    else:
        room = 0.07 * (high - low)
    return low - room, high + room


def _edges(series: Series, low: float, high: float, reach: float, datum: Array | float, factor: float) -> list[float]:
    """Return the edges of forbidden regions on each side of what is shown, if they are in sight."""
    if not series.forbidden or not math.isfinite(reach):
        return []
    shown = np.linspace(low - IN_SIGHT * reach, high + IN_SIGHT * reach, LEVELS)
    values = shown[:, None] / factor + datum + np.zeros_like(series.values)
    found = []
    for forbidden in series.forbidden:
        bad = forbidden(values) > 0.0
        for above in (False, True):
            beyond = bad[1:] & ~bad[:-1] if above else bad[:-1] & ~bad[1:]
            where = shown[1:][beyond.any(axis=1)] if above else shown[:-1][beyond.any(axis=1)]
            found += [float(where.min() if above else where.max())] if where.size else []
    return found


def _known(values: Array) -> Array:
    """Return the finite values; a zero where there are none."""
    known = values[np.isfinite(values)]
    return known if known.size else np.zeros(1)


def _width(values: Array) -> float:
    return float(np.ptp(_known(values)))


def _size(values: Array) -> float:
    return float(np.abs(_known(values)).max())


def box(curve: Array, others: list[Array], free: Array | None = None) -> tuple[Array, Array]:
    """Corners around a curve; what is drawn beside it widens them as far as the curve stays readable.

    Parameters
    ----------
    curve, others
        Shape (2 or 3, N) each.
    free
        The uncontrolled motion, of which less is shown.
    """
    low, high = np.nanmin(curve, axis=1), np.nanmax(curve, axis=1)
    width = float((high - low).max()) or np.inf
    core = (low, high)
    beside = [(other, FURTHEST) for other in others] + ([] if free is None else [(free, FREE)])
    for other, furthest in beside:
        if np.isfinite(other).any(axis=1).all():
            below, above = core[0] - np.nanmin(other, axis=1), np.nanmax(other, axis=1) - core[1]
            low = np.minimum(low, core[0] - [within_reach(excess, width, furthest) for excess in below])
            high = np.maximum(high, core[1] + [within_reach(excess, width, furthest) for excess in above])
    room = 0.07 * (high - low)
    room[room == 0.0] = 0.07 * float((high - low).max()) or 1.0
    return low - room, high + room
