"""Space shuttle entry with maximum cross-range.

Written by satsym from derivations/examples/shuttle.py. Do not edit: mend that file instead, then run
    satsym derive derivations/examples/shuttle.py
Source: ../derivations/examples/shuttle.py e39c764e6c798ad3b528b4ebccadd7c0
Digest: fe0defb52e7acd9c34000c0ed095ac43c205e2b4637b78bd29bd350a98970f3d
"""

import math

import numpy as np


MODEL = {
    'format': 1,
    'name': 'shuttle',
    'title': 'Space shuttle entry with maximum cross-range',
    'source': 'derivations/examples/shuttle.py',
    'states': (
        {'symbol': 'h', 'latex': 'h', 'unit': 'ft', 'meaning': 'altitude', 'typical': (80000.0, 260000.0)},
        {'symbol': 'phi', 'latex': '\\phi', 'unit': 'rad', 'meaning': 'longitude', 'kind': 'angle', 'typical': (0.0, 1.0)},
        {'symbol': 'theta', 'latex': '\\theta', 'unit': 'rad', 'meaning': 'latitude', 'typical': (0.0, 1.0)},
        {'symbol': 'v', 'latex': 'v', 'unit': 'ft/s', 'meaning': 'speed', 'positive': True, 'typical': (2500.0, 26000.0)},
        {'symbol': 'gamma', 'latex': '\\gamma', 'unit': 'rad', 'meaning': 'flight-path angle', 'typical': (-0.1, 0.1)},
        {'symbol': 'psi', 'latex': '\\psi', 'unit': 'rad', 'meaning': 'azimuth', 'typical': (0.0, 1.6)},
    ),
    'controls': (
        {'symbol': 'alpha', 'latex': '\\alpha', 'unit': 'deg', 'meaning': 'angle of attack', 'typical': (0.0, 30.0)},
        {'symbol': 'beta', 'latex': '\\beta', 'unit': 'rad', 'meaning': 'bank angle', 'kind': 'angle'},
    ),
    'parameters': (
        {'symbol': 'mu', 'latex': '\\mu', 'unit': 'ft^3/s^2', 'meaning': 'gravitational parameter', 'default': 1.4076539e+16, 'positive': True},
        {'symbol': 'r_e', 'latex': 'r_e', 'unit': 'ft', 'meaning': 'radius of the Earth', 'default': 20902900.0, 'positive': True},
        {'symbol': 'rho_0', 'latex': '\\rho_0', 'unit': 'slug/ft^3', 'meaning': 'density at the ground', 'default': 0.002378, 'positive': True},
        {'symbol': 'h_r', 'latex': 'h_r', 'unit': 'ft', 'meaning': 'scale height', 'default': 23800.0, 'positive': True},
        {'symbol': 'area', 'latex': 'A_{\\mathrm{ref}}', 'unit': 'ft^2', 'meaning': 'reference area', 'default': 2690.0, 'positive': True},
        {'symbol': 'm', 'latex': 'm', 'unit': 'slug', 'meaning': 'mass', 'default': 6309.442406912414, 'positive': True},
        {'symbol': 'a_0', 'latex': 'a_0', 'meaning': 'lift coefficient at zero angle of attack', 'default': -0.20704},
        {'symbol': 'a_1', 'latex': 'a_1', 'unit': '1/deg', 'meaning': 'slope of the lift coefficient', 'default': 0.029244, 'positive': True},
        {'symbol': 'b_0', 'latex': 'b_0', 'meaning': 'drag coefficient at zero angle of attack', 'default': 0.07854, 'positive': True},
        {'symbol': 'b_1', 'latex': 'b_1', 'unit': '1/deg', 'meaning': 'slope of the drag coefficient at zero angle of attack', 'default': -0.0061592},
        {'symbol': 'b_2', 'latex': 'b_2', 'unit': '1/deg^2', 'meaning': 'quadratic coefficient of the drag', 'default': 0.000621408, 'positive': True},
    ),
    'control_set': 'product',
    'has_cost': True,
    'has_terminal_cost': True,
    'has_reference': False,
    'autonomous': True,
    'invariants': (),
    'position': (),
    'multipliers': (),
    'control_parts': (
        {'name': 'attack', 'kind': 'box', 'controls': ('alpha',), 'branch': 'stationary'},
        {'name': 'bank', 'kind': 'box', 'controls': ('beta',), 'branch': 'stationary'},
    ),
    'maximise': True,
    'objective_unit': '1',
}


def dynamics(t, x, u, p):
    """Rates of change of the states, f(t, x, u)."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    sin_gamma = math.sin(gamma)
    cos_theta = math.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    w = h + r_e
    inv_w = 1.0/w
    cos_gamma = math.cos(gamma)
    cos_gamma_inv_w_v = cos_gamma*inv_w*v
    w_2 = cos_gamma_inv_w_v*inv_cos_theta*math.sin(psi)
    w_3 = inv_w*inv_w*mu
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w_4 = 0.5*area*inv_m*rho_0*math.exp(-h*inv_h_r)
    inv_v = 1.0/v
    w_5 = v*w_4*(a_0 + a_1*alpha)
    inv_cos_gamma = 1.0/cos_gamma
    return (
        sin_gamma*v,
        w_2,
        cos_gamma_inv_w_v*math.cos(psi),
        -sin_gamma*w_3 - v*v*w_4*(alpha*alpha*b_2 + alpha*b_1 + b_0),
        cos_gamma*(inv_w*v - inv_v*w_3) + w_5*math.cos(beta),
        inv_cos_gamma*w_5*math.sin(beta) + w_2*math.sin(theta),
    )


def jacobian_x(t, x, u, p):
    """A = df/dx, row by row."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    sin_gamma = math.sin(gamma)
    cos_gamma = math.cos(gamma)
    cos_gamma_v = cos_gamma*v
    cos_theta = math.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    sin_psi = math.sin(psi)
    inv_cos_theta_sin_psi = inv_cos_theta*sin_psi
    w = h + r_e
    inv_w = 1.0/w
    inv_w_sq = inv_w*inv_w
    cos_gamma_v_inv_w_sq = cos_gamma_v*inv_w_sq
    sin_theta = math.sin(theta)
    cos_gamma_v_sin_psi = cos_gamma_v*sin_psi
    w_2 = cos_gamma_v_sin_psi*inv_w
    w_3 = inv_cos_theta*inv_cos_theta*w_2
    cos_gamma_inv_w = cos_gamma*inv_w
    sin_gamma_v = sin_gamma*v
    cos_psi = math.cos(psi)
    cos_psi_inv_w = cos_psi*inv_w
    w_4 = cos_gamma_v*cos_psi_inv_w*inv_cos_theta
    h_cubed = h*h*h
    r_e_cubed = r_e*r_e*r_e
    r_e_sq = r_e*r_e
    w_5 = 3.0*h*r_e_sq
    h_sq = h*h
    w_6 = 3.0*h_sq*r_e
    w_7 = h_cubed + r_e_cubed + w_5 + w_6
    inv_w_7 = 1.0/w_7
    inv_h_r = 1.0/h_r
    inv_m = 1.0/m
    w_8 = area*inv_m*rho_0*math.exp(-h*inv_h_r)
    half_w_8 = 0.5*w_8
    v_sq = v*v
    half_w_8_inv_h_r_v_sq = half_w_8*inv_h_r*v_sq
    alpha_b_1 = alpha*b_1
    w_9 = alpha*alpha*b_2
    v_w_8 = v*w_8
    cos_gamma_mu = cos_gamma*mu
    w_10 = h_cubed*v + r_e_cubed*v + v*w_5 + v*w_6
    inv_w_10 = 1.0/w_10
    twice_r_e = 2.0*r_e
    w_11 = h*twice_r_e + h_sq + r_e_sq
    inv_w_11 = 1.0/w_11
    cos_beta = math.cos(beta)
    w_12 = 0.5*inv_h_r*v_w_8
    cos_beta_w_12 = cos_beta*w_12
    a_1_alpha = a_1*alpha
    h_v_sq = h*v_sq
    w_13 = h_sq*v_sq + h_v_sq*twice_r_e + r_e_sq*v_sq
    inv_w_13 = 1.0/w_13
    cos_beta_half_w_8 = cos_beta*half_w_8
    inv_v = 1.0/v
    cos_theta_h = cos_theta*h
    w_14 = cos_theta*h_sq + cos_theta*r_e_sq + cos_theta_h*twice_r_e
    inv_w_14 = 1.0/w_14
    inv_cos_gamma = 1.0/cos_gamma
    sin_beta = math.sin(beta)
    inv_cos_gamma_sin_beta = inv_cos_gamma*sin_beta
    w_15 = inv_cos_gamma_sin_beta*w_12
    w_16 = cos_theta*r_e + cos_theta_h
    inv_w_16 = 1.0/w_16
    w_17 = inv_w_16*sin_psi*sin_theta
    w_18 = half_w_8*inv_cos_gamma_sin_beta
    w_19 = half_w_8*inv_cos_gamma*inv_cos_gamma*sin_beta*sin_gamma_v
    return (
        0.0,
        0.0,
        0.0,
        sin_gamma,
        cos_gamma_v,
        0.0,
        -cos_gamma_v_inv_w_sq*inv_cos_theta_sin_psi,
        0.0,
        sin_theta*w_3,
        cos_gamma_inv_w*inv_cos_theta_sin_psi,
        -inv_cos_theta_sin_psi*inv_w*sin_gamma_v,
        w_4,
        -cos_gamma_v_inv_w_sq*cos_psi,
        0.0,
        0.0,
        cos_gamma_inv_w*cos_psi,
        -cos_psi_inv_w*sin_gamma_v,
        -w_2,
        alpha_b_1*half_w_8_inv_h_r_v_sq + b_0*half_w_8_inv_h_r_v_sq + half_w_8_inv_h_r_v_sq*w_9 + 2.0*inv_w_7*mu*sin_gamma,
        0.0,
        0.0,
        -v_w_8*(alpha_b_1 + b_0 + w_9),
        -cos_gamma_mu*inv_w_sq,
        0.0,
        2.0*cos_gamma*inv_w_10*mu - a_0*cos_beta_w_12 - a_1_alpha*cos_beta_w_12 - cos_gamma_v*inv_w_11,
        0.0,
        0.0,
        a_0*cos_beta_half_w_8 + a_1_alpha*cos_beta_half_w_8 + cos_gamma_inv_w + cos_gamma_mu*inv_w_13,
        -inv_v*inv_w_sq*sin_gamma*(h_v_sq + r_e*v_sq - mu),
        0.0,
        -a_0*w_15 - a_1_alpha*w_15 - cos_gamma_v_sin_psi*inv_w_14*sin_theta,
        0.0,
        w_3*(cos_theta*cos_theta + sin_theta*sin_theta),
        a_0*w_18 + a_1_alpha*w_18 + cos_gamma*w_17,
        a_0*w_19 + a_1_alpha*w_19 - sin_gamma_v*w_17,
        sin_theta*w_4,
    )


def jacobian_u(t, x, u, p):
    """B = df/du, row by row."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w = 0.5*area*inv_m*rho_0*math.exp(-h*inv_h_r)
    cos_beta = math.cos(beta)
    v_w = v*w
    a_1_v_w = a_1*v_w
    sin_beta = math.sin(beta)
    w_2 = v_w*(a_0 + a_1*alpha)
    cos_gamma = math.cos(gamma)
    inv_cos_gamma = 1.0/cos_gamma
    return (
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -v*v*w*(2.0*alpha*b_2 + b_1),
        0.0,
        a_1_v_w*cos_beta,
        -sin_beta*w_2,
        a_1_v_w*inv_cos_gamma*sin_beta,
        cos_beta*inv_cos_gamma*w_2,
    )


def running_cost(t, x, u, p):
    """Integrand L of the cost."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    return 0.0


def terminal_cost(t, x, p):
    """Terminal cost S."""
    h, phi, theta, v, gamma, psi = x
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    return -theta


def terminal_gradient(t, x, p):
    """S_x: the costates at the final time where the final state is free."""
    h, phi, theta, v, gamma, psi = x
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    return (
        0.0,
        0.0,
        -1.0,
        0.0,
        0.0,
        0.0,
    )


def hamiltonian(t, x, u, lam, p):
    """H = L + lam' f."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    w = h + r_e
    inv_w = 1.0/w
    inv_v = 1.0/v
    cos_gamma = math.cos(gamma)
    inv_cos_gamma = 1.0/cos_gamma
    sin_gamma = math.sin(gamma)
    cos_gamma_inv_w_v = cos_gamma*inv_w*v
    cos_theta = math.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    w_2 = cos_gamma_inv_w_v*inv_cos_theta*math.sin(psi)
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w_3 = 0.5*area*inv_m*rho_0*math.exp(-h*inv_h_r)
    w_4 = v*w_3*(a_0 + a_1*alpha)
    w_5 = inv_w*inv_w*mu
    return cos_gamma_inv_w_v*lambda_theta*math.cos(psi) + lambda_gamma*(cos_gamma*(inv_w*v - inv_v*w_5) + w_4*math.cos(beta)) + lambda_h*sin_gamma*v + lambda_phi*w_2 + lambda_psi*(inv_cos_gamma*w_4*math.sin(beta) + w_2*math.sin(theta)) + lambda_v*(-sin_gamma*w_5 - v*v*w_3*(alpha*alpha*b_2 + alpha*b_1 + b_0))


def stationarity(t, x, u, lam, p):
    """H_u."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    cos_gamma = math.cos(gamma)
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w = area*inv_m*rho_0*math.exp(-h*inv_h_r)
    sin_beta = math.sin(beta)
    cos_beta = math.cos(beta)
    cos_gamma_lambda_gamma = cos_gamma*lambda_gamma
    inv_cos_gamma = 1.0/cos_gamma
    w_2 = 0.5*inv_cos_gamma*v*w
    w_3 = w_2*(cos_beta*lambda_psi - cos_gamma_lambda_gamma*sin_beta)
    return (
        w_2*(a_1*cos_beta*cos_gamma_lambda_gamma + a_1*lambda_psi*sin_beta - b_1*cos_gamma*lambda_v*v) - alpha*b_2*lambda_v*v*v*w,
        a_0*w_3 + a_1*alpha*w_3,
    )


