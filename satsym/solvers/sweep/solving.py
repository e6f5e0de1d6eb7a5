"""The forward-backward sweep method for a given final time and a free final state (boundary type 3).

The problem is solved on a uniform grid. If the control meets bounds, nodes are moved to the corners and the problem is
solved again, until the corners no longer change: between corners all functions are smooth, and the sweep is of fourth
order.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.solution import Iteration, Progress, Solution
from satsym.solvers.control import corners
from satsym.solvers.iteration import Limits, Run, computed, deadline_of, iterate
from satsym.solvers.sweep.quasi_newton import Descent, QuasiNewton
from satsym.solvers.sweep.sweeps import Forward, Sweep, SweepProblem, backward, forward, unbounded_law
from satsym.status import Status

ROUNDS = 6
"""Largest number of times that nodes are moved to the corners."""

SETTLED_CORNERS = 1e-9
"""Change of a corner, as a fraction of the duration, below which it has converged."""

WORTH_COMPILING = 20_000
"""Number of steps above which compiled kernels save more time than their compilation takes."""

ITERATIONS = {"quasi-Newton": 500, "relaxation": 20_000}

GROWTH = 1e3
"""Factor of the smallest difference between control and control law so far, above which the iteration diverges."""

PATIENCE = 200
"""Number of sweeps without a smaller difference after which the iteration is taken to cycle."""

PROBE = 1e-6
"""Size of the perturbation for measuring the response of the control law, relative to the control."""

PROBES = 30
"""Largest number of power iterations for the largest response."""

FALLBACK = 100, 5.0
"""Largest number of iterations and of seconds for finding the extremal after relaxation has failed."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Minimise the cost over the control by forward-backward sweeps.

    Parameters
    ----------
    instance
        An instance with a given final time and a free final state.
    progress
        Function that is called after each iteration.

    Returns
    -------
    Solution
        The status is ``converged`` if control and control law agree to the instance's tolerance.
    """
    began = time.perf_counter()
    if instance.tf is None or instance.final:
        raise ValueError("the sweep needs a given final time and a free final state")
    kernels = _kernels(instance)
    rule = "relaxation" if instance.solver.relaxation else "quasi-Newton"
    limits = Limits(instance.solver.max_iterations or ITERATIONS[rule], deadline_of(instance))
    problem = SweepProblem(instance, kernels, Grid.uniform(instance.t0, instance.tf, instance.solver.steps), limits)
    start = forward(problem, _starting_control(problem))
    if not start.usable:
        return _without_answer(problem, start, time.perf_counter() - began)
    run = _run(problem, start, limits, progress)
    history = run.history
    switches = switching_times(problem, run.state.sweep)
    for _ in range(ROUNDS):
        if not any(switches) or not _improvable(run):
            break
        before = switches
        moved = _with_kinks(problem, switches)
        start = forward(moved, _carried_over(problem, run.state.sweep, moved))
        if not start.usable:
            break
        run = _run(moved, start, limits, progress)
        history = _continued(history, run.history)
        problem = moved
        switches = switching_times(problem, run.state.sweep)
        if _settled(before, switches, instance.tf - instance.t0):
            break
    return _solution(problem, run, history, switches, time.perf_counter() - began)


def switching_times(problem: SweepProblem, sweep: Sweep) -> tuple[tuple[float, ...], ...]:
    """Return, for each control, the times at which it meets or leaves a bound; empty for a fixed control.

    In a ball the times are the same for all controls.
    """
    instance = problem.instance
    m = len(instance.model.spec.controls)
    distances = instance.control_set.excess(unbounded_law(problem, sweep))
    if instance.model.spec.control_set == "box":
        fixed = np.tile(np.equal(instance.lower, instance.upper), 2)
        distances[fixed] = np.inf
    found = [corners.zeros(problem.times, row) if np.isfinite(row).all() else [] for row in distances]
    if len(found) == 1:
        found = found * m
    return tuple(tuple(sorted(t for row in found[i::m] for t in row)) for i in range(m))


def _kernels(instance: Instance) -> Kernels:
    backend, steps = instance.solver.backend, instance.solver.steps
    if backend == "numba" or (backend == "auto" and steps >= WORTH_COMPILING and _numba_installed()):
        return instance.model.compiled()
    return instance.model


def _numba_installed() -> bool:
    from importlib.util import find_spec

    return find_spec("numba") is not None


def _starting_control(problem: SweepProblem) -> Array:
    """Return the guessed control, otherwise zero or the admissible control nearest to zero."""
    instance, times = problem.instance, problem.times
    u = np.zeros((len(instance.model.spec.controls), len(times)))
    for i, name in enumerate(instance.model.spec.control_names):
        if values := instance.guess.control.get(name):
            u[i] = np.interp(times, np.linspace(times[0], times[-1], len(values)), values)
    return instance.control_set.project(u)


def _run(
    problem: SweepProblem, start: Forward, limits: Limits, progress: Progress | None
) -> Run[Descent] | Run[_Relaxed]:
    options = problem.instance.solver
    if options.relaxation:
        return iterate(_Relaxation(problem, start, options.tolerance, options.relaxation), limits, progress)
    return iterate(QuasiNewton(problem, start, options.tolerance), limits, progress)


def _improvable(run: Run[Descent] | Run[_Relaxed]) -> bool:
    """Return whether nodes at the corners can improve a run: it has converged, or its descent is stuck."""
    return run.status is Status.CONVERGED or (isinstance(run.state, Descent) and run.state.stalled)


def _with_kinks(problem: SweepProblem, switches: tuple[tuple[float, ...], ...]) -> SweepProblem:
    uniform = Grid.uniform(problem.grid.t0, problem.grid.tf, problem.instance.solver.steps)
    points = sorted({t for times in switches for t in times})
    return SweepProblem(problem.instance, problem.kernels, uniform.with_corners(points), problem.limits)


def _carried_over(problem: SweepProblem, sweep: Sweep, onto: SweepProblem) -> Array:
    """Return the control on another grid; it is interpolated before projection, so that its corners stay sharp."""
    smooth = unbounded_law(problem, sweep)
    u = np.array([np.interp(onto.times, problem.times, row) for row in smooth])
    return problem.instance.control_set.project(u)


def _settled(before: tuple[tuple[float, ...], ...], after: tuple[tuple[float, ...], ...], horizon: float) -> bool:
    return all(
        len(old) == len(new) and np.allclose(old, new, rtol=0.0, atol=SETTLED_CORNERS * horizon)
        for old, new in zip(before, after, strict=True)
    )


def _continued(history: tuple[Iteration, ...], more: tuple[Iteration, ...]) -> tuple[Iteration, ...]:
    offset = len(history)
    return history + tuple(Iteration(offset + i.number, i.objective, i.residual) for i in more)


def _solution(
    problem: SweepProblem,
    run: Run[Descent] | Run[_Relaxed],
    history: tuple[Iteration, ...],
    switches: tuple[tuple[float, ...], ...],
    wall_s: float,
) -> Solution:
    sweep = run.state.sweep
    return Solution(
        instance=problem.instance,
        method="sweep",
        status=run.status,
        message=_explained(problem, sweep, run),
        objective=sweep.objective,
        times=problem.grid.nodes,
        x=sweep.forward.x[:, ::2],
        u=sweep.u[:, ::2],
        lam=sweep.lam[:, ::2],
        switching_times=switches,
        iterations=len(history) - 1,
        history=history,
        wall_s=wall_s,
    )


def _explained(problem: SweepProblem, sweep: Sweep, run: Run[Descent] | Run[_Relaxed]) -> str:
    if run.status is not Status.CONVERGED:
        return run.message
    if not sweep.lam.any() and not sweep.u.any():
        return f"{run.message}; all costates of the uncontrolled motion vanish"
    return run.message


def _without_answer(problem: SweepProblem, start: Forward, wall_s: float) -> Solution:
    """Return a failed solution, because the initial motion leaves the domain or is not finite."""
    n = len(problem.instance.model.spec.states)
    status = Status.NON_FINITE if start.in_domain else Status.LEFT_DOMAIN
    what = "is not finite" if start.in_domain else "leaves the domain"
    return Solution(
        instance=problem.instance,
        method="sweep",
        status=status,
        message=f"the motion under the initial guess of the control {what}",
        objective=float("nan"),
        times=problem.grid.nodes,
        x=start.x[:, ::2],
        u=start.u[:, ::2],
        lam=np.full((n, problem.grid.steps + 1), np.nan),
        switching_times=tuple(() for _ in problem.instance.model.spec.controls),
        iterations=0,
        history=(),
        wall_s=wall_s,
    )


@dataclass(frozen=True, eq=False)
class _Relaxed:
    """State of the relaxation of a forward-backward sweep."""

    sweep: Sweep
    """The last completed sweep."""
    closest: float
    since: int = 0
    """Smallest difference of control and law so far, and number of sweeps since then."""
    broken: bool = False
    """Whether the next control led out of the domain or to numbers that are not finite."""


@dataclass(frozen=True, eq=False)
class _Relaxation:
    """Plain relaxation of the sweep, u <- (1 - rho) u + rho law, as in textbooks and the audited documents.

    Near an extremal without active bounds, a change v of the control changes the law by -K v with K >= 0. An error is
    therefore multiplied by 1 - rho (1 + k) for each eigenvalue k of K, and relaxation is stable only if rho < 2/(1 +
    max k). K grows quickly with the duration. As K differs far from the extremal, the limit that is reported after a
    failure is computed at the extremal, which the quasi-Newton method finds. The initial motion must be usable.
    """

    problem: SweepProblem
    start: Forward
    tolerance: float
    fraction: float

    def init(self) -> _Relaxed:
        """Return the state at the initial control."""
        sweep = backward(self.problem, self.start)
        return _Relaxed(sweep, _distance(sweep))

    def measure(self, state: _Relaxed, number: int) -> Iteration:
        """Return cost and residual of an iteration."""
        return Iteration(number, state.sweep.objective, state.sweep.residual)

    def step(self, state: _Relaxed) -> _Relaxed:
        """Return the state after a step of fraction rho towards the control law."""
        motion = forward(self.problem, state.sweep.u + self.fraction * state.sweep.step)
        if not motion.usable:
            return replace(state, broken=True)
        sweep = backward(self.problem, motion)
        distance = _distance(sweep)
        closer = distance < state.closest
        return _Relaxed(sweep, min(distance, state.closest), 0 if closer else state.since + 1)

    def terminate(self, state: _Relaxed) -> tuple[Status, str] | None:
        """Return status and message if control and control law agree, diverge or cycle; otherwise ``None``."""
        if state.sweep.residual <= self.tolerance:
            return Status.CONVERGED, "control and control law agree"
        if state.broken or _distance(state.sweep) > GROWTH * state.closest:
            return Status.NOT_CONVERGED, f"relaxation {self.fraction:g} diverges; {self._advice()}"
        if state.since >= PATIENCE:
            return (
                Status.NOT_CONVERGED,
                f"relaxation {self.fraction:g} makes the sweeps repeat themselves; {self._advice()}",
            )
        return None

    def _advice(self) -> str:
        largest = largest_stable(self.problem, self._near_extremal())
        return (
            f"here the iteration converges only if relaxation is below about {largest:.2g}; leave out "
            "relaxation to use a method without this limit"
        )

    def _near_extremal(self) -> Forward:
        iterations, seconds = FALLBACK
        limits = Limits(iterations, computed() + seconds)
        return iterate(QuasiNewton(self.problem, self.start, self.tolerance), limits, None).state.sweep.forward


def largest_stable(problem: SweepProblem, motion: Forward) -> float:
    """Return the largest stable relaxation near a motion, from the largest response of the law to the control.

    The response is found by power iteration on the law without bounds. If the iteration ends early, the response is too
    small and the result too large.
    """
    base = unbounded_law(problem, backward(problem, motion))
    size = PROBE * max(np.abs(base).max(), np.abs(motion.u).max(), np.finfo(float).tiny)
    direction = np.ones_like(motion.u)
    response = 0.0
    for _ in range(PROBES):
        direction *= size / np.abs(direction).max()
        moved = forward(problem, motion.u + direction)
        if not moved.usable:
            break
        change = unbounded_law(problem, backward(problem, moved)) - base
        before, response = response, float(-np.sum(change * direction) / np.sum(direction**2))
        if abs(response - before) <= 1e-3 * abs(response):
            break
        direction = change
    return 2.0 / (1.0 + max(response, 0.0))


def _distance(sweep: Sweep) -> float:
    """Return the largest difference between control and control law."""
    return float(np.abs(sweep.step).max(initial=0.0))
