"""Generated text against the derivation, before it is written: values, derivatives, and whole loops.

Three independent routes: every function, in both forms, against its expression evaluated with 30 digits;
derivatives against complex steps through other generated functions; loops against a plain RK4 that calls the
generated right-hand sides.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any, TypeAlias

import mpmath as mp
import numpy as np
import sympy as sp

from satsym.agreement import DIGITS
from satsym.arrays import Array
from satsym.codegen.block import used
from satsym.codegen.functions import ARGUMENTS, Function, Symbols
from satsym.codegen.naming import code_of
from satsym.kernels import Kernels, plain
from satsym.kernels.contract import TUPLES
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.spec import ProblemSpec
from satsym.symbolic.checks import drawn_from, numeric_along, random_number
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.model import variables_of

POINTS = 12
HUGE = 1e12
"""Largest numbers that are compared."""
LIMIT = 1e-12
"""Allowed deviation relative to one plus the size of the number: rounding of some tens of operations."""

DERIVATIVES: dict[str, tuple[str | tuple[str, ...], tuple[str, ...], float]] = {
    "jacobian_x": ("dynamics", ("x",), 1.0),
    "jacobian_u": ("dynamics", ("u",), 1.0),
    "state_matrix": ("dynamics", ("x",), 1.0),
    "input_matrix": ("dynamics", ("u",), 1.0),
    "terminal_gradient": ("terminal_cost", ("x",), 1.0),
    "dynamics": ("hamiltonian", ("lam",), 1.0),
    "stationarity": ("hamiltonian", ("u",), 1.0),
    "costate_rate": ("hamiltonian", ("x",), -1.0),
    "control_hessian": ("stationarity", ("u",), 1.0),
    "extremal_jacobian": (("dynamics", "costate_rate"), ("x", "lam"), 1.0),
    "canonical_jacobian": ("canonical", ("x", "lam"), 1.0),
    "canonical_drift": ("canonical", ("t",), 1.0),
    "path_gradient": ("path_constraints", ("x",), 1.0),
    "path_effect": ("path_constraints", ("u",), 1.0),
    "interior_gradient": ("interior", ("x",), 1.0),
    "interior_drift": ("interior", ("t",), 1.0),
    "boundary_jacobian": ("boundary", ("x", "lam", "nu", "t"), 1.0),
}
"""Function -> (function it is a derivative of, or several below each other; by which arguments; factor)."""

TRIES = 400
"""Random places at most, of which those serve where functions have moderate numbers."""
STEPS = (0.3, 0.02, 0.03, 0.01)
"""Of the loops that are compared; the first is where they begin."""
LIE = "say where the variables lie: Variable(..., typical=(low, high)); nothing written"
ROUNDING = 1e-14
"""Share of the arguments by which rounding may seem to move them: some tens of the last place."""

Arguments = dict[str, Any]
Exact: TypeAlias = Callable[[Mapping[sp.Symbol, Any]], list[Any]]


def verify(derivation: Derivation, kernels: Kernels) -> None:
    """Compare generated functions with what they were generated from.

    Raises
    ------
    DerivationError
        Naming the first function that deviates, and by how much. Nothing must be written then.
    """
    with drawn_from(variables_of(derivation.model)):
        _verify(derivation, kernels)


def _verify(derivation: Derivation, kernels: Kernels) -> None:
    code = code_of(derivation)
    known, found, constants = code.symbols, code.functions, code.constants
    chains = [(*constants.items(), *used(code.chain, function.outputs)) for function in found]
    exact = [numeric_along(chain, f.outputs)[0] for chain, f in zip(chains, found, strict=True)]
    rng = random.Random(derivation.name)
    places, expected = _places(derivation, kernels.spec, found, exact, rng)
    for k, function in enumerate(found):
        _same_values(derivation.name, kernels, (function, exact[k]), known, places, [each[k] for each in expected])
    names = {f.name for f in found}
    for name, (of, by, factor) in DERIVATIVES.items():
        functions = (of,) if isinstance(of, str) else of
        if {name, *functions} <= names:
            _same_derivatives(derivation.name, kernels, (name, functions, by, factor), found, places)
    _same_loops(derivation, known, kernels, rng, places[-1])


def _places(
    derivation: Derivation, spec: ProblemSpec, found: Sequence[Function], exact: Sequence[Exact], rng: random.Random
) -> tuple[list[Arguments], list[list[list[Any]]]]:
    """Random arguments at which all functions have moderate numbers, and these, function by function."""
    known = code_of(derivation).symbols
    places, expected = [], []
    for _ in range(TRIES):
        place = _arguments(known, spec, rng)
        with mp.workdps(DIGITS), suppress(ArithmeticError, ValueError):
            values = [e(_point(f, known, place)) for f, e in zip(found, exact, strict=True)]
            if all(moderate(each) and not any(map(mp.im, each)) for each in values):
                places.append(place)
                expected.append(values)
        if len(places) == POINTS:
            return places, expected
    raise DerivationError(
        f"{derivation.name}: at random points of size one generated functions have no numbers to compare; {LIE}"
    )


def _point(function: Function, known: Symbols, place: Arguments, by: float = 0.0) -> dict[sp.Symbol, Any]:
    """What the symbols of a function's arguments stand for; moved by a share of themselves, up and down in turn."""
    values = {s: v for a in function.arguments for s, v in zip(known.of(a), np.atleast_1d(place[a]), strict=True)}
    return {s: mp.mpf(float(v)) * (1 + by * (-1) ** k) for k, (s, v) in enumerate(values.items())}


