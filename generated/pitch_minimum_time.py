"""Minimum-time pitch manoeuvre.

Written by satsym from derivations/pitch_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/pitch_wheel.py
Source: ../derivations/pitch_wheel.py 6f132d08f603f74b458d9763f6cace18
Digest: 2f1498a28ad78d2ac17c522d3fc16e17fbc57778068b56437d60ccd2d3288e86
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'pitch_minimum_time',
    'title': 'Minimum-time pitch manoeuvre',
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
    'switching': True,
    'quantities': (
        {'symbol': 'wheel_speed', 'latex': '\\Omega', 'unit': 'rad/s', 'meaning': 'deviation of the wheel speed from its nominal value'},
        {'symbol': 'motor_torque', 'latex': 'T_m', 'unit': 'N*m', 'meaning': 'torque of the motor between wheel and body'},
        {'symbol': 'current', 'latex': 'i', 'unit': 'A', 'meaning': 'current of the motor'},
        {'symbol': 'voltage', 'latex': 'V', 'unit': 'V', 'meaning': 'voltage across the motor'},
        {'symbol': 'power', 'latex': 'P', 'unit': 'W', 'meaning': 'electrical power of the motor'},
    ),
    'switching_curve': (
        'theta',
        'theta_dot',
    ),
    'conditions': (
        {'terms': (('I_wy', -1.0), ('I_y', 1.0)), 'strict': True, 'reason': 'the wheel has at least as much inertia as the whole satellite, wheel included'},
    ),
    'objective_unit': 's',
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
    return 1.0


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
    return inv_I_y*lambda_theta_dot*wheel_torque + lambda_theta*theta_dot + 1.0


def switching_function(t, x, lam, p):
    """What multiplies each control in H."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    return (
        inv_I_y*lambda_theta_dot,
    )


def switching_rate(t, x, u, lam, p):
    """Its rates of change along an extremal."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    inv_I_y = 1.0/I_y
    return (
        -inv_I_y*lambda_theta,
    )


def magnitude_weight(t, x, lam, p):
    """What multiplies each |u| in H."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    return (
        0.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the box."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    inv_I_y = 1.0/I_y
    inv_I_y_lambda_theta_dot = inv_I_y*lambda_theta_dot
    wheel_torque = wheel_torque_min if inv_I_y_lambda_theta_dot > 0.0 else wheel_torque_max if inv_I_y_lambda_theta_dot < 0.0 else 0.5*(wheel_torque_min + wheel_torque_max)
    return (
        wheel_torque,
    )


def extremal_jacobian(t, x, u, lam, p):
    """Rates of states and costates by states and costates, row by row, the controls being held."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    return (
        0.0,
        1.0,
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
        0.0,
        -1.0,
        0.0,
    )


def beyond_switching_curve(t, x, p, bounds, final):
    """How far the position lies beyond the switching curve of least time."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    inv_wheel_torque_max = 1.0/wheel_torque_max
    inv_wheel_torque_min = 1.0/wheel_torque_min
    w = target_theta_dot - theta_dot
    Abs_w = math.fabs(w)
    return theta - 0.25*I_y*(target_theta_dot + theta_dot)*(-Abs_w*(inv_wheel_torque_max - inv_wheel_torque_min) - w*(inv_wheel_torque_max + inv_wheel_torque_min)) - target_theta


