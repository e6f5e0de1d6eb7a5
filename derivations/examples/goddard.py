"""Goddard's rocket: a vertical ascent to the maximum altitude that the fuel allows.

Thrust is limited; drag grows with the square of the velocity and falls exponentially with altitude. The optimum has
full thrust, then a singular arc that balances the losses due to drag and to gravity, then a coast to the top. The data
are those of Dolan, More and Munson (Benchmarking optimization software with COPS 3.0, 2004), in units of the initial
radius, the gravity there and the initial mass.
"""

from sympy import exp

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("h", "h", meaning="distance from the centre of force", positive=True, typical=(1.0, 1.02)),
    Variable("v", "v", meaning="velocity", typical=(0.01, 0.15)),
    Variable("m", "m", meaning="mass", positive=True, typical=(0.6, 1.0)),
)
CONTROLS = (Variable("T", "T", meaning="thrust", typical=(0.0, 3.5)),)
PARAMETERS = (
    Variable("D0", "D_0", meaning="drag at unit velocity and initial height", default=310.0, positive=True),
    Variable("beta", r"\beta", meaning="rate of decrease of the drag with height", default=500.0, positive=True),
    Variable("g0", "g_0", meaning="acceleration of gravity at the initial height", default=1.0, positive=True),
    Variable("c", "c", meaning="exhaust velocity", default=0.5, positive=True),
)
h, v, m = symbols_of(STATES)
(T,) = symbols_of(CONTROLS)
D0, beta, g0, c = symbols_of(PARAMETERS)

goddard = Problem(
    name="goddard",
    title="Goddard rocket: ascent to maximum altitude",
    model=FirstOrder(
        name="rocket",
        title="Rocket in vertical ascent",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={h: v, v: (T - D0 * v**2 * exp(-beta * (h - 1))) / m - g0 / h**2, m: -T / c},
    ),
    running_cost=0,
    terminal_cost=h,
    maximise=True,
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "Goddard rocket: ascent to maximum altitude": "Roket Goddard: naik ke ketinggian maksimum",
        "Rocket in vertical ascent": "Roket yang bergerak vertikal",
        "distance from the centre of force": "jarak dari pusat gaya",
        "velocity": "kecepatan",
        "mass": "massa",
        "thrust": "gaya dorong",
        "drag at unit velocity and initial height": "gaya hambat pada kecepatan satu dan ketinggian awal",
        "rate of decrease of the drag with height": "laju berkurangnya gaya hambat terhadap ketinggian",
        "acceleration of gravity at the initial height": "percepatan gravitasi pada ketinggian awal",
        "exhaust velocity": "kecepatan gas buang",
    },
}

PROBLEMS = (goddard,)
