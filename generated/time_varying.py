"""Linearisation about a time-varying trajectory.

Written by satsym from derivations/small_systems.py. Do not edit: mend that file instead, then run
    satsym derive derivations/small_systems.py
Source: ../derivations/small_systems.py 219aaf3a6733f2c363ccec0535df6f9d
Digest: b9bdcf8861eae2a2e6bdffe55d91d91e5d313209cca4959899c82e12b4f3568a
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'time_varying',
    'title': 'Linearisation about a time-varying trajectory',
    'source': 'derivations/small_systems.py',
    'states': (
        {'symbol': 'z1', 'latex': 'z_1', 'meaning': 'deviation of state 1'},
        {'symbol': 'z2', 'latex': 'z_2', 'meaning': 'deviation of state 2'},
    ),
    'controls': (
        {'symbol': 'v1', 'latex': 'v_1', 'meaning': 'deviation of the control'},
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
    'outputs': (
        {'symbol': 'w1', 'latex': 'w_1', 'meaning': 'deviation of the output'},
    ),
    'linear': (
        'state_matrix',
        'input_matrix',
        'output_matrix',
        'feedthrough_matrix',
        'deviation_dynamics',
        'original_state',
        'deviation_state',
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    z1, z2 = x
    (v1,) = u
    inv_t = 1.0/t
    return (
        v1 - t*z2,
        inv_t*z1,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    z1, z2 = x
    (v1,) = u
    inv_t = 1.0/t
    return (
        0.0,
        -t,
        inv_t,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    z1, z2 = x
    (v1,) = u
    return (
        1.0,
        0.0,
    )


def state_matrix(t, p):
    """A, row by row."""
    inv_t = 1.0/t
    return (
        0.0,
        -t,
        inv_t,
        0.0,
    )


def input_matrix(t, p):
    """B, row by row."""
    return (
        1.0,
        0.0,
    )


def output_matrix(t, p):
    """C, row by row."""
    inv_t = 1.0/t
    return (
        2.0*inv_t*math.sin(t),
        -2.0*t*math.cos(t),
    )


def feedthrough_matrix(t, p):
    """D, row by row."""
    return (
        0.0,
    )


def deviation_dynamics(t, x, u, p):
    """Exact rates of change of the deviations."""
    z1, z2 = x
    (v1,) = u
    inv_t = 1.0/t
    return (
        v1 - t*z2,
        inv_t*z1,
    )


def original_state(t, x, p):
    """The original states at a deviation."""
    z1, z2 = x
    return (
        t*math.sin(t) + z1,
        z2 - math.cos(t),
    )


def deviation_state(t, original, p):
    """The deviation at original states."""
    x1, x2 = original
    return (
        x1 - t*math.sin(t),
        x2 + math.cos(t),
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    z1_at, z2_at = x
    z1_mid, z2_mid = x_mid
    (v1_at,) = u
    (v1_mid,) = u_mid
    z1, z2 = x0
    steps = len(times) - 1
    t = times[0]
    z1_at[0] = z1
    z2_at[0] = z2
    v1 = v1_at[0]
    inv_t = 1.0/t
    slope_z1 = v1 - t*z2
    slope_z2 = inv_t*z1
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        z1_at[i] = z1
        z2_at[i] = z2
        v1_half = v1_mid[i]
        v1_end = v1_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        z1_2 = half*slope_z1 + z1
        z2_2 = half*slope_z2 + z2
        w = half + t
        inv_w = 1.0/w
        k2_z1 = v1_half - w*z2_2
        k2_z2 = inv_w*z1_2
        z1_3 = half*k2_z1 + z1
        z2_3 = half*k2_z2 + z2
        k3_z1 = v1_half - w*z2_3
        k3_z2 = inv_w*z1_3
        z1_4 = h*k3_z1 + z1
        z2_4 = h*k3_z2 + z2
        inv_t_end = 1.0/t_end
        k4_z1 = v1_end - t_end*z2_4
        k4_z2 = inv_t_end*z1_4
        z1_end = sixth*(k4_z1 + slope_z1 + 2.0*(k2_z1 + k3_z1)) + z1
        z2_end = sixth*(k4_z2 + slope_z2 + 2.0*(k2_z2 + k3_z2)) + z2
        slope_end_z1 = v1_end - t_end*z2_end
        slope_end_z2 = inv_t_end*z1_end
        eighth = 0.125*h
        z1_mid[i] = eighth*(slope_z1 - slope_end_z1) + 0.5*(z1 + z1_end)
        z2_mid[i] = eighth*(slope_z2 - slope_end_z2) + 0.5*(z2 + z2_end)
        t = t_end
        z1 = z1_end
        z2 = z2_end
        slope_z1 = slope_end_z1
        slope_z2 = slope_end_z2
    z1_at[steps] = z1
    z2_at[steps] = z2


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    z1, z2 = x
    (v1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    inv_t = 1.0/t
    out[0] = v1 - t*z2
    out[1] = inv_t*z1
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    z1, z2 = x
    (v1,) = u
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
    z1, z2 = x
    (v1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 1, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = 1.0
    out[1, 0] = 0.0
    return out


def state_matrix_batch(t, p, out=None):
    """A, row by row. Batch form."""
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((2, 2, *shape), np.result_type(float, t, *p))
    inv_t = 1.0/t
    out[0, 0] = 0.0
    out[0, 1] = -t
    out[1, 0] = inv_t
    out[1, 1] = 0.0
    return out


def input_matrix_batch(t, p, out=None):
    """B, row by row. Batch form."""
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((2, 1, *shape), np.result_type(float, t, *p))
    out[0, 0] = 1.0
    out[1, 0] = 0.0
    return out


def output_matrix_batch(t, p, out=None):
    """C, row by row. Batch form."""
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((1, 2, *shape), np.result_type(float, t, *p))
    inv_t = 1.0/t
    out[0, 0] = 2.0*inv_t*np.sin(t)
    out[0, 1] = -2.0*t*np.cos(t)
    return out


def feedthrough_matrix_batch(t, p, out=None):
    """D, row by row. Batch form."""
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((1, 1, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    return out


def deviation_dynamics_batch(t, x, u, p, out=None):
    """Exact rates of change of the deviations. Batch form."""
    z1, z2 = x
    (v1,) = u
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p))
    inv_t = 1.0/t
    out[0] = v1 - t*z2
    out[1] = inv_t*z1
    return out


def original_state_batch(t, x, p, out=None):
    """The original states at a deviation. Batch form."""
    z1, z2 = x
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = t*np.sin(t) + z1
    out[1] = z2 - np.cos(t)
    return out


def deviation_state_batch(t, original, p, out=None):
    """The deviation at original states. Batch form."""
    x1, x2 = original
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(original[0]))
        out = np.empty((2, *shape), np.result_type(float, t, original, *p))
    out[0] = x1 - t*np.sin(t)
    out[1] = x2 + np.cos(t)
    return out
