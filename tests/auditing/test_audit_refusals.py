"""A ledger that asks a predicate for what is not there is refused in one line that names the row, never a traceback."""

from __future__ import annotations

from pathlib import Path

import pytest

from satsym.cli import main
from tests.support import ledger_fuzz
from tests.support.ledgers import whole


def ledger(folder: Path, printed: str, holds: str, left_out: str) -> Path:
    """The notation and the numbers of lapan_pitch, without one of them, and a single row."""
    pitch = whole("lapan_pitch")
    head = "\n".join(line for line in pitch[: pitch.index("[[row]]")].splitlines() if line != left_out)
    path = folder / "ledger.toml"
    row = f'item = "13"\nkind = "claim"\nwhere = "here"\nsays = "so"\nprinted = "{printed}"\nholds = "{holds}"\n'
    path.write_text(f"{head}\n[[row]]\n{row}", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("printed", "holds", "left_out", "complaint"),
    [
        ("3*foo*E", "largest_torque()", "", 'no number for "foo"'),
        ("3*P_c", "wheel_stays(law='classical', share='0.1')", 'E = "0.01 1/s"', 'no number in [inputs] called "E"'),
        ("3*P_c", "wheel_stays(law='classical', share='abc')", "", '"abc" is no number'),
        ("3*P_c", "wave_arrives(rate='abc')", "", '"abc" is no number'),
        ("3*P_c", "costate_solves(rate='99', solution='13')", "", 'no row called "99"'),
        ("3*P_c", "is_integral(rate='13', speed='13')", "", 'the letter "delta" does not stand there'),
        ("3*P_c", "setting_to_zero_maximises(hamiltonian='13')", "", 'the letter "U" does not stand there'),
        ("3*P_c", "starts_from(program='13', rates='f')", "", 'no row "13" prints a program'),
        ("3*P_c", "leaves_its_orbit(name='double-integrator-time')", "", "is no motion about a centre"),
        ("3*P_c", "derivative_is(model='two_body')", "", "print v_dot, then r, r_dot or v, then a formula"),
        ("3*P_c", "has_equilibrium(model='nope')", "", 'no derivation "nope"'),
    ],
)
def test_what_is_not_there_is_told_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], printed: str, holds: str, left_out: str, complaint: str
) -> None:
    assert main(["audit", str(ledger(tmp_path, printed, holds, left_out))]) == 3
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert complaint in line
    assert "row 13" in line


def test_a_rank_without_a_value_is_told_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "ledger.toml"
    path.write_text(ledger_fuzz.ledger(74), encoding="utf-8")
    assert main(["audit", str(path)]) == 3
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert "row 1: no point at which max(theta," in line


ROW = 'item = "{}"\nkind = "claim"\nwhere = "here"\nsays = "so"\nprinted = "x"\nholds = "{}"\n'


@pytest.mark.parametrize(
    ("chapter", "complaint"),
    [
        ("[[row]]\n" + ROW.format("2", "nothing()"), "ledger_2.toml:7: row 2: holds: "),
        ("[[row]]\n" + ROW.format("1", "illegible()"), "ledger_2.toml:2: row 1: item: there is another row"),
        ("\n[symbols]\nx = 'm'\n", "ledger_2.toml:2: symbols: not in a chapter; put it in ledger.toml"),
        ("", "ledger_2.toml:1: row: no rows"),
        ("row = 1", "ledger_2.toml:1: row: no rows"),
        ("[[row", "ledger_2.toml: "),
    ],
)
def test_what_is_wrong_with_a_chapter_is_told_with_its_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], chapter: str, complaint: str
) -> None:
    pitch = whole("lapan_pitch")
    rows = "".join(f"[[row]]\nlegible = false\n{ROW.format(item, '')}" for item in ("13", "1"))
    (tmp_path / "ledger.toml").write_text(pitch[: pitch.index("[[row]]")] + rows, encoding="utf-8")
    (tmp_path / "ledger_2.toml").write_text(chapter, encoding="utf-8")
    assert main(["audit", str(tmp_path)]) == 3
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert complaint in line


def test_a_folder_without_a_head_is_no_ledger(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["audit", str(tmp_path)]) == 3
    assert "no ledger.toml in this folder" in capsys.readouterr().err
