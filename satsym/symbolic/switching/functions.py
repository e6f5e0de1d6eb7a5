"""Hamiltonians linear in the controls and their magnitudes: switching functions, the law, and their rates.

H = H_0 + sum of sigma_i u_i + sum of w_i |u_i| is least on a box where each control is at a bound, or at rest where its
magnitude costs more than it gains. The sign of sigma_i - or its size beside w_i - decides which, and its rate is the
Poisson bracket with H. Where sigma_i stays at the threshold the law is undetermined: see
:mod:`satsym.symbolic.switching.singular`.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.agreement import slopes
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import tidy, vanishes
from satsym.symbolic.checks import Point, compare, never_below, numeric
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Derivation, DerivationError, Equation, Step
from satsym.symbolic.functions.minimisers import Clip, Shrink, SignedClip, SignedSwitch, Switch, compared
from satsym.symbolic.model import Problem, symbols_of, t
from satsym.symbolic.principle import control_sets
from satsym.symbolic.principle.parts import weighed
from satsym.symbolic.principle.pontryagin import COMPETITORS, costates
from satsym.symbolic.switching import notation as s

SCALES = (0.1, 1.0, 10.0)
"""Factors of the costates at each random point, so that switching functions lie on both sides of their thresholds."""


@dataclass(frozen=True)
class Parts:
    """The parts of H: ``drift + sum(switching * u) + sign * sum(weights * |u|)``."""

    drift: sp.Expr
    switching: tuple[sp.Expr, ...]
    weights: tuple[sp.Expr, ...]


def applies(so_far: Derivation) -> bool:
    """Tell whether cost and motion are affine in the controls and their magnitudes.

    Raises
    ------
    DerivationError
        If they are, but the control set is one on which this machinery has no law, or the magnitude of a control
        enters in a way that it has none for.
    """
    problem = so_far.problem
    if problem is None:
        return False
    controls = symbols_of(problem.model.controls)
    f = list(so_far.rhs("first_order"))
    if not s.is_affine([problem.running_cost, *f], controls):
        return False
    _refuse(so_far.name, problem, controls, f)
    return True


def refuse_magnitudes(so_far: Derivation) -> None:
    """Refuse the magnitude of a single control in the motion where H is not affine in all controls and magnitudes.

    Raises
    ------
    DerivationError
        Where there is one.
    """
    magnitudes, rates = s.magnitudes(symbols_of(so_far.model.controls)), so_far.rhs("first_order")
    stated = (a for a in magnitudes if isinstance(a, sp.Abs))  # that of a positive control is the control itself
    if magnitude := next((a for a in stated if any(rate.has(a) for rate in rates)), None):
        raise DerivationError(
            f'{so_far.name}: {magnitude} in the equations of motion is supported only with control_set = "box", and '
            "only if the cost and the motion are linear in the controls and their magnitudes; use two controls, "
            "one for each sign, both with the lower bound 0; replace the control by their difference and its "
            "magnitude by their sum"
        )


def parts(so_far: Derivation) -> Parts:
    """Return the parts of H as the step ``switching_function`` states them."""
    assert so_far.problem is not None
    controls = symbols_of(so_far.model.controls)
    stated = {e.name: e.rhs for e in so_far.step("switching_function").equations}
    return Parts(
        stated["H_0"],
        tuple(stated[u.name] for u in controls),
        tuple(stated.get(f"weight_{u.name}", sp.Integer(0)) for u in controls),
    )


def switching_function(so_far: Derivation) -> Step:
    """Derive H_0, the factor of each control in H, and the weight of each magnitude."""
    problem, controls = _problem(so_far), symbols_of(so_far.model.controls)
    h = so_far.equation("hamiltonian.H").rhs
    stands_for = s.magnitudes(controls)
    plain = h.xreplace(stands_for)
    none = dict.fromkeys([*controls, *stands_for.values()], sp.Integer(0))
    drift = tidy(plain.xreplace(none), costates(so_far))
    sigma = [tidy(sp.diff(plain, u).xreplace(none), costates(so_far)) for u in controls]
    weights = [tidy(sign(problem) * sp.diff(plain, v).xreplace(none), costates(so_far)) for v in stands_for.values()]
    equations = [
        Equation("H_0", s.UNSWITCHED, drift),
        *(Equation(u.name, s.switching_of(u), slope) for u, slope in zip(controls, sigma, strict=True)),
        *(Equation(f"weight_{u.name}", s.weight_of(u), w) for u, w in zip(controls, weights, strict=True) if w != 0),
    ]
    value, taken_apart = numeric([h]), numeric([drift, *sigma, *weights])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        rest, *factors = taken_apart(point)
        u = [point[c] for c in controls]
        terms = [f * v for f, v in zip(factors, [*u, *(sign(problem) * abs(v) for v in u)], strict=True)]
        return [rest + sum(terms)], value(point)

    check = compare("adds up to H", h.free_symbols | {*controls, *costates(so_far)}, sides)
    weighed = any(w != 0 for w in weights)
    rule = worded("collect controls with magnitudes", problem) if weighed else "collect controls"
    return Step("switching_function", rule, tuple(equations), ("hamiltonian",), (check,))


def control_law(so_far: Derivation) -> Step:
    """Derive the control that minimises H over the box: at a bound, or of least magnitude."""
    problem, found = _problem(so_far), parts(so_far)
    controls, lower, upper = _box(so_far)
    weights = _weight_symbols(found, controls)
    signed = moving_magnitudes(so_far)
    equations = tuple(
        Equation(
            u.name, n.optimal(u), (SignedSwitch if u in signed else Switch)(sign(problem) * s.switching_of(u), w, *ends)
        )
        for u, w, *ends in zip(controls, weights, lower, upper, strict=True)
    )
    check = _cheapest(so_far, "no vertex cheaper", so_far.equation("hamiltonian.H").rhs, [e.rhs for e in equations])
    rule = "levels compared" if signed else "three levels" if any(w != 0 for w in weights) else "two levels"
    return Step("control_law", worded(rule, problem), equations, ("switching_function",), (check,))


def smoothed_law(so_far: Derivation) -> Step:
    """Derive the continuous law of the regularised problem, which weighs u^2 a little and only a fraction of |u|."""
    problem, found = _problem(so_far), parts(so_far)
    controls, lower, upper = _box(so_far)
    weights = _weight_symbols(found, controls)
    effort = weighed(s.SMOOTHING, controls, so_far.model.controls)
    saved = sum(
        ((1 - s.MAGNITUDE_FACTOR) * w * sp.Abs(u) for u, w in zip(controls, weights, strict=True)), sp.Integer(0)
    )
    companion = Equation("H", s.SMOOTHED, n.HAMILTONIAN + sign(problem) * effort - sign(problem) * saved)
    better, signed = sign(problem), moving_magnitudes(so_far)

    def law(u: sp.Symbol, w: sp.Expr, *ends: sp.Symbol) -> sp.Expr:
        sigma, weight = s.switching_of(u), s.MAGNITUDE_FACTOR * w
        if u in signed:
            return SignedClip(better * sigma, weight, s.SMOOTHING, *ends)
        return Clip(-better * Shrink(sigma, weight) / s.SMOOTHING, *ends)

    laws = tuple(
        Equation(u.name, s.smoothed(u), law(u, w, low, high))
        for u, w, low, high in zip(controls, weights, lower, upper, strict=True)
    )
    h = companion.rhs.xreplace({n.HAMILTONIAN: so_far.equation("hamiltonian.H").rhs})
    (h,) = written_out(so_far, [h])
    check = _cheapest(so_far, "cheapest admissible", h, [e.rhs for e in laws])
    sources = ("switching_function", "control_law")
    shrunk = any(law.rhs.has(Shrink) for law in laws)
    less = "weigh the effort and less of the magnitude" if shrunk else "weigh the effort and less of magnitudes moving"
    rule = less if saved != 0 else "weigh the effort"
    return Step("smoothed_law", rule, (companion, *laws), sources, (check,))


def switching_rate(so_far: Derivation) -> Step:
    """Derive the rates of the switching functions along an extremal by Poisson brackets."""
    problem, found = _problem(so_far), parts(so_far)
    controls, lam = symbols_of(so_far.model.controls), costates(so_far)
    equations: list[Equation] = []
    rates = []
    for u, sigma in zip(controls, found.switching, strict=True):
        named = {s.drift_bracket(u): (poisson(so_far, found.drift, sigma), sp.Integer(1))}
        for by, other, w in zip(controls, found.switching, found.weights, strict=True):
            named[s.bracket(by, u)] = (poisson(so_far, other, sigma), by)
            named[s.weight_bracket(by, u)] = (poisson(so_far, w, sigma), sign(problem) * sp.Abs(by))
        equations += [Equation(k.name, k, b) for k, (b, _) in named.items() if b != 0 or k == s.drift_bracket(u)]
        total = sp.diff(sigma, t) + sum((b * factor for b, factor in named.values()), sp.Integer(0))
        rates.append(Equation(u.name, n.rate_of(s.switching_of(u)), tidy(total, (*controls, *lam))))
    check = along_extremals(so_far, "numeric derivative along extremals", found.switching, [e.rhs for e in rates])
    sources = ("switching_function", "state_equations", "costate_equations")
    return Step("switching_rate", "Poisson brackets", (*equations, *rates), sources, (check,))


def poisson(so_far: Derivation, by: sp.Expr, of: sp.Expr) -> sp.Expr:
    """Return the Poisson bracket by_lambda of_x - by_x of_lambda: the rate of ``of`` where H is ``by``."""
    states, lam = symbols_of(so_far.model.states), costates(so_far)
    terms = (
        sp.diff(by, costate) * sp.diff(of, x) - sp.diff(by, x) * sp.diff(of, costate)
        for x, costate in zip(states, lam, strict=True)
    )
    return tidy(sum(terms, sp.Integer(0)), lam)


def flow(so_far: Derivation) -> dict[sp.Symbol, sp.Expr]:
    """Map states and costates to their rates of change under constant controls."""
    z = (*symbols_of(so_far.model.states), *costates(so_far))
    return dict(zip(z, (*so_far.rhs("first_order"), *so_far.rhs("costate_equations")), strict=True))


def along_extremals(
    so_far: Derivation,
    claim: str,
    functions: Sequence[sp.Expr],
    derived: Sequence[sp.Expr],
    replaced: Mapping[sp.Expr, sp.Expr] | None = None,
) -> Any:
    """Compare derived total time derivatives of functions with differences along canonical equations."""
    rates = {z: rate.xreplace(dict(replaced or {})) for z, rate in flow(so_far).items()}
    values, rate, motion = numeric(list(functions)), numeric(list(derived)), numeric(list(rates.values()))
    everything = {t, *rates, *symbols_of(so_far.model.controls)}
    everything |= set().union(*(sp.sympify(e).free_symbols for e in (*functions, *derived, *rates.values())))
    return compare(claim, everything, lambda point: (rate(point), directional(values, motion, list(rates), point)))


def directional(values: Any, motion: Any, moving: Sequence[sp.Symbol], point: Point) -> list[Any]:
    """Return central differences of functions along a motion, time included."""
    with mp.workdps(3 * mp.mp.dps):
        speed = motion(point)
    along = [(t, 1), *zip(moving, speed, strict=True)]
    return slopes(lambda h: values({**point, **{z: point[z] + h * v for z, v in along}}))


def written_out(so_far: Derivation, expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """Replace symbols of switching functions and weights by their values, and minimisers by comparisons."""
    found, controls = parts(so_far), symbols_of(so_far.model.controls)
    values = dict(zip(map(s.switching_of, controls), found.switching, strict=True))
    values |= dict(zip(map(s.weight_of, controls), found.weights, strict=True))
    return [compared(e).xreplace(values) for e in expressions]


def _cheapest(so_far: Derivation, claim: str, h: sp.Expr, laws: Sequence[sp.Expr]) -> Any:
    """Check that no admissible control has a lower H: corners, controls at rest, and random ones."""
    problem = _problem(so_far)
    controls, lower, upper = _box(so_far)
    limits, better = (*lower, *upper), sign(problem)
    value, chosen = numeric([h]), numeric(written_out(so_far, laws))

    def margins(point: Point, rng: random.Random) -> list[Any]:
        found = []
        for scale in SCALES:
            scaled = {c: scale * point[c] for c in costates(so_far)}
            fraction = {s.MAGNITUDE_FACTOR: abs(point[s.MAGNITUDE_FACTOR]) % 1} if s.MAGNITUDE_FACTOR in point else {}
            here = control_sets.ordered("box", {**point, **scaled, **fraction}, limits)
            law = chosen(here)
            best = value({**here, **dict(zip(controls, law, strict=True))})[0]
            found += control_sets.slacks("box", here, limits, law)
            for other in _competitors(here, lower, upper, rng):
                found.append(better * (value({**here, **dict(zip(controls, other, strict=True))})[0] - best))
        return found

    everything = {*limits, *controls, *costates(so_far)}
    everything |= set().union(*(e.free_symbols for e in (h, *written_out(so_far, laws))))
    return never_below(worded(claim, problem), everything, margins)


def _competitors(
    point: Point, lower: Sequence[sp.Symbol], upper: Sequence[sp.Symbol], rng: random.Random
) -> list[Sequence[Any]]:
    """Return all corners of the box, its points with controls at rest, and random points of it."""
    levels = [
        (point[low], point[high], max(point[low], min(mp.mpf(0), point[high])))
        for low, high in zip(lower, upper, strict=True)
    ]
    corners = list(itertools.islice(itertools.product(*levels), 3**4))
    return [*corners, *control_sets.admissible("box", point, (*lower, *upper), len(lower), rng, COMPETITORS)]


def _box(so_far: Derivation) -> tuple[tuple[sp.Symbol, ...], tuple[sp.Symbol, ...], tuple[sp.Symbol, ...]]:
    """Return controls, lower bounds and upper bounds."""
    controls = symbols_of(so_far.model.controls)
    limits = symbols_of(control_sets.bounds("box", so_far.model.controls))
    return controls, limits[: len(controls)], limits[len(controls) :]


def moving_magnitudes(so_far: Derivation) -> list[sp.Symbol]:
    """Return controls whose magnitudes occur in the motion, so that costates determine their worth."""
    controls, lam = symbols_of(so_far.model.controls), set(costates(so_far))
    return [u for u, w in zip(controls, parts(so_far).weights, strict=True) if w.free_symbols & lam]


def _weight_symbols(found: Parts, controls: Sequence[sp.Symbol]) -> list[sp.Expr]:
    """Map the names of weights to symbols, zero where a magnitude has no weight."""
    return [s.weight_of(u) if w != 0 else sp.Integer(0) for u, w in zip(controls, found.weights, strict=True)]


def _problem(so_far: Derivation) -> Problem:
    if so_far.problem is None:
        raise TypeError(f"{so_far.name} has no cost")
    return so_far.problem


def _refuse(name: str, problem: Problem, controls: Sequence[sp.Symbol], f: Sequence[sp.Expr]) -> None:
    """Refuse problems for which no law is derived here."""
    if problem.control_set != "box":
        raise DerivationError(
            f"{name}: H is linear in the controls, so its minimum lies at their bounds; this requires "
            f'control_set = "box", not "{problem.control_set}"'
        )
    stands_for = s.magnitudes(controls)
    cost = sp.sympify(problem.running_cost).xreplace(stands_for)
    for u, v in zip(controls, stands_for.values(), strict=True):
        weight = tidy(sp.diff(cost, v))
        if not weight.is_nonnegative:
            raise DerivationError(
                f"{name}: the weight of |{u.name}| in the cost, {weight}, might be negative, but negative "
                "weights are not supported; declare the factors of the weight to be positive"
            )
        if weight == 0 and all(vanishes(sp.diff(e, u)) for e in (cost, *f)):
            raise DerivationError(f"{name}: {u.name} enters neither the motion nor the cost; leave it out")
