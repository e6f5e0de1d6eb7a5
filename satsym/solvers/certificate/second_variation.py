"""The second variation as a matrix: in the lengths of arcs, and in what continuous controls change on short pieces.

Stretched to a fixed length each arc is a smooth problem with a parameter, so that nothing jumps: to the integral of the
accessory problem (Bryson and Ho, Applied Optimal Control, 6.3) a change of the length adds its share of the rates, and
of H_x. Where arcs are saturated their lengths are all there is; on a boundary the control follows the state, and keeps
to it where the state is on it at the entry. Where this form is positive on what keeps the end and the entries, an
extremal that switches strictly, with Legendre's condition strict on its arcs and strictly pressed against its
boundaries, is a strict strong local minimum (Osmolovskii and Maurer, Applications to Regular and Bang-Bang Control,
2012, chapters 6 and 7; with boundaries Maurer and Vossen, Sufficient conditions and sensitivity analysis for optimal
bang-bang control problems with state constraints, System Modeling and Optimization, 2009). Of a smooth extremal, which
is one arc, it has a negative eigenvalue where the second variation has one; it knows nothing of conjugate times.
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
"""Share of the weight of a control's change that rounding of the form may come to."""

ALONG = 1.0 - 1e-6
"""Least cosine between directions that are the same."""


@dataclass(frozen=True, eq=False)
class Arc:
    """The accessory problem at the ends and in the middle of each step of an arc, shapes (2 K + 1, ...), in units.

    States x have the time as their last one. Changes follow x' = motion x + push w + f / T dT and cost
    (x' restoring x + w'w) / 2 + H_x x / T dT; those of the continuous controls, w, are constant on each piece. An arc
    of no length has a single place and no pieces.
    """

    lasting: float
    pieces: int
    motion: Array
    push: Array
    restoring: Array
    rates: Array
    slope: Array
    met: Mapping[int, Met] = field(default_factory=dict)
    """What is met where steps begin, by their numbers, and at the end."""
    basis: Array | None = None
    """In what changes w are combined on each piece, shape (pieces, n, r); all of the states without it."""

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
        """The accessory problem that linearised extremal equations give, by the derivatives of least H over controls.

        Parameters
        ----------
        times
            The ends and middles of steps, shape (2 K + 1,).
        slopes
            The rates of states and costates by these and by explicit time, shape (2 K + 1, 2 n, 2 n + 1).
        rates
            The rates themselves, shape (2 n, 2 K + 1).
        hamiltonian
            H by explicit time, once and twice, shapes (2 K + 1,).
        state, cost
            Units of states and time, shape (n + 1,), and of the cost.
        controls
            How many there are, if each piece is a step and its changes are to be as many.
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
        """The length of a step, and how many there are in a piece or, without any, in the whole arc."""
        steps = (len(self.motion) - 1) // 2
        return self.lasting / max(steps, 1), steps // max(self.pieces, 1)

    def stepped(self, k: int, x: Array, w: Array, share: Array) -> tuple[Array, Array]:
        """Where changes are in the middle and at the end of a step, by the classical Runge-Kutta method.

        Parameters
        ----------
        share
            The change of the arc's length, relative to it.
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
        """How many changes of the continuous controls there are."""
        return self.pieces * (self.motion.shape[1] if self.basis is None else self.basis.shape[2])

    def added(self, form: Array, x: Array, length: Array, own: int, ties: list[Array]) -> Array:
        """Add what the arc gives to a form and to ties, and return the states at its end by all changes.

        Parameters
        ----------
        x
            Those at its beginning.
        length
            The change of its length.
        own
            The first column of its continuous controls.
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
    """Conditions at one time: rows that vanish on the states, shape (c, n), and a form in these, shape (n, n)."""

    kept: Array
    curved: Array | None = None


@dataclass(frozen=True, eq=False)
class Quadratic:
    """The form in changes of the lengths of arcs, in units of the duration, and then of the continuous controls.

    The latter are normed so that by themselves they would give the unit matrix.
    """

    arcs: Sequence[Arc]
    form: Array
    """Shape (P, P), in units of the cost."""
    lengths: int
    """How many of the changes are of lengths."""
    ties: Array
    """Rows that vanish where the end and the entries are kept, shape (c, P)."""
    free_time: bool
    """Whether the final time is free."""

    def kept(self) -> tuple[Array, Array]:
        """Sizes that make all changes comparable, and directions relative to these that keep the ties, as columns."""
        size, lengths = np.sqrt(np.abs(np.diag(self.form))), self.lengths
        size[:lengths] = max(size[:lengths].max(), 1e-300)
        size[lengths:] = np.maximum(size[lengths:], 1e-6 * size[lengths:].max(initial=0.0) + 1e-300)
        rows = self.ties / size
        return size, kernel(rows / np.maximum(np.abs(rows).max(axis=1, keepdims=True), 1e-300))

    def reduced(self) -> tuple[Array, Array]:
        """The form where the ties vanish, relative to its diagonal, and the changes that it is about, as columns."""
        size, free = self.kept()
        return free.T @ (self.form / size / size[:, None]) @ free, free / size[:, None]

    @property
    def curvature(self) -> float:
        """The smallest eigenvalue where the ties vanish, relative; infinite where they fix all."""
        form = self.reduced()[0]
        return float(np.linalg.eigvalsh(form).min()) if form.size else float("inf")

    def flat_by_shift(self, flat: float) -> bool:
        """Whether the form vanishes where all happens later, in that direction and no other.

        Parameters
        ----------
        flat
            Up to which an eigenvalue counts as zero.
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
        """Whether motions part so quickly that nothing but rounding is left of the form."""
        return not np.abs(np.diag(self.form)).max() * np.finfo(float).eps < DROWNED

    def steepest(self) -> tuple[float, Array]:
        """The least eigenvalue, in units of what changes cost by themselves, and its direction.

        Infinite where the ties fix all changes, NaN where numbers fail.
        """
        if not np.isfinite(self.form).all():
            return float("nan"), np.zeros(len(self.form))
        free = kernel(self.ties / np.maximum(np.abs(self.ties).max(axis=1, keepdims=True), 1e-300))
        if not free.shape[1]:
            return float("inf"), np.zeros(len(self.form))
        values, axes = np.linalg.eigh(free.T @ self.form @ free)
        return float(values[0]), free @ axes[:, 0]


