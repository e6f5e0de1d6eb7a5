"""Motions of linear systems, by integration or by e^(At), and the effect of inputs on them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from satsym.arrays import Array, kept
from satsym.auditing.measurements import linear
from satsym.auditing.measurements.matrices import numeric
from satsym.auditing.propositions.values import Record, numbers

_LATE, _GROWN = 80.0, 1.5
_ENDLESS = 1e100
_SLOWEST = 1e-6
"""Fraction of the largest eigenvalue below which other eigenvalues are attributed to rounding and taken as zero."""
_MOMENTS = 400
STEPS = 4000
_LOST, _DEAD = 1e-9, 1e-3


def motion(of: Any, start: Any, t: float) -> Array:
    """Return the state of x' = A x at time t from an initial state, by integration of all unit vectors at once."""
    return np.asarray(_transition(numbers(linear.system(of).part("A")), t) @ numeric(start))


def trajectory(of: Any, start: Any, until: float) -> Record:
    """Return the motion of x' = A x from an initial state, by e^(At): ``t``, states by name, ``curves``, ``size``."""
    system = linear.system(of)
    advance, path = linear.flow(system, until / STEPS), [np.asarray(numeric(start), dtype=float).ravel()]
    for _ in range(STEPS):
        path.append(advance @ path[-1])
    curves, times = np.array(path).T, np.linspace(0.0, until, STEPS + 1)
    names = system.parts.get("states") or [f"x{k + 1}" for k in range(len(curves))]
    parts = {"t": times, "size": np.linalg.norm(curves, axis=0), "curves": list(curves)}
    return Record(f"the motion of {system.name}", {**parts, **dict(zip(names, curves, strict=True))})


def flow_rate(of: Any, t: float) -> Array:
    """Return the derivative of e^(At) with respect to t, computed from Cauchy's integral around t."""
    from scipy.linalg import expm

    a, points = numbers(linear.system(of).part("A")), np.exp(2j * math.pi * np.arange(16) / 16)
    return np.asarray(np.real(np.mean([expm(a * (t + 0.2 * z)) / (0.2 * z) for z in points], axis=0)))


def limit(values: Sequence[Any]) -> Any:
    """Return the limit of a sequence whose steps are halved from one entry to the next, by Richardson extrapolation."""
    column = [np.asarray(numeric(entry), dtype=float) for entry in values]
    for power in range(1, len(values)):
        column = [(2.0**power * b - a) / (2.0**power - 1.0) for a, b in pairwise(column)]
    return column[0]


def farthest(of: Any, size: float) -> float:
    """Return the largest norm reached by motions that start within `size` of zero.

    Infinite if motions are unbounded.
    """
    largest, bounded = _reach(numbers(linear.system(of).part("A")))
    return size * largest if bounded else math.inf


def remaining(of: Any, size: float) -> float:
    """Return the norm for t -> infinity of motions that start at distance `size` from zero; infinite if unbounded."""
    a = numbers(linear.system(of).part("A"))
    if not _reach(a)[1]:
        return math.inf
    left = max(float(np.linalg.norm(linear.flow(a, t), 2)) for t in _late(a) * np.linspace(1.0, 1.2, 20))
    return 0.0 if left < _LOST else size * left


def stable(of: Any) -> bool:
    """Return whether x' = A x is stable, judged by e^(At) at increasing times."""
    return farthest(of, 1.0) < math.inf


def asymptotically_stable(of: Any) -> bool:
    """Return whether x' = A x is asymptotically stable, judged by e^(At) at increasing times."""
    return remaining(of, 1.0) < _DEAD


def quadrature(start: float, end: float, nodes: int = 24) -> list[list[float]]:
    """Return nodes and weights of Gauss-Legendre quadrature on an interval."""
    places, weights = np.polynomial.legendre.leggauss(nodes)
    half = 0.5 * (end - start)
    return [[float(start + half * (p + 1.0)), float(half * w)] for p, w in zip(places, weights, strict=True)]


def wave(of: Any, t: float) -> Array:
    """Return an arbitrary input at time t, which has no special structure."""
    return np.array([math.cos(3.0 * t + k) + k * t for k in range(linear.system(of).part("B").shape[1])])


def driven(of: Any, t: float) -> Array:
    """Return the state at time t under the input ``wave``, from the zero state, by integration."""
    system = linear.system(of)
    a, b = numbers(system.part("A")), numbers(system.part("B"))
    return _followed(lambda s, x: np.asarray(a @ x + b @ wave(system, s)), np.zeros(len(a)), t)


