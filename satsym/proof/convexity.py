"""Where an extremal is a global minimum.

One case is a linear motion with a convex cost and a convex control set, in given time. Then H is convex in states and
controls together, and every normal extremal is optimal among all admissible motions (Mangasarian). The other case is
least time to a point of rest, with a linear motion. Linearity and the second derivatives are read from the model with
states and controls unbounded: what comes out finite does not depend on them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from flint import arb, ctx

from satsym.proof.balls.arithmetic import Answers, Ball, constant, value
from satsym.proof.balls.jets import OPAQUE, Jet, variables
from satsym.proof.rest import admits_zero
from satsym.proof.statement import Statement


def convex(statement: Statement) -> str:
    """Say why a problem is convex, in words; empty where that is not known.

    A range of a final state is a convex end set, and so are a given state and linear equations and inequalities; a
    final time that is free is not.
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
    """Say why no other motion takes less time to the end, in words; empty where that is not known.

    Where the motion is linear, the controls that alone minimise H also make lambda' x least at the final time, among
    all motions until then. Whoever arrives earlier at a point where one can stay without control may wait there until
    that time; lambda' x is then as small, by other controls: H vanishes at the end, and without control it would be
    the running cost, which is positive.
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
    return "the motion is linear, time alone is the cost, and the end is an equilibrium of the uncontrolled motion"


def _linear(statement: Statement) -> bool:
    """Whether the rates of the states are linear in states and controls, apart from constants."""
    kernel, n = statement.kernel, len(statement.spec.states)
    motion = _anywhere(statement, lambda given: kernel.dynamics(constant(0), given[:n], given[n:], statement.p))
    jets = [one for one in motion or () if isinstance(one, Jet)]
    finite = all(v[0].is_finite() for one in jets for v in one.first.values())
    return motion is not None and finite and not any(_second(one) for one in jets)


def _affine_end(statement: Statement) -> bool:
    """Whether constraints at the end are linear in the states, apart from constants: a convex end set, then."""
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
    """What a function returns of states and controls that may be anything; ``None`` where it asks which."""
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
    """Answers of comparisons where states may be anything: there are none."""

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
