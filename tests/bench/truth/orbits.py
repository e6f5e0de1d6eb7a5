"""Random instances about a centre of attraction: in polar coordinates with all kinds of ends and bounds, and others."""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import expm

from tests.bench.truth.case import Case

Rng = np.random.Generator
STATES = ("r", "r_dot", "theta", "theta_dot")
ON_REFERENCE = dict.fromkeys(STATES, "reference")
FULL = 1e3


def _start(rng: Rng, spread: float = 0.5) -> dict[str, float]:
    r = float(np.exp(rng.uniform(-spread, spread)))
    rates = rng.uniform(-0.3 * spread, 0.3 * spread), rng.uniform(1.0 - spread / 3.0, 1.0 + spread / 3.0) * r**-1.5
    return dict(zip(STATES, (r, float(rates[0]), float(rng.uniform(-1.0, 1.0)), float(rates[1])), strict=True))


def _circle(rng: Rng, radius: float, ahead: float) -> dict[str, float]:
    return dict(zip(STATES, (radius, 0.0, ahead, radius**-1.5), strict=True))


def given(rng: Rng, family: str, number: int) -> Case:
    """Final time and final state given: circles from half to twice the radius, up to three revolutions."""
    start, tf = _start(rng), float(rng.uniform(1.0, 18.0))
    radius = float(np.exp(rng.uniform(-0.6, 0.6)))
    model = str(rng.choice(["polar_orbit", "polar_orbit_timed"]))
    weights = {} if model == "polar_orbit" else {"c0": float(10 ** rng.uniform(-4, -2))}
    if rng.random() < 0.3:
        weights |= {"c1": float(rng.uniform(0.2, 5.0))}
    final = _circle(rng, radius, float(rng.uniform(-0.8, 0.8)) + tf * radius**-1.5)
    return Case(family, number, model, start, final, tf, parameters=weights)


def state_given(rng: Rng, family: str, number: int) -> Case:
    """Final state given, final time free and weighed."""
    weights = {"c0": float(10 ** rng.uniform(-3.5, -1))}
    final = _circle(rng, float(np.exp(rng.uniform(-0.4, 0.5))), float(rng.uniform(0.5, 9.0)))
    return Case(family, number, "polar_orbit_timed", _start(rng, 0.3), final, parameters=weights)


def time_given(rng: Rng, family: str, number: int) -> Case:
    """Final time given, a part of the final state or all of it free, weighed or not."""
    free = list(rng.permutation(STATES)[: rng.integers(1, 5)])
    final = {name: "reference" for name in STATES if name not in free}
    weights = {f"k{STATES.index(name) + 1}": float(10 ** rng.uniform(-2, 1.5)) for name in free if rng.random() < 0.7}
    t0 = float(rng.choice([0.0, 1.7]))
    return Case(family, number, "polar_orbit", _start(rng, 0.4), final, t0 + float(rng.uniform(1.0, 14.0)), t0, weights)


def rendezvous(rng: Rng, family: str, number: int) -> Case:
    """On the reference, final time free and weighed."""
    weights = {"c0": float(10 ** rng.uniform(-3.5, -1))}
    t0 = float(rng.choice([0.0, -2.3]))
    start = _start(rng, 0.35)
    start["theta"] += t0
    return Case(family, number, "polar_orbit_timed", start, dict(ON_REFERENCE), None, t0, weights)


def all_free(rng: Rng, family: str, number: int) -> Case:
    """Final time free and at least a part of the final state; both weighed."""
    weights = {"c0": float(10 ** rng.uniform(-3.5, -1.5))}
    weights |= {f"k{k}": float(10 ** rng.uniform(-1, 1)) for k in (1, 2, 4)}
    final = {"r": 1.0} if rng.random() < 0.3 else {}
    return Case(family, number, "polar_orbit_timed", _start(rng, 0.3), final, parameters=weights)


