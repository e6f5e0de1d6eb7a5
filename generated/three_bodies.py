"""Circular restricted three-body problem.

Written by satsym from derivations/examples/three_bodies.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/three_bodies.py
Source: ../derivations/examples/three_bodies.py 1e4b58f326963e49ddc52b060de09152
Digest: d100ee4e561f1e4a6c2f0995f07f4a0c70feb22b86444b1acc0725eca32f41cd
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'three_bodies',
    'title': 'Circular restricted three-body problem',
    'source': 'derivations/examples/three_bodies.py',
    'states': (
        {'symbol': 'x', 'latex': 'x', 'unit': 'km', 'meaning': 'position along the line of the two bodies'},
        {'symbol': 'y', 'latex': 'y', 'unit': 'km', 'meaning': 'position in their plane, across that line'},
        {'symbol': 'z', 'latex': 'z', 'unit': 'km', 'meaning': 'position along the normal of their plane'},
        {'symbol': 'x_dot', 'latex': '\\dot x', 'unit': 'km/s', 'meaning': 'rate of x'},
        {'symbol': 'y_dot', 'latex': '\\dot y', 'unit': 'km/s', 'meaning': 'rate of y'},
        {'symbol': 'z_dot', 'latex': '\\dot z', 'unit': 'km/s', 'meaning': 'rate of z'},
    ),
    'controls': (),
    'parameters': (
        {'symbol': 'n', 'latex': 'n', 'unit': 'rad/s', 'meaning': 'angular velocity of the two bodies', 'default': 1.0, 'positive': True},
        {'symbol': 'R', 'latex': 'R', 'unit': 'km', 'meaning': 'distance between the two bodies', 'default': 1.0, 'positive': True},
        {'symbol': 'mu', 'latex': '\\mu', 'meaning': 'mass of the second body as a fraction of the total mass', 'default': 0.01215, 'positive': True},
    ),
    'control_set': None,
    'has_cost': False,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (
        {'symbol': 'jacobi_integral', 'latex': '\\mathcal{J}', 'unit': 'km**2/s**2'},
    ),
    'position': (
        {'symbol': 'x', 'latex': 'x'},
        {'symbol': 'y', 'latex': 'y'},
        {'symbol': 'z', 'latex': 'z'},
    ),
    'multipliers': (),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    n_sq = n*n
    twice_n = 2.0*n
    w = -x_value
    x1 = -R*mu
    w_2 = -w - x1
    w_3 = y*y + z*z
    w_4 = w_2*w_2 + w_3
    sqrt_w_4 = math.sqrt(w_4)
    inv_sqrt_w_4 = 1.0/sqrt_w_4
    w_5 = 1.0 - mu
    w_6 = R*R*R*n_sq
    mu1 = w_5*w_6
    w_7 = inv_sqrt_w_4*inv_sqrt_w_4*inv_sqrt_w_4*mu1
    x2 = R*w_5
    w_8 = -w - x2
    w_9 = w_3 + w_8*w_8
    sqrt_w_9 = math.sqrt(w_9)
    inv_sqrt_w_9 = 1.0/sqrt_w_9
    mu2 = mu*w_6
    w_10 = inv_sqrt_w_9*inv_sqrt_w_9*inv_sqrt_w_9*mu2
    twice_x_value = 2.0*x_value
    w_11 = w_3 + x_value*x_value
    w_12 = w_11 + x1*x1 - twice_x_value*x1
    sqrt_w_12 = math.sqrt(w_12)
    inv_sqrt_w_12 = 1.0/sqrt_w_12
    w_13 = w_11 + x2*x2 - twice_x_value*x2
    sqrt_w_13 = math.sqrt(w_13)
    inv_sqrt_w_13 = 1.0/sqrt_w_13
    return (
        x_dot,
        y_dot,
        z_dot,
        n_sq*x_value + twice_n*y_dot + w_10*x2 + w_7*x1 - w_10*x_value - w_7*x_value,
        n_sq*y - inv_sqrt_w_12*inv_sqrt_w_12*inv_sqrt_w_12*mu1*y - inv_sqrt_w_13*inv_sqrt_w_13*inv_sqrt_w_13*mu2*y - twice_n*x_dot,
        -w_10*z - w_7*z,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    n_sq = n*n
    w = 1.0 - mu
    x2 = R*w
    x2_sq = x2*x2
    w_2 = -x_value
    x1 = -R*mu
    w_3 = -w_2 - x1
    y_sq = y*y
    z_sq = z*z
    w_4 = y_sq + z_sq
    w_5 = w_3*w_3 + w_4
    sqrt_w_5 = math.sqrt(w_5)
    inv_sqrt_w_5 = 1.0/sqrt_w_5
    w_6 = R*R*R*n_sq
    mu1 = w*w_6
    w_7 = inv_sqrt_w_5*inv_sqrt_w_5*inv_sqrt_w_5*mu1
    w_8 = -w_2 - x2
    w_9 = w_4 + w_8*w_8
    sqrt_w_9 = math.sqrt(w_9)
    inv_sqrt_w_9 = 1.0/sqrt_w_9
    mu2 = mu*w_6
    w_10 = inv_sqrt_w_9*inv_sqrt_w_9*inv_sqrt_w_9*mu2
    inv_sqrt_w_5_sq = inv_sqrt_w_5*inv_sqrt_w_5
    inv_sqrt_w_5_sq_sq = inv_sqrt_w_5_sq*inv_sqrt_w_5_sq
    w_11 = inv_sqrt_w_5*inv_sqrt_w_5_sq_sq
    w_12 = 6.0*x_value
    inv_sqrt_w_9_sq = inv_sqrt_w_9*inv_sqrt_w_9
    inv_sqrt_w_9_sq_sq = inv_sqrt_w_9_sq*inv_sqrt_w_9_sq
    w_13 = inv_sqrt_w_9*inv_sqrt_w_9_sq_sq
    w_14 = 3.0*mu1
    w_11_w_14 = w_11*w_14
    w_15 = 3.0*mu2
    w_13_w_15 = w_13*w_15
    x1_sq = x1*x1
    x_value_sq = x_value*x_value
    w_11_w_14_y = w_11_w_14*y
    w_13_w_15_y = w_13_w_15*y
    w_16 = 3.0*inv_sqrt_w_5*inv_sqrt_w_5_sq_sq*mu1*x_value*z + 3.0*inv_sqrt_w_9*inv_sqrt_w_9_sq_sq*mu2*x_value*z - w_11_w_14*x1*z - w_13_w_15*x2*z
    twice_n = 2.0*n
    w_17 = w_4 + x_value_sq
    twice_x_value = 2.0*x_value
    w_18 = w_17 + x1_sq - twice_x_value*x1
    sqrt_w_18 = math.sqrt(w_18)
    inv_sqrt_w_18 = 1.0/sqrt_w_18
    w_19 = w_17 + x2_sq - twice_x_value*x2
    sqrt_w_19 = math.sqrt(w_19)
    inv_sqrt_w_19 = 1.0/sqrt_w_19
    inv_sqrt_w_18_sq = inv_sqrt_w_18*inv_sqrt_w_18
    inv_sqrt_w_18_sq_sq = inv_sqrt_w_18_sq*inv_sqrt_w_18_sq
    w_20 = inv_sqrt_w_18*inv_sqrt_w_18_sq_sq*w_14
    w_20_y = w_20*y
    inv_sqrt_w_19_sq = inv_sqrt_w_19*inv_sqrt_w_19
    inv_sqrt_w_19_sq_sq = inv_sqrt_w_19_sq*inv_sqrt_w_19_sq
    w_21 = inv_sqrt_w_19*inv_sqrt_w_19_sq_sq*w_15
    w_21_y = w_21*y
    return (
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
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
        n_sq + w_11_w_14*x1_sq + w_11_w_14*x_value_sq + w_13_w_15*x2_sq + w_13_w_15*x_value_sq - mu1*w_11*w_12*x1 - mu2*w_12*w_13*x2 - w_10 - w_7,
        3.0*inv_sqrt_w_5*inv_sqrt_w_5_sq_sq*mu1*x_value*y + 3.0*inv_sqrt_w_9*inv_sqrt_w_9_sq_sq*mu2*x_value*y - w_11_w_14_y*x1 - w_13_w_15_y*x2,
        w_16,
        0.0,
        twice_n,
        0.0,
        3.0*inv_sqrt_w_18*inv_sqrt_w_18_sq_sq*mu1*x_value*y + 3.0*inv_sqrt_w_19*inv_sqrt_w_19_sq_sq*mu2*x_value*y - w_20_y*x1 - w_21_y*x2,
        n_sq + w_20*y_sq + w_21*y_sq - inv_sqrt_w_18*inv_sqrt_w_18*inv_sqrt_w_18*mu1 - inv_sqrt_w_19*inv_sqrt_w_19*inv_sqrt_w_19*mu2,
        w_20_y*z + w_21_y*z,
        -twice_n,
        0.0,
        0.0,
        w_16,
        w_11_w_14_y*z + w_13_w_15_y*z,
        3.0*inv_sqrt_w_5*inv_sqrt_w_5_sq_sq*mu1*z_sq + 3.0*inv_sqrt_w_9*inv_sqrt_w_9_sq_sq*mu2*z_sq - w_10 - w_7,
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    return (
    )


def invariants(t, x, p):
    """What the uncontrolled motion keeps constant."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    w = -x_value
    x1 = -R*mu
    w_2 = -w - x1
    y_sq = y*y
    w_3 = y_sq + z*z
    w_4 = w_2*w_2 + w_3
    sqrt_w_4 = math.sqrt(w_4)
    inv_sqrt_w_4 = 1.0/sqrt_w_4
    w_5 = 1.0 - mu
    x2 = R*w_5
    w_6 = -w - x2
    w_7 = w_3 + w_6*w_6
    sqrt_w_7 = math.sqrt(w_7)
    inv_sqrt_w_7 = 1.0/sqrt_w_7
    n_sq = n*n
    half_n_sq = 0.5*n_sq
    w_8 = R*R*R*n_sq
    mu1 = w_5*w_8
    mu2 = mu*w_8
    return (
        0.5*x_dot*x_dot + 0.5*y_dot*y_dot + 0.5*z_dot*z_dot - half_n_sq*x_value*x_value - half_n_sq*y_sq - inv_sqrt_w_4*mu1 - inv_sqrt_w_7*mu2,
    )


