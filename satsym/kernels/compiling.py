"""Compile a model's scalar functions and loops with numba, from the code that Python runs."""

from __future__ import annotations

from collections.abc import Mapping
from types import FunctionType
from typing import Any

from satsym import activity
from satsym.kernels.contract import BATCH
from satsym.status import BadInput


def compile_functions(functions: Mapping[str, Any], *, cache: bool) -> dict[str, Any]:
    """The functions with their scalar forms and loops as numba dispatchers, which compile at the first call.

    Parameters
    ----------
    functions
        Those of one module, by name.
    cache
        Whether machine code is kept beside the module's file. numba reads such a cache with pickle, so a
        folder that is not trusted must not offer one.

    Raises
    ------
    BadInput
        If numba is not installed.
    """
    try:
        import numba
    except ImportError:
        raise BadInput(
            "backend 'numba': numba is not installed; install the extra: pip install 'satsym[fast]'"
        ) from None
    result = dict(functions)
    if not functions:
        return result
    activity.tell("compiling; the first time this may take half a minute ...")
    # The copies share fresh globals, in which a function finds the compiled form of another.
    scope = dict(next(iter(functions.values())).__globals__)
    for name, function in functions.items():
        if name.endswith(BATCH):
            continue
        copy = FunctionType(function.__code__, scope, name, function.__defaults__)
        try:
            result[name] = numba.njit(copy, error_model="numpy", cache=cache)
        except RuntimeError:  # nowhere to keep a cache
            result[name] = numba.njit(copy, error_model="numpy")
        scope[name] = result[name]
    return result
