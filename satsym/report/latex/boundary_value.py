"""The two-point boundary-value problem that the steps lead to, collected: equations bear the numbers they have."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from satsym.report.latex import tex
from satsym.report.latex.equations import Row, display
from satsym.report.latex.steps import Context, costate_rows, row_of
from satsym.symbolic import Step
from satsym.symbolic import notation as n
from satsym.symbolic.latex.terms import plain
from satsym.symbolic.model import symbols_of

ASIDE = (
    *("boundary_control", "control_rates", "constraint_multiplier", "constrained_costates", "junction_conditions"),
    *("mixed_constraints", "mixed_costates"),
)
"""Steps for stretches on which a path constraint is active."""


def collected(context: Context) -> Iterator[str]:
    """Paragraphs: what holds along the trajectory, at its start and at its end."""
    derivation, texts = context.derivation, context.texts
    problem = derivation.problem
    assert problem is not None

    def said(key: str, **fill: str) -> str:
        return texts.get("boundary_value", key, **fill)

    motion, costates, law = (derivation.step(name) for name in ("state_equations", "costate_equations", "control_law"))
    along = [*(row_of(context, motion, e) for e in motion.equations), *costate_rows(context, costates)]
    yield said("multipliers" if problem.end_conditions else "unknowns") + "\n" + _shown(along)
    yield said("control") + "\n" + _shown([row_of(context, law, e) for e in law.equations])
    steps = [rf"\ref{{{tex.label(context.address(derivation.step(name)))}}}" for name in ASIDE if name in derivation]
    if steps:
        yield said("aside", steps=texts.listed(steps))
    ends = derivation.step("boundary_conditions")
    states = symbols_of(derivation.model.states)
    yield said("start") + "\n" + _shown(_at(context, ends, "t_0", [s.name for s in states]))
    multipliers = [n.costate_of(s).name for s in states]
    either, end = _at(context, ends, "t_f", multipliers), context.typeset.at("t_f")
    given = [
        plain(
            rf"{end.symbol(s.name)} = {end.symbol(n.target(s).name)}"
            rf" \quad\text{{{texts.get('words', 'or')}}}\quad {row.left_tex}"
        )
        for s, row in zip(states, either, strict=True)
    ]
    yield (
        said("end", step=rf"\ref{{{tex.label(context.address(ends))}}}")
        + "\n"
        + _shown([replace(row, left=left) for row, left in zip(either, given, strict=True)])
    )
    others = [e.name for e in ends.equations if e.name not in {*multipliers, *(s.name for s in states), "final_time"}]
    if others:
        yield said("constraints") + "\n" + _shown(_at(context, ends, "t_f", others))
    yield said("final_time") + "\n" + _shown(_at(context, ends, "t_f", ["final_time"]))


def _at(context: Context, step: Step, time: str, names: list[str]) -> list[Row]:
    """The equations of those names, at a time."""
    typeset = context.typeset.at(time)
    return [row_of(context, step, e, typeset=typeset) for e in step.equations if e.name in names]


def _shown(rows: list[Row]) -> str:
    return display([replace(row, again=True) for row in rows])
