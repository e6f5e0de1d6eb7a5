"""Relations between the functions of a problem with a cost, and of its path constraints.

Where controls switch, the Hamiltonian of the regularised problem is H + smoothing/2 u^2 with a factor of the weights of
|u|.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.kernels.evaluation import SMALLEST_FRACTION, Evaluation, Relation, along, derivative, size
from satsym.kernels.relations import effort, of_sets, outside_ball, outside_box, relaxed, slope_terms


def of_the_cost(of: Evaluation) -> Iterator[Relation]:
    """Yield relations of the Hamiltonian, the law, the canonical equations and the boundary residuals."""
    yield from _of_hamiltonian(of)
    if of.kernels.spec.switching:
        yield from of_switching(of)
        control, surplus = regularised_law(of)
    else:
        yield from _of_regular_law(of)
        control, surplus = of("control_law"), np.zeros((2 * len(of.at["x"]), 1))
    yield from _of_canonical(of, control, surplus)
    yield from _of_ends(of, control)
    if of.kernels.spec.path_constraints:
        yield from of_path_constraints(of)
    if of.kernels.spec.interior:
        yield from derivative(of, "interior_gradient", "interior", ("x",))
        yield from derivative(of, "interior_drift", "interior", ("t",))


def _of_hamiltonian(of: Evaluation) -> Iterator[Relation]:
    f, lam = of("dynamics"), of.at["lam"]
    work = lam * f
    cost, terms = of("hamiltonian") - work.sum(axis=0), np.abs(work).sum(axis=0)
    yield Relation("running_cost", "H - lambda' f", of("running_cost"), cost, SMALLEST_FRACTION * terms)
    yield from derivative(of, "dynamics", "hamiltonian", ("lam",))
    yield from derivative(of, "costate_rate", "hamiltonian", ("x",), -1.0)
    yield from derivative(of, "terminal_gradient", "terminal_cost", ("x",))
    if not of.kernels.spec.has_terminal_cost:
        yield Relation("terminal_cost", "none", of("terminal_cost"), np.zeros_like(of.at["t"]))


def _of_regular_law(of: Evaluation) -> Iterator[Relation]:
    yield from derivative(of, "stationarity", "hamiltonian", ("u",))
    yield from derivative(of, "control_hessian", "stationarity", ("u",))
    if of.kernels.spec.control_parts:
        yield from of_sets(of)
        return
    law = of("control_law")
    slope, terms = slope_terms(of, law)
    limits = ControlSet.from_arguments(of.kernels.spec, [np.asarray(b) for b in of.at["bounds"]])
    if limits.kind == "box":
        low, high = (np.array(np.broadcast_arrays(*half, law[0])[:-1]) for half in (limits.lower, limits.upper))
        curved = np.asarray(np.einsum("iik->ik", of("control_hessian", u=law)) > 0.0)
        left = outside_box(slope, law, low, high, curved)
        size_of_law = size(law)
        yield Relation("control_law", "within its box", law, np.minimum(np.maximum(law, low), high), size_of_law)
    elif limits.kind == "ball":
        norm = np.sqrt((law * law).sum(axis=0))
        left = outside_ball(slope, law, norm, np.asarray(limits.radius))
        yield Relation("control_law", "within its ball", norm, np.minimum(norm, np.asarray(limits.radius)))
    else:
        left = slope
    yield Relation("control_law", "H is minimal there", left, np.zeros_like(left), terms)


def _of_canonical(of: Evaluation, control: Array, surplus: Array) -> Iterator[Relation]:
    """Yield relations of the rates of states and costates under the law, and of their derivatives."""
    rates = (_under_law(of, name, control) for name in ("dynamics", "costate_rate"))
    expected = np.concatenate([*rates]) + surplus
    terms = sum(np.abs(of.slope("canonical", name) * of.at[name]).sum(axis=-2) for name in ("x", "lam"))
    yield Relation(
        "canonical", "rates of states and costates under the law", of("canonical"), expected, SMALLEST_FRACTION * terms
    )
    yield from derivative(of, "canonical_jacobian", "canonical", ("x", "lam"))
    yield from derivative(of, "canonical_drift", "canonical", ("t",))


def _under_law(of: Evaluation, name: str, control: Array) -> Array:
    """Evaluate a function of the controls under the law of the problem, or of the regularised problem."""
    return relaxed(of, name) if of.kernels.spec.directional else of(name, u=control)


def _of_ends(of: Evaluation, control: Array) -> Iterator[Relation]:
    """Yield relations of the boundary residuals with cost, reference and constraints."""
    x, lam, n = of.at["x"], of.at["lam"], len(of.at["x"])
    given, on_reference, target = (_rows(of.at["final"][k * n : (k + 1) * n], x) for k in range(3))
    found = of("boundary")
    constraints = slice(n, len(found) - 1)
    weights = _rows(of.at["nu"], x)
    by_state, by_time = (of.slope("boundary", a)[constraints] for a in ("x", "t"))
    curve, pace = np.zeros_like(x), np.zeros_like(x)
    if of.has("reference"):
        curve, pace = of("reference"), of.slope("reference", "t")[..., 0, :]
    slope = of.slope("terminal_cost", "x") + np.einsum("ck,cnk->nk", weights, by_state)
    ends = given * (x - target) + on_reference * (x - curve) + (1.0 - given - on_reference) * (lam - slope)
    terms = np.abs(given * x) + np.abs(on_reference * x) + np.abs(lam) + np.abs(slope)
    yield Relation("boundary", "the end, or transversality, of each state", found[:n], ends, SMALLEST_FRACTION * terms)
    h = _under_law(of, "hamiltonian", control) + _smoothing(of, control)
    parts = [h, of.slope("terminal_cost", "t")[0], *(weights * by_time[:, 0]), *((slope - lam) * on_reference * pace)]
    size_of_parts = np.sum(np.abs(parts), axis=0)
    yield Relation(
        "boundary",
        "transversality of the final time",
        found[-1],
        np.sum(parts, axis=0),
        size_of_parts * SMALLEST_FRACTION,
    )
    yield from derivative(of, "boundary_jacobian", "boundary", ("x", "lam", "nu", "t"))


def _smoothing(of: Evaluation, control: Array) -> Array | float:
    """Return the additional terms of the regularised problem's Hamiltonian, where there are any."""
    if of.kernels.spec.directional:
        return effort(of)
    if not of.kernels.spec.switching:
        return 0.0
    return extra_cost(of, control)


