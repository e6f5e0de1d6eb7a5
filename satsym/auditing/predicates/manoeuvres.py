"""Claims that compare manoeuvres of the pitch axis: impulse, time, energy, sensors, and what the panels feel."""

from __future__ import annotations

import numpy as np

from satsym.auditing import quantities
from satsym.auditing.predicates import Finding, Question, exact, predicate
from satsym.auditing.predicates.pitch_axis import (
    Array,
    Flight,
    classical,
    derived,
    gentle,
    largest_torques,
    least_time,
    numbers,
    switched,
)

_SAME = 1e-8
_BAND = 0.02
_PHASES = np.linspace(4.0, 200.0, 800)
"""Frequencies of a panel times the duration of the manoeuvre."""


def _spent(flight: Flight, inertia: float) -> Array:
    """The impulse spent up to each time: how much the rate has gone up and down, times the inertia."""
    return np.concatenate([[0.0], np.cumsum(np.abs(np.diff(flight.rate)))]) * inertia


@predicate
def smaller_impulse(row: Question) -> Finding:
    """Whether the law of least time spends less impulse than the classical one, with both largest torques."""
    values = numbers(row)
    after = classical(values)
    sudden = derived("pitch_classical:control_response.impulse", values)
    spent = sudden + _spent(after, values["I_y"])
    whole, in_time = float(spent[-1]), float(np.interp(values["transition"], after.times, spent))
    switching = {
        name: float(_spent(switched(values, torque), values["I_y"])[-1])
        for name, torque in largest_torques(values).items()
    }
    return Finding(
        all(value < whole for value in switching.values()),
        f"{whole:.4f} N m s by the classical law, of which {sudden:.4f} at the step and {in_time:.4f} within the "
        "printed time; "
        + " and ".join(f"{value:.4f} N m s with the torque {name}" for name, value in switching.items())
        + " by switching",
        {"classical": whole, "classical, impulse left out": whole - sudden, "classical, in the printed time": in_time}
        | {f"switching, torque {name}": value for name, value in switching.items()},
    )


@predicate
def faster(row: Question) -> Finding:
    """Whether least time is less than the classical law takes; unsound if not less than what is printed of that."""
    values = numbers(row)
    flight = classical(values)
    off = np.abs(flight.angle / values["P_c"] - 1.0) > _BAND
    settled = float(flight.times[np.flatnonzero(off)[-1]])
    times = {name: least_time(values, torque) for name, torque in largest_torques(values).items()}
    slowest, printed = max(times.values()), values["transition"]
    return Finding(
        slowest < settled,
        f"{settled:.0f} s until the classical law keeps within {100.0 * _BAND:g} %; "
        + " and ".join(f"{time:.1f} s with the torque {name}" for name, time in times.items())
        + " by switching",
        {"classical, s": settled} | {f"switching, torque {name}, s": time for name, time in times.items()},
        sound=slowest < printed,
        remark=""
        if slowest < printed
        else f"the document counts {printed:g} s for the classical law, and in that time neither torque is faster",
    )


@predicate
def least_of_both(row: Question) -> Finding:
    """Whether one control makes both the time and the energy least: heat of the motor, in the same time and in more."""
    heats = _heats(row)
    return Finding(
        heats["switching"] <= min(heats.values()) * (1.0 + _SAME),
        f"what heats the motor is {heats['switching'] / heats['least energy, same time']:.4g} times as much by "
        f"switching as by the law of least energy in the same time, and that needs "
        f"{heats['least energy, twice the time'] / heats['least energy, same time']:.3g} of it in twice the time",
        {f"integral of the torque squared, {name}": value for name, value in heats.items()},
        remark="time and energy are two problems, which the document itself solves by two laws",
    )


@predicate
def energy_law_better(row: Question) -> Finding:
    """Whether the law of least energy takes less energy than that of least time, in the same time."""
    heats = _heats(row)
    ratio = heats["least energy, same time"] / heats["switching"]
    return Finding(ratio < 1.0, f"it heats the motor {ratio:.4g} times as much in the same time", {"ratio": ratio})


