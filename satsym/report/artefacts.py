"""Generated files: rendered in memory from derivation files, and compared with a folder or written as a whole."""

from __future__ import annotations

import difflib
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from satsym.kernels.digest import sealed
from satsym.records import record
from satsym.report import stamps
from satsym.report.results.files import write_text
from satsym.status import BadInput

if TYPE_CHECKING:
    from satsym.kernels import Kernels
    from satsym.symbolic import Derivation, Model, Problem

SUFFIXES = (".py", ".tex", record.SUFFIX)
SIGNATURE = "Written by satsym from "
"""First words of every generated file; files without them are never overwritten or removed."""

KEPT = "__init__.py"
"""The only file in the folder of generated files that is written by hand."""

MAX_SECONDS = 900.0
"""Time limit in seconds for deriving one problem, several times the time of the longest shipped derivation."""

Job: TypeAlias = "tuple[Path, str, Path, float]"
"""A derivation file, the name of a problem in it, the folder of the results, and the time limit."""

FEWEST_IN_PARALLEL = 6
"""Number of problems from which several processes are used to derive them."""


def render(
    paths: Iterable[Path],
    folder: Path,
    announce: Callable[[str], None] = lambda name: None,
    max_seconds: float = MAX_SECONDS,
) -> dict[str, str]:
    """Render all files that derivation files lead to.

    Parameters
    ----------
    folder
        Where it is to be written; modules say where their sources are, seen from there.
    announce
        Told the name of each problem once it is derived.
    max_seconds
        For each of them.

    Returns
    -------
    dict
        File name -> text, each generated module verified against its derivation.

    Raises
    ------
    BadInput
        If a file cannot be read, something cannot be derived, or what was generated deviates from it.
    """
    from satsym.symbolic import loader

    jobs = [(path, problem.name, folder, max_seconds) for path in paths for problem in loader.load(path)]
    return _derived(jobs, announce)


def renew(
    paths: Sequence[Path],
    folder: Path,
    announce: Callable[[str], None] = lambda name: None,
    *,
    fresh: bool = False,
    max_seconds: float = MAX_SECONDS,
) -> dict[str, str | None]:
    """Render as :func:`render` does, but derive nothing that the folder already holds, by the stamps of earlier runs.

    Parameters
    ----------
    paths, announce, max_seconds
        As there.
    fresh
        Derive everything, and keep stamps of it.

    Returns
    -------
    dict
        File name -> text; ``None`` where the file that is there has that text.

    Raises
    ------
    BadInput
        As there; also if a file that would be overwritten was not written by satsym.
    """
    engine = stamps.engine()
    known = {path: None if fresh else stamps.read(path, engine) for path in paths}
    done = {path for path, stamp in known.items() if stamp and stamps.holds(stamp, folder)}
    stated = {path: _stated(path, max_seconds) for path in paths if path not in done}
    _refuse_others((f"{name}{suffix}" for names in stated.values() for name in names for suffix in SUFFIXES), folder)
    jobs = [
        (path, name, folder, max_seconds)
        for path, identities in stated.items()
        for name, identity in identities.items()
        if not stamps.spares(known[path], name, identity, folder)
    ]
    texts = _derived(jobs, announce) | _sealed_anew(stated, jobs, folder)
    for path, identities in stated.items():
        stamps.keep(path, known[path], engine, identities, texts)
    names = [name for path in paths for name in (stated[path] if path in stated else stamps.problems(known[path]))]
    return {f"{name}{suffix}": texts.get(f"{name}{suffix}") for name in names for suffix in SUFFIXES}


def _stated(path: Path, seconds: float) -> dict[str, str]:
    """Map the name of each problem of a derivation file to its identity."""
    from satsym.symbolic import loader
    from satsym.symbolic.declared import identity
    from satsym.symbolic.time_limit import within

    with loader.explained(), within(seconds, str(path)):
        return {problem.name: identity(problem) for problem in loader.load(path)}


def _sealed_anew(stated: Mapping[Path, Mapping[str, str]], jobs: Sequence[Job], folder: Path) -> dict[str, str]:
    """Return the files of unchanged problems in a file that has changed, with the new digest of that file."""
    from satsym.symbolic import loader

    derived, texts = {name for _, name, *_ in jobs}, {}
    for path, names in stated.items():
        for name in names.keys() - derived:
            for suffix in SUFFIXES:
                text = (folder / f"{name}{suffix}").read_text(encoding="utf-8")
                if suffix == ".py":
                    text = sealed(text, folder, loader.stating(path))
                elif suffix == record.SUFFIX:
                    anew = record.with_sources(record.from_text(text), folder, loader.stating(path))
                    text = record.text_of(anew)
                texts[f"{name}{suffix}"] = text
    return texts


