"""Hill's equations: exact spectrum, the equations of clohessy_wiltshire in the plane, and real neighbouring orbits."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from satsym import kernels
from satsym.symbolic import Derivation, loader, symbols_of, t
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.analysis import analyse
from satsym.symbolic.linear.matrices import system_of
from satsym.symbolic.lookup import library
from satsym.symbolic.motion import central_force

(HILL,) = loader.load(loader.find("hill"))
(PLANE,) = loader.load(loader.find("clohessy_wiltshire"))
sigma, omega = symbols_of(HILL.parameters)
IN_PLANE, OUT_OF_PLANE = [0, 3, 1, 4], [2, 5]
"""Places of xi, xi', eta, eta', in the order of clohessy_wiltshire, and of zeta, zeta'."""


@pytest.fixture(scope="module")
def hill() -> Derivation:
    return library.derivation("hill")


@pytest.mark.slow
def test_equations_are_those_of_the_textbook(hill: Derivation) -> None:
    """Clohessy and Wiltshire 1960; Curtis, Orbital Mechanics for Engineering Students, 7.4."""
    xi, _eta, zeta, xi_dot, eta_dot, _zeta_dot = symbols_of(HILL.states)
    u1, u2, u3 = symbols_of(HILL.controls)
    expected = [
        3 * omega**2 * xi + 2 * omega * eta_dot + u1,
        -2 * omega * xi_dot + u2,
        -(omega**2) * zeta + u3,
    ]
    assert all(sp.expand(a - b) == 0 for a, b in zip(hill.rhs("first_order")[3:], expected, strict=True))


@pytest.mark.slow
def test_reference_is_a_motion_exactly_for_keplers_third_law(hill: Derivation) -> None:
    assert hill.equation("reference_condition.mu").rhs == sigma**3 * omega**2


def test_spectrum_is_exact(hill: Derivation) -> None:
    """Zero is double with one eigenvector, the along-track drift; the frequencies are double with two each."""
    found = analyse(system_of(hill))
    blocks = {e.value: (e.algebraic, e.blocks) for e in found.eigenvalues}
    assert blocks == {
        sp.Integer(0): (2, (2,)),
        sp.I * omega: (2, (1, 1)),
        -sp.I * omega: (2, (1, 1)),
    }
    assert (found.stability.verdict, found.stability.block) == ("unstable", 2)


@pytest.mark.parametrize("values", [(1.0, 1.0), (1.3, 0.7), (42164.0, 7.292e-5)])
def test_in_the_plane_these_are_the_clohessy_wiltshire_equations(hill: Derivation, values: tuple[float, float]) -> None:
    """Up to the change of variables from polar to turning Cartesian axes, to first order."""
    x1, x2, x3, x4 = symbols_of(PLANE.states)
    distance, angle = sigma + x1, x3 / sigma
    velocity, rate = x2, x4 / sigma + omega
    outward, ahead = distance * sp.cos(angle), distance * sp.sin(angle)
    # the velocity in axes that turn with omega, from that in polar coordinates
    turning = rate - omega
    exact = sp.Matrix(
        [
            outward - sigma,
            velocity * sp.cos(angle) - distance * turning * sp.sin(angle),
            ahead,
            velocity * sp.sin(angle) + distance * turning * sp.cos(angle),
        ]
    )
    zero = dict.fromkeys((x1, x2, x3, x4), 0)
    change = exact.jacobian([x1, x2, x3, x4]).subs(zero)
    assert exact.subs(zero).is_zero_matrix
    change = np.array(change.subs(dict(zip((sigma, omega), values, strict=True))), dtype=float)
    whole, flat = kernels.load("hill"), kernels.load("clohessy_wiltshire")
    a, b = (np.reshape(f(0.0, values), (6, -1)) for f in (whole.state_matrix, whole.input_matrix))
    flat_a, flat_b = (np.reshape(f(0.0, values), (4, -1)) for f in (flat.state_matrix, flat.input_matrix))
    np.testing.assert_allclose(a[np.ix_(IN_PLANE, IN_PLANE)], change @ flat_a @ np.linalg.inv(change), rtol=1e-14)
    np.testing.assert_allclose(b[np.ix_(IN_PLANE, [0, 1])], change @ flat_b, rtol=1e-14)