def in_kilometres(rng: Rng, family: str, number: int) -> Case:
    """The same in kilometres and seconds, near the geostationary orbit or a low one."""
    radius, rate = ((42164.17, 7.2921159e-5), (6778.14, 1.1313e-3))[int(rng.integers(2))]
    maker = (given, time_given, rendezvous, boxed)[int(rng.integers(4))]
    plain = maker(rng, family, number)
    weights = {"sigma": 1.0, "omega": 1.0, **plain.parameters}
    return Case(
        **{**vars(plain), "parameters": weights, "length": radius, "time": 1.0 / rate},
    )


def any_angle(rng: Rng, family: str, number: int) -> Case:
    """The final angle counts modulo a turn."""
    start, tf = _start(rng, 0.4), float(rng.uniform(2.0, 15.0))
    radius = float(np.exp(rng.uniform(-0.4, 0.4)))
    final = _circle(rng, radius, float(rng.uniform(-math.pi, math.pi)))
    final["theta"] += 2.0 * math.pi * round((tf * (1.0 + radius**-1.5) / 2.0 - final["theta"]) / (2.0 * math.pi))
    return Case(family, number, "polar_orbit", start, final, tf, free_angles=("theta",))


def _return(rng: Rng, family: str, number: int, model: str = "polar_orbit") -> tuple[Case, float]:
    """A return to the reference within a revolution or two, and the largest thrust it takes, to first order."""
    r = float(rng.uniform(0.85, 1.15))
    start = dict(zip(STATES, (r, float(rng.uniform(-0.1, 0.1)), float(rng.uniform(-0.3, 0.3)), 0.0), strict=True))
    start["theta_dot"] = float(rng.uniform(0.92, 1.08)) * r**-1.5
    tf = float(rng.uniform(3.0, 11.0))
    off = np.array([r - 1.0, start["r_dot"], start["theta"], start["theta_dot"] - 1.0])
    A = np.array([[0, 1, 0, 0], [3, 0, 0, 2], [0, 0, 0, 1], [0, -2, 0, 0]], dtype=float)
    B = np.array([[0, 0], [1, 0], [0, 0], [0, 1]], dtype=float)
    times = np.linspace(0.0, tf, 201)
    effects = np.array([expm(A * (tf - t)) @ B for t in times])
    gram = np.einsum("kim,kjm->ij", effects, effects) * tf / 200.0
    nu = np.linalg.solve(gram, -expm(A * tf) @ off)
    peak = float(np.linalg.norm(np.einsum("kim,i->km", effects, nu), axis=1).max())
    return Case(family, number, model, start, dict(ON_REFERENCE), tf), peak


def boxed(rng: Rng, family: str, number: int) -> Case:
    """Return within a box that binds for a part of the time."""
    case, peak = _return(rng, family, number)
    limits = peak * rng.uniform(0.5, 1.1, 2)
    return _with(case, bounds={f"u{k}": (-float(b), float(b)) for k, b in enumerate(limits, 1)})


def above_floor(rng: Rng, family: str, number: int) -> Case:
    """Return that would go lower than it may, by the linear motion that a return takes."""
    case, _ = _return(rng, family, number, "return_above")
    lowest = min(case.initial["r"], 1.0)
    return _with(case, parameters={"r_min": float(lowest - 10 ** rng.uniform(-2.5, -1.2))})


def lopsided(rng: Rng, family: str, number: int) -> Case:
    """Bounds that are not symmetric; some leave out zero by a little, some bind one control only."""
    case, peak = _return(rng, family, number)
    bounds = {}
    for name in ("u1", "u2")[: int(rng.integers(1, 3))]:
        low, high = -peak * rng.uniform(0.15, 1.2), peak * rng.uniform(0.15, 1.2)
        if rng.random() < 0.15:
            low = peak * 0.03
        bounds[name] = (float(low), float(high))
    return _with(case, bounds=bounds)


def one_sided(rng: Rng, family: str, number: int) -> Case:
    """Engines that push one way only, with or without a limit."""
    case, peak = _return(rng, family, number)
    name, other = ("u1", "u2") if rng.random() < 0.6 else ("u2", "u1")
    limit = FULL if rng.random() < 0.4 else float(peak * rng.uniform(0.8, 3.0))
    bounds = {name: (0.0, limit) if rng.random() < 0.5 else (-limit, 0.0)}
    if rng.random() < 0.3:
        bounds[other] = (-1.2 * peak, 1.2 * peak)
    return _with(case, bounds=bounds)


