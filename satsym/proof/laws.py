"""The control laws of arcs: how controls follow from states and costates, and what must be positive for that.

A law is an analytic field of states, costates and, where the motion depends on it, time; it is defined beyond the arc
on which its controls minimise H. The components are (x, lambda) or (x, lambda, t).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Any

from flint import arb, arb_series, ctx

from satsym.proof.balls.arithmetic import Answers, Ball, Key, NotProved, Series, constant, value
from satsym.proof.balls.kernel import BallKernel

SIMULTANEOUS = "two bounds are reached or left at the same time; the theorem requires one at a time"


def hamiltonian(kernel: BallKernel, t: Any, x: Sequence[Any], u: Sequence[Any], lam: Sequence[Any], p: Any) -> Any:
    """Return H, from the motion and the running cost of a kernel alone."""
    total = kernel.running_cost(t, x, u, p) + constant(0)
    for a, b in zip(lam, kernel.dynamics(t, x, u, p), strict=True):
        total = a * b + total
    return total


class Law(ABC):
    """A law of the controls along an arc.

    Parameters
    ----------
    kernel
        The model.
    parameters
        The parameters of the model, as constants.
    """

    def __init__(self, kernel: BallKernel, parameters: Sequence[Series]) -> None:
        self.kernel, self.p, self.n = kernel, tuple(parameters), len(kernel.spec.states)
        self.timed = not kernel.spec.autonomous
        self.m = 2 * self.n + self.timed
        self.answers = Answers()

    def parts(self, z: Sequence[Series]) -> tuple[Series, Sequence[Series], Sequence[Series]]:
        """Return time, states and costates."""
        self.kernel.answers = self.answers
        return (z[-1] if self.timed else _NEVER), z[: self.n], z[self.n : 2 * self.n]

    def rates(self, z: Sequence[Series]) -> list[Series]:
        """Return the rates of change of all components."""
        found = list(self._rates(z))
        return [*found, constant(1)] if self.timed else found

    def jacobian(self, z: Sequence[Series]) -> list[Series]:
        """Return the derivatives of the rates by the components, row by row."""
        found, n = list(self._jacobian(z)), 2 * self.n
        if not self.timed:
            return found
        drift = self._drift(z)
        rows = [[*found[n * i : n * i + n], drift[i]] for i in range(n)]
        return [v for row in rows for v in row] + [constant(0)] * (n + 1)

    def cost(self, z: Sequence[Series]) -> Series:
        """Return the running cost under the law."""
        t, x, _ = self.parts(z)
        return self.kernel.running_cost(t, x, self.control(z), self.p) + constant(0)

    @abstractmethod
    def control(self, z: Sequence[Series]) -> Sequence[Series]:
        """Return the controls of the law."""

    @abstractmethod
    def conditions(self, z: Sequence[Series]) -> list[tuple[Key, Series]]:
        """Return the quantities that must be positive along the arc, by key."""

    @abstractmethod
    def leaving(self, other: Law) -> Key:
        """Return the key of the condition that vanishes at the junction with another law."""

    @abstractmethod
    def _rates(self, z: Sequence[Series]) -> Sequence[Series]: ...

    @abstractmethod
    def _jacobian(self, z: Sequence[Series]) -> Sequence[Series]: ...

    def _drift(self, z: Sequence[Series]) -> Sequence[Series]:
        raise NotImplementedError


class _Never:
    """A placeholder for time where no function depends on it."""


_NEVER: Any = _Never()


class Regular(Law):
    """A law in which the generated function gives the controls, with fixed answers to its comparisons.

    Parameters
    ----------
    bounds
        The argument of that name: constants, or infinite floats.
    """

    def __init__(self, kernel: BallKernel, parameters: Sequence[Series], bounds: Sequence[Any]) -> None:
        super().__init__(kernel, parameters)
        self.bounds = tuple(bounds)

    def control(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        return self.kernel.control_law(t, x, lam, self.p, self.bounds)

    def conditions(self, z: Sequence[Series]) -> list[tuple[Key, Series]]:
        return list(dict(self.answers.notes(lambda: self._rates(z))).items())

    def leaving(self, other: Law) -> Key:
        found = [
            key
            for key, answer in self.answers.given.items()
            if key[0] == "canonical" and other.answers.given.get(key, answer) is not answer
        ]
        if len(found) != 1:
            raise NotProved(SIMULTANEOUS)
        return found[0]

    def state(self) -> frozenset[tuple[Key, bool]]:
        """Return the answers to the comparisons of the motion; two arcs of one law have equal ones."""
        return frozenset(item for item in self.answers.given.items() if item[0][0] == "canonical")

    def _rates(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        return self.kernel.canonical(t, x, lam, self.p, self.bounds)

    def _jacobian(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        return self.kernel.canonical_jacobian(t, x, lam, self.p, self.bounds)

    def _drift(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        return self.kernel.canonical_drift(t, x, lam, self.p, self.bounds)


class Throttled(Regular):
    """A law with a vector at its largest or smallest norm, by the sign of the throttle's slope."""

    def control(self, z: Sequence[Series]) -> Sequence[Series]:
        none = self.off and value(norms(self)[0]).is_zero()
        return [constant(0)] * len(self.kernel.spec.controls) if none else super().control(z)

    def conditions(self, z: Sequence[Series]) -> list[tuple[Key, Series]]:
        t, x, lam = self.parts(z)
        (slope,) = self.kernel.throttle_slope(t, x, lam, self.p, self.bounds)
        return [(THROTTLE, slope if self.off else -slope)]

    def leaving(self, other: Law) -> Key:
        return THROTTLE

    @property
    def off(self) -> bool:
        """Tell whether the norm is the smallest one: the first comparison of the motion is with it."""
        return next((answer for key, answer in self.answers.given.items() if key[0] == "canonical"), False)