def test_plane_and_normal_go_their_own_ways(hill: Derivation) -> None:
    whole = system_of(hill)
    assert whole.a.extract(IN_PLANE, OUT_OF_PLANE).is_zero_matrix
    assert whole.a.extract(OUT_OF_PLANE, IN_PLANE).is_zero_matrix
    assert whole.b.extract(OUT_OF_PLANE, [0, 1]).is_zero_matrix
    found = analyse(system_of(hill))
    assert {name: reach.rank for name, reach in found.by_input.items()} == {"u1": 3, "u2": 4, "u3": 2}


def inertial(deviation: np.ndarray, radius: float, rate: float, time: float) -> np.ndarray:
    """Position and velocity along inertial axes of a deviation in the turning ones, by the textbook."""
    cosine, sine = np.cos(rate * time), np.sin(rate * time)
    axes = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    place = np.add(deviation[:3], [radius, 0.0, 0.0])
    return np.concatenate([axes @ place, axes @ (deviation[3:] + np.cross([0.0, 0.0, rate], place))])


def seen(state: np.ndarray, radius: float, rate: float, time: float) -> np.ndarray:
    """The way back."""
    cosine, sine = np.cos(rate * time), np.sin(rate * time)
    axes = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    place = axes @ state[:3]
    return np.concatenate([place - [radius, 0.0, 0.0], axes @ state[3:] - np.cross([0.0, 0.0, rate], place)])


def test_neighbouring_orbits_follow_the_transition_matrix_to_second_order() -> None:
    """Simulations of the exact two-body problem: ten times the deviation, a hundred times the error."""
    radius, rate, until = 1.3, 0.7, 9.0
    mu = radius**3 * rate**2
    model = kernels.load("hill")
    transition = np.reshape(model.transition_matrix(until, (radius, rate)), (6, 6))
    direction = np.array([0.3, -0.5, 0.4, 0.2, -0.3, 0.5])

    def rates(_time: float, state: np.ndarray) -> np.ndarray:
        return np.concatenate([state[3:], -mu * state[:3] / np.linalg.norm(state[:3]) ** 3])

    errors = []
    for size in (1e-3, 1e-4):
        start = inertial(size * direction, radius, rate, 0.0)
        end = solve_ivp(rates, (0.0, until), start, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
        errors.append(np.linalg.norm(seen(end, radius, rate, until) - size * transition @ direction))
    assert 80.0 < errors[0] / errors[1] < 120.0


def test_transition_matrix_is_symplectic_in_turning_axes() -> None:
    """The velocity in inertial axes is the momentum: the transition matrix in these variables is symplectic."""
    rate = 0.7
    transition = np.reshape(kernels.load("hill").transition_matrix(9.0, (1.3, rate)), (6, 6))
    turn = rate * np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    to_momenta = np.block([[np.eye(3), np.zeros((3, 3))], [turn, np.eye(3)]])
    canonical = to_momenta @ transition @ np.linalg.inv(to_momenta)
    form = np.block([[np.zeros((3, 3)), np.eye(3)], [-np.eye(3), np.zeros((3, 3))]])
    assert np.abs(canonical.T @ form @ canonical - form).max() <= 1e-11
    assert abs(np.linalg.det(transition) - 1.0) <= 1e-11


def test_attraction_by_a_centre_is_recognised_from_turning_axes() -> None:
    """The inertial state is that of the textbook, although position and axes depend on time."""
    turning = HILL.of
    found = central_force.recognised(turning)
    assert found is not None
    column = central_force.inertial_state(turning, found.strength).xreplace(definitions_of(turning))
    function = sp.lambdify([t, *symbols_of(turning.states), sigma, omega], list(column), "numpy")
    deviation, radius, rate, time = np.array([0.1, -0.2, 0.3, 0.4, -0.5, 0.6]), 1.3, 0.7, 2.1
    at = np.add(deviation, [radius, 0.0, 0.0, 0.0, 0.0, 0.0])
    expected = [*inertial(deviation, radius, rate, time), radius**3 * rate**2]
    np.testing.assert_allclose(function(time, *at, radius, rate), expected, rtol=1e-13)
