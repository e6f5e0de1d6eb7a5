"""Summaries for terminals say a thing once, and call rounding zero."""

from __future__ import annotations

import numpy as np
import pytest

from satsym import instance as instances
from satsym.report.said import message as in_words
from satsym.report.said import spoken
from satsym.report.terminal.comparison import _without_rounding
from satsym.report.terminal.solution import solution_text, state_rows
from satsym.solution import Solution
from satsym.solvers.collocation.attempt import Reason
from satsym.status import Status

T = np.linspace(0.0, 1.0, 11)


def made(name: str, *times: tuple[float, ...]) -> Solution:
    case = instances.load(name)
    spec = case.model.spec
    x, u = np.ones((len(spec.states), len(T))), np.zeros((len(spec.controls), len(T)))
    return Solution(case, "bang-bang", Status.CONVERGED, "", 1.0, T, x, u, x, times, 1, (), 0.1)


def test_a_vector_has_its_switching_times_once() -> None:
    together = solution_text(made("transfer-fuel", (0.25, 0.5), (0.25, 0.5)))
    assert together.count("0.25, 0.5") == 1
    assert "T_r, T_t" in together
    apart = solution_text(made("transfer-fuel", (0.25, 0.5), (0.25, 0.75)))
    assert "0.25, 0.5" in apart
    assert "0.25, 0.75" in apart


def test_a_costate_that_is_nothing_beside_the_others_is_zero() -> None:
    found = made("double-integrator-fuel", ())
    lam = np.vstack([np.full(len(T), 3e-30), np.ones(len(T))])
    costates = [row[7] for row in state_rows(found.instance, T, found.x, lam)[1:]]
    assert costates == ["0", "1"]
    # with a state so large, a costate so small is worth as much as the other
    large = np.vstack([np.full(len(T), 1e30), np.ones(len(T))])
    assert [row[7] for row in state_rows(found.instance, T, large, lam)[1:]] == ["3e-30", "1"]


def test_a_final_value_that_is_nothing_beside_its_peak_is_zero() -> None:
    found = {"v_peak": [1.0, 1e-20, None], "v_final": [-3e-17, 3e-21, None], "w_final": [1e-30, 0.0, 1.0]}
    assert _without_rounding("v_final", found) == [0.0, 3e-21, None]
    assert _without_rounding("w_final", found) == found["w_final"]


@pytest.mark.parametrize("language", ["en", "id"])
def test_bounds_that_are_met_at_no_settled_times_come_with_a_way_out(language: str) -> None:
    with spoken(language):
        said = in_words(Reason.UNSETTLED.value)
    assert "--continue" in said
    assert ("do not settle" in said) == (language == "en")
