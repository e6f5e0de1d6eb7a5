"""Messages about the current activity of a long run, for a listener if there is one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_LISTENER: ContextVar[Callable[[str], None] | None] = ContextVar("listener", default=None)


def tell(what: str) -> None:
    """Say in a few words what begins now and takes its time."""
    listener = _LISTENER.get()
    if listener is not None:
        listener(what)


@contextmanager
def heard(listener: Callable[[str], None]) -> Iterator[None]:
    """Pass the messages within this context to a listener."""
    before = _LISTENER.set(listener)
    try:
        yield
    finally:
        _LISTENER.reset(before)
