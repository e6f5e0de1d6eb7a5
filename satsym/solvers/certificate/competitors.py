"""Competitors: admissible motions that might be cheaper. The certificate names each kind it has compared.

None starts where the solver did, and how far each may go is limited by work, so that what is found is the same on
every machine; only time that is up can end it before, and that is said.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from satsym import activity
from satsym.arrays import Array
from satsym.instance import Guess, Instance
from satsym.solution import Kind, Solution
from satsym.solvers.certificate.comparison import Compared, Comparison, Competitor, summed
from satsym.solvers.certificate.directed import led, led_far_round
from satsym.solvers.certificate.drawn_controls import drawable, drawn_below
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.certificate.seeded import drawn_extremals
from satsym.solvers.certificate.seeded.answer import Answer
from satsym.solvers.certificate.seeded.searches import ROUGH, Search, accurate, at_its_duration, bounded, from_path
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.revolutions import shifted

if TYPE_CHECKING:
    from satsym.solvers.collocation.curve import Curve
    from satsym.solvers.collocation.problem import TwoPoint
    from satsym.solvers.symmetry import Spiral

WORK = 15_000
"""Columns that may be linearised for one attempt; a revolution has some 30 of them an iteration."""

SEEDS = 4
"""Starts that are drawn, of each kind."""

MORE, MORE_WORK, ROUNDS = 12, 4 * WORK, 3
"""Further starts where the first ones lead to several minima or nowhere, the columns after which no other one is begun,
and how often that is done as long as there are several minima."""

FAR_ROUND = 8
"""First paths that are drawn far from the straight line, where the final time is free."""

PATIENT, DRAWN_WORK = 10 * WORK, 30 * WORK
"""Columns for one extremal that is drawn, and after which no other one is begun: long swings take many."""

BENT, ALSO_BENT = (0.3, 1.0), (0.03, 0.1, 1.0)
"""Amplitudes of what is added to a straight line, in sizes of the states, at first and for further starts.

