"""Satellite with a gimballed wheel and flexible modes, linearised about rest.

Written by satsym from derivations/gimballed_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/gimballed_wheel.py
Source: ../derivations/gimballed_wheel.py 556f29f5e697be71060e04a260695b4e
Digest: 2db2a6aed151bcd23ae2ea84af18d921aa2a7392496b680203efe7282d67e5b8
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'gimballed_linear',
    'title': 'Satellite with a gimballed wheel and flexible modes, linearised about rest',
    'source': 'derivations/gimballed_wheel.py',
    'states': (
        {'symbol': 'phi', 'latex': '\\phi', 'unit': 'rad', 'meaning': 'roll angle, about x, after yaw', 'kind': 'angle'},
        {'symbol': 'psi', 'latex': '\\psi', 'unit': 'rad', 'meaning': 'yaw angle, about z, the first of the three', 'kind': 'angle'},
        {'symbol': 'theta', 'latex': '\\theta', 'unit': 'rad', 'meaning': 'pitch angle, about y, the last of the three', 'kind': 'angle'},
        {'symbol': 'g_x', 'latex': '\\gamma_x', 'unit': 'rad', 'meaning': 'angle of the inner gimbal, about x'},
        {'symbol': 'g_z', 'latex': '\\gamma_z', 'unit': 'rad', 'meaning': 'angle of the outer gimbal, about z'},
        {'symbol': 'eta_x', 'latex': '\\eta_x', 'unit': 'rad', 'meaning': 'deflection of the mode about x'},
        {'symbol': 'eta_y', 'latex': '\\eta_y', 'unit': 'rad', 'meaning': 'deflection of the mode about y'},
        {'symbol': 'eta_z', 'latex': '\\eta_z', 'unit': 'rad', 'meaning': 'deflection of the mode about z'},
        {'symbol': 'phi_dot', 'latex': '\\dot\\phi', 'unit': 'rad/s', 'meaning': 'rate of the roll angle'},
        {'symbol': 'psi_dot', 'latex': '\\dot\\psi', 'unit': 'rad/s', 'meaning': 'rate of the yaw angle'},
        {'symbol': 'theta_dot', 'latex': '\\dot\\theta', 'unit': 'rad/s', 'meaning': 'rate of the pitch angle'},
        {'symbol': 'g_x_dot', 'latex': '\\dot\\gamma_x', 'unit': 'rad/s', 'meaning': 'angular velocity of the inner gimbal'},
        {'symbol': 'g_z_dot', 'latex': '\\dot\\gamma_z', 'unit': 'rad/s', 'meaning': 'angular velocity of the outer gimbal'},
        {'symbol': 'eta_x_dot', 'latex': '\\dot\\eta_x', 'unit': 'rad/s', 'meaning': 'rate of deflection about x'},
        {'symbol': 'eta_y_dot', 'latex': '\\dot\\eta_y', 'unit': 'rad/s', 'meaning': 'rate of deflection about y'},
        {'symbol': 'eta_z_dot', 'latex': '\\dot\\eta_z', 'unit': 'rad/s', 'meaning': 'rate of deflection about z'},
        {'symbol': 'wheel_speed', 'latex': '\\Omega', 'unit': 'rad/s', 'meaning': 'deviation of the wheel speed from its nominal value'},
    ),
    'controls': (
        {'symbol': 'T_cx', 'latex': 'T_{cx}', 'unit': 'N*m', 'meaning': 'torque of the actuator on the inner gimbal'},
        {'symbol': 'T_cz', 'latex': 'T_{cz}', 'unit': 'N*m', 'meaning': 'torque of the actuator on the outer gimbal'},
        {'symbol': 'motor_torque', 'latex': 'T_m', 'unit': 'N*m', 'meaning': 'torque of the motor between wheel and inner gimbal'},
    ),
    'parameters': (
        {'symbol': 'I_x', 'latex': 'I_x', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in roll', 'default': 1356.0, 'positive': True},
        {'symbol': 'I_y', 'latex': 'I_y', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in pitch', 'default': 678.0, 'positive': True},
        {'symbol': 'I_z', 'latex': 'I_z', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the satellite in yaw', 'default': 1356.0, 'positive': True},
        {'symbol': 'w0', 'latex': '\\omega_0', 'unit': 'rad/s', 'meaning': 'orbital angular velocity', 'default': 7.26e-05, 'positive': True},
        {'symbol': 'I_wx', 'latex': 'I_{wx}', 'unit': 'kg*m**2', 'meaning': 'transverse moment of inertia of the wheel', 'default': 0.05, 'positive': True},
        {'symbol': 'I_wy', 'latex': 'I_{wy}', 'unit': 'kg*m**2', 'meaning': 'moment of inertia of the wheel about its axis', 'default': 0.09, 'positive': True},
        {'symbol': 'nominal_speed', 'latex': '\\Omega_n', 'unit': 'rad/s', 'meaning': 'nominal speed of the wheel', 'default': 104.71976, 'positive': True},
        {'symbol': 'K_x', 'latex': 'K_x', 'unit': 'N*m/rad', 'meaning': 'stiffness of the spring on the inner gimbal', 'default': 0.9, 'positive': True},
        {'symbol': 'K_z', 'latex': 'K_z', 'unit': 'N*m/rad', 'meaning': 'stiffness of the spring on the outer gimbal', 'default': 0.9, 'positive': True},
        {'symbol': 'D_x', 'latex': 'D_x', 'unit': 'N*m*s/rad', 'meaning': 'damping on the inner gimbal', 'default': 9.0},
        {'symbol': 'D_z', 'latex': 'D_z', 'unit': 'N*m*s/rad', 'meaning': 'damping on the outer gimbal', 'default': 9.0},
        {'symbol': 'J_x', 'latex': 'J_x', 'unit': 'kg*m**2', 'meaning': 'elastic part of the moment of inertia in roll', 'default': 200.0, 'positive': True},
        {'symbol': 'J_y', 'latex': 'J_y', 'unit': 'kg*m**2', 'meaning': 'elastic part of the moment of inertia in pitch', 'default': 200.0, 'positive': True},
        {'symbol': 'J_z', 'latex': 'J_z', 'unit': 'kg*m**2', 'meaning': 'elastic part of the moment of inertia in yaw', 'default': 200.0, 'positive': True},
        {'symbol': 'freq_x', 'latex': '\\nu_x', 'unit': 'rad/s', 'meaning': 'frequency of the mode about x, with the body fixed', 'default': 0.6, 'positive': True},
        {'symbol': 'freq_y', 'latex': '\\nu_y', 'unit': 'rad/s', 'meaning': 'frequency of the mode about y, with the body fixed', 'default': 0.9, 'positive': True},
        {'symbol': 'freq_z', 'latex': '\\nu_z', 'unit': 'rad/s', 'meaning': 'frequency of the mode about z, with the body fixed', 'default': 0.7, 'positive': True},
        {'symbol': 'zeta_x', 'latex': '\\zeta_x', 'meaning': 'damping ratio of the mode about x', 'default': 0.005},
        {'symbol': 'zeta_y', 'latex': '\\zeta_y', 'meaning': 'damping ratio of the mode about y', 'default': 0.005},
        {'symbol': 'zeta_z', 'latex': '\\zeta_z', 'meaning': 'damping ratio of the mode about z', 'default': 0.005},
    ),
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
    ),
    'conditions': (
        {'terms': (('I_x', -1.0), ('I_y', 1.0), ('I_z', 1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_x', 1.0), ('I_y', -1.0), ('I_z', 1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_x', 1.0), ('I_y', 1.0), ('I_z', -1.0)), 'strict': False, 'reason': 'one moment of inertia of the satellite exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_wy', 1.0),), 'strict': False, 'reason': 'one moment of inertia of the wheel exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_wx', 2.0), ('I_wy', -1.0)), 'strict': False, 'reason': 'one moment of inertia of the wheel exceeds the sum of the other two, which is impossible for a rigid body'},
        {'terms': (('I_wx', -1.0), ('I_x', 1.0), ('J_x', -1.0)), 'strict': True, 'reason': 'the wheel and the elastic part together have at least as much inertia as the whole satellite'},
        {'terms': (('I_wy', -1.0), ('I_y', 1.0), ('J_y', -1.0)), 'strict': True, 'reason': 'the wheel and the elastic part together have at least as much inertia as the whole satellite'},
        {'terms': (('I_wx', -1.0), ('I_z', 1.0), ('J_z', -1.0)), 'strict': True, 'reason': 'the wheel and the elastic part together have at least as much inertia as the whole satellite'},
    ),
    'mode_groups': (
        {'name': 'nutation', 'states': ('phi', 'psi', 'phi_dot', 'psi_dot'), 'vanishing': 'w0', 'slow': 'orbit-rate mode'},
        {'name': 'pitch libration', 'states': ('theta', 'theta_dot'), 'neutral': 'pitch drift'},
        {'name': 'gimbal mode', 'states': ('g_x', 'g_z', 'g_x_dot', 'g_z_dot', 'g_x_dot', 'g_z_dot')},
        {'name': 'flexible mode about x', 'states': ('eta_x', 'eta_x_dot', 'eta_x_dot')},
        {'name': 'flexible mode about y', 'states': ('eta_y', 'eta_y_dot', 'eta_y_dot')},
        {'name': 'flexible mode about z', 'states': ('eta_z', 'eta_z_dot', 'eta_z_dot')},
        {'name': 'speed of the wheel', 'states': ('wheel_speed',)},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, phi_dot, psi_dot, theta_dot, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    w = -I_x
    w_2 = I_wx + w
    w_3 = J_x + w_2
    inv_w_3 = 1.0/w_3
    w_4 = -I_z
    w_5 = I_y - I_wy
    w_6 = 2.0*I_wx + w + w_4 + w_5
    w0_sq = w0*w0
    w_7 = I_wx + w_4
    w_8 = w_5 + w_7
    w_9 = 4.0*inv_w_3*phi*w0_sq*w_8
    J_x_inv_w_3 = J_x*inv_w_3
    w_10 = eta_x*freq_x*freq_x
    inv_w_3_w0 = inv_w_3*w0
    J_z_eta_z_dot = J_z*eta_z_dot
    J_z_eta_z_dot_inv_w_3_w0 = J_z_eta_z_dot*inv_w_3_w0
    w_11 = 2.0*eta_x_dot*freq_x*zeta_x
    w_12 = J_x_inv_w_3*w_10 + J_x_inv_w_3*w_11 + J_z_eta_z_dot_inv_w_3_w0
    T_cx_inv_w_3 = T_cx*inv_w_3
    D_x_g_x_dot_inv_w_3 = D_x*g_x_dot*inv_w_3
    g_x_inv_w_3 = g_x*inv_w_3
    K_x_g_x_inv_w_3 = K_x*g_x_inv_w_3
    w_13 = J_z + w_7
    inv_w_13 = 1.0/w_13
    T_cz_inv_w_13 = T_cz*inv_w_13
    D_z_g_z_dot_inv_w_13 = D_z*g_z_dot*inv_w_13
    g_z_inv_w_13 = g_z*inv_w_13
    K_z_g_z_inv_w_13 = K_z*g_z_inv_w_13
    inv_w_13_w0 = inv_w_13*w0
    w_14 = w_2 + w_5
    inv_w_13_psi_w0_sq_w_14 = inv_w_13*psi*w0_sq*w_14
    w_15 = eta_z*freq_z*freq_z*inv_w_13
    w_16 = J_x*eta_x_dot*inv_w_13_w0
    w_17 = 2.0*freq_z*inv_w_13*zeta_z
    w_18 = J_z*w_15 + J_z_eta_z_dot*w_17 - w_16
    w_19 = I_wy - I_y
    w_20 = J_y + w_19
    inv_w_20 = 1.0/w_20
    inv_w_20_motor_torque = inv_w_20*motor_torque
    J_y_inv_w_20 = J_y*inv_w_20
    w_21 = eta_y*freq_y*freq_y
    w_22 = 3.0*inv_w_20*theta*w0_sq*(I_x + w_4)
    w_23 = 2.0*eta_y_dot*freq_y*zeta_y
    w_24 = J_y_inv_w_20*w_21 + J_y_inv_w_20*w_23 - w_22
    inv_I_wx = 1.0/I_wx
    I_wy_nominal_speed = I_wy*nominal_speed
    I_wy_w0 = I_wy*w0
    w_25 = inv_I_wx*(2.0*I_wx*w0 - I_wy_nominal_speed - I_wy_w0)
    I_wx_I_wy_nominal_speed = I_wx*I_wy_nominal_speed
    w_26 = I_wx_I_wy_nominal_speed*w0
    I_wy_nominal_speed_J_x = I_wy_nominal_speed*J_x
    I_wx_w0_sq = I_wx*w0_sq
    I_wx_w0_sq_I_wy = I_wx_w0_sq*I_wy
    I_wy_w0_sq = I_wy*w0_sq
    I_wx_sq = I_wx*I_wx
    w_27 = inv_I_wx*(I_x - J_x)
    I_wx_w0 = I_wx*w0
    I_wx_w0_I_x = I_wx_w0*I_x
    I_wy_w0_J_x = I_wy_w0*J_x
    I_wx_w0_I_z = I_wx_w0*I_z
    I_wx_w0_J_x = I_wx_w0*J_x
    I_wy_w0_I_x = I_wy_w0*I_x
    I_wx_w0_I_y = I_wx_w0*I_y
    w_28 = I_wx_I_wy_nominal_speed + I_wx_w0_I_y
    w_29 = I_wy_nominal_speed_J_x - I_wy_nominal_speed*I_x
    I_wy_nominal_speed_J_z = I_wy_nominal_speed*J_z
    w_30 = inv_I_wx*(I_z - J_z)
    w_31 = inv_I_wx*(I_wx*I_x*w0 + I_wx*J_z*w0 + I_wy*I_z*nominal_speed + I_wy*I_z*w0 - I_wx_w0_I_z - I_wy_nominal_speed_J_z - I_wy_w0*J_z - w_28)
    inv_w_3_w_2 = inv_w_3*w_2
    inv_w_20_w_19 = inv_w_20*w_19
    inv_I_wy = 1.0/I_wy
    return (
        phi_dot,
        psi_dot,
        theta_dot,
        g_x_dot,
        g_z_dot,
        eta_x_dot,
        eta_y_dot,
        eta_z_dot,
        T_cx_inv_w_3 + inv_w_3*psi_dot*w0*(J_x + w_6) + w_9 - D_x_g_x_dot_inv_w_3 - K_x_g_x_inv_w_3 - w_12,
        T_cz_inv_w_13 + inv_w_13_psi_w0_sq_w_14 - D_z_g_z_dot_inv_w_13 - K_z_g_z_inv_w_13 - inv_w_13_w0*phi_dot*(J_z + w_6) - w_18,
        -inv_w_20_motor_torque - w_24,
        D_x_g_x_dot_inv_w_3*w_27 + g_x_inv_w_3*inv_I_wx*(4.0*I_wx*J_x*w0_sq + 4.0*I_wx_sq*w0_sq + I_wy*I_x*nominal_speed*w0 + 4.0*I_wy*I_x*w0_sq + I_x*K_x - 4.0*I_wx_w0_sq*I_x - 4.0*I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_x*w0 - 4.0*I_wy_w0_sq*J_x - J_x*K_x - w_26) + g_z_dot*w_25 + w_12 - T_cx_inv_w_3*w_27 - inv_I_wx*inv_w_3*psi_dot*(I_wx_w0_I_x + I_wy_w0_J_x + w_28 + w_29 - I_wx_w0_I_z - I_wx_w0_J_x - I_wy_w0_I_x) - inv_I_wx*inv_w_3_w0*phi*(I_wx_I_wy_nominal_speed + 4.0*I_wx_w0_I_x + 4.0*I_wx_w0_I_y + 4.0*I_wy_w0_J_x + w_29 - 4.0*I_wx_w0_I_z - 4.0*I_wx_w0_J_x - 4.0*I_wy_w0_I_x),
        D_z_g_z_dot_inv_w_13*w_30 + g_z_inv_w_13*inv_I_wx*(I_wx*J_z*w0_sq + I_wx_sq*w0_sq + I_wy*I_z*nominal_speed*w0 + I_wy*I_z*w0_sq + I_z*K_z - I_wx_w0_sq*I_z - I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_z*w0 - I_wy_w0_sq*J_z - J_z*K_z - w_26) + inv_w_13_w0*psi*w_31 + w_18 - T_cz_inv_w_13*w_30 - g_x_dot*w_25 - inv_w_13*phi_dot*w_31,
        D_x_g_x_dot_inv_w_3 + J_z_eta_z_dot_inv_w_3_w0 + K_x_g_x_inv_w_3 - T_cx_inv_w_3 - inv_w_3_w0*psi_dot*w_8 - inv_w_3_w_2*w_10 - inv_w_3_w_2*w_11 - w_9,
        inv_w_20_motor_torque - inv_w_20_w_19*w_21 - inv_w_20_w_19*w_23 - w_22,
        D_z_g_z_dot_inv_w_13 + K_z_g_z_inv_w_13 + inv_w_13*phi_dot*w0*w_14 - T_cz_inv_w_13 - eta_z_dot*w_17*w_7 - inv_w_13_psi_w0_sq_w_14 - w_15*w_7 - w_16,
        -inv_I_wy*inv_w_20_motor_torque*(I_y - J_y) - w_24,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, phi_dot, psi_dot, theta_dot, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    w = -I_z
    w_2 = I_wx + w
    w_3 = I_y - I_wy
    w_4 = w_2 + w_3
    w_5 = -I_x
    w_6 = I_wx + w_5
    w_7 = J_x + w_6
    inv_w_7 = 1.0/w_7
    w0_sq = w0*w0
    w_8 = 4.0*inv_w_7*w0_sq
    K_x_inv_w_7 = K_x*inv_w_7
    w_9 = freq_x*freq_x*inv_w_7
    J_x_w_9 = J_x*w_9
    w_10 = 2.0*I_wx + w + w_3 + w_5
    inv_w_7_w0 = inv_w_7*w0
    D_x_inv_w_7 = D_x*inv_w_7
    w_11 = 2.0*freq_x*inv_w_7*zeta_x
    J_x_w_11 = J_x*w_11
    J_z_inv_w_7_w0 = J_z*inv_w_7_w0
    w_12 = w_3 + w_6
    w_13 = J_z + w_2
    inv_w_13 = 1.0/w_13
    inv_w_13_w0_sq = inv_w_13*w0_sq
    K_z_inv_w_13 = K_z*inv_w_13
    w_14 = freq_z*freq_z*inv_w_13
    J_z_w_14 = J_z*w_14
    inv_w_13_w0 = inv_w_13*w0
    D_z_inv_w_13 = D_z*inv_w_13
    J_x_inv_w_13_w0 = J_x*inv_w_13_w0
    w_15 = 2.0*freq_z*inv_w_13*zeta_z
    J_z_w_15 = J_z*w_15
    w_16 = I_x + w
    w_17 = I_wy - I_y
    w_18 = J_y + w_17
    inv_w_18 = 1.0/w_18
    w_19 = 3.0*inv_w_18*w0_sq
    w_16_w_19 = w_16*w_19
    w_20 = freq_y*freq_y*inv_w_18
    w_21 = -J_y*w_20
    w_22 = 2.0*freq_y*inv_w_18*zeta_y
    w_23 = -J_y*w_22
    inv_I_wx = 1.0/I_wx
    I_wx_w0 = I_wx*w0
    I_wx_w0_I_x = I_wx_w0*I_x
    I_wx_w0_I_y = I_wx_w0*I_y
    I_wy_w0 = I_wy*w0
    I_wy_w0_J_x = I_wy_w0*J_x
    I_wy_nominal_speed = I_wy*nominal_speed
    I_wx_I_wy_nominal_speed = I_wx*I_wy_nominal_speed
    I_wy_nominal_speed_J_x = I_wy_nominal_speed*J_x
    w_24 = I_wx_I_wy_nominal_speed + I_wy_nominal_speed_J_x - I_wy*I_x*nominal_speed
    w_25 = I_wx_I_wy_nominal_speed*w0
    I_wx_w0_sq = I_wx*w0_sq
    I_wx_w0_sq_I_wy = I_wx_w0_sq*I_wy
    I_wy_w0_sq = I_wy*w0_sq
    I_wx_sq = I_wx*I_wx
    inv_I_wx_inv_w_7 = inv_I_wx*inv_w_7
    I_wx_w0_I_z = I_wx_w0*I_z
    w_26 = I_wy_nominal_speed*inv_I_wx + I_wy_w0*inv_I_wx - 2.0*w0
    I_wy_nominal_speed_J_z = I_wy_nominal_speed*J_z
    w_27 = I_wx_I_wy_nominal_speed + I_wx_w0_I_y + I_wx_w0_I_z + I_wy_nominal_speed_J_z + I_wy_w0*J_z - I_wx*J_z*w0 - I_wx_w0_I_x - I_wy*I_z*nominal_speed - I_wy*I_z*w0
    inv_I_wx_inv_w_13 = inv_I_wx*inv_w_13
    w_28 = -J_x_inv_w_13_w0
    w_29 = -w_4
    w_30 = -w_6
    w_31 = -w_17
    w_32 = -w_2
    return (
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
        1.0,
        0.0,
        w_4*w_8,
        0.0,
        0.0,
        -K_x_inv_w_7,
        0.0,
        -J_x_w_9,
        0.0,
        0.0,
        0.0,
        inv_w_7_w0*(J_x + w_10),
        0.0,
        -D_x_inv_w_7,
        0.0,
        -J_x_w_11,
        0.0,
        -J_z_inv_w_7_w0,
        0.0,
        0.0,
        inv_w_13_w0_sq*w_12,
        0.0,
        0.0,
        -K_z_inv_w_13,
        0.0,
        0.0,
        -J_z_w_14,
        inv_w_13_w0*(-J_z - w_10),
        0.0,
        0.0,
        0.0,
        -D_z_inv_w_13,
        J_x_inv_w_13_w0,
        0.0,
        -J_z_w_15,
        0.0,
        0.0,
        0.0,
        w_16_w_19,
        0.0,
        0.0,
        0.0,
        w_21,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_23,
        0.0,
        0.0,
        inv_I_wx*inv_w_7_w0*(4.0*I_wx*I_z*w0 + 4.0*I_wx*J_x*w0 + 4.0*I_wy*I_x*w0 - 4.0*I_wx_w0_I_x - 4.0*I_wx_w0_I_y - 4.0*I_wy_w0_J_x - w_24),
        0.0,
        0.0,
        inv_I_wx_inv_w_7*(4.0*I_wx*J_x*w0_sq + 4.0*I_wx_sq*w0_sq + I_wy*I_x*nominal_speed*w0 + 4.0*I_wy*I_x*w0_sq + I_x*K_x - 4.0*I_wx_w0_sq*I_x - 4.0*I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_x*w0 - 4.0*I_wy_w0_sq*J_x - J_x*K_x - w_25),
        0.0,
        J_x_w_9,
        0.0,
        0.0,
        0.0,
        inv_I_wx_inv_w_7*(I_wx*J_x*w0 + I_wx_w0_I_z + I_wy*I_x*w0 - I_wx_w0_I_x - I_wx_w0_I_y - I_wy_w0_J_x - w_24),
        0.0,
        D_x_inv_w_7*inv_I_wx*(I_x - J_x),
        -w_26,
        J_x_w_11,
        0.0,
        J_z_inv_w_7_w0,
        0.0,
        0.0,
        -inv_I_wx*inv_w_13_w0*w_27,
        0.0,
        0.0,
        inv_I_wx_inv_w_13*(I_wx*J_z*w0_sq + I_wx_sq*w0_sq + I_wy*I_z*nominal_speed*w0 + I_wy*I_z*w0_sq + I_z*K_z - I_wx_w0_sq*I_z - I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_z*w0 - I_wy_w0_sq*J_z - J_z*K_z - w_25),
        0.0,
        0.0,
        J_z_w_14,
        inv_I_wx_inv_w_13*w_27,
        0.0,
        0.0,
        w_26,
        D_z_inv_w_13*inv_I_wx*(I_z - J_z),
        w_28,
        0.0,
        J_z_w_15,
        0.0,
        w_29*w_8,
        0.0,
        0.0,
        K_x_inv_w_7,
        0.0,
        w_30*w_9,
        0.0,
        0.0,
        0.0,
        inv_w_7_w0*w_29,
        0.0,
        D_x_inv_w_7,
        0.0,
        w_11*w_30,
        0.0,
        J_z_inv_w_7_w0,
        0.0,
        0.0,
        0.0,
        -w_16*w_19,
        0.0,
        0.0,
        0.0,
        w_20*w_31,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_22*w_31,
        0.0,
        0.0,
        0.0,
        -inv_w_13_w0_sq*w_12,
        0.0,
        0.0,
        K_z_inv_w_13,
        0.0,
        0.0,
        w_14*w_32,
        inv_w_13_w0*w_12,
        0.0,
        0.0,
        0.0,
        D_z_inv_w_13,
        w_28,
        0.0,
        w_15*w_32,
        0.0,
        0.0,
        0.0,
        w_16_w_19,
        0.0,
        0.0,
        0.0,
        w_21,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_23,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, phi_dot, psi_dot, theta_dot, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    w = I_wx + J_x - I_x
    inv_w = 1.0/w
    w_2 = I_wx + J_z - I_z
    inv_w_2 = 1.0/w_2
    w_3 = I_wy + J_y - I_y
    inv_w_3 = 1.0/w_3
    inv_I_wx = 1.0/I_wx
    inv_I_wy = 1.0/I_wy
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
        inv_w,
        0.0,
        0.0,
        0.0,
        inv_w_2,
        0.0,
        0.0,
        0.0,
        -inv_w_3,
        inv_I_wx*inv_w*(J_x - I_x),
        0.0,
        0.0,
        0.0,
        inv_I_wx*inv_w_2*(J_z - I_z),
        0.0,
        -inv_w,
        0.0,
        0.0,
        0.0,
        0.0,
        inv_w_3,
        0.0,
        -inv_w_2,
        0.0,
        0.0,
        0.0,
        inv_I_wy*inv_w_3*(J_y - I_y),
    )


def state_matrix(t, p):
    """A, row by row."""
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    w = -I_z
    w_2 = I_wx + w
    w_3 = I_y - I_wy
    w_4 = w_2 + w_3
    w_5 = -I_x
    w_6 = I_wx + w_5
    w_7 = J_x + w_6
    inv_w_7 = 1.0/w_7
    w0_sq = w0*w0
    w_8 = 4.0*inv_w_7*w0_sq
    K_x_inv_w_7 = K_x*inv_w_7
    w_9 = freq_x*freq_x*inv_w_7
    J_x_w_9 = J_x*w_9
    w_10 = 2.0*I_wx + w + w_3 + w_5
    inv_w_7_w0 = inv_w_7*w0
    D_x_inv_w_7 = D_x*inv_w_7
    w_11 = 2.0*freq_x*inv_w_7*zeta_x
    J_x_w_11 = J_x*w_11
    J_z_inv_w_7_w0 = J_z*inv_w_7_w0
    w_12 = w_3 + w_6
    w_13 = J_z + w_2
    inv_w_13 = 1.0/w_13
    inv_w_13_w0_sq = inv_w_13*w0_sq
    K_z_inv_w_13 = K_z*inv_w_13
    w_14 = freq_z*freq_z*inv_w_13
    J_z_w_14 = J_z*w_14
    inv_w_13_w0 = inv_w_13*w0
    D_z_inv_w_13 = D_z*inv_w_13
    J_x_inv_w_13_w0 = J_x*inv_w_13_w0
    w_15 = 2.0*freq_z*inv_w_13*zeta_z
    J_z_w_15 = J_z*w_15
    w_16 = I_x + w
    w_17 = I_wy - I_y
    w_18 = J_y + w_17
    inv_w_18 = 1.0/w_18
    w_19 = 3.0*inv_w_18*w0_sq
    w_16_w_19 = w_16*w_19
    w_20 = freq_y*freq_y*inv_w_18
    w_21 = -J_y*w_20
    w_22 = 2.0*freq_y*inv_w_18*zeta_y
    w_23 = -J_y*w_22
    inv_I_wx = 1.0/I_wx
    I_wx_w0 = I_wx*w0
    I_wx_w0_I_x = I_wx_w0*I_x
    I_wx_w0_I_y = I_wx_w0*I_y
    I_wy_w0 = I_wy*w0
    I_wy_w0_J_x = I_wy_w0*J_x
    I_wy_nominal_speed = I_wy*nominal_speed
    I_wx_I_wy_nominal_speed = I_wx*I_wy_nominal_speed
    I_wy_nominal_speed_J_x = I_wy_nominal_speed*J_x
    w_24 = I_wx_I_wy_nominal_speed + I_wy_nominal_speed_J_x - I_wy*I_x*nominal_speed
    w_25 = I_wx_I_wy_nominal_speed*w0
    I_wx_w0_sq = I_wx*w0_sq
    I_wx_w0_sq_I_wy = I_wx_w0_sq*I_wy
    I_wy_w0_sq = I_wy*w0_sq
    I_wx_sq = I_wx*I_wx
    inv_I_wx_inv_w_7 = inv_I_wx*inv_w_7
    I_wx_w0_I_z = I_wx_w0*I_z
    w_26 = I_wy_nominal_speed*inv_I_wx + I_wy_w0*inv_I_wx - 2.0*w0
    I_wy_nominal_speed_J_z = I_wy_nominal_speed*J_z
    w_27 = I_wx_I_wy_nominal_speed + I_wx_w0_I_y + I_wx_w0_I_z + I_wy_nominal_speed_J_z + I_wy_w0*J_z - I_wx*J_z*w0 - I_wx_w0_I_x - I_wy*I_z*nominal_speed - I_wy*I_z*w0
    inv_I_wx_inv_w_13 = inv_I_wx*inv_w_13
    w_28 = -J_x_inv_w_13_w0
    w_29 = -w_4
    w_30 = -w_6
    w_31 = -w_17
    w_32 = -w_2
    return (
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
        1.0,
        0.0,
        w_4*w_8,
        0.0,
        0.0,
        -K_x_inv_w_7,
        0.0,
        -J_x_w_9,
        0.0,
        0.0,
        0.0,
        inv_w_7_w0*(J_x + w_10),
        0.0,
        -D_x_inv_w_7,
        0.0,
        -J_x_w_11,
        0.0,
        -J_z_inv_w_7_w0,
        0.0,
        0.0,
        inv_w_13_w0_sq*w_12,
        0.0,
        0.0,
        -K_z_inv_w_13,
        0.0,
        0.0,
        -J_z_w_14,
        inv_w_13_w0*(-J_z - w_10),
        0.0,
        0.0,
        0.0,
        -D_z_inv_w_13,
        J_x_inv_w_13_w0,
        0.0,
        -J_z_w_15,
        0.0,
        0.0,
        0.0,
        w_16_w_19,
        0.0,
        0.0,
        0.0,
        w_21,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_23,
        0.0,
        0.0,
        inv_I_wx*inv_w_7_w0*(4.0*I_wx*I_z*w0 + 4.0*I_wx*J_x*w0 + 4.0*I_wy*I_x*w0 - 4.0*I_wx_w0_I_x - 4.0*I_wx_w0_I_y - 4.0*I_wy_w0_J_x - w_24),
        0.0,
        0.0,
        inv_I_wx_inv_w_7*(4.0*I_wx*J_x*w0_sq + 4.0*I_wx_sq*w0_sq + I_wy*I_x*nominal_speed*w0 + 4.0*I_wy*I_x*w0_sq + I_x*K_x - 4.0*I_wx_w0_sq*I_x - 4.0*I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_x*w0 - 4.0*I_wy_w0_sq*J_x - J_x*K_x - w_25),
        0.0,
        J_x_w_9,
        0.0,
        0.0,
        0.0,
        inv_I_wx_inv_w_7*(I_wx*J_x*w0 + I_wx_w0_I_z + I_wy*I_x*w0 - I_wx_w0_I_x - I_wx_w0_I_y - I_wy_w0_J_x - w_24),
        0.0,
        D_x_inv_w_7*inv_I_wx*(I_x - J_x),
        -w_26,
        J_x_w_11,
        0.0,
        J_z_inv_w_7_w0,
        0.0,
        0.0,
        -inv_I_wx*inv_w_13_w0*w_27,
        0.0,
        0.0,
        inv_I_wx_inv_w_13*(I_wx*J_z*w0_sq + I_wx_sq*w0_sq + I_wy*I_z*nominal_speed*w0 + I_wy*I_z*w0_sq + I_z*K_z - I_wx_w0_sq*I_z - I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_z*w0 - I_wy_w0_sq*J_z - J_z*K_z - w_25),
        0.0,
        0.0,
        J_z_w_14,
        inv_I_wx_inv_w_13*w_27,
        0.0,
        0.0,
        w_26,
        D_z_inv_w_13*inv_I_wx*(I_z - J_z),
        w_28,
        0.0,
        J_z_w_15,
        0.0,
        w_29*w_8,
        0.0,
        0.0,
        K_x_inv_w_7,
        0.0,
        w_30*w_9,
        0.0,
        0.0,
        0.0,
        inv_w_7_w0*w_29,
        0.0,
        D_x_inv_w_7,
        0.0,
        w_11*w_30,
        0.0,
        J_z_inv_w_7_w0,
        0.0,
        0.0,
        0.0,
        -w_16*w_19,
        0.0,
        0.0,
        0.0,
        w_20*w_31,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_22*w_31,
        0.0,
        0.0,
        0.0,
        -inv_w_13_w0_sq*w_12,
        0.0,
        0.0,
        K_z_inv_w_13,
        0.0,
        0.0,
        w_14*w_32,
        inv_w_13_w0*w_12,
        0.0,
        0.0,
        0.0,
        D_z_inv_w_13,
        w_28,
        0.0,
        w_15*w_32,
        0.0,
        0.0,
        0.0,
        w_16_w_19,
        0.0,
        0.0,
        0.0,
        w_21,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w_23,
        0.0,
        0.0,
    )


def input_matrix(t, p):
    """B, row by row."""
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    w = I_wx + J_x - I_x
    inv_w = 1.0/w
    w_2 = I_wx + J_z - I_z
    inv_w_2 = 1.0/w_2
    w_3 = I_wy + J_y - I_y
    inv_w_3 = 1.0/w_3
    inv_I_wx = 1.0/I_wx
    inv_I_wy = 1.0/I_wy
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
        inv_w,
        0.0,
        0.0,
        0.0,
        inv_w_2,
        0.0,
        0.0,
        0.0,
        -inv_w_3,
        inv_I_wx*inv_w*(J_x - I_x),
        0.0,
        0.0,
        0.0,
        inv_I_wx*inv_w_2*(J_z - I_z),
        0.0,
        -inv_w,
        0.0,
        0.0,
        0.0,
        0.0,
        inv_w_3,
        0.0,
        -inv_w_2,
        0.0,
        0.0,
        0.0,
        inv_I_wy*inv_w_3*(J_y - I_y),
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    phi_at, psi_at, theta_at, g_x_at, g_z_at, eta_x_at, eta_y_at, eta_z_at, phi_dot_at, psi_dot_at, theta_dot_at, g_x_dot_at, g_z_dot_at, eta_x_dot_at, eta_y_dot_at, eta_z_dot_at, wheel_speed_at = x
    phi_mid, psi_mid, theta_mid, g_x_mid, g_z_mid, eta_x_mid, eta_y_mid, eta_z_mid, phi_dot_mid, psi_dot_mid, theta_dot_mid, g_x_dot_mid, g_z_dot_mid, eta_x_dot_mid, eta_y_dot_mid, eta_z_dot_mid, wheel_speed_mid = x_mid
    T_cx_at, T_cz_at, motor_torque_at = u
    T_cx_mid, T_cz_mid, motor_torque_mid = u_mid
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, phi_dot, psi_dot, theta_dot, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x0
    w = -I_z
    w_2 = -I_x
    w_3 = I_y - I_wy
    w_4 = 2.0*I_wx + w + w_2 + w_3
    w_5 = I_wx + w_2
    w_6 = J_x + w_5
    inv_w_6 = 1.0/w_6
    inv_w_6_w0 = inv_w_6*w0
    w_7 = inv_w_6_w0*(J_x + w_4)
    D_x_inv_w_6 = D_x*inv_w_6
    K_x_inv_w_6 = K_x*inv_w_6
    w0_sq = w0*w0
    w_8 = I_wx + w
    w_9 = w_3 + w_8
    w_10 = 4.0*inv_w_6*w0_sq*w_9
    w_11 = freq_x*freq_x*inv_w_6
    J_x_w_11 = J_x*w_11
    w_12 = 2.0*freq_x*inv_w_6*zeta_x
    J_x_w_12 = J_x*w_12
    J_z_inv_w_6_w0 = J_z*inv_w_6_w0
    w_14 = J_z + w_8
    inv_w_14 = 1.0/w_14
    inv_w_14_w0 = inv_w_14*w0
    w_15 = inv_w_14_w0*(J_z + w_4)
    K_z_inv_w_14 = K_z*inv_w_14
    D_z_inv_w_14 = D_z*inv_w_14
    w_16 = w_3 + w_5
    inv_w_14_w0_sq_w_16 = inv_w_14*w0_sq*w_16
    w_17 = freq_z*freq_z*inv_w_14
    J_z_w_17 = J_z*w_17
    w_18 = 2.0*freq_z*inv_w_14*zeta_z
    J_z_w_18 = J_z*w_18
    J_x_inv_w_14_w0 = J_x*inv_w_14_w0
    w_21 = I_wy - I_y
    w_22 = J_y + w_21
    inv_w_22 = 1.0/w_22
    w_23 = freq_y*freq_y*inv_w_22
    J_y_w_23 = J_y*w_23
    w_24 = 2.0*freq_y*inv_w_22*zeta_y
    J_y_w_24 = J_y*w_24
    w_25 = 3.0*inv_w_22*w0_sq*(I_x + w)
    inv_I_wx = 1.0/I_wx
    I_wy_nominal_speed = I_wy*nominal_speed
    I_wy_w0 = I_wy*w0
    w_27 = inv_I_wx*(2.0*I_wx*w0 - I_wy_nominal_speed - I_wy_w0)
    I_wx_I_wy_nominal_speed = I_wx*I_wy_nominal_speed
    w_28 = I_wx_I_wy_nominal_speed*w0
    I_wy_nominal_speed_J_x = I_wy_nominal_speed*J_x
    I_wx_w0_sq = I_wx*w0_sq
    I_wx_w0_sq_I_wy = I_wx_w0_sq*I_wy
    I_wy_w0_sq = I_wy*w0_sq
    I_wx_sq = I_wx*I_wx
    inv_I_wx_inv_w_6 = inv_I_wx*inv_w_6
    w_29 = inv_I_wx_inv_w_6*(4.0*I_wx*J_x*w0_sq + 4.0*I_wx_sq*w0_sq + I_wy*I_x*nominal_speed*w0 + 4.0*I_wy*I_x*w0_sq + I_x*K_x - 4.0*I_wx_w0_sq*I_x - 4.0*I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_x*w0 - 4.0*I_wy_w0_sq*J_x - J_x*K_x - w_28)
    w_30 = I_x - J_x
    inv_I_wx_inv_w_6_w_30 = inv_I_wx_inv_w_6*w_30
    I_wx_w0 = I_wx*w0
    I_wx_w0_I_x = I_wx_w0*I_x
    I_wy_w0_J_x = I_wy_w0*J_x
    I_wx_w0_I_z = I_wx_w0*I_z
    I_wx_w0_J_x = I_wx_w0*J_x
    I_wy_w0_I_x = I_wy_w0*I_x
    I_wx_w0_I_y = I_wx_w0*I_y
    w_31 = I_wx_I_wy_nominal_speed + I_wx_w0_I_y
    w_32 = I_wy_nominal_speed_J_x - I_wy_nominal_speed*I_x
    w_33 = inv_I_wx_inv_w_6*(I_wx_w0_I_x + I_wy_w0_J_x + w_31 + w_32 - I_wx_w0_I_z - I_wx_w0_J_x - I_wy_w0_I_x)
    w_34 = D_x_inv_w_6*inv_I_wx*w_30
    w_35 = inv_I_wx*inv_w_6_w0*(I_wx_I_wy_nominal_speed + 4.0*I_wx_w0_I_x + 4.0*I_wx_w0_I_y + 4.0*I_wy_w0_J_x + w_32 - 4.0*I_wx_w0_I_z - 4.0*I_wx_w0_J_x - 4.0*I_wy_w0_I_x)
    I_wy_nominal_speed_J_z = I_wy_nominal_speed*J_z
    inv_I_wx_inv_w_14 = inv_I_wx*inv_w_14
    w_36 = inv_I_wx_inv_w_14*(I_wx*J_z*w0_sq + I_wx_sq*w0_sq + I_wy*I_z*nominal_speed*w0 + I_wy*I_z*w0_sq + I_z*K_z - I_wx_w0_sq*I_z - I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_z*w0 - I_wy_w0_sq*J_z - J_z*K_z - w_28)
    w_37 = I_z - J_z
    inv_I_wx_inv_w_14_w_37 = inv_I_wx_inv_w_14*w_37
    w_38 = I_wx*I_x*w0 + I_wx*J_z*w0 + I_wy*I_z*nominal_speed + I_wy*I_z*w0 - I_wx_w0_I_z - I_wy_nominal_speed_J_z - I_wy_w0*J_z - w_31
    inv_I_wx_inv_w_14_w_38 = inv_I_wx_inv_w_14*w_38
    w_39 = D_z_inv_w_14*inv_I_wx*w_37
    w_40 = inv_I_wx*inv_w_14_w0*w_38
    w_11_w_5 = w_11*w_5
    inv_w_6_w0_w_9 = inv_w_6_w0*w_9
    w_12_w_5 = w_12*w_5
    w_21_w_23 = w_21*w_23
    w_21_w_24 = w_21*w_24
    inv_w_14_w0_w_16 = inv_w_14_w0*w_16
    w_17_w_8 = w_17*w_8
    w_18_w_8 = w_18*w_8
    inv_I_wy = 1.0/I_wy
    w_41 = inv_I_wy*inv_w_22*(I_y - J_y)
    steps = len(times) - 1
    t = times[0]
    phi_at[0] = phi
    psi_at[0] = psi
    theta_at[0] = theta
    g_x_at[0] = g_x
    g_z_at[0] = g_z
    eta_x_at[0] = eta_x
    eta_y_at[0] = eta_y
    eta_z_at[0] = eta_z
    phi_dot_at[0] = phi_dot
    psi_dot_at[0] = psi_dot
    theta_dot_at[0] = theta_dot
    g_x_dot_at[0] = g_x_dot
    g_z_dot_at[0] = g_z_dot
    eta_x_dot_at[0] = eta_x_dot
    eta_y_dot_at[0] = eta_y_dot
    eta_z_dot_at[0] = eta_z_dot
    wheel_speed_at[0] = wheel_speed
    T_cx = T_cx_at[0]
    T_cz = T_cz_at[0]
    motor_torque = motor_torque_at[0]
    D_x_inv_w_6_g_x_dot = D_x_inv_w_6*g_x_dot
    K_x_inv_w_6_g_x = K_x_inv_w_6*g_x
    T_cx_inv_w_6 = T_cx*inv_w_6
    phi_w_10 = phi*w_10
    J_z_inv_w_6_w0_eta_z_dot = J_z_inv_w_6_w0*eta_z_dot
    w_13 = J_x_w_11*eta_x + J_x_w_12*eta_x_dot + J_z_inv_w_6_w0_eta_z_dot
    K_z_inv_w_14_g_z = K_z_inv_w_14*g_z
    D_z_inv_w_14_g_z_dot = D_z_inv_w_14*g_z_dot
    T_cz_inv_w_14 = T_cz*inv_w_14
    inv_w_14_w0_sq_w_16_psi = inv_w_14_w0_sq_w_16*psi
    w_19 = J_x_inv_w_14_w0*eta_x_dot
    w_20 = J_z_w_17*eta_z + J_z_w_18*eta_z_dot - w_19
    inv_w_22_motor_torque = inv_w_22*motor_torque
    theta_w_25 = theta*w_25
    w_26 = J_y_w_23*eta_y + J_y_w_24*eta_y_dot - theta_w_25
    slope_phi_dot = T_cx_inv_w_6 + phi_w_10 + psi_dot*w_7 - D_x_inv_w_6_g_x_dot - K_x_inv_w_6_g_x - w_13
    slope_psi_dot = T_cz_inv_w_14 + inv_w_14_w0_sq_w_16_psi - D_z_inv_w_14_g_z_dot - K_z_inv_w_14_g_z - phi_dot*w_15 - w_20
    slope_theta_dot = -inv_w_22_motor_torque - w_26
    slope_g_x_dot = g_x*w_29 + g_x_dot*w_34 + g_z_dot*w_27 + w_13 - T_cx*inv_I_wx_inv_w_6_w_30 - phi*w_35 - psi_dot*w_33
    slope_g_z_dot = g_z*w_36 + g_z_dot*w_39 + psi*w_40 + w_20 - T_cz*inv_I_wx_inv_w_14_w_37 - g_x_dot*w_27 - inv_I_wx_inv_w_14_w_38*phi_dot
    slope_eta_x_dot = D_x_inv_w_6_g_x_dot + J_z_inv_w_6_w0_eta_z_dot + K_x_inv_w_6_g_x - T_cx_inv_w_6 - eta_x*w_11_w_5 - eta_x_dot*w_12_w_5 - inv_w_6_w0_w_9*psi_dot - phi_w_10
    slope_eta_y_dot = inv_w_22_motor_torque - eta_y*w_21_w_23 - eta_y_dot*w_21_w_24 - theta_w_25
    slope_eta_z_dot = D_z_inv_w_14_g_z_dot + K_z_inv_w_14_g_z + inv_w_14_w0_w_16*phi_dot - T_cz_inv_w_14 - eta_z*w_17_w_8 - eta_z_dot*w_18_w_8 - inv_w_14_w0_sq_w_16_psi - w_19
    slope_wheel_speed = -motor_torque*w_41 - w_26
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        phi_at[i] = phi
        psi_at[i] = psi
        theta_at[i] = theta
        g_x_at[i] = g_x
        g_z_at[i] = g_z
        eta_x_at[i] = eta_x
        eta_y_at[i] = eta_y
        eta_z_at[i] = eta_z
        phi_dot_at[i] = phi_dot
        psi_dot_at[i] = psi_dot
        theta_dot_at[i] = theta_dot
        g_x_dot_at[i] = g_x_dot
        g_z_dot_at[i] = g_z_dot
        eta_x_dot_at[i] = eta_x_dot
        eta_y_dot_at[i] = eta_y_dot
        eta_z_dot_at[i] = eta_z_dot
        wheel_speed_at[i] = wheel_speed
        T_cx_half = T_cx_mid[i]
        T_cx_end = T_cx_at[i + 1]
        T_cz_half = T_cz_mid[i]
        T_cz_end = T_cz_at[i + 1]
        motor_torque_half = motor_torque_mid[i]
        motor_torque_end = motor_torque_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        phi_2 = half*phi_dot + phi
        psi_2 = half*psi_dot + psi
        theta_2 = half*theta_dot + theta
        g_x_2 = g_x + g_x_dot*half
        g_z_2 = g_z + g_z_dot*half
        eta_x_2 = eta_x + eta_x_dot*half
        eta_y_2 = eta_y + eta_y_dot*half
        eta_z_2 = eta_z + eta_z_dot*half
        phi_dot_2 = half*slope_phi_dot + phi_dot
        psi_dot_2 = half*slope_psi_dot + psi_dot
        theta_dot_2 = half*slope_theta_dot + theta_dot
        g_x_dot_2 = g_x_dot + half*slope_g_x_dot
        g_z_dot_2 = g_z_dot + half*slope_g_z_dot
        eta_x_dot_2 = eta_x_dot + half*slope_eta_x_dot
        eta_y_dot_2 = eta_y_dot + half*slope_eta_y_dot
        eta_z_dot_2 = eta_z_dot + half*slope_eta_z_dot
        D_x_inv_w_6_g_x_dot_2 = D_x_inv_w_6*g_x_dot_2
        K_x_inv_w_6_g_x_2 = K_x_inv_w_6*g_x_2
        T_cx_half_inv_w_6 = T_cx_half*inv_w_6
        phi_2_w_10 = phi_2*w_10
        w_42 = J_z_inv_w_6_w0*eta_z_dot_2
        w_43 = J_x_w_11*eta_x_2 + J_x_w_12*eta_x_dot_2 + w_42
        K_z_inv_w_14_g_z_2 = K_z_inv_w_14*g_z_2
        D_z_inv_w_14_g_z_dot_2 = D_z_inv_w_14*g_z_dot_2
        T_cz_half_inv_w_14 = T_cz_half*inv_w_14
        w_44 = inv_w_14_w0_sq_w_16*psi_2
        w_45 = J_x_inv_w_14_w0*eta_x_dot_2
        w_46 = J_z_w_17*eta_z_2 + J_z_w_18*eta_z_dot_2 - w_45
        w_47 = inv_w_22*motor_torque_half
        theta_2_w_25 = theta_2*w_25
        w_48 = J_y_w_23*eta_y_2 + J_y_w_24*eta_y_dot_2 - theta_2_w_25
        k2_phi_dot = T_cx_half_inv_w_6 + phi_2_w_10 + psi_dot_2*w_7 - D_x_inv_w_6_g_x_dot_2 - K_x_inv_w_6_g_x_2 - w_43
        k2_psi_dot = T_cz_half_inv_w_14 + w_44 - D_z_inv_w_14_g_z_dot_2 - K_z_inv_w_14_g_z_2 - phi_dot_2*w_15 - w_46
        k2_theta_dot = -w_47 - w_48
        k2_g_x_dot = g_x_2*w_29 + g_x_dot_2*w_34 + g_z_dot_2*w_27 + w_43 - T_cx_half*inv_I_wx_inv_w_6_w_30 - phi_2*w_35 - psi_dot_2*w_33
        k2_g_z_dot = g_z_2*w_36 + g_z_dot_2*w_39 + psi_2*w_40 + w_46 - T_cz_half*inv_I_wx_inv_w_14_w_37 - g_x_dot_2*w_27 - inv_I_wx_inv_w_14_w_38*phi_dot_2
        k2_eta_x_dot = D_x_inv_w_6_g_x_dot_2 + K_x_inv_w_6_g_x_2 + w_42 - T_cx_half_inv_w_6 - eta_x_2*w_11_w_5 - eta_x_dot_2*w_12_w_5 - inv_w_6_w0_w_9*psi_dot_2 - phi_2_w_10
        k2_eta_y_dot = w_47 - eta_y_2*w_21_w_23 - eta_y_dot_2*w_21_w_24 - theta_2_w_25
        k2_eta_z_dot = D_z_inv_w_14_g_z_dot_2 + K_z_inv_w_14_g_z_2 + inv_w_14_w0_w_16*phi_dot_2 - T_cz_half_inv_w_14 - eta_z_2*w_17_w_8 - eta_z_dot_2*w_18_w_8 - w_44 - w_45
        k2_wheel_speed = -motor_torque_half*w_41 - w_48
        phi_3 = half*phi_dot_2 + phi
        psi_3 = half*psi_dot_2 + psi
        theta_3 = half*theta_dot_2 + theta
        g_x_3 = g_x + g_x_dot_2*half
        g_z_3 = g_z + g_z_dot_2*half
        eta_x_3 = eta_x + eta_x_dot_2*half
        eta_y_3 = eta_y + eta_y_dot_2*half
        eta_z_3 = eta_z + eta_z_dot_2*half
        phi_dot_3 = half*k2_phi_dot + phi_dot
        psi_dot_3 = half*k2_psi_dot + psi_dot
        theta_dot_3 = half*k2_theta_dot + theta_dot
        g_x_dot_3 = g_x_dot + half*k2_g_x_dot
        g_z_dot_3 = g_z_dot + half*k2_g_z_dot
        eta_x_dot_3 = eta_x_dot + half*k2_eta_x_dot
        eta_y_dot_3 = eta_y_dot + half*k2_eta_y_dot
        eta_z_dot_3 = eta_z_dot + half*k2_eta_z_dot
        D_x_inv_w_6_g_x_dot_3 = D_x_inv_w_6*g_x_dot_3
        K_x_inv_w_6_g_x_3 = K_x_inv_w_6*g_x_3
        phi_3_w_10 = phi_3*w_10
        w_49 = J_z_inv_w_6_w0*eta_z_dot_3
        w_50 = J_x_w_11*eta_x_3 + J_x_w_12*eta_x_dot_3 + w_49
        K_z_inv_w_14_g_z_3 = K_z_inv_w_14*g_z_3
        D_z_inv_w_14_g_z_dot_3 = D_z_inv_w_14*g_z_dot_3
        w_51 = inv_w_14_w0_sq_w_16*psi_3
        w_52 = J_x_inv_w_14_w0*eta_x_dot_3
        w_53 = J_z_w_17*eta_z_3 + J_z_w_18*eta_z_dot_3 - w_52
        theta_3_w_25 = theta_3*w_25
        w_54 = J_y_w_23*eta_y_3 + J_y_w_24*eta_y_dot_3 - theta_3_w_25
        k3_phi_dot = T_cx_half_inv_w_6 + phi_3_w_10 + psi_dot_3*w_7 - D_x_inv_w_6_g_x_dot_3 - K_x_inv_w_6_g_x_3 - w_50
        k3_psi_dot = T_cz_half_inv_w_14 + w_51 - D_z_inv_w_14_g_z_dot_3 - K_z_inv_w_14_g_z_3 - phi_dot_3*w_15 - w_53
        k3_theta_dot = -w_47 - w_54
        k3_g_x_dot = g_x_3*w_29 + g_x_dot_3*w_34 + g_z_dot_3*w_27 + w_50 - T_cx_half*inv_I_wx_inv_w_6_w_30 - phi_3*w_35 - psi_dot_3*w_33
        k3_g_z_dot = g_z_3*w_36 + g_z_dot_3*w_39 + psi_3*w_40 + w_53 - T_cz_half*inv_I_wx_inv_w_14_w_37 - g_x_dot_3*w_27 - inv_I_wx_inv_w_14_w_38*phi_dot_3
        k3_eta_x_dot = D_x_inv_w_6_g_x_dot_3 + K_x_inv_w_6_g_x_3 + w_49 - T_cx_half_inv_w_6 - eta_x_3*w_11_w_5 - eta_x_dot_3*w_12_w_5 - inv_w_6_w0_w_9*psi_dot_3 - phi_3_w_10
        k3_eta_y_dot = w_47 - eta_y_3*w_21_w_23 - eta_y_dot_3*w_21_w_24 - theta_3_w_25
        k3_eta_z_dot = D_z_inv_w_14_g_z_dot_3 + K_z_inv_w_14_g_z_3 + inv_w_14_w0_w_16*phi_dot_3 - T_cz_half_inv_w_14 - eta_z_3*w_17_w_8 - eta_z_dot_3*w_18_w_8 - w_51 - w_52
        k3_wheel_speed = -motor_torque_half*w_41 - w_54
        phi_4 = h*phi_dot_3 + phi
        psi_4 = h*psi_dot_3 + psi
        theta_4 = h*theta_dot_3 + theta
        g_x_4 = g_x + g_x_dot_3*h
        g_z_4 = g_z + g_z_dot_3*h
        eta_x_4 = eta_x + eta_x_dot_3*h
        eta_y_4 = eta_y + eta_y_dot_3*h
        eta_z_4 = eta_z + eta_z_dot_3*h
        phi_dot_4 = h*k3_phi_dot + phi_dot
        psi_dot_4 = h*k3_psi_dot + psi_dot
        g_x_dot_4 = g_x_dot + h*k3_g_x_dot
        g_z_dot_4 = g_z_dot + h*k3_g_z_dot
        eta_x_dot_4 = eta_x_dot + h*k3_eta_x_dot
        eta_y_dot_4 = eta_y_dot + h*k3_eta_y_dot
        eta_z_dot_4 = eta_z_dot + h*k3_eta_z_dot
        D_x_inv_w_6_g_x_dot_4 = D_x_inv_w_6*g_x_dot_4
        K_x_inv_w_6_g_x_4 = K_x_inv_w_6*g_x_4
        T_cx_end_inv_w_6 = T_cx_end*inv_w_6
        phi_4_w_10 = phi_4*w_10
        w_55 = J_z_inv_w_6_w0*eta_z_dot_4
        w_56 = J_x_w_11*eta_x_4 + J_x_w_12*eta_x_dot_4 + w_55
        K_z_inv_w_14_g_z_4 = K_z_inv_w_14*g_z_4
        D_z_inv_w_14_g_z_dot_4 = D_z_inv_w_14*g_z_dot_4
        T_cz_end_inv_w_14 = T_cz_end*inv_w_14
        w_57 = inv_w_14_w0_sq_w_16*psi_4
        w_58 = J_x_inv_w_14_w0*eta_x_dot_4
        w_59 = J_z_w_17*eta_z_4 + J_z_w_18*eta_z_dot_4 - w_58
        w_60 = inv_w_22*motor_torque_end
        theta_4_w_25 = theta_4*w_25
        w_61 = J_y_w_23*eta_y_4 + J_y_w_24*eta_y_dot_4 - theta_4_w_25
        k4_phi_dot = T_cx_end_inv_w_6 + phi_4_w_10 + psi_dot_4*w_7 - D_x_inv_w_6_g_x_dot_4 - K_x_inv_w_6_g_x_4 - w_56
        k4_psi_dot = T_cz_end_inv_w_14 + w_57 - D_z_inv_w_14_g_z_dot_4 - K_z_inv_w_14_g_z_4 - phi_dot_4*w_15 - w_59
        k4_theta_dot = -w_60 - w_61
        k4_g_x_dot = g_x_4*w_29 + g_x_dot_4*w_34 + g_z_dot_4*w_27 + w_56 - T_cx_end*inv_I_wx_inv_w_6_w_30 - phi_4*w_35 - psi_dot_4*w_33
        k4_g_z_dot = g_z_4*w_36 + g_z_dot_4*w_39 + psi_4*w_40 + w_59 - T_cz_end*inv_I_wx_inv_w_14_w_37 - g_x_dot_4*w_27 - inv_I_wx_inv_w_14_w_38*phi_dot_4
        k4_eta_x_dot = D_x_inv_w_6_g_x_dot_4 + K_x_inv_w_6_g_x_4 + w_55 - T_cx_end_inv_w_6 - eta_x_4*w_11_w_5 - eta_x_dot_4*w_12_w_5 - inv_w_6_w0_w_9*psi_dot_4 - phi_4_w_10
        k4_eta_y_dot = w_60 - eta_y_4*w_21_w_23 - eta_y_dot_4*w_21_w_24 - theta_4_w_25
        k4_eta_z_dot = D_z_inv_w_14_g_z_dot_4 + K_z_inv_w_14_g_z_4 + inv_w_14_w0_w_16*phi_dot_4 - T_cz_end_inv_w_14 - eta_z_4*w_17_w_8 - eta_z_dot_4*w_18_w_8 - w_57 - w_58
        k4_wheel_speed = -motor_torque_end*w_41 - w_61
        k23_phi_dot = k2_phi_dot + k3_phi_dot
        k123_phi_dot = k23_phi_dot + slope_phi_dot
        k23_psi_dot = k2_psi_dot + k3_psi_dot
        k123_psi_dot = k23_psi_dot + slope_psi_dot
        k23_theta_dot = k2_theta_dot + k3_theta_dot
        k123_theta_dot = k23_theta_dot + slope_theta_dot
        k23_g_x_dot = k2_g_x_dot + k3_g_x_dot
        k123_g_x_dot = k23_g_x_dot + slope_g_x_dot
        k23_g_z_dot = k2_g_z_dot + k3_g_z_dot
        k123_g_z_dot = k23_g_z_dot + slope_g_z_dot
        k23_eta_x_dot = k2_eta_x_dot + k3_eta_x_dot
        k123_eta_x_dot = k23_eta_x_dot + slope_eta_x_dot
        k23_eta_y_dot = k2_eta_y_dot + k3_eta_y_dot
        k123_eta_y_dot = k23_eta_y_dot + slope_eta_y_dot
        k23_eta_z_dot = k2_eta_z_dot + k3_eta_z_dot
        k123_eta_z_dot = k23_eta_z_dot + slope_eta_z_dot
        phi_end = h*(k123_phi_dot*sixth + phi_dot) + phi
        psi_end = h*(k123_psi_dot*sixth + psi_dot) + psi
        theta_end = h*(k123_theta_dot*sixth + theta_dot) + theta
        g_x_end = g_x + h*(g_x_dot + k123_g_x_dot*sixth)
        g_z_end = g_z + h*(g_z_dot + k123_g_z_dot*sixth)
        eta_x_end = eta_x + h*(eta_x_dot + k123_eta_x_dot*sixth)
        eta_y_end = eta_y + h*(eta_y_dot + k123_eta_y_dot*sixth)
        eta_z_end = eta_z + h*(eta_z_dot + k123_eta_z_dot*sixth)
        phi_dot_end = phi_dot + sixth*(k123_phi_dot + k23_phi_dot + k4_phi_dot)
        psi_dot_end = psi_dot + sixth*(k123_psi_dot + k23_psi_dot + k4_psi_dot)
        theta_dot_end = sixth*(k123_theta_dot + k23_theta_dot + k4_theta_dot) + theta_dot
        g_x_dot_end = g_x_dot + sixth*(k123_g_x_dot + k23_g_x_dot + k4_g_x_dot)
        g_z_dot_end = g_z_dot + sixth*(k123_g_z_dot + k23_g_z_dot + k4_g_z_dot)
        eta_x_dot_end = eta_x_dot + sixth*(k123_eta_x_dot + k23_eta_x_dot + k4_eta_x_dot)
        eta_y_dot_end = eta_y_dot + sixth*(k123_eta_y_dot + k23_eta_y_dot + k4_eta_y_dot)
        eta_z_dot_end = eta_z_dot + sixth*(k123_eta_z_dot + k23_eta_z_dot + k4_eta_z_dot)
        wheel_speed_end = sixth*(k4_wheel_speed + slope_wheel_speed + 2.0*(k2_wheel_speed + k3_wheel_speed)) + wheel_speed
        D_x_inv_w_6_g_x_dot_end = D_x_inv_w_6*g_x_dot_end
        K_x_inv_w_6_g_x_end = K_x_inv_w_6*g_x_end
        phi_end_w_10 = phi_end*w_10
        w_62 = J_z_inv_w_6_w0*eta_z_dot_end
        w_63 = J_x_w_11*eta_x_end + J_x_w_12*eta_x_dot_end + w_62
        K_z_inv_w_14_g_z_end = K_z_inv_w_14*g_z_end
        D_z_inv_w_14_g_z_dot_end = D_z_inv_w_14*g_z_dot_end
        w_64 = inv_w_14_w0_sq_w_16*psi_end
        w_65 = J_x_inv_w_14_w0*eta_x_dot_end
        w_66 = J_z_w_17*eta_z_end + J_z_w_18*eta_z_dot_end - w_65
        theta_end_w_25 = theta_end*w_25
        w_67 = J_y_w_23*eta_y_end + J_y_w_24*eta_y_dot_end - theta_end_w_25
        slope_end_phi_dot = T_cx_end_inv_w_6 + phi_end_w_10 + psi_dot_end*w_7 - D_x_inv_w_6_g_x_dot_end - K_x_inv_w_6_g_x_end - w_63
        slope_end_psi_dot = T_cz_end_inv_w_14 + w_64 - D_z_inv_w_14_g_z_dot_end - K_z_inv_w_14_g_z_end - phi_dot_end*w_15 - w_66
        slope_end_theta_dot = -w_60 - w_67
        slope_end_g_x_dot = g_x_dot_end*w_34 + g_x_end*w_29 + g_z_dot_end*w_27 + w_63 - T_cx_end*inv_I_wx_inv_w_6_w_30 - phi_end*w_35 - psi_dot_end*w_33
        slope_end_g_z_dot = g_z_dot_end*w_39 + g_z_end*w_36 + psi_end*w_40 + w_66 - T_cz_end*inv_I_wx_inv_w_14_w_37 - g_x_dot_end*w_27 - inv_I_wx_inv_w_14_w_38*phi_dot_end
        slope_end_eta_x_dot = D_x_inv_w_6_g_x_dot_end + K_x_inv_w_6_g_x_end + w_62 - T_cx_end_inv_w_6 - eta_x_dot_end*w_12_w_5 - eta_x_end*w_11_w_5 - inv_w_6_w0_w_9*psi_dot_end - phi_end_w_10
        slope_end_eta_y_dot = w_60 - eta_y_dot_end*w_21_w_24 - eta_y_end*w_21_w_23 - theta_end_w_25
        slope_end_eta_z_dot = D_z_inv_w_14_g_z_dot_end + K_z_inv_w_14_g_z_end + inv_w_14_w0_w_16*phi_dot_end - T_cz_end_inv_w_14 - eta_z_dot_end*w_18_w_8 - eta_z_end*w_17_w_8 - w_64 - w_65
        slope_end_wheel_speed = -motor_torque_end*w_41 - w_67
        eighth = 0.125*h
        phi_mid[i] = eighth*(phi_dot - phi_dot_end) + 0.5*(phi + phi_end)
        psi_mid[i] = eighth*(psi_dot - psi_dot_end) + 0.5*(psi + psi_end)
        theta_mid[i] = eighth*(theta_dot - theta_dot_end) + 0.5*(theta + theta_end)
        g_x_mid[i] = eighth*(g_x_dot - g_x_dot_end) + 0.5*(g_x + g_x_end)
        g_z_mid[i] = eighth*(g_z_dot - g_z_dot_end) + 0.5*(g_z + g_z_end)
        eta_x_mid[i] = eighth*(eta_x_dot - eta_x_dot_end) + 0.5*(eta_x + eta_x_end)
        eta_y_mid[i] = eighth*(eta_y_dot - eta_y_dot_end) + 0.5*(eta_y + eta_y_end)
        eta_z_mid[i] = eighth*(eta_z_dot - eta_z_dot_end) + 0.5*(eta_z + eta_z_end)
        phi_dot_mid[i] = eighth*(slope_phi_dot - slope_end_phi_dot) + 0.5*(phi_dot + phi_dot_end)
        psi_dot_mid[i] = eighth*(slope_psi_dot - slope_end_psi_dot) + 0.5*(psi_dot + psi_dot_end)
        theta_dot_mid[i] = eighth*(slope_theta_dot - slope_end_theta_dot) + 0.5*(theta_dot + theta_dot_end)
        g_x_dot_mid[i] = eighth*(slope_g_x_dot - slope_end_g_x_dot) + 0.5*(g_x_dot + g_x_dot_end)
        g_z_dot_mid[i] = eighth*(slope_g_z_dot - slope_end_g_z_dot) + 0.5*(g_z_dot + g_z_dot_end)
        eta_x_dot_mid[i] = eighth*(slope_eta_x_dot - slope_end_eta_x_dot) + 0.5*(eta_x_dot + eta_x_dot_end)
        eta_y_dot_mid[i] = eighth*(slope_eta_y_dot - slope_end_eta_y_dot) + 0.5*(eta_y_dot + eta_y_dot_end)
        eta_z_dot_mid[i] = eighth*(slope_eta_z_dot - slope_end_eta_z_dot) + 0.5*(eta_z_dot + eta_z_dot_end)
        wheel_speed_mid[i] = eighth*(slope_wheel_speed - slope_end_wheel_speed) + 0.5*(wheel_speed + wheel_speed_end)
        t = t_end
        phi = phi_end
        psi = psi_end
        theta = theta_end
        g_x = g_x_end
        g_z = g_z_end
        eta_x = eta_x_end
        eta_y = eta_y_end
        eta_z = eta_z_end
        phi_dot = phi_dot_end
        psi_dot = psi_dot_end
        theta_dot = theta_dot_end
        g_x_dot = g_x_dot_end
        g_z_dot = g_z_dot_end
        eta_x_dot = eta_x_dot_end
        eta_y_dot = eta_y_dot_end
        eta_z_dot = eta_z_dot_end
        wheel_speed = wheel_speed_end
        slope_phi_dot = slope_end_phi_dot
        slope_psi_dot = slope_end_psi_dot
        slope_theta_dot = slope_end_theta_dot
        slope_g_x_dot = slope_end_g_x_dot
        slope_g_z_dot = slope_end_g_z_dot
        slope_eta_x_dot = slope_end_eta_x_dot
        slope_eta_y_dot = slope_end_eta_y_dot
        slope_eta_z_dot = slope_end_eta_z_dot
        slope_wheel_speed = slope_end_wheel_speed
    phi_at[steps] = phi
    psi_at[steps] = psi
    theta_at[steps] = theta
    g_x_at[steps] = g_x
    g_z_at[steps] = g_z
    eta_x_at[steps] = eta_x
    eta_y_at[steps] = eta_y
    eta_z_at[steps] = eta_z
    phi_dot_at[steps] = phi_dot
    psi_dot_at[steps] = psi_dot
    theta_dot_at[steps] = theta_dot
    g_x_dot_at[steps] = g_x_dot
    g_z_dot_at[steps] = g_z_dot
    eta_x_dot_at[steps] = eta_x_dot
    eta_y_dot_at[steps] = eta_y_dot
    eta_z_dot_at[steps] = eta_z_dot
    wheel_speed_at[steps] = wheel_speed


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, phi_dot, psi_dot, theta_dot, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((17, *shape), np.result_type(float, t, x, u, *p))
    w = -I_x
    w_2 = I_wx + w
    w_3 = J_x + w_2
    inv_w_3 = 1.0/w_3
    w_4 = -I_z
    w_5 = I_y - I_wy
    w_6 = 2.0*I_wx + w + w_4 + w_5
    w0_sq = w0*w0
    w_7 = I_wx + w_4
    w_8 = w_5 + w_7
    w_9 = 4.0*inv_w_3*phi*w0_sq*w_8
    J_x_inv_w_3 = J_x*inv_w_3
    w_10 = eta_x*freq_x*freq_x
    inv_w_3_w0 = inv_w_3*w0
    J_z_eta_z_dot = J_z*eta_z_dot
    J_z_eta_z_dot_inv_w_3_w0 = J_z_eta_z_dot*inv_w_3_w0
    w_11 = 2.0*eta_x_dot*freq_x*zeta_x
    w_12 = J_x_inv_w_3*w_10 + J_x_inv_w_3*w_11 + J_z_eta_z_dot_inv_w_3_w0
    T_cx_inv_w_3 = T_cx*inv_w_3
    D_x_g_x_dot_inv_w_3 = D_x*g_x_dot*inv_w_3
    g_x_inv_w_3 = g_x*inv_w_3
    K_x_g_x_inv_w_3 = K_x*g_x_inv_w_3
    w_13 = J_z + w_7
    inv_w_13 = 1.0/w_13
    T_cz_inv_w_13 = T_cz*inv_w_13
    D_z_g_z_dot_inv_w_13 = D_z*g_z_dot*inv_w_13
    g_z_inv_w_13 = g_z*inv_w_13
    K_z_g_z_inv_w_13 = K_z*g_z_inv_w_13
    inv_w_13_w0 = inv_w_13*w0
    w_14 = w_2 + w_5
    inv_w_13_psi_w0_sq_w_14 = inv_w_13*psi*w0_sq*w_14
    w_15 = eta_z*freq_z*freq_z*inv_w_13
    w_16 = J_x*eta_x_dot*inv_w_13_w0
    w_17 = 2.0*freq_z*inv_w_13*zeta_z
    w_18 = J_z*w_15 + J_z_eta_z_dot*w_17 - w_16
    w_19 = I_wy - I_y
    w_20 = J_y + w_19
    inv_w_20 = 1.0/w_20
    inv_w_20_motor_torque = inv_w_20*motor_torque
    J_y_inv_w_20 = J_y*inv_w_20
    w_21 = eta_y*freq_y*freq_y
    w_22 = 3.0*inv_w_20*theta*w0_sq*(I_x + w_4)
    w_23 = 2.0*eta_y_dot*freq_y*zeta_y
    w_24 = J_y_inv_w_20*w_21 + J_y_inv_w_20*w_23 - w_22
    inv_I_wx = 1.0/I_wx
    I_wy_nominal_speed = I_wy*nominal_speed
    I_wy_w0 = I_wy*w0
    w_25 = inv_I_wx*(2.0*I_wx*w0 - I_wy_nominal_speed - I_wy_w0)
    I_wx_I_wy_nominal_speed = I_wx*I_wy_nominal_speed
    w_26 = I_wx_I_wy_nominal_speed*w0
    I_wy_nominal_speed_J_x = I_wy_nominal_speed*J_x
    I_wx_w0_sq = I_wx*w0_sq
    I_wx_w0_sq_I_wy = I_wx_w0_sq*I_wy
    I_wy_w0_sq = I_wy*w0_sq
    I_wx_sq = I_wx*I_wx
    w_27 = inv_I_wx*(I_x - J_x)
    I_wx_w0 = I_wx*w0
    I_wx_w0_I_x = I_wx_w0*I_x
    I_wy_w0_J_x = I_wy_w0*J_x
    I_wx_w0_I_z = I_wx_w0*I_z
    I_wx_w0_J_x = I_wx_w0*J_x
    I_wy_w0_I_x = I_wy_w0*I_x
    I_wx_w0_I_y = I_wx_w0*I_y
    w_28 = I_wx_I_wy_nominal_speed + I_wx_w0_I_y
    w_29 = I_wy_nominal_speed_J_x - I_wy_nominal_speed*I_x
    I_wy_nominal_speed_J_z = I_wy_nominal_speed*J_z
    w_30 = inv_I_wx*(I_z - J_z)
    w_31 = inv_I_wx*(I_wx*I_x*w0 + I_wx*J_z*w0 + I_wy*I_z*nominal_speed + I_wy*I_z*w0 - I_wx_w0_I_z - I_wy_nominal_speed_J_z - I_wy_w0*J_z - w_28)
    inv_w_3_w_2 = inv_w_3*w_2
    inv_w_20_w_19 = inv_w_20*w_19
    inv_I_wy = 1.0/I_wy
    out[0] = phi_dot
    out[1] = psi_dot
    out[2] = theta_dot
    out[3] = g_x_dot
    out[4] = g_z_dot
    out[5] = eta_x_dot
    out[6] = eta_y_dot
    out[7] = eta_z_dot
    out[8] = T_cx_inv_w_3 + inv_w_3*psi_dot*w0*(J_x + w_6) + w_9 - D_x_g_x_dot_inv_w_3 - K_x_g_x_inv_w_3 - w_12
    out[9] = T_cz_inv_w_13 + inv_w_13_psi_w0_sq_w_14 - D_z_g_z_dot_inv_w_13 - K_z_g_z_inv_w_13 - inv_w_13_w0*phi_dot*(J_z + w_6) - w_18
    out[10] = -inv_w_20_motor_torque - w_24
    out[11] = D_x_g_x_dot_inv_w_3*w_27 + g_x_inv_w_3*inv_I_wx*(4.0*I_wx*J_x*w0_sq + 4.0*I_wx_sq*w0_sq + I_wy*I_x*nominal_speed*w0 + 4.0*I_wy*I_x*w0_sq + I_x*K_x - 4.0*I_wx_w0_sq*I_x - 4.0*I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_x*w0 - 4.0*I_wy_w0_sq*J_x - J_x*K_x - w_26) + g_z_dot*w_25 + w_12 - T_cx_inv_w_3*w_27 - inv_I_wx*inv_w_3*psi_dot*(I_wx_w0_I_x + I_wy_w0_J_x + w_28 + w_29 - I_wx_w0_I_z - I_wx_w0_J_x - I_wy_w0_I_x) - inv_I_wx*inv_w_3_w0*phi*(I_wx_I_wy_nominal_speed + 4.0*I_wx_w0_I_x + 4.0*I_wx_w0_I_y + 4.0*I_wy_w0_J_x + w_29 - 4.0*I_wx_w0_I_z - 4.0*I_wx_w0_J_x - 4.0*I_wy_w0_I_x)
    out[12] = D_z_g_z_dot_inv_w_13*w_30 + g_z_inv_w_13*inv_I_wx*(I_wx*J_z*w0_sq + I_wx_sq*w0_sq + I_wy*I_z*nominal_speed*w0 + I_wy*I_z*w0_sq + I_z*K_z - I_wx_w0_sq*I_z - I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_z*w0 - I_wy_w0_sq*J_z - J_z*K_z - w_26) + inv_w_13_w0*psi*w_31 + w_18 - T_cz_inv_w_13*w_30 - g_x_dot*w_25 - inv_w_13*phi_dot*w_31
    out[13] = D_x_g_x_dot_inv_w_3 + J_z_eta_z_dot_inv_w_3_w0 + K_x_g_x_inv_w_3 - T_cx_inv_w_3 - inv_w_3_w0*psi_dot*w_8 - inv_w_3_w_2*w_10 - inv_w_3_w_2*w_11 - w_9
    out[14] = inv_w_20_motor_torque - inv_w_20_w_19*w_21 - inv_w_20_w_19*w_23 - w_22
    out[15] = D_z_g_z_dot_inv_w_13 + K_z_g_z_inv_w_13 + inv_w_13*phi_dot*w0*w_14 - T_cz_inv_w_13 - eta_z_dot*w_17*w_7 - inv_w_13_psi_w0_sq_w_14 - w_15*w_7 - w_16
    out[16] = -inv_I_wy*inv_w_20_motor_torque*(I_y - J_y) - w_24
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, phi_dot, psi_dot, theta_dot, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((17, 17, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    w = -I_z
    w_2 = I_wx + w
    w_3 = I_y - I_wy
    w_4 = w_2 + w_3
    w_5 = -I_x
    w_6 = I_wx + w_5
    w_7 = J_x + w_6
    inv_w_7 = 1.0/w_7
    w0_sq = w0*w0
    w_8 = 4.0*inv_w_7*w0_sq
    K_x_inv_w_7 = K_x*inv_w_7
    w_9 = freq_x*freq_x*inv_w_7
    J_x_w_9 = J_x*w_9
    w_10 = 2.0*I_wx + w + w_3 + w_5
    inv_w_7_w0 = inv_w_7*w0
    D_x_inv_w_7 = D_x*inv_w_7
    w_11 = 2.0*freq_x*inv_w_7*zeta_x
    J_x_w_11 = J_x*w_11
    J_z_inv_w_7_w0 = J_z*inv_w_7_w0
    w_12 = w_3 + w_6
    w_13 = J_z + w_2
    inv_w_13 = 1.0/w_13
    inv_w_13_w0_sq = inv_w_13*w0_sq
    K_z_inv_w_13 = K_z*inv_w_13
    w_14 = freq_z*freq_z*inv_w_13
    J_z_w_14 = J_z*w_14
    inv_w_13_w0 = inv_w_13*w0
    D_z_inv_w_13 = D_z*inv_w_13
    J_x_inv_w_13_w0 = J_x*inv_w_13_w0
    w_15 = 2.0*freq_z*inv_w_13*zeta_z
    J_z_w_15 = J_z*w_15
    w_16 = I_x + w
    w_17 = I_wy - I_y
    w_18 = J_y + w_17
    inv_w_18 = 1.0/w_18
    w_19 = 3.0*inv_w_18*w0_sq
    w_16_w_19 = w_16*w_19
    w_20 = freq_y*freq_y*inv_w_18
    w_21 = -J_y*w_20
    w_22 = 2.0*freq_y*inv_w_18*zeta_y
    w_23 = -J_y*w_22
    inv_I_wx = 1.0/I_wx
    I_wx_w0 = I_wx*w0
    I_wx_w0_I_x = I_wx_w0*I_x
    I_wx_w0_I_y = I_wx_w0*I_y
    I_wy_w0 = I_wy*w0
    I_wy_w0_J_x = I_wy_w0*J_x
    I_wy_nominal_speed = I_wy*nominal_speed
    I_wx_I_wy_nominal_speed = I_wx*I_wy_nominal_speed
    I_wy_nominal_speed_J_x = I_wy_nominal_speed*J_x
    w_24 = I_wx_I_wy_nominal_speed + I_wy_nominal_speed_J_x - I_wy*I_x*nominal_speed
    w_25 = I_wx_I_wy_nominal_speed*w0
    I_wx_w0_sq = I_wx*w0_sq
    I_wx_w0_sq_I_wy = I_wx_w0_sq*I_wy
    I_wy_w0_sq = I_wy*w0_sq
    I_wx_sq = I_wx*I_wx
    inv_I_wx_inv_w_7 = inv_I_wx*inv_w_7
    I_wx_w0_I_z = I_wx_w0*I_z
    w_26 = I_wy_nominal_speed*inv_I_wx + I_wy_w0*inv_I_wx - 2.0*w0
    I_wy_nominal_speed_J_z = I_wy_nominal_speed*J_z
    w_27 = I_wx_I_wy_nominal_speed + I_wx_w0_I_y + I_wx_w0_I_z + I_wy_nominal_speed_J_z + I_wy_w0*J_z - I_wx*J_z*w0 - I_wx_w0_I_x - I_wy*I_z*nominal_speed - I_wy*I_z*w0
    inv_I_wx_inv_w_13 = inv_I_wx*inv_w_13
    w_28 = -J_x_inv_w_13_w0
    w_29 = -w_4
    w_30 = -w_6
    w_31 = -w_17
    w_32 = -w_2
    out[0, 8] = 1.0
    out[1, 9] = 1.0
    out[2, 10] = 1.0
    out[3, 11] = 1.0
    out[4, 12] = 1.0
    out[5, 13] = 1.0
    out[6, 14] = 1.0
    out[7, 15] = 1.0
    out[8, 0] = w_4*w_8
    out[8, 3] = -K_x_inv_w_7
    out[8, 5] = -J_x_w_9
    out[8, 9] = inv_w_7_w0*(J_x + w_10)
    out[8, 11] = -D_x_inv_w_7
    out[8, 13] = -J_x_w_11
    out[8, 15] = -J_z_inv_w_7_w0
    out[9, 1] = inv_w_13_w0_sq*w_12
    out[9, 4] = -K_z_inv_w_13
    out[9, 7] = -J_z_w_14
    out[9, 8] = inv_w_13_w0*(-J_z - w_10)
    out[9, 12] = -D_z_inv_w_13
    out[9, 13] = J_x_inv_w_13_w0
    out[9, 15] = -J_z_w_15
    out[10, 2] = w_16_w_19
    out[10, 6] = w_21
    out[10, 14] = w_23
    out[11, 0] = inv_I_wx*inv_w_7_w0*(4.0*I_wx*I_z*w0 + 4.0*I_wx*J_x*w0 + 4.0*I_wy*I_x*w0 - 4.0*I_wx_w0_I_x - 4.0*I_wx_w0_I_y - 4.0*I_wy_w0_J_x - w_24)
    out[11, 3] = inv_I_wx_inv_w_7*(4.0*I_wx*J_x*w0_sq + 4.0*I_wx_sq*w0_sq + I_wy*I_x*nominal_speed*w0 + 4.0*I_wy*I_x*w0_sq + I_x*K_x - 4.0*I_wx_w0_sq*I_x - 4.0*I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_x*w0 - 4.0*I_wy_w0_sq*J_x - J_x*K_x - w_25)
    out[11, 5] = J_x_w_9
    out[11, 9] = inv_I_wx_inv_w_7*(I_wx*J_x*w0 + I_wx_w0_I_z + I_wy*I_x*w0 - I_wx_w0_I_x - I_wx_w0_I_y - I_wy_w0_J_x - w_24)
    out[11, 11] = D_x_inv_w_7*inv_I_wx*(I_x - J_x)
    out[11, 12] = -w_26
    out[11, 13] = J_x_w_11
    out[11, 15] = J_z_inv_w_7_w0
    out[12, 1] = -inv_I_wx*inv_w_13_w0*w_27
    out[12, 4] = inv_I_wx_inv_w_13*(I_wx*J_z*w0_sq + I_wx_sq*w0_sq + I_wy*I_z*nominal_speed*w0 + I_wy*I_z*w0_sq + I_z*K_z - I_wx_w0_sq*I_z - I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_z*w0 - I_wy_w0_sq*J_z - J_z*K_z - w_25)
    out[12, 7] = J_z_w_14
    out[12, 8] = inv_I_wx_inv_w_13*w_27
    out[12, 11] = w_26
    out[12, 12] = D_z_inv_w_13*inv_I_wx*(I_z - J_z)
    out[12, 13] = w_28
    out[12, 15] = J_z_w_15
    out[13, 0] = w_29*w_8
    out[13, 3] = K_x_inv_w_7
    out[13, 5] = w_30*w_9
    out[13, 9] = inv_w_7_w0*w_29
    out[13, 11] = D_x_inv_w_7
    out[13, 13] = w_11*w_30
    out[13, 15] = J_z_inv_w_7_w0
    out[14, 2] = -w_16*w_19
    out[14, 6] = w_20*w_31
    out[14, 14] = w_22*w_31
    out[15, 1] = -inv_w_13_w0_sq*w_12
    out[15, 4] = K_z_inv_w_13
    out[15, 7] = w_14*w_32
    out[15, 8] = inv_w_13_w0*w_12
    out[15, 12] = D_z_inv_w_13
    out[15, 13] = w_28
    out[15, 15] = w_15*w_32
    out[16, 2] = w_16_w_19
    out[16, 6] = w_21
    out[16, 14] = w_23
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, phi_dot, psi_dot, theta_dot, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((17, 3, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    w = I_wx + J_x - I_x
    inv_w = 1.0/w
    w_2 = I_wx + J_z - I_z
    inv_w_2 = 1.0/w_2
    w_3 = I_wy + J_y - I_y
    inv_w_3 = 1.0/w_3
    inv_I_wx = 1.0/I_wx
    inv_I_wy = 1.0/I_wy
    out[8, 0] = inv_w
    out[9, 1] = inv_w_2
    out[10, 2] = -inv_w_3
    out[11, 0] = inv_I_wx*inv_w*(J_x - I_x)
    out[12, 1] = inv_I_wx*inv_w_2*(J_z - I_z)
    out[13, 0] = -inv_w
    out[14, 2] = inv_w_3
    out[15, 1] = -inv_w_2
    out[16, 2] = inv_I_wy*inv_w_3*(J_y - I_y)
    return out


def state_matrix_batch(t, p, out=None):
    """A, row by row. Batch form."""
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]), np.shape(p[2]), np.shape(p[3]), np.shape(p[4]), np.shape(p[5]), np.shape(p[6]), np.shape(p[7]), np.shape(p[8]), np.shape(p[9]), np.shape(p[10]), np.shape(p[11]), np.shape(p[12]), np.shape(p[13]), np.shape(p[14]), np.shape(p[15]), np.shape(p[16]), np.shape(p[17]), np.shape(p[18]), np.shape(p[19]))
        out = np.empty((17, 17, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    w = -I_z
    w_2 = I_wx + w
    w_3 = I_y - I_wy
    w_4 = w_2 + w_3
    w_5 = -I_x
    w_6 = I_wx + w_5
    w_7 = J_x + w_6
    inv_w_7 = 1.0/w_7
    w0_sq = w0*w0
    w_8 = 4.0*inv_w_7*w0_sq
    K_x_inv_w_7 = K_x*inv_w_7
    w_9 = freq_x*freq_x*inv_w_7
    J_x_w_9 = J_x*w_9
    w_10 = 2.0*I_wx + w + w_3 + w_5
    inv_w_7_w0 = inv_w_7*w0
    D_x_inv_w_7 = D_x*inv_w_7
    w_11 = 2.0*freq_x*inv_w_7*zeta_x
    J_x_w_11 = J_x*w_11
    J_z_inv_w_7_w0 = J_z*inv_w_7_w0
    w_12 = w_3 + w_6
    w_13 = J_z + w_2
    inv_w_13 = 1.0/w_13
    inv_w_13_w0_sq = inv_w_13*w0_sq
    K_z_inv_w_13 = K_z*inv_w_13
    w_14 = freq_z*freq_z*inv_w_13
    J_z_w_14 = J_z*w_14
    inv_w_13_w0 = inv_w_13*w0
    D_z_inv_w_13 = D_z*inv_w_13
    J_x_inv_w_13_w0 = J_x*inv_w_13_w0
    w_15 = 2.0*freq_z*inv_w_13*zeta_z
    J_z_w_15 = J_z*w_15
    w_16 = I_x + w
    w_17 = I_wy - I_y
    w_18 = J_y + w_17
    inv_w_18 = 1.0/w_18
    w_19 = 3.0*inv_w_18*w0_sq
    w_16_w_19 = w_16*w_19
    w_20 = freq_y*freq_y*inv_w_18
    w_21 = -J_y*w_20
    w_22 = 2.0*freq_y*inv_w_18*zeta_y
    w_23 = -J_y*w_22
    inv_I_wx = 1.0/I_wx
    I_wx_w0 = I_wx*w0
    I_wx_w0_I_x = I_wx_w0*I_x
    I_wx_w0_I_y = I_wx_w0*I_y
    I_wy_w0 = I_wy*w0
    I_wy_w0_J_x = I_wy_w0*J_x
    I_wy_nominal_speed = I_wy*nominal_speed
    I_wx_I_wy_nominal_speed = I_wx*I_wy_nominal_speed
    I_wy_nominal_speed_J_x = I_wy_nominal_speed*J_x
    w_24 = I_wx_I_wy_nominal_speed + I_wy_nominal_speed_J_x - I_wy*I_x*nominal_speed
    w_25 = I_wx_I_wy_nominal_speed*w0
    I_wx_w0_sq = I_wx*w0_sq
    I_wx_w0_sq_I_wy = I_wx_w0_sq*I_wy
    I_wy_w0_sq = I_wy*w0_sq
    I_wx_sq = I_wx*I_wx
    inv_I_wx_inv_w_7 = inv_I_wx*inv_w_7
    I_wx_w0_I_z = I_wx_w0*I_z
    w_26 = I_wy_nominal_speed*inv_I_wx + I_wy_w0*inv_I_wx - 2.0*w0
    I_wy_nominal_speed_J_z = I_wy_nominal_speed*J_z
    w_27 = I_wx_I_wy_nominal_speed + I_wx_w0_I_y + I_wx_w0_I_z + I_wy_nominal_speed_J_z + I_wy_w0*J_z - I_wx*J_z*w0 - I_wx_w0_I_x - I_wy*I_z*nominal_speed - I_wy*I_z*w0
    inv_I_wx_inv_w_13 = inv_I_wx*inv_w_13
    w_28 = -J_x_inv_w_13_w0
    w_29 = -w_4
    w_30 = -w_6
    w_31 = -w_17
    w_32 = -w_2
    out[0, 8] = 1.0
    out[1, 9] = 1.0
    out[2, 10] = 1.0
    out[3, 11] = 1.0
    out[4, 12] = 1.0
    out[5, 13] = 1.0
    out[6, 14] = 1.0
    out[7, 15] = 1.0
    out[8, 0] = w_4*w_8
    out[8, 3] = -K_x_inv_w_7
    out[8, 5] = -J_x_w_9
    out[8, 9] = inv_w_7_w0*(J_x + w_10)
    out[8, 11] = -D_x_inv_w_7
    out[8, 13] = -J_x_w_11
    out[8, 15] = -J_z_inv_w_7_w0
    out[9, 1] = inv_w_13_w0_sq*w_12
    out[9, 4] = -K_z_inv_w_13
    out[9, 7] = -J_z_w_14
    out[9, 8] = inv_w_13_w0*(-J_z - w_10)
    out[9, 12] = -D_z_inv_w_13
    out[9, 13] = J_x_inv_w_13_w0
    out[9, 15] = -J_z_w_15
    out[10, 2] = w_16_w_19
    out[10, 6] = w_21
    out[10, 14] = w_23
    out[11, 0] = inv_I_wx*inv_w_7_w0*(4.0*I_wx*I_z*w0 + 4.0*I_wx*J_x*w0 + 4.0*I_wy*I_x*w0 - 4.0*I_wx_w0_I_x - 4.0*I_wx_w0_I_y - 4.0*I_wy_w0_J_x - w_24)
    out[11, 3] = inv_I_wx_inv_w_7*(4.0*I_wx*J_x*w0_sq + 4.0*I_wx_sq*w0_sq + I_wy*I_x*nominal_speed*w0 + 4.0*I_wy*I_x*w0_sq + I_x*K_x - 4.0*I_wx_w0_sq*I_x - 4.0*I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_x*w0 - 4.0*I_wy_w0_sq*J_x - J_x*K_x - w_25)
    out[11, 5] = J_x_w_9
    out[11, 9] = inv_I_wx_inv_w_7*(I_wx*J_x*w0 + I_wx_w0_I_z + I_wy*I_x*w0 - I_wx_w0_I_x - I_wx_w0_I_y - I_wy_w0_J_x - w_24)
    out[11, 11] = D_x_inv_w_7*inv_I_wx*(I_x - J_x)
    out[11, 12] = -w_26
    out[11, 13] = J_x_w_11
    out[11, 15] = J_z_inv_w_7_w0
    out[12, 1] = -inv_I_wx*inv_w_13_w0*w_27
    out[12, 4] = inv_I_wx_inv_w_13*(I_wx*J_z*w0_sq + I_wx_sq*w0_sq + I_wy*I_z*nominal_speed*w0 + I_wy*I_z*w0_sq + I_z*K_z - I_wx_w0_sq*I_z - I_wx_w0_sq_I_wy - I_wy_nominal_speed_J_z*w0 - I_wy_w0_sq*J_z - J_z*K_z - w_25)
    out[12, 7] = J_z_w_14
    out[12, 8] = inv_I_wx_inv_w_13*w_27
    out[12, 11] = w_26
    out[12, 12] = D_z_inv_w_13*inv_I_wx*(I_z - J_z)
    out[12, 13] = w_28
    out[12, 15] = J_z_w_15
    out[13, 0] = w_29*w_8
    out[13, 3] = K_x_inv_w_7
    out[13, 5] = w_30*w_9
    out[13, 9] = inv_w_7_w0*w_29
    out[13, 11] = D_x_inv_w_7
    out[13, 13] = w_11*w_30
    out[13, 15] = J_z_inv_w_7_w0
    out[14, 2] = -w_16*w_19
    out[14, 6] = w_20*w_31
    out[14, 14] = w_22*w_31
    out[15, 1] = -inv_w_13_w0_sq*w_12
    out[15, 4] = K_z_inv_w_13
    out[15, 7] = w_14*w_32
    out[15, 8] = inv_w_13_w0*w_12
    out[15, 12] = D_z_inv_w_13
    out[15, 13] = w_28
    out[15, 15] = w_15*w_32
    out[16, 2] = w_16_w_19
    out[16, 6] = w_21
    out[16, 14] = w_23
    return out


def input_matrix_batch(t, p, out=None):
    """B, row by row. Batch form."""
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(p[0]), np.shape(p[1]), np.shape(p[2]), np.shape(p[3]), np.shape(p[4]), np.shape(p[5]), np.shape(p[6]), np.shape(p[7]), np.shape(p[8]), np.shape(p[9]), np.shape(p[10]), np.shape(p[11]), np.shape(p[12]), np.shape(p[13]), np.shape(p[14]), np.shape(p[15]), np.shape(p[16]), np.shape(p[17]), np.shape(p[18]), np.shape(p[19]))
        out = np.empty((17, 3, *shape), np.result_type(float, t, *p))
    out[...] = 0.0
    w = I_wx + J_x - I_x
    inv_w = 1.0/w
    w_2 = I_wx + J_z - I_z
    inv_w_2 = 1.0/w_2
    w_3 = I_wy + J_y - I_y
    inv_w_3 = 1.0/w_3
    inv_I_wx = 1.0/I_wx
    inv_I_wy = 1.0/I_wy
    out[8, 0] = inv_w
    out[9, 1] = inv_w_2
    out[10, 2] = -inv_w_3
    out[11, 0] = inv_I_wx*inv_w*(J_x - I_x)
    out[12, 1] = inv_I_wx*inv_w_2*(J_z - I_z)
    out[13, 0] = -inv_w
    out[14, 2] = inv_w_3
    out[15, 1] = -inv_w_2
    out[16, 2] = inv_I_wy*inv_w_3*(J_y - I_y)
    return out
