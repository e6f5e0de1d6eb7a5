"""Catalyst mixing for maximum yield.

Written by satsym from derivations/examples/catalyst.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/catalyst.py
Source: ../derivations/examples/catalyst.py 1924fbdee84b95c909d7c86c1498d3bc
Digest: 26ca7257ebee364988116842c71b0c1338a7488cd389c69cd8aa910698d4d511
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'catalyst',
    'title': 'Catalyst mixing for maximum yield',
    'source': 'derivations/examples/catalyst.py',
    'states': (
        {'symbol': 'x1', 'latex': 'x_1', 'meaning': 'fraction of substance 1'},
        {'symbol': 'x2', 'latex': 'x_2', 'meaning': 'fraction of substance 2'},
    ),
    'controls': (
        {'symbol': 'u', 'latex': 'u', 'meaning': 'fraction of the first catalyst'},
    ),
    'parameters': (),
    'control_set': 'box',
    'has_cost': True,
    'has_terminal_cost': True,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'switching': True,
    'maximise': True,
    'objective_unit': '1',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x1, x2 = x
    (u_value,) = u
    w = x1 - 10.0*x2
    return (
        -u_value*w,
        u_value*w - x2*(1.0 - u_value),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        -u_value,
        10.0*u_value,
        u_value,
        -9.0*u_value - 1.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        10.0*x2 - x1,
        x1 - 9.0*x2,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x1, x2 = x
    (u_value,) = u
    return 0.0


def terminal_cost(t, x, p):
    """Terminal cost S."""
    x1, x2 = x
    return x1 + x2 - 1.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    x1, x2 = x
    return (
        1.0,
        1.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    w = x1 - 10.0*x2
    return lambda_x2*(u_value*w - x2*(1.0 - u_value)) - lambda_x1*u_value*w


def switching_function(t, x, lam, p):
    """What multiplies each control in H."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    return (
        lambda_x1*(10.0*x2 - x1) + lambda_x2*(x1 - 9.0*x2),
    )


def switching_rate(t, x, u, lam, p):
    """Its rates of change along an extremal."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        lambda_x2*x1 - 10.0*lambda_x1*x2,
    )


def magnitude_weight(t, x, lam, p):
    """What multiplies each |u| in H."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    return (
        0.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the box."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    w = lambda_x1*(10.0*x2 - x1) + lambda_x2*(x1 - 9.0*x2)
    u_2 = u_min if w > 0.0 else u_max if w < 0.0 else 0.5*(u_min + u_max)
    return (
        u_2,
    )


