"""Measures of a motion under any control law: impulse, effort, peak and final values, and violated limits."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

POINTS = 6
"""Gauss points in each interval between nodes."""


@dataclass(frozen=True, eq=False)
class Span:
    """A part of a motion on which its controls are smooth."""

    times: Array
    """Nodes for the integration of signals, shape (M,)."""
    x: Callable[[Array], Array]
    u: Callable[[Array], Array]
    """Functions from times within the span, shape (K,), to states (n, K) and to controls (m, K)."""


@np.errstate(over="ignore", invalid="ignore")  # numbers out of range are reported as such
def totals(instance: Instance, spans: Sequence[Span], impulse: float = 0.0) -> dict[str, float]:
    """Compute the numbers that describe a motion.

    Parameters
    ----------
    spans
        Parts of the motion, in order.
    impulse
        Integral of the first control over the moment at which the motion begins, which `spans` leave out.

    Returns
    -------
    dict
        ``impulse`` as given; of each control ``_total``, the integral over its magnitude, the impulse included,
        ``_peak`` without it, and ``_effort``, the integral over its square; of each state and derived quantity
        ``_peak`` and ``_final``; and of each derived quantity in watts ``_energy``, its integral. With an impulse,
        effort and energy are infinite.
    """
    spec = instance.model.spec
    m, powers = len(spec.controls), [k for k, variable in enumerate(spec.quantities) if variable.unit == "W"]

    def signals(span: Span, times: Array) -> Array:
        """Return controls, states and derived quantities at some times, in rows."""
        x, u = span.x(times), span.u(times)
        return np.concatenate([u, x, _quantities(instance, times, x, u)])

    def integrands(span: Span, times: Array) -> Array:
        x, u = span.x(times), span.u(times)
        return np.concatenate([np.abs(u), u**2, _quantities(instance, times, x, u)[powers]])

    spent = np.sum([_integral(span, partial(integrands, span)) for span in spans], axis=0)
    peaks = np.max([_peaks(span, partial(signals, span)) for span in spans], axis=0)
    last = signals(spans[-1], spans[-1].times[-1:])[:, 0]
    found: dict[str, float] = {"impulse": impulse}
    for k, name in enumerate(spec.control_names):
        at_once = impulse if k == 0 else 0.0
        found[f"{name}_total"] = float(spent[k]) + abs(at_once)
        found[f"{name}_peak"] = float(peaks[k])
        found[f"{name}_effort"] = math.inf if at_once else float(spent[m + k])
    for k, variable in enumerate((*spec.states, *spec.quantities), m):
        found |= {f"{variable.symbol}_peak": float(peaks[k]), f"{variable.symbol}_final": float(last[k])}
    for used, k in zip(spent[2 * m :], powers, strict=True):
        found[f"{spec.quantities[k].symbol}_energy"] = math.inf if impulse else float(used)
    return found


def excesses(instance: Instance, metrics: dict[str, float]) -> str:
    """Describe each limit that a motion exceeds in a sentence; empty where it exceeds none."""
    variables = {v.symbol: v for v in (*instance.model.spec.states, *instance.model.spec.quantities)}
    found = [
        f"{name} reaches {peak:.6g} {variables[name].unit}, which exceeds its limit of {limit:.6g}"
        for name, limit in instance.limits.items()
        if (peak := metrics.get(f"{name}_peak", 0.0)) > limit
    ]
    return "; ".join(found)


def spans_of(times: Array, x: Array, u: Array, switches: Sequence[float]) -> list[Span]:
    """Split a solution at the times at which its controls meet or leave bounds, or jump.

    States are interpolated by cubic splines; controls by straight lines between nodes, which are
    extrapolated to the ends of each part.
    """
    borders = [times[0], *sorted({s for s in switches if times[0] < s < times[-1]}), times[-1]]
    spans = []
    for a, b in pairwise(borders):
        margin = 1e-9 * (times[-1] - times[0])
        inside = np.flatnonzero((times > a + margin) & (times < b - margin))
        if len(inside) < 2:
            inside = np.arange(max(np.searchsorted(times, a) - 1, 0), min(np.searchsorted(times, b) + 1, len(times)))
        nodes = np.concatenate([[a], times[inside][(times[inside] > a) & (times[inside] < b)], [b]])
        spans.append(Span(nodes, _states(times, x), _controls(times[inside], u[:, inside])))
    return spans


def _states(times: Array, x: Array) -> Callable[[Array], Array]:
    from scipy.interpolate import CubicSpline

    kept = np.concatenate([[True], np.diff(times) > 0.0])
    spline = CubicSpline(times[kept], x[:, kept], axis=1)
    return lambda t: spline(t)


def _controls(times: Array, u: Array) -> Callable[[Array], Array]:
    """Interpolate controls by straight lines between nodes, and extrapolate the first and the last of them."""

    def at(t: Array) -> Array:
        k = np.clip(np.searchsorted(times, t) - 1, 0, len(times) - 2)
        fraction = (t - times[k]) / (times[k + 1] - times[k])
        found: Array = u[:, k] + fraction * (u[:, k + 1] - u[:, k])
        return found

    return at


def _quantities(instance: Instance, times: Array, x: Array, u: Array) -> Array:
    if not instance.model.spec.quantities:
        return np.empty((0, len(times)))
    found: Array = instance.model.quantities_batch(times, x, u, instance.parameters)
    return found


def _peaks(span: Span, signals: Callable[[Array], Array]) -> Array:
    """Return the largest magnitude of each signal, at a node or by a search near the largest one."""
    from scipy.optimize import minimize_scalar

    values = np.abs(signals(span.times))
    found = values.max(axis=1, initial=0.0)
    for k, row in enumerate(values):
        place = int(row.argmax())
        if 0 < place < len(row) - 1:
            near = span.times[place - 1], span.times[place + 1]
            best = minimize_scalar(
                lambda t, k=k: -float(abs(signals(np.array([t]))[k, 0])),
                bounds=near,
                method="bounded",
                options={"xatol": 1e-9 * near[1]},
            )
            found[k] = max(found[k], -best.fun)
    return found


def _integral(span: Span, function: Callable[[Array], Array]) -> Array:
    """Integrate a function over a span by Gauss's rule between its nodes, joined by the zeros of the controls."""
    nodes = np.unique(np.concatenate([span.times, _zeros(span)]))
    places, weights = np.polynomial.legendre.leggauss(POINTS)
    half = np.diff(nodes) / 2.0
    at = (nodes[:-1] + half)[:, None] + half[:, None] * places
    values = function(at.ravel()).reshape(-1, *at.shape)
    total: Array = (values * weights * half[:, None]).sum(axis=(1, 2))
    return total