def _rows(values: Any, like: Array) -> Array:
    """Return a tuple of numbers or arrays as a table with equally many columns."""
    return np.array([np.broadcast_to(value, like.shape[-1:]) for value in values]).reshape(len(values), like.shape[-1])


def of_switching(of: Evaluation) -> Iterator[Relation]:
    """Yield relations of switching functions and weights, their rates, and the exact law."""
    u = of.at["u"]
    sigma, weight = of("switching_function"), _weights(of)
    alone = u[:, None, :] * np.eye(len(u))[:, :, None]
    idle = of("hamiltonian", u=np.zeros_like(u))
    gained = np.array([of("hamiltonian", u=each) - idle for each in alone.swapaxes(0, 1)])
    terms = SMALLEST_FRACTION * np.abs(idle)
    yield Relation(
        "switching_function", "contribution of each control to H", sigma * u + weight * np.abs(u), gained, terms
    )
    together, claim = of("hamiltonian") - idle, "sum of the contributions of the controls"
    yield Relation("hamiltonian", claim, together, gained.sum(axis=0), terms)
    rates = {"x": of("dynamics"), "lam": of("costate_rate")}
    parts = [of.slope("switching_function", a) * rate for a, rate in rates.items()]
    by_time = of.slope("switching_function", "t")[:, 0]
    total = by_time + sum(part.sum(axis=-2) for part in parts)
    terms = np.abs(by_time) + sum(np.abs(part).sum(axis=-2) for part in parts)
    yield Relation("switching_rate", "rate of change along an extremal", of("switching_rate"), total, terms)
    yield Relation("control_law", "H is minimal there", of("control_law"), _law(of, sigma, weight))
    none = np.zeros_like(of.at["lam"])
    indifferent = of("switching_function", lam=none), _weights(of, lam=none)
    yield Relation("control_law", "of minimum magnitude", of("control_law", lam=none), _law(of, *indifferent))
    for row, name in enumerate(("dynamics", "costate_rate")):
        n = len(of.at["x"])
        block = of("extremal_jacobian")[row * n : (row + 1) * n]
        slopes = np.concatenate([_slope(of, name, a) for a in ("x", "lam")], axis=-2)
        faint = np.concatenate([of.faint(name, a) for a in ("x", "lam")], axis=-2)
        yield Relation("extremal_jacobian", f"derivative of {name}", block, slopes, faint)


def _slope(of: Evaluation, name: str, by: str) -> Array:
    """Return a derivative of a function, zero where the function does not have the argument."""
    if by in of.signatures[name].arguments:
        return of.slope(name, by)
    value = of(name)
    return np.zeros((len(value), *of.at[by].shape))


