"""Libraries that write formats of others: what to install where one is missing."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from satsym.status import BadInput


def library(name: str, distribution: str) -> ModuleType:
    """A module of a library of the extra ``exchange``, loaded now.

    Raises
    ------
    BadInput
        If it is not installed.
    """
    try:
        return import_module(name)
    except ImportError:
        raise BadInput(
            f"{distribution} is not installed, which writes this format; pip install 'satsym[exchange]'"
        ) from None
