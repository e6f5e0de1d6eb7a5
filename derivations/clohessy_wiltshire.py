"""A satellite near a circular orbit: deviations from the reference of polar_orbit, to first order.

The new variables are lengths and velocities: along the orbit, deviations of angles are multiplied by its radius.
"""

from pathlib import Path

from satsym.symbolic import Linearised, Output, Problem, Variable, symbols_of, t
from satsym.symbolic.loader import find, load

orbit = next(p.model for p in load(find("polar_orbit", Path(__file__).parent)) if isinstance(p, Problem))

STATES = (
    Variable("x1", "x_1", "km", "deviation of the distance from the centre of force"),
    Variable("x2", "x_2", "km/s", "deviation of the radial velocity"),
    Variable("x3", "x_3", "km", "deviation of the angle, as a length along the reference orbit"),
    Variable("x4", "x_4", "km/s", "deviation of the angular velocity, as a velocity along the reference orbit"),
)
PARAMETERS = tuple(v for v in orbit.parameters if v.symbol in ("sigma", "omega"))
DISTANCE = Variable("y1", "y_1", "km", "deviation of the measured distance")
ANGLE = Variable("y2", "y_2", "km", "deviation of the measured angle, times the radius of the reference orbit")

r, r_dot, theta, theta_dot = symbols_of(orbit.states)
x1, x2, x3, x4 = symbols_of(STATES)
sigma, omega = symbols_of(PARAMETERS)

clohessy_wiltshire = Linearised(
    name="clohessy_wiltshire",
    title="Clohessy-Wiltshire equations: linearised in-plane motion near a circular orbit",
    of=orbit,
    about=orbit.reference,
    states=STATES,
    controls=orbit.controls,
    parameters=PARAMETERS,
    definitions=orbit.definitions,
    deviations={x1: r - sigma, x2: r_dot, x3: sigma * (theta - omega * t), x4: sigma * (theta_dot - omega)},
    outputs=(Output(DISTANCE, r), Output(ANGLE, sigma * theta)),
)

TRANSLATIONS = {
    "id": {
        "Clohessy-Wiltshire equations: linearised in-plane motion near a circular orbit": (
            "Persamaan Clohessy-Wiltshire: linearisasi gerak sebidang di dekat orbit lingkaran"
        ),
        "deviation of the distance from the centre of force": "simpangan jarak dari pusat gaya",
        "deviation of the radial velocity": "simpangan kecepatan radial",
        "deviation of the angle, as a length along the reference orbit": (
            "simpangan sudut, sebagai panjang sepanjang orbit acuan"
        ),
        "deviation of the angular velocity, as a velocity along the reference orbit": (
            "simpangan kecepatan sudut, sebagai kecepatan sepanjang orbit acuan"
        ),
        "deviation of the measured distance": "simpangan jarak terukur",
        "deviation of the measured angle, times the radius of the reference orbit": (
            "simpangan sudut terukur kali jari-jari orbit acuan"
        ),
    },
}

PROBLEMS = (clohessy_wiltshire,)
