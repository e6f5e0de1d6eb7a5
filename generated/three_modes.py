"""Three real modes, two of which grow.

Written by satsym from derivations/small_systems.py. Do not edit: mend that file instead, then run
    satsym derive derivations/small_systems.py
Source: ../derivations/small_systems.py 219aaf3a6733f2c363ccec0535df6f9d
Digest: 520d94fddee6c549d1564b8a1438f0585df998b114b13061b8053603ed983bce
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'three_modes',
    'title': 'Three real modes, two of which grow',
    'source': 'derivations/small_systems.py',
    'states': (
        {'symbol': 'x1', 'latex': 'x_1', 'meaning': 'state 1'},
        {'symbol': 'x2', 'latex': 'x_2', 'meaning': 'state 2'},
        {'symbol': 'x3', 'latex': 'x_3', 'meaning': 'state 3'},
    ),
    'controls': (),
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
        'characteristic_polynomial',
        'routh_column',
        'eigenvalues',
        'transition_matrix',
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x1, x2, x3 = x
    return (
        x1,
        x1 + 2.0*x2,
        x1 - x3,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x1, x2, x3 = x
    return (
        1.0,
        0.0,
        0.0,
        1.0,
        2.0,
        0.0,
        1.0,
        0.0,
        -1.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x1, x2, x3 = x
    return (
    )


def state_matrix(t, p):
    """A, row by row."""
    return (
        1.0,
        0.0,
        0.0,
        1.0,
        2.0,
        0.0,
        1.0,
        0.0,
        -1.0,
    )


def characteristic_polynomial(p):
    """det(s I - A), highest power first."""
    return (
        1.0,
        -2.0,
        -1.0,
        2.0,
    )


def routh_column(p):
    """First column of the Routh array of the characteristic polynomial."""
    return (
        1.0,
        -2.0,
        -4.0,
        2.0,
    )


def eigenvalues(p):
    """Eigenvalues of A: rows of a real and an imaginary part."""
    return (
        2.0,
        0.0,
        1.0,
        0.0,
        -1.0,
        0.0,
    )


def transition_matrix(t, p):
    """e^(At), row by row."""
    exp_t = math.exp(t)
    w = math.exp(2.0*t)
    w_2 = math.exp(-t)
    return (
        exp_t,
        0.0,
        0.0,
        w - exp_t,
        w,
        0.0,
        0.5*exp_t - 0.5*w_2,
        0.0,
        w_2,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    x1_at, x2_at, x3_at = x
    x1_mid, x2_mid, x3_mid = x_mid
    x1, x2, x3 = x0
    steps = len(times) - 1
    t = times[0]
    x1_at[0] = x1
    x2_at[0] = x2
    x3_at[0] = x3
    slope_x2 = x1 + 2.0*x2
    slope_x3 = x1 - x3
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x1_at[i] = x1
        x2_at[i] = x2
        x3_at[i] = x3
        half = 0.5*h
        sixth = (1.0/6.0)*h
        x1_2 = half*x1 + x1
        x2_2 = half*slope_x2 + x2
        x3_2 = half*slope_x3 + x3
        k2_x2 = x1_2 + 2.0*x2_2
        k2_x3 = x1_2 - x3_2
        x1_3 = half*x1_2 + x1
        x2_3 = half*k2_x2 + x2
        x3_3 = half*k2_x3 + x3
        k3_x2 = x1_3 + 2.0*x2_3
        k3_x3 = x1_3 - x3_3
        x1_4 = h*x1_3 + x1
        x2_4 = h*k3_x2 + x2
        x3_4 = h*k3_x3 + x3
        k4_x2 = x1_4 + 2.0*x2_4
        k4_x3 = x1_4 - x3_4
        k23_x1 = x1_2 + x1_3
        k123_x1 = k23_x1 + x1
        x1_end = h*(k123_x1*sixth + x1) + x1
        x2_end = sixth*(k4_x2 + slope_x2 + 2.0*(k2_x2 + k3_x2)) + x2
        x3_end = sixth*(k4_x3 + slope_x3 + 2.0*(k2_x3 + k3_x3)) + x3
        slope_end_x2 = x1_end + 2.0*x2_end
        slope_end_x3 = x1_end - x3_end
        eighth = 0.125*h
        x1_mid[i] = eighth*(x1 - x1_end) + 0.5*(x1 + x1_end)
        x2_mid[i] = eighth*(slope_x2 - slope_end_x2) + 0.5*(x2 + x2_end)
        x3_mid[i] = eighth*(slope_x3 - slope_end_x3) + 0.5*(x3 + x3_end)
        t = t_end
        x1 = x1_end
        x2 = x2_end
        x3 = x3_end
        slope_x2 = slope_end_x2
        slope_x3 = slope_end_x3
    x1_at[steps] = x1
    x2_at[steps] = x2
    x3_at[steps] = x3


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x1, x2, x3 = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, *p))
    out[0] = x1
    out[1] = x1 + 2.0*x2
    out[2] = x1 - x3
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x1, x2, x3 = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, 3, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 1.0
    out[0, 1] = 0.0
    out[0, 2] = 0.0
    out[1, 0] = 1.0
    out[1, 1] = 2.0
    out[1, 2] = 0.0
    out[2, 0] = 1.0
    out[2, 1] = 0.0
    out[2, 2] = -1.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x1, x2, x3 = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, 0, *shape), np.result_type(float, t, x, u, *p))
    return out


def state_matrix_batch(t, p, out=None):
    """A, row by row. Batch form."""
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((3, 3, *shape), np.result_type(float, t, *p))
    out[0, 0] = 1.0
    out[0, 1] = 0.0
    out[0, 2] = 0.0
    out[1, 0] = 1.0
    out[1, 1] = 2.0
    out[1, 2] = 0.0
    out[2, 0] = 1.0
    out[2, 1] = 0.0
    out[2, 2] = -1.0
    return out


def characteristic_polynomial_batch(p, out=None):
    """det(s I - A), highest power first. Batch form."""
    if out is None:
        shape = np.broadcast_shapes()
        out = np.empty((4, *shape), np.result_type(float, *p))
    out[0] = 1.0
    out[1] = -2.0
    out[2] = -1.0
    out[3] = 2.0
    return out


def routh_column_batch(p, out=None):
    """First column of the Routh array of the characteristic polynomial. Batch form."""
    if out is None:
        shape = np.broadcast_shapes()
        out = np.empty((4, *shape), np.result_type(float, *p))
    out[0] = 1.0
    out[1] = -2.0
    out[2] = -4.0
    out[3] = 2.0
    return out


def eigenvalues_batch(p, out=None):
    """Eigenvalues of A: rows of a real and an imaginary part. Batch form."""
    if out is None:
        shape = np.broadcast_shapes()
        out = np.empty((3, 2, *shape), np.result_type(float, *p))
    out[0, 0] = 2.0
    out[0, 1] = 0.0
    out[1, 0] = 1.0
    out[1, 1] = 0.0
    out[2, 0] = -1.0
    out[2, 1] = 0.0
    return out


def transition_matrix_batch(t, p, out=None):
    """e^(At), row by row. Batch form."""
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((3, 3, *shape), np.result_type(float, t, *p))
    exp_t = np.exp(t)
    w = np.exp(2.0*t)
    w_2 = np.exp(-t)
    out[0, 0] = exp_t
    out[0, 1] = 0.0
    out[0, 2] = 0.0
    out[1, 0] = w - exp_t
    out[1, 1] = w
    out[1, 2] = 0.0
    out[2, 0] = 0.5*exp_t - 0.5*w_2
    out[2, 1] = 0.0
    out[2, 2] = w_2
    return out
