"""Libraries that write formats of others."""

from __future__ import annotations

from types import ModuleType

from satsym.report.extra import library


def written_by(name: str, distribution: str) -> ModuleType:
    """A module of a library of the extra ``exchange``, loaded now.

    Raises
    ------
    BadInput
        If it is not installed.
    """
    return library(name, distribution, "exchange")
