"""Minimum-time pitch manoeuvre, nondimensional.

Written by satsym from derivations/pitch_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/pitch_wheel.py
Source: ../derivations/pitch_wheel.py 6f132d08f603f74b458d9763f6cace18
Digest: 44d0a36c210a4c48a97e550088738459966f4fad4287b4dfde19304b509fad43
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'pitch_scaled_time',
    'title': 'Minimum-time pitch manoeuvre, nondimensional',
    'source': 'derivations/pitch_wheel.py',
    'states': (
        {'symbol': 'X1', 'latex': 'X_1', 'meaning': 'pitch angle'},
        {'symbol': 'X2', 'latex': 'X_2', 'meaning': 'rate of the pitch angle, in a unit of time set by the maximum torque'},
    ),
    'controls': (
        {'symbol': 'U', 'latex': 'U', 'meaning': 'torque of the wheel, relative to its maximum'},
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
    'switching_curve': (
        'X1',
        'X2',
    ),
    'objective_unit': '1',
    'linear_quadratic': True,
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    X1, X2 = x
    (U,) = u
    return (
        X2,
        U,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    X1, X2 = x
    (U,) = u
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
    return (
        0.0,
        1.0,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    X1, X2 = x
    (U,) = u
    return 1.0


def terminal_cost(t, x, p):
    """Terminal cost S."""
    X1, X2 = x
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    X1, X2 = x
    return (
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    return U*lambda_X2 + X2*lambda_X1 + 1.0


def switching_function(t, x, lam, p):
    """What multiplies each control in H."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    return (
        lambda_X2,
    )


def switching_rate(t, x, u, lam, p):
    """Its rates of change along an extremal."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    return (
        -lambda_X1,
    )


def magnitude_weight(t, x, lam, p):
    """What multiplies each |u| in H."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    return (
        0.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the box."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
    U = U_min if lambda_X2 > 0.0 else U_max if lambda_X2 < 0.0 else 0.5*(U_min + U_max)
    return (
        U,
    )


