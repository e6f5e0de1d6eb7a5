"""Reading of derivation files, which are Python that states physics, without deriving anything.

Errors that Python raises in a file are told in one line, with the place, in the words of the declarations.
"""

from __future__ import annotations

import ast
import hashlib
import importlib.util
import re
import sys
import warnings
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import MISSING, fields, is_dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any

from satsym import source_files
from satsym.source_files import digest_of, shipped
from satsym.status import BadInput
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.model import Model, Problem
from satsym.wording import printable, suggestion

__all__ = ["explained", "find", "load", "problem", "reached", "shipped"]

_REACHED: dict[Path, dict[Path, str]] = {}
"""Derivation file that was executed -> the files that it read, including itself, with digests of their contents."""

_IMPORTED: dict[Path, str] = {}
"""Modules that derivation files imported, except satsym and libraries, with digests; each file is opened once."""

_EXECUTING: list[Path] = []
"""Derivation files that are being executed, each requested by the one before."""

_LIBRARIES = tuple({sys.prefix, sys.base_prefix, sys.exec_prefix, str(Path(__file__).resolve().parents[1])})


def reached(path: Path) -> dict[Path, str]:
    """Return the files that a loaded derivation file read, itself included, with their digests.

    What the file took from elsewhere, such as the environment, is not known here.
    """
    imported = {each: digest for each, digest in _IMPORTED.items() if each not in _REACHED}
    return imported | _REACHED.get(path.resolve(), {})


def stating(path: Path) -> dict[Path, str]:
    """Return the code files that a loaded derivation file states its problems with, with digests as of reading.

    These are the file itself, first, then the derivations that it asked for, and modules beside these.
    """
    first, digests = path.resolve(), reached(path)
    known = [first, *sorted(each for each in _REACHED.get(first, {}) if each in _REACHED and each != first)]
    for each in known:  # which grows
        imported = source_files.imports(each.read_text(encoding="utf-8"))
        beside = (each.parent / f"{name.replace('.', '/')}{source_files.SUFFIX}" for name in sorted(imported))
        known += [found for found in beside if found not in known and found.is_file()]
    return {each: digests.get(each) or digest_of(each) for each in known}


def _watch(event: str, arguments: tuple[Any, ...]) -> None:
    """Record the files that a derivation file opens; Python calls this at every event, so that it has to be quick."""
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
    """Return the source of a compiled file; any other file is its own source."""
    return path.parents[1] / f"{path.name.partition('.')[0]}.py" if path.suffix == ".pyc" else path


sys.addaudithook(_watch)


def find(name_or_path: str, folder: Path | None = None) -> Path:
    """Find a derivation file as :func:`satsym.source_files.find` does, and record also searches in vain."""
    found = source_files.find(name_or_path, folder)
    if folder is not None and not name_or_path.endswith(source_files.SUFFIX):
        first = folder / f"{name_or_path}{source_files.SUFFIX}"
        for asking in _EXECUTING:
            _REACHED[asking].setdefault(first.resolve(), digest_of(first))
    return found


def load(path: Path) -> tuple[Problem | Model, ...]:
    """Execute a derivation file, the user's own Python, and return the problems and models that it states.

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
    """Return the problem of a shipped name, or of ``FILE.py`` or ``FILE.py:NAME``, with its file.

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
    """Turn errors about a derivation into bad input with one line and no traceback.

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
    """Execute a file as a module whose name its path determines; again only if a file that it read has changed."""
    resolved = path.resolve()
    name = f"satsym_derivation_{hashlib.sha256(str(resolved).encode()).hexdigest()[:12]}_{path.stem}"
    if name not in sys.modules or any(digest_of(each) != known for each, known in _REACHED[resolved].items()):
        _execute(path, name)
    for asking in _EXECUTING:
        _REACHED[asking] |= _REACHED[resolved]
    return sys.modules[name]


def _translate(module: ModuleType) -> None:
    """Give a file's translations to the models and problems that it states, whose own ones take precedence."""
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
    """Return the phrases of a derivation file with their translations, from the file of a language beside it."""
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
        line, message = described(error, resolved, vars(module))
        raise BadInput(f"{path}{f':{line}' if line else ''}: {message}") from error
    finally:
        _EXECUTING.pop()


def _line_of(path: Path, subject: Problem | Model, named: Sequence[str]) -> int | None:
    """Return the line of a statement about a problem or its model; ``None`` where it is not known.

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
    """Return the calls that state a problem or model with this name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            keywords = {k.arg: k.value for k in node.keywords}
            stated = keywords.get("name")
            if isinstance(stated, ast.Constant) and stated.value == name:
                yield node


def _mentions(node: ast.AST, named: Collection[str]) -> Iterator[int]:
    """Return the lines at which one of these names is used, as a variable or in quotes, in order."""
    lines = []
    for each in ast.walk(node):
        used = each.id if isinstance(each, ast.Name) else each.value if isinstance(each, ast.Constant) else None
        if isinstance(used, str) and used in named and isinstance(each, ast.expr):
            lines.append(each.lineno)
    yield from sorted(lines)


