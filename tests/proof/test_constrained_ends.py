"""Constraints at the end, against distances to curves: at the cost of u^2/2 a motion in the plane is straight.

The cost from a point to a curve in time T is the squared distance over 2 T. Feet of normals at which the distance has a
local minimum are optima; those at which it has a maximum along the curve are extremals as well, and none.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy

import satsym
from satsym import kernels, solvers
from satsym.instance import Instance
from satsym.instance.ends import Side
from satsym.kernels.active import with_active
from satsym.proof.ends import kernel_of
from satsym.proof.proving import prove
from satsym.proof.record import Outcome, Proof
from satsym.solution import Solution
from satsym.symbolic import t
from tests.proof.closed_forms import answer

x, y, u, w = sympy.symbols("x y u w", real=True)
A, B = 2, 1


@cache
def problem(kind: str) -> Any:
    motion = satsym.FirstOrder(
        name="plane_motion",
        title="A point of the plane",
        states=(satsym.Variable("x", "x"), satsym.Variable("y", "y")),
        controls=(satsym.Variable("u", "u"), satsym.Variable("w", "w")),
        parameters=(),
        rates={x: u, y: w},
    )
    level = x**2 / A**2 + y**2 / B**2 - 1
    stated: dict[str, Any] = {
        "on": {"terminal_constraints": (level,)},
        "inside": {"terminal_inequalities": {"level": level}},
        "outside": {"terminal_inequalities": {"level": -level}},
        "turning": {"terminal_constraints": (x - sympy.cos(3 * t), y - 2 * sympy.sin(3 * t))},
        "beyond a line": {"terminal_inequalities": {"level": x + y - 1}},
        "twice": {"terminal_constraints": (level, 2 * level)},
    }[kind]
    cost = (u**2 + w**2) / 2 + (1 if kind == "turning" else 0)
    return satsym.Problem(name="curve", title="To a curve", model=motion, running_cost=cost, **stated)


def straight(case: Instance, start: tuple[float, float], end: tuple[Any, Any], tf: Any) -> Solution:
    times = np.linspace(0.0, float(tf), 21)
    pace = np.array([float((b - a) / tf) for a, b in zip(start, end, strict=True)])
    states = np.array(start)[:, None] + np.outer(pace, times)
    controls = np.repeat(pace[:, None], len(times), axis=1)
    return answer(case, times, states, controls, -controls)


def stated(kind: str, start: tuple[float, float], tf: float | str = 1.0) -> Instance:
    begun = {"tf_guess": 1.0} if tf == "free" else {}
    return satsym.Instance.of(problem(kind), initial=dict(zip("xy", start, strict=True)), final={}, tf=tf, **begun).case


def feet(start: tuple[float, float]) -> list[tuple[Any, bool]]:
    """Angles of the normals from a point to the ellipse, and whether the distance has a minimum there."""

    def slope(s: Any) -> Any:
        return (A * mpmath.cos(s) - start[0]) * -A * mpmath.sin(s) + (B * mpmath.sin(s) - start[1]) * B * mpmath.cos(s)

    grid = [2 * mpmath.pi * k / 400 + mpmath.mpf("0.001") for k in range(401)]
    signs = [(a, b) for a, b in pairwise(grid) if slope(a) * slope(b) < 0]
    found = [mpmath.findroot(slope, pair, solver="anderson") for pair in signs]
    return [(s, mpmath.diff(slope, s) > 0) for s in found]


def held(found: Proof, exact: Any) -> bool:
    assert found.objective is not None
    return bool(abs(mpmath.mpf(found.objective.centre) - exact) <= mpmath.mpf(found.objective.radius))


@pytest.mark.parametrize("start", [(3.0, 1.0), (0.25, 0.125), (-0.5, 0.0625)])
def test_of_all_normals_to_an_ellipse_those_to_nearest_points_are_proved(start: tuple[float, float]) -> None:
    case, seen = stated("on", start), set()
    with mpmath.workdps(40):
        for angle, nearest in feet(start):
            end = A * mpmath.cos(angle), B * mpmath.sin(angle)
            proof = prove(case, lambda end=end: straight(case, start, end, 1))
            assert proof.status is (Outcome.PROVED if nearest else Outcome.NOT_PROVED), proof.reason
            assert held(proof, sum((a - b) ** 2 for a, b in zip(start, end, strict=True)) / 2)
            assert nearest or "focal point of the final conditions" in proof.reason
            seen.add(nearest)
    assert seen == {True, False}


def test_an_inequality_that_is_met_pushes() -> None:
    start = (3.0, 1.0)
    case = stated("inside", start)
    found = solvers.solve(case)
    assert found.instance.met == {"level": Side.UPPER}
    proof = prove(case, lambda: found)
    assert proof.status is Outcome.PROVED
    with mpmath.workdps(40):
        (angle, _) = next(one for one in feet(start) if one[1])
        end = A * mpmath.cos(angle), B * mpmath.sin(angle)
        assert held(proof, sum((a - b) ** 2 for a, b in zip(start, end, strict=True)) / 2)
        outwards = stated("outside", start)  # the same end holds nothing back: its multiplier has the other sign
        met = replace(outwards, met={"level": Side.UPPER}, model=with_active(outwards.model, {"level"}))
        proof = prove(outwards, lambda: straight(met, start, end, 1))
    assert proof.status is Outcome.NOT_PROVED
    assert "multiplier of the inequality level" in proof.reason


def test_a_half_plane_is_entered_at_the_least_cost_of_all() -> None:
    """The distance from (3, 1) to x + y = 1 is 3/sqrt(2)."""
    case = stated("beyond a line", (3.0, 1.0))
    proof = prove(case, lambda: solvers.solve(case))
    assert proof.status is Outcome.PROVED
    assert held(proof, mpmath.mpf(9) / 4)
    assert proof.theorem is not None
    assert "The optimum is global" in proof.theorem.claims[-1]


def test_an_inequality_that_is_not_met_is_kept() -> None:
    case = stated("outside", (3.0, 1.0))
    proof = prove(case, lambda: straight(case, (3.0, 1.0), (3.0, 1.0), 1))
    assert proof.status is Outcome.PROVED
    assert held(proof, 0)
    assert proof.theorem is not None
    assert not any("global" in claim for claim in proof.theorem.claims)
    case = stated("inside", (3.0, 1.0))
    proof = prove(case, lambda: straight(case, (3.0, 1.0), (3.0, 1.0), 1))
    assert proof.status is Outcome.NOT_PROVED
    assert "the inequality level at the end" in proof.reason


def test_who_meets_a_point_that_moves_does_so_at_a_minimum_of_the_cost() -> None:
    """T + d(T)^2/(2 T), with the distance to a point on its way round an ellipse, has maxima between its minima."""
    start, case = (2.0, 1.0), stated("turning", (2.0, 1.0), "free")
    seen = set()
    with mpmath.workdps(40):

        def end(tf: Any) -> tuple[Any, Any]:
            return mpmath.cos(3 * tf), 2 * mpmath.sin(3 * tf)

        def cost(tf: Any) -> Any:
            return tf + sum((a - b) ** 2 for a, b in zip(start, end(tf), strict=True)) / (2 * tf)

        def slope(tf: Any) -> Any:
            return mpmath.diff(cost, tf)

        grid = [mpmath.mpf(k) / 40 for k in range(8, 240)]
        for a, b in pairwise(grid):
            if slope(a) * slope(b) > 0:
                continue
            tf = mpmath.findroot(slope, (a, b), solver="anderson")
            least = mpmath.diff(cost, tf, 2) > 0
            proof = prove(case, lambda tf=tf: straight(case, start, end(tf), tf))
            assert proof.status is (Outcome.PROVED if least else Outcome.NOT_PROVED), proof.reason
            assert held(proof, cost(tf))
            seen.add(least)
    assert seen == {True, False}


@cache
def body() -> Any:
    motion = satsym.FirstOrder(
        name="line_motion",
        title="A body on a line",
        states=(satsym.Variable("x", "x"), satsym.Variable("y", "y")),
        controls=(satsym.Variable("u", "u"),),
        parameters=(),
        rates={x: y, y: u},
    )
    return satsym.Problem(
        name="soon",
        title="Into a disc of the phase plane in least time",
        model=motion,
        running_cost=1,
        terminal_constraints=(x**2 + y**2 - sympy.Rational(1, 4),),
        control_set="box",
    )


def test_a_body_is_soonest_in_a_disc_of_the_phase_plane_with_one_switch() -> None:
    """From rest at 3: u = -1, then 1 until the end; the costates are 2 nu (x, y + x (T - t)) with those of the end."""
    case = satsym.Instance.of(
        body(), initial={"x": 3.0, "y": 0.0}, final={}, tf="free", tf_guess=3.0, control={"u": [-1.0, 1.0]}
    ).case

    def motion(s: Any, t: Any) -> tuple[Any, Any]:
        if t <= s:
            return 3 - t**2 / 2, -t
        after = t - s
        return 3 - s**2 / 2 - s * after + after**2 / 2, -s + after

    with mpmath.workdps(40):

        def conditions(s: Any, tf: Any) -> list[Any]:
            q, v = motion(s, tf)
            return [q**2 + v**2 - mpmath.mpf(1) / 4, v + q * (tf - s)]

        s, tf = mpmath.findroot(conditions, (mpmath.mpf("1.9"), mpmath.mpf("2.6")))
        q, v = motion(s, tf)
        nu = -1 / (2 * q * v + 2 * v)  # H = 1 + lambda_x y + lambda_y = 0 at the end
        assert 0 < s < tf
        assert nu > 0
        times = np.concatenate([np.linspace(0.0, float(s), 41), np.linspace(float(s), float(tf), 41)])
        states = np.array([[float(one) for one in motion(float(s), k)] for k in times]).T
        costates = 2 * np.array([[float(nu * q)] * len(times), [float(nu * (v + q * (tf - k))) for k in times]])
        controls = np.repeat([-1.0, 1.0], 41)[None]
        found = replace(answer(case, times, states, controls, costates), switching_times=((float(s),),))
        proof = prove(case, lambda: found)
        assert proof.status is Outcome.PROVED, proof.reason
        assert held(proof, tf)
        (switch,) = proof.switching_times
        assert abs(mpmath.mpf(switch.centre) - s) <= mpmath.mpf(switch.radius)
        assert proof.theorem
        assert not any("global" in claim for claim in proof.theorem.claims)


@pytest.mark.parametrize(
    ("said", "feature"),
    [
        ("lambda_x", "more than states"),
        ("nu_1", "more than states"),
        ("given_y*y", "more than states"),
        ("(y if y > 0.0 else -y)", "defined piecewise or contains absolute values"),
        ("math.fabs(y)", "defined piecewise or contains absolute values"),
    ],
)
def test_constraints_of_another_form_are_refused(said: str, feature: str) -> None:
    case = stated("on", (3.0, 1.0))
    text = case.model.text
    assert text
    begin = text.index("def boundary(")
    line = next(one for one in text[begin:].splitlines() if one.endswith("- 1.0,"))
    changed = text[:begin] + text[begin:].replace(line, f"        {said} - 1.0,", 1)
    other = replace(case, model=kernels.loading.from_text(changed, "curve"))
    proof = prove(other, lambda: pytest.fail("nothing need be solved"))
    assert proof.status is Outcome.BEYOND
    assert feature in proof.reason


def test_constraints_that_say_the_same_are_not_proved() -> None:
    case = stated("twice", (3.0, 1.0))
    proof = prove(case, lambda: straight(case, (3.0, 1.0), (1.9, 0.3), 1))
    assert proof.status is Outcome.NOT_PROVED


def test_rows_that_span_a_kernel_are_mapped_to_zero() -> None:
    from flint import arb, arb_mat

    slopes = arb_mat(2, 4, [arb(v) for v in (1, 2, 3, 4, 0, 1e-9, 5, -2)])
    rows = kernel_of(slopes)
    assert (rows.nrows(), rows.ncols()) == (2, 4)
    assert all(v.contains(0) and v.rad() < 1e-12 for v in (slopes * rows.transpose()).entries())
    assert not (rows * rows.transpose()).det().contains(0)
