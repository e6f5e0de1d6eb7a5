"""Studies from beginning to end: what is asked is written down, missing rows are computed, and all is merged."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from satsym.report.look import SCREEN, Look
from satsym.report.results import sets, studies
from satsym.report.results.files import Content, check_writable, opened, to_json, write_text
from satsym.report.results.studies import ASKED, TABLE, Merged
from satsym.status import BadInput
from satsym.studies import parts
from satsym.studies.asked import Study, differences
from satsym.studies.running import Watch, run
from satsym.wording import printable

LOG = "times.log"
"""When chunks were done and how long they took: not of the results, for it is never twice the same."""

LARGEST = 2**24
"""Bytes of a study.json that are read."""


def carry_out(
    study: Study,
    folder: Path,
    executor: Callable[[], Executor],
    at_once: int,
    *,
    resume: bool = False,
    watch: Watch = lambda _: None,
) -> dict[str, Any]:
    """Carry out a study, or what is missing of it; what result.json holds.

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
        Told after each chunk how far the study is.

    Raises
    ------
    BadInput
        If there is a study already and it is not to be resumed, or is another one; or the folder cannot be written to.
    """
    check_writable(folder)
    found = _found(study, folder, resume)
    if found is not None:
        parts.remove(folder)  # which a process that was killed may have left
        return found
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not (folder / ASKED).exists():
            write_text(folder / ASKED, to_json(studies.asked_object(study)))
        with parts.opened(folder) as kept, _log(folder) as log:
            if len(kept.done) < study.chunks:
                with executor() as workers:
                    run(study, kept, workers, at_once, watch, log=log)
            merged = Merged(study, kept)
            result = studies.study_object(merged)
            files: dict[str, Content] = {TABLE: studies.table(merged), **studies.trajectories(merged)}
            sets.write(folder, result, files)
        parts.remove(folder)
    except OSError as error:
        reason = error.strerror or "the path leads nowhere"
        raise BadInput(
            f"{printable(str(folder))}: cannot be written ({reason}); see to it, and go on with --resume"
        ) from None
    return result


def _found(study: Study, folder: Path, resume: bool) -> dict[str, Any] | None:
    """What result.json holds of this very study, if that is done; refuses any other."""
    before = asked(folder)
    if before is None:
        return None
    if not resume:
        raise BadInput(f"{printable(str(folder))}: holds a study; add --resume to go on, or give another folder")
    if changed := differences(before, study.identity):
        more = f", and {len(changed) - 3} more" if len(changed) > 3 else ""
        raise BadInput(
            f"{printable(str(folder))}: holds another study: {'; '.join(changed[:3])}{more}; give another folder"
        )
    if sets.written_at(folder) is None or sets.command_of(folder) != "study":
        return None
    found: dict[str, Any] = json.loads(sets.read(folder).result)
    found.pop("files")
    return found


def draw(folder: Path, look: Look = SCREEN, out: Path | None = None) -> tuple[dict[str, Any], list[Path]]:
    """Draw the study of a folder; what its result.json holds, and the pictures, which are there, or in another folder.

    Raises
    ------
    BadInput
        If there is no whole one, or pictures cannot be written.
    """
    from satsym.report.plots import studies as plots

    found = sets.read(folder)
    if found.command != "study" or TABLE not in found.listed:
        raise BadInput(f"{printable(str(folder))}: holds the result of {printable(found.command)}, and no study")
    said: dict[str, Any] = json.loads(found.result)
    pictures = plots.pictures(studies.numbers(folder / TABLE, said), look)
    if out is None or out.resolve() == folder.resolve():
        return said, sets.extend(found, pictures)
    if (other := sets.command_of(out)) not in (None, "plot"):
        raise BadInput(f"{printable(str(out))}: holds the result of {other}; give another folder for pictures")
    return said, sets.write(out, {**said, "command": "plot"}, pictures)[:-1]


def asked(folder: Path) -> dict[str, str] | None:
    """What the study of a folder depends on, if there is one.

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
            said = json.loads(stream.read(min(size, LARGEST)))["asked"]
        return {str(name): str(value) for name, value in said.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        raise BadInput(f"{printable(str(path))}: cannot be read; give another folder, or remove this one") from None


@contextmanager
def _log(folder: Path) -> Iterator[Callable[[str], None]]:
    """Appends lines with the time; a log that cannot be written ends no study."""
    import time

    with (folder / LOG).open("a", encoding="utf-8") as stream:

        def line(said: str) -> None:
            try:
                stream.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {os.getpid()} {said}\n")
                stream.flush()
            except OSError:
                return

        yield line
