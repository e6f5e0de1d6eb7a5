"""Motions about a central body in the formats of other programs: OEM of CCSDS, CZML of Cesium, STK ephemerides, CSV.

Each format has one function from an :class:`~satsym.report.exchange.ephemeris.Ephemeris` to text; :func:`_writer` names
it.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.report.exchange.ephemeris import Arc, Ephemeris
from satsym.report.extra import written_by
from satsym.report.plots import style
from satsym.solution import Simulation, Solution
from satsym.status import BadInput
from satsym.version import __version__
from satsym.wording import shown, suggestion

FORMATS = {"oem": ".oem", "czml": ".czml", "stk": ".e", "csv": ".csv"}
"""Exchange formats -> suffixes of file names."""


def exported(result: Solution | Simulation, kind: str) -> str:
    """Return a motion as the text of a file.

    Parameters
    ----------
    kind
        Of :data:`FORMATS`.

    Raises
    ------
    BadInput
        If there is no such format, its library is not installed, there is no motion, or it cannot be placed in the
        sky: the model has no central body, no real units, or the instance no table [orbit].
    """
    if kind not in FORMATS:
        raise BadInput(f"there is no export format {shown(kind)}; {suggestion(kind, FORMATS)}")
    return _writer(kind)(Ephemeris.of(result))


def _writer(kind: str) -> Callable[[Ephemeris], str]:
    """Return the function that writes a format."""
    return {"oem": oem, "czml": czml, "stk": stk, "csv": table}[kind]


COLUMNS = (
    ("utc", "time_s"),
    ("x_km", "y_km", "z_km"),
    ("vx_km_s", "vy_km_s", "vz_km_s"),
    ("thrust_x_km_s2", "thrust_y_km_s2", "thrust_z_km_s2"),
)


def table(motion: Ephemeris) -> str:
    """Return a CSV table of time, position, velocity and thrust per unit mass; jumps of thrust have two lines.

    Parameters
    ----------
    motion
        Of any centre.

    Returns
    -------
    str
        A line of names, then numbers with all their digits, in kilometres and seconds, in the frame of the motion.
    """
    lines = [",".join(name for group in COLUMNS for name in group)]
    for arc in motion.arcs:
        rows = np.vstack([arc.times, arc.position, arc.velocity, arc.thrust]).T
        lines += [",".join([f"{motion.utc(row[0])}Z", *(repr(float(value)) for value in row)]) for row in rows]
    return "\n".join([*lines, ""])


ORIGINATOR = "SATSYM"
UNKNOWN = "UNKNOWN"
"""Designator that the standard prescribes for an object without an international designator."""
DEGREE = 7
"""Degree of the Hermite interpolation of positions."""


def oem(motion: Ephemeris) -> str:
    """Return a motion as an orbit ephemeris message in keyword-value notation, version 2.0.

    The motion is divided into segments where the thrust jumps, so that no reader interpolates across. Comments state
    the burns of each segment.

    Parameters
    ----------
    motion
        Of any centre.

    Returns
    -------
    str
        Positions in km and velocities in km/s. Its date of creation is now, or that of ``SOURCE_DATE_EPOCH``.

    Raises
    ------
    BadInput
        If ccsds-ndm is not installed.
    """
    models = written_by("ccsds_ndm.models.ndmxml2", "ccsds-ndm")
    writing = written_by("ccsds_ndm.ndm_io", "ccsds-ndm")
    header = models.NdmHeader(
        comment=[_plain(f"{motion.name}: {motion.title}")], creation_date=_now(), originator=ORIGINATOR
    )
    body = models.OemBody(segment=[_segment(motion, arc, models) for arc in motion.arcs])
    message = models.Oem(header=header, body=body)
    return str(writing.NdmIo().to_string(message, writing.NDMFileFormats.KVN))


def _segment(motion: Ephemeris, arc: Arc, models: Any) -> Any:
    first, last = motion.utc(arc.times[0]), motion.utc(arc.times[-1])
    metadata = models.OemMetadata(
        object_name=_plain(motion.name).upper(),
        object_id=UNKNOWN,
        center_name=motion.orbit.centre.upper(),
        ref_frame=motion.orbit.frame,
        time_system="UTC",
        start_time=first,
        stop_time=last,
        interpolation="HERMITE",
        interpolation_degree=min(DEGREE, 2 * len(arc.times) - 1),
    )
    said = [
        text
        for text, burn in zip(burns(motion), motion.burns, strict=True)
        if burn.start < arc.times[-1] and burn.end > arc.times[0]
    ]
    rows = [
        models.StateVectorAccType(
            epoch=motion.utc(time),
            **{name: models.PositionType(value=value) for name, value in zip("xyz", map(_digits, place), strict=True)},
            **{
                f"{name}_dot": models.VelocityType(value=value)
                for name, value in zip("xyz", map(_digits, pace), strict=True)
            },
        )
        for time, place, pace in zip(arc.times, arc.position.T, arc.velocity.T, strict=True)
    ]
    return models.OemSegment(metadata=metadata, data=models.OemData(comment=said, state_vector=rows))


def _digits(value: float) -> str:
    """Write a number with 12 decimal places, without an exponent."""
    return f"{value:.12f}"


def _now() -> str:
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    moment = datetime.fromtimestamp(int(given), UTC) if given.isdecimal() else datetime.now(UTC)
    return moment.strftime("%Y-%m-%dT%H:%M:%S")


def _plain(text: str) -> str:
    """Return text in printable ASCII characters, the only ones that the standard allows."""
    return "".join(c if " " <= c <= "~" else "?" for c in text)


SYSTEMS = {"EME2000": "J2000", "ICRF": "ICRF", "GCRF": "ICRF"}
"""Reference frames -> their names in STK."""
MONTHS = "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec".split()
"""English names of months, whatever the language of the system."""


def stk(motion: Ephemeris) -> str:
    """Return a motion as an STK ephemeris in metres, which is not interpolated across jumps of thrust.

    Parameters
    ----------
    motion
        Of any centre.

    Returns
    -------
    str
        Lines with times in seconds from the epoch.
    """
    epoch = motion.orbit.epoch
    date = f"{epoch.day} {MONTHS[epoch.month - 1]} {epoch.year} {epoch:%H:%M:%S}.{epoch.microsecond * 1000:09d}"
    lines = [
        "stk.v.11.0",
        "",
        f"# WrittenBy satsym {__version__}",
        f"# {motion.name}: {motion.title}".encode("ascii", "replace").decode("ascii"),
        *(f"# {text}" for text in burns(motion)),
        "",
        "BEGIN Ephemeris",
        "",
        f"NumberOfEphemerisPoints {len(motion.times)}",
        f"ScenarioEpoch {date}",
        "InterpolationMethod Hermite",
        f"InterpolationSamplesM1 {DEGREE}",
        f"CentralBody {motion.orbit.centre}",
        f"CoordinateSystem {SYSTEMS[motion.orbit.frame]}",
        "DistanceUnit Meters",
        "",
    ]
    if len(motion.arcs) > 1:
        lines += ["BEGIN SegmentBoundaryTimes", *(f"{arc.times[0]:.16e}" for arc in motion.arcs[1:])]
        lines += ["END SegmentBoundaryTimes", ""]
    lines += ["EphemerisTimePosVel", ""]
    for time, place, pace in zip(motion.times, motion.position.T * 1e3, motion.velocity.T * 1e3, strict=True):
        lines.append(" ".join(f"{value:.16e}" for value in (time, *place, *pace)))
    return "\n".join([*lines, "", "END Ephemeris", ""])


def burns(motion: Ephemeris) -> list[str]:
    """Return a line on each burn."""
    return [
        f"MANOEUVRE {k}: {motion.utc(burn.start)} to {motion.utc(burn.end)} UTC, delta-v {1e3 * burn.delta_v:.6g} m/s, "
        f"thrust per unit mass at most {1e3 * burn.largest:.6g} m/s**2"
        for k, burn in enumerate(motion.burns, 1)
    ]


CZML_DEGREE = 5
"""Degree of the Lagrange interpolation of positions."""
SHOWN = 60.0
"""Duration in seconds in which Cesium plays the whole motion."""
GLOBE = "Earth"
"""The body that Cesium shows."""
OTHER = "#C8C8C8"
"""Colour of the reference curve on a dark background."""


def czml(motion: Ephemeris) -> str:
    """Return a motion as a CZML scene: the satellite with its path and burns, and the reference where there is one.

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
    """Return the moving objects: the reference, the satellite, and over it its burns."""
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
    """Return a point that moves, and its path."""
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
            interpolationDegree=CZML_DEGREE,
        ),
        point=properties.Point(pixelSize=6.0 + 2.0 * (width > 2.0), color=rgba),
        path=properties.Path(width=width, material=solid, resolution=float(np.ptp(motion.times)) / 1000.0),
        label=properties.Label(text=name, font="12pt sans-serif", fillColor=rgba, pixelOffset=_offset(properties)),
    )


def _offset(properties: Any) -> Any:
    """Return the offset of a name beside its point, in pixels."""
    return written_by("czml3.types", "czml3").Cartesian2Value(values=[0.0, -16.0])
