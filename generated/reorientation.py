"""Minimum-time rest-to-rest reorientation of a rigid body.

Written by satsym from derivations/examples/reorientation.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/reorientation.py
Source: ../derivations/examples/reorientation.py 2cdc777bdab0cb58d428a4243a641a7f
Digest: 6048fd2d893014f4ed354609ea00d9a8b54dff29980342638a1115c54cf56025
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'reorientation',
    'title': 'Minimum-time rest-to-rest reorientation of a rigid body',
    'source': 'derivations/examples/reorientation.py',
    'states': (
        {'symbol': 'q1', 'latex': 'q_1', 'meaning': 'component 1 of the quaternion'},
        {'symbol': 'q2', 'latex': 'q_2', 'meaning': 'component 2 of the quaternion'},
        {'symbol': 'q3', 'latex': 'q_3', 'meaning': 'component 3 of the quaternion'},
        {'symbol': 'q4', 'latex': 'q_4', 'meaning': 'component 4 of the quaternion'},
        {'symbol': 'w1', 'latex': '\\omega_1', 'meaning': 'angular velocity about axis 1'},
        {'symbol': 'w2', 'latex': '\\omega_2', 'meaning': 'angular velocity about axis 2'},
        {'symbol': 'w3', 'latex': '\\omega_3', 'meaning': 'angular velocity about axis 3'},
    ),
    'controls': (
        {'symbol': 'u1', 'latex': 'u_1', 'meaning': 'torque about axis 1'},
        {'symbol': 'u2', 'latex': 'u_2', 'meaning': 'torque about axis 2'},
        {'symbol': 'u3', 'latex': 'u_3', 'meaning': 'torque about axis 3'},
    ),
    'parameters': (
        {'symbol': 'I1', 'latex': 'I_1', 'meaning': 'moment of inertia about axis 1', 'default': 1.0, 'positive': True},
        {'symbol': 'I2', 'latex': 'I_2', 'meaning': 'moment of inertia about axis 2', 'default': 1.0, 'positive': True},
        {'symbol': 'I3', 'latex': 'I_3', 'meaning': 'moment of inertia about axis 3', 'default': 1.0, 'positive': True},
    ),
    'control_set': 'box',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'switching': True,
    'objective_unit': '1',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    I1, I2, I3 = p
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    inv_I1 = 1.0/I1
    w = -I3
    inv_I2 = 1.0/I2
    inv_I3 = 1.0/I3
    return (
        half_w1*q4 + half_w3*q2 - half_w2*q3,
        half_w1*q3 + half_w2*q4 - half_w3*q1,
        half_w2*q1 + half_w3*q4 - half_w1*q2,
        -half_w1*q1 - half_w2*q2 - half_w3*q3,
        inv_I1*(u1 - w2*w3*(-I2 - w)),
        inv_I2*(u2 - w1*w3*(I1 + w)),
        inv_I3*(u3 - w1*w2*(I2 - I1)),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    I1, I2, I3 = p
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    w = -half_w2
    half_w1 = 0.5*w1
    half_q4 = 0.5*q4
    half_q3 = 0.5*q3
    w_2 = -half_q3
    half_q2 = 0.5*q2
    w_3 = -half_w3
    half_q1 = 0.5*q1
    w_4 = -half_q1
    w_5 = -half_w1
    w_6 = -half_q2
    inv_I1 = 1.0/I1
    w_7 = -I3
    w_8 = inv_I1*(I2 + w_7)
    inv_I2 = 1.0/I2
    w_9 = inv_I2*(-I1 - w_7)
    inv_I3 = 1.0/I3
    w_10 = inv_I3*(I1 - I2)
    return (
        0.0,
        half_w3,
        w,
        half_w1,
        half_q4,
        w_2,
        half_q2,
        w_3,
        0.0,
        half_w1,
        half_w2,
        half_q3,
        half_q4,
        w_4,
        half_w2,
        w_5,
        0.0,
        half_w3,
        w_6,
        half_q1,
        half_q4,
        w_5,
        w,
        w_3,
        0.0,
        w_4,
        w_6,
        w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w3*w_8,
        w2*w_8,
        0.0,
        0.0,
        0.0,
        0.0,
        w3*w_9,
        0.0,
        w1*w_9,
        0.0,
        0.0,
        0.0,
        0.0,
        w2*w_10,
        w1*w_10,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    I1, I2, I3 = p
    inv_I1 = 1.0/I1
    inv_I2 = 1.0/I2
    inv_I3 = 1.0/I3
    return (
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
        inv_I1,
        0.0,
        0.0,
        0.0,
        inv_I2,
        0.0,
        0.0,
        0.0,
        inv_I3,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    I1, I2, I3 = p
    return 1.0


def terminal_cost(t, x, p):
    """Terminal cost S."""
    q1, q2, q3, q4, w1, w2, w3 = x
    I1, I2, I3 = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    q1, q2, q3, q4, w1, w2, w3 = x
    I1, I2, I3 = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    inv_I1 = 1.0/I1
    inv_I2 = 1.0/I2
    inv_I3 = 1.0/I3
    w = -I3
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    return inv_I1*lambda_w1*(u1 - w2*w3*(-I2 - w)) + inv_I2*lambda_w2*(u2 - w1*w3*(I1 + w)) + inv_I3*lambda_w3*(u3 - w1*w2*(I2 - I1)) + lambda_q1*(half_w1*q4 + half_w3*q2 - half_w2*q3) + lambda_q2*(half_w1*q3 + half_w2*q4 - half_w3*q1) + lambda_q3*(half_w2*q1 + half_w3*q4 - half_w1*q2) + lambda_q4*(-half_w1*q1 - half_w2*q2 - half_w3*q3) + 1.0


def switching_function(t, x, lam, p):
    """What multiplies each control in H."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    inv_I1 = 1.0/I1
    inv_I2 = 1.0/I2
    inv_I3 = 1.0/I3
    return (
        inv_I1*lambda_w1,
        inv_I2*lambda_w2,
        inv_I3*lambda_w3,
    )


def switching_rate(t, x, u, lam, p):
    """Its rates of change along an extremal."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    inv_I1 = 1.0/I1
    half_inv_I1 = 0.5*inv_I1
    inv_I2 = 1.0/I2
    inv_I1_inv_I2_w3 = inv_I1*inv_I2*w3
    w = -I3
    w_2 = lambda_w2*(I1 + w)
    inv_I3 = 1.0/I3
    w_3 = inv_I3*lambda_w3*(I2 - I1)
    inv_I1_w2 = inv_I1*w2
    half_inv_I2 = 0.5*inv_I2
    w_4 = lambda_w1*(-I2 - w)
    inv_I2_w1 = inv_I2*w1
    half_inv_I3 = 0.5*inv_I3
    return (
        half_inv_I1*lambda_q3*q2 + half_inv_I1*lambda_q4*q1 + inv_I1_inv_I2_w3*w_2 + inv_I1_w2*w_3 - half_inv_I1*lambda_q1*q4 - half_inv_I1*lambda_q2*q3,
        half_inv_I2*lambda_q1*q3 + half_inv_I2*lambda_q4*q2 + inv_I1_inv_I2_w3*w_4 + inv_I2_w1*w_3 - half_inv_I2*lambda_q2*q4 - half_inv_I2*lambda_q3*q1,
        half_inv_I3*lambda_q2*q1 + half_inv_I3*lambda_q4*q3 + inv_I1_w2*inv_I3*w_4 + inv_I2_w1*inv_I3*w_2 - half_inv_I3*lambda_q1*q2 - half_inv_I3*lambda_q3*q4,
    )


def magnitude_weight(t, x, lam, p):
    """What multiplies each |u| in H."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    return (
        0.0,
        0.0,
        0.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the box."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    inv_I1 = 1.0/I1
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    u1 = u1_min if inv_I1_lambda_w1 > 0.0 else u1_max if inv_I1_lambda_w1 < 0.0 else 0.5*(u1_min + u1_max)
    inv_I2 = 1.0/I2
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    u2 = u2_min if inv_I2_lambda_w2 > 0.0 else u2_max if inv_I2_lambda_w2 < 0.0 else 0.5*(u2_min + u2_max)
    inv_I3 = 1.0/I3
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    u3 = u3_min if inv_I3_lambda_w3 > 0.0 else u3_max if inv_I3_lambda_w3 < 0.0 else 0.5*(u3_min + u3_max)
    return (
        u1,
        u2,
        u3,
    )


