"""Goddard rocket: ascent to maximum altitude under a dynamic-pressure limit.

Written by satsym from derivations/examples/goddard_pressure.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/goddard_pressure.py
Source: ../derivations/examples/goddard_pressure.py cff3d8450d21b61e30780253131d7f9d
Digest: d44ba383f104a76493e210a7fadf2ba6c1baa53637048c95e0388bcdbacfd13b
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'goddard_pressure',
    'title': 'Goddard rocket: ascent to maximum altitude under a dynamic-pressure limit',
    'source': 'derivations/examples/goddard_pressure.py',
    'states': (
        {'symbol': 'h', 'latex': 'h', 'meaning': 'distance from the centre of force', 'positive': True, 'typical': (1.0, 1.02)},
        {'symbol': 'v', 'latex': 'v', 'meaning': 'velocity', 'typical': (0.01, 0.15)},
        {'symbol': 'm', 'latex': 'm', 'meaning': 'mass', 'positive': True, 'typical': (0.6, 1.0)},
    ),
    'controls': (
        {'symbol': 'T', 'latex': 'T', 'meaning': 'thrust', 'typical': (0.0, 3.5)},
    ),
    'parameters': (
        {'symbol': 'rho0', 'latex': '\\rho_0', 'meaning': 'density of the air at the initial height', 'default': 12400.0, 'positive': True},
        {'symbol': 'area', 'latex': 'A_{\\mathrm{ref}}', 'meaning': 'drag reference area', 'default': 0.05, 'positive': True},
        {'symbol': 'beta', 'latex': '\\beta', 'meaning': 'rate of decrease of the density with height', 'default': 500.0, 'positive': True},
        {'symbol': 'g0', 'latex': 'g_0', 'meaning': 'acceleration of gravity at the initial height', 'default': 1.0, 'positive': True},
        {'symbol': 'c', 'latex': 'c', 'meaning': 'exhaust velocity', 'default': 0.5, 'positive': True},
        {'symbol': 'q_max', 'latex': 'q_{\\max}', 'meaning': 'maximum dynamic pressure', 'default': 10.0, 'positive': True},
    ),
    'control_set': 'box',
    'has_cost': True,
    'has_terminal_cost': True,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'switching': True,
    'maximise': True,
    'objective_unit': '1',
    'path_constraints': (
        {'name': 'pressure', 'order': 1},
        {'name': 'T_min', 'order': 0},
        {'name': 'T_max', 'order': 0},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    inv_m = 1.0/m
    inv_h = 1.0/h
    inv_c = 1.0/c
    return (
        v,
        inv_m*(T - 0.5*area*rho0*v*v*math.exp(-beta*(h - 1.0))) - g0*inv_h*inv_h,
        -T*inv_c,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    inv_h = 1.0/h
    inv_m = 1.0/m
    v_sq = v*v
    w = math.exp(-beta*(h - 1.0))
    area_rho0_w = area*rho0*w
    return (
        0.0,
        1.0,
        0.0,
        0.5*area_rho0_w*beta*inv_m*v_sq + 2.0*g0*inv_h*inv_h*inv_h,
        -area_rho0_w*inv_m*v,
        0.5*inv_m*inv_m*(area*rho0*v_sq*w - 2.0*T),
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    inv_m = 1.0/m
    inv_c = 1.0/c
    return (
        0.0,
        inv_m,
        -inv_c,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    return 0.0


def terminal_cost(t, x, p):
    """Terminal cost S."""
    h, v, m = x
    rho0, area, beta, g0, c, q_max = p
    return -h


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    h, v, m = x
    rho0, area, beta, g0, c, q_max = p
    return (
        -1.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    inv_m = 1.0/m
    inv_h = 1.0/h
    inv_c = 1.0/c
    return lambda_h*v + lambda_v*(inv_m*(T - 0.5*area*rho0*v*v*math.exp(-beta*(h - 1.0))) - g0*inv_h*inv_h) - T*inv_c*lambda_m


def switching_function(t, x, lam, p):
    """What multiplies each control in H."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    inv_m = 1.0/m
    inv_c = 1.0/c
    return (
        inv_m*lambda_v - inv_c*lambda_m,
    )


def switching_rate(t, x, u, lam, p):
    """Its rates of change along an extremal."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    inv_m = 1.0/m
    inv_c = 1.0/c
    return (
        0.5*area*inv_c*inv_m*inv_m*lambda_v*rho0*v*(2.0*c + v)*math.exp(-beta*(h - 1.0)) - inv_m*lambda_h,
    )


def magnitude_weight(t, x, lam, p):
    """What multiplies each |u| in H."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    return (
        0.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the box."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    inv_m = 1.0/m
    inv_c = 1.0/c
    w = inv_m*lambda_v - inv_c*lambda_m
    T = T_min if w > 0.0 else T_max if w < 0.0 else 0.5*(T_min + T_max)
    return (
        T,
    )


