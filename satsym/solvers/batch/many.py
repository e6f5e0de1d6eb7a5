"""Instances of one problem that differ in initial states, final states and parameters, as columns of arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.batch.condensing import Condensing, condensing
from satsym.solvers.batch.motion import Motion, motion
from satsym.solvers.cold_start import paths
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import final_argument, two_point

FINER = 2
"""Number of segments for each time scale of the fastest mode, while steps are of low order."""


@dataclass(frozen=True, eq=False)
class Many:
    """M instances of one problem with given boundary values and times."""

    problem: TwoPoint
    """The common instance as a two-point boundary value problem, with its scales and times."""
    motion: Motion
    """Integrator of the canonical equations."""
    initial: Array
    end: Array
    """Initial and final states, shape (n, M)."""
    parameters: Array
    """Parameters, shape (k, M)."""
    mesh: Array
    """Nodes in [0, 1], shape (N+1, M), or (N+1, 1) if they are the same for all instances."""
    condense: Condensing
    """Function that expresses all nodes by the first node."""
    lower: Array
    upper: Array
    radius: Array
    """Bounds on controls, shapes (m, M), and on their norm, shape (M,), for judging solutions."""
    bounded: bool = False
    """Whether controls are limited by their bounds; otherwise the problems are solved as if there were none."""

    @classmethod
    def of(cls, instance: Instance, instances: Sequence[Instance], compiled: bool) -> Many:
        """Return the problems of instances that vary boundary values, parameters or bounds of a common instance."""
        assert instance.tf is not None
        problem = two_point(instance, instance.tf - instance.t0).relaxed(float("inf"))
        path = paths.first(problem)
        laid = meshes.along(problem, (tau := np.linspace(0.0, 1.0, paths.POINTS)), path(tau), problem.theta)
        mesh = np.interp(np.linspace(0.0, len(laid) - 1.0, FINER * (len(laid) - 1) + 1), np.arange(len(laid)), laid)
        parameters = np.array([one.parameters for one in instances]).reshape(len(instances), -1).T.copy()
        return cls(
            problem,
            motion(instance.model, problem.control_set.arguments, compiled),
            np.array([one.initial for one in instances]).T.copy(),
            _ends(instances, parameters),
            parameters,
            mesh[:, None],
            condensing(problem.states, compiled),
            np.array([one.lower for one in instances]).reshape(len(instances), -1).T,
            np.array([one.upper for one in instances]).reshape(len(instances), -1).T,
            np.array([one.max_norm for one in instances]),
        )

    @property
    def instance(self) -> Instance:
        """The common instance that is varied."""
        return self.problem.instance

    @property
    def states(self) -> int:
        """Number n of states."""
        return len(self.initial)

    @property
    def count(self) -> int:
        """Number M of instances."""
        return self.initial.shape[1]

    @cached_property
    def units(self) -> Array:
        """Units of states and costates, shape (2n,)."""
        return np.asarray(self.problem.scale.both[:, 0])

    @property
    def times(self) -> Array:
        """Times of the nodes, shape (N+1, M) or (N+1, 1)."""
        return self.instance.t0 + self.problem.duration * self.mesh

    @property
    def line(self) -> Array:
        """Straight line between initial and final states, with zero costates, at the nodes, shape (2n, N+1, M)."""
        found = np.zeros((2 * self.states, len(self.mesh), self.count))
        found[: self.states] = self.initial[:, None] + (self.end - self.initial)[:, None] * self.mesh
        return found

    def only(self, chosen: NDArray[np.intp]) -> Many:
        """Return the problems with the given indices."""
        if len(chosen) == self.count:
            return self
        columns: dict[str, Any] = {
            name: np.ascontiguousarray(getattr(self, name)[..., chosen])
            for name in ("initial", "end", "parameters", "lower", "upper", "radius")
        }
        mesh = self.mesh[:, chosen] if self.mesh.shape[1] > 1 else self.mesh
        return replace(self, **columns, mesh=mesh)

    def within_bounds(self) -> Many:
        """Return the problems with their bounds, integrated by NumPy, since usually only few problems reach bounds."""
        return replace(self, bounded=True, motion=motion(self.instance.model, None, False))

    @property
    def limits(self) -> Array:
        """Bounds on controls as rows in the order that generated functions expect, shape (b, M)."""
        if self.problem.control_set.kind == "ball":
            return self.radius[None]
        return np.concatenate([self.lower, self.upper])

    @property
    def given(self) -> Array:
        """Rows that integrators receive: the parameters, and the bounds if controls are limited.

        Shape (k, M) or (k + b, M).
        """
        return np.concatenate([self.parameters, self.limits]) if self.bounded else self.parameters

    def arguments(self, times: int) -> tuple[tuple[Array, ...], tuple[Any, ...]]:
        """Return parameters and bounds as arguments of generated functions, repeated for a number of times."""
        bounds = tuple(np.tile(self.limits, times)) if self.bounded else self.problem.control_set.arguments
        return tuple(np.tile(self.parameters, times)), bounds

    def at_nodes(self, nodes: slice) -> Array:
        """Return the times of some nodes, one column for each node of each instance."""
        times = self.times[nodes]
        return np.broadcast_to(times, (len(times), self.count)).ravel()

    def segments(self, z: Array) -> tuple[Array, Array, Array, Array]:
        """Return the arguments for integrating over all segments, one column for each segment of each instance.

        Parameters
        ----------
        z
            Values at the nodes, shape (2n, N+1, M).
        """
        begins, lasting, given = self._segments
        return begins, np.ascontiguousarray(z[:, :-1]).reshape(len(z), -1), lasting, given

    @cached_property
    def _segments(self) -> tuple[Array, Array, Array]:
        """Initial times and lengths of the segments, and parameters (and bounds) in each."""
        given = np.ascontiguousarray(np.tile(self.given, len(self.times) - 1))
        begins, ends = self.at_nodes(slice(None, -1)), self.at_nodes(slice(1, None))
        return begins, ends - begins, given


def _ends(instances: Sequence[Instance], parameters: Array) -> Array:
    """Return the required final states, shape (n, M)."""
    first, tf = instances[0], instances[0].tf
    assert tf is not None
    same = all(one.final is first.final for one in instances)
    stated = np.array([final_argument(one) for one in (instances[:1] if same else instances)])
    given = np.repeat(stated, len(instances), axis=0) if same else stated
    _, on_reference, target = given.reshape(len(instances), 3, -1).transpose(1, 2, 0)
    if not on_reference.any():
        return np.ascontiguousarray(target)
    curve = first.model.reference_batch(np.full(len(instances), tf), tuple(parameters))
    return np.where(on_reference > 0.0, curve, target)
