"""Hill's equations: three-dimensional motion near a circular orbit.

Written by satsym from derivations/hill.py. Do not edit: mend that file instead, then run
    satsym derive derivations/hill.py
Source: ../derivations/hill.py 4e4795c416dd7578e62badd714c450d8
Digest: c9d35eec4e004bac7df502b001a80dd47f6ead00449ae8eb2606e53af502ac0e
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'hill',
    'title': "Hill's equations: three-dimensional motion near a circular orbit",
    'source': 'derivations/hill.py',
    'states': (
        {'symbol': 'xi', 'latex': '\\xi', 'unit': 'km', 'meaning': 'deviation in the radial direction'},
        {'symbol': 'eta', 'latex': '\\eta', 'unit': 'km', 'meaning': 'deviation along the track'},
        {'symbol': 'zeta', 'latex': '\\zeta', 'unit': 'km', 'meaning': 'deviation along the orbit normal'},
        {'symbol': 'xi_dot', 'latex': '\\dot\\xi', 'unit': 'km/s', 'meaning': 'rate of xi'},
        {'symbol': 'eta_dot', 'latex': '\\dot\\eta', 'unit': 'km/s', 'meaning': 'rate of eta'},
        {'symbol': 'zeta_dot', 'latex': '\\dot\\zeta', 'unit': 'km/s', 'meaning': 'rate of zeta'},
    ),
    'controls': (
        {'symbol': 'u1', 'latex': 'u_1', 'unit': 'km/s**2', 'meaning': 'thrust per unit mass in the radial direction'},
        {'symbol': 'u2', 'latex': 'u_2', 'unit': 'km/s**2', 'meaning': 'thrust per unit mass along the track'},
        {'symbol': 'u3', 'latex': 'u_3', 'unit': 'km/s**2', 'meaning': 'thrust per unit mass along the orbit normal'},
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
        {'symbol': 'y1', 'latex': 'y_1', 'unit': 'km', 'meaning': 'deviation of the distance from the centre of force'},
        {'symbol': 'y2', 'latex': 'y_2', 'unit': 'km', 'meaning': 'distance from the plane of the reference orbit'},
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
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    u1, u2, u3 = u
    sigma, omega = p
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    return (
        xi_dot,
        eta_dot,
        zeta_dot,
        eta_dot*twice_omega + 3.0*omega_sq*xi + u1,
        u2 - twice_omega*xi_dot,
        u3 - omega_sq*zeta,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    u1, u2, u3 = u
    sigma, omega = p
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    return (
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
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
        0.0,
        0.0,
        1.0,
        3.0*omega_sq,
        0.0,
        0.0,
        0.0,
        twice_omega,
        0.0,
        0.0,
        0.0,
        0.0,
        -twice_omega,
        0.0,
        0.0,
        0.0,
        0.0,
        -omega_sq,
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    u1, u2, u3 = u
    sigma, omega = p
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
        1.0,
        0.0,
        0.0,
        0.0,
        1.0,
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
        0.0,
        0.0,
        1.0,
        0.0,
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
        0.0,
        0.0,
        1.0,
        3.0*omega_sq,
        0.0,
        0.0,
        0.0,
        twice_omega,
        0.0,
        0.0,
        0.0,
        0.0,
        -twice_omega,
        0.0,
        0.0,
        0.0,
        0.0,
        -omega_sq,
        0.0,
        0.0,
        0.0,
    )


def input_matrix(t, p):
    """B, row by row."""
    sigma, omega = p
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
        1.0,
        0.0,
        0.0,
        0.0,
        1.0,
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
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
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
        0.0,
        0.0,
    )


def deviation_dynamics(t, x, u, p):
    """Exact rates of change of the deviations."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    u1, u2, u3 = u
    sigma, omega = p
    omega_sq = omega*omega
    w = sigma + xi
    twice_omega = 2.0*omega
    w_2 = eta*eta + w*w + zeta*zeta
    sqrt_w_2 = math.sqrt(w_2)
    inv_sqrt_w_2 = 1.0/sqrt_w_2
    mu = omega_sq*sigma*sigma*sigma
    w_3 = inv_sqrt_w_2*inv_sqrt_w_2*inv_sqrt_w_2*mu
    return (
        xi_dot,
        eta_dot,
        zeta_dot,
        eta_dot*twice_omega + omega_sq*w + u1 - w*w_3,
        eta*omega_sq + u2 - eta*w_3 - twice_omega*xi_dot,
        u3 - w_3*zeta,
    )


