"""The certificate of boundary arcs: the extremal again, multipliers and their signs, what makes it a minimum."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Certificate, Check, Solution
from satsym.solvers.certificate import conditions
from satsym.solvers.certificate.constrained.comparison import Comparison
from satsym.solvers.certificate.constrained.comparison import compared as with_other_arcs
from satsym.solvers.certificate.constrained.replay import Piece, Replay, replay
from satsym.solvers.certificate.constrained.second_variation import curvature
from satsym.solvers.certificate.flow import FAINT, typical
from satsym.solvers.constrained.arcs import values
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.constrained.structure import FREE, within
from satsym.status import Verdict

RESIDUAL, DEFECT, STATIONARY, DRIFT, COST = 1e-9, 1e-7, 1e-8, 1e-9, 1e-8
"""Largest boundary residual, defect, violation of stationarity, change of H and error of the stated cost."""

VIOLATED, SIGN = 1e-9, 1e-9
"""Largest violation of a constraint, relative to its size along the way, and negative share of a multiplier."""

CURVED = 1e-7
"""Least curvature with the active arcs held, relative to that without costs but of the control."""

STRICT = 1e-6
"""Least share of the largest multiplier at which one is strictly positive."""


def certify(solution: Solution, seed: int = 0, compared: bool = True) -> Certificate:
    """Certify arcs on boundaries of path constraints; see :func:`satsym.solvers.certificate.certify`."""
    with np.errstate(all="ignore"):
        again = replay(solution)
        if again is None:
            missing = float("nan")
            check = Check("flow from the initial costates is finite", 1.0, 0.0)
            return Certificate(Verdict.FAILED, missing, missing, missing, None, missing, None, (check,))
        first = _first_order(solution, again)
        second: list[Check] = []
        comparison = Comparison((), (), ())
        if all(c.passed for c in first):
            second = [Check("legendre-clebsch", float(not conditions.legendre_clebsch(solution) > 0.0), 0.0)]
            if convex(solution.instance):
                second.append(Check("not convex", 0.0, 0.0))
            else:
                second += _sufficient(solution, again)
                if compared:
                    comparison = with_other_arcs(solution, seed)
                    second += comparison.checks
    return Certificate(
        verdict=Verdict.of(all(c.passed for c in first), all(c.passed for c in second), compared),
        **conditions.headlines(first),
        legendre_clebsch=conditions.legendre_clebsch(solution),
        conjugate_time=None,
        checks=(*first, *second),
        competitors=comparison.competitors,
        not_checked=comparison.not_checked,
    )


def _first_order(solution: Solution, again: Replay) -> list[Check]:
    flow = again.flow(solution)
    checks = [
        Check(conditions.BOUNDARY, conditions.boundary_residual(solution, flow), RESIDUAL),
        Check(conditions.OF_FLOW, _defect(solution, again), DEFECT),
        Check(conditions.STATIONARITY, conditions.stationarity(solution), STATIONARY),
        Check("cost", conditions.off_cost(solution, flow), COST),
        Check("domain violation", float(not solution.instance.model.in_domain(flow.x)), 0.0),
        Check("path constraint violated", _violated(solution, again), VIOLATED),
        Check("off the boundary on a boundary arc", _off_boundary(solution, again), VIOLATED),
        Check("off tangency at junctions", _off_tangency(solution, again), DEFECT),
        Check("jump of costates off the constraint's gradient", again.off_gradient, DEFECT),
        Check("negative multiplier", _negative(solution, again), SIGN),
    ]
    drift = _drift(solution, again)
    return checks if drift is None else [*checks, Check(conditions.HAMILTONIAN, drift, DRIFT)]


def _sufficient(solution: Solution, again: Replay) -> list[Check]:
    """Each is a deficit that must not be positive."""
    least, most = _least_multiplier(solution, again)
    return [
        Check("multiplier vanishes on a boundary", float(not least > STRICT * most), 0.0),
        Check("second variation with the active arcs fixed", float(not curvature(solution, again) > CURVED), 0.0),
    ]


def _defect(solution: Solution, again: Replay) -> float:
    """Largest distance of the solver's states and costates from the flow, relative to the size of each."""
    mine = np.concatenate([solution.x, solution.lam])
    return float((np.abs(mine - again.z).max(axis=1) / np.concatenate(typical(solution, FAINT))).max())


def _sizes(solution: Solution, again: Replay) -> Array:
    """Of each constraint along the way."""
    n = len(solution.x)
    found = [np.abs(values(solution.instance, p.times, p.dense[:n])).max(axis=1) for p in again.pieces]
    return np.maximum(np.max(found, axis=0), 1e-300)


