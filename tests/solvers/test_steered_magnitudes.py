"""A magnitude beside an angle between bounds that turns it: laws against grids, answers against shooting by hand."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve
from sympy import Expr, cos, sin

import satsym
from satsym.arrays import Array
from satsym.report.latex.document import render
from satsym.status import BadInput, Status, Verdict
from satsym.symbolic import Angle, Box, FirstOrder, Problem, Variable, symbols_of
from satsym.symbolic.pipeline import derive
from satsym.symbolic.sets import AdmissibleSet
from tests.support.models import build

LANDER = tuple(Variable(name, name, positive=name == "m") for name in ("x", "y", "vx", "vy", "m"))
CONTROLS = (Variable("T", "T"), Variable("b", "beta", kind="angle"))
x, y, vx, vy, m = symbols_of(LANDER)
T, b = symbols_of(CONTROLS)
EXHAUST, STRONGEST, LASTING = 5.0, 3.0, 3.6


def lander(name: str, cost: Expr, gimbal: AdmissibleSet, side: str = "minimum") -> Problem:
    """Down to the ground, whose gravity is one, by a thrust that is turned from the vertical; mass flows with it."""
    rates = {x: vx, y: vy, vx: T * sin(b) / m, vy: T * cos(b) / m - 1, m: -T / 5}
    moving = FirstOrder(name="lander", title="L", states=LANDER, controls=CONTROLS, parameters=(), rates=rates)
    sets = {"throttle": Box("T"), "gimbal": gimbal}
    return Problem(name=name, title="L", model=moving, running_cost=cost, control_sets=sets, convention=side)


THRIFTY = lander("thrifty", T, Box("b"))
SMOOTH = lander("smooth", T**2 / 2, Box("b"))
START = {"x": -1.2, "y": 2.0, "vx": 0.3, "vy": -0.5, "m": 1.0}
GROUND = {"x": 0.0, "y": 0.0, "vx": 0.0, "vy": 0.0}


def landing(problem: Problem, widest: float) -> satsym.Solution:
    bounds = {"T": (0, STRONGEST), "b": (-widest, widest)}
    found = satsym.solve(satsym.Instance.of(problem, initial=START, final=GROUND, tf=LASTING, control=bounds))
    assert found.status is Status.CONVERGED, found.message
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate
    return found


@pytest.mark.slow
@pytest.mark.parametrize("ends", [(-0.3, 0.3), (0.5, 1.2), (-3.0, 1.0), (2.0, 7.0)])
@pytest.mark.parametrize(("problem", "weight"), [(THRIFTY, 0.0), (SMOOTH, 1.0)], ids=["linear", "square"])
def test_no_thrust_within_both_bounds_is_better(
    tmp_path: Path, problem: Problem, weight: float, ends: tuple[float, float]
):
    start = "".join(f"{name} = {value}\n" for name, value in START.items())
    text = f"[initial]\n{start}[time]\ntf = 1.0\n[control]\nT = [0.5, 3.0]\nb = [{ends[0]}, {ends[1]}]\n"
    case, rng, taken = build(tmp_path, problem, text), np.random.default_rng(1), set()
    size, angle = (v.ravel() for v in np.meshgrid(np.linspace(0.5, 3.0, 101), np.linspace(*ends, 1001)))
    for lam in map(tuple, rng.normal(size=(80, 5)) * [1.0, 1.0, 2.0, 2.0, 2.0]):
        at = 0.0, (0.0, 1.0, 0.2, 0.1, 0.8)
        best, turned = case.model.control_law(*at, lam, case.parameters, case.control_set.arguments)
        assert 0.5 <= best <= 3.0
        assert ends[0] <= turned <= ends[1]
        h = case.model.hamiltonian(*at, (best, turned), lam, case.parameters)
        pull = (lam[2] * np.sin(angle) + lam[3] * np.cos(angle)) / 0.8 - lam[4] / 5.0
        cost = weight * size**2 / 2.0 + (1.0 - weight) * size
        others = cost + size * pull + lam[0] * 0.2 + lam[1] * 0.1 - lam[3]
        assert h <= others.min() + 1e-12
        taken.add((best if best in (0.5, 3.0) else "between", turned if turned in ends else "between"))
    sizes, angles = ({one[k] for one in taken} for k in range(2))
    assert sizes == ({0.5, 3.0, "between"} if weight else {0.5, 3.0})
    assert "between" in angles
    assert angles & set(ends)


@pytest.mark.slow
def test_where_the_bounds_leave_every_angle_it_is_the_vector():
    """The same rates, derivatives and costs as without bounds, also of regularised problems at any share of norms."""
    free, bounded = (satsym.derive(p).kernels for p in (lander("turned", T, Angle("b")), THRIFTY))
    rng = np.random.default_rng(3)
    for _ in range(20):
        at = 0.0, (*rng.normal(size=4), 0.8), tuple(rng.normal(size=5).tolist()), ()
        least, largest, smoothing, share = (*np.sort(rng.uniform(0.0, 3.0, 2)), 10 ** rng.uniform(-3, 0), rng.uniform())
        limits = tuple((least, largest, end, *rest, smoothing, share) for end, *rest in ((1.0,), (-math.pi, math.pi)))
        for name in ("control_law", "throttle_slope", "canonical", "canonical_jacobian", "regularised_cost"):
            theirs, ours = (getattr(k, name)(*at, g) for k, g in zip((free, bounded), limits, strict=True))
            assert ours == pytest.approx(theirs, rel=1e-10, abs=1e-10), name


def after(costates: Array, until: list[float], levels: list[float | None], widest: float) -> Array:
    """States and costates after arcs; a thrust without a level is what half its square allows."""

    def rates(_: float, z: Array, level: float | None) -> list[float]:
        _, _, *v, mass, a, c, pull_x, pull_y, of_mass = z
        turn = float(np.clip(math.atan2(-pull_x, -pull_y), -widest, widest))
        gain = -(pull_x * math.sin(turn) + pull_y * math.cos(turn)) / mass
        size = float(np.clip(gain + of_mass / EXHAUST, 0.0, STRONGEST)) if level is None else level
        up, aside = size * math.cos(turn) / mass - 1.0, size * math.sin(turn) / mass
        return [*v, aside, up, -size / EXHAUST, 0.0, 0.0, -a, -c, -size * gain / mass]

    z, begun = np.array([*START.values(), *costates]), 0.0
    for end, level in zip(until, levels, strict=True):
        z = solve_ivp(rates, (begun, end), z, "DOP853", args=(level,), rtol=1e-11, atol=1e-12).y[:, -1]
        begun = end
    return z


def margin(z: Array, widest: float) -> float:
    """By how much thrust is worth more than it costs."""
    turn = float(np.clip(math.atan2(-z[7], -z[8]), -widest, widest))
    return float(-(z[7] * math.sin(turn) + z[8] * math.cos(turn)) / z[4] + z[9] / EXHAUST - 1.0)


@pytest.mark.slow
def test_a_landing_by_a_gimbal_between_bounds_that_weighs_the_square_of_its_thrust():
    found = landing(SMOOTH, 0.2)

    def miss(costates: Array) -> Array:
        z = after(costates, [LASTING], [None], 0.2)
        return np.array([*z[:4], z[9]])

    costates = fsolve(miss, np.round(found.lam(0.0), 1), xtol=1e-12)
    assert found.lam(0.0) == pytest.approx(costates, abs=1e-8)
    assert np.abs(miss(costates)).max() < 1e-9
    turned = [float(found.u["b"](t)) for t in (0.1, 3.5)]
    assert turned == [0.2, -0.2]
    assert len(found.switching_times["b"]) == 2


@pytest.mark.slow
def test_a_landing_of_least_fuel_by_a_gimbal_between_bounds():
    """Full thrust, none, full thrust; the gimbal is held at a bound for a while."""
    found = landing(THRIFTY, 0.15)
    switches = found.switching_times["T"]
    levels: list[float | None] = [STRONGEST if k % 2 == (found.u["T"](0.0) == 0.0) else 0.0 for k in range(9)]

    def miss(unknown: Array) -> Array:
        costates, times = unknown[:5], [*unknown[5:], LASTING]
        z = after(costates, times, levels[: len(times)], 0.15)
        at = [margin(after(costates, times[:k], levels[:k], 0.15), 0.15) for k in range(1, len(times))]
        return np.array([*z[:4], z[9], *at])

    guess = np.round([*found.lam(0.0), *switches], 2)
    unknown = fsolve(miss, guess, xtol=1e-12)
    assert np.abs(miss(unknown)).max() < 1e-9
    assert found.lam(0.0) == pytest.approx(unknown[:5], abs=1e-8)
    assert switches == pytest.approx(unknown[5:], abs=1e-8)
    burning = np.diff([0.0, *unknown[5:], LASTING]) @ np.array(levels[: len(switches) + 1], dtype=float)
    assert found.objective == pytest.approx(burning, rel=1e-9)
    assert found.u["b"](3.5) == -0.15


@pytest.mark.parametrize("side", ["minimum", "maximum"])
def test_the_law_within_bounds_is_typeset_and_described(side: str):
    derived = derive(lander("said", T, Box("b"), side))
    assert {c.key for c in derived.step("control_law").conclusions} >= {"magnitude that is turned within bounds"}
    assert "nearest to the direction of" in render(derived)
    assert "terdekat dengan arah" in render(derived, language="id")


@pytest.mark.slow
def test_a_magnitude_beside_a_bounded_angle_is_not_negative():
    with pytest.raises(BadInput, match="a vector with the direction b, so it must not be negative"):
        satsym.Instance.of(THRIFTY, initial=START, tf=1, control={"T": (-1, 1), "b": (-1, 1)})