def original_state(t, x, p):
    """The original states at a deviation."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    sigma, omega = p
    return (
        sigma + xi,
        eta,
        zeta,
        xi_dot,
        eta_dot,
        zeta_dot,
    )


def deviation_state(t, original, p):
    """The deviation at original states."""
    x_value, y, z, x_dot, y_dot, z_dot = original
    sigma, omega = p
    return (
        x_value - sigma,
        y,
        z,
        x_dot,
        y_dot,
        z_dot,
    )


def characteristic_polynomial(p):
    """det(s I - A), highest power first."""
    sigma, omega = p
    omega_sq = omega*omega
    return (
        1.0,
        0.0,
        2.0*omega_sq,
        0.0,
        omega*omega*omega*omega,
        0.0,
        0.0,
    )


def routh_column(p):
    """First column of the Routh array of the characteristic polynomial."""
    sigma, omega = p
    omega_sq = omega*omega
    w = omega*omega*omega*omega
    return (
        1.0,
        6.0,
        (2.0/3.0)*omega_sq,
        2.0*omega_sq,
        6.0*omega_sq,
        (4.0/3.0)*w,
        2.0*w,
    )


def eigenvalues(p):
    """Eigenvalues of A: rows of a real and an imaginary part."""
    sigma, omega = p
    w = -omega
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        omega,
        0.0,
        omega,
        0.0,
        w,
        0.0,
        w,
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
    omega_sin_omega_t = omega*sin_omega_t
    twice_sin_omega_t = 2.0*sin_omega_t
    w_2 = 6.0*omega
    return (
        4.0 - 3.0*cos_omega_t,
        0.0,
        0.0,
        inv_omega_sin_omega_t,
        -w,
        0.0,
        6.0*sin_omega_t - 6.0*omega_t,
        1.0,
        0.0,
        w,
        4.0*inv_omega_sin_omega_t - 3.0*t,
        0.0,
        0.0,
        0.0,
        cos_omega_t,
        0.0,
        0.0,
        inv_omega_sin_omega_t,
        3.0*omega_sin_omega_t,
        0.0,
        0.0,
        cos_omega_t,
        twice_sin_omega_t,
        0.0,
        cos_omega_t*w_2 - w_2,
        0.0,
        0.0,
        -twice_sin_omega_t,
        4.0*cos_omega_t - 3.0,
        0.0,
        0.0,
        0.0,
        -omega_sin_omega_t,
        0.0,
        0.0,
        cos_omega_t,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    sigma, omega = p
    xi_at, eta_at, zeta_at, xi_dot_at, eta_dot_at, zeta_dot_at = x
    xi_mid, eta_mid, zeta_mid, xi_dot_mid, eta_dot_mid, zeta_dot_mid = x_mid
    u1_at, u2_at, u3_at = u
    u1_mid, u2_mid, u3_mid = u_mid
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x0
    twice_omega = 2.0*omega
    omega_sq = omega*omega
    w = 3.0*omega_sq
    steps = len(times) - 1
    t = times[0]
    xi_at[0] = xi
    eta_at[0] = eta
    zeta_at[0] = zeta
    xi_dot_at[0] = xi_dot
    eta_dot_at[0] = eta_dot
    zeta_dot_at[0] = zeta_dot
    u1 = u1_at[0]
    u2 = u2_at[0]
    u3 = u3_at[0]
    slope_xi_dot = eta_dot*twice_omega + u1 + w*xi
    slope_eta_dot = u2 - twice_omega*xi_dot
    slope_zeta_dot = u3 - omega_sq*zeta
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        xi_at[i] = xi
        eta_at[i] = eta
        zeta_at[i] = zeta
        xi_dot_at[i] = xi_dot
        eta_dot_at[i] = eta_dot
        zeta_dot_at[i] = zeta_dot
        u1_half = u1_mid[i]
        u1_end = u1_at[i + 1]
        u2_half = u2_mid[i]
        u2_end = u2_at[i + 1]
        u3_half = u3_mid[i]
        u3_end = u3_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        xi_2 = half*xi_dot + xi
        zeta_2 = half*zeta_dot + zeta
        xi_dot_2 = half*slope_xi_dot + xi_dot
        eta_dot_2 = eta_dot + half*slope_eta_dot
        zeta_dot_2 = half*slope_zeta_dot + zeta_dot
        k2_xi_dot = eta_dot_2*twice_omega + u1_half + w*xi_2
        k2_eta_dot = u2_half - twice_omega*xi_dot_2
        k2_zeta_dot = u3_half - omega_sq*zeta_2
        xi_3 = half*xi_dot_2 + xi
        zeta_3 = half*zeta_dot_2 + zeta
        xi_dot_3 = half*k2_xi_dot + xi_dot
        eta_dot_3 = eta_dot + half*k2_eta_dot
        zeta_dot_3 = half*k2_zeta_dot + zeta_dot
        k3_xi_dot = eta_dot_3*twice_omega + u1_half + w*xi_3
        k3_eta_dot = u2_half - twice_omega*xi_dot_3
        k3_zeta_dot = u3_half - omega_sq*zeta_3
        xi_4 = h*xi_dot_3 + xi
        zeta_4 = h*zeta_dot_3 + zeta
        xi_dot_4 = h*k3_xi_dot + xi_dot
        eta_dot_4 = eta_dot + h*k3_eta_dot
        k4_xi_dot = eta_dot_4*twice_omega + u1_end + w*xi_4
        k4_eta_dot = u2_end - twice_omega*xi_dot_4
        k4_zeta_dot = u3_end - omega_sq*zeta_4
        k23_xi_dot = k2_xi_dot + k3_xi_dot
        k123_xi_dot = k23_xi_dot + slope_xi_dot
        k23_eta_dot = k2_eta_dot + k3_eta_dot
        k123_eta_dot = k23_eta_dot + slope_eta_dot
        k23_zeta_dot = k2_zeta_dot + k3_zeta_dot
        k123_zeta_dot = k23_zeta_dot + slope_zeta_dot
        xi_end = h*(k123_xi_dot*sixth + xi_dot) + xi
        eta_end = eta + h*(eta_dot + k123_eta_dot*sixth)
        zeta_end = h*(k123_zeta_dot*sixth + zeta_dot) + zeta
        xi_dot_end = sixth*(k123_xi_dot + k23_xi_dot + k4_xi_dot) + xi_dot
        eta_dot_end = eta_dot + sixth*(k123_eta_dot + k23_eta_dot + k4_eta_dot)
        zeta_dot_end = sixth*(k123_zeta_dot + k23_zeta_dot + k4_zeta_dot) + zeta_dot
        slope_end_xi_dot = eta_dot_end*twice_omega + u1_end + w*xi_end
        slope_end_eta_dot = u2_end - twice_omega*xi_dot_end
        slope_end_zeta_dot = u3_end - omega_sq*zeta_end
        eighth = 0.125*h
        xi_mid[i] = eighth*(xi_dot - xi_dot_end) + 0.5*(xi + xi_end)
        eta_mid[i] = eighth*(eta_dot - eta_dot_end) + 0.5*(eta + eta_end)
        zeta_mid[i] = eighth*(zeta_dot - zeta_dot_end) + 0.5*(zeta + zeta_end)
        xi_dot_mid[i] = eighth*(slope_xi_dot - slope_end_xi_dot) + 0.5*(xi_dot + xi_dot_end)
        eta_dot_mid[i] = eighth*(slope_eta_dot - slope_end_eta_dot) + 0.5*(eta_dot + eta_dot_end)
        zeta_dot_mid[i] = eighth*(slope_zeta_dot - slope_end_zeta_dot) + 0.5*(zeta_dot + zeta_dot_end)
        t = t_end
        xi = xi_end
        eta = eta_end
        zeta = zeta_end
        xi_dot = xi_dot_end
        eta_dot = eta_dot_end
        zeta_dot = zeta_dot_end
        slope_xi_dot = slope_end_xi_dot
        slope_eta_dot = slope_end_eta_dot
        slope_zeta_dot = slope_end_zeta_dot
    xi_at[steps] = xi
    eta_at[steps] = eta
    zeta_at[steps] = zeta
    xi_dot_at[steps] = xi_dot
    eta_dot_at[steps] = eta_dot
    zeta_dot_at[steps] = zeta_dot


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    u1, u2, u3 = u
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, u, *p))
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[0] = xi_dot
    out[1] = eta_dot
    out[2] = zeta_dot
    out[3] = eta_dot*twice_omega + 3.0*omega_sq*xi + u1
    out[4] = u2 - twice_omega*xi_dot
    out[5] = u3 - omega_sq*zeta
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    u1, u2, u3 = u
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[0, 3] = 1.0
    out[1, 4] = 1.0
    out[2, 5] = 1.0
    out[3, 0] = 3.0*omega_sq
    out[3, 4] = twice_omega
    out[4, 3] = -twice_omega
    out[5, 2] = -omega_sq
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    u1, u2, u3 = u
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 3, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[3, 0] = 1.0
    out[4, 1] = 1.0
    out[5, 2] = 1.0
    return out


def state_matrix_batch(t, p, out=None):
    """A, row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[0, 3] = 1.0
    out[1, 4] = 1.0
    out[2, 5] = 1.0
    out[3, 0] = 3.0*omega_sq
    out[3, 4] = twice_omega
    out[4, 3] = -twice_omega
    out[5, 2] = -omega_sq
    return out


