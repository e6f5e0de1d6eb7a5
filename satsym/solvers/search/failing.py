"""Reasons why a search finds no solution: no optimal duration, unbounded motions, or an unreachable final state."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, partial
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.control_set import stated_constraints
from satsym.instance import Instance
from satsym.solvers.constrained.arcs import sizes as measured
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits, Meter
from satsym.solvers.search import coarse, nlp
from satsym.solvers.search.controls import controls_of
from satsym.solvers.search.escaping import REMEDY, escape
from satsym.solvers.search.nearest import nearest
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import sizes_of
from satsym.solvers.search.starts import planning
from satsym.solvers.search.transcription import FREE, Places
from satsym.solvers.switching.linear.by_reach import unreachable
from satsym.solvers.switching.solving import NOT_FOUND
from satsym.solvers.switching.throttled import signs, switched
from satsym.status import Status

Reason = tuple[Status, str]
"""Status of an instance without a solution, and the message that explains it."""

BETWEEN, FAINT_SLOPE, LASTING = 0.05, 1e-2, 0.35
"""Minimum distance of a norm from its bounds, as a fraction of its range, at which it counts as intermediate. Magnitude
of its switching function, relative to the cost of the norm, below which the control is undetermined. Fraction of the
duration for which one of both has to last."""

LONGER, SHORTER = (4.0, 8.0, 16.0, 32.0), (0.25, 2.0**-4, 2.0**-6, 2.0**-8)
FAR_LONGER = (128.0, 512.0, 2048.0)
"""Multiples of the initial guess of a free duration at which costs are compared if no extremal is found. The last ones
are used if costs fall for all others, because a weight on time may only show there if the guess is far too short."""

FAR_OFF = 0.1
"""Relative distance from the final state above which other starts hardly ever arrive."""

ENDLESS, EVEN = 1e-2, 1e-7
"""Minimum relative decrease of the cost from each duration to a longer one, if nothing limits the duration. Minimum
relative difference of two costs that count as different, also in units of the cost."""

INTERVALS = (40, 80)
"""Number of intervals of the meshes on which the smallest violation of the path constraints is computed."""

REMAINING, UNAVOIDABLE = 0.5, 1e-6
"""Minimum ratio of the violation on the fine mesh to that on the coarse mesh, and minimum violation relative to the
constraint's magnitude, for which path constraints count as contradictory."""

PUSHING = 1e-2
"""Multiplier, relative to the largest, above which a constraint is named as part of a contradiction."""


def why(instance: Instance, limits: Limits, early: bool = False) -> Reason:
    """Return the status of an instance for which no start leads to an extremal, and a message.

    Parameters
    ----------
    early
        Whether other starts have not been tried yet; then only an end that is far from reached counts as unreachable.
    """
    if limits.late:
        return Status.TIME_LIMIT, "the time limit was reached before an extremal was found"
    message, limits = NOT_FOUND, replace(limits, meter=Meter())
    if instance.tf is None:
        message += f"; give {'a' if instance.tf_guess is None else 'another'} tf_guess"
    if endless := tried(partial(escape, instance)):
        return Status.NO_MINIMISER, f"{endless}; {REMEDY}"
    if instance.tf is not None and (separated := tried(partial(unreachable, instance, limits))):
        return Status.INFEASIBLE, separated
    if stated_constraints(instance.model.spec):
        against = tried(partial(contradiction, instance, limits))
        if against:
            return Status.INFEASIBLE, against
    if instance.tf is None:  # of ends that are out of reach nothing is said: another duration may reach them
        return _endless(instance, limits) or (Status.NOT_CONVERGED, message)
    several = [name for part in instance.model.spec.control_parts if part.ends for name in part.controls]
    near = None if several else tried(partial(nearest, instance, limits))
    if near is None or near.arrives:  # else no start leads to a motion of which anything could be undecided
        by_jumps = f"{message}; {_jumping(several)}" if several else message
        return Status.NOT_CONVERGED, _undecided(instance, limits) or by_jumps
    if limits.expired:
        return Status.TIME_LIMIT if limits.late else Status.NOT_CONVERGED, message
    if near.undecided or (early and near.distance <= FAR_OFF):
        return Status.NOT_CONVERGED, f"{message}; {near.message}, but other controls might reach it"
    return Status.INFEASIBLE, near.message


