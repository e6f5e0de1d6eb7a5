"""Newton's equations of the program, factorised stage by stage; the factors say how the Lagrangian is curved.

What is unknown at a stage (the state at its end, the control, the multipliers of its motion) meets that of others only
in the state at which the stage begins. Every other stage is eliminated, all of these at once, until one is left and,
for the multipliers at the end and the duration, a last block (cyclic reduction). By Sylvester and Haynsworth the signs
of the blocks' eigenvalues are those of the whole matrix: the Lagrangian is convex along all that the linearised
conditions allow exactly where as many are negative as there are conditions (Gould, Mathematical Programming 32, 1985).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.solvers.constrained.regularised.slopes import Slopes
from satsym.solvers.constrained.regularised.transcription import Step

FAINT = 1e-8
"""Share of the largest curvature that any direction is measured by at least."""

ACCURATE = 1e-6
"""Largest error of a solution, relative to the right-hand side, that Newton's method puts up with."""


@dataclass(frozen=True, eq=False)
class Level:
    """One step of elimination: of every other stage, the first among them, by the ones before and after it."""

    inverses: Array
    """Of the blocks of stages that are eliminated."""
    entering: Array
    leaving: Array
    """Coupling of these by the states at which they begin, and of the stages kept by those at which these do."""

    @classmethod
    def of(cls, blocks: Array, coupling: Array) -> tuple[Level, Array, Array]:
        """Besides the blocks of stages that are kept, and their coupling."""
        entering, leaving = coupling[::2], coupling[1::2]
        n, inverses, kept = coupling.shape[2], np.linalg.inv(blocks[::2]), blocks[1::2].copy()
        inner = leaving @ inverses[: len(kept), :n]
        kept -= inner[..., :n] @ leaving.swapaxes(1, 2)
        kept[: len(inverses) - 1, :n, :n] -= entering[1:].swapaxes(1, 2) @ inverses[1:] @ entering[1:]
        return cls(inverses, entering, leaving), kept, -inner @ entering[: len(kept)]

    def before(self, right: Array) -> Array:
        """The right-hand side that is left for the stages that are kept."""
        n, found, kept = self.entering.shape[2], self.inverses @ right[::2], right[1::2].copy()
        kept -= self.leaving @ found[: len(kept), :n]
        kept[: len(found) - 1, :n] -= self.entering[1:].swapaxes(1, 2) @ found[1:]
        return kept

    def after(self, right: Array, kept: Array) -> Array:
        """What solves the equations of the stages that were eliminated, those of the others solved."""
        n, rest = self.entering.shape[2], right[::2].copy()
        rest[: len(kept), :n] -= self.leaving.swapaxes(1, 2) @ kept
        rest[1:] -= self.entering[1:] @ kept[: len(rest) - 1, :n]
        return np.asarray(self.inverses @ rest)


