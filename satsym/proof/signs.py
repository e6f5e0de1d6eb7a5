"""The signs for which the law of each arc minimises H all along it, shown between nodes as well."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb, arb_mat, arb_series, ctx

from satsym.proof.balls.arithmetic import Ball, BeyondProof, Key, NotProved, value
from satsym.proof.balls.jets import OPAQUE
from satsym.proof.balls.taylor import Step, polynomial, rates
from satsym.proof.ends import positive
from satsym.proof.laws import AtLevels, Law, Regular, Throttled
from satsym.proof.shooting import Junction, Pass, Shooting
from satsym.proof.walls import OnBoundary, OnMixed, require_push

DEEPEST = 16
"""Largest number of times that a step is halved to prove a sign on it."""
PARTS = 14
"""Largest number of times that a step is halved to locate the part in which a condition falls to zero."""

_LINEAR = "H is linear in the controls, and its coefficients do not all vanish"
_DIRECTED = {
    "angle": "H is a cosine of the direction, and its amplitude does not vanish",
    **dict.fromkeys(("ball", "annulus"), _LINEAR),
}
"""Kind of a control set -> reason why the direction found is the only minimiser of the Hamiltonian."""


@dataclass(frozen=True)
class Shown:
    """The signs shown along all arcs: how many, and at how many places one of them passes through zero."""

    conditions: int
    crossings: int


def hold(shooting: Shooting, passed: Pass) -> Shown:
    """Show that conditions of laws are positive, and that one which ends an arc passes through zero with a slope.

    Raises
    ------
    NotProved
        Where that is not so, or cannot be shown.
    """
    conditions = 0
    laws = [arc.law for arc in shooting.arcs]
    for j, (law, segments) in enumerate(zip(laws, passed.segments, strict=True)):
        before = shooting.junctions[j - 1] if j else None
        after = shooting.junctions[j] if j + 1 < len(laws) else None
        steps = [step for segment in segments for step in segment.steps]
        for k, step in enumerate(steps):
            conditions += _on_step(
                law, step, before if k == 0 else None, after if k == len(steps) - 1 else None, f"arc {j + 1}"
            )
        if isinstance(law, AtLevels):
            _require_weights(law, steps)
        if isinstance(law, OnBoundary):
            require_push(law, steps)
    return Shown(conditions, len(laws) - 1)


def _on_step(law: Law, step: Step, before: Junction | None, after: Junction | None, where: str) -> int:
    n = step.terms
    ctx.cap = n + 1
    near, last = law.conditions(step.series), law.conditions(step.last)
    for (key, c), (_, d) in zip(near, last, strict=True):
        condition = _Condition(law, key, step, [*(c[k] for k in range(n)), d[n]])
        first = last_part = 0.0
        if before and key == before.entering:
            first = _part(condition, before.order, 1, 1, where)
        if after and key == after.leaving:
            last_part = _part(condition, after.order, -1, (-1) ** after.order, where)
        if first + last_part >= 1.0:
            continue
        low, high = step.h * first, step.h * (1.0 - last_part)
        if not _positive(condition, low, high):
            raise NotProved(
                f"{where}: a sign that its law requires ({key[0]} {key[1]}) could not be shown; another structure "
                "may be right"
            )
    return len(near)


def _derived(series: Sequence[Ball], order: int) -> list[Ball]:
    """Return the coefficients of a derivative of a series."""
    for _ in range(order):
        series = [k * v for k, v in enumerate(series)][1:]
    return list(series)


def _part(condition: _Condition, order: int, end: int, sign: int, where: str) -> float:
    """Return the fraction of a step, from its beginning (1) or to its end (-1), on which a derivative has a sign.

    A condition that vanishes at that point, with all derivatives of lower order, is positive on that part except there.
    """
    h, derivative = condition.step.h, _derived(condition.series, order)
    for k in range(PARTS):
        w = h / 2**k
        between = arb(0).union(w) if end > 0 else (h - w).union(h)
        if sign * polynomial(derivative, between) > 0 or (order == 1 and sign * condition.rate(between) > 0):
            return float(2.0**-k)
    raise NotProved(
        f"{where}: a condition of its law vanishes at its end with zero slope (the switching is not transversal)"
    )


@dataclass(frozen=True)
class _Condition:
    """A condition of a law on a step, as a function of time."""

    law: Law
    key: Key
    step: Step
    series: list[Ball]

    def positive(self, time: Ball) -> bool:
        """Tell whether the condition is positive, by its series or by values over the motion."""
        return bool(polynomial(self.series, time) > 0 or self.at(time) > 0)

    def at(self, time: Ball) -> Ball:
        """Return the value of the condition over a ball of times."""
        ctx.cap = 1
        z = [arb_series([v]) for v in self.step.reached(time)]
        try:
            return value(dict(self.law.conditions(z))[self.key])
        except (ArithmeticError, ValueError):
            return arb(0, float("inf"))

    def rate(self, time: Ball) -> Ball:
        """Return the rate of change of the condition over a ball of times."""
        z = self.step.reached(time)
        try:
            moved = zip(z, rates(self.law, z), strict=True)
            ctx.cap = 2
            return dict(self.law.conditions([arb_series([v, r]) for v, r in moved]))[self.key][1]
        except (ArithmeticError, ValueError):
            return arb(0, float("inf"))


def _positive(condition: _Condition, low: Ball, high: Ball, depth: int = DEEPEST) -> bool:
    """Tell whether a condition is positive from one time to another."""
    if condition.positive(low.union(high)):
        return True
    middle = ((low + high) / 2).mid()
    if depth == 0 or condition.at(middle) <= 0:
        return False
    return _positive(condition, low, middle, depth - 1) and _positive(condition, middle, high, depth - 1)


def _require_weights(law: AtLevels, steps: Sequence[Step]) -> None:
    """Require that weights of magnitudes are not negative, since H would not be convex in the controls."""
    for step in steps:
        ctx.cap = 1
        t, x, lam = law.parts([arb_series([v]) for v in step.range])
        for weight in law.kernel.magnitude_weight(t, x, lam, law.p):
            if not value(weight) >= 0:
                raise NotProved("the weight of a control's magnitude could not be shown to be positive")


def unique(shooting: Shooting, passed: Pass) -> str:
    """Show that H has one minimiser along all arcs, and that states are inside their domain; the reason, in words.

    The signs of :func:`hold` are part of the reason.

    Raises
    ------
    NotProved
        Where that cannot be shown.
    """
    reason = ""
    spec = shooting.statement.spec
    inside = [i for i, v in enumerate(spec.states) if v.positive]
    for arc, segments in zip(shooting.arcs, passed.segments, strict=True):
        for segment in segments:
            for step in segment.steps:
                if not all(step.range[i] > 0 for i in inside):
                    raise NotProved("a state that must be positive could not be shown to remain positive")
                reason = _of_hamiltonian(arc.law, step)
    return reason


def _of_hamiltonian(law: Law, step: Step) -> str:
    if isinstance(law, AtLevels):
        return "H is linear in the controls and their magnitudes, and no switching function vanishes within an arc"
    if isinstance(law, Throttled):
        return "H is linear in the controls and their norm, and the switching function does not vanish within an arc"
    assert isinstance(law, Regular | OnBoundary | OnMixed)
    spec = law.kernel.spec
    if spec.control_parts:
        return _DIRECTED[spec.control_parts[0].kind]
    ctx.cap = 1
    t, x, lam = law.parts([arb_series([v]) for v in step.range])
    m = len(spec.controls)
    try:
        entries = [value(v) for v in law.kernel.control_hessian(t, x, [OPAQUE] * m, lam, law.p)]
    except TypeError:
        raise BeyondProof("a Hamiltonian that is not quadratic in the controls") from None
    if not positive(arb_mat(m, m, entries)):
        raise NotProved("H_uu could not be shown to be positive definite")
    return "H is quadratic in the controls, and H_uu is positive definite"
