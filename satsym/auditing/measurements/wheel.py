"""Manoeuvres of a pitch axis with a reaction wheel: by the classical law, by switching, and with minimum heat.

An instance with a ``[classical]`` table provides the numbers, and motions are simulated with the generated equations. A
motion has times ``t``, ``angle``, ``rate``, ``speed`` of the wheel (deviation from the nominal speed), ``torque``, the
``impulse`` spent so far, its ``duration``, and ``heat``, the integral of the squared torque, which the resistance of
the motor dissipates. The work against the back-EMF is zero between two states of rest.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import sqrt
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.auditing.measurements import motion
from satsym.auditing.propositions.values import Record, Undecided
from satsym.status import BadInput
from satsym.wording import refuse_unknown

_TIGHT = 1e-11
_LAGS = 5000.0
"""Longest simulation of the law with a real differentiator, in time constants of the differentiator."""
_NODES = 1001
_PHASES = np.linspace(4.0, 200.0, 800)
"""Frequencies of a panel times the duration of the manoeuvre, at which its oscillation is computed."""


def valued(formula: Any, instance: str, **more: float) -> float:
    """Return the value of a formula for the numbers of an instance, and further numbers by name."""
    known = _numbers(instance) | more
    letters = {s.name: s for s in formula.free_symbols}
    for name in letters:
        refuse_unknown("the instance gives no numerical value for", name, known)
    return float(formula.xreplace({s: known[name] for name, s in letters.items()}))


@cache
def classical(instance: str, differentiator: float = 0.0) -> Record:
    """Return the motion under the classical law after a step of the command.

    The rate comes from an ideal differentiator, which responds to the step with an impulse, or from one with the given
    time constant.
    """
    from satsym.analysis.classical import law

    case = motion.loaded(instance)
    if case.classical is None or case.tf is None:
        raise BadInput(f"{instance} lacks a table [classical] or a final time")
    until = min(case.tf, case.t0 + _LAGS * differentiator) if differentiator else case.tf
    case = replace(case, tf=until, classical=replace(case.classical, differentiator=differentiator))
    found = law.simulate(case)
    return _recorded(instance, found.times, found.x, found.u[0], law.loop(case).impulse)


def switched(instance: str, torque: float = 0.0, duration: float = 0.0, share: float = 0.0) -> Record:
    """Return the minimum-time motion from rest to rest, under one period of a square wave of torque.

    Either the torque or the duration is given. `share` is the initial rate as a fraction of the largest rate.
    """
    n = _numbers(instance)
    if bool(torque) == bool(duration):
        raise BadInput("give the torque, or the duration")
    push = torque or 4.0 * n["I_y"] * n["P_c"] / duration**2
    half = sqrt(n["I_y"] * n["P_c"] / push)
    return _pushed(instance, [(half, push, push), (half, -push, -push)], share * push * half / n["I_y"])


def gentle(instance: str, duration: float) -> Record:
    """Return the motion of minimum heat from rest to rest in a given time, by the derived law."""
    from satsym.symbolic.lookup import library

    n = _numbers(instance)
    unit = n["I_y"] / duration**2  # the torque that is 1 where that time is
    shared = library.names(("pitch_scaled_energy",), {})
    law = library.at("pitch_scaled_energy:least_effort.from_rest", shared, lambda names: tuple(range(len(names)))).rhs
    first, last = (unit * valued(law, instance, X1_0=-n["P_c"], t_f=1.0, t=end) for end in (0.0, 1.0))
    return _pushed(instance, [(duration, first, last)])


def settled(motion: Record, aim: float, band: float) -> float:
    """Return the time after which the angle of a motion stays within a relative band around its target."""
    off = np.flatnonzero(np.abs(motion.part("angle") / aim - 1.0) > band)
    return float(motion.part("t")[off[-1]]) if len(off) else 0.0


def reached(motion: Record, aim: float) -> float:
    """Return the first time at which the angle of a motion reaches its target, by linear interpolation."""
    t, gap = motion.part("t"), motion.part("angle") - aim
    crossed = np.flatnonzero(gap[1:] * gap[:-1] <= 0.0)
    if not len(crossed):
        raise Undecided("the angle never reaches its target")
    k = int(crossed[0])
    return float(t[k] + (t[k + 1] - t[k]) * gap[k] / (gap[k] - gap[k + 1]))


def swinging(motion: Record) -> float:
    """Return the largest amplitude of panels after a motion over all their frequencies, as an acceleration of the body.

    An impulse at the beginning of the motion is included.
    """
    from scipy.optimize import minimize_scalar

    t, pushes = motion.part("t"), np.diff(motion.part("rate"))
    lengths = np.diff(t)
    kept = lengths > 0.0
    push, begin, end = pushes[kept] / lengths[kept], t[:-1][kept], t[1:][kept]
    kick = float(motion.part("rate")[0]) if motion.part("impulse")[0] > 0.0 else 0.0

    def swing(w: float) -> float:
        wave = (np.exp(-1j * w * end) - np.exp(-1j * w * begin)) / (-1j * w)
        return abs(complex((push * wave).sum()) + kick * complex(np.exp(-1j * w * t[0]))) * w

    frequencies = _PHASES / motion.part("duration")
    found = [swing(w) for w in frequencies]
    peak = int(np.argmax(found))
    around = frequencies[max(peak - 1, 0) : peak + 2][[0, -1]]
    refined = minimize_scalar(lambda w: -swing(w), bounds=around, options={"xatol": 1e-9 * around[1]})
    return max(found[peak], -float(refined.fun))


def crossing_time(shares: list[float], controls: list[float]) -> float:
    """Return the time in which a body of inertia 1 moves the distance 1 from rest to rest.

    `controls` are the forces at the fractions `shares` of the time, linear between them; at a jump the fraction is
    given twice.
    """
    fine = np.unique(np.concatenate([np.linspace(0.0, 1.0, 20001), shares]))
    middle = 0.5 * (fine[1:] + fine[:-1])
    rate = np.concatenate([[0.0], np.cumsum(np.interp(middle, shares, controls) * np.diff(fine))])
    if abs(rate[-1]) > 1e-9:
        raise BadInput(f"the motion must end at rest, but its final rate is {rate[-1]:.3g}")
    return float(((rate[1:] + rate[:-1]) * np.diff(fine) / 2.0).sum()) ** -0.5


@cache
def _numbers(instance: str) -> dict[str, float]:
    case = motion.loaded(instance)
    law = case.classical
    if law is None or law.damping is None:
        raise BadInput(f"{instance} gives no damping in a table [classical]")
    found = {v.symbol: float(p) for v, p in zip(case.model.spec.parameters, case.parameters, strict=True)}
    return {**found, "E": law.damping, "P_c": law.command}


def _pushed(instance: str, pieces: list[tuple[float, float, float]], rate: float = 0.0) -> Record:
    """Return the motion under successive torques, each linear in time, from an initial rate."""
    from scipy.integrate import solve_ivp

    case = motion.loaded(instance)
    times, states, torques = [0.0], np.array([[0.0], [rate], [0.0]]), [0.0]

    def rates(t: float, x: Array, until: float, piece: tuple[float, float, float]) -> Any:
        duration, first, last = piece
        torque = last + (first - last) * (until - t) / duration
        return case.model.dynamics(t, tuple(x), (torque,), case.parameters)

    for piece in pieces:
        t = times[-1] + np.linspace(0.0, piece[0], _NODES)
        done = solve_ivp(
            rates, (t[0], t[-1]), states[:, -1], "DOP853", t, args=(t[-1], piece), rtol=_TIGHT, atol=_TIGHT * 1e-3
        )
        times, states = [*times, *t], np.hstack([states, done.y])
        torques += np.linspace(piece[1], piece[2], _NODES).tolist()
    return _recorded(instance, np.array(times), states, np.array(torques))


def _recorded(instance: str, t: Array, x: Array, pushes: Array, spent: float = 0.0) -> Record:
    """Return a motion as a record of its curves; `spent` is the impulse with which it begins."""
    means = 0.5 * (np.abs(pushes[1:]) + np.abs(pushes[:-1])) * np.diff(t)
    squares = (pushes[1:] ** 2 + pushes[1:] * pushes[:-1] + pushes[:-1] ** 2) / 3.0 * np.diff(t)
    return Record(
        f"a motion of {instance}",
        {
            "t": t, "angle": x[0], "rate": x[1], "speed": x[2], "torque": pushes, "duration": float(t[-1]),
            "impulse": spent + np.concatenate([[0.0], np.cumsum(means)]), "heat": float(squares.sum()),
        },
    )  # fmt: skip