def control_hessian(t, x, u, lam, p):
    """H_uu, row by row."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w = area*inv_m*rho_0*math.exp(-h*inv_h_r)
    cos_beta = math.cos(beta)
    sin_beta = math.sin(beta)
    cos_gamma = math.cos(gamma)
    cos_gamma_lambda_gamma = cos_gamma*lambda_gamma
    w_2 = cos_gamma_lambda_gamma*sin_beta
    inv_cos_gamma = 1.0/cos_gamma
    w_3 = 0.5*inv_cos_gamma*v*w
    a_1_w_3 = a_1*w_3
    w_4 = -cos_beta*cos_gamma_lambda_gamma - lambda_psi*sin_beta
    return (
        -b_2*lambda_v*v*v*w,
        w_3*(a_1*cos_beta*lambda_psi - a_1*w_2),
        a_1_w_3*(cos_beta*lambda_psi - w_2),
        a_0*w_3*w_4 + a_1_w_3*alpha*w_4,
    )


def control_law(t, x, lam, p, bounds):
    """The controls that minimise H over the control set."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    cos_gamma = math.cos(gamma)
    inv_cos_gamma = 1.0/cos_gamma
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    law_part_6 = h*inv_h_r
    law_part_7 = area*inv_m*rho_0*math.exp(-law_part_6)
    law_part_8 = 0.5*law_part_7*v
    law_part_11 = inv_cos_gamma*lambda_psi*law_part_8
    w = 0.5*((beta_min if beta_min > (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi else (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi) + (beta_max if beta_max < (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi else (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi))
    law_part_10 = math.cos(w)
    law_part_5 = math.sin(w)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_2 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_3 = math.atan2(w_2, law_part_13) + 0.0/(w_2*w_2 + law_part_13*law_part_13)
    w_4 = w + w_3
    w_5 = beta_min if w_4 < beta_min else beta_max if w_4 > beta_max else w_4
    law_part_15 = law_part_11*math.sin(w_5) + law_part_9*math.cos(w_5)
    inv_lambda_v = 1.0/lambda_v
    law_part_16 = v*v
    inv_law_part_16 = 1.0/law_part_16
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    inv_b_2 = 1.0/b_2
    law_part_17 = a_1*inv_area*inv_b_2*inv_lambda_v*inv_law_part_16*inv_rho_0*m*math.exp(law_part_6)
    law_part_2 = 0.5*b_1
    law_part_3 = -inv_b_2*law_part_2
    w_6 = law_part_15*law_part_17 + law_part_3
    law_part_18 = lambda_v*law_part_16*law_part_7
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_7 = w_6 + 0.0*math.sqrt(law_part_20)
    w_8 = alpha_min if w_7 < alpha_min else alpha_max if w_7 > alpha_max else w_7
    w_9 = -law_part_13
    w_10 = math.atan2(law_part_12, w_9) + 0.0/(law_part_12*law_part_12 + w_9*w_9)
    w_11 = w + w_10
    w_12 = beta_min if w_11 < beta_min else beta_max if w_11 > beta_max else w_11
    law_part_24 = law_part_11*math.sin(w_12) + law_part_9*math.cos(w_12)
    w_13 = law_part_17*law_part_24 + law_part_3
    w_14 = w_13 + 0.0*math.sqrt(law_part_20)
    w_15 = alpha_min if w_14 < alpha_min else alpha_max if w_14 > alpha_max else w_14
    law_part_22 = law_part_18*law_part_2
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_8 + law_part_24*(a_0 + a_1*w_15) + law_part_26*w_8*w_8 - law_part_15*(a_0 + a_1*w_8) - law_part_22*w_15 - law_part_26*w_15*w_15
    w_16 = (w_15 if law_part_27 <= 0.0 else w_8) + 0.0*law_part_27
    w_17 = (w_12 if law_part_27 <= 0.0 else w_5) + 0.0*law_part_27
    return (
        w_16,
        w_17,
    )


def costate_rate(t, x, u, lam, p):
    """Rates of change of the costates, -H_x."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    h_sq = h*h
    r_e_sq = r_e*r_e
    twice_r_e = 2.0*r_e
    w = h*twice_r_e + h_sq + r_e_sq
    inv_w = 1.0/w
    h_cubed = h*h*h
    r_e_cubed = r_e*r_e*r_e
    w_2 = 3.0*h*r_e_sq
    w_3 = 3.0*h_sq*r_e
    w_4 = h_cubed + r_e_cubed + w_2 + w_3
    inv_w_4 = 1.0/w_4
    w_5 = h_cubed*v + r_e_cubed*v + v*w_2 + v*w_3
    inv_w_5 = 1.0/w_5
    cos_theta = math.cos(theta)
    cos_theta_h = cos_theta*h
    w_6 = cos_theta*h_sq + cos_theta*r_e_sq + cos_theta_h*twice_r_e
    inv_w_6 = 1.0/w_6
    cos_psi = math.cos(psi)
    cos_psi_lambda_theta = cos_psi*lambda_theta
    cos_gamma = math.cos(gamma)
    cos_gamma_v = cos_gamma*v
    w_7 = h + r_e
    inv_w_7 = 1.0/w_7
    inv_w_7_sq = inv_w_7*inv_w_7
    cos_gamma_v_inv_w_7_sq = cos_gamma_v*inv_w_7_sq
    sin_psi = math.sin(psi)
    inv_cos_theta = 1.0/cos_theta
    inv_cos_theta_lambda_phi = inv_cos_theta*lambda_phi
    w_8 = inv_cos_theta_lambda_phi*sin_psi
    cos_gamma_mu = cos_gamma*mu
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w_9 = math.exp(-h*inv_h_r)
    w_10 = 0.5*area*inv_m*rho_0*w_9
    w_11 = w_10*math.cos(beta)
    a_0_w_11 = a_0*w_11
    inv_h_r_v = inv_h_r*v
    a_1_alpha = a_1*alpha
    a_1_alpha_w_11 = a_1_alpha*w_11
    sin_theta = math.sin(theta)
    sin_psi_sin_theta = sin_psi*sin_theta
    inv_h_r_w_10 = inv_h_r*w_10
    inv_cos_gamma = 1.0/cos_gamma
    sin_beta = math.sin(beta)
    inv_cos_gamma_sin_beta = inv_cos_gamma*sin_beta
    w_12 = inv_cos_gamma_sin_beta*inv_h_r_w_10*v
    sin_gamma = math.sin(gamma)
    v_sq = v*v
    inv_h_r_w_10_v_sq = inv_h_r_w_10*v_sq
    alpha_b_1 = alpha*b_1
    w_13 = alpha*alpha*b_2
    inv_cos_theta_sq = inv_cos_theta*inv_cos_theta
    cos_gamma_inv_w_7 = cos_gamma*inv_w_7
    cos_gamma_inv_w_7_v = cos_gamma_inv_w_7*v
    w_14 = cos_gamma_inv_w_7*sin_psi
    h_v_sq = h*v_sq
    w_15 = h_sq*v_sq + h_v_sq*twice_r_e + r_e_sq*v_sq
    inv_w_15 = 1.0/w_15
    w_16 = cos_theta*r_e + cos_theta_h
    inv_w_16 = 1.0/w_16
    w_17 = inv_cos_gamma_sin_beta*w_10
    inv_v = 1.0/v
    sin_gamma_v = sin_gamma*v
    inv_w_7_sin_gamma_v = inv_w_7*sin_gamma_v
    w_18 = inv_cos_gamma*inv_cos_gamma*sin_beta*sin_gamma_v*w_10
    w_19 = cos_gamma_inv_w_7_v*cos_psi
    return (
        cos_gamma_v_inv_w_7_sq*cos_psi_lambda_theta + cos_gamma_v_inv_w_7_sq*w_8 + lambda_gamma*(a_0_w_11*inv_h_r_v + a_1_alpha_w_11*inv_h_r_v + cos_gamma_v*inv_w - 2.0*cos_gamma_mu*inv_w_5) + lambda_psi*(a_0*w_12 + a_1_alpha*w_12 + cos_gamma_v*inv_w_6*sin_psi_sin_theta) + lambda_v*(-alpha_b_1*inv_h_r_w_10_v_sq - b_0*inv_h_r_w_10_v_sq - inv_h_r_w_10_v_sq*w_13 - 2.0*inv_w_4*mu*sin_gamma),
        0.0,
        -cos_gamma_inv_w_7_v*inv_cos_theta_sq*lambda_phi*sin_psi_sin_theta - inv_cos_theta_sq*lambda_psi*v*w_14*(cos_theta*cos_theta + sin_theta*sin_theta),
        area*inv_m*lambda_v*rho_0*v*w_9*(alpha_b_1 + b_0 + w_13) + lambda_gamma*(-a_0_w_11 - a_1_alpha_w_11 - cos_gamma_inv_w_7 - cos_gamma_mu*inv_w_15) + lambda_psi*(-a_0*w_17 - a_1_alpha*w_17 - cos_gamma*inv_w_16*sin_psi_sin_theta) - cos_gamma_inv_w_7*cos_psi_lambda_theta - inv_cos_theta_lambda_phi*w_14 - lambda_h*sin_gamma,
        cos_gamma_mu*inv_w_7_sq*lambda_v + cos_psi_lambda_theta*inv_w_7_sin_gamma_v + inv_v*inv_w_7_sq*lambda_gamma*sin_gamma*(h_v_sq + r_e*v_sq - mu) + inv_w_7_sin_gamma_v*w_8 + lambda_psi*(inv_w_16*sin_gamma*sin_psi*sin_theta*v - a_0*w_18 - a_1_alpha*w_18) - cos_gamma_v*lambda_h,
        cos_gamma*inv_w_7*lambda_theta*sin_psi*v - inv_cos_theta*lambda_psi*sin_theta*w_19 - inv_cos_theta_lambda_phi*w_19,
    )


def canonical(t, x, lam, p, bounds):
    """Rates of change of states and costates under the control law."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    sin_gamma = math.sin(gamma)
    sin_gamma_v = sin_gamma*v
    w = h + r_e
    inv_w = 1.0/w
    cos_gamma = math.cos(gamma)
    cos_gamma_inv_w_v = cos_gamma*inv_w*v
    cos_theta = math.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    sin_psi = math.sin(psi)
    inv_cos_theta_sin_psi = inv_cos_theta*sin_psi
    cos_psi = math.cos(psi)
    w_2 = cos_gamma_inv_w_v*cos_psi
    inv_w_sq = inv_w*inv_w
    inv_w_sq_mu = inv_w_sq*mu
    inv_cos_gamma = 1.0/cos_gamma
    half_v = 0.5*v
    inv_m = 1.0/m
    area_inv_m_rho_0 = area*inv_m*rho_0
    inv_h_r = 1.0/h_r
    h_inv_h_r = h*inv_h_r
    law_part_7 = area_inv_m_rho_0*math.exp(-h_inv_h_r)
    law_part_8 = half_v*law_part_7
    law_part_11 = inv_cos_gamma*lambda_psi*law_part_8
    w_3 = 0.5*((beta_min if beta_min > (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi else (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi) + (beta_max if beta_max < (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi else (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi))
    law_part_10 = math.cos(w_3)
    law_part_5 = math.sin(w_3)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_4 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_5 = math.atan2(w_4, law_part_13) + 0.0/(w_4*w_4 + law_part_13*law_part_13)
    w_6 = w_3 + w_5
    w_7 = beta_min if w_6 < beta_min else beta_max if w_6 > beta_max else w_6
    law_part_15 = law_part_11*math.sin(w_7) + law_part_9*math.cos(w_7)
    inv_lambda_v = 1.0/lambda_v
    v_sq = v*v
    inv_v_sq = 1.0/v_sq
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    inv_b_2 = 1.0/b_2
    law_part_17 = a_1*inv_area*inv_b_2*inv_lambda_v*inv_rho_0*inv_v_sq*m*math.exp(h_inv_h_r)
    half_b_1 = 0.5*b_1
    law_part_3 = -half_b_1*inv_b_2
    w_8 = law_part_15*law_part_17 + law_part_3
    law_part_18 = lambda_v*law_part_7*v_sq
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_9 = w_8 + 0.0*math.sqrt(law_part_20)
    w_10 = alpha_min if w_9 < alpha_min else alpha_max if w_9 > alpha_max else w_9
    w_11 = -law_part_13
    w_12 = math.atan2(law_part_12, w_11) + 0.0/(law_part_12*law_part_12 + w_11*w_11)
    w_13 = w_12 + w_3
    w_14 = beta_min if w_13 < beta_min else beta_max if w_13 > beta_max else w_13
    law_part_24 = law_part_11*math.sin(w_14) + law_part_9*math.cos(w_14)
    w_15 = law_part_17*law_part_24 + law_part_3
    w_16 = w_15 + 0.0*math.sqrt(law_part_20)
    w_17 = alpha_min if w_16 < alpha_min else alpha_max if w_16 > alpha_max else w_16
    law_part_22 = half_b_1*law_part_18
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_10 + law_part_24*(a_0 + a_1*w_17) + law_part_26*w_10*w_10 - law_part_15*(a_0 + a_1*w_10) - law_part_22*w_17 - law_part_26*w_17*w_17
    w_18 = (w_17 if law_part_27 <= 0.0 else w_10) + 0.0*law_part_27
    w_19 = b_2*w_18*w_18
    w_20 = b_0 + b_1*w_18 + w_19
    w_21 = math.exp(-h_inv_h_r)
    area_inv_m_rho_0_w_21 = area_inv_m_rho_0*w_21
    w_22 = 0.5*area_inv_m_rho_0_w_21
    v_sq_w_22 = v_sq*w_22
    inv_v = 1.0/v
    w_23 = (w_14 if law_part_27 <= 0.0 else w_7) + 0.0*law_part_27
    cos_w_23 = math.cos(w_23)
    a_1_w_18 = a_1*w_18
    w_24 = area_inv_m_rho_0_w_21*half_v
    w_25 = w_24*(a_0 + a_1_w_18)
    sin_theta = math.sin(theta)
    sin_psi_sin_theta = sin_psi*sin_theta
    w_26 = cos_gamma_inv_w_v*sin_psi_sin_theta
    sin_w_23 = math.sin(w_23)
    inv_cos_gamma_sin_w_23 = inv_cos_gamma*sin_w_23
    h_sq = h*h
    r_e_sq = r_e*r_e
    twice_r_e = 2.0*r_e
    w_27 = h*twice_r_e + h_sq + r_e_sq
    inv_w_27 = 1.0/w_27
    h_cubed = h*h*h
    r_e_cubed = r_e*r_e*r_e
    w_28 = 3.0*h*r_e_sq
    w_29 = 3.0*h_sq*r_e
    w_30 = h_cubed*v + r_e_cubed*v + v*w_28 + v*w_29
    inv_w_30 = 1.0/w_30
    cos_theta_h = cos_theta*h
    w_31 = cos_theta*h_sq + cos_theta*r_e_sq + cos_theta_h*twice_r_e
    inv_w_31 = 1.0/w_31
    w_32 = h_cubed + r_e_cubed + w_28 + w_29
    inv_w_32 = 1.0/w_32
    cos_psi_lambda_theta = cos_psi*lambda_theta
    cos_gamma_v = cos_gamma*v
    cos_gamma_v_inv_w_sq = cos_gamma_v*inv_w_sq
    w_33 = inv_cos_theta_sin_psi*lambda_phi
    cos_gamma_mu = cos_gamma*mu
    inv_h_r_w_24 = inv_h_r*w_24
    cos_w_23_inv_h_r_w_24 = cos_w_23*inv_h_r_w_24
    w_34 = inv_cos_gamma_sin_w_23*inv_h_r_w_24
    inv_h_r_v_sq_w_22 = inv_h_r*v_sq_w_22
    inv_cos_theta_sq = inv_cos_theta*inv_cos_theta
    h_v_sq = h*v_sq
    w_35 = h_sq*v_sq + h_v_sq*twice_r_e + r_e_sq*v_sq
    inv_w_35 = 1.0/w_35
    w_36 = cos_theta*r_e + cos_theta_h
    inv_w_36 = 1.0/w_36
    cos_gamma_inv_w = cos_gamma*inv_w
    cos_w_23_w_22 = cos_w_23*w_22
    w_37 = inv_cos_gamma_sin_w_23*w_22
    inv_w_sin_gamma_v = inv_w*sin_gamma_v
    w_38 = inv_cos_gamma*inv_cos_gamma*sin_gamma_v*sin_w_23*w_22
    inv_cos_theta_w_2 = inv_cos_theta*w_2
    return (
        sin_gamma_v,
        cos_gamma_inv_w_v*inv_cos_theta_sin_psi,
        w_2,
        -inv_w_sq_mu*sin_gamma - v_sq_w_22*w_20,
        cos_gamma*(inv_w*v - inv_v*inv_w_sq_mu) + cos_w_23*w_25,
        inv_cos_gamma_sin_w_23*w_25 + inv_cos_theta*w_26,
        cos_gamma_v_inv_w_sq*cos_psi_lambda_theta + cos_gamma_v_inv_w_sq*w_33 + lambda_gamma*(a_0*cos_w_23_inv_h_r_w_24 + a_1_w_18*cos_w_23_inv_h_r_w_24 + cos_gamma_v*inv_w_27 - 2.0*cos_gamma_mu*inv_w_30) + lambda_psi*(a_0*w_34 + a_1_w_18*w_34 + cos_gamma_v*inv_w_31*sin_psi_sin_theta) + lambda_v*(-area_inv_m_rho_0_w_21*half_b_1*inv_h_r*v_sq*w_18 - b_0*inv_h_r_v_sq_w_22 - inv_h_r_v_sq_w_22*w_19 - 2.0*inv_w_32*mu*sin_gamma),
        0.0,
        -cos_gamma_inv_w_v*inv_cos_theta_sq*lambda_psi*sin_psi*(cos_theta*cos_theta + sin_theta*sin_theta) - inv_cos_theta_sq*lambda_phi*w_26,
        area*inv_m*lambda_v*rho_0*v*w_20*w_21 + lambda_gamma*(-a_0*cos_w_23_w_22 - a_1_w_18*cos_w_23_w_22 - cos_gamma_inv_w - cos_gamma_mu*inv_w_35) + lambda_psi*(-a_0*w_37 - a_1_w_18*w_37 - cos_gamma*inv_w_36*sin_psi_sin_theta) - cos_gamma_inv_w*cos_psi_lambda_theta - cos_gamma_inv_w*w_33 - lambda_h*sin_gamma,
        cos_gamma*inv_w_sq_mu*lambda_v + cos_psi_lambda_theta*inv_w_sin_gamma_v + inv_v*inv_w_sq*lambda_gamma*sin_gamma*(h_v_sq + r_e*v_sq - mu) + inv_w_sin_gamma_v*w_33 + lambda_psi*(inv_w_36*sin_gamma*sin_psi*sin_theta*v - a_0*w_38 - a_1_w_18*w_38) - cos_gamma_v*lambda_h,
        cos_gamma*inv_w*lambda_theta*sin_psi*v - inv_cos_theta_w_2*lambda_phi - inv_cos_theta_w_2*lambda_psi*sin_theta,
    )


def canonical_jacobian(t, x, lam, p, bounds):
    """The canonical rates by states and costates, row by row."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    sin_gamma = math.sin(gamma)
    cos_gamma = math.cos(gamma)
    cos_gamma_v = cos_gamma*v
    w = h + r_e
    inv_w = 1.0/w
    inv_w_sq = inv_w*inv_w
    cos_gamma_v_inv_w_sq = cos_gamma_v*inv_w_sq
    cos_theta = math.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    sin_psi = math.sin(psi)
    inv_cos_theta_sin_psi = inv_cos_theta*sin_psi
    w_2 = cos_gamma_v_inv_w_sq*inv_cos_theta_sin_psi
    sin_theta = math.sin(theta)
    inv_cos_theta_sq = inv_cos_theta*inv_cos_theta
    cos_gamma_v_inv_w = cos_gamma_v*inv_w
    w_3 = cos_gamma_v_inv_w*sin_psi
    inv_cos_theta_sq_w_3 = inv_cos_theta_sq*w_3
    w_4 = inv_cos_theta_sq_w_3*sin_theta
    cos_gamma_inv_w = cos_gamma*inv_w
    cos_gamma_inv_w_sin_psi = cos_gamma_inv_w*sin_psi
    w_5 = cos_gamma_inv_w_sin_psi*inv_cos_theta
    inv_w_v = inv_w*v
    inv_w_v_sin_gamma = inv_w_v*sin_gamma
    w_6 = inv_cos_theta_sin_psi*inv_w_v_sin_gamma
    cos_psi = math.cos(psi)
    w_7 = cos_gamma_v_inv_w*cos_psi
    inv_cos_theta_w_7 = inv_cos_theta*w_7
    w_8 = cos_gamma_v_inv_w_sq*cos_psi
    cos_gamma_inv_w_cos_psi = cos_gamma_inv_w*cos_psi
    w_9 = cos_psi*inv_w_v_sin_gamma
    inv_w_cubed = inv_w*inv_w*inv_w
    twice_mu = 2.0*mu
    inv_w_cubed_twice_mu = inv_w_cubed*twice_mu
    w_10 = 0.5*((beta_min if beta_min > (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi else (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi) + (beta_max if beta_max < (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi else (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi))
    law_part_10 = math.cos(w_10)
    inv_cos_gamma = 1.0/cos_gamma
    inv_m = 1.0/m
    area_inv_m_rho_0 = area*inv_m*rho_0
    inv_h_r = 1.0/h_r
    h_inv_h_r = h*inv_h_r
    w_11 = area_inv_m_rho_0*math.exp(-h_inv_h_r)
    half_w_11 = 0.5*w_11
    law_part_8 = half_w_11*v
    inv_cos_gamma_law_part_8 = inv_cos_gamma*law_part_8
    law_part_11 = inv_cos_gamma_law_part_8*lambda_psi
    law_part_5 = math.sin(w_10)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_12 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_13 = math.atan2(w_12, law_part_13) + 0.0/(w_12*w_12 + law_part_13*law_part_13)
    w_14 = w_10 + w_13
    w_15 = beta_min if w_14 < beta_min else beta_max if w_14 > beta_max else w_14
    sin_w_15 = math.sin(w_15)
    cos_w_15 = math.cos(w_15)
    law_part_15 = cos_w_15*law_part_9 + law_part_11*sin_w_15
    inv_lambda_v = 1.0/lambda_v
    v_sq = v*v
    inv_v_sq = 1.0/v_sq
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    exp_h_inv_h_r = math.exp(h_inv_h_r)
    inv_b_2 = 1.0/b_2
    w_16 = a_1*exp_h_inv_h_r*inv_area*inv_b_2*inv_rho_0*inv_v_sq*m
    inv_lambda_v_w_16 = inv_lambda_v*w_16
    half_b_1 = 0.5*b_1
    law_part_3 = -half_b_1*inv_b_2
    w_17 = inv_lambda_v_w_16*law_part_15 + law_part_3
    law_part_18 = lambda_v*v_sq*w_11
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_18 = w_17 + 0.0*math.sqrt(law_part_20)
    w_19 = alpha_min if w_18 < alpha_min else alpha_max if w_18 > alpha_max else w_18
    w_20 = -law_part_13
    w_21 = math.atan2(law_part_12, w_20) + 0.0/(law_part_12*law_part_12 + w_20*w_20)
    w_22 = w_10 + w_21
    w_23 = beta_min if w_22 < beta_min else beta_max if w_22 > beta_max else w_22
    sin_w_23 = math.sin(w_23)
    cos_w_23 = math.cos(w_23)
    law_part_24 = cos_w_23*law_part_9 + law_part_11*sin_w_23
    w_24 = inv_lambda_v_w_16*law_part_24 + law_part_3
    w_25 = w_24 + 0.0*math.sqrt(law_part_20)
    w_26 = alpha_min if w_25 < alpha_min else alpha_max if w_25 > alpha_max else w_25
    law_part_22 = half_b_1*law_part_18
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_19 + law_part_24*(a_0 + a_1*w_26) + law_part_26*w_19*w_19 - law_part_15*(a_0 + a_1*w_19) - law_part_22*w_26 - law_part_26*w_26*w_26
    w_27 = (w_26 if law_part_27 <= 0.0 else w_19) + 0.0*law_part_27
    b_2_w_27 = b_2*w_27
    w_28 = b_1 + 2.0*b_2_w_27
    w_29 = math.exp(-h_inv_h_r)
    area_inv_m_rho_0_w_29 = area_inv_m_rho_0*w_29
    w_30 = 0.5*area_inv_m_rho_0_w_29
    v_sq_w_30 = v_sq*w_30
    v_sq_w_30_w_28 = v_sq_w_30*w_28
    b_1_w_27 = b_1*w_27
    w_31 = b_2*w_27*w_27
    w_32 = area_inv_m_rho_0_w_29*(b_0 + b_1_w_27 + w_31)
    inv_h_r_v_sq = inv_h_r*v_sq
    w_33 = (0.0 if law_part_27 <= 0.0 else 1.0) + 0.0*law_part_27
    w_34 = (1.0 if law_part_27 <= 0.0 else 0.0) + 0.0*law_part_27
    w_35 = 0.0 if w_18 < alpha_min else 0.0 if w_18 > alpha_max else 1.0
    inv_lambda_v_w_16_w_35 = inv_lambda_v_w_16*w_35
    law_part_15_w_35 = law_part_15*w_35
    w_36 = cos_w_15*law_part_11 - law_part_9*sin_w_15
    inv_cos_gamma_lambda_psi = inv_cos_gamma*lambda_psi
    half_v = 0.5*v
    d_law_part_7_by_h = -inv_h_r*w_11
    d_law_part_8_by_h = d_law_part_7_by_h*half_v
    d_law_part_11_by_h = d_law_part_8_by_h*inv_cos_gamma_lambda_psi
    w_37 = law_part_12*law_part_12 + law_part_13*law_part_13
    inv_w_37 = 1.0/w_37
    w_38 = 0.0 if w_14 < beta_min else 0.0 if w_14 > beta_max else 1.0
    inv_w_37_w_38 = inv_w_37*w_38
    d_law_part_9_by_h = d_law_part_8_by_h*lambda_gamma
    d_law_part_12_by_h = d_law_part_9_by_h*law_part_5 - d_law_part_11_by_h*law_part_10
    w_39 = d_law_part_12_by_h*law_part_13
    d_law_part_13_by_h = d_law_part_11_by_h*law_part_5 + d_law_part_9_by_h*law_part_10
    d_law_part_14_by_h = d_law_part_13_by_h*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_39
    d_law_part_15_by_h = cos_w_15*d_law_part_9_by_h + d_law_part_11_by_h*sin_w_15 + d_law_part_14_by_h*w_36
    d_law_part_17_by_h = inv_h_r*inv_lambda_v_w_16
    d_law_part_21_by_h = d_law_part_15_by_h*inv_lambda_v_w_16_w_35 + d_law_part_17_by_h*law_part_15_w_35
    w_40 = 0.0 if w_25 < alpha_min else 0.0 if w_25 > alpha_max else 1.0
    law_part_24_w_40 = law_part_24*w_40
    inv_lambda_v_w_16_w_40 = inv_lambda_v_w_16*w_40
    w_41 = cos_w_23*law_part_11 - law_part_9*sin_w_23
    w_42 = 0.0 if w_22 < beta_min else 0.0 if w_22 > beta_max else 1.0
    inv_w_37_w_42 = inv_w_37*w_42
    d_law_part_23_by_h = d_law_part_13_by_h*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_39
    d_law_part_24_by_h = cos_w_23*d_law_part_9_by_h + d_law_part_11_by_h*sin_w_23 + d_law_part_23_by_h*w_41
    d_law_part_25_by_h = d_law_part_17_by_h*law_part_24_w_40 + d_law_part_24_by_h*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_h = d_law_part_21_by_h*w_33 + d_law_part_25_by_h*w_34
    v_w_32 = v*w_32
    d_law_part_11_by_v = half_w_11*inv_cos_gamma_lambda_psi
    d_law_part_9_by_v = half_w_11*lambda_gamma
    d_law_part_12_by_v = d_law_part_9_by_v*law_part_5 - d_law_part_11_by_v*law_part_10
    w_43 = d_law_part_12_by_v*law_part_13
    d_law_part_13_by_v = d_law_part_11_by_v*law_part_5 + d_law_part_9_by_v*law_part_10
    d_law_part_14_by_v = d_law_part_13_by_v*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_43
    d_law_part_15_by_v = cos_w_15*d_law_part_9_by_v + d_law_part_11_by_v*sin_w_15 + d_law_part_14_by_v*w_36
    twice_v = 2.0*v
    d_law_part_17_by_v = -a_1*exp_h_inv_h_r*inv_area*inv_b_2*inv_lambda_v*inv_rho_0*inv_v_sq*inv_v_sq*m*twice_v
    d_law_part_21_by_v = d_law_part_15_by_v*inv_lambda_v_w_16_w_35 + d_law_part_17_by_v*law_part_15_w_35
    d_law_part_23_by_v = d_law_part_13_by_v*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_43
    d_law_part_24_by_v = cos_w_23*d_law_part_9_by_v + d_law_part_11_by_v*sin_w_23 + d_law_part_23_by_v*w_41
    d_law_part_25_by_v = d_law_part_17_by_v*law_part_24_w_40 + d_law_part_24_by_v*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_v = d_law_part_21_by_v*w_33 + d_law_part_25_by_v*w_34
    cos_gamma_inv_w_sq = cos_gamma*inv_w_sq
    cos_gamma_inv_w_sq_mu = cos_gamma_inv_w_sq*mu
    inv_cos_gamma_sq = inv_cos_gamma*inv_cos_gamma
    lambda_psi_sin_gamma = lambda_psi*sin_gamma
    w_44 = inv_cos_gamma_sq*lambda_psi_sin_gamma
    d_law_part_11_by_gamma = law_part_8*w_44
    d_law_part_12_by_gamma = -d_law_part_11_by_gamma*law_part_10
    w_45 = d_law_part_12_by_gamma*law_part_13
    d_law_part_13_by_gamma = d_law_part_11_by_gamma*law_part_5
    d_law_part_14_by_gamma = d_law_part_13_by_gamma*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_45
    d_law_part_15_by_gamma = d_law_part_11_by_gamma*sin_w_15 + d_law_part_14_by_gamma*w_36
    d_law_part_21_by_gamma = d_law_part_15_by_gamma*inv_lambda_v_w_16_w_35
    d_law_part_23_by_gamma = d_law_part_13_by_gamma*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_45
    d_law_part_24_by_gamma = d_law_part_11_by_gamma*sin_w_23 + d_law_part_23_by_gamma*w_41
    d_law_part_25_by_gamma = d_law_part_24_by_gamma*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_gamma = d_law_part_21_by_gamma*w_33 + d_law_part_25_by_gamma*w_34
    d_law_part_17_by_lambda_v = -inv_lambda_v*inv_lambda_v*w_16
    d_law_part_21_by_lambda_v = d_law_part_17_by_lambda_v*law_part_15_w_35
    d_law_part_25_by_lambda_v = d_law_part_17_by_lambda_v*law_part_24_w_40
    d_law_of_alpha_by_lambda_v = d_law_part_21_by_lambda_v*w_33 + d_law_part_25_by_lambda_v*w_34
    d_law_part_12_by_lambda_gamma = law_part_5*law_part_8
    w_46 = d_law_part_12_by_lambda_gamma*law_part_13
    d_law_part_13_by_lambda_gamma = law_part_10*law_part_8
    d_law_part_14_by_lambda_gamma = d_law_part_13_by_lambda_gamma*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_46
    d_law_part_15_by_lambda_gamma = cos_w_15*law_part_8 + d_law_part_14_by_lambda_gamma*w_36
    d_law_part_21_by_lambda_gamma = d_law_part_15_by_lambda_gamma*inv_lambda_v_w_16_w_35
    d_law_part_23_by_lambda_gamma = d_law_part_13_by_lambda_gamma*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_46
    d_law_part_24_by_lambda_gamma = cos_w_23*law_part_8 + d_law_part_23_by_lambda_gamma*w_41
    d_law_part_25_by_lambda_gamma = d_law_part_24_by_lambda_gamma*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_lambda_gamma = d_law_part_21_by_lambda_gamma*w_33 + d_law_part_25_by_lambda_gamma*w_34
    d_law_part_12_by_lambda_psi = -inv_cos_gamma_law_part_8*law_part_10
    w_47 = d_law_part_12_by_lambda_psi*law_part_13
    d_law_part_13_by_lambda_psi = inv_cos_gamma_law_part_8*law_part_5
    d_law_part_14_by_lambda_psi = d_law_part_13_by_lambda_psi*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_47
    d_law_part_15_by_lambda_psi = d_law_part_14_by_lambda_psi*w_36 + inv_cos_gamma_law_part_8*sin_w_15
    d_law_part_21_by_lambda_psi = d_law_part_15_by_lambda_psi*inv_lambda_v_w_16_w_35
    d_law_part_23_by_lambda_psi = d_law_part_13_by_lambda_psi*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_47
    d_law_part_24_by_lambda_psi = d_law_part_23_by_lambda_psi*w_41 + inv_cos_gamma_law_part_8*sin_w_23
    d_law_part_25_by_lambda_psi = d_law_part_24_by_lambda_psi*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_lambda_psi = d_law_part_21_by_lambda_psi*w_33 + d_law_part_25_by_lambda_psi*w_34
    inv_v = 1.0/v
    w_48 = (w_23 if law_part_27 <= 0.0 else w_15) + 0.0*law_part_27
    cos_w_48 = math.cos(w_48)
    inv_w_sq_v = inv_w_sq*v
    a_1_w_27 = a_1*w_27
    w_49 = a_0 + a_1_w_27
    w_50 = area_inv_m_rho_0_w_29*half_v
    cos_w_48_w_50 = cos_w_48*w_50
    cos_w_48_w_50_inv_h_r = cos_w_48_w_50*inv_h_r
    sin_w_48 = math.sin(w_48)
    sin_w_48_w_50 = sin_w_48*w_50
    d_law_of_beta_by_h = d_law_part_14_by_h*w_33 + d_law_part_23_by_h*w_34
    inv_v_sq_2 = inv_v*inv_v
    inv_w_sq_mu = inv_w_sq*mu
    a_1_cos_w_48_w_50 = a_1*cos_w_48_w_50
    cos_w_48_w_30 = cos_w_48*w_30
    sin_w_48_w_50_w_49 = sin_w_48_w_50*w_49
    d_law_of_beta_by_v = d_law_part_14_by_v*w_33 + d_law_part_23_by_v*w_34
    d_law_of_beta_by_gamma = d_law_part_14_by_gamma*w_33 + d_law_part_23_by_gamma*w_34
    d_law_of_beta_by_lambda_gamma = d_law_part_14_by_lambda_gamma*w_33 + d_law_part_23_by_lambda_gamma*w_34
    d_law_of_beta_by_lambda_psi = d_law_part_14_by_lambda_psi*w_33 + d_law_part_23_by_lambda_psi*w_34
    sin_theta_sq = sin_theta*sin_theta
    w_51 = inv_cos_gamma*sin_w_48_w_50
    a_1_w_51 = a_1*w_51
    sin_w_48_w_30 = sin_w_48*w_30
    w_52 = inv_cos_gamma*sin_w_48_w_30
    w_53 = cos_w_48_w_50*inv_cos_gamma*w_49
    w_54 = inv_cos_gamma_sq*sin_gamma
    w_55 = inv_cos_theta_w_7*sin_theta
    h_sq = h*h
    r_e_sq = r_e*r_e
    twice_h = 2.0*h
    w_56 = h_sq + r_e*twice_h + r_e_sq
    inv_w_56 = 1.0/w_56
    h_cubed = h*h*h
    r_e_cubed = r_e*r_e*r_e
    w_57 = 3.0*r_e_sq
    h_w_57 = h*w_57
    w_58 = 3.0*h_sq
    r_e_w_58 = r_e*w_58
    w_59 = h_cubed + h_w_57 + r_e_cubed + r_e_w_58
    inv_w_59 = 1.0/w_59
    cos_psi_lambda_theta = cos_psi*lambda_theta
    inv_w_cubed_twice_v = inv_w_cubed*twice_v
    cos_gamma_sin_psi = cos_gamma*sin_psi
    inv_cos_theta_lambda_phi = inv_cos_theta*lambda_phi
    inv_h_r_sq = inv_h_r*inv_h_r
    a_0_sin_w_48_w_50 = a_0*sin_w_48_w_50
    w_60 = a_0_sin_w_48_w_50*inv_cos_gamma
    a_1_w_27_w_51 = a_1_w_27*w_51
    cos_theta_h = cos_theta*h
    twice_r_e = 2.0*r_e
    w_61 = cos_theta*h_sq + cos_theta*r_e_sq + cos_theta_h*twice_r_e
    inv_w_61 = 1.0/w_61
    inv_w_61_sq = inv_w_61*inv_w_61
    a_1_lambda_gamma = a_1*lambda_gamma
    w_62 = a_1*inv_cos_gamma_lambda_psi
    inv_h_r_sin_w_48_w_50 = inv_h_r*sin_w_48_w_50
    w_63 = area_inv_m_rho_0_w_29*inv_h_r_v_sq
    half_b_1_w_63 = half_b_1*w_63
    w_64 = a_1_lambda_gamma*cos_w_48_w_50_inv_h_r + inv_h_r_sin_w_48_w_50*w_62 + lambda_v*(-b_2_w_27*w_63 - half_b_1_w_63)
    w_65 = a_0_sin_w_48_w_50*inv_h_r
    w_66 = a_1_w_27*inv_h_r_sin_w_48_w_50
    w_67 = a_0*cos_w_48_w_50_inv_h_r
    w_68 = a_1_w_27*cos_w_48_w_50_inv_h_r
    w_69 = lambda_gamma*(-w_65 - w_66) + lambda_psi*(inv_cos_gamma*w_67 + inv_cos_gamma*w_68)
    cos_w_48_w_50_inv_h_r_sq = cos_w_48_w_50*inv_h_r_sq
    h_r_e = h*r_e
    w_70 = 6.0*h_r_e
    w_71 = h_cubed*v + h_w_57*v + r_e_cubed*v + r_e_w_58*v
    inv_w_71 = 1.0/w_71
    cos_gamma_twice_mu = cos_gamma*twice_mu
    w_72 = cos_gamma_twice_mu*inv_w_71*inv_w_71
    inv_h_r_sq_v_sq_w_30 = inv_h_r_sq*v_sq_w_30
    sin_gamma_twice_mu = sin_gamma*twice_mu
    cos_theta_r_e = cos_theta*r_e
    lambda_phi_sin_theta = lambda_phi*sin_theta
    inv_cos_theta_sq_sin_psi = inv_cos_theta_sq*sin_psi
    w_73 = cos_gamma_v_inv_w_sq*inv_cos_theta_sq_sin_psi
    w_74 = lambda_phi_sin_theta*w_73
    cos_gamma_v_sin_psi = cos_gamma_v*sin_psi
    r_e_sin_theta = r_e*sin_theta
    a_0_cos_w_48_w_30 = a_0*cos_w_48_w_30
    a_1_w_27_cos_w_48_w_30 = a_1_w_27*cos_w_48_w_30
    w_75 = a_0_cos_w_48_w_30*inv_h_r + a_1_w_27_cos_w_48_w_30*inv_h_r
    inv_w_61_sin_theta = inv_w_61*sin_theta
    a_0_sin_w_48_w_30 = a_0*sin_w_48_w_30
    w_76 = a_0_sin_w_48_w_30*inv_cos_gamma
    a_1_w_27_w_52 = a_1_w_27*w_52
    w_77 = a_1_w_27_w_52*inv_h_r + inv_h_r*w_76
    area_inv_m_rho_0_w_29_v = area_inv_m_rho_0_w_29*v
    b_0_inv_h_r = b_0*inv_h_r
    w_78 = area_inv_m_rho_0_w_29_v*inv_h_r
    w_79 = inv_cos_theta_sin_psi*lambda_phi
    w_80 = cos_gamma_inv_w_sq*cos_psi_lambda_theta + cos_gamma_inv_w_sq*w_79
    w_81 = cos_psi_lambda_theta*inv_w_sq_v*sin_gamma
    w_82 = inv_cos_theta_lambda_phi*inv_w_sq_v*sin_gamma*sin_psi
    sin_gamma_v = sin_gamma*v
    sin_gamma_v_sin_psi = sin_gamma_v*sin_psi
    w_83 = w_54*w_65 + w_54*w_66
    cos_psi_lambda_psi = cos_psi*lambda_psi
    lambda_theta_sin_psi = lambda_theta*sin_psi
    w_84 = inv_cos_theta_lambda_phi*w_8 - cos_gamma_v_inv_w_sq*lambda_theta_sin_psi
    w_85 = cos_theta*cos_theta + sin_theta_sq
    lambda_psi_w_85 = lambda_psi*w_85
    w_86 = inv_cos_theta_lambda_phi*w_3
    w_87 = cos_gamma_inv_w_sin_psi*inv_cos_theta*inv_cos_theta*inv_cos_theta*twice_v
    w_88 = cos_gamma_inv_w_sin_psi*inv_cos_theta_sq
    w_89 = lambda_phi_sin_theta*w_88
    w_90 = inv_cos_theta_sq_sin_psi*inv_w_v_sin_gamma*lambda_phi_sin_theta
    w_91 = inv_w_v*lambda_psi_sin_gamma
    w_92 = inv_cos_theta_sq*lambda_phi_sin_theta*w_7
    lambda_psi_w_7 = lambda_psi*w_7
    w_93 = inv_cos_theta_sq*lambda_psi_w_7
    w_94 = area*inv_m*lambda_v*rho_0*v*w_28*w_29 - a_1_lambda_gamma*cos_w_48_w_30 - sin_w_48_w_30*w_62
    a_1_w_27_sin_w_48_w_30 = a_1_w_27*sin_w_48_w_30
    w_95 = lambda_gamma*(a_0_sin_w_48_w_30 + a_1_w_27_sin_w_48_w_30) + lambda_psi*(-a_0_cos_w_48_w_30*inv_cos_gamma - a_1_w_27_cos_w_48_w_30*inv_cos_gamma)
    r_e_v_sq = r_e*v_sq
    w_96 = h_sq*v_sq + r_e_sq*v_sq + r_e_v_sq*twice_h
    inv_w_96 = 1.0/w_96
    w_97 = cos_gamma*inv_w_96*inv_w_96*mu
    w_98 = cos_theta_h + cos_theta_r_e
    inv_w_98 = 1.0/w_98
    w_99 = inv_w_98*inv_w_98*sin_theta
    cos_gamma_sin_psi_w_99 = cos_gamma_sin_psi*w_99
    w_100 = cos_gamma_sin_psi*inv_w_98
    w_101 = h*sin_theta + r_e_sin_theta
    inv_w_sin_gamma = inv_w*sin_gamma
    inv_w_96_mu = inv_w_96*mu
    w_102 = cos_psi_lambda_theta*inv_w_sin_gamma + inv_w_sin_gamma*w_79 + lambda_psi*(inv_w_98*sin_gamma*sin_psi*sin_theta - a_0_sin_w_48_w_30*w_54 - a_1_w_27_sin_w_48_w_30*w_54) - cos_gamma*lambda_h
    w_103 = cos_psi_lambda_psi*inv_w_98*sin_theta
    w_104 = cos_gamma_inv_w_cos_psi*inv_cos_theta_lambda_phi - cos_gamma*inv_w*lambda_theta*sin_psi
    a_1_sin_w_48_w_50_w_44 = a_1*sin_w_48_w_50*w_44
    w_105 = h*v_sq + r_e_v_sq - mu
    inv_v_w_105 = inv_v*w_105
    inv_v_w_105_lambda_gamma = inv_v_w_105*lambda_gamma
    cos_w_48_w_50_w_54 = cos_w_48_w_50*w_54
    w_106 = -a_0*cos_w_48_w_50_w_54 - a_1_w_27*cos_w_48_w_50_w_54
    w_107 = cos_theta*sin_gamma_v_sin_psi
    lambda_psi_w_106 = lambda_psi*w_106
    inv_w_sq_sin_gamma = inv_w_sq*sin_gamma
    w_108 = inv_w_sq_sin_gamma*lambda_gamma
    w_109 = area_inv_m_rho_0_w_29_v*inv_cos_gamma*inv_cos_gamma*inv_cos_gamma*sin_gamma*sin_gamma*sin_w_48
    w_110 = cos_gamma_v_inv_w*cos_psi_lambda_theta + w_86
    w_111 = inv_cos_theta_lambda_phi*w_9 - inv_w_v_sin_gamma*lambda_theta_sin_psi
    inv_cos_theta_sin_theta = inv_cos_theta*sin_theta
    w_112 = inv_cos_theta_sin_theta*lambda_psi
    return (
        0.0,
        0.0,
        0.0,
        sin_gamma,
        cos_gamma_v,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -w_2,
        0.0,
        w_4,
        w_5,
        -w_6,
        inv_cos_theta_w_7,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -w_8,
        0.0,
        0.0,
        cos_gamma_inv_w_cos_psi,
        -w_9,
        -w_3,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.5*inv_h_r_v_sq*w_32 + inv_w_cubed_twice_mu*sin_gamma - d_law_of_alpha_by_h*v_sq_w_30_w_28,
        0.0,
        0.0,
        -d_law_of_alpha_by_v*v_sq_w_30_w_28 - v_w_32,
        -cos_gamma_inv_w_sq_mu - d_law_of_alpha_by_gamma*v_sq_w_30_w_28,
        0.0,
        0.0,
        0.0,
        0.0,
        -d_law_of_alpha_by_lambda_v*v_sq_w_30_w_28,
        -d_law_of_alpha_by_lambda_gamma*v_sq_w_30_w_28,
        -d_law_of_alpha_by_lambda_psi*v_sq_w_30_w_28,
        0.5*a_1*area*cos_w_48*d_law_of_alpha_by_h*inv_m*rho_0*v*w_29 + cos_gamma*(inv_v*inv_w_cubed_twice_mu - inv_w_sq_v) - cos_w_48_w_50_inv_h_r*w_49 - d_law_of_beta_by_h*sin_w_48_w_50*w_49,
        0.0,
        0.0,
        a_1_cos_w_48_w_50*d_law_of_alpha_by_v + cos_gamma*(inv_v_sq_2*inv_w_sq_mu + inv_w) + cos_w_48_w_30*w_49 - d_law_of_beta_by_v*sin_w_48_w_50_w_49,
        0.5*a_1*area*cos_w_48*d_law_of_alpha_by_gamma*inv_m*rho_0*v*w_29 - d_law_of_beta_by_gamma*sin_w_48_w_50_w_49 - sin_gamma*(inv_w*v - inv_v*inv_w_sq_mu),
        0.0,
        0.0,
        0.0,
        0.0,
        a_1_cos_w_48_w_50*d_law_of_alpha_by_lambda_v,
        a_1_cos_w_48_w_50*d_law_of_alpha_by_lambda_gamma - d_law_of_beta_by_lambda_gamma*sin_w_48_w_50_w_49,
        a_1_cos_w_48_w_50*d_law_of_alpha_by_lambda_psi - d_law_of_beta_by_lambda_psi*sin_w_48_w_50_w_49,
        0.5*a_1*area*d_law_of_alpha_by_h*inv_cos_gamma*inv_m*rho_0*sin_w_48*v*w_29 + 0.5*area*cos_w_48*d_law_of_beta_by_h*inv_cos_gamma*inv_m*rho_0*v*w_29*w_49 - inv_cos_gamma*inv_h_r*sin_w_48_w_50_w_49 - sin_theta*w_2,
        0.0,
        inv_cos_theta_sq_w_3*sin_theta_sq + w_3,
        a_1_w_51*d_law_of_alpha_by_v + d_law_of_beta_by_v*w_53 + sin_theta*w_5 + w_49*w_52,
        a_1_w_51*d_law_of_alpha_by_gamma + d_law_of_beta_by_gamma*w_53 + sin_w_48_w_50_w_49*w_54 - sin_theta*w_6,
        w_55,
        0.0,
        0.0,
        0.0,
        a_1_w_51*d_law_of_alpha_by_lambda_v,
        a_1_w_51*d_law_of_alpha_by_lambda_gamma + d_law_of_beta_by_lambda_gamma*w_53,
        a_1_w_51*d_law_of_alpha_by_lambda_psi + d_law_of_beta_by_lambda_psi*w_53,
        d_law_of_alpha_by_h*w_64 + d_law_of_beta_by_h*w_69 + lambda_gamma*(cos_gamma*inv_w_56*inv_w_56*v*(-twice_h - twice_r_e) - a_0*cos_w_48_w_50_inv_h_r_sq - a_1_w_27*cos_w_48_w_50_inv_h_r_sq - w_72*(-v*w_57 - v*w_58 - v*w_70)) + lambda_psi*(cos_gamma*inv_w_61_sq*sin_psi*sin_theta*v*(-2.0*cos_theta_h - 2.0*cos_theta_r_e) - a_1_w_27_w_51*inv_h_r_sq - inv_h_r_sq*w_60) + lambda_v*(area_inv_m_rho_0_w_29*half_b_1*inv_h_r_sq*v_sq*w_27 + b_0*inv_h_r_sq_v_sq_w_30 + inv_h_r_sq_v_sq_w_30*w_31 - inv_w_59*inv_w_59*sin_gamma_twice_mu*(-w_57 - w_58 - w_70)) - cos_gamma*cos_psi_lambda_theta*inv_w_cubed_twice_v - cos_gamma_sin_psi*inv_cos_theta_lambda_phi*inv_w_cubed_twice_v,
        0.0,
        lambda_psi*(cos_gamma_v_sin_psi*cos_theta*inv_w_61 + cos_gamma_v_sin_psi*inv_w_61_sq*sin_theta*(h_sq*sin_theta + r_e_sin_theta*twice_h + r_e_sq*sin_theta)) + w_74,
        d_law_of_alpha_by_v*w_64 + d_law_of_beta_by_v*w_69 + lambda_gamma*(cos_gamma*inv_w_56 + w_59*w_72 + w_75) + lambda_psi*(cos_gamma_sin_psi*inv_w_61_sin_theta + w_77) + lambda_v*(-area_inv_m_rho_0_w_29_v*b_0_inv_h_r - b_1_w_27*w_78 - w_31*w_78) + w_80,
        d_law_of_alpha_by_gamma*w_64 + d_law_of_beta_by_gamma*w_69 + lambda_gamma*(2.0*inv_w_71*mu*sin_gamma - inv_w_56*sin_gamma_v) + lambda_psi*(w_83 - inv_w_61_sin_theta*sin_gamma_v_sin_psi) - cos_gamma_twice_mu*inv_w_59*lambda_v - w_81 - w_82,
        cos_gamma_v*cos_psi_lambda_psi*inv_w_61_sin_theta + w_84,
        0.0,
        w_2,
        w_8,
        d_law_of_alpha_by_lambda_v*w_64 - b_0_inv_h_r*v_sq_w_30 - half_b_1_w_63*w_27 - inv_h_r_v_sq*w_30*w_31 - inv_w_59*sin_gamma_twice_mu,
        cos_gamma_v*inv_w_56 + d_law_of_alpha_by_lambda_gamma*w_64 + d_law_of_beta_by_lambda_gamma*w_69 + w_67 + w_68 - cos_gamma_twice_mu*inv_w_71,
        a_1_w_27_w_51*inv_h_r + cos_gamma_v_sin_psi*inv_w_61_sin_theta + d_law_of_alpha_by_lambda_psi*w_64 + d_law_of_beta_by_lambda_psi*w_69 + inv_cos_gamma*w_65,
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
        lambda_psi_w_85*w_73 + w_74,
        0.0,
        -lambda_phi*sin_theta_sq*w_87 - lambda_psi_w_85*sin_theta*w_87 - w_86,
        -lambda_psi_w_85*w_88 - w_89,
        inv_cos_theta_sq_sin_psi*w_85*w_91 + w_90,
        -w_85*w_93 - w_92,
        0.0,
        -w_4,
        0.0,
        0.0,
        0.0,
        -inv_cos_theta_sq_w_3*w_85,
        d_law_of_alpha_by_h*w_94 + d_law_of_beta_by_h*w_95 + lambda_gamma*(cos_gamma_inv_w_sq + w_75 - w_97*(-twice_h*v_sq - twice_r_e*v_sq)) + lambda_psi*(cos_gamma_sin_psi_w_99*cos_theta + w_77) + w_80 - inv_h_r*lambda_v*v_w_32,
        0.0,
        lambda_psi*(-cos_gamma_sin_psi_w_99*w_101 - cos_theta*w_100) - w_89,
        d_law_of_alpha_by_v*w_94 + d_law_of_beta_by_v*w_95 + lambda_v*w_32 - lambda_gamma*w_97*(-4.0*h_r_e*v - h_sq*twice_v - r_e_sq*twice_v),
        d_law_of_alpha_by_gamma*w_94 + d_law_of_beta_by_gamma*w_95 + lambda_gamma*(inv_w_96_mu*sin_gamma + inv_w_sin_gamma) + w_102,
        -cos_gamma*w_103 - w_104,
        -sin_gamma,
        -w_5,
        -cos_gamma_inv_w_cos_psi,
        d_law_of_alpha_by_lambda_v*w_94 + v_w_32,
        d_law_of_alpha_by_lambda_gamma*w_94 + d_law_of_beta_by_lambda_gamma*w_95 - a_0_cos_w_48_w_30 - a_1_w_27_cos_w_48_w_30 - cos_gamma*inv_w_96_mu - cos_gamma_inv_w,
        d_law_of_alpha_by_lambda_psi*w_94 + d_law_of_beta_by_lambda_psi*w_95 - a_1_w_27_w_52 - sin_theta*w_100 - w_76,
        d_law_of_beta_by_h*lambda_psi*w_106 + inv_w_sq*lambda_gamma*sin_gamma*v + lambda_psi*(w_83 - w_107*w_99) - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_h - cos_gamma*inv_w_cubed_twice_mu*lambda_v - 2.0*inv_v_w_105_lambda_gamma*inv_w_cubed*sin_gamma - w_81 - w_82,
        0.0,
        lambda_psi*(inv_w_98*w_107 + sin_gamma_v_sin_psi*w_101*w_99) + w_90,
        d_law_of_beta_by_v*lambda_psi_w_106 + inv_v*w_108*(h*twice_v + r_e*twice_v) + w_102 - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_v - inv_v_sq_2*w_105*w_108,
        cos_gamma_inv_w_sq*inv_v_w_105_lambda_gamma + d_law_of_beta_by_gamma*lambda_psi_w_106 + lambda_h*sin_gamma_v + lambda_psi*(cos_gamma*inv_w_98*sin_psi*sin_theta*v - a_0*w_109 - a_1_w_27*w_109 - a_1_w_27_w_51 - w_60) + w_110 - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_gamma - inv_w_sq_mu*lambda_v*sin_gamma,
        sin_gamma_v*w_103 + w_111,
        -cos_gamma_v,
        w_6,
        w_9,
        cos_gamma_inv_w_sq_mu - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_lambda_v,
        d_law_of_beta_by_lambda_gamma*lambda_psi_w_106 + inv_v_w_105*inv_w_sq_sin_gamma - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_lambda_gamma,
        d_law_of_beta_by_lambda_psi*lambda_psi*w_106 + inv_w_98*sin_gamma*sin_psi*sin_theta*v - a_0_sin_w_48_w_50*w_54 - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_lambda_psi - a_1_w_27*sin_w_48_w_50*w_54,
        w_112*w_8 + w_84,
        0.0,
        -lambda_psi_w_7 - sin_theta_sq*w_93 - w_92,
        -cos_gamma_inv_w_cos_psi*w_112 - w_104,
        cos_psi*inv_cos_theta_sin_theta*w_91 + w_111,
        w_110 + w_112*w_3,
        0.0,
        -inv_cos_theta_w_7,
        w_3,
        0.0,
        0.0,
        -w_55,
    )


def canonical_drift(t, x, lam, p, bounds):
    """The canonical rates by explicit time."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
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
    )


def boundary(t, x, lam, nu, p, bounds, final):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    given_h, given_phi, given_theta, given_v, given_gamma, given_psi, on_reference_h, on_reference_phi, on_reference_theta, on_reference_v, on_reference_gamma, on_reference_psi, target_h, target_phi, target_theta, target_v, target_gamma, target_psi = final
    w = h + r_e
    inv_w = 1.0/w
    inv_v = 1.0/v
    cos_gamma = math.cos(gamma)
    inv_cos_gamma = 1.0/cos_gamma
    w_2 = inv_w*inv_w*mu
    v_sq = v*v
    sin_gamma = math.sin(gamma)
    cos_gamma_inv_w_v = cos_gamma*inv_w*v
    cos_theta = math.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    w_3 = cos_gamma_inv_w_v*inv_cos_theta*math.sin(psi)
    inv_h_r = 1.0/h_r
    h_inv_h_r = h*inv_h_r
    inv_m = 1.0/m
    area_inv_m_rho_0 = area*inv_m*rho_0
    w_4 = area_inv_m_rho_0*math.exp(-h_inv_h_r)
    half_v = 0.5*v
    law_part_8 = half_v*w_4
    law_part_11 = inv_cos_gamma*lambda_psi*law_part_8
    w_5 = 0.5*((beta_min if beta_min > (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi else (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi) + (beta_max if beta_max < (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi else (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi))
    law_part_10 = math.cos(w_5)
    law_part_5 = math.sin(w_5)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_6 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_7 = math.atan2(w_6, law_part_13) + 0.0/(w_6*w_6 + law_part_13*law_part_13)
    w_8 = w_5 + w_7
    w_9 = beta_min if w_8 < beta_min else beta_max if w_8 > beta_max else w_8
    law_part_15 = law_part_11*math.sin(w_9) + law_part_9*math.cos(w_9)
    inv_lambda_v = 1.0/lambda_v
    inv_v_sq = 1.0/v_sq
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    inv_b_2 = 1.0/b_2
    law_part_17 = a_1*inv_area*inv_b_2*inv_lambda_v*inv_rho_0*inv_v_sq*m*math.exp(h_inv_h_r)
    law_part_2 = 0.5*b_1
    law_part_3 = -inv_b_2*law_part_2
    w_10 = law_part_15*law_part_17 + law_part_3
    law_part_18 = lambda_v*v_sq*w_4
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_11 = w_10 + 0.0*math.sqrt(law_part_20)
    w_12 = alpha_min if w_11 < alpha_min else alpha_max if w_11 > alpha_max else w_11
    w_13 = -law_part_13
    w_14 = math.atan2(law_part_12, w_13) + 0.0/(law_part_12*law_part_12 + w_13*w_13)
    w_15 = w_14 + w_5
    w_16 = beta_min if w_15 < beta_min else beta_max if w_15 > beta_max else w_15
    law_part_24 = law_part_11*math.sin(w_16) + law_part_9*math.cos(w_16)
    w_17 = law_part_17*law_part_24 + law_part_3
    w_18 = w_17 + 0.0*math.sqrt(law_part_20)
    w_19 = alpha_min if w_18 < alpha_min else alpha_max if w_18 > alpha_max else w_18
    law_part_22 = law_part_18*law_part_2
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_12 + law_part_24*(a_0 + a_1*w_19) + law_part_26*w_12*w_12 - law_part_15*(a_0 + a_1*w_12) - law_part_22*w_19 - law_part_26*w_19*w_19
    w_20 = (w_19 if law_part_27 <= 0.0 else w_12) + 0.0*law_part_27
    w_21 = half_v*w_4*(a_0 + a_1*w_20)
    w_22 = (w_16 if law_part_27 <= 0.0 else w_9) + 0.0*law_part_27
    return (
        given_h*(h - target_h) + h*on_reference_h + lambda_h*(1.0 - given_h - on_reference_h),
        given_phi*(phi - target_phi) + lambda_phi*(1.0 - given_phi - on_reference_phi) + on_reference_phi*phi,
        given_theta*(theta - target_theta) + on_reference_theta*theta - (-lambda_theta - 1.0)*(1.0 - given_theta - on_reference_theta),
        given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v,
        gamma*on_reference_gamma + given_gamma*(gamma - target_gamma) + lambda_gamma*(1.0 - given_gamma - on_reference_gamma),
        given_psi*(psi - target_psi) + lambda_psi*(1.0 - given_psi - on_reference_psi) + on_reference_psi*psi,
        cos_gamma_inv_w_v*lambda_theta*math.cos(psi) + lambda_gamma*(cos_gamma*(inv_w*v - inv_v*w_2) + w_21*math.cos(w_22)) + lambda_h*sin_gamma*v + lambda_phi*w_3 + lambda_psi*(inv_cos_gamma*w_21*math.sin(w_22) + w_3*math.sin(theta)) + lambda_v*(-sin_gamma*w_2 - 0.5*v_sq*w_4*(b_0 + b_1*w_20 + b_2*w_20*w_20)),
    )


def boundary_jacobian(t, x, lam, nu, p, bounds, final):
    """The boundary residuals by states, costates, multipliers and final time, row by row."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    given_h, given_phi, given_theta, given_v, given_gamma, given_psi, on_reference_h, on_reference_phi, on_reference_theta, on_reference_v, on_reference_gamma, on_reference_psi, target_h, target_phi, target_theta, target_v, target_gamma, target_psi = final
    w = given_h + on_reference_h
    w_2 = given_phi + on_reference_phi
    w_3 = given_theta + on_reference_theta
    w_4 = given_v + on_reference_v
    w_5 = given_gamma + on_reference_gamma
    w_6 = given_psi + on_reference_psi
    inv_h_r = 1.0/h_r
    inv_v = 1.0/v
    sin_gamma = math.sin(gamma)
    cos_gamma = math.cos(gamma)
    sin_theta = math.sin(theta)
    cos_psi = math.cos(psi)
    cos_psi_lambda_theta = cos_psi*lambda_theta
    w_7 = h + r_e
    inv_w_7 = 1.0/w_7
    inv_w_7_sq = inv_w_7*inv_w_7
    inv_w_7_sq_v = inv_w_7_sq*v
    cos_gamma_inv_w_7_sq_v = cos_gamma*inv_w_7_sq_v
    cos_theta = math.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    sin_psi = math.sin(psi)
    inv_cos_theta_sin_psi = inv_cos_theta*sin_psi
    w_8 = cos_gamma_inv_w_7_sq_v*inv_cos_theta_sin_psi
    w_9 = 2.0*inv_w_7*inv_w_7*inv_w_7*mu
    w_10 = 0.5*((beta_min if beta_min > (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi else (beta_max if beta_max < math.pi else math.pi) - 2.0*math.pi) + (beta_max if beta_max < (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi else (beta_min if beta_min > -math.pi else -math.pi) + 2.0*math.pi))
    law_part_10 = math.cos(w_10)
    inv_cos_gamma = 1.0/cos_gamma
    inv_m = 1.0/m
    area_inv_m_rho_0 = area*inv_m*rho_0
    h_inv_h_r = h*inv_h_r
    w_11 = area_inv_m_rho_0*math.exp(-h_inv_h_r)
    half_w_11 = 0.5*w_11
    law_part_8 = half_w_11*v
    inv_cos_gamma_law_part_8 = inv_cos_gamma*law_part_8
    law_part_11 = inv_cos_gamma_law_part_8*lambda_psi
    law_part_5 = math.sin(w_10)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_12 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_13 = math.atan2(w_12, law_part_13) + 0.0/(w_12*w_12 + law_part_13*law_part_13)
    w_14 = w_10 + w_13
    w_15 = beta_min if w_14 < beta_min else beta_max if w_14 > beta_max else w_14
    sin_w_15 = math.sin(w_15)
    cos_w_15 = math.cos(w_15)
    law_part_15 = cos_w_15*law_part_9 + law_part_11*sin_w_15
    inv_lambda_v = 1.0/lambda_v
    v_sq = v*v
    inv_v_sq = 1.0/v_sq
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    exp_h_inv_h_r = math.exp(h_inv_h_r)
    inv_b_2 = 1.0/b_2
    w_16 = a_1*exp_h_inv_h_r*inv_area*inv_b_2*inv_rho_0*inv_v_sq*m
    inv_lambda_v_w_16 = inv_lambda_v*w_16
    law_part_2 = 0.5*b_1
    law_part_3 = -inv_b_2*law_part_2
    w_17 = inv_lambda_v_w_16*law_part_15 + law_part_3
    law_part_18 = lambda_v*v_sq*w_11
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_18 = w_17 + 0.0*math.sqrt(law_part_20)
    w_19 = alpha_min if w_18 < alpha_min else alpha_max if w_18 > alpha_max else w_18
    w_20 = -law_part_13
    w_21 = math.atan2(law_part_12, w_20) + 0.0/(law_part_12*law_part_12 + w_20*w_20)
    w_22 = w_10 + w_21
    w_23 = beta_min if w_22 < beta_min else beta_max if w_22 > beta_max else w_22
    sin_w_23 = math.sin(w_23)
    cos_w_23 = math.cos(w_23)
    law_part_24 = cos_w_23*law_part_9 + law_part_11*sin_w_23
    w_24 = inv_lambda_v_w_16*law_part_24 + law_part_3
    w_25 = w_24 + 0.0*math.sqrt(law_part_20)
    w_26 = alpha_min if w_25 < alpha_min else alpha_max if w_25 > alpha_max else w_25
    law_part_22 = law_part_18*law_part_2
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_19 + law_part_24*(a_0 + a_1*w_26) + law_part_26*w_19*w_19 - law_part_15*(a_0 + a_1*w_19) - law_part_22*w_26 - law_part_26*w_26*w_26
    w_27 = (w_26 if law_part_27 <= 0.0 else w_19) + 0.0*law_part_27
    w_28 = b_0 + b_1*w_27 + b_2*w_27*w_27
    half_w_11_v_sq = half_w_11*v_sq
    half_w_11_v_sq_w_28 = half_w_11_v_sq*w_28
    w_29 = (w_23 if law_part_27 <= 0.0 else w_15) + 0.0*law_part_27
    sin_w_29 = math.sin(w_29)
    inv_cos_gamma_sin_w_29 = inv_cos_gamma*sin_w_29
    w_30 = a_0 + a_1*w_27
    half_v = 0.5*v
    half_v_w_11 = half_v*w_11
    half_v_w_11_w_30 = half_v_w_11*w_30
    w_31 = half_v_w_11_w_30*inv_cos_gamma_sin_w_29
    cos_w_29 = math.cos(w_29)
    cos_w_29_half_v_w_11 = cos_w_29*half_v_w_11
    w_32 = cos_w_29_half_v_w_11*w_30
    inv_cos_gamma_lambda_psi = inv_cos_gamma*lambda_psi
    w_33 = inv_cos_gamma_lambda_psi*w_32 - half_v_w_11_w_30*lambda_gamma*sin_w_29
    w_34 = a_1*cos_w_29_half_v_w_11*lambda_gamma + a_1*half_v_w_11*inv_cos_gamma_lambda_psi*sin_w_29 - half_w_11_v_sq*lambda_v*(b_1 + 2.0*b_2*w_27)
    w_35 = (0.0 if law_part_27 <= 0.0 else 1.0) + 0.0*law_part_27
    w_36 = (1.0 if law_part_27 <= 0.0 else 0.0) + 0.0*law_part_27
    w_37 = 0.0 if w_18 < alpha_min else 0.0 if w_18 > alpha_max else 1.0
    inv_lambda_v_w_16_w_37 = inv_lambda_v_w_16*w_37
    law_part_15_w_37 = law_part_15*w_37
    w_38 = cos_w_15*law_part_11 - law_part_9*sin_w_15
    d_law_part_7_by_h = -inv_h_r*w_11
    d_law_part_8_by_h = d_law_part_7_by_h*half_v
    d_law_part_11_by_h = d_law_part_8_by_h*inv_cos_gamma_lambda_psi
    w_39 = law_part_12*law_part_12 + law_part_13*law_part_13
    inv_w_39 = 1.0/w_39
    w_40 = 0.0 if w_14 < beta_min else 0.0 if w_14 > beta_max else 1.0
    inv_w_39_w_40 = inv_w_39*w_40
    d_law_part_9_by_h = d_law_part_8_by_h*lambda_gamma
    d_law_part_12_by_h = d_law_part_9_by_h*law_part_5 - d_law_part_11_by_h*law_part_10
    w_41 = d_law_part_12_by_h*law_part_13
    d_law_part_13_by_h = d_law_part_11_by_h*law_part_5 + d_law_part_9_by_h*law_part_10
    d_law_part_14_by_h = d_law_part_13_by_h*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_41
    d_law_part_15_by_h = cos_w_15*d_law_part_9_by_h + d_law_part_11_by_h*sin_w_15 + d_law_part_14_by_h*w_38
    d_law_part_17_by_h = inv_h_r*inv_lambda_v_w_16
    d_law_part_21_by_h = d_law_part_15_by_h*inv_lambda_v_w_16_w_37 + d_law_part_17_by_h*law_part_15_w_37
    w_42 = 0.0 if w_25 < alpha_min else 0.0 if w_25 > alpha_max else 1.0
    law_part_24_w_42 = law_part_24*w_42
    inv_lambda_v_w_16_w_42 = inv_lambda_v_w_16*w_42
    w_43 = cos_w_23*law_part_11 - law_part_9*sin_w_23
    w_44 = 0.0 if w_22 < beta_min else 0.0 if w_22 > beta_max else 1.0
    inv_w_39_w_44 = inv_w_39*w_44
    d_law_part_23_by_h = d_law_part_13_by_h*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_41
    d_law_part_24_by_h = cos_w_23*d_law_part_9_by_h + d_law_part_11_by_h*sin_w_23 + d_law_part_23_by_h*w_43
    d_law_part_25_by_h = d_law_part_17_by_h*law_part_24_w_42 + d_law_part_24_by_h*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_h = d_law_part_21_by_h*w_35 + d_law_part_25_by_h*w_36
    d_law_of_beta_by_h = d_law_part_14_by_h*w_35 + d_law_part_23_by_h*w_36
    inv_w_7_v = inv_w_7*v
    cos_gamma_inv_w_7_v = cos_gamma*inv_w_7_v
    w_45 = cos_gamma_inv_w_7_v*sin_psi
    w_46 = inv_cos_theta*inv_cos_theta*w_45
    cos_gamma_inv_w_7 = cos_gamma*inv_w_7
    w_47 = cos_gamma_inv_w_7*inv_cos_theta_sin_psi
    half_w_11_w_30 = half_w_11*w_30
    inv_w_7_sq_mu = inv_w_7_sq*mu
    d_law_part_11_by_v = half_w_11*inv_cos_gamma_lambda_psi
    d_law_part_9_by_v = half_w_11*lambda_gamma
    d_law_part_12_by_v = d_law_part_9_by_v*law_part_5 - d_law_part_11_by_v*law_part_10
    w_48 = d_law_part_12_by_v*law_part_13
    d_law_part_13_by_v = d_law_part_11_by_v*law_part_5 + d_law_part_9_by_v*law_part_10
    d_law_part_14_by_v = d_law_part_13_by_v*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_48
    d_law_part_15_by_v = cos_w_15*d_law_part_9_by_v + d_law_part_11_by_v*sin_w_15 + d_law_part_14_by_v*w_38
    d_law_part_16_by_v = 2.0*v
    d_law_part_17_by_v = -a_1*d_law_part_16_by_v*exp_h_inv_h_r*inv_area*inv_b_2*inv_lambda_v*inv_rho_0*inv_v_sq*inv_v_sq*m
    d_law_part_21_by_v = d_law_part_15_by_v*inv_lambda_v_w_16_w_37 + d_law_part_17_by_v*law_part_15_w_37
    d_law_part_23_by_v = d_law_part_13_by_v*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_48
    d_law_part_24_by_v = cos_w_23*d_law_part_9_by_v + d_law_part_11_by_v*sin_w_23 + d_law_part_23_by_v*w_43
    d_law_part_25_by_v = d_law_part_17_by_v*law_part_24_w_42 + d_law_part_24_by_v*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_v = d_law_part_21_by_v*w_35 + d_law_part_25_by_v*w_36
    d_law_of_beta_by_v = d_law_part_14_by_v*w_35 + d_law_part_23_by_v*w_36
    inv_cos_gamma_sq = inv_cos_gamma*inv_cos_gamma
    inv_w_7_v_sin_gamma = inv_w_7_v*sin_gamma
    w_49 = inv_cos_theta_sin_psi*inv_w_7_v_sin_gamma
    w_50 = inv_w_7*v - inv_v*inv_w_7_sq_mu
    sin_gamma_v = sin_gamma*v
    d_law_part_11_by_gamma = inv_cos_gamma_sq*lambda_psi*law_part_8*sin_gamma
    d_law_part_12_by_gamma = -d_law_part_11_by_gamma*law_part_10
    w_51 = d_law_part_12_by_gamma*law_part_13
    d_law_part_13_by_gamma = d_law_part_11_by_gamma*law_part_5
    d_law_part_14_by_gamma = d_law_part_13_by_gamma*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_51
    d_law_part_15_by_gamma = d_law_part_11_by_gamma*sin_w_15 + d_law_part_14_by_gamma*w_38
    d_law_part_21_by_gamma = d_law_part_15_by_gamma*inv_lambda_v_w_16_w_37
    d_law_part_23_by_gamma = d_law_part_13_by_gamma*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_51
    d_law_part_24_by_gamma = d_law_part_11_by_gamma*sin_w_23 + d_law_part_23_by_gamma*w_43
    d_law_part_25_by_gamma = d_law_part_24_by_gamma*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_gamma = d_law_part_21_by_gamma*w_35 + d_law_part_25_by_gamma*w_36
    d_law_of_beta_by_gamma = d_law_part_14_by_gamma*w_35 + d_law_part_23_by_gamma*w_36
    w_52 = cos_gamma_inv_w_7_v*cos_psi
    inv_cos_theta_w_52 = inv_cos_theta*w_52
    inv_cos_theta_w_45 = inv_cos_theta*w_45
    d_law_part_17_by_lambda_v = -inv_lambda_v*inv_lambda_v*w_16
    d_law_part_21_by_lambda_v = d_law_part_17_by_lambda_v*law_part_15_w_37
    d_law_part_25_by_lambda_v = d_law_part_17_by_lambda_v*law_part_24_w_42
    d_law_of_alpha_by_lambda_v = d_law_part_21_by_lambda_v*w_35 + d_law_part_25_by_lambda_v*w_36
    d_law_part_12_by_lambda_gamma = law_part_5*law_part_8
    w_53 = d_law_part_12_by_lambda_gamma*law_part_13
    d_law_part_13_by_lambda_gamma = law_part_10*law_part_8
    d_law_part_14_by_lambda_gamma = d_law_part_13_by_lambda_gamma*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_53
    d_law_part_15_by_lambda_gamma = cos_w_15*law_part_8 + d_law_part_14_by_lambda_gamma*w_38
    d_law_part_21_by_lambda_gamma = d_law_part_15_by_lambda_gamma*inv_lambda_v_w_16_w_37
    d_law_part_23_by_lambda_gamma = d_law_part_13_by_lambda_gamma*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_53
    d_law_part_24_by_lambda_gamma = cos_w_23*law_part_8 + d_law_part_23_by_lambda_gamma*w_43
    d_law_part_25_by_lambda_gamma = d_law_part_24_by_lambda_gamma*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_lambda_gamma = d_law_part_21_by_lambda_gamma*w_35 + d_law_part_25_by_lambda_gamma*w_36
    d_law_of_beta_by_lambda_gamma = d_law_part_14_by_lambda_gamma*w_35 + d_law_part_23_by_lambda_gamma*w_36
    d_law_part_12_by_lambda_psi = -inv_cos_gamma_law_part_8*law_part_10
    w_54 = d_law_part_12_by_lambda_psi*law_part_13
    d_law_part_13_by_lambda_psi = inv_cos_gamma_law_part_8*law_part_5
    d_law_part_14_by_lambda_psi = d_law_part_13_by_lambda_psi*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_54
    d_law_part_15_by_lambda_psi = d_law_part_14_by_lambda_psi*w_38 + inv_cos_gamma_law_part_8*sin_w_15
    d_law_part_21_by_lambda_psi = d_law_part_15_by_lambda_psi*inv_lambda_v_w_16_w_37
    d_law_part_23_by_lambda_psi = d_law_part_13_by_lambda_psi*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_54
    d_law_part_24_by_lambda_psi = d_law_part_23_by_lambda_psi*w_43 + inv_cos_gamma_law_part_8*sin_w_23
    d_law_part_25_by_lambda_psi = d_law_part_24_by_lambda_psi*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_lambda_psi = d_law_part_21_by_lambda_psi*w_35 + d_law_part_25_by_lambda_psi*w_36
    d_law_of_beta_by_lambda_psi = d_law_part_14_by_lambda_psi*w_35 + d_law_part_23_by_lambda_psi*w_36
    return (
        w,
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
        w_2,
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
        w_3,
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
        w_4,
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
        w_5,
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
        w_6,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0 - w_6,
        0.0,
        d_law_of_alpha_by_h*w_34 + d_law_of_beta_by_h*w_33 + lambda_gamma*(cos_gamma*(inv_v*w_9 - inv_w_7_sq_v) - inv_h_r*w_32) + lambda_psi*(-inv_h_r*w_31 - sin_theta*w_8) + lambda_v*(half_w_11_v_sq_w_28*inv_h_r + sin_gamma*w_9) - cos_gamma_inv_w_7_sq_v*cos_psi_lambda_theta - lambda_phi*w_8,
        0.0,
        lambda_phi*sin_theta*w_46 + lambda_psi*(sin_theta*sin_theta*w_46 + w_45),
        cos_gamma_inv_w_7*cos_psi_lambda_theta + d_law_of_alpha_by_v*w_34 + d_law_of_beta_by_v*w_33 + lambda_gamma*(cos_gamma*(inv_v*inv_v*inv_w_7_sq_mu + inv_w_7) + cos_w_29*half_w_11_w_30) + lambda_h*sin_gamma + lambda_phi*w_47 + lambda_psi*(half_w_11_w_30*inv_cos_gamma_sin_w_29 + sin_theta*w_47) - lambda_v*v*w_11*w_28,
        cos_gamma*lambda_h*v + d_law_of_alpha_by_gamma*w_34 + d_law_of_beta_by_gamma*w_33 + lambda_psi*(half_w_11_w_30*inv_cos_gamma_sq*sin_gamma_v*sin_w_29 - sin_theta*w_49) - cos_gamma*inv_w_7_sq_mu*lambda_v - cos_psi_lambda_theta*inv_w_7_v_sin_gamma - lambda_gamma*sin_gamma*w_50 - lambda_phi*w_49,
        inv_cos_theta_w_52*lambda_phi + inv_cos_theta_w_52*lambda_psi*sin_theta - lambda_theta*w_45,
        sin_gamma_v,
        inv_cos_theta_w_45,
        w_52,
        d_law_of_alpha_by_lambda_v*w_34 - half_w_11_v_sq_w_28 - inv_w_7_sq_mu*sin_gamma,
        cos_gamma*w_50 + d_law_of_alpha_by_lambda_gamma*w_34 + d_law_of_beta_by_lambda_gamma*w_33 + w_32,
        d_law_of_alpha_by_lambda_psi*w_34 + d_law_of_beta_by_lambda_psi*w_33 + inv_cos_theta_w_45*sin_theta + w_31,
        0.0,
    )


def forward(times, x0, u, u_mid, p, x, x_mid):
    """RK4 over the nodes from x0 at times[0]; returns the integral of the running cost."""
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    h_at, phi_at, theta_at, v_at, gamma_at, psi_at = x
    h_mid, phi_mid, theta_mid, v_mid, gamma_mid, psi_mid = x_mid
    alpha_at, beta_at = u
    alpha_mid, beta_mid = u_mid
    h, phi, theta, v, gamma, psi = x0
    inv_m = 1.0/m
    w_4 = 0.5*area*inv_m*rho_0
    inv_h_r = 1.0/h_r
    steps = len(times) - 1
    t = times[0]
    h_at[0] = h
    phi_at[0] = phi
    theta_at[0] = theta
    v_at[0] = v
    gamma_at[0] = gamma
    psi_at[0] = psi
    alpha = alpha_at[0]
    beta = beta_at[0]
    sin_gamma = math.sin(gamma)
    cos_theta = math.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    w = h + r_e
    inv_w = 1.0/w
    cos_gamma = math.cos(gamma)
    cos_gamma_inv_w_v = cos_gamma*inv_w*v
    w_2 = cos_gamma_inv_w_v*inv_cos_theta*math.sin(psi)
    w_3 = inv_w*inv_w*mu
    w_5 = w_4*math.exp(-h*inv_h_r)
    inv_v = 1.0/v
    w_6 = v*w_5*(a_0 + a_1*alpha)
    inv_cos_gamma = 1.0/cos_gamma
    slope_h = sin_gamma*v
    slope_phi = w_2
    slope_theta = cos_gamma_inv_w_v*math.cos(psi)
    slope_v = -sin_gamma*w_3 - v*v*w_5*(alpha*alpha*b_2 + alpha*b_1 + b_0)
    slope_gamma = cos_gamma*(inv_w*v - inv_v*w_3) + w_6*math.cos(beta)
    slope_psi = inv_cos_gamma*w_6*math.sin(beta) + w_2*math.sin(theta)
    total = 0.0
    for i in range(steps):
        t_end = times[i + 1]
        h_2 = t_end - t
        h_at[i] = h
        phi_at[i] = phi
        theta_at[i] = theta
        v_at[i] = v
        gamma_at[i] = gamma
        psi_at[i] = psi
        alpha_half = alpha_mid[i]
        alpha_end = alpha_at[i + 1]
        beta_half = beta_mid[i]
        beta_end = beta_at[i + 1]
        half = 0.5*h_2
        sixth = (1.0/6.0)*h_2
        h_2_2 = h + half*slope_h
        theta_2 = half*slope_theta + theta
        v_2 = half*slope_v + v
        gamma_2 = gamma + half*slope_gamma
        psi_2 = half*slope_psi + psi
        sin_gamma_2 = math.sin(gamma_2)
        cos_theta_2 = math.cos(theta_2)
        inv_cos_theta_2 = 1.0/cos_theta_2
        w_7 = h_2_2 + r_e
        inv_w_7 = 1.0/w_7
        cos_gamma_2 = math.cos(gamma_2)
        cos_gamma_2_inv_w_7_v_2 = cos_gamma_2*inv_w_7*v_2
        k2_phi = cos_gamma_2_inv_w_7_v_2*inv_cos_theta_2*math.sin(psi_2)
        w_8 = inv_w_7*inv_w_7*mu
        w_9 = w_4*math.exp(-h_2_2*inv_h_r)
        inv_v_2 = 1.0/v_2
        w_10 = v_2*w_9*(a_0 + a_1*alpha_half)
        inv_cos_gamma_2 = 1.0/cos_gamma_2
        k2_h = sin_gamma_2*v_2
        k2_theta = cos_gamma_2_inv_w_7_v_2*math.cos(psi_2)
        k2_v = -sin_gamma_2*w_8 - v_2*v_2*w_9*(alpha_half*alpha_half*b_2 + alpha_half*b_1 + b_0)
        k2_gamma = cos_gamma_2*(inv_w_7*v_2 - inv_v_2*w_8) + w_10*math.cos(beta_half)
        k2_psi = inv_cos_gamma_2*w_10*math.sin(beta_half) + k2_phi*math.sin(theta_2)
        h_3 = h + half*k2_h
        theta_3 = half*k2_theta + theta
        v_3 = half*k2_v + v
        gamma_3 = gamma + half*k2_gamma
        psi_3 = half*k2_psi + psi
        sin_gamma_3 = math.sin(gamma_3)
        cos_theta_3 = math.cos(theta_3)
        inv_cos_theta_3 = 1.0/cos_theta_3
        w_11 = h_3 + r_e
        inv_w_11 = 1.0/w_11
        cos_gamma_3 = math.cos(gamma_3)
        cos_gamma_3_inv_w_11_v_3 = cos_gamma_3*inv_w_11*v_3
        k3_phi = cos_gamma_3_inv_w_11_v_3*inv_cos_theta_3*math.sin(psi_3)
        w_12 = inv_w_11*inv_w_11*mu
        w_13 = w_4*math.exp(-h_3*inv_h_r)
        inv_v_3 = 1.0/v_3
        w_14 = v_3*w_13*(a_0 + a_1*alpha_half)
        inv_cos_gamma_3 = 1.0/cos_gamma_3
        k3_h = sin_gamma_3*v_3
        k3_theta = cos_gamma_3_inv_w_11_v_3*math.cos(psi_3)
        k3_v = -sin_gamma_3*w_12 - v_3*v_3*w_13*(alpha_half*alpha_half*b_2 + alpha_half*b_1 + b_0)
        k3_gamma = cos_gamma_3*(inv_w_11*v_3 - inv_v_3*w_12) + w_14*math.cos(beta_half)
        k3_psi = inv_cos_gamma_3*w_14*math.sin(beta_half) + k3_phi*math.sin(theta_3)
        h_4 = h + h_2*k3_h
        theta_4 = h_2*k3_theta + theta
        v_4 = h_2*k3_v + v
        gamma_4 = gamma + h_2*k3_gamma
        psi_4 = h_2*k3_psi + psi
        sin_gamma_4 = math.sin(gamma_4)
        cos_theta_4 = math.cos(theta_4)
        inv_cos_theta_4 = 1.0/cos_theta_4
        w_15 = h_4 + r_e
        inv_w_15 = 1.0/w_15
        cos_gamma_4 = math.cos(gamma_4)
        cos_gamma_4_inv_w_15_v_4 = cos_gamma_4*inv_w_15*v_4
        k4_phi = cos_gamma_4_inv_w_15_v_4*inv_cos_theta_4*math.sin(psi_4)
        w_16 = inv_w_15*inv_w_15*mu
        w_17 = w_4*math.exp(-h_4*inv_h_r)
        inv_v_4 = 1.0/v_4
        w_18 = v_4*w_17*(a_0 + a_1*alpha_end)
        inv_cos_gamma_4 = 1.0/cos_gamma_4
        k4_h = sin_gamma_4*v_4
        k4_theta = cos_gamma_4_inv_w_15_v_4*math.cos(psi_4)
        k4_v = -sin_gamma_4*w_16 - v_4*v_4*w_17*(alpha_end*alpha_end*b_2 + alpha_end*b_1 + b_0)
        k4_gamma = cos_gamma_4*(inv_w_15*v_4 - inv_v_4*w_16) + w_18*math.cos(beta_end)
        k4_psi = inv_cos_gamma_4*w_18*math.sin(beta_end) + k4_phi*math.sin(theta_4)
        h_end = h + sixth*(k4_h + slope_h + 2.0*(k2_h + k3_h))
        phi_end = phi + sixth*(k4_phi + slope_phi + 2.0*(k2_phi + k3_phi))
        theta_end = sixth*(k4_theta + slope_theta + 2.0*(k2_theta + k3_theta)) + theta
        v_end = sixth*(k4_v + slope_v + 2.0*(k2_v + k3_v)) + v
        gamma_end = gamma + sixth*(k4_gamma + slope_gamma + 2.0*(k2_gamma + k3_gamma))
        psi_end = psi + sixth*(k4_psi + slope_psi + 2.0*(k2_psi + k3_psi))
        sin_gamma_end = math.sin(gamma_end)
        cos_theta_end = math.cos(theta_end)
        inv_cos_theta_end = 1.0/cos_theta_end
        w_19 = h_end + r_e
        inv_w_19 = 1.0/w_19
        cos_gamma_end = math.cos(gamma_end)
        w_20 = cos_gamma_end*inv_w_19*v_end
        slope_end_phi = inv_cos_theta_end*w_20*math.sin(psi_end)
        w_21 = inv_w_19*inv_w_19*mu
        w_22 = w_4*math.exp(-h_end*inv_h_r)
        inv_v_end = 1.0/v_end
        w_23 = v_end*w_22*(a_0 + a_1*alpha_end)
        inv_cos_gamma_end = 1.0/cos_gamma_end
        slope_end_h = sin_gamma_end*v_end
        slope_end_theta = w_20*math.cos(psi_end)
        slope_end_v = -sin_gamma_end*w_21 - v_end*v_end*w_22*(alpha_end*alpha_end*b_2 + alpha_end*b_1 + b_0)
        slope_end_gamma = cos_gamma_end*(inv_w_19*v_end - inv_v_end*w_21) + w_23*math.cos(beta_end)
        slope_end_psi = inv_cos_gamma_end*w_23*math.sin(beta_end) + slope_end_phi*math.sin(theta_end)
        eighth = 0.125*h_2
        h_mid[i] = eighth*(slope_h - slope_end_h) + 0.5*(h + h_end)
        phi_mid[i] = eighth*(slope_phi - slope_end_phi) + 0.5*(phi + phi_end)
        theta_mid[i] = eighth*(slope_theta - slope_end_theta) + 0.5*(theta + theta_end)
        v_mid[i] = eighth*(slope_v - slope_end_v) + 0.5*(v + v_end)
        gamma_mid[i] = eighth*(slope_gamma - slope_end_gamma) + 0.5*(gamma + gamma_end)
        psi_mid[i] = eighth*(slope_psi - slope_end_psi) + 0.5*(psi + psi_end)
        total = total
        t = t_end
        h = h_end
        phi = phi_end
        theta = theta_end
        v = v_end
        gamma = gamma_end
        psi = psi_end
        slope_h = slope_end_h
        slope_phi = slope_end_phi
        slope_theta = slope_end_theta
        slope_v = slope_end_v
        slope_gamma = slope_end_gamma
        slope_psi = slope_end_psi
    h_at[steps] = h
    phi_at[steps] = phi
    theta_at[steps] = theta
    v_at[steps] = v
    gamma_at[steps] = gamma
    psi_at[steps] = psi
    return total


def backward(times, lam_f, x, x_mid, u, u_mid, p, lam, lam_mid):
    """RK4 over the nodes, from the costates lam_f at times[-1] back to times[0]."""
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    lambda_h_at, lambda_phi_at, lambda_theta_at, lambda_v_at, lambda_gamma_at, lambda_psi_at = lam
    lambda_h_mid, lambda_phi_mid, lambda_theta_mid, lambda_v_mid, lambda_gamma_mid, lambda_psi_mid = lam_mid
    h_at, phi_at, theta_at, v_at, gamma_at, psi_at = x
    alpha_at, beta_at = u
    h_mid, phi_mid, theta_mid, v_mid, gamma_mid, psi_mid = x_mid
    alpha_mid, beta_mid = u_mid
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam_f
    r_e_sq = r_e*r_e
    twice_r_e = 2.0*r_e
    r_e_cubed = r_e*r_e*r_e
    w_2 = 3.0*r_e_sq
    w_3 = 3.0*r_e
    twice_mu = 2.0*mu
    inv_h_r = 1.0/h_r
    inv_m = 1.0/m
    area_inv_m_rho_0 = area*inv_m*rho_0
    half_area_inv_m_rho_0 = 0.5*area_inv_m_rho_0
    w_5 = a_0*half_area_inv_m_rho_0
    inv_h_r_w_5 = inv_h_r*w_5
    w_8 = a_1*half_area_inv_m_rho_0
    inv_h_r_w_8 = inv_h_r*w_8
    w_14 = half_area_inv_m_rho_0*inv_h_r
    b_1_w_14 = b_1*w_14
    b_2_w_14 = b_2*w_14
    b_0_w_14 = b_0*w_14
    steps = len(times) - 1
    t = times[steps]
    lambda_h_at[steps] = lambda_h
    lambda_phi_at[steps] = lambda_phi
    lambda_theta_at[steps] = lambda_theta
    lambda_v_at[steps] = lambda_v
    lambda_gamma_at[steps] = lambda_gamma
    lambda_psi_at[steps] = lambda_psi
    h = h_at[steps]
    theta = theta_at[steps]
    v = v_at[steps]
    gamma = gamma_at[steps]
    psi = psi_at[steps]
    alpha = alpha_at[steps]
    beta = beta_at[steps]
    h_sq = h*h
    h_twice_r_e = h*twice_r_e
    w = h_sq + h_twice_r_e + r_e_sq
    inv_w = 1.0/w
    h_w_2 = h*w_2
    h_cubed = h*h*h
    h_sq_w_3 = h_sq*w_3
    w_4 = h_cubed*v + h_sq_w_3*v + h_w_2*v + r_e_cubed*v
    inv_w_4 = 1.0/w_4
    w_6 = math.exp(-h*inv_h_r)
    w_7 = w_6*math.cos(beta)
    v_w_7 = v*w_7
    alpha_inv_h_r_w_8 = alpha*inv_h_r_w_8
    cos_gamma = math.cos(gamma)
    cos_gamma_v = cos_gamma*v
    w_9 = alpha_inv_h_r_w_8*v_w_7 + cos_gamma_v*inv_w + inv_h_r_w_5*v_w_7 - cos_gamma*inv_w_4*twice_mu
    cos_theta = math.cos(theta)
    w_10 = cos_theta*h_sq + cos_theta*h_twice_r_e + cos_theta*r_e_sq
    inv_w_10 = 1.0/w_10
    sin_psi = math.sin(psi)
    sin_theta = math.sin(theta)
    sin_psi_sin_theta = sin_psi*sin_theta
    inv_cos_gamma = 1.0/cos_gamma
    w_11 = w_6*math.sin(beta)
    inv_cos_gamma_w_11 = inv_cos_gamma*w_11
    inv_cos_gamma_w_11_v = inv_cos_gamma_w_11*v
    w_12 = alpha_inv_h_r_w_8*inv_cos_gamma_w_11_v + cos_gamma_v*inv_w_10*sin_psi_sin_theta + inv_cos_gamma_w_11_v*inv_h_r_w_5
    w_13 = h_cubed + h_sq_w_3 + h_w_2 + r_e_cubed
    inv_w_13 = 1.0/w_13
    sin_gamma = math.sin(gamma)
    v_sq = v*v
    v_sq_w_6 = v_sq*w_6
    alpha_sq = alpha*alpha
    w_15 = alpha*b_1_w_14*v_sq_w_6 + alpha_sq*b_2_w_14*v_sq_w_6 + b_0_w_14*v_sq_w_6 + inv_w_13*sin_gamma*twice_mu
    cos_psi = math.cos(psi)
    w_16 = h + r_e
    inv_w_16 = 1.0/w_16
    inv_w_16_sq = inv_w_16*inv_w_16
    cos_gamma_v_inv_w_16_sq = cos_gamma_v*inv_w_16_sq
    w_17 = cos_gamma_v_inv_w_16_sq*cos_psi
    inv_cos_theta = 1.0/cos_theta
    inv_cos_theta_sin_psi = inv_cos_theta*sin_psi
    w_18 = cos_gamma_v_inv_w_16_sq*inv_cos_theta_sin_psi
    inv_cos_theta_sq = inv_cos_theta*inv_cos_theta
    cos_gamma_inv_w_16 = cos_gamma*inv_w_16
    w_19 = cos_gamma_inv_w_16*inv_cos_theta_sq*sin_psi_sin_theta*v
    w_20 = cos_gamma_inv_w_16*sin_psi
    v_w_20 = v*w_20
    w_21 = inv_cos_theta_sq*v_w_20*(cos_theta*cos_theta + sin_theta*sin_theta)
    w_22 = cos_gamma_inv_w_16*cos_psi
    w_23 = area_inv_m_rho_0*v*w_6*(alpha*b_1 + alpha_sq*b_2 + b_0)
    inv_cos_theta_w_20 = inv_cos_theta*w_20
    h_v_sq = h*v_sq
    w_24 = h_sq*v_sq + h_v_sq*twice_r_e + r_e_sq*v_sq
    inv_w_24 = 1.0/w_24
    cos_gamma_mu = cos_gamma*mu
    alpha_w_8 = alpha*w_8
    w_25 = alpha_w_8*w_7 + cos_gamma_inv_w_16 + cos_gamma_mu*inv_w_24 + w_5*w_7
    w_26 = cos_theta*h + cos_theta*r_e
    inv_w_26 = 1.0/w_26
    w_27 = alpha_w_8*inv_cos_gamma_w_11 + cos_gamma*inv_w_26*sin_psi_sin_theta + inv_cos_gamma_w_11*w_5
    sin_gamma_v = sin_gamma*v
    w_28 = inv_cos_gamma*inv_cos_gamma*sin_gamma_v*w_11
    w_29 = inv_w_26*sin_gamma*sin_psi*sin_theta*v - alpha_w_8*w_28 - w_28*w_5
    cos_gamma_mu_inv_w_16_sq = cos_gamma_mu*inv_w_16_sq
    inv_v = 1.0/v
    w_30 = inv_v*inv_w_16_sq*sin_gamma*(h_v_sq + r_e*v_sq - mu)
    inv_w_16_sin_gamma_v = inv_w_16*sin_gamma_v
    w_31 = cos_psi*inv_w_16_sin_gamma_v
    w_32 = inv_cos_theta_sin_psi*inv_w_16_sin_gamma_v
    inv_cos_theta_v_w_22 = inv_cos_theta*v*w_22
    w_33 = inv_cos_theta_v_w_22*sin_theta
    slope_lambda_h = lambda_gamma*w_9 + lambda_phi*w_18 + lambda_psi*w_12 + lambda_theta*w_17 - lambda_v*w_15
    slope_lambda_theta = -lambda_phi*w_19 - lambda_psi*w_21
    slope_lambda_v = lambda_v*w_23 - inv_cos_theta_w_20*lambda_phi - lambda_gamma*w_25 - lambda_h*sin_gamma - lambda_psi*w_27 - lambda_theta*w_22
    slope_lambda_gamma = cos_gamma_mu_inv_w_16_sq*lambda_v + lambda_gamma*w_30 + lambda_phi*w_32 + lambda_psi*w_29 + lambda_theta*w_31 - cos_gamma_v*lambda_h
    slope_lambda_psi = lambda_theta*v_w_20 - inv_cos_theta_v_w_22*lambda_phi - lambda_psi*w_33
    for i in range(steps - 1, -1, -1):
        t_end = times[i]
        h_2 = t_end - t
        h_half = h_mid[i]
        h_end = h_at[i]
        theta_half = theta_mid[i]
        theta_end = theta_at[i]
        v_half = v_mid[i]
        v_end = v_at[i]
        gamma_half = gamma_mid[i]
        gamma_end = gamma_at[i]
        psi_half = psi_mid[i]
        psi_end = psi_at[i]
        alpha_half = alpha_mid[i]
        alpha_end = alpha_at[i]
        beta_half = beta_mid[i]
        beta_end = beta_at[i]
        half = 0.5*h_2
        sixth = (1.0/6.0)*h_2
        lambda_h_2 = half*slope_lambda_h + lambda_h
        lambda_theta_2 = half*slope_lambda_theta + lambda_theta
        lambda_v_2 = half*slope_lambda_v + lambda_v
        lambda_gamma_2 = half*slope_lambda_gamma + lambda_gamma
        lambda_psi_2 = half*slope_lambda_psi + lambda_psi
        h_half_sq = h_half*h_half
        h_half_twice_r_e = h_half*twice_r_e
        w_34 = h_half_sq + h_half_twice_r_e + r_e_sq
        inv_w_34 = 1.0/w_34
        h_half_w_2 = h_half*w_2
        h_half_cubed = h_half*h_half*h_half
        h_half_sq_w_3 = h_half_sq*w_3
        w_35 = h_half_cubed*v_half + h_half_sq_w_3*v_half + h_half_w_2*v_half + r_e_cubed*v_half
        inv_w_35 = 1.0/w_35
        w_36 = math.exp(-h_half*inv_h_r)
        w_37 = w_36*math.cos(beta_half)
        v_half_w_37 = v_half*w_37
        alpha_half_inv_h_r_w_8 = alpha_half*inv_h_r_w_8
        cos_gamma_half = math.cos(gamma_half)
        cos_gamma_half_v_half = cos_gamma_half*v_half
        w_38 = alpha_half_inv_h_r_w_8*v_half_w_37 + cos_gamma_half_v_half*inv_w_34 + inv_h_r_w_5*v_half_w_37 - cos_gamma_half*inv_w_35*twice_mu
        cos_theta_half = math.cos(theta_half)
        w_39 = cos_theta_half*h_half_sq + cos_theta_half*h_half_twice_r_e + cos_theta_half*r_e_sq
        inv_w_39 = 1.0/w_39
        sin_psi_half = math.sin(psi_half)
        sin_theta_half = math.sin(theta_half)
        w_40 = sin_psi_half*sin_theta_half
        inv_cos_gamma_half = 1.0/cos_gamma_half
        w_41 = w_36*math.sin(beta_half)
        inv_cos_gamma_half_w_41 = inv_cos_gamma_half*w_41
        w_42 = inv_cos_gamma_half_w_41*v_half
        w_43 = alpha_half_inv_h_r_w_8*w_42 + cos_gamma_half_v_half*inv_w_39*w_40 + inv_h_r_w_5*w_42
        w_44 = h_half_cubed + h_half_sq_w_3 + h_half_w_2 + r_e_cubed
        inv_w_44 = 1.0/w_44
        sin_gamma_half = math.sin(gamma_half)
        v_half_sq = v_half*v_half
        v_half_sq_w_36 = v_half_sq*w_36
        alpha_half_sq = alpha_half*alpha_half
        w_45 = alpha_half*b_1_w_14*v_half_sq_w_36 + alpha_half_sq*b_2_w_14*v_half_sq_w_36 + b_0_w_14*v_half_sq_w_36 + inv_w_44*sin_gamma_half*twice_mu
        cos_psi_half = math.cos(psi_half)
        w_46 = h_half + r_e
        inv_w_46 = 1.0/w_46
        inv_w_46_sq = inv_w_46*inv_w_46
        w_47 = cos_gamma_half_v_half*inv_w_46_sq
        cos_psi_half_w_47 = cos_psi_half*w_47
        inv_cos_theta_half = 1.0/cos_theta_half
        w_48 = inv_cos_theta_half*sin_psi_half
        w_47_w_48 = w_47*w_48
        inv_cos_theta_half_sq = inv_cos_theta_half*inv_cos_theta_half
        cos_gamma_half_inv_w_46 = cos_gamma_half*inv_w_46
        w_49 = cos_gamma_half_inv_w_46*inv_cos_theta_half_sq*v_half*w_40
        w_50 = cos_gamma_half_inv_w_46*sin_psi_half
        v_half_w_50 = v_half*w_50
        w_51 = inv_cos_theta_half_sq*v_half_w_50*(cos_theta_half*cos_theta_half + sin_theta_half*sin_theta_half)
        w_52 = cos_gamma_half_inv_w_46*cos_psi_half
        w_53 = area_inv_m_rho_0*v_half*w_36*(alpha_half*b_1 + alpha_half_sq*b_2 + b_0)
        inv_cos_theta_half_w_50 = inv_cos_theta_half*w_50
        h_half_v_half_sq = h_half*v_half_sq
        w_54 = h_half_sq*v_half_sq + h_half_v_half_sq*twice_r_e + r_e_sq*v_half_sq
        inv_w_54 = 1.0/w_54
        cos_gamma_half_mu = cos_gamma_half*mu
        alpha_half_w_8 = alpha_half*w_8
        w_55 = alpha_half_w_8*w_37 + cos_gamma_half_inv_w_46 + cos_gamma_half_mu*inv_w_54 + w_37*w_5
        w_56 = cos_theta_half*h_half + cos_theta_half*r_e
        inv_w_56 = 1.0/w_56
        w_57 = alpha_half_w_8*inv_cos_gamma_half_w_41 + cos_gamma_half*inv_w_56*w_40 + inv_cos_gamma_half_w_41*w_5
        sin_gamma_half_v_half = sin_gamma_half*v_half
        w_58 = inv_cos_gamma_half*inv_cos_gamma_half*sin_gamma_half_v_half*w_41
        w_59 = inv_w_56*sin_gamma_half*sin_psi_half*sin_theta_half*v_half - alpha_half_w_8*w_58 - w_5*w_58
        w_60 = cos_gamma_half_mu*inv_w_46_sq
        inv_v_half = 1.0/v_half
        w_61 = inv_v_half*inv_w_46_sq*sin_gamma_half*(h_half_v_half_sq + r_e*v_half_sq - mu)
        w_62 = inv_w_46*sin_gamma_half_v_half
        cos_psi_half_w_62 = cos_psi_half*w_62
        w_48_w_62 = w_48*w_62
        w_63 = inv_cos_theta_half*v_half*w_52
        sin_theta_half_w_63 = sin_theta_half*w_63
        k2_lambda_h = cos_psi_half_w_47*lambda_theta_2 + lambda_gamma_2*w_38 + lambda_phi*w_47_w_48 + lambda_psi_2*w_43 - lambda_v_2*w_45
        k2_lambda_theta = -lambda_phi*w_49 - lambda_psi_2*w_51
        k2_lambda_v = lambda_v_2*w_53 - inv_cos_theta_half_w_50*lambda_phi - lambda_gamma_2*w_55 - lambda_h_2*sin_gamma_half - lambda_psi_2*w_57 - lambda_theta_2*w_52
        k2_lambda_gamma = cos_psi_half_w_62*lambda_theta_2 + lambda_gamma_2*w_61 + lambda_phi*w_48_w_62 + lambda_psi_2*w_59 + lambda_v_2*w_60 - cos_gamma_half_v_half*lambda_h_2
        k2_lambda_psi = lambda_theta_2*v_half_w_50 - lambda_phi*w_63 - lambda_psi_2*sin_theta_half_w_63
        lambda_h_3 = half*k2_lambda_h + lambda_h
        lambda_theta_3 = half*k2_lambda_theta + lambda_theta
        lambda_v_3 = half*k2_lambda_v + lambda_v
        lambda_gamma_3 = half*k2_lambda_gamma + lambda_gamma
        lambda_psi_3 = half*k2_lambda_psi + lambda_psi
        k3_lambda_h = cos_psi_half_w_47*lambda_theta_3 + lambda_gamma_3*w_38 + lambda_phi*w_47_w_48 + lambda_psi_3*w_43 - lambda_v_3*w_45
        k3_lambda_theta = -lambda_phi*w_49 - lambda_psi_3*w_51
        k3_lambda_v = lambda_v_3*w_53 - inv_cos_theta_half_w_50*lambda_phi - lambda_gamma_3*w_55 - lambda_h_3*sin_gamma_half - lambda_psi_3*w_57 - lambda_theta_3*w_52
        k3_lambda_gamma = cos_psi_half_w_62*lambda_theta_3 + lambda_gamma_3*w_61 + lambda_phi*w_48_w_62 + lambda_psi_3*w_59 + lambda_v_3*w_60 - cos_gamma_half_v_half*lambda_h_3
        k3_lambda_psi = lambda_theta_3*v_half_w_50 - lambda_phi*w_63 - lambda_psi_3*sin_theta_half_w_63
        lambda_h_4 = h_2*k3_lambda_h + lambda_h
        lambda_theta_4 = h_2*k3_lambda_theta + lambda_theta
        lambda_v_4 = h_2*k3_lambda_v + lambda_v
        lambda_gamma_4 = h_2*k3_lambda_gamma + lambda_gamma
        lambda_psi_4 = h_2*k3_lambda_psi + lambda_psi
        h_end_sq = h_end*h_end
        h_end_twice_r_e = h_end*twice_r_e
        w_64 = h_end_sq + h_end_twice_r_e + r_e_sq
        inv_w_64 = 1.0/w_64
        h_end_w_2 = h_end*w_2
        h_end_cubed = h_end*h_end*h_end
        h_end_sq_w_3 = h_end_sq*w_3
        w_65 = h_end_cubed*v_end + h_end_sq_w_3*v_end + h_end_w_2*v_end + r_e_cubed*v_end
        inv_w_65 = 1.0/w_65
        w_66 = math.exp(-h_end*inv_h_r)
        w_67 = w_66*math.cos(beta_end)
        v_end_w_67 = v_end*w_67
        alpha_end_inv_h_r_w_8 = alpha_end*inv_h_r_w_8
        cos_gamma_end = math.cos(gamma_end)
        cos_gamma_end_v_end = cos_gamma_end*v_end
        w_68 = alpha_end_inv_h_r_w_8*v_end_w_67 + cos_gamma_end_v_end*inv_w_64 + inv_h_r_w_5*v_end_w_67 - cos_gamma_end*inv_w_65*twice_mu
        cos_theta_end = math.cos(theta_end)
        w_69 = cos_theta_end*h_end_sq + cos_theta_end*h_end_twice_r_e + cos_theta_end*r_e_sq
        inv_w_69 = 1.0/w_69
        sin_psi_end = math.sin(psi_end)
        sin_theta_end = math.sin(theta_end)
        w_70 = sin_psi_end*sin_theta_end
        inv_cos_gamma_end = 1.0/cos_gamma_end
        w_71 = w_66*math.sin(beta_end)
        inv_cos_gamma_end_w_71 = inv_cos_gamma_end*w_71
        w_72 = inv_cos_gamma_end_w_71*v_end
        w_73 = alpha_end_inv_h_r_w_8*w_72 + cos_gamma_end_v_end*inv_w_69*w_70 + inv_h_r_w_5*w_72
        w_74 = h_end_cubed + h_end_sq_w_3 + h_end_w_2 + r_e_cubed
        inv_w_74 = 1.0/w_74
        sin_gamma_end = math.sin(gamma_end)
        v_end_sq = v_end*v_end
        v_end_sq_w_66 = v_end_sq*w_66
        alpha_end_sq = alpha_end*alpha_end
        w_75 = alpha_end*b_1_w_14*v_end_sq_w_66 + alpha_end_sq*b_2_w_14*v_end_sq_w_66 + b_0_w_14*v_end_sq_w_66 + inv_w_74*sin_gamma_end*twice_mu
        cos_psi_end = math.cos(psi_end)
        w_76 = h_end + r_e
        inv_w_76 = 1.0/w_76
        inv_w_76_sq = inv_w_76*inv_w_76
        w_77 = cos_gamma_end_v_end*inv_w_76_sq
        cos_psi_end_w_77 = cos_psi_end*w_77
        inv_cos_theta_end = 1.0/cos_theta_end
        w_78 = inv_cos_theta_end*sin_psi_end
        w_77_w_78 = w_77*w_78
        inv_cos_theta_end_sq = inv_cos_theta_end*inv_cos_theta_end
        cos_gamma_end_inv_w_76 = cos_gamma_end*inv_w_76
        w_79 = cos_gamma_end_inv_w_76*inv_cos_theta_end_sq*v_end*w_70
        w_80 = cos_gamma_end_inv_w_76*sin_psi_end
        v_end_w_80 = v_end*w_80
        w_81 = inv_cos_theta_end_sq*v_end_w_80*(cos_theta_end*cos_theta_end + sin_theta_end*sin_theta_end)
        w_82 = cos_gamma_end_inv_w_76*cos_psi_end
        w_83 = area_inv_m_rho_0*v_end*w_66*(alpha_end*b_1 + alpha_end_sq*b_2 + b_0)
        inv_cos_theta_end_w_80 = inv_cos_theta_end*w_80
        h_end_v_end_sq = h_end*v_end_sq
        w_84 = h_end_sq*v_end_sq + h_end_v_end_sq*twice_r_e + r_e_sq*v_end_sq
        inv_w_84 = 1.0/w_84
        cos_gamma_end_mu = cos_gamma_end*mu
        alpha_end_w_8 = alpha_end*w_8
        w_85 = alpha_end_w_8*w_67 + cos_gamma_end_inv_w_76 + cos_gamma_end_mu*inv_w_84 + w_5*w_67
        w_86 = cos_theta_end*h_end + cos_theta_end*r_e
        inv_w_86 = 1.0/w_86
        w_87 = alpha_end_w_8*inv_cos_gamma_end_w_71 + cos_gamma_end*inv_w_86*w_70 + inv_cos_gamma_end_w_71*w_5
        sin_gamma_end_v_end = sin_gamma_end*v_end
        w_88 = inv_cos_gamma_end*inv_cos_gamma_end*sin_gamma_end_v_end*w_71
        w_89 = inv_w_86*sin_gamma_end*sin_psi_end*sin_theta_end*v_end - alpha_end_w_8*w_88 - w_5*w_88
        w_90 = cos_gamma_end_mu*inv_w_76_sq
        inv_v_end = 1.0/v_end
        w_91 = inv_v_end*inv_w_76_sq*sin_gamma_end*(h_end_v_end_sq + r_e*v_end_sq - mu)
        w_92 = inv_w_76*sin_gamma_end_v_end
        cos_psi_end_w_92 = cos_psi_end*w_92
        w_78_w_92 = w_78*w_92
        w_93 = inv_cos_theta_end*v_end*w_82
        sin_theta_end_w_93 = sin_theta_end*w_93
        k4_lambda_h = cos_psi_end_w_77*lambda_theta_4 + lambda_gamma_4*w_68 + lambda_phi*w_77_w_78 + lambda_psi_4*w_73 - lambda_v_4*w_75
        k4_lambda_theta = -lambda_phi*w_79 - lambda_psi_4*w_81
        k4_lambda_v = lambda_v_4*w_83 - inv_cos_theta_end_w_80*lambda_phi - lambda_gamma_4*w_85 - lambda_h_4*sin_gamma_end - lambda_psi_4*w_87 - lambda_theta_4*w_82
        k4_lambda_gamma = cos_psi_end_w_92*lambda_theta_4 + lambda_gamma_4*w_91 + lambda_phi*w_78_w_92 + lambda_psi_4*w_89 + lambda_v_4*w_90 - cos_gamma_end_v_end*lambda_h_4
        k4_lambda_psi = lambda_theta_4*v_end_w_80 - lambda_phi*w_93 - lambda_psi_4*sin_theta_end_w_93
        lambda_h_end = lambda_h + sixth*(k4_lambda_h + slope_lambda_h + 2.0*(k2_lambda_h + k3_lambda_h))
        lambda_theta_end = lambda_theta + sixth*(k4_lambda_theta + slope_lambda_theta + 2.0*(k2_lambda_theta + k3_lambda_theta))
        lambda_v_end = lambda_v + sixth*(k4_lambda_v + slope_lambda_v + 2.0*(k2_lambda_v + k3_lambda_v))
        lambda_gamma_end = lambda_gamma + sixth*(k4_lambda_gamma + slope_lambda_gamma + 2.0*(k2_lambda_gamma + k3_lambda_gamma))
        lambda_psi_end = lambda_psi + sixth*(k4_lambda_psi + slope_lambda_psi + 2.0*(k2_lambda_psi + k3_lambda_psi))
        slope_end_lambda_h = cos_psi_end_w_77*lambda_theta_end + lambda_gamma_end*w_68 + lambda_phi*w_77_w_78 + lambda_psi_end*w_73 - lambda_v_end*w_75
        slope_end_lambda_theta = -lambda_phi*w_79 - lambda_psi_end*w_81
        slope_end_lambda_v = lambda_v_end*w_83 - inv_cos_theta_end_w_80*lambda_phi - lambda_gamma_end*w_85 - lambda_h_end*sin_gamma_end - lambda_psi_end*w_87 - lambda_theta_end*w_82
        slope_end_lambda_gamma = cos_psi_end_w_92*lambda_theta_end + lambda_gamma_end*w_91 + lambda_phi*w_78_w_92 + lambda_psi_end*w_89 + lambda_v_end*w_90 - cos_gamma_end_v_end*lambda_h_end
        slope_end_lambda_psi = lambda_theta_end*v_end_w_80 - lambda_phi*w_93 - lambda_psi_end*sin_theta_end_w_93
        eighth = 0.125*h_2
        lambda_h_mid[i] = eighth*(slope_lambda_h - slope_end_lambda_h) + 0.5*(lambda_h + lambda_h_end)
        lambda_h_at[i] = lambda_h_end
        lambda_phi_mid[i] = lambda_phi
        lambda_phi_at[i] = lambda_phi
        lambda_theta_mid[i] = eighth*(slope_lambda_theta - slope_end_lambda_theta) + 0.5*(lambda_theta + lambda_theta_end)
        lambda_theta_at[i] = lambda_theta_end
        lambda_v_mid[i] = eighth*(slope_lambda_v - slope_end_lambda_v) + 0.5*(lambda_v + lambda_v_end)
        lambda_v_at[i] = lambda_v_end
        lambda_gamma_mid[i] = eighth*(slope_lambda_gamma - slope_end_lambda_gamma) + 0.5*(lambda_gamma + lambda_gamma_end)
        lambda_gamma_at[i] = lambda_gamma_end
        lambda_psi_mid[i] = eighth*(slope_lambda_psi - slope_end_lambda_psi) + 0.5*(lambda_psi + lambda_psi_end)
        lambda_psi_at[i] = lambda_psi_end
        t = t_end
        lambda_h = lambda_h_end
        lambda_theta = lambda_theta_end
        lambda_v = lambda_v_end
        lambda_gamma = lambda_gamma_end
        lambda_psi = lambda_psi_end
        slope_lambda_h = slope_end_lambda_h
        slope_lambda_theta = slope_end_lambda_theta
        slope_lambda_v = slope_end_lambda_v
        slope_lambda_gamma = slope_end_lambda_gamma
        slope_lambda_psi = slope_end_lambda_psi


def dynamics_batch(t, x, u, p, out=None):
    """Rates of change of the states, f(t, x, u). Batch form."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, u, *p))
    sin_gamma = np.sin(gamma)
    cos_theta = np.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    w = h + r_e
    inv_w = 1.0/w
    cos_gamma = np.cos(gamma)
    cos_gamma_inv_w_v = cos_gamma*inv_w*v
    w_2 = cos_gamma_inv_w_v*inv_cos_theta*np.sin(psi)
    w_3 = inv_w*inv_w*mu
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w_4 = 0.5*area*inv_m*rho_0*np.exp(-h*inv_h_r)
    inv_v = 1.0/v
    w_5 = v*w_4*(a_0 + a_1*alpha)
    inv_cos_gamma = 1.0/cos_gamma
    out[0] = sin_gamma*v
    out[1] = w_2
    out[2] = cos_gamma_inv_w_v*np.cos(psi)
    out[3] = -sin_gamma*w_3 - v*v*w_4*(alpha*alpha*b_2 + alpha*b_1 + b_0)
    out[4] = cos_gamma*(inv_w*v - inv_v*w_3) + w_5*np.cos(beta)
    out[5] = inv_cos_gamma*w_5*np.sin(beta) + w_2*np.sin(theta)
    return out


def jacobian_x_batch(t, x, u, p, out=None):
    """A = df/dx, row by row. Batch form."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 6, *shape), np.result_type(float, t, x, u, *p))
    sin_gamma = np.sin(gamma)
    cos_gamma = np.cos(gamma)
    cos_gamma_v = cos_gamma*v
    cos_theta = np.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    sin_psi = np.sin(psi)
    inv_cos_theta_sin_psi = inv_cos_theta*sin_psi
    w = h + r_e
    inv_w = 1.0/w
    inv_w_sq = inv_w*inv_w
    cos_gamma_v_inv_w_sq = cos_gamma_v*inv_w_sq
    sin_theta = np.sin(theta)
    cos_gamma_v_sin_psi = cos_gamma_v*sin_psi
    w_2 = cos_gamma_v_sin_psi*inv_w
    w_3 = inv_cos_theta*inv_cos_theta*w_2
    cos_gamma_inv_w = cos_gamma*inv_w
    sin_gamma_v = sin_gamma*v
    cos_psi = np.cos(psi)
    cos_psi_inv_w = cos_psi*inv_w
    w_4 = cos_gamma_v*cos_psi_inv_w*inv_cos_theta
    h_cubed = h*h*h
    r_e_cubed = r_e*r_e*r_e
    r_e_sq = r_e*r_e
    w_5 = 3.0*h*r_e_sq
    h_sq = h*h
    w_6 = 3.0*h_sq*r_e
    w_7 = h_cubed + r_e_cubed + w_5 + w_6
    inv_w_7 = 1.0/w_7
    inv_h_r = 1.0/h_r
    inv_m = 1.0/m
    w_8 = area*inv_m*rho_0*np.exp(-h*inv_h_r)
    half_w_8 = 0.5*w_8
    v_sq = v*v
    half_w_8_inv_h_r_v_sq = half_w_8*inv_h_r*v_sq
    alpha_b_1 = alpha*b_1
    w_9 = alpha*alpha*b_2
    v_w_8 = v*w_8
    cos_gamma_mu = cos_gamma*mu
    w_10 = h_cubed*v + r_e_cubed*v + v*w_5 + v*w_6
    inv_w_10 = 1.0/w_10
    twice_r_e = 2.0*r_e
    w_11 = h*twice_r_e + h_sq + r_e_sq
    inv_w_11 = 1.0/w_11
    cos_beta = np.cos(beta)
    w_12 = 0.5*inv_h_r*v_w_8
    cos_beta_w_12 = cos_beta*w_12
    a_1_alpha = a_1*alpha
    h_v_sq = h*v_sq
    w_13 = h_sq*v_sq + h_v_sq*twice_r_e + r_e_sq*v_sq
    inv_w_13 = 1.0/w_13
    cos_beta_half_w_8 = cos_beta*half_w_8
    inv_v = 1.0/v
    cos_theta_h = cos_theta*h
    w_14 = cos_theta*h_sq + cos_theta*r_e_sq + cos_theta_h*twice_r_e
    inv_w_14 = 1.0/w_14
    inv_cos_gamma = 1.0/cos_gamma
    sin_beta = np.sin(beta)
    inv_cos_gamma_sin_beta = inv_cos_gamma*sin_beta
    w_15 = inv_cos_gamma_sin_beta*w_12
    w_16 = cos_theta*r_e + cos_theta_h
    inv_w_16 = 1.0/w_16
    w_17 = inv_w_16*sin_psi*sin_theta
    w_18 = half_w_8*inv_cos_gamma_sin_beta
    w_19 = half_w_8*inv_cos_gamma*inv_cos_gamma*sin_beta*sin_gamma_v
    out[0, 0] = 0.0
    out[0, 1] = 0.0
    out[0, 2] = 0.0
    out[0, 3] = sin_gamma
    out[0, 4] = cos_gamma_v
    out[0, 5] = 0.0
    out[1, 0] = -cos_gamma_v_inv_w_sq*inv_cos_theta_sin_psi
    out[1, 1] = 0.0
    out[1, 2] = sin_theta*w_3
    out[1, 3] = cos_gamma_inv_w*inv_cos_theta_sin_psi
    out[1, 4] = -inv_cos_theta_sin_psi*inv_w*sin_gamma_v
    out[1, 5] = w_4
    out[2, 0] = -cos_gamma_v_inv_w_sq*cos_psi
    out[2, 1] = 0.0
    out[2, 2] = 0.0
    out[2, 3] = cos_gamma_inv_w*cos_psi
    out[2, 4] = -cos_psi_inv_w*sin_gamma_v
    out[2, 5] = -w_2
    out[3, 0] = alpha_b_1*half_w_8_inv_h_r_v_sq + b_0*half_w_8_inv_h_r_v_sq + half_w_8_inv_h_r_v_sq*w_9 + 2.0*inv_w_7*mu*sin_gamma
    out[3, 1] = 0.0
    out[3, 2] = 0.0
    out[3, 3] = -v_w_8*(alpha_b_1 + b_0 + w_9)
    out[3, 4] = -cos_gamma_mu*inv_w_sq
    out[3, 5] = 0.0
    out[4, 0] = 2.0*cos_gamma*inv_w_10*mu - a_0*cos_beta_w_12 - a_1_alpha*cos_beta_w_12 - cos_gamma_v*inv_w_11
    out[4, 1] = 0.0
    out[4, 2] = 0.0
    out[4, 3] = a_0*cos_beta_half_w_8 + a_1_alpha*cos_beta_half_w_8 + cos_gamma_inv_w + cos_gamma_mu*inv_w_13
    out[4, 4] = -inv_v*inv_w_sq*sin_gamma*(h_v_sq + r_e*v_sq - mu)
    out[4, 5] = 0.0
    out[5, 0] = -a_0*w_15 - a_1_alpha*w_15 - cos_gamma_v_sin_psi*inv_w_14*sin_theta
    out[5, 1] = 0.0
    out[5, 2] = w_3*(cos_theta*cos_theta + sin_theta*sin_theta)
    out[5, 3] = a_0*w_18 + a_1_alpha*w_18 + cos_gamma*w_17
    out[5, 4] = a_0*w_19 + a_1_alpha*w_19 - sin_gamma_v*w_17
    out[5, 5] = sin_theta*w_4
    return out


def jacobian_u_batch(t, x, u, p, out=None):
    """B = df/du, row by row. Batch form."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty((6, 2, *shape), np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w = 0.5*area*inv_m*rho_0*np.exp(-h*inv_h_r)
    cos_beta = np.cos(beta)
    v_w = v*w
    a_1_v_w = a_1*v_w
    sin_beta = np.sin(beta)
    w_2 = v_w*(a_0 + a_1*alpha)
    cos_gamma = np.cos(gamma)
    inv_cos_gamma = 1.0/cos_gamma
    out[3, 0] = -v*v*w*(2.0*alpha*b_2 + b_1)
    out[4, 0] = a_1_v_w*cos_beta
    out[4, 1] = -sin_beta*w_2
    out[5, 0] = a_1_v_w*inv_cos_gamma*sin_beta
    out[5, 1] = cos_beta*inv_cos_gamma*w_2
    return out


def running_cost_batch(t, x, u, p, out=None):
    """Integrand L of the cost. Batch form."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, *p))
    out[...] = 0.0
    return out


def terminal_cost_batch(t, x, p, out=None):
    """Terminal cost S. Batch form."""
    h, phi, theta, v, gamma, psi = x
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty(shape, np.result_type(float, t, x, *p))
    out[...] = -theta
    return out


def terminal_gradient_batch(t, x, p, out=None):
    """S_x: the costates at the final time where the final state is free. Batch form."""
    h, phi, theta, v, gamma, psi = x
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, *p))
    out[0] = 0.0
    out[1] = 0.0
    out[2] = -1.0
    out[3] = 0.0
    out[4] = 0.0
    out[5] = 0.0
    return out


def hamiltonian_batch(t, x, u, lam, p, out=None):
    """H = L + lam' f. Batch form."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty(shape, np.result_type(float, t, x, u, lam, *p))
    w = h + r_e
    inv_w = 1.0/w
    inv_v = 1.0/v
    cos_gamma = np.cos(gamma)
    inv_cos_gamma = 1.0/cos_gamma
    sin_gamma = np.sin(gamma)
    cos_gamma_inv_w_v = cos_gamma*inv_w*v
    cos_theta = np.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    w_2 = cos_gamma_inv_w_v*inv_cos_theta*np.sin(psi)
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w_3 = 0.5*area*inv_m*rho_0*np.exp(-h*inv_h_r)
    w_4 = v*w_3*(a_0 + a_1*alpha)
    w_5 = inv_w*inv_w*mu
    out[...] = cos_gamma_inv_w_v*lambda_theta*np.cos(psi) + lambda_gamma*(cos_gamma*(inv_w*v - inv_v*w_5) + w_4*np.cos(beta)) + lambda_h*sin_gamma*v + lambda_phi*w_2 + lambda_psi*(inv_cos_gamma*w_4*np.sin(beta) + w_2*np.sin(theta)) + lambda_v*(-sin_gamma*w_5 - v*v*w_3*(alpha*alpha*b_2 + alpha*b_1 + b_0))
    return out


def stationarity_batch(t, x, u, lam, p, out=None):
    """H_u. Batch form."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, u, lam, *p))
    cos_gamma = np.cos(gamma)
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w = area*inv_m*rho_0*np.exp(-h*inv_h_r)
    sin_beta = np.sin(beta)
    cos_beta = np.cos(beta)
    cos_gamma_lambda_gamma = cos_gamma*lambda_gamma
    inv_cos_gamma = 1.0/cos_gamma
    w_2 = 0.5*inv_cos_gamma*v*w
    w_3 = w_2*(cos_beta*lambda_psi - cos_gamma_lambda_gamma*sin_beta)
    out[0] = w_2*(a_1*cos_beta*cos_gamma_lambda_gamma + a_1*lambda_psi*sin_beta - b_1*cos_gamma*lambda_v*v) - alpha*b_2*lambda_v*v*v*w
    out[1] = a_0*w_3 + a_1*alpha*w_3
    return out


def control_hessian_batch(t, x, u, lam, p, out=None):
    """H_uu, row by row. Batch form."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((2, 2, *shape), np.result_type(float, t, x, u, lam, *p))
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w = area*inv_m*rho_0*np.exp(-h*inv_h_r)
    cos_beta = np.cos(beta)
    sin_beta = np.sin(beta)
    cos_gamma = np.cos(gamma)
    cos_gamma_lambda_gamma = cos_gamma*lambda_gamma
    w_2 = cos_gamma_lambda_gamma*sin_beta
    inv_cos_gamma = 1.0/cos_gamma
    w_3 = 0.5*inv_cos_gamma*v*w
    a_1_w_3 = a_1*w_3
    w_4 = -cos_beta*cos_gamma_lambda_gamma - lambda_psi*sin_beta
    out[0, 0] = -b_2*lambda_v*v*v*w
    out[0, 1] = w_3*(a_1*cos_beta*lambda_psi - a_1*w_2)
    out[1, 0] = a_1_w_3*(cos_beta*lambda_psi - w_2)
    out[1, 1] = a_0*w_3*w_4 + a_1_w_3*alpha*w_4
    return out


def control_law_batch(t, x, lam, p, bounds, out=None):
    """The controls that minimise H over the control set. Batch form."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((2, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    cos_gamma = np.cos(gamma)
    inv_cos_gamma = 1.0/cos_gamma
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    law_part_6 = h*inv_h_r
    law_part_7 = area*inv_m*rho_0*np.exp(-law_part_6)
    law_part_8 = 0.5*law_part_7*v
    law_part_11 = inv_cos_gamma*lambda_psi*law_part_8
    w = 0.5*(np.maximum(beta_min, np.minimum(beta_max, np.pi) - 2.0*np.pi) + np.minimum(beta_max, np.maximum(beta_min, -np.pi) + 2.0*np.pi))
    law_part_10 = np.cos(w)
    law_part_5 = np.sin(w)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_2 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_3 = np.arctan2(np.real(w_2), np.real(law_part_13)) + np.arctan((w_2*np.cos(np.arctan2(np.real(w_2), np.real(law_part_13))) - law_part_13*np.sin(np.arctan2(np.real(w_2), np.real(law_part_13))))/(law_part_13*np.cos(np.arctan2(np.real(w_2), np.real(law_part_13))) + w_2*np.sin(np.arctan2(np.real(w_2), np.real(law_part_13)))))
    w_4 = w + w_3
    w_5 = np.minimum(np.maximum(w_4, beta_min), beta_max)
    law_part_15 = law_part_11*np.sin(w_5) + law_part_9*np.cos(w_5)
    inv_lambda_v = 1.0/lambda_v
    law_part_16 = v*v
    inv_law_part_16 = 1.0/law_part_16
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    inv_b_2 = 1.0/b_2
    law_part_17 = a_1*inv_area*inv_b_2*inv_lambda_v*inv_law_part_16*inv_rho_0*m*np.exp(law_part_6)
    law_part_2 = 0.5*b_1
    law_part_3 = -inv_b_2*law_part_2
    w_6 = law_part_15*law_part_17 + law_part_3
    law_part_18 = lambda_v*law_part_16*law_part_7
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_7 = w_6 + 0.0*np.sqrt(law_part_20)
    w_8 = np.minimum(np.maximum(w_7, alpha_min), alpha_max)
    w_9 = -law_part_13
    w_10 = np.arctan2(np.real(law_part_12), np.real(w_9)) + np.arctan((law_part_12*np.cos(np.arctan2(np.real(law_part_12), np.real(w_9))) - w_9*np.sin(np.arctan2(np.real(law_part_12), np.real(w_9))))/(w_9*np.cos(np.arctan2(np.real(law_part_12), np.real(w_9))) + law_part_12*np.sin(np.arctan2(np.real(law_part_12), np.real(w_9)))))
    w_11 = w + w_10
    w_12 = np.minimum(np.maximum(w_11, beta_min), beta_max)
    law_part_24 = law_part_11*np.sin(w_12) + law_part_9*np.cos(w_12)
    w_13 = law_part_17*law_part_24 + law_part_3
    w_14 = w_13 + 0.0*np.sqrt(law_part_20)
    w_15 = np.minimum(np.maximum(w_14, alpha_min), alpha_max)
    law_part_22 = law_part_18*law_part_2
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_8 + law_part_24*(a_0 + a_1*w_15) + law_part_26*w_8*w_8 - law_part_15*(a_0 + a_1*w_8) - law_part_22*w_15 - law_part_26*w_15*w_15
    w_16 = np.where(law_part_27 <= 0.0, w_15, w_8) + 0.0*law_part_27
    w_17 = np.where(law_part_27 <= 0.0, w_12, w_5) + 0.0*law_part_27
    out[0] = w_16
    out[1] = w_17
    return out


def costate_rate_batch(t, x, u, lam, p, out=None):
    """Rates of change of the costates, -H_x. Batch form."""
    h, phi, theta, v, gamma, psi = x
    alpha, beta = u
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(u[0]), np.shape(lam[0]))
        out = np.empty((6, *shape), np.result_type(float, t, x, u, lam, *p))
    h_sq = h*h
    r_e_sq = r_e*r_e
    twice_r_e = 2.0*r_e
    w = h*twice_r_e + h_sq + r_e_sq
    inv_w = 1.0/w
    h_cubed = h*h*h
    r_e_cubed = r_e*r_e*r_e
    w_2 = 3.0*h*r_e_sq
    w_3 = 3.0*h_sq*r_e
    w_4 = h_cubed + r_e_cubed + w_2 + w_3
    inv_w_4 = 1.0/w_4
    w_5 = h_cubed*v + r_e_cubed*v + v*w_2 + v*w_3
    inv_w_5 = 1.0/w_5
    cos_theta = np.cos(theta)
    cos_theta_h = cos_theta*h
    w_6 = cos_theta*h_sq + cos_theta*r_e_sq + cos_theta_h*twice_r_e
    inv_w_6 = 1.0/w_6
    cos_psi = np.cos(psi)
    cos_psi_lambda_theta = cos_psi*lambda_theta
    cos_gamma = np.cos(gamma)
    cos_gamma_v = cos_gamma*v
    w_7 = h + r_e
    inv_w_7 = 1.0/w_7
    inv_w_7_sq = inv_w_7*inv_w_7
    cos_gamma_v_inv_w_7_sq = cos_gamma_v*inv_w_7_sq
    sin_psi = np.sin(psi)
    inv_cos_theta = 1.0/cos_theta
    inv_cos_theta_lambda_phi = inv_cos_theta*lambda_phi
    w_8 = inv_cos_theta_lambda_phi*sin_psi
    cos_gamma_mu = cos_gamma*mu
    inv_m = 1.0/m
    inv_h_r = 1.0/h_r
    w_9 = np.exp(-h*inv_h_r)
    w_10 = 0.5*area*inv_m*rho_0*w_9
    w_11 = w_10*np.cos(beta)
    a_0_w_11 = a_0*w_11
    inv_h_r_v = inv_h_r*v
    a_1_alpha = a_1*alpha
    a_1_alpha_w_11 = a_1_alpha*w_11
    sin_theta = np.sin(theta)
    sin_psi_sin_theta = sin_psi*sin_theta
    inv_h_r_w_10 = inv_h_r*w_10
    inv_cos_gamma = 1.0/cos_gamma
    sin_beta = np.sin(beta)
    inv_cos_gamma_sin_beta = inv_cos_gamma*sin_beta
    w_12 = inv_cos_gamma_sin_beta*inv_h_r_w_10*v
    sin_gamma = np.sin(gamma)
    v_sq = v*v
    inv_h_r_w_10_v_sq = inv_h_r_w_10*v_sq
    alpha_b_1 = alpha*b_1
    w_13 = alpha*alpha*b_2
    inv_cos_theta_sq = inv_cos_theta*inv_cos_theta
    cos_gamma_inv_w_7 = cos_gamma*inv_w_7
    cos_gamma_inv_w_7_v = cos_gamma_inv_w_7*v
    w_14 = cos_gamma_inv_w_7*sin_psi
    h_v_sq = h*v_sq
    w_15 = h_sq*v_sq + h_v_sq*twice_r_e + r_e_sq*v_sq
    inv_w_15 = 1.0/w_15
    w_16 = cos_theta*r_e + cos_theta_h
    inv_w_16 = 1.0/w_16
    w_17 = inv_cos_gamma_sin_beta*w_10
    inv_v = 1.0/v
    sin_gamma_v = sin_gamma*v
    inv_w_7_sin_gamma_v = inv_w_7*sin_gamma_v
    w_18 = inv_cos_gamma*inv_cos_gamma*sin_beta*sin_gamma_v*w_10
    w_19 = cos_gamma_inv_w_7_v*cos_psi
    out[0] = cos_gamma_v_inv_w_7_sq*cos_psi_lambda_theta + cos_gamma_v_inv_w_7_sq*w_8 + lambda_gamma*(a_0_w_11*inv_h_r_v + a_1_alpha_w_11*inv_h_r_v + cos_gamma_v*inv_w - 2.0*cos_gamma_mu*inv_w_5) + lambda_psi*(a_0*w_12 + a_1_alpha*w_12 + cos_gamma_v*inv_w_6*sin_psi_sin_theta) + lambda_v*(-alpha_b_1*inv_h_r_w_10_v_sq - b_0*inv_h_r_w_10_v_sq - inv_h_r_w_10_v_sq*w_13 - 2.0*inv_w_4*mu*sin_gamma)
    out[1] = 0.0
    out[2] = -cos_gamma_inv_w_7_v*inv_cos_theta_sq*lambda_phi*sin_psi_sin_theta - inv_cos_theta_sq*lambda_psi*v*w_14*(cos_theta*cos_theta + sin_theta*sin_theta)
    out[3] = area*inv_m*lambda_v*rho_0*v*w_9*(alpha_b_1 + b_0 + w_13) + lambda_gamma*(-a_0_w_11 - a_1_alpha_w_11 - cos_gamma_inv_w_7 - cos_gamma_mu*inv_w_15) + lambda_psi*(-a_0*w_17 - a_1_alpha*w_17 - cos_gamma*inv_w_16*sin_psi_sin_theta) - cos_gamma_inv_w_7*cos_psi_lambda_theta - inv_cos_theta_lambda_phi*w_14 - lambda_h*sin_gamma
    out[4] = cos_gamma_mu*inv_w_7_sq*lambda_v + cos_psi_lambda_theta*inv_w_7_sin_gamma_v + inv_v*inv_w_7_sq*lambda_gamma*sin_gamma*(h_v_sq + r_e*v_sq - mu) + inv_w_7_sin_gamma_v*w_8 + lambda_psi*(inv_w_16*sin_gamma*sin_psi*sin_theta*v - a_0*w_18 - a_1_alpha*w_18) - cos_gamma_v*lambda_h
    out[5] = cos_gamma*inv_w_7*lambda_theta*sin_psi*v - inv_cos_theta*lambda_psi*sin_theta*w_19 - inv_cos_theta_lambda_phi*w_19
    return out


def canonical_batch(t, x, lam, p, bounds, out=None):
    """Rates of change of states and costates under the control law. Batch form."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((12, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    sin_gamma = np.sin(gamma)
    sin_gamma_v = sin_gamma*v
    w = h + r_e
    inv_w = 1.0/w
    cos_gamma = np.cos(gamma)
    cos_gamma_inv_w_v = cos_gamma*inv_w*v
    cos_theta = np.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    sin_psi = np.sin(psi)
    inv_cos_theta_sin_psi = inv_cos_theta*sin_psi
    cos_psi = np.cos(psi)
    w_2 = cos_gamma_inv_w_v*cos_psi
    inv_w_sq = inv_w*inv_w
    inv_w_sq_mu = inv_w_sq*mu
    inv_cos_gamma = 1.0/cos_gamma
    half_v = 0.5*v
    inv_m = 1.0/m
    area_inv_m_rho_0 = area*inv_m*rho_0
    inv_h_r = 1.0/h_r
    h_inv_h_r = h*inv_h_r
    law_part_7 = area_inv_m_rho_0*np.exp(-h_inv_h_r)
    law_part_8 = half_v*law_part_7
    law_part_11 = inv_cos_gamma*lambda_psi*law_part_8
    w_3 = 0.5*(np.maximum(beta_min, np.minimum(beta_max, np.pi) - 2.0*np.pi) + np.minimum(beta_max, np.maximum(beta_min, -np.pi) + 2.0*np.pi))
    law_part_10 = np.cos(w_3)
    law_part_5 = np.sin(w_3)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_4 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_5 = np.arctan2(np.real(w_4), np.real(law_part_13)) + np.arctan((w_4*np.cos(np.arctan2(np.real(w_4), np.real(law_part_13))) - law_part_13*np.sin(np.arctan2(np.real(w_4), np.real(law_part_13))))/(law_part_13*np.cos(np.arctan2(np.real(w_4), np.real(law_part_13))) + w_4*np.sin(np.arctan2(np.real(w_4), np.real(law_part_13)))))
    w_6 = w_3 + w_5
    w_7 = np.minimum(np.maximum(w_6, beta_min), beta_max)
    law_part_15 = law_part_11*np.sin(w_7) + law_part_9*np.cos(w_7)
    inv_lambda_v = 1.0/lambda_v
    v_sq = v*v
    inv_v_sq = 1.0/v_sq
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    inv_b_2 = 1.0/b_2
    law_part_17 = a_1*inv_area*inv_b_2*inv_lambda_v*inv_rho_0*inv_v_sq*m*np.exp(h_inv_h_r)
    half_b_1 = 0.5*b_1
    law_part_3 = -half_b_1*inv_b_2
    w_8 = law_part_15*law_part_17 + law_part_3
    law_part_18 = lambda_v*law_part_7*v_sq
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_9 = w_8 + 0.0*np.sqrt(law_part_20)
    w_10 = np.minimum(np.maximum(w_9, alpha_min), alpha_max)
    w_11 = -law_part_13
    w_12 = np.arctan2(np.real(law_part_12), np.real(w_11)) + np.arctan((law_part_12*np.cos(np.arctan2(np.real(law_part_12), np.real(w_11))) - w_11*np.sin(np.arctan2(np.real(law_part_12), np.real(w_11))))/(w_11*np.cos(np.arctan2(np.real(law_part_12), np.real(w_11))) + law_part_12*np.sin(np.arctan2(np.real(law_part_12), np.real(w_11)))))
    w_13 = w_12 + w_3
    w_14 = np.minimum(np.maximum(w_13, beta_min), beta_max)
    law_part_24 = law_part_11*np.sin(w_14) + law_part_9*np.cos(w_14)
    w_15 = law_part_17*law_part_24 + law_part_3
    w_16 = w_15 + 0.0*np.sqrt(law_part_20)
    w_17 = np.minimum(np.maximum(w_16, alpha_min), alpha_max)
    law_part_22 = half_b_1*law_part_18
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_10 + law_part_24*(a_0 + a_1*w_17) + law_part_26*w_10*w_10 - law_part_15*(a_0 + a_1*w_10) - law_part_22*w_17 - law_part_26*w_17*w_17
    w_18 = np.where(law_part_27 <= 0.0, w_17, w_10) + 0.0*law_part_27
    w_19 = b_2*w_18*w_18
    w_20 = b_0 + b_1*w_18 + w_19
    w_21 = np.exp(-h_inv_h_r)
    area_inv_m_rho_0_w_21 = area_inv_m_rho_0*w_21
    w_22 = 0.5*area_inv_m_rho_0_w_21
    v_sq_w_22 = v_sq*w_22
    inv_v = 1.0/v
    w_23 = np.where(law_part_27 <= 0.0, w_14, w_7) + 0.0*law_part_27
    cos_w_23 = np.cos(w_23)
    a_1_w_18 = a_1*w_18
    w_24 = area_inv_m_rho_0_w_21*half_v
    w_25 = w_24*(a_0 + a_1_w_18)
    sin_theta = np.sin(theta)
    sin_psi_sin_theta = sin_psi*sin_theta
    w_26 = cos_gamma_inv_w_v*sin_psi_sin_theta
    sin_w_23 = np.sin(w_23)
    inv_cos_gamma_sin_w_23 = inv_cos_gamma*sin_w_23
    h_sq = h*h
    r_e_sq = r_e*r_e
    twice_r_e = 2.0*r_e
    w_27 = h*twice_r_e + h_sq + r_e_sq
    inv_w_27 = 1.0/w_27
    h_cubed = h*h*h
    r_e_cubed = r_e*r_e*r_e
    w_28 = 3.0*h*r_e_sq
    w_29 = 3.0*h_sq*r_e
    w_30 = h_cubed*v + r_e_cubed*v + v*w_28 + v*w_29
    inv_w_30 = 1.0/w_30
    cos_theta_h = cos_theta*h
    w_31 = cos_theta*h_sq + cos_theta*r_e_sq + cos_theta_h*twice_r_e
    inv_w_31 = 1.0/w_31
    w_32 = h_cubed + r_e_cubed + w_28 + w_29
    inv_w_32 = 1.0/w_32
    cos_psi_lambda_theta = cos_psi*lambda_theta
    cos_gamma_v = cos_gamma*v
    cos_gamma_v_inv_w_sq = cos_gamma_v*inv_w_sq
    w_33 = inv_cos_theta_sin_psi*lambda_phi
    cos_gamma_mu = cos_gamma*mu
    inv_h_r_w_24 = inv_h_r*w_24
    cos_w_23_inv_h_r_w_24 = cos_w_23*inv_h_r_w_24
    w_34 = inv_cos_gamma_sin_w_23*inv_h_r_w_24
    inv_h_r_v_sq_w_22 = inv_h_r*v_sq_w_22
    inv_cos_theta_sq = inv_cos_theta*inv_cos_theta
    h_v_sq = h*v_sq
    w_35 = h_sq*v_sq + h_v_sq*twice_r_e + r_e_sq*v_sq
    inv_w_35 = 1.0/w_35
    w_36 = cos_theta*r_e + cos_theta_h
    inv_w_36 = 1.0/w_36
    cos_gamma_inv_w = cos_gamma*inv_w
    cos_w_23_w_22 = cos_w_23*w_22
    w_37 = inv_cos_gamma_sin_w_23*w_22
    inv_w_sin_gamma_v = inv_w*sin_gamma_v
    w_38 = inv_cos_gamma*inv_cos_gamma*sin_gamma_v*sin_w_23*w_22
    inv_cos_theta_w_2 = inv_cos_theta*w_2
    out[0] = sin_gamma_v
    out[1] = cos_gamma_inv_w_v*inv_cos_theta_sin_psi
    out[2] = w_2
    out[3] = -inv_w_sq_mu*sin_gamma - v_sq_w_22*w_20
    out[4] = cos_gamma*(inv_w*v - inv_v*inv_w_sq_mu) + cos_w_23*w_25
    out[5] = inv_cos_gamma_sin_w_23*w_25 + inv_cos_theta*w_26
    out[6] = cos_gamma_v_inv_w_sq*cos_psi_lambda_theta + cos_gamma_v_inv_w_sq*w_33 + lambda_gamma*(a_0*cos_w_23_inv_h_r_w_24 + a_1_w_18*cos_w_23_inv_h_r_w_24 + cos_gamma_v*inv_w_27 - 2.0*cos_gamma_mu*inv_w_30) + lambda_psi*(a_0*w_34 + a_1_w_18*w_34 + cos_gamma_v*inv_w_31*sin_psi_sin_theta) + lambda_v*(-area_inv_m_rho_0_w_21*half_b_1*inv_h_r*v_sq*w_18 - b_0*inv_h_r_v_sq_w_22 - inv_h_r_v_sq_w_22*w_19 - 2.0*inv_w_32*mu*sin_gamma)
    out[7] = 0.0
    out[8] = -cos_gamma_inv_w_v*inv_cos_theta_sq*lambda_psi*sin_psi*(cos_theta*cos_theta + sin_theta*sin_theta) - inv_cos_theta_sq*lambda_phi*w_26
    out[9] = area*inv_m*lambda_v*rho_0*v*w_20*w_21 + lambda_gamma*(-a_0*cos_w_23_w_22 - a_1_w_18*cos_w_23_w_22 - cos_gamma_inv_w - cos_gamma_mu*inv_w_35) + lambda_psi*(-a_0*w_37 - a_1_w_18*w_37 - cos_gamma*inv_w_36*sin_psi_sin_theta) - cos_gamma_inv_w*cos_psi_lambda_theta - cos_gamma_inv_w*w_33 - lambda_h*sin_gamma
    out[10] = cos_gamma*inv_w_sq_mu*lambda_v + cos_psi_lambda_theta*inv_w_sin_gamma_v + inv_v*inv_w_sq*lambda_gamma*sin_gamma*(h_v_sq + r_e*v_sq - mu) + inv_w_sin_gamma_v*w_33 + lambda_psi*(inv_w_36*sin_gamma*sin_psi*sin_theta*v - a_0*w_38 - a_1_w_18*w_38) - cos_gamma_v*lambda_h
    out[11] = cos_gamma*inv_w*lambda_theta*sin_psi*v - inv_cos_theta_w_2*lambda_phi - inv_cos_theta_w_2*lambda_psi*sin_theta
    return out


def canonical_jacobian_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by states and costates, row by row. Batch form."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((12, 12, *shape), np.result_type(float, t, x, lam, *p, *bounds))
    sin_gamma = np.sin(gamma)
    cos_gamma = np.cos(gamma)
    cos_gamma_v = cos_gamma*v
    w = h + r_e
    inv_w = 1.0/w
    inv_w_sq = inv_w*inv_w
    cos_gamma_v_inv_w_sq = cos_gamma_v*inv_w_sq
    cos_theta = np.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    sin_psi = np.sin(psi)
    inv_cos_theta_sin_psi = inv_cos_theta*sin_psi
    w_2 = cos_gamma_v_inv_w_sq*inv_cos_theta_sin_psi
    sin_theta = np.sin(theta)
    inv_cos_theta_sq = inv_cos_theta*inv_cos_theta
    cos_gamma_v_inv_w = cos_gamma_v*inv_w
    w_3 = cos_gamma_v_inv_w*sin_psi
    inv_cos_theta_sq_w_3 = inv_cos_theta_sq*w_3
    w_4 = inv_cos_theta_sq_w_3*sin_theta
    cos_gamma_inv_w = cos_gamma*inv_w
    cos_gamma_inv_w_sin_psi = cos_gamma_inv_w*sin_psi
    w_5 = cos_gamma_inv_w_sin_psi*inv_cos_theta
    inv_w_v = inv_w*v
    inv_w_v_sin_gamma = inv_w_v*sin_gamma
    w_6 = inv_cos_theta_sin_psi*inv_w_v_sin_gamma
    cos_psi = np.cos(psi)
    w_7 = cos_gamma_v_inv_w*cos_psi
    inv_cos_theta_w_7 = inv_cos_theta*w_7
    w_8 = cos_gamma_v_inv_w_sq*cos_psi
    cos_gamma_inv_w_cos_psi = cos_gamma_inv_w*cos_psi
    w_9 = cos_psi*inv_w_v_sin_gamma
    inv_w_cubed = inv_w*inv_w*inv_w
    twice_mu = 2.0*mu
    inv_w_cubed_twice_mu = inv_w_cubed*twice_mu
    w_10 = 0.5*(np.maximum(beta_min, np.minimum(beta_max, np.pi) - 2.0*np.pi) + np.minimum(beta_max, np.maximum(beta_min, -np.pi) + 2.0*np.pi))
    law_part_10 = np.cos(w_10)
    inv_cos_gamma = 1.0/cos_gamma
    inv_m = 1.0/m
    area_inv_m_rho_0 = area*inv_m*rho_0
    inv_h_r = 1.0/h_r
    h_inv_h_r = h*inv_h_r
    w_11 = area_inv_m_rho_0*np.exp(-h_inv_h_r)
    half_w_11 = 0.5*w_11
    law_part_8 = half_w_11*v
    inv_cos_gamma_law_part_8 = inv_cos_gamma*law_part_8
    law_part_11 = inv_cos_gamma_law_part_8*lambda_psi
    law_part_5 = np.sin(w_10)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_12 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_13 = np.arctan2(np.real(w_12), np.real(law_part_13)) + np.arctan((w_12*np.cos(np.arctan2(np.real(w_12), np.real(law_part_13))) - law_part_13*np.sin(np.arctan2(np.real(w_12), np.real(law_part_13))))/(law_part_13*np.cos(np.arctan2(np.real(w_12), np.real(law_part_13))) + w_12*np.sin(np.arctan2(np.real(w_12), np.real(law_part_13)))))
    w_14 = w_10 + w_13
    w_15 = np.minimum(np.maximum(w_14, beta_min), beta_max)
    sin_w_15 = np.sin(w_15)
    cos_w_15 = np.cos(w_15)
    law_part_15 = cos_w_15*law_part_9 + law_part_11*sin_w_15
    inv_lambda_v = 1.0/lambda_v
    v_sq = v*v
    inv_v_sq = 1.0/v_sq
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    exp_h_inv_h_r = np.exp(h_inv_h_r)
    inv_b_2 = 1.0/b_2
    w_16 = a_1*exp_h_inv_h_r*inv_area*inv_b_2*inv_rho_0*inv_v_sq*m
    inv_lambda_v_w_16 = inv_lambda_v*w_16
    half_b_1 = 0.5*b_1
    law_part_3 = -half_b_1*inv_b_2
    w_17 = inv_lambda_v_w_16*law_part_15 + law_part_3
    law_part_18 = lambda_v*v_sq*w_11
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_18 = w_17 + 0.0*np.sqrt(law_part_20)
    w_19 = np.minimum(np.maximum(w_18, alpha_min), alpha_max)
    w_20 = -law_part_13
    w_21 = np.arctan2(np.real(law_part_12), np.real(w_20)) + np.arctan((law_part_12*np.cos(np.arctan2(np.real(law_part_12), np.real(w_20))) - w_20*np.sin(np.arctan2(np.real(law_part_12), np.real(w_20))))/(w_20*np.cos(np.arctan2(np.real(law_part_12), np.real(w_20))) + law_part_12*np.sin(np.arctan2(np.real(law_part_12), np.real(w_20)))))
    w_22 = w_10 + w_21
    w_23 = np.minimum(np.maximum(w_22, beta_min), beta_max)
    sin_w_23 = np.sin(w_23)
    cos_w_23 = np.cos(w_23)
    law_part_24 = cos_w_23*law_part_9 + law_part_11*sin_w_23
    w_24 = inv_lambda_v_w_16*law_part_24 + law_part_3
    w_25 = w_24 + 0.0*np.sqrt(law_part_20)
    w_26 = np.minimum(np.maximum(w_25, alpha_min), alpha_max)
    law_part_22 = half_b_1*law_part_18
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_19 + law_part_24*(a_0 + a_1*w_26) + law_part_26*w_19*w_19 - law_part_15*(a_0 + a_1*w_19) - law_part_22*w_26 - law_part_26*w_26*w_26
    w_27 = np.where(law_part_27 <= 0.0, w_26, w_19) + 0.0*law_part_27
    b_2_w_27 = b_2*w_27
    w_28 = b_1 + 2.0*b_2_w_27
    w_29 = np.exp(-h_inv_h_r)
    area_inv_m_rho_0_w_29 = area_inv_m_rho_0*w_29
    w_30 = 0.5*area_inv_m_rho_0_w_29
    v_sq_w_30 = v_sq*w_30
    v_sq_w_30_w_28 = v_sq_w_30*w_28
    b_1_w_27 = b_1*w_27
    w_31 = b_2*w_27*w_27
    w_32 = area_inv_m_rho_0_w_29*(b_0 + b_1_w_27 + w_31)
    inv_h_r_v_sq = inv_h_r*v_sq
    w_33 = np.where(law_part_27 <= 0.0, 0.0, 1.0) + 0.0*law_part_27
    w_34 = np.where(law_part_27 <= 0.0, 1.0, 0.0) + 0.0*law_part_27
    w_35 = np.heaviside(w_18 - alpha_min, 1.0)*np.heaviside(alpha_max - w_18, 1.0)
    inv_lambda_v_w_16_w_35 = inv_lambda_v_w_16*w_35
    law_part_15_w_35 = law_part_15*w_35
    w_36 = cos_w_15*law_part_11 - law_part_9*sin_w_15
    inv_cos_gamma_lambda_psi = inv_cos_gamma*lambda_psi
    half_v = 0.5*v
    d_law_part_7_by_h = -inv_h_r*w_11
    d_law_part_8_by_h = d_law_part_7_by_h*half_v
    d_law_part_11_by_h = d_law_part_8_by_h*inv_cos_gamma_lambda_psi
    w_37 = law_part_12*law_part_12 + law_part_13*law_part_13
    inv_w_37 = 1.0/w_37
    w_38 = np.heaviside(w_14 - beta_min, 1.0)*np.heaviside(beta_max - w_14, 1.0)
    inv_w_37_w_38 = inv_w_37*w_38
    d_law_part_9_by_h = d_law_part_8_by_h*lambda_gamma
    d_law_part_12_by_h = d_law_part_9_by_h*law_part_5 - d_law_part_11_by_h*law_part_10
    w_39 = d_law_part_12_by_h*law_part_13
    d_law_part_13_by_h = d_law_part_11_by_h*law_part_5 + d_law_part_9_by_h*law_part_10
    d_law_part_14_by_h = d_law_part_13_by_h*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_39
    d_law_part_15_by_h = cos_w_15*d_law_part_9_by_h + d_law_part_11_by_h*sin_w_15 + d_law_part_14_by_h*w_36
    d_law_part_17_by_h = inv_h_r*inv_lambda_v_w_16
    d_law_part_21_by_h = d_law_part_15_by_h*inv_lambda_v_w_16_w_35 + d_law_part_17_by_h*law_part_15_w_35
    w_40 = np.heaviside(w_25 - alpha_min, 1.0)*np.heaviside(alpha_max - w_25, 1.0)
    law_part_24_w_40 = law_part_24*w_40
    inv_lambda_v_w_16_w_40 = inv_lambda_v_w_16*w_40
    w_41 = cos_w_23*law_part_11 - law_part_9*sin_w_23
    w_42 = np.heaviside(w_22 - beta_min, 1.0)*np.heaviside(beta_max - w_22, 1.0)
    inv_w_37_w_42 = inv_w_37*w_42
    d_law_part_23_by_h = d_law_part_13_by_h*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_39
    d_law_part_24_by_h = cos_w_23*d_law_part_9_by_h + d_law_part_11_by_h*sin_w_23 + d_law_part_23_by_h*w_41
    d_law_part_25_by_h = d_law_part_17_by_h*law_part_24_w_40 + d_law_part_24_by_h*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_h = d_law_part_21_by_h*w_33 + d_law_part_25_by_h*w_34
    v_w_32 = v*w_32
    d_law_part_11_by_v = half_w_11*inv_cos_gamma_lambda_psi
    d_law_part_9_by_v = half_w_11*lambda_gamma
    d_law_part_12_by_v = d_law_part_9_by_v*law_part_5 - d_law_part_11_by_v*law_part_10
    w_43 = d_law_part_12_by_v*law_part_13
    d_law_part_13_by_v = d_law_part_11_by_v*law_part_5 + d_law_part_9_by_v*law_part_10
    d_law_part_14_by_v = d_law_part_13_by_v*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_43
    d_law_part_15_by_v = cos_w_15*d_law_part_9_by_v + d_law_part_11_by_v*sin_w_15 + d_law_part_14_by_v*w_36
    twice_v = 2.0*v
    d_law_part_17_by_v = -a_1*exp_h_inv_h_r*inv_area*inv_b_2*inv_lambda_v*inv_rho_0*inv_v_sq*inv_v_sq*m*twice_v
    d_law_part_21_by_v = d_law_part_15_by_v*inv_lambda_v_w_16_w_35 + d_law_part_17_by_v*law_part_15_w_35
    d_law_part_23_by_v = d_law_part_13_by_v*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_43
    d_law_part_24_by_v = cos_w_23*d_law_part_9_by_v + d_law_part_11_by_v*sin_w_23 + d_law_part_23_by_v*w_41
    d_law_part_25_by_v = d_law_part_17_by_v*law_part_24_w_40 + d_law_part_24_by_v*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_v = d_law_part_21_by_v*w_33 + d_law_part_25_by_v*w_34
    cos_gamma_inv_w_sq = cos_gamma*inv_w_sq
    cos_gamma_inv_w_sq_mu = cos_gamma_inv_w_sq*mu
    inv_cos_gamma_sq = inv_cos_gamma*inv_cos_gamma
    lambda_psi_sin_gamma = lambda_psi*sin_gamma
    w_44 = inv_cos_gamma_sq*lambda_psi_sin_gamma
    d_law_part_11_by_gamma = law_part_8*w_44
    d_law_part_12_by_gamma = -d_law_part_11_by_gamma*law_part_10
    w_45 = d_law_part_12_by_gamma*law_part_13
    d_law_part_13_by_gamma = d_law_part_11_by_gamma*law_part_5
    d_law_part_14_by_gamma = d_law_part_13_by_gamma*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_45
    d_law_part_15_by_gamma = d_law_part_11_by_gamma*sin_w_15 + d_law_part_14_by_gamma*w_36
    d_law_part_21_by_gamma = d_law_part_15_by_gamma*inv_lambda_v_w_16_w_35
    d_law_part_23_by_gamma = d_law_part_13_by_gamma*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_45
    d_law_part_24_by_gamma = d_law_part_11_by_gamma*sin_w_23 + d_law_part_23_by_gamma*w_41
    d_law_part_25_by_gamma = d_law_part_24_by_gamma*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_gamma = d_law_part_21_by_gamma*w_33 + d_law_part_25_by_gamma*w_34
    d_law_part_17_by_lambda_v = -inv_lambda_v*inv_lambda_v*w_16
    d_law_part_21_by_lambda_v = d_law_part_17_by_lambda_v*law_part_15_w_35
    d_law_part_25_by_lambda_v = d_law_part_17_by_lambda_v*law_part_24_w_40
    d_law_of_alpha_by_lambda_v = d_law_part_21_by_lambda_v*w_33 + d_law_part_25_by_lambda_v*w_34
    d_law_part_12_by_lambda_gamma = law_part_5*law_part_8
    w_46 = d_law_part_12_by_lambda_gamma*law_part_13
    d_law_part_13_by_lambda_gamma = law_part_10*law_part_8
    d_law_part_14_by_lambda_gamma = d_law_part_13_by_lambda_gamma*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_46
    d_law_part_15_by_lambda_gamma = cos_w_15*law_part_8 + d_law_part_14_by_lambda_gamma*w_36
    d_law_part_21_by_lambda_gamma = d_law_part_15_by_lambda_gamma*inv_lambda_v_w_16_w_35
    d_law_part_23_by_lambda_gamma = d_law_part_13_by_lambda_gamma*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_46
    d_law_part_24_by_lambda_gamma = cos_w_23*law_part_8 + d_law_part_23_by_lambda_gamma*w_41
    d_law_part_25_by_lambda_gamma = d_law_part_24_by_lambda_gamma*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_lambda_gamma = d_law_part_21_by_lambda_gamma*w_33 + d_law_part_25_by_lambda_gamma*w_34
    d_law_part_12_by_lambda_psi = -inv_cos_gamma_law_part_8*law_part_10
    w_47 = d_law_part_12_by_lambda_psi*law_part_13
    d_law_part_13_by_lambda_psi = inv_cos_gamma_law_part_8*law_part_5
    d_law_part_14_by_lambda_psi = d_law_part_13_by_lambda_psi*inv_w_37*law_part_12*w_38 - inv_w_37_w_38*w_47
    d_law_part_15_by_lambda_psi = d_law_part_14_by_lambda_psi*w_36 + inv_cos_gamma_law_part_8*sin_w_15
    d_law_part_21_by_lambda_psi = d_law_part_15_by_lambda_psi*inv_lambda_v_w_16_w_35
    d_law_part_23_by_lambda_psi = d_law_part_13_by_lambda_psi*inv_w_37*law_part_12*w_42 - inv_w_37_w_42*w_47
    d_law_part_24_by_lambda_psi = d_law_part_23_by_lambda_psi*w_41 + inv_cos_gamma_law_part_8*sin_w_23
    d_law_part_25_by_lambda_psi = d_law_part_24_by_lambda_psi*inv_lambda_v_w_16_w_40
    d_law_of_alpha_by_lambda_psi = d_law_part_21_by_lambda_psi*w_33 + d_law_part_25_by_lambda_psi*w_34
    inv_v = 1.0/v
    w_48 = np.where(law_part_27 <= 0.0, w_23, w_15) + 0.0*law_part_27
    cos_w_48 = np.cos(w_48)
    inv_w_sq_v = inv_w_sq*v
    a_1_w_27 = a_1*w_27
    w_49 = a_0 + a_1_w_27
    w_50 = area_inv_m_rho_0_w_29*half_v
    cos_w_48_w_50 = cos_w_48*w_50
    cos_w_48_w_50_inv_h_r = cos_w_48_w_50*inv_h_r
    sin_w_48 = np.sin(w_48)
    sin_w_48_w_50 = sin_w_48*w_50
    d_law_of_beta_by_h = d_law_part_14_by_h*w_33 + d_law_part_23_by_h*w_34
    inv_v_sq_2 = inv_v*inv_v
    inv_w_sq_mu = inv_w_sq*mu
    a_1_cos_w_48_w_50 = a_1*cos_w_48_w_50
    cos_w_48_w_30 = cos_w_48*w_30
    sin_w_48_w_50_w_49 = sin_w_48_w_50*w_49
    d_law_of_beta_by_v = d_law_part_14_by_v*w_33 + d_law_part_23_by_v*w_34
    d_law_of_beta_by_gamma = d_law_part_14_by_gamma*w_33 + d_law_part_23_by_gamma*w_34
    d_law_of_beta_by_lambda_gamma = d_law_part_14_by_lambda_gamma*w_33 + d_law_part_23_by_lambda_gamma*w_34
    d_law_of_beta_by_lambda_psi = d_law_part_14_by_lambda_psi*w_33 + d_law_part_23_by_lambda_psi*w_34
    sin_theta_sq = sin_theta*sin_theta
    w_51 = inv_cos_gamma*sin_w_48_w_50
    a_1_w_51 = a_1*w_51
    sin_w_48_w_30 = sin_w_48*w_30
    w_52 = inv_cos_gamma*sin_w_48_w_30
    w_53 = cos_w_48_w_50*inv_cos_gamma*w_49
    w_54 = inv_cos_gamma_sq*sin_gamma
    w_55 = inv_cos_theta_w_7*sin_theta
    h_sq = h*h
    r_e_sq = r_e*r_e
    twice_h = 2.0*h
    w_56 = h_sq + r_e*twice_h + r_e_sq
    inv_w_56 = 1.0/w_56
    h_cubed = h*h*h
    r_e_cubed = r_e*r_e*r_e
    w_57 = 3.0*r_e_sq
    h_w_57 = h*w_57
    w_58 = 3.0*h_sq
    r_e_w_58 = r_e*w_58
    w_59 = h_cubed + h_w_57 + r_e_cubed + r_e_w_58
    inv_w_59 = 1.0/w_59
    cos_psi_lambda_theta = cos_psi*lambda_theta
    inv_w_cubed_twice_v = inv_w_cubed*twice_v
    cos_gamma_sin_psi = cos_gamma*sin_psi
    inv_cos_theta_lambda_phi = inv_cos_theta*lambda_phi
    inv_h_r_sq = inv_h_r*inv_h_r
    a_0_sin_w_48_w_50 = a_0*sin_w_48_w_50
    w_60 = a_0_sin_w_48_w_50*inv_cos_gamma
    a_1_w_27_w_51 = a_1_w_27*w_51
    cos_theta_h = cos_theta*h
    twice_r_e = 2.0*r_e
    w_61 = cos_theta*h_sq + cos_theta*r_e_sq + cos_theta_h*twice_r_e
    inv_w_61 = 1.0/w_61
    inv_w_61_sq = inv_w_61*inv_w_61
    a_1_lambda_gamma = a_1*lambda_gamma
    w_62 = a_1*inv_cos_gamma_lambda_psi
    inv_h_r_sin_w_48_w_50 = inv_h_r*sin_w_48_w_50
    w_63 = area_inv_m_rho_0_w_29*inv_h_r_v_sq
    half_b_1_w_63 = half_b_1*w_63
    w_64 = a_1_lambda_gamma*cos_w_48_w_50_inv_h_r + inv_h_r_sin_w_48_w_50*w_62 + lambda_v*(-b_2_w_27*w_63 - half_b_1_w_63)
    w_65 = a_0_sin_w_48_w_50*inv_h_r
    w_66 = a_1_w_27*inv_h_r_sin_w_48_w_50
    w_67 = a_0*cos_w_48_w_50_inv_h_r
    w_68 = a_1_w_27*cos_w_48_w_50_inv_h_r
    w_69 = lambda_gamma*(-w_65 - w_66) + lambda_psi*(inv_cos_gamma*w_67 + inv_cos_gamma*w_68)
    cos_w_48_w_50_inv_h_r_sq = cos_w_48_w_50*inv_h_r_sq
    h_r_e = h*r_e
    w_70 = 6.0*h_r_e
    w_71 = h_cubed*v + h_w_57*v + r_e_cubed*v + r_e_w_58*v
    inv_w_71 = 1.0/w_71
    cos_gamma_twice_mu = cos_gamma*twice_mu
    w_72 = cos_gamma_twice_mu*inv_w_71*inv_w_71
    inv_h_r_sq_v_sq_w_30 = inv_h_r_sq*v_sq_w_30
    sin_gamma_twice_mu = sin_gamma*twice_mu
    cos_theta_r_e = cos_theta*r_e
    lambda_phi_sin_theta = lambda_phi*sin_theta
    inv_cos_theta_sq_sin_psi = inv_cos_theta_sq*sin_psi
    w_73 = cos_gamma_v_inv_w_sq*inv_cos_theta_sq_sin_psi
    w_74 = lambda_phi_sin_theta*w_73
    cos_gamma_v_sin_psi = cos_gamma_v*sin_psi
    r_e_sin_theta = r_e*sin_theta
    a_0_cos_w_48_w_30 = a_0*cos_w_48_w_30
    a_1_w_27_cos_w_48_w_30 = a_1_w_27*cos_w_48_w_30
    w_75 = a_0_cos_w_48_w_30*inv_h_r + a_1_w_27_cos_w_48_w_30*inv_h_r
    inv_w_61_sin_theta = inv_w_61*sin_theta
    a_0_sin_w_48_w_30 = a_0*sin_w_48_w_30
    w_76 = a_0_sin_w_48_w_30*inv_cos_gamma
    a_1_w_27_w_52 = a_1_w_27*w_52
    w_77 = a_1_w_27_w_52*inv_h_r + inv_h_r*w_76
    area_inv_m_rho_0_w_29_v = area_inv_m_rho_0_w_29*v
    b_0_inv_h_r = b_0*inv_h_r
    w_78 = area_inv_m_rho_0_w_29_v*inv_h_r
    w_79 = inv_cos_theta_sin_psi*lambda_phi
    w_80 = cos_gamma_inv_w_sq*cos_psi_lambda_theta + cos_gamma_inv_w_sq*w_79
    w_81 = cos_psi_lambda_theta*inv_w_sq_v*sin_gamma
    w_82 = inv_cos_theta_lambda_phi*inv_w_sq_v*sin_gamma*sin_psi
    sin_gamma_v = sin_gamma*v
    sin_gamma_v_sin_psi = sin_gamma_v*sin_psi
    w_83 = w_54*w_65 + w_54*w_66
    cos_psi_lambda_psi = cos_psi*lambda_psi
    lambda_theta_sin_psi = lambda_theta*sin_psi
    w_84 = inv_cos_theta_lambda_phi*w_8 - cos_gamma_v_inv_w_sq*lambda_theta_sin_psi
    w_85 = cos_theta*cos_theta + sin_theta_sq
    lambda_psi_w_85 = lambda_psi*w_85
    w_86 = inv_cos_theta_lambda_phi*w_3
    w_87 = cos_gamma_inv_w_sin_psi*inv_cos_theta*inv_cos_theta*inv_cos_theta*twice_v
    w_88 = cos_gamma_inv_w_sin_psi*inv_cos_theta_sq
    w_89 = lambda_phi_sin_theta*w_88
    w_90 = inv_cos_theta_sq_sin_psi*inv_w_v_sin_gamma*lambda_phi_sin_theta
    w_91 = inv_w_v*lambda_psi_sin_gamma
    w_92 = inv_cos_theta_sq*lambda_phi_sin_theta*w_7
    lambda_psi_w_7 = lambda_psi*w_7
    w_93 = inv_cos_theta_sq*lambda_psi_w_7
    w_94 = area*inv_m*lambda_v*rho_0*v*w_28*w_29 - a_1_lambda_gamma*cos_w_48_w_30 - sin_w_48_w_30*w_62
    a_1_w_27_sin_w_48_w_30 = a_1_w_27*sin_w_48_w_30
    w_95 = lambda_gamma*(a_0_sin_w_48_w_30 + a_1_w_27_sin_w_48_w_30) + lambda_psi*(-a_0_cos_w_48_w_30*inv_cos_gamma - a_1_w_27_cos_w_48_w_30*inv_cos_gamma)
    r_e_v_sq = r_e*v_sq
    w_96 = h_sq*v_sq + r_e_sq*v_sq + r_e_v_sq*twice_h
    inv_w_96 = 1.0/w_96
    w_97 = cos_gamma*inv_w_96*inv_w_96*mu
    w_98 = cos_theta_h + cos_theta_r_e
    inv_w_98 = 1.0/w_98
    w_99 = inv_w_98*inv_w_98*sin_theta
    cos_gamma_sin_psi_w_99 = cos_gamma_sin_psi*w_99
    w_100 = cos_gamma_sin_psi*inv_w_98
    w_101 = h*sin_theta + r_e_sin_theta
    inv_w_sin_gamma = inv_w*sin_gamma
    inv_w_96_mu = inv_w_96*mu
    w_102 = cos_psi_lambda_theta*inv_w_sin_gamma + inv_w_sin_gamma*w_79 + lambda_psi*(inv_w_98*sin_gamma*sin_psi*sin_theta - a_0_sin_w_48_w_30*w_54 - a_1_w_27_sin_w_48_w_30*w_54) - cos_gamma*lambda_h
    w_103 = cos_psi_lambda_psi*inv_w_98*sin_theta
    w_104 = cos_gamma_inv_w_cos_psi*inv_cos_theta_lambda_phi - cos_gamma*inv_w*lambda_theta*sin_psi
    a_1_sin_w_48_w_50_w_44 = a_1*sin_w_48_w_50*w_44
    w_105 = h*v_sq + r_e_v_sq - mu
    inv_v_w_105 = inv_v*w_105
    inv_v_w_105_lambda_gamma = inv_v_w_105*lambda_gamma
    cos_w_48_w_50_w_54 = cos_w_48_w_50*w_54
    w_106 = -a_0*cos_w_48_w_50_w_54 - a_1_w_27*cos_w_48_w_50_w_54
    w_107 = cos_theta*sin_gamma_v_sin_psi
    lambda_psi_w_106 = lambda_psi*w_106
    inv_w_sq_sin_gamma = inv_w_sq*sin_gamma
    w_108 = inv_w_sq_sin_gamma*lambda_gamma
    w_109 = area_inv_m_rho_0_w_29_v*inv_cos_gamma*inv_cos_gamma*inv_cos_gamma*sin_gamma*sin_gamma*sin_w_48
    w_110 = cos_gamma_v_inv_w*cos_psi_lambda_theta + w_86
    w_111 = inv_cos_theta_lambda_phi*w_9 - inv_w_v_sin_gamma*lambda_theta_sin_psi
    inv_cos_theta_sin_theta = inv_cos_theta*sin_theta
    w_112 = inv_cos_theta_sin_theta*lambda_psi
    out[0, 0] = 0.0
    out[0, 1] = 0.0
    out[0, 2] = 0.0
    out[0, 3] = sin_gamma
    out[0, 4] = cos_gamma_v
    out[0, 5] = 0.0
    out[0, 6] = 0.0
    out[0, 7] = 0.0
    out[0, 8] = 0.0
    out[0, 9] = 0.0
    out[0, 10] = 0.0
    out[0, 11] = 0.0
    out[1, 0] = -w_2
    out[1, 1] = 0.0
    out[1, 2] = w_4
    out[1, 3] = w_5
    out[1, 4] = -w_6
    out[1, 5] = inv_cos_theta_w_7
    out[1, 6] = 0.0
    out[1, 7] = 0.0
    out[1, 8] = 0.0
    out[1, 9] = 0.0
    out[1, 10] = 0.0
    out[1, 11] = 0.0
    out[2, 0] = -w_8
    out[2, 1] = 0.0
    out[2, 2] = 0.0
    out[2, 3] = cos_gamma_inv_w_cos_psi
    out[2, 4] = -w_9
    out[2, 5] = -w_3
    out[2, 6] = 0.0
    out[2, 7] = 0.0
    out[2, 8] = 0.0
    out[2, 9] = 0.0
    out[2, 10] = 0.0
    out[2, 11] = 0.0
    out[3, 0] = 0.5*inv_h_r_v_sq*w_32 + inv_w_cubed_twice_mu*sin_gamma - d_law_of_alpha_by_h*v_sq_w_30_w_28
    out[3, 1] = 0.0
    out[3, 2] = 0.0
    out[3, 3] = -d_law_of_alpha_by_v*v_sq_w_30_w_28 - v_w_32
    out[3, 4] = -cos_gamma_inv_w_sq_mu - d_law_of_alpha_by_gamma*v_sq_w_30_w_28
    out[3, 5] = 0.0
    out[3, 6] = 0.0
    out[3, 7] = 0.0
    out[3, 8] = 0.0
    out[3, 9] = -d_law_of_alpha_by_lambda_v*v_sq_w_30_w_28
    out[3, 10] = -d_law_of_alpha_by_lambda_gamma*v_sq_w_30_w_28
    out[3, 11] = -d_law_of_alpha_by_lambda_psi*v_sq_w_30_w_28
    out[4, 0] = 0.5*a_1*area*cos_w_48*d_law_of_alpha_by_h*inv_m*rho_0*v*w_29 + cos_gamma*(inv_v*inv_w_cubed_twice_mu - inv_w_sq_v) - cos_w_48_w_50_inv_h_r*w_49 - d_law_of_beta_by_h*sin_w_48_w_50*w_49
    out[4, 1] = 0.0
    out[4, 2] = 0.0
    out[4, 3] = a_1_cos_w_48_w_50*d_law_of_alpha_by_v + cos_gamma*(inv_v_sq_2*inv_w_sq_mu + inv_w) + cos_w_48_w_30*w_49 - d_law_of_beta_by_v*sin_w_48_w_50_w_49
    out[4, 4] = 0.5*a_1*area*cos_w_48*d_law_of_alpha_by_gamma*inv_m*rho_0*v*w_29 - d_law_of_beta_by_gamma*sin_w_48_w_50_w_49 - sin_gamma*(inv_w*v - inv_v*inv_w_sq_mu)
    out[4, 5] = 0.0
    out[4, 6] = 0.0
    out[4, 7] = 0.0
    out[4, 8] = 0.0
    out[4, 9] = a_1_cos_w_48_w_50*d_law_of_alpha_by_lambda_v
    out[4, 10] = a_1_cos_w_48_w_50*d_law_of_alpha_by_lambda_gamma - d_law_of_beta_by_lambda_gamma*sin_w_48_w_50_w_49
    out[4, 11] = a_1_cos_w_48_w_50*d_law_of_alpha_by_lambda_psi - d_law_of_beta_by_lambda_psi*sin_w_48_w_50_w_49
    out[5, 0] = 0.5*a_1*area*d_law_of_alpha_by_h*inv_cos_gamma*inv_m*rho_0*sin_w_48*v*w_29 + 0.5*area*cos_w_48*d_law_of_beta_by_h*inv_cos_gamma*inv_m*rho_0*v*w_29*w_49 - inv_cos_gamma*inv_h_r*sin_w_48_w_50_w_49 - sin_theta*w_2
    out[5, 1] = 0.0
    out[5, 2] = inv_cos_theta_sq_w_3*sin_theta_sq + w_3
    out[5, 3] = a_1_w_51*d_law_of_alpha_by_v + d_law_of_beta_by_v*w_53 + sin_theta*w_5 + w_49*w_52
    out[5, 4] = a_1_w_51*d_law_of_alpha_by_gamma + d_law_of_beta_by_gamma*w_53 + sin_w_48_w_50_w_49*w_54 - sin_theta*w_6
    out[5, 5] = w_55
    out[5, 6] = 0.0
    out[5, 7] = 0.0
    out[5, 8] = 0.0
    out[5, 9] = a_1_w_51*d_law_of_alpha_by_lambda_v
    out[5, 10] = a_1_w_51*d_law_of_alpha_by_lambda_gamma + d_law_of_beta_by_lambda_gamma*w_53
    out[5, 11] = a_1_w_51*d_law_of_alpha_by_lambda_psi + d_law_of_beta_by_lambda_psi*w_53
    out[6, 0] = d_law_of_alpha_by_h*w_64 + d_law_of_beta_by_h*w_69 + lambda_gamma*(cos_gamma*inv_w_56*inv_w_56*v*(-twice_h - twice_r_e) - a_0*cos_w_48_w_50_inv_h_r_sq - a_1_w_27*cos_w_48_w_50_inv_h_r_sq - w_72*(-v*w_57 - v*w_58 - v*w_70)) + lambda_psi*(cos_gamma*inv_w_61_sq*sin_psi*sin_theta*v*(-2.0*cos_theta_h - 2.0*cos_theta_r_e) - a_1_w_27_w_51*inv_h_r_sq - inv_h_r_sq*w_60) + lambda_v*(area_inv_m_rho_0_w_29*half_b_1*inv_h_r_sq*v_sq*w_27 + b_0*inv_h_r_sq_v_sq_w_30 + inv_h_r_sq_v_sq_w_30*w_31 - inv_w_59*inv_w_59*sin_gamma_twice_mu*(-w_57 - w_58 - w_70)) - cos_gamma*cos_psi_lambda_theta*inv_w_cubed_twice_v - cos_gamma_sin_psi*inv_cos_theta_lambda_phi*inv_w_cubed_twice_v
    out[6, 1] = 0.0
    out[6, 2] = lambda_psi*(cos_gamma_v_sin_psi*cos_theta*inv_w_61 + cos_gamma_v_sin_psi*inv_w_61_sq*sin_theta*(h_sq*sin_theta + r_e_sin_theta*twice_h + r_e_sq*sin_theta)) + w_74
    out[6, 3] = d_law_of_alpha_by_v*w_64 + d_law_of_beta_by_v*w_69 + lambda_gamma*(cos_gamma*inv_w_56 + w_59*w_72 + w_75) + lambda_psi*(cos_gamma_sin_psi*inv_w_61_sin_theta + w_77) + lambda_v*(-area_inv_m_rho_0_w_29_v*b_0_inv_h_r - b_1_w_27*w_78 - w_31*w_78) + w_80
    out[6, 4] = d_law_of_alpha_by_gamma*w_64 + d_law_of_beta_by_gamma*w_69 + lambda_gamma*(2.0*inv_w_71*mu*sin_gamma - inv_w_56*sin_gamma_v) + lambda_psi*(w_83 - inv_w_61_sin_theta*sin_gamma_v_sin_psi) - cos_gamma_twice_mu*inv_w_59*lambda_v - w_81 - w_82
    out[6, 5] = cos_gamma_v*cos_psi_lambda_psi*inv_w_61_sin_theta + w_84
    out[6, 6] = 0.0
    out[6, 7] = w_2
    out[6, 8] = w_8
    out[6, 9] = d_law_of_alpha_by_lambda_v*w_64 - b_0_inv_h_r*v_sq_w_30 - half_b_1_w_63*w_27 - inv_h_r_v_sq*w_30*w_31 - inv_w_59*sin_gamma_twice_mu
    out[6, 10] = cos_gamma_v*inv_w_56 + d_law_of_alpha_by_lambda_gamma*w_64 + d_law_of_beta_by_lambda_gamma*w_69 + w_67 + w_68 - cos_gamma_twice_mu*inv_w_71
    out[6, 11] = a_1_w_27_w_51*inv_h_r + cos_gamma_v_sin_psi*inv_w_61_sin_theta + d_law_of_alpha_by_lambda_psi*w_64 + d_law_of_beta_by_lambda_psi*w_69 + inv_cos_gamma*w_65
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
    out[8, 0] = lambda_psi_w_85*w_73 + w_74
    out[8, 1] = 0.0
    out[8, 2] = -lambda_phi*sin_theta_sq*w_87 - lambda_psi_w_85*sin_theta*w_87 - w_86
    out[8, 3] = -lambda_psi_w_85*w_88 - w_89
    out[8, 4] = inv_cos_theta_sq_sin_psi*w_85*w_91 + w_90
    out[8, 5] = -w_85*w_93 - w_92
    out[8, 6] = 0.0
    out[8, 7] = -w_4
    out[8, 8] = 0.0
    out[8, 9] = 0.0
    out[8, 10] = 0.0
    out[8, 11] = -inv_cos_theta_sq_w_3*w_85
    out[9, 0] = d_law_of_alpha_by_h*w_94 + d_law_of_beta_by_h*w_95 + lambda_gamma*(cos_gamma_inv_w_sq + w_75 - w_97*(-twice_h*v_sq - twice_r_e*v_sq)) + lambda_psi*(cos_gamma_sin_psi_w_99*cos_theta + w_77) + w_80 - inv_h_r*lambda_v*v_w_32
    out[9, 1] = 0.0
    out[9, 2] = lambda_psi*(-cos_gamma_sin_psi_w_99*w_101 - cos_theta*w_100) - w_89
    out[9, 3] = d_law_of_alpha_by_v*w_94 + d_law_of_beta_by_v*w_95 + lambda_v*w_32 - lambda_gamma*w_97*(-4.0*h_r_e*v - h_sq*twice_v - r_e_sq*twice_v)
    out[9, 4] = d_law_of_alpha_by_gamma*w_94 + d_law_of_beta_by_gamma*w_95 + lambda_gamma*(inv_w_96_mu*sin_gamma + inv_w_sin_gamma) + w_102
    out[9, 5] = -cos_gamma*w_103 - w_104
    out[9, 6] = -sin_gamma
    out[9, 7] = -w_5
    out[9, 8] = -cos_gamma_inv_w_cos_psi
    out[9, 9] = d_law_of_alpha_by_lambda_v*w_94 + v_w_32
    out[9, 10] = d_law_of_alpha_by_lambda_gamma*w_94 + d_law_of_beta_by_lambda_gamma*w_95 - a_0_cos_w_48_w_30 - a_1_w_27_cos_w_48_w_30 - cos_gamma*inv_w_96_mu - cos_gamma_inv_w
    out[9, 11] = d_law_of_alpha_by_lambda_psi*w_94 + d_law_of_beta_by_lambda_psi*w_95 - a_1_w_27_w_52 - sin_theta*w_100 - w_76
    out[10, 0] = d_law_of_beta_by_h*lambda_psi*w_106 + inv_w_sq*lambda_gamma*sin_gamma*v + lambda_psi*(w_83 - w_107*w_99) - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_h - cos_gamma*inv_w_cubed_twice_mu*lambda_v - 2.0*inv_v_w_105_lambda_gamma*inv_w_cubed*sin_gamma - w_81 - w_82
    out[10, 1] = 0.0
    out[10, 2] = lambda_psi*(inv_w_98*w_107 + sin_gamma_v_sin_psi*w_101*w_99) + w_90
    out[10, 3] = d_law_of_beta_by_v*lambda_psi_w_106 + inv_v*w_108*(h*twice_v + r_e*twice_v) + w_102 - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_v - inv_v_sq_2*w_105*w_108
    out[10, 4] = cos_gamma_inv_w_sq*inv_v_w_105_lambda_gamma + d_law_of_beta_by_gamma*lambda_psi_w_106 + lambda_h*sin_gamma_v + lambda_psi*(cos_gamma*inv_w_98*sin_psi*sin_theta*v - a_0*w_109 - a_1_w_27*w_109 - a_1_w_27_w_51 - w_60) + w_110 - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_gamma - inv_w_sq_mu*lambda_v*sin_gamma
    out[10, 5] = sin_gamma_v*w_103 + w_111
    out[10, 6] = -cos_gamma_v
    out[10, 7] = w_6
    out[10, 8] = w_9
    out[10, 9] = cos_gamma_inv_w_sq_mu - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_lambda_v
    out[10, 10] = d_law_of_beta_by_lambda_gamma*lambda_psi_w_106 + inv_v_w_105*inv_w_sq_sin_gamma - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_lambda_gamma
    out[10, 11] = d_law_of_beta_by_lambda_psi*lambda_psi*w_106 + inv_w_98*sin_gamma*sin_psi*sin_theta*v - a_0_sin_w_48_w_50*w_54 - a_1_sin_w_48_w_50_w_44*d_law_of_alpha_by_lambda_psi - a_1_w_27*sin_w_48_w_50*w_54
    out[11, 0] = w_112*w_8 + w_84
    out[11, 1] = 0.0
    out[11, 2] = -lambda_psi_w_7 - sin_theta_sq*w_93 - w_92
    out[11, 3] = -cos_gamma_inv_w_cos_psi*w_112 - w_104
    out[11, 4] = cos_psi*inv_cos_theta_sin_theta*w_91 + w_111
    out[11, 5] = w_110 + w_112*w_3
    out[11, 6] = 0.0
    out[11, 7] = -inv_cos_theta_w_7
    out[11, 8] = w_3
    out[11, 9] = 0.0
    out[11, 10] = 0.0
    out[11, 11] = -w_55
    return out


def canonical_drift_batch(t, x, lam, p, bounds, out=None):
    """The canonical rates by explicit time. Batch form."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((12, *shape), np.result_type(float, t, x, lam, *p, *bounds))
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
    return out


def boundary_batch(t, x, lam, nu, p, bounds, final, out=None):
    """Residuals at the final time: for each state (its end or its transversality), each constraint, the time. Batch form."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    given_h, given_phi, given_theta, given_v, given_gamma, given_psi, on_reference_h, on_reference_phi, on_reference_theta, on_reference_v, on_reference_gamma, on_reference_psi, target_h, target_phi, target_theta, target_v, target_gamma, target_psi = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((7, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    w = h + r_e
    inv_w = 1.0/w
    inv_v = 1.0/v
    cos_gamma = np.cos(gamma)
    inv_cos_gamma = 1.0/cos_gamma
    w_2 = inv_w*inv_w*mu
    v_sq = v*v
    sin_gamma = np.sin(gamma)
    cos_gamma_inv_w_v = cos_gamma*inv_w*v
    cos_theta = np.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    w_3 = cos_gamma_inv_w_v*inv_cos_theta*np.sin(psi)
    inv_h_r = 1.0/h_r
    h_inv_h_r = h*inv_h_r
    inv_m = 1.0/m
    area_inv_m_rho_0 = area*inv_m*rho_0
    w_4 = area_inv_m_rho_0*np.exp(-h_inv_h_r)
    half_v = 0.5*v
    law_part_8 = half_v*w_4
    law_part_11 = inv_cos_gamma*lambda_psi*law_part_8
    w_5 = 0.5*(np.maximum(beta_min, np.minimum(beta_max, np.pi) - 2.0*np.pi) + np.minimum(beta_max, np.maximum(beta_min, -np.pi) + 2.0*np.pi))
    law_part_10 = np.cos(w_5)
    law_part_5 = np.sin(w_5)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_6 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_7 = np.arctan2(np.real(w_6), np.real(law_part_13)) + np.arctan((w_6*np.cos(np.arctan2(np.real(w_6), np.real(law_part_13))) - law_part_13*np.sin(np.arctan2(np.real(w_6), np.real(law_part_13))))/(law_part_13*np.cos(np.arctan2(np.real(w_6), np.real(law_part_13))) + w_6*np.sin(np.arctan2(np.real(w_6), np.real(law_part_13)))))
    w_8 = w_5 + w_7
    w_9 = np.minimum(np.maximum(w_8, beta_min), beta_max)
    law_part_15 = law_part_11*np.sin(w_9) + law_part_9*np.cos(w_9)
    inv_lambda_v = 1.0/lambda_v
    inv_v_sq = 1.0/v_sq
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    inv_b_2 = 1.0/b_2
    law_part_17 = a_1*inv_area*inv_b_2*inv_lambda_v*inv_rho_0*inv_v_sq*m*np.exp(h_inv_h_r)
    law_part_2 = 0.5*b_1
    law_part_3 = -inv_b_2*law_part_2
    w_10 = law_part_15*law_part_17 + law_part_3
    law_part_18 = lambda_v*v_sq*w_4
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_11 = w_10 + 0.0*np.sqrt(law_part_20)
    w_12 = np.minimum(np.maximum(w_11, alpha_min), alpha_max)
    w_13 = -law_part_13
    w_14 = np.arctan2(np.real(law_part_12), np.real(w_13)) + np.arctan((law_part_12*np.cos(np.arctan2(np.real(law_part_12), np.real(w_13))) - w_13*np.sin(np.arctan2(np.real(law_part_12), np.real(w_13))))/(w_13*np.cos(np.arctan2(np.real(law_part_12), np.real(w_13))) + law_part_12*np.sin(np.arctan2(np.real(law_part_12), np.real(w_13)))))
    w_15 = w_14 + w_5
    w_16 = np.minimum(np.maximum(w_15, beta_min), beta_max)
    law_part_24 = law_part_11*np.sin(w_16) + law_part_9*np.cos(w_16)
    w_17 = law_part_17*law_part_24 + law_part_3
    w_18 = w_17 + 0.0*np.sqrt(law_part_20)
    w_19 = np.minimum(np.maximum(w_18, alpha_min), alpha_max)
    law_part_22 = law_part_18*law_part_2
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_12 + law_part_24*(a_0 + a_1*w_19) + law_part_26*w_12*w_12 - law_part_15*(a_0 + a_1*w_12) - law_part_22*w_19 - law_part_26*w_19*w_19
    w_20 = np.where(law_part_27 <= 0.0, w_19, w_12) + 0.0*law_part_27
    w_21 = half_v*w_4*(a_0 + a_1*w_20)
    w_22 = np.where(law_part_27 <= 0.0, w_16, w_9) + 0.0*law_part_27
    out[0] = given_h*(h - target_h) + h*on_reference_h + lambda_h*(1.0 - given_h - on_reference_h)
    out[1] = given_phi*(phi - target_phi) + lambda_phi*(1.0 - given_phi - on_reference_phi) + on_reference_phi*phi
    out[2] = given_theta*(theta - target_theta) + on_reference_theta*theta - (-lambda_theta - 1.0)*(1.0 - given_theta - on_reference_theta)
    out[3] = given_v*(v - target_v) + lambda_v*(1.0 - given_v - on_reference_v) + on_reference_v*v
    out[4] = gamma*on_reference_gamma + given_gamma*(gamma - target_gamma) + lambda_gamma*(1.0 - given_gamma - on_reference_gamma)
    out[5] = given_psi*(psi - target_psi) + lambda_psi*(1.0 - given_psi - on_reference_psi) + on_reference_psi*psi
    out[6] = cos_gamma_inv_w_v*lambda_theta*np.cos(psi) + lambda_gamma*(cos_gamma*(inv_w*v - inv_v*w_2) + w_21*np.cos(w_22)) + lambda_h*sin_gamma*v + lambda_phi*w_3 + lambda_psi*(inv_cos_gamma*w_21*np.sin(w_22) + w_3*np.sin(theta)) + lambda_v*(-sin_gamma*w_2 - 0.5*v_sq*w_4*(b_0 + b_1*w_20 + b_2*w_20*w_20))
    return out


def boundary_jacobian_batch(t, x, lam, nu, p, bounds, final, out=None):
    """The boundary residuals by states, costates, multipliers and final time, row by row. Batch form."""
    h, phi, theta, v, gamma, psi = x
    lambda_h, lambda_phi, lambda_theta, lambda_v, lambda_gamma, lambda_psi = lam
    mu, r_e, rho_0, h_r, area, m, a_0, a_1, b_0, b_1, b_2 = p
    alpha_min, alpha_max, beta_min, beta_max = bounds
    given_h, given_phi, given_theta, given_v, given_gamma, given_psi, on_reference_h, on_reference_phi, on_reference_theta, on_reference_v, on_reference_gamma, on_reference_psi, target_h, target_phi, target_theta, target_v, target_gamma, target_psi = final
    if out is None:
        shape = np.broadcast_shapes(np.shape(t), np.shape(x[0]), np.shape(lam[0]))
        out = np.empty((7, 13, *shape), np.result_type(float, t, x, lam, *nu, *p, *bounds, *final))
    out[...] = 0.0
    w = given_h + on_reference_h
    w_2 = given_phi + on_reference_phi
    w_3 = given_theta + on_reference_theta
    w_4 = given_v + on_reference_v
    w_5 = given_gamma + on_reference_gamma
    w_6 = given_psi + on_reference_psi
    inv_h_r = 1.0/h_r
    inv_v = 1.0/v
    sin_gamma = np.sin(gamma)
    cos_gamma = np.cos(gamma)
    sin_theta = np.sin(theta)
    cos_psi = np.cos(psi)
    cos_psi_lambda_theta = cos_psi*lambda_theta
    w_7 = h + r_e
    inv_w_7 = 1.0/w_7
    inv_w_7_sq = inv_w_7*inv_w_7
    inv_w_7_sq_v = inv_w_7_sq*v
    cos_gamma_inv_w_7_sq_v = cos_gamma*inv_w_7_sq_v
    cos_theta = np.cos(theta)
    inv_cos_theta = 1.0/cos_theta
    sin_psi = np.sin(psi)
    inv_cos_theta_sin_psi = inv_cos_theta*sin_psi
    w_8 = cos_gamma_inv_w_7_sq_v*inv_cos_theta_sin_psi
    w_9 = 2.0*inv_w_7*inv_w_7*inv_w_7*mu
    w_10 = 0.5*(np.maximum(beta_min, np.minimum(beta_max, np.pi) - 2.0*np.pi) + np.minimum(beta_max, np.maximum(beta_min, -np.pi) + 2.0*np.pi))
    law_part_10 = np.cos(w_10)
    inv_cos_gamma = 1.0/cos_gamma
    inv_m = 1.0/m
    area_inv_m_rho_0 = area*inv_m*rho_0
    h_inv_h_r = h*inv_h_r
    w_11 = area_inv_m_rho_0*np.exp(-h_inv_h_r)
    half_w_11 = 0.5*w_11
    law_part_8 = half_w_11*v
    inv_cos_gamma_law_part_8 = inv_cos_gamma*law_part_8
    law_part_11 = inv_cos_gamma_law_part_8*lambda_psi
    law_part_5 = np.sin(w_10)
    law_part_9 = lambda_gamma*law_part_8
    law_part_12 = law_part_5*law_part_9 - law_part_10*law_part_11
    w_12 = -law_part_12
    law_part_13 = law_part_10*law_part_9 + law_part_11*law_part_5
    w_13 = np.arctan2(np.real(w_12), np.real(law_part_13)) + np.arctan((w_12*np.cos(np.arctan2(np.real(w_12), np.real(law_part_13))) - law_part_13*np.sin(np.arctan2(np.real(w_12), np.real(law_part_13))))/(law_part_13*np.cos(np.arctan2(np.real(w_12), np.real(law_part_13))) + w_12*np.sin(np.arctan2(np.real(w_12), np.real(law_part_13)))))
    w_14 = w_10 + w_13
    w_15 = np.minimum(np.maximum(w_14, beta_min), beta_max)
    sin_w_15 = np.sin(w_15)
    cos_w_15 = np.cos(w_15)
    law_part_15 = cos_w_15*law_part_9 + law_part_11*sin_w_15
    inv_lambda_v = 1.0/lambda_v
    v_sq = v*v
    inv_v_sq = 1.0/v_sq
    inv_area = 1.0/area
    inv_rho_0 = 1.0/rho_0
    exp_h_inv_h_r = np.exp(h_inv_h_r)
    inv_b_2 = 1.0/b_2
    w_16 = a_1*exp_h_inv_h_r*inv_area*inv_b_2*inv_rho_0*inv_v_sq*m
    inv_lambda_v_w_16 = inv_lambda_v*w_16
    law_part_2 = 0.5*b_1
    law_part_3 = -inv_b_2*law_part_2
    w_17 = inv_lambda_v_w_16*law_part_15 + law_part_3
    law_part_18 = lambda_v*v_sq*w_11
    law_part_19 = b_2*law_part_18
    law_part_20 = -law_part_19
    w_18 = w_17 + 0.0*np.sqrt(law_part_20)
    w_19 = np.minimum(np.maximum(w_18, alpha_min), alpha_max)
    w_20 = -law_part_13
    w_21 = np.arctan2(np.real(law_part_12), np.real(w_20)) + np.arctan((law_part_12*np.cos(np.arctan2(np.real(law_part_12), np.real(w_20))) - w_20*np.sin(np.arctan2(np.real(law_part_12), np.real(w_20))))/(w_20*np.cos(np.arctan2(np.real(law_part_12), np.real(w_20))) + law_part_12*np.sin(np.arctan2(np.real(law_part_12), np.real(w_20)))))
    w_22 = w_10 + w_21
    w_23 = np.minimum(np.maximum(w_22, beta_min), beta_max)
    sin_w_23 = np.sin(w_23)
    cos_w_23 = np.cos(w_23)
    law_part_24 = cos_w_23*law_part_9 + law_part_11*sin_w_23
    w_24 = inv_lambda_v_w_16*law_part_24 + law_part_3
    w_25 = w_24 + 0.0*np.sqrt(law_part_20)
    w_26 = np.minimum(np.maximum(w_25, alpha_min), alpha_max)
    law_part_22 = law_part_18*law_part_2
    law_part_26 = 0.5*law_part_19
    law_part_27 = law_part_22*w_19 + law_part_24*(a_0 + a_1*w_26) + law_part_26*w_19*w_19 - law_part_15*(a_0 + a_1*w_19) - law_part_22*w_26 - law_part_26*w_26*w_26
    w_27 = np.where(law_part_27 <= 0.0, w_26, w_19) + 0.0*law_part_27
    w_28 = b_0 + b_1*w_27 + b_2*w_27*w_27
    half_w_11_v_sq = half_w_11*v_sq
    half_w_11_v_sq_w_28 = half_w_11_v_sq*w_28
    w_29 = np.where(law_part_27 <= 0.0, w_23, w_15) + 0.0*law_part_27
    sin_w_29 = np.sin(w_29)
    inv_cos_gamma_sin_w_29 = inv_cos_gamma*sin_w_29
    w_30 = a_0 + a_1*w_27
    half_v = 0.5*v
    half_v_w_11 = half_v*w_11
    half_v_w_11_w_30 = half_v_w_11*w_30
    w_31 = half_v_w_11_w_30*inv_cos_gamma_sin_w_29
    cos_w_29 = np.cos(w_29)
    cos_w_29_half_v_w_11 = cos_w_29*half_v_w_11
    w_32 = cos_w_29_half_v_w_11*w_30
    inv_cos_gamma_lambda_psi = inv_cos_gamma*lambda_psi
    w_33 = inv_cos_gamma_lambda_psi*w_32 - half_v_w_11_w_30*lambda_gamma*sin_w_29
    w_34 = a_1*cos_w_29_half_v_w_11*lambda_gamma + a_1*half_v_w_11*inv_cos_gamma_lambda_psi*sin_w_29 - half_w_11_v_sq*lambda_v*(b_1 + 2.0*b_2*w_27)
    w_35 = np.where(law_part_27 <= 0.0, 0.0, 1.0) + 0.0*law_part_27
    w_36 = np.where(law_part_27 <= 0.0, 1.0, 0.0) + 0.0*law_part_27
    w_37 = np.heaviside(w_18 - alpha_min, 1.0)*np.heaviside(alpha_max - w_18, 1.0)
    inv_lambda_v_w_16_w_37 = inv_lambda_v_w_16*w_37
    law_part_15_w_37 = law_part_15*w_37
    w_38 = cos_w_15*law_part_11 - law_part_9*sin_w_15
    d_law_part_7_by_h = -inv_h_r*w_11
    d_law_part_8_by_h = d_law_part_7_by_h*half_v
    d_law_part_11_by_h = d_law_part_8_by_h*inv_cos_gamma_lambda_psi
    w_39 = law_part_12*law_part_12 + law_part_13*law_part_13
    inv_w_39 = 1.0/w_39
    w_40 = np.heaviside(w_14 - beta_min, 1.0)*np.heaviside(beta_max - w_14, 1.0)
    inv_w_39_w_40 = inv_w_39*w_40
    d_law_part_9_by_h = d_law_part_8_by_h*lambda_gamma
    d_law_part_12_by_h = d_law_part_9_by_h*law_part_5 - d_law_part_11_by_h*law_part_10
    w_41 = d_law_part_12_by_h*law_part_13
    d_law_part_13_by_h = d_law_part_11_by_h*law_part_5 + d_law_part_9_by_h*law_part_10
    d_law_part_14_by_h = d_law_part_13_by_h*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_41
    d_law_part_15_by_h = cos_w_15*d_law_part_9_by_h + d_law_part_11_by_h*sin_w_15 + d_law_part_14_by_h*w_38
    d_law_part_17_by_h = inv_h_r*inv_lambda_v_w_16
    d_law_part_21_by_h = d_law_part_15_by_h*inv_lambda_v_w_16_w_37 + d_law_part_17_by_h*law_part_15_w_37
    w_42 = np.heaviside(w_25 - alpha_min, 1.0)*np.heaviside(alpha_max - w_25, 1.0)
    law_part_24_w_42 = law_part_24*w_42
    inv_lambda_v_w_16_w_42 = inv_lambda_v_w_16*w_42
    w_43 = cos_w_23*law_part_11 - law_part_9*sin_w_23
    w_44 = np.heaviside(w_22 - beta_min, 1.0)*np.heaviside(beta_max - w_22, 1.0)
    inv_w_39_w_44 = inv_w_39*w_44
    d_law_part_23_by_h = d_law_part_13_by_h*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_41
    d_law_part_24_by_h = cos_w_23*d_law_part_9_by_h + d_law_part_11_by_h*sin_w_23 + d_law_part_23_by_h*w_43
    d_law_part_25_by_h = d_law_part_17_by_h*law_part_24_w_42 + d_law_part_24_by_h*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_h = d_law_part_21_by_h*w_35 + d_law_part_25_by_h*w_36
    d_law_of_beta_by_h = d_law_part_14_by_h*w_35 + d_law_part_23_by_h*w_36
    inv_w_7_v = inv_w_7*v
    cos_gamma_inv_w_7_v = cos_gamma*inv_w_7_v
    w_45 = cos_gamma_inv_w_7_v*sin_psi
    w_46 = inv_cos_theta*inv_cos_theta*w_45
    cos_gamma_inv_w_7 = cos_gamma*inv_w_7
    w_47 = cos_gamma_inv_w_7*inv_cos_theta_sin_psi
    half_w_11_w_30 = half_w_11*w_30
    inv_w_7_sq_mu = inv_w_7_sq*mu
    d_law_part_11_by_v = half_w_11*inv_cos_gamma_lambda_psi
    d_law_part_9_by_v = half_w_11*lambda_gamma
    d_law_part_12_by_v = d_law_part_9_by_v*law_part_5 - d_law_part_11_by_v*law_part_10
    w_48 = d_law_part_12_by_v*law_part_13
    d_law_part_13_by_v = d_law_part_11_by_v*law_part_5 + d_law_part_9_by_v*law_part_10
    d_law_part_14_by_v = d_law_part_13_by_v*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_48
    d_law_part_15_by_v = cos_w_15*d_law_part_9_by_v + d_law_part_11_by_v*sin_w_15 + d_law_part_14_by_v*w_38
    d_law_part_16_by_v = 2.0*v
    d_law_part_17_by_v = -a_1*d_law_part_16_by_v*exp_h_inv_h_r*inv_area*inv_b_2*inv_lambda_v*inv_rho_0*inv_v_sq*inv_v_sq*m
    d_law_part_21_by_v = d_law_part_15_by_v*inv_lambda_v_w_16_w_37 + d_law_part_17_by_v*law_part_15_w_37
    d_law_part_23_by_v = d_law_part_13_by_v*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_48
    d_law_part_24_by_v = cos_w_23*d_law_part_9_by_v + d_law_part_11_by_v*sin_w_23 + d_law_part_23_by_v*w_43
    d_law_part_25_by_v = d_law_part_17_by_v*law_part_24_w_42 + d_law_part_24_by_v*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_v = d_law_part_21_by_v*w_35 + d_law_part_25_by_v*w_36
    d_law_of_beta_by_v = d_law_part_14_by_v*w_35 + d_law_part_23_by_v*w_36
    inv_cos_gamma_sq = inv_cos_gamma*inv_cos_gamma
    inv_w_7_v_sin_gamma = inv_w_7_v*sin_gamma
    w_49 = inv_cos_theta_sin_psi*inv_w_7_v_sin_gamma
    w_50 = inv_w_7*v - inv_v*inv_w_7_sq_mu
    sin_gamma_v = sin_gamma*v
    d_law_part_11_by_gamma = inv_cos_gamma_sq*lambda_psi*law_part_8*sin_gamma
    d_law_part_12_by_gamma = -d_law_part_11_by_gamma*law_part_10
    w_51 = d_law_part_12_by_gamma*law_part_13
    d_law_part_13_by_gamma = d_law_part_11_by_gamma*law_part_5
    d_law_part_14_by_gamma = d_law_part_13_by_gamma*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_51
    d_law_part_15_by_gamma = d_law_part_11_by_gamma*sin_w_15 + d_law_part_14_by_gamma*w_38
    d_law_part_21_by_gamma = d_law_part_15_by_gamma*inv_lambda_v_w_16_w_37
    d_law_part_23_by_gamma = d_law_part_13_by_gamma*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_51
    d_law_part_24_by_gamma = d_law_part_11_by_gamma*sin_w_23 + d_law_part_23_by_gamma*w_43
    d_law_part_25_by_gamma = d_law_part_24_by_gamma*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_gamma = d_law_part_21_by_gamma*w_35 + d_law_part_25_by_gamma*w_36
    d_law_of_beta_by_gamma = d_law_part_14_by_gamma*w_35 + d_law_part_23_by_gamma*w_36
    w_52 = cos_gamma_inv_w_7_v*cos_psi
    inv_cos_theta_w_52 = inv_cos_theta*w_52
    inv_cos_theta_w_45 = inv_cos_theta*w_45
    d_law_part_17_by_lambda_v = -inv_lambda_v*inv_lambda_v*w_16
    d_law_part_21_by_lambda_v = d_law_part_17_by_lambda_v*law_part_15_w_37
    d_law_part_25_by_lambda_v = d_law_part_17_by_lambda_v*law_part_24_w_42
    d_law_of_alpha_by_lambda_v = d_law_part_21_by_lambda_v*w_35 + d_law_part_25_by_lambda_v*w_36
    d_law_part_12_by_lambda_gamma = law_part_5*law_part_8
    w_53 = d_law_part_12_by_lambda_gamma*law_part_13
    d_law_part_13_by_lambda_gamma = law_part_10*law_part_8
    d_law_part_14_by_lambda_gamma = d_law_part_13_by_lambda_gamma*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_53
    d_law_part_15_by_lambda_gamma = cos_w_15*law_part_8 + d_law_part_14_by_lambda_gamma*w_38
    d_law_part_21_by_lambda_gamma = d_law_part_15_by_lambda_gamma*inv_lambda_v_w_16_w_37
    d_law_part_23_by_lambda_gamma = d_law_part_13_by_lambda_gamma*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_53
    d_law_part_24_by_lambda_gamma = cos_w_23*law_part_8 + d_law_part_23_by_lambda_gamma*w_43
    d_law_part_25_by_lambda_gamma = d_law_part_24_by_lambda_gamma*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_lambda_gamma = d_law_part_21_by_lambda_gamma*w_35 + d_law_part_25_by_lambda_gamma*w_36
    d_law_of_beta_by_lambda_gamma = d_law_part_14_by_lambda_gamma*w_35 + d_law_part_23_by_lambda_gamma*w_36
    d_law_part_12_by_lambda_psi = -inv_cos_gamma_law_part_8*law_part_10
    w_54 = d_law_part_12_by_lambda_psi*law_part_13
    d_law_part_13_by_lambda_psi = inv_cos_gamma_law_part_8*law_part_5
    d_law_part_14_by_lambda_psi = d_law_part_13_by_lambda_psi*inv_w_39*law_part_12*w_40 - inv_w_39_w_40*w_54
    d_law_part_15_by_lambda_psi = d_law_part_14_by_lambda_psi*w_38 + inv_cos_gamma_law_part_8*sin_w_15
    d_law_part_21_by_lambda_psi = d_law_part_15_by_lambda_psi*inv_lambda_v_w_16_w_37
    d_law_part_23_by_lambda_psi = d_law_part_13_by_lambda_psi*inv_w_39*law_part_12*w_44 - inv_w_39_w_44*w_54
    d_law_part_24_by_lambda_psi = d_law_part_23_by_lambda_psi*w_43 + inv_cos_gamma_law_part_8*sin_w_23
    d_law_part_25_by_lambda_psi = d_law_part_24_by_lambda_psi*inv_lambda_v_w_16_w_42
    d_law_of_alpha_by_lambda_psi = d_law_part_21_by_lambda_psi*w_35 + d_law_part_25_by_lambda_psi*w_36
    d_law_of_beta_by_lambda_psi = d_law_part_14_by_lambda_psi*w_35 + d_law_part_23_by_lambda_psi*w_36
    out[0, 0] = w
    out[0, 6] = 1.0 - w
    out[1, 1] = w_2
    out[1, 7] = 1.0 - w_2
    out[2, 2] = w_3
    out[2, 8] = 1.0 - w_3
    out[3, 3] = w_4
    out[3, 9] = 1.0 - w_4
    out[4, 4] = w_5
    out[4, 10] = 1.0 - w_5
    out[5, 5] = w_6
    out[5, 11] = 1.0 - w_6
    out[6, 0] = d_law_of_alpha_by_h*w_34 + d_law_of_beta_by_h*w_33 + lambda_gamma*(cos_gamma*(inv_v*w_9 - inv_w_7_sq_v) - inv_h_r*w_32) + lambda_psi*(-inv_h_r*w_31 - sin_theta*w_8) + lambda_v*(half_w_11_v_sq_w_28*inv_h_r + sin_gamma*w_9) - cos_gamma_inv_w_7_sq_v*cos_psi_lambda_theta - lambda_phi*w_8
    out[6, 2] = lambda_phi*sin_theta*w_46 + lambda_psi*(sin_theta*sin_theta*w_46 + w_45)
    out[6, 3] = cos_gamma_inv_w_7*cos_psi_lambda_theta + d_law_of_alpha_by_v*w_34 + d_law_of_beta_by_v*w_33 + lambda_gamma*(cos_gamma*(inv_v*inv_v*inv_w_7_sq_mu + inv_w_7) + cos_w_29*half_w_11_w_30) + lambda_h*sin_gamma + lambda_phi*w_47 + lambda_psi*(half_w_11_w_30*inv_cos_gamma_sin_w_29 + sin_theta*w_47) - lambda_v*v*w_11*w_28
    out[6, 4] = cos_gamma*lambda_h*v + d_law_of_alpha_by_gamma*w_34 + d_law_of_beta_by_gamma*w_33 + lambda_psi*(half_w_11_w_30*inv_cos_gamma_sq*sin_gamma_v*sin_w_29 - sin_theta*w_49) - cos_gamma*inv_w_7_sq_mu*lambda_v - cos_psi_lambda_theta*inv_w_7_v_sin_gamma - lambda_gamma*sin_gamma*w_50 - lambda_phi*w_49
    out[6, 5] = inv_cos_theta_w_52*lambda_phi + inv_cos_theta_w_52*lambda_psi*sin_theta - lambda_theta*w_45
    out[6, 6] = sin_gamma_v
    out[6, 7] = inv_cos_theta_w_45
    out[6, 8] = w_52
    out[6, 9] = d_law_of_alpha_by_lambda_v*w_34 - half_w_11_v_sq_w_28 - inv_w_7_sq_mu*sin_gamma
    out[6, 10] = cos_gamma*w_50 + d_law_of_alpha_by_lambda_gamma*w_34 + d_law_of_beta_by_lambda_gamma*w_33 + w_32
    out[6, 11] = d_law_of_alpha_by_lambda_psi*w_34 + d_law_of_beta_by_lambda_psi*w_33 + inv_cos_theta_w_45*sin_theta + w_31
    return out
