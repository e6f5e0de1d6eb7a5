"""Studies as a whole: the request is saved, missing rows are computed, and all rows are merged."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from satsym.choices import Command, TableFormat
from satsym.report.look import SCREEN, Look
from satsym.report.results import sets, studies, study_table
from satsym.report.results.files import Content, check_writable, opened, to_json, write_text
from satsym.report.results.set_list import ASKED, LIST, STUDY
from satsym.report.results.studies import TRAJECTORIES, Merged
from satsym.report.results.study_table import path_of
from satsym.status import BadInput
from satsym.studies import branches, parts
from satsym.studies.asked import Study, differences
from satsym.studies.parts import Parts
from satsym.studies.rows import PASSING
from satsym.studies.running import Watch, run
from satsym.wording import printable, shown, suggestion

LOG = "times.log"
"""Name of the file with the times at which chunks were finished.

It is not part of the results, which are reproducible.
"""

MOST_BYTES_READ, NUMBER = 2**24, 8
"""Largest size of a study.json that is read, and size of a number, both in bytes."""


def carry_out(
    study: Study,
    folder: Path,
    executor: Callable[[], Executor],
    at_once: int,
    *,
    resume: bool = False,
    watch: Watch = lambda _: None,
    more: Mapping[str, Content] = MappingProxyType({}),
) -> dict[str, Any]:
    """Carry out a study, or its missing part; return the contents of result.json.

    Parameters
    ----------
    study
        What is asked.
    folder
        Where it goes.
    executor
        Makes what runs chunks, once it is needed.
    at_once
        Chunks that are under way at a time.
    resume
        Whether a study may be there, which must be this one.
    watch
        Called after each chunk with how far the study is.
    more
        Files that belong to it besides.

    Raises
    ------
    BadInput
        If the folder holds anything else than this study, or that and it is not to be resumed, or cannot be written to.
    """
    check_writable(folder)
    _refuse_other(study, folder, resume)
    if (done := _done(folder)) is not None:
        parts.remove(folder)  # which a process that was killed may have left
        return done
    if not (folder / ASKED).exists():
        _refuse_too_large(study, folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with parts.opened(folder, study.digest) as kept:
            _refuse_other(study, folder, resume)  # again, for now no other process comes in between
            if (done := _done(folder)) is None:
                done = _carried_out(study, kept, folder, executor, at_once, watch, more)
        if not _passing(done):  # else the others are wanted once more
            parts.remove(folder)
    except OSError as error:
        reason = error.strerror or "the path cannot be resolved"
        raise BadInput(
            f"{printable(str(folder))}: cannot be written ({reason}); free some space, then repeat the command "
            "with --resume"
        ) from None
    return done


def written_as(study: Study, form: str | None) -> Study:
    """Return a study whose table is written in the named format.

    Raises
    ------
    BadInput
        If there is no such form, or what writes it is not installed.
    """
    if form is None:
        return study
    if form not in TableFormat.names():
        raise BadInput(f"table: {shown(form)} is unknown; {suggestion(form, TableFormat.names())}")
    if form == TableFormat.PARQUET.value:
        study_table.require()
    return replace(study, table=TableFormat(form))


def _carried_out(
    study: Study,
    kept: Parts,
    folder: Path,
    executor: Callable[[], Executor],
    at_once: int,
    watch: Watch,
    more: Mapping[str, Content],
) -> dict[str, Any]:
    if not (folder / ASKED).exists():
        write_text(folder / ASKED, to_json(studies.asked_object(study)))
    merged = Merged(study, kept)
    if len(kept.done) < study.chunks or branches.looked_for(study):
        with _log(folder) as log, executor() as workers:
            run(study, kept, workers, at_once, watch, log=log)
            if branches.looked_for(study):
                merged = replace(merged, branches=branches.followed(study, merged.rows(), workers))
    result = studies.study_object(merged)
    sets.write(folder, result, {**studies.files(merged), **more})
    return result


def _refuse_other(study: Study, folder: Path, resume: bool) -> None:
    """Refuse a folder that holds anything but this study, or this study if it is not to be resumed."""
    sets.keep_apart(folder, STUDY)
    before = asked(folder)
    if before is None:
        known = sets.listed(folder)
        for name in (study.table.file, TRAJECTORIES.format(0), LIST):
            if (folder / name).exists() and name not in known:  # it would be lost
                raise BadInput(
                    f"{printable(str(folder))}: contains {name}, which does not belong to a study; give "
                    "another folder, or remove it"
                )
        return
    if not resume:
        raise BadInput(
            f"{printable(str(folder))}: contains a study; add --resume to continue the study, or give another folder"
        )
    if changed := differences(before, study.identity):
        more = f", and {len(changed) - 3} more" if len(changed) > 3 else ""
        raise BadInput(
            f"{printable(str(folder))}: contains another study: {'; '.join(changed[:3])}{more}; give another folder"
        )


def _done(folder: Path) -> dict[str, Any] | None:
    """Return the result.json of a finished study whose rows are all final; else ``None``."""
    try:
        found: dict[str, Any] = json.loads(sets.read(folder).result)
    except BadInput:
        return None
    found.pop("files")
    return None if _passing(found) else found


def _passing(done: Mapping[str, Any]) -> bool:
    """Tell whether there are rows that another run may answer."""
    return any(status in done["statuses"] for status in PASSING)


def _refuse_too_large(study: Study, folder: Path) -> None:
    """Refuse trajectories for which there is no space: first in chunks, then in files."""
    if not study.trajectories:
        return
    spec, solver, rows = study.instance.model.spec, study.instance.solver, study.design.count
    states = len(spec.states) * (2 if study.command is Command.SOLVE else 1)
    wanted = 2 * rows * NUMBER * (solver.steps + 1) * (1 + states + len(spec.controls))
    place = next(place for place in (folder, *folder.absolute().parents) if place.is_dir())
    free = shutil.disk_usage(place).free
    if wanted > free:
        raise BadInput(
            f"{printable(str(folder))}: the trajectories of {rows} cases need {wanted / 1e9:.3g} GB, but only "
            f"{free / 1e9:.3g} GB are free; request fewer cases or steps, or leave out the trajectories"
        )


def is_study(folder: Path) -> bool:
    """Tell whether a folder holds a study, finished or not."""
    try:
        command = sets.command_of(folder)
    except BadInput:
        command = None
    return command == STUDY or (command is None and (folder / ASKED).is_file())


def draw(folder: Path, look: Look = SCREEN, out: Path | None = None) -> tuple[dict[str, Any], list[Path]]:
    """Draw the study of a folder; return its result.json and the pictures, there or in another folder.

    Raises
    ------
    BadInput
        If there is no whole one, or pictures cannot be written.
    """
    from satsym.report.plots import studies as plots

    if sets.written_at(folder) is None:
        raise BadInput(f"{printable(str(folder))}: that study is not finished; continue it: `satsym study X --resume`")
    found = sets.read(folder)
    if found.command != STUDY or path_of(folder).name not in found.listed:
        raise BadInput(f"{printable(str(folder))}: contains the result of {printable(found.command)}, not a study")
    said: dict[str, Any] = json.loads(found.result)
    pictures = plots.pictures(studies.numbers(path_of(folder), said), look)
    if out is None or out.resolve() == folder.resolve():
        return said, sets.extend(found, pictures)
    sets.keep_apart(out, "plot")
    return said, sets.write(out, {**said, "command": "plot"}, pictures)[:-1]


def asked(folder: Path) -> dict[str, str] | None:
    """Return the identity of the study in a folder, if there is one.

    Raises
    ------
    BadInput
        If it cannot be read.
    """
    path = folder / ASKED
    if not path.exists():
        return None
    try:
        with opened(path) as (stream, size):
            said = json.loads(stream.read(min(size, MOST_BYTES_READ)))["asked"]
        return {str(name): str(value) for name, value in said.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        raise BadInput(f"{printable(str(path))}: cannot be read; give another folder") from None


@contextmanager
def _log(folder: Path) -> Iterator[Callable[[str], None]]:
    """Return a function that appends lines with the time; a log that cannot be written does not end a study."""
    import time

    with (folder / LOG).open("a", encoding="utf-8") as stream:

        def line(said: str) -> None:
            try:
                stream.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {os.getpid()} {said}\n")
                stream.flush()
            except OSError:
                return

        yield line
