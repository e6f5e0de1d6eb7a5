"""Hanging chain of given length.

Written by satsym from derivations/examples/chain.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/chain.py
Source: ../derivations/examples/chain.py b423c1ad38d81e10864f6403217460f2
Digest: db0de7a971e663cc609ace160e91b614609e4e36dfa39d7566e30b61a5215d7e
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'chain',
    'title': 'Hanging chain of given length',
    'source': 'derivations/examples/chain.py',
    'states': (
        {'symbol': 'height', 'latex': 'y', 'meaning': 'height at the horizontal distance t'},
        {'symbol': 'length', 'latex': 's', 'meaning': 'arc length up to this point'},
    ),
    'controls': (
        {'symbol': 'slope', 'latex': 'u', 'meaning': 'slope of the chain'},
    ),
    'parameters': (),
    'control_set': 'product',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'control_parts': (
        {'name': 'control', 'kind': 'free', 'controls': ('slope',), 'branch': 'stationary'},
    ),
    'objective_unit': '1',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    height, length = x
    (slope,) = u
    w = slope*slope + 1.0
    sqrt_w = math.sqrt(w)
    return (
        slope,
        sqrt_w,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    height, length = x
    (slope,) = u
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    height, length = x
    (slope,) = u
    w = slope*slope + 1.0
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    return (
        1.0,
        inv_sqrt_w*slope,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    height, length = x
    (slope,) = u
    w = slope*slope + 1.0
    sqrt_w = math.sqrt(w)
    return height*sqrt_w


def terminal_cost(t, x, p):
    """Terminal cost S."""
    height, length = x
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    height, length = x
    return (
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    height, length = x
    (slope,) = u
    lambda_height, lambda_length = lam
    w = slope*slope + 1.0
    sqrt_w = math.sqrt(w)
    return height*sqrt_w + lambda_height*slope + lambda_length*sqrt_w


def stationarity(t, x, u, lam, p):
    """H_u."""
    height, length = x
    (slope,) = u
    lambda_height, lambda_length = lam
    w = slope*slope + 1.0
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    return (
        inv_sqrt_w*slope*(height + lambda_length) + lambda_height,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    height, length = x
    (slope,) = u
    lambda_height, lambda_length = lam
    slope_sq = slope*slope
    w = slope_sq + 1.0
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = height + lambda_length
    return (
        inv_sqrt_w*w_2 - inv_sqrt_w*inv_sqrt_w*inv_sqrt_w*slope_sq*w_2,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    height, length = x
    lambda_height, lambda_length = lam
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    law_part_2 = inv_law_part_1*inv_law_part_1*lambda_height*lambda_height - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w = -inv_law_part_2
    sqrt_w = math.sqrt(w)
    w_2 = -inv_law_part_1*lambda_height*sqrt_w
    w_3 = law_part_1*law_part_2*law_part_2*sqrt_w
    w_4 = w_2 + 0.0*math.sqrt(w_3)
    return (
        w_4,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    height, length = x
    (slope,) = u
    lambda_height, lambda_length = lam
    w = slope*slope + 1.0
    sqrt_w = math.sqrt(w)
    return (
        -sqrt_w,
        0.0,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    height, length = x
    lambda_height, lambda_length = lam
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    law_part_2 = inv_law_part_1*inv_law_part_1*lambda_height*lambda_height - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w = -inv_law_part_2
    sqrt_w = math.sqrt(w)
    w_2 = -inv_law_part_1*lambda_height*sqrt_w
    w_3 = law_part_1*law_part_2*law_part_2*sqrt_w
    w_4 = w_2 + 0.0*math.sqrt(w_3)
    w_5 = w_4*w_4 + 1.0
    sqrt_w_5 = math.sqrt(w_5)
    return (
        w_4,
        sqrt_w_5,
        -sqrt_w_5,
        0.0,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    height, length = x
    lambda_height, lambda_length = lam
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    w = inv_law_part_1*lambda_height
    inv_law_part_1_sq = inv_law_part_1*inv_law_part_1
    w_2 = inv_law_part_1_sq*lambda_height
    lambda_height_sq = lambda_height*lambda_height
    law_part_2 = inv_law_part_1_sq*lambda_height_sq - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w_3 = -inv_law_part_2
    sqrt_w_3 = math.sqrt(w_3)
    sqrt_w_3_w_2 = sqrt_w_3*w_2
    w_4 = 0.5*inv_law_part_2*sqrt_w_3
    w_5 = -2.0*inv_law_part_1*inv_law_part_1*inv_law_part_1*lambda_height_sq
    d_law_part_3_by_height = -w_4*w_5
    d_law_of_slope_by_height = sqrt_w_3_w_2 - d_law_part_3_by_height*w
    inv_law_part_1_sqrt_w_3 = inv_law_part_1*sqrt_w_3
    d_law_part_2_by_lambda_height = 2.0*w_2
    d_law_part_3_by_lambda_height = -d_law_part_2_by_lambda_height*w_4
    d_law_of_slope_by_lambda_height = -d_law_part_3_by_lambda_height*w - inv_law_part_1_sqrt_w_3
    w_6 = -inv_law_part_1_sqrt_w_3*lambda_height
    w_7 = law_part_1*law_part_2*law_part_2*sqrt_w_3
    w_8 = w_6 + 0.0*math.sqrt(w_7)
    w_9 = w_8*w_8 + 1.0
    sqrt_w_9 = math.sqrt(w_9)
    inv_sqrt_w_9 = 1.0/sqrt_w_9
    inv_sqrt_w_9_w_8 = inv_sqrt_w_9*w_8
    w_10 = d_law_of_slope_by_height*inv_sqrt_w_9_w_8
    w_11 = d_law_of_slope_by_lambda_height*inv_sqrt_w_9_w_8
    return (
        d_law_of_slope_by_height,
        0.0,
        d_law_of_slope_by_lambda_height,
        d_law_of_slope_by_height,
        w_10,
        0.0,
        w_11,
        w_10,
        -w_10,
        0.0,
        -w_11,
        -w_10,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    height, length = x
    lambda_height, lambda_length = lam
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    height, length = x
    lambda_height, lambda_length = lam
    given_height, given_length, on_reference_height, on_reference_length, target_height, target_length = final
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    law_part_2 = inv_law_part_1*inv_law_part_1*lambda_height*lambda_height - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w = -inv_law_part_2
    sqrt_w = math.sqrt(w)
    w_2 = -inv_law_part_1*lambda_height*sqrt_w
    w_3 = law_part_1*law_part_2*law_part_2*sqrt_w
    w_4 = w_2 + 0.0*math.sqrt(w_3)
    w_5 = w_4*w_4 + 1.0
    sqrt_w_5 = math.sqrt(w_5)
    return (
        given_height*(height - target_height) + height*on_reference_height + lambda_height*(1.0 - given_height - on_reference_height),
        given_length*(length - target_length) + lambda_length*(1.0 - given_length - on_reference_length) + length*on_reference_length,
        height*sqrt_w_5 + lambda_height*w_4 + lambda_length*sqrt_w_5,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    height, length = x
    lambda_height, lambda_length = lam
    given_height, given_length, on_reference_height, on_reference_length, target_height, target_length = final
    w = given_height + on_reference_height
    w_2 = given_length + on_reference_length
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    inv_law_part_1_sq = inv_law_part_1*inv_law_part_1
    lambda_height_sq = lambda_height*lambda_height
    law_part_2 = inv_law_part_1_sq*lambda_height_sq - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w_3 = -inv_law_part_2
    sqrt_w_3 = math.sqrt(w_3)
    inv_law_part_1_sqrt_w_3 = inv_law_part_1*sqrt_w_3
    w_4 = -inv_law_part_1_sqrt_w_3*lambda_height
    w_5 = law_part_1*law_part_2*law_part_2*sqrt_w_3
    w_6 = w_4 + 0.0*math.sqrt(w_5)
    w_7 = w_6*w_6 + 1.0
    sqrt_w_7 = math.sqrt(w_7)
    inv_sqrt_w_7 = 1.0/sqrt_w_7
    inv_sqrt_w_7_w_6 = inv_sqrt_w_7*w_6
    w_8 = height*inv_sqrt_w_7_w_6 + inv_sqrt_w_7_w_6*lambda_length + lambda_height
    w_9 = inv_law_part_1*lambda_height
    w_10 = inv_law_part_1_sq*lambda_height
    sqrt_w_3_w_10 = sqrt_w_3*w_10
    w_11 = 0.5*inv_law_part_2*sqrt_w_3
    w_12 = -2.0*inv_law_part_1*inv_law_part_1*inv_law_part_1*lambda_height_sq
    d_law_part_3_by_height = -w_11*w_12
    d_law_of_slope_by_height = sqrt_w_3_w_10 - d_law_part_3_by_height*w_9
    d_law_part_2_by_lambda_height = 2.0*w_10
    d_law_part_3_by_lambda_height = -d_law_part_2_by_lambda_height*w_11
    d_law_of_slope_by_lambda_height = -d_law_part_3_by_lambda_height*w_9 - inv_law_part_1_sqrt_w_3
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
        d_law_of_slope_by_height*w_8 + sqrt_w_7,
        0.0,
        d_law_of_slope_by_lambda_height*w_8 + w_6,
        d_law_of_slope_by_height*w_8 + sqrt_w_7,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    height_at, length_at = x
    height_mid, length_mid = x_mid
    (slope_at,) = u
    (slope_mid,) = u_mid
    height, length = x0
    steps = len(times) - 1
    t = times[0]
    height_at[0] = height
    length_at[0] = length
    slope = slope_at[0]
    w = slope*slope + 1.0
    sqrt_w = math.sqrt(w)
    slope_height = slope
    slope_length = sqrt_w
    slope_total = height*sqrt_w
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        height_at[i] = height
        length_at[i] = length
        slope_half = slope_mid[i]
        slope_end = slope_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        height_2 = half*slope_height + height
        w_2 = slope_half*slope_half + 1.0
        k2_length = math.sqrt(w_2)
        k2_total = height_2*k2_length
        height_3 = half*slope_half + height
        k3_total = height_3*k2_length
        height_4 = h*slope_half + height
        w_3 = slope_end*slope_end + 1.0
        k4_length = math.sqrt(w_3)
        k4_total = height_4*k4_length
        height_end = height + sixth*(slope_end + 4.0*slope_half + slope_height)
        length_end = length + sixth*(4.0*k2_length + k4_length + slope_length)
        slope_end_total = height_end*k4_length
        eighth = 0.125*h
        height_mid[i] = eighth*(slope_height - slope_end) + 0.5*(height + height_end)
        length_mid[i] = eighth*(slope_length - k4_length) + 0.5*(length + length_end)
        total = sixth*(k4_total + slope_total + 2.0*(k2_total + k3_total)) + total
        t = t_end
        height = height_end
        length = length_end
        slope_height = slope_end
        slope_length = k4_length
        slope_total = slope_end_total
    height_at[steps] = height
    length_at[steps] = length
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    lambda_height_at, lambda_length_at = lam
    lambda_height_mid, lambda_length_mid = lam_mid
    height_at, length_at = x
    (slope_at,) = u
    height_mid, length_mid = x_mid
    (slope_mid,) = u_mid
    lambda_height, lambda_length = lam_f
    steps = len(times) - 1
    t = times[steps]
    lambda_height_at[steps] = lambda_height
    lambda_length_at[steps] = lambda_length
    slope = slope_at[steps]
    w = slope*slope + 1.0
    sqrt_w = math.sqrt(w)
    slope_lambda_height = -sqrt_w
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        slope_half = slope_mid[i]
        slope_end = slope_at[i]
        sixth = (1.0/6.0)*h
        w_2 = slope_half*slope_half + 1.0
        sqrt_w_2 = math.sqrt(w_2)
        k2_lambda_height = -sqrt_w_2
        w_3 = slope_end*slope_end + 1.0
        sqrt_w_3 = math.sqrt(w_3)
        k4_lambda_height = -sqrt_w_3
        lambda_height_end = lambda_height + sixth*(4.0*k2_lambda_height + k4_lambda_height + slope_lambda_height)
        eighth = 0.125*h
        lambda_height_mid[i] = eighth*(slope_lambda_height - k4_lambda_height) + 0.5*(lambda_height + lambda_height_end)
        lambda_height_at[i] = lambda_height_end
        lambda_length_mid[i] = lambda_length
        lambda_length_at[i] = lambda_length
        t = t_end
        lambda_height = lambda_height_end
        slope_lambda_height = k4_lambda_height


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    height, length = x
    (slope,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    w = slope*slope + 1.0
    sqrt_w = np.sqrt(w)
    out[0] = slope
    out[1] = sqrt_w
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    height, length = x
    (slope,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    height, length = x
    (slope,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    w = slope*slope + 1.0
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    out[0, 0] = 1.0
    out[1, 0] = inv_sqrt_w*slope
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    height, length = x
    (slope,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    w = slope*slope + 1.0
    sqrt_w = np.sqrt(w)
    out[...] = height*sqrt_w
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    height, length = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    height, length = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    height, length = x
    (slope,) = u
    lambda_height, lambda_length = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    w = slope*slope + 1.0
    sqrt_w = np.sqrt(w)
    out[...] = height*sqrt_w + lambda_height*slope + lambda_length*sqrt_w
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    height, length = x
    (slope,) = u
    lambda_height, lambda_length = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    w = slope*slope + 1.0
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    out[0] = inv_sqrt_w*slope*(height + lambda_length) + lambda_height
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    height, length = x
    (slope,) = u
    lambda_height, lambda_length = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    slope_sq = slope*slope
    w = slope_sq + 1.0
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = height + lambda_length
    out[0, 0] = inv_sqrt_w*w_2 - inv_sqrt_w*inv_sqrt_w*inv_sqrt_w*slope_sq*w_2
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    height, length = x
    lambda_height, lambda_length = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    law_part_2 = inv_law_part_1*inv_law_part_1*lambda_height*lambda_height - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w = -inv_law_part_2
    sqrt_w = np.sqrt(w)
    w_2 = -inv_law_part_1*lambda_height*sqrt_w
    w_3 = law_part_1*law_part_2*law_part_2*sqrt_w
    w_4 = w_2 + 0.0*np.sqrt(w_3)
    out[0] = w_4
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    height, length = x
    (slope,) = u
    lambda_height, lambda_length = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    w = slope*slope + 1.0
    sqrt_w = np.sqrt(w)
    out[0] = -sqrt_w
    out[1] = 0.0
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    height, length = x
    lambda_height, lambda_length = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    law_part_2 = inv_law_part_1*inv_law_part_1*lambda_height*lambda_height - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w = -inv_law_part_2
    sqrt_w = np.sqrt(w)
    w_2 = -inv_law_part_1*lambda_height*sqrt_w
    w_3 = law_part_1*law_part_2*law_part_2*sqrt_w
    w_4 = w_2 + 0.0*np.sqrt(w_3)
    w_5 = w_4*w_4 + 1.0
    sqrt_w_5 = np.sqrt(w_5)
    out[0] = w_4
    out[1] = sqrt_w_5
    out[2] = -sqrt_w_5
    out[3] = 0.0
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    height, length = x
    lambda_height, lambda_length = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    w = inv_law_part_1*lambda_height
    inv_law_part_1_sq = inv_law_part_1*inv_law_part_1
    w_2 = inv_law_part_1_sq*lambda_height
    lambda_height_sq = lambda_height*lambda_height
    law_part_2 = inv_law_part_1_sq*lambda_height_sq - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w_3 = -inv_law_part_2
    sqrt_w_3 = np.sqrt(w_3)
    sqrt_w_3_w_2 = sqrt_w_3*w_2
    w_4 = 0.5*inv_law_part_2*sqrt_w_3
    w_5 = -2.0*inv_law_part_1*inv_law_part_1*inv_law_part_1*lambda_height_sq
    d_law_part_3_by_height = -w_4*w_5
    d_law_of_slope_by_height = sqrt_w_3_w_2 - d_law_part_3_by_height*w
    inv_law_part_1_sqrt_w_3 = inv_law_part_1*sqrt_w_3
    d_law_part_2_by_lambda_height = 2.0*w_2
    d_law_part_3_by_lambda_height = -d_law_part_2_by_lambda_height*w_4
    d_law_of_slope_by_lambda_height = -d_law_part_3_by_lambda_height*w - inv_law_part_1_sqrt_w_3
    w_6 = -inv_law_part_1_sqrt_w_3*lambda_height
    w_7 = law_part_1*law_part_2*law_part_2*sqrt_w_3
    w_8 = w_6 + 0.0*np.sqrt(w_7)
    w_9 = w_8*w_8 + 1.0
    sqrt_w_9 = np.sqrt(w_9)
    inv_sqrt_w_9 = 1.0/sqrt_w_9
    inv_sqrt_w_9_w_8 = inv_sqrt_w_9*w_8
    w_10 = d_law_of_slope_by_height*inv_sqrt_w_9_w_8
    w_11 = d_law_of_slope_by_lambda_height*inv_sqrt_w_9_w_8
    out[0, 0] = d_law_of_slope_by_height
    out[0, 1] = 0.0
    out[0, 2] = d_law_of_slope_by_lambda_height
    out[0, 3] = d_law_of_slope_by_height
    out[1, 0] = w_10
    out[1, 1] = 0.0
    out[1, 2] = w_11
    out[1, 3] = w_10
    out[2, 0] = -w_10
    out[2, 1] = 0.0
    out[2, 2] = -w_11
    out[2, 3] = -w_10
    out[3, 0] = 0.0
    out[3, 1] = 0.0
    out[3, 2] = 0.0
    out[3, 3] = 0.0
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    height, length = x
    lambda_height, lambda_length = lam
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
    height, length = x
    lambda_height, lambda_length = lam
    given_height, given_length, on_reference_height, on_reference_length, target_height, target_length = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    law_part_2 = inv_law_part_1*inv_law_part_1*lambda_height*lambda_height - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w = -inv_law_part_2
    sqrt_w = np.sqrt(w)
    w_2 = -inv_law_part_1*lambda_height*sqrt_w
    w_3 = law_part_1*law_part_2*law_part_2*sqrt_w
    w_4 = w_2 + 0.0*np.sqrt(w_3)
    w_5 = w_4*w_4 + 1.0
    sqrt_w_5 = np.sqrt(w_5)
    out[0] = given_height*(height - target_height) + height*on_reference_height + lambda_height*(1.0 - given_height - on_reference_height)
    out[1] = given_length*(length - target_length) + lambda_length*(1.0 - given_length - on_reference_length) + length*on_reference_length
    out[2] = height*sqrt_w_5 + lambda_height*w_4 + lambda_length*sqrt_w_5
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    height, length = x
    lambda_height, lambda_length = lam
    given_height, given_length, on_reference_height, on_reference_length, target_height, target_length = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_height + on_reference_height
    w_2 = given_length + on_reference_length
    law_part_1 = height + lambda_length
    inv_law_part_1 = 1.0/law_part_1
    inv_law_part_1_sq = inv_law_part_1*inv_law_part_1
    lambda_height_sq = lambda_height*lambda_height
    law_part_2 = inv_law_part_1_sq*lambda_height_sq - 1.0
    inv_law_part_2 = 1.0/law_part_2
    w_3 = -inv_law_part_2
    sqrt_w_3 = np.sqrt(w_3)
    inv_law_part_1_sqrt_w_3 = inv_law_part_1*sqrt_w_3
    w_4 = -inv_law_part_1_sqrt_w_3*lambda_height
    w_5 = law_part_1*law_part_2*law_part_2*sqrt_w_3
    w_6 = w_4 + 0.0*np.sqrt(w_5)
    w_7 = w_6*w_6 + 1.0
    sqrt_w_7 = np.sqrt(w_7)
    inv_sqrt_w_7 = 1.0/sqrt_w_7
    inv_sqrt_w_7_w_6 = inv_sqrt_w_7*w_6
    w_8 = height*inv_sqrt_w_7_w_6 + inv_sqrt_w_7_w_6*lambda_length + lambda_height
    w_9 = inv_law_part_1*lambda_height
    w_10 = inv_law_part_1_sq*lambda_height
    sqrt_w_3_w_10 = sqrt_w_3*w_10
    w_11 = 0.5*inv_law_part_2*sqrt_w_3
    w_12 = -2.0*inv_law_part_1*inv_law_part_1*inv_law_part_1*lambda_height_sq
    d_law_part_3_by_height = -w_11*w_12
    d_law_of_slope_by_height = sqrt_w_3_w_10 - d_law_part_3_by_height*w_9
    d_law_part_2_by_lambda_height = 2.0*w_10
    d_law_part_3_by_lambda_height = -d_law_part_2_by_lambda_height*w_11
    d_law_of_slope_by_lambda_height = -d_law_part_3_by_lambda_height*w_9 - inv_law_part_1_sqrt_w_3
    out[0, 0] = w
    out[0, 2] = 1.0 - w
    out[1, 1] = w_2
    out[1, 3] = 1.0 - w_2
    out[2, 0] = d_law_of_slope_by_height*w_8 + sqrt_w_7
    out[2, 2] = d_law_of_slope_by_lambda_height*w_8 + w_6
    out[2, 3] = d_law_of_slope_by_height*w_8 + sqrt_w_7
    return out
