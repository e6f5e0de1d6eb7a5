"""The machine-written folder: what derivation files lead to, rendered in memory, compared or written whole."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from satsym.report.files import write_text

SUFFIXES = (".py", ".tex")
KEPT = "__init__.py"
"""The one file of the generated folder that people write."""


def render(paths: Iterable[Path], announce: Callable[[str], None] = lambda name: None) -> dict[str, str]:
    """Everything that derivation files lead to.

    Parameters
    ----------
    paths
        Derivation files.
    announce
        Told the name of each problem before it is derived.

    Returns
    -------
    dict
        File name -> text, each generated module verified against its derivation.

    Raises
    ------
    BadInput
        If a file cannot be read.
    DerivationError
        If something cannot be derived, or what was generated deviates from it.
    """
    from satsym import kernels
    from satsym.codegen import module, verify
    from satsym.report import latex
    from satsym.symbolic import derive, loader

    rendered: dict[str, str] = {}
    for path in paths:
        for problem in loader.load(path):
            announce(problem.name)
            derivation = derive(problem)
            text = module.render(derivation, _source(path))
            verify.verify(derivation, kernels.from_text(text, f"{problem.name}.py"))
            rendered[f"{problem.name}.py"] = text
            rendered[f"{problem.name}.tex"] = latex.render(derivation)
    return rendered


def differences(rendered: Mapping[str, str], folder: Path, whole: bool) -> list[str]:
    """Unified diffs from the files of a folder to what was rendered; empty where they agree.

    Parameters
    ----------
    rendered
        File name -> text.
    folder
        Where the files should be.
    whole
        Whether the folder should hold nothing else, so that a leftover file is a difference.
    """
    names = set(rendered)
    if whole and folder.is_dir():
        names |= {p.name for p in folder.iterdir() if p.suffix in SUFFIXES and p.name != KEPT}
    found = []
    for name in sorted(names):
        path = folder / name
        there = path.read_text(encoding="utf-8") if path.is_file() else ""
        lines = difflib.unified_diff(
            there.splitlines(keepends=True),
            rendered.get(name, "").splitlines(keepends=True),
            str(path) if there else "(no such file)",
            f"{name} as derived now" if name in rendered else "(no derivation leads to it)",
        )
        if diff := "".join(lines):
            found.append(diff)
    return found


def write(rendered: Mapping[str, str], folder: Path) -> list[Path]:
    """Write what was rendered, each file whole or not at all; the paths."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name, text in rendered.items():
        write_text(folder / name, text)
        written.append(folder / name)
    return written


def _source(path: Path) -> str:
    """How a generated file names its source: relative to the project where it is part of it, else by name."""
    return f"{path.parent.name}/{path.name}" if path.parent.name == "derivations" else path.name
