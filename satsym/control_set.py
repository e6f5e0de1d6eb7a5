"""The set of admissible controls: its bounds, its regularisation, projection onto it, and its boundary."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_part import SWITCHED, ControlPart, PartKind
from satsym.spec import ProblemSpec

Row = tuple[float, ...]

UNSMOOTHED = 1e-100
"""The smoothing that stands for none, in problems whose controls switch or are directions."""

Norms = Mapping[str, tuple[float, float]]
"""The least and the largest norm of controls, by the name of their set."""


def bound_names(spec: ProblemSpec) -> tuple[tuple[str, ...], ...]:
    """Return the names of the bounds of each control; empty where the control set is no box."""
    boxed = set(spec.control_names) if spec.control_set == "box" else set()
    boxed = boxed.union(*(part.controls for part in spec.control_parts if part.kind == "box"))
    return tuple(tuple(f"{name}_{end}" for end in ("min", "max") if name in boxed) for name in spec.control_names)


def stated_constraints(spec: ProblemSpec) -> dict[str, int]:
    """Return the path constraints other than bounds of controls, and their places among all."""
    bounds = {name for names in bound_names(spec) for name in names}
    return {one.name: k for k, one in enumerate(spec.path_constraints) if one.name not in bounds}


@dataclass(frozen=True)
class ControlSet:
    """The set of admissible controls, with the amount of regularisation."""

    kind: PartKind | Literal["product"] | None
    """The kind of the set, which selects the fields that count; ``None`` for a model without a cost, whose controls are
    free."""
    lower: Row = ()
    upper: Row = ()
    """Lower and upper bounds of a box in the model's order, infinite where there is none."""
    radius: float = math.inf
    """Largest norm of a ball or an annulus, infinite where there is none. For an angle it is one, or more where a
    regularised problem is relaxed."""
    smoothing: float = 0.0
    """The weight of half the squared controls in the cost of a regularised problem, in the unit of the running cost
    over that of the squared control; zero where controls neither switch nor are directions."""
    fraction: float = 1.0
    """Fraction of the weight of |u| that counts in a regularised problem, 0 to 1."""
    inner: float = 0.0
    """The least norm of an annulus, or the norm at which a vector in a ball is kept."""
    directed: bool = False
    """Whether H is linear in the vector, which then has full length except in a regularised problem."""
    throttled: bool = False
    """Whether the norm, or a single control, switches between two levels."""
    turned_by: int | None = None
    """Place of the angle that turns the quantity multiplied by a magnitude; ``None`` for other sets."""
    parts: tuple[tuple[tuple[int, ...], ControlSet], ...] = ()
    """Sets of a product, each with the places of its controls in the model's order."""

    @classmethod
    def of(cls, spec: ProblemSpec, lower: Row, upper: Row, radius: float, norms: Norms | None = None) -> ControlSet:
        """Return the control set of a problem with these bounds, nothing regularised."""
        smoothing = UNSMOOTHED if spec.regularising else 0.0
        if not spec.control_parts:
            kind = spec.control_set
            assert kind != "product"
            return cls(kind, lower, upper, radius, smoothing)

        def one(part: ControlPart, places: tuple[int, ...]) -> ControlSet:
            inner, outer = (norms or {}).get(part.name, (0.0, 1.0 if part.kind == "angle" else math.inf))
            low, high = (tuple(row[i] for i in places) for row in (lower, upper))
            angle = spec.control_names.index(part.turned_by) if part.turned_by else None
            return cls(part.kind, low, high, outer, 0.0, 1.0, inner, part.directed, part.branch in SWITCHED, angle)

        return cls("product", smoothing=smoothing, parts=_placed(spec, one))

    @classmethod
    def from_arguments(cls, spec: ProblemSpec, bounds: Sequence[Any]) -> ControlSet:
        """Return the control set of the numbers or arrays in :attr:`arguments` of generated functions."""
        m = len(spec.controls)
        if spec.control_parts:
            left = list(bounds)

            def one(part: ControlPart, places: tuple[int, ...]) -> ControlSet:
                own = [left.pop(0) for _ in range(part.bounds)]
                directed, throttled = part.directed, part.branch in SWITCHED
                if part.kind == "box":
                    ends = tuple(own[: len(places)]), tuple(own[len(places) :])
                    angle = spec.control_names.index(part.turned_by) if part.turned_by else None
                    return cls("box", *ends, directed=directed, throttled=throttled, turned_by=angle)
                inner = own[0] if part.kind == "annulus" else 0.0
                radius = own[-1] if own else math.inf
                return cls(part.kind, radius=radius, inner=inner, directed=directed, throttled=throttled)

            parts = _placed(spec, one)
            smoothing, fraction = (left + [0.0, 1.0][len(left) :])[:2]
            least = left[2:]
            for k, (at, part) in enumerate(parts):
                if part.throttled and part.kind == "ball" and least:
                    parts = (*parts[:k], (at, replace(part, inner=least.pop(0))), *parts[k + 1 :])
            return cls("product", smoothing=smoothing, fraction=fraction, parts=parts)
        if spec.control_set == "ball":
            return cls("ball", radius=bounds[0])
        if spec.control_set != "box":
            return cls("free" if spec.control_set else None)
        return cls("box", tuple(bounds[:m]), tuple(bounds[m : 2 * m]), math.inf, *bounds[2 * m :])

    @cached_property
    def arguments(self) -> Row:
        """Return the argument ``bounds`` of generated functions: bounds or radius, then the regularisation."""
        if self.kind == "product":
            own = tuple(value for _, part in self.parts for value in part.arguments)
            throttled = [part for _, part in self.parts if part.throttled]
            regular = ((self.smoothing,) if self.smoothing else ()) + ((self.fraction,) if throttled else ())
            return own + regular + tuple(part.inner for part in throttled if part.kind == "ball")
        if self.kind == "box":
            return self.lower + self.upper + ((self.smoothing, self.fraction) if self.smoothing else ())
        if self.kind == "annulus":
            return (self.inner, self.radius)
        return (self.radius,) if self.kind in ("ball", "angle") else ()

    @property
    def bounded(self) -> bool:
        """Tell whether any bound is finite, other than the length of a direction."""
        if self.kind == "product":
            return any(part.bounded for _, part in self.parts)
        return not self.directed and any(map(math.isfinite, (*self.lower, *self.upper, self.radius)))

    def relaxed(self, by: float) -> ControlSet:
        """Return the set with every bound moved outwards, in the controls' units.

        The bound of a direction moves only if it is regularised.
        """
        if self.kind == "product":
            eased = self.smoothing > UNSMOOTHED
            parts = tuple((at, part.relaxed(by) if eased or not part.directed else part) for at, part in self.parts)
            return replace(self, parts=parts)
        if self.kind == "box":
            lower, upper = tuple(low - by for low in self.lower), tuple(high + by for high in self.upper)
            return replace(self, lower=lower, upper=upper)
        if self.kind == "annulus":
            return replace(self, radius=self.radius + by, inner=max(self.inner - by, 0.0))
        return replace(self, radius=self.radius + by) if self.kind in ("ball", "angle") else self

    @cached_property
    def without_bounds(self) -> ControlSet:
        """Return the control set for an unlimited control."""
        return self.relaxed(math.inf)

    def regularised(self, smoothing: float, fraction: float) -> ControlSet:
        """Return the control set of a regularised problem."""
        return replace(self, smoothing=smoothing, fraction=fraction)

    def saturated(self, u: Row) -> ControlSet:
        """Return the set that admits only this control; sets of a product that switch keep these levels."""
        if self.kind == "product":
            levels = iter(u)

            def kept(part: ControlSet) -> ControlSet:
                level = next(levels)
                if part.kind == "box":
                    return part.saturated((level,))
                return replace(part, inner=level, radius=level)

            return replace(self, parts=tuple((at, kept(one) if one.throttled else one) for at, one in self.parts))
        return replace(self, lower=u, upper=u)

    @property
    def levels(self) -> tuple[float, float]:
        """Return the two levels between which a single control in a box, or the norm of a vector, switches."""
        return (self.lower[0], self.upper[0]) if self.kind == "box" else (self.inner, self.radius)

    @property
    def reach(self) -> float:
        """Return the largest magnitude of a single control in a box, or norm of a vector."""
        return max(map(abs, self.levels)) if self.kind == "box" else self.radius

    @cached_property
    def switching(self) -> tuple[Row, Row]:
        """Return the bounds of switching quantities: controls in a box; norms and single controls of a product."""
        if self.kind != "product":
            return self.lower, self.upper
        levels = [part.levels for _, part in self.parts if part.throttled]
        return tuple(low for low, _ in levels), tuple(high for _, high in levels)

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """Return lower and upper bounds as columns, shapes (m, 1)."""
        return np.array(self.lower)[:, None], np.array(self.upper)[:, None]

    def around(self, controls: int) -> tuple[Array, Array]:
        """Return lower and upper bounds of a box around the set, shapes (m, 1); infinite for unlimited controls.

        Parameters
        ----------
        controls
            Number m of controls.
        """
        if self.kind == "box":
            return self.box
        largest = math.pi if self.kind == "angle" else self.radius
        low, high = np.full((controls, 1), -largest), np.full((controls, 1), largest)
        for at, part in self.parts:
            low[list(at)], high[list(at)] = part.around(len(at))
        return low, high

    @cached_property
    def rest(self) -> Row:
        """Return the control of least magnitude in a box."""
        return tuple(min(max(0.0, low), high) for low, high in zip(self.lower, self.upper, strict=True))

    def project(self, u: Array) -> Array:
        """Return the nearest admissible controls.

        Parameters
        ----------
        u
            Controls, shape (m, M).
        """
        if self.kind == "product":
            found = np.array(u)
            for at, part in self.parts:
                found[list(at)] = part.project(u[list(at)])
            return found
        if self.kind == "box":
            low, high = self.box
            return np.minimum(np.maximum(u, low), high)
        if self.kind in ("ball", "annulus"):
            norm = np.linalg.norm(u, axis=0)
            within = np.where(norm > self.radius, u * (self.radius / np.maximum(norm, 1e-300)), u)
            return np.where(norm < self.inner, u * (self.inner / np.maximum(norm, 1e-300)), within)
        return u

    def nearest(self) -> Callable[[Sequence[float]], Sequence[float]]:
        """Return the projection as a function of one control on plain floats; see :meth:`project`."""
        if self.kind == "box":
            bounds = list(zip(self.lower, self.upper, strict=True))
            return lambda u: [min(max(v, low), high) for v, (low, high) in zip(u, bounds, strict=True)]
        if self.kind == "ball":
            return lambda u: [v * min(1.0, self.radius / max(math.hypot(*u), 1e-300)) for v in u]
        if self.kind == "product":
            return lambda u: self.project(np.array(u, dtype=float)[:, None])[:, 0].tolist()
        return lambda u: u

    def active(self, unbounded: Array) -> NDArray[np.int8]:
        """Tell which bound saturates each control: -1 the lower, 1 the upper, 0 none; on a ball 1 or 0.

        Parameters
        ----------
        unbounded
            What the controls would be without bounds, shape (m, M).
        """
        if self.kind == "product":
            found = np.zeros(unbounded.shape, np.int8)
            for at, part in self.parts:
                found[list(at)] = part.active(unbounded[list(at)])
            return found
        if self.kind == "box" and not self.directed:
            low, high = self.box
            return (unbounded > high).astype(np.int8) - (unbounded < low).astype(np.int8)
        if self.kind in ("ball", "annulus") and not self.directed:
            norm = np.linalg.norm(unbounded, axis=0)
            met = (norm > self.radius).astype(np.int8) - (norm < self.inner).astype(np.int8)
            return np.broadcast_to(met, unbounded.shape).astype(np.int8)
        return np.zeros(unbounded.shape, np.int8)

    def excess(self, unbounded: Array) -> Array:
        """Return signed distances to each bound, whose zeros are the switching times; shape (bounds, M).

        The rows are, for a box, control minus lower bound and control minus upper bound for each control; for a
        ball the norm minus its limit, of an annulus with its least norm before; set after set. Bounds that are infinite
        have rows of infinities, directions none.
        """
        if self.kind == "product":
            rows = [part.excess(unbounded[list(at)]) for at, part in self.parts]
            return np.concatenate([*rows, np.empty((0, unbounded.shape[1]))])
        if self.directed:
            return np.empty((0, unbounded.shape[1]))
        if self.kind == "box":
            return np.concatenate([unbounded - bound for bound in self.box])
        if self.kind == "ball":
            return (np.linalg.norm(unbounded, axis=0) - self.radius)[None, :]
        if self.kind == "annulus":
            return np.linalg.norm(unbounded, axis=0)[None, :] - np.array([[self.inner], [self.radius]])
        return np.empty((0, unbounded.shape[1]))

    @cached_property
    def limited(self) -> tuple[tuple[int, ...], ...]:
        """Return, for each row of :meth:`excess` in a product, the places of the controls that it limits."""
        rows: list[tuple[int, ...]] = []
        for at, part in self.parts:
            if part.kind == "box" and not part.directed:
                rows += [(i,) for i in at] * 2
            elif part.kind in ("ball", "annulus") and not part.directed:
                rows += [at] * len(part.arguments)
        return tuple(rows)

    @property
    def angles(self) -> tuple[int, ...]:
        """Return the places of the controls that are angles."""
        return tuple(at[0] for at, part in self.parts if part.kind == "angle")

    def apart(self, u: Array, other: Array) -> Array:
        """Return differences of controls, those of angles by the shorter way round."""
        found = np.subtract(u, other)
        for i in self.angles:
            found[i] = np.remainder(found[i] + math.pi, 2.0 * math.pi) - math.pi
        return found

    def continued(self, u: Array) -> Array:
        """Return controls over time, shape (m, M), with angles continued without jumps by a turn."""
        found = np.array(u)
        for i in self.angles:
            found[i] = np.unwrap(found[i])
        return found

    def violation(self, u: Array) -> float:
        """Return the largest violation of a bound; not positive for admissible controls."""
        if self.kind == "product":
            return max((part.violation(u[list(at)]) for at, part in self.parts), default=-np.inf)
        distances = self.excess(u)
        if self.kind == "box":
            m = len(u)
            distances = np.concatenate([-distances[:m], distances[m:]])
        elif self.kind == "annulus" and len(distances):
            distances[0] *= -1.0
        return float(distances.max(initial=-np.inf))


def _placed(
    spec: ProblemSpec, one: Callable[[ControlPart, tuple[int, ...]], ControlSet]
) -> tuple[tuple[tuple[int, ...], ControlSet], ...]:
    """Return the sets of a product with the places of their controls."""
    places = [tuple(spec.control_names.index(c) for c in part.controls) for part in spec.control_parts]
    return tuple((at, one(part, at)) for part, at in zip(spec.control_parts, places, strict=True))
