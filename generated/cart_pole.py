"""Minimum-effort swing-up of a cart-pole.

Written by satsym from derivations/examples/cart_pole.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/cart_pole.py
Source: ../derivations/examples/cart_pole.py be0c65e3c02a1ee187955c29643bcb8a
Digest: 8cf8bdd64a80e6f6b3f5155bf87ad4b7cee605937eba2b3b347fa145e5bdaeef
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'cart_pole',
    'title': 'Minimum-effort swing-up of a cart-pole',
    'source': 'derivations/examples/cart_pole.py',
    'states': (
        {'symbol': 'q1', 'latex': 'q_1', 'unit': 'm', 'meaning': 'position of the cart'},
        {'symbol': 'q2', 'latex': 'q_2', 'unit': 'rad', 'meaning': 'angle of the pole from the hanging position', 'kind': 'angle'},
        {'symbol': 'v1', 'latex': 'v_1', 'unit': 'm/s', 'meaning': 'velocity of the cart'},
        {'symbol': 'v2', 'latex': 'v_2', 'unit': 'rad/s', 'meaning': 'angular velocity of the pole'},
    ),
    'controls': (
        {'symbol': 'u', 'latex': 'u', 'unit': 'N', 'meaning': 'force on the cart'},
    ),
    'parameters': (
        {'symbol': 'm1', 'latex': 'm_1', 'unit': 'kg', 'meaning': 'mass of the cart', 'default': 1.0, 'positive': True},
        {'symbol': 'm2', 'latex': 'm_2', 'unit': 'kg', 'meaning': 'mass at the end of the pole', 'default': 0.3, 'positive': True},
        {'symbol': 'l', 'latex': '\\ell', 'unit': 'm', 'meaning': 'length of the pole', 'default': 0.5, 'positive': True},
        {'symbol': 'g', 'latex': 'g', 'unit': 'm/s^2', 'meaning': 'acceleration of gravity', 'default': 9.81, 'positive': True},
    ),
    'control_set': 'box',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'objective_unit': 'N**2*s',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    m1, m2, l, g = p
    sin_q2 = math.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    g_sin_q2 = g*sin_q2
    cos_q2 = math.cos(q2)
    cos_q2_m2 = cos_q2*m2
    w_2 = l*sin_q2*v2*v2
    inv_l = 1.0/l
    return (
        v1,
        v2,
        inv_w*(cos_q2_m2*g_sin_q2 + m2*w_2 + u_value),
        inv_l*inv_w*(-cos_q2*u_value - cos_q2_m2*w_2 - g_sin_q2*(m1 + m2)),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    m1, m2, l, g = p
    sin_q2 = math.sin(q2)
    sin_q2_sq = sin_q2*sin_q2
    w = l*v2*v2
    cos_q2 = math.cos(q2)
    cos_q2_w = cos_q2*w
    m2_sin_q2_sq = m2*sin_q2_sq
    w_2 = m1 + m2_sin_q2_sq
    inv_w_2 = 1.0/w_2
    inv_w_2_sq = inv_w_2*inv_w_2
    g_m1 = g*m1
    w_3 = sin_q2*sin_q2*sin_q2*sin_q2
    cos_q2_sq = cos_q2*cos_q2
    sin_q2_u_value = sin_q2*u_value
    twice_sin_q2_u_value = 2.0*sin_q2_u_value
    w_4 = 2.0*inv_w_2*m2*sin_q2*v2
    inv_l = 1.0/l
    cos_q2_g_m1 = cos_q2*g_m1
    cos_q2_g = cos_q2*g
    cos_q2_sq_m2 = cos_q2_sq*m2
    m2_sq = m2*m2
    m2_sq_sin_q2_sq = m2_sq*sin_q2_sq
    m1_w = m1*w
    return (
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        -inv_w_2_sq*m2*(cos_q2*twice_sin_q2_u_value + cos_q2_sq*g*m2_sin_q2_sq + cos_q2_w*m2_sin_q2_sq + g*m2*w_3 + g_m1*sin_q2_sq - cos_q2_sq*g_m1 - cos_q2_w*m1),
        0.0,
        l*w_4,
        0.0,
        inv_l*inv_w_2_sq*(cos_q2_g*m2_sq_sin_q2_sq + cos_q2_g_m1*m2_sin_q2_sq + cos_q2_sq*m2_sq_sin_q2_sq*w + cos_q2_sq_m2*twice_sin_q2_u_value + m1*sin_q2_u_value + m1_w*m2_sin_q2_sq + m2*sin_q2*sin_q2*sin_q2*u_value + m2_sq*w*w_3 - cos_q2_g*m1*m1 - cos_q2_g_m1*m2 - cos_q2_sq_m2*m1_w),
        0.0,
        -cos_q2*w_4,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    m1, m2, l, g = p
    sin_q2 = math.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    inv_l = 1.0/l
    return (
        0.0,
        0.0,
        inv_w,
        -inv_l*inv_w*math.cos(q2),
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    m1, m2, l, g = p
    return u_value*u_value


def terminal_cost(t, x, p):
    """Terminal cost S."""
    q1, q2, v1, v2 = x
    m1, m2, l, g = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    q1, q2, v1, v2 = x
    m1, m2, l, g = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    sin_q2 = math.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    inv_l = 1.0/l
    g_sin_q2 = g*sin_q2
    cos_q2 = math.cos(q2)
    cos_q2_m2 = cos_q2*m2
    w_2 = l*sin_q2*v2*v2
    return inv_l*inv_w*lambda_v2*(-cos_q2*u_value - cos_q2_m2*w_2 - g_sin_q2*(m1 + m2)) + inv_w*lambda_v1*(cos_q2_m2*g_sin_q2 + m2*w_2 + u_value) + lambda_q1*v1 + lambda_q2*v2 + u_value*u_value


def stationarity(t, x, u, lam, p):
    """H_u."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    inv_l = 1.0/l
    sin_q2 = math.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    return (
        inv_l*inv_w*(l*lambda_v1 - lambda_v2*math.cos(q2)) + 2.0*u_value,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    return (
        2.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    inv_l = 1.0/l
    sin_q2 = math.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    w_2 = 0.5*inv_l*inv_w*(lambda_v2*math.cos(q2) - l*lambda_v1)
    u_2 = u_min if w_2 < u_min else u_max if w_2 > u_max else w_2
    return (
        u_2,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    sin_q2 = math.sin(q2)
    inv_l = 1.0/l
    sin_q2_sq = sin_q2*sin_q2
    w = l*v2*v2
    cos_q2 = math.cos(q2)
    cos_q2_w = cos_q2*w
    g_m1 = g*m1
    cos_q2_g_m1 = cos_q2*g_m1
    cos_q2_g = cos_q2*g
    cos_q2_sq = cos_q2*cos_q2
    cos_q2_sq_m2 = cos_q2_sq*m2
    m2_sq = m2*m2
    m2_sq_sin_q2_sq = m2_sq*sin_q2_sq
    m1_w = m1*w
    m2_sin_q2_sq = m2*sin_q2_sq
    w_2 = m1 + m2_sin_q2_sq
    inv_w_2 = 1.0/w_2
    inv_w_2_sq = inv_w_2*inv_w_2
    w_3 = sin_q2*sin_q2*sin_q2*sin_q2
    sin_q2_u_value = sin_q2*u_value
    twice_sin_q2_u_value = 2.0*sin_q2_u_value
    return (
        0.0,
        inv_w_2_sq*lambda_v1*m2*(cos_q2*twice_sin_q2_u_value + cos_q2_sq*g*m2_sin_q2_sq + cos_q2_w*m2_sin_q2_sq + g*m2*w_3 + g_m1*sin_q2_sq - cos_q2_sq*g_m1 - cos_q2_w*m1) - inv_l*inv_w_2_sq*lambda_v2*(cos_q2_g*m2_sq_sin_q2_sq + cos_q2_g_m1*m2_sin_q2_sq + cos_q2_sq*m2_sq_sin_q2_sq*w + cos_q2_sq_m2*twice_sin_q2_u_value + m1*sin_q2_u_value + m1_w*m2_sin_q2_sq + m2*sin_q2*sin_q2*sin_q2*u_value + m2_sq*w*w_3 - cos_q2_g*m1*m1 - cos_q2_g_m1*m2 - cos_q2_sq_m2*m1_w),
        -lambda_q1,
        2.0*cos_q2*inv_w_2*lambda_v2*m2*sin_q2*v2 - 2.0*inv_w_2*l*lambda_v1*m2*sin_q2*v2 - lambda_q2,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    sin_q2 = math.sin(q2)
    sin_q2_sq = sin_q2*sin_q2
    m2_sin_q2_sq = m2*sin_q2_sq
    w = m1 + m2_sin_q2_sq
    inv_w = 1.0/w
    l_lambda_v1 = l*lambda_v1
    cos_q2 = math.cos(q2)
    inv_l = 1.0/l
    inv_l_inv_w = inv_l*inv_w
    w_2 = 0.5*inv_l_inv_w*(cos_q2*lambda_v2 - l_lambda_v1)
    w_3 = u_min if w_2 < u_min else u_max if w_2 > u_max else w_2
    g_sin_q2 = g*sin_q2
    cos_q2_m2 = cos_q2*m2
    w_4 = l*v2*v2
    m2_sin_q2 = m2*sin_q2
    cos_q2_w_3 = cos_q2*w_3
    inv_w_sq = inv_w*inv_w
    g_m1 = g*m1
    w_5 = sin_q2*sin_q2*sin_q2*sin_q2
    cos_q2_sq = cos_q2*cos_q2
    cos_q2_w_4 = cos_q2*w_4
    sin_q2_w_3 = sin_q2*w_3
    cos_q2_g = cos_q2*g
    cos_q2_sq_m2 = cos_q2_sq*m2
    m2_sq = m2*m2
    m2_sq_sin_q2_sq = m2_sq*sin_q2_sq
    m1_w_4 = m1*w_4
    return (
        v1,
        v2,
        inv_w*(cos_q2_m2*g_sin_q2 + m2_sin_q2*w_4 + w_3),
        inv_l_inv_w*(-cos_q2_m2*sin_q2*w_4 - cos_q2_w_3 - g_sin_q2*(m1 + m2)),
        0.0,
        inv_w_sq*lambda_v1*m2*(cos_q2_sq*g*m2_sin_q2_sq + 2.0*cos_q2_w_3*sin_q2 + cos_q2_w_4*m2_sin_q2_sq + g*m2*w_5 + g_m1*sin_q2_sq - cos_q2_sq*g_m1 - cos_q2_w_4*m1) - inv_l*inv_w_sq*lambda_v2*(cos_q2*g_m1*m2_sin_q2_sq + cos_q2_g*m2_sq_sin_q2_sq + cos_q2_sq*m2_sq_sin_q2_sq*w_4 + 2.0*cos_q2_sq_m2*sin_q2_w_3 + m1*sin_q2_w_3 + m1_w_4*m2_sin_q2_sq + m2*sin_q2*sin_q2*sin_q2*w_3 + m2_sq*w_4*w_5 - cos_q2_g*m1*m1 - cos_q2_m2*g_m1 - cos_q2_sq_m2*m1_w_4),
        -lambda_q1,
        2.0*cos_q2*inv_w*lambda_v2*m2*sin_q2*v2 - 2.0*inv_w*l_lambda_v1*m2_sin_q2*v2 - lambda_q2,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    sin_q2 = math.sin(q2)
    sin_q2_sq = sin_q2*sin_q2
    m2_sin_q2_sq = m2*sin_q2_sq
    w = m1 + m2_sin_q2_sq
    inv_w = 1.0/w
    l_lambda_v1 = l*lambda_v1
    cos_q2 = math.cos(q2)
    w_2 = cos_q2*lambda_v2 - l_lambda_v1
    inv_l = 1.0/l
    inv_l_inv_w = inv_l*inv_w
    half_inv_l_inv_w = 0.5*inv_l_inv_w
    half_inv_l_inv_w_w_2 = half_inv_l_inv_w*w_2
    w_3 = u_min if half_inv_l_inv_w_w_2 < u_min else u_max if half_inv_l_inv_w_w_2 > u_max else half_inv_l_inv_w_w_2
    v2_sq = v2*v2
    l_v2_sq = l*v2_sq
    l_v2_sq_m2 = l_v2_sq*m2
    l_v2_sq_m2_sin_q2 = l_v2_sq_m2*sin_q2
    twice_cos_q2 = 2.0*cos_q2
    inv_w_sq = inv_w*inv_w
    inv_w_sq_m2 = inv_w_sq*m2
    inv_w_sq_m2_sin_q2 = inv_w_sq_m2*sin_q2
    w_4 = inv_w_sq_m2_sin_q2*twice_cos_q2
    cos_q2_sq = cos_q2*cos_q2
    g_m2 = g*m2
    cos_q2_sq_g_m2 = cos_q2_sq*g_m2
    g_m2_sin_q2_sq = g*m2_sin_q2_sq
    cos_q2_m2 = cos_q2*m2
    cos_q2_m2_l_v2_sq = cos_q2_m2*l_v2_sq
    w_5 = 0.0 if half_inv_l_inv_w_w_2 < u_min else 0.0 if half_inv_l_inv_w_w_2 > u_max else 1.0
    cos_q2_inv_l = cos_q2*inv_l
    w_6 = w_5*(-cos_q2_inv_l*inv_w_sq_m2_sin_q2*w_2 - half_inv_l_inv_w*lambda_v2*sin_q2)
    g_m2_sin_q2 = g_m2*sin_q2
    l_v2 = l*v2
    twice_sin_q2 = 2.0*sin_q2
    inv_w_twice_sin_q2 = inv_w*twice_sin_q2
    inv_w_twice_sin_q2_m2 = inv_w_twice_sin_q2*m2
    w_7 = inv_w_twice_sin_q2_m2*l_v2
    half_w_5 = 0.5*w_5
    half_w_5_inv_w_sq = half_w_5*inv_w_sq
    w_8 = cos_q2_inv_l*half_w_5_inv_w_sq
    cos_q2_w_3 = cos_q2*w_3
    w_9 = g*(m1 + m2)
    cos_q2_sq_l_v2_sq_m2 = cos_q2_sq*l_v2_sq_m2
    cos_q2_w_6 = cos_q2*w_6
    cos_q2_m2_v2 = cos_q2_m2*v2
    w_10 = cos_q2_m2_v2*inv_w_twice_sin_q2
    m2_sq = m2*m2
    g_m1 = g*m1
    w_11 = sin_q2*sin_q2*sin_q2*sin_q2
    sin_q2_w_3 = sin_q2*w_3
    cos_q2_m1 = cos_q2*m1
    l_v2_sq_m2_sin_q2_sq = l_v2_sq*m2_sin_q2_sq
    w_12 = cos_q2*l_v2_sq_m2_sin_q2_sq + cos_q2_sq*g_m2_sin_q2_sq + g_m1*sin_q2_sq + g_m2*w_11 + sin_q2_w_3*twice_cos_q2 - cos_q2_m1*l_v2_sq - cos_q2_sq*g_m1
    w_13 = 4.0*sin_q2
    cos_q2_w_13 = cos_q2*w_13
    inv_w_cubed = inv_w*inv_w*inv_w
    inv_w_cubed_lambda_v1 = inv_w_cubed*lambda_v1
    twice_w_3 = 2.0*w_3
    m1_sin_q2 = m1*sin_q2
    sin_q2_cubed = sin_q2*sin_q2*sin_q2
    w_14 = sin_q2_cubed*twice_cos_q2
    cos_q2_cubed = cos_q2*cos_q2*cos_q2
    m2_sin_q2_cubed = m2*sin_q2_cubed
    g_m2_m1 = g_m2*m1
    w_15 = g*m1*m1
    g_m2_sq = g*m2_sq
    l_v2_sq_m2_sq = l_v2_sq*m2_sq
    cos_q2_sq_m2 = cos_q2_sq*m2
    twice_cos_q2_sq_m2 = 2.0*cos_q2_sq_m2
    cos_q2_sq_sin_q2_sq = cos_q2_sq*sin_q2_sq
    w_16 = cos_q2*g_m2_sq*sin_q2_sq + cos_q2_m1*g_m2_sin_q2_sq + cos_q2_sq_sin_q2_sq*l_v2_sq_m2_sq + l_v2_sq_m2_sin_q2_sq*m1 + l_v2_sq_m2_sq*w_11 + m1*sin_q2_w_3 + m2_sin_q2_cubed*w_3 + sin_q2_w_3*twice_cos_q2_sq_m2 - cos_q2*g_m2_m1 - cos_q2*w_15 - cos_q2_sq_l_v2_sq_m2*m1
    cos_q2_cubed_m2 = cos_q2_cubed*m2
    cos_q2_sq_twice_sin_q2 = cos_q2_sq*twice_sin_q2
    inv_l_inv_w_sq = inv_l*inv_w_sq
    inv_l_inv_w_sq_lambda_v2 = inv_l_inv_w_sq*lambda_v2
    l_v2_twice_cos_q2 = l_v2*twice_cos_q2
    twice_l_v2 = 2.0*l_v2
    m2_sq_twice_l_v2 = m2_sq*twice_l_v2
    sin_q2_w_5 = sin_q2*w_5
    half_w_5_inv_w = half_w_5*inv_w
    w_17 = cos_q2*half_w_5*inv_l_inv_w
    lambda_v2_v2 = lambda_v2*v2
    twice_inv_w = 2.0*inv_w
    return (
        0.0,
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
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        inv_w*(cos_q2_m2_l_v2_sq + cos_q2_sq_g_m2 + w_6 - g_m2_sin_q2_sq) - w_4*(cos_q2*g_m2_sin_q2 + l_v2_sq_m2_sin_q2 + w_3),
        0.0,
        w_7,
        0.0,
        0.0,
        -half_w_5_inv_w_sq,
        w_8,
        0.0,
        inv_l*inv_w*(l*m2*sin_q2_sq*v2_sq + sin_q2*w_3 - cos_q2*w_9 - cos_q2_sq_l_v2_sq_m2 - cos_q2_w_6) - inv_l*w_4*(-cos_q2_m2_l_v2_sq*sin_q2 - cos_q2_w_3 - sin_q2*w_9),
        0.0,
        -w_10,
        0.0,
        0.0,
        w_8,
        -cos_q2_sq*half_w_5_inv_w_sq*inv_l*inv_l,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        cos_q2*inv_l*inv_w_cubed*lambda_v2*m2*w_13*w_16 + inv_w_sq_m2*lambda_v1*(2.0*cos_q2_cubed*g_m2_sin_q2 + 2.0*cos_q2_sq*l_v2_sq_m2_sin_q2 + cos_q2_sq*twice_w_3 + cos_q2_w_13*g_m1 + cos_q2_w_6*twice_sin_q2 + g_m2*w_14 + l_v2_sq*m1_sin_q2 - l_v2_sq*m2_sin_q2_cubed - sin_q2_sq*twice_w_3) - cos_q2_w_13*inv_w_cubed_lambda_v1*m2_sq*w_12 - inv_l_inv_w_sq_lambda_v2*(cos_q2_cubed*l_v2_sq_m2_sq*twice_sin_q2 + cos_q2_cubed_m2*twice_w_3 + 4.0*cos_q2_m2_l_v2_sq*m1_sin_q2 + 2.0*cos_q2_sq_g_m2*m1_sin_q2 + cos_q2_sq_twice_sin_q2*g_m2_sq + cos_q2_sq_twice_sin_q2*m2*w_6 + cos_q2_w_3*m1 + g_m2_sin_q2*m1 + l_v2_sq_m2_sq*w_14 + m1_sin_q2*w_6 + m2_sin_q2_cubed*w_6 + sin_q2*w_15 - cos_q2_w_3*m2_sin_q2_sq - g_m2_m1*sin_q2_cubed - g_m2_sq*sin_q2_cubed),
        0.0,
        inv_w_sq*lambda_v1*m2*(l_v2_twice_cos_q2*m2_sin_q2_sq - l_v2_twice_cos_q2*m1) - inv_l_inv_w_sq_lambda_v2*(cos_q2_sq_sin_q2_sq*m2_sq_twice_l_v2 + m1*m2_sin_q2_sq*twice_l_v2 + m2_sq_twice_l_v2*w_11 - l_v2*m1*twice_cos_q2_sq_m2),
        0.0,
        0.0,
        inv_w_sq*m2*w_12 - cos_q2_m2*inv_w_cubed_lambda_v1*sin_q2_w_5 - inv_l_inv_w_sq_lambda_v2*(-cos_q2_sq_m2*inv_w*sin_q2_w_5 - half_w_5_inv_w*m1_sin_q2 - half_w_5_inv_w*m2_sin_q2_cubed),
        cos_q2_sq*inv_l*inv_w_cubed*lambda_v1*m2*sin_q2*w_5 - inv_l_inv_w_sq*w_16 - inv_l_inv_w_sq_lambda_v2*(cos_q2_cubed_m2*inv_l_inv_w*sin_q2_w_5 + m1_sin_q2*w_17 + m2_sin_q2_cubed*w_17),
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        4.0*cos_q2*inv_w_sq*l*lambda_v1*m2_sq*sin_q2_sq*v2 + 2.0*cos_q2_sq*inv_w*lambda_v2*m2*v2 - cos_q2_m2_v2*l_lambda_v1*twice_inv_w - 4.0*cos_q2_sq_sin_q2_sq*inv_w_sq*lambda_v2_v2*m2_sq - lambda_v2_v2*m2_sin_q2_sq*twice_inv_w,
        0.0,
        2.0*cos_q2*inv_w*lambda_v2*m2*sin_q2 - inv_w_twice_sin_q2_m2*l_lambda_v1,
        0.0,
        -1.0,
        -w_7,
        w_10,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    given_q1, given_q2, given_v1, given_v2, on_reference_q1, on_reference_q2, on_reference_v1, on_reference_v2, target_q1, target_q2, target_v1, target_v2 = final
    sin_q2 = math.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    cos_q2 = math.cos(q2)
    inv_l = 1.0/l
    inv_l_inv_w = inv_l*inv_w
    w_2 = 0.5*inv_l_inv_w*(cos_q2*lambda_v2 - l*lambda_v1)
    w_3 = u_min if w_2 < u_min else u_max if w_2 > u_max else w_2
    g_sin_q2 = g*sin_q2
    cos_q2_m2 = cos_q2*m2
    w_4 = l*sin_q2*v2*v2
    return (
        given_q1*(q1 - target_q1) + lambda_q1*(1.0 - given_q1 - on_reference_q1) + on_reference_q1*q1,
        given_q2*(q2 - target_q2) + lambda_q2*(1.0 - given_q2 - on_reference_q2) + on_reference_q2*q2,
        given_v1*(v1 - target_v1) + lambda_v1*(1.0 - given_v1 - on_reference_v1) + on_reference_v1*v1,
        given_v2*(v2 - target_v2) + lambda_v2*(1.0 - given_v2 - on_reference_v2) + on_reference_v2*v2,
        inv_l_inv_w*lambda_v2*(-cos_q2*w_3 - cos_q2_m2*w_4 - g_sin_q2*(m1 + m2)) + inv_w*lambda_v1*(cos_q2_m2*g_sin_q2 + m2*w_4 + w_3) + lambda_q1*v1 + lambda_q2*v2 + w_3*w_3,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    given_q1, given_q2, given_v1, given_v2, on_reference_q1, on_reference_q2, on_reference_v1, on_reference_v2, target_q1, target_q2, target_v1, target_v2 = final
    w = given_q1 + on_reference_q1
    w_2 = given_q2 + on_reference_q2
    w_3 = given_v1 + on_reference_v1
    w_4 = given_v2 + on_reference_v2
    sin_q2 = math.sin(q2)
    sin_q2_sq = sin_q2*sin_q2
    m2_sin_q2_sq = m2*sin_q2_sq
    w_5 = m1 + m2_sin_q2_sq
    inv_w_5 = 1.0/w_5
    l_lambda_v1 = l*lambda_v1
    cos_q2 = math.cos(q2)
    w_6 = cos_q2*lambda_v2 - l_lambda_v1
    inv_l = 1.0/l
    inv_l_inv_w_5 = inv_l*inv_w_5
    half_inv_l_inv_w_5 = 0.5*inv_l_inv_w_5
    half_inv_l_inv_w_5_w_6 = half_inv_l_inv_w_5*w_6
    w_7 = u_min if half_inv_l_inv_w_5_w_6 < u_min else u_max if half_inv_l_inv_w_5_w_6 > u_max else half_inv_l_inv_w_5_w_6
    cos_q2_m2 = cos_q2*m2
    cos_q2_m2_sin_q2 = cos_q2_m2*sin_q2
    v2_sq = v2*v2
    l_v2_sq = l*v2_sq
    m2_sin_q2 = m2*sin_q2
    w_8 = cos_q2_m2_sin_q2*g + l_v2_sq*m2_sin_q2 + w_7
    inv_w_5_sq = inv_w_5*inv_w_5
    inv_w_5_sq_lambda_v1 = inv_w_5_sq*lambda_v1
    w_9 = 0.0 if half_inv_l_inv_w_5_w_6 < u_min else 0.0 if half_inv_l_inv_w_5_w_6 > u_max else 1.0
    inv_l_inv_w_5_sq = inv_l*inv_w_5_sq
    w_10 = w_9*(-cos_q2_m2_sin_q2*inv_l_inv_w_5_sq*w_6 - half_inv_l_inv_w_5*lambda_v2*sin_q2)
    w_11 = g*(m1 + m2)
    cos_q2_m2_l_v2_sq = cos_q2_m2*l_v2_sq
    cos_q2_w_7 = cos_q2*w_7
    w_12 = -cos_q2_m2_l_v2_sq*sin_q2 - cos_q2_w_7 - sin_q2*w_11
    cos_q2_lambda_v2 = cos_q2*lambda_v2
    w_13 = cos_q2_lambda_v2*inv_l_inv_w_5_sq
    twice_m2_sin_q2 = 2.0*m2_sin_q2
    cos_q2_sq = cos_q2*cos_q2
    cos_q2_sq_m2 = cos_q2_sq*m2
    w_14 = inv_w_5*twice_m2_sin_q2*v2
    inv_w_5_w_9 = inv_w_5*w_9
    half_w_9 = 0.5*w_9
    w_15 = half_w_9*inv_w_5_sq_lambda_v1
    return (
        w,
        0.0,
        0.0,
        0.0,
        1.0 - w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_2,
        0.0,
        0.0,
        0.0,
        1.0 - w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        0.0,
        0.0,
        0.0,
        1.0 - w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_4,
        0.0,
        0.0,
        0.0,
        1.0 - w_4,
        0.0,
        0.0,
        inv_l_inv_w_5*lambda_v2*(l*m2*sin_q2_sq*v2_sq + sin_q2*w_7 - cos_q2*w_10 - cos_q2*w_11 - cos_q2_sq_m2*l_v2_sq) + inv_w_5*lambda_v1*(cos_q2_m2_l_v2_sq + cos_q2_sq_m2*g + w_10 - g*m2_sin_q2_sq) + 2.0*w_10*w_7 - 2.0*cos_q2_m2_sin_q2*inv_w_5_sq_lambda_v1*w_8 - twice_m2_sin_q2*w_12*w_13,
        lambda_q1,
        l_lambda_v1*w_14 + lambda_q2 - cos_q2_lambda_v2*w_14,
        v1,
        v2,
        half_w_9*w_13 + inv_w_5*w_8 - inv_w_5_w_9*w_7 - w_15,
        cos_q2*inv_l*w_15 + cos_q2_w_7*inv_l*inv_w_5_w_9 + inv_l_inv_w_5*w_12 - cos_q2_sq*half_w_9*inv_l*inv_l*inv_w_5_sq*lambda_v2,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    m1, m2, l, g = p
    q1_at, q2_at, v1_at, v2_at = x
    q1_mid, q2_mid, v1_mid, v2_mid = x_mid
    (u_value_at,) = u
    (u_value_mid,) = u_mid
    q1, q2, v1, v2 = x0
    g_m2 = g*m2
    l_m2 = l*m2
    inv_l = 1.0/l
    w_3 = g*(m1 + m2)
    steps = len(times) - 1
    t = times[0]
    q1_at[0] = q1
    q2_at[0] = q2
    v1_at[0] = v1
    v2_at[0] = v2
    u_value = u_value_at[0]
    sin_q2 = math.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    cos_q2 = math.cos(q2)
    cos_q2_sin_q2 = cos_q2*sin_q2
    w_2 = l_m2*v2*v2
    slope_v1 = inv_w*(cos_q2_sin_q2*g_m2 + sin_q2*w_2 + u_value)
    slope_v2 = inv_l*inv_w*(-cos_q2*u_value - cos_q2_sin_q2*w_2 - sin_q2*w_3)
    slope_total = u_value*u_value
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        q1_at[i] = q1
        q2_at[i] = q2
        v1_at[i] = v1
        v2_at[i] = v2
        u_value_half = u_value_mid[i]
        u_value_end = u_value_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        q2_2 = half*v2 + q2
        v2_2 = half*slope_v2 + v2
        sin_q2_2 = math.sin(q2_2)
        w_4 = m1 + m2*sin_q2_2*sin_q2_2
        inv_w_4 = 1.0/w_4
        cos_q2_2 = math.cos(q2_2)
        cos_q2_2_sin_q2_2 = cos_q2_2*sin_q2_2
        w_5 = l_m2*v2_2*v2_2
        k2_v1 = inv_w_4*(cos_q2_2_sin_q2_2*g_m2 + sin_q2_2*w_5 + u_value_half)
        k2_v2 = inv_l*inv_w_4*(-cos_q2_2*u_value_half - cos_q2_2_sin_q2_2*w_5 - sin_q2_2*w_3)
        k2_total = u_value_half*u_value_half
        q2_3 = half*v2_2 + q2
        v2_3 = half*k2_v2 + v2
        sin_q2_3 = math.sin(q2_3)
        w_6 = m1 + m2*sin_q2_3*sin_q2_3
        inv_w_6 = 1.0/w_6
        cos_q2_3 = math.cos(q2_3)
        cos_q2_3_sin_q2_3 = cos_q2_3*sin_q2_3
        w_7 = l_m2*v2_3*v2_3
        k3_v1 = inv_w_6*(cos_q2_3_sin_q2_3*g_m2 + sin_q2_3*w_7 + u_value_half)
        k3_v2 = inv_l*inv_w_6*(-cos_q2_3*u_value_half - cos_q2_3_sin_q2_3*w_7 - sin_q2_3*w_3)
        q2_4 = h*v2_3 + q2
        v2_4 = h*k3_v2 + v2
        sin_q2_4 = math.sin(q2_4)
        w_8 = m1 + m2*sin_q2_4*sin_q2_4
        inv_w_8 = 1.0/w_8
        cos_q2_4 = math.cos(q2_4)
        cos_q2_4_sin_q2_4 = cos_q2_4*sin_q2_4
        w_9 = l_m2*v2_4*v2_4
        k4_v1 = inv_w_8*(cos_q2_4_sin_q2_4*g_m2 + sin_q2_4*w_9 + u_value_end)
        k4_v2 = inv_l*inv_w_8*(-cos_q2_4*u_value_end - cos_q2_4_sin_q2_4*w_9 - sin_q2_4*w_3)
        k4_total = u_value_end*u_value_end
        k23_v1 = k2_v1 + k3_v1
        k123_v1 = k23_v1 + slope_v1
        k23_v2 = k2_v2 + k3_v2
        k123_v2 = k23_v2 + slope_v2
        q1_end = h*(k123_v1*sixth + v1) + q1
        q2_end = h*(k123_v2*sixth + v2) + q2
        v1_end = sixth*(k123_v1 + k23_v1 + k4_v1) + v1
        v2_end = sixth*(k123_v2 + k23_v2 + k4_v2) + v2
        sin_q2_end = math.sin(q2_end)
        w_10 = m1 + m2*sin_q2_end*sin_q2_end
        inv_w_10 = 1.0/w_10
        cos_q2_end = math.cos(q2_end)
        cos_q2_end_sin_q2_end = cos_q2_end*sin_q2_end
        w_11 = l_m2*v2_end*v2_end
        slope_end_v1 = inv_w_10*(cos_q2_end_sin_q2_end*g_m2 + sin_q2_end*w_11 + u_value_end)
        slope_end_v2 = inv_l*inv_w_10*(-cos_q2_end*u_value_end - cos_q2_end_sin_q2_end*w_11 - sin_q2_end*w_3)
        eighth = 0.125*h
        q1_mid[i] = eighth*(v1 - v1_end) + 0.5*(q1 + q1_end)
        q2_mid[i] = eighth*(v2 - v2_end) + 0.5*(q2 + q2_end)
        v1_mid[i] = eighth*(slope_v1 - slope_end_v1) + 0.5*(v1 + v1_end)
        v2_mid[i] = eighth*(slope_v2 - slope_end_v2) + 0.5*(v2 + v2_end)
        total = sixth*(4.0*k2_total + k4_total + slope_total) + total
        t = t_end
        q1 = q1_end
        q2 = q2_end
        v1 = v1_end
        v2 = v2_end
        slope_v1 = slope_end_v1
        slope_v2 = slope_end_v2
        slope_total = k4_total
    q1_at[steps] = q1
    q2_at[steps] = q2
    v1_at[steps] = v1
    v2_at[steps] = v2
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    m1, m2, l, g = p
    lambda_q1_at, lambda_q2_at, lambda_v1_at, lambda_v2_at = lam
    lambda_q1_mid, lambda_q2_mid, lambda_v1_mid, lambda_v2_mid = lam_mid
    q1_at, q2_at, v1_at, v2_at = x
    (u_value_at,) = u
    q1_mid, q2_mid, v1_mid, v2_mid = x_mid
    (u_value_mid,) = u_mid
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam_f
    g_m1 = g*m1
    g_m2 = g*m2
    l_m1 = l*m1
    l_m2 = l*m2
    inv_l = 1.0/l
    w_4 = g*m1*m1
    m2_sq = m2*m2
    g_m2_sq = g*m2_sq
    twice_m2 = 2.0*m2
    g_m1_m2 = g_m1*m2
    l_m1_m2 = l_m1*m2
    l_m2_sq = l*m2_sq
    twice_l_m2 = 2.0*l_m2
    steps = len(times) - 1
    t = times[steps]
    lambda_q1_at[steps] = lambda_q1
    lambda_q2_at[steps] = lambda_q2
    lambda_v1_at[steps] = lambda_v1
    lambda_v2_at[steps] = lambda_v2
    q2 = q2_at[steps]
    v2 = v2_at[steps]
    u_value = u_value_at[steps]
    sin_q2 = math.sin(q2)
    sin_q2_u_value = sin_q2*u_value
    sin_q2_sq = sin_q2*sin_q2
    cos_q2 = math.cos(q2)
    cos_q2_sq = cos_q2*cos_q2
    cos_q2_sq_sin_q2_sq = cos_q2_sq*sin_q2_sq
    v2_sq = v2*v2
    cos_q2_v2_sq = cos_q2*v2_sq
    w = m1 + m2*sin_q2_sq
    inv_w = 1.0/w
    inv_w_sq = inv_w*inv_w
    w_2 = sin_q2*sin_q2*sin_q2*sin_q2
    w_3 = inv_w_sq*m2*(2.0*cos_q2*sin_q2_u_value + cos_q2_sq_sin_q2_sq*g_m2 + cos_q2_v2_sq*l_m2*sin_q2_sq + g_m1*sin_q2_sq + g_m2*w_2 - cos_q2_sq*g_m1 - cos_q2_v2_sq*l_m1)
    cos_q2_g_m1_m2 = cos_q2*g_m1_m2
    l_m1_m2_v2_sq = l_m1_m2*v2_sq
    l_m2_sq_v2_sq = l_m2_sq*v2_sq
    w_5 = inv_l*inv_w_sq*(cos_q2*g_m2_sq*sin_q2_sq + cos_q2_g_m1_m2*sin_q2_sq + cos_q2_sq*sin_q2_u_value*twice_m2 + cos_q2_sq_sin_q2_sq*l_m2_sq_v2_sq + l_m1_m2_v2_sq*sin_q2_sq + l_m2_sq_v2_sq*w_2 + m1*sin_q2_u_value + m2*sin_q2*sin_q2*sin_q2*u_value - cos_q2*w_4 - cos_q2_g_m1_m2 - cos_q2_sq*l_m1_m2_v2_sq)
    inv_w_sin_q2_v2 = inv_w*sin_q2*v2
    w_6 = inv_w_sin_q2_v2*twice_l_m2
    w_7 = cos_q2*inv_w_sin_q2_v2*twice_m2
    slope_lambda_q2 = lambda_v1*w_3 - lambda_v2*w_5
    slope_lambda_v1 = -lambda_q1
    slope_lambda_v2 = lambda_v2*w_7 - lambda_q2 - lambda_v1*w_6
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        q2_half = q2_mid[i]
        q2_end = q2_at[i]
        v2_half = v2_mid[i]
        v2_end = v2_at[i]
        u_value_half = u_value_mid[i]
        u_value_end = u_value_at[i]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_q2_2 = half*slope_lambda_q2 + lambda_q2
        lambda_v1_2 = half*slope_lambda_v1 + lambda_v1
        lambda_v2_2 = half*slope_lambda_v2 + lambda_v2
        sin_q2_half = math.sin(q2_half)
        sin_q2_half_u_value_half = sin_q2_half*u_value_half
        sin_q2_half_sq = sin_q2_half*sin_q2_half
        cos_q2_half = math.cos(q2_half)
        cos_q2_half_sq = cos_q2_half*cos_q2_half
        w_8 = cos_q2_half_sq*sin_q2_half_sq
        v2_half_sq = v2_half*v2_half
        cos_q2_half_v2_half_sq = cos_q2_half*v2_half_sq
        w_9 = m1 + m2*sin_q2_half_sq
        inv_w_9 = 1.0/w_9
        inv_w_9_sq = inv_w_9*inv_w_9
        w_10 = sin_q2_half*sin_q2_half*sin_q2_half*sin_q2_half
        w_11 = inv_w_9_sq*m2*(2.0*cos_q2_half*sin_q2_half_u_value_half + cos_q2_half_v2_half_sq*l_m2*sin_q2_half_sq + g_m1*sin_q2_half_sq + g_m2*w_10 + g_m2*w_8 - cos_q2_half_sq*g_m1 - cos_q2_half_v2_half_sq*l_m1)
        cos_q2_half_g_m1_m2 = cos_q2_half*g_m1_m2
        l_m1_m2_v2_half_sq = l_m1_m2*v2_half_sq
        l_m2_sq_v2_half_sq = l_m2_sq*v2_half_sq
        w_12 = inv_l*inv_w_9_sq*(cos_q2_half*g_m2_sq*sin_q2_half_sq + cos_q2_half_g_m1_m2*sin_q2_half_sq + cos_q2_half_sq*sin_q2_half_u_value_half*twice_m2 + l_m1_m2_v2_half_sq*sin_q2_half_sq + l_m2_sq_v2_half_sq*w_10 + l_m2_sq_v2_half_sq*w_8 + m1*sin_q2_half_u_value_half + m2*sin_q2_half*sin_q2_half*sin_q2_half*u_value_half - cos_q2_half*w_4 - cos_q2_half_g_m1_m2 - cos_q2_half_sq*l_m1_m2_v2_half_sq)
        w_13 = inv_w_9*sin_q2_half*v2_half
        twice_l_m2_w_13 = twice_l_m2*w_13
        w_14 = cos_q2_half*twice_m2*w_13
        k2_lambda_q2 = lambda_v1_2*w_11 - lambda_v2_2*w_12
        k2_lambda_v1 = -lambda_q1
        k2_lambda_v2 = lambda_v2_2*w_14 - lambda_q2_2 - lambda_v1_2*twice_l_m2_w_13
        lambda_q2_3 = half*k2_lambda_q2 + lambda_q2
        lambda_v1_3 = half*k2_lambda_v1 + lambda_v1
        lambda_v2_3 = half*k2_lambda_v2 + lambda_v2
        k3_lambda_q2 = lambda_v1_3*w_11 - lambda_v2_3*w_12
        k3_lambda_v2 = lambda_v2_3*w_14 - lambda_q2_3 - lambda_v1_3*twice_l_m2_w_13
        lambda_q2_4 = h*k3_lambda_q2 + lambda_q2
        lambda_v1_4 = h*k2_lambda_v1 + lambda_v1
        lambda_v2_4 = h*k3_lambda_v2 + lambda_v2
        sin_q2_end = math.sin(q2_end)
        sin_q2_end_u_value_end = sin_q2_end*u_value_end
        sin_q2_end_sq = sin_q2_end*sin_q2_end
        cos_q2_end = math.cos(q2_end)
        cos_q2_end_sq = cos_q2_end*cos_q2_end
        w_15 = cos_q2_end_sq*sin_q2_end_sq
        v2_end_sq = v2_end*v2_end
        cos_q2_end_v2_end_sq = cos_q2_end*v2_end_sq
        w_16 = m1 + m2*sin_q2_end_sq
        inv_w_16 = 1.0/w_16
        inv_w_16_sq = inv_w_16*inv_w_16
        w_17 = sin_q2_end*sin_q2_end*sin_q2_end*sin_q2_end
        w_18 = inv_w_16_sq*m2*(2.0*cos_q2_end*sin_q2_end_u_value_end + cos_q2_end_v2_end_sq*l_m2*sin_q2_end_sq + g_m1*sin_q2_end_sq + g_m2*w_15 + g_m2*w_17 - cos_q2_end_sq*g_m1 - cos_q2_end_v2_end_sq*l_m1)
        cos_q2_end_g_m1_m2 = cos_q2_end*g_m1_m2
        l_m1_m2_v2_end_sq = l_m1_m2*v2_end_sq
        l_m2_sq_v2_end_sq = l_m2_sq*v2_end_sq
        w_19 = inv_l*inv_w_16_sq*(cos_q2_end*g_m2_sq*sin_q2_end_sq + cos_q2_end_g_m1_m2*sin_q2_end_sq + cos_q2_end_sq*sin_q2_end_u_value_end*twice_m2 + l_m1_m2_v2_end_sq*sin_q2_end_sq + l_m2_sq_v2_end_sq*w_15 + l_m2_sq_v2_end_sq*w_17 + m1*sin_q2_end_u_value_end + m2*sin_q2_end*sin_q2_end*sin_q2_end*u_value_end - cos_q2_end*w_4 - cos_q2_end_g_m1_m2 - cos_q2_end_sq*l_m1_m2_v2_end_sq)
        w_20 = inv_w_16*sin_q2_end*v2_end
        twice_l_m2_w_20 = twice_l_m2*w_20
        cos_q2_end_twice_m2_w_20 = cos_q2_end*twice_m2*w_20
        k4_lambda_q2 = lambda_v1_4*w_18 - lambda_v2_4*w_19
        k4_lambda_v2 = cos_q2_end_twice_m2_w_20*lambda_v2_4 - lambda_q2_4 - lambda_v1_4*twice_l_m2_w_20
        lambda_q2_end = lambda_q2 + sixth*(k4_lambda_q2 + slope_lambda_q2 + 2.0*(k2_lambda_q2 + k3_lambda_q2))
        lambda_v1_end = lambda_v1 + sixth*(5.0*k2_lambda_v1 + slope_lambda_v1)
        lambda_v2_end = lambda_v2 + sixth*(k4_lambda_v2 + slope_lambda_v2 + 2.0*(k2_lambda_v2 + k3_lambda_v2))
        slope_end_lambda_q2 = lambda_v1_end*w_18 - lambda_v2_end*w_19
        slope_end_lambda_v2 = cos_q2_end_twice_m2_w_20*lambda_v2_end - lambda_q2_end - lambda_v1_end*twice_l_m2_w_20
        eighth = 0.125*h
        lambda_q1_mid[i] = lambda_q1
        lambda_q1_at[i] = lambda_q1
        lambda_q2_mid[i] = eighth*(slope_lambda_q2 - slope_end_lambda_q2) + 0.5*(lambda_q2 + lambda_q2_end)
        lambda_q2_at[i] = lambda_q2_end
        lambda_v1_mid[i] = eighth*(slope_lambda_v1 - k2_lambda_v1) + 0.5*(lambda_v1 + lambda_v1_end)
        lambda_v1_at[i] = lambda_v1_end
        lambda_v2_mid[i] = eighth*(slope_lambda_v2 - slope_end_lambda_v2) + 0.5*(lambda_v2 + lambda_v2_end)
        lambda_v2_at[i] = lambda_v2_end
        t = t_end
        lambda_q2 = lambda_q2_end
        lambda_v1 = lambda_v1_end
        lambda_v2 = lambda_v2_end
        slope_lambda_q2 = slope_end_lambda_q2
        slope_lambda_v1 = k2_lambda_v1
        slope_lambda_v2 = slope_end_lambda_v2


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))
    sin_q2 = np.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    g_sin_q2 = g*sin_q2
    cos_q2 = np.cos(q2)
    cos_q2_m2 = cos_q2*m2
    w_2 = l*sin_q2*v2*v2
    inv_l = 1.0/l
    out[0] = v1
    out[1] = v2
    out[2] = inv_w*(cos_q2_m2*g_sin_q2 + m2*w_2 + u_value)
    out[3] = inv_l*inv_w*(-cos_q2*u_value - cos_q2_m2*w_2 - g_sin_q2*(m1 + m2))
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    sin_q2 = np.sin(q2)
    sin_q2_sq = sin_q2*sin_q2
    w = l*v2*v2
    cos_q2 = np.cos(q2)
    cos_q2_w = cos_q2*w
    m2_sin_q2_sq = m2*sin_q2_sq
    w_2 = m1 + m2_sin_q2_sq
    inv_w_2 = 1.0/w_2
    inv_w_2_sq = inv_w_2*inv_w_2
    g_m1 = g*m1
    w_3 = sin_q2*sin_q2*sin_q2*sin_q2
    cos_q2_sq = cos_q2*cos_q2
    sin_q2_u_value = sin_q2*u_value
    twice_sin_q2_u_value = 2.0*sin_q2_u_value
    w_4 = 2.0*inv_w_2*m2*sin_q2*v2
    inv_l = 1.0/l
    cos_q2_g_m1 = cos_q2*g_m1
    cos_q2_g = cos_q2*g
    cos_q2_sq_m2 = cos_q2_sq*m2
    m2_sq = m2*m2
    m2_sq_sin_q2_sq = m2_sq*sin_q2_sq
    m1_w = m1*w
    out[0, 2] = 1.0
    out[1, 3] = 1.0
    out[2, 1] = -inv_w_2_sq*m2*(cos_q2*twice_sin_q2_u_value + cos_q2_sq*g*m2_sin_q2_sq + cos_q2_w*m2_sin_q2_sq + g*m2*w_3 + g_m1*sin_q2_sq - cos_q2_sq*g_m1 - cos_q2_w*m1)
    out[2, 3] = l*w_4
    out[3, 1] = inv_l*inv_w_2_sq*(cos_q2_g*m2_sq_sin_q2_sq + cos_q2_g_m1*m2_sin_q2_sq + cos_q2_sq*m2_sq_sin_q2_sq*w + cos_q2_sq_m2*twice_sin_q2_u_value + m1*sin_q2_u_value + m1_w*m2_sin_q2_sq + m2*sin_q2*sin_q2*sin_q2*u_value + m2_sq*w*w_3 - cos_q2_g*m1*m1 - cos_q2_g_m1*m2 - cos_q2_sq_m2*m1_w)
    out[3, 3] = -cos_q2*w_4
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 1, *shape), np.result_type(float, t, x, u, *p))
    sin_q2 = np.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    inv_l = 1.0/l
    out[0, 0] = 0.0
    out[1, 0] = 0.0
    out[2, 0] = inv_w
    out[3, 0] = -inv_l*inv_w*np.cos(q2)
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = u_value*u_value
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    q1, q2, v1, v2 = x
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    q1, q2, v1, v2 = x
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    sin_q2 = np.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    inv_l = 1.0/l
    g_sin_q2 = g*sin_q2
    cos_q2 = np.cos(q2)
    cos_q2_m2 = cos_q2*m2
    w_2 = l*sin_q2*v2*v2
    out[...] = inv_l*inv_w*lambda_v2*(-cos_q2*u_value - cos_q2_m2*w_2 - g_sin_q2*(m1 + m2)) + inv_w*lambda_v1*(cos_q2_m2*g_sin_q2 + m2*w_2 + u_value) + lambda_q1*v1 + lambda_q2*v2 + u_value*u_value
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_l = 1.0/l
    sin_q2 = np.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    out[0] = inv_l*inv_w*(l*lambda_v1 - lambda_v2*np.cos(q2)) + 2.0*u_value
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((1, 1, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = 2.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_l = 1.0/l
    sin_q2 = np.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    w_2 = 0.5*inv_l*inv_w*(lambda_v2*np.cos(q2) - l*lambda_v1)
    u_2 = np.minimum(np.maximum(w_2, u_min), u_max)
    out[0] = u_2
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    q1, q2, v1, v2 = x
    (u_value,) = u
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, lam, *p))
    sin_q2 = np.sin(q2)
    inv_l = 1.0/l
    sin_q2_sq = sin_q2*sin_q2
    w = l*v2*v2
    cos_q2 = np.cos(q2)
    cos_q2_w = cos_q2*w
    g_m1 = g*m1
    cos_q2_g_m1 = cos_q2*g_m1
    cos_q2_g = cos_q2*g
    cos_q2_sq = cos_q2*cos_q2
    cos_q2_sq_m2 = cos_q2_sq*m2
    m2_sq = m2*m2
    m2_sq_sin_q2_sq = m2_sq*sin_q2_sq
    m1_w = m1*w
    m2_sin_q2_sq = m2*sin_q2_sq
    w_2 = m1 + m2_sin_q2_sq
    inv_w_2 = 1.0/w_2
    inv_w_2_sq = inv_w_2*inv_w_2
    w_3 = sin_q2*sin_q2*sin_q2*sin_q2
    sin_q2_u_value = sin_q2*u_value
    twice_sin_q2_u_value = 2.0*sin_q2_u_value
    out[0] = 0.0
    out[1] = inv_w_2_sq*lambda_v1*m2*(cos_q2*twice_sin_q2_u_value + cos_q2_sq*g*m2_sin_q2_sq + cos_q2_w*m2_sin_q2_sq + g*m2*w_3 + g_m1*sin_q2_sq - cos_q2_sq*g_m1 - cos_q2_w*m1) - inv_l*inv_w_2_sq*lambda_v2*(cos_q2_g*m2_sq_sin_q2_sq + cos_q2_g_m1*m2_sin_q2_sq + cos_q2_sq*m2_sq_sin_q2_sq*w + cos_q2_sq_m2*twice_sin_q2_u_value + m1*sin_q2_u_value + m1_w*m2_sin_q2_sq + m2*sin_q2*sin_q2*sin_q2*u_value + m2_sq*w*w_3 - cos_q2_g*m1*m1 - cos_q2_g_m1*m2 - cos_q2_sq_m2*m1_w)
    out[2] = -lambda_q1
    out[3] = 2.0*cos_q2*inv_w_2*lambda_v2*m2*sin_q2*v2 - 2.0*inv_w_2*l*lambda_v1*m2*sin_q2*v2 - lambda_q2
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    sin_q2 = np.sin(q2)
    sin_q2_sq = sin_q2*sin_q2
    m2_sin_q2_sq = m2*sin_q2_sq
    w = m1 + m2_sin_q2_sq
    inv_w = 1.0/w
    l_lambda_v1 = l*lambda_v1
    cos_q2 = np.cos(q2)
    inv_l = 1.0/l
    inv_l_inv_w = inv_l*inv_w
    w_2 = 0.5*inv_l_inv_w*(cos_q2*lambda_v2 - l_lambda_v1)
    w_3 = np.minimum(np.maximum(w_2, u_min), u_max)
    g_sin_q2 = g*sin_q2
    cos_q2_m2 = cos_q2*m2
    w_4 = l*v2*v2
    m2_sin_q2 = m2*sin_q2
    cos_q2_w_3 = cos_q2*w_3
    inv_w_sq = inv_w*inv_w
    g_m1 = g*m1
    w_5 = sin_q2*sin_q2*sin_q2*sin_q2
    cos_q2_sq = cos_q2*cos_q2
    cos_q2_w_4 = cos_q2*w_4
    sin_q2_w_3 = sin_q2*w_3
    cos_q2_g = cos_q2*g
    cos_q2_sq_m2 = cos_q2_sq*m2
    m2_sq = m2*m2
    m2_sq_sin_q2_sq = m2_sq*sin_q2_sq
    m1_w_4 = m1*w_4
    out[0] = v1
    out[1] = v2
    out[2] = inv_w*(cos_q2_m2*g_sin_q2 + m2_sin_q2*w_4 + w_3)
    out[3] = inv_l_inv_w*(-cos_q2_m2*sin_q2*w_4 - cos_q2_w_3 - g_sin_q2*(m1 + m2))
    out[4] = 0.0
    out[5] = inv_w_sq*lambda_v1*m2*(cos_q2_sq*g*m2_sin_q2_sq + 2.0*cos_q2_w_3*sin_q2 + cos_q2_w_4*m2_sin_q2_sq + g*m2*w_5 + g_m1*sin_q2_sq - cos_q2_sq*g_m1 - cos_q2_w_4*m1) - inv_l*inv_w_sq*lambda_v2*(cos_q2*g_m1*m2_sin_q2_sq + cos_q2_g*m2_sq_sin_q2_sq + cos_q2_sq*m2_sq_sin_q2_sq*w_4 + 2.0*cos_q2_sq_m2*sin_q2_w_3 + m1*sin_q2_w_3 + m1_w_4*m2_sin_q2_sq + m2*sin_q2*sin_q2*sin_q2*w_3 + m2_sq*w_4*w_5 - cos_q2_g*m1*m1 - cos_q2_m2*g_m1 - cos_q2_sq_m2*m1_w_4)
    out[6] = -lambda_q1
    out[7] = 2.0*cos_q2*inv_w*lambda_v2*m2*sin_q2*v2 - 2.0*inv_w*l_lambda_v1*m2_sin_q2*v2 - lambda_q2
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, 8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    sin_q2 = np.sin(q2)
    sin_q2_sq = sin_q2*sin_q2
    m2_sin_q2_sq = m2*sin_q2_sq
    w = m1 + m2_sin_q2_sq
    inv_w = 1.0/w
    l_lambda_v1 = l*lambda_v1
    cos_q2 = np.cos(q2)
    w_2 = cos_q2*lambda_v2 - l_lambda_v1
    inv_l = 1.0/l
    inv_l_inv_w = inv_l*inv_w
    half_inv_l_inv_w = 0.5*inv_l_inv_w
    half_inv_l_inv_w_w_2 = half_inv_l_inv_w*w_2
    w_3 = np.minimum(np.maximum(half_inv_l_inv_w_w_2, u_min), u_max)
    v2_sq = v2*v2
    l_v2_sq = l*v2_sq
    l_v2_sq_m2 = l_v2_sq*m2
    l_v2_sq_m2_sin_q2 = l_v2_sq_m2*sin_q2
    twice_cos_q2 = 2.0*cos_q2
    inv_w_sq = inv_w*inv_w
    inv_w_sq_m2 = inv_w_sq*m2
    inv_w_sq_m2_sin_q2 = inv_w_sq_m2*sin_q2
    w_4 = inv_w_sq_m2_sin_q2*twice_cos_q2
    cos_q2_sq = cos_q2*cos_q2
    g_m2 = g*m2
    cos_q2_sq_g_m2 = cos_q2_sq*g_m2
    g_m2_sin_q2_sq = g*m2_sin_q2_sq
    cos_q2_m2 = cos_q2*m2
    cos_q2_m2_l_v2_sq = cos_q2_m2*l_v2_sq
    w_5 = np.heaviside(half_inv_l_inv_w_w_2 - u_min, 1.0)*np.heaviside(u_max - half_inv_l_inv_w_w_2, 1.0)
    cos_q2_inv_l = cos_q2*inv_l
    w_6 = w_5*(-cos_q2_inv_l*inv_w_sq_m2_sin_q2*w_2 - half_inv_l_inv_w*lambda_v2*sin_q2)
    g_m2_sin_q2 = g_m2*sin_q2
    l_v2 = l*v2
    twice_sin_q2 = 2.0*sin_q2
    inv_w_twice_sin_q2 = inv_w*twice_sin_q2
    inv_w_twice_sin_q2_m2 = inv_w_twice_sin_q2*m2
    w_7 = inv_w_twice_sin_q2_m2*l_v2
    half_w_5 = 0.5*w_5
    half_w_5_inv_w_sq = half_w_5*inv_w_sq
    w_8 = cos_q2_inv_l*half_w_5_inv_w_sq
    cos_q2_w_3 = cos_q2*w_3
    w_9 = g*(m1 + m2)
    cos_q2_sq_l_v2_sq_m2 = cos_q2_sq*l_v2_sq_m2
    cos_q2_w_6 = cos_q2*w_6
    cos_q2_m2_v2 = cos_q2_m2*v2
    w_10 = cos_q2_m2_v2*inv_w_twice_sin_q2
    m2_sq = m2*m2
    g_m1 = g*m1
    w_11 = sin_q2*sin_q2*sin_q2*sin_q2
    sin_q2_w_3 = sin_q2*w_3
    cos_q2_m1 = cos_q2*m1
    l_v2_sq_m2_sin_q2_sq = l_v2_sq*m2_sin_q2_sq
    w_12 = cos_q2*l_v2_sq_m2_sin_q2_sq + cos_q2_sq*g_m2_sin_q2_sq + g_m1*sin_q2_sq + g_m2*w_11 + sin_q2_w_3*twice_cos_q2 - cos_q2_m1*l_v2_sq - cos_q2_sq*g_m1
    w_13 = 4.0*sin_q2
    cos_q2_w_13 = cos_q2*w_13
    inv_w_cubed = inv_w*inv_w*inv_w
    inv_w_cubed_lambda_v1 = inv_w_cubed*lambda_v1
    twice_w_3 = 2.0*w_3
    m1_sin_q2 = m1*sin_q2
    sin_q2_cubed = sin_q2*sin_q2*sin_q2
    w_14 = sin_q2_cubed*twice_cos_q2
    cos_q2_cubed = cos_q2*cos_q2*cos_q2
    m2_sin_q2_cubed = m2*sin_q2_cubed
    g_m2_m1 = g_m2*m1
    w_15 = g*m1*m1
    g_m2_sq = g*m2_sq
    l_v2_sq_m2_sq = l_v2_sq*m2_sq
    cos_q2_sq_m2 = cos_q2_sq*m2
    twice_cos_q2_sq_m2 = 2.0*cos_q2_sq_m2
    cos_q2_sq_sin_q2_sq = cos_q2_sq*sin_q2_sq
    w_16 = cos_q2*g_m2_sq*sin_q2_sq + cos_q2_m1*g_m2_sin_q2_sq + cos_q2_sq_sin_q2_sq*l_v2_sq_m2_sq + l_v2_sq_m2_sin_q2_sq*m1 + l_v2_sq_m2_sq*w_11 + m1*sin_q2_w_3 + m2_sin_q2_cubed*w_3 + sin_q2_w_3*twice_cos_q2_sq_m2 - cos_q2*g_m2_m1 - cos_q2*w_15 - cos_q2_sq_l_v2_sq_m2*m1
    cos_q2_cubed_m2 = cos_q2_cubed*m2
    cos_q2_sq_twice_sin_q2 = cos_q2_sq*twice_sin_q2
    inv_l_inv_w_sq = inv_l*inv_w_sq
    inv_l_inv_w_sq_lambda_v2 = inv_l_inv_w_sq*lambda_v2
    l_v2_twice_cos_q2 = l_v2*twice_cos_q2
    twice_l_v2 = 2.0*l_v2
    m2_sq_twice_l_v2 = m2_sq*twice_l_v2
    sin_q2_w_5 = sin_q2*w_5
    half_w_5_inv_w = half_w_5*inv_w
    w_17 = cos_q2*half_w_5*inv_l_inv_w
    lambda_v2_v2 = lambda_v2*v2
    twice_inv_w = 2.0*inv_w
    out[0, 2] = 1.0
    out[1, 3] = 1.0
    out[2, 1] = inv_w*(cos_q2_m2_l_v2_sq + cos_q2_sq_g_m2 + w_6 - g_m2_sin_q2_sq) - w_4*(cos_q2*g_m2_sin_q2 + l_v2_sq_m2_sin_q2 + w_3)
    out[2, 3] = w_7
    out[2, 6] = -half_w_5_inv_w_sq
    out[2, 7] = w_8
    out[3, 1] = inv_l*inv_w*(l*m2*sin_q2_sq*v2_sq + sin_q2*w_3 - cos_q2*w_9 - cos_q2_sq_l_v2_sq_m2 - cos_q2_w_6) - inv_l*w_4*(-cos_q2_m2_l_v2_sq*sin_q2 - cos_q2_w_3 - sin_q2*w_9)
    out[3, 3] = -w_10
    out[3, 6] = w_8
    out[3, 7] = -cos_q2_sq*half_w_5_inv_w_sq*inv_l*inv_l
    out[5, 1] = cos_q2*inv_l*inv_w_cubed*lambda_v2*m2*w_13*w_16 + inv_w_sq_m2*lambda_v1*(2.0*cos_q2_cubed*g_m2_sin_q2 + 2.0*cos_q2_sq*l_v2_sq_m2_sin_q2 + cos_q2_sq*twice_w_3 + cos_q2_w_13*g_m1 + cos_q2_w_6*twice_sin_q2 + g_m2*w_14 + l_v2_sq*m1_sin_q2 - l_v2_sq*m2_sin_q2_cubed - sin_q2_sq*twice_w_3) - cos_q2_w_13*inv_w_cubed_lambda_v1*m2_sq*w_12 - inv_l_inv_w_sq_lambda_v2*(cos_q2_cubed*l_v2_sq_m2_sq*twice_sin_q2 + cos_q2_cubed_m2*twice_w_3 + 4.0*cos_q2_m2_l_v2_sq*m1_sin_q2 + 2.0*cos_q2_sq_g_m2*m1_sin_q2 + cos_q2_sq_twice_sin_q2*g_m2_sq + cos_q2_sq_twice_sin_q2*m2*w_6 + cos_q2_w_3*m1 + g_m2_sin_q2*m1 + l_v2_sq_m2_sq*w_14 + m1_sin_q2*w_6 + m2_sin_q2_cubed*w_6 + sin_q2*w_15 - cos_q2_w_3*m2_sin_q2_sq - g_m2_m1*sin_q2_cubed - g_m2_sq*sin_q2_cubed)
    out[5, 3] = inv_w_sq*lambda_v1*m2*(l_v2_twice_cos_q2*m2_sin_q2_sq - l_v2_twice_cos_q2*m1) - inv_l_inv_w_sq_lambda_v2*(cos_q2_sq_sin_q2_sq*m2_sq_twice_l_v2 + m1*m2_sin_q2_sq*twice_l_v2 + m2_sq_twice_l_v2*w_11 - l_v2*m1*twice_cos_q2_sq_m2)
    out[5, 6] = inv_w_sq*m2*w_12 - cos_q2_m2*inv_w_cubed_lambda_v1*sin_q2_w_5 - inv_l_inv_w_sq_lambda_v2*(-cos_q2_sq_m2*inv_w*sin_q2_w_5 - half_w_5_inv_w*m1_sin_q2 - half_w_5_inv_w*m2_sin_q2_cubed)
    out[5, 7] = cos_q2_sq*inv_l*inv_w_cubed*lambda_v1*m2*sin_q2*w_5 - inv_l_inv_w_sq*w_16 - inv_l_inv_w_sq_lambda_v2*(cos_q2_cubed_m2*inv_l_inv_w*sin_q2_w_5 + m1_sin_q2*w_17 + m2_sin_q2_cubed*w_17)
    out[6, 4] = -1.0
    out[7, 1] = 4.0*cos_q2*inv_w_sq*l*lambda_v1*m2_sq*sin_q2_sq*v2 + 2.0*cos_q2_sq*inv_w*lambda_v2*m2*v2 - cos_q2_m2_v2*l_lambda_v1*twice_inv_w - 4.0*cos_q2_sq_sin_q2_sq*inv_w_sq*lambda_v2_v2*m2_sq - lambda_v2_v2*m2_sin_q2_sq*twice_inv_w
    out[7, 3] = 2.0*cos_q2*inv_w*lambda_v2*m2*sin_q2 - inv_w_twice_sin_q2_m2*l_lambda_v1
    out[7, 5] = -1.0
    out[7, 6] = -w_7
    out[7, 7] = w_10
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = 0.0
    out[7] = 0.0
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    given_q1, given_q2, given_v1, given_v2, on_reference_q1, on_reference_q2, on_reference_v1, on_reference_v2, target_q1, target_q2, target_v1, target_v2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    sin_q2 = np.sin(q2)
    w = m1 + m2*sin_q2*sin_q2
    inv_w = 1.0/w
    cos_q2 = np.cos(q2)
    inv_l = 1.0/l
    inv_l_inv_w = inv_l*inv_w
    w_2 = 0.5*inv_l_inv_w*(cos_q2*lambda_v2 - l*lambda_v1)
    w_3 = np.minimum(np.maximum(w_2, u_min), u_max)
    g_sin_q2 = g*sin_q2
    cos_q2_m2 = cos_q2*m2
    w_4 = l*sin_q2*v2*v2
    out[0] = given_q1*(q1 - target_q1) + lambda_q1*(1.0 - given_q1 - on_reference_q1) + on_reference_q1*q1
    out[1] = given_q2*(q2 - target_q2) + lambda_q2*(1.0 - given_q2 - on_reference_q2) + on_reference_q2*q2
    out[2] = given_v1*(v1 - target_v1) + lambda_v1*(1.0 - given_v1 - on_reference_v1) + on_reference_v1*v1
    out[3] = given_v2*(v2 - target_v2) + lambda_v2*(1.0 - given_v2 - on_reference_v2) + on_reference_v2*v2
    out[4] = inv_l_inv_w*lambda_v2*(-cos_q2*w_3 - cos_q2_m2*w_4 - g_sin_q2*(m1 + m2)) + inv_w*lambda_v1*(cos_q2_m2*g_sin_q2 + m2*w_4 + w_3) + lambda_q1*v1 + lambda_q2*v2 + w_3*w_3
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    q1, q2, v1, v2 = x
    lambda_q1, lambda_q2, lambda_v1, lambda_v2 = lam
    m1, m2, l, g = p
    u_min, u_max = bounds
    given_q1, given_q2, given_v1, given_v2, on_reference_q1, on_reference_q2, on_reference_v1, on_reference_v2, target_q1, target_q2, target_v1, target_v2 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, 9, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_q1 + on_reference_q1
    w_2 = given_q2 + on_reference_q2
    w_3 = given_v1 + on_reference_v1
    w_4 = given_v2 + on_reference_v2
    sin_q2 = np.sin(q2)
    sin_q2_sq = sin_q2*sin_q2
    m2_sin_q2_sq = m2*sin_q2_sq
    w_5 = m1 + m2_sin_q2_sq
    inv_w_5 = 1.0/w_5
    l_lambda_v1 = l*lambda_v1
    cos_q2 = np.cos(q2)
    w_6 = cos_q2*lambda_v2 - l_lambda_v1
    inv_l = 1.0/l
    inv_l_inv_w_5 = inv_l*inv_w_5
    half_inv_l_inv_w_5 = 0.5*inv_l_inv_w_5
    half_inv_l_inv_w_5_w_6 = half_inv_l_inv_w_5*w_6
    w_7 = np.minimum(np.maximum(half_inv_l_inv_w_5_w_6, u_min), u_max)
    cos_q2_m2 = cos_q2*m2
    cos_q2_m2_sin_q2 = cos_q2_m2*sin_q2
    v2_sq = v2*v2
    l_v2_sq = l*v2_sq
    m2_sin_q2 = m2*sin_q2
    w_8 = cos_q2_m2_sin_q2*g + l_v2_sq*m2_sin_q2 + w_7
    inv_w_5_sq = inv_w_5*inv_w_5
    inv_w_5_sq_lambda_v1 = inv_w_5_sq*lambda_v1
    w_9 = np.heaviside(half_inv_l_inv_w_5_w_6 - u_min, 1.0)*np.heaviside(u_max - half_inv_l_inv_w_5_w_6, 1.0)
    inv_l_inv_w_5_sq = inv_l*inv_w_5_sq
    w_10 = w_9*(-cos_q2_m2_sin_q2*inv_l_inv_w_5_sq*w_6 - half_inv_l_inv_w_5*lambda_v2*sin_q2)
    w_11 = g*(m1 + m2)
    cos_q2_m2_l_v2_sq = cos_q2_m2*l_v2_sq
    cos_q2_w_7 = cos_q2*w_7
    w_12 = -cos_q2_m2_l_v2_sq*sin_q2 - cos_q2_w_7 - sin_q2*w_11
    cos_q2_lambda_v2 = cos_q2*lambda_v2
    w_13 = cos_q2_lambda_v2*inv_l_inv_w_5_sq
    twice_m2_sin_q2 = 2.0*m2_sin_q2
    cos_q2_sq = cos_q2*cos_q2
    cos_q2_sq_m2 = cos_q2_sq*m2
    w_14 = inv_w_5*twice_m2_sin_q2*v2
    inv_w_5_w_9 = inv_w_5*w_9
    half_w_9 = 0.5*w_9
    w_15 = half_w_9*inv_w_5_sq_lambda_v1
    out[0, 0] = w
    out[0, 4] = 1.0 - w
    out[1, 1] = w_2
    out[1, 5] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 6] = 1.0 - w_3
    out[3, 3] = w_4
    out[3, 7] = 1.0 - w_4
    out[4, 1] = inv_l_inv_w_5*lambda_v2*(l*m2*sin_q2_sq*v2_sq + sin_q2*w_7 - cos_q2*w_10 - cos_q2*w_11 - cos_q2_sq_m2*l_v2_sq) + inv_w_5*lambda_v1*(cos_q2_m2_l_v2_sq + cos_q2_sq_m2*g + w_10 - g*m2_sin_q2_sq) + 2.0*w_10*w_7 - 2.0*cos_q2_m2_sin_q2*inv_w_5_sq_lambda_v1*w_8 - twice_m2_sin_q2*w_12*w_13
    out[4, 2] = lambda_q1
    out[4, 3] = l_lambda_v1*w_14 + lambda_q2 - cos_q2_lambda_v2*w_14
    out[4, 4] = v1
    out[4, 5] = v2
    out[4, 6] = half_w_9*w_13 + inv_w_5*w_8 - inv_w_5_w_9*w_7 - w_15
    out[4, 7] = cos_q2*inv_l*w_15 + cos_q2_w_7*inv_l*inv_w_5_w_9 + inv_l_inv_w_5*w_12 - cos_q2_sq*half_w_9*inv_l*inv_l*inv_w_5_sq*lambda_v2
    return out
