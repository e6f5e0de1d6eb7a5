"""Reading derivation files: Python that states physics. Reading one derives nothing."""

from __future__ import annotations

import ast
import hashlib
import importlib.util
import sys
import warnings
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

from satsym import source_files
from satsym.source_files import digest_of, shipped
from satsym.status import BadInput
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.loader.mistakes import said
from satsym.symbolic.model import Model, Problem
from satsym.wording import printable, suggestion

__all__ = ["explained", "find", "load", "problem", "reached", "shipped"]

_REACHED: dict[Path, dict[Path, str]] = {}
"""Derivation files that were executed -> what they read, themselves included, with digests of its content."""

_IMPORTED: dict[Path, str] = {}
"""Modules that any of them imported, neither satsym's nor a library's: the second one to import them opens nothing."""

_EXECUTING: list[Path] = []
"""The files whose execution has begun and is not over, each asked for by the one before."""

_LIBRARIES = tuple({sys.prefix, sys.base_prefix, sys.exec_prefix, str(Path(__file__).resolve().parents[2])})


def reached(path: Path) -> dict[Path, str]:
    """The files that a loaded derivation file consists of, itself and all that it read, with their digests.

    What it took from elsewhere, such as the environment, is not known here.
    """
    imported = {each: digest for each, digest in _IMPORTED.items() if each not in _REACHED}
    return imported | _REACHED.get(path.resolve(), {})


def stating(path: Path) -> dict[Path, str]:
    """The code that a loaded derivation file states its problems with, with digests as of when it was read.

    That is the file itself, first, then the derivations that it asked for and the modules beside one of these.
    """
    first, digests = path.resolve(), reached(path)
    known = [first, *sorted(each for each in _REACHED.get(first, {}) if each in _REACHED and each != first)]
    for each in known:  # which grows
        imported = source_files.imports(each.read_text(encoding="utf-8"))
        beside = (each.parent / f"{name.replace('.', '/')}{source_files.SUFFIX}" for name in sorted(imported))
        known += [found for found in beside if found not in known and found.is_file()]
    return {each: digests.get(each) or digest_of(each) for each in known}


def _watch(event: str, arguments: tuple[Any, ...]) -> None:
    """Note what a derivation file opens. Python calls this at every event, so that it has to be quick."""
    if event == "open" and _EXECUTING and isinstance(arguments[0], str) and not arguments[0].startswith(_LIBRARIES):
        asking = tuple(_EXECUTING)
        _EXECUTING.clear()  # what is opened here is not opened by the file
        opened = _source(Path(arguments[0]).absolute())
        digest = digest_of(opened)
        _EXECUTING.extend(asking)
        if opened.suffix == source_files.SUFFIX:
            _IMPORTED.setdefault(opened, digest)
        for each in asking:
            _REACHED[each][opened] = digest


def _source(path: Path) -> Path:
    """The source behind a compiled file; any other file itself."""
    return path.parents[1] / f"{path.name.partition('.')[0]}.py" if path.suffix == ".pyc" else path


sys.addaudithook(_watch)


def find(name_or_path: str, folder: Path | None = None) -> Path:
    """As :func:`satsym.source_files.find`; what a file that is being executed looked for in vain is noted, too."""
    found = source_files.find(name_or_path, folder)
    if folder is not None and not name_or_path.endswith(source_files.SUFFIX):
        first = folder / f"{name_or_path}{source_files.SUFFIX}"
        for asking in _EXECUTING:
            _REACHED[asking].setdefault(first.resolve(), digest_of(first))
    return found


def load(path: Path) -> tuple[Problem | Model, ...]:
    """The problems and models that a derivation file states.

    A derivation file is the user's own Python and is executed.

    Raises
    ------
    BadInput
        If it cannot be executed, or does not end with ``PROBLEMS``.
    """
    problems = getattr(_module(path), "PROBLEMS", None)
    if not isinstance(problems, tuple) or not problems or not all(isinstance(p, Problem | Model) for p in problems):
        raise BadInput(f"{path}: PROBLEMS must be a tuple of problems and models; end the file with PROBLEMS = (...,)")
    names = [p.name for p in problems]
    if len(set(names)) < len(names):
        raise BadInput(
            f"{path}: two entries of PROBLEMS have the same name; a generated file is named after each entry, "
            "so the names must differ"
        )
    return problems


def problem(name: str) -> tuple[Problem | Model, Path]:
    """The problem of a shipped name, ``FILE.py`` where it states a single one, or ``FILE.py:NAME``; and its file.

    Raises
    ------
    BadInput
        If there is none, or more than one.
    """
    file, _, wanted = (
        name.rpartition(":") if ".py:" in name else (name if name.endswith(source_files.SUFFIX) else "", "", name)
    )
    paths = [find(file)] if file else shipped()
    found = {one.name: (one, path) for path in paths for one in load(path)}
    if file and wanted == name:
        if len(found) > 1:
            raise BadInput(
                f"{printable(file)}: states {', '.join(found)}; name one of them, as in {file}:{next(iter(found))}"
            )
        return next(iter(found.values()))
    if wanted not in found:
        raise BadInput(f"{printable(name)}: there is no derivation of this name; {suggestion(wanted, found)}")
    return found[wanted]


