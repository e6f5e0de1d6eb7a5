"""Minimum-fuel transfer between circular orbits.

Written by satsym from derivations/examples/transfer_fuel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/transfer_fuel.py
Source: ../derivations/examples/transfer_fuel.py 9df8f4b0db4bec87bc5a4fbc2a8b1116
Digest: 79f7e8c0ab38fb21c41d5d2e5ae65c7c51711266b760f644ad29855f776d9c5f
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'transfer_fuel',
    'title': 'Minimum-fuel transfer between circular orbits',
    'source': 'derivations/examples/transfer_fuel.py',
    'states': (
        {'symbol': 'r', 'latex': 'r', 'meaning': 'distance from the centre of force', 'positive': True},
        {'symbol': 'theta', 'latex': '\\theta', 'meaning': 'polar angle', 'kind': 'angle'},
        {'symbol': 'u', 'latex': 'u', 'meaning': 'radial velocity'},
        {'symbol': 'v', 'latex': 'v', 'meaning': 'transverse velocity'},
        {'symbol': 'm', 'latex': 'm', 'meaning': 'mass over the initial mass', 'positive': True},
    ),
    'controls': (
        {'symbol': 'T_r', 'latex': 'T_r', 'meaning': 'radial thrust over the initial mass'},
        {'symbol': 'T_t', 'latex': 'T_\\theta', 'meaning': 'transverse thrust over the initial mass'},
    ),
    'parameters': (
        {'symbol': 'mu', 'latex': '\\mu', 'meaning': 'gravitational parameter', 'default': 1.0, 'positive': True},
        {'symbol': 'c', 'latex': 'c', 'meaning': 'exhaust velocity', 'default': 1.0, 'positive': True},
    ),
    'control_set': 'product',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'control_parts': (
        {'name': 'thrust', 'kind': 'ball', 'controls': ('T_r', 'T_t'), 'branch': 'throttled'},
    ),
    'objective_unit': '1',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    mu, c = p
    inv_r = 1.0/r
    inv_r_v = inv_r*v
    inv_m = 1.0/m
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = math.sqrt(w)
    return (
        u_value,
        inv_r_v,
        T_r*inv_m + inv_r*v*v - inv_r*inv_r*mu,
        T_t*inv_m - inv_r_v*u_value,
        -inv_c*sqrt_w,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    mu, c = p
    inv_r = 1.0/r
    w = inv_r*inv_r*v
    inv_r_v = inv_r*v
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    return (
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        -w,
        0.0,
        0.0,
        inv_r,
        0.0,
        inv_r*inv_r*inv_r*(2.0*mu - r*v*v),
        0.0,
        0.0,
        2.0*inv_r_v,
        -T_r*inv_m_sq,
        u_value*w,
        0.0,
        -inv_r_v,
        -inv_r*u_value,
        -T_t*inv_m_sq,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    mu, c = p
    inv_m = 1.0/m
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    inv_c_inv_sqrt_w = inv_c*inv_sqrt_w
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        inv_m,
        0.0,
        0.0,
        inv_m,
        -T_r*inv_c_inv_sqrt_w,
        -T_t*inv_c_inv_sqrt_w,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    mu, c = p
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = math.sqrt(w)
    return inv_c*sqrt_w


def terminal_cost(t, x, p):
    """Terminal cost S."""
    r, theta, u_value, v, m = x
    mu, c = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    r, theta, u_value, v, m = x
    mu, c = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    inv_m = 1.0/m
    inv_r = 1.0/r
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = math.sqrt(w)
    inv_c_sqrt_w = inv_c*sqrt_w
    inv_r_v = inv_r*v
    return inv_c_sqrt_w + inv_r_v*lambda_theta + lambda_r*u_value + lambda_u*(T_r*inv_m + inv_r*v*v - inv_r*inv_r*mu) + lambda_v*(T_t*inv_m - inv_r_v*u_value) - inv_c_sqrt_w*lambda_m


def stationarity(t, x, u, lam, p):
    """H_u."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    inv_m = 1.0/m
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = inv_c*inv_sqrt_w*(1.0 - lambda_m)
    return (
        T_r*w_2 + inv_m*lambda_u,
        T_t*w_2 + inv_m*lambda_v,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    T_r_sq = T_r*T_r
    inv_c = 1.0/c
    T_t_sq = T_t*T_t
    w = T_r_sq + T_t_sq
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = 1.0 - lambda_m
    w_3 = -inv_c*inv_sqrt_w*w_2
    w_4 = inv_c*inv_sqrt_w*inv_sqrt_w*inv_sqrt_w*w_2
    w_5 = -T_r*T_t*w_4
    return (
        -T_r_sq*w_4 - w_3,
        w_5,
        w_5,
        -T_t_sq*w_4 - w_3,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    w = inv_m_sq*lambda_u*lambda_u + inv_m_sq*lambda_v*lambda_v
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    w_2 = inv_smoothing*(sqrt_w - inv_c*norm_factor*(1.0 - lambda_m))
    w_3 = thrust_least if w_2 < thrust_least else u_max if w_2 > u_max else w_2
    inv_m_inv_sqrt_w_w_3 = inv_m*inv_sqrt_w*w_3
    return (
        -inv_m_inv_sqrt_w_w_3*lambda_u,
        -inv_m_inv_sqrt_w_w_3*lambda_v,
    )


def regularised_cost(t, x, lam, p, bounds):
    """Integrand of the cost of the regularised problem."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    inv_smoothing = 1.0/smoothing
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    w = inv_m_sq*lambda_u*lambda_u
    w_2 = inv_m_sq*lambda_v*lambda_v
    w_3 = w + w_2
    sqrt_w_3 = math.sqrt(w_3)
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_4 = inv_smoothing*(sqrt_w_3 - inv_c_norm_factor*(1.0 - lambda_m))
    w_5 = thrust_least if w_4 < thrust_least else u_max if w_4 > u_max else w_4
    inv_w_3 = 1.0/w_3
    w_6 = inv_w_3*w_5*w_5
    return inv_c_norm_factor*w_5 + 0.5*smoothing*(w*w_6 + w_2*w_6)


def throttle_slope(t, x, lam, p, bounds):
    """How H changes with the norm of each vector that may be none, along its best direction."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    w = inv_m_sq*lambda_u*lambda_u + inv_m_sq*lambda_v*lambda_v
    sqrt_w = math.sqrt(w)
    inv_c = 1.0/c
    return (
        inv_c*(1.0 - lambda_m) - sqrt_w,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    inv_r = 1.0/r
    w = inv_r*inv_r*v
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    return (
        inv_r*inv_r*inv_r*lambda_u*(r*v*v - 2.0*mu) + lambda_theta*w - lambda_v*u_value*w,
        0.0,
        inv_r*lambda_v*v - lambda_r,
        inv_r*lambda_v*u_value - inv_r*lambda_theta - 2.0*inv_r*lambda_u*v,
        T_r*inv_m_sq*lambda_u + T_t*inv_m_sq*lambda_v,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    inv_r = 1.0/r
    inv_r_v = inv_r*v
    inv_r_sq = inv_r*inv_r
    v_sq = v*v
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    lambda_u_sq = lambda_u*lambda_u
    lambda_v_sq = lambda_v*lambda_v
    w = inv_m_sq*lambda_u_sq + inv_m_sq*lambda_v_sq
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_2 = inv_smoothing*(sqrt_w - inv_c_norm_factor*(1.0 - lambda_m))
    w_3 = thrust_least if w_2 < thrust_least else u_max if w_2 > u_max else w_2
    inv_sqrt_w_w_3 = inv_sqrt_w*w_3
    inv_m_sq_inv_sqrt_w_w_3 = inv_m_sq*inv_sqrt_w_w_3
    inv_r_sq_v = inv_r_sq*v
    w_4 = inv_m*inv_m*inv_m*inv_sqrt_w_w_3
    return (
        u_value,
        inv_r_v,
        inv_r*v_sq - inv_m_sq_inv_sqrt_w_w_3*lambda_u - inv_r_sq*mu,
        -inv_m_sq_inv_sqrt_w_w_3*lambda_v - inv_r_v*u_value,
        -inv_c_norm_factor*w_3,
        inv_r*inv_r*inv_r*lambda_u*(r*v_sq - 2.0*mu) + inv_r_sq_v*lambda_theta - inv_r_sq_v*lambda_v*u_value,
        0.0,
        inv_r_v*lambda_v - lambda_r,
        inv_r*lambda_v*u_value - inv_r*lambda_theta - 2.0*inv_r_v*lambda_u,
        -lambda_u_sq*w_4 - lambda_v_sq*w_4,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    inv_r_sq_v = inv_r_sq*v
    inv_r_cubed = inv_r*inv_r*inv_r
    twice_mu = 2.0*mu
    v_sq = v*v
    inv_r_v = inv_r*v
    twice_inv_r_v = 2.0*inv_r_v
    twice_lambda_u = 2.0*lambda_u
    inv_m = 1.0/m
    inv_m_cubed = inv_m*inv_m*inv_m
    inv_m_sq = inv_m*inv_m
    lambda_u_sq = lambda_u*lambda_u
    lambda_v_sq = lambda_v*lambda_v
    w = inv_m_sq*lambda_u_sq + inv_m_sq*lambda_v_sq
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_2 = inv_smoothing*(sqrt_w - inv_c_norm_factor*(1.0 - lambda_m))
    w_3 = thrust_least if w_2 < thrust_least else u_max if w_2 > u_max else w_2
    inv_sqrt_w_w_3 = inv_sqrt_w*w_3
    w_4 = inv_m_cubed*inv_sqrt_w_w_3
    twice_lambda_u_w_4 = twice_lambda_u*w_4
    inv_m_cubed_lambda_u_sq = inv_m_cubed*lambda_u_sq
    inv_m_cubed_lambda_v_sq = inv_m_cubed*lambda_v_sq
    w_5 = inv_m_cubed_lambda_u_sq + inv_m_cubed_lambda_v_sq
    inv_sqrt_w_cubed = inv_sqrt_w*inv_sqrt_w*inv_sqrt_w
    inv_sqrt_w_cubed_w_3_w_5 = inv_sqrt_w_cubed*w_3*w_5
    inv_m_sq_lambda_u = inv_m_sq*lambda_u
    w_6 = -w_5
    inv_w = 1.0/w
    w_7 = 0.0 if w_2 < thrust_least else 0.0 if w_2 > u_max else 1.0
    inv_smoothing_w_7 = inv_smoothing*w_7
    inv_smoothing_w_7_inv_w = inv_smoothing_w_7*inv_w
    w_8 = inv_smoothing_w_7_inv_w*w_6
    inv_m_sq_inv_sqrt_w_w_3 = inv_m_sq*inv_sqrt_w_w_3
    w_9 = inv_m*inv_m*inv_m*inv_m
    w_10 = inv_sqrt_w_cubed*lambda_u*lambda_v*w_3*w_9 - inv_smoothing_w_7_inv_w*lambda_u*lambda_v*w_9
    w_11 = inv_c_norm_factor*inv_smoothing_w_7*inv_sqrt_w
    w_12 = -inv_m_sq_lambda_u*w_11
    inv_r_sq_v_u_value = inv_r_sq_v*u_value
    inv_r_u_value = inv_r*u_value
    w_13 = 2.0*lambda_v*w_4
    inv_m_sq_lambda_v = inv_m_sq*lambda_v
    w_14 = -inv_m_sq_lambda_v*w_11
    w_15 = r*v_sq - twice_mu
    w_16 = -inv_r_sq_v*lambda_v
    w_17 = inv_r_sq*lambda_theta + inv_r_sq_v*twice_lambda_u - inv_r_sq*lambda_v*u_value
    inv_r_lambda_v = inv_r*lambda_v
    lambda_u_cubed = lambda_u*lambda_u*lambda_u
    inv_m_sq_sq = inv_m_sq*inv_m_sq
    w_18 = inv_m*inv_m_sq_sq*inv_smoothing_w_7_inv_w
    lambda_v_cubed = lambda_v*lambda_v*lambda_v
    return (
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_r_sq_v,
        0.0,
        0.0,
        inv_r,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        inv_r_cubed*twice_mu - inv_r_sq*v_sq,
        0.0,
        0.0,
        twice_inv_r_v,
        twice_lambda_u_w_4 - inv_m_sq_lambda_u*inv_sqrt_w_cubed_w_3_w_5 - inv_m_sq_lambda_u*w_8,
        0.0,
        0.0,
        inv_sqrt_w_cubed*lambda_u_sq*w_3*w_9 - inv_m_sq_inv_sqrt_w_w_3 - inv_smoothing_w_7_inv_w*lambda_u_sq*w_9,
        w_10,
        w_12,
        inv_r_sq_v_u_value,
        0.0,
        -inv_r_v,
        -inv_r_u_value,
        w_13 - inv_m_sq_lambda_v*inv_sqrt_w_cubed_w_3_w_5 - inv_m_sq_lambda_v*w_8,
        0.0,
        0.0,
        w_10,
        inv_sqrt_w_cubed*lambda_v_sq*w_3*w_9 - inv_m_sq_inv_sqrt_w_w_3 - inv_smoothing_w_7_inv_w*lambda_v_sq*w_9,
        w_14,
        0.0,
        0.0,
        0.0,
        0.0,
        -w_11*w_6,
        0.0,
        0.0,
        w_12,
        w_14,
        -inv_c*inv_c*inv_smoothing_w_7*norm_factor*norm_factor,
        inv_r_cubed*lambda_u*v_sq + 2.0*inv_r_cubed*lambda_v*u_value*v - 3.0*inv_r*inv_r*inv_r*inv_r*lambda_u*w_15 - 2.0*inv_r_cubed*lambda_theta*v,
        0.0,
        w_16,
        w_17,
        0.0,
        0.0,
        inv_r_sq_v,
        inv_r_cubed*w_15,
        -inv_r_sq_v_u_value,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_16,
        0.0,
        0.0,
        inv_r_lambda_v,
        0.0,
        -1.0,
        0.0,
        0.0,
        inv_r_v,
        0.0,
        w_17,
        0.0,
        inv_r_lambda_v,
        -inv_r*twice_lambda_u,
        0.0,
        0.0,
        -inv_r,
        -twice_inv_r_v,
        inv_r_u_value,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        3.0*inv_sqrt_w*lambda_u_sq*w_3*w_9 + 3.0*inv_sqrt_w*lambda_v_sq*w_3*w_9 - inv_m_cubed_lambda_u_sq*inv_sqrt_w_cubed_w_3_w_5 - inv_m_cubed_lambda_u_sq*w_8 - inv_m_cubed_lambda_v_sq*inv_sqrt_w_cubed_w_3_w_5 - inv_m_cubed_lambda_v_sq*w_8,
        0.0,
        0.0,
        inv_m*inv_m_sq_sq*inv_sqrt_w_cubed*lambda_u*lambda_v_sq*w_3 + inv_m*inv_m_sq_sq*inv_sqrt_w_cubed*lambda_u_cubed*w_3 - lambda_u*lambda_v_sq*w_18 - lambda_u_cubed*w_18 - twice_lambda_u_w_4,
        inv_m*inv_m_sq_sq*inv_sqrt_w_cubed*lambda_u_sq*lambda_v*w_3 + inv_m*inv_m_sq_sq*inv_sqrt_w_cubed*lambda_v_cubed*w_3 - lambda_u_sq*lambda_v*w_18 - lambda_v_cubed*w_18 - w_13,
        -inv_m_cubed_lambda_u_sq*w_11 - inv_m_cubed_lambda_v_sq*w_11,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    return (
        0.0,
        0.0,
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
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    given_r, given_theta, given_u, given_v, given_m, on_reference_r, on_reference_theta, on_reference_u, on_reference_v, on_reference_m, target_r, target_theta, target_u, target_v, target_m = final
    inv_r = 1.0/r
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    w = inv_m_sq*lambda_u*lambda_u
    w_2 = inv_m_sq*lambda_v*lambda_v
    inv_r_v = inv_r*v
    w_3 = w + w_2
    sqrt_w_3 = math.sqrt(w_3)
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_4 = inv_smoothing*(sqrt_w_3 - inv_c_norm_factor*(1.0 - lambda_m))
    w_5 = thrust_least if w_4 < thrust_least else u_max if w_4 > u_max else w_4
    inv_c_norm_factor_w_5 = inv_c_norm_factor*w_5
    inv_sqrt_w_3 = 1.0/sqrt_w_3
    w_6 = inv_m_sq*inv_sqrt_w_3*w_5
    inv_w_3 = 1.0/w_3
    w_7 = inv_w_3*w_5*w_5
    return (
        given_r*(r - target_r) + lambda_r*(1.0 - given_r - on_reference_r) + on_reference_r*r,
        given_theta*(theta - target_theta) + lambda_theta*(1.0 - given_theta - on_reference_theta) + on_reference_theta*theta,
        given_u*(u_value - target_u) + lambda_u*(1.0 - given_u - on_reference_u) + on_reference_u*u_value,
        given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v,
        given_m*(m - target_m) + lambda_m*(1.0 - given_m - on_reference_m) + m*on_reference_m,
        inv_c_norm_factor_w_5 + inv_r_v*lambda_theta + lambda_r*u_value + lambda_u*(inv_r*v*v - inv_r*inv_r*mu - lambda_u*w_6) + lambda_v*(-inv_r_v*u_value - lambda_v*w_6) + 0.5*smoothing*(w*w_7 + w_2*w_7) - inv_c_norm_factor_w_5*lambda_m,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    given_r, given_theta, given_u, given_v, given_m, on_reference_r, on_reference_theta, on_reference_u, on_reference_v, on_reference_m, target_r, target_theta, target_u, target_v, target_m = final
    w = given_r + on_reference_r
    w_2 = given_theta + on_reference_theta
    w_3 = given_u + on_reference_u
    w_4 = given_v + on_reference_v
    w_5 = given_m + on_reference_m
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    inv_r_sq_v = inv_r_sq*v
    lambda_v_u_value = lambda_v*u_value
    v_sq = v*v
    inv_r_v = inv_r*v
    twice_lambda_u = 2.0*lambda_u
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    lambda_u_sq = lambda_u*lambda_u
    inv_m_sq_lambda_u_sq = inv_m_sq*lambda_u_sq
    lambda_v_sq = lambda_v*lambda_v
    inv_m_sq_lambda_v_sq = inv_m_sq*lambda_v_sq
    w_6 = inv_m_sq_lambda_u_sq + inv_m_sq_lambda_v_sq
    sqrt_w_6 = math.sqrt(w_6)
    inv_sqrt_w_6 = 1.0/sqrt_w_6
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_7 = inv_smoothing*(sqrt_w_6 - inv_c_norm_factor*(1.0 - lambda_m))
    w_8 = thrust_least if w_7 < thrust_least else u_max if w_7 > u_max else w_7
    inv_m_cubed = inv_m*inv_m*inv_m
    inv_m_cubed_lambda_u_sq = inv_m_cubed*lambda_u_sq
    inv_m_cubed_lambda_v_sq = inv_m_cubed*lambda_v_sq
    w_9 = inv_m_cubed_lambda_u_sq + inv_m_cubed_lambda_v_sq
    w_10 = -w_9
    w_11 = 0.0 if w_7 < thrust_least else 0.0 if w_7 > u_max else 1.0
    inv_smoothing_w_11 = inv_smoothing*w_11
    inv_smoothing_w_11_w_10 = inv_smoothing_w_11*w_10
    w_12 = inv_c_norm_factor*inv_sqrt_w_6
    w_13 = inv_smoothing_w_11_w_10*w_12
    inv_m_sq_lambda_u = inv_m_sq*lambda_u
    inv_sqrt_w_6_cubed = inv_sqrt_w_6*inv_sqrt_w_6*inv_sqrt_w_6
    inv_sqrt_w_6_cubed_w_8 = inv_sqrt_w_6_cubed*w_8
    w_14 = inv_sqrt_w_6_cubed_w_8*w_9
    inv_w_6 = 1.0/w_6
    w_15 = inv_smoothing_w_11*inv_w_6
    w_10_w_15 = w_10*w_15
    inv_m_sq_lambda_v = inv_m_sq*lambda_v
    w_16 = 2.0*inv_m_cubed_lambda_u_sq
    w_8_sq = w_8*w_8
    inv_w_6_w_8_sq = inv_w_6*w_8_sq
    w_17 = 2.0*inv_m_cubed_lambda_v_sq
    w_18 = inv_w_6*inv_w_6*w_8_sq
    w_19 = w_18*(w_16 + w_17)
    w_20 = 2.0*inv_m_sq_lambda_u_sq
    w_21 = inv_smoothing_w_11_w_10*inv_sqrt_w_6_cubed_w_8
    w_22 = 2.0*inv_m_sq_lambda_v_sq
    half_smoothing = 0.5*smoothing
    w_23 = inv_m_sq*inv_sqrt_w_6*w_8
    inv_smoothing_w_11_w_12 = inv_smoothing_w_11*w_12
    w_24 = inv_m_sq_lambda_u*inv_smoothing_w_11_w_12
    w_25 = inv_m*inv_m*inv_m*inv_m
    w_15_w_25 = w_15*w_25
    w_26 = inv_sqrt_w_6_cubed*lambda_u*lambda_v*w_25*w_8 - lambda_u*lambda_v*w_15_w_25
    lambda_u_sq_w_25 = lambda_u_sq*w_25
    inv_m_sq_inv_w_6_w_8_sq = inv_m_sq*inv_w_6_w_8_sq
    w_18_w_25 = w_18*w_25
    w_27 = 2.0*lambda_u*lambda_u*lambda_u
    w_28 = inv_sqrt_w_6_cubed_w_8*w_25
    inv_smoothing_w_11_w_28 = inv_smoothing_w_11*w_28
    w_29 = inv_m_sq_lambda_v*inv_smoothing_w_11_w_12
    twice_lambda_v = 2.0*lambda_v
    w_30 = 2.0*lambda_v*lambda_v*lambda_v
    inv_c_norm_factor_w_8 = inv_c_norm_factor*w_8
    inv_c_sq = inv_c*inv_c
    norm_factor_sq = norm_factor*norm_factor
    w_31 = inv_c_norm_factor_w_8*w_15
    return (
        w,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_4,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_5,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_5,
        0.0,
        inv_r_sq_v*lambda_v_u_value + lambda_u*(2.0*inv_r*inv_r*inv_r*mu - inv_r_sq*v_sq) - inv_r_sq_v*lambda_theta,
        0.0,
        lambda_r - inv_r_v*lambda_v,
        inv_r*lambda_theta + inv_r_v*twice_lambda_u - inv_r*lambda_v_u_value,
        half_smoothing*(inv_m_sq_lambda_u_sq*w_19 + inv_m_sq_lambda_v_sq*w_19 + w_20*w_21 + w_21*w_22 - inv_w_6_w_8_sq*w_16 - inv_w_6_w_8_sq*w_17) + lambda_u*(2.0*inv_m_cubed*inv_sqrt_w_6*lambda_u*w_8 - inv_m_sq_lambda_u*w_10_w_15 - inv_m_sq_lambda_u*w_14) + lambda_v*(2.0*inv_m_cubed*inv_sqrt_w_6*lambda_v*w_8 - inv_m_sq_lambda_v*w_10_w_15 - inv_m_sq_lambda_v*w_14) + w_13 - lambda_m*w_13,
        u_value,
        inv_r_v,
        half_smoothing*(inv_m_sq_inv_w_6_w_8_sq*twice_lambda_u + inv_smoothing_w_11*lambda_v_sq*twice_lambda_u*w_28 + inv_smoothing_w_11_w_28*w_27 - lambda_v_sq*twice_lambda_u*w_18_w_25 - w_18_w_25*w_27) + inv_r*v_sq + lambda_u*(inv_sqrt_w_6_cubed*lambda_u_sq*w_25*w_8 - lambda_u_sq_w_25*w_15 - w_23) + lambda_v*w_26 + w_24 - inv_r_sq*mu - lambda_m*w_24 - lambda_u*w_23,
        half_smoothing*(inv_m_sq_inv_w_6_w_8_sq*twice_lambda_v + inv_smoothing_w_11*inv_sqrt_w_6_cubed_w_8*lambda_u_sq_w_25*twice_lambda_v + inv_smoothing_w_11_w_28*w_30 - lambda_u_sq_w_25*twice_lambda_v*w_18 - w_18_w_25*w_30) + lambda_u*w_26 + lambda_v*(inv_sqrt_w_6_cubed*lambda_v_sq*w_25*w_8 - lambda_v_sq*w_15_w_25 - w_23) + w_29 - inv_r_v*u_value - lambda_m*w_29 - lambda_v*w_23,
        inv_c_sq*inv_smoothing*norm_factor_sq*w_11 + 0.5*smoothing*(w_20*w_31 + w_22*w_31) - inv_c_norm_factor_w_8 - inv_c_sq*inv_smoothing_w_11*lambda_m*norm_factor_sq - inv_m_sq_lambda_u_sq*inv_smoothing_w_11_w_12 - inv_m_sq_lambda_v_sq*inv_smoothing_w_11_w_12,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    mu, c = p
    r_at, theta_at, u_value_at, v_at, m_at = x
    r_mid, theta_mid, u_value_mid, v_mid, m_mid = x_mid
    T_r_at, T_t_at = u
    T_r_mid, T_t_mid = u_mid
    r, theta, u_value, v, m = x0
    inv_c = 1.0/c
    steps = len(times) - 1
    t = times[0]
    r_at[0] = r
    theta_at[0] = theta
    u_value_at[0] = u_value
    v_at[0] = v
    m_at[0] = m
    T_r = T_r_at[0]
    T_t = T_t_at[0]
    inv_r = 1.0/r
    inv_r_v = inv_r*v
    inv_m = 1.0/m
    w = T_r*T_r + T_t*T_t
    sqrt_w = math.sqrt(w)
    inv_c_sqrt_w = inv_c*sqrt_w
    slope_theta = inv_r_v
    slope_u_value = T_r*inv_m + inv_r*v*v - inv_r*inv_r*mu
    slope_v = T_t*inv_m - inv_r_v*u_value
    slope_m = -inv_c_sqrt_w
    slope_total = inv_c_sqrt_w
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        r_at[i] = r
        theta_at[i] = theta
        u_value_at[i] = u_value
        v_at[i] = v
        m_at[i] = m
        T_r_half = T_r_mid[i]
        T_r_end = T_r_at[i + 1]
        T_t_half = T_t_mid[i]
        T_t_end = T_t_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        r_2 = half*u_value + r
        u_value_2 = half*slope_u_value + u_value
        v_2 = half*slope_v + v
        m_2 = half*slope_m + m
        inv_r_2 = 1.0/r_2
        k2_theta = inv_r_2*v_2
        inv_m_2 = 1.0/m_2
        w_2 = T_r_half*T_r_half + T_t_half*T_t_half
        sqrt_w_2 = math.sqrt(w_2)
        k2_total = inv_c*sqrt_w_2
        k2_u_value = T_r_half*inv_m_2 + inv_r_2*v_2*v_2 - inv_r_2*inv_r_2*mu
        k2_v = T_t_half*inv_m_2 - k2_theta*u_value_2
        k2_m = -k2_total
        r_3 = half*u_value_2 + r
        u_value_3 = half*k2_u_value + u_value
        v_3 = half*k2_v + v
        m_3 = half*k2_m + m
        inv_r_3 = 1.0/r_3
        k3_theta = inv_r_3*v_3
        inv_m_3 = 1.0/m_3
        k3_u_value = T_r_half*inv_m_3 + inv_r_3*v_3*v_3 - inv_r_3*inv_r_3*mu
        k3_v = T_t_half*inv_m_3 - k3_theta*u_value_3
        r_4 = h*u_value_3 + r
        u_value_4 = h*k3_u_value + u_value
        v_4 = h*k3_v + v
        m_4 = h*k2_m + m
        inv_r_4 = 1.0/r_4
        k4_theta = inv_r_4*v_4
        inv_m_4 = 1.0/m_4
        w_3 = T_r_end*T_r_end + T_t_end*T_t_end
        sqrt_w_3 = math.sqrt(w_3)
        k4_total = inv_c*sqrt_w_3
        k4_u_value = T_r_end*inv_m_4 + inv_r_4*v_4*v_4 - inv_r_4*inv_r_4*mu
        k4_v = T_t_end*inv_m_4 - k4_theta*u_value_4
        k4_m = -k4_total
        k23_u_value = k2_u_value + k3_u_value
        k123_u_value = k23_u_value + slope_u_value
        r_end = h*(k123_u_value*sixth + u_value) + r
        theta_end = sixth*(k4_theta + slope_theta + 2.0*(k2_theta + k3_theta)) + theta
        u_value_end = sixth*(k123_u_value + k23_u_value + k4_u_value) + u_value
        v_end = sixth*(k4_v + slope_v + 2.0*(k2_v + k3_v)) + v
        m_end = m + sixth*(4.0*k2_m + k4_m + slope_m)
        inv_r_end = 1.0/r_end
        slope_end_theta = inv_r_end*v_end
        inv_m_end = 1.0/m_end
        slope_end_u_value = T_r_end*inv_m_end + inv_r_end*v_end*v_end - inv_r_end*inv_r_end*mu
        slope_end_v = T_t_end*inv_m_end - slope_end_theta*u_value_end
        eighth = 0.125*h
        r_mid[i] = eighth*(u_value - u_value_end) + 0.5*(r + r_end)
        theta_mid[i] = eighth*(slope_theta - slope_end_theta) + 0.5*(theta + theta_end)
        u_value_mid[i] = eighth*(slope_u_value - slope_end_u_value) + 0.5*(u_value + u_value_end)
        v_mid[i] = eighth*(slope_v - slope_end_v) + 0.5*(v + v_end)
        m_mid[i] = eighth*(slope_m - k4_m) + 0.5*(m + m_end)
        total = sixth*(4.0*k2_total + k4_total + slope_total) + total
        t = t_end
        r = r_end
        theta = theta_end
        u_value = u_value_end
        v = v_end
        m = m_end
        slope_theta = slope_end_theta
        slope_u_value = slope_end_u_value
        slope_v = slope_end_v
        slope_m = k4_m
        slope_total = k4_total
    r_at[steps] = r
    theta_at[steps] = theta
    u_value_at[steps] = u_value
    v_at[steps] = v
    m_at[steps] = m
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    mu, c = p
    lambda_r_at, lambda_theta_at, lambda_u_at, lambda_v_at, lambda_m_at = lam
    lambda_r_mid, lambda_theta_mid, lambda_u_mid, lambda_v_mid, lambda_m_mid = lam_mid
    r_at, theta_at, u_value_at, v_at, m_at = x
    T_r_at, T_t_at = u
    r_mid, theta_mid, u_value_mid, v_mid, m_mid = x_mid
    T_r_mid, T_t_mid = u_mid
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam_f
    twice_mu = 2.0*mu
    steps = len(times) - 1
    t = times[steps]
    lambda_r_at[steps] = lambda_r
    lambda_theta_at[steps] = lambda_theta
    lambda_u_at[steps] = lambda_u
    lambda_v_at[steps] = lambda_v
    lambda_m_at[steps] = lambda_m
    r = r_at[steps]
    u_value = u_value_at[steps]
    v = v_at[steps]
    m = m_at[steps]
    T_r = T_r_at[steps]
    T_t = T_t_at[steps]
    inv_r = 1.0/r
    w = inv_r*inv_r*v
    w_2 = inv_r*inv_r*inv_r*(r*v*v - twice_mu)
    u_value_w = u_value*w
    inv_r_v = inv_r*v
    inv_r_u_value = inv_r*u_value
    twice_inv_r_v = 2.0*inv_r_v
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    T_r_inv_m_sq = T_r*inv_m_sq
    T_t_inv_m_sq = T_t*inv_m_sq
    slope_lambda_r = lambda_theta*w + lambda_u*w_2 - lambda_v*u_value_w
    slope_lambda_u = inv_r_v*lambda_v - lambda_r
    slope_lambda_v = inv_r_u_value*lambda_v - inv_r*lambda_theta - lambda_u*twice_inv_r_v
    slope_lambda_m = T_r_inv_m_sq*lambda_u + T_t_inv_m_sq*lambda_v
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        r_half = r_mid[i]
        r_end = r_at[i]
        u_value_half = u_value_mid[i]
        u_value_end = u_value_at[i]
        v_half = v_mid[i]
        v_end = v_at[i]
        m_half = m_mid[i]
        m_end = m_at[i]
        T_r_half = T_r_mid[i]
        T_r_end = T_r_at[i]
        T_t_half = T_t_mid[i]
        T_t_end = T_t_at[i]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_r_2 = half*slope_lambda_r + lambda_r
        lambda_u_2 = half*slope_lambda_u + lambda_u
        lambda_v_2 = half*slope_lambda_v + lambda_v
        inv_r_half = 1.0/r_half
        w_3 = inv_r_half*inv_r_half*v_half
        w_4 = inv_r_half*inv_r_half*inv_r_half*(r_half*v_half*v_half - twice_mu)
        u_value_half_w_3 = u_value_half*w_3
        inv_r_half_v_half = inv_r_half*v_half
        inv_r_half_u_value_half = inv_r_half*u_value_half
        twice_inv_r_half_v_half = 2.0*inv_r_half_v_half
        inv_m_half = 1.0/m_half
        inv_m_half_sq = inv_m_half*inv_m_half
        T_r_half_inv_m_half_sq = T_r_half*inv_m_half_sq
        T_t_half_inv_m_half_sq = T_t_half*inv_m_half_sq
        k2_lambda_r = lambda_theta*w_3 + lambda_u_2*w_4 - lambda_v_2*u_value_half_w_3
        k2_lambda_u = inv_r_half_v_half*lambda_v_2 - lambda_r_2
        k2_lambda_v = inv_r_half_u_value_half*lambda_v_2 - inv_r_half*lambda_theta - lambda_u_2*twice_inv_r_half_v_half
        k2_lambda_m = T_r_half_inv_m_half_sq*lambda_u_2 + T_t_half_inv_m_half_sq*lambda_v_2
        lambda_r_3 = half*k2_lambda_r + lambda_r
        lambda_u_3 = half*k2_lambda_u + lambda_u
        lambda_v_3 = half*k2_lambda_v + lambda_v
        k3_lambda_r = lambda_theta*w_3 + lambda_u_3*w_4 - lambda_v_3*u_value_half_w_3
        k3_lambda_u = inv_r_half_v_half*lambda_v_3 - lambda_r_3
        k3_lambda_v = inv_r_half_u_value_half*lambda_v_3 - inv_r_half*lambda_theta - lambda_u_3*twice_inv_r_half_v_half
        k3_lambda_m = T_r_half_inv_m_half_sq*lambda_u_3 + T_t_half_inv_m_half_sq*lambda_v_3
        lambda_r_4 = h*k3_lambda_r + lambda_r
        lambda_u_4 = h*k3_lambda_u + lambda_u
        lambda_v_4 = h*k3_lambda_v + lambda_v
        inv_r_end = 1.0/r_end
        w_5 = inv_r_end*inv_r_end*v_end
        w_6 = inv_r_end*inv_r_end*inv_r_end*(r_end*v_end*v_end - twice_mu)
        u_value_end_w_5 = u_value_end*w_5
        inv_r_end_v_end = inv_r_end*v_end
        inv_r_end_u_value_end = inv_r_end*u_value_end
        twice_inv_r_end_v_end = 2.0*inv_r_end_v_end
        inv_m_end = 1.0/m_end
        inv_m_end_sq = inv_m_end*inv_m_end
        T_r_end_inv_m_end_sq = T_r_end*inv_m_end_sq
        T_t_end_inv_m_end_sq = T_t_end*inv_m_end_sq
        k4_lambda_r = lambda_theta*w_5 + lambda_u_4*w_6 - lambda_v_4*u_value_end_w_5
        k4_lambda_u = inv_r_end_v_end*lambda_v_4 - lambda_r_4
        k4_lambda_v = inv_r_end_u_value_end*lambda_v_4 - inv_r_end*lambda_theta - lambda_u_4*twice_inv_r_end_v_end
        k4_lambda_m = T_r_end_inv_m_end_sq*lambda_u_4 + T_t_end_inv_m_end_sq*lambda_v_4
        lambda_r_end = lambda_r + sixth*(k4_lambda_r + slope_lambda_r + 2.0*(k2_lambda_r + k3_lambda_r))
        lambda_u_end = lambda_u + sixth*(k4_lambda_u + slope_lambda_u + 2.0*(k2_lambda_u + k3_lambda_u))
        lambda_v_end = lambda_v + sixth*(k4_lambda_v + slope_lambda_v + 2.0*(k2_lambda_v + k3_lambda_v))
        lambda_m_end = lambda_m + sixth*(k4_lambda_m + slope_lambda_m + 2.0*(k2_lambda_m + k3_lambda_m))
        slope_end_lambda_r = lambda_theta*w_5 + lambda_u_end*w_6 - lambda_v_end*u_value_end_w_5
        slope_end_lambda_u = inv_r_end_v_end*lambda_v_end - lambda_r_end
        slope_end_lambda_v = inv_r_end_u_value_end*lambda_v_end - inv_r_end*lambda_theta - lambda_u_end*twice_inv_r_end_v_end
        slope_end_lambda_m = T_r_end_inv_m_end_sq*lambda_u_end + T_t_end_inv_m_end_sq*lambda_v_end
        eighth = 0.125*h
        lambda_r_mid[i] = eighth*(slope_lambda_r - slope_end_lambda_r) + 0.5*(lambda_r + lambda_r_end)
        lambda_r_at[i] = lambda_r_end
        lambda_theta_mid[i] = lambda_theta
        lambda_theta_at[i] = lambda_theta
        lambda_u_mid[i] = eighth*(slope_lambda_u - slope_end_lambda_u) + 0.5*(lambda_u + lambda_u_end)
        lambda_u_at[i] = lambda_u_end
        lambda_v_mid[i] = eighth*(slope_lambda_v - slope_end_lambda_v) + 0.5*(lambda_v + lambda_v_end)
        lambda_v_at[i] = lambda_v_end
        lambda_m_mid[i] = eighth*(slope_lambda_m - slope_end_lambda_m) + 0.5*(lambda_m + lambda_m_end)
        lambda_m_at[i] = lambda_m_end
        t = t_end
        lambda_r = lambda_r_end
        lambda_u = lambda_u_end
        lambda_v = lambda_v_end
        lambda_m = lambda_m_end
        slope_lambda_r = slope_end_lambda_r
        slope_lambda_u = slope_end_lambda_u
        slope_lambda_v = slope_end_lambda_v
        slope_lambda_m = slope_end_lambda_m


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, u, *p))
    inv_r = 1.0/r
    inv_r_v = inv_r*v
    inv_m = 1.0/m
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = np.sqrt(w)
    out[0] = u_value
    out[1] = inv_r_v
    out[2] = T_r*inv_m + inv_r*v*v - inv_r*inv_r*mu
    out[3] = T_t*inv_m - inv_r_v*u_value
    out[4] = -inv_c*sqrt_w
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((5, 5, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_r = 1.0/r
    w = inv_r*inv_r*v
    inv_r_v = inv_r*v
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    out[0, 2] = 1.0
    out[1, 0] = -w
    out[1, 3] = inv_r
    out[2, 0] = inv_r*inv_r*inv_r*(2.0*mu - r*v*v)
    out[2, 3] = 2.0*inv_r_v
    out[2, 4] = -T_r*inv_m_sq
    out[3, 0] = u_value*w
    out[3, 2] = -inv_r_v
    out[3, 3] = -inv_r*u_value
    out[3, 4] = -T_t*inv_m_sq
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((5, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_m = 1.0/m
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    inv_c_inv_sqrt_w = inv_c*inv_sqrt_w
    out[2, 0] = inv_m
    out[3, 1] = inv_m
    out[4, 0] = -T_r*inv_c_inv_sqrt_w
    out[4, 1] = -T_t*inv_c_inv_sqrt_w
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = np.sqrt(w)
    out[...] = inv_c*sqrt_w
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    r, theta, u_value, v, m = x
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    r, theta, u_value, v, m = x
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    inv_m = 1.0/m
    inv_r = 1.0/r
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = np.sqrt(w)
    inv_c_sqrt_w = inv_c*sqrt_w
    inv_r_v = inv_r*v
    out[...] = inv_c_sqrt_w + inv_r_v*lambda_theta + lambda_r*u_value + lambda_u*(T_r*inv_m + inv_r*v*v - inv_r*inv_r*mu) + lambda_v*(T_t*inv_m - inv_r_v*u_value) - inv_c_sqrt_w*lambda_m
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_m = 1.0/m
    inv_c = 1.0/c
    w = T_r*T_r + T_t*T_t
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = inv_c*inv_sqrt_w*(1.0 - lambda_m)
    out[0] = T_r*w_2 + inv_m*lambda_u
    out[1] = T_t*w_2 + inv_m*lambda_v
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, lam, *p))
    T_r_sq = T_r*T_r
    inv_c = 1.0/c
    T_t_sq = T_t*T_t
    w = T_r_sq + T_t_sq
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = 1.0 - lambda_m
    w_3 = -inv_c*inv_sqrt_w*w_2
    w_4 = inv_c*inv_sqrt_w*inv_sqrt_w*inv_sqrt_w*w_2
    w_5 = -T_r*T_t*w_4
    out[0, 0] = -T_r_sq*w_4 - w_3
    out[0, 1] = w_5
    out[1, 0] = w_5
    out[1, 1] = -T_t_sq*w_4 - w_3
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    w = inv_m_sq*lambda_u*lambda_u + inv_m_sq*lambda_v*lambda_v
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    w_2 = inv_smoothing*(sqrt_w - inv_c*norm_factor*(1.0 - lambda_m))
    w_3 = np.minimum(np.maximum(w_2, thrust_least), u_max)
    inv_m_inv_sqrt_w_w_3 = inv_m*inv_sqrt_w*w_3
    out[0] = -inv_m_inv_sqrt_w_w_3*lambda_u
    out[1] = -inv_m_inv_sqrt_w_w_3*lambda_v
    return out


def regularised_cost_batch(t, x, lam, p, bounds, out=None):
    """Integrand of the cost of the regularised problem. Batch form."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, lam, *p, *bounds))
    inv_smoothing = 1.0/smoothing
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    w = inv_m_sq*lambda_u*lambda_u
    w_2 = inv_m_sq*lambda_v*lambda_v
    w_3 = w + w_2
    sqrt_w_3 = np.sqrt(w_3)
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_4 = inv_smoothing*(sqrt_w_3 - inv_c_norm_factor*(1.0 - lambda_m))
    w_5 = np.minimum(np.maximum(w_4, thrust_least), u_max)
    inv_w_3 = 1.0/w_3
    w_6 = inv_w_3*w_5*w_5
    out[...] = inv_c_norm_factor*w_5 + 0.5*smoothing*(w*w_6 + w_2*w_6)
    return out


def throttle_slope_batch(t, x, lam, p, bounds, out=None):
    """How H changes with the norm of each vector that may be none, along its best direction. Batch form."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    w = inv_m_sq*lambda_u*lambda_u + inv_m_sq*lambda_v*lambda_v
    sqrt_w = np.sqrt(w)
    inv_c = 1.0/c
    out[0] = inv_c*(1.0 - lambda_m) - sqrt_w
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    r, theta, u_value, v, m = x
    T_r, T_t = u
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_r = 1.0/r
    w = inv_r*inv_r*v
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    out[0] = inv_r*inv_r*inv_r*lambda_u*(r*v*v - 2.0*mu) + lambda_theta*w - lambda_v*u_value*w
    out[1] = 0.0
    out[2] = inv_r*lambda_v*v - lambda_r
    out[3] = inv_r*lambda_v*u_value - inv_r*lambda_theta - 2.0*inv_r*lambda_u*v
    out[4] = T_r*inv_m_sq*lambda_u + T_t*inv_m_sq*lambda_v
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((10, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_r = 1.0/r
    inv_r_v = inv_r*v
    inv_r_sq = inv_r*inv_r
    v_sq = v*v
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    lambda_u_sq = lambda_u*lambda_u
    lambda_v_sq = lambda_v*lambda_v
    w = inv_m_sq*lambda_u_sq + inv_m_sq*lambda_v_sq
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_2 = inv_smoothing*(sqrt_w - inv_c_norm_factor*(1.0 - lambda_m))
    w_3 = np.minimum(np.maximum(w_2, thrust_least), u_max)
    inv_sqrt_w_w_3 = inv_sqrt_w*w_3
    inv_m_sq_inv_sqrt_w_w_3 = inv_m_sq*inv_sqrt_w_w_3
    inv_r_sq_v = inv_r_sq*v
    w_4 = inv_m*inv_m*inv_m*inv_sqrt_w_w_3
    out[0] = u_value
    out[1] = inv_r_v
    out[2] = inv_r*v_sq - inv_m_sq_inv_sqrt_w_w_3*lambda_u - inv_r_sq*mu
    out[3] = -inv_m_sq_inv_sqrt_w_w_3*lambda_v - inv_r_v*u_value
    out[4] = -inv_c_norm_factor*w_3
    out[5] = inv_r*inv_r*inv_r*lambda_u*(r*v_sq - 2.0*mu) + inv_r_sq_v*lambda_theta - inv_r_sq_v*lambda_v*u_value
    out[6] = 0.0
    out[7] = inv_r_v*lambda_v - lambda_r
    out[8] = inv_r*lambda_v*u_value - inv_r*lambda_theta - 2.0*inv_r_v*lambda_u
    out[9] = -lambda_u_sq*w_4 - lambda_v_sq*w_4
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((10, 10, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    inv_r_sq_v = inv_r_sq*v
    inv_r_cubed = inv_r*inv_r*inv_r
    twice_mu = 2.0*mu
    v_sq = v*v
    inv_r_v = inv_r*v
    twice_inv_r_v = 2.0*inv_r_v
    twice_lambda_u = 2.0*lambda_u
    inv_m = 1.0/m
    inv_m_cubed = inv_m*inv_m*inv_m
    inv_m_sq = inv_m*inv_m
    lambda_u_sq = lambda_u*lambda_u
    lambda_v_sq = lambda_v*lambda_v
    w = inv_m_sq*lambda_u_sq + inv_m_sq*lambda_v_sq
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_2 = inv_smoothing*(sqrt_w - inv_c_norm_factor*(1.0 - lambda_m))
    w_3 = np.minimum(np.maximum(w_2, thrust_least), u_max)
    inv_sqrt_w_w_3 = inv_sqrt_w*w_3
    w_4 = inv_m_cubed*inv_sqrt_w_w_3
    twice_lambda_u_w_4 = twice_lambda_u*w_4
    inv_m_cubed_lambda_u_sq = inv_m_cubed*lambda_u_sq
    inv_m_cubed_lambda_v_sq = inv_m_cubed*lambda_v_sq
    w_5 = inv_m_cubed_lambda_u_sq + inv_m_cubed_lambda_v_sq
    inv_sqrt_w_cubed = inv_sqrt_w*inv_sqrt_w*inv_sqrt_w
    inv_sqrt_w_cubed_w_3_w_5 = inv_sqrt_w_cubed*w_3*w_5
    inv_m_sq_lambda_u = inv_m_sq*lambda_u
    w_6 = -w_5
    inv_w = 1.0/w
    w_7 = np.heaviside(w_2 - thrust_least, 1.0)*np.heaviside(u_max - w_2, 1.0)
    inv_smoothing_w_7 = inv_smoothing*w_7
    inv_smoothing_w_7_inv_w = inv_smoothing_w_7*inv_w
    w_8 = inv_smoothing_w_7_inv_w*w_6
    inv_m_sq_inv_sqrt_w_w_3 = inv_m_sq*inv_sqrt_w_w_3
    w_9 = inv_m*inv_m*inv_m*inv_m
    w_10 = inv_sqrt_w_cubed*lambda_u*lambda_v*w_3*w_9 - inv_smoothing_w_7_inv_w*lambda_u*lambda_v*w_9
    w_11 = inv_c_norm_factor*inv_smoothing_w_7*inv_sqrt_w
    w_12 = -inv_m_sq_lambda_u*w_11
    inv_r_sq_v_u_value = inv_r_sq_v*u_value
    inv_r_u_value = inv_r*u_value
    w_13 = 2.0*lambda_v*w_4
    inv_m_sq_lambda_v = inv_m_sq*lambda_v
    w_14 = -inv_m_sq_lambda_v*w_11
    w_15 = r*v_sq - twice_mu
    w_16 = -inv_r_sq_v*lambda_v
    w_17 = inv_r_sq*lambda_theta + inv_r_sq_v*twice_lambda_u - inv_r_sq*lambda_v*u_value
    inv_r_lambda_v = inv_r*lambda_v
    lambda_u_cubed = lambda_u*lambda_u*lambda_u
    inv_m_sq_sq = inv_m_sq*inv_m_sq
    w_18 = inv_m*inv_m_sq_sq*inv_smoothing_w_7_inv_w
    lambda_v_cubed = lambda_v*lambda_v*lambda_v
    out[0, 2] = 1.0
    out[1, 0] = -inv_r_sq_v
    out[1, 3] = inv_r
    out[2, 0] = inv_r_cubed*twice_mu - inv_r_sq*v_sq
    out[2, 3] = twice_inv_r_v
    out[2, 4] = twice_lambda_u_w_4 - inv_m_sq_lambda_u*inv_sqrt_w_cubed_w_3_w_5 - inv_m_sq_lambda_u*w_8
    out[2, 7] = inv_sqrt_w_cubed*lambda_u_sq*w_3*w_9 - inv_m_sq_inv_sqrt_w_w_3 - inv_smoothing_w_7_inv_w*lambda_u_sq*w_9
    out[2, 8] = w_10
    out[2, 9] = w_12
    out[3, 0] = inv_r_sq_v_u_value
    out[3, 2] = -inv_r_v
    out[3, 3] = -inv_r_u_value
    out[3, 4] = w_13 - inv_m_sq_lambda_v*inv_sqrt_w_cubed_w_3_w_5 - inv_m_sq_lambda_v*w_8
    out[3, 7] = w_10
    out[3, 8] = inv_sqrt_w_cubed*lambda_v_sq*w_3*w_9 - inv_m_sq_inv_sqrt_w_w_3 - inv_smoothing_w_7_inv_w*lambda_v_sq*w_9
    out[3, 9] = w_14
    out[4, 4] = -w_11*w_6
    out[4, 7] = w_12
    out[4, 8] = w_14
    out[4, 9] = -inv_c*inv_c*inv_smoothing_w_7*norm_factor*norm_factor
    out[5, 0] = inv_r_cubed*lambda_u*v_sq + 2.0*inv_r_cubed*lambda_v*u_value*v - 3.0*inv_r*inv_r*inv_r*inv_r*lambda_u*w_15 - 2.0*inv_r_cubed*lambda_theta*v
    out[5, 2] = w_16
    out[5, 3] = w_17
    out[5, 6] = inv_r_sq_v
    out[5, 7] = inv_r_cubed*w_15
    out[5, 8] = -inv_r_sq_v_u_value
    out[7, 0] = w_16
    out[7, 3] = inv_r_lambda_v
    out[7, 5] = -1.0
    out[7, 8] = inv_r_v
    out[8, 0] = w_17
    out[8, 2] = inv_r_lambda_v
    out[8, 3] = -inv_r*twice_lambda_u
    out[8, 6] = -inv_r
    out[8, 7] = -twice_inv_r_v
    out[8, 8] = inv_r_u_value
    out[9, 4] = 3.0*inv_sqrt_w*lambda_u_sq*w_3*w_9 + 3.0*inv_sqrt_w*lambda_v_sq*w_3*w_9 - inv_m_cubed_lambda_u_sq*inv_sqrt_w_cubed_w_3_w_5 - inv_m_cubed_lambda_u_sq*w_8 - inv_m_cubed_lambda_v_sq*inv_sqrt_w_cubed_w_3_w_5 - inv_m_cubed_lambda_v_sq*w_8
    out[9, 7] = inv_m*inv_m_sq_sq*inv_sqrt_w_cubed*lambda_u*lambda_v_sq*w_3 + inv_m*inv_m_sq_sq*inv_sqrt_w_cubed*lambda_u_cubed*w_3 - lambda_u*lambda_v_sq*w_18 - lambda_u_cubed*w_18 - twice_lambda_u_w_4
    out[9, 8] = inv_m*inv_m_sq_sq*inv_sqrt_w_cubed*lambda_u_sq*lambda_v*w_3 + inv_m*inv_m_sq_sq*inv_sqrt_w_cubed*lambda_v_cubed*w_3 - lambda_u_sq*lambda_v*w_18 - lambda_v_cubed*w_18 - w_13
    out[9, 9] = -inv_m_cubed_lambda_u_sq*w_11 - inv_m_cubed_lambda_v_sq*w_11
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((10, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = 0.0
    out[7] = 0.0
    out[8] = 0.0
    out[9] = 0.0
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    given_r, given_theta, given_u, given_v, given_m, on_reference_r, on_reference_theta, on_reference_u, on_reference_v, on_reference_m, target_r, target_theta, target_u, target_v, target_m = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    inv_r = 1.0/r
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    w = inv_m_sq*lambda_u*lambda_u
    w_2 = inv_m_sq*lambda_v*lambda_v
    inv_r_v = inv_r*v
    w_3 = w + w_2
    sqrt_w_3 = np.sqrt(w_3)
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_4 = inv_smoothing*(sqrt_w_3 - inv_c_norm_factor*(1.0 - lambda_m))
    w_5 = np.minimum(np.maximum(w_4, thrust_least), u_max)
    inv_c_norm_factor_w_5 = inv_c_norm_factor*w_5
    inv_sqrt_w_3 = 1.0/sqrt_w_3
    w_6 = inv_m_sq*inv_sqrt_w_3*w_5
    inv_w_3 = 1.0/w_3
    w_7 = inv_w_3*w_5*w_5
    out[0] = given_r*(r - target_r) + lambda_r*(1.0 - given_r - on_reference_r) + on_reference_r*r
    out[1] = given_theta*(theta - target_theta) + lambda_theta*(1.0 - given_theta - on_reference_theta) + on_reference_theta*theta
    out[2] = given_u*(u_value - target_u) + lambda_u*(1.0 - given_u - on_reference_u) + on_reference_u*u_value
    out[3] = given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v
    out[4] = given_m*(m - target_m) + lambda_m*(1.0 - given_m - on_reference_m) + m*on_reference_m
    out[5] = inv_c_norm_factor_w_5 + inv_r_v*lambda_theta + lambda_r*u_value + lambda_u*(inv_r*v*v - inv_r*inv_r*mu - lambda_u*w_6) + lambda_v*(-inv_r_v*u_value - lambda_v*w_6) + 0.5*smoothing*(w*w_7 + w_2*w_7) - inv_c_norm_factor_w_5*lambda_m
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    r, theta, u_value, v, m = x
    lambda_r, lambda_theta, lambda_u, lambda_v, lambda_m = lam
    mu, c = p
    u_max, smoothing, norm_factor, thrust_least = bounds
    given_r, given_theta, given_u, given_v, given_m, on_reference_r, on_reference_theta, on_reference_u, on_reference_v, on_reference_m, target_r, target_theta, target_u, target_v, target_m = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, 11, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_r + on_reference_r
    w_2 = given_theta + on_reference_theta
    w_3 = given_u + on_reference_u
    w_4 = given_v + on_reference_v
    w_5 = given_m + on_reference_m
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    inv_r_sq_v = inv_r_sq*v
    lambda_v_u_value = lambda_v*u_value
    v_sq = v*v
    inv_r_v = inv_r*v
    twice_lambda_u = 2.0*lambda_u
    inv_m = 1.0/m
    inv_m_sq = inv_m*inv_m
    lambda_u_sq = lambda_u*lambda_u
    inv_m_sq_lambda_u_sq = inv_m_sq*lambda_u_sq
    lambda_v_sq = lambda_v*lambda_v
    inv_m_sq_lambda_v_sq = inv_m_sq*lambda_v_sq
    w_6 = inv_m_sq_lambda_u_sq + inv_m_sq_lambda_v_sq
    sqrt_w_6 = np.sqrt(w_6)
    inv_sqrt_w_6 = 1.0/sqrt_w_6
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_norm_factor = inv_c*norm_factor
    w_7 = inv_smoothing*(sqrt_w_6 - inv_c_norm_factor*(1.0 - lambda_m))
    w_8 = np.minimum(np.maximum(w_7, thrust_least), u_max)
    inv_m_cubed = inv_m*inv_m*inv_m
    inv_m_cubed_lambda_u_sq = inv_m_cubed*lambda_u_sq
    inv_m_cubed_lambda_v_sq = inv_m_cubed*lambda_v_sq
    w_9 = inv_m_cubed_lambda_u_sq + inv_m_cubed_lambda_v_sq
    w_10 = -w_9
    w_11 = np.heaviside(w_7 - thrust_least, 1.0)*np.heaviside(u_max - w_7, 1.0)
    inv_smoothing_w_11 = inv_smoothing*w_11
    inv_smoothing_w_11_w_10 = inv_smoothing_w_11*w_10
    w_12 = inv_c_norm_factor*inv_sqrt_w_6
    w_13 = inv_smoothing_w_11_w_10*w_12
    inv_m_sq_lambda_u = inv_m_sq*lambda_u
    inv_sqrt_w_6_cubed = inv_sqrt_w_6*inv_sqrt_w_6*inv_sqrt_w_6
    inv_sqrt_w_6_cubed_w_8 = inv_sqrt_w_6_cubed*w_8
    w_14 = inv_sqrt_w_6_cubed_w_8*w_9
    inv_w_6 = 1.0/w_6
    w_15 = inv_smoothing_w_11*inv_w_6
    w_10_w_15 = w_10*w_15
    inv_m_sq_lambda_v = inv_m_sq*lambda_v
    w_16 = 2.0*inv_m_cubed_lambda_u_sq
    w_8_sq = w_8*w_8
    inv_w_6_w_8_sq = inv_w_6*w_8_sq
    w_17 = 2.0*inv_m_cubed_lambda_v_sq
    w_18 = inv_w_6*inv_w_6*w_8_sq
    w_19 = w_18*(w_16 + w_17)
    w_20 = 2.0*inv_m_sq_lambda_u_sq
    w_21 = inv_smoothing_w_11_w_10*inv_sqrt_w_6_cubed_w_8
    w_22 = 2.0*inv_m_sq_lambda_v_sq
    half_smoothing = 0.5*smoothing
    w_23 = inv_m_sq*inv_sqrt_w_6*w_8
    inv_smoothing_w_11_w_12 = inv_smoothing_w_11*w_12
    w_24 = inv_m_sq_lambda_u*inv_smoothing_w_11_w_12
    w_25 = inv_m*inv_m*inv_m*inv_m
    w_15_w_25 = w_15*w_25
    w_26 = inv_sqrt_w_6_cubed*lambda_u*lambda_v*w_25*w_8 - lambda_u*lambda_v*w_15_w_25
    lambda_u_sq_w_25 = lambda_u_sq*w_25
    inv_m_sq_inv_w_6_w_8_sq = inv_m_sq*inv_w_6_w_8_sq
    w_18_w_25 = w_18*w_25
    w_27 = 2.0*lambda_u*lambda_u*lambda_u
    w_28 = inv_sqrt_w_6_cubed_w_8*w_25
    inv_smoothing_w_11_w_28 = inv_smoothing_w_11*w_28
    w_29 = inv_m_sq_lambda_v*inv_smoothing_w_11_w_12
    twice_lambda_v = 2.0*lambda_v
    w_30 = 2.0*lambda_v*lambda_v*lambda_v
    inv_c_norm_factor_w_8 = inv_c_norm_factor*w_8
    inv_c_sq = inv_c*inv_c
    norm_factor_sq = norm_factor*norm_factor
    w_31 = inv_c_norm_factor_w_8*w_15
    out[0, 0] = w
    out[0, 5] = 1.0 - w
    out[1, 1] = w_2
    out[1, 6] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 7] = 1.0 - w_3
    out[3, 3] = w_4
    out[3, 8] = 1.0 - w_4
    out[4, 4] = w_5
    out[4, 9] = 1.0 - w_5
    out[5, 0] = inv_r_sq_v*lambda_v_u_value + lambda_u*(2.0*inv_r*inv_r*inv_r*mu - inv_r_sq*v_sq) - inv_r_sq_v*lambda_theta
    out[5, 2] = lambda_r - inv_r_v*lambda_v
    out[5, 3] = inv_r*lambda_theta + inv_r_v*twice_lambda_u - inv_r*lambda_v_u_value
    out[5, 4] = half_smoothing*(inv_m_sq_lambda_u_sq*w_19 + inv_m_sq_lambda_v_sq*w_19 + w_20*w_21 + w_21*w_22 - inv_w_6_w_8_sq*w_16 - inv_w_6_w_8_sq*w_17) + lambda_u*(2.0*inv_m_cubed*inv_sqrt_w_6*lambda_u*w_8 - inv_m_sq_lambda_u*w_10_w_15 - inv_m_sq_lambda_u*w_14) + lambda_v*(2.0*inv_m_cubed*inv_sqrt_w_6*lambda_v*w_8 - inv_m_sq_lambda_v*w_10_w_15 - inv_m_sq_lambda_v*w_14) + w_13 - lambda_m*w_13
    out[5, 5] = u_value
    out[5, 6] = inv_r_v
    out[5, 7] = half_smoothing*(inv_m_sq_inv_w_6_w_8_sq*twice_lambda_u + inv_smoothing_w_11*lambda_v_sq*twice_lambda_u*w_28 + inv_smoothing_w_11_w_28*w_27 - lambda_v_sq*twice_lambda_u*w_18_w_25 - w_18_w_25*w_27) + inv_r*v_sq + lambda_u*(inv_sqrt_w_6_cubed*lambda_u_sq*w_25*w_8 - lambda_u_sq_w_25*w_15 - w_23) + lambda_v*w_26 + w_24 - inv_r_sq*mu - lambda_m*w_24 - lambda_u*w_23
    out[5, 8] = half_smoothing*(inv_m_sq_inv_w_6_w_8_sq*twice_lambda_v + inv_smoothing_w_11*inv_sqrt_w_6_cubed_w_8*lambda_u_sq_w_25*twice_lambda_v + inv_smoothing_w_11_w_28*w_30 - lambda_u_sq_w_25*twice_lambda_v*w_18 - w_18_w_25*w_30) + lambda_u*w_26 + lambda_v*(inv_sqrt_w_6_cubed*lambda_v_sq*w_25*w_8 - lambda_v_sq*w_15_w_25 - w_23) + w_29 - inv_r_v*u_value - lambda_m*w_29 - lambda_v*w_23
    out[5, 9] = inv_c_sq*inv_smoothing*norm_factor_sq*w_11 + 0.5*smoothing*(w_20*w_31 + w_22*w_31) - inv_c_norm_factor_w_8 - inv_c_sq*inv_smoothing_w_11*lambda_m*norm_factor_sq - inv_m_sq_lambda_u_sq*inv_smoothing_w_11_w_12 - inv_m_sq_lambda_v_sq*inv_smoothing_w_11_w_12
    return out
