"""Phases and the form at the end against the eigenvalues of the second variation itself, on random linear problems."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import block_diag, expm

from satsym.solvers.certificate.end_form import EndForm
from satsym.solvers.certificate.jacobi import Phases, followed, second_order_at_end
from satsym.solvers.certificate.reintegration.segments import balanced

Array = NDArray[np.floating[Any]]
PIECES, STEPS = 80, 200
UNDECIDED = 0.02
"""Eigenvalues closer to zero than this are not told from zero on so few pieces."""


@dataclass(frozen=True, eq=False)
class Problem:
    """x' = A x + B u with cost (x'Q x + 2 x'N u + u'R u + x_f'S x_f)/2 and C x_f = 0; some controls rest on bounds."""

    a: Array
    b: Array
    q: Array
    mixed: Array
    r: Array
    s: Array
    c: Array
    edges: Array
    free: tuple[NDArray[np.bool_], ...]

    def pieces(self, count: int) -> list[tuple[float, int, NDArray[np.bool_]]]:
        """For each interval of one set of active bounds: how long and how many its pieces are, and what is free."""
        widths = np.diff(self.edges)
        counts = np.ceil(count * widths / self.edges[-1]).astype(int)
        return [(w / k, int(k), free) for w, k, free in zip(widths, counts, self.free, strict=True)]


def drawn(seed: int) -> Problem:
    """One to three states; equal axes, directions out of reach, bounds met and ends of all kinds among them."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 4))
    m = int(rng.integers(1, n + 1))
    a, b, mixed = rng.standard_normal((n, n)), rng.standard_normal((n, m)), rng.standard_normal((n, m)) / 2.0
    q = rng.standard_normal((n, n))
    q = (q + q.T) * rng.uniform(0.2, 4.0) - np.eye(n) * rng.uniform(0.0, 3.0)
    if rng.random() < 0.3:
        a, b, mixed, m = np.zeros((n, n)), np.eye(n), np.zeros((n, n)), n
        q = -np.eye(n) * rng.uniform(0.5, 9.0)
    if n > 1 and rng.random() < 0.2:
        a[0, 1:], b[0] = 0.0, 0.0
    tf, count = rng.uniform(0.5, 3.0), int(rng.integers(1, 4))
    edges = np.concatenate([[0.0], np.sort(rng.uniform(0.0, tf, count - 1)), [tf]])
    free = tuple(np.ones(m, bool) if rng.random() < 0.6 else rng.random(m) < 0.6 for _ in range(count))
    s = rng.standard_normal((n, n))
    ends = (np.eye(n), np.zeros((0, n)), rng.standard_normal((int(rng.integers(1, n + 1)), n)))
    c = ends[int(rng.integers(3))]
    return Problem(a, b, q, mixed, np.eye(m) * rng.uniform(0.5, 2.0), (s + s.T) * rng.uniform(0.0, 2.0), c, edges, free)


def eigenvalues(problem: Problem) -> Array:
    """Of the second variation on controls that are constant on pieces, the end kept; exact on each (Van Loan)."""
    pieces = problem.pieces(PIECES)
    n, total = len(problem.a), sum(k * int(free.sum()) for _, k, free in pieces)
    states, form, done = np.zeros((n, total)), np.zeros((total, total)), 0
    for width, repeated, free in pieces:
        count = int(free.sum())
        motion = block_diag(problem.a, np.zeros((count, count)))
        motion[:n, n:] = problem.b[:, free]
        cost = block_diag(problem.q, problem.r[np.ix_(free, free)])
        cost[:n, n:] = problem.mixed[:, free]
        cost[n:, :n] = cost[:n, n:].T
        flow = expm(np.block([[-motion.T, cost], [np.zeros_like(motion), motion]]) * width)
        step = flow[len(motion) :, len(motion) :]
        weight = step.T @ flow[: len(motion), len(motion) :]
        for _ in range(repeated):
            own = np.zeros((count, total))
            own[:, done : done + count] = np.eye(count) / np.sqrt(width)
            both = np.concatenate([states, own])
            form += both.T @ weight @ both
            states, done = (step @ both)[:n], done + count
    form += states.T @ problem.s @ states
    ties = problem.c @ states
    if ties.size:
        _, values, rows = np.linalg.svd(ties)
        within = rows[int((values > 1e-9 * max(values.max(), 1e-300)).sum()) :].T
        form = within.T @ form @ within
    return np.linalg.eigvalsh((form + form.T) / 2.0)


def judged(problem: Problem, unit: Array) -> tuple[Phases, float]:
    """Phases and the least curvature at the end, of states given in other units."""
    slopes = []
    for free in problem.free:
        inverse = np.zeros_like(problem.r)
        inverse[np.ix_(free, free)] = np.linalg.inv(problem.r[np.ix_(free, free)])
        motion = problem.a - problem.b @ inverse @ problem.mixed.T
        restoring = problem.q - problem.mixed @ inverse @ problem.mixed.T
        both = np.block([[motion, -problem.b @ inverse @ problem.b.T], [-restoring, -motion.T]])
        change = np.concatenate([unit, 1.0 / unit])
        slopes.append(both * change[:, None] / change)
    tf, n = float(problem.edges[-1]), len(problem.a)
    scale = balanced(np.ones(2 * n), np.abs(slopes).max(axis=0), tf)
    scaled = np.array(slopes) * (scale / scale[:, None])
    turning = 2.0 * np.sqrt(n) * np.linalg.norm(scaled, axis=(1, 2)).max() * tf
    pieces = problem.pieces(max(STEPS, int(turning)))
    matrices = [np.repeat(expm(slope * w)[None], k, axis=0) for slope, (w, k, _) in zip(scaled, pieces, strict=True)]
    phases = followed(np.concatenate(matrices))
    assert phases is not None
    into = np.diag(scale[:n] / unit)
    form, ties = into @ problem.s @ into / (scale[0] * scale[n]), problem.c @ into
    sizes = np.abs(ties).max(axis=1, initial=0.0)
    return phases, second_order_at_end(phases.frames[-1], EndForm(form, ties / sizes[:, None], sizes))


@pytest.mark.parametrize("first", range(0, 40, 10))
def test_phases_and_end_agree_with_the_second_variation_itself(first: int) -> None:
    decided = {True: 0, False: 0}
    for seed in range(first, first + 10):
        problem = drawn(seed)
        values = eigenvalues(problem)
        if np.abs(values).min(initial=np.inf) < UNDECIDED:
            continue
        unit = 10.0 ** np.random.default_rng(seed).uniform(-1.0, 1.0, len(problem.a))
        phases, curvature = judged(problem, unit)
        passed, minimum = int(phases.passed[-1]), bool((values > 0.0).all())
        assert (passed == 0 and curvature > 0.0) is minimum, seed
        if len(problem.c) == len(problem.a):
            assert passed == int((values < 0.0).sum()), seed
        decided[minimum] += 1
    assert min(decided.values()) > 1
