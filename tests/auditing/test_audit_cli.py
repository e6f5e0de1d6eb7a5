"""`satsym audit` as its users meet it: ledgers good and bad, what is printed, and what is kept."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from satsym import auditing
from satsym.auditing import cache, run
from satsym.cli import main
from tests.support.ledgers import HAMILTONIAN, HEAD, TANGENTIAL, row, text, write

Run = Callable[..., tuple[int, str, str]]
KEYS = "document item part kind role printed derived verdict cause weight diagnosis evidence".split()
GOOD = row("1", "d_x4 = (u2 - 2*x2*x4)/x1", TANGENTIAL, says="rate of x4", where="section 1")
SLIP = row("2", "d_x4 = -(2*x2*x4 + u2)/x1", TANGENTIAL, part="again", says="the same", where="section 2")
NUMBER = row("table 1", "35786 km", "altitude", "number")
MATRIX = row("3", [["0", "0"], ["1", "0"], ["0", "0"], ["0", "x1"]], "polar_orbit:linearisation.B", "matrix")
needs_tex = pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no pdflatex to compile with")


@pytest.fixture
def audited(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Exit code, stdout and stderr of `satsym audit`, with a cache of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("SATSYM_DEBUG", raising=False)

    def run_audit(*arguments: str | Path) -> tuple[int, str, str]:
        code = main(["audit", *map(str, arguments)])
        return code, *capsys.readouterr()

    return run_audit


def complaint(error: str) -> str:
    """The one line that was said."""
    assert error.startswith("satsym: ")
    assert error.count("\n") == 1
    return error


# What is printed


def test_json_has_the_rows_and_how_many_of_each_verdict(audited: Run, tmp_path: Path) -> None:
    code, out, err = audited(write(tmp_path, [GOOD, SLIP, NUMBER, MATRIX]), "--json")
    found = json.loads(out)
    assert (code, err, list(found)) == (0, "", ["rows", "findings", "counts"])
    assert all(list(entry) == KEYS for entry in found["rows"])
    assert found["counts"] == {"confirmed": 2, "misprint": 2}
    assert [entry["item"] for entry in found["rows"]] == ["1", "2", "table 1", "3"]
    assert [entry["printed"] for entry in found["rows"]][2:] == ["35786 km", MATRIX["printed"]]
    assert found["rows"][1]["diagnosis"].startswith(
        "The sign of `u2` is reversed. The document has the right form in 1."
    )


def test_what_is_right_is_said_first(audited: Run, tmp_path: Path) -> None:
    code, out, err = audited(write(tmp_path, [SLIP, GOOD]))
    assert (code, err) == (0, "")
    assert out.startswith("small: A small document (A. Writer, 2024)\n")
    assert (
        out.index("checked, one is confirmed") < out.index("Slips without consequence") < out.rindex("The sign of `u2`")
    )
    assert "1. 2 again: The sign of `u2` is reversed." in out
    assert (
        "2 again: misprint (section 2), printed d_x4 = -(2*x2*x4 + u2)/x1"
        in audited(tmp_path / "small.toml", "--rows")[1]
    )


def test_a_page_is_written_whole_and_in_the_language_asked_for(audited: Run, tmp_path: Path) -> None:
    path, page = write(tmp_path, [GOOD, SLIP, MATRIX]), tmp_path / "page.html"
    code, out, _ = audited(path, "--html", page, "--lang", "id")
    written = page.read_text(encoding="utf-8")
    assert code == 0
    assert "Kekeliruan tanpa akibat" in out
    assert written.startswith('<!doctype html>\n<html lang="id">')
    assert 'href="#polar_orbit:first_order.theta_dot"' in written
    assert 'id="polar_orbit:first_order.theta_dot"' in written


def test_nothing_to_correct_is_said_too(audited: Run, tmp_path: Path) -> None:
    code, out, _ = audited(write(tmp_path, [GOOD]))
    assert code == 0
    assert "There is nothing to correct." in out


def test_one_item_is_judged_as_among_all(audited: Run, tmp_path: Path) -> None:
    path = write(tmp_path, [GOOD, SLIP, NUMBER, MATRIX])
    whole = {entry["item"]: entry for entry in json.loads(audited(path, "--json")[1])["rows"]}
    for arguments in (["--item", "2"], ["--item", "2 again"]):
        alone = json.loads(audited(path, "--json", *arguments)[1])
        assert alone["rows"] == [whole["2"]]
    assert "--item" in whole["2"]["evidence"]


def test_the_command_that_is_printed_recomputes_the_row(audited: Run, tmp_path: Path) -> None:
    import shlex

    path = write(tmp_path, [GOOD, SLIP])
    entry = json.loads(audited(path, "--json")[1])["rows"][1]
    program, command, *arguments = shlex.split(entry["evidence"])
    assert (program, command) == ("satsym", "audit")
    assert json.loads(audited(*arguments, "--json")[1])["rows"] == [entry]


def test_coverage_lists_the_numbers_without_a_row(audited: Run, tmp_path: Path) -> None:
    path = write(tmp_path, [GOOD])
    assert audited(path, "--coverage") == (0, "small: 1 of 2 numbers have no row: 2\n", "")
    expected = {"document": "small", "numbers": 2, "rows": 1, "missing": ["2"]}
    assert json.loads(audited(path, "--coverage", "--json")[1]) == {"coverage": [expected]}
    whole = write(tmp_path, [GOOD, SLIP])
    assert audited(whole, "--coverage")[1] == "small: each of its 2 numbers has a row (2 rows)\n"


def test_output_is_the_same_every_time_and_from_the_cache(
    audited: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path, [GOOD, SLIP, MATRIX])
    first = audited(path, "--json")
    assert audited(path, "--json", "--fresh") == first
    monkeypatch.setattr(run, "audit", lambda *_: pytest.fail("judged again"))
    monkeypatch.setattr(cache, "judge", lambda *_: pytest.fail("judged again"))
    assert audited(path, "--json") == first


def test_a_changed_ledger_or_a_damaged_cache_is_judged_anew(audited: Run, tmp_path: Path) -> None:
    path = write(tmp_path, [SLIP])
    assert json.loads(audited(path, "--json")[1])["counts"] == {"misprint": 1}
    for kept in (tmp_path / "cache").rglob("*.json"):
        kept.write_bytes(b'[{"verdict": 7')
    assert json.loads(audited(path, "--json")[1])["counts"] == {"misprint": 1}
    write(tmp_path, [GOOD])
    assert json.loads(audited(path, "--json")[1])["counts"] == {"confirmed": 1}


def test_a_cache_that_cannot_be_written_is_no_error(audited: Run, tmp_path: Path) -> None:
    (tmp_path / "cache").write_text("a file, not a folder", encoding="utf-8")
    assert audited(write(tmp_path, [GOOD]))[0] == 0


@needs_tex
def test_the_report_compiles(audited: Run, tmp_path: Path) -> None:
    odd = row("5 % & $ # _ ~ ^ \\", "stable('saddle')", "", "claim", original="x_2 is 100 %, {it} says: \\input{x}")
    long = row("H", HAMILTONIAN.replace("u1)", "u2)"), "polar_orbit:hamiltonian.H")
    path = write(tmp_path, [GOOD, SLIP, MATRIX, long, odd, row("torn", "", "", legible=False)])
    assert audited(path, "--latex", tmp_path / "report.tex")[0] == 0
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "report.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    log = done.stdout.decode("utf-8", "replace")
    assert done.returncode == 0, log
    assert "Overfull" not in log, re.findall(r"Overfull.*", log)
    source = (tmp_path / "report.tex").read_text(encoding="utf-8")
    assert r"\dot{x}_{4} = -\frac{2 x_{2} x_{4} + u_{2}}{x_{1}}" in source
    assert r"\input{x}" not in source


# Bad ledgers


BAD = {
    "syntax of TOML": ("format = = 1", "not valid TOML"),
    "no format": ("[document]\nkey = 'x'\ntitle = ''", "format: got"),
    "unknown table": (text([GOOD]) + "\n[rows]\n", "rows: unknown key"),
    "no rows": (HEAD, "the ledger has no rows"),
    "unknown key": (text([{**GOOD, "verdict": "confirmed"}]), "verdict: unknown key"),
    "wrong type": (text([{**GOOD, "says": 3}]), "says: got 3"),
    "unknown kind": (text([{**GOOD, "kind": "formula"}]), 'kind: got "formula"'),
    "twice the same": (text([GOOD, GOOD]), "another row has the same name"),
    "nothing to hold against": (text([{**GOOD, "holds": ""}]), "holds: missing"),
    "syntax": (text([row("1", "d_x4 = (u2 - ", TANGENTIAL)]), "is not a formula"),
    "unknown symbol": (text([row("1", "d_x4 = u3/x1", TANGENTIAL)]), '"u3" is not a symbol of [scope.main]'),
    "unknown scope": (text([{**GOOD, "scope": "other"}]), 'no scope "other"'),
    "unknown name of ours": (text([GOOD], HEAD + 'x9 = "r_dott"\n'), 'no derivation defines the name "r_dott"'),
    "unknown model": (text([row("1", "u2", "polar_orbits:first_order.r")]), 'there is no derivation "polar_orbits"'),
    "unknown row": (text([{**GOOD, "from": "row['4.1']"}]), 'there is no row "4.1" with a formula'),
    "follows from itself": (text([{**GOOD, "from": "row['1']"}]), "cannot follow from itself"),
    "unknown function": (text([row("1", "u2", "eval('1')")]), 'the function "eval" is unknown'),
    "unknown measurement": (text([row("1", "u2", "eval('1') == 1")]), 'the measurement "eval" is unknown'),
    "import": (text([row("1", "__import__('os').system('true')", TANGENTIAL)]), "not allowed"),
    "attribute": (text([row("1", "x1.__class__", TANGENTIAL)]), "attribute"),
    "tower of powers": (text([row("1", "9**9**9", TANGENTIAL)]), "exponent"),
    "nested brackets": (text([row("1", "(" * 10_000 + "x1" + ")" * 10_000, TANGENTIAL)]), "longer than 4000"),
    "nested brackets, few": (text([row("1", "(" * 1500 + "x1" + ")" * 1500, TANGENTIAL)]), "nested"),
    "nested lists": ("x = " + "[" * 10_000, "nested too deeply"),
    "TeX in a name": (text([GOOD], HEAD + '"\\\\theta" = "theta"\n'), "without TeX"),
    "TeX in a formula": (text([row("1", "\\\\frac{1}{2}", TANGENTIAL)]), "not allowed here"),
    "circle of scopes": (
        text([GOOD], HEAD + '[scope.a]\nextends = "b"\n[scope.b]\nextends = "a"\n'),
        "refers back to itself",
    ),
    "not an address": (text([row("1", "u2", "at('polar_orbit')")]), "is not an address"),
    "not a number": (text([row("1", "many km", "altitude", "number")]), "not a number"),
    "unknown input": (text([row("1", "5 km", "altitud", "number")]), "neither in [inputs]"),
    "matrix of texts": (text([row("1", [["1", "2"], ["3"]], TANGENTIAL, "matrix")]), "must have the same length"),
    "attack in from": (text([{**GOOD, "from": "row['1'].__class__"}]), "attribute"),
    "attack in a claim": (text([row("1", "rank(__import__('os')) == 1", "", "claim")]), "unknown"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_ledger_is_3_with_line_and_reason_at_once(audited: Run, tmp_path: Path, name: str) -> None:
    content, reason = BAD[name]
    path = tmp_path / "bad.toml"
    path.write_text(content, encoding="utf-8")
    begun = time.thread_time()
    code, out, err = audited(path, "--json")
    assert time.thread_time() - begun < 1
    assert (code, out) == (3, "")
    assert reason in complaint(err)
    assert re.search(r"bad\.toml:\d+: |bad\.toml: ", err)
    assert len(err) < 600


def test_the_line_is_that_of_the_key(audited: Run, tmp_path: Path) -> None:
    path = write(tmp_path, [GOOD, row("2", "d_x4 = u3/x1", TANGENTIAL, says="[[row]] = no header")])
    line = next(i for i, entry in enumerate(path.read_text().splitlines(), start=1) if "u3" in entry)
    assert f"small.toml:{line}: row 2: printed: " in audited(path)[2]


def test_bad_ledgers_are_refused_before_sympy_is_loaded(tmp_path: Path) -> None:
    path = write(tmp_path, [GOOD, NUMBER, row("2", "d_x4 = u3/x1", TANGENTIAL)])
    code = (
        f"import sys; from satsym.cli import main; code = main(['audit', {str(path)!r}]); "
        "print(code, *sorted({'sympy', 'pint', 'scipy', 'numpy'} & set(sys.modules)))"
    )
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False)
    assert done.stdout == "3\n", done.stderr


def test_what_only_the_derivation_knows_is_refused_with_its_line(audited: Run, tmp_path: Path) -> None:
    path = write(tmp_path, [GOOD, row("2", "u2", "polar_orbit:first_order.thetas")])
    code, out, err = audited(path)
    assert (code, out) == (3, "")
    assert 'row 2: holds: "polar_orbit:first_order.thetas": the step has no "thetas"' in complaint(err)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["its_thesys"], 'did you mean "its_thesis"'),
        (["nowhere/ledger.toml"], "neither a ledger nor a file"),
        (["its_thesis", "--item", "99.99"], 'no row "99.99"'),
    ],
)
def test_unknown_ledgers_and_items_are_3(audited: Run, arguments: list[str], reason: str) -> None:
    code, out, err = audited(*arguments)
    assert (code, out) == (3, "")
    assert reason in complaint(err)


def test_shipped_ledgers_read_and_cover_every_number() -> None:
    shipped = auditing.shipped()
    assert {path.name for path in shipped} >= {"its_thesis", "its_paper"}
    for path in shipped:
        read = auditing.read(path)
        assert read.document.key == path.name
        if path.name.startswith("its_"):
            assert read.uncovered() == []
