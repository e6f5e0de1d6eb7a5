"""The brachistochrone: the curve along which a bead slides from point to point in minimum time (Bernoulli, 1696).

The slope of the curve is the control. From (0, 10) to (10, 5), it is the cycloid x = a (phi - sin phi), y = 10 - a (1 -
cos phi), which is traversed with t = phi sqrt(a / g). With g = 9.80665 m/s^2, the time is 1.8016031225 s.
"""

from sympy import cos, sin

from satsym.symbolic import Angle, FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("x", "x", "m", meaning="horizontal distance"),
    Variable("y", "y", "m", meaning="height"),
    Variable("v", "v", "m/s", meaning="speed"),
)
CONTROLS = (Variable("theta", r"\theta", "rad", meaning="angle of the path below the horizontal", kind="angle"),)
PARAMETERS = (Variable("g", "g", "m/s^2", meaning="acceleration of gravity", default=9.80665, positive=True),)
x, y, v = symbols_of(STATES)
(theta,) = symbols_of(CONTROLS)
(g,) = symbols_of(PARAMETERS)

brachistochrone = Problem(
    name="brachistochrone",
    title="Brachistochrone: a bead sliding down a curve in minimum time",
    model=FirstOrder(
        name="bead",
        title="Bead on a curve",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={x: v * cos(theta), y: -v * sin(theta), v: g * sin(theta)},
    ),
    running_cost=1,
    control_sets={"slope": Angle("theta")},
)

TRANSLATIONS = {
    "id": {
        "Brachistochrone: a bead sliding down a curve in minimum time": (
            "Brakistokron: manik yang meluncur sepanjang kurva dalam waktu minimum"
        ),
        "Bead on a curve": "Manik pada kurva",
        "horizontal distance": "jarak horizontal",
        "height": "ketinggian",
        "speed": "laju",
        "angle of the path below the horizontal": "sudut arah gerak di bawah horizontal",
        "acceleration of gravity": "percepatan gravitasi",
    },
}

PROBLEMS = (brachistochrone,)
