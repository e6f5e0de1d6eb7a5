"""What a long run is at just now, for whoever shows it: nobody, unless someone listens."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_LISTENER: ContextVar[Callable[[str], None] | None] = ContextVar("listener", default=None)


def tell(what: str) -> None:
    """Say what begins now and takes its time, in a few words."""
    listener = _LISTENER.get()
    if listener is not None:
        listener(what)


@contextmanager
def heard(listener: Callable[[str], None]) -> Iterator[None]:
    """Pass what is said in here to a listener."""
    before = _LISTENER.set(listener)
    try:
        yield
    finally:
        _LISTENER.reset(before)
