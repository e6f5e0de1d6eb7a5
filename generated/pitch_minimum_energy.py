"""Pitch manoeuvre with minimum electrical energy.

Written by satsym from derivations/pitch_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/pitch_wheel.py
Source: ../derivations/pitch_wheel.py 6f132d08f603f74b458d9763f6cace18
Digest: a129c9c492d81bf3a2e7fabe579dd4008415ca44edb3584daadd77f1285c1827
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'pitch_minimum_energy',
    'title': 'Pitch manoeuvre with minimum electrical energy',
    'source': 'derivations/pitch_wheel.py',
    'states': (
        {'symbol': 'theta', 'latex': '\\theta', 'unit': 'rad', 'meaning': 'pitch angle from the local vertical'},
        {'symbol': 'theta_dot', 'latex': '\\dot\\theta', 'unit': 'rad/s', 'meaning': 'rate of the pitch angle'},
    ),
    'controls': (
        {'symbol': 'wheel_torque', 'latex': 'T_w', 'unit': 'N*m', 'meaning': 'wheel inertia times angular acceleration relative to the body'},
    ),
    'parameters': (
        {'symbol': 'I_y', 'latex': 'I_y', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in pitch', 'default': 678.0, 'positive': True},
        {'symbol': 'I_wy', 'latex': 'I_{wy}', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the wheel about its axis', 'default': 0.09, 'positive': True},
        {'symbol': 'nominal_speed', 'latex': '\\Omega_n', 'unit': 'rad/s', 'meaning': 'nominal speed of the wheel', 'default': 104.71976, 'positive': True},
        {'symbol': 'R_a', 'latex': 'R_a', 'unit': 'ohm', 'meaning': 'armature resistance', 'default': 10.0, 'positive': True},
        {'symbol': 'K_t', 'latex': 'K_t', 'unit': 'N*m/A', 'meaning': 'torque constant', 'default': 0.05, 'positive': True},
        {'symbol': 'K_m', 'latex': 'K_m', 'unit': 'rad/V/s', 'meaning': 'speed constant', 'default': 20.0, 'positive': True},
    ),
    'control_set': 'box',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'quantities': (
        {'symbol': 'wheel_speed', 'latex': '\\Omega', 'unit': 'rad/s', 'meaning': 'deviation of the wheel speed from its nominal value'},
        {'symbol': 'motor_torque', 'latex': 'T_m', 'unit': 'N*m', 'meaning': 'torque of the motor between wheel and body'},
        {'symbol': 'current', 'latex': 'i', 'unit': 'A', 'meaning': 'current of the motor'},
        {'symbol': 'voltage', 'latex': 'V', 'unit': 'V', 'meaning': 'voltage across the motor'},
        {'symbol': 'power', 'latex': 'P', 'unit': 'W', 'meaning': 'electrical power of the motor'},
    ),
    'conditions': (
        {'terms': (('I_wy', -1.0), ('I_y', 1.0)), 'strict': True, 'reason': 'the wheel has at least as much inertia as the whole satellite, wheel included'},
    ),
    'objective_unit': 'W*s',
    'linear_quadratic': True,
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    return (
        theta_dot,
        inv_I_y*wheel_torque,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    return (
        0.0,
        1.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    return (
        0.0,
        inv_I_y,
    )


def quantities(t, x, u, p):
    """What is derived along the motion besides."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_I_wy = 1.0/I_wy
    I_y_inv_I_wy_theta_dot = I_y*inv_I_wy*theta_dot
    inv_I_y = 1.0/I_y
    w = wheel_torque - I_wy*inv_I_y*wheel_torque
    inv_K_t = 1.0/K_t
    inv_K_t_w = inv_K_t*w
    inv_K_m = 1.0/K_m
    w_2 = I_y_inv_I_wy_theta_dot*inv_K_m + R_a*inv_K_t_w + inv_K_m*nominal_speed
    return (
        I_y_inv_I_wy_theta_dot,
        w,
        inv_K_t_w,
        w_2,
        inv_K_t_w*w_2,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_K_m = 1.0/K_m
    inv_I_wy = 1.0/I_wy
    inv_K_t = 1.0/K_t
    inv_I_y = 1.0/I_y
    w = inv_K_t*(wheel_torque - I_wy*inv_I_y*wheel_torque)
    return w*(I_y*inv_I_wy*inv_K_m*theta_dot + R_a*w + inv_K_m*nominal_speed)


def terminal_cost(t, x, p):
    """Terminal cost S."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    return (
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_K_t = 1.0/K_t
    I_wy_I_y = I_wy*I_y
    return inv_I_wy*inv_I_y*inv_I_y*inv_K_m*inv_K_t*inv_K_t*wheel_torque*(I_wy - I_y)*(I_wy*I_wy*K_m*R_a*wheel_torque - I_wy_I_y*K_m*R_a*wheel_torque - I_wy_I_y*K_t*nominal_speed - I_y*I_y*K_t*theta_dot) + inv_I_y*lambda_theta_dot*wheel_torque + lambda_theta*theta_dot


def stationarity(t, x, u, lam, p):
    """H_u."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    inv_K_t = 1.0/K_t
    inv_I_wy = 1.0/I_wy
    w = I_wy - I_y
    inv_K_m = 1.0/K_m
    inv_K_m_inv_K_t = inv_K_m*inv_K_t
    w_2 = inv_K_m_inv_K_t*nominal_speed
    w_3 = inv_K_m_inv_K_t*theta_dot
    return (
        I_y*inv_I_wy*w_3 + 2.0*R_a*inv_I_y*inv_I_y*inv_K_t*inv_K_t*w*w*wheel_torque + inv_I_y*lambda_theta_dot + w_2 - I_wy*inv_I_y*w_2 - w_3,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    inv_K_t = 1.0/K_t
    w = I_wy - I_y
    return (
        2.0*R_a*inv_I_y*inv_I_y*inv_K_t*inv_K_t*w*w,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_R_a = 1.0/R_a
    w = I_wy - I_y
    inv_w = 1.0/w
    w_2 = 0.5*I_y*K_t*inv_I_wy*inv_K_m*inv_R_a*inv_w*inv_w*(I_wy*I_wy*nominal_speed + I_wy*I_y*theta_dot - I_wy*I_y*nominal_speed - I_wy*K_m*K_t*lambda_theta_dot - I_y*I_y*theta_dot)
    wheel_torque = wheel_torque_min if w_2 < wheel_torque_min else wheel_torque_max if w_2 > wheel_torque_max else w_2
    return (
        wheel_torque,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_K_t = 1.0/K_t
    return (
        0.0,
        inv_I_wy*inv_K_m*inv_K_t*wheel_torque*(I_wy - I_y) - lambda_theta,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    inv_I_y = 1.0/I_y
    inv_R_a = 1.0/R_a
    w = I_wy - I_y
    inv_w = 1.0/w
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_I_wy_inv_K_m = inv_I_wy*inv_K_m
    w_2 = 0.5*I_y*K_t*inv_I_wy_inv_K_m*inv_R_a*inv_w*inv_w*(I_wy*I_wy*nominal_speed + I_wy*I_y*theta_dot - I_wy*I_y*nominal_speed - I_wy*K_m*K_t*lambda_theta_dot - I_y*I_y*theta_dot)
    w_3 = wheel_torque_min if w_2 < wheel_torque_min else wheel_torque_max if w_2 > wheel_torque_max else w_2
    inv_K_t = 1.0/K_t
    return (
        theta_dot,
        inv_I_y*w_3,
        0.0,
        inv_I_wy_inv_K_m*inv_K_t*w*w_3 - lambda_theta,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    K_t_inv_I_wy_inv_K_m = K_t*inv_I_wy*inv_K_m
    I_wy_I_y = I_wy*I_y
    I_y_sq = I_y*I_y
    w = I_wy_I_y - I_y_sq
    inv_R_a = 1.0/R_a
    w_2 = I_wy - I_y
    inv_w_2 = 1.0/w_2
    w_3 = 0.5*inv_R_a*inv_w_2*inv_w_2
    I_y_K_t_inv_I_wy_inv_K_m = I_y*K_t_inv_I_wy_inv_K_m
    w_4 = I_y_K_t_inv_I_wy_inv_K_m*w_3*(I_wy*I_wy*nominal_speed + I_wy*I_y*theta_dot - I_wy*K_m*K_t*lambda_theta_dot - I_wy_I_y*nominal_speed - I_y_sq*theta_dot)
    w_5 = 0.0 if w_4 < wheel_torque_min else 0.0 if w_4 > wheel_torque_max else 1.0
    w_3_w_5 = w_3*w_5
    w_6 = 0.5*inv_R_a*inv_w_2*w_5
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        K_t_inv_I_wy_inv_K_m*w*w_3_w_5,
        0.0,
        -K_t*K_t*w_3_w_5,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        I_y*inv_I_wy*inv_I_wy*inv_K_m*inv_K_m*w*w_6,
        -1.0,
        -I_y_K_t_inv_I_wy_inv_K_m*w_6,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    inv_I_y = 1.0/I_y
    inv_R_a = 1.0/R_a
    w = I_wy - I_y
    inv_w = 1.0/w
    I_wy_I_y = I_wy*I_y
    I_wy_I_y_nominal_speed = I_wy_I_y*nominal_speed
    w_2 = I_y*I_y*theta_dot
    I_wy_sq = I_wy*I_wy
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_I_wy_inv_K_m = inv_I_wy*inv_K_m
    w_3 = 0.5*I_y*K_t*inv_I_wy_inv_K_m*inv_R_a*inv_w*inv_w*(I_wy*I_y*theta_dot + I_wy_sq*nominal_speed - I_wy*K_m*K_t*lambda_theta_dot - I_wy_I_y_nominal_speed - w_2)
    w_4 = wheel_torque_min if w_3 < wheel_torque_min else wheel_torque_max if w_3 > wheel_torque_max else w_3
    inv_K_t = 1.0/K_t
    return (
        given_theta*(theta - target_theta) + lambda_theta*(1.0 - given_theta - on_reference_theta) + on_reference_theta*theta,
        given_theta_dot*(theta_dot - target_theta_dot) + lambda_theta_dot*(1.0 - given_theta_dot - on_reference_theta_dot) + on_reference_theta_dot*theta_dot,
        inv_I_wy_inv_K_m*inv_I_y*inv_I_y*inv_K_t*inv_K_t*w*w_4*(I_wy_sq*K_m*R_a*w_4 - I_wy_I_y*K_m*R_a*w_4 - I_wy_I_y_nominal_speed*K_t - K_t*w_2) + inv_I_y*lambda_theta_dot*w_4 + lambda_theta*theta_dot,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    w = given_theta + on_reference_theta
    w_2 = given_theta_dot + on_reference_theta_dot
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_K_t = 1.0/K_t
    inv_R_a = 1.0/R_a
    inv_I_wy_inv_K_m = inv_I_wy*inv_K_m
    inv_I_wy_inv_K_m_inv_R_a = inv_I_wy_inv_K_m*inv_R_a
    I_wy_I_y = I_wy*I_y
    I_wy_I_y_nominal_speed = I_wy_I_y*nominal_speed
    I_y_sq = I_y*I_y
    I_y_sq_theta_dot = I_y_sq*theta_dot
    K_t_lambda_theta_dot = K_t*lambda_theta_dot
    I_wy_sq = I_wy*I_wy
    w_3 = I_wy - I_y
    inv_w_3 = 1.0/w_3
    inv_w_3_sq = inv_w_3*inv_w_3
    half_inv_w_3_sq = 0.5*inv_w_3_sq
    w_4 = I_y*K_t*half_inv_w_3_sq*inv_I_wy_inv_K_m_inv_R_a*(I_wy*I_y*theta_dot + I_wy_sq*nominal_speed - I_wy*K_m*K_t_lambda_theta_dot - I_wy_I_y_nominal_speed - I_y_sq_theta_dot)
    w_5 = 0.0 if w_4 < wheel_torque_min else 0.0 if w_4 > wheel_torque_max else 1.0
    w_6 = wheel_torque_min if w_4 < wheel_torque_min else wheel_torque_max if w_4 > wheel_torque_max else w_4
    w_7 = I_wy_I_y - I_y_sq
    half_inv_w_3_sq_w_5 = half_inv_w_3_sq*w_5
    half_inv_w_3_sq_w_5_w_7 = half_inv_w_3_sq_w_5*w_7
    inv_I_y = 1.0/I_y
    w_8 = 0.5*inv_I_y*inv_w_3*w_5*(I_wy_sq*K_m*R_a*w_6 - I_wy_I_y*K_m*R_a*w_6 - I_wy_I_y_nominal_speed*K_t - I_y_sq_theta_dot*K_t)
    I_y_sq_K_t = I_y_sq*K_t
    inv_I_y_sq = inv_I_y*inv_I_y
    inv_K_t_sq = inv_K_t*inv_K_t
    K_t_sq = K_t*K_t
    w_9 = K_t_sq*half_inv_w_3_sq_w_5
    return (
        w,
        0.0,
        1.0 - w,
        0.0,
        0.0,
        0.0,
        w_2,
        0.0,
        1.0 - w_2,
        0.0,
        0.0,
        K_t_lambda_theta_dot*half_inv_w_3_sq_w_5_w_7*inv_I_wy_inv_K_m_inv_R_a + inv_I_wy*inv_I_wy*inv_K_m*inv_K_m*inv_K_t*inv_R_a*w_7*w_8 + inv_I_wy_inv_K_m*inv_I_y_sq*inv_K_t_sq*w_3*w_6*(0.5*I_wy*I_y*K_t*inv_w_3_sq*w_5*w_7 - I_y_sq_K_t*half_inv_w_3_sq_w_5_w_7 - I_y_sq_K_t) + lambda_theta,
        theta_dot,
        inv_I_wy*inv_I_y_sq*inv_K_m*inv_K_t_sq*w_3*w_6*(0.5*I_wy*I_y_sq*K_m*K_t_sq*inv_w_3_sq*w_5 - I_wy_sq*I_y*K_m*w_9) + inv_I_y*w_6 - inv_I_wy_inv_K_m_inv_R_a*w_8 - inv_R_a*lambda_theta_dot*w_9,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    theta_at, theta_dot_at = x
    theta_mid, theta_dot_mid = x_mid
    (wheel_torque_at,) = u
    (wheel_torque_mid,) = u_mid
    theta, theta_dot = x0
    inv_I_y = 1.0/I_y
    inv_K_t = 1.0/K_t
    inv_K_m = 1.0/K_m
    inv_K_m_nominal_speed = inv_K_m*nominal_speed
    R_a_inv_K_t = R_a*inv_K_t
    inv_I_wy = 1.0/I_wy
    I_y_inv_I_wy_inv_K_m = I_y*inv_I_wy*inv_K_m
    I_wy_inv_I_y = I_wy*inv_I_y
    steps = len(times) - 1
    t = times[0]
    theta_at[0] = theta
    theta_dot_at[0] = theta_dot
    wheel_torque = wheel_torque_at[0]
    w = wheel_torque - I_wy_inv_I_y*wheel_torque
    slope_theta_dot = inv_I_y*wheel_torque
    slope_total = inv_K_t*w*(I_y_inv_I_wy_inv_K_m*theta_dot + R_a_inv_K_t*w + inv_K_m_nominal_speed)
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        theta_at[i] = theta
        theta_dot_at[i] = theta_dot
        wheel_torque_half = wheel_torque_mid[i]
        wheel_torque_end = wheel_torque_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        theta_dot_2 = half*slope_theta_dot + theta_dot
        w_2 = wheel_torque_half - I_wy_inv_I_y*wheel_torque_half
        k2_theta_dot = inv_I_y*wheel_torque_half
        k2_total = inv_K_t*w_2*(I_y_inv_I_wy_inv_K_m*theta_dot_2 + R_a_inv_K_t*w_2 + inv_K_m_nominal_speed)
        theta_dot_3 = half*k2_theta_dot + theta_dot
        k3_total = inv_K_t*w_2*(I_y_inv_I_wy_inv_K_m*theta_dot_3 + R_a_inv_K_t*w_2 + inv_K_m_nominal_speed)
        theta_dot_4 = h*k2_theta_dot + theta_dot
        w_3 = wheel_torque_end - I_wy_inv_I_y*wheel_torque_end
        k4_theta_dot = inv_I_y*wheel_torque_end
        k4_total = inv_K_t*w_3*(I_y_inv_I_wy_inv_K_m*theta_dot_4 + R_a_inv_K_t*w_3 + inv_K_m_nominal_speed)
        k23_theta_dot = 2.0*k2_theta_dot
        k123_theta_dot = k23_theta_dot + slope_theta_dot
        theta_end = h*(k123_theta_dot*sixth + theta_dot) + theta
        theta_dot_end = sixth*(k123_theta_dot + k23_theta_dot + k4_theta_dot) + theta_dot
        slope_end_total = inv_K_t*w_3*(I_y_inv_I_wy_inv_K_m*theta_dot_end + R_a_inv_K_t*w_3 + inv_K_m_nominal_speed)
        eighth = 0.125*h
        theta_mid[i] = eighth*(theta_dot - theta_dot_end) + 0.5*(theta + theta_end)
        theta_dot_mid[i] = eighth*(slope_theta_dot - k4_theta_dot) + 0.5*(theta_dot + theta_dot_end)
        total = sixth*(k4_total + slope_total + 2.0*(k2_total + k3_total)) + total
        t = t_end
        theta = theta_end
        theta_dot = theta_dot_end
        slope_theta_dot = k4_theta_dot
        slope_total = slope_end_total
    theta_at[steps] = theta
    theta_dot_at[steps] = theta_dot
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    lambda_theta_at, lambda_theta_dot_at = lam
    lambda_theta_mid, lambda_theta_dot_mid = lam_mid
    theta_at, theta_dot_at = x
    (wheel_torque_at,) = u
    theta_mid, theta_dot_mid = x_mid
    (wheel_torque_mid,) = u_mid
    lambda_theta, lambda_theta_dot = lam_f
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_K_t = 1.0/K_t
    w = inv_I_wy*inv_K_m*inv_K_t*(I_wy - I_y)
    steps = len(times) - 1
    t = times[steps]
    lambda_theta_at[steps] = lambda_theta
    lambda_theta_dot_at[steps] = lambda_theta_dot
    wheel_torque = wheel_torque_at[steps]
    w_wheel_torque = w*wheel_torque
    slope_lambda_theta_dot = w_wheel_torque - lambda_theta
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        wheel_torque_half = wheel_torque_mid[i]
        wheel_torque_end = wheel_torque_at[i]
        sixth = (1.0/6.0)*h
        w_wheel_torque_half = w*wheel_torque_half
        k2_lambda_theta_dot = w_wheel_torque_half - lambda_theta
        w_wheel_torque_end = w*wheel_torque_end
        k4_lambda_theta_dot = w_wheel_torque_end - lambda_theta
        lambda_theta_dot_end = lambda_theta_dot + sixth*(4.0*k2_lambda_theta_dot + k4_lambda_theta_dot + slope_lambda_theta_dot)
        eighth = 0.125*h
        lambda_theta_mid[i] = lambda_theta
        lambda_theta_at[i] = lambda_theta
        lambda_theta_dot_mid[i] = eighth*(slope_lambda_theta_dot - k4_lambda_theta_dot) + 0.5*(lambda_theta_dot + lambda_theta_dot_end)
        lambda_theta_dot_at[i] = lambda_theta_dot_end
        t = t_end
        lambda_theta_dot = lambda_theta_dot_end
        slope_lambda_theta_dot = k4_lambda_theta_dot


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    inv_I_y = 1.0/I_y
    out[0] = theta_dot
    out[1] = inv_I_y*wheel_torque
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[0, 1] = 1.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    inv_I_y = 1.0/I_y
    out[0, 0] = 0.0
    out[1, 0] = inv_I_y
    return out


def quantities_batch(t, x, u, p, out=None):
    """What is derived along the motion besides. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, u, *p))
    inv_I_wy = 1.0/I_wy
    I_y_inv_I_wy_theta_dot = I_y*inv_I_wy*theta_dot
    inv_I_y = 1.0/I_y
    w = wheel_torque - I_wy*inv_I_y*wheel_torque
    inv_K_t = 1.0/K_t
    inv_K_t_w = inv_K_t*w
    inv_K_m = 1.0/K_m
    w_2 = I_y_inv_I_wy_theta_dot*inv_K_m + R_a*inv_K_t_w + inv_K_m*nominal_speed
    out[0] = I_y_inv_I_wy_theta_dot
    out[1] = w
    out[2] = inv_K_t_w
    out[3] = w_2
    out[4] = inv_K_t_w*w_2
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    inv_K_m = 1.0/K_m
    inv_I_wy = 1.0/I_wy
    inv_K_t = 1.0/K_t
    inv_I_y = 1.0/I_y
    w = inv_K_t*(wheel_torque - I_wy*inv_I_y*wheel_torque)
    out[...] = w*(I_y*inv_I_wy*inv_K_m*theta_dot + R_a*w + inv_K_m*nominal_speed)
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    inv_I_y = 1.0/I_y
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_K_t = 1.0/K_t
    I_wy_I_y = I_wy*I_y
    out[...] = inv_I_wy*inv_I_y*inv_I_y*inv_K_m*inv_K_t*inv_K_t*wheel_torque*(I_wy - I_y)*(I_wy*I_wy*K_m*R_a*wheel_torque - I_wy_I_y*K_m*R_a*wheel_torque - I_wy_I_y*K_t*nominal_speed - I_y*I_y*K_t*theta_dot) + inv_I_y*lambda_theta_dot*wheel_torque + lambda_theta*theta_dot
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_I_y = 1.0/I_y
    inv_K_t = 1.0/K_t
    inv_I_wy = 1.0/I_wy
    w = I_wy - I_y
    inv_K_m = 1.0/K_m
    inv_K_m_inv_K_t = inv_K_m*inv_K_t
    w_2 = inv_K_m_inv_K_t*nominal_speed
    w_3 = inv_K_m_inv_K_t*theta_dot
    out[0] = I_y*inv_I_wy*w_3 + 2.0*R_a*inv_I_y*inv_I_y*inv_K_t*inv_K_t*w*w*wheel_torque + inv_I_y*lambda_theta_dot + w_2 - I_wy*inv_I_y*w_2 - w_3
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_I_y = 1.0/I_y
    inv_K_t = 1.0/K_t
    w = I_wy - I_y
    out[0, 0] = 2.0*R_a*inv_I_y*inv_I_y*inv_K_t*inv_K_t*w*w
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_R_a = 1.0/R_a
    w = I_wy - I_y
    inv_w = 1.0/w
    w_2 = 0.5*I_y*K_t*inv_I_wy*inv_K_m*inv_R_a*inv_w*inv_w*(I_wy*I_wy*nominal_speed + I_wy*I_y*theta_dot - I_wy*I_y*nominal_speed - I_wy*K_m*K_t*lambda_theta_dot - I_y*I_y*theta_dot)
    wheel_torque = np.minimum(np.maximum(w_2, wheel_torque_min), wheel_torque_max)
    out[0] = wheel_torque
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_K_t = 1.0/K_t
    out[0] = 0.0
    out[1] = inv_I_wy*inv_K_m*inv_K_t*wheel_torque*(I_wy - I_y) - lambda_theta
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_I_y = 1.0/I_y
    inv_R_a = 1.0/R_a
    w = I_wy - I_y
    inv_w = 1.0/w
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_I_wy_inv_K_m = inv_I_wy*inv_K_m
    w_2 = 0.5*I_y*K_t*inv_I_wy_inv_K_m*inv_R_a*inv_w*inv_w*(I_wy*I_wy*nominal_speed + I_wy*I_y*theta_dot - I_wy*I_y*nominal_speed - I_wy*K_m*K_t*lambda_theta_dot - I_y*I_y*theta_dot)
    w_3 = np.minimum(np.maximum(w_2, wheel_torque_min), wheel_torque_max)
    inv_K_t = 1.0/K_t
    out[0] = theta_dot
    out[1] = inv_I_y*w_3
    out[2] = 0.0
    out[3] = inv_I_wy_inv_K_m*inv_K_t*w*w_3 - lambda_theta
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    K_t_inv_I_wy_inv_K_m = K_t*inv_I_wy*inv_K_m
    I_wy_I_y = I_wy*I_y
    I_y_sq = I_y*I_y
    w = I_wy_I_y - I_y_sq
    inv_R_a = 1.0/R_a
    w_2 = I_wy - I_y
    inv_w_2 = 1.0/w_2
    w_3 = 0.5*inv_R_a*inv_w_2*inv_w_2
    I_y_K_t_inv_I_wy_inv_K_m = I_y*K_t_inv_I_wy_inv_K_m
    w_4 = I_y_K_t_inv_I_wy_inv_K_m*w_3*(I_wy*I_wy*nominal_speed + I_wy*I_y*theta_dot - I_wy*K_m*K_t*lambda_theta_dot - I_wy_I_y*nominal_speed - I_y_sq*theta_dot)
    w_5 = np.heaviside(w_4 - wheel_torque_min, 1.0)*np.heaviside(wheel_torque_max - w_4, 1.0)
    w_3_w_5 = w_3*w_5
    w_6 = 0.5*inv_R_a*inv_w_2*w_5
    out[0, 1] = 1.0
    out[1, 1] = K_t_inv_I_wy_inv_K_m*w*w_3_w_5
    out[1, 3] = -K_t*K_t*w_3_w_5
    out[3, 1] = I_y*inv_I_wy*inv_I_wy*inv_K_m*inv_K_m*w*w_6
    out[3, 2] = -1.0
    out[3, 3] = -I_y_K_t_inv_I_wy_inv_K_m*w_6
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    inv_I_y = 1.0/I_y
    inv_R_a = 1.0/R_a
    w = I_wy - I_y
    inv_w = 1.0/w
    I_wy_I_y = I_wy*I_y
    I_wy_I_y_nominal_speed = I_wy_I_y*nominal_speed
    w_2 = I_y*I_y*theta_dot
    I_wy_sq = I_wy*I_wy
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_I_wy_inv_K_m = inv_I_wy*inv_K_m
    w_3 = 0.5*I_y*K_t*inv_I_wy_inv_K_m*inv_R_a*inv_w*inv_w*(I_wy*I_y*theta_dot + I_wy_sq*nominal_speed - I_wy*K_m*K_t*lambda_theta_dot - I_wy_I_y_nominal_speed - w_2)
    w_4 = np.minimum(np.maximum(w_3, wheel_torque_min), wheel_torque_max)
    inv_K_t = 1.0/K_t
    out[0] = given_theta*(theta - target_theta) + lambda_theta*(1.0 - given_theta - on_reference_theta) + on_reference_theta*theta
    out[1] = given_theta_dot*(theta_dot - target_theta_dot) + lambda_theta_dot*(1.0 - given_theta_dot - on_reference_theta_dot) + on_reference_theta_dot*theta_dot
    out[2] = inv_I_wy_inv_K_m*inv_I_y*inv_I_y*inv_K_t*inv_K_t*w*w_4*(I_wy_sq*K_m*R_a*w_4 - I_wy_I_y*K_m*R_a*w_4 - I_wy_I_y_nominal_speed*K_t - K_t*w_2) + inv_I_y*lambda_theta_dot*w_4 + lambda_theta*theta_dot
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_theta + on_reference_theta
    w_2 = given_theta_dot + on_reference_theta_dot
    inv_I_wy = 1.0/I_wy
    inv_K_m = 1.0/K_m
    inv_K_t = 1.0/K_t
    inv_R_a = 1.0/R_a
    inv_I_wy_inv_K_m = inv_I_wy*inv_K_m
    inv_I_wy_inv_K_m_inv_R_a = inv_I_wy_inv_K_m*inv_R_a
    I_wy_I_y = I_wy*I_y
    I_wy_I_y_nominal_speed = I_wy_I_y*nominal_speed
    I_y_sq = I_y*I_y
    I_y_sq_theta_dot = I_y_sq*theta_dot
    K_t_lambda_theta_dot = K_t*lambda_theta_dot
    I_wy_sq = I_wy*I_wy
    w_3 = I_wy - I_y
    inv_w_3 = 1.0/w_3
    inv_w_3_sq = inv_w_3*inv_w_3
    half_inv_w_3_sq = 0.5*inv_w_3_sq
    w_4 = I_y*K_t*half_inv_w_3_sq*inv_I_wy_inv_K_m_inv_R_a*(I_wy*I_y*theta_dot + I_wy_sq*nominal_speed - I_wy*K_m*K_t_lambda_theta_dot - I_wy_I_y_nominal_speed - I_y_sq_theta_dot)
    w_5 = np.heaviside(w_4 - wheel_torque_min, 1.0)*np.heaviside(wheel_torque_max - w_4, 1.0)
    w_6 = np.minimum(np.maximum(w_4, wheel_torque_min), wheel_torque_max)
    w_7 = I_wy_I_y - I_y_sq
    half_inv_w_3_sq_w_5 = half_inv_w_3_sq*w_5
    half_inv_w_3_sq_w_5_w_7 = half_inv_w_3_sq_w_5*w_7
    inv_I_y = 1.0/I_y
    w_8 = 0.5*inv_I_y*inv_w_3*w_5*(I_wy_sq*K_m*R_a*w_6 - I_wy_I_y*K_m*R_a*w_6 - I_wy_I_y_nominal_speed*K_t - I_y_sq_theta_dot*K_t)
    I_y_sq_K_t = I_y_sq*K_t
    inv_I_y_sq = inv_I_y*inv_I_y
    inv_K_t_sq = inv_K_t*inv_K_t
    K_t_sq = K_t*K_t
    w_9 = K_t_sq*half_inv_w_3_sq_w_5
    out[0, 0] = w
    out[0, 2] = 1.0 - w
    out[1, 1] = w_2
    out[1, 3] = 1.0 - w_2
    out[2, 1] = K_t_lambda_theta_dot*half_inv_w_3_sq_w_5_w_7*inv_I_wy_inv_K_m_inv_R_a + inv_I_wy*inv_I_wy*inv_K_m*inv_K_m*inv_K_t*inv_R_a*w_7*w_8 + inv_I_wy_inv_K_m*inv_I_y_sq*inv_K_t_sq*w_3*w_6*(0.5*I_wy*I_y*K_t*inv_w_3_sq*w_5*w_7 - I_y_sq_K_t*half_inv_w_3_sq_w_5_w_7 - I_y_sq_K_t) + lambda_theta
    out[2, 2] = theta_dot
    out[2, 3] = inv_I_wy*inv_I_y_sq*inv_K_m*inv_K_t_sq*w_3*w_6*(0.5*I_wy*I_y_sq*K_m*K_t_sq*inv_w_3_sq*w_5 - I_wy_sq*I_y*K_m*w_9) + inv_I_y*w_6 - inv_I_wy_inv_K_m_inv_R_a*w_8 - inv_R_a*lambda_theta_dot*w_9
    return out