def _violated(solution: Solution, again: Replay) -> float:
    """Largest value of a constraint along the flow, relative to its size."""
    n = len(solution.x)
    found = [values(solution.instance, p.times, p.dense[:n]).max(axis=1) for p in again.pieces]
    return max(0.0, float((np.max(found, axis=0) / _sizes(solution, again)).max()))


def _off_boundary(solution: Solution, again: Replay) -> float:
    """Largest distance from the boundary on its arcs, relative."""
    n, sizes, worst = len(solution.x), _sizes(solution, again), 0.0
    for piece in again.pieces:
        if piece.constraint != FREE:
            g = values(solution.instance, piece.times, piece.dense[:n])[piece.constraint]
            worst = max(worst, float(np.abs(g).max()) / sizes[piece.constraint])
    return float(worst)


def _off_tangency(solution: Solution, again: Replay) -> float:
    """Largest constraint, or its rate over the duration, at entries and touch points, relative to its size."""
    instance, n, sizes, worst = solution.instance, len(solution.x), _sizes(solution, again), 0.0
    lasting = float(solution.times[-1] - solution.times[0])
    for event, piece in zip(solution.events, again.pieces, strict=False):
        which = _number(solution, event.name)
        x, t = piece.z[:n, -1:], piece.times[-1:]
        found = [abs(float(values(instance, t, x)[which, 0]))]
        if instance.model.spec.path_constraints[which].order > 1 and event.t < solution.times[-1]:
            found.append(abs(_rates(solution, piece, -1)[which, 0]) * lasting)
        worst = max(worst, max(found) / sizes[which])
    return float(worst)


def _number(solution: Solution, name: str) -> int:
    return [one.name for one in solution.instance.model.spec.path_constraints].index(name)


def _rates(solution: Solution, piece: Piece, place: int) -> Array:
    """First and second rates of all constraints at an end of an arc, shape (h, 2)."""
    instance, n = solution.instance, len(solution.x)
    t, z = np.array([piece.times[place]]), piece.z[:, [place]]
    u = instance.model.control_law_batch(t, z[:n], z[n:], instance.parameters, instance.control_set.arguments)
    return np.asarray(instance.model.path_rates_batch(t, z[:n], u, instance.parameters)).reshape(-1, 2)


def _multipliers(solution: Solution, again: Replay) -> list[Array]:
    """eta along each arc on a boundary."""
    n, found = len(solution.x), []
    for piece in again.pieces:
        if piece.constraint != FREE:
            eta = solution.instance.model.path_multiplier_batch(
                piece.times, piece.dense[:n], piece.dense[n:], solution.instance.parameters
            )
            found.append(np.broadcast_to(np.asarray(eta)[piece.constraint], piece.times.shape))
    return found


def _negative(solution: Solution, again: Replay) -> float:
    """Largest negative multiplier along an arc or at a junction, relative to the largest there is.

    A touch point at which the constraint would rise on either side counts as one.
    """
    least, most = _least_multiplier(solution, again)
    return max(0.0, float(-least / most))


def _least_multiplier(solution: Solution, again: Replay) -> tuple[float, float]:
    """The least multiplier, those at junctions over the duration, and the largest magnitude of any."""
    lasting = float(solution.times[-1] - solution.times[0])
    jumping = [
        abs(jump) > 0.0 or solution.instance.model.spec.path_constraints[_number(solution, event.name)].order > 1
        for event, jump in zip(within(solution), again.jumps, strict=False)
    ]
    jumps = [jump / lasting for jump, counts in zip(again.jumps, jumping, strict=False) if counts]
    jumps += [jump / lasting for jump in again.jumps[len(jumping) :]]
    along = [float(eta.min()) for eta in _multipliers(solution, again)]
    sizes = [float(np.abs(eta).max()) for eta in _multipliers(solution, again)]
    return float(min([*jumps, *along], default=0.0)), float(max([*map(abs, jumps), *sizes, 1e-300]))


def _drift(solution: Solution, again: Replay) -> float | None:
    """Largest change of H along the flow, relative to its terms; ``None`` where time is explicit."""
    instance, n = solution.instance, len(solution.x)
    model, p, t = instance.model, instance.parameters, solution.times
    x, lam = again.z[:n], again.z[n:]
    moving = np.imag(np.asarray(model.path_constraints_batch(t + 1e-30j, x, p))).any()
    if not model.spec.autonomous or moving:
        return None
    u = model.control_law_batch(t, x, lam, p, instance.control_set.arguments)
    h = np.broadcast_to(model.hamiltonian_batch(t, x, u, lam, p), t.shape)
    terms = np.abs(lam * model.dynamics_batch(t, x, u, p)).sum(axis=0).max()
    return float(np.abs(h - h[0]).max() / max(terms, np.abs(h).max(), 1e-300))
