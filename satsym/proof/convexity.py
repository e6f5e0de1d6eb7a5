"""Where an extremal is a global minimum: linear motion, convex cost and convex control set, in given time.

Then H is convex in states and controls together, and every normal extremal is optimal among all admissible motions
(Mangasarian). Linearity and the second derivatives are read from the model with states and controls unbounded: what
comes out finite does not depend on them.
"""

from __future__ import annotations

from typing import Any

from flint import arb, ctx

from satsym.proof.balls.arithmetic import Answers, Ball, constant, value
from satsym.proof.balls.jets import Jet, variables
from satsym.proof.statement import Statement


def convex(statement: Statement) -> str:
    """In what a problem is convex, in words; empty where that is not known.

    A range of a final state is a convex end set, and so is a given state; a final time that is free is not.
    """
    spec = statement.spec
    if statement.tf is None or spec.control_set not in ("free", "box", "ball") or not spec.autonomous:
        return ""
    n, m = len(spec.states), len(spec.controls)
    anywhere = arb(0, float("inf"))
    ctx.cap = 1
    given = variables([anywhere] * (n + m))
    kernel, p = statement.kernel, statement.p
    before, kernel.answers = kernel.answers, _Undecided()
    try:
        motion = kernel.dynamics(constant(0), given[:n], given[n:], p)
        cost = kernel.running_cost(constant(0), given[:n], given[n:], p)
        end = kernel.terminal_cost(constant(statement.tf), given[:n], p)
    except (ArithmeticError, ValueError, _Asked):
        return ""
    finally:
        kernel.answers = before
    if any(_second(v) for v in motion if isinstance(v, Jet)):
        return ""
    if any(not v[0].is_finite() for one in motion if isinstance(one, Jet) for v in one.first.values()):
        return ""
    if not (_semidefinite(cost, n + m) and _semidefinite(end, n + m)):
        return ""
    return "the motion is linear, the costs are convex, so is the control set, and the final time is given"


class _Asked(Exception):
    pass


class _Undecided(Answers):
    """Of a comparison there is no answer where states may be anything."""

    def below(self, key: Any, a: Any, b: Any) -> bool:
        raise _Asked


def _second(jet: Jet) -> bool:
    """Whether a second derivative is other than zero."""
    return any(not value(v).is_zero() for v in jet.second.values())


def _semidefinite(jet: Any, count: int) -> bool:
    """Whether a Hessian is the same everywhere and nonnegative, by the pivots of its elimination."""
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
