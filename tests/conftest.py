"""What all tests share."""

from __future__ import annotations

import gc
import hashlib
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import hypothesis
import pytest

# Before NumPy is loaded: on small matrices threads gain nothing, and those of two workers take each other's time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Workers of pytest-xdist have the one that readline sets in the process that starts them; others have none.
os.environ.pop("COLUMNS", None)

import satsym
from satsym.report.plots import style
from satsym.symbolic.lookup import library
from tests.support.derived import derived
from tests.support.examples import WHOLE
from tests.support.faults import EveryFault, found, ledger, verdicts

__all__ = ["found", "ledger", "verdicts"]

# The same examples on every run, and no deadline: two busy cores make any single example slow.
hypothesis.settings.register_profile(WHOLE, deadline=None, derandomize=True)
hypothesis.settings.register_profile("sample", hypothesis.settings.get_profile(WHOLE), max_examples=40)


SHARE = 40
"""Of the cases of slow tests every fortieth runs, unless all are asked for."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """``--whole``: every case of every test (`make test-whole`)."""
    parser.addoption("--whole", action="store_true", help="run all cases of slow tests, not a sample, and studies")


def pytest_configure(config: pytest.Config) -> None:
    """Only where reports of all processes come together is it known what none of the tests reached."""
    hypothesis.settings.load_profile(WHOLE if config.getoption("--whole") else "sample")
    if not hasattr(config, "workerinput"):
        config.pluginmanager.register(EveryFault())


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave a sample of slow tests, and no studies: those are for who has the time.

    Each revision of satsym has its own sample, which is the same in all processes and on all machines.
    """
    if config.getoption("--whole"):
        return
    spared = {item for item in items if item.get_closest_marker("study")}
    slow = [item for item in items if item.get_closest_marker("slow") and item not in spared]
    spared |= set(slow) - set(slow[revision() % SHARE :: SHARE])
    config.hook.pytest_deselected(items=[item for item in items if item in spared])
    items[:] = [item for item in items if item not in spared]


def revision() -> int:
    """A number made of all that satsym's code says."""
    found = hashlib.blake2b(digest_size=8)
    for path in sorted(Path(satsym.__file__).parent.rglob("*.py")):
        found.update(path.read_bytes())
    return int.from_bytes(found.digest())


def pytest_collection_finish() -> None:
    """What is collected stays until the end: it is no garbage, however often one looks."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(100_000, 20, 50)


@pytest.fixture(scope="session")
def whole(request: pytest.FixtureRequest) -> bool:
    """Whether every case of every test is asked for."""
    return bool(request.config.getoption("--whole"))


@pytest.fixture(scope="session")
def sample(whole: bool) -> Callable[[Iterable[Any]], list[Any]]:
    """What is looked at of many cases in one test: every fortieth, or all if all are asked for."""
    step = 1 if whole else SHARE
    return lambda cases: list(cases)[::step]


@pytest.fixture(scope="session")
def repository() -> Path:
    """The checkout that the tests belong to."""
    return Path(__file__).resolve().parent.parent


@pytest.fixture(autouse=True, scope="session")
def _no_windows() -> Iterator[None]:
    """Plots go to files, also where there is a display."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MPLBACKEND", "Agg")
        yield


@pytest.fixture(autouse=True, scope="session")
def _coarse_pictures() -> Iterator[None]:
    """Pictures drawn in the process of the tests are coarse, which takes less time; see ``full_resolution``."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(style._RC, "figure.dpi", 40)
        yield


@pytest.fixture(autouse=True, scope="session")
def _derivations_are_shared() -> Iterator[None]:
    """Shipped models that an audit looks into are derived once for all processes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(library, "derive", derived)
        yield


@pytest.fixture
def full_resolution(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures as users get them, for tests of how large they are."""
    monkeypatch.setitem(style._RC, "figure.dpi", style.DPI)
