"""Verification of generated text against the derivation, before it is written: values, derivatives, whole loops.

The text of every function, in both forms, is evaluated with as many digits as are needed to compare it with its
expression, and the text of loops with a plain RK4 that calls the generated right-hand sides: an error in the smallest
of their terms is detected, and nothing is refused for rounding. On floats, where a number may differ by rounding,
values are compared once more, and derivatives with complex steps through other generated functions.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeAlias

import mpmath as mp
import numpy as np
import sympy as sp

from satsym.agreement import DIGITS, Sides, disagreement, slopes
from satsym.agreement import LIMIT as EQUAL
from satsym.codegen.block import used
from satsym.codegen.functions import ARGUMENTS, Function, Symbols
from satsym.codegen.naming import code_of
from satsym.codegen.printers import WRITTEN
from satsym.codegen.thresholds import beside_thresholds
from satsym.kernels import Kernels, many_digits, plain
from satsym.kernels.contract import BATCH, TUPLES
from satsym.kernels.core import Function as GeneratedFunction
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.kernels.many_digits import NO_NUMBERS, exactly, loops
from satsym.spec import ProblemSpec
from satsym.symbolic.checks import drawn_from, numeric_along, random_number
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.model import variables_of

POINTS, MANY_DIGIT_POINTS = 12, 2
"""Numbers of points at which floats are compared, and at which many digits are."""
LARGEST_NUMBER = 1e150
"""Largest magnitude of numbers that are compared, so that their squares are floats."""
LIMIT = 1e-12
"""Deviation of floats, relative to one plus the size of the number, above which more digits decide."""

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
"""For each derivative: the differentiated function, or several in turn, the arguments, and a factor."""

TRIES = 400
"""Largest number of random points drawn to find those at which functions have moderate values."""
EARLIER = 40
"""Number of random points after which every second one has a tenth of the usual time."""
SHORTEST, FARTHEST = 15, 10.0
"""Largest power of ten by which steps are shortened, and the largest motion in them, in units of the states' size."""
STEPS = (0.3, 0.02, 0.03, 0.01)
"""Steps of compared loops, before they are shortened; the first leads to their start."""
LIE = "give the ranges of the variables: Variable(..., typical=(low, high)); nothing was written"

FAR_FACTOR = 1e9
"""Largest factor, up or down, on the random values of regularising numbers; on bounds, its square."""

Arguments: TypeAlias = dict[str, Any]
"""Arguments of generated functions at a place, by name."""

Exact: TypeAlias = Callable[[Mapping[sp.Symbol, Any]], list[Any]]


def verify(derivation: Derivation, kernels: Kernels) -> None:
    """Compare generated functions with the expressions they were generated from.

    Raises
    ------
    DerivationError
        Naming the first function that deviates, and by how much. Nothing must be written then.
    """
    with drawn_from(variables_of(derivation.model)), np.errstate(all="ignore"):
        _verify(derivation, kernels)


def _verify(derivation: Derivation, kernels: Kernels) -> None:
    code = code_of(derivation)
    known, found, constants = code.symbols, code.functions, code.constants
    chains = [(*constants.items(), *used(code.chain, function.outputs)) for function in found]
    exact = [numeric_along(chain, f.outputs)[0] for chain, f in zip(chains, found, strict=True)]
    rng = random.Random(derivation.name)
    places, expected = _places(derivation, kernels, found, exact, rng)
    text = many_digits.functions_of(kernels.text or "", WRITTEN)
    watched = many_digits.watched(kernels.text or "", WRITTEN)
    for k, function in enumerate(found):
        of = _Of(derivation.name, function, exact[k], known)
        for place, values in zip(places[:MANY_DIGIT_POINTS], expected, strict=False):
            _same_text(of, text, place, values[k])
        for place in limiting(kernels.spec, function, places[0]):
            if (there := _moderate_values(of, place)) is not None:
                _same_text(of, text, place, there)
        for form in (form for form in ("", BATCH) if function.name + form in watched):
            out = _shape(function) if form else None
            begin = [*places[:MANY_DIGIT_POINTS], *limiting(kernels.spec, function, places[0])]
            for place in beside_thresholds(watched[function.name + form], function.arguments, out, begin, DIGITS):
                if _allowed(kernels.spec, place) and (there := _moderate_values(of, place)) is not None:
                    _same_text(of, text, place, there, (form,))
        _same_values(of, kernels, text, places, [each[k] for each in expected])
    names = {f.name for f in found}
    for name, (argument, by, factor) in DERIVATIVES.items():
        functions = (argument,) if isinstance(argument, str) else argument
        if {name, *functions} <= names:
            _same_derivatives(derivation.name, kernels, text, (name, functions, by, factor), found, places)
    _same_loops(derivation, known, kernels, text, rng, places[-1])


