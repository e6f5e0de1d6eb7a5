"""Manoeuvres of a pitch axis with a reaction wheel: by the classical law, by switching, and with the least heat.

An instance with a ``[classical]`` table gives the numbers. Motions are simulated with the generated equations; one has
its times ``t``, ``angle``, ``rate``, wheel ``speed`` (the deviation from the nominal one), ``torque``, the ``impulse``
spent by then, its ``duration``, and the ``heat``: the integral of the torque squared, as the motor's resistance makes
it. What its back-EMF takes comes to nothing between two states of rest.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import sqrt
from typing import Any, TypeAlias

import numpy as np

from satsym.arrays import Array
from satsym.auditing.measurements import measurement, motion
from satsym.auditing.propositions.values import Record
from satsym.status import BadInput
from satsym.wording import shown, suggestion

Torque: TypeAlias = Callable[[float, Array], float]
_TIGHT = 1e-11
_LONG = 32.0
"""How long the classical law is followed, in units of 1/E."""
_NODES = 1001
_PHASES = np.linspace(4.0, 200.0, 800)
"""Frequencies of a panel times the duration of the manoeuvre."""


@measurement
def valued(formula: Any, instance: str, **more: float) -> float:
    """The value of a formula with the numbers of an instance, and others by name."""
    known = _numbers(instance) | more
    letters = {s.name: s for s in formula.free_symbols}
    for name in letters:
        if name not in known:
            raise BadInput(f"no number for {shown(name)}; {suggestion(name, known)}")
    return float(formula.xreplace({s: known[name] for name, s in letters.items()}))


@measurement
@cache
def classical(instance: str, differentiator: float = 0.0) -> Record:
    """The motion under the classical law after a step of the command.

    Its rate is that of an ideal differentiator, which answers the step with an impulse, or of one with a time constant.
    """
    n = _numbers(instance)
    e, command = n["E"], n["P_c"]
    k1, k2 = (_derived(f"pitch_classical:critical_damping.{name}", n) for name in ("K1", "K2"))
    long = _LONG / e
    if differentiator:

        def filtered(_: float, x: Array) -> float:
            return float(k2 * (command - x[0]) + k1 * (command - x[0] - x[3]) / differentiator)

        quick = 40.0 * differentiator
        pieces: list[tuple[float, Torque]] = [(quick, filtered), (long - quick, filtered)]
        return _simulated(instance, pieces, np.zeros(4), lambda x: (command - x[0] - x[3]) / differentiator)

    def law(_: float, x: Array) -> float:
        return float(k2 * (command - x[0]) - k1 * x[1])

    impulse = _derived("pitch_classical:control_response.impulse", n)  # the rate of a step
    start = np.array([0.0, impulse / n["I_y"], impulse / n["I_wy"]])
    return _simulated(instance, [(5.0 / e, law), (long - 5.0 / e, law)], start, spent=impulse)


@measurement
def switched(instance: str, torque: float = 0.0, duration: float = 0.0, share: float = 0.0) -> Record:
    """A square wave of torque of one period: the motion of least time from rest to rest, with that torque or duration.

    It may begin with a share of the largest rate that it has from rest.
    """
    n = _numbers(instance)
    if bool(torque) == bool(duration):
        raise BadInput("give the torque, or the duration")
    push = torque or 4.0 * n["I_y"] * n["P_c"] / duration**2
    half = sqrt(n["I_y"] * n["P_c"] / push)
    start = np.array([0.0, share * push * half / n["I_y"], 0.0])
    return _simulated(instance, [(half, lambda t, x: push), (half, lambda t, x: -push)], start)


@measurement
def gentle(instance: str, duration: float) -> Record:
    """The motion of least heat from rest to rest in some time, by the derived law."""
    n = _numbers(instance)
    unit = n["I_y"] / duration**2  # the torque that is 1 where that time is
    first, last = (
        unit * _derived("pitch_scaled_energy:least_effort.from_rest", {"X1_0": -n["P_c"], "t_f": 1.0, "t": end})
        for end in (0.0, 1.0)
    )
    return _simulated(instance, [(duration, lambda t, x: first + (last - first) * t / duration)], np.zeros(3))


@measurement
def settled(motion: Record, aim: float, band: float) -> float:
    """When a motion's angle is within a share of its aim for good."""
    off = np.flatnonzero(np.abs(motion.part("angle") / aim - 1.0) > band)
    return float(motion.part("t")[off[-1]]) if len(off) else 0.0


