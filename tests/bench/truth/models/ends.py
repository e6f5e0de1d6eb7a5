"""Ends that are constrained or rewarded: on an ellipse, on a line of the phase plane, far away."""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("x1", "x_1", meaning="first state"), Variable("x2", "x_2", meaning="second state"))
CONTROLS = tuple(Variable(f"u{k}", f"u_{k}", meaning=f"control {k}") for k in (1, 2))
AXES = tuple(
    Variable(name, name, meaning=f"half axis {name} of the ellipse", default=1.0, positive=True) for name in "ab"
)
LINE = (
    Variable("m", "m", meaning="slope of the line", default=1.0),
    Variable("c", "c", meaning="where it meets the axis", default=0.0),
)
WEIGHTS = tuple(Variable(f"k{k}", f"k_{k}", meaning=f"terminal weight of state {k}", default=0.0) for k in (1, 2))
x1, x2 = symbols_of(STATES)
u1, u2 = symbols_of(CONTROLS)
a, b = symbols_of(AXES)
m, c = symbols_of(LINE)
k1, k2 = symbols_of(WEIGHTS)

plane = FirstOrder(
    name="plane",
    title="A point of the plane",
    states=STATES,
    controls=CONTROLS,
    parameters=AXES,
    rates={x1: u1, x2: u2},
)
body = FirstOrder(
    name="body",
    title="A body on a line",
    states=STATES,
    controls=CONTROLS[:1],
    parameters=LINE,
    rates={x1: x2, x2: u1},
)

end_on_ellipse = Problem(
    name="end_on_ellipse",
    title="To the nearest point of an ellipse",
    model=plane,
    running_cost=(u1**2 + u2**2) / 2,
    terminal_constraints=(x1**2 / a**2 + x2**2 / b**2 - 1,),
)
end_on_line = Problem(
    name="end_on_line",
    title="To a line of the phase plane",
    model=body,
    running_cost=u1**2 / 2,
    terminal_constraints=(x2 - m * x1 - c,),
)
end_on_line_time = Problem(
    name="end_on_line_time",
    title="To a line of the phase plane in least time",
    model=body,
    running_cost=1,
    terminal_constraints=(x2 - m * x1 - c,),
    control_set="box",
)
end_weighed = Problem(
    name="end_weighed",
    title="An end that is weighed, perhaps negatively",
    model=FirstOrder(
        name="weighed", title="A body", states=STATES, controls=CONTROLS[:1], parameters=WEIGHTS, rates=body.rates
    ),
    running_cost=u1**2 / 2,
    terminal_cost=(k1 * x1**2 + k2 * x2**2) / 2,
    control_set="box",
)
end_of_one = Problem(
    name="end_of_one",
    title="One state, its end weighed, perhaps negatively",
    model=FirstOrder(
        name="one",
        title="A rate that is chosen",
        states=STATES[:1],
        controls=CONTROLS[:1],
        parameters=WEIGHTS[:1],
        rates={x1: u1},
    ),
    running_cost=u1**2 / 2,
    terminal_cost=k1 * x1**2 / 2,
    control_set="box",
)

PROBLEMS = (end_on_ellipse, end_on_line, end_on_line_time, end_weighed, end_of_one)