def feedback_law(t, x, p, bounds, final):
    """The controls of least time, by the side of the switching curve."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    w = target_theta_dot - theta_dot
    Abs_w = math.fabs(w)
    inv_wheel_torque_max = 1.0/wheel_torque_max
    inv_wheel_torque_min = 1.0/wheel_torque_min
    w_2 = inv_wheel_torque_max - inv_wheel_torque_min
    w_3 = -w
    w_4 = -w_3*(inv_wheel_torque_max + inv_wheel_torque_min)
    w_5 = 0.25*I_y*(target_theta_dot + theta_dot)
    w_6 = target_theta - theta
    w_7 = -w_5*(-Abs_w*w_2 - w_4) - w_6
    w_8 = 1.0 if w_7 > 0.0 else -1.0 if w_7 < 0.0 else 0.0
    w_9 = 1.0 if w_3 > 0.0 else -1.0 if w_3 < 0.0 else 0.0
    w_10 = w_8 + w_9*(1.0 - w_8*w_8)
    wheel_torque = wheel_torque_min if w_10 > 0.0 else wheel_torque_max if w_10 < 0.0 else 0.5*(wheel_torque_min + wheel_torque_max)
    return (
        wheel_torque,
    )


def transition_time(t, x, p, bounds, final):
    """How long the change of position takes from rest to rest."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    inv_wheel_torque_min = 1.0/wheel_torque_min
    inv_wheel_torque_max = 1.0/wheel_torque_max
    w = 2.0*I_y*inv_wheel_torque_max - 2.0*I_y*inv_wheel_torque_min
    sqrt_w = math.sqrt(w)
    w_2 = target_theta - theta
    Abs_w_2 = math.fabs(w_2)
    sqrt_Abs_w_2 = math.sqrt(Abs_w_2)
    return sqrt_Abs_w_2*sqrt_w


