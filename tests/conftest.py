"""What all tests share."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest

from tests.faults import found, ledger, noted, verdicts

__all__ = ["found", "ledger", "noted", "verdicts"]

# The same examples on every run, and no deadline: two busy cores make any single example slow.
hypothesis.settings.register_profile("satsym", deadline=None, derandomize=True)
hypothesis.settings.load_profile("satsym")


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
