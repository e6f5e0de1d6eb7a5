"""Clohessy-Wiltshire equations: linearised in-plane motion near a circular orbit.

Written by satsym from derivations/clohessy_wiltshire.py. Do not edit: mend that file instead, then run
    satsym derive derivations/clohessy_wiltshire.py
Source: ../derivations/clohessy_wiltshire.py 76e49da5527c6e0ad02437036b6b61bc
Source: ../derivations/polar_orbit.py cbc2ab9efa60b232bc9a9d755c4231e3
Digest: c04dc11561ec6e500e40a4d88dc0f68f8f955140f61a0767331373d4894dba1e
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'clohessy_wiltshire',
    'title': 'Clohessy-Wiltshire equations: linearised in-plane motion near a circular orbit',
    'source': 'derivations/clohessy_wiltshire.py',
    'states': (
        {'symbol': 'x1', 'latex': 'x_1', 'unit': 'km', 'meaning': 'deviation of the distance from the centre of force'},
        {'symbol': 'x2', 'latex': 'x_2', 'unit': 'km/s', 'meaning': 'deviation of the radial velocity'},
        {'symbol': 'x3', 'latex': 'x_3', 'unit': 'km', 'meaning': 'deviation of the angle, as a length along the reference orbit'},
        {'symbol': 'x4', 'latex': 'x_4', 'unit': 'km/s', 'meaning': 'deviation of the angular velocity, as a velocity along the reference orbit'},
    ),
    'controls': (
        {'symbol': 'u1', 'latex': 'u_1', 'unit': 'km/s**2', 'meaning': 'radial thrust per unit mass'},
        {'symbol': 'u2', 'latex': 'u_2', 'unit': 'km/s**2', 'meaning': 'transverse thrust per unit mass'},
    ),
    'parameters': (
        {'symbol': 'sigma', 'latex': '\\sigma', 'unit': 'km', 'meaning': 'radius of the reference orbit', 'default': 1.0, 'positive': True},
        {'symbol': 'omega', 'latex': '\\omega', 'unit': 'rad/s', 'meaning': 'angular velocity of the reference orbit', 'default': 1.0, 'positive': True},
    ),
    'control_set': None,
    'has_cost': False,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'outputs': (
        {'symbol': 'y1', 'latex': 'y_1', 'unit': 'km', 'meaning': 'deviation of the measured distance'},
        {'symbol': 'y2', 'latex': 'y_2', 'unit': 'km', 'meaning': 'deviation of the measured angle, times the radius of the reference orbit'},
    ),
    'linear': (
        'state_matrix',
        'input_matrix',
        'output_matrix',
        'feedthrough_matrix',
        'deviation_dynamics',
        'original_state',
        'deviation_state',
        'characteristic_polynomial',
        'routh_column',
        'eigenvalues',
        'transition_matrix',
        'closed_loop_polynomial',
        'closed_loop_routh',
        'riccati_residual',
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega = p
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    return (
        x2,
        3.0*omega_sq*x1 + twice_omega*x4 + u1,
        x4,
        u2 - twice_omega*x2,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega = p
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        3.0*omega_sq,
        0.0,
        0.0,
        twice_omega,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        -twice_omega,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega = p
    return (
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
    )


def state_matrix(t, p):
    """A, row by row."""
    sigma, omega = p
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        3.0*omega_sq,
        0.0,
        0.0,
        twice_omega,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        -twice_omega,
        0.0,
        0.0,
    )


def input_matrix(t, p):
    """B, row by row."""
    sigma, omega = p
    return (
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
    )


def output_matrix(t, p):
    """C, row by row."""
    sigma, omega = p
    return (
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
    )


def feedthrough_matrix(t, p):
    """D, row by row."""
    sigma, omega = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def deviation_dynamics(t, x, u, p):
    """Exact rates of change of the deviations."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega = p
    inv_sigma = 1.0/sigma
    w = inv_sigma*x4 + omega
    w_2 = sigma + x1
    inv_w_2 = 1.0/w_2
    mu = omega*omega*sigma*sigma*sigma
    return (
        x2,
        u1 + w*w*w_2 - inv_w_2*inv_w_2*mu,
        x4,
        inv_w_2*sigma*(u2 - 2.0*w*x2),
    )