def first_arc_time(t, x, p, bounds, final):
    """How long the first arc of it takes."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    inv_wheel_torque_min = 1.0/wheel_torque_min
    inv_wheel_torque_max = 1.0/wheel_torque_max
    w = 2.0*I_y*inv_wheel_torque_max - 2.0*I_y*inv_wheel_torque_min
    sqrt_w = math.sqrt(w)
    w_2 = target_theta - theta
    Abs_w_2 = math.fabs(w_2)
    sqrt_Abs_w_2 = math.sqrt(Abs_w_2)
    w_3 = wheel_torque_max - wheel_torque_min
    inv_w_3 = 1.0/w_3
    w_4 = 1.0 if w_2 > 0.0 else -1.0 if w_2 < 0.0 else 0.0
    return sqrt_Abs_w_2*sqrt_w*(0.5 - 0.5*inv_w_3*w_4*(wheel_torque_max + wheel_torque_min))


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    return (
        0.0,
        -lambda_theta,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    inv_I_y = 1.0/I_y
    inv_smoothing = 1.0/smoothing
    w = -inv_I_y*inv_smoothing*lambda_theta_dot
    w_2 = wheel_torque_min if w < wheel_torque_min else wheel_torque_max if w > wheel_torque_max else w
    return (
        theta_dot,
        inv_I_y*w_2,
        0.0,
        -lambda_theta,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    inv_I_y = 1.0/I_y
    inv_smoothing = 1.0/smoothing
    w = -inv_I_y*inv_smoothing*lambda_theta_dot
    w_2 = 0.0 if w < wheel_torque_min else 0.0 if w > wheel_torque_max else 1.0
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_I_y*inv_I_y*inv_smoothing*w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
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
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    inv_smoothing = 1.0/smoothing
    inv_I_y = 1.0/I_y
    inv_I_y_lambda_theta_dot = inv_I_y*lambda_theta_dot
    w = -inv_I_y_lambda_theta_dot*inv_smoothing
    w_2 = wheel_torque_min if w < wheel_torque_min else wheel_torque_max if w > wheel_torque_max else w
    return (
        given_theta*(theta - target_theta) + lambda_theta*(1.0 - given_theta - on_reference_theta) + on_reference_theta*theta,
        given_theta_dot*(theta_dot - target_theta_dot) + lambda_theta_dot*(1.0 - given_theta_dot - on_reference_theta_dot) + on_reference_theta_dot*theta_dot,
        inv_I_y_lambda_theta_dot*w_2 + lambda_theta*theta_dot + 0.5*smoothing*w_2*w_2 + 1.0,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    w = given_theta + on_reference_theta
    w_2 = given_theta_dot + on_reference_theta_dot
    inv_I_y = 1.0/I_y
    inv_smoothing = 1.0/smoothing
    w_3 = inv_smoothing*lambda_theta_dot
    w_4 = -inv_I_y*w_3
    w_5 = wheel_torque_min if w_4 < wheel_torque_min else wheel_torque_max if w_4 > wheel_torque_max else w_4
    w_6 = 0.0 if w_4 < wheel_torque_min else 0.0 if w_4 > wheel_torque_max else 1.0
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
        lambda_theta,
        theta_dot,
        inv_I_y*w_5 - inv_I_y*inv_I_y*w_3*w_6 - inv_I_y*w_5*w_6,
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
    steps = len(times) - 1
    t = times[0]
    theta_at[0] = theta
    theta_dot_at[0] = theta_dot
    wheel_torque = wheel_torque_at[0]
    slope_theta_dot = inv_I_y*wheel_torque
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        theta_at[i] = theta
        theta_dot_at[i] = theta_dot
        wheel_torque_half = wheel_torque_mid[i]
        wheel_torque_end = wheel_torque_at[i + 1]
        sixth = (1.0/6.0)*h
        k2_theta_dot = inv_I_y*wheel_torque_half
        k4_theta_dot = inv_I_y*wheel_torque_end
        k23_theta_dot = 2.0*k2_theta_dot
        k123_theta_dot = k23_theta_dot + slope_theta_dot
        theta_end = h*(k123_theta_dot*sixth + theta_dot) + theta
        theta_dot_end = sixth*(k123_theta_dot + k23_theta_dot + k4_theta_dot) + theta_dot
        eighth = 0.125*h
        theta_mid[i] = eighth*(theta_dot - theta_dot_end) + 0.5*(theta + theta_end)
        theta_dot_mid[i] = eighth*(slope_theta_dot - k4_theta_dot) + 0.5*(theta_dot + theta_dot_end)
        total = 6.0*sixth + total
        t = t_end
        theta = theta_end
        theta_dot = theta_dot_end
        slope_theta_dot = k4_theta_dot
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
    steps = len(times) - 1
    t = times[steps]
    lambda_theta_at[steps] = lambda_theta
    lambda_theta_dot_at[steps] = lambda_theta_dot
    slope_lambda_theta_dot = -lambda_theta
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        sixth = (1.0/6.0)*h
        k2_lambda_theta_dot = -lambda_theta
        lambda_theta_dot_end = lambda_theta_dot + sixth*(5.0*k2_lambda_theta_dot + slope_lambda_theta_dot)
        eighth = 0.125*h
        lambda_theta_mid[i] = lambda_theta
        lambda_theta_at[i] = lambda_theta
        lambda_theta_dot_mid[i] = eighth*(slope_lambda_theta_dot - k2_lambda_theta_dot) + 0.5*(lambda_theta_dot + lambda_theta_dot_end)
        lambda_theta_dot_at[i] = lambda_theta_dot_end
        t = t_end
        lambda_theta_dot = lambda_theta_dot_end
        slope_lambda_theta_dot = k2_lambda_theta_dot


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
    out[...] = 1.0
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
    out[...] = inv_I_y*lambda_theta_dot*wheel_torque + lambda_theta*theta_dot + 1.0
    return out


def switching_function_batch(t, x, lam, p, out=None):
    """What multiplies each control in H. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p))
    inv_I_y = 1.0/I_y
    out[0] = inv_I_y*lambda_theta_dot
    return out


