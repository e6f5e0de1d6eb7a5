"""Construction of a study from an instance, its ``[study]`` table, and options of the command line or of Python."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import msgspec

from satsym import instance as instances
from satsym import methods
from satsym.choices import FEEDBACKS, Checked, Command
from satsym.instance import Instance, Written
from satsym.instance.numbers import changed
from satsym.instance.schema import StudyTable
from satsym.instance.schema import study as checked
from satsym.status import BadInput
from satsym.studies import reading
from satsym.studies.asked import Study
from satsym.wording import shown, suggestion

OF_COMMANDS = {
    "certificate": (Command.SOLVE,),
    "feedback": (Command.SIMULATE,),
    "trajectories": (Command.SOLVE, Command.SIMULATE),
}
"""Option -> the commands that have this option."""


def asked(
    written: Written,
    case: Instance,
    said: Mapping[str, Any],
    subject: str = "",
    settings: Mapping[str, float] = MappingProxyType({}),
) -> Study:
    """Return a study after checks of every part of it.

    Parameters
    ----------
    written, case
        The instance whose numbers are varied, as it was written and as it was read.
    said
        Keys of the table ``[study]`` and their values, instead of those there; ``None`` leaves a key to the table.
        If anything varies by this, what varies by the table is left aside.
    subject
        Name of the instance on the command line.
    settings
        Other values of some numbers by key, for all rows.

    Raises
    ------
    BadInput
        With one line, before anything is computed or written.
    """
    case = changed(case, settings)
    stated = checked(written.tree.get("study", {}))
    given = checked({name: value for name, value in said.items() if value is not None})
    design = given
    if not (given.vary or given.normal or given.uniform):
        drawn = {name: value for name in ("sample", "method", "seed") if (value := getattr(given, name)) is not None}
        design = msgspec.structs.replace(stated, **drawn)
    command = Command(given.command or stated.command or Command.SOLVE)
    options = {name: _option(name, command, given, stated) for name in OF_COMMANDS}
    _refuse(case, command, options["feedback"])
    study = Study(
        case,
        reading.design(design, case),
        command,
        Checked(options["certificate"] or Checked.LOCAL),
        options["feedback"],
        compiled=case.solver.backend == "numba",
        trajectories=bool(options["trajectories"]),
        subject=subject,
        settings=settings,
    )
    for key in study.design.keys:
        if key.text in settings:
            raise BadInput(
                f"--set {key.text}: is varied in this study, so it cannot be set as well; remove it, or leave it "
                "out of the varied keys"
            )
    return replace(study, compiled=True) if case.solver.backend == "auto" and _worth_compiling(study) else study


FEWEST_ROWS_COMPILED = 1000
"""Number of rows above which code is compiled without a request."""


def _worth_compiling(study: Study) -> bool:
    """Tell whether enough rows are solved together for compilation to pay, and a compiler is installed."""
    from satsym.kernels.batch.compiling import able

    if study.design.count < FEWEST_ROWS_COMPILED or study.command is not Command.SOLVE or not able():
        return False
    from satsym.studies.together import together

    return together(study.task) is not None


def named(written: Written) -> str | None:
    """Return the name of an instance on the command line; ``None`` where its tables are not those of a file."""
    if written.model is not None:
        return None
    shipped = written.path == instances.files.SHIPPED / f"{written.name}.toml"
    subject = written.name if shipped else str(written.path)
    try:
        same = instances.read(subject).tree == written.tree
    except BadInput:
        same = False
    return subject if same else None


def _option(name: str, command: Command, given: StudyTable, stated: StudyTable) -> Any:
    """Return an option, from the call or from the table, unless the table is about another command."""
    fitting = command in OF_COMMANDS[name]
    for table, binding in ((given, True), (stated, given.command in (None, stated.command))):
        value = getattr(table, name)
        if value and fitting:
            return value
        if value and binding:
            wanted = " or ".join(f'"{each.value}"' for each in OF_COMMANDS[name])
            raise BadInput(f'{name}: applies to {wanted}, but this study runs "{command.value}"; remove it')
    return None


def _refuse(case: Instance, command: Command, feedback: str | None) -> None:
    """Refuse requests that no row can fulfil."""
    spec = case.model.spec
    if command is Command.SOLVE:
        if not spec.has_cost:
            raise BadInput(f"{case.called}: model {spec.name} has no cost, so there is nothing to solve")
        if refusal := methods.refusal(case.solver.method, case):
            raise BadInput(f"{case.called}: {refusal}")
        return
    case.require_numbers()
    if feedback is not None and feedback not in FEEDBACKS:
        raise BadInput(f"feedback: {shown(feedback)}: {suggestion(feedback, FEEDBACKS)}")
    if (command is Command.LQR or feedback == "lqr") and case.lqr is None:
        raise BadInput(f"{case.called}: has no table [lqr]; add a table [lqr] with Q and R")
