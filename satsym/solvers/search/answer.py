"""An extremal in arcs as a solution."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solution import Solution
from satsym.solvers.control.slopes import continued
from satsym.solvers.multipoint.equations import between
from satsym.solvers.multipoint.newton import Extremal
from satsym.status import Status

ROUNDING = 1e-16
"""Share of costates near by that those are given which vanish exactly, where kernels divide by their norm."""


def answered(instance: Instance, extremal: Extremal) -> Solution:
    """The solution of an instance that an extremal is; times hold each junction twice where the control jumps.

    Parameters
    ----------
    instance
        As it was stated; the solution has the values that were found for what it leaves free.
    """
    problem = extremal.problem
    given = _with_values(instance, extremal)
    names = "".join(law.name for law in problem.laws)
    structure = f"structure {names}, " if len(names) > 1 else ""
    with np.errstate(all="ignore"):  # where the slope by a direction vanishes its law is not a number
        times, z, u = _grid(extremal, np.linspace(given.t0, float(extremal.times[-1]), instance.solver.steps + 1))
    n, m = problem.n, len(instance.model.spec.controls)
    open_ones = np.asarray(~np.isfinite(u).all(axis=0))
    if open_ones.any() and not open_ones.all():
        z = _beside_poles(z, n, open_ones)
    if (instance.model.spec.directional and not structure) or open_ones.any():
        u = continued(given, times, z[:n], z[n:], u)
    switches = [
        (float(t), place)
        for t, one in zip(extremal.times[1:-1], problem.junctions, strict=True)
        for place in one.controls
    ]
    status = Status.CONVERGED if instance.model.in_domain(z[:n]) else Status.LEFT_DOMAIN
    return Solution(
        instance=given,
        method="bang-bang" if structure else "collocation",
        status=status,
        message=(
            f"{structure}estimated error {extremal.step:.0e} on {sum(problem.intervals)} intervals, "
            "found by the direct search"
        ),
        objective=extremal.cost,
        times=times,
        x=z[:n],
        u=u,
        lam=z[n:],
        switching_times=tuple(tuple(t for t, control in switches if control == k) for k in range(m)),
        iterations=extremal.iterations,
        history=(),
        wall_s=0.0,
    )


def _beside_poles(z: Array, n: int, open_ones: NDArray[np.bool_]) -> Array:
    """Values with costates that decide a direction at all times: as before or after, and as small as rounding."""
    z, known = z.copy(), np.flatnonzero(~open_ones)
    for at in np.flatnonzero(open_ones):
        z[n:, at] += ROUNDING * z[n:, known[np.abs(known - at).argmin()]]
    return z


def _with_values(instance: Instance, extremal: Extremal) -> Instance:
    """With what was found for what is free besides the end."""
    problem, v = extremal.problem, extremal.unknown
    parameters = tuple(float(np.real(value)) for value in problem.given(v))
    initial = list(instance.initial)
    for one in instance.free:
        if one.place is Place.INITIAL:
            initial[one.index] = float(v[one.index])
    return replace(instance, initial=tuple(initial), parameters=parameters, t0=problem.instance.t0)


def _grid(extremal: Extremal, even: Array) -> tuple[Array, Array, Array]:
    """Times, values and controls at even times and at junctions, at both sides where the law changes."""
    problem, v, edges = extremal.problem, extremal.unknown, extremal.times
    p, times, values, controls = problem.given(v), list[Array](), list[Array](), list[Array]()
    near = 1e-9 * (edges[-1] - edges[0])
    for arc, law in enumerate(problem.laws):
        begin, end = edges[arc], edges[arc + 1]
        inside = even[(even > begin + near) & (even < end - near)]
        again = arc > 0 and law is problem.laws[arc - 1]
        t = np.concatenate([[] if again else [begin], inside, [end]])
        z = between(problem, v, arc, np.clip((t - begin) / (end - begin), 0.0, 1.0))
        z[:, -1] = problem.values(v, arc)[0][-1]
        times.append(t)
        values.append(z)
        controls.append(np.asarray(law.control(t, z, p)))
    return np.concatenate(times), np.concatenate(values, axis=1), np.concatenate(controls, axis=1)
