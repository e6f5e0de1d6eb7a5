"""Phrases of a derivation file are translated in it or beside it; what it says of itself goes first."""

from __future__ import annotations

from pathlib import Path

import pytest

from satsym.status import BadInput
from satsym.symbolic import Model, loader
from satsym.symbolic.model import translated

FILE = """
from satsym.symbolic import FirstOrder, Variable, symbols_of

q, v = Variable("q", "q", meaning="position"), Variable("v", "v", meaning="velocity")
PROBLEMS = (
    FirstOrder(
        name="drifting", title="Drifting", states=(q, v), controls=(), parameters=(),
        rates=dict(zip(symbols_of((q, v)), (symbols_of((v,))[0], 0), strict=True)),
    ),
)
"""


def stated(folder: Path, more: str = "", **beside: str) -> Model:
    """The model of a derivation file, with files of these names beside it."""
    for name, text in beside.items():
        (folder / f"drifting.{name}.toml").write_text(text, encoding="utf-8")
    path = folder / "drifting.py"
    path.write_text(FILE + more, encoding="utf-8")
    (found,) = loader.load(path)
    assert isinstance(found, Model)
    return found


def test_a_file_beside_it_translates_a_derivation_file(tmp_path: Path) -> None:
    found = stated(tmp_path, id='"position" = "posisi"\n"velocity" = "laju"\n', nl='"position" = "plaats"\n')
    assert translated(found, "id") == {"position": "posisi", "velocity": "laju"}
    assert translated(found, "nl") == {"position": "plaats"}
    assert translated(found, "fr") == {}


def test_what_the_file_says_itself_goes_first(tmp_path: Path) -> None:
    own = 'TRANSLATIONS = {"id": {"velocity": "kecepatan"}, "fr": {"velocity": "vitesse"}}\n'
    found = stated(tmp_path, own, id='"position" = "posisi"\n"velocity" = "laju"\n')
    assert translated(found, "id") == {"position": "posisi", "velocity": "kecepatan"}
    assert translated(found, "fr") == {"velocity": "vitesse"}


def test_other_files_beside_it_are_left_alone(tmp_path: Path) -> None:
    assert translated(stated(tmp_path, ledger="no translation at all"), "ledger") == {}


def test_a_translation_that_has_changed_is_read_again(tmp_path: Path) -> None:
    stated(tmp_path, id='"velocity" = "laju"\n')
    assert translated(stated(tmp_path, id='"velocity" = "kecepatan"\n'), "id") == {"velocity": "kecepatan"}


@pytest.mark.parametrize(
    ("text", "said"), [("velocity kecepatan", "drifting.id.toml: "), ("[phrases]\na = 1", "phrases: not a text")]
)
def test_what_is_no_translation_is_refused_in_a_line(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(BadInput, match=said) as refusal:
        stated(tmp_path, id=text)
    assert "\n" not in str(refusal.value)
