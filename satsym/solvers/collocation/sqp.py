"""Globalised Newton's method, which treats the collocation equations as conditions of a constrained minimisation.

A curve of states and costates implies a control (through the control law) and multipliers, so that a full Newton step
on the canonical equations is a step of sequential quadratic programming. Steps are therefore measured by an exact
penalty function. If the second variation is not positive, the Newton step is no descent direction and the Gauss-Newton
step is taken, whose quadratic programme is convex: derivatives of the costates' rates with respect to the states are
evaluated without costates. If costs are concave and this step is no descent direction either, the negative curvature of
the costs is left out. A second-order correction prevents the penalty function from rejecting good steps (Nocedal and
Wright, Numerical Optimization, chapter 18).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve, Step
from satsym.solvers.collocation.linearised import Linearised, linearise
from satsym.solvers.collocation.newton import within_domain
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.collocation.system import Residual, System
from satsym.solvers.iteration import Limits

CLOSE_STEP = 1e-3
"""Size of a full Newton step below which Newton's method converges without globalisation."""

CUT = 0.2
"""Fraction of a Newton step below which a shortened step is followed by a Gauss-Newton step."""

FRACTIONS = (1.0, 0.8, 0.5, 0.0)
"""Fractions of the costates with which derivatives of their rates by the states are evaluated. The first fraction with
a positive second variation is used. 1 is Newton's method, 0 is Gauss-Newton, whose quadratic programme is always
convex."""

SHORTEST = 1e-6
SUFFICIENT = 1e-4
CORRECTED = 4
"""``SHORTEST`` is the smallest fraction of a step; ``SUFFICIENT`` the required part of the predicted decrease;
``CORRECTED`` the number of fractions that are also tried with a second-order correction."""

PROBE = 1e-6
"""Step by which the derivative of the cost along a direction is computed."""


def minimise(system: System, start: Curve, limits: Limits, tolerance: float, most: int) -> Attempt:
    """Minimise the cost from a curve without costates, over all curves that solve the problem.

    A mesh that is too coarse has spurious minima, so the minimisation stops if the fastest mode turns by more than
    ``mesh.COARSEST`` in one interval.

    Parameters
    ----------
    system
        Collocation equations of a problem without control bounds.
    start
        A curve on the system's mesh: an initial guess of the states without costates, or an extremal of a neighbouring
        problem.
    tolerance
        Size of the last step at which the iteration has converged.
    most
        Maximum number of steps.
    """
    n, problem, curve = system.problem.states, system.problem, start
    residual, cost = system.residual(curve), system.cost(curve)
    violated = system.infeasibility(residual)
    penalty: Array = np.zeros(len(violated))
    fraction, hard, newton, close = 1.0, False, False, False
    for iteration in range(most):
        first = not curve.stages[n:].any()
        jacobian = system.jacobian(curve)
        limits.spend(curve.flat.shape[1])
        if iteration and system.largest_turn(curve, jacobian) > meshes.COARSEST:
            return Attempt(curve, Reason.OUTGROWN, iteration, cost)
        avoid = newton and fraction < CUT
        linearised, newton = _direction(system, curve, residual, jacobian, avoid, trusted=close)
        if linearised is None:
            return Attempt(curve, Reason.SINGULAR, iteration, cost)
        hard = hard or not (newton or first)
        step = linearised.step(residual)
        size = step.size(curve.moved(step, 1.0))
        if not np.isfinite(size):
            return Attempt(curve, Reason.NOT_FINITE, iteration, cost)
        if limits.expired:
            return Attempt(curve, Reason.TIME_UP, iteration, cost)
        limits.tell(cost * problem.scale.cost, size)
        if size < tolerance:
            curve, known = curve.moved(step, 1.0), linearised if newton else None
            reason, known = _kind(system, curve, known, sure=newton and not close)
            return Attempt(curve, reason, iteration + 1, system.cost(curve), hard, known)
        close = newton and size < CLOSE_STEP and fraction == 1.0
        penalty = _raised(penalty, _multipliers(curve, step, n, len(violated)))
        at = _Merit(system, curve, cost, violated, penalty, linearised, step)
        found = _searched(at, within_domain(problem, curve, step), whole=close)
        found = found or _convexly(at, residual, jacobian)
        if found is None:
            return Attempt(curve, Reason.NO_DESCENT, iteration, cost)
        curve, residual, cost, violated = found.curve, found.residual, found.cost, found.violated
        fraction, halved = found.fraction, found.halved
        limits.spend(int(curve.flat.shape[1] * -np.log2(fraction)) if halved else 0)
        hard = hard or halved
    return Attempt(curve, Reason.NO_CONVERGENCE, most, cost, facts=(most,))


