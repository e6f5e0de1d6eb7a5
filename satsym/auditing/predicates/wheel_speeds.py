"""Claims about the classical law of the pitch axis and about the wheel's speed, held against flown motions."""

from __future__ import annotations

import numpy as np

from satsym.auditing import quantities
from satsym.auditing.predicates import Finding, Question, exact, predicate
from satsym.auditing.predicates.pitch_axis import Flight, classical, derived, gentle, largest_torques, numbers, switched
from satsym.status import BadInput
from satsym.wording import shown, suggestion

_AT_REST = 1e-8
"""What is left, as a share of the largest, where a motion has come to rest."""
_LONG = 32.0
"""How long a motion is followed, in units of 1/E."""
_FILTERS = (1.0, 0.1)
"""Time constants of the differentiator, s."""
_LAWS = ("classical", "minimum time", "minimum energy")


def _flown(law: str, values: dict[str, float]) -> dict[str, Flight]:
    if law == "minimum time":
        return {name: switched(values, torque) for name, torque in largest_torques(values).items()}
    if law == "minimum energy":
        return {"in the printed time": gentle(values, values["transition"])}
    if law == "classical":
        return {"ideal": classical(values)} | {
            f"differentiator filtered with {f:g} s": classical(values, f) for f in _FILTERS
        }
    raise BadInput(f"no law {shown(law)}; {suggestion(law, _LAWS)}")


@predicate
def wheel_returns(row: Question, law: str, printed: bool) -> Finding:
    """Whether the wheel is back at its nominal speed once the satellite has come to rest, as is printed or denied."""
    values = numbers(row)
    flights = _flown(law, values)
    moved = {name: float(np.abs(flight.speed).max()) for name, flight in flights.items()}
    left = {name: flight.end[2] for name, flight in flights.items()}
    back = all(abs(left[name]) < _AT_REST * moved[name] for name in flights)
    evidence: dict[str, float | int | bool | str] = {}
    for name in flights:
        evidence |= {f"largest deviation, {name}, rad/s": moved[name], f"in the end, {name}, rad/s": left[name]}
    if law == "classical":
        evidence["in the end, closed form"] = derived("pitch_classical:extremes.final_wheel_speed", values)
    worst = max(moved.values())
    return Finding(
        back == printed,
        f"it deviates by up to {worst:.3g} rad/s, {100.0 * worst / values['nominal']:.2g} % of its nominal "
        f"speed, and is back when the satellite rests (but for {max(map(abs, left.values())):.0e} rad/s)",
        evidence,
        remark=""
        if back == printed
        else "I_y times the rate of the body less I_wy times the deviation of the wheel is constant without other "
        "torques, by the document's own equation of motion: whatever the law, a body at rest again has its wheel at "
        "its nominal speed again",
    )


@predicate
def wheel_stays(row: Question, law: str, share: str) -> Finding:
    """Whether the wheel's speed stays within a share of its nominal one."""
    values = numbers(row)
    worst = max(float(np.abs(flight.speed).max()) for flight in _flown(law, values).values())
    limit = exact.share(share) * values["nominal"]
    return Finding(
        worst <= limit, f"it deviates by up to {worst:.3g} rad/s of {limit:.3g} rad/s", {"largest deviation": worst}
    )


@predicate
def critically_damped() -> Finding:
    """Whether the derived gains make both poles equal and negative."""
    values = {"E": 0.3, "I_y": 2.0}
    values |= {name: derived(f"pitch_classical:critical_damping.{name}", values) for name in ("K1", "K2")}
    poles = [derived(f"pitch_classical:poles_and_zeros.pole_{k}", values) for k in (1, 2)]
    beyond = derived("pitch_classical:extremes.overshoot", values)
    return Finding(
        max(abs(p + values["E"]) for p in poles) < 1e-7,
        f"both poles lie at -E; the zero at -E/2 still takes the angle {100.0 * beyond:.3g} % beyond the command",
        {"overshoot": beyond},
        "satsym derive pitch_wheel",
    )


