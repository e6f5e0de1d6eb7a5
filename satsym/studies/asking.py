"""A study from an instance, its ``[study]`` table, and what is said besides."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any, TypeVar

import msgspec

from satsym import methods
from satsym.instance import Instance
from satsym.instance.schema import StudyTable
from satsym.status import BadInput
from satsym.studies import reading
from satsym.studies.asked import Checked, Command, Study
from satsym.studies.design import texts
from satsym.studies.reading import Written
from satsym.wording import shown, suggestion

Choice = TypeVar("Choice", bound=Enum)


class Options(msgspec.Struct, frozen=True):
    """What is said besides the design; ``None`` leaves it to the table, or to the default."""

    command: str | None = None
    certificate: str | None = None
    feedback: str | None = None
    trajectories: bool = False


def asked(instance: Instance, table: Mapping[str, Any], design: Written, options: Options) -> Study:
    """A study, every part of it checked.

    Parameters
    ----------
    instance
        What is varied.
    table
        Its ``[study]``, as it was written.
    design
        What varies; if anything does, the table's design is left aside.
    options
        Instead of the table's.

    Raises
    ------
    BadInput
        With one line, before anything is computed or written.
    """
    stated = StudyTable(**table)
    written = design
    if not design:
        kinds: dict[str, Any] = {name: texts(getattr(stated, name)) for name in ("vary", "normal", "uniform")}
        drawn: dict[str, Any] = {
            name: getattr(stated, name) if (said := getattr(design, name)) is None else said
            for name in ("sample", "method", "seed")
        }
        written = Written(**kinds, **drawn)
    command = _one(Command, options.command or stated.command or Command.SOLVE.value, "command")
    checked = _one(Checked, options.certificate or stated.certificate or Checked.LOCAL.value, "certificate")
    feedback = options.feedback or stated.feedback
    _refuse(instance, command, feedback)
    found = reading.design(written, instance)
    return Study(
        instance,
        found,
        command,
        checked,
        feedback,
        compiled=instance.solver.backend == "numba",
        trajectories=options.trajectories or stated.trajectories,
    )


def _refuse(instance: Instance, command: Command, feedback: str | None) -> None:
    """Refuse what no row can have."""
    spec = instance.model.spec
    if command is not Command.SIMULATE and feedback is not None:
        raise BadInput(f'feedback: is for "simulate", and this study is of "{command.value}"; remove it')
    if command is Command.SOLVE:
        if not spec.has_cost:
            raise BadInput(f"{instance.name}: model {spec.name} has no cost, so there is nothing to solve")
        if refusal := methods.refusal(instance.solver.method, instance):
            raise BadInput(f"{instance.name}: {refusal}")
        return
    instance.require_numbers()
    from satsym.analysis.regulator.feedback import FEEDBACKS

    if feedback is not None and feedback not in FEEDBACKS:
        raise BadInput(f"feedback: {shown(feedback)}: {suggestion(feedback, FEEDBACKS)}")
    if (command is Command.LQR or feedback == "lqr") and instance.lqr is None:
        raise BadInput(f"{instance.name}: has no table [lqr]; add one with Q and R")


def _one(choices: type[Choice], name: str, key: str) -> Choice:
    """A member of an enum by its value."""
    known = [str(each.value) for each in choices]
    if name not in known:
        raise BadInput(f"{key}: {shown(name)}: {suggestion(name, known)}")
    return choices(name)