def extremal_jacobian(t, x, u, lam, p):
    """Rates of states and costates by states and costates, row by row, the controls being held."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    return (
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
        0.0,
        0.0,
        -1.0,
        0.0,
    )


def beyond_switching_curve(t, x, p, bounds, final):
    """How far the position lies beyond the switching curve of least time."""
    X1, X2 = x
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    inv_U_max = 1.0/U_max
    inv_U_min = 1.0/U_min
    w = X2 - target_X2
    Abs_w = math.fabs(w)
    return X1 - target_X1 - 0.25*(X2 + target_X2)*(w*(inv_U_max + inv_U_min) - Abs_w*(inv_U_max - inv_U_min))


def feedback_law(t, x, p, bounds, final):
    """The controls of least time, by the side of the switching curve."""
    X1, X2 = x
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    w = X2 - target_X2
    Abs_w = math.fabs(w)
    inv_U_max = 1.0/U_max
    inv_U_min = 1.0/U_min
    w_2 = inv_U_max - inv_U_min
    w_3 = -w*(inv_U_max + inv_U_min)
    w_4 = 0.25*X2 + 0.25*target_X2
    w_5 = target_X1 - X1
    w_6 = -w_4*(-Abs_w*w_2 - w_3) - w_5
    w_7 = 1.0 if w_6 > 0.0 else -1.0 if w_6 < 0.0 else 0.0
    w_8 = 1.0 if w > 0.0 else -1.0 if w < 0.0 else 0.0
    w_9 = w_7 + w_8*(1.0 - w_7*w_7)
    U = U_min if w_9 > 0.0 else U_max if w_9 < 0.0 else 0.5*(U_min + U_max)
    return (
        U,
    )


def transition_time(t, x, p, bounds, final):
    """How long the change of position takes from rest to rest."""
    X1, X2 = x
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    inv_U_min = 1.0/U_min
    inv_U_max = 1.0/U_max
    w = 2.0*inv_U_max - 2.0*inv_U_min
    sqrt_w = math.sqrt(w)
    w_2 = X1 - target_X1
    Abs_w_2 = math.fabs(w_2)
    sqrt_Abs_w_2 = math.sqrt(Abs_w_2)
    return sqrt_Abs_w_2*sqrt_w


def first_arc_time(t, x, p, bounds, final):
    """How long the first arc of it takes."""
    X1, X2 = x
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    inv_U_min = 1.0/U_min
    inv_U_max = 1.0/U_max
    w = 2.0*inv_U_max - 2.0*inv_U_min
    sqrt_w = math.sqrt(w)
    w_2 = X1 - target_X1
    Abs_w_2 = math.fabs(w_2)
    sqrt_Abs_w_2 = math.sqrt(Abs_w_2)
    w_3 = U_max - U_min
    inv_w_3 = 1.0/w_3
    w_4 = -w_2
    w_5 = 1.0 if w_4 > 0.0 else -1.0 if w_4 < 0.0 else 0.0
    return sqrt_Abs_w_2*sqrt_w*(0.5 - 0.5*inv_w_3*w_5*(U_max + U_min))


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    return (
        0.0,
        -lambda_X1,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
    inv_smoothing = 1.0/smoothing
    w = -inv_smoothing*lambda_X2
    w_2 = U_min if w < U_min else U_max if w > U_max else w
    return (
        X2,
        w_2,
        0.0,
        -lambda_X1,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
    inv_smoothing = 1.0/smoothing
    w = -inv_smoothing*lambda_X2
    w_2 = 0.0 if w < U_min else 0.0 if w > U_max else 1.0
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_smoothing*w_2,
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
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
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
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    inv_smoothing = 1.0/smoothing
    w = -inv_smoothing*lambda_X2
    w_2 = U_min if w < U_min else U_max if w > U_max else w
    return (
        X1*on_reference_X1 + given_X1*(X1 - target_X1) + lambda_X1*(1.0 - given_X1 - on_reference_X1),
        X2*on_reference_X2 + given_X2*(X2 - target_X2) + lambda_X2*(1.0 - given_X2 - on_reference_X2),
        X2*lambda_X1 + lambda_X2*w_2 + 0.5*smoothing*w_2*w_2 + 1.0,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    w = given_X1 + on_reference_X1
    w_2 = given_X2 + on_reference_X2
    inv_smoothing = 1.0/smoothing
    inv_smoothing_lambda_X2 = inv_smoothing*lambda_X2
    w_3 = -inv_smoothing_lambda_X2
    w_4 = U_min if w_3 < U_min else U_max if w_3 > U_max else w_3
    w_5 = 0.0 if w_3 < U_min else 0.0 if w_3 > U_max else 1.0
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
        lambda_X1,
        X2,
        w_4 - inv_smoothing_lambda_X2*w_5 - w_4*w_5,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
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
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        X1_at[i] = X1
        X2_at[i] = X2
        U_half = U_mid[i]
        U_end = U_at[i + 1]
        sixth = (1.0/6.0)*h
        k23_X2 = 2.0*U_half
        k123_X2 = k23_X2 + slope_X2
        X1_end = X1 + h*(X2 + k123_X2*sixth)
        X2_end = X2 + sixth*(U_end + k123_X2 + k23_X2)
        eighth = 0.125*h
        X1_mid[i] = eighth*(X2 - X2_end) + 0.5*(X1 + X1_end)
        X2_mid[i] = eighth*(slope_X2 - U_end) + 0.5*(X2 + X2_end)
        total = 6.0*sixth + total
        t = t_end
        X1 = X1_end
        X2 = X2_end
        slope_X2 = U_end
    X1_at[steps] = X1
    X2_at[steps] = X2
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
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
    slope_lambda_X2 = -lambda_X1
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        sixth = (1.0/6.0)*h
        k2_lambda_X2 = -lambda_X1
        lambda_X2_end = lambda_X2 + sixth*(5.0*k2_lambda_X2 + slope_lambda_X2)
        eighth = 0.125*h
        lambda_X1_mid[i] = lambda_X1
        lambda_X1_at[i] = lambda_X1
        lambda_X2_mid[i] = eighth*(slope_lambda_X2 - k2_lambda_X2) + 0.5*(lambda_X2 + lambda_X2_end)
        lambda_X2_at[i] = lambda_X2_end
        t = t_end
        lambda_X2 = lambda_X2_end
        slope_lambda_X2 = k2_lambda_X2


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    X1, X2 = x
    (U,) = u
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
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 0.0
    out[1, 0] = 1.0
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    X1, X2 = x
    (U,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 1.0
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    X1, X2 = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    X1, X2 = x
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
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    out[...] = U*lambda_X2 + X2*lambda_X1 + 1.0
    return out


def switching_function_batch(t, x, lam, p, out=None):
    """What multiplies each control in H. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p))
    out[0] = lambda_X2
    return out