def extremal_jacobian(t, x, u, lam, p):
    """Rates of states and costates by states and costates, row by row, the controls being held."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    inv_h = 1.0/h
    inv_m = 1.0/m
    w = area*rho0*math.exp(-beta*(h - 1.0))
    w_2 = v*v*w
    half_w_2 = 0.5*w_2
    half_w_2_inv_m = half_w_2*inv_m
    w_3 = beta*half_w_2_inv_m + 2.0*g0*inv_h*inv_h*inv_h
    inv_m_w = inv_m*w
    inv_m_w_v = inv_m_w*v
    inv_m_sq = inv_m*inv_m
    beta_lambda_v = beta*lambda_v
    w_4 = -beta_lambda_v*inv_m_w_v
    half_inv_m_sq = 0.5*inv_m_sq
    w_5 = beta_lambda_v*half_inv_m_sq*w_2
    w_6 = -inv_m_sq*lambda_v*v*w
    w_7 = 2.0*T - w_2
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        -inv_m_w_v,
        -inv_m_sq*(T - half_w_2),
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        lambda_v*(beta*beta*half_w_2_inv_m + 6.0*g0*inv_h*inv_h*inv_h*inv_h),
        w_4,
        w_5,
        0.0,
        -w_3,
        0.0,
        w_4,
        inv_m_w*lambda_v,
        w_6,
        -1.0,
        inv_m_w_v,
        0.0,
        w_5,
        w_6,
        -inv_m*inv_m*inv_m*lambda_v*w_7,
        0.0,
        half_inv_m_sq*w_7,
        0.0,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    inv_h = 1.0/h
    inv_m = 1.0/m
    w = area*rho0*math.exp(-beta*(h - 1.0))
    w_2 = v*v*w
    return (
        lambda_v*(-0.5*beta*inv_m*w_2 - 2.0*g0*inv_h*inv_h*inv_h),
        inv_m*lambda_v*v*w - lambda_h,
        0.5*inv_m*inv_m*lambda_v*(2.0*T - w_2),
    )


def path_constraints(t, x, u, p, bounds):
    """What may not be positive along the way."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    return (
        0.5*rho0*v*v*math.exp(-beta*(h - 1.0)) - q_max,
        T_min - T,
        T - T_max,
    )


def path_gradient(t, x, u, p):
    """Its derivatives by the states, row by row."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    w = rho0*math.exp(-beta*(h - 1.0))
    return (
        -0.5*beta*v*v*w,
        v*w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def path_effect(t, x, u, p):
    """Its derivatives by the controls, row by row."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    return (
        0.0,
        -1.0,
        1.0,
    )


def path_rates(t, x, u, p):
    """Its first and second rates of change; 0 for those after the control."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    inv_m = 1.0/m
    inv_h = 1.0/h
    w = beta*(h - 1.0)
    w_2 = math.exp(-w)
    rho0_w_2 = rho0*w_2
    w_3 = 0.5*v*v*v
    return (
        T*inv_m*rho0*v*w_2 - area*inv_m*rho0*rho0*w_3*math.exp(-2.0*w) - beta*rho0_w_2*w_3 - g0*inv_h*inv_h*rho0_w_2*v,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def path_vanishing(t, x, u, lam, p, bounds):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    inv_m = 1.0/m
    inv_c = 1.0/c
    return (
        inv_m*lambda_v - inv_c*lambda_m,
        0.0,
        T_min - T,
        0.0,
        T - T_max,
        0.0,
    )


def path_multiplier(t, x, u, lam, p, bounds):
    """The multiplier of each while it is on its boundary."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    inv_v = 1.0/v
    inv_rho0 = 1.0/rho0
    inv_c = 1.0/c
    inv_m = 1.0/m
    area_inv_m_lambda_v = area*inv_m*lambda_v
    return (
        0.5*area_inv_m_lambda_v*inv_c*v + area_inv_m_lambda_v - inv_rho0*inv_v*lambda_h*math.exp(beta*(h - 1.0)),
        0.0,
        0.0,
    )


