"""Zermelo's problem: minimum-time crossing of a linear current.

Written by satsym from derivations/examples/zermelo.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/zermelo.py
Source: ../derivations/examples/zermelo.py 089adabda78bb52ba5d2b4e88a8133eb
Digest: 6a6a0469765d2f6c7aaf5285149f5923b2ed750d0afd393454910b0adffbf143
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'zermelo',
    'title': "Zermelo's problem: minimum-time crossing of a linear current",
    'source': 'derivations/examples/zermelo.py',
    'states': (
        {'symbol': 'x', 'latex': 'x', 'meaning': 'distance along the current'},
        {'symbol': 'y', 'latex': 'y', 'meaning': 'distance across the current'},
    ),
    'controls': (
        {'symbol': 'heading', 'latex': '\\theta', 'meaning': 'heading, from the direction of x', 'kind': 'angle'},
    ),
    'parameters': (
        {'symbol': 'V', 'latex': 'V', 'meaning': 'speed of the ship in the water', 'default': 1.0, 'positive': True},
        {'symbol': 'h', 'latex': 'h', 'meaning': "distance over which the current grows by the ship's speed", 'default': 1.0, 'positive': True},
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
        {'name': 'rudder', 'kind': 'angle', 'controls': ('heading',), 'branch': 'direction'},
    ),
    'objective_unit': '1',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x_value, y = x
    (heading,) = u
    V, h = p
    inv_h = 1.0/h
    return (
        V*math.cos(heading) - V*inv_h*y,
        V*math.sin(heading),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x_value, y = x
    (heading,) = u
    V, h = p
    inv_h = 1.0/h
    return (
        0.0,
        -V*inv_h,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x_value, y = x
    (heading,) = u
    V, h = p
    return (
        -V*math.sin(heading),
        V*math.cos(heading),
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x_value, y = x
    (heading,) = u
    V, h = p
    return 1.0


def terminal_cost(t, x, p):
    """Terminal cost S."""
    x_value, y = x
    V, h = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    x_value, y = x
    V, h = p
    return (
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    x_value, y = x
    (heading,) = u
    lambda_x, lambda_y = lam
    V, h = p
    inv_h = 1.0/h
    return V*lambda_y*math.sin(heading) + lambda_x*(V*math.cos(heading) - V*inv_h*y) + 1.0


def stationarity(t, x, u, lam, p):
    """H_u."""
    x_value, y = x
    (heading,) = u
    lambda_x, lambda_y = lam
    V, h = p
    return (
        V*(lambda_y*math.cos(heading) - lambda_x*math.sin(heading)),
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    x_value, y = x
    (heading,) = u
    lambda_x, lambda_y = lam
    V, h = p
    return (
        V*(-lambda_x*math.cos(heading) - lambda_y*math.sin(heading)),
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    return (
        math.atan2(-V*lambda_y, -V*lambda_x),
    )


def regularised_cost(t, x, lam, p, bounds):
    """Integrand of the cost of the regularised problem."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    V_sq = V*V
    w = V_sq*lambda_x*lambda_x
    w_2 = V_sq*lambda_y*lambda_y
    w_3 = w + w_2
    w_4 = heading_reach/math.sqrt(w_3) if w_3 > smoothing*heading_reach*(smoothing*heading_reach) else 1.0/smoothing
    w_4_sq = w_4*w_4
    return 0.5*smoothing*(w*w_4_sq + w_2*w_4_sq) + 1.0


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x_value, y = x
    (heading,) = u
    lambda_x, lambda_y = lam
    V, h = p
    inv_h = 1.0/h
    return (
        0.0,
        V*inv_h*lambda_x,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    inv_h = 1.0/h
    V_inv_h = V*inv_h
    V_sq = V*V
    w = V_sq*lambda_x*lambda_x + V_sq*lambda_y*lambda_y
    w_2 = heading_reach/math.sqrt(w) if w > smoothing*heading_reach*(smoothing*heading_reach) else 1.0/smoothing
    V_sq_w_2 = V_sq*w_2
    return (
        -V_inv_h*y - V_sq_w_2*lambda_x,
        -V_sq_w_2*lambda_y,
        0.0,
        V_inv_h*lambda_x,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    inv_h = 1.0/h
    V_inv_h = V*inv_h
    lambda_x_sq = lambda_x*lambda_x
    V_sq = V*V
    lambda_y_sq = lambda_y*lambda_y
    w = V_sq*lambda_x_sq + V_sq*lambda_y_sq
    w_2 = heading_reach/math.sqrt(w) if w > smoothing*heading_reach*(smoothing*heading_reach) else 1.0/smoothing
    V_sq_w_2 = V_sq*w_2
    w_3 = -0.5*heading_reach/(w*math.sqrt(w)) if w > smoothing*heading_reach*(smoothing*heading_reach) else 0.0
    w_4 = 2.0*V*V*V*V*w_3
    w_5 = -lambda_x*lambda_y*w_4
    return (
        0.0,
        -V_inv_h,
        -V_sq_w_2 - lambda_x_sq*w_4,
        w_5,
        0.0,
        0.0,
        w_5,
        -V_sq_w_2 - lambda_y_sq*w_4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        V_inv_h,
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    given_x, given_y, on_reference_x, on_reference_y, target_x, target_y = final
    V_sq = V*V
    w = V_sq*lambda_x*lambda_x
    w_2 = V_sq*lambda_y*lambda_y
    w_3 = w + w_2
    w_4 = heading_reach/math.sqrt(w_3) if w_3 > smoothing*heading_reach*(smoothing*heading_reach) else 1.0/smoothing
    inv_h = 1.0/h
    w_4_sq = w_4*w_4
    return (
        given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value,
        given_y*(y - target_y) + lambda_y*(1.0 - given_y - on_reference_y) + on_reference_y*y,
        0.5*smoothing*(w*w_4_sq + w_2*w_4_sq) + 1.0 - V*inv_h*lambda_x*y - w*w_4 - w_2*w_4,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    given_x, given_y, on_reference_x, on_reference_y, target_x, target_y = final
    w = given_x + on_reference_x
    w_2 = given_y + on_reference_y
    inv_h = 1.0/h
    V_inv_h = V*inv_h
    V_sq = V*V
    lambda_x_sq = lambda_x*lambda_x
    lambda_y_sq = lambda_y*lambda_y
    w_3 = V_sq*lambda_x_sq + V_sq*lambda_y_sq
    w_4 = heading_reach/math.sqrt(w_3) if w_3 > smoothing*heading_reach*(smoothing*heading_reach) else 1.0/smoothing
    w_5 = -0.5*heading_reach/(w_3*math.sqrt(w_3)) if w_3 > smoothing*heading_reach*(smoothing*heading_reach) else 0.0
    w_6 = V*V*V*V*w_5
    twice_w_6 = 2.0*w_6
    lambda_x_lambda_y_sq = lambda_x*lambda_y_sq
    w_4_sq = w_4*w_4
    w_7 = 4.0*w_4*w_6
    twice_V_sq = 2.0*V_sq
    lambda_x_twice_V_sq = lambda_x*twice_V_sq
    lambda_x_cubed = lambda_x*lambda_x*lambda_x
    lambda_y_twice_V_sq = lambda_y*twice_V_sq
    lambda_y_cubed = lambda_y*lambda_y*lambda_y
    lambda_x_sq_lambda_y = lambda_x_sq*lambda_y
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
        -V_inv_h*lambda_x,
        0.5*smoothing*(lambda_x_cubed*w_7 + lambda_x_lambda_y_sq*w_7 + lambda_x_twice_V_sq*w_4_sq) - V_inv_h*y - lambda_x_cubed*twice_w_6 - lambda_x_lambda_y_sq*twice_w_6 - lambda_x_twice_V_sq*w_4,
        0.5*smoothing*(lambda_x_sq_lambda_y*w_7 + lambda_y_cubed*w_7 + lambda_y_twice_V_sq*w_4_sq) - lambda_x_sq_lambda_y*twice_w_6 - lambda_y_cubed*twice_w_6 - lambda_y_twice_V_sq*w_4,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    V, h = p
    x_value_at, y_at = x
    x_value_mid, y_mid = x_mid
    (heading_at,) = u
    (heading_mid,) = u_mid
    x_value, y = x0
    inv_h = 1.0/h
    V_inv_h = V*inv_h
    steps = len(times) - 1
    t = times[0]
    x_value_at[0] = x_value
    y_at[0] = y
    heading = heading_at[0]
    slope_x_value = V*math.cos(heading) - V_inv_h*y
    slope_y = V*math.sin(heading)
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h_2 = t_end - t
        x_value_at[i] = x_value
        y_at[i] = y
        heading_half = heading_mid[i]
        heading_end = heading_at[i + 1]
        half = 0.5*h_2
        sixth = (1.0/6.0)*h_2
        y_2 = half*slope_y + y
        k2_x_value = V*math.cos(heading_half) - V_inv_h*y_2
        k2_y = V*math.sin(heading_half)
        y_3 = half*k2_y + y
        k3_x_value = V*math.cos(heading_half) - V_inv_h*y_3
        y_4 = h_2*k2_y + y
        k4_x_value = V*math.cos(heading_end) - V_inv_h*y_4
        k4_y = V*math.sin(heading_end)
        x_value_end = sixth*(k4_x_value + slope_x_value + 2.0*(k2_x_value + k3_x_value)) + x_value
        y_end = sixth*(4.0*k2_y + k4_y + slope_y) + y
        slope_end_x_value = V*math.cos(heading_end) - V_inv_h*y_end
        eighth = 0.125*h_2
        x_value_mid[i] = eighth*(slope_x_value - slope_end_x_value) + 0.5*(x_value + x_value_end)
        y_mid[i] = eighth*(slope_y - k4_y) + 0.5*(y + y_end)
        total = 6.0*sixth + total
        t = t_end
        x_value = x_value_end
        y = y_end
        slope_x_value = slope_end_x_value
        slope_y = k4_y
    x_value_at[steps] = x_value
    y_at[steps] = y
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    V, h = p
    lambda_x_at, lambda_y_at = lam
    lambda_x_mid, lambda_y_mid = lam_mid
    x_value_at, y_at = x
    (heading_at,) = u
    x_value_mid, y_mid = x_mid
    (heading_mid,) = u_mid
    lambda_x, lambda_y = lam_f
    inv_h = 1.0/h
    V_inv_h = V*inv_h
    steps = len(times) - 1
    t = times[steps]
    lambda_x_at[steps] = lambda_x
    lambda_y_at[steps] = lambda_y
    slope_lambda_y = V_inv_h*lambda_x
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h_2 = t_end - t
        sixth = (1.0/6.0)*h_2
        k2_lambda_y = V_inv_h*lambda_x
        lambda_y_end = lambda_y + sixth*(5.0*k2_lambda_y + slope_lambda_y)
        eighth = 0.125*h_2
        lambda_x_mid[i] = lambda_x
        lambda_x_at[i] = lambda_x
        lambda_y_mid[i] = eighth*(slope_lambda_y - k2_lambda_y) + 0.5*(lambda_y + lambda_y_end)
        lambda_y_at[i] = lambda_y_end
        t = t_end
        lambda_y = lambda_y_end
        slope_lambda_y = k2_lambda_y


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x_value, y = x
    (heading,) = u
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    inv_h = 1.0/h
    out[0] = V*np.cos(heading) - V*inv_h*y
    out[1] = V*np.sin(heading)
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x_value, y = x
    (heading,) = u
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_h = 1.0/h
    out[0, 1] = -V*inv_h
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x_value, y = x
    (heading,) = u
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = -V*np.sin(heading)
    out[1, 0] = V*np.cos(heading)
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x_value, y = x
    (heading,) = u
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 1.0
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    x_value, y = x
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    x_value, y = x
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    x_value, y = x
    (heading,) = u
    lambda_x, lambda_y = lam
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    inv_h = 1.0/h
    out[...] = V*lambda_y*np.sin(heading) + lambda_x*(V*np.cos(heading) - V*inv_h*y) + 1.0
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    x_value, y = x
    (heading,) = u
    lambda_x, lambda_y = lam
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = V*(lambda_y*np.cos(heading) - lambda_x*np.sin(heading))
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    x_value, y = x
    (heading,) = u
    lambda_x, lambda_y = lam
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = V*(-lambda_x*np.cos(heading) - lambda_y*np.sin(heading))
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = np.arctan2(-V*lambda_y, -V*lambda_x)
    return out


def regularised_cost_batch(t, x, lam, p, bounds, out=None):
    """Integrand of the cost of the regularised problem. Batch form."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, lam, *p, *bounds))
    V_sq = V*V
    w = V_sq*lambda_x*lambda_x
    w_2 = V_sq*lambda_y*lambda_y
    w_3 = w + w_2
    w_4 = np.minimum(1.0/smoothing, heading_reach/np.sqrt(np.maximum(w_3, 1e-300)))
    w_4_sq = w_4*w_4
    out[...] = 0.5*smoothing*(w*w_4_sq + w_2*w_4_sq) + 1.0
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x_value, y = x
    (heading,) = u
    lambda_x, lambda_y = lam
    V, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_h = 1.0/h
    out[0] = 0.0
    out[1] = V*inv_h*lambda_x
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_h = 1.0/h
    V_inv_h = V*inv_h
    V_sq = V*V
    w = V_sq*lambda_x*lambda_x + V_sq*lambda_y*lambda_y
    w_2 = np.minimum(1.0/smoothing, heading_reach/np.sqrt(np.maximum(w, 1e-300)))
    V_sq_w_2 = V_sq*w_2
    out[0] = -V_inv_h*y - V_sq_w_2*lambda_x
    out[1] = -V_sq_w_2*lambda_y
    out[2] = 0.0
    out[3] = V_inv_h*lambda_x
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    inv_h = 1.0/h
    V_inv_h = V*inv_h
    lambda_x_sq = lambda_x*lambda_x
    V_sq = V*V
    lambda_y_sq = lambda_y*lambda_y
    w = V_sq*lambda_x_sq + V_sq*lambda_y_sq
    w_2 = np.minimum(1.0/smoothing, heading_reach/np.sqrt(np.maximum(w, 1e-300)))
    V_sq_w_2 = V_sq*w_2
    w_3 = -0.5*np.heaviside(np.sqrt(w) - smoothing*heading_reach, 0.0)*np.minimum(heading_reach, 1e100)/np.maximum(w*np.sqrt(w), 1e-200)
    w_4 = 2.0*V*V*V*V*w_3
    w_5 = -lambda_x*lambda_y*w_4
    out[0, 1] = -V_inv_h
    out[0, 2] = -V_sq_w_2 - lambda_x_sq*w_4
    out[0, 3] = w_5
    out[1, 2] = w_5
    out[1, 3] = -V_sq_w_2 - lambda_y_sq*w_4
    out[3, 2] = V_inv_h
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
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
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    given_x, given_y, on_reference_x, on_reference_y, target_x, target_y = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    V_sq = V*V
    w = V_sq*lambda_x*lambda_x
    w_2 = V_sq*lambda_y*lambda_y
    w_3 = w + w_2
    w_4 = np.minimum(1.0/smoothing, heading_reach/np.sqrt(np.maximum(w_3, 1e-300)))
    inv_h = 1.0/h
    w_4_sq = w_4*w_4
    out[0] = given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value
    out[1] = given_y*(y - target_y) + lambda_y*(1.0 - given_y - on_reference_y) + on_reference_y*y
    out[2] = 0.5*smoothing*(w*w_4_sq + w_2*w_4_sq) + 1.0 - V*inv_h*lambda_x*y - w*w_4 - w_2*w_4
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    x_value, y = x
    lambda_x, lambda_y = lam
    V, h = p
    heading_reach, smoothing = bounds
    given_x, given_y, on_reference_x, on_reference_y, target_x, target_y = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_x + on_reference_x
    w_2 = given_y + on_reference_y
    inv_h = 1.0/h
    V_inv_h = V*inv_h
    V_sq = V*V
    lambda_x_sq = lambda_x*lambda_x
    lambda_y_sq = lambda_y*lambda_y
    w_3 = V_sq*lambda_x_sq + V_sq*lambda_y_sq
    w_4 = np.minimum(1.0/smoothing, heading_reach/np.sqrt(np.maximum(w_3, 1e-300)))
    w_5 = -0.5*np.heaviside(np.sqrt(w_3) - smoothing*heading_reach, 0.0)*np.minimum(heading_reach, 1e100)/np.maximum(w_3*np.sqrt(w_3), 1e-200)
    w_6 = V*V*V*V*w_5
    twice_w_6 = 2.0*w_6
    lambda_x_lambda_y_sq = lambda_x*lambda_y_sq
    w_4_sq = w_4*w_4
    w_7 = 4.0*w_4*w_6
    twice_V_sq = 2.0*V_sq
    lambda_x_twice_V_sq = lambda_x*twice_V_sq
    lambda_x_cubed = lambda_x*lambda_x*lambda_x
    lambda_y_twice_V_sq = lambda_y*twice_V_sq
    lambda_y_cubed = lambda_y*lambda_y*lambda_y
    lambda_x_sq_lambda_y = lambda_x_sq*lambda_y
    out[0, 0] = w
    out[0, 2] = 1.0 - w
    out[1, 1] = w_2
    out[1, 3] = 1.0 - w_2
    out[2, 1] = -V_inv_h*lambda_x
    out[2, 2] = 0.5*smoothing*(lambda_x_cubed*w_7 + lambda_x_lambda_y_sq*w_7 + lambda_x_twice_V_sq*w_4_sq) - V_inv_h*y - lambda_x_cubed*twice_w_6 - lambda_x_lambda_y_sq*twice_w_6 - lambda_x_twice_V_sq*w_4
    out[2, 3] = 0.5*smoothing*(lambda_x_sq_lambda_y*w_7 + lambda_y_cubed*w_7 + lambda_y_twice_V_sq*w_4_sq) - lambda_x_sq_lambda_y*twice_w_6 - lambda_y_cubed*twice_w_6 - lambda_y_twice_V_sq*w_4
    return out
