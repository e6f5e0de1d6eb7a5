"""Motions about a central body as other programs read them: OEM of CCSDS, CZML of Cesium, ephemerides of STK, CSV.

Each format is a module with one function from an :class:`~satsym.report.exchange.ephemeris.Ephemeris` to text.
"""

from __future__ import annotations

from collections.abc import Callable

from satsym.report.exchange.ephemeris import Ephemeris
from satsym.solution import Simulation, Solution
from satsym.status import BadInput
from satsym.wording import shown, suggestion

FORMATS = {"oem": ".oem", "czml": ".czml", "stk": ".e", "csv": ".csv"}
"""What is written, and how names of such files end."""


def exported(result: Solution | Simulation, kind: str) -> str:
    """A motion as the text of a file.

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
        raise BadInput(f"no export as {shown(kind)}; {suggestion(kind, FORMATS)}")
    return _writer(kind)(Ephemeris.of(result))


def _writer(kind: str) -> Callable[[Ephemeris], str]:
    """The function that writes a format; its module is loaded now."""
    if kind == "oem":
        from satsym.report.exchange.oem import oem

        return oem
    if kind == "czml":
        from satsym.report.exchange.czml import czml

        return czml
    if kind == "stk":
        from satsym.report.exchange.stk import stk

        return stk
    from satsym.report.exchange.table import table

    return table
