"""Newton's equations of regularised paths: stage by stage as all at once, and away from saddles."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import satsym
from satsym.solvers.constrained.regularised.slopes import ByDuration, Slopes
from satsym.solvers.constrained.regularised.stagewise import Factors
from satsym.solvers.constrained.regularised.transcription import Step
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES, CONTROLS = (Variable("x", "x"),), (Variable("u", "u"),)
(x,), (u,) = symbols_of(STATES), symbols_of(CONTROLS)
HILL = Problem(
    name="hill",
    title="down a hill",
    model=FirstOrder(name="climber", title="x' = u", states=STATES, controls=CONTROLS, parameters=(), rates={x: u}),
    running_cost=u**2 / 2 - 8 * x**2,
    path_constraints={"up": u - 0.3 * x - 1, "down": -u + 0.3 * x - 1},
)


def drawn(seed: int, count: int, timed: bool, steep: float) -> tuple[Slopes, float]:
    """Derivatives at random, of three states and two controls with one condition at the end."""
    rng = np.random.default_rng(seed)
    n, m, h, e = 3, 2, 2, 1
    step = Step(*(rng.normal(size=(k, count)) for k in (n, m)), 0.0, rng.normal(size=(n, count)), rng.normal(size=e))
    between, nodes = rng.normal(size=(count, n + m, n + m)), rng.normal(size=(count, n, n))
    by_time = ByDuration(*(rng.normal(size=(k, count)) for k in (n, m, n, n)), rng.normal(size=e), np.zeros((h, count)))
    slopes = Slopes(
        replace(step, duration=float(rng.normal()) if timed else 0.0),
        (between + between.swapaxes(1, 2)) / 2 + steep * np.eye(n + m),
        (nodes + nodes.swapaxes(1, 2)) / 2,
        rng.normal(size=(count, n, n)) / 4,
        rng.normal(size=(count, n, m)),
        rng.normal(size=(e, n)),
        np.zeros((h, n, count)),
        np.zeros((h, m, count)),
        np.array([True, False]),
        by_time if timed else None,
    )
    return slopes, float(rng.normal())


def whole(slopes: Slopes, own: float) -> tuple[np.ndarray, int]:
    """The matrix of Newton's equations, and how many of its rows are conditions: states, controls, duration, others."""
    (count, n, m), e, timed = slopes.b.shape, len(slopes.ends), slopes.timed
    size = (n + m) * count + (timed is not None)
    hessian, conditions = np.zeros((size, size)), np.zeros((n * count + e, size))
    for k in range(count):
        middle, move = np.zeros((n + m, size)), np.zeros((n, size))
        at, node = slice(n * k, n * k + n), np.zeros((n, size))
        node[:, at] = np.eye(n)
        middle[:n, at] = np.eye(n) / 2
        move[:, at] = -np.eye(n)
        if k:
            middle[:n, n * (k - 1) : n * k] = np.eye(n) / 2
            move[:, n * (k - 1) : n * k] = np.eye(n)
        middle[n:, n * count + m * k : n * count + m * (k + 1)] = np.eye(m)
        hessian += middle.T @ slopes.between[k] @ middle + node.T @ slopes.nodes[k] @ node
        conditions[at] = move + slopes.a[k] @ middle[:n] + slopes.b[k] @ middle[n:]
        if timed is not None:
            mixed = middle.T @ np.concatenate([timed.state, timed.control])[:, k] + node.T @ timed.nodes[:, k]
            hessian[-1] += mixed
            hessian[:, -1] += mixed
            conditions[at, -1] = timed.gaps[:, k]
    conditions[n * count :, n * (count - 1) : n * count] = slopes.ends
    if timed is not None:
        hessian[-1, -1] = own
        conditions[n * count :, -1] = timed.ends
    return np.block([[hessian, conditions.T], [conditions, np.zeros((len(conditions),) * 2)]]), len(conditions)


@pytest.mark.parametrize("timed", [False, True])
@pytest.mark.parametrize("count", [1, 2, 5, 8])
@pytest.mark.parametrize("steep", [0.0, 3.0, 9.0])
def test_stages_have_the_step_and_the_signs_of_the_whole(count: int, timed: bool, steep: float):
    for seed in range(8):
        slopes, own = drawn(seed, count, timed, steep)
        matrix, conditions = whole(slopes, own)
        factors, n = Factors.of(slopes, own), 3
        assert factors.convex == (int((np.linalg.eigvalsh(matrix) < 0.0).sum()) == conditions)
        one = slopes.gradient
        right = [one.x.T.ravel(), one.u.T.ravel(), [one.duration] if timed else [], one.y.T.ravel(), one.v]
        wanted, found = -np.linalg.solve(matrix, np.concatenate(right)), factors.step(slopes, one)
        assert found.x.T.ravel() == pytest.approx(wanted[: n * count], rel=1e-6, abs=1e-8)
        assert found.y.T.ravel() == pytest.approx(wanted[-n * count - 1 : -1], rel=1e-6, abs=1e-8)
        assert found.duration == pytest.approx(wanted[5 * count] if timed else 0.0, rel=1e-6, abs=1e-8)


def test_curvature_that_is_added_makes_it_convex():
    slopes, own = drawn(0, 5, True, 0.0)
    assert not Factors.of(slopes, own).convex
    assert Factors.of(slopes, own, 1e4).convex


@pytest.mark.slow
@pytest.mark.parametrize("begun", [0.0, 0.05, -0.2, 0.4])
def test_a_saddle_is_left(begun: float):
    """Uphill as fast as allowed, x' = 1 + 0.3 x to the side of the start, then x = a cos 4 (1 - t)."""
    start = abs(begun)

    def on_bound(time: float) -> float:
        return (start + 1 / 0.3) * math.exp(0.3 * time) - 1 / 0.3

    def corner(time: float) -> float:
        return 4 * math.tan(4 * (1 - time)) * on_bound(time) - (1 + 0.3 * on_bound(time))

    left = brentq(corner, 1 - math.pi / 8 + 1e-6, 1.0, xtol=1e-15)
    size = on_bound(left) / math.cos(4 * (1 - left))
    first = quad(lambda s: (1 + 0.3 * on_bound(s)) ** 2 / 2 - 8 * on_bound(s) ** 2, 0.0, left, epsabs=1e-13)[0]
    then = quad(lambda s: 8 * size**2 * (math.sin(4 * s) ** 2 - math.cos(4 * s) ** 2), 0.0, 1 - left, epsabs=1e-13)[0]
    found = satsym.solve(satsym.Instance.of(HILL, initial={"x": begun}, tf=1.0))
    said = found.to_dict()
    assert said["certificate"]["verdict"] == "certified", said["certificate"]
    assert found.objective == pytest.approx(first + then, rel=1e-9)
    assert [(one.kind, one.t) for one in found.events] == [("entry", 0.0), ("exit", pytest.approx(left, abs=1e-8))]
