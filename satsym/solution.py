"""The results of solving and simulating: trajectories with their facts, ready for reports."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.status import Scope, Status, Verdict


@dataclass(frozen=True)
class Iteration:
    """One iteration in a solver's history.

    Attributes
    ----------
    number
        Number of the iteration; 0 is the starting point.
    objective
        The cost there; NaN where it is not known, as on the way to exact arcs.
    residual
        Residual of the optimality conditions, relative to the size of the control.
    """

    number: int
    objective: float
    residual: float


Progress: TypeAlias = Callable[[Iteration], None]
"""Called after each iteration of a solver."""


@dataclass(frozen=True)
class Event:
    """An event on the way: an entry, an exit or a touch point of a path constraint, a point on the way, or a jump.

    A jump is that of a control from one minimiser of H to another.

    Attributes
    ----------
    kind
        ``"entry"``, ``"exit"``, ``"touch"``, ``"interior"`` or ``"jump"``.
    name
        Name of the constraint, the point or the control.
    t
        Time of the event.
    """

    kind: str
    name: str
    t: float


@dataclass(frozen=True)
class Check:
    """A measured condition of optimality, with its limit."""

    name: str
    value: float
    limit: float

    @property
    def passed(self) -> bool:
        """Return whether the value is within its limit; a NaN never is."""
        return self.value <= self.limit


class Kind(str, Enum):
    """The kinds of competitors; the kind of a trajectory is visible from the trajectory."""

    NEIGHBOURS = "neighbours"  # in results that version 0.2 saved
    REVOLUTIONS = "revolutions"
    DURATIONS = "duration"
    STARTS = "seeded starts"
    FURTHER = "further starts"  # never tried: named where those that were tried kept finding new motions
    ARCS = "structure of boundary arcs"
    TIMES = "other times at waypoints"
    ENDS = "other limits of the end"  # in results that version 0.2 saved
    UNKNOWNS = "other values of the free quantities"


@dataclass(frozen=True)
class Competitors:
    """The competitors of one kind that a solution is compared with.

    Attributes
    ----------
    kind
        The kind of these competitors.
    tried
        Number of searches: ``solved`` plus ``unanswered``.
    solved
        Number of searches that led to an admissible motion to the final state; finding the solution itself again
        counts.
    cheapest
        The lowest cost of these motions; NaN if there are none.
    """

    kind: Kind
    tried: int
    solved: int
    cheapest: float

    @property
    def unanswered(self) -> int:
        """Return the number of searches that found no motion to the final state."""
        return self.tried - self.solved


@dataclass(frozen=True)
class Certificate:
    """Evidence for an optimum, which anyone can recompute from the initial costates.

    Attributes
    ----------
    verdict
        Verdict on the solution.
    boundary_residual
        Largest relative residual of the final conditions after integration from the initial costates.
    dynamics_defect
        Largest relative distance of the solver's trajectory from the integrated one.
    stationarity
        Largest relative difference of the control from the one that minimises H.
    hamiltonian_drift
        Largest relative change of H along the flow; ``None`` if H depends on time explicitly.
    legendre_clebsch
        Smallest eigenvalue of H_uu; for controls that switch, the smallest value of the generalised condition on
        singular arcs (NaN if there are none).
    conjugate_time
        The first conjugate time, or ``None``.
    checks
        All measured conditions, with their limits.
    competitors
        The competing solutions, by kind.
    not_checked
        Kinds of competitors that the problem allows but that were not compared: they were not tried, none of them was
        solved, or the time limit was reached.
    scope
        Whether the minimum is local or global.
    because
        The theorem on which the verdict rests or, where there is none, the first condition that could not be proved.
    """

    verdict: Verdict
    boundary_residual: float
    dynamics_defect: float
    stationarity: float
    hamiltonian_drift: float | None
    legendre_clebsch: float
    conjugate_time: float | None
    checks: tuple[Check, ...]
    competitors: tuple[Competitors, ...] = ()
    not_checked: tuple[Kind, ...] = ()
    scope: Scope = Scope.LOCAL
    because: str = ""


@dataclass(frozen=True)
class CostInterval:
    """An interval that contains the least cost, where the optimum switches infinitely often.

    The shown answer is then the optimum of a regularised problem: an admissible motion, whose cost is the upper end.

    Attributes
    ----------
    lower, upper
        The least cost is not above the latter, nor below the former if the problem is convex; otherwise that is an
        estimate to first order.
    smoothing
        So many times half the squared controls are added to the running cost of the regularised problem.
    """

    lower: float
    upper: float
    smoothing: float


@dataclass(frozen=True, eq=False)
class Solution:
    """The outcome of a solver run.

    Attributes
    ----------
    instance
        The instance that was solved, with names, units and bounds.
    method, status, message
        Solver, outcome, and one sentence for people.
    objective
        The cost J, which is minimised, so that it is minus the objective that a model maximises; NaN where there is
        none.
    times
        Nodes, shape (N+1,). Where a control jumps, the time occurs twice: the end of one arc and the start of the next.
    x, u, lam
        States (n, N+1), controls (m, N+1) and costates (n, N+1) at the nodes.
    switching_times
        For each control, the times at which it reaches or leaves a bound.
    iterations, history
        Number of iterations, and a record of each.
    wall_s
        Seconds of solving, without loading and reporting.
    certificate
        Certificate of the solution; ``None`` without a solution.
    events
        Entries, exits and touch points of path constraints, and jumps of controls between minimisers of H, in order of
        time.
    intermediate
        Solutions of the preceding problems of a continuation, in order.
    interval
        Interval that contains the least cost, if controls chatter.
    """

    instance: Instance
    method: str
    status: Status
    message: str
    objective: float
    times: Array
    x: Array
    u: Array
    lam: Array
    switching_times: tuple[tuple[float, ...], ...]
    iterations: int
    history: tuple[Iteration, ...]
    wall_s: float
    certificate: Certificate | None = None
    events: tuple[Event, ...] = ()
    intermediate: tuple[Solution, ...] = ()
    interval: CostInterval | None = None


@dataclass(frozen=True)
class Invariant:
    """A conserved quantity: its initial value, and the largest departure from it, in its own unit."""

    initial: float
    drift: float


@dataclass(frozen=True, eq=False)
class Simulation:
    """A simulated motion.

    Attributes
    ----------
    instance
        The instance that was simulated.
    feedback
        Name of the control law, ``"none"`` for the uncontrolled motion.
    status, message
        Outcome, and one sentence for people.
    times, x, u
        As in :class:`Solution`.
    invariants
        Conserved quantities of the uncontrolled motion, and balances that hold under every control, by name.
    metrics
        Numbers that describe the motion, by name.
    """

    instance: Instance
    feedback: str
    status: Status
    message: str
    times: Array
    x: Array
    u: Array
    invariants: dict[str, Invariant]
    metrics: dict[str, float]
