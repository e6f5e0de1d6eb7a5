"""Symbols of what follows where a cost is an effort and a rate of change, and how they are typeset."""

from __future__ import annotations

import sympy as sp

from satsym.symbolic.model import Model
from satsym.symbolic.notation import named

POTENTIAL, REDUCED_COST = sp.Symbol("cost_potential", real=True), sp.Symbol("reduced_cost", real=True)
MINIMUM_COST, COST_FROM_REST = sp.Symbol("least_cost", real=True), sp.Symbol("cost_from_rest", real=True)


reduced_costate_of = named("reduced_lambda_{}")
"""The symbol for the costate of a state when the exact part of the cost is left out."""
peak_of = named("{}_peak")
"""The symbol for the largest magnitude of a control."""


def names(model: Model) -> dict[str, str]:
    """Name -> LaTeX of all of them."""
    found = {POTENTIAL.name: "V", REDUCED_COST.name: "L_0", MINIMUM_COST.name: "J_0", COST_FROM_REST.name: "J_0"}
    found |= {f"reduced_lambda_{v.symbol}": rf"\mu_{{{v.latex}}}" for v in model.states}
    for v in model.controls:
        found |= {f"{v.symbol}_peak": rf"|{v.latex}|_{{\max}}", f"{v.symbol}_answer": rf"{v.latex}(t)"}
    return found
