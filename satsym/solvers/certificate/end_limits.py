"""Limits of the end, of ranges of final states and of inequalities: how far it is beyond, and how hard they press.

Where a limit of a range is met the final state is given, and what transversality lacks there, lambda - S_x - nu' psi_x,
is its multiplier mu: the cost changes by -mu dx, so that at an upper limit it must not be negative, nor positive at a
lower one. An inequality psi <= 0 that is met has its nu, which must not be negative (Karush, Kuhn and Tucker). Where
none vanishes, a change away from the limits costs more to first order; the rest is the problem with these limits met.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.instance.end_time import in_time_alone
from satsym.instance.ends import Side
from satsym.kernels.active import stated
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Certificate, Check, Solution
from satsym.solvers.certificate.end_form import final_values, multipliers
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.status import Verdict

BEYOND_LIMIT = 1e-9
"""Largest distance beyond a limit, relative to what is limited, that is none."""

SIGN, STRICT = 1e-9, 1e-7
"""Largest multiplier of the wrong sign that is none, and least one that does not vanish, relative to the costate."""


def beyond(solution: Solution) -> dict[tuple[str, Side], float]:
    """By how much the end is beyond its limits, relative to the size of what each limits; negative before them.

    A limit that is met is not looked at: the boundary residual has it.
    """
    instance, names = solution.instance, solution.instance.model.spec.state_names
    found = {}
    for name, limits in instance.ranges.items():
        row = solution.x[names.index(name)]
        size = max([float(np.abs(row).max()), *(abs(v) for v in limits if np.isfinite(v))])
        for side in instance.end_limits[name]:
            found[name, side] = side.outward * (float(row[-1]) - side.of(limits)) / max(size, 1e-300)
    for name, one in _inequalities(solution).items():
        found[name, Side.UPPER] = one.value / one.size
    return {place: by for place, by in found.items() if instance.met.get(place[0]) is not place[1]}


@dataclass(frozen=True, eq=False)
class _Inequality:
    """An inequality at the end of a solution."""

    value: float
    by_state: Array
    by_time: float
    size: float
    """The size of its terms."""
    on_time: float
    """What its multiplier adds to the transversality of the final time."""


def _inequalities(solution: Solution) -> dict[str, _Inequality]:
    """By name, whether they are met or not."""
    instance, model = solution.instance, stated(solution.instance.model)
    if not model.spec.terminal_inequalities:
        return {}
    tf, x, lam = final_values(solution)
    n, c, count = len(x), len(model.spec.multipliers), len(model.spec.terminal_inequalities)
    arguments = tf, x, lam, (0.0,) * c, instance.parameters, instance.control_set.arguments, (0.0,) * 3 * n
    place, lasting = slice(n + c - count, n + c), tf - float(solution.times[0])
    values = np.array(model.boundary(*arguments))[place]
    table = np.array(model.boundary_jacobian(*arguments)).reshape(n + c + 1, -1)
    slopes, on_time = table[place], table[-1, 2 * n + c - count : 2 * n + c]
    sizes = np.abs(slopes[:, :n]) @ typical(solution)[0] + np.abs(slopes[:, -1]) * lasting
    rows = zip(model.spec.terminal_inequalities, values, slopes, sizes, on_time, strict=True)
    return {
        name: _Inequality(float(value), slope[:n], float(slope[-1]), max(float(size), 1e-300), float(by_multiplier))
        for name, value, slope, size, by_multiplier in rows
    }


def pushes(solution: Solution) -> dict[str, float]:
    """Multipliers of the limits that are met, relative to the costates, positive where they hold the end."""
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
    of, timed = _inequalities(solution), in_time_alone(instance)
    inside = [name for name in instance.end_limits if name in instance.met and name not in instance.ranges]
    active = [name for name in inside if name not in timed]
    held = dict(zip(active, nu[len(nu) - len(active) :], strict=True))
    # the final time is given by one in time alone, which makes up what transversality lacks: H + S_t + nu' psi_t
    held |= {name: -float(residual[-1] + _held_back(solution)) / of[name].on_time for name in inside if name in timed}
    pace = float(np.abs(np.array(instance.model.canonical(tf, x, lam, *arguments))[:n]) @ sizes)  # the size of H
    for name, multiplier in held.items():
        strengths = [*(np.abs(of[name].by_state) / sizes), abs(of[name].by_time) / max(pace, 1e-300)]
        found[name] = float(multiplier) * max(strengths)
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


def _held_back(solution: Solution) -> float:
    """H at the end less that under the law, which boundary residuals have: where a constraint holds a control."""
    if solution.method != BOUNDARY_ARCS:
        return 0.0
    from satsym.solvers.certificate.constrained.conditions import more_at_end
    from satsym.solvers.certificate.constrained.replay import replay

    again = replay(solution)
    return 0.0 if again is None else more_at_end(solution, again)


def with_limits(certificate: Certificate, solution: Solution) -> Certificate:
    """The certificate of a solution with the limits given that are met, and what must hold besides."""
    if not solution.instance.end_limits:
        return certificate
    pressing = min(pushes(solution).values(), default=np.inf)
    first = [
        Check("limit of the end violated", max([0.0, *beyond(solution).values()]), BEYOND_LIMIT),
        Check("negative multiplier of a limit of the end", max(0.0, -pressing), SIGN),
    ]
    second = [Check("multiplier of a limit of the end vanishes", float(not pressing > STRICT), 0.0)]
    checks, verdict = (*certificate.checks, *first), certificate.verdict
    if not all(c.passed for c in first):
        return replace(certificate, verdict=Verdict.FAILED, checks=checks)
    lesser = verdict is not Verdict.FAILED and not all(c.passed for c in second)
    return replace(certificate, verdict=Verdict.EXTREMAL_ONLY if lesser else verdict, checks=(*checks, *second))
