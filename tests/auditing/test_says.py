"""What rows are about is told in Indonesian where the ledger has that beside it, and nowhere else."""

from __future__ import annotations

import json
import re
import tomllib
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest

from satsym.auditing import Judged, read
from satsym.auditing.ledger import documents
from satsym.auditing.sentences import in_indonesian
from satsym.cli import main
from satsym.formula.writing import GREEK
from satsym.report.findings.review import Review
from satsym.report.html import audit as page
from satsym.report.latex import audit as typeset
from satsym.report.texts import load
from tests.support.ledgers import TANGENTIAL, judged, ledger, row, write
from tests.support.said import ENGLISH

SLIP = row("2", "d_x4 = -(2*x2*x4 + u2)/x1", TANGENTIAL, says="rate of x4")
CARRIED = row("2", "d_x4 = -2*(2*x2*x4 + u2)/x1", TANGENTIAL, part="twice", **{"from": "2*rhs(row['2'])"})
PLAIN = row("3", "d_x4 = (u2 + 2*x2*x4)/x1", TANGENTIAL, says="as it is said again")
TORN = row("torn", "", "", legible=False, says="the page is torn")
TABLE = '# a comment\n"rate of x4" = "laju x4"\n"the page is torn" = "halamannya sobek"\n'

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def audited(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Exit code, stdout and stderr of `satsym audit`, with a cache of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))

    def run_audit(*arguments: str | Path) -> tuple[int, str, str]:
        code = main(["audit", *map(str, arguments)])
        return code, *capsys.readouterr()

    return run_audit


@pytest.fixture
def beside(tmp_path: Path) -> Path:
    """Where what rows are about stands in Indonesian."""
    return tmp_path / "small.says.id.toml"


@pytest.fixture
def found(tmp_path: Path, beside: Path) -> dict[str, Judged]:
    beside.write_text(TABLE, encoding="utf-8")
    return judged(tmp_path, [SLIP, CARRIED, PLAIN, TORN])


def shipped(path: Path) -> dict[str, str]:
    """What a shipped ledger has in Indonesian."""
    return tomllib.loads((path / documents.INDONESIAN).read_text("utf-8"))


# The shipped ledgers


@pytest.mark.parametrize("path", documents.shipped(), ids=lambda path: path.name)
def test_what_every_row_of_the_five_documents_is_about_is_told_in_indonesian(path: Path) -> None:
    """And nothing else is: a ledger with an entry of no row is refused when it is read."""
    rows = [one for one in read(path).rows if one.table.says]
    assert len(rows) > 50
    assert [one.key for one in rows if not one.says_id] == []


@pytest.mark.parametrize("path", documents.shipped(), ids=lambda path: path.name)
def test_numbers_and_symbols_are_those_of_the_english_and_words_are_not(path: Path) -> None:
    def kept(text: str) -> Counter[str]:
        words = re.findall(r"\d+(?:\.\d+)*|(?<!')\b\w+", text)
        return Counter(word for word in words if word in GREEK or word.isdigit() or re.search(r"_|\d|^[b-zA-Z]$", word))

    for english, text in shipped(path).items():
        assert kept(english.replace("24 h ", "24 jam ")) == kept(text), english
        assert not ENGLISH.search(re.sub(r"\w+\(\w+\)", "", text)), text
        assert text == text.strip()
        assert not text.endswith(".") or english.endswith("...")


def test_what_several_documents_say_is_told_in_the_same_words() -> None:
    told: dict[str, set[str]] = {}
    for path in documents.shipped():
        for english, text in shipped(path).items():
            told.setdefault(english, set()).add(text)
    assert len(told) > 700
    assert {english: texts for english, texts in told.items() if len(texts) > 1} == {}


# Any ledger


def test_reports_tell_it_in_indonesian_and_english_where_that_is_all_there_is(
    tmp_path: Path, found: dict[str, Judged]
) -> None:
    own = ledger(tmp_path, [SLIP, CARRIED, PLAIN, TORN])
    assert [in_indonesian(one.says) for one in own.rows] == ["laju x4", "", "as it is said again", "halamannya sobek"]
    rows = {"small": list(found.values())}
    english, indonesian = (page.render([own], rows, language) for language in ("en", "id"))
    assert "<span>rate of x4</span>" in english
    assert "<span>as it is said again</span>" in english
    assert "<span>laju x4</span>" in indonesian
    assert '<span lang="en">as it is said again</span>' in indonesian
    assert r"\satsymfact{tentang}{laju x4}" in typeset.render([own], rows, "id")
    assert r"\satsymfact{about}{rate of x4}" in typeset.render([own], rows, "en")
    torn = {language: Review.of(own, rows["small"], load(language)).rows[3].diagnosis for language in ("en", "id")}
    assert torn["en"].endswith(": the page is torn.")
    assert torn["id"].endswith(": halamannya sobek.")


def test_a_changed_translation_is_seen_by_the_cache_and_json_stays_english(
    audited: Run, tmp_path: Path, beside: Path
) -> None:
    path, page = write(tmp_path, [SLIP, TORN]), tmp_path / "page.html"
    without = audited(path, "--json")
    for told in ("halamannya sobek", "halaman itu hilang"):
        beside.write_text(TABLE.replace("halamannya sobek", told), encoding="utf-8")
        for _ in range(2):
            assert audited(path, "--html", page, "--lang", "id")[0] == 0
            assert "laju x4" in page.read_text("utf-8")
        kept = [json.loads(file.read_text("utf-8")) for file in (tmp_path / "cache").rglob("small-*.json")]
        assert sum(rows[1]["diagnosis_id"].endswith(f": {told}.") for rows in kept) == 1
        assert audited(path, "--json") == without


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        (
            '"rate of x4" = "laju x4"\n"rate of x5; so" = "laju x5"',
            2,
            'no row has the text "rate of x5"; copy the text',
        ),
        ('\n"rate of x4" = 4', 2, 'got 4 for "rate of x4"; write the Indonesian translation in quotes'),
        ('"rate of x4" = " "', 1, 'got " " for "rate of x4"; write the Indonesian'),
        ('"" = "kosong"', 1, 'no row has the text ""; copy the text'),
        ("# rows\n[rows]\n", 1, 'got a table for "rows"; write the Indonesian'),
        ("rate of x4 = 4", 0, "not valid TOML"),
    ],
)
def test_an_entry_of_no_row_or_that_is_no_text_is_3_with_its_line(
    audited: Run, tmp_path: Path, beside: Path, text: str, line: int, reason: str
) -> None:
    path = write(tmp_path, [SLIP, row("4", "d_x4 = u2/x1 - 2*x2*x4/x1", TANGENTIAL)])
    beside.write_text(text, encoding="utf-8")
    code, out, error = audited(path, "--json")
    assert (code, out) == (3, "")
    assert error.count("\n") == 1
    assert f"small.says.id.toml:{line}: {reason}" in error if line else f"small.says.id.toml: {reason}" in error
    assert not ENGLISH.search(
        re.sub(r'"[^"]*"|.*toml|bukan TOML yang sah: [^;]*', "", audited(path, "--lang", "id")[2])
    )
