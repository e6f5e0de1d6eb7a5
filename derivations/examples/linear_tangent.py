"""Steering in a plane at constant acceleration: the linear tangent law (Bryson and Ho, Applied Optimal Control, 2.4).

The data are those of Betts, Practical Methods for Optimal Control, 4.6: the motion leads from rest to a height of 5 and
a horizontal velocity of 45 in minimum time, with an acceleration of 100.
"""

from sympy import cos, sin

from satsym.symbolic import Angle, FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("x", "x", meaning="horizontal distance"),
    Variable("y", "y", meaning="height"),
    Variable("vx", "v_x", meaning="horizontal velocity"),
    Variable("vy", "v_y", meaning="vertical velocity"),
)
CONTROLS = (Variable("beta", r"\beta", meaning="direction of the acceleration, above the horizontal", kind="angle"),)
PARAMETERS = (Variable("a", "a", meaning="acceleration", default=100.0, positive=True),)
x, y, vx, vy = symbols_of(STATES)
(beta,) = symbols_of(CONTROLS)
(a,) = symbols_of(PARAMETERS)

steered = FirstOrder(
    name="steered_point",
    title="Point mass steered in a plane at constant acceleration",
    states=STATES,
    controls=CONTROLS,
    parameters=PARAMETERS,
    rates={x: vx, y: vy, vx: a * cos(beta), vy: a * sin(beta)},
)

linear_tangent = Problem(
    name="linear_tangent",
    title="Minimum-time steering in a plane: the linear tangent law",
    model=steered,
    running_cost=1,
    control_sets={"steering": Angle("beta")},
)

TRANSLATIONS = {
    "id": {
        "Minimum-time steering in a plane: the linear tangent law": (
            "Pengarahan pada bidang dengan waktu minimum: hukum tangen linear"
        ),
        "Point mass steered in a plane at constant acceleration": (
            "Titik massa yang diarahkan pada bidang dengan percepatan konstan"
        ),
        "horizontal distance": "jarak horizontal",
        "height": "ketinggian",
        "horizontal velocity": "kecepatan horizontal",
        "vertical velocity": "kecepatan vertikal",
        "direction of the acceleration, above the horizontal": "sudut percepatan terhadap horizontal",
        "acceleration": "percepatan",
    },
}

PROBLEMS = (linear_tangent,)
