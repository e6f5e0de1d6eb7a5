"""A motion as a table of comma-separated values."""

from __future__ import annotations

import numpy as np

from satsym.report.exchange.ephemeris import Ephemeris

COLUMNS = (
    ("utc", "time_s"),
    ("x_km", "y_km", "z_km"),
    ("vx_km_s", "vy_km_s", "vz_km_s"),
    ("thrust_x_km_s2", "thrust_y_km_s2", "thrust_z_km_s2"),
)


def table(motion: Ephemeris) -> str:
    """Time, position, velocity and thrust per unit mass, a line each; where the thrust jumps there are two lines.

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
