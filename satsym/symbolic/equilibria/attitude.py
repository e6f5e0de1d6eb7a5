"""Equilibrium attitudes of bodies relative to their orbit, isolated or not, and their stability."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import lru_cache
from typing import Any

import numpy as np
import sympy as sp

from satsym.arrays import Array
from satsym.symbolic.equilibria.real_roots import Solutions, solve
from satsym.symbolic.equilibria.rest import Rest

ZERO = 1e-7
"""Fraction of the largest stiffness or eigenvalue below which others count as zero."""


class Kind(Enum):
    """The stability of the motion near an equilibrium attitude."""

    STABLE = "stable"
    """The amended potential has a strict minimum at the equilibrium (Lyapunov)."""
    GYROSCOPIC = "gyroscopically stabilised"
    """The potential has no minimum, but all eigenvalues lie on the imaginary axis; damping then destabilises."""
    UNSTABLE = "unstable"
    DEGENERATE = "degenerate"
    """A stiffness vanishes, so that the linearised equations do not decide stability."""


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """One equilibrium attitude of a body in orbit.

    Attributes
    ----------
    cosines
        Orbital axes (rows) along those of the body, shape (3, 3).
    kind, eigenvalues
        What holds near it, and the six eigenvalues of the linearised motion.
    """

    cosines: Array
    kind: Kind
    eigenvalues: Array


def all_of(rest: Rest) -> tuple[Solutions, tuple[Equilibrium, ...]]:
    """Return every equilibrium of a body with numbers for its letters, where there are finitely many."""
    unknowns = [s for k in rest.axes for s in rest.cosines.row(k)]
    found = solve([*rest.equations, *orthonormal(rest)], unknowns)
    return found, tuple(classified(rest, completed(rest, point)) for point in found.points)


def orthonormal(rest: Rest) -> list[sp.Expr]:
    """Return expressions that vanish because the axes in the torques are orthonormal unit vectors."""
    rows = [rest.cosines.row(k) for k in rest.axes]
    return [a.dot(b) - int(i == k) for i, a in enumerate(rows) for k, b in enumerate(rows) if k <= i]


def completed(rest: Rest, point: Array) -> Array:
    """Return all direction cosines, with the third axis completing a right-handed frame."""
    matrix = np.zeros((3, 3))
    matrix[rest.axes] = np.reshape(point, (-1, 3))
    if len(rest.axes) == 1:
        k = rest.axes[0]
        other = np.cross(matrix[k], np.eye(3)[np.abs(matrix[k]).argmin()])
        matrix[(k + 1) % 3] = other / np.linalg.norm(other)
        matrix[(k + 2) % 3] = np.cross(matrix[k], matrix[(k + 1) % 3])
    elif len(rest.axes) == 2:
        k = next(k for k in range(3) if k not in rest.axes)
        matrix[k] = np.cross(matrix[(k + 1) % 3], matrix[(k + 2) % 3])
    return matrix


def classified(rest: Rest, cosines: Array, *letters: float, neutral: int = 0) -> Equilibrium:
    """Classify the motion near an equilibrium attitude.

    In a continuum of equilibria, as many turns as ``neutral`` says have no restoring torque.
    """
    mass, damp, stiff = (np.array(part, float) for part in _near(rest)(*cosines.ravel(), *letters))
    inverse = np.linalg.inv(mass)
    matrix = np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ stiff, -inverse @ damp]])
    rate = max(np.sqrt(np.abs(inverse @ stiff).max()), np.abs(inverse @ damp).max())
    eigenvalues = np.linalg.eigvals(matrix / np.repeat([1.0, rate], 3)[:, None] * np.repeat([1.0, rate], 3) / rate)
    stiffness = np.linalg.eigvalsh((stiff + stiff.T) / 2)
    small = ZERO * np.abs(stiffness).max()
    flat, falling = int((np.abs(stiffness) <= small).sum()), int((stiffness < -small).sum())
    growing = eigenvalues.real.max() > np.sqrt(ZERO) if flat else eigenvalues.real.max() > ZERO
    if growing:
        kind = Kind.UNSTABLE
    elif flat > neutral:
        kind = Kind.DEGENERATE
    else:
        kind = Kind.GYROSCOPIC if falling else Kind.STABLE
    return Equilibrium(cosines, kind, eigenvalues * rate)


@lru_cache(maxsize=8)
def _near(rest: Rest) -> Any:
    """Return the functions of linearised motion near an attitude.

    They are the mass matrix, derivatives of the torques by rates and by turns, of direction cosines and remaining
    letters.
    """
    a = rest.cosines
    turn, faster = sp.Matrix(sp.symbols("turn_:3")), sp.Matrix(sp.symbols("faster_:3"))
    moved = {s: s + c for k in range(3) for s, c in zip(a.row(k), -turn.cross(a.row(k).T), strict=True)}
    spin = {w: (e.xreplace(moved) + f) for (w, e), f in zip(rest.turns.items(), faster, strict=True)}
    rotation = {w: e.xreplace(moved) - e for w, e in rest.turns.items()}
    whole = rest.torque.xreplace({**moved, **spin})
    zero = dict.fromkeys((*turn, *faster), sp.Integer(0))
    stiff = -whole.jacobian(turn).xreplace(zero)
    damp = -whole.jacobian(faster).xreplace(zero) + rest.inertia * sp.Matrix(list(rotation.values())).jacobian(turn)
    letters = sorted(rest.inertia.free_symbols | rest.torque.free_symbols - {*a, *rest.turns}, key=str)
    return sp.lambdify([*a, *letters], [rest.inertia, damp, stiff], "numpy")


@dataclass(frozen=True, eq=False)
class Continuum:
    """An infinite set of equilibrium attitudes.

    Attributes
    ----------
    dimension
        Of the set of complex solutions.
    axis
        Of the body: 0, 1 or 2, where all of it consists of circles by turns about that axis; else ``None``.
    circles
        One attitude on each circle; ``None`` where the set does not consist of circles.
    """

    dimension: int
    axis: int | None
    circles: tuple[Equilibrium, ...] | None


def continuum(rest: Rest, dimension: int) -> Continuum:
    """Describe an infinite set of equilibria of the given dimension.

    On each circle the nadir, or where it lies along the axis the orbit normal, can be turned into a plane in two ways.
    """
    axis = next((k for k in range(3) if _same_turned(rest, k)), None)
    if axis is None or len(rest.axes) < 2:
        return Continuum(dimension, axis, None)
    aside, level = (axis + 1) % 3, (axis + 2) % 3
    first, second = (rest.cosines.row(k) for k in rest.axes[::-1][:2])
    apart = sp.Dummy("apart")
    cases: tuple[tuple[list[sp.Expr], list[sp.Symbol]], ...] = (
        ([first[aside], apart * first[level] - 1], [apart]),
        ([first[aside], first[level], second[aside]], []),
    )
    found: list[Equilibrium] = []
    for conditions, more in cases:
        unknowns = [s for k in rest.axes for s in rest.cosines.row(k)]
        answers = solve([*rest.equations, *orthonormal(rest), *conditions], [*more, *unknowns])
        if answers.dimension > 0:
            return Continuum(dimension, axis, None)
        points = [completed(rest, point[len(more) :]) for point in answers.points]
        row, column = (rest.axes[-1], level) if more else (rest.axes[-2], level)
        found += [classified(rest, a, neutral=1) for a in points if a[row, column] > 0]
    return Continuum(dimension, axis, tuple(found))


def _same_turned(rest: Rest, axis: int) -> bool:
    """Tell whether the torques turn with the body when it turns about one of its own axes."""
    e = sp.eye(3)[:, axis]
    rows: Sequence[sp.Matrix] = [rest.cosines.row(k).T for k in range(3)]
    torque = sp.Matrix(rest.equations)
    change = sum((torque.jacobian(row) * e.cross(row) for row in rows), sp.zeros(3, 1))
    return all(sp.expand(c) == 0 for c in change - e.cross(torque))
