"""Control sets of a single kind (free, box, ball): projection of the unconstrained minimiser of H onto the set.

H is quadratic in the controls. On a box its minimiser is the clipped unconstrained one only if H_uu is diagonal; on a
ball it is the shortened one only if H_uu is a multiple of the identity.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.control_part import PartKind
from satsym.spec import ControlSetKind, Variable
from satsym.symbolic.algebra import depends, vanishes
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.functions.minimisers import Clip, Shorten


def bounds(control_set: ControlSetKind, controls: Sequence[Variable]) -> tuple[Variable, ...]:
    """Return the variables of an instance's numbers, in the order of the ``bounds`` argument of kernels."""
    if control_set == "box":
        lower = tuple(Variable(f"{c.symbol}_min", rf"{c.latex}^{{\min}}", c.unit) for c in controls)
        upper = tuple(Variable(f"{c.symbol}_max", rf"{c.latex}^{{\max}}", c.unit) for c in controls)
        return lower + upper
    if control_set == "ball":
        return (Variable("u_max", rf"{letter_of(controls)}^{{\max}}", controls[0].unit, positive=True),)
    return ()


def letter_of(controls: Sequence[Variable]) -> str:
    """Return the letter of a vector of controls: the one they share, as T_r and T_t do, or else u."""
    letters = {c.latex.partition("_")[0] for c in controls}
    return letters.pop() if len(letters) == 1 and len(controls) > 1 else "u"


def project(
    control_set: ControlSetKind, unconstrained: Sequence[sp.Expr], limits: Sequence[sp.Symbol], hessian: sp.Matrix
) -> list[sp.Expr]:
    """Return the minimiser of H over the control set, from the minimiser over all controls.

    Parameters
    ----------
    unconstrained
        The controls at which H_u = 0.
    limits
        Symbols of :func:`bounds`.
    hessian
        H_uu, which decides whether projection gives the minimiser at all.

    Raises
    ------
    DerivationError
        If projection does not give the minimiser.
    """
    m = len(unconstrained)
    if control_set == "box":
        if not hessian.is_diagonal():
            raise DerivationError(
                "if the control set is a box, H_uu must be diagonal, "
                "because only then does clipping each control minimise H"
            )
        return [Clip(u, limits[i], limits[m + i]) for i, u in enumerate(unconstrained)]
    if control_set == "ball":
        refuse_unequal(hessian)
        factor = Shorten(sum((u**2 for u in unconstrained), sp.Integer(0)), limits[0])
        return [factor * u for u in unconstrained]
    return list(unconstrained)


def refuse_unequal(hessian: sp.Matrix) -> None:
    """Refuse an H_uu that is not a multiple of the identity."""
    m = hessian.rows
    if not all(vanishes(e) for e in hessian - hessian[0, 0] * sp.eye(m)):
        raise DerivationError(
            "in a ball, the squares of all controls must have the same weight in the cost, because only then does "
            "shortening the control vector minimise H"
        )


def refuse_singular(name: str, kind: PartKind, controls: Sequence[sp.Symbol], hessian: sp.Matrix) -> None:
    """Refuse a set of controls that H_u = 0 does not determine.

    Parameters
    ----------
    hessian
        H_uu of them.
    """
    if not vanishes(hessian.det()):
        return
    names = ", ".join(u.name for u in controls)
    linear = [u.name for k, u in enumerate(controls) if all(vanishes(entry) for entry in hessian.row(k))]
    if linear and kind == "free":
        message = f"H is linear in {', '.join(linear)}, which has no bounds; use a Box or a Ball"
        raise DerivationError(f"{name}: {message}")
    if linear and kind in ("ball", "annulus"):
        refuse_unequal(hessian)
    message = (
        f"H_uu of {names} is singular, so H_u = 0 does not determine them; add the square of each of these "
        "controls to the cost"
    )
    raise DerivationError(f"{name}: {message}")


def ordered(control_set: ControlSetKind, point: dict[Any, Any], limits: Sequence[sp.Symbol]) -> dict[Any, Any]:
    """Return the point with lower bounds below upper ones."""
    if control_set != "box":
        return point
    m = len(limits) // 2
    pairs = [sorted((point[limits[i]], point[limits[m + i]])) for i in range(m)]
    return {**point, **{limits[i]: low for i, (low, _) in enumerate(pairs)}} | {
        limits[m + i]: high for i, (_, high) in enumerate(pairs)
    }


def slacks(
    control_set: ControlSetKind, point: dict[Any, Any], limits: Sequence[sp.Symbol], controls: Sequence[Any]
) -> list[Any]:
    """Return how far numeric controls are inside the control set; a negative entry is a violated bound."""
    m = len(controls)
    if control_set == "box":
        below = [u - point[limits[i]] for i, u in enumerate(controls)]
        return below + [point[limits[m + i]] - u for i, u in enumerate(controls)]
    if control_set == "ball":
        return [point[limits[0]] - mp.sqrt(sum(u**2 for u in controls))]
    return []


def admissible(
    control_set: ControlSetKind,
    point: dict[Any, Any],
    limits: Sequence[sp.Symbol],
    m: int,
    rng: random.Random,
    count: int,
) -> list[list[Any]]:
    """Draw random controls from the control set, its corners and boundary included."""
    found = []
    for _ in range(count):
        if control_set == "box":
            fraction = [rng.choice((0.0, 1.0, rng.random())) for _ in range(m)]
            found.append(
                [point[limits[i]] + s * (point[limits[m + i]] - point[limits[i]]) for i, s in enumerate(fraction)]
            )
        else:
            direction = [mp.mpf(rng.gauss(0, 1)) for _ in range(m)]
            length = point[limits[0]] * rng.choice((1.0, rng.random())) if control_set == "ball" else rng.uniform(0, 3)
            norm = mp.sqrt(sum(d**2 for d in direction))
            found.append([d / norm * length for d in direction])
    return found


def by_circle(expression: sp.Expr, angle: sp.Symbol) -> tuple[sp.Expr, sp.Expr, sp.Expr] | None:
    """Return c, a and b of c + a cos(angle) + b sin(angle); ``None`` where an expression is no such sum."""
    along, across = sp.Dummy("along", real=True), sp.Dummy("across", real=True)

    def apart(e: sp.Expr) -> sp.Expr:
        return sp.expand_trig(e).xreplace({sp.cos(angle): along, sp.sin(angle): across})

    turned = sp.sympify(expression).replace(lambda e: e.func in (sp.sin, sp.cos, sp.tan) and e.has(angle), apart)
    slopes = [sp.diff(turned, v) for v in (along, across)]
    if turned.has(angle) or any(depends(s, [along, across]) for s in slopes):
        return None
    none = {along: sp.Integer(0), across: sp.Integer(0)}
    return (turned.xreplace(none), *(s.xreplace(none) for s in slopes))