@contextmanager
def explained(path: Path | None = None, subject: Problem | Model | None = None) -> Iterator[None]:
    """Turns what is wrong with a derivation into bad input: one line, no traceback.

    Parameters
    ----------
    path, subject
        The file and what of it is derived, where they are known: the message then begins with file and line.
    """
    try:
        yield
    except DerivationError as error:
        message = " ".join(str(error).split())
        if path is not None and subject is not None:
            line = _line_of(path, subject, error.named)
            message = f"{path}{'' if line is None else f':{line}'}: {message}"
        raise BadInput(message) from error


def _module(path: Path) -> ModuleType:
    """Execute a file under a name that its path determines; once, unless it or what it asks for has changed since."""
    resolved = path.resolve()
    name = f"satsym_derivation_{hashlib.sha256(str(resolved).encode()).hexdigest()[:12]}_{path.stem}"
    if name not in sys.modules or any(digest_of(each) != known for each, known in _REACHED[resolved].items()):
        _execute(path, name)
    for asking in _EXECUTING:
        _REACHED[asking] |= _REACHED[resolved]
    return sys.modules[name]


def _translate(module: ModuleType) -> None:
    """Give the file's translations to what it states; its own ones go first."""
    words, stated = getattr(module, "TRANSLATIONS", {}), getattr(module, "PROBLEMS", ())
    if not isinstance(words, Mapping) or not all(isinstance(each, Mapping) for each in words.values()):
        raise TypeError('TRANSLATIONS must have phrases by language, {"id": {"velocity": "kecepatan"}}')
    beside = {
        language: _phrases(path) for language, path in source_files.translations(Path(module.__file__ or "")).items()
    }
    words = {key: {**beside.get(key, {}), **words.get(key, {})} for key in dict.fromkeys((*words, *beside))}
    if words and isinstance(stated, tuple):
        module.PROBLEMS = tuple(_in_languages(one, words) for one in stated)  # type: ignore[attr-defined]


def _phrases(path: Path) -> dict[str, str]:
    """Phrases of a derivation file and what they are in the language of a file beside it."""
    try:
        return source_files.phrases(path)
    except ValueError as error:
        raise ValueError(f"its translation {path.name}: {error}") from None


def _in_languages(one: Any, words: Mapping[str, Mapping[str, str]]) -> Any:
    if isinstance(one, Problem):
        return replace(one, model=_in_languages(one.model, words))
    if not isinstance(one, Model):
        return one
    own = one.translations
    both = {key: {**words.get(key, {}), **own.get(key, {})} for key in dict.fromkeys((*words, *own))}
    return replace(one, translations=both)


def _execute(path: Path, name: str) -> None:
    resolved = path.resolve()
    spec = importlib.util.spec_from_file_location(name, resolved)
    if spec is None or spec.loader is None or not resolved.is_file():
        raise BadInput(f"{path}: cannot be read as Python")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    _REACHED[resolved] = {resolved: digest_of(resolved)}
    _EXECUTING.append(resolved)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)  # the error that follows says the same, with its line
            spec.loader.exec_module(module)
        _translate(module)
    except Exception as error:
        del sys.modules[name]
        line, message = said(error, resolved, vars(module))
        raise BadInput(f"{path}{f':{line}' if line else ''}: {message}") from error
    finally:
        _EXECUTING.pop()


def _line_of(path: Path, subject: Problem | Model, named: Sequence[str]) -> int | None:
    """The line of the statement of a problem or its model at which something stands; ``None`` where none is known.

    Parameters
    ----------
    named
        Fields of the statement, or symbols, that the message is about, the likeliest first. Without any, or where none
        of them stands there, it is the line where the statement begins.
    """
    try:
        tree = ast.parse(path.read_text(encoding="utf-8"))
    except (OSError, SyntaxError, ValueError):
        return None
    model = subject.model if isinstance(subject, Problem) else subject
    calls = [call for name in (subject.name, model.name) for call in _statements(tree, name)]
    fields = [k for name in named for call in calls for k in call.keywords if k.arg == name]
    rows = [
        value
        for k in fields
        if isinstance(k.value, ast.Dict)
        for key, value in zip(k.value.keys, k.value.values, strict=True)
        if isinstance(key, ast.Name) and key.id in named
    ]
    if rows:
        return rows[0].lineno
    within = [*(k.value for k in fields), *calls]
    found = next((line for node in within for line in _mentions(node, named)), None)
    if found is None and fields:
        return fields[0].value.lineno
    if found is None:
        found = next(_mentions(tree, named), None)
    return found if found is not None or not calls else calls[0].lineno


def _statements(tree: ast.Module, name: str) -> Iterator[ast.Call]:
    """Calls that state something of this name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            keywords = {k.arg: k.value for k in node.keywords}
            stated = keywords.get("name")
            if isinstance(stated, ast.Constant) and stated.value == name:
                yield node


def _mentions(node: ast.AST, named: Collection[str]) -> Iterator[int]:
    """Lines at which one of these names is used, as a variable or in quotes, from the top."""
    lines = []
    for each in ast.walk(node):
        used = each.id if isinstance(each, ast.Name) else each.value if isinstance(each, ast.Constant) else None
        if isinstance(used, str) and used in named and isinstance(each, ast.expr):
            lines.append(each.lineno)
    yield from sorted(lines)
