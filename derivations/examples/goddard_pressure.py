"""Goddard's rocket with bounded dynamic pressure: the engine is throttled while the air is dense.

The rocket and its data are those of ``goddard`` (COPS 3.0, problem 10). Drag is dynamic pressure times an area; with
the defaults, a pressure of 10 corresponds to a drag of half the initial weight. Full thrust is followed by a boundary
arc, a singular arc, and a coast; the duration of each arc, and whether it occurs at all, depends on the bound (Seywald
and Cliff, Goddard problem in presence of a dynamic pressure limit, Journal of Guidance, Control, and Dynamics 16,
1993).
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
    Variable("rho0", r"\rho_0", meaning="density of the air at the initial height", default=12400.0, positive=True),
    Variable("area", r"A_{\mathrm{ref}}", meaning="drag reference area", default=0.05, positive=True),
    Variable("beta", r"\beta", meaning="rate of decrease of the density with height", default=500.0, positive=True),
    Variable("g0", "g_0", meaning="acceleration of gravity at the initial height", default=1.0, positive=True),
    Variable("c", "c", meaning="exhaust velocity", default=0.5, positive=True),
    Variable("q_max", r"q_{\max}", meaning="maximum dynamic pressure", default=10.0, positive=True),
)
h, v, m = symbols_of(STATES)
(T,) = symbols_of(CONTROLS)
rho0, area, beta, g0, c, q_max = symbols_of(PARAMETERS)

pressure = rho0 / 2 * v**2 * exp(-beta * (h - 1))

goddard_pressure = Problem(
    name="goddard_pressure",
    title="Goddard rocket: ascent to maximum altitude under a dynamic-pressure limit",
    model=FirstOrder(
        name="rocket_in_air",
        title="Rocket in vertical ascent through the atmosphere",
        states=STATES,
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates={h: v, v: (T - area * pressure) / m - g0 / h**2, m: -T / c},
    ),
    running_cost=0,
    terminal_cost=h,
    maximise=True,
    control_set="box",
    path_constraints={"pressure": pressure - q_max},
)

TRANSLATIONS = {
    "id": {
        "Goddard rocket: ascent to maximum altitude under a dynamic-pressure limit": (
            "Roket Goddard: naik ke ketinggian maksimum dengan batas tekanan dinamik"
        ),
        "Rocket in vertical ascent through the atmosphere": "Roket yang bergerak vertikal melalui atmosfer",
        "distance from the centre of force": "jarak dari pusat gaya",
        "velocity": "kecepatan",
        "mass": "massa",
        "thrust": "gaya dorong",
        "density of the air at the initial height": "massa jenis udara pada ketinggian awal",
        "drag reference area": "luas acuan gaya hambat",
        "rate of decrease of the density with height": "laju berkurangnya massa jenis udara terhadap ketinggian",
        "acceleration of gravity at the initial height": "percepatan gravitasi pada ketinggian awal",
        "exhaust velocity": "kecepatan gas buang",
        "maximum dynamic pressure": "tekanan dinamik maksimum",
    },
}

PROBLEMS = (goddard_pressure,)