def _jumping(controls: list[str]) -> str:
    """Return the message for controls whose Hamiltonian may have several minimisers."""
    advice = "if two of them remain equally good, there is no optimum (chattering)"
    return f"H may have several minimisers in {', '.join(controls)}, and {advice}"


def _endless(instance: Instance, limits: Limits) -> Reason | None:
    """Return why no duration is the cheapest, or ``None`` if costs at several durations do not show it."""
    longer, shorter = (coarse.costs_by_duration(instance, limits, shares) for shares in (LONGER, SHORTER))
    both = longer + shorter
    if longer and shorter and not any(_clearly_less(a, b) for a in both for b in both):
        return Status.NO_MINIMISER, f"nothing determines the final time: {_listed(longer)}; fix the final time"
    if _always_cheaper(instance, longer, limits):
        advice = "add a cost of time, or fix the final time"
        return Status.NO_MINIMISER, f"a longer duration is always cheaper: {_listed(longer)}; {advice}"
    if shorter and all(_clearly_less(b, a) for a, b in pairwise(shorter)):
        advice = "give time a smaller weight, constrain the final state, or fix the final time"
        return Status.NO_MINIMISER, f"a shorter duration is always cheaper: {_listed(shorter)}; {advice}"
    return None


def _always_cheaper(instance: Instance, longer: list[coarse.Priced], limits: Limits) -> bool:
    """Return whether each longer duration is clearly cheaper, and none is cheaper than the longest of all.

    Durations that the coarse mesh does not resolve may have no costs, or too high ones.
    """
    if not longer or not all(_clearly_less(b, a, ENDLESS) for a, b in pairwise(longer)):
        return False
    far = [one for share in FAR_LONGER for one in coarse.costs_by_duration(instance, limits, (share,))]
    return not far or not any(_clearly_less(one, far[-1]) for one in [longer[-1], *far[:-1]])


def _clearly_less(one: coarse.Priced, than: coarse.Priced, share: float = EVEN) -> bool:
    """Return whether a motion costs less than another by a given fraction of the cost, and by more than rounding."""
    return one.cost < than.cost - max(share * abs(than.cost), EVEN * than.unit)


def _listed(tried: list[coarse.Priced]) -> str:
    costs, durations = (
        ", ".join(f"{value:.4g}" for value in row)
        for row in zip(*((one.cost, one.duration) for one in tried), strict=True)
    )
    return f"cost {costs} at durations {durations}"


def _undecided(instance: Instance, limits: Limits) -> str:
    """Return the message for norms that stay between their bounds for long, where no control law is known."""
    spec = instance.model.spec
    if not spec.throttled:
        return ""
    at = coarse.first_motion(instance, limits)
    if at is None:
        return ""
    low, high = (np.array(bounds)[:, None] for bounds in instance.control_set.switching)
    filled = (switched(instance, at.u) - low) / np.where(high > low, high - low, 1.0)
    between = (filled > BETWEEN) & (filled < 1.0 - BETWEEN)
    sigma, priced = (signs(instance, at.times, at.x, costates)[0] for costates in (at.lam, np.zeros_like(at.lam)))
    price = np.abs(priced).max(axis=1, keepdims=True)
    with np.errstate(all="ignore"):  # where norms cost nothing, no slope is small beside their price
        faint = (np.abs(sigma) <= FAINT_SLOPE * price) & (price > 0.0)
    if not ((between | faint[:, 1:]) @ at.steps > LASTING * at.steps.sum()).any():
        return ""
    single = [c for part in spec.control_parts if part.branch == "switched" for c in part.controls]
    what = "the norm of a vector"
    if single:
        alone = all(part.branch != "throttled" for part in spec.control_parts)
        what = f"the value of {' or '.join(single)}" if alone else "the value of a control"
    return f"no law is known for {what} on an interval where the minimum principle does not determine it"