def least_energy(of: Any, start: Any, t: float) -> float:
    """Return the minimum energy (integral of the squared inputs) that brings a state to zero at time t."""
    x = numeric(start)
    return float(x @ np.linalg.solve(linear.gramian(of, t), x))


def steered_to(of: Any, start: Any, aim: Any) -> Array:
    """Return the state at time 1 under the input of minimum energy that comes as close to a target as possible."""
    a, b = (numbers(linear.system(of).part(name)) for name in "AB")
    moved, pushed, effort = _steering(a, b)
    return np.asarray(moved @ numeric(start) + pushed @ (effort @ (numeric(aim) - moved @ numeric(start))))


def placing_gain(of: Any, coefficients: Sequence[float]) -> Any:
    """Return K such that det(s I - A - B K) has the given coefficients, for a single input, by Ackermann's formula."""
    system = linear.system(of)
    a, b = system.part("A"), system.part("B")
    wanted = sum((a ** (a.rows - k) * c for k, c in enumerate(coefficients)), a * 0)
    last = a.zeros(1, a.rows - 1).row_join(a.eye(1))
    return -last * linear.controllability(Record("", {"A": a, "B": b})).inv() * wanted


def stabilising_gain(of: Any) -> Array:
    """Return K such that A + B K stabilises the controllable part of the system, by the equation of Bass."""
    from scipy.linalg import solve_continuous_lyapunov

    system = linear.system(of)
    a, b = numbers(system.part("A")), numbers(system.part("B"))
    shift = 1.0 + float(np.linalg.norm(a, 2))
    weight = solve_continuous_lyapunov(a + shift * np.eye(len(a)), 2.0 * b @ b.T)
    return np.asarray(-b.T @ np.linalg.pinv(weight, rcond=1e-10, hermitian=True))


def _followed(rates: Callable[[float, Array], Array], start: Any, t: float) -> Array:
    from scipy.integrate import solve_ivp

    begin = np.asarray(numeric(start), dtype=float).ravel()
    found = solve_ivp(rates, (0.0, t), begin, rtol=1e-11, atol=1e-12, method="DOP853")
    return np.asarray(found.y[:, -1])


@kept
def _steering(a: Array, b: Array) -> tuple[Array, Array, Array]:
    """Return the transition matrix to time 1, the matrix M, and its pseudo-inverse.

    The inputs B' e^(-A's) d displace the state at time 1 by M d.
    """
    n = len(a)

    def rates(s: float, x: Array) -> Array:
        both = x.reshape(n, 2 * n)
        return np.asarray((a @ both + np.hstack([np.zeros((n, n)), b @ b.T @ linear.flow(-a.T, s)])).ravel())

    whole = _followed(rates, np.hstack([np.eye(n), np.zeros((n, n))]), 1.0).reshape(n, 2 * n)
    return whole[:, :n], whole[:, n:], np.linalg.pinv(whole[:, n:], rcond=1e-9)


@kept
def _transition(a: Array, t: float) -> Array:
    return _followed(lambda _, x: np.asarray((a @ x.reshape(a.shape)).ravel()), np.eye(len(a)), t).reshape(a.shape)


def _late(a: Array) -> float:
    """Return a time after which the slowest mode has shown whether it grows or decays."""
    found = np.linalg.eigvals(a)
    rates = np.abs([found, found.real])
    telling = rates[rates > _SLOWEST * np.abs(found).max(initial=0.0)]
    return _LATE / float(telling.min(initial=np.linalg.norm(a, 2) or 1.0))


@kept
def _reach(a: Array) -> tuple[float, bool]:
    """Return the largest norm of e^(At) that was found, and whether e^(At) is bounded."""
    moved, sizes = np.eye(len(a)), []
    with np.errstate(over="ignore", invalid="ignore"):
        step = linear.flow(a, _late(a) / _MOMENTS)
        for _ in range(_MOMENTS):
            if not np.abs(moved).max() <= _ENDLESS:
                return math.inf, False
            sizes.append(float(np.linalg.norm(moved, 2)))
            moved = step @ moved
    early = max(sizes[: _MOMENTS // 2])
    return max(sizes), max(sizes[_MOMENTS // 2 :]) <= _GROWN * early
