"""Neighbours simulated side by side, all their steps at once, while their ends are corrected.

One motion after the other costs as many calls as there are steps. What all steps of all neighbours reach from where
they are thought to begin are a few calls on arrays instead. The gaps between these, and what the ends miss, are closed
by Newton's method with the derivatives along the solution, which is near: in the end the steps are those of the same
simulation.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.grid import interleave
from satsym.solvers.certificate.competitors.accessory import Along
from satsym.solvers.certificate.competitors.simulations import Simulations
from satsym.solvers.certificate.reintegration.chain import Chain

SWEEPS = 16
"""Over all steps, at most."""

CLOSED = 1e-10
"""Gaps between steps, carried on to all later ones and relative to the sizes of the states, after whose correction
there are none."""

SHRINKING = 0.3
"""Share of the largest gap, or miss of an end, that a sweep may leave: where derivatives along the solution say little
of its neighbours these are better simulated one after the other."""

STAGES = ((0, 0.5, 1.0), (1, 0.5, 2.0), (1, 1.0, 2.0), (2, 0.0, 1.0))
"""Of a step of RK4: at its beginning, middle or end; the share of the step to the next; its weight."""

Stages = list[tuple[Array, Array, Array]]
"""Times, states and controls of all steps at each stage."""


@dataclass(frozen=True, eq=False)
class SideBySide:
    """Neighbours of a solution with the same duration."""

    simulations: Simulations
    """With the solution's own motion."""
    second: Along
    """What changes of the control do."""
    control: Array
    """The solution's own at nodes and midpoints, shape (m, 2N + 1)."""
    sizes: Array
    """Of the states, shape (n,)."""

    def costs(self, changes: Array, end: Array, missed: float) -> Array | None:
        """Of neighbours once their ends are as they should be, shape (B,); ``None`` where they do not settle.

        Parameters
        ----------
        changes
            Of the control, shape (k, B), to which others are added that correct the end.
        end
            What ties the end, in sizes, as it should be, shape (c,).
        missed
            Largest difference from that.
        """
        grid, (own, _) = self.simulations.grid(), self.simulations.own
        chain, response = self._linear
        states = own.T[:, :, None] + np.concatenate([np.zeros((1, *response.shape[1:])), response]) @ changes
        before = np.inf
        for _ in range(SWEEPS):
            reached, stages = self._stepped(states, changes)
            carried = chain.carried(reached - states[1:])
            states[1:] += carried
            ends = [self.simulations.measured(one[:, None], 0.0, grid) for one in states[-1].T]
            gap = np.array([at - end for _, at in ends]).T
            apart = float((np.abs(carried).max(axis=(0, 2)) / self.sizes).max())
            miss = float(np.abs(gap).max(initial=0.0))
            if apart <= CLOSED and miss <= missed:
                return self._running(stages) + np.array([terminal for terminal, _ in ends])
            if not max(apart, miss) <= SHRINKING * before:
                return None
            added = -np.linalg.lstsq(self.second.ties, gap, rcond=None)[0]
            changes, before = changes + added, max(apart, miss)
            states[1:] += response @ added
        return None

    @cached_property
    def _times(self) -> tuple[Array, Array]:
        """Nodes with midpoints, shape (2N + 1,), and the lengths of steps, shape (N,)."""
        grid = self.simulations.grid()
        return interleave(grid.nodes, grid.midpoints), grid.widths

    @cached_property
    def _linear(self) -> tuple[Chain, Array]:
        """Steps by where they begin, and how the states at all nodes but the first follow changes, shape (N, n, k)."""
        (times, h), (own, _), model = self._times, self.simulations.own, self.simulations.instance.model
        x, p = interleave(own, (own[:, 1:] + own[:, :-1]) / 2.0), self.simulations.instance.parameters
        n, m = len(x), len(self.control)
        by_state = np.asarray(model.jacobian_x_batch(times, x, self.control, p)).reshape(n, n, -1).transpose(2, 0, 1)
        by_control = np.asarray(model.jacobian_u_batch(times, x, self.control, p)).reshape(n, m, -1).transpose(2, 0, 1)
        pushed = by_control @ self.second.controls.transpose(1, 0, 2)
        start, none = np.eye(n, n + pushed.shape[2]), np.zeros((len(times), n, n))
        h, push = h[:, None, None], np.concatenate([none, pushed], axis=2)
        first, middle, last = by_state[:-2:2], by_state[1::2], by_state[2::2]
        one = first @ start + push[:-2:2]
        two = middle @ (start + h / 2.0 * one) + push[1::2]
        three = middle @ (start + h / 2.0 * two) + push[1::2]
        four = last @ (start + h * three) + push[2::2]
        step = start + h / 6.0 * (one + 2.0 * (two + three) + four)
        chain = Chain(step[:, :, :n])
        return chain, chain.carried(np.ascontiguousarray(step[:, :, n:]))

    def _stepped(self, states: Array, changes: Array) -> tuple[Array, Stages]:
        """Where all steps end, shape (N, n, B), and the stages of the steps.

        Parameters
        ----------
        states
            Where they begin, and the ends, shape (N + 1, n, B).
        changes
            Of the control, shape (k, B).
        """
        instance, (times, h), (count, n, many) = self.simulations.instance, self._times, states[1:].shape
        moved = self.second.controls @ changes
        u = instance.control_set.project((self.control[:, :, None] + moved).reshape(len(moved), -1))
        u = u.reshape(moved.shape)
        given = [
            (np.repeat(times[own], many), u[:, own].reshape(len(u), -1))
            for own in (slice(0, -2, 2), slice(1, None, 2), slice(2, None, 2))
        ]
        begin, width = states[:-1].transpose(1, 0, 2).reshape(n, -1), np.repeat(h, many)
        now, rates, stages = begin, np.zeros_like(begin), []
        for at, share, weight in STAGES:
            t, control = given[at]
            stages.append((t, now, control))
            slope = np.asarray(instance.model.dynamics_batch(t, now, control, instance.parameters))
            rates += weight * slope
            now = begin + share * width * slope
        return (begin + width / 6.0 * rates).reshape(n, count, many).transpose(1, 0, 2), stages

    def _running(self, stages: Stages) -> Array:
        """Integrals of the running cost, shape (B,), by the stages of all steps."""
        instance, (_, h) = self.simulations.instance, self._times
        found = np.zeros((len(h), len(stages[0][0]) // len(h)))
        for (_, _, weight), stage in zip(STAGES, stages, strict=True):
            found += weight * np.asarray(instance.model.running_cost_batch(*stage, instance.parameters)).reshape(
                found.shape
            )
        return np.asarray(h / 6.0 @ found)