def original_state(t, x, p):
    """The original states at a deviation."""
    x1, x2, x3, x4 = x
    sigma, omega = p
    inv_sigma = 1.0/sigma
    return (
        sigma + x1,
        x2,
        inv_sigma*x3 + omega*t,
        inv_sigma*x4 + omega,
    )


def deviation_state(t, original, p):
    """The deviation at original states."""
    r, r_dot, theta, theta_dot = original
    sigma, omega = p
    return (
        r - sigma,
        r_dot,
        sigma*(theta - omega*t),
        sigma*(theta_dot - omega),
    )


def characteristic_polynomial(p):
    """det(s I - A), highest power first."""
    sigma, omega = p
    omega_sq = omega*omega
    return (
        1.0,
        0.0,
        omega_sq,
        0.0,
        0.0,
    )


def routh_column(p):
    """First column of the Routh array of the characteristic polynomial."""
    sigma, omega = p
    omega_sq = omega*omega
    twice_omega_sq = 2.0*omega_sq
    return (
        1.0,
        4.0,
        0.5*omega_sq,
        twice_omega_sq,
        twice_omega_sq,
    )


def eigenvalues(p):
    """Eigenvalues of A: rows of a real and an imaginary part."""
    sigma, omega = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        omega,
        0.0,
        -omega,
    )


def transition_matrix(t, p):
    """e^(At), row by row."""
    sigma, omega = p
    omega_t = omega*t
    cos_omega_t = math.cos(omega_t)
    inv_omega = 1.0/omega
    sin_omega_t = math.sin(omega_t)
    inv_omega_sin_omega_t = inv_omega*sin_omega_t
    w = 2.0*cos_omega_t*inv_omega - 2.0*inv_omega
    twice_sin_omega_t = 2.0*sin_omega_t
    w_2 = 6.0*omega
    return (
        4.0 - 3.0*cos_omega_t,
        inv_omega_sin_omega_t,
        0.0,
        -w,
        3.0*omega*sin_omega_t,
        cos_omega_t,
        0.0,
        twice_sin_omega_t,
        6.0*sin_omega_t - 6.0*omega_t,
        w,
        1.0,
        4.0*inv_omega_sin_omega_t - 3.0*t,
        cos_omega_t*w_2 - w_2,
        -twice_sin_omega_t,
        0.0,
        4.0*cos_omega_t - 3.0,
    )


def closed_loop_polynomial(gain, p):
    """det(s I - A + B K), highest power first."""
    K_1_1, K_1_2, K_1_3, K_1_4, K_2_1, K_2_2, K_2_3, K_2_4 = gain
    sigma, omega = p
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    w = 3.0*omega_sq
    return (
        1.0,
        K_1_2 + K_2_4,
        K_1_1 + K_1_2*K_2_4 + K_2_2*twice_omega + K_2_3 + omega_sq - K_1_4*K_2_2 - K_1_4*twice_omega,
        K_1_1*K_2_4 + K_1_2*K_2_3 + 2.0*K_2_1*omega - K_1_3*K_2_2 - K_1_3*twice_omega - K_1_4*K_2_1 - K_2_4*w,
        K_1_1*K_2_3 - K_1_3*K_2_1 - K_2_3*w,
    )


def closed_loop_routh(gain, p):
    """First column of the Routh array of the closed loop; not finite where an element but the last vanishes."""
    K_1_1, K_1_2, K_1_3, K_1_4, K_2_1, K_2_2, K_2_3, K_2_4 = gain
    sigma, omega = p
    w = K_1_2 + K_2_4
    inv_w = 1.0/w
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    w_2 = 3.0*omega_sq
    w_3 = K_1_3*K_2_2 + K_1_3*twice_omega + K_1_4*K_2_1 + K_2_4*w_2 - K_1_1*K_2_4 - K_1_2*K_2_3 - 2.0*K_2_1*omega
    w_4 = K_1_1 + K_1_2*K_2_4 + K_2_2*twice_omega + K_2_3 + inv_w*w_3 + omega_sq - K_1_4*K_2_2 - K_1_4*twice_omega
    inv_w_4 = 1.0/w_4
    w_5 = K_1_1*K_2_3 - K_1_3*K_2_1 - K_2_3*w_2
    return (
        1.0,
        w,
        w_4,
        -inv_w_4*w*w_5 - w_3,
        w_5,
    )