@dataclass(frozen=True, eq=False)
class _Merit:
    """A curve from which a step is taken, with the exact penalty function that decides whether the step is accepted."""

    system: System
    curve: Curve
    cost: float
    violated: Array
    penalty: Array
    linearised: Linearised
    step: Step

    @property
    def value(self) -> float:
        """Return the value of the penalty function at the curve."""
        return float(self.cost + self.penalty @ self.violated)

    def slope(self) -> float:
        """Return the derivative of the penalty function along the step."""
        ahead = self.curve.moved(self.step, PROBE)
        return float((self.system.cost(ahead) - self.cost) / PROBE - self.penalty @ self.violated)

    def measured(self, curve: Curve, fraction: float, halved: bool) -> _Trial:
        """Return the evaluation of another curve, reached by a fraction of the step."""
        residual = self.system.residual(curve)
        cost, violated = self.system.cost(curve), self.system.infeasibility(residual)
        value = float(cost + self.penalty @ violated)
        return _Trial(curve, residual, cost, violated, value if np.isfinite(value) else float("inf"), fraction, halved)


@dataclass(frozen=True, eq=False)
class _Trial:
    """A curve after a fraction of a step."""

    curve: Curve
    residual: Residual
    cost: float
    violated: Array
    value: float
    """Value of the penalty function; infinite if it is not a number."""
    fraction: float
    halved: bool
    """Fraction of the step, and whether it was reduced."""


def _searched(at: _Merit, fraction: float, whole: bool) -> _Trial | None:
    """Return the curve after the largest fraction of the step that decreases the penalty function, or ``None``.

    Parameters
    ----------
    fraction
        First fraction of the step that is tried.
    whole
        Whether this fraction is accepted without a test.
    """
    slope, value, tried = 0.0 if whole else min(at.slope(), 0.0), at.value, 0
    while fraction >= SHORTEST:
        trial = at.measured(at.curve.moved(at.step, fraction), fraction, tried > 0)
        enough = value + SUFFICIENT * fraction * slope + 1e-9 * abs(value)
        if whole or trial.value <= enough:
            return trial
        corrected = _corrected(at, trial) if tried < CORRECTED else None
        if corrected is not None and (trial := at.measured(corrected, fraction, tried > 0)).value <= enough:
            return trial
        tried, fraction = tried + 1, fraction / 2.0
    return None


def _direction(
    system: System, curve: Curve, residual: Residual, jacobian: Array, avoid: bool, trusted: bool
) -> tuple[Linearised | None, bool]:
    """Return the linearisation for the next step, or ``None``, and whether it is that of Newton's method."""
    n = system.problem.states
    without_costates = not curve.stages[n:].any()
    fractions = (0.0,) if without_costates else (1.0, 0.0) if trusted else FRACTIONS[int(avoid) :]
    bare: Array | None = jacobian if without_costates else None
    for fraction in fractions:
        if fraction < 1.0 and bare is None:
            bare = _without_costates(system, curve, jacobian)
        try:
            slopes = jacobian if bare is None else fraction * jacobian + (1.0 - fraction) * bare
            linearised = linearise(system, curve, residual, slopes)
            if trusted or fraction == 0.0 or negative_directions(system.problem, curve, linearised.matching) == 0:
                return linearised, fraction == 1.0
        except np.linalg.LinAlgError:
            continue
    return None, False


