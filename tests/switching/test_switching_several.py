"""A problem with three extremals, all known: two minima, one of them cheaper, and between them no minimum at all."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sympy import Integer

from satsym import solvers as solve
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.certificate import certify
from tests.switching.test_switching_models import assert_certified, case, problem, v, x, y

END = 2.0
FAR_AND_FAST = replace(problem("far_and_fast", {x: y, y: v}, Integer(0), ("v",)), terminal_cost=-x - y**2)
"""From rest, with |v| <= 1 and two units of time: as far and as fast as possible, in either direction.

Along v = +1 up to s and -1 from there the end is x = 4 s - s**2 - 2, y = 2 s - 2. The costate of y, which decides on v,
is -2 y(end) - (2 - t); at s it vanishes for s = 2/3 only, and there J''(s) = -6.
"""


@pytest.fixture(scope="module")
def instance(tmp_path_factory: pytest.TempPathFactory) -> Instance:
    folder: Path = tmp_path_factory.mktemp("several")
    return case(folder, FAR_AND_FAST, (0.0, 0.0), None, str(END))


def extremal(instance: Instance, switch: float) -> Solution:
    """The exact motion with v = 1 up to a time and v = -1 from there, and the costates that belong to its end."""
    inside = 0.0 < switch < END
    t = np.linspace(0.0, END, 101)
    if inside:
        t = np.sort(np.append(t[np.abs(t - switch) > 1e-9], [switch, switch]))
    u = np.where(t < switch, 1.0, -1.0)
    if inside:
        u[np.flatnonzero(t == switch)[-1]] = -1.0
        u[np.flatnonzero(t == switch)[0]] = 1.0
    late = np.maximum(t - switch, 0.0)
    speed, place = t - 2.0 * late, t**2 / 2.0 - late**2
    return replace(
        solve.solve(instance),
        times=t,
        x=np.array([place, speed]),
        u=u[None],
        lam=np.array([-np.ones_like(t), -2.0 * speed[-1] - (END - t)]),
        objective=-place[-1] - speed[-1] ** 2,
        switching_times=((switch,) if inside else (),),
        certificate=None,
    )


def failed(solution: Solution) -> set[str]:
    """What keeps an extremal from being certified; it must be one."""
    certificate = certify(solution)
    assert certificate is not None
    assert certificate.verdict == "extremal only", certificate.checks
    return {check.name for check in certificate.checks if not check.passed}


def test_the_cheapest_of_several_minima_is_found(instance: Instance):
    found = solve.solve(instance)
    assert found.objective == pytest.approx(-6.0, abs=1e-12)
    assert found.switching_times == ((),)
    assert_certified(found)


def test_a_minimum_is_not_certified_where_another_start_leads_to_a_cheaper_one(instance: Instance):
    assert failed(extremal(instance, 0.0)) == {"cheaper by: seeded starts"}


def test_an_extremal_that_is_no_minimum_is_shown_to_be_none(instance: Instance):
    """By the second variation, and by other starts."""
    expected = {"second variation with respect to the switching times", "cheaper by: seeded starts"}
    assert failed(extremal(instance, 2.0 / 3.0)) == expected


@pytest.mark.parametrize("switch", [0.5, 1.0])
def test_motions_that_do_not_minimise_h_are_no_extremals(instance: Instance, switch: float):
    certificate = certify(extremal(instance, switch))
    assert certificate is not None
    assert certificate.verdict == "failed"
