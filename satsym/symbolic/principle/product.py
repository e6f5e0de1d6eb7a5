"""The law over a control set that is a product of sets: H taken apart, its minimum set by set, a continuous companion.

The law of a direction (an angle, or a vector in a ball on which H depends linearly) is continuous wherever its slope
does not vanish, but nothing leads to it from vanishing costates. In the regularised problem the direction may be
shorter, and half its square costs ``smoothing``: its law is proportional to the slope up to the full length, and the
same as the law itself where the slope is larger than the smoothing.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.spec import ControlSetKind, PartKind
from satsym.symbolic import notation as n
from satsym.symbolic.checks import Point, compare, never_below, numeric
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Conclusion, Derivation, DerivationError, Equation, Step
from satsym.symbolic.minimisers import Clip, Stretch, Within
from satsym.symbolic.model import Problem, symbols_of
from satsym.symbolic.principle import control_sets
from satsym.symbolic.principle import notation as pn
from satsym.symbolic.principle.branches import Minimum, by_circle, minima, norm_of, with_norms
from satsym.symbolic.principle.parts import FRACTION, SMOOTHING, limits_of, minimum_norm_of, parts_of
from satsym.symbolic.principle.pontryagin import COMPETITORS, costates

STEP = "control_parts"
"""The step that only derivations of such problems have."""

SCALES = (0.1, 1.0, 10.0)
"""Factors on the costates at each random point."""

EPSILON, FACTOR = symbols_of((SMOOTHING, FRACTION))


EXACT = {EPSILON: sp.Float(1e-25, 30), FACTOR: sp.Integer(1)}
"""With which the law of the regularised problem is that of the problem itself."""


def applies(so_far: Derivation) -> bool:
    """Whether the control set is stated set by set, or is a ball on which H is linear."""
    problem = so_far.problem
    if problem is None:
        return False
    if problem.control_sets:
        return True
    if problem.control_set != "ball" or len(problem.model.controls) == 1:
        return False
    controls = symbols_of(problem.model.controls)
    stated = [with_norms(e, parts_of(problem)) for e in (problem.running_cost, *so_far.rhs("first_order"))]
    return not any(sp.simplify(sp.diff(e, u, v)) != 0 for e in stated for u in controls for v in controls)


def found(so_far: Derivation) -> tuple[Minimum, ...]:
    """The branches of a derivation that has its Hamiltonian."""
    h = so_far.equation("hamiltonian.H").rhs
    return minima(so_far.name, h, parts_of(stated(so_far)))


def control_parts(so_far: Derivation) -> Step:
    """What H is of the controls of each set."""
    problem, h = stated(so_far), so_far.equation("hamiltonian.H").rhs
    every = found(so_far)
    equations: list[Equation] = []
    for one in every:
        symbols = one.part.symbols
        if one.branch == "quadratic":
            equations += [Equation(u.name, sp.Integer(0), g) for u, g in zip(symbols, one.gradient, strict=True)]
            equations += [
                Equation(f"{u.name}_hat", n.unconstrained(u), hat) for u, hat in zip(symbols, one.hats, strict=True)
            ]
        else:
            equations += [Equation(s.name, s, value) for s, value in zip(pn.slopes_of(one), one.vector, strict=True)]
            if one.weight != 0:
                weight = pn.weight_of(one.part.symbols[0])
                equations.append(Equation(weight.name, weight, one.weight))
    checks = [_adds_up(so_far, h, every)]
    checks += [_convex(so_far, one) for one in every if one.branch == "quadratic"]
    return Step(STEP, worded("set by set", problem), tuple(equations), ("hamiltonian",), tuple(checks))


def control_law(so_far: Derivation) -> Step:
    """The control that minimises H over the product of the sets: the minimiser over each."""
    problem, every = stated(so_far), found(so_far)
    laws = {u: law for one in every for u, law in zip(one.part.symbols, _law(problem, one), strict=True)}
    equations = tuple(Equation(u.name, n.optimal(u), laws[u]) for u in symbols_of(problem.model.controls))
    h = so_far.equation("hamiltonian.H").rhs
    exact = [e.rhs.xreplace(EXACT) for e in equations]
    check = _cheapest(so_far, h, written_out(so_far, exact))
    said = tuple(
        Conclusion("no direction where it vanishes", {"slope": sp.Tuple(*pn.slopes_of(one))})
        for one in every
        if one.branch != "quadratic"
    )
    return Step("control_law", worded("minimum set by set", problem), equations, (STEP,), (check,), said)


def smoothed_law(so_far: Derivation) -> Step | None:
    """Where controls are directions: H of the problem in which half their squares cost a little, and its law."""
    problem = stated(so_far)
    directions = [one for one in found(so_far) if one.branch != "quadratic"]
    if not directions:
        return None
    short = [component for one in directions for component in pn.components_of(one.part)]
    equations = [
        Equation("H", pn.REGULARISED_H, n.HAMILTONIAN + sign(problem) * EPSILON / 2 * sum(c**2 for c in short))
    ]
    for one in directions:
        laws = _shortened(problem, one)
        equations += [Equation(c.name, c, law) for c, law in zip(pn.components_of(one.part), laws, strict=True)]
    h = relaxed(so_far, [so_far.equation("hamiltonian.H").rhs])[0]
    h += sign(problem) * EPSILON / 2 * sum(c**2 for c in short)
    norms = {norm_of(one.part): FACTOR * sp.sqrt(sum(u**2 for u in one.part.symbols)) for one in directions}
    h = h.xreplace(norms)
    value, chosen = numeric([h]), numeric(written_out(so_far, [e.rhs for e in equations[1:]]))

    def margins(point: Point, rng: random.Random) -> list[Any]:
        margin = []
        for scale in SCALES:
            here = {**point, **{c: scale * point[c] for c in costates(so_far)}}
            for one in directions:
                here = ordered(one, here)
            law = chosen(here)
            best = value({**here, **dict(zip(short, law, strict=True))})[0]
            for _ in range(COMPETITORS):
                other: list[Any] = []
                for one in directions:
                    limit = here[one.part.bounds[-1]]
                    bounds = {sp.Symbol("radius"): limit}
                    size = len(pn.components_of(one.part))
                    if one.branch == "throttled":
                        other += _drawn(one, here, rng).values()
                    else:
                        other += control_sets.admissible("ball", bounds, list(bounds), size, rng, 1)[0]
                margin.append(sign(problem) * (value({**here, **dict(zip(short, other, strict=True))})[0] - best))
        return margin

    everything = {*short, *costates(so_far), EPSILON, *symbols_of(limits_of(problem))}
    everything |= h.free_symbols.union(*(e.free_symbols for e in written_out(so_far, [e.rhs for e in equations[1:]])))
    check = never_below(worded("cheapest admissible", problem), everything, margins)
    rule = worded("shorter directions", problem)
    return Step("smoothed_law", rule, tuple(equations), (STEP, "control_law"), (check,))


def relaxed(so_far: Derivation, expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """Expressions with directions as vectors that may be shorter: what the regularised problem has in place of them."""
    values = [with_norms(e, parts_of(stated(so_far))) for e in expressions]
    for part in parts_of(stated(so_far)):
        if part.kind != "angle":
            continue
        (angle,), (along, across) = part.symbols, pn.components_of(part)
        taken = [by_circle(value, angle) for value in values]
        if any(one is None for one in taken):
            message = f"the motion or the cost is not linear in cos({angle.name}) and sin({angle.name})"
            raise DerivationError(f"{so_far.name}: {message}")
        values = [c + a * along + b * across for one in taken if one is not None for c, a, b in (one,)]
    return values


def regularised_law(so_far: Derivation) -> dict[sp.Symbol, sp.Expr]:
    """What takes the place of controls, or of the components of directions, in the regularised problem."""
    problem, every = stated(so_far), found(so_far)
    laws: dict[sp.Symbol, sp.Expr] = {}
    for one in every:
        if one.branch != "quadratic":
            laws |= dict(zip(pn.components_of(one.part), _shortened(problem, one), strict=True))
            if one.weight != 0:
                laws[norm_of(one.part)] = FACTOR * _size(problem, one)
        else:
            laws |= dict(zip(one.part.symbols, _law(problem, one), strict=True))
    return dict(zip(laws, with_minimum_norms(so_far, written_out(so_far, laws.values())), strict=True))


def throttled(so_far: Derivation) -> tuple[Minimum, ...]:
    """The sets of vectors that may be none, or as short as they may be."""
    return tuple(one for one in found(so_far) if one.branch == "throttled")


def with_minimum_norms(so_far: Derivation, expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """Laws in which vectors in balls have a least norm, by which they can be kept at any."""
    least = {one.part.bounds[-1]: symbols_of((minimum_norm_of(one.part),))[0] for one in throttled(so_far)}

    def raised(value: sp.Expr, lower: sp.Expr, upper: sp.Expr) -> sp.Expr:
        return Clip(value, least[upper] if lower == 0 and upper in least else lower, upper)

    return [e.replace(Clip, raised) for e in expressions]


def throttle_slopes(so_far: Derivation) -> list[sp.Expr]:
    """How H changes with the norm of each of these vectors, in the direction in which it changes least."""
    slopes = []
    for one in throttled(so_far):
        length = sp.sqrt(sum((s**2 for s in pn.slopes_of(one)), sp.Integer(0)))
        slopes.append(pn.weight_of(one.part.symbols[0]) - sign(stated(so_far)) * length)
    return written_out(so_far, slopes)


def effort(so_far: Derivation) -> sp.Expr:
    """What the regularised problem costs besides, by its components."""
    every = [one for one in found(so_far) if one.branch != "quadratic"]
    return EPSILON / 2 * sum((c**2 for one in every for c in pn.components_of(one.part)), sp.Integer(0))


def written_out(so_far: Derivation, expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """Expressions with slopes as what they stand for."""
    values = {
        s: value
        for one in found(so_far)
        if one.branch != "quadratic"
        for s, value in zip(pn.slopes_of(one), one.vector, strict=True)
    }
    values |= {pn.weight_of(one.part.symbols[0]): one.weight for one in found(so_far) if one.weight != 0}
    return [e.xreplace(values) for e in expressions]


def _law(problem: Problem, one: Minimum) -> list[sp.Expr]:
    """The minimiser over one set."""
    part = one.part
    if one.branch != "quadratic":
        if part.kind != "angle":
            return _shortened(problem, one)
        along, across = (-sign(problem) * s for s in pn.slopes_of(one))
        return [sp.atan2(across, along)]
    assert one.hessian is not None
    if part.kind == "annulus":
        control_sets.refuse_unequal(one.hessian)
        factor = Within(sum((u**2 for u in one.hats), sp.Integer(0)), *part.bounds)
        return [factor * u for u in one.hats]
    return control_sets.project(_bare(part.kind), one.hats, part.bounds, one.hessian)


def _shortened(problem: Problem, one: Minimum) -> list[sp.Expr]:
    """The minimiser over a ball where half the square costs the smoothing, by the components of the slope."""
    slopes = pn.slopes_of(one)
    square = sum((s**2 for s in slopes), sp.Integer(0))
    if one.weight != 0:
        return [-sign(problem) * s / sp.sqrt(square) * _size(problem, one) for s in slopes]
    factor = Stretch(square, EPSILON, one.part.bounds[-1])
    return [-sign(problem) * s * factor for s in slopes]


def _size(problem: Problem, one: Minimum) -> sp.Expr:
    """The norm of that minimiser, where H depends on the norm."""
    length = sp.sqrt(sum((s**2 for s in pn.slopes_of(one)), sp.Integer(0)))
    margin = length - sign(problem) * FACTOR * pn.weight_of(one.part.symbols[0])
    return Clip(margin / EPSILON, one.part.bounds[0] if one.part.kind == "annulus" else 0, one.part.bounds[-1])


def _adds_up(so_far: Derivation, h: sp.Expr, every: Sequence[Minimum]) -> Any:
    """Check that the change of H from some controls to others is the sum of the changes in each set."""
    value = numeric([h])
    other = {u: sp.Dummy(f"other_{u.name}", real=True) for one in every for u in one.part.symbols}
    changes = []
    for one in every:
        symbols = one.part.symbols
        if one.part.kind == "angle":
            (angle,) = symbols
            moved = [f(other[angle]) - f(angle) for f in (sp.cos, sp.sin)]
            changes += [s * m for s, m in zip(one.vector, moved, strict=True)]
        elif one.branch != "quadratic":
            changes += [s * (other[u] - u) for s, u in zip(one.vector, symbols, strict=True)]
            before, after = (sp.sqrt(sum(v**2 for v in w)) for w in (symbols, [other[u] for u in symbols]))
            changes.append(one.weight * (after - before))
        else:
            assert one.hessian is not None
            move = sp.Matrix([other[u] - u for u in symbols])
            changes += [(sp.Matrix(one.gradient).T * move)[0], (move.T * one.hessian * move)[0] / 2]
    change = numeric([sum(changes, sp.Integer(0))])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        there = {**point, **{u: point[v] for u, v in other.items()}}
        return change(point), [value(there)[0] - value(point)[0]]

    return compare("adds up to H", h.free_symbols.union(other, other.values(), costates(so_far)), sides)


def _convex(so_far: Derivation, one: Minimum) -> Any:
    """Check that H_uu of one set is positive definite."""
    problem, h = stated(so_far), so_far.equation("hamiltonian.H").rhs
    assert one.hessian is not None
    minors = [(sign(problem) * one.hessian[:k, :k]).det() for k in range(1, one.hessian.rows + 1)]
    leading = numeric(minors)
    positive = never_below(worded("positive minors", problem), h.free_symbols, lambda point, rng: leading(point))
    if not positive.passed or any(sp.simplify(m).is_positive is False for m in minors):
        raise DerivationError(
            f"{so_far.name}: H_uu of {one.part.name!r} is not definite, so H has no {problem.convention} in these "
            "controls (weights have to be declared positive)"
        )
    return positive


def _cheapest(so_far: Derivation, h: sp.Expr, laws: Sequence[sp.Expr]) -> Any:
    """Check that no admissible control makes H better, set by set and all together."""
    problem, every = stated(so_far), found(so_far)
    controls = symbols_of(problem.model.controls)
    value, chosen, limits = numeric([h]), numeric(list(laws)), symbols_of(limits_of(problem))

    def margins(point: Point, rng: random.Random) -> list[Any]:
        margin = []
        for scale in SCALES:
            here = {**point, **{c: scale * point[c] for c in costates(so_far)}}
            for one in every:
                here = ordered(one, here)
            law = dict(zip(controls, chosen(here), strict=True))
            best = value({**here, **law})[0]
            for one in every:
                margin += _slacks(one, here, law)
            for _ in range(COMPETITORS):
                other = {u: v for one in every for u, v in _drawn(one, here, rng).items()}
                margin.append(sign(problem) * (value({**here, **other})[0] - best))
        return margin

    everything = {*limits, *controls, *costates(so_far)} | h.free_symbols.union(*(e.free_symbols for e in laws))
    return never_below(worded("cheapest admissible", problem), everything, margins)


def _bare(kind: PartKind) -> ControlSetKind:
    """The simple set that limits controls as this one does from outside; an angle is not limited."""
    return "free" if kind == "angle" else "ball" if kind == "annulus" else kind


def ordered(one: Minimum, point: Point) -> Point:
    """A point with bounds that leave something between them."""
    if one.part.kind == "angle":
        return {**point, one.part.bounds[0]: mp.mpf(1)}
    if one.part.kind == "annulus":
        low, high = sorted(point[b] for b in one.part.bounds)
        return {**point, one.part.bounds[0]: low, one.part.bounds[1]: high}
    return control_sets.ordered(_bare(one.part.kind), point, one.part.bounds)


def _slacks(one: Minimum, point: Point, law: dict[sp.Symbol, Any]) -> list[Any]:
    """How far the law stays within the set; rounding may bring it to the limit."""
    values = [law[u] for u in one.part.symbols]
    kind = _bare(one.part.kind)
    limits = one.part.bounds[-1:] if kind == "ball" else one.part.bounds
    return [s + mp.mpf(10) ** -20 for s in control_sets.slacks(kind, point, limits, values)]


def _drawn(one: Minimum, point: Point, rng: random.Random) -> dict[sp.Symbol, Any]:
    """A random admissible control of one set."""
    symbols, limits = one.part.symbols, one.part.bounds
    if one.part.kind == "angle":
        return {symbols[0]: mp.mpf(rng.uniform(-4, 4))}
    if one.part.kind == "annulus":
        (shown,) = control_sets.admissible("ball", {limits[1]: mp.mpf(1)}, limits[1:], len(symbols), rng, 1)
        norm = mp.sqrt(sum(v**2 for v in shown))
        size = point[limits[0]] + norm * (point[limits[1]] - point[limits[0]])
        return {u: v / norm * size for u, v in zip(symbols, shown, strict=True)}
    (shown,) = control_sets.admissible(_bare(one.part.kind), point, limits, len(symbols), rng, 1)
    return dict(zip(symbols, shown, strict=True))


def stated(so_far: Derivation) -> Problem:
    """The problem that is derived from.

    Raises
    ------
    TypeError
        If there is none.
    """
    if so_far.problem is None:
        raise TypeError(f"{so_far.name} has no cost")
    return so_far.problem