DECLARING = "satsym.symbolic"
"""The package with the classes and functions with which a derivation file declares models."""

_OURS = Path(__file__).parents[1]
"""The folder of the package satsym."""

_UNKNOWN = re.compile(r"(\w+)\.__init__\(\) got an unexpected keyword argument '(\w+)'")
_MISSING = re.compile(r"(\w+)\.__init__\(\) missing \d+ required (?:keyword-only|positional) arguments?: (.*)")
_TOO_MANY_ARGUMENTS = re.compile(r"(\w+)\.__init__\(\) takes (?:from \d+ to )?(\d+) positional arguments?")

_POWER = re.compile(r"unsupported operand type\(s\) for \^")

_NOT_THERE = re.compile(r"cannot import name '(\w+)' from '([\w.]+)'")


def described(error: Exception, path: Path, names: Mapping[str, Any]) -> tuple[int | None, str]:
    """Return the line at which an error arose in a file, where it is known, and a sentence about the error.

    Parameters
    ----------
    names
        What the file has defined until then.
    """
    line, text = _line(path, error), " ".join(str(error).split())
    if isinstance(error, TypeError):
        if _POWER.match(text):
            return line, "write powers with **, as in x**3; ^ is not the power operator in Python"
        if (found := _UNKNOWN.match(text)) and (known := _fields(found[1], names)):
            at = next(_keywords(path, line, found[2]), line)
            return at, f"{found[1]} has no field {found[2]!r}; {suggestion(found[2], known)}"
        if (found := _MISSING.match(text)) and (known := _fields(found[1], names)):
            return line, f"{found[1]} needs {found[2]}; its fields are {', '.join(known)}"
        if (found := _TOO_MANY_ARGUMENTS.match(text)) and (known := _fields(found[1], names)):
            ordered = ", ".join(name for name, keyword in known.items() if not keyword)
            instead = (
                f"its positional fields are {ordered}"
                if ordered
                else "pass its fields by keyword, for example name=..."
            )
            return line, f"{found[1]} was given more values than it has fields; {instead}"
    if isinstance(error, SyntaxError):
        return line, f"{type(error).__name__}: {error.msg}"
    if isinstance(error, ModuleNotFoundError) and (error.name or "").startswith("satsym"):
        return line, f"there is no {error.name}; write `from {DECLARING} import ...`"
    if isinstance(error, NameError) and error.name:
        return line, f"{error.name!r} is not defined; {_instead(error.name, names)}"
    if isinstance(error, ImportError) and (found := _NOT_THERE.match(text)) and found[2] == DECLARING:
        return line, f"{DECLARING} has no {found[1]!r}; {suggestion(found[1], _offered())}"
    if isinstance(error, ValueError) and _refused(error):
        return line, text
    return line, f"{type(error).__name__}: {text}"


def _instead(name: str, names: Mapping[str, Any]) -> str:
    """Suggest what to write instead of a name that is not defined."""
    if name in _offered():
        return f"write `from {DECLARING} import {name}`"
    defined = [known for known in names if not known.startswith("__")]
    return suggestion(name, [*defined, *_offered()])


def _offered() -> list[str]:
    """Return the names that a derivation file can import to declare something."""
    return sorted(getattr(sys.modules[DECLARING], "__all__", ()))


def _fields(kind: str, names: Mapping[str, Any]) -> dict[str, bool]:
    """Return the fields of a class that declares something, required ones first, and whether they must be named."""
    found = names.get(kind, getattr(sys.modules[DECLARING], kind, None))
    if not is_dataclass(found):
        return {}
    stated = sorted(fields(found), key=lambda f: f.default is not MISSING or f.default_factory is not MISSING)
    return {field.name: bool(field.kw_only) for field in stated if field.init}


def _keywords(path: Path, line: int | None, keyword: str) -> Iterator[int]:
    """Return the lines of a keyword in the call that spans a line."""
    try:
        tree = ast.parse(path.read_text(encoding="utf-8"))
    except (OSError, SyntaxError, ValueError):
        return
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and line and call.lineno <= line <= (call.end_lineno or line):
            yield from (k.lineno for k in call.keywords if k.arg == keyword)


def _refused(error: Exception) -> bool:
    """Tell whether an error is a refusal by the classes of declarations, in a sentence, and not by Python."""
    traceback = error.__traceback__
    while traceback and traceback.tb_next:
        traceback = traceback.tb_next
    return traceback is not None and Path(traceback.tb_frame.f_code.co_filename).is_relative_to(_OURS)


def _line(path: Path, error: Exception) -> int | None:
    """Return the line of a file at which an error arose."""
    if isinstance(error, SyntaxError):
        return error.lineno or None
    line, traceback = None, error.__traceback__
    while traceback:
        if traceback.tb_frame.f_code.co_filename == str(path):
            line = traceback.tb_lineno
        traceback = traceback.tb_next
    return line