def riccati_residual(riccati, state_weight, control_weight, p):
    """A' P + P A - P B R^-1 B' P + Q, row by row."""
    P_1_1, P_1_2, P_1_3, P_1_4, P_2_1, P_2_2, P_2_3, P_2_4, P_3_1, P_3_2, P_3_3, P_3_4, P_4_1, P_4_2, P_4_3, P_4_4 = riccati
    Q_1_1, Q_1_2, Q_1_3, Q_1_4, Q_2_1, Q_2_2, Q_2_3, Q_2_4, Q_3_1, Q_3_2, Q_3_3, Q_3_4, Q_4_1, Q_4_2, Q_4_3, Q_4_4 = state_weight
    R_1_1, R_1_2, R_2_1, R_2_2 = control_weight
    sigma, omega = p
    omega_sq = omega*omega
    w = 3.0*omega_sq
    w_2 = R_1_1*R_2_2 - R_1_2*R_2_1
    inv_w_2 = 1.0/w_2
    P_1_2_inv_w_2 = P_1_2*inv_w_2
    w_3 = P_1_2_inv_w_2*R_2_2 - P_1_4*R_2_1*inv_w_2
    w_4 = P_1_4*R_1_1*inv_w_2 - P_1_2_inv_w_2*R_1_2
    twice_omega = 2.0*omega
    w_5 = P_1_1 + P_2_2*w
    P_2_2_inv_w_2 = P_2_2*inv_w_2
    w_6 = P_2_2_inv_w_2*R_2_2 - P_2_4*R_2_1*inv_w_2
    w_7 = P_2_4*R_1_1*inv_w_2 - P_2_2_inv_w_2*R_1_2
    w_8 = P_2_4*twice_omega + P_4_2*twice_omega
    w_9 = P_2_2*twice_omega - P_4_4*twice_omega
    P_3_2_inv_w_2 = P_3_2*inv_w_2
    w_10 = P_3_2_inv_w_2*R_2_2 - P_3_4*R_2_1*inv_w_2
    w_11 = P_3_4*R_1_1*inv_w_2 - P_3_2_inv_w_2*R_1_2
    P_4_2_inv_w_2 = P_4_2*inv_w_2
    w_12 = P_4_2_inv_w_2*R_2_2 - P_4_4*R_2_1*inv_w_2
    w_13 = P_4_4*R_1_1*inv_w_2 - P_4_2_inv_w_2*R_1_2
    return (
        P_1_2*w + P_2_1*w + Q_1_1 - P_2_1*w_3 - P_4_1*w_4,
        Q_1_2 + w_5 - P_1_4*twice_omega - P_2_2*w_3 - P_4_2*w_4,
        P_2_3*w + Q_1_3 - P_2_3*w_3 - P_4_3*w_4,
        P_1_2*twice_omega + P_1_3 + P_2_4*w + Q_1_4 - P_2_4*w_3 - P_4_4*w_4,
        Q_2_1 + w_5 - P_2_1*w_6 - P_4_1*twice_omega - P_4_1*w_7,
        P_1_2 + P_2_1 + Q_2_2 - P_2_2*w_6 - P_4_2*w_7 - w_8,
        P_1_3 + Q_2_3 - P_2_3*w_6 - P_4_3*twice_omega - P_4_3*w_7,
        P_1_4 + P_2_3 + Q_2_4 + w_9 - P_2_4*w_6 - P_4_4*w_7,
        3.0*P_3_2*omega_sq + Q_3_1 - P_2_1*w_10 - P_4_1*w_11,
        P_3_1 + Q_3_2 - P_2_2*w_10 - P_3_4*twice_omega - P_4_2*w_11,
        Q_3_3 - P_2_3*w_10 - P_4_3*w_11,
        P_3_2*twice_omega + P_3_3 + Q_3_4 - P_2_4*w_10 - P_4_4*w_11,
        P_2_1*twice_omega + P_3_1 + P_4_2*w + Q_4_1 - P_2_1*w_12 - P_4_1*w_13,
        P_3_2 + P_4_1 + Q_4_2 + w_9 - P_2_2*w_12 - P_4_2*w_13,
        P_2_3*twice_omega + P_3_3 + Q_4_3 - P_2_3*w_12 - P_4_3*w_13,
        P_3_4 + P_4_3 + Q_4_4 + w_8 - P_2_4*w_12 - P_4_4*w_13,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    sigma, omega = p
    x1_at, x2_at, x3_at, x4_at = x
    x1_mid, x2_mid, x3_mid, x4_mid = x_mid
    u1_at, u2_at = u
    u1_mid, u2_mid = u_mid
    x1, x2, x3, x4 = x0
    twice_omega = 2.0*omega
    omega_sq = omega*omega
    w = 3.0*omega_sq
    steps = len(times) - 1
    t = times[0]
    x1_at[0] = x1
    x2_at[0] = x2
    x3_at[0] = x3
    x4_at[0] = x4
    u1 = u1_at[0]
    u2 = u2_at[0]
    slope_x2 = twice_omega*x4 + u1 + w*x1
    slope_x4 = u2 - twice_omega*x2
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x1_at[i] = x1
        x2_at[i] = x2
        x3_at[i] = x3
        x4_at[i] = x4
        u1_half = u1_mid[i]
        u1_end = u1_at[i + 1]
        u2_half = u2_mid[i]
        u2_end = u2_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        x1_2 = half*x2 + x1
        x2_2 = half*slope_x2 + x2
        x4_2 = half*slope_x4 + x4
        k2_x2 = twice_omega*x4_2 + u1_half + w*x1_2
        k2_x4 = u2_half - twice_omega*x2_2
        x1_3 = half*x2_2 + x1
        x2_3 = half*k2_x2 + x2
        x4_3 = half*k2_x4 + x4
        k3_x2 = twice_omega*x4_3 + u1_half + w*x1_3
        k3_x4 = u2_half - twice_omega*x2_3
        x1_4 = h*x2_3 + x1
        x2_4 = h*k3_x2 + x2
        x4_4 = h*k3_x4 + x4
        k4_x2 = twice_omega*x4_4 + u1_end + w*x1_4
        k4_x4 = u2_end - twice_omega*x2_4
        k23_x2 = k2_x2 + k3_x2
        k123_x2 = k23_x2 + slope_x2
        k23_x4 = k2_x4 + k3_x4
        k123_x4 = k23_x4 + slope_x4
        x1_end = h*(k123_x2*sixth + x2) + x1
        x2_end = sixth*(k123_x2 + k23_x2 + k4_x2) + x2
        x3_end = h*(k123_x4*sixth + x4) + x3
        x4_end = sixth*(k123_x4 + k23_x4 + k4_x4) + x4
        slope_end_x2 = twice_omega*x4_end + u1_end + w*x1_end
        slope_end_x4 = u2_end - twice_omega*x2_end
        eighth = 0.125*h
        x1_mid[i] = eighth*(x2 - x2_end) + 0.5*(x1 + x1_end)
        x2_mid[i] = eighth*(slope_x2 - slope_end_x2) + 0.5*(x2 + x2_end)
        x3_mid[i] = eighth*(x4 - x4_end) + 0.5*(x3 + x3_end)
        x4_mid[i] = eighth*(slope_x4 - slope_end_x4) + 0.5*(x4 + x4_end)
        t = t_end
        x1 = x1_end
        x2 = x2_end
        x3 = x3_end
        x4 = x4_end
        slope_x2 = slope_end_x2
        slope_x4 = slope_end_x4
    x1_at[steps] = x1
    x2_at[steps] = x2
    x3_at[steps] = x3
    x4_at[steps] = x4


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[0] = x2
    out[1] = 3.0*omega_sq*x1 + twice_omega*x4 + u1
    out[2] = x4
    out[3] = u2 - twice_omega*x2
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[0, 1] = 1.0
    out[1, 0] = 3.0*omega_sq
    out[1, 3] = twice_omega
    out[2, 3] = 1.0
    out[3, 1] = -twice_omega
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[1, 0] = 1.0
    out[3, 1] = 1.0
    return out


def state_matrix_batch(t, p, out=None):
    """A, row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[0, 1] = 1.0
    out[1, 0] = 3.0*omega_sq
    out[1, 3] = twice_omega
    out[2, 3] = 1.0
    out[3, 1] = -twice_omega
    return out


def input_matrix_batch(t, p, out=None):
    """B, row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    out[1, 0] = 1.0
    out[3, 1] = 1.0
    return out


def output_matrix_batch(t, p, out=None):
    """C, row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((2, 4, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    out[0, 0] = 1.0
    out[1, 2] = 1.0
    return out


def feedthrough_matrix_batch(t, p, out=None):
    """D, row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    return out


def deviation_dynamics_batch(t, x, u, p, out=None):
    """Exact rates of change of the deviations. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))
    inv_sigma = 1.0/sigma
    w = inv_sigma*x4 + omega
    w_2 = sigma + x1
    inv_w_2 = 1.0/w_2
    mu = omega*omega*sigma*sigma*sigma
    out[0] = x2
    out[1] = u1 + w*w*w_2 - inv_w_2*inv_w_2*mu
    out[2] = x4
    out[3] = inv_w_2*sigma*(u2 - 2.0*w*x2)
    return out


def original_state_batch(t, x, p, out=None):
    """The original states at a deviation. Batch form."""
    x1, x2, x3, x4 = x
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, *p))
    inv_sigma = 1.0/sigma
    out[0] = sigma + x1
    out[1] = x2
    out[2] = inv_sigma*x3 + omega*t
    out[3] = inv_sigma*x4 + omega
    return out


def deviation_state_batch(t, original, p, out=None):
    """The deviation at original states. Batch form."""
    r, r_dot, theta, theta_dot = original
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(original[0]))
        out = np.empty((4, *shape), np.result_type(float, t, original, *p))
    out[0] = r - sigma
    out[1] = r_dot
    out[2] = sigma*(theta - omega*t)
    out[3] = sigma*(theta_dot - omega)
    return out


def characteristic_polynomial_batch(p, out=None):
    """det(s I - A), highest power first. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(p[0]), np.shape(p[1]))
        out = np.empty((5, *shape), np.result_type(float, *p))
    omega_sq = omega*omega
    out[0] = 1.0
    out[1] = 0.0
    out[2] = omega_sq
    out[3] = 0.0
    out[4] = 0.0
    return out


