"""Enclosures hold the closed forms of shipped problems."""

from __future__ import annotations

from functools import cache

import mpmath
import pytest

from satsym import instance, solvers
from satsym.proof.proving import prove
from satsym.proof.record import Enclosure, Outcome, Proof


@cache
def proved(name: str, digits: int = 25) -> Proof:
    case = instance.load(name)
    return prove(case, lambda: solvers.solve(case), digits)


def holds(found: Enclosure | None, exact: mpmath.mpf) -> bool:
    assert found is not None
    return abs(mpmath.mpf(found.centre) - exact) <= mpmath.mpf(found.radius) < mpmath.mpf(10) ** -20 * abs(exact)


@pytest.fixture(autouse=True)
def digits() -> None:
    mpmath.mp.dps = 40


def test_a_body_on_a_line_is_brought_to_rest() -> None:
    """In least time 2, at least |u| in time 3 for 3 - sqrt(5), at least energy in 9/4 for 9/8 - sqrt(51)/12."""
    exact = {
        "double-integrator-time": mpmath.mpf(2),
        "double-integrator-fuel": 3 - mpmath.sqrt(5),
        "double-integrator-energy": mpmath.mpf(9) / 8 - mpmath.sqrt(51) / 12,
    }
    for name, value in exact.items():
        assert proved(name).status is Outcome.PROVED
        assert holds(proved(name).objective, value), name
    switch = proved("double-integrator-time").switching_times
    assert len(switch) == 1
    assert holds(switch[0], mpmath.mpf(1))
    first, second = proved("double-integrator-energy").switching_times
    half = mpmath.sqrt(51) / 8
    assert holds(first, mpmath.mpf(9) / 8 - half)
    assert holds(second, mpmath.mpf(9) / 8 + half)


def test_least_time_of_a_pitch_manoeuvre_goes_with_the_root_of_the_torque() -> None:
    slow, quick = proved("lapan-minimum-time"), proved("lapan-minimum-time-100s")
    assert slow.status is quick.status is Outcome.PROVED
    assert holds(quick.objective, mpmath.mpf(100))
    assert holds(slow.objective, 200 / mpmath.sqrt(3))


def test_a_wall_is_kept_at_least_cost() -> None:
    """4/(9 l) with the wall at l < 1/6, which is entered at 3 l."""
    for name, wall, factor in (("bryson-denham", "0.1111111111111111", 1), ("breakwell", "0.1", 1), ("beam", "0.1", 2)):
        proof, level = proved(name), mpmath.mpf(wall)
        assert proof.status is Outcome.PROVED
        assert holds(proof.objective, factor * 4 / (9 * level)), name
        assert holds(proof.switching_times[0], 3 * level)
        assert proof.theorem is not None
        assert "global" in proof.theorem.claims[-1]


@pytest.mark.slow
def test_a_limit_of_the_control_by_the_state_is_kept_and_its_cost_found() -> None:
    """The optimum is that of SciPy's integrator with a root finder, in tests/bench/optima.toml, to its digits."""
    proof = proved("rayleigh-mixed")
    assert proof.status is Outcome.PROVED
    assert len(proof.switching_times) == 3
    assert proof.objective is not None
    assert float(proof.objective.centre) == pytest.approx(44.804444908361, rel=1e-13)


def test_where_nothing_is_asked_of_the_end_doing_nothing_is_best() -> None:
    case = instance.load("its-thesis")
    proof = prove(case, lambda: pytest.fail("nothing need be solved"))
    assert proof.status is Outcome.PROVED
    assert proof.objective == Enclosure("0", "0")
    assert float(proof.x_final["r"].centre) == pytest.approx(25.0, abs=0.6)  # on its parabola, as the README says


@pytest.mark.slow
def test_the_brachistochrone_is_a_cycloid() -> None:
    proof = proved("brachistochrone")
    assert proof.status is Outcome.PROVED
    angle = mpmath.findroot(lambda a: (a - mpmath.sin(a)) / (1 - mpmath.cos(a)) - 2, 3.5)
    radius = 5 / (1 - mpmath.cos(angle))
    assert holds(proof.objective, angle * mpmath.sqrt(radius / mpmath.mpf("9.80665")))


def test_a_linear_problem_with_a_convex_cost_is_proved_globally() -> None:
    theorem = proved("double-integrator-energy").theorem
    assert theorem is not None
    assert any("global" in claim for claim in theorem.claims)
    other = proved("brachistochrone").theorem
    assert other is not None
    assert not any("global" in claim for claim in other.claims)
