"""Wrappers of calls from Python: errors about bad input in one line, and linear algebra on one thread.

The traceback of an error about bad input ends at the caller's own line. On matrices as small as ours threads cost
several times what they save, and on cores that others use as well they wait for each other, until time is up before a
certificate has compared all competitors. The command line sets the number of threads before libraries are loaded; in a
notebook some are loaded already.
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
    """Return a function whose refusals have a traceback that ends at its caller.

    SATSYM_DEBUG=1 in the environment keeps the whole traceback.
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
"""Variables of the environment that limit libraries to one thread when they are loaded."""

_HELD = RLock()
"""Lock of the thread that limits libraries to one thread, because it also restores the setting."""


@contextmanager
def single_threaded() -> Iterator[None]:
    """Limit all libraries of linear algebra to one thread in this context.

    Afterwards each has as many threads as before; one that was loaded in the meantime has as many as the others.
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
