"""Instances of one problem that differ in initial states, ends and parameters, as columns."""

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
"""Segments for each interval that the motion's fastest mode asks for, while steps are of low order."""


@dataclass(frozen=True, eq=False)
class Many:
    """M instances whose ends and times are given."""

    problem: TwoPoint
    """The instance that they vary as a two-point problem: scales, times and what else all share."""
    motion: Motion
    """Steps of the canonical equations."""
    initial: Array
    end: Array
    """States where the motions begin and end, shape (n, M)."""
    parameters: Array
    """Shape (k, M)."""
    mesh: Array
    """Nodes in [0, 1], shape (N+1, M), or (N+1, 1) where they are the same for all."""
    condense: Condensing
    """How nodes follow from the first one."""
    lower: Array
    upper: Array
    radius: Array
    """Bounds on controls, shapes (m, M), and on their norm, shape (M,), by which solutions are judged."""
    bounded: bool = False
    """Whether controls are held within them; otherwise all are solved as if there were none."""

    @classmethod
    def of(cls, instance: Instance, instances: Sequence[Instance], compiled: bool) -> Many:
        """Variations of an instance."""
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
        """The one that is varied."""
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
        """The straight line between the ends without costates, at the nodes, shape (2n, N+1, M)."""
        found = np.zeros((2 * self.states, len(self.mesh), self.count))
        found[: self.states] = self.initial[:, None] + (self.end - self.initial)[:, None] * self.mesh
        return found

    def only(self, chosen: NDArray[np.intp]) -> Many:
        """Some of the problems."""
        if len(chosen) == self.count:
            return self
        columns: dict[str, Any] = {
            name: np.ascontiguousarray(getattr(self, name)[..., chosen])
            for name in ("initial", "end", "parameters", "lower", "upper", "radius")
        }
        mesh = self.mesh[:, chosen] if self.mesh.shape[1] > 1 else self.mesh
        return replace(self, **columns, mesh=mesh)

    def within_bounds(self) -> Many:
        """The instances with their bounds, on arrays: few meet them as a rule."""
        return replace(self, bounded=True, motion=motion(self.instance.model, None, False))

    @property
    def limits(self) -> Array:
        """What generated functions have as bounds, shape (b, M)."""
        if self.problem.control_set.kind == "ball":
            return self.radius[None]
        return np.concatenate([self.lower, self.upper])

    @property
    def given(self) -> Array:
        """Parameters, and bounds where there are any: what motions take, shape (k, M) or (k + b, M)."""
        return np.concatenate([self.parameters, self.limits]) if self.bounded else self.parameters

    def arguments(self, times: int) -> tuple[tuple[Array, ...], tuple[Any, ...]]:
        """Parameters and bounds of generated functions, so many times one after the other."""
        bounds = tuple(np.tile(self.limits, times)) if self.bounded else self.problem.control_set.arguments
        return tuple(np.tile(self.parameters, times)), bounds

    def at_nodes(self, nodes: slice) -> Array:
        """Times of nodes, a column for each of each instance."""
        times = self.times[nodes]
        return np.broadcast_to(times, (len(times), self.count)).ravel()

    def segments(self, z: Array) -> tuple[Array, Array, Array, Array]:
        """Arguments of steps over all segments, a column for each of each instance.

        Parameters
        ----------
        z
            Nodes, shape (2n, N+1, M).
        """
        begins, lasting, given = self._segments
        return begins, np.ascontiguousarray(z[:, :-1]).reshape(len(z), -1), lasting, given

    @cached_property
    def _segments(self) -> tuple[Array, Array, Array]:
        """When they begin, how long they last, and what is given in each."""
        given = np.ascontiguousarray(np.tile(self.given, len(self.times) - 1))
        begins, ends = self.at_nodes(slice(None, -1)), self.at_nodes(slice(1, None))
        return begins, ends - begins, given


def _ends(instances: Sequence[Instance], parameters: Array) -> Array:
    """Where motions should end, shape (n, M)."""
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
