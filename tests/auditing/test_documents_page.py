"""The page on the audited documents states what the audits find."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from satsym import auditing
from satsym.auditing import cache
from satsym.report.findings.review import Review
from satsym.report.texts import load

PAGE = Path(__file__).parents[2] / "docs" / "documents.md"
STATED = re.findall(
    r"^\| [^|]+ \| `(\w+)` \| (\d+) \| (\d+) \| (\d+) \| (\d+) of (\d+) \|$", PAGE.read_text("utf-8"), re.M
)


@pytest.mark.slow
@pytest.mark.parametrize("stated", STATED, ids=lambda stated: stated[0])
def test_the_page_counts_as_the_audit_does(stated: tuple[str, ...]) -> None:
    ledger = auditing.read(auditing.locate(stated[0]))
    review = Review(ledger, cache.audit(ledger), load("en"))
    conclusions = [row for row in review.rows if row.role == "conclusion"]
    fallen = {row.key for found in review.findings for row in found.overturned}
    counted = (len(review.rows), review.counts["confirmed"], len(review.findings), len(fallen), len(conclusions))
    assert counted == tuple(map(int, stated[1:]))


def test_the_page_has_every_document() -> None:
    assert [key for key, *_ in STATED] == ["its_thesis", "its_paper", "itb_eigen", "lapan_pitch", "uny_thesis"]
