"""Pitch axis of a satellite with a reaction wheel.

Written by satsym from derivations/pitch_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/pitch_wheel.py
Source: ../derivations/pitch_wheel.py 6f132d08f603f74b458d9763f6cace18
Digest: cd07b723324ced55009f6b8fbacbb2f6843a53e63e21d6c5f199c1fc8a102503
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'pitch_wheel',
    'title': 'Pitch axis of a satellite with a reaction wheel',
    'source': 'derivations/pitch_wheel.py',
    'states': (
        {'symbol': 'theta', 'latex': '\\theta', 'unit': 'rad', 'meaning': 'pitch angle from the local vertical'},
        {'symbol': 'theta_dot', 'latex': '\\dot\\theta', 'unit': 'rad/s', 'meaning': 'rate of the pitch angle'},
        {'symbol': 'wheel_speed', 'latex': '\\Omega', 'unit': 'rad/s', 'meaning': 'deviation of the wheel speed from its nominal value'},
    ),
    'controls': (
        {'symbol': 'wheel_torque', 'latex': 'T_w', 'unit': 'N*m', 'meaning': 'wheel inertia times angular acceleration relative to the body'},
    ),
    'parameters': (
        {'symbol': 'I_x', 'latex': 'I_x', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in roll', 'default': 1356.0, 'positive': True},
        {'symbol': 'I_y', 'latex': 'I_y', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in pitch', 'default': 678.0, 'positive': True},
        {'symbol': 'I_z', 'latex': 'I_z', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in yaw', 'default': 1356.0, 'positive': True},
        {'symbol': 'I_wy', 'latex': 'I_{wy}', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the wheel about its axis', 'default': 0.09, 'positive': True},
        {'symbol': 'w0', 'latex': '\\omega_0', 'unit': 'rad/s', 'meaning': 'orbital angular velocity', 'default': 7.26e-05, 'positive': True},
        {'symbol': 'nominal_speed', 'latex': '\\Omega_n', 'unit': 'rad/s', 'meaning': 'nominal speed of the wheel', 'default': 104.71976, 'positive': True},
        {'symbol': 'R_a', 'latex': 'R_a', 'unit': 'ohm', 'meaning': 'armature resistance', 'default': 10.0, 'positive': True},
        {'symbol': 'K_t', 'latex': 'K_t', 'unit': 'N*m/A', 'meaning': 'torque constant', 'default': 0.05, 'positive': True},
        {'symbol': 'K_m', 'latex': 'K_m', 'unit': 'rad/V/s', 'meaning': 'speed constant', 'default': 20.0, 'positive': True},
    ),
    'control_set': None,
    'has_cost': False,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'quantities': (
        {'symbol': 'motor_torque', 'latex': 'T_m', 'unit': 'N*m', 'meaning': 'torque of the motor between wheel and body'},
        {'symbol': 'current', 'latex': 'i', 'unit': 'A', 'meaning': 'current of the motor'},
        {'symbol': 'voltage', 'latex': 'V', 'unit': 'V', 'meaning': 'voltage across the motor'},
        {'symbol': 'power', 'latex': 'P', 'unit': 'W', 'meaning': 'electrical power of the motor'},
    ),
    'balances': (
        {'symbol': 'angular_momentum', 'latex': '\\ell'},
    ),
    'conditions': (
        {'terms': (('I_wy', -1.0), ('I_y', 1.0)), 'strict': True, 'reason': 'the wheel has at least as much inertia as the whole satellite, wheel included'},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    inv_I_wy = 1.0/I_wy
    return (
        theta_dot,
        3.0*inv_I_y*w0*w0*(I_z - I_x)*math.sin(theta)*math.cos(theta) + inv_I_y*wheel_torque,
        inv_I_wy*wheel_torque,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    sin_theta = math.sin(theta)
    cos_theta = math.cos(theta)
    return (
        0.0,
        1.0,
        0.0,
        -3.0*inv_I_y*w0*w0*(I_x - I_z)*(cos_theta - sin_theta)*(cos_theta + sin_theta),
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    inv_I_wy = 1.0/I_wy
    return (
        0.0,
        inv_I_y,
        inv_I_wy,
    )


def quantities(t, x, u, p):
    """What is derived along the motion besides."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    I_wy_inv_I_y = I_wy*inv_I_y
    w = 3.0*I_wy_inv_I_y*w0*w0*(I_x - I_z)*math.sin(theta)*math.cos(theta) + wheel_torque*(1.0 - I_wy_inv_I_y)
    inv_K_t = 1.0/K_t
    inv_K_t_w = inv_K_t*w
    inv_K_m = 1.0/K_m
    w_2 = R_a*inv_K_t_w + inv_K_m*(nominal_speed + wheel_speed)
    return (
        w,
        inv_K_t_w,
        w_2,
        inv_K_t_w*w_2,
    )


