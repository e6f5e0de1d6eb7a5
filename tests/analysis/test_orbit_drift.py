"""Energy over many revolutions: bounded where the integrator is symplectic, a straight line where it is RK4."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from satsym import instance
from satsym.status import BadInput
from tests.bench import orbit_drift as drifts
from tests.bench.orbit_drift import CLOSED_FORM, INTEGRATORS, Drift, drift
from tests.support.cases import shipped

REVOLUTIONS = 100.0
EVALUATIONS = 550


@pytest.fixture(scope="module")
def found() -> dict[str, Drift]:
    return drift(instance.load("molniya"), REVOLUTIONS, EVALUATIONS, {k: INTEGRATORS[k] for k in ("RK4", "symplectic")})


def test_the_energy_of_rk4_leaves_in_a_line_and_that_of_the_symplectic_method_swings(found: dict[str, Drift]):
    rk4, symplectic = found["RK4"], found["symplectic"]
    assert abs(rk4.trend) >= 20.0 * rk4.swing
    assert abs(symplectic.trend) <= 0.2 * symplectic.swing
    assert np.abs(symplectic.energy).max() <= 1e-3 * np.abs(rk4.energy).max()


def test_what_the_symplectic_method_swings_by_does_not_grow_with_time(found: dict[str, Drift]):
    energy = np.abs(found["symplectic"].energy[1:])
    early, late = np.split(energy[: len(energy) // 2 * 2], 2)
    assert late.max() <= 1.2 * early.max()
    halves = np.split(np.abs(found["RK4"].energy[1:97]), 2)
    assert halves[1].max() >= 1.8 * halves[0].max()


def test_kicks_and_drifts_keep_the_angular_momentum_to_rounding_and_rk4_does_not(found: dict[str, Drift]):
    assert found["symplectic"].momentum.max() <= 1e-12
    assert found["RK4"].momentum.max() >= 1e-4


def test_half_the_step_leaves_a_64th_of_the_swing():
    earth, only = instance.load("itb-earth"), {"symplectic": INTEGRATORS["symplectic"]}
    # a sample each quarter of a revolution, in four steps and in eight
    coarse, fine = (drift(earth, 24.25, work, only)["symplectic"] for work in (170, 345))
    assert 64.0 * 0.7 <= coarse.swing / fine.swing <= 64.0 * 1.5


def test_the_closed_form_keeps_all_to_rounding(found: dict[str, Drift]):
    kept = found[CLOSED_FORM]
    assert np.abs(kept.energy).max() <= 1e-13
    assert kept.momentum.max() <= 1e-13
    assert kept.position.max() <= 1e-9


def test_dop853_is_as_good_as_its_tolerance():
    only = {"DOP853": INTEGRATORS["DOP853"]}
    run = drift(instance.load("itb-earth"), 3.0, EVALUATIONS, only, samples=7)["DOP853"]
    assert np.abs(run.energy).max() <= 1e-10
    assert run.position.max() <= 1e-9


def test_dop853_starts_afresh_where_one_run_would_take_too_many_evaluations(monkeypatch: pytest.MonkeyPatch):
    earth = instance.load("itb-earth")
    whole = drifts.by_dop853(earth, 3e7, 100)
    monkeypatch.setattr(drifts.closed_loop, "MOST_EVALUATIONS", 2000)
    assert np.allclose(drifts.by_dop853(earth, 3e7, 3000), whole, rtol=1e-10)


def test_compiled_code_drifts_alike(found: dict[str, Drift]):
    pytest.importorskip("numba")
    case = instance.load("molniya")
    compiled = replace(case, model=case.model.compiled())
    fast = drift(compiled, REVOLUTIONS, EVALUATIONS, {"RK4": INTEGRATORS["RK4"]})
    assert np.allclose(fast["RK4"].energy, found["RK4"].energy, rtol=1e-6, atol=1e-12)
    by = INTEGRATORS["DOP853"]
    assert np.allclose(by(compiled, 3e4, 100), by(case, 3e4, 100), rtol=1e-10, atol=1e-9)


def test_what_has_no_revolutions_is_refused():
    with pytest.raises(BadInput, match=r"^itb-earth-escape: not an ellipse"):
        drift(instance.load("itb-earth-escape"), 1.0)
    with pytest.raises(BadInput, match=r"^uny-lqr: its motion is not Kepler's"):
        drift(shipped("uny-lqr"), 1.0)
