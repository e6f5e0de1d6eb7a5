"""The pitch axis with a document's numbers, flown with the generated equations of motion; no predicates here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from math import sqrt

import numpy as np

from satsym import kernels
from satsym.arrays import Array
from satsym.auditing import quantities
from satsym.auditing.predicates import Question, Told, exact

Numbers = Mapping[str, float]

_TIGHT = 1e-11
_LONG = 32.0
"""How long the classical law is followed, in units of 1/E."""
_NODES = 1001
_MODEL = "pitch_wheel"
_STATED = "number in [inputs]"


@dataclass(frozen=True)
class Flight:
    """A motion under a torque: at each time the angle, its rate and the wheel's speed, rad and rad/s."""

    times: Array
    angle: Array
    rate: Array
    speed: Array

    @property
    def end(self) -> tuple[float, float, float]:
        """Where it comes to."""
        return float(self.angle[-1]), float(self.rate[-1]), float(self.speed[-1])


def numbers(row: Question) -> dict[str, float]:
    """The document's numbers in base units, by the names that derivations have for them."""
    stated = {name: quantities.in_base_units(text).value for name, text in row.inputs.items()}
    return Told(_STATED, stated)


def derived(address: str, values: Numbers) -> float:
    """A derived expression at numbers for its symbols."""
    from satsym.symbolic.lookup.library import derivation

    name, _, where = address.partition(":")
    found = derivation(name).equation(where).rhs
    return exact.number(found, values)


def fly(values: Numbers, pieces: list[tuple[float, Callable[[float, Array], float]]], start: Array) -> Flight:
    """Fly torques one after the other, each for its time, from (angle, rate, wheel speed, further states).

    A piece may carry one further state, the last of ``start``, whose rate is the attribute ``rate`` of its torque.
    """
    from scipy.integrate import solve_ivp

    model = kernels.load(_MODEL)
    # what a document does not state, or calls otherwise, are numbers on which the motion does not depend
    p = tuple(float(values.get(v.symbol, v.default or 0.0)) for v in model.spec.parameters)
    times, columns, begin, state = [np.zeros(1)], [start.reshape(-1, 1)], 0.0, start
    for duration, torque in pieces:
        more = getattr(torque, "rate", None)

        def rates(t: float, x: Array, torque=torque, more=more) -> list[float]:  # type: ignore[no-untyped-def]
            moved = list(model.dynamics(t, tuple(x[:3]), (torque(t, x),), p))
            return [*moved, more(t, x)] if more else moved

        found = solve_ivp(
            rates,
            (begin, begin + duration),
            state,
            rtol=_TIGHT,
            atol=_TIGHT * 1e-3,
            method="DOP853" if more is None else "LSODA",
            t_eval=np.linspace(begin, begin + duration, _NODES),
        )
        times.append(found.t)
        columns.append(found.y)
        begin, state = begin + duration, found.y[:, -1]
    whole = np.hstack(columns)
    return Flight(np.concatenate(times), whole[0], whole[1], whole[2])


def classical(values: Numbers, filtered: float = 0.0) -> Flight:
    """The classical law after a step of the command, its differentiator ideal, or filtered with a time constant."""
    return _classical(tuple(sorted(values.items())), filtered)


@cache
def _classical(items: tuple[tuple[str, float], ...], filtered: float) -> Flight:
    values = Told(_STATED, dict(items))
    duration = _LONG / values["E"]
    e, command = values["E"], values["P_c"]
    k1, k2 = (derived(f"pitch_classical:critical_damping.{name}", values) for name in ("K1", "K2"))
    if filtered:

        def torque(t: float, x: Array) -> float:
            return k2 * (command - x[0]) + k1 * (command - x[0] - x[3]) / filtered

        torque.rate = lambda t, x: (command - x[0] - x[3]) / filtered  # type: ignore[attr-defined]
        return fly(values, [(40.0 * filtered, torque), (duration - 40.0 * filtered, torque)], np.zeros(4))

    def law(t: float, x: Array) -> float:
        return float(k2 * (command - x[0]) - k1 * x[1])

    impulse = derived("pitch_classical:control_response.impulse", values)  # the rate of a step
    start = np.array([0.0, impulse / values["I_y"], impulse / values["I_wy"]])
    return fly(values, [(5.0 / e, law), (duration - 5.0 / e, law)], start)


def largest_torques(values: Numbers) -> dict[str, float]:
    """The largest torque as the document may mean it: that of the classical law, or what makes the time as printed."""
    peak = abs(derived("pitch_classical:control_response.initial", values))
    timed = 4.0 * values["I_y"] * values["P_c"] / values["transition"] ** 2
    return {"of the classical law": peak, "for the printed time": timed}


def least_time(values: Numbers, torque: float) -> float:
    """Time from rest to rest under a bounded torque: half of it each way."""
    return 2.0 * sqrt(values["I_y"] * values["P_c"] / torque)


def switched(values: Numbers, torque: float, rate: float = 0.0) -> Flight:
    """The square wave of least time from rest to rest; from another rate, the same wave."""
    half = 0.5 * least_time(values, torque)
    pieces: list[tuple[float, Callable[[float, Array], float]]] = [
        (half, lambda t, x: torque),
        (half, lambda t, x: -torque),
    ]
    return fly(values, pieces, np.array([0.0, rate, 0.0]))


def gentle(values: Numbers, duration: float) -> Flight:
    """From rest to rest in a given time with the derived torque of least energy."""
    unit = values["I_y"] / duration**2  # the torque that is 1 where that time is
    first, last = (
        unit * derived("pitch_scaled_energy:least_effort.from_rest", {"X1_0": -values["P_c"], "t_f": 1.0, "t": end})
        for end in (0.0, 1.0)
    )
    return fly(values, [(duration, lambda t, x: first + (last - first) * t / duration)], np.zeros(3))