def switching_rate_batch(t, x, u, lam, p, out=None):
    """Its rates of change along an extremal. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_I_y = 1.0/I_y
    out[0] = -inv_I_y*lambda_theta
    return out


def magnitude_weight_batch(t, x, lam, p, out=None):
    """What multiplies each |u| in H. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p))
    out[0] = 0.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the box. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_I_y = 1.0/I_y
    inv_I_y_lambda_theta_dot = inv_I_y*lambda_theta_dot
    wheel_torque = np.heaviside(inv_I_y_lambda_theta_dot - 0.0, 0.0)*wheel_torque_min + np.heaviside(-inv_I_y_lambda_theta_dot - 0.0, 0.0)*wheel_torque_max + (1.0 - np.heaviside(inv_I_y_lambda_theta_dot - 0.0, 0.0) - np.heaviside(-inv_I_y_lambda_theta_dot - 0.0, 0.0))*0.5*(wheel_torque_min + wheel_torque_max)
    out[0] = wheel_torque
    return out


def extremal_jacobian_batch(t, x, u, lam, p, out=None):
    """Rates of states and costates by states and costates, row by row, the controls being held. Batch form."""
    theta, theta_dot = x
    (wheel_torque,) = u
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, lam, *p))
    out[...] = 0.0
    out[0, 1] = 1.0
    out[3, 2] = -1.0
    return out


def beyond_switching_curve_batch(t, x, p, bounds, final, out=None):
    """How far the position lies beyond the switching curve of least time. Batch form."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p, *bounds, *final))
    inv_wheel_torque_max = 1.0/wheel_torque_max
    inv_wheel_torque_min = 1.0/wheel_torque_min
    w = target_theta_dot - theta_dot
    Abs_w = np.maximum(w, -w)
    out[...] = theta - 0.25*I_y*(target_theta_dot + theta_dot)*(-Abs_w*(inv_wheel_torque_max - inv_wheel_torque_min) - w*(inv_wheel_torque_max + inv_wheel_torque_min)) - target_theta
    return out


def feedback_law_batch(t, x, p, bounds, final, out=None):
    """The controls of least time, by the side of the switching curve. Batch form."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, *p, *bounds, *final))
    w = target_theta_dot - theta_dot
    Abs_w = np.maximum(w, -w)
    inv_wheel_torque_max = 1.0/wheel_torque_max
    inv_wheel_torque_min = 1.0/wheel_torque_min
    w_2 = inv_wheel_torque_max - inv_wheel_torque_min
    w_3 = -w
    w_4 = -w_3*(inv_wheel_torque_max + inv_wheel_torque_min)
    w_5 = 0.25*I_y*(target_theta_dot + theta_dot)
    w_6 = target_theta - theta
    w_7 = -w_5*(-Abs_w*w_2 - w_4) - w_6
    w_8 = np.heaviside(w_7, 0.0) - np.heaviside(-w_7, 0.0)
    w_9 = np.heaviside(w_3, 0.0) - np.heaviside(-w_3, 0.0)
    w_10 = w_8 + w_9*(1.0 - w_8*w_8)
    wheel_torque = np.heaviside(w_10 - 0.0, 0.0)*wheel_torque_min + np.heaviside(-w_10 - 0.0, 0.0)*wheel_torque_max + (1.0 - np.heaviside(w_10 - 0.0, 0.0) - np.heaviside(-w_10 - 0.0, 0.0))*0.5*(wheel_torque_min + wheel_torque_max)
    out[0] = wheel_torque
    return out


