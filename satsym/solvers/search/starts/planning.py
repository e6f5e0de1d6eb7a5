"""Starts of nonlinear programmes: a short list of motions that is fixed for an instance.

They are the straight line to the final state, controls near a bound if no final state is given, uncontrolled motions
from both ends, revolutions about the origin, and straight lines with random waves; free durations are tried with
several multiples of their initial guess.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.search.controls import Controls
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import flow, followed, resting, wanted
from satsym.solvers.search.starts import ends, revolutions, sampling
from satsym.solvers.search.transcription import Places

WITHIN = 1e2
"""Largest magnitude of a state in a start, as a multiple of its scale."""

WAVES = 3
"""Number of harmonic waves that random starts are made of."""

DRAWS, BENT = 40, (0.0, 0.3, 1.0, 0.3)
"""Number of starts with random values of free initial and final states, and amplitudes of waves on their paths."""

MORE, WIDER, LASTING = 24, (0.3, 1.0, 3.0), (2.0, 4.0, 1.0)
"""Number of further starts if the first ones lead to several costs or none, amplitudes of their waves, and their
durations relative to the initial guess. If the duration is free, the largest amplitudes come first, because detours
take time."""

LOOKS = 5
"""Number of random points at which it is tested whether only time has a cost."""

LOOSENED = 20
"""Number of starts that ignore the bounds of controls at first."""

NEXT_TO_BOUND = 0.96
"""Position of controls near their bounds, relative to half their ranges."""

LENGTHS = (0.25, 4.0, 0.06)
"""Lengths of one phase between waypoints that are tried, relative to the other phases."""

TURNS = (0, -1, 1, 2, 3)
"""Numbers of revolutions that are tried if the duration is free; -1 is one turn in the opposite direction."""

SAMPLED = sum(count for count, _ in sampling.GROUPS)
"""Number of starts that are random motions."""

DURATIONS = (4.0, 0.25, 16.0, 2.0**-4, 2.0**-6)
"""Durations, relative to the initial guess, that are fixed at first."""


@dataclass(frozen=True)
class Plan:
    """Description of a start of a nonlinear programme.

    Attributes
    ----------
    scale
        The duration, relative to its initial guess.
    timed
        Whether the motion is first solved with this duration fixed, so that each local minimum over it is found.
    noise, seed
        Amplitude of the waves on states and controls, relative to their scales, and the seed of the random waves.
    arriving
        Whether a motion to the final state is found first, at any cost, from one that obeys its equations.
    loosened
        Whether the motion without bounds of controls is solved first, as weak controls need a swing to arrive in time.
    turns
        Number of revolutions about the origin; ``None`` for a straight line.
    coasting
        Whether the start blends the uncontrolled motions from both ends.
    turned
        Value of the controls that are angles, as a fraction of half a turn; ``None`` for the default.
    drawn
        Seed of the random values of free initial and final states; 0 if they are not random.
    guessed
        Whether states and controls are taken from the initial guess of the instance.
    at_bound
        Constant position of the controls in their ranges, between -1 and 1; ``None`` for the default.
    parts
        Fractions of the duration between waypoints; empty if they are equal.
    sampled
        Number of the random motion that the start is, of those that end well or are cheap; 0 if it is none.
    """

    scale: float = 1.0
    timed: bool = False
    noise: float = 0.0
    seed: int = 0
    arriving: bool = False
    loosened: bool = False
    turns: int | None = None
    coasting: bool = False
    turned: float | None = None
    drawn: int = 0
    guessed: bool = False
    at_bound: float | None = None
    parts: tuple[float, ...] = ()
    sampled: int = 0

    @property
    def kind(self) -> tuple[bool, ...]:
        """Return what the start has in common with others, which fail for the same reasons."""
        return self.timed, self.noise > 0.0, self.arriving, self.turns is not None, self.drawn > 0, self.sampled > 0


def plans(instance: Instance, controls: Controls, duration: float) -> list[Plan]:
    """Return the list of starts of an instance, in the order in which they are tried."""
    given = instance.tf is not None
    if given:
        drawn = [(0.1, 1), (0.3, 2), (0.3, 3), (1.0, 4), (1.0, 5)]
        drawn += [(WIDER[seed % len(WIDER)], seed) for seed in range(6, 6 + MORE)]
        found = [Plan(), *(Plan(noise=noise, seed=seed) for noise, seed in drawn)]
    else:
        found = [Plan()]
        found += [Plan(scale=scale, timed=True) for scale in DURATIONS if not _time_alone(instance, duration)]
        found += [Plan(scale=scale) for scale in (0.6, 6.0)]
        found += [
            Plan(noise=noise, seed=seed, scale=scale)
            for noise, seed, scale in ((0.1, 1, 1.5), (0.3, 2, 2.0), (0.3, 3, 4.0))
        ]
        wider = WIDER[::-1]
        found += [
            Plan(noise=wider[k // len(LASTING) % len(wider)], seed=6 + k, scale=LASTING[k % len(LASTING)])
            for k in range(MORE)
        ]
    pairs = revolutions.pairs(instance, controls)
    start, end = np.array(instance.initial), wanted(instance, instance.t0 + duration)
    if ends.random(instance):  # every other path is a bent line, because coasts of several revolutions diverge
        found[1:1] = [Plan(coasting=k % 2 > 0, drawn=k, noise=BENT[(k - 1) % 4], seed=k) for k in range(1, DRAWS + 1)]
    if pairs:
        places = [place for pair in pairs[:2] for place in pair]
        speed = revolutions.rate(instance, controls, start, end, pairs)
        if given or np.isnan(end[places]).any():
            usual = int(speed * duration / (2.0 * np.pi))
            turns = dict.fromkeys((usual, usual - 1, usual + 1))
            first = 0 if speed > 0.0 else 1  # a straight line leads through the centre of what goes round
            found[first:first] = [*(Plan(turns=k) for k in turns), Plan(coasting=True)]
        elif speed > 0.0:
            angle = revolutions.swept(start, end, pairs)
            rounds = [Plan(turns=k, scale=max(abs(angle + 2.0 * np.pi * k) / speed / duration, 0.2)) for k in TURNS]
            found = rounds + found
    elif given and len(instance.final) >= len(start) - 1:
        found.insert(1, Plan(coasting=True))
    if np.isnan(end).all() and len(_ranged(controls)):
        found[1:1] = [Plan(at_bound=share) for share in (NEXT_TO_BOUND, -NEXT_TO_BOUND)]
    found[1:1] = [Plan(parts=parts) for parts in _parts(len(instance.model.spec.interior) + 1)]
    if np.isfinite(end).any() and _limited(instance, controls):
        found[1:1] = [Plan(arriving=True), Plan(arriving=True, noise=0.3, seed=2)]
    if controls.angles:
        found[1:1] = [Plan(turned=0.0), Plan(turned=-0.5), Plan(turned=0.5)]
    if not given:
        found.insert(1, Plan(scale=2.5))  # a competitor of another duration is always among the first
    if not instance.model.spec.interior:
        for k in range(SAMPLED):  # every other one
            found.insert(2 + 2 * k, Plan(sampled=k + 1))
    return [Plan(guessed=True), *found] if instance.guess.state or instance.guess.control else found


def weak(instance: Instance, controls: Controls) -> list[Plan]:
    """Return further starts for controls that may be hardly strong enough; an empty list if they have no bounds."""
    if instance.tf is None or instance.model.spec.switching or controls.loosened is None:
        return []
    return [Plan(noise=WIDER[seed % len(WIDER)], seed=seed, loosened=True) for seed in range(LOOSENED)]


def _limited(instance: Instance, controls: Controls) -> bool:
    """Return whether controls or path are constrained; otherwise any end can be reached in any time without a swing."""
    bounded = np.isfinite(controls.lower).any() or np.isfinite(controls.upper).any()
    return bool(bounded or controls.norms or controls.angles or instance.model.spec.path_constraints)


def _time_alone(instance: Instance, duration: float) -> bool:
    """Return whether only time has a cost, at a constant rate; the cost then has one minimum over the duration."""
    spec = instance.model.spec
    if spec.has_terminal_cost:
        return False
    rng = np.random.default_rng(0)
    x = np.array(instance.initial)[:, None] * (1.0 + 0.1 * rng.standard_normal((len(instance.initial), LOOKS)))
    u = instance.control_set.project(rng.standard_normal((len(spec.controls), LOOKS)))
    times = instance.t0 + duration * rng.random(LOOKS)
    with np.errstate(all="ignore"):
        rates = np.broadcast_to(instance.model.running_cost_batch(times, x, u, instance.parameters), LOOKS)
    return bool(np.ptp(rates) == 0.0)


def _parts(phases: int) -> list[tuple[float, ...]]:
    """Return fractions of the duration between waypoints, with one phase in turn longer or shorter than the others."""
    if phases == 1:
        return []
    rows = [[length if k == place else 1.0 for k in range(phases)] for place in range(phases) for length in LENGTHS]
    return [tuple(one / sum(row) for one in row) for row in rows]


def _ranged(controls: Controls) -> Places:
    """Return the indices of controls that have two bounds of their own."""
    lifted = {place for lift in controls.lifts for place in lift.places}
    given = [place for place in range(controls.given) if place not in lifted]
    return np.array([k for k in given if np.isfinite(controls.lower[k]) and np.isfinite(controls.upper[k])], int)


def begun(programme: Programme, plan: Plan) -> Array:
    """Return the initial unknowns of a programme according to a plan."""
    instance, controls, sizes = programme.instance, programme.controls, programme.sizes
    equal = np.full(programme.phases, 1.0 / programme.phases)
    durations = plan.scale * sizes.duration * (np.array(plan.parts) if plan.parts else equal)
    times = programme.times(durations, instance.t0)
    lasting = times[-1] - times[0]
    share = (times - times[0]) / lasting
    start, end = np.array(instance.initial), wanted(instance, times[-1])
    v = resting(controls)
    if plan.turned is not None:
        for cosine, sine in controls.angles.values():
            v[cosine], v[sine] = np.cos(np.pi * plan.turned), np.sin(np.pi * plan.turned)
    if plan.at_bound is not None:
        at = _ranged(controls)
        low, high = controls.lower[at], controls.upper[at]
        v[at] = 0.5 * (low + high) + 0.5 * plan.at_bound * (high - low)
    if plan.drawn:
        start, end = ends.drawn(programme, plan.drawn, start, end)
    free = np.isnan(end)
    x = start[:, None] + np.where(free, 0.0, end - start)[:, None] * share
    if plan.coasting:
        x = _blended(programme, times, share, start, end, v)
    elif plan.turns is not None:
        x = revolutions.spiral(instance, controls, x, times, (start, end), plan.turns)
    if free.any() and not plan.coasting and plan.turns is None:
        x = _followed(programme, times, x, free, v)
    for i, state in enumerate(instance.model.spec.states):
        if state.positive:
            x[i] = np.maximum(x[i], 0.01 * sizes.states[i])
    many = np.repeat(v[:, None], len(times) - 1, 1)
    if plan.noise:
        x, many = _bent(programme, x, many, share, plan)
    if plan.guessed:
        _overlaid(programme, x, many, share)
    parameters = [one.of(instance) for one in programme.free]
    return programme.packed(x, many, durations, np.array(parameters), instance.t0)


def _overlaid(programme: Programme, x: Array, v: Array, share: Array) -> None:
    """Overwrite states and controls with the instance's initial guess, interpolated linearly between even times."""
    instance, controls, spec = programme.instance, programme.controls, programme.instance.model.spec

    def along(values: Sequence[float], at: Array) -> Array:
        return np.asarray(np.interp(at, np.linspace(0.0, 1.0, len(values)), values))

    for name, values in instance.guess.state.items():
        x[spec.state_names.index(name)] = along(values, share)
    known = {spec.control_names.index(name): values for name, values in instance.guess.control.items()}
    for place, values in known.items():
        row = along(values, share[1:])
        if place in controls.angles:
            cosine, sine = controls.angles[place]
            v[cosine], v[sine] = np.cos(row), np.sin(row)
        else:
            v[place] = row
    for norm in controls.norms:
        if norm.spot is not None and known.keys() & set(norm.places):
            v[norm.spot] = np.linalg.norm(v[list(norm.places)], axis=0)


