"""Hypersensitive problem: minimum deviation and effort over a long time.

Written by satsym from derivations/examples/hypersensitive.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/hypersensitive.py
Source: ../derivations/examples/hypersensitive.py a2e6777af7d81f7800123c3d996d577f
Digest: e7572c0dac45992e953557d9dcc9919ace8900736f2540d3b14023a6e94a8808
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'hypersensitive',
    'title': 'Hypersensitive problem: minimum deviation and effort over a long time',
    'source': 'derivations/examples/hypersensitive.py',
    'states': (
        {'symbol': 'x', 'latex': 'x', 'meaning': 'state'},
    ),
    'controls': (
        {'symbol': 'u', 'latex': 'u', 'meaning': 'control'},
    ),
    'parameters': (),
    'control_set': 'free',
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
    (x_value,) = x
    (u_value,) = u
    return (
        u_value - x_value*x_value*x_value,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    (x_value,) = x
    (u_value,) = u
    return (
        -3.0*x_value*x_value,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    (x_value,) = x
    (u_value,) = u
    return (
        1.0,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    (x_value,) = x
    (u_value,) = u
    return 0.5*u_value*u_value + 0.5*x_value*x_value


def terminal_cost(t, x, p):
    """Terminal cost S."""
    (x_value,) = x
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    (x_value,) = x
    return (
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    (x_value,) = x
    (u_value,) = u
    (lambda_x,) = lam
    return lambda_x*(u_value - x_value*x_value*x_value) + 0.5*u_value*u_value + 0.5*x_value*x_value


def stationarity(t, x, u, lam, p):
    """H_u."""
    (x_value,) = x
    (u_value,) = u
    (lambda_x,) = lam
    return (
        lambda_x + u_value,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    (x_value,) = x
    (u_value,) = u
    (lambda_x,) = lam
    return (
        1.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    (x_value,) = x
    (lambda_x,) = lam
    return (
        -lambda_x,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    (x_value,) = x
    (u_value,) = u
    (lambda_x,) = lam
    return (
        3.0*lambda_x*x_value*x_value - x_value,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    (x_value,) = x
    (lambda_x,) = lam
    return (
        -lambda_x - x_value*x_value*x_value,
        3.0*lambda_x*x_value*x_value - x_value,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    (x_value,) = x
    (lambda_x,) = lam
    w = 3.0*x_value*x_value
    return (
        -w,
        -1.0,
        6.0*lambda_x*x_value - 1.0,
        w,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    (x_value,) = x
    (lambda_x,) = lam
    return (
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    (x_value,) = x
    (lambda_x,) = lam
    given_x, on_reference_x, target_x = final
    return (
        given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value,
        0.5*lambda_x*lambda_x + lambda_x*(-lambda_x - x_value*x_value*x_value) + 0.5*x_value*x_value,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    (x_value,) = x
    (lambda_x,) = lam
    given_x, on_reference_x, target_x = final
    w = given_x + on_reference_x
    return (
        w,
        1.0 - w,
        0.0,
        x_value - 3.0*lambda_x*x_value*x_value,
        -lambda_x - x_value*x_value*x_value,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    (x_value_at,) = x
    (x_value_mid,) = x_mid
    (u_value_at,) = u
    (u_value_mid,) = u_mid
    (x_value,) = x0
    steps = len(times) - 1
    t = times[0]
    x_value_at[0] = x_value
    u_value = u_value_at[0]
    slope_x_value = u_value - x_value*x_value*x_value
    slope_total = 0.5*u_value*u_value + 0.5*x_value*x_value
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x_value_at[i] = x_value
        u_value_half = u_value_mid[i]
        u_value_end = u_value_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        x_value_2 = half*slope_x_value + x_value
        k2_x_value = u_value_half - x_value_2*x_value_2*x_value_2
        k2_total = 0.5*u_value_half*u_value_half + 0.5*x_value_2*x_value_2
        x_value_3 = half*k2_x_value + x_value
        k3_x_value = u_value_half - x_value_3*x_value_3*x_value_3
        k3_total = 0.5*u_value_half*u_value_half + 0.5*x_value_3*x_value_3
        x_value_4 = h*k3_x_value + x_value
        k4_x_value = u_value_end - x_value_4*x_value_4*x_value_4
        k4_total = 0.5*u_value_end*u_value_end + 0.5*x_value_4*x_value_4
        x_value_end = sixth*(k4_x_value + slope_x_value + 2.0*(k2_x_value + k3_x_value)) + x_value
        slope_end_x_value = u_value_end - x_value_end*x_value_end*x_value_end
        slope_end_total = 0.5*u_value_end*u_value_end + 0.5*x_value_end*x_value_end
        eighth = 0.125*h
        x_value_mid[i] = eighth*(slope_x_value - slope_end_x_value) + 0.5*(x_value + x_value_end)
        total = sixth*(k4_total + slope_total + 2.0*(k2_total + k3_total)) + total
        t = t_end
        x_value = x_value_end
        slope_x_value = slope_end_x_value
        slope_total = slope_end_total
    x_value_at[steps] = x_value
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    (lambda_x_at,) = lam
    (lambda_x_mid,) = lam_mid
    (x_value_at,) = x
    (u_value_at,) = u
    (x_value_mid,) = x_mid
    (u_value_mid,) = u_mid
    (lambda_x,) = lam_f
    steps = len(times) - 1
    t = times[steps]
    lambda_x_at[steps] = lambda_x
    x_value = x_value_at[steps]
    w = 3.0*x_value*x_value
    slope_lambda_x = lambda_x*w - x_value
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        x_value_half = x_value_mid[i]
        x_value_end = x_value_at[i]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_x_2 = half*slope_lambda_x + lambda_x
        w_2 = 3.0*x_value_half*x_value_half
        k2_lambda_x = lambda_x_2*w_2 - x_value_half
        lambda_x_3 = half*k2_lambda_x + lambda_x
        k3_lambda_x = lambda_x_3*w_2 - x_value_half
        lambda_x_4 = h*k3_lambda_x + lambda_x
        w_3 = 3.0*x_value_end*x_value_end
        k4_lambda_x = lambda_x_4*w_3 - x_value_end
        lambda_x_end = lambda_x + sixth*(k4_lambda_x + slope_lambda_x + 2.0*(k2_lambda_x + k3_lambda_x))
        slope_end_lambda_x = lambda_x_end*w_3 - x_value_end
        eighth = 0.125*h
        lambda_x_mid[i] = eighth*(slope_lambda_x - slope_end_lambda_x) + 0.5*(lambda_x + lambda_x_end)
        lambda_x_at[i] = lambda_x_end
        t = t_end
        lambda_x = lambda_x_end
        slope_lambda_x = slope_end_lambda_x


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    (x_value,) = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, *p))
    out[0] = u_value - x_value*x_value*x_value
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    (x_value,) = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = -3.0*x_value*x_value
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    (x_value,) = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 1.0
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    (x_value,) = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.5*u_value*u_value + 0.5*x_value*x_value
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    (x_value,) = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    (x_value,) = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    (x_value,) = x
    (u_value,) = u
    (lambda_x,) = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    out[...] = lambda_x*(u_value - x_value*x_value*x_value) + 0.5*u_value*u_value + 0.5*x_value*x_value
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    (x_value,) = x
    (u_value,) = u
    (lambda_x,) = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = lambda_x + u_value
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    (x_value,) = x
    (u_value,) = u
    (lambda_x,) = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = 1.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    (x_value,) = x
    (lambda_x,) = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = -lambda_x
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    (x_value,) = x
    (u_value,) = u
    (lambda_x,) = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = 3.0*lambda_x*x_value*x_value - x_value
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    (x_value,) = x
    (lambda_x,) = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = -lambda_x - x_value*x_value*x_value
    out[1] = 3.0*lambda_x*x_value*x_value - x_value
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    (x_value,) = x
    (lambda_x,) = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = 3.0*x_value*x_value
    out[0, 0] = -w
    out[0, 1] = -1.0
    out[1, 0] = 6.0*lambda_x*x_value - 1.0
    out[1, 1] = w
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    (x_value,) = x
    (lambda_x,) = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = 0.0
    out[1] = 0.0
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    (x_value,) = x
    (lambda_x,) = lam
    given_x, on_reference_x, target_x = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[0] = given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value
    out[1] = 0.5*lambda_x*lambda_x + lambda_x*(-lambda_x - x_value*x_value*x_value) + 0.5*x_value*x_value
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    (x_value,) = x
    (lambda_x,) = lam
    given_x, on_reference_x, target_x = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, 3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = given_x + on_reference_x
    out[0, 0] = w
    out[0, 1] = 1.0 - w
    out[0, 2] = 0.0
    out[1, 0] = x_value - 3.0*lambda_x*x_value*x_value
    out[1, 1] = -lambda_x - x_value*x_value*x_value
    out[1, 2] = 0.0
    return out
