"""Costs that fall away from the origin: a minimum until the conjugate time, none at all after it."""

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = tuple(Variable(f"x{k}", f"x_{k}", meaning=f"state {k}") for k in (1, 2))
CONTROLS = tuple(Variable(f"u{k}", f"u_{k}", meaning=f"rate of state {k}") for k in (1, 2))
PARAMETERS = tuple(Variable(f"a{k}", f"a_{k}", meaning=f"reward of state {k}", default=1.0) for k in (1, 2))
states, controls, rewards = symbols_of(STATES), symbols_of(CONTROLS), symbols_of(PARAMETERS)


def _axes(count: int) -> Problem:
    parts = list(zip(states, controls, rewards, strict=True))[:count]
    model = FirstOrder(
        name=f"axes_{count}",
        title="Rates that are chosen",
        states=STATES[:count],
        controls=CONTROLS[:count],
        parameters=PARAMETERS[:count],
        rates={x: u for x, u, _ in parts},
    )
    cost = sum(u**2 - a * x**2 for x, u, a in parts) / 2
    return Problem(name=f"conjugate_{count}", title="A reward for distance", model=model, running_cost=cost)


PROBLEMS = (_axes(1), _axes(2))