def _derived(jobs: Sequence[Job], announce: Callable[[str], None]) -> dict[str, str]:
    """Map file names to texts, for problems of derivation files."""
    rendered: dict[str, str] = {}
    if not jobs:
        return rendered
    from satsym.symbolic import loader

    with loader.explained(), _workers(len(jobs)) as each:
        for (_, name, *_), texts in zip(jobs, each(_rendered, jobs), strict=True):
            announce(name)
            rendered |= texts
    return rendered


@contextmanager
def _workers(jobs: int) -> Iterator[Callable[..., Iterator[Any]]]:
    """Return a map over processes, one for each processor; a few jobs run in this process, which begins at once."""
    if jobs < FEWEST_IN_PARALLEL or (os.cpu_count() or 1) < 2:
        yield map
        return
    with ProcessPoolExecutor(min(jobs, os.cpu_count() or 1), get_context("spawn")) as pool:
        yield pool.map


def _rendered(job: Job) -> dict[str, str]:
    """Render the files of one problem."""
    from satsym.symbolic import derive, loader
    from satsym.symbolic.time_limit import within

    path, name, folder, seconds = job
    problem = next(problem for problem in loader.load(path) if problem.name == name)
    with loader.explained(path, problem), within(seconds, name):
        return files(problem, derive, path, folder)


def files(
    problem: Problem | Model, derive: Callable[[Problem | Model], Derivation], path: Path, folder: Path
) -> dict[str, str]:
    """Map file names to texts for one problem, with the generated module verified against its derivation.

    Parameters
    ----------
    derive
        What derives it, in the convention it is stated in and in that of a minimum.
    path, folder
        The derivation file, which has been loaded, and where these files are to be written.

    Raises
    ------
    DerivationError
        As of :func:`generated`.
    """
    from satsym.report.latex import document as latex
    from satsym.symbolic import loader
    from satsym.symbolic.convention import in_convention, is_minimum

    derivation = derive(problem)
    in_minimum_form = derivation if is_minimum(derivation) else derive(in_convention(problem, "minimum"))
    text, _ = generated(in_minimum_form, source_of(path))
    text = sealed(text, folder, loader.stating(path))
    return {
        f"{problem.name}.py": text,
        f"{problem.name}.tex": latex.render(derivation),
        f"{problem.name}{record.SUFFIX}": recorded_text(derivation, path, folder, loader.stating(path)),
    }


def recorded_text(derivation: Derivation, path: Path, folder: Path, stating: Mapping[Path, str]) -> str:
    """Return the text of a derivation's record, which audits read in place of the file that states it."""
    from satsym.symbolic.lookup.addresses import recorded

    return record.text_of(record.with_sources(recorded(derivation, source_of(path)), folder, stating))


def generated(derivation: Derivation, source: str) -> tuple[str, Kernels]:
    """Return the module of a derivation in the minimum convention, and its kernels, verified against the derivation.

    Parameters
    ----------
    source
        Name of the derivation file, for the header.

    Raises
    ------
    DerivationError
        If what was generated deviates from what was derived.
    """
    from satsym import kernels
    from satsym.codegen import module, verify
    from satsym.symbolic.time_limit import entering

    entering(derivation.name, "of writing its functions")
    text = module.render(derivation, source)
    entering(derivation.name, "of verifying its functions")
    found = kernels.from_text(text, f"{derivation.name}.py")
    verify.verify(derivation, found)
    return text, found


def differences(rendered: Mapping[str, str], folder: Path, whole: bool) -> list[str]:
    """Return unified diffs from the files of a folder to the rendered ones; empty where they agree.

    Parameters
    ----------
    rendered
        File name -> text.
    whole
        Whether the folder should hold nothing else, so that a leftover file is a difference.
    """
    names = set(rendered)
    if whole and folder.is_dir():
        names |= {p.name for p in folder.iterdir() if p.name.endswith(SUFFIXES) and p.name != KEPT}
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
    """Write the rendered files, each whole or not at all, and return their paths.

    Raises
    ------
    BadInput
        If a file of such a name was not written by satsym.
    """
    _refuse_others(rendered, folder)
    written = []
    for name, text in rendered.items():
        write_text(folder / name, text)
        written.append(folder / name)
    return written


def _refuse_others(names: Iterable[str], folder: Path) -> None:
    for path in (folder / name for name in names):
        if path.is_file() and SIGNATURE not in path.read_text("utf-8", "replace"):
            raise BadInput(
                f"{path}: this file exists and was not written by satsym; give another folder, or rename the problem"
            )


def source_of(path: Path) -> str:
    """Return the name by which a generated file cites its source: relative to the project, if the source is in it."""
    place = path.parent
    if place.name == "derivations":
        return f"{place.name}/{path.name}"
    inside = place.name == "examples" and place.parent.name == "derivations"
    return f"{place.parent.name}/{place.name}/{path.name}" if inside else path.name