def switching_rate_batch(t, x, u, lam, p, out=None):
    """Its rates of change along an extremal. Batch form."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = -lambda_X1
    return out


def magnitude_weight_batch(t, x, lam, p, out=None):
    """What multiplies each |u| in H. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p))
    out[0] = 0.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the box. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    U = np.heaviside(lambda_X2 - 0.0, 0.0)*U_min + np.heaviside(-lambda_X2 - 0.0, 0.0)*U_max + (1.0 - np.heaviside(lambda_X2 - 0.0, 0.0) - np.heaviside(-lambda_X2 - 0.0, 0.0))*0.5*(U_min + U_max)
    out[0] = U
    return out


def extremal_jacobian_batch(t, x, u, lam, p, out=None):
    """Rates of states and costates by states and costates, row by row, the controls being held. Batch form."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, lam, *p))
    out[...] = 0.0
    out[0, 1] = 1.0
    out[3, 2] = -1.0
    return out


def beyond_switching_curve_batch(t, x, p, bounds, final, out=None):
    """How far the position lies beyond the switching curve of least time. Batch form."""
    X1, X2 = x
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p, *bounds, *final))
    inv_U_max = 1.0/U_max
    inv_U_min = 1.0/U_min
    w = X2 - target_X2
    Abs_w = np.maximum(w, -w)
    out[...] = X1 - target_X1 - 0.25*(X2 + target_X2)*(w*(inv_U_max + inv_U_min) - Abs_w*(inv_U_max - inv_U_min))
    return out


def feedback_law_batch(t, x, p, bounds, final, out=None):
    """The controls of least time, by the side of the switching curve. Batch form."""
    X1, X2 = x
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, *p, *bounds, *final))
    w = X2 - target_X2
    Abs_w = np.maximum(w, -w)
    inv_U_max = 1.0/U_max
    inv_U_min = 1.0/U_min
    w_2 = inv_U_max - inv_U_min
    w_3 = -w*(inv_U_max + inv_U_min)
    w_4 = 0.25*X2 + 0.25*target_X2
    w_5 = target_X1 - X1
    w_6 = -w_4*(-Abs_w*w_2 - w_3) - w_5
    w_7 = np.heaviside(w_6, 0.0) - np.heaviside(-w_6, 0.0)
    w_8 = np.heaviside(w, 0.0) - np.heaviside(-w, 0.0)
    w_9 = w_7 + w_8*(1.0 - w_7*w_7)
    U = np.heaviside(w_9 - 0.0, 0.0)*U_min + np.heaviside(-w_9 - 0.0, 0.0)*U_max + (1.0 - np.heaviside(w_9 - 0.0, 0.0) - np.heaviside(-w_9 - 0.0, 0.0))*0.5*(U_min + U_max)
    out[0] = U
    return out


def transition_time_batch(t, x, p, bounds, final, out=None):
    """How long the change of position takes from rest to rest. Batch form."""
    X1, X2 = x
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p, *bounds, *final))
    inv_U_min = 1.0/U_min
    inv_U_max = 1.0/U_max
    w = 2.0*inv_U_max - 2.0*inv_U_min
    sqrt_w = np.sqrt(w)
    w_2 = X1 - target_X1
    Abs_w_2 = np.maximum(w_2, -w_2)
    sqrt_Abs_w_2 = np.sqrt(Abs_w_2)
    out[...] = sqrt_Abs_w_2*sqrt_w
    return out


def first_arc_time_batch(t, x, p, bounds, final, out=None):
    """How long the first arc of it takes. Batch form."""
    X1, X2 = x
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p, *bounds, *final))
    inv_U_min = 1.0/U_min
    inv_U_max = 1.0/U_max
    w = 2.0*inv_U_max - 2.0*inv_U_min
    sqrt_w = np.sqrt(w)
    w_2 = X1 - target_X1
    Abs_w_2 = np.maximum(w_2, -w_2)
    sqrt_Abs_w_2 = np.sqrt(Abs_w_2)
    w_3 = U_max - U_min
    inv_w_3 = 1.0/w_3
    w_4 = -w_2
    w_5 = np.heaviside(w_4, 0.0) - np.heaviside(-w_4, 0.0)
    out[...] = sqrt_Abs_w_2*sqrt_w*(0.5 - 0.5*inv_w_3*w_5*(U_max + U_min))
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    X1, X2 = x
    (U,) = u
    lambda_X1, lambda_X2 = lam
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = 0.0
    out[1] = -lambda_X1
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_smoothing = 1.0/smoothing
    w = -inv_smoothing*lambda_X2
    w_2 = np.minimum(np.maximum(w, U_min), U_max)
    out[0] = X2
    out[1] = w_2
    out[2] = 0.0
    out[3] = -lambda_X1
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    inv_smoothing = 1.0/smoothing
    w = -inv_smoothing*lambda_X2
    w_2 = np.heaviside(w - U_min, 1.0)*np.heaviside(U_max - w, 1.0)
    out[0, 1] = 1.0
    out[1, 3] = -inv_smoothing*w_2
    out[3, 2] = -1.0
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
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
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    inv_smoothing = 1.0/smoothing
    w = -inv_smoothing*lambda_X2
    w_2 = np.minimum(np.maximum(w, U_min), U_max)
    out[0] = X1*on_reference_X1 + given_X1*(X1 - target_X1) + lambda_X1*(1.0 - given_X1 - on_reference_X1)
    out[1] = X2*on_reference_X2 + given_X2*(X2 - target_X2) + lambda_X2*(1.0 - given_X2 - on_reference_X2)
    out[2] = X2*lambda_X1 + lambda_X2*w_2 + 0.5*smoothing*w_2*w_2 + 1.0
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    X1, X2 = x
    lambda_X1, lambda_X2 = lam
    U_min, U_max, smoothing, magnitude_share = bounds
    given_X1, given_X2, on_reference_X1, on_reference_X2, target_X1, target_X2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, 5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_X1 + on_reference_X1
    w_2 = given_X2 + on_reference_X2
    inv_smoothing = 1.0/smoothing
    inv_smoothing_lambda_X2 = inv_smoothing*lambda_X2
    w_3 = -inv_smoothing_lambda_X2
    w_4 = np.minimum(np.maximum(w_3, U_min), U_max)
    w_5 = np.heaviside(w_3 - U_min, 1.0)*np.heaviside(U_max - w_3, 1.0)
    out[0, 0] = w
    out[0, 2] = 1.0 - w
    out[1, 1] = w_2
    out[1, 3] = 1.0 - w_2
    out[2, 1] = lambda_X1
    out[2, 2] = X2
    out[2, 3] = w_4 - inv_smoothing_lambda_X2*w_5 - w_4*w_5
    return out
