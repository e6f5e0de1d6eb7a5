"""The audit's reports for people: terminal, page and LaTeX say the same, each finding once, whatever a ledger holds."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import tomllib
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path

import pytest

from satsym.auditing import VERDICTS, Judged, Ledger, cache, read, sentences
from satsym.auditing.causes import Weight
from satsym.auditing.ledger import documents
from satsym.auditing.sentences import sentence
from satsym.formula.tree import Num
from satsym.report.findings.objects import audit_object
from satsym.report.findings.review import Review
from satsym.report.html import audit as page
from satsym.report.html.markup import Markup, joined, math, tag
from satsym.report.latex import audit as typeset
from satsym.report.latex.formula_tex import formula
from satsym.report.terminal.audit import audit_text
from satsym.report.texts import languages, load
from tests.support.ledgers import ledger, row

NASTY = (
    """</script><script>alert(1)</script><img src=x onerror=alert(1)> "q" 'p' & &lt;b&gt; `<i>` $x$ \\input{x} % # _"""
)
KELIRU = "Tanda `x` terbalik."
RATE = "saddle:first_order.x1"
HEAD = f"""
format = 1
[document]
key = "small"
title = {json.dumps(NASTY)}
authors = {json.dumps(NASTY)}
language = "id"
model = "saddle"
[scope.main]
x = "x1"
d_x = "d_x1"
""".replace("'</", "'''</").replace("% # _'", "% # _'''")
ROWS = [
    row("1", "d_x = x", RATE, where="chapter 1"),
    row("2", "d_x = -x", RATE, **{"from": "row['1']"}),
    row(
        "3", "stable('saddle')", "", "claim", original="titik ini stabil " + NASTY, role="conclusion", **{"from": ["2"]}
    ),
    row("4", "not stable('saddle')", "", "claim", original="titik ini pelana", role="conclusion", **{"from": ["1"]}),
    row("finding-1", "d_x = x", RATE),
    row("4 <", NASTY, "len(printed) > 3", "algorithm"),
    row("5", [["1", "2"], ["3", NASTY]], "len(printed) == 2", "table"),
]


def verdict(ledger: Ledger, key: str, found: str, **more: object) -> Judged:
    """A row of a ledger, judged by hand."""
    table = next(row.table for row in ledger.rows if row.key == key)
    same = {
        name: getattr(table, name) for name in ("item", "part", "kind", "says", "where", "printed", "role", "original")
    }
    evidence = f'{NASTY} = 1; satsym audit small --item "{key}"'
    judged = Judged("small", **same, derived="", verdict="confirmed", diagnosis="", evidence=evidence)
    return replace(judged, verdict=found, **more)


@pytest.fixture(scope="module")
def document(tmp_path_factory: pytest.TempPathFactory) -> Ledger:
    return ledger(tmp_path_factory.mktemp("ledger"), ROWS, HEAD)


@pytest.fixture(scope="module")
def judged(document: Ledger) -> dict[str, list[Judged]]:
    slip = "The sign of `x` is reversed. `<script>` is none."
    rows = [
        verdict(document, "1", "confirmed"),
        verdict(
            document,
            "2",
            "misprint",
            diagnosis=slip,
            derived="d_x = x",
            form="SIGN x",
            diagnosis_id="Tanda `x` terbalik.",
        ),
        verdict(
            document,
            "3",
            "wrong",
            diagnosis="The statement does not hold: 1.",
            why=f"It runs away. {NASTY}",
            spoiled_by=("2",),
        ),
        verdict(document, "4", "confirmed"),
        verdict(document, "finding-1", "confirmed"),
        verdict(
            document, "4 <", "wrong", diagnosis=f"The statement does not hold: {NASTY}.", derived=NASTY, role="result"
        ),
        verdict(document, "5", "undecided", diagnosis="This cannot be decided."),
    ]
    return {"small": rows}


@pytest.fixture(scope="module")
def pages(document: Ledger, judged: dict[str, list[Judged]]) -> dict[str, str]:
    return {language: page.render([document], judged, language) for language in languages()}


