"""How H is minimised over one set of controls: which branch applies, and what the minimiser is made of.

H must be a sum of functions of the controls of one set each. One that is quadratic in its controls has its minimum
where its derivative vanishes, or nearest to that within the set; one that is linear in them has it in the direction
against the slope, as far as the set goes; of ``a cos u + b sin u`` it is at the angle of ``(-a, -b)``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp
from sympy.solvers.solveset import NonlinearError

from satsym.spec import Branch
from satsym.symbolic.algebra import gradient, simplified, tidy
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.principle.parts import Part


@dataclass(frozen=True)
class Minimum:
    """What the minimiser of H over one set is made of.

    Attributes
    ----------
    part
        The set.
    branch
        Which branch applies.
    vector
        Where H is linear in a vector, its slope: H_u of the controls, or what multiplies cosine and sine of an angle.
    weight
        What multiplies the norm of such a vector in H; zero where it does not occur.
    gradient, hats, hessian
        Where it is quadratic: H_u, the controls at which that vanishes, and H_uu.
    """

    part: Part
    branch: Branch
    vector: tuple[sp.Expr, ...] = ()
    gradient: tuple[sp.Expr, ...] = ()
    hats: tuple[sp.Expr, ...] = ()
    hessian: sp.Matrix | None = None
    weight: sp.Expr = sp.Integer(0)


def minima(name: str, h: sp.Expr, parts: Sequence[Part]) -> tuple[Minimum, ...]:
    """The branch of each set.

    Parameters
    ----------
    name
        Of what is derived, for messages.
    h
        The Hamiltonian.

    Raises
    ------
    DerivationError
        Where there is none, with the reason.
    """
    found = []
    h = with_norms(h, parts)
    for part in parts:
        others = {u for other in parts if other is not part for u in other.symbols}
        slopes = [tidy(g, part.symbols) for g in gradient(h, part.symbols)]
        for u, slope in zip(part.symbols, slopes, strict=True):
            norms = {norm_of(other) for other in parts if other is not part}
            if mixed := sorted(v.name for v in slope.free_symbols & (others | norms)):
                raise DerivationError(
                    f"{name}: H has products of {u.name} with {', '.join(mixed)}, which are in other control sets; "
                    "this is not supported: state them as one set, such as the components of a vector"
                )
            if slope == 0 and not h.has(norm_of(part)):
                raise DerivationError(f"{name}: {u.name} enters neither the motion nor the cost; leave it out")
        found.append(_of_angle(name, h, part) if part.kind == "angle" else _of_vector(name, h, part, slopes))
    return tuple(found)


def _of_angle(name: str, h: sp.Expr, part: Part) -> Minimum:
    (angle,) = part.symbols
    parts = by_circle(h, angle)
    if parts is None:
        raise DerivationError(
            f"{name}: H is not a sum a cos({angle.name}) + b sin({angle.name}) + c, so that no angle is known to "
            "minimise it"
        )
    _, cosine, sine = parts
    return Minimum(part, "direction", (tidy(cosine), tidy(sine)))


def by_circle(expression: sp.Expr, angle: sp.Symbol) -> tuple[sp.Expr, sp.Expr, sp.Expr] | None:
    """c, a and b of c + a cos(angle) + b sin(angle); ``None`` where an expression is no such sum."""
    along, across = sp.Dummy("along", real=True), sp.Dummy("across", real=True)

    def apart(e: sp.Expr) -> sp.Expr:
        return sp.expand_trig(e).xreplace({sp.cos(angle): along, sp.sin(angle): across})

    turned = sp.sympify(expression).replace(lambda e: e.func in (sp.sin, sp.cos, sp.tan) and e.has(angle), apart)
    slopes = [sp.diff(turned, v) for v in (along, across)]
    if turned.has(angle) or any(sp.simplify(s).has(along, across) for s in slopes if s.has(along, across)):
        return None
    none = {along: sp.Integer(0), across: sp.Integer(0)}
    return (turned.xreplace(none), *(s.xreplace(none) for s in slopes))


def norm_of(part: Part) -> sp.Symbol:
    """The symbol for the norm of the controls of a set."""
    return sp.Symbol(f"norm_of_{part.name}", nonnegative=True)


def with_norms(expression: sp.Expr, parts: Sequence[Part]) -> sp.Expr:
    """An expression with symbols for the norms of controls of sets that limit these."""
    found = sp.sympify(expression)
    for part in parts:
        if part.kind not in ("ball", "annulus"):
            continue
        square, norm = sp.expand(sum(u**2 for u in part.symbols)), norm_of(part)
        roots = [p for p in found.atoms(sp.Pow) if 2 * p.exp % 2 == 1 and sp.expand(p.base) == square]
        found = found.xreplace({p: norm ** (2 * p.exp) for p in roots})
        if len(part.symbols) == 1:
            found = found.xreplace({sp.Abs(part.symbols[0]): norm})
    return found


def _of_vector(name: str, h: sp.Expr, part: Part, slopes: list[sp.Expr]) -> Minimum:
    controls, norm = ", ".join(u.name for u in part.symbols), norm_of(part)
    weight = sp.diff(h, norm)
    if weight != 0:
        if weight.has(norm, *part.symbols) or any(slope.has(norm, *part.symbols) for slope in slopes):
            raise DerivationError(f"{name}: H is not linear in {controls} and in their norm, which is not supported")
        if len(slopes) == 1:
            raise DerivationError(
                f"{name}: the norm of {controls} alone is its magnitude; state a box, and |{controls}|"
            )
        return Minimum(part, "throttled", tuple(slopes), weight=tidy(weight))
    try:
        rows, load = sp.linear_eq_to_matrix(slopes, part.symbols)
    except NonlinearError:
        message = f"{name}: H is neither linear nor quadratic in {controls}, which is not supported"
        raise DerivationError(message) from None
    if all(entry == 0 for entry in rows):
        if part.kind not in ("ball", "annulus"):
            raise DerivationError(
                f"{name}: H is linear in {controls}, so that its minimum is where they end; {part.name!r} has to be a "
                "ball, or all controls of the problem to be in one box"
            )
        if len(slopes) == 1:
            raise DerivationError(
                f"{name}: H is linear in {controls} alone, which switches and does not turn; state a problem whose "
                "controls are all in one box"
            )
        return Minimum(part, "direction", tuple(slopes))
    if sp.simplify(rows.det()) == 0:
        raise DerivationError(f"{name}: H_uu of {controls} is singular, so H_u = 0 does not determine them")
    hats = tuple(tidy(simplified(u)) for u in rows.LUsolve(load))
    return Minimum(part, "quadratic", (), tuple(slopes), hats, rows.applyfunc(sp.simplify))
