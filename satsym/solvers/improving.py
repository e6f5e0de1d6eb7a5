"""Solutions with certificates, replaced by the solution near a cheaper competitor if the certificate finds one."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import gcd

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.instance import Guess, Instance
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Progress, Solution
from satsym.solvers import iteration
from satsym.solvers.certificate.competitors.drawn import drawn_below, natural
from satsym.solvers.certificate.competitors.simulations import Simulations, simulations_of, stated_control
from satsym.solvers.certificate.end_limits import others_asked
from satsym.solvers.certificate.second_variation import Arc, Quadratic, quadratic, scaled_units
from satsym.solvers.certificate.verdict import examined
from satsym.solvers.search.escaping import REMEDY, escape
from satsym.solvers.search.tried import Past
from satsym.status import Status, Verdict

ROUNDS = 8
"""Maximum number of cheaper competitors that successively replace the solution."""

SWITCHED = "bang-bang"
"""Method whose saddle points are not left by descent, as descents keep neither switching controls nor path constraints.
The same holds for methods with boundary arcs."""

SAMPLES = 401
"""Number of values in an initial guess."""

Solver = Callable[[Instance, Progress | None], Solution]

DOUBLINGS = 12
"""Number of doublings of a control change, starting from the control that moves the state by its own magnitude."""

FALLS = 6
"""Number of last doublings over which the cost has to fall at least in proportion to the change."""

PROPORTIONAL = 1.9
"""Minimum ratio of successive decreases of the cost that counts as proportional."""

KEPT = 1e-6
"""Largest deviation of the final state, relative to the effect of the control change on it, that counts as none."""

DEPARTED = (0.5, -0.5, 0.1, -0.1)
"""Fractions of the control change by which a motion departs from a saddle point."""

PIECES = 50
"""Maximum number of pieces of the motion on which the change of the control is constant."""

NUDGE = 1e-6
"""Relative change of states and costates for differences of the control law."""


def improved(solver: Solver, instance: Instance, progress: Progress | None, asked: Instance | None = None) -> Solution:
    """Solve an instance, and again from each competitor that is cheaper than the solution found.

    For an instance with an initial guess the solution near this guess is kept; a cheaper one is only mentioned.

    Parameters
    ----------
    instance
        What to solve.
    progress
        Called after each iteration.
    asked
        The problem whose conditions competitors have to meet, if it has more final conditions than the instance.
    """
    began = time.perf_counter()
    deadline = iteration.deadline_of(instance)
    solution = solver(instance, progress)
    if solution.status.answered and (endless := escape(instance)):
        return without_minimiser(solution, f"{endless}; {REMEDY}")
    past = Past(asked=asked)
    certificate, better = examined(solution, deadline, past)
    if better is not None and instance.guess:
        less = f"another extremal costs less, {better.objective:.10g}: leave out [guess] to obtain that extremal"
        message = f"{solution.message}; {less}"
        solution, better = replace(solution, message=message), None
    first = solution.objective
    for number in range(1, ROUNDS + 1):
        if better is None or others_asked(better) is not None:
            break
        message = f"{better.message}; the first extremal found costs {first:.6g}"
        own = solution.instance
        past = replace(past, answers=number) if better.instance.met == own.met else Past(number, asked=asked)
        own = own if better.instance.met == own.met else own.meeting(better.instance.met)
        solution = replace(better, instance=_begun(own, better), message=message, history=solution.history)
        certificate, better = examined(solution, deadline, past)
    if certificate is not None and certificate.verdict is Verdict.EXTREMAL_ONLY and solution.method != BOUNDARY_ARCS:
        fallen = bottomless(solution)
        if fallen is not None:
            return fallen
        lower = None if instance.guess else _departed(solver, solution, progress, deadline)
        if lower is not None:
            solution, certificate = lower, examined(lower, deadline, replace(past, answers=ROUNDS + 1))[0]
    return replace(solution, certificate=certificate, wall_s=time.perf_counter() - began)


def goes_on(solution: Solution) -> bool:
    """Return whether :func:`improved` looks for a lower cost although the certificate lists no cheaper competitor."""
    certificate, lasting = solution.certificate, (BOUNDARY_ARCS, SWITCHED)
    extremal = certificate is not None and certificate.verdict is Verdict.EXTREMAL_ONLY
    return extremal and solution.method not in lasting


def bottomless(solution: Solution) -> Solution | None:
    """Return no answer if a stationary solution has ever cheaper controls; ``None`` if none are found."""
    constrained = solution.instance.model.spec.in_arcs  # of which descents know nothing
    endless = None if constrained or solution.method == SWITCHED else fall(solution)
    if endless is None:
        return None
    advice = "increase the weight of the control or of time, shorten the time, or bound the control"
    spec, within = solution.instance.model.spec, solution.instance.control_set
    if spec.control_set not in (None, "free") and not within.bounded:
        advice += "; the model allows bounds on the control, but [control] gives none"
    return without_minimiser(solution, f"{endless}; {advice}")


def without_minimiser(solution: Solution, message: str) -> Solution:
    """Return no answer in place of a solution, because there is always a cheaper one."""
    x, u, lam = (np.full_like(row, np.nan) for row in (solution.x, solution.u, solution.lam))
    return replace(
        solution,
        status=Status.NO_MINIMISER,
        message=message,
        objective=float("nan"),
        x=x,
        u=u,
        lam=lam,
        switching_times=tuple(() for _ in solution.switching_times),
        certificate=None,
    )


def starting_from(solution: Solution) -> Instance:
    """Return the instance of a solution with its states and costates as initial guess, resampled evenly."""
    instance, names = solution.instance, solution.instance.model.spec.state_names
    times = np.linspace(float(solution.times[0]), float(solution.times[-1]), SAMPLES)
    rows = [tuple(np.interp(times, solution.times, row).tolist()) for row in (*solution.x, *solution.lam)]
    n = len(names)
    start = Guess(dict(zip(names, rows[:n], strict=True)), dict(zip(names, rows[n:], strict=True)))
    return replace(instance, guess=start)


def _begun(instance: Instance, better: Solution) -> Instance:
    """Return an instance with the free initial values and parameters of another solution."""
    for unknown in instance.free:
        instance = unknown.at(instance, unknown.of(better.instance))
    return instance


def _departed(solver: Solver, solution: Solution, progress: Progress | None, deadline: float) -> Solution | None:
    """Return a cheaper solution found by descending from a saddle point, or ``None``."""
    if solution.method == SWITCHED or solution.instance.model.spec.in_arcs:
        return None
    for start in _departures(solution):
        found = _again(replace(solution.instance, guess=start), solver, solution, progress, deadline)
        if found is not None:
            return found
    return None


def _again(
    start: Instance, solver: Solver, solution: Solution, progress: Progress | None, deadline: float
) -> Solution | None:
    """Return the solution of an instance with an initial guess; ``None`` if it is not cheaper or time is up."""
    instance, begun = solution.instance, iteration.hurried(start, deadline)
    if begun is None:
        return None
    found = solver(begun, progress)
    if not found.status.answered or not found.objective < solution.objective:
        return None
    message = f"{found.message}; the first extremal found costs {solution.objective:.6g}"
    return replace(
        found, instance=_begun(instance, found), message=message, iterations=found.iterations + solution.iterations
    )


def fall(solution: Solution) -> str | None:
    """Return a text if the cost falls without limit from an extremal that is no minimum; otherwise ``None``.

    The control is changed in both senses along the direction of the smallest second variation, or towards a distant
    cheaper control. If repeated doubling of the change keeps the end and lowers the cost at least in proportion, there
    is no optimum: for linear-quadratic problems this is conclusive, for others it is evidence.

    Parameters
    ----------
    solution
        Solution with a given final time; problems with control bounds are not tested.
    """
    if solution.instance.control_set.bounded:
        return None
    found = _downhill(solution) or _far(solution)
    if found is None:
        return None
    simulations, grid, u, change = found
    falls = (_doubled(simulations, grid, u, sign * change) for sign in (1.0, -1.0))
    return next(filter(None, falls), None)


def _departures(solution: Solution) -> list[Guess]:
    """Return motions on both sides of a saddle point along which the cost falls at first; empty elsewhere."""
    found = _downhill(solution)
    if found is None:
        return []
    simulations, grid, u, change = found
    names, guesses = solution.instance.model.spec.state_names, []
    for fraction in DEPARTED:
        x, _ = simulations.motion(solution.instance.control_set.project(u + fraction * change), grid)
        if np.isfinite(x).all() and solution.instance.model.in_domain(x):
            guesses.append(Guess(state=dict(zip(names, map(tuple, x.tolist()), strict=True))))
    return guesses


def _downhill(solution: Solution) -> tuple[Simulations, Grid, Array, Array] | None:
    """Return the control of an extremal on a grid, and a change of negative second variation, or ``None``."""
    simulations = simulations_of(solution)
    if solution.instance.tf is None or simulations is None:
        return None
    grid = simulations.grid()
    found = along(solution, grid)
    if found is None or found.second.drowned:
        return None
    curvature, direction = found.second.steepest()
    shape = found.controls(direction)
    largest = float(np.abs(shape).max(initial=0.0))
    if not (curvature < 0.0 and largest > 0.0):
        return None
    unit = max(float(np.abs(solution.u).max()), float(natural(solution).min())) / largest
    u = stated_control(solution, grid)
    return simulations, grid, u, _keeping_the_end(simulations, grid, u, unit * shape, found)


def _keeping_the_end(simulations: Simulations, grid: Grid, u: Array, change: Array, found: Along) -> Array:
    """Return a change of the control corrected to keep the end to first order on the grid."""
    ties = found.second.ties[:-1]  # the last keeps the duration
    if not len(ties):
        return change
    others = [found.controls(one) for one in np.linalg.pinv(ties).T]
    size = float(np.abs(change).max())
    others = [one * size / max(float(np.abs(one).max()), 1e-300) for one in others]
    _, end = simulations(u, grid)
    response = np.array([simulations(u + one, grid)[1] - end for one in others]).T
    added = np.linalg.lstsq(response, end - simulations(u + change, grid)[1], rcond=None)[0]
    return change + np.einsum("c,cmN->mN", added, np.array(others))


def _far(solution: Solution) -> tuple[Simulations, Grid, Array, Array] | None:
    """Return the control of a minimum on a grid, and the change to a distant cheaper control, or ``None``."""
    drawn = drawn_below(solution) if solution.instance.tf is not None else None
    return None if drawn is None else (drawn.simulations, drawn.grid, drawn.stated, drawn.control - drawn.stated)


def _doubled(simulations: Simulations, grid: Grid, u: Array, change: Array) -> str | None:
    """Return costs of repeatedly doubled control changes as text if they fall without limit, otherwise ``None``."""
    instance = simulations.instance
    cost, end = simulations(u, grid)
    _, pushed = simulations(u + change, grid)
    falls, sizes, costs = [], [], []
    for k in range(DOUBLINGS):
        control = u + 2.0**k * change
        now, reached = simulations(control, grid)
        x, _ = simulations.motion(control, grid)
        if not np.isfinite(now) or not instance.model.in_domain(x):
            return None
        moved = 2.0**k * max(1.0, float(np.abs(pushed).max(initial=0.0)))
        if np.abs(reached - end).max(initial=0.0) > KEPT * moved:
            return None
        falls.append(cost - now)
        sizes.append(float(np.abs(control).max()))
        costs.append(now)
    last = np.array(falls[-FALLS - 1 :])
    endless = (last > 0.0).all() and (last[1:] >= PROPORTIONAL * last[:-1]).all()
    if not endless:
        return None
    shown, largest = (", ".join(f"{value:.4g}" for value in row[-3:]) for row in (costs, sizes))
    return f"the cost is unbounded below: controls up to {largest} have the costs {shown}"


@dataclass(frozen=True, eq=False)
class Along:
    """The second variation along a smooth extremal as one arc, and the response of its control to variations."""

    second: Quadratic
    feedback: Array
    direct: Array
    """Responses of the control to variations of the states and to its own variations, scaled, shapes (2 N + 1, m,
    n)."""

    def controls(self, direction: Array) -> Array:
        """Return the control variation at nodes and midpoints, (m, 2 N + 1), for a direction of the form."""
        (arc,), n = self.second.arcs, self.feedback.shape[2]
        (h, per), x, found = arc.widths, np.zeros(n + 1), []
        length, unit = direction[0] * arc.lasting, np.sqrt(2.0 / (h * per))
        for k in range(len(self.feedback) // 2):
            first = 1 + (n + 1) * (k // per)
            w = unit * direction[first : first + n + 1]
            middle, after = arc.stepped(k, x, w, np.asarray(length / arc.lasting))
            found += [
                self.feedback[at] @ y[:n] + self.direct[at] @ w[:n] for at, y in ((2 * k, x), (2 * k + 1, middle))
            ]
            x = after
        found.append(self.feedback[-1] @ x[:n] + self.direct[-1] @ w[:n])
        return np.array(found).T


def along(solution: Solution, grid: Grid) -> Along | None:
    """Return the second variation of a solution; ``None`` if values are not finite.

    Parameters
    ----------
    grid
        Grid on which the linearised motion is integrated.
    """
    instance, n, t = solution.instance, len(solution.x), interleave(grid.nodes, grid.midpoints)
    model, p, bounds = instance.model, instance.parameters, instance.control_set.arguments
    z = np.array([np.interp(t, solution.times, row) for row in np.concatenate([solution.x, solution.lam])])
    state, cost = scaled_units(solution)
    scale = np.concatenate([state[:-1], cost / state[:-1]])
    slopes = np.zeros((len(t), 2 * n, 2 * n + 1))
    slopes[:, :, :-1] = model.canonical_jacobian_batch(t, z[:n], z[n:], p, bounds).transpose(2, 0, 1)
    law, rates = _law_slopes(solution, t, z, scale), np.asarray(model.canonical_batch(t, z[:n], z[n:], p, bounds))
    if not (np.isfinite(slopes).all() and np.isfinite(law).all() and np.isfinite(rates).all()):
        return None
    still = np.zeros(len(t)), np.zeros(len(t))  # the final time is given
    arc = Arc.of(t, slopes, rates, still, state, cost, gcd(grid.steps, PIECES))
    # the law follows the costates as -K B', where push is the root of B K B'
    direct = -law[:, :, n:] @ np.linalg.pinv(arc.push[:, :n, :n], rcond=NUDGE, hermitian=True)
    return Along(quadratic(solution, [arc], state, cost), law[:, :, :n], direct)


def _law_slopes(solution: Solution, t: Array, z: Array, scale: Array) -> Array:
    """Return derivatives of the control law by scaled states and costates, by differences, shape (M, m, 2n)."""
    instance, n = solution.instance, len(z) // 2
    size = np.maximum(np.abs(z).max(axis=1), NUDGE * scale)
    change = NUDGE * size[:, None] * np.concatenate([np.eye(2 * n), -np.eye(2 * n)], axis=1)
    moved = (z[:, None] + change[:, :, None]).reshape(2 * n, -1)
    p, bounds = instance.parameters, instance.control_set.arguments
    law = np.asarray(instance.model.control_law_batch(np.tile(t, 4 * n), moved[:n], moved[n:], p, bounds))
    ahead, behind = np.split(law.reshape(len(law), 4 * n, len(t)), 2, axis=1)
    return np.asarray((ahead - behind).transpose(2, 0, 1) * (scale / (2.0 * NUDGE * size)))
