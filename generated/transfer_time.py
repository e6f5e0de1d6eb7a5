"""Minimum-time transfer between circular orbits.

Written by satsym from derivations/examples/transfer_time.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/transfer_time.py
Source: ../derivations/examples/transfer_time.py b4b089fe3a65aa4bf480ad7c016c7e83
Digest: fbd1a88cc224b27b9cb0b5a7a9981c668c4d0d6968cd2ee2796a6bc985e1fa93
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'transfer_time',
    'title': 'Minimum-time transfer between circular orbits',
    'source': 'derivations/examples/transfer_time.py',
    'states': (
        {'symbol': 'r', 'latex': 'r', 'meaning': 'distance from the centre of force', 'positive': True},
        {'symbol': 'u', 'latex': 'u', 'meaning': 'radial velocity'},
        {'symbol': 'v', 'latex': 'v', 'meaning': 'transverse velocity'},
    ),
    'controls': (
        {'symbol': 'beta', 'latex': '\\beta', 'meaning': 'direction of the thrust, above the local horizontal', 'kind': 'angle'},
    ),
    'parameters': (
        {'symbol': 'mu', 'latex': '\\mu', 'meaning': 'gravitational parameter', 'default': 1.0, 'positive': True},
        {'symbol': 'F', 'latex': 'F', 'meaning': 'thrust over the initial mass', 'default': 0.1405, 'positive': True},
        {'symbol': 'w', 'latex': 'w', 'meaning': 'mass flow rate over the initial mass', 'default': 0.07487, 'positive': True},
    ),
    'control_set': 'product',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': False,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'control_parts': (
        {'name': 'steering', 'kind': 'angle', 'controls': ('beta',), 'branch': 'direction'},
    ),
    'objective_unit': '1',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    r, u_value, v = x
    (beta,) = u
    mu, F, w = p
    inv_r = 1.0/r
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    F_inv_w_2 = F*inv_w_2
    return (
        u_value,
        F_inv_w_2*math.sin(beta) + inv_r*v*v - inv_r*inv_r*mu,
        F_inv_w_2*math.cos(beta) - inv_r*u_value*v,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    r, u_value, v = x
    (beta,) = u
    mu, F, w = p
    inv_r = 1.0/r
    inv_r_v = inv_r*v
    return (
        0.0,
        1.0,
        0.0,
        inv_r*inv_r*inv_r*(2.0*mu - r*v*v),
        0.0,
        2.0*inv_r_v,
        inv_r*inv_r*u_value*v,
        -inv_r_v,
        -inv_r*u_value,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    r, u_value, v = x
    (beta,) = u
    mu, F, w = p
    w_2 = t*w - 1.0
    w_3 = -w_2
    inv_w_3 = 1.0/w_3
    inv_w_2 = 1.0/w_2
    return (
        0.0,
        F*inv_w_3*math.cos(beta),
        F*inv_w_2*math.sin(beta),
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    r, u_value, v = x
    (beta,) = u
    mu, F, w = p
    return 1.0


def terminal_cost(t, x, p):
    """Terminal cost S."""
    r, u_value, v = x
    mu, F, w = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    r, u_value, v = x
    mu, F, w = p
    return (
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    r, u_value, v = x
    (beta,) = u
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    inv_r = 1.0/r
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    F_inv_w_2 = F*inv_w_2
    return lambda_r*u_value + lambda_u*(F_inv_w_2*math.sin(beta) + inv_r*v*v - inv_r*inv_r*mu) + lambda_v*(F_inv_w_2*math.cos(beta) - inv_r*u_value*v) + 1.0


def stationarity(t, x, u, lam, p):
    """H_u."""
    r, u_value, v = x
    (beta,) = u
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    return (
        F*inv_w_2*(lambda_u*math.cos(beta) - lambda_v*math.sin(beta)),
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    r, u_value, v = x
    (beta,) = u
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    return (
        F*inv_w_2*(-lambda_u*math.sin(beta) - lambda_v*math.cos(beta)),
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    F_inv_w_2 = F*inv_w_2
    return (
        math.atan2(-F_inv_w_2*lambda_u, -F_inv_w_2*lambda_v),
    )


def regularised_cost(t, x, lam, p, bounds):
    """Integrand of the cost of the regularised problem."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    w_3 = F*F*inv_w_2*inv_w_2
    w_4 = lambda_u*lambda_u*w_3
    w_5 = lambda_v*lambda_v*w_3
    w_6 = w_4 + w_5
    w_7 = beta_reach/math.sqrt(w_6) if w_6 > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    w_7_sq = w_7*w_7
    return 0.5*smoothing*(w_4*w_7_sq + w_5*w_7_sq) + 1.0


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    r, u_value, v = x
    (beta,) = u
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    inv_r = 1.0/r
    return (
        inv_r*inv_r*inv_r*lambda_u*(r*v*v - 2.0*mu) - inv_r*inv_r*lambda_v*u_value*v,
        inv_r*lambda_v*v - lambda_r,
        inv_r*lambda_v*u_value - 2.0*inv_r*lambda_u*v,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    v_sq = v*v
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    w_3 = F*F*inv_w_2*inv_w_2
    w_4 = lambda_u*lambda_u*w_3 + lambda_v*lambda_v*w_3
    w_5 = beta_reach/math.sqrt(w_4) if w_4 > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    w_3_w_5 = w_3*w_5
    inv_r_v = inv_r*v
    return (
        u_value,
        inv_r*v_sq - inv_r_sq*mu - lambda_u*w_3_w_5,
        -inv_r_v*u_value - lambda_v*w_3_w_5,
        inv_r*inv_r*inv_r*lambda_u*(r*v_sq - 2.0*mu) - inv_r_sq*lambda_v*u_value*v,
        inv_r_v*lambda_v - lambda_r,
        inv_r*lambda_v*u_value - 2.0*inv_r_v*lambda_u,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    inv_r = 1.0/r
    inv_r_cubed = inv_r*inv_r*inv_r
    twice_mu = 2.0*mu
    inv_r_sq = inv_r*inv_r
    v_sq = v*v
    inv_r_v = inv_r*v
    twice_inv_r_v = 2.0*inv_r_v
    lambda_u_sq = lambda_u*lambda_u
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    w_3 = F*F*inv_w_2*inv_w_2
    lambda_v_sq = lambda_v*lambda_v
    w_4 = lambda_u_sq*w_3 + lambda_v_sq*w_3
    w_5 = -0.5*beta_reach/(w_4*math.sqrt(w_4)) if w_4 > smoothing*beta_reach*(smoothing*beta_reach) else 0.0
    w_6 = F*F*F*F*inv_w_2*inv_w_2*inv_w_2*inv_w_2*w_5
    twice_w_6 = 2.0*w_6
    w_7 = beta_reach/math.sqrt(w_4) if w_4 > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    w_3_w_7 = w_3*w_7
    twice_lambda_u = 2.0*lambda_u
    w_8 = -lambda_v*twice_lambda_u*w_6
    inv_r_sq_v = inv_r_sq*v
    inv_r_sq_v_u_value = inv_r_sq_v*u_value
    inv_r_u_value = inv_r*u_value
    lambda_v_u_value = lambda_v*u_value
    w_9 = r*v_sq - twice_mu
    w_10 = -inv_r_sq_v*lambda_v
    w_11 = inv_r_sq_v*twice_lambda_u - inv_r_sq*lambda_v_u_value
    inv_r_lambda_v = inv_r*lambda_v
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        inv_r_cubed*twice_mu - inv_r_sq*v_sq,
        0.0,
        twice_inv_r_v,
        0.0,
        -lambda_u_sq*twice_w_6 - w_3_w_7,
        w_8,
        inv_r_sq_v_u_value,
        -inv_r_v,
        -inv_r_u_value,
        0.0,
        w_8,
        -lambda_v_sq*twice_w_6 - w_3_w_7,
        inv_r_cubed*lambda_u*v_sq + 2.0*inv_r_cubed*lambda_v_u_value*v - 3.0*inv_r*inv_r*inv_r*inv_r*lambda_u*w_9,
        w_10,
        w_11,
        0.0,
        inv_r_cubed*w_9,
        -inv_r_sq_v_u_value,
        w_10,
        0.0,
        inv_r_lambda_v,
        -1.0,
        0.0,
        inv_r_v,
        w_11,
        inv_r_lambda_v,
        -inv_r*twice_lambda_u,
        0.0,
        -twice_inv_r_v,
        inv_r_u_value,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    lambda_u_sq = lambda_u*lambda_u
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    F_sq = F*F
    w_3 = F_sq*inv_w_2*inv_w_2
    lambda_v_sq = lambda_v*lambda_v
    w_4 = lambda_u_sq*w_3 + lambda_v_sq*w_3
    w_5 = beta_reach/math.sqrt(w_4) if w_4 > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    w_6 = 2.0*F_sq*inv_w_2*inv_w_2*inv_w_2*w
    w_5_w_6 = w_5*w_6
    w_7 = -0.5*beta_reach/(w_4*math.sqrt(w_4)) if w_4 > smoothing*beta_reach*(smoothing*beta_reach) else 0.0
    w_8 = w_3*w_7*(lambda_u_sq*w_6 + lambda_v_sq*w_6)
    return (
        0.0,
        -lambda_u*w_5_w_6 - lambda_u*w_8,
        -lambda_v*w_5_w_6 - lambda_v*w_8,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    given_r, given_u, given_v, on_reference_r, on_reference_u, on_reference_v, target_r, target_u, target_v = final
    inv_r = 1.0/r
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    w_3 = F*F*inv_w_2*inv_w_2
    w_4 = lambda_u*lambda_u*w_3
    w_5 = lambda_v*lambda_v*w_3
    w_6 = w_4 + w_5
    w_7 = beta_reach/math.sqrt(w_6) if w_6 > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    w_7_sq = w_7*w_7
    return (
        given_r*(r - target_r) + lambda_r*(1.0 - given_r - on_reference_r) + on_reference_r*r,
        given_u*(u_value - target_u) + lambda_u*(1.0 - given_u - on_reference_u) + on_reference_u*u_value,
        given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v,
        lambda_r*u_value + lambda_u*(inv_r*v*v - inv_r*inv_r*mu) + 0.5*smoothing*(w_4*w_7_sq + w_5*w_7_sq) + 1.0 - inv_r*lambda_v*u_value*v - w_4*w_7 - w_5*w_7,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    given_r, given_u, given_v, on_reference_r, on_reference_u, on_reference_v, target_r, target_u, target_v = final
    w_2 = given_r + on_reference_r
    w_3 = given_u + on_reference_u
    w_4 = given_v + on_reference_v
    inv_r = 1.0/r
    u_value_v = u_value*v
    v_sq = v*v
    inv_r_sq = inv_r*inv_r
    inv_r_lambda_v = inv_r*lambda_v
    twice_lambda_u = 2.0*lambda_u
    lambda_u_sq = lambda_u*lambda_u
    w_5 = 1.0 - t*w
    inv_w_5 = 1.0/w_5
    F_sq = F*F
    w_6 = F_sq*inv_w_5*inv_w_5
    lambda_u_sq_w_6 = lambda_u_sq*w_6
    lambda_v_sq = lambda_v*lambda_v
    lambda_v_sq_w_6 = lambda_v_sq*w_6
    w_7 = lambda_u_sq_w_6 + lambda_v_sq_w_6
    w_8 = beta_reach/math.sqrt(w_7) if w_7 > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    twice_lambda_u_w_6 = twice_lambda_u*w_6
    lambda_u_cubed = lambda_u*lambda_u*lambda_u
    w_9 = -0.5*beta_reach/(w_7*math.sqrt(w_7)) if w_7 > smoothing*beta_reach*(smoothing*beta_reach) else 0.0
    twice_w_9 = 2.0*w_9
    w_10 = F*F*F*F*inv_w_5*inv_w_5*inv_w_5*inv_w_5
    twice_w_9_w_10 = twice_w_9*w_10
    w_10_w_9 = w_10*w_9
    w_8_sq = w_8*w_8
    w_11 = 4.0*w_10_w_9*w_8
    lambda_v_w_6 = lambda_v*w_6
    twice_w_8 = 2.0*w_8
    lambda_v_cubed = lambda_v*lambda_v*lambda_v
    lambda_u_sq_lambda_v = lambda_u_sq*lambda_v
    twice_w_8_sq = 2.0*w_8_sq
    w_12 = F_sq*inv_w_5*inv_w_5*inv_w_5*w
    twice_w_8_w_12 = twice_w_8*w_12
    twice_w_12 = 2.0*w_12
    w_13 = lambda_u_sq*twice_w_12 + lambda_v_sq*twice_w_12
    w_13_w_9 = w_13*w_9
    twice_w_8_sq_w_12 = twice_w_8_sq*w_12
    twice_w_9_w_13_w_8 = twice_w_9*w_13*w_8
    return (
        w_2,
        0.0,
        0.0,
        1.0 - w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        0.0,
        0.0,
        1.0 - w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        w_4,
        0.0,
        0.0,
        1.0 - w_4,
        0.0,
        inv_r_sq*lambda_v*u_value_v + lambda_u*(2.0*inv_r*inv_r*inv_r*mu - inv_r_sq*v_sq),
        lambda_r - inv_r_lambda_v*v,
        inv_r*twice_lambda_u*v - inv_r_lambda_v*u_value,
        u_value,
        inv_r*v_sq + 0.5*smoothing*(lambda_u*lambda_v_sq*w_11 + lambda_u_cubed*w_11 + twice_lambda_u_w_6*w_8_sq) - inv_r_sq*mu - lambda_u_cubed*twice_w_9_w_10 - lambda_v_sq*twice_lambda_u*w_10_w_9 - twice_lambda_u_w_6*w_8,
        0.5*smoothing*(lambda_u_sq_lambda_v*w_11 + lambda_v_cubed*w_11 + lambda_v_w_6*twice_w_8_sq) - inv_r*u_value_v - lambda_u_sq_lambda_v*twice_w_9_w_10 - lambda_v_cubed*twice_w_9_w_10 - lambda_v_w_6*twice_w_8,
        0.5*smoothing*(lambda_u_sq*twice_w_8_sq_w_12 + lambda_u_sq_w_6*twice_w_9_w_13_w_8 + lambda_v_sq*twice_w_8_sq_w_12 + lambda_v_sq_w_6*twice_w_9_w_13_w_8) - lambda_u_sq*twice_w_8_w_12 - lambda_u_sq_w_6*w_13_w_9 - lambda_v_sq*twice_w_8_w_12 - lambda_v_sq_w_6*w_13_w_9,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    mu, F, w = p
    r_at, u_value_at, v_at = x
    r_mid, u_value_mid, v_mid = x_mid
    (beta_at,) = u
    (beta_mid,) = u_mid
    r, u_value, v = x0
    steps = len(times) - 1
    t = times[0]
    r_at[0] = r
    u_value_at[0] = u_value
    v_at[0] = v
    beta = beta_at[0]
    inv_r = 1.0/r
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    F_inv_w_2 = F*inv_w_2
    slope_u_value = F_inv_w_2*math.sin(beta) + inv_r*v*v - inv_r*inv_r*mu
    slope_v = F_inv_w_2*math.cos(beta) - inv_r*u_value*v
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        r_at[i] = r
        u_value_at[i] = u_value
        v_at[i] = v
        beta_half = beta_mid[i]
        beta_end = beta_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        r_2 = half*u_value + r
        u_value_2 = half*slope_u_value + u_value
        v_2 = half*slope_v + v
        w_3 = half + t
        inv_r_2 = 1.0/r_2
        w_4 = 1.0 - w*w_3
        inv_w_4 = 1.0/w_4
        F_inv_w_4 = F*inv_w_4
        k2_u_value = F_inv_w_4*math.sin(beta_half) + inv_r_2*v_2*v_2 - inv_r_2*inv_r_2*mu
        k2_v = F_inv_w_4*math.cos(beta_half) - inv_r_2*u_value_2*v_2
        r_3 = half*u_value_2 + r
        u_value_3 = half*k2_u_value + u_value
        v_3 = half*k2_v + v
        inv_r_3 = 1.0/r_3
        k3_u_value = F_inv_w_4*math.sin(beta_half) + inv_r_3*v_3*v_3 - inv_r_3*inv_r_3*mu
        k3_v = F_inv_w_4*math.cos(beta_half) - inv_r_3*u_value_3*v_3
        r_4 = h*u_value_3 + r
        u_value_4 = h*k3_u_value + u_value
        v_4 = h*k3_v + v
        inv_r_4 = 1.0/r_4
        w_5 = 1.0 - t_end*w
        inv_w_5 = 1.0/w_5
        F_inv_w_5 = F*inv_w_5
        k4_u_value = F_inv_w_5*math.sin(beta_end) + inv_r_4*v_4*v_4 - inv_r_4*inv_r_4*mu
        k4_v = F_inv_w_5*math.cos(beta_end) - inv_r_4*u_value_4*v_4
        k23_u_value = k2_u_value + k3_u_value
        k123_u_value = k23_u_value + slope_u_value
        r_end = h*(k123_u_value*sixth + u_value) + r
        u_value_end = sixth*(k123_u_value + k23_u_value + k4_u_value) + u_value
        v_end = sixth*(k4_v + slope_v + 2.0*(k2_v + k3_v)) + v
        inv_r_end = 1.0/r_end
        slope_end_u_value = F_inv_w_5*math.sin(beta_end) + inv_r_end*v_end*v_end - inv_r_end*inv_r_end*mu
        slope_end_v = F_inv_w_5*math.cos(beta_end) - inv_r_end*u_value_end*v_end
        eighth = 0.125*h
        r_mid[i] = eighth*(u_value - u_value_end) + 0.5*(r + r_end)
        u_value_mid[i] = eighth*(slope_u_value - slope_end_u_value) + 0.5*(u_value + u_value_end)
        v_mid[i] = eighth*(slope_v - slope_end_v) + 0.5*(v + v_end)
        total = 6.0*sixth + total
        t = t_end
        r = r_end
        u_value = u_value_end
        v = v_end
        slope_u_value = slope_end_u_value
        slope_v = slope_end_v
    r_at[steps] = r
    u_value_at[steps] = u_value
    v_at[steps] = v
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    mu, F, w = p
    lambda_r_at, lambda_u_at, lambda_v_at = lam
    lambda_r_mid, lambda_u_mid, lambda_v_mid = lam_mid
    r_at, u_value_at, v_at = x
    (beta_at,) = u
    r_mid, u_value_mid, v_mid = x_mid
    (beta_mid,) = u_mid
    lambda_r, lambda_u, lambda_v = lam_f
    twice_mu = 2.0*mu
    steps = len(times) - 1
    t = times[steps]
    lambda_r_at[steps] = lambda_r
    lambda_u_at[steps] = lambda_u
    lambda_v_at[steps] = lambda_v
    r = r_at[steps]
    u_value = u_value_at[steps]
    v = v_at[steps]
    inv_r = 1.0/r
    w_2 = inv_r*inv_r*inv_r*(r*v*v - twice_mu)
    w_3 = inv_r*inv_r*u_value*v
    inv_r_v = inv_r*v
    inv_r_u_value = inv_r*u_value
    twice_inv_r_v = 2.0*inv_r_v
    slope_lambda_r = lambda_u*w_2 - lambda_v*w_3
    slope_lambda_u = inv_r_v*lambda_v - lambda_r
    slope_lambda_v = inv_r_u_value*lambda_v - lambda_u*twice_inv_r_v
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        r_half = r_mid[i]
        r_end = r_at[i]
        u_value_half = u_value_mid[i]
        u_value_end = u_value_at[i]
        v_half = v_mid[i]
        v_end = v_at[i]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_r_2 = half*slope_lambda_r + lambda_r
        lambda_u_2 = half*slope_lambda_u + lambda_u
        lambda_v_2 = half*slope_lambda_v + lambda_v
        inv_r_half = 1.0/r_half
        w_4 = inv_r_half*inv_r_half*inv_r_half*(r_half*v_half*v_half - twice_mu)
        w_5 = inv_r_half*inv_r_half*u_value_half*v_half
        inv_r_half_v_half = inv_r_half*v_half
        inv_r_half_u_value_half = inv_r_half*u_value_half
        twice_inv_r_half_v_half = 2.0*inv_r_half_v_half
        k2_lambda_r = lambda_u_2*w_4 - lambda_v_2*w_5
        k2_lambda_u = inv_r_half_v_half*lambda_v_2 - lambda_r_2
        k2_lambda_v = inv_r_half_u_value_half*lambda_v_2 - lambda_u_2*twice_inv_r_half_v_half
        lambda_r_3 = half*k2_lambda_r + lambda_r
        lambda_u_3 = half*k2_lambda_u + lambda_u
        lambda_v_3 = half*k2_lambda_v + lambda_v
        k3_lambda_r = lambda_u_3*w_4 - lambda_v_3*w_5
        k3_lambda_u = inv_r_half_v_half*lambda_v_3 - lambda_r_3
        k3_lambda_v = inv_r_half_u_value_half*lambda_v_3 - lambda_u_3*twice_inv_r_half_v_half
        lambda_r_4 = h*k3_lambda_r + lambda_r
        lambda_u_4 = h*k3_lambda_u + lambda_u
        lambda_v_4 = h*k3_lambda_v + lambda_v
        inv_r_end = 1.0/r_end
        w_6 = inv_r_end*inv_r_end*inv_r_end*(r_end*v_end*v_end - twice_mu)
        w_7 = inv_r_end*inv_r_end*u_value_end*v_end
        inv_r_end_v_end = inv_r_end*v_end
        inv_r_end_u_value_end = inv_r_end*u_value_end
        twice_inv_r_end_v_end = 2.0*inv_r_end_v_end
        k4_lambda_r = lambda_u_4*w_6 - lambda_v_4*w_7
        k4_lambda_u = inv_r_end_v_end*lambda_v_4 - lambda_r_4
        k4_lambda_v = inv_r_end_u_value_end*lambda_v_4 - lambda_u_4*twice_inv_r_end_v_end
        lambda_r_end = lambda_r + sixth*(k4_lambda_r + slope_lambda_r + 2.0*(k2_lambda_r + k3_lambda_r))
        lambda_u_end = lambda_u + sixth*(k4_lambda_u + slope_lambda_u + 2.0*(k2_lambda_u + k3_lambda_u))
        lambda_v_end = lambda_v + sixth*(k4_lambda_v + slope_lambda_v + 2.0*(k2_lambda_v + k3_lambda_v))
        slope_end_lambda_r = lambda_u_end*w_6 - lambda_v_end*w_7
        slope_end_lambda_u = inv_r_end_v_end*lambda_v_end - lambda_r_end
        slope_end_lambda_v = inv_r_end_u_value_end*lambda_v_end - lambda_u_end*twice_inv_r_end_v_end
        eighth = 0.125*h
        lambda_r_mid[i] = eighth*(slope_lambda_r - slope_end_lambda_r) + 0.5*(lambda_r + lambda_r_end)
        lambda_r_at[i] = lambda_r_end
        lambda_u_mid[i] = eighth*(slope_lambda_u - slope_end_lambda_u) + 0.5*(lambda_u + lambda_u_end)
        lambda_u_at[i] = lambda_u_end
        lambda_v_mid[i] = eighth*(slope_lambda_v - slope_end_lambda_v) + 0.5*(lambda_v + lambda_v_end)
        lambda_v_at[i] = lambda_v_end
        t = t_end
        lambda_r = lambda_r_end
        lambda_u = lambda_u_end
        lambda_v = lambda_v_end
        slope_lambda_r = slope_end_lambda_r
        slope_lambda_u = slope_end_lambda_u
        slope_lambda_v = slope_end_lambda_v


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    r, u_value, v = x
    (beta,) = u
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, *p))
    inv_r = 1.0/r
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    F_inv_w_2 = F*inv_w_2
    out[0] = u_value
    out[1] = F_inv_w_2*np.sin(beta) + inv_r*v*v - inv_r*inv_r*mu
    out[2] = F_inv_w_2*np.cos(beta) - inv_r*u_value*v
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    r, u_value, v = x
    (beta,) = u
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 3, *shape), np.result_type(float, t, x, u, *p))
    inv_r = 1.0/r
    inv_r_v = inv_r*v
    out[0, 0] = 0.0
    out[0, 1] = 1.0
    out[0, 2] = 0.0
    out[1, 0] = inv_r*inv_r*inv_r*(2.0*mu - r*v*v)
    out[1, 1] = 0.0
    out[1, 2] = 2.0*inv_r_v
    out[2, 0] = inv_r*inv_r*u_value*v
    out[2, 1] = -inv_r_v
    out[2, 2] = -inv_r*u_value
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    r, u_value, v = x
    (beta,) = u
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 1, *shape), np.result_type(float, t, x, u, *p))
    w_2 = t*w - 1.0
    w_3 = -w_2
    inv_w_3 = 1.0/w_3
    inv_w_2 = 1.0/w_2
    out[0, 0] = 0.0
    out[1, 0] = F*inv_w_3*np.cos(beta)
    out[2, 0] = F*inv_w_2*np.sin(beta)
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    r, u_value, v = x
    (beta,) = u
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 1.0
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    r, u_value, v = x
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    r, u_value, v = x
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    r, u_value, v = x
    (beta,) = u
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    inv_r = 1.0/r
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    F_inv_w_2 = F*inv_w_2
    out[...] = lambda_r*u_value + lambda_u*(F_inv_w_2*np.sin(beta) + inv_r*v*v - inv_r*inv_r*mu) + lambda_v*(F_inv_w_2*np.cos(beta) - inv_r*u_value*v) + 1.0
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    r, u_value, v = x
    (beta,) = u
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    out[0] = F*inv_w_2*(lambda_u*np.cos(beta) - lambda_v*np.sin(beta))
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    r, u_value, v = x
    (beta,) = u
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    out[0, 0] = F*inv_w_2*(-lambda_u*np.sin(beta) - lambda_v*np.cos(beta))
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    F_inv_w_2 = F*inv_w_2
    out[0] = np.arctan2(-F_inv_w_2*lambda_u, -F_inv_w_2*lambda_v)
    return out


