"""Fuller's problem: bringing a body to rest with minimum squared distance.

Written by satsym from derivations/examples/fuller.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/fuller.py
Source: ../derivations/examples/fuller.py b8bd6c3e53908d8e8ed7eff8543a9b11
Digest: b3fa717e81fcea6be7d44ead7a6e7f6f1d1bad14b390b8926cf43b35b65cc85c
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'fuller',
    'title': "Fuller's problem: bringing a body to rest with minimum squared distance",
    'source': 'derivations/examples/fuller.py',
    'states': (
        {'symbol': 'x1', 'latex': 'x_1', 'meaning': 'position'},
        {'symbol': 'x2', 'latex': 'x_2', 'meaning': 'velocity'},
    ),
    'controls': (
        {'symbol': 'u', 'latex': 'u', 'meaning': 'force per unit mass'},
    ),
    'parameters': (),
    'control_set': 'box',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'switching': True,
    'objective_unit': '1',
    'chattering': (
        'u',
    ),
    'linear_quadratic': True,
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x1, x2 = x
    (u_value,) = u
    return (
        x2,
        u_value,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        0.0,
        1.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        0.0,
        1.0,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x1, x2 = x
    (u_value,) = u
    return x1*x1


def terminal_cost(t, x, p):
    """Terminal cost S."""
    x1, x2 = x
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    x1, x2 = x
    return (
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return lambda_x1*x2 + lambda_x2*u_value + x1*x1


def switching_function(t, x, lam, p):
    """What multiplies each control in H."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    return (
        lambda_x2,
    )


