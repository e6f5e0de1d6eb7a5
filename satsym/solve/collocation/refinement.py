"""Accuracy: the error of a curve is what two more stages change; where it is too large the mesh follows the defects."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.solve.collocation.curve import Curve
from satsym.solve.collocation.newton import Outcome, newton
from satsym.solve.collocation.problem import TwoPoint
from satsym.solve.collocation.system import System

Array = NDArray[np.floating[Any]]

MORE = 2
"""Stages added for the estimate, and kept: the answer is of the higher order."""

SAFETY = 10.0
ROUNDS = 6
MOST_INTERVALS = 400
FEWEST, LARGEST_SPLIT = 0.6, 4.0
"""Bounds of the change in the density of the mesh in one round."""


@dataclass(frozen=True, eq=False)
class Refined:
    """A curve with an estimate of its error.

    Attributes
    ----------
    curve
        The answer.
    error
        Estimated error at the nodes, relative as in :meth:`Step.size`.
    converged
        Whether that is below the tolerance.
    iterations
        Newton corrections that were needed.
    """

    curve: Curve
    error: float
    converged: bool
    iterations: int


def refine(problem: TwoPoint, curve: Curve, tolerance: float, keep_nodes: bool = False) -> Refined:
    """Raise the order, and where that is not enough refine the mesh, until the error is below a tolerance.

    Parameters
    ----------
    problem
        What is solved.
    curve
        A solution of collocation equations on some mesh.
    tolerance
        Largest error.
    keep_nodes
        Whether nodes stay where they are (on kinks) and intervals are only split.
    """
    order, total, error = curve.order, 0, float("inf")
    for _ in range(ROUNDS):
        outcome = newton(System(problem, curve.mesh, order + MORE), curve.on(curve.mesh, order + MORE))
        total += outcome.iterations if outcome else 0
        if outcome and outcome.converged:
            curve, error = outcome.curve, _higher(outcome.first, order)
            if error < tolerance:
                return Refined(curve, error, True, total)
            density = _density(problem, outcome, order, tolerance)
        else:
            density = np.full(len(curve.mesh) - 1, 2.0)
        if density.sum() > MOST_INTERVALS:
            break
        curve = curve.on(_split(curve.mesh, density) if keep_nodes else _spread(curve.mesh, density), order + MORE)
    return Refined(curve, error, False, total)


def _higher(error: float, order: int) -> float:
    """The error of the higher order, from that of the lower one."""
    return float(SAFETY * error ** ((order + MORE) / order))


def _density(problem: TwoPoint, outcome: Outcome, order: int, tolerance: float) -> Array:
    """Wanted intervals for each present one, from the defects of the lower order."""
    n, nodes = problem.states, outcome.curve.nodes
    size = np.concatenate(
        [np.full(n, max(1.0, np.abs(nodes[:n]).max())), np.full(n, max(np.abs(nodes[n:]).max(), 1e-300))]
    )
    defect = (np.abs(outcome.defects) / size).max(axis=1)
    allowed = 0.3 * (tolerance / SAFETY) ** (order / (order + MORE)) * defect.max() / outcome.first
    return np.clip((defect / allowed) ** (1.0 / (2 * order + 1)), FEWEST, LARGEST_SPLIT)


def _split(mesh: Array, density: Array) -> Array:
    """Every interval in equal parts."""
    parts = np.ceil(density - 0.05).astype(int)
    inner = [a + (b - a) * np.arange(k) / k for a, b, k in zip(mesh[:-1], mesh[1:], parts, strict=True)]
    return np.concatenate([*inner, mesh[-1:]])


def _spread(mesh: Array, density: Array) -> Array:
    """The defects equally distributed over a new mesh."""
    count = max(int(np.ceil(density.sum())), len(density) + 1)
    cumulated = np.concatenate([[0.0], np.cumsum(density)]) / density.sum()
    spread = np.interp(np.linspace(0.0, 1.0, count + 1), cumulated, mesh)
    spread[0], spread[-1] = mesh[0], mesh[-1]
    return spread
