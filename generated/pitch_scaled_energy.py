"""Minimum-energy pitch manoeuvre, nondimensional.

Written by satsym from derivations/pitch_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/pitch_wheel.py
Source: ../derivations/pitch_wheel.py 6f132d08f603f74b458d9763f6cace18
Digest: 550a087ffd1ab84e8caf1e6bcb83a11105dc88d8a31f5b58f0437380e857f692
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'pitch_scaled_energy',
    'title': 'Minimum-energy pitch manoeuvre, nondimensional',
    'source': 'derivations/pitch_wheel.py',
    'states': (
        {'symbol': 'X1', 'latex': 'X_1', 'meaning': 'pitch angle'},
        {'symbol': 'X2', 'latex': 'X_2', 'meaning': 'rate of the pitch angle, in a unit of time set by the maximum torque'},
    ),
    'controls': (
        {'symbol': 'U', 'latex': 'U', 'meaning': 'torque of the wheel, relative to its maximum'},
    ),
    'parameters': (
        {'symbol': 'C_p', 'latex': 'C_p', 'meaning': 'weight of the wheel power relative to the heat', 'default': 0.1},
    ),
    'control_set': 'box',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'quantities': (
        {'symbol': 'scaled_power', 'latex': 'p', 'meaning': 'power relative to the heat dissipated at maximum torque'},
    ),
    'objective_unit': '1',
    'linear_quadratic': True,
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    return (
        X2,
        U,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    return (
        0.0,
        1.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    return (
        0.0,
        1.0,
    )


def quantities(t, x, u, p):
    """What is derived along the motion besides."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    return (
        U*(C_p*X2 + U),
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    return U*(C_p*X2 + U)