class Elements(HTMLParser):
    """Elements of a page with their attributes, and whether they are closed in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.text: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))
        if tag not in ("meta", "wbr"):
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text.append(data)

    def ids(self) -> list[str]:
        return [str(attributes["id"]) for _, attributes in self.found if "id" in attributes]

    def links(self) -> list[str]:
        return [str(attributes["href"]) for name, attributes in self.found if name == "a"]


# The page


@pytest.mark.parametrize("language", languages())
def test_nothing_that_a_ledger_holds_becomes_markup(pages: dict[str, str], language: str) -> None:
    elements = Elements(pages[language])
    assert elements.open == []
    names = Counter(name for name, _ in elements.found)
    assert (names["script"], names["img"], names["i"]) == (1, 0, 0)
    assert not [key for _, attributes in elements.found for key in attributes if key.startswith("on")]
    assert "<script>alert(1)</script><img src=x onerror=alert(1)>" in "".join(elements.text)


def test_a_page_needs_nothing_but_itself(pages: dict[str, str]) -> None:
    elements = Elements(pages["en"])
    assert "://" not in pages["en"]
    assert not {"src", "srcset", "action", "xlink:href"} & {key for _, a in elements.found for key in a}
    assert not re.search(r"url\(|@import", pages["en"])
    assert {"link", "iframe", "object", "base"}.isdisjoint(name for name, _ in elements.found)


def test_every_row_is_on_the_page_and_linked(pages: dict[str, str], judged: dict[str, list[Judged]]) -> None:
    elements = Elements(pages["en"])
    ids = elements.ids()
    assert len(ids) == len(set(ids))
    assert all(link.startswith("#") and link[1:] in ids for link in elements.links())
    rows = dict(re.findall(r'(<tr id="small\.[^>]*>.*?</tr>)()', pages["en"]))
    assert len(rows) == len(judged["small"])
    linked = {re.search(r'id="([^"]*)"', row)[1]: set(re.findall(r'href="#([^"]*)"', row)) for row in rows}  # type: ignore[index]
    assert linked["small.2"] == {"small-finding-1", "small.1", RATE}
    assert linked["small.3"] == {"small-finding-1", "small.2"}
    assert linked["small.4--2"] == {"small-finding-2"}
    assert linked["small.5"] == set()
    assert RATE in ids


def test_a_page_can_be_heard_and_reached_by_keys(pages: dict[str, str]) -> None:
    for language, text in pages.items():
        elements = Elements(text)
        assert ("html", {"lang": language}) in elements.found
        names = Counter(name for name, _ in elements.found)
        assert all(names[name] == 1 for name in ("h1", "main", "header", "nav", "title", "output"))
        levels = [int(name[1]) for name, _ in elements.found if re.fullmatch("h[1-6]", name)]
        assert all(after - before <= 1 for before, after in pairwise(levels))
        assert [a["lang"] for name, a in elements.found if name == "q"].count("id") >= 3  # the document's own words
        assert next(a.get("lang") for name, a in elements.found if name == "h2") == "id"
        assert all("scope" in a for name, a in elements.found if name == "th")


def test_reports_are_the_same_every_time(
    document: Ledger, judged: dict[str, list[Judged]], pages: dict[str, str]
) -> None:
    assert page.render([document], judged, "id") == pages["id"]
    assert typeset.render([document], judged, "id") == typeset.render([document], judged, "id")


def test_text_is_escaped_unless_it_is_markup() -> None:
    assert tag("a", "<b>", tag("b", "&"), title='"<') == '<a title="&quot;&lt;">&lt;b&gt;<b>&amp;</b></a>'
    assert joined("<", Markup("<br>"), by="|") == "&lt;|<br>"


@pytest.mark.parametrize("formula", ["a_b_c", r"\left( x", "x^"])
def test_a_formula_that_cannot_be_converted_is_shown_as_code(formula: str) -> None:
    assert math(formula) == tag("code", formula)


def test_a_number_is_a_fraction_only_where_no_decimal_is_exact() -> None:
    assert formula(Num(Fraction(7))) == "7"
    assert formula(Num(Fraction(1, 4))) == "0.25"
    assert formula(Num(Fraction(1, 3))) == r"\frac{1}{3}"


def test_mathematics_is_read_as_it_is_written() -> None:
    assert "<mtext>max</mtext>" in math(r"u_{\mathrm{max}}")
    assert re.search(r'<mo form="prefix">.</mo>', math(r"x = -\frac{1}{2}"))
    assert "form=" not in math("a - b")
    assert "\\" not in math(r"\max\biggl\{a, b\biggr\}")
    assert "<script>" not in math(r"\text{<script>&lt;script>}")


# What is said first


@pytest.mark.parametrize("language", languages())
def test_the_summary_says_what_falls_and_stands_and_why(
    document: Ledger, judged: dict[str, list[Judged]], language: str
) -> None:
    review = Review.of(document, judged["small"], load(language))
    assert 3 <= len(review.summary) <= 6
    checked, falls, stands, *_ = review.summary
    assert "7" in checked
    assert "titik ini stabil" in falls
    assert "(3): It runs away" in falls
    assert "titik ini pelana" in stands
    assert "titik ini stabil" not in stands


def test_a_conclusion_without_a_reason_of_its_own_falls_with_that_of_its_cause(
    document: Ledger, judged: dict[str, list[Judged]]
) -> None:
    rows = [replace(row, why="") for row in judged["small"]]
    english, indonesian = (Review.of(document, rows, load(language)).summary[1] for language in ("en", "id"))
    assert english.endswith("(3): because of 2: The sign of `x` is reversed.")
    assert indonesian.endswith("(3): karena 2: Tanda `x` terbalik.")


def test_many_conclusions_that_stand_are_named_and_not_quoted(
    document: Ledger, judged: dict[str, list[Judged]]
) -> None:
    rows = [*judged["small"], *(replace(judged["small"][3], item=f"9.{k}", verdict="unsound") for k in range(5))]
    stands = Review(document, rows, load("en")).summary[2]
    assert stands.startswith("These hold: 4; 9.0, though not for the reason given; 9.1")


def test_a_conclusion_that_is_right_for_another_reason_stands_with_a_word_about_it(
    document: Ledger, judged: dict[str, list[Judged]]
) -> None:
    rows = [replace(row, verdict="unsound") if row.key == "4" else row for row in judged["small"]]
    stands = Review(document, rows, load("en")).summary[2]
    assert stands.endswith('"titik ini pelana" (4), though not for the reason given.')


def test_what_is_right_has_nothing_to_correct(document: Ledger, judged: dict[str, list[Judged]]) -> None:
    right = {"small": [replace(row, verdict="confirmed", diagnosis="", why="") for row in judged["small"]]}
    assert "There is nothing to correct." in audit_text([document], right)
    assert "There is nothing to correct." in page.render([document], right)
    assert Review(document, right["small"], load("en")).confirmed_items == ["1", "2", "3", "4", "finding-1", "4 <", "5"]


def test_an_item_counts_as_confirmed_if_all_its_parts_are(document: Ledger, judged: dict[str, list[Judged]]) -> None:
    rows = [replace(row, item="1") if row.key in ("1", "2") else row for row in judged["small"]]
    assert Review(document, rows, load("en")).confirmed_items == ["4", "finding-1"]


# The terminal


@pytest.mark.parametrize("width", [60, 80, 100])
@pytest.mark.parametrize("language", languages())
def test_lines_fit_the_terminal_and_lose_nothing(
    monkeypatch: pytest.MonkeyPatch, document: Ledger, judged: dict[str, list[Judged]], width: int, language: str
) -> None:
    long = [replace(row, why="averylongname_" * 9 + "(x)+" * 40) if row.key == "3" else row for row in judged["small"]]
    monkeypatch.setenv("COLUMNS", str(width))
    narrow = audit_text([document], {"small": long}, rows=True, language=language)
    assert max(map(len, narrow.splitlines())) <= width
    labels = ("says", "claims", "printed", "in_fact", "measured", "recompute", "right", "spoils")
    assert max(len(load(language).get("audit", label)) for label in labels) < 10  # columns of a label
    assert "".join(long[2].why.split()) in "".join(narrow.split())
    monkeypatch.setenv("COLUMNS", "100")
    assert "".join(audit_text([document], judged, rows=True).split()) != "".join(narrow.split())
    assert NASTY.replace(" ", "") in "".join(narrow.split())


def test_each_finding_is_told_once_and_those_of_weight_in_full(
    document: Ledger, judged: dict[str, list[Judged]]
) -> None:
    text = " ".join(audit_text([document], judged).split())
    assert text.index("Overturns a conclusion 1. 2: misprint") < text.index("Wrong results 2. 4 <: wrong")
    assert text.count("affects 3") == 1
    assert "right" not in text.partition("1. 2: misprint")[2].partition("Wrong results")[0]  # the edit says it
    assert "Not judged 5." in text


@pytest.mark.parametrize(
    ("clause", "said"),
    {
        "the term is missing": "The term is missing.",
        "a cost in J needs kg": "A cost in J needs kg.",
        "unstable: it grows": "Unstable: it grows.",
        "omega is negative": "omega is negative.",
        "err1 and err2 are positive": "err1 and err2 are positive.",
        "r = 25 after 60 s": "r = 25 after 60 s.",
        "rank(R) = 3": "rank(R) = 3.",
        "cost = 3": "cost = 3.",
        "`u2` is reversed": "`u2` is reversed.",
        "": "",
    }.items(),
)
def test_symbols_keep_their_case(clause: str, said: str) -> None:
    assert sentence(clause) == said


def test_diagnoses_are_said_in_both_languages() -> None:
    fault = sentences.joined([sentences.say("carried_on", ["1", "2"]), "", sentences.say("same_slip", ["3"])])
    assert fault == "The error propagates to 1 and 2. The same slip occurs in 3."
    assert fault.indonesian == "Kekeliruan ini terbawa ke 1 dan 2. Kekeliruan yang sama ada di 3."
    assert sentences.stated(sentences.say("denied"), "{x}").indonesian == "Tidak benar demikian: {x}."
    assert sentence("x is measured") == sentences.in_indonesian("x is measured.")


def test_each_sentence_is_said_somewhere_and_has_the_same_places_in_both_languages() -> None:
    folder = Path(sentences.__file__).parent
    tables = tomllib.loads((folder / "sentences.toml").read_text(encoding="utf-8"))
    said = {key for path in folder.rglob("*.py") for key in re.findall(r'say\("(\w+)"', path.read_text("utf-8"))}
    assert said | {"rows", "columns"} == {*tables["rows"], *tables["sizes"], *tables["exchanges"]}
    for text in (text for table in tables.values() for text in table.values()):
        assert text.keys() == {"en", "id"}
        assert set(re.findall(r"{\d}", text["en"])) == set(re.findall(r"{\d}", text["id"])), text


# LaTeX and JSON


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no pdflatex to compile with")
@pytest.mark.parametrize("language", languages())
def test_whatever_a_ledger_holds_is_typeset(
    document: Ledger, judged: dict[str, list[Judged]], language: str, tmp_path: Path
) -> None:
    (tmp_path / "it.tex").write_text(typeset.render([document], judged, language), encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "it.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    log = done.stdout.decode("utf-8", "replace")
    assert done.returncode == 0, log
    assert "Overfull" not in log, re.findall(r"Overfull.*", log)


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no pdflatex to compile with")
@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("path", documents.shipped(), ids=lambda path: path.name)
def test_the_report_on_each_document_has_no_box_too_full_or_too_loose(
    path: Path, language: str, tmp_path: Path
) -> None:
    own = read(path)
    source = typeset.render([own], {own.document.key: cache.audit(own)}, language)
    (tmp_path / "it.tex").write_text(source, encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "it.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    log = done.stdout.decode("utf-8", "replace")
    assert done.returncode == 0, log
    assert re.findall(r"(?:Over|Under)full.*", log) == []


def test_every_verdict_and_weight_has_its_words_in_every_language() -> None:
    for language in languages():
        tables = load(language).tables
        assert set(tables["verdicts"]) == set(tables["verdict_meanings"]) == set(VERDICTS)
        weights = {weight.value for weight in Weight}
        assert set(tables["weights"]) == set(tables["weight_meanings"]) == set(tables["weights_counted"]) == weights


def test_objects_have_the_findings_beside_the_rows(judged: dict[str, list[Judged]]) -> None:
    found = audit_object(judged["small"])
    assert list(found) == ["rows", "findings", "counts"]
    assert found["findings"][0]["places"] == ["2"]
    assert found["findings"][0]["spoils"] == ["3"]
    assert [finding["weight"] for finding in found["findings"]] == ["overturns a conclusion", "wrong result"]


def test_each_finding_quotes_what_is_printed(document: Ledger, judged: dict[str, list[Judged]]) -> None:
    """Whether told in full or in a sentence; a proposition, which only a reader of code can follow, is no quotation."""
    told = " ".join(audit_text([document], judged).split())
    findings = told.partition("titik ini pelana")[2]
    for found in Review.of(document, judged["small"], load("en")).findings:
        printed = found.places[0].original or found.places[0].printed
        assert str(printed)[:40] in findings, found.places[0].key
    assert "stable('saddle')" not in findings
    assert "stable('saddle')" in " ".join(audit_text([document], judged, rows=True, code=True).split())
    conclusion = next(found for found in judged["small"] if found.original and found.verdict == "wrong")
    review = Review.of(document, [replace(conclusion, spoiled_by=())], load("en"))
    (brief,) = typeset._in_brief(review, 1, review.findings[0])
    assert r"\textit{titik ini stabil" in brief


def test_code_is_shown_of_what_was_measured_and_not_of_a_formula_alone(
    document: Ledger, judged: dict[str, list[Judged]]
) -> None:
    def shown(**more: object) -> bool:
        rows = [replace(row, **more) if row.key == "2" else row for row in judged["small"]]
        text = page.render([document], {"small": rows}, "en")
        _, _, finding = text.partition('id="small-finding-1"')
        return 'class="code"' in finding.partition('id="small-finding-2"')[0]

    assert shown()
    assert not shown(by_formula=True)
    assert not shown(evidence="")
