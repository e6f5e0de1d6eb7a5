"""A ledger that asks for what is not there is refused in one line that names the row, never a traceback."""

from __future__ import annotations

from pathlib import Path

import pytest

from satsym.cli import main
from tests.support import ledger_fuzz
from tests.support.ledgers import whole


def ledger(folder: Path, printed: str) -> Path:
    """The notation of lapan_pitch and a single claim."""
    pitch = whole("lapan_pitch")
    path = folder / "ledger.toml"
    row = f'item = "13"\nkind = "claim"\nwhere = "here"\noriginal = "so"\nprinted = "{printed}"\nfrom = []\n'
    path.write_text(f"{pitch[: pitch.index('[[row]]')]}\n[[row]]\n{row}", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("printed", "complaint"),
    [
        ("foo == 1", '"foo" is unknown here'),
        ("valued(theta*I_y, 'lapan-classical') == 1", 'no numerical value for "theta"'),
        ("valued(I_y, 'double-integrator-time') == 1", "gives no damping in a table [classical]"),
        ("valued(I_y, 'nope') == 1", "nope"),
        ("switched('lapan-classical').heat > 0", "give the torque, or the duration"),
        ("switched('lapan-classical', duration=100).weight > 0", 'has no "weight"'),
        ("diff(I_y, theta + 1) == 0", "is not a symbol"),
        ("len(text['99']) > 0", 'no row "99"'),
        ("orbit('double-integrator-time').energy < 0", "is not a motion about a centre"),
        ("rates_at('nope', [1]) == 0", "nope"),
        ("unit_in('x') == 1", "has no unit in brackets"),
    ],
)
def test_what_is_not_there_is_told_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], printed: str, complaint: str
) -> None:
    assert main(["audit", str(ledger(tmp_path, printed))]) == 3
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert complaint in line
    assert "row 13" in line


def test_a_rank_without_a_value_is_told_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "ledger.toml"
    path.write_text(ledger_fuzz.ledger(74), encoding="utf-8")
    assert main(["audit", str(path)]) == 3
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert "row 1: no point at which max(theta," in line


ROW = 'item = "{}"\nkind = "claim"\nwhere = "here"\nfrom = []\noriginal = "so"\nprinted = "{}"\n'


@pytest.mark.parametrize(
    ("chapter", "complaint"),
    [
        ("[[row]]\n" + ROW.format("2", "nothing()"), "ledger_2.toml:7: row 2: printed: "),
        ("[[row]]\n" + ROW.format("1", "1 == 1"), "ledger_2.toml:2: row 1: item: another row has the same name"),
        ("\n[symbols]\nx = 'm'\n", "ledger_2.toml:2: symbols: this table is not allowed in a chapter; put it in "),
        ("", "ledger_2.toml:1: row: the ledger has no rows"),
        ("row = 1", "ledger_2.toml:1: row: the ledger has no rows"),
        ("[[row", "ledger_2.toml: "),
    ],
)
def test_what_is_wrong_with_a_chapter_is_told_with_its_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], chapter: str, complaint: str
) -> None:
    pitch = whole("lapan_pitch")
    rows = "".join(f"[[row]]\nlegible = false\n{ROW.format(item, '1 == 1')}" for item in ("13", "1"))
    (tmp_path / "ledger.toml").write_text(pitch[: pitch.index("[[row]]")] + rows, encoding="utf-8")
    (tmp_path / "ledger_2.toml").write_text(chapter, encoding="utf-8")
    assert main(["audit", str(tmp_path)]) == 3
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert complaint in line


def test_a_folder_without_a_head_is_no_ledger(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["audit", str(tmp_path)]) == 3
    assert "this folder has no ledger.toml" in capsys.readouterr().err
