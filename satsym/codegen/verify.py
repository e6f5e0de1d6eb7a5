"""Generated text against the derivation, before it is written: values, derivatives, and whole loops.

Three independent routes: every function, in both forms, against its expression evaluated with 30 digits;
derivatives against complex steps through other generated functions; loops against a plain RK4 that calls the
generated right-hand sides.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from satsym.codegen.block import used
from satsym.codegen.functions import ARGUMENTS, Function, Symbols
from satsym.codegen.naming import code_of
from satsym.kernels import Kernels, plain
from satsym.kernels.contract import TUPLES
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.spec import ProblemSpec
from satsym.symbolic.checks import DIGITS, numeric_along
from satsym.symbolic.derivation import Derivation, DerivationError

POINTS = 12
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
    "boundary_jacobian": ("boundary", ("x", "lam", "nu", "t"), 1.0),
}
"""Function -> (function it is a derivative of, or several below each other; by which arguments; factor)."""

Arguments = dict[str, Any]


def verify(derivation: Derivation, kernels: Kernels) -> None:
    """Compare generated functions with what they were generated from.

    Raises
    ------
    DerivationError
        Naming the first function that deviates, and by how much. Nothing must be written then.
    """
    code = code_of(derivation)
    known, found, constants = code.symbols, code.functions, code.constants
    rng = random.Random(derivation.name)
    places = [_arguments(known, kernels.spec, rng) for _ in range(POINTS)]
    for function in found:
        chain = (*constants.items(), *used(code.chain, function.outputs))
        exact, _ = numeric_along(chain, function.outputs)
        _same_values(derivation.name, kernels, function, exact, known, places)
    names = {f.name for f in found}
    for name, (of, by, factor) in DERIVATIVES.items():
        functions = (of,) if isinstance(of, str) else of
        if {name, *functions} <= names:
            _same_derivatives(derivation.name, kernels, (name, functions, by, factor), found, places)
    _same_loops(derivation, known, kernels, rng)


def _arguments(known: Symbols, spec: ProblemSpec, rng: random.Random) -> Arguments:
    """Random arguments of size one; bounds that are met by some controls and not by others."""

    def draw(symbol: Any) -> float:
        size = rng.uniform(0.5, 1.5)
        return size if symbol.is_positive or rng.random() < 0.5 else -size

    place: Arguments = {a: tuple(map(draw, known.of(a))) for a in ARGUMENTS if a != "t"}
    place["bounds"] = tuple(-abs(b) if i in spec.lower_bounds else abs(b) for i, b in enumerate(place["bounds"]))
    return place | {"t": draw(known.t)}


def _same_values(
    name: str,
    kernels: Kernels,
    function: Function,
    exact: Callable[[Mapping[sp.Symbol, Any]], list[Any]],
    known: Symbols,
    places: Sequence[Arguments],
) -> None:
    batch = getattr(kernels, f"{function.name}_batch")(*(_stacked(a, places) for a in function.arguments))
    # a function of the parameters of a model that has none is one and the same at all places
    outputs = len(function.outputs)
    single = np.size(batch) == outputs
    columns = np.broadcast_to(np.reshape(batch, (outputs, 1 if single else len(places))), (outputs, len(places)))
    for place, column in zip(places, columns.T, strict=True):
        point = {s: v for a in function.arguments for s, v in zip(known.of(a), np.atleast_1d(place[a]), strict=True)}
        with mp.workdps(DIGITS):
            expected = [float(v) for v in exact({s: mp.mpf(float(v)) for s, v in point.items()})]
        scalar = np.atleast_1d(getattr(kernels, function.name)(*(place[a] for a in function.arguments)))
        _refuse(name, f"{function.name}", scalar, expected)
        _refuse(name, f"{function.name}_batch", column, expected)


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


def _same_loops(derivation: Derivation, known: Symbols, kernels: Kernels, rng: random.Random) -> None:
    place = _arguments(known, kernels.spec, rng)
    times = np.cumsum([0.3, 0.02, 0.03, 0.01])
    steps, m, p = len(times) - 1, len(known.u), place["p"]
    u, u_mid = (np.array([[rng.uniform(-1, 1) for _ in range(m)] for _ in range(k)]).T for k in (steps + 1, steps))
    exact, exact_mid, cost = plain.forward(kernels, times, place["x"], u, u_mid, p)
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


def _refuse(model: str, what: str, found: Any, expected: Any) -> None:
    """Raise unless the numbers agree."""
    a, b = np.asarray(found, float), np.asarray(expected, float)
    error = float(np.max(np.abs(a - b) / (1.0 + np.abs(b)), initial=0.0))
    if not error <= LIMIT:
        raise DerivationError(f"{model}: generated {what} deviates by {error:.1e} from the derivation; nothing written")
