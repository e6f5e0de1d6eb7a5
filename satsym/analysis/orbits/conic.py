"""Kinds of orbits about one centre, and how near to a border between two of them counts as on it."""

from __future__ import annotations

from enum import Enum

TOLERANCE = 1e-12
"""One for all: some ten thousand roundings of the numbers an orbit starts with, and far below what is ever measured.

A circle has an eccentricity up to this. On a parabola the square of the speed is that of escape within this share. A
rectilinear orbit is one whose velocity is along the radius within this angle. What is farther away is not so called:
a nearly circular ellipse is an ellipse.
"""


class Conic(str, Enum):
    """What the path is; ``rectilinear`` without angular momentum, whatever the energy."""

    CIRCLE = "circle"
    ELLIPSE = "ellipse"
    PARABOLA = "parabola"
    HYPERBOLA = "hyperbola"
    RECTILINEAR = "rectilinear"


def classify(eccentricity: float, shortfall: float, sine: float) -> Conic:
    """The kind of an orbit.

    Parameters
    ----------
    eccentricity
        From 0.
    shortfall
        By how much the square of the speed falls short of that of escape, as a share of the latter: 1 at rest, 0 on
        a parabola, negative on a hyperbola. It is minus the energy in units of mu/r.
    sine
        Of the angle between radius and velocity; 0 at rest.
    """
    if sine <= TOLERANCE:
        return Conic.RECTILINEAR
    if abs(shortfall) <= TOLERANCE:
        return Conic.PARABOLA
    if shortfall < 0.0:
        return Conic.HYPERBOLA
    return Conic.CIRCLE if eccentricity <= TOLERANCE else Conic.ELLIPSE
