"""Long integrations in blocks of steps, between which the time limit is checked.

The results of generated loops do not depend on the blocks, except for the order in which the running cost is added.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from satsym.arrays import Array
from satsym.kernels import Kernels
from satsym.solvers.iteration import BLOCK, Limits

Row = Sequence[float]


def forward(
    model: Kernels, nodes: Array, x0: Row, u: Array, u_mid: Array, p: Row, limits: Limits | None
) -> tuple[Array, Array, float]:
    """Return the result of :meth:`satsym.kernels.core.Kernels.forward`, computed in blocks.

    Raises
    ------
    TimeUp
        If the time limit is exceeded between two blocks.
    """
    steps, start, total = len(nodes) - 1, x0, 0.0
    if steps <= BLOCK or limits is None:
        return model.forward(nodes, x0, u, u_mid, p)
    x, x_mid = np.empty((len(x0), steps + 1)), np.empty((len(x0), steps))
    for first in range(0, steps, BLOCK):
        if first:
            limits.check()
        last = min(first + BLOCK, steps)
        own = slice(first, last + 1)
        x[:, own], x_mid[:, first:last], cost = model.forward(nodes[own], start, u[:, own], u_mid[:, first:last], p)
        start, total = tuple(x[:, last].tolist()), total + cost
    return x, x_mid, total


def backward(
    model: Kernels,
    nodes: Array,
    lam_f: Row,
    motion: tuple[Array, Array],
    control: tuple[Array, Array],
    p: Row,
    limits: Limits | None,
) -> tuple[Array, Array]:
    """Return the result of :meth:`satsym.kernels.core.Kernels.backward`, computed in blocks.

    Motion and control are given at nodes and midpoints.

    Raises
    ------
    TimeUp
        If the time limit is exceeded between two blocks.
    """
    (x, x_mid), (u, u_mid), steps, end = motion, control, len(nodes) - 1, lam_f
    if steps <= BLOCK or limits is None:
        return model.backward(nodes, lam_f, x, x_mid, u, u_mid, p)
    lam, lam_mid = np.empty((len(lam_f), steps + 1)), np.empty((len(lam_f), steps))
    for last in range(steps, 0, -BLOCK):
        if last < steps:
            limits.check()
        first = max(last - BLOCK, 0)
        own, between = slice(first, last + 1), slice(first, last)
        lam[:, own], lam_mid[:, between] = model.backward(
            nodes[own], end, x[:, own], x_mid[:, between], u[:, own], u_mid[:, between], p
        )
        end = tuple(lam[:, first].tolist())
    return lam, lam_mid
