"""Each docstring is a sentence that can be understood out of its place, also where others quote it alone."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

DANGLING = re.compile(r"(The same|Of|That|Those|These)\b")
"""Beginnings of docstrings that speak of something which only their surroundings name."""

VERBLESS = re.compile(
    r"(What|Whether|How|Where|Which|When|Why|Likewise|It|Its|One|As|By|For|The|An?|All|Each|Everything)\b"
)
"""Beginnings of docstrings of functions that name something instead of saying what the function does."""

NAMING = ("auditing", "solvers")
"""Rooms in which docstrings of functions may name what is returned, as that of a measurement does."""

BARE = frozenset(
    "AGAIN ALIKE ALONE APART ASIDE BEYOND CLEAR CLOSE EACH ENOUGH FAINT FAR FAST FEW HUGE LARGEST LEAST LONG LONGEST "
    "MANY MOST NEAR NEARLY SAME SETTLED SHORT SMALL SMALLEST STEEP SURELY TINY".split()
)
"""Names of constants that do not say what they limit, and therefore mean something else in each file."""


def docstrings(source: str) -> Iterator[tuple[int, str]]:
    """Line and text of the docstrings of modules, classes, functions, constants and fields."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            for part in node.body:
                text = part.value if isinstance(part, ast.Expr) else None
                if isinstance(text, ast.Constant) and isinstance(text.value, str):
                    yield part.lineno, text.value.strip()


def dangling(source: str) -> list[int]:
    """Lines of docstrings that cannot be understood out of their place."""
    return [line for line, text in docstrings(source) if DANGLING.match(text)]


def verbless(source: str) -> list[int]:
    """Lines of functions whose docstrings do not begin with a verb."""
    functions = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)]
    return [node.lineno for node in functions if VERBLESS.match(ast.get_docstring(node) or "")]


def bare(source: str) -> list[str]:
    """Constants of a module whose names do not say what they limit."""
    assigned = [node for node in ast.parse(source).body if isinstance(node, ast.Assign)]
    names = [n for node in assigned for target in node.targets for n in ast.walk(target) if isinstance(n, ast.Name)]
    return [name.id for name in names if name.id.strip("_") in BARE]


def test_docstrings_can_be_understood_out_of_their_place(repository: Path) -> None:
    found = {path: dangling(path.read_text("utf-8")) for path in sorted((repository / "satsym").rglob("*.py"))}
    assert [f"{path}:{line}" for path, lines in found.items() for line in lines] == []


def test_docstrings_of_functions_say_what_these_do(repository: Path) -> None:
    house = repository / "satsym"
    paths = [path for path in sorted(house.rglob("*.py")) if path.relative_to(house).parts[0] not in NAMING]
    found = {path: verbless(path.read_text("utf-8")) for path in paths}
    assert [f"{path}:{line}" for path, lines in found.items() for line in lines] == []


def test_a_docstring_without_a_verb_would_be_seen() -> None:
    assert verbless('def f():\n    """The gain."""\n\n\ndef g():\n    """Return the gain."""\n') == [1]


def test_names_of_constants_say_what_they_limit(repository: Path) -> None:
    found = {path: bare(path.read_text("utf-8")) for path in sorted((repository / "satsym").rglob("*.py"))}
    assert [f"{path}: {name}" for path, names in found.items() for name in names] == []


def test_a_bare_name_would_be_seen() -> None:
    assert bare("MOST = 3\nMOST_STEPS = 3\n_FAR, SAME_SIGN = 1, 2\n") == ["MOST", "_FAR"]


@pytest.mark.parametrize(
    "source",
    [
        '"""Of a model."""',
        'class A:\n    """The same as text."""',
        'def f():\n    """That of a problem."""',
        'MOST = 3\n"""Of steps."""',
        'class A:\n    """A motion."""\n\n    x: int\n    """Those at the start."""',
    ],
)
def test_a_docstring_that_needs_its_surroundings_would_be_seen(source: str) -> None:
    assert len(dangling(source)) == 1


@pytest.mark.parametrize(
    "source", ['"""Office hours."""', 'x = "Of it"', '"""Thatched roofs."""', '"""Steps of RK4."""']
)
def test_other_texts_are_left_alone(source: str) -> None:
    assert dangling(source) == []
