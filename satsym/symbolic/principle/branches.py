"""The minimiser of H over one set of controls: the branch that applies, and the parts of the minimiser.

H must be a sum of functions of the controls of one set each. A function that is quadratic in its controls has its
minimum where its derivative vanishes, or at the nearest point of the set; a linear one has it in the direction against
the slope, on the boundary of the set; ``a cos u + b sin u`` has it at the angle of ``(-a, -b)``. Any other function of
one control has its minimum where its slope vanishes, see :mod:`satsym.symbolic.principle.stationary`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import sympy as sp
from sympy.solvers.solveset import NonlinearError

from satsym.control_part import DIRECTED, Branch
from satsym.symbolic.algebra import gradient, simplified, simplify, tidy, vanishes
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.functions.roots import Argmin, Bearing, Choice, Convex, Middle, Vertex
from satsym.symbolic.principle.control_sets import by_circle, refuse_singular
from satsym.symbolic.principle.parts import Part
from satsym.symbolic.principle.stationary import indefinite, minimiser, nearest_angle, with_angle


@dataclass(frozen=True)
class Minimum:
    """The parts of the minimiser of H over one set of controls.

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
    laws: tuple[sp.Expr, ...] = ()
    """Minimisers within the bounds if H is neither linear nor quadratic in the controls."""
    turned_by: sp.Symbol | None = None
    """Angle of rotation of the vector that a magnitude, such as a thrust, multiplies."""
    turned_to: sp.Expr | None = None
    """Minimising value of this angle if the angle has bounds."""

    @property
    def directed(self) -> bool:
        """Tell whether the minimiser is a direction."""
        return self.branch in DIRECTED

    @property
    def remarks(self) -> set[str]:
        """Return the keys of remarks on such a control law."""
        said = {Choice: "least of two minimisers", Middle: "nearer end of the angles", Convex: "only where convex"}
        said |= {Vertex: "ends compared where not convex", Argmin: "least of all minimisers"}
        return {key for kind, key in said.items() for law in self.laws if law.has(kind)}


@lru_cache(maxsize=64)  # every step asks again
def minima(name: str, h: sp.Expr, parts: tuple[Part, ...], side: int = 1) -> tuple[Minimum, ...]:
    """Find the branch of the minimiser over each set.

    Parameters
    ----------
    name
        Of what is derived, for messages.
    h
        The Hamiltonian.
    side
        Minus one where it is maximised.

    Raises
    ------
    DerivationError
        Where there is none, with the reason.
    """
    found = []
    h = with_norms(h, parts)
    coupled = _coupled(name, h, parts, side)
    for part in parts:
        others = {u for other in parts if other is not part for u in other.symbols}
        if part.name in coupled:
            found.append(coupled[part.name])
            continue
        slopes = [tidy(g, part.symbols) for g in gradient(h, part.symbols)]
        for u, slope in zip(part.symbols, slopes, strict=True):
            norms = {norm_of(other) for other in parts if other is not part}
            if mixed := sorted(v.name for v in slope.free_symbols & (others | norms)):
                raise DerivationError(
                    f"{name}: H contains products of {u.name} and {', '.join(mixed)}, which belong to different "
                    "control sets; this is not supported: declare them as one set, such as the components of a vector"
                )
            if slope.has(sp.sign):
                raise DerivationError(
                    f'{name}: |{u.name}| is not supported together with control_sets; write control_set = "box" for '
                    "all controls, or use two controls, one for each sign, both with the lower bound 0"
                )
            if slope == 0 and not h.has(norm_of(part)):
                raise DerivationError(f"{name}: {u.name} enters neither the motion nor the cost; leave it out")
        found.append(_of_angle(name, h, part) if part.kind == "angle" else _of_vector(name, h, part, slopes, side))
    return tuple(found)


def _coupled(name: str, h: sp.Expr, parts: Sequence[Part], side: int) -> dict[str, Minimum]:
    """Find the branches of an angle and of a control that multiplies functions of it in H, by names of sets."""
    found: dict[str, Minimum] = {}
    for turned, beside in product(parts, repeat=2):
        if turned.kind not in ("angle", "box") or beside.kind not in ("free", "box"):
            continue
        if turned is beside or len(turned.symbols + beside.symbols) > 2:
            continue
        (angle,), (u,) = turned.symbols, beside.symbols
        circle = by_circle(h, angle)
        if circle is None or not any(e.has(u) for e in circle[1:]) or by_circle(h, u):
            continue
        if vanishes(sp.diff(h, u, 2)):
            found |= _turned(name, circle, turned, beside, side)
            continue
        arc = ends_of(turned, angle) if turned.kind == "box" else None
        others = {v for part in parts if part not in (turned, beside) for v in part.symbols}
        slopes = gradient(h, (u, angle))
        laws = (
            None
            if any(s.has(*others) for s in slopes)
            else with_angle(name, side * h, u, ends_of(beside, u), angle, arc)
        )
        if laws is not None:
            found[beside.name] = Minimum(beside, "stationary", gradient=tuple(slopes[:1]), laws=laws[:1])
            found[turned.name] = Minimum(turned, "stationary", gradient=tuple(slopes[1:]), laws=laws[1:])
    return found