def _bent(programme: Programme, x: Array, v: Array, share: Array, plan: Plan) -> tuple[Array, Array]:
    """Return states and controls with random waves added."""
    rng, controls, sizes = np.random.default_rng(plan.seed), programme.controls, programme.sizes
    deviations = ends.spread(programme, plan.drawn) if plan.drawn else sizes.states
    waves = np.array([np.sin(np.pi * k * share) / k for k in range(1, WAVES + 1)])
    x = x + plan.noise * deviations[:, None] * (rng.normal(size=(len(x), WAVES)) @ waves)
    span = controls.upper - controls.lower
    span = np.where(np.isfinite(span), span, 2.0 * sizes.variables)
    beats = np.array([np.cos(np.pi * k * share[1:]) / k for k in range(1, WAVES + 1)])
    return x, v + plan.noise * span[:, None] * (rng.normal(size=(len(v), WAVES)) @ beats)


def _blended(programme: Programme, times: Array, share: Array, start: Array, end: Array, v: Array) -> Array:
    """Return the forward motion from the start blended with the backward motion from the end, without control."""
    instance, controls, sizes = programme.instance, programme.controls, programme.sizes
    line = start[:, None] + np.where(np.isnan(end), 0.0, end - start)[:, None] * share
    rest = np.where(
        np.isfinite(controls.lower) & np.isfinite(controls.upper), 0.5 * (controls.lower + controls.upper), 0.0
    )
    rest = np.where(np.isfinite(rest), rest, 0.0)
    fine, places = _finer(times)
    ahead = followed(instance, controls, fine, start, rest, np.inf)
    if len(ahead) < len(fine):
        return line
    goal = np.where(np.isnan(end), ahead[-1], end)
    back = followed(instance, controls, fine[::-1], goal, rest, np.inf)
    if len(back) < len(fine):
        return line
    weight = share * share * (3.0 - 2.0 * share)
    forth, returned = ahead[places].T, back[::-1][places].T
    both = np.where(np.isnan(end)[:, None], forth, (1.0 - weight) * forth + weight * returned)
    far = np.abs(both / sizes.states[:, None]).max() > WITHIN
    return line if far else both


