"""Transfer from one circular orbit to another with minimum fuel, in a given time and with bounded thrust.

Mass decreases in proportion to the magnitude of the thrust. The optimum alternates between arcs of full thrust and
coasts, as the primer vector determines (Lawden, Optimal Trajectories for Space Navigation, 1963). Lengths are in units
of the radius of the first orbit, times in units of the time in which a satellite on that orbit moves through one
radian; the initial mass is one.
"""

from sympy import sqrt

from satsym.symbolic import Ball, FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("r", "r", meaning="distance from the centre of force", positive=True),
    Variable("theta", r"\theta", meaning="polar angle", kind="angle"),
    Variable("u", "u", meaning="radial velocity"),
    Variable("v", "v", meaning="transverse velocity"),
    Variable("m", "m", meaning="mass over the initial mass", positive=True),
)
CONTROLS = (
    Variable("T_r", "T_r", meaning="radial thrust over the initial mass"),
    Variable("T_t", r"T_\theta", meaning="transverse thrust over the initial mass"),
)
PARAMETERS = (
    Variable("mu", r"\mu", meaning="gravitational parameter", default=1.0, positive=True),
    Variable("c", "c", meaning="exhaust velocity", default=1.0, positive=True),
)
r, theta, u, v, m = symbols_of(STATES)
T_r, T_t = symbols_of(CONTROLS)
mu, c = symbols_of(PARAMETERS)
thrust = sqrt(T_r**2 + T_t**2)

transfer_fuel = Problem(
    name="transfer_fuel",
    title="Minimum-fuel transfer between circular orbits",
    model=FirstOrder(
        name="throttled_satellite",
        title="Satellite with steerable, throttleable thrust",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={r: u, theta: v / r, u: v**2 / r - mu / r**2 + T_r / m, v: -u * v / r + T_t / m, m: -thrust / c},
    ),
    running_cost=thrust / c,
    control_sets={"thrust": Ball("T_r", "T_t")},
)

TRANSLATIONS = {
    "id": {
        "Minimum-fuel transfer between circular orbits": ("Transfer antara orbit lingkaran dengan bahan bakar minimum"),
        "Satellite with steerable, throttleable thrust": ("Satelit yang gaya dorongnya dapat diarahkan dan diatur"),
        "distance from the centre of force": "jarak dari pusat gaya",
        "polar angle": "sudut polar",
        "radial velocity": "kecepatan radial",
        "transverse velocity": "kecepatan transversal",
        "mass over the initial mass": "massa dibagi massa awal",
        "radial thrust over the initial mass": "gaya dorong radial dibagi massa awal",
        "transverse thrust over the initial mass": "gaya dorong transversal dibagi massa awal",
        "gravitational parameter": "parameter gravitasi",
        "exhaust velocity": "kecepatan gas buang",
    },
}

PROBLEMS = (transfer_fuel,)
