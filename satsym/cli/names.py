"""Names for shell completion, from lists of files alone; and the folder of the checkout."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import chain
from pathlib import Path

import click
from click.shell_completion import CompletionItem

import satsym

FILES = (".py", ".toml")

Completed = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def completed(*kinds: Callable[[], Iterable[str]]) -> Completed:
    """Return the completion of an argument that names one of these kinds, or a file of the folder.

    Where no name fits, the shell looks for paths; bash cannot take names and paths together.
    """

    def complete(_context: click.Context, _argument: click.Parameter, begun: str) -> list[CompletionItem]:
        own = (path.name for path in Path().glob("*.*") if path.suffix in FILES)
        names = chain(*(kind() for kind in kinds), sorted(own))
        found = [CompletionItem(name) for name in names if name.startswith(begun)]
        return found or [CompletionItem(begun, type="file")]

    return complete


def instances() -> Iterable[str]:
    """Return the names of shipped instances."""
    from satsym.instance import files

    return files.shipped()


def models() -> Iterable[str]:
    """Return the names of shipped models."""
    from satsym import source_files

    return source_files.models()


def derivations() -> Iterable[str]:
    """Return the names of shipped derivation files."""
    from satsym import source_files

    return (path.stem for path in source_files.shipped())


def documents() -> Iterable[str]:
    """Return the names of the documents that are audited."""
    from satsym import source_files

    return (path.name for path in source_files.documents())


def checkout() -> Path | None:
    """Return the folder with derivations/ and generated/ of a checkout; ``None`` where satsym is installed."""
    home = Path(satsym.__file__).resolve().parent.parent
    return home if (home / "pyproject.toml").is_file() and (home / "derivations").is_dir() else None
