"""Return to the orbit within an angular slot about the reference.

Written by satsym from derivations/examples/kept_orbit.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/kept_orbit.py
Source: ../derivations/examples/kept_orbit.py d56e2c422185465194780434dc4ab2e9
Source: ../derivations/clohessy_wiltshire.py 76e49da5527c6e0ad02437036b6b61bc
Source: ../derivations/polar_orbit.py cbc2ab9efa60b232bc9a9d755c4231e3
Digest: affaa1abe67d27a8f83b002b70ecfa65349ac377e8e9412c9a9c4bbb21f85c8f
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'return_in_slot',
    'title': 'Return to the orbit within an angular slot about the reference',
    'source': 'derivations/examples/kept_orbit.py',
    'states': (
        {'symbol': 'r', 'latex': 'r', 'unit': 'km', 'meaning': 'distance from the centre of force', 'positive': True},
        {'symbol': 'r_dot', 'latex': '\\dot r', 'unit': 'km/s', 'meaning': 'radial velocity'},
        {'symbol': 'theta', 'latex': '\\theta', 'unit': 'rad', 'meaning': 'polar angle in the inertial plane', 'kind': 'angle'},
        {'symbol': 'theta_dot', 'latex': '\\dot\\theta', 'unit': 'rad/s', 'meaning': 'angular velocity'},
    ),
    'controls': (
        {'symbol': 'u1', 'latex': 'u_1', 'unit': 'km/s**2', 'meaning': 'radial thrust per unit mass'},
        {'symbol': 'u2', 'latex': 'u_2', 'unit': 'km/s**2', 'meaning': 'transverse thrust per unit mass'},
    ),
    'parameters': (
        {'symbol': 'sigma', 'latex': '\\sigma', 'unit': 'km', 'meaning': 'radius of the reference orbit', 'default': 1.0, 'positive': True},
        {'symbol': 'omega', 'latex': '\\omega', 'unit': 'rad/s', 'meaning': 'angular velocity of the reference orbit', 'default': 1.0, 'positive': True},
        {'symbol': 'c1', 'latex': 'c_1', 'meaning': 'weight of the radial thrust', 'default': 1.0, 'positive': True},
        {'symbol': 'c2', 'latex': 'c_2', 'meaning': 'weight of the transverse thrust', 'default': 1.0, 'positive': True},
        {'symbol': 'slot', 'latex': '\\Delta', 'unit': 'rad', 'meaning': 'angular half-width of the slot', 'positive': True},
    ),
    'control_set': 'free',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': True,
    'autonomous': True,
    'invariants': (
        {'symbol': 'energy', 'latex': '\\mathcal{E}', 'unit': 'km**2/s**2'},
        {'symbol': 'angular_momentum', 'latex': '\\ell', 'unit': 'km**2/s'},
    ),
    'position': (
        {'symbol': 'x', 'latex': 'x'},
        {'symbol': 'y', 'latex': 'y'},
    ),
    'multipliers': (),
    'keplerian': True,
    'objective_unit': 'km**2/s**3',
    'path_constraints': (
        {'name': 'ahead', 'order': 2},
        {'name': 'behind', 'order': 2},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    mu = omega*omega*sigma*sigma*sigma
    return (
        r_dot,
        r*theta_dot*theta_dot + u1 - inv_r*inv_r*mu,
        theta_dot,
        inv_r*(u2 - 2.0*r_dot*theta_dot),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    mu = omega*omega*sigma*sigma*sigma
    twice_theta_dot = 2.0*theta_dot
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        2.0*inv_r*inv_r*inv_r*mu + theta_dot*theta_dot,
        0.0,
        0.0,
        r*twice_theta_dot,
        0.0,
        0.0,
        0.0,
        1.0,
        inv_r*inv_r*(r_dot*twice_theta_dot - u2),
        -inv_r*twice_theta_dot,
        0.0,
        -2.0*inv_r*r_dot,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    return (
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        inv_r,
    )


def reference(t, p):
    """The reference curve c(t)."""
    sigma, omega, c1, c2, slot = p
    return (
        sigma,
        0.0,
        omega*t,
        omega,
    )


def invariants(t, x, p):
    """What the uncontrolled motion keeps constant."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    r_sq = r*r
    mu = omega*omega*sigma*sigma*sigma
    return (
        0.5*r_dot*r_dot + 0.5*r_sq*theta_dot*theta_dot - inv_r*mu,
        r_sq*theta_dot,
    )