def routh_column_batch(p, out=None):
    """First column of the Routh array of the characteristic polynomial. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(p[0]), np.shape(p[1]))
        out = np.empty((5, *shape), np.result_type(float, *p))
    omega_sq = omega*omega
    twice_omega_sq = 2.0*omega_sq
    out[0] = 1.0
    out[1] = 4.0
    out[2] = 0.5*omega_sq
    out[3] = twice_omega_sq
    out[4] = twice_omega_sq
    return out


def eigenvalues_batch(p, out=None):
    """Eigenvalues of A: rows of a real and an imaginary part. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(p[0]), np.shape(p[1]))
        out = np.empty((4, 2, *shape), np.result_type(float, *p))
    out[...] = 0.0
    out[2, 1] = omega
    out[3, 1] = -omega
    return out


def transition_matrix_batch(t, p, out=None):
    """e^(At), row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, *p))
    omega_t = omega*t
    cos_omega_t = np.cos(omega_t)
    inv_omega = 1.0/omega
    sin_omega_t = np.sin(omega_t)
    inv_omega_sin_omega_t = inv_omega*sin_omega_t
    w = 2.0*cos_omega_t*inv_omega - 2.0*inv_omega
    twice_sin_omega_t = 2.0*sin_omega_t
    w_2 = 6.0*omega
    out[0, 0] = 4.0 - 3.0*cos_omega_t
    out[0, 1] = inv_omega_sin_omega_t
    out[0, 2] = 0.0
    out[0, 3] = -w
    out[1, 0] = 3.0*omega*sin_omega_t
    out[1, 1] = cos_omega_t
    out[1, 2] = 0.0
    out[1, 3] = twice_sin_omega_t
    out[2, 0] = 6.0*sin_omega_t - 6.0*omega_t
    out[2, 1] = w
    out[2, 2] = 1.0
    out[2, 3] = 4.0*inv_omega_sin_omega_t - 3.0*t
    out[3, 0] = cos_omega_t*w_2 - w_2
    out[3, 1] = -twice_sin_omega_t
    out[3, 2] = 0.0
    out[3, 3] = 4.0*cos_omega_t - 3.0
    return out


def closed_loop_polynomial_batch(gain, p, out=None):
    """det(s I - A + B K), highest power first. Batch form."""
    K_1_1, K_1_2, K_1_3, K_1_4, K_2_1, K_2_2, K_2_3, K_2_4 = gain
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(gain[0]), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((5, *shape), np.result_type(float, gain, *p))
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    w = 3.0*omega_sq
    out[0] = 1.0
    out[1] = K_1_2 + K_2_4
    out[2] = K_1_1 + K_1_2*K_2_4 + K_2_2*twice_omega + K_2_3 + omega_sq - K_1_4*K_2_2 - K_1_4*twice_omega
    out[3] = K_1_1*K_2_4 + K_1_2*K_2_3 + 2.0*K_2_1*omega - K_1_3*K_2_2 - K_1_3*twice_omega - K_1_4*K_2_1 - K_2_4*w
    out[4] = K_1_1*K_2_3 - K_1_3*K_2_1 - K_2_3*w
    return out


def closed_loop_routh_batch(gain, p, out=None):
    """First column of the Routh array of the closed loop; not finite where an element but the last vanishes. Batch form."""
    K_1_1, K_1_2, K_1_3, K_1_4, K_2_1, K_2_2, K_2_3, K_2_4 = gain
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(gain[0]), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((5, *shape), np.result_type(float, gain, *p))
    w = K_1_2 + K_2_4
    inv_w = 1.0/w
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    w_2 = 3.0*omega_sq
    w_3 = K_1_3*K_2_2 + K_1_3*twice_omega + K_1_4*K_2_1 + K_2_4*w_2 - K_1_1*K_2_4 - K_1_2*K_2_3 - 2.0*K_2_1*omega
    w_4 = K_1_1 + K_1_2*K_2_4 + K_2_2*twice_omega + K_2_3 + inv_w*w_3 + omega_sq - K_1_4*K_2_2 - K_1_4*twice_omega
    inv_w_4 = 1.0/w_4
    w_5 = K_1_1*K_2_3 - K_1_3*K_2_1 - K_2_3*w_2
    out[0] = 1.0
    out[1] = w
    out[2] = w_4
    out[3] = -inv_w_4*w*w_5 - w_3
    out[4] = w_5
    return out


def riccati_residual_batch(riccati, state_weight, control_weight, p, out=None):
    """A' P + P A - P B R^-1 B' P + Q, row by row. Batch form."""
    P_1_1, P_1_2, P_1_3, P_1_4, P_2_1, P_2_2, P_2_3, P_2_4, P_3_1, P_3_2, P_3_3, P_3_4, P_4_1, P_4_2, P_4_3, P_4_4 = riccati
    Q_1_1, Q_1_2, Q_1_3, Q_1_4, Q_2_1, Q_2_2, Q_2_3, Q_2_4, Q_3_1, Q_3_2, Q_3_3, Q_3_4, Q_4_1, Q_4_2, Q_4_3, Q_4_4 = state_weight
    R_1_1, R_1_2, R_2_1, R_2_2 = control_weight
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(riccati[0]), np.shape(state_weight[0]), np.shape(control_weight[0]), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((4, 4, *shape), np.result_type(float, riccati, state_weight, control_weight, *p))
    omega_sq = omega*omega
    w = 3.0*omega_sq
    w_2 = R_1_1*R_2_2 - R_1_2*R_2_1
    inv_w_2 = 1.0/w_2
    P_1_2_inv_w_2 = P_1_2*inv_w_2
    w_3 = P_1_2_inv_w_2*R_2_2 - P_1_4*R_2_1*inv_w_2
    w_4 = P_1_4*R_1_1*inv_w_2 - P_1_2_inv_w_2*R_1_2
    twice_omega = 2.0*omega
    w_5 = P_1_1 + P_2_2*w
    P_2_2_inv_w_2 = P_2_2*inv_w_2
    w_6 = P_2_2_inv_w_2*R_2_2 - P_2_4*R_2_1*inv_w_2
    w_7 = P_2_4*R_1_1*inv_w_2 - P_2_2_inv_w_2*R_1_2
    w_8 = P_2_4*twice_omega + P_4_2*twice_omega
    w_9 = P_2_2*twice_omega - P_4_4*twice_omega
    P_3_2_inv_w_2 = P_3_2*inv_w_2
    w_10 = P_3_2_inv_w_2*R_2_2 - P_3_4*R_2_1*inv_w_2
    w_11 = P_3_4*R_1_1*inv_w_2 - P_3_2_inv_w_2*R_1_2
    P_4_2_inv_w_2 = P_4_2*inv_w_2
    w_12 = P_4_2_inv_w_2*R_2_2 - P_4_4*R_2_1*inv_w_2
    w_13 = P_4_4*R_1_1*inv_w_2 - P_4_2_inv_w_2*R_1_2
    out[0, 0] = P_1_2*w + P_2_1*w + Q_1_1 - P_2_1*w_3 - P_4_1*w_4
    out[0, 1] = Q_1_2 + w_5 - P_1_4*twice_omega - P_2_2*w_3 - P_4_2*w_4
    out[0, 2] = P_2_3*w + Q_1_3 - P_2_3*w_3 - P_4_3*w_4
    out[0, 3] = P_1_2*twice_omega + P_1_3 + P_2_4*w + Q_1_4 - P_2_4*w_3 - P_4_4*w_4
    out[1, 0] = Q_2_1 + w_5 - P_2_1*w_6 - P_4_1*twice_omega - P_4_1*w_7
    out[1, 1] = P_1_2 + P_2_1 + Q_2_2 - P_2_2*w_6 - P_4_2*w_7 - w_8
    out[1, 2] = P_1_3 + Q_2_3 - P_2_3*w_6 - P_4_3*twice_omega - P_4_3*w_7
    out[1, 3] = P_1_4 + P_2_3 + Q_2_4 + w_9 - P_2_4*w_6 - P_4_4*w_7
    out[2, 0] = 3.0*P_3_2*omega_sq + Q_3_1 - P_2_1*w_10 - P_4_1*w_11
    out[2, 1] = P_3_1 + Q_3_2 - P_2_2*w_10 - P_3_4*twice_omega - P_4_2*w_11
    out[2, 2] = Q_3_3 - P_2_3*w_10 - P_4_3*w_11
    out[2, 3] = P_3_2*twice_omega + P_3_3 + Q_3_4 - P_2_4*w_10 - P_4_4*w_11
    out[3, 0] = P_2_1*twice_omega + P_3_1 + P_4_2*w + Q_4_1 - P_2_1*w_12 - P_4_1*w_13
    out[3, 1] = P_3_2 + P_4_1 + Q_4_2 + w_9 - P_2_2*w_12 - P_4_2*w_13
    out[3, 2] = P_2_3*twice_omega + P_3_3 + Q_4_3 - P_2_3*w_12 - P_4_3*w_13
    out[3, 3] = P_3_4 + P_4_3 + Q_4_4 + w_8 - P_2_4*w_12 - P_4_4*w_13
    return out
