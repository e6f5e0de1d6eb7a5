"""Polynomials of a control with several local minima: laws against grids, closed forms, and what is not answered."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from sympy import Expr

from satsym.report.latex.document import render
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import Status, Verdict
from satsym.symbolic import DerivationError, derive
from tests.solvers.test_stationary import least_on_a_grid
from tests.support.models import build, q, scalar, w

WELL = (w**2 - 1) ** 2

LAWS: dict[str, tuple[Expr, tuple[float, float] | None]] = {
    "cubic_in_a_box": (w**3 / 3 - w**2, (-2.0, 3.0)),
    "double_well": (WELL, (-2.0, 2.0)),
    "double_well_without_bounds": (WELL, None),
    "ends_alone": (-(w**4), (-1.0, 2.0)),
    "quintic": (w**5 / 5 - w**3 + w / 2, (-2.5, 2.0)),
    "sextic": (w**6 - 3 * w**4 + w**3 / 3 + w**2, (-3.0, 3.0)),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LAWS)
def test_the_law_is_the_least_of_all_minimisers(tmp_path: Path, name: str) -> None:
    cost, ends = LAWS[name]
    problem = scalar(name, -q + w, cost + q**2, 0, "box" if ends else "free")
    bounds = f"[control]\nw = [{ends[0]}, {ends[1]}]\n" if ends else ""
    case = build(tmp_path, problem, f"[initial]\nq = 1.0\n[time]\ntf = 1.0\n{bounds}")
    rng, arguments, taken = np.random.default_rng(0), (case.parameters, case.control_set.arguments), []
    for lam in [0.0, *rng.normal(0.0, 3.0, 60), *rng.normal(0.0, 30.0, 60)]:
        (u,) = case.model.control_law(0.0, (1.0,), (lam,), *arguments)
        on_arrays = case.model.control_law_batch(np.zeros(1), np.ones((1, 1)), np.array([[lam]]), *arguments)
        assert u == pytest.approx(float(on_arrays[0, 0]), rel=1e-14, abs=1e-14)
        assert ends is None or ends[0] <= u <= ends[1]
        least = least_on_a_grid(case, (lam,), (1.0,), ends or (-5.0, 5.0))
        assert case.model.hamiltonian(0.0, (1.0,), (u,), (lam,), case.parameters) <= least + 1e-13 * abs(least)
        taken.append(u)
    moves = np.abs(np.diff(np.sort(taken)))
    assert moves.max() > 0.3, "somewhere it jumps"


def within(folder: Path, cost: Expr, start: float, end: float, duration: float, bounds: str = "[-2, 2]") -> Solution:
    problem = scalar("double_well", w, cost, 0, "box")
    text = f"[initial]\nq = {start}\n[final]\nq = {end}\n[time]\ntf = {duration}\n[control]\nw = {bounds}\n"
    return solve(build(folder, problem, text))


def test_beyond_both_wells_the_best_speed_is_steady(tmp_path: Path) -> None:
    """The convex hull of the double well is itself beyond one: no speed that varies is cheaper."""
    found = within(tmp_path, WELL, 0.0, 2.0, 1.0, "[-3, 3]")
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(9.0, rel=1e-12)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_a_jump_from_one_well_to_the_other_is_certified(tmp_path: Path) -> None:
    """q' = w at the cost of the double well and of q: lambda = 1 - t, and w jumps at t = 1."""
    found = within(tmp_path, WELL + q, 0.0, 0.0, 2.0)
    assert found.status is Status.CONVERGED

    def speed(t: float) -> float:
        side = 1.0 if t > 1.0 else -1.0
        return side * brentq(lambda v: 4.0 * v * (v**2 - 1.0) - abs(1.0 - t), 1.0, 2.0, xtol=1e-15)

    ways = [quad(lambda t: (speed(t) ** 2 - 1.0) ** 2 - (t - 1.0) * speed(t), *ends)[0] for ends in ((0, 1), (1, 2))]
    assert found.objective == pytest.approx(sum(ways), rel=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    ((jump, name),) = ((one.t, one.name) for one in found.events)
    assert (jump, name) == (pytest.approx(1.0, rel=1e-11), "w")


@pytest.mark.slow
def test_where_both_wells_stay_as_good_neither_is_certified(tmp_path: Path) -> None:
    """Nothing weighs where q ends: speeds of one, of minus one, and any that take turns cost nothing."""
    case = build(
        tmp_path,
        scalar("double_well", w, WELL, 0, "box"),
        "[initial]\nq = 0.0\n[time]\ntf = 1.0\n[control]\nw = [-2, 1.5]\n",
    )
    found = solve(case)
    assert found.status is Status.CONVERGED
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.EXTREMAL_ONLY
    assert [c.name for c in found.certificate.checks if not c.passed] == ["another minimiser of H remains equally good"]


@pytest.mark.slow
def test_between_the_wells_there_is_no_best_speed(tmp_path: Path) -> None:
    """Slower than one it pays to go to and fro, as often as one likes: nothing is found, and it is said why."""
    found = within(tmp_path, WELL, 0.0, 0.5, 1.0)
    assert found.status is Status.NOT_CONVERGED
    assert "several minimisers in w" in found.message
    assert "chattering" in found.message


def test_what_may_fall_for_ever_needs_bounds() -> None:
    with pytest.raises(DerivationError, match=r"several local minima, and these are not compared; choose"):
        derive(scalar("falling", -q + w, w**3 + q**2, 0, "free"))


def test_the_law_is_typeset_and_what_it_compares_is_said() -> None:
    derived = derive(scalar("double_well", -q + w, WELL + q**2, 0, "box"))
    assert {c.key for c in derived.step("control_law").conclusions} >= {"least of all minimisers"}
    assert r"\operatorname*{arg\,min}" in render(derived)