def transition_time_batch(t, x, p, bounds, final, out=None):
    """How long the change of position takes from rest to rest. Batch form."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p, *bounds, *final))
    inv_wheel_torque_min = 1.0/wheel_torque_min
    inv_wheel_torque_max = 1.0/wheel_torque_max
    w = 2.0*I_y*inv_wheel_torque_max - 2.0*I_y*inv_wheel_torque_min
    sqrt_w = np.sqrt(w)
    w_2 = target_theta - theta
    Abs_w_2 = np.maximum(w_2, -w_2)
    sqrt_Abs_w_2 = np.sqrt(Abs_w_2)
    out[...] = sqrt_Abs_w_2*sqrt_w
    return out


def first_arc_time_batch(t, x, p, bounds, final, out=None):
    """How long the first arc of it takes. Batch form."""
    theta, theta_dot = x
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p, *bounds, *final))
    inv_wheel_torque_min = 1.0/wheel_torque_min
    inv_wheel_torque_max = 1.0/wheel_torque_max
    w = 2.0*I_y*inv_wheel_torque_max - 2.0*I_y*inv_wheel_torque_min
    sqrt_w = np.sqrt(w)
    w_2 = target_theta - theta
    Abs_w_2 = np.maximum(w_2, -w_2)
    sqrt_Abs_w_2 = np.sqrt(Abs_w_2)
    w_3 = wheel_torque_max - wheel_torque_min
    inv_w_3 = 1.0/w_3
    w_4 = np.heaviside(w_2, 0.0) - np.heaviside(-w_2, 0.0)
    out[...] = sqrt_Abs_w_2*sqrt_w*(0.5 - 0.5*inv_w_3*w_4*(wheel_torque_max + wheel_torque_min))
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
    out[0] = 0.0
    out[1] = -lambda_theta
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_I_y = 1.0/I_y
    inv_smoothing = 1.0/smoothing
    w = -inv_I_y*inv_smoothing*lambda_theta_dot
    w_2 = np.minimum(np.maximum(w, wheel_torque_min), wheel_torque_max)
    out[0] = theta_dot
    out[1] = inv_I_y*w_2
    out[2] = 0.0
    out[3] = -lambda_theta
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    inv_I_y = 1.0/I_y
    inv_smoothing = 1.0/smoothing
    w = -inv_I_y*inv_smoothing*lambda_theta_dot
    w_2 = np.heaviside(w - wheel_torque_min, 1.0)*np.heaviside(wheel_torque_max - w, 1.0)
    out[0, 1] = 1.0
    out[1, 3] = -inv_I_y*inv_I_y*inv_smoothing*w_2
    out[3, 2] = -1.0
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
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
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    inv_smoothing = 1.0/smoothing
    inv_I_y = 1.0/I_y
    inv_I_y_lambda_theta_dot = inv_I_y*lambda_theta_dot
    w = -inv_I_y_lambda_theta_dot*inv_smoothing
    w_2 = np.minimum(np.maximum(w, wheel_torque_min), wheel_torque_max)
    out[0] = given_theta*(theta - target_theta) + lambda_theta*(1.0 - given_theta - on_reference_theta) + on_reference_theta*theta
    out[1] = given_theta_dot*(theta_dot - target_theta_dot) + lambda_theta_dot*(1.0 - given_theta_dot - on_reference_theta_dot) + on_reference_theta_dot*theta_dot
    out[2] = inv_I_y_lambda_theta_dot*w_2 + lambda_theta*theta_dot + 0.5*smoothing*w_2*w_2 + 1.0
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    theta, theta_dot = x
    lambda_theta, lambda_theta_dot = lam
    I_y, I_wy, nominal_speed, R_a, K_t, K_m = p
    wheel_torque_min, wheel_torque_max, smoothing, magnitude_share = bounds
    given_theta, given_theta_dot, on_reference_theta, on_reference_theta_dot, target_theta, target_theta_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_theta + on_reference_theta
    w_2 = given_theta_dot + on_reference_theta_dot
    inv_I_y = 1.0/I_y
    inv_smoothing = 1.0/smoothing
    w_3 = inv_smoothing*lambda_theta_dot
    w_4 = -inv_I_y*w_3
    w_5 = np.minimum(np.maximum(w_4, wheel_torque_min), wheel_torque_max)
    w_6 = np.heaviside(w_4 - wheel_torque_min, 1.0)*np.heaviside(wheel_torque_max - w_4, 1.0)
    out[0, 0] = w
    out[0, 2] = 1.0 - w
    out[1, 1] = w_2
    out[1, 3] = 1.0 - w_2
    out[2, 1] = lambda_theta
    out[2, 2] = theta_dot
    out[2, 3] = inv_I_y*w_5 - inv_I_y*inv_I_y*w_3*w_6 - inv_I_y*w_5*w_6
    return out
