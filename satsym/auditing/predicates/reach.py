"""Whether a satellite can be steered back at all with thrusts that push one way only: a proof by what it conserves.

Along any motion the rate of the angular momentum h is r u2, and that of the energy E is r_dot u1 + r theta_dot u2.
Both are checked here against the model's own invariants and equations before they are used.
"""

from __future__ import annotations

import numpy as np

from satsym.auditing.predicates import Finding, predicate
from satsym.auditing.predicates.motion import loaded, reference
from satsym.instance import Instance

_POINTS = 20
_STEP = 1e-6
_EQUAL = 1e-12


@predicate
def can_return(instance: str) -> Finding:
    """Whether controls within their bounds can bring the instance to its reference orbit; ``None`` if undecided.

    The proof that they cannot has three steps. If neither thrust can be negative, h never falls; where it is that of
    the reference at the start, u2 must be zero all the way. E then changes at the rate r_dot u1, so it can fall only
    where r_dot is negative. But with h as it is, r_dot^2 = 2 E + 2 mu/r - (h/r)^2 is positive from the start
    outwards as long as E is not negative; so a motion that begins outwards with E >= 0 never turns, and E never
    falls to the negative value on the reference.
    """
    case = loaded(instance)
    names = case.model.spec.state_names
    start = np.array(case.initial)
    energy, momentum = _invariants(case, start)
    energy_on, momentum_on = _invariants(case, reference(case, case.t0))
    rates = _rate_errors(case)
    values = dict(zip((v.symbol for v in case.model.spec.parameters), case.parameters, strict=True))
    mu, r = values["sigma"] ** 3 * values["omega"] ** 2, float(start[names.index("r")])
    one_way = all(low >= 0.0 for low in case.lower)
    # the smallest value of 2 mu/r - (h/r)^2 beyond r is not negative once 2 mu r >= h^2
    outwards = float(start[names.index("r_dot")]) > 0.0 and 2.0 * mu * r >= momentum**2
    impossible = (
        rates < 1e-6 and one_way and abs(momentum - momentum_on) < _EQUAL and energy >= 0.0 > energy_on and outwards
    )
    return Finding(
        False if impossible else None,
        f"the angular momentum {momentum:g} is that of the orbit and cannot fall, so u2 = 0; the energy {energy:g} "
        f"should fall to {energy_on:g}, but does not while the satellite moves outwards, and it never turns"
        if impossible
        else "undecided by conserved quantities",
        {
            "energy at the start": energy,
            "energy on the reference": energy_on,
            "angular momentum at the start": momentum,
            "angular momentum on the reference": momentum_on,
            "largest error of dE/dt and dh/dt": rates,
        },
        f"satsym simulate {instance}",
    )


def _invariants(case: Instance, x: np.ndarray) -> tuple[float, float]:
    """Energy and angular momentum."""
    names = [v.symbol for v in case.model.spec.invariants]
    values = case.model.invariants(case.t0, tuple(x), case.parameters)
    return float(values[names.index("energy")]), float(values[names.index("angular_momentum")])


def _rate_errors(case: Instance) -> float:
    """How far dE/dt = r_dot u1 + r theta_dot u2 and dh/dt = r u2 are off, by differences along the equations."""
    rng, worst = np.random.default_rng(1), 0.0
    for _ in range(_POINTS):
        x, u = rng.uniform(0.5, 2.0, 4), rng.uniform(-1.0, 1.0, 2)
        flow = np.array(case.model.dynamics(case.t0, tuple(x), tuple(u), case.parameters))
        ahead, behind = (_invariants(case, x + sign * _STEP * flow) for sign in (1.0, -1.0))
        found = [(a - b) / (2.0 * _STEP) for a, b in zip(ahead, behind, strict=True)]
        said = (x[1] * u[0] + x[0] * x[3] * u[1], x[0] * u[1])
        worst = max(worst, *(abs(f - s) for f, s in zip(found, said, strict=True)))
    return worst
