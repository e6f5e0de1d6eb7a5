"""Bryson-Denham problem: minimum effort with a position limit.

Written by satsym from derivations/examples/bryson_denham.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/bryson_denham.py
Source: ../derivations/examples/bryson_denham.py 47a4432d6ef6a5b62366746a5836594d
Digest: 6dfa98a5bd90bb95e07c9d3a688cfe9647b399aa7ecd7729bb9c053daa886954
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'bryson_denham',
    'title': 'Bryson-Denham problem: minimum effort with a position limit',
    'source': 'derivations/examples/bryson_denham.py',
    'states': (
        {'symbol': 'x', 'latex': 'x', 'meaning': 'position'},
        {'symbol': 'v', 'latex': 'v', 'meaning': 'velocity'},
    ),
    'controls': (
        {'symbol': 'u', 'latex': 'u', 'meaning': 'acceleration'},
    ),
    'parameters': (
        {'symbol': 'l', 'latex': '\\ell', 'meaning': 'position of the wall', 'default': 0.1111111111111111, 'positive': True},
    ),
    'control_set': 'free',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'objective_unit': '1',
    'path_constraints': (
        {'name': 'wall', 'order': 2},
    ),
    'linear_quadratic': True,
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    return (
        v,
        u_value,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    return (
        0.0,
        1.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    return (
        0.0,
        1.0,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    return 0.5*u_value*u_value


def terminal_cost(t, x, p):
    """Terminal cost S."""
    x_value, v = x
    (l,) = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    x_value, v = x
    (l,) = p
    return (
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    return lambda_v*u_value + lambda_x*v + 0.5*u_value*u_value


def stationarity(t, x, u, lam, p):
    """H_u."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        lambda_v + u_value,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        1.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        -lambda_v,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        0.0,
        -lambda_x,
    )


def path_constraints(t, x, u, p, bounds):
    """What may not be positive along the way."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    return (
        x_value - l,
    )


def path_gradient(t, x, u, p):
    """Its derivatives by the states, row by row."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    return (
        1.0,
        0.0,
    )


def path_effect(t, x, u, p):
    """Its derivatives by the controls, row by row."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    return (
        0.0,
    )


def path_rates(t, x, u, p):
    """Its first and second rates of change; 0 for those after the control."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    return (
        v,
        u_value,
    )


def path_vanishing(t, x, u, lam, p, bounds):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        -lambda_v,
        lambda_x,
    )


