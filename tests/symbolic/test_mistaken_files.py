"""Derivation files with mistakes get one line that says where and what, and nothing else ever."""

from __future__ import annotations

from pathlib import Path

import pytest

from satsym.report import artefacts
from satsym.status import BadInput
from satsym.symbolic import loader
from tests.support.model_mutations import SMALL, mutated, sound


def complaint(folder: Path, text: str, seconds: float = 20.0) -> str:
    """The line that a file is refused with, without its folder; empty where it is derived."""
    path = folder / "mine.py"
    path.write_text(text, encoding="utf-8")
    try:
        artefacts.render([path], folder, max_seconds=seconds)
    except BadInput as error:
        said = str(error)
        assert said.isprintable()
        assert len(said) < 700
        assert said.startswith((f"{path}:", "mine", "walk", "stroll")), said
        return said.replace(f"{folder}/", "")
    return ""


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        (
            "running_cost=",
            "runing_cost=",
            "mine.py:12: Problem has no field 'runing_cost'; did you mean \"running_cost\"?",
        ),
        ("rates=", "rate=", "mine.py:9: FirstOrder has no field 'rate'; did you mean \"rates\"?"),
        ("positive=True", "postive=True", "mine.py:6: Variable has no field 'postive'; did you mean \"positive\"?"),
        (
            "c * speed**2",
            "c * speed^2",
            "mine.py:12: write powers with **, as in x**3; ^ is not the power operator in Python",
        ),
        (", model=walk", "", "mine.py:12: Problem needs 'model'; its fields are name, title, model, "),
        (
            '"speed"),)',
            '"speed", 1, "real", 1, (1, 2), 3),)',
            "Variable was given more values than it has fields; its positional",
        ),
        ("import FirstOrder,", "import FirstOder,", "satsym.symbolic has no 'FirstOder'; did you mean \"FirstOrder\"?"),
        ("import FirstOrder,", "import", "mine.py:8: 'FirstOrder' is not defined; write `from satsym.symbolic import"),
        ("c * speed**2", "c * sped**2", "mine.py:12: 'sped' is not defined; did you mean \"speed\"?"),
        ("from satsym.symbolic", "from satsym.symbolics", "there is no satsym.symbolics; write `from satsym.symbolic"),
        ('"m/s"', '"m/ss"', 'stroll: speed: unit "ss" is unknown'),
        (
            "rates={place: speed}",
            "rates={c: speed}",
            "give one rate for each state; without a rate: place; no state: c",
        ),
        (
            "c * speed**2",
            "c * speed**2 + abs(place)",
            "mine.py:12: stroll: the running cost contains Abs(place), whose derivatives jump; use a smooth",
        ),
        (
            "rates={place: speed}",
            "rates={place: abs(speed)}",
            'Abs(speed) in the equations of motion is supported only with control_set = "box", and only if the cost',
        ),
        (
            "terminal_cost=place**2",
            "terminal_cost=place**2 + abs(place)",
            "the terminal cost contains Abs(place)",
        ),
        ('"speed", "v"', '"speed up", "v"', "mine.py:5: variable 'speed up': use a letter, then letters"),
        (
            "1.0, positive=True",
            "1.0, typical=(1.0, 0.1)",
            "mine.py:6: variable 'c': got the typical range (1.0, 0.1); give two numbers, low < high",
        ),
        (
            "1.0, positive=True",
            "1.0, typical=(1.0, 2.0, 3.0)",
            "mine.py:6: variable 'c': got the typical range (1.0, 2.0, 3.0); give two numbers, low < high",
        ),
        (
            '"place", "s"',
            '"place", "S"',
            "mine.py:12: stroll: the LaTeX of 'place', S, is reserved for a derived quantity; choose another",
        ),
        ('"c", "c"', '"c", "{H}"', "stroll: the LaTeX of 'c', {H}, is reserved for"),
        ('"speed", "v"', '"speed", r"\\lambda_s"', "the LaTeX of 'speed', \\lambda_s, is reserved for"),
        ("rates={place: speed}", 'rates={place: int("speed")}', "mine.py:9: ValueError: invalid literal for int()"),
        ("(speed,), (c,) =", "(speed,) (c,) =", "mine.py:7: SyntaxError: cannot assign to function call"),
    ],
)
def test_a_mistake_is_named_with_its_line_and_what_was_meant(tmp_path: Path, right: str, wrong: str, said: str) -> None:
    assert SMALL.count(right) == 1
    assert said in complaint(tmp_path, SMALL.replace(right, wrong))


def test_the_files_that_mistakes_are_made_in_are_sound(tmp_path: Path) -> None:
    assert complaint(tmp_path, SMALL) == ""
    for k, text in enumerate(sound()):
        (tmp_path / f"sound_{k}.py").write_text(text, encoding="utf-8")
        assert loader.load(tmp_path / f"sound_{k}.py")


def test_mistakes_in_a_small_file_are_refused_or_harmless(tmp_path: Path) -> None:
    said = [complaint(tmp_path, mutated(SMALL, seed)) for seed in range(60)]
    assert 40 < sum(map(bool, said)) < 60


@pytest.mark.study
@pytest.mark.parametrize("first", range(0, 300, 30))
def test_mistakes_in_real_files_are_refused_or_harmless(tmp_path: Path, first: int) -> None:
    texts = sound()
    said = [complaint(tmp_path, mutated(texts[seed % len(texts)], seed), 120.0) for seed in range(first, first + 30)]
    assert sum(map(bool, said)) > 15
