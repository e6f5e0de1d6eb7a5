"""Find a model by name or by path, and make its Kernels.

Shipped modules are imported like any other. A file that an instance names by path is foreign data: it must lie in the
instance's folder, and it is checked node by node before anything in it runs; then its digest is checked, and its
functions against each other.
"""

from __future__ import annotations

import ast
import copyreg
import importlib
import math
import os
import re
import shlex
from collections.abc import Callable, Mapping
from functools import cache, lru_cache
from importlib.abc import InspectLoader
from pathlib import Path
from types import FunctionType
from typing import Any, NoReturn

import numpy as np

from satsym import source_files
from satsym.kernels.core import Backend, Function, Kernels
from satsym.kernels.digest import changed, intact
from satsym.spec import NAMES, ProblemSpec, is_name
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

MOST_BYTES = 1_000_000
"""Largest size of a module file, in bytes; larger files are refused. Shipped modules have a twentieth of that."""

_DECLARING = "satsym.symbolic"
"""The package that derivation files import, and generated modules never do."""
_STATED = re.compile(r"""\bProblem\(\s*(?:name\s*=\s*)?["']([a-z][a-z0-9_]{0,99})["']""")

_ANEW = "write it again with `satsym derive`"
_EDITED = "edited by hand or damaged since it was written; run `satsym derive` again"


def shipped() -> list[str]:
    """Return the names of the shipped models, without importing them."""
    return source_files.models()


def load(model: str, folder: Path | None = None) -> Kernels:
    """Return the kernels of a shipped model, or of a generated file in ``folder``.

    Parameters
    ----------
    model
        A shipped name, or a path relative to ``folder``, without ``.py``: ``"DIR/name"``, ``"./name"``, or
        just ``"name"`` where no shipped model has that name.
    folder
        Folder in which paths start, and which they cannot leave: that of the instance file. By default the working
        folder.

    Raises
    ------
    BadInput
        If there is no such model, or if its file is not what ``satsym derive`` writes.
    """
    folder = folder or Path()
    if model.endswith(".py"):
        _refuse_ending(model)
    if "/" not in model:
        if source_files.is_model(model):
            found = _load_shipped(model)
            _refuse_older(model, *_lying(model))
            return found
        if not (is_name(model) and (folder / f"{model}.py").is_file()):
            raise BadInput(_unknown(model))
        model = f"./{model}"
    path, root = _resolve(model, folder)
    text = _read(model, path)
    _refuse_derivation(model, path, root, text)
    found = _load_file(model, root, path, text)
    _refuse_older(model, text, path.parent)
    return found


@lru_cache(maxsize=32)
def from_text(text: str, name: str, folder: Path | None = None) -> Kernels:
    """Return the kernels of a module that has not been written to a file, after the same checks of its code.

    Parameters
    ----------
    text
        Contents of a generated file.
    folder
        Folder to which the file belongs, or belonged.

    Raises
    ------
    BadInput
        If the text is not what ``satsym derive`` writes.
    """
    return _load_text(name, folder or Path(), Path(name), text)


def check_name(name: str) -> None:
    """Refuse a name that no generated module can have.

    Raises
    ------
    BadInput
        With what a name is.
    """
    if not is_name(name):
        raise BadInput(f"{shown(name)}: the name of a model must be {NAMES}")


def _unknown(model: str) -> str:
    return f"{shown(model)} is not a shipped model; {suggestion(model, shipped())} (`satsym models` lists all)"


def _refuse_ending(model: str) -> NoReturn:
    raise BadInput(
        f"{shown(model)}: leave out the ending .py; a model is a module written by `satsym derive`, not a "
        "derivation file"
    )


def _refuse_derivation(model: str, path: Path, root: Path, text: str) -> None:
    """Refuse a file that states a problem, and advise how to generate the wanted module from it."""
    if _DECLARING not in source_files.imports(text):
        return
    out, stating = (os.path.relpath(place) for place in (root / "generated", path))
    command = printable(shlex.join(["satsym", "derive", stating, "--out", out]), 150)
    found = _STATED.search(text)
    wanted = f"generated/{found[1] if found else path.stem}"
    raise BadInput(f"{shown(model)}: this is a derivation file; run `{command}` and write {shown(wanted)}")


def _lying(name: str) -> tuple[str, Path]:
    """Return the text of a shipped module, empty where it cannot be read, and its folder."""
    module = importlib.import_module(f"{source_files.GENERATED}.{name}")
    loader = module.__loader__
    text = loader.get_source(module.__name__) if isinstance(loader, InspectLoader) else None
    return text or "", Path(module.__file__ or "").parent


def shipped_text(name: str) -> str:
    """Return the text of a shipped module; empty where it cannot be read."""
    return _lying(name)[0]


