"""Ephemerides of the Systems Tool Kit, in the format that its help publishes: files that end in ``.e``."""

from __future__ import annotations

from satsym.report.exchange.ephemeris import Ephemeris
from satsym.version import __version__

SYSTEMS = {"EME2000": "J2000", "ICRF": "ICRF", "GCRF": "ICRF"}
"""What frames are called there."""
MONTHS = "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec".split()
"""Whatever language the system speaks."""
DEGREE = 7
"""Degree of the polynomials that readers put through points; with velocities four points determine one."""


def stk(motion: Ephemeris) -> str:
    """A motion as an ephemeris of positions and velocities in metres, which is not interpolated across jumps of thrust.

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
    """A line on each burn."""
    return [
        f"MANOEUVRE {k}: {motion.utc(burn.start)} to {motion.utc(burn.end)} UTC, delta-v {1e3 * burn.delta_v:.6g} m/s, "
        f"thrust per unit mass at most {1e3 * burn.largest:.6g} m/s**2"
        for k, burn in enumerate(motion.burns, 1)
    ]
