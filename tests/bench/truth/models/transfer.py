"""Transfers with least energy about a centre of attraction, in Cartesian coordinates of the plane and of space."""

from sympy import sqrt

from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

PLACES = tuple(Variable(q, q, meaning=f"position along {q}", unit="1") for q in "xyz")
RATES = tuple(Variable(f"v_{q}", f"v_{q}", meaning=f"velocity along {q}") for q in "xyz")
THRUST = tuple(Variable(f"a_{q}", f"a_{q}", meaning=f"thrust along {q}") for q in "xyz")
MU = Variable("mu", r"\mu", meaning="gravitational parameter", default=1.0, positive=True)
(mu,) = symbols_of((MU,))


def _transfer(name: str, axes: int) -> Problem:
    places, velocities, thrust = (symbols_of(group[:axes]) for group in (PLACES, RATES, THRUST))
    distance = sqrt(sum(q**2 for q in places))
    rates = dict(zip(places, velocities, strict=True))
    rates |= {v: a - mu * q / distance**3 for q, v, a in zip(places, velocities, thrust, strict=True)}
    model = FirstOrder(
        name=f"{name}_motion",
        title="Motion about a centre of attraction",
        states=(*PLACES[:axes], *RATES[:axes]),
        controls=THRUST[:axes],
        parameters=(MU,),
        rates=rates,
    )
    energy = sum(a**2 for a in thrust) / 2
    return Problem(name=name, title="Least-energy transfer", model=model, running_cost=energy, control_set="ball")


PROBLEMS = (_transfer("transfer_plane", 2), _transfer("transfer_space", 3))
