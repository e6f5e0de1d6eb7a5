"""Functions of extremals: the canonical equations with the control law in them, their Jacobian, the right end.

With the control law substituted, states and costates obey one system z' = F(t, z). Its Jacobian is exact also
where a bound is active: the projection's derivative is one inside the control set and zero outside.
"""

from __future__ import annotations

import sympy as sp

from satsym.codegen import switching
from satsym.codegen.functions import Function, Symbols, functions, symbols
from satsym.codegen.laws import LawParts, law_parts
from satsym.codegen.linear import linear_functions
from satsym.symbolic import notation as n
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.principle import product, set_laws


def all_functions(derivation: Derivation) -> list[Function]:
    """Every function of a generated module, in its order."""
    s = symbols(derivation)
    found = functions(derivation) + linear_functions(derivation)
    return found + (extremal_functions(derivation, s) if derivation.problem else [])


def extremal_functions(derivation: Derivation, s: Symbols) -> list[Function]:
    """The canonical system and the boundary residual, each with its derivatives."""
    z, law = (*s.x, *s.lam), law_parts(derivation)
    rates, h = _under_the_law(derivation, s, law)
    ends = _ends(derivation, len(s.x)).xreplace({n.HAMILTONIAN: h})
    unknown = (*z, *s.nu, s.t)
    smoothed = " of the regularised problem" if "smoothed_law" in derivation else ""
    return [
        Function(
            "canonical",
            f"Rates of change of states and costates under the control law{smoothed}.",
            ("t", "x", "lam", "p", "bounds"),
            rates,
            "vector",
        ),
        Function(
            "canonical_jacobian",
            "The canonical rates by states and costates, row by row.",
            ("t", "x", "lam", "p", "bounds"),
            law.jacobian(rates, z),
            "matrix",
        ),
        Function(
            "canonical_drift",
            "The canonical rates by explicit time.",
            ("t", "x", "lam", "p", "bounds"),
            law.jacobian(rates, (s.t,)),
            "vector",
        ),
        Function(
            "boundary",
            "Residuals at the final time: for each state (its end or its transversality), each constraint, the time.",
            ("t", "x", "lam", "nu", "p", "bounds", "final"),
            ends,
            "vector",
        ),
        Function(
            "boundary_jacobian",
            "The boundary residuals by states, costates, multipliers and final time, row by row.",
            ("t", "x", "lam", "nu", "p", "bounds", "final"),
            law.jacobian(ends, unknown),
            "matrix",
        ),
    ]


def _under_the_law(derivation: Derivation, s: Symbols, parts: LawParts) -> tuple[sp.Matrix, sp.Expr]:
    """Rates of states and costates, and H; those of the smoothed companion where the law itself jumps."""
    if switching.switches(derivation):
        regularised = switching.regularised(derivation)
        return regularised.rates, regularised.hamiltonian
    if product.STEP in derivation:
        return _under_the_law_of_sets(derivation, parts)
    law = dict(zip(s.u, derivation.rhs("control_law"), strict=True))
    rates = sp.Matrix([*derivation.rhs("first_order"), *derivation.rhs("costate_equations")])
    return rates.xreplace(law), derivation.equation("hamiltonian.H").rhs.xreplace(law)


def _under_the_law_of_sets(derivation: Derivation, parts: LawParts) -> tuple[sp.Matrix, sp.Expr]:
    """Return rates and H under the law over a product of sets, of the regularised problem where that differs."""
    *rates, h = set_laws.relaxed(
        derivation,
        [
            *derivation.rhs("first_order"),
            *derivation.rhs("costate_equations"),
            derivation.equation("hamiltonian.H").rhs,
        ],
    )
    law = set_laws.regularised_law(derivation) | dict(parts.values)
    return sp.Matrix(rates).xreplace(law), (h + set_laws.effort(derivation)).xreplace(law)


def _ends(derivation: Derivation, states: int) -> sp.Matrix:
    """The boundary residuals, the two of each state in one: the instance's choice makes one of them zero."""
    residuals = derivation.rhs("boundary_residual")
    return sp.Matrix([residuals[:states, 0] + residuals[states : 2 * states, 0], residuals[2 * states :, 0]])