def _arguments(known: Symbols, spec: ProblemSpec, rng: random.Random) -> Arguments:
    """Random arguments; bounds that are met by some controls and not by others."""

    def draw(symbol: Any) -> float:
        return random_number(symbol, rng)

    place: Arguments = {a: tuple(map(draw, known.of(a))) for a in ARGUMENTS if a != "t"}
    bounds = [-abs(b) if i in spec.lower_bounds else abs(b) for i, b in enumerate(place["bounds"])]
    for ring in spec.rings:
        bounds[ring[0]], bounds[ring[1]] = sorted(bounds[i] for i in ring)
    place["bounds"] = tuple(bounds)
    return place | {"t": draw(known.t)}


def _same_values(
    name: str,
    kernels: Kernels,
    of: tuple[Function, Exact],
    known: Symbols,
    places: Sequence[Arguments],
    expected: Sequence[Sequence[Any]],
) -> None:
    function, exact = of
    batch = getattr(kernels, f"{function.name}_batch")(*(_stacked(a, places) for a in function.arguments))
    # a function of the parameters of a model that has none is one and the same at all places
    outputs = len(function.outputs)
    single = np.size(batch) == outputs
    columns = np.broadcast_to(np.reshape(batch, (outputs, 1 if single else len(places))), (outputs, len(places)))
    for place, column, values in zip(places, columns.T, expected, strict=True):
        wanted = np.array([float(mp.re(v)) for v in values])
        scalar = np.atleast_1d(getattr(kernels, function.name)(*(place[a] for a in function.arguments)))
        spread: Array | float = 0.0
        if not max(_error(scalar, wanted), _error(column, wanted)) <= LIMIT:  # rounding of arguments may do as much
            with mp.workdps(DIGITS):
                aside = exact(_point(function, known, place, ROUNDING))
                spread = np.array([float(abs(v - a)) for v, a in zip(values, aside, strict=True)])
        _refuse(name, f"{function.name}", scalar, wanted, spread)
        _refuse(name, f"{function.name}_batch", column, wanted, spread)


