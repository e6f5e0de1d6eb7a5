"""What the commands that derive share: where the checkout is, finding a problem, and errors in one line."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import satsym
from satsym.status import BadInput
from satsym.wording import printable, suggestion

if TYPE_CHECKING:
    from satsym.symbolic import Model, Problem


def checkout() -> Path | None:
    """The folder that holds derivations/ and generated/ as people edit them; ``None`` where satsym is installed."""
    home = Path(satsym.__file__).resolve().parent.parent
    return home if (home / "pyproject.toml").is_file() and (home / "derivations").is_dir() else None


@contextmanager
def explained() -> Iterator[None]:
    """Turns what is wrong with a derivation into bad input: one line, no traceback."""
    try:
        yield
    except Exception as error:
        derivation = sys.modules.get("satsym.symbolic.derivation")  # takes its time, and may not have been needed
        if derivation is None or not isinstance(error, derivation.DerivationError):
            raise
        raise BadInput(" ".join(str(error).split())) from error


def find(name: str) -> Problem | Model:
    """The problem of a shipped name, ``FILE.py`` where it states a single one, or ``FILE.py:NAME``.

    Raises
    ------
    BadInput
        If there is none, or more than one.
    """
    from satsym.symbolic import loader

    file, _, wanted = name.rpartition(":") if ".py:" in name else (name if name.endswith(".py") else "", "", name)
    paths = [loader.find(file)] if file else loader.shipped()
    found = {problem.name: problem for path in paths for problem in loader.load(path)}
    if file and wanted == name:
        if len(found) > 1:
            raise BadInput(f"{printable(file)}: states {', '.join(found)}; say which, as in {file}:{next(iter(found))}")
        return next(iter(found.values()))
    if wanted not in found:
        raise BadInput(f"{printable(name)}: no derivation of this name; {suggestion(wanted, found)}")
    return found[wanted]
