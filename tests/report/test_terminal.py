"""Summaries for terminals say a thing once, call rounding zero, and say what holds and when controls switch."""

from __future__ import annotations

import ast
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from satsym import instance as instances
from satsym import kernels
from satsym.analysis.comparison import compare
from satsym.report.said import message as in_words
from satsym.report.said import spoken
from satsym.report.terminal.arcs import in_words as arcs_in_words
from satsym.report.terminal.certificate import _HOLDS, statement, verdict_text
from satsym.report.terminal.comparison import _without_rounding, comparison_text
from satsym.report.terminal.listing import INSTANCES, MODELS, OTHER, by_subject
from satsym.report.terminal.solution import _metrics, control_rows, solution_text, state_rows
from satsym.solution import Certificate, Check, Competitors, Kind, Solution
from satsym.solvers.collocation.attempt import Reason
from satsym.status import Status, Verdict
from tests.support.said import SOURCE, tree

T = np.linspace(0.0, 1.0, 11)


def made(name: str, *times: tuple[float, ...]) -> Solution:
    case = instances.load(name)
    spec = case.model.spec
    x, u = np.ones((len(spec.states), len(T))), np.zeros((len(spec.controls), len(T)))
    return Solution(case, "bang-bang", Status.CONVERGED, "", 1.0, T, x, u, x, times, 1, (), 0.1)


def test_a_vector_has_its_arcs_once_and_they_burn_or_coast() -> None:
    together = solution_text(made("transfer-fuel", (0.25, 0.5), (0.25, 0.5)))
    assert together.count("coast from 0 to 0.25, coast from 0.25 to 0.5, coast from 0.5 to 1") == 1
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


def test_a_metric_that_is_nothing_beside_its_variable_is_zero() -> None:
    spec = SimpleNamespace(state_names=("q", "v"))
    metrics = {"q_final": 2e-17, "v_residual": 3e-19, "v_peak": 1.0, "w_final": 1e-15, "w_peak": 100.0, "steps": 3.0}
    found = SimpleNamespace(
        instance=SimpleNamespace(model=SimpleNamespace(spec=spec)),
        x=np.array([[0.0, 1e-16], [0.0, 1.0]]),
        metrics=metrics,
    )
    assert _metrics(found) == {**metrics, "v_residual": 0.0, "w_final": 0.0}


def test_an_extreme_control_that_is_nothing_beside_the_others_is_zero() -> None:
    found = made("double-integrator-energy", ())
    pushes = np.linspace(-3e-17, 2.0, len(T))[None, :]
    assert control_rows(found.instance, T, pushes)[1][1:3] == ("0", "2")


@pytest.mark.parametrize("language", ["en", "id"])
def test_bounds_that_are_met_at_no_settled_times_come_with_a_way_out(language: str) -> None:
    with spoken(language):
        said = in_words(Reason.UNSETTLED.value)
    assert "--continue" in said
    assert ("do not converge" in said) == (language == "en")


def test_a_control_that_saturates_without_a_jump_does_not_switch() -> None:
    found = made("return-to-orbit-006", (), (0.5,))
    found.u[1] = np.where(T <= 0.5, -0.06, 0.0)
    text = solution_text(replace(found, method="collocation"))
    assert "saturated:" in text
    assert "from 0 to 0.5" in text
    assert "switching times" not in text
    assert "switching times" in solution_text(found)  # a method for controls that jump


@pytest.mark.parametrize(
    ("name", "message", "said"),
    [
        ("transfer-fuel", "structure -+-, 2 switches, residual 3e-11, from the reachable set", "coast, burn, coast;"),
        ("double-integrator-fuel", "structure -0+, 2 switches, residual 3e-11, from the reachable set", "bound, zero"),
        (
            "goddard",
            "structure +s-, 2 switches, residual 3e-11, from the reachable set",
            "upper bound, singular, lower",
        ),
        (
            "reorientation",
            "structure -+ | +- | -, 2 switches, residual 3e-11, from the reachable set",
            "u1 lower bound, upper bound; u2 upper bound, lower bound; u3 lower bound;",
        ),
        ("goddard", "structure +-+-+-+-+-, 9 switches, residual 3e-11, from the reachable set", "structure +-+-+-+-+-"),
    ],
)
def test_a_structure_is_put_in_words_unless_it_is_long(name: str, message: str, said: str) -> None:
    told = arcs_in_words(made(name, ()), message)
    assert said in told
    assert re.search("residual 3e-11, (starting )?from the reachable set", told)


def test_a_comparison_says_in_which_arcs_a_control_is_as_the_solution_does() -> None:
    told = " ".join(comparison_text(compare([instances.load("double-integrator-time")])).split())
    assert "arcs: lower bound, upper bound; residual" in told
    assert "structure" not in told


def test_every_condition_that_can_hold_is_stated_as_what_holds() -> None:
    names = {
        node.args[0].value
        for path in (SOURCE / "solvers").rglob("*.py")
        for node in ast.walk(tree(path))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Check"
        if isinstance(node.args[0], ast.Constant) and not isinstance(node.args[1], ast.Constant)
    }
    assert len(names) > 30
    assert names - _HOLDS.keys() - {"second variation unknown: the control jumps between minimisers"} == {
        "another minimiser of H remains equally good",  # made only where it fails
        "waypoints that are not passed",
    }


def test_a_condition_that_fails_says_what_is_wrong() -> None:
    held, failed = (
        Check("kernels contradict each other", 1e-16, 1e-9),
        Check("kernels contradict each other", 1.0, 1e-9),
    )
    assert statement(held) == "generated kernels agree"
    assert statement(failed) == "generated kernels do not agree with each other"
    assert statement(Check("cheaper by: revolutions", 0.0, 1e-9)) == "no cheaper competitor: revolutions"
    assert statement(Check("cheaper by: revolutions", 1.0, 1e-9)) == "cheaper by: revolutions"


@pytest.mark.parametrize(
    ("verdict", "solved", "maximise", "said"),
    [
        (Verdict.CERTIFIED, 8, False, "certified (strict local minimum; none of 8 competing solutions is cheaper)"),
        (Verdict.CERTIFIED, 1, False, "certified (strict local minimum; the one competing solution is not cheaper)"),
        (Verdict.CERTIFIED, 2, True, "certified (strict local minimum; none of 2 competing solutions is better)"),
        (Verdict.CERTIFIED, 0, False, "certified (strict local minimum)"),
        (Verdict.FAILED, 8, False, "failed (an optimality condition is violated)"),
    ],
)
def test_a_verdict_says_what_it_claims(verdict: Verdict, solved: int, maximise: bool, said: str) -> None:
    compared = (Competitors(Kind.STARTS, solved, solved, 1.0),)
    found = Certificate(verdict, 0.0, 0.0, 0.0, 0.0, 1.0, None, (), compared)
    assert verdict_text(found, maximise) == said
    missing = replace(found, not_checked=(Kind.REVOLUTIONS,))
    assert verdict_text(missing, maximise) == f"{said}; not compared: other numbers of revolutions"


def test_subjects_list_nothing_that_is_not_shipped_and_nothing_twice() -> None:
    for subjects, shipped in ((INSTANCES, instances.shipped()), (MODELS, kernels.shipped())):
        listed = [name for names in subjects.values() for name in names.split()]
        assert len(set(listed)) == len(listed)
        assert set(listed) <= set(shipped)
        found = by_subject(["of_nobody", *shipped], subjects)
        assert sorted(name for names in found.values() for name in names) == sorted(["of_nobody", *shipped])
        assert "of_nobody" in found[OTHER]
