"""Brachistochrone: a bead sliding down a curve in minimum time.

Written by satsym from derivations/examples/brachistochrone.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/brachistochrone.py
Source: ../derivations/examples/brachistochrone.py 4e04102ca44c55ed551aa9e1d8954f9a
Digest: e17f64478edf01de03147e0d4ec85c5453a09474f1b9003d767144800541001b
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'brachistochrone',
    'title': 'Brachistochrone: a bead sliding down a curve in minimum time',
    'source': 'derivations/examples/brachistochrone.py',
    'states': (
        {'symbol': 'x', 'latex': 'x', 'unit': 'm', 'meaning': 'horizontal distance'},
        {'symbol': 'y', 'latex': 'y', 'unit': 'm', 'meaning': 'height'},
        {'symbol': 'v', 'latex': 'v', 'unit': 'm/s', 'meaning': 'speed'},
    ),
    'controls': (
        {'symbol': 'theta', 'latex': '\\theta', 'unit': 'rad', 'meaning': 'angle of the path below the horizontal', 'kind': 'angle'},
    ),
    'parameters': (
        {'symbol': 'g', 'latex': 'g', 'unit': 'm/s^2', 'meaning': 'acceleration of gravity', 'default': 9.80665, 'positive': True},
    ),
    'control_set': 'product',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'control_parts': (
        {'name': 'slope', 'kind': 'angle', 'controls': ('theta',), 'branch': 'direction'},
    ),
    'objective_unit': 's',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x_value, y, v = x
    (theta,) = u
    (g,) = p
    sin_theta = math.sin(theta)
    return (
        v*math.cos(theta),
        -sin_theta*v,
        g*sin_theta,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x_value, y, v = x
    (theta,) = u
    (g,) = p
    return (
        0.0,
        0.0,
        math.cos(theta),
        0.0,
        0.0,
        -math.sin(theta),
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x_value, y, v = x
    (theta,) = u
    (g,) = p
    cos_theta = math.cos(theta)
    return (
        -v*math.sin(theta),
        -cos_theta*v,
        cos_theta*g,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x_value, y, v = x
    (theta,) = u
    (g,) = p
    return 1.0


def terminal_cost(t, x, p):
    """Terminal cost S."""
    x_value, y, v = x
    (g,) = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    x_value, y, v = x
    (g,) = p
    return (
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    x_value, y, v = x
    (theta,) = u
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    sin_theta = math.sin(theta)
    return g*lambda_v*sin_theta + lambda_x*v*math.cos(theta) + 1.0 - lambda_y*sin_theta*v


def stationarity(t, x, u, lam, p):
    """H_u."""
    x_value, y, v = x
    (theta,) = u
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    cos_theta = math.cos(theta)
    return (
        cos_theta*g*lambda_v - cos_theta*lambda_y*v - lambda_x*v*math.sin(theta),
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    x_value, y, v = x
    (theta,) = u
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    sin_theta = math.sin(theta)
    return (
        lambda_y*sin_theta*v - g*lambda_v*sin_theta - lambda_x*v*math.cos(theta),
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    return (
        math.atan2(lambda_y*v - g*lambda_v, -lambda_x*v),
    )


def regularised_cost(t, x, lam, p, bounds):
    """Integrand of the cost of the regularised problem."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    w = g*lambda_v - lambda_y*v
    w_sq = w*w
    w_2 = lambda_x*lambda_x*v*v
    w_3 = w_2 + w_sq
    w_4 = theta_reach/math.sqrt(w_3) if w_3 > smoothing*theta_reach*(smoothing*theta_reach) else 1.0/smoothing
    w_4_sq = w_4*w_4
    return 0.5*smoothing*(w_2*w_4_sq + w_4_sq*w_sq) + 1.0


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x_value, y, v = x
    (theta,) = u
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    return (
        0.0,
        0.0,
        lambda_y*math.sin(theta) - lambda_x*math.cos(theta),
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    w = g*lambda_v - lambda_y*v
    lambda_x_sq = lambda_x*lambda_x
    v_sq = v*v
    w_2 = lambda_x_sq*v_sq + w*w
    w_3 = theta_reach/math.sqrt(w_2) if w_2 > smoothing*theta_reach*(smoothing*theta_reach) else 1.0/smoothing
    w_w_3 = w*w_3
    return (
        -lambda_x*v_sq*w_3,
        v*w_w_3,
        -g*w_w_3,
        0.0,
        0.0,
        lambda_x_sq*v*w_3 - lambda_y*w_w_3,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    lambda_y_v = lambda_y*v
    w = g*lambda_v - lambda_y_v
    w_sq = w*w
    lambda_x_sq = lambda_x*lambda_x
    v_sq = v*v
    lambda_x_sq_v_sq = lambda_x_sq*v_sq
    w_2 = lambda_x_sq_v_sq + w_sq
    w_3 = -0.5*theta_reach/(w_2*math.sqrt(w_2)) if w_2 > smoothing*theta_reach*(smoothing*theta_reach) else 0.0
    twice_v = 2.0*v
    lambda_y_w = lambda_y*w
    twice_lambda_y_w = 2.0*lambda_y_w
    w_4 = w_3*(lambda_x_sq*twice_v - twice_lambda_y_w)
    lambda_x_v_sq = lambda_x*v_sq
    w_5 = theta_reach/math.sqrt(w_2) if w_2 > smoothing*theta_reach*(smoothing*theta_reach) else 1.0/smoothing
    lambda_x_twice_v_w_5 = lambda_x*twice_v*w_5
    v_sq_w_5 = v_sq*w_5
    twice_w_3 = 2.0*w_3
    w_6 = twice_w_3*v*v*v
    lambda_x_w_w_6 = lambda_x*w*w_6
    twice_w_3_w = twice_w_3*w
    w_7 = -g*lambda_x_v_sq*twice_w_3_w
    lambda_y_v_w_5 = lambda_y_v*w_5
    w_w_5 = w*w_5
    w_w_4 = w*w_4
    twice_w_3_w_sq = twice_w_3*w_sq
    g_w_5 = g*w_5
    w_8 = g*twice_v*w_3*w_sq + g_w_5*v
    g_w_5_lambda_y = g_w_5*lambda_y
    g_sq = g*g
    return (
        0.0,
        0.0,
        -lambda_x_twice_v_w_5 - lambda_x_v_sq*w_4,
        -lambda_x_sq*twice_w_3*v*v*v*v - v_sq_w_5,
        lambda_x_w_w_6,
        w_7,
        0.0,
        0.0,
        v*w_w_4 + w_w_5 - lambda_y_v_w_5,
        lambda_x_w_w_6,
        -twice_w_3_w_sq*v_sq - v_sq_w_5,
        w_8,
        0.0,
        0.0,
        g_w_5_lambda_y - g*w_w_4,
        w_7,
        w_8,
        -g_sq*twice_w_3_w_sq - g_sq*w_5,
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
        0.0,
        0.0,
        lambda_x_sq*v*w_4 + lambda_x_sq*w_5 + lambda_y*lambda_y*w_5 - lambda_y_w*w_4,
        lambda_x*lambda_x*lambda_x*w_6 + lambda_x_twice_v_w_5 - lambda_x_v_sq*twice_lambda_y_w*w_3,
        lambda_y_v*twice_w_3_w_sq + lambda_y_v_w_5 - lambda_x_sq_v_sq*twice_w_3_w - w_w_5,
        2.0*g*lambda_x_sq*v*w*w_3 - g*lambda_y*twice_w_3_w_sq - g_w_5_lambda_y,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
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
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    given_x, given_y, given_v, on_reference_x, on_reference_y, on_reference_v, target_x, target_y, target_v = final
    w = g*lambda_v - lambda_y*v
    w_sq = w*w
    w_2 = lambda_x*lambda_x*v*v
    w_3 = w_2 + w_sq
    w_4 = theta_reach/math.sqrt(w_3) if w_3 > smoothing*theta_reach*(smoothing*theta_reach) else 1.0/smoothing
    w_4_sq = w_4*w_4
    return (
        given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value,
        given_y*(y - target_y) + lambda_y*(1.0 - given_y - on_reference_y) + on_reference_y*y,
        given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v,
        0.5*smoothing*(w_2*w_4_sq + w_4_sq*w_sq) + 1.0 - w_2*w_4 - w_4*w_sq,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    given_x, given_y, given_v, on_reference_x, on_reference_y, on_reference_v, target_x, target_y, target_v = final
    w = given_x + on_reference_x
    w_2 = given_y + on_reference_y
    w_3 = given_v + on_reference_v
    w_4 = g*lambda_v - lambda_y*v
    w_4_sq = w_4*w_4
    lambda_x_sq = lambda_x*lambda_x
    v_sq = v*v
    lambda_x_sq_v_sq = lambda_x_sq*v_sq
    w_5 = lambda_x_sq_v_sq + w_4_sq
    w_6 = theta_reach/math.sqrt(w_5) if w_5 > smoothing*theta_reach*(smoothing*theta_reach) else 1.0/smoothing
    twice_w_4 = 2.0*w_4
    lambda_y_twice_w_4 = lambda_y*twice_w_4
    w_7 = -0.5*theta_reach/(w_5*math.sqrt(w_5)) if w_5 > smoothing*theta_reach*(smoothing*theta_reach) else 0.0
    twice_v = 2.0*v
    lambda_x_sq_twice_v = lambda_x_sq*twice_v
    w_8 = w_7*(lambda_x_sq_twice_v - lambda_y_twice_w_4)
    w_4_sq_w_8 = w_4_sq*w_8
    lambda_x_sq_v_sq_w_8 = lambda_x_sq_v_sq*w_8
    w_6_sq = w_6*w_6
    twice_w_6 = 2.0*w_6
    lambda_x_v_sq = lambda_x*v_sq
    twice_lambda_x_v_sq = 2.0*lambda_x_v_sq
    twice_w_7 = 2.0*w_7
    w_9 = lambda_x*lambda_x*lambda_x*v*v*v*v
    w_10 = 4.0*w_6
    w_10_w_7 = w_10*w_7
    w_4_cubed = w_4*w_4*w_4
    w_4_cubed_w_7 = w_4_cubed*w_7
    twice_w_4_v = twice_w_4*v
    w_11 = lambda_x_sq*v*v*v
    w_10_w_4_cubed_w_7 = w_10*w_4_cubed_w_7
    w_10_w_7_w_4 = w_10_w_7*w_4
    g_twice_w_4 = g*twice_w_4
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
        0.0,
        0.0,
        2.0*lambda_y*w_4*w_6 + 0.5*smoothing*(lambda_x_sq_twice_v*w_6_sq + lambda_x_sq_v_sq_w_8*twice_w_6 + twice_w_6*w_4_sq_w_8 - lambda_y_twice_w_4*w_6_sq) - lambda_x_sq_twice_v*w_6 - lambda_x_sq_v_sq_w_8 - w_4_sq_w_8,
        0.5*smoothing*(lambda_x_v_sq*w_10_w_7*w_4_sq + twice_lambda_x_v_sq*w_6_sq + w_10_w_7*w_9) - twice_lambda_x_v_sq*w_4_sq*w_7 - twice_lambda_x_v_sq*w_6 - twice_w_7*w_9,
        0.5*smoothing*(-twice_w_4_v*w_6_sq - v*w_10_w_4_cubed_w_7 - w_10_w_7_w_4*w_11) + twice_v*w_4_cubed_w_7 + twice_w_4*w_11*w_7 + twice_w_4_v*w_6,
        0.5*smoothing*(g*lambda_x_sq_v_sq*w_10_w_7_w_4 + g*w_10_w_4_cubed_w_7 + g_twice_w_4*w_6_sq) - g*twice_w_7*w_4_cubed - g_twice_w_4*lambda_x_sq_v_sq*w_7 - g_twice_w_4*w_6,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    (g,) = p
    x_value_at, y_at, v_at = x
    x_value_mid, y_mid, v_mid = x_mid
    (theta_at,) = u
    (theta_mid,) = u_mid
    x_value, y, v = x0
    steps = len(times) - 1
    t = times[0]
    x_value_at[0] = x_value
    y_at[0] = y
    v_at[0] = v
    theta = theta_at[0]
    sin_theta = math.sin(theta)
    slope_x_value = v*math.cos(theta)
    slope_y = -sin_theta*v
    slope_v = g*sin_theta
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x_value_at[i] = x_value
        y_at[i] = y
        v_at[i] = v
        theta_half = theta_mid[i]
        theta_end = theta_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        v_2 = half*slope_v + v
        sin_theta_half = math.sin(theta_half)
        k2_x_value = v_2*math.cos(theta_half)
        k2_y = -sin_theta_half*v_2
        k2_v = g*sin_theta_half
        v_3 = half*k2_v + v
        k3_x_value = v_3*math.cos(theta_half)
        k3_y = -sin_theta_half*v_3
        v_4 = h*k2_v + v
        sin_theta_end = math.sin(theta_end)
        k4_x_value = v_4*math.cos(theta_end)
        k4_y = -sin_theta_end*v_4
        k4_v = g*sin_theta_end
        x_value_end = sixth*(k4_x_value + slope_x_value + 2.0*(k2_x_value + k3_x_value)) + x_value
        y_end = sixth*(k4_y + slope_y + 2.0*(k2_y + k3_y)) + y
        v_end = sixth*(4.0*k2_v + k4_v + slope_v) + v
        slope_end_x_value = v_end*math.cos(theta_end)
        slope_end_y = -sin_theta_end*v_end
        eighth = 0.125*h
        x_value_mid[i] = eighth*(slope_x_value - slope_end_x_value) + 0.5*(x_value + x_value_end)
        y_mid[i] = eighth*(slope_y - slope_end_y) + 0.5*(y + y_end)
        v_mid[i] = eighth*(slope_v - k4_v) + 0.5*(v + v_end)
        total = 6.0*sixth + total
        t = t_end
        x_value = x_value_end
        y = y_end
        v = v_end
        slope_x_value = slope_end_x_value
        slope_y = slope_end_y
        slope_v = k4_v
    x_value_at[steps] = x_value
    y_at[steps] = y
    v_at[steps] = v
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    (g,) = p
    lambda_x_at, lambda_y_at, lambda_v_at = lam
    lambda_x_mid, lambda_y_mid, lambda_v_mid = lam_mid
    x_value_at, y_at, v_at = x
    (theta_at,) = u
    x_value_mid, y_mid, v_mid = x_mid
    (theta_mid,) = u_mid
    lambda_x, lambda_y, lambda_v = lam_f
    steps = len(times) - 1
    t = times[steps]
    lambda_x_at[steps] = lambda_x
    lambda_y_at[steps] = lambda_y
    lambda_v_at[steps] = lambda_v
    theta = theta_at[steps]
    sin_theta = math.sin(theta)
    cos_theta = math.cos(theta)
    slope_lambda_v = lambda_y*sin_theta - cos_theta*lambda_x
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        theta_half = theta_mid[i]
        theta_end = theta_at[i]
        sixth = (1.0/6.0)*h
        sin_theta_half = math.sin(theta_half)
        cos_theta_half = math.cos(theta_half)
        k2_lambda_v = lambda_y*sin_theta_half - cos_theta_half*lambda_x
        sin_theta_end = math.sin(theta_end)
        cos_theta_end = math.cos(theta_end)
        k4_lambda_v = lambda_y*sin_theta_end - cos_theta_end*lambda_x
        lambda_v_end = lambda_v + sixth*(4.0*k2_lambda_v + k4_lambda_v + slope_lambda_v)
        eighth = 0.125*h
        lambda_x_mid[i] = lambda_x
        lambda_x_at[i] = lambda_x
        lambda_y_mid[i] = lambda_y
        lambda_y_at[i] = lambda_y
        lambda_v_mid[i] = eighth*(slope_lambda_v - k4_lambda_v) + 0.5*(lambda_v + lambda_v_end)
        lambda_v_at[i] = lambda_v_end
        t = t_end
        lambda_v = lambda_v_end
        slope_lambda_v = k4_lambda_v


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x_value, y, v = x
    (theta,) = u
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, *p))
    sin_theta = np.sin(theta)
    out[0] = v*np.cos(theta)
    out[1] = -sin_theta*v
    out[2] = g*sin_theta
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x_value, y, v = x
    (theta,) = u
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 3, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[0, 2] = np.cos(theta)
    out[1, 2] = -np.sin(theta)
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x_value, y, v = x
    (theta,) = u
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((3, 1, *shape), np.result_type(float, t, x, u, *p))
    cos_theta = np.cos(theta)
    out[0, 0] = -v*np.sin(theta)
    out[1, 0] = -cos_theta*v
    out[2, 0] = cos_theta*g
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x_value, y, v = x
    (theta,) = u
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 1.0
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    x_value, y, v = x
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    x_value, y, v = x
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    x_value, y, v = x
    (theta,) = u
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    sin_theta = np.sin(theta)
    out[...] = g*lambda_v*sin_theta + lambda_x*v*np.cos(theta) + 1.0 - lambda_y*sin_theta*v
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    x_value, y, v = x
    (theta,) = u
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    cos_theta = np.cos(theta)
    out[0] = cos_theta*g*lambda_v - cos_theta*lambda_y*v - lambda_x*v*np.sin(theta)
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    x_value, y, v = x
    (theta,) = u
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    sin_theta = np.sin(theta)
    out[0, 0] = lambda_y*sin_theta*v - g*lambda_v*sin_theta - lambda_x*v*np.cos(theta)
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = np.arctan2(lambda_y*v - g*lambda_v, -lambda_x*v)
    return out


def regularised_cost_batch(t, x, lam, p, bounds, out=None):
    """Integrand of the cost of the regularised problem. Batch form."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, lam, *p, *bounds))
    w = g*lambda_v - lambda_y*v
    w_sq = w*w
    w_2 = lambda_x*lambda_x*v*v
    w_3 = w_2 + w_sq
    w_4 = np.minimum(1.0/smoothing, theta_reach/np.sqrt(np.maximum(w_3, 1e-300)))
    w_4_sq = w_4*w_4
    out[...] = 0.5*smoothing*(w_2*w_4_sq + w_4_sq*w_sq) + 1.0
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x_value, y, v = x
    (theta,) = u
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = lambda_y*np.sin(theta) - lambda_x*np.cos(theta)
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = g*lambda_v - lambda_y*v
    lambda_x_sq = lambda_x*lambda_x
    v_sq = v*v
    w_2 = lambda_x_sq*v_sq + w*w
    w_3 = np.minimum(1.0/smoothing, theta_reach/np.sqrt(np.maximum(w_2, 1e-300)))
    w_w_3 = w*w_3
    out[0] = -lambda_x*v_sq*w_3
    out[1] = v*w_w_3
    out[2] = -g*w_w_3
    out[3] = 0.0
    out[4] = 0.0
    out[5] = lambda_x_sq*v*w_3 - lambda_y*w_w_3
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    lambda_y_v = lambda_y*v
    w = g*lambda_v - lambda_y_v
    w_sq = w*w
    lambda_x_sq = lambda_x*lambda_x
    v_sq = v*v
    lambda_x_sq_v_sq = lambda_x_sq*v_sq
    w_2 = lambda_x_sq_v_sq + w_sq
    w_3 = -0.5*np.heaviside(np.sqrt(w_2) - smoothing*theta_reach, 0.0)*np.minimum(theta_reach, 1e100)/np.maximum(w_2*np.sqrt(w_2), 1e-200)
    twice_v = 2.0*v
    lambda_y_w = lambda_y*w
    twice_lambda_y_w = 2.0*lambda_y_w
    w_4 = w_3*(lambda_x_sq*twice_v - twice_lambda_y_w)
    lambda_x_v_sq = lambda_x*v_sq
    w_5 = np.minimum(1.0/smoothing, theta_reach/np.sqrt(np.maximum(w_2, 1e-300)))
    lambda_x_twice_v_w_5 = lambda_x*twice_v*w_5
    v_sq_w_5 = v_sq*w_5
    twice_w_3 = 2.0*w_3
    w_6 = twice_w_3*v*v*v
    lambda_x_w_w_6 = lambda_x*w*w_6
    twice_w_3_w = twice_w_3*w
    w_7 = -g*lambda_x_v_sq*twice_w_3_w
    lambda_y_v_w_5 = lambda_y_v*w_5
    w_w_5 = w*w_5
    w_w_4 = w*w_4
    twice_w_3_w_sq = twice_w_3*w_sq
    g_w_5 = g*w_5
    w_8 = g*twice_v*w_3*w_sq + g_w_5*v
    g_w_5_lambda_y = g_w_5*lambda_y
    g_sq = g*g
    out[0, 2] = -lambda_x_twice_v_w_5 - lambda_x_v_sq*w_4
    out[0, 3] = -lambda_x_sq*twice_w_3*v*v*v*v - v_sq_w_5
    out[0, 4] = lambda_x_w_w_6
    out[0, 5] = w_7
    out[1, 2] = v*w_w_4 + w_w_5 - lambda_y_v_w_5
    out[1, 3] = lambda_x_w_w_6
    out[1, 4] = -twice_w_3_w_sq*v_sq - v_sq_w_5
    out[1, 5] = w_8
    out[2, 2] = g_w_5_lambda_y - g*w_w_4
    out[2, 3] = w_7
    out[2, 4] = w_8
    out[2, 5] = -g_sq*twice_w_3_w_sq - g_sq*w_5
    out[5, 2] = lambda_x_sq*v*w_4 + lambda_x_sq*w_5 + lambda_y*lambda_y*w_5 - lambda_y_w*w_4
    out[5, 3] = lambda_x*lambda_x*lambda_x*w_6 + lambda_x_twice_v_w_5 - lambda_x_v_sq*twice_lambda_y_w*w_3
    out[5, 4] = lambda_y_v*twice_w_3_w_sq + lambda_y_v_w_5 - lambda_x_sq_v_sq*twice_w_3_w - w_w_5
    out[5, 5] = 2.0*g*lambda_x_sq*v*w*w_3 - g*lambda_y*twice_w_3_w_sq - g_w_5_lambda_y
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
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
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    given_x, given_y, given_v, on_reference_x, on_reference_y, on_reference_v, target_x, target_y, target_v = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = g*lambda_v - lambda_y*v
    w_sq = w*w
    w_2 = lambda_x*lambda_x*v*v
    w_3 = w_2 + w_sq
    w_4 = np.minimum(1.0/smoothing, theta_reach/np.sqrt(np.maximum(w_3, 1e-300)))
    w_4_sq = w_4*w_4
    out[0] = given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value
    out[1] = given_y*(y - target_y) + lambda_y*(1.0 - given_y - on_reference_y) + on_reference_y*y
    out[2] = given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v
    out[3] = 0.5*smoothing*(w_2*w_4_sq + w_4_sq*w_sq) + 1.0 - w_2*w_4 - w_4*w_sq
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    x_value, y, v = x
    lambda_x, lambda_y, lambda_v = lam
    (g,) = p
    theta_reach, smoothing = bounds
    given_x, given_y, given_v, on_reference_x, on_reference_y, on_reference_v, target_x, target_y, target_v = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 7, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_x + on_reference_x
    w_2 = given_y + on_reference_y
    w_3 = given_v + on_reference_v
    w_4 = g*lambda_v - lambda_y*v
    w_4_sq = w_4*w_4
    lambda_x_sq = lambda_x*lambda_x
    v_sq = v*v
    lambda_x_sq_v_sq = lambda_x_sq*v_sq
    w_5 = lambda_x_sq_v_sq + w_4_sq
    w_6 = np.minimum(1.0/smoothing, theta_reach/np.sqrt(np.maximum(w_5, 1e-300)))
    twice_w_4 = 2.0*w_4
    lambda_y_twice_w_4 = lambda_y*twice_w_4
    w_7 = -0.5*np.heaviside(np.sqrt(w_5) - smoothing*theta_reach, 0.0)*np.minimum(theta_reach, 1e100)/np.maximum(w_5*np.sqrt(w_5), 1e-200)
    twice_v = 2.0*v
    lambda_x_sq_twice_v = lambda_x_sq*twice_v
    w_8 = w_7*(lambda_x_sq_twice_v - lambda_y_twice_w_4)
    w_4_sq_w_8 = w_4_sq*w_8
    lambda_x_sq_v_sq_w_8 = lambda_x_sq_v_sq*w_8
    w_6_sq = w_6*w_6
    twice_w_6 = 2.0*w_6
    lambda_x_v_sq = lambda_x*v_sq
    twice_lambda_x_v_sq = 2.0*lambda_x_v_sq
    twice_w_7 = 2.0*w_7
    w_9 = lambda_x*lambda_x*lambda_x*v*v*v*v
    w_10 = 4.0*w_6
    w_10_w_7 = w_10*w_7
    w_4_cubed = w_4*w_4*w_4
    w_4_cubed_w_7 = w_4_cubed*w_7
    twice_w_4_v = twice_w_4*v
    w_11 = lambda_x_sq*v*v*v
    w_10_w_4_cubed_w_7 = w_10*w_4_cubed_w_7
    w_10_w_7_w_4 = w_10_w_7*w_4
    g_twice_w_4 = g*twice_w_4
    out[0, 0] = w
    out[0, 3] = 1.0 - w
    out[1, 1] = w_2
    out[1, 4] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 5] = 1.0 - w_3
    out[3, 2] = 2.0*lambda_y*w_4*w_6 + 0.5*smoothing*(lambda_x_sq_twice_v*w_6_sq + lambda_x_sq_v_sq_w_8*twice_w_6 + twice_w_6*w_4_sq_w_8 - lambda_y_twice_w_4*w_6_sq) - lambda_x_sq_twice_v*w_6 - lambda_x_sq_v_sq_w_8 - w_4_sq_w_8
    out[3, 3] = 0.5*smoothing*(lambda_x_v_sq*w_10_w_7*w_4_sq + twice_lambda_x_v_sq*w_6_sq + w_10_w_7*w_9) - twice_lambda_x_v_sq*w_4_sq*w_7 - twice_lambda_x_v_sq*w_6 - twice_w_7*w_9
    out[3, 4] = 0.5*smoothing*(-twice_w_4_v*w_6_sq - v*w_10_w_4_cubed_w_7 - w_10_w_7_w_4*w_11) + twice_v*w_4_cubed_w_7 + twice_w_4*w_11*w_7 + twice_w_4_v*w_6
    out[3, 5] = 0.5*smoothing*(g*lambda_x_sq_v_sq*w_10_w_7_w_4 + g*w_10_w_4_cubed_w_7 + g_twice_w_4*w_6_sq) - g*twice_w_7*w_4_cubed - g_twice_w_4*lambda_x_sq_v_sq*w_7 - g_twice_w_4*w_6
    return out
