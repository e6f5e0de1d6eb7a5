"""A mass on a spring, pushed within bounds: least time, least energy, least fuel."""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("x1", "x_1", meaning="deflection"), Variable("x2", "x_2", meaning="its rate"))
CONTROLS = (Variable("u1", "u_1", meaning="push"),)
FREQUENCY = Variable("omega", r"\omega", meaning="frequency", default=1.0, positive=True)
x1, x2 = symbols_of(STATES)
(u1,) = symbols_of(CONTROLS)
(omega,) = symbols_of((FREQUENCY,))

spring = FirstOrder(
    name="spring",
    title="A mass on a spring",
    states=STATES,
    controls=CONTROLS,
    parameters=(FREQUENCY,),
    rates={x1: x2, x2: u1 - omega**2 * x1},
)

PROBLEMS = tuple(
    Problem(
        name=f"oscillator_{name}",
        title=f"Least {name} of an oscillator",
        model=spring,
        running_cost=cost,
        control_set="box",
    )
    for name, cost in (("time", 1), ("energy", u1**2 / 2), ("fuel", abs(u1)))
)