def boundary_control(t, x, lam, p, bounds):
    """The controls on the boundary of each, row by row."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    inv_h = 1.0/h
    w = 0.5*v*v
    return (
        area*rho0*w*math.exp(-beta*(h - 1.0)) + beta*m*w + g0*inv_h*inv_h*m,
        T_min,
        T_max,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    inv_m = 1.0/m
    inv_h = 1.0/h
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_m_lambda_v = inv_m*lambda_v
    w = -inv_smoothing*(inv_m_lambda_v - inv_c*lambda_m)
    w_2 = T_min if w < T_min else T_max if w > T_max else w
    w_3 = area*rho0*math.exp(-beta*(h - 1.0))
    w_4 = 0.5*v*v*w_3
    w_5 = w_2 - w_4
    return (
        v,
        inv_m*w_5 - g0*inv_h*inv_h,
        -inv_c*w_2,
        -lambda_v*(beta*inv_m*w_4 + 2.0*g0*inv_h*inv_h*inv_h),
        inv_m_lambda_v*v*w_3 - lambda_h,
        inv_m*inv_m*lambda_v*w_5,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    inv_h = 1.0/h
    inv_m = 1.0/m
    w = area*rho0*math.exp(-beta*(h - 1.0))
    w_2 = 0.5*v*v*w
    inv_m_w_2 = inv_m*w_2
    w_3 = beta*inv_m_w_2 + 2.0*g0*inv_h*inv_h*inv_h
    v_w = v*w
    inv_m_v_w = inv_m*v_w
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_m_lambda_v = inv_m*lambda_v
    w_4 = -inv_smoothing*(inv_m_lambda_v - inv_c*lambda_m)
    w_5 = T_min if w_4 < T_min else T_max if w_4 > T_max else w_4
    w_6 = w_5 - w_2
    w_7 = 0.0 if w_4 < T_min else 0.0 if w_4 > T_max else 1.0
    inv_smoothing_w_7 = inv_smoothing*w_7
    w_8 = inv_m*inv_m*inv_m*lambda_v
    inv_m_sq = inv_m*inv_m
    w_9 = inv_smoothing_w_7*w_8 - inv_m_sq*w_6
    w_10 = inv_m_sq*inv_smoothing_w_7
    w_11 = inv_c*inv_m*inv_smoothing_w_7
    inv_c_lambda_v_w_10 = inv_c*lambda_v*w_10
    w_12 = -beta*inv_m_lambda_v*v_w
    inv_m_sq_lambda_v = inv_m_sq*lambda_v
    w_13 = beta*inv_m_sq_lambda_v*w_2
    w_14 = -inv_m_sq_lambda_v*v_w
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        -inv_m_v_w,
        w_9,
        0.0,
        -w_10,
        w_11,
        0.0,
        0.0,
        -inv_c_lambda_v_w_10,
        0.0,
        w_11,
        -inv_c*inv_c*inv_smoothing_w_7,
        -lambda_v*(-beta*beta*inv_m_w_2 - 6.0*g0*inv_h*inv_h*inv_h*inv_h),
        w_12,
        w_13,
        0.0,
        -w_3,
        0.0,
        w_12,
        inv_m_lambda_v*w,
        w_14,
        -1.0,
        inv_m_v_w,
        0.0,
        w_13,
        w_14,
        inv_m*inv_m*inv_m*inv_m*inv_smoothing_w_7*lambda_v*lambda_v - 2.0*w_6*w_8,
        0.0,
        -w_9,
        inv_c_lambda_v_w_10,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    given_h, given_v, given_m, on_reference_h, on_reference_v, on_reference_m, target_h, target_v, target_m = final
    inv_m = 1.0/m
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_lambda_m = inv_c*lambda_m
    w = -inv_smoothing*(inv_m*lambda_v - inv_c_lambda_m)
    w_2 = T_min if w < T_min else T_max if w > T_max else w
    inv_h = 1.0/h
    return (
        given_h*(h - target_h) + h*on_reference_h - (-lambda_h - 1.0)*(1.0 - given_h - on_reference_h),
        given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v,
        given_m*(m - target_m) + lambda_m*(1.0 - given_m - on_reference_m) + m*on_reference_m,
        lambda_h*v + lambda_v*(inv_m*(w_2 - 0.5*area*rho0*v*v*math.exp(-beta*(h - 1.0))) - g0*inv_h*inv_h) + 0.5*smoothing*w_2*w_2 - inv_c_lambda_m*w_2,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    given_h, given_v, given_m, on_reference_h, on_reference_v, on_reference_m, target_h, target_v, target_m = final
    w = given_h + on_reference_h
    w_2 = given_v + on_reference_v
    w_3 = given_m + on_reference_m
    inv_h = 1.0/h
    inv_m = 1.0/m
    w_4 = area*rho0*math.exp(-beta*(h - 1.0))
    w_5 = 0.5*v*v*w_4
    inv_m_lambda_v = inv_m*lambda_v
    inv_c = 1.0/c
    inv_c_lambda_m = inv_c*lambda_m
    inv_smoothing = 1.0/smoothing
    w_6 = -inv_smoothing*(inv_m_lambda_v - inv_c_lambda_m)
    w_7 = 0.0 if w_6 < T_min else 0.0 if w_6 > T_max else 1.0
    inv_smoothing_w_7 = inv_smoothing*w_7
    w_8 = inv_smoothing_w_7*lambda_v
    inv_m_sq = inv_m*inv_m
    inv_m_sq_w_8 = inv_m_sq*w_8
    w_9 = T_min if w_6 < T_min else T_max if w_6 > T_max else w_6
    w_10 = w_9 - w_5
    w_7_w_9 = w_7*w_9
    inv_c_w_9 = inv_c*w_9
    return (
        w,
        0.0,
        0.0,
        1.0 - w,
        0.0,
        0.0,
        0.0,
        0.0,
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
        lambda_v*(beta*inv_m*w_5 + 2.0*g0*inv_h*inv_h*inv_h),
        lambda_h - inv_m_lambda_v*v*w_4,
        inv_m_sq*lambda_v*w_7_w_9 + lambda_v*(inv_m*inv_m*inv_m*w_8 - inv_m_sq*w_10) - inv_c_lambda_m*inv_m_sq_w_8,
        v,
        inv_c*inv_m*inv_smoothing*lambda_m*w_7 + inv_m*w_10 - g0*inv_h*inv_h - inv_m*w_7_w_9 - inv_m_sq_w_8,
        inv_c*inv_m_lambda_v*inv_smoothing_w_7 + inv_c_w_9*w_7 - inv_c*inv_c*inv_smoothing_w_7*lambda_m - inv_c_w_9,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    rho0, area, beta, g0, c, q_max = p
    h_at, v_at, m_at = x
    h_mid, v_mid, m_mid = x_mid
    (T_at,) = u
    (T_mid,) = u_mid
    h, v, m = x0
    w = 0.5*area*rho0
    inv_c = 1.0/c
    steps = len(times) - 1
    t = times[0]
    h_at[0] = h
    v_at[0] = v
    m_at[0] = m
    T = T_at[0]
    inv_m = 1.0/m
    inv_h = 1.0/h
    slope_v = inv_m*(T - v*v*w*math.exp(-beta*(h - 1.0))) - g0*inv_h*inv_h
    slope_m = -T*inv_c
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h_2 = t_end - t
        h_at[i] = h
        v_at[i] = v
        m_at[i] = m
        T_half = T_mid[i]
        T_end = T_at[i + 1]
        half = 0.5*h_2
        sixth = (1.0/6.0)*h_2
        h_2_2 = h + half*v
        v_2 = half*slope_v + v
        m_2 = half*slope_m + m
        inv_m_2 = 1.0/m_2
        inv_h_2_2 = 1.0/h_2_2
        k2_v = inv_m_2*(T_half - v_2*v_2*w*math.exp(-beta*(h_2_2 - 1.0))) - g0*inv_h_2_2*inv_h_2_2
        k2_m = -T_half*inv_c
        h_3 = h + half*v_2
        v_3 = half*k2_v + v
        m_3 = half*k2_m + m
        inv_m_3 = 1.0/m_3
        inv_h_3 = 1.0/h_3
        k3_v = inv_m_3*(T_half - v_3*v_3*w*math.exp(-beta*(h_3 - 1.0))) - g0*inv_h_3*inv_h_3
        h_4 = h + h_2*v_3
        v_4 = h_2*k3_v + v
        m_4 = h_2*k2_m + m
        inv_m_4 = 1.0/m_4
        inv_h_4 = 1.0/h_4
        k4_v = inv_m_4*(T_end - v_4*v_4*w*math.exp(-beta*(h_4 - 1.0))) - g0*inv_h_4*inv_h_4
        k4_m = -T_end*inv_c
        k23_v = k2_v + k3_v
        k123_v = k23_v + slope_v
        h_end = h + h_2*(k123_v*sixth + v)
        v_end = sixth*(k123_v + k23_v + k4_v) + v
        m_end = m + sixth*(4.0*k2_m + k4_m + slope_m)
        inv_m_end = 1.0/m_end
        inv_h_end = 1.0/h_end
        slope_end_v = inv_m_end*(T_end - v_end*v_end*w*math.exp(-beta*(h_end - 1.0))) - g0*inv_h_end*inv_h_end
        eighth = 0.125*h_2
        h_mid[i] = eighth*(v - v_end) + 0.5*(h + h_end)
        v_mid[i] = eighth*(slope_v - slope_end_v) + 0.5*(v + v_end)
        m_mid[i] = eighth*(slope_m - k4_m) + 0.5*(m + m_end)
        total = total
        t = t_end
        h = h_end
        v = v_end
        m = m_end
        slope_v = slope_end_v
        slope_m = k4_m
    h_at[steps] = h
    v_at[steps] = v
    m_at[steps] = m
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    rho0, area, beta, g0, c, q_max = p
    lambda_h_at, lambda_v_at, lambda_m_at = lam
    lambda_h_mid, lambda_v_mid, lambda_m_mid = lam_mid
    h_at, v_at, m_at = x
    (T_at,) = u
    h_mid, v_mid, m_mid = x_mid
    (T_mid,) = u_mid
    lambda_h, lambda_v, lambda_m = lam_f
    twice_g0 = 2.0*g0
    area_rho0 = area*rho0
    w = 0.5*area_rho0*beta
    steps = len(times) - 1
    t = times[steps]
    lambda_h_at[steps] = lambda_h
    lambda_v_at[steps] = lambda_v
    lambda_m_at[steps] = lambda_m
    h = h_at[steps]
    v = v_at[steps]
    m = m_at[steps]
    T = T_at[steps]
    inv_h = 1.0/h
    inv_m = 1.0/m
    w_2 = math.exp(-beta*(h - 1.0))
    w_3 = v*v*w_2
    w_4 = inv_h*inv_h*inv_h*twice_g0 + inv_m*w*w_3
    area_rho0_inv_m_v_w_2 = area_rho0*inv_m*v*w_2
    w_5 = 0.5*inv_m*inv_m*(2.0*T - area_rho0*w_3)
    slope_lambda_h = -lambda_v*w_4
    slope_lambda_v = area_rho0_inv_m_v_w_2*lambda_v - lambda_h
    slope_lambda_m = lambda_v*w_5
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h_2 = t_end - t
        h_half = h_mid[i]
        h_end = h_at[i]
        v_half = v_mid[i]
        v_end = v_at[i]
        m_half = m_mid[i]
        m_end = m_at[i]
        T_half = T_mid[i]
        T_end = T_at[i]
        half = 0.5*h_2
        sixth = (1.0/6.0)*h_2
        lambda_h_2 = half*slope_lambda_h + lambda_h
        lambda_v_2 = half*slope_lambda_v + lambda_v
        inv_h_half = 1.0/h_half
        inv_m_half = 1.0/m_half
        w_6 = math.exp(-beta*(h_half - 1.0))
        w_7 = v_half*v_half*w_6
        w_8 = inv_h_half*inv_h_half*inv_h_half*twice_g0 + inv_m_half*w*w_7
        w_9 = area_rho0*inv_m_half*v_half*w_6
        w_10 = 0.5*inv_m_half*inv_m_half*(2.0*T_half - area_rho0*w_7)
        k2_lambda_h = -lambda_v_2*w_8
        k2_lambda_v = lambda_v_2*w_9 - lambda_h_2
        k2_lambda_m = lambda_v_2*w_10
        lambda_h_3 = half*k2_lambda_h + lambda_h
        lambda_v_3 = half*k2_lambda_v + lambda_v
        k3_lambda_h = -lambda_v_3*w_8
        k3_lambda_v = lambda_v_3*w_9 - lambda_h_3
        k3_lambda_m = lambda_v_3*w_10
        lambda_h_4 = h_2*k3_lambda_h + lambda_h
        lambda_v_4 = h_2*k3_lambda_v + lambda_v
        inv_h_end = 1.0/h_end
        inv_m_end = 1.0/m_end
        w_11 = math.exp(-beta*(h_end - 1.0))
        w_12 = v_end*v_end*w_11
        w_13 = inv_h_end*inv_h_end*inv_h_end*twice_g0 + inv_m_end*w*w_12
        w_14 = area_rho0*inv_m_end*v_end*w_11
        w_15 = 0.5*inv_m_end*inv_m_end*(2.0*T_end - area_rho0*w_12)
        k4_lambda_h = -lambda_v_4*w_13
        k4_lambda_v = lambda_v_4*w_14 - lambda_h_4
        k4_lambda_m = lambda_v_4*w_15
        lambda_h_end = lambda_h + sixth*(k4_lambda_h + slope_lambda_h + 2.0*(k2_lambda_h + k3_lambda_h))
        lambda_v_end = lambda_v + sixth*(k4_lambda_v + slope_lambda_v + 2.0*(k2_lambda_v + k3_lambda_v))
        lambda_m_end = lambda_m + sixth*(k4_lambda_m + slope_lambda_m + 2.0*(k2_lambda_m + k3_lambda_m))
        slope_end_lambda_h = -lambda_v_end*w_13
        slope_end_lambda_v = lambda_v_end*w_14 - lambda_h_end
        slope_end_lambda_m = lambda_v_end*w_15
        eighth = 0.125*h_2
        lambda_h_mid[i] = eighth*(slope_lambda_h - slope_end_lambda_h) + 0.5*(lambda_h + lambda_h_end)
        lambda_h_at[i] = lambda_h_end
        lambda_v_mid[i] = eighth*(slope_lambda_v - slope_end_lambda_v) + 0.5*(lambda_v + lambda_v_end)
        lambda_v_at[i] = lambda_v_end
        lambda_m_mid[i] = eighth*(slope_lambda_m - slope_end_lambda_m) + 0.5*(lambda_m + lambda_m_end)
        lambda_m_at[i] = lambda_m_end
        t = t_end
        lambda_h = lambda_h_end
        lambda_v = lambda_v_end
        lambda_m = lambda_m_end
        slope_lambda_h = slope_end_lambda_h
        slope_lambda_v = slope_end_lambda_v
        slope_lambda_m = slope_end_lambda_m


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, *p))
    inv_m = 1.0/m
    inv_h = 1.0/h
    inv_c = 1.0/c
    out[0] = v
    out[1] = inv_m*(T - 0.5*area*rho0*v*v*np.exp(-beta*(h - 1.0))) - g0*inv_h*inv_h
    out[2] = -T*inv_c
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 3, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_h = 1.0/h
    inv_m = 1.0/m
    v_sq = v*v
    w = np.exp(-beta*(h - 1.0))
    area_rho0_w = area*rho0*w
    out[0, 1] = 1.0
    out[1, 0] = 0.5*area_rho0_w*beta*inv_m*v_sq + 2.0*g0*inv_h*inv_h*inv_h
    out[1, 1] = -area_rho0_w*inv_m*v
    out[1, 2] = 0.5*inv_m*inv_m*(area*rho0*v_sq*w - 2.0*T)
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 1, *shape), np.result_type(float, t, x, u, *p))
    inv_m = 1.0/m
    inv_c = 1.0/c
    out[0, 0] = 0.0
    out[1, 0] = inv_m
    out[2, 0] = -inv_c
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    h, v, m = x
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = -h
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    h, v, m = x
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, *p))
    out[0] = -1.0
    out[1] = 0.0
    out[2] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    inv_m = 1.0/m
    inv_h = 1.0/h
    inv_c = 1.0/c
    out[...] = lambda_h*v + lambda_v*(inv_m*(T - 0.5*area*rho0*v*v*np.exp(-beta*(h - 1.0))) - g0*inv_h*inv_h) - T*inv_c*lambda_m
    return out


def switching_function_batch(t, x, lam, p, out=None):
    """What multiplies each control in H. Batch form."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p))
    inv_m = 1.0/m
    inv_c = 1.0/c
    out[0] = inv_m*lambda_v - inv_c*lambda_m
    return out


