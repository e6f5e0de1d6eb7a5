"""Equilibria of a gyrostat in orbit: exact counts, an independent search, and what the motion itself says of each."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.spatial.transform import Rotation

from satsym import kernels
from satsym.symbolic.equilibria.attitude import Kind, all_of, continuum
from satsym.symbolic.equilibria.momenta import follow
from satsym.symbolic.equilibria.real_roots import solve
from satsym.symbolic.lookup import library

X, Y = sp.symbols("x y", real=True)


@cache
def gyrostat():
    derivation = library.derivation("gyrostat")
    return derivation.model.rest(derivation)


def numbers(I_x, I_y, I_z, h, w0=1):
    known = {"I_x": I_x, "I_y": I_y, "I_z": I_z, "h": h, "w0": w0}
    rest = gyrostat()
    letters = (rest.inertia.free_symbols | rest.torque.free_symbols) - {*rest.cosines, *rest.turns}
    return {s: sp.Rational(known[s.name]) for s in letters}


@pytest.mark.parametrize(
    ("equations", "real", "complex_"),
    [
        ([X**2 + Y**2 - 1, X - Y], 2, 2),
        ([X**2 + 1, Y - X], 0, 2),
        ([X**3 - X, Y**2 - X], 3, 5),  # one double
        ([(X - 1) ** 2, Y], 1, 1),
        ([X**4 - 10 * X**2 + 1, Y - X], 4, 4),
        ([X, X - 1, Y], 0, 0),
    ],
)
def test_real_and_complex_solutions_are_counted_exactly(equations, real, complex_):
    found = solve(equations, [X, Y])
    assert (found.real, found.complex) == (real, complex_)
    assert len(found.points) == real


def test_what_is_not_finite_has_a_dimension():
    assert solve([X * Y], [X, Y]).dimension == 1


def searched(inertias, h):
    """Equilibria by Newton's method from many attitudes, written down by hand; the angular velocity is -b."""
    moments, h = np.array(inertias, float), np.array([0.0, -h, 0.0])

    def torque(a):
        b, c = a[:, 1], a[:, 2]
        return np.cross(b, -moments * b + h) + 3 * np.cross(c, moments * c)

    def turned(a, turn):
        return a - np.cross(turn[:, None], a)

    a = Rotation.random(1500, random_state=2).as_matrix()
    for _ in range(60):
        nudges = 1e-6 * np.eye(3)
        slope = np.stack([(torque(turned(a, n[None])) - torque(turned(a, -n[None]))) / 2e-6 for n in nudges], axis=-1)
        step = -(np.linalg.pinv(slope, rcond=1e-9) @ torque(a)[..., None])[..., 0]
        step /= np.maximum(1.0, 4 * np.linalg.norm(step, axis=1))[:, None]
        u, _, v = np.linalg.svd(turned(a, step))
        a = u @ v
    kept = []
    for each in a[np.abs(torque(a)).max(axis=1) < 1e-9]:
        if all(np.abs(each - other).max() > 1e-4 for other in kept):
            kept.append(each)
    return kept


@pytest.mark.slow
@pytest.mark.parametrize(("h", "count"), [("1/2", 24), ("5/2", 16), ("5", 8)])
def test_a_gyrostat_of_inertias_3_2_1_has_24_then_16_then_8_equilibria(h, count):
    found, equilibria = all_of(gyrostat().at(numbers(3, 2, 1, h)))
    assert (found.real, found.complex, len(equilibria)) == (count, 24, count)


@pytest.mark.slow
@pytest.mark.parametrize("h", ["1/2", "5/2", "5"])
def test_an_independent_search_finds_the_same_equilibria(h):
    _, equilibria = all_of(gyrostat().at(numbers(3, 2, 1, h)))
    others = searched((3, 2, 1), float(sp.Rational(h)))
    assert len(others) == len(equilibria)
    for other in others:
        assert min(np.abs(other - each.cosines).max() for each in equilibria) < 1e-6


@pytest.mark.slow
def test_each_is_an_equilibrium_of_the_motion_with_those_eigenvalues():
    model, p = kernels.load("gyrostat"), (3.0, 2.0, 1.0, 1.0, 2.9)
    _, equilibria = all_of(gyrostat().at(numbers(3, 2, 1, "29/10")))
    kinds = set()
    for each in equilibria:
        if abs(each.cosines[2, 1]) > 0.999 or abs(each.cosines[1, 1]) + abs(each.cosines[0, 1]) < 1e-3:
            continue  # a roll of a quarter turn, which the angles do not know
        a = each.cosines.T  # third * second * first
        phi, psi, theta = np.arcsin(a[1, 2]), np.arctan2(-a[1, 0], a[1, 1]), np.arctan2(-a[0, 2], a[2, 2])
        x = [phi, psi, theta, *(-each.cosines[1])]
        assert np.abs(model.dynamics(0.0, x, (0.0, 0.0), p)).max() < 1e-12
        found = np.linalg.eigvals(np.reshape(model.jacobian_x(0.0, x, (0.0, 0.0), p), (6, 6)))
        for value in each.eigenvalues:
            assert np.abs(found - value).min() < 1e-5
        assert (found.real.max() > 1e-4) == (each.kind is Kind.UNSTABLE)
        kinds.add(each.kind)
    assert kinds == {Kind.STABLE, Kind.GYROSCOPIC, Kind.UNSTABLE}


@pytest.mark.slow
def test_number_and_stability_change_in_brackets_about_one_and_four():
    letters = {s: v for s, v in numbers(3, 2, 1, 0).items() if s.name != "h"}
    changes = follow(gyrostat(), letters, 2.0).changes
    assert [c.counts for c in changes] == [(24, 16), (16, 16), (16, 8)]
    for change, value in zip(changes, (1.0, None, 4.0), strict=True):
        assert change.above - change.below < 1e-4
        assert value is None or change.below < value < change.above
        assert change.kinds[0] != change.kinds[1]


@pytest.mark.parametrize(("h", "circles"), [("9.4247784", 2), ("0", 6)])
def test_where_two_inertias_coincide_there_is_a_continuum_of_circles(h, circles):
    rest = gyrostat().at(numbers(1356, 678, 1356, h, "7.26e-5"))
    found, _ = all_of(rest)
    assert (found.dimension, found.real) == (1, None)
    whole = continuum(rest, found.dimension)
    assert whole.axis == 1
    torque = sp.lambdify(list(rest.cosines), rest.equations)
    for each in whole.circles:
        for angle in (0.4, 2.0):  # turned about the body's y it still rests
            c, s = np.cos(angle), np.sin(angle)
            turned = each.cosines @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])
            assert np.abs(torque(*turned.ravel())).max() < 1e-12 * 9.5
    assert len(whole.circles) == circles
