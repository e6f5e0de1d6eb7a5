"""Expressions as sums of the cosine and the sine of an angle."""

from __future__ import annotations

import sympy as sp

from satsym.symbolic.algebra import depends


def by_circle(expression: sp.Expr, angle: sp.Symbol) -> tuple[sp.Expr, sp.Expr, sp.Expr] | None:
    """c, a and b of c + a cos(angle) + b sin(angle); ``None`` where an expression is no such sum."""
    along, across = sp.Dummy("along", real=True), sp.Dummy("across", real=True)

    def apart(e: sp.Expr) -> sp.Expr:
        return sp.expand_trig(e).xreplace({sp.cos(angle): along, sp.sin(angle): across})

    turned = sp.sympify(expression).replace(lambda e: e.func in (sp.sin, sp.cos, sp.tan) and e.has(angle), apart)
    slopes = [sp.diff(turned, v) for v in (along, across)]
    if turned.has(angle) or any(depends(s, [along, across]) for s in slopes):
        return None
    none = {along: sp.Integer(0), across: sp.Integer(0)}
    return (turned.xreplace(none), *(s.xreplace(none) for s in slopes))
