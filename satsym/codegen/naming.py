"""The names that symbols have inside generated functions.

A function names the components of its arguments as the derivation does: ``r, r_dot = x``. A Cartesian model has a
coordinate that is itself called x, another a parameter called ``lambda``: inside the code, and only there, what would
clash with an argument or with Python is called ``x_value``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from keyword import kwlist
from typing import TypeVar

import sympy as sp

from satsym.codegen.block import Assignment
from satsym.codegen.extremals import all_functions
from satsym.codegen.functions import ARGUMENTS, Function, Symbols, chain_of, symbols
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.convention import is_minimum
from satsym.symbolic.derivation import Derivation

NEEDED = (
    frozenset(ARGUMENTS) | frozenset(kwlist) | frozenset("math np float len range out shape times x0 lam_f i".split())
)
"""What generated code calls by these names itself; the midpoints of loops are ``x_mid`` and the like."""

Expression = TypeVar("Expression", sp.Expr, sp.Matrix)


@dataclass(frozen=True)
class Code:
    """What a module is written from, under the names it has there."""

    symbols: Symbols
    """Behind each argument."""
    functions: tuple[Function, ...]
    """Functions of the module, in its order."""
    constants: Mapping[sp.Symbol, sp.Expr]
    """Defined constants and their values."""
    chain: tuple[Assignment, ...]
    """Named parts that move, each in terms of those before; empty where functions are written in closed form."""
    names: Mapping[sp.Symbol, sp.Symbol]
    """Symbol of the derivation -> symbol of the code, where they differ."""

    def renamed(self, expression: Expression) -> Expression:
        """An expression of the derivation as the code has it."""
        return expression.xreplace(dict(self.names))


_LATEST: list[tuple[Derivation, Code]] = []
"""The derivation that was asked for last, with its code."""


def code_of(derivation: Derivation) -> Code:
    """What the module of a derivation is written from.

    It is kept until another derivation is asked for: what writes a module and what verifies it ask in turn.
    """
    if not (_LATEST and _LATEST[0][0] is derivation):
        _LATEST[:] = [(derivation, _code_of(derivation))]
    return _LATEST[0][1]


def _code_of(derivation: Derivation) -> Code:
    if not is_minimum(derivation):
        raise ValueError(f"{derivation.name}: kernels are generated from the minimum form of a problem")
    found, constants = symbols(derivation), definitions_of(derivation.model)
    names = _names(derivation, {s for argument in ARGUMENTS for s in found.of(argument)} | set(constants))
    return Code(
        Symbols(**{f.name: _renamed(getattr(found, f.name), names) for f in fields(found)}),
        tuple(replace(f, value=f.value.xreplace(names)) for f in all_functions(derivation)),
        {names.get(s, s): value.xreplace(names) for s, value in constants.items()},
        tuple((s, value.xreplace(names)) for s, value in chain_of(derivation)),
        names,
    )


def _names(derivation: Derivation, present: set[sp.Symbol]) -> dict[sp.Symbol, sp.Symbol]:
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
