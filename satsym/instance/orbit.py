"""The [orbit] table of an instance: the frame, the centre and the epoch of its motion."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from types import MappingProxyType

from satsym.instance.resolve import quantity
from satsym.instance.schema import OrbitTable
from satsym.spec import ProblemSpec
from satsym.status import BadInput
from satsym.wording import shown, suggestion

FRAMES = ("EME2000", "ICRF", "GCRF")
"""Axes that do not rotate, by the names of CCSDS: mean equator and equinox of J2000, and the celestial frames."""
YEARS = range(1900, 2200)
"""Calendar years in which an epoch may lie."""
SPACE = 3
"""Number of components of a position in space."""


@dataclass(frozen=True)
class Body:
    """A centre of attraction.

    Attributes
    ----------
    mu
        Gravitational parameter in km**3/s**2 (JPL's ephemeris DE440, Park and others 2021).
    radius
        Equatorial radius in km (IAU working group on cartographic coordinates, 2015).
    """

    mu: float
    radius: float


BODIES = MappingProxyType(
    {
        "Sun": Body(132712440041.279419, 695700.0),
        "Mercury": Body(22031.868551, 2440.53),
        "Venus": Body(324858.592000, 6051.8),
        "Earth": Body(398600.435507, 6378.1366),
        "Moon": Body(4902.800118, 1737.4),
        "Mars": Body(42828.375816, 3396.19),
        "Jupiter": Body(126712764.1, 71492.0),
        "Saturn": Body(37940584.8418, 60268.0),
        "Uranus": Body(5794556.4, 25559.0),
        "Neptune": Body(6836527.10058, 24764.0),
    }
)
"""Centres of attraction by name; mu of an outer planet includes its moons."""


@dataclass(frozen=True)
class OrbitOptions:
    """The frame, the centre and the epoch of a motion.

    Attributes
    ----------
    epoch
        Date and time in UTC at which the model's time is zero.
    frame
        The axes, one of :data:`FRAMES`.
    centre
        The body at the origin, one of :data:`BODIES`.
    inclination, node, argument
        Orientation of the plane of a planar model in the frame, in rad: the angle between the two planes, the direction
        of the ascending node, and the angle from there to the first axis of the model.
    """

    epoch: datetime
    frame: str
    centre: str
    inclination: float = 0.0
    node: float = 0.0
    argument: float = 0.0

    @property
    def body(self) -> Body:
        """Return the body at the origin."""
        return BODIES[self.centre]


def orbit(table: OrbitTable | None, spec: ProblemSpec) -> OrbitOptions | None:
    """Return the frame, centre and epoch that an instance states.

    Raises
    ------
    BadInput
        If the epoch is no date, a name is unknown, or the plane of a motion in space is stated.
    """
    if table is None:
        return None
    for key, name, names in (("frame", table.frame, FRAMES), ("centre", table.centre, tuple(BODIES))):
        if name not in names:
            raise BadInput(f"[orbit] {key}: {shown(name)} is not supported; {suggestion(name, names)}")
    plane = {"inclination": table.inclination, "node": table.node, "argument": table.argument}
    for key, value in plane.items():
        if value is not None and len(spec.position) == SPACE:
            raise BadInput(f"[orbit] {key}: the model {spec.name} is not planar; leave out this key")
    angles = {key: quantity(value or 0.0, "rad", f"[orbit] {key}") for key, value in plane.items()}
    return OrbitOptions(_epoch(table.epoch), table.frame, table.centre, **angles)


def _epoch(given: datetime) -> datetime:
    """Return a date and time in UTC, where a time without an offset is taken as UTC."""
    if given.year not in YEARS:
        raise BadInput(
            f"[orbit] epoch: the year {given.year} does not lie between {YEARS[0]} and {YEARS[-1]}; correct the epoch"
        )
    return given.replace(tzinfo=UTC) if given.tzinfo is None else given.astimezone(UTC)
