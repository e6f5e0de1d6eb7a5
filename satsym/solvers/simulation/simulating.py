"""Simulation of an instance from its initial state, to the accuracy of its tolerance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid
from satsym.instance import Instance
from satsym.solution import Invariant, Simulation
from satsym.solvers import iteration
from satsym.solvers.iteration import Limits, TimeUp, watched
from satsym.solvers.simulation import blocks, closed_loop
from satsym.solvers.simulation.balances import balances
from satsym.solvers.simulation.closed_loop import Law
from satsym.solvers.simulation.stability import propagated, stable_steps
from satsym.status import BadInput, Status

RICHARDSON = 2.0**4 - 1.0
"""Ratio of the difference between two runs of RK4, one with half the steps, to the error of the better run."""
MARGIN = 0.1
"""Fraction of the tolerance that the estimated error may reach, since estimates can be too small."""

TIGHTER, SMALLEST_TOLERANCE = 0.01, 3e-14
"""Factor of the tolerance from one run under a control law to the next, and the smallest tolerance above rounding."""
GAINED = 10.0
"""Factor by which the error of a run under a control law is at least smaller than that of the run before.

The factor is nearly that of the tolerances if the law has no corners.
"""

ROUNDING = 100.0 * float(np.finfo(float).eps)
"""Relative change of the initial state whose effect is attributed to rounding.

More steps do not reduce such an error. It matters for a state that is small because large terms cancel, like the radial
velocity on a nearly circular orbit.
"""

MOST_STEPS = 2**20
"""Largest number of steps, unless the instance itself requests more than half as many."""

HOPELESS = 64
"""Multiple of the given number of steps at which a motion that leaves the domain is abandoned.

Before, the motion may have left the domain only because steps were too long.
"""

FASTEST = 2.0**6
"""Largest factor by which halving the step can reduce the error: 16 asymptotically, more before.

