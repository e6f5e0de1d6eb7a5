"""The set of admissible controls: its bounds, what regularises it, projection onto it, and where its boundary is."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.spec import ControlSetKind, ProblemSpec

Row = tuple[float, ...]

UNSMOOTHED = 1e-100
"""The smoothing of a switching problem itself: none."""


@dataclass(frozen=True)
class ControlSet:
    """Which controls are admissible, and how much of a regularisation there is."""

    kind: ControlSetKind | None
    """Which of the following count; ``None`` for a model without a cost, whose controls are free."""
    lower: Row = ()
    upper: Row = ()
    """Of a box: bounds in the model's order, infinite where there is none."""
    radius: float = math.inf
    """Of a ball: the largest norm, infinite where there is none."""
    smoothing: float = 0.0
    """What half the squared controls is weighed with in the cost of a regularised problem, in the unit of the running
    cost over that of the squared control; zero where controls do not enter the Hamiltonian affinely."""
    fraction: float = 1.0
    """Of the weight of |u| that counts there, 0 to 1."""

    @classmethod
    def of(cls, spec: ProblemSpec, lower: Row, upper: Row, radius: float) -> ControlSet:
        """That of a problem with these bounds, nothing regularised."""
        return cls(spec.control_set, lower, upper, radius, UNSMOOTHED if spec.switching else 0.0)

    @classmethod
    def from_arguments(cls, spec: ProblemSpec, bounds: Sequence[Any]) -> ControlSet:
        """What generated functions were given as :attr:`arguments`, numbers or arrays."""
        m = len(spec.controls)
        if spec.control_set == "ball":
            return cls("ball", radius=bounds[0])
        if spec.control_set != "box":
            return cls(spec.control_set)
        return cls("box", tuple(bounds[:m]), tuple(bounds[m : 2 * m]), math.inf, *bounds[2 * m :])

    @cached_property
    def arguments(self) -> Row:
        """The argument ``bounds`` of generated functions: bounds or radius, then what regularises."""
        if self.kind == "box":
            return self.lower + self.upper + ((self.smoothing, self.fraction) if self.smoothing else ())
        return (self.radius,) if self.kind == "ball" else ()

    @property
    def bounded(self) -> bool:
        """Whether any bound is finite."""
        return any(map(math.isfinite, (*self.lower, *self.upper, self.radius)))

    def relaxed(self, by: float) -> ControlSet:
        """With relaxed bounds: every one moved outwards, in the controls' units."""
        if self.kind == "box":
            lower, upper = tuple(low - by for low in self.lower), tuple(high + by for high in self.upper)
            return replace(self, lower=lower, upper=upper)
        return replace(self, radius=self.radius + by) if self.kind == "ball" else self

    @cached_property
    def without_bounds(self) -> ControlSet:
        """The same for an unlimited control."""
        return self.relaxed(math.inf)

    def regularised(self, smoothing: float, fraction: float) -> ControlSet:
        """The same of a regularised problem."""
        return replace(self, smoothing=smoothing, fraction=fraction)

    def saturated(self, u: Row) -> ControlSet:
        """That in which only this control is admissible."""
        return replace(self, lower=u, upper=u)

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """Lower and upper bounds as columns, shapes (m, 1)."""
        return np.array(self.lower)[:, None], np.array(self.upper)[:, None]

    @cached_property
    def rest(self) -> Row:
        """The control of least magnitude in a box."""
        return tuple(min(max(0.0, low), high) for low, high in zip(self.lower, self.upper, strict=True))

    def project(self, u: Array) -> Array:
        """The nearest admissible controls.

        Parameters
        ----------
        u
            Controls, shape (m, M).
        """
        if self.kind == "box":
            low, high = self.box
            return np.minimum(np.maximum(u, low), high)
        if self.kind == "ball":
            norm = np.linalg.norm(u, axis=0)
            return np.where(norm > self.radius, u * (self.radius / np.maximum(norm, 1e-300)), u)
        return u

    def nearest(self) -> Callable[[Sequence[float]], Sequence[float]]:
        """The nearest admissible control as a function of one, for loops on plain floats; see :meth:`project`."""
        if self.kind == "box":
            bounds = list(zip(self.lower, self.upper, strict=True))
            return lambda u: [min(max(v, low), high) for v, (low, high) in zip(u, bounds, strict=True)]
        if self.kind == "ball":
            return lambda u: [v * min(1.0, self.radius / max(math.hypot(*u), 1e-300)) for v in u]
        return lambda u: u

    def active(self, unbounded: Array) -> NDArray[np.int8]:
        """Which bound saturates each control: -1 the lower, 1 the upper, 0 none; on a ball 1 or 0.

        Parameters
        ----------
        unbounded
            What the controls would be without bounds, shape (m, M).
        """
        if self.kind == "box":
            low, high = self.box
            return (unbounded > high).astype(np.int8) - (unbounded < low).astype(np.int8)
        if self.kind == "ball":
            outside = np.linalg.norm(unbounded, axis=0) > self.radius
            return np.broadcast_to(outside, unbounded.shape).astype(np.int8)
        return np.zeros(unbounded.shape, np.int8)

    def excess(self, unbounded: Array) -> Array:
        """Signed distances to each bound, whose zeros are the switching times; shape (bounds, M).

        The rows are, for a box, control minus lower bound and control minus upper bound for each control; for a
        ball the norm minus its limit. Bounds that are infinite have rows of infinities.
        """
        if self.kind == "box":
            return np.concatenate([unbounded - bound for bound in self.box])
        if self.kind == "ball":
            return (np.linalg.norm(unbounded, axis=0) - self.radius)[None, :]
        return np.empty((0, unbounded.shape[1]))

    def violation(self, u: Array) -> float:
        """By how much controls leave the set at most; not positive where they do not."""
        distances = self.excess(u)
        if self.kind == "box":
            m = len(u)
            distances = np.concatenate([-distances[:m], distances[m:]])
        return float(distances.max(initial=-np.inf))
