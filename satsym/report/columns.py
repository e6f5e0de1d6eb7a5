"""Columns of a table of a study as formulas: ``costate_initial.r_dot`` is the costate of r_dot at the start."""

from __future__ import annotations

import re

from satsym.instance.numbers import SIDES, Table
from satsym.report.display import labelled, plain
from satsym.report.said import say
from satsym.studies.rows import Column

GREEK = "alpha beta gamma delta epsilon zeta eta theta kappa lambda mu nu xi rho sigma tau phi chi psi omega".split()
_NAME = re.compile(rf"({'|'.join(GREEK)}|[A-Za-z])_?(\d+|[A-Za-z])?((?:_d?dot)?)")
_AT = {
    Table.INITIAL.value: "(t_0)",
    Table.FINAL.value: "(t_f)",
    "x_final": "(t_f)",
    "found": "",
    Table.PARAMETERS.value: "",
}
_TIMES = {
    f"{Table.TIME.value}.tf": "t_f",
    f"{Table.TIME.value}.t0": "t_0",
    Column.T_FINAL.value: "t_f",
    Column.T_INITIAL.value: "t_0",
}


def on_axis(column: str) -> str:
    """A column with its unit as an axis has it; what is not known here stays as it is."""
    name, bracket, unit = column.partition(" [")
    said = _said(name)
    return labelled(said, unit.removesuffix("]")) if bracket else said


def _said(name: str) -> str:
    if name == Column.OBJECTIVE:
        return say("objective")
    if name in _TIMES:
        return f"${_TIMES[name]}$"
    place, _, rest = name.partition(".")
    if place in _AT and (symbol := latex(rest)):
        return f"${symbol}{_AT[place]}$"
    if place == "costate_initial" and (symbol := latex(rest)):
        return rf"$\lambda_{{{symbol}}}(t_0)$"
    if place == Table.CONTROL.value:
        control, _, side = rest.rpartition(".")
        if side in SIDES and (symbol := latex(control)):
            return say("upper bound of <name>" if side == SIDES[1] else "lower bound of <name>", name=f"${symbol}$")
    return plain(name)


def latex(name: str) -> str:
    """A name of a model as a formula, as far as it is built as names of formulas are; empty for others.

    Parameters
    ----------
    name
        Such as ``theta_dot``, ``u1`` or ``w_x``.
    """
    found = _NAME.fullmatch(name)
    if not found:
        return ""
    letter = rf"\{found[1]}" if found[1] in GREEK else found[1]
    dotted = {"": letter, "_dot": rf"\dot{{{letter}}}", "_ddot": rf"\ddot{{{letter}}}"}[found[3]]
    return f"{dotted}_{{{found[2]}}}" if found[2] else dotted
