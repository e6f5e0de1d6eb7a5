"""That all faults of a document are reached is known wherever the tests of its file have run."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from tests.support.faults import EveryFault

TESTS = ["test_a", "test_b"]


def reported(test: str, *reached: str, passed: bool = True, when: str = "call") -> SimpleNamespace:
    properties = [("tests", TESTS), ("faults", ["4.1", "4.2"]), ("reached", reached)]
    return SimpleNamespace(nodeid=f"tests/test_x.py::{test}", when=when, passed=passed, user_properties=properties)


def ended(*reports: SimpleNamespace) -> tuple[int, list[str]]:
    """How a run ends, and what it says."""
    held, session = EveryFault(), SimpleNamespace(exitstatus=pytest.ExitCode.OK)
    for report in reports:
        held.pytest_runtest_logreport(report)
    held.pytest_sessionfinish(session)
    lines: list[str] = []
    held.pytest_terminal_summary(SimpleNamespace(write_line=lambda line, **_: lines.append(line)))
    return session.exitstatus, lines


def test_a_fault_that_no_test_reaches_fails_the_run() -> None:
    code, (line,) = ended(reported("test_b"), reported("test_a[1]", "4.1"))
    assert code == pytest.ExitCode.TESTS_FAILED
    assert "tests/test_x.py" in line
    assert line.endswith("on 4.2")


def test_faults_that_tests_reach_between_them_are_fine() -> None:
    assert ended(reported("test_a", "4.1"), reported("test_b", "4.2")) == (0, [])


def test_of_some_tests_of_a_file_nothing_is_asked() -> None:
    assert ended(reported("test_a", "4.1")) == (0, [])
    assert ended(reported("test_a", "4.1"), reported("test_b", passed=False)) == (0, [])
    assert ended(reported("test_a", "4.1"), reported("test_b", when="setup")) == (0, [])