def _finer(times: Array, pieces: int = 4) -> tuple[Array, Places]:
    """Return times with intermediate ones inserted, and the indices of the original times."""
    inner = np.linspace(0.0, 1.0, pieces, endpoint=False)
    fine = (times[:-1, None] + np.diff(times)[:, None] * inner).ravel()
    return np.append(fine, times[-1]), np.arange(len(times)) * pieces


def _followed(programme: Programme, times: Array, x: Array, free: Array, v: Array) -> Array:
    """Return states in which those that are free at the end are integrated along the path of the other states."""
    instance, controls, sizes = programme.instance, programme.controls, programme.sizes.states
    x, y = x.copy(), x[:, 0].copy()
    for k in range(len(times) - 1):
        h = times[k + 1] - times[k]
        rate = flow(instance, controls, times[k], np.where(free, y, x[:, k]), v)[:-1]
        middle = np.where(free, y + h / 2 * rate, 0.5 * (x[:, k] + x[:, k + 1]))
        step = h * flow(instance, controls, times[k] + h / 2, middle, v)[:-1]
        room = 0.5 * sizes + np.abs(y)
        after = y + np.clip(step, -room, room)
        known = np.isfinite(after) & (np.abs(after) <= 10.0 * WITHIN * sizes)
        y = np.where(free, np.where(known, after, y), x[:, k + 1])
        x[free, k + 1] = y[free]
    return x


def carried(programme: Programme, other: Programme, w: Array) -> Array:
    """Return the unknowns of a programme interpolated from those of a programme on another mesh."""
    x, v, durations, free, start = other.unpacked(w)
    known, times = other.times(durations, start), programme.times(durations, start)
    states = np.array([np.interp(times, known, row) for row in x])
    variables = np.array([np.interp(times[1:], known[1:], row) for row in v]).reshape(len(v), len(times) - 1)
    return programme.packed(states, variables, durations, free, start)