def extremal_jacobian(t, x, u, lam, p):
    """Rates of states and costates by states and costates, row by row, the controls being held."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    w = -half_w2
    half_w1 = 0.5*w1
    half_q4 = 0.5*q4
    half_q3 = 0.5*q3
    w_2 = -half_q3
    half_q2 = 0.5*q2
    w_3 = -half_w3
    half_q1 = 0.5*q1
    w_4 = -half_q1
    w_5 = -half_w1
    w_6 = -half_q2
    inv_I1 = 1.0/I1
    w_7 = -I3
    w_8 = inv_I1*(-I2 - w_7)
    w3_w_8 = w3*w_8
    w2_w_8 = w2*w_8
    inv_I2 = 1.0/I2
    w_9 = inv_I2*(I1 + w_7)
    w3_w_9 = w3*w_9
    w1_w_9 = w1*w_9
    inv_I3 = 1.0/I3
    w_10 = inv_I3*(I2 - I1)
    w2_w_10 = w2*w_10
    w1_w_10 = w1*w_10
    half_lambda_q4 = 0.5*lambda_q4
    half_lambda_q3 = 0.5*lambda_q3
    w_11 = -half_lambda_q3
    half_lambda_q2 = 0.5*lambda_q2
    half_lambda_q1 = 0.5*lambda_q1
    w_12 = -half_lambda_q1
    w_13 = -half_lambda_q2
    lambda_w3_w_10 = lambda_w3*w_10
    lambda_w2_w_9 = lambda_w2*w_9
    w_14 = -half_q4
    lambda_w1_w_8 = lambda_w1*w_8
    return (
        0.0,
        half_w3,
        w,
        half_w1,
        half_q4,
        w_2,
        half_q2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        0.0,
        half_w1,
        half_w2,
        half_q3,
        half_q4,
        w_4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        half_w2,
        w_5,
        0.0,
        half_w3,
        w_6,
        half_q1,
        half_q4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_5,
        w,
        w_3,
        0.0,
        w_4,
        w_6,
        w_2,
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
        -w3_w_8,
        -w2_w_8,
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
        -w3_w_9,
        0.0,
        -w1_w_9,
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
        -w2_w_10,
        -w1_w_10,
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
        half_lambda_q4,
        w_11,
        half_lambda_q2,
        0.0,
        half_w3,
        w,
        half_w1,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        half_lambda_q3,
        half_lambda_q4,
        w_12,
        w_3,
        0.0,
        half_w1,
        half_w2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_13,
        half_lambda_q1,
        half_lambda_q4,
        half_w2,
        w_5,
        0.0,
        half_w3,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_12,
        w_13,
        w_11,
        w_5,
        w,
        w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        half_lambda_q4,
        half_lambda_q3,
        w_13,
        w_12,
        0.0,
        lambda_w3_w_10,
        lambda_w2_w_9,
        w_14,
        w_2,
        half_q2,
        half_q1,
        0.0,
        w3_w_9,
        w2_w_10,
        w_11,
        half_lambda_q4,
        half_lambda_q1,
        w_13,
        lambda_w3_w_10,
        0.0,
        lambda_w1_w_8,
        half_q3,
        w_14,
        w_4,
        half_q2,
        w3_w_8,
        0.0,
        w1_w_10,
        half_lambda_q2,
        w_12,
        half_lambda_q4,
        w_11,
        lambda_w2_w_9,
        lambda_w1_w_8,
        0.0,
        w_6,
        half_q1,
        w_14,
        half_q3,
        w2_w_8,
        w1_w_9,
        0.0,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    half_lambda_q1 = 0.5*lambda_q1
    half_lambda_q2 = 0.5*lambda_q2
    half_q2 = 0.5*q2
    half_q1 = 0.5*q1
    inv_I2 = 1.0/I2
    w = -I3
    w_2 = inv_I2*lambda_w2*(I1 + w)
    inv_I3 = 1.0/I3
    w_3 = inv_I3*lambda_w3*(I2 - I1)
    inv_I1 = 1.0/I1
    w_4 = inv_I1*lambda_w1*(-I2 - w)
    return (
        half_w1*lambda_q4 + half_w3*lambda_q2 - half_w2*lambda_q3,
        half_w1*lambda_q3 + half_w2*lambda_q4 - half_w3*lambda_q1,
        half_w2*lambda_q1 + half_w3*lambda_q4 - half_w1*lambda_q2,
        -half_w1*lambda_q1 - half_w2*lambda_q2 - half_w3*lambda_q3,
        half_q1*lambda_q4 + half_q2*lambda_q3 + w2*w_3 + w3*w_2 - half_lambda_q1*q4 - half_lambda_q2*q3,
        half_lambda_q1*q3 + half_q2*lambda_q4 + w1*w_3 + w3*w_4 - half_lambda_q2*q4 - half_q1*lambda_q3,
        half_q1*lambda_q2 + 0.5*lambda_q4*q3 + w1*w_2 + w2*w_4 - half_q2*lambda_q1 - 0.5*lambda_q3*q4,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law of the regularised problem."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    inv_I1 = 1.0/I1
    inv_smoothing = 1.0/smoothing
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    w = -inv_I1_lambda_w1*inv_smoothing
    w_2 = u1_min if w < u1_min else u1_max if w > u1_max else w
    w_3 = -I3
    w_4 = -I2 - w_3
    w3_w_4 = w3*w_4
    inv_I2 = 1.0/I2
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    w_5 = -inv_I2_lambda_w2*inv_smoothing
    w_6 = u2_min if w_5 < u2_min else u2_max if w_5 > u2_max else w_5
    w_7 = I1 + w_3
    w3_w_7 = w3*w_7
    inv_I3 = 1.0/I3
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    w_8 = -inv_I3_lambda_w3*inv_smoothing
    w_9 = u3_min if w_8 < u3_min else u3_max if w_8 > u3_max else w_8
    w_10 = I2 - I1
    w2_w_10 = w2*w_10
    half_lambda_q1 = 0.5*lambda_q1
    half_lambda_q2 = 0.5*lambda_q2
    half_q2 = 0.5*q2
    half_q1 = 0.5*q1
    return (
        half_w1*q4 + half_w3*q2 - half_w2*q3,
        half_w1*q3 + half_w2*q4 - half_w3*q1,
        half_w2*q1 + half_w3*q4 - half_w1*q2,
        -half_w1*q1 - half_w2*q2 - half_w3*q3,
        inv_I1*(w_2 - w2*w3_w_4),
        inv_I2*(w_6 - w1*w3_w_7),
        inv_I3*(w_9 - w1*w2_w_10),
        half_w1*lambda_q4 + half_w3*lambda_q2 - half_w2*lambda_q3,
        half_w1*lambda_q3 + half_w2*lambda_q4 - half_w3*lambda_q1,
        half_w2*lambda_q1 + half_w3*lambda_q4 - half_w1*lambda_q2,
        -half_w1*lambda_q1 - half_w2*lambda_q2 - half_w3*lambda_q3,
        half_q1*lambda_q4 + half_q2*lambda_q3 + inv_I2_lambda_w2*w3_w_7 + inv_I3_lambda_w3*w2_w_10 - half_lambda_q1*q4 - half_lambda_q2*q3,
        half_lambda_q1*q3 + half_q2*lambda_q4 + inv_I1_lambda_w1*w3_w_4 + inv_I3_lambda_w3*w1*w_10 - half_lambda_q2*q4 - half_q1*lambda_q3,
        half_q1*lambda_q2 + inv_I1_lambda_w1*w2*w_4 + inv_I2_lambda_w2*w1*w_7 + 0.5*lambda_q4*q3 - half_q2*lambda_q1 - 0.5*lambda_q3*q4,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    w = -half_w2
    half_w1 = 0.5*w1
    half_q4 = 0.5*q4
    half_q3 = 0.5*q3
    w_2 = -half_q3
    half_q2 = 0.5*q2
    w_3 = -half_w3
    half_q1 = 0.5*q1
    w_4 = -half_q1
    w_5 = -half_w1
    w_6 = -half_q2
    inv_I1 = 1.0/I1
    w_7 = -I3
    w_8 = -I2 - w_7
    inv_I1_w_8 = inv_I1*w_8
    inv_I1_w_8_w3 = inv_I1_w_8*w3
    inv_I1_w_8_w2 = inv_I1_w_8*w2
    inv_smoothing = 1.0/smoothing
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    w_9 = -inv_I1_lambda_w1*inv_smoothing
    w_10 = 0.0 if w_9 < u1_min else 0.0 if w_9 > u1_max else 1.0
    inv_I2 = 1.0/I2
    w_11 = I1 + w_7
    inv_I2_w_11 = inv_I2*w_11
    inv_I2_w_11_w3 = inv_I2_w_11*w3
    inv_I2_w_11_w1 = inv_I2_w_11*w1
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    w_12 = -inv_I2_lambda_w2*inv_smoothing
    w_13 = 0.0 if w_12 < u2_min else 0.0 if w_12 > u2_max else 1.0
    inv_I3 = 1.0/I3
    w_14 = I2 - I1
    inv_I3_w_14 = inv_I3*w_14
    inv_I3_w_14_w2 = inv_I3_w_14*w2
    inv_I3_w_14_w1 = inv_I3_w_14*w1
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    w_15 = -inv_I3_lambda_w3*inv_smoothing
    w_16 = 0.0 if w_15 < u3_min else 0.0 if w_15 > u3_max else 1.0
    half_lambda_q4 = 0.5*lambda_q4
    half_lambda_q3 = 0.5*lambda_q3
    w_17 = -half_lambda_q3
    half_lambda_q2 = 0.5*lambda_q2
    half_lambda_q1 = 0.5*lambda_q1
    w_18 = -half_lambda_q1
    w_19 = -half_lambda_q2
    inv_I3_lambda_w3_w_14 = inv_I3_lambda_w3*w_14
    inv_I2_lambda_w2_w_11 = inv_I2_lambda_w2*w_11
    w_20 = -half_q4
    inv_I1_lambda_w1_w_8 = inv_I1_lambda_w1*w_8
    return (
        0.0,
        half_w3,
        w,
        half_w1,
        half_q4,
        w_2,
        half_q2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        0.0,
        half_w1,
        half_w2,
        half_q3,
        half_q4,
        w_4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        half_w2,
        w_5,
        0.0,
        half_w3,
        w_6,
        half_q1,
        half_q4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_5,
        w,
        w_3,
        0.0,
        w_4,
        w_6,
        w_2,
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
        -inv_I1_w_8_w3,
        -inv_I1_w_8_w2,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_I1*inv_I1*inv_smoothing*w_10,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_I2_w_11_w3,
        0.0,
        -inv_I2_w_11_w1,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_I2*inv_I2*inv_smoothing*w_13,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_I3_w_14_w2,
        -inv_I3_w_14_w1,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_I3*inv_I3*inv_smoothing*w_16,
        0.0,
        0.0,
        0.0,
        0.0,
        half_lambda_q4,
        w_17,
        half_lambda_q2,
        0.0,
        half_w3,
        w,
        half_w1,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        half_lambda_q3,
        half_lambda_q4,
        w_18,
        w_3,
        0.0,
        half_w1,
        half_w2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_19,
        half_lambda_q1,
        half_lambda_q4,
        half_w2,
        w_5,
        0.0,
        half_w3,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_18,
        w_19,
        w_17,
        w_5,
        w,
        w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        half_lambda_q4,
        half_lambda_q3,
        w_19,
        w_18,
        0.0,
        inv_I3_lambda_w3_w_14,
        inv_I2_lambda_w2_w_11,
        w_20,
        w_2,
        half_q2,
        half_q1,
        0.0,
        inv_I2_w_11_w3,
        inv_I3_w_14_w2,
        w_17,
        half_lambda_q4,
        half_lambda_q1,
        w_19,
        inv_I3_lambda_w3_w_14,
        0.0,
        inv_I1_lambda_w1_w_8,
        half_q3,
        w_20,
        w_4,
        half_q2,
        inv_I1_w_8_w3,
        0.0,
        inv_I3_w_14_w1,
        half_lambda_q2,
        w_18,
        half_lambda_q4,
        w_17,
        inv_I2_lambda_w2_w_11,
        inv_I1_lambda_w1_w_8,
        0.0,
        w_6,
        half_q1,
        w_20,
        half_q3,
        inv_I1_w_8_w2,
        inv_I2_w_11_w1,
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    return (
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
        0.0,
        0.0,
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    given_q1, given_q2, given_q3, given_q4, given_w1, given_w2, given_w3, on_reference_q1, on_reference_q2, on_reference_q3, on_reference_q4, on_reference_w1, on_reference_w2, on_reference_w3, target_q1, target_q2, target_q3, target_q4, target_w1, target_w2, target_w3 = final
    inv_smoothing = 1.0/smoothing
    inv_I1 = 1.0/I1
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    w = -inv_I1_lambda_w1*inv_smoothing
    w_2 = u1_min if w < u1_min else u1_max if w > u1_max else w
    inv_I2 = 1.0/I2
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    w_3 = -inv_I2_lambda_w2*inv_smoothing
    w_4 = u2_min if w_3 < u2_min else u2_max if w_3 > u2_max else w_3
    inv_I3 = 1.0/I3
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    w_5 = -inv_I3_lambda_w3*inv_smoothing
    w_6 = u3_min if w_5 < u3_min else u3_max if w_5 > u3_max else w_5
    w_7 = -I3
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    return (
        given_q1*(q1 - target_q1) + lambda_q1*(1.0 - given_q1 - on_reference_q1) + on_reference_q1*q1,
        given_q2*(q2 - target_q2) + lambda_q2*(1.0 - given_q2 - on_reference_q2) + on_reference_q2*q2,
        given_q3*(q3 - target_q3) + lambda_q3*(1.0 - given_q3 - on_reference_q3) + on_reference_q3*q3,
        given_q4*(q4 - target_q4) + lambda_q4*(1.0 - given_q4 - on_reference_q4) + on_reference_q4*q4,
        given_w1*(w1 - target_w1) + lambda_w1*(1.0 - given_w1 - on_reference_w1) + on_reference_w1*w1,
        given_w2*(w2 - target_w2) + lambda_w2*(1.0 - given_w2 - on_reference_w2) + on_reference_w2*w2,
        given_w3*(w3 - target_w3) + lambda_w3*(1.0 - given_w3 - on_reference_w3) + on_reference_w3*w3,
        inv_I1_lambda_w1*(w_2 - w2*w3*(-I2 - w_7)) + inv_I2_lambda_w2*(w_4 - w1*w3*(I1 + w_7)) + inv_I3_lambda_w3*(w_6 - w1*w2*(I2 - I1)) + lambda_q1*(half_w1*q4 + half_w3*q2 - half_w2*q3) + lambda_q2*(half_w1*q3 + half_w2*q4 - half_w3*q1) + lambda_q3*(half_w2*q1 + half_w3*q4 - half_w1*q2) + lambda_q4*(-half_w1*q1 - half_w2*q2 - half_w3*q3) + 0.5*smoothing*(w_2*w_2 + w_4*w_4 + w_6*w_6) + 1.0,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    given_q1, given_q2, given_q3, given_q4, given_w1, given_w2, given_w3, on_reference_q1, on_reference_q2, on_reference_q3, on_reference_q4, on_reference_w1, on_reference_w2, on_reference_w3, target_q1, target_q2, target_q3, target_q4, target_w1, target_w2, target_w3 = final
    w = given_q1 + on_reference_q1
    w_2 = given_q2 + on_reference_q2
    w_3 = given_q3 + on_reference_q3
    w_4 = given_q4 + on_reference_q4
    w_5 = given_w1 + on_reference_w1
    w_6 = given_w2 + on_reference_w2
    w_7 = given_w3 + on_reference_w3
    half_w3 = 0.5*w3
    half_lambda_q4 = 0.5*lambda_q4
    half_lambda_q3 = 0.5*lambda_q3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    inv_I2 = 1.0/I2
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    w_8 = -I3
    w_9 = I1 + w_8
    w3_w_9 = w3*w_9
    w_10 = I2 - I1
    w2_w_10 = w2*w_10
    inv_I3 = 1.0/I3
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    inv_I1 = 1.0/I1
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    w_11 = -I2 - w_8
    w3_w_11 = w3*w_11
    inv_smoothing = 1.0/smoothing
    w_12 = -inv_I1_lambda_w1*inv_smoothing
    w_13 = u1_min if w_12 < u1_min else u1_max if w_12 > u1_max else w_12
    w_14 = 0.0 if w_12 < u1_min else 0.0 if w_12 > u1_max else 1.0
    w_15 = -inv_I2_lambda_w2*inv_smoothing
    w_16 = u2_min if w_15 < u2_min else u2_max if w_15 > u2_max else w_15
    w_17 = 0.0 if w_15 < u2_min else 0.0 if w_15 > u2_max else 1.0
    w_18 = -inv_I3_lambda_w3*inv_smoothing
    w_19 = u3_min if w_18 < u3_min else u3_max if w_18 > u3_max else w_18
    w_20 = 0.0 if w_18 < u3_min else 0.0 if w_18 > u3_max else 1.0
    return (
        w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_5,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_5,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_6,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_6,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_7,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_7,
        0.0,
        0.5*lambda_q3*w2 - half_lambda_q4*w1 - half_w3*lambda_q2,
        0.5*lambda_q1*w3 - half_lambda_q3*w1 - half_lambda_q4*w2,
        0.5*lambda_q2*w1 - half_w2*lambda_q1 - half_w3*lambda_q4,
        half_lambda_q3*w3 + half_w1*lambda_q1 + half_w2*lambda_q2,
        0.5*lambda_q1*q4 + 0.5*lambda_q2*q3 - half_lambda_q3*q2 - half_lambda_q4*q1 - inv_I2_lambda_w2*w3_w_9 - inv_I3_lambda_w3*w2_w_10,
        0.5*lambda_q2*q4 + 0.5*lambda_q3*q1 - half_lambda_q4*q2 - inv_I1_lambda_w1*w3_w_11 - inv_I3_lambda_w3*w1*w_10 - 0.5*lambda_q1*q3,
        0.5*lambda_q1*q2 + 0.5*lambda_q3*q4 - half_lambda_q4*q3 - inv_I1_lambda_w1*w2*w_11 - inv_I2_lambda_w2*w1*w_9 - 0.5*lambda_q2*q1,
        half_w1*q4 + half_w3*q2 - half_w2*q3,
        half_w1*q3 + half_w2*q4 - half_w3*q1,
        half_w2*q1 + half_w3*q4 - half_w1*q2,
        -half_w1*q1 - half_w2*q2 - half_w3*q3,
        inv_I1*(w_13 - w2*w3_w_11) - inv_I1*inv_I1*inv_smoothing*lambda_w1*w_14 - inv_I1*w_13*w_14,
        inv_I2*(w_16 - w1*w3_w_9) - inv_I2*inv_I2*inv_smoothing*lambda_w2*w_17 - inv_I2*w_16*w_17,
        inv_I3*(w_19 - w1*w2_w_10) - inv_I3*inv_I3*inv_smoothing*lambda_w3*w_20 - inv_I3*w_19*w_20,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    I1, I2, I3 = p
    q1_at, q2_at, q3_at, q4_at, w1_at, w2_at, w3_at = x
    q1_mid, q2_mid, q3_mid, q4_mid, w1_mid, w2_mid, w3_mid = x_mid
    u1_at, u2_at, u3_at = u
    u1_mid, u2_mid, u3_mid = u_mid
    q1, q2, q3, q4, w1, w2, w3 = x0
    inv_I1 = 1.0/I1
    w = -I3
    w_2 = I2 + w
    inv_I2 = 1.0/I2
    w_3 = -I1 - w
    inv_I3 = 1.0/I3
    w_4 = I1 - I2
    steps = len(times) - 1
    t = times[0]
    q1_at[0] = q1
    q2_at[0] = q2
    q3_at[0] = q3
    q4_at[0] = q4
    w1_at[0] = w1
    w2_at[0] = w2
    w3_at[0] = w3
    u1 = u1_at[0]
    u2 = u2_at[0]
    u3 = u3_at[0]
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    slope_q1 = half_w1*q4 + half_w3*q2 - half_w2*q3
    slope_q2 = half_w1*q3 + half_w2*q4 - half_w3*q1
    slope_q3 = half_w2*q1 + half_w3*q4 - half_w1*q2
    slope_q4 = -half_w1*q1 - half_w2*q2 - half_w3*q3
    slope_w1 = inv_I1*(u1 + w2*w3*w_2)
    slope_w2 = inv_I2*(u2 + w1*w3*w_3)
    slope_w3 = inv_I3*(u3 + w1*w2*w_4)
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        q1_at[i] = q1
        q2_at[i] = q2
        q3_at[i] = q3
        q4_at[i] = q4
        w1_at[i] = w1
        w2_at[i] = w2
        w3_at[i] = w3
        u1_half = u1_mid[i]
        u1_end = u1_at[i + 1]
        u2_half = u2_mid[i]
        u2_end = u2_at[i + 1]
        u3_half = u3_mid[i]
        u3_end = u3_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        q1_2 = half*slope_q1 + q1
        q2_2 = half*slope_q2 + q2
        q3_2 = half*slope_q3 + q3
        q4_2 = half*slope_q4 + q4
        w1_2 = half*slope_w1 + w1
        w2_2 = half*slope_w2 + w2
        w3_2 = half*slope_w3 + w3
        half_w3_2 = 0.5*w3_2
        half_w2_2 = 0.5*w2_2
        half_w1_2 = 0.5*w1_2
        k2_q1 = half_w1_2*q4_2 + half_w3_2*q2_2 - half_w2_2*q3_2
        k2_q2 = half_w1_2*q3_2 + half_w2_2*q4_2 - half_w3_2*q1_2
        k2_q3 = half_w2_2*q1_2 + half_w3_2*q4_2 - half_w1_2*q2_2
        k2_q4 = -half_w1_2*q1_2 - half_w2_2*q2_2 - half_w3_2*q3_2
        k2_w1 = inv_I1*(u1_half + w2_2*w3_2*w_2)
        k2_w2 = inv_I2*(u2_half + w1_2*w3_2*w_3)
        k2_w3 = inv_I3*(u3_half + w1_2*w2_2*w_4)
        q1_3 = half*k2_q1 + q1
        q2_3 = half*k2_q2 + q2
        q3_3 = half*k2_q3 + q3
        q4_3 = half*k2_q4 + q4
        w1_3 = half*k2_w1 + w1
        w2_3 = half*k2_w2 + w2
        w3_3 = half*k2_w3 + w3
        half_w3_3 = 0.5*w3_3
        half_w2_3 = 0.5*w2_3
        half_w1_3 = 0.5*w1_3
        k3_q1 = half_w1_3*q4_3 + half_w3_3*q2_3 - half_w2_3*q3_3
        k3_q2 = half_w1_3*q3_3 + half_w2_3*q4_3 - half_w3_3*q1_3
        k3_q3 = half_w2_3*q1_3 + half_w3_3*q4_3 - half_w1_3*q2_3
        k3_q4 = -half_w1_3*q1_3 - half_w2_3*q2_3 - half_w3_3*q3_3
        k3_w1 = inv_I1*(u1_half + w2_3*w3_3*w_2)
        k3_w2 = inv_I2*(u2_half + w1_3*w3_3*w_3)
        k3_w3 = inv_I3*(u3_half + w1_3*w2_3*w_4)
        q1_4 = h*k3_q1 + q1
        q2_4 = h*k3_q2 + q2
        q3_4 = h*k3_q3 + q3
        q4_4 = h*k3_q4 + q4
        w1_4 = h*k3_w1 + w1
        w2_4 = h*k3_w2 + w2
        w3_4 = h*k3_w3 + w3
        half_w3_4 = 0.5*w3_4
        half_w2_4 = 0.5*w2_4
        half_w1_4 = 0.5*w1_4
        k4_q1 = half_w1_4*q4_4 + half_w3_4*q2_4 - half_w2_4*q3_4
        k4_q2 = half_w1_4*q3_4 + half_w2_4*q4_4 - half_w3_4*q1_4
        k4_q3 = half_w2_4*q1_4 + half_w3_4*q4_4 - half_w1_4*q2_4
        k4_q4 = -half_w1_4*q1_4 - half_w2_4*q2_4 - half_w3_4*q3_4
        k4_w1 = inv_I1*(u1_end + w2_4*w3_4*w_2)
        k4_w2 = inv_I2*(u2_end + w1_4*w3_4*w_3)
        k4_w3 = inv_I3*(u3_end + w1_4*w2_4*w_4)
        q1_end = q1 + sixth*(k4_q1 + slope_q1 + 2.0*(k2_q1 + k3_q1))
        q2_end = q2 + sixth*(k4_q2 + slope_q2 + 2.0*(k2_q2 + k3_q2))
        q3_end = q3 + sixth*(k4_q3 + slope_q3 + 2.0*(k2_q3 + k3_q3))
        q4_end = q4 + sixth*(k4_q4 + slope_q4 + 2.0*(k2_q4 + k3_q4))
        w1_end = sixth*(k4_w1 + slope_w1 + 2.0*(k2_w1 + k3_w1)) + w1
        w2_end = sixth*(k4_w2 + slope_w2 + 2.0*(k2_w2 + k3_w2)) + w2
        w3_end = sixth*(k4_w3 + slope_w3 + 2.0*(k2_w3 + k3_w3)) + w3
        half_w3_end = 0.5*w3_end
        half_w2_end = 0.5*w2_end
        half_w1_end = 0.5*w1_end
        slope_end_q1 = half_w1_end*q4_end + half_w3_end*q2_end - half_w2_end*q3_end
        slope_end_q2 = half_w1_end*q3_end + half_w2_end*q4_end - half_w3_end*q1_end
        slope_end_q3 = half_w2_end*q1_end + half_w3_end*q4_end - half_w1_end*q2_end
        slope_end_q4 = -half_w1_end*q1_end - half_w2_end*q2_end - half_w3_end*q3_end
        slope_end_w1 = inv_I1*(u1_end + w2_end*w3_end*w_2)
        slope_end_w2 = inv_I2*(u2_end + w1_end*w3_end*w_3)
        slope_end_w3 = inv_I3*(u3_end + w1_end*w2_end*w_4)
        eighth = 0.125*h
        q1_mid[i] = eighth*(slope_q1 - slope_end_q1) + 0.5*(q1 + q1_end)
        q2_mid[i] = eighth*(slope_q2 - slope_end_q2) + 0.5*(q2 + q2_end)
        q3_mid[i] = eighth*(slope_q3 - slope_end_q3) + 0.5*(q3 + q3_end)
        q4_mid[i] = eighth*(slope_q4 - slope_end_q4) + 0.5*(q4 + q4_end)
        w1_mid[i] = eighth*(slope_w1 - slope_end_w1) + 0.5*(w1 + w1_end)
        w2_mid[i] = eighth*(slope_w2 - slope_end_w2) + 0.5*(w2 + w2_end)
        w3_mid[i] = eighth*(slope_w3 - slope_end_w3) + 0.5*(w3 + w3_end)
        total = 6.0*sixth + total
        t = t_end
        q1 = q1_end
        q2 = q2_end
        q3 = q3_end
        q4 = q4_end
        w1 = w1_end
        w2 = w2_end
        w3 = w3_end
        slope_q1 = slope_end_q1
        slope_q2 = slope_end_q2
        slope_q3 = slope_end_q3
        slope_q4 = slope_end_q4
        slope_w1 = slope_end_w1
        slope_w2 = slope_end_w2
        slope_w3 = slope_end_w3
    q1_at[steps] = q1
    q2_at[steps] = q2
    q3_at[steps] = q3
    q4_at[steps] = q4
    w1_at[steps] = w1
    w2_at[steps] = w2
    w3_at[steps] = w3
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    I1, I2, I3 = p
    lambda_q1_at, lambda_q2_at, lambda_q3_at, lambda_q4_at, lambda_w1_at, lambda_w2_at, lambda_w3_at = lam
    lambda_q1_mid, lambda_q2_mid, lambda_q3_mid, lambda_q4_mid, lambda_w1_mid, lambda_w2_mid, lambda_w3_mid = lam_mid
    q1_at, q2_at, q3_at, q4_at, w1_at, w2_at, w3_at = x
    u1_at, u2_at, u3_at = u
    q1_mid, q2_mid, q3_mid, q4_mid, w1_mid, w2_mid, w3_mid = x_mid
    u1_mid, u2_mid, u3_mid = u_mid
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam_f
    inv_I2 = 1.0/I2
    w = -I3
    w_2 = inv_I2*(I1 + w)
    inv_I3 = 1.0/I3
    w_3 = inv_I3*(I2 - I1)
    inv_I1 = 1.0/I1
    w_4 = inv_I1*(-I2 - w)
    steps = len(times) - 1
    t = times[steps]
    lambda_q1_at[steps] = lambda_q1
    lambda_q2_at[steps] = lambda_q2
    lambda_q3_at[steps] = lambda_q3
    lambda_q4_at[steps] = lambda_q4
    lambda_w1_at[steps] = lambda_w1
    lambda_w2_at[steps] = lambda_w2
    lambda_w3_at[steps] = lambda_w3
    q1 = q1_at[steps]
    q2 = q2_at[steps]
    q3 = q3_at[steps]
    q4 = q4_at[steps]
    w1 = w1_at[steps]
    w2 = w2_at[steps]
    w3 = w3_at[steps]
    half_w3 = 0.5*w3
    half_w1 = 0.5*w1
    half_w2 = 0.5*w2
    half_q2 = 0.5*q2
    half_q1 = 0.5*q1
    half_q4 = 0.5*q4
    half_q3 = 0.5*q3
    w3_w_2 = w3*w_2
    w2_w_3 = w2*w_3
    w3_w_4 = w3*w_4
    w1_w_3 = w1*w_3
    w1_w_2 = w1*w_2
    w2_w_4 = w2*w_4
    slope_lambda_q1 = half_w1*lambda_q4 + half_w3*lambda_q2 - half_w2*lambda_q3
    slope_lambda_q2 = half_w1*lambda_q3 + half_w2*lambda_q4 - half_w3*lambda_q1
    slope_lambda_q3 = half_w2*lambda_q1 + half_w3*lambda_q4 - half_w1*lambda_q2
    slope_lambda_q4 = -half_w1*lambda_q1 - half_w2*lambda_q2 - half_w3*lambda_q3
    slope_lambda_w1 = half_q1*lambda_q4 + half_q2*lambda_q3 + lambda_w2*w3_w_2 + lambda_w3*w2_w_3 - half_q3*lambda_q2 - half_q4*lambda_q1
    slope_lambda_w2 = half_q2*lambda_q4 + half_q3*lambda_q1 + lambda_w1*w3_w_4 + lambda_w3*w1_w_3 - half_q1*lambda_q3 - half_q4*lambda_q2
    slope_lambda_w3 = half_q1*lambda_q2 + half_q3*lambda_q4 + lambda_w1*w2_w_4 + lambda_w2*w1_w_2 - half_q2*lambda_q1 - half_q4*lambda_q3
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        q1_half = q1_mid[i]
        q1_end = q1_at[i]
        q2_half = q2_mid[i]
        q2_end = q2_at[i]
        q3_half = q3_mid[i]
        q3_end = q3_at[i]
        q4_half = q4_mid[i]
        q4_end = q4_at[i]
        w1_half = w1_mid[i]
        w1_end = w1_at[i]
        w2_half = w2_mid[i]
        w2_end = w2_at[i]
        w3_half = w3_mid[i]
        w3_end = w3_at[i]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_q1_2 = half*slope_lambda_q1 + lambda_q1
        lambda_q2_2 = half*slope_lambda_q2 + lambda_q2
        lambda_q3_2 = half*slope_lambda_q3 + lambda_q3
        lambda_q4_2 = half*slope_lambda_q4 + lambda_q4
        lambda_w1_2 = half*slope_lambda_w1 + lambda_w1
        lambda_w2_2 = half*slope_lambda_w2 + lambda_w2
        lambda_w3_2 = half*slope_lambda_w3 + lambda_w3
        half_w3_half = 0.5*w3_half
        half_w1_half = 0.5*w1_half
        half_w2_half = 0.5*w2_half
        half_q2_half = 0.5*q2_half
        half_q1_half = 0.5*q1_half
        half_q4_half = 0.5*q4_half
        half_q3_half = 0.5*q3_half
        w3_half_w_2 = w3_half*w_2
        w2_half_w_3 = w2_half*w_3
        w3_half_w_4 = w3_half*w_4
        w1_half_w_3 = w1_half*w_3
        w1_half_w_2 = w1_half*w_2
        w2_half_w_4 = w2_half*w_4
        k2_lambda_q1 = half_w1_half*lambda_q4_2 + half_w3_half*lambda_q2_2 - half_w2_half*lambda_q3_2
        k2_lambda_q2 = half_w1_half*lambda_q3_2 + half_w2_half*lambda_q4_2 - half_w3_half*lambda_q1_2
        k2_lambda_q3 = half_w2_half*lambda_q1_2 + half_w3_half*lambda_q4_2 - half_w1_half*lambda_q2_2
        k2_lambda_q4 = -half_w1_half*lambda_q1_2 - half_w2_half*lambda_q2_2 - half_w3_half*lambda_q3_2
        k2_lambda_w1 = half_q1_half*lambda_q4_2 + half_q2_half*lambda_q3_2 + lambda_w2_2*w3_half_w_2 + lambda_w3_2*w2_half_w_3 - half_q3_half*lambda_q2_2 - half_q4_half*lambda_q1_2
        k2_lambda_w2 = half_q2_half*lambda_q4_2 + half_q3_half*lambda_q1_2 + lambda_w1_2*w3_half_w_4 + lambda_w3_2*w1_half_w_3 - half_q1_half*lambda_q3_2 - half_q4_half*lambda_q2_2
        k2_lambda_w3 = half_q1_half*lambda_q2_2 + half_q3_half*lambda_q4_2 + lambda_w1_2*w2_half_w_4 + lambda_w2_2*w1_half_w_2 - half_q2_half*lambda_q1_2 - half_q4_half*lambda_q3_2
        lambda_q1_3 = half*k2_lambda_q1 + lambda_q1
        lambda_q2_3 = half*k2_lambda_q2 + lambda_q2
        lambda_q3_3 = half*k2_lambda_q3 + lambda_q3
        lambda_q4_3 = half*k2_lambda_q4 + lambda_q4
        lambda_w1_3 = half*k2_lambda_w1 + lambda_w1
        lambda_w2_3 = half*k2_lambda_w2 + lambda_w2
        lambda_w3_3 = half*k2_lambda_w3 + lambda_w3
        k3_lambda_q1 = half_w1_half*lambda_q4_3 + half_w3_half*lambda_q2_3 - half_w2_half*lambda_q3_3
        k3_lambda_q2 = half_w1_half*lambda_q3_3 + half_w2_half*lambda_q4_3 - half_w3_half*lambda_q1_3
        k3_lambda_q3 = half_w2_half*lambda_q1_3 + half_w3_half*lambda_q4_3 - half_w1_half*lambda_q2_3
        k3_lambda_q4 = -half_w1_half*lambda_q1_3 - half_w2_half*lambda_q2_3 - half_w3_half*lambda_q3_3
        k3_lambda_w1 = half_q1_half*lambda_q4_3 + half_q2_half*lambda_q3_3 + lambda_w2_3*w3_half_w_2 + lambda_w3_3*w2_half_w_3 - half_q3_half*lambda_q2_3 - half_q4_half*lambda_q1_3
        k3_lambda_w2 = half_q2_half*lambda_q4_3 + half_q3_half*lambda_q1_3 + lambda_w1_3*w3_half_w_4 + lambda_w3_3*w1_half_w_3 - half_q1_half*lambda_q3_3 - half_q4_half*lambda_q2_3
        k3_lambda_w3 = half_q1_half*lambda_q2_3 + half_q3_half*lambda_q4_3 + lambda_w1_3*w2_half_w_4 + lambda_w2_3*w1_half_w_2 - half_q2_half*lambda_q1_3 - half_q4_half*lambda_q3_3
        lambda_q1_4 = h*k3_lambda_q1 + lambda_q1
        lambda_q2_4 = h*k3_lambda_q2 + lambda_q2
        lambda_q3_4 = h*k3_lambda_q3 + lambda_q3
        lambda_q4_4 = h*k3_lambda_q4 + lambda_q4
        lambda_w1_4 = h*k3_lambda_w1 + lambda_w1
        lambda_w2_4 = h*k3_lambda_w2 + lambda_w2
        lambda_w3_4 = h*k3_lambda_w3 + lambda_w3
        half_w3_end = 0.5*w3_end
        half_w1_end = 0.5*w1_end
        half_w2_end = 0.5*w2_end
        half_q2_end = 0.5*q2_end
        half_q1_end = 0.5*q1_end
        half_q4_end = 0.5*q4_end
        half_q3_end = 0.5*q3_end
        w3_end_w_2 = w3_end*w_2
        w2_end_w_3 = w2_end*w_3
        w3_end_w_4 = w3_end*w_4
        w1_end_w_3 = w1_end*w_3
        w1_end_w_2 = w1_end*w_2
        w2_end_w_4 = w2_end*w_4
        k4_lambda_q1 = half_w1_end*lambda_q4_4 + half_w3_end*lambda_q2_4 - half_w2_end*lambda_q3_4
        k4_lambda_q2 = half_w1_end*lambda_q3_4 + half_w2_end*lambda_q4_4 - half_w3_end*lambda_q1_4
        k4_lambda_q3 = half_w2_end*lambda_q1_4 + half_w3_end*lambda_q4_4 - half_w1_end*lambda_q2_4
        k4_lambda_q4 = -half_w1_end*lambda_q1_4 - half_w2_end*lambda_q2_4 - half_w3_end*lambda_q3_4
        k4_lambda_w1 = half_q1_end*lambda_q4_4 + half_q2_end*lambda_q3_4 + lambda_w2_4*w3_end_w_2 + lambda_w3_4*w2_end_w_3 - half_q3_end*lambda_q2_4 - half_q4_end*lambda_q1_4
        k4_lambda_w2 = half_q2_end*lambda_q4_4 + half_q3_end*lambda_q1_4 + lambda_w1_4*w3_end_w_4 + lambda_w3_4*w1_end_w_3 - half_q1_end*lambda_q3_4 - half_q4_end*lambda_q2_4
        k4_lambda_w3 = half_q1_end*lambda_q2_4 + half_q3_end*lambda_q4_4 + lambda_w1_4*w2_end_w_4 + lambda_w2_4*w1_end_w_2 - half_q2_end*lambda_q1_4 - half_q4_end*lambda_q3_4
        lambda_q1_end = lambda_q1 + sixth*(k4_lambda_q1 + slope_lambda_q1 + 2.0*(k2_lambda_q1 + k3_lambda_q1))
        lambda_q2_end = lambda_q2 + sixth*(k4_lambda_q2 + slope_lambda_q2 + 2.0*(k2_lambda_q2 + k3_lambda_q2))
        lambda_q3_end = lambda_q3 + sixth*(k4_lambda_q3 + slope_lambda_q3 + 2.0*(k2_lambda_q3 + k3_lambda_q3))
        lambda_q4_end = lambda_q4 + sixth*(k4_lambda_q4 + slope_lambda_q4 + 2.0*(k2_lambda_q4 + k3_lambda_q4))
        lambda_w1_end = lambda_w1 + sixth*(k4_lambda_w1 + slope_lambda_w1 + 2.0*(k2_lambda_w1 + k3_lambda_w1))
        lambda_w2_end = lambda_w2 + sixth*(k4_lambda_w2 + slope_lambda_w2 + 2.0*(k2_lambda_w2 + k3_lambda_w2))
        lambda_w3_end = lambda_w3 + sixth*(k4_lambda_w3 + slope_lambda_w3 + 2.0*(k2_lambda_w3 + k3_lambda_w3))
        slope_end_lambda_q1 = half_w1_end*lambda_q4_end + half_w3_end*lambda_q2_end - half_w2_end*lambda_q3_end
        slope_end_lambda_q2 = half_w1_end*lambda_q3_end + half_w2_end*lambda_q4_end - half_w3_end*lambda_q1_end
        slope_end_lambda_q3 = half_w2_end*lambda_q1_end + half_w3_end*lambda_q4_end - half_w1_end*lambda_q2_end
        slope_end_lambda_q4 = -half_w1_end*lambda_q1_end - half_w2_end*lambda_q2_end - half_w3_end*lambda_q3_end
        slope_end_lambda_w1 = half_q1_end*lambda_q4_end + half_q2_end*lambda_q3_end + lambda_w2_end*w3_end_w_2 + lambda_w3_end*w2_end_w_3 - half_q3_end*lambda_q2_end - half_q4_end*lambda_q1_end
        slope_end_lambda_w2 = half_q2_end*lambda_q4_end + half_q3_end*lambda_q1_end + lambda_w1_end*w3_end_w_4 + lambda_w3_end*w1_end_w_3 - half_q1_end*lambda_q3_end - half_q4_end*lambda_q2_end
        slope_end_lambda_w3 = half_q1_end*lambda_q2_end + half_q3_end*lambda_q4_end + lambda_w1_end*w2_end_w_4 + lambda_w2_end*w1_end_w_2 - half_q2_end*lambda_q1_end - half_q4_end*lambda_q3_end
        eighth = 0.125*h
        lambda_q1_mid[i] = eighth*(slope_lambda_q1 - slope_end_lambda_q1) + 0.5*(lambda_q1 + lambda_q1_end)
        lambda_q1_at[i] = lambda_q1_end
        lambda_q2_mid[i] = eighth*(slope_lambda_q2 - slope_end_lambda_q2) + 0.5*(lambda_q2 + lambda_q2_end)
        lambda_q2_at[i] = lambda_q2_end
        lambda_q3_mid[i] = eighth*(slope_lambda_q3 - slope_end_lambda_q3) + 0.5*(lambda_q3 + lambda_q3_end)
        lambda_q3_at[i] = lambda_q3_end
        lambda_q4_mid[i] = eighth*(slope_lambda_q4 - slope_end_lambda_q4) + 0.5*(lambda_q4 + lambda_q4_end)
        lambda_q4_at[i] = lambda_q4_end
        lambda_w1_mid[i] = eighth*(slope_lambda_w1 - slope_end_lambda_w1) + 0.5*(lambda_w1 + lambda_w1_end)
        lambda_w1_at[i] = lambda_w1_end
        lambda_w2_mid[i] = eighth*(slope_lambda_w2 - slope_end_lambda_w2) + 0.5*(lambda_w2 + lambda_w2_end)
        lambda_w2_at[i] = lambda_w2_end
        lambda_w3_mid[i] = eighth*(slope_lambda_w3 - slope_end_lambda_w3) + 0.5*(lambda_w3 + lambda_w3_end)
        lambda_w3_at[i] = lambda_w3_end
        t = t_end
        lambda_q1 = lambda_q1_end
        lambda_q2 = lambda_q2_end
        lambda_q3 = lambda_q3_end
        lambda_q4 = lambda_q4_end
        lambda_w1 = lambda_w1_end
        lambda_w2 = lambda_w2_end
        lambda_w3 = lambda_w3_end
        slope_lambda_q1 = slope_end_lambda_q1
        slope_lambda_q2 = slope_end_lambda_q2
        slope_lambda_q3 = slope_end_lambda_q3
        slope_lambda_q4 = slope_end_lambda_q4
        slope_lambda_w1 = slope_end_lambda_w1
        slope_lambda_w2 = slope_end_lambda_w2
        slope_lambda_w3 = slope_end_lambda_w3


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((7, *shape), np.result_type(float, t, x, u, *p))
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    inv_I1 = 1.0/I1
    w = -I3
    inv_I2 = 1.0/I2
    inv_I3 = 1.0/I3
    out[0] = half_w1*q4 + half_w3*q2 - half_w2*q3
    out[1] = half_w1*q3 + half_w2*q4 - half_w3*q1
    out[2] = half_w2*q1 + half_w3*q4 - half_w1*q2
    out[3] = -half_w1*q1 - half_w2*q2 - half_w3*q3
    out[4] = inv_I1*(u1 - w2*w3*(-I2 - w))
    out[5] = inv_I2*(u2 - w1*w3*(I1 + w))
    out[6] = inv_I3*(u3 - w1*w2*(I2 - I1))
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((7, 7, *shape), np.result_type(float, t, x, u, *p))
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    w = -half_w2
    half_w1 = 0.5*w1
    half_q4 = 0.5*q4
    half_q3 = 0.5*q3
    w_2 = -half_q3
    half_q2 = 0.5*q2
    w_3 = -half_w3
    half_q1 = 0.5*q1
    w_4 = -half_q1
    w_5 = -half_w1
    w_6 = -half_q2
    inv_I1 = 1.0/I1
    w_7 = -I3
    w_8 = inv_I1*(I2 + w_7)
    inv_I2 = 1.0/I2
    w_9 = inv_I2*(-I1 - w_7)
    inv_I3 = 1.0/I3
    w_10 = inv_I3*(I1 - I2)
    out[0, 0] = 0.0
    out[0, 1] = half_w3
    out[0, 2] = w
    out[0, 3] = half_w1
    out[0, 4] = half_q4
    out[0, 5] = w_2
    out[0, 6] = half_q2
    out[1, 0] = w_3
    out[1, 1] = 0.0
    out[1, 2] = half_w1
    out[1, 3] = half_w2
    out[1, 4] = half_q3
    out[1, 5] = half_q4
    out[1, 6] = w_4
    out[2, 0] = half_w2
    out[2, 1] = w_5
    out[2, 2] = 0.0
    out[2, 3] = half_w3
    out[2, 4] = w_6
    out[2, 5] = half_q1
    out[2, 6] = half_q4
    out[3, 0] = w_5
    out[3, 1] = w
    out[3, 2] = w_3
    out[3, 3] = 0.0
    out[3, 4] = w_4
    out[3, 5] = w_6
    out[3, 6] = w_2
    out[4, 0] = 0.0
    out[4, 1] = 0.0
    out[4, 2] = 0.0
    out[4, 3] = 0.0
    out[4, 4] = 0.0
    out[4, 5] = w3*w_8
    out[4, 6] = w2*w_8
    out[5, 0] = 0.0
    out[5, 1] = 0.0
    out[5, 2] = 0.0
    out[5, 3] = 0.0
    out[5, 4] = w3*w_9
    out[5, 5] = 0.0
    out[5, 6] = w1*w_9
    out[6, 0] = 0.0
    out[6, 1] = 0.0
    out[6, 2] = 0.0
    out[6, 3] = 0.0
    out[6, 4] = w2*w_10
    out[6, 5] = w1*w_10
    out[6, 6] = 0.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((7, 3, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_I1 = 1.0/I1
    inv_I2 = 1.0/I2
    inv_I3 = 1.0/I3
    out[4, 0] = inv_I1
    out[5, 1] = inv_I2
    out[6, 2] = inv_I3
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 1.0
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((7, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    inv_I1 = 1.0/I1
    inv_I2 = 1.0/I2
    inv_I3 = 1.0/I3
    w = -I3
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    out[...] = inv_I1*lambda_w1*(u1 - w2*w3*(-I2 - w)) + inv_I2*lambda_w2*(u2 - w1*w3*(I1 + w)) + inv_I3*lambda_w3*(u3 - w1*w2*(I2 - I1)) + lambda_q1*(half_w1*q4 + half_w3*q2 - half_w2*q3) + lambda_q2*(half_w1*q3 + half_w2*q4 - half_w3*q1) + lambda_q3*(half_w2*q1 + half_w3*q4 - half_w1*q2) + lambda_q4*(-half_w1*q1 - half_w2*q2 - half_w3*q3) + 1.0
    return out


def switching_function_batch(t, x, lam, p, out=None):
    """What multiplies each control in H. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *p))
    inv_I1 = 1.0/I1
    inv_I2 = 1.0/I2
    inv_I3 = 1.0/I3
    out[0] = inv_I1*lambda_w1
    out[1] = inv_I2*lambda_w2
    out[2] = inv_I3*lambda_w3
    return out


