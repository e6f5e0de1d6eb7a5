"""Two catalysts are mixed along a tubular reactor so that the yield of the product is maximal.

This is problem 14 of COPS (Dolan, More and Munson, Benchmarking optimization software with COPS 3.0, 2004), after
Jackson (1968). The position along the reactor takes the role of time. In the optimum, the mixing ratio is first one,
then singular, then zero.
"""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("x1", "x_1", meaning="fraction of substance 1"),
    Variable("x2", "x_2", meaning="fraction of substance 2"),
)
CONTROLS = (Variable("u", "u", meaning="fraction of the first catalyst"),)
x1, x2 = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)

catalyst = Problem(
    name="catalyst",
    title="Catalyst mixing for maximum yield",
    model=FirstOrder(
        name="tubular_reactor",
        title="Tubular reactor with two catalysts",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={x1: u * (10 * x2 - x1), x2: u * (x1 - 10 * x2) - (1 - u) * x2},
    ),
    running_cost=0,
    terminal_cost=1 - x1 - x2,
    maximise=True,
    control_set="box",
)

TRANSLATIONS = {
    "id": {
        "Catalyst mixing for maximum yield": "Pencampuran katalis untuk hasil maksimum",
        "Tubular reactor with two catalysts": "Reaktor pipa dengan dua katalis",
        "fraction of substance 1": "fraksi zat 1",
        "fraction of substance 2": "fraksi zat 2",
        "fraction of the first catalyst": "fraksi katalis pertama",
    },
}

PROBLEMS = (catalyst,)