@measurement
def swinging(motion: Record) -> float:
    """How far panels swing after a motion, at most over their frequencies, as an acceleration of the body."""
    t, pushes = motion.part("t"), np.diff(motion.part("rate"))
    lengths = np.diff(t)
    kept = lengths > 0.0
    push, begin, end = pushes[kept] / lengths[kept], t[:-1][kept], t[1:][kept]
    largest = 0.0
    for w in _PHASES / motion.part("duration"):
        wave = (np.exp(-1j * w * end) - np.exp(-1j * w * begin)) / (-1j * w)
        largest = max(largest, abs(complex((push * wave).sum())) * w)
    return float(largest)


@measurement
def crossing_time(shares: list[float], controls: list[float]) -> float:
    """How long a body of inertia 1 takes over the distance 1 from rest to rest, under forces at shares of the time.

    They are straight between; one that jumps is given twice at that share.
    """
    fine = np.unique(np.concatenate([np.linspace(0.0, 1.0, 20001), shares]))
    middle = 0.5 * (fine[1:] + fine[:-1])
    rate = np.concatenate([[0.0], np.cumsum(np.interp(middle, shares, controls) * np.diff(fine))])
    if abs(rate[-1]) > 1e-9:
        raise BadInput(f"it ends with the rate {rate[-1]:.3g}, and not at rest")
    return float(((rate[1:] + rate[:-1]) * np.diff(fine) / 2.0).sum()) ** -0.5


@cache
def _numbers(instance: str) -> dict[str, float]:
    case = motion.loaded(instance)
    law = case.classical
    if law is None or law.damping is None:
        raise BadInput(f"{instance} has no damping in a table [classical]")
    found = {v.symbol: float(p) for v, p in zip(case.model.spec.parameters, case.parameters, strict=True)}
    return {**found, "E": law.damping, "P_c": law.command}


def _derived(address: str, numbers: dict[str, float]) -> float:
    """A derived expression at numbers for its letters."""
    from satsym.symbolic.lookup.library import derivation

    name, _, where = address.partition(":")
    found = derivation(name).equation(where).rhs
    return float(found.xreplace({s: numbers[s.name] for s in found.free_symbols}))


def _simulated(
    instance: str,
    pieces: list[tuple[float, Torque]],
    start: Array,
    further: Callable[[Array], float] | None = None,
    spent: float = 0.0,
) -> Record:
    """The motion under torques one after the other, each for its time, from angle, rate and wheel speed.

    ``further`` is the rate of a further state, ``spent`` the impulse with which it begins.
    """
    from scipy.integrate import solve_ivp

    case = motion.loaded(instance)
    times, columns, torques, begin, state = [], [], [], 0.0, start
    for duration, torque in pieces:

        def rates(t: float, x: Array, torque: Torque = torque) -> list[float]:
            moved = list(case.model.dynamics(t, tuple(x[:3]), (torque(t, x),), case.parameters))
            return [*moved, further(x)] if further else moved

        t = np.linspace(begin, begin + duration, _NODES)
        method = "LSODA" if further else "DOP853"
        done = solve_ivp(rates, (begin, begin + duration), state, method, t, rtol=_TIGHT, atol=_TIGHT * 1e-3)
        times.append(t)
        columns.append(done.y)
        torques.append(np.array([torque(s, x) for s, x in zip(t, done.y.T, strict=True)]))
        begin, state = begin + duration, done.y[:, -1]
    t, x, pushes = np.concatenate(times), np.hstack(columns), np.concatenate(torques)
    means = 0.5 * (np.abs(pushes[1:]) + np.abs(pushes[:-1])) * np.diff(t)
    squares = (pushes[1:] ** 2 + pushes[1:] * pushes[:-1] + pushes[:-1] ** 2) / 3.0 * np.diff(t)
    return Record(
        f"a motion of {instance}",
        {
            "t": t, "angle": x[0], "rate": x[1], "speed": x[2], "torque": pushes, "duration": begin,
            "impulse": spent + np.concatenate([[0.0], np.cumsum(means)]), "heat": float(squares.sum()),
        },
    )  # fmt: skip
