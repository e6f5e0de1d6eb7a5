"""Orbit ephemeris messages of CCSDS (502.0-B), written by the library ccsds-ndm."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from typing import Any

from satsym.report.exchange.ephemeris import Arc, Ephemeris
from satsym.report.exchange.stk import burns
from satsym.report.exchange.writers import written_by

ORIGINATOR = "SATSYM"
UNKNOWN = "UNKNOWN"
"""The international designator of an object that has none, as the standard wants it."""
DEGREE = 7
"""Degree of Hermite's interpolation."""


def oem(motion: Ephemeris) -> str:
    """A motion as an orbit ephemeris message in keyword-value notation, version 2.0.

    The motion is cut into segments where the thrust jumps, so that no reader interpolates across. The burns of each
    segment are said in comments.

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
    """A number to 12 decimal places, without an exponent."""
    return f"{value:.12f}"


def _now() -> str:
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    moment = datetime.fromtimestamp(int(given), UTC) if given.isdecimal() else datetime.now(UTC)
    return moment.strftime("%Y-%m-%dT%H:%M:%S")


def _plain(text: str) -> str:
    """Text in the characters of ASCII that can be printed, which is all that the standard allows."""
    return "".join(c if " " <= c <= "~" else "?" for c in text)
