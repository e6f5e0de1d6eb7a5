"""Compilation of texts written for a model; machine code is kept in the user's cache folder.

The place of machine code is a digest of the text, which follows from the generated module: a module that is derived
anew is compiled anew.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numpy as np

from satsym import activity, user_cache
from satsym.kernels.core import Kernels
from satsym.status import BadInput

HEAD = ('"""Written by satsym; it may be removed at any time."""', "", "import math", "", "inf = math.inf")
"""First lines of every source text that is compiled."""

FAST_MATH_FLAGS = {"contract", "nsz", "arcp"}
"""Floating-point transformations that compilers may apply; they may never assume that numbers are finite."""


MOST_KEPT = 500 * 10**6
"""Size of cached machine code, in bytes, above which the least recently used code is removed."""


def able() -> bool:
    """Tell whether a compiler is installed."""
    return find_spec("numba") is not None


def module_text(kernels: Kernels) -> str:
    """Return the text of the generated module that kernels come from.

    Raises
    ------
    BadInput
        If there is none, for they were made by hand.
    """
    from satsym.kernels import loading

    if kernels.text is not None:
        return kernels.text
    if kernels.origin is None:
        raise BadInput(
            f"{kernels.spec.name}: the kernels were made without a generated module, so there is nothing to compile"
        )
    return loading.shipped_text(kernels.origin[0])


@lru_cache(maxsize=32)
def compiled(name: str, text: str) -> Mapping[str, Any]:
    """Return the functions of a text by name, compiled at their first call or read from the cache.

    Parameters
    ----------
    name
        Name of the model.
    text
        Source text that satsym wrote for the model.
    """
    import numba

    digest = hashlib.sha256(text.encode()).hexdigest()[:24]
    path = user_cache.folder("kernels") / f"{name}-{digest}" / "columns.py"
    if user_cache.read(path) != text.encode():
        user_cache.write(path, text.encode())
        user_cache.prune(user_cache.folder("kernels"), MOST_KEPT, path.parent)
    user_cache.used(path.parent)
    keeps = user_cache.read(path) == text.encode() and _writable(path.parent)
    if not any(path.parent.glob("__pycache__/*.nbi")):  # numba keeps machine code there
        activity.tell(f"compiling {name}, once only ...")
    module = ModuleType(f"satsym_kept_{name}_{digest}")
    sys.modules[module.__name__] = module  # where machine code that was kept looks for it
    vars(module).update(np=np, __file__=str(path))
    exec(compile(text, str(path), "exec"), vars(module))  # noqa: S102 - written by us, from checked functions
    names = [key for key, value in vars(module).items() if isinstance(value, FunctionType)]
    for key in names:
        function = numba.njit(
            vars(module)[key], error_model="numpy", fastmath=FAST_MATH_FLAGS, nogil=True, cache=keeps and key in ENTRIES
        )
        setattr(module, key, function)
    return {key: vars(module)[key] for key in names}


ENTRIES = ("accurate", "rough", "leap_costing", "leap_varied", "many", "combine")
"""Compiled functions that are called from Python; their machine code is cached with all functions that they call."""


@contextmanager
def alone(name: str) -> Iterator[None]:
    """Hold a lock while machine code is made for a model: a process that waited finds the code made."""
    path = user_cache.folder("kernels") / f"{name}.lock"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        stream = path.open("a")
    except OSError:
        yield
        return
    with stream:
        try:
            import fcntl

            fcntl.flock(stream, fcntl.LOCK_EX)
        except (ImportError, OSError):
            pass  # a system or a folder without locks: it is made twice
        yield


def _writable(folder: Path) -> bool:
    import os

    return os.access(folder, os.W_OK)