def position(t, x, p):
    """Inertial components of the position vector."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    n_t = n*t
    cos_n_t = math.cos(n_t)
    sin_n_t = math.sin(n_t)
    return (
        cos_n_t*x_value - sin_n_t*y,
        cos_n_t*y + sin_n_t*x_value,
        z,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    n, R, mu = p
    x_value_at, y_at, z_at, x_dot_at, y_dot_at, z_dot_at = x
    x_value_mid, y_mid, z_mid, x_dot_mid, y_dot_mid, z_dot_mid = x_mid
    x_value, y, z, x_dot, y_dot, z_dot = x0
    n_sq = n*n
    twice_n = 2.0*n
    w = 1.0 - mu
    w_2 = R*R*R*n_sq
    mu1 = w*w_2
    x1 = -R*mu
    mu1_x1 = mu1*x1
    mu2 = mu*w_2
    x2 = R*w
    mu2_x2 = mu2*x2
    x1_sq = x1*x1
    twice_x1 = 2.0*x1
    x2_sq = x2*x2
    twice_x2 = 2.0*x2
    steps = len(times) - 1
    t = times[0]
    x_value_at[0] = x_value
    y_at[0] = y
    z_at[0] = z
    x_dot_at[0] = x_dot
    y_dot_at[0] = y_dot
    z_dot_at[0] = z_dot
    w_3 = -x_value
    w_4 = -w_3 - x1
    w_5 = y*y + z*z
    w_6 = w_4*w_4 + w_5
    sqrt_w_6 = math.sqrt(w_6)
    inv_sqrt_w_6 = 1.0/sqrt_w_6
    inv_sqrt_w_6_cubed = inv_sqrt_w_6*inv_sqrt_w_6*inv_sqrt_w_6
    w_7 = -w_3 - x2
    w_8 = w_5 + w_7*w_7
    sqrt_w_8 = math.sqrt(w_8)
    inv_sqrt_w_8 = 1.0/sqrt_w_8
    inv_sqrt_w_8_cubed = inv_sqrt_w_8*inv_sqrt_w_8*inv_sqrt_w_8
    inv_sqrt_w_6_cubed_mu1 = inv_sqrt_w_6_cubed*mu1
    inv_sqrt_w_8_cubed_mu2 = inv_sqrt_w_8_cubed*mu2
    w_9 = w_5 + x_value*x_value
    w_10 = w_9 + x1_sq - twice_x1*x_value
    sqrt_w_10 = math.sqrt(w_10)
    inv_sqrt_w_10 = 1.0/sqrt_w_10
    w_11 = w_9 + x2_sq - twice_x2*x_value
    sqrt_w_11 = math.sqrt(w_11)
    inv_sqrt_w_11 = 1.0/sqrt_w_11
    slope_x_dot = inv_sqrt_w_6_cubed*mu1_x1 + inv_sqrt_w_8_cubed*mu2_x2 + n_sq*x_value + twice_n*y_dot - inv_sqrt_w_6_cubed_mu1*x_value - inv_sqrt_w_8_cubed_mu2*x_value
    slope_y_dot = n_sq*y - inv_sqrt_w_10*inv_sqrt_w_10*inv_sqrt_w_10*mu1*y - inv_sqrt_w_11*inv_sqrt_w_11*inv_sqrt_w_11*mu2*y - twice_n*x_dot
    slope_z_dot = -inv_sqrt_w_6_cubed_mu1*z - inv_sqrt_w_8_cubed_mu2*z
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x_value_at[i] = x_value
        y_at[i] = y
        z_at[i] = z
        x_dot_at[i] = x_dot
        y_dot_at[i] = y_dot
        z_dot_at[i] = z_dot
        half = 0.5*h
        sixth = (1.0/6.0)*h
        x_value_2 = half*x_dot + x_value
        y_2 = half*y_dot + y
        z_2 = half*z_dot + z
        x_dot_2 = half*slope_x_dot + x_dot
        y_dot_2 = half*slope_y_dot + y_dot
        z_dot_2 = half*slope_z_dot + z_dot
        w_12 = -x_value_2
        w_13 = -w_12 - x1
        w_14 = y_2*y_2 + z_2*z_2
        w_15 = w_13*w_13 + w_14
        sqrt_w_15 = math.sqrt(w_15)
        inv_sqrt_w_15 = 1.0/sqrt_w_15
        inv_sqrt_w_15_cubed = inv_sqrt_w_15*inv_sqrt_w_15*inv_sqrt_w_15
        w_16 = -w_12 - x2
        w_17 = w_14 + w_16*w_16
        sqrt_w_17 = math.sqrt(w_17)
        inv_sqrt_w_17 = 1.0/sqrt_w_17
        inv_sqrt_w_17_cubed = inv_sqrt_w_17*inv_sqrt_w_17*inv_sqrt_w_17
        inv_sqrt_w_15_cubed_mu1 = inv_sqrt_w_15_cubed*mu1
        inv_sqrt_w_17_cubed_mu2 = inv_sqrt_w_17_cubed*mu2
        w_18 = w_14 + x_value_2*x_value_2
        w_19 = w_18 + x1_sq - twice_x1*x_value_2
        sqrt_w_19 = math.sqrt(w_19)
        inv_sqrt_w_19 = 1.0/sqrt_w_19
        w_20 = w_18 + x2_sq - twice_x2*x_value_2
        sqrt_w_20 = math.sqrt(w_20)
        inv_sqrt_w_20 = 1.0/sqrt_w_20
        k2_x_dot = inv_sqrt_w_15_cubed*mu1_x1 + inv_sqrt_w_17_cubed*mu2_x2 + n_sq*x_value_2 + twice_n*y_dot_2 - inv_sqrt_w_15_cubed_mu1*x_value_2 - inv_sqrt_w_17_cubed_mu2*x_value_2
        k2_y_dot = n_sq*y_2 - inv_sqrt_w_19*inv_sqrt_w_19*inv_sqrt_w_19*mu1*y_2 - inv_sqrt_w_20*inv_sqrt_w_20*inv_sqrt_w_20*mu2*y_2 - twice_n*x_dot_2
        k2_z_dot = -inv_sqrt_w_15_cubed_mu1*z_2 - inv_sqrt_w_17_cubed_mu2*z_2
        x_value_3 = half*x_dot_2 + x_value
        y_3 = half*y_dot_2 + y
        z_3 = half*z_dot_2 + z
        x_dot_3 = half*k2_x_dot + x_dot
        y_dot_3 = half*k2_y_dot + y_dot
        z_dot_3 = half*k2_z_dot + z_dot
        w_21 = -x_value_3
        w_22 = -w_21 - x1
        w_23 = y_3*y_3 + z_3*z_3
        w_24 = w_22*w_22 + w_23
        sqrt_w_24 = math.sqrt(w_24)
        inv_sqrt_w_24 = 1.0/sqrt_w_24
        inv_sqrt_w_24_cubed = inv_sqrt_w_24*inv_sqrt_w_24*inv_sqrt_w_24
        w_25 = -w_21 - x2
        w_26 = w_23 + w_25*w_25
        sqrt_w_26 = math.sqrt(w_26)
        inv_sqrt_w_26 = 1.0/sqrt_w_26
        inv_sqrt_w_26_cubed = inv_sqrt_w_26*inv_sqrt_w_26*inv_sqrt_w_26
        inv_sqrt_w_24_cubed_mu1 = inv_sqrt_w_24_cubed*mu1
        inv_sqrt_w_26_cubed_mu2 = inv_sqrt_w_26_cubed*mu2
        w_27 = w_23 + x_value_3*x_value_3
        w_28 = w_27 + x1_sq - twice_x1*x_value_3
        sqrt_w_28 = math.sqrt(w_28)
        inv_sqrt_w_28 = 1.0/sqrt_w_28
        w_29 = w_27 + x2_sq - twice_x2*x_value_3
        sqrt_w_29 = math.sqrt(w_29)
        inv_sqrt_w_29 = 1.0/sqrt_w_29
        k3_x_dot = inv_sqrt_w_24_cubed*mu1_x1 + inv_sqrt_w_26_cubed*mu2_x2 + n_sq*x_value_3 + twice_n*y_dot_3 - inv_sqrt_w_24_cubed_mu1*x_value_3 - inv_sqrt_w_26_cubed_mu2*x_value_3
        k3_y_dot = n_sq*y_3 - inv_sqrt_w_28*inv_sqrt_w_28*inv_sqrt_w_28*mu1*y_3 - inv_sqrt_w_29*inv_sqrt_w_29*inv_sqrt_w_29*mu2*y_3 - twice_n*x_dot_3
        k3_z_dot = -inv_sqrt_w_24_cubed_mu1*z_3 - inv_sqrt_w_26_cubed_mu2*z_3
        x_value_4 = h*x_dot_3 + x_value
        y_4 = h*y_dot_3 + y
        z_4 = h*z_dot_3 + z
        x_dot_4 = h*k3_x_dot + x_dot
        y_dot_4 = h*k3_y_dot + y_dot
        w_30 = -x_value_4
        w_31 = -w_30 - x1
        w_32 = y_4*y_4 + z_4*z_4
        w_33 = w_31*w_31 + w_32
        sqrt_w_33 = math.sqrt(w_33)
        inv_sqrt_w_33 = 1.0/sqrt_w_33
        inv_sqrt_w_33_cubed = inv_sqrt_w_33*inv_sqrt_w_33*inv_sqrt_w_33
        w_34 = -w_30 - x2
        w_35 = w_32 + w_34*w_34
        sqrt_w_35 = math.sqrt(w_35)
        inv_sqrt_w_35 = 1.0/sqrt_w_35
        inv_sqrt_w_35_cubed = inv_sqrt_w_35*inv_sqrt_w_35*inv_sqrt_w_35
        inv_sqrt_w_33_cubed_mu1 = inv_sqrt_w_33_cubed*mu1
        inv_sqrt_w_35_cubed_mu2 = inv_sqrt_w_35_cubed*mu2
        w_36 = w_32 + x_value_4*x_value_4
        w_37 = w_36 + x1_sq - twice_x1*x_value_4
        sqrt_w_37 = math.sqrt(w_37)
        inv_sqrt_w_37 = 1.0/sqrt_w_37
        w_38 = w_36 + x2_sq - twice_x2*x_value_4
        sqrt_w_38 = math.sqrt(w_38)
        inv_sqrt_w_38 = 1.0/sqrt_w_38
        k4_x_dot = inv_sqrt_w_33_cubed*mu1_x1 + inv_sqrt_w_35_cubed*mu2_x2 + n_sq*x_value_4 + twice_n*y_dot_4 - inv_sqrt_w_33_cubed_mu1*x_value_4 - inv_sqrt_w_35_cubed_mu2*x_value_4
        k4_y_dot = n_sq*y_4 - inv_sqrt_w_37*inv_sqrt_w_37*inv_sqrt_w_37*mu1*y_4 - inv_sqrt_w_38*inv_sqrt_w_38*inv_sqrt_w_38*mu2*y_4 - twice_n*x_dot_4
        k4_z_dot = -inv_sqrt_w_33_cubed_mu1*z_4 - inv_sqrt_w_35_cubed_mu2*z_4
        k23_x_dot = k2_x_dot + k3_x_dot
        k123_x_dot = k23_x_dot + slope_x_dot
        k23_y_dot = k2_y_dot + k3_y_dot
        k123_y_dot = k23_y_dot + slope_y_dot
        k23_z_dot = k2_z_dot + k3_z_dot
        k123_z_dot = k23_z_dot + slope_z_dot
        x_value_end = h*(k123_x_dot*sixth + x_dot) + x_value
        y_end = h*(k123_y_dot*sixth + y_dot) + y
        z_end = h*(k123_z_dot*sixth + z_dot) + z
        x_dot_end = sixth*(k123_x_dot + k23_x_dot + k4_x_dot) + x_dot
        y_dot_end = sixth*(k123_y_dot + k23_y_dot + k4_y_dot) + y_dot
        z_dot_end = sixth*(k123_z_dot + k23_z_dot + k4_z_dot) + z_dot
        w_39 = -x_value_end
        w_40 = -w_39 - x1
        w_41 = y_end*y_end + z_end*z_end
        w_42 = w_40*w_40 + w_41
        sqrt_w_42 = math.sqrt(w_42)
        inv_sqrt_w_42 = 1.0/sqrt_w_42
        inv_sqrt_w_42_cubed = inv_sqrt_w_42*inv_sqrt_w_42*inv_sqrt_w_42
        w_43 = -w_39 - x2
        w_44 = w_41 + w_43*w_43
        sqrt_w_44 = math.sqrt(w_44)
        inv_sqrt_w_44 = 1.0/sqrt_w_44
        inv_sqrt_w_44_cubed = inv_sqrt_w_44*inv_sqrt_w_44*inv_sqrt_w_44
        inv_sqrt_w_42_cubed_mu1 = inv_sqrt_w_42_cubed*mu1
        inv_sqrt_w_44_cubed_mu2 = inv_sqrt_w_44_cubed*mu2
        w_45 = w_41 + x_value_end*x_value_end
        w_46 = w_45 + x1_sq - twice_x1*x_value_end
        sqrt_w_46 = math.sqrt(w_46)
        inv_sqrt_w_46 = 1.0/sqrt_w_46
        w_47 = w_45 + x2_sq - twice_x2*x_value_end
        sqrt_w_47 = math.sqrt(w_47)
        inv_sqrt_w_47 = 1.0/sqrt_w_47
        slope_end_x_dot = inv_sqrt_w_42_cubed*mu1_x1 + inv_sqrt_w_44_cubed*mu2_x2 + n_sq*x_value_end + twice_n*y_dot_end - inv_sqrt_w_42_cubed_mu1*x_value_end - inv_sqrt_w_44_cubed_mu2*x_value_end
        slope_end_y_dot = n_sq*y_end - inv_sqrt_w_46*inv_sqrt_w_46*inv_sqrt_w_46*mu1*y_end - inv_sqrt_w_47*inv_sqrt_w_47*inv_sqrt_w_47*mu2*y_end - twice_n*x_dot_end
        slope_end_z_dot = -inv_sqrt_w_42_cubed_mu1*z_end - inv_sqrt_w_44_cubed_mu2*z_end
        eighth = 0.125*h
        x_value_mid[i] = eighth*(x_dot - x_dot_end) + 0.5*(x_value + x_value_end)
        y_mid[i] = eighth*(y_dot - y_dot_end) + 0.5*(y + y_end)
        z_mid[i] = eighth*(z_dot - z_dot_end) + 0.5*(z + z_end)
        x_dot_mid[i] = eighth*(slope_x_dot - slope_end_x_dot) + 0.5*(x_dot + x_dot_end)
        y_dot_mid[i] = eighth*(slope_y_dot - slope_end_y_dot) + 0.5*(y_dot + y_dot_end)
        z_dot_mid[i] = eighth*(slope_z_dot - slope_end_z_dot) + 0.5*(z_dot + z_dot_end)
        t = t_end
        x_value = x_value_end
        y = y_end
        z = z_end
        x_dot = x_dot_end
        y_dot = y_dot_end
        z_dot = z_dot_end
        slope_x_dot = slope_end_x_dot
        slope_y_dot = slope_end_y_dot
        slope_z_dot = slope_end_z_dot
    x_value_at[steps] = x_value
    y_at[steps] = y
    z_at[steps] = z
    x_dot_at[steps] = x_dot
    y_dot_at[steps] = y_dot
    z_dot_at[steps] = z_dot


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, u, *p))
    n_sq = n*n
    twice_n = 2.0*n
    w = -x_value
    x1 = -R*mu
    w_2 = -w - x1
    w_3 = y*y + z*z
    w_4 = w_2*w_2 + w_3
    sqrt_w_4 = np.sqrt(w_4)
    inv_sqrt_w_4 = 1.0/sqrt_w_4
    w_5 = 1.0 - mu
    w_6 = R*R*R*n_sq
    mu1 = w_5*w_6
    w_7 = inv_sqrt_w_4*inv_sqrt_w_4*inv_sqrt_w_4*mu1
    x2 = R*w_5
    w_8 = -w - x2
    w_9 = w_3 + w_8*w_8
    sqrt_w_9 = np.sqrt(w_9)
    inv_sqrt_w_9 = 1.0/sqrt_w_9
    mu2 = mu*w_6
    w_10 = inv_sqrt_w_9*inv_sqrt_w_9*inv_sqrt_w_9*mu2
    twice_x_value = 2.0*x_value
    w_11 = w_3 + x_value*x_value
    w_12 = w_11 + x1*x1 - twice_x_value*x1
    sqrt_w_12 = np.sqrt(w_12)
    inv_sqrt_w_12 = 1.0/sqrt_w_12
    w_13 = w_11 + x2*x2 - twice_x_value*x2
    sqrt_w_13 = np.sqrt(w_13)
    inv_sqrt_w_13 = 1.0/sqrt_w_13
    out[0] = x_dot
    out[1] = y_dot
    out[2] = z_dot
    out[3] = n_sq*x_value + twice_n*y_dot + w_10*x2 + w_7*x1 - w_10*x_value - w_7*x_value
    out[4] = n_sq*y - inv_sqrt_w_12*inv_sqrt_w_12*inv_sqrt_w_12*mu1*y - inv_sqrt_w_13*inv_sqrt_w_13*inv_sqrt_w_13*mu2*y - twice_n*x_dot
    out[5] = -w_10*z - w_7*z
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    n_sq = n*n
    w = 1.0 - mu
    x2 = R*w
    x2_sq = x2*x2
    w_2 = -x_value
    x1 = -R*mu
    w_3 = -w_2 - x1
    y_sq = y*y
    z_sq = z*z
    w_4 = y_sq + z_sq
    w_5 = w_3*w_3 + w_4
    sqrt_w_5 = np.sqrt(w_5)
    inv_sqrt_w_5 = 1.0/sqrt_w_5
    w_6 = R*R*R*n_sq
    mu1 = w*w_6
    w_7 = inv_sqrt_w_5*inv_sqrt_w_5*inv_sqrt_w_5*mu1
    w_8 = -w_2 - x2
    w_9 = w_4 + w_8*w_8
    sqrt_w_9 = np.sqrt(w_9)
    inv_sqrt_w_9 = 1.0/sqrt_w_9
    mu2 = mu*w_6
    w_10 = inv_sqrt_w_9*inv_sqrt_w_9*inv_sqrt_w_9*mu2
    inv_sqrt_w_5_sq = inv_sqrt_w_5*inv_sqrt_w_5
    inv_sqrt_w_5_sq_sq = inv_sqrt_w_5_sq*inv_sqrt_w_5_sq
    w_11 = inv_sqrt_w_5*inv_sqrt_w_5_sq_sq
    w_12 = 6.0*x_value
    inv_sqrt_w_9_sq = inv_sqrt_w_9*inv_sqrt_w_9
    inv_sqrt_w_9_sq_sq = inv_sqrt_w_9_sq*inv_sqrt_w_9_sq
    w_13 = inv_sqrt_w_9*inv_sqrt_w_9_sq_sq
    w_14 = 3.0*mu1
    w_11_w_14 = w_11*w_14
    w_15 = 3.0*mu2
    w_13_w_15 = w_13*w_15
    x1_sq = x1*x1
    x_value_sq = x_value*x_value
    w_11_w_14_y = w_11_w_14*y
    w_13_w_15_y = w_13_w_15*y
    w_16 = 3.0*inv_sqrt_w_5*inv_sqrt_w_5_sq_sq*mu1*x_value*z + 3.0*inv_sqrt_w_9*inv_sqrt_w_9_sq_sq*mu2*x_value*z - w_11_w_14*x1*z - w_13_w_15*x2*z
    twice_n = 2.0*n
    w_17 = w_4 + x_value_sq
    twice_x_value = 2.0*x_value
    w_18 = w_17 + x1_sq - twice_x_value*x1
    sqrt_w_18 = np.sqrt(w_18)
    inv_sqrt_w_18 = 1.0/sqrt_w_18
    w_19 = w_17 + x2_sq - twice_x_value*x2
    sqrt_w_19 = np.sqrt(w_19)
    inv_sqrt_w_19 = 1.0/sqrt_w_19
    inv_sqrt_w_18_sq = inv_sqrt_w_18*inv_sqrt_w_18
    inv_sqrt_w_18_sq_sq = inv_sqrt_w_18_sq*inv_sqrt_w_18_sq
    w_20 = inv_sqrt_w_18*inv_sqrt_w_18_sq_sq*w_14
    w_20_y = w_20*y
    inv_sqrt_w_19_sq = inv_sqrt_w_19*inv_sqrt_w_19
    inv_sqrt_w_19_sq_sq = inv_sqrt_w_19_sq*inv_sqrt_w_19_sq
    w_21 = inv_sqrt_w_19*inv_sqrt_w_19_sq_sq*w_15
    w_21_y = w_21*y
    out[0, 3] = 1.0
    out[1, 4] = 1.0
    out[2, 5] = 1.0
    out[3, 0] = n_sq + w_11_w_14*x1_sq + w_11_w_14*x_value_sq + w_13_w_15*x2_sq + w_13_w_15*x_value_sq - mu1*w_11*w_12*x1 - mu2*w_12*w_13*x2 - w_10 - w_7
    out[3, 1] = 3.0*inv_sqrt_w_5*inv_sqrt_w_5_sq_sq*mu1*x_value*y + 3.0*inv_sqrt_w_9*inv_sqrt_w_9_sq_sq*mu2*x_value*y - w_11_w_14_y*x1 - w_13_w_15_y*x2
    out[3, 2] = w_16
    out[3, 4] = twice_n
    out[4, 0] = 3.0*inv_sqrt_w_18*inv_sqrt_w_18_sq_sq*mu1*x_value*y + 3.0*inv_sqrt_w_19*inv_sqrt_w_19_sq_sq*mu2*x_value*y - w_20_y*x1 - w_21_y*x2
    out[4, 1] = n_sq + w_20*y_sq + w_21*y_sq - inv_sqrt_w_18*inv_sqrt_w_18*inv_sqrt_w_18*mu1 - inv_sqrt_w_19*inv_sqrt_w_19*inv_sqrt_w_19*mu2
    out[4, 2] = w_20_y*z + w_21_y*z
    out[4, 3] = -twice_n
    out[5, 0] = w_16
    out[5, 1] = w_11_w_14_y*z + w_13_w_15_y*z
    out[5, 2] = 3.0*inv_sqrt_w_5*inv_sqrt_w_5_sq_sq*mu1*z_sq + 3.0*inv_sqrt_w_9*inv_sqrt_w_9_sq_sq*mu2*z_sq - w_10 - w_7
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((6, 0, *shape), np.result_type(float, t, x, u, *p))
    return out


def invariants_batch(t, x, p, out=None):
    """What the uncontrolled motion keeps constant. Batch form."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((1, *shape), np.result_type(float, t, x, *p))
    w = -x_value
    x1 = -R*mu
    w_2 = -w - x1
    y_sq = y*y
    w_3 = y_sq + z*z
    w_4 = w_2*w_2 + w_3
    sqrt_w_4 = np.sqrt(w_4)
    inv_sqrt_w_4 = 1.0/sqrt_w_4
    w_5 = 1.0 - mu
    x2 = R*w_5
    w_6 = -w - x2
    w_7 = w_3 + w_6*w_6
    sqrt_w_7 = np.sqrt(w_7)
    inv_sqrt_w_7 = 1.0/sqrt_w_7
    n_sq = n*n
    half_n_sq = 0.5*n_sq
    w_8 = R*R*R*n_sq
    mu1 = w_5*w_8
    mu2 = mu*w_8
    out[0] = 0.5*x_dot*x_dot + 0.5*y_dot*y_dot + 0.5*z_dot*z_dot - half_n_sq*x_value*x_value - half_n_sq*y_sq - inv_sqrt_w_4*mu1 - inv_sqrt_w_7*mu2
    return out


def position_batch(t, x, p, out=None):
    """Inertial components of the position vector. Batch form."""
    x_value, y, z, x_dot, y_dot, z_dot = x
    n, R, mu = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, *p))
    n_t = n*t
    cos_n_t = np.cos(n_t)
    sin_n_t = np.sin(n_t)
    out[0] = cos_n_t*x_value - sin_n_t*y
    out[1] = cos_n_t*y + sin_n_t*x_value
    out[2] = z
    return out
