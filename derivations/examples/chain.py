"""A chain that hangs between two points: its shape has the least potential energy (Euler, 1744; COPS 3.0, problem 3).

The slope of the chain is the control, its length a state: of length 4 between heights 1 and 3 at distance 1 it is a
catenary, y = c cosh((x - m) / c) + d, whose three constants follow from the two ends and the length.
"""

from sympy import sqrt

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("height", "y", meaning="height at the horizontal distance t"),
    Variable("length", "s", meaning="length so far"),
)
CONTROLS = (Variable("slope", "u", meaning="slope of the chain"),)
height, length = symbols_of(STATES)
(slope,) = symbols_of(CONTROLS)

chain = Problem(
    name="chain",
    title="A hanging chain",
    model=FirstOrder(
        name="curve",
        title="A curve over the horizontal, with its length",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={height: slope, length: sqrt(1 + slope**2)},
    ),
    running_cost=height * sqrt(1 + slope**2),
)

TRANSLATIONS = {
    "id": {
        "A hanging chain": "Rantai yang menggantung",
        "A curve over the horizontal, with its length": "Kurva di atas horizontal beserta panjangnya",
        "height at the horizontal distance t": "ketinggian pada jarak horizontal t",
        "length so far": "panjang sampai titik ini",
        "slope of the chain": "kemiringan rantai",
    },
}

PROBLEMS = (chain,)
