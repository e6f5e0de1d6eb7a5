"""Damping the Van der Pol oscillator with a bounded control.

Written by satsym from derivations/examples/oscillators.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/oscillators.py
Source: ../derivations/examples/oscillators.py 790e9a30cb29b5f02dee26a00093dde9
Digest: 36c592b9a63976ba51632609041f7747c87bfd5a7bdd4af17ff5ddf8c19db77b
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'van_der_pol_boxed',
    'title': 'Damping the Van der Pol oscillator with a bounded control',
    'source': 'derivations/examples/oscillators.py',
    'states': (
        {'symbol': 'x1', 'latex': 'x_1', 'meaning': 'state 1'},
        {'symbol': 'x2', 'latex': 'x_2', 'meaning': 'state 2'},
    ),
    'controls': (
        {'symbol': 'u', 'latex': 'u', 'meaning': 'control'},
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
    'objective_unit': '1',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x1, x2 = x
    (u_value,) = u
    return (
        u_value + x1*(1.0 - x2*x2) - x2,
        x1,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        1.0 - x2*x2,
        -2.0*x1*x2 - 1.0,
        1.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        1.0,
        0.0,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x1, x2 = x
    (u_value,) = u
    return u_value*u_value + x1*x1 + x2*x2


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
    x2_sq = x2*x2
    return lambda_x1*(u_value + x1*(1.0 - x2_sq) - x2) + lambda_x2*x1 + u_value*u_value + x1*x1 + x2_sq


def stationarity(t, x, u, lam, p):
    """H_u."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        lambda_x1 + 2.0*u_value,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        2.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
    w = -0.5*lambda_x1
    u_2 = u_min if w < u_min else u_max if w > u_max else w
    return (
        u_2,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    twice_x1 = 2.0*x1
    return (
        lambda_x1*(x2*x2 - 1.0) - lambda_x2 - twice_x1,
        lambda_x1*(twice_x1*x2 + 1.0) - 2.0*x2,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
    w = -0.5*lambda_x1
    w_2 = u_min if w < u_min else u_max if w > u_max else w
    w_3 = x2*x2 - 1.0
    twice_x1 = 2.0*x1
    return (
        w_2 - w_3*x1 - x2,
        x1,
        lambda_x1*w_3 - lambda_x2 - twice_x1,
        lambda_x1*(twice_x1*x2 + 1.0) - 2.0*x2,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
    w = x2*x2 - 1.0
    twice_x2 = 2.0*x2
    w_2 = twice_x2*x1 + 1.0
    w_3 = -0.5*lambda_x1
    w_4 = 0.0 if w_3 < u_min else 0.0 if w_3 > u_max else 1.0
    lambda_x1_twice_x2 = lambda_x1*twice_x2
    return (
        -w,
        -w_2,
        -0.5*w_4,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        -2.0,
        lambda_x1_twice_x2,
        w,
        -1.0,
        lambda_x1_twice_x2,
        2.0*lambda_x1*x1 - 2.0,
        w_2,
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
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
    u_min, u_max = bounds
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    w = -x2
    w_2 = -0.5*lambda_x1
    w_3 = u_min if w_2 < u_min else u_max if w_2 > u_max else w_2
    x2_sq = x2*x2
    return (
        given_x1*(x1 - target_x1) + lambda_x1*(1.0 - given_x1 - on_reference_x1) + on_reference_x1*x1,
        given_x2*(-target_x2 - w) + lambda_x2*(1.0 - given_x2 - on_reference_x2) + on_reference_x2*x2,
        lambda_x1*(w + w_3 + x1*(1.0 - x2_sq)) + lambda_x2*x1 + w_3*w_3 + x1*x1 + x2_sq,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    w = given_x1 + on_reference_x1
    w_2 = given_x2 + on_reference_x2
    twice_x1 = 2.0*x1
    w_3 = 1.0 - x2*x2
    half_lambda_x1 = 0.5*lambda_x1
    w_4 = -half_lambda_x1
    w_5 = u_min if w_4 < u_min else u_max if w_4 > u_max else w_4
    w_6 = 0.0 if w_4 < u_min else 0.0 if w_4 > u_max else 1.0
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
        lambda_x1*w_3 + lambda_x2 + twice_x1,
        lambda_x1*(-twice_x1*x2 - 1.0) + 2.0*x2,
        w_3*x1 + w_5 - half_lambda_x1*w_6 - w_5*w_6 - x2,
        x1,
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
    x2_sq = x2*x2
    slope_x1 = u_value + x1*(1.0 - x2_sq) - x2
    slope_total = u_value*u_value + x1*x1 + x2_sq
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
        x2_2 = half*x1 + x2
        x2_2_sq = x2_2*x2_2
        k2_x1 = u_value_half + x1_2*(1.0 - x2_2_sq) - x2_2
        k2_total = u_value_half*u_value_half + x1_2*x1_2 + x2_2_sq
        x1_3 = half*k2_x1 + x1
        x2_3 = half*x1_2 + x2
        x2_3_sq = x2_3*x2_3
        k3_x1 = u_value_half + x1_3*(1.0 - x2_3_sq) - x2_3
        k3_total = u_value_half*u_value_half + x1_3*x1_3 + x2_3_sq
        x1_4 = h*k3_x1 + x1
        x2_4 = h*x1_3 + x2
        x2_4_sq = x2_4*x2_4
        k4_x1 = u_value_end + x1_4*(1.0 - x2_4_sq) - x2_4
        k4_total = u_value_end*u_value_end + x1_4*x1_4 + x2_4_sq
        k23_x1 = k2_x1 + k3_x1
        k123_x1 = k23_x1 + slope_x1
        x1_end = sixth*(k123_x1 + k23_x1 + k4_x1) + x1
        x2_end = h*(k123_x1*sixth + x1) + x2
        x2_end_sq = x2_end*x2_end
        slope_end_x1 = u_value_end + x1_end*(1.0 - x2_end_sq) - x2_end
        slope_end_total = u_value_end*u_value_end + x1_end*x1_end + x2_end_sq
        eighth = 0.125*h
        x1_mid[i] = eighth*(slope_x1 - slope_end_x1) + 0.5*(x1 + x1_end)
        x2_mid[i] = eighth*(x1 - x1_end) + 0.5*(x2 + x2_end)
        total = sixth*(k4_total + slope_total + 2.0*(k2_total + k3_total)) + total
        t = t_end
        x1 = x1_end
        x2 = x2_end
        slope_x1 = slope_end_x1
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
    x2 = x2_at[steps]
    twice_x1 = 2.0*x1
    w = x2*x2 - 1.0
    twice_x2 = 2.0*x2
    w_2 = twice_x1*x2 + 1.0
    slope_lambda_x1 = lambda_x1*w - lambda_x2 - twice_x1
    slope_lambda_x2 = lambda_x1*w_2 - twice_x2
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        x1_half = x1_mid[i]
        x1_end = x1_at[i]
        x2_half = x2_mid[i]
        x2_end = x2_at[i]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_x1_2 = half*slope_lambda_x1 + lambda_x1
        lambda_x2_2 = half*slope_lambda_x2 + lambda_x2
        twice_x1_half = 2.0*x1_half
        w_3 = x2_half*x2_half - 1.0
        twice_x2_half = 2.0*x2_half
        w_4 = twice_x1_half*x2_half + 1.0
        k2_lambda_x1 = lambda_x1_2*w_3 - lambda_x2_2 - twice_x1_half
        k2_lambda_x2 = lambda_x1_2*w_4 - twice_x2_half
        lambda_x1_3 = half*k2_lambda_x1 + lambda_x1
        lambda_x2_3 = half*k2_lambda_x2 + lambda_x2
        k3_lambda_x1 = lambda_x1_3*w_3 - lambda_x2_3 - twice_x1_half
        k3_lambda_x2 = lambda_x1_3*w_4 - twice_x2_half
        lambda_x1_4 = h*k3_lambda_x1 + lambda_x1
        lambda_x2_4 = h*k3_lambda_x2 + lambda_x2
        twice_x1_end = 2.0*x1_end
        w_5 = x2_end*x2_end - 1.0
        twice_x2_end = 2.0*x2_end
        w_6 = twice_x1_end*x2_end + 1.0
        k4_lambda_x1 = lambda_x1_4*w_5 - lambda_x2_4 - twice_x1_end
        k4_lambda_x2 = lambda_x1_4*w_6 - twice_x2_end
        lambda_x1_end = lambda_x1 + sixth*(k4_lambda_x1 + slope_lambda_x1 + 2.0*(k2_lambda_x1 + k3_lambda_x1))
        lambda_x2_end = lambda_x2 + sixth*(k4_lambda_x2 + slope_lambda_x2 + 2.0*(k2_lambda_x2 + k3_lambda_x2))
        slope_end_lambda_x1 = lambda_x1_end*w_5 - lambda_x2_end - twice_x1_end
        slope_end_lambda_x2 = lambda_x1_end*w_6 - twice_x2_end
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
    out[0] = u_value + x1*(1.0 - x2*x2) - x2
    out[1] = x1
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 1.0 - x2*x2
    out[0, 1] = -2.0*x1*x2 - 1.0
    out[1, 0] = 1.0
    out[1, 1] = 0.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 1.0
    out[1, 0] = 0.0
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = u_value*u_value + x1*x1 + x2*x2
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
    x2_sq = x2*x2
    out[...] = lambda_x1*(u_value + x1*(1.0 - x2_sq) - x2) + lambda_x2*x1 + u_value*u_value + x1*x1 + x2_sq
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = lambda_x1 + 2.0*u_value
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = 2.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -0.5*lambda_x1
    u_2 = np.minimum(np.maximum(w, u_min), u_max)
    out[0] = u_2
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    twice_x1 = 2.0*x1
    out[0] = lambda_x1*(x2*x2 - 1.0) - lambda_x2 - twice_x1
    out[1] = lambda_x1*(twice_x1*x2 + 1.0) - 2.0*x2
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -0.5*lambda_x1
    w_2 = np.minimum(np.maximum(w, u_min), u_max)
    w_3 = x2*x2 - 1.0
    twice_x1 = 2.0*x1
    out[0] = w_2 - w_3*x1 - x2
    out[1] = x1
    out[2] = lambda_x1*w_3 - lambda_x2 - twice_x1
    out[3] = lambda_x1*(twice_x1*x2 + 1.0) - 2.0*x2
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = x2*x2 - 1.0
    twice_x2 = 2.0*x2
    w_2 = twice_x2*x1 + 1.0
    w_3 = -0.5*lambda_x1
    w_4 = np.heaviside(w_3 - u_min, 1.0)*np.heaviside(u_max - w_3, 1.0)
    lambda_x1_twice_x2 = lambda_x1*twice_x2
    out[0, 0] = -w
    out[0, 1] = -w_2
    out[0, 2] = -0.5*w_4
    out[0, 3] = 0.0
    out[1, 0] = 1.0
    out[1, 1] = 0.0
    out[1, 2] = 0.0
    out[1, 3] = 0.0
    out[2, 0] = -2.0
    out[2, 1] = lambda_x1_twice_x2
    out[2, 2] = w
    out[2, 3] = -1.0
    out[3, 0] = lambda_x1_twice_x2
    out[3, 1] = 2.0*lambda_x1*x1 - 2.0
    out[3, 2] = w_2
    out[3, 3] = 0.0
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
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
    u_min, u_max = bounds
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = -x2
    w_2 = -0.5*lambda_x1
    w_3 = np.minimum(np.maximum(w_2, u_min), u_max)
    x2_sq = x2*x2
    out[0] = given_x1*(x1 - target_x1) + lambda_x1*(1.0 - given_x1 - on_reference_x1) + on_reference_x1*x1
    out[1] = given_x2*(-target_x2 - w) + lambda_x2*(1.0 - given_x2 - on_reference_x2) + on_reference_x2*x2
    out[2] = lambda_x1*(w + w_3 + x1*(1.0 - x2_sq)) + lambda_x2*x1 + w_3*w_3 + x1*x1 + x2_sq
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    u_min, u_max = bounds
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = given_x1 + on_reference_x1
    w_2 = given_x2 + on_reference_x2
    twice_x1 = 2.0*x1
    w_3 = 1.0 - x2*x2
    half_lambda_x1 = 0.5*lambda_x1
    w_4 = -half_lambda_x1
    w_5 = np.minimum(np.maximum(w_4, u_min), u_max)
    w_6 = np.heaviside(w_4 - u_min, 1.0)*np.heaviside(u_max - w_4, 1.0)
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
    out[2, 0] = lambda_x1*w_3 + lambda_x2 + twice_x1
    out[2, 1] = lambda_x1*(-twice_x1*x2 - 1.0) + 2.0*x2
    out[2, 2] = w_3*x1 + w_5 - half_lambda_x1*w_6 - w_5*w_6 - x2
    out[2, 3] = x1
    out[2, 4] = 0.0
    return out
