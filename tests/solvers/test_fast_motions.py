"""Motions that the given steps are too long for: they neither blow up, nor is what blew up called converged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from satsym import instance
from satsym.analysis.linear.equilibrium import linearise
from satsym.analysis.regulator.feedback import designed, law, simulate
from satsym.instance import Instance
from satsym.solvers.simulation.batch import simulate as in_steps
from satsym.solvers.simulation.simulating import simulate as simulated
from satsym.solvers.simulation.stability import stable_steps
from satsym.status import Status


def with_steps(name: str, steps: int, tf: float) -> Instance:
    given = instance.load(name)
    return replace(given, tf=tf, solver=type(given.solver)(steps=steps))


@pytest.mark.parametrize("feedback", ["none", "lqr"])
def test_a_stiff_linear_motion_is_that_of_its_eigenvectors(feedback: str) -> None:
    given = instance.load("lapan-roll-yaw-lqr")
    assert given.tf is not None
    assert stable_steps(given, given.solver.steps, 2**20) > given.solver.steps
    A = linearise(given).system.A
    if feedback == "lqr":
        design = designed(given)
        A = A - design.regulator.system.B @ design.regulator.K
    values, vectors = np.linalg.eig(A)
    parts = np.linalg.solve(vectors, np.array(given.initial))
    expected = (vectors @ (np.exp(values * given.tf) * parts)).real
    found = simulate(given, feedback)
    assert found.status is Status.CONVERGED
    np.testing.assert_allclose(found.x[:, -1], expected, rtol=1e-6, atol=1e-15)
    assert np.abs(found.x).max() < 0.1


def test_a_law_of_any_form_gives_the_same_stiff_motion() -> None:
    given = with_steps("lapan-roll-yaw-lqr", 40, 2.0)
    design = designed(given)
    linear = law(design.about, design.regulator)
    exact, stepped = simulated(given, linear), simulated(given, replace(linear, gain=None))
    assert exact.status is stepped.status is Status.CONVERGED
    assert (np.abs(stepped.x - exact.x) / np.abs(exact.x).max(axis=1, keepdims=True)).max() < 1e-7


@pytest.mark.study
def test_a_stiff_nonlinear_motion_is_that_of_many_short_steps() -> None:
    given = with_steps("lapan-coupling", 50, 2.0)
    found = simulate(given, "none")
    assert found.feedback == "none"
    assert found.metrics["estimated_error"] < 1e-8  # the pitch angle that is excited is next to rounding
    columns = [[value] for value in given.initial]
    fine = in_steps(given.model, [0.0, 2.0], columns, given.parameters, 10_000)[:, -1, 0]
    np.testing.assert_allclose(found.x[:, -1], fine, rtol=1e-6, atol=1e-15)