def input_matrix_batch(t, p, out=None):
    """B, row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((6, 3, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    out[3, 0] = 1.0
    out[4, 1] = 1.0
    out[5, 2] = 1.0
    return out


def output_matrix_batch(t, p, out=None):
    """C, row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((2, 6, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    out[0, 0] = 1.0
    out[1, 2] = 1.0
    return out


def feedthrough_matrix_batch(t, p, out=None):
    """D, row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((2, 3, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    return out


def deviation_dynamics_batch(t, x, u, p, out=None):
    """Exact rates of change of the deviations. Batch form."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    u1, u2, u3 = u
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, u, *p))
    omega_sq = omega*omega
    w = sigma + xi
    twice_omega = 2.0*omega
    w_2 = eta*eta + w*w + zeta*zeta
    sqrt_w_2 = np.sqrt(w_2)
    inv_sqrt_w_2 = 1.0/sqrt_w_2
    mu = omega_sq*sigma*sigma*sigma
    w_3 = inv_sqrt_w_2*inv_sqrt_w_2*inv_sqrt_w_2*mu
    out[0] = xi_dot
    out[1] = eta_dot
    out[2] = zeta_dot
    out[3] = eta_dot*twice_omega + omega_sq*w + u1 - w*w_3
    out[4] = eta*omega_sq + u2 - eta*w_3 - twice_omega*xi_dot
    out[5] = u3 - w_3*zeta
    return out


