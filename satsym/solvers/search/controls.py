"""Variables of a nonlinear programme that replace controls, so that rates are smooth functions of these variables.

Rates that contain the norm of a vector are ``a + B u + c |u|``, and those that contain an angle are ``a + b cos(u) + c
sin(u)``. Both are sums of the rates at a few fixed controls, the nodes, with weights that are linear in the vector and
its norm, or in cosine and sine. The norm is a variable s of its own with ``|u|^2 <= s^2``, and so are cosine and sine
with ``cos^2 + sin^2 <= 1``: at an optimum both hold with equality, or convexity shows that the relaxation does not
lower the cost.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.instance import Instance

DRAWN, EQUAL_RATES = 6, 1e-9
"""Number of random controls at which weighted sums of rates are compared with exact rates, and the largest relative
difference that counts as rounding."""

Node = tuple[float, ...]


@dataclass(frozen=True)
class Lift:
    """Replacement of controls by variables in which rates are linear.

    Attributes
    ----------
    places
        Indices of these controls in the model's order.
    variables
        Indices of the replacing variables, in the order of the columns of `weights` after its first.
    nodes
        Values of these controls, one row each.
    weights
        Weights of the nodes, one row each: a constant, then the factors of the variables.
    """

    places: tuple[int, ...]
    variables: tuple[int, ...]
    nodes: tuple[Node, ...]
    weights: Array


@dataclass(frozen=True)
class Norm:
    """Bounds on the norm of some variables: at most `outer` or the variable `spot`, and at least `inner`."""

    places: tuple[int, ...]
    inner: float
    outer: float
    spot: int | None = None


@dataclass(frozen=True)
class Controls:
    """The variables of a nonlinear programme that represent controls.

    Attributes
    ----------
    given
        Number of controls; they are the first variables.
    lower, upper
        Bounds of all variables.
    """

    given: int
    lower: Array
    upper: Array
    lifts: tuple[Lift, ...] = ()
    norms: tuple[Norm, ...] = ()
    angles: dict[int, tuple[int, int]] = field(default_factory=dict)
    """Index of an angle -> indices of its cosine and its sine."""
    affine: bool = False
    """Whether rates are linear in all controls, except for their magnitudes."""

    @property
    def count(self) -> int:
        """Return the number of variables."""
        return len(self.lower)

    @property
    def loosened(self) -> Controls | None:
        """Return the variables without bounds; ``None`` if there are none, or they are needed for a finite cost."""
        if self.lifts or self.angles or any(norm.spot is not None for norm in self.norms):
            return None
        bounded = bool(self.norms) or bool(np.isfinite(self.lower).any() or np.isfinite(self.upper).any())
        endless = np.full(self.count, np.inf)
        return replace(self, lower=-endless, upper=endless, norms=()) if bounded else None

    def excess(self, v: Array) -> float:
        """Return the largest of the variables (count, M) relative to their bounds; greater than 1 outside these."""
        found = [0.0]
        for row, low, high in zip(v, self.lower, self.upper, strict=True):
            middle, half = 0.5 * (low + high), 0.5 * (high - low)
            found += [float(np.abs(row - middle).max() / half)] if 0.0 < half < np.inf else []
        found += [float(np.linalg.norm(v[list(one.places)], axis=0).max() / one.outer) for one in self.norms]
        return max(found)

    @property
    def linear(self) -> set[int]:
        """Return the indices of variables in which rates are linear, so that second derivatives vanish."""
        lifted = {place for lift in self.lifts for place in (*lift.places, *lift.variables)}
        return set(range(self.count)) if self.affine else lifted

    def nodes(self, v: Array) -> list[tuple[Array, Array]]:
        """Return controls (m, M) at which rates are evaluated, and the weights (M,) of these rates in their sum.

        Parameters
        ----------
        v
            Variables, shape (count, M), real or complex.
        """
        u = np.array(v[: self.given])
        for lift in self.lifts:
            u[list(lift.places)] = np.array(lift.nodes[0])[:, None]
        whole = [(u, np.ones(v.shape[1], v.dtype))]
        for lift in self.lifts:
            weights = lift.weights[:, :1] + lift.weights[:, 1:] @ v[list(lift.variables)]
            for node, weight in zip(lift.nodes[1:], weights[1:], strict=True):
                moved = np.array(u)
                moved[list(lift.places)] = np.array(node)[:, None]
                whole.append((moved, weight))
            whole[0] = (u, whole[0][1] + weights[0] - 1.0)
        return whole

    def controls(self, v: Array) -> Array:
        """Return the controls that the variables represent, shape (m, M)."""
        u = np.array(v[: self.given])
        for place, (cosine, sine) in self.angles.items():
            u[place] = np.arctan2(v[sine], v[cosine])
        return u

    def variables(self, u: Array) -> Array:
        """Return the variables that represent given controls, shape (count, M)."""
        v = np.zeros((self.count, u.shape[1]))
        v[: self.given] = u
        for norm in self.norms:
            if norm.spot is not None:
                v[norm.spot] = np.linalg.norm(v[list(norm.places)], axis=0)
        for place, (cosine, sine) in self.angles.items():
            v[cosine], v[sine] = np.cos(u[place]), np.sin(u[place])
        return v


def controls_of(instance: Instance) -> Controls | None:
    """Return the variables of an instance; ``None`` if its rates do not have the form that they need."""
    within, m = instance.control_set, len(instance.model.spec.controls)
    parts = within.parts if within.kind == "product" else ((tuple(range(m)), within),)
    lower, upper = np.full(m, -np.inf), np.full(m, np.inf)
    made = _Made(instance, list(lower), list(upper))
    for places, part in parts:
        made.add(places, part)
    found = made.controls(m)
    return found if _reproduces(instance, found) else None


class _Made:
    """Collector of variables, to which control sets are added one by one."""

    def __init__(self, instance: Instance, lower: list[float], upper: list[float]) -> None:
        self.instance, self.lower, self.upper = instance, lower, upper
        self.lifts: list[Lift] = []
        self.norms: list[Norm] = []
        self.angles: dict[int, tuple[int, int]] = {}

    def controls(self, m: int) -> Controls:
        lower, upper = np.array(self.lower), np.array(self.upper)
        affine = self.instance.model.spec.switching
        return Controls(m, lower, upper, tuple(self.lifts), tuple(self.norms), self.angles, affine)

    def new(self, low: float, high: float) -> int:
        self.lower.append(low)
        self.upper.append(high)
        return len(self.lower) - 1

    def add(self, places: tuple[int, ...], part: ControlSet) -> None:
        spec = self.instance.model.spec
        if part.kind == "box":
            for place, low, high in zip(places, part.lower, part.upper, strict=True):
                self.lower[place], self.upper[place] = low, high
                weighed = spec.switching and low < 0.0 < high
                if weighed and _depends_on_norms(self.instance, (place,)):
                    self._with_norm((place,), 0.0, max(-low, high))
        elif part.kind == "angle":
            cosine, sine = self.new(-1.0, 1.0), self.new(-1.0, 1.0)
            self.lower[places[0]] = self.upper[places[0]] = 0.0
            self.angles[places[0]] = cosine, sine
            quarter = np.pi / 2
            weights = np.array([[0.5, 0.5, -0.5], [0.0, 0.0, 1.0], [0.5, -0.5, -0.5]])
            self.lifts.append(Lift(places, (cosine, sine), ((0.0,), (quarter,), (2 * quarter,)), weights))
            self.norms.append(Norm((cosine, sine), 0.0, 1.0))
        elif part.kind in ("ball", "annulus"):
            if part.throttled and _depends_on_norms(self.instance, places):
                self._with_norm(places, part.inner, part.radius)
            elif np.isfinite(part.radius) or part.inner:
                self.norms.append(Norm(places, part.inner, part.radius))
            if np.isfinite(part.radius):
                for place in places:
                    self.lower[place], self.upper[place] = -part.radius, part.radius

    def _with_norm(self, places: tuple[int, ...], inner: float, outer: float) -> None:
        """Add the norm of a vector as a variable, for rates that depend on it."""
        spot = self.new(inner, outer)
        size, k = (outer if np.isfinite(outer) else 1.0), len(places)
        nodes = [np.zeros(k), *(sign * size * row for row in np.eye(k) for sign in (1.0, -1.0))]
        # with f = a + B u + c s: c = (f(e) + f(-e) - 2 f(0)) / 2 size, of the first axis, and B e = (f(e) - f(-e)) / 2
        weights = np.zeros((len(nodes), k + 2))
        weights[0] = [1.0, *np.zeros(k), -1.0 / size]
        weights[1:3, k + 1] = 0.5 / size
        for axis in range(k):
            weights[1 + 2 * axis, 1 + axis] += 0.5 / size
            weights[2 + 2 * axis, 1 + axis] -= 0.5 / size
        self.lifts.append(Lift(places, (*places, spot), tuple(map(tuple, nodes)), weights))
        self.norms.append(Norm(places, inner, outer, spot))


def rates(instance: Instance, t: Array, x: Array, u: Array, p: tuple[Any, ...]) -> Array:
    """Return the rates of the states and of the cost, shape (n + 1, M)."""
    model, n = instance.model, len(x)
    kind = np.result_type(t, x, u, *p)
    found = np.empty((n + 1, x.shape[1]), kind)
    found[:n] = model.dynamics_batch(t, x, u, p)
    found[n] = model.running_cost_batch(t, x, u, p)
    return found


def _drawn(instance: Instance) -> tuple[Array, Array, np.random.Generator]:
    """Return times, random states about the initial state, and the random number generator."""
    rng, start = np.random.default_rng(0), np.array(instance.initial)
    x = start[:, None] * (1.0 + 0.1 * rng.uniform(-1.0, 1.0, (len(start), DRAWN)))
    return np.full(DRAWN, instance.t0), x, rng


def _depends_on_norms(instance: Instance, places: tuple[int, ...]) -> bool:
    """Return whether rates are nonlinear in some controls, which means that rates depend on the norm of these."""
    t, x, _ = _drawn(instance)
    u = np.zeros((len(instance.model.spec.controls), DRAWN))
    with np.errstate(all="ignore"):
        still = rates(instance, t, x, u, instance.parameters)
        u[places[0]] = 1.0
        ahead = rates(instance, t, x, u, instance.parameters)
        back = rates(instance, t, x, -u, instance.parameters)
    bent = np.abs(ahead + back - 2.0 * still)
    return bool(np.nanmax(bent) > EQUAL_RATES * max(np.nanmax(np.abs(ahead - still)), 1e-300))


def _reproduces(instance: Instance, controls: Controls) -> bool:
    """Return whether a weighted sum of rates at a few controls reproduces the rates of the model."""
    t, x, rng = _drawn(instance)
    u = rng.uniform(-1.0, 1.0, (controls.given, DRAWN))
    low, high = controls.lower[: controls.given, None], controls.upper[: controls.given, None]
    finite = np.isfinite(low) & np.isfinite(high) & (low < high)
    with np.errstate(all="ignore"):
        span, middle = np.where(finite, high - low, 2.0), np.where(finite, (high + low) / 2, 0.0)
        u = middle + 0.4 * span * u
        direct = rates(instance, t, x, u, instance.parameters)
        nodes = controls.nodes(controls.variables(u))
        each = [weight * rates(instance, t, x, node, instance.parameters) for node, weight in nodes]
        size = np.sum(np.abs(each), axis=0)
        error = np.abs(np.sum(each, axis=0) - direct)
    known = np.isfinite(direct)
    return bool(known.any() and (error[known] <= EQUAL_RATES * np.maximum(size[known], 1e-300)).all())
