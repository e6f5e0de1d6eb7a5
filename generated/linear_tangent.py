"""Minimum-time steering in a plane: the linear tangent law.

Written by satsym from derivations/examples/linear_tangent.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/linear_tangent.py
Source: ../derivations/examples/linear_tangent.py 7859caeb8e8d340b1f571b6bf3958cc4
Digest: 2873b26394b82e0a8b1911e4d7c3733a74e344c06cd32ead0efb173e96b34c35
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'linear_tangent',
    'title': 'Minimum-time steering in a plane: the linear tangent law',
    'source': 'derivations/examples/linear_tangent.py',
    'states': (
        {'symbol': 'x', 'latex': 'x', 'meaning': 'horizontal distance'},
        {'symbol': 'y', 'latex': 'y', 'meaning': 'height'},
        {'symbol': 'vx', 'latex': 'v_x', 'meaning': 'horizontal velocity'},
        {'symbol': 'vy', 'latex': 'v_y', 'meaning': 'vertical velocity'},
    ),
    'controls': (
        {'symbol': 'beta', 'latex': '\\beta', 'meaning': 'direction of the acceleration, above the horizontal', 'kind': 'angle'},
    ),
    'parameters': (
        {'symbol': 'a', 'latex': 'a', 'meaning': 'acceleration', 'default': 100.0, 'positive': True},
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
        {'name': 'steering', 'kind': 'angle', 'controls': ('beta',), 'branch': 'direction'},
    ),
    'objective_unit': '1',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x_value, y, vx, vy = x
    (beta,) = u
    (a,) = p
    return (
        vx,
        vy,
        a*math.cos(beta),
        a*math.sin(beta),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x_value, y, vx, vy = x
    (beta,) = u
    (a,) = p
    return (
        0.0,
        0.0,
        1.0,
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
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x_value, y, vx, vy = x
    (beta,) = u
    (a,) = p
    return (
        0.0,
        0.0,
        -a*math.sin(beta),
        a*math.cos(beta),
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x_value, y, vx, vy = x
    (beta,) = u
    (a,) = p
    return 1.0


def terminal_cost(t, x, p):
    """Terminal cost S."""
    x_value, y, vx, vy = x
    (a,) = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    x_value, y, vx, vy = x
    (a,) = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    x_value, y, vx, vy = x
    (beta,) = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    return a*lambda_vx*math.cos(beta) + a*lambda_vy*math.sin(beta) + lambda_x*vx + lambda_y*vy + 1.0


def stationarity(t, x, u, lam, p):
    """H_u."""
    x_value, y, vx, vy = x
    (beta,) = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    return (
        a*(lambda_vy*math.cos(beta) - lambda_vx*math.sin(beta)),
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    x_value, y, vx, vy = x
    (beta,) = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    return (
        a*(-lambda_vx*math.cos(beta) - lambda_vy*math.sin(beta)),
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    return (
        math.atan2(-a*lambda_vy, -a*lambda_vx),
    )


def regularised_cost(t, x, lam, p, bounds):
    """Integrand of the cost of the regularised problem."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    a_sq = a*a
    w = a_sq*lambda_vx*lambda_vx
    w_2 = a_sq*lambda_vy*lambda_vy
    w_3 = w + w_2
    w_4 = beta_reach/math.sqrt(w_3) if w_3 > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    w_4_sq = w_4*w_4
    return 0.5*smoothing*(w*w_4_sq + w_2*w_4_sq) + 1.0


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x_value, y, vx, vy = x
    (beta,) = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    return (
        0.0,
        0.0,
        -lambda_x,
        -lambda_y,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    a_sq = a*a
    w = a_sq*lambda_vx*lambda_vx + a_sq*lambda_vy*lambda_vy
    w_2 = beta_reach/math.sqrt(w) if w > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    a_sq_w_2 = a_sq*w_2
    return (
        vx,
        vy,
        -a_sq_w_2*lambda_vx,
        -a_sq_w_2*lambda_vy,
        0.0,
        0.0,
        -lambda_x,
        -lambda_y,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    lambda_vx_sq = lambda_vx*lambda_vx
    a_sq = a*a
    lambda_vy_sq = lambda_vy*lambda_vy
    w = a_sq*lambda_vx_sq + a_sq*lambda_vy_sq
    w_2 = beta_reach/math.sqrt(w) if w > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    a_sq_w_2 = a_sq*w_2
    w_3 = -0.5*beta_reach/(w*math.sqrt(w)) if w > smoothing*beta_reach*(smoothing*beta_reach) else 0.0
    w_4 = 2.0*a*a*a*a*w_3
    w_5 = -lambda_vx*lambda_vy*w_4
    return (
        0.0,
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
        -a_sq_w_2 - lambda_vx_sq*w_4,
        w_5,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_5,
        -a_sq_w_2 - lambda_vy_sq*w_4,
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
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
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
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    given_x, given_y, given_vx, given_vy, on_reference_x, on_reference_y, on_reference_vx, on_reference_vy, target_x, target_y, target_vx, target_vy = final
    a_sq = a*a
    w = a_sq*lambda_vx*lambda_vx
    w_2 = a_sq*lambda_vy*lambda_vy
    w_3 = w + w_2
    w_4 = beta_reach/math.sqrt(w_3) if w_3 > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    w_4_sq = w_4*w_4
    return (
        given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value,
        given_y*(y - target_y) + lambda_y*(1.0 - given_y - on_reference_y) + on_reference_y*y,
        given_vx*(vx - target_vx) + lambda_vx*(1.0 - given_vx - on_reference_vx) + on_reference_vx*vx,
        given_vy*(vy - target_vy) + lambda_vy*(1.0 - given_vy - on_reference_vy) + on_reference_vy*vy,
        lambda_x*vx + lambda_y*vy + 0.5*smoothing*(w*w_4_sq + w_2*w_4_sq) + 1.0 - w*w_4 - w_2*w_4,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    given_x, given_y, given_vx, given_vy, on_reference_x, on_reference_y, on_reference_vx, on_reference_vy, target_x, target_y, target_vx, target_vy = final
    w = given_x + on_reference_x
    w_2 = given_y + on_reference_y
    w_3 = given_vx + on_reference_vx
    w_4 = given_vy + on_reference_vy
    a_sq = a*a
    lambda_vx_sq = lambda_vx*lambda_vx
    lambda_vy_sq = lambda_vy*lambda_vy
    w_5 = a_sq*lambda_vx_sq + a_sq*lambda_vy_sq
    w_6 = beta_reach/math.sqrt(w_5) if w_5 > smoothing*beta_reach*(smoothing*beta_reach) else 1.0/smoothing
    w_7 = -0.5*beta_reach/(w_5*math.sqrt(w_5)) if w_5 > smoothing*beta_reach*(smoothing*beta_reach) else 0.0
    w_8 = a*a*a*a*w_7
    twice_w_8 = 2.0*w_8
    lambda_vx_lambda_vy_sq = lambda_vx*lambda_vy_sq
    w_6_sq = w_6*w_6
    w_9 = 4.0*w_6*w_8
    twice_a_sq = 2.0*a_sq
    lambda_vx_twice_a_sq = lambda_vx*twice_a_sq
    lambda_vx_cubed = lambda_vx*lambda_vx*lambda_vx
    lambda_vy_twice_a_sq = lambda_vy*twice_a_sq
    lambda_vy_cubed = lambda_vy*lambda_vy*lambda_vy
    lambda_vx_sq_lambda_vy = lambda_vx_sq*lambda_vy
    return (
        w,
        0.0,
        0.0,
        0.0,
        1.0 - w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_2,
        0.0,
        0.0,
        0.0,
        1.0 - w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        0.0,
        0.0,
        0.0,
        1.0 - w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_4,
        0.0,
        0.0,
        0.0,
        1.0 - w_4,
        0.0,
        0.0,
        0.0,
        lambda_x,
        lambda_y,
        vx,
        vy,
        0.5*smoothing*(lambda_vx_cubed*w_9 + lambda_vx_lambda_vy_sq*w_9 + lambda_vx_twice_a_sq*w_6_sq) - lambda_vx_cubed*twice_w_8 - lambda_vx_lambda_vy_sq*twice_w_8 - lambda_vx_twice_a_sq*w_6,
        0.5*smoothing*(lambda_vx_sq_lambda_vy*w_9 + lambda_vy_cubed*w_9 + lambda_vy_twice_a_sq*w_6_sq) - lambda_vx_sq_lambda_vy*twice_w_8 - lambda_vy_cubed*twice_w_8 - lambda_vy_twice_a_sq*w_6,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    (a,) = p
    x_value_at, y_at, vx_at, vy_at = x
    x_value_mid, y_mid, vx_mid, vy_mid = x_mid
    (beta_at,) = u
    (beta_mid,) = u_mid
    x_value, y, vx, vy = x0
    steps = len(times) - 1
    t = times[0]
    x_value_at[0] = x_value
    y_at[0] = y
    vx_at[0] = vx
    vy_at[0] = vy
    beta = beta_at[0]
    slope_vx = a*math.cos(beta)
    slope_vy = a*math.sin(beta)
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x_value_at[i] = x_value
        y_at[i] = y
        vx_at[i] = vx
        vy_at[i] = vy
        beta_half = beta_mid[i]
        beta_end = beta_at[i + 1]
        sixth = (1.0/6.0)*h
        k2_vx = a*math.cos(beta_half)
        k2_vy = a*math.sin(beta_half)
        k4_vx = a*math.cos(beta_end)
        k4_vy = a*math.sin(beta_end)
        k23_vx = 2.0*k2_vx
        k123_vx = k23_vx + slope_vx
        k23_vy = 2.0*k2_vy
        k123_vy = k23_vy + slope_vy
        x_value_end = h*(k123_vx*sixth + vx) + x_value
        y_end = h*(k123_vy*sixth + vy) + y
        vx_end = sixth*(k123_vx + k23_vx + k4_vx) + vx
        vy_end = sixth*(k123_vy + k23_vy + k4_vy) + vy
        eighth = 0.125*h
        x_value_mid[i] = eighth*(vx - vx_end) + 0.5*(x_value + x_value_end)
        y_mid[i] = eighth*(vy - vy_end) + 0.5*(y + y_end)
        vx_mid[i] = eighth*(slope_vx - k4_vx) + 0.5*(vx + vx_end)
        vy_mid[i] = eighth*(slope_vy - k4_vy) + 0.5*(vy + vy_end)
        total = 6.0*sixth + total
        t = t_end
        x_value = x_value_end
        y = y_end
        vx = vx_end
        vy = vy_end
        slope_vx = k4_vx
        slope_vy = k4_vy
    x_value_at[steps] = x_value
    y_at[steps] = y
    vx_at[steps] = vx
    vy_at[steps] = vy
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    (a,) = p
    lambda_x_at, lambda_y_at, lambda_vx_at, lambda_vy_at = lam
    lambda_x_mid, lambda_y_mid, lambda_vx_mid, lambda_vy_mid = lam_mid
    x_value_at, y_at, vx_at, vy_at = x
    (beta_at,) = u
    x_value_mid, y_mid, vx_mid, vy_mid = x_mid
    (beta_mid,) = u_mid
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam_f
    steps = len(times) - 1
    t = times[steps]
    lambda_x_at[steps] = lambda_x
    lambda_y_at[steps] = lambda_y
    lambda_vx_at[steps] = lambda_vx
    lambda_vy_at[steps] = lambda_vy
    slope_lambda_vx = -lambda_x
    slope_lambda_vy = -lambda_y
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        sixth = (1.0/6.0)*h
        k2_lambda_vx = -lambda_x
        k2_lambda_vy = -lambda_y
        lambda_vx_end = lambda_vx + sixth*(5.0*k2_lambda_vx + slope_lambda_vx)
        lambda_vy_end = lambda_vy + sixth*(5.0*k2_lambda_vy + slope_lambda_vy)
        eighth = 0.125*h
        lambda_x_mid[i] = lambda_x
        lambda_x_at[i] = lambda_x
        lambda_y_mid[i] = lambda_y
        lambda_y_at[i] = lambda_y
        lambda_vx_mid[i] = eighth*(slope_lambda_vx - k2_lambda_vx) + 0.5*(lambda_vx + lambda_vx_end)
        lambda_vx_at[i] = lambda_vx_end
        lambda_vy_mid[i] = eighth*(slope_lambda_vy - k2_lambda_vy) + 0.5*(lambda_vy + lambda_vy_end)
        lambda_vy_at[i] = lambda_vy_end
        t = t_end
        lambda_vx = lambda_vx_end
        lambda_vy = lambda_vy_end
        slope_lambda_vx = k2_lambda_vx
        slope_lambda_vy = k2_lambda_vy


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x_value, y, vx, vy = x
    (beta,) = u
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))
    out[0] = vx
    out[1] = vy
    out[2] = a*np.cos(beta)
    out[3] = a*np.sin(beta)
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x_value, y, vx, vy = x
    (beta,) = u
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[0, 2] = 1.0
    out[1, 3] = 1.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x_value, y, vx, vy = x
    (beta,) = u
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 0.0
    out[1, 0] = 0.0
    out[2, 0] = -a*np.sin(beta)
    out[3, 0] = a*np.cos(beta)
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x_value, y, vx, vy = x
    (beta,) = u
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 1.0
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    x_value, y, vx, vy = x
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    x_value, y, vx, vy = x
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    x_value, y, vx, vy = x
    (beta,) = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    out[...] = a*lambda_vx*np.cos(beta) + a*lambda_vy*np.sin(beta) + lambda_x*vx + lambda_y*vy + 1.0
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    x_value, y, vx, vy = x
    (beta,) = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = a*(lambda_vy*np.cos(beta) - lambda_vx*np.sin(beta))
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    x_value, y, vx, vy = x
    (beta,) = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = a*(-lambda_vx*np.cos(beta) - lambda_vy*np.sin(beta))
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = np.arctan2(-a*lambda_vy, -a*lambda_vx)
    return out


def regularised_cost_batch(t, x, lam, p, bounds, out=None):
    """Integrand of the cost of the regularised problem. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, lam, *p, *bounds))
    a_sq = a*a
    w = a_sq*lambda_vx*lambda_vx
    w_2 = a_sq*lambda_vy*lambda_vy
    w_3 = w + w_2
    w_4 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w_3, 1e-300)))
    w_4_sq = w_4*w_4
    out[...] = 0.5*smoothing*(w*w_4_sq + w_2*w_4_sq) + 1.0
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x_value, y, vx, vy = x
    (beta,) = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = -lambda_x
    out[3] = -lambda_y
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    a_sq = a*a
    w = a_sq*lambda_vx*lambda_vx + a_sq*lambda_vy*lambda_vy
    w_2 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w, 1e-300)))
    a_sq_w_2 = a_sq*w_2
    out[0] = vx
    out[1] = vy
    out[2] = -a_sq_w_2*lambda_vx
    out[3] = -a_sq_w_2*lambda_vy
    out[4] = 0.0
    out[5] = 0.0
    out[6] = -lambda_x
    out[7] = -lambda_y
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, 8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    lambda_vx_sq = lambda_vx*lambda_vx
    a_sq = a*a
    lambda_vy_sq = lambda_vy*lambda_vy
    w = a_sq*lambda_vx_sq + a_sq*lambda_vy_sq
    w_2 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w, 1e-300)))
    a_sq_w_2 = a_sq*w_2
    w_3 = -0.5*np.heaviside(np.sqrt(w) - smoothing*beta_reach, 0.0)*np.minimum(beta_reach, 1e100)/np.maximum(w*np.sqrt(w), 1e-200)
    w_4 = 2.0*a*a*a*a*w_3
    w_5 = -lambda_vx*lambda_vy*w_4
    out[0, 2] = 1.0
    out[1, 3] = 1.0
    out[2, 6] = -a_sq_w_2 - lambda_vx_sq*w_4
    out[2, 7] = w_5
    out[3, 6] = w_5
    out[3, 7] = -a_sq_w_2 - lambda_vy_sq*w_4
    out[6, 4] = -1.0
    out[7, 5] = -1.0
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = 0.0
    out[7] = 0.0
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    given_x, given_y, given_vx, given_vy, on_reference_x, on_reference_y, on_reference_vx, on_reference_vy, target_x, target_y, target_vx, target_vy = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    a_sq = a*a
    w = a_sq*lambda_vx*lambda_vx
    w_2 = a_sq*lambda_vy*lambda_vy
    w_3 = w + w_2
    w_4 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w_3, 1e-300)))
    w_4_sq = w_4*w_4
    out[0] = given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value
    out[1] = given_y*(y - target_y) + lambda_y*(1.0 - given_y - on_reference_y) + on_reference_y*y
    out[2] = given_vx*(vx - target_vx) + lambda_vx*(1.0 - given_vx - on_reference_vx) + on_reference_vx*vx
    out[3] = given_vy*(vy - target_vy) + lambda_vy*(1.0 - given_vy - on_reference_vy) + on_reference_vy*vy
    out[4] = lambda_x*vx + lambda_y*vy + 0.5*smoothing*(w*w_4_sq + w_2*w_4_sq) + 1.0 - w*w_4 - w_2*w_4
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    (a,) = p
    beta_reach, smoothing = bounds
    given_x, given_y, given_vx, given_vy, on_reference_x, on_reference_y, on_reference_vx, on_reference_vy, target_x, target_y, target_vx, target_vy = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, 9, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_x + on_reference_x
    w_2 = given_y + on_reference_y
    w_3 = given_vx + on_reference_vx
    w_4 = given_vy + on_reference_vy
    a_sq = a*a
    lambda_vx_sq = lambda_vx*lambda_vx
    lambda_vy_sq = lambda_vy*lambda_vy
    w_5 = a_sq*lambda_vx_sq + a_sq*lambda_vy_sq
    w_6 = np.minimum(1.0/smoothing, beta_reach/np.sqrt(np.maximum(w_5, 1e-300)))
    w_7 = -0.5*np.heaviside(np.sqrt(w_5) - smoothing*beta_reach, 0.0)*np.minimum(beta_reach, 1e100)/np.maximum(w_5*np.sqrt(w_5), 1e-200)
    w_8 = a*a*a*a*w_7
    twice_w_8 = 2.0*w_8
    lambda_vx_lambda_vy_sq = lambda_vx*lambda_vy_sq
    w_6_sq = w_6*w_6
    w_9 = 4.0*w_6*w_8
    twice_a_sq = 2.0*a_sq
    lambda_vx_twice_a_sq = lambda_vx*twice_a_sq
    lambda_vx_cubed = lambda_vx*lambda_vx*lambda_vx
    lambda_vy_twice_a_sq = lambda_vy*twice_a_sq
    lambda_vy_cubed = lambda_vy*lambda_vy*lambda_vy
    lambda_vx_sq_lambda_vy = lambda_vx_sq*lambda_vy
    out[0, 0] = w
    out[0, 4] = 1.0 - w
    out[1, 1] = w_2
    out[1, 5] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 6] = 1.0 - w_3
    out[3, 3] = w_4
    out[3, 7] = 1.0 - w_4
    out[4, 2] = lambda_x
    out[4, 3] = lambda_y
    out[4, 4] = vx
    out[4, 5] = vy
    out[4, 6] = 0.5*smoothing*(lambda_vx_cubed*w_9 + lambda_vx_lambda_vy_sq*w_9 + lambda_vx_twice_a_sq*w_6_sq) - lambda_vx_cubed*twice_w_8 - lambda_vx_lambda_vy_sq*twice_w_8 - lambda_vx_twice_a_sq*w_6
    out[4, 7] = 0.5*smoothing*(lambda_vx_sq_lambda_vy*w_9 + lambda_vy_cubed*w_9 + lambda_vy_twice_a_sq*w_6_sq) - lambda_vx_sq_lambda_vy*twice_w_8 - lambda_vy_cubed*twice_w_8 - lambda_vy_twice_a_sq*w_6
    return out