@dataclass(frozen=True, eq=False)
class Factors:
    """Of the matrix of Newton's equations."""

    blocks: Array
    """Of each stage, shape (N, 2n + m, 2n + m): state, control, multipliers of the motion."""
    coupling: Array
    """By the state at which each stage begins, shape (N, 2n + m, n)."""
    border: Array
    corner: Array
    """By the multipliers at the end and the duration, shape (N, 2n + m, q), and of these by themselves."""
    levels: list[Level]
    """Of elimination."""
    reached: Array
    """The border after elimination, shape (N, 2n + m, q)."""
    last: Array
    """What elimination leaves of the corner."""
    convex: bool
    """Whether the Lagrangian is strictly convex along what the linearised conditions allow."""

    @classmethod
    def of(cls, slopes: Slopes, own: float = 0.0, curved: float = 0.0) -> Factors:
        """Factorise.

        Parameters
        ----------
        slopes
            Derivatives, as :meth:`~satsym.solvers.constrained.regularised.slopes.Slopes.stiffened` leaves them.
        own
            The second derivative of the Lagrangian by the duration.
        curved
            Curvature that is added in all directions, relative to that which each has.

        Raises
        ------
        numpy.linalg.LinAlgError
            Where the matrix is singular, or not finite.
        """
        blocks, coupling, border, corner = _assembled(slopes, own)
        n, m = slopes.b.shape[1:]
        if curved:
            size = np.abs(np.diagonal(blocks[:, : n + m, : n + m], axis1=1, axis2=2))
            size = np.maximum(size, FAINT * size.max())
            places = np.arange(n + m)
            blocks[:, places, places] += curved * size
            if slopes.timed is not None:
                corner[-1, -1] += curved * max(abs(own), FAINT * size.max())
        levels, negative, left, joined = list[Level](), 0, blocks, coupling
        while len(left):
            negative += _negative(left[::2])
            level, left, joined = Level.of(left, joined)
            levels.append(level)
        reached = _reduced(levels, border)
        last = corner - np.einsum("kiq,kir->qr", border, reached)
        conditions = len(blocks) * n + len(slopes.ends)
        if not np.isfinite(last).all():
            raise np.linalg.LinAlgError("not finite")
        return cls(
            blocks, coupling, border, corner, levels, reached, last, negative + _negative(last[None]) == conditions
        )

    def step(self, slopes: Slopes, gradient: Step) -> Step:
        """Newton's step, after which a gradient and the conditions in it vanish as far as they are linear.

        Raises
        ------
        numpy.linalg.LinAlgError
            Where rounding leaves too little of it.
        """
        n, m = slopes.b.shape[1:]
        e, timed = len(slopes.ends), slopes.timed is not None
        stages = -np.concatenate([gradient.x, gradient.u, gradient.y]).T
        rest = -np.append(gradient.v, [gradient.duration] if timed else [])
        found, others = self._solved(stages, rest)
        left = self._left(stages, rest, found, others)
        more = self._solved(*left)
        found, others = found + more[0], others + more[1]
        left = self._left(stages, rest, found, others)
        size = max(np.abs(stages).max(), np.abs(rest).max(initial=0.0))
        if not max(np.abs(left[0]).max(), np.abs(left[1]).max(initial=0.0)) <= ACCURATE * size:
            raise np.linalg.LinAlgError("too ill-conditioned")
        x, u, y = np.split(found.T, [n, n + m])
        return Step(x, u, float(others[-1]) if timed else 0.0, y, others[:e])

    def _solved(self, stages: Array, rest: Array) -> tuple[Array, Array]:
        swept = _reduced(self.levels, stages[..., None])[..., 0]
        others = np.linalg.solve(self.last, rest - np.einsum("kiq,ki->q", self.border, swept))
        return swept - self.reached @ others, others

    def _left(self, stages: Array, rest: Array, found: Array, others: Array) -> tuple[Array, Array]:
        """What a solution leaves of the right-hand side."""
        n = self.coupling.shape[2]
        made = np.einsum("kij,kj->ki", self.blocks, found) + self.border @ others
        made[1:] += np.einsum("kij,kj->ki", self.coupling[1:], found[:-1, :n])
        made[:-1, :n] += np.einsum("kij,ki->kj", self.coupling[1:], found[1:])
        return stages - made, rest - self.corner @ others - np.einsum("kiq,ki->q", self.border, found)


def _assembled(slopes: Slopes, own: float) -> tuple[Array, Array, Array, Array]:
    """Blocks, coupling, border and corner."""
    (count, n, m), e = slopes.b.shape, len(slopes.ends)
    second, unit, d = slopes.between, np.eye(n), 2 * n + m
    blocks, coupling = np.zeros((count, d, d)), np.zeros((count, d, n))
    blocks[:, :n, :n] = second[:, :n, :n] / 4 + slopes.nodes
    blocks[:-1, :n, :n] += second[1:, :n, :n] / 4
    blocks[:, n : n + m, :n] = second[:, n:, :n] / 2
    blocks[:, n : n + m, n : n + m] = second[:, n:, n:]
    blocks[:, n + m :, :n] = slopes.a / 2 - unit
    blocks[:, n + m :, n : n + m] = slopes.b
    blocks[:, :n, n:] = blocks[:, n:, :n].swapaxes(1, 2)
    blocks[:, n : n + m, n + m :] = slopes.b.swapaxes(1, 2)
    coupling[:, :n] = second[:, :n, :n] / 4
    coupling[:, n : n + m] = second[:, n:, :n] / 2
    coupling[:, n + m :] = slopes.a / 2 + unit
    coupling[0] = 0.0
    border, corner = np.zeros((count, d, e + (slopes.timed is not None))), np.zeros((e + 1, e + 1))
    border[-1, :n, :e] = slopes.ends.T
    if slopes.timed is None:
        return blocks, coupling, border, corner[:e, :e]
    between = slopes.timed.state / 2
    states = between + slopes.timed.nodes
    states[:, :-1] += between[:, 1:]
    border[:, :, e] = np.concatenate([states, slopes.timed.control, slopes.timed.gaps]).T
    corner[e, :e] = corner[:e, e] = slopes.timed.ends
    corner[e, e] = own
    return blocks, coupling, border, corner


def _reduced(levels: list[Level], right: Array) -> Array:
    """What solves the equations of the stages alone, shapes (N, 2n + m, columns)."""
    if not levels:
        return right
    found = np.empty_like(right)
    found[1::2] = _reduced(levels[1:], levels[0].before(right))
    found[::2] = levels[0].after(right, found[1::2])
    return found


def _negative(tables: Array) -> int:
    """How many eigenvalues of symmetric matrices are negative, scaled so that rounding does not decide."""
    if not tables.size:
        return 0
    size = 1.0 / np.sqrt(np.maximum(np.abs(tables).max(axis=2), 1e-300))
    values = np.linalg.eigvalsh(tables * size[:, :, None] * size[:, None, :])
    return int((values < 0.0).sum())
