"""Two-body motion in Cartesian coordinates.

Written by satsym from derivations/two_body.py. Do not edit: mend that file instead, then run
    satsym derive derivations/two_body.py
Source: ../derivations/two_body.py 94b397bdcfdda3df3d13fb950f54663c
Digest: 59b1408a229d4d3a941ffc6ce8a096fb5cabd6c64977b54cf0bd3e741698e0e5
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'two_body',
    'title': 'Two-body motion in Cartesian coordinates',
    'source': 'derivations/two_body.py',
    'states': (
        {'symbol': 'x', 'latex': 'x', 'unit': 'km', 'meaning': 'first component of the position'},
        {'symbol': 'y', 'latex': 'y', 'unit': 'km', 'meaning': 'second component of the position'},
        {'symbol': 'z', 'latex': 'z', 'unit': 'km', 'meaning': 'third component of the position'},
        {'symbol': 'v_x', 'latex': 'v_x', 'unit': 'km/s', 'meaning': 'first component of the velocity'},
        {'symbol': 'v_y', 'latex': 'v_y', 'unit': 'km/s', 'meaning': 'second component of the velocity'},
        {'symbol': 'v_z', 'latex': 'v_z', 'unit': 'km/s', 'meaning': 'third component of the velocity'},
    ),
    'controls': (
        {'symbol': 'a_x', 'latex': 'a_x', 'unit': 'km/s**2', 'meaning': 'thrust per unit mass along x'},
        {'symbol': 'a_y', 'latex': 'a_y', 'unit': 'km/s**2', 'meaning': 'thrust per unit mass along y'},
        {'symbol': 'a_z', 'latex': 'a_z', 'unit': 'km/s**2', 'meaning': 'thrust per unit mass along z'},
    ),
    'parameters': (
        {'symbol': 'mu', 'latex': '\\mu', 'unit': 'km**3/s**2', 'meaning': 'gravitational parameter of the central body', 'default': 1.0, 'positive': True},
    ),
    'control_set': None,
    'has_cost': False,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (
        {'symbol': 'energy', 'latex': '\\mathcal{E}', 'unit': 'km**2/s**2'},
        {'symbol': 'angular_momentum_x', 'latex': '\\ell_x', 'unit': 'km**2/s'},
        {'symbol': 'angular_momentum_y', 'latex': '\\ell_y', 'unit': 'km**2/s'},
        {'symbol': 'angular_momentum_z', 'latex': '\\ell_z', 'unit': 'km**2/s'},
    ),
    'position': (
        {'symbol': 'x', 'latex': 'x'},
        {'symbol': 'y', 'latex': 'y'},
        {'symbol': 'z', 'latex': 'z'},
    ),
    'multipliers': (),
    'keplerian': True,
    'coordinates': (
        'x',
        'y',
        'z',
    ),
    'velocities': (
        'v_x',
        'v_y',
        'v_z',
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x_value, y, z, v_x, v_y, v_z = x
    a_x, a_y, a_z = u
    (mu,) = p
    w = x_value*x_value + y*y + z*z
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = inv_sqrt_w*inv_sqrt_w*inv_sqrt_w*mu
    return (
        v_x,
        v_y,
        v_z,
        a_x - w_2*x_value,
        a_y - w_2*y,
        a_z - w_2*z,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x_value, y, z, v_x, v_y, v_z = x
    a_x, a_y, a_z = u
    (mu,) = p
    x_value_sq = x_value*x_value
    y_sq = y*y
    z_sq = z*z
    w = y_sq + z_sq
    w_2 = w + x_value_sq
    sqrt_w_2 = math.sqrt(w_2)
    inv_sqrt_w_2 = 1.0/sqrt_w_2
    inv_sqrt_w_2_sq = inv_sqrt_w_2*inv_sqrt_w_2
    w_3 = inv_sqrt_w_2*inv_sqrt_w_2_sq*inv_sqrt_w_2_sq*mu
    w_4 = 3.0*w_3*x_value
    w_4_y = w_4*y
    w_4_z = w_4*z
    w_5 = 3.0*w_3*y*z
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
        w_3*(2.0*x_value_sq - w),
        w_4_y,
        w_4_z,
        0.0,
        0.0,
        0.0,
        w_4_y,
        w_3*(2.0*y_sq - x_value_sq - z_sq),
        w_5,
        0.0,
        0.0,
        0.0,
        w_4_z,
        w_5,
        w_3*(2.0*z_sq - x_value_sq - y_sq),
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x_value, y, z, v_x, v_y, v_z = x
    a_x, a_y, a_z = u
    (mu,) = p
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
        1.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        1.0,
    )


def invariants(t, x, p):
    """What the uncontrolled motion keeps constant."""
    x_value, y, z, v_x, v_y, v_z = x
    (mu,) = p
    w = x_value*x_value + y*y + z*z
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    return (
        0.5*v_x*v_x + 0.5*v_y*v_y + 0.5*v_z*v_z - inv_sqrt_w*mu,
        v_z*y - v_y*z,
        v_x*z - v_z*x_value,
        v_y*x_value - v_x*y,
    )


def position(t, x, p):
    """Inertial components of the position vector."""
    x_value, y, z, v_x, v_y, v_z = x
    (mu,) = p
    return (
        x_value,
        y,
        z,
    )


def inertial_state(t, x, p):
    """Position and velocity along inertial axes, three numbers each, and the gravitational parameter."""
    x_value, y, z, v_x, v_y, v_z = x
    (mu,) = p
    return (
        x_value,
        y,
        z,
        v_x,
        v_y,
        v_z,
        mu,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]."""
    (mu,) = p
    x_value_at, y_at, z_at, v_x_at, v_y_at, v_z_at = x
    x_value_mid, y_mid, z_mid, v_x_mid, v_y_mid, v_z_mid = x_mid
    a_x_at, a_y_at, a_z_at = u
    a_x_mid, a_y_mid, a_z_mid = u_mid
    x_value, y, z, v_x, v_y, v_z = x0
    steps = len(times) - 1
    t = times[0]
    x_value_at[0] = x_value
    y_at[0] = y
    z_at[0] = z
    v_x_at[0] = v_x
    v_y_at[0] = v_y
    v_z_at[0] = v_z
    a_x = a_x_at[0]
    a_y = a_y_at[0]
    a_z = a_z_at[0]
    w = x_value*x_value + y*y + z*z
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = inv_sqrt_w*inv_sqrt_w*inv_sqrt_w*mu
    slope_v_x = a_x - w_2*x_value
    slope_v_y = a_y - w_2*y
    slope_v_z = a_z - w_2*z
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x_value_at[i] = x_value
        y_at[i] = y
        z_at[i] = z
        v_x_at[i] = v_x
        v_y_at[i] = v_y
        v_z_at[i] = v_z
        a_x_half = a_x_mid[i]
        a_x_end = a_x_at[i + 1]
        a_y_half = a_y_mid[i]
        a_y_end = a_y_at[i + 1]
        a_z_half = a_z_mid[i]
        a_z_end = a_z_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        x_value_2 = half*v_x + x_value
        y_2 = half*v_y + y
        z_2 = half*v_z + z
        v_x_2 = half*slope_v_x + v_x
        v_y_2 = half*slope_v_y + v_y
        v_z_2 = half*slope_v_z + v_z
        w_3 = x_value_2*x_value_2 + y_2*y_2 + z_2*z_2
        sqrt_w_3 = math.sqrt(w_3)
        inv_sqrt_w_3 = 1.0/sqrt_w_3
        w_4 = inv_sqrt_w_3*inv_sqrt_w_3*inv_sqrt_w_3*mu
        k2_v_x = a_x_half - w_4*x_value_2
        k2_v_y = a_y_half - w_4*y_2
        k2_v_z = a_z_half - w_4*z_2
        x_value_3 = half*v_x_2 + x_value
        y_3 = half*v_y_2 + y
        z_3 = half*v_z_2 + z
        v_x_3 = half*k2_v_x + v_x
        v_y_3 = half*k2_v_y + v_y
        v_z_3 = half*k2_v_z + v_z
        w_5 = x_value_3*x_value_3 + y_3*y_3 + z_3*z_3
        sqrt_w_5 = math.sqrt(w_5)
        inv_sqrt_w_5 = 1.0/sqrt_w_5
        w_6 = inv_sqrt_w_5*inv_sqrt_w_5*inv_sqrt_w_5*mu
        k3_v_x = a_x_half - w_6*x_value_3
        k3_v_y = a_y_half - w_6*y_3
        k3_v_z = a_z_half - w_6*z_3
        x_value_4 = h*v_x_3 + x_value
        y_4 = h*v_y_3 + y
        z_4 = h*v_z_3 + z
        w_7 = x_value_4*x_value_4 + y_4*y_4 + z_4*z_4
        sqrt_w_7 = math.sqrt(w_7)
        inv_sqrt_w_7 = 1.0/sqrt_w_7
        w_8 = inv_sqrt_w_7*inv_sqrt_w_7*inv_sqrt_w_7*mu
        k4_v_x = a_x_end - w_8*x_value_4
        k4_v_y = a_y_end - w_8*y_4
        k4_v_z = a_z_end - w_8*z_4
        k23_v_x = k2_v_x + k3_v_x
        k123_v_x = k23_v_x + slope_v_x
        k23_v_y = k2_v_y + k3_v_y
        k123_v_y = k23_v_y + slope_v_y
        k23_v_z = k2_v_z + k3_v_z
        k123_v_z = k23_v_z + slope_v_z
        x_value_end = h*(k123_v_x*sixth + v_x) + x_value
        y_end = h*(k123_v_y*sixth + v_y) + y
        z_end = h*(k123_v_z*sixth + v_z) + z
        v_x_end = sixth*(k123_v_x + k23_v_x + k4_v_x) + v_x
        v_y_end = sixth*(k123_v_y + k23_v_y + k4_v_y) + v_y
        v_z_end = sixth*(k123_v_z + k23_v_z + k4_v_z) + v_z
        w_9 = x_value_end*x_value_end + y_end*y_end + z_end*z_end
        sqrt_w_9 = math.sqrt(w_9)
        inv_sqrt_w_9 = 1.0/sqrt_w_9
        w_10 = inv_sqrt_w_9*inv_sqrt_w_9*inv_sqrt_w_9*mu
        slope_end_v_x = a_x_end - w_10*x_value_end
        slope_end_v_y = a_y_end - w_10*y_end
        slope_end_v_z = a_z_end - w_10*z_end
        eighth = 0.125*h
        x_value_mid[i] = eighth*(v_x - v_x_end) + 0.5*(x_value + x_value_end)
        y_mid[i] = eighth*(v_y - v_y_end) + 0.5*(y + y_end)
        z_mid[i] = eighth*(v_z - v_z_end) + 0.5*(z + z_end)
        v_x_mid[i] = eighth*(slope_v_x - slope_end_v_x) + 0.5*(v_x + v_x_end)
        v_y_mid[i] = eighth*(slope_v_y - slope_end_v_y) + 0.5*(v_y + v_y_end)
        v_z_mid[i] = eighth*(slope_v_z - slope_end_v_z) + 0.5*(v_z + v_z_end)
        t = t_end
        x_value = x_value_end
        y = y_end
        z = z_end
        v_x = v_x_end
        v_y = v_y_end
        v_z = v_z_end
        slope_v_x = slope_end_v_x
        slope_v_y = slope_end_v_y
        slope_v_z = slope_end_v_z
    x_value_at[steps] = x_value
    y_at[steps] = y
    z_at[steps] = z
    v_x_at[steps] = v_x
    v_y_at[steps] = v_y
    v_z_at[steps] = v_z


