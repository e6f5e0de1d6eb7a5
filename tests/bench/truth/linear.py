"""Linear motions: exact discretisation, and what constraints of the end say about the control."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from tests.bench.truth.case import Case
from tests.bench.truth.physics import MODELS


@dataclass(frozen=True, eq=False)
class Linear:
    """x' = A x + B u, with rows C x(tf) = goal.

    Attributes
    ----------
    A, B
        Of the motion.
    C, goal
        Of the end.
    x0, low, high, radius
        Start and control set; infinite where there is no bound.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    goal: np.ndarray
    x0: np.ndarray
    low: np.ndarray
    high: np.ndarray
    radius: float

    def gap(self, duration: float) -> np.ndarray:
        """What the control has to bring about."""
        return np.asarray(self.goal - self.C @ expm(self.A * duration) @ self.x0)

    def effect(self, duration: float, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Effects C exp(A (tf - t)) B on the end at midpoints of equal steps, shape (count, rows, m), and times."""
        h = duration / count
        step = expm(self.A * h)
        effects = np.empty((count, len(self.C), self.B.shape[1]))
        now = self.C @ expm(self.A * h / 2.0)
        for k in range(count - 1, -1, -1):
            effects[k] = now @ self.B
            now = now @ step
        return effects, (np.arange(count) + 0.5) * h

    def steps(self, nodes: np.ndarray) -> np.ndarray:
        """Effects of controls that are constant between nodes (from 0 to the duration): shape (rows, steps, m)."""
        n, m = self.B.shape
        block = np.zeros((n + m, n + m))
        block[:n, :n], block[:n, n:] = self.A, self.B
        widths = np.diff(nodes)
        different, which = np.unique(np.round(widths, 14), return_inverse=True)
        exact = [expm(block * h) for h in different]
        effects, after = np.empty((len(widths), len(self.C), m)), self.C
        for k in range(len(widths) - 1, -1, -1):
            step = exact[which[k]]
            effects[k] = after @ step[:n, n:]
            after = after @ step[:n, :n]
        return effects.transpose(1, 0, 2)


def linear(case: Case) -> Linear:
    """The linear motion of a case, with the final states it gives."""
    physics = MODELS[case.model]
    p = physics.given(case.parameters)
    A, B = physics.matrices(p)
    rows = [i for i, name in enumerate(physics.states) if name in case.final]
    C, goal = np.eye(len(A))[rows], np.array([float(case.final[physics.states[i]]) for i in rows])
    if case.model.startswith("end_on_line"):
        C, goal = np.array([[-p[0], 1.0]]), np.array([p[1]])
    pairs = np.array([case.bounds.get(name, (-np.inf, np.inf)) for name in physics.controls])
    x0 = np.array([case.initial[name] for name in physics.states])
    return Linear(A, B, C, goal, x0, pairs[:, 0], pairs[:, 1], np.inf if case.max_norm is None else case.max_norm)
