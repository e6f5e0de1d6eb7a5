"""What is measured of linear systems, their regulators and orbits, against solutions that are known in closed form."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import sympy as sp

from satsym.auditing.measurements import earth, formulas, linear, linear_motions, matrices, programs, regulators
from satsym.auditing.measurements import words as all_words
from satsym.auditing.propositions.values import Record, Undecided, numbers
from satsym.status import BadInput

M = sp.ImmutableMatrix
INTEGRATOR = Record("integrator", {"A": M([[0]]), "B": M([[1]])})
DOUBLE = Record("double integrator", {"A": M([[0, 1], [0, 0]]), "B": M([[0], [1]])})
WEIGHED, WEIGHED_DOUBLE = (
    Record(of.name, {**of.parts, "Q": np.eye(of.part("A").rows), "R": np.eye(1)}) for of in (INTEGRATOR, DOUBLE)
)
OSCILLATOR = M([[0, 1], [-1, 0]])
HALF = Record("half reached", {"A": M([[1, 0], [0, 2]]), "B": M([[1], [0]])})
DECAY = M([[-1]])


def test_motions_are_those_of_the_closed_forms() -> None:
    assert linear_motions.motion(DOUBLE, [1, 2], 3) == pytest.approx([7, 2])
    assert linear_motions.motion(OSCILLATOR, [1, 0], 2) == pytest.approx([math.cos(2), -math.sin(2)])
    path = linear_motions.trajectory(OSCILLATOR, [1, 0], 7.0)
    assert path.part("x1") == pytest.approx(np.cos(path.part("t")), abs=1e-9)
    assert path.part("size") == pytest.approx(np.ones(len(path.part("t"))))
    turn = [[-math.sin(2), math.cos(2)], [-math.cos(2), -math.sin(2)]]
    assert linear_motions.flow_rate(OSCILLATOR, 2) == pytest.approx(np.array(turn))


def test_limits_are_extrapolated() -> None:
    assert linear_motions.limit([math.expm1(2.0**-k) * 2.0**k for k in range(6, 12)]) == pytest.approx(1, abs=1e-11)
    assert linear_motions.limit([2.0**-k for k in range(6, 12)]) == pytest.approx(0, abs=1e-13)


@pytest.mark.parametrize(
    ("a", "far", "left"),
    [(DECAY, 3.0, 0.0), (OSCILLATOR, 3.0, 3.0), (M([[0]]), 3.0, 3.0), (M([[0, 1], [0, 0]]), math.inf, math.inf),
     (-DECAY, math.inf, math.inf)],
)  # fmt: skip
def test_how_far_motions_get_and_stay(a: sp.Matrix, far: float, left: float) -> None:
    assert linear_motions.farthest(a, 3.0) == pytest.approx(far)
    assert linear_motions.remaining(a, 3.0) == pytest.approx(left)


def test_inputs_bring_about_what_integrals_say() -> None:
    nodes = linear_motions.quadrature(-1, 3)
    assert sum(w * t**5 for t, w in nodes) == pytest.approx((3**6 - 1) / 6)
    decay = Record("", {"A": M([[-2]]), "B": M([[3]])})
    assert linear.gramian(decay, 0.7)[0, 0] == pytest.approx(9 * math.expm1(4 * 0.7) / 4)
    assert linear_motions.driven(INTEGRATOR, 1.5) == pytest.approx([math.sin(4.5) / 3])
    assert linear_motions.steered_to(DOUBLE, [1, -1], [0.5, 2]) == pytest.approx([0.5, 2])
    reached = linear_motions.steered_to(HALF, [1, 1], [5, 5])
    assert reached == pytest.approx([5, math.exp(2)])


def test_gains_place_what_can_be_placed() -> None:
    gain = linear_motions.placing_gain(DOUBLE, [1, 5, 6])
    assert gain.tolist() == [[-6, -5]]
    assert linear.characteristic(DOUBLE.part("A") + DOUBLE.part("B") * gain) == [1, 5, 6]
    kept = np.linalg.eigvals(numbers(HALF.part("A")) + numbers(HALF.part("B")) @ linear_motions.stabilising_gain(HALF))
    assert sorted(kept.real)[1] == pytest.approx(2)
    assert min(kept.real) < 0
    assert not linear.stabilisable(HALF)
    assert linear.stabilisable(Record("", {**HALF.parts, "A": M([[1, 0], [0, -2]])}))
    assert not linear.stabilisable(Record("", {**HALF.parts, "A": M([[1, 0], [0, 0]])}))
    assert linear.closed_loop(DOUBLE, [[6, 5]]).part("A").tolist() == [[0, 1], [-6, -5]]


def test_rouths_array_is_that_of_the_textbook() -> None:
    # Ogata, Modern Control Engineering, example 5-11
    assert linear.routh([1, 2, 3, 4, 5]) == [[1, 3, 5], [2, 4, 0], [1, 5, 0], [-6, 0, 0], [5, 0, 0]]
    assert linear.routh([1, -2, -1, 2]) == [[1, -1], [-2, 2], [0, 0]]
    a = sp.symbols("a0:4")
    assert sp.simplify(linear.routh(a)[2][0] - (a[1] * a[2] - a[0] * a[3]) / a[1]) == 0


def test_chains_make_the_jordan_form() -> None:
    a = M([[3, 1], [-1, 1]])
    found = linear.jordan(a)
    form = found.part("P").inv() * a * found.part("P")
    assert found.part("values") == [2, 2]
    assert form == M([[2, 1], [0, 2]])
    assert len(matrices.kernel(a - 2 * a.eye(2))) == 1
    assert len(matrices.kernel(M([[0, 0], [0, 0]]))) == 2


@pytest.mark.parametrize("t", [0.3, 1.0])
def test_the_regulator_of_an_integrator_is_known(t: float) -> None:
    found = regulators.regulator(WEIGHED)
    assert (found.part("K")[0, 0], found.part("P")[0, 0]) == pytest.approx((1, 1))
    for k in (0.5, 1.0, 2.0):
        assert regulators.cost(WEIGHED, [[k]], [3]) == pytest.approx(9 * (1 + k * k) / (2 * k))
    assert regulators.riccati(WEIGHED, t)[0, 0] == pytest.approx(math.tanh(t))
    assert regulators.costate(WEIGHED, [2], t) == pytest.approx([2 * math.tanh(t)])
    with pytest.raises(Undecided, match="not stable"):
        regulators.cost(WEIGHED, [[-1]], [1])


def test_the_regulator_of_a_double_integrator_is_known() -> None:
    assert regulators.regulator(WEIGHED_DOUBLE).part("K") == pytest.approx(np.array([[1, math.sqrt(3)]]))
    assert regulators.regulator(WEIGHED_DOUBLE, Q=np.diag([16, 0])).part("K") == pytest.approx(
        np.array([[4, math.sqrt(8)]])
    )
    assert np.linalg.eigvals(regulators.hamiltonian(WEIGHED, [[-1]])) == pytest.approx([1j, -1j])
    for gain in regulators.other_gains(WEIGHED_DOUBLE):
        assert np.linalg.eigvals(linear.closed_loop(DOUBLE, gain).part("A")).real.max() < 0
    with pytest.raises(Undecided):
        regulators.regulator(HALF, Q=np.eye(2), R=[[1]])
    back, solution, poles = regulators.matlab_lqr(DOUBLE.part("A"), DOUBLE.part("B"), np.eye(2), [[1]])
    assert back == pytest.approx(np.array([[1, math.sqrt(3)]]))
    assert solution[0] == pytest.approx([math.sqrt(3), 1])
    assert sum(poles) == pytest.approx(-math.sqrt(3))


@pytest.mark.parametrize("given", [{}, {"Q": np.eye(2)}, {"R": [[1]]}])
def test_weights_that_nobody_states_are_not_made_up(given: dict[str, Any]) -> None:
    with pytest.raises(BadInput, match="double integrator has no weights; give both Q and R"):
        regulators.regulator(DOUBLE, **given)


def test_matrices() -> None:
    singular = M([[1, 2], [2, 4]])
    (kept,) = matrices.kernel(singular)
    assert singular * M(kept) == pytest.approx(np.zeros((2, 1)))
    assert any(np.allclose(singular.tolist() @ v, 0) and np.linalg.norm(v) > 0.5 for v in matrices.vectors(singular))
    w = sp.Symbol("w")
    assert matrices.kernel(M([[0, w], [0, 0]])) == [M([1, 0])]
    assert matrices.inverse(M([[w]])) == M([[1 / w]])
    assert matrices.rows(singular, [2]) == M([[2, 4]])
    assert matrices.diagonal([np.eye(1), 2 * np.eye(2)]).tolist() == [[1, 0, 0], [0, 2, 0], [0, 0, 2]]


def test_rates_are_integrated() -> None:
    x, v = sp.symbols("x v")
    path = formulas.integrated([v, -x], ["x", "v"], [0, 1], 6.0)
    assert path.part("x") == pytest.approx(np.sin(path.part("t")), abs=1e-8)


def test_orbits_of_the_earth() -> None:
    ellipse = next(o for o in all_words().values["ORBITS"]() if o.part("eccentricity") == 0.4)
    ends = earth.distance_after(ellipse, 0.0).value, earth.distance_after(ellipse, 0.5).value
    assert ends == pytest.approx([ellipse.part("axis").value * (1 + k * 0.4) for k in (-1, 1)])
    along = [earth.distance_after(ellipse, k / 20).value for k in range(11)]
    assert all(one < other for one, other in pairwise(along))
    # seen from radius 2 R it is above the horizon for a third of the way
    twice = earth.circular("6378.137 km")
    assert earth.seen_latitude(twice) == pytest.approx(60)


def test_signs_and_calls_of_a_line() -> None:
    assert programs.count("plot([a[1], b)", "[") == 2


def test_the_dual_is_observed_where_the_system_is_controlled() -> None:
    whole = linear.inputs_of(linear.system("clohessy_wiltshire"), ["u1"])
    assert linear.dual(linear.dual(whole)).part("B") == whole.part("B")
    assert linear.rank(linear.observability(linear.dual(whole))) == linear.rank(linear.controllability(whole)) == 3
