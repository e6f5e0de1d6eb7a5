"""Satellite with a double-gimballed momentum wheel and a flexible mode about each axis.

Written by satsym from derivations/gimballed_wheel.py. Do not edit: mend that file instead, then run
    satsym derive derivations/gimballed_wheel.py
Source: ../derivations/gimballed_wheel.py 556f29f5e697be71060e04a260695b4e
Digest: 4dad9cdd77f3e0bf5091613d75ffeedf9e598986bb0ac086a1d7da7e2aec5f48
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'gimballed_wheel',
    'title': 'Satellite with a double-gimballed momentum wheel and a flexible mode about each axis',
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
        {'symbol': 'w_x', 'latex': '\\omega_x', 'unit': 'rad/s', 'meaning': "inertial angular velocity about the body's x"},
        {'symbol': 'w_y', 'latex': '\\omega_y', 'unit': 'rad/s', 'meaning': "inertial angular velocity about the body's y"},
        {'symbol': 'w_z', 'latex': '\\omega_z', 'unit': 'rad/s', 'meaning': "inertial angular velocity about the body's z"},
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
    'has_reference': True,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
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
        {'name': 'nutation', 'states': ('phi', 'psi', 'w_x', 'w_z'), 'vanishing': 'w0', 'slow': 'orbit-rate mode'},
        {'name': 'pitch libration', 'states': ('theta', 'w_y'), 'neutral': 'pitch drift'},
        {'name': 'gimbal mode', 'states': ('g_x', 'g_z', 'g_x_dot', 'g_z_dot')},
        {'name': 'flexible mode about x', 'states': ('eta_x', 'eta_x_dot')},
        {'name': 'flexible mode about y', 'states': ('eta_y', 'eta_y_dot')},
        {'name': 'flexible mode about z', 'states': ('eta_z', 'eta_z_dot')},
        {'name': 'speed of the wheel', 'states': ('wheel_speed',)},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, w_x, w_y, w_z, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    cos_theta = math.cos(theta)
    sin_psi = math.sin(psi)
    sin_theta = math.sin(theta)
    cos_psi = math.cos(psi)
    sin_phi = math.sin(phi)
    cos_psi_sin_phi = cos_psi*sin_phi
    a_yx = cos_psi_sin_phi*sin_theta + cos_theta*sin_psi
    w = a_yx*w0 + w_x
    a_yz = sin_psi*sin_theta - cos_psi_sin_phi*cos_theta
    w_2 = a_yz*w0 + w_z
    cos_phi = math.cos(phi)
    inv_cos_phi = 1.0/cos_phi
    w_3 = sin_theta*w - cos_theta*w_2
    a_yy = cos_phi*cos_psi
    inv_I_wx = 1.0/I_wx
    part_1 = math.cos(g_z)
    mass_4_1 = I_wx*part_1
    factor_0_3 = inv_I_wx*mass_4_1
    w_4 = -I_wx
    part_9 = math.cos(g_x)
    part_10 = part_9*part_9
    part_11 = I_wy*part_10
    part_2 = part_1*part_1
    part_3 = I_wx*part_2
    part_4 = math.sin(g_z)
    part_5 = part_4*part_4
    part_6 = math.sin(g_x)
    part_7 = part_6*part_6
    part_8 = I_wx*part_7
    mass_1_1 = I_x + part_11*part_5 + part_3 + part_5*part_8 + w_4
    rest_5_0_0 = mass_1_1 - J_x
    rest_3_0_0 = rest_5_0_0 - factor_0_3*mass_4_1
    inv_rest_3_0_0 = 1.0/rest_3_0_0
    mass_2_1 = part_1*part_4*(-part_11 - part_8 - w_4)
    mass_4_2 = I_wx*part_4
    rest_3_0_1 = mass_2_1 - factor_0_3*mass_4_2
    factor_1_0 = inv_rest_3_0_0*rest_3_0_1
    factor_1_3 = inv_I_wx*mass_4_2
    w_5 = -I_wy
    mass_2_2 = I_wx*part_5 + I_y + part_11*part_2 + part_3*part_7 + w_5
    rest_6_1_1 = mass_2_2 - J_y
    rest_3_1_1 = rest_6_1_1 - factor_1_3*mass_4_2
    rest_0_1_1 = rest_3_1_1 - factor_1_0*rest_3_0_1
    inv_rest_0_1_1 = 1.0/rest_0_1_1
    part_12 = part_6*part_9
    part_13 = I_wx + w_5
    part_14 = part_13*part_4
    part_15 = part_12*part_14
    part_16 = -part_1*part_13
    part_17 = part_12*part_16
    w_6 = part_17 - factor_1_0*part_15
    factor_2_1 = inv_rest_0_1_1*w_6
    inv_rest_3_0_0_part_15 = inv_rest_3_0_0*part_15
    w_7 = inv_rest_3_0_0_part_15*part_15
    part_18 = I_wx*part_10 + I_wy*part_7
    mass_3_3 = I_z + part_18 + w_4
    rest_7_2_2 = mass_3_3 - J_z
    rest_0_2_2 = rest_7_2_2 - w_7
    rest_1_2_2 = rest_0_2_2 - factor_2_1*w_6
    inv_rest_1_2_2 = 1.0/rest_1_2_2
    w_8 = -part_18
    rest_0_2_4 = -w_7 - w_8
    rest_1_2_4 = rest_0_2_4 - factor_2_1*w_6
    factor_4_2 = inv_rest_1_2_2*rest_1_2_4
    rest_0_4_4 = -inv_rest_3_0_0_part_15*part_15 - w_8
    rest_1_4_4 = rest_0_4_4 - factor_2_1*w_6
    rest_2_4_4 = rest_1_4_4 - factor_4_2*rest_1_2_4
    inv_rest_2_4_4 = 1.0/rest_2_4_4
    part_19 = I_wy*part_9
    mass_9_1 = part_19*part_4
    mass_9_2 = -part_1*part_19
    rest_0_1_8 = mass_9_2 - factor_1_0*mass_9_1
    part_20 = I_wy*part_6
    w_9 = -part_20
    rest_0_2_8 = w_9 - inv_rest_3_0_0_part_15*mass_9_1
    rest_1_2_8 = rest_0_2_8 - factor_2_1*rest_0_1_8
    rest_2_4_8 = rest_1_2_8 - factor_4_2*rest_1_2_8
    factor_8_4 = inv_rest_2_4_4*rest_2_4_8
    factor_8_2 = inv_rest_1_2_2*rest_1_2_8
    factor_8_1 = inv_rest_0_1_1*rest_0_1_8
    factor_8_0 = inv_rest_3_0_0*mass_9_1
    rest_0_8_8 = I_wy - factor_8_0*mass_9_1
    rest_1_8_8 = rest_0_8_8 - factor_8_1*rest_0_1_8
    rest_2_8_8 = rest_1_8_8 - factor_8_2*rest_1_2_8
    rest_4_8_8 = rest_2_8_8 - factor_8_4*rest_2_4_8
    inv_rest_4_8_8 = 1.0/rest_4_8_8
    part_31 = part_4*w_x
    part_37 = nominal_speed + wheel_speed
    part_1_w_y = part_1*w_y
    part_30 = g_z_dot + w_z
    part_43 = part_30*part_9 + part_31*part_6 - part_1_w_y*part_6
    part_30_part_6 = part_30*part_6
    part_38 = part_1_w_y*part_9 + part_30_part_6 - part_31*part_9 - part_37
    part_44 = part_38*part_43
    part_45 = I_wx*part_44 + I_wx*(g_z_dot*part_1_w_y + part_37*part_43 - g_z_dot*part_31) - I_wy*part_44
    part_52 = w0*w0
    part_56 = D_x*g_x_dot + K_x*g_x - T_cx
    a_zz = cos_phi*cos_theta
    a_zx = -cos_phi*sin_theta
    part_59 = part_1*sin_phi - a_zx*part_4
    part_60 = a_zz*part_6 + part_59*part_9
    part_64 = a_zz*part_9 - part_59*part_6
    acceleration_right_3 = 3.0*part_13*part_52*part_60*part_64 - part_45 - part_56
    acceleration_right_5 = -J_x*freq_x*(eta_x*freq_x + 2.0*eta_x_dot*zeta_x)
    part_21 = J_z*(eta_z_dot + w_z)
    part_22 = J_y*(eta_y_dot + w_y)
    part_23 = J_z - I_z
    part_24 = -I_wx - part_23
    part_25 = w_y*w_z
    part_26 = I_y - I_wy - J_y
    part_27 = part_1*w_x
    part_28 = g_z_dot*part_9
    part_29 = part_4*w_y
    part_32 = g_x_dot*(part_1_w_y - part_31)
    part_33 = g_x_dot*part_30*part_9 - part_27*part_28 - part_28*part_29 - part_32*part_6
    part_34 = I_wy*part_33
    part_35 = part_34*part_9
    part_36 = g_x_dot + part_27 + part_29
    part_39 = part_36*part_38
    part_40 = I_wx*(g_z_dot*part_1*part_6*w_x + g_z_dot*part_4*part_6*w_y - g_x_dot*part_30_part_6 - part_32*part_9 - part_36*part_37) + I_wy*part_39 - I_wx*part_39
    part_41 = part_40*part_6
    w_10 = 3.0*part_52
    part_54 = a_zz*w_10
    part_55 = part_54*sin_phi
    part_57 = I_y + part_13 - J_y
    part_58 = a_zx*part_1 + part_4*sin_phi
    part_58_part_60 = part_58*part_60
    part_62 = -part_13*part_58_part_60
    part_63 = part_6*w_10
    part_65 = part_60*part_64*w_10
    acceleration_right_0 = J_z*part_55 + part_1*part_13*part_65 + part_22*w_z + part_25*part_26 + part_35*part_4 + part_4*part_62*part_63 + part_55*(-part_23 - part_57) - J_y*part_55 - acceleration_right_3*factor_0_3 - acceleration_right_5 - part_1*part_45 - part_21*w_y - part_24*part_25 - part_4*part_41
    w_11 = I_x - J_x
    acceleration_right_6 = -J_y*freq_y*(eta_y*freq_y + 2.0*eta_y_dot*zeta_y)
    part_46 = J_x*(eta_x_dot + w_x)
    part_47 = -w_11
    part_48 = -I_wx - part_47
    part_49 = w_x*w_z
    part_66 = a_zx*part_54
    acceleration_right_1 = J_x*part_66 + part_1*part_41 + part_14*part_65 + part_21*w_x + part_24*part_49 + part_66*(part_23 + w_11) - J_z*part_66 - acceleration_right_0*factor_1_0 - acceleration_right_3*factor_1_3 - acceleration_right_6 - part_1*part_35 - part_16*part_58_part_60*part_63 - part_4*part_45 - part_46*w_z - part_48*part_49
    acceleration_right_7 = -J_z*freq_z*(eta_z*freq_z + 2.0*eta_z_dot*zeta_z)
    part_50 = w_x*w_y
    part_51 = part_20*part_33 + part_40*part_9
    part_67 = a_zx*sin_phi
    acceleration_right_2 = part_46*w_y + part_48*part_50 + w_10*(J_y*part_67 + part_62*part_9 + part_67*(part_47 + part_57) - J_x*part_67) - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_7 - part_22*w_x - part_26*part_50 - part_51
    acceleration_right_4 = T_cz - D_z*g_z_dot - K_z*g_z - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_2*factor_4_2 - part_13*part_58_part_60*part_9*w_10 - part_51
    acceleration_right_8 = motor_torque + part_34 - acceleration_right_0*factor_8_0 - acceleration_right_1*factor_8_1 - acceleration_right_2*factor_8_2 - acceleration_right_4*factor_8_4
    acceleration_8 = acceleration_right_8*inv_rest_4_8_8
    acceleration_4 = acceleration_right_4*inv_rest_2_4_4 - acceleration_8*factor_8_4
    acceleration_2 = acceleration_right_2*inv_rest_1_2_2 - acceleration_4*factor_4_2 - acceleration_8*factor_8_2
    acceleration_1 = acceleration_right_1*inv_rest_0_1_1 - acceleration_2*factor_2_1 - acceleration_4*factor_2_1 - acceleration_8*factor_8_1
    acceleration_0 = acceleration_right_0*inv_rest_3_0_0 - acceleration_1*factor_1_0 - acceleration_2*inv_rest_3_0_0_part_15 - acceleration_4*inv_rest_3_0_0_part_15 - acceleration_8*factor_8_0
    acceleration_3 = acceleration_right_3*inv_I_wx - acceleration_0*factor_0_3 - acceleration_1*factor_1_3
    inv_J_x = 1.0/J_x
    acceleration_5 = acceleration_right_5*inv_J_x - acceleration_0
    inv_J_y = 1.0/J_y
    acceleration_6 = acceleration_right_6*inv_J_y - acceleration_1
    inv_J_z = 1.0/J_z
    acceleration_7 = acceleration_right_7*inv_J_z - acceleration_2
    return (
        cos_theta*w + sin_theta*w_2,
        -inv_cos_phi*w_3,
        a_yy*w0 + w_3*math.tan(phi) + w_y,
        g_x_dot,
        g_z_dot,
        eta_x_dot,
        eta_y_dot,
        eta_z_dot,
        acceleration_0,
        acceleration_1,
        acceleration_2,
        acceleration_3,
        acceleration_4,
        acceleration_5,
        acceleration_6,
        acceleration_7,
        acceleration_8,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, w_x, w_y, w_z, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    cos_theta = math.cos(theta)
    cos_theta_w0 = cos_theta*w0
    sin_theta = math.sin(theta)
    sin_theta_w0 = sin_theta*w0
    cos_phi = math.cos(phi)
    cos_phi_sin_theta = cos_phi*sin_theta
    cos_psi = math.cos(psi)
    d_a_yx_by_phi = cos_phi_sin_theta*cos_psi
    cos_phi_cos_theta = cos_phi*cos_theta
    d_a_yz_by_phi = -cos_phi_cos_theta*cos_psi
    sin_psi = math.sin(psi)
    sin_phi = math.sin(phi)
    d_a_yx_by_psi = cos_psi*cos_theta - sin_phi*sin_psi*sin_theta
    cos_theta_sin_psi = cos_theta*sin_psi
    d_a_yz_by_psi = cos_psi*sin_theta + cos_theta_sin_psi*sin_phi
    cos_psi_sin_phi = cos_psi*sin_phi
    w = cos_psi_sin_phi*cos_theta - sin_psi*sin_theta
    a_yz = -w
    w_2 = a_yz*w0 + w_z
    w_3 = cos_psi_sin_phi*sin_theta + cos_theta_sin_psi
    w_4 = w0*w_3 + w_x
    sin_theta_w_4 = sin_theta*w_4
    inv_cos_phi = 1.0/cos_phi
    cos_theta_inv_cos_phi = cos_theta*inv_cos_phi
    cos_theta_inv_cos_phi_w0 = cos_theta_inv_cos_phi*w0
    inv_cos_phi_sin_theta = inv_cos_phi*sin_theta
    inv_cos_phi_sin_theta_w0 = inv_cos_phi_sin_theta*w0
    w_5 = sin_theta_w_4 - cos_theta*w_2
    w_6 = cos_theta*w_4 + sin_theta*w_2
    tan_phi = math.tan(phi)
    sin_theta_tan_phi = sin_theta*tan_phi
    sin_theta_tan_phi_w0 = sin_theta_tan_phi*w0
    cos_theta_tan_phi = cos_theta*tan_phi
    cos_theta_tan_phi_w0 = cos_theta_tan_phi*w0
    d_a_yy_by_phi = -cos_psi_sin_phi
    d_a_yy_by_psi = -cos_phi*sin_psi
    inv_I_wx = 1.0/I_wx
    cos_g_z = math.cos(g_z)
    I_wx_cos_g_z = I_wx*cos_g_z
    factor_0_3 = I_wx_cos_g_z*inv_I_wx
    w_7 = -I_wx
    cos_g_x = math.cos(g_x)
    part_10 = cos_g_x*cos_g_x
    part_11 = I_wy*part_10
    part_2 = cos_g_z*cos_g_z
    part_3 = I_wx*part_2
    sin_g_z = math.sin(g_z)
    part_5 = sin_g_z*sin_g_z
    sin_g_x = math.sin(g_x)
    part_7 = sin_g_x*sin_g_x
    part_8 = I_wx*part_7
    mass_1_1 = I_x + part_11*part_5 + part_3 + part_5*part_8 + w_7
    rest_5_0_0 = mass_1_1 - J_x
    rest_3_0_0 = rest_5_0_0 - I_wx_cos_g_z*factor_0_3
    inv_rest_3_0_0 = 1.0/rest_3_0_0
    w_8 = part_11 + part_8
    w_9 = -w_7 - w_8
    cos_g_z_sin_g_z = cos_g_z*sin_g_z
    mass_2_1 = cos_g_z_sin_g_z*w_9
    I_wx_sin_g_z = I_wx*sin_g_z
    rest_3_0_1 = mass_2_1 - I_wx_sin_g_z*factor_0_3
    factor_1_0 = inv_rest_3_0_0*rest_3_0_1
    part_12 = cos_g_x*sin_g_x
    w_10 = -I_wy
    w_11 = I_wx + w_10
    part_14 = sin_g_z*w_11
    part_15 = part_12*part_14
    inv_rest_3_0_0_part_15 = inv_rest_3_0_0*part_15
    part_19 = I_wy*cos_g_x
    mass_9_1 = part_19*sin_g_z
    factor_8_0 = inv_rest_3_0_0*mass_9_1
    factor_1_3 = I_wx_sin_g_z*inv_I_wx
    mass_2_2 = I_wx*part_5 + I_y + part_11*part_2 + part_3*part_7 + w_10
    rest_6_1_1 = mass_2_2 - J_y
    rest_3_1_1 = rest_6_1_1 - I_wx_sin_g_z*factor_1_3
    rest_0_1_1 = rest_3_1_1 - factor_1_0*rest_3_0_1
    inv_rest_0_1_1 = 1.0/rest_0_1_1
    cos_g_z_w_11 = cos_g_z*w_11
    part_16 = -cos_g_z_w_11
    part_17 = part_12*part_16
    w_12 = part_17 - factor_1_0*part_15
    factor_2_1 = inv_rest_0_1_1*w_12
    mass_9_2 = -cos_g_z*part_19
    rest_0_1_8 = mass_9_2 - factor_1_0*mass_9_1
    factor_8_1 = inv_rest_0_1_1*rest_0_1_8
    w_13 = inv_rest_3_0_0_part_15*part_15
    part_18 = I_wx*part_10 + I_wy*part_7
    mass_3_3 = I_z + part_18 + w_7
    rest_7_2_2 = mass_3_3 - J_z
    rest_0_2_2 = rest_7_2_2 - w_13
    rest_1_2_2 = rest_0_2_2 - factor_2_1*w_12
    inv_rest_1_2_2 = 1.0/rest_1_2_2
    w_14 = -part_18
    rest_0_2_4 = -w_13 - w_14
    rest_1_2_4 = rest_0_2_4 - factor_2_1*w_12
    factor_4_2 = inv_rest_1_2_2*rest_1_2_4
    part_20 = I_wy*sin_g_x
    w_15 = -part_20
    rest_0_2_8 = w_15 - inv_rest_3_0_0_part_15*mass_9_1
    rest_1_2_8 = rest_0_2_8 - factor_2_1*rest_0_1_8
    factor_8_2 = inv_rest_1_2_2*rest_1_2_8
    rest_0_4_4 = -inv_rest_3_0_0_part_15*part_15 - w_14
    rest_1_4_4 = rest_0_4_4 - factor_2_1*w_12
    rest_2_4_4 = rest_1_4_4 - factor_4_2*rest_1_2_4
    inv_rest_2_4_4 = 1.0/rest_2_4_4
    rest_2_4_8 = rest_1_2_8 - factor_4_2*rest_1_2_8
    factor_8_4 = inv_rest_2_4_4*rest_2_4_8
    rest_0_8_8 = I_wy - factor_8_0*mass_9_1
    rest_1_8_8 = rest_0_8_8 - factor_8_1*rest_0_1_8
    rest_2_8_8 = rest_1_8_8 - factor_8_2*rest_1_2_8
    rest_4_8_8 = rest_2_8_8 - factor_8_4*rest_2_4_8
    inv_rest_4_8_8 = 1.0/rest_4_8_8
    part_52 = w0*w0
    w_16 = 3.0*part_52
    part_63 = sin_g_x*w_16
    part_63_sin_g_z = part_63*sin_g_z
    w_17 = -J_z
    part_23 = -I_z - w_17
    part_57 = I_y + w_11 - J_y
    w_18 = part_23 + part_57
    w_19 = -J_y - w_17 - w_18
    d_a_zz_by_phi = -cos_theta*sin_phi
    d_part_54_by_phi = d_a_zz_by_phi*w_16
    part_54 = cos_phi_cos_theta*w_16
    d_part_55_by_phi = cos_phi*part_54 + d_part_54_by_phi*sin_phi
    d_a_zx_by_phi = sin_phi*sin_theta
    d_part_58_by_phi = cos_g_z*d_a_zx_by_phi + cos_phi*sin_g_z
    w_20 = -cos_phi_sin_theta
    part_59 = cos_g_z*sin_phi - sin_g_z*w_20
    part_60 = cos_g_x*part_59 + cos_phi_cos_theta*sin_g_x
    d_part_58_by_phi_part_60 = d_part_58_by_phi*part_60
    d_part_59_by_phi = cos_g_z*cos_phi - d_a_zx_by_phi*sin_g_z
    d_part_60_by_phi = cos_g_x*d_part_59_by_phi + d_a_zz_by_phi*sin_g_x
    part_58 = cos_g_z*w_20 + sin_g_z*sin_phi
    d_part_60_by_phi_part_58 = d_part_60_by_phi*part_58
    d_part_61_by_phi = d_part_58_by_phi_part_60 + d_part_60_by_phi_part_58
    d_part_62_by_phi = -d_part_61_by_phi*w_11
    part_64 = cos_g_x*cos_phi_cos_theta - part_59*sin_g_x
    part_64_w_16 = part_64*w_16
    part_60_w_16 = part_60*w_16
    d_part_64_by_phi = cos_g_x*d_a_zz_by_phi - d_part_59_by_phi*sin_g_x
    d_part_65_by_phi = d_part_60_by_phi*part_64_w_16 + d_part_64_by_phi*part_60_w_16
    w_11_w_16 = w_11*w_16
    part_64_w_11_w_16 = part_64*w_11_w_16
    part_60_w_11_w_16 = part_60*w_11_w_16
    slope_phi_right_3 = d_part_60_by_phi*part_64_w_11_w_16 + d_part_64_by_phi*part_60_w_11_w_16
    slope_phi_right_0 = cos_g_z_w_11*d_part_65_by_phi + d_part_55_by_phi*w_19 + d_part_62_by_phi*part_63_sin_g_z - factor_0_3*slope_phi_right_3
    part_16_part_63 = part_16*part_63
    w_21 = I_x + part_23 + w_17
    d_part_66_by_phi = d_a_zx_by_phi*part_54 + d_part_54_by_phi*w_20
    slope_phi_right_1 = d_part_65_by_phi*part_14 + d_part_66_by_phi*w_21 - d_part_61_by_phi*part_16_part_63 - factor_1_0*slope_phi_right_0 - factor_1_3*slope_phi_right_3
    cos_g_x_w_16 = cos_g_x*w_16
    w_22 = -J_x
    w_23 = I_x + w_22
    part_47 = -w_23
    w_24 = part_47 + part_57
    w_25 = w_16*(J_y + w_22 + w_24)
    d_part_67_by_phi = cos_phi*w_20 + d_a_zx_by_phi*sin_phi
    slope_phi_right_2 = cos_g_x_w_16*d_part_62_by_phi + d_part_67_by_phi*w_25 - factor_2_1*slope_phi_right_1 - inv_rest_3_0_0_part_15*slope_phi_right_0
    cos_g_x_w_11_w_16 = cos_g_x*w_11_w_16
    slope_phi_right_4 = -cos_g_x_w_11_w_16*d_part_58_by_phi_part_60 - cos_g_x_w_11_w_16*d_part_60_by_phi_part_58 - factor_2_1*slope_phi_right_1 - factor_4_2*slope_phi_right_2 - inv_rest_3_0_0_part_15*slope_phi_right_0
    slope_phi_right_8 = -factor_8_0*slope_phi_right_0 - factor_8_1*slope_phi_right_1 - factor_8_2*slope_phi_right_2 - factor_8_4*slope_phi_right_4
    slope_phi_8 = inv_rest_4_8_8*slope_phi_right_8
    slope_phi_4 = inv_rest_2_4_4*slope_phi_right_4 - factor_8_4*slope_phi_8
    slope_phi_2 = inv_rest_1_2_2*slope_phi_right_2 - factor_4_2*slope_phi_4 - factor_8_2*slope_phi_8
    slope_phi_1 = inv_rest_0_1_1*slope_phi_right_1 - factor_2_1*slope_phi_2 - factor_2_1*slope_phi_4 - factor_8_1*slope_phi_8
    slope_phi_0 = inv_rest_3_0_0*slope_phi_right_0 - factor_1_0*slope_phi_1 - factor_8_0*slope_phi_8 - inv_rest_3_0_0_part_15*slope_phi_2 - inv_rest_3_0_0_part_15*slope_phi_4
    d_part_54_by_theta = w_16*w_20
    d_part_55_by_theta = d_part_54_by_theta*sin_phi
    d_a_zx_by_theta = -cos_phi_cos_theta
    d_part_58_by_theta = cos_g_z*d_a_zx_by_theta
    w_26 = d_part_58_by_theta*part_60
    d_part_59_by_theta = -d_a_zx_by_theta*sin_g_z
    d_part_60_by_theta = cos_g_x*d_part_59_by_theta + sin_g_x*w_20
    w_27 = d_part_60_by_theta*part_58
    d_part_61_by_theta = w_26 + w_27
    d_part_62_by_theta = -d_part_61_by_theta*w_11
    d_part_64_by_theta = cos_g_x*w_20 - d_part_59_by_theta*sin_g_x
    d_part_65_by_theta = d_part_60_by_theta*part_64_w_16 + d_part_64_by_theta*part_60_w_16
    slope_theta_right_3 = d_part_60_by_theta*part_64_w_11_w_16 + d_part_64_by_theta*part_60_w_11_w_16
    slope_theta_right_0 = cos_g_z_w_11*d_part_65_by_theta + d_part_55_by_theta*w_19 + d_part_62_by_theta*part_63_sin_g_z - factor_0_3*slope_theta_right_3
    d_part_66_by_theta = d_a_zx_by_theta*part_54 + d_part_54_by_theta*w_20
    slope_theta_right_1 = d_part_65_by_theta*part_14 + d_part_66_by_theta*w_21 - d_part_61_by_theta*part_16_part_63 - factor_1_0*slope_theta_right_0 - factor_1_3*slope_theta_right_3
    d_part_67_by_theta = d_a_zx_by_theta*sin_phi
    slope_theta_right_2 = cos_g_x_w_16*d_part_62_by_theta + d_part_67_by_theta*w_25 - factor_2_1*slope_theta_right_1 - inv_rest_3_0_0_part_15*slope_theta_right_0
    slope_theta_right_4 = -cos_g_x_w_11_w_16*w_26 - cos_g_x_w_11_w_16*w_27 - factor_2_1*slope_theta_right_1 - factor_4_2*slope_theta_right_2 - inv_rest_3_0_0_part_15*slope_theta_right_0
    slope_theta_right_8 = -factor_8_0*slope_theta_right_0 - factor_8_1*slope_theta_right_1 - factor_8_2*slope_theta_right_2 - factor_8_4*slope_theta_right_4
    slope_theta_8 = inv_rest_4_8_8*slope_theta_right_8
    slope_theta_4 = inv_rest_2_4_4*slope_theta_right_4 - factor_8_4*slope_theta_8
    slope_theta_2 = inv_rest_1_2_2*slope_theta_right_2 - factor_4_2*slope_theta_4 - factor_8_2*slope_theta_8
    slope_theta_1 = inv_rest_0_1_1*slope_theta_right_1 - factor_2_1*slope_theta_2 - factor_2_1*slope_theta_4 - factor_8_1*slope_theta_8
    slope_theta_0 = inv_rest_3_0_0*slope_theta_right_0 - factor_1_0*slope_theta_1 - factor_8_0*slope_theta_8 - inv_rest_3_0_0_part_15*slope_theta_2 - inv_rest_3_0_0_part_15*slope_theta_4
    part_31 = sin_g_z*w_x
    part_37 = nominal_speed + wheel_speed
    cos_g_z_w_y = cos_g_z*w_y
    part_30 = g_z_dot + w_z
    part_43 = cos_g_x*part_30 + part_31*sin_g_x - cos_g_z_w_y*sin_g_x
    part_30_sin_g_x = part_30*sin_g_x
    part_38 = cos_g_x*cos_g_z_w_y + part_30_sin_g_x - cos_g_x*part_31 - part_37
    part_44 = part_38*part_43
    part_45 = I_wx*part_44 + I_wx*(cos_g_z_w_y*g_z_dot + part_37*part_43 - g_z_dot*part_31) - I_wy*part_44
    part_56 = D_x*g_x_dot + K_x*g_x - T_cx
    acceleration_right_3 = 3.0*part_52*part_60*part_64*w_11 - part_45 - part_56
    twice_zeta_x = 2.0*zeta_x
    J_x_freq_x = J_x*freq_x
    acceleration_right_5 = -J_x_freq_x*(eta_x*freq_x + eta_x_dot*twice_zeta_x)
    part_21 = J_z*(eta_z_dot + w_z)
    part_22 = J_y*(eta_y_dot + w_y)
    part_24 = -I_wx - part_23
    part_25 = w_y*w_z
    part_26 = I_y - I_wy - J_y
    cos_g_z_w_x = cos_g_z*w_x
    part_28 = cos_g_x*g_z_dot
    sin_g_z_w_y = sin_g_z*w_y
    w_28 = cos_g_z_w_y - part_31
    part_32 = g_x_dot*w_28
    part_33 = cos_g_x*g_x_dot*part_30 - cos_g_z_w_x*part_28 - part_28*sin_g_z_w_y - part_32*sin_g_x
    part_34 = I_wy*part_33
    part_35 = cos_g_x*part_34
    w_29 = cos_g_z_w_x + sin_g_z_w_y
    part_36 = g_x_dot + w_29
    part_39 = part_36*part_38
    part_40 = I_wx*(cos_g_z*g_z_dot*sin_g_x*w_x + g_z_dot*sin_g_x*sin_g_z*w_y - cos_g_x*part_32 - g_x_dot*part_30_sin_g_x - part_36*part_37) + I_wy*part_39 - I_wx*part_39
    part_41 = part_40*sin_g_x
    part_55 = part_54*sin_phi
    part_58_part_60 = part_58*part_60
    part_62 = -part_58_part_60*w_11
    part_65 = part_60*part_64_w_16
    acceleration_right_0 = J_z*part_55 + cos_g_z*part_65*w_11 + part_22*w_z + part_25*part_26 + part_35*sin_g_z + part_62*part_63*sin_g_z - J_y*part_55 - acceleration_right_3*factor_0_3 - acceleration_right_5 - cos_g_z*part_45 - part_21*w_y - part_24*part_25 - part_41*sin_g_z - part_55*w_18
    twice_zeta_y = 2.0*zeta_y
    J_y_freq_y = J_y*freq_y
    acceleration_right_6 = -J_y_freq_y*(eta_y*freq_y + eta_y_dot*twice_zeta_y)
    part_46 = J_x*(eta_x_dot + w_x)
    part_48 = -I_wx - part_47
    part_49 = w_x*w_z
    part_66 = part_54*w_20
    acceleration_right_1 = J_x*part_66 + cos_g_z*part_41 + part_14*part_65 + part_21*w_x + part_24*part_49 + part_66*(part_23 + w_23) - J_z*part_66 - acceleration_right_0*factor_1_0 - acceleration_right_3*factor_1_3 - acceleration_right_6 - cos_g_z*part_35 - part_16_part_63*part_58_part_60 - part_45*sin_g_z - part_46*w_z - part_48*part_49
    twice_zeta_z = 2.0*zeta_z
    J_z_freq_z = J_z*freq_z
    acceleration_right_7 = -J_z_freq_z*(eta_z*freq_z + eta_z_dot*twice_zeta_z)
    part_50 = w_x*w_y
    part_51 = cos_g_x*part_40 + part_20*part_33
    part_67 = sin_phi*w_20
    acceleration_right_2 = part_46*w_y + part_48*part_50 + w_16*(J_y*part_67 + cos_g_x*part_62 + part_67*w_24 - J_x*part_67) - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_7 - part_22*w_x - part_26*part_50 - part_51
    acceleration_right_4 = T_cz - D_z*g_z_dot - K_z*g_z - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_2*factor_4_2 - cos_g_x_w_11_w_16*part_58_part_60 - part_51
    acceleration_right_8 = motor_torque + part_34 - acceleration_right_0*factor_8_0 - acceleration_right_1*factor_8_1 - acceleration_right_2*factor_8_2 - acceleration_right_4*factor_8_4
    acceleration_8 = acceleration_right_8*inv_rest_4_8_8
    acceleration_4 = acceleration_right_4*inv_rest_2_4_4 - acceleration_8*factor_8_4
    acceleration_2 = acceleration_right_2*inv_rest_1_2_2 - acceleration_4*factor_4_2 - acceleration_8*factor_8_2
    acceleration_1 = acceleration_right_1*inv_rest_0_1_1 - acceleration_2*factor_2_1 - acceleration_4*factor_2_1 - acceleration_8*factor_8_1
    acceleration_0 = acceleration_right_0*inv_rest_3_0_0 - acceleration_1*factor_1_0 - acceleration_2*inv_rest_3_0_0_part_15 - acceleration_4*inv_rest_3_0_0_part_15 - acceleration_8*factor_8_0
    d_part_9_by_g_x = -sin_g_x
    d_part_19_by_g_x = I_wy*d_part_9_by_g_x
    d_mass_9_1_by_g_x = d_part_19_by_g_x*sin_g_z
    d_mass_9_2_by_g_x = -cos_g_z*d_part_19_by_g_x
    w_30 = -part_19
    g_x_dot_part_30 = g_x_dot*part_30
    w_31 = -w_29
    d_part_28_by_g_x = d_part_9_by_g_x*g_z_dot
    d_part_33_by_g_x = d_part_28_by_g_x*w_31 + d_part_9_by_g_x*g_x_dot_part_30 - cos_g_x*part_32
    d_part_34_by_g_x = I_wy*d_part_33_by_g_x
    d_part_10_by_g_x = 2.0*cos_g_x*d_part_9_by_g_x
    d_part_11_by_g_x = I_wy*d_part_10_by_g_x
    d_part_7_by_g_x = 2.0*cos_g_x*sin_g_x
    d_part_8_by_g_x = I_wx*d_part_7_by_g_x
    d_mass_1_1_by_g_x = d_part_11_by_g_x*part_5 + d_part_8_by_g_x*part_5
    d_mass_2_1_by_g_x = -cos_g_z_sin_g_z*d_part_11_by_g_x - cos_g_z_sin_g_z*d_part_8_by_g_x
    d_part_12_by_g_x = cos_g_x*cos_g_x + d_part_9_by_g_x*sin_g_x
    d_part_15_by_g_x = d_part_12_by_g_x*part_14
    d_part_35_by_g_x = cos_g_x*d_part_34_by_g_x + d_part_9_by_g_x*part_34
    w_32 = -w_11
    d_part_38_by_g_x = cos_g_x*part_30 + d_part_9_by_g_x*w_28
    d_part_39_by_g_x = d_part_38_by_g_x*part_36
    d_part_40_by_g_x = I_wx*cos_g_x*(cos_g_z_w_x*g_z_dot + g_z_dot*sin_g_z_w_y - g_x_dot_part_30) + d_part_39_by_g_x*w_32 - I_wx*d_part_9_by_g_x*part_32
    d_part_41_by_g_x = cos_g_x*part_40 + d_part_40_by_g_x*sin_g_x
    I_wx_part_37 = I_wx*part_37
    w_33 = part_31 - cos_g_z_w_y
    d_part_43_by_g_x = cos_g_x*w_33 + d_part_9_by_g_x*part_30
    d_part_44_by_g_x = d_part_38_by_g_x*part_43 + d_part_43_by_g_x*part_38
    d_part_45_by_g_x = I_wx_part_37*d_part_43_by_g_x + d_part_44_by_g_x*w_11
    d_part_60_by_g_x = cos_g_x*cos_phi_cos_theta + d_part_9_by_g_x*part_59
    d_part_60_by_g_x_part_58 = d_part_60_by_g_x*part_58
    d_part_62_by_g_x = -d_part_60_by_g_x_part_58*w_11
    d_part_64_by_g_x = cos_phi_cos_theta*d_part_9_by_g_x - cos_g_x*part_59
    d_part_65_by_g_x = d_part_60_by_g_x*part_64_w_16 + d_part_64_by_g_x*part_60_w_16
    slope_g_x_right_3 = 3.0*d_part_60_by_g_x*part_52*part_64*w_11 + 3.0*d_part_64_by_g_x*part_52*part_60*w_11 - K_x - d_part_45_by_g_x
    slope_g_x_right_0 = cos_g_x_w_16*part_62*sin_g_z + cos_g_z*d_part_65_by_g_x*w_11 + d_part_35_by_g_x*sin_g_z + d_part_62_by_g_x*part_63*sin_g_z - acceleration_0*d_mass_1_1_by_g_x - acceleration_1*d_mass_2_1_by_g_x - acceleration_2*d_part_15_by_g_x - acceleration_4*d_part_15_by_g_x - acceleration_8*d_mass_9_1_by_g_x - cos_g_z*d_part_45_by_g_x - d_part_41_by_g_x*sin_g_z - factor_0_3*slope_g_x_right_3
    d_mass_2_2_by_g_x = d_part_11_by_g_x*part_2 + d_part_7_by_g_x*part_3
    d_part_17_by_g_x = d_part_12_by_g_x*part_16
    slope_g_x_right_1 = cos_g_z*d_part_41_by_g_x + d_part_65_by_g_x*part_14 - acceleration_0*d_mass_2_1_by_g_x - acceleration_1*d_mass_2_2_by_g_x - acceleration_2*d_part_17_by_g_x - acceleration_4*d_part_17_by_g_x - acceleration_8*d_mass_9_2_by_g_x - cos_g_x_w_16*part_16*part_58_part_60 - cos_g_z*d_part_35_by_g_x - d_part_45_by_g_x*sin_g_z - d_part_60_by_g_x_part_58*part_16_part_63 - factor_1_0*slope_g_x_right_0 - factor_1_3*slope_g_x_right_3
    d_part_18_by_g_x = I_wx*d_part_10_by_g_x + I_wy*d_part_7_by_g_x
    d_part_51_by_g_x = cos_g_x*d_part_40_by_g_x + d_part_33_by_g_x*part_20 + d_part_9_by_g_x*part_40 + part_19*part_33
    w_34 = acceleration_0*d_part_15_by_g_x + acceleration_1*d_part_17_by_g_x + acceleration_2*d_part_18_by_g_x + acceleration_4*d_part_18_by_g_x + d_part_51_by_g_x
    slope_g_x_right_2 = cos_g_x*d_part_62_by_g_x*w_16 + d_part_9_by_g_x*part_62*w_16 - acceleration_8*w_30 - factor_2_1*slope_g_x_right_1 - inv_rest_3_0_0_part_15*slope_g_x_right_0 - w_34
    slope_g_x_right_4 = -acceleration_8*w_30 - cos_g_x_w_11_w_16*d_part_60_by_g_x_part_58 - d_part_9_by_g_x*part_58_part_60*w_11_w_16 - factor_2_1*slope_g_x_right_1 - factor_4_2*slope_g_x_right_2 - inv_rest_3_0_0_part_15*slope_g_x_right_0 - w_34
    slope_g_x_right_8 = d_part_34_by_g_x - acceleration_0*d_mass_9_1_by_g_x - acceleration_1*d_mass_9_2_by_g_x - acceleration_2*w_30 - acceleration_4*w_30 - factor_8_0*slope_g_x_right_0 - factor_8_1*slope_g_x_right_1 - factor_8_2*slope_g_x_right_2 - factor_8_4*slope_g_x_right_4
    slope_g_x_8 = inv_rest_4_8_8*slope_g_x_right_8
    slope_g_x_4 = inv_rest_2_4_4*slope_g_x_right_4 - factor_8_4*slope_g_x_8
    slope_g_x_2 = inv_rest_1_2_2*slope_g_x_right_2 - factor_4_2*slope_g_x_4 - factor_8_2*slope_g_x_8
    slope_g_x_1 = inv_rest_0_1_1*slope_g_x_right_1 - factor_2_1*slope_g_x_2 - factor_2_1*slope_g_x_4 - factor_8_1*slope_g_x_8
    slope_g_x_0 = inv_rest_3_0_0*slope_g_x_right_0 - factor_1_0*slope_g_x_1 - factor_8_0*slope_g_x_8 - inv_rest_3_0_0_part_15*slope_g_x_2 - inv_rest_3_0_0_part_15*slope_g_x_4
    d_mass_9_1_by_g_z = cos_g_z*part_19
    d_part_1_by_g_z = -sin_g_z
    d_mass_9_2_by_g_z = -d_part_1_by_g_z*part_19
    d_part_1_by_g_z_w_x = d_part_1_by_g_z*w_x
    d_part_1_by_g_z_w_y = d_part_1_by_g_z*w_y
    d_part_32_by_g_z = d_part_1_by_g_z_w_y*g_x_dot - cos_g_z_w_x*g_x_dot
    d_part_33_by_g_z = -cos_g_z_w_y*part_28 - d_part_1_by_g_z_w_x*part_28 - d_part_32_by_g_z*sin_g_x
    d_part_34_by_g_z = I_wy*d_part_33_by_g_z
    w_35 = part_35 - part_41
    acceleration_3 = acceleration_right_3*inv_I_wx - acceleration_0*factor_0_3 - acceleration_1*factor_1_3
    d_part_2_by_g_z = 2.0*cos_g_z*d_part_1_by_g_z
    d_part_3_by_g_z = I_wx*d_part_2_by_g_z
    d_part_5_by_g_z = 2.0*cos_g_z*sin_g_z
    d_mass_1_1_by_g_z = d_part_3_by_g_z + d_part_5_by_g_z*w_8
    d_mass_2_1_by_g_z = cos_g_z*cos_g_z*w_9 + d_part_1_by_g_z*sin_g_z*w_9
    d_mass_4_1_by_g_z = I_wx*d_part_1_by_g_z
    d_part_15_by_g_z = cos_g_z_w_11*part_12
    d_part_35_by_g_z = cos_g_x*d_part_34_by_g_z
    I_wx_cos_g_x = I_wx*cos_g_x
    I_wx_g_z_dot = I_wx*g_z_dot
    I_wx_g_z_dot_sin_g_x = I_wx_g_z_dot*sin_g_x
    d_part_36_by_g_z = cos_g_z_w_y + d_part_1_by_g_z_w_x
    d_part_38_by_g_z = cos_g_x*d_part_1_by_g_z_w_y - cos_g_x*cos_g_z_w_x
    d_part_39_by_g_z = d_part_36_by_g_z*part_38 + d_part_38_by_g_z*part_36
    d_part_40_by_g_z = I_wx_g_z_dot_sin_g_x*cos_g_z_w_y + I_wx_g_z_dot_sin_g_x*d_part_1_by_g_z_w_x + d_part_39_by_g_z*w_32 - I_wx_cos_g_x*d_part_32_by_g_z - I_wx_part_37*d_part_36_by_g_z
    d_part_41_by_g_z = d_part_40_by_g_z*sin_g_x
    d_part_43_by_g_z = cos_g_z_w_x*sin_g_x - d_part_1_by_g_z_w_y*sin_g_x
    d_part_44_by_g_z = d_part_38_by_g_z*part_43 + d_part_43_by_g_z*part_38
    d_part_45_by_g_z = I_wx_g_z_dot*d_part_1_by_g_z_w_y + I_wx_part_37*d_part_43_by_g_z + d_part_44_by_g_z*w_11 - I_wx_g_z_dot*cos_g_z_w_x
    d_part_58_by_g_z = cos_g_z*sin_phi + d_part_1_by_g_z*w_20
    d_part_58_by_g_z_part_60 = d_part_58_by_g_z*part_60
    d_part_59_by_g_z = d_part_1_by_g_z*sin_phi - cos_g_z*w_20
    d_part_60_by_g_z = cos_g_x*d_part_59_by_g_z
    d_part_60_by_g_z_part_58 = d_part_60_by_g_z*part_58
    d_part_61_by_g_z = d_part_58_by_g_z_part_60 + d_part_60_by_g_z_part_58
    d_part_62_by_g_z = -d_part_61_by_g_z*w_11
    d_part_64_by_g_z = -d_part_59_by_g_z*sin_g_x
    d_part_65_by_g_z = d_part_60_by_g_z*part_64_w_16 + d_part_64_by_g_z*part_60_w_16
    slope_g_z_right_3 = 3.0*d_part_60_by_g_z*part_52*part_64*w_11 + 3.0*d_part_64_by_g_z*part_52*part_60*w_11 - I_wx_cos_g_z*acceleration_1 - acceleration_0*d_mass_4_1_by_g_z - d_part_45_by_g_z
    slope_g_z_right_0 = cos_g_z*d_part_65_by_g_z*w_11 + cos_g_z*(part_62*part_63 + w_35) + d_part_1_by_g_z*(part_65*w_11 - part_45) + d_part_35_by_g_z*sin_g_z + d_part_62_by_g_z*part_63*sin_g_z - acceleration_0*d_mass_1_1_by_g_z - acceleration_1*d_mass_2_1_by_g_z - acceleration_2*d_part_15_by_g_z - acceleration_3*d_mass_4_1_by_g_z - acceleration_4*d_part_15_by_g_z - acceleration_8*d_mass_9_1_by_g_z - cos_g_z*d_part_45_by_g_z - d_part_41_by_g_z*sin_g_z - factor_0_3*slope_g_z_right_3
    d_mass_2_2_by_g_z = I_wx*d_part_5_by_g_z + d_part_2_by_g_z*part_11 + d_part_3_by_g_z*part_7
    d_part_16_by_g_z = -d_part_1_by_g_z*w_11
    d_part_17_by_g_z = d_part_16_by_g_z*part_12
    slope_g_z_right_1 = cos_g_z*d_part_41_by_g_z + cos_g_z_w_11*part_65 + d_part_65_by_g_z*part_14 - I_wx_cos_g_z*acceleration_3 - acceleration_0*d_mass_2_1_by_g_z - acceleration_1*d_mass_2_2_by_g_z - acceleration_2*d_part_17_by_g_z - acceleration_4*d_part_17_by_g_z - acceleration_8*d_mass_9_2_by_g_z - cos_g_z*d_part_35_by_g_z - cos_g_z*part_45 - d_part_16_by_g_z*part_58_part_60*part_63 - d_part_1_by_g_z*w_35 - d_part_45_by_g_z*sin_g_z - d_part_61_by_g_z*part_16_part_63 - factor_1_0*slope_g_z_right_0 - factor_1_3*slope_g_z_right_3
    d_part_51_by_g_z = cos_g_x*d_part_40_by_g_z + d_part_33_by_g_z*part_20
    w_36 = acceleration_0*d_part_15_by_g_z + acceleration_1*d_part_17_by_g_z + d_part_51_by_g_z
    slope_g_z_right_2 = cos_g_x*d_part_62_by_g_z*w_16 - factor_2_1*slope_g_z_right_1 - inv_rest_3_0_0_part_15*slope_g_z_right_0 - w_36
    slope_g_z_right_4 = -K_z - cos_g_x_w_11_w_16*d_part_58_by_g_z_part_60 - cos_g_x_w_11_w_16*d_part_60_by_g_z_part_58 - factor_2_1*slope_g_z_right_1 - factor_4_2*slope_g_z_right_2 - inv_rest_3_0_0_part_15*slope_g_z_right_0 - w_36
    slope_g_z_right_8 = d_part_34_by_g_z - acceleration_0*d_mass_9_1_by_g_z - acceleration_1*d_mass_9_2_by_g_z - factor_8_0*slope_g_z_right_0 - factor_8_1*slope_g_z_right_1 - factor_8_2*slope_g_z_right_2 - factor_8_4*slope_g_z_right_4
    slope_g_z_8 = inv_rest_4_8_8*slope_g_z_right_8
    slope_g_z_4 = inv_rest_2_4_4*slope_g_z_right_4 - factor_8_4*slope_g_z_8
    slope_g_z_2 = inv_rest_1_2_2*slope_g_z_right_2 - factor_4_2*slope_g_z_4 - factor_8_2*slope_g_z_8
    slope_g_z_1 = inv_rest_0_1_1*slope_g_z_right_1 - factor_2_1*slope_g_z_2 - factor_2_1*slope_g_z_4 - factor_8_1*slope_g_z_8
    slope_g_z_0 = inv_rest_3_0_0*slope_g_z_right_0 - factor_1_0*slope_g_z_1 - factor_8_0*slope_g_z_8 - inv_rest_3_0_0_part_15*slope_g_z_2 - inv_rest_3_0_0_part_15*slope_g_z_4
    slope_eta_x_right_5 = -J_x*freq_x*freq_x
    slope_eta_x_right_0 = -slope_eta_x_right_5
    slope_eta_x_right_1 = -factor_1_0*slope_eta_x_right_0
    slope_eta_x_right_2 = -factor_2_1*slope_eta_x_right_1 - inv_rest_3_0_0_part_15*slope_eta_x_right_0
    slope_eta_x_right_4 = -factor_2_1*slope_eta_x_right_1 - factor_4_2*slope_eta_x_right_2 - inv_rest_3_0_0_part_15*slope_eta_x_right_0
    slope_eta_x_right_8 = -factor_8_0*slope_eta_x_right_0 - factor_8_1*slope_eta_x_right_1 - factor_8_2*slope_eta_x_right_2 - factor_8_4*slope_eta_x_right_4
    slope_eta_x_8 = inv_rest_4_8_8*slope_eta_x_right_8
    slope_eta_x_4 = inv_rest_2_4_4*slope_eta_x_right_4 - factor_8_4*slope_eta_x_8
    slope_eta_x_2 = inv_rest_1_2_2*slope_eta_x_right_2 - factor_4_2*slope_eta_x_4 - factor_8_2*slope_eta_x_8
    slope_eta_x_1 = inv_rest_0_1_1*slope_eta_x_right_1 - factor_2_1*slope_eta_x_2 - factor_2_1*slope_eta_x_4 - factor_8_1*slope_eta_x_8
    slope_eta_x_0 = inv_rest_3_0_0*slope_eta_x_right_0 - factor_1_0*slope_eta_x_1 - factor_8_0*slope_eta_x_8 - inv_rest_3_0_0_part_15*slope_eta_x_2 - inv_rest_3_0_0_part_15*slope_eta_x_4
    slope_eta_y_right_6 = -J_y*freq_y*freq_y
    slope_eta_y_right_1 = -slope_eta_y_right_6
    slope_eta_y_right_2 = -factor_2_1*slope_eta_y_right_1
    slope_eta_y_right_4 = -factor_2_1*slope_eta_y_right_1 - factor_4_2*slope_eta_y_right_2
    slope_eta_y_right_8 = -factor_8_1*slope_eta_y_right_1 - factor_8_2*slope_eta_y_right_2 - factor_8_4*slope_eta_y_right_4
    slope_eta_y_8 = inv_rest_4_8_8*slope_eta_y_right_8
    slope_eta_y_4 = inv_rest_2_4_4*slope_eta_y_right_4 - factor_8_4*slope_eta_y_8
    slope_eta_y_2 = inv_rest_1_2_2*slope_eta_y_right_2 - factor_4_2*slope_eta_y_4 - factor_8_2*slope_eta_y_8
    slope_eta_y_1 = inv_rest_0_1_1*slope_eta_y_right_1 - factor_2_1*slope_eta_y_2 - factor_2_1*slope_eta_y_4 - factor_8_1*slope_eta_y_8
    slope_eta_y_0 = -factor_1_0*slope_eta_y_1 - factor_8_0*slope_eta_y_8 - inv_rest_3_0_0_part_15*slope_eta_y_2 - inv_rest_3_0_0_part_15*slope_eta_y_4
    slope_eta_z_right_7 = -J_z*freq_z*freq_z
    slope_eta_z_right_2 = -slope_eta_z_right_7
    slope_eta_z_right_4 = -factor_4_2*slope_eta_z_right_2
    slope_eta_z_right_8 = -factor_8_2*slope_eta_z_right_2 - factor_8_4*slope_eta_z_right_4
    slope_eta_z_8 = inv_rest_4_8_8*slope_eta_z_right_8
    slope_eta_z_4 = inv_rest_2_4_4*slope_eta_z_right_4 - factor_8_4*slope_eta_z_8
    slope_eta_z_2 = inv_rest_1_2_2*slope_eta_z_right_2 - factor_4_2*slope_eta_z_4 - factor_8_2*slope_eta_z_8
    slope_eta_z_1 = -factor_2_1*slope_eta_z_2 - factor_2_1*slope_eta_z_4 - factor_8_1*slope_eta_z_8
    slope_eta_z_0 = -factor_1_0*slope_eta_z_1 - factor_8_0*slope_eta_z_8 - inv_rest_3_0_0_part_15*slope_eta_z_2 - inv_rest_3_0_0_part_15*slope_eta_z_4
    d_part_32_by_w_x = -g_x_dot*sin_g_z
    d_part_33_by_w_x = -cos_g_z*part_28 - d_part_32_by_w_x*sin_g_x
    d_part_34_by_w_x = I_wy*d_part_33_by_w_x
    d_part_35_by_w_x = cos_g_x*d_part_34_by_w_x
    d_part_38_by_w_x = -cos_g_x*sin_g_z
    d_part_39_by_w_x = cos_g_z*part_38 + d_part_38_by_w_x*part_36
    d_part_40_by_w_x = I_wx*cos_g_z*g_z_dot*sin_g_x + d_part_39_by_w_x*w_32 - I_wx_cos_g_x*d_part_32_by_w_x - I_wx_cos_g_z*part_37
    d_part_41_by_w_x = d_part_40_by_w_x*sin_g_x
    d_part_43_by_w_x = sin_g_x*sin_g_z
    d_part_44_by_w_x = d_part_38_by_w_x*part_43 + d_part_43_by_w_x*part_38
    d_part_45_by_w_x = I_wx_part_37*d_part_43_by_w_x + d_part_44_by_w_x*w_11 - I_wx_sin_g_z*g_z_dot
    slope_w_x_right_3 = -d_part_45_by_w_x
    slope_w_x_right_0 = d_part_35_by_w_x*sin_g_z - cos_g_z*d_part_45_by_w_x - d_part_41_by_w_x*sin_g_z - factor_0_3*slope_w_x_right_3
    J_x_w_z = J_x*w_z
    w_37 = -part_48
    w_38 = part_24 + w_37
    slope_w_x_right_1 = cos_g_z*d_part_41_by_w_x + part_21 + w_38*w_z - J_x_w_z - cos_g_z*d_part_35_by_w_x - d_part_45_by_w_x*sin_g_z - factor_1_0*slope_w_x_right_0 - factor_1_3*slope_w_x_right_3
    w_39 = -J_x*w_y
    w_40 = -part_26 - w_37
    d_part_51_by_w_x = cos_g_x*d_part_40_by_w_x + d_part_33_by_w_x*part_20
    slope_w_x_right_2 = w_40*w_y - d_part_51_by_w_x - factor_2_1*slope_w_x_right_1 - inv_rest_3_0_0_part_15*slope_w_x_right_0 - part_22 - w_39
    slope_w_x_right_4 = -d_part_51_by_w_x - factor_2_1*slope_w_x_right_1 - factor_4_2*slope_w_x_right_2 - inv_rest_3_0_0_part_15*slope_w_x_right_0
    slope_w_x_right_8 = d_part_34_by_w_x - factor_8_0*slope_w_x_right_0 - factor_8_1*slope_w_x_right_1 - factor_8_2*slope_w_x_right_2 - factor_8_4*slope_w_x_right_4
    slope_w_x_8 = inv_rest_4_8_8*slope_w_x_right_8
    slope_w_x_4 = inv_rest_2_4_4*slope_w_x_right_4 - factor_8_4*slope_w_x_8
    slope_w_x_2 = inv_rest_1_2_2*slope_w_x_right_2 - factor_4_2*slope_w_x_4 - factor_8_2*slope_w_x_8
    slope_w_x_1 = inv_rest_0_1_1*slope_w_x_right_1 - factor_2_1*slope_w_x_2 - factor_2_1*slope_w_x_4 - factor_8_1*slope_w_x_8
    slope_w_x_0 = inv_rest_3_0_0*slope_w_x_right_0 - factor_1_0*slope_w_x_1 - factor_8_0*slope_w_x_8 - inv_rest_3_0_0_part_15*slope_w_x_2 - inv_rest_3_0_0_part_15*slope_w_x_4
    d_part_32_by_w_y = cos_g_z*g_x_dot
    d_part_33_by_w_y = -d_part_32_by_w_y*sin_g_x - part_28*sin_g_z
    d_part_34_by_w_y = I_wy*d_part_33_by_w_y
    w_41 = part_26 - part_24
    d_part_35_by_w_y = cos_g_x*d_part_34_by_w_y
    d_part_38_by_w_y = cos_g_x*cos_g_z
    d_part_39_by_w_y = d_part_38_by_w_y*part_36 + part_38*sin_g_z
    d_part_40_by_w_y = I_wx*g_z_dot*sin_g_x*sin_g_z + d_part_39_by_w_y*w_32 - I_wx_cos_g_x*d_part_32_by_w_y - I_wx_sin_g_z*part_37
    d_part_41_by_w_y = d_part_40_by_w_y*sin_g_x
    d_part_43_by_w_y = -cos_g_z*sin_g_x
    d_part_44_by_w_y = d_part_38_by_w_y*part_43 + d_part_43_by_w_y*part_38
    d_part_45_by_w_y = I_wx_cos_g_z*g_z_dot + I_wx_part_37*d_part_43_by_w_y + d_part_44_by_w_y*w_11
    slope_w_y_right_3 = -d_part_45_by_w_y
    slope_w_y_right_0 = J_y*w_z + d_part_35_by_w_y*sin_g_z + w_41*w_z - cos_g_z*d_part_45_by_w_y - d_part_41_by_w_y*sin_g_z - factor_0_3*slope_w_y_right_3 - part_21
    slope_w_y_right_1 = cos_g_z*d_part_41_by_w_y - cos_g_z*d_part_35_by_w_y - d_part_45_by_w_y*sin_g_z - factor_1_0*slope_w_y_right_0 - factor_1_3*slope_w_y_right_3
    J_y_w_x = J_y*w_x
    d_part_51_by_w_y = cos_g_x*d_part_40_by_w_y + d_part_33_by_w_y*part_20
    slope_w_y_right_2 = part_46 + w_40*w_x - J_y_w_x - d_part_51_by_w_y - factor_2_1*slope_w_y_right_1 - inv_rest_3_0_0_part_15*slope_w_y_right_0
    slope_w_y_right_4 = -d_part_51_by_w_y - factor_2_1*slope_w_y_right_1 - factor_4_2*slope_w_y_right_2 - inv_rest_3_0_0_part_15*slope_w_y_right_0
    slope_w_y_right_8 = d_part_34_by_w_y - factor_8_0*slope_w_y_right_0 - factor_8_1*slope_w_y_right_1 - factor_8_2*slope_w_y_right_2 - factor_8_4*slope_w_y_right_4
    slope_w_y_8 = inv_rest_4_8_8*slope_w_y_right_8
    slope_w_y_4 = inv_rest_2_4_4*slope_w_y_right_4 - factor_8_4*slope_w_y_8
    slope_w_y_2 = inv_rest_1_2_2*slope_w_y_right_2 - factor_4_2*slope_w_y_4 - factor_8_2*slope_w_y_8
    slope_w_y_1 = inv_rest_0_1_1*slope_w_y_right_1 - factor_2_1*slope_w_y_2 - factor_2_1*slope_w_y_4 - factor_8_1*slope_w_y_8
    slope_w_y_0 = inv_rest_3_0_0*slope_w_y_right_0 - factor_1_0*slope_w_y_1 - factor_8_0*slope_w_y_8 - inv_rest_3_0_0_part_15*slope_w_y_2 - inv_rest_3_0_0_part_15*slope_w_y_4
    cos_g_x_g_x_dot = cos_g_x*g_x_dot
    d_part_34_by_w_z = I_wy*cos_g_x_g_x_dot
    J_z_w_y = J_z*w_y
    d_part_35_by_w_z = cos_g_x*d_part_34_by_w_z
    I_wx_g_x_dot_sin_g_x = I_wx*g_x_dot*sin_g_x
    part_36_sin_g_x = part_36*sin_g_x
    d_part_40_by_w_z = part_36_sin_g_x*w_32 - I_wx_g_x_dot_sin_g_x
    d_part_41_by_w_z = d_part_40_by_w_z*sin_g_x
    I_wx_part_37_cos_g_x = I_wx_part_37*cos_g_x
    w_42 = cos_g_x*part_38 + part_43*sin_g_x
    d_part_45_by_w_z = I_wx_part_37_cos_g_x + w_11*w_42
    slope_w_z_right_3 = -d_part_45_by_w_z
    slope_w_z_right_0 = d_part_35_by_w_z*sin_g_z + part_22 + w_41*w_y - J_z_w_y - cos_g_z*d_part_45_by_w_z - d_part_41_by_w_z*sin_g_z - factor_0_3*slope_w_z_right_3
    slope_w_z_right_1 = J_z*w_x + cos_g_z*d_part_41_by_w_z + w_38*w_x - cos_g_z*d_part_35_by_w_z - d_part_45_by_w_z*sin_g_z - factor_1_0*slope_w_z_right_0 - factor_1_3*slope_w_z_right_3 - part_46
    d_part_51_by_w_z = cos_g_x*d_part_40_by_w_z + cos_g_x_g_x_dot*part_20
    slope_w_z_right_2 = -d_part_51_by_w_z - factor_2_1*slope_w_z_right_1 - inv_rest_3_0_0_part_15*slope_w_z_right_0
    slope_w_z_right_4 = -d_part_51_by_w_z - factor_2_1*slope_w_z_right_1 - factor_4_2*slope_w_z_right_2 - inv_rest_3_0_0_part_15*slope_w_z_right_0
    slope_w_z_right_8 = d_part_34_by_w_z - factor_8_0*slope_w_z_right_0 - factor_8_1*slope_w_z_right_1 - factor_8_2*slope_w_z_right_2 - factor_8_4*slope_w_z_right_4
    slope_w_z_8 = inv_rest_4_8_8*slope_w_z_right_8
    slope_w_z_4 = inv_rest_2_4_4*slope_w_z_right_4 - factor_8_4*slope_w_z_8
    slope_w_z_2 = inv_rest_1_2_2*slope_w_z_right_2 - factor_4_2*slope_w_z_4 - factor_8_2*slope_w_z_8
    slope_w_z_1 = inv_rest_0_1_1*slope_w_z_right_1 - factor_2_1*slope_w_z_2 - factor_2_1*slope_w_z_4 - factor_8_1*slope_w_z_8
    slope_w_z_0 = inv_rest_3_0_0*slope_w_z_right_0 - factor_1_0*slope_w_z_1 - factor_8_0*slope_w_z_8 - inv_rest_3_0_0_part_15*slope_w_z_2 - inv_rest_3_0_0_part_15*slope_w_z_4
    d_part_33_by_g_x_dot = cos_g_x*part_30 - sin_g_x*w_28
    d_part_34_by_g_x_dot = I_wy*d_part_33_by_g_x_dot
    d_part_35_by_g_x_dot = cos_g_x*d_part_34_by_g_x_dot
    d_part_40_by_g_x_dot = part_38*w_32 - I_wx*part_30_sin_g_x - I_wx_cos_g_x*w_28 - I_wx_part_37
    d_part_41_by_g_x_dot = d_part_40_by_g_x_dot*sin_g_x
    slope_g_x_dot_right_3 = -D_x
    slope_g_x_dot_right_0 = d_part_35_by_g_x_dot*sin_g_z - d_part_41_by_g_x_dot*sin_g_z - factor_0_3*slope_g_x_dot_right_3
    slope_g_x_dot_right_1 = cos_g_z*d_part_41_by_g_x_dot - cos_g_z*d_part_35_by_g_x_dot - factor_1_0*slope_g_x_dot_right_0 - factor_1_3*slope_g_x_dot_right_3
    d_part_51_by_g_x_dot = cos_g_x*d_part_40_by_g_x_dot + d_part_33_by_g_x_dot*part_20
    slope_g_x_dot_right_2 = -d_part_51_by_g_x_dot - factor_2_1*slope_g_x_dot_right_1 - inv_rest_3_0_0_part_15*slope_g_x_dot_right_0
    slope_g_x_dot_right_4 = -d_part_51_by_g_x_dot - factor_2_1*slope_g_x_dot_right_1 - factor_4_2*slope_g_x_dot_right_2 - inv_rest_3_0_0_part_15*slope_g_x_dot_right_0
    slope_g_x_dot_right_8 = d_part_34_by_g_x_dot - factor_8_0*slope_g_x_dot_right_0 - factor_8_1*slope_g_x_dot_right_1 - factor_8_2*slope_g_x_dot_right_2 - factor_8_4*slope_g_x_dot_right_4
    slope_g_x_dot_8 = inv_rest_4_8_8*slope_g_x_dot_right_8
    slope_g_x_dot_4 = inv_rest_2_4_4*slope_g_x_dot_right_4 - factor_8_4*slope_g_x_dot_8
    slope_g_x_dot_2 = inv_rest_1_2_2*slope_g_x_dot_right_2 - factor_4_2*slope_g_x_dot_4 - factor_8_2*slope_g_x_dot_8
    slope_g_x_dot_1 = inv_rest_0_1_1*slope_g_x_dot_right_1 - factor_2_1*slope_g_x_dot_2 - factor_2_1*slope_g_x_dot_4 - factor_8_1*slope_g_x_dot_8
    slope_g_x_dot_0 = inv_rest_3_0_0*slope_g_x_dot_right_0 - factor_1_0*slope_g_x_dot_1 - factor_8_0*slope_g_x_dot_8 - inv_rest_3_0_0_part_15*slope_g_x_dot_2 - inv_rest_3_0_0_part_15*slope_g_x_dot_4
    d_part_33_by_g_z_dot = cos_g_x*w_31 + cos_g_x_g_x_dot
    d_part_34_by_g_z_dot = I_wy*d_part_33_by_g_z_dot
    d_part_35_by_g_z_dot = cos_g_x*d_part_34_by_g_z_dot
    d_part_40_by_g_z_dot = I_wx*(cos_g_z_w_x*sin_g_x + sin_g_x*sin_g_z_w_y) + part_36_sin_g_x*w_32 - I_wx_g_x_dot_sin_g_x
    d_part_41_by_g_z_dot = d_part_40_by_g_z_dot*sin_g_x
    d_part_45_by_g_z_dot = I_wx_part_37_cos_g_x + w_11*w_42 - I_wx*w_33
    slope_g_z_dot_right_3 = -d_part_45_by_g_z_dot
    slope_g_z_dot_right_0 = d_part_35_by_g_z_dot*sin_g_z - cos_g_z*d_part_45_by_g_z_dot - d_part_41_by_g_z_dot*sin_g_z - factor_0_3*slope_g_z_dot_right_3
    slope_g_z_dot_right_1 = cos_g_z*d_part_41_by_g_z_dot - cos_g_z*d_part_35_by_g_z_dot - d_part_45_by_g_z_dot*sin_g_z - factor_1_0*slope_g_z_dot_right_0 - factor_1_3*slope_g_z_dot_right_3
    d_part_51_by_g_z_dot = cos_g_x*d_part_40_by_g_z_dot + d_part_33_by_g_z_dot*part_20
    slope_g_z_dot_right_2 = -d_part_51_by_g_z_dot - factor_2_1*slope_g_z_dot_right_1 - inv_rest_3_0_0_part_15*slope_g_z_dot_right_0
    slope_g_z_dot_right_4 = -D_z - d_part_51_by_g_z_dot - factor_2_1*slope_g_z_dot_right_1 - factor_4_2*slope_g_z_dot_right_2 - inv_rest_3_0_0_part_15*slope_g_z_dot_right_0
    slope_g_z_dot_right_8 = d_part_34_by_g_z_dot - factor_8_0*slope_g_z_dot_right_0 - factor_8_1*slope_g_z_dot_right_1 - factor_8_2*slope_g_z_dot_right_2 - factor_8_4*slope_g_z_dot_right_4
    slope_g_z_dot_8 = inv_rest_4_8_8*slope_g_z_dot_right_8
    slope_g_z_dot_4 = inv_rest_2_4_4*slope_g_z_dot_right_4 - factor_8_4*slope_g_z_dot_8
    slope_g_z_dot_2 = inv_rest_1_2_2*slope_g_z_dot_right_2 - factor_4_2*slope_g_z_dot_4 - factor_8_2*slope_g_z_dot_8
    slope_g_z_dot_1 = inv_rest_0_1_1*slope_g_z_dot_right_1 - factor_2_1*slope_g_z_dot_2 - factor_2_1*slope_g_z_dot_4 - factor_8_1*slope_g_z_dot_8
    slope_g_z_dot_0 = inv_rest_3_0_0*slope_g_z_dot_right_0 - factor_1_0*slope_g_z_dot_1 - factor_8_0*slope_g_z_dot_8 - inv_rest_3_0_0_part_15*slope_g_z_dot_2 - inv_rest_3_0_0_part_15*slope_g_z_dot_4
    slope_eta_x_dot_right_5 = -J_x_freq_x*twice_zeta_x
    slope_eta_x_dot_right_0 = -slope_eta_x_dot_right_5
    slope_eta_x_dot_right_1 = -J_x_w_z - factor_1_0*slope_eta_x_dot_right_0
    slope_eta_x_dot_right_2 = -factor_2_1*slope_eta_x_dot_right_1 - inv_rest_3_0_0_part_15*slope_eta_x_dot_right_0 - w_39
    slope_eta_x_dot_right_4 = -factor_2_1*slope_eta_x_dot_right_1 - factor_4_2*slope_eta_x_dot_right_2 - inv_rest_3_0_0_part_15*slope_eta_x_dot_right_0
    slope_eta_x_dot_right_8 = -factor_8_0*slope_eta_x_dot_right_0 - factor_8_1*slope_eta_x_dot_right_1 - factor_8_2*slope_eta_x_dot_right_2 - factor_8_4*slope_eta_x_dot_right_4
    slope_eta_x_dot_8 = inv_rest_4_8_8*slope_eta_x_dot_right_8
    slope_eta_x_dot_4 = inv_rest_2_4_4*slope_eta_x_dot_right_4 - factor_8_4*slope_eta_x_dot_8
    slope_eta_x_dot_2 = inv_rest_1_2_2*slope_eta_x_dot_right_2 - factor_4_2*slope_eta_x_dot_4 - factor_8_2*slope_eta_x_dot_8
    slope_eta_x_dot_1 = inv_rest_0_1_1*slope_eta_x_dot_right_1 - factor_2_1*slope_eta_x_dot_2 - factor_2_1*slope_eta_x_dot_4 - factor_8_1*slope_eta_x_dot_8
    slope_eta_x_dot_0 = inv_rest_3_0_0*slope_eta_x_dot_right_0 - factor_1_0*slope_eta_x_dot_1 - factor_8_0*slope_eta_x_dot_8 - inv_rest_3_0_0_part_15*slope_eta_x_dot_2 - inv_rest_3_0_0_part_15*slope_eta_x_dot_4
    slope_eta_y_dot_right_0 = J_y*w_z
    slope_eta_y_dot_right_6 = -J_y_freq_y*twice_zeta_y
    slope_eta_y_dot_right_1 = -factor_1_0*slope_eta_y_dot_right_0 - slope_eta_y_dot_right_6
    slope_eta_y_dot_right_2 = -J_y_w_x - factor_2_1*slope_eta_y_dot_right_1 - inv_rest_3_0_0_part_15*slope_eta_y_dot_right_0
    slope_eta_y_dot_right_4 = -factor_2_1*slope_eta_y_dot_right_1 - factor_4_2*slope_eta_y_dot_right_2 - inv_rest_3_0_0_part_15*slope_eta_y_dot_right_0
    slope_eta_y_dot_right_8 = -factor_8_0*slope_eta_y_dot_right_0 - factor_8_1*slope_eta_y_dot_right_1 - factor_8_2*slope_eta_y_dot_right_2 - factor_8_4*slope_eta_y_dot_right_4
    slope_eta_y_dot_8 = inv_rest_4_8_8*slope_eta_y_dot_right_8
    slope_eta_y_dot_4 = inv_rest_2_4_4*slope_eta_y_dot_right_4 - factor_8_4*slope_eta_y_dot_8
    slope_eta_y_dot_2 = inv_rest_1_2_2*slope_eta_y_dot_right_2 - factor_4_2*slope_eta_y_dot_4 - factor_8_2*slope_eta_y_dot_8
    slope_eta_y_dot_1 = inv_rest_0_1_1*slope_eta_y_dot_right_1 - factor_2_1*slope_eta_y_dot_2 - factor_2_1*slope_eta_y_dot_4 - factor_8_1*slope_eta_y_dot_8
    slope_eta_y_dot_0 = inv_rest_3_0_0*slope_eta_y_dot_right_0 - factor_1_0*slope_eta_y_dot_1 - factor_8_0*slope_eta_y_dot_8 - inv_rest_3_0_0_part_15*slope_eta_y_dot_2 - inv_rest_3_0_0_part_15*slope_eta_y_dot_4
    slope_eta_z_dot_right_0 = -J_z_w_y
    slope_eta_z_dot_right_1 = J_z*w_x - factor_1_0*slope_eta_z_dot_right_0
    slope_eta_z_dot_right_7 = -J_z_freq_z*twice_zeta_z
    slope_eta_z_dot_right_2 = -factor_2_1*slope_eta_z_dot_right_1 - inv_rest_3_0_0_part_15*slope_eta_z_dot_right_0 - slope_eta_z_dot_right_7
    slope_eta_z_dot_right_4 = -factor_2_1*slope_eta_z_dot_right_1 - factor_4_2*slope_eta_z_dot_right_2 - inv_rest_3_0_0_part_15*slope_eta_z_dot_right_0
    slope_eta_z_dot_right_8 = -factor_8_0*slope_eta_z_dot_right_0 - factor_8_1*slope_eta_z_dot_right_1 - factor_8_2*slope_eta_z_dot_right_2 - factor_8_4*slope_eta_z_dot_right_4
    slope_eta_z_dot_8 = inv_rest_4_8_8*slope_eta_z_dot_right_8
    slope_eta_z_dot_4 = inv_rest_2_4_4*slope_eta_z_dot_right_4 - factor_8_4*slope_eta_z_dot_8
    slope_eta_z_dot_2 = inv_rest_1_2_2*slope_eta_z_dot_right_2 - factor_4_2*slope_eta_z_dot_4 - factor_8_2*slope_eta_z_dot_8
    slope_eta_z_dot_1 = inv_rest_0_1_1*slope_eta_z_dot_right_1 - factor_2_1*slope_eta_z_dot_2 - factor_2_1*slope_eta_z_dot_4 - factor_8_1*slope_eta_z_dot_8
    slope_eta_z_dot_0 = inv_rest_3_0_0*slope_eta_z_dot_right_0 - factor_1_0*slope_eta_z_dot_1 - factor_8_0*slope_eta_z_dot_8 - inv_rest_3_0_0_part_15*slope_eta_z_dot_2 - inv_rest_3_0_0_part_15*slope_eta_z_dot_4
    d_part_39_by_wheel_speed = -part_36
    d_part_40_by_wheel_speed = d_part_39_by_wheel_speed*w_32 - I_wx*part_36
    d_part_41_by_wheel_speed = d_part_40_by_wheel_speed*sin_g_x
    d_part_44_by_wheel_speed = -part_43
    d_part_45_by_wheel_speed = I_wx*part_43 + d_part_44_by_wheel_speed*w_11
    slope_wheel_speed_right_3 = -d_part_45_by_wheel_speed
    slope_wheel_speed_right_0 = -cos_g_z*d_part_45_by_wheel_speed - d_part_41_by_wheel_speed*sin_g_z - factor_0_3*slope_wheel_speed_right_3
    slope_wheel_speed_right_1 = cos_g_z*d_part_41_by_wheel_speed - d_part_45_by_wheel_speed*sin_g_z - factor_1_0*slope_wheel_speed_right_0 - factor_1_3*slope_wheel_speed_right_3
    d_part_51_by_wheel_speed = cos_g_x*d_part_40_by_wheel_speed
    slope_wheel_speed_right_2 = -d_part_51_by_wheel_speed - factor_2_1*slope_wheel_speed_right_1 - inv_rest_3_0_0_part_15*slope_wheel_speed_right_0
    slope_wheel_speed_right_4 = -d_part_51_by_wheel_speed - factor_2_1*slope_wheel_speed_right_1 - factor_4_2*slope_wheel_speed_right_2 - inv_rest_3_0_0_part_15*slope_wheel_speed_right_0
    slope_wheel_speed_right_8 = -factor_8_0*slope_wheel_speed_right_0 - factor_8_1*slope_wheel_speed_right_1 - factor_8_2*slope_wheel_speed_right_2 - factor_8_4*slope_wheel_speed_right_4
    slope_wheel_speed_8 = inv_rest_4_8_8*slope_wheel_speed_right_8
    slope_wheel_speed_4 = inv_rest_2_4_4*slope_wheel_speed_right_4 - factor_8_4*slope_wheel_speed_8
    slope_wheel_speed_2 = inv_rest_1_2_2*slope_wheel_speed_right_2 - factor_4_2*slope_wheel_speed_4 - factor_8_2*slope_wheel_speed_8
    slope_wheel_speed_1 = inv_rest_0_1_1*slope_wheel_speed_right_1 - factor_2_1*slope_wheel_speed_2 - factor_2_1*slope_wheel_speed_4 - factor_8_1*slope_wheel_speed_8
    slope_wheel_speed_0 = inv_rest_3_0_0*slope_wheel_speed_right_0 - factor_1_0*slope_wheel_speed_1 - factor_8_0*slope_wheel_speed_8 - inv_rest_3_0_0_part_15*slope_wheel_speed_2 - inv_rest_3_0_0_part_15*slope_wheel_speed_4
    slope_phi_3 = inv_I_wx*slope_phi_right_3 - factor_0_3*slope_phi_0 - factor_1_3*slope_phi_1
    slope_theta_3 = inv_I_wx*slope_theta_right_3 - factor_0_3*slope_theta_0 - factor_1_3*slope_theta_1
    slope_g_x_3 = inv_I_wx*slope_g_x_right_3 - factor_0_3*slope_g_x_0 - factor_1_3*slope_g_x_1
    slope_g_z_3 = inv_I_wx*slope_g_z_right_3 - factor_0_3*slope_g_z_0 - factor_1_3*slope_g_z_1
    slope_eta_x_3 = -factor_0_3*slope_eta_x_0 - factor_1_3*slope_eta_x_1
    slope_eta_y_3 = -factor_0_3*slope_eta_y_0 - factor_1_3*slope_eta_y_1
    slope_eta_z_3 = -factor_0_3*slope_eta_z_0 - factor_1_3*slope_eta_z_1
    slope_w_x_3 = inv_I_wx*slope_w_x_right_3 - factor_0_3*slope_w_x_0 - factor_1_3*slope_w_x_1
    slope_w_y_3 = inv_I_wx*slope_w_y_right_3 - factor_0_3*slope_w_y_0 - factor_1_3*slope_w_y_1
    slope_w_z_3 = inv_I_wx*slope_w_z_right_3 - factor_0_3*slope_w_z_0 - factor_1_3*slope_w_z_1
    slope_g_x_dot_3 = inv_I_wx*slope_g_x_dot_right_3 - factor_0_3*slope_g_x_dot_0 - factor_1_3*slope_g_x_dot_1
    slope_g_z_dot_3 = inv_I_wx*slope_g_z_dot_right_3 - factor_0_3*slope_g_z_dot_0 - factor_1_3*slope_g_z_dot_1
    slope_eta_x_dot_3 = -factor_0_3*slope_eta_x_dot_0 - factor_1_3*slope_eta_x_dot_1
    slope_eta_y_dot_3 = -factor_0_3*slope_eta_y_dot_0 - factor_1_3*slope_eta_y_dot_1
    slope_eta_z_dot_3 = -factor_0_3*slope_eta_z_dot_0 - factor_1_3*slope_eta_z_dot_1
    slope_wheel_speed_3 = inv_I_wx*slope_wheel_speed_right_3 - factor_0_3*slope_wheel_speed_0 - factor_1_3*slope_wheel_speed_1
    slope_phi_5 = -slope_phi_0
    slope_theta_5 = -slope_theta_0
    slope_g_x_5 = -slope_g_x_0
    slope_g_z_5 = -slope_g_z_0
    inv_J_x = 1.0/J_x
    slope_eta_x_5 = inv_J_x*slope_eta_x_right_5 - slope_eta_x_0
    slope_eta_y_5 = -slope_eta_y_0
    slope_eta_z_5 = -slope_eta_z_0
    slope_w_x_5 = -slope_w_x_0
    slope_w_y_5 = -slope_w_y_0
    slope_w_z_5 = -slope_w_z_0
    slope_g_x_dot_5 = -slope_g_x_dot_0
    slope_g_z_dot_5 = -slope_g_z_dot_0
    slope_eta_x_dot_5 = inv_J_x*slope_eta_x_dot_right_5 - slope_eta_x_dot_0
    slope_eta_y_dot_5 = -slope_eta_y_dot_0
    slope_eta_z_dot_5 = -slope_eta_z_dot_0
    slope_wheel_speed_5 = -slope_wheel_speed_0
    slope_phi_6 = -slope_phi_1
    slope_theta_6 = -slope_theta_1
    slope_g_x_6 = -slope_g_x_1
    slope_g_z_6 = -slope_g_z_1
    slope_eta_x_6 = -slope_eta_x_1
    inv_J_y = 1.0/J_y
    slope_eta_y_6 = inv_J_y*slope_eta_y_right_6 - slope_eta_y_1
    slope_eta_z_6 = -slope_eta_z_1
    slope_w_x_6 = -slope_w_x_1
    slope_w_y_6 = -slope_w_y_1
    slope_w_z_6 = -slope_w_z_1
    slope_g_x_dot_6 = -slope_g_x_dot_1
    slope_g_z_dot_6 = -slope_g_z_dot_1
    slope_eta_x_dot_6 = -slope_eta_x_dot_1
    slope_eta_y_dot_6 = inv_J_y*slope_eta_y_dot_right_6 - slope_eta_y_dot_1
    slope_eta_z_dot_6 = -slope_eta_z_dot_1
    slope_wheel_speed_6 = -slope_wheel_speed_1
    slope_phi_7 = -slope_phi_2
    slope_theta_7 = -slope_theta_2
    slope_g_x_7 = -slope_g_x_2
    slope_g_z_7 = -slope_g_z_2
    slope_eta_x_7 = -slope_eta_x_2
    slope_eta_y_7 = -slope_eta_y_2
    inv_J_z = 1.0/J_z
    slope_eta_z_7 = inv_J_z*slope_eta_z_right_7 - slope_eta_z_2
    slope_w_x_7 = -slope_w_x_2
    slope_w_y_7 = -slope_w_y_2
    slope_w_z_7 = -slope_w_z_2
    slope_g_x_dot_7 = -slope_g_x_dot_2
    slope_g_z_dot_7 = -slope_g_z_dot_2
    slope_eta_x_dot_7 = -slope_eta_x_dot_2
    slope_eta_y_dot_7 = -slope_eta_y_dot_2
    slope_eta_z_dot_7 = inv_J_z*slope_eta_z_dot_right_7 - slope_eta_z_dot_2
    slope_wheel_speed_7 = -slope_wheel_speed_2
    return (
        cos_theta_w0*d_a_yx_by_phi + d_a_yz_by_phi*sin_theta_w0,
        cos_theta_w0*d_a_yx_by_psi + d_a_yz_by_psi*sin_theta_w0,
        cos_theta*w_2 + cos_theta_w0*w + sin_theta_w0*w_3 - sin_theta_w_4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        cos_theta,
        0.0,
        sin_theta,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        cos_theta_inv_cos_phi_w0*d_a_yz_by_phi - d_a_yx_by_phi*inv_cos_phi_sin_theta_w0 - inv_cos_phi*inv_cos_phi*sin_phi*w_5,
        cos_theta*d_a_yz_by_psi*inv_cos_phi*w0 - d_a_yx_by_psi*inv_cos_phi_sin_theta_w0,
        cos_theta_inv_cos_phi_w0*w_3 - inv_cos_phi*w_6 - inv_cos_phi_sin_theta_w0*w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -inv_cos_phi_sin_theta,
        0.0,
        cos_theta_inv_cos_phi,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        d_a_yx_by_phi*sin_theta_tan_phi_w0 + d_a_yy_by_phi*w0 + w_5*(tan_phi*tan_phi + 1.0) - cos_theta_tan_phi_w0*d_a_yz_by_phi,
        d_a_yx_by_psi*sin_theta_tan_phi_w0 + d_a_yy_by_psi*w0 - cos_theta_tan_phi_w0*d_a_yz_by_psi,
        sin_theta_tan_phi_w0*w + tan_phi*w_6 - cos_theta_tan_phi_w0*w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        sin_theta_tan_phi,
        1.0,
        -cos_theta_tan_phi,
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
        slope_phi_0,
        0.0,
        slope_theta_0,
        slope_g_x_0,
        slope_g_z_0,
        slope_eta_x_0,
        slope_eta_y_0,
        slope_eta_z_0,
        slope_w_x_0,
        slope_w_y_0,
        slope_w_z_0,
        slope_g_x_dot_0,
        slope_g_z_dot_0,
        slope_eta_x_dot_0,
        slope_eta_y_dot_0,
        slope_eta_z_dot_0,
        slope_wheel_speed_0,
        slope_phi_1,
        0.0,
        slope_theta_1,
        slope_g_x_1,
        slope_g_z_1,
        slope_eta_x_1,
        slope_eta_y_1,
        slope_eta_z_1,
        slope_w_x_1,
        slope_w_y_1,
        slope_w_z_1,
        slope_g_x_dot_1,
        slope_g_z_dot_1,
        slope_eta_x_dot_1,
        slope_eta_y_dot_1,
        slope_eta_z_dot_1,
        slope_wheel_speed_1,
        slope_phi_2,
        0.0,
        slope_theta_2,
        slope_g_x_2,
        slope_g_z_2,
        slope_eta_x_2,
        slope_eta_y_2,
        slope_eta_z_2,
        slope_w_x_2,
        slope_w_y_2,
        slope_w_z_2,
        slope_g_x_dot_2,
        slope_g_z_dot_2,
        slope_eta_x_dot_2,
        slope_eta_y_dot_2,
        slope_eta_z_dot_2,
        slope_wheel_speed_2,
        slope_phi_3,
        0.0,
        slope_theta_3,
        slope_g_x_3,
        slope_g_z_3,
        slope_eta_x_3,
        slope_eta_y_3,
        slope_eta_z_3,
        slope_w_x_3,
        slope_w_y_3,
        slope_w_z_3,
        slope_g_x_dot_3,
        slope_g_z_dot_3,
        slope_eta_x_dot_3,
        slope_eta_y_dot_3,
        slope_eta_z_dot_3,
        slope_wheel_speed_3,
        slope_phi_4,
        0.0,
        slope_theta_4,
        slope_g_x_4,
        slope_g_z_4,
        slope_eta_x_4,
        slope_eta_y_4,
        slope_eta_z_4,
        slope_w_x_4,
        slope_w_y_4,
        slope_w_z_4,
        slope_g_x_dot_4,
        slope_g_z_dot_4,
        slope_eta_x_dot_4,
        slope_eta_y_dot_4,
        slope_eta_z_dot_4,
        slope_wheel_speed_4,
        slope_phi_5,
        0.0,
        slope_theta_5,
        slope_g_x_5,
        slope_g_z_5,
        slope_eta_x_5,
        slope_eta_y_5,
        slope_eta_z_5,
        slope_w_x_5,
        slope_w_y_5,
        slope_w_z_5,
        slope_g_x_dot_5,
        slope_g_z_dot_5,
        slope_eta_x_dot_5,
        slope_eta_y_dot_5,
        slope_eta_z_dot_5,
        slope_wheel_speed_5,
        slope_phi_6,
        0.0,
        slope_theta_6,
        slope_g_x_6,
        slope_g_z_6,
        slope_eta_x_6,
        slope_eta_y_6,
        slope_eta_z_6,
        slope_w_x_6,
        slope_w_y_6,
        slope_w_z_6,
        slope_g_x_dot_6,
        slope_g_z_dot_6,
        slope_eta_x_dot_6,
        slope_eta_y_dot_6,
        slope_eta_z_dot_6,
        slope_wheel_speed_6,
        slope_phi_7,
        0.0,
        slope_theta_7,
        slope_g_x_7,
        slope_g_z_7,
        slope_eta_x_7,
        slope_eta_y_7,
        slope_eta_z_7,
        slope_w_x_7,
        slope_w_y_7,
        slope_w_z_7,
        slope_g_x_dot_7,
        slope_g_z_dot_7,
        slope_eta_x_dot_7,
        slope_eta_y_dot_7,
        slope_eta_z_dot_7,
        slope_wheel_speed_7,
        slope_phi_8,
        0.0,
        slope_theta_8,
        slope_g_x_8,
        slope_g_z_8,
        slope_eta_x_8,
        slope_eta_y_8,
        slope_eta_z_8,
        slope_w_x_8,
        slope_w_y_8,
        slope_w_z_8,
        slope_g_x_dot_8,
        slope_g_z_dot_8,
        slope_eta_x_dot_8,
        slope_eta_y_dot_8,
        slope_eta_z_dot_8,
        slope_wheel_speed_8,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, w_x, w_y, w_z, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    inv_I_wx = 1.0/I_wx
    part_1 = math.cos(g_z)
    mass_4_1 = I_wx*part_1
    factor_0_3 = inv_I_wx*mass_4_1
    w = -I_wx
    part_9 = math.cos(g_x)
    part_10 = part_9*part_9
    part_11 = I_wy*part_10
    part_2 = part_1*part_1
    part_3 = I_wx*part_2
    part_4 = math.sin(g_z)
    part_5 = part_4*part_4
    part_6 = math.sin(g_x)
    part_7 = part_6*part_6
    part_8 = I_wx*part_7
    mass_1_1 = I_x + part_11*part_5 + part_3 + part_5*part_8 + w
    rest_5_0_0 = mass_1_1 - J_x
    rest_3_0_0 = rest_5_0_0 - factor_0_3*mass_4_1
    inv_rest_3_0_0 = 1.0/rest_3_0_0
    mass_2_1 = part_1*part_4*(-part_11 - part_8 - w)
    mass_4_2 = I_wx*part_4
    rest_3_0_1 = mass_2_1 - factor_0_3*mass_4_2
    factor_1_0 = inv_rest_3_0_0*rest_3_0_1
    part_12 = part_6*part_9
    w_2 = -I_wy
    part_13 = I_wx + w_2
    part_14 = part_13*part_4
    part_15 = part_12*part_14
    inv_rest_3_0_0_part_15 = inv_rest_3_0_0*part_15
    part_19 = I_wy*part_9
    mass_9_1 = part_19*part_4
    factor_8_0 = inv_rest_3_0_0*mass_9_1
    factor_1_3 = inv_I_wx*mass_4_2
    mass_2_2 = I_wx*part_5 + I_y + part_11*part_2 + part_3*part_7 + w_2
    rest_6_1_1 = mass_2_2 - J_y
    rest_3_1_1 = rest_6_1_1 - factor_1_3*mass_4_2
    rest_0_1_1 = rest_3_1_1 - factor_1_0*rest_3_0_1
    inv_rest_0_1_1 = 1.0/rest_0_1_1
    part_16 = -part_1*part_13
    part_17 = part_12*part_16
    w_3 = part_17 - factor_1_0*part_15
    factor_2_1 = inv_rest_0_1_1*w_3
    mass_9_2 = -part_1*part_19
    rest_0_1_8 = mass_9_2 - factor_1_0*mass_9_1
    factor_8_1 = inv_rest_0_1_1*rest_0_1_8
    w_4 = inv_rest_3_0_0_part_15*part_15
    part_18 = I_wx*part_10 + I_wy*part_7
    mass_3_3 = I_z + part_18 + w
    rest_7_2_2 = mass_3_3 - J_z
    rest_0_2_2 = rest_7_2_2 - w_4
    rest_1_2_2 = rest_0_2_2 - factor_2_1*w_3
    inv_rest_1_2_2 = 1.0/rest_1_2_2
    w_5 = -part_18
    rest_0_2_4 = -w_4 - w_5
    rest_1_2_4 = rest_0_2_4 - factor_2_1*w_3
    factor_4_2 = inv_rest_1_2_2*rest_1_2_4
    part_20 = I_wy*part_6
    w_6 = -part_20
    rest_0_2_8 = w_6 - inv_rest_3_0_0_part_15*mass_9_1
    rest_1_2_8 = rest_0_2_8 - factor_2_1*rest_0_1_8
    factor_8_2 = inv_rest_1_2_2*rest_1_2_8
    rest_0_4_4 = -inv_rest_3_0_0_part_15*part_15 - w_5
    rest_1_4_4 = rest_0_4_4 - factor_2_1*w_3
    rest_2_4_4 = rest_1_4_4 - factor_4_2*rest_1_2_4
    inv_rest_2_4_4 = 1.0/rest_2_4_4
    rest_2_4_8 = rest_1_2_8 - factor_4_2*rest_1_2_8
    factor_8_4 = inv_rest_2_4_4*rest_2_4_8
    rest_0_8_8 = I_wy - factor_8_0*mass_9_1
    rest_1_8_8 = rest_0_8_8 - factor_8_1*rest_0_1_8
    rest_2_8_8 = rest_1_8_8 - factor_8_2*rest_1_2_8
    rest_4_8_8 = rest_2_8_8 - factor_8_4*rest_2_4_8
    inv_rest_4_8_8 = 1.0/rest_4_8_8
    slope_T_cx_right_0 = -factor_0_3
    slope_T_cx_right_1 = -factor_1_0*slope_T_cx_right_0 - factor_1_3
    slope_T_cx_right_2 = -factor_2_1*slope_T_cx_right_1 - inv_rest_3_0_0_part_15*slope_T_cx_right_0
    slope_T_cx_right_4 = -factor_2_1*slope_T_cx_right_1 - factor_4_2*slope_T_cx_right_2 - inv_rest_3_0_0_part_15*slope_T_cx_right_0
    slope_T_cx_right_8 = -factor_8_0*slope_T_cx_right_0 - factor_8_1*slope_T_cx_right_1 - factor_8_2*slope_T_cx_right_2 - factor_8_4*slope_T_cx_right_4
    slope_T_cx_8 = inv_rest_4_8_8*slope_T_cx_right_8
    slope_T_cx_4 = inv_rest_2_4_4*slope_T_cx_right_4 - factor_8_4*slope_T_cx_8
    slope_T_cx_2 = inv_rest_1_2_2*slope_T_cx_right_2 - factor_4_2*slope_T_cx_4 - factor_8_2*slope_T_cx_8
    slope_T_cx_1 = inv_rest_0_1_1*slope_T_cx_right_1 - factor_2_1*slope_T_cx_2 - factor_2_1*slope_T_cx_4 - factor_8_1*slope_T_cx_8
    slope_T_cx_0 = inv_rest_3_0_0*slope_T_cx_right_0 - factor_1_0*slope_T_cx_1 - factor_8_0*slope_T_cx_8 - inv_rest_3_0_0_part_15*slope_T_cx_2 - inv_rest_3_0_0_part_15*slope_T_cx_4
    slope_T_cz_right_8 = -factor_8_4
    slope_T_cz_8 = inv_rest_4_8_8*slope_T_cz_right_8
    slope_T_cz_4 = inv_rest_2_4_4 - factor_8_4*slope_T_cz_8
    slope_T_cz_2 = -factor_4_2*slope_T_cz_4 - factor_8_2*slope_T_cz_8
    slope_T_cz_1 = -factor_2_1*slope_T_cz_2 - factor_2_1*slope_T_cz_4 - factor_8_1*slope_T_cz_8
    slope_T_cz_0 = -factor_1_0*slope_T_cz_1 - factor_8_0*slope_T_cz_8 - inv_rest_3_0_0_part_15*slope_T_cz_2 - inv_rest_3_0_0_part_15*slope_T_cz_4
    slope_motor_torque_4 = -factor_8_4*inv_rest_4_8_8
    slope_motor_torque_2 = -factor_4_2*slope_motor_torque_4 - factor_8_2*inv_rest_4_8_8
    slope_motor_torque_1 = -factor_2_1*slope_motor_torque_2 - factor_2_1*slope_motor_torque_4 - factor_8_1*inv_rest_4_8_8
    slope_motor_torque_0 = -factor_1_0*slope_motor_torque_1 - factor_8_0*inv_rest_4_8_8 - inv_rest_3_0_0_part_15*slope_motor_torque_2 - inv_rest_3_0_0_part_15*slope_motor_torque_4
    slope_T_cx_3 = inv_I_wx - factor_0_3*slope_T_cx_0 - factor_1_3*slope_T_cx_1
    slope_T_cz_3 = -factor_0_3*slope_T_cz_0 - factor_1_3*slope_T_cz_1
    slope_motor_torque_3 = -factor_0_3*slope_motor_torque_0 - factor_1_3*slope_motor_torque_1
    slope_T_cx_5 = -slope_T_cx_0
    slope_T_cz_5 = -slope_T_cz_0
    slope_motor_torque_5 = -slope_motor_torque_0
    slope_T_cx_6 = -slope_T_cx_1
    slope_T_cz_6 = -slope_T_cz_1
    slope_motor_torque_6 = -slope_motor_torque_1
    slope_T_cx_7 = -slope_T_cx_2
    slope_T_cz_7 = -slope_T_cz_2
    slope_motor_torque_7 = -slope_motor_torque_2
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
        slope_T_cx_0,
        slope_T_cz_0,
        slope_motor_torque_0,
        slope_T_cx_1,
        slope_T_cz_1,
        slope_motor_torque_1,
        slope_T_cx_2,
        slope_T_cz_2,
        slope_motor_torque_2,
        slope_T_cx_3,
        slope_T_cz_3,
        slope_motor_torque_3,
        slope_T_cx_4,
        slope_T_cz_4,
        slope_motor_torque_4,
        slope_T_cx_5,
        slope_T_cz_5,
        slope_motor_torque_5,
        slope_T_cx_6,
        slope_T_cz_6,
        slope_motor_torque_6,
        slope_T_cx_7,
        slope_T_cz_7,
        slope_motor_torque_7,
        slope_T_cx_8,
        slope_T_cz_8,
        inv_rest_4_8_8,
    )


def reference(t, p):
    """The reference curve c(t)."""
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
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
        -w0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    phi_at, psi_at, theta_at, g_x_at, g_z_at, eta_x_at, eta_y_at, eta_z_at, w_x_at, w_y_at, w_z_at, g_x_dot_at, g_z_dot_at, eta_x_dot_at, eta_y_dot_at, eta_z_dot_at, wheel_speed_at = x
    phi_mid, psi_mid, theta_mid, g_x_mid, g_z_mid, eta_x_mid, eta_y_mid, eta_z_mid, w_x_mid, w_y_mid, w_z_mid, g_x_dot_mid, g_z_dot_mid, eta_x_dot_mid, eta_y_dot_mid, eta_z_dot_mid, wheel_speed_mid = x_mid
    T_cx_at, T_cz_at, motor_torque_at = u
    T_cx_mid, T_cz_mid, motor_torque_mid = u_mid
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, w_x, w_y, w_z, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x0
    inv_I_wx = 1.0/I_wx
    w_4 = I_x - I_wx
    w_5 = I_wy - I_y
    w_6 = -w_5
    w_7 = I_wx - I_wy
    w_10 = I_z - I_wx
    w0_sq = w0*w0
    J_x_freq_x = J_x*freq_x
    twice_zeta_x = 2.0*zeta_x
    w_13 = J_z - I_z
    part_24 = -I_wx - w_13
    w_14 = -J_y - w_5
    w_15 = 3.0*w0_sq
    w_16 = I_y - J_y
    part_57 = w_16 + w_7
    w_17 = I_x - J_x
    J_y_freq_y = J_y*freq_y
    twice_zeta_y = 2.0*zeta_y
    w_18 = -w_17
    part_48 = -I_wx - w_18
    J_z_freq_z = J_z*freq_z
    twice_zeta_z = 2.0*zeta_z
    inv_J_x = 1.0/J_x
    inv_J_y = 1.0/J_y
    inv_J_z = 1.0/J_z
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
    w_x_at[0] = w_x
    w_y_at[0] = w_y
    w_z_at[0] = w_z
    g_x_dot_at[0] = g_x_dot
    g_z_dot_at[0] = g_z_dot
    eta_x_dot_at[0] = eta_x_dot
    eta_y_dot_at[0] = eta_y_dot
    eta_z_dot_at[0] = eta_z_dot
    wheel_speed_at[0] = wheel_speed
    T_cx = T_cx_at[0]
    T_cz = T_cz_at[0]
    motor_torque = motor_torque_at[0]
    sin_psi = math.sin(psi)
    cos_theta = math.cos(theta)
    sin_theta = math.sin(theta)
    cos_psi = math.cos(psi)
    sin_phi = math.sin(phi)
    cos_psi_sin_phi = cos_psi*sin_phi
    a_yx = cos_psi_sin_phi*sin_theta + cos_theta*sin_psi
    w = a_yx*w0 + w_x
    a_yz = sin_psi*sin_theta - cos_psi_sin_phi*cos_theta
    w_2 = a_yz*w0 + w_z
    cos_phi = math.cos(phi)
    inv_cos_phi = 1.0/cos_phi
    w_3 = sin_theta*w - cos_theta*w_2
    a_yy = cos_phi*cos_psi
    part_1 = math.cos(g_z)
    mass_4_1 = I_wx*part_1
    factor_0_3 = inv_I_wx*mass_4_1
    part_9 = math.cos(g_x)
    part_10 = part_9*part_9
    part_11 = I_wy*part_10
    part_2 = part_1*part_1
    part_3 = I_wx*part_2
    part_4 = math.sin(g_z)
    part_5 = part_4*part_4
    part_6 = math.sin(g_x)
    part_7 = part_6*part_6
    part_8 = I_wx*part_7
    mass_1_1 = part_11*part_5 + part_3 + part_5*part_8 + w_4
    rest_5_0_0 = mass_1_1 - J_x
    rest_3_0_0 = rest_5_0_0 - factor_0_3*mass_4_1
    inv_rest_3_0_0 = 1.0/rest_3_0_0
    mass_2_1 = part_1*part_4*(I_wx - part_11 - part_8)
    mass_4_2 = I_wx*part_4
    rest_3_0_1 = mass_2_1 - factor_0_3*mass_4_2
    factor_1_0 = inv_rest_3_0_0*rest_3_0_1
    factor_1_3 = inv_I_wx*mass_4_2
    mass_2_2 = I_wx*part_5 + part_11*part_2 + part_3*part_7 + w_6
    rest_6_1_1 = mass_2_2 - J_y
    rest_3_1_1 = rest_6_1_1 - factor_1_3*mass_4_2
    rest_0_1_1 = rest_3_1_1 - factor_1_0*rest_3_0_1
    inv_rest_0_1_1 = 1.0/rest_0_1_1
    part_12 = part_6*part_9
    part_14 = part_4*w_7
    part_15 = part_12*part_14
    part_16 = -part_1*w_7
    part_17 = part_12*part_16
    w_8 = part_17 - factor_1_0*part_15
    factor_2_1 = inv_rest_0_1_1*w_8
    inv_rest_3_0_0_part_15 = inv_rest_3_0_0*part_15
    w_9 = inv_rest_3_0_0_part_15*part_15
    part_18 = I_wx*part_10 + I_wy*part_7
    mass_3_3 = part_18 + w_10
    rest_7_2_2 = mass_3_3 - J_z
    rest_0_2_2 = rest_7_2_2 - w_9
    rest_1_2_2 = rest_0_2_2 - factor_2_1*w_8
    inv_rest_1_2_2 = 1.0/rest_1_2_2
    w_11 = -part_18
    rest_0_2_4 = -w_11 - w_9
    rest_1_2_4 = rest_0_2_4 - factor_2_1*w_8
    factor_4_2 = inv_rest_1_2_2*rest_1_2_4
    rest_0_4_4 = -inv_rest_3_0_0_part_15*part_15 - w_11
    rest_1_4_4 = rest_0_4_4 - factor_2_1*w_8
    rest_2_4_4 = rest_1_4_4 - factor_4_2*rest_1_2_4
    inv_rest_2_4_4 = 1.0/rest_2_4_4
    part_19 = I_wy*part_9
    mass_9_1 = part_19*part_4
    mass_9_2 = -part_1*part_19
    rest_0_1_8 = mass_9_2 - factor_1_0*mass_9_1
    part_20 = I_wy*part_6
    w_12 = -part_20
    rest_0_2_8 = w_12 - inv_rest_3_0_0_part_15*mass_9_1
    rest_1_2_8 = rest_0_2_8 - factor_2_1*rest_0_1_8
    rest_2_4_8 = rest_1_2_8 - factor_4_2*rest_1_2_8
    factor_8_4 = inv_rest_2_4_4*rest_2_4_8
    factor_8_2 = inv_rest_1_2_2*rest_1_2_8
    factor_8_1 = inv_rest_0_1_1*rest_0_1_8
    factor_8_0 = inv_rest_3_0_0*mass_9_1
    rest_0_8_8 = I_wy - factor_8_0*mass_9_1
    rest_1_8_8 = rest_0_8_8 - factor_8_1*rest_0_1_8
    rest_2_8_8 = rest_1_8_8 - factor_8_2*rest_1_2_8
    rest_4_8_8 = rest_2_8_8 - factor_8_4*rest_2_4_8
    inv_rest_4_8_8 = 1.0/rest_4_8_8
    part_31 = part_4*w_x
    part_37 = nominal_speed + wheel_speed
    part_1_w_y = part_1*w_y
    part_30 = g_z_dot + w_z
    part_43 = part_30*part_9 + part_31*part_6 - part_1_w_y*part_6
    part_30_part_6 = part_30*part_6
    part_38 = part_1_w_y*part_9 + part_30_part_6 - part_31*part_9 - part_37
    part_44 = part_38*part_43
    part_45 = I_wx*part_44 + I_wx*(g_z_dot*part_1_w_y + part_37*part_43 - g_z_dot*part_31) - I_wy*part_44
    part_56 = D_x*g_x_dot + K_x*g_x - T_cx
    a_zz = cos_phi*cos_theta
    a_zx = -cos_phi*sin_theta
    part_59 = part_1*sin_phi - a_zx*part_4
    part_60 = a_zz*part_6 + part_59*part_9
    part_64 = a_zz*part_9 - part_59*part_6
    acceleration_right_3 = 3.0*part_60*part_64*w0_sq*w_7 - part_45 - part_56
    acceleration_right_5 = -J_x_freq_x*(eta_x*freq_x + eta_x_dot*twice_zeta_x)
    part_21 = J_z*(eta_z_dot + w_z)
    part_22 = J_y*(eta_y_dot + w_y)
    part_25 = w_y*w_z
    part_27 = part_1*w_x
    part_28 = g_z_dot*part_9
    part_29 = part_4*w_y
    part_32 = g_x_dot*(part_1_w_y - part_31)
    part_33 = g_x_dot*part_30*part_9 - part_27*part_28 - part_28*part_29 - part_32*part_6
    part_34 = I_wy*part_33
    part_35 = part_34*part_9
    part_36 = g_x_dot + part_27 + part_29
    part_39 = part_36*part_38
    part_40 = I_wx*(g_z_dot*part_1*part_6*w_x + g_z_dot*part_4*part_6*w_y - g_x_dot*part_30_part_6 - part_32*part_9 - part_36*part_37) + I_wy*part_39 - I_wx*part_39
    part_41 = part_40*part_6
    part_54 = a_zz*w_15
    part_55 = part_54*sin_phi
    part_58 = a_zx*part_1 + part_4*sin_phi
    part_58_part_60 = part_58*part_60
    part_62 = -part_58_part_60*w_7
    part_63 = part_6*w_15
    part_65 = part_60*part_64*w_15
    acceleration_right_0 = J_z*part_55 + part_1*part_65*w_7 + part_22*w_z + part_25*w_14 + part_35*part_4 + part_4*part_62*part_63 + part_55*(-part_57 - w_13) - J_y*part_55 - acceleration_right_3*factor_0_3 - acceleration_right_5 - part_1*part_45 - part_21*w_y - part_24*part_25 - part_4*part_41
    acceleration_right_6 = -J_y_freq_y*(eta_y*freq_y + eta_y_dot*twice_zeta_y)
    part_46 = J_x*(eta_x_dot + w_x)
    part_49 = w_x*w_z
    part_66 = a_zx*part_54
    acceleration_right_1 = J_x*part_66 + part_1*part_41 + part_14*part_65 + part_21*w_x + part_24*part_49 + part_66*(w_13 + w_17) - J_z*part_66 - acceleration_right_0*factor_1_0 - acceleration_right_3*factor_1_3 - acceleration_right_6 - part_1*part_35 - part_16*part_58_part_60*part_63 - part_4*part_45 - part_46*w_z - part_48*part_49
    acceleration_right_7 = -J_z_freq_z*(eta_z*freq_z + eta_z_dot*twice_zeta_z)
    part_50 = w_x*w_y
    part_51 = part_20*part_33 + part_40*part_9
    part_67 = a_zx*sin_phi
    acceleration_right_2 = part_46*w_y + part_48*part_50 + w_15*(J_y*part_67 + part_62*part_9 + part_67*(part_57 + w_18) - J_x*part_67) - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_7 - part_22*w_x - part_50*w_14 - part_51
    acceleration_right_4 = T_cz - D_z*g_z_dot - K_z*g_z - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_2*factor_4_2 - part_51 - part_58_part_60*part_9*w_15*w_7
    acceleration_right_8 = motor_torque + part_34 - acceleration_right_0*factor_8_0 - acceleration_right_1*factor_8_1 - acceleration_right_2*factor_8_2 - acceleration_right_4*factor_8_4
    acceleration_8 = acceleration_right_8*inv_rest_4_8_8
    acceleration_4 = acceleration_right_4*inv_rest_2_4_4 - acceleration_8*factor_8_4
    acceleration_2 = acceleration_right_2*inv_rest_1_2_2 - acceleration_4*factor_4_2 - acceleration_8*factor_8_2
    acceleration_1 = acceleration_right_1*inv_rest_0_1_1 - acceleration_2*factor_2_1 - acceleration_4*factor_2_1 - acceleration_8*factor_8_1
    acceleration_0 = acceleration_right_0*inv_rest_3_0_0 - acceleration_1*factor_1_0 - acceleration_2*inv_rest_3_0_0_part_15 - acceleration_4*inv_rest_3_0_0_part_15 - acceleration_8*factor_8_0
    acceleration_3 = acceleration_right_3*inv_I_wx - acceleration_0*factor_0_3 - acceleration_1*factor_1_3
    acceleration_5 = acceleration_right_5*inv_J_x - acceleration_0
    acceleration_6 = acceleration_right_6*inv_J_y - acceleration_1
    acceleration_7 = acceleration_right_7*inv_J_z - acceleration_2
    slope_phi = cos_theta*w + sin_theta*w_2
    slope_psi = -inv_cos_phi*w_3
    slope_theta = a_yy*w0 + w_3*math.tan(phi) + w_y
    slope_w_x = acceleration_0
    slope_w_y = acceleration_1
    slope_w_z = acceleration_2
    slope_g_x_dot = acceleration_3
    slope_g_z_dot = acceleration_4
    slope_eta_x_dot = acceleration_5
    slope_eta_y_dot = acceleration_6
    slope_eta_z_dot = acceleration_7
    slope_wheel_speed = acceleration_8
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
        w_x_at[i] = w_x
        w_y_at[i] = w_y
        w_z_at[i] = w_z
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
        phi_2 = half*slope_phi + phi
        psi_2 = half*slope_psi + psi
        theta_2 = half*slope_theta + theta
        g_x_2 = g_x + g_x_dot*half
        g_z_2 = g_z + g_z_dot*half
        eta_x_2 = eta_x + eta_x_dot*half
        eta_y_2 = eta_y + eta_y_dot*half
        eta_z_2 = eta_z + eta_z_dot*half
        w_x_2 = half*slope_w_x + w_x
        w_y_2 = half*slope_w_y + w_y
        w_z_2 = half*slope_w_z + w_z
        g_x_dot_2 = g_x_dot + half*slope_g_x_dot
        g_z_dot_2 = g_z_dot + half*slope_g_z_dot
        eta_x_dot_2 = eta_x_dot + half*slope_eta_x_dot
        eta_y_dot_2 = eta_y_dot + half*slope_eta_y_dot
        eta_z_dot_2 = eta_z_dot + half*slope_eta_z_dot
        wheel_speed_2 = half*slope_wheel_speed + wheel_speed
        sin_psi_2 = math.sin(psi_2)
        cos_theta_2 = math.cos(theta_2)
        sin_theta_2 = math.sin(theta_2)
        cos_psi_2 = math.cos(psi_2)
        sin_phi_2 = math.sin(phi_2)
        cos_psi_2_sin_phi_2 = cos_psi_2*sin_phi_2
        a_yx_2 = cos_psi_2_sin_phi_2*sin_theta_2 + cos_theta_2*sin_psi_2
        w_19 = a_yx_2*w0 + w_x_2
        a_yz_2 = sin_psi_2*sin_theta_2 - cos_psi_2_sin_phi_2*cos_theta_2
        w_20 = a_yz_2*w0 + w_z_2
        cos_phi_2 = math.cos(phi_2)
        inv_cos_phi_2 = 1.0/cos_phi_2
        w_21 = sin_theta_2*w_19 - cos_theta_2*w_20
        a_yy_2 = cos_phi_2*cos_psi_2
        part_1_2 = math.cos(g_z_2)
        mass_4_1_2 = I_wx*part_1_2
        factor_0_3_2 = inv_I_wx*mass_4_1_2
        part_9_2 = math.cos(g_x_2)
        part_10_2 = part_9_2*part_9_2
        part_11_2 = I_wy*part_10_2
        part_2_2 = part_1_2*part_1_2
        part_3_2 = I_wx*part_2_2
        part_4_2 = math.sin(g_z_2)
        part_5_2 = part_4_2*part_4_2
        part_6_2 = math.sin(g_x_2)
        part_7_2 = part_6_2*part_6_2
        part_8_2 = I_wx*part_7_2
        mass_1_1_2 = part_11_2*part_5_2 + part_3_2 + part_5_2*part_8_2 + w_4
        rest_5_0_0_2 = mass_1_1_2 - J_x
        rest_3_0_0_2 = rest_5_0_0_2 - factor_0_3_2*mass_4_1_2
        inv_rest_3_0_0_2 = 1.0/rest_3_0_0_2
        mass_2_1_2 = part_1_2*part_4_2*(I_wx - part_11_2 - part_8_2)
        mass_4_2_2 = I_wx*part_4_2
        rest_3_0_1_2 = mass_2_1_2 - factor_0_3_2*mass_4_2_2
        factor_1_0_2 = inv_rest_3_0_0_2*rest_3_0_1_2
        factor_1_3_2 = inv_I_wx*mass_4_2_2
        mass_2_2_2 = I_wx*part_5_2 + part_11_2*part_2_2 + part_3_2*part_7_2 + w_6
        rest_6_1_1_2 = mass_2_2_2 - J_y
        rest_3_1_1_2 = rest_6_1_1_2 - factor_1_3_2*mass_4_2_2
        rest_0_1_1_2 = rest_3_1_1_2 - factor_1_0_2*rest_3_0_1_2
        inv_rest_0_1_1_2 = 1.0/rest_0_1_1_2
        part_12_2 = part_6_2*part_9_2
        part_14_2 = part_4_2*w_7
        part_15_2 = part_12_2*part_14_2
        part_16_2 = -part_1_2*w_7
        part_17_2 = part_12_2*part_16_2
        w_22 = part_17_2 - factor_1_0_2*part_15_2
        factor_2_1_2 = inv_rest_0_1_1_2*w_22
        w_23 = inv_rest_3_0_0_2*part_15_2
        part_15_2_w_23 = part_15_2*w_23
        part_18_2 = I_wx*part_10_2 + I_wy*part_7_2
        mass_3_3_2 = part_18_2 + w_10
        rest_7_2_2_2 = mass_3_3_2 - J_z
        rest_0_2_2_2 = rest_7_2_2_2 - part_15_2_w_23
        rest_1_2_2_2 = rest_0_2_2_2 - factor_2_1_2*w_22
        inv_rest_1_2_2_2 = 1.0/rest_1_2_2_2
        w_24 = -part_18_2
        rest_0_2_4_2 = -part_15_2_w_23 - w_24
        rest_1_2_4_2 = rest_0_2_4_2 - factor_2_1_2*w_22
        factor_4_2_2 = inv_rest_1_2_2_2*rest_1_2_4_2
        rest_0_4_4_2 = -part_15_2*w_23 - w_24
        rest_1_4_4_2 = rest_0_4_4_2 - factor_2_1_2*w_22
        rest_2_4_4_2 = rest_1_4_4_2 - factor_4_2_2*rest_1_2_4_2
        inv_rest_2_4_4_2 = 1.0/rest_2_4_4_2
        part_19_2 = I_wy*part_9_2
        mass_9_1_2 = part_19_2*part_4_2
        mass_9_2_2 = -part_19_2*part_1_2
        rest_0_1_8_2 = mass_9_2_2 - factor_1_0_2*mass_9_1_2
        part_20_2 = I_wy*part_6_2
        w_25 = -part_20_2
        rest_0_2_8_2 = w_25 - mass_9_1_2*w_23
        rest_1_2_8_2 = rest_0_2_8_2 - factor_2_1_2*rest_0_1_8_2
        rest_2_4_8_2 = rest_1_2_8_2 - factor_4_2_2*rest_1_2_8_2
        factor_8_4_2 = inv_rest_2_4_4_2*rest_2_4_8_2
        factor_8_2_2 = inv_rest_1_2_2_2*rest_1_2_8_2
        factor_8_1_2 = inv_rest_0_1_1_2*rest_0_1_8_2
        factor_8_0_2 = inv_rest_3_0_0_2*mass_9_1_2
        rest_0_8_8_2 = I_wy - factor_8_0_2*mass_9_1_2
        rest_1_8_8_2 = rest_0_8_8_2 - factor_8_1_2*rest_0_1_8_2
        rest_2_8_8_2 = rest_1_8_8_2 - factor_8_2_2*rest_1_2_8_2
        rest_4_8_8_2 = rest_2_8_8_2 - factor_8_4_2*rest_2_4_8_2
        inv_rest_4_8_8_2 = 1.0/rest_4_8_8_2
        part_31_2 = part_4_2*w_x_2
        part_37_2 = nominal_speed + wheel_speed_2
        part_1_2_w_y_2 = part_1_2*w_y_2
        part_30_2 = g_z_dot_2 + w_z_2
        part_43_2 = part_30_2*part_9_2 + part_31_2*part_6_2 - part_1_2_w_y_2*part_6_2
        part_30_2_part_6_2 = part_30_2*part_6_2
        part_38_2 = part_1_2_w_y_2*part_9_2 + part_30_2_part_6_2 - part_31_2*part_9_2 - part_37_2
        part_44_2 = part_38_2*part_43_2
        part_45_2 = I_wx*part_44_2 + I_wx*(g_z_dot_2*part_1_2_w_y_2 + part_37_2*part_43_2 - g_z_dot_2*part_31_2) - I_wy*part_44_2
        part_56_2 = D_x*g_x_dot_2 + K_x*g_x_2 - T_cx_half
        a_zz_2 = cos_phi_2*cos_theta_2
        a_zx_2 = -cos_phi_2*sin_theta_2
        part_59_2 = part_1_2*sin_phi_2 - a_zx_2*part_4_2
        part_60_2 = a_zz_2*part_6_2 + part_59_2*part_9_2
        part_64_2 = a_zz_2*part_9_2 - part_59_2*part_6_2
        acceleration_right_3_2 = 3.0*part_60_2*part_64_2*w0_sq*w_7 - part_45_2 - part_56_2
        acceleration_right_5_2 = -J_x_freq_x*(eta_x_2*freq_x + eta_x_dot_2*twice_zeta_x)
        part_21_2 = J_z*(eta_z_dot_2 + w_z_2)
        part_22_2 = J_y*(eta_y_dot_2 + w_y_2)
        part_25_2 = w_y_2*w_z_2
        part_27_2 = part_1_2*w_x_2
        part_28_2 = g_z_dot_2*part_9_2
        part_29_2 = part_4_2*w_y_2
        part_32_2 = g_x_dot_2*(part_1_2_w_y_2 - part_31_2)
        part_33_2 = g_x_dot_2*part_30_2*part_9_2 - part_27_2*part_28_2 - part_28_2*part_29_2 - part_32_2*part_6_2
        part_34_2 = I_wy*part_33_2
        part_35_2 = part_34_2*part_9_2
        part_36_2 = g_x_dot_2 + part_27_2 + part_29_2
        part_39_2 = part_36_2*part_38_2
        part_40_2 = I_wx*(g_z_dot_2*part_1_2*part_6_2*w_x_2 + g_z_dot_2*part_4_2*part_6_2*w_y_2 - g_x_dot_2*part_30_2_part_6_2 - part_32_2*part_9_2 - part_36_2*part_37_2) + I_wy*part_39_2 - I_wx*part_39_2
        part_41_2 = part_40_2*part_6_2
        part_54_2 = a_zz_2*w_15
        part_55_2 = part_54_2*sin_phi_2
        part_58_2 = a_zx_2*part_1_2 + part_4_2*sin_phi_2
        part_58_2_part_60_2 = part_58_2*part_60_2
        part_62_2 = -part_58_2_part_60_2*w_7
        part_63_2 = part_6_2*w_15
        part_65_2 = part_60_2*part_64_2*w_15
        acceleration_right_0_2 = J_z*part_55_2 + part_1_2*part_65_2*w_7 + part_22_2*w_z_2 + part_25_2*w_14 + part_35_2*part_4_2 + part_4_2*part_62_2*part_63_2 + part_55_2*(-part_57 - w_13) - J_y*part_55_2 - acceleration_right_3_2*factor_0_3_2 - acceleration_right_5_2 - part_1_2*part_45_2 - part_21_2*w_y_2 - part_24*part_25_2 - part_41_2*part_4_2
        acceleration_right_6_2 = -J_y_freq_y*(eta_y_2*freq_y + eta_y_dot_2*twice_zeta_y)
        part_46_2 = J_x*(eta_x_dot_2 + w_x_2)
        part_49_2 = w_x_2*w_z_2
        part_66_2 = a_zx_2*part_54_2
        acceleration_right_1_2 = J_x*part_66_2 + part_14_2*part_65_2 + part_1_2*part_41_2 + part_21_2*w_x_2 + part_24*part_49_2 + part_66_2*(w_13 + w_17) - J_z*part_66_2 - acceleration_right_0_2*factor_1_0_2 - acceleration_right_3_2*factor_1_3_2 - acceleration_right_6_2 - part_16_2*part_58_2_part_60_2*part_63_2 - part_1_2*part_35_2 - part_45_2*part_4_2 - part_46_2*w_z_2 - part_48*part_49_2
        acceleration_right_7_2 = -J_z_freq_z*(eta_z_2*freq_z + eta_z_dot_2*twice_zeta_z)
        part_50_2 = w_x_2*w_y_2
        part_51_2 = part_20_2*part_33_2 + part_40_2*part_9_2
        part_67_2 = a_zx_2*sin_phi_2
        acceleration_right_2_2 = part_46_2*w_y_2 + part_48*part_50_2 + w_15*(J_y*part_67_2 + part_62_2*part_9_2 + part_67_2*(part_57 + w_18) - J_x*part_67_2) - acceleration_right_0_2*w_23 - acceleration_right_1_2*factor_2_1_2 - acceleration_right_7_2 - part_22_2*w_x_2 - part_50_2*w_14 - part_51_2
        acceleration_right_4_2 = T_cz_half - D_z*g_z_dot_2 - K_z*g_z_2 - acceleration_right_0_2*w_23 - acceleration_right_1_2*factor_2_1_2 - acceleration_right_2_2*factor_4_2_2 - part_51_2 - part_58_2_part_60_2*part_9_2*w_15*w_7
        acceleration_right_8_2 = motor_torque_half + part_34_2 - acceleration_right_0_2*factor_8_0_2 - acceleration_right_1_2*factor_8_1_2 - acceleration_right_2_2*factor_8_2_2 - acceleration_right_4_2*factor_8_4_2
        acceleration_8_2 = acceleration_right_8_2*inv_rest_4_8_8_2
        acceleration_4_2 = acceleration_right_4_2*inv_rest_2_4_4_2 - acceleration_8_2*factor_8_4_2
        acceleration_2_2 = acceleration_right_2_2*inv_rest_1_2_2_2 - acceleration_4_2*factor_4_2_2 - acceleration_8_2*factor_8_2_2
        acceleration_1_2 = acceleration_right_1_2*inv_rest_0_1_1_2 - acceleration_2_2*factor_2_1_2 - acceleration_4_2*factor_2_1_2 - acceleration_8_2*factor_8_1_2
        acceleration_0_2 = acceleration_right_0_2*inv_rest_3_0_0_2 - acceleration_1_2*factor_1_0_2 - acceleration_2_2*w_23 - acceleration_4_2*w_23 - acceleration_8_2*factor_8_0_2
        acceleration_3_2 = acceleration_right_3_2*inv_I_wx - acceleration_0_2*factor_0_3_2 - acceleration_1_2*factor_1_3_2
        acceleration_5_2 = acceleration_right_5_2*inv_J_x - acceleration_0_2
        acceleration_6_2 = acceleration_right_6_2*inv_J_y - acceleration_1_2
        acceleration_7_2 = acceleration_right_7_2*inv_J_z - acceleration_2_2
        k2_phi = cos_theta_2*w_19 + sin_theta_2*w_20
        k2_psi = -inv_cos_phi_2*w_21
        k2_theta = a_yy_2*w0 + w_21*math.tan(phi_2) + w_y_2
        phi_3 = half*k2_phi + phi
        psi_3 = half*k2_psi + psi
        theta_3 = half*k2_theta + theta
        g_x_3 = g_x + g_x_dot_2*half
        g_z_3 = g_z + g_z_dot_2*half
        eta_x_3 = eta_x + eta_x_dot_2*half
        eta_y_3 = eta_y + eta_y_dot_2*half
        eta_z_3 = eta_z + eta_z_dot_2*half
        w_x_3 = acceleration_0_2*half + w_x
        w_y_3 = acceleration_1_2*half + w_y
        w_z_3 = acceleration_2_2*half + w_z
        g_x_dot_3 = acceleration_3_2*half + g_x_dot
        g_z_dot_3 = acceleration_4_2*half + g_z_dot
        eta_x_dot_3 = acceleration_5_2*half + eta_x_dot
        eta_y_dot_3 = acceleration_6_2*half + eta_y_dot
        eta_z_dot_3 = acceleration_7_2*half + eta_z_dot
        wheel_speed_3 = acceleration_8_2*half + wheel_speed
        sin_psi_3 = math.sin(psi_3)
        cos_theta_3 = math.cos(theta_3)
        sin_theta_3 = math.sin(theta_3)
        cos_psi_3 = math.cos(psi_3)
        sin_phi_3 = math.sin(phi_3)
        cos_psi_3_sin_phi_3 = cos_psi_3*sin_phi_3
        a_yx_3 = cos_psi_3_sin_phi_3*sin_theta_3 + cos_theta_3*sin_psi_3
        w_26 = a_yx_3*w0 + w_x_3
        a_yz_3 = sin_psi_3*sin_theta_3 - cos_psi_3_sin_phi_3*cos_theta_3
        w_27 = a_yz_3*w0 + w_z_3
        cos_phi_3 = math.cos(phi_3)
        inv_cos_phi_3 = 1.0/cos_phi_3
        w_28 = sin_theta_3*w_26 - cos_theta_3*w_27
        a_yy_3 = cos_phi_3*cos_psi_3
        part_1_3 = math.cos(g_z_3)
        mass_4_1_3 = I_wx*part_1_3
        factor_0_3_3 = inv_I_wx*mass_4_1_3
        part_9_3 = math.cos(g_x_3)
        part_10_3 = part_9_3*part_9_3
        part_11_3 = I_wy*part_10_3
        part_2_3 = part_1_3*part_1_3
        part_3_3 = I_wx*part_2_3
        part_4_3 = math.sin(g_z_3)
        part_5_3 = part_4_3*part_4_3
        part_6_3 = math.sin(g_x_3)
        part_7_3 = part_6_3*part_6_3
        part_8_3 = I_wx*part_7_3
        mass_1_1_3 = part_11_3*part_5_3 + part_3_3 + part_5_3*part_8_3 + w_4
        rest_5_0_0_3 = mass_1_1_3 - J_x
        rest_3_0_0_3 = rest_5_0_0_3 - factor_0_3_3*mass_4_1_3
        inv_rest_3_0_0_3 = 1.0/rest_3_0_0_3
        mass_2_1_3 = part_1_3*part_4_3*(I_wx - part_11_3 - part_8_3)
        mass_4_2_3 = I_wx*part_4_3
        rest_3_0_1_3 = mass_2_1_3 - factor_0_3_3*mass_4_2_3
        factor_1_0_3 = inv_rest_3_0_0_3*rest_3_0_1_3
        factor_1_3_3 = inv_I_wx*mass_4_2_3
        mass_2_2_3 = I_wx*part_5_3 + part_11_3*part_2_3 + part_3_3*part_7_3 + w_6
        rest_6_1_1_3 = mass_2_2_3 - J_y
        rest_3_1_1_3 = rest_6_1_1_3 - factor_1_3_3*mass_4_2_3
        rest_0_1_1_3 = rest_3_1_1_3 - factor_1_0_3*rest_3_0_1_3
        inv_rest_0_1_1_3 = 1.0/rest_0_1_1_3
        part_12_3 = part_6_3*part_9_3
        part_14_3 = part_4_3*w_7
        part_15_3 = part_12_3*part_14_3
        part_16_3 = -part_1_3*w_7
        part_17_3 = part_12_3*part_16_3
        w_29 = part_17_3 - factor_1_0_3*part_15_3
        factor_2_1_3 = inv_rest_0_1_1_3*w_29
        w_30 = inv_rest_3_0_0_3*part_15_3
        part_15_3_w_30 = part_15_3*w_30
        part_18_3 = I_wx*part_10_3 + I_wy*part_7_3
        mass_3_3_3 = part_18_3 + w_10
        rest_7_2_2_3 = mass_3_3_3 - J_z
        rest_0_2_2_3 = rest_7_2_2_3 - part_15_3_w_30
        rest_1_2_2_3 = rest_0_2_2_3 - factor_2_1_3*w_29
        inv_rest_1_2_2_3 = 1.0/rest_1_2_2_3
        w_31 = -part_18_3
        rest_0_2_4_3 = -part_15_3_w_30 - w_31
        rest_1_2_4_3 = rest_0_2_4_3 - factor_2_1_3*w_29
        factor_4_2_3 = inv_rest_1_2_2_3*rest_1_2_4_3
        rest_0_4_4_3 = -part_15_3*w_30 - w_31
        rest_1_4_4_3 = rest_0_4_4_3 - factor_2_1_3*w_29
        rest_2_4_4_3 = rest_1_4_4_3 - factor_4_2_3*rest_1_2_4_3
        inv_rest_2_4_4_3 = 1.0/rest_2_4_4_3
        part_19_3 = I_wy*part_9_3
        mass_9_1_3 = part_19_3*part_4_3
        mass_9_2_3 = -part_19_3*part_1_3
        rest_0_1_8_3 = mass_9_2_3 - factor_1_0_3*mass_9_1_3
        part_20_3 = I_wy*part_6_3
        w_32 = -part_20_3
        rest_0_2_8_3 = w_32 - mass_9_1_3*w_30
        rest_1_2_8_3 = rest_0_2_8_3 - factor_2_1_3*rest_0_1_8_3
        rest_2_4_8_3 = rest_1_2_8_3 - factor_4_2_3*rest_1_2_8_3
        factor_8_4_3 = inv_rest_2_4_4_3*rest_2_4_8_3
        factor_8_2_3 = inv_rest_1_2_2_3*rest_1_2_8_3
        factor_8_1_3 = inv_rest_0_1_1_3*rest_0_1_8_3
        factor_8_0_3 = inv_rest_3_0_0_3*mass_9_1_3
        rest_0_8_8_3 = I_wy - factor_8_0_3*mass_9_1_3
        rest_1_8_8_3 = rest_0_8_8_3 - factor_8_1_3*rest_0_1_8_3
        rest_2_8_8_3 = rest_1_8_8_3 - factor_8_2_3*rest_1_2_8_3
        rest_4_8_8_3 = rest_2_8_8_3 - factor_8_4_3*rest_2_4_8_3
        inv_rest_4_8_8_3 = 1.0/rest_4_8_8_3
        part_31_3 = part_4_3*w_x_3
        part_37_3 = nominal_speed + wheel_speed_3
        part_1_3_w_y_3 = part_1_3*w_y_3
        part_30_3 = g_z_dot_3 + w_z_3
        part_43_3 = part_30_3*part_9_3 + part_31_3*part_6_3 - part_1_3_w_y_3*part_6_3
        part_30_3_part_6_3 = part_30_3*part_6_3
        part_38_3 = part_1_3_w_y_3*part_9_3 + part_30_3_part_6_3 - part_31_3*part_9_3 - part_37_3
        part_44_3 = part_38_3*part_43_3
        part_45_3 = I_wx*part_44_3 + I_wx*(g_z_dot_3*part_1_3_w_y_3 + part_37_3*part_43_3 - g_z_dot_3*part_31_3) - I_wy*part_44_3
        part_56_3 = D_x*g_x_dot_3 + K_x*g_x_3 - T_cx_half
        a_zz_3 = cos_phi_3*cos_theta_3
        a_zx_3 = -cos_phi_3*sin_theta_3
        part_59_3 = part_1_3*sin_phi_3 - a_zx_3*part_4_3
        part_60_3 = a_zz_3*part_6_3 + part_59_3*part_9_3
        part_64_3 = a_zz_3*part_9_3 - part_59_3*part_6_3
        acceleration_right_3_3 = 3.0*part_60_3*part_64_3*w0_sq*w_7 - part_45_3 - part_56_3
        acceleration_right_5_3 = -J_x_freq_x*(eta_x_3*freq_x + eta_x_dot_3*twice_zeta_x)
        part_21_3 = J_z*(eta_z_dot_3 + w_z_3)
        part_22_3 = J_y*(eta_y_dot_3 + w_y_3)
        part_25_3 = w_y_3*w_z_3
        part_27_3 = part_1_3*w_x_3
        part_28_3 = g_z_dot_3*part_9_3
        part_29_3 = part_4_3*w_y_3
        part_32_3 = g_x_dot_3*(part_1_3_w_y_3 - part_31_3)
        part_33_3 = g_x_dot_3*part_30_3*part_9_3 - part_27_3*part_28_3 - part_28_3*part_29_3 - part_32_3*part_6_3
        part_34_3 = I_wy*part_33_3
        part_35_3 = part_34_3*part_9_3
        part_36_3 = g_x_dot_3 + part_27_3 + part_29_3
        part_39_3 = part_36_3*part_38_3
        part_40_3 = I_wx*(g_z_dot_3*part_1_3*part_6_3*w_x_3 + g_z_dot_3*part_4_3*part_6_3*w_y_3 - g_x_dot_3*part_30_3_part_6_3 - part_32_3*part_9_3 - part_36_3*part_37_3) + I_wy*part_39_3 - I_wx*part_39_3
        part_41_3 = part_40_3*part_6_3
        part_54_3 = a_zz_3*w_15
        part_55_3 = part_54_3*sin_phi_3
        part_58_3 = a_zx_3*part_1_3 + part_4_3*sin_phi_3
        part_58_3_part_60_3 = part_58_3*part_60_3
        part_62_3 = -part_58_3_part_60_3*w_7
        part_63_3 = part_6_3*w_15
        part_65_3 = part_60_3*part_64_3*w_15
        acceleration_right_0_3 = J_z*part_55_3 + part_1_3*part_65_3*w_7 + part_22_3*w_z_3 + part_25_3*w_14 + part_35_3*part_4_3 + part_4_3*part_62_3*part_63_3 + part_55_3*(-part_57 - w_13) - J_y*part_55_3 - acceleration_right_3_3*factor_0_3_3 - acceleration_right_5_3 - part_1_3*part_45_3 - part_21_3*w_y_3 - part_24*part_25_3 - part_41_3*part_4_3
        acceleration_right_6_3 = -J_y_freq_y*(eta_y_3*freq_y + eta_y_dot_3*twice_zeta_y)
        part_46_3 = J_x*(eta_x_dot_3 + w_x_3)
        part_49_3 = w_x_3*w_z_3
        part_66_3 = a_zx_3*part_54_3
        acceleration_right_1_3 = J_x*part_66_3 + part_14_3*part_65_3 + part_1_3*part_41_3 + part_21_3*w_x_3 + part_24*part_49_3 + part_66_3*(w_13 + w_17) - J_z*part_66_3 - acceleration_right_0_3*factor_1_0_3 - acceleration_right_3_3*factor_1_3_3 - acceleration_right_6_3 - part_16_3*part_58_3_part_60_3*part_63_3 - part_1_3*part_35_3 - part_45_3*part_4_3 - part_46_3*w_z_3 - part_48*part_49_3
        acceleration_right_7_3 = -J_z_freq_z*(eta_z_3*freq_z + eta_z_dot_3*twice_zeta_z)
        part_50_3 = w_x_3*w_y_3
        part_51_3 = part_20_3*part_33_3 + part_40_3*part_9_3
        part_67_3 = a_zx_3*sin_phi_3
        acceleration_right_2_3 = part_46_3*w_y_3 + part_48*part_50_3 + w_15*(J_y*part_67_3 + part_62_3*part_9_3 + part_67_3*(part_57 + w_18) - J_x*part_67_3) - acceleration_right_0_3*w_30 - acceleration_right_1_3*factor_2_1_3 - acceleration_right_7_3 - part_22_3*w_x_3 - part_50_3*w_14 - part_51_3
        acceleration_right_4_3 = T_cz_half - D_z*g_z_dot_3 - K_z*g_z_3 - acceleration_right_0_3*w_30 - acceleration_right_1_3*factor_2_1_3 - acceleration_right_2_3*factor_4_2_3 - part_51_3 - part_58_3_part_60_3*part_9_3*w_15*w_7
        acceleration_right_8_3 = motor_torque_half + part_34_3 - acceleration_right_0_3*factor_8_0_3 - acceleration_right_1_3*factor_8_1_3 - acceleration_right_2_3*factor_8_2_3 - acceleration_right_4_3*factor_8_4_3
        acceleration_8_3 = acceleration_right_8_3*inv_rest_4_8_8_3
        acceleration_4_3 = acceleration_right_4_3*inv_rest_2_4_4_3 - acceleration_8_3*factor_8_4_3
        acceleration_2_3 = acceleration_right_2_3*inv_rest_1_2_2_3 - acceleration_4_3*factor_4_2_3 - acceleration_8_3*factor_8_2_3
        acceleration_1_3 = acceleration_right_1_3*inv_rest_0_1_1_3 - acceleration_2_3*factor_2_1_3 - acceleration_4_3*factor_2_1_3 - acceleration_8_3*factor_8_1_3
        acceleration_0_3 = acceleration_right_0_3*inv_rest_3_0_0_3 - acceleration_1_3*factor_1_0_3 - acceleration_2_3*w_30 - acceleration_4_3*w_30 - acceleration_8_3*factor_8_0_3
        acceleration_3_3 = acceleration_right_3_3*inv_I_wx - acceleration_0_3*factor_0_3_3 - acceleration_1_3*factor_1_3_3
        acceleration_5_3 = acceleration_right_5_3*inv_J_x - acceleration_0_3
        acceleration_6_3 = acceleration_right_6_3*inv_J_y - acceleration_1_3
        acceleration_7_3 = acceleration_right_7_3*inv_J_z - acceleration_2_3
        k3_phi = cos_theta_3*w_26 + sin_theta_3*w_27
        k3_psi = -inv_cos_phi_3*w_28
        k3_theta = a_yy_3*w0 + w_28*math.tan(phi_3) + w_y_3
        phi_4 = h*k3_phi + phi
        psi_4 = h*k3_psi + psi
        theta_4 = h*k3_theta + theta
        g_x_4 = g_x + g_x_dot_3*h
        g_z_4 = g_z + g_z_dot_3*h
        eta_x_4 = eta_x + eta_x_dot_3*h
        eta_y_4 = eta_y + eta_y_dot_3*h
        eta_z_4 = eta_z + eta_z_dot_3*h
        w_x_4 = acceleration_0_3*h + w_x
        w_y_4 = acceleration_1_3*h + w_y
        w_z_4 = acceleration_2_3*h + w_z
        g_x_dot_4 = acceleration_3_3*h + g_x_dot
        g_z_dot_4 = acceleration_4_3*h + g_z_dot
        eta_x_dot_4 = acceleration_5_3*h + eta_x_dot
        eta_y_dot_4 = acceleration_6_3*h + eta_y_dot
        eta_z_dot_4 = acceleration_7_3*h + eta_z_dot
        wheel_speed_4 = acceleration_8_3*h + wheel_speed
        sin_psi_4 = math.sin(psi_4)
        cos_theta_4 = math.cos(theta_4)
        sin_theta_4 = math.sin(theta_4)
        cos_psi_4 = math.cos(psi_4)
        sin_phi_4 = math.sin(phi_4)
        cos_psi_4_sin_phi_4 = cos_psi_4*sin_phi_4
        a_yx_4 = cos_psi_4_sin_phi_4*sin_theta_4 + cos_theta_4*sin_psi_4
        w_33 = a_yx_4*w0 + w_x_4
        a_yz_4 = sin_psi_4*sin_theta_4 - cos_psi_4_sin_phi_4*cos_theta_4
        w_34 = a_yz_4*w0 + w_z_4
        cos_phi_4 = math.cos(phi_4)
        inv_cos_phi_4 = 1.0/cos_phi_4
        w_35 = sin_theta_4*w_33 - cos_theta_4*w_34
        a_yy_4 = cos_phi_4*cos_psi_4
        part_1_4 = math.cos(g_z_4)
        mass_4_1_4 = I_wx*part_1_4
        factor_0_3_4 = inv_I_wx*mass_4_1_4
        part_9_4 = math.cos(g_x_4)
        part_10_4 = part_9_4*part_9_4
        part_11_4 = I_wy*part_10_4
        part_2_4 = part_1_4*part_1_4
        part_3_4 = I_wx*part_2_4
        part_4_4 = math.sin(g_z_4)
        part_5_4 = part_4_4*part_4_4
        part_6_4 = math.sin(g_x_4)
        part_7_4 = part_6_4*part_6_4
        part_8_4 = I_wx*part_7_4
        mass_1_1_4 = part_11_4*part_5_4 + part_3_4 + part_5_4*part_8_4 + w_4
        rest_5_0_0_4 = mass_1_1_4 - J_x
        rest_3_0_0_4 = rest_5_0_0_4 - factor_0_3_4*mass_4_1_4
        inv_rest_3_0_0_4 = 1.0/rest_3_0_0_4
        mass_2_1_4 = part_1_4*part_4_4*(I_wx - part_11_4 - part_8_4)
        mass_4_2_4 = I_wx*part_4_4
        rest_3_0_1_4 = mass_2_1_4 - factor_0_3_4*mass_4_2_4
        factor_1_0_4 = inv_rest_3_0_0_4*rest_3_0_1_4
        factor_1_3_4 = inv_I_wx*mass_4_2_4
        mass_2_2_4 = I_wx*part_5_4 + part_11_4*part_2_4 + part_3_4*part_7_4 + w_6
        rest_6_1_1_4 = mass_2_2_4 - J_y
        rest_3_1_1_4 = rest_6_1_1_4 - factor_1_3_4*mass_4_2_4
        rest_0_1_1_4 = rest_3_1_1_4 - factor_1_0_4*rest_3_0_1_4
        inv_rest_0_1_1_4 = 1.0/rest_0_1_1_4
        part_12_4 = part_6_4*part_9_4
        part_14_4 = part_4_4*w_7
        part_15_4 = part_12_4*part_14_4
        part_16_4 = -part_1_4*w_7
        part_17_4 = part_12_4*part_16_4
        w_36 = part_17_4 - factor_1_0_4*part_15_4
        factor_2_1_4 = inv_rest_0_1_1_4*w_36
        w_37 = inv_rest_3_0_0_4*part_15_4
        part_15_4_w_37 = part_15_4*w_37
        part_18_4 = I_wx*part_10_4 + I_wy*part_7_4
        mass_3_3_4 = part_18_4 + w_10
        rest_7_2_2_4 = mass_3_3_4 - J_z
        rest_0_2_2_4 = rest_7_2_2_4 - part_15_4_w_37
        rest_1_2_2_4 = rest_0_2_2_4 - factor_2_1_4*w_36
        inv_rest_1_2_2_4 = 1.0/rest_1_2_2_4
        w_38 = -part_18_4
        rest_0_2_4_4 = -part_15_4_w_37 - w_38
        rest_1_2_4_4 = rest_0_2_4_4 - factor_2_1_4*w_36
        factor_4_2_4 = inv_rest_1_2_2_4*rest_1_2_4_4
        rest_0_4_4_4 = -part_15_4*w_37 - w_38
        rest_1_4_4_4 = rest_0_4_4_4 - factor_2_1_4*w_36
        rest_2_4_4_4 = rest_1_4_4_4 - factor_4_2_4*rest_1_2_4_4
        inv_rest_2_4_4_4 = 1.0/rest_2_4_4_4
        part_19_4 = I_wy*part_9_4
        mass_9_1_4 = part_19_4*part_4_4
        mass_9_2_4 = -part_19_4*part_1_4
        rest_0_1_8_4 = mass_9_2_4 - factor_1_0_4*mass_9_1_4
        part_20_4 = I_wy*part_6_4
        w_39 = -part_20_4
        rest_0_2_8_4 = w_39 - mass_9_1_4*w_37
        rest_1_2_8_4 = rest_0_2_8_4 - factor_2_1_4*rest_0_1_8_4
        rest_2_4_8_4 = rest_1_2_8_4 - factor_4_2_4*rest_1_2_8_4
        factor_8_4_4 = inv_rest_2_4_4_4*rest_2_4_8_4
        factor_8_2_4 = inv_rest_1_2_2_4*rest_1_2_8_4
        factor_8_1_4 = inv_rest_0_1_1_4*rest_0_1_8_4
        factor_8_0_4 = inv_rest_3_0_0_4*mass_9_1_4
        rest_0_8_8_4 = I_wy - factor_8_0_4*mass_9_1_4
        rest_1_8_8_4 = rest_0_8_8_4 - factor_8_1_4*rest_0_1_8_4
        rest_2_8_8_4 = rest_1_8_8_4 - factor_8_2_4*rest_1_2_8_4
        rest_4_8_8_4 = rest_2_8_8_4 - factor_8_4_4*rest_2_4_8_4
        inv_rest_4_8_8_4 = 1.0/rest_4_8_8_4
        part_31_4 = part_4_4*w_x_4
        part_37_4 = nominal_speed + wheel_speed_4
        part_1_4_w_y_4 = part_1_4*w_y_4
        part_30_4 = g_z_dot_4 + w_z_4
        part_43_4 = part_30_4*part_9_4 + part_31_4*part_6_4 - part_1_4_w_y_4*part_6_4
        part_30_4_part_6_4 = part_30_4*part_6_4
        part_38_4 = part_1_4_w_y_4*part_9_4 + part_30_4_part_6_4 - part_31_4*part_9_4 - part_37_4
        part_44_4 = part_38_4*part_43_4
        part_45_4 = I_wx*part_44_4 + I_wx*(g_z_dot_4*part_1_4_w_y_4 + part_37_4*part_43_4 - g_z_dot_4*part_31_4) - I_wy*part_44_4
        part_56_4 = D_x*g_x_dot_4 + K_x*g_x_4 - T_cx_end
        a_zz_4 = cos_phi_4*cos_theta_4
        a_zx_4 = -cos_phi_4*sin_theta_4
        part_59_4 = part_1_4*sin_phi_4 - a_zx_4*part_4_4
        part_60_4 = a_zz_4*part_6_4 + part_59_4*part_9_4
        part_64_4 = a_zz_4*part_9_4 - part_59_4*part_6_4
        acceleration_right_3_4 = 3.0*part_60_4*part_64_4*w0_sq*w_7 - part_45_4 - part_56_4
        acceleration_right_5_4 = -J_x_freq_x*(eta_x_4*freq_x + eta_x_dot_4*twice_zeta_x)
        part_21_4 = J_z*(eta_z_dot_4 + w_z_4)
        part_22_4 = J_y*(eta_y_dot_4 + w_y_4)
        part_25_4 = w_y_4*w_z_4
        part_27_4 = part_1_4*w_x_4
        part_28_4 = g_z_dot_4*part_9_4
        part_29_4 = part_4_4*w_y_4
        part_32_4 = g_x_dot_4*(part_1_4_w_y_4 - part_31_4)
        part_33_4 = g_x_dot_4*part_30_4*part_9_4 - part_27_4*part_28_4 - part_28_4*part_29_4 - part_32_4*part_6_4
        part_34_4 = I_wy*part_33_4
        part_35_4 = part_34_4*part_9_4
        part_36_4 = g_x_dot_4 + part_27_4 + part_29_4
        part_39_4 = part_36_4*part_38_4
        part_40_4 = I_wx*(g_z_dot_4*part_1_4*part_6_4*w_x_4 + g_z_dot_4*part_4_4*part_6_4*w_y_4 - g_x_dot_4*part_30_4_part_6_4 - part_32_4*part_9_4 - part_36_4*part_37_4) + I_wy*part_39_4 - I_wx*part_39_4
        part_41_4 = part_40_4*part_6_4
        part_54_4 = a_zz_4*w_15
        part_55_4 = part_54_4*sin_phi_4
        part_58_4 = a_zx_4*part_1_4 + part_4_4*sin_phi_4
        part_58_4_part_60_4 = part_58_4*part_60_4
        part_62_4 = -part_58_4_part_60_4*w_7
        part_63_4 = part_6_4*w_15
        part_65_4 = part_60_4*part_64_4*w_15
        acceleration_right_0_4 = J_z*part_55_4 + part_1_4*part_65_4*w_7 + part_22_4*w_z_4 + part_25_4*w_14 + part_35_4*part_4_4 + part_4_4*part_62_4*part_63_4 + part_55_4*(-part_57 - w_13) - J_y*part_55_4 - acceleration_right_3_4*factor_0_3_4 - acceleration_right_5_4 - part_1_4*part_45_4 - part_21_4*w_y_4 - part_24*part_25_4 - part_41_4*part_4_4
        acceleration_right_6_4 = -J_y_freq_y*(eta_y_4*freq_y + eta_y_dot_4*twice_zeta_y)
        part_46_4 = J_x*(eta_x_dot_4 + w_x_4)
        part_49_4 = w_x_4*w_z_4
        part_66_4 = a_zx_4*part_54_4
        acceleration_right_1_4 = J_x*part_66_4 + part_14_4*part_65_4 + part_1_4*part_41_4 + part_21_4*w_x_4 + part_24*part_49_4 + part_66_4*(w_13 + w_17) - J_z*part_66_4 - acceleration_right_0_4*factor_1_0_4 - acceleration_right_3_4*factor_1_3_4 - acceleration_right_6_4 - part_16_4*part_58_4_part_60_4*part_63_4 - part_1_4*part_35_4 - part_45_4*part_4_4 - part_46_4*w_z_4 - part_48*part_49_4
        acceleration_right_7_4 = -J_z_freq_z*(eta_z_4*freq_z + eta_z_dot_4*twice_zeta_z)
        part_50_4 = w_x_4*w_y_4
        part_51_4 = part_20_4*part_33_4 + part_40_4*part_9_4
        part_67_4 = a_zx_4*sin_phi_4
        acceleration_right_2_4 = part_46_4*w_y_4 + part_48*part_50_4 + w_15*(J_y*part_67_4 + part_62_4*part_9_4 + part_67_4*(part_57 + w_18) - J_x*part_67_4) - acceleration_right_0_4*w_37 - acceleration_right_1_4*factor_2_1_4 - acceleration_right_7_4 - part_22_4*w_x_4 - part_50_4*w_14 - part_51_4
        acceleration_right_4_4 = T_cz_end - D_z*g_z_dot_4 - K_z*g_z_4 - acceleration_right_0_4*w_37 - acceleration_right_1_4*factor_2_1_4 - acceleration_right_2_4*factor_4_2_4 - part_51_4 - part_58_4_part_60_4*part_9_4*w_15*w_7
        acceleration_right_8_4 = motor_torque_end + part_34_4 - acceleration_right_0_4*factor_8_0_4 - acceleration_right_1_4*factor_8_1_4 - acceleration_right_2_4*factor_8_2_4 - acceleration_right_4_4*factor_8_4_4
        acceleration_8_4 = acceleration_right_8_4*inv_rest_4_8_8_4
        acceleration_4_4 = acceleration_right_4_4*inv_rest_2_4_4_4 - acceleration_8_4*factor_8_4_4
        acceleration_2_4 = acceleration_right_2_4*inv_rest_1_2_2_4 - acceleration_4_4*factor_4_2_4 - acceleration_8_4*factor_8_2_4
        acceleration_1_4 = acceleration_right_1_4*inv_rest_0_1_1_4 - acceleration_2_4*factor_2_1_4 - acceleration_4_4*factor_2_1_4 - acceleration_8_4*factor_8_1_4
        acceleration_0_4 = acceleration_right_0_4*inv_rest_3_0_0_4 - acceleration_1_4*factor_1_0_4 - acceleration_2_4*w_37 - acceleration_4_4*w_37 - acceleration_8_4*factor_8_0_4
        acceleration_3_4 = acceleration_right_3_4*inv_I_wx - acceleration_0_4*factor_0_3_4 - acceleration_1_4*factor_1_3_4
        acceleration_5_4 = acceleration_right_5_4*inv_J_x - acceleration_0_4
        acceleration_6_4 = acceleration_right_6_4*inv_J_y - acceleration_1_4
        acceleration_7_4 = acceleration_right_7_4*inv_J_z - acceleration_2_4
        k4_phi = cos_theta_4*w_33 + sin_theta_4*w_34
        k4_psi = -inv_cos_phi_4*w_35
        k4_theta = a_yy_4*w0 + w_35*math.tan(phi_4) + w_y_4
        k23_g_x_dot = acceleration_3_2 + acceleration_3_3
        k123_g_x_dot = k23_g_x_dot + slope_g_x_dot
        k23_g_z_dot = acceleration_4_2 + acceleration_4_3
        k123_g_z_dot = k23_g_z_dot + slope_g_z_dot
        k23_eta_x_dot = acceleration_5_2 + acceleration_5_3
        k123_eta_x_dot = k23_eta_x_dot + slope_eta_x_dot
        k23_eta_y_dot = acceleration_6_2 + acceleration_6_3
        k123_eta_y_dot = k23_eta_y_dot + slope_eta_y_dot
        k23_eta_z_dot = acceleration_7_2 + acceleration_7_3
        k123_eta_z_dot = k23_eta_z_dot + slope_eta_z_dot
        phi_end = phi + sixth*(k4_phi + slope_phi + 2.0*(k2_phi + k3_phi))
        psi_end = psi + sixth*(k4_psi + slope_psi + 2.0*(k2_psi + k3_psi))
        theta_end = sixth*(k4_theta + slope_theta + 2.0*(k2_theta + k3_theta)) + theta
        g_x_end = g_x + h*(g_x_dot + k123_g_x_dot*sixth)
        g_z_end = g_z + h*(g_z_dot + k123_g_z_dot*sixth)
        eta_x_end = eta_x + h*(eta_x_dot + k123_eta_x_dot*sixth)
        eta_y_end = eta_y + h*(eta_y_dot + k123_eta_y_dot*sixth)
        eta_z_end = eta_z + h*(eta_z_dot + k123_eta_z_dot*sixth)
        w_x_end = sixth*(acceleration_0_4 + slope_w_x + 2.0*(acceleration_0_2 + acceleration_0_3)) + w_x
        w_y_end = sixth*(acceleration_1_4 + slope_w_y + 2.0*(acceleration_1_2 + acceleration_1_3)) + w_y
        w_z_end = sixth*(acceleration_2_4 + slope_w_z + 2.0*(acceleration_2_2 + acceleration_2_3)) + w_z
        g_x_dot_end = g_x_dot + sixth*(acceleration_3_4 + k123_g_x_dot + k23_g_x_dot)
        g_z_dot_end = g_z_dot + sixth*(acceleration_4_4 + k123_g_z_dot + k23_g_z_dot)
        eta_x_dot_end = eta_x_dot + sixth*(acceleration_5_4 + k123_eta_x_dot + k23_eta_x_dot)
        eta_y_dot_end = eta_y_dot + sixth*(acceleration_6_4 + k123_eta_y_dot + k23_eta_y_dot)
        eta_z_dot_end = eta_z_dot + sixth*(acceleration_7_4 + k123_eta_z_dot + k23_eta_z_dot)
        wheel_speed_end = sixth*(acceleration_8_4 + slope_wheel_speed + 2.0*(acceleration_8_2 + acceleration_8_3)) + wheel_speed
        sin_psi_end = math.sin(psi_end)
        cos_theta_end = math.cos(theta_end)
        sin_theta_end = math.sin(theta_end)
        cos_psi_end = math.cos(psi_end)
        sin_phi_end = math.sin(phi_end)
        cos_psi_end_sin_phi_end = cos_psi_end*sin_phi_end
        a_yx_5 = cos_psi_end_sin_phi_end*sin_theta_end + cos_theta_end*sin_psi_end
        w_40 = a_yx_5*w0 + w_x_end
        a_yz_5 = sin_psi_end*sin_theta_end - cos_psi_end_sin_phi_end*cos_theta_end
        w_41 = a_yz_5*w0 + w_z_end
        cos_phi_end = math.cos(phi_end)
        inv_cos_phi_end = 1.0/cos_phi_end
        w_42 = sin_theta_end*w_40 - cos_theta_end*w_41
        a_yy_5 = cos_phi_end*cos_psi_end
        part_1_5 = math.cos(g_z_end)
        mass_4_1_5 = I_wx*part_1_5
        factor_0_3_5 = inv_I_wx*mass_4_1_5
        part_9_5 = math.cos(g_x_end)
        part_10_5 = part_9_5*part_9_5
        part_11_5 = I_wy*part_10_5
        part_2_5 = part_1_5*part_1_5
        part_3_5 = I_wx*part_2_5
        part_4_5 = math.sin(g_z_end)
        part_5_5 = part_4_5*part_4_5
        part_6_5 = math.sin(g_x_end)
        part_7_5 = part_6_5*part_6_5
        part_8_5 = I_wx*part_7_5
        mass_1_1_5 = part_11_5*part_5_5 + part_3_5 + part_5_5*part_8_5 + w_4
        rest_5_0_0_5 = mass_1_1_5 - J_x
        rest_3_0_0_5 = rest_5_0_0_5 - factor_0_3_5*mass_4_1_5
        inv_rest_3_0_0_5 = 1.0/rest_3_0_0_5
        mass_2_1_5 = part_1_5*part_4_5*(I_wx - part_11_5 - part_8_5)
        mass_4_2_5 = I_wx*part_4_5
        rest_3_0_1_5 = mass_2_1_5 - factor_0_3_5*mass_4_2_5
        factor_1_0_5 = inv_rest_3_0_0_5*rest_3_0_1_5
        factor_1_3_5 = inv_I_wx*mass_4_2_5
        mass_2_2_5 = I_wx*part_5_5 + part_11_5*part_2_5 + part_3_5*part_7_5 + w_6
        rest_6_1_1_5 = mass_2_2_5 - J_y
        rest_3_1_1_5 = rest_6_1_1_5 - factor_1_3_5*mass_4_2_5
        rest_0_1_1_5 = rest_3_1_1_5 - factor_1_0_5*rest_3_0_1_5
        inv_rest_0_1_1_5 = 1.0/rest_0_1_1_5
        part_12_5 = part_6_5*part_9_5
        part_14_5 = part_4_5*w_7
        part_15_5 = part_12_5*part_14_5
        part_16_5 = -part_1_5*w_7
        part_17_5 = part_12_5*part_16_5
        w_43 = part_17_5 - factor_1_0_5*part_15_5
        factor_2_1_5 = inv_rest_0_1_1_5*w_43
        w_44 = inv_rest_3_0_0_5*part_15_5
        part_15_5_w_44 = part_15_5*w_44
        part_18_5 = I_wx*part_10_5 + I_wy*part_7_5
        mass_3_3_5 = part_18_5 + w_10
        rest_7_2_2_5 = mass_3_3_5 - J_z
        rest_0_2_2_5 = rest_7_2_2_5 - part_15_5_w_44
        rest_1_2_2_5 = rest_0_2_2_5 - factor_2_1_5*w_43
        inv_rest_1_2_2_5 = 1.0/rest_1_2_2_5
        w_45 = -part_18_5
        rest_0_2_4_5 = -part_15_5_w_44 - w_45
        rest_1_2_4_5 = rest_0_2_4_5 - factor_2_1_5*w_43
        factor_4_2_5 = inv_rest_1_2_2_5*rest_1_2_4_5
        rest_0_4_4_5 = -part_15_5*w_44 - w_45
        rest_1_4_4_5 = rest_0_4_4_5 - factor_2_1_5*w_43
        rest_2_4_4_5 = rest_1_4_4_5 - factor_4_2_5*rest_1_2_4_5
        inv_rest_2_4_4_5 = 1.0/rest_2_4_4_5
        part_19_5 = I_wy*part_9_5
        mass_9_1_5 = part_19_5*part_4_5
        mass_9_2_5 = -part_19_5*part_1_5
        rest_0_1_8_5 = mass_9_2_5 - factor_1_0_5*mass_9_1_5
        part_20_5 = I_wy*part_6_5
        w_46 = -part_20_5
        rest_0_2_8_5 = w_46 - mass_9_1_5*w_44
        rest_1_2_8_5 = rest_0_2_8_5 - factor_2_1_5*rest_0_1_8_5
        rest_2_4_8_5 = rest_1_2_8_5 - factor_4_2_5*rest_1_2_8_5
        factor_8_4_5 = inv_rest_2_4_4_5*rest_2_4_8_5
        factor_8_2_5 = inv_rest_1_2_2_5*rest_1_2_8_5
        factor_8_1_5 = inv_rest_0_1_1_5*rest_0_1_8_5
        factor_8_0_5 = inv_rest_3_0_0_5*mass_9_1_5
        rest_0_8_8_5 = I_wy - factor_8_0_5*mass_9_1_5
        rest_1_8_8_5 = rest_0_8_8_5 - factor_8_1_5*rest_0_1_8_5
        rest_2_8_8_5 = rest_1_8_8_5 - factor_8_2_5*rest_1_2_8_5
        rest_4_8_8_5 = rest_2_8_8_5 - factor_8_4_5*rest_2_4_8_5
        inv_rest_4_8_8_5 = 1.0/rest_4_8_8_5
        part_31_5 = part_4_5*w_x_end
        part_37_5 = nominal_speed + wheel_speed_end
        part_1_5_w_y_end = part_1_5*w_y_end
        part_30_5 = g_z_dot_end + w_z_end
        part_43_5 = part_30_5*part_9_5 + part_31_5*part_6_5 - part_1_5_w_y_end*part_6_5
        part_30_5_part_6_5 = part_30_5*part_6_5
        part_38_5 = part_1_5_w_y_end*part_9_5 + part_30_5_part_6_5 - part_31_5*part_9_5 - part_37_5
        part_44_5 = part_38_5*part_43_5
        part_45_5 = I_wx*part_44_5 + I_wx*(g_z_dot_end*part_1_5_w_y_end + part_37_5*part_43_5 - g_z_dot_end*part_31_5) - I_wy*part_44_5
        part_56_5 = D_x*g_x_dot_end + K_x*g_x_end - T_cx_end
        a_zz_5 = cos_phi_end*cos_theta_end
        a_zx_5 = -cos_phi_end*sin_theta_end
        part_59_5 = part_1_5*sin_phi_end - a_zx_5*part_4_5
        part_60_5 = a_zz_5*part_6_5 + part_59_5*part_9_5
        part_64_5 = a_zz_5*part_9_5 - part_59_5*part_6_5
        acceleration_right_3_5 = 3.0*part_60_5*part_64_5*w0_sq*w_7 - part_45_5 - part_56_5
        acceleration_right_5_5 = -J_x_freq_x*(eta_x_dot_end*twice_zeta_x + eta_x_end*freq_x)
        part_21_5 = J_z*(eta_z_dot_end + w_z_end)
        part_22_5 = J_y*(eta_y_dot_end + w_y_end)
        part_25_5 = w_y_end*w_z_end
        part_27_5 = part_1_5*w_x_end
        part_28_5 = g_z_dot_end*part_9_5
        part_29_5 = part_4_5*w_y_end
        part_32_5 = g_x_dot_end*(part_1_5_w_y_end - part_31_5)
        part_33_5 = g_x_dot_end*part_30_5*part_9_5 - part_27_5*part_28_5 - part_28_5*part_29_5 - part_32_5*part_6_5
        part_34_5 = I_wy*part_33_5
        part_35_5 = part_34_5*part_9_5
        part_36_5 = g_x_dot_end + part_27_5 + part_29_5
        part_39_5 = part_36_5*part_38_5
        part_40_5 = I_wx*(g_z_dot_end*part_1_5*part_6_5*w_x_end + g_z_dot_end*part_4_5*part_6_5*w_y_end - g_x_dot_end*part_30_5_part_6_5 - part_32_5*part_9_5 - part_36_5*part_37_5) + I_wy*part_39_5 - I_wx*part_39_5
        part_41_5 = part_40_5*part_6_5
        part_54_5 = a_zz_5*w_15
        part_55_5 = part_54_5*sin_phi_end
        part_58_5 = a_zx_5*part_1_5 + part_4_5*sin_phi_end
        part_58_5_part_60_5 = part_58_5*part_60_5
        part_62_5 = -part_58_5_part_60_5*w_7
        part_63_5 = part_6_5*w_15
        part_65_5 = part_60_5*part_64_5*w_15
        acceleration_right_0_5 = J_z*part_55_5 + part_1_5*part_65_5*w_7 + part_22_5*w_z_end + part_25_5*w_14 + part_35_5*part_4_5 + part_4_5*part_62_5*part_63_5 + part_55_5*(-part_57 - w_13) - J_y*part_55_5 - acceleration_right_3_5*factor_0_3_5 - acceleration_right_5_5 - part_1_5*part_45_5 - part_21_5*w_y_end - part_24*part_25_5 - part_41_5*part_4_5
        acceleration_right_6_5 = -J_y_freq_y*(eta_y_dot_end*twice_zeta_y + eta_y_end*freq_y)
        part_46_5 = J_x*(eta_x_dot_end + w_x_end)
        part_49_5 = w_x_end*w_z_end
        part_66_5 = a_zx_5*part_54_5
        acceleration_right_1_5 = J_x*part_66_5 + part_14_5*part_65_5 + part_1_5*part_41_5 + part_21_5*w_x_end + part_24*part_49_5 + part_66_5*(w_13 + w_17) - J_z*part_66_5 - acceleration_right_0_5*factor_1_0_5 - acceleration_right_3_5*factor_1_3_5 - acceleration_right_6_5 - part_16_5*part_58_5_part_60_5*part_63_5 - part_1_5*part_35_5 - part_45_5*part_4_5 - part_46_5*w_z_end - part_48*part_49_5
        acceleration_right_7_5 = -J_z_freq_z*(eta_z_dot_end*twice_zeta_z + eta_z_end*freq_z)
        part_50_5 = w_x_end*w_y_end
        part_51_5 = part_20_5*part_33_5 + part_40_5*part_9_5
        part_67_5 = a_zx_5*sin_phi_end
        acceleration_right_2_5 = part_46_5*w_y_end + part_48*part_50_5 + w_15*(J_y*part_67_5 + part_62_5*part_9_5 + part_67_5*(part_57 + w_18) - J_x*part_67_5) - acceleration_right_0_5*w_44 - acceleration_right_1_5*factor_2_1_5 - acceleration_right_7_5 - part_22_5*w_x_end - part_50_5*w_14 - part_51_5
        acceleration_right_4_5 = T_cz_end - D_z*g_z_dot_end - K_z*g_z_end - acceleration_right_0_5*w_44 - acceleration_right_1_5*factor_2_1_5 - acceleration_right_2_5*factor_4_2_5 - part_51_5 - part_58_5_part_60_5*part_9_5*w_15*w_7
        acceleration_right_8_5 = motor_torque_end + part_34_5 - acceleration_right_0_5*factor_8_0_5 - acceleration_right_1_5*factor_8_1_5 - acceleration_right_2_5*factor_8_2_5 - acceleration_right_4_5*factor_8_4_5
        acceleration_8_5 = acceleration_right_8_5*inv_rest_4_8_8_5
        acceleration_4_5 = acceleration_right_4_5*inv_rest_2_4_4_5 - acceleration_8_5*factor_8_4_5
        acceleration_2_5 = acceleration_right_2_5*inv_rest_1_2_2_5 - acceleration_4_5*factor_4_2_5 - acceleration_8_5*factor_8_2_5
        acceleration_1_5 = acceleration_right_1_5*inv_rest_0_1_1_5 - acceleration_2_5*factor_2_1_5 - acceleration_4_5*factor_2_1_5 - acceleration_8_5*factor_8_1_5
        acceleration_0_5 = acceleration_right_0_5*inv_rest_3_0_0_5 - acceleration_1_5*factor_1_0_5 - acceleration_2_5*w_44 - acceleration_4_5*w_44 - acceleration_8_5*factor_8_0_5
        acceleration_3_5 = acceleration_right_3_5*inv_I_wx - acceleration_0_5*factor_0_3_5 - acceleration_1_5*factor_1_3_5
        acceleration_5_5 = acceleration_right_5_5*inv_J_x - acceleration_0_5
        acceleration_6_5 = acceleration_right_6_5*inv_J_y - acceleration_1_5
        acceleration_7_5 = acceleration_right_7_5*inv_J_z - acceleration_2_5
        slope_end_phi = cos_theta_end*w_40 + sin_theta_end*w_41
        slope_end_psi = -inv_cos_phi_end*w_42
        slope_end_theta = a_yy_5*w0 + w_42*math.tan(phi_end) + w_y_end
        eighth = 0.125*h
        phi_mid[i] = eighth*(slope_phi - slope_end_phi) + 0.5*(phi + phi_end)
        psi_mid[i] = eighth*(slope_psi - slope_end_psi) + 0.5*(psi + psi_end)
        theta_mid[i] = eighth*(slope_theta - slope_end_theta) + 0.5*(theta + theta_end)
        g_x_mid[i] = eighth*(g_x_dot - g_x_dot_end) + 0.5*(g_x + g_x_end)
        g_z_mid[i] = eighth*(g_z_dot - g_z_dot_end) + 0.5*(g_z + g_z_end)
        eta_x_mid[i] = eighth*(eta_x_dot - eta_x_dot_end) + 0.5*(eta_x + eta_x_end)
        eta_y_mid[i] = eighth*(eta_y_dot - eta_y_dot_end) + 0.5*(eta_y + eta_y_end)
        eta_z_mid[i] = eighth*(eta_z_dot - eta_z_dot_end) + 0.5*(eta_z + eta_z_end)
        w_x_mid[i] = eighth*(slope_w_x - acceleration_0_5) + 0.5*(w_x + w_x_end)
        w_y_mid[i] = eighth*(slope_w_y - acceleration_1_5) + 0.5*(w_y + w_y_end)
        w_z_mid[i] = eighth*(slope_w_z - acceleration_2_5) + 0.5*(w_z + w_z_end)
        g_x_dot_mid[i] = eighth*(slope_g_x_dot - acceleration_3_5) + 0.5*(g_x_dot + g_x_dot_end)
        g_z_dot_mid[i] = eighth*(slope_g_z_dot - acceleration_4_5) + 0.5*(g_z_dot + g_z_dot_end)
        eta_x_dot_mid[i] = eighth*(slope_eta_x_dot - acceleration_5_5) + 0.5*(eta_x_dot + eta_x_dot_end)
        eta_y_dot_mid[i] = eighth*(slope_eta_y_dot - acceleration_6_5) + 0.5*(eta_y_dot + eta_y_dot_end)
        eta_z_dot_mid[i] = eighth*(slope_eta_z_dot - acceleration_7_5) + 0.5*(eta_z_dot + eta_z_dot_end)
        wheel_speed_mid[i] = eighth*(slope_wheel_speed - acceleration_8_5) + 0.5*(wheel_speed + wheel_speed_end)
        t = t_end
        phi = phi_end
        psi = psi_end
        theta = theta_end
        g_x = g_x_end
        g_z = g_z_end
        eta_x = eta_x_end
        eta_y = eta_y_end
        eta_z = eta_z_end
        w_x = w_x_end
        w_y = w_y_end
        w_z = w_z_end
        g_x_dot = g_x_dot_end
        g_z_dot = g_z_dot_end
        eta_x_dot = eta_x_dot_end
        eta_y_dot = eta_y_dot_end
        eta_z_dot = eta_z_dot_end
        wheel_speed = wheel_speed_end
        slope_phi = slope_end_phi
        slope_psi = slope_end_psi
        slope_theta = slope_end_theta
        slope_w_x = acceleration_0_5
        slope_w_y = acceleration_1_5
        slope_w_z = acceleration_2_5
        slope_g_x_dot = acceleration_3_5
        slope_g_z_dot = acceleration_4_5
        slope_eta_x_dot = acceleration_5_5
        slope_eta_y_dot = acceleration_6_5
        slope_eta_z_dot = acceleration_7_5
        slope_wheel_speed = acceleration_8_5
    phi_at[steps] = phi
    psi_at[steps] = psi
    theta_at[steps] = theta
    g_x_at[steps] = g_x
    g_z_at[steps] = g_z
    eta_x_at[steps] = eta_x
    eta_y_at[steps] = eta_y
    eta_z_at[steps] = eta_z
    w_x_at[steps] = w_x
    w_y_at[steps] = w_y
    w_z_at[steps] = w_z
    g_x_dot_at[steps] = g_x_dot
    g_z_dot_at[steps] = g_z_dot
    eta_x_dot_at[steps] = eta_x_dot
    eta_y_dot_at[steps] = eta_y_dot
    eta_z_dot_at[steps] = eta_z_dot
    wheel_speed_at[steps] = wheel_speed


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, w_x, w_y, w_z, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((17, *shape), np.result_type(float, t, x, u, *p))
    cos_theta = np.cos(theta)
    sin_psi = np.sin(psi)
    sin_theta = np.sin(theta)
    cos_psi = np.cos(psi)
    sin_phi = np.sin(phi)
    cos_psi_sin_phi = cos_psi*sin_phi
    a_yx = cos_psi_sin_phi*sin_theta + cos_theta*sin_psi
    w = a_yx*w0 + w_x
    a_yz = sin_psi*sin_theta - cos_psi_sin_phi*cos_theta
    w_2 = a_yz*w0 + w_z
    cos_phi = np.cos(phi)
    inv_cos_phi = 1.0/cos_phi
    w_3 = sin_theta*w - cos_theta*w_2
    a_yy = cos_phi*cos_psi
    inv_I_wx = 1.0/I_wx
    part_1 = np.cos(g_z)
    mass_4_1 = I_wx*part_1
    factor_0_3 = inv_I_wx*mass_4_1
    w_4 = -I_wx
    part_9 = np.cos(g_x)
    part_10 = part_9*part_9
    part_11 = I_wy*part_10
    part_2 = part_1*part_1
    part_3 = I_wx*part_2
    part_4 = np.sin(g_z)
    part_5 = part_4*part_4
    part_6 = np.sin(g_x)
    part_7 = part_6*part_6
    part_8 = I_wx*part_7
    mass_1_1 = I_x + part_11*part_5 + part_3 + part_5*part_8 + w_4
    rest_5_0_0 = mass_1_1 - J_x
    rest_3_0_0 = rest_5_0_0 - factor_0_3*mass_4_1
    inv_rest_3_0_0 = 1.0/rest_3_0_0
    mass_2_1 = part_1*part_4*(-part_11 - part_8 - w_4)
    mass_4_2 = I_wx*part_4
    rest_3_0_1 = mass_2_1 - factor_0_3*mass_4_2
    factor_1_0 = inv_rest_3_0_0*rest_3_0_1
    factor_1_3 = inv_I_wx*mass_4_2
    w_5 = -I_wy
    mass_2_2 = I_wx*part_5 + I_y + part_11*part_2 + part_3*part_7 + w_5
    rest_6_1_1 = mass_2_2 - J_y
    rest_3_1_1 = rest_6_1_1 - factor_1_3*mass_4_2
    rest_0_1_1 = rest_3_1_1 - factor_1_0*rest_3_0_1
    inv_rest_0_1_1 = 1.0/rest_0_1_1
    part_12 = part_6*part_9
    part_13 = I_wx + w_5
    part_14 = part_13*part_4
    part_15 = part_12*part_14
    part_16 = -part_1*part_13
    part_17 = part_12*part_16
    w_6 = part_17 - factor_1_0*part_15
    factor_2_1 = inv_rest_0_1_1*w_6
    inv_rest_3_0_0_part_15 = inv_rest_3_0_0*part_15
    w_7 = inv_rest_3_0_0_part_15*part_15
    part_18 = I_wx*part_10 + I_wy*part_7
    mass_3_3 = I_z + part_18 + w_4
    rest_7_2_2 = mass_3_3 - J_z
    rest_0_2_2 = rest_7_2_2 - w_7
    rest_1_2_2 = rest_0_2_2 - factor_2_1*w_6
    inv_rest_1_2_2 = 1.0/rest_1_2_2
    w_8 = -part_18
    rest_0_2_4 = -w_7 - w_8
    rest_1_2_4 = rest_0_2_4 - factor_2_1*w_6
    factor_4_2 = inv_rest_1_2_2*rest_1_2_4
    rest_0_4_4 = -inv_rest_3_0_0_part_15*part_15 - w_8
    rest_1_4_4 = rest_0_4_4 - factor_2_1*w_6
    rest_2_4_4 = rest_1_4_4 - factor_4_2*rest_1_2_4
    inv_rest_2_4_4 = 1.0/rest_2_4_4
    part_19 = I_wy*part_9
    mass_9_1 = part_19*part_4
    mass_9_2 = -part_1*part_19
    rest_0_1_8 = mass_9_2 - factor_1_0*mass_9_1
    part_20 = I_wy*part_6
    w_9 = -part_20
    rest_0_2_8 = w_9 - inv_rest_3_0_0_part_15*mass_9_1
    rest_1_2_8 = rest_0_2_8 - factor_2_1*rest_0_1_8
    rest_2_4_8 = rest_1_2_8 - factor_4_2*rest_1_2_8
    factor_8_4 = inv_rest_2_4_4*rest_2_4_8
    factor_8_2 = inv_rest_1_2_2*rest_1_2_8
    factor_8_1 = inv_rest_0_1_1*rest_0_1_8
    factor_8_0 = inv_rest_3_0_0*mass_9_1
    rest_0_8_8 = I_wy - factor_8_0*mass_9_1
    rest_1_8_8 = rest_0_8_8 - factor_8_1*rest_0_1_8
    rest_2_8_8 = rest_1_8_8 - factor_8_2*rest_1_2_8
    rest_4_8_8 = rest_2_8_8 - factor_8_4*rest_2_4_8
    inv_rest_4_8_8 = 1.0/rest_4_8_8
    part_31 = part_4*w_x
    part_37 = nominal_speed + wheel_speed
    part_1_w_y = part_1*w_y
    part_30 = g_z_dot + w_z
    part_43 = part_30*part_9 + part_31*part_6 - part_1_w_y*part_6
    part_30_part_6 = part_30*part_6
    part_38 = part_1_w_y*part_9 + part_30_part_6 - part_31*part_9 - part_37
    part_44 = part_38*part_43
    part_45 = I_wx*part_44 + I_wx*(g_z_dot*part_1_w_y + part_37*part_43 - g_z_dot*part_31) - I_wy*part_44
    part_52 = w0*w0
    part_56 = D_x*g_x_dot + K_x*g_x - T_cx
    a_zz = cos_phi*cos_theta
    a_zx = -cos_phi*sin_theta
    part_59 = part_1*sin_phi - a_zx*part_4
    part_60 = a_zz*part_6 + part_59*part_9
    part_64 = a_zz*part_9 - part_59*part_6
    acceleration_right_3 = 3.0*part_13*part_52*part_60*part_64 - part_45 - part_56
    acceleration_right_5 = -J_x*freq_x*(eta_x*freq_x + 2.0*eta_x_dot*zeta_x)
    part_21 = J_z*(eta_z_dot + w_z)
    part_22 = J_y*(eta_y_dot + w_y)
    part_23 = J_z - I_z
    part_24 = -I_wx - part_23
    part_25 = w_y*w_z
    part_26 = I_y - I_wy - J_y
    part_27 = part_1*w_x
    part_28 = g_z_dot*part_9
    part_29 = part_4*w_y
    part_32 = g_x_dot*(part_1_w_y - part_31)
    part_33 = g_x_dot*part_30*part_9 - part_27*part_28 - part_28*part_29 - part_32*part_6
    part_34 = I_wy*part_33
    part_35 = part_34*part_9
    part_36 = g_x_dot + part_27 + part_29
    part_39 = part_36*part_38
    part_40 = I_wx*(g_z_dot*part_1*part_6*w_x + g_z_dot*part_4*part_6*w_y - g_x_dot*part_30_part_6 - part_32*part_9 - part_36*part_37) + I_wy*part_39 - I_wx*part_39
    part_41 = part_40*part_6
    w_10 = 3.0*part_52
    part_54 = a_zz*w_10
    part_55 = part_54*sin_phi
    part_57 = I_y + part_13 - J_y
    part_58 = a_zx*part_1 + part_4*sin_phi
    part_58_part_60 = part_58*part_60
    part_62 = -part_13*part_58_part_60
    part_63 = part_6*w_10
    part_65 = part_60*part_64*w_10
    acceleration_right_0 = J_z*part_55 + part_1*part_13*part_65 + part_22*w_z + part_25*part_26 + part_35*part_4 + part_4*part_62*part_63 + part_55*(-part_23 - part_57) - J_y*part_55 - acceleration_right_3*factor_0_3 - acceleration_right_5 - part_1*part_45 - part_21*w_y - part_24*part_25 - part_4*part_41
    w_11 = I_x - J_x
    acceleration_right_6 = -J_y*freq_y*(eta_y*freq_y + 2.0*eta_y_dot*zeta_y)
    part_46 = J_x*(eta_x_dot + w_x)
    part_47 = -w_11
    part_48 = -I_wx - part_47
    part_49 = w_x*w_z
    part_66 = a_zx*part_54
    acceleration_right_1 = J_x*part_66 + part_1*part_41 + part_14*part_65 + part_21*w_x + part_24*part_49 + part_66*(part_23 + w_11) - J_z*part_66 - acceleration_right_0*factor_1_0 - acceleration_right_3*factor_1_3 - acceleration_right_6 - part_1*part_35 - part_16*part_58_part_60*part_63 - part_4*part_45 - part_46*w_z - part_48*part_49
    acceleration_right_7 = -J_z*freq_z*(eta_z*freq_z + 2.0*eta_z_dot*zeta_z)
    part_50 = w_x*w_y
    part_51 = part_20*part_33 + part_40*part_9
    part_67 = a_zx*sin_phi
    acceleration_right_2 = part_46*w_y + part_48*part_50 + w_10*(J_y*part_67 + part_62*part_9 + part_67*(part_47 + part_57) - J_x*part_67) - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_7 - part_22*w_x - part_26*part_50 - part_51
    acceleration_right_4 = T_cz - D_z*g_z_dot - K_z*g_z - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_2*factor_4_2 - part_13*part_58_part_60*part_9*w_10 - part_51
    acceleration_right_8 = motor_torque + part_34 - acceleration_right_0*factor_8_0 - acceleration_right_1*factor_8_1 - acceleration_right_2*factor_8_2 - acceleration_right_4*factor_8_4
    acceleration_8 = acceleration_right_8*inv_rest_4_8_8
    acceleration_4 = acceleration_right_4*inv_rest_2_4_4 - acceleration_8*factor_8_4
    acceleration_2 = acceleration_right_2*inv_rest_1_2_2 - acceleration_4*factor_4_2 - acceleration_8*factor_8_2
    acceleration_1 = acceleration_right_1*inv_rest_0_1_1 - acceleration_2*factor_2_1 - acceleration_4*factor_2_1 - acceleration_8*factor_8_1
    acceleration_0 = acceleration_right_0*inv_rest_3_0_0 - acceleration_1*factor_1_0 - acceleration_2*inv_rest_3_0_0_part_15 - acceleration_4*inv_rest_3_0_0_part_15 - acceleration_8*factor_8_0
    acceleration_3 = acceleration_right_3*inv_I_wx - acceleration_0*factor_0_3 - acceleration_1*factor_1_3
    inv_J_x = 1.0/J_x
    acceleration_5 = acceleration_right_5*inv_J_x - acceleration_0
    inv_J_y = 1.0/J_y
    acceleration_6 = acceleration_right_6*inv_J_y - acceleration_1
    inv_J_z = 1.0/J_z
    acceleration_7 = acceleration_right_7*inv_J_z - acceleration_2
    out[0] = cos_theta*w + sin_theta*w_2
    out[1] = -inv_cos_phi*w_3
    out[2] = a_yy*w0 + w_3*np.tan(phi) + w_y
    out[3] = g_x_dot
    out[4] = g_z_dot
    out[5] = eta_x_dot
    out[6] = eta_y_dot
    out[7] = eta_z_dot
    out[8] = acceleration_0
    out[9] = acceleration_1
    out[10] = acceleration_2
    out[11] = acceleration_3
    out[12] = acceleration_4
    out[13] = acceleration_5
    out[14] = acceleration_6
    out[15] = acceleration_7
    out[16] = acceleration_8
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, w_x, w_y, w_z, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((17, 17, *shape), np.result_type(float, t, x, u, *p))
    cos_theta = np.cos(theta)
    cos_theta_w0 = cos_theta*w0
    sin_theta = np.sin(theta)
    sin_theta_w0 = sin_theta*w0
    cos_phi = np.cos(phi)
    cos_phi_sin_theta = cos_phi*sin_theta
    cos_psi = np.cos(psi)
    d_a_yx_by_phi = cos_phi_sin_theta*cos_psi
    cos_phi_cos_theta = cos_phi*cos_theta
    d_a_yz_by_phi = -cos_phi_cos_theta*cos_psi
    sin_psi = np.sin(psi)
    sin_phi = np.sin(phi)
    d_a_yx_by_psi = cos_psi*cos_theta - sin_phi*sin_psi*sin_theta
    cos_theta_sin_psi = cos_theta*sin_psi
    d_a_yz_by_psi = cos_psi*sin_theta + cos_theta_sin_psi*sin_phi
    cos_psi_sin_phi = cos_psi*sin_phi
    w = cos_psi_sin_phi*cos_theta - sin_psi*sin_theta
    a_yz = -w
    w_2 = a_yz*w0 + w_z
    w_3 = cos_psi_sin_phi*sin_theta + cos_theta_sin_psi
    w_4 = w0*w_3 + w_x
    sin_theta_w_4 = sin_theta*w_4
    inv_cos_phi = 1.0/cos_phi
    cos_theta_inv_cos_phi = cos_theta*inv_cos_phi
    cos_theta_inv_cos_phi_w0 = cos_theta_inv_cos_phi*w0
    inv_cos_phi_sin_theta = inv_cos_phi*sin_theta
    inv_cos_phi_sin_theta_w0 = inv_cos_phi_sin_theta*w0
    w_5 = sin_theta_w_4 - cos_theta*w_2
    w_6 = cos_theta*w_4 + sin_theta*w_2
    tan_phi = np.tan(phi)
    sin_theta_tan_phi = sin_theta*tan_phi
    sin_theta_tan_phi_w0 = sin_theta_tan_phi*w0
    cos_theta_tan_phi = cos_theta*tan_phi
    cos_theta_tan_phi_w0 = cos_theta_tan_phi*w0
    d_a_yy_by_phi = -cos_psi_sin_phi
    d_a_yy_by_psi = -cos_phi*sin_psi
    inv_I_wx = 1.0/I_wx
    cos_g_z = np.cos(g_z)
    I_wx_cos_g_z = I_wx*cos_g_z
    factor_0_3 = I_wx_cos_g_z*inv_I_wx
    w_7 = -I_wx
    cos_g_x = np.cos(g_x)
    part_10 = cos_g_x*cos_g_x
    part_11 = I_wy*part_10
    part_2 = cos_g_z*cos_g_z
    part_3 = I_wx*part_2
    sin_g_z = np.sin(g_z)
    part_5 = sin_g_z*sin_g_z
    sin_g_x = np.sin(g_x)
    part_7 = sin_g_x*sin_g_x
    part_8 = I_wx*part_7
    mass_1_1 = I_x + part_11*part_5 + part_3 + part_5*part_8 + w_7
    rest_5_0_0 = mass_1_1 - J_x
    rest_3_0_0 = rest_5_0_0 - I_wx_cos_g_z*factor_0_3
    inv_rest_3_0_0 = 1.0/rest_3_0_0
    w_8 = part_11 + part_8
    w_9 = -w_7 - w_8
    cos_g_z_sin_g_z = cos_g_z*sin_g_z
    mass_2_1 = cos_g_z_sin_g_z*w_9
    I_wx_sin_g_z = I_wx*sin_g_z
    rest_3_0_1 = mass_2_1 - I_wx_sin_g_z*factor_0_3
    factor_1_0 = inv_rest_3_0_0*rest_3_0_1
    part_12 = cos_g_x*sin_g_x
    w_10 = -I_wy
    w_11 = I_wx + w_10
    part_14 = sin_g_z*w_11
    part_15 = part_12*part_14
    inv_rest_3_0_0_part_15 = inv_rest_3_0_0*part_15
    part_19 = I_wy*cos_g_x
    mass_9_1 = part_19*sin_g_z
    factor_8_0 = inv_rest_3_0_0*mass_9_1
    factor_1_3 = I_wx_sin_g_z*inv_I_wx
    mass_2_2 = I_wx*part_5 + I_y + part_11*part_2 + part_3*part_7 + w_10
    rest_6_1_1 = mass_2_2 - J_y
    rest_3_1_1 = rest_6_1_1 - I_wx_sin_g_z*factor_1_3
    rest_0_1_1 = rest_3_1_1 - factor_1_0*rest_3_0_1
    inv_rest_0_1_1 = 1.0/rest_0_1_1
    cos_g_z_w_11 = cos_g_z*w_11
    part_16 = -cos_g_z_w_11
    part_17 = part_12*part_16
    w_12 = part_17 - factor_1_0*part_15
    factor_2_1 = inv_rest_0_1_1*w_12
    mass_9_2 = -cos_g_z*part_19
    rest_0_1_8 = mass_9_2 - factor_1_0*mass_9_1
    factor_8_1 = inv_rest_0_1_1*rest_0_1_8
    w_13 = inv_rest_3_0_0_part_15*part_15
    part_18 = I_wx*part_10 + I_wy*part_7
    mass_3_3 = I_z + part_18 + w_7
    rest_7_2_2 = mass_3_3 - J_z
    rest_0_2_2 = rest_7_2_2 - w_13
    rest_1_2_2 = rest_0_2_2 - factor_2_1*w_12
    inv_rest_1_2_2 = 1.0/rest_1_2_2
    w_14 = -part_18
    rest_0_2_4 = -w_13 - w_14
    rest_1_2_4 = rest_0_2_4 - factor_2_1*w_12
    factor_4_2 = inv_rest_1_2_2*rest_1_2_4
    part_20 = I_wy*sin_g_x
    w_15 = -part_20
    rest_0_2_8 = w_15 - inv_rest_3_0_0_part_15*mass_9_1
    rest_1_2_8 = rest_0_2_8 - factor_2_1*rest_0_1_8
    factor_8_2 = inv_rest_1_2_2*rest_1_2_8
    rest_0_4_4 = -inv_rest_3_0_0_part_15*part_15 - w_14
    rest_1_4_4 = rest_0_4_4 - factor_2_1*w_12
    rest_2_4_4 = rest_1_4_4 - factor_4_2*rest_1_2_4
    inv_rest_2_4_4 = 1.0/rest_2_4_4
    rest_2_4_8 = rest_1_2_8 - factor_4_2*rest_1_2_8
    factor_8_4 = inv_rest_2_4_4*rest_2_4_8
    rest_0_8_8 = I_wy - factor_8_0*mass_9_1
    rest_1_8_8 = rest_0_8_8 - factor_8_1*rest_0_1_8
    rest_2_8_8 = rest_1_8_8 - factor_8_2*rest_1_2_8
    rest_4_8_8 = rest_2_8_8 - factor_8_4*rest_2_4_8
    inv_rest_4_8_8 = 1.0/rest_4_8_8
    part_52 = w0*w0
    w_16 = 3.0*part_52
    part_63 = sin_g_x*w_16
    part_63_sin_g_z = part_63*sin_g_z
    w_17 = -J_z
    part_23 = -I_z - w_17
    part_57 = I_y + w_11 - J_y
    w_18 = part_23 + part_57
    w_19 = -J_y - w_17 - w_18
    d_a_zz_by_phi = -cos_theta*sin_phi
    d_part_54_by_phi = d_a_zz_by_phi*w_16
    part_54 = cos_phi_cos_theta*w_16
    d_part_55_by_phi = cos_phi*part_54 + d_part_54_by_phi*sin_phi
    d_a_zx_by_phi = sin_phi*sin_theta
    d_part_58_by_phi = cos_g_z*d_a_zx_by_phi + cos_phi*sin_g_z
    w_20 = -cos_phi_sin_theta
    part_59 = cos_g_z*sin_phi - sin_g_z*w_20
    part_60 = cos_g_x*part_59 + cos_phi_cos_theta*sin_g_x
    d_part_58_by_phi_part_60 = d_part_58_by_phi*part_60
    d_part_59_by_phi = cos_g_z*cos_phi - d_a_zx_by_phi*sin_g_z
    d_part_60_by_phi = cos_g_x*d_part_59_by_phi + d_a_zz_by_phi*sin_g_x
    part_58 = cos_g_z*w_20 + sin_g_z*sin_phi
    d_part_60_by_phi_part_58 = d_part_60_by_phi*part_58
    d_part_61_by_phi = d_part_58_by_phi_part_60 + d_part_60_by_phi_part_58
    d_part_62_by_phi = -d_part_61_by_phi*w_11
    part_64 = cos_g_x*cos_phi_cos_theta - part_59*sin_g_x
    part_64_w_16 = part_64*w_16
    part_60_w_16 = part_60*w_16
    d_part_64_by_phi = cos_g_x*d_a_zz_by_phi - d_part_59_by_phi*sin_g_x
    d_part_65_by_phi = d_part_60_by_phi*part_64_w_16 + d_part_64_by_phi*part_60_w_16
    w_11_w_16 = w_11*w_16
    part_64_w_11_w_16 = part_64*w_11_w_16
    part_60_w_11_w_16 = part_60*w_11_w_16
    slope_phi_right_3 = d_part_60_by_phi*part_64_w_11_w_16 + d_part_64_by_phi*part_60_w_11_w_16
    slope_phi_right_0 = cos_g_z_w_11*d_part_65_by_phi + d_part_55_by_phi*w_19 + d_part_62_by_phi*part_63_sin_g_z - factor_0_3*slope_phi_right_3
    part_16_part_63 = part_16*part_63
    w_21 = I_x + part_23 + w_17
    d_part_66_by_phi = d_a_zx_by_phi*part_54 + d_part_54_by_phi*w_20
    slope_phi_right_1 = d_part_65_by_phi*part_14 + d_part_66_by_phi*w_21 - d_part_61_by_phi*part_16_part_63 - factor_1_0*slope_phi_right_0 - factor_1_3*slope_phi_right_3
    cos_g_x_w_16 = cos_g_x*w_16
    w_22 = -J_x
    w_23 = I_x + w_22
    part_47 = -w_23
    w_24 = part_47 + part_57
    w_25 = w_16*(J_y + w_22 + w_24)
    d_part_67_by_phi = cos_phi*w_20 + d_a_zx_by_phi*sin_phi
    slope_phi_right_2 = cos_g_x_w_16*d_part_62_by_phi + d_part_67_by_phi*w_25 - factor_2_1*slope_phi_right_1 - inv_rest_3_0_0_part_15*slope_phi_right_0
    cos_g_x_w_11_w_16 = cos_g_x*w_11_w_16
    slope_phi_right_4 = -cos_g_x_w_11_w_16*d_part_58_by_phi_part_60 - cos_g_x_w_11_w_16*d_part_60_by_phi_part_58 - factor_2_1*slope_phi_right_1 - factor_4_2*slope_phi_right_2 - inv_rest_3_0_0_part_15*slope_phi_right_0
    slope_phi_right_8 = -factor_8_0*slope_phi_right_0 - factor_8_1*slope_phi_right_1 - factor_8_2*slope_phi_right_2 - factor_8_4*slope_phi_right_4
    slope_phi_8 = inv_rest_4_8_8*slope_phi_right_8
    slope_phi_4 = inv_rest_2_4_4*slope_phi_right_4 - factor_8_4*slope_phi_8
    slope_phi_2 = inv_rest_1_2_2*slope_phi_right_2 - factor_4_2*slope_phi_4 - factor_8_2*slope_phi_8
    slope_phi_1 = inv_rest_0_1_1*slope_phi_right_1 - factor_2_1*slope_phi_2 - factor_2_1*slope_phi_4 - factor_8_1*slope_phi_8
    slope_phi_0 = inv_rest_3_0_0*slope_phi_right_0 - factor_1_0*slope_phi_1 - factor_8_0*slope_phi_8 - inv_rest_3_0_0_part_15*slope_phi_2 - inv_rest_3_0_0_part_15*slope_phi_4
    d_part_54_by_theta = w_16*w_20
    d_part_55_by_theta = d_part_54_by_theta*sin_phi
    d_a_zx_by_theta = -cos_phi_cos_theta
    d_part_58_by_theta = cos_g_z*d_a_zx_by_theta
    w_26 = d_part_58_by_theta*part_60
    d_part_59_by_theta = -d_a_zx_by_theta*sin_g_z
    d_part_60_by_theta = cos_g_x*d_part_59_by_theta + sin_g_x*w_20
    w_27 = d_part_60_by_theta*part_58
    d_part_61_by_theta = w_26 + w_27
    d_part_62_by_theta = -d_part_61_by_theta*w_11
    d_part_64_by_theta = cos_g_x*w_20 - d_part_59_by_theta*sin_g_x
    d_part_65_by_theta = d_part_60_by_theta*part_64_w_16 + d_part_64_by_theta*part_60_w_16
    slope_theta_right_3 = d_part_60_by_theta*part_64_w_11_w_16 + d_part_64_by_theta*part_60_w_11_w_16
    slope_theta_right_0 = cos_g_z_w_11*d_part_65_by_theta + d_part_55_by_theta*w_19 + d_part_62_by_theta*part_63_sin_g_z - factor_0_3*slope_theta_right_3
    d_part_66_by_theta = d_a_zx_by_theta*part_54 + d_part_54_by_theta*w_20
    slope_theta_right_1 = d_part_65_by_theta*part_14 + d_part_66_by_theta*w_21 - d_part_61_by_theta*part_16_part_63 - factor_1_0*slope_theta_right_0 - factor_1_3*slope_theta_right_3
    d_part_67_by_theta = d_a_zx_by_theta*sin_phi
    slope_theta_right_2 = cos_g_x_w_16*d_part_62_by_theta + d_part_67_by_theta*w_25 - factor_2_1*slope_theta_right_1 - inv_rest_3_0_0_part_15*slope_theta_right_0
    slope_theta_right_4 = -cos_g_x_w_11_w_16*w_26 - cos_g_x_w_11_w_16*w_27 - factor_2_1*slope_theta_right_1 - factor_4_2*slope_theta_right_2 - inv_rest_3_0_0_part_15*slope_theta_right_0
    slope_theta_right_8 = -factor_8_0*slope_theta_right_0 - factor_8_1*slope_theta_right_1 - factor_8_2*slope_theta_right_2 - factor_8_4*slope_theta_right_4
    slope_theta_8 = inv_rest_4_8_8*slope_theta_right_8
    slope_theta_4 = inv_rest_2_4_4*slope_theta_right_4 - factor_8_4*slope_theta_8
    slope_theta_2 = inv_rest_1_2_2*slope_theta_right_2 - factor_4_2*slope_theta_4 - factor_8_2*slope_theta_8
    slope_theta_1 = inv_rest_0_1_1*slope_theta_right_1 - factor_2_1*slope_theta_2 - factor_2_1*slope_theta_4 - factor_8_1*slope_theta_8
    slope_theta_0 = inv_rest_3_0_0*slope_theta_right_0 - factor_1_0*slope_theta_1 - factor_8_0*slope_theta_8 - inv_rest_3_0_0_part_15*slope_theta_2 - inv_rest_3_0_0_part_15*slope_theta_4
    part_31 = sin_g_z*w_x
    part_37 = nominal_speed + wheel_speed
    cos_g_z_w_y = cos_g_z*w_y
    part_30 = g_z_dot + w_z
    part_43 = cos_g_x*part_30 + part_31*sin_g_x - cos_g_z_w_y*sin_g_x
    part_30_sin_g_x = part_30*sin_g_x
    part_38 = cos_g_x*cos_g_z_w_y + part_30_sin_g_x - cos_g_x*part_31 - part_37
    part_44 = part_38*part_43
    part_45 = I_wx*part_44 + I_wx*(cos_g_z_w_y*g_z_dot + part_37*part_43 - g_z_dot*part_31) - I_wy*part_44
    part_56 = D_x*g_x_dot + K_x*g_x - T_cx
    acceleration_right_3 = 3.0*part_52*part_60*part_64*w_11 - part_45 - part_56
    twice_zeta_x = 2.0*zeta_x
    J_x_freq_x = J_x*freq_x
    acceleration_right_5 = -J_x_freq_x*(eta_x*freq_x + eta_x_dot*twice_zeta_x)
    part_21 = J_z*(eta_z_dot + w_z)
    part_22 = J_y*(eta_y_dot + w_y)
    part_24 = -I_wx - part_23
    part_25 = w_y*w_z
    part_26 = I_y - I_wy - J_y
    cos_g_z_w_x = cos_g_z*w_x
    part_28 = cos_g_x*g_z_dot
    sin_g_z_w_y = sin_g_z*w_y
    w_28 = cos_g_z_w_y - part_31
    part_32 = g_x_dot*w_28
    part_33 = cos_g_x*g_x_dot*part_30 - cos_g_z_w_x*part_28 - part_28*sin_g_z_w_y - part_32*sin_g_x
    part_34 = I_wy*part_33
    part_35 = cos_g_x*part_34
    w_29 = cos_g_z_w_x + sin_g_z_w_y
    part_36 = g_x_dot + w_29
    part_39 = part_36*part_38
    part_40 = I_wx*(cos_g_z*g_z_dot*sin_g_x*w_x + g_z_dot*sin_g_x*sin_g_z*w_y - cos_g_x*part_32 - g_x_dot*part_30_sin_g_x - part_36*part_37) + I_wy*part_39 - I_wx*part_39
    part_41 = part_40*sin_g_x
    part_55 = part_54*sin_phi
    part_58_part_60 = part_58*part_60
    part_62 = -part_58_part_60*w_11
    part_65 = part_60*part_64_w_16
    acceleration_right_0 = J_z*part_55 + cos_g_z*part_65*w_11 + part_22*w_z + part_25*part_26 + part_35*sin_g_z + part_62*part_63*sin_g_z - J_y*part_55 - acceleration_right_3*factor_0_3 - acceleration_right_5 - cos_g_z*part_45 - part_21*w_y - part_24*part_25 - part_41*sin_g_z - part_55*w_18
    twice_zeta_y = 2.0*zeta_y
    J_y_freq_y = J_y*freq_y
    acceleration_right_6 = -J_y_freq_y*(eta_y*freq_y + eta_y_dot*twice_zeta_y)
    part_46 = J_x*(eta_x_dot + w_x)
    part_48 = -I_wx - part_47
    part_49 = w_x*w_z
    part_66 = part_54*w_20
    acceleration_right_1 = J_x*part_66 + cos_g_z*part_41 + part_14*part_65 + part_21*w_x + part_24*part_49 + part_66*(part_23 + w_23) - J_z*part_66 - acceleration_right_0*factor_1_0 - acceleration_right_3*factor_1_3 - acceleration_right_6 - cos_g_z*part_35 - part_16_part_63*part_58_part_60 - part_45*sin_g_z - part_46*w_z - part_48*part_49
    twice_zeta_z = 2.0*zeta_z
    J_z_freq_z = J_z*freq_z
    acceleration_right_7 = -J_z_freq_z*(eta_z*freq_z + eta_z_dot*twice_zeta_z)
    part_50 = w_x*w_y
    part_51 = cos_g_x*part_40 + part_20*part_33
    part_67 = sin_phi*w_20
    acceleration_right_2 = part_46*w_y + part_48*part_50 + w_16*(J_y*part_67 + cos_g_x*part_62 + part_67*w_24 - J_x*part_67) - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_7 - part_22*w_x - part_26*part_50 - part_51
    acceleration_right_4 = T_cz - D_z*g_z_dot - K_z*g_z - acceleration_right_0*inv_rest_3_0_0_part_15 - acceleration_right_1*factor_2_1 - acceleration_right_2*factor_4_2 - cos_g_x_w_11_w_16*part_58_part_60 - part_51
    acceleration_right_8 = motor_torque + part_34 - acceleration_right_0*factor_8_0 - acceleration_right_1*factor_8_1 - acceleration_right_2*factor_8_2 - acceleration_right_4*factor_8_4
    acceleration_8 = acceleration_right_8*inv_rest_4_8_8
    acceleration_4 = acceleration_right_4*inv_rest_2_4_4 - acceleration_8*factor_8_4
    acceleration_2 = acceleration_right_2*inv_rest_1_2_2 - acceleration_4*factor_4_2 - acceleration_8*factor_8_2
    acceleration_1 = acceleration_right_1*inv_rest_0_1_1 - acceleration_2*factor_2_1 - acceleration_4*factor_2_1 - acceleration_8*factor_8_1
    acceleration_0 = acceleration_right_0*inv_rest_3_0_0 - acceleration_1*factor_1_0 - acceleration_2*inv_rest_3_0_0_part_15 - acceleration_4*inv_rest_3_0_0_part_15 - acceleration_8*factor_8_0
    d_part_9_by_g_x = -sin_g_x
    d_part_19_by_g_x = I_wy*d_part_9_by_g_x
    d_mass_9_1_by_g_x = d_part_19_by_g_x*sin_g_z
    d_mass_9_2_by_g_x = -cos_g_z*d_part_19_by_g_x
    w_30 = -part_19
    g_x_dot_part_30 = g_x_dot*part_30
    w_31 = -w_29
    d_part_28_by_g_x = d_part_9_by_g_x*g_z_dot
    d_part_33_by_g_x = d_part_28_by_g_x*w_31 + d_part_9_by_g_x*g_x_dot_part_30 - cos_g_x*part_32
    d_part_34_by_g_x = I_wy*d_part_33_by_g_x
    d_part_10_by_g_x = 2.0*cos_g_x*d_part_9_by_g_x
    d_part_11_by_g_x = I_wy*d_part_10_by_g_x
    d_part_7_by_g_x = 2.0*cos_g_x*sin_g_x
    d_part_8_by_g_x = I_wx*d_part_7_by_g_x
    d_mass_1_1_by_g_x = d_part_11_by_g_x*part_5 + d_part_8_by_g_x*part_5
    d_mass_2_1_by_g_x = -cos_g_z_sin_g_z*d_part_11_by_g_x - cos_g_z_sin_g_z*d_part_8_by_g_x
    d_part_12_by_g_x = cos_g_x*cos_g_x + d_part_9_by_g_x*sin_g_x
    d_part_15_by_g_x = d_part_12_by_g_x*part_14
    d_part_35_by_g_x = cos_g_x*d_part_34_by_g_x + d_part_9_by_g_x*part_34
    w_32 = -w_11
    d_part_38_by_g_x = cos_g_x*part_30 + d_part_9_by_g_x*w_28
    d_part_39_by_g_x = d_part_38_by_g_x*part_36
    d_part_40_by_g_x = I_wx*cos_g_x*(cos_g_z_w_x*g_z_dot + g_z_dot*sin_g_z_w_y - g_x_dot_part_30) + d_part_39_by_g_x*w_32 - I_wx*d_part_9_by_g_x*part_32
    d_part_41_by_g_x = cos_g_x*part_40 + d_part_40_by_g_x*sin_g_x
    I_wx_part_37 = I_wx*part_37
    w_33 = part_31 - cos_g_z_w_y
    d_part_43_by_g_x = cos_g_x*w_33 + d_part_9_by_g_x*part_30
    d_part_44_by_g_x = d_part_38_by_g_x*part_43 + d_part_43_by_g_x*part_38
    d_part_45_by_g_x = I_wx_part_37*d_part_43_by_g_x + d_part_44_by_g_x*w_11
    d_part_60_by_g_x = cos_g_x*cos_phi_cos_theta + d_part_9_by_g_x*part_59
    d_part_60_by_g_x_part_58 = d_part_60_by_g_x*part_58
    d_part_62_by_g_x = -d_part_60_by_g_x_part_58*w_11
    d_part_64_by_g_x = cos_phi_cos_theta*d_part_9_by_g_x - cos_g_x*part_59
    d_part_65_by_g_x = d_part_60_by_g_x*part_64_w_16 + d_part_64_by_g_x*part_60_w_16
    slope_g_x_right_3 = 3.0*d_part_60_by_g_x*part_52*part_64*w_11 + 3.0*d_part_64_by_g_x*part_52*part_60*w_11 - K_x - d_part_45_by_g_x
    slope_g_x_right_0 = cos_g_x_w_16*part_62*sin_g_z + cos_g_z*d_part_65_by_g_x*w_11 + d_part_35_by_g_x*sin_g_z + d_part_62_by_g_x*part_63*sin_g_z - acceleration_0*d_mass_1_1_by_g_x - acceleration_1*d_mass_2_1_by_g_x - acceleration_2*d_part_15_by_g_x - acceleration_4*d_part_15_by_g_x - acceleration_8*d_mass_9_1_by_g_x - cos_g_z*d_part_45_by_g_x - d_part_41_by_g_x*sin_g_z - factor_0_3*slope_g_x_right_3
    d_mass_2_2_by_g_x = d_part_11_by_g_x*part_2 + d_part_7_by_g_x*part_3
    d_part_17_by_g_x = d_part_12_by_g_x*part_16
    slope_g_x_right_1 = cos_g_z*d_part_41_by_g_x + d_part_65_by_g_x*part_14 - acceleration_0*d_mass_2_1_by_g_x - acceleration_1*d_mass_2_2_by_g_x - acceleration_2*d_part_17_by_g_x - acceleration_4*d_part_17_by_g_x - acceleration_8*d_mass_9_2_by_g_x - cos_g_x_w_16*part_16*part_58_part_60 - cos_g_z*d_part_35_by_g_x - d_part_45_by_g_x*sin_g_z - d_part_60_by_g_x_part_58*part_16_part_63 - factor_1_0*slope_g_x_right_0 - factor_1_3*slope_g_x_right_3
    d_part_18_by_g_x = I_wx*d_part_10_by_g_x + I_wy*d_part_7_by_g_x
    d_part_51_by_g_x = cos_g_x*d_part_40_by_g_x + d_part_33_by_g_x*part_20 + d_part_9_by_g_x*part_40 + part_19*part_33
    w_34 = acceleration_0*d_part_15_by_g_x + acceleration_1*d_part_17_by_g_x + acceleration_2*d_part_18_by_g_x + acceleration_4*d_part_18_by_g_x + d_part_51_by_g_x
    slope_g_x_right_2 = cos_g_x*d_part_62_by_g_x*w_16 + d_part_9_by_g_x*part_62*w_16 - acceleration_8*w_30 - factor_2_1*slope_g_x_right_1 - inv_rest_3_0_0_part_15*slope_g_x_right_0 - w_34
    slope_g_x_right_4 = -acceleration_8*w_30 - cos_g_x_w_11_w_16*d_part_60_by_g_x_part_58 - d_part_9_by_g_x*part_58_part_60*w_11_w_16 - factor_2_1*slope_g_x_right_1 - factor_4_2*slope_g_x_right_2 - inv_rest_3_0_0_part_15*slope_g_x_right_0 - w_34
    slope_g_x_right_8 = d_part_34_by_g_x - acceleration_0*d_mass_9_1_by_g_x - acceleration_1*d_mass_9_2_by_g_x - acceleration_2*w_30 - acceleration_4*w_30 - factor_8_0*slope_g_x_right_0 - factor_8_1*slope_g_x_right_1 - factor_8_2*slope_g_x_right_2 - factor_8_4*slope_g_x_right_4
    slope_g_x_8 = inv_rest_4_8_8*slope_g_x_right_8
    slope_g_x_4 = inv_rest_2_4_4*slope_g_x_right_4 - factor_8_4*slope_g_x_8
    slope_g_x_2 = inv_rest_1_2_2*slope_g_x_right_2 - factor_4_2*slope_g_x_4 - factor_8_2*slope_g_x_8
    slope_g_x_1 = inv_rest_0_1_1*slope_g_x_right_1 - factor_2_1*slope_g_x_2 - factor_2_1*slope_g_x_4 - factor_8_1*slope_g_x_8
    slope_g_x_0 = inv_rest_3_0_0*slope_g_x_right_0 - factor_1_0*slope_g_x_1 - factor_8_0*slope_g_x_8 - inv_rest_3_0_0_part_15*slope_g_x_2 - inv_rest_3_0_0_part_15*slope_g_x_4
    d_mass_9_1_by_g_z = cos_g_z*part_19
    d_part_1_by_g_z = -sin_g_z
    d_mass_9_2_by_g_z = -d_part_1_by_g_z*part_19
    d_part_1_by_g_z_w_x = d_part_1_by_g_z*w_x
    d_part_1_by_g_z_w_y = d_part_1_by_g_z*w_y
    d_part_32_by_g_z = d_part_1_by_g_z_w_y*g_x_dot - cos_g_z_w_x*g_x_dot
    d_part_33_by_g_z = -cos_g_z_w_y*part_28 - d_part_1_by_g_z_w_x*part_28 - d_part_32_by_g_z*sin_g_x
    d_part_34_by_g_z = I_wy*d_part_33_by_g_z
    w_35 = part_35 - part_41
    acceleration_3 = acceleration_right_3*inv_I_wx - acceleration_0*factor_0_3 - acceleration_1*factor_1_3
    d_part_2_by_g_z = 2.0*cos_g_z*d_part_1_by_g_z
    d_part_3_by_g_z = I_wx*d_part_2_by_g_z
    d_part_5_by_g_z = 2.0*cos_g_z*sin_g_z
    d_mass_1_1_by_g_z = d_part_3_by_g_z + d_part_5_by_g_z*w_8
    d_mass_2_1_by_g_z = cos_g_z*cos_g_z*w_9 + d_part_1_by_g_z*sin_g_z*w_9
    d_mass_4_1_by_g_z = I_wx*d_part_1_by_g_z
    d_part_15_by_g_z = cos_g_z_w_11*part_12
    d_part_35_by_g_z = cos_g_x*d_part_34_by_g_z
    I_wx_cos_g_x = I_wx*cos_g_x
    I_wx_g_z_dot = I_wx*g_z_dot
    I_wx_g_z_dot_sin_g_x = I_wx_g_z_dot*sin_g_x
    d_part_36_by_g_z = cos_g_z_w_y + d_part_1_by_g_z_w_x
    d_part_38_by_g_z = cos_g_x*d_part_1_by_g_z_w_y - cos_g_x*cos_g_z_w_x
    d_part_39_by_g_z = d_part_36_by_g_z*part_38 + d_part_38_by_g_z*part_36
    d_part_40_by_g_z = I_wx_g_z_dot_sin_g_x*cos_g_z_w_y + I_wx_g_z_dot_sin_g_x*d_part_1_by_g_z_w_x + d_part_39_by_g_z*w_32 - I_wx_cos_g_x*d_part_32_by_g_z - I_wx_part_37*d_part_36_by_g_z
    d_part_41_by_g_z = d_part_40_by_g_z*sin_g_x
    d_part_43_by_g_z = cos_g_z_w_x*sin_g_x - d_part_1_by_g_z_w_y*sin_g_x
    d_part_44_by_g_z = d_part_38_by_g_z*part_43 + d_part_43_by_g_z*part_38
    d_part_45_by_g_z = I_wx_g_z_dot*d_part_1_by_g_z_w_y + I_wx_part_37*d_part_43_by_g_z + d_part_44_by_g_z*w_11 - I_wx_g_z_dot*cos_g_z_w_x
    d_part_58_by_g_z = cos_g_z*sin_phi + d_part_1_by_g_z*w_20
    d_part_58_by_g_z_part_60 = d_part_58_by_g_z*part_60
    d_part_59_by_g_z = d_part_1_by_g_z*sin_phi - cos_g_z*w_20
    d_part_60_by_g_z = cos_g_x*d_part_59_by_g_z
    d_part_60_by_g_z_part_58 = d_part_60_by_g_z*part_58
    d_part_61_by_g_z = d_part_58_by_g_z_part_60 + d_part_60_by_g_z_part_58
    d_part_62_by_g_z = -d_part_61_by_g_z*w_11
    d_part_64_by_g_z = -d_part_59_by_g_z*sin_g_x
    d_part_65_by_g_z = d_part_60_by_g_z*part_64_w_16 + d_part_64_by_g_z*part_60_w_16
    slope_g_z_right_3 = 3.0*d_part_60_by_g_z*part_52*part_64*w_11 + 3.0*d_part_64_by_g_z*part_52*part_60*w_11 - I_wx_cos_g_z*acceleration_1 - acceleration_0*d_mass_4_1_by_g_z - d_part_45_by_g_z
    slope_g_z_right_0 = cos_g_z*d_part_65_by_g_z*w_11 + cos_g_z*(part_62*part_63 + w_35) + d_part_1_by_g_z*(part_65*w_11 - part_45) + d_part_35_by_g_z*sin_g_z + d_part_62_by_g_z*part_63*sin_g_z - acceleration_0*d_mass_1_1_by_g_z - acceleration_1*d_mass_2_1_by_g_z - acceleration_2*d_part_15_by_g_z - acceleration_3*d_mass_4_1_by_g_z - acceleration_4*d_part_15_by_g_z - acceleration_8*d_mass_9_1_by_g_z - cos_g_z*d_part_45_by_g_z - d_part_41_by_g_z*sin_g_z - factor_0_3*slope_g_z_right_3
    d_mass_2_2_by_g_z = I_wx*d_part_5_by_g_z + d_part_2_by_g_z*part_11 + d_part_3_by_g_z*part_7
    d_part_16_by_g_z = -d_part_1_by_g_z*w_11
    d_part_17_by_g_z = d_part_16_by_g_z*part_12
    slope_g_z_right_1 = cos_g_z*d_part_41_by_g_z + cos_g_z_w_11*part_65 + d_part_65_by_g_z*part_14 - I_wx_cos_g_z*acceleration_3 - acceleration_0*d_mass_2_1_by_g_z - acceleration_1*d_mass_2_2_by_g_z - acceleration_2*d_part_17_by_g_z - acceleration_4*d_part_17_by_g_z - acceleration_8*d_mass_9_2_by_g_z - cos_g_z*d_part_35_by_g_z - cos_g_z*part_45 - d_part_16_by_g_z*part_58_part_60*part_63 - d_part_1_by_g_z*w_35 - d_part_45_by_g_z*sin_g_z - d_part_61_by_g_z*part_16_part_63 - factor_1_0*slope_g_z_right_0 - factor_1_3*slope_g_z_right_3
    d_part_51_by_g_z = cos_g_x*d_part_40_by_g_z + d_part_33_by_g_z*part_20
    w_36 = acceleration_0*d_part_15_by_g_z + acceleration_1*d_part_17_by_g_z + d_part_51_by_g_z
    slope_g_z_right_2 = cos_g_x*d_part_62_by_g_z*w_16 - factor_2_1*slope_g_z_right_1 - inv_rest_3_0_0_part_15*slope_g_z_right_0 - w_36
    slope_g_z_right_4 = -K_z - cos_g_x_w_11_w_16*d_part_58_by_g_z_part_60 - cos_g_x_w_11_w_16*d_part_60_by_g_z_part_58 - factor_2_1*slope_g_z_right_1 - factor_4_2*slope_g_z_right_2 - inv_rest_3_0_0_part_15*slope_g_z_right_0 - w_36
    slope_g_z_right_8 = d_part_34_by_g_z - acceleration_0*d_mass_9_1_by_g_z - acceleration_1*d_mass_9_2_by_g_z - factor_8_0*slope_g_z_right_0 - factor_8_1*slope_g_z_right_1 - factor_8_2*slope_g_z_right_2 - factor_8_4*slope_g_z_right_4
    slope_g_z_8 = inv_rest_4_8_8*slope_g_z_right_8
    slope_g_z_4 = inv_rest_2_4_4*slope_g_z_right_4 - factor_8_4*slope_g_z_8
    slope_g_z_2 = inv_rest_1_2_2*slope_g_z_right_2 - factor_4_2*slope_g_z_4 - factor_8_2*slope_g_z_8
    slope_g_z_1 = inv_rest_0_1_1*slope_g_z_right_1 - factor_2_1*slope_g_z_2 - factor_2_1*slope_g_z_4 - factor_8_1*slope_g_z_8
    slope_g_z_0 = inv_rest_3_0_0*slope_g_z_right_0 - factor_1_0*slope_g_z_1 - factor_8_0*slope_g_z_8 - inv_rest_3_0_0_part_15*slope_g_z_2 - inv_rest_3_0_0_part_15*slope_g_z_4
    slope_eta_x_right_5 = -J_x*freq_x*freq_x
    slope_eta_x_right_0 = -slope_eta_x_right_5
    slope_eta_x_right_1 = -factor_1_0*slope_eta_x_right_0
    slope_eta_x_right_2 = -factor_2_1*slope_eta_x_right_1 - inv_rest_3_0_0_part_15*slope_eta_x_right_0
    slope_eta_x_right_4 = -factor_2_1*slope_eta_x_right_1 - factor_4_2*slope_eta_x_right_2 - inv_rest_3_0_0_part_15*slope_eta_x_right_0
    slope_eta_x_right_8 = -factor_8_0*slope_eta_x_right_0 - factor_8_1*slope_eta_x_right_1 - factor_8_2*slope_eta_x_right_2 - factor_8_4*slope_eta_x_right_4
    slope_eta_x_8 = inv_rest_4_8_8*slope_eta_x_right_8
    slope_eta_x_4 = inv_rest_2_4_4*slope_eta_x_right_4 - factor_8_4*slope_eta_x_8
    slope_eta_x_2 = inv_rest_1_2_2*slope_eta_x_right_2 - factor_4_2*slope_eta_x_4 - factor_8_2*slope_eta_x_8
    slope_eta_x_1 = inv_rest_0_1_1*slope_eta_x_right_1 - factor_2_1*slope_eta_x_2 - factor_2_1*slope_eta_x_4 - factor_8_1*slope_eta_x_8
    slope_eta_x_0 = inv_rest_3_0_0*slope_eta_x_right_0 - factor_1_0*slope_eta_x_1 - factor_8_0*slope_eta_x_8 - inv_rest_3_0_0_part_15*slope_eta_x_2 - inv_rest_3_0_0_part_15*slope_eta_x_4
    slope_eta_y_right_6 = -J_y*freq_y*freq_y
    slope_eta_y_right_1 = -slope_eta_y_right_6
    slope_eta_y_right_2 = -factor_2_1*slope_eta_y_right_1
    slope_eta_y_right_4 = -factor_2_1*slope_eta_y_right_1 - factor_4_2*slope_eta_y_right_2
    slope_eta_y_right_8 = -factor_8_1*slope_eta_y_right_1 - factor_8_2*slope_eta_y_right_2 - factor_8_4*slope_eta_y_right_4
    slope_eta_y_8 = inv_rest_4_8_8*slope_eta_y_right_8
    slope_eta_y_4 = inv_rest_2_4_4*slope_eta_y_right_4 - factor_8_4*slope_eta_y_8
    slope_eta_y_2 = inv_rest_1_2_2*slope_eta_y_right_2 - factor_4_2*slope_eta_y_4 - factor_8_2*slope_eta_y_8
    slope_eta_y_1 = inv_rest_0_1_1*slope_eta_y_right_1 - factor_2_1*slope_eta_y_2 - factor_2_1*slope_eta_y_4 - factor_8_1*slope_eta_y_8
    slope_eta_y_0 = -factor_1_0*slope_eta_y_1 - factor_8_0*slope_eta_y_8 - inv_rest_3_0_0_part_15*slope_eta_y_2 - inv_rest_3_0_0_part_15*slope_eta_y_4
    slope_eta_z_right_7 = -J_z*freq_z*freq_z
    slope_eta_z_right_2 = -slope_eta_z_right_7
    slope_eta_z_right_4 = -factor_4_2*slope_eta_z_right_2
    slope_eta_z_right_8 = -factor_8_2*slope_eta_z_right_2 - factor_8_4*slope_eta_z_right_4
    slope_eta_z_8 = inv_rest_4_8_8*slope_eta_z_right_8
    slope_eta_z_4 = inv_rest_2_4_4*slope_eta_z_right_4 - factor_8_4*slope_eta_z_8
    slope_eta_z_2 = inv_rest_1_2_2*slope_eta_z_right_2 - factor_4_2*slope_eta_z_4 - factor_8_2*slope_eta_z_8
    slope_eta_z_1 = -factor_2_1*slope_eta_z_2 - factor_2_1*slope_eta_z_4 - factor_8_1*slope_eta_z_8
    slope_eta_z_0 = -factor_1_0*slope_eta_z_1 - factor_8_0*slope_eta_z_8 - inv_rest_3_0_0_part_15*slope_eta_z_2 - inv_rest_3_0_0_part_15*slope_eta_z_4
    d_part_32_by_w_x = -g_x_dot*sin_g_z
    d_part_33_by_w_x = -cos_g_z*part_28 - d_part_32_by_w_x*sin_g_x
    d_part_34_by_w_x = I_wy*d_part_33_by_w_x
    d_part_35_by_w_x = cos_g_x*d_part_34_by_w_x
    d_part_38_by_w_x = -cos_g_x*sin_g_z
    d_part_39_by_w_x = cos_g_z*part_38 + d_part_38_by_w_x*part_36
    d_part_40_by_w_x = I_wx*cos_g_z*g_z_dot*sin_g_x + d_part_39_by_w_x*w_32 - I_wx_cos_g_x*d_part_32_by_w_x - I_wx_cos_g_z*part_37
    d_part_41_by_w_x = d_part_40_by_w_x*sin_g_x
    d_part_43_by_w_x = sin_g_x*sin_g_z
    d_part_44_by_w_x = d_part_38_by_w_x*part_43 + d_part_43_by_w_x*part_38
    d_part_45_by_w_x = I_wx_part_37*d_part_43_by_w_x + d_part_44_by_w_x*w_11 - I_wx_sin_g_z*g_z_dot
    slope_w_x_right_3 = -d_part_45_by_w_x
    slope_w_x_right_0 = d_part_35_by_w_x*sin_g_z - cos_g_z*d_part_45_by_w_x - d_part_41_by_w_x*sin_g_z - factor_0_3*slope_w_x_right_3
    J_x_w_z = J_x*w_z
    w_37 = -part_48
    w_38 = part_24 + w_37
    slope_w_x_right_1 = cos_g_z*d_part_41_by_w_x + part_21 + w_38*w_z - J_x_w_z - cos_g_z*d_part_35_by_w_x - d_part_45_by_w_x*sin_g_z - factor_1_0*slope_w_x_right_0 - factor_1_3*slope_w_x_right_3
    w_39 = -J_x*w_y
    w_40 = -part_26 - w_37
    d_part_51_by_w_x = cos_g_x*d_part_40_by_w_x + d_part_33_by_w_x*part_20
    slope_w_x_right_2 = w_40*w_y - d_part_51_by_w_x - factor_2_1*slope_w_x_right_1 - inv_rest_3_0_0_part_15*slope_w_x_right_0 - part_22 - w_39
    slope_w_x_right_4 = -d_part_51_by_w_x - factor_2_1*slope_w_x_right_1 - factor_4_2*slope_w_x_right_2 - inv_rest_3_0_0_part_15*slope_w_x_right_0
    slope_w_x_right_8 = d_part_34_by_w_x - factor_8_0*slope_w_x_right_0 - factor_8_1*slope_w_x_right_1 - factor_8_2*slope_w_x_right_2 - factor_8_4*slope_w_x_right_4
    slope_w_x_8 = inv_rest_4_8_8*slope_w_x_right_8
    slope_w_x_4 = inv_rest_2_4_4*slope_w_x_right_4 - factor_8_4*slope_w_x_8
    slope_w_x_2 = inv_rest_1_2_2*slope_w_x_right_2 - factor_4_2*slope_w_x_4 - factor_8_2*slope_w_x_8
    slope_w_x_1 = inv_rest_0_1_1*slope_w_x_right_1 - factor_2_1*slope_w_x_2 - factor_2_1*slope_w_x_4 - factor_8_1*slope_w_x_8
    slope_w_x_0 = inv_rest_3_0_0*slope_w_x_right_0 - factor_1_0*slope_w_x_1 - factor_8_0*slope_w_x_8 - inv_rest_3_0_0_part_15*slope_w_x_2 - inv_rest_3_0_0_part_15*slope_w_x_4
    d_part_32_by_w_y = cos_g_z*g_x_dot
    d_part_33_by_w_y = -d_part_32_by_w_y*sin_g_x - part_28*sin_g_z
    d_part_34_by_w_y = I_wy*d_part_33_by_w_y
    w_41 = part_26 - part_24
    d_part_35_by_w_y = cos_g_x*d_part_34_by_w_y
    d_part_38_by_w_y = cos_g_x*cos_g_z
    d_part_39_by_w_y = d_part_38_by_w_y*part_36 + part_38*sin_g_z
    d_part_40_by_w_y = I_wx*g_z_dot*sin_g_x*sin_g_z + d_part_39_by_w_y*w_32 - I_wx_cos_g_x*d_part_32_by_w_y - I_wx_sin_g_z*part_37
    d_part_41_by_w_y = d_part_40_by_w_y*sin_g_x
    d_part_43_by_w_y = -cos_g_z*sin_g_x
    d_part_44_by_w_y = d_part_38_by_w_y*part_43 + d_part_43_by_w_y*part_38
    d_part_45_by_w_y = I_wx_cos_g_z*g_z_dot + I_wx_part_37*d_part_43_by_w_y + d_part_44_by_w_y*w_11
    slope_w_y_right_3 = -d_part_45_by_w_y
    slope_w_y_right_0 = J_y*w_z + d_part_35_by_w_y*sin_g_z + w_41*w_z - cos_g_z*d_part_45_by_w_y - d_part_41_by_w_y*sin_g_z - factor_0_3*slope_w_y_right_3 - part_21
    slope_w_y_right_1 = cos_g_z*d_part_41_by_w_y - cos_g_z*d_part_35_by_w_y - d_part_45_by_w_y*sin_g_z - factor_1_0*slope_w_y_right_0 - factor_1_3*slope_w_y_right_3
    J_y_w_x = J_y*w_x
    d_part_51_by_w_y = cos_g_x*d_part_40_by_w_y + d_part_33_by_w_y*part_20
    slope_w_y_right_2 = part_46 + w_40*w_x - J_y_w_x - d_part_51_by_w_y - factor_2_1*slope_w_y_right_1 - inv_rest_3_0_0_part_15*slope_w_y_right_0
    slope_w_y_right_4 = -d_part_51_by_w_y - factor_2_1*slope_w_y_right_1 - factor_4_2*slope_w_y_right_2 - inv_rest_3_0_0_part_15*slope_w_y_right_0
    slope_w_y_right_8 = d_part_34_by_w_y - factor_8_0*slope_w_y_right_0 - factor_8_1*slope_w_y_right_1 - factor_8_2*slope_w_y_right_2 - factor_8_4*slope_w_y_right_4
    slope_w_y_8 = inv_rest_4_8_8*slope_w_y_right_8
    slope_w_y_4 = inv_rest_2_4_4*slope_w_y_right_4 - factor_8_4*slope_w_y_8
    slope_w_y_2 = inv_rest_1_2_2*slope_w_y_right_2 - factor_4_2*slope_w_y_4 - factor_8_2*slope_w_y_8
    slope_w_y_1 = inv_rest_0_1_1*slope_w_y_right_1 - factor_2_1*slope_w_y_2 - factor_2_1*slope_w_y_4 - factor_8_1*slope_w_y_8
    slope_w_y_0 = inv_rest_3_0_0*slope_w_y_right_0 - factor_1_0*slope_w_y_1 - factor_8_0*slope_w_y_8 - inv_rest_3_0_0_part_15*slope_w_y_2 - inv_rest_3_0_0_part_15*slope_w_y_4
    cos_g_x_g_x_dot = cos_g_x*g_x_dot
    d_part_34_by_w_z = I_wy*cos_g_x_g_x_dot
    J_z_w_y = J_z*w_y
    d_part_35_by_w_z = cos_g_x*d_part_34_by_w_z
    I_wx_g_x_dot_sin_g_x = I_wx*g_x_dot*sin_g_x
    part_36_sin_g_x = part_36*sin_g_x
    d_part_40_by_w_z = part_36_sin_g_x*w_32 - I_wx_g_x_dot_sin_g_x
    d_part_41_by_w_z = d_part_40_by_w_z*sin_g_x
    I_wx_part_37_cos_g_x = I_wx_part_37*cos_g_x
    w_42 = cos_g_x*part_38 + part_43*sin_g_x
    d_part_45_by_w_z = I_wx_part_37_cos_g_x + w_11*w_42
    slope_w_z_right_3 = -d_part_45_by_w_z
    slope_w_z_right_0 = d_part_35_by_w_z*sin_g_z + part_22 + w_41*w_y - J_z_w_y - cos_g_z*d_part_45_by_w_z - d_part_41_by_w_z*sin_g_z - factor_0_3*slope_w_z_right_3
    slope_w_z_right_1 = J_z*w_x + cos_g_z*d_part_41_by_w_z + w_38*w_x - cos_g_z*d_part_35_by_w_z - d_part_45_by_w_z*sin_g_z - factor_1_0*slope_w_z_right_0 - factor_1_3*slope_w_z_right_3 - part_46
    d_part_51_by_w_z = cos_g_x*d_part_40_by_w_z + cos_g_x_g_x_dot*part_20
    slope_w_z_right_2 = -d_part_51_by_w_z - factor_2_1*slope_w_z_right_1 - inv_rest_3_0_0_part_15*slope_w_z_right_0
    slope_w_z_right_4 = -d_part_51_by_w_z - factor_2_1*slope_w_z_right_1 - factor_4_2*slope_w_z_right_2 - inv_rest_3_0_0_part_15*slope_w_z_right_0
    slope_w_z_right_8 = d_part_34_by_w_z - factor_8_0*slope_w_z_right_0 - factor_8_1*slope_w_z_right_1 - factor_8_2*slope_w_z_right_2 - factor_8_4*slope_w_z_right_4
    slope_w_z_8 = inv_rest_4_8_8*slope_w_z_right_8
    slope_w_z_4 = inv_rest_2_4_4*slope_w_z_right_4 - factor_8_4*slope_w_z_8
    slope_w_z_2 = inv_rest_1_2_2*slope_w_z_right_2 - factor_4_2*slope_w_z_4 - factor_8_2*slope_w_z_8
    slope_w_z_1 = inv_rest_0_1_1*slope_w_z_right_1 - factor_2_1*slope_w_z_2 - factor_2_1*slope_w_z_4 - factor_8_1*slope_w_z_8
    slope_w_z_0 = inv_rest_3_0_0*slope_w_z_right_0 - factor_1_0*slope_w_z_1 - factor_8_0*slope_w_z_8 - inv_rest_3_0_0_part_15*slope_w_z_2 - inv_rest_3_0_0_part_15*slope_w_z_4
    d_part_33_by_g_x_dot = cos_g_x*part_30 - sin_g_x*w_28
    d_part_34_by_g_x_dot = I_wy*d_part_33_by_g_x_dot
    d_part_35_by_g_x_dot = cos_g_x*d_part_34_by_g_x_dot
    d_part_40_by_g_x_dot = part_38*w_32 - I_wx*part_30_sin_g_x - I_wx_cos_g_x*w_28 - I_wx_part_37
    d_part_41_by_g_x_dot = d_part_40_by_g_x_dot*sin_g_x
    slope_g_x_dot_right_3 = -D_x
    slope_g_x_dot_right_0 = d_part_35_by_g_x_dot*sin_g_z - d_part_41_by_g_x_dot*sin_g_z - factor_0_3*slope_g_x_dot_right_3
    slope_g_x_dot_right_1 = cos_g_z*d_part_41_by_g_x_dot - cos_g_z*d_part_35_by_g_x_dot - factor_1_0*slope_g_x_dot_right_0 - factor_1_3*slope_g_x_dot_right_3
    d_part_51_by_g_x_dot = cos_g_x*d_part_40_by_g_x_dot + d_part_33_by_g_x_dot*part_20
    slope_g_x_dot_right_2 = -d_part_51_by_g_x_dot - factor_2_1*slope_g_x_dot_right_1 - inv_rest_3_0_0_part_15*slope_g_x_dot_right_0
    slope_g_x_dot_right_4 = -d_part_51_by_g_x_dot - factor_2_1*slope_g_x_dot_right_1 - factor_4_2*slope_g_x_dot_right_2 - inv_rest_3_0_0_part_15*slope_g_x_dot_right_0
    slope_g_x_dot_right_8 = d_part_34_by_g_x_dot - factor_8_0*slope_g_x_dot_right_0 - factor_8_1*slope_g_x_dot_right_1 - factor_8_2*slope_g_x_dot_right_2 - factor_8_4*slope_g_x_dot_right_4
    slope_g_x_dot_8 = inv_rest_4_8_8*slope_g_x_dot_right_8
    slope_g_x_dot_4 = inv_rest_2_4_4*slope_g_x_dot_right_4 - factor_8_4*slope_g_x_dot_8
    slope_g_x_dot_2 = inv_rest_1_2_2*slope_g_x_dot_right_2 - factor_4_2*slope_g_x_dot_4 - factor_8_2*slope_g_x_dot_8
    slope_g_x_dot_1 = inv_rest_0_1_1*slope_g_x_dot_right_1 - factor_2_1*slope_g_x_dot_2 - factor_2_1*slope_g_x_dot_4 - factor_8_1*slope_g_x_dot_8
    slope_g_x_dot_0 = inv_rest_3_0_0*slope_g_x_dot_right_0 - factor_1_0*slope_g_x_dot_1 - factor_8_0*slope_g_x_dot_8 - inv_rest_3_0_0_part_15*slope_g_x_dot_2 - inv_rest_3_0_0_part_15*slope_g_x_dot_4
    d_part_33_by_g_z_dot = cos_g_x*w_31 + cos_g_x_g_x_dot
    d_part_34_by_g_z_dot = I_wy*d_part_33_by_g_z_dot
    d_part_35_by_g_z_dot = cos_g_x*d_part_34_by_g_z_dot
    d_part_40_by_g_z_dot = I_wx*(cos_g_z_w_x*sin_g_x + sin_g_x*sin_g_z_w_y) + part_36_sin_g_x*w_32 - I_wx_g_x_dot_sin_g_x
    d_part_41_by_g_z_dot = d_part_40_by_g_z_dot*sin_g_x
    d_part_45_by_g_z_dot = I_wx_part_37_cos_g_x + w_11*w_42 - I_wx*w_33
    slope_g_z_dot_right_3 = -d_part_45_by_g_z_dot
    slope_g_z_dot_right_0 = d_part_35_by_g_z_dot*sin_g_z - cos_g_z*d_part_45_by_g_z_dot - d_part_41_by_g_z_dot*sin_g_z - factor_0_3*slope_g_z_dot_right_3
    slope_g_z_dot_right_1 = cos_g_z*d_part_41_by_g_z_dot - cos_g_z*d_part_35_by_g_z_dot - d_part_45_by_g_z_dot*sin_g_z - factor_1_0*slope_g_z_dot_right_0 - factor_1_3*slope_g_z_dot_right_3
    d_part_51_by_g_z_dot = cos_g_x*d_part_40_by_g_z_dot + d_part_33_by_g_z_dot*part_20
    slope_g_z_dot_right_2 = -d_part_51_by_g_z_dot - factor_2_1*slope_g_z_dot_right_1 - inv_rest_3_0_0_part_15*slope_g_z_dot_right_0
    slope_g_z_dot_right_4 = -D_z - d_part_51_by_g_z_dot - factor_2_1*slope_g_z_dot_right_1 - factor_4_2*slope_g_z_dot_right_2 - inv_rest_3_0_0_part_15*slope_g_z_dot_right_0
    slope_g_z_dot_right_8 = d_part_34_by_g_z_dot - factor_8_0*slope_g_z_dot_right_0 - factor_8_1*slope_g_z_dot_right_1 - factor_8_2*slope_g_z_dot_right_2 - factor_8_4*slope_g_z_dot_right_4
    slope_g_z_dot_8 = inv_rest_4_8_8*slope_g_z_dot_right_8
    slope_g_z_dot_4 = inv_rest_2_4_4*slope_g_z_dot_right_4 - factor_8_4*slope_g_z_dot_8
    slope_g_z_dot_2 = inv_rest_1_2_2*slope_g_z_dot_right_2 - factor_4_2*slope_g_z_dot_4 - factor_8_2*slope_g_z_dot_8
    slope_g_z_dot_1 = inv_rest_0_1_1*slope_g_z_dot_right_1 - factor_2_1*slope_g_z_dot_2 - factor_2_1*slope_g_z_dot_4 - factor_8_1*slope_g_z_dot_8
    slope_g_z_dot_0 = inv_rest_3_0_0*slope_g_z_dot_right_0 - factor_1_0*slope_g_z_dot_1 - factor_8_0*slope_g_z_dot_8 - inv_rest_3_0_0_part_15*slope_g_z_dot_2 - inv_rest_3_0_0_part_15*slope_g_z_dot_4
    slope_eta_x_dot_right_5 = -J_x_freq_x*twice_zeta_x
    slope_eta_x_dot_right_0 = -slope_eta_x_dot_right_5
    slope_eta_x_dot_right_1 = -J_x_w_z - factor_1_0*slope_eta_x_dot_right_0
    slope_eta_x_dot_right_2 = -factor_2_1*slope_eta_x_dot_right_1 - inv_rest_3_0_0_part_15*slope_eta_x_dot_right_0 - w_39
    slope_eta_x_dot_right_4 = -factor_2_1*slope_eta_x_dot_right_1 - factor_4_2*slope_eta_x_dot_right_2 - inv_rest_3_0_0_part_15*slope_eta_x_dot_right_0
    slope_eta_x_dot_right_8 = -factor_8_0*slope_eta_x_dot_right_0 - factor_8_1*slope_eta_x_dot_right_1 - factor_8_2*slope_eta_x_dot_right_2 - factor_8_4*slope_eta_x_dot_right_4
    slope_eta_x_dot_8 = inv_rest_4_8_8*slope_eta_x_dot_right_8
    slope_eta_x_dot_4 = inv_rest_2_4_4*slope_eta_x_dot_right_4 - factor_8_4*slope_eta_x_dot_8
    slope_eta_x_dot_2 = inv_rest_1_2_2*slope_eta_x_dot_right_2 - factor_4_2*slope_eta_x_dot_4 - factor_8_2*slope_eta_x_dot_8
    slope_eta_x_dot_1 = inv_rest_0_1_1*slope_eta_x_dot_right_1 - factor_2_1*slope_eta_x_dot_2 - factor_2_1*slope_eta_x_dot_4 - factor_8_1*slope_eta_x_dot_8
    slope_eta_x_dot_0 = inv_rest_3_0_0*slope_eta_x_dot_right_0 - factor_1_0*slope_eta_x_dot_1 - factor_8_0*slope_eta_x_dot_8 - inv_rest_3_0_0_part_15*slope_eta_x_dot_2 - inv_rest_3_0_0_part_15*slope_eta_x_dot_4
    slope_eta_y_dot_right_0 = J_y*w_z
    slope_eta_y_dot_right_6 = -J_y_freq_y*twice_zeta_y
    slope_eta_y_dot_right_1 = -factor_1_0*slope_eta_y_dot_right_0 - slope_eta_y_dot_right_6
    slope_eta_y_dot_right_2 = -J_y_w_x - factor_2_1*slope_eta_y_dot_right_1 - inv_rest_3_0_0_part_15*slope_eta_y_dot_right_0
    slope_eta_y_dot_right_4 = -factor_2_1*slope_eta_y_dot_right_1 - factor_4_2*slope_eta_y_dot_right_2 - inv_rest_3_0_0_part_15*slope_eta_y_dot_right_0
    slope_eta_y_dot_right_8 = -factor_8_0*slope_eta_y_dot_right_0 - factor_8_1*slope_eta_y_dot_right_1 - factor_8_2*slope_eta_y_dot_right_2 - factor_8_4*slope_eta_y_dot_right_4
    slope_eta_y_dot_8 = inv_rest_4_8_8*slope_eta_y_dot_right_8
    slope_eta_y_dot_4 = inv_rest_2_4_4*slope_eta_y_dot_right_4 - factor_8_4*slope_eta_y_dot_8
    slope_eta_y_dot_2 = inv_rest_1_2_2*slope_eta_y_dot_right_2 - factor_4_2*slope_eta_y_dot_4 - factor_8_2*slope_eta_y_dot_8
    slope_eta_y_dot_1 = inv_rest_0_1_1*slope_eta_y_dot_right_1 - factor_2_1*slope_eta_y_dot_2 - factor_2_1*slope_eta_y_dot_4 - factor_8_1*slope_eta_y_dot_8
    slope_eta_y_dot_0 = inv_rest_3_0_0*slope_eta_y_dot_right_0 - factor_1_0*slope_eta_y_dot_1 - factor_8_0*slope_eta_y_dot_8 - inv_rest_3_0_0_part_15*slope_eta_y_dot_2 - inv_rest_3_0_0_part_15*slope_eta_y_dot_4
    slope_eta_z_dot_right_0 = -J_z_w_y
    slope_eta_z_dot_right_1 = J_z*w_x - factor_1_0*slope_eta_z_dot_right_0
    slope_eta_z_dot_right_7 = -J_z_freq_z*twice_zeta_z
    slope_eta_z_dot_right_2 = -factor_2_1*slope_eta_z_dot_right_1 - inv_rest_3_0_0_part_15*slope_eta_z_dot_right_0 - slope_eta_z_dot_right_7
    slope_eta_z_dot_right_4 = -factor_2_1*slope_eta_z_dot_right_1 - factor_4_2*slope_eta_z_dot_right_2 - inv_rest_3_0_0_part_15*slope_eta_z_dot_right_0
    slope_eta_z_dot_right_8 = -factor_8_0*slope_eta_z_dot_right_0 - factor_8_1*slope_eta_z_dot_right_1 - factor_8_2*slope_eta_z_dot_right_2 - factor_8_4*slope_eta_z_dot_right_4
    slope_eta_z_dot_8 = inv_rest_4_8_8*slope_eta_z_dot_right_8
    slope_eta_z_dot_4 = inv_rest_2_4_4*slope_eta_z_dot_right_4 - factor_8_4*slope_eta_z_dot_8
    slope_eta_z_dot_2 = inv_rest_1_2_2*slope_eta_z_dot_right_2 - factor_4_2*slope_eta_z_dot_4 - factor_8_2*slope_eta_z_dot_8
    slope_eta_z_dot_1 = inv_rest_0_1_1*slope_eta_z_dot_right_1 - factor_2_1*slope_eta_z_dot_2 - factor_2_1*slope_eta_z_dot_4 - factor_8_1*slope_eta_z_dot_8
    slope_eta_z_dot_0 = inv_rest_3_0_0*slope_eta_z_dot_right_0 - factor_1_0*slope_eta_z_dot_1 - factor_8_0*slope_eta_z_dot_8 - inv_rest_3_0_0_part_15*slope_eta_z_dot_2 - inv_rest_3_0_0_part_15*slope_eta_z_dot_4
    d_part_39_by_wheel_speed = -part_36
    d_part_40_by_wheel_speed = d_part_39_by_wheel_speed*w_32 - I_wx*part_36
    d_part_41_by_wheel_speed = d_part_40_by_wheel_speed*sin_g_x
    d_part_44_by_wheel_speed = -part_43
    d_part_45_by_wheel_speed = I_wx*part_43 + d_part_44_by_wheel_speed*w_11
    slope_wheel_speed_right_3 = -d_part_45_by_wheel_speed
    slope_wheel_speed_right_0 = -cos_g_z*d_part_45_by_wheel_speed - d_part_41_by_wheel_speed*sin_g_z - factor_0_3*slope_wheel_speed_right_3
    slope_wheel_speed_right_1 = cos_g_z*d_part_41_by_wheel_speed - d_part_45_by_wheel_speed*sin_g_z - factor_1_0*slope_wheel_speed_right_0 - factor_1_3*slope_wheel_speed_right_3
    d_part_51_by_wheel_speed = cos_g_x*d_part_40_by_wheel_speed
    slope_wheel_speed_right_2 = -d_part_51_by_wheel_speed - factor_2_1*slope_wheel_speed_right_1 - inv_rest_3_0_0_part_15*slope_wheel_speed_right_0
    slope_wheel_speed_right_4 = -d_part_51_by_wheel_speed - factor_2_1*slope_wheel_speed_right_1 - factor_4_2*slope_wheel_speed_right_2 - inv_rest_3_0_0_part_15*slope_wheel_speed_right_0
    slope_wheel_speed_right_8 = -factor_8_0*slope_wheel_speed_right_0 - factor_8_1*slope_wheel_speed_right_1 - factor_8_2*slope_wheel_speed_right_2 - factor_8_4*slope_wheel_speed_right_4
    slope_wheel_speed_8 = inv_rest_4_8_8*slope_wheel_speed_right_8
    slope_wheel_speed_4 = inv_rest_2_4_4*slope_wheel_speed_right_4 - factor_8_4*slope_wheel_speed_8
    slope_wheel_speed_2 = inv_rest_1_2_2*slope_wheel_speed_right_2 - factor_4_2*slope_wheel_speed_4 - factor_8_2*slope_wheel_speed_8
    slope_wheel_speed_1 = inv_rest_0_1_1*slope_wheel_speed_right_1 - factor_2_1*slope_wheel_speed_2 - factor_2_1*slope_wheel_speed_4 - factor_8_1*slope_wheel_speed_8
    slope_wheel_speed_0 = inv_rest_3_0_0*slope_wheel_speed_right_0 - factor_1_0*slope_wheel_speed_1 - factor_8_0*slope_wheel_speed_8 - inv_rest_3_0_0_part_15*slope_wheel_speed_2 - inv_rest_3_0_0_part_15*slope_wheel_speed_4
    slope_phi_3 = inv_I_wx*slope_phi_right_3 - factor_0_3*slope_phi_0 - factor_1_3*slope_phi_1
    slope_theta_3 = inv_I_wx*slope_theta_right_3 - factor_0_3*slope_theta_0 - factor_1_3*slope_theta_1
    slope_g_x_3 = inv_I_wx*slope_g_x_right_3 - factor_0_3*slope_g_x_0 - factor_1_3*slope_g_x_1
    slope_g_z_3 = inv_I_wx*slope_g_z_right_3 - factor_0_3*slope_g_z_0 - factor_1_3*slope_g_z_1
    slope_eta_x_3 = -factor_0_3*slope_eta_x_0 - factor_1_3*slope_eta_x_1
    slope_eta_y_3 = -factor_0_3*slope_eta_y_0 - factor_1_3*slope_eta_y_1
    slope_eta_z_3 = -factor_0_3*slope_eta_z_0 - factor_1_3*slope_eta_z_1
    slope_w_x_3 = inv_I_wx*slope_w_x_right_3 - factor_0_3*slope_w_x_0 - factor_1_3*slope_w_x_1
    slope_w_y_3 = inv_I_wx*slope_w_y_right_3 - factor_0_3*slope_w_y_0 - factor_1_3*slope_w_y_1
    slope_w_z_3 = inv_I_wx*slope_w_z_right_3 - factor_0_3*slope_w_z_0 - factor_1_3*slope_w_z_1
    slope_g_x_dot_3 = inv_I_wx*slope_g_x_dot_right_3 - factor_0_3*slope_g_x_dot_0 - factor_1_3*slope_g_x_dot_1
    slope_g_z_dot_3 = inv_I_wx*slope_g_z_dot_right_3 - factor_0_3*slope_g_z_dot_0 - factor_1_3*slope_g_z_dot_1
    slope_eta_x_dot_3 = -factor_0_3*slope_eta_x_dot_0 - factor_1_3*slope_eta_x_dot_1
    slope_eta_y_dot_3 = -factor_0_3*slope_eta_y_dot_0 - factor_1_3*slope_eta_y_dot_1
    slope_eta_z_dot_3 = -factor_0_3*slope_eta_z_dot_0 - factor_1_3*slope_eta_z_dot_1
    slope_wheel_speed_3 = inv_I_wx*slope_wheel_speed_right_3 - factor_0_3*slope_wheel_speed_0 - factor_1_3*slope_wheel_speed_1
    slope_phi_5 = -slope_phi_0
    slope_theta_5 = -slope_theta_0
    slope_g_x_5 = -slope_g_x_0
    slope_g_z_5 = -slope_g_z_0
    inv_J_x = 1.0/J_x
    slope_eta_x_5 = inv_J_x*slope_eta_x_right_5 - slope_eta_x_0
    slope_eta_y_5 = -slope_eta_y_0
    slope_eta_z_5 = -slope_eta_z_0
    slope_w_x_5 = -slope_w_x_0
    slope_w_y_5 = -slope_w_y_0
    slope_w_z_5 = -slope_w_z_0
    slope_g_x_dot_5 = -slope_g_x_dot_0
    slope_g_z_dot_5 = -slope_g_z_dot_0
    slope_eta_x_dot_5 = inv_J_x*slope_eta_x_dot_right_5 - slope_eta_x_dot_0
    slope_eta_y_dot_5 = -slope_eta_y_dot_0
    slope_eta_z_dot_5 = -slope_eta_z_dot_0
    slope_wheel_speed_5 = -slope_wheel_speed_0
    slope_phi_6 = -slope_phi_1
    slope_theta_6 = -slope_theta_1
    slope_g_x_6 = -slope_g_x_1
    slope_g_z_6 = -slope_g_z_1
    slope_eta_x_6 = -slope_eta_x_1
    inv_J_y = 1.0/J_y
    slope_eta_y_6 = inv_J_y*slope_eta_y_right_6 - slope_eta_y_1
    slope_eta_z_6 = -slope_eta_z_1
    slope_w_x_6 = -slope_w_x_1
    slope_w_y_6 = -slope_w_y_1
    slope_w_z_6 = -slope_w_z_1
    slope_g_x_dot_6 = -slope_g_x_dot_1
    slope_g_z_dot_6 = -slope_g_z_dot_1
    slope_eta_x_dot_6 = -slope_eta_x_dot_1
    slope_eta_y_dot_6 = inv_J_y*slope_eta_y_dot_right_6 - slope_eta_y_dot_1
    slope_eta_z_dot_6 = -slope_eta_z_dot_1
    slope_wheel_speed_6 = -slope_wheel_speed_1
    slope_phi_7 = -slope_phi_2
    slope_theta_7 = -slope_theta_2
    slope_g_x_7 = -slope_g_x_2
    slope_g_z_7 = -slope_g_z_2
    slope_eta_x_7 = -slope_eta_x_2
    slope_eta_y_7 = -slope_eta_y_2
    inv_J_z = 1.0/J_z
    slope_eta_z_7 = inv_J_z*slope_eta_z_right_7 - slope_eta_z_2
    slope_w_x_7 = -slope_w_x_2
    slope_w_y_7 = -slope_w_y_2
    slope_w_z_7 = -slope_w_z_2
    slope_g_x_dot_7 = -slope_g_x_dot_2
    slope_g_z_dot_7 = -slope_g_z_dot_2
    slope_eta_x_dot_7 = -slope_eta_x_dot_2
    slope_eta_y_dot_7 = -slope_eta_y_dot_2
    slope_eta_z_dot_7 = inv_J_z*slope_eta_z_dot_right_7 - slope_eta_z_dot_2
    slope_wheel_speed_7 = -slope_wheel_speed_2
    out[0, 0] = cos_theta_w0*d_a_yx_by_phi + d_a_yz_by_phi*sin_theta_w0
    out[0, 1] = cos_theta_w0*d_a_yx_by_psi + d_a_yz_by_psi*sin_theta_w0
    out[0, 2] = cos_theta*w_2 + cos_theta_w0*w + sin_theta_w0*w_3 - sin_theta_w_4
    out[0, 3] = 0.0
    out[0, 4] = 0.0
    out[0, 5] = 0.0
    out[0, 6] = 0.0
    out[0, 7] = 0.0
    out[0, 8] = cos_theta
    out[0, 9] = 0.0
    out[0, 10] = sin_theta
    out[0, 11] = 0.0
    out[0, 12] = 0.0
    out[0, 13] = 0.0
    out[0, 14] = 0.0
    out[0, 15] = 0.0
    out[0, 16] = 0.0
    out[1, 0] = cos_theta_inv_cos_phi_w0*d_a_yz_by_phi - d_a_yx_by_phi*inv_cos_phi_sin_theta_w0 - inv_cos_phi*inv_cos_phi*sin_phi*w_5
    out[1, 1] = cos_theta*d_a_yz_by_psi*inv_cos_phi*w0 - d_a_yx_by_psi*inv_cos_phi_sin_theta_w0
    out[1, 2] = cos_theta_inv_cos_phi_w0*w_3 - inv_cos_phi*w_6 - inv_cos_phi_sin_theta_w0*w
    out[1, 3] = 0.0
    out[1, 4] = 0.0
    out[1, 5] = 0.0
    out[1, 6] = 0.0
    out[1, 7] = 0.0
    out[1, 8] = -inv_cos_phi_sin_theta
    out[1, 9] = 0.0
    out[1, 10] = cos_theta_inv_cos_phi
    out[1, 11] = 0.0
    out[1, 12] = 0.0
    out[1, 13] = 0.0
    out[1, 14] = 0.0
    out[1, 15] = 0.0
    out[1, 16] = 0.0
    out[2, 0] = d_a_yx_by_phi*sin_theta_tan_phi_w0 + d_a_yy_by_phi*w0 + w_5*(tan_phi*tan_phi + 1.0) - cos_theta_tan_phi_w0*d_a_yz_by_phi
    out[2, 1] = d_a_yx_by_psi*sin_theta_tan_phi_w0 + d_a_yy_by_psi*w0 - cos_theta_tan_phi_w0*d_a_yz_by_psi
    out[2, 2] = sin_theta_tan_phi_w0*w + tan_phi*w_6 - cos_theta_tan_phi_w0*w_3
    out[2, 3] = 0.0
    out[2, 4] = 0.0
    out[2, 5] = 0.0
    out[2, 6] = 0.0
    out[2, 7] = 0.0
    out[2, 8] = sin_theta_tan_phi
    out[2, 9] = 1.0
    out[2, 10] = -cos_theta_tan_phi
    out[2, 11] = 0.0
    out[2, 12] = 0.0
    out[2, 13] = 0.0
    out[2, 14] = 0.0
    out[2, 15] = 0.0
    out[2, 16] = 0.0
    out[3, 0] = 0.0
    out[3, 1] = 0.0
    out[3, 2] = 0.0
    out[3, 3] = 0.0
    out[3, 4] = 0.0
    out[3, 5] = 0.0
    out[3, 6] = 0.0
    out[3, 7] = 0.0
    out[3, 8] = 0.0
    out[3, 9] = 0.0
    out[3, 10] = 0.0
    out[3, 11] = 1.0
    out[3, 12] = 0.0
    out[3, 13] = 0.0
    out[3, 14] = 0.0
    out[3, 15] = 0.0
    out[3, 16] = 0.0
    out[4, 0] = 0.0
    out[4, 1] = 0.0
    out[4, 2] = 0.0
    out[4, 3] = 0.0
    out[4, 4] = 0.0
    out[4, 5] = 0.0
    out[4, 6] = 0.0
    out[4, 7] = 0.0
    out[4, 8] = 0.0
    out[4, 9] = 0.0
    out[4, 10] = 0.0
    out[4, 11] = 0.0
    out[4, 12] = 1.0
    out[4, 13] = 0.0
    out[4, 14] = 0.0
    out[4, 15] = 0.0
    out[4, 16] = 0.0
    out[5, 0] = 0.0
    out[5, 1] = 0.0
    out[5, 2] = 0.0
    out[5, 3] = 0.0
    out[5, 4] = 0.0
    out[5, 5] = 0.0
    out[5, 6] = 0.0
    out[5, 7] = 0.0
    out[5, 8] = 0.0
    out[5, 9] = 0.0
    out[5, 10] = 0.0
    out[5, 11] = 0.0
    out[5, 12] = 0.0
    out[5, 13] = 1.0
    out[5, 14] = 0.0
    out[5, 15] = 0.0
    out[5, 16] = 0.0
    out[6, 0] = 0.0
    out[6, 1] = 0.0
    out[6, 2] = 0.0
    out[6, 3] = 0.0
    out[6, 4] = 0.0
    out[6, 5] = 0.0
    out[6, 6] = 0.0
    out[6, 7] = 0.0
    out[6, 8] = 0.0
    out[6, 9] = 0.0
    out[6, 10] = 0.0
    out[6, 11] = 0.0
    out[6, 12] = 0.0
    out[6, 13] = 0.0
    out[6, 14] = 1.0
    out[6, 15] = 0.0
    out[6, 16] = 0.0
    out[7, 0] = 0.0
    out[7, 1] = 0.0
    out[7, 2] = 0.0
    out[7, 3] = 0.0
    out[7, 4] = 0.0
    out[7, 5] = 0.0
    out[7, 6] = 0.0
    out[7, 7] = 0.0
    out[7, 8] = 0.0
    out[7, 9] = 0.0
    out[7, 10] = 0.0
    out[7, 11] = 0.0
    out[7, 12] = 0.0
    out[7, 13] = 0.0
    out[7, 14] = 0.0
    out[7, 15] = 1.0
    out[7, 16] = 0.0
    out[8, 0] = slope_phi_0
    out[8, 1] = 0.0
    out[8, 2] = slope_theta_0
    out[8, 3] = slope_g_x_0
    out[8, 4] = slope_g_z_0
    out[8, 5] = slope_eta_x_0
    out[8, 6] = slope_eta_y_0
    out[8, 7] = slope_eta_z_0
    out[8, 8] = slope_w_x_0
    out[8, 9] = slope_w_y_0
    out[8, 10] = slope_w_z_0
    out[8, 11] = slope_g_x_dot_0
    out[8, 12] = slope_g_z_dot_0
    out[8, 13] = slope_eta_x_dot_0
    out[8, 14] = slope_eta_y_dot_0
    out[8, 15] = slope_eta_z_dot_0
    out[8, 16] = slope_wheel_speed_0
    out[9, 0] = slope_phi_1
    out[9, 1] = 0.0
    out[9, 2] = slope_theta_1
    out[9, 3] = slope_g_x_1
    out[9, 4] = slope_g_z_1
    out[9, 5] = slope_eta_x_1
    out[9, 6] = slope_eta_y_1
    out[9, 7] = slope_eta_z_1
    out[9, 8] = slope_w_x_1
    out[9, 9] = slope_w_y_1
    out[9, 10] = slope_w_z_1
    out[9, 11] = slope_g_x_dot_1
    out[9, 12] = slope_g_z_dot_1
    out[9, 13] = slope_eta_x_dot_1
    out[9, 14] = slope_eta_y_dot_1
    out[9, 15] = slope_eta_z_dot_1
    out[9, 16] = slope_wheel_speed_1
    out[10, 0] = slope_phi_2
    out[10, 1] = 0.0
    out[10, 2] = slope_theta_2
    out[10, 3] = slope_g_x_2
    out[10, 4] = slope_g_z_2
    out[10, 5] = slope_eta_x_2
    out[10, 6] = slope_eta_y_2
    out[10, 7] = slope_eta_z_2
    out[10, 8] = slope_w_x_2
    out[10, 9] = slope_w_y_2
    out[10, 10] = slope_w_z_2
    out[10, 11] = slope_g_x_dot_2
    out[10, 12] = slope_g_z_dot_2
    out[10, 13] = slope_eta_x_dot_2
    out[10, 14] = slope_eta_y_dot_2
    out[10, 15] = slope_eta_z_dot_2
    out[10, 16] = slope_wheel_speed_2
    out[11, 0] = slope_phi_3
    out[11, 1] = 0.0
    out[11, 2] = slope_theta_3
    out[11, 3] = slope_g_x_3
    out[11, 4] = slope_g_z_3
    out[11, 5] = slope_eta_x_3
    out[11, 6] = slope_eta_y_3
    out[11, 7] = slope_eta_z_3
    out[11, 8] = slope_w_x_3
    out[11, 9] = slope_w_y_3
    out[11, 10] = slope_w_z_3
    out[11, 11] = slope_g_x_dot_3
    out[11, 12] = slope_g_z_dot_3
    out[11, 13] = slope_eta_x_dot_3
    out[11, 14] = slope_eta_y_dot_3
    out[11, 15] = slope_eta_z_dot_3
    out[11, 16] = slope_wheel_speed_3
    out[12, 0] = slope_phi_4
    out[12, 1] = 0.0
    out[12, 2] = slope_theta_4
    out[12, 3] = slope_g_x_4
    out[12, 4] = slope_g_z_4
    out[12, 5] = slope_eta_x_4
    out[12, 6] = slope_eta_y_4
    out[12, 7] = slope_eta_z_4
    out[12, 8] = slope_w_x_4
    out[12, 9] = slope_w_y_4
    out[12, 10] = slope_w_z_4
    out[12, 11] = slope_g_x_dot_4
    out[12, 12] = slope_g_z_dot_4
    out[12, 13] = slope_eta_x_dot_4
    out[12, 14] = slope_eta_y_dot_4
    out[12, 15] = slope_eta_z_dot_4
    out[12, 16] = slope_wheel_speed_4
    out[13, 0] = slope_phi_5
    out[13, 1] = 0.0
    out[13, 2] = slope_theta_5
    out[13, 3] = slope_g_x_5
    out[13, 4] = slope_g_z_5
    out[13, 5] = slope_eta_x_5
    out[13, 6] = slope_eta_y_5
    out[13, 7] = slope_eta_z_5
    out[13, 8] = slope_w_x_5
    out[13, 9] = slope_w_y_5
    out[13, 10] = slope_w_z_5
    out[13, 11] = slope_g_x_dot_5
    out[13, 12] = slope_g_z_dot_5
    out[13, 13] = slope_eta_x_dot_5
    out[13, 14] = slope_eta_y_dot_5
    out[13, 15] = slope_eta_z_dot_5
    out[13, 16] = slope_wheel_speed_5
    out[14, 0] = slope_phi_6
    out[14, 1] = 0.0
    out[14, 2] = slope_theta_6
    out[14, 3] = slope_g_x_6
    out[14, 4] = slope_g_z_6
    out[14, 5] = slope_eta_x_6
    out[14, 6] = slope_eta_y_6
    out[14, 7] = slope_eta_z_6
    out[14, 8] = slope_w_x_6
    out[14, 9] = slope_w_y_6
    out[14, 10] = slope_w_z_6
    out[14, 11] = slope_g_x_dot_6
    out[14, 12] = slope_g_z_dot_6
    out[14, 13] = slope_eta_x_dot_6
    out[14, 14] = slope_eta_y_dot_6
    out[14, 15] = slope_eta_z_dot_6
    out[14, 16] = slope_wheel_speed_6
    out[15, 0] = slope_phi_7
    out[15, 1] = 0.0
    out[15, 2] = slope_theta_7
    out[15, 3] = slope_g_x_7
    out[15, 4] = slope_g_z_7
    out[15, 5] = slope_eta_x_7
    out[15, 6] = slope_eta_y_7
    out[15, 7] = slope_eta_z_7
    out[15, 8] = slope_w_x_7
    out[15, 9] = slope_w_y_7
    out[15, 10] = slope_w_z_7
    out[15, 11] = slope_g_x_dot_7
    out[15, 12] = slope_g_z_dot_7
    out[15, 13] = slope_eta_x_dot_7
    out[15, 14] = slope_eta_y_dot_7
    out[15, 15] = slope_eta_z_dot_7
    out[15, 16] = slope_wheel_speed_7
    out[16, 0] = slope_phi_8
    out[16, 1] = 0.0
    out[16, 2] = slope_theta_8
    out[16, 3] = slope_g_x_8
    out[16, 4] = slope_g_z_8
    out[16, 5] = slope_eta_x_8
    out[16, 6] = slope_eta_y_8
    out[16, 7] = slope_eta_z_8
    out[16, 8] = slope_w_x_8
    out[16, 9] = slope_w_y_8
    out[16, 10] = slope_w_z_8
    out[16, 11] = slope_g_x_dot_8
    out[16, 12] = slope_g_z_dot_8
    out[16, 13] = slope_eta_x_dot_8
    out[16, 14] = slope_eta_y_dot_8
    out[16, 15] = slope_eta_z_dot_8
    out[16, 16] = slope_wheel_speed_8
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    phi, psi, theta, g_x, g_z, eta_x, eta_y, eta_z, w_x, w_y, w_z, g_x_dot, g_z_dot, eta_x_dot, eta_y_dot, eta_z_dot, wheel_speed = x
    T_cx, T_cz, motor_torque = u
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((17, 3, *shape), np.result_type(float, t, x, u, *p))
    inv_I_wx = 1.0/I_wx
    part_1 = np.cos(g_z)
    mass_4_1 = I_wx*part_1
    factor_0_3 = inv_I_wx*mass_4_1
    w = -I_wx
    part_9 = np.cos(g_x)
    part_10 = part_9*part_9
    part_11 = I_wy*part_10
    part_2 = part_1*part_1
    part_3 = I_wx*part_2
    part_4 = np.sin(g_z)
    part_5 = part_4*part_4
    part_6 = np.sin(g_x)
    part_7 = part_6*part_6
    part_8 = I_wx*part_7
    mass_1_1 = I_x + part_11*part_5 + part_3 + part_5*part_8 + w
    rest_5_0_0 = mass_1_1 - J_x
    rest_3_0_0 = rest_5_0_0 - factor_0_3*mass_4_1
    inv_rest_3_0_0 = 1.0/rest_3_0_0
    mass_2_1 = part_1*part_4*(-part_11 - part_8 - w)
    mass_4_2 = I_wx*part_4
    rest_3_0_1 = mass_2_1 - factor_0_3*mass_4_2
    factor_1_0 = inv_rest_3_0_0*rest_3_0_1
    part_12 = part_6*part_9
    w_2 = -I_wy
    part_13 = I_wx + w_2
    part_14 = part_13*part_4
    part_15 = part_12*part_14
    inv_rest_3_0_0_part_15 = inv_rest_3_0_0*part_15
    part_19 = I_wy*part_9
    mass_9_1 = part_19*part_4
    factor_8_0 = inv_rest_3_0_0*mass_9_1
    factor_1_3 = inv_I_wx*mass_4_2
    mass_2_2 = I_wx*part_5 + I_y + part_11*part_2 + part_3*part_7 + w_2
    rest_6_1_1 = mass_2_2 - J_y
    rest_3_1_1 = rest_6_1_1 - factor_1_3*mass_4_2
    rest_0_1_1 = rest_3_1_1 - factor_1_0*rest_3_0_1
    inv_rest_0_1_1 = 1.0/rest_0_1_1
    part_16 = -part_1*part_13
    part_17 = part_12*part_16
    w_3 = part_17 - factor_1_0*part_15
    factor_2_1 = inv_rest_0_1_1*w_3
    mass_9_2 = -part_1*part_19
    rest_0_1_8 = mass_9_2 - factor_1_0*mass_9_1
    factor_8_1 = inv_rest_0_1_1*rest_0_1_8
    w_4 = inv_rest_3_0_0_part_15*part_15
    part_18 = I_wx*part_10 + I_wy*part_7
    mass_3_3 = I_z + part_18 + w
    rest_7_2_2 = mass_3_3 - J_z
    rest_0_2_2 = rest_7_2_2 - w_4
    rest_1_2_2 = rest_0_2_2 - factor_2_1*w_3
    inv_rest_1_2_2 = 1.0/rest_1_2_2
    w_5 = -part_18
    rest_0_2_4 = -w_4 - w_5
    rest_1_2_4 = rest_0_2_4 - factor_2_1*w_3
    factor_4_2 = inv_rest_1_2_2*rest_1_2_4
    part_20 = I_wy*part_6
    w_6 = -part_20
    rest_0_2_8 = w_6 - inv_rest_3_0_0_part_15*mass_9_1
    rest_1_2_8 = rest_0_2_8 - factor_2_1*rest_0_1_8
    factor_8_2 = inv_rest_1_2_2*rest_1_2_8
    rest_0_4_4 = -inv_rest_3_0_0_part_15*part_15 - w_5
    rest_1_4_4 = rest_0_4_4 - factor_2_1*w_3
    rest_2_4_4 = rest_1_4_4 - factor_4_2*rest_1_2_4
    inv_rest_2_4_4 = 1.0/rest_2_4_4
    rest_2_4_8 = rest_1_2_8 - factor_4_2*rest_1_2_8
    factor_8_4 = inv_rest_2_4_4*rest_2_4_8
    rest_0_8_8 = I_wy - factor_8_0*mass_9_1
    rest_1_8_8 = rest_0_8_8 - factor_8_1*rest_0_1_8
    rest_2_8_8 = rest_1_8_8 - factor_8_2*rest_1_2_8
    rest_4_8_8 = rest_2_8_8 - factor_8_4*rest_2_4_8
    inv_rest_4_8_8 = 1.0/rest_4_8_8
    slope_T_cx_right_0 = -factor_0_3
    slope_T_cx_right_1 = -factor_1_0*slope_T_cx_right_0 - factor_1_3
    slope_T_cx_right_2 = -factor_2_1*slope_T_cx_right_1 - inv_rest_3_0_0_part_15*slope_T_cx_right_0
    slope_T_cx_right_4 = -factor_2_1*slope_T_cx_right_1 - factor_4_2*slope_T_cx_right_2 - inv_rest_3_0_0_part_15*slope_T_cx_right_0
    slope_T_cx_right_8 = -factor_8_0*slope_T_cx_right_0 - factor_8_1*slope_T_cx_right_1 - factor_8_2*slope_T_cx_right_2 - factor_8_4*slope_T_cx_right_4
    slope_T_cx_8 = inv_rest_4_8_8*slope_T_cx_right_8
    slope_T_cx_4 = inv_rest_2_4_4*slope_T_cx_right_4 - factor_8_4*slope_T_cx_8
    slope_T_cx_2 = inv_rest_1_2_2*slope_T_cx_right_2 - factor_4_2*slope_T_cx_4 - factor_8_2*slope_T_cx_8
    slope_T_cx_1 = inv_rest_0_1_1*slope_T_cx_right_1 - factor_2_1*slope_T_cx_2 - factor_2_1*slope_T_cx_4 - factor_8_1*slope_T_cx_8
    slope_T_cx_0 = inv_rest_3_0_0*slope_T_cx_right_0 - factor_1_0*slope_T_cx_1 - factor_8_0*slope_T_cx_8 - inv_rest_3_0_0_part_15*slope_T_cx_2 - inv_rest_3_0_0_part_15*slope_T_cx_4
    slope_T_cz_right_8 = -factor_8_4
    slope_T_cz_8 = inv_rest_4_8_8*slope_T_cz_right_8
    slope_T_cz_4 = inv_rest_2_4_4 - factor_8_4*slope_T_cz_8
    slope_T_cz_2 = -factor_4_2*slope_T_cz_4 - factor_8_2*slope_T_cz_8
    slope_T_cz_1 = -factor_2_1*slope_T_cz_2 - factor_2_1*slope_T_cz_4 - factor_8_1*slope_T_cz_8
    slope_T_cz_0 = -factor_1_0*slope_T_cz_1 - factor_8_0*slope_T_cz_8 - inv_rest_3_0_0_part_15*slope_T_cz_2 - inv_rest_3_0_0_part_15*slope_T_cz_4
    slope_motor_torque_4 = -factor_8_4*inv_rest_4_8_8
    slope_motor_torque_2 = -factor_4_2*slope_motor_torque_4 - factor_8_2*inv_rest_4_8_8
    slope_motor_torque_1 = -factor_2_1*slope_motor_torque_2 - factor_2_1*slope_motor_torque_4 - factor_8_1*inv_rest_4_8_8
    slope_motor_torque_0 = -factor_1_0*slope_motor_torque_1 - factor_8_0*inv_rest_4_8_8 - inv_rest_3_0_0_part_15*slope_motor_torque_2 - inv_rest_3_0_0_part_15*slope_motor_torque_4
    slope_T_cx_3 = inv_I_wx - factor_0_3*slope_T_cx_0 - factor_1_3*slope_T_cx_1
    slope_T_cz_3 = -factor_0_3*slope_T_cz_0 - factor_1_3*slope_T_cz_1
    slope_motor_torque_3 = -factor_0_3*slope_motor_torque_0 - factor_1_3*slope_motor_torque_1
    slope_T_cx_5 = -slope_T_cx_0
    slope_T_cz_5 = -slope_T_cz_0
    slope_motor_torque_5 = -slope_motor_torque_0
    slope_T_cx_6 = -slope_T_cx_1
    slope_T_cz_6 = -slope_T_cz_1
    slope_motor_torque_6 = -slope_motor_torque_1
    slope_T_cx_7 = -slope_T_cx_2
    slope_T_cz_7 = -slope_T_cz_2
    slope_motor_torque_7 = -slope_motor_torque_2
    out[0, 0] = 0.0
    out[0, 1] = 0.0
    out[0, 2] = 0.0
    out[1, 0] = 0.0
    out[1, 1] = 0.0
    out[1, 2] = 0.0
    out[2, 0] = 0.0
    out[2, 1] = 0.0
    out[2, 2] = 0.0
    out[3, 0] = 0.0
    out[3, 1] = 0.0
    out[3, 2] = 0.0
    out[4, 0] = 0.0
    out[4, 1] = 0.0
    out[4, 2] = 0.0
    out[5, 0] = 0.0
    out[5, 1] = 0.0
    out[5, 2] = 0.0
    out[6, 0] = 0.0
    out[6, 1] = 0.0
    out[6, 2] = 0.0
    out[7, 0] = 0.0
    out[7, 1] = 0.0
    out[7, 2] = 0.0
    out[8, 0] = slope_T_cx_0
    out[8, 1] = slope_T_cz_0
    out[8, 2] = slope_motor_torque_0
    out[9, 0] = slope_T_cx_1
    out[9, 1] = slope_T_cz_1
    out[9, 2] = slope_motor_torque_1
    out[10, 0] = slope_T_cx_2
    out[10, 1] = slope_T_cz_2
    out[10, 2] = slope_motor_torque_2
    out[11, 0] = slope_T_cx_3
    out[11, 1] = slope_T_cz_3
    out[11, 2] = slope_motor_torque_3
    out[12, 0] = slope_T_cx_4
    out[12, 1] = slope_T_cz_4
    out[12, 2] = slope_motor_torque_4
    out[13, 0] = slope_T_cx_5
    out[13, 1] = slope_T_cz_5
    out[13, 2] = slope_motor_torque_5
    out[14, 0] = slope_T_cx_6
    out[14, 1] = slope_T_cz_6
    out[14, 2] = slope_motor_torque_6
    out[15, 0] = slope_T_cx_7
    out[15, 1] = slope_T_cz_7
    out[15, 2] = slope_motor_torque_7
    out[16, 0] = slope_T_cx_8
    out[16, 1] = slope_T_cz_8
    out[16, 2] = inv_rest_4_8_8
    return out


def reference_batch(t, p, out=None):
    """The reference curve c(t). Batch form."""
    I_x, I_y, I_z, w0, I_wx, I_wy, nominal_speed, K_x, K_z, D_x, D_z, J_x, J_y, J_z, freq_x, freq_y, freq_z, zeta_x, zeta_y, zeta_z = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t))
        out = np.empty((17, *shape), np.result_type(float, t, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = 0.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    out[6] = 0.0
    out[7] = 0.0
    out[8] = 0.0
    out[9] = -w0
    out[10] = 0.0
    out[11] = 0.0
    out[12] = 0.0
    out[13] = 0.0
    out[14] = 0.0
    out[15] = 0.0
    out[16] = 0.0
    return out