def terminal_cost(t, x, p):
    """Terminal cost S."""
    X1, X2 = x
    (C_p,) = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    X1, X2 = x
    (C_p,) = p
    return (
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    return U*lambda_X2 + U*(C_p*X2 + U) + X2*lambda_X1


def stationarity(t, x, u, lam, p):
    """H_u."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    return (
        C_p*X2 + 2.0*U + lambda_X2,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    return (
        2.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    w = -0.5*C_p*X2 - 0.5*lambda_X2
    U = U_min if w < U_min else U_max if w > U_max else w
    return (
        U,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    return (
        0.0,
        -C_p*U - lambda_X1,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    w = -0.5*C_p*X2 - 0.5*lambda_X2
    w_2 = U_min if w < U_min else U_max if w > U_max else w
    return (
        X2,
        w_2,
        0.0,
        -C_p*w_2 - lambda_X1,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    w = -0.5*C_p*X2 - 0.5*lambda_X2
    w_2 = 0.0 if w < U_min else 0.0 if w > U_max else 1.0
    half_w_2 = 0.5*w_2
    C_p_half_w_2 = C_p*half_w_2
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        -C_p_half_w_2,
        0.0,
        -half_w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        C_p*C_p*half_w_2,
        -1.0,
        C_p_half_w_2,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    C_p_X2 = C_p*X2
    w = -0.5*C_p_X2 - 0.5*lambda_X2
    w_2 = U_min if w < U_min else U_max if w > U_max else w
    return (
        X1*on_reference_X1 + given_X1*(X1 - target_X1) + lambda_X1*(1.0 - given_X1 - on_reference_X1),
        X2*on_reference_X2 + given_X2*(X2 - target_X2) + lambda_X2*(1.0 - given_X2 - on_reference_X2),
        X2*lambda_X1 + lambda_X2*w_2 + w_2*(C_p_X2 + w_2),
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    w = given_X1 + on_reference_X1
    w_2 = given_X2 + on_reference_X2
    half_lambda_X2 = 0.5*lambda_X2
    C_p_X2 = C_p*X2
    w_3 = -0.5*C_p_X2 - half_lambda_X2
    w_4 = U_min if w_3 < U_min else U_max if w_3 > U_max else w_3
    w_5 = 0.0 if w_3 < U_min else 0.0 if w_3 > U_max else 1.0
    half_lambda_X2_w_5 = half_lambda_X2*w_5
    half_w_5 = 0.5*w_5
    C_p_half_w_5 = C_p*half_w_5
    w_6 = C_p_X2 + w_4
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
        lambda_X1 + w_4*(C_p - C_p_half_w_5) - C_p*half_lambda_X2_w_5 - C_p_half_w_5*w_6,
        X2,
        w_4 - half_lambda_X2_w_5 - half_w_5*w_4 - half_w_5*w_6,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    (C_p,) = p
    X1_at, X2_at = x
    X1_mid, X2_mid = x_mid
    (U_at,) = u
    (U_mid,) = u_mid
    X1, X2 = x0
    steps = len(times) - 1
    t = times[0]
    X1_at[0] = X1
    X2_at[0] = X2
    U = U_at[0]
    slope_X2 = U
    slope_total = U*(C_p*X2 + U)
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        X1_at[i] = X1
        X2_at[i] = X2
        U_half = U_mid[i]
        U_end = U_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        X2_2 = X2 + half*slope_X2
        k2_total = U_half*(C_p*X2_2 + U_half)
        X2_3 = U_half*half + X2
        k3_total = U_half*(C_p*X2_3 + U_half)
        X2_4 = U_half*h + X2
        k4_total = U_end*(C_p*X2_4 + U_end)
        k23_X2 = 2.0*U_half
        k123_X2 = k23_X2 + slope_X2
        X1_end = X1 + h*(X2 + k123_X2*sixth)
        X2_end = X2 + sixth*(U_end + k123_X2 + k23_X2)
        slope_end_total = U_end*(C_p*X2_end + U_end)
        eighth = 0.125*h
        X1_mid[i] = eighth*(X2 - X2_end) + 0.5*(X1 + X1_end)
        X2_mid[i] = eighth*(slope_X2 - U_end) + 0.5*(X2 + X2_end)
        total = sixth*(k4_total + slope_total + 2.0*(k2_total + k3_total)) + total
        t = t_end
        X1 = X1_end
        X2 = X2_end
        slope_X2 = U_end
        slope_total = slope_end_total
    X1_at[steps] = X1
    X2_at[steps] = X2
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    (C_p,) = p
    lambda_X1_at, lambda_X2_at = lam
    lambda_X1_mid, lambda_X2_mid = lam_mid
    X1_at, X2_at = x
    (U_at,) = u
    X1_mid, X2_mid = x_mid
    (U_mid,) = u_mid
    lambda_X1, lambda_X2 = lam_f
    steps = len(times) - 1
    t = times[steps]
    lambda_X1_at[steps] = lambda_X1
    lambda_X2_at[steps] = lambda_X2
    U = U_at[steps]
    C_p_U = C_p*U
    slope_lambda_X2 = -C_p_U - lambda_X1
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        U_half = U_mid[i]
        U_end = U_at[i]
        sixth = (1.0/6.0)*h
        C_p_U_half = C_p*U_half
        k2_lambda_X2 = -C_p_U_half - lambda_X1
        C_p_U_end = C_p*U_end
        k4_lambda_X2 = -C_p_U_end - lambda_X1
        lambda_X2_end = lambda_X2 + sixth*(4.0*k2_lambda_X2 + k4_lambda_X2 + slope_lambda_X2)
        eighth = 0.125*h
        lambda_X1_mid[i] = lambda_X1
        lambda_X1_at[i] = lambda_X1
        lambda_X2_mid[i] = eighth*(slope_lambda_X2 - k4_lambda_X2) + 0.5*(lambda_X2 + lambda_X2_end)
        lambda_X2_at[i] = lambda_X2_end
        t = t_end
        lambda_X2 = lambda_X2_end
        slope_lambda_X2 = k4_lambda_X2


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    out[0] = X2
    out[1] = U
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[0, 1] = 1.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 0.0
    out[1, 0] = 1.0
    return out


def quantities_batch(t, x, u, p, out=None):
    """What is derived along the motion besides. Batch form."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, *p))
    out[0] = U*(C_p*X2 + U)
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    X1, X2 = x
    (U,) = u
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = U*(C_p*X2 + U)
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    X1, X2 = x
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    X1, X2 = x
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    out[...] = U*lambda_X2 + U*(C_p*X2 + U) + X2*lambda_X1
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = C_p*X2 + 2.0*U + lambda_X2
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = 2.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -0.5*C_p*X2 - 0.5*lambda_X2
    U = np.minimum(np.maximum(w, U_min), U_max)
    out[0] = U
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = 0.0
    out[1] = -C_p*U - lambda_X1
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -0.5*C_p*X2 - 0.5*lambda_X2
    w_2 = np.minimum(np.maximum(w, U_min), U_max)
    out[0] = X2
    out[1] = w_2
    out[2] = 0.0
    out[3] = -C_p*w_2 - lambda_X1
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    w = -0.5*C_p*X2 - 0.5*lambda_X2
    w_2 = np.heaviside(w - U_min, 1.0)*np.heaviside(U_max - w, 1.0)
    half_w_2 = 0.5*w_2
    C_p_half_w_2 = C_p*half_w_2
    out[0, 1] = 1.0
    out[1, 1] = -C_p_half_w_2
    out[1, 3] = -half_w_2
    out[3, 1] = C_p*C_p*half_w_2
    out[3, 2] = -1.0
    out[3, 3] = C_p_half_w_2
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
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
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    C_p_X2 = C_p*X2
    w = -0.5*C_p_X2 - 0.5*lambda_X2
    w_2 = np.minimum(np.maximum(w, U_min), U_max)
    out[0] = X1*on_reference_X1 + given_X1*(X1 - target_X1) + lambda_X1*(1.0 - given_X1 - on_reference_X1)
    out[1] = X2*on_reference_X2 + given_X2*(X2 - target_X2) + lambda_X2*(1.0 - given_X2 - on_reference_X2)
    out[2] = X2*lambda_X1 + lambda_X2*w_2 + w_2*(C_p_X2 + w_2)
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    (C_p,) = p
    U_min, U_max = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_X1 + on_reference_X1
    w_2 = given_X2 + on_reference_X2
    half_lambda_X2 = 0.5*lambda_X2
    C_p_X2 = C_p*X2
    w_3 = -0.5*C_p_X2 - half_lambda_X2
    w_4 = np.minimum(np.maximum(w_3, U_min), U_max)
    w_5 = np.heaviside(w_3 - U_min, 1.0)*np.heaviside(U_max - w_3, 1.0)
    half_lambda_X2_w_5 = half_lambda_X2*w_5
    half_w_5 = 0.5*w_5
    C_p_half_w_5 = C_p*half_w_5
    w_6 = C_p_X2 + w_4
    out[0, 0] = w
    out[0, 2] = 1.0 - w
    out[1, 1] = w_2
    out[1, 3] = 1.0 - w_2
    out[2, 1] = lambda_X1 + w_4*(C_p - C_p_half_w_5) - C_p*half_lambda_X2_w_5 - C_p_half_w_5*w_6
    out[2, 2] = X2
    out[2, 3] = w_4 - half_lambda_X2_w_5 - half_w_5*w_4 - half_w_5*w_6
    return out
