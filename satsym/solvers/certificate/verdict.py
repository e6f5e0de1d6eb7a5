"""Derivation of a certificate's verdict from the measured conditions."""

from __future__ import annotations

import numpy as np

from satsym.arrays import distinct
from satsym.instance.unknowns import Unknown
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Certificate, Check, Solution
from satsym.solvers import revolutions
from satsym.solvers.certificate import conditions, free_start
from satsym.solvers.certificate.competitors import comparing
from satsym.solvers.certificate.competitors.comparison import Comparison
from satsym.solvers.certificate.conclusion import OF_NODES, OF_SEGMENTS, concluded, unmeasured
from satsym.solvers.certificate.conditions import DEFECT, RESIDUAL, correction, node_by_node
from satsym.solvers.certificate.end_limits import with_limits
from satsym.solvers.certificate.jacobi import Conjugate, conjugate
from satsym.solvers.certificate.kernel_consistency import with_kernels_examined
from satsym.solvers.certificate.reintegration.closed_flow import closed_flow
from satsym.solvers.certificate.reintegration.flow import TOLERANCE, flow, unit_sizes
from satsym.solvers.certificate.reintegration.node_defect import node_defect
from satsym.solvers.certificate.reintegration.passages import passages
from satsym.solvers.certificate.reintegration.segments import Segments, segments
from satsym.solvers.certificate.scope import with_scope
from satsym.solvers.certificate.start import settled, with_start
from satsym.solvers.certificate.stated_times import with_stated_times
from satsym.solvers.iteration import MOST_ITERATIONS, Limits, deadline_of
from satsym.solvers.search.tried import Past

CROSSED = 1e-9
"""Minimum rate at which one minimiser of H overtakes another, relative to the change of the rates at the jump. Below
it, both minimisers stay equally good after the jump."""

LOOKED_AT, GRID = 9, 201
"""Number of times within a solution, and of values of a control, at which other minimisers of H are searched for."""

EQUAL, OTHER_CONTROL = 1e-9, 1e-3
"""Largest difference of H, relative to its range, between equally good minimisers; and minimum difference of a control,
relative to its range, that counts as another minimiser."""


def certify(solution: Solution, compared: bool = True) -> Certificate | None:
    """Certify a solution; ``None`` if it has no answer to certify.

    Parameters
    ----------
    compared
        Whether competitors are looked for.

    Returns
    -------
    Certificate
        ``certified``: a strict local optimum, with no cheaper competitor among the kinds that it lists.
        ``local minimum``: the same, but competitors were not looked for. ``extremal only``: the first-order conditions
        hold, but a sufficient condition does not. ``failed``: a first-order condition does not hold.
    """
    return examined(solution, deadline_of(solution.instance), compared=compared)[0]


def examined(
    solution: Solution, deadline: float, past: Past | None = None, *, compared: bool = True
) -> tuple[Certificate | None, Solution | None]:
    """Return the certificate of a solution, and the cheapest competitor if it is cheaper than the solution.

    Parameters
    ----------
    deadline
        Deadline on the clock of :func:`~satsym.solvers.iteration.computed`; the certificate lists what was not
        compared.
    past
        Results found beside earlier answers; new results are added to it.
    compared
        Whether competitors are looked for.
    """
    if not solution.status.answered:
        return None, None
    given = settled(solution)
    certificate, competitor = _judged(given, deadline, past, compared, solution.instance.free)
    certificate = with_stated_times(with_limits(with_kernels_examined(certificate, given), given), given)
    if solution.instance.free:
        certificate = with_start(certificate, solution, free_start.curvature(solution).checks)
    return with_scope(certificate, solution), competitor


def _judged(
    solution: Solution, deadline: float, past: Past | None, compared: bool, free: tuple[Unknown, ...]
) -> tuple[Certificate, Solution | None]:
    """Return the certificate and the cheapest competitor, without a test whether the kernels are consistent.

    Parameters
    ----------
    solution
        Solution with its initial values given.
    free
        Initial states, initial time and parameters that competitors may choose as well as the final state.
    """
    solution = revolutions.as_stated(solution)
    if solution.interval is not None:
        from satsym.solvers.certificate.switching import chattering

        with np.errstate(all="ignore"):
            return chattering.certify(solution, solution.interval), None
    if comparing.switching(solution):
        from satsym.solvers.certificate.switching import conditions as of_arcs

        with np.errstate(all="ignore"):
            return of_arcs.certify(solution, deadline, compared, past)
    if solution.method == BOUNDARY_ARCS:
        from satsym.solvers.certificate.constrained import conditions as constrained

        return constrained.certify(solution, deadline, past, compared)
    with np.errstate(all="ignore"):
        along = segments(solution)
        first = _first_order(solution, along)
        if not first:
            return unmeasured("flow from the initial costates is finite"), None
        if solution.instance.model.spec.path_constraints:
            from satsym.solvers.constrained.violation import VIOLATED, violation

            first.append(Check("path constraint violated", max(0.0, violation(solution)), VIOLATED))
        field = conjugate(solution, along)
        second: list[Check] = []
        legendre = conditions.legendre_clebsch(solution)
        others = Comparison()
        if all(c.passed for c in first):
            second = _sufficient(solution, legendre, field)
            if compared:
                others = comparing.compared(solution, Limits(MOST_ITERATIONS, deadline), past, free)
    certificate = concluded(
        first,
        second,
        legendre,
        others,
        compared=compared,
        conjugate_time=field.time,
    )
    return certificate, others.better


