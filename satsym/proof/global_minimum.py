"""Problems whose extremal is a global minimum.

In the first case the cost is a sum of squares of the controls, and the final state is free. Then zero control is
optimal, and no other control costs nothing. What has to be shown is that the uncontrolled motion exists until the
final time. In the second case the motion is linear, the cost and the control set are convex, and the final time is
given. Then H is convex in states and controls together, and every normal extremal is optimal among all admissible
motions (Mangasarian). The third case is minimum time to a point of rest, with a linear motion. Linearity and the second
derivatives are read from the model with states and controls unbounded: what comes out finite does not depend on them.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from typing import Any

from flint import arb, arb_mat, ctx

from satsym.proof.balls.arithmetic import Answers, Ball, NotProved, Series, constant, value
from satsym.proof.balls.jets import OPAQUE, Jet, derivatives, gradients, variables
from satsym.proof.balls.taylor import Order
from satsym.proof.ends import positive
from satsym.proof.shooting import integrated
from satsym.proof.statement import Statement

POINTS, SEED = 3, 20261


def costs_nothing(statement: Statement) -> bool:
    """Tell whether zero control is optimal: it is admissible, others cost something, and the end is free."""
    spec = statement.spec
    if (
        statement.free
        or statement.targets
        or statement.open_ranges
        or spec.multipliers
        or statement.tf is None
        or spec.control_parts
        or spec.switching
    ):
        return False
    if spec.path_constraints or spec.maximise or not spec.autonomous:
        return False
    within = zip(statement.lower, statement.upper, strict=True)
    if spec.control_set == "box" and not all(admits_zero(low, high) for low, high in within):
        return False
    return _squares(statement) and _nothing_at_the_end(statement)


def admits_zero(low: Any, high: Any) -> bool:
    """Tell whether zero lies between the bounds of a control."""
    return bool((low == -math.inf or low <= 0) and (high == math.inf or high >= 0))


def _squares(statement: Statement) -> bool:
    """Tell whether the running cost is a positive definite quadratic form in the controls alone."""
    n, m = len(statement.spec.states), len(statement.spec.controls)
    ctx.cap = 1

    def cost(at: Ball) -> tuple[Ball, list[Ball], list[list[Ball]]]:
        u = variables([at] * m)
        return derivatives(lambda: statement.kernel.running_cost(OPAQUE, [OPAQUE] * n, u, statement.p), m)

    try:
        there, slopes, _ = cost(arb(0))
        _, _, bends = cost(arb(0, math.inf))
    except TypeError:  # it depends on the states
        return False
    entries = [v for row in bends for v in row]
    least = there.is_zero() and all(v.is_zero() for v in slopes)
    return bool(least and all(v.is_finite() for v in entries) and positive(arb_mat(m, m, entries)))


def _nothing_at_the_end(statement: Statement) -> bool:
    """Tell whether the terminal cost vanishes: it is analytic, and exactly zero over balls about random points."""
    drawn, n = random.Random(SEED), len(statement.spec.states)
    ctx.cap = 1
    for _ in range(POINTS):
        x = [constant(arb(drawn.uniform(0.5, 2.0), 0.1)) for _ in range(n)]
        if not value(statement.kernel.terminal_cost(constant(statement.tf), x, statement.p)).is_zero():
            return False
    return True


class Uncontrolled:
    """The motion without control, as a field of the states."""

    def __init__(self, statement: Statement) -> None:
        self.kernel, self.p = statement.kernel, statement.p
        self.u = [constant(0)] * len(statement.spec.controls)

    def rates(self, z: Sequence[Series]) -> list[Series]:
        return [v + constant(0) for v in self.kernel.dynamics(OPAQUE, z, self.u, self.p)]

    def jacobian(self, z: Sequence[Series]) -> list[Series]:
        return gradients(lambda given: self.kernel.dynamics(OPAQUE, given, self.u, self.p), z)

    def cost(self, z: Sequence[Series]) -> Series:
        return constant(0)


def final_state(statement: Statement, order: Order, sizes: Sequence[float]) -> tuple[list[Ball], int]:
    """Return the end of the uncontrolled motion, and the number of steps that enclosed it.

    Raises
    ------
    NotProved
        If it is not shown to exist until then.
    """
    n = len(statement.initial)
    span = statement.tf - statement.t0
    found = integrated(Uncontrolled(statement), list(statement.initial), [arb(0)] * n, span, arb(0), order, sizes)
    inside = [i for i, v in enumerate(statement.spec.states) if v.positive]
    if not all(step.range[i] > 0 for step in found.steps for i in inside):
        raise NotProved("a state that must be positive could not be shown to remain positive")
    return found.point, len(found.steps)


def convex(statement: Statement) -> str:
    """State why a problem is convex, in words; empty where that is not known.

    A range of a final state is a convex end set, and so are a given state and linear equations and inequalities; a free
    final time is not.
    """
    spec = statement.spec
    if statement.tf is None or spec.control_set not in ("free", "box", "ball") or not spec.autonomous:
        return ""
    if any(target.turns is not None for target in statement.targets.values()) or not _affine_end(statement):
        return ""
    n, m = len(spec.states), len(spec.controls)
    kernel, p = statement.kernel, statement.p
    cost = _anywhere(statement, lambda given: [kernel.running_cost(constant(0), given[:n], given[n:], p)])
    end = _anywhere(statement, lambda given: [kernel.terminal_cost(constant(statement.tf), given[:n], p)])
    if cost is None or end is None or not _linear(statement):
        return ""
    if not (_semidefinite(cost[0], n + m) and _semidefinite(end[0], n + m)):
        return ""
    return "the motion is linear, the costs and the control set are convex, and the final time is given"


def waiting(statement: Statement) -> str:
    """State why no other motion reaches the end in less time; empty where that is not known.

    Where the motion is linear, the controls that alone minimise H also minimise lambda' x at the final time, among all
    motions until then. A motion that arrives earlier, at a point where it can stay without control, may wait there
    until that time; its lambda' x is then as small, under other controls: H vanishes at the end, and without control it
    would be the running cost, which is positive.
    """
    spec, kernel, p = statement.spec, statement.kernel, statement.p
    n, m = len(spec.states), len(spec.controls)
    if statement.tf is not None or spec.control_set not in ("box", "ball") or not spec.autonomous:
        return ""
    if spec.path_constraints or spec.multipliers or spec.maximise or len(statement.targets) != n:
        return ""
    if any(target.value is None or target.side or target.turns is not None for target in statement.targets.values()):
        return ""
    if not all(admits_zero(low, high) for low, high in zip(statement.lower, statement.upper, strict=True)):
        return ""
    ctx.cap = 1
    try:
        rate = value(kernel.running_cost(OPAQUE, [OPAQUE] * n, [OPAQUE] * m, p))
        end = value(kernel.terminal_cost(OPAQUE, [OPAQUE] * n, p))
    except TypeError:  # one of them depends on something
        return ""
    there = [constant(statement.targets[i].value) for i in range(n)]
    still = kernel.dynamics(constant(0), there, [constant(0)] * m, p)
    if not (rate > 0 and end.is_zero() and all(value(v).is_zero() for v in still) and _linear(statement)):
        return ""
    return (
        "the motion is linear, time alone is the cost, and the final state is an equilibrium of the uncontrolled motion"
    )


def _linear(statement: Statement) -> bool:
    """Tell whether the rates of the states are linear in states and controls, apart from constants."""
    kernel, n = statement.kernel, len(statement.spec.states)
    motion = _anywhere(statement, lambda given: kernel.dynamics(constant(0), given[:n], given[n:], statement.p))
    jets = [one for one in motion or () if isinstance(one, Jet)]
    finite = all(v[0].is_finite() for one in jets for v in one.first.values())
    return motion is not None and finite and not any(_second(one) for one in jets)


def _affine_end(statement: Statement) -> bool:
    """Tell whether constraints at the end are linear in the states, so that the end set is convex."""
    kernel, n = statement.kernel, len(statement.spec.states)
    if not statement.spec.multipliers:
        return True
    rows = _anywhere(
        statement, lambda given: kernel.terminal_constraints(constant(statement.tf), given[:n], statement.p)
    )
    jets = [one for one in rows or () if isinstance(one, Jet)]
    finite = all(v[0].is_finite() for one in jets for v in one.first.values())
    return rows is not None and finite and not any(_second(one) for one in jets)


def _anywhere(statement: Statement, function: Callable[[list[Jet]], Sequence[Any]]) -> Sequence[Any] | None:
    """Evaluate a function at unbounded states and controls; ``None`` where it compares them."""
    ctx.cap = 1
    given = variables([arb(0, float("inf"))] * (len(statement.spec.states) + len(statement.spec.controls)))
    kernel = statement.kernel
    before, kernel.answers = kernel.answers, _Undecided()
    try:
        return function(given)
    except (ArithmeticError, ValueError, _Asked):
        return None
    finally:
        kernel.answers = before


class _Asked(Exception):
    pass


class _Undecided(Answers):
    """Answers of comparisons for unbounded states: none can be given."""

    def below(self, key: Any, a: Any, b: Any) -> bool:
        raise _Asked


def _second(jet: Jet) -> bool:
    """Tell whether a second derivative differs from zero."""
    return any(not value(v).is_zero() for v in jet.second.values())


def _semidefinite(jet: Any, count: int) -> bool:
    """Tell whether a Hessian is constant and positive semidefinite, by the pivots of its elimination."""
    if not isinstance(jet, Jet):
        return True
    a: list[list[Ball]] = [[arb(0)] * count for _ in range(count)]
    for (i, j), v in jet.second.items():
        if not value(v).is_finite():
            return False
        a[i][j] = a[j][i] = value(v)
    left = list(range(count))
    while left:
        pivot = next((k for k in left if a[k][k] > 0), None)
        if pivot is None:  # what is left must vanish exactly
            return all(a[i][j].is_zero() for i in left for j in left)
        left.remove(pivot)
        for i in left:
            for j in left:
                a[i][j] = a[i][j] - a[i][pivot] * a[pivot][j] / a[pivot][pivot]
    return True