def switching_rate_batch(t, x, u, lam, p, out=None):
    """Its rates of change along an extremal. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_I1 = 1.0/I1
    half_inv_I1 = 0.5*inv_I1
    inv_I2 = 1.0/I2
    inv_I1_inv_I2_w3 = inv_I1*inv_I2*w3
    w = -I3
    w_2 = lambda_w2*(I1 + w)
    inv_I3 = 1.0/I3
    w_3 = inv_I3*lambda_w3*(I2 - I1)
    inv_I1_w2 = inv_I1*w2
    half_inv_I2 = 0.5*inv_I2
    w_4 = lambda_w1*(-I2 - w)
    inv_I2_w1 = inv_I2*w1
    half_inv_I3 = 0.5*inv_I3
    out[0] = half_inv_I1*lambda_q3*q2 + half_inv_I1*lambda_q4*q1 + inv_I1_inv_I2_w3*w_2 + inv_I1_w2*w_3 - half_inv_I1*lambda_q1*q4 - half_inv_I1*lambda_q2*q3
    out[1] = half_inv_I2*lambda_q1*q3 + half_inv_I2*lambda_q4*q2 + inv_I1_inv_I2_w3*w_4 + inv_I2_w1*w_3 - half_inv_I2*lambda_q2*q4 - half_inv_I2*lambda_q3*q1
    out[2] = half_inv_I3*lambda_q2*q1 + half_inv_I3*lambda_q4*q3 + inv_I1_w2*inv_I3*w_4 + inv_I2_w1*inv_I3*w_2 - half_inv_I3*lambda_q1*q2 - half_inv_I3*lambda_q3*q4
    return out


def magnitude_weight_batch(t, x, lam, p, out=None):
    """What multiplies each |u| in H. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the box. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_I1 = 1.0/I1
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    u1 = np.heaviside(inv_I1_lambda_w1 - 0.0, 0.0)*u1_min + np.heaviside(-inv_I1_lambda_w1 - 0.0, 0.0)*u1_max + (1.0 - np.heaviside(inv_I1_lambda_w1 - 0.0, 0.0) - np.heaviside(-inv_I1_lambda_w1 - 0.0, 0.0))*0.5*(u1_min + u1_max)
    inv_I2 = 1.0/I2
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    u2 = np.heaviside(inv_I2_lambda_w2 - 0.0, 0.0)*u2_min + np.heaviside(-inv_I2_lambda_w2 - 0.0, 0.0)*u2_max + (1.0 - np.heaviside(inv_I2_lambda_w2 - 0.0, 0.0) - np.heaviside(-inv_I2_lambda_w2 - 0.0, 0.0))*0.5*(u2_min + u2_max)
    inv_I3 = 1.0/I3
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    u3 = np.heaviside(inv_I3_lambda_w3 - 0.0, 0.0)*u3_min + np.heaviside(-inv_I3_lambda_w3 - 0.0, 0.0)*u3_max + (1.0 - np.heaviside(inv_I3_lambda_w3 - 0.0, 0.0) - np.heaviside(-inv_I3_lambda_w3 - 0.0, 0.0))*0.5*(u3_min + u3_max)
    out[0] = u1
    out[1] = u2
    out[2] = u3
    return out


