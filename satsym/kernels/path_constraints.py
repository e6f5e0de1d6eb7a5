"""What the functions of constraints along the way must have to do with each other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.kernels.evaluation import SMALLEST_SHARE, Evaluation, size
from satsym.kernels.relations import Relation, along, derivative


def of_path_constraints(of: Evaluation) -> Iterator[Relation]:
    """Gradients and rates are derivatives; what vanishes on the boundary stays there with the multiplier."""
    orders = np.array([one.order for one in of.kernels.spec.path_constraints])
    second, derived = orders > 1, orders > 0
    yield from derivative(of, "path_gradient", "path_constraints", ("x",))
    yield from derivative(of, "path_effect", "path_constraints", ("u",))
    rates, law = of("path_rates"), _law(of)
    first, terms = along(of, "path_constraints", of("dynamics"))
    wanted = np.where(derived[:, None], first, 0.0)
    yield Relation("path_rates", "first rates of the constraints", rates[:, 0], wanted, terms)
    faster, terms = along(of, "path_rates", of("dynamics"))
    wanted = np.where(second[:, None], faster[:, 0], 0.0)
    yield Relation("path_rates", "second rates of the constraints", rates[:, 1], wanted, terms[:, 0])
    vanishing, last, own = of("path_vanishing", u=law), of("path_rates", u=law), of("path_constraints", u=law)
    wanted = np.where(second[:, None], last[:, 1], np.where(derived[:, None], last[:, 0], own))
    faint = SMALLEST_SHARE * max(size(last).max(), size(own).max())
    if of.kernels.spec.switching:
        wanted, moved = own.copy(), np.abs(_effect(of)).argmax(axis=1)
        wanted[derived] = np.take_along_axis(of("switching_function"), moved, axis=0)[derived]
        faint = SMALLEST_SHARE * max(size(vanishing).max(), size(wanted).max())
    yield Relation("path_vanishing", "the last rate under the law", vanishing[:, 0], wanted, faint)
    for k, order in enumerate(orders):
        if order:
            yield from _on_boundary(of, k, order)
        elif of.has("boundary_control"):
            yield from _while_active(of, k)


def _law(of: Evaluation) -> Array:
    """Without bounds; where the law is not in closed form any controls, as what is looked at holds for all of these."""
    closed = of.has("boundary_control") and not of.kernels.spec.switching
    return of("control_law", bounds=_none(of)) if closed else np.asarray(of.at["u"])


def _effect(of: Evaluation) -> Array:
    """What controls do to the last rate of each constraint, shape (h, m, N)."""
    first, second = np.moveaxis(of.slope("path_rates", "u"), 1, 0)
    return np.where(np.any(second, axis=(1, 2), keepdims=True), second, first)


def _none(of: Evaluation) -> Any:
    """Bounds where there are none."""
    bounds = of.at["bounds"]
    return tuple(np.full(len(of.at["t"]), np.inf if 2 * k >= len(bounds) else -np.inf) for k in range(len(bounds)))


def _while_active(of: Evaluation, which: int) -> Iterator[Relation]:
    """Relate a constraint that holds controls with its multiplier: they make H stationary, and keep it zero."""
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
    """Relate a constraint on states alone with its multiplier: what vanishes on the boundary keeps vanishing."""
    vanishing = of("path_vanishing", u=_law(of))
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
    """Rates of what vanishes along the extremal on the boundary of one constraint, and sizes of their terms."""
    law = _law(of)
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
    """The rate of change of a function with states and costates, controls being held, and sizes of its terms.

    ``forced`` are the rates of the costates, and the sizes of the terms of these.
    """
    by_state, terms = along(of, name, moving, u=u)
    slope, (rates, sizes) = of.slope(name, "lam", u=u), forced
    return by_state + (slope * rates).sum(axis=-2), terms + (np.abs(slope) * sizes).sum(axis=-2)
