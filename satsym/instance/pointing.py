"""The tables [classical], [switching], [driven] and [limits] of an instance, checked against its model."""

from __future__ import annotations

from collections.abc import Mapping

from satsym.instance.resolve import known, quantity, time, value_of
from satsym.instance.schema import ClassicalTable, DrivenTable, SwitchingTable
from satsym.instance.types import ClassicalOptions, DrivenOptions
from satsym.spec import ProblemSpec
from satsym.status import BadInput
from satsym.wording import shown


def classical(table: ClassicalTable | None, spec: ProblemSpec) -> ClassicalOptions | None:
    """The law that an instance states.

    Raises
    ------
    BadInput
        If a name is no state, both or neither of damping and gains are given, or a number has no meaning.
    """
    if table is None:
        return None
    if table.follows not in spec.state_names:
        have = ", ".join(spec.state_names)
        raise BadInput(f"[classical] follows: the model has no state {shown(table.follows)}; states here: {have}")
    state = spec.states[spec.state_names.index(table.follows)]
    if len(spec.controls) != 1:
        raise BadInput(f"[classical] the law has one control, but model {spec.name} has {len(spec.controls)}")
    if (table.damping is None) == (table.gains is None):
        raise BadInput("[classical] damping: write either the damping, such as 0.01, or gains, and not both")
    damping = None if table.damping is None else quantity(table.damping, _rate(spec), "[classical] damping")
    if damping is not None and damping <= 0.0:
        raise BadInput(f"[classical] damping: {shown(table.damping)} is not positive; the loop would not settle")
    differentiator = time(table.differentiator, "[classical] differentiator", spec)
    if differentiator < 0.0:
        raise BadInput(
            f"[classical] differentiator: {shown(table.differentiator)} is negative; write a time, or 0 for none"
        )
    if table.gains is not None and min(table.gains) <= 0.0:
        raise BadInput(f"[classical] gains: {shown(table.gains)} are not both positive; the loop would not settle")
    return ClassicalOptions(
        follows=table.follows,
        command=value_of(state, table.command, "[classical] command"),
        damping=damping,
        gains=table.gains,
        differentiator=differentiator,
    )


def limits(table: Mapping[str, float | str], spec: ProblemSpec) -> dict[str, float]:
    """Largest magnitudes that are allowed, by name, in the model's units.

    Raises
    ------
    BadInput
        If a name is no state or derived quantity, or a limit is not positive.
    """
    variables = (*spec.states, *spec.quantities)
    known(table, variables, "state or derived quantity", "limits")
    found = {
        v.symbol: quantity(table[v.symbol], v.unit, f"[limits] {v.symbol}") for v in variables if v.symbol in table
    }
    for name, limit in found.items():
        if limit <= 0.0:
            raise BadInput(
                f"[limits] {name}: {shown(table[name])} is not positive; write the largest magnitude allowed"
            )
    return found


def deadband(table: SwitchingTable | None, spec: ProblemSpec) -> float | None:
    """The error of the position that a switching feedback allows.

    Raises
    ------
    BadInput
        If the model has no switching curve, or the deadband is not positive.
    """
    if table is None:
        return None
    if not spec.switching_curve:
        raise BadInput(
            f"[switching] model {spec.name} has no switching curve in closed form, as minimum-time problems with "
            "two integrators have; leave the table out"
        )
    position = spec.states[spec.state_names.index(spec.switching_curve[0])]
    found = quantity(table.deadband, position.unit, "[switching] deadband")
    if found <= 0.0:
        raise BadInput(
            f"[switching] deadband: {shown(table.deadband)} is not positive; "
            f"write the error of {position.symbol} that is allowed"
        )
    return found


def driven(table: DrivenTable | None, spec: ProblemSpec) -> DrivenOptions | None:
    """The control that other instances have worked out.

    Raises
    ------
    BadInput
        If the model has no such control, or no instance is named.
    """
    if table is None:
        return None
    if table.control not in spec.control_names:
        have = ", ".join(spec.control_names) or "none"
        raise BadInput(f"[driven] control: the model has no control {shown(table.control)}; controls here: {have}")
    if not table.by:
        raise BadInput("[driven] by: an empty list; name at least one instance that works the control out")
    return DrivenOptions(table.control, tuple(table.by))


def _rate(spec: ProblemSpec) -> str:
    """The unit of a damping: per second, or a plain number where all numbers of the model are plain."""
    return "1/s" if any(v.unit != "1" for v in (*spec.states, *spec.parameters)) else "1"