def extremal_jacobian_batch(t, x, u, lam, p, out=None):
    """Rates of states and costates by states and costates, row by row, the controls being held. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((14, 14, *shape), np.result_type(float, t, x, u, lam, *p))
    out[...] = 0.0
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    w = -half_w2
    half_w1 = 0.5*w1
    half_q4 = 0.5*q4
    half_q3 = 0.5*q3
    w_2 = -half_q3
    half_q2 = 0.5*q2
    w_3 = -half_w3
    half_q1 = 0.5*q1
    w_4 = -half_q1
    w_5 = -half_w1
    w_6 = -half_q2
    inv_I1 = 1.0/I1
    w_7 = -I3
    w_8 = inv_I1*(-I2 - w_7)
    w3_w_8 = w3*w_8
    w2_w_8 = w2*w_8
    inv_I2 = 1.0/I2
    w_9 = inv_I2*(I1 + w_7)
    w3_w_9 = w3*w_9
    w1_w_9 = w1*w_9
    inv_I3 = 1.0/I3
    w_10 = inv_I3*(I2 - I1)
    w2_w_10 = w2*w_10
    w1_w_10 = w1*w_10
    half_lambda_q4 = 0.5*lambda_q4
    half_lambda_q3 = 0.5*lambda_q3
    w_11 = -half_lambda_q3
    half_lambda_q2 = 0.5*lambda_q2
    half_lambda_q1 = 0.5*lambda_q1
    w_12 = -half_lambda_q1
    w_13 = -half_lambda_q2
    lambda_w3_w_10 = lambda_w3*w_10
    lambda_w2_w_9 = lambda_w2*w_9
    w_14 = -half_q4
    lambda_w1_w_8 = lambda_w1*w_8
    out[0, 1] = half_w3
    out[0, 2] = w
    out[0, 3] = half_w1
    out[0, 4] = half_q4
    out[0, 5] = w_2
    out[0, 6] = half_q2
    out[1, 0] = w_3
    out[1, 2] = half_w1
    out[1, 3] = half_w2
    out[1, 4] = half_q3
    out[1, 5] = half_q4
    out[1, 6] = w_4
    out[2, 0] = half_w2
    out[2, 1] = w_5
    out[2, 3] = half_w3
    out[2, 4] = w_6
    out[2, 5] = half_q1
    out[2, 6] = half_q4
    out[3, 0] = w_5
    out[3, 1] = w
    out[3, 2] = w_3
    out[3, 4] = w_4
    out[3, 5] = w_6
    out[3, 6] = w_2
    out[4, 5] = -w3_w_8
    out[4, 6] = -w2_w_8
    out[5, 4] = -w3_w_9
    out[5, 6] = -w1_w_9
    out[6, 4] = -w2_w_10
    out[6, 5] = -w1_w_10
    out[7, 4] = half_lambda_q4
    out[7, 5] = w_11
    out[7, 6] = half_lambda_q2
    out[7, 8] = half_w3
    out[7, 9] = w
    out[7, 10] = half_w1
    out[8, 4] = half_lambda_q3
    out[8, 5] = half_lambda_q4
    out[8, 6] = w_12
    out[8, 7] = w_3
    out[8, 9] = half_w1
    out[8, 10] = half_w2
    out[9, 4] = w_13
    out[9, 5] = half_lambda_q1
    out[9, 6] = half_lambda_q4
    out[9, 7] = half_w2
    out[9, 8] = w_5
    out[9, 10] = half_w3
    out[10, 4] = w_12
    out[10, 5] = w_13
    out[10, 6] = w_11
    out[10, 7] = w_5
    out[10, 8] = w
    out[10, 9] = w_3
    out[11, 0] = half_lambda_q4
    out[11, 1] = half_lambda_q3
    out[11, 2] = w_13
    out[11, 3] = w_12
    out[11, 5] = lambda_w3_w_10
    out[11, 6] = lambda_w2_w_9
    out[11, 7] = w_14
    out[11, 8] = w_2
    out[11, 9] = half_q2
    out[11, 10] = half_q1
    out[11, 12] = w3_w_9
    out[11, 13] = w2_w_10
    out[12, 0] = w_11
    out[12, 1] = half_lambda_q4
    out[12, 2] = half_lambda_q1
    out[12, 3] = w_13
    out[12, 4] = lambda_w3_w_10
    out[12, 6] = lambda_w1_w_8
    out[12, 7] = half_q3
    out[12, 8] = w_14
    out[12, 9] = w_4
    out[12, 10] = half_q2
    out[12, 11] = w3_w_8
    out[12, 13] = w1_w_10
    out[13, 0] = half_lambda_q2
    out[13, 1] = w_12
    out[13, 2] = half_lambda_q4
    out[13, 3] = w_11
    out[13, 4] = lambda_w2_w_9
    out[13, 5] = lambda_w1_w_8
    out[13, 7] = w_6
    out[13, 8] = half_q1
    out[13, 9] = w_14
    out[13, 10] = half_q3
    out[13, 11] = w2_w_8
    out[13, 12] = w1_w_9
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    u1, u2, u3 = u
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((7, *shape), np.result_type(float, t, x, u, lam, *p))
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    half_lambda_q1 = 0.5*lambda_q1
    half_lambda_q2 = 0.5*lambda_q2
    half_q2 = 0.5*q2
    half_q1 = 0.5*q1
    inv_I2 = 1.0/I2
    w = -I3
    w_2 = inv_I2*lambda_w2*(I1 + w)
    inv_I3 = 1.0/I3
    w_3 = inv_I3*lambda_w3*(I2 - I1)
    inv_I1 = 1.0/I1
    w_4 = inv_I1*lambda_w1*(-I2 - w)
    out[0] = half_w1*lambda_q4 + half_w3*lambda_q2 - half_w2*lambda_q3
    out[1] = half_w1*lambda_q3 + half_w2*lambda_q4 - half_w3*lambda_q1
    out[2] = half_w2*lambda_q1 + half_w3*lambda_q4 - half_w1*lambda_q2
    out[3] = -half_w1*lambda_q1 - half_w2*lambda_q2 - half_w3*lambda_q3
    out[4] = half_q1*lambda_q4 + half_q2*lambda_q3 + w2*w_3 + w3*w_2 - half_lambda_q1*q4 - half_lambda_q2*q3
    out[5] = half_lambda_q1*q3 + half_q2*lambda_q4 + w1*w_3 + w3*w_4 - half_lambda_q2*q4 - half_q1*lambda_q3
    out[6] = half_q1*lambda_q2 + 0.5*lambda_q4*q3 + w1*w_2 + w2*w_4 - half_q2*lambda_q1 - 0.5*lambda_q3*q4
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law of the regularised problem. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((14, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    inv_I1 = 1.0/I1
    inv_smoothing = 1.0/smoothing
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    w = -inv_I1_lambda_w1*inv_smoothing
    w_2 = np.minimum(np.maximum(w, u1_min), u1_max)
    w_3 = -I3
    w_4 = -I2 - w_3
    w3_w_4 = w3*w_4
    inv_I2 = 1.0/I2
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    w_5 = -inv_I2_lambda_w2*inv_smoothing
    w_6 = np.minimum(np.maximum(w_5, u2_min), u2_max)
    w_7 = I1 + w_3
    w3_w_7 = w3*w_7
    inv_I3 = 1.0/I3
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    w_8 = -inv_I3_lambda_w3*inv_smoothing
    w_9 = np.minimum(np.maximum(w_8, u3_min), u3_max)
    w_10 = I2 - I1
    w2_w_10 = w2*w_10
    half_lambda_q1 = 0.5*lambda_q1
    half_lambda_q2 = 0.5*lambda_q2
    half_q2 = 0.5*q2
    half_q1 = 0.5*q1
    out[0] = half_w1*q4 + half_w3*q2 - half_w2*q3
    out[1] = half_w1*q3 + half_w2*q4 - half_w3*q1
    out[2] = half_w2*q1 + half_w3*q4 - half_w1*q2
    out[3] = -half_w1*q1 - half_w2*q2 - half_w3*q3
    out[4] = inv_I1*(w_2 - w2*w3_w_4)
    out[5] = inv_I2*(w_6 - w1*w3_w_7)
    out[6] = inv_I3*(w_9 - w1*w2_w_10)
    out[7] = half_w1*lambda_q4 + half_w3*lambda_q2 - half_w2*lambda_q3
    out[8] = half_w1*lambda_q3 + half_w2*lambda_q4 - half_w3*lambda_q1
    out[9] = half_w2*lambda_q1 + half_w3*lambda_q4 - half_w1*lambda_q2
    out[10] = -half_w1*lambda_q1 - half_w2*lambda_q2 - half_w3*lambda_q3
    out[11] = half_q1*lambda_q4 + half_q2*lambda_q3 + inv_I2_lambda_w2*w3_w_7 + inv_I3_lambda_w3*w2_w_10 - half_lambda_q1*q4 - half_lambda_q2*q3
    out[12] = half_lambda_q1*q3 + half_q2*lambda_q4 + inv_I1_lambda_w1*w3_w_4 + inv_I3_lambda_w3*w1*w_10 - half_lambda_q2*q4 - half_q1*lambda_q3
    out[13] = half_q1*lambda_q2 + inv_I1_lambda_w1*w2*w_4 + inv_I2_lambda_w2*w1*w_7 + 0.5*lambda_q4*q3 - half_q2*lambda_q1 - 0.5*lambda_q3*q4
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((14, 14, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    w = -half_w2
    half_w1 = 0.5*w1
    half_q4 = 0.5*q4
    half_q3 = 0.5*q3
    w_2 = -half_q3
    half_q2 = 0.5*q2
    w_3 = -half_w3
    half_q1 = 0.5*q1
    w_4 = -half_q1
    w_5 = -half_w1
    w_6 = -half_q2
    inv_I1 = 1.0/I1
    w_7 = -I3
    w_8 = -I2 - w_7
    inv_I1_w_8 = inv_I1*w_8
    inv_I1_w_8_w3 = inv_I1_w_8*w3
    inv_I1_w_8_w2 = inv_I1_w_8*w2
    inv_smoothing = 1.0/smoothing
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    w_9 = -inv_I1_lambda_w1*inv_smoothing
    w_10 = np.heaviside(w_9 - u1_min, 1.0)*np.heaviside(u1_max - w_9, 1.0)
    inv_I2 = 1.0/I2
    w_11 = I1 + w_7
    inv_I2_w_11 = inv_I2*w_11
    inv_I2_w_11_w3 = inv_I2_w_11*w3
    inv_I2_w_11_w1 = inv_I2_w_11*w1
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    w_12 = -inv_I2_lambda_w2*inv_smoothing
    w_13 = np.heaviside(w_12 - u2_min, 1.0)*np.heaviside(u2_max - w_12, 1.0)
    inv_I3 = 1.0/I3
    w_14 = I2 - I1
    inv_I3_w_14 = inv_I3*w_14
    inv_I3_w_14_w2 = inv_I3_w_14*w2
    inv_I3_w_14_w1 = inv_I3_w_14*w1
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    w_15 = -inv_I3_lambda_w3*inv_smoothing
    w_16 = np.heaviside(w_15 - u3_min, 1.0)*np.heaviside(u3_max - w_15, 1.0)
    half_lambda_q4 = 0.5*lambda_q4
    half_lambda_q3 = 0.5*lambda_q3
    w_17 = -half_lambda_q3
    half_lambda_q2 = 0.5*lambda_q2
    half_lambda_q1 = 0.5*lambda_q1
    w_18 = -half_lambda_q1
    w_19 = -half_lambda_q2
    inv_I3_lambda_w3_w_14 = inv_I3_lambda_w3*w_14
    inv_I2_lambda_w2_w_11 = inv_I2_lambda_w2*w_11
    w_20 = -half_q4
    inv_I1_lambda_w1_w_8 = inv_I1_lambda_w1*w_8
    out[0, 1] = half_w3
    out[0, 2] = w
    out[0, 3] = half_w1
    out[0, 4] = half_q4
    out[0, 5] = w_2
    out[0, 6] = half_q2
    out[1, 0] = w_3
    out[1, 2] = half_w1
    out[1, 3] = half_w2
    out[1, 4] = half_q3
    out[1, 5] = half_q4
    out[1, 6] = w_4
    out[2, 0] = half_w2
    out[2, 1] = w_5
    out[2, 3] = half_w3
    out[2, 4] = w_6
    out[2, 5] = half_q1
    out[2, 6] = half_q4
    out[3, 0] = w_5
    out[3, 1] = w
    out[3, 2] = w_3
    out[3, 4] = w_4
    out[3, 5] = w_6
    out[3, 6] = w_2
    out[4, 5] = -inv_I1_w_8_w3
    out[4, 6] = -inv_I1_w_8_w2
    out[4, 11] = -inv_I1*inv_I1*inv_smoothing*w_10
    out[5, 4] = -inv_I2_w_11_w3
    out[5, 6] = -inv_I2_w_11_w1
    out[5, 12] = -inv_I2*inv_I2*inv_smoothing*w_13
    out[6, 4] = -inv_I3_w_14_w2
    out[6, 5] = -inv_I3_w_14_w1
    out[6, 13] = -inv_I3*inv_I3*inv_smoothing*w_16
    out[7, 4] = half_lambda_q4
    out[7, 5] = w_17
    out[7, 6] = half_lambda_q2
    out[7, 8] = half_w3
    out[7, 9] = w
    out[7, 10] = half_w1
    out[8, 4] = half_lambda_q3
    out[8, 5] = half_lambda_q4
    out[8, 6] = w_18
    out[8, 7] = w_3
    out[8, 9] = half_w1
    out[8, 10] = half_w2
    out[9, 4] = w_19
    out[9, 5] = half_lambda_q1
    out[9, 6] = half_lambda_q4
    out[9, 7] = half_w2
    out[9, 8] = w_5
    out[9, 10] = half_w3
    out[10, 4] = w_18
    out[10, 5] = w_19
    out[10, 6] = w_17
    out[10, 7] = w_5
    out[10, 8] = w
    out[10, 9] = w_3
    out[11, 0] = half_lambda_q4
    out[11, 1] = half_lambda_q3
    out[11, 2] = w_19
    out[11, 3] = w_18
    out[11, 5] = inv_I3_lambda_w3_w_14
    out[11, 6] = inv_I2_lambda_w2_w_11
    out[11, 7] = w_20
    out[11, 8] = w_2
    out[11, 9] = half_q2
    out[11, 10] = half_q1
    out[11, 12] = inv_I2_w_11_w3
    out[11, 13] = inv_I3_w_14_w2
    out[12, 0] = w_17
    out[12, 1] = half_lambda_q4
    out[12, 2] = half_lambda_q1
    out[12, 3] = w_19
    out[12, 4] = inv_I3_lambda_w3_w_14
    out[12, 6] = inv_I1_lambda_w1_w_8
    out[12, 7] = half_q3
    out[12, 8] = w_20
    out[12, 9] = w_4
    out[12, 10] = half_q2
    out[12, 11] = inv_I1_w_8_w3
    out[12, 13] = inv_I3_w_14_w1
    out[13, 0] = half_lambda_q2
    out[13, 1] = w_18
    out[13, 2] = half_lambda_q4
    out[13, 3] = w_17
    out[13, 4] = inv_I2_lambda_w2_w_11
    out[13, 5] = inv_I1_lambda_w1_w_8
    out[13, 7] = w_6
    out[13, 8] = half_q1
    out[13, 9] = w_20
    out[13, 10] = half_q3
    out[13, 11] = inv_I1_w_8_w2
    out[13, 12] = inv_I2_w_11_w1
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((14, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = 0.0
    out[7] = 0.0
    out[8] = 0.0
    out[9] = 0.0
    out[10] = 0.0
    out[11] = 0.0
    out[12] = 0.0
    out[13] = 0.0
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    given_q1, given_q2, given_q3, given_q4, given_w1, given_w2, given_w3, on_reference_q1, on_reference_q2, on_reference_q3, on_reference_q4, on_reference_w1, on_reference_w2, on_reference_w3, target_q1, target_q2, target_q3, target_q4, target_w1, target_w2, target_w3 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    inv_smoothing = 1.0/smoothing
    inv_I1 = 1.0/I1
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    w = -inv_I1_lambda_w1*inv_smoothing
    w_2 = np.minimum(np.maximum(w, u1_min), u1_max)
    inv_I2 = 1.0/I2
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    w_3 = -inv_I2_lambda_w2*inv_smoothing
    w_4 = np.minimum(np.maximum(w_3, u2_min), u2_max)
    inv_I3 = 1.0/I3
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    w_5 = -inv_I3_lambda_w3*inv_smoothing
    w_6 = np.minimum(np.maximum(w_5, u3_min), u3_max)
    w_7 = -I3
    half_w3 = 0.5*w3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    out[0] = given_q1*(q1 - target_q1) + lambda_q1*(1.0 - given_q1 - on_reference_q1) + on_reference_q1*q1
    out[1] = given_q2*(q2 - target_q2) + lambda_q2*(1.0 - given_q2 - on_reference_q2) + on_reference_q2*q2
    out[2] = given_q3*(q3 - target_q3) + lambda_q3*(1.0 - given_q3 - on_reference_q3) + on_reference_q3*q3
    out[3] = given_q4*(q4 - target_q4) + lambda_q4*(1.0 - given_q4 - on_reference_q4) + on_reference_q4*q4
    out[4] = given_w1*(w1 - target_w1) + lambda_w1*(1.0 - given_w1 - on_reference_w1) + on_reference_w1*w1
    out[5] = given_w2*(w2 - target_w2) + lambda_w2*(1.0 - given_w2 - on_reference_w2) + on_reference_w2*w2
    out[6] = given_w3*(w3 - target_w3) + lambda_w3*(1.0 - given_w3 - on_reference_w3) + on_reference_w3*w3
    out[7] = inv_I1_lambda_w1*(w_2 - w2*w3*(-I2 - w_7)) + inv_I2_lambda_w2*(w_4 - w1*w3*(I1 + w_7)) + inv_I3_lambda_w3*(w_6 - w1*w2*(I2 - I1)) + lambda_q1*(half_w1*q4 + half_w3*q2 - half_w2*q3) + lambda_q2*(half_w1*q3 + half_w2*q4 - half_w3*q1) + lambda_q3*(half_w2*q1 + half_w3*q4 - half_w1*q2) + lambda_q4*(-half_w1*q1 - half_w2*q2 - half_w3*q3) + 0.5*smoothing*(w_2*w_2 + w_4*w_4 + w_6*w_6) + 1.0
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    q1, q2, q3, q4, w1, w2, w3 = x
    lambda_q1, lambda_q2, lambda_q3, lambda_q4, lambda_w1, lambda_w2, lambda_w3 = lam
    I1, I2, I3 = p
    u1_min, u2_min, u3_min, u1_max, u2_max, u3_max, smoothing, magnitude_share = bounds
    given_q1, given_q2, given_q3, given_q4, given_w1, given_w2, given_w3, on_reference_q1, on_reference_q2, on_reference_q3, on_reference_q4, on_reference_w1, on_reference_w2, on_reference_w3, target_q1, target_q2, target_q3, target_q4, target_w1, target_w2, target_w3 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, 15, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_q1 + on_reference_q1
    w_2 = given_q2 + on_reference_q2
    w_3 = given_q3 + on_reference_q3
    w_4 = given_q4 + on_reference_q4
    w_5 = given_w1 + on_reference_w1
    w_6 = given_w2 + on_reference_w2
    w_7 = given_w3 + on_reference_w3
    half_w3 = 0.5*w3
    half_lambda_q4 = 0.5*lambda_q4
    half_lambda_q3 = 0.5*lambda_q3
    half_w2 = 0.5*w2
    half_w1 = 0.5*w1
    inv_I2 = 1.0/I2
    inv_I2_lambda_w2 = inv_I2*lambda_w2
    w_8 = -I3
    w_9 = I1 + w_8
    w3_w_9 = w3*w_9
    w_10 = I2 - I1
    w2_w_10 = w2*w_10
    inv_I3 = 1.0/I3
    inv_I3_lambda_w3 = inv_I3*lambda_w3
    inv_I1 = 1.0/I1
    inv_I1_lambda_w1 = inv_I1*lambda_w1
    w_11 = -I2 - w_8
    w3_w_11 = w3*w_11
    inv_smoothing = 1.0/smoothing
    w_12 = -inv_I1_lambda_w1*inv_smoothing
    w_13 = np.minimum(np.maximum(w_12, u1_min), u1_max)
    w_14 = np.heaviside(w_12 - u1_min, 1.0)*np.heaviside(u1_max - w_12, 1.0)
    w_15 = -inv_I2_lambda_w2*inv_smoothing
    w_16 = np.minimum(np.maximum(w_15, u2_min), u2_max)
    w_17 = np.heaviside(w_15 - u2_min, 1.0)*np.heaviside(u2_max - w_15, 1.0)
    w_18 = -inv_I3_lambda_w3*inv_smoothing
    w_19 = np.minimum(np.maximum(w_18, u3_min), u3_max)
    w_20 = np.heaviside(w_18 - u3_min, 1.0)*np.heaviside(u3_max - w_18, 1.0)
    out[0, 0] = w
    out[0, 7] = 1.0 - w
    out[1, 1] = w_2
    out[1, 8] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 9] = 1.0 - w_3
    out[3, 3] = w_4
    out[3, 10] = 1.0 - w_4
    out[4, 4] = w_5
    out[4, 11] = 1.0 - w_5
    out[5, 5] = w_6
    out[5, 12] = 1.0 - w_6
    out[6, 6] = w_7
    out[6, 13] = 1.0 - w_7
    out[7, 0] = 0.5*lambda_q3*w2 - half_lambda_q4*w1 - half_w3*lambda_q2
    out[7, 1] = 0.5*lambda_q1*w3 - half_lambda_q3*w1 - half_lambda_q4*w2
    out[7, 2] = 0.5*lambda_q2*w1 - half_w2*lambda_q1 - half_w3*lambda_q4
    out[7, 3] = half_lambda_q3*w3 + half_w1*lambda_q1 + half_w2*lambda_q2
    out[7, 4] = 0.5*lambda_q1*q4 + 0.5*lambda_q2*q3 - half_lambda_q3*q2 - half_lambda_q4*q1 - inv_I2_lambda_w2*w3_w_9 - inv_I3_lambda_w3*w2_w_10
    out[7, 5] = 0.5*lambda_q2*q4 + 0.5*lambda_q3*q1 - half_lambda_q4*q2 - inv_I1_lambda_w1*w3_w_11 - inv_I3_lambda_w3*w1*w_10 - 0.5*lambda_q1*q3
    out[7, 6] = 0.5*lambda_q1*q2 + 0.5*lambda_q3*q4 - half_lambda_q4*q3 - inv_I1_lambda_w1*w2*w_11 - inv_I2_lambda_w2*w1*w_9 - 0.5*lambda_q2*q1
    out[7, 7] = half_w1*q4 + half_w3*q2 - half_w2*q3
    out[7, 8] = half_w1*q3 + half_w2*q4 - half_w3*q1
    out[7, 9] = half_w2*q1 + half_w3*q4 - half_w1*q2
    out[7, 10] = -half_w1*q1 - half_w2*q2 - half_w3*q3
    out[7, 11] = inv_I1*(w_13 - w2*w3_w_11) - inv_I1*inv_I1*inv_smoothing*lambda_w1*w_14 - inv_I1*w_13*w_14
    out[7, 12] = inv_I2*(w_16 - w1*w3_w_9) - inv_I2*inv_I2*inv_smoothing*lambda_w2*w_17 - inv_I2*w_16*w_17
    out[7, 13] = inv_I3*(w_19 - w1*w2_w_10) - inv_I3*inv_I3*inv_smoothing*lambda_w3*w_20 - inv_I3*w_19*w_20
    return out
