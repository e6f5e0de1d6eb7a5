"""The minimiser of H over each set of a product, and over the sets of the regularised problem, with its checks.

The checks compare numbers: H is a sum over the sets, and no admissible control has a lower H.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.control_part import SWITCHED, PartKind
from satsym.spec import ControlSetKind
from satsym.symbolic import notation as n
from satsym.symbolic.checks import Point, compare, never_below, numeric, positive, vanishes
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Check, Derivation, DerivationError
from satsym.symbolic.functions.minimisers import Clip, Stretch, Switch, Within
from satsym.symbolic.functions.roots import Choice
from satsym.symbolic.model import Problem, symbols_of
from satsym.symbolic.principle import control_sets
from satsym.symbolic.principle import effort as pn
from satsym.symbolic.principle.branches import Minimum, minima, norm_of, with_norms
from satsym.symbolic.principle.control_sets import by_circle
from satsym.symbolic.principle.parts import FRACTION, SMOOTHING, limits_of, minimum_norm_of, parts_of, unsigned
from satsym.symbolic.principle.pontryagin import COMPETITORS, costates

EPSILON, FACTOR = symbols_of((SMOOTHING, FRACTION))

SCALES = (0.1, 1.0, 10.0)
"""Factors of the costates at each random point."""

NEARBY_CONTROLS = 4
"""Number of admissible controls near the control law with which the law is compared, for each set."""

TRIES = 60
"""Largest number of random costates that are tried until the Hamiltonian has a minimum."""


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


def adds_up(so_far: Derivation, h: sp.Expr, every: Sequence[Minimum]) -> Check:
    """Check that the change of H from some controls to others is the sum of the changes in each set.

    Controls on which H depends otherwise than linearly, quadratically or as on an angle stay as they are.
    """
    turned = {one.turned_by for one in every if one.turned_by}
    moving = [one for one in every if one.branch != "stationary" or turned & {*one.part.symbols}]
    other = {u: sp.Dummy(f"other_{u.name}", real=True) for one in moving for u in one.part.symbols}
    changes = [change for one in every if one.branch != "stationary" for change in _changes(one, other)]
    value, change = numeric([h]), numeric([sum(changes, sp.Integer(0))])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        there = {**point, **{u: point[v] for u, v in other.items()}}
        return change(point), [value(there)[0] - value(point)[0]]

    return compare("adds up to H", h.free_symbols.union(other, other.values(), costates(so_far)), sides)


def _changes(one: Minimum, other: Mapping[sp.Symbol, sp.Symbol]) -> list[sp.Expr]:
    """Return the change of H by the controls of one set; with a magnitude, also by the angle that turns it."""
    symbols, angle = one.part.symbols, one.turned_by or one.part.symbols[0]
    if one.turned_by or one.part.kind == "angle":
        sizes = (symbols[0], other[symbols[0]]) if one.turned_by else (sp.Integer(1), sp.Integer(1))
        moved = [sizes[1] * f(other[angle]) - sizes[0] * f(angle) for f in (sp.cos, sp.sin)]
        return [s * m for s, m in zip((*one.vector, one.weight), (*moved, sizes[1] - sizes[0]), strict=True)]
    if one.directed:
        before, after = (sp.sqrt(sum(v**2 for v in w)) for w in (symbols, [other[u] for u in symbols]))
        moved = [*(other[u] - u for u in symbols), after - before]
        return [s * m for s, m in zip((*one.vector, one.weight), moved, strict=True)]
    assert one.hessian is not None
    move = sp.Matrix([other[u] - u for u in symbols])
    return [(sp.Matrix(one.gradient).T * move)[0], (move.T * one.hessian * move)[0] / 2]


def convex(so_far: Derivation, one: Minimum) -> Any:
    """Check that H_uu of one set is positive definite."""
    problem, h = problem_of(so_far), so_far.equation("hamiltonian.H").rhs
    assert one.hessian is not None
    minors = [(sign(problem) * one.hessian[:k, :k]).det() for k in range(1, one.hessian.rows + 1)]
    definite = positive(worded("positive minors", problem), h.free_symbols, minors)
    if not definite.passed or any(vanishes(worded("positive minors", problem), m) for m in minors):
        raise DerivationError(
            f"{so_far.name}: H_uu of {one.part.name!r} is not definite, so H has no {problem.convention} in these "
            f"controls; {unsigned(problem, one.hessian)}"
        )
    return definite


def cheapest(so_far: Derivation, h: sp.Expr, laws: Sequence[sp.Expr]) -> Any:
    """Check that no admissible control has a lower H, set by set and for all sets together."""
    problem, every = problem_of(so_far), found(so_far)
    controls = symbols_of(problem.model.controls)
    value, chosen, limits = numeric([h]), numeric(list(laws)), symbols_of(limits_of(problem))

    def margins(point: Point, rng: random.Random) -> list[Any]:
        margin = []
        for scale in SCALES:
            here = {**point, **{c: scale * point[c] for c in costates(so_far)}}
            for one in every:
                here = ordered(one, here)
            if (decided := _decided(chosen, here, costates(so_far), rng)) is None:
                continue
            here, law = decided[0], dict(zip(controls, decided[1], strict=True))
            best = value({**here, **law})[0]
            for one in every:
                margin += _slacks(one, here, law)
            margin += _beside(so_far, value, chosen, here, rng)
            for _ in range(COMPETITORS):
                other = {u: v for one in every for u, v in drawn(one, here, rng).items()}
                margin.append(sign(problem) * (value({**here, **other})[0] - best))
        return margin or [mp.nan]

    everything = {*limits, *controls, *costates(so_far)} | h.free_symbols.union(*(e.free_symbols for e in laws))
    unlimited = all(one.part.kind in ("free", "angle") for one in every)
    return never_below(worded("cheapest of all" if unlimited else "cheapest admissible", problem), everything, margins)


def _beside(so_far: Derivation, value: Any, chosen: Any, here: Point, rng: random.Random) -> list[Any]:
    """Return the increase of H for admissible controls close to the law, where a slip in the law shows.

    Farther away H grows with the square of the distance, which hides a small distance of the law from the minimiser.
    """
    problem, margin, step = problem_of(so_far), list[Any](), mp.mpf(10) ** -mp.mp.dps
    with mp.workdps(3 * mp.mp.dps):
        law = dict(zip(symbols_of(problem.model.controls), chosen(here), strict=True))
        best = value({**here, **law})[0]
        for one in found(so_far):
            for _ in range(NEARBY_CONTROLS):
                other = {**law, **near(one, here, law, step, rng)}
                margin.append(sign(problem) * (value({**here, **other})[0] - best) / step)
    return margin


def near(
    one: Minimum, point: Point, law: Mapping[sp.Symbol, Any], step: Any, rng: random.Random
) -> dict[sp.Symbol, Any]:
    """Return the law over one set, moved by a step within the set.

    Where a single control may move alone, it does, so that no control hides another.
    """
    symbols, limits, kind = one.part.symbols, one.part.bounds, bare(one.part.kind)
    if kind == "box":
        k = rng.randrange(len(symbols))
        end = point[limits[rng.choice((k, k + len(symbols)))]]
        return {symbols[k]: law[symbols[k]] + step * (end - law[symbols[k]])}
    before = [law[u] for u in symbols]
    size = mp.sqrt(sum(u**2 for u in before))
    if kind == "free":
        k = rng.randrange(len(symbols))
        return {symbols[k]: before[k] + rng.choice((-1, 1)) * step * (size or 1)}
    moved = [u + step * point[limits[-1]] * mp.mpf(rng.gauss(0, 1)) for u in before]
    norm = mp.sqrt(sum(u**2 for u in moved))
    least = point[limits[0]] if one.part.kind == "annulus" else 0
    wanted = max(least, min(norm, point[limits[-1]]))
    return {u: v * wanted / norm for u, v in zip(symbols, moved, strict=True)}


def _decided(
    chosen: Any, here: Point, moved: Sequence[sp.Symbol], rng: random.Random
) -> tuple[Point, list[Any]] | None:
    """Return the point, or one with other costates, at which a minimiser exists, with that minimiser."""
    there = here
    for _ in range(TRIES):
        law = chosen(there)
        if not any(v != v or mp.im(v) for v in law):
            return there, law
        there = {s: v * rng.choice((-1, 1)) * 10 ** rng.uniform(-1, 2) if s in moved else v for s, v in here.items()}
    return None


def ordered(one: Minimum, point: Point) -> Point:
    """Return a point with bounds that leave room between them."""
    if one.part.kind == "angle":
        return {**point, one.part.bounds[0]: mp.mpf(1)}
    if one.part.kind == "annulus":
        low, high = sorted(point[b] for b in one.part.bounds)
        return {**point, one.part.bounds[0]: low, one.part.bounds[1]: high}
    if one.turned_by:  # which turns it round as well
        point = {**point, **{b: abs(point[b]) for b in one.part.bounds}}
    return control_sets.ordered(bare(one.part.kind), point, one.part.bounds)


def _slacks(one: Minimum, point: Point, law: dict[sp.Symbol, Any]) -> list[Any]:
    """Return how far the law is inside its set; a negative entry is a violated bound."""
    values = [law[u] for u in one.part.symbols]
    kind = bare(one.part.kind)
    limits = one.part.bounds[-1:] if kind == "ball" else one.part.bounds
    return control_sets.slacks(kind, point, limits, values)


def drawn(one: Minimum, point: Point, rng: random.Random) -> dict[sp.Symbol, Any]:
    """Draw a random admissible control of one set."""
    symbols, limits = one.part.symbols, one.part.bounds
    if one.part.kind == "angle":
        return {symbols[0]: mp.mpf(rng.uniform(-4, 4))}
    if one.part.kind == "annulus":
        (shown,) = control_sets.admissible("ball", {limits[1]: mp.mpf(1)}, limits[1:], len(symbols), rng, 1)
        norm = mp.sqrt(sum(v**2 for v in shown))
        size = point[limits[0]] + norm * (point[limits[1]] - point[limits[0]])
        return {u: v / norm * size for u, v in zip(symbols, shown, strict=True)}
    (shown,) = control_sets.admissible(bare(one.part.kind), point, limits, len(symbols), rng, 1)
    return dict(zip(symbols, shown, strict=True))