def switching_rate_batch(t, x, u, lam, p, out=None):
    """Its rates of change along an extremal. Batch form."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_m = 1.0/m
    inv_c = 1.0/c
    out[0] = 0.5*area*inv_c*inv_m*inv_m*lambda_v*rho0*v*(2.0*c + v)*np.exp(-beta*(h - 1.0)) - inv_m*lambda_h
    return out


def magnitude_weight_batch(t, x, lam, p, out=None):
    """What multiplies each |u| in H. Batch form."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p))
    out[0] = 0.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the box. Batch form."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_m = 1.0/m
    inv_c = 1.0/c
    w = inv_m*lambda_v - inv_c*lambda_m
    T = np.heaviside(w - 0.0, 0.0)*T_min + np.heaviside(-w - 0.0, 0.0)*T_max + (1.0 - np.heaviside(w - 0.0, 0.0) - np.heaviside(-w - 0.0, 0.0))*0.5*(T_min + T_max)
    out[0] = T
    return out


def extremal_jacobian_batch(t, x, u, lam, p, out=None):
    """Rates of states and costates by states and costates, row by row, the controls being held. Batch form."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, u, lam, *p))
    out[...] = 0.0
    inv_h = 1.0/h
    inv_m = 1.0/m
    w = area*rho0*np.exp(-beta*(h - 1.0))
    w_2 = v*v*w
    half_w_2 = 0.5*w_2
    half_w_2_inv_m = half_w_2*inv_m
    w_3 = beta*half_w_2_inv_m + 2.0*g0*inv_h*inv_h*inv_h
    inv_m_w = inv_m*w
    inv_m_w_v = inv_m_w*v
    inv_m_sq = inv_m*inv_m
    beta_lambda_v = beta*lambda_v
    w_4 = -beta_lambda_v*inv_m_w_v
    half_inv_m_sq = 0.5*inv_m_sq
    w_5 = beta_lambda_v*half_inv_m_sq*w_2
    w_6 = -inv_m_sq*lambda_v*v*w
    w_7 = 2.0*T - w_2
    out[0, 1] = 1.0
    out[1, 0] = w_3
    out[1, 1] = -inv_m_w_v
    out[1, 2] = -inv_m_sq*(T - half_w_2)
    out[3, 0] = lambda_v*(beta*beta*half_w_2_inv_m + 6.0*g0*inv_h*inv_h*inv_h*inv_h)
    out[3, 1] = w_4
    out[3, 2] = w_5
    out[3, 4] = -w_3
    out[4, 0] = w_4
    out[4, 1] = inv_m_w*lambda_v
    out[4, 2] = w_6
    out[4, 3] = -1.0
    out[4, 4] = inv_m_w_v
    out[5, 0] = w_5
    out[5, 1] = w_6
    out[5, 2] = -inv_m*inv_m*inv_m*lambda_v*w_7
    out[5, 4] = half_inv_m_sq*w_7
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_h = 1.0/h
    inv_m = 1.0/m
    w = area*rho0*np.exp(-beta*(h - 1.0))
    w_2 = v*v*w
    out[0] = lambda_v*(-0.5*beta*inv_m*w_2 - 2.0*g0*inv_h*inv_h*inv_h)
    out[1] = inv_m*lambda_v*v*w - lambda_h
    out[2] = 0.5*inv_m*inv_m*lambda_v*(2.0*T - w_2)
    return out


def path_constraints_batch(t, x, u, p, bounds, out=None):
    """What may not be positive along the way. Batch form."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, *p, *bounds))
    out[0] = 0.5*rho0*v*v*np.exp(-beta*(h - 1.0)) - q_max
    out[1] = T_min - T
    out[2] = T - T_max
    return out