def extremal_jacobian(t, x, u, lam, p):
    """Rates of states and costates by states and costates, row by row, the controls being held."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    w = -u_value
    w_2 = 10.0*u_value
    w_3 = 9.0*u_value + 1.0
    return (
        w,
        w_2,
        0.0,
        0.0,
        u_value,
        -w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        u_value,
        w,
        0.0,
        0.0,
        -w_2,
        w_3,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    lambda_x1_u_value = lambda_x1*u_value
    return (
        lambda_x1_u_value - lambda_x2*u_value,
        lambda_x2*(9.0*u_value + 1.0) - 10.0*lambda_x1_u_value,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    inv_smoothing = 1.0/smoothing
    w = x1 - 10.0*x2
    w_2 = -w
    w_3 = -inv_smoothing*(lambda_x1*w_2 + lambda_x2*(x1 - 9.0*x2))
    w_4 = u_min if w_3 < u_min else u_max if w_3 > u_max else w_3
    lambda_x1_w_4 = lambda_x1*w_4
    return (
        w_2*w_4,
        w*w_4 - x2*(1.0 - w_4),
        lambda_x1_w_4 - lambda_x2*w_4,
        -10.0*lambda_x1_w_4 - lambda_x2*(-9.0*w_4 - 1.0),
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    inv_smoothing = 1.0/smoothing
    w = x1 - 9.0*x2
    lambda_x2_w = lambda_x2*w
    w_2 = x1 - 10.0*x2
    w_3 = -w_2
    lambda_x1_w_3 = lambda_x1*w_3
    w_4 = -inv_smoothing*(lambda_x1_w_3 + lambda_x2_w)
    w_5 = u_min if w_4 < u_min else u_max if w_4 > u_max else w_4
    w_6 = lambda_x2 - lambda_x1
    w_7 = 0.0 if w_4 < u_min else 0.0 if w_4 > u_max else 1.0
    inv_smoothing_w_7 = inv_smoothing*w_7
    inv_smoothing_w_7_w_3 = inv_smoothing_w_7*w_3
    w_8 = 9.0*lambda_x2
    w_9 = 10.0*lambda_x1
    w_10 = w_9 - w_8
    w_11 = 10.0*w_5
    inv_smoothing_w_7_w_6 = inv_smoothing_w_7*w_6
    inv_smoothing_w_7_w_10 = inv_smoothing_w_7*w_10
    w_12 = 9.0*w_5 + 1.0
    inv_smoothing_w_7_w = inv_smoothing_w_7*w
    return (
        -inv_smoothing_w_7_w_3*w_6 - w_5,
        w_11 - inv_smoothing_w_7_w_3*w_10,
        -inv_smoothing_w_7*w_3*w_3,
        -inv_smoothing_w_7_w_3*w,
        w_5 - inv_smoothing_w_7_w_6*w_2 - inv_smoothing_w_7_w_6*x2,
        -inv_smoothing_w_7_w_10*w_2 - inv_smoothing_w_7_w_10*x2 - w_12,
        -inv_smoothing_w_7_w_3*w_2 - inv_smoothing_w_7_w_3*x2,
        -inv_smoothing_w_7_w*w_2 - inv_smoothing_w_7_w*x2,
        inv_smoothing*lambda_x2*w_6*w_7 - inv_smoothing_w_7_w_6*lambda_x1,
        inv_smoothing*lambda_x2*w_10*w_7 - inv_smoothing_w_7_w_10*lambda_x1,
        inv_smoothing_w_7_w_3*lambda_x2 + w_5 - inv_smoothing_w_7*lambda_x1_w_3,
        inv_smoothing*lambda_x2*w*w_7 - inv_smoothing_w_7_w*lambda_x1 - w_5,
        inv_smoothing_w_7_w_6*w_9 - inv_smoothing_w_7_w_6*w_8,
        inv_smoothing_w_7_w_10*w_9 - inv_smoothing_w_7_w_10*w_8,
        10.0*inv_smoothing*lambda_x1*w_3*w_7 - inv_smoothing_w_7_w_3*w_8 - w_11,
        inv_smoothing_w_7_w*w_9 + w_12 - 9.0*inv_smoothing_w_7*lambda_x2_w,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    inv_smoothing = 1.0/smoothing
    w = x1 - 10.0*x2
    w_2 = -lambda_x1*w
    w_3 = -inv_smoothing*(lambda_x2*(x1 - 9.0*x2) + w_2)
    w_4 = u_min if w_3 < u_min else u_max if w_3 > u_max else w_3
    return (
        given_x1*(x1 - target_x1) + on_reference_x1*x1 - (1.0 - lambda_x1)*(1.0 - given_x1 - on_reference_x1),
        given_x2*(x2 - target_x2) + on_reference_x2*x2 - (1.0 - lambda_x2)*(1.0 - given_x2 - on_reference_x2),
        lambda_x2*(w*w_4 - x2*(1.0 - w_4)) + 0.5*smoothing*w_4*w_4 + w_2*w_4,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    w = given_x1 + on_reference_x1
    w_2 = given_x2 + on_reference_x2
    inv_smoothing = 1.0/smoothing
    w_3 = x1 - 9.0*x2
    w_4 = x1 - 10.0*x2
    w_5 = -w_4
    lambda_x1_w_5 = lambda_x1*w_5
    w_6 = -inv_smoothing*(lambda_x1_w_5 + lambda_x2*w_3)
    w_7 = u_min if w_6 < u_min else u_max if w_6 > u_max else w_6
    w_8 = lambda_x2 - lambda_x1
    w_9 = 0.0 if w_6 < u_min else 0.0 if w_6 > u_max else 1.0
    w_7_w_9 = w_7*w_9
    inv_smoothing_w_9 = inv_smoothing*w_9
    inv_smoothing_w_9_w_8 = inv_smoothing_w_9*w_8
    w_10 = 10.0*lambda_x1 - 9.0*lambda_x2
    inv_smoothing_w_9_w_10 = inv_smoothing_w_9*w_10
    inv_smoothing_w_9_w_5 = inv_smoothing_w_9*w_5
    inv_smoothing_w_9_w_3 = inv_smoothing_w_9*w_3
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
        lambda_x2*(w_7 - inv_smoothing_w_9_w_8*w_4 - inv_smoothing_w_9_w_8*x2) - inv_smoothing_w_9_w_8*lambda_x1_w_5 - lambda_x1*w_7 - w_7_w_9*w_8,
        10.0*lambda_x1*w_7 + lambda_x2*(-inv_smoothing_w_9_w_10*w_4 - inv_smoothing_w_9_w_10*x2 - 9.0*w_7 - 1.0) - inv_smoothing_w_9_w_10*lambda_x1_w_5 - w_10*w_7_w_9,
        lambda_x2*(-inv_smoothing_w_9_w_5*w_4 - inv_smoothing_w_9_w_5*x2) + w_5*w_7 - inv_smoothing_w_9*lambda_x1*w_5*w_5 - w_5*w_7*w_9,
        lambda_x2*(-inv_smoothing_w_9_w_3*w_4 - inv_smoothing_w_9_w_3*x2) + w_4*w_7 - inv_smoothing_w_9_w_3*lambda_x1_w_5 - w_3*w_7_w_9 - x2*(1.0 - w_7),
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    x1_at, x2_at = x
    x1_mid, x2_mid = x_mid
    (u_value_at,) = u
    (u_value_mid,) = u_mid
    x1, x2 = x0
    steps = len(times) - 1
    t = times[0]
    x1_at[0] = x1
    x2_at[0] = x2
    u_value = u_value_at[0]
    w = x1 - 10.0*x2
    slope_x1 = -u_value*w
    slope_x2 = u_value*w - x2*(1.0 - u_value)
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x1_at[i] = x1
        x2_at[i] = x2
        u_value_half = u_value_mid[i]
        u_value_end = u_value_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        x1_2 = half*slope_x1 + x1
        x2_2 = half*slope_x2 + x2
        w_2 = x1_2 - 10.0*x2_2
        k2_x1 = -u_value_half*w_2
        k2_x2 = u_value_half*w_2 - x2_2*(1.0 - u_value_half)
        x1_3 = half*k2_x1 + x1
        x2_3 = half*k2_x2 + x2
        w_3 = x1_3 - 10.0*x2_3
        k3_x1 = -u_value_half*w_3
        k3_x2 = u_value_half*w_3 - x2_3*(1.0 - u_value_half)
        x1_4 = h*k3_x1 + x1
        x2_4 = h*k3_x2 + x2
        w_4 = x1_4 - 10.0*x2_4
        k4_x1 = -u_value_end*w_4
        k4_x2 = u_value_end*w_4 - x2_4*(1.0 - u_value_end)
        x1_end = sixth*(k4_x1 + slope_x1 + 2.0*(k2_x1 + k3_x1)) + x1
        x2_end = sixth*(k4_x2 + slope_x2 + 2.0*(k2_x2 + k3_x2)) + x2
        w_5 = x1_end - 10.0*x2_end
        slope_end_x1 = -u_value_end*w_5
        slope_end_x2 = u_value_end*w_5 - x2_end*(1.0 - u_value_end)
        eighth = 0.125*h
        x1_mid[i] = eighth*(slope_x1 - slope_end_x1) + 0.5*(x1 + x1_end)
        x2_mid[i] = eighth*(slope_x2 - slope_end_x2) + 0.5*(x2 + x2_end)
        total = total
        t = t_end
        x1 = x1_end
        x2 = x2_end
        slope_x1 = slope_end_x1
        slope_x2 = slope_end_x2
    x1_at[steps] = x1
    x2_at[steps] = x2
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    lambda_x1_at, lambda_x2_at = lam
    lambda_x1_mid, lambda_x2_mid = lam_mid
    x1_at, x2_at = x
    (u_value_at,) = u
    x1_mid, x2_mid = x_mid
    (u_value_mid,) = u_mid
    lambda_x1, lambda_x2 = lam_f
    steps = len(times) - 1
    t = times[steps]
    lambda_x1_at[steps] = lambda_x1
    lambda_x2_at[steps] = lambda_x2
    u_value = u_value_at[steps]
    w = 9.0*u_value + 1.0
    w_2 = 10.0*u_value
    slope_lambda_x1 = lambda_x1*u_value - lambda_x2*u_value
    slope_lambda_x2 = lambda_x2*w - lambda_x1*w_2
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        u_value_half = u_value_mid[i]
        u_value_end = u_value_at[i]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_x1_2 = half*slope_lambda_x1 + lambda_x1
        lambda_x2_2 = half*slope_lambda_x2 + lambda_x2
        w_3 = 9.0*u_value_half + 1.0
        w_4 = 10.0*u_value_half
        k2_lambda_x1 = lambda_x1_2*u_value_half - lambda_x2_2*u_value_half
        k2_lambda_x2 = lambda_x2_2*w_3 - lambda_x1_2*w_4
        lambda_x1_3 = half*k2_lambda_x1 + lambda_x1
        lambda_x2_3 = half*k2_lambda_x2 + lambda_x2
        k3_lambda_x1 = lambda_x1_3*u_value_half - lambda_x2_3*u_value_half
        k3_lambda_x2 = lambda_x2_3*w_3 - lambda_x1_3*w_4
        lambda_x1_4 = h*k3_lambda_x1 + lambda_x1
        lambda_x2_4 = h*k3_lambda_x2 + lambda_x2
        w_5 = 9.0*u_value_end + 1.0
        w_6 = 10.0*u_value_end
        k4_lambda_x1 = lambda_x1_4*u_value_end - lambda_x2_4*u_value_end
        k4_lambda_x2 = lambda_x2_4*w_5 - lambda_x1_4*w_6
        lambda_x1_end = lambda_x1 + sixth*(k4_lambda_x1 + slope_lambda_x1 + 2.0*(k2_lambda_x1 + k3_lambda_x1))
        lambda_x2_end = lambda_x2 + sixth*(k4_lambda_x2 + slope_lambda_x2 + 2.0*(k2_lambda_x2 + k3_lambda_x2))
        slope_end_lambda_x1 = lambda_x1_end*u_value_end - lambda_x2_end*u_value_end
        slope_end_lambda_x2 = lambda_x2_end*w_5 - lambda_x1_end*w_6
        eighth = 0.125*h
        lambda_x1_mid[i] = eighth*(slope_lambda_x1 - slope_end_lambda_x1) + 0.5*(lambda_x1 + lambda_x1_end)
        lambda_x1_at[i] = lambda_x1_end
        lambda_x2_mid[i] = eighth*(slope_lambda_x2 - slope_end_lambda_x2) + 0.5*(lambda_x2 + lambda_x2_end)
        lambda_x2_at[i] = lambda_x2_end
        t = t_end
        lambda_x1 = lambda_x1_end
        lambda_x2 = lambda_x2_end
        slope_lambda_x1 = slope_end_lambda_x1
        slope_lambda_x2 = slope_end_lambda_x2


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    w = x1 - 10.0*x2
    out[0] = -u_value*w
    out[1] = u_value*w - x2*(1.0 - u_value)
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = -u_value
    out[0, 1] = 10.0*u_value
    out[1, 0] = u_value
    out[1, 1] = -9.0*u_value - 1.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 10.0*x2 - x1
    out[1, 0] = x1 - 9.0*x2
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    x1, x2 = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = x1 + x2 - 1.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    x1, x2 = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = 1.0
    out[1] = 1.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    w = x1 - 10.0*x2
    out[...] = lambda_x2*(u_value*w - x2*(1.0 - u_value)) - lambda_x1*u_value*w
    return out


def switching_function_batch(t, x, lam, p, out=None):
    """What multiplies each control in H. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p))
    out[0] = lambda_x1*(10.0*x2 - x1) + lambda_x2*(x1 - 9.0*x2)
    return out


