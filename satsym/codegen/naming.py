"""The functions of a generated module, with the names that symbols have inside them.

A function names the components of its arguments as the derivation does: ``r, r_dot = x``. A Cartesian model has a
coordinate that is itself called x, another a parameter called ``lambda``: inside the code, and only there, a name that
would clash with an argument or with Python becomes ``x_value``. The functions include those of extremals. With the
control law substituted, states and costates obey one system z' = F(t, z). Its Jacobian is exact also where a bound is
active: the projection's derivative is one inside the control set and zero outside.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from keyword import kwlist
from typing import TypeVar

import sympy as sp

from satsym.codegen import switching
from satsym.codegen.block import Assignment
from satsym.codegen.functions import ARGUMENTS, Function, Symbols, chain_of, functions, symbols
from satsym.codegen.laws import LawParts, law_parts
from satsym.codegen.linear import linear_functions
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.convention import is_minimum
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.principle import product, set_laws


def all_functions(derivation: Derivation) -> list[Function]:
    """Return every function of a generated module, in its order."""
    s = symbols(derivation)
    found = functions(derivation) + linear_functions(derivation)
    return found + (extremal_functions(derivation, s) if derivation.problem else [])


def extremal_functions(derivation: Derivation, s: Symbols) -> list[Function]:
    """Return the canonical system and the boundary residual, each with its derivatives."""
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
            "Derivatives of the canonical rates with respect to states and costates, row by row.",
            ("t", "x", "lam", "p", "bounds"),
            law.jacobian(rates, z),
            "matrix",
        ),
        Function(
            "canonical_drift",
            "Derivatives of the canonical rates with respect to explicit time.",
            ("t", "x", "lam", "p", "bounds"),
            law.jacobian(rates, (s.t,)),
            "vector",
        ),
        Function(
            "boundary",
            "Residuals at the final time, one for each state (final value or transversality), each constraint and "
            "the time.",
            ("t", "x", "lam", "nu", "p", "bounds", "final"),
            ends,
            "vector",
        ),
        Function(
            "boundary_jacobian",
            "Derivatives of the boundary residuals by states, costates, multipliers and final time, row by row.",
            ("t", "x", "lam", "nu", "p", "bounds", "final"),
            law.jacobian(ends, unknown),
            "matrix",
        ),
    ]


def _under_the_law(derivation: Derivation, s: Symbols, parts: LawParts) -> tuple[sp.Matrix, sp.Expr]:
    """Return rates of states and costates, and H, under the law, smoothed where the exact law jumps."""
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
    """Return the boundary residuals, with the two of each state combined, since an instance selects one of them."""
    residuals = derivation.rhs("boundary_residual")
    return sp.Matrix([residuals[:states, 0] + residuals[states : 2 * states, 0], residuals[2 * states :, 0]])


NEEDED = (
    frozenset(ARGUMENTS) | frozenset(kwlist) | frozenset("math np float len range out shape times x0 lam_f i".split())
)
"""Names that generated code itself uses; the midpoints of loops are ``x_mid`` and the like."""

Expression = TypeVar("Expression", sp.Expr, sp.Matrix)


@dataclass(frozen=True)
class Code:
    """The derivation that a module is written from, under the names in its code."""

    symbols: Symbols
    """Symbols of the components of each argument."""
    functions: tuple[Function, ...]
    """Functions of the module, in its order."""
    constants: Mapping[sp.Symbol, sp.Expr]
    """Defined constants and their values."""
    chain: tuple[Assignment, ...]
    """Named parts that move, each in terms of those before; empty where functions are written in closed form."""
    names: Mapping[sp.Symbol, sp.Symbol]
    """Symbols of the derivation with the symbols of the code, where they differ."""

    def renamed(self, expression: Expression) -> Expression:
        """Return an expression of the derivation with the names of the code."""
        return expression.xreplace(dict(self.names))


_LATEST: list[tuple[Derivation, Code]] = []
"""The latest derivation, with its code."""


def code_of(derivation: Derivation) -> Code:
    """Return the derivation that a module is written from, with the names of the code.

    It is cached until another derivation is asked for, because the writer and the verifier of a module ask in turn.
    """
    if not (_LATEST and _LATEST[0][0] is derivation):
        _LATEST[:] = [(derivation, _code_of(derivation))]
    return _LATEST[0][1]


def _code_of(derivation: Derivation) -> Code:
    if not is_minimum(derivation):
        raise ValueError(f"{derivation.name}: kernels are generated from the minimum form of a problem")
    found, constants = symbols(derivation), definitions_of(derivation.model)
    names = _names({s for argument in ARGUMENTS for s in found.of(argument)} | set(constants))
    return Code(
        Symbols(**{f.name: _renamed(getattr(found, f.name), names) for f in fields(found)}),
        tuple(replace(f, value=f.value.xreplace(names)) for f in all_functions(derivation)),
        {names.get(s, s): value.xreplace(names) for s, value in constants.items()},
        tuple((s, value.xreplace(names)) for s, value in chain_of(derivation)),
        names,
    )


def _names(present: set[sp.Symbol]) -> dict[sp.Symbol, sp.Symbol]:
    taken = NEEDED | {s.name for s in present} | {f"{group}_mid" for group in ARGUMENTS}
    clashing = sorted((s for s in present if s.name != "t" and _clashes(s.name)), key=lambda s: s.name)
    names: dict[sp.Symbol, sp.Symbol] = {}
    for symbol in clashing:
        name = f"{symbol.name}_value"
        while name in taken:
            name += "_too"
        names[symbol] = sp.Symbol(name, **symbol.assumptions0)
        taken |= {name}
    return names


def _clashes(name: str) -> bool:
    return name in NEEDED or name.removesuffix("_mid") in ARGUMENTS


def _renamed(
    group: sp.Symbol | tuple[sp.Symbol, ...], names: Mapping[sp.Symbol, sp.Symbol]
) -> sp.Symbol | tuple[sp.Symbol, ...]:
    return tuple(names.get(s, s) for s in group) if isinstance(group, tuple) else names.get(group, group)
