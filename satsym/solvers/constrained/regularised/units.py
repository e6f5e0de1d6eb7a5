"""What unknowns of the program are measured by, so that nothing depends on the units in which a model is stated."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.constrained.regularised.slopes import Slopes, rooms
from satsym.solvers.constrained.regularised.transcription import Point, Program, Step, middles


@dataclass(frozen=True, eq=False)
class Units:
    """Of states (n,), controls (m,), the duration, conditions at the end, and constraints (h, 1)."""

    x: Array
    u: Array
    duration: float
    ends: Array
    g: Array

    @classmethod
    def of(cls, program: Program, at: Point) -> Units:
        """By the sizes that a path has."""
        unit = two_point(program.instance, at.duration).scale.state
        state = np.maximum(np.abs(at.x).max(axis=1), unit)
        reach = np.maximum(np.abs(at.u).max(axis=1, initial=0.0), control_unit(program, at, unit))
        ends = np.append(state[program.given], np.ones(len(at.v) - len(program.given)))
        return cls(state, np.where(reach > 0.0, reach, 1.0), at.duration, ends, rooms(program, at))

    def scaled(self, slopes: Slopes, own: float) -> tuple[Slopes, float]:
        """Derivatives by what is measured in these units, of conditions in these; and the second by the duration."""
        x, u, d, both = self.x, self.u, self.duration, np.append(self.x, self.u)
        timed = slopes.timed and replace(
            slopes.timed,
            state=slopes.timed.state * x[:, None] * d,
            control=slopes.timed.control * u[:, None] * d,
            nodes=slopes.timed.nodes * x[:, None] * d,
            gaps=slopes.timed.gaps * d / x[:, None],
            ends=slopes.timed.ends * d / self.ends,
            constraints=slopes.timed.constraints * d,
        )
        found = replace(
            slopes,
            between=slopes.between * np.outer(both, both),
            nodes=slopes.nodes * np.outer(x, x),
            a=slopes.a * x / x[:, None],
            b=slopes.b * u / x[:, None],
            ends=slopes.ends * x / self.ends[:, None],
            timed=timed,
        )
        return found, own * d * d

    def converted(self, of: Step) -> Step:
        """A step from these units to those of the model, or a gradient and its conditions from those to these."""
        x, u = self.x[:, None], self.u[:, None]
        return Step(of.x * x, of.u * u, of.duration * self.duration, of.y / x, of.v / self.ends)


def control_unit(program: Program, about: Point, unit: Array) -> Array:
    """Of each control, shape (m,): what moves a state by its unit while the motion lasts."""
    n, m = len(about.x), len(about.u)
    t, x = program.times(about.duration, middle=True), middles(about.x)
    found = np.abs(np.asarray(program.instance.model.jacobian_u_batch(t, x, about.u, program.p)).reshape(n, m, -1))
    strength = (found.max(axis=2) / unit[:, None]).max(axis=0) * about.duration
    return np.where(strength > 0.0, 1.0 / np.maximum(strength, 1e-300), 0.0)