class _Eased(Programme):
    """Nonlinear programme that minimises its last unknown, the relative violation of the path constraints."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.unknowns += 1
        path = self.kinds["path"]
        self.held = np.arange(path.first, path.first + len(path.upper))

    def begun(self) -> Array:
        """Return unknowns of the straight line to the final state, with its violation of the path constraints."""
        w = planning.begun(self, planning.Plan())
        y, _, _ = self._local(np.append(w, 0.0))
        n, given = self.points.states, self.controls.given
        found = measured(self.instance, y[self._time], y[:n], y[n : n + given])
        self.room = np.repeat(found[None, self.points.kept], self.count, 0).ravel()
        over = super().values(np.append(w, 0.0))[self.held] / self.room
        return np.append(w, max(float(over.max()), 0.0) + 1.0)

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Return lower and upper bounds of the unknowns."""
        low, high = super().bounds
        return np.append(low, 0.0), np.append(high, FREE)

    def objective(self, w: Array) -> float:
        """Return the last unknown, the relative violation of the path constraints."""
        return float(w[-1])

    def gradient(self, w: Array) -> Array:
        """Return the derivatives of :meth:`objective` with respect to all unknowns."""
        return np.append(np.zeros(self.unknowns - 1), 1.0)

    def values(self, w: Array) -> Array:
        """Return the constraint rows, shape (m,), with path constraints relaxed by the last unknown."""
        found = super().values(w)
        found[self.held] -= w[-1] * self.room
        return found

    def jacobian(self, w: Array) -> Array:
        """Return the entries of the constraint Jacobian, at the positions of :attr:`jacobian_places`."""
        return np.concatenate([super().jacobian(w), -self.room])

    @cached_property
    def jacobian_places(self) -> tuple[Places, Places]:
        """Return rows and columns of the entries of :meth:`jacobian`."""
        rows, columns = super().jacobian_places
        return np.concatenate([rows, self.held]), np.append(columns, np.full(len(self.held), self.unknowns - 1))

    def hessian(self, w: Array, multipliers: Array, factor: float) -> Array:
        """Return the Hessian of the Lagrangian; the objective is linear and does not contribute."""
        return super().hessian(w, multipliers, 0.0)


def contradiction(instance: Instance, limits: Limits) -> str:
    """Return the path constraints that no motion of a convex problem can satisfy together; empty if there are none.

    The largest violation of a path constraint is minimised. If motion and constraints are convex, this is a convex
    programme, so that its minimum is global.

    Parameters
    ----------
    instance
        Instance with path constraints.
    limits
        Limits of time and work.
    """
    controls = controls_of(instance)
    if controls is None or instance.tf is None or not convex(instance):
        return ""
    left, names = list[float](), list[str]()
    for intervals in INTERVALS:
        mesh, lasting = np.linspace(0.0, 1.0, intervals + 1), instance.tf - instance.t0
        with np.errstate(all="ignore"):
            programme = _Eased(instance, controls, [mesh], sizes_of(instance, controls, lasting))
            found = nlp.solve(programme, programme.begun(), limits)
        if not found.solved:
            return ""
        left.append(float(found.unknown[-1]))
        pushes = found.multipliers[programme.held].reshape(programme.count, -1).sum(axis=0)
        spec = instance.model.spec.path_constraints
        kept = [spec[place].name for place in programme.points.kept]
        names = [name for name, push in zip(kept, pushes, strict=True) if push > PUSHING * pushes.max()]
    if not left[1] > max(UNAVOIDABLE, REMAINING * left[0]):
        return ""
    against = ", ".join(names)
    return (
        f"no motion to the given final state satisfies the path constraints ({against}): one of them is always violated"
    )