def _without_costates(system: System, curve: Curve, jacobian: Array) -> Array:
    """Return the Jacobian with the derivatives of the costates' rates by states evaluated without costates."""
    n, bare = system.problem.states, jacobian.copy()
    stages, nodes = curve.stages.copy(), curve.nodes.copy()
    stages[n:], nodes[n:] = 0.0, 0.0
    bare[n:, :n] = system.jacobian(replace(curve, stages=stages, nodes=nodes))[n:, :n]
    return bare


def _convexly(at: _Merit, residual: Residual, jacobian: Array) -> _Trial | None:
    """Return the curve after a Gauss-Newton step with convexified costs if the step descends, otherwise ``None``."""
    system, curve, problem = at.system, at.curve, at.system.problem
    n, slopes = problem.states, _without_costates(system, curve, jacobian)
    slopes[n:, :n] = -_convex(-slopes[n:, :n].transpose(2, 0, 1)).transpose(1, 2, 0)
    by_end = problem.boundary_slopes(curve.nodes[:, -1], curve.theta)[0].copy()
    free = np.ix_(~problem.fixed, np.append(~problem.fixed, np.zeros(n, bool)))
    by_end[:n][free] = -_convex(-by_end[:n][free][None])[0]
    try:
        linearised = linearise(system, curve, residual, slopes, by_end)
    except np.linalg.LinAlgError:
        return None
    step = linearised.step(residual)
    if not np.isfinite(step.size(curve.moved(step, 1.0))):
        return None
    penalty = _raised(at.penalty, _multipliers(curve, step, n, len(at.violated)))
    convex = replace(at, linearised=linearised, step=step, penalty=penalty)
    return _searched(convex, within_domain(problem, curve, step), whole=False)


def _convex(hessians: Array) -> Array:
    """Return symmetric matrices of a stack, shape (M, n, n), with negative eigenvalues replaced by zero."""
    values, axes = np.linalg.eigh((hessians + hessians.transpose(0, 2, 1)) / 2.0)
    found: Array = (axes * np.maximum(values, 0.0)[:, None, :]) @ axes.transpose(0, 2, 1)
    return found


def _kind(system: System, curve: Curve, near: Linearised | None, sure: bool) -> tuple[Reason, Linearised | None]:
    """Return whether an extremal is a minimum, and the linearised equations from which this follows.

    Parameters
    ----------
    sure
        Whether these equations are known to be those of a minimum.
    """
    try:
        if near is None:
            near = linearise(system, curve, system.residual(curve), system.jacobian(curve))
        minimum = sure or negative_directions(system.problem, curve, near.matching) == 0
    except np.linalg.LinAlgError:
        return Reason.SINGULAR, None
    return Reason.MINIMUM if minimum else Reason.SADDLE, near


def _multipliers(curve: Curve, step: Step, n: int, count: int) -> Array:
    """Return the largest multipliers after the full step: of each state's equation, then of terminal constraints."""
    costates = np.abs(curve.stages[n:] + step.stages[n:]).reshape(n, -1).max(axis=1)
    return np.concatenate([costates, np.abs(curve.theta + step.theta)[: count - n]])


def _raised(penalty: Array, multipliers: Array) -> Array:
    """Return penalties above the multipliers, reduced where they have become much too large."""
    found: Array = np.where(
        penalty < 1.1 * multipliers,
        2.0 * multipliers,
        np.where(penalty > 10.0 * multipliers, 4.0 * multipliers, penalty),
    )
    return found


def _corrected(at: _Merit, trial: _Trial) -> Curve | None:
    """Return the trial after a second-order correction of the equations of motion; ``None`` outside the domain."""
    n = at.system.problem.states
    stages, ends = trial.residual.stages.copy(), trial.residual.ends.copy()
    stages[n:], ends[n:] = 0.0, 0.0
    missing = replace(trial.residual, stages=stages, ends=ends)
    corrected = trial.curve.moved(at.linearised.step(missing), 1.0)
    for i in at.system.problem.positive:
        if not (corrected.stages[i] > 0.1 * at.curve.stages[i]).all():
            return None
    return corrected
