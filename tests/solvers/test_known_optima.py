"""Optima of the literature by routes that have nothing of satsym in them: closed forms, and shooting by hand."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_bvp, solve_ivp
from scipy.linalg import expm
from scipy.optimize import minimize, root

from satsym import instance
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import Verdict

KNOWN = tomllib.loads((Path(__file__).parents[1] / "bench" / "optima.toml").read_text(encoding="utf-8"))
WITHIN = 1e-9


def found(name: str, optimum: float) -> Solution:
    """Ours, which must be the optimum that the test has found, and that of the table."""
    ours = solve(instance.load(name))
    assert ours.instance.model.spec.objective(ours.objective) == pytest.approx(optimum, rel=WITHIN)
    assert KNOWN[name]["optimum"] == pytest.approx(optimum, rel=WITHIN)
    assert ours.certificate is not None
    assert ours.certificate.verdict is Verdict(KNOWN[name]["verdict"]), ours.certificate
    return ours


def along(
    rates: Callable[..., object], times: tuple[float, float], start: Sequence[float], *more: object
) -> np.ndarray:
    """Where a motion ends."""
    end = solve_ivp(rates, times, start, args=more, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    return np.asarray(end)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["hypersensitive", "hypersensitive-10000"])
def test_in_a_long_time_the_state_rests_in_between(name: str):
    """H vanishes in endless time: lambda = -x^3 +- x sqrt(1 + x^4), and its integrals from 1 to 0 and from 0 to 1.5."""

    def integral(x: float) -> float:
        return (x * x * math.sqrt(1.0 + x**4) + math.asinh(x * x)) / 4.0

    ours = found(name, integral(1.0) - 0.25 + integral(1.5) + 1.5**4 / 4.0)
    assert np.abs(ours.x[0, len(ours.times) // 2]) < 1e-9


def test_rayleighs_oscillator_is_damped_as_by_shooting():
    def rates(t: float, z: Sequence[float]) -> list[float]:
        a, b, p, q, _ = z
        u = -2.0 * q
        return [b, -a + b * (1.4 - 0.14 * b * b) + 4 * u, q - 2.0 * a, -p - q * (1.4 - 0.42 * b * b), u * u + a * a]

    def ends(costates: Sequence[float]) -> np.ndarray:
        return along(rates, (0.0, 4.5), [-5.0, -5.0, *costates, 0.0])

    shot = root(lambda costates: ends(costates)[2:4], [-9.0012, -2.6726], tol=1e-12)
    assert np.abs(ends(shot.x)[2:4]).max() < 1e-9
    found("rayleigh", ends(shot.x)[4])


@pytest.mark.slow
def test_van_der_pols_oscillator_is_damped_as_by_multiple_shooting():
    """u = 1 on an arc whose ends are unknown, -lambda_1 / 2 elsewhere."""

    def rates(t: float, z: np.ndarray, held: bool | None = None) -> np.ndarray:
        a, b, p, q = z[:4]
        u = np.clip(-p / 2.0, -0.75, 1.0) if held is None else 1.0 if held else -p / 2.0
        motion = [(1.0 - b * b) * a - b + u, a]
        return np.array(
            [*motion, -2.0 * a - p * (1.0 - b * b) - q, -2.0 * b + 2.0 * a * b * p + p, a * a + b * b + u * u]
        )

    t, later = np.linspace(0.0, 10.0, 400), [3.0, 4.5, 6.0, 7.5, 8.75]
    first = solve_bvp(
        lambda t, z: rates(t, z)[:4],
        lambda a, b: np.array([a[0], a[1] - 1.0, b[2], b[3]]),
        t,
        np.zeros((4, 400)),
        tol=1e-6,
        max_nodes=50_000,
    )
    fine = np.linspace(0.5, 2.0, 3001)
    switches = fine[np.flatnonzero(np.diff(np.sign(first.sol(fine)[2] + 2.0)))]

    def run(p: np.ndarray) -> tuple[list[float], float]:
        nodes = [np.array([0.0, 1.0, *p[:2]]), *p[4:].reshape(-1, 4)]
        times, missed, cost = [0.0, *p[2:4], *later, 10.0], [nodes[1][2] + 2.0, nodes[2][2] + 2.0], 0.0
        for k, node in enumerate(nodes):
            end = along(rates, (times[k], times[k + 1]), [*node, 0.0], k == 1)
            cost += end[4]
            missed += [*(end[:4] - nodes[k + 1])] if k + 1 < len(nodes) else [*end[2:4]]
        return missed, cost

    start = np.concatenate([first.y[2:, 0], switches, *(first.sol(t) for t in (*switches, *later))])
    missed, cost = run(root(lambda p: run(p)[0], start, tol=1e-12).x)
    assert np.abs(missed).max() < 1e-9
    ours = found("van-der-pol-boxed", cost)
    assert ours.switching_times[0] == pytest.approx(switches, abs=1e-3)


@pytest.mark.slow
def test_the_pole_is_swung_up_at_less_than_is_printed():
    """Kelly's 58.8076675 is a local optimum. Shooting from these costates, slopes of H by complex steps."""

    def motion(x: Sequence[complex], u: complex) -> list[complex]:
        _, q, v, w = x
        s, c = np.sin(q), np.cos(q)
        inertia = 1.0 + 0.3 * s * s
        cart = (0.15 * s * w * w + u + 0.3 * 9.81 * c * s) / inertia
        return [v, w, cart, -(0.15 * c * s * w * w + u * c + 1.3 * 9.81 * s) / (0.5 * inertia)]

    def rates(t: float, z: np.ndarray) -> list[float]:
        x, p = z[:4], z[4:8]
        s, c = math.sin(x[1]), math.cos(x[1])
        u = -(p[2] - p[3] * c / 0.5) / (1.0 + 0.3 * s * s) / 2.0
        slopes = [np.dot(p, motion(x + 1e-30j * unit, u)).imag / 1e-30 for unit in np.eye(4)]
        return [*np.real(motion(x, u)), *(-slope for slope in slopes), u * u]

    def ends(costates: Sequence[float]) -> np.ndarray:
        return along(rates, (0.0, 2.0), [0.0] * 4 + [*costates, 0.0])

    shot = root(lambda costates: ends(costates)[:4] - [1.0, math.pi, 0.0, 0.0], [6.306, -35.56, 4.341, -4.69], tol=1e-9)
    assert np.abs(ends(shot.x)[:4] - [1.0, math.pi, 0.0, 0.0]).max() < 1e-8
    cost = ends(shot.x)[8]
    assert cost < 58.0
    ours = found("cart-pole", cost)
    assert np.abs(ours.u).max() < 20.0


