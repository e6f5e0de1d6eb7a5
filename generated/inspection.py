"""Rendezvous via an inspection point.

Written by satsym from derivations/examples/inspection.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/inspection.py
Source: ../derivations/examples/inspection.py ba3a62cd9ac7fd6d92bf3bb30bc2d1d5
Source: ../derivations/clohessy_wiltshire.py 76e49da5527c6e0ad02437036b6b61bc
Source: ../derivations/polar_orbit.py cbc2ab9efa60b232bc9a9d755c4231e3
Digest: 8d3465e61076b06ed87fd5de77323e15c6e705fd6173591be0057ded8b12cef2
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'inspection',
    'title': 'Rendezvous via an inspection point',
    'source': 'derivations/examples/inspection.py',
    'states': (
        {'symbol': 'x1', 'latex': 'x_1', 'unit': 'km', 'meaning': 'deviation of the distance from the centre of force'},
        {'symbol': 'x2', 'latex': 'x_2', 'unit': 'km/s', 'meaning': 'deviation of the radial velocity'},
        {'symbol': 'x3', 'latex': 'x_3', 'unit': 'km', 'meaning': 'deviation of the angle, as a length along the reference orbit'},
        {'symbol': 'x4', 'latex': 'x_4', 'unit': 'km/s', 'meaning': 'deviation of the angular velocity, as a velocity along the reference orbit'},
    ),
    'controls': (
        {'symbol': 'u1', 'latex': 'u_1', 'unit': 'km/s**2', 'meaning': 'radial thrust per unit mass'},
        {'symbol': 'u2', 'latex': 'u_2', 'unit': 'km/s**2', 'meaning': 'transverse thrust per unit mass'},
    ),
    'parameters': (
        {'symbol': 'sigma', 'latex': '\\sigma', 'unit': 'km', 'meaning': 'radius of the reference orbit', 'default': 1.0, 'positive': True},
        {'symbol': 'omega', 'latex': '\\omega', 'unit': 'rad/s', 'meaning': 'angular velocity of the reference orbit', 'default': 1.0, 'positive': True},
        {'symbol': 'above', 'latex': 'a', 'unit': 'km', 'meaning': 'height of the point above the orbit'},
        {'symbol': 'ahead', 'latex': 'b', 'unit': 'km', 'meaning': 'distance of the point ahead, along the orbit'},
    ),
    'control_set': 'box',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'objective_unit': 'km**2/s**3',
    'path_constraints': (
        {'name': 'u1_min', 'order': 0},
        {'name': 'u2_min', 'order': 0},
        {'name': 'u1_max', 'order': 0},
        {'name': 'u2_max', 'order': 0},
    ),
    'interior': (
        {'name': 'viewpoint', 'conditions': 2},
    ),
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    return (
        x2,
        3.0*omega_sq*x1 + twice_omega*x4 + u1,
        x4,
        u2 - twice_omega*x2,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        3.0*omega_sq,
        0.0,
        0.0,
        twice_omega,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        -twice_omega,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    return (
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    return 0.5*u1*u1 + 0.5*u2*u2


def terminal_cost(t, x, p):
    """Terminal cost S."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    return lambda_x1*x2 + lambda_x2*(3.0*omega_sq*x1 + twice_omega*x4 + u1) + lambda_x3*x4 + lambda_x4*(u2 - twice_omega*x2) + 0.5*u1*u1 + 0.5*u2*u2


def stationarity(t, x, u, lam, p):
    """H_u."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    return (
        lambda_x2 + u1,
        lambda_x4 + u2,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    return (
        1.0,
        0.0,
        0.0,
        1.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    w = -lambda_x2
    u1 = u1_min if w < u1_min else u1_max if w > u1_max else w
    w_2 = -lambda_x4
    u2 = u2_min if w_2 < u2_min else u2_max if w_2 > u2_max else w_2
    return (
        u1,
        u2,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    omega_sq = omega*omega
    return (
        -3.0*lambda_x2*omega_sq,
        2.0*lambda_x4*omega - lambda_x1,
        0.0,
        -2.0*lambda_x2*omega - lambda_x3,
    )


def path_constraints(t, x, u, p, bounds):
    """What may not be positive along the way."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    return (
        u1_min - u1,
        u2_min - u2,
        u1 - u1_max,
        u2 - u2_max,
    )