@predicate
def settled_by(row: Question, printed: str, band: str) -> Finding:
    """Whether the classical law has brought the satellite to the commanded angle, within a band, and keeps it there."""
    values = numbers(row)
    until, step = quantities.in_base_units(printed).value, values["P_c"]
    flight = classical(values)
    off = np.abs(flight.angle / step - 1.0) > exact.share(band)
    settled = float(flight.times[np.flatnonzero(off)[-1]])
    first = derived("pitch_classical:extremes.first_reached", values)
    beyond, highest = (derived(f"pitch_classical:extremes.{name}", values) for name in ("overshoot", "highest_at"))
    rate = float(np.interp(first, flight.times, flight.rate))
    return Finding(
        settled <= until,
        f"after {first:.4g} s it passes the command at {rate:.2g} rad/s, is {100.0 * beyond:.3g} % beyond it after "
        f"{highest:.4g} s, and stays within {100.0 * exact.share(band):g} % from about {settled:.0f} s on",
        {"first at the command, s": first, "overshoot": beyond, "settled, s": settled},
        "satsym simulate lapan-classical",
        remark="what is printed is when the angle first equals the command, not when the manoeuvre is over",
    )


@predicate
def largest_torque(row: Question) -> Finding:
    """Whether a printed formula is the largest torque of the classical law, whose differentiator sees a step."""
    values = numbers(row)
    formula = exact.expression(str(row.printed))
    said = exact.number(formula, values)
    k1 = derived("pitch_classical:critical_damping.K1", values)
    k2 = derived("pitch_classical:critical_damping.K2", values)
    start = {f: (k2 + k1 / f) * values["P_c"] for f in _FILTERS}  # nothing has moved yet
    flown = {f: _push(values, classical(values, f)) for f in _FILTERS}
    largest = {f: max(start[f], flown[f]) for f in _FILTERS}
    impulse = derived("pitch_classical:control_response.impulse", values)
    return Finding(
        all(value <= said * (1.0 + 1e-9) for value in largest.values()),
        f"before it comes an impulse of {impulse:.3g} N m s; with a differentiator that needs "
        + " or ".join(f"{f:g} s the largest torque is {value:.3g} N m" for f, value in largest.items())
        + f", against {said:.3g} N m",
        {f"largest torque, filter of {f:g} s": value for f, value in largest.items()} | {"printed": said},
        "satsym simulate lapan-classical",
        remark="the formula is what is left just after the impulse -2 delta(t), which (13) itself has",
    )


def _push(values: dict[str, float], flight: Flight) -> float:
    """The largest torque of a flight, from how fast the rate changes between its nodes."""
    steps = np.diff(flight.times) > 0.0
    return float(np.abs(np.diff(flight.rate)[steps] / np.diff(flight.times)[steps]).max()) * values["I_y"]


@predicate
def is_integral(row: Question, rate: str, speed: str) -> Finding:
    """Whether one printed function of time is the integral of another, its impulse at time zero included, from zero.

    Parameters
    ----------
    rate, speed
        Keys of rows; the impulse is written ``delta`` in the first.
    """
    slope, whole = (exact.expression(str(row.document[key])) for key in (rate, speed))
    place = exact.letters(slope, whole, needed=("delta", "t"))
    smooth, impulse = slope.xreplace({place["delta"]: 0}), slope.diff(place["delta"])
    same_rate = exact.same(whole.diff(place["t"]), smooth)
    first = whole.xreplace({place["t"]: 0 * place["t"]})
    same_start = exact.same(first, impulse)
    values = numbers(row)
    off = [exact.number(e, values | {"t": 1.0 / values["E"]}) for e in (whole.diff(place["t"]), smooth)]
    begun = [exact.number(e, values) for e in (first, impulse)]
    summed = begun[1] + _summed(smooth, values)
    return Finding(
        same_rate and same_start,
        f"after 1/E its rate is {off[0]:.3g} rad/s^2, where (13) has {off[1]:.3g}; it begins with "
        f"{begun[0]:.3g} rad/s, where the impulse leaves {begun[1]:.3g}; the integral ends at {summed:.0e} rad/s",
        {"rate agrees": same_rate, "start agrees": same_start, "integral of (13) to the end, rad/s": summed},
        remark="a sign is lost in integrating t e^(-Et), and the impulse is left out: with both, the wheel ends where "
        "it began",
    )


def _summed(found: exact.Expression, values: dict[str, float]) -> float:
    """An integral over time, by quadrature."""
    from scipy.integrate import quad

    end = _LONG / values["E"]
    return float(quad(lambda t: exact.number(found, values | {"t": t}), 0.0, end, epsabs=1e-12, points=[0.1 * end])[0])