def _refuse_older(model: str, text: str, folder: Path) -> None:
    """Refuse a module that is older than its derivation file, because that file now states another problem."""
    if (found := changed(text, folder)) is None:
        return
    edited, stating, out = (printable(os.path.relpath(path.resolve()), 150) for path in (*found, folder))
    ours = source_files.is_model(model)
    command = "satsym derive" if ours else shlex.join(["satsym", "derive", stating, "--out", out])
    raise BadInput(f"{shown(model)}: {edited} has changed since this module was derived from it; run `{command}`")


@cache
def _load_shipped(name: str) -> Kernels:
    module = importlib.import_module(f"{source_files.GENERATED}.{name}")
    text, _ = _lying(name)
    if text and not intact(text):
        raise BadInput(f"{shown(name)}: {_EDITED}")
    try:
        return Kernels(ProblemSpec.from_literal(module.MODEL), _defined(vars(module)), origin=(name, None))
    except ValueError as error:
        raise BadInput(f"{shown(name)}: {error}; {_ANEW}") from None


def _resolve(model: str, folder: Path) -> tuple[Path, Path]:
    """Return the file that a relative path names, and the folder that it cannot leave, with symbolic links followed."""
    if Path(model).is_absolute():
        raise BadInput(
            f"{shown(model)}: absolute paths are not allowed; give a path relative to the folder of the instance file"
        )
    if not is_name(model.rpartition("/")[2]):
        raise BadInput(f"{shown(model)}: a file name must be {NAMES}")
    try:
        root = folder.resolve(strict=True)
        path = (root / f"{model}.py").resolve(strict=True)
        regular = path.is_file()
    except (OSError, RuntimeError, ValueError):  # missing, no access, a loop of links, a NUL character
        raise BadInput(
            f"{shown(model)}: no such file; check the path, or write the module with `satsym derive`"
        ) from None
    if not path.is_relative_to(root):
        raise BadInput(
            f"{shown(model)}: lies outside the folder of the instance file; move the module into that folder"
        )
    if not regular:
        raise BadInput(f"{shown(model)}: not a file; give the name of a module written by `satsym derive`")
    return path, root


def _read(model: str, path: Path) -> str:
    """Return the text of the file, read once: the text that is checked is the text that runs."""
    try:
        with path.open("rb") as stream:
            data = stream.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise BadInput(
                f"{shown(model)}: larger than {MOST_BYTES} bytes; give the name of a module written by `satsym derive`"
            )
        return data.decode("utf-8")
    except OSError as error:
        raise BadInput(f"{shown(model)}: cannot be read ({error.strerror}); check its permissions") from None
    except UnicodeDecodeError:
        raise BadInput(
            f"{shown(model)}: not UTF-8 text; give the name of a module written by `satsym derive`"
        ) from None


@lru_cache(maxsize=32)
def _load_file(model: str, root: Path, path: Path, text: str) -> Kernels:
    """Return the kernels of a file that is as it was written and does not contradict itself."""
    from satsym.kernels import consistency

    found = _load_text(model, root, path, text)
    if not intact(text):
        raise BadInput(f"{shown(model)}: {_EDITED}")
    worst = consistency.worst(found, consistency.random_places(found))
    if worst is not None and not worst.deviation <= consistency.LIMIT:
        raise BadInput(f"{shown(model)}: {worst.function} contradicts the other functions ({worst.claim}); {_ANEW}")
    return found


def _load_text(model: str, root: Path, path: Path, text: str) -> Kernels:
    # Imported here: shipped models need no check.
    from satsym.kernels.bodies import Unexpected
    from satsym.kernels.checking import check

    try:
        spec, definitions = check(text)
        code = compile(ast.Module(list(definitions), []), str(path), "exec", dont_inherit=True)
    except Unexpected as error:
        raise BadInput(f"{shown(model)}: line {error.line} {printable(error.reason, 200)}; {_ANEW}") from None
    except (RecursionError, MemoryError, SystemError):  # the last by the parser of some versions
        raise BadInput(f"{shown(model)}: nested too deeply; {_ANEW}") from None
    namespace: dict[str, Any] = {
        "__builtins__": {"float": float, "len": len, "range": range},
        "__name__": f"satsym.loaded.{path.stem}",
        "math": math,
        "np": np,
    }
    exec(code, namespace)  # noqa: S102 - definitions only, each of them checked
    return Kernels(spec, _defined(namespace), origin=(model, root), text=text)


def _defined(namespace: Mapping[str, Any]) -> dict[str, Function]:
    return {name: value for name, value in namespace.items() if isinstance(value, FunctionType)}


def _parts(kernels: Kernels) -> tuple[Callable[..., Kernels], tuple[Any, ...]]:
    """Return how to rebuild kernels in another process: by their source, to be loaded there again."""
    if kernels.origin is None:
        return Kernels, (kernels.spec, kernels.functions, kernels.backend)
    return _restored, (*kernels.origin, kernels.text, kernels.backend)


def _restored(model: str, folder: Path | None, text: str | None, backend: Backend) -> Kernels:
    kernels = load(model, folder) if text is None else from_text(text, model, folder)
    return kernels.compiled() if backend == "numba" else kernels


copyreg.pickle(Kernels, _parts)