def path_gradient(t, x, u, p):
    """Its derivatives by the states, row by row."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
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
    )


def path_effect(t, x, u, p):
    """Its derivatives by the controls, row by row."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    return (
        -1.0,
        0.0,
        0.0,
        -1.0,
        1.0,
        0.0,
        0.0,
        1.0,
    )


def path_rates(t, x, u, p):
    """Its first and second rates of change; 0 for those after the control."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
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


def path_vanishing(t, x, u, lam, p, bounds):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    return (
        lambda_x2 + u1_min,
        0.0,
        lambda_x4 + u2_min,
        0.0,
        -lambda_x2 - u1_max,
        0.0,
        -lambda_x4 - u2_max,
        0.0,
    )


def path_multiplier(t, x, u, lam, p, bounds):
    """The multiplier of each while it is on its boundary."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    return (
        lambda_x2 + u1_min,
        lambda_x4 + u2_min,
        -lambda_x2 - u1_max,
        -lambda_x4 - u2_max,
    )


def boundary_control(t, x, lam, p, bounds):
    """The controls on the boundary of each, row by row."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    w = -lambda_x4
    w_2 = -lambda_x2
    return (
        u1_min,
        w,
        w_2,
        u2_min,
        u1_max,
        w,
        w_2,
        u2_max,
    )


def interior(t, x, p):
    """What vanishes at waypoints, those of the first one first."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
    return (
        x1 - above,
        x3 - ahead,
    )