def _first_order(solution: Solution, along: Segments | None) -> list[Check]:
    """Return checks of first-order conditions along the flow from the initial costates, or node by node.

    The latter is used if the flow fails them and its own rounding grows beyond the tolerances. The list is empty if
    neither flow is finite.
    """
    recomputed = (along and closed_flow(solution, along)) or flow(solution)
    checks = conditions.first_order(solution, recomputed) if recomputed else []
    if checks:
        checks.append(Check(OF_NODES, node_defect(solution), DEFECT))
    if (checks and all(c.passed for c in checks)) or along is None or not along.growth * TOLERANCE > RESIDUAL:
        return checks
    reached = node_by_node(solution, along)
    if reached is None:
        return checks
    moved = Check("correction of the nodes", correction(solution, along, reached), DEFECT)
    return [*conditions.first_order(solution, reached, OF_SEGMENTS), moved]


def _sufficient(solution: Solution, legendre: float, field: Conjugate) -> list[Check]:
    """Return checks of sufficient conditions, each with a value that is positive if it fails."""
    return [
        Check("legendre-clebsch", float(not legendre > 0.0), 0.0),
        *_jump_checks(solution),
        *field.checks,
    ]


def _jump_checks(solution: Solution) -> list[Check]:
    """Return checks of the conditions at jumps of the control under which the second variation is known.

    The value of each check is positive if the check fails.
    """
    every, tied = passages(solution), _ties(solution)
    unknown, unit = sum(not one.located for one in every), unit_sizes(solution)
    crossing = [one.saltation(solution, unit) for one in every if one.located]
    flat = sum(not -one.speed > CROSSED * float(np.abs(one.leap).max()) for one in crossing)
    found = (
        [Check("second variation unknown: the control jumps between minimisers", float(unknown), 0.0)]
        if unknown
        else []
    )
    found += (
        [Check("the two minimisers of H are still equally good after a jump", float(flat), 0.0)] if crossing else []
    )
    return found + ([Check("another minimiser of H remains equally good", float(tied), 0.0)] if tied else [])


def _ties(solution: Solution) -> int:
    """Return the number of intervals between tested times on which another value of a control is equally good for H.

    If this lasts, no control is optimal by itself, since any two may alternate. At single instants it is harmless.
    """
    if not solution.instance.model.spec.stationary:
        return 0
    nodes = distinct(np.linspace(0, solution.times.size - 1, LOOKED_AT + 2).astype(int)[1:-1])
    tied = np.array([_tied(solution, int(node)) for node in nodes])
    return int((tied[1:] & tied[:-1]).sum())


def _tied(solution: Solution, node: int) -> bool:
    """Return whether H has another minimiser at a node when one control is changed at a time."""
    from scipy.optimize import minimize_scalar

    instance, model = solution.instance, solution.instance.model
    t, x, u, lam = solution.times[node], solution.x[:, node], solution.u[:, node], solution.lam[:, node]
    wide = 1.0 + 2.0 * float(np.abs(solution.u).max())
    for k, variable in enumerate(model.spec.controls):
        low, high = max(instance.lower[k], -wide), min(instance.upper[k], wide)

        def h(value: float, k: int = k) -> float:
            return float(model.hamiltonian(t, x, (*u[:k], value, *u[k + 1 :]), lam, instance.parameters))

        grid = np.linspace(low, high, GRID)
        values = np.array([h(value) for value in grid])
        padded = np.pad(values, 1, constant_values=np.inf)
        lowest = np.flatnonzero((values <= padded[:-2]) & (values <= padded[2:]))
        for at in map(int, lowest):
            ends = grid[max(at - 1, 0)], grid[min(at + 1, GRID - 1)]
            other = minimize_scalar(h, bounds=ends, method="bounded", options={"xatol": 1e-10 * (high - low)})
            distance = abs(other.x - u[k])
            if variable.kind == "angle":
                distance = abs(np.remainder(other.x - u[k] + np.pi, 2.0 * np.pi) - np.pi)
            best = min(other.fun, values[at])
            if distance > OTHER_CONTROL * (high - low) and best - h(u[k]) <= EQUAL * np.ptp(values):
                return True
    return False
