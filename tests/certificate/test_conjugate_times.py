"""Jacobi's condition and the form at the end, held against closed forms: times that count more than once, free ends."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sympy import Expr, sympify

from satsym.grid import Grid
from satsym.instance import Instance
from satsym.solution import Certificate, Solution
from satsym.solvers import linear
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.jacobi import NOT_STRICT, Conjugate, conjugate
from satsym.solvers.certificate.reintegration.segments import segments
from satsym.solvers.improving import along
from satsym.spec import ControlSetKind, Variable
from satsym.status import Status
from satsym.symbolic import FirstOrder, Problem, symbols_of
from tests.support.models import build

NAMES = ("a", "b")
a, b, va, vb = symbols_of([Variable(name, name) for name in ("a", "b", "va", "vb")])
NOTHING = sympify(0)
TEXT = "[initial]\na = 0.5\nb = 0.3\n[time]\ntf = 3.0\n"


def plane(
    name: str,
    running_cost: Expr,
    terminal_cost: Expr = NOTHING,
    constraints: tuple[Expr, ...] = (),
    control_set: ControlSetKind = "free",
) -> Problem:
    """Two places, each with its own velocity as control."""
    return Problem(
        name=name,
        title=name,
        model=FirstOrder(
            name=f"{name}_motion",
            title="A point in the plane",
            states=tuple(Variable(one, one) for one in NAMES),
            controls=tuple(Variable(f"v{one}", f"v_{one}") for one in NAMES),
            parameters=(),
            rates={a: va, b: vb},
        ),
        running_cost=running_cost,
        terminal_cost=terminal_cost,
        terminal_constraints=constraints,
        control_set=control_set,
    )


EFFORT = (va**2 + vb**2) / 2


def extremal(case: Instance, times: np.ndarray, x: Any, u: Any, cost: float) -> Solution:
    """States and controls in closed form; the costates are minus the controls."""
    x, u = np.array(x), np.array(u)
    initial = tuple(x[:, 0].tolist())
    return Solution(
        instance=replace(case, initial=initial),
        method="closed form",
        status=Status.CONVERGED,
        message="",
        objective=cost,
        times=times,
        x=x,
        u=u,
        lam=-u,
        switching_times=((), ()),
        iterations=0,
        history=(),
        wall_s=0.0,
    )


def second_order(solution: Solution) -> tuple[Conjugate, float]:
    """What conjugate points say, and the least eigenvalue of the second variation, which knows none of them."""
    grid = Grid.uniform(float(solution.times[0]), float(solution.times[-1]), 200)
    found = along(solution, grid)
    assert found is not None
    assert not found.second.drowned
    return conjugate(solution, segments(solution)), found.second.steepest()[0]


def failing(certificate: Certificate | None) -> set[str]:
    assert certificate is not None
    return {check.name for check in certificate.checks if not check.passed}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("conjugate")


@pytest.fixture(scope="module")
def equal(folder: Path) -> Instance:
    """Conjugate times k pi, each twice."""
    return build(folder, plane("equal", EFFORT - (a**2 + b**2) / 2), TEXT)


@pytest.fixture(scope="module")
def unequal(folder: Path) -> Instance:
    """Conjugate times k pi and k pi / 2."""
    return build(folder, plane("unequal", EFFORT - (a**2 + 4 * b**2) / 2), TEXT)


def swinging(case: Instance, tf: float, rates: tuple[float, float], t0: float = 0.0) -> Solution:
    """Both axes at their own angular rate, to wherever they are at the end."""
    t = np.linspace(t0, tf, 201)
    s = t - t0
    x = [np.cos(w * s) + c * np.sin(w * s) for w, c in zip(rates, (0.3, -0.8), strict=True)]
    u = [w * (c * np.cos(w * s) - np.sin(w * s)) for w, c in zip(rates, (0.3, -0.8), strict=True)]
    cost = sum(x[i][-1] * u[i][-1] - x[i][0] * u[i][0] for i in range(2)) / 2.0
    final = {name: float(row[-1]) for name, row in zip(NAMES, x, strict=True)}
    return extremal(replace(case, final=final, tf=tf, t0=t0), t, x, u, cost)


@pytest.mark.parametrize(("tf", "count"), [(3.0, 0), (4.0, 2), (6.0, 2), (7.0, 4), (10.0, 6)])
def test_equal_axes_are_conjugate_twice_at_once(equal: Instance, tf: float, count: int) -> None:
    found, least = second_order(swinging(equal, tf, (1.0, 1.0)))
    assert found.resolved
    assert found.passed == count
    assert found.time == (pytest.approx(np.pi, abs=1e-7) if count else None)
    assert least == pytest.approx(1.0 - (tf / np.pi) ** 2, rel=0.02)  # of a half wave, per its own cost
    assert (least < 0.0) is (count > 0)


@pytest.mark.parametrize(
    ("tf", "count", "first"), [(1.5, 0, None), (1.7, 1, np.pi / 2), (3.5, 3, np.pi / 2), (6.5, 6, np.pi / 2)]
)
def test_unequal_axes_are_conjugate_each_at_its_own_times(
    unequal: Instance, tf: float, count: int, first: float | None
) -> None:
    found, least = second_order(swinging(unequal, tf + 1.25, (1.0, 2.0), t0=1.25))
    assert found.passed == count
    assert found.time == (None if first is None else pytest.approx(1.25 + first, abs=1e-7))
    assert (least < 0.0) is (count > 0)


@pytest.mark.slow
def test_a_final_time_that_is_conjugate_is_no_strict_minimum(equal: Instance) -> None:
    solution = swinging(equal, np.pi, (1.0, 1.0))
    found, _ = second_order(solution)
    assert found.passed in (0, 1, 2)  # what rounding says
    assert found.touching
    certificate = certify(solution)
    assert certificate is not None
    assert certificate.verdict == "extremal only"
    assert failing(certificate) & {NOT_STRICT, "conjugate points: none"}


@pytest.mark.parametrize(("tf", "verdict"), [(3.0, "certified"), (4.0, "extremal only"), (7.0, "extremal only")])
def test_the_linear_method_is_not_certified_beyond_the_conjugate_time(equal: Instance, tf: float, verdict: str) -> None:
    found = linear.solve(replace(equal, final={"a": 0.0, "b": 0.0}, tf=tf))
    assert found.status is Status.CONVERGED
    certificate = certify(found)
    assert certificate is not None
    assert certificate.verdict == verdict
    assert ("conjugate points: none" in failing(certificate)) is (verdict != "certified")


@pytest.mark.parametrize(("weight", "minimum"), [(0.45, True), (0.55, False)])
@pytest.mark.parametrize("tied", [False, True])
def test_a_terminal_weight_may_turn_a_free_end_into_a_maximum(
    folder: Path, weight: float, minimum: bool, tied: bool
) -> None:
    """S = -k (a - b)^2 / 2 against (da^2 + db^2) / (2 T) with T = 1: a minimum for k < 1/2, with a + b tied or not."""
    cost, constraints = sympify(-weight) * (a - b) ** 2 / 2, (a + b - 1,) if tied else ()
    text = TEXT.replace("3.0", "1.0")
    name = f"weighed_{round(100 * weight)}_{tied}".lower()
    case = build(folder, plane(name, EFFORT, cost, constraints), text)
    t = np.linspace(0.0, 1.0, 201)
    # Along a - b: v_a = -v_b = k (a - b) at the end; along a + b to its target, or at rest.
    sum_end, difference = (1.0 if tied else 0.8), 0.2 / (1.0 - 2.0 * weight)
    end = np.array([sum_end + difference, sum_end - difference]) / 2.0
    start = np.array([0.5, 0.3])
    u = np.repeat((end - start)[:, None], len(t), axis=1)
    value = float((end - start) @ (end - start) / 2.0 - weight * difference**2 / 2.0)
    solution = extremal(replace(case, final={}), t, start[:, None] + u * t, u, value)
    found, least = second_order(solution)
    assert found.passed == 0
    assert (found.curvature > 0.0) is minimum
    assert (least > 0.0) is minimum
    assert least == pytest.approx(1.0 - 2.0 * weight, rel=1e-6)
    verdict = certify(solution)
    assert verdict is not None
    assert verdict.verdict == ("certified" if minimum else "extremal only"), failing(verdict)


@pytest.mark.parametrize(("side", "minimum"), [(1.0, True), (-1.0, False)])
def test_the_curvature_of_a_constraint_tells_the_near_side_of_a_circle_from_the_far_one(
    folder: Path, side: float, minimum: bool
) -> None:
    """From (1/2, 0) onto the unit circle: straight to (1, 0), or to (-1, 0), the most expensive place of all."""
    case = build(folder, plane(f"circle_{minimum}".lower(), EFFORT, constraints=(a**2 + b**2 - 1,)), TEXT)
    t = np.linspace(0.0, 3.0, 201)
    u = np.stack([np.full_like(t, (side - 0.5) / 3.0), np.zeros_like(t)])
    x = np.stack([0.5 + u[0] * t, np.zeros_like(t)])
    solution = extremal(replace(case, final={}), t, x, u, (side - 0.5) ** 2 / 6.0)
    found, least = second_order(solution)
    assert (found.curvature > 0.0) is minimum
    assert (least > 0.0) is minimum
    certificate = certify(solution)
    assert certificate is not None
    assert certificate.verdict == ("certified" if minimum else "extremal only")


@pytest.mark.parametrize(("late", "minimum"), [(False, True), (True, False)])
def test_a_free_final_time_may_be_the_worst_one(folder: Path, late: bool, minimum: bool) -> None:
    """J(T) = (a0^2 + b0^2) cot(T) / 2 + T / 2: least at arcsin of the distance, largest at pi less that."""
    case = build(folder, plane(f"timed_{minimum}".lower(), EFFORT - (a**2 + b**2) / 2 + sympify(1) / 2), TEXT)
    start = np.array([0.18, 0.24])  # 0.3 from the end
    tf = np.pi - np.arcsin(0.3) if late else np.arcsin(0.3)
    t = np.linspace(0.0, tf, 401)
    x = start[:, None] * np.sin(tf - t) / np.sin(tf)
    u = -start[:, None] * np.cos(tf - t) / np.sin(tf)
    cost = 0.09 / np.tan(tf) / 2.0 + tf / 2.0
    solution = extremal(replace(case, final={"a": 0.0, "b": 0.0}, tf=None), t, x, u, cost)
    found, least = second_order(solution)
    assert found.passed == 0
    assert (found.curvature > 0.0) is minimum
    assert (least > 0.0) is minimum
    certificate = certify(solution)
    assert certificate is not None
    assert (certificate.verdict == "certified") is minimum


def test_a_final_time_is_the_worst_one_where_costates_still_change(folder: Path) -> None:
    """From 0.6 to 0.6 again within a quarter of a turn: J(T) = T c / 2 - 0.36 tan(T / 2) is concave throughout."""
    price = 2.0 * 0.36 / (1.0 + np.cos(1.0))  # for J'(1) = 0
    cost = EFFORT - (a**2 + b**2) / 2 + sympify(float(price)) / 2
    case = build(folder, plane("there_and_back", cost), TEXT)
    t = np.linspace(0.0, 1.0, 401)
    x = np.stack([0.6 * np.cos(t - 0.5) / np.cos(0.5), np.zeros_like(t)])
    u = np.stack([-0.6 * np.sin(t - 0.5) / np.cos(0.5), np.zeros_like(t)])
    objective = float(price) / 2.0 - 0.36 * np.tan(0.5)
    solution = extremal(replace(case, final={"a": 0.6, "b": 0.0}, tf=None), t, x, u, objective)
    found, least = second_order(solution)
    assert found.passed == 0
    assert found.curvature < 0.0
    assert least < 0.0
