"""Stability of x' = A x, with the reason: eigenvalues off the imaginary axis, then Jordan blocks of those on it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Literal

import sympy as sp

from satsym.symbolic.analysis.routh import routh
from satsym.symbolic.analysis.spectrum import Factor, Spectrum

Verdict = Literal["asymptotically stable", "marginally stable", "unstable", "depends on the parameters"]

_TIMES = {1: "simple", 2: "double", 3: "triple"}
_GROWTH = {2: "linearly", 3: "quadratically", 4: "cubically"}


class Cause(Enum):
    """The reason of a verdict on stability; texts of verdicts have these names."""

    LEFT = "all left"
    BOUNDED = "bounded on the axis"
    RIGHT = "right"
    BLOCK = "block on the axis"
    PARAMETERS = "parameters decide"


@dataclass(frozen=True)
class Stability:
    """A verdict on stability with its reason."""

    verdict: Verdict
    cause: Cause
    """The argument that determines the verdict."""
    eigenvalues: tuple[sp.Expr, ...]
    """Eigenvalues to which the argument refers; empty if they have no closed form."""
    block: int
    """Size of the largest Jordan block of an eigenvalue on the imaginary axis; 0 if there is no such eigenvalue."""
    conditions: tuple[sp.Expr, ...]
    """Expressions that are all positive if and only if all eigenvalues have negative real parts.

    Empty unless stability depends on parameters.
    """
    reason: str
    """One English sentence without its full stop."""


def stability(of: Spectrum) -> Stability:
    """Decide the stability of the origin of x' = A x for all values that the parameters may take."""
    right = [f for f in of.factors if f.right]
    block = max((f.blocks[0] for f in of.factors if f.axis), default=0)
    if right:
        found = tuple(r for f in right for r in _growing(f))
        return Stability("unstable", Cause.RIGHT, found, block, (), _exponential(found))
    if any(f.right is None for f in of.factors):
        conditions = tuple(c for c in routh(of.coefficients).column[1:])
        reason = (
            "stability depends on the parameters: all eigenvalues have negative real parts if and only if each of "
            "these is positive: " + ", ".join(map(str, conditions))
        )
        return Stability("depends on the parameters", Cause.PARAMETERS, (), block, conditions, reason)
    if block > 1:
        worst = next(f for f in of.factors if f.axis and f.blocks[0] == block)
        return Stability("unstable", Cause.BLOCK, worst.roots, block, (), _polynomial(worst))
    if block:
        found = tuple(r for f in of.factors if f.axis for r in f.roots)
        reason = "the eigenvalues on the imaginary axis have Jordan blocks of size 1: deviations neither grow nor decay"
        return Stability("marginally stable", Cause.BOUNDED, found, block, (), reason)
    reason = "all eigenvalues have negative real parts: deviations decay exponentially"
    return Stability("asymptotically stable", Cause.LEFT, (), block, (), reason)


def _growing(factor: Factor) -> tuple[sp.Expr, ...]:
    """Return the roots of a factor whose real parts are known to be positive."""
    if factor.right == factor.degree:
        return factor.roots
    return tuple(r for r in factor.roots if (real := sp.re(r)).is_positive or (real.is_number and real.evalf() > 0))


def _exponential(found: tuple[sp.Expr, ...]) -> str:
    if not found:
        return "an eigenvalue has a positive real part: deviations grow exponentially"
    named = ", ".join(map(str, found))
    subject = f"the eigenvalue {named} has a" if len(found) == 1 else f"the eigenvalues {named} have"
    return f"{subject} positive real part{'s' * (len(found) > 1)}: deviations grow exponentially"


def _polynomial(factor: Factor) -> str:
    size, times = factor.blocks[0], sum(factor.blocks)
    growth = _GROWTH.get(size, f"like t^{size - 1}")
    manifold = _TIMES.get(times, f"{times}-fold")
    named = ", ".join(map(str, factor.roots)) or "roots of an irreducible factor"
    if len(factor.roots) == 1:
        return (
            f"the {manifold} eigenvalue {named} has a Jordan block of size {size}: deviations grow {growth} with time"
        )
    return (
        f"the {manifold} eigenvalues {named} on the imaginary axis have Jordan blocks of size {size}: "
        f"deviations grow {growth} with time"
    )