THROTTLE: Key = ("throttle_slope", 0)


def norms(law: Regular) -> tuple[Series, Series]:
    """Return the smallest and the largest norm of a vector of controls, which are among the bounds."""
    (part,) = law.kernel.spec.control_parts
    if part.kind == "annulus":
        return law.bounds[0], law.bounds[1]
    return (law.bounds[-1] if part.branch == "throttled" else constant(0)), law.bounds[0]


class AtLevels(Law):
    """A law with controls at an end of their bounds, or at zero where their magnitudes cost something.

    Parameters
    ----------
    levels
        For each control, the values that may be optimal, in increasing order.
    held
        For each control, the index of its value among its levels.
    """

    def __init__(
        self, kernel: BallKernel, parameters: Sequence[Series], levels: Sequence[Sequence[Any]], held: Sequence[int]
    ) -> None:
        super().__init__(kernel, parameters)
        self.levels, self.held = levels, tuple(held)
        self.u = tuple(constant(values[k]) for values, k in zip(levels, held, strict=True))

    def control(self, z: Sequence[Series]) -> Sequence[Series]:
        return self.u

    def conditions(self, z: Sequence[Series]) -> list[tuple[Key, Series]]:
        t, x, lam = self.parts(z)
        slopes = self.kernel.switching_function(t, x, lam, self.p)
        weights = self.kernel.magnitude_weight(t, x, lam, self.p)
        found: list[tuple[Key, Series]] = []
        for i, (slope, weight, values, k) in enumerate(zip(slopes, weights, self.levels, self.held, strict=True)):
            above = self.levels[i][k] >= 0  # the sign of the control just above the value that it has, and just below
            below = self.levels[i][k] > 0
            if k < len(values) - 1:
                found.append((("up", i), slope + weight if above else slope - weight))
            if k > 0:
                found.append((("down", i), -slope - weight if below else -slope + weight))
        return found

    def leaving(self, other: Law) -> Key:
        assert isinstance(other, AtLevels)
        found = [i for i, (a, b) in enumerate(zip(self.held, other.held, strict=True)) if a != b]
        if len(found) != 1 or abs(self.held[found[0]] - other.held[found[0]]) != 1:
            raise NotProved(SIMULTANEOUS)
        return ("up" if other.held[found[0]] > self.held[found[0]] else "down", found[0])

    def _rates(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        u = self.u
        return (*self.kernel.dynamics(t, x, u, self.p), *self.kernel.costate_rate(t, x, u, lam, self.p))

    def _jacobian(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        return self.kernel.extremal_jacobian(t, x, self.u, lam, self.p)


def derivatives(function: Callable[[Sequence[Series]], list[Series]], z: Sequence[Ball]) -> list[list[Ball]]:
    """Return derivatives of a function's series by all components, over a ball."""
    ctx.cap = 2
    columns = []
    for k in range(len(z)):
        found = function([arb_series([v, arb(int(i == k))]) for i, v in enumerate(z)])
        columns.append([v[1] for v in found])
    return [list(row) for row in zip(*columns, strict=True)] if columns[0] else []


def gradient(law: Law, key: Key, z: Sequence[Ball]) -> list[Ball]:
    """Return derivatives of a condition by all components, over a ball."""
    return derivatives(lambda series: [dict(law.conditions(series))[key]], z)[0]