def path_gradient_batch(t, x, u, p, out=None):
    """Its derivatives by the states, row by row. Batch form."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 3, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    w = rho0*np.exp(-beta*(h - 1.0))
    out[0, 0] = -0.5*beta*v*v*w
    out[0, 1] = v*w
    return out


def path_effect_batch(t, x, u, p, out=None):
    """Its derivatives by the controls, row by row. Batch form."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 0.0
    out[1, 0] = -1.0
    out[2, 0] = 1.0
    return out


def path_rates_batch(t, x, u, p, out=None):
    """Its first and second rates of change; 0 for those after the control. Batch form."""
    h, v, m = x
    (T,) = u
    rho0, area, beta, g0, c, q_max = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_m = 1.0/m
    inv_h = 1.0/h
    w = beta*(h - 1.0)
    w_2 = np.exp(-w)
    rho0_w_2 = rho0*w_2
    w_3 = 0.5*v*v*v
    out[0, 0] = T*inv_m*rho0*v*w_2 - area*inv_m*rho0*rho0*w_3*np.exp(-2.0*w) - beta*rho0_w_2*w_3 - g0*inv_h*inv_h*rho0_w_2*v
    return out


def path_vanishing_batch(t, x, u, lam, p, bounds, out=None):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row. Batch form."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((3, 2, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    inv_m = 1.0/m
    inv_c = 1.0/c
    out[0, 0] = inv_m*lambda_v - inv_c*lambda_m
    out[0, 1] = 0.0
    out[1, 0] = T_min - T
    out[1, 1] = 0.0
    out[2, 0] = T - T_max
    out[2, 1] = 0.0
    return out


