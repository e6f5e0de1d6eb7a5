"""Earth-pointing gyrostat, linearised about rest.

Written by satsym from derivations/gimballed_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/gimballed_wheel.py
Source: ../derivations/gimballed_wheel.py 556f29f5e697be71060e04a260695b4e
Digest: ca2a56a4fe3de274f103268578d9f9ad372e1727dc737cbc1aaf23408e2ac3a4
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'gyrostat_linear',
    'title': 'Earth-pointing gyrostat, linearised about rest',
    'source': 'derivations/gimballed_wheel.py',
    'states': (
        {'symbol': 'phi', 'latex': '\\phi', 'unit': 'rad', 'meaning': 'roll angle, about x, after yaw', 'kind': 'angle'},
        {'symbol': 'psi', 'latex': '\\psi', 'unit': 'rad', 'meaning': 'yaw angle, about z, the first of the three', 'kind': 'angle'},
        {'symbol': 'theta', 'latex': '\\theta', 'unit': 'rad', 'meaning': 'pitch angle, about y, the last of the three', 'kind': 'angle'},
        {'symbol': 'phi_dot', 'latex': '\\dot\\phi', 'unit': 'rad/s', 'meaning': 'rate of the roll angle'},
        {'symbol': 'psi_dot', 'latex': '\\dot\\psi', 'unit': 'rad/s', 'meaning': 'rate of the yaw angle'},
        {'symbol': 'theta_dot', 'latex': '\\dot\\theta', 'unit': 'rad/s', 'meaning': 'rate of the pitch angle'},
    ),
    'controls': (
        {'symbol': 'torque_x', 'latex': 'T_x', 'unit': 'N*m', 'meaning': 'torque on the body in roll'},
        {'symbol': 'torque_z', 'latex': 'T_z', 'unit': 'N*m', 'meaning': 'torque on the body in yaw'},
    ),
    'parameters': (
        {'symbol': 'I_x', 'latex': 'I_x', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in roll', 'default': 1356.0, 'positive': True},
        {'symbol': 'I_y', 'latex': 'I_y', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in pitch', 'default': 678.0, 'positive': True},
        {'symbol': 'I_z', 'latex': 'I_z', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in yaw', 'default': 1356.0, 'positive': True},
        {'symbol': 'w0', 'latex': '\\omega_0', 'unit': 'rad/s', 'meaning': 'orbital angular velocity', 'default': 7.26e-05, 'positive': True},
        {'symbol': 'h', 'latex': 'h', 'unit': 'N*m*s', 'meaning': 'angular momentum of the wheel relative to the body, along -y', 'default': 9.4247784},
    ),
    'control_set': None,
    'has_cost': False,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'linear': (
        'state_matrix',
        'input_matrix',
    ),
    'conditions': (
        {'terms': (('I_x', -1.0), ('I_y', 1.0), ('I_z', 1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_x', 1.0), ('I_y', -1.0), ('I_z', 1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_x', 1.0), ('I_y', 1.0), ('I_z', -1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
    ),
    'mode_groups': (
        {'name': 'nutation', 'states': ('phi', 'psi', 'phi_dot', 'psi_dot'), 'vanishing': 'w0', 'slow': 'orbit-rate mode'},
        {'name': 'pitch libration', 'states': ('theta', 'theta_dot'), 'neutral': 'pitch drift'},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    phi, psi, theta, phi_dot, psi_dot, theta_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w = I_x*w0 + I_z_w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    inv_I_y = 1.0/I_y
    return (
        phi_dot,
        psi_dot,
        theta_dot,
        inv_I_x*psi_dot*w + inv_I_x*torque_x - inv_I_x*phi*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0),
        inv_I_z*psi*w0*(I_x*w0 - I_y_w0 - h) + inv_I_z*torque_z - inv_I_z*phi_dot*w,
        -3.0*inv_I_y*theta*w0*w0*(I_x - I_z),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    phi, psi, theta, phi_dot, psi_dot, theta_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_x_w0 = I_x*w0
    w = I_x_w0 + I_z*w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    inv_I_y = 1.0/I_y
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
        inv_I_x*w0*(4.0*I_z*w0 - 4.0*I_y_w0 - h),
        0.0,
        0.0,
        0.0,
        inv_I_x*w,
        0.0,
        0.0,
        inv_I_z*w0*(I_x_w0 - I_y_w0 - h),
        0.0,
        -inv_I_z*w,
        0.0,
        0.0,
        0.0,
        0.0,
        3.0*inv_I_y*w0*w0*(I_z - I_x),
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    phi, psi, theta, phi_dot, psi_dot, theta_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        inv_I_x,
        0.0,
        0.0,
        inv_I_z,
        0.0,
        0.0,
    )


def state_matrix(t, p):
    """A, row by row."""
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_x_w0 = I_x*w0
    w = I_x_w0 + I_z*w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    inv_I_y = 1.0/I_y
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
        inv_I_x*w0*(4.0*I_z*w0 - 4.0*I_y_w0 - h),
        0.0,
        0.0,
        0.0,
        inv_I_x*w,
        0.0,
        0.0,
        inv_I_z*w0*(I_x_w0 - I_y_w0 - h),
        0.0,
        -inv_I_z*w,
        0.0,
        0.0,
        0.0,
        0.0,
        3.0*inv_I_y*w0*w0*(I_z - I_x),
        0.0,
        0.0,
        0.0,
    )


def input_matrix(t, p):
    """B, row by row."""
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        inv_I_x,
        0.0,
        0.0,
        inv_I_z,
        0.0,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    I_x, I_y, I_z, w0, h = p
    phi_at, psi_at, theta_at, phi_dot_at, psi_dot_at, theta_dot_at = x
    phi_mid, psi_mid, theta_mid, phi_dot_mid, psi_dot_mid, theta_dot_mid = x_mid
    torque_x_at, torque_z_at = u
    torque_x_mid, torque_z_mid = u_mid
    phi, psi, theta, phi_dot, psi_dot, theta_dot = x0
    inv_I_x = 1.0/I_x
    I_z_w0 = I_z*w0
    I_y_w0 = I_y*w0
    w = I_x*w0 + I_z_w0 - I_y_w0 - h
    inv_I_x_w = inv_I_x*w
    w_2 = inv_I_x*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    inv_I_z = 1.0/I_z
    inv_I_z_w = inv_I_z*w
    w_3 = inv_I_z*w0*(I_x*w0 - I_y_w0 - h)
    inv_I_y = 1.0/I_y
    w_4 = 3.0*inv_I_y*w0*w0*(I_x - I_z)
    steps = len(times) - 1
    t = times[0]
    phi_at[0] = phi
    psi_at[0] = psi
    theta_at[0] = theta
    phi_dot_at[0] = phi_dot
    psi_dot_at[0] = psi_dot
    theta_dot_at[0] = theta_dot
    torque_x = torque_x_at[0]
    torque_z = torque_z_at[0]
    slope_phi_dot = inv_I_x*torque_x + inv_I_x_w*psi_dot - phi*w_2
    slope_psi_dot = inv_I_z*torque_z + psi*w_3 - inv_I_z_w*phi_dot
    slope_theta_dot = -theta*w_4
    for i in range(steps):
        t_end = times[i + 1]
        h_2 = t_end - t
        phi_at[i] = phi
        psi_at[i] = psi
        theta_at[i] = theta
        phi_dot_at[i] = phi_dot
        psi_dot_at[i] = psi_dot
        theta_dot_at[i] = theta_dot
        torque_x_half = torque_x_mid[i]
        torque_x_end = torque_x_at[i + 1]
        torque_z_half = torque_z_mid[i]
        torque_z_end = torque_z_at[i + 1]
        half = 0.5*h_2
        sixth = (1.0/6.0)*h_2
        phi_2 = half*phi_dot + phi
        psi_2 = half*psi_dot + psi
        theta_2 = half*theta_dot + theta
        phi_dot_2 = half*slope_phi_dot + phi_dot
        psi_dot_2 = half*slope_psi_dot + psi_dot
        theta_dot_2 = half*slope_theta_dot + theta_dot
        k2_phi_dot = inv_I_x*torque_x_half + inv_I_x_w*psi_dot_2 - phi_2*w_2
        k2_psi_dot = inv_I_z*torque_z_half + psi_2*w_3 - inv_I_z_w*phi_dot_2
        k2_theta_dot = -theta_2*w_4
        phi_3 = half*phi_dot_2 + phi
        psi_3 = half*psi_dot_2 + psi
        theta_3 = half*theta_dot_2 + theta
        phi_dot_3 = half*k2_phi_dot + phi_dot
        psi_dot_3 = half*k2_psi_dot + psi_dot
        theta_dot_3 = half*k2_theta_dot + theta_dot
        k3_phi_dot = inv_I_x*torque_x_half + inv_I_x_w*psi_dot_3 - phi_3*w_2
        k3_psi_dot = inv_I_z*torque_z_half + psi_3*w_3 - inv_I_z_w*phi_dot_3
        k3_theta_dot = -theta_3*w_4
        phi_4 = h_2*phi_dot_3 + phi
        psi_4 = h_2*psi_dot_3 + psi
        theta_4 = h_2*theta_dot_3 + theta
        phi_dot_4 = h_2*k3_phi_dot + phi_dot
        psi_dot_4 = h_2*k3_psi_dot + psi_dot
        k4_phi_dot = inv_I_x*torque_x_end + inv_I_x_w*psi_dot_4 - phi_4*w_2
        k4_psi_dot = inv_I_z*torque_z_end + psi_4*w_3 - inv_I_z_w*phi_dot_4
        k4_theta_dot = -theta_4*w_4
        k23_phi_dot = k2_phi_dot + k3_phi_dot
        k123_phi_dot = k23_phi_dot + slope_phi_dot
        k23_psi_dot = k2_psi_dot + k3_psi_dot
        k123_psi_dot = k23_psi_dot + slope_psi_dot
        k23_theta_dot = k2_theta_dot + k3_theta_dot
        k123_theta_dot = k23_theta_dot + slope_theta_dot
        phi_end = h_2*(k123_phi_dot*sixth + phi_dot) + phi
        psi_end = h_2*(k123_psi_dot*sixth + psi_dot) + psi
        theta_end = h_2*(k123_theta_dot*sixth + theta_dot) + theta
        phi_dot_end = phi_dot + sixth*(k123_phi_dot + k23_phi_dot + k4_phi_dot)
        psi_dot_end = psi_dot + sixth*(k123_psi_dot + k23_psi_dot + k4_psi_dot)
        theta_dot_end = sixth*(k123_theta_dot + k23_theta_dot + k4_theta_dot) + theta_dot
        slope_end_phi_dot = inv_I_x*torque_x_end + inv_I_x_w*psi_dot_end - phi_end*w_2
        slope_end_psi_dot = inv_I_z*torque_z_end + psi_end*w_3 - inv_I_z_w*phi_dot_end
        slope_end_theta_dot = -theta_end*w_4
        eighth = 0.125*h_2
        phi_mid[i] = eighth*(phi_dot - phi_dot_end) + 0.5*(phi + phi_end)
        psi_mid[i] = eighth*(psi_dot - psi_dot_end) + 0.5*(psi + psi_end)
        theta_mid[i] = eighth*(theta_dot - theta_dot_end) + 0.5*(theta + theta_end)
        phi_dot_mid[i] = eighth*(slope_phi_dot - slope_end_phi_dot) + 0.5*(phi_dot + phi_dot_end)
        psi_dot_mid[i] = eighth*(slope_psi_dot - slope_end_psi_dot) + 0.5*(psi_dot + psi_dot_end)
        theta_dot_mid[i] = eighth*(slope_theta_dot - slope_end_theta_dot) + 0.5*(theta_dot + theta_dot_end)
        t = t_end
        phi = phi_end
        psi = psi_end
        theta = theta_end
        phi_dot = phi_dot_end
        psi_dot = psi_dot_end
        theta_dot = theta_dot_end
        slope_phi_dot = slope_end_phi_dot
        slope_psi_dot = slope_end_psi_dot
        slope_theta_dot = slope_end_theta_dot
    phi_at[steps] = phi
    psi_at[steps] = psi
    theta_at[steps] = theta
    phi_dot_at[steps] = phi_dot
    psi_dot_at[steps] = psi_dot
    theta_dot_at[steps] = theta_dot


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    phi, psi, theta, phi_dot, psi_dot, theta_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, u, *p))
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w = I_x*w0 + I_z_w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    inv_I_y = 1.0/I_y
    out[0] = phi_dot
    out[1] = psi_dot
    out[2] = theta_dot
    out[3] = inv_I_x*psi_dot*w + inv_I_x*torque_x - inv_I_x*phi*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    out[4] = inv_I_z*psi*w0*(I_x*w0 - I_y_w0 - h) + inv_I_z*torque_z - inv_I_z*phi_dot*w
    out[5] = -3.0*inv_I_y*theta*w0*w0*(I_x - I_z)
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    phi, psi, theta, phi_dot, psi_dot, theta_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_x_w0 = I_x*w0
    w = I_x_w0 + I_z*w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    inv_I_y = 1.0/I_y
    out[0, 3] = 1.0
    out[1, 4] = 1.0
    out[2, 5] = 1.0
    out[3, 0] = inv_I_x*w0*(4.0*I_z*w0 - 4.0*I_y_w0 - h)
    out[3, 4] = inv_I_x*w
    out[4, 1] = inv_I_z*w0*(I_x_w0 - I_y_w0 - h)
    out[4, 3] = -inv_I_z*w
    out[5, 2] = 3.0*inv_I_y*w0*w0*(I_z - I_x)
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    phi, psi, theta, phi_dot, psi_dot, theta_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    out[3, 0] = inv_I_x
    out[4, 1] = inv_I_z
    return out


def state_matrix_batch(t, p, out=None):
    """A, row by row. Batch form."""
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]), np.shape(p[2]), np.shape(p[3]), np.shape(p[4]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_x_w0 = I_x*w0
    w = I_x_w0 + I_z*w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    inv_I_y = 1.0/I_y
    out[0, 3] = 1.0
    out[1, 4] = 1.0
    out[2, 5] = 1.0
    out[3, 0] = inv_I_x*w0*(4.0*I_z*w0 - 4.0*I_y_w0 - h)
    out[3, 4] = inv_I_x*w
    out[4, 1] = inv_I_z*w0*(I_x_w0 - I_y_w0 - h)
    out[4, 3] = -inv_I_z*w
    out[5, 2] = 3.0*inv_I_y*w0*w0*(I_z - I_x)
    return out


def input_matrix_batch(t, p, out=None):
    """B, row by row. Batch form."""
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]), np.shape(p[2]), np.shape(p[3]), np.shape(p[4]))
        out = np.empty((6, 2, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    out[3, 0] = inv_I_x
    out[4, 1] = inv_I_z
    return out
