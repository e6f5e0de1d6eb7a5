"""The certificate of boundary arcs: repeated integration, multipliers and their signs, and sufficient conditions."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.solution import Certificate, Check, Kind, Solution
from satsym.solvers.certificate import conditions
from satsym.solvers.certificate.competitors import comparing
from satsym.solvers.certificate.competitors.comparison import Comparison, summed
from satsym.solvers.certificate.conclusion import (
    HAMILTONIAN,
    OF_FLOW,
    OF_SEGMENTS,
    concluded,
    unmeasured,
)
from satsym.solvers.certificate.conditions import DEFECT, DRIFT, RESIDUAL
from satsym.solvers.certificate.constrained.passing import drifting, passing
from satsym.solvers.certificate.constrained.replay import Piece, Replay, replay
from satsym.solvers.certificate.constrained.second_variation import curvature
from satsym.solvers.certificate.constrained.variants import near
from satsym.solvers.certificate.reintegration.flow import FAINT_COSTATE, Flow, typical
from satsym.solvers.constrained.active import control, deciding, multipliers
from satsym.solvers.constrained.arcs import holds_control, sizes, values
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.constrained.law import smallest_curvature, stationary
from satsym.solvers.constrained.structure import FREE, within
from satsym.solvers.constrained.violation import VIOLATED
from satsym.solvers.iteration import MOST_ITERATIONS, Limits
from satsym.solvers.search.tried import Past

NAMES = {OF_FLOW: OF_SEGMENTS}
"""Name of a check for an integration from the initial costates -> its name if the integration is done part by part."""

SIGN = 1e-9
"""Largest magnitude of a negative multiplier, relative to the largest multiplier, that counts as rounding."""

CURVED = 1e-7
"""Minimum second variation with fixed active arcs, relative to that of the control cost alone. Below it the sufficient
condition counts as violated."""

STRICT, BESIDE = 1e-6, 1e-6
"""``STRICT`` is the smallest multiplier that counts as strictly positive, relative to the largest. ``BESIDE`` is the
fraction of an arc next to its entry and exit that is left out of this test."""


def certify(
    solution: Solution, deadline: float, past: Past | None = None, compared: bool = True
) -> tuple[Certificate, Solution | None]:
    """Certify an extremal with boundary arcs, see :func:`satsym.solvers.certificate.verdict.examined`."""
    with np.errstate(all="ignore"):
        followed = _followed(solution)
        if followed is None:
            return unmeasured("flow from the initial costates is finite"), None
        first, again = followed
        curved = _legendre_clebsch(solution, again)
        second: list[Check] = []
        others = Comparison((), ())
        if all(c.passed for c in first):
            second = [Check("legendre-clebsch", float(not curved > 0.0), 0.0)]
            if convex(solution.instance):
                second.append(Check("not convex", 0.0, 0.0))
            elif all(c.passed for c in second):
                second += _sufficient(solution, again)
                if compared:
                    others = comparing.compared(solution, Limits(MOST_ITERATIONS, deadline), past)
                    if again.meets_a_boundary(solution):
                        others = others.joined(_of_other_structures(solution, deadline))
    return concluded(first, second, curved, others, compared=compared), others.better


def _of_other_structures(solution: Solution, deadline: float) -> Comparison:
    """Compare a solution with extremals whose sequence of boundary arcs is similar to its own."""
    count, costs, late = near(solution, deadline)
    found = summed(solution, Kind.ARCS, count, costs, late)
    return Comparison((found,), () if count and not late else (Kind.ARCS,))


def _legendre_clebsch(solution: Solution, again: Replay) -> float:
    """Return the smallest curvature of H with respect to the controls that keep active constraints."""
    if not stationary(solution.instance):
        return conditions.legendre_clebsch(solution)
    found = []
    for p in again.pieces:
        held = tuple(k for k in p.active if holds_control(solution.instance, k))
        found.append(smallest_curvature(solution.instance, held, solution.times[p.nodes], p.z))
    return min(found)


def _followed(solution: Solution) -> tuple[list[Check], Replay] | None:
    """Integrate a solution again and check the first-order conditions; ``None`` if no integration is finite.

    The conditions are checked along one flow or, if these fail there by the growth of rounding, part by part. The gap
    between a part and the beginning of the next one must not exceed the tolerance of the boundary residual.
    """
    whole = replay(solution, most=DEFECT)
    if whole is not None:
        checks = _first_order(solution, whole)
        if all(c.passed for c in checks):
            return checks, whole
    parts = replay(solution, in_segments=True)
    if parts is not None:
        renamed = [replace(c, name=NAMES.get(c.name, c.name)) for c in _first_order(solution, parts)]
        checks = [*renamed, Check("gaps where the integration restarts", parts.gap, RESIDUAL)]
        if all(c.passed for c in checks):
            return checks, parts
    whole = replay(solution)  # to its end, which shows how far it is from the solution
    return None if whole is None else (_first_order(solution, whole), whole)


def _first_order(solution: Solution, again: Replay) -> list[Check]:
    off_law, more = _stationarity(solution, again), more_at_end(solution, again)
    checks = conditions.first_order(solution, again.flow(solution), off_law=off_law, constant=False, more=more)
    checks[1] = Check(OF_FLOW, _defect(solution, again), DEFECT)  # before the jump at the end
    checks.append(Check("path constraint violated", _violated(solution, again), VIOLATED))
    if again.meets_a_boundary(solution):
        checks += [
            Check("distance from the boundary on a boundary arc", _off_boundary(solution, again), VIOLATED),
            Check("deviation from tangency at junctions", _off_tangency(solution, again), DEFECT),
            Check("negative multiplier", _negative(solution, again), SIGN),
        ]
    if any(again.jumps):
        checks.append(
            Check("jump of the costates that is not along the constraint's gradient", again.off_gradient, DEFECT)
        )
    checks += passing(solution, again)
    drift = _drift(solution, again)
    return checks if drift is None else [*checks, Check(HAMILTONIAN, drift, DRIFT)]


def _sufficient(solution: Solution, again: Replay) -> list[Check]:
    """Return checks of sufficient conditions, each with a value that is positive if it fails."""
    least, most = _least_multiplier(solution, again, strict=True)
    strict = least > STRICT * most and min(_pushed(solution, again, tent=True), default=np.inf) > STRICT
    vanishing = [Check("a multiplier vanishes on a boundary arc", float(not strict), 0.0)]
    vanishing = vanishing if again.meets_a_boundary(solution) else []
    if solution.instance.tf is None and (again.pressed or again.pieces[-1].active):
        return [
            *vanishing,
            Check("second variation not resolved: the motion ends on a boundary at a free time", 1.0, 0.0),
        ]
    return [
        *vanishing,
        Check("second variation with fixed active arcs", float(not curvature(solution, again) > CURVED), 0.0),
    ]


def _controls(solution: Solution, piece: Piece) -> tuple[Array, Array, Array]:
    """Return times, states and controls on an arc, at the nodes and between them."""
    u = control(solution.instance, piece.active, piece.times, piece.dense)
    return piece.times, piece.dense[: len(solution.x)], u


def _stationarity(solution: Solution, again: Replay) -> float:
    """Return the largest relative difference of the control from the minimiser of H on the active constraints."""
    z = np.concatenate([solution.x, solution.lam])
    parts = [control(solution.instance, p.active, solution.times[p.nodes], z[:, p.nodes]) for p in again.pieces]
    law = np.concatenate(parts, axis=1)
    size = max(float(np.abs(solution.u).max()), float(np.abs(law).max()))
    return float(np.abs(law - solution.u).max() / size) if size > 0.0 else 0.0


def more_at_end(solution: Solution, again: Replay) -> float:
    """Return H at the final time under the control of the last arc less H under the unconstrained control law."""
    instance, model, n = solution.instance, solution.instance.model, len(solution.x)
    t, z, p = solution.times[-1:], again.end[:, None], instance.parameters
    law = model.control_law_batch(t, z[:n], z[n:], p, instance.control_set.arguments)
    ours, other = (
        float(np.asarray(model.hamiltonian_batch(t, z[:n], u, z[n:], p)).sum())
        for u in (control(instance, again.pieces[-1].active, t, z), np.asarray(law))
    )
    return ours - other


def _defect(solution: Solution, again: Replay) -> float:
    """Return the largest distance of the solver's states and costates from the flow, relative to their magnitudes."""
    mine = np.concatenate([solution.x, solution.lam])
    return float((np.abs(mine - again.z).max(axis=1) / np.concatenate(typical(solution, FAINT_COSTATE))).max())