def _heats(row: Question) -> dict[str, float]:
    """Integral of the torque squared; what the back-EMF takes comes to nothing between two states of rest."""
    values = numbers(row)
    time = values["transition"]
    torque = largest_torques(values)["for the printed time"]
    flights = {
        "switching": switched(values, torque),
        "least energy, same time": gentle(values, time),
        "least energy, twice the time": gentle(values, 2.0 * time),
    }
    return {name: _heat(flight, values["I_y"]) for name, flight in flights.items()}


def _heat(flight: Flight, inertia: float) -> float:
    lengths = np.diff(flight.times)
    kept = lengths > 0.0
    pushes = np.diff(flight.rate)[kept] / lengths[kept] * inertia
    return float((pushes**2 * lengths[kept]).sum())


@predicate
def wave_arrives(row: Question, rate: str) -> Finding:
    """Whether a square wave, as long as the least time from rest, ends at rest at the commanded angle.

    Parameters
    ----------
    rate
        Of the satellite when it begins, which a sensor of position does not tell, as a share of its largest later.
    """
    values, begun = numbers(row), exact.share(rate)
    torque = largest_torques(values)["for the printed time"]
    largest = torque * least_time(values, torque) / 2.0 / values["I_y"]
    flight = switched(values, torque, begun * largest)
    angle, end_rate, _ = flight.end
    return Finding(
        abs(angle / values["P_c"] - 1.0) < _SAME and abs(end_rate) < _SAME * largest,
        f"it ends at {angle / values['P_c']:.6g} of the command with {end_rate / largest:.3g} of its largest rate",
        {"angle in the end, rad": angle, "rate in the end, rad/s": end_rate},
        remark=f"here it began with {begun:g} of that rate, and the wave cannot take that away: when to switch "
        "depends on the rate as well",
    )


@predicate
def never_desaturates(row: Question, torque: str, share: str) -> Finding:
    """Whether a law of control can keep the wheel within its limits for good: under a small constant outer torque.

    By the document's own equation of motion, with the body kept at rest.
    """
    from satsym.symbolic.lookup.library import derivation

    values = numbers(row)
    outside = quantities.in_base_units(torque).value
    held = derivation("pitch_wheel").equation("momenta.angular_momentum").rhs
    slope = next(held.diff(s) for s in held.free_symbols if s.name == "wheel_speed")
    drift = abs(outside / exact.number(slope, values))
    hours = exact.share(share) * values["nominal"] / drift / 3600.0 if drift else float("inf")
    return Finding(
        hours == float("inf"),
        f"the wheel takes up all that outer torques add to the angular momentum: {torque} alone bring it to its limit "
        f"in {hours:.3g} h, by any law that keeps the satellite pointed",
        {"drift of the wheel, rad/s^2": drift, "hours to the limit": hours},
        remark="a law decides what its own manoeuvres leave, not what disturbances add up to",
    )


@predicate
def shakes_least(row: Question) -> Finding:
    """Whether the law of least time leaves panels swinging least: the largest amplitude left, over their frequencies.

    Beside it, in the same time, the law of least energy.
    """
    values = numbers(row)
    torque, time = largest_torques(values)["for the printed time"], values["transition"]
    left = {
        "switching": _left_swinging(switched(values, torque), time),
        "least energy": _left_swinging(gentle(values, time), time),
    }
    ratio = left["switching"] / left["least energy"]
    return Finding(
        ratio <= 1.0,
        f"the swinging left is up to {ratio:.3g} times that after the law of least energy in the same time",
        {f"largest amplitude left, {name}": value for name, value in left.items()},
        remark="least time asks nothing of the panels: its torque jumps by the whole range when it switches",
    )


def _left_swinging(flight: Flight, time: float) -> float:
    """The largest amplitude that a free mode is left with, times the square of its frequency in units of 1/time."""
    lengths = np.diff(flight.times)
    kept = lengths > 0.0
    push, begin = (np.diff(flight.rate)[kept] / lengths[kept]), flight.times[:-1][kept]
    end = flight.times[1:][kept]
    found = 0.0
    for phase in _PHASES:
        w = phase / time
        wave = (np.exp(-1j * w * end) - np.exp(-1j * w * begin)) / (-1j * w)
        found = max(found, abs(complex((push * wave).sum())) * w)
    return float(found)
