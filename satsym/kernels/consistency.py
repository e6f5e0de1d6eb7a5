"""Whether the functions of a module contradict each other.

A digest shows that a file is as it was written; it can be recomputed. What was edited in one function no longer fits
the others: the two forms of a function must agree, loops must do what the functions of one point say, and derivatives
must be derivatives (:mod:`satsym.kernels.evaluation`).
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import prod
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.kernels import plain
from satsym.kernels.contract import CURVE, GROUPS, TUPLES, pointwise, sizes
from satsym.kernels.core import Function, Kernels
from satsym.kernels.evaluation import COPIES, Evaluation, Relation, deviations, size, with_copies
from satsym.kernels.optimality import of_the_cost
from satsym.kernels.relations import of_motion
from satsym.spec import Variable

LIMIT = 1e-9
"""Largest relative difference of two sides that must be equal; kernels with a larger one contradict each other."""

PLACES = 24
"""Number of random points at which functions are compared."""

STEPS, FRACTION = 3, 0.1
"""Number of nodes of the trajectory loops that are compared, and relative change of the states in a step."""

FAR_FACTOR = 1e9
BOUNDS_ASIDE = ((float("nan"), -0.2, 0.1, -0.5), (float("nan"), 0.2, 0.5, -0.1))
"""Lower and upper bounds relative to a control: arbitrary, then such that they enclose it, lie above it and below
it."""

SEED = 20
_FAILED = (ArithmeticError, ValueError, TypeError)
"""Errors that functions on floats raise outside their domain."""


Evaluating = TypeVar("Evaluating", bound=Evaluation)


@dataclass(frozen=True)
class Contradiction:
    """The worst disagreement of a function with others."""

    function: str
    claim: str
    """Name of the function, and the relation that it violates."""
    deviation: float
    """Relative deviation, see :data:`LIMIT`; infinite if only one of the two numbers is finite."""


def worst(kernels: Kernels, at: Mapping[str, Any], seed: int = SEED) -> Contradiction | None:
    """Return the largest contradiction between the functions of a module; ``None`` where no place is in their domain.

    Where none is, but the form on floats has numbers that the one on arrays has not, that is the contradiction. What
    floats would refuse is compared once more with many digits, if the text of the module is known.

    Parameters
    ----------
    at
        Arguments by name, as :func:`random_places` gives them.
    seed
        Seed of the displaced copies of the places, from which the sizes of functions are found.
    """
    found = _largest_of(_contradictions(kernels, at, seed, Evaluation, _loops))
    if found is None or found.deviation <= LIMIT or kernels.text is None:
        return found
    from satsym.kernels.many_digits import LongEvaluation, of_loops  # mpmath takes a tenth of a second to be imported

    every = _contradictions(kernels, at, seed, LongEvaluation, of_loops)
    still = [each for each in every if each.function == found.function and not each.deviation <= LIMIT]
    return _largest_of(still or every)


def _largest_of(found: Sequence[Contradiction]) -> Contradiction | None:
    return max(found, key=lambda each: each.deviation, default=None)


def _contradictions(
    kernels: Kernels,
    at: Mapping[str, Any],
    seed: int,
    evaluating: Callable[[Kernels, Mapping[str, Any]], Evaluating],
    loops: Callable[[Evaluating, Mapping[str, Any], tuple[Array, Array, Array]], Iterator[Relation]],
) -> list[Contradiction]:
    """Return how far the sides of each relation are apart, for one way to evaluate functions."""
    with np.errstate(all="ignore"):
        evaluation = evaluating(kernels, with_copies(at, seed))
        finite = _finite(evaluation)
        nowhere = not finite.any()
        if not finite.all() and not nowhere:
            at = {a: tuple(v[finite] for v in row) if a in TUPLES else row[..., finite] for a, row in at.items()}
            evaluation = evaluating(kernels, with_copies(at, seed))
        groups: list[tuple[list[Relation], Callable[[Array], Array]]] = []
        rowwise = [*_both_forms(evaluation)]
        if not nowhere:
            together = [*of_motion(evaluation), *(of_the_cost(evaluation) if kernels.spec.has_cost else ())]
            groups.append((together, size))
            rowwise += loops(evaluation, *_first_steps(kernels, at))
        rowwise.sort(key=_columns)
        groups += [(list(alike), _largest) for _, alike in groupby(rowwise, _columns)]
        found = [
            Contradiction(each.function, each.claim, deviation)
            for group, scale in groups
            for each, deviation in zip(group, deviations(group, scale), strict=True)
        ]
    return [] if nowhere and all(each.deviation <= LIMIT for each in found) else found


def _finite(of: Evaluation) -> NDArray[np.bool_]:
    """Tell which places, with their copies, are in the domain of all functions except laws of switching curves."""
    names = [name for name in of.signatures if name not in CURVE]
    rows = np.concatenate([of(name).reshape(-1, len(of.at["t"])) for name in names])
    return np.asarray(np.isfinite(rows).all(axis=0).reshape(1 + COPIES, -1).all(axis=0))


def random_places(kernels: Kernels, seed: int = SEED) -> dict[str, Any]:
    """Draw arguments of size one, parameters near their defaults, and bounds that are active for some controls."""
    spec, counts, rng = kernels.spec, sizes(kernels.spec), random.Random(seed)

    def drawn(count: int, positive: Mapping[int, float]) -> Array:
        rows = [
            [positive.get(i, rng.choice((-1.0, 1.0))) * rng.uniform(0.5, 1.5) for _ in range(PLACES)]
            for i in range(count)
        ]
        return np.array(rows).reshape(count, PLACES)

    signs = {"x": _positive(spec.states), "original": {}, "p": _positive(spec.parameters)}
    b = counts["b"]
    signs["bounds"] = {i: -1.0 if i in spec.lower_bounds else 1.0 for i in range(b)}
    found: dict[str, Any] = {"t": drawn(1, {})[0]}
    needed = {"x", "u", "lam"}.union(*(signature.arguments for signature in pointwise(spec).values()))
    for name, letters in GROUPS.items():
        if name not in needed:
            continue
        table = drawn(prod(counts[letter] for letter in letters), signs.get(name, {}))
        if name == "p":
            table = _about_defaults(table, spec.parameters)
        if name in ("lam", "bounds"):  # so that some bounds hold nearly every control, and some hold none
            varied = table[: b - spec.regularising] if name == "bounds" else table
            varied *= 10.0 ** np.array(rng.sample([-1.5 + 2.0 * k / PLACES for k in range(PLACES)], PLACES))
        for ring in spec.rings if name == "bounds" else ():
            table[list(ring)] = np.sort(table[list(ring)], axis=0)
        found[name] = tuple(table) if name in TUPLES else table
    if spec.has_cost and spec.control_set == "box" and not spec.switching:
        found["bounds"] = about_the_law(kernels, found)
    return found


def _about_defaults(table: Array, parameters: Sequence[Variable]) -> Array:
    """Scale parameters of size one by their defaults, since other values need not fit together.

    Masses that are no masses make a nearly singular matrix of inertia, whose elimination loses all digits.
    """
    each = zip(table, parameters, strict=True)
    return np.array([np.abs(row) * p.default if p.default else row for row, p in each]).reshape(table.shape)


def about_the_law(kernels: Kernels, at: Mapping[str, Any]) -> tuple[Array, ...]:
    """Return bounds of a box of which most are near the unbounded control: around it, above it or below."""
    m = len(kernels.spec.controls)
    with np.errstate(all="ignore"):
        unlimited = ControlSet("box", (-FAR_FACTOR,) * m, (FAR_FACTOR,) * m).arguments
        law = kernels.control_law_batch(at["t"], at["x"], at["lam"], at["p"], unlimited)
    kinds = np.arange(law.shape[-1])[None, :] + np.arange(m)[:, None]  # no two controls alike
    found = []
    drawn = ControlSet.from_arguments(kernels.spec, at["bounds"])
    for shifts, bounds in zip(BOUNDS_ASIDE, (drawn.lower, drawn.upper), strict=True):
        near = law + np.array(shifts)[kinds % len(shifts)] * np.abs(law)
        found += list(np.where(np.isfinite(near), near, np.array(bounds)))
    return tuple(found)


def _positive(variables: tuple[Variable, ...]) -> dict[int, float]:
    return {i: 1.0 for i, variable in enumerate(variables) if variable.positive}


def _both_forms(of: Evaluation) -> Iterator[Relation]:
    """Relate the form on floats to that on arrays, of every function, also at zero costates."""
    columns = _columns_of(of.at, len(of.at["t"]) // (1 + COPIES))
    columns.append({**columns[0], "lam": (0.0,) * len(of.at["lam"])})
    for name, signature in of.signatures.items():
        everywhere = of(name)[..., : len(columns) - 1]
        rows = np.concatenate([everywhere, of.without_costates(name)], axis=-1).reshape(-1, len(columns))
        single, known = _singly(of.single(name), signature.arguments, columns)
        if known:  # sizes are those at all places
            terms = 0.0 if len(known) == len(columns) else _largest(rows)
            yield Relation(name, "the same on floats and on arrays", single.T, rows[:, known], terms)


def _singly(
    function: Function, arguments: tuple[str, ...], columns: Sequence[Mapping[str, Any]]
) -> tuple[Array, list[int]]:
    """Evaluate a function on floats at each place; return the rows and the places that have a value."""
    every, given = list(range(len(columns))), [[at[a] for a in arguments] for at in columns]
    try:
        return np.array([function(*one) for one in given], dtype=float).reshape(len(given), -1), every
    except _FAILED:
        found = [_single(function, one) for one in given]
        known = [k for k in every if found[k] is not None]
        return np.array([found[k] for k in known], dtype=float), known


def _single(function: Function, given: Sequence[Any]) -> list[float] | None:
    """Evaluate a function at one place; ``None`` where a number has no value."""
    try:
        found = function(*given)
        return [*map(float, found)] if isinstance(found, tuple) else [float(found)]
    except _FAILED:
        return None


def column(at: Mapping[str, Any], k: int) -> dict[str, Any]:
    """Return the arguments at one of many places, as floats."""
    return _columns_of({name: np.asarray(values)[..., k : k + 1] for name, values in at.items()}, 1)[0]


def _columns_of(at: Mapping[str, Any], count: int) -> list[dict[str, Any]]:
    """Return the first places, each as floats."""
    tables = {name: np.asarray(values, dtype=float).reshape(-1, len(at["t"])) for name, values in at.items()}
    rows = {name: table[:, :count].T.tolist() for name, table in tables.items()}
    return [{name: own[k][0] if name == "t" else tuple(own[k]) for name, own in rows.items()} for k in range(count)]


def _first_steps(kernels: Kernels, at: Mapping[str, Any]) -> tuple[dict[str, Any], tuple[Array, Array, Array]]:
    """Return the first place, and a few times from there, with the controls of other places at and between them."""
    first, u = column(at, 0), at["u"][:, :STEPS]
    times = first["t"] + _short(kernels, first) * np.array([0.0, 1.0, 1.5])
    return first, (times, u, 0.3 * u[:, :-1] + 0.7 * u[:, 1:])


def _loops(of: Evaluation, first: Mapping[str, Any], along: tuple[Array, Array, Array]) -> Iterator[Relation]:
    """Relate trajectory loops over a few steps to plain ones."""
    kernels, (times, u, u_mid) = of.kernels, along
    p, start, end = first["p"], first["x"], first["lam"]
    x, x_mid, cost = kernels.forward(times, start, u, u_mid, p)
    try:
        exact, exact_mid, total = plain.forward(kernels, times, start, u, u_mid, p)
        claim = "RK4 of the rates"
        yield Relation("forward", claim, np.hstack([x, x_mid]), np.hstack([exact, exact_mid]))
        yield Relation("forward", "Simpson's rule for the running cost", np.array([[cost]]), np.array([[total]]))
        if kernels.spec.separable:
            again = plain.symplectic(kernels, times, start, p)
            yield Relation("symplectic", "kicks and drifts", kernels.symplectic(times, start, p), again)
        if kernels.spec.has_cost:
            lam = np.hstack(kernels.backward(times, end, x, x_mid, u, u_mid, p))
            again = np.hstack(plain.backward(kernels, times, end, x, x_mid, u, u_mid, p))
            yield Relation("backward", claim, lam, again)
    except _FAILED:
        return  # beyond the domain of the rates


def _columns(each: Relation) -> int:
    return each.left.shape[-1]


def _largest(rows: Array) -> Array:
    """Return the largest magnitude of the finite numbers in each row, shape (rows, 1)."""
    return np.asarray(np.abs(np.where(np.isfinite(rows), rows, 0.0)).max(axis=-1, initial=0.0, keepdims=True))


def _short(kernels: Kernels, at: Mapping[str, Any]) -> float:
    """Return a time in which the states change by about a tenth of themselves."""
    try:
        rates = np.abs(kernels.dynamics(at["t"], at["x"], at["u"], at["p"]))
    except _FAILED:
        return FRACTION
    x = np.abs(at["x"])
    pace = float((rates / np.where(x > 0.0, x, np.inf)).max(initial=0.0))
    return FRACTION / pace if np.isfinite(pace) and pace > 0.0 else FRACTION