def balances(t, x, u, p):
    """What changes only from outside, each with its rate of change."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    return (
        I_y*theta_dot - I_wy*nominal_speed - I_wy*wheel_speed - I_y*w0,
        3.0*w0*w0*(I_z - I_x)*math.sin(theta)*math.cos(theta),
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    theta_at, theta_dot_at, wheel_speed_at = x
    theta_mid, theta_dot_mid, wheel_speed_mid = x_mid
    (wheel_torque_at,) = u
    (wheel_torque_mid,) = u_mid
    theta, theta_dot, wheel_speed = x0
    inv_I_y = 1.0/I_y
    w = 3.0*inv_I_y*w0*w0*(I_z - I_x)
    inv_I_wy = 1.0/I_wy
    steps = len(times) - 1
    t = times[0]
    theta_at[0] = theta
    theta_dot_at[0] = theta_dot
    wheel_speed_at[0] = wheel_speed
    wheel_torque = wheel_torque_at[0]
    slope_theta_dot = inv_I_y*wheel_torque + w*math.sin(theta)*math.cos(theta)
    slope_wheel_speed = inv_I_wy*wheel_torque
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        theta_at[i] = theta
        theta_dot_at[i] = theta_dot
        wheel_speed_at[i] = wheel_speed
        wheel_torque_half = wheel_torque_mid[i]
        wheel_torque_end = wheel_torque_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        theta_2 = half*theta_dot + theta
        theta_dot_2 = half*slope_theta_dot + theta_dot
        k2_theta_dot = inv_I_y*wheel_torque_half + w*math.sin(theta_2)*math.cos(theta_2)
        k2_wheel_speed = inv_I_wy*wheel_torque_half
        theta_3 = half*theta_dot_2 + theta
        theta_dot_3 = half*k2_theta_dot + theta_dot
        k3_theta_dot = inv_I_y*wheel_torque_half + w*math.sin(theta_3)*math.cos(theta_3)
        theta_4 = h*theta_dot_3 + theta
        k4_theta_dot = inv_I_y*wheel_torque_end + w*math.sin(theta_4)*math.cos(theta_4)
        k4_wheel_speed = inv_I_wy*wheel_torque_end
        k23_theta_dot = k2_theta_dot + k3_theta_dot
        k123_theta_dot = k23_theta_dot + slope_theta_dot
        theta_end = h*(k123_theta_dot*sixth + theta_dot) + theta
        theta_dot_end = sixth*(k123_theta_dot + k23_theta_dot + k4_theta_dot) + theta_dot
        wheel_speed_end = sixth*(4.0*k2_wheel_speed + k4_wheel_speed + slope_wheel_speed) + wheel_speed
        slope_end_theta_dot = inv_I_y*wheel_torque_end + w*math.sin(theta_end)*math.cos(theta_end)
        eighth = 0.125*h
        theta_mid[i] = eighth*(theta_dot - theta_dot_end) + 0.5*(theta + theta_end)
        theta_dot_mid[i] = eighth*(slope_theta_dot - slope_end_theta_dot) + 0.5*(theta_dot + theta_dot_end)
        wheel_speed_mid[i] = eighth*(slope_wheel_speed - k4_wheel_speed) + 0.5*(wheel_speed + wheel_speed_end)
        t = t_end
        theta = theta_end
        theta_dot = theta_dot_end
        wheel_speed = wheel_speed_end
        slope_theta_dot = slope_end_theta_dot
        slope_wheel_speed = k4_wheel_speed
    theta_at[steps] = theta
    theta_dot_at[steps] = theta_dot
    wheel_speed_at[steps] = wheel_speed


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, *p))
    inv_I_y = 1.0/I_y
    inv_I_wy = 1.0/I_wy
    out[0] = theta_dot
    out[1] = 3.0*inv_I_y*w0*w0*(I_z - I_x)*np.sin(theta)*np.cos(theta) + inv_I_y*wheel_torque
    out[2] = inv_I_wy*wheel_torque
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 3, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_I_y = 1.0/I_y
    sin_theta = np.sin(theta)
    cos_theta = np.cos(theta)
    out[0, 1] = 1.0
    out[1, 0] = -3.0*inv_I_y*w0*w0*(I_x - I_z)*(cos_theta - sin_theta)*(cos_theta + sin_theta)
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 1, *shape), np.result_type(float, t, x, u, *p))
    inv_I_y = 1.0/I_y
    inv_I_wy = 1.0/I_wy
    out[0, 0] = 0.0
    out[1, 0] = inv_I_y
    out[2, 0] = inv_I_wy
    return out


def quantities_batch(t, x, u, p, out=None):
    """What is derived along the motion besides. Batch form."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))
    inv_I_y = 1.0/I_y
    I_wy_inv_I_y = I_wy*inv_I_y
    w = 3.0*I_wy_inv_I_y*w0*w0*(I_x - I_z)*np.sin(theta)*np.cos(theta) + wheel_torque*(1.0 - I_wy_inv_I_y)
    inv_K_t = 1.0/K_t
    inv_K_t_w = inv_K_t*w
    inv_K_m = 1.0/K_m
    w_2 = R_a*inv_K_t_w + inv_K_m*(nominal_speed + wheel_speed)
    out[0] = w
    out[1] = inv_K_t_w
    out[2] = w_2
    out[3] = inv_K_t_w*w_2
    return out


def balances_batch(t, x, u, p, out=None):
    """What changes only from outside, each with its rate of change. Batch form."""
    theta, theta_dot, wheel_speed = x
    (wheel_torque,) = u
    I_x, I_y, I_z, I_wy, w0, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    out[0] = I_y*theta_dot - I_wy*nominal_speed - I_wy*wheel_speed - I_y*w0
    out[1] = 3.0*w0*w0*(I_z - I_x)*np.sin(theta)*np.cos(theta)
    return out
