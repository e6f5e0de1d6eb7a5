"""Problems that are solved by doing nothing: a sum of squares of the controls is the cost, and the end is free.

Then zero control is optimal, and only none costs nothing. What has to be shown is that the uncontrolled motion
exists until the final time.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import Any

from flint import arb, arb_mat, ctx

from satsym.proof.balls.arithmetic import Ball, NotProved, Series, constant, value
from satsym.proof.balls.jets import OPAQUE, derivatives, gradients, variables
from satsym.proof.balls.taylor import Order
from satsym.proof.ends import positive
from satsym.proof.shooting import integrated
from satsym.proof.statement import Statement

POINTS, SEED = 3, 20261


def costs_nothing(statement: Statement) -> bool:
    """Whether no control is the best one: it is admissible, others cost something, and the end is free."""
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
    """Whether zero lies between bounds of a control."""
    return bool((low == -math.inf or low <= 0) and (high == math.inf or high >= 0))


def _squares(statement: Statement) -> bool:
    """Whether the running cost is a positive definite quadratic form in the controls alone."""
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
    """Whether the terminal cost vanishes: it is analytic, and exactly zero over balls about random points."""
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
    """Where the uncontrolled motion ends, and in how many steps that was shown.

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
        raise NotProved("a state is not shown to stay positive, which its meaning asks for")
    return found.point, len(found.steps)
