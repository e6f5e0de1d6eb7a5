"""Scenes for Cesium, in its language CZML, written by the library czml3."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.report.exchange import burns
from satsym.report.exchange.ephemeris import Ephemeris
from satsym.report.extra import written_by
from satsym.report.plots import style
from satsym.status import BadInput

DEGREE = 5
"""Degree of Lagrange's interpolation."""
SHOWN = 60.0
"""Seconds that the whole motion takes on the screen."""
GLOBE = "Earth"
"""The body that Cesium shows."""
OTHER = "#C8C8C8"
"""Colour of the reference, on black."""


def czml(motion: Ephemeris) -> str:
    """A motion as a scene: the satellite with its path and burns, and the reference where there is one.

    Parameters
    ----------
    motion
        About the Earth, which is what Cesium shows.

    Returns
    -------
    str
        JSON, positions in metres in the celestial frame.

    Raises
    ------
    BadInput
        If the centre is another body, or czml3 is not installed.
    """
    if motion.orbit.centre != GLOBE:
        raise BadInput(f"[orbit] centre: Cesium shows motions about the {GLOBE}, not {motion.orbit.centre}")
    kit = written_by("czml3", "czml3")
    packets = [_document(motion, kit), *_objects(motion, kit)]
    return str(kit.Document(packets=packets).dumps()) + "\n"


def _document(motion: Ephemeris, kit: Any) -> Any:
    first, last = motion.moment(motion.times[0]), motion.moment(motion.times[-1])
    pace = max(1.0, round(float(np.ptp(motion.times)) / SHOWN))
    clock = written_by("czml3.properties", "czml3").Clock(currentTime=first, multiplier=pace)
    interval = written_by("czml3.types", "czml3").IntervalValue(start=first, end=last, value=clock)
    return kit.Packet(id="document", name=motion.title, version="1.0", clock=interval)


def _objects(motion: Ephemeris, kit: Any) -> Iterator[Any]:
    """What moves: the reference, the satellite, and over it its burns."""
    if motion.reference is not None:
        yield _moving(motion, kit, "reference", "reference", motion.reference, OTHER, width=1.0)
    said = "<br>".join([f"{motion.name}: {motion.title}", *burns(motion)])
    yield _moving(motion, kit, "satellite", motion.name, motion.position, style.SKY, said=said)
    for k, burn in enumerate(motion.burns, 1):
        inside = (motion.times >= burn.start) & (motion.times <= burn.end)
        if inside.sum() > 1:
            name = f"burn {k}"
            times, places = motion.times[inside], motion.position[:, inside]
            yield _moving(motion, kit, f"burn-{k}", name, places, style.VERMILION, width=4.0, times=times)


def _moving(
    motion: Ephemeris,
    kit: Any,
    key: str,
    name: str,
    places: Array,
    colour: str,
    width: float = 2.0,
    said: str | None = None,
    times: Array | None = None,
) -> Any:
    """A point that moves, and its path."""
    properties, types = (written_by(f"czml3.{part}", "czml3") for part in ("properties", "types"))
    times = motion.times if times is None else times
    rgba = properties.Color(rgba=[*bytes.fromhex(colour[1:]), 255])
    rows = np.column_stack([np.round(times - times[0], 6), np.round(places.T * 1e3, 3)])
    solid = properties.PolylineMaterial(solidColor=properties.SolidColorMaterial(color=rgba))
    return kit.Packet(
        id=key,
        name=name,
        description=said,
        availability=types.TimeInterval(start=motion.moment(times[0]), end=motion.moment(times[-1])),
        position=properties.Position(
            epoch=motion.moment(times[0]),
            cartesian=rows.ravel().tolist(),
            referenceFrame="INERTIAL",
            interpolationAlgorithm="LAGRANGE",
            interpolationDegree=DEGREE,
        ),
        point=properties.Point(pixelSize=6.0 + 2.0 * (width > 2.0), color=rgba),
        path=properties.Path(width=width, material=solid, resolution=float(np.ptp(motion.times)) / 1000.0),
        label=properties.Label(text=name, font="12pt sans-serif", fillColor=rgba, pixelOffset=_offset(properties)),
    )


def _offset(properties: Any) -> Any:
    """Where the name stands beside its point, in pixels."""
    return written_by("czml3.types", "czml3").Cartesian2Value(values=[0.0, -16.0])
