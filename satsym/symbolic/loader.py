"""Reading derivation files: Python that states physics. Reading one derives nothing."""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path
from types import ModuleType

from satsym.status import BadInput
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.model import Model, Problem
from satsym.wording import printable, suggestion

SUFFIX = ".py"


def shipped() -> list[Path]:
    """Derivation files that come with satsym, by name."""
    folder = Path(str(files("satsym.derivations")))
    return sorted(p for p in folder.glob(f"*{SUFFIX}") if not p.name.startswith("_"))


def find(name_or_path: str, folder: Path | None = None) -> Path:
    """The derivation file of a name, or at a path.

    Parameters
    ----------
    name_or_path
        A path ending in ``.py``; or a name: the file in ``folder`` if there is one, else the shipped one.
    folder
        Where the asking file lies.

    Raises
    ------
    BadInput
        If there is none.
    """
    if name_or_path.endswith(SUFFIX):
        path = Path(name_or_path)
        if path.is_file():
            return path
        raise BadInput(f"{name_or_path}: no such derivation file")
    candidates = [folder / f"{name_or_path}{SUFFIX}"] if folder else []
    candidates += [p for p in shipped() if p.stem == name_or_path]
    for candidate in candidates:
        if candidate.is_file():
            return candidate
    known = ", ".join(p.stem for p in shipped())
    raise BadInput(f"{name_or_path}: no such derivation; give a file ending in {SUFFIX}, or one of {known}")


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
        raise BadInput(f"{path}: two entries of PROBLEMS have the same name; names are those of the generated files")
    return problems


def problem(name: str) -> tuple[Problem | Model, Path]:
    """The problem of a shipped name, ``FILE.py`` where it states a single one, or ``FILE.py:NAME``; and its file.

    Raises
    ------
    BadInput
        If there is none, or more than one.
    """
    file, _, wanted = name.rpartition(":") if ".py:" in name else (name if name.endswith(SUFFIX) else "", "", name)
    paths = [find(file)] if file else shipped()
    found = {one.name: (one, path) for path in paths for one in load(path)}
    if file and wanted == name:
        if len(found) > 1:
            raise BadInput(f"{printable(file)}: states {', '.join(found)}; say which, as in {file}:{next(iter(found))}")
        return next(iter(found.values()))
    if wanted not in found:
        raise BadInput(f"{printable(name)}: no derivation of this name; {suggestion(wanted, found)}")
    return found[wanted]


@contextmanager
def explained() -> Iterator[None]:
    """Turns what is wrong with a derivation into bad input: one line, no traceback."""
    try:
        yield
    except DerivationError as error:
        raise BadInput(" ".join(str(error).split())) from error


def _module(path: Path) -> ModuleType:
    """Execute a file under a name that its path determines, once."""
    resolved = path.resolve()
    name = f"satsym_derivation_{hashlib.sha256(str(resolved).encode()).hexdigest()[:12]}_{path.stem}"
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, resolved)
    if spec is None or spec.loader is None or not resolved.is_file():
        raise BadInput(f"{path}: cannot be read as Python")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        del sys.modules[name]
        line = _line_in(resolved, error)
        raise BadInput(f"{path}{line}: {type(error).__name__}: {' '.join(str(error).split())}") from error
    return module


def _line_in(path: Path, error: Exception) -> str:
    """``:line`` of the file at which the error arose, where that is known."""
    if isinstance(error, SyntaxError) and error.lineno:
        return f":{error.lineno}"
    line, traceback = "", error.__traceback__
    while traceback:
        if traceback.tb_frame.f_code.co_filename == str(path):
            line = f":{traceback.tb_lineno}"
        traceback = traceback.tb_next
    return line