def interior_gradient(t, x, p):
    """Its derivatives by the states, row by row."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
    return (
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
    )


def interior_drift(t, x, p):
    """Its derivatives by time."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
    return (
        0.0,
        0.0,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    w = -lambda_x2
    w_2 = u1_min if w < u1_min else u1_max if w > u1_max else w
    twice_omega = 2.0*omega
    omega_sq = omega*omega
    w_3 = 3.0*omega_sq
    w_4 = -lambda_x4
    w_5 = u2_min if w_4 < u2_min else u2_max if w_4 > u2_max else w_4
    return (
        x2,
        twice_omega*x4 + w_2 + w_3*x1,
        x4,
        w_5 - twice_omega*x2,
        -lambda_x2*w_3,
        2.0*lambda_x4*omega - lambda_x1,
        0.0,
        -lambda_x2*twice_omega - lambda_x3,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    omega_sq = omega*omega
    w = 3.0*omega_sq
    twice_omega = 2.0*omega
    w_2 = -lambda_x2
    w_3 = 0.0 if w_2 < u1_min else 0.0 if w_2 > u1_max else 1.0
    w_4 = -twice_omega
    w_5 = -lambda_x4
    w_6 = 0.0 if w_5 < u2_min else 0.0 if w_5 > u2_max else 1.0
    return (
        0.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        w,
        0.0,
        0.0,
        twice_omega,
        0.0,
        -w_3,
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
        w_4,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -w_6,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -w,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        0.0,
        0.0,
        twice_omega,
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
        w_4,
        -1.0,
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
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
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    given_x1, given_x2, given_x3, given_x4, on_reference_x1, on_reference_x2, on_reference_x3, on_reference_x4, target_x1, target_x2, target_x3, target_x4 = final
    w = -lambda_x2
    w_2 = u1_min if w < u1_min else u1_max if w > u1_max else w
    w_3 = -lambda_x4
    w_4 = u2_min if w_3 < u2_min else u2_max if w_3 > u2_max else w_3
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    return (
        given_x1*(x1 - target_x1) + lambda_x1*(1.0 - given_x1 - on_reference_x1) + on_reference_x1*x1,
        given_x2*(x2 - target_x2) + lambda_x2*(1.0 - given_x2 - on_reference_x2) + on_reference_x2*x2,
        given_x3*(x3 - target_x3) + lambda_x3*(1.0 - given_x3 - on_reference_x3) + on_reference_x3*x3,
        given_x4*(x4 - target_x4) + lambda_x4*(1.0 - given_x4 - on_reference_x4) + on_reference_x4*x4,
        lambda_x1*x2 + lambda_x2*(3.0*omega_sq*x1 + twice_omega*x4 + w_2) + lambda_x3*x4 + lambda_x4*(w_4 - twice_omega*x2) + 0.5*w_2*w_2 + 0.5*w_4*w_4,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    given_x1, given_x2, given_x3, given_x4, on_reference_x1, on_reference_x2, on_reference_x3, on_reference_x4, target_x1, target_x2, target_x3, target_x4 = final
    w = given_x1 + on_reference_x1
    w_2 = given_x2 + on_reference_x2
    w_3 = given_x3 + on_reference_x3
    w_4 = given_x4 + on_reference_x4
    omega_sq = omega*omega
    w_5 = 3.0*omega_sq
    twice_omega = 2.0*omega
    w_6 = -lambda_x2
    w_7 = 0.0 if w_6 < u1_min else 0.0 if w_6 > u1_max else 1.0
    w_8 = u1_min if w_6 < u1_min else u1_max if w_6 > u1_max else w_6
    w_9 = -lambda_x4
    w_10 = 0.0 if w_9 < u2_min else 0.0 if w_9 > u2_max else 1.0
    w_11 = u2_min if w_9 < u2_min else u2_max if w_9 > u2_max else w_9
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
        lambda_x2*w_5,
        lambda_x1 - lambda_x4*twice_omega,
        0.0,
        lambda_x2*twice_omega + lambda_x3,
        x2,
        twice_omega*x4 + w_5*x1 + w_8 - lambda_x2*w_7 - w_7*w_8,
        x4,
        w_11 - lambda_x4*w_10 - twice_omega*x2 - w_10*w_11,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    sigma, omega, above, ahead = p
    x1_at, x2_at, x3_at, x4_at = x
    x1_mid, x2_mid, x3_mid, x4_mid = x_mid
    u1_at, u2_at = u
    u1_mid, u2_mid = u_mid
    x1, x2, x3, x4 = x0
    twice_omega = 2.0*omega
    omega_sq = omega*omega
    w = 3.0*omega_sq
    steps = len(times) - 1
    t = times[0]
    x1_at[0] = x1
    x2_at[0] = x2
    x3_at[0] = x3
    x4_at[0] = x4
    u1 = u1_at[0]
    u2 = u2_at[0]
    slope_x2 = twice_omega*x4 + u1 + w*x1
    slope_x4 = u2 - twice_omega*x2
    slope_total = 0.5*u1*u1 + 0.5*u2*u2
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x1_at[i] = x1
        x2_at[i] = x2
        x3_at[i] = x3
        x4_at[i] = x4
        u1_half = u1_mid[i]
        u1_end = u1_at[i + 1]
        u2_half = u2_mid[i]
        u2_end = u2_at[i + 1]
        half = 0.5*h
        sixth = (1.0/6.0)*h
        x1_2 = half*x2 + x1
        x2_2 = half*slope_x2 + x2
        x4_2 = half*slope_x4 + x4
        k2_x2 = twice_omega*x4_2 + u1_half + w*x1_2
        k2_x4 = u2_half - twice_omega*x2_2
        k2_total = 0.5*u1_half*u1_half + 0.5*u2_half*u2_half
        x1_3 = half*x2_2 + x1
        x2_3 = half*k2_x2 + x2
        x4_3 = half*k2_x4 + x4
        k3_x2 = twice_omega*x4_3 + u1_half + w*x1_3
        k3_x4 = u2_half - twice_omega*x2_3
        x1_4 = h*x2_3 + x1
        x2_4 = h*k3_x2 + x2
        x4_4 = h*k3_x4 + x4
        k4_x2 = twice_omega*x4_4 + u1_end + w*x1_4
        k4_x4 = u2_end - twice_omega*x2_4
        k4_total = 0.5*u1_end*u1_end + 0.5*u2_end*u2_end
        k23_x2 = k2_x2 + k3_x2
        k123_x2 = k23_x2 + slope_x2
        k23_x4 = k2_x4 + k3_x4
        k123_x4 = k23_x4 + slope_x4
        x1_end = h*(k123_x2*sixth + x2) + x1
        x2_end = sixth*(k123_x2 + k23_x2 + k4_x2) + x2
        x3_end = h*(k123_x4*sixth + x4) + x3
        x4_end = sixth*(k123_x4 + k23_x4 + k4_x4) + x4
        slope_end_x2 = twice_omega*x4_end + u1_end + w*x1_end
        slope_end_x4 = u2_end - twice_omega*x2_end
        eighth = 0.125*h
        x1_mid[i] = eighth*(x2 - x2_end) + 0.5*(x1 + x1_end)
        x2_mid[i] = eighth*(slope_x2 - slope_end_x2) + 0.5*(x2 + x2_end)
        x3_mid[i] = eighth*(x4 - x4_end) + 0.5*(x3 + x3_end)
        x4_mid[i] = eighth*(slope_x4 - slope_end_x4) + 0.5*(x4 + x4_end)
        total = sixth*(4.0*k2_total + k4_total + slope_total) + total
        t = t_end
        x1 = x1_end
        x2 = x2_end
        x3 = x3_end
        x4 = x4_end
        slope_x2 = slope_end_x2
        slope_x4 = slope_end_x4
        slope_total = k4_total
    x1_at[steps] = x1
    x2_at[steps] = x2
    x3_at[steps] = x3
    x4_at[steps] = x4
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    sigma, omega, above, ahead = p
    lambda_x1_at, lambda_x2_at, lambda_x3_at, lambda_x4_at = lam
    lambda_x1_mid, lambda_x2_mid, lambda_x3_mid, lambda_x4_mid = lam_mid
    x1_at, x2_at, x3_at, x4_at = x
    u1_at, u2_at = u
    x1_mid, x2_mid, x3_mid, x4_mid = x_mid
    u1_mid, u2_mid = u_mid
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam_f
    omega_sq = omega*omega
    w = 3.0*omega_sq
    twice_omega = 2.0*omega
    steps = len(times) - 1
    t = times[steps]
    lambda_x1_at[steps] = lambda_x1
    lambda_x2_at[steps] = lambda_x2
    lambda_x3_at[steps] = lambda_x3
    lambda_x4_at[steps] = lambda_x4
    slope_lambda_x1 = -lambda_x2*w
    slope_lambda_x2 = lambda_x4*twice_omega - lambda_x1
    slope_lambda_x4 = -lambda_x2*twice_omega - lambda_x3
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        half = 0.5*h
        sixth = (1.0/6.0)*h
        lambda_x1_2 = half*slope_lambda_x1 + lambda_x1
        lambda_x2_2 = half*slope_lambda_x2 + lambda_x2
        lambda_x4_2 = half*slope_lambda_x4 + lambda_x4
        k2_lambda_x1 = -lambda_x2_2*w
        k2_lambda_x2 = lambda_x4_2*twice_omega - lambda_x1_2
        k2_lambda_x4 = -lambda_x2_2*twice_omega - lambda_x3
        lambda_x1_3 = half*k2_lambda_x1 + lambda_x1
        lambda_x2_3 = half*k2_lambda_x2 + lambda_x2
        lambda_x4_3 = half*k2_lambda_x4 + lambda_x4
        k3_lambda_x1 = -lambda_x2_3*w
        k3_lambda_x2 = lambda_x4_3*twice_omega - lambda_x1_3
        k3_lambda_x4 = -lambda_x2_3*twice_omega - lambda_x3
        lambda_x1_4 = h*k3_lambda_x1 + lambda_x1
        lambda_x2_4 = h*k3_lambda_x2 + lambda_x2
        lambda_x4_4 = h*k3_lambda_x4 + lambda_x4
        k4_lambda_x1 = -lambda_x2_4*w
        k4_lambda_x2 = lambda_x4_4*twice_omega - lambda_x1_4
        k4_lambda_x4 = -lambda_x2_4*twice_omega - lambda_x3
        lambda_x1_end = lambda_x1 + sixth*(k4_lambda_x1 + slope_lambda_x1 + 2.0*(k2_lambda_x1 + k3_lambda_x1))
        lambda_x2_end = lambda_x2 + sixth*(k4_lambda_x2 + slope_lambda_x2 + 2.0*(k2_lambda_x2 + k3_lambda_x2))
        lambda_x4_end = lambda_x4 + sixth*(k4_lambda_x4 + slope_lambda_x4 + 2.0*(k2_lambda_x4 + k3_lambda_x4))
        slope_end_lambda_x1 = -lambda_x2_end*w
        slope_end_lambda_x2 = lambda_x4_end*twice_omega - lambda_x1_end
        slope_end_lambda_x4 = -lambda_x2_end*twice_omega - lambda_x3
        eighth = 0.125*h
        lambda_x1_mid[i] = eighth*(slope_lambda_x1 - slope_end_lambda_x1) + 0.5*(lambda_x1 + lambda_x1_end)
        lambda_x1_at[i] = lambda_x1_end
        lambda_x2_mid[i] = eighth*(slope_lambda_x2 - slope_end_lambda_x2) + 0.5*(lambda_x2 + lambda_x2_end)
        lambda_x2_at[i] = lambda_x2_end
        lambda_x3_mid[i] = lambda_x3
        lambda_x3_at[i] = lambda_x3
        lambda_x4_mid[i] = eighth*(slope_lambda_x4 - slope_end_lambda_x4) + 0.5*(lambda_x4 + lambda_x4_end)
        lambda_x4_at[i] = lambda_x4_end
        t = t_end
        lambda_x1 = lambda_x1_end
        lambda_x2 = lambda_x2_end
        lambda_x4 = lambda_x4_end
        slope_lambda_x1 = slope_end_lambda_x1
        slope_lambda_x2 = slope_end_lambda_x2
        slope_lambda_x4 = slope_end_lambda_x4


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[0] = x2
    out[1] = 3.0*omega_sq*x1 + twice_omega*x4 + u1
    out[2] = x4
    out[3] = u2 - twice_omega*x2
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[0, 1] = 1.0
    out[1, 0] = 3.0*omega_sq
    out[1, 3] = twice_omega
    out[2, 3] = 1.0
    out[3, 1] = -twice_omega
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[1, 0] = 1.0
    out[3, 1] = 1.0
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.5*u1*u1 + 0.5*u2*u2
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
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
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[...] = lambda_x1*x2 + lambda_x2*(3.0*omega_sq*x1 + twice_omega*x4 + u1) + lambda_x3*x4 + lambda_x4*(u2 - twice_omega*x2) + 0.5*u1*u1 + 0.5*u2*u2
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = lambda_x2 + u1
    out[1] = lambda_x4 + u2
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
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
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -lambda_x2
    u1 = np.minimum(np.maximum(w, u1_min), u1_max)
    w_2 = -lambda_x4
    u2 = np.minimum(np.maximum(w_2, u2_min), u2_max)
    out[0] = u1
    out[1] = u2
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, lam, *p))
    omega_sq = omega*omega
    out[0] = -3.0*lambda_x2*omega_sq
    out[1] = 2.0*lambda_x4*omega - lambda_x1
    out[2] = 0.0
    out[3] = -2.0*lambda_x2*omega - lambda_x3
    return out


def path_constraints_batch(t, x, u, p, bounds, out=None):
    """What may not be positive along the way. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p, *bounds))
    out[0] = u1_min - u1
    out[1] = u2_min - u2
    out[2] = u1 - u1_max
    out[3] = u2 - u2_max
    return out


def path_gradient_batch(t, x, u, p, out=None):
    """Its derivatives by the states, row by row. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def path_effect_batch(t, x, u, p, out=None):
    """Its derivatives by the controls, row by row. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, x, u, *p))
    out[0, 0] = -1.0
    out[0, 1] = 0.0
    out[1, 0] = 0.0
    out[1, 1] = -1.0
    out[2, 0] = 1.0
    out[2, 1] = 0.0
    out[3, 0] = 0.0
    out[3, 1] = 1.0
    return out


def path_rates_batch(t, x, u, p, out=None):
    """Its first and second rates of change; 0 for those after the control. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def path_vanishing_batch(t, x, u, lam, p, bounds, out=None):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    out[0, 0] = lambda_x2 + u1_min
    out[0, 1] = 0.0
    out[1, 0] = lambda_x4 + u2_min
    out[1, 1] = 0.0
    out[2, 0] = -lambda_x2 - u1_max
    out[2, 1] = 0.0
    out[3, 0] = -lambda_x4 - u2_max
    out[3, 1] = 0.0
    return out


def path_multiplier_batch(t, x, u, lam, p, bounds, out=None):
    """The multiplier of each while it is on its boundary. Batch form."""
    x1, x2, x3, x4 = x
    u1, u2 = u
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    out[0] = lambda_x2 + u1_min
    out[1] = lambda_x4 + u2_min
    out[2] = -lambda_x2 - u1_max
    out[3] = -lambda_x4 - u2_max
    return out


def boundary_control_batch(t, x, lam, p, bounds, out=None):
    """The controls on the boundary of each, row by row. Batch form."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -lambda_x4
    w_2 = -lambda_x2
    out[0, 0] = u1_min
    out[0, 1] = w
    out[1, 0] = w_2
    out[1, 1] = u2_min
    out[2, 0] = u1_max
    out[2, 1] = w
    out[3, 0] = w_2
    out[3, 1] = u2_max
    return out


def interior_batch(t, x, p, out=None):
    """What vanishes at waypoints, those of the first one first. Batch form."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = x1 - above
    out[1] = x3 - ahead
    return out


def interior_gradient_batch(t, x, p, out=None):
    """Its derivatives by the states, row by row. Batch form."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, 4, *shape), np.result_type(float, t, x, *p))
    out[...] = 0.0
    out[0, 0] = 1.0
    out[1, 2] = 1.0
    return out


def interior_drift_batch(t, x, p, out=None):
    """Its derivatives by time. Batch form."""
    x1, x2, x3, x4 = x
    sigma, omega, above, ahead = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -lambda_x2
    w_2 = np.minimum(np.maximum(w, u1_min), u1_max)
    twice_omega = 2.0*omega
    omega_sq = omega*omega
    w_3 = 3.0*omega_sq
    w_4 = -lambda_x4
    w_5 = np.minimum(np.maximum(w_4, u2_min), u2_max)
    out[0] = x2
    out[1] = twice_omega*x4 + w_2 + w_3*x1
    out[2] = x4
    out[3] = w_5 - twice_omega*x2
    out[4] = -lambda_x2*w_3
    out[5] = 2.0*lambda_x4*omega - lambda_x1
    out[6] = 0.0
    out[7] = -lambda_x2*twice_omega - lambda_x3
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, 8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    omega_sq = omega*omega
    w = 3.0*omega_sq
    twice_omega = 2.0*omega
    w_2 = -lambda_x2
    w_3 = np.heaviside(w_2 - u1_min, 1.0)*np.heaviside(u1_max - w_2, 1.0)
    w_4 = -twice_omega
    w_5 = -lambda_x4
    w_6 = np.heaviside(w_5 - u2_min, 1.0)*np.heaviside(u2_max - w_5, 1.0)
    out[0, 1] = 1.0
    out[1, 0] = w
    out[1, 3] = twice_omega
    out[1, 5] = -w_3
    out[2, 3] = 1.0
    out[3, 1] = w_4
    out[3, 7] = -w_6
    out[4, 5] = -w
    out[5, 4] = -1.0
    out[5, 7] = twice_omega
    out[7, 5] = w_4
    out[7, 6] = -1.0
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
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
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    given_x1, given_x2, given_x3, given_x4, on_reference_x1, on_reference_x2, on_reference_x3, on_reference_x4, target_x1, target_x2, target_x3, target_x4 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = -lambda_x2
    w_2 = np.minimum(np.maximum(w, u1_min), u1_max)
    w_3 = -lambda_x4
    w_4 = np.minimum(np.maximum(w_3, u2_min), u2_max)
    omega_sq = omega*omega
    twice_omega = 2.0*omega
    out[0] = given_x1*(x1 - target_x1) + lambda_x1*(1.0 - given_x1 - on_reference_x1) + on_reference_x1*x1
    out[1] = given_x2*(x2 - target_x2) + lambda_x2*(1.0 - given_x2 - on_reference_x2) + on_reference_x2*x2
    out[2] = given_x3*(x3 - target_x3) + lambda_x3*(1.0 - given_x3 - on_reference_x3) + on_reference_x3*x3
    out[3] = given_x4*(x4 - target_x4) + lambda_x4*(1.0 - given_x4 - on_reference_x4) + on_reference_x4*x4
    out[4] = lambda_x1*x2 + lambda_x2*(3.0*omega_sq*x1 + twice_omega*x4 + w_2) + lambda_x3*x4 + lambda_x4*(w_4 - twice_omega*x2) + 0.5*w_2*w_2 + 0.5*w_4*w_4
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    x1, x2, x3, x4 = x
    lambda_x1, lambda_x2, lambda_x3, lambda_x4 = lam
    sigma, omega, above, ahead = p
    u1_min, u2_min, u1_max, u2_max = bounds
    given_x1, given_x2, given_x3, given_x4, on_reference_x1, on_reference_x2, on_reference_x3, on_reference_x4, target_x1, target_x2, target_x3, target_x4 = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, 9, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_x1 + on_reference_x1
    w_2 = given_x2 + on_reference_x2
    w_3 = given_x3 + on_reference_x3
    w_4 = given_x4 + on_reference_x4
    omega_sq = omega*omega
    w_5 = 3.0*omega_sq
    twice_omega = 2.0*omega
    w_6 = -lambda_x2
    w_7 = np.heaviside(w_6 - u1_min, 1.0)*np.heaviside(u1_max - w_6, 1.0)
    w_8 = np.minimum(np.maximum(w_6, u1_min), u1_max)
    w_9 = -lambda_x4
    w_10 = np.heaviside(w_9 - u2_min, 1.0)*np.heaviside(u2_max - w_9, 1.0)
    w_11 = np.minimum(np.maximum(w_9, u2_min), u2_max)
    out[0, 0] = w
    out[0, 4] = 1.0 - w
    out[1, 1] = w_2
    out[1, 5] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 6] = 1.0 - w_3
    out[3, 3] = w_4
    out[3, 7] = 1.0 - w_4
    out[4, 0] = lambda_x2*w_5
    out[4, 1] = lambda_x1 - lambda_x4*twice_omega
    out[4, 3] = lambda_x2*twice_omega + lambda_x3
    out[4, 4] = x2
    out[4, 5] = twice_omega*x4 + w_5*x1 + w_8 - lambda_x2*w_7 - w_7*w_8
    out[4, 6] = x4
    out[4, 7] = w_11 - lambda_x4*w_10 - twice_omega*x2 - w_10*w_11
    return out
