"""Pitch axis under a critically damped proportional-derivative law.

Written by satsym from derivations/pitch_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/pitch_wheel.py
Source: ../derivations/pitch_wheel.py 6f132d08f603f74b458d9763f6cace18
Digest: f6a175acb06dc2c463faf9be419adc23ca1b006f892430f8bd8ef32c840c0b9e
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'pitch_classical',
    'title': 'Pitch axis under a critically damped proportional-derivative law',
    'source': 'derivations/pitch_wheel.py',
    'states': (
        {'symbol': 'theta', 'latex': '\\theta', 'unit': 'rad', 'meaning': 'pitch angle from the local vertical'},
        {'symbol': 'theta_dot', 'latex': '\\dot\\theta', 'unit': 'rad/s', 'meaning': 'rate of the pitch angle'},
        {'symbol': 'wheel_speed', 'latex': '\\Omega', 'unit': 'rad/s', 'meaning': 'deviation of the wheel speed from its nominal value'},
    ),
    'controls': (),
    'parameters': (
        {'symbol': 'I_x', 'latex': 'I_x', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in roll', 'default': 1356.0, 'positive': True},
        {'symbol': 'I_y', 'latex': 'I_y', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in pitch', 'default': 678.0, 'positive': True},
        {'symbol': 'I_z', 'latex': 'I_z', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in yaw', 'default': 1356.0, 'positive': True},
        {'symbol': 'I_wy', 'latex': 'I_{wy}', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the wheel about its axis', 'default': 0.09, 'positive': True},
        {'symbol': 'w0', 'latex': '\\omega_0', 'unit': 'rad/s', 'meaning': 'orbital angular velocity', 'default': 7.26e-05, 'positive': True},
        {'symbol': 'nominal_speed', 'latex': '\\Omega_n', 'unit': 'rad/s', 'meaning': 'nominal speed of the wheel', 'default': 104.71976, 'positive': True},
        {'symbol': 'E', 'latex': 'E', 'unit': '1/s', 'meaning': 'damping parameter; the double pole is at -E', 'default': 0.01, 'positive': True},
        {'symbol': 'P_c', 'latex': 'P_c', 'unit': 'rad', 'meaning': 'pitch angle commanded at time 0', 'default': 0.025, 'positive': True},
    ),
    'control_set': None,
    'has_cost': False,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'conditions': (
        {'terms': (('I_wy', -1.0), ('I_y', 1.0)), 'strict': True, 'reason': 'the wheel has at least as much inertia as the whole satellite, wheel included'},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    theta, theta_dot, wheel_speed = x
    I_x, I_y, I_z, I_wy, w0, nominal_speed, E, P_c = p
    twice_theta_dot = 2.0*theta_dot
    inv_I_wy = 1.0/I_wy
    E_sq = E*E
    w0_sq = w0*w0
    return (
        theta_dot,
        E*(E*P_c - E*theta - twice_theta_dot),
        inv_I_wy*(E_sq*I_y*P_c + 3.0*I_x*theta*w0_sq - E*I_y*twice_theta_dot - E_sq*I_y*theta - 3.0*I_z*theta*w0_sq),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    theta, theta_dot, wheel_speed = x
    I_x, I_y, I_z, I_wy, w0, nominal_speed, E, P_c = p
    E_sq = E*E
    twice_E = 2.0*E
    inv_I_wy = 1.0/I_wy
    w0_sq = w0*w0
    return (
        0.0,
        1.0,
        0.0,
        -E_sq,
        -twice_E,
        0.0,
        inv_I_wy*(3.0*I_x*w0_sq - E_sq*I_y - 3.0*I_z*w0_sq),
        -I_y*inv_I_wy*twice_E,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    theta, theta_dot, wheel_speed = x
    I_x, I_y, I_z, I_wy, w0, nominal_speed, E, P_c = p
    return (
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    I_x, I_y, I_z, I_wy, w0, nominal_speed, E, P_c = p
    theta_at, theta_dot_at, wheel_speed_at = x
    theta_mid, theta_dot_mid, wheel_speed_mid = x_mid
    theta, theta_dot, wheel_speed = x0
    E_P_c = E*P_c
    inv_I_wy = 1.0/I_wy
    w = E*E*I_y
    P_c_w = P_c*w
    w_2 = 3.0*w0*w0
    I_z_w_2 = I_z*w_2
    w_3 = 2.0*E*I_y
    I_x_w_2 = I_x*w_2
    steps = len(times) - 1
    t = times[0]
    theta_at[0] = theta
    theta_dot_at[0] = theta_dot
    wheel_speed_at[0] = wheel_speed
    slope_theta_dot = E*(E_P_c - E*theta - 2.0*theta_dot)
    slope_wheel_speed = inv_I_wy*(I_x_w_2*theta + P_c_w - I_z_w_2*theta - theta*w - theta_dot*w_3)
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        theta_at[i] = theta
        theta_dot_at[i] = theta_dot
        wheel_speed_at[i] = wheel_speed
        half = 0.5*h
        sixth = (1.0/6.0)*h
        theta_2 = half*theta_dot + theta
        theta_dot_2 = half*slope_theta_dot + theta_dot
        k2_theta_dot = E*(E_P_c - E*theta_2 - 2.0*theta_dot_2)
        k2_wheel_speed = inv_I_wy*(I_x_w_2*theta_2 + P_c_w - I_z_w_2*theta_2 - theta_2*w - theta_dot_2*w_3)
        theta_3 = half*theta_dot_2 + theta
        theta_dot_3 = half*k2_theta_dot + theta_dot
        k3_theta_dot = E*(E_P_c - E*theta_3 - 2.0*theta_dot_3)
        k3_wheel_speed = inv_I_wy*(I_x_w_2*theta_3 + P_c_w - I_z_w_2*theta_3 - theta_3*w - theta_dot_3*w_3)
        theta_4 = h*theta_dot_3 + theta
        theta_dot_4 = h*k3_theta_dot + theta_dot
        k4_theta_dot = E*(E_P_c - E*theta_4 - 2.0*theta_dot_4)
        k4_wheel_speed = inv_I_wy*(I_x_w_2*theta_4 + P_c_w - I_z_w_2*theta_4 - theta_4*w - theta_dot_4*w_3)
        k23_theta_dot = k2_theta_dot + k3_theta_dot
        k123_theta_dot = k23_theta_dot + slope_theta_dot
        theta_end = h*(k123_theta_dot*sixth + theta_dot) + theta
        theta_dot_end = sixth*(k123_theta_dot + k23_theta_dot + k4_theta_dot) + theta_dot
        wheel_speed_end = sixth*(k4_wheel_speed + slope_wheel_speed + 2.0*(k2_wheel_speed + k3_wheel_speed)) + wheel_speed
        slope_end_theta_dot = E*(E_P_c - E*theta_end - 2.0*theta_dot_end)
        slope_end_wheel_speed = inv_I_wy*(I_x_w_2*theta_end + P_c_w - I_z_w_2*theta_end - theta_dot_end*w_3 - theta_end*w)
        eighth = 0.125*h
        theta_mid[i] = eighth*(theta_dot - theta_dot_end) + 0.5*(theta + theta_end)
        theta_dot_mid[i] = eighth*(slope_theta_dot - slope_end_theta_dot) + 0.5*(theta_dot + theta_dot_end)
        wheel_speed_mid[i] = eighth*(slope_wheel_speed - slope_end_wheel_speed) + 0.5*(wheel_speed + wheel_speed_end)
        t = t_end
        theta = theta_end
        theta_dot = theta_dot_end
        wheel_speed = wheel_speed_end
        slope_theta_dot = slope_end_theta_dot
        slope_wheel_speed = slope_end_wheel_speed
    theta_at[steps] = theta
    theta_dot_at[steps] = theta_dot
    wheel_speed_at[steps] = wheel_speed


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    theta, theta_dot, wheel_speed = x
    I_x, I_y, I_z, I_wy, w0, nominal_speed, E, P_c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, *p))
    twice_theta_dot = 2.0*theta_dot
    inv_I_wy = 1.0/I_wy
    E_sq = E*E
    w0_sq = w0*w0
    out[0] = theta_dot
    out[1] = E*(E*P_c - E*theta - twice_theta_dot)
    out[2] = inv_I_wy*(E_sq*I_y*P_c + 3.0*I_x*theta*w0_sq - E*I_y*twice_theta_dot - E_sq*I_y*theta - 3.0*I_z*theta*w0_sq)
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    theta, theta_dot, wheel_speed = x
    I_x, I_y, I_z, I_wy, w0, nominal_speed, E, P_c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, 3, *shape), np.result_type(float, t, x, u, *p))
    E_sq = E*E
    twice_E = 2.0*E
    inv_I_wy = 1.0/I_wy
    w0_sq = w0*w0
    out[0, 0] = 0.0
    out[0, 1] = 1.0
    out[0, 2] = 0.0
    out[1, 0] = -E_sq
    out[1, 1] = -twice_E
    out[1, 2] = 0.0
    out[2, 0] = inv_I_wy*(3.0*I_x*w0_sq - E_sq*I_y - 3.0*I_z*w0_sq)
    out[2, 1] = -I_y*inv_I_wy*twice_E
    out[2, 2] = 0.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    theta, theta_dot, wheel_speed = x
    I_x, I_y, I_z, I_wy, w0, nominal_speed, E, P_c = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, 0, *shape), np.result_type(float, t, x, u, *p))
    return out