Where ends are close together, or motions unstable, the smallest lead to the most minima.
"""

BETWEEN = (0.25, 0.5, 0.75)
"""Shares of the way from lower to upper bounds at which constant controls are that are swept, besides the corners."""

SOFT = (0.1, 0.01)
"""Softness of bounds with which saturated structures are looked for."""

TURNS = 3
"""Numbers of revolutions that are tried."""

EARLIER = (0.6, 0.8, 0.95)
"""Shares of the duration after which a competitor has arrived, and coasts."""

SHORTER_AND_LONGER = (0.4, 0.5, 0.6, 0.7, 0.8, 1.25, 1.5, 2.0)
"""Durations beside one that was chosen, as shares of it."""

SAMPLES = 401
"""Values of a guess that leads to a cheaper competitor."""


def compared(solution: Solution, deadline: float, seed: int = 0) -> Comparison:
    """Compare a solution with competitors of every kind.

    Parameters
    ----------
    deadline
        On the clock of :func:`~satsym.solvers.iteration.computed`.
    seed
        Of starts that are drawn: another one where a solution was found from such a start.
    """
    kinds, missing, spec, answer = [], [], solution.instance.model.spec, Answer(solution)
    for kind, attempts in _attempts(solution, answer, seed):
        beside: Compared | None = None
        by_law = spec.directional or spec.stationary
        smooth = kind is Kind.STARTS and not by_law
        activity.tell(f"certificate: comparing with {kind.value} ...")
        found = _tried(solution, kind, attempts, deadline)
        if found is None:
            missing.append(kind)
            continue
        if (smooth or by_law) and not found.interrupted:
            drawn = tried(partial(drawn_extremals.searches, solution, found, seed)) or []
            more = _tried(solution, kind, drawn, deadline, DRAWN_WORK, PATIENT)
            likely = kind is Kind.DURATIONS and drawn_extremals.several_likely(solution, found)
            found = found if more is None else found.joined(more)
            beside = _from_far_round(solution, deadline, seed) if likely else None
        several = found.several or seed > 0 or found.summary.solved < found.summary.tried
        for number in range(ROUNDS if smooth else 0):
            if not several or found.margin < 0.0 or found.interrupted:
                break
            more = _tried(solution, kind, _from_more(solution, answer, (seed, number)), deadline, MORE_WORK)
            several = more is not None and more.several
            found = found if more is None else found.joined(more)
        if kind is Kind.STARTS and found.margin >= 0.0:
            far = _tried(solution, kind, _from_controls(solution, seed), deadline)
            found = replace(found if far is None else found.joined(far), simulated=drawable(solution))
        for one in (found,) if beside is None else (found, beside):
            kinds.append(one)
            if one.interrupted or not one.summary.solved:
                missing.append(one.summary.kind)
    return Comparison(tuple(kinds), tuple(missing))


def guess(competitor: Competitor, solution: Solution) -> Instance:
    """The instance of a solution that starts from a competitor."""
    instance, names = solution.instance, solution.instance.model.spec.state_names
    n, (_, z, end) = len(names), _motion(competitor, solution)
    rows = [tuple(row) for row in z.tolist()]
    start = Guess(dict(zip(names, rows[:n], strict=True)), dict(zip(names, rows[n:], strict=True)))
    return replace(instance, guess=start, tf_guess=end if instance.tf is None else None)


def _admissible(competitor: Competitor, solution: Solution) -> bool:
    """Whether a competitor keeps to path constraints, of which it knows nothing; one that costs more need not."""
    model, p = solution.instance.model, solution.instance.parameters
    if not model.spec.path_constraints or competitor.curve is None or not competitor.cost < solution.objective:
        return True
    from satsym.solvers.constrained.violation import VIOLATED, violation

    n, (times, z, _) = len(solution.x), _motion(competitor, solution)
    u = model.control_law_batch(times, z[:n], z[n:], p, solution.instance.control_set.arguments)
    controls = np.broadcast_to(u, (len(solution.u), len(times)))
    return violation(replace(solution, times=times, x=z[:n], u=controls, lam=z[n:])) <= VIOLATED


def _motion(competitor: Competitor, solution: Solution) -> tuple[Array, Array, float]:
    """Times, states and costates of a competitor, and when it arrives."""
    problem, curve, instance = competitor.problem, competitor.curve, solution.instance
    assert curve is not None
    end = problem.instance.t0 + problem.elapsed(curve.theta)
    last = end if instance.tf is None else max(instance.tf, end)
    n, times = len(instance.initial), np.linspace(instance.t0, last, SAMPLES)
    tau = np.minimum((times - instance.t0) / (end - instance.t0), 1.0)
    z = curve(tau) * problem.scale.both
    z[:n] += (np.array(instance.initial) - np.array(problem.instance.initial))[:, None]
    coasting = times > end
    if coasting.any():  # arrived on the reference before the end
        z[:n, coasting] = np.array([instance.model.reference(t, instance.parameters) for t in times[coasting]]).T
        z[n:, coasting] = 0.0
    return times, z, end


def _tried(
    solution: Solution, kind: Kind, attempts: list[Search], deadline: float, work: float = math.inf, each: float = WORK
) -> Compared | None:
    """Every attempt at a kind that is begun before so much work is done; ``None`` where there is none."""
    if not attempts:
        return None
    found: list[Competitor] = []
    count, spent, interrupted = 0, 0, False
    for attempt in attempts:
        if spent > work:
            break
        limits = Limits(200, deadline, work=each)
        with np.errstate(all="ignore"):
            competitor = tried(partial(attempt, limits))
        interrupted, spent = limits.late, spent + limits.meter.spent
        if interrupted:
            break
        count += 1
        if competitor is not None and _admissible(competitor, solution):
            found.append(competitor)
    cheapest = min(found, key=lambda one: one.cost, default=None)
    summary = summed(solution, kind, count, [one.cost for one in found], interrupted)
    several = any(one.cost > solution.objective + ROUGH * abs(solution.objective) for one in found)
    return replace(summary, cheapest=cheapest, several=several)


def _attempts(solution: Solution, answer: Answer, seed: int) -> Iterator[tuple[Kind, list[Search]]]:
    """Kinds that the problem of a solution allows, with what is tried of each; nothing where nobody knows how."""
    from satsym.solvers.collocation.scaling import two_point
    from satsym.solvers.symmetry import other_spirals, rotation

    instance, cost = solution.instance, solution.objective
    problem, lasting = at_its_duration(solution), float(solution.times[-1]) - instance.t0
    fixed, rng = problem.instance, np.random.default_rng(seed)

    if instance.model.spec.directional or instance.model.spec.stationary:
        bent = tuple(BENT[k % len(BENT)] for k in range(SEEDS))
        for kind, searches in led(instance, lasting, rng, bent, SHORTER_AND_LONGER):
            yield kind, _made_accurate(searches, cost)
        if rotation(fixed):
            yield Kind.REVOLUTIONS, []
        return
    yield Kind.STARTS, [from_path(problem, path, 1.0, cost, answer=answer) for path in _bent(problem, rng)]
    if instance.control_set.bounded:
        starts = zip(_bent(problem, rng), SOFT * SEEDS, strict=False)
        soft = [from_path(problem, path, softness, cost) for path, softness in starts]
        yield Kind.SATURATION, [*soft, *_from_constants(problem, cost)]
    angles = [name for name in instance.solver.free_angles if name in instance.final]
    turned = [two_point(shifted(fixed, {name: turns}), lasting) for name in angles for turns in (-1, 1)]
    around: list[Search] = [_cold(one, cost) for one in turned]
    symmetry = None if angles else rotation(fixed)
    if symmetry and problem.fixed[symmetry.moved].all():
        around = [_from_spiral(problem, one, cost) for one in other_spirals(problem, solution.x, TURNS + 1)]
    elif symmetry:
        yield Kind.REVOLUTIONS, []
    if around:
        yield Kind.REVOLUTIONS, around
    if instance.tf is None:
        beside = [_lasting(instance, fraction * lasting, cost) for fraction in SHORTER_AND_LONGER]
        yield Kind.DURATIONS, [*beside, *_at_once(two_point(instance, lasting))]
    if instance.tf is not None and _on_reference(solution):
        final: dict[str, float | Literal["reference"]] = dict.fromkeys(instance.model.spec.state_names, "reference")
        sooner = [fraction * lasting for fraction in EARLIER]
        early = [two_point(replace(fixed, tf=instance.t0 + t, final=final), t) for t in sooner]
        yield Kind.EARLIER, [_cold(one, cost) for one in early]


def _made_accurate(searches: list[Callable[[Limits], tuple[TwoPoint, Curve] | None]], cost: float) -> list[Search]:
    """What searches find, made accurate; several may find the same."""
    made: list[tuple[Curve, Competitor | None]] = []

    def attempt(search: Callable[[Limits], tuple[TwoPoint, Curve] | None], limits: Limits) -> Competitor | None:
        found = search(limits)
        if found is None:
            return None
        if not any(found[1] is curve for curve, _ in made):
            made.append((found[1], accurate(*found, cost)))
        return next(competitor for curve, competitor in made if found[1] is curve)

    return [partial(attempt, search) for search in searches]


def _from_far_round(solution: Solution, deadline: float, seed: int) -> Compared | None:
    """What paths lead to that are far from the straight line; more are drawn where the first disagree or fail."""
    lasting, rng = float(solution.times[-1]) - solution.instance.t0, np.random.default_rng((seed, MORE))
    found: Compared | None = None
    for searches in led_far_round(solution.instance, lasting, rng, (FAR_ROUND, MORE)):
        attempts = _made_accurate(searches, solution.objective)
        more = _tried(solution, Kind.STARTS, attempts, deadline, DRAWN_WORK)
        found = more if found is None or more is None else found.joined(more)
        if found is None or (not found.several and found.summary.solved == found.summary.tried) or found.interrupted:
            break
    return found


def _from_more(solution: Solution, answer: Answer, seed: tuple[int, int]) -> list[Search]:
    """The minima within the bounds to which further paths lead that are drawn."""
    problem, rng = at_its_duration(solution), np.random.default_rng((*seed, MORE))
    paths = _bent(problem, rng, MORE, ALSO_BENT)
    return [from_path(problem, path, 1.0, solution.objective, answer=answer) for path in paths]


def _from_controls(solution: Solution, seed: int) -> list[Search]:
    """The minimum to which the cheapest of controls that are drawn leads, if one costs less; else that control.

    Its path of states is descended from, and where that leads elsewhere the control itself is swept.
    """
    from satsym.solvers.cold_start import paths
    from satsym.solvers.cold_start.swept import loose
    from satsym.solvers.collocation.scaling import two_point

    drawn = drawn_below(solution, seed)
    if drawn is None:
        return []
    lasting = drawn.grid.tf - drawn.grid.t0
    problem = two_point(replace(solution.instance, tf=drawn.grid.tf, tf_guess=None, guess=Guess()), lasting)
    descend = from_path(problem, paths.through(problem, drawn.states), SOFT[-1], solution.objective)

    control = dict(zip(solution.instance.model.spec.control_names, drawn.control.tolist(), strict=True))

    def attempt(limits: Limits) -> Competitor | None:
        found = tried(partial(descend, limits))
        if loose(problem) and not (found and found.cost <= drawn.cost):
            found = _swept(problem, control, solution.objective, limits)
        return found if found and found.cost <= drawn.cost else Competitor(problem, None, drawn.cost)

    return [attempt]


def _from_spiral(problem: TwoPoint, spiral: Spiral, cost: float) -> Search:
    """The minimum within the bounds with a number of turns."""
    from satsym.solvers.cold_start.path_of_problems import along_turns

    return lambda limits: bounded(problem, along_turns(problem.relaxed(float("inf")), spiral, limits), cost, limits)


def _from_constants(problem: TwoPoint, cost: float) -> list[Search]:
    """The extremals to which sweeps lead from constant controls, where nothing is asked of the end."""
    from satsym.solvers.cold_start.swept import constants

    return [partial(_swept, problem, control, cost) for control in constants(problem, BETWEEN)]


def _swept(problem: TwoPoint, control: Mapping[str, Sequence[float]], cost: float, limits: Limits) -> Competitor | None:
    """The extremal to which sweeps lead from a control."""
    from satsym.solvers.cold_start.swept import from_control

    curve = tried(partial(from_control, problem, control, limits))
    return None if curve is None else accurate(problem, curve, cost)


def _lasting(instance: Instance, duration: float, cost: float) -> Search:
    """The minimum over the duration next to a given one; that of the given one where bounds are in its way."""
    from satsym.solvers.cold_start.duration_trials import Trials
    from satsym.solvers.collocation.continuation import kept

    free = replace(instance, guess=Guess(), tf_guess=None)

    def attempt(limits: Limits) -> Competitor | None:
        trials = Trials(free, limits, duration)
        rough = trials.cold(duration, quick=True)
        if rough is None:
            return None
        smallest = trials.freed(rough)
        if smallest is not None and kept(smallest.problem.relaxed(0.0), smallest.start.found.curve):
            return accurate(smallest.problem.relaxed(0.0), smallest.start.found.curve, cost)
        given = replace(rough.problem, relaxation=0.0)
        return bounded(given, rough.start.found, cost, limits)

    return attempt


def _at_once(problem: TwoPoint) -> list[Search]:
    """The end without any motion, where it is one."""
    cost = problem.at_once
    return [lambda _: Competitor(problem, None, cost)] if math.isfinite(cost) else []


def _cold(problem: TwoPoint, cost: float) -> Search:
    """The minimum within the bounds to which the first ways of the cold start lead."""
    from satsym.solvers.cold_start.first_minimum import cold_start

    def attempt(limits: Limits) -> Competitor | None:
        start = cold_start(problem, limits, quick=True)
        return bounded(problem, start.found, cost, limits)

    return attempt


def _bent(
    problem: TwoPoint, rng: np.random.Generator, count: int = SEEDS, amplitudes: tuple[float, ...] = BENT
) -> Iterator[Callable[[Any], Any]]:
    """Paths that are drawn, of all amplitudes in turn."""
    from satsym.solvers.cold_start import paths

    for k in range(count):
        yield paths.bent(problem, rng, amplitudes[k % len(amplitudes)])


def none_conceivable(solution: Solution) -> bool:
    """Whether no control can cost less: the state costs nothing, and the control is the least of the running cost.

    So it is where all costates vanish, neither the terminal nor the running cost depends on the state, and no control
    makes the latter smaller: looked at for states and controls drawn all around those of the solution.
    """
    if solution.lam.any() or solution.instance.model.spec.multipliers:
        return False
    instance, model = solution.instance, solution.instance.model
    rng, p, t = np.random.default_rng(0), instance.parameters, solution.times
    x = solution.x + unit_sizes(solution)[: len(solution.x), None] * rng.uniform(-2.0, 2.0, solution.x.shape)
    positive = [i for i, state in enumerate(model.spec.states) if state.positive]
    x[positive] = solution.x[positive] * rng.uniform(0.2, 5.0, solution.x[positive].shape)
    size = np.abs(solution.u).max(initial=0.0) or 1.0
    drawn = solution.u + size * 10.0 ** rng.uniform(-3.0, 3.0) * rng.normal(size=solution.u.shape)
    u = instance.control_set.project(drawn)
    slopes = model.costate_rate_batch(t, x, u, solution.lam, p)
    ends = [model.terminal_gradient(float(t[-1]), tuple(row), p) for row in x.T[:20]]
    smallest = model.running_cost_batch(t, x, solution.u, p) <= model.running_cost_batch(t, x, u, p)
    return not np.any(slopes) and not np.any(ends) and bool(np.all(smallest))


def _on_reference(solution: Solution) -> bool:
    """Whether the whole final state is the reference's, and coasting on it is admissible."""
    instance, spec = solution.instance, solution.instance.model.spec
    if not spec.has_reference or instance.final.keys() != set(spec.state_names):
        return False
    curve = np.array(instance.model.reference(float(solution.times[-1]), instance.parameters))
    none = np.zeros((len(spec.controls), 1))
    there = np.allclose(solution.x[:, -1], curve, rtol=1e-9, atol=1e-12)
    return bool(there and (instance.control_set.project(none) == none).all())
