"""The picture of the iterations: they lead to the answer, whatever other problems were solved before it."""

from __future__ import annotations

import re

import numpy as np
import pytest

from satsym import instance
from satsym.report import display
from satsym.report.plots import style
from satsym.report.plots.pages import convergence
from satsym.report.plots.scene import Scene
from satsym.solution import Solution
from tests.support.solved import solve

IN_ARCS = [name for name in instance.shipped() if instance.load(name).model.spec.in_arcs]
"""With path constraints, or points on the way: the problem without these is solved first, and costs less."""

SWITCHING = ["double-integrator-fuel", "goddard"]


def title(solution: Solution) -> str:
    """What stands above the costs."""
    with style.applied():
        page = convergence(Scene.of(solution))
    assert page is not None
    return str(page.axes[0].get_title("left"))


@pytest.mark.slow
@pytest.mark.parametrize("name", [*IN_ARCS, *SWITCHING])
def test_iterations_end_at_the_cost_of_the_answer_and_the_picture_says_it(name: str) -> None:
    solution = solve(instance.load(name), examined=False)
    assert solution.status.answered
    last = solution.history[-1]
    assert last.objective == pytest.approx(solution.objective, rel=1e-9)
    assert last.residual < 1e-6
    spec = solution.instance.model.spec
    final = display.number(spec.objective(solution.objective), 10)
    assert re.search(r"final (?:cost|objective) (\S+)", title(solution))[1] == final


def test_a_constraint_that_is_active_shows_in_the_iterations() -> None:
    solution = solve(instance.load("bryson-denham"), examined=False)
    costs = np.array([one.objective for one in solution.history])
    assert solution.objective == pytest.approx(4.0, rel=1e-9)  # 4 / (9 l) of l = 1/9; Bryson and Ho, 3.11
    assert costs[-1] == pytest.approx(solution.objective)
    assert (np.abs(costs[-4:] - 4.0) < 0.01).all(), "with the constraint, not the 2 without it"
    assert solution.iterations == len(solution.history)
