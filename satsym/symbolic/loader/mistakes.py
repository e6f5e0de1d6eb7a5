"""What Python has against a derivation file, in the words of what is declared there: one line, and where."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from typing import Any

from satsym.wording import suggestion

DECLARING = "satsym.symbolic"
"""Where the classes and functions come from that a derivation file declares with."""

_OURS = Path(__file__).parents[2]
"""The folder of the package that they belong to."""

_UNKNOWN = re.compile(r"(\w+)\.__init__\(\) got an unexpected keyword argument '(\w+)'")
_MISSING = re.compile(r"(\w+)\.__init__\(\) missing \d+ required (?:keyword-only|positional) arguments?: (.*)")
_TOO_MANY_ARGUMENTS = re.compile(r"(\w+)\.__init__\(\) takes (?:from \d+ to )?(\d+) positional arguments?")

_POWER = re.compile(r"unsupported operand type\(s\) for \^")

_IMPORTED = re.compile(r"cannot import name '(\w+)' from '([\w.]+)'")


def said(error: Exception, path: Path, names: Mapping[str, Any]) -> tuple[int | None, str]:
    """The line of the file at which an error arose, where that is known, and a sentence.

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
    if isinstance(error, ImportError) and (found := _IMPORTED.match(text)) and found[2] == DECLARING:
        return line, f"{DECLARING} has no {found[1]!r}; {suggestion(found[1], _offered())}"
    if isinstance(error, ValueError) and _refused(error):
        return line, text
    return line, f"{type(error).__name__}: {text}"


def _instead(name: str, names: Mapping[str, Any]) -> str:
    """What to do about a name that is not defined."""
    if name in _offered():
        return f"write `from {DECLARING} import {name}`"
    defined = [known for known in names if not known.startswith("__")]
    return suggestion(name, [*defined, *_offered()])


def _offered() -> list[str]:
    """The names of what is declared with."""
    return sorted(getattr(sys.modules[DECLARING], "__all__", ()))


def _fields(kind: str, names: Mapping[str, Any]) -> dict[str, bool]:
    """Names of the fields of what a file declares with, required ones first, and whether they must be named."""
    found = names.get(kind, getattr(sys.modules[DECLARING], kind, None))
    if not is_dataclass(found):
        return {}
    stated = sorted(fields(found), key=lambda f: f.default is not MISSING or f.default_factory is not MISSING)
    return {field.name: bool(field.kw_only) for field in stated if field.init}


def _keywords(path: Path, line: int | None, keyword: str) -> Iterator[int]:
    """Lines of a keyword in the call that spans a line."""
    try:
        tree = ast.parse(path.read_text(encoding="utf-8"))
    except (OSError, SyntaxError, ValueError):
        return
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and line and call.lineno <= line <= (call.end_lineno or line):
            yield from (k.lineno for k in call.keywords if k.arg == keyword)


def _refused(error: Exception) -> bool:
    """Whether it is what is declared with that refused a value, in a sentence, and not Python."""
    traceback = error.__traceback__
    while traceback and traceback.tb_next:
        traceback = traceback.tb_next
    return traceback is not None and Path(traceback.tb_frame.f_code.co_filename).is_relative_to(_OURS)


def _line(path: Path, error: Exception) -> int | None:
    """The line of the file at which an error arose."""
    if isinstance(error, SyntaxError):
        return error.lineno or None
    line, traceback = None, error.__traceback__
    while traceback:
        if traceback.tb_frame.f_code.co_filename == str(path):
            line = traceback.tb_lineno
        traceback = traceback.tb_next
    return line