def _sizes(solution: Solution, again: Replay) -> Array:
    """Return the largest magnitudes of the constraints along the motion, shape (h,)."""
    return np.asarray(np.max([sizes(solution.instance, *_controls(solution, p)) for p in again.pieces], axis=0))


def _violated(solution: Solution, again: Replay) -> float:
    """Return the largest violation of a path constraint along the flow, relative to the constraint's magnitude."""
    found = [values(solution.instance, *_controls(solution, p)).max(axis=1) for p in again.pieces]
    return max(0.0, float((np.max(found, axis=0) / _sizes(solution, again)).max(initial=0.0)))


def _off_boundary(solution: Solution, again: Replay) -> float:
    """Return the largest distance from the boundary on boundary arcs, relative to the constraint's magnitude."""
    sizes, worst = _sizes(solution, again), 0.0
    for piece in again.pieces:
        g = values(solution.instance, *_controls(solution, piece))
        worst = max([worst, *(float(np.abs(g[k]).max() / sizes[k]) for k in piece.active)])
    return float(worst)


def _off_tangency(solution: Solution, again: Replay) -> float:
    """Return the largest deviation from tangency at entries and touch points, relative to the constraint's magnitude.

    The deviation is the value of the constraint or its rate times the duration. For a constraint that involves the
    control it is the quantity whose sign decides whether the constraint is active, also at exits unless another arc
    follows directly.
    """
    instance, n, sizes, worst = solution.instance, len(solution.x), _sizes(solution, again), 0.0
    lasting = float(solution.times[-1] - solution.times[0])
    last = tuple(one for one in solution.events if one.t >= solution.times[-1])
    for group, piece in zip([*within(solution), last], again.pieces, strict=True):
        if any(one.kind == "interior" for one in group):  # where controls may jump
            continue
        begun = {one.name for one in group if one.kind != "exit"}
        for event in group:
            which, t, z = _number(solution, event.name), piece.times[-1:], piece.z[:, -1:]
            if holds_control(instance, which):
                if event.kind == "exit" and begun:  # what follows it directly says where
                    continue
                found = [abs(float(deciding(instance, piece.active, which, t, z)[0]))]
            elif event.kind == "exit":
                continue
            else:
                found = [abs(float(values(instance, t, z[:n], control(instance, FREE, t, z))[which, 0]))]
            if instance.model.spec.path_constraints[which].order > 1 and event.t < solution.times[-1]:
                found.append(abs(_rates(solution, piece, -1)[which, 0]) * lasting)
            worst = max(worst, max(found) / sizes[which])
    return float(worst)


