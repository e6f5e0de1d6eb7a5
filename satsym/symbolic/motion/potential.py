"""The potential of forces, where they have one: integration force by force, proved by differentiation.

A general integrator may search for minutes, and splits cases that do not matter here. Forces of physics are
mostly powers of a distance: one substitution, read off the expression itself, integrates them at once.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from satsym.symbolic.algebra import gradient, simplify, tidy
from satsym.symbolic.checks import compare, numeric
from satsym.symbolic.model import Particle


def potential(model: Particle, coast: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr | None:
    """The function of the coordinates whose negative gradient the generalised forces are.

    Parameters
    ----------
    model
        Where the position and the forces are stated.
    coast
        Control -> its value in the uncontrolled motion.

    Returns
    -------
    Expr or None
        ``None`` if a force depends on velocities or has no potential that was found.
    """
    total = sp.Integer(0)
    for force in model.forces.values():
        along = {q: simplify(force.xreplace(dict(coast)).dot(sp.diff(model.position, q))) for q in model.coordinates}
        if any(component.has(*model.coordinates.values()) for component in along.values()):
            return None
        found = _of(along)
        if found is None:
            return None
        total += found
    return total


def _of(generalised: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr | None:
    """The potential of one generalised force."""
    # an antiderivative that holds for positive coordinates holds for all, which the comparison below confirms
    positive = {q: sp.Dummy(q.name, positive=True) for q in generalised}
    found = sp.Integer(0)
    for q, force in generalised.items():
        rest = simplify(force.xreplace(positive) + sp.diff(found, positive[q]))
        part = _antiderivative(rest, positive[q])
        if part is None:
            return None
        found -= part
    found = found.xreplace({dummy: q for q, dummy in positive.items()})
    forces, slopes = numeric(list(generalised.values())), numeric(gradient(-found, generalised))
    symbols = set(generalised).union(found.free_symbols, *(f.free_symbols for f in generalised.values()))
    agree = compare("gradient of the potential", symbols, lambda point: (slopes(point), forces(point)))
    return tidy(found) if agree.passed else None


def _antiderivative(function: sp.Expr, by: sp.Symbol) -> sp.Expr | None:
    """An antiderivative in closed form, by substitution of a part w of the function: ∫ h(w) w' = ∫ h dw."""
    parts = [part for part in sp.preorder_traversal(function) if part.has(by) and not part.is_Add]
    inner = {argument for part in parts for argument in part.args if argument.is_Add and argument.has(by)}
    for w in (*sorted(inner, key=sp.default_sort_key), by):
        new = sp.Dummy("w", positive=True)
        quotient = simplify(function / sp.diff(w, by)).subs(w, new)
        if not quotient.has(by):
            outer = sp.integrate(quotient, new)
            return None if outer.has(sp.Integral) else outer.xreplace({new: w})
    if function.is_Add:
        terms = [_antiderivative(term, by) for term in function.args]
        return None if None in terms else sp.Add(*terms)
    return None
