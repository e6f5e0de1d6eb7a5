"""Transfer from one circular orbit to another in minimum time, with constant thrust in a free direction.

The mass flow rate is constant, so the mass is a known function of time. The data are those of the transfer from the
Earth's orbit to that of Mars (Bryson and Ho, Applied Optimal Control, 2.5). Lengths are in units of the radius of the
first orbit, times in units of the time in which a satellite on that orbit moves through one radian.
"""

from sympy import cos, sin

from satsym.symbolic import Angle, FirstOrder, Problem, Variable, symbols_of, t

STATES = (
    Variable("r", "r", meaning="distance from the centre of force", positive=True),
    Variable("u", "u", meaning="radial velocity"),
    Variable("v", "v", meaning="transverse velocity"),
)
CONTROLS = (Variable("beta", r"\beta", meaning="direction of the thrust, above the local horizontal", kind="angle"),)
PARAMETERS = (
    Variable("mu", r"\mu", meaning="gravitational parameter", default=1.0, positive=True),
    Variable("F", "F", meaning="thrust over the initial mass", default=0.1405, positive=True),
    Variable("w", "w", meaning="mass flow rate over the initial mass", default=0.07487, positive=True),
)
r, u, v = symbols_of(STATES)
(beta,) = symbols_of(CONTROLS)
mu, F, w = symbols_of(PARAMETERS)
push = F / (1 - w * t)

transfer_time = Problem(
    name="transfer_time",
    title="Minimum-time transfer between circular orbits",
    model=FirstOrder(
        name="thrusting_satellite",
        title="Satellite with constant thrust",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={r: u, u: v**2 / r - mu / r**2 + push * sin(beta), v: -u * v / r + push * cos(beta)},
    ),
    running_cost=1,
    control_sets={"steering": Angle("beta")},
)

TRANSLATIONS = {
    "id": {
        "Minimum-time transfer between circular orbits": "Transfer antara orbit lingkaran dengan waktu minimum",
        "Satellite with constant thrust": "Satelit dengan gaya dorong konstan",
        "distance from the centre of force": "jarak dari pusat gaya",
        "radial velocity": "kecepatan radial",
        "transverse velocity": "kecepatan transversal",
        "direction of the thrust, above the local horizontal": "sudut gaya dorong terhadap horizontal setempat",
        "gravitational parameter": "parameter gravitasi",
        "thrust over the initial mass": "gaya dorong dibagi massa awal",
        "mass flow rate over the initial mass": "laju aliran massa dibagi massa awal",
    },
}

PROBLEMS = (transfer_time,)
