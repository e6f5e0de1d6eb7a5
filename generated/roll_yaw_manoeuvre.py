"""Roll and yaw manoeuvre of a gyrostat with minimum integral of squared torques.

Written by satsym from derivations/gimballed_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/gimballed_wheel.py
Source: ../derivations/gimballed_wheel.py 556f29f5e697be71060e04a260695b4e
Digest: 20ac5433cd169855069ce780bac930fc1b3d402981cf63633cf1edbd380835ae
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'roll_yaw_manoeuvre',
    'title': 'Roll and yaw manoeuvre of a gyrostat with minimum integral of squared torques',
    'source': 'derivations/gimballed_wheel.py',
    'states': (
        {'symbol': 'phi', 'latex': '\\phi', 'unit': 'rad', 'meaning': 'roll angle, about x, after yaw', 'kind': 'angle'},
        {'symbol': 'psi', 'latex': '\\psi', 'unit': 'rad', 'meaning': 'yaw angle, about z, the first of the three', 'kind': 'angle'},
        {'symbol': 'phi_dot', 'latex': '\\dot\\phi', 'unit': 'rad/s', 'meaning': 'rate of the roll angle'},
        {'symbol': 'psi_dot', 'latex': '\\dot\\psi', 'unit': 'rad/s', 'meaning': 'rate of the yaw angle'},
    ),
    'controls': (
        {'symbol': 'torque_x', 'latex': 'T_x', 'unit': 'N*m', 'meaning': 'torque on the body in roll'},
        {'symbol': 'torque_z', 'latex': 'T_z', 'unit': 'N*m', 'meaning': 'torque on the body in yaw'},
    ),
    'parameters': (
        {'symbol': 'I_x', 'latex': 'I_x', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in roll', 'default': 1356.0, 'positive': True},
        {'symbol': 'I_y', 'latex': 'I_y', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in pitch', 'default': 678.0, 'positive': True},
        {'symbol': 'I_z', 'latex': 'I_z', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in yaw', 'default': 1356.0, 'positive': True},
        {'symbol': 'w0', 'latex': '\\omega_0', 'unit': 'rad/s', 'meaning': 'orbital angular velocity', 'default': 7.26e-05, 'positive': True},
        {'symbol': 'h', 'latex': 'h', 'unit': 'N*m*s', 'meaning': 'angular momentum of the wheel relative to the body, along -y', 'default': 9.4247784},
    ),
    'control_set': 'box',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'conditions': (
        {'terms': (('I_x', -1.0), ('I_y', 1.0), ('I_z', 1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_x', 1.0), ('I_y', -1.0), ('I_z', 1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_x', 1.0), ('I_y', 1.0), ('I_z', -1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
    ),
    'mode_groups': (
        {'name': 'nutation', 'states': ('phi', 'psi', 'phi_dot', 'psi_dot'), 'vanishing': 'w0', 'slow': 'orbit-rate mode'},
    ),
    'objective_unit': 'N**2*m**2*s',
    'linear_quadratic': True,
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w = I_x*w0 + I_z_w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    return (
        phi_dot,
        psi_dot,
        inv_I_x*psi_dot*w + inv_I_x*torque_x - inv_I_x*phi*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0),
        inv_I_z*psi*w0*(I_x*w0 - I_y_w0 - h) + inv_I_z*torque_z - inv_I_z*phi_dot*w,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_x_w0 = I_x*w0
    w = I_x_w0 + I_z*w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    return (
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
        inv_I_x*w0*(4.0*I_z*w0 - 4.0*I_y_w0 - h),
        0.0,
        0.0,
        inv_I_x*w,
        0.0,
        inv_I_z*w0*(I_x_w0 - I_y_w0 - h),
        -inv_I_z*w,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        inv_I_x,
        0.0,
        0.0,
        inv_I_z,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    return 0.5*torque_x*torque_x + 0.5*torque_z*torque_z


def terminal_cost(t, x, p):
    """Terminal cost S."""
    phi, psi, phi_dot, psi_dot = x
    I_x, I_y, I_z, w0, h = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    phi, psi, phi_dot, psi_dot = x
    I_x, I_y, I_z, w0, h = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w = I_x*w0 + I_z_w0 - I_y_w0 - h
    return lambda_phi*phi_dot + lambda_phi_dot*(inv_I_x*psi_dot*w + inv_I_x*torque_x - inv_I_x*phi*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)) + lambda_psi*psi_dot + lambda_psi_dot*(inv_I_z*psi*w0*(I_x*w0 - I_y_w0 - h) + inv_I_z*torque_z - inv_I_z*phi_dot*w) + 0.5*torque_x*torque_x + 0.5*torque_z*torque_z


def stationarity(t, x, u, lam, p):
    """H_u."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    return (
        inv_I_x*lambda_phi_dot + torque_x,
        inv_I_z*lambda_psi_dot + torque_z,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    return (
        1.0,
        0.0,
        0.0,
        1.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    inv_I_x = 1.0/I_x
    w = -inv_I_x*lambda_phi_dot
    torque_x = torque_x_min if w < torque_x_min else torque_x_max if w > torque_x_max else w
    inv_I_z = 1.0/I_z
    w_2 = -inv_I_z*lambda_psi_dot
    torque_z = torque_z_min if w_2 < torque_z_min else torque_z_max if w_2 > torque_z_max else w_2
    return (
        torque_x,
        torque_z,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    inv_I_x = 1.0/I_x
    inv_I_x_lambda_phi_dot = inv_I_x*lambda_phi_dot
    I_x_w0 = I_x*w0
    inv_I_z = 1.0/I_z
    inv_I_z_lambda_psi_dot = inv_I_z*lambda_psi_dot
    w = I_x_w0 + I_z_w0 - I_y_w0 - h
    return (
        inv_I_x_lambda_phi_dot*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0),
        inv_I_z_lambda_psi_dot*w0*(I_y_w0 + h - I_x_w0),
        inv_I_z_lambda_psi_dot*w - lambda_phi,
        -inv_I_x_lambda_phi_dot*w - lambda_psi,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    inv_I_x = 1.0/I_x
    inv_I_x_lambda_phi_dot = inv_I_x*lambda_phi_dot
    w = -inv_I_x_lambda_phi_dot
    w_2 = torque_x_min if w < torque_x_min else torque_x_max if w > torque_x_max else w
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w_3 = w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    I_x_w0 = I_x*w0
    w_4 = I_x_w0 + I_z_w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    inv_I_z_lambda_psi_dot = inv_I_z*lambda_psi_dot
    w_5 = -inv_I_z_lambda_psi_dot
    w_6 = torque_z_min if w_5 < torque_z_min else torque_z_max if w_5 > torque_z_max else w_5
    w_7 = I_y_w0 + h - I_x_w0
    return (
        phi_dot,
        psi_dot,
        inv_I_x*psi_dot*w_4 + inv_I_x*w_2 - inv_I_x*phi*w_3,
        inv_I_z*w_6 - inv_I_z*phi_dot*w_4 - inv_I_z*psi*w0*w_7,
        inv_I_x_lambda_phi_dot*w_3,
        inv_I_z_lambda_psi_dot*w0*w_7,
        inv_I_z_lambda_psi_dot*w_4 - lambda_phi,
        -inv_I_x_lambda_phi_dot*w_4 - lambda_psi,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w = inv_I_x*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    I_x_w0 = I_x*w0
    w_2 = I_x_w0 + I_z_w0 - I_y_w0 - h
    w_3 = -inv_I_x*lambda_phi_dot
    w_4 = 0.0 if w_3 < torque_x_min else 0.0 if w_3 > torque_x_max else 1.0
    w_5 = I_y_w0 + h - I_x_w0
    inv_I_z = 1.0/I_z
    inv_I_z_w0 = inv_I_z*w0
    inv_I_z_w_2 = inv_I_z*w_2
    w_6 = -inv_I_z*lambda_psi_dot
    w_7 = 0.0 if w_6 < torque_z_min else 0.0 if w_6 > torque_z_max else 1.0
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
        -w,
        0.0,
        0.0,
        inv_I_x*w_2,
        0.0,
        0.0,
        -inv_I_x*inv_I_x*w_4,
        0.0,
        0.0,
        -inv_I_z_w0*w_5,
        -inv_I_z_w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_I_z*inv_I_z*w_7,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        inv_I_z_w0*w_5,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        0.0,
        0.0,
        inv_I_z_w_2,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        -inv_I_x*w_2,
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
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
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    given_phi, given_psi, given_phi_dot, given_psi_dot, on_reference_phi, on_reference_psi, on_reference_phi_dot, on_reference_psi_dot, target_phi, target_psi, target_phi_dot, target_psi_dot = final
    inv_I_x = 1.0/I_x
    w = -inv_I_x*lambda_phi_dot
    w_2 = torque_x_min if w < torque_x_min else torque_x_max if w > torque_x_max else w
    inv_I_z = 1.0/I_z
    w_3 = -inv_I_z*lambda_psi_dot
    w_4 = torque_z_min if w_3 < torque_z_min else torque_z_max if w_3 > torque_z_max else w_3
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w_5 = I_x*w0 + I_z_w0 - I_y_w0 - h
    return (
        given_phi*(phi - target_phi) + lambda_phi*(1.0 - given_phi - on_reference_phi) + on_reference_phi*phi,
        given_psi*(psi - target_psi) + lambda_psi*(1.0 - given_psi - on_reference_psi) + on_reference_psi*psi,
        given_phi_dot*(phi_dot - target_phi_dot) + lambda_phi_dot*(1.0 - given_phi_dot - on_reference_phi_dot) + on_reference_phi_dot*phi_dot,
        given_psi_dot*(psi_dot - target_psi_dot) + lambda_psi_dot*(1.0 - given_psi_dot - on_reference_psi_dot) + on_reference_psi_dot*psi_dot,
        lambda_phi*phi_dot + lambda_phi_dot*(inv_I_x*psi_dot*w_5 + inv_I_x*w_2 - inv_I_x*phi*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)) + lambda_psi*psi_dot + lambda_psi_dot*(inv_I_z*psi*w0*(I_x*w0 - I_y_w0 - h) + inv_I_z*w_4 - inv_I_z*phi_dot*w_5) + 0.5*w_2*w_2 + 0.5*w_4*w_4,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    given_phi, given_psi, given_phi_dot, given_psi_dot, on_reference_phi, on_reference_psi, on_reference_phi_dot, on_reference_psi_dot, target_phi, target_psi, target_phi_dot, target_psi_dot = final
    w = given_phi + on_reference_phi
    w_2 = given_psi + on_reference_psi
    w_3 = given_phi_dot + on_reference_phi_dot
    w_4 = given_psi_dot + on_reference_psi_dot
    inv_I_x = 1.0/I_x
    inv_I_x_lambda_phi_dot = inv_I_x*lambda_phi_dot
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w_5 = w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    inv_I_z = 1.0/I_z
    inv_I_z_lambda_psi_dot = inv_I_z*lambda_psi_dot
    w_6 = I_x*w0 - I_y_w0 - h
    w_7 = I_x*w0 + I_z_w0 - I_y_w0 - h
    w_8 = -inv_I_x_lambda_phi_dot
    w_9 = torque_x_min if w_8 < torque_x_min else torque_x_max if w_8 > torque_x_max else w_8
    w_10 = 0.0 if w_8 < torque_x_min else 0.0 if w_8 > torque_x_max else 1.0
    w_11 = -inv_I_z_lambda_psi_dot
    w_12 = torque_z_min if w_11 < torque_z_min else torque_z_max if w_11 > torque_z_max else w_11
    w_13 = 0.0 if w_11 < torque_z_min else 0.0 if w_11 > torque_z_max else 1.0
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
        -inv_I_x_lambda_phi_dot*w_5,
        inv_I_z_lambda_psi_dot*w0*w_6,
        lambda_phi - inv_I_z_lambda_psi_dot*w_7,
        inv_I_x_lambda_phi_dot*w_7 + lambda_psi,
        phi_dot,
        psi_dot,
        inv_I_x*psi_dot*w_7 + inv_I_x*w_9 - inv_I_x*inv_I_x*lambda_phi_dot*w_10 - inv_I_x*phi*w_5 - inv_I_x*w_10*w_9,
        inv_I_z*psi*w0*w_6 + inv_I_z*w_12 - inv_I_z*inv_I_z*lambda_psi_dot*w_13 - inv_I_z*phi_dot*w_7 - inv_I_z*w_12*w_13,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    I_x, I_y, I_z, w0, h = p
    phi_at, psi_at, phi_dot_at, psi_dot_at = x
    phi_mid, psi_mid, phi_dot_mid, psi_dot_mid = x_mid
    torque_x_at, torque_z_at = u
    torque_x_mid, torque_z_mid = u_mid
    phi, psi, phi_dot, psi_dot = x0
    inv_I_x = 1.0/I_x
    I_z_w0 = I_z*w0
    I_y_w0 = I_y*w0
    w = I_x*w0 + I_z_w0 - I_y_w0 - h
    inv_I_x_w = inv_I_x*w
    w_2 = inv_I_x*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    inv_I_z = 1.0/I_z
    inv_I_z_w = inv_I_z*w
    w_3 = inv_I_z*w0*(I_x*w0 - I_y_w0 - h)
    steps = len(times) - 1
    t = times[0]
    phi_at[0] = phi
    psi_at[0] = psi
    phi_dot_at[0] = phi_dot
    psi_dot_at[0] = psi_dot
    torque_x = torque_x_at[0]
    torque_z = torque_z_at[0]
    slope_phi_dot = inv_I_x*torque_x + inv_I_x_w*psi_dot - phi*w_2
    slope_psi_dot = inv_I_z*torque_z + psi*w_3 - inv_I_z_w*phi_dot
    slope_total = 0.5*torque_x*torque_x + 0.5*torque_z*torque_z
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h_2 = t_end - t
        phi_at[i] = phi
        psi_at[i] = psi
        phi_dot_at[i] = phi_dot
        psi_dot_at[i] = psi_dot
        torque_x_half = torque_x_mid[i]
        torque_x_end = torque_x_at[i + 1]
        torque_z_half = torque_z_mid[i]
        torque_z_end = torque_z_at[i + 1]
        half = 0.5*h_2
        sixth = (1.0/6.0)*h_2
        phi_2 = half*phi_dot + phi
        psi_2 = half*psi_dot + psi
        phi_dot_2 = half*slope_phi_dot + phi_dot
        psi_dot_2 = half*slope_psi_dot + psi_dot
        k2_phi_dot = inv_I_x*torque_x_half + inv_I_x_w*psi_dot_2 - phi_2*w_2
        k2_psi_dot = inv_I_z*torque_z_half + psi_2*w_3 - inv_I_z_w*phi_dot_2
        k2_total = 0.5*torque_x_half*torque_x_half + 0.5*torque_z_half*torque_z_half
        phi_3 = half*phi_dot_2 + phi
        psi_3 = half*psi_dot_2 + psi
        phi_dot_3 = half*k2_phi_dot + phi_dot
        psi_dot_3 = half*k2_psi_dot + psi_dot
        k3_phi_dot = inv_I_x*torque_x_half + inv_I_x_w*psi_dot_3 - phi_3*w_2
        k3_psi_dot = inv_I_z*torque_z_half + psi_3*w_3 - inv_I_z_w*phi_dot_3
        phi_4 = h_2*phi_dot_3 + phi
        psi_4 = h_2*psi_dot_3 + psi
        phi_dot_4 = h_2*k3_phi_dot + phi_dot
        psi_dot_4 = h_2*k3_psi_dot + psi_dot
        k4_phi_dot = inv_I_x*torque_x_end + inv_I_x_w*psi_dot_4 - phi_4*w_2
        k4_psi_dot = inv_I_z*torque_z_end + psi_4*w_3 - inv_I_z_w*phi_dot_4
        k4_total = 0.5*torque_x_end*torque_x_end + 0.5*torque_z_end*torque_z_end
        k23_phi_dot = k2_phi_dot + k3_phi_dot
        k123_phi_dot = k23_phi_dot + slope_phi_dot
        k23_psi_dot = k2_psi_dot + k3_psi_dot
        k123_psi_dot = k23_psi_dot + slope_psi_dot
        phi_end = h_2*(k123_phi_dot*sixth + phi_dot) + phi
        psi_end = h_2*(k123_psi_dot*sixth + psi_dot) + psi
        phi_dot_end = phi_dot + sixth*(k123_phi_dot + k23_phi_dot + k4_phi_dot)
        psi_dot_end = psi_dot + sixth*(k123_psi_dot + k23_psi_dot + k4_psi_dot)
        slope_end_phi_dot = inv_I_x*torque_x_end + inv_I_x_w*psi_dot_end - phi_end*w_2
        slope_end_psi_dot = inv_I_z*torque_z_end + psi_end*w_3 - inv_I_z_w*phi_dot_end
        eighth = 0.125*h_2
        phi_mid[i] = eighth*(phi_dot - phi_dot_end) + 0.5*(phi + phi_end)
        psi_mid[i] = eighth*(psi_dot - psi_dot_end) + 0.5*(psi + psi_end)
        phi_dot_mid[i] = eighth*(slope_phi_dot - slope_end_phi_dot) + 0.5*(phi_dot + phi_dot_end)
        psi_dot_mid[i] = eighth*(slope_psi_dot - slope_end_psi_dot) + 0.5*(psi_dot + psi_dot_end)
        total = sixth*(4.0*k2_total + k4_total + slope_total) + total
        t = t_end
        phi = phi_end
        psi = psi_end
        phi_dot = phi_dot_end
        psi_dot = psi_dot_end
        slope_phi_dot = slope_end_phi_dot
        slope_psi_dot = slope_end_psi_dot
        slope_total = k4_total
    phi_at[steps] = phi
    psi_at[steps] = psi
    phi_dot_at[steps] = phi_dot
    psi_dot_at[steps] = psi_dot
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    I_x, I_y, I_z, w0, h = p
    lambda_phi_at, lambda_psi_at, lambda_phi_dot_at, lambda_psi_dot_at = lam
    lambda_phi_mid, lambda_psi_mid, lambda_phi_dot_mid, lambda_psi_dot_mid = lam_mid
    phi_at, psi_at, phi_dot_at, psi_dot_at = x
    torque_x_at, torque_z_at = u
    phi_mid, psi_mid, phi_dot_mid, psi_dot_mid = x_mid
    torque_x_mid, torque_z_mid = u_mid
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam_f
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w = inv_I_x*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    inv_I_z = 1.0/I_z
    I_x_w0 = I_x*w0
    w_2 = inv_I_z*w0*(I_y_w0 + h - I_x_w0)
    w_3 = I_x_w0 + I_z_w0 - I_y_w0 - h
    inv_I_z_w_3 = inv_I_z*w_3
    w_4 = -inv_I_x*w_3
    steps = len(times) - 1
    t = times[steps]
    lambda_phi_at[steps] = lambda_phi
    lambda_psi_at[steps] = lambda_psi
    lambda_phi_dot_at[steps] = lambda_phi_dot
    lambda_psi_dot_at[steps] = lambda_psi_dot
    slope_lambda_phi = lambda_phi_dot*w
    slope_lambda_psi = lambda_psi_dot*w_2
    slope_lambda_phi_dot = inv_I_z_w_3*lambda_psi_dot - lambda_phi
    slope_lambda_psi_dot = lambda_phi_dot*w_4 - lambda_psi
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h_2 = t_end - t
        half = 0.5*h_2
        sixth = (1.0/6.0)*h_2
        lambda_phi_2 = half*slope_lambda_phi + lambda_phi
        lambda_psi_2 = half*slope_lambda_psi + lambda_psi
        lambda_phi_dot_2 = half*slope_lambda_phi_dot + lambda_phi_dot
        lambda_psi_dot_2 = half*slope_lambda_psi_dot + lambda_psi_dot
        k2_lambda_phi = lambda_phi_dot_2*w
        k2_lambda_psi = lambda_psi_dot_2*w_2
        k2_lambda_phi_dot = inv_I_z_w_3*lambda_psi_dot_2 - lambda_phi_2
        k2_lambda_psi_dot = lambda_phi_dot_2*w_4 - lambda_psi_2
        lambda_phi_3 = half*k2_lambda_phi + lambda_phi
        lambda_psi_3 = half*k2_lambda_psi + lambda_psi
        lambda_phi_dot_3 = half*k2_lambda_phi_dot + lambda_phi_dot
        lambda_psi_dot_3 = half*k2_lambda_psi_dot + lambda_psi_dot
        k3_lambda_phi = lambda_phi_dot_3*w
        k3_lambda_psi = lambda_psi_dot_3*w_2
        k3_lambda_phi_dot = inv_I_z_w_3*lambda_psi_dot_3 - lambda_phi_3
        k3_lambda_psi_dot = lambda_phi_dot_3*w_4 - lambda_psi_3
        lambda_phi_4 = h_2*k3_lambda_phi + lambda_phi
        lambda_psi_4 = h_2*k3_lambda_psi + lambda_psi
        lambda_phi_dot_4 = h_2*k3_lambda_phi_dot + lambda_phi_dot
        lambda_psi_dot_4 = h_2*k3_lambda_psi_dot + lambda_psi_dot
        k4_lambda_phi = lambda_phi_dot_4*w
        k4_lambda_psi = lambda_psi_dot_4*w_2
        k4_lambda_phi_dot = inv_I_z_w_3*lambda_psi_dot_4 - lambda_phi_4
        k4_lambda_psi_dot = lambda_phi_dot_4*w_4 - lambda_psi_4
        lambda_phi_end = lambda_phi + sixth*(k4_lambda_phi + slope_lambda_phi + 2.0*(k2_lambda_phi + k3_lambda_phi))
        lambda_psi_end = lambda_psi + sixth*(k4_lambda_psi + slope_lambda_psi + 2.0*(k2_lambda_psi + k3_lambda_psi))
        lambda_phi_dot_end = lambda_phi_dot + sixth*(k4_lambda_phi_dot + slope_lambda_phi_dot + 2.0*(k2_lambda_phi_dot + k3_lambda_phi_dot))
        lambda_psi_dot_end = lambda_psi_dot + sixth*(k4_lambda_psi_dot + slope_lambda_psi_dot + 2.0*(k2_lambda_psi_dot + k3_lambda_psi_dot))
        slope_end_lambda_phi = lambda_phi_dot_end*w
        slope_end_lambda_psi = lambda_psi_dot_end*w_2
        slope_end_lambda_phi_dot = inv_I_z_w_3*lambda_psi_dot_end - lambda_phi_end
        slope_end_lambda_psi_dot = lambda_phi_dot_end*w_4 - lambda_psi_end
        eighth = 0.125*h_2
        lambda_phi_mid[i] = eighth*(slope_lambda_phi - slope_end_lambda_phi) + 0.5*(lambda_phi + lambda_phi_end)
        lambda_phi_at[i] = lambda_phi_end
        lambda_psi_mid[i] = eighth*(slope_lambda_psi - slope_end_lambda_psi) + 0.5*(lambda_psi + lambda_psi_end)
        lambda_psi_at[i] = lambda_psi_end
        lambda_phi_dot_mid[i] = eighth*(slope_lambda_phi_dot - slope_end_lambda_phi_dot) + 0.5*(lambda_phi_dot + lambda_phi_dot_end)
        lambda_phi_dot_at[i] = lambda_phi_dot_end
        lambda_psi_dot_mid[i] = eighth*(slope_lambda_psi_dot - slope_end_lambda_psi_dot) + 0.5*(lambda_psi_dot + lambda_psi_dot_end)
        lambda_psi_dot_at[i] = lambda_psi_dot_end
        t = t_end
        lambda_phi = lambda_phi_end
        lambda_psi = lambda_psi_end
        lambda_phi_dot = lambda_phi_dot_end
        lambda_psi_dot = lambda_psi_dot_end
        slope_lambda_phi = slope_end_lambda_phi
        slope_lambda_psi = slope_end_lambda_psi
        slope_lambda_phi_dot = slope_end_lambda_phi_dot
        slope_lambda_psi_dot = slope_end_lambda_psi_dot


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w = I_x*w0 + I_z_w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    out[0] = phi_dot
    out[1] = psi_dot
    out[2] = inv_I_x*psi_dot*w + inv_I_x*torque_x - inv_I_x*phi*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    out[3] = inv_I_z*psi*w0*(I_x*w0 - I_y_w0 - h) + inv_I_z*torque_z - inv_I_z*phi_dot*w
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_x_w0 = I_x*w0
    w = I_x_w0 + I_z*w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    out[0, 2] = 1.0
    out[1, 3] = 1.0
    out[2, 0] = inv_I_x*w0*(4.0*I_z*w0 - 4.0*I_y_w0 - h)
    out[2, 3] = inv_I_x*w
    out[3, 1] = inv_I_z*w0*(I_x_w0 - I_y_w0 - h)
    out[3, 2] = -inv_I_z*w
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    out[2, 0] = inv_I_x
    out[3, 1] = inv_I_z
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.5*torque_x*torque_x + 0.5*torque_z*torque_z
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    I_x, I_y, I_z, w0, h = p
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
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w = I_x*w0 + I_z_w0 - I_y_w0 - h
    out[...] = lambda_phi*phi_dot + lambda_phi_dot*(inv_I_x*psi_dot*w + inv_I_x*torque_x - inv_I_x*phi*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)) + lambda_psi*psi_dot + lambda_psi_dot*(inv_I_z*psi*w0*(I_x*w0 - I_y_w0 - h) + inv_I_z*torque_z - inv_I_z*phi_dot*w) + 0.5*torque_x*torque_x + 0.5*torque_z*torque_z
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_I_x = 1.0/I_x
    inv_I_z = 1.0/I_z
    out[0] = inv_I_x*lambda_phi_dot + torque_x
    out[1] = inv_I_z*lambda_psi_dot + torque_z
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0, 0] = 1.0
    out[0, 1] = 0.0
    out[1, 0] = 0.0
    out[1, 1] = 1.0
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_I_x = 1.0/I_x
    w = -inv_I_x*lambda_phi_dot
    torque_x = np.minimum(np.maximum(w, torque_x_min), torque_x_max)
    inv_I_z = 1.0/I_z
    w_2 = -inv_I_z*lambda_psi_dot
    torque_z = np.minimum(np.maximum(w_2, torque_z_min), torque_z_max)
    out[0] = torque_x
    out[1] = torque_z
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    torque_x, torque_z = u
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, lam, *p))
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    inv_I_x = 1.0/I_x
    inv_I_x_lambda_phi_dot = inv_I_x*lambda_phi_dot
    I_x_w0 = I_x*w0
    inv_I_z = 1.0/I_z
    inv_I_z_lambda_psi_dot = inv_I_z*lambda_psi_dot
    w = I_x_w0 + I_z_w0 - I_y_w0 - h
    out[0] = inv_I_x_lambda_phi_dot*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    out[1] = inv_I_z_lambda_psi_dot*w0*(I_y_w0 + h - I_x_w0)
    out[2] = inv_I_z_lambda_psi_dot*w - lambda_phi
    out[3] = -inv_I_x_lambda_phi_dot*w - lambda_psi
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    inv_I_x = 1.0/I_x
    inv_I_x_lambda_phi_dot = inv_I_x*lambda_phi_dot
    w = -inv_I_x_lambda_phi_dot
    w_2 = np.minimum(np.maximum(w, torque_x_min), torque_x_max)
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w_3 = w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    I_x_w0 = I_x*w0
    w_4 = I_x_w0 + I_z_w0 - I_y_w0 - h
    inv_I_z = 1.0/I_z
    inv_I_z_lambda_psi_dot = inv_I_z*lambda_psi_dot
    w_5 = -inv_I_z_lambda_psi_dot
    w_6 = np.minimum(np.maximum(w_5, torque_z_min), torque_z_max)
    w_7 = I_y_w0 + h - I_x_w0
    out[0] = phi_dot
    out[1] = psi_dot
    out[2] = inv_I_x*psi_dot*w_4 + inv_I_x*w_2 - inv_I_x*phi*w_3
    out[3] = inv_I_z*w_6 - inv_I_z*phi_dot*w_4 - inv_I_z*psi*w0*w_7
    out[4] = inv_I_x_lambda_phi_dot*w_3
    out[5] = inv_I_z_lambda_psi_dot*w0*w_7
    out[6] = inv_I_z_lambda_psi_dot*w_4 - lambda_phi
    out[7] = -inv_I_x_lambda_phi_dot*w_4 - lambda_psi
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, 8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    inv_I_x = 1.0/I_x
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w = inv_I_x*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    I_x_w0 = I_x*w0
    w_2 = I_x_w0 + I_z_w0 - I_y_w0 - h
    w_3 = -inv_I_x*lambda_phi_dot
    w_4 = np.heaviside(w_3 - torque_x_min, 1.0)*np.heaviside(torque_x_max - w_3, 1.0)
    w_5 = I_y_w0 + h - I_x_w0
    inv_I_z = 1.0/I_z
    inv_I_z_w0 = inv_I_z*w0
    inv_I_z_w_2 = inv_I_z*w_2
    w_6 = -inv_I_z*lambda_psi_dot
    w_7 = np.heaviside(w_6 - torque_z_min, 1.0)*np.heaviside(torque_z_max - w_6, 1.0)
    out[0, 2] = 1.0
    out[1, 3] = 1.0
    out[2, 0] = -w
    out[2, 3] = inv_I_x*w_2
    out[2, 6] = -inv_I_x*inv_I_x*w_4
    out[3, 1] = -inv_I_z_w0*w_5
    out[3, 2] = -inv_I_z_w_2
    out[3, 7] = -inv_I_z*inv_I_z*w_7
    out[4, 6] = w
    out[5, 7] = inv_I_z_w0*w_5
    out[6, 4] = -1.0
    out[6, 7] = inv_I_z_w_2
    out[7, 5] = -1.0
    out[7, 6] = -inv_I_x*w_2
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
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
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    given_phi, given_psi, given_phi_dot, given_psi_dot, on_reference_phi, on_reference_psi, on_reference_phi_dot, on_reference_psi_dot, target_phi, target_psi, target_phi_dot, target_psi_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    inv_I_x = 1.0/I_x
    w = -inv_I_x*lambda_phi_dot
    w_2 = np.minimum(np.maximum(w, torque_x_min), torque_x_max)
    inv_I_z = 1.0/I_z
    w_3 = -inv_I_z*lambda_psi_dot
    w_4 = np.minimum(np.maximum(w_3, torque_z_min), torque_z_max)
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w_5 = I_x*w0 + I_z_w0 - I_y_w0 - h
    out[0] = given_phi*(phi - target_phi) + lambda_phi*(1.0 - given_phi - on_reference_phi) + on_reference_phi*phi
    out[1] = given_psi*(psi - target_psi) + lambda_psi*(1.0 - given_psi - on_reference_psi) + on_reference_psi*psi
    out[2] = given_phi_dot*(phi_dot - target_phi_dot) + lambda_phi_dot*(1.0 - given_phi_dot - on_reference_phi_dot) + on_reference_phi_dot*phi_dot
    out[3] = given_psi_dot*(psi_dot - target_psi_dot) + lambda_psi_dot*(1.0 - given_psi_dot - on_reference_psi_dot) + on_reference_psi_dot*psi_dot
    out[4] = lambda_phi*phi_dot + lambda_phi_dot*(inv_I_x*psi_dot*w_5 + inv_I_x*w_2 - inv_I_x*phi*w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)) + lambda_psi*psi_dot + lambda_psi_dot*(inv_I_z*psi*w0*(I_x*w0 - I_y_w0 - h) + inv_I_z*w_4 - inv_I_z*phi_dot*w_5) + 0.5*w_2*w_2 + 0.5*w_4*w_4
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    phi, psi, phi_dot, psi_dot = x
    lambda_phi, lambda_psi, lambda_phi_dot, lambda_psi_dot = lam
    I_x, I_y, I_z, w0, h = p
    torque_x_min, torque_z_min, torque_x_max, torque_z_max = bounds
    given_phi, given_psi, given_phi_dot, given_psi_dot, on_reference_phi, on_reference_psi, on_reference_phi_dot, on_reference_psi_dot, target_phi, target_psi, target_phi_dot, target_psi_dot = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, 9, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_phi + on_reference_phi
    w_2 = given_psi + on_reference_psi
    w_3 = given_phi_dot + on_reference_phi_dot
    w_4 = given_psi_dot + on_reference_psi_dot
    inv_I_x = 1.0/I_x
    inv_I_x_lambda_phi_dot = inv_I_x*lambda_phi_dot
    I_y_w0 = I_y*w0
    I_z_w0 = I_z*w0
    w_5 = w0*(4.0*I_y_w0 + h - 4.0*I_z_w0)
    inv_I_z = 1.0/I_z
    inv_I_z_lambda_psi_dot = inv_I_z*lambda_psi_dot
    w_6 = I_x*w0 - I_y_w0 - h
    w_7 = I_x*w0 + I_z_w0 - I_y_w0 - h
    w_8 = -inv_I_x_lambda_phi_dot
    w_9 = np.minimum(np.maximum(w_8, torque_x_min), torque_x_max)
    w_10 = np.heaviside(w_8 - torque_x_min, 1.0)*np.heaviside(torque_x_max - w_8, 1.0)
    w_11 = -inv_I_z_lambda_psi_dot
    w_12 = np.minimum(np.maximum(w_11, torque_z_min), torque_z_max)
    w_13 = np.heaviside(w_11 - torque_z_min, 1.0)*np.heaviside(torque_z_max - w_11, 1.0)
    out[0, 0] = w
    out[0, 4] = 1.0 - w
    out[1, 1] = w_2
    out[1, 5] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 6] = 1.0 - w_3
    out[3, 3] = w_4
    out[3, 7] = 1.0 - w_4
    out[4, 0] = -inv_I_x_lambda_phi_dot*w_5
    out[4, 1] = inv_I_z_lambda_psi_dot*w0*w_6
    out[4, 2] = lambda_phi - inv_I_z_lambda_psi_dot*w_7
    out[4, 3] = inv_I_x_lambda_phi_dot*w_7 + lambda_psi
    out[4, 4] = phi_dot
    out[4, 5] = psi_dot
    out[4, 6] = inv_I_x*psi_dot*w_7 + inv_I_x*w_9 - inv_I_x*inv_I_x*lambda_phi_dot*w_10 - inv_I_x*phi*w_5 - inv_I_x*w_10*w_9
    out[4, 7] = inv_I_z*psi*w0*w_6 + inv_I_z*w_12 - inv_I_z*inv_I_z*lambda_psi_dot*w_13 - inv_I_z*phi_dot*w_7 - inv_I_z*w_12*w_13
    return out
