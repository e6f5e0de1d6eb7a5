"""Questions answered in a process of its own, one after the other: none takes this process with it, nor for ever.

The module that answers is started with ``python -m``; it calls :func:`serve`, and :class:`Child` asks it.
"""

from __future__ import annotations

import json
import math
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import FrameType, TracebackType
from typing import Any

ROOT = Path(__file__).resolve().parents[2]

GRACE = 60.0
"""Seconds of the processor after which a process is ended that has not minded that its time is over."""

TOO_LONG, ENDED, ERROR = "too long", "ended", "error"
"""What is said in place of an answer: its time was over, the process ended, or an exception was raised."""

Said = dict[str, Any]


class Child:
    """A process that answers questions; begun when it is asked first, and anew when it has ended.

    Parameters
    ----------
    module, arguments
        What is started.
    settings
        Variables of its environment, beside those of this process.
    work
        Seconds of the processor that a question may take.
    """

    def __init__(
        self, module: str, *arguments: str, settings: Mapping[str, str] | None = None, work: float = math.inf
    ) -> None:
        self.command = [sys.executable, "-m", module, *arguments]
        self.environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", **(settings or {})}
        self.work = work
        self.process: subprocess.Popen[str] | None = None

    def __enter__(self) -> Child:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.end()

    def ask(self, question: Any) -> Said:
        """The answer, with the ``seconds`` of the processor that it took, unless it says that itself."""
        process = self.process = self.process or self._begun()
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            process.stdin.write(json.dumps({"question": question, "work": self.work}) + "\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if line.endswith("\n"):
            said: Said = json.loads(line)
            return said
        code = process.wait()
        self.process = None
        if code == -signal.SIGXCPU:
            return {"status": TOO_LONG, "seconds": self.work}
        return {"status": ENDED, "said": f"the process ended with {code}", "seconds": math.nan}

    def end(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None

    def _begun(self) -> subprocess.Popen[str]:
        pipe = subprocess.PIPE
        return subprocess.Popen(self.command, cwd=ROOT, env=self.environment, stdin=pipe, stdout=pipe, text=True)


class TooLong(BaseException):
    """The time of a question is over; no ``Exception``, so that nothing that tries another way goes on."""


def serve(answer: Callable[[Any], Said]) -> None:
    """Answer what is asked on the standard input; what else is printed goes to where errors do."""
    answers, sys.stdout = sys.stdout, sys.stderr
    for line in sys.stdin:
        asked = json.loads(line)
        began = time.process_time()
        try:
            with limited(asked["work"]):
                said = answer(asked["question"])
        except TooLong:
            said = {"status": TOO_LONG}
        except Exception as error:
            said = {"status": ERROR, "said": f"{type(error).__name__}: {error}"}
        seconds = said.pop("seconds", time.process_time() - began)
        print(json.dumps({**said, "seconds": seconds}), file=answers, flush=True)


@contextmanager
def limited(work: float) -> Iterator[None]:
    """Raise :class:`TooLong` after these seconds of the processor; end the process if it does not mind that."""
    if not math.isfinite(work):
        yield
        return
    before, (soft, hard) = signal.signal(signal.SIGPROF, _over), resource.getrlimit(resource.RLIMIT_CPU)
    used = resource.getrusage(resource.RUSAGE_SELF)
    last = math.ceil(used.ru_utime + used.ru_stime + work + GRACE)
    resource.setrlimit(resource.RLIMIT_CPU, (last if hard == resource.RLIM_INFINITY else min(last, hard), hard))
    signal.setitimer(signal.ITIMER_PROF, work)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
        resource.setrlimit(resource.RLIMIT_CPU, (soft, hard))


def _over(number: int, frame: FrameType | None) -> None:
    raise TooLong


def tell(text: str) -> None:
    """Where people watch, one line that the next replaces; an empty one takes it away."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)
