"""Messages on terminals and in pictures, in the language that was asked for.

A message is written in English where it is made, with ``<name>`` where something is filled in. That text is the key of
its translation in the folder of a language, ``id`` for Indonesian; English needs none. A message without a translation
stays English as a whole. The texts of documents have keys of their own, in :mod:`satsym.report.texts`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from pathlib import Path

from satsym import wording
from satsym.status import BadInput
from satsym.wording import shown, suggestion

VARIABLE = "SATSYM_LANG"
"""Environment variable of the language, used if no language is requested."""

_BREAK = re.compile(r"(; |(?<=[.:]) )")
"""Separators of clauses and sentences of a message, each of which may have its own translation."""
_PLACE = re.compile(r"(?:(?:\[[\w.]+\]|--[\w-]+) )?\S+:")
"""Pattern of the beginning of a message that is not translated: a file, an instance or a key."""
_HOLE = re.compile(r"<([a-z_]+)>")
_SENTENCE = re.compile(r"\b(?:the|is|are|has|have|not|no|which|with|must|cannot|be)\b")
"""Pattern of English words that distinguish a sentence from a name."""
_QUOTED = re.compile(r"`[^`]*`|\"[^\"]*\"|'[^']*'")
_FOREIGN = "error"
"""Name of the placeholder for a message of a library, which is not translated."""
_TEXT_PLACE = "said_"
"""Prefix of placeholders for texts that are translated; other placeholders stand for names and numbers."""
_MIXED, _BETWEEN = ("arcs", "got"), re.compile(r"(, | \(|\))")
"""Placeholders for lists of names that contain translated words, and pattern of the separators in such lists."""
_ASKED: ContextVar[str | None] = ContextVar("language", default=None)


def language() -> str:
    """Return the language that was asked for, else that of the environment, else English.

    Raises
    ------
    BadInput
        If there are no texts in it.
    """
    return _ASKED.get() or known(os.environ.get(VARIABLE) or "en", VARIABLE)


def known(name: str, place: str) -> str:
    """Return the name of a language after a check that it has texts.

    Raises
    ------
    BadInput
        If there are none, with the place where it was asked for.
    """
    if name == "en":
        return name
    from satsym.report import texts

    if name not in texts.languages():
        raise BadInput(
            f"{place}: there is no translation into the language {shown(name)}; {suggestion(name, texts.languages())}"
        )
    return name


def ask(name: str) -> None:
    """Set the language of messages in this context."""
    _ASKED.set(name)


@contextmanager
def spoken(name: str) -> Iterator[None]:
    """Set the language of messages within a ``with`` block."""
    before = _ASKED.set(name)
    try:
        yield
    finally:
        _ASKED.reset(before)


def say(text: str, **fill: object) -> str:
    """Return a message in the current language, with its places filled in."""
    if (spoken_here := language()) != "en":
        text = translations(spoken_here).get(text, text)
    return _filled(text, fill) if fill else text


def each(*heads: str) -> tuple[str, ...]:
    """Return several texts in the current language, such as the headings of columns."""
    return tuple(map(say, heads))


def counted(number: int, one: str, several: str = "") -> str:
    """Return a number with its noun, as in 1 iteration, 2 iterations; some languages have no plurals."""
    return wording.counted(number, one, several) if language() == "en" else f"{number} {say(one)}"


def decimal(text: str) -> str:
    """Return numbers in a picture with the decimal sign of the language."""
    return text if language() == "en" else re.sub(r"(?<=\d)\.(?=\d)", ",", text)


def numbers(given: Iterable[str]) -> str:
    """Return a list of numbers, separated by semicolons where they have a decimal comma."""
    return (", " if language() == "en" else "; ").join(map(decimal, given))


def message(text: str) -> str:
    """Translate an English message of a solver, a check or a refusal, as a whole or by clauses; else return it."""
    if (asked := language()) == "en" or not text:
        return text
    found = _by_parts(_BREAK.split(text), asked)
    return text if found is None else found


def explained(text: str) -> str:
    """Translate a text of the help; no other texts are loaded, since help has to be fast."""
    asked = language()
    known = {} if asked == "en" else group(asked, "help")
    return known.get(text) or _filled_in(text, asked, "help") or text


def _by_parts(parts: Sequence[str], asked: str) -> str | None:
    """Translate clauses, as many together as there is a translation for."""
    for count in range(len(parts), 0, -2):
        found = _translated("".join(parts[:count]), asked)
        if found is not None and count < len(parts):
            rest = _by_parts(parts[count + 1 :], asked)
            found = None if rest is None else found + parts[count] + rest
        if found is not None:
            return found
    if len(parts) > 1 and _PLACE.fullmatch(parts[0]):
        rest = _by_parts(parts[2:], asked)
        return None if rest is None else parts[0] + parts[1] + rest
    return None


def _translated(text: str, asked: str, name: str = "messages") -> str | None:
    """Translate a text, or a filled-in form of one."""
    exact = translations(asked).get(text)
    return _filled_in(text, asked, name) if exact is None else exact


def _filled_in(text: str, asked: str, name: str) -> str | None:
    """Translate the text of which this is a filled-in form."""
    for most, english, translation in _with_places(asked, name):
        if most in text and (found := _pattern(english).fullmatch(text)):
            parts = {k: _part(k, part, asked) for k, part in found.groupdict().items()}
            if None not in parts.values():  # else half of it would stay English
                return _filled(translation, parts)
    return None


def _part(place: str, text: str, asked: str) -> str | None:
    """Translate the filling of a place where it is a text; ``None`` where a sentence fills the place of a name."""
    if place.startswith(_TEXT_PLACE):
        return _inside(text, asked)
    if place in _MIXED:
        return "".join(_translated(part, asked, "items") or part for part in _BETWEEN.split(text))
    return None if place != _FOREIGN and _SENTENCE.search(_QUOTED.sub("", text)) else text


def _inside(text: str, asked: str) -> str | None:
    """Translate the filling of a place: a text, or a list of texts; numbers are unchanged."""
    if not re.search("[a-z]{2}", text):
        return text
    found = _by_parts(_BREAK.split(text), asked)
    if found is None:
        items = [_translated(item, asked, "items") for item in text.split(", ")]
        found = None if None in items else ", ".join(filter(None, items))
    return found


def _filled(text: str, fill: Mapping[str, object]) -> str:
    return _HOLE.sub(lambda hole: str(fill.get(hole[1], hole[0])), text)


@cache
def translations(asked: str) -> Mapping[str, str]:
    """Map English texts to those in a language; empty where there is no file."""
    found = dict(_of_models(asked))
    for file in (Path(__file__).parent / asked).glob("*.toml"):
        found |= group(asked, file.stem)
    return found


def _of_models(asked: str) -> Iterator[tuple[str, str]]:
    """Return titles and meanings of shipped derivation files in a language; no file is executed."""
    import ast

    from satsym import source_files

    for file in source_files.shipped():
        if beside := source_files.translations(file).get(asked):
            yield from source_files.phrases(beside).items()
        for statement in ast.parse(file.read_text(encoding="utf-8")).body:
            match statement:
                case ast.Assign(targets=[ast.Name(id="TRANSLATIONS")], value=table):
                    yield from ast.literal_eval(table).get(asked, {}).items()


@cache
def group(asked: str, name: str) -> Mapping[str, str]:
    """Return the texts of the files whose names begin like this; empty where there is no such file.

    The texts of ``said`` and ``authored``, titles of shipped instances, are looked up as they are. Those of
    ``messages``, of ``items``, which are listed in such texts, and of ``help`` are recognised in any filled-in form.
    """
    import tomllib  # nothing of this for English

    files = sorted((Path(__file__).parent / asked).glob(f"{name}*.toml"))
    tables = (table for file in files for table in tomllib.loads(file.read_text(encoding="utf-8")).values())
    return {english: text for table in tables for english, text in table.items()}


@cache
def _with_places(asked: str, name: str) -> list[tuple[str, str, str]]:
    """Return texts with places, the most specific first: its longest fixed part, the text, its translation."""
    phrases = group(asked, name)
    with_places = [english for english in phrases if _HOLE.search(english)]
    with_places.sort(key=lambda english: -len(_HOLE.sub("", english)))
    return [(max(_HOLE.split(english)[::2], key=len), english, phrases[english]) for english in with_places]


@cache
def _pattern(english: str) -> re.Pattern[str]:
    """Return a pattern that matches every filled-in form of a text; a place that occurs twice has one filling."""
    parts, seen = [], set[str]()
    for k, part in enumerate(_HOLE.split(english)):
        if k % 2 == 0:
            parts.append(re.escape(part))
        else:
            inside = "." if part.startswith(_TEXT_PLACE) else "(?:(?!: )[^;])"  # names end where their clause does
            parts.append(f"(?P={part})" if part in seen else f"(?P<{part}>{inside}*?)")
            seen.add(part)
    return re.compile("".join(parts))
