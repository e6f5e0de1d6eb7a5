"""Units of what follows from a model: of its cost and of what it conserves, derived from their dimensions.

Numbers are what the author's units make of them, so that a unit is composed of these names alone: a model in km and s
has a cost in km**2/s**3. Where its names could be put together to units of several sizes, as of m and km, or count
angles other than in radians, no unit is said.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence

import sympy as sp

from satsym import units
from satsym.status import BadInput
from satsym.symbolic import notation as n
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.dimension_algebra import Dimension, Disagreement, dimension_of
from satsym.symbolic.dimensions import declared, of_unit
from satsym.symbolic.model import variables_of

UNKNOWN = ""
SIZE_TOLERANCE = 1e-9
"""Relative difference of the sizes of two units that are the same."""


def of_objective(derivation: Derivation) -> str:
    """The unit of the cost: what its author stated, or what its terms have; empty where that is not clear."""
    problem = derivation.problem
    if problem is None or problem.unit:
        return problem.unit if problem else UNKNOWN
    return unit_of(declared(derivation)[n.TERMINAL_COST.name], _names(derivation))


def of_expressions(derivation: Derivation, expressions: Iterable[sp.Expr]) -> list[str]:
    """Units of expressions in the symbols of a model, ``"1"`` where that is not clear."""
    known, names = declared(derivation), _names(derivation)
    found = []
    for expression in expressions:
        try:
            found.append(unit_of(dimension_of(expression, known), names) or "1")
        except Disagreement:
            found.append("1")
    return found


def unit_of(dimension: Dimension | None, names: Sequence[str]) -> str:
    """The shortest unit of a dimension that is composed of some names.

    Returns
    -------
    str
        ``"1"`` for a plain number; empty where there is none, or units of several sizes.
    """
    if dimension is None:
        return UNKNOWN
    if not dimension:
        return "1"
    by_name = {name: found for name in names if (found := of_unit(name))}
    bases = sorted({base for found in by_name.values() for base in found} | set(dimension))
    wanted = sp.Matrix([dimension.get(base, 0) for base in bases])
    candidates: list[dict[str, int]] = []
    for count in range(1, len(bases) + 1):
        for chosen in itertools.combinations(by_name, count):
            columns = sp.Matrix([[by_name[name].get(base, 0) for name in chosen] for base in bases])
            if columns.rank() < count or columns.row_join(wanted).rank() > count:
                continue
            exponents = (columns.T * columns).LUsolve(columns.T * wanted)
            if all(e.is_Integer for e in exponents) and all(exponents):
                candidates.append({name: int(e) for name, e in zip(chosen, exponents, strict=True)})
    sizes = [math.prod(units.in_base_units(name) ** e for name, e in one.items()) for one in candidates]
    if not candidates or max(sizes) > (1.0 + SIZE_TOLERANCE) * min(sizes):
        return UNKNOWN
    shortest = min(candidates, key=lambda one: sum(map(abs, one.values())))
    # such as N*m*s: what is made of most comes first, time last
    order = sorted(shortest, key=lambda name: (list(by_name[name]) == ["[time]"], -len(by_name[name])))
    return units.expression({name: shortest[name] for name in order})


def _names(derivation: Derivation) -> list[str]:
    """The names of units that a model's author uses, in order of their first use; none where angles are not radians."""
    stated = [v.unit for v in variables_of(derivation.model)]
    try:
        names = list(dict.fromkeys(name for unit in stated for name in units.factors(unit)))
        angular = {name for name in names if not of_unit(name) and units.in_base_units(name) != 1.0}
    except BadInput:
        return []
    return [] if angular else names
