"""Limits of final states and terminal inequalities: whether they are violated, and the signs of their multipliers.

If a limit of a range is active, the final state is given there, and the residual of transversality, lambda - S_x - nu'
psi_x, is its multiplier mu: the cost changes by -mu dx, so that mu must not be negative at an upper limit nor positive
at a lower one. The multiplier nu of an active inequality psi <= 0 must not be negative (Karush, Kuhn and Tucker). If no
multiplier vanishes, a variation away from the limits increases the cost to first order; what remains is the problem
with these limits as equalities.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.instance.end_time import in_time_alone, inequalities_at
from satsym.instance.ends import Side
from satsym.kernels.active import stated
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Certificate, Check, Solution
from satsym.solvers.certificate.end_form import final_values, multipliers
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.search.reading.limits import BEYOND_LIMIT, beyond
from satsym.status import Verdict

SIGN, STRICT = 1e-9, 1e-7
"""Largest multiplier of the wrong sign that counts as zero, and smallest multiplier that counts as strictly nonzero,
both relative to the costates."""


def pushes(solution: Solution) -> dict[str, float]:
    """Return multipliers of the active limits relative to the costates; positive if a limit restrains the end."""
    instance, spec = solution.instance, solution.instance.model.spec
    if not instance.met:
        return {}
    tf, x, lam = final_values(_after_jump(solution))
    nu, residual = multipliers(instance, tf, x, lam)
    n, arguments = len(x), (instance.parameters, instance.control_set.arguments)
    # what the residual of a free state is
    lacking = np.array(instance.model.boundary(tf, x, lam, nu, *arguments, (0.0,) * 3 * n))[:n]
    sizes, found = np.maximum(typical(solution, 0.0)[1], 1e-300), {}
    for name, side in instance.met.items():
        if name in instance.ranges:
            i = spec.state_names.index(name)
            found[name] = side.outward * float(lacking[i]) / max(float(sizes[i]), abs(float(lacking[i] - lam[i])))
    inside = [name for name in instance.end_limits if name in instance.met and name not in instance.ranges]
    if not inside:
        return found
    _, slopes, on_time = inequalities_at(instance, tf, np.array(x))
    place, timed = stated(instance.model).spec.terminal_inequalities.index, in_time_alone(instance)
    active = [name for name in inside if name not in timed]
    held = dict(zip(active, nu[len(nu) - len(active) :], strict=True))
    # the final time is given by one in time alone, which makes up what transversality lacks: H + S_t + nu' psi_t
    lacked = float(residual[-1] + _held_back(solution))
    held |= {name: -lacked / float(on_time[place(name)]) for name in inside if name in timed}
    pace = float(np.abs(np.array(instance.model.canonical(tf, x, lam, *arguments))[:n]) @ sizes)  # the size of H
    for name, multiplier in held.items():
        strengths = np.abs(slopes[place(name)]) / np.append(sizes, max(pace, 1e-300))
        found[name] = float(multiplier) * float(strengths.max())
    return found


def others_asked(solution: Solution) -> dict[str, Side] | None:
    """Return other active limits that a solution requires, or ``None`` if its own are right.

    Either a violated limit is added, or the limit with the most negative multiplier is removed.
    """
    met = dict(solution.instance.met)
    over = beyond(solution.instance, solution.times, solution.x)
    if max(over.values(), default=0.0) > BEYOND_LIMIT:
        name, side = max(over, key=lambda place: over[place])
        return {**met, name: side}
    pulling = {name: push for name, push in pushes(solution).items() if push < -SIGN}
    if not pulling:
        return None
    return {name: side for name, side in met.items() if name != min(pulling, key=lambda one: pulling[one])}


def _after_jump(solution: Solution) -> Solution:
    """Return the solution with its costates at the final time after the jump that a path constraint causes."""
    if solution.method != BOUNDARY_ARCS:
        return solution
    from satsym.solvers.certificate.constrained.replay import replay

    again = replay(solution)
    if again is None:
        return solution
    return replace(solution, lam=np.column_stack([solution.lam[:, :-1], again.end[len(solution.x) :]]))


def _held_back(solution: Solution) -> float:
    """Return H at the final time less H under the control law; nonzero if a path constraint sets a control."""
    if solution.method != BOUNDARY_ARCS:
        return 0.0
    from satsym.solvers.certificate.constrained.conditions import more_at_end
    from satsym.solvers.certificate.constrained.replay import replay

    again = replay(solution)
    return 0.0 if again is None else more_at_end(solution, again)


def with_limits(certificate: Certificate, solution: Solution) -> Certificate:
    """Return a certificate extended by the conditions on active limits of the end, with the verdict that follows."""
    if not solution.instance.end_limits:
        return certificate
    pressing = min(pushes(solution).values(), default=np.inf)
    over = max([0.0, *beyond(solution.instance, solution.times, solution.x).values()])
    first = [
        Check("a terminal limit is violated", over, BEYOND_LIMIT),
        Check("negative multiplier of a terminal limit", max(0.0, -pressing), SIGN),
    ]
    second = [Check("the multiplier of a terminal limit vanishes", float(not pressing > STRICT), 0.0)]
    checks, verdict = (*certificate.checks, *first), certificate.verdict
    if not all(c.passed for c in first):
        return replace(certificate, verdict=Verdict.FAILED, checks=checks)
    lesser = verdict is not Verdict.FAILED and not all(c.passed for c in second)
    return replace(certificate, verdict=Verdict.EXTREMAL_ONLY if lesser else verdict, checks=(*checks, *second))
