"""Damping the Rayleigh oscillator with a state-dependent control bound.

Written by satsym from derivations/examples/oscillators.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/oscillators.py
Source: ../derivations/examples/oscillators.py 790e9a30cb29b5f02dee26a00093dde9
Digest: 3e3379e969da84a3db2c845921bb3751c8c947b0a8d11e70f2f4f7a46168bfbf
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'rayleigh_mixed',
    'title': 'Damping the Rayleigh oscillator with a state-dependent control bound',
    'source': 'derivations/examples/oscillators.py',
    'states': (
        {'symbol': 'x1', 'latex': 'x_1', 'meaning': 'state 1'},
        {'symbol': 'x2', 'latex': 'x_2', 'meaning': 'state 2'},
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
    'path_constraints': (
        {'name': 'bound', 'order': 0},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x1, x2 = x
    (u_value,) = u
    return (
        x2,
        4.0*u_value + x2*(1.4 - 0.14*x2*x2) - x1,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        0.0,
        1.0,
        -1.0,
        1.4 - 0.42*x2*x2,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        0.0,
        4.0,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x1, x2 = x
    (u_value,) = u
    return u_value*u_value + x1*x1


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
    return lambda_x1*x2 + lambda_x2*(4.0*u_value + x2*(1.4 - 0.14*x2*x2) - x1) + u_value*u_value + x1*x1


def stationarity(t, x, u, lam, p):
    """H_u."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        4.0*lambda_x2 + 2.0*u_value,
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
    return (
        -2.0*lambda_x2,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        lambda_x2 - 2.0*x1,
        lambda_x2*(0.42*x2*x2 - 1.4) - lambda_x1,
    )


def path_constraints(t, x, u, p, bounds):
    """What may not be positive along the way."""
    x1, x2 = x
    (u_value,) = u
    return (
        u_value + (1.0/6.0)*x1,
    )


def path_gradient(t, x, u, p):
    """Its derivatives by the states, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        1.0/6.0,
        0.0,
    )


def path_effect(t, x, u, p):
    """Its derivatives by the controls, row by row."""
    x1, x2 = x
    (u_value,) = u
    return (
        1.0,
    )


def path_rates(t, x, u, p):
    """Its first and second rates of change; 0 for those after the control."""
    x1, x2 = x
    (u_value,) = u
    return (
        0.0,
        0.0,
    )


def path_vanishing(t, x, u, lam, p, bounds):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        (1.0/6.0)*x1 - 2.0*lambda_x2,
        0.0,
    )


def path_multiplier(t, x, u, lam, p, bounds):
    """The multiplier of each while it is on its boundary."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    return (
        (1.0/3.0)*x1 - 4.0*lambda_x2,
    )