def _same_derivatives(
    model: str,
    kernels: Kernels,
    relation: tuple[str, tuple[str, ...], tuple[str, ...], float],
    found: Sequence[Function],
    places: Sequence[Arguments],
) -> None:
    name, of, by, factor = relation
    signature = {f.name: f.arguments for f in found}
    arguments = {a: _stacked(a, places) for f in (name, *of) for a in signature[f]}
    derived = getattr(kernels, f"{name}_batch")(*(arguments[a] for a in signature[name]))
    slopes = []
    for argument in by:
        for moved in _moved(arguments[argument]):
            stepped = {**arguments, argument: moved}
            values = [getattr(kernels, f"{f}_batch")(*(stepped[a] for a in signature[f])) for f in of]
            slopes.append(np.imag(values[0] if len(of) == 1 else np.concatenate(values)) / COMPLEX_STEP)
    if not slopes:  # a model without controls
        return
    columns = np.stack(slopes, axis=-2)
    _refuse(model, f"{name} (as derivative of {' and '.join(of)})", derived.reshape(columns.shape), factor * columns)


def _moved(values: Any) -> Iterator[Any]:
    """An argument with a complex step in each of its components in turn."""
    if np.ndim(values) == 1 and not isinstance(values, tuple):
        yield values + 1j * COMPLEX_STEP
        return
    for i in range(len(values)):
        moved = np.array(values, dtype=complex)
        moved[i] += 1j * COMPLEX_STEP
        yield tuple(moved) if isinstance(values, tuple) else moved


def _stacked(argument: str, places: Sequence[Arguments]) -> Any:
    """An argument at all places, as the batch form takes it."""
    values = np.array([place[argument] for place in places]).T
    return tuple(values) if argument in TUPLES else values


def _same_loops(derivation: Derivation, known: Symbols, kernels: Kernels, rng: random.Random, place: Arguments) -> None:
    p = place["p"]
    steps, m = len(STEPS) - 1, len(known.u)
    u, u_mid = (np.array([[rng.uniform(-1, 1) for _ in range(m)] for _ in range(k)]).T for k in (steps + 1, steps))
    for shorter in (1.0, 0.1, 0.01, 0.001):  # longer steps may leave the domain
        times = place["t"] + shorter * np.cumsum(STEPS)
        with suppress(ArithmeticError, ValueError):
            exact, exact_mid, cost = plain.forward(kernels, times, place["x"], u, u_mid, p)
            if moderate([*exact.flat, *exact_mid.flat, cost]):
                break
    else:
        raise DerivationError(f"{derivation.name}: no step of a thousandth is possible at random points; {LIE}")
    x, x_mid, total = kernels.forward(times, place["x"], u, u_mid, p)
    _refuse(derivation.name, "forward", np.hstack([x, x_mid]), np.hstack([exact, exact_mid]))
    if kernels.spec.separable:
        found = kernels.symplectic(times, place["x"], p)
        _refuse(derivation.name, "symplectic", found, plain.symplectic(kernels, times, place["x"], p))
    if derivation.problem is None:
        return
    _refuse(derivation.name, "forward (cost)", [total], [cost])
    lam = np.hstack(kernels.backward(times, place["lam"], x, x_mid, u, u_mid, p))
    exact = np.hstack(plain.backward(kernels, times, place["lam"], x, x_mid, u, u_mid, p))
    _refuse(derivation.name, "backward", lam, exact)


def moderate(values: Iterable[Any]) -> bool:
    """Whether floats have these, and what they are made of."""
    return all(abs(value) <= HUGE for value in values)


def _refuse(model: str, what: str, found: Any, expected: Any, spread: Array | float = 0.0) -> None:
    """Raise unless the numbers agree, but for what they are spread by."""
    error = _error(found, expected, spread)
    if not error <= LIMIT:
        raise DerivationError(f"{model}: generated {what} deviates by {error:.1e} from the derivation; nothing written")


def _error(found: Any, expected: Any, spread: Array | float = 0.0) -> float:
    a, b = np.asarray(found, float), np.asarray(expected, float)
    return float(np.max(np.maximum(np.abs(a - b) - spread, 0.0) / (1.0 + np.abs(b)), initial=0.0))
