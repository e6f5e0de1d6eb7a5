"""Initial guesses for direct collocation, of every kind that is known to lead to different minima."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from itertools import product

import numpy as np
from scipy.integrate import solve_ivp

from tests.bench.truth.case import Case
from tests.bench.truth.collocate import Start
from tests.bench.truth.physics import MODELS

Path = Callable[[np.ndarray], np.ndarray]
BENDS = ((1, 0.0), (1, -0.3), (1, -0.6), (1, 0.3), (1, 0.6), (2, -0.4), (2, 0.4), (1, 0.9))
TURN = 2.0 * math.pi


def starts(case: Case) -> list[Start]:
    """All of them, for the model of the case."""
    if case.model.startswith(("polar", "return")):
        return _polar(case)
    if case.model.startswith("transfer"):
        return _spirals(case)
    return _around(case)


def _polar(case: Case) -> list[Start]:
    shifts = [TURN * k for k in (-1, 0, 1, 2)] if case.free_angles else [0.0]
    bends = BENDS[:3] if case.free_angles else BENDS
    corners = _corners(case) if case.bounds and not case.final else []
    if case.tf is not None:
        return corners + [
            Start(case.tf - case.t0, _bent(case, case.tf, shift, waves, bend), shift)
            for shift in shifts
            for waves, bend in bends
        ]
    durations = (0.8, 2.0, 4.0, 6.5) if case.bounds else (0.7, 1.5, 3.0, 4.5, 6.5, 9.0)
    return [Start(T, _bent(case, case.t0 + T, 0.0, 1, bend)) for T in durations for bend in (0.0, 0.3)]


def _corners(case: Case) -> list[Start]:
    """Motions under full thrust all the way, to which negative weights of a free end may lead."""
    physics, start = MODELS[case.model], [case.initial[name] for name in MODELS[case.model].states]
    p = physics.given(case.parameters)
    duration = 3.0 if case.tf is None else case.tf - case.t0
    found = []
    for u in product(*(case.bounds.get(name, (0.0, 0.0)) for name in physics.controls)):
        with np.errstate(all="ignore"):
            motion = solve_ivp(
                lambda t, x, u=u: physics.rate(math, t, x, u, p), (0.0, duration), start, dense_output=True, rtol=1e-6
            )
        if motion.success and np.isfinite(motion.y).all():
            found.append(Start(duration, partial(_along, motion.sol, duration)))
    return found


def _along(motion: Callable[[np.ndarray], np.ndarray], duration: float, tau: np.ndarray) -> np.ndarray:
    return motion(tau * duration)


def _bent(case: Case, tf: float, shift: float, waves: int, bend: float) -> Path:
    """A straight line in all states, its radius bent."""
    physics = MODELS[case.model]
    p = physics.given(case.parameters)
    ends, reference = [], physics.reference(math, tf, p)
    mean = case.initial["theta_dot"]
    for i, name in enumerate(physics.states):
        value = case.final.get(name)
        if value is None:
            ends.append(case.initial[name] + (mean * (tf - case.t0) if name == "theta" else 0.0))
        elif isinstance(value, str):
            ends.append(reference[i])
        else:
            ends.append(value + (shift if name in case.free_angles else 0.0))
    return partial(_line, np.array([case.initial[name] for name in physics.states]), np.array(ends), waves, bend)


def _line(x0: np.ndarray, xf: np.ndarray, waves: int, bend: float, tau: np.ndarray) -> np.ndarray:
    states = x0[:, None] + (xf - x0)[:, None] * tau
    states[0] *= np.exp(bend * np.sin(waves * math.pi * tau))
    return states


def _spirals(case: Case) -> list[Start]:
    """Plane spirals of some revolutions either way, in the plane of the initial motion, and the straight line."""
    assert case.tf is not None
    k = 3 if case.model == "transfer_space" else 2
    T = case.tf - case.t0
    names = MODELS[case.model].states
    x0 = np.array([case.initial[name] for name in names])
    xf = np.array([float(case.final[name]) for name in names])
    found = [Start(T, partial(_line, x0, xf, 1, 0.0))]
    for turns in (-1, 0, 1, 2, 3):
        found.append(Start(T, partial(_spiral, x0, xf, k, turns, T, 0.0)))
    found += [Start(T, partial(_spiral, x0, xf, k, turns, T, 0.4)) for turns in (0, 1, 2)]
    return found


def _spiral(x0: np.ndarray, xf: np.ndarray, k: int, turns: int, T: float, bend: float, tau: np.ndarray) -> np.ndarray:
    a, b = x0[:k], xf[:k]
    first, last = math.atan2(a[1], a[0]), math.atan2(b[1], b[0])
    angle = first + ((last - first) % TURN + TURN * turns) * tau
    radii = np.linalg.norm(a[:2]), np.linalg.norm(b[:2])
    radius = (radii[0] + (radii[1] - radii[0]) * tau) * np.exp(bend * np.sin(math.pi * tau))
    place = np.vstack([radius * np.cos(angle), radius * np.sin(angle)])
    if k == 3:
        place = np.vstack([place, a[2] + (b[2] - a[2]) * tau])
    rate = np.gradient(place, tau * T, axis=1)
    return np.vstack([place, rate])


def _around(case: Case) -> list[Start]:
    """Straight ahead, and bent to either side; ends that are free at both sides of zero."""
    names = MODELS[case.model].states
    T = (case.tf if case.tf is not None else case.t0 + 3.0) - case.t0
    x0 = np.array([case.initial[name] for name in names])
    found = []
    for bend in (0.0, 0.3, -0.3, 1.0, -1.0, 0.05, -0.05, 2.0, -2.0):
        ends = np.array([float(case.final.get(name, x0[i] + 2.0 * bend)) for i, name in enumerate(names)])
        found.append(Start(T, partial(_sideways, x0, ends, bend)))
    return found


def _sideways(x0: np.ndarray, xf: np.ndarray, bend: float, tau: np.ndarray) -> np.ndarray:
    states = x0[:, None] + (xf - x0)[:, None] * tau
    across = np.array([-(xf - x0)[1], (xf - x0)[0]]) if len(x0) > 1 else np.zeros(1)
    states[: len(across)] += bend * across[:, None] / 2.0 * np.sin(math.pi * tau)
    return states
