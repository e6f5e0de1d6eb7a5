"""The minimiser of H over each set of a product, and over the sets of the regularised problem."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import sympy as sp

from satsym.control_part import SWITCHED, PartKind
from satsym.spec import ControlSetKind
from satsym.symbolic import notation as n
from satsym.symbolic.convention import sign
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.functions.minimisers import Clip, Stretch, Switch, Within
from satsym.symbolic.functions.roots import Choice
from satsym.symbolic.model import Problem, symbols_of
from satsym.symbolic.principle import control_sets
from satsym.symbolic.principle import effort as pn
from satsym.symbolic.principle.branches import Minimum, minima, norm_of, with_norms
from satsym.symbolic.principle.control_sets import by_circle
from satsym.symbolic.principle.parts import FRACTION, SMOOTHING, minimum_norm_of, parts_of

EPSILON, FACTOR = symbols_of((SMOOTHING, FRACTION))


def found(so_far: Derivation) -> tuple[Minimum, ...]:
    """Return the minimiser's branches for all sets, from a derivation that contains its Hamiltonian."""
    problem = problem_of(so_far)
    return minima(so_far.name, so_far.equation("hamiltonian.H").rhs, parts_of(problem), sign(problem))


def problem_of(so_far: Derivation) -> Problem:
    """Return the problem of a derivation, which must have one."""
    if so_far.problem is None:
        raise TypeError(f"{so_far.name} has no cost")
    return so_far.problem


def bare(kind: PartKind) -> ControlSetKind:
    """Return the simple set with the same outer limit as this kind of set; an angle is not limited."""
    return "free" if kind == "angle" else "ball" if kind == "annulus" else kind


