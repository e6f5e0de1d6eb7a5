"""Bounds that give way: a soft problem is one of optimal control itself, and its derivatives are exact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from satsym import instance
from satsym.instance import Instance
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.soft_bounds import within_bounds
from satsym.solvers.collocation.attempt import Reason
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.iteration import Limits

BOX, BALL = "return-to-orbit-005", "return-to-orbit-ball"
FOREVER = float("inf")


def problem(name: str) -> tuple[Instance, TwoPoint]:
    case = replace(instance.load(name), t0=0.5, tf=6.0)
    assert case.tf is not None
    return case, two_point(case, case.tf - case.t0)


def places(of: TwoPoint) -> tuple[np.ndarray, np.ndarray]:
    """Times, and states and costates large enough for every bound to be met somewhere."""
    rng = np.random.default_rng(3)
    z = rng.uniform(-4.0, 4.0, (2 * of.states, 40))
    z[list(of.positive)] = rng.uniform(0.5, 2.0, (len(of.positive), 40))
    return np.linspace(0.0, 1.0, 40), z


@pytest.mark.parametrize("name", [BOX, BALL])
@pytest.mark.parametrize("softness", [0.0, 0.03, 0.5, 1.0])
def test_motion_and_costates_follow_the_control_that_exceeds_its_bounds_by_a_share(name: str, softness: float) -> None:
    case, hard = problem(name)
    (tau, z), model, p = places(hard), case.model, case.parameters
    t, both = case.t0 + hard.duration * tau, z * hard.scale.both
    x, lam = both[: hard.states], both[hard.states :]
    free = np.asarray(model.control_law_batch(t, x, lam, p, case.control_set.without_bounds.arguments))
    within = case.control_set.project(free)
    assert np.abs(free - within).max() > 0.0
    u = within + softness * (free - within)
    rates = np.concatenate([model.dynamics_batch(t, x, u, p), model.costate_rate_batch(t, x, u, lam, p)])
    soft = hard.softened(softness)
    np.testing.assert_allclose(soft.rates(tau, z, soft.theta), rates / hard.scale.both, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize("name", [BOX, BALL])
def test_derivatives_are_those_of_the_soft_motion(name: str) -> None:
    _, hard = problem(name)
    soft, (tau, z), step = hard.softened(0.2), places(hard), 1e-6
    slopes = soft.jacobian(tau, z, soft.theta)
    for k in range(len(z)):
        moved = np.zeros_like(z)
        moved[k] = step
        found = (soft.rates(tau, z + moved, soft.theta) - soft.rates(tau, z - moved, soft.theta)) / (2.0 * step)
        np.testing.assert_allclose(slopes[:, k], found, rtol=1e-5, atol=1e-5 * np.abs(slopes).max())


@pytest.mark.parametrize("name", [BOX, BALL])
def test_the_law_minimises_the_soft_hamiltonian(name: str) -> None:
    """With what exceeding costs, k |u - v|^2 c / 2 with k = 1/softness - 1 and v the nearest admissible control."""
    case, hard = problem(name)
    softness, (tau, z), model, p = 0.1, places(hard), case.model, case.parameters
    t, both = case.t0 + hard.duration * tau, z * hard.scale.both
    x, lam = both[: hard.states], both[hard.states :]
    free = np.asarray(model.control_law_batch(t, x, lam, p, case.control_set.without_bounds.arguments))
    within = case.control_set.project(free)
    weight = np.einsum("iik->ik", np.asarray(model.control_hessian_batch(t, x, free, lam, p)))

    def soft(u: np.ndarray) -> np.ndarray:
        over = u - case.control_set.project(u)
        return np.asarray(model.hamiltonian_batch(t, x, u, lam, p)) + (1.0 / softness - 1.0) / 2.0 * (
            weight * over**2
        ).sum(axis=0)

    least = soft(within + softness * (free - within))
    rng = np.random.default_rng(0)
    for _ in range(30):
        other = within + softness * (free - within) + 10.0 ** rng.uniform(-4, 1) * rng.normal(size=free.shape)
        assert (soft(other) >= least - 1e-9 * np.abs(least)).all()
    running = hard.softened(softness).running_cost(tau, z, hard.theta) * hard.scale.cost
    motion = (lam * model.dynamics_batch(t, x, within + softness * (free - within), p)).sum(axis=0)
    np.testing.assert_allclose(running + motion, least, rtol=1e-9, atol=1e-9)


def test_bounds_that_cannot_be_kept_are_blocked_and_others_are_kept() -> None:
    for size, blocked in ((0.05, False), (0.004, True)):
        case = replace(instance.load("return-to-orbit"), lower=(-size,) * 2, upper=(size,) * 2)
        assert case.tf is not None
        of = two_point(case, case.tf - case.t0)
        with np.errstate(all="ignore"):
            found = within_bounds(of, paths.first(of), Limits(200, FOREVER))
        assert (found.reason is Reason.COSTLY) is blocked
        assert found.solved is not blocked
        if found.solved:
            tau = np.linspace(0.0, 1.0, 400)
            u = of.control(tau, found.curve(tau), of.theta)
            assert np.abs(u).max() == pytest.approx(size, rel=1e-12)
