"""Symbols of what follows where a cost is an effort and a rate of change, and how they are typeset."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over
from satsym.symbolic.model import Model, Problem, variables_of
from satsym.symbolic.notation import free_letter, indexed, named
from satsym.symbolic.principle import parts
from satsym.symbolic.principle.parts import Part

if TYPE_CHECKING:
    from satsym.symbolic.principle.branches import Minimum

POTENTIAL, REDUCED_COST = sp.Symbol("cost_potential", real=True), sp.Symbol("reduced_cost", real=True)
MINIMUM_COST, COST_FROM_REST = sp.Symbol("least_cost", real=True), sp.Symbol("cost_from_rest", real=True)


reduced_costate_of = named("reduced_lambda_{}")
"""The symbol for the costate of a state when the exact part of the cost is left out."""
peak_of = named("{}_peak")
"""The symbol for the largest magnitude of a control."""


def cost_letter(model: Model) -> str:
    """The letter of the cost functional: J, unless a variable has it, as moments of inertia do."""
    return free_letter(("J", r"\mathcal{C}"), variables_of(model))


def names(model: Model, time: str) -> dict[str, str]:
    """Name -> LaTeX of all of them, with the letter for time."""
    found = {
        POTENTIAL.name: r"\mathcal{V}",
        REDUCED_COST.name: "L_0",
        MINIMUM_COST.name: f"{cost_letter(model)}_0",
        COST_FROM_REST.name: rf"{cost_letter(model)}_{{\mathrm{{rest}}}}",
    }
    found |= {f"reduced_lambda_{v.symbol}": rf"\mu_{{{v.latex}}}" for v in model.states}
    for v in model.controls:
        from_rest = indexed(v.latex, r"{\mathrm{rest}}")
        found |= {f"{v.symbol}_peak": rf"|{from_rest}|_{{\max}}", f"{v.symbol}_answer": f"{from_rest}({time})"}
    return found


REGULARISED_H = sp.Symbol("H_regularised", real=True)
"""H of the regularised problem of directions."""

slope_by = named("slope_by_{}")
"""H_u of a control on which H depends neither linearly nor quadratically."""
MOST_PARTS = 200
"""Named parts of laws, at most."""


def part_of_law(number: int) -> sp.Symbol:
    """The symbol for a part of laws."""
    return sp.Symbol(f"law_part_{number}", real=True)


def letter_of_parts(problem: Problem) -> str:
    """The letter of these: one that no variable has."""
    return free_letter("qkdgs", variables_of(problem.model))


primer_of = named("primer_{}")
"""The slope of H by a control on which it depends linearly, in a ball."""
weight_of = named("norm_weight_{}")
"""What multiplies the norm of a vector in H, by the first of its controls."""
cosine_of, sine_of = named("cosine_of_{}"), named("sine_of_{}")
"""What multiplies the cosine and the sine of an angle in H."""
along_of, across_of = named("along_{}"), named("across_{}")
"""What takes the place of cosine and sine in the regularised problem."""


def slopes_of(one: Minimum) -> tuple[sp.Symbol, ...]:
    """Symbols for the slope of H where it is linear in a vector."""
    if one.part.kind == "angle" or one.turned_by:
        return cosine_of(one.part.symbols[0]), sine_of(one.part.symbols[0])
    return tuple(map(primer_of, one.part.symbols))


def components_of(part: Part) -> tuple[sp.Symbol, ...]:
    """The vector in which H is linear: the controls, or what takes the place of cosine and sine of an angle."""
    if part.kind == "angle":
        return along_of(part.symbols[0]), across_of(part.symbols[0])
    return part.symbols


def product_names(problem: Problem) -> dict[str, str]:
    """Name -> LaTeX of what the law over a product of sets introduces."""
    found = {REGULARISED_H.name: r"H_\varepsilon"}
    found |= {v.symbol: v.latex for v in (parts.SMOOTHING, parts.FRACTION)}
    if problem.control_sets or problem.control_set == "box":
        found |= {part_of_law(k).name: f"{letter_of_parts(problem)}_{{{k}}}" for k in range(1, MOST_PARTS + 1)}
    angles = {v.symbol for part in parts.parts_of(problem) if part.kind == "angle" for v in part.controls}
    for v in problem.model.controls:
        found |= {f"slope_by_{v.symbol}": f"H_{{{v.latex}}}", f"primer_{v.symbol}": f"p_{{{v.latex}}}"}
        turned = v.symbol in angles
        for name, of in (("cosine", r"\cos"), ("sine", r"\sin")):
            found[f"{name}_of_{v.symbol}"] = f"H_{{{of} {v.latex}}}" if turned else f"H_{{{v.latex}{of}}}"
        found[f"along_{v.symbol}"] = f"c_{{{v.latex}}}"
        found |= {f"across_{v.symbol}": f"s_{{{v.latex}}}", f"norm_weight_{v.symbol}": f"w_{{{v.latex}}}"}
    for part in parts.parts_of(problem):
        squares = " + ".join(f"{v.latex}^2" for v in part.controls)
        found[f"norm_of_{part.name}"] = rf"\sqrt{{{squares}}}"
    return found


def declare_product(known: dict[str, Dimension | None], problem: Problem, running: Dimension | None) -> None:
    """Enter the dimensions of these."""
    known[REGULARISED_H.name], known[parts.FRACTION.symbol] = running, PLAIN
    efforts = []
    for part in parts.parts_of(problem):
        for v in part.controls:
            known[f"slope_by_{v.symbol}"] = known[f"primer_{v.symbol}"] = known[f"norm_weight_{v.symbol}"] = over(
                running, known[v.symbol]
            )
            known[f"norm_of_{part.name}"] = known[v.symbol]
            turned = running if part.kind == "angle" else over(running, known[v.symbol])
            known[f"cosine_of_{v.symbol}"] = known[f"sine_of_{v.symbol}"] = turned
            known[f"along_{v.symbol}"] = known[f"across_{v.symbol}"] = PLAIN
        switched = part.kind == "box" and sp.diff(problem.running_cost, part.symbols[0], 2) == 0
        if switched or part.kind in ("ball", "annulus", "angle"):
            units = (PLAIN if part.kind == "angle" else known[v.symbol] for v in part.controls)
            efforts += [over(over(running, unit), unit) for unit in units]
    # one number smooths all directions: where their units differ it has none that would suit them all
    known[parts.SMOOTHING.symbol] = efforts[0] if efforts and all(e == efforts[0] for e in efforts) else None