def _limits(of: Evaluation) -> tuple[Array, Array, Array, Array]:
    """Return lower and upper bounds as tables, with smoothing and the factor of weights."""
    u = of.at["u"]
    bounds = [np.broadcast_to(value, u.shape[-1:]) for value in of.at["bounds"]]
    limits = ControlSet.from_arguments(of.kernels.spec, bounds)
    return np.array(limits.lower), np.array(limits.upper), np.asarray(limits.smoothing), np.asarray(limits.fraction)


def _law(of: Evaluation, sigma: Array, weight: Array) -> Array:
    """Return the minimiser of sigma u + weight |u| in the box.

    Where all of an interval minimises, it is the value of least magnitude, or the middle.
    """
    low, high, *_ = _limits(of)
    least = np.minimum(np.maximum(0.0, low), high)
    rest = np.where((weight > 0.0) | _moving(of)[:, None], least, 0.5 * (low + high))
    rise = sigma * (high - low) + np.minimum(weight, 0.0) * (np.abs(high) - np.abs(low))
    bent = np.where(rise > 0.0, low, np.where(rise < 0.0, high, rest))
    return np.asarray(
        np.where(weight < 0.0, bent, np.where(sigma > weight, low, np.where(sigma < -weight, high, rest)))
    )


def regularised_law(of: Evaluation) -> tuple[Array, Array]:
    """Return the controls of the regularised problem, and the additional rates of states and costates."""
    low, high, smoothing, fraction = _limits(of)
    sigma, width = of("switching_function"), fraction * _weights(of)
    rest = np.minimum(np.maximum(0.0, low), high)
    sides = ((-(sigma + width) / smoothing, rest, high), (-(sigma - width) / smoothing, low, rest))
    above, below = (np.minimum(np.maximum(value, least), most) for value, least, most in sides)
    values = (0.5 * smoothing * u * u + sigma * u + width * np.abs(u) for u in (above, below))
    control = np.where(next(values) <= next(values), above, below)
    moved = (np.einsum("mnk,mk->nk", _slope(of, "magnitude_weight", by), np.abs(control)) for by in ("lam", "x"))
    return control, (1.0 - fraction) * np.concatenate([-next(moved), next(moved)])


def _moving(of: Evaluation) -> NDArray[np.bool_]:
    """Tell whether the magnitude of each control occurs in the motion, shape (m,)."""
    return np.asarray(_slope(of, "magnitude_weight", "lam").any(axis=(1, 2)))


def extra_cost(of: Evaluation, control: Array) -> Array:
    """Return the additional terms of the regularised problem's Hamiltonian."""
    *_, smoothing, fraction = _limits(of)
    return np.asarray((0.5 * smoothing * control**2 - (1.0 - fraction) * _weights(of) * np.abs(control)).sum(axis=0))


def _weights(of: Evaluation, **given: Array) -> Array:
    return np.broadcast_to(of("magnitude_weight", **given), of.at["u"].shape)


def of_path_constraints(of: Evaluation) -> Iterator[Relation]:
    """Yield relations of gradients and rates of path constraints, and of quantities that vanish on the boundary."""
    orders = np.array([one.order for one in of.kernels.spec.path_constraints])
    second, derived = orders > 1, orders > 0
    yield from derivative(of, "path_gradient", "path_constraints", ("x",))
    yield from derivative(of, "path_effect", "path_constraints", ("u",))
    rates, law = of("path_rates"), _constrained_law(of)
    first, terms = along(of, "path_constraints", of("dynamics"))
    wanted = np.where(derived[:, None], first, 0.0)
    yield Relation("path_rates", "first rates of the constraints", rates[:, 0], wanted, terms)
    faster, terms = along(of, "path_rates", of("dynamics"))
    wanted = np.where(second[:, None], faster[:, 0], 0.0)
    yield Relation("path_rates", "second rates of the constraints", rates[:, 1], wanted, terms[:, 0])
    vanishing, last, own = of("path_vanishing", u=law), of("path_rates", u=law), of("path_constraints", u=law)
    wanted = np.where(second[:, None], last[:, 1], np.where(derived[:, None], last[:, 0], own))
    faint = SMALLEST_FRACTION * max(size(last).max(), size(own).max())
    if of.kernels.spec.switching:
        wanted, moved = own.copy(), np.abs(_effect(of)).argmax(axis=1)
        wanted[derived] = np.take_along_axis(of("switching_function"), moved, axis=0)[derived]
        faint = SMALLEST_FRACTION * max(size(vanishing).max(), size(wanted).max())
    yield Relation("path_vanishing", "the last rate under the law", vanishing[:, 0], wanted, faint)
    for k, order in enumerate(orders):
        if order:
            yield from _on_boundary(of, k, order)
        elif of.has("boundary_control"):
            yield from _while_active(of, k)


