"""The two-point boundary-value problem that the steps lead to, collected: equations bear the numbers they have."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from satsym.report.latex import tex
from satsym.report.latex.context import Context, row_of
from satsym.report.latex.equations import Row, display
from satsym.report.latex.steps import costate_rows
from satsym.symbolic import Problem, Step
from satsym.symbolic import notation as n
from satsym.symbolic.latex.terms import plain
from satsym.symbolic.model import symbols_of
from satsym.symbolic.principle.path.interior import named

ASIDE = (
    *("boundary_control", "control_rates", "constraint_multiplier", "constrained_costates", "junction_conditions"),
    *("mixed_constraints", "mixed_costates"),
)
"""Steps for stretches on which a path constraint is active."""
SINGULAR = ("singular_arcs", "generalised_legendre_clebsch")
"""Steps that say what is known of singular arcs."""
DEFINING = ("switching_function", "control_parts")
"""Steps that define what control laws are stated in."""


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
    yield said("control") + "\n" + _shown([*(row_of(context, law, e) for e in law.equations), *_parts(context, law)])
    steps = [rf"\ref{{{tex.label(context.address(derivation.step(name)))}}}" for name in ASIDE if name in derivation]
    if steps and _constrained(problem):
        yield said("aside", steps=texts.listed(steps))
    if arc := _singular(context):
        yield said("singular", step=arc)
    if "interior_conditions" in derivation:
        passed = derivation.step("interior_conditions")
        address = tex.label(context.address(passed))
        key = "interior" if len(problem.interior) > 1 else "interior_one"
        yield said(key, step=rf"\ref{{{address}}}") + "\n" + _shown(_passing(context, passed))
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


def _parts(context: Context, law: Step) -> list[Row]:
    """What the law is stated in: switching functions, or the parts of H, as far as they stand in it."""
    derivation = context.derivation
    within = set[Any]().union(*(e.rhs.free_symbols for e in law.equations))
    steps = [derivation.step(name) for name in DEFINING if name in derivation]
    return [row_of(context, step, e) for step in steps for e in step.equations if e.lhs in within]


def _singular(context: Context) -> str:
    """The step that states controls on singular arcs, where there may be such arcs that are optimal."""
    derivation = context.derivation
    found = [step for name in SINGULAR if name in derivation for step in (derivation.step(name),)]
    keys = [c.key.partition(",")[0] for step in found for c in step.conclusions]
    stated = keys.count("singular arc") > keys.count("Legendre-Clebsch violated")
    return rf"\ref{{{tex.label(context.address(found[0]))}}}" if stated else ""


def _constrained(problem: Problem) -> bool:
    """Whether there is a path constraint; bounds beside points on the way are in the law."""
    return bool(problem.path_constraints)


def _passing(context: Context, step: Step) -> list[Row]:
    """The conditions at points on the way, as they are stated, and what they make of costates and H."""
    problem = context.derivation.problem
    assert problem is not None
    stated = set(named(problem))
    return [replace(row_of(context, step, e), end="= 0" if e.name in stated else "") for e in step.equations]


def _at(context: Context, step: Step, time: str, names: list[str]) -> list[Row]:
    """The equations of those names, at a time."""
    typeset = context.typeset.at(time)
    return [row_of(context, step, e, typeset=typeset) for e in step.equations if e.name in names]


def _shown(rows: list[Row]) -> str:
    return display([replace(row, again=True) for row in rows])
