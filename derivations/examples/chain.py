"""A chain hangs between two points: its shape has minimum potential energy (Euler, 1744; COPS 3.0, problem 3).

The slope of the chain is the control, and its length is a state. With length 4, between heights 1 and 3 at a horizontal
distance of 1, the shape is a catenary, y = c cosh((x - m) / c) + d, whose three constants follow from the two ends and
the length.
"""

from sympy import sqrt

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("height", "y", meaning="height at the horizontal distance t"),
    Variable("length", "s", meaning="arc length up to this point"),
)
CONTROLS = (Variable("slope", "u", meaning="slope of the chain"),)
height, length = symbols_of(STATES)
(slope,) = symbols_of(CONTROLS)

chain = Problem(
    name="chain",
    title="Hanging chain of given length",
    model=FirstOrder(
        name="curve",
        title="Plane curve with its arc length",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={height: slope, length: sqrt(1 + slope**2)},
    ),
    running_cost=height * sqrt(1 + slope**2),
)

TRANSLATIONS = {
    "id": {
        "Hanging chain of given length": "Rantai menggantung dengan panjang tertentu",
        "Plane curve with its arc length": "Kurva bidang beserta panjang busurnya",
        "height at the horizontal distance t": "ketinggian pada jarak horizontal t",
        "arc length up to this point": "panjang sampai titik ini",
        "slope of the chain": "kemiringan rantai",
    },
}

PROBLEMS = (chain,)
