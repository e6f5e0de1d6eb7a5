"""Krawczyk's method: a box in which the equations of shooting have exactly one solution."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.proof.balls.arithmetic import Ball, NotProved
from satsym.proof.balls.taylor import Matrix, Order, column, unit
from satsym.proof.shooting import Box, Pass, Shooting


@dataclass(frozen=True)
class Inclusion:
    """Krawczyk's operator on a box: whether its image lies inside, and the image, about the box's midpoint."""

    inside: bool
    image: list[Ball]
    passed: Pass


def krawczyk(shooting: Shooting, box: Box, order: Order) -> Inclusion:
    """Apply Krawczyk's operator: where the image is inside the box, there is one extremal in the box, in the image.

    Raises
    ------
    NotProved
        If the equations are singular.
    """
    passed = shooting.run(box, order)
    around = shooting.unknowns(box.around, box.lengths_around)
    c = inverse(passed.jacobian)
    image = (-(c * passed.residuals) + (unit(len(around)) - c * passed.jacobian) * column(around)).entries()
    inside = all(o.contains_interior(v) for o, v in zip(around, image, strict=True))
    return Inclusion(inside, image, passed)


def inverse(jacobian: Matrix) -> Matrix:
    """An approximate inverse of a ball matrix, exact in its entries.

    Raises
    ------
    NotProved
        If there is none.
    """
    if jacobian.nrows() != jacobian.ncols():
        raise NotProved("as many equations as unknowns are needed; two bounds are met at once")
    try:
        return jacobian.mid().inv().mid()
    except ZeroDivisionError:
        raise NotProved("the equations of the extremal are singular; it may be one of a family") from None