def path_multiplier(t, x, u, lam, p, bounds):
    """The multiplier of each while it is on its boundary."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        0.0,
    )


def boundary_control(t, x, lam, p, bounds):
    """The controls on the boundary of each, row by row."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        0.0,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        v,
        -lambda_v,
        0.0,
        -lambda_x,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        0.0,
        1.0,
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
        -1.0,
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    given_x, given_v, on_reference_x, on_reference_v, target_x, target_v = final
    return (
        given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value,
        given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v,
        lambda_x*v - 0.5*lambda_v*lambda_v,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    given_x, given_v, on_reference_x, on_reference_v, target_x, target_v = final
    w = given_x + on_reference_x
    w_2 = given_v + on_reference_v
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
        lambda_x,
        v,
        -lambda_v,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    (l,) = p
    x_value_at, v_at = x
    x_value_mid, v_mid = x_mid
    (u_value_at,) = u
    (u_value_mid,) = u_mid
    x_value, v = x0
    steps = len(times) - 1
    t = times[0]
    x_value_at[0] = x_value
    v_at[0] = v
    u_value = u_value_at[0]
    slope_v = u_value
    slope_total = 0.5*u_value*u_value
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x_value_at[i] = x_value
        v_at[i] = v
        u_value_half = u_value_mid[i]
        u_value_end = u_value_at[i + 1]
        sixth = (1.0/6.0)*h
        k2_total = 0.5*u_value_half*u_value_half
        k4_total = 0.5*u_value_end*u_value_end
        k23_v = 2.0*u_value_half
        k123_v = k23_v + slope_v
        x_value_end = h*(k123_v*sixth + v) + x_value
        v_end = sixth*(k123_v + k23_v + u_value_end) + v
        eighth = 0.125*h
        x_value_mid[i] = eighth*(v - v_end) + 0.5*(x_value + x_value_end)
        v_mid[i] = eighth*(slope_v - u_value_end) + 0.5*(v + v_end)
        total = sixth*(4.0*k2_total + k4_total + slope_total) + total
        t = t_end
        x_value = x_value_end
        v = v_end
        slope_v = u_value_end
        slope_total = k4_total
    x_value_at[steps] = x_value
    v_at[steps] = v
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    (l,) = p
    lambda_x_at, lambda_v_at = lam
    lambda_x_mid, lambda_v_mid = lam_mid
    x_value_at, v_at = x
    (u_value_at,) = u
    x_value_mid, v_mid = x_mid
    (u_value_mid,) = u_mid
    lambda_x, lambda_v = lam_f
    steps = len(times) - 1
    t = times[steps]
    lambda_x_at[steps] = lambda_x
    lambda_v_at[steps] = lambda_v
    slope_lambda_v = -lambda_x
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        sixth = (1.0/6.0)*h
        k2_lambda_v = -lambda_x
        lambda_v_end = lambda_v + sixth*(5.0*k2_lambda_v + slope_lambda_v)
        eighth = 0.125*h
        lambda_x_mid[i] = lambda_x
        lambda_x_at[i] = lambda_x
        lambda_v_mid[i] = eighth*(slope_lambda_v - k2_lambda_v) + 0.5*(lambda_v + lambda_v_end)
        lambda_v_at[i] = lambda_v_end
        t = t_end
        lambda_v = lambda_v_end
        slope_lambda_v = k2_lambda_v


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    out[0] = v
    out[1] = u_value
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[0, 1] = 1.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 0.0
    out[1, 0] = 1.0
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.5*u_value*u_value
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    x_value, v = x
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    x_value, v = x
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    out[...] = lambda_v*u_value + lambda_x*v + 0.5*u_value*u_value
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = lambda_v + u_value
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = 1.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = -lambda_v
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = 0.0
    out[1] = -lambda_x
    return out


def path_constraints_batch(t, x, u, p, bounds, out=None):
    """What may not be positive along the way. Batch form."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, *p, *bounds))
    out[0] = x_value - l
    return out


def path_gradient_batch(t, x, u, p, out=None):
    """Its derivatives by the states, row by row. Batch form."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, 2, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 1.0
    out[0, 1] = 0.0
    return out


def path_effect_batch(t, x, u, p, out=None):
    """Its derivatives by the controls, row by row. Batch form."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def path_rates_batch(t, x, u, p, out=None):
    """Its first and second rates of change; 0 for those after the control. Batch form."""
    x_value, v = x
    (u_value,) = u
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, 2, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = v
    out[0, 1] = u_value
    return out


def path_vanishing_batch(t, x, u, lam, p, bounds, out=None):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row. Batch form."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 2, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    out[0, 0] = -lambda_v
    out[0, 1] = lambda_x
    return out


def path_multiplier_batch(t, x, u, lam, p, bounds, out=None):
    """The multiplier of each while it is on its boundary. Batch form."""
    x_value, v = x
    (u_value,) = u
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    out[0] = 0.0
    return out


def boundary_control_batch(t, x, lam, p, bounds, out=None):
    """The controls on the boundary of each, row by row. Batch form."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = v
    out[1] = -lambda_v
    out[2] = 0.0
    out[3] = -lambda_x
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    out[0, 1] = 1.0
    out[1, 3] = -1.0
    out[3, 2] = -1.0
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
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
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    given_x, given_v, on_reference_x, on_reference_v, target_x, target_v = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[0] = given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value
    out[1] = given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v
    out[2] = lambda_x*v - 0.5*lambda_v*lambda_v
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    x_value, v = x
    lambda_x, lambda_v = lam
    (l,) = p
    given_x, given_v, on_reference_x, on_reference_v, target_x, target_v = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_x + on_reference_x
    w_2 = given_v + on_reference_v
    out[0, 0] = w
    out[0, 2] = 1.0 - w
    out[1, 1] = w_2
    out[1, 3] = 1.0 - w_2
    out[2, 1] = lambda_x
    out[2, 2] = v
    out[2, 3] = -lambda_v
    return out