def position(t, x, p):
    """Inertial components of the position vector."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    return (
        r*math.cos(theta),
        r*math.sin(theta),
    )


def inertial_state(t, x, p):
    """Position and velocity along inertial axes, three numbers each, and the gravitational parameter."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    cos_theta = math.cos(theta)
    cos_theta_r = cos_theta*r
    sin_theta = math.sin(theta)
    r_sin_theta = r*sin_theta
    mu = omega*omega*sigma*sigma*sigma
    return (
        cos_theta_r,
        r_sin_theta,
        0.0,
        cos_theta*r_dot - r_sin_theta*theta_dot,
        cos_theta_r*theta_dot + r_dot*sin_theta,
        0.0,
        mu,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    return 0.5*c1*u1*u1 + 0.5*c2*u2*u2


def terminal_cost(t, x, p):
    """Terminal cost S."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    mu = omega*omega*sigma*sigma*sigma
    return 0.5*c1*u1*u1 + 0.5*c2*u2*u2 + inv_r*lambda_theta_dot*(u2 - 2.0*r_dot*theta_dot) + lambda_r*r_dot + lambda_r_dot*(r*theta_dot*theta_dot + u1 - inv_r*inv_r*mu) + lambda_theta*theta_dot


def stationarity(t, x, u, lam, p):
    """H_u."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    return (
        c1*u1 + lambda_r_dot,
        c2*u2 + inv_r*lambda_theta_dot,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    return (
        c1,
        0.0,
        0.0,
        c2,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    inv_c1 = 1.0/c1
    inv_c2 = 1.0/c2
    inv_r = 1.0/r
    return (
        -inv_c1*lambda_r_dot,
        -inv_c2*inv_r*lambda_theta_dot,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    twice_theta_dot = 2.0*theta_dot
    mu = omega*omega*sigma*sigma*sigma
    return (
        inv_r*inv_r*lambda_theta_dot*(u2 - r_dot*twice_theta_dot) + lambda_r_dot*(-2.0*inv_r*inv_r*inv_r*mu - theta_dot*theta_dot),
        inv_r*lambda_theta_dot*twice_theta_dot - lambda_r,
        0.0,
        2.0*inv_r*lambda_theta_dot*r_dot - lambda_r_dot*r*twice_theta_dot - lambda_theta,
    )


def path_constraints(t, x, u, p, bounds):
    """What may not be positive along the way."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    omega_t = omega*t
    return (
        theta - omega_t - slot,
        omega_t - slot - theta,
    )


def path_gradient(t, x, u, p):
    """Its derivatives by the states, row by row."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    return (
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        0.0,
    )


def path_effect(t, x, u, p):
    """Its derivatives by the controls, row by row."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def path_rates(t, x, u, p):
    """Its first and second rates of change; 0 for those after the control."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    w = omega - theta_dot
    inv_r = 1.0/r
    w_2 = 2.0*inv_r*r_dot*theta_dot - inv_r*u2
    return (
        -w,
        -w_2,
        w,
        w_2,
    )


def path_vanishing(t, x, u, lam, p, bounds):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    twice_theta_dot = 2.0*theta_dot
    inv_r_twice_theta_dot = inv_r*twice_theta_dot
    inv_c2 = 1.0/c2
    inv_r_sq = inv_r*inv_r
    inv_c2_inv_r_sq = inv_c2*inv_r_sq
    w = inv_c2_inv_r_sq*lambda_theta_dot + inv_r_twice_theta_dot*r_dot
    inv_c1 = 1.0/c1
    w_2 = inv_r_twice_theta_dot*lambda_r_dot
    inv_r_cubed = inv_r*inv_r*inv_r
    mu = omega*omega*sigma*sigma*sigma
    w_3 = inv_c1*w_2 + 2.0*inv_c2*inv_r_cubed*lambda_theta_dot*r_dot + inv_c2*w_2 + inv_c2_inv_r_sq*lambda_theta + inv_r_cubed*mu*twice_theta_dot + 6.0*inv_r_sq*r_dot*r_dot*theta_dot - 2.0*theta_dot*theta_dot*theta_dot
    return (
        -w,
        w_3,
        w,
        -w_3,
    )


def path_multiplier(t, x, u, lam, p, bounds):
    """The multiplier of each while it is on its boundary."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    inv_c1 = 1.0/c1
    inv_c2 = 1.0/c2
    w = 4.0*inv_r
    w_2 = 2.0*lambda_r*r*theta_dot
    r_dot_theta_dot = r_dot*theta_dot
    w_3 = lambda_r_dot*r_dot_theta_dot
    theta_dot_sq = theta_dot*theta_dot
    w_4 = lambda_r_dot*lambda_theta_dot
    c2_inv_c1 = c2*inv_c1
    inv_r_sq = inv_r*inv_r
    mu = omega*omega*sigma*sigma*sigma
    w_5 = 24.0*c2*inv_r*r_dot*r_dot*r_dot*theta_dot + 22.0*c2*inv_r_sq*mu*r_dot_theta_dot + c2_inv_c1*w_2 + 18.0*c2_inv_c1*w_3 + inv_c1*w*w_4 + 2.0*inv_c2*inv_r*w_4 + 4.0*inv_r*inv_r*inv_r*lambda_theta_dot*mu + 8.0*inv_r_sq*lambda_theta_dot*r_dot*r_dot + lambda_theta*r_dot*w + w_2 + 10.0*w_3 - 4.0*c2*inv_c1*lambda_theta_dot*theta_dot_sq - 24.0*c2*r*r_dot*theta_dot*theta_dot*theta_dot - 12.0*lambda_theta_dot*theta_dot_sq
    return (
        -w_5,
        w_5,
    )


def boundary_control(t, x, lam, p, bounds):
    """The controls on the boundary of each, row by row."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    inv_c1 = 1.0/c1
    w = -inv_c1*lambda_r_dot
    w_2 = 2.0*r_dot*theta_dot
    return (
        w,
        w_2,
        w,
        w_2,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    inv_c1 = 1.0/c1
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    theta_dot_sq = theta_dot*theta_dot
    mu = omega*omega*sigma*sigma*sigma
    inv_c2 = 1.0/c2
    twice_theta_dot = 2.0*theta_dot
    inv_r_lambda_theta_dot = inv_r*lambda_theta_dot
    w = -inv_c2*inv_r_lambda_theta_dot - r_dot*twice_theta_dot
    return (
        r_dot,
        r*theta_dot_sq - inv_c1*lambda_r_dot - inv_r_sq*mu,
        theta_dot,
        inv_r*w,
        inv_r_sq*lambda_theta_dot*w + lambda_r_dot*(-2.0*inv_r*inv_r*inv_r*mu - theta_dot_sq),
        inv_r_lambda_theta_dot*twice_theta_dot - lambda_r,
        0.0,
        2.0*inv_r*lambda_theta_dot*r_dot - lambda_r_dot*r*twice_theta_dot - lambda_theta,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    inv_r = 1.0/r
    inv_r_cubed = inv_r*inv_r*inv_r
    twice_inv_r_cubed = 2.0*inv_r_cubed
    mu = omega*omega*sigma*sigma*sigma
    w = mu*twice_inv_r_cubed + theta_dot*theta_dot
    twice_theta_dot = 2.0*theta_dot
    r_twice_theta_dot = r*twice_theta_dot
    inv_c1 = 1.0/c1
    inv_c2 = 1.0/c2
    inv_c2_lambda_theta_dot = inv_c2*lambda_theta_dot
    inv_r_sq = inv_r*inv_r
    w_2 = -inv_c2_lambda_theta_dot*inv_r - r_dot*twice_theta_dot
    w_3 = inv_c2_lambda_theta_dot*inv_r_cubed - inv_r_sq*w_2
    inv_r_twice_theta_dot = inv_r*twice_theta_dot
    twice_inv_r = 2.0*inv_r
    r_dot_twice_inv_r = r_dot*twice_inv_r
    w_4 = inv_r*inv_r*inv_r*inv_r
    w_5 = inv_r_sq*lambda_theta_dot
    w_6 = -twice_theta_dot*w_5
    w_7 = -lambda_r_dot*twice_theta_dot - 2.0*r_dot*w_5
    w_8 = lambda_theta_dot*twice_inv_r
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w,
        0.0,
        0.0,
        r_twice_theta_dot,
        0.0,
        -inv_c1,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        -inv_r_twice_theta_dot,
        0.0,
        -r_dot_twice_inv_r,
        0.0,
        0.0,
        0.0,
        -inv_c2*inv_r_sq,
        inv_c2*lambda_theta_dot*lambda_theta_dot*w_4 + 6.0*lambda_r_dot*mu*w_4 - lambda_theta_dot*twice_inv_r_cubed*w_2,
        w_6,
        0.0,
        w_7,
        0.0,
        -w,
        0.0,
        -w_3,
        w_6,
        0.0,
        0.0,
        w_8,
        -1.0,
        0.0,
        0.0,
        inv_r_twice_theta_dot,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_7,
        w_8,
        0.0,
        -2.0*lambda_r_dot*r,
        0.0,
        -r_twice_theta_dot,
        -1.0,
        r_dot_twice_inv_r,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    given_r, given_r_dot, given_theta, given_theta_dot, on_reference_r, on_reference_r_dot, on_reference_theta, on_reference_theta_dot, target_r, target_r_dot, target_theta, target_theta_dot = final
    w = -theta
    w_2 = -theta_dot
    inv_c1 = 1.0/c1
    inv_c2 = 1.0/c2
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    inv_r_lambda_theta_dot = inv_r*lambda_theta_dot
    mu = omega*omega*sigma*sigma*sigma
    return (
        given_r*(r - target_r) + lambda_r*(1.0 - given_r - on_reference_r) + on_reference_r*(r - sigma),
        given_r_dot*(r_dot - target_r_dot) + lambda_r_dot*(1.0 - given_r_dot - on_reference_r_dot) + on_reference_r_dot*r_dot,
        given_theta*(-target_theta - w) + lambda_theta*(1.0 - given_theta - on_reference_theta) + on_reference_theta*(-omega*t - w),
        given_theta_dot*(-target_theta_dot - w_2) + lambda_theta_dot*(1.0 - given_theta_dot - on_reference_theta_dot) + on_reference_theta_dot*(-omega - w_2),
        0.5*inv_c1*lambda_r_dot*lambda_r_dot + 0.5*inv_c2*inv_r_sq*lambda_theta_dot*lambda_theta_dot + inv_r_lambda_theta_dot*(-inv_c2*inv_r_lambda_theta_dot - 2.0*r_dot*theta_dot) + lambda_r*r_dot + lambda_r_dot*(r*theta_dot*theta_dot - inv_c1*lambda_r_dot - inv_r_sq*mu) + lambda_theta*theta_dot - lambda_theta*omega*on_reference_theta,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    given_r, given_r_dot, given_theta, given_theta_dot, on_reference_r, on_reference_r_dot, on_reference_theta, on_reference_theta_dot, target_r, target_r_dot, target_theta, target_theta_dot = final
    w = given_r + on_reference_r
    w_2 = given_r_dot + on_reference_r_dot
    w_3 = given_theta + on_reference_theta
    omega_on_reference_theta = omega*on_reference_theta
    w_4 = given_theta_dot + on_reference_theta_dot
    inv_r = 1.0/r
    theta_dot_sq = theta_dot*theta_dot
    inv_r_sq = inv_r*inv_r
    inv_c2 = 1.0/c2
    twice_theta_dot = 2.0*theta_dot
    inv_r_lambda_theta_dot = inv_r*lambda_theta_dot
    w_5 = -inv_c2*inv_r_lambda_theta_dot - r_dot*twice_theta_dot
    mu = omega*omega*sigma*sigma*sigma
    inv_c1 = 1.0/c1
    return (
        w,
        0.0,
        0.0,
        0.0,
        1.0 - w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_2,
        0.0,
        0.0,
        0.0,
        1.0 - w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        0.0,
        0.0,
        0.0,
        1.0 - w_3,
        0.0,
        -omega_on_reference_theta,
        0.0,
        0.0,
        0.0,
        w_4,
        0.0,
        0.0,
        0.0,
        1.0 - w_4,
        0.0,
        lambda_r_dot*(2.0*inv_r*inv_r*inv_r*mu + theta_dot_sq) - inv_r_sq*lambda_theta_dot*w_5,
        lambda_r - inv_r_lambda_theta_dot*twice_theta_dot,
        0.0,
        lambda_r_dot*r*twice_theta_dot + lambda_theta - 2.0*inv_r_lambda_theta_dot*r_dot,
        r_dot,
        r*theta_dot_sq - inv_c1*lambda_r_dot - inv_r_sq*mu,
        theta_dot - omega_on_reference_theta,
        inv_r*w_5,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    sigma, omega, c1, c2, slot = p
    r_at, r_dot_at, theta_at, theta_dot_at = x
    r_mid, r_dot_mid, theta_mid, theta_dot_mid = x_mid
    u1_at, u2_at = u
    u1_mid, u2_mid = u_mid
    r, r_dot, theta, theta_dot = x0
    mu = omega*omega*sigma*sigma*sigma
    half_c1 = 0.5*c1
    half_c2 = 0.5*c2
    steps = len(times) - 1
    t = times[0]
    r_at[0] = r
    r_dot_at[0] = r_dot
    theta_at[0] = theta
    theta_dot_at[0] = theta_dot
    u1 = u1_at[0]
    u2 = u2_at[0]
    inv_r = 1.0/r
    slope_r_dot = r*theta_dot*theta_dot + u1 - inv_r*inv_r*mu
    slope_theta_dot = inv_r*(u2 - 2.0*r_dot*theta_dot)
    slope_total = half_c1*u1*u1 + half_c2*u2*u2
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        r_at[i] = r
        r_dot_at[i] = r_dot
        theta_at[i] = theta
        theta_dot_at[i] = theta_dot
        u1_half = u1_mid[i]
        u1_end = u1_at[i + 1]
        u2_half = u2_mid[i]
        u2_end = u2_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        r_2 = half*r_dot + r
        r_dot_2 = half*slope_r_dot + r_dot
        theta_dot_2 = half*slope_theta_dot + theta_dot
        inv_r_2 = 1.0/r_2
        k2_r_dot = r_2*theta_dot_2*theta_dot_2 + u1_half - inv_r_2*inv_r_2*mu
        k2_theta_dot = inv_r_2*(u2_half - 2.0*r_dot_2*theta_dot_2)
        k2_total = half_c1*u1_half*u1_half + half_c2*u2_half*u2_half
        r_3 = half*r_dot_2 + r
        r_dot_3 = half*k2_r_dot + r_dot
        theta_dot_3 = half*k2_theta_dot + theta_dot
        inv_r_3 = 1.0/r_3
        k3_r_dot = r_3*theta_dot_3*theta_dot_3 + u1_half - inv_r_3*inv_r_3*mu
        k3_theta_dot = inv_r_3*(u2_half - 2.0*r_dot_3*theta_dot_3)
        r_4 = h*r_dot_3 + r
        r_dot_4 = h*k3_r_dot + r_dot
        theta_dot_4 = h*k3_theta_dot + theta_dot
        inv_r_4 = 1.0/r_4
        k4_r_dot = r_4*theta_dot_4*theta_dot_4 + u1_end - inv_r_4*inv_r_4*mu
        k4_theta_dot = inv_r_4*(u2_end - 2.0*r_dot_4*theta_dot_4)
        k4_total = half_c1*u1_end*u1_end + half_c2*u2_end*u2_end
        k23_r_dot = k2_r_dot + k3_r_dot
        k123_r_dot = k23_r_dot + slope_r_dot
        k23_theta_dot = k2_theta_dot + k3_theta_dot
        k123_theta_dot = k23_theta_dot + slope_theta_dot
        r_end = h*(k123_r_dot*sixth + r_dot) + r
        r_dot_end = r_dot + sixth*(k123_r_dot + k23_r_dot + k4_r_dot)
        theta_end = h*(k123_theta_dot*sixth + theta_dot) + theta
        theta_dot_end = sixth*(k123_theta_dot + k23_theta_dot + k4_theta_dot) + theta_dot
        inv_r_end = 1.0/r_end
        slope_end_r_dot = r_end*theta_dot_end*theta_dot_end + u1_end - inv_r_end*inv_r_end*mu
        slope_end_theta_dot = inv_r_end*(u2_end - 2.0*r_dot_end*theta_dot_end)
        eighth = 0.125*h
        r_mid[i] = eighth*(r_dot - r_dot_end) + 0.5*(r + r_end)
        r_dot_mid[i] = eighth*(slope_r_dot - slope_end_r_dot) + 0.5*(r_dot + r_dot_end)
        theta_mid[i] = eighth*(theta_dot - theta_dot_end) + 0.5*(theta + theta_end)
        theta_dot_mid[i] = eighth*(slope_theta_dot - slope_end_theta_dot) + 0.5*(theta_dot + theta_dot_end)
        total = sixth*(4.0*k2_total + k4_total + slope_total) + total
        t = t_end
        r = r_end
        r_dot = r_dot_end
        theta = theta_end
        theta_dot = theta_dot_end
        slope_r_dot = slope_end_r_dot
        slope_theta_dot = slope_end_theta_dot
        slope_total = k4_total
    r_at[steps] = r
    r_dot_at[steps] = r_dot
    theta_at[steps] = theta
    theta_dot_at[steps] = theta_dot
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    sigma, omega, c1, c2, slot = p
    lambda_r_at, lambda_r_dot_at, lambda_theta_at, lambda_theta_dot_at = lam
    lambda_r_mid, lambda_r_dot_mid, lambda_theta_mid, lambda_theta_dot_mid = lam_mid
    r_at, r_dot_at, theta_at, theta_dot_at = x
    u1_at, u2_at = u
    r_mid, r_dot_mid, theta_mid, theta_dot_mid = x_mid
    u1_mid, u2_mid = u_mid
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam_f
    mu = omega*omega*sigma*sigma*sigma
    twice_mu = 2.0*mu
    steps = len(times) - 1
    t = times[steps]
    lambda_r_at[steps] = lambda_r
    lambda_r_dot_at[steps] = lambda_r_dot
    lambda_theta_at[steps] = lambda_theta
    lambda_theta_dot_at[steps] = lambda_theta_dot
    r = r_at[steps]
    r_dot = r_dot_at[steps]
    theta_dot = theta_dot_at[steps]
    u2 = u2_at[steps]
    inv_r = 1.0/r
    w = inv_r*inv_r*inv_r*twice_mu + theta_dot*theta_dot
    twice_theta_dot = 2.0*theta_dot
    w_2 = inv_r*inv_r*(u2 - r_dot*twice_theta_dot)
    inv_r_twice_theta_dot = inv_r*twice_theta_dot
    r_twice_theta_dot = r*twice_theta_dot
    w_3 = 2.0*inv_r*r_dot
    slope_lambda_r = lambda_theta_dot*w_2 - lambda_r_dot*w
    slope_lambda_r_dot = inv_r_twice_theta_dot*lambda_theta_dot - lambda_r
    slope_lambda_theta_dot = lambda_theta_dot*w_3 - lambda_r_dot*r_twice_theta_dot - lambda_theta
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        r_half = r_mid[i]
        r_end = r_at[i]
        r_dot_half = r_dot_mid[i]
        r_dot_end = r_dot_at[i]
        theta_dot_half = theta_dot_mid[i]
        theta_dot_end = theta_dot_at[i]
        u2_half = u2_mid[i]
        u2_end = u2_at[i]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_r_2 = half*slope_lambda_r + lambda_r
        lambda_r_dot_2 = half*slope_lambda_r_dot + lambda_r_dot
        lambda_theta_dot_2 = half*slope_lambda_theta_dot + lambda_theta_dot
        inv_r_half = 1.0/r_half
        w_4 = inv_r_half*inv_r_half*inv_r_half*twice_mu + theta_dot_half*theta_dot_half
        twice_theta_dot_half = 2.0*theta_dot_half
        w_5 = inv_r_half*inv_r_half*(u2_half - r_dot_half*twice_theta_dot_half)
        w_6 = inv_r_half*twice_theta_dot_half
        w_7 = r_half*twice_theta_dot_half
        w_8 = 2.0*inv_r_half*r_dot_half
        k2_lambda_r = lambda_theta_dot_2*w_5 - lambda_r_dot_2*w_4
        k2_lambda_r_dot = lambda_theta_dot_2*w_6 - lambda_r_2
        k2_lambda_theta_dot = lambda_theta_dot_2*w_8 - lambda_r_dot_2*w_7 - lambda_theta
        lambda_r_3 = half*k2_lambda_r + lambda_r
        lambda_r_dot_3 = half*k2_lambda_r_dot + lambda_r_dot
        lambda_theta_dot_3 = half*k2_lambda_theta_dot + lambda_theta_dot
        k3_lambda_r = lambda_theta_dot_3*w_5 - lambda_r_dot_3*w_4
        k3_lambda_r_dot = lambda_theta_dot_3*w_6 - lambda_r_3
        k3_lambda_theta_dot = lambda_theta_dot_3*w_8 - lambda_r_dot_3*w_7 - lambda_theta
        lambda_r_4 = h*k3_lambda_r + lambda_r
        lambda_r_dot_4 = h*k3_lambda_r_dot + lambda_r_dot
        lambda_theta_dot_4 = h*k3_lambda_theta_dot + lambda_theta_dot
        inv_r_end = 1.0/r_end
        w_9 = inv_r_end*inv_r_end*inv_r_end*twice_mu + theta_dot_end*theta_dot_end
        twice_theta_dot_end = 2.0*theta_dot_end
        w_10 = inv_r_end*inv_r_end*(u2_end - r_dot_end*twice_theta_dot_end)
        w_11 = inv_r_end*twice_theta_dot_end
        w_12 = r_end*twice_theta_dot_end
        w_13 = 2.0*inv_r_end*r_dot_end
        k4_lambda_r = lambda_theta_dot_4*w_10 - lambda_r_dot_4*w_9
        k4_lambda_r_dot = lambda_theta_dot_4*w_11 - lambda_r_4
        k4_lambda_theta_dot = lambda_theta_dot_4*w_13 - lambda_r_dot_4*w_12 - lambda_theta
        lambda_r_end = lambda_r + sixth*(k4_lambda_r + slope_lambda_r + 2.0*(k2_lambda_r + k3_lambda_r))
        lambda_r_dot_end = lambda_r_dot + sixth*(k4_lambda_r_dot + slope_lambda_r_dot + 2.0*(k2_lambda_r_dot + k3_lambda_r_dot))
        lambda_theta_dot_end = lambda_theta_dot + sixth*(k4_lambda_theta_dot + slope_lambda_theta_dot + 2.0*(k2_lambda_theta_dot + k3_lambda_theta_dot))
        slope_end_lambda_r = lambda_theta_dot_end*w_10 - lambda_r_dot_end*w_9
        slope_end_lambda_r_dot = lambda_theta_dot_end*w_11 - lambda_r_end
        slope_end_lambda_theta_dot = lambda_theta_dot_end*w_13 - lambda_r_dot_end*w_12 - lambda_theta
        eighth = 0.125*h
        lambda_r_mid[i] = eighth*(slope_lambda_r - slope_end_lambda_r) + 0.5*(lambda_r + lambda_r_end)
        lambda_r_at[i] = lambda_r_end
        lambda_r_dot_mid[i] = eighth*(slope_lambda_r_dot - slope_end_lambda_r_dot) + 0.5*(lambda_r_dot + lambda_r_dot_end)
        lambda_r_dot_at[i] = lambda_r_dot_end
        lambda_theta_mid[i] = lambda_theta
        lambda_theta_at[i] = lambda_theta
        lambda_theta_dot_mid[i] = eighth*(slope_lambda_theta_dot - slope_end_lambda_theta_dot) + 0.5*(lambda_theta_dot + lambda_theta_dot_end)
        lambda_theta_dot_at[i] = lambda_theta_dot_end
        t = t_end
        lambda_r = lambda_r_end
        lambda_r_dot = lambda_r_dot_end
        lambda_theta_dot = lambda_theta_dot_end
        slope_lambda_r = slope_end_lambda_r
        slope_lambda_r_dot = slope_end_lambda_r_dot
        slope_lambda_theta_dot = slope_end_lambda_theta_dot


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))
    inv_r = 1.0/r
    mu = omega*omega*sigma*sigma*sigma
    out[0] = r_dot
    out[1] = r*theta_dot*theta_dot + u1 - inv_r*inv_r*mu
    out[2] = theta_dot
    out[3] = inv_r*(u2 - 2.0*r_dot*theta_dot)
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_r = 1.0/r
    mu = omega*omega*sigma*sigma*sigma
    twice_theta_dot = 2.0*theta_dot
    out[0, 1] = 1.0
    out[1, 0] = 2.0*inv_r*inv_r*inv_r*mu + theta_dot*theta_dot
    out[1, 3] = r*twice_theta_dot
    out[2, 3] = 1.0
    out[3, 0] = inv_r*inv_r*(r_dot*twice_theta_dot - u2)
    out[3, 1] = -inv_r*twice_theta_dot
    out[3, 3] = -2.0*inv_r*r_dot
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_r = 1.0/r
    out[1, 0] = 1.0
    out[3, 1] = inv_r
    return out


def reference_batch(t, p, out=None):
    """The reference curve c(t). Batch form."""
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((4, *shape), np.result_type(float, t, *p))
    out[0] = sigma
    out[1] = 0.0
    out[2] = omega*t
    out[3] = omega
    return out


def invariants_batch(t, x, p, out=None):
    """What the uncontrolled motion keeps constant. Batch form."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    inv_r = 1.0/r
    r_sq = r*r
    mu = omega*omega*sigma*sigma*sigma
    out[0] = 0.5*r_dot*r_dot + 0.5*r_sq*theta_dot*theta_dot - inv_r*mu
    out[1] = r_sq*theta_dot
    return out


def position_batch(t, x, p, out=None):
    """Inertial components of the position vector. Batch form."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = r*np.cos(theta)
    out[1] = r*np.sin(theta)
    return out


def inertial_state_batch(t, x, p, out=None):
    """Position and velocity along inertial axes, three numbers each, and the gravitational parameter. Batch form."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((7, *shape), np.result_type(float, t, x, *p))
    cos_theta = np.cos(theta)
    cos_theta_r = cos_theta*r
    sin_theta = np.sin(theta)
    r_sin_theta = r*sin_theta
    mu = omega*omega*sigma*sigma*sigma
    out[0] = cos_theta_r
    out[1] = r_sin_theta
    out[2] = 0.0
    out[3] = cos_theta*r_dot - r_sin_theta*theta_dot
    out[4] = cos_theta_r*theta_dot + r_dot*sin_theta
    out[5] = 0.0
    out[6] = mu
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.5*c1*u1*u1 + 0.5*c2*u2*u2
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    r, r_dot, theta, theta_dot = x
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    inv_r = 1.0/r
    mu = omega*omega*sigma*sigma*sigma
    out[...] = 0.5*c1*u1*u1 + 0.5*c2*u2*u2 + inv_r*lambda_theta_dot*(u2 - 2.0*r_dot*theta_dot) + lambda_r*r_dot + lambda_r_dot*(r*theta_dot*theta_dot + u1 - inv_r*inv_r*mu) + lambda_theta*theta_dot
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_r = 1.0/r
    out[0] = c1*u1 + lambda_r_dot
    out[1] = c2*u2 + inv_r*lambda_theta_dot
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = c1
    out[0, 1] = 0.0
    out[1, 0] = 0.0
    out[1, 1] = c2
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_c1 = 1.0/c1
    inv_c2 = 1.0/c2
    inv_r = 1.0/r
    out[0] = -inv_c1*lambda_r_dot
    out[1] = -inv_c2*inv_r*lambda_theta_dot
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_r = 1.0/r
    twice_theta_dot = 2.0*theta_dot
    mu = omega*omega*sigma*sigma*sigma
    out[0] = inv_r*inv_r*lambda_theta_dot*(u2 - r_dot*twice_theta_dot) + lambda_r_dot*(-2.0*inv_r*inv_r*inv_r*mu - theta_dot*theta_dot)
    out[1] = inv_r*lambda_theta_dot*twice_theta_dot - lambda_r
    out[2] = 0.0
    out[3] = 2.0*inv_r*lambda_theta_dot*r_dot - lambda_r_dot*r*twice_theta_dot - lambda_theta
    return out


def path_constraints_batch(t, x, u, p, bounds, out=None):
    """What may not be positive along the way. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p, *bounds))
    omega_t = omega*t
    out[0] = theta - omega_t - slot
    out[1] = omega_t - slot - theta
    return out


def path_gradient_batch(t, x, u, p, out=None):
    """Its derivatives by the states, row by row. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 4, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[0, 2] = 1.0
    out[1, 2] = -1.0
    return out


def path_effect_batch(t, x, u, p, out=None):
    """Its derivatives by the controls, row by row. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def path_rates_batch(t, x, u, p, out=None):
    """Its first and second rates of change; 0 for those after the control. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    w = omega - theta_dot
    inv_r = 1.0/r
    w_2 = 2.0*inv_r*r_dot*theta_dot - inv_r*u2
    out[0, 0] = -w
    out[0, 1] = -w_2
    out[1, 0] = w
    out[1, 1] = w_2
    return out


def path_vanishing_batch(t, x, u, lam, p, bounds, out=None):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    inv_r = 1.0/r
    twice_theta_dot = 2.0*theta_dot
    inv_r_twice_theta_dot = inv_r*twice_theta_dot
    inv_c2 = 1.0/c2
    inv_r_sq = inv_r*inv_r
    inv_c2_inv_r_sq = inv_c2*inv_r_sq
    w = inv_c2_inv_r_sq*lambda_theta_dot + inv_r_twice_theta_dot*r_dot
    inv_c1 = 1.0/c1
    w_2 = inv_r_twice_theta_dot*lambda_r_dot
    inv_r_cubed = inv_r*inv_r*inv_r
    mu = omega*omega*sigma*sigma*sigma
    w_3 = inv_c1*w_2 + 2.0*inv_c2*inv_r_cubed*lambda_theta_dot*r_dot + inv_c2*w_2 + inv_c2_inv_r_sq*lambda_theta + inv_r_cubed*mu*twice_theta_dot + 6.0*inv_r_sq*r_dot*r_dot*theta_dot - 2.0*theta_dot*theta_dot*theta_dot
    out[0, 0] = -w
    out[0, 1] = w_3
    out[1, 0] = w
    out[1, 1] = -w_3
    return out


def path_multiplier_batch(t, x, u, lam, p, bounds, out=None):
    """The multiplier of each while it is on its boundary. Batch form."""
    r, r_dot, theta, theta_dot = x
    u1, u2 = u
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    inv_r = 1.0/r
    inv_c1 = 1.0/c1
    inv_c2 = 1.0/c2
    w = 4.0*inv_r
    w_2 = 2.0*lambda_r*r*theta_dot
    r_dot_theta_dot = r_dot*theta_dot
    w_3 = lambda_r_dot*r_dot_theta_dot
    theta_dot_sq = theta_dot*theta_dot
    w_4 = lambda_r_dot*lambda_theta_dot
    c2_inv_c1 = c2*inv_c1
    inv_r_sq = inv_r*inv_r
    mu = omega*omega*sigma*sigma*sigma
    w_5 = 24.0*c2*inv_r*r_dot*r_dot*r_dot*theta_dot + 22.0*c2*inv_r_sq*mu*r_dot_theta_dot + c2_inv_c1*w_2 + 18.0*c2_inv_c1*w_3 + inv_c1*w*w_4 + 2.0*inv_c2*inv_r*w_4 + 4.0*inv_r*inv_r*inv_r*lambda_theta_dot*mu + 8.0*inv_r_sq*lambda_theta_dot*r_dot*r_dot + lambda_theta*r_dot*w + w_2 + 10.0*w_3 - 4.0*c2*inv_c1*lambda_theta_dot*theta_dot_sq - 24.0*c2*r*r_dot*theta_dot*theta_dot*theta_dot - 12.0*lambda_theta_dot*theta_dot_sq
    out[0] = -w_5
    out[1] = w_5
    return out


def boundary_control_batch(t, x, lam, p, bounds, out=None):
    """The controls on the boundary of each, row by row. Batch form."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_c1 = 1.0/c1
    w = -inv_c1*lambda_r_dot
    w_2 = 2.0*r_dot*theta_dot
    out[0, 0] = w
    out[0, 1] = w_2
    out[1, 0] = w
    out[1, 1] = w_2
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_c1 = 1.0/c1
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    theta_dot_sq = theta_dot*theta_dot
    mu = omega*omega*sigma*sigma*sigma
    inv_c2 = 1.0/c2
    twice_theta_dot = 2.0*theta_dot
    inv_r_lambda_theta_dot = inv_r*lambda_theta_dot
    w = -inv_c2*inv_r_lambda_theta_dot - r_dot*twice_theta_dot
    out[0] = r_dot
    out[1] = r*theta_dot_sq - inv_c1*lambda_r_dot - inv_r_sq*mu
    out[2] = theta_dot
    out[3] = inv_r*w
    out[4] = inv_r_sq*lambda_theta_dot*w + lambda_r_dot*(-2.0*inv_r*inv_r*inv_r*mu - theta_dot_sq)
    out[5] = inv_r_lambda_theta_dot*twice_theta_dot - lambda_r
    out[6] = 0.0
    out[7] = 2.0*inv_r*lambda_theta_dot*r_dot - lambda_r_dot*r*twice_theta_dot - lambda_theta
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, 8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    inv_r = 1.0/r
    inv_r_cubed = inv_r*inv_r*inv_r
    twice_inv_r_cubed = 2.0*inv_r_cubed
    mu = omega*omega*sigma*sigma*sigma
    w = mu*twice_inv_r_cubed + theta_dot*theta_dot
    twice_theta_dot = 2.0*theta_dot
    r_twice_theta_dot = r*twice_theta_dot
    inv_c1 = 1.0/c1
    inv_c2 = 1.0/c2
    inv_c2_lambda_theta_dot = inv_c2*lambda_theta_dot
    inv_r_sq = inv_r*inv_r
    w_2 = -inv_c2_lambda_theta_dot*inv_r - r_dot*twice_theta_dot
    w_3 = inv_c2_lambda_theta_dot*inv_r_cubed - inv_r_sq*w_2
    inv_r_twice_theta_dot = inv_r*twice_theta_dot
    twice_inv_r = 2.0*inv_r
    r_dot_twice_inv_r = r_dot*twice_inv_r
    w_4 = inv_r*inv_r*inv_r*inv_r
    w_5 = inv_r_sq*lambda_theta_dot
    w_6 = -twice_theta_dot*w_5
    w_7 = -lambda_r_dot*twice_theta_dot - 2.0*r_dot*w_5
    w_8 = lambda_theta_dot*twice_inv_r
    out[0, 1] = 1.0
    out[1, 0] = w
    out[1, 3] = r_twice_theta_dot
    out[1, 5] = -inv_c1
    out[2, 3] = 1.0
    out[3, 0] = w_3
    out[3, 1] = -inv_r_twice_theta_dot
    out[3, 3] = -r_dot_twice_inv_r
    out[3, 7] = -inv_c2*inv_r_sq
    out[4, 0] = inv_c2*lambda_theta_dot*lambda_theta_dot*w_4 + 6.0*lambda_r_dot*mu*w_4 - lambda_theta_dot*twice_inv_r_cubed*w_2
    out[4, 1] = w_6
    out[4, 3] = w_7
    out[4, 5] = -w
    out[4, 7] = -w_3
    out[5, 0] = w_6
    out[5, 3] = w_8
    out[5, 4] = -1.0
    out[5, 7] = inv_r_twice_theta_dot
    out[7, 0] = w_7
    out[7, 1] = w_8
    out[7, 3] = -2.0*lambda_r_dot*r
    out[7, 5] = -r_twice_theta_dot
    out[7, 6] = -1.0
    out[7, 7] = r_dot_twice_inv_r
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = 0.0
    out[7] = 0.0
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    given_r, given_r_dot, given_theta, given_theta_dot, on_reference_r, on_reference_r_dot, on_reference_theta, on_reference_theta_dot, target_r, target_r_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = -theta
    w_2 = -theta_dot
    inv_c1 = 1.0/c1
    inv_c2 = 1.0/c2
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    inv_r_lambda_theta_dot = inv_r*lambda_theta_dot
    mu = omega*omega*sigma*sigma*sigma
    out[0] = given_r*(r - target_r) + lambda_r*(1.0 - given_r - on_reference_r) + on_reference_r*(r - sigma)
    out[1] = given_r_dot*(r_dot - target_r_dot) + lambda_r_dot*(1.0 - given_r_dot - on_reference_r_dot) + on_reference_r_dot*r_dot
    out[2] = given_theta*(-target_theta - w) + lambda_theta*(1.0 - given_theta - on_reference_theta) + on_reference_theta*(-omega*t - w)
    out[3] = given_theta_dot*(-target_theta_dot - w_2) + lambda_theta_dot*(1.0 - given_theta_dot - on_reference_theta_dot) + on_reference_theta_dot*(-omega - w_2)
    out[4] = 0.5*inv_c1*lambda_r_dot*lambda_r_dot + 0.5*inv_c2*inv_r_sq*lambda_theta_dot*lambda_theta_dot + inv_r_lambda_theta_dot*(-inv_c2*inv_r_lambda_theta_dot - 2.0*r_dot*theta_dot) + lambda_r*r_dot + lambda_r_dot*(r*theta_dot*theta_dot - inv_c1*lambda_r_dot - inv_r_sq*mu) + lambda_theta*theta_dot - lambda_theta*omega*on_reference_theta
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    r, r_dot, theta, theta_dot = x
    lambda_r, lambda_r_dot, lambda_theta, lambda_theta_dot = lam
    sigma, omega, c1, c2, slot = p
    given_r, given_r_dot, given_theta, given_theta_dot, on_reference_r, on_reference_r_dot, on_reference_theta, on_reference_theta_dot, target_r, target_r_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, 9, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_r + on_reference_r
    w_2 = given_r_dot + on_reference_r_dot
    w_3 = given_theta + on_reference_theta
    omega_on_reference_theta = omega*on_reference_theta
    w_4 = given_theta_dot + on_reference_theta_dot
    inv_r = 1.0/r
    theta_dot_sq = theta_dot*theta_dot
    inv_r_sq = inv_r*inv_r
    inv_c2 = 1.0/c2
    twice_theta_dot = 2.0*theta_dot
    inv_r_lambda_theta_dot = inv_r*lambda_theta_dot
    w_5 = -inv_c2*inv_r_lambda_theta_dot - r_dot*twice_theta_dot
    mu = omega*omega*sigma*sigma*sigma
    inv_c1 = 1.0/c1
    out[0, 0] = w
    out[0, 4] = 1.0 - w
    out[1, 1] = w_2
    out[1, 5] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 6] = 1.0 - w_3
    out[2, 8] = -omega_on_reference_theta
    out[3, 3] = w_4
    out[3, 7] = 1.0 - w_4
    out[4, 0] = lambda_r_dot*(2.0*inv_r*inv_r*inv_r*mu + theta_dot_sq) - inv_r_sq*lambda_theta_dot*w_5
    out[4, 1] = lambda_r - inv_r_lambda_theta_dot*twice_theta_dot
    out[4, 3] = lambda_r_dot*r*twice_theta_dot + lambda_theta - 2.0*inv_r_lambda_theta_dot*r_dot
    out[4, 4] = r_dot
    out[4, 5] = r*theta_dot_sq - inv_c1*lambda_r_dot - inv_r_sq*mu
    out[4, 6] = theta_dot - omega_on_reference_theta
    out[4, 7] = inv_r*w_5
    return out
