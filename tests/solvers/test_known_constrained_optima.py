"""Optima with path constraints by routes that have nothing of satsym in them.

Motions by hand, DOP853, and indirect adjoining (Bryson and Ho, 3.11), of which satsym knows nothing: on the boundary
g'' is adjoined with a multiplier m, and costates jump at the entry alone, by multiples of g_x and g'_x.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import root

import satsym
from satsym import instance
from satsym.solvers import solve
from satsym.status import Verdict
from satsym.symbolic import loader

KNOWN = tomllib.loads((Path(__file__).parents[1] / "bench" / "optima.toml").read_text(encoding="utf-8"))
WITHIN = 1e-9
Rates = Callable[[float, Sequence[float]], list[float]]


def check(name: str, optimum: float, events: Sequence[float]) -> None:
    """Ours, which must be the optimum that the test has found, with these events, and that of the table."""
    ours = solve(instance.load(name))
    assert ours.objective == pytest.approx(optimum, rel=WITHIN)
    assert KNOWN[name]["optimum"] == pytest.approx(optimum, rel=WITHIN)
    assert [one.t for one in ours.events] == pytest.approx(list(events), abs=1e-6)
    assert ours.certificate is not None
    assert ours.certificate.verdict is Verdict(KNOWN[name]["verdict"]), ours.certificate


def oscillators() -> tuple[Any, ...]:
    """The problems of the file."""
    return loader.load(Path(__file__).parents[2] / "derivations" / "examples" / "oscillators.py")


def along(rates: Rates, start: float, end: float, z: np.ndarray) -> np.ndarray:
    """Where a motion ends, with its cost."""
    return np.asarray(solve_ivp(rates, (start, end), z, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1])


def shot(misses: Callable[[np.ndarray], np.ndarray], near: Sequence[float]) -> np.ndarray:
    """Unknowns with which nothing is missed."""
    found = root(misses, near, tol=1e-13)
    assert np.abs(misses(found.x)).max() < 1e-9, found
    return np.asarray(found.x)


def polar(on_floor: bool) -> Rates:
    """States and costates of a satellite about mu = 1, with the cost; where r'' = 0 is kept on the floor."""

    def rates(t: float, z: Sequence[float]) -> list[float]:
        r, w, _, o, lr, lw, lt, lo, _ = z
        u2 = -lo / r
        u1 = 1 / r**2 - r * o * o if on_floor else -lw
        m = u1 + lw  # of g'' = -(r o^2 - 1/r^2 + u1)
        down = o * o + 2 / r**3
        return [
            *(w, r * o * o - 1 / r**2 + u1, o, (u2 - 2 * w * o) / r),
            -lw * down + lo * (u2 - 2 * w * o) / r**2 + m * down,
            *(-lr + 2 * lo * o / r, 0.0, -lt - 2 * lw * r * o + 2 * lo * w / r + 2 * m * r * o),
            (u1 * u1 + u2 * u2) / 2,
        ]

    return rates


TURN = 2 * np.pi
START, BACK = [1.1, 0.0, 0.0, 0.9], [1.0, 0.0, TURN, 1.0]


@pytest.mark.slow
def test_a_satellite_touches_its_floor_and_then_follows_it():
    def simulated(v: np.ndarray) -> tuple[np.ndarray, list[float]]:
        touch, push, entry, first, second, leave = v[4:]
        z = along(polar(False), 0.0, touch, np.array([*START, *v[:4], 0.0]))
        missed = [z[0] - 0.98, z[1]]
        z[4] += push
        z = along(polar(False), touch, entry, z)
        missed += [z[0] - 0.98, z[1], -z[5] - (1 / z[0] ** 2 - z[0] * z[3] ** 2)]
        z[4:6] += first, second
        z = along(polar(True), entry, leave, z)
        missed += [1 / z[0] ** 2 - z[0] * z[3] ** 2 + z[5]]
        return along(polar(False), leave, TURN, z), missed

    def misses(v: np.ndarray) -> np.ndarray:
        z, missed = simulated(v)
        return np.array([*missed, *(z[:4] - BACK)])

    near = [0.2439, 0.1003, -0.033, 0.1191, 3.2401, 0.0846, 4.0242, 0.055, 0.0, 4.2807]
    found = shot(misses, near)
    check("return-above", simulated(found)[0][8], found[[4, 6, 9]])


@pytest.mark.study
def test_a_satellite_touches_the_end_of_its_slot_twice():
    slot = np.radians(3.0)

    def simulated(v: np.ndarray) -> tuple[np.ndarray, list[float]]:
        z, missed, begun = np.array([*START, *v[:4], 0.0]), [], 0.0
        for time, push in (v[4:6], v[6:8]):
            z = along(polar(False), begun, time, z)
            missed += [time - z[2] - slot, 1.0 - z[3]]
            z[6] += push
            begun = time
        return along(polar(False), begun, TURN, z), missed

    def misses(v: np.ndarray) -> np.ndarray:
        z, missed = simulated(v)
        return np.array([*missed, *(z[:4] - BACK)])

    found = shot(misses, [0.5494, 0.3406, -0.361, 0.025, 1.0258, 0.3437, 2.5928, 0.0106])
    check("return-in-slot", simulated(found)[0][8], found[[4, 6]])


def damped(arcs: Sequence[str], bound: float, near: Sequence[float]) -> tuple[float, np.ndarray]:
    """Rayleigh's oscillator, and its costates and junctions: the least cost with arcs on u = -x1 / 6 and on bounds.

    On the first, lambda_1 falls by mu / 6 besides, mu = -2 u - 4 lambda_2. The control is continuous.
    """

    def control(arc: str, z: Sequence[float]) -> float:
        return {"state": -z[0] / 6, "free": -2 * z[3], "upper": bound, "lower": -bound}[arc]

    def rates(arc: str) -> Rates:
        def found(t: float, z: Sequence[float]) -> list[float]:
            a, b, p, q, _ = z
            u, falls = control(arc, z), arc == "state"
            pushed = q - 2 * a + falls * (2 * u + 4 * q) / 6
            return [b, -a + b * (1.4 - 0.14 * b * b) + 4 * u, pushed, -p - q * (1.4 - 0.42 * b * b), u * u + a * a]

        return found

    def simulated(v: np.ndarray) -> tuple[np.ndarray, list[float]]:
        z, missed, begun = np.array([-5.0, -5.0, *v[:2], 0.0]), list[float](), 0.0
        for arc, after, until in zip(arcs, (*arcs[1:], "free"), (*v[2:], 4.5), strict=True):
            z = along(rates(arc), begun, until, z)
            missed.append(control(arc, z) - control(after, z))
            begun = until
        return z, [*missed[:-1], *z[2:4]]

    found = shot(lambda v: np.array(simulated(v)[1]), near)
    return simulated(found)[0][4], found


@pytest.mark.slow
def test_rayleighs_oscillator_is_damped_with_its_control_bounded_by_the_state():
    cost, found = damped(["state", "free", "state", "free"], 0.0, [-10.678, -4.191, 1.27, 2.978, 4.295])
    check("rayleigh-mixed", cost, [0.0, *found[2:]])


@pytest.mark.slow
def test_where_a_bound_and_a_constraint_cross_one_follows_the_other():
    arcs = ["upper", "state", "free", "lower", "free", "state", "free"]
    near = [-12.94158, -4.79831, 1.08886, 1.27113, 1.71322, 3.26966, 3.4852, 4.30121]
    cost, found = damped(arcs, 0.8, near)
    rayleigh = next(one for one in oscillators() if one.name == "rayleigh_mixed")
    boxed = replace(rayleigh, name="rayleigh_boxed", control_set="box")
    start = {"x1": -5.0, "x2": -5.0}
    ours = satsym.solve(satsym.Instance.of(boxed, control={"u": [-0.8, 0.8]}, initial=start, tf=4.5)).found
    assert ours.objective == pytest.approx(cost, rel=1e-10)
    assert [one.t for one in ours.events] == pytest.approx([0.0, found[2], *found[2:]], abs=1e-7)
    assert [one.kind for one in ours.events] == ["entry", "exit"] * 4
    assert ours.certificate is not None
    assert ours.certificate.verdict is Verdict.CERTIFIED


def test_a_rendezvous_slides_along_its_approach_cone():
    """The Clohessy-Wiltshire equations, and g = -x1 + x3 / 2 - 0.001."""

    def hill(on_cone: bool) -> Rates:
        def rates(t: float, z: Sequence[float]) -> list[float]:
            x1, x2, _, x4, l1, l2, l3, l4, _ = z
            m = 0.0
            if on_cone:  # g'' = -(3 x1 + 2 x4 + u1) + (u2 - 2 x2) / 2 = 0 with u1 = m - l2, u2 = -m / 2 - l4
                m = (-3 * x1 - 2 * x4 + l2 - x2 - l4 / 2) / 1.25
            u1, u2 = m - l2, -m / 2 - l4
            return [
                *(x2, 3 * x1 + 2 * x4 + u1, x4, u2 - 2 * x2),
                *(-3 * l2 + 3 * m, -l1 + 2 * l4 + m, 0.0, -2 * l2 - l3 + 2 * m),
                (u1 * u1 + u2 * u2) / 2,
            ]

        return rates

    def pushed(z: np.ndarray) -> float:
        return float(-3 * z[0] - 2 * z[3] + z[5] - z[1] - z[7] / 2)

    def simulated(v: np.ndarray) -> tuple[np.ndarray, list[float]]:
        entry, first, second, leave = v[4:]
        z = along(hill(False), 0.0, entry, np.array([0.04, 0.0, -0.1, 0.0, *v[:4], 0.0]))
        missed = [-z[0] + z[2] / 2 - 0.001, -z[1] + z[3] / 2, pushed(z)]
        z[4:8] += [first, second, -first / 2, -second / 2]
        z = along(hill(True), entry, leave, z)
        return along(hill(False), leave, np.pi, z), [*missed, pushed(z)]

    def misses(v: np.ndarray) -> np.ndarray:
        z, missed = simulated(v)
        return np.array([*missed, *z[:4]])

    found = shot(misses, [0.4374, 0.1959, -0.0933, 0.1371, 2.5171, 0.26, 0.0, 2.5439])
    check("approach-cone", simulated(found)[0][8], found[[4, 7]])


@pytest.mark.study
def test_round_two_discs_a_spline_leads_through_two_points_at_which_it_is_stationary():
    """Between touch points accelerations are linear in time: the least effort through two given points is a spline."""

    def effort(v: Sequence[float]) -> float:
        first, a, second, b = v
        times = np.array([0.0, first, second, 1.0])
        points = np.array(
            [
                *([0.0, 0.0], [0.3 + 0.2 * np.cos(a), -0.05 + 0.2 * np.sin(a)]),
                *([0.7 + 0.15 * np.cos(b), 0.1 + 0.15 * np.sin(b)], [1.0, 0.0]),
            ]
        )
        bent = CubicSpline(times, points, bc_type="clamped")(times, 2)
        h = np.diff(times)[:, None]
        return float((h / 6 * (bent[:-1] ** 2 + bent[:-1] * bent[1:] + bent[1:] ** 2)).sum())

    def slope(v: np.ndarray) -> np.ndarray:
        return np.array([(effort(v + d) - effort(v - d)) / 2e-5 for d in 1e-5 * np.eye(4)])

    found = root(slope, [0.269, 2.05, 0.6203, 1.29], tol=1e-10).x
    check("obstacle", effort(found), found[[0, 2]])
