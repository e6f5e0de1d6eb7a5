"""Motions for other programs, as users ask for them."""

from __future__ import annotations

from pathlib import Path

from satsym.front.calls import in_one_line
from satsym.front.solution import Solution
from satsym.front.trajectory import Trajectory
from satsym.report.results.files import write_text


@in_one_line
def export(result: Solution | Trajectory, kind: str, path: str | Path | None = None) -> str:
    """A motion about a central body as other programs read it.

    Parameters
    ----------
    result
        Of an instance with a table [orbit].
    kind
        ``"oem"`` (orbit ephemeris message of CCSDS), ``"czml"`` (Cesium), ``"stk"`` (ephemeris of STK) or ``"csv"``.
    path
        Also write it there; a file of this name is replaced.

    Returns
    -------
    str
        The text of the file.

    Raises
    ------
    BadInput
        If it cannot be placed in the sky, or the library that writes the format is not installed: with one line that
        says what, where and what to do.

    Examples
    --------
    ::

        satsym.export(satsym.solve("return-to-geo"), "oem", "geo.oem")
    """
    from satsym.report.exchange import exported

    text = exported(result.found, kind)
    if path is not None:
        write_text(Path(path), text)
    return text
