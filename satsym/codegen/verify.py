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
from numpy.typing import NDArray

from satsym.codegen import symplectic
from satsym.codegen.functions import ARGUMENTS, TUPLES, Function, Symbols
from satsym.codegen.naming import code_of
from satsym.kernels import Kernels
from satsym.kernels.composition import weights
from satsym.symbolic.checks import DIGITS, numeric
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.model import symbols_of

POINTS = 12
LIMIT = 1e-12
"""Allowed deviation relative to one plus the size of the number: rounding of some tens of operations."""

COMPLEX_STEP = 1e-30

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
Array = NDArray[np.floating[Any]]


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
    places = [_arguments(known, derivation, rng) for _ in range(POINTS)]
    for function in found:
        exact = numeric([output.xreplace(constants) for output in function.outputs])
        _same_values(derivation.name, kernels, function, exact, known, places)
    names = {f.name for f in found}
    for name, (of, by, factor) in DERIVATIVES.items():
        functions = (of,) if isinstance(of, str) else of
        if {name, *functions} <= names:
            _same_derivatives(derivation.name, kernels, (name, functions, by, factor), found, places)
    _same_loops(derivation, known, kernels, rng)


def _arguments(known: Symbols, derivation: Derivation, rng: random.Random) -> Arguments:
    """Random arguments of size one; bounds that are met by some controls and not by others."""

    def draw(symbol: Any) -> float:
        size = rng.uniform(0.5, 1.5)
        return size if symbol.is_positive or rng.random() < 0.5 else -size

    place: Arguments = {a: tuple(map(draw, known.of(a))) for a in ARGUMENTS if a != "t"}
    if derivation.problem and derivation.problem.control_set == "box":
        m = len(known.u)
        lower, upper, companion = (place["bounds"][i:k] for i, k in ((0, m), (m, 2 * m), (2 * m, None)))
        place["bounds"] = (*(-abs(b) for b in lower), *map(abs, (*upper, *companion)))
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
    place = _arguments(known, derivation, rng)
    times = np.cumsum([0.3, 0.02, 0.03, 0.01])
    steps, m = len(times) - 1, len(known.u)
    u, u_mid = (np.array([[rng.uniform(-1, 1) for _ in range(m)] for _ in range(k)]).T for k in (steps + 1, steps))
    p, costs = place["p"], derivation.problem is not None

    def rates(t: float, y: Array, u_now: Array) -> Array:
        state = tuple(y[: len(known.x)])
        running = [kernels.running_cost(t, state, tuple(u_now), p)] if costs else []
        return np.array([*kernels.dynamics(t, state, tuple(u_now), p), *running])

    start = np.array([*place["x"], *([0.0] if costs else [])])
    y, y_mid = _plain_rk4(rates, times, start, u, u_mid)
    x, x_mid, total = kernels.forward(times, place["x"], u, u_mid, p)
    n = len(known.x)
    _refuse(derivation.name, "forward", np.hstack([x, x_mid]), np.hstack([y[:n], y_mid[:n]]))
    if kernels.spec.separable:
        found = kernels.symplectic(times, place["x"], p)
        _refuse(derivation.name, "symplectic", found, _kicked(derivation, kernels, times, place))
    if not costs:
        return
    _refuse(derivation.name, "forward (cost)", [total], [y[n, -1]])

    def costate_rates(t: float, lam: Array, given: Array) -> Array:
        return np.array(kernels.costate_rate(t, tuple(given[:n]), tuple(given[n:]), tuple(lam), p))

    given, given_mid = np.vstack([x, u])[:, ::-1], np.vstack([x_mid, u_mid])[:, ::-1]
    lam, lam_mid = _plain_rk4(costate_rates, times[::-1], np.array(place["lam"]), given, given_mid)
    found = np.hstack(kernels.backward(times, place["lam"], x, x_mid, u, u_mid, p))
    _refuse(derivation.name, "backward", found, np.hstack([lam[:, ::-1], lam_mid[:, ::-1]]))


def _plain_rk4(
    rates: Callable[[float, Array, Array], Array], times: Array, start: Array, given: Array, given_mid: Array
) -> tuple[Array, Array]:
    """RK4 and Hermite midpoints, written as in a textbook; times may run backward."""
    y, middles = [start], []
    for i, h in enumerate(np.diff(times)):
        t, here = times[i], y[-1]
        k1 = rates(t, here, given[:, i])
        k2 = rates(t + h / 2, here + h / 2 * k1, given_mid[:, i])
        k3 = rates(t + h / 2, here + h / 2 * k2, given_mid[:, i])
        k4 = rates(t + h, here + h * k3, given[:, i + 1])
        there = here + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        middles.append((here + there) / 2 + h / 8 * (k1 - rates(t + h, there, given[:, i + 1])))
        y.append(there)
    return np.array(y).T, np.array(middles).T


def _kicked(derivation: Derivation, kernels: Kernels, times: Array, place: Arguments) -> Array:
    """Kicks of the velocities and drifts of the coordinates in turn, by the rates without control."""
    parts, states = symplectic.split(derivation), symbols_of(derivation.model.states)
    assert parts is not None
    moved, kicked = (np.isin(states, group) for group in (parts.coordinates, parts.velocities))
    kicks, drifts = weights()
    coast = (0.0,) * len(kernels.spec.controls)
    y = [np.array(place["x"])]
    for i, h in enumerate(np.diff(times)):
        now = y[-1]
        for kick, drift in zip(kicks, [*drifts, 0.0], strict=True):
            now = now + kick * h * kicked * kernels.dynamics(times[i], now, coast, place["p"])
            now = now + drift * h * moved * kernels.dynamics(times[i], now, coast, place["p"])
        y.append(now)
    return np.array(y).T


def _refuse(model: str, what: str, found: Any, expected: Any) -> None:
    """Raise unless the numbers agree."""
    a, b = np.asarray(found, float), np.asarray(expected, float)
    error = float(np.max(np.abs(a - b) / (1.0 + np.abs(b)), initial=0.0))
    if not error <= LIMIT:
        raise DerivationError(f"{model}: generated {what} deviates by {error:.1e} from the derivation; nothing written")
