"""Three integrators in a row, the last driven by a bounded control: least time, least energy, least fuel."""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = tuple(Variable(f"x{k}", f"x_{k}", meaning=f"state {k}") for k in (1, 2, 3))
CONTROLS = (Variable("u1", "u_1", meaning="rate of the last state"),)
x1, x2, x3 = symbols_of(STATES)
(u1,) = symbols_of(CONTROLS)

chain = FirstOrder(
    name="chain",
    title="Three integrators in a row",
    states=STATES,
    controls=CONTROLS,
    parameters=(),
    rates={x1: x2, x2: x3, x3: u1},
)

PROBLEMS = tuple(
    Problem(name=f"chain_{name}", title=f"Least {name} of a chain", model=chain, running_cost=cost, control_set="box")
    for name, cost in (("time", 1), ("energy", u1**2 / 2), ("fuel", abs(u1)))
)
