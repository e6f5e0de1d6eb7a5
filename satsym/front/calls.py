"""Wrappers of calls from Python: errors about bad input in one line, and linear algebra on one thread.

The traceback of an error about bad input ends at the caller's own line. For matrices as small as those of satsym, the
overhead of threads exceeds their gain, and on cores that are also used by others threads wait for each other, so that a
certificate may run out of time. The command line sets the number of threads before libraries are loaded, but in a
notebook some libraries are already loaded.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from threading import RLock
from typing import ParamSpec, TypeVar

from satsym.status import BadInput

Given = ParamSpec("Given")
Answer = TypeVar("Answer")


def in_one_line(function: Callable[Given, Answer]) -> Callable[Given, Answer]:
    """Return a function that raises BadInput with a traceback that ends at the caller of the function.

    If SATSYM_DEBUG=1 is set in the environment, the whole traceback is kept.
    """

    @wraps(function)
    def asked(*args: Given.args, **options: Given.kwargs) -> Answer:
        try:
            return function(*args, **options)
        except BadInput as error:
            if os.environ.get("SATSYM_DEBUG"):
                raise
            raise error.with_traceback(None) from None

    return asked


VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""Environment variables that limit libraries of linear algebra to one thread when these are loaded."""

_HELD = RLock()
"""Lock that is set while libraries are limited to one thread, so that one thread only sets and restores the limit."""


@contextmanager
def single_threaded() -> Iterator[None]:
    """Limit all libraries of linear algebra to one thread in this context.

    Afterwards the previous numbers of threads are restored; a library that was loaded within the context receives the
    largest of these numbers.
    """
    from threadpoolctl import ThreadpoolController

    if not _HELD.acquire(blocking=False):
        yield
        return
    try:
        libraries = ThreadpoolController().select(user_api="blas")
        before = {library.filepath: library.num_threads for library in libraries.lib_controllers}
        variables = {name: os.environ[name] for name in VARIABLES if name in os.environ}
        with libraries.limit(limits=1):
            os.environ.update(dict.fromkeys(VARIABLES, "1"))
            try:
                yield
            finally:
                for name in VARIABLES:
                    os.environ.pop(name, None)
                os.environ.update(variables)
                for library in ThreadpoolController().select(user_api="blas").lib_controllers:
                    if library.filepath not in before:
                        library.set_num_threads(max(before.values(), default=os.cpu_count() or 1))
    finally:
        _HELD.release()
