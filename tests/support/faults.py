"""Fixtures of files that find a document's faults once more by hand; such a file names its ``DOCUMENT``.

They reach the tests through conftest.py.
"""

from __future__ import annotations

import tomllib
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import pytest

from satsym import auditing as audit
from satsym.auditing import cache
from tests.support.ledgers import whole

FAULTLESS = ("confirmed", "illegible")


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

    faults = sorted(key for key, verdict in verdicts.items() if verdict not in FAULTLESS)
    tests = sorted(test for test in vars(request.module) if test.startswith("test_"))
    request.node.user_properties += [("faults", faults), ("tests", tests)]

    def check(verdict: str, *keys: str) -> None:
        request.node.user_properties.append(("reached", keys))
        for key in keys:
            assert verdicts[key] == verdict, key

    return check


@dataclass
class Sums:
    """What the tests of each file reached, from whatever process they report."""

    tests: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    faults: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    reached: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    passed: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))

    def add(self, report: pytest.TestReport) -> None:
        """Take in what a test says of itself once it has run."""
        if report.when != "call" or not report.passed:
            return
        file, _, test = report.nodeid.partition("::")
        self.passed[file].add(test.partition("[")[0])
        for name, values in report.user_properties:
            if name in ("tests", "faults", "reached"):
                getattr(self, name)[file].update(values)

    def unreached(self) -> list[str]:
        """A line for each file all of whose tests have passed, and which leaves out faults of its document."""
        return [
            f"{file}: no test reaches the verdicts on {', '.join(sorted(left))}"
            for file, tests in self.tests.items()
            if tests <= self.passed[file] and (left := self.faults[file] - self.reached[file])
        ]


class EveryFault:
    """Holds files that reach a document's faults by second routes to reaching all of them, at the end of a run."""

    def __init__(self) -> None:
        self.sums = Sums()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.sums.add(report)

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        if self.sums.unreached() and session.exitstatus == pytest.ExitCode.OK:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        for line in self.sums.unreached():
            terminalreporter.write_line(line, red=True)
