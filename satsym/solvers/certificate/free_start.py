"""Second derivatives of the minimum cost with respect to free initial states, from the field of neighbouring extremals.

Neighbouring extremals that satisfy the final conditions span, in states and costates at the initial time, a Lagrangian
plane (X, Lambda). The initial costate is the gradient of the minimum cost V, so that Lambda = V_xx X: among the
extremals that keep the given initial states, X' Lambda is the second derivative of V with respect to the free ones. If
the extremal is a strict minimum for a given initial state and this form is positive, it is a strict minimum for a free
initial state. The plane is propagated backwards from the final time, so that no accuracy is lost where motions diverge
quickly.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Solution
from satsym.solvers.certificate.end_form import boundary_slopes
from satsym.solvers.certificate.jacobi import AFRESH, kernel
from satsym.solvers.certificate.reintegration.segments import segments
from satsym.solvers.certificate.start import STILL, UNRESOLVED, Curvature, softest

SWITCHED = "bang-bang"
"""Method of extremals with switching controls, for which the field of neighbouring extremals is not available."""

DISTINCT = 1e-9
"""Minimum singular value, relative, of the states in a plane of extremals. Below it, extremals cannot be distinguished
by their initial states, and the derivatives count as not resolved."""


def tells(instance: Instance) -> bool:
    """Return whether only initial states are free and the model is smooth, so that neighbouring extremals suffice."""
    spec = instance.model.spec
    in_arcs = spec.switching or spec.throttled or spec.in_arcs
    return not in_arcs and all(unknown.place is Place.INITIAL for unknown in instance.free)


def curvature(solution: Solution) -> Curvature:
    """Return the curvature of the minimum cost in the free initial states.

    It is not resolved if other quantities than initial states are free, if the extremal consists of arcs, or if the
    computation fails numerically.
    """
    form = second_derivative(solution)
    if form is None:
        return UNRESOLVED
    largest = np.abs(solution.x).max(axis=1)[[unknown.index for unknown in solution.instance.free]]
    unit = np.where(largest > 0.0, largest, 1.0)
    return Curvature(softest(form * np.outer(unit, unit), STILL * abs(solution.objective))[0])


def second_derivative(solution: Solution) -> Array | None:
    """Return the second derivatives of the minimum cost with respect to free initial states.

    Returns
    -------
    Array
        Shape (f, f), symmetric; ``None`` where they are not resolved.
    """
    instance, n = solution.instance, len(solution.x)
    if solution.method in (BOUNDARY_ARCS, SWITCHED) or not tells(instance):
        return None
    with np.errstate(all="ignore"):
        along = segments(solution)
        plane = None if along is None else _ended(solution, along.scale)
        if along is None or plane is None:
            return None
        for number, matrix in enumerate(along.transition[::-1]):
            plane = _inverse(matrix) @ plane
            if number % AFRESH == AFRESH - 1:
                plane = np.linalg.qr(plane)[0]
        if not np.isfinite(plane).all():
            return None
        plane = np.linalg.qr(plane)[0]
    free = np.isin(np.arange(n), [unknown.index for unknown in instance.free])
    kept = plane @ kernel(plane[:n][~free])
    states, costates = kept[:n][free], kept[n:][free]
    values = np.linalg.svd(states, compute_uv=False)
    if (
        len(values) != int(free.sum())
        or states.shape[0] != states.shape[1]
        or not values.min() > DISTINCT * values.max()
    ):
        return None
    unit = along.scale[:n][free]
    form = np.linalg.solve(states.T, costates.T).T * along.scale[n:][free][:, None] / unit
    return np.asarray((form + form.T) / 2.0)


def _ended(solution: Solution, scale: Array) -> Array | None:
    """Return an orthonormal basis, shape (2n, n), of neighbouring extremals that satisfy the final conditions.

    The basis is taken at the final time; ``None`` if the plane is not resolved.
    """
    instance, n = solution.instance, len(solution.x)
    tf, slopes, rates = boundary_slopes(solution)
    by_time = slopes[:, : 2 * n] @ rates + slopes[:, -1]
    rows = np.column_stack(
        [slopes[:, : 2 * n] * scale, slopes[:, 2 * n : -1], by_time * (tf - float(solution.times[0]))]
    )
    if instance.tf is not None:
        rows = rows[:-1, :-1]
    rows = rows / np.maximum(np.abs(rows).max(axis=1, keepdims=True), 1e-300)
    rows[:, 2 * n :] /= np.maximum(np.abs(rows[:, 2 * n :]).max(axis=0), 1e-300)
    found = kernel(rows)[: 2 * n] if np.isfinite(rows).all() else np.zeros((2 * n, 0))
    if found.shape[1] != n:
        return None
    plane, triangle = np.linalg.qr(found)
    return plane if np.abs(np.diag(triangle)).min() > DISTINCT else None


def _inverse(symplectic: Array) -> Array:
    """Return the inverse of a symplectic matrix."""
    n = len(symplectic) // 2
    a, b, c, d = symplectic[:n, :n], symplectic[:n, n:], symplectic[n:, :n], symplectic[n:, n:]
    return np.block([[d.T, -b.T], [-c.T, a.T]])
