"""Double integrator, minimum energy.

Written by satsym from derivations/double_integrator.py. Do not edit: mend that file instead, then run
    satsym derive derivations/double_integrator.py
Source: ../derivations/double_integrator.py 872632fbd939dead61dd02b05065ecc8
Digest: 384086ba709320ee1e586956668455faae651439d139b127654bcbe9a1dd1a42
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'double_integrator_energy',
    'title': 'Double integrator, minimum energy',
    'source': 'derivations/double_integrator.py',
    'states': (
        {'symbol': 'q', 'latex': 'q', 'unit': 'm', 'meaning': 'position'},
        {'symbol': 'q_dot', 'latex': '\\dot q', 'unit': 'm/s', 'meaning': 'velocity'},
    ),
    'controls': (
        {'symbol': 'u1', 'latex': 'u_1', 'unit': 'm/s**2', 'meaning': 'thrust per unit mass'},
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
    'objective_unit': 'm**2/s**3',
    'linear_quadratic': True,
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    q, q_dot = x
    (u1,) = u
    return (
        q_dot,
        u1,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    q, q_dot = x
    (u1,) = u
    return (
        0.0,
        1.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    q, q_dot = x
    (u1,) = u
    return (
        0.0,
        1.0,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    q, q_dot = x
    (u1,) = u
    return 0.5*u1*u1


def terminal_cost(t, x, p):
    """Terminal cost S."""
    q, q_dot = x
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    q, q_dot = x
    return (
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    q, q_dot = x
    (u1,) = u
    lambda_q, lambda_q_dot = lam
    return lambda_q*q_dot + lambda_q_dot*u1 + 0.5*u1*u1


def stationarity(t, x, u, lam, p):
    """H_u."""
    q, q_dot = x
    (u1,) = u
    lambda_q, lambda_q_dot = lam
    return (
        lambda_q_dot + u1,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    q, q_dot = x
    (u1,) = u
    lambda_q, lambda_q_dot = lam
    return (
        1.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    w = -lambda_q_dot
    u1 = u1_min if w < u1_min else u1_max if w > u1_max else w
    return (
        u1,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    q, q_dot = x
    (u1,) = u
    lambda_q, lambda_q_dot = lam
    return (
        0.0,
        -lambda_q,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    w = -lambda_q_dot
    w_2 = u1_min if w < u1_min else u1_max if w > u1_max else w
    return (
        q_dot,
        w_2,
        0.0,
        -lambda_q,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    w = -lambda_q_dot
    w_2 = 0.0 if w < u1_min else 0.0 if w > u1_max else 1.0
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -w_2,
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
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    given_q, given_q_dot, on_reference_q, on_reference_q_dot, target_q, target_q_dot = final
    w = -lambda_q_dot
    w_2 = u1_min if w < u1_min else u1_max if w > u1_max else w
    return (
        given_q*(q - target_q) + lambda_q*(1.0 - given_q - on_reference_q) + on_reference_q*q,
        given_q_dot*(q_dot - target_q_dot) + lambda_q_dot*(1.0 - given_q_dot - on_reference_q_dot) + on_reference_q_dot*q_dot,
        lambda_q*q_dot + lambda_q_dot*w_2 + 0.5*w_2*w_2,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    given_q, given_q_dot, on_reference_q, on_reference_q_dot, target_q, target_q_dot = final
    w = given_q + on_reference_q
    w_2 = given_q_dot + on_reference_q_dot
    w_3 = -lambda_q_dot
    w_4 = 0.0 if w_3 < u1_min else 0.0 if w_3 > u1_max else 1.0
    w_5 = u1_min if w_3 < u1_min else u1_max if w_3 > u1_max else w_3
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
        lambda_q,
        q_dot,
        w_5 - lambda_q_dot*w_4 - w_4*w_5,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    q_at, q_dot_at = x
    q_mid, q_dot_mid = x_mid
    (u1_at,) = u
    (u1_mid,) = u_mid
    q, q_dot = x0
    steps = len(times) - 1
    t = times[0]
    q_at[0] = q
    q_dot_at[0] = q_dot
    u1 = u1_at[0]
    slope_q_dot = u1
    slope_total = 0.5*u1*u1
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        q_at[i] = q
        q_dot_at[i] = q_dot
        u1_half = u1_mid[i]
        u1_end = u1_at[i + 1]
        sixth = (1.0/6.0)*h
        k2_total = 0.5*u1_half*u1_half
        k4_total = 0.5*u1_end*u1_end
        k23_q_dot = 2.0*u1_half
        k123_q_dot = k23_q_dot + slope_q_dot
        q_end = h*(k123_q_dot*sixth + q_dot) + q
        q_dot_end = q_dot + sixth*(k123_q_dot + k23_q_dot + u1_end)
        eighth = 0.125*h
        q_mid[i] = eighth*(q_dot - q_dot_end) + 0.5*(q + q_end)
        q_dot_mid[i] = eighth*(slope_q_dot - u1_end) + 0.5*(q_dot + q_dot_end)
        total = sixth*(4.0*k2_total + k4_total + slope_total) + total
        t = t_end
        q = q_end
        q_dot = q_dot_end
        slope_q_dot = u1_end
        slope_total = k4_total
    q_at[steps] = q
    q_dot_at[steps] = q_dot
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    lambda_q_at, lambda_q_dot_at = lam
    lambda_q_mid, lambda_q_dot_mid = lam_mid
    q_at, q_dot_at = x
    (u1_at,) = u
    q_mid, q_dot_mid = x_mid
    (u1_mid,) = u_mid
    lambda_q, lambda_q_dot = lam_f
    steps = len(times) - 1
    t = times[steps]
    lambda_q_at[steps] = lambda_q
    lambda_q_dot_at[steps] = lambda_q_dot
    slope_lambda_q_dot = -lambda_q
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        sixth = (1.0/6.0)*h
        k2_lambda_q_dot = -lambda_q
        lambda_q_dot_end = lambda_q_dot + sixth*(5.0*k2_lambda_q_dot + slope_lambda_q_dot)
        eighth = 0.125*h
        lambda_q_mid[i] = lambda_q
        lambda_q_at[i] = lambda_q
        lambda_q_dot_mid[i] = eighth*(slope_lambda_q_dot - k2_lambda_q_dot) + 0.5*(lambda_q_dot + lambda_q_dot_end)
        lambda_q_dot_at[i] = lambda_q_dot_end
        t = t_end
        lambda_q_dot = lambda_q_dot_end
        slope_lambda_q_dot = k2_lambda_q_dot


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    q, q_dot = x
    (u1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    out[0] = q_dot
    out[1] = u1
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    q, q_dot = x
    (u1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[0, 1] = 1.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    q, q_dot = x
    (u1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 0.0
    out[1, 0] = 1.0
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    q, q_dot = x
    (u1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.5*u1*u1
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    q, q_dot = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    q, q_dot = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    q, q_dot = x
    (u1,) = u
    lambda_q, lambda_q_dot = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    out[...] = lambda_q*q_dot + lambda_q_dot*u1 + 0.5*u1*u1
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    q, q_dot = x
    (u1,) = u
    lambda_q, lambda_q_dot = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = lambda_q_dot + u1
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    q, q_dot = x
    (u1,) = u
    lambda_q, lambda_q_dot = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = 1.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -lambda_q_dot
    u1 = np.minimum(np.maximum(w, u1_min), u1_max)
    out[0] = u1
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    q, q_dot = x
    (u1,) = u
    lambda_q, lambda_q_dot = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = 0.0
    out[1] = -lambda_q
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -lambda_q_dot
    w_2 = np.minimum(np.maximum(w, u1_min), u1_max)
    out[0] = q_dot
    out[1] = w_2
    out[2] = 0.0
    out[3] = -lambda_q
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    w = -lambda_q_dot
    w_2 = np.heaviside(w - u1_min, 1.0)*np.heaviside(u1_max - w, 1.0)
    out[0, 1] = 1.0
    out[1, 3] = -w_2
    out[3, 2] = -1.0
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
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
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    given_q, given_q_dot, on_reference_q, on_reference_q_dot, target_q, target_q_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = -lambda_q_dot
    w_2 = np.minimum(np.maximum(w, u1_min), u1_max)
    out[0] = given_q*(q - target_q) + lambda_q*(1.0 - given_q - on_reference_q) + on_reference_q*q
    out[1] = given_q_dot*(q_dot - target_q_dot) + lambda_q_dot*(1.0 - given_q_dot - on_reference_q_dot) + on_reference_q_dot*q_dot
    out[2] = lambda_q*q_dot + lambda_q_dot*w_2 + 0.5*w_2*w_2
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    q, q_dot = x
    lambda_q, lambda_q_dot = lam
    u1_min, u1_max = bounds
    given_q, given_q_dot, on_reference_q, on_reference_q_dot, target_q, target_q_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_q + on_reference_q
    w_2 = given_q_dot + on_reference_q_dot
    w_3 = -lambda_q_dot
    w_4 = np.heaviside(w_3 - u1_min, 1.0)*np.heaviside(u1_max - w_3, 1.0)
    w_5 = np.minimum(np.maximum(w_3, u1_min), u1_max)
    out[0, 0] = w
    out[0, 2] = 1.0 - w
    out[1, 1] = w_2
    out[1, 3] = 1.0 - w_2
    out[2, 1] = lambda_q
    out[2, 2] = q_dot
    out[2, 3] = w_5 - lambda_q_dot*w_4 - w_4*w_5
    return out
