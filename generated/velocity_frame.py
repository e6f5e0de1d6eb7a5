"""Axes aligned with the velocity on a Kepler orbit.

Written by satsym from derivations/examples/velocity_frame.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/velocity_frame.py
Source: ../derivations/examples/velocity_frame.py 4986ef846e7b8eae0ff647d0b7424e2c
Digest: a42a5d68d566df89b64c715409fbf67951a2a10fcf44af15602c1bae80788393
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'velocity_frame',
    'title': 'Axes aligned with the velocity on a Kepler orbit',
    'source': 'derivations/examples/velocity_frame.py',
    'states': (
        {'symbol': 'f', 'latex': 'f', 'unit': 'rad', 'meaning': 'true anomaly', 'kind': 'angle'},
    ),
    'controls': (),
    'parameters': (
        {'symbol': 'e', 'latex': 'e', 'meaning': 'eccentricity', 'default': 0.3, 'positive': True, 'typical': (0.05, 0.8)},
        {'symbol': 'p', 'latex': 'p', 'unit': 'km', 'meaning': 'semi-latus rectum', 'default': 1.0, 'positive': True},
        {'symbol': 'mu', 'latex': '\\mu', 'unit': 'km**3/s**2', 'meaning': 'gravitational parameter', 'default': 1.0, 'positive': True},
    ),
    'control_set': None,
    'has_cost': False,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    (f,) = x
    e, p_value, mu = p
    inv_p_value = 1.0/p_value
    w = e*math.cos(f) + 1.0
    sqrt_mu = math.sqrt(mu)
    sqrt_p_value = math.sqrt(p_value)
    h = sqrt_mu*sqrt_p_value
    return (
        h*inv_p_value*inv_p_value*w*w,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    (f,) = x
    e, p_value, mu = p
    inv_p_value = 1.0/p_value
    sqrt_mu = math.sqrt(mu)
    sqrt_p_value = math.sqrt(p_value)
    h = sqrt_mu*sqrt_p_value
    return (
        -2.0*e*h*inv_p_value*inv_p_value*(e*math.cos(f) + 1.0)*math.sin(f),
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    (f,) = x
    e, p_value, mu = p
    return (
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    e, p_value, mu = p
    (f_at,) = x
    (f_mid,) = x_mid
    (f,) = x0
    inv_p_value = 1.0/p_value
    sqrt_mu = math.sqrt(mu)
    sqrt_p_value = math.sqrt(p_value)
    h_2 = sqrt_mu*sqrt_p_value
    w_2 = h_2*inv_p_value*inv_p_value
    steps = len(times) - 1
    t = times[0]
    f_at[0] = f
    w = e*math.cos(f) + 1.0
    slope_f = w*w*w_2
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        f_at[i] = f
        half = 0.5*h
        sixth = (1.0/6.0)*h
        f_2 = f + half*slope_f
        w_3 = e*math.cos(f_2) + 1.0
        k2_f = w_2*w_3*w_3
        f_3 = f + half*k2_f
        w_4 = e*math.cos(f_3) + 1.0
        k3_f = w_2*w_4*w_4
        f_4 = f + h*k3_f
        w_5 = e*math.cos(f_4) + 1.0
        k4_f = w_2*w_5*w_5
        f_end = f + sixth*(k4_f + slope_f + 2.0*(k2_f + k3_f))
        w_6 = e*math.cos(f_end) + 1.0
        slope_end_f = w_2*w_6*w_6
        eighth = 0.125*h
        f_mid[i] = eighth*(slope_f - slope_end_f) + 0.5*(f + f_end)
        t = t_end
        f = f_end
        slope_f = slope_end_f
    f_at[steps] = f


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    (f,) = x
    e, p_value, mu = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, *p))
    inv_p_value = 1.0/p_value
    w = e*np.cos(f) + 1.0
    sqrt_mu = np.sqrt(mu)
    sqrt_p_value = np.sqrt(p_value)
    h = sqrt_mu*sqrt_p_value
    out[0] = h*inv_p_value*inv_p_value*w*w
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    (f,) = x
    e, p_value, mu = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, *p))
    inv_p_value = 1.0/p_value
    sqrt_mu = np.sqrt(mu)
    sqrt_p_value = np.sqrt(p_value)
    h = sqrt_mu*sqrt_p_value
    out[0, 0] = -2.0*e*h*inv_p_value*inv_p_value*(e*np.cos(f) + 1.0)*np.sin(f)
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    (f,) = x
    e, p_value, mu = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((1, 0, *shape), np.result_type(float, t, x, u, *p))
    return out