def _zeros(span: Span) -> list[float]:
    """Return the times at which a control changes its sign."""
    from scipy.optimize import brentq

    u = span.u(span.times)
    found = []
    for row, values in enumerate(u):
        for k in np.flatnonzero(values[:-1] * values[1:] < 0.0):
            found.append(
                brentq(lambda t, r=row: float(span.u(np.array([t]))[r, 0]), *span.times[k : k + 2], xtol=1e-13)
            )
    return found


SETTLING_BAND = 0.02
"""Fraction of the step below which the error has to stay for the motion to count as settled."""


def performance(
    times: Array, x: Callable[[Array], Array], follows: int, before: float, command: float
) -> dict[str, float]:
    """Measure when a state first reaches its command, its overshoot, and when it has settled.

    Parameters
    ----------
    times
        Nodes, shape (M,).
    x
        States (n, K) at times, shape (K,).
    follows
        Place of the state.
    before, command
        Values of the state before the step, and commanded after it.
    """
    from scipy.optimize import minimize_scalar

    step = command - before
    if not step:
        return {}

    def fraction(t: Array) -> Array:
        found: Array = (x(t)[follows] - before) / step
        return found

    def at_time(t: float) -> float:
        return float(fraction(np.array([t]))[0])

    at = fraction(times)
    reached, off = np.flatnonzero(at >= 1.0), np.flatnonzero(np.abs(at - 1.0) > SETTLING_BAND)
    top, after = int(at.argmax()), int(off[-1]) + 1 if len(off) else 0
    highest = float(at.max())
    if 0 < top < len(at) - 1:
        near = times[top - 1], times[top + 1]
        found = minimize_scalar(lambda t: -at_time(t), bounds=near, method="bounded", options={"xatol": 1e-9 * near[1]})
        highest = max(highest, -float(found.fun))
    first = _crossing(times, lambda t: at_time(t) - 1.0, int(reached[0])) if len(reached) else math.nan
    settled = _crossing(times, lambda t: abs(at_time(t) - 1.0) - SETTLING_BAND, after) if after < len(at) else math.nan
    return {"first_reached": first, "settling_time": settled, "overshoot": max(highest - 1.0, 0.0)}


def _crossing(times: Array, value: Callable[[float], float], after: int) -> float:
    """Return the time at which a function changes its sign just before a node, measured from the first node."""
    from scipy.optimize import brentq

    if after == 0:
        return 0.0
    a, b = times[after - 1], times[after]
    if value(a) * value(b) > 0.0:  # it only just reaches the node
        return float(b - times[0])
    return float(brentq(value, a, b, xtol=1e-12 * max(abs(b), 1.0)) - times[0])