If even this factor does not suffice before the largest number of steps, the run is the last one. Otherwise motions near
a singularity would take very long without result.
"""


@np.errstate(all="ignore")  # numbers out of range are a status
def simulate(instance: Instance, law: Law | None = None) -> Simulation:
    """Simulate an instance with RK4, or under a control law with DOP853, until two runs agree.

    If the given steps are too long for the fastest mode, a linear motion is computed from e^(At), and any other motion
    is integrated with DOP853.

    Parameters
    ----------
    instance
        An instance with a given final time.
    law
        Control law; by default the controls are zero, or the admissible controls nearest to zero.

    Returns
    -------
    Simulation
        The motion at the instance's number of steps. ``metrics`` contains the number of steps that were needed and the
        estimated error, relative to the magnitude of each state or, if larger, to the magnitude at which rounding alone
        causes this error.

    Raises
    ------
    BadInput
        If the final time is free.
    """
    if instance.tf is None:
        raise BadInput(f"{instance.called}: time.tf: a simulation requires a final time; give a number")
    limits, _ = watched(instance, None)
    try:
        return _simulated(instance, law, limits)
    except TimeUp:
        return iteration.unsimulated(instance, law.name if law else "none")


def _simulated(instance: Instance, law: Law | None, limits: Limits) -> Simulation:
    assert instance.tf is not None
    times = Grid.uniform(instance.t0, instance.tf, instance.solver.steps).nodes
    fast = stable_steps(instance, instance.solver.steps, 2 * instance.solver.steps) > instance.solver.steps
    exact = _propagated(instance, law, times) if fast else None
    if exact is not None:
        (x, u, error), steps, left = exact, len(times) - 1, False
    elif law is None and not fast:
        x, steps, error = _uncontrolled(instance, limits)
        u, left = np.repeat(_control(instance), len(times), axis=1), False
    else:
        run, error = _controlled(instance, law or _idle(instance), times, limits)
        x, u, steps, left = run.x, run.u, run.steps, run.left_domain
    status = Status.LEFT_DOMAIN if left else _status(instance, x, error, limits)
    return Simulation(
        instance=instance,
        feedback=law.name if law else "none",
        status=status,
        message=_message(status, error, steps),
        times=times,
        x=x,
        u=u,
        invariants=(_invariants(instance, times, x) if not u.any() else {}) | balances(instance, times, x, u),
        metrics=_metrics(instance, x) | {"steps": float(steps), "estimated_error": error},
    )


def _propagated(instance: Instance, law: Law | None, times: Array) -> tuple[Array, Array, float] | None:
    """Return states, controls and estimated error of a linear motion under a linear law; ``None`` for other motions."""
    if law is not None and law.gain is None:
        return None
    found = propagated(instance, times, law.gain if law else None)
    if found is None:
        return None
    x, coarser = found
    u = np.repeat(_control(instance), len(times), axis=1) if law is None or law.gain is None else -law.gain @ x
    return x, u, _difference(coarser, x)


def _idle(instance: Instance) -> Law:
    """Return the control law whose controls are all zero."""
    rest = [0.0] * len(instance.model.spec.controls)
    return Law("none", lambda t, x: rest)


def _control(instance: Instance) -> Array:
    """Return zero controls, or the admissible controls nearest to zero, shape (m, 1)."""
    return instance.control_set.project(np.zeros((len(instance.model.spec.controls), 1)))


def _uncontrolled(instance: Instance, limits: Limits) -> tuple[Array, int, float]:
    """Return the states at the nodes by RK4, with steps halved until two runs agree; number of steps; and error."""
    coarse_steps, sufficient = instance.solver.steps, MARGIN * instance.solver.tolerance
    steps, x, error = coarse_steps, _fly(instance, coarse_steps, limits), float("nan")
    most = max(MOST_STEPS, 2 * coarse_steps)
    while 2 * steps <= most and (steps < HOPELESS * coarse_steps or _sound(instance, x)):
        try:
            finer = _fly(instance, 2 * steps, limits)
        except TimeUp:  # what there is stays, with the error of the run before
            break
        steps, coarse, x, before = 2 * steps, x, finer, error
        error = _difference(coarse, x[:, ::2]) / RICHARDSON
        if error > 0.25 * before:  # no longer fourth order
            error = _difference(coarse, x[:, ::2], _rounding(instance, x, steps, limits) / sufficient) / RICHARDSON
        if error <= sufficient or error > instance.solver.tolerance * FASTEST ** np.log2(most / steps):
            break
        if limits.expired:
            break
    return x[:, :: steps // coarse_steps], steps, error


def _controlled(instance: Instance, law: Law, times: Array, limits: Limits) -> tuple[closed_loop.Run, float]:
    """Return the motion under a law, with tolerances reduced until two runs agree, and the estimated error."""
    sufficient = MARGIN * instance.solver.tolerance
    tolerance, error = sufficient, float("nan")
    run = closed_loop.simulate(instance, law, times, tolerance, limits=limits)
    while (
        not error <= sufficient and tolerance > SMALLEST_TOLERANCE and np.isfinite(run.x).all() and not limits.expired
    ):
        tolerance, coarse = max(TIGHTER * tolerance, SMALLEST_TOLERANCE), run
        try:
            run = closed_loop.simulate(instance, law, times, tolerance, limits=limits)
        except TimeUp:
            break
        error = _difference(coarse.x, run.x) / GAINED
    return run, error


def _fly(instance: Instance, steps: int, limits: Limits) -> Array:
    assert instance.tf is not None
    grid = Grid.uniform(instance.t0, instance.tf, steps)
    u = np.repeat(_control(instance), steps + 1, axis=1)
    x, _, _ = blocks.forward(instance.model, grid.nodes, instance.initial, u, u[:, 1:], instance.parameters, limits)
    return x


def _sound(instance: Instance, x: Array) -> bool:
    return bool(np.isfinite(x).all()) and instance.model.in_domain(x)


def _rounding(instance: Instance, x: Array, steps: int, limits: Limits) -> Array:
    """Return the effect of rounding on each state, shape (n, 1)."""
    nudged = replace(instance, initial=tuple(value * (1.0 + ROUNDING) for value in instance.initial))
    with np.errstate(invalid="ignore"):
        effect: Array = np.abs(_fly(nudged, steps, limits) - x).max(axis=1, keepdims=True)
    return effect


def _difference(coarse: Array, fine: Array, least: Array | float = 0.0) -> float:
    """Return the difference of two runs, relative to the magnitude of each state or to `least`, if larger."""
    with np.errstate(invalid="ignore"):
        size = np.maximum(np.abs(fine).max(axis=1, keepdims=True), np.maximum(least, np.finfo(float).tiny))
        return float((np.abs(coarse - fine) / size).max())


def _status(instance: Instance, x: Array, error: float, limits: Limits) -> Status:
    if not np.isfinite(x).all():
        return Status.NON_FINITE
    if not instance.model.in_domain(x):
        return Status.LEFT_DOMAIN
    if error <= instance.solver.tolerance:
        return Status.CONVERGED
    return Status.TIME_LIMIT if limits.expired else Status.NOT_CONVERGED


def _message(status: Status, error: float, steps: int) -> str:
    if status is Status.CONVERGED:
        return f"a second run with fewer steps agrees to {error:.0e}"
    if status is Status.TIME_LIMIT:
        return f"time limit reached: {steps} steps leave an estimated error of {error:.0e}; {status.advice}"
    if status is Status.NOT_CONVERGED:
        return f"even {steps} steps leave an estimated error of {error:.0e}: the motion passes close to a singularity"
    return f"the motion is not finite: {status.advice}" if status is Status.NON_FINITE else status.advice


def _invariants(instance: Instance, times: Array, x: Array) -> dict[str, Invariant]:
    spec = instance.model.spec
    if not spec.invariants or not np.isfinite(x).all():
        return {}
    values = instance.model.invariants_batch(times, x, instance.parameters)
    return {
        v.symbol: Invariant(float(row[0]), float(np.abs(row - row[0]).max()))
        for v, row in zip(spec.invariants, values, strict=True)
    }


def _metrics(instance: Instance, x: Array) -> dict[str, float]:
    """Return the extrema of each state, and the deviation of the final state from the reference."""
    spec = instance.model.spec
    found: dict[str, float] = {}
    for name, row in zip(spec.state_names, x, strict=True):
        found |= {f"{name}_min": float(row.min()), f"{name}_max": float(row.max())}
    if spec.has_reference:
        assert instance.tf is not None
        curve = instance.model.reference(instance.tf, instance.parameters)
        found |= {f"{name}_error": float(row[-1] - c) for name, row, c in zip(spec.state_names, x, curve, strict=True)}
    return found