def tight(rng: Rng, family: str, number: int) -> Case:
    """Bounds so narrow that they bind from the start, nearly or fully forbid to arrive."""
    case, peak = _return(rng, family, number)
    fraction = float(rng.uniform(0.22, 0.6))
    return _with(case, bounds={f"u{k}": (-fraction * peak, fraction * peak) for k in (1, 2)})


def ball(rng: Rng, family: str, number: int) -> Case:
    """One steerable engine that is at its limit for a part of the time."""
    case, peak = _return(rng, family, number, "polar_orbit_ball")
    return _with(case, max_norm=float(peak * rng.uniform(0.5, 1.05)))


def tight_ball(rng: Rng, family: str, number: int) -> Case:
    """One steerable engine that can hardly do it."""
    case, peak = _return(rng, family, number, "polar_orbit_ball")
    return _with(case, max_norm=float(peak * rng.uniform(0.3, 0.65)))


def boxed_ends(rng: Rng, family: str, number: int) -> Case:
    """A box with the other kinds of ends."""
    maker = (state_given, time_given, rendezvous, all_free)[int(rng.integers(4))]
    case = maker(rng, family, number)
    limits = 10 ** rng.uniform(-1.3, 0.0, 2)
    return _with(case, bounds={f"u{k}": (-float(b), float(b)) for k, b in enumerate(limits, 1)})


def rewarded(rng: Rng, family: str, number: int) -> Case:
    """A negative terminal weight of the distance, within bounds: going far is rewarded.

    Rates are not: near the centre they have no bound.
    """
    tf, weights = float(rng.uniform(1.0, 6.0)), {"k1": -float(10 ** rng.uniform(-2.5, 0.0))}
    limits = 10 ** rng.uniform(-2.0, -0.7, 2)
    bounds = {f"u{k}": (-float(b), float(b)) for k, b in enumerate(limits, 1)}
    return Case(family, number, "polar_orbit", _start(rng, 0.2), {}, tf, parameters=weights, bounds=bounds)


def plane(rng: Rng, family: str, number: int) -> Case:
    """From a nearly circular orbit to another, in Cartesian coordinates of the plane: revolutions are free."""
    return _cartesian(rng, family, number, "transfer_plane", 0.0)


def space(rng: Rng, family: str, number: int) -> Case:
    """The same in space, with inclined orbits."""
    return _cartesian(rng, family, number, "transfer_space", 0.5)


def _cartesian(rng: Rng, family: str, number: int, model: str, tilt: float) -> Case:
    radius, axes = float(np.exp(rng.uniform(-0.4, 0.5))), "xyz" if tilt else "xy"
    first = _on_circle(1.0, float(rng.uniform(-math.pi, math.pi)), 0.0)
    last = _on_circle(radius, float(rng.uniform(-math.pi, math.pi)), float(rng.uniform(-tilt, tilt)))
    first[3:] *= rng.uniform(0.9, 1.1)
    names = [*axes, *(f"v_{q}" for q in axes)]
    kept = [i for i in range(6) if tilt or i % 3 < 2]
    initial, final = (dict(zip(names, map(float, row[kept]), strict=True)) for row in (first, last))
    return Case(family, number, model, initial, final, float(rng.uniform(2.0, 16.0)))


def _on_circle(radius: float, angle: float, tilt: float) -> np.ndarray:
    c, s, rate = math.cos(angle), math.sin(angle), radius**-0.5
    turn = np.array([[1, 0, 0], [0, math.cos(tilt), -math.sin(tilt)], [0, math.sin(tilt), math.cos(tilt)]])
    return np.concatenate([turn @ [radius * c, radius * s, 0.0], turn @ [-rate * s, rate * c, 0.0]])


def _with(case: Case, **changes: object) -> Case:
    return Case(**{**vars(case), **changes})
