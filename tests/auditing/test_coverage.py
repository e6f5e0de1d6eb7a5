"""What of a text has a row, with the text and from what is kept of it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from satsym import auditing
from satsym.auditing.ledger import coverage
from satsym.cli import main
from tests.support.ledgers import TANGENTIAL, row, write

TEXT = """\
BAB I
1.1 Tujuan
Kami mencari kontrol optimal dari sistem gerak sate-
lit ini. Sistem itu adalah sistem yang
stabil. Terima kasih. Satelit selalu kembali ke orbitnya.

BAB II
2.1 Model
Dengan demikian berlaku
𝑥4' = (𝑢2 − 2𝑥2𝑥4)/𝑥1    (2.1)
dan seterusnya dari persamaan (2.7)
$$ y = x \\tag{2.2} $$
Gambar 2.1 Satelit pada orbitnya
Tabel 2.1. Nilai
"""
CLAIM = """
[[row]]
item = "stable"
kind = "claim"
where = "section 1.1"
printed = "not stable('clohessy_wiltshire')"
original = "kontrol optimal dari sistem gerak satelit ... adalah sistem yang stabil"
from = []
"""


@pytest.fixture
def ledger(tmp_path: Path) -> Path:
    """A ledger of one equation and one claim, and its text beside it."""
    path = write(tmp_path, [row("2.1", "d_x4 = (u2 - 2*x2*x4)/x1", TANGENTIAL, where="section 2.1")])
    path.write_text(path.read_text(encoding="utf-8") + CLAIM, encoding="utf-8")
    (tmp_path / "text.txt").write_text(TEXT, encoding="utf-8")
    return path


def cover(capsys: pytest.CaptureFixture[str], path: Path, *arguments: str | Path) -> dict[str, object]:
    assert main(["audit", str(path), "--coverage", "--json", *map(str, arguments)]) == 0
    found: dict[str, object] = json.loads(capsys.readouterr().out)["coverage"][0].get("text", {})
    return found


def test_what_is_numbered_or_asserted_is_found_and_matched(ledger: Path) -> None:
    found = coverage.measured(auditing.read(ledger), TEXT).found
    assert found["formulas"] == {"2.1": "2.1", "2.2": ""}, "(2.7) is a reference"
    assert (found["figures"], found["tables"]) == ({"figure 2.1": ""}, {"table 2.1": ""})
    assert list(found["sections"]) == ["chapter 1", "section 1.1", "chapter 2", "section 2.1"]
    assert [bool(v) for v in found["sections"].values()] == [False, True, False, True]
    assert [v for k, v in found["sentences"].items() if "Kami" in k] == ["stable"], "across a hyphen at a line's end"
    assert [v for k, v in found["sentences"].items() if "Sistem itu" in k] == ["stable"], "the second piece"
    assert [v for k, v in found["sentences"].items() if "Satelit selalu" in k] == [""]
    assert not [k for k in found["sentences"] if "Terima" in k], "nothing is asserted there"


def test_a_common_piece_of_a_quotation_counts_only_near_its_longest_one(ledger: Path) -> None:
    again = "Sistem itu adalah sistem yang stabil. "
    found = coverage.measured(auditing.read(ledger), TEXT + again + "Kami diam saja. " * 200 + again[:-2] + " juga.")
    rows = list(found.found["sentences"].values())
    assert rows.count("stable") == 3
    assert rows[-1] == "", "a thousand signs away"


def test_the_row_with_the_longest_piece_has_a_sentence(ledger: Path) -> None:
    longer = CLAIM.replace('"stable"', '"longer"').replace("kontrol optimal dari", "Kami mencari kontrol optimal dari")
    ledger.write_text(ledger.read_text(encoding="utf-8") + longer, encoding="utf-8")
    found = coverage.measured(auditing.read(ledger), TEXT).found["sentences"]
    assert [row for name, row in found.items() if "Kami mencari" in name] == ["longer"]


def test_quotations_that_the_text_has_not_are_named(ledger: Path) -> None:
    read = auditing.read(ledger)
    assert coverage.measured(read, TEXT).unquoted == ()
    changed = coverage.measured(read, TEXT.replace("stabil", "labil"))
    assert changed.unquoted == (("stable", "adalah sistem yang stabil"),)


def test_what_is_kept_answers_without_the_text(
    ledger: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cover(capsys, ledger) == {}, "nothing is kept yet"
    kept = coverage.place(auditing.read(ledger))
    first = cover(capsys, ledger, "--text", tmp_path / "text.txt", "--keep", kept)
    assert first["same"] is None
    reasons = kept.read_text(encoding="utf-8").replace('"2.2" = ""', '"2.2" = "none: a definition of letters"')
    kept.write_text(reasons.replace('"figure 2.1" = ""', '"figure 2.1" = "2.1"'), encoding="utf-8")
    without, again = cover(capsys, ledger), cover(capsys, ledger, "--text", tmp_path / "text.txt")
    assert without == again
    assert without["missing"]["formulas"] == without["missing"]["figures"] == []  # type: ignore[index]
    assert without["counts"]["formulas"] == {"found": 2, "rows": 1, "excused": 1, "missing": 0}  # type: ignore[index]
    (tmp_path / "text.txt").write_text(TEXT + "Tabel 2.2 Lagi\n", encoding="utf-8")
    kept.write_text(kept.read_text(encoding="utf-8").replace('"2.1" = "2.1"', '"2.1" = "2.11"'), encoding="utf-8")
    assert cover(capsys, ledger)["missing"]["formulas"] == ["2.1"], "of a row that is gone"  # type: ignore[index]
    other = cover(capsys, ledger, "--text", tmp_path / "text.txt")
    assert other["same"] is False
    assert other["missing"]["tables"] == ["table 2.1", "table 2.2"]  # type: ignore[index]
    assert main(["audit", str(ledger), "--coverage", "--text", str(tmp_path / "text.txt")]) == 0
    printed = capsys.readouterr().out
    assert "another text" in printed
    assert "no row: tables: table 2.2" in printed


@pytest.mark.parametrize(
    ("kept", "reason"),
    [
        ('text_digest = ""\n[pictures]\n', ":2: pictures: unknown key"),
        ('text_digest = ""\n\n[figures]\n"figure 2.1" = 3\n', ":3: figures: got"),
        ("[figures]\n", "text_digest: missing"),
    ],
)
def test_what_is_kept_wrongly_is_refused_by_its_line(
    ledger: Path, capsys: pytest.CaptureFixture[str], kept: str, reason: str
) -> None:
    place = coverage.place(auditing.read(ledger))
    place.write_text(kept, encoding="utf-8")
    assert main(["audit", str(ledger), "--coverage"]) == 3
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert place.name in error
    assert reason in error


@pytest.mark.parametrize(
    "arguments", [["--text", "text.txt"], ["--coverage", "--keep", "x"], ["--coverage", "--text", "none.txt"]]
)
def test_options_that_do_not_go_together_are_3(
    ledger: Path, capsys: pytest.CaptureFixture[str], arguments: list[str]
) -> None:
    assert main(["audit", str(ledger), *arguments]) == 3
    assert capsys.readouterr().err.count("--text") >= 1


@pytest.mark.parametrize("document", [path.name for path in auditing.shipped()])
def test_what_the_texts_of_shipped_documents_have_is_kept(document: str) -> None:
    kept = coverage.kept(auditing.read(auditing.locate(document)))
    assert kept is not None
    assert len(kept.digest) == 64
    assert {kind: kept.missing(kind) for kind in ("figures", "tables")} == {"figures": [], "tables": []}
    if document.startswith("its_"):
        assert {kind: kept.missing(kind) for kind in coverage.KINDS} == {kind: [] for kind in coverage.KINDS}
