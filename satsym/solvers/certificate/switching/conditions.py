"""The certificate of exact arcs: repeated integration, strict switching, second variation and competitors."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Certificate, Check, Solution
from satsym.solvers.certificate import conditions
from satsym.solvers.certificate.competitors.comparing import compared
from satsym.solvers.certificate.competitors.comparison import Comparison
from satsym.solvers.certificate.competitors.searched import kinds
from satsym.solvers.certificate.conclusion import concluded, unmeasured
from satsym.solvers.certificate.conditions import RESIDUAL, STATIONARY
from satsym.solvers.certificate.reintegration.flow import Flow, typical
from satsym.solvers.certificate.switching import boundaries, singular
from satsym.solvers.certificate.switching.convexity import convex
from satsym.solvers.certificate.switching.end_switches import with_end_switches
from satsym.solvers.certificate.switching.integration import Integration, OutOfTime, Span, TooMuchWork
from satsym.solvers.certificate.switching.next_switch import noise
from satsym.solvers.certificate.switching.replay import EVALUATIONS, Replay, replay
from satsym.solvers.certificate.switching.second_variation import curvature
from satsym.solvers.certificate.switching.stated_arcs import UNDECIDED, decided_by_none
from satsym.solvers.control.slopes import undecided
from satsym.solvers.failures import tried
from satsym.solvers.iteration import MOST_ITERATIONS, Limits
from satsym.solvers.search.tried import Past
from satsym.solvers.switching.boundary import BoundaryField
from satsym.solvers.switching.linear.linear_motion import linear_motion
from satsym.solvers.switching.structure import SINGULAR
from satsym.solvers.switching.throttled import shown_by, signs
from satsym.status import Verdict

TIMES = 1e-9
"""Largest change of switching times, relative to the duration, between solution and repeated integration."""

STRICT = 1e-6
"""Minimum rate of a switching function at a switch, relative to its magnitude over the duration; also the minimum
relative distance between switches, and the minimum relative distance of a switching function from its zero elsewhere.
Below them switching does not count as strict."""

CLOSE_TO_SWITCH = 0.01
"""Fraction of the duration around a switch within which small values of a switching function are not tested."""

CURVED = 1e-7
"""Minimum relative curvature in the switching times for which the second variation counts as positive."""

UNPROVED = "no proof of a minimum along singular arcs: the problem is not convex"
IN_DIRECTIONS = "second variation with respect to arc lengths and directions"
ALONG_SINGULAR = "second variation along singular arcs"
"""Names of checks."""

LATER = Check("not strict: the same arcs at a later time have the same cost", 1.0, 0.0)
"""Check that names a shift in time as the only reason why a second variation is not positive."""


def certify(
    solution: Solution, deadline: float, compare: bool = True, past: Past | None = None
) -> tuple[Certificate, Solution | None]:
    """Certify an extremal in exact arcs, see :func:`satsym.solvers.certificate.certify`.

    Returns the certificate, and a cheaper extremal or ``None``.
    """
    limits = Limits(MOST_ITERATIONS, deadline)
    try:
        again, failed = replay(solution, limits), "flow from the initial costates is finite"
    except TooMuchWork:
        again, failed = None, f"flow from the initial costates is integrated within {EVALUATIONS} evaluations"
    except OutOfTime:
        late = "not checked within the time limit: flow from the initial costates"
        return unmeasured(late, Verdict.EXTREMAL_ONLY, tuple(kinds(solution.instance))), None
    first = [] if again is None else _first_order(solution, again)
    if not first or not all(c.passed for c in first):
        again, first = _closely(solution, limits) or (again, first)
    if again is None:
        return unmeasured(failed), None
    second: list[Check] = []
    others = Comparison()
    if all(c.passed for c in first):
        second = _sufficient(solution, again, limits)
        others = compared(solution, limits, past) if compare else others
    return concluded(first, second, _legendre(again), others, compared=compare), others.better


def _closely(solution: Solution, limits: Limits) -> tuple[Replay, list[Check]] | None:
    """Integrate again part by part and check the first-order conditions; ``None`` if this fails as well.

    This is used if errors grow too much along one flow.
    """
    try:
        again = replay(solution, limits, closely=True)
    except (TooMuchWork, OutOfTime):
        return None
    if again is None:
        return None
    first = [Check("gaps where the integration restarts", again.gap, RESIDUAL), *_first_order(solution, again)]
    return (again, first) if all(c.passed for c in first) else None


def _first_order(solution: Solution, again: Replay) -> list[Check]:
    n = len(solution.x)
    flow, constant = Flow(again.times, again.z[:n], again.z[n:], again.cost), boundaries.still(again)
    checks = conditions.first_order(solution, flow, off_law=_excess(solution), u=again.u, constant=constant)
    checks.insert(2, Check("switching times", _moved(solution, again), TIMES))
    own = list[Check]()
    if any(piece.field.kept is not None for piece in again.pieces):
        own.append(Check("switching function on singular arcs", _off_singular(solution, again), STATIONARY))
    if solution.instance.model.spec.path_constraints:
        own += boundaries.necessary(solution, again)
    checks[6:6] = own
    return checks


def _sufficient(solution: Solution, again: Replay, limits: Limits) -> list[Check]:
    """Return checks of sufficient conditions, each with a value that is positive if it fails."""
    free = [decided_by_none(solution, control) for control in range(len(shown_by(solution.instance)))]
    extended = with_end_switches(again, _along(again)[0])
    rates, gap, distance = _strictness(again, extended, free)
    checks = [Check("not strict: other controls have the same cost", 1.0, 0.0)] if any(free) else []
    if _decided_by_signs(solution, again, free):
        return [Check("switching function vanishes on an arc", float(_vanishes(solution, again, extended)), 0.0)]
    checks += [
        Check("strict bang-bang condition", float(not rates > STRICT), 0.0),
        Check("coinciding switching times", float(not gap > STRICT), 0.0),
        Check("switching function vanishes on an arc", float(not distance > STRICT), 0.0),
    ]
    if any(SINGULAR in piece.field.levels for piece in again.pieces):
        checks.append(Check("generalised legendre-clebsch", float(not _legendre(again) > 0.0), 0.0))
        checks += _along_singular(solution, again, extended, limits)
    elif boundaries.on_boundary(again) and boundaries.jumping(again):
        checks.append(Check("not resolved: second variation where costates jump", 1.0, 0.0))
    elif (throttled := solution.instance.model.spec.throttled) or not any(free):
        checks += boundaries.strict(again) if boundaries.on_boundary(again) else []
        checks += _in_times(solution, extended, limits, *([IN_DIRECTIONS] if throttled else []))
    return checks


def _along_singular(solution: Solution, again: Replay, extended: Replay, limits: Limits) -> list[Check]:
    """Return checks that singular arcs are optimal: by convexity, or else by the second variation."""
    spec, proved, bounded = solution.instance.model.spec, convex(solution), boundaries.on_boundary(again)
    met = {piece.field.constraint for piece in again.pieces if isinstance(piece.field, BoundaryField)}
    simple = len(met) <= 1 and all(spec.path_constraints[k].order == 1 for k in met)
    unknown = spec.throttled or not singular.single(again) or not simple
    if proved or unknown or (bounded and boundaries.jumping(again)):
        return [Check(UNPROVED, float(not proved), 0.0)]
    checks = [Check("singular control at its bound", float(not singular.inside(again) > STRICT), 0.0)]
    if not bounded:
        return [*checks, *_in_times(solution, extended, limits, ALONG_SINGULAR)]
    checks.append(Check("control continuous at a junction", float(not singular.jumped(again) > STRICT), 0.0))
    name = "second variation along singular and boundary arcs"
    return [*checks, *boundaries.strict(again), *_in_times(solution, extended, limits, name)]


def _in_times(
    solution: Solution,
    extended: Replay,
    limits: Limits,
    name: str = "second variation with respect to the switching times",
) -> list[Check]:
    """Return checks of the second variation in junction times and in the variations of controls within arcs."""
    try:
        least, form = curvature(solution, extended, Integration(np.concatenate(typical(solution)), limits))
    except TooMuchWork:
        return [Check(f"{name} is integrated within {EVALUATIONS} evaluations", 1.0, 0.0)]
    except OutOfTime:
        return [Check(f"not checked within the time limit: {name}", 1.0, 0.0)]
    flat = not least > CURVED
    return [Check(name, float(flat), 0.0), *([LATER] if flat and form.flat_by_shift(CURVED) else [])]


def _decided_by_signs(solution: Solution, again: Replay, free: list[bool]) -> bool:
    """Return whether signs of the switching functions suffice: the problem is convex and every arc is saturated.

    No admissible motion costs less than such an extremal, and one of the same cost has the same control wherever the
    switching function is not zero (Mangasarian, see :func:`convex`). The rate at its zeros and at the final time may
    then vanish.
    """
    if any(free) or solution.instance.model.spec.throttled:
        return False
    saturated = all(piece.field.kept is None for piece in again.pieces) and not boundaries.on_boundary(again)
    return saturated and bool(tried(lambda: convex(solution)))  # it looks at states at which costs may have no value


def _vanishes(solution: Solution, again: Replay, extended: Replay) -> bool:
    """Return whether a switching function vanishes, within integration errors, away from its switches.

    Shortly before a final time at which several of its derivatives vanish it is very small, but larger than these
    errors.
    """
    by = Integration(np.concatenate(typical(solution)), Limits(MOST_ITERATIONS, float("inf")))
    lasting = float(again.times[-1] - again.times[0])
    sizes, marks = _along(again)
    for control, (times, margin) in enumerate(marks):
        for piece in again.pieces:
            own = extended.switching_times(control)
            away = np.min([np.abs(times - t) for t in own], axis=0) if own else np.full(len(times), np.inf)
            here = (times >= piece.start) & (times <= piece.end) & (away > CLOSE_TO_SWITCH * lasting)
            errors = noise(Span(piece.field, piece.start, piece.end, piece.before), control, by, piece.spread)
            if (margin[here] <= max(errors, UNDECIDED * sizes[control])).any():
                return True
    return False


def _moved(solution: Solution, again: Replay) -> float:
    """Return the largest change of a switching time relative to the duration; infinite if their numbers differ."""
    lasting = float(solution.times[-1] - solution.times[0])
    worst = 0.0
    for control, shown in enumerate(shown_by(solution.instance)):
        times = solution.switching_times[shown]
        found = again.switching_times(control)
        if len(found) != len(times):
            return float("inf")
        worst = max([worst, *(abs(a - b) / lasting for a, b in zip(found, times, strict=True))])
    return worst


def _excess(solution: Solution) -> float:
    """Return the largest relative excess of H over its minimum in the box, plus any relative violation of the box."""
    instance, model = solution.instance, solution.instance.model
    p, u = instance.parameters, solution.u
    if model.spec.throttled:
        return _excess_by_law(solution)
    sigma = model.switching_function_batch(solution.times, solution.x, solution.lam, p)
    weight = model.magnitude_weight_batch(solution.times, solution.x, solution.lam, p)
    low, high = instance.control_set.box
    rest = np.minimum(np.maximum(0.0, low), high)
    least = np.min([sigma * v + weight * np.abs(v) for v in np.broadcast_arrays(low, high, rest, u)[:3]], axis=0)
    outside = (np.maximum(np.maximum(low - u, u - high), 0.0) / np.maximum(high - low, 1e-300)).max(initial=0.0)
    excess = (sigma * u + weight * np.abs(u) - least).max(initial=0.0)
    return float(excess / max(_terms(instance, solution.times, solution.x, solution.lam, u), 1e-300) + outside)


def _excess_by_law(solution: Solution) -> float:
    """Return the largest relative excess of H over its minimum for throttled vectors, by the minimising control law."""
    instance, model = solution.instance, solution.instance.model
    t, x, lam, p = solution.times, solution.x, solution.lam, instance.parameters
    law = model.control_law_batch(t, x, lam, p, instance.control_set.arguments)
    law = np.where(np.isnan(law) & undecided(instance, t, x, lam), solution.u, law)
    above = [model.hamiltonian_batch(t, x, u, lam, p) for u in (solution.u, law)]
    size = max(float(np.abs(law).max()), float(np.abs(solution.u).max()), 1e-300)
    outside = max(instance.control_set.violation(solution.u), 0.0) / size
    return float((above[0] - above[1]).max() / max(_terms(instance, t, x, lam, solution.u), 1e-300) + outside)


def _terms(instance: Instance, t: Array, x: Array, lam: Array, u: Array) -> float:
    """Return the largest sum of magnitudes of costates times rates along the solution, a scale of H."""
    rates = instance.model.dynamics_batch(t, x, u, instance.parameters)
    return float(np.abs(lam * rates).sum(axis=0).max())


def _off_singular(solution: Solution, again: Replay) -> float:
    """Return the largest switching function on singular arcs, where it should vanish, relative to its magnitude.

    The magnitude is taken on other arcs or, if it vanishes on all of them, estimated from states and costates.
    """
    sizes, _ = _along(again)
    worst, both = 0.0, np.concatenate(typical(solution))
    for piece in again.pieces:
        control, field = piece.field.kept, piece.field
        if control is not None:
            if all(one.field.kept == control for one in again.pieces):
                sizes[control] = float(np.abs(field.gradient(piece.start, piece.before.tolist(), control)) @ both)
            times, z = again.along(piece)
            sigma = signs(field.instance, times, z[: field.n], z[field.n :])[0][control]
            worst = max(worst, float(np.abs(sigma).max(initial=0.0)) / sizes[control])
    return worst


def _legendre(again: Replay) -> float:
    """Return the minimum generalised Legendre-Clebsch expression on singular arcs; NaN if there is none."""
    values = [
        piece.field.legendre(t, z.tolist())
        for piece in again.pieces
        if piece.field.singular is not None
        for t, z in ((piece.start, piece.before), (piece.end, piece.after))
    ]
    return min(values, default=float("nan"))


def _strictness(again: Replay, extended: Replay, free: list[bool]) -> tuple[float, float, float]:
    """Return minimum rate at switches, minimum time between switches, and minimum distance from zero elsewhere.

    All are relative and concern switching functions. Controls that H does not determine are left out.
    """
    pieces = extended.pieces
    start, end = pieces[0].start, pieces[-1].end
    lasting = end - start
    sizes, marks = _along(again)
    switches = [piece for piece in again.pieces if piece.switched is not None and not free[piece.switched]]
    rates = [float("inf")]
    for k, piece in enumerate(pieces[:-1]):
        control = piece.switched
        assert control is not None
        if free[control] or max(piece.field.levels[control], pieces[k + 1].field.levels[control]) >= SINGULAR:
            continue
        ratio = piece.field.ratio(control, (piece.field.levels[control], pieces[k + 1].field.levels[control]))
        for field in (piece.field, pieces[k + 1].field):
            _, rate = field.passing(piece.end, piece.after.tolist(), control, ratio)
            rates.append(abs(rate) * lasting / sizes[control])
    # In a convex problem switches of different controls may coincide: each of them is decided by its own sign.
    each = [None] if linear_motion(again.pieces[0].field.instance) is None else range(len(free))
    rows = [[piece.end for piece in switches if control in (None, piece.switched)] for control in each]
    gaps = np.concatenate([np.diff([start, *row, end]) for row in rows]) / lasting
    distances = [float("inf")]
    for control, (times, margin) in enumerate(marks):
        if free[control]:
            continue
        own = extended.switching_times(control)
        away = np.min([np.abs(times - t) for t in own], axis=0) if own else np.full(len(times), np.inf)
        far = (away > CLOSE_TO_SWITCH * lasting) & np.isfinite(margin)
        distances.append(float((margin[far] / sizes[control]).min(initial=np.inf)))
    return min(rates), float(gaps.min()), min(distances)


def _along(again: Replay) -> tuple[list[float], list[tuple[Array, Array]]]:
    """Return magnitudes of the switching functions, and their distances from the values at which controls switch."""
    pieces = again.pieces
    n, instance = pieces[0].field.n, pieces[0].field.instance
    sigma, weight = signs(instance, again.times, again.z[:n], again.z[n:])
    low, high = instance.control_set.switching
    sizes = [max(float((np.abs(s) + w).max()), 1e-300) for s, w in zip(sigma, weight, strict=True)]
    singular = np.zeros(sigma.shape, bool)
    for piece in pieces:
        if piece.field.kept is not None:
            singular[piece.field.kept] |= (again.times >= piece.start) & (again.times <= piece.end)
    marks = []
    for i, (s, w) in enumerate(zip(sigma, weight, strict=True)):
        margin = np.abs(np.abs(s) - w)
        marks.append((again.times, np.where(singular[i] | (low[i] == high[i]), np.inf, margin)))
    return sizes, marks
