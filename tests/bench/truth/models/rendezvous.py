"""Rendezvous near a circular orbit (Clohessy and Wiltshire), least energy, with two engines or a steerable one."""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (
    Variable("x", "x", meaning="deviation outwards"),
    Variable("x_dot", r"\dot x", meaning="its rate"),
    Variable("y", "y", meaning="deviation ahead"),
    Variable("y_dot", r"\dot y", meaning="its rate"),
)
CONTROLS = (Variable("u1", "u_1", meaning="thrust outwards"), Variable("u2", "u_2", meaning="thrust ahead"))
RATE = Variable("omega", r"\omega", meaning="angular velocity of the orbit", default=1.0, positive=True)
x, x_dot, y, y_dot = symbols_of(STATES)
u1, u2 = symbols_of(CONTROLS)
(omega,) = symbols_of((RATE,))

nearby = FirstOrder(
    name="nearby",
    title="Motion near a circular orbit",
    states=STATES,
    controls=CONTROLS,
    parameters=(RATE,),
    rates={
        x: x_dot,
        x_dot: 3 * omega**2 * x + 2 * omega * y_dot + u1,
        y: y_dot,
        y_dot: u2 - 2 * omega * x_dot,
    },
)

PROBLEMS = tuple(
    Problem(
        name=f"rendezvous_{kind}",
        title="Rendezvous with least energy",
        model=nearby,
        running_cost=(u1**2 + u2**2) / 2,
        control_set=kind,
    )
    for kind in ("box", "ball")
)