def symplectic(times, x0, p, x):
    """Kicks and drifts of sixth order over the nodes from x0 at times[0], without control."""
    (mu,) = p
    x_value_at, y_at, z_at, v_x_at, v_y_at, v_z_at = x
    x_value, y, z, v_x, v_y, v_z = x0
    steps = len(times) - 1
    t = times[0]
    x_value_at[0] = x_value
    y_at[0] = y
    z_at[0] = z
    v_x_at[0] = v_x
    v_y_at[0] = v_y
    v_z_at[0] = v_z
    w = x_value*x_value + y*y + z*z
    sqrt_w = math.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = inv_sqrt_w*inv_sqrt_w*inv_sqrt_w*mu
    slope_v_x = -w_2*x_value
    slope_v_y = -w_2*y
    slope_v_z = -w_2*z
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x_value_at[i] = x_value
        y_at[i] = y
        z_at[i] = z
        v_x_at[i] = v_x
        v_y_at[i] = v_y
        v_z_at[i] = v_z
        kick_1 = 0.0414649985182624*h
        v_x_1 = kick_1*slope_v_x + v_x
        v_y_1 = kick_1*slope_v_y + v_y
        v_z_1 = kick_1*slope_v_z + v_z
        drift_1 = 0.123229775946271*h
        x_value_1 = drift_1*v_x_1 + x_value
        y_1 = drift_1*v_y_1 + y
        z_1 = drift_1*v_z_1 + z
        w_3 = x_value_1*x_value_1 + y_1*y_1 + z_1*z_1
        sqrt_w_3 = math.sqrt(w_3)
        inv_sqrt_w_3 = 1.0/sqrt_w_3
        w_4 = inv_sqrt_w_3*inv_sqrt_w_3*inv_sqrt_w_3*mu
        a1_v_x = -w_4*x_value_1
        a1_v_y = -w_4*y_1
        a1_v_z = -w_4*z_1
        kick_2 = 0.198128671918067*h
        v_x_2 = a1_v_x*kick_2 + v_x_1
        v_y_2 = a1_v_y*kick_2 + v_y_1
        v_z_2 = a1_v_z*kick_2 + v_z_1
        drift_2 = 0.290553797799558*h
        x_value_2 = drift_2*v_x_2 + x_value_1
        y_2 = drift_2*v_y_2 + y_1
        z_2 = drift_2*v_z_2 + z_1
        w_5 = x_value_2*x_value_2 + y_2*y_2 + z_2*z_2
        sqrt_w_5 = math.sqrt(w_5)
        inv_sqrt_w_5 = 1.0/sqrt_w_5
        w_6 = inv_sqrt_w_5*inv_sqrt_w_5*inv_sqrt_w_5*mu
        a2_v_x = -w_6*x_value_2
        a2_v_y = -w_6*y_2
        a2_v_z = -w_6*z_2
        kick_3 = -0.0400061921041533*h
        v_x_3 = a2_v_x*kick_3 + v_x_2
        v_y_3 = a2_v_y*kick_3 + v_y_2
        v_z_3 = a2_v_z*kick_3 + v_z_2
        drift_3 = -0.127049212625417*h
        x_value_3 = drift_3*v_x_3 + x_value_2
        y_3 = drift_3*v_y_3 + y_2
        z_3 = drift_3*v_z_3 + z_2
        w_7 = x_value_3*x_value_3 + y_3*y_3 + z_3*z_3
        sqrt_w_7 = math.sqrt(w_7)
        inv_sqrt_w_7 = 1.0/sqrt_w_7
        w_8 = inv_sqrt_w_7*inv_sqrt_w_7*inv_sqrt_w_7*mu
        a3_v_x = -w_8*x_value_3
        a3_v_y = -w_8*y_3
        a3_v_z = -w_8*z_3
        kick_4 = 0.0752539843015807*h
        v_x_4 = a3_v_x*kick_4 + v_x_3
        v_y_4 = a3_v_y*kick_4 + v_y_3
        v_z_4 = a3_v_z*kick_4 + v_z_3
        drift_4 = -0.246331761062075*h
        x_value_4 = drift_4*v_x_4 + x_value_3
        y_4 = drift_4*v_y_4 + y_3
        z_4 = drift_4*v_z_4 + z_3
        w_9 = x_value_4*x_value_4 + y_4*y_4 + z_4*z_4
        sqrt_w_9 = math.sqrt(w_9)
        inv_sqrt_w_9 = 1.0/sqrt_w_9
        w_10 = inv_sqrt_w_9*inv_sqrt_w_9*inv_sqrt_w_9*mu
        a4_v_x = -w_10*x_value_4
        a4_v_y = -w_10*y_4
        a4_v_z = -w_10*z_4
        kick_5 = -0.0115113874206879*h
        v_x_5 = a4_v_x*kick_5 + v_x_4
        v_y_5 = a4_v_y*kick_5 + v_y_4
        v_z_5 = a4_v_z*kick_5 + v_z_4
        drift_5 = 0.357208872795928*h
        x_value_5 = drift_5*v_x_5 + x_value_4
        y_5 = drift_5*v_y_5 + y_4
        z_5 = drift_5*v_z_5 + z_4
        w_11 = x_value_5*x_value_5 + y_5*y_5 + z_5*z_5
        sqrt_w_11 = math.sqrt(w_11)
        inv_sqrt_w_11 = 1.0/sqrt_w_11
        w_12 = inv_sqrt_w_11*inv_sqrt_w_11*inv_sqrt_w_11*mu
        a5_v_x = -w_12*x_value_5
        a5_v_y = -w_12*y_5
        a5_v_z = -w_12*z_5
        kick_6 = 0.2366699247869311*h
        v_x_6 = a5_v_x*kick_6 + v_x_5
        v_y_6 = a5_v_y*kick_6 + v_y_5
        v_z_6 = a5_v_z*kick_6 + v_z_5
        drift_6 = 0.20477705429147*h
        x_value_6 = drift_6*v_x_6 + x_value_5
        y_6 = drift_6*v_y_6 + y_5
        z_6 = drift_6*v_z_6 + z_5
        w_13 = x_value_6*x_value_6 + y_6*y_6 + z_6*z_6
        sqrt_w_13 = math.sqrt(w_13)
        inv_sqrt_w_13 = 1.0/sqrt_w_13
        w_14 = inv_sqrt_w_13*inv_sqrt_w_13*inv_sqrt_w_13*mu
        a6_v_x = -w_14*x_value_6
        a6_v_y = -w_14*y_6
        a6_v_z = -w_14*z_6
        v_x_7 = a6_v_x*kick_6 + v_x_6
        v_y_7 = a6_v_y*kick_6 + v_y_6
        v_z_7 = a6_v_z*kick_6 + v_z_6
        x_value_7 = drift_5*v_x_7 + x_value_6
        y_7 = drift_5*v_y_7 + y_6
        z_7 = drift_5*v_z_7 + z_6
        w_15 = x_value_7*x_value_7 + y_7*y_7 + z_7*z_7
        sqrt_w_15 = math.sqrt(w_15)
        inv_sqrt_w_15 = 1.0/sqrt_w_15
        w_16 = inv_sqrt_w_15*inv_sqrt_w_15*inv_sqrt_w_15*mu
        a7_v_x = -w_16*x_value_7
        a7_v_y = -w_16*y_7
        a7_v_z = -w_16*z_7
        v_x_8 = a7_v_x*kick_5 + v_x_7
        v_y_8 = a7_v_y*kick_5 + v_y_7
        v_z_8 = a7_v_z*kick_5 + v_z_7
        x_value_8 = drift_4*v_x_8 + x_value_7
        y_8 = drift_4*v_y_8 + y_7
        z_8 = drift_4*v_z_8 + z_7
        w_17 = x_value_8*x_value_8 + y_8*y_8 + z_8*z_8
        sqrt_w_17 = math.sqrt(w_17)
        inv_sqrt_w_17 = 1.0/sqrt_w_17
        w_18 = inv_sqrt_w_17*inv_sqrt_w_17*inv_sqrt_w_17*mu
        a8_v_x = -w_18*x_value_8
        a8_v_y = -w_18*y_8
        a8_v_z = -w_18*z_8
        v_x_9 = a8_v_x*kick_4 + v_x_8
        v_y_9 = a8_v_y*kick_4 + v_y_8
        v_z_9 = a8_v_z*kick_4 + v_z_8
        x_value_9 = drift_3*v_x_9 + x_value_8
        y_9 = drift_3*v_y_9 + y_8
        z_9 = drift_3*v_z_9 + z_8
        w_19 = x_value_9*x_value_9 + y_9*y_9 + z_9*z_9
        sqrt_w_19 = math.sqrt(w_19)
        inv_sqrt_w_19 = 1.0/sqrt_w_19
        w_20 = inv_sqrt_w_19*inv_sqrt_w_19*inv_sqrt_w_19*mu
        a9_v_x = -w_20*x_value_9
        a9_v_y = -w_20*y_9
        a9_v_z = -w_20*z_9
        v_x_10 = a9_v_x*kick_3 + v_x_9
        v_y_10 = a9_v_y*kick_3 + v_y_9
        v_z_10 = a9_v_z*kick_3 + v_z_9
        x_value_10 = drift_2*v_x_10 + x_value_9
        y_10 = drift_2*v_y_10 + y_9
        z_10 = drift_2*v_z_10 + z_9
        w_21 = x_value_10*x_value_10 + y_10*y_10 + z_10*z_10
        sqrt_w_21 = math.sqrt(w_21)
        inv_sqrt_w_21 = 1.0/sqrt_w_21
        w_22 = inv_sqrt_w_21*inv_sqrt_w_21*inv_sqrt_w_21*mu
        a10_v_x = -w_22*x_value_10
        a10_v_y = -w_22*y_10
        a10_v_z = -w_22*z_10
        v_x_11 = a10_v_x*kick_2 + v_x_10
        v_y_11 = a10_v_y*kick_2 + v_y_10
        v_z_11 = a10_v_z*kick_2 + v_z_10
        x_value_11 = drift_1*v_x_11 + x_value_10
        y_11 = drift_1*v_y_11 + y_10
        z_11 = drift_1*v_z_11 + z_10
        w_23 = x_value_11*x_value_11 + y_11*y_11 + z_11*z_11
        sqrt_w_23 = math.sqrt(w_23)
        inv_sqrt_w_23 = 1.0/sqrt_w_23
        w_24 = inv_sqrt_w_23*inv_sqrt_w_23*inv_sqrt_w_23*mu
        a11_v_x = -w_24*x_value_11
        a11_v_y = -w_24*y_11
        a11_v_z = -w_24*z_11
        v_x_12 = a11_v_x*kick_1 + v_x_11
        v_y_12 = a11_v_y*kick_1 + v_y_11
        v_z_12 = a11_v_z*kick_1 + v_z_11
        t = t_end
        x_value = x_value_11
        y = y_11
        z = z_11
        v_x = v_x_12
        v_y = v_y_12
        v_z = v_z_12
        slope_v_x = a11_v_x
        slope_v_y = a11_v_y
        slope_v_z = a11_v_z
    x_value_at[steps] = x_value
    y_at[steps] = y
    z_at[steps] = z
    v_x_at[steps] = v_x
    v_y_at[steps] = v_y
    v_z_at[steps] = v_z


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x_value, y, z, v_x, v_y, v_z = x
    a_x, a_y, a_z = u
    (mu,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, u, *p))
    w = x_value*x_value + y*y + z*z
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    w_2 = inv_sqrt_w*inv_sqrt_w*inv_sqrt_w*mu
    out[0] = v_x
    out[1] = v_y
    out[2] = v_z
    out[3] = a_x - w_2*x_value
    out[4] = a_y - w_2*y
    out[5] = a_z - w_2*z
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x_value, y, z, v_x, v_y, v_z = x
    a_x, a_y, a_z = u
    (mu,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    x_value_sq = x_value*x_value
    y_sq = y*y
    z_sq = z*z
    w = y_sq + z_sq
    w_2 = w + x_value_sq
    sqrt_w_2 = np.sqrt(w_2)
    inv_sqrt_w_2 = 1.0/sqrt_w_2
    inv_sqrt_w_2_sq = inv_sqrt_w_2*inv_sqrt_w_2
    w_3 = inv_sqrt_w_2*inv_sqrt_w_2_sq*inv_sqrt_w_2_sq*mu
    w_4 = 3.0*w_3*x_value
    w_4_y = w_4*y
    w_4_z = w_4*z
    w_5 = 3.0*w_3*y*z
    out[0, 3] = 1.0
    out[1, 4] = 1.0
    out[2, 5] = 1.0
    out[3, 0] = w_3*(2.0*x_value_sq - w)
    out[3, 1] = w_4_y
    out[3, 2] = w_4_z
    out[4, 0] = w_4_y
    out[4, 1] = w_3*(2.0*y_sq - x_value_sq - z_sq)
    out[4, 2] = w_5
    out[5, 0] = w_4_z
    out[5, 1] = w_5
    out[5, 2] = w_3*(2.0*z_sq - x_value_sq - y_sq)
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x_value, y, z, v_x, v_y, v_z = x
    a_x, a_y, a_z = u
    (mu,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 3, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[3, 0] = 1.0
    out[4, 1] = 1.0
    out[5, 2] = 1.0
    return out


def invariants_batch(t, x, p, out=None):
    """What the uncontrolled motion keeps constant. Batch form."""
    x_value, y, z, v_x, v_y, v_z = x
    (mu,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, *p))
    w = x_value*x_value + y*y + z*z
    sqrt_w = np.sqrt(w)
    inv_sqrt_w = 1.0/sqrt_w
    out[0] = 0.5*v_x*v_x + 0.5*v_y*v_y + 0.5*v_z*v_z - inv_sqrt_w*mu
    out[1] = v_z*y - v_y*z
    out[2] = v_x*z - v_z*x_value
    out[3] = v_y*x_value - v_x*y
    return out


def position_batch(t, x, p, out=None):
    """Inertial components of the position vector. Batch form."""
    x_value, y, z, v_x, v_y, v_z = x
    (mu,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((3, *shape), np.result_type(float, t, x, *p))
    out[0] = x_value
    out[1] = y
    out[2] = z
    return out


def inertial_state_batch(t, x, p, out=None):
    """Position and velocity along inertial axes, three numbers each, and the gravitational parameter. Batch form."""
    x_value, y, z, v_x, v_y, v_z = x
    (mu,) = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((7, *shape), np.result_type(float, t, x, *p))
    out[0] = x_value
    out[1] = y
    out[2] = z
    out[3] = v_x
    out[4] = v_y
    out[5] = v_z
    out[6] = mu
    return out
