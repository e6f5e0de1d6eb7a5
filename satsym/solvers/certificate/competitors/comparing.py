"""Competitors of smooth extremals: what other starts of the direct search come to, and controls that are drawn.

How far each start may go is limited by work, so that what is found is the same on every machine; only time that is up
can end it before, and that is said.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym import activity
from satsym.instance import Guess
from satsym.solution import Check, Kind, Solution
from satsym.solvers.certificate.competitors.comparison import Compared, Comparison, summed
from satsym.solvers.certificate.competitors.drawn import Drawn, drawable, drawn_below
from satsym.solvers.certificate.competitors.searched import kinds, searched
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.failures import tried
from satsym.solvers.iteration import MOST, Limits

WORK = 1_000_000
"""Unknowns times iterations that the search may take from a control that was drawn."""


def compared(solution: Solution, deadline: float, seed: int = 0) -> Comparison:
    """Compare a solution with competitors of every kind.

    Parameters
    ----------
    deadline
        On the clock of :func:`~satsym.solvers.iteration.computed`.
    seed
        Of controls that are drawn: another one where a solution was found from such a control.
    """
    if none_conceivable(solution):
        return Comparison(proved=(Check("no cheaper competitor", 0.0, 0.0),))
    if convex(solution.instance):
        return Comparison(proved=(Check("not convex", 0.0, 0.0),))
    limits = Limits(MOST, deadline)
    activity.tell("certificate: comparing with other starts of the search ...")
    with np.errstate(all="ignore"):
        found = searched(solution, limits, seed)
    compared, exact = list[Compared](), found.better
    for one in found.competitors:
        costs = [one.cheapest] if one.solved else []
        own = replace(summed(solution, one.kind, one.tried, costs, limits.late), summary=one)
        if one.kind is Kind.STARTS and own.margin >= 0.0 and not limits.late:
            drawn, led = _from_controls(solution, seed, limits)
            own = replace(own if drawn is None else own.joined(drawn), simulated=drawable(solution))
            exact = exact or led
        compared.append(own)
    known = {one.kind for one in found.competitors if one.solved and not limits.late}
    missing = tuple(kind for kind in kinds(solution.instance) if kind not in known)
    begun = {one.kind for one in found.competitors}
    if limits.late or not begun:  # nothing to compare with is said
        compared += [summed(solution, kind, 0, [], limits.late) for kind in missing if kind not in begun]
    return Comparison(tuple(compared), missing, exact)


def _from_controls(solution: Solution, seed: int, limits: Limits) -> tuple[Compared | None, Solution | None]:
    """The cheapest of controls that are drawn, if one costs less, and the extremal to which it leads the search."""
    drawn = drawn_below(solution, seed)
    if drawn is None:
        return None, None
    with np.errstate(all="ignore"):
        found = tried(lambda: _led(solution, drawn, limits))
    cost = drawn.cost if found is None else min(found.objective, drawn.cost)
    return summed(solution, Kind.STARTS, 1, [cost], limits.late), found


def _led(solution: Solution, drawn: Drawn, limits: Limits) -> Solution | None:
    """The extremal to which the search is led by a control that was drawn, where it costs no more than that."""
    from satsym.solvers.search import solving

    spec = solution.instance.model.spec
    states, controls = (
        dict(zip(names, map(tuple, rows.tolist()), strict=True))
        for names, rows in ((spec.state_names, drawn.states), (spec.control_names, drawn.control))
    )
    end = None if solution.instance.tf is not None else drawn.grid.tf
    instance = replace(solution.instance, guess=Guess(states, {}, controls), tf_guess=end)
    within = replace(limits, work=limits.meter.spent + WORK, watch=None)
    found = solving.searched(instance, within)
    if found is None or not found.objective <= drawn.cost:
        return None
    return replace(found, instance=replace(found.instance, guess=Guess()))


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
