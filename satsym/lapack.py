"""LAPACK as SciPy wraps it, without the rest of SciPy: loading that takes longer than solving a usual problem."""

from __future__ import annotations

from functools import cache
from importlib.machinery import PathFinder
from importlib.util import find_spec, module_from_spec
from pathlib import Path
from typing import Any

WRAPPER = "_flapack"
"""The module of ``scipy.linalg`` that is compiled against LAPACK, and needs NumPy alone."""


@cache
def lapack() -> Any:
    """What has the routines of :mod:`scipy.linalg.lapack` in double precision, by their names: ``dgbtrf`` and others.

    The compiled module is loaded by itself; where SciPy is laid out in another way, as a part of SciPy.
    """
    scipy = find_spec("scipy")
    folders = [str(Path(folder, "linalg")) for folder in (scipy and scipy.submodule_search_locations) or ()]
    found = PathFinder.find_spec(WRAPPER, folders)
    if found is not None and found.loader is not None:
        try:
            module = module_from_spec(found)
            found.loader.exec_module(module)
            return module
        except ImportError:  # as where a library that it needs is found by SciPy only
            pass
    from scipy.linalg import lapack as whole

    return whole