def switching_rate_batch(t, x, u, lam, p, out=None):
    """Its rates of change along an extremal. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = lambda_x2*x1 - 10.0*lambda_x1*x2
    return out


def magnitude_weight_batch(t, x, lam, p, out=None):
    """What multiplies each |u| in H. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p))
    out[0] = 0.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the box. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = lambda_x1*(10.0*x2 - x1) + lambda_x2*(x1 - 9.0*x2)
    u_2 = np.heaviside(w - 0.0, 0.0)*u_min + np.heaviside(-w - 0.0, 0.0)*u_max + (1.0 - np.heaviside(w - 0.0, 0.0) - np.heaviside(-w - 0.0, 0.0))*0.5*(u_min + u_max)
    out[0] = u_2
    return out


def extremal_jacobian_batch(t, x, u, lam, p, out=None):
    """Rates of states and costates by states and costates, row by row, the controls being held. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, lam, *p))
    w = -u_value
    w_2 = 10.0*u_value
    w_3 = 9.0*u_value + 1.0
    out[0, 0] = w
    out[0, 1] = w_2
    out[0, 2] = 0.0
    out[0, 3] = 0.0
    out[1, 0] = u_value
    out[1, 1] = -w_3
    out[1, 2] = 0.0
    out[1, 3] = 0.0
    out[2, 0] = 0.0
    out[2, 1] = 0.0
    out[2, 2] = u_value
    out[2, 3] = w
    out[3, 0] = 0.0
    out[3, 1] = 0.0
    out[3, 2] = -w_2
    out[3, 3] = w_3
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    lambda_x1_u_value = lambda_x1*u_value
    out[0] = lambda_x1_u_value - lambda_x2*u_value
    out[1] = lambda_x2*(9.0*u_value + 1.0) - 10.0*lambda_x1_u_value
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_smoothing = 1.0/smoothing
    w = x1 - 10.0*x2
    w_2 = -w
    w_3 = -inv_smoothing*(lambda_x1*w_2 + lambda_x2*(x1 - 9.0*x2))
    w_4 = np.minimum(np.maximum(w_3, u_min), u_max)
    lambda_x1_w_4 = lambda_x1*w_4
    out[0] = w_2*w_4
    out[1] = w*w_4 - x2*(1.0 - w_4)
    out[2] = lambda_x1_w_4 - lambda_x2*w_4
    out[3] = -10.0*lambda_x1_w_4 - lambda_x2*(-9.0*w_4 - 1.0)
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_smoothing = 1.0/smoothing
    w = x1 - 9.0*x2
    lambda_x2_w = lambda_x2*w
    w_2 = x1 - 10.0*x2
    w_3 = -w_2
    lambda_x1_w_3 = lambda_x1*w_3
    w_4 = -inv_smoothing*(lambda_x1_w_3 + lambda_x2_w)
    w_5 = np.minimum(np.maximum(w_4, u_min), u_max)
    w_6 = lambda_x2 - lambda_x1
    w_7 = np.heaviside(w_4 - u_min, 1.0)*np.heaviside(u_max - w_4, 1.0)
    inv_smoothing_w_7 = inv_smoothing*w_7
    inv_smoothing_w_7_w_3 = inv_smoothing_w_7*w_3
    w_8 = 9.0*lambda_x2
    w_9 = 10.0*lambda_x1
    w_10 = w_9 - w_8
    w_11 = 10.0*w_5
    inv_smoothing_w_7_w_6 = inv_smoothing_w_7*w_6
    inv_smoothing_w_7_w_10 = inv_smoothing_w_7*w_10
    w_12 = 9.0*w_5 + 1.0
    inv_smoothing_w_7_w = inv_smoothing_w_7*w
    out[0, 0] = -inv_smoothing_w_7_w_3*w_6 - w_5
    out[0, 1] = w_11 - inv_smoothing_w_7_w_3*w_10
    out[0, 2] = -inv_smoothing_w_7*w_3*w_3
    out[0, 3] = -inv_smoothing_w_7_w_3*w
    out[1, 0] = w_5 - inv_smoothing_w_7_w_6*w_2 - inv_smoothing_w_7_w_6*x2
    out[1, 1] = -inv_smoothing_w_7_w_10*w_2 - inv_smoothing_w_7_w_10*x2 - w_12
    out[1, 2] = -inv_smoothing_w_7_w_3*w_2 - inv_smoothing_w_7_w_3*x2
    out[1, 3] = -inv_smoothing_w_7_w*w_2 - inv_smoothing_w_7_w*x2
    out[2, 0] = inv_smoothing*lambda_x2*w_6*w_7 - inv_smoothing_w_7_w_6*lambda_x1
    out[2, 1] = inv_smoothing*lambda_x2*w_10*w_7 - inv_smoothing_w_7_w_10*lambda_x1
    out[2, 2] = inv_smoothing_w_7_w_3*lambda_x2 + w_5 - inv_smoothing_w_7*lambda_x1_w_3
    out[2, 3] = inv_smoothing*lambda_x2*w*w_7 - inv_smoothing_w_7_w*lambda_x1 - w_5
    out[3, 0] = inv_smoothing_w_7_w_6*w_9 - inv_smoothing_w_7_w_6*w_8
    out[3, 1] = inv_smoothing_w_7_w_10*w_9 - inv_smoothing_w_7_w_10*w_8
    out[3, 2] = 10.0*inv_smoothing*lambda_x1*w_3*w_7 - inv_smoothing_w_7_w_3*w_8 - w_11
    out[3, 3] = inv_smoothing_w_7_w*w_9 + w_12 - 9.0*inv_smoothing_w_7*lambda_x2_w
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
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
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    inv_smoothing = 1.0/smoothing
    w = x1 - 10.0*x2
    w_2 = -lambda_x1*w
    w_3 = -inv_smoothing*(lambda_x2*(x1 - 9.0*x2) + w_2)
    w_4 = np.minimum(np.maximum(w_3, u_min), u_max)
    out[0] = given_x1*(x1 - target_x1) + on_reference_x1*x1 - (1.0 - lambda_x1)*(1.0 - given_x1 - on_reference_x1)
    out[1] = given_x2*(x2 - target_x2) + on_reference_x2*x2 - (1.0 - lambda_x2)*(1.0 - given_x2 - on_reference_x2)
    out[2] = lambda_x2*(w*w_4 - x2*(1.0 - w_4)) + 0.5*smoothing*w_4*w_4 + w_2*w_4
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = given_x1 + on_reference_x1
    w_2 = given_x2 + on_reference_x2
    inv_smoothing = 1.0/smoothing
    w_3 = x1 - 9.0*x2
    w_4 = x1 - 10.0*x2
    w_5 = -w_4
    lambda_x1_w_5 = lambda_x1*w_5
    w_6 = -inv_smoothing*(lambda_x1_w_5 + lambda_x2*w_3)
    w_7 = np.minimum(np.maximum(w_6, u_min), u_max)
    w_8 = lambda_x2 - lambda_x1
    w_9 = np.heaviside(w_6 - u_min, 1.0)*np.heaviside(u_max - w_6, 1.0)
    w_7_w_9 = w_7*w_9
    inv_smoothing_w_9 = inv_smoothing*w_9
    inv_smoothing_w_9_w_8 = inv_smoothing_w_9*w_8
    w_10 = 10.0*lambda_x1 - 9.0*lambda_x2
    inv_smoothing_w_9_w_10 = inv_smoothing_w_9*w_10
    inv_smoothing_w_9_w_5 = inv_smoothing_w_9*w_5
    inv_smoothing_w_9_w_3 = inv_smoothing_w_9*w_3
    out[0, 0] = w
    out[0, 1] = 0.0
    out[0, 2] = 1.0 - w
    out[0, 3] = 0.0
    out[0, 4] = 0.0
    out[1, 0] = 0.0
    out[1, 1] = w_2
    out[1, 2] = 0.0
    out[1, 3] = 1.0 - w_2
    out[1, 4] = 0.0
    out[2, 0] = lambda_x2*(w_7 - inv_smoothing_w_9_w_8*w_4 - inv_smoothing_w_9_w_8*x2) - inv_smoothing_w_9_w_8*lambda_x1_w_5 - lambda_x1*w_7 - w_7_w_9*w_8
    out[2, 1] = 10.0*lambda_x1*w_7 + lambda_x2*(-inv_smoothing_w_9_w_10*w_4 - inv_smoothing_w_9_w_10*x2 - 9.0*w_7 - 1.0) - inv_smoothing_w_9_w_10*lambda_x1_w_5 - w_10*w_7_w_9
    out[2, 2] = lambda_x2*(-inv_smoothing_w_9_w_5*w_4 - inv_smoothing_w_9_w_5*x2) + w_5*w_7 - inv_smoothing_w_9*lambda_x1*w_5*w_5 - w_5*w_7*w_9
    out[2, 3] = lambda_x2*(-inv_smoothing_w_9_w_3*w_4 - inv_smoothing_w_9_w_3*x2) + w_4*w_7 - inv_smoothing_w_9_w_3*lambda_x1_w_5 - w_3*w_7_w_9 - x2*(1.0 - w_7)
    out[2, 4] = 0.0
    return out
