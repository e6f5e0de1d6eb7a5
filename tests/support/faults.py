"""Fixtures of files that find a document's faults once more by hand; such a file names its ``DOCUMENT``.

They reach the tests through conftest.py.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from typing import Any

import pytest

from satsym import auditing as audit
from satsym.auditing import cache
from tests.support.ledgers import whole

FAULTLESS = ("confirmed", "illegible")

_REACHED: dict[str, set[str]] = {}
_RAN: dict[str, set[str]] = {}


@pytest.fixture(autouse=True)
def noted(request: pytest.FixtureRequest) -> None:
    """That a test has run in this process."""
    _RAN.setdefault(request.module.__name__, set()).add(request.node.originalname)


@pytest.fixture(scope="module")
def verdicts(request: pytest.FixtureRequest) -> dict[str, str]:
    """What the audit says of each row, by item and part."""
    judged = cache.audit(audit.read(audit.locate(request.module.DOCUMENT)))
    return {f"{row.item} {row.part}".strip(): row.verdict for row in judged}


@pytest.fixture(scope="module")
def ledger(request: pytest.FixtureRequest) -> dict[str, Any]:
    """The ledger as it is written."""
    return tomllib.loads(whole(request.module.DOCUMENT))


@pytest.fixture
def found(request: pytest.FixtureRequest, verdicts: dict[str, str]) -> Callable[..., None]:
    """Holds rows against the verdict that the test has reached."""

    def check(verdict: str, *keys: str) -> None:
        for key in keys:
            _REACHED.setdefault(request.module.__name__, set()).add(key)
            assert verdicts[key] == verdict, key

    return check


def assert_all_reached(request: pytest.FixtureRequest, verdicts: dict[str, str]) -> None:
    """Every row with a fault has been reached by some test of the file; skips where not all of them have run here."""
    name = request.module.__name__
    if {test for test in vars(request.module) if test.startswith("test_")} - _RAN[name]:
        pytest.skip("needs all other tests of this file to have run before it, in one process")
    assert not {key for key, verdict in verdicts.items() if verdict not in FAULTLESS} - _REACHED[name]
