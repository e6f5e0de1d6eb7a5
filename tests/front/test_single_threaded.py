"""What is called from Python holds libraries of linear algebra to one thread, and gives their threads back."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import satsym
from satsym import solvers
from satsym.front.calls import VARIABLES, single_threaded
from satsym.status import BadInput

BEGINNING = """
import json, os
from threading import Event, Thread
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.pop(name, None)
import numpy, threadpoolctl
from satsym.front.calls import single_threaded
with threadpoolctl.threadpool_limits(3, "blas") as limited:
    limited.restore_original_limits = lambda: None
def threads():
    return sorted({one["num_threads"] for one in threadpoolctl.threadpool_info() if one["user_api"] == "blas"})
"""

LATER = """
with single_threaded():
    import scipy.linalg
    inside = threads()
print(json.dumps([inside, threads(), [name for name in os.environ if name.endswith("NUM_THREADS")]]))
"""

OVERLAPPING = """
begun, leave = Event(), Event()
def first():
    with single_threaded():
        begun.set()
        leave.wait()
other = Thread(target=first, daemon=True)
other.start()
begun.wait()
with single_threaded():
    assert threads() == [1]
    leave.set()
    other.join()
print(json.dumps(threads()))
"""


def said_by(script: str) -> Any:
    done = subprocess.run([sys.executable, "-c", BEGINNING + script], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def threads() -> set[int]:
    return {one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"}


@pytest.fixture(autouse=True)
def of_a_notebook() -> Iterator[None]:
    with threadpool_limits(2, "blas"):
        yield


@pytest.mark.parametrize("name", ["solve", "simulate", "analyse", "lqr"])
def test_it_computes_on_one_thread(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[set[int]] = []

    def seeing(function: Callable[..., Any]) -> Callable[..., Any]:
        def seen_by(*given: Any) -> Any:
            seen.append(threads())
            return function(*given)

        return seen_by

    from satsym.analysis import subject
    from satsym.analysis.regulator import feedback

    for owner, attribute in ((solvers, "solve"), (subject, "examined"), (feedback, "simulate"), (feedback, "designed")):
        monkeypatch.setattr(owner, attribute, seeing(getattr(owner, attribute)))
    getattr(satsym, name)("uny-lqr" if name == "lqr" else "soft-return")
    assert seen == [{1}]
    assert threads() == {2}


def test_threads_come_back_after_an_error() -> None:
    with pytest.raises(BadInput):
        satsym.solve("no-such-instance")
    assert threads() == {2}


def test_of_two_at_once_the_first_gives_threads_back_for_both() -> None:
    assert said_by(OVERLAPPING) == [3]


def test_variables_come_back_with_what_they_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLES[0], "7")
    monkeypatch.delenv(VARIABLES[1], raising=False)
    with single_threaded():
        assert {os.environ[name] for name in VARIABLES} == {"1"}
    assert (os.environ[VARIABLES[0]], VARIABLES[1] in os.environ) == ("7", False)


def test_a_library_loaded_in_the_meantime_has_as_many_as_the_others() -> None:
    assert said_by(LATER) == [[1], [3], []]