def regularised_cost_batch(t, x, lam, p, bounds, out=None):
    """Integrand of the cost of the regularised problem. Batch form."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, lam, *p, *bounds))
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    w_3 = F*F*inv_w_2*inv_w_2
    w_4 = lambda_u*lambda_u*w_3
    w_5 = lambda_v*lambda_v*w_3
    w_6 = w_4 + w_5
    w_7 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w_6, 1e-300)))
    w_7_sq = w_7*w_7
    out[...] = 0.5*smoothing*(w_4*w_7_sq + w_5*w_7_sq) + 1.0
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    r, u_value, v = x
    (beta,) = u
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_r = 1.0/r
    out[0] = inv_r*inv_r*inv_r*lambda_u*(r*v*v - 2.0*mu) - inv_r*inv_r*lambda_v*u_value*v
    out[1] = inv_r*lambda_v*v - lambda_r
    out[2] = inv_r*lambda_v*u_value - 2.0*inv_r*lambda_u*v
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_r = 1.0/r
    inv_r_sq = inv_r*inv_r
    v_sq = v*v
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    w_3 = F*F*inv_w_2*inv_w_2
    w_4 = lambda_u*lambda_u*w_3 + lambda_v*lambda_v*w_3
    w_5 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w_4, 1e-300)))
    w_3_w_5 = w_3*w_5
    inv_r_v = inv_r*v
    out[0] = u_value
    out[1] = inv_r*v_sq - inv_r_sq*mu - lambda_u*w_3_w_5
    out[2] = -inv_r_v*u_value - lambda_v*w_3_w_5
    out[3] = inv_r*inv_r*inv_r*lambda_u*(r*v_sq - 2.0*mu) - inv_r_sq*lambda_v*u_value*v
    out[4] = inv_r_v*lambda_v - lambda_r
    out[5] = inv_r*lambda_v*u_value - 2.0*inv_r_v*lambda_u
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_r = 1.0/r
    inv_r_cubed = inv_r*inv_r*inv_r
    twice_mu = 2.0*mu
    inv_r_sq = inv_r*inv_r
    v_sq = v*v
    inv_r_v = inv_r*v
    twice_inv_r_v = 2.0*inv_r_v
    lambda_u_sq = lambda_u*lambda_u
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    w_3 = F*F*inv_w_2*inv_w_2
    lambda_v_sq = lambda_v*lambda_v
    w_4 = lambda_u_sq*w_3 + lambda_v_sq*w_3
    w_5 = -0.5*np.heaviside(np.sqrt(w_4) - smoothing*beta_reach, 0.0)*np.minimum(beta_reach, 1e100)/np.maximum(w_4*np.sqrt(w_4), 1e-200)
    w_6 = F*F*F*F*inv_w_2*inv_w_2*inv_w_2*inv_w_2*w_5
    twice_w_6 = 2.0*w_6
    w_7 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w_4, 1e-300)))
    w_3_w_7 = w_3*w_7
    twice_lambda_u = 2.0*lambda_u
    w_8 = -lambda_v*twice_lambda_u*w_6
    inv_r_sq_v = inv_r_sq*v
    inv_r_sq_v_u_value = inv_r_sq_v*u_value
    inv_r_u_value = inv_r*u_value
    lambda_v_u_value = lambda_v*u_value
    w_9 = r*v_sq - twice_mu
    w_10 = -inv_r_sq_v*lambda_v
    w_11 = inv_r_sq_v*twice_lambda_u - inv_r_sq*lambda_v_u_value
    inv_r_lambda_v = inv_r*lambda_v
    out[0, 0] = 0.0
    out[0, 1] = 1.0
    out[0, 2] = 0.0
    out[0, 3] = 0.0
    out[0, 4] = 0.0
    out[0, 5] = 0.0
    out[1, 0] = inv_r_cubed*twice_mu - inv_r_sq*v_sq
    out[1, 1] = 0.0
    out[1, 2] = twice_inv_r_v
    out[1, 3] = 0.0
    out[1, 4] = -lambda_u_sq*twice_w_6 - w_3_w_7
    out[1, 5] = w_8
    out[2, 0] = inv_r_sq_v_u_value
    out[2, 1] = -inv_r_v
    out[2, 2] = -inv_r_u_value
    out[2, 3] = 0.0
    out[2, 4] = w_8
    out[2, 5] = -lambda_v_sq*twice_w_6 - w_3_w_7
    out[3, 0] = inv_r_cubed*lambda_u*v_sq + 2.0*inv_r_cubed*lambda_v_u_value*v - 3.0*inv_r*inv_r*inv_r*inv_r*lambda_u*w_9
    out[3, 1] = w_10
    out[3, 2] = w_11
    out[3, 3] = 0.0
    out[3, 4] = inv_r_cubed*w_9
    out[3, 5] = -inv_r_sq_v_u_value
    out[4, 0] = w_10
    out[4, 1] = 0.0
    out[4, 2] = inv_r_lambda_v
    out[4, 3] = -1.0
    out[4, 4] = 0.0
    out[4, 5] = inv_r_v
    out[5, 0] = w_11
    out[5, 1] = inv_r_lambda_v
    out[5, 2] = -inv_r*twice_lambda_u
    out[5, 3] = 0.0
    out[5, 4] = -twice_inv_r_v
    out[5, 5] = inv_r_u_value
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    lambda_u_sq = lambda_u*lambda_u
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    F_sq = F*F
    w_3 = F_sq*inv_w_2*inv_w_2
    lambda_v_sq = lambda_v*lambda_v
    w_4 = lambda_u_sq*w_3 + lambda_v_sq*w_3
    w_5 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w_4, 1e-300)))
    w_6 = 2.0*F_sq*inv_w_2*inv_w_2*inv_w_2*w
    w_5_w_6 = w_5*w_6
    w_7 = -0.5*np.heaviside(np.sqrt(w_4) - smoothing*beta_reach, 0.0)*np.minimum(beta_reach, 1e100)/np.maximum(w_4*np.sqrt(w_4), 1e-200)
    w_8 = w_3*w_7*(lambda_u_sq*w_6 + lambda_v_sq*w_6)
    out[0] = 0.0
    out[1] = -lambda_u*w_5_w_6 - lambda_u*w_8
    out[2] = -lambda_v*w_5_w_6 - lambda_v*w_8
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    given_r, given_u, given_v, on_reference_r, on_reference_u, on_reference_v, target_r, target_u, target_v = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    inv_r = 1.0/r
    w_2 = 1.0 - t*w
    inv_w_2 = 1.0/w_2
    w_3 = F*F*inv_w_2*inv_w_2
    w_4 = lambda_u*lambda_u*w_3
    w_5 = lambda_v*lambda_v*w_3
    w_6 = w_4 + w_5
    w_7 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w_6, 1e-300)))
    w_7_sq = w_7*w_7
    out[0] = given_r*(r - target_r) + lambda_r*(1.0 - given_r - on_reference_r) + on_reference_r*r
    out[1] = given_u*(u_value - target_u) + lambda_u*(1.0 - given_u - on_reference_u) + on_reference_u*u_value
    out[2] = given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v
    out[3] = lambda_r*u_value + lambda_u*(inv_r*v*v - inv_r*inv_r*mu) + 0.5*smoothing*(w_4*w_7_sq + w_5*w_7_sq) + 1.0 - inv_r*lambda_v*u_value*v - w_4*w_7 - w_5*w_7
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    r, u_value, v = x
    lambda_r, lambda_u, lambda_v = lam
    mu, F, w = p
    beta_reach, smoothing = bounds
    given_r, given_u, given_v, on_reference_r, on_reference_u, on_reference_v, target_r, target_u, target_v = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 7, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w_2 = given_r + on_reference_r
    w_3 = given_u + on_reference_u
    w_4 = given_v + on_reference_v
    inv_r = 1.0/r
    u_value_v = u_value*v
    v_sq = v*v
    inv_r_sq = inv_r*inv_r
    inv_r_lambda_v = inv_r*lambda_v
    twice_lambda_u = 2.0*lambda_u
    lambda_u_sq = lambda_u*lambda_u
    w_5 = 1.0 - t*w
    inv_w_5 = 1.0/w_5
    F_sq = F*F
    w_6 = F_sq*inv_w_5*inv_w_5
    lambda_u_sq_w_6 = lambda_u_sq*w_6
    lambda_v_sq = lambda_v*lambda_v
    lambda_v_sq_w_6 = lambda_v_sq*w_6
    w_7 = lambda_u_sq_w_6 + lambda_v_sq_w_6
    w_8 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w_7, 1e-300)))
    twice_lambda_u_w_6 = twice_lambda_u*w_6
    lambda_u_cubed = lambda_u*lambda_u*lambda_u
    w_9 = -0.5*np.heaviside(np.sqrt(w_7) - smoothing*beta_reach, 0.0)*np.minimum(beta_reach, 1e100)/np.maximum(w_7*np.sqrt(w_7), 1e-200)
    twice_w_9 = 2.0*w_9
    w_10 = F*F*F*F*inv_w_5*inv_w_5*inv_w_5*inv_w_5
    twice_w_9_w_10 = twice_w_9*w_10
    w_10_w_9 = w_10*w_9
    w_8_sq = w_8*w_8
    w_11 = 4.0*w_10_w_9*w_8
    lambda_v_w_6 = lambda_v*w_6
    twice_w_8 = 2.0*w_8
    lambda_v_cubed = lambda_v*lambda_v*lambda_v
    lambda_u_sq_lambda_v = lambda_u_sq*lambda_v
    twice_w_8_sq = 2.0*w_8_sq
    w_12 = F_sq*inv_w_5*inv_w_5*inv_w_5*w
    twice_w_8_w_12 = twice_w_8*w_12
    twice_w_12 = 2.0*w_12
    w_13 = lambda_u_sq*twice_w_12 + lambda_v_sq*twice_w_12
    w_13_w_9 = w_13*w_9
    twice_w_8_sq_w_12 = twice_w_8_sq*w_12
    twice_w_9_w_13_w_8 = twice_w_9*w_13*w_8
    out[0, 0] = w_2
    out[0, 3] = 1.0 - w_2
    out[1, 1] = w_3
    out[1, 4] = 1.0 - w_3
    out[2, 2] = w_4
    out[2, 5] = 1.0 - w_4
    out[3, 0] = inv_r_sq*lambda_v*u_value_v + lambda_u*(2.0*inv_r*inv_r*inv_r*mu - inv_r_sq*v_sq)
    out[3, 1] = lambda_r - inv_r_lambda_v*v
    out[3, 2] = inv_r*twice_lambda_u*v - inv_r_lambda_v*u_value
    out[3, 3] = u_value
    out[3, 4] = inv_r*v_sq + 0.5*smoothing*(lambda_u*lambda_v_sq*w_11 + lambda_u_cubed*w_11 + twice_lambda_u_w_6*w_8_sq) - inv_r_sq*mu - lambda_u_cubed*twice_w_9_w_10 - lambda_v_sq*twice_lambda_u*w_10_w_9 - twice_lambda_u_w_6*w_8
    out[3, 5] = 0.5*smoothing*(lambda_u_sq_lambda_v*w_11 + lambda_v_cubed*w_11 + lambda_v_w_6*twice_w_8_sq) - inv_r*u_value_v - lambda_u_sq_lambda_v*twice_w_9_w_10 - lambda_v_cubed*twice_w_9_w_10 - lambda_v_w_6*twice_w_8
    out[3, 6] = 0.5*smoothing*(lambda_u_sq*twice_w_8_sq_w_12 + lambda_u_sq_w_6*twice_w_9_w_13_w_8 + lambda_v_sq*twice_w_8_sq_w_12 + lambda_v_sq_w_6*twice_w_9_w_13_w_8) - lambda_u_sq*twice_w_8_w_12 - lambda_u_sq_w_6*w_13_w_9 - lambda_v_sq*twice_w_8_w_12 - lambda_v_sq_w_6*w_13_w_9
    return out