def boundary_control(t, x, lam, p, bounds):
    """The controls on the boundary of each, row by row."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    return (
        -1.0/6.0*x1,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    x2_sq = x2*x2
    return (
        x2,
        x2*(1.4 - 0.14*x2_sq) - 8.0*lambda_x2 - x1,
        lambda_x2 - 2.0*x1,
        lambda_x2*(0.42*x2_sq - 1.4) - lambda_x1,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    w = 0.42*x2*x2 - 1.4
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        -1.0,
        -w,
        0.0,
        -8.0,
        -2.0,
        0.0,
        0.0,
        1.0,
        0.0,
        0.84*lambda_x2*x2,
        -1.0,
        w,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
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
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    return (
        given_x1*(x1 - target_x1) + lambda_x1*(1.0 - given_x1 - on_reference_x1) + on_reference_x1*x1,
        given_x2*(x2 - target_x2) + lambda_x2*(1.0 - given_x2 - on_reference_x2) + on_reference_x2*x2,
        lambda_x1*x2 + 4.0*lambda_x2*lambda_x2 + lambda_x2*(x2*(1.4 - 0.14*x2*x2) - 8.0*lambda_x2 - x1) + x1*x1,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    w = given_x1 + on_reference_x1
    w_2 = given_x2 + on_reference_x2
    x2_sq = x2*x2
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
        2.0*x1 - lambda_x2,
        lambda_x1 + lambda_x2*(1.4 - 0.42*x2_sq),
        x2,
        x2*(1.4 - 0.14*x2_sq) - 8.0*lambda_x2 - x1,
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
    slope_x2 = 4.0*u_value + x2*(1.4 - 0.14*x2*x2) - x1
    slope_total = u_value*u_value + x1*x1
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
        k2_x2 = 4.0*u_value_half + x2_2*(1.4 - 0.14*x2_2*x2_2) - x1_2
        k2_total = u_value_half*u_value_half + x1_2*x1_2
        x1_3 = half*x2_2 + x1
        x2_3 = half*k2_x2 + x2
        k3_x2 = 4.0*u_value_half + x2_3*(1.4 - 0.14*x2_3*x2_3) - x1_3
        k3_total = u_value_half*u_value_half + x1_3*x1_3
        x1_4 = h*x2_3 + x1
        x2_4 = h*k3_x2 + x2
        k4_x2 = 4.0*u_value_end + x2_4*(1.4 - 0.14*x2_4*x2_4) - x1_4
        k4_total = u_value_end*u_value_end + x1_4*x1_4
        k23_x2 = k2_x2 + k3_x2
        k123_x2 = k23_x2 + slope_x2
        x1_end = h*(k123_x2*sixth + x2) + x1
        x2_end = sixth*(k123_x2 + k23_x2 + k4_x2) + x2
        slope_end_x2 = 4.0*u_value_end + x2_end*(1.4 - 0.14*x2_end*x2_end) - x1_end
        slope_end_total = u_value_end*u_value_end + x1_end*x1_end
        eighth = 0.125*h
        x1_mid[i] = eighth*(x2 - x2_end) + 0.5*(x1 + x1_end)
        x2_mid[i] = eighth*(slope_x2 - slope_end_x2) + 0.5*(x2 + x2_end)
        total = sixth*(k4_total + slope_total + 2.0*(k2_total + k3_total)) + total
        t = t_end
        x1 = x1_end
        x2 = x2_end
        slope_x2 = slope_end_x2
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
    w = 0.42*x2*x2 - 1.4
    slope_lambda_x1 = lambda_x2 - twice_x1
    slope_lambda_x2 = lambda_x2*w - lambda_x1
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
        w_2 = 0.42*x2_half*x2_half - 1.4
        k2_lambda_x1 = lambda_x2_2 - twice_x1_half
        k2_lambda_x2 = lambda_x2_2*w_2 - lambda_x1_2
        lambda_x1_3 = half*k2_lambda_x1 + lambda_x1
        lambda_x2_3 = half*k2_lambda_x2 + lambda_x2
        k3_lambda_x1 = lambda_x2_3 - twice_x1_half
        k3_lambda_x2 = lambda_x2_3*w_2 - lambda_x1_3
        lambda_x1_4 = h*k3_lambda_x1 + lambda_x1
        lambda_x2_4 = h*k3_lambda_x2 + lambda_x2
        twice_x1_end = 2.0*x1_end
        w_3 = 0.42*x2_end*x2_end - 1.4
        k4_lambda_x1 = lambda_x2_4 - twice_x1_end
        k4_lambda_x2 = lambda_x2_4*w_3 - lambda_x1_4
        lambda_x1_end = lambda_x1 + sixth*(k4_lambda_x1 + slope_lambda_x1 + 2.0*(k2_lambda_x1 + k3_lambda_x1))
        lambda_x2_end = lambda_x2 + sixth*(k4_lambda_x2 + slope_lambda_x2 + 2.0*(k2_lambda_x2 + k3_lambda_x2))
        slope_end_lambda_x1 = lambda_x2_end - twice_x1_end
        slope_end_lambda_x2 = lambda_x2_end*w_3 - lambda_x1_end
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
    out[0] = x2
    out[1] = 4.0*u_value + x2*(1.4 - 0.14*x2*x2) - x1
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 0.0
    out[0, 1] = 1.0
    out[1, 0] = -1.0
    out[1, 1] = 1.4 - 0.42*x2*x2
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 0.0
    out[1, 0] = 4.0
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = u_value*u_value + x1*x1
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
    out[...] = lambda_x1*x2 + lambda_x2*(4.0*u_value + x2*(1.4 - 0.14*x2*x2) - x1) + u_value*u_value + x1*x1
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = 4.0*lambda_x2 + 2.0*u_value
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
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = -2.0*lambda_x2
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = lambda_x2 - 2.0*x1
    out[1] = lambda_x2*(0.42*x2*x2 - 1.4) - lambda_x1
    return out


def path_constraints_batch(t, x, u, p, bounds, out=None):
    """What may not be positive along the way. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, *p, *bounds))
    out[0] = u_value + (1.0/6.0)*x1
    return out