def _turned(
    name: str, circle: tuple[sp.Expr, sp.Expr, sp.Expr], turned: Part, beside: Part, side: int
) -> dict[str, Minimum]:
    """Find the minimiser over a magnitude and the angle that turns it: the best angle, and a switching magnitude."""
    (angle,), (u,) = turned.symbols, beside.symbols
    rest, *pair = circle
    alone = not all(vanishes(e.xreplace({u: sp.Integer(0)})) for e in pair)
    if alone or beside.kind != "box":
        raise DerivationError(
            f"{name}: H is linear in {u.name}, the magnitude of a vector whose direction is the angle "
            f'{angle.name}; this requires "{u.name}": Box("{u.name}") and no other vector with the direction '
            f"{angle.name}; or use the components of this vector as controls in a Ball"
        )
    cosine, sine = (tidy(sp.diff(e, u)) for e in pair)
    bounded = turned.kind == "box"
    law = nearest_angle(side * cosine, side * sine, ends_of(turned, angle)) if bounded else None
    magnitude = Minimum(
        beside, "throttled", (cosine, sine), weight=tidy(sp.diff(rest, u)), turned_by=angle, turned_to=law
    )
    law = law or Bearing(-side * sine, -side * cosine)
    slope = tidy(u * (cosine * -sp.sin(angle) + sine * sp.cos(angle)))
    return {
        beside.name: magnitude,
        turned.name: Minimum(turned, "stationary", gradient=(slope,), laws=(law,)),
    }


def ends_of(part: Part, u: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """Return the bounds of one control of a box; infinite for other sets."""
    if part.kind != "box":
        return -sp.oo, sp.oo
    at, half = part.symbols.index(u), len(part.bounds) // 2
    return part.bounds[at], part.bounds[half + at]


def _of_angle(name: str, h: sp.Expr, part: Part) -> Minimum:
    (angle,) = part.symbols
    parts = by_circle(h, angle)
    if parts is None:
        raise DerivationError(
            f"{name}: H does not have the form a cos({angle.name}) + b sin({angle.name}) + c, so the angle "
            "that minimises H cannot be derived"
        )
    _, cosine, sine = parts
    return Minimum(part, "direction", (tidy(cosine), tidy(sine)))


def norm_of(part: Part) -> sp.Symbol:
    """Return the symbol for the norm of the controls of a set."""
    return sp.Symbol(f"norm_of_{part.name}", nonnegative=True)


def with_norms(expression: sp.Expr, parts: Sequence[Part]) -> sp.Expr:
    """Replace norms of controls by symbols, for the sets that limit these norms."""
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


def _of_vector(name: str, h: sp.Expr, part: Part, slopes: list[sp.Expr], side: int) -> Minimum:
    controls, norm = ", ".join(u.name for u in part.symbols), norm_of(part)
    weight = sp.diff(h, norm)
    if weight != 0:
        if weight.has(norm, *part.symbols) or any(slope.has(norm, *part.symbols) for slope in slopes):
            raise DerivationError(
                f"{name}: an H that is not jointly linear in {controls} and their norm is not supported"
            )
        if len(slopes) == 1:
            raise DerivationError(
                f"{name}: the norm of the single control {controls} is its magnitude; use a Box, and write |{controls}|"
            )
        return Minimum(part, "throttled", tuple(slopes), weight=tidy(weight))
    try:
        rows, load = sp.linear_eq_to_matrix(slopes, part.symbols)
    except NonlinearError:
        return _of_each(name, side * h, part, slopes)
    if all(entry == 0 for entry in rows):
        if part.kind == "free":
            raise DerivationError(f"{name}: H is linear in {controls}, which has no bounds; use a Box or a Ball")
        if part.kind != "box" and len(slopes) == 1:
            raise DerivationError(
                f"{name}: H is linear in the single control {controls}, so there is no direction to choose; use a Box"
            )
        return Minimum(part, "switched" if part.kind == "box" else "direction", tuple(slopes))
    refuse_singular(name, part.kind, part.symbols, rows)
    if part.kind == "box" and rows.is_diagonal() and any(_falls(name, side * row) for row in rows.diagonal()):
        bends, falls = rows.diagonal(), (side * tidy(-entry) for entry in load)
        each = zip(part.symbols, bends, falls, strict=True)
        laws = tuple(Vertex(side * simplified(bend), fall, *ends_of(part, u)) for u, bend, fall in each)
        return Minimum(part, "stationary", gradient=tuple(slopes), laws=laws)
    hats = tuple(tidy(simplified(u)) for u in rows.LUsolve(load))
    return Minimum(part, "quadratic", (), tuple(slopes), hats, rows.applyfunc(simplify))


def _falls(name: str, curvature: sp.Expr) -> bool:
    """Tell whether H is concave in a control, everywhere or in places."""
    return bool(simplify(curvature).is_negative) or indefinite(name, curvature)


def _of_each(name: str, h: sp.Expr, part: Part, slopes: list[sp.Expr]) -> Minimum:
    """Find minimisers, one by one, of controls on which H depends neither linearly nor quadratically."""
    controls = ", ".join(u.name for u in part.symbols)
    if part.kind not in ("free", "box"):
        raise DerivationError(
            f"{name}: H is neither linear nor quadratic in {controls}, so this control must be "
            "unbounded (Free) or have bounds of its own (Box)"
        )
    apart = all(not s.has(*(v for v in part.symbols if v != u)) for u, s in zip(part.symbols, slopes, strict=True))
    if not apart:
        raise DerivationError(
            f"{name}: an H that contains products of {controls} but is not quadratic in them is not supported"
        )
    if part.kind == "free" and any(by_circle(h, u) for u in part.symbols):
        raise DerivationError(f"{name}: {controls} is an angle without bounds; use Angle({controls!r})")
    laws = tuple(minimiser(name, h, u, ends_of(part, u)) for u in part.symbols)
    return Minimum(part, "stationary", gradient=tuple(slopes), laws=laws)
