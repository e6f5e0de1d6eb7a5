"""Claims about matrices: eigenvalues, rank, row operations."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.auditing.predicates import Finding, Question, exact, predicate

_SEED = 5
_TRIES = 30
_ROUNDING = 1e-9


def _random(rng: np.random.Generator, singular: bool) -> Array:
    """A matrix of three rows; a singular one has a row that depends on the others."""
    found = rng.uniform(-2.0, 2.0, (3, 3))
    if singular:
        found[2] = found[0] - 2.0 * found[1]
    return found[rng.permutation(3)]


@predicate
def eigenvalue_definition() -> Finding:
    """Whether A x = s x, (A - s I) x = 0 and det(A - s I) = 0 single out the same numbers, on random matrices."""
    rng, agree, total = np.random.default_rng(_SEED), 0, 0
    for _ in range(_TRIES):
        a = _random(rng, singular=False)
        roots, vectors = np.linalg.eig(a)
        others = rng.uniform(-3.0, 3.0, 3)
        for number, vector in [*zip(roots, vectors.T, strict=True), *((s, None) for s in others)]:
            shifted = a - number * np.eye(3)
            vanishes = abs(np.linalg.det(shifted)) < _ROUNDING
            solved = np.linalg.svd(shifted)[1][-1] < _ROUNDING
            kept = vector is not None and bool(np.allclose(a @ vector, number * vector))
            total += 1
            agree += bool(vanishes == solved == kept)
    return Finding(
        agree == total, f"the three agree for {agree} of {total} numbers", {"numbers": total, "agree": agree}
    )


@predicate
def rank_rule() -> Finding:
    """Whether rows and columns span spaces of one dimension, which with the nullity makes the number of columns."""
    rng, agree = np.random.default_rng(_SEED), 0
    for attempt in range(_TRIES):
        a = _random(rng, singular=attempt % 2 == 0)
        by_columns, by_rows = np.linalg.matrix_rank(a), np.linalg.matrix_rank(a.T)
        nullity = int((np.linalg.svd(a)[1] < _ROUNDING).sum())
        agree += bool(by_columns == by_rows == 3 - nullity)
    return Finding(agree == _TRIES, f"so for {agree} of {_TRIES} matrices", {"matrices": _TRIES, "agree": agree})


@predicate
def rows_depend(matrix: tuple[str, ...], printed: bool) -> Finding:
    """Whether the rows of a matrix depend on one another, as is printed or denied."""
    rows = np.array([[float(entry) for entry in line.split(",")] for line in matrix])
    rank = int(np.linalg.matrix_rank(rows))
    depend = rank < len(rows)
    return Finding(depend == printed, f"{len(rows)} rows of rank {rank}", {"rows": len(rows), "rank": rank})


@predicate
def row_operations_keep_rank() -> Finding:
    """Whether the elementary row operations keep the rank, on random matrices; and whether c = 0 would."""
    rng, kept, by_zero = np.random.default_rng(_SEED), 0, 0
    for attempt in range(_TRIES):
        a = _random(rng, singular=attempt % 2 == 0)
        rank = np.linalg.matrix_rank(a)
        i, j = rng.permutation(3)[:2]
        c = float(rng.uniform(0.5, 2.0))
        exchanged, scaled, added, wiped = (a.copy() for _ in range(4))
        exchanged[[i, j]] = a[[j, i]]
        scaled[i] *= c
        added[i] += c * a[j]
        wiped[np.abs(a).sum(axis=1).argmax()] = 0.0
        kept += all(np.linalg.matrix_rank(m) == rank for m in (exchanged, scaled, added))
        by_zero += bool(rank == 3 and np.linalg.matrix_rank(wiped) == rank)
    return Finding(
        kept == _TRIES and by_zero == 0,
        f"the rank is kept in {kept} of {_TRIES} cases",
        {"matrices": _TRIES, "kept": kept, "kept by c = 0 though full": by_zero},
    )


@predicate
def row_operations(row: Question, before: tuple[str, ...], operations: tuple[str, ...]) -> Finding:
    """Whether a printed matrix is what the stated row operations make of the one printed before.

    Where it is not, but each of its rows is a multiple of one that they make, the step is one of elementary
    operations all the same: then it is right, and only not the one that is stated.

    Parameters
    ----------
    before
        The matrix before, a text for each row.
    operations
        What is said to be done, as the matrix that does it: row i of it says what the new row i is made of.
    """
    printed = exact.matrix(row.printed)
    made = exact.product(exact.matrix(operations), exact.matrix(before))
    if exact.same_entries(printed, made):
        return Finding(True, f"the operations give {exact.written(made)}")
    sources = [next((k for k, line in enumerate(made) if _multiple(new, line)), None) for new in printed]
    legal = None not in sources and len(set(sources)) == len(printed)
    scaled = [str(i) for i, (new, k) in enumerate(zip(printed, sources, strict=True), start=1) if k is not None
              and not exact.same_entries([new], [made[k]])]  # fmt: skip
    moved = [str(i) for i, k in enumerate(sources, start=1) if k != i - 1]
    unsaid = [*([f"row {' and '.join(scaled)} is multiplied as well"] if scaled else []),
              *([f"rows {' and '.join(moved)} are exchanged as well"] if moved else [])]  # fmt: skip
    return Finding(
        legal,
        f"the operations give {exact.written(made)}",
        {"given by the operations": exact.written(made), "printed": exact.written(printed)},
        sound=False,
        remark=f"{'; '.join(unsaid)}, which is not said" if legal else "",
    )


def _multiple(new: list[exact.Expression], line: list[exact.Expression]) -> bool:
    """Whether a row is another one times a factor other than zero."""
    crossed = all(
        exact.same(a * d, b * c)
        for i, (a, c) in enumerate(zip(new, line, strict=True))
        for b, d in list(zip(new, line, strict=True))[i + 1 :]
    )
    empty = [all(exact.same(entry, 0 * entry) for entry in each) for each in (new, line)]
    pattern = [[exact.same(entry, 0 * entry) for entry in each] for each in (new, line)]
    return crossed and not any(empty) and pattern[0] == pattern[1]