def path_gradient_batch(t, x, u, p, out=None):
    """Its derivatives by the states, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, 2, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 1.0/6.0
    out[0, 1] = 0.0
    return out


def path_effect_batch(t, x, u, p, out=None):
    """Its derivatives by the controls, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 1.0
    return out


def path_rates_batch(t, x, u, p, out=None):
    """Its first and second rates of change; 0 for those after the control. Batch form."""
    x1, x2 = x
    (u_value,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def path_vanishing_batch(t, x, u, lam, p, bounds, out=None):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 2, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    out[0, 0] = (1.0/6.0)*x1 - 2.0*lambda_x2
    out[0, 1] = 0.0
    return out


def path_multiplier_batch(t, x, u, lam, p, bounds, out=None):
    """The multiplier of each while it is on its boundary. Batch form."""
    x1, x2 = x
    (u_value,) = u
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    out[0] = (1.0/3.0)*x1 - 4.0*lambda_x2
    return out


def boundary_control_batch(t, x, lam, p, bounds, out=None):
    """The controls on the boundary of each, row by row. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0, 0] = -1.0/6.0*x1
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    x2_sq = x2*x2
    out[0] = x2
    out[1] = x2*(1.4 - 0.14*x2_sq) - 8.0*lambda_x2 - x1
    out[2] = lambda_x2 - 2.0*x1
    out[3] = lambda_x2*(0.42*x2_sq - 1.4) - lambda_x1
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = 0.42*x2*x2 - 1.4
    out[0, 0] = 0.0
    out[0, 1] = 1.0
    out[0, 2] = 0.0
    out[0, 3] = 0.0
    out[1, 0] = -1.0
    out[1, 1] = -w
    out[1, 2] = 0.0
    out[1, 3] = -8.0
    out[2, 0] = -2.0
    out[2, 1] = 0.0
    out[2, 2] = 0.0
    out[2, 3] = 1.0
    out[3, 0] = 0.0
    out[3, 1] = 0.84*lambda_x2*x2
    out[3, 2] = -1.0
    out[3, 3] = w
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
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
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[0] = given_x1*(x1 - target_x1) + lambda_x1*(1.0 - given_x1 - on_reference_x1) + on_reference_x1*x1
    out[1] = given_x2*(x2 - target_x2) + lambda_x2*(1.0 - given_x2 - on_reference_x2) + on_reference_x2*x2
    out[2] = lambda_x1*x2 + 4.0*lambda_x2*lambda_x2 + lambda_x2*(x2*(1.4 - 0.14*x2*x2) - 8.0*lambda_x2 - x1) + x1*x1
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    x1, x2 = x
    lambda_x1, lambda_x2 = lam
    given_x1, given_x2, on_reference_x1, on_reference_x2, target_x1, target_x2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = given_x1 + on_reference_x1
    w_2 = given_x2 + on_reference_x2
    x2_sq = x2*x2
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
    out[2, 0] = 2.0*x1 - lambda_x2
    out[2, 1] = lambda_x1 + lambda_x2*(1.4 - 0.42*x2_sq)
    out[2, 2] = x2
    out[2, 3] = x2*(1.4 - 0.14*x2_sq) - 8.0*lambda_x2 - x1
    out[2, 4] = 0.0
    return out
