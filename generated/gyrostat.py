"""Satellite in a circular orbit with constant wheel momentum along -y.

Written by satsym from derivations/gimballed_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/gimballed_wheel.py
Source: ../derivations/gimballed_wheel.py 556f29f5e697be71060e04a260695b4e
Digest: 24c04e8c0c8a7a4ac0ff81e496e0362eddafc7c65d7a20a045607af5ac46c844
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'gyrostat',
    'title': 'Satellite in a circular orbit with constant wheel momentum along -y',
    'source': 'derivations/gimballed_wheel.py',
    'states': (
        {'symbol': 'phi', 'latex': '\\phi', 'unit': 'rad', 'meaning': 'roll angle, about x, after yaw', 'kind': 'angle'},
        {'symbol': 'psi', 'latex': '\\psi', 'unit': 'rad', 'meaning': 'yaw angle, about z, the first of the three', 'kind': 'angle'},
        {'symbol': 'theta', 'latex': '\\theta', 'unit': 'rad', 'meaning': 'pitch angle, about y, the last of the three', 'kind': 'angle'},
        {'symbol': 'w_x', 'latex': '\\omega_x', 'unit': 'rad/s', 'meaning': "inertial angular velocity about the body's x"},
        {'symbol': 'w_y', 'latex': '\\omega_y', 'unit': 'rad/s', 'meaning': "inertial angular velocity about the body's y"},
        {'symbol': 'w_z', 'latex': '\\omega_z', 'unit': 'rad/s', 'meaning': "inertial angular velocity about the body's z"},
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
    'has_reference': True,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'conditions': (
        {'terms': (('I_x', -1.0), ('I_y', 1.0), ('I_z', 1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_x', 1.0), ('I_y', -1.0), ('I_z', 1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_x', 1.0), ('I_y', 1.0), ('I_z', -1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
    ),
    'equilibria': 'h',
    'mode_groups': (
        {'name': 'nutation', 'states': ('phi', 'psi', 'w_x', 'w_z'), 'vanishing': 'w0', 'slow': 'orbit-rate mode'},
        {'name': 'pitch libration', 'states': ('theta', 'w_y'), 'neutral': 'pitch drift'},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    phi, psi, theta, w_x, w_y, w_z = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    cos_theta = math.cos(theta)
    sin_theta = math.sin(theta)
    cos_phi = math.cos(phi)
    inv_cos_phi = 1.0/cos_phi
    sin_theta_w_x = sin_theta*w_x
    sin_phi = math.sin(phi)
    w = w0*math.cos(psi)
    tan_phi = math.tan(phi)
    inv_I_x = 1.0/I_x
    w_2 = -I_z
    w_3 = -I_y - w_2
    w0_sq = w0*w0
    inv_I_y = 1.0/I_y
    w_4 = I_x + w_2
    inv_I_z = 1.0/I_z
    w_5 = I_y - I_x
    return (
        cos_theta*w_x + sin_theta*w_z + w0*math.sin(psi),
        inv_cos_phi*(cos_theta*w_z - sin_phi*w - sin_theta_w_x),
        inv_cos_phi*w + sin_theta_w_x*tan_phi + w_y - cos_theta*tan_phi*w_z,
        inv_I_x*(3.0*cos_phi*cos_theta*sin_phi*w0_sq*w_3 + torque_x - h*w_z - w_3*w_y*w_z),
        inv_I_y*(-3.0*cos_phi*cos_phi*cos_theta*sin_theta*w0_sq*w_4 - w_4*w_x*w_z),
        inv_I_z*(h*w_x + torque_z - 3.0*cos_phi*sin_phi*sin_theta*w0_sq*w_5 - w_5*w_x*w_y),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    phi, psi, theta, w_x, w_y, w_z = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    w = w0*math.cos(psi)
    sin_theta = math.sin(theta)
    sin_theta_w_x = sin_theta*w_x
    cos_theta = math.cos(theta)
    cos_theta_w_z = cos_theta*w_z
    w_2 = sin_theta_w_x - cos_theta_w_z
    sin_phi = math.sin(phi)
    cos_phi = math.cos(phi)
    cos_phi_sq = cos_phi*cos_phi
    inv_cos_phi = 1.0/cos_phi
    inv_cos_phi_sq = inv_cos_phi*inv_cos_phi
    w_3 = inv_cos_phi*w0*math.sin(psi)
    w_4 = cos_theta*w_x + sin_theta*w_z
    tan_phi = math.tan(phi)
    tan_phi_sq = tan_phi*tan_phi
    inv_I_x = 1.0/I_x
    w_5 = -I_z
    w_6 = inv_I_x*(I_y + w_5)
    w0_sq = w0*w0
    w_7 = 3.0*w0_sq
    w_6_w_7 = w_6*w_7
    w_8 = (cos_phi - sin_phi)*(cos_phi + sin_phi)
    cos_phi_sin_phi = cos_phi*sin_phi
    w_9 = cos_phi_sin_phi*sin_theta
    w_10 = h - I_y*w_y
    inv_I_y = 1.0/I_y
    w_11 = I_x + w_5
    inv_I_y_w_11 = inv_I_y*w_11
    w_12 = -inv_I_y*w_11
    inv_I_z = 1.0/I_z
    w_13 = inv_I_z*(I_x - I_y)
    w_13_w_7 = w_13*w_7
    return (
        0.0,
        w,
        -w_2,
        cos_theta,
        0.0,
        sin_theta,
        inv_cos_phi_sq*(cos_theta*sin_phi*w_z - cos_phi_sq*w - sin_phi*sin_phi*w - sin_phi*sin_theta_w_x),
        sin_phi*w_3,
        -inv_cos_phi*w_4,
        -inv_cos_phi*sin_theta,
        0.0,
        cos_theta*inv_cos_phi,
        inv_cos_phi_sq*sin_phi*w + sin_theta_w_x*tan_phi_sq + w_2 - cos_theta_w_z*tan_phi_sq,
        -w_3,
        tan_phi*w_4,
        sin_theta*tan_phi,
        1.0,
        -cos_theta*tan_phi,
        -cos_theta*w_6_w_7*w_8,
        0.0,
        w_6_w_7*w_9,
        0.0,
        w_6*w_z,
        inv_I_x*(-I_z*w_y - w_10),
        6.0*cos_theta*inv_I_y_w_11*w0_sq*w_9,
        0.0,
        -cos_phi_sq*inv_I_y_w_11*w_7*(cos_theta - sin_theta)*(cos_theta + sin_theta),
        w_12*w_z,
        0.0,
        w_12*w_x,
        sin_theta*w_13_w_7*w_8,
        0.0,
        cos_phi_sin_phi*cos_theta*w_13_w_7,
        inv_I_z*(I_x*w_y + w_10),
        w_13*w_x,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    phi, psi, theta, w_x, w_y, w_z = x
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
        0.0,
        0.0,
        inv_I_z,
    )


def reference(t, p):
    """The reference curve c(t)."""
    I_x, I_y, I_z, w0, h = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        -w0,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    I_x, I_y, I_z, w0, h = p
    phi_at, psi_at, theta_at, w_x_at, w_y_at, w_z_at = x
    phi_mid, psi_mid, theta_mid, w_x_mid, w_y_mid, w_z_mid = x_mid
    torque_x_at, torque_z_at = u
    torque_x_mid, torque_z_mid = u_mid
    phi, psi, theta, w_x, w_y, w_z = x0
    inv_I_x = 1.0/I_x
    w_2 = -I_z
    w_3 = I_y + w_2
    w_4 = 3.0*w0*w0
    w_5 = -w_3*w_4
    inv_I_y = 1.0/I_y
    w_6 = I_x + w_2
    w_7 = -w_6
    w_4_w_6 = w_4*w_6
    inv_I_z = 1.0/I_z
    w_8 = I_x - I_y
    w_9 = -w_4*w_8
    steps = len(times) - 1
    t = times[0]
    phi_at[0] = phi
    psi_at[0] = psi
    theta_at[0] = theta
    w_x_at[0] = w_x
    w_y_at[0] = w_y
    w_z_at[0] = w_z
    torque_x = torque_x_at[0]
    torque_z = torque_z_at[0]
    cos_theta = math.cos(theta)
    sin_theta = math.sin(theta)
    cos_phi = math.cos(phi)
    inv_cos_phi = 1.0/cos_phi
    w = w0*math.cos(psi)
    sin_theta_w_x = sin_theta*w_x
    sin_phi = math.sin(phi)
    tan_phi = math.tan(phi)
    cos_phi_sin_phi = cos_phi*sin_phi
    slope_phi = cos_theta*w_x + sin_theta*w_z + w0*math.sin(psi)
    slope_psi = inv_cos_phi*(cos_theta*w_z - sin_phi*w - sin_theta_w_x)
    slope_theta = inv_cos_phi*w + sin_theta_w_x*tan_phi + w_y - cos_theta*tan_phi*w_z
    slope_w_x = inv_I_x*(cos_phi_sin_phi*cos_theta*w_5 + torque_x + w_3*w_y*w_z - h*w_z)
    slope_w_y = inv_I_y*(w_7*w_x*w_z - cos_phi*cos_phi*cos_theta*sin_theta*w_4_w_6)
    slope_w_z = inv_I_z*(h*w_x + torque_z + w_8*w_x*w_y - cos_phi_sin_phi*sin_theta*w_9)
    for i in range(steps):
        t_end = times[i + 1]
        h_2 = t_end - t
        phi_at[i] = phi
        psi_at[i] = psi
        theta_at[i] = theta
        w_x_at[i] = w_x
        w_y_at[i] = w_y
        w_z_at[i] = w_z
        torque_x_half = torque_x_mid[i]
        torque_x_end = torque_x_at[i + 1]
        torque_z_half = torque_z_mid[i]
        torque_z_end = torque_z_at[i + 1]
        half = 0.5*h_2
        sixth = (1.0/6.0)*h_2
        phi_2 = half*slope_phi + phi
        psi_2 = half*slope_psi + psi
        theta_2 = half*slope_theta + theta
        w_x_2 = half*slope_w_x + w_x
        w_y_2 = half*slope_w_y + w_y
        w_z_2 = half*slope_w_z + w_z
        cos_theta_2 = math.cos(theta_2)
        sin_theta_2 = math.sin(theta_2)
        cos_phi_2 = math.cos(phi_2)
        inv_cos_phi_2 = 1.0/cos_phi_2
        w_10 = w0*math.cos(psi_2)
        sin_theta_2_w_x_2 = sin_theta_2*w_x_2
        sin_phi_2 = math.sin(phi_2)
        tan_phi_2 = math.tan(phi_2)
        cos_phi_2_sin_phi_2 = cos_phi_2*sin_phi_2
        k2_phi = cos_theta_2*w_x_2 + sin_theta_2*w_z_2 + w0*math.sin(psi_2)
        k2_psi = inv_cos_phi_2*(cos_theta_2*w_z_2 - sin_phi_2*w_10 - sin_theta_2_w_x_2)
        k2_theta = inv_cos_phi_2*w_10 + sin_theta_2_w_x_2*tan_phi_2 + w_y_2 - cos_theta_2*tan_phi_2*w_z_2
        k2_w_x = inv_I_x*(cos_phi_2_sin_phi_2*cos_theta_2*w_5 + torque_x_half + w_3*w_y_2*w_z_2 - h*w_z_2)
        k2_w_y = inv_I_y*(w_7*w_x_2*w_z_2 - cos_phi_2*cos_phi_2*cos_theta_2*sin_theta_2*w_4_w_6)
        k2_w_z = inv_I_z*(h*w_x_2 + torque_z_half + w_8*w_x_2*w_y_2 - cos_phi_2_sin_phi_2*sin_theta_2*w_9)
        phi_3 = half*k2_phi + phi
        psi_3 = half*k2_psi + psi
        theta_3 = half*k2_theta + theta
        w_x_3 = half*k2_w_x + w_x
        w_y_3 = half*k2_w_y + w_y
        w_z_3 = half*k2_w_z + w_z
        cos_theta_3 = math.cos(theta_3)
        sin_theta_3 = math.sin(theta_3)
        cos_phi_3 = math.cos(phi_3)
        inv_cos_phi_3 = 1.0/cos_phi_3
        w_11 = w0*math.cos(psi_3)
        sin_theta_3_w_x_3 = sin_theta_3*w_x_3
        sin_phi_3 = math.sin(phi_3)
        tan_phi_3 = math.tan(phi_3)
        cos_phi_3_sin_phi_3 = cos_phi_3*sin_phi_3
        k3_phi = cos_theta_3*w_x_3 + sin_theta_3*w_z_3 + w0*math.sin(psi_3)
        k3_psi = inv_cos_phi_3*(cos_theta_3*w_z_3 - sin_phi_3*w_11 - sin_theta_3_w_x_3)
        k3_theta = inv_cos_phi_3*w_11 + sin_theta_3_w_x_3*tan_phi_3 + w_y_3 - cos_theta_3*tan_phi_3*w_z_3
        k3_w_x = inv_I_x*(cos_phi_3_sin_phi_3*cos_theta_3*w_5 + torque_x_half + w_3*w_y_3*w_z_3 - h*w_z_3)
        k3_w_y = inv_I_y*(w_7*w_x_3*w_z_3 - cos_phi_3*cos_phi_3*cos_theta_3*sin_theta_3*w_4_w_6)
        k3_w_z = inv_I_z*(h*w_x_3 + torque_z_half + w_8*w_x_3*w_y_3 - cos_phi_3_sin_phi_3*sin_theta_3*w_9)
        phi_4 = h_2*k3_phi + phi
        psi_4 = h_2*k3_psi + psi
        theta_4 = h_2*k3_theta + theta
        w_x_4 = h_2*k3_w_x + w_x
        w_y_4 = h_2*k3_w_y + w_y
        w_z_4 = h_2*k3_w_z + w_z
        cos_theta_4 = math.cos(theta_4)
        sin_theta_4 = math.sin(theta_4)
        cos_phi_4 = math.cos(phi_4)
        inv_cos_phi_4 = 1.0/cos_phi_4
        w_12 = w0*math.cos(psi_4)
        sin_theta_4_w_x_4 = sin_theta_4*w_x_4
        sin_phi_4 = math.sin(phi_4)
        tan_phi_4 = math.tan(phi_4)
        cos_phi_4_sin_phi_4 = cos_phi_4*sin_phi_4
        k4_phi = cos_theta_4*w_x_4 + sin_theta_4*w_z_4 + w0*math.sin(psi_4)
        k4_psi = inv_cos_phi_4*(cos_theta_4*w_z_4 - sin_phi_4*w_12 - sin_theta_4_w_x_4)
        k4_theta = inv_cos_phi_4*w_12 + sin_theta_4_w_x_4*tan_phi_4 + w_y_4 - cos_theta_4*tan_phi_4*w_z_4
        k4_w_x = inv_I_x*(cos_phi_4_sin_phi_4*cos_theta_4*w_5 + torque_x_end + w_3*w_y_4*w_z_4 - h*w_z_4)
        k4_w_y = inv_I_y*(w_7*w_x_4*w_z_4 - cos_phi_4*cos_phi_4*cos_theta_4*sin_theta_4*w_4_w_6)
        k4_w_z = inv_I_z*(h*w_x_4 + torque_z_end + w_8*w_x_4*w_y_4 - cos_phi_4_sin_phi_4*sin_theta_4*w_9)
        phi_end = phi + sixth*(k4_phi + slope_phi + 2.0*(k2_phi + k3_phi))
        psi_end = psi + sixth*(k4_psi + slope_psi + 2.0*(k2_psi + k3_psi))
        theta_end = sixth*(k4_theta + slope_theta + 2.0*(k2_theta + k3_theta)) + theta
        w_x_end = sixth*(k4_w_x + slope_w_x + 2.0*(k2_w_x + k3_w_x)) + w_x
        w_y_end = sixth*(k4_w_y + slope_w_y + 2.0*(k2_w_y + k3_w_y)) + w_y
        w_z_end = sixth*(k4_w_z + slope_w_z + 2.0*(k2_w_z + k3_w_z)) + w_z
        cos_theta_end = math.cos(theta_end)
        sin_theta_end = math.sin(theta_end)
        cos_phi_end = math.cos(phi_end)
        inv_cos_phi_end = 1.0/cos_phi_end
        w_13 = w0*math.cos(psi_end)
        sin_theta_end_w_x_end = sin_theta_end*w_x_end
        sin_phi_end = math.sin(phi_end)
        tan_phi_end = math.tan(phi_end)
        cos_phi_end_sin_phi_end = cos_phi_end*sin_phi_end
        slope_end_phi = cos_theta_end*w_x_end + sin_theta_end*w_z_end + w0*math.sin(psi_end)
        slope_end_psi = inv_cos_phi_end*(cos_theta_end*w_z_end - sin_phi_end*w_13 - sin_theta_end_w_x_end)
        slope_end_theta = inv_cos_phi_end*w_13 + sin_theta_end_w_x_end*tan_phi_end + w_y_end - cos_theta_end*tan_phi_end*w_z_end
        slope_end_w_x = inv_I_x*(cos_phi_end_sin_phi_end*cos_theta_end*w_5 + torque_x_end + w_3*w_y_end*w_z_end - h*w_z_end)
        slope_end_w_y = inv_I_y*(w_7*w_x_end*w_z_end - cos_phi_end*cos_phi_end*cos_theta_end*sin_theta_end*w_4_w_6)
        slope_end_w_z = inv_I_z*(h*w_x_end + torque_z_end + w_8*w_x_end*w_y_end - cos_phi_end_sin_phi_end*sin_theta_end*w_9)
        eighth = 0.125*h_2
        phi_mid[i] = eighth*(slope_phi - slope_end_phi) + 0.5*(phi + phi_end)
        psi_mid[i] = eighth*(slope_psi - slope_end_psi) + 0.5*(psi + psi_end)
        theta_mid[i] = eighth*(slope_theta - slope_end_theta) + 0.5*(theta + theta_end)
        w_x_mid[i] = eighth*(slope_w_x - slope_end_w_x) + 0.5*(w_x + w_x_end)
        w_y_mid[i] = eighth*(slope_w_y - slope_end_w_y) + 0.5*(w_y + w_y_end)
        w_z_mid[i] = eighth*(slope_w_z - slope_end_w_z) + 0.5*(w_z + w_z_end)
        t = t_end
        phi = phi_end
        psi = psi_end
        theta = theta_end
        w_x = w_x_end
        w_y = w_y_end
        w_z = w_z_end
        slope_phi = slope_end_phi
        slope_psi = slope_end_psi
        slope_theta = slope_end_theta
        slope_w_x = slope_end_w_x
        slope_w_y = slope_end_w_y
        slope_w_z = slope_end_w_z
    phi_at[steps] = phi
    psi_at[steps] = psi
    theta_at[steps] = theta
    w_x_at[steps] = w_x
    w_y_at[steps] = w_y
    w_z_at[steps] = w_z


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    phi, psi, theta, w_x, w_y, w_z = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, u, *p))
    cos_theta = np.cos(theta)
    sin_theta = np.sin(theta)
    cos_phi = np.cos(phi)
    inv_cos_phi = 1.0/cos_phi
    sin_theta_w_x = sin_theta*w_x
    sin_phi = np.sin(phi)
    w = w0*np.cos(psi)
    tan_phi = np.tan(phi)
    inv_I_x = 1.0/I_x
    w_2 = -I_z
    w_3 = -I_y - w_2
    w0_sq = w0*w0
    inv_I_y = 1.0/I_y
    w_4 = I_x + w_2
    inv_I_z = 1.0/I_z
    w_5 = I_y - I_x
    out[0] = cos_theta*w_x + sin_theta*w_z + w0*np.sin(psi)
    out[1] = inv_cos_phi*(cos_theta*w_z - sin_phi*w - sin_theta_w_x)
    out[2] = inv_cos_phi*w + sin_theta_w_x*tan_phi + w_y - cos_theta*tan_phi*w_z
    out[3] = inv_I_x*(3.0*cos_phi*cos_theta*sin_phi*w0_sq*w_3 + torque_x - h*w_z - w_3*w_y*w_z)
    out[4] = inv_I_y*(-3.0*cos_phi*cos_phi*cos_theta*sin_theta*w0_sq*w_4 - w_4*w_x*w_z)
    out[5] = inv_I_z*(h*w_x + torque_z - 3.0*cos_phi*sin_phi*sin_theta*w0_sq*w_5 - w_5*w_x*w_y)
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    phi, psi, theta, w_x, w_y, w_z = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, u, *p))
    w = w0*np.cos(psi)
    sin_theta = np.sin(theta)
    sin_theta_w_x = sin_theta*w_x
    cos_theta = np.cos(theta)
    cos_theta_w_z = cos_theta*w_z
    w_2 = sin_theta_w_x - cos_theta_w_z
    sin_phi = np.sin(phi)
    cos_phi = np.cos(phi)
    cos_phi_sq = cos_phi*cos_phi
    inv_cos_phi = 1.0/cos_phi
    inv_cos_phi_sq = inv_cos_phi*inv_cos_phi
    w_3 = inv_cos_phi*w0*np.sin(psi)
    w_4 = cos_theta*w_x + sin_theta*w_z
    tan_phi = np.tan(phi)
    tan_phi_sq = tan_phi*tan_phi
    inv_I_x = 1.0/I_x
    w_5 = -I_z
    w_6 = inv_I_x*(I_y + w_5)
    w0_sq = w0*w0
    w_7 = 3.0*w0_sq
    w_6_w_7 = w_6*w_7
    w_8 = (cos_phi - sin_phi)*(cos_phi + sin_phi)
    cos_phi_sin_phi = cos_phi*sin_phi
    w_9 = cos_phi_sin_phi*sin_theta
    w_10 = h - I_y*w_y
    inv_I_y = 1.0/I_y
    w_11 = I_x + w_5
    inv_I_y_w_11 = inv_I_y*w_11
    w_12 = -inv_I_y*w_11
    inv_I_z = 1.0/I_z
    w_13 = inv_I_z*(I_x - I_y)
    w_13_w_7 = w_13*w_7
    out[0, 0] = 0.0
    out[0, 1] = w
    out[0, 2] = -w_2
    out[0, 3] = cos_theta
    out[0, 4] = 0.0
    out[0, 5] = sin_theta
    out[1, 0] = inv_cos_phi_sq*(cos_theta*sin_phi*w_z - cos_phi_sq*w - sin_phi*sin_phi*w - sin_phi*sin_theta_w_x)
    out[1, 1] = sin_phi*w_3
    out[1, 2] = -inv_cos_phi*w_4
    out[1, 3] = -inv_cos_phi*sin_theta
    out[1, 4] = 0.0
    out[1, 5] = cos_theta*inv_cos_phi
    out[2, 0] = inv_cos_phi_sq*sin_phi*w + sin_theta_w_x*tan_phi_sq + w_2 - cos_theta_w_z*tan_phi_sq
    out[2, 1] = -w_3
    out[2, 2] = tan_phi*w_4
    out[2, 3] = sin_theta*tan_phi
    out[2, 4] = 1.0
    out[2, 5] = -cos_theta*tan_phi
    out[3, 0] = -cos_theta*w_6_w_7*w_8
    out[3, 1] = 0.0
    out[3, 2] = w_6_w_7*w_9
    out[3, 3] = 0.0
    out[3, 4] = w_6*w_z
    out[3, 5] = inv_I_x*(-I_z*w_y - w_10)
    out[4, 0] = 6.0*cos_theta*inv_I_y_w_11*w0_sq*w_9
    out[4, 1] = 0.0
    out[4, 2] = -cos_phi_sq*inv_I_y_w_11*w_7*(cos_theta - sin_theta)*(cos_theta + sin_theta)
    out[4, 3] = w_12*w_z
    out[4, 4] = 0.0
    out[4, 5] = w_12*w_x
    out[5, 0] = sin_theta*w_13_w_7*w_8
    out[5, 1] = 0.0
    out[5, 2] = cos_phi_sin_phi*cos_theta*w_13_w_7
    out[5, 3] = inv_I_z*(I_x*w_y + w_10)
    out[5, 4] = w_13*w_x
    out[5, 5] = 0.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    phi, psi, theta, w_x, w_y, w_z = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    out[3, 0] = inv_I_x
    out[5, 1] = inv_I_z
    return out


def reference_batch(t, p, out=None):
    """The reference curve c(t). Batch form."""
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((6, *shape), np.result_type(float, t, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = -w0
    out[5] = 0.0
    return out
