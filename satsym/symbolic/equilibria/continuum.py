"""Equilibria that are not isolated: where turns about an axis of the body change nothing, each is on a circle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from satsym.symbolic.equilibria.attitude import Equilibrium, classified, completed, orthonormal
from satsym.symbolic.equilibria.real_roots import solve
from satsym.symbolic.equilibria.rest import Rest


@dataclass(frozen=True, eq=False)
class Continuum:
    """A set of equilibria that is not finite.

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
    """What an infinite set of equilibria consists of.

    On each circle the nadir, or where that lies along the axis the normal of the orbit, can be turned into a plane, in
    two ways.
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
    """Whether the torques turn with the body where it turns about an axis of its own."""
    e = sp.eye(3)[:, axis]
    rows: Sequence[sp.Matrix] = [rest.cosines.row(k).T for k in range(3)]
    torque = sp.Matrix(rest.equations)
    change = sum((torque.jacobian(row) * e.cross(row) for row in rows), sp.zeros(3, 1))
    return all(sp.expand(c) == 0 for c in change - e.cross(torque))
