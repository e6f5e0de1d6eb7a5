"""The rules that documents quote for linear systems, tried on systems whose behaviour is found in another way."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache

import numpy as np

from satsym.arrays import Array
from satsym.auditing.predicates import Finding, predicate
from satsym.auditing.predicates.linear import analysis, numeric
from satsym.status import BadInput
from satsym.wording import shown

_SEED = 20
_TRIES = 40
_ROUNDING = 1e-12
_LATE = 40.0
"""From here on motions are compared: what grows like t doubles until twice this time, what is bounded does not."""
_MOMENTS = 16
"""How often they are looked at before and after; what turns is not always at its largest."""

BLOCKS: Mapping[str, tuple[list[list[float]], str]] = {
    "simple, negative": ([[-0.5]], "decays"),
    "double with one eigenvector, negative": ([[-0.5, 1.0], [0.0, -0.5]], "decays"),
    "complex, negative": ([[-0.5, 1.3], [-1.3, -0.5]], "decays"),
    "zero": ([[0.0]], "stays"),
    "double zero with two eigenvectors": ([[0.0, 0.0], [0.0, 0.0]], "stays"),
    "imaginary": ([[0.0, 1.3], [-1.3, 0.0]], "stays"),
    "double zero with one eigenvector": ([[0.0, 1.0], [0.0, 0.0]], "grows"),
    "double imaginary with one eigenvector each": (
        [[0.0, 1.3, 1.0, 0.0], [-1.3, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.3], [0.0, 0.0, -1.3, 0.0]],
        "grows",
    ),
    "positive": ([[0.2]], "grows"),
}
"""Blocks by their eigenvalues, each with what the rule says of them."""


@predicate
def eigenvalue_rule() -> Finding:
    """Whether real parts, and multiplicities on the axis, decide as the rule says: against e^(At) itself.

    All pairs of blocks are put together, mixed by a random change of basis, and followed for a while.
    """
    agree, total = _agreeing_pairs()
    return Finding(
        agree == total,
        f"the rule and e^(At) agree in {agree} of {total} systems",
        {"systems": total, "agree": agree},
    )


@cache
def _agreeing_pairs() -> tuple[int, int]:
    """In how many systems rule and motion agree, and how many there are."""
    rng = np.random.default_rng(_SEED)
    order = ("decays", "stays", "grows")
    agree = total = 0
    for first, said in BLOCKS.values():
        for second, said_too in BLOCKS.values():
            a, b = np.array(first), np.array(second)
            whole = np.zeros((len(a) + len(b),) * 2)
            whole[: len(a), : len(a)], whole[len(a) :, len(a) :] = a, b
            basis = np.linalg.qr(rng.normal(size=whole.shape))[0] @ np.diag(rng.uniform(0.5, 2.0, len(whole)))
            early, late = _sizes(basis @ whole @ np.linalg.inv(basis))
            seen = "decays" if late < 1e-3 else "grows" if late > 1.5 * early else "stays"
            total += 1
            agree += seen == max(said, said_too, key=order.index)
    return agree, total


@predicate
def kalman_rule(kind: str) -> Finding:
    """Whether full rank of Kalman's matrix goes with a Gramian that is positive definite, on random systems.

    Half of the systems have a part that no input reaches (no output shows), hidden by a change of basis.
    x' = A'x, y = B'x is observable exactly if x' = Ax + Bu is controllable, and has the same Gramian.
    """
    if kind not in ("controllability", "observability"):
        raise BadInput(f"kalman_rule: no {shown(kind)}; write controllability or observability")
    agree, full = _agreeing_ranks()
    return Finding(
        agree == _TRIES,
        f"rank and Gramian agree in {agree} of {_TRIES} systems",
        {"systems": _TRIES, "agree": agree, "of full rank": full},
    )


@cache
def _agreeing_ranks() -> tuple[int, int]:
    """In how many systems rank and Gramian agree, and how many have full rank."""
    rng = np.random.default_rng(_SEED)
    agree = full = 0
    for attempt in range(_TRIES):
        a, b = _system(rng, hidden=attempt % 2 == 1)
        columns = [b]
        for _ in range(len(a) - 1):
            columns.append(a @ columns[-1])
        reaches = np.linalg.matrix_rank(np.hstack(columns), tol=1e-7) == len(a)
        values = np.linalg.eigvalsh(_gramian(a, b))
        full += bool(reaches)
        agree += bool(reaches == (values[0] > 1e-10 * values[-1]))
    return agree, full


@predicate
def linear_form(model: str) -> Finding:
    """Whether the equations of a model are x' = A x + B u with constant matrices: at random states and controls."""
    from satsym.symbolic.lookup.library import derivation

    found, equations = analysis(model).system, derivation(model).step("first_order").equations
    rng, error = np.random.default_rng(_SEED), 0.0
    for _ in range(_TRIES):
        names = {s.name for e in equations for s in e.rhs.free_symbols} | {*found.states, *found.inputs}
        values = dict(zip(sorted(names), rng.uniform(0.5, 2.0, len(names)), strict=True))
        x, u = (np.array([values[name] for name in group]) for group in (found.states, found.inputs))
        linear = numeric(found.a, values) @ x + numeric(found.b, values) @ u
        rates = [float(e.rhs.xreplace({s: values[s.name] for s in e.rhs.free_symbols})) for e in equations]
        error = max(error, float(np.abs(linear - rates).max()))
    return Finding(
        error < _ROUNDING,
        f"the rates of {model} and A x + B u differ by {error:.0e} at most",
        {"points": _TRIES, "largest difference": error},
        f"satsym analyse {model}",
    )


def _sizes(matrix: Array) -> tuple[float, float]:
    """The largest norms of e^(At) seen for a while, from a time on, and from twice that time on."""
    from scipy.linalg import expm

    start, step = expm(_LATE * matrix), expm(2.0 * math.pi / _MOMENTS * matrix)
    sizes = []
    for moved in (start, start @ start):
        largest = 0.0
        for _ in range(_MOMENTS):
            largest, moved = max(largest, float(np.linalg.norm(moved))), moved @ step
        sizes.append(largest)
    return sizes[0], sizes[1]


def _system(rng: np.random.Generator, hidden: bool) -> tuple[Array, Array]:
    """A stable system with four states and one input; its last state is out of reach if something is to be hidden."""
    a = np.tril(rng.normal(size=(4, 4)), -1) + np.diag(-rng.uniform(0.2, 1.0, 4))
    b = np.zeros((4, 1))
    b[:2, 0] = rng.uniform(0.5, 1.0, 2)
    if hidden:
        a[3, :3] = 0.0
    basis = np.linalg.qr(rng.normal(size=(4, 4)))[0]
    return basis @ a @ basis.T, basis @ b


def _gramian(a: Array, b: Array, tf: float = 5.0, steps: int = 400) -> Array:
    """The integral of e^(At) B B' e^(A't) over [0, tf], by Simpson's rule."""
    from scipy.linalg import expm

    advance = expm(tf / steps * a)
    column, total = b, np.zeros_like(a)
    for i in range(steps + 1):
        weight = 1.0 if i in (0, steps) else 4.0 if i % 2 else 2.0
        total = total + weight * (column @ column.T)
        column = advance @ column
    return total * tf / steps / 3.0
