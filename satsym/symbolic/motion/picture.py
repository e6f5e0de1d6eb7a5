"""A picture of a geometry: points, arrows and their names."""

from __future__ import annotations

from dataclasses import dataclass

Place = tuple[float, float]


@dataclass(frozen=True)
class Arrow:
    """From where and where to, with the names of what points there, as LaTeX."""

    start: Place
    end: Place
    labels: tuple[str, ...]


@dataclass(frozen=True)
class Picture:
    """What is drawn, in a unit of length that suits it.

    Attributes
    ----------
    kind
        Key of what it shows: a motion, deviations, bodies, an attitude.
    path
        Points of the reference.
    arrows
        From the centre, and where the body is.
    angle
        That of the body as seen from the centre, and its name; none if no coordinate is that angle.
    bodies
        Names of concentric bodies.
    turns
        Arrows about axes, each with the name of the angle.
    axes
        Where the inertial axes point.
    guides
        Lines that show depth, from where to where.
    """

    kind: str
    path: tuple[Place, ...] = ()
    arrows: tuple[Arrow, ...] = ()
    angle: tuple[float, str] | None = None
    bodies: tuple[str, ...] = ()
    turns: tuple[tuple[tuple[Place, ...], str], ...] = ()
    axes: tuple[Place, ...] = ((1.0, 0.0), (0.0, 1.0))
    guides: tuple[tuple[Place, Place], ...] = ()
