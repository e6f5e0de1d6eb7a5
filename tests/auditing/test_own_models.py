"""Ledgers of any model: own ones after `satsym derive --out`, examples, every declared name; no model is executed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from satsym import auditing
from satsym.auditing import audit
from satsym.cli import main
from satsym.records import record, shelf
from satsym.status import BadInput
from satsym.symbolic.lookup import library
from satsym.symbolic.lookup.addresses import recorded
from tests.support.ledgers import row, text

OWN = """
from sympy import symbols
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = (Variable("q", "q", "m"), Variable("v", "v", "m/s"))
CONTROLS = (Variable("a", "a", "m/s**2"),)
PARAMETERS = (Variable("k", "k", "1/m", default=0.1, positive=True),)
q, v = symbols_of(STATES)
(a,) = symbols_of(CONTROLS)
(k,) = symbols_of(PARAMETERS)
UNUSED = 1 / OPEN
sled_motion = FirstOrder(
    name="sled_motion", title="A sled with drag", states=STATES, controls=CONTROLS, parameters=PARAMETERS,
    rates={q: v, v: a - k * v**2},
)
PROBLEMS = (Problem(name="sled", title="Pushing a sled", model=sled_motion, running_cost=a**2 / 2),)
"""
HEAD = """
format = 1
[document]
key = "own"
title = "A document of one's own"
model = "made/sled"

[scope.main]
q = "q"
v = "v"
a = "a"
k = "k"
p1 = "lambda_q"
p2 = "lambda_v"
H = "H"
d_p2 = "d_lambda_v"
d_v = "d_v"
L = "at('sled:declared.L')"
"""
ROWS = [
    row("1", "d_v = a - k*v**2", "sled:first_order.v"),
    row("2", "d_p2 = 2*k*p2*v - p1", "sled:costate_equations.v"),
    row("3", "d_p2 = 2*k*p2*v + p1", "sled:costate_equations.v"),
    row("4", "L = a**2/2", "sled:declared.L"),
    row("5", "v*d_v", "d(v**2/2)"),
]


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a derived model, whose file cannot be executed again."""
    monkeypatch.chdir(tmp_path)
    source = tmp_path / "sled.py"
    source.write_text(OWN.replace("1 / OPEN", "1"))
    assert main(["derive", "sled.py", "--out", "made"]) == 0
    return tmp_path


def test_a_model_of_ones_own_is_audited_without_its_file(own: Path) -> None:
    (own / "sled.py").unlink()
    path = own / "ledger.toml"
    path.write_text(text(ROWS, HEAD))
    found = {entry.key: entry.verdict for entry in audit(auditing.read(path))}
    assert found["1"] == found["2"] == found["4"] == found["5"] == "confirmed"
    assert found["3"] in ("misprint", "wrong")


def test_a_page_and_a_remark_on_drafts_for_a_model_of_ones_own(own: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, page = own / "ledger.toml", own / "page.html"
    path.write_text(text([*ROWS[:2], {**ROWS[2], "draft": True}], HEAD))
    assert main(["audit", str(path), "--html", str(page)]) == 0
    assert "1 ledger row is a draft that has not been confirmed" in capsys.readouterr().out
    assert 'id="sled:first_order.v"' in page.read_text()


def test_a_record_older_than_its_model_is_refused(own: Path) -> None:
    (own / "sled.py").write_text(OWN.replace("1 / OPEN", "2"))
    path = own / "ledger.toml"
    path.write_text(text(ROWS[:1], HEAD))
    with pytest.raises(BadInput, match=r"is older than \.\./sled\.py; run satsym derive"):
        auditing.read(path)


@pytest.mark.parametrize(
    ("model", "reason"),
    [
        ("made/nope", "no derivation"),
        ("made/../sled:1", "is not a model"),
        ("nowhere/sled", "no derivation"),
        ("made/\\u0000", "is not a model"),
    ],
)
def test_a_model_that_is_not_there_is_told_in_one_line(own: Path, model: str, reason: str) -> None:
    path = own / "ledger.toml"
    path.write_text(text(ROWS[:1], HEAD.replace("made/sled", model)))
    with pytest.raises(BadInput, match=reason) as caught:
        auditing.read(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("content", ["", "{", "[]", '{"format": 1}', '{"format": "x"}', "\x00"])
def test_a_file_that_is_no_record_is_told_in_one_line(own: Path, content: str) -> None:
    (own / "made" / "sled.derivation.json").write_text(content)
    path = own / "ledger.toml"
    path.write_text(text(ROWS[:1], HEAD))
    with pytest.raises(BadInput, match="not the record of a derivation") as caught:
        auditing.read(path)
    assert "\n" not in str(caught.value)


def test_examples_are_audited(tmp_path: Path) -> None:
    head = '\nformat = 1\n[document]\nkey = "own"\ntitle = "t"\nmodel = "goddard"\n[scope.main]\nv = "v"\nd_h = "d_h"\n'
    path = tmp_path / "ledger.toml"
    path.write_text(text([row("1", "d_h = v", "goddard:first_order.h")], head))
    assert [entry.verdict for entry in audit(auditing.read(path))] == ["confirmed"]


def test_every_declared_name_is_an_address() -> None:
    found = shelf.find("hill")
    names = [name for name, entry in found.names.items() if entry.kind in ("state", "control", "parameter", "output")]
    assert "u3" in names
    for name in names:
        record.look_up(found, f"hill:declared.{name}")


@pytest.mark.parametrize("model", ["hill", "polar_orbit", "pitch_minimum_time", "transfer_fuel"])
def test_records_say_what_is_derived(model: str) -> None:
    derived = library.derivation(model)
    kept = shelf.find(model)
    anew = recorded(derived, "derivations/x.py")
    assert (anew.names, anew.definitions, anew.declared, anew.steps) == (
        kept.names,
        kept.definitions,
        kept.declared,
        kept.steps,
    )
    assert record.from_text(record.text_of(kept)) == kept
    assert json.loads(record.text_of(kept))["name"] == model
