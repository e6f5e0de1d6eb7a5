"""Transversality at a free start: derivatives of the minimum cost by free initial values and parameters.

The minimum cost V as a function of given initial values and parameters has as its derivative the initial costate for an
initial state, -H for the initial time, and the integral of H_p plus the contribution of the end for a parameter (Bryson
and Ho, Applied Optimal Control, 2.8 and 3.3; it is the costate of p as a state with p' = 0). If these vanish, the
initial values are stationary. The accessory problem with a free start is positive exactly if that with a given start
and the second derivative of V are positive, since V is the minimum over the motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.instance.unknowns import Place, Unknown
from satsym.solution import Certificate, Check, Solution
from satsym.solvers.certificate.competitors.drawn import natural
from satsym.solvers.certificate.end_form import final_values, multipliers
from satsym.solvers.certificate.jacobi import NOT_STRICT
from satsym.solvers.collocation.scaling import final_argument
from satsym.status import Verdict

STATIONARY = 1e-8
"""Largest relative derivative of the minimum cost with respect to a free quantity that counts as zero."""

FLAT = 1e-5
"""Relative curvature of the minimum cost below which its sign cannot be determined."""

STILL = 1e-2
"""Minimum reference for curvatures, relative to the cost. Curvatures smaller than ``FLAT`` times it count as zero."""

COMPLEX_STEP = 1e-30

ROUNDING = 1e-12
"""Derivative of the minimum cost, relative to the cost of controls that change the states by their own magnitudes, that
counts as zero: where the uncontrolled motion is optimal, all costates consist of rounding."""


@dataclass(frozen=True)
class Slope:
    """Derivative of the minimum cost with respect to a free quantity."""

    value: float
    size: float
    """Sum of the magnitudes of the terms that the derivative consists of."""

    @property
    def relative(self) -> float:
        """Return the magnitude of the derivative relative to ``size``; infinite if it is not finite."""
        found = abs(self.value) / max(self.size, 1e-300)
        return float(found) if np.isfinite(found) else float("inf")


def slope(solution: Solution, unknown: Unknown) -> Slope:
    """Return the derivative of the minimum cost with respect to a free quantity, at its value in the solution."""
    if unknown.place is Place.INITIAL:
        lam, x = np.abs(solution.lam).max(axis=1), np.abs(solution.x).max(axis=1)
        i = unknown.index
        energy = float(lam @ x) + abs(solution.objective) + ROUNDING / STATIONARY * _effort(solution)
        return Slope(float(solution.lam[i, 0]), max(float(lam[i]), energy / max(float(x[i]), 1e-300)))
    if unknown.place is Place.TIME:
        instance = solution.instance
        t, starts = float(solution.times[0]), (solution.x, solution.u, solution.lam)
        x, u, lam = (tuple(row[:, 0].tolist()) for row in starts)
        h = float(instance.model.hamiltonian(t, x, u, lam, instance.parameters))
        rates = np.array(instance.model.dynamics(t, x, u, instance.parameters))
        terms = np.abs(np.array(lam) * rates)
        return Slope(-h, float(terms.sum()) + abs(h - float(np.array(lam) @ rates)))
    along, its_size = _along(solution, unknown.index)
    end, end_size = _at_the_end(solution, unknown.index)
    return Slope(along + end, its_size + end_size)


def _effort(solution: Solution) -> float:
    """Return the running cost of controls that change the states by their own magnitudes; 0 if it is not finite."""
    instance, times = solution.instance, solution.times
    u = instance.control_set.project(natural(solution)[:, None] * np.ones(len(times)))
    rate = np.abs(instance.model.running_cost_batch(times, solution.x, u, instance.parameters))
    found = float(np.mean(rate)) * float(times[-1] - times[0])
    return found if np.isfinite(found) else 0.0


def _along(solution: Solution, index: int) -> tuple[float, float]:
    """Return the integrals of H_p and of the magnitudes of its terms, by Simpson's rule with Hermite midpoints."""
    instance, model, p = solution.instance, solution.instance.model, solution.instance.parameters
    t, x, u, lam = solution.times, solution.x, solution.u, solution.lam
    h = np.diff(t)
    middle = (t[1:] + t[:-1]) / 2.0
    rates = np.asarray(model.dynamics_batch(t, x, u, p)), np.asarray(model.costate_rate_batch(t, x, u, lam, p))
    state, costate = (
        np.asarray((row[:, 1:] + row[:, :-1]) / 2.0 + h / 8.0 * (rate[:, :-1] - rate[:, 1:]))
        for row, rate in zip((x, lam), rates, strict=True)
    )
    if model.spec.switching:  # between switching times controls are constant, or as smooth as on singular arcs
        control = (u[:, 1:] + u[:, :-1]) / 2.0
    else:
        control = np.asarray(model.control_law_batch(middle, state, costate, p, instance.control_set.arguments))
    moved = _stepped(p, index)

    def terms(*at: Array) -> Array:
        """Return the terms of H_p: each costate times the derivative of its rate, and that of the running cost."""
        found = np.zeros((len(x) + 1, len(at[0])))
        found[:-1] = at[3] * np.imag(model.dynamics_batch(at[0], at[1], at[2], moved)) / COMPLEX_STEP
        found[-1] = np.imag(model.running_cost_batch(at[0], at[1], at[2], moved)) / COMPLEX_STEP
        return found

    nodes, inside = terms(t, x, u, lam), terms(middle, state, control, costate)
    value = h / 6.0 * (nodes[:, :-1] + 4.0 * inside + nodes[:, 1:])
    return float(value.sum()), float(np.abs(value).sum())