def _constrained_law(of: Evaluation) -> Array:
    """Return the unbounded law; where it has no closed form, any controls, for which the relations hold as well."""
    closed = of.has("boundary_control") and not of.kernels.spec.switching
    return of("control_law", bounds=_none(of)) if closed else np.asarray(of.at["u"])


def _effect(of: Evaluation) -> Array:
    """Return the derivatives of the last rate of each constraint by the controls, shape (h, m, N)."""
    first, second = np.moveaxis(of.slope("path_rates", "u"), 1, 0)
    return np.where(np.any(second, axis=(1, 2), keepdims=True), second, first)


def _none(of: Evaluation) -> Any:
    """Return infinite bounds where there are none."""
    bounds = of.at["bounds"]
    return tuple(np.full(len(of.at["t"]), np.inf if 2 * k >= len(bounds) else -np.inf) for k in range(len(bounds)))


def _while_active(of: Evaluation, which: int) -> Iterator[Relation]:
    """Relate a constraint that contains controls with its multiplier: they make H stationary, and keep it zero."""
    u = of("boundary_control")[which]
    eta, effect = of("path_multiplier")[which], of("path_effect", u=u)[which]
    kept, sizes = of("path_constraints", u=u)[which], np.abs(effect * u).sum(axis=0)
    yield Relation("boundary_control", "keeps the constraint", kept, np.zeros_like(kept), sizes)
    if of.kernels.spec.switching:
        return
    slope = of("stationarity", u=u)
    terms = np.abs(slope) + np.abs(of("control_hessian", u=u) * u).sum(axis=1)  # of a control that is free they cancel
    yield Relation("path_multiplier", "makes the control stationary", slope, -eta * effect, terms)


def _on_boundary(of: Evaluation, which: int, order: int) -> Iterator[Relation]:
    """Yield relations on the boundary of a state constraint, whose rates stay zero under the multiplier there."""
    vanishing = of("path_vanishing", u=_constrained_law(of))
    found, terms = _rates_on_boundary(of, which)
    if order > 1:
        yield Relation("path_vanishing", "and its rate", vanishing[which, 1], found[which, 0], terms[which, 0])
    zero = found[which, order - 1]
    yield Relation("path_multiplier", "keeps to the boundary", zero, np.zeros_like(zero), terms[which, order - 1])
    if not of.has("boundary_control"):
        return
    u = of("boundary_control")[which]
    kept = of("path_rates", u=u)[which, order - 1]
    sizes = np.abs(of.slope("path_rates", "u") * u).sum(axis=-2)[which, order - 1]
    yield Relation("boundary_control", "keeps the last rate zero", kept, np.zeros_like(kept), sizes)


def _rates_on_boundary(of: Evaluation, which: int) -> tuple[Array, Array]:
    """Return the rates along the extremal of quantities that vanish on one boundary, and the sizes of their terms."""
    law = _constrained_law(of)
    eta, push = of("path_multiplier", u=law)[which], of("path_gradient")[which]
    moving, falling = of("dynamics", u=law), of("costate_rate", u=law)
    forced = falling - eta * push, np.abs(falling) + np.abs(eta * push)
    found, terms = _along_extremal(of, "path_vanishing", law, moving, forced)
    if of.has("boundary_control"):
        return found, terms
    drift, sizes = _along_extremal(of, "stationarity", law, moving, forced)
    flat = np.linalg.inv(np.moveaxis(of("control_hessian", u=law), -1, 0))
    turning, most = (np.einsum("kij,jk->ik", m, d) for m, d in ((-flat, drift), (np.abs(flat), sizes)))
    slope = of.slope("path_vanishing", "u", u=law)
    return found + (slope * turning).sum(axis=-2), terms + (np.abs(slope) * most).sum(axis=-2)


def _along_extremal(
    of: Evaluation, name: str, u: Array, moving: Array, forced: tuple[Array, Array]
) -> tuple[Array, Array]:
    """Return the rate of a function along states and costates with constant controls, and the sizes of its terms.

    ``forced`` are the rates of the costates, and the sizes of the terms of these.
    """
    by_state, terms = along(of, name, moving, u=u)
    slope, (rates, sizes) = of.slope(name, "lam", u=u), forced
    return by_state + (slope * rates).sum(axis=-2), terms + (np.abs(slope) * sizes).sum(axis=-2)
