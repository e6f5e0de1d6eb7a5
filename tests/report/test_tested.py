"""Propositions that an audit tested, as mathematics."""

from __future__ import annotations

import pytest

from satsym.report.html.markup import math
from satsym.report.html.tested import mathematics


@pytest.mark.parametrize(
    ("proposition", "tex"),
    [
        ("all(x > 0 for x in values)", r"\forall"),
        ("any(x == 0 for x in values)", r"\exists"),
        ("x1[0] == 1", "}_{0}"),  # an index on what has one
        ("implies(a < b, not c)", r"\Rightarrow"),
        ("abs(x - y) <= NEAR", r"\left|"),
        ("(a + b) * c / d", r"\frac"),
    ],
)
def test_a_proposition_is_written_as_mathematics_that_a_page_shows(proposition: str, tex: str) -> None:
    found = mathematics(proposition)
    assert tex in found
    assert "<math" in math(found, block=True)


@pytest.mark.parametrize("proposition", ["text['appendix B']", "x if y else z", "{1: 2}", "a +", "f(" * 300])
def test_what_has_no_usual_form_is_left_as_code(proposition: str) -> None:
    assert mathematics(proposition) == ""