def original_state_batch(t, x, p, out=None):
    """The original states at a deviation. Batch form."""
    xi, eta, zeta, xi_dot, eta_dot, zeta_dot = x
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, *p))
    out[0] = sigma + xi
    out[1] = eta
    out[2] = zeta
    out[3] = xi_dot
    out[4] = eta_dot
    out[5] = zeta_dot
    return out


def deviation_state_batch(t, original, p, out=None):
    """The deviation at original states. Batch form."""
    x_value, y, z, x_dot, y_dot, z_dot = original
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(original[0]))
        out = np.empty((6, *shape), np.result_type(float, t, original, *p))
    out[0] = x_value - sigma
    out[1] = y
    out[2] = z
    out[3] = x_dot
    out[4] = y_dot
    out[5] = z_dot
    return out


def characteristic_polynomial_batch(p, out=None):
    """det(s I - A), highest power first. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(p[0]), np.shape(p[1]))
        out = np.empty((7, *shape), np.result_type(float, *p))
    omega_sq = omega*omega
    out[0] = 1.0
    out[1] = 0.0
    out[2] = 2.0*omega_sq
    out[3] = 0.0
    out[4] = omega*omega*omega*omega
    out[5] = 0.0
    out[6] = 0.0
    return out


def routh_column_batch(p, out=None):
    """First column of the Routh array of the characteristic polynomial. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(p[0]), np.shape(p[1]))
        out = np.empty((7, *shape), np.result_type(float, *p))
    omega_sq = omega*omega
    w = omega*omega*omega*omega
    out[0] = 1.0
    out[1] = 6.0
    out[2] = (2.0/3.0)*omega_sq
    out[3] = 2.0*omega_sq
    out[4] = 6.0*omega_sq
    out[5] = (4.0/3.0)*w
    out[6] = 2.0*w
    return out


def eigenvalues_batch(p, out=None):
    """Eigenvalues of A: rows of a real and an imaginary part. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(p[0]), np.shape(p[1]))
        out = np.empty((6, 2, *shape), np.result_type(float, *p))
    out[...] = 0.0
    w = -omega
    out[2, 1] = omega
    out[3, 1] = omega
    out[4, 1] = w
    out[5, 1] = w
    return out


def transition_matrix_batch(t, p, out=None):
    """e^(At), row by row. Batch form."""
    sigma, omega = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    omega_t = omega*t
    cos_omega_t = np.cos(omega_t)
    inv_omega = 1.0/omega
    sin_omega_t = np.sin(omega_t)
    inv_omega_sin_omega_t = inv_omega*sin_omega_t
    w = 2.0*cos_omega_t*inv_omega - 2.0*inv_omega
    omega_sin_omega_t = omega*sin_omega_t
    twice_sin_omega_t = 2.0*sin_omega_t
    w_2 = 6.0*omega
    out[0, 0] = 4.0 - 3.0*cos_omega_t
    out[0, 3] = inv_omega_sin_omega_t
    out[0, 4] = -w
    out[1, 0] = 6.0*sin_omega_t - 6.0*omega_t
    out[1, 1] = 1.0
    out[1, 3] = w
    out[1, 4] = 4.0*inv_omega_sin_omega_t - 3.0*t
    out[2, 2] = cos_omega_t
    out[2, 5] = inv_omega_sin_omega_t
    out[3, 0] = 3.0*omega_sin_omega_t
    out[3, 3] = cos_omega_t
    out[3, 4] = twice_sin_omega_t
    out[4, 0] = cos_omega_t*w_2 - w_2
    out[4, 3] = -twice_sin_omega_t
    out[4, 4] = 4.0*cos_omega_t - 3.0
    out[5, 2] = -omega_sin_omega_t
    out[5, 5] = cos_omega_t
    return out
