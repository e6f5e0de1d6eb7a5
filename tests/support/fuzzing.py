"""What the fuzzers of results and of instances share: commands that run here, and what may come of them."""

from __future__ import annotations

import contextlib
import io
import resource
import time
import warnings
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from satsym.cli import main

MOST_GROWTH = 2**30
"""Bytes by which one command may make this process larger."""


@dataclass(frozen=True)
class Outcome:
    """Exit code, what was written, what libraries warned of, seconds, and how much larger the process has become."""

    code: int
    out: str
    err: str
    warned: tuple[str, ...]
    seconds: float
    growth: int


def ran(arguments: Sequence[str]) -> Outcome:
    """Run a command in this process."""
    out, err, before, began = io.StringIO(), io.StringIO(), _largest(), time.perf_counter()
    with warnings.catch_warnings(record=True) as warned, contextlib.redirect_stdout(out):
        warnings.simplefilter("always")
        with contextlib.redirect_stderr(err):
            code = main(arguments)
    told = tuple(f"{one.category.__name__}: {one.message}" for one in warned)
    return Outcome(code, out.getvalue(), err.getvalue(), told, time.perf_counter() - began, _largest() - before)


def faults(found: Outcome, allowed: Collection[int]) -> Iterator[str]:
    """What is wrong with an outcome: nothing, if a command did its work or said in a line why not."""
    if found.code not in allowed:
        yield f"exit {found.code}: {found.err[-300:]}"
    if "Traceback" in found.err + found.out:
        yield "a traceback"
    if found.code == 3 and not (found.err.startswith("satsym: ") and found.err.count("\n") == 1 and not found.out):
        yield f"not one line: {found.err[:300]!r}"
    if not found.err.rstrip("\n").isprintable():
        yield f"not printable: {found.err[:300]!r}"
    yield from (f"warned: {one}" for one in found.warned)
    if found.growth > MOST_GROWTH:
        yield f"took {found.growth} bytes"


def _largest() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
