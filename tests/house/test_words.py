"""The glossary is the list of words: what people read, and public names, keep to it."""

from __future__ import annotations

import ast
import functools
import re
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from satsym import instance, kernels
from satsym.auditing import read
from satsym.auditing.ledger import documents
from satsym.cli.app import program
from satsym.report.said import translations
from satsym.report.texts import languages
from tests.support.said import tree

EXCEPT = re.compile(r"\((?:but|kecuali): ([^)]*)\)")

HOLE = re.compile(r"<[a-z_]+>")
"""What a text leaves open, by a name that nobody reads."""


@dataclass(frozen=True)
class Avoided:
    """Words to avoid, as one of the field's terms says it, and uses of them that are right all the same."""

    words: str
    term: str
    right: tuple[str, ...]

    def used(self, words: str) -> bool:
        """Whether words that :func:`plain` or :func:`apart` made contain them other than rightly."""
        for right in self.right:
            words = _whole(right).sub("|", words)
        return _whole(self.words).search(words) is not None


@functools.cache
def _whole(words: str) -> re.Pattern[str]:
    return re.compile(rf"(?<!\S){re.escape(words)}s?(?!\S)")  # or the plural


def plain(text: str) -> str:
    """The words of a text, in small letters, with single spaces between them."""
    return " ".join(re.findall(r"[^\W\d_]+", text.lower()))


