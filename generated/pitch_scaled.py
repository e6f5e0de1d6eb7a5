"""Pitch axis of a symmetric satellite, nondimensional.

Written by satsym from derivations/pitch_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/pitch_wheel.py
Source: ../derivations/pitch_wheel.py 6f132d08f603f74b458d9763f6cace18
Digest: 152f2b36bceea0cdd7a21e40202f42a5dbb0a417f32396816d7fd59df21c32ca
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'pitch_scaled',
    'title': 'Pitch axis of a symmetric satellite, nondimensional',
    'source': 'derivations/pitch_wheel.py',
    'states': (
        {'symbol': 'X1', 'latex': 'X_1', 'meaning': 'pitch angle'},
        {'symbol': 'X2', 'latex': 'X_2', 'meaning': 'rate of the pitch angle, in a unit of time set by the maximum torque'},
    ),
    'controls': (
        {'symbol': 'U', 'latex': 'U', 'meaning': 'torque of the wheel, relative to its maximum'},
    ),
    'parameters': (),
    'control_set': None,
    'has_cost': False,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'linear': (
        'state_matrix',
        'input_matrix',
        'characteristic_polynomial',
        'routh_column',
        'eigenvalues',
        'transition_matrix',
        'closed_loop_polynomial',
        'closed_loop_routh',
        'riccati_residual',
    ),
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


def state_matrix(t, p):
    """A, row by row."""
    return (
        0.0,
        1.0,
        0.0,
        0.0,
    )


def input_matrix(t, p):
    """B, row by row."""
    return (
        0.0,
        1.0,
    )


def characteristic_polynomial(p):
    """det(s I - A), highest power first."""
    return (
        1.0,
        0.0,
        0.0,
    )


def routh_column(p):
    """First column of the Routh array of the characteristic polynomial."""
    return (
        1.0,
        2.0,
        2.0,
    )


def eigenvalues(p):
    """Eigenvalues of A: rows of a real and an imaginary part."""
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def transition_matrix(t, p):
    """e^(At), row by row."""
    return (
        1.0,
        t,
        0.0,
        1.0,
    )


def closed_loop_polynomial(gain, p):
    """det(s I - A + B K), highest power first."""
    K_1_1, K_1_2 = gain
    return (
        1.0,
        K_1_2,
        K_1_1,
    )


def closed_loop_routh(gain, p):
    """First column of the Routh array of the closed loop; not finite where an element but the last vanishes."""
    K_1_1, K_1_2 = gain
    return (
        1.0,
        K_1_2,
        K_1_1,
    )


def riccati_residual(riccati, state_weight, control_weight, p):
    """A' P + P A - P B R^-1 B' P + Q, row by row."""
    P_1_1, P_1_2, P_2_1, P_2_2 = riccati
    Q_1_1, Q_1_2, Q_2_1, Q_2_2 = state_weight
    (R_1_1,) = control_weight
    inv_R_1_1 = 1.0/R_1_1
    P_1_2_inv_R_1_1 = P_1_2*inv_R_1_1
    return (
        Q_1_1 - P_1_2_inv_R_1_1*P_2_1,
        P_1_1 + Q_1_2 - P_1_2_inv_R_1_1*P_2_2,
        P_1_1 + Q_2_1 - P_2_1*P_2_2*inv_R_1_1,
        P_1_2 + P_2_1 + Q_2_2 - P_2_2*P_2_2*inv_R_1_1,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
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
        t = t_end
        X1 = X1_end
        X2 = X2_end
        slope_X2 = U_end
    X1_at[steps] = X1
    X2_at[steps] = X2


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


def state_matrix_batch(t, p, out=None):
    """A, row by row. Batch form."""
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((2, 2, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    out[0, 1] = 1.0
    return out


def input_matrix_batch(t, p, out=None):
    """B, row by row. Batch form."""
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((2, 1, *shape), np.result_type(float, t, *p))
    out[0, 0] = 0.0
    out[1, 0] = 1.0
    return out


def characteristic_polynomial_batch(p, out=None):
    """det(s I - A), highest power first. Batch form."""
    if out is None:
        shape = np.broadcast_shapes()
        out = np.empty((3, *shape), np.result_type(float, *p))
    out[0] = 1.0
    out[1] = 0.0
    out[2] = 0.0
    return out


def routh_column_batch(p, out=None):
    """First column of the Routh array of the characteristic polynomial. Batch form."""
    if out is None:
        shape = np.broadcast_shapes()
        out = np.empty((3, *shape), np.result_type(float, *p))
    out[0] = 1.0
    out[1] = 2.0
    out[2] = 2.0
    return out


def eigenvalues_batch(p, out=None):
    """Eigenvalues of A: rows of a real and an imaginary part. Batch form."""
    if out is None:
        shape = np.broadcast_shapes()
        out = np.empty((2, 2, *shape), np.result_type(float, *p))
    out[...] = 0.0
    return out


def transition_matrix_batch(t, p, out=None):
    """e^(At), row by row. Batch form."""
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((2, 2, *shape), np.result_type(float, t, *p))
    out[0, 0] = 1.0
    out[0, 1] = t
    out[1, 0] = 0.0
    out[1, 1] = 1.0
    return out


def closed_loop_polynomial_batch(gain, p, out=None):
    """det(s I - A + B K), highest power first. Batch form."""
    K_1_1, K_1_2 = gain
    if out is None:
        shape = np.broadcast_shapes(np.shape(gain[0]))
        out = np.empty((3, *shape), np.result_type(float, gain, *p))
    out[0] = 1.0
    out[1] = K_1_2
    out[2] = K_1_1
    return out


def closed_loop_routh_batch(gain, p, out=None):
    """First column of the Routh array of the closed loop; not finite where an element but the last vanishes. Batch form."""
    K_1_1, K_1_2 = gain
    if out is None:
        shape = np.broadcast_shapes(np.shape(gain[0]))
        out = np.empty((3, *shape), np.result_type(float, gain, *p))
    out[0] = 1.0
    out[1] = K_1_2
    out[2] = K_1_1
    return out


def riccati_residual_batch(riccati, state_weight, control_weight, p, out=None):
    """A' P + P A - P B R^-1 B' P + Q, row by row. Batch form."""
    P_1_1, P_1_2, P_2_1, P_2_2 = riccati
    Q_1_1, Q_1_2, Q_2_1, Q_2_2 = state_weight
    (R_1_1,) = control_weight
    if out is None:
        shape = np.broadcast_shapes(np.shape(riccati[0]), np.shape(state_weight[0]), np.shape(control_weight[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, riccati, state_weight, control_weight, *p))
    inv_R_1_1 = 1.0/R_1_1
    P_1_2_inv_R_1_1 = P_1_2*inv_R_1_1
    out[0, 0] = Q_1_1 - P_1_2_inv_R_1_1*P_2_1
    out[0, 1] = P_1_1 + Q_1_2 - P_1_2_inv_R_1_1*P_2_2
    out[1, 0] = P_1_1 + Q_2_1 - P_2_1*P_2_2*inv_R_1_1
    out[1, 1] = P_1_2 + P_2_1 + Q_2_2 - P_2_2*P_2_2*inv_R_1_1
    return out