def _at_the_end(solution: Solution, index: int) -> tuple[float, float]:
    """Return the contribution of terminal cost, terminal constraints and a moving reference, and its magnitude."""
    instance, model, n = solution.instance, solution.instance.model, len(solution.x)
    tf, x, lam = final_values(solution)
    nu, _ = multipliers(instance, tf, x, lam)
    bounds, p = instance.control_set.arguments, instance.parameters
    moved = _stepped(p, index)
    time, end, costate = solution.times[-1:], solution.x[:, -1:], solution.lam[:, -1:]
    parts = [float(np.imag(model.terminal_cost_batch(time, end, moved)).sum()) / COMPLEX_STEP]

    def rows(final: tuple[float, ...], parameters: tuple[Any, ...]) -> Array:
        return np.asarray(model.boundary_batch(time, end, costate, nu, parameters, bounds, final))[:, 0]

    # what holds the end on the reference: lambda - S_x - nu' psi_x, which is what a free state's residual is
    force = rows((0.0,) * (3 * n), p)[:n]
    final = final_argument(instance)
    shifted = np.imag(rows(final, moved)) / COMPLEX_STEP
    held = np.array(final).reshape(3, n)[1] > 0
    parts += (force * shifted[:n])[held].tolist() + (np.array(nu) * shifted[n : n + len(nu)]).tolist()
    return float(sum(parts)), float(np.abs(parts).sum())


def _stepped(parameters: tuple[float, ...], index: int) -> tuple[Any, ...]:
    """Return parameters with a complex step added to one of them."""
    return tuple(p + 1j * COMPLEX_STEP * (k == index) for k, p in enumerate(parameters))


@dataclass(frozen=True)
class Curvature:
    """Curvature of the minimum cost with respect to free initial quantities."""

    smallest: float
    """Smallest curvature, relative; NaN if it was not resolved."""

    @property
    def checks(self) -> list[Check]:
        """Return checks of the second-order condition at the start, each with a value that is positive if it fails."""
        if not np.isfinite(self.smallest):
            return [Check("second-order condition at the free initial point not resolved", 1.0, 0.0)]
        found = [Check("second-order condition at the free initial point", float(not self.smallest > -FLAT), 0.0)]
        return [*found, Check(NOT_STRICT, 1.0, 0.0)] if abs(self.smallest) <= FLAT else found


UNRESOLVED = Curvature(float("nan"))


def softest(form: Array, least: float) -> tuple[float, Array]:
    """Return the smallest relative curvature and its direction.

    Curvatures are relative to those along the axes, which count as at least ``least``.
    """
    unit = 1.0 / np.sqrt(np.maximum(np.abs(np.diag(form)), max(least, 1e-300)))
    values, vectors = np.linalg.eigh(form * np.outer(unit, unit))
    direction = unit * vectors[:, 0]
    return float(values[0]), direction / np.linalg.norm(direction)


def with_start(certificate: Certificate, solution: Solution, sufficient: Sequence[Check]) -> Certificate:
    """Return a certificate extended by the conditions that a free start requires as well.

    Parameters
    ----------
    sufficient
        Checks of the second-order condition at the free start, used if the necessary conditions hold.
    """
    first = [
        Check(f"transversality at the initial time: {unknown.name}", slope(solution, unknown).relative, STATIONARY)
        for unknown in solution.instance.free
    ]
    if not all(c.passed for c in first):
        return replace(certificate, verdict=Verdict.FAILED, checks=(*certificate.checks, *first))
    lesser = certificate.verdict is not Verdict.FAILED and not all(c.passed for c in sufficient)
    verdict = Verdict.EXTREMAL_ONLY if lesser else certificate.verdict
    return replace(certificate, verdict=verdict, checks=(*certificate.checks, *first, *sufficient))


def settled(solution: Solution) -> Solution:
    """Return a solution whose instance has the free initial quantities given at the values that were found."""
    return replace(solution, instance=replace(solution.instance, free=()))
