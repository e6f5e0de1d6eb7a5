"""The set of admissible controls: the tuple that generated functions take, relaxed bounds, projection, distances."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

from satsym import instance, kernels
from satsym.control_set import UNSMOOTHED, ControlSet

BOX = ControlSet("box", (-1.0, 0.5, -math.inf), (2.0, 0.5, 3.0))
BALL = ControlSet("ball", radius=1.5)
FREE = ControlSet("free", (-math.inf,) * 3, (math.inf,) * 3)
SWITCHING = ControlSet("box", (-1.0, 0.0), (2.0, 3.0)).regularised(0.25, 0.5)
ALL = {"box": BOX, "ball": BALL, "free": FREE, "no cost": replace(FREE, kind=None), "switching": SWITCHING}


def drawn(of: ControlSet, count: int = 200) -> np.ndarray:
    return np.random.default_rng(3).normal(scale=2.0, size=(len(of.lower) or 3, count))


def test_generated_functions_take_bounds_then_what_regularises() -> None:
    assert BOX.arguments == (-1.0, 0.5, -math.inf, 2.0, 0.5, 3.0)
    assert SWITCHING.arguments == (-1.0, 0.0, 2.0, 3.0, 0.25, 0.5)
    assert BALL.arguments == (1.5,)
    assert FREE.arguments == ()


@pytest.mark.parametrize("name", ["polar_orbit", "polar_orbit_ball", "double_integrator_fuel", "saddle"])
def test_the_tuple_is_read_as_it_is_written(name: str) -> None:
    spec = kernels.load(name).spec
    m = len(spec.controls)
    of = ControlSet.of(spec, tuple(map(float, range(-m, 0))), tuple(map(float, range(1, m + 1))), 7.0)
    again = ControlSet.from_arguments(spec, of.arguments)
    assert again.arguments == of.arguments
    assert (again.kind, again.smoothing, again.fraction) == (of.kind, UNSMOOTHED if spec.switching else 0.0, 1.0)


def test_an_instance_knows_its_set() -> None:
    case = instance.load("return-to-orbit")
    assert case.control_set == ControlSet("box", case.lower, case.upper)
    assert replace(case, lower=(-9.0, -9.0)).control_set.lower == (-9.0, -9.0)
    ball = instance.load("return-to-orbit-ball")
    assert ball.control_set.arguments == (ball.max_norm,)


@pytest.mark.parametrize("name", ALL)
def test_relaxed_bounds_lie_outside_by_as_much_and_nothing_else_changes(name: str) -> None:
    of = ALL[name]
    there = of.relaxed(0.25)
    u = drawn(of)
    assert there.violation(u) == (pytest.approx(of.violation(u) - 0.25) if of.arguments else -math.inf)
    assert (there.kind, there.smoothing, there.fraction) == (of.kind, of.smoothing, of.fraction)
    assert of.relaxed(math.inf) == of.without_bounds
    assert (of.without_bounds.project(u) == u).all()
    assert not of.without_bounds.bounded
    assert of.bounded == bool(of.arguments)


@pytest.mark.parametrize("name", ALL)
def test_projection_is_the_nearest_of_all_admissible_controls(name: str) -> None:
    of = ALL[name]
    u = drawn(of)
    near = of.project(u)
    assert of.violation(near) <= 1e-15 or not of.arguments
    for other in (of.project(np.roll(u, shift, axis=1)) for shift in range(1, u.shape[1])):  # admissible ones
        assert (np.linalg.norm(u - near, axis=0) <= np.linalg.norm(u - other, axis=0) + 1e-12).all()
    one = of.nearest()
    assert pytest.approx(near, abs=1e-15) == np.array([one(column) for column in u.T.tolist()]).T


@pytest.mark.parametrize("name", ALL)
def test_what_saturates_a_control_is_the_bound_that_it_exceeds(name: str) -> None:
    of = ALL[name]
    u = drawn(of)
    active, moved = of.active(u), np.sign(u - of.project(u))
    if of.kind == "ball":
        assert (active == (np.abs(moved).max(axis=0) > 0)).all()
    else:
        assert (active == moved).all()
        assert not of.active(of.project(u)).any(), "a control on its bound exceeds nothing"


def test_a_saturated_set_has_one_control_and_rest_is_that_of_least_magnitude() -> None:
    assert BOX.rest == (0.0, 0.5, 0.0)
    assert SWITCHING.rest == (0.0, 0.0)
    only = SWITCHING.saturated((1.0, 2.0))
    assert only.arguments == (1.0, 2.0, 1.0, 2.0, 0.25, 0.5)
    assert (only.project(drawn(only)) == [[1.0], [2.0]]).all()


def test_a_set_that_was_used_goes_to_another_process() -> None:
    for of in ALL.values():
        of.project(drawn(of)), of.nearest(), of.without_bounds, of.arguments
        assert pickle.loads(pickle.dumps(of)) == of


def test_the_minimum_norm_of_a_throttled_vector_comes_last() -> None:
    case = instance.load("transfer-fuel")
    ((least, largest),) = case.model.spec.rings
    arguments = case.control_set.arguments
    assert (least, largest) == (len(arguments) - 1, 0)
    assert arguments[least] == 0.0 < arguments[largest] < math.inf
