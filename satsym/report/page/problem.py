"""The problem as a section: what is to be minimised, where the motion begins and ends, and what bounds the controls."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from satsym.control_set import stated_constraints
from satsym.instance import Instance
from satsym.instance.files import text as text_of
from satsym.report.display import unit_text
from satsym.report.html.markup import Markup, joined, tag
from satsym.report.page import answer
from satsym.report.results.objects import file_of, time_unit
from satsym.report.said import decimal, message, say
from satsym.report.terminal.table import figure
from satsym.report.texts import Texts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from satsym.report.page.derived import Derived


DIGITS = 10
"""Significant digits of given numbers."""


def problem(instance: Instance, statement: Derived | None, values: Sequence[str], texts: Texts) -> Markup:
    """The statement, as far as it is at hand, and the numbers of the instance.

    Parameters
    ----------
    statement
        The derivation of the model.
    values
        What stands in place of numbers of the file, each as ``KEY=VALUE``.
    """
    return joined(
        statement.statement() if statement else "",
        tag("h3", texts.get("page", "instance")),
        answer.table(texts.get("page", "conditions"), _conditions(instance, texts)),
        answer.table(texts.get("page", "admissible"), rows) if len(rows := _admissible(instance)) > 1 else "",
        tag("p", _times(instance, texts)),
        _file(instance, values, texts),
    )


def _conditions(instance: Instance, texts: Texts) -> list[tuple[str, ...]]:
    """Below a header, a row for each state: where it begins and where it is to end."""
    rows: list[tuple[str, ...]] = [
        (say("state"), say("initial"), say("final"), say("unit"), texts.get("words", "meaning").lower())
    ]
    free = {unknown.name for unknown in instance.free}
    for variable, initial in zip(instance.model.spec.states, instance.initial, strict=True):
        name = variable.symbol
        begin = say("free") if name in free else figure(initial, DIGITS)
        rows.append((name, begin, _final(instance, name), variable.unit, say(variable.meaning)))
    return rows


def _final(instance: Instance, name: str) -> str:
    """What is asked of a state at the end."""
    if name in instance.ranges:
        lower, upper = (figure(end, DIGITS) if math.isfinite(end) else say("free") for end in instance.ranges[name])
        return f"[{lower}, {upper}]"
    value = instance.final.get(name)
    if value is None:
        return say("free")
    return message(value) if isinstance(value, str) else figure(value, DIGITS)


def _admissible(instance: Instance) -> list[tuple[str, ...]]:
    """Below a header, a row for each bound of controls and each path constraint."""
    spec = instance.model.spec
    rows: list[tuple[str, ...]] = [(say("control"), say("lower bound"), say("upper bound"), say("unit"))]
    for variable, *bounds in zip(spec.controls, instance.lower, instance.upper, strict=True):
        if any(map(math.isfinite, bounds)):
            rows.append((variable.symbol, *(figure(b) if math.isfinite(b) else "" for b in bounds), variable.unit))
    for norm in instance.bounded_norms:
        lower = figure(norm.lower) if norm.lower else ""
        rows.append((f"|{norm.name or 'u'}|", lower, figure(norm.upper), norm.unit))
    rows += [(name.replace("_", " "), "", "0", "1") for name in stated_constraints(spec)]
    return rows


def _times(instance: Instance, texts: Texts) -> str:
    unit = unit_text(time_unit(instance.model.spec) or "1")

    def said(time: float) -> str:
        return f"{decimal(figure(time, DIGITS))} {unit}".rstrip()

    if instance.tf is None:
        return texts.get("page", "until_free", begin=said(instance.t0))
    return texts.get("page", "between", begin=said(instance.t0), end=said(instance.tf))


def _file(instance: Instance, values: Sequence[str], texts: Texts) -> Markup:
    """The file as it was read, and what stood in place of its numbers."""
    file = file_of(instance)
    if file is None:
        return Markup()
    about = texts.get("page", "file", name=file["name"], digest=file["digest"])
    text = tag("pre", tag("code", text_of(instance.path)), tabindex="0")
    instead = texts.get("page", "instead", values=", ".join(values))
    return joined(tag("details", tag("summary", about), text), tag("p", instead) if values else Markup())
