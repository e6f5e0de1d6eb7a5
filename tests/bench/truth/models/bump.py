"""Ways across a plane on which a round hill of cost stands; around it lead two ways that may cost the same."""

from sympy import exp

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

PLACES = (Variable("x", "x", meaning="first coordinate"), Variable("y", "y", meaning="second coordinate"))
RATES = (Variable("v_x", "v_x", meaning="first rate"), Variable("v_y", "v_y", meaning="second rate"))
CONTROLS = (Variable("u1", "u_1", meaning="control along x"), Variable("u2", "u_2", meaning="control along y"))
PARAMETERS = (
    Variable("height", "h", meaning="height of the hill", default=1.0, positive=True),
    Variable("width", "b", meaning="width of the hill", default=0.3, positive=True),
)
x, y = symbols_of(PLACES)
v_x, v_y = symbols_of(RATES)
u1, u2 = symbols_of(CONTROLS)
height, width = symbols_of(PARAMETERS)
COST = (u1**2 + u2**2) / 2 + height * exp(-(x**2 + y**2) / (2 * width**2))

steered = FirstOrder(
    name="steered",
    title="A point whose velocity is chosen",
    states=PLACES,
    controls=CONTROLS,
    parameters=PARAMETERS,
    rates={x: u1, y: u2},
)
pushed = FirstOrder(
    name="pushed",
    title="A point whose acceleration is chosen",
    states=(*PLACES, *RATES),
    controls=CONTROLS,
    parameters=PARAMETERS,
    rates={x: v_x, y: v_y, v_x: u1, v_y: u2},
)

PROBLEMS = tuple(
    Problem(name=name, title="Around a hill", model=model, running_cost=COST, control_set="box")
    for name, model in (("bump_steered", steered), ("bump_pushed", pushed))
)
