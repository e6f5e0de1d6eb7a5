"""Small problems whose Hamiltonian is linear in the controls, with arcs that are known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from satsym.symbolic import Derivation, FirstOrder, Problem, Variable, symbols_of
from satsym.symbolic.model import Convention
from tests.support import derived as shared

STATES = tuple(Variable(f"x{k}", f"x_{k}") for k in (1, 2, 3))
CONTROLS = tuple(Variable(f"u{k}", f"u_{k}") for k in (1, 2))
WEIGHT = Variable("a", "a", default=1.0, positive=True)
x1, x2, x3 = symbols_of(STATES)
u1, u2 = symbols_of(CONTROLS)
(a,) = symbols_of((WEIGHT,))


def switching(rates: Mapping[sp.Symbol, Any], cost: Any, **changes: Any) -> Problem:
    """A problem in a box with the states that have rates, and with the controls that occur."""
    occurring = set().union(*(sp.sympify(e).free_symbols for e in (*rates.values(), cost)))
    model = FirstOrder(
        name="motion",
        title="A motion",
        states=STATES[: len(rates)],
        controls=tuple(v for v, u in zip(CONTROLS, (u1, u2), strict=True) if u in occurring),
        parameters=(WEIGHT,),
        rates=rates,
    )
    fields: dict[str, Any] = {"name": "task", "title": "A task", "control_set": "box"}
    return Problem(model=model, running_cost=cost, **(fields | changes))


CHAIN = {x1: x2, x2: u1}
MINIMUM_TIME = switching(CHAIN, 1)
LEAST_FUEL = switching(CHAIN, sp.Abs(u1))
FULLER = switching(CHAIN, x1**2 / 2)
REGULATOR = switching({x1: u1}, x1**2 / 2)
WORST = switching({x1: u1}, -(x1**2) / 2)
OSCILLATOR = switching({x1: x2, x2: -x1 + x2 * (1 - x1**2) + u1}, (x1**2 + x2**2) / 2)
DAMPER = switching(CHAIN, (x1**2 + x2**2) / 2)
CATALYST = switching(
    # mixing of two catalysts: Jackson, Optimal use of mixed catalysts for two successive reactions, 1968
    {x1: u1 * (10 * x2 - x1), x2: u1 * (x1 - 10 * x2) - (1 - u1) * x2},
    0,
    terminal_cost=x1 + x2 - 1,
)
BURNING = switching({x1: x2, x2: u1 / x3, x3: -a * sp.Abs(u1)}, 1)
ROCKET = switching({x1: x2, x2: u1 / x3 - 1 - x2**2, x3: -u1}, -x2)
"""Vertical ascent with drag v^2, without an atmosphere that thins out."""

TWO_ENGINES = switching({x1: x2 * u1 + u2, x2: u1 - x1}, a * sp.Abs(u1) + sp.Abs(u2) * (1 + x1**2) + x1**2)
"""Weights of magnitudes, one of which varies along the motion; the two switching functions do not commute."""


def derived(problem: Problem, convention: Convention = "minimum") -> Derivation:
    """Its derivation in a convention."""
    return shared.derived(replace(problem, convention=convention))
