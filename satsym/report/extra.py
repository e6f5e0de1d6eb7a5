"""Libraries of an extra: their import, and what to install where one is missing."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from satsym.status import BadInput


def library(name: str, distribution: str, extra: str) -> ModuleType:
    """Import a module of an optional library.

    Parameters
    ----------
    name
        Of the module.
    distribution, extra
        What it is installed as, and with which extra of satsym.

    Raises
    ------
    BadInput
        If it is not installed.
    """
    try:
        return import_module(name)
    except ImportError:
        raise BadInput(f"{distribution} is not installed; run pip install 'satsym[{extra}]'") from None


def written_by(name: str, distribution: str) -> ModuleType:
    """Import a module of a library of the extra ``exchange``.

    Raises
    ------
    BadInput
        If it is not installed.
    """
    return library(name, distribution, "exchange")
