"""From measured conditions to a verdict."""

from __future__ import annotations

import numpy as np

from satsym.instance.unknowns import Unknown
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Certificate, Check, Solution
from satsym.solvers import revolutions
from satsym.solvers.certificate import conditions, free_start, jumps
from satsym.solvers.certificate.competitors import comparing
from satsym.solvers.certificate.competitors.comparison import Comparison
from satsym.solvers.certificate.conclusion import (
    OF_NODES,
    OF_SEGMENTS,
    concluded,
    unmeasured,
)
from satsym.solvers.certificate.conditions import DEFECT, RESIDUAL, correction, node_by_node
from satsym.solvers.certificate.end_limits import with_limits
from satsym.solvers.certificate.jacobi import Conjugate, conjugate
from satsym.solvers.certificate.kernel_consistency import with_kernels_examined
from satsym.solvers.certificate.reintegration.closed_flow import closed_flow
from satsym.solvers.certificate.reintegration.flow import TOLERANCE, flow
from satsym.solvers.certificate.reintegration.node_defect import node_defect
from satsym.solvers.certificate.reintegration.segments import Segments, segments
from satsym.solvers.certificate.scope import with_scope
from satsym.solvers.certificate.start import settled, with_start
from satsym.solvers.certificate.stated_times import with_stated_times
from satsym.solvers.iteration import MOST_ITERATIONS, Limits, deadline_of


def certify(solution: Solution, compared: bool = True) -> Certificate | None:
    """Certify a solution; ``None`` where there is nothing to certify.

    Parameters
    ----------
    compared
        Whether competitors are looked for.

    Returns
    -------
    Certificate
        ``certified``: a strict local optimum, with no cheaper competitor among the kinds that it lists.
        ``local minimum``: the same where none was looked for.
        ``extremal only``: the first-order conditions hold, a sufficient one does not. ``failed``: not even the
        former hold.
    """
    return examined(solution, deadline_of(solution.instance), compared=compared)[0]


def examined(
    solution: Solution, deadline: float, seed: int = 0, *, compared: bool = True
) -> tuple[Certificate | None, Solution | None]:
    """The certificate of a solution, and the cheapest competitor if one is cheaper than it.

    Parameters
    ----------
    deadline
        On the clock of :func:`~satsym.solvers.iteration.computed`; what is not compared by then is said.
    seed
        Of starts that are drawn.
    compared
        Whether competitors are looked for.
    """
    if not solution.status.answered:
        return None, None
    given = settled(solution)
    certificate, competitor = _judged(given, deadline, seed, compared, solution.instance.free)
    certificate = with_stated_times(with_limits(with_kernels_examined(certificate, given), given), given)
    if solution.instance.free:
        certificate = with_start(certificate, solution, free_start.curvature(solution).checks)
    return with_scope(certificate, solution), competitor


def _judged(
    solution: Solution, deadline: float, seed: int, compared: bool, free: tuple[Unknown, ...]
) -> tuple[Certificate, Solution | None]:
    """The certificate that the kernels give, whatever they are worth, and the cheapest competitor.

    Parameters
    ----------
    solution
        With its start given.
    free
        What competitors may choose besides.
    """
    solution = revolutions.as_stated(solution)
    if solution.interval is not None:
        from satsym.solvers.certificate.switching import chattering

        with np.errstate(all="ignore"):
            return chattering.certify(solution, solution.interval), None
    if comparing.switching(solution):
        from satsym.solvers.certificate.switching import conditions as of_arcs

        with np.errstate(all="ignore"):
            return of_arcs.certify(solution, deadline, compared, seed)
    if solution.method == BOUNDARY_ARCS:
        from satsym.solvers.certificate.constrained import conditions as constrained

        return constrained.certify(solution, deadline, seed, compared)
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
                others = comparing.compared(solution, Limits(MOST_ITERATIONS, deadline), seed, free)
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
    """What is measured along the flow from the initial costates, or node by node where that flow can tell nothing.

    So it is where it misses, and its own rounding grows beyond what may be missed. Empty where neither is finite.
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
    """Each is a deficit that must not be positive."""
    return [
        Check("legendre-clebsch", float(not legendre > 0.0), 0.0),
        *jumps.checks(solution),
        *field.checks,
    ]