@pytest.mark.slow
def test_the_catalysts_are_mixed_in_a_constant_ratio_in_between():
    """For a constant share the motion is linear: the least of a closed form in two lengths and that share."""

    def left(values: Sequence[float]) -> float:
        first, last, share = values
        matrices = (np.array([[-u, 10 * u], [u, -9 * u - 1]]) for u in (1.0, share, 0.0))
        through = [expm(m * h) for m, h in zip(matrices, (first, last - first, 1.0 - last), strict=True)]
        return float((through[2] @ through[1] @ through[0] @ [1.0, 0.0]).sum())

    least = minimize(left, [0.14, 0.72, 0.23], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-15})
    ours = found("catalyst", 1.0 - least.fun)
    assert ours.switching_times[0] == pytest.approx(least.x[:2], abs=1e-6)


@pytest.mark.study
def test_the_body_turns_about_no_fixed_axis():
    """Bilimoria and Wie: five switches; they and the time by the six conditions at the end. About one axis: 3.545."""
    levels = (-1.0, -1.0, 1.0)

    def rates(t: float, z: np.ndarray, u: Sequence[float]) -> list[float]:
        a, b, c, d, *w = z
        turned = [w[0] * d - w[1] * c + w[2] * b, w[0] * c + w[1] * d - w[2] * a, -w[0] * b + w[1] * a + w[2] * d]
        return [*(v / 2.0 for v in turned), -(w[0] * a + w[1] * b + w[2] * c) / 2.0, *u]

    def end(p: np.ndarray) -> np.ndarray:
        rows = (p[1:3], p[3:5], p[5:6])
        edges = np.sort(np.concatenate([[0.0], p[1:], p[:1]]))
        z = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
        for a, b in pairwise(edges.tolist()):
            u = [s * (-1.0) ** int((row < (a + b) / 2.0).sum()) for s, row in zip(levels, rows, strict=True)]
            z = along(rates, (a, b), z, u)
        return z

    at = root(lambda p: end(p)[[0, 1, 3, 4, 5, 6]], [3.24, 0.5, 2.1, 1.1, 2.75, 1.62], tol=1e-12).x
    assert abs(end(at)[2]) == pytest.approx(1.0, abs=1e-10)
    ours = found("reorientation", at[0])
    assert sorted(t for own in ours.switching_times for t in own) == pytest.approx(sorted(at[1:]), abs=1e-8)


def test_every_entry_is_shipped_and_on_the_page():
    page = (Path(__file__).parents[2] / "docs" / "optima.md").read_text(encoding="utf-8")
    for name, entry in KNOWN.items():
        assert name in instance.shipped()
        assert f"| [{name}](gallery/{name}.md) | {entry['source']} |" in page
        assert ("reason" in entry) == (entry["verdict"] != "certified")
