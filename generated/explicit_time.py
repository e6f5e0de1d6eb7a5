"""Explicit time dependence and a quadratic output.

Written by satsym from derivations/small_systems.py. Do not edit: mend that file instead, then run
    satsym derive derivations/small_systems.py
Source: ../derivations/small_systems.py 219aaf3a6733f2c363ccec0535df6f9d
Digest: f73df1658cd664753bee613a58332efa5f4dd53df3c1fcd997e74a85c77a46b7
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'explicit_time',
    'title': 'Explicit time dependence and a quadratic output',
    'source': 'derivations/small_systems.py',
    'states': (
        {'symbol': 'x1', 'latex': 'x_1', 'meaning': 'state 1'},
        {'symbol': 'x2', 'latex': 'x_2', 'meaning': 'state 2'},
    ),
    'controls': (
        {'symbol': 'u1', 'latex': 'u_1', 'meaning': 'control'},
    ),
    'parameters': (),
    'control_set': None,
    'has_cost': False,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': False,
    'invariants': (),
    'position': (),
    'multipliers': (),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x1, x2 = x
    (u1,) = u
    inv_t = 1.0/t
    return (
        u1 - t*x2,
        inv_t*x1,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x1, x2 = x
    (u1,) = u
    inv_t = 1.0/t
    return (
        0.0,
        -t,
        inv_t,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x1, x2 = x
    (u1,) = u
    return (
        1.0,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    x1_at, x2_at = x
    x1_mid, x2_mid = x_mid
    (u1_at,) = u
    (u1_mid,) = u_mid
    x1, x2 = x0
    steps = len(times) - 1
    t = times[0]
    x1_at[0] = x1
    x2_at[0] = x2
    u1 = u1_at[0]
    inv_t = 1.0/t
    slope_x1 = u1 - t*x2
    slope_x2 = inv_t*x1
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x1_at[i] = x1
        x2_at[i] = x2
        u1_half = u1_mid[i]
        u1_end = u1_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        x1_2 = half*slope_x1 + x1
        x2_2 = half*slope_x2 + x2
        w = half + t
        inv_w = 1.0/w
        k2_x1 = u1_half - w*x2_2
        k2_x2 = inv_w*x1_2
        x1_3 = half*k2_x1 + x1
        x2_3 = half*k2_x2 + x2
        k3_x1 = u1_half - w*x2_3
        k3_x2 = inv_w*x1_3
        x1_4 = h*k3_x1 + x1
        x2_4 = h*k3_x2 + x2
        inv_t_end = 1.0/t_end
        k4_x1 = u1_end - t_end*x2_4
        k4_x2 = inv_t_end*x1_4
        x1_end = sixth*(k4_x1 + slope_x1 + 2.0*(k2_x1 + k3_x1)) + x1
        x2_end = sixth*(k4_x2 + slope_x2 + 2.0*(k2_x2 + k3_x2)) + x2
        slope_end_x1 = u1_end - t_end*x2_end
        slope_end_x2 = inv_t_end*x1_end
        eighth = 0.125*h
        x1_mid[i] = eighth*(slope_x1 - slope_end_x1) + 0.5*(x1 + x1_end)
        x2_mid[i] = eighth*(slope_x2 - slope_end_x2) + 0.5*(x2 + x2_end)
        t = t_end
        x1 = x1_end
        x2 = x2_end
        slope_x1 = slope_end_x1
        slope_x2 = slope_end_x2
    x1_at[steps] = x1
    x2_at[steps] = x2


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x1, x2 = x
    (u1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    inv_t = 1.0/t
    out[0] = u1 - t*x2
    out[1] = inv_t*x1
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x1, x2 = x
    (u1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    inv_t = 1.0/t
    out[0, 0] = 0.0
    out[0, 1] = -t
    out[1, 0] = inv_t
    out[1, 1] = 0.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x1, x2 = x
    (u1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 1.0
    out[1, 0] = 0.0
    return out
