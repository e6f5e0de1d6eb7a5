"""A body on a line that keeps below a ceiling, above a floor and to a speed: least energy."""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("q", "q", meaning="place"), Variable("q_dot", "v", meaning="velocity"))
CONTROLS = (Variable("u1", "u_1", meaning="acceleration"),)
LIMITS = (
    Variable("ceiling", "c", meaning="largest place"),
    Variable("floor", "f", meaning="smallest place"),
    Variable("fastest", "w", meaning="largest velocity"),
)
q, v = symbols_of(STATES)
(u1,) = symbols_of(CONTROLS)
ceiling, floor, fastest = symbols_of(LIMITS)

line = FirstOrder(
    name="line_kept",
    title="A body on a line",
    states=STATES,
    controls=CONTROLS,
    parameters=LIMITS,
    rates={q: v, v: u1},
)

PROBLEMS = (
    Problem(
        name="kept_line",
        title="Least energy within limits",
        model=line,
        running_cost=u1**2 / 2,
        path_constraints={"above": q - ceiling, "below": floor - q, "fast": v - fastest},
    ),
)
