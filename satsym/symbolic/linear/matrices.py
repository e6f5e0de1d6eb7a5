"""Which models are linear, and their matrices."""

from __future__ import annotations

from typing import Literal

import sympy as sp

from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.analysis.field import NotExact, exact
from satsym.symbolic.analysis.system import LinearSystem
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.linear.notation import results
from satsym.symbolic.model import symbols_of, t, variables_of

Coefficients = Literal["constant", "varying"]


def coefficients_of(derivation: Derivation) -> Coefficients | None:
    """Whether x' = A x + B u with constant or time-varying matrices; ``None`` where the motion is not linear."""
    if "linearisation" not in derivation:
        return None
    model = derivation.model
    moving = {*symbols_of(model.states), *symbols_of(model.controls)}
    matrices = [
        e.rhs
        for step in ("linearisation", "output_matrix")
        if step in derivation
        for e in derivation.step(step).equations
    ]
    at_rest = derivation.rhs("first_order").xreplace(dict.fromkeys(moving, sp.Integer(0)))
    at_rest = at_rest.xreplace(definitions_of(model))
    if any(e.free_symbols & moving for e in matrices) or any(sp.simplify(e) != 0 for e in at_rest):
        return None
    return "varying" if any(e.has(t) for e in matrices) else "constant"


def system_of(derivation: Derivation) -> LinearSystem:
    """The matrices of a linear model with constant coefficients, named constants filled in.

    Raises
    ------
    DerivationError
        If the model is not linear, or its coefficients are not constant.
    """
    if coefficients_of(derivation) != "constant":
        raise DerivationError(
            f"{derivation.name}: not linear with constant coefficients; linearise it about a motion, "
            "as derivations/clohessy_wiltshire.py does"
        )
    model = derivation.model
    outputs = tuple(o.variable.symbol for o in model.outputs)
    n, m, k = len(model.states), len(model.controls), len(outputs)
    constants = definitions_of(model)
    entries = [e.rhs.xreplace(constants) for e in derivation.step("linearisation").equations]
    shown = [e.rhs.xreplace(constants) for e in derivation.step("output_matrix").equations] if outputs else []
    return LinearSystem(
        sp.ImmutableMatrix(n, n, entries[: n * n]),
        sp.ImmutableMatrix(n, m, entries[n * n :]),
        sp.ImmutableMatrix(k, n, shown[: k * n]),
        sp.ImmutableMatrix(k, m, shown[k * n :]),
        tuple(v.symbol for v in model.states),
        tuple(v.symbol for v in model.controls),
        outputs,
    )


def analysable(derivation: Derivation) -> bool:
    """Whether the steps of exact analysis apply.

    They do to models without a cost and with constant coefficients, if exact arithmetic reaches the entries and no
    variable has the name of a result.
    """
    if derivation.problem is not None or coefficients_of(derivation) != "constant":
        return False
    if {v.symbol for v in variables_of(derivation.model)} & set(results(derivation.model)):
        return False
    system = system_of(derivation)
    try:
        exact(system.a, system.b, system.c)
    except NotExact:
        return False
    return True
