"""LAPACK and BLAS as SciPy wraps them, without the rest of SciPy, whose import takes longer than a usual problem."""

from __future__ import annotations

from functools import cache
from importlib.machinery import PathFinder
from importlib.util import find_spec, module_from_spec
from pathlib import Path
from typing import Any

WRAPPERS = {"lapack": "_flapack", "blas": "_fblas"}
"""The compiled modules of ``scipy.linalg`` that need only a library and NumPy."""


def lapack() -> Any:
    """Return the double-precision routines of :mod:`scipy.linalg.lapack` by name: ``dgbtrf`` and others."""
    return _wrapper("lapack")


def blas() -> Any:
    """Return the compiled functions of :mod:`scipy.linalg.blas`, such as ``daxpy``, without the rest of SciPy."""
    return _wrapper("blas")


@cache
def _wrapper(library: str) -> Any:
    """Return the module of a library, loaded alone; as a part of SciPy where SciPy's layout is different."""
    scipy = find_spec("scipy")
    folders = [str(Path(folder, "linalg")) for folder in (scipy and scipy.submodule_search_locations) or ()]
    found = PathFinder.find_spec(WRAPPERS[library], folders)
    if found is not None and found.loader is not None:
        try:
            module = module_from_spec(found)
            found.loader.exec_module(module)
            return module
        except ImportError:  # as where another library is found by SciPy only
            pass
    from scipy import linalg

    return getattr(linalg, library)
