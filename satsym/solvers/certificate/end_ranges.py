"""Final states that must lie in ranges: how far they are outside, and how hard the ends press that are met.

At an end of a range the final state is given, and what transversality lacks there, mu = lambda - S_x - nu' psi_x, is
its multiplier: the cost changes by -mu dx, so that at an upper end it must not be negative, nor positive at a lower one
(Karush, Kuhn and Tucker). Where it does not vanish a change into the range costs more to first order; the rest is the
problem with that end given.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.instance.ends import Side
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Certificate, Check, Solution
from satsym.solvers.certificate.end_form import final_values, multipliers
from satsym.solvers.certificate.flow import typical
from satsym.status import Verdict

OUTSIDE = 1e-9
"""Largest distance from a range, relative to the state's size, that is none."""

SIGN, STRICT = 1e-9, 1e-7
"""Largest multiplier of the wrong sign that is none, and least one that does not vanish, relative to the costate."""


def outside(solution: Solution) -> dict[tuple[str, Side], float]:
    """By how much final states are beyond ends of their ranges, relative to the size of each; negative inside.

    An end that is met is not looked at: the boundary residual has it.
    """
    instance, names = solution.instance, solution.instance.model.spec.state_names
    found = {}
    for name, limits in instance.ranges.items():
        row = solution.x[names.index(name)]
        size = max(float(np.abs(row).max()), *(abs(v) for v in limits if np.isfinite(v)))
        for side in Side:
            if np.isfinite(side.of(limits)) and instance.met.get(name) is not side:
                found[name, side] = side.outward * (float(row[-1]) - side.of(limits)) / max(size, 1e-300)
    return found


def pushes(solution: Solution) -> dict[str, float]:
    """Multipliers of the ends that are met, relative to the costates, positive where they hold the state in."""
    instance, spec = solution.instance, solution.instance.model.spec
    if not instance.met:
        return {}
    tf, x, lam = final_values(_after_jump(solution))
    nu, _ = multipliers(instance, tf, x, lam)
    n, arguments = len(x), (instance.parameters, instance.control_set.arguments)
    # what the residual of a free state is
    lacking = np.array(instance.model.boundary(tf, x, lam, nu, *arguments, (0.0,) * 3 * n))[:n]
    slopes = lacking - np.array(lam)
    sizes, found = np.maximum(typical(solution, 0.0)[1], np.abs(slopes)), {}
    for name, side in instance.met.items():
        i = spec.state_names.index(name)
        found[name] = side.outward * float(lacking[i]) / max(float(sizes[i]), 1e-300)
    return found


def _after_jump(solution: Solution) -> Solution:
    """With costates at the end after the jump that a path constraint makes there."""
    if solution.method != BOUNDARY_ARCS:
        return solution
    from satsym.solvers.certificate.constrained.replay import replay

    again = replay(solution)
    if again is None:
        return solution
    return replace(solution, lam=np.column_stack([solution.lam[:, :-1], again.end[len(solution.x) :]]))


def with_ranges(certificate: Certificate, solution: Solution) -> Certificate:
    """The certificate of a solution with the ends given that are met, and what must hold besides."""
    if not solution.instance.ranges:
        return certificate
    pressing = min(pushes(solution).values(), default=np.inf)
    first = [
        Check("final range violated", max([0.0, *outside(solution).values()]), OUTSIDE),
        Check("negative multiplier of a final range", max(0.0, -pressing), SIGN),
    ]
    second = [Check("multiplier of a final range vanishes", float(not pressing > STRICT), 0.0)]
    checks, verdict = (*certificate.checks, *first), certificate.verdict
    if not all(c.passed for c in first):
        return replace(certificate, verdict=Verdict.FAILED, checks=checks)
    lesser = verdict is not Verdict.FAILED and not all(c.passed for c in second)
    return replace(certificate, verdict=Verdict.EXTREMAL_ONLY if lesser else verdict, checks=(*checks, *second))