def _number(solution: Solution, name: str) -> int:
    return [one.name for one in solution.instance.model.spec.path_constraints].index(name)


def _rates(solution: Solution, piece: Piece, place: int) -> Array:
    """Return first and second time derivatives of all constraints at one end of an arc, shape (h, 2)."""
    instance, n = solution.instance, len(solution.x)
    t, z = np.array([piece.times[place]]), piece.z[:, [place]]
    u = control(instance, FREE, t, z)
    return np.asarray(instance.model.path_rates_batch(t, z[:n], u, instance.parameters)).reshape(-1, 2)


def _multipliers(solution: Solution, again: Replay) -> list[Array]:
    """Return the multipliers eta along each arc, one array for each active constraint on states alone."""
    found = list[Array]()
    for piece in again.pieces:
        states = [place for place, k in enumerate(piece.active) if not holds_control(solution.instance, k)]
        if states:
            found += list(multipliers(solution.instance, piece.active, piece.times, piece.dense)[states])
    return found


def _pushed(solution: Solution, again: Replay, tent: bool) -> list[float]:
    """Return for each control constraint the minimum, on its active arcs, of the value it would have if inactive.

    Parameters
    ----------
    tent
        Whether this value is divided by the fraction of the arc since the entry or until the exit, where it vanishes.
    """
    instance, found, sizes = solution.instance, list[float](), _sizes(solution, again)
    for which in {k for piece in again.pieces for k in piece.active if holds_control(instance, k)}:
        for pieces in _runs(again.pieces, which):
            t = np.concatenate([piece.times for piece in pieces])
            push = [deciding(instance, piece.active, which, piece.times, piece.dense) for piece in pieces]
            found.append(_least_push(solution, t, np.concatenate(push) / sizes[which], tent))
    return found


