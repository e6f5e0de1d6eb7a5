"""From measured conditions to a verdict."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import Any

import numpy as np

from satsym.solution import Certificate, Check, Competitors, Kind, Solution
from satsym.solve import revolutions
from satsym.solve.certificate import competitors, conditions
from satsym.solve.certificate.competitors import Compared, Comparison, Rival
from satsym.solve.certificate.flow import Flow, flow
from satsym.solve.certificate.neighbours import neighbours
from satsym.solve.collocation.scaling import final_argument
from satsym.status import Verdict

RESIDUAL, DEFECT, STATIONARY, DRIFT, COST = 1e-9, 1e-7, 1e-8, 1e-9, 1e-8
"""Largest boundary residual, defect, violation of stationarity, change of H and error of the stated cost."""

DEARER = 1e-9
"""Relative margin by which a competitor may seem cheaper: its own error."""


def certify(solution: Solution) -> Certificate | None:
    """Certify a solution; ``None`` where there is nothing to certify.

    Returns
    -------
    Certificate
        ``certified``: a strict local optimum, with no cheaper competitor among the kinds that it lists.
        ``extremal only``: the first-order conditions hold, a sufficient one does not. ``failed``: not even the
        former hold.
    """
    return examined(solution, time.perf_counter() + solution.instance.solver.max_seconds)[0]


def examined(solution: Solution, deadline: float, seed: int = 0) -> tuple[Certificate | None, Rival | None]:
    """The certificate of a solution, and the cheapest competitor if one is cheaper than it.

    Parameters
    ----------
    solution
        Whatever its status.
    deadline
        On the clock of ``time.perf_counter``; what is not compared by then is said.
    seed
        Of starts that are drawn.
    """
    if not solution.status.answered:
        return None, None
    if solution.instance.model.spec.switching:
        from satsym.solve.certificate import switching

        with np.errstate(all="ignore"):
            return switching.certify(solution), None
    solution = revolutions.as_stated(solution)
    with np.errstate(all="ignore"):
        recomputed = flow(solution)
        if recomputed is None:
            return _without_flow(), None
        first = _first_order(solution, recomputed)
        second, others = [], Comparison((), ())
        if all(c.passed for c in first):
            second = _sufficient(solution, recomputed)
            others = _compared(solution, deadline, seed)
            second += [_cheaper(kind) for kind in others.kinds]
            second += [Check(f"time was up before: {kind.value}", 1.0, 0.0) for kind in others.interrupted]
    verdict = Verdict.of(all(c.passed for c in first), all(c.passed for c in second))
    measured: dict[str, Any] = {c.name: c.value for c in (*first, *second)}
    certificate = Certificate(
        verdict=verdict,
        boundary_residual=measured["boundary residual"],
        dynamics_defect=measured["dynamics defect"],
        stationarity=measured["stationarity"],
        hamiltonian_drift=measured.get("hamiltonian drift"),
        legendre_clebsch=conditions.legendre_clebsch(solution),
        conjugate_time=conditions.conjugate_time(recomputed),
        checks=(*first, *second),
        competitors=tuple(kind.summary for kind in others.kinds),
        not_checked=others.not_checked,
    )
    return certificate, others.better


def _compared(solution: Solution, deadline: float, seed: int) -> Comparison:
    """With competitors, unless none can be cheaper."""
    if competitors.none_conceivable(solution):
        return Comparison((), ())
    near = neighbours(solution)
    found = competitors.compared(solution, deadline, seed)
    summary = Competitors(Kind.NEIGHBOURS, 1, int(math.isfinite(near)), float("nan"))
    return replace(found, kinds=(Compared(summary, near, None, False), *found.kinds))


def _cheaper(found: Compared) -> Check:
    """That no competitor of a kind is cheaper."""
    return Check(f"cheaper by: {found.summary.kind.value}", max(0.0, -found.margin), DEARER)


def _first_order(solution: Solution, recomputed: Flow) -> list[Check]:
    model = solution.instance.model
    checks = [
        Check("boundary residual", conditions.boundary_residual(solution, recomputed), RESIDUAL),
        Check("dynamics defect", conditions.dynamics_defect(solution, recomputed), DEFECT),
        Check("stationarity", conditions.stationarity(solution), STATIONARY),
        Check("cost", conditions.off_cost(solution, recomputed), COST),
        Check("outside the domain", float(not model.in_domain(recomputed.x)), 0.0),
    ]
    drift = conditions.hamiltonian_drift(solution, recomputed)
    return checks if drift is None else [*checks, Check("hamiltonian drift", drift, DRIFT)]


def _sufficient(solution: Solution, recomputed: Flow) -> list[Check]:
    """Each is a deficit that must not be positive."""
    fixed = np.array(final_argument(solution.instance)).reshape(3, -1)[:2].any(axis=0)
    time = conditions.conjugate_time(recomputed)
    checks = [
        Check("legendre-clebsch", float(not conditions.legendre_clebsch(solution) > 0.0), 0.0),
        Check("conjugate times", 0.0 if time is None else 1.0, 0.0),
    ]
    if not fixed.all():
        checks.append(
            Check("curvature in the free end", float(not conditions.negative_end(solution, recomputed) > 0.0), 0.0)
        )
    return checks


def _without_flow() -> Certificate:
    missing = float("nan")
    check = Check("flow from the initial costates is finite", 1.0, 0.0)
    return Certificate(Verdict.FAILED, missing, missing, missing, None, missing, None, (check,))