def apart(name: str) -> str:
    """The words of a name in code: small_words, CAPITALS or CamelCase."""
    return plain(re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", name.replace("_", " ")))


def rows(text: str) -> list[list[str]]:
    """Cells of the table, without its head."""
    table = [line for line in text.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table[2:]]


def avoided(text: str) -> list[Avoided]:
    """What the last column of a glossary lists."""
    found = []
    for term, _, instead in rows(text):
        for entry in re.split(r", (?![^(]*\))", instead) if instead else ():
            excepted = EXCEPT.search(entry)
            right = tuple(plain(use) for use in excepted[1].split(",")) if excepted else ()
            found.append(Avoided(plain(EXCEPT.sub("", entry)), term, right))
    return found


@pytest.fixture(scope="module")
def glossaries(repository: Path) -> dict[str, str]:
    return {
        language: (repository / "docs" / f"glossary{'' if language == 'en' else f'.{language}'}.md").read_text("utf-8")
        for language in languages()
    }


@pytest.fixture(scope="module")
def english(glossaries: dict[str, str]) -> list[Avoided]:
    return avoided(glossaries["en"])


def complaints(named: Iterable[tuple[str, str]], words: list[Avoided]) -> list[str]:
    """What to write instead, and where."""
    any_of = re.compile("|".join(re.escape(each.words) for each in words))
    return [
        f'{where}: write "{each.term}" instead of "{each.words}" in {text[:160]!r}'
        for where, text in named
        for said in [plain(HOLE.sub(" ", text))]
        if any_of.search(said)
        for each in words
        if each.words in said and each.used(said)
    ]


def leaves(table: Any, path: str = "") -> Iterator[tuple[str, str]]:
    """Strings of nested tables, each with its keys."""
    if isinstance(table, dict):
        for key, value in table.items():
            yield from leaves(value, f"{path}.{key}".strip("."))
    else:
        yield path, str(table)


def texts(repository: Path, language: str) -> dict[str, Any]:
    return tomllib.loads((repository / f"satsym/report/texts/{language}.toml").read_text("utf-8"))


@pytest.mark.parametrize("language", ["en", "id"])
def test_a_glossary_is_a_table_in_order_whose_every_word_can_be_found(
    language: str, glossaries: dict[str, str]
) -> None:
    terms = [row[0] for row in rows(glossaries[language])]
    assert len(terms) >= 50
    assert all(len(row) == 3 and row[0] and row[1] for row in rows(glossaries[language]))
    assert [*map(plain, terms)] == sorted(map(plain, terms))
    words = avoided(glossaries[language])
    assert len({each.words for each in words}) == len(words), "a word to avoid stands there twice"
    for each in words:
        assert each.used(plain(f"Some {each.words}, so written."))
        assert all(each.words in right.split(" ") or each.words in right for right in each.right), each
        assert not any(each.used(right) for right in each.right), each
    assert not complaints(zip(terms, terms, strict=True), words)


def test_words_are_found_whole_and_excepted_where_the_glossary_says_so() -> None:
    (least,) = avoided("| term | meaning | instead of |\n| --- | --- | --- |\n| minimum | m | least (but: at least) |")
    assert least == Avoided("least", "minimum", ("at least",))
    assert least.used(plain("The Least-effort transfer, at least here"))
    assert not least.used(plain("at least the leastways"))
    assert least.used(apart("LeastTime"))
    assert least.used(apart("LEAST_TIME"))
    assert not least.used(apart("at_least"))
    assert Avoided("kink", "corner", ()).used(apart("with_kinks"))


@pytest.mark.parametrize("language", languages())
def test_typeset_texts_use_the_words_of_their_glossary(
    language: str, glossaries: dict[str, str], repository: Path
) -> None:
    assert complaints(leaves(texts(repository, language)), avoided(glossaries[language])) == []


@pytest.mark.parametrize("language", [each for each in languages() if each != "en"])
def test_translated_messages_use_the_words_of_their_glossary(language: str, glossaries: dict[str, str]) -> None:
    texts = translations(language)
    assert len(texts) > 300
    assert complaints(texts.items(), avoided(glossaries[language])) == []


def test_what_rows_of_ledgers_are_about_is_told_in_the_words_of_the_glossary(glossaries: dict[str, str]) -> None:
    told = {text: text for path in documents.shipped() for text in (row.says_id for row in read(path).rows)}
    assert len(told) > 600
    assert complaints(told.items(), avoided(glossaries["id"])) == []


def test_help_uses_the_words_of_the_glossary(english: list[Avoided]) -> None:
    context = program.make_context("satsym", [], resilient_parsing=True)
    pages = {"satsym": program.get_help(context)}
    for name in program.list_commands(context):
        command = program.get_command(context, name)
        assert command is not None
        pages[name] = command.get_help(command.make_context(name, [], parent=context, resilient_parsing=True))
    assert len(pages) > 10
    assert complaints(pages.items(), english) == []


def test_titles_and_meanings_of_what_is_shipped_use_the_words_of_the_glossary(english: list[Avoided]) -> None:
    said = {f"instance {name}": instance.load(name).title for name in instance.shipped()}
    for name in kernels.shipped():
        spec = kernels.load(name).spec
        said[f"model {name}"] = spec.title
        said |= {f"{name}.{v.symbol}": v.meaning for v in (*spec.states, *spec.controls, *spec.parameters)}
    assert complaints(said.items(), english) == []


@pytest.fixture(scope="module")
def sources(repository: Path) -> dict[Path, ast.Module]:
    """All modules of satsym, by their paths in it."""
    top = repository / "satsym"
    return {path.relative_to(top): tree(path) for path in sorted(top.rglob("*.py"))}


def messages(module: ast.Module) -> Iterator[tuple[int, str]]:
    """String literals of more than one word with their lines: no docstrings, holes of f-strings left out."""
    nodes = [node for node in ast.walk(module) if isinstance(node, ast.Expr | ast.JoinedStr | ast.Constant)]
    silent = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    for node in nodes:
        if isinstance(node, ast.JoinedStr):
            parts = [part for part in node.values if isinstance(part, ast.Constant)]
            silent |= {id(part) for part in parts}
            yield node.lineno, " { } ".join(str(part.value) for part in parts)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in silent:
            yield node.lineno, node.value


def test_messages_and_labels_use_the_words_of_the_glossary(
    sources: dict[Path, ast.Module], repository: Path, english: list[Avoided]
) -> None:
    keys = {path.partition(".")[2] for path, _ in leaves(texts(repository, "en"))}  # name a text, and are not read
    said = [
        (f"{path}:{line}", text)
        for path, module in sources.items()
        if path.parts[0] not in ("auditing", "codegen")
        for line, text in messages(module)
        if " " in text.strip() and text not in keys
    ]
    assert len(said) > 500
    assert complaints(said, english) == []


def public_names(path: Path, module: ast.Module) -> Iterator[str]:
    """The module, its constants, functions and classes, and their fields and methods; nothing that begins with _."""
    yield from path.with_suffix("").parts
    waiting: list[ast.stmt] = list(module.body)
    while waiting:
        node = waiting.pop()
        found: list[str] = []
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found = [node.name]
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                waiting += node.body
        elif isinstance(node, ast.AnnAssign | ast.Assign):
            targets = [node.target] if isinstance(node, ast.AnnAssign) else node.targets
            found = [each.id for target in targets for each in ast.walk(target) if isinstance(each, ast.Name)]
        yield from found


def test_public_names_use_the_words_of_the_glossary(sources: dict[Path, ast.Module], english: list[Avoided]) -> None:
    # measurements are named by ledgers, in the words of the documents
    kept = {path: module for path, module in sources.items() if path.parts[:2] != ("auditing", "measurements")}
    names = {name for path, module in kept.items() for name in public_names(path, module) if name[0] != "_"}
    assert len(names) > 1000
    old = {name for name in names if any(each.words in apart(name) and each.used(apart(name)) for each in english)}
    assert sorted(old) == [], "these names use words to avoid"
