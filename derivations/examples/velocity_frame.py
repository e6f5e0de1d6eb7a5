"""Axes aligned with the velocity of a satellite on a Kepler orbit, and their angular velocity.

The orbit is a conic of eccentricity e; its motion follows from the angular momentum alone. The velocity makes the
flight path angle beta with the local horizontal, so the axes rotate through the angle f - beta.
"""

from sympy import atan, cos, sin, sqrt

from satsym.symbolic import Definition, FirstOrder, Output, Variable, symbols_of

STATES = (Variable("f", "f", "rad", "true anomaly", kind="angle"),)
PARAMETERS = (
    Variable("e", "e", "1", "eccentricity", 0.3, positive=True, typical=(0.05, 0.8)),
    Variable("p", "p", "km", "semi-latus rectum", 1.0, positive=True),
    Variable("mu", r"\mu", "km**3/s**2", "gravitational parameter", 1.0, positive=True),
)
H = Variable("h", "h", "km**2/s", "angular momentum per unit mass", positive=True)
R = Variable("r", "r", "km", "distance from the centre of force", positive=True)
V_R = Variable("v_r", "v_r", "km/s", "radial velocity")
V = Variable("v", "v", "km/s", "speed", positive=True)
BETA = Variable("beta", r"\beta", "rad", "flight path angle")

(f,), (e, p, mu) = symbols_of(STATES), symbols_of(PARAMETERS)
(h,) = symbols_of((H,))
r = p / (1 + e * cos(f))
v_r = mu / h * e * sin(f)

velocity_frame = FirstOrder(
    name="velocity_frame",
    title="Axes aligned with the velocity on a Kepler orbit",
    states=STATES,
    controls=(),
    parameters=PARAMETERS,
    definitions=(Definition(H, sqrt(mu * p)),),
    rates={f: h / r**2},
    outputs=(
        Output(R, r),
        Output(V_R, v_r),
        Output(V, sqrt(v_r**2 + h**2 / r**2)),
        Output(BETA, atan(e * sin(f) / (1 + e * cos(f)))),
    ),
)

PROBLEMS = (velocity_frame,)

TRANSLATIONS = {
    "id": {
        "Axes aligned with the velocity on a Kepler orbit": "Sumbu yang searah dengan kecepatan pada orbit Kepler",
        "flight path angle": "sudut lintasan terbang",
        "eccentricity": "eksentrisitas",
        "true anomaly": "anomali sejati",
        "angular momentum per unit mass": "momentum sudut per satuan massa",
        "semi-latus rectum": "semi-latus rektum",
    }
}
