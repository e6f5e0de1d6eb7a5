"""Minimum-effort path around two circular obstacles.

Written by satsym from derivations/examples/obstacle.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/obstacle.py
Source: ../derivations/examples/obstacle.py e070ab0fce25a11a521eadd73bdc102d
Digest: b7d796c1584af482203301959acca24391292198b887b20e15170a3eb86f9333
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'obstacle',
    'title': 'Minimum-effort path around two circular obstacles',
    'source': 'derivations/examples/obstacle.py',
    'states': (
        {'symbol': 'x', 'latex': 'x', 'meaning': 'position in the direction of the target'},
        {'symbol': 'y', 'latex': 'y', 'meaning': 'position across that direction'},
        {'symbol': 'vx', 'latex': 'v_x', 'meaning': 'velocity in the direction of the target'},
        {'symbol': 'vy', 'latex': 'v_y', 'meaning': 'velocity across that direction'},
    ),
    'controls': (
        {'symbol': 'ux', 'latex': 'u_x', 'meaning': 'acceleration in the direction of the target'},
        {'symbol': 'uy', 'latex': 'u_y', 'meaning': 'acceleration across that direction'},
    ),
    'parameters': (
        {'symbol': 'x_1', 'latex': 'x_1', 'meaning': 'centre of the first disc, in the direction of the target', 'default': 0.3},
        {'symbol': 'y_1', 'latex': 'y_1', 'meaning': 'centre of the first disc, across that direction', 'default': -0.05},
        {'symbol': 'radius_1', 'latex': 'R_1', 'meaning': 'radius of the first disc', 'default': 0.2, 'positive': True},
        {'symbol': 'x_2', 'latex': 'x_2', 'meaning': 'centre of the second disc, in the direction of the target', 'default': 0.7},
        {'symbol': 'y_2', 'latex': 'y_2', 'meaning': 'centre of the second disc, across that direction', 'default': 0.1},
        {'symbol': 'radius_2', 'latex': 'R_2', 'meaning': 'radius of the second disc', 'default': 0.15, 'positive': True},
    ),
    'control_set': 'free',
    'has_cost': True,
    'has_terminal_cost': False,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'objective_unit': '1',
    'path_constraints': (
        {'name': 'first', 'order': 2},
        {'name': 'second', 'order': 2},
    ),
    'linear_quadratic': True,
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return (
        vx,
        vy,
        ux,
        uy,
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
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
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        0.0,
        1.0,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return 0.5*ux*ux + 0.5*uy*uy


def terminal_cost(t, x, p):
    """Terminal cost S."""
    x_value, y, vx, vy = x
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return 0.0


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    x_value, y, vx, vy = x
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return lambda_vx*ux + lambda_vy*uy + lambda_x*vx + lambda_y*vy + 0.5*ux*ux + 0.5*uy*uy


def stationarity(t, x, u, lam, p):
    """H_u."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return (
        lambda_vx + ux,
        lambda_vy + uy,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return (
        1.0,
        0.0,
        0.0,
        1.0,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return (
        -lambda_vx,
        -lambda_vy,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return (
        0.0,
        0.0,
        -lambda_x,
        -lambda_y,
    )


def path_constraints(t, x, u, p, bounds):
    """What may not be positive along the way."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    w = -x_value
    w_2 = -w - x_1
    w_3 = y - y_1
    w_4 = -w - x_2
    w_5 = y - y_2
    return (
        radius_1*radius_1 - w_2*w_2 - w_3*w_3,
        radius_2*radius_2 - w_4*w_4 - w_5*w_5,
    )


def path_gradient(t, x, u, p):
    """Its derivatives by the states, row by row."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    w = -2.0*x_value
    twice_y = 2.0*y
    return (
        w + 2.0*x_1,
        2.0*y_1 - twice_y,
        0.0,
        0.0,
        w + 2.0*x_2,
        2.0*y_2 - twice_y,
        0.0,
        0.0,
    )


def path_effect(t, x, u, p):
    """Its derivatives by the controls, row by row."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return (
        0.0,
        0.0,
        0.0,
        0.0,
    )


def path_rates(t, x, u, p):
    """Its first and second rates of change; 0 for those after the control."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    twice_vx = 2.0*vx
    twice_vy = 2.0*vy
    w = -twice_vx*x_value - twice_vy*y
    w_2 = -x_value
    twice_ux = 2.0*ux
    twice_uy = 2.0*uy
    w_3 = -2.0*vx*vx - 2.0*vy*vy
    return (
        twice_vx*x_1 + twice_vy*y_1 + w,
        twice_ux*(w_2 + x_1) + twice_uy*(y_1 - y) + w_3,
        twice_vx*x_2 + twice_vy*y_2 + w,
        twice_ux*(w_2 + x_2) + twice_uy*(y_2 - y) + w_3,
    )


def path_vanishing(t, x, u, lam, p, bounds):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    twice_lambda_vx = 2.0*lambda_vx
    twice_lambda_vy = 2.0*lambda_vy
    w = 2.0*vx*vx + 2.0*vy*vy - 2.0*lambda_vx*x_value - 2.0*lambda_vy*y
    twice_lambda_x = 2.0*lambda_x
    twice_lambda_y = 2.0*lambda_y
    w_2 = 6.0*lambda_vx*vx + 6.0*lambda_vy*vy - twice_lambda_x*x_value - twice_lambda_y*y
    return (
        -twice_lambda_vx*x_1 - twice_lambda_vy*y_1 - w,
        twice_lambda_x*x_1 + twice_lambda_y*y_1 + w_2,
        -twice_lambda_vx*x_2 - twice_lambda_vy*y_2 - w,
        twice_lambda_x*x_2 + twice_lambda_y*y_2 + w_2,
    )


def path_multiplier(t, x, u, lam, p, bounds):
    """The multiplier of each while it is on its boundary."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    twice_x_value = 2.0*x_value
    twice_y = 2.0*y
    w = x_value*x_value + y*y
    w_2 = w + x_1*x_1 + y_1*y_1 - twice_x_value*x_1 - twice_y*y_1
    inv_w_2 = 1.0/w_2
    w_3 = 1.5*lambda_vx*lambda_vx + 1.5*lambda_vy*lambda_vy + 2.0*lambda_x*vx + 2.0*lambda_y*vy
    w_4 = w + x_2*x_2 + y_2*y_2 - twice_x_value*x_2 - twice_y*y_2
    inv_w_4 = 1.0/w_4
    return (
        -inv_w_2*w_3,
        -inv_w_4*w_3,
    )


def boundary_control(t, x, lam, p, bounds):
    """The controls on the boundary of each, row by row."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    w = -x_value
    w_2 = w + x_1
    w_3 = -lambda_vx
    w_4 = y_1 - y
    w_5 = w_2*w_2 + w_4*w_4
    inv_w_5 = 1.0/w_5
    w_6 = vx*vx + vy*vy
    w_7 = inv_w_5*(lambda_vx*w_2 + lambda_vy*w_4 + w_6)
    w_8 = -lambda_vy
    w_9 = w + x_2
    w_10 = y_2 - y
    w_11 = w_10*w_10 + w_9*w_9
    inv_w_11 = 1.0/w_11
    w_12 = inv_w_11*(lambda_vx*w_9 + lambda_vy*w_10 + w_6)
    return (
        w_2*w_7 + w_3,
        w_4*w_7 + w_8,
        w_12*w_9 + w_3,
        w_10*w_12 + w_8,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    return (
        vx,
        vy,
        -lambda_vx,
        -lambda_vy,
        0.0,
        0.0,
        -lambda_x,
        -lambda_y,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
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
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
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
        -1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
        0.0,
        0.0,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
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
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    given_x, given_y, given_vx, given_vy, on_reference_x, on_reference_y, on_reference_vx, on_reference_vy, target_x, target_y, target_vx, target_vy = final
    return (
        given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value,
        given_y*(y - target_y) + lambda_y*(1.0 - given_y - on_reference_y) + on_reference_y*y,
        given_vx*(vx - target_vx) + lambda_vx*(1.0 - given_vx - on_reference_vx) + on_reference_vx*vx,
        given_vy*(vy - target_vy) + lambda_vy*(1.0 - given_vy - on_reference_vy) + on_reference_vy*vy,
        lambda_x*vx + lambda_y*vy - 0.5*lambda_vx*lambda_vx - 0.5*lambda_vy*lambda_vy,
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    given_x, given_y, given_vx, given_vy, on_reference_x, on_reference_y, on_reference_vx, on_reference_vy, target_x, target_y, target_vx, target_vy = final
    w = given_x + on_reference_x
    w_2 = given_y + on_reference_y
    w_3 = given_vx + on_reference_vx
    w_4 = given_vy + on_reference_vy
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
        0.0,
        lambda_x,
        lambda_y,
        vx,
        vy,
        -lambda_vx,
        -lambda_vy,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    x_value_at, y_at, vx_at, vy_at = x
    x_value_mid, y_mid, vx_mid, vy_mid = x_mid
    ux_at, uy_at = u
    ux_mid, uy_mid = u_mid
    x_value, y, vx, vy = x0
    steps = len(times) - 1
    t = times[0]
    x_value_at[0] = x_value
    y_at[0] = y
    vx_at[0] = vx
    vy_at[0] = vy
    ux = ux_at[0]
    uy = uy_at[0]
    slope_vx = ux
    slope_vy = uy
    slope_total = 0.5*ux*ux + 0.5*uy*uy
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h = t_end - t
        x_value_at[i] = x_value
        y_at[i] = y
        vx_at[i] = vx
        vy_at[i] = vy
        ux_half = ux_mid[i]
        ux_end = ux_at[i + 1]
        uy_half = uy_mid[i]
        uy_end = uy_at[i + 1]
        sixth = (1.0/6.0)*h
        k2_total = 0.5*ux_half*ux_half + 0.5*uy_half*uy_half
        k4_total = 0.5*ux_end*ux_end + 0.5*uy_end*uy_end
        k23_vx = 2.0*ux_half
        k123_vx = k23_vx + slope_vx
        k23_vy = 2.0*uy_half
        k123_vy = k23_vy + slope_vy
        x_value_end = h*(k123_vx*sixth + vx) + x_value
        y_end = h*(k123_vy*sixth + vy) + y
        vx_end = sixth*(k123_vx + k23_vx + ux_end) + vx
        vy_end = sixth*(k123_vy + k23_vy + uy_end) + vy
        eighth = 0.125*h
        x_value_mid[i] = eighth*(vx - vx_end) + 0.5*(x_value + x_value_end)
        y_mid[i] = eighth*(vy - vy_end) + 0.5*(y + y_end)
        vx_mid[i] = eighth*(slope_vx - ux_end) + 0.5*(vx + vx_end)
        vy_mid[i] = eighth*(slope_vy - uy_end) + 0.5*(vy + vy_end)
        total = sixth*(4.0*k2_total + k4_total + slope_total) + total
        t = t_end
        x_value = x_value_end
        y = y_end
        vx = vx_end
        vy = vy_end
        slope_vx = ux_end
        slope_vy = uy_end
        slope_total = k4_total
    x_value_at[steps] = x_value
    y_at[steps] = y
    vx_at[steps] = vx
    vy_at[steps] = vy
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    lambda_x_at, lambda_y_at, lambda_vx_at, lambda_vy_at = lam
    lambda_x_mid, lambda_y_mid, lambda_vx_mid, lambda_vy_mid = lam_mid
    x_value_at, y_at, vx_at, vy_at = x
    ux_at, uy_at = u
    x_value_mid, y_mid, vx_mid, vy_mid = x_mid
    ux_mid, uy_mid = u_mid
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam_f
    steps = len(times) - 1
    t = times[steps]
    lambda_x_at[steps] = lambda_x
    lambda_y_at[steps] = lambda_y
    lambda_vx_at[steps] = lambda_vx
    lambda_vy_at[steps] = lambda_vy
    slope_lambda_vx = -lambda_x
    slope_lambda_vy = -lambda_y
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h = t_end - t
        sixth = (1.0/6.0)*h
        k2_lambda_vx = -lambda_x
        k2_lambda_vy = -lambda_y
        lambda_vx_end = lambda_vx + sixth*(5.0*k2_lambda_vx + slope_lambda_vx)
        lambda_vy_end = lambda_vy + sixth*(5.0*k2_lambda_vy + slope_lambda_vy)
        eighth = 0.125*h
        lambda_x_mid[i] = lambda_x
        lambda_x_at[i] = lambda_x
        lambda_y_mid[i] = lambda_y
        lambda_y_at[i] = lambda_y
        lambda_vx_mid[i] = eighth*(slope_lambda_vx - k2_lambda_vx) + 0.5*(lambda_vx + lambda_vx_end)
        lambda_vx_at[i] = lambda_vx_end
        lambda_vy_mid[i] = eighth*(slope_lambda_vy - k2_lambda_vy) + 0.5*(lambda_vy + lambda_vy_end)
        lambda_vy_at[i] = lambda_vy_end
        t = t_end
        lambda_vx = lambda_vx_end
        lambda_vy = lambda_vy_end
        slope_lambda_vx = k2_lambda_vx
        slope_lambda_vy = k2_lambda_vy


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, *p))
    out[0] = vx
    out[1] = vy
    out[2] = ux
    out[3] = uy
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 4, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[0, 2] = 1.0
    out[1, 3] = 1.0
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((4, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    out[2, 0] = 1.0
    out[3, 1] = 1.0
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.5*ux*ux + 0.5*uy*uy
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    x_value, y, vx, vy = x
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = 0.0
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    x_value, y, vx, vy = x
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
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
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    out[...] = lambda_vx*ux + lambda_vy*uy + lambda_x*vx + lambda_y*vy + 0.5*ux*ux + 0.5*uy*uy
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = lambda_vx + ux
    out[1] = lambda_vy + uy
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
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
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = -lambda_vx
    out[1] = -lambda_vy
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((4, *shape), np.result_type(float, t, x, u, lam, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = -lambda_x
    out[3] = -lambda_y
    return out


def path_constraints_batch(t, x, u, p, bounds, out=None):
    """What may not be positive along the way. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, *p, *bounds))
    w = -x_value
    w_2 = -w - x_1
    w_3 = y - y_1
    w_4 = -w - x_2
    w_5 = y - y_2
    out[0] = radius_1*radius_1 - w_2*w_2 - w_3*w_3
    out[1] = radius_2*radius_2 - w_4*w_4 - w_5*w_5
    return out


def path_gradient_batch(t, x, u, p, out=None):
    """Its derivatives by the states, row by row. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 4, *shape), np.result_type(float, t, x, u, *p))
    w = -2.0*x_value
    twice_y = 2.0*y
    out[0, 0] = w + 2.0*x_1
    out[0, 1] = 2.0*y_1 - twice_y
    out[0, 2] = 0.0
    out[0, 3] = 0.0
    out[1, 0] = w + 2.0*x_2
    out[1, 1] = 2.0*y_2 - twice_y
    out[1, 2] = 0.0
    out[1, 3] = 0.0
    return out


def path_effect_batch(t, x, u, p, out=None):
    """Its derivatives by the controls, row by row. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def path_rates_batch(t, x, u, p, out=None):
    """Its first and second rates of change; 0 for those after the control. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, *p))
    twice_vx = 2.0*vx
    twice_vy = 2.0*vy
    w = -twice_vx*x_value - twice_vy*y
    w_2 = -x_value
    twice_ux = 2.0*ux
    twice_uy = 2.0*uy
    w_3 = -2.0*vx*vx - 2.0*vy*vy
    out[0, 0] = twice_vx*x_1 + twice_vy*y_1 + w
    out[0, 1] = twice_ux*(w_2 + x_1) + twice_uy*(y_1 - y) + w_3
    out[1, 0] = twice_vx*x_2 + twice_vy*y_2 + w
    out[1, 1] = twice_ux*(w_2 + x_2) + twice_uy*(y_2 - y) + w_3
    return out


def path_vanishing_batch(t, x, u, lam, p, bounds, out=None):
    """What vanishes besides on the boundary, or where it begins and ends, and its rate, row by row. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    twice_lambda_vx = 2.0*lambda_vx
    twice_lambda_vy = 2.0*lambda_vy
    w = 2.0*vx*vx + 2.0*vy*vy - 2.0*lambda_vx*x_value - 2.0*lambda_vy*y
    twice_lambda_x = 2.0*lambda_x
    twice_lambda_y = 2.0*lambda_y
    w_2 = 6.0*lambda_vx*vx + 6.0*lambda_vy*vy - twice_lambda_x*x_value - twice_lambda_y*y
    out[0, 0] = -twice_lambda_vx*x_1 - twice_lambda_vy*y_1 - w
    out[0, 1] = twice_lambda_x*x_1 + twice_lambda_y*y_1 + w_2
    out[1, 0] = -twice_lambda_vx*x_2 - twice_lambda_vy*y_2 - w
    out[1, 1] = twice_lambda_x*x_2 + twice_lambda_y*y_2 + w_2
    return out


def path_multiplier_batch(t, x, u, lam, p, bounds, out=None):
    """The multiplier of each while it is on its boundary. Batch form."""
    x_value, y, vx, vy = x
    ux, uy = u
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p, *bounds))
    twice_x_value = 2.0*x_value
    twice_y = 2.0*y
    w = x_value*x_value + y*y
    w_2 = w + x_1*x_1 + y_1*y_1 - twice_x_value*x_1 - twice_y*y_1
    inv_w_2 = 1.0/w_2
    w_3 = 1.5*lambda_vx*lambda_vx + 1.5*lambda_vy*lambda_vy + 2.0*lambda_x*vx + 2.0*lambda_y*vy
    w_4 = w + x_2*x_2 + y_2*y_2 - twice_x_value*x_2 - twice_y*y_2
    inv_w_4 = 1.0/w_4
    out[0] = -inv_w_2*w_3
    out[1] = -inv_w_4*w_3
    return out


def boundary_control_batch(t, x, lam, p, bounds, out=None):
    """The controls on the boundary of each, row by row. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    w = -x_value
    w_2 = w + x_1
    w_3 = -lambda_vx
    w_4 = y_1 - y
    w_5 = w_2*w_2 + w_4*w_4
    inv_w_5 = 1.0/w_5
    w_6 = vx*vx + vy*vy
    w_7 = inv_w_5*(lambda_vx*w_2 + lambda_vy*w_4 + w_6)
    w_8 = -lambda_vy
    w_9 = w + x_2
    w_10 = y_2 - y
    w_11 = w_10*w_10 + w_9*w_9
    inv_w_11 = 1.0/w_11
    w_12 = inv_w_11*(lambda_vx*w_9 + lambda_vy*w_10 + w_6)
    out[0, 0] = w_2*w_7 + w_3
    out[0, 1] = w_4*w_7 + w_8
    out[1, 0] = w_12*w_9 + w_3
    out[1, 1] = w_10*w_12 + w_8
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[0] = vx
    out[1] = vy
    out[2] = -lambda_vx
    out[3] = -lambda_vy
    out[4] = 0.0
    out[5] = 0.0
    out[6] = -lambda_x
    out[7] = -lambda_y
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((8, 8, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    out[...] = 0.0
    out[0, 2] = 1.0
    out[1, 3] = 1.0
    out[2, 6] = -1.0
    out[3, 7] = -1.0
    out[6, 4] = -1.0
    out[7, 5] = -1.0
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
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
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    given_x, given_y, given_vx, given_vy, on_reference_x, on_reference_y, on_reference_vx, on_reference_vy, target_x, target_y, target_vx, target_vy = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[0] = given_x*(x_value - target_x) + lambda_x*(1.0 - given_x - on_reference_x) + on_reference_x*x_value
    out[1] = given_y*(y - target_y) + lambda_y*(1.0 - given_y - on_reference_y) + on_reference_y*y
    out[2] = given_vx*(vx - target_vx) + lambda_vx*(1.0 - given_vx - on_reference_vx) + on_reference_vx*vx
    out[3] = given_vy*(vy - target_vy) + lambda_vy*(1.0 - given_vy - on_reference_vy) + on_reference_vy*vy
    out[4] = lambda_x*vx + lambda_y*vy - 0.5*lambda_vx*lambda_vx - 0.5*lambda_vy*lambda_vy
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    x_value, y, vx, vy = x
    lambda_x, lambda_y, lambda_vx, lambda_vy = lam
    x_1, y_1, radius_1, x_2, y_2, radius_2 = p
    given_x, given_y, given_vx, given_vy, on_reference_x, on_reference_y, on_reference_vx, on_reference_vy, target_x, target_y, target_vx, target_vy = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((5, 9, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_x + on_reference_x
    w_2 = given_y + on_reference_y
    w_3 = given_vx + on_reference_vx
    w_4 = given_vy + on_reference_vy
    out[0, 0] = w
    out[0, 4] = 1.0 - w
    out[1, 1] = w_2
    out[1, 5] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 6] = 1.0 - w_3
    out[3, 3] = w_4
    out[3, 7] = 1.0 - w_4
    out[4, 2] = lambda_x
    out[4, 3] = lambda_y
    out[4, 4] = vx
    out[4, 5] = vy
    out[4, 6] = -lambda_vx
    out[4, 7] = -lambda_vy
    return out