def _runs(pieces: list[Piece], which: int) -> list[list[Piece]]:
    """Return groups of consecutive arcs on which a constraint stays active."""
    together = groupby(pieces, key=lambda piece: which in piece.active)
    return [list(group) for active, group in together if active]


def _least_push(solution: Solution, t: Array, push: Array, tent: bool) -> float:
    """Return the minimum, over an active interval, of the value that a constraint would have if inactive."""
    (begin, end), (a, b) = solution.times[[0, -1]], t[[0, -1]]
    if tent:
        share = np.minimum(t - a if a > begin else np.inf, b - t if b < end else np.inf) / (b - a)
        push = (push / np.minimum(share, 1.0))[share > BESIDE]
    return float(push.min())


def _negative(solution: Solution, again: Replay) -> float:
    """Return the largest negative multiplier along an arc or at a junction, relative to the largest multiplier.

    For control constraints, the value that they would have if inactive takes the place of the multiplier, relative to
    the constraint's magnitude.
    """
    least, most = _least_multiplier(solution, again, strict=False)
    return max(0.0, float(-least / most), -min(_pushed(solution, again, tent=False), default=0.0))


def _least_multiplier(solution: Solution, again: Replay, strict: bool) -> tuple[float, float]:
    """Return the smallest multiplier and the largest magnitude of any; at junctions, multipliers over the duration.

    Only constraints on states alone count; infinite and 1 if none of them is ever active.

    Parameters
    ----------
    strict
        Whether to leave out multipliers at junctions that need not be positive because another constraint becomes
        active or inactive there.
    """
    lasting, spec = float(solution.times[-1] - solution.times[0]), solution.instance.model.spec.path_constraints
    jumps = list[float]()
    for group, own in zip(within(solution), again.jumps, strict=True):
        met = {_number(solution, event.name) for event in group if event.kind != "interior"}
        own = {k: zeta for k, zeta in own.items() if k < len(spec)}  # those of points on the way have any sign
        jumps += [zeta / lasting for k, zeta in own.items() if (k in met and spec[k].order > 1) or not strict]
    jumps += [zeta / lasting for zeta in again.pressed.values()]
    along = [float(eta.min()) for eta in _multipliers(solution, again)]
    sizes = [float(np.abs(eta).max()) for eta in _multipliers(solution, again)]
    return float(min([*jumps, *along], default=np.inf)), float(max([*map(abs, jumps), *sizes], default=1.0)) or 1e-300


def _drift(solution: Solution, again: Replay) -> float | None:
    """Return the largest change of H along the flow, relative to its terms; ``None`` if the problem depends on time."""
    instance, n, t = solution.instance, len(solution.x), solution.times
    parts = [control(instance, one.active, t[one.nodes], again.z[:, one.nodes]) for one in again.pieces]
    u, flow = np.concatenate(parts, axis=1), Flow(t, again.z[:n], again.z[n:], again.cost)
    moving: Any = t + 1e-30j
    explicit = np.imag(values(instance, moving, flow.x, u)).any()
    if not instance.model.spec.autonomous or explicit or drifting(solution, again):
        return None
    return conditions.hamiltonian_drift(solution, flow, u)
