"""Comparison of a solution with competitors: results of the direct search from other starts, and random controls.

A competitor is another motion of the same problem whose cost is compared with the cost of the solution. The effort for
each start is limited by work, not by time, so that every machine finds the same competitors; only the time limit can
end a search earlier, and then the certificate says so.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym import activity
from satsym.instance import Guess
from satsym.instance.unknowns import Unknown
from satsym.solution import Check, Kind, Solution
from satsym.solvers.certificate.competitors.comparison import SAME_COST, Compared, Comparison, summed, unseen
from satsym.solvers.certificate.competitors.drawn import Drawn, drawable, drawn_below
from satsym.solvers.certificate.competitors.searched import kinds, searched
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.search.tried import Past
from satsym.solvers.switching.linear.linear_motion import linear_motion
from satsym.solvers.switching.linear.reach import THERE, Reach, given_rows

COARSE = {Kind.DURATIONS: 1e-6}
"""Relative difference below which two costs count as equal if controls switch, for kinds that need another value than
``SAME_COST``."""

WORK = 1_000_000
"""Maximum work, in unknowns times iterations, of the search that starts from a randomly drawn control."""

SEED, DURATIONS = 20012, 12
"""``SEED`` is the seed of the random shorter durations and ``DURATIONS`` is their number."""


UNSEEN = 0.2
"""Estimated probability that a further start leads to a new motion, above which certificates say that such starts were
not compared."""


def compared(
    solution: Solution, limits: Limits, past: Past | None = None, free: tuple[Unknown, ...] = ()
) -> Comparison:
    """Compare a solution with competitors of every kind.

    Parameters
    ----------
    limits
        Time and work limits; competitors that are not solved within these limits count as not checked.
    past
        Earlier answers and their number, which is the seed of the random controls: a solution that was found from a
        random control needs other controls than the earlier one.
    free
        Initial states, initial time and parameters that competitors may choose as well as the final state.
    """
    instance, switches, past = solution.instance, switching(solution), past or Past()
    if not switches and none_conceivable(solution):
        return Comparison(proved=(Check("no cheaper competitor", 0.0, 0.0),))
    if not switches and convex(instance):
        return Comparison(proved=(Check("not convex", 0.0, 0.0),))
    activity.tell("certificate: comparing with other starts of the search ...")
    unhindered = switches and not (instance.model.spec.throttled or instance.model.spec.in_arcs)
    with np.errstate(all="ignore"):
        costs, exact, unsettled = searched(solution, limits, past, free)
        if unhindered and not limits.late and (quicker := _shorter_costs(solution, limits)) and not limits.late:
            costs[Kind.DURATIONS] = [*costs.get(Kind.DURATIONS, []), *quicker]
    new = unseen([cost for kind, own in costs.items() if kind is not Kind.TIMES for cost in own])
    found = dict[Kind, Compared]()
    for kind, own in costs.items():
        answered, coarse = [cost for cost in own if not np.isnan(cost)], COARSE.get(kind) if switches else None
        found[kind] = summed(solution, kind, len(own), answered, limits.late, coarse or SAME_COST)
    possible = kinds(instance)
    enough = {kind for kind, one in found.items() if one.summary.solved and not limits.late}
    if switches and not limits.late and linear_motion(instance) is not None:  # nothing of it arrives anywhere else
        enough, found = set(found), {kind: replace(one, enough=True) for kind, one in found.items()}
    missing = tuple(kind for kind in possible if kind not in enough - unsettled)
    if not switches and Kind.STARTS in found and found[Kind.STARTS].margin >= 0.0 and not limits.late:
        drawn, led = _from_controls(solution, past.answers, limits, free)
        starts = found[Kind.STARTS] if drawn is None else found[Kind.STARTS].joined(drawn)
        found[Kind.STARTS], exact = replace(starts, enough=drawable(solution)), exact or led
    if limits.late or not (found or switches):  # nothing to compare with is said
        found |= {kind: summed(solution, kind, 0, [], limits.late) for kind in missing if kind not in found}
    if new > UNSEEN and not (switches and linear_motion(instance) is not None):
        missing += (Kind.FURTHER,)
    return Comparison(tuple(found[kind] for kind in possible if kind in found), missing, exact)


def switching(solution: Solution) -> bool:
    """Return whether the controls of a solution switch between arcs."""
    return solution.method == "bang-bang" or solution.instance.model.spec.switching


def _from_controls(
    solution: Solution, seed: int, limits: Limits, free: tuple[Unknown, ...]
) -> tuple[Compared | None, Solution | None]:
    """Compare a solution with the cheapest of the randomly drawn controls, and search from that control.

    Returns
    -------
    Comparison with that control, ``None`` if no drawn control costs less than the solution. Extremal found from that
    control, ``None`` if the search found none that costs at most as much as the control.
    """
    drawn = drawn_below(solution, seed)
    if drawn is None:
        return None, None
    with np.errstate(all="ignore"):
        found = tried(lambda: _led(solution, drawn, limits, free))
    cost = drawn.cost if found is None else min(found.objective, drawn.cost)
    return summed(solution, Kind.STARTS, 1, [cost], limits.late), found


def _led(solution: Solution, drawn: Drawn, limits: Limits, free: tuple[Unknown, ...]) -> Solution | None:
    """Return the extremal found by the search from a drawn control, or ``None`` if it costs more than this control."""
    from satsym.solvers.search import solving

    spec = solution.instance.model.spec
    states, controls = (
        dict(zip(names, map(tuple, rows.tolist()), strict=True))
        for names, rows in ((spec.state_names, drawn.states), (spec.control_names, drawn.control))
    )
    end = None if solution.instance.tf is not None else drawn.grid.tf
    instance = replace(solution.instance, guess=Guess(states, {}, controls), tf_guess=end, free=free)
    within = replace(limits, work=limits.meter.spent + WORK, watch=None)
    found = solving.searched(instance, within)
    if found is None or not found.objective <= drawn.cost:
        return None
    return replace(found, instance=replace(found.instance, guess=Guess()))


def none_conceivable(solution: Solution) -> bool:
    """Return whether no control can cost less than the solution: neither states nor controls can lower the cost.

    This is so if all costates vanish, neither the terminal nor the running cost depends on the state, and the control
    minimises the running cost. The last two conditions are tested at random states and controls around the solution.
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


def _shorter_costs(solution: Solution, limits: Limits) -> list[float]:
    """Return minimum costs of a linear motion for random shorter durations, NaN where the end cannot be reached.

    All admissible controls of these durations are covered. The list is empty if the motion is not linear, or if its
    duration is given or costs nothing.
    """
    instance, rng = solution.instance, np.random.default_rng(SEED)
    motion = None if instance.model.spec.multipliers or instance.tf is not None else linear_motion(instance)
    if motion is None or not motion.priced or not motion.rate > 0.0 or not len(given_rows(instance)):
        return []
    lasting = float(solution.times[-1]) - instance.t0
    edges = np.linspace(0.0, 1.0, DURATIONS + 1)
    fractions = np.append(rng.uniform(edges[:-1], edges[1:])[:-1], 1.0 - 10.0 ** rng.uniform(-3.0, -2.0))
    costs = list[float]()
    for fraction in fractions.tolist():
        reach = Reach(instance, motion, fraction * lasting)
        limits.spend(reach.count)
        if reach.separation()[0] > THERE:
            costs.append(float("nan"))
            continue
        priced = reach.minimum_cost() if motion.weight.any() or motion.slope.any() else None
        costs.append(motion.rate * reach.duration + (priced.cost if priced is not None else 0.0))
    return costs
