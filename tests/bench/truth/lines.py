"""Random instances of linear motions, of hills of cost, of conjugate times and of ends that are constrained."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import linprog

from tests.bench.truth import closed
from tests.bench.truth.case import Case
from tests.bench.truth.linear import linear

Rng = np.random.Generator
LINE = ("q", "q_dot")


def _numbers(rng: Rng, names: tuple[str, ...], size: float) -> dict[str, float]:
    return {name: float(rng.uniform(-size, size)) for name in names}


def _bounds(rng: Rng, kind: str) -> tuple[float, float]:
    low, high = -float(10 ** rng.uniform(-0.5, 0.5)), float(10 ** rng.uniform(-0.5, 0.5))
    return (-high, high) if kind == "even" else (low, high)


def _bodies(rng: Rng, sides: str = "uneven") -> tuple[dict[str, float], dict[str, float], tuple[float, float]]:
    initial, final = _numbers(rng, LINE, 3.0), _numbers(rng, LINE, 2.0)
    if rng.random() < 0.25:
        final["q_dot"] = 0.0
    return initial, final, _bounds(rng, sides)


def line_kept(rng: Rng, family: str, number: int) -> Case:
    """Least energy of a body on a line within one to three limits of place and velocity that it would exceed."""
    tf = float(rng.uniform(1.0, 3.0))
    initial, final = _numbers(rng, LINE, 1.5), _numbers(rng, LINE, 1.5)
    ends = np.array([list(initial.values()), list(final.values())])
    share, gap = np.linspace(0.0, 1.0, 401), ends[1] - ends[0] - tf * np.array([ends[0, 1], 0.0])
    begin, slope = np.linalg.solve([[tf**2 / 2.0, tf**3 / 6.0], [tf, tf**2 / 2.0]], gap)
    times = share * tf
    place = ends[0, 0] + ends[0, 1] * times + begin * times**2 / 2.0 + slope * times**3 / 6.0
    speed = ends[0, 1] + begin * times + slope * times**2 / 2.0
    limits = {}
    for name, row, column in (("ceiling", place, 0), ("floor", -place, 0), ("fastest", speed, 1)):
        least = float((ends[:, column] * (-1.0 if name == "floor" else 1.0)).max())
        if name == "fastest":
            least = max(least, 1.05 * (ends[1, 0] - ends[0, 0]) / tf)
        room = float(row.max()) - least
        within = least + room * float(rng.uniform(0.1, 0.9)) if room > 0.0 and rng.random() < 0.7 else row.max() + 9.0
        limits[name] = float(-within if name == "floor" else within)
    return Case(family, number, "kept_line", initial, final, tf, parameters=limits)


def line_time(rng: Rng, family: str, number: int) -> Case:
    """Least time of a body on a line to a state that is mostly no rest, by bounds that are mostly not symmetric."""
    initial, final, bounds = _bodies(rng, "even" if rng.random() < 0.3 else "uneven")
    return Case(family, number, "double_integrator_time", initial, final, bounds={"u1": bounds})


def line_time_one_sided(rng: Rng, family: str, number: int) -> Case:
    """The same with a thrust that pushes one way only: often nothing arrives."""
    initial, final, _ = _bodies(rng)
    low = 0.0 if rng.random() < 0.4 else float(rng.uniform(0.05, 0.5))
    high = low + float(10 ** rng.uniform(-0.5, 0.5))
    if rng.random() < 0.5:
        # A state that can be reached, by two arcs of random lengths.
        first, last = rng.uniform(0.2, 2.0, 2)
        pair = (low, high) if rng.random() < 0.5 else (high, low)
        q, v = initial["q"], initial["q_dot"]
        for u, t in zip(pair, (first, last), strict=True):
            q, v = q + v * t + u * t * t / 2.0, v + u * t
        final = {"q": float(q), "q_dot": float(v)}
    return Case(family, number, "double_integrator_time", initial, final, bounds={"u1": (low, high)})


def _lengthened(rng: Rng, family: str, number: int, factors: tuple[float, ...], sides: str) -> Case:
    case = Case(family, number, "double_integrator_time", *_bodies(rng, sides)[:2], bounds={"u1": _bounds(rng, sides)})
    least = closed.line_time(case).cost
    assert least is not None
    return Case(**{**vars(case), "tf": least * float(rng.choice(factors))})


def line_energy(rng: Rng, family: str, number: int) -> Case:
    """Least energy in a given time, from too little by a hair to plenty."""
    case = _lengthened(rng, family, number, (0.9, 0.99, 0.999, 1.001, 1.01, 1.05, 1.2, 1.5, 3.0), "uneven")
    return Case(**{**vars(case), "model": "double_integrator_energy"})


def line_fuel(rng: Rng, family: str, number: int) -> Case:
    """Least fuel in a given time, from too little by a hair to plenty."""
    sides = "even" if rng.random() < 0.4 else "uneven"
    case = _lengthened(rng, family, number, (0.97, 0.999, 1.003, 1.05, 1.3, 2.0, 4.0), sides)
    return Case(**{**vars(case), "model": "double_integrator_fuel"})


def line_fuel_free(rng: Rng, family: str, number: int) -> Case:
    """Least weighted time and fuel."""
    initial, final, bounds = _bodies(rng)
    weight = {"weight_time": float(10 ** rng.uniform(-1.5, 1.0))}
    return Case(family, number, "double_integrator_fuel", initial, final, parameters=weight, bounds={"u1": bounds})


def _of_one_control(rng: Rng, family: str, number: int, model: str, names: tuple[str, ...], size: float) -> Case:
    initial, final = _numbers(rng, names, size), _numbers(rng, names, size / 2.0)
    if rng.random() < 0.5:
        final = dict.fromkeys(names, 0.0)
    parameters = {"omega": float(rng.uniform(0.6, 1.6))} if model.startswith("oscillator") else {}
    return Case(family, number, model, initial, final, parameters=parameters, bounds={"u1": _bounds(rng, "uneven")})


def chain_time(rng: Rng, family: str, number: int) -> Case:
    """Least time of three integrators."""
    return _of_one_control(rng, family, number, "chain_time", ("x1", "x2", "x3"), 1.0)


def _timed(rng: Rng, case: Case) -> Case:
    """Bounds that bind more or less in the given time, seen from the least energy without any."""
    tf = float(rng.uniform(1.5, 8.0))
    plain = Case(**{**vars(case), "tf": tf, "bounds": {}})
    motion = linear(plain)
    effects, _ = motion.effect(tf, 400)
    gram = np.einsum("kim,kjm->ij", effects, effects) * tf / 400.0
    peak = float(np.abs(effects[:, :, 0] @ np.linalg.solve(gram, motion.gap(tf))).max())
    least, most = (0.8, 1.8) if case.model.startswith("oscillator") else (0.35, 1.2)
    low, high = peak * rng.uniform(least, most, 2)
    return Case(**{**vars(plain), "bounds": {"u1": (-float(low), float(high))}})


def chain_energy(rng: Rng, family: str, number: int) -> Case:
    """Least energy of three integrators."""
    return _timed(rng, _of_one_control(rng, family, number, "chain_energy", ("x1", "x2", "x3"), 1.0))


def chain_fuel(rng: Rng, family: str, number: int) -> Case:
    """Least fuel of three integrators."""
    return _timed(rng, _of_one_control(rng, family, number, "chain_fuel", ("x1", "x2", "x3"), 1.0))


def spring_time(rng: Rng, family: str, number: int) -> Case:
    """Least time of an oscillator, with up to some dozen switches."""
    return _of_one_control(rng, family, number, "oscillator_time", ("x1", "x2"), 4.0)


def spring_energy(rng: Rng, family: str, number: int) -> Case:
    """Least energy of an oscillator."""
    return _timed(rng, _of_one_control(rng, family, number, "oscillator_energy", ("x1", "x2"), 2.0))


def spring_fuel(rng: Rng, family: str, number: int) -> Case:
    """Least fuel of an oscillator."""
    return _timed(rng, _of_one_control(rng, family, number, "oscillator_fuel", ("x1", "x2"), 2.0))


NEAR = ("x", "x_dot", "y", "y_dot")


def rendezvous_energy(rng: Rng, family: str, number: int) -> Case:
    """Rendezvous near a circular orbit without bounds; sometimes a part of the end is free."""
    final = dict.fromkeys(NEAR, 0.0)
    if rng.random() < 0.3:
        del final[str(rng.choice(NEAR))]
    return Case(family, number, "rendezvous_box", _numbers(rng, NEAR, 1.0), final, float(rng.uniform(1.0, 10.0)))


def rendezvous_box(rng: Rng, family: str, number: int) -> Case:
    """Within a box scaled to what is needed at least: forbidden by a hair, allowed by a hair, ample."""
    case = rendezvous_energy(rng, family, number)
    sides = 10 ** rng.uniform(-0.4, 0.4, 4)
    if rng.random() < 0.15:
        sides[int(rng.integers(4))] = 0.0
    case = Case(**{**vars(case), "bounds": {"u1": (-sides[0], sides[1]), "u2": (-sides[2], sides[3])}})
    scale = _least_scale(case) * float(rng.choice([0.9, 0.99, 1.01, 1.05, 1.2, 1.6, 2.5]))
    bounds = {name: (float(a * scale), float(b * scale)) for name, (a, b) in case.bounds.items()}
    return Case(**{**vars(case), "bounds": bounds})


def rendezvous_ball(rng: Rng, family: str, number: int) -> Case:
    """With one steerable engine, seen from the box that just does it."""
    case = rendezvous_energy(rng, family, number)
    box = Case(**{**vars(case), "bounds": {"u1": (-1.0, 1.0), "u2": (-1.0, 1.0)}})
    radius = _least_scale(box) * float(rng.uniform(0.95, 2.2))
    return Case(**{**vars(case), "model": "rendezvous_ball", "max_norm": radius})


def _least_scale(case: Case) -> float:
    """By how much bounds must be multiplied at least so that a control arrives (steps of equal length)."""
    assert case.tf is not None
    motion = linear(case)
    steps = 100
    effects = motion.steps(np.linspace(0.0, case.tf - case.t0, steps + 1))
    rows, m = len(motion.C), motion.B.shape[1]
    flat = effects.reshape(rows, steps * m)
    low, high = np.tile(motion.low, steps), np.tile(motion.high, steps)
    one = np.eye(steps * m)
    found = linprog(
        np.append(np.zeros(steps * m), 1.0),
        A_eq=np.hstack([flat, np.zeros((rows, 1))]),
        b_eq=motion.gap(case.tf - case.t0),
        A_ub=np.vstack([np.hstack([one, -high[:, None]]), np.hstack([-one, low[:, None]])]),
        b_ub=np.zeros(2 * steps * m),
        bounds=[(None, None)] * (steps * m) + [(0.0, None)],
        method="highs",
    )
    return float(found.fun) if found.status == 0 else 1.0


def hill_steered(rng: Rng, family: str, number: int) -> Case:
    """Across a hill of cost that stands in the way, exactly or nearly; the velocity is chosen."""
    return _over_a_hill(rng, family, number, "bump_steered", ())


def hill_pushed(rng: Rng, family: str, number: int) -> Case:
    """The same where the acceleration is chosen."""
    return _over_a_hill(rng, family, number, "bump_pushed", ("v_x", "v_y"))


def _over_a_hill(rng: Rng, family: str, number: int, model: str, rates: tuple[str, ...]) -> Case:
    aside = 0.0 if rng.random() < 0.6 else float(rng.uniform(-0.2, 0.2))
    initial = {"x": -1.0, "y": aside, **dict.fromkeys(rates, 0.0)}
    final = {"x": 1.0, "y": -aside if rng.random() < 0.5 else aside, **dict.fromkeys(rates, 0.0)}
    hill = {"height": float(10 ** rng.uniform(-0.7, 0.9)), "width": float(rng.uniform(0.15, 0.6))}
    return Case(family, number, model, initial, final, float(rng.uniform(1.0, 4.0)), parameters=hill)


def conjugate_one(rng: Rng, family: str, number: int) -> Case:
    """One axis, from half the conjugate time to three times as long."""
    return _conjugate(rng, family, number, 1)


def conjugate_two(rng: Rng, family: str, number: int) -> Case:
    """Two axes with conjugate times of their own."""
    return _conjugate(rng, family, number, 2)


def _conjugate(rng: Rng, family: str, number: int, count: int) -> Case:
    names = ("x1", "x2")[:count]
    rewards = {f"a{k}": float(10 ** rng.uniform(-0.3, 0.3)) for k in range(1, count + 1)}
    final = {name: float(rng.uniform(-1.0, 1.0)) for name in names if rng.random() < 0.75}
    initial = _numbers(rng, names, 1.0)
    if rng.random() < 0.15:
        initial, final = dict.fromkeys(names, 0.0), dict.fromkeys(names, 0.0)
    limit = min(
        math.pi / math.sqrt(a) / (1.0 if name in final else 2.0)
        for name, a in zip(names, rewards.values(), strict=True)
    )
    fraction = float(rng.choice([0.5, 0.8, 0.95, 0.995, 1.005, 1.05, 1.3, 2.2, 3.0]))
    return Case(family, number, f"conjugate_{count}", initial, final, limit * fraction, parameters=rewards)


def ellipse(rng: Rng, family: str, number: int) -> Case:
    """To the nearest point of an ellipse, from inside or outside, sometimes from its axis or centre."""
    axes = {"a": float(rng.uniform(0.5, 3.0)), "b": float(rng.uniform(0.5, 3.0))}
    initial = _numbers(rng, ("x1", "x2"), 2.0)
    if rng.random() < 0.3:
        initial[str(rng.choice(["x1", "x2"]))] = 0.0
    return Case(family, number, "end_on_ellipse", initial, {}, float(rng.uniform(0.5, 4.0)), parameters=axes)


def line_end(rng: Rng, family: str, number: int) -> Case:
    """To a line of the phase plane, with least energy."""
    line = {"m": float(rng.uniform(-2.0, 2.0)), "c": float(rng.uniform(-1.0, 1.0))}
    initial = _numbers(rng, ("x1", "x2"), 2.0)
    return Case(family, number, "end_on_line", initial, {}, float(rng.uniform(0.5, 4.0)), parameters=line)


def line_end_time(rng: Rng, family: str, number: int) -> Case:
    """To a line of the phase plane in least time."""
    line = {"m": float(rng.uniform(-2.0, 1.0)), "c": float(rng.uniform(-1.0, 1.0))}
    initial = _numbers(rng, ("x1", "x2"), 2.0)
    bounds = {"u1": _bounds(rng, "uneven")}
    return Case(family, number, "end_on_line_time", initial, {}, None, parameters=line, bounds=bounds)


def weighed(rng: Rng, family: str, number: int) -> Case:
    """A weighed end, one of the weights often negative: with or without a minimum."""
    weights = {f"k{k}": float(rng.choice([-1.0, 1.0]) * 10 ** rng.uniform(-1.5, 0.7)) for k in (1, 2)}
    initial = _numbers(rng, ("x1", "x2"), 2.0)
    return Case(family, number, "end_weighed", initial, {}, float(rng.uniform(0.3, 2.5)), parameters=weights)


def weighed_within(rng: Rng, family: str, number: int) -> Case:
    """The same within bounds, where there is always a minimum, often at either end."""
    case = weighed(rng, family, number)
    return Case(**{**vars(case), "bounds": {"u1": _bounds(rng, "even" if rng.random() < 0.4 else "uneven")}})


def one_within(rng: Rng, family: str, number: int) -> Case:
    """One state with a weighed end, within bounds; sometimes from the top of the cost."""
    initial = {"x1": 0.0 if rng.random() < 0.2 else float(rng.uniform(-1.0, 1.0))}
    weights = {"k1": float(-(10 ** rng.uniform(-1.0, 1.0)))}
    bounds = {"u1": _bounds(rng, "even" if rng.random() < 0.4 else "uneven")}
    return Case(
        family, number, "end_of_one", initial, {}, float(rng.uniform(0.3, 3.0)), parameters=weights, bounds=bounds
    )
