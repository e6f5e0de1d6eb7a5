"""The second variation as a matrix, with respect to arc lengths and piecewise constant variations of the controls.

Scaled to a fixed length, each arc is a smooth problem with its length as a parameter, so that nothing jumps: a change
of the length adds its part of the rates and of H_x to the integral of the accessory problem (Bryson and Ho, Applied
Optimal Control, 6.3). For saturated arcs the lengths are the only variations; on a boundary the control follows from
the state, and the state stays on it if it is on it at the entry. If this form is positive on the variations that keep
the end conditions and the entries, an extremal with strict switching, strict Legendre condition on its arcs and
strictly positive boundary multipliers is a strict strong local minimum (Osmolovskii and Maurer, Applications to Regular
and Bang-Bang Control, 2012, chapters 6 and 7; with boundaries Maurer and Vossen, Sufficient conditions and sensitivity
analysis for optimal bang-bang control problems with state constraints, System Modeling and Optimization, 2009). For a
smooth extremal, which is a single arc, the form has a negative eigenvalue if the second variation has one; it does not
show conjugate times.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.end_form import final_values, fixed_states, multipliers
from satsym.solvers.certificate.jacobi import kernel
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.collocation.scaling import final_argument

DROWNED = 1e-8
"""Rounding error of the form, relative to the cost of a control variation, above which the form is unreliable."""

ALONG = 1.0 - 1e-6
"""Minimum cosine of the angle between two directions that count as the same."""


@dataclass(frozen=True, eq=False)
class Arc:
    """The accessory problem at the ends and midpoints of the steps of an arc, shapes (2 K + 1, ...), in scaled units.

    Time is the last component of the states x. Variations satisfy x' = motion x + push w + f / T dT with the cost (x'
    restoring x + w'w) / 2 + H_x x / T dT. Here w are the variations of the continuous controls, constant on each piece,
    and T is the length of the arc. An arc of no length has a single point and no pieces.
    """

    lasting: float
    pieces: int
    motion: Array
    push: Array
    restoring: Array
    rates: Array
    slope: Array
    met: Mapping[int, Met] = field(default_factory=dict)
    """Conditions and forms at the beginnings of steps, by the index of the step, and at the end of the arc."""
    basis: Array | None = None
    """Basis of the admissible control variations on each piece: w is a combination of its columns; shape (pieces, n,
    r). ``None`` means that all n components of w vary independently."""

    @classmethod
    def of(
        cls,
        times: Array,
        slopes: Array,
        rates: Array,
        hamiltonian: tuple[Array, Array],
        state: Array,
        cost: float,
        pieces: int,
        met: Mapping[int, Met] | None = None,
        controls: int | None = None,
    ) -> Arc:
        """Return the accessory problem from linearised extremal equations, by derivatives of the minimised H.

        Parameters
        ----------
        times
            Times of the ends and midpoints of steps, shape (2 K + 1,).
        slopes
            Derivatives of the rates of states and costates by these and by explicit time, shape (2 K + 1, 2 n, 2 n +
            1).
        rates
            Rates of states and costates, shape (2 n, 2 K + 1).
        hamiltonian
            First and second derivative of H with respect to explicit time, shapes (2 K + 1,).
        state, cost
            Units of states and time, shape (n + 1,), and of the cost.
        controls
            Number of controls, to which the variations of each piece are limited if a piece is one step; otherwise
            ``None``.
        """
        n, (by_time, twice) = len(rates) // 2, hamiltonian
        motion, follow, restoring = np.zeros((3, len(times), n + 1, n + 1))
        motion[:, :n, :n], motion[:, :n, n] = slopes[:, :n, :n], slopes[:, :n, -1]
        follow[:, :n, :n] = -slopes[:, :n, n : 2 * n]
        restoring[:, :n, :n] = -(slopes[:, n:, :n] + slopes[:, n:, :n].transpose(0, 2, 1)) / 2.0
        restoring[:, :n, n] = restoring[:, n, :n] = -slopes[:, n:, -1]
        restoring[:, n, n] = twice
        push = _roots(follow / state[:, None] / state * cost) if pieces else np.zeros_like(follow)
        basis = np.linalg.eigh(push[1::2] @ push[1::2])[1][:, :, -min(controls, n) :] if controls else None
        return cls(
            float(times[-1] - times[0]),
            pieces,
            motion * state / state[:, None],
            push,
            restoring * state[:, None] * state / cost,
            np.concatenate([rates[:n], np.ones((1, len(times)))]).T / state,
            np.concatenate([-rates[n:], by_time[None]]).T * state / cost,
            met or {},
            basis,
        )

    @property
    def widths(self) -> tuple[float, int]:
        """Return the length of a step, and the number of steps in a piece or, without pieces, in the whole arc."""
        steps = (len(self.motion) - 1) // 2
        return self.lasting / max(steps, 1), steps // max(self.pieces, 1)

    def stepped(self, k: int, x: Array, w: Array, share: Array) -> tuple[Array, Array]:
        """Return the variations in the middle and at the end of a step, by the classical Runge-Kutta method.

        Parameters
        ----------
        share
            Change of the arc's length, relative to its length.
        """
        h, (a, b, c) = self.widths[0], (2 * k, 2 * k + 1, 2 * k + 2)

        def rate(at: int, y: Array) -> Array:
            return self.motion[at] @ y + self.push[at] @ w + np.multiply.outer(self.rates[at], share)

        f1 = rate(a, x)
        f2 = rate(b, x + h / 2.0 * f1)
        f3 = rate(b, x + h / 2.0 * f2)
        f4 = rate(c, x + h * f3)
        after = x + h / 6.0 * (f1 + 2.0 * (f2 + f3) + f4)
        return (x + after) / 2.0 + h / 8.0 * (f1 - rate(c, after)), after

    @property
    def columns(self) -> int:
        """Return the number of control variations on the arc."""
        return self.pieces * (self.motion.shape[1] if self.basis is None else self.basis.shape[2])

    def added(self, form: Array, x: Array, length: Array, own: int, ties: list[Array]) -> Array:
        """Add the arc's contribution to a form and to constraints, and return the variations of the states at its end.

        Parameters
        ----------
        x
            Variations of the states at the beginning of the arc.
        length
            Change of the arc's length, for each variation.
        own
            Index of the first column that belongs to the arc's continuous controls.
        """
        self._meet(0, form, x, ties)
        if not self.lasting:
            jump = np.outer(self.rates[0], length)
            form += np.outer(length, self.slope[0] @ (x + 0.5 * jump))
            return np.asarray(x + jump)
        (h, per), n, share = self.widths, len(x), length / self.lasting
        basis = np.eye(n)[None] if self.basis is None else self.basis
        unit, r = np.sqrt(2.0 / (h * per)), basis.shape[2]

        def integrand(at: int, y: Array) -> Array:
            return np.asarray(y.T @ (self.restoring[at] @ y) / 2.0 + np.outer(share, self.slope[at] @ y))

        for k in range((len(self.motion) - 1) // 2):
            w, piece = np.zeros_like(x), k // per
            if self.pieces:
                place = slice(own + r * piece, own + r * (piece + 1))
                w[:, place] = unit * basis[piece % len(basis)]
                form[place, place] += np.eye(r) / per
            middle, after = self.stepped(k, x, w, share)
            form += h / 6.0 * (integrand(2 * k, x) + 4.0 * integrand(2 * k + 1, middle) + integrand(2 * k + 2, after))
            x = after
            self._meet(k + 1, form, x, ties)
        return x

    def _meet(self, place: int, form: Array, x: Array, ties: list[Array]) -> None:
        if (met := self.met.get(place)) is not None:
            ties += [*(met.kept @ x)]
            if met.curved is not None:
                form += x.T @ met.curved @ x / 2.0


@dataclass(frozen=True, eq=False)
class Met:
    """Linear conditions on the states at one time, rows of shape (c, n), and a quadratic form in them, shape (n, n)."""

    kept: Array
    curved: Array | None = None


@dataclass(frozen=True, eq=False)
class Quadratic:
    """The second variation as a quadratic form.

    Its arguments are changes of arc lengths, in units of the duration, followed by variations of the continuous
    controls. The latter are normalised so that their own cost is the unit matrix.
    """

    arcs: Sequence[Arc]
    form: Array
    """Matrix of the form, shape (P, P), in units of the cost."""
    lengths: int
    """Number of changes of arc lengths, which are the first arguments of the form."""
    ties: Array
    """Rows of the linear constraints that keep the end conditions and the entries of boundary arcs, shape (c, P)."""
    free_time: bool
    """Whether the final time is free."""

    def kept(self) -> tuple[Array, Array]:
        """Return scaling factors that make all arguments comparable, and a basis under the constraints."""
        size, lengths = np.sqrt(np.abs(np.diag(self.form))), self.lengths
        size[:lengths] = max(size[:lengths].max(), 1e-300)
        size[lengths:] = np.maximum(size[lengths:], 1e-6 * size[lengths:].max(initial=0.0) + 1e-300)
        rows = self.ties / size
        return size, kernel(rows / np.maximum(np.abs(rows).max(axis=1, keepdims=True), 1e-300))

    def reduced(self) -> tuple[Array, Array]:
        """Return the form under the constraints, relative to its diagonal, and its variations as columns."""
        size, free = self.kept()
        return free.T @ (self.form / size / size[:, None]) @ free, free / size[:, None]

    @property
    def curvature(self) -> float:
        """Return the smallest relative eigenvalue under the constraints; infinite if no variation is possible."""
        form = self.reduced()[0]
        return float(np.linalg.eigvalsh(form).min()) if form.size else float("inf")

    def flat_by_shift(self, flat: float) -> bool:
        """Return whether the form vanishes for a shift of the whole motion in time, and for no other variation.

        Parameters
        ----------
        flat
            Magnitude up to which an eigenvalue counts as zero.
        """
        (form, _), (size, free) = self.reduced(), self.kept()
        if not form.size:
            return False
        later = np.zeros(len(self.form))
        later[0] = 1.0
        if not self.free_time:  # what begins with a longer arc ends with a shorter one
            later[self.lengths - 1] -= 1.0
        values, axes = np.linalg.eigh(form)
        direction = free.T @ (size * later)
        along = abs(float(axes[:, 0] @ direction)) / max(float(np.linalg.norm(direction)), 1e-300)
        return bool(abs(values[0]) <= flat and (values[1:] > flat).all() and along > ALONG)

    @property
    def drowned(self) -> bool:
        """Return whether motions diverge so quickly that the form consists of rounding errors."""
        return not np.abs(np.diag(self.form)).max() * np.finfo(float).eps < DROWNED

    def steepest(self) -> tuple[float, Array]:
        """Return the smallest eigenvalue, relative to the cost of the variations themselves, and its direction.

        It is infinite if the constraints allow no variation, and NaN if the form is not finite.
        """
        if not np.isfinite(self.form).all():
            return float("nan"), np.zeros(len(self.form))
        free = kernel(self.ties / np.maximum(np.abs(self.ties).max(axis=1, keepdims=True), 1e-300))
        if not free.shape[1]:
            return float("inf"), np.zeros(len(self.form))
        values, axes = np.linalg.eigh(free.T @ self.form @ free)
        return float(values[0]), free @ axes[:, 0]


def scaled_units(solution: Solution) -> tuple[Array, float]:
    """Return the units of the scaled problem: those of the states, with time as the last one, and that of the cost."""
    unit, n = unit_sizes(solution), len(solution.x)
    return np.append(unit[:n], float(solution.times[-1] - solution.times[0])), float(unit[0] * unit[n])


def units(solution: Solution, state: Array) -> tuple[Array, float]:
    """Return units of the states, with time as the last one, and the unit of the cost.

    Parameters
    ----------
    state
        Typical magnitudes of the states, shape (n,).
    """
    cost = max(float((state * np.abs(solution.lam).max(axis=1)).sum()), 1e-300)
    return np.append(state, float(solution.times[-1] - solution.times[0])), cost


def _roots(follow: Array) -> Array:
    """Return the square roots of a stack of positive semidefinite symmetric matrices."""
    values, axes = np.linalg.eigh((follow + follow.transpose(0, 2, 1)) / 2.0)
    return np.asarray((axes * np.sqrt(np.maximum(values, 0.0))[:, None, :]) @ axes.transpose(0, 2, 1))


def quadratic(
    solution: Solution, arcs: Sequence[Arc], state: Array, cost: float, groups: Sequence[int] | None = None
) -> Quadratic:
    """Return the second variation as the sum of the contributions of arcs, junctions and the end.

    Parameters
    ----------
    state, cost
        Units of states and time, shape (n + 1,), and of the cost.
    groups
        Index of the length variation that each arc takes part in; ``None`` if each arc has its own.
    """
    lasting, groups = float(state[-1]), groups if groups is not None else range(len(arcs))
    lengths, own = max(groups) + 1, max(groups) + 1
    total = lengths + sum(arc.columns for arc in arcs)
    each = [sum(arc.lasting for arc, one in zip(arcs, groups, strict=True) if one == k) for k in range(lengths)]
    form, ties = np.zeros((total, total)), list[Array]()
    x: Array = np.zeros((len(state), total))
    for arc, group in zip(arcs, groups, strict=True):
        length = np.zeros(total)
        length[group] = lasting * (arc.lasting / each[group] if each[group] else 1.0)
        x = arc.added(form, x, length, own, ties)
        own += arc.columns
    duration = np.zeros(total)
    duration[:lengths] = lasting
    ties += [*_ended(solution, form, x, duration, state, cost)]
    table = np.array(ties).reshape(-1, total)
    return Quadratic(arcs, (form + form.T) / 2.0, lengths, table, solution.instance.tf is None)


def _ended(solution: Solution, form: Array, x: Array, duration: Array, state: Array, cost: float) -> Array:
    """Add the contribution of the end to the form, and return the rows of the end constraints."""
    instance, n, (tf, end, lam) = solution.instance, len(solution.x), final_values(solution)
    nu, _ = multipliers(instance, tf, end, lam)
    table = instance.model.boundary_jacobian(
        tf, end, lam, nu, instance.parameters, instance.control_set.arguments, final_argument(instance)
    )
    slopes = np.array(table).reshape(n + len(nu) + 1, -1)
    fixed = fixed_states(instance)
    both = np.concatenate([(state[:, None] * x)[:n], duration[None]])
    by = np.column_stack([slopes[:, :n], slopes[:, -1]])
    curved = np.zeros((n + 1, n + 1))
    curved[:n][~fixed] = -by[:n][~fixed]
    curved[n, :n], curved[n, n] = curved[:n, n], by[-1, -1]
    form += both.T @ curved @ both / (2.0 * cost)
    ties = np.concatenate([by[:n][fixed], by[n:-1]]) @ both
    return ties if instance.tf is None else np.concatenate([ties, duration[None]])
