"""Zermelo's problem: a ship crosses a current in minimum time (Zermelo, 1931).

The current is along x and grows with y. The ship heads for the origin; from (3.66, -1.86) h, where the current is -V y
/ h, its heading turns from 105 degrees to 240 (Bryson and Ho, Applied Optimal Control, 2.7).
"""

from sympy import cos, sin

from satsym.symbolic import Angle, FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("x", "x", meaning="distance along the current"),
    Variable("y", "y", meaning="distance across the current"),
)
CONTROLS = (Variable("heading", r"\theta", meaning="heading, from the direction of x", kind="angle"),)
PARAMETERS = (
    Variable("V", "V", meaning="speed of the ship in the water", default=1.0, positive=True),
    Variable("h", "h", meaning="distance over which the current grows by the ship's speed", default=1.0, positive=True),
)
x, y = symbols_of(STATES)
(heading,) = symbols_of(CONTROLS)
V, h = symbols_of(PARAMETERS)

zermelo = Problem(
    name="zermelo",
    title="Zermelo's problem: minimum-time crossing of a linear current",
    model=FirstOrder(
        name="ship",
        title="Ship in a current",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={x: V * cos(heading) - V * y / h, y: V * sin(heading)},
    ),
    running_cost=1,
    control_sets={"rudder": Angle("heading")},
)

TRANSLATIONS = {
    "id": {
        "Zermelo's problem: minimum-time crossing of a linear current": (
            "Masalah Zermelo: melintasi arus linear dalam waktu minimum"
        ),
        "Ship in a current": "Kapal dalam arus",
        "distance along the current": "jarak sepanjang arus",
        "distance across the current": "jarak melintang terhadap arus",
        "heading, from the direction of x": "sudut haluan dari arah x",
        "speed of the ship in the water": "laju kapal di dalam air",
        "distance over which the current grows by the ship's speed": (
            "jarak yang sepanjangnya kecepatan arus bertambah sebesar laju kapal"
        ),
    },
}

PROBLEMS = (zermelo,)
