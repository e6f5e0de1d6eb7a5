"""Pictures of analyses, regulators and comparisons, drawn again from the instances that a result.json names.

Trajectories are read back; the numbers behind the pictures of these commands are not saved, because they are computed
quickly.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from satsym import instance
from satsym.cli.output import live
from satsym.cli.saving import DRAWN
from satsym.instance import Instance
from satsym.instance.numbers import changed
from satsym.report.results import sets
from satsym.report.results.objects import file_of, head, head_about
from satsym.report.results.set_list import LIST, unusable
from satsym.status import Status
from satsym.wording import printable

if TYPE_CHECKING:
    from satsym.report.look import Look
    from satsym.report.results.files import Content
    from satsym.report.results.sets import Found


class _File(msgspec.Struct):
    name: str
    digest: str


class _Of(msgspec.Struct):
    """An instance that a result belongs to."""

    instance: str | None
    model: str | None
    instance_file: _File | None = None


class _Written(_Of):
    """The part of result.json that is read back."""

    settings: dict[str, float] = msgspec.field(name="set", default_factory=dict)
    instances: list[_Of] = []


Drawn = tuple[dict[str, Any], str, dict[str, "Content"]]
"""The head of an object about pictures, a title, and the pictures."""


def named_in(folder: Path) -> str | None:
    """Return the instance or model of the result in a folder, as a command takes it; ``None`` without a result.

    Raises
    ------
    BadInput
        If its result.json cannot be read.
    """
    if sets.command_of(folder) not in DRAWN:
        return None
    written = _written(sets.read(folder))
    file = written.instance_file.name if written.instance_file else ""
    return file if file and Path(file).is_file() else written.instance or written.model


def redrawn(subject: str, found: Found, look: Look) -> Drawn:
    """Draw the pictures of a result of ``satsym analyse``, ``lqr`` or ``compare`` again.

    Parameters
    ----------
    subject
        The instance or the model that it is of, of several the first.
    found
        The result.

    Raises
    ------
    BadInput
        If the result cannot be read, is of something else, or of an instance that has changed since.
    """
    written = _written(found)
    return (
        _of_several(subject, written, found, look)
        if found.command == "compare"
        else _of_one(subject, written, found, look)
    )


def _written(found: Found) -> _Written:
    try:
        return msgspec.json.decode(found.result, type=_Written)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise unusable(found.folder / LIST, f"cannot be read ({printable(str(error))})", found.command) from None


def _of_one(subject: str, written: _Written, found: Found, look: Look) -> Drawn:
    from satsym.analysis.subject import find

    given = find(subject)
    own, spec = (given, given.model.spec) if isinstance(given, Instance) else (None, given.spec)
    _require_same(written, own, spec.name, found, written.settings)
    if own and written.settings:
        given = changed(own, written.settings)
    if found.command == "lqr":
        from satsym.analysis.regulator.feedback import designed
        from satsym.report.plots.systems import of_design

        pictures = of_design(designed(given), look)
    else:
        from satsym.analysis.subject import examined
        from satsym.report.plots.systems import of_subject
        from satsym.report.results.linear import attitudes

        pictures = of_subject(given, *examined(given), attitudes(given), look)
    return head_about("plot", given, Status.CONVERGED), (own.title if own else "") or spec.title, pictures


def _of_several(subject: str, written: _Written, found: Found, look: Look) -> Drawn:
    from satsym.analysis import comparison
    from satsym.report.plots.comparison import pictures

    first = instance.load(subject)
    loaded = list(_loaded(first, written))
    for one, case in zip(written.instances, loaded, strict=True):
        _require_same(one, case, case.model.spec.name, found)
    with live() as line:
        cases = comparison.compare(loaded, line.show)
    status = Status.CONVERGED if all(case.answered for case in cases) else Status.NOT_CONVERGED
    title = ", ".join(case.name for case in loaded)
    return head("plot", first.model.spec, None, status), title, pictures(cases, look)


def _loaded(first: Instance, written: _Written) -> Iterator[Instance]:
    """Load the instances from their files beside that of the first, or else by name."""
    for one in written.instances:
        beside = first.path.parent / (one.instance_file.name if one.instance_file else "")
        yield instance.load(str(beside) if beside.is_file() else one.instance or "")


def _require_same(
    written: _Of, given: Instance | None, model: str, found: Found, settings: dict[str, float] | None = None
) -> None:
    """Refuse a result of an instance that has changed since, or that is not of the model."""
    listing, own = found.folder / LIST, given.name if given else None
    more = "".join(f" --set {printable(name)}={value!r}" for name, value in (settings or {}).items())
    if (written.model, written.instance) != (model, own):
        theirs = printable(f"{written.instance or written.model} (model {written.model})")
        raise unusable(listing, f"belongs to {theirs}, not to {own or model} (model {model})", found.command, more)
    file = file_of(given) if given else None
    if file and written.instance_file and file["digest"] != written.instance_file.digest:
        raise unusable(listing, f"was computed from {own} before its file was changed", found.command, more)