def switching_rate(t, x, u, lam, p):
    """Its rates of change along an extremal."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        -lambda_x1,
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
    u_2 = u_min if lambda_x2 > 0.0 else u_max if lambda_x2 < 0.0 else 0.5*(u_min + u_max)
    return (
        u_2,
    )


def extremal_jacobian(t, x, u, lam, p):
    """Rates of states and costates by states and costates, row by row, the controls being held."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -2.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        0.0,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        -2.0*x1,
        -lambda_x1,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    inv_smoothing = 1.0/smoothing
    w = -inv_smoothing*lambda_x2
    w_2 = u_min if w < u_min else u_max if w > u_max else w
    return (
        x2,
        w_2,
        -2.0*x1,
        -lambda_x1,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    inv_smoothing = 1.0/smoothing
    w = -inv_smoothing*lambda_x2
    w_2 = 0.0 if w < u_min else 0.0 if w > u_max else 1.0
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_smoothing*w_2,
        -2.0,
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
    w = -inv_smoothing*lambda_x2
    w_2 = u_min if w < u_min else u_max if w > u_max else w
    return (
        given_x1*(x1 - target_x1) + lambda_x1*(1.0 - given_x1 - on_reference_x1) + on_reference_x1*x1,
        given_x2*(x2 - target_x2) + lambda_x2*(1.0 - given_x2 - on_reference_x2) + on_reference_x2*x2,
        lambda_x1*x2 + lambda_x2*w_2 + 0.5*smoothing*w_2*w_2 + x1*x1,
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
    inv_smoothing_lambda_x2 = inv_smoothing*lambda_x2
    w_3 = -inv_smoothing_lambda_x2
    w_4 = u_min if w_3 < u_min else u_max if w_3 > u_max else w_3
    w_5 = 0.0 if w_3 < u_min else 0.0 if w_3 > u_max else 1.0
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
        2.0*x1,
        lambda_x1,
        x2,
        w_4 - inv_smoothing_lambda_x2*w_5 - w_4*w_5,
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
    slope_x2 = u_value
    slope_total = x1*x1
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
        x1_2 = half*x2 + x1
        x2_2 = half*slope_x2 + x2
        k2_total = x1_2*x1_2
        x1_3 = half*x2_2 + x1
        x2_3 = half*u_value_half + x2
        k3_total = x1_3*x1_3
        x1_4 = h*x2_3 + x1
        k4_total = x1_4*x1_4
        k23_x2 = 2.0*u_value_half
        k123_x2 = k23_x2 + slope_x2
        x1_end = h*(k123_x2*sixth + x2) + x1
        x2_end = sixth*(k123_x2 + k23_x2 + u_value_end) + x2
        slope_end_total = x1_end*x1_end
        eighth = 0.125*h
        x1_mid[i] = eighth*(x2 - x2_end) + 0.5*(x1 + x1_end)
        x2_mid[i] = eighth*(slope_x2 - u_value_end) + 0.5*(x2 + x2_end)
        total = sixth*(k4_total + slope_total + 2.0*(k2_total + k3_total)) + total
        t = t_end
        x1 = x1_end
        x2 = x2_end
        slope_x2 = u_value_end
        slope_total = slope_end_total
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
    x1 = x1_at[steps]
    twice_x1 = 2.0*x1
    slope_lambda_x1 = -twice_x1
    slope_lambda_x2 = -lambda_x1
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        x1_half = x1_mid[i]
        x1_end = x1_at[i]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_x1_2 = half*slope_lambda_x1 + lambda_x1
        twice_x1_half = 2.0*x1_half
        k2_lambda_x1 = -twice_x1_half
        k2_lambda_x2 = -lambda_x1_2
        lambda_x1_3 = half*k2_lambda_x1 + lambda_x1
        k3_lambda_x2 = -lambda_x1_3
        lambda_x1_4 = h*k2_lambda_x1 + lambda_x1
        twice_x1_end = 2.0*x1_end
        k4_lambda_x1 = -twice_x1_end
        k4_lambda_x2 = -lambda_x1_4
        lambda_x1_end = lambda_x1 + sixth*(4.0*k2_lambda_x1 + k4_lambda_x1 + slope_lambda_x1)
        lambda_x2_end = lambda_x2 + sixth*(k4_lambda_x2 + slope_lambda_x2 + 2.0*(k2_lambda_x2 + k3_lambda_x2))
        slope_end_lambda_x2 = -lambda_x1_end
        eighth = 0.125*h
        lambda_x1_mid[i] = eighth*(slope_lambda_x1 - k4_lambda_x1) + 0.5*(lambda_x1 + lambda_x1_end)
        lambda_x1_at[i] = lambda_x1_end
        lambda_x2_mid[i] = eighth*(slope_lambda_x2 - slope_end_lambda_x2) + 0.5*(lambda_x2 + lambda_x2_end)
        lambda_x2_at[i] = lambda_x2_end
        t = t_end
        lambda_x1 = lambda_x1_end
        lambda_x2 = lambda_x2_end
        slope_lambda_x1 = k4_lambda_x1
        slope_lambda_x2 = slope_end_lambda_x2


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    out[0] = x2
    out[1] = u_value
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[0, 1] = 1.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 0.0
    out[1, 0] = 1.0
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = x1*x1
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    x1, x2 = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    x1, x2 = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    out[...] = lambda_x1*x2 + lambda_x2*u_value + x1*x1
    return out


def switching_function_batch(t, x, lam, p, out=None):
    """What multiplies each control in H. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p))
    out[0] = lambda_x2
    return out


def switching_rate_batch(t, x, u, lam, p, out=None):
    """Its rates of change along an extremal. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = -lambda_x1
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
    u_2 = np.heaviside(lambda_x2 - 0.0, 0.0)*u_min + np.heaviside(-lambda_x2 - 0.0, 0.0)*u_max + (1.0 - np.heaviside(lambda_x2 - 0.0, 0.0) - np.heaviside(-lambda_x2 - 0.0, 0.0))*0.5*(u_min + u_max)
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
    out[...] = 0.0
    out[0, 1] = 1.0
    out[2, 0] = -2.0
    out[3, 2] = -1.0
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = -2.0*x1
    out[1] = -lambda_x1
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
    w = -inv_smoothing*lambda_x2
    w_2 = np.minimum(np.maximum(w, u_min), u_max)
    out[0] = x2
    out[1] = w_2
    out[2] = -2.0*x1
    out[3] = -lambda_x1
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    inv_smoothing = 1.0/smoothing
    w = -inv_smoothing*lambda_x2
    w_2 = np.heaviside(w - u_min, 1.0)*np.heaviside(u_max - w, 1.0)
    out[0, 1] = 1.0
    out[1, 3] = -inv_smoothing*w_2
    out[2, 0] = -2.0
    out[3, 2] = -1.0
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
    w = -inv_smoothing*lambda_x2
    w_2 = np.minimum(np.maximum(w, u_min), u_max)
    out[0] = given_x1*(x1 - target_x1) + lambda_x1*(1.0 - given_x1 - on_reference_x1) + on_reference_x1*x1
    out[1] = given_x2*(x2 - target_x2) + lambda_x2*(1.0 - given_x2 - on_reference_x2) + on_reference_x2*x2
    out[2] = lambda_x1*x2 + lambda_x2*w_2 + 0.5*smoothing*w_2*w_2 + x1*x1
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
    inv_smoothing_lambda_x2 = inv_smoothing*lambda_x2
    w_3 = -inv_smoothing_lambda_x2
    w_4 = np.minimum(np.maximum(w_3, u_min), u_max)
    w_5 = np.heaviside(w_3 - u_min, 1.0)*np.heaviside(u_max - w_3, 1.0)
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
    out[2, 0] = 2.0*x1
    out[2, 1] = lambda_x1
    out[2, 2] = x2
    out[2, 3] = w_4 - inv_smoothing_lambda_x2*w_5 - w_4*w_5
    out[2, 4] = 0.0
    return out
