"""Why a row goes wrong: sentences with measured terms for any row, what follows instead, one finding for one fault."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from satsym.auditing import measurements
from satsym.auditing.causes import findings
from satsym.auditing.ledger import documents
from satsym.auditing.ledger.load import read
from satsym.auditing.measurements.earth import quantity
from satsym.auditing.measurements.formulas import subs
from satsym.auditing.propositions.evaluation import Evaluation
from satsym.auditing.propositions.reading import proposition
from satsym.report.findings.review import Review
from satsym.report.texts import load
from satsym.status import BadInput
from tests.support.ledgers import TANGENTIAL, judged, ledger, row

WRONG = "d_x4 = -(2*x2*x4 + u2)/x1"
RIGHT = "d_x4 = (u2 - 2*x2*x4)/x1"


def test_a_formula_that_is_wrong_tells_why_beside_the_edit(tmp_path: Path) -> None:
    rows = [
        row("first", WRONG, TANGENTIAL, why="thrust adds {diff(row['first'], u2)}"),
        row("second", RIGHT, TANGENTIAL),
    ]
    found = judged(tmp_path, rows)
    assert found["first"].why == "Thrust adds -1/r."
    assert found["second"].why == ""
    told = Review(ledger(tmp_path, rows), list(found.values()), load("en")).fact(found["first"])
    assert "sign" in told
    assert told.endswith("Thrust adds -1/r.")


def test_reports_in_indonesian_tell_why_in_indonesian_where_the_ledger_does(tmp_path: Path) -> None:
    """With the same measured terms, of formulas and of claims; English is left where it is all there is."""
    claim = {"kind": "claim", "original": "so", "from": []}
    rows = [
        row("first", WRONG, TANGENTIAL, why="thrust adds {2 + 3}", why_id="dorongan menambah {2 + 3}"),
        {"item": "second", "printed": "2 == 3", "why": "it is {1 + 1}", "why_id": "nilainya {1 + 1}", **claim},
        {"item": "third", "printed": "2 == 4", "why": "it is {1 + 1}", **claim},
    ]
    found = judged(tmp_path, rows)
    told = {}
    for language in ("en", "id"):
        review = Review.of(ledger(tmp_path, rows), list(found.values()), load(language))
        told[language] = [review.fact(one) for one in review.rows]
    assert [text.endswith(end) for text, end in zip(told["en"], ("adds 5.", "is 2.", "is 2."), strict=True)] == [
        True
    ] * 3
    assert told["id"][0].endswith("Dorongan menambah 5.")
    assert "sign" not in told["id"][0]
    assert told["id"][1:] == ["Nilainya 2.", "It is 2."]
    assert found["second"].diagnosis.endswith("It is 2.")


def test_what_terms_measure_is_called_in_indonesian_and_formulas_are_left(tmp_path: Path) -> None:
    about = "{[E.stability for E in EQUILIBRIA if E.called == 'oscillator with cubic driving'][0]}"
    claim = {"kind": "claim", "original": "so", "from": [], "why": f"it is {about}", "why_id": f"sistemnya {about}"}
    rows = [{"item": "1", "printed": "2 == 3", **claim}]
    (found,) = judged(tmp_path, rows).values()
    assert (found.why, found.why_id) == ("It is unstable.", "Sistemnya tidak stabil.")
    row = replace(found, derived="len(meanings['x']) = 2", why="", diagnosis="")
    review = Review.of(ledger(tmp_path, rows), [row], load("id"))
    assert review.in_words(review.rows[0]) == "Dokumen memakai `x` dengan 2 arti."


@pytest.mark.parametrize("path", documents.shipped(), ids=lambda path: path.name)
def test_what_the_five_documents_are_answered_is_told_in_both_languages_with_the_same_terms(path: Path) -> None:
    for one in read(path).rows:
        texts = (one.table.why, one.table.why_id)
        english, indonesian = (sorted(re.findall(r"{[^{}]*}", text)) for text in texts)
        assert english == indonesian, one.key
        assert bool(texts[0]) == bool(texts[1]), one.key
        assert not texts[0] or texts[0] != texts[1], one.key


def test_a_right_formula_tells_no_reason(tmp_path: Path) -> None:
    assert judged(tmp_path, [row("first", RIGHT, TANGENTIAL, why="{1 + 1}")])["first"].why == ""


def test_what_does_not_follow_is_told_with_what_does(tmp_path: Path) -> None:
    rows = [row("first", RIGHT, TANGENTIAL), row("second", RIGHT, TANGENTIAL, **{"from": "2*rhs(row['first'])"})]
    found = judged(tmp_path, rows)["second"]
    assert found.verdict == "unsound"
    assert "that gives `" in found.diagnosis
    assert "2*u2" in found.diagnosis.replace("(", "").replace(" ", "")


def test_the_same_printed_twice_and_wrong_alike_is_one_finding(tmp_path: Path) -> None:
    def unit(item: str, printed: str) -> dict[str, object]:
        return dict(row(item, printed, "r*theta_dot", "unit"))

    found = findings(list(judged(tmp_path, [unit("1", "deg"), unit("2", "deg"), unit("3", "kg")]).values()))
    assert [[place.item for place in finding.places] for finding in found] == [["1", "2"], ["3"]]


def test_places_of_one_finding_tell_their_own_reasons(tmp_path: Path) -> None:
    claims = [
        {"item": str(n), "kind": "claim", "printed": f"sqrt({n}) == 9", "original": "so", "from": [],
         "why": f"the root is {{sqrt({n})}}"}
        for n in (4, 16)
    ]  # fmt: skip
    rows = list(judged(tmp_path, claims).values())
    (finding,) = findings(rows)
    assert Review(ledger(tmp_path, claims), rows, load("en")).brief(finding) == "The root is 2. The root is 4"


def test_a_conclusion_about_nothing_stands_with_that_reserve(tmp_path: Path) -> None:
    claims = [{"item": "1", "kind": "claim", "role": "conclusion", "original": "so", "from": [],
               "printed": "all(implies(n > 9, n == 1) for n in [1, 2])"}]  # fmt: skip
    (found,) = judged(tmp_path, claims).values()
    assert found.verdict == "unsound"
    assert found.diagnosis == "The statement is vacuous: none of 2 cases satisfies the condition n > 9."
    said = " ".join(Review(ledger(tmp_path, claims), [found], load("en")).summary)
    assert "though only because nothing satisfies its condition" in said
    assert "reason given" not in said


def test_a_letter_takes_a_plain_quantity_and_no_length() -> None:
    words = measurements.words()

    def value(text: str) -> str:
        return Evaluation(words).term(proposition(text, words))

    rate = "rates('clohessy_wiltshire')[1]"
    assert value(f"subs({rate}, omega=quantity('2 km')/quantity('1000 m'), x1=1, x4=0, u1=0)").rstrip("0") == "12."
    with pytest.raises(BadInput, match="divide it by a unit"):
        value(f"subs({rate}, omega=quantity('2 km'))")
    assert str((quantity("8 km^3/s^3")) ** (1 / 3)) == "2000 m/s"
    assert subs(3, omega=quantity("1 m")) == 3