@dataclass(frozen=True)
class _Of:
    """A function under verification, with the expressions it was generated from."""

    model: str
    function: Function
    exact: Exact
    known: Symbols


def _places(
    derivation: Derivation, kernels: Kernels, found: Sequence[Function], exact: Sequence[Exact], rng: random.Random
) -> tuple[list[Arguments], list[list[list[Any]]]]:
    """Draw arguments at which all functions have values, also on floats, and return the values by function."""
    known = code_of(derivation).symbols
    places, expected = [], []
    for attempt in range(TRIES):
        place = drawn(known, kernels.spec, rng)
        if attempt % 2:  # e^(At) of a fast motion has no floats at times of size one
            place["t"] *= 10.0 ** -(attempt // EARLIER)
        with mp.workdps(DIGITS), suppress(*NO_NUMBERS):
            values = [e(symbols_at(f, known, place)) for f, e in zip(found, exact, strict=True)]
            for function in found:
                getattr(kernels, function.name)(*(place[a] for a in function.arguments))
            if all(moderate(each) and not any(map(mp.im, each)) for each in values):
                places.append(place)
                expected.append(values)
        if len(places) == POINTS:
            return places, expected
    raise DerivationError(
        f"{derivation.name}: the generated functions are not finite at random points of order one; {LIE}"
    )


def symbols_at(function: Function, known: Symbols, place: Arguments) -> dict[sp.Symbol, Any]:
    """Map the symbols of a function's arguments to their values."""
    pairs = ((s, v) for a in function.arguments for s, v in zip(known.of(a), np.atleast_1d(place[a]), strict=True))
    return {s: mp.mpf(v) for s, v in pairs}


def drawn(known: Symbols, spec: ProblemSpec, rng: random.Random) -> Arguments:
    """Draw random arguments, with bounds that are active for some controls and inactive for others."""

    def draw(symbol: Any) -> float:
        return random_number(symbol, rng)

    place: Arguments = {a: tuple(map(draw, known.of(a))) for a in ARGUMENTS if a != "t"}
    bounds = [-abs(b) if i in spec.lower_bounds else abs(b) for i, b in enumerate(place["bounds"])]
    for ring in spec.rings:
        bounds[ring[0]], bounds[ring[1]] = sorted(bounds[i] for i in ring)
    place["bounds"] = tuple(bounds)
    return place | {"t": draw(known.t)}


def _allowed(spec: ProblemSpec, place: Arguments) -> bool:
    """Tell whether lower bounds are negative, positive quantities positive, and the radii of annuli in order."""
    bounds = place["bounds"]
    signs = all((b < 0) == (i in spec.lower_bounds) for i, b in enumerate(bounds))
    given = [*zip(spec.states, place["x"], strict=True), *zip(spec.parameters, place["p"], strict=True)]
    signs = signs and all(value > 0 for declared, value in given if declared.positive)
    return signs and all(bounds[least] <= bounds[largest] for least, largest in spec.rings)


def limiting(spec: ProblemSpec, function: Function, place: Arguments) -> Iterator[Arguments]:
    """Vary a place: bounds so wide that they hold no control, so narrow that they hold all, and for laws zero costates.

    What only the one or the other side of a law has would not be seen elsewhere: at bounds of size one laws may always
    be far below them, and costates never vanish. Where they do, what is made of laws may have no derivative.
    """
    if "bounds" not in function.arguments:
        return
    bounds, inner = place["bounds"], {low for low, _ in spec.rings}
    regular = range(len(bounds) - spec.regularising, len(bounds))
    for outer, least, smoothed in [(2, -2, -1), (-2, -2, -1), *([(2, 2, 1)] if inner or regular else [])]:
        powers = [least if i in inner else smoothed if i in regular else outer for i in range(len(bounds))]
        yield {**place, "bounds": tuple(b * FAR_FACTOR**power for b, power in zip(bounds, powers, strict=True))}
    if function.name == "control_law":
        yield {**place, "lam": (0.0,) * len(place["lam"])}


def _moderate_values(of: _Of, place: Arguments) -> list[Any] | None:
    """Return the values of a function's expression, if they are real, without roots of negative numbers."""
    with mp.workdps(DIGITS), suppress(*NO_NUMBERS):
        values = of.exact(symbols_at(of.function, of.known, place))
        if moderate(values) and not any(isinstance(value, mp.mpc) for value in values):
            return values
    return None


def _same_text(
    of: _Of,
    text: Mapping[str, GeneratedFunction],
    place: Arguments,
    values: Sequence[Any],
    forms: Sequence[str] = ("", BATCH),
) -> None:
    """Compare forms of a function with its expression, with as many digits as that needs."""
    for form in forms:
        try:
            error = _text_error(of, text, place, values, form)
        except (ArithmeticError, TypeError):  # on arrays such a place may be passed over
            continue
        _refuse(of.model, f"{of.function.name}{form}", error)


def _text_error(
    of: _Of, text: Mapping[str, GeneratedFunction], place: Arguments, values: Sequence[Any], form: str
) -> float:
    """Return how far the text of one form of a function is from its expression."""

    def sides(count: int) -> Sides:
        with mp.workdps(count):
            exact = values if count == DIGITS else of.exact(symbols_at(of.function, of.known, place))
            return _values(text, [of.function], place, form), [mp.re(v) for v in exact]

    return disagreement(sides)


def _values(
    text: Mapping[str, GeneratedFunction], functions: Sequence[Function], place: Arguments, form: str = BATCH
) -> list[Any]:
    """Return the values of functions, one after another, in the working precision of mpmath."""
    found: list[Any] = []
    for function in functions:
        given = [exactly(place[a]) for a in function.arguments]
        if form:
            out = np.empty(_shape(function), dtype=object)
            text[function.name + form](*given, out)
            found += out.ravel().tolist()
        else:
            value = text[function.name](*given)
            found += value if isinstance(value, tuple) else (value,)
    return found


def _shape(function: Function) -> tuple[int, ...]:
    """Return the shape of the array that the batch form of a function fills at one point."""
    shapes: dict[str, tuple[int, ...]] = {"scalar": (), "vector": (len(function.outputs),)}
    return shapes.get(function.kind, function.value.shape)


def _same_values(
    of: _Of,
    kernels: Kernels,
    text: Mapping[str, GeneratedFunction],
    places: Sequence[Arguments],
    expected: Sequence[Sequence[Any]],
) -> None:
    """Compare both forms of a function with its expression, on floats, or else their text with many digits."""
    function = of.function
    batch = getattr(kernels, f"{function.name}_batch")(*(_stacked(a, places) for a in function.arguments))
    # a function of the parameters of a model that has none is one and the same at all places
    outputs = len(function.outputs)
    single = np.size(batch) == outputs
    columns = np.broadcast_to(np.reshape(batch, (outputs, 1 if single else len(places))), (outputs, len(places)))
    for place, column, values in zip(places, columns.T, expected, strict=True):
        wanted = np.array([float(mp.re(v)) for v in values])
        scalar = np.atleast_1d(getattr(kernels, function.name)(*(place[a] for a in function.arguments)))
        for form, found in (("", scalar), (BATCH, column)):
            if not _error(found, wanted) <= LIMIT:
                _refuse(of.model, f"{function.name}{form}", _text_error(of, text, place, values, form))


def _same_derivatives(
    model: str,
    kernels: Kernels,
    text: Mapping[str, GeneratedFunction],
    relation: tuple[str, tuple[str, ...], tuple[str, ...], float],
    found: Sequence[Function],
    places: Sequence[Arguments],
) -> None:
    """Compare a derivative with complex steps through its function; where they differ, compare texts."""
    name, of, by, factor = relation
    functions = {f.name: f for f in found}
    arguments = {a: _stacked(a, places) for f in (name, *of) for a in functions[f].arguments}
    derived = getattr(kernels, f"{name}_batch")(*(arguments[a] for a in functions[name].arguments))
    columns = []
    for argument in by:
        for values in _stepped(arguments[argument]):
            moved = {**arguments, argument: values}
            stack = [getattr(kernels, f"{f}_batch")(*(moved[a] for a in functions[f].arguments)) for f in of]
            columns.append(np.imag(stack[0] if len(of) == 1 else np.concatenate(stack)) / COMPLEX_STEP)
    if not columns:  # a model without controls
        return
    expected = factor * np.stack(columns, axis=-2)
    derived = derived.reshape(expected.shape)

    def moved_by(place: Arguments, a: str, k: int, by: Any) -> list[Any]:
        return _values(text, [functions[f] for f in of], _moved(place, a, k, by))

    def sides(place: Arguments, count: int) -> Sides:
        with mp.workdps(count):
            rows = [slopes(partial(moved_by, place, a, k)) for a in by for k in range(np.size(place[a]))]
            wanted = [factor * slope for row in zip(*rows, strict=True) for slope in row]
            return _values(text, [functions[name]], place), wanted

    for k, place in enumerate(places):
        if not _error(derived[..., k], expected[..., k]) <= LIMIT:
            claim = f"{name} (as derivative of {' and '.join(of)})"
            _refuse(model, claim, disagreement(partial(sides, place)))


def _stepped(values: Any) -> Iterator[Any]:
    """Return copies of an argument with a complex step in each of its components in turn."""
    if np.ndim(values) == 1 and not isinstance(values, tuple):
        yield values + 1j * COMPLEX_STEP
        return
    for i in range(len(values)):
        moved = np.array(values, dtype=complex)
        moved[i] += 1j * COMPLEX_STEP
        yield tuple(moved) if isinstance(values, tuple) else moved


def _moved(place: Arguments, argument: str, component: int, by: Any) -> Arguments:
    """Return arguments with one component of one argument changed."""
    values = place[argument]
    if not isinstance(values, tuple):
        return {**place, argument: values + by}
    moved = tuple(value + by if k == component else value for k, value in enumerate(values))
    return {**place, argument: moved}


def _stacked(argument: str, places: Sequence[Arguments]) -> Any:
    """Stack an argument over all points, as the batch form takes it."""
    values = np.array([place[argument] for place in places]).T
    return tuple(values) if argument in TUPLES else values


def _same_loops(
    derivation: Derivation,
    known: Symbols,
    kernels: Kernels,
    text: Mapping[str, GeneratedFunction],
    rng: random.Random,
    place: Arguments,
) -> None:
    """Compare the generated loops with plain ones, with as many digits as that needs."""
    steps, m = len(STEPS) - 1, len(known.u)
    u, u_mid = (np.array([[rng.uniform(-1, 1) for _ in range(m)] for _ in range(k)]).T for k in (steps + 1, steps))
    begin = np.abs(place["x"])
    for power in range(0, SHORTEST, 2):  # longer steps may leave the domain, or what the digits tell
        times = place["t"] + 10.0**-power * np.cumsum(STEPS)
        with suppress(*NO_NUMBERS):
            exact, exact_mid, cost = plain.forward(kernels, times, place["x"], u, u_mid, place["p"])
            along = np.hstack([exact, exact_mid])
            moved = np.abs(along).max(axis=1) <= FARTHEST * (1.0 + begin)
            if moved.all() and moderate([cost]) and np.isrealobj(along):
                break
    else:
        raise DerivationError(
            f"{derivation.name}: no integration step, however short, is possible at random points; {LIE}"
        )
    for name, sides in loops(kernels.spec, text, place, (times, u, u_mid)).items():
        _refuse(derivation.name, name, disagreement(sides))


def moderate(values: Iterable[Any]) -> bool:
    """Tell whether values, and the terms they are made of, can be represented as floats."""
    return all(abs(value) <= LARGEST_NUMBER for value in values)


def _refuse(model: str, what: str, error: float) -> None:
    """Raise if numbers with many digits disagree."""
    if not error <= EQUAL:
        raise DerivationError(
            f"{model}: generated {what} deviates by {error:.1e} from the derivation; nothing was written"
        )


def _error(found: Any, expected: Any) -> float:
    a, b = np.asarray(found, float), np.asarray(expected, float)
    return float(np.max(np.abs(a - b) / (1.0 + np.abs(b)), initial=0.0))