def path_multiplier_batch(t, x, u, lam, p, bounds, out=None):
    """The multiplier of each while it is on its boundary. Batch form."""
    h, v, m = x
    (T,) = u
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    inv_v = 1.0/v
    inv_rho0 = 1.0/rho0
    inv_c = 1.0/c
    inv_m = 1.0/m
    area_inv_m_lambda_v = area*inv_m*lambda_v
    out[0] = 0.5*area_inv_m_lambda_v*inv_c*v + area_inv_m_lambda_v - inv_rho0*inv_v*lambda_h*np.exp(beta*(h - 1.0))
    out[1] = 0.0
    out[2] = 0.0
    return out


def boundary_control_batch(t, x, lam, p, bounds, out=None):
    """The controls on the boundary of each, row by row. Batch form."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_h = 1.0/h
    w = 0.5*v*v
    out[0, 0] = area*rho0*w*np.exp(-beta*(h - 1.0)) + beta*m*w + g0*inv_h*inv_h*m
    out[1, 0] = T_min
    out[2, 0] = T_max
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_m = 1.0/m
    inv_h = 1.0/h
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_m_lambda_v = inv_m*lambda_v
    w = -inv_smoothing*(inv_m_lambda_v - inv_c*lambda_m)
    w_2 = np.minimum(np.maximum(w, T_min), T_max)
    w_3 = area*rho0*np.exp(-beta*(h - 1.0))
    w_4 = 0.5*v*v*w_3
    w_5 = w_2 - w_4
    out[0] = v
    out[1] = inv_m*w_5 - g0*inv_h*inv_h
    out[2] = -inv_c*w_2
    out[3] = -lambda_v*(beta*inv_m*w_4 + 2.0*g0*inv_h*inv_h*inv_h)
    out[4] = inv_m_lambda_v*v*w_3 - lambda_h
    out[5] = inv_m*inv_m*lambda_v*w_5
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_h = 1.0/h
    inv_m = 1.0/m
    w = area*rho0*np.exp(-beta*(h - 1.0))
    w_2 = 0.5*v*v*w
    inv_m_w_2 = inv_m*w_2
    w_3 = beta*inv_m_w_2 + 2.0*g0*inv_h*inv_h*inv_h
    v_w = v*w
    inv_m_v_w = inv_m*v_w
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_m_lambda_v = inv_m*lambda_v
    w_4 = -inv_smoothing*(inv_m_lambda_v - inv_c*lambda_m)
    w_5 = np.minimum(np.maximum(w_4, T_min), T_max)
    w_6 = w_5 - w_2
    w_7 = np.heaviside(w_4 - T_min, 1.0)*np.heaviside(T_max - w_4, 1.0)
    inv_smoothing_w_7 = inv_smoothing*w_7
    w_8 = inv_m*inv_m*inv_m*lambda_v
    inv_m_sq = inv_m*inv_m
    w_9 = inv_smoothing_w_7*w_8 - inv_m_sq*w_6
    w_10 = inv_m_sq*inv_smoothing_w_7
    w_11 = inv_c*inv_m*inv_smoothing_w_7
    inv_c_lambda_v_w_10 = inv_c*lambda_v*w_10
    w_12 = -beta*inv_m_lambda_v*v_w
    inv_m_sq_lambda_v = inv_m_sq*lambda_v
    w_13 = beta*inv_m_sq_lambda_v*w_2
    w_14 = -inv_m_sq_lambda_v*v_w
    out[0, 0] = 0.0
    out[0, 1] = 1.0
    out[0, 2] = 0.0
    out[0, 3] = 0.0
    out[0, 4] = 0.0
    out[0, 5] = 0.0
    out[1, 0] = w_3
    out[1, 1] = -inv_m_v_w
    out[1, 2] = w_9
    out[1, 3] = 0.0
    out[1, 4] = -w_10
    out[1, 5] = w_11
    out[2, 0] = 0.0
    out[2, 1] = 0.0
    out[2, 2] = -inv_c_lambda_v_w_10
    out[2, 3] = 0.0
    out[2, 4] = w_11
    out[2, 5] = -inv_c*inv_c*inv_smoothing_w_7
    out[3, 0] = -lambda_v*(-beta*beta*inv_m_w_2 - 6.0*g0*inv_h*inv_h*inv_h*inv_h)
    out[3, 1] = w_12
    out[3, 2] = w_13
    out[3, 3] = 0.0
    out[3, 4] = -w_3
    out[3, 5] = 0.0
    out[4, 0] = w_12
    out[4, 1] = inv_m_lambda_v*w
    out[4, 2] = w_14
    out[4, 3] = -1.0
    out[4, 4] = inv_m_v_w
    out[4, 5] = 0.0
    out[5, 0] = w_13
    out[5, 1] = w_14
    out[5, 2] = inv_m*inv_m*inv_m*inv_m*inv_smoothing_w_7*lambda_v*lambda_v - 2.0*w_6*w_8
    out[5, 3] = 0.0
    out[5, 4] = -w_9
    out[5, 5] = inv_c_lambda_v_w_10
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    given_h, given_v, given_m, on_reference_h, on_reference_v, on_reference_m, target_h, target_v, target_m = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    inv_m = 1.0/m
    inv_smoothing = 1.0/smoothing
    inv_c = 1.0/c
    inv_c_lambda_m = inv_c*lambda_m
    w = -inv_smoothing*(inv_m*lambda_v - inv_c_lambda_m)
    w_2 = np.minimum(np.maximum(w, T_min), T_max)
    inv_h = 1.0/h
    out[0] = given_h*(h - target_h) + h*on_reference_h - (-lambda_h - 1.0)*(1.0 - given_h - on_reference_h)
    out[1] = given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v
    out[2] = given_m*(m - target_m) + lambda_m*(1.0 - given_m - on_reference_m) + m*on_reference_m
    out[3] = lambda_h*v + lambda_v*(inv_m*(w_2 - 0.5*area*rho0*v*v*np.exp(-beta*(h - 1.0))) - g0*inv_h*inv_h) + 0.5*smoothing*w_2*w_2 - inv_c_lambda_m*w_2
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    h, v, m = x
    lambda_h, lambda_v, lambda_m = lam
    rho0, area, beta, g0, c, q_max = p
    T_min, T_max, smoothing, magnitude_share = bounds
    given_h, given_v, given_m, on_reference_h, on_reference_v, on_reference_m, target_h, target_v, target_m = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 7, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_h + on_reference_h
    w_2 = given_v + on_reference_v
    w_3 = given_m + on_reference_m
    inv_h = 1.0/h
    inv_m = 1.0/m
    w_4 = area*rho0*np.exp(-beta*(h - 1.0))
    w_5 = 0.5*v*v*w_4
    inv_m_lambda_v = inv_m*lambda_v
    inv_c = 1.0/c
    inv_c_lambda_m = inv_c*lambda_m
    inv_smoothing = 1.0/smoothing
    w_6 = -inv_smoothing*(inv_m_lambda_v - inv_c_lambda_m)
    w_7 = np.heaviside(w_6 - T_min, 1.0)*np.heaviside(T_max - w_6, 1.0)
    inv_smoothing_w_7 = inv_smoothing*w_7
    w_8 = inv_smoothing_w_7*lambda_v
    inv_m_sq = inv_m*inv_m
    inv_m_sq_w_8 = inv_m_sq*w_8
    w_9 = np.minimum(np.maximum(w_6, T_min), T_max)
    w_10 = w_9 - w_5
    w_7_w_9 = w_7*w_9
    inv_c_w_9 = inv_c*w_9
    out[0, 0] = w
    out[0, 3] = 1.0 - w
    out[1, 1] = w_2
    out[1, 4] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 5] = 1.0 - w_3
    out[3, 0] = lambda_v*(beta*inv_m*w_5 + 2.0*g0*inv_h*inv_h*inv_h)
    out[3, 1] = lambda_h - inv_m_lambda_v*v*w_4
    out[3, 2] = inv_m_sq*lambda_v*w_7_w_9 + lambda_v*(inv_m*inv_m*inv_m*w_8 - inv_m_sq*w_10) - inv_c_lambda_m*inv_m_sq_w_8
    out[3, 3] = v
    out[3, 4] = inv_c*inv_m*inv_smoothing*lambda_m*w_7 + inv_m*w_10 - g0*inv_h*inv_h - inv_m*w_7_w_9 - inv_m_sq_w_8
    out[3, 5] = inv_c*inv_m_lambda_v*inv_smoothing_w_7 + inv_c_w_9*w_7 - inv_c*inv_c*inv_smoothing_w_7*lambda_m - inv_c_w_9
    return out
