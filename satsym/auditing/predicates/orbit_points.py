"""What the Jacobian at a point of an orbit can tell, and what it cannot: exactly, and on orbits."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from satsym import instance
from satsym.analysis.orbits.elements import Elements, elements
from satsym.analysis.orbits.kepler import propagate
from satsym.arrays import Array
from satsym.auditing.predicates import Finding, Question, predicate
from satsym.auditing.predicates.programs import function, walked
from satsym.instance import Instance
from satsym.status import BadInput
from satsym.wording import shown

_SEED = 47
_TRIES = 20
_TURNS = 50
_PLACES = 400
_IMPROVED = 6
_KICK = 1e-6
_SAME = 1e-9


def _orbit(name: str) -> tuple[Instance, Elements]:
    case = instance.load(name)
    if not case.model.spec.keplerian:
        raise BadInput(f"{shown(name)} is no motion about a centre; name an instance such as itb-earth")
    state = case.model.inertial_state(case.t0, case.initial, case.parameters)
    return case, elements(state[:3], state[3:6], state[6])


def _roots(case: Instance) -> NDArray[np.complex128]:
    """Eigenvalues of the generated Jacobian at the start of an instance."""
    spec = case.model.spec
    matrix = case.model.jacobian_x(case.t0, case.initial, (0.0,) * len(spec.controls), case.parameters)
    return np.linalg.eigvals(np.array(matrix).reshape(len(spec.states), -1)).astype(complex)


@predicate
def has_equilibrium(model: str) -> Finding:
    """Whether a body that a centre attracts has a point where the rates vanish: from the derived acceleration."""
    from satsym.symbolic.lookup.library import derivation

    pull = derivation(model).equation("no_equilibrium.acceleration").rhs
    return Finding(
        None if pull.is_positive is None else not pull.is_positive,
        f"the acceleration is {pull} at every distance" + (", and never zero" if pull.is_positive else ""),
        {"acceleration": str(pull)},
        f"satsym derive {model}",
        remark="so no point of an orbit is an equilibrium, and what is said of equilibria does not apply to it",
    )


@predicate
def taken_at_equilibrium(row: Question, program: str, rates: str) -> Finding:
    """Whether the point at which the program takes its Jacobian is an equilibrium of its own rates."""
    found = walked(row, program)
    moved = np.array(function(found, rates)(0.0, np.asarray(found.values["y0"])))
    speed, pull = float(np.linalg.norm(moved[:3])), float(np.linalg.norm(moved[3:]))
    return Finding(
        max(speed, pull) == 0.0,
        f"there it moves at {speed:.4g} m/s, and its acceleration is {pull:.4g} m/s^2",
        {"speed, m/s": speed, "acceleration, m/s^2": pull},
        remark="the Jacobian may be taken at any point, but its eigenvalues decide about stability at equilibria only",
    )


@predicate
def rule_tells_apart(instances: tuple[str, ...], rule: str) -> Finding:
    """Whether a rule about real parts calls bound orbits stable, and others unstable: at the start of instances.

    What the eigenvalues depend on is told by the derived characteristic polynomial.

    Parameters
    ----------
    rule
        ``negative``: stable if all real parts are negative; ``not positive``: if none is positive.
    """
    if rule not in ("negative", "not positive"):
        raise BadInput(f"rule_tells_apart: no rule {shown(rule)}; write negative, or not positive")
    from satsym.symbolic.lookup.library import derivation

    right, parts, said, asked = 0, {}, [], set()
    for name in instances:
        case, orbit = _orbit(name)
        asked.add(case.model.spec.name)
        largest = float(_roots(case).real.max())
        stable = largest < 0.0 if rule == "negative" else largest <= 0.0
        right += stable == orbit.bound
        said.append(f"{name} ({orbit.conic.value}) {'stable' if stable else 'unstable'}")
        parts[f"largest real part, {name}, 1/s"] = largest
    polynomials = [
        derivation(model).equation("point_spectrum.characteristic_polynomial").rhs for model in sorted(asked)
    ]
    used = sorted({symbol.name for polynomial in polynomials for symbol in polynomial.free_symbols})
    return Finding(
        right == len(instances),
        f"it calls {', '.join(said)}",
        {**parts, "in the characteristic polynomial": ", ".join(used)},
        f"satsym analyse {instances[0]}",
        remark="the characteristic polynomial has the distance in it and no velocity, so that circles, ellipses and "
        "hyperbolas through one point have the same eigenvalues"
        if not any(name.startswith("v_") for name in used)
        else "",
    )


@predicate
def rule_ever_applies(model: str) -> Finding:
    """Whether all real parts being negative, of which stability is to follow, ever happens: by the trace, their sum.

    Where it never does, the rule calls nothing stable, so that it is not false; but it shows nothing either.
    """
    from satsym.symbolic.lookup.library import derivation

    entries = {e.name: e.rhs for e in derivation(model).step("linearisation").equations}
    names = [v.symbol for v in derivation(model).model.states]
    trace = sum(entries[f"A_{name}_{name}"] for name in names).together().simplify()
    never = bool(trace.is_zero)
    return Finding(
        True if never else None,
        f"the eigenvalues add up to the trace of the Jacobian, which is {trace} at every point",
        {"trace": str(trace)},
        f"satsym derive {model}",
        sound=not never,
        remark="so they are never all negative, and the rule calls no orbit stable" if never else "",
    )


@predicate
def leaves_its_orbit(name: str) -> Finding:
    """Whether neighbours of an orbit leave it, as a positive eigenvalue at its start would have it.

    Neighbours are followed in closed form. What is measured is how far they are from the orbit as a path, and how far
    from the body on it, which runs ahead or behind as their periods differ.
    """
    case, orbit = _orbit(name)
    if orbit.period is None:
        raise BadInput(f"leaves_its_orbit: {name} is on no closed orbit")
    rng = np.random.default_rng(_SEED)
    start = np.concatenate([orbit.position, orbit.velocity])
    length, speed = float(np.linalg.norm(orbit.position)), float(np.linalg.norm(orbit.velocity))
    scale = np.array([length] * 3 + [speed] * 3)
    once = np.linspace(0.0, orbit.period, _PLACES, endpoint=False)
    away: dict[int, float] = {1: 0.0, _TURNS: 0.0}
    apart: dict[int, float] = {1: 0.0, _TURNS: 0.0}
    for _ in range(_TRIES // 2):
        shift = rng.normal(size=6)
        moved = start + _KICK * scale * shift / np.linalg.norm(shift)
        for turn in away:
            t = orbit.period * (turn - 1.0 + np.linspace(0.0, 1.0, 40, endpoint=False))
            place = _positions(moved, orbit.mu, t)
            away[turn] = max(away[turn], _distance(place, start, orbit.mu, once) / length / _KICK)
            own = _positions(start, orbit.mu, t)
            apart[turn] = max(apart[turn], float(np.linalg.norm(place - own, axis=0).max()) / length / _KICK)
    predicted = float(_roots(case).real.max()) * orbit.period
    grown = away[_TURNS] / away[1]
    return Finding(
        grown > 2.0,
        f"after {_TURNS} revolutions neighbours are {away[_TURNS]:.2f} times the first deviation from the orbit, "
        f"{away[1]:.2f} times in the first",
        {
            "growth of the distance from the orbit": grown,
            f"distance along the orbit in revolution {_TURNS}, first deviations": apart[_TURNS],
            "growth in one revolution by the eigenvalue, exponent": predicted,
        },
        f"satsym analyse {name}",
        remark=f"the eigenvalue would have deviations grow by e^{predicted:.2f} in each revolution; they run ahead or "
        f"behind along the orbit, in proportion to time, and that is all: it is stable as an orbit",
    )


def _positions(state: Array, mu: float, t: Array) -> Array:
    position, _ = propagate(state[:3, None], state[3:, None], mu, t)
    return np.asarray(position)


def _distance(places: Array, start: Array, mu: float, t: Array) -> float:
    """The largest distance of some places from the path of a start, near which it is sampled at times t.

    From the nearest sample on, the time is improved until the way to the path is normal to it.
    """
    path = _positions(start, mu, t)
    time = t[np.argmin(np.linalg.norm(path[:, None, :] - places[:, :, None], axis=0), axis=1)]
    for _ in range(_IMPROVED):
        position, velocity = map(np.asarray, propagate(start[:3, None], start[3:, None], mu, time))
        time = time + ((places - position) * velocity).sum(axis=0) / (velocity**2).sum(axis=0)
    return float(np.linalg.norm(places - _positions(start, mu, time), axis=0).max())


@predicate
def goes_round(name: str) -> Finding:
    """Whether a body goes round the centre and comes back to where it began: by its angle, over one revolution."""
    _, orbit = _orbit(name)
    if orbit.period is None:
        return Finding(False, f"it is on a {orbit.conic.value}, which never comes back", {})
    start = np.concatenate([orbit.position, orbit.velocity])
    places = _positions(start, orbit.mu, np.linspace(0.0, orbit.period, _PLACES))
    angle = np.unwrap(np.arctan2(places[1], places[0]))
    back = float(np.linalg.norm(places[:, -1] - places[:, 0]) / np.linalg.norm(places[:, 0]))
    turned = float(abs(angle[-1] - angle[0]) / (2.0 * math.pi))
    return Finding(
        bool((np.diff(angle) > 0.0).all()) and back < _SAME and abs(turned - 1.0) < _SAME,
        f"it turns once and comes back, on an {orbit.conic.value} of eccentricity {orbit.eccentricity:.4f}",
        {"turns in a period": turned, "eccentricity": float(orbit.eccentricity)},
        f"satsym analyse {name}",
    )


@predicate
def start_decides_kind(instances: tuple[str, ...]) -> Finding:
    """Whether orbits that begin at one place with different velocities are of different kinds."""
    orbits = {name: _orbit(name)[1] for name in instances}
    together = len({tuple(np.round(orbit.position, 3)) for orbit in orbits.values()}) == 1
    kinds = {orbit.conic.value for orbit in orbits.values()}
    return Finding(
        together and len(kinds) > 1,
        f"from one place there is {', '.join(f'a {orbit.conic.value} ({name})' for name, orbit in orbits.items())}",
        {f"eccentricity, {name}": float(orbit.eccentricity) for name, orbit in orbits.items()},
    )