def relaxed(so_far: Derivation, expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """Replace directions in expressions by vectors that may be shorter, as in the regularised problem."""
    values = [with_norms(e, parts_of(problem_of(so_far))) for e in expressions]
    for part in (one.part for one in found(so_far) if one.directed):
        if part.kind != "angle":
            continue
        (angle,), (along, across) = part.symbols, pn.components_of(part)
        taken = [by_circle(value, angle) for value in values]
        if any(one is None for one in taken):
            message = f"the motion or the cost is not linear in cos({angle.name}) and sin({angle.name})"
            raise DerivationError(f"{so_far.name}: {message}")
        values = [c + a * along + b * across for one in taken if one is not None for c, a, b in (one,)]
    for one in (one for one in found(so_far) if one.turned_by):
        (size,) = one.part.symbols
        values = [_with_norm(value, size, one.turned_by, norm_of(one.part)) for value in values]
    return values


def _with_norm(value: sp.Expr, size: sp.Symbol, angle: sp.Symbol, norm: sp.Symbol) -> sp.Expr:
    """Replace a magnitude by a symbol where it occurs apart from the angle that turns it."""
    circle = by_circle(value, angle)
    if circle is None:
        return value
    rest, cosine, sine = circle
    return rest.xreplace({size: norm}) + cosine * sp.cos(angle) + sine * sp.sin(angle)


def regularised_law(so_far: Derivation) -> dict[sp.Symbol, sp.Expr]:
    """Return the quantities that replace controls, or components of directions, in the regularised problem."""
    problem, every = problem_of(so_far), found(so_far)
    laws: dict[sp.Symbol, sp.Expr] = {}
    for one in every:
        if one.directed:
            laws |= dict(zip(pn.components_of(one.part), shortened(problem, one), strict=True))
            if one.weight != 0:
                laws[norm_of(one.part)] = FACTOR * _size(problem, one)
        else:
            laws |= dict(zip(one.part.symbols, law_of(problem, one), strict=True))
    return dict(zip(laws, with_minimum_norms(so_far, written_out(so_far, laws.values())), strict=True))


def throttled(so_far: Derivation) -> tuple[Minimum, ...]:
    """Return the sets in which a norm of a vector, or a single control, switches."""
    return tuple(one for one in found(so_far) if one.branch in SWITCHED)


def with_minimum_norms(so_far: Derivation, expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """Add minimum norms to laws of vectors in balls, so that the vectors can be kept at any norm."""
    balls = [one.part for one in throttled(so_far) if one.part.kind == "ball"]
    least = {part.bounds[-1]: symbols_of((minimum_norm_of(part),))[0] for part in balls}

    def raised(value: sp.Expr, lower: sp.Expr, upper: sp.Expr) -> sp.Expr:
        return Clip(value, least[upper] if lower == 0 and upper in least else lower, upper)

    return [e.replace(Clip, raised) for e in expressions]


def throttle_slopes(so_far: Derivation) -> list[sp.Expr]:
    """Return the derivatives of H by the switching norms, in the direction in which H changes least."""
    slopes: list[sp.Expr] = []
    for one in throttled(so_far):
        if one.branch == "switched":
            slopes += pn.slopes_of(one)
            continue
        slopes.append(pn.weight_of(one.part.symbols[0]) - sign(problem_of(so_far)) * _gain(problem_of(so_far), one))
    return written_out(so_far, slopes)


def effort(so_far: Derivation) -> sp.Expr:
    """Return the additional cost of the regularised problem, by its components."""
    every = [one for one in found(so_far) if one.directed]
    return EPSILON / 2 * sum((c**2 for one in every for c in pn.components_of(one.part)), sp.Integer(0))


def written_out(so_far: Derivation, expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """Replace symbols of slopes in expressions by their values."""
    values = {
        s: value
        for one in found(so_far)
        if one.directed
        for s, value in zip(pn.slopes_of(one), one.vector, strict=True)
    }
    values |= {pn.weight_of(one.part.symbols[0]): one.weight for one in found(so_far) if one.branch == "throttled"}
    values |= {n.optimal(one.turned_by): one.turned_to for one in found(so_far) if one.turned_by and one.turned_to}
    return [e.xreplace(values) for e in expressions]


def law_of(problem: Problem, one: Minimum) -> list[sp.Expr]:
    """Return the minimiser of H over one set."""
    part = one.part
    if one.branch == "stationary":
        return list(one.laws)
    if one.directed:
        return _directed(problem, one)
    assert one.hessian is not None
    if part.kind == "annulus":
        control_sets.refuse_unequal(one.hessian)
        factor = Within(sum((u**2 for u in one.hats), sp.Integer(0)), *part.bounds)
        return [factor * u for u in one.hats]
    return control_sets.project(bare(part.kind), one.hats, part.bounds, one.hessian)


def _directed(problem: Problem, one: Minimum) -> list[sp.Expr]:
    """Return the minimiser of a function that is linear in a direction, and perhaps in its length."""
    slopes, ends = pn.slopes_of(one), one.part.bounds
    if one.part.kind == "angle":
        along, across = (-sign(problem) * s for s in slopes)
        return [sp.atan2(across, along)]
    if one.branch == "switched":
        return [Switch(sign(problem) * slopes[0], 0, *ends)]
    ways = [sp.Integer(1)] if one.turned_by else [-sign(problem) * s / _length(slopes) for s in slopes]
    if one.weight == 0:
        return [ends[-1] * way for way in ways]
    excess = _gain(problem, one) - sign(problem) * pn.weight_of(one.part.symbols[0])
    shortest = sp.Integer(0) if one.part.kind == "ball" else ends[0]
    return [Choice(excess, shortest * way, ends[-1] * way) for way in ways]


def continuous_law(problem: Problem, one: Minimum) -> list[sp.Expr]:
    """Return the law that solvers use: for directions, that of the regularised problem."""
    return shortened(problem, one) if one.directed and one.part.kind != "angle" else law_of(problem, one)


def shortened(problem: Problem, one: Minimum) -> list[sp.Expr]:
    """Return the minimiser with half the square weighted by the smoothing, by the components of the slope."""
    slopes = pn.slopes_of(one)
    if one.branch == "switched":
        return [Clip(-sign(problem) * slopes[0] / EPSILON, *one.part.bounds)]
    square = sum((s**2 for s in slopes), sp.Integer(0))
    if one.turned_by:
        return [_size(problem, one)]
    if one.weight != 0:
        return [-sign(problem) * s / _length(slopes) * _size(problem, one) for s in slopes]
    factor = Stretch(square, EPSILON, one.part.bounds[-1])
    return [-sign(problem) * s * factor for s in slopes]


def _size(problem: Problem, one: Minimum) -> sp.Expr:
    """Return the norm of the regularised minimiser, where H depends on the norm."""
    margin = _gain(problem, one) - sign(problem) * FACTOR * pn.weight_of(one.part.symbols[0])
    return Clip(margin / EPSILON, 0 if one.part.kind == "ball" else one.part.bounds[0], one.part.bounds[-1])


def _gain(problem: Problem, one: Minimum) -> sp.Expr:
    """Return by how much a vector of norm one lowers H in the best direction; an angle may have bounds."""
    slopes = pn.slopes_of(one)
    if one.turned_by is None or one.turned_to is None:
        return _length(slopes)
    best = n.optimal(one.turned_by)
    return -sign(problem) * (slopes[0] * sp.cos(best) + slopes[1] * sp.sin(best))


def _length(vector: Sequence[sp.Expr]) -> sp.Expr:
    return sp.sqrt(sum((s**2 for s in vector), sp.Integer(0)))