def scaled_units(solution: Solution) -> tuple[Array, float]:
    """Units of states and, as the last one, of time, and that of the cost: those of the scaled problem."""
    unit, n = unit_sizes(solution), len(solution.x)
    return np.append(unit[:n], float(solution.times[-1] - solution.times[0])), float(unit[0] * unit[n])


def units(solution: Solution, state: Array) -> tuple[Array, float]:
    """Units of states and, as the last one, of time; and that of the cost.

    Parameters
    ----------
    state
        Typical sizes of the states, shape (n,).
    """
    cost = max(float((state * np.abs(solution.lam).max(axis=1)).sum()), 1e-300)
    return np.append(state, float(solution.times[-1] - solution.times[0])), cost


def _roots(follow: Array) -> Array:
    """Square roots of a stack of symmetric matrices that are not negative."""
    values, axes = np.linalg.eigh((follow + follow.transpose(0, 2, 1)) / 2.0)
    return np.asarray((axes * np.sqrt(np.maximum(values, 0.0))[:, None, :]) @ axes.transpose(0, 2, 1))


def quadratic(
    solution: Solution, arcs: Sequence[Arc], state: Array, cost: float, groups: Sequence[int] | None = None
) -> Quadratic:
    """Add up what arcs, junctions and the end give.

    Parameters
    ----------
    state, cost
        Units of states and time, shape (n + 1,), and of the cost.
    groups
        Which change of length each arc has its share of; its own without these.
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
    """Add to the form what the end does, and return the rows that vanish."""
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
