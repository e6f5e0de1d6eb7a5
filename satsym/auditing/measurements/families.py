"""Families of systems over which claims quantify: textbook systems of every kind, and random members.

No member is chosen with regard to a claim, and no member contains what is claimed of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from satsym.auditing.propositions.values import Family, Record

_SEED = 20

BLOCKS: Mapping[str, list[list[str]]] = {
    "simple, negative": [["-1/2"]],
    "double with one eigenvector, negative": [["-1/2", "1"], ["0", "-1/2"]],
    "complex, negative": [["-1/2", "1"], ["-1", "-1/2"]],
    "zero": [["0"]],
    "double zero with two eigenvectors": [["0", "0"], ["0", "0"]],
    "imaginary": [["0", "1"], ["-1", "0"]],
    "double zero with one eigenvector": [["0", "1"], ["0", "0"]],
    "double imaginary with one eigenvector each": [
        ["0", "1", "1", "0"],
        ["-1", "0", "0", "1"],
        ["0", "0", "0", "1"],
        ["0", "0", "-1", "0"],
    ],
    "positive": [["1/4"]],
    "complex, positive": [["1/4", "1"], ["-1", "1/4"]],
}
"""Matrices with all kinds of eigenvalues: real or complex, simple or multiple, with all eigenvectors or fewer."""


def linear() -> Family:
    """Return a family of systems x' = A x: single blocks, and pairs of blocks after a change of basis.

    Exact matrices.
    """
    rng = np.random.default_rng(_SEED)
    names = list(BLOCKS)
    pairs = [(a, b) for i, a in enumerate(names) for b in names[i + 1 :] if len(BLOCKS[a]) + len(BLOCKS[b]) <= 4]
    members = [Record(name, {"A": _exact(BLOCKS[name])}) for name in names]
    for a, b in pairs:
        one, other = _exact(BLOCKS[a]), _exact(BLOCKS[b])
        whole = one.diag(one, other)
        basis = _basis(rng, whole.rows)
        members.append(Record(f"{a}; {b}", {"A": basis * whole * basis.inv()}))
    return Family("LINEAR", "linear systems", tuple(members))


def controlled() -> Family:
    """Return a family of systems x' = A x + B u, y = C x with two or four states.

    A quarter of the members is not controllable, and another quarter is not observable.
    """
    rng = np.random.default_rng(_SEED)
    members = []
    for k in range(24):
        n, m = (2, 1) if k % 3 == 0 else (4, 1 + k % 2)
        a = [[str(entry) for entry in row] for row in rng.integers(-2, 3, (n, n))]
        b = [[str(entry) for entry in row] for row in rng.integers(-2, 3, (n, m))]
        c = [[str(entry) for entry in row] for row in rng.integers(-2, 3, (1, n))]
        if k % 4 == 1:  # the last state moves by itself, and no input moves it
            a[-1], b[-1] = ["0"] * (n - 1) + [a[-1][-1]], ["0"] * m
        if k % 4 == 3:  # nothing shows the last state
            for row in a[:-1]:
                row[-1] = "0"
            c[0][-1] = "0"
        basis = _basis(rng, n)
        parts = {"A": basis * _exact(a) * basis.inv(), "B": basis * _exact(b), "C": _exact(c) * basis.inv()}
        inputs, outputs = [f"u{i + 1}" for i in range(m)], ["y1"]
        members.append(Record(f"system {k + 1}", {**parts, "inputs": inputs, "outputs": outputs}))
    return Family("CONTROLLED", "linear systems with inputs and outputs", tuple(members))


def symmetric() -> Family:
    """Return a family of symmetric matrices: definite, semidefinite, indefinite and zero."""
    rng = np.random.default_rng(_SEED)
    members = []
    for signs in ([1, 1], [1, 0], [1, -1], [0, 0], [-1, -1], [1], [-1], [1, 1, 1], [1, 1, 0], [1, 1, -1], [-1, -1, 0]):
        sizes = np.array(signs) * rng.uniform(0.5, 3.0, len(signs))
        basis = np.linalg.qr(rng.normal(size=(len(signs), len(signs))))[0]
        whole = basis @ np.diag(sizes) @ basis.T
        members.append(0.5 * (whole + whole.T))
    return Family("SYMMETRIC", "symmetric matrices", tuple(members))


def _exact(rows: list[list[str]]) -> Any:
    """Return a matrix of exact numbers."""
    from satsym.symbolic.lookup import formulas

    return formulas.exact_matrix(rows)


def _basis(rng: np.random.Generator, n: int) -> Any:
    """Return an integer matrix with integer inverse, as a product of shears."""
    basis = np.eye(n, dtype=int)
    for _ in range(n):
        i, j = rng.choice(n, 2, replace=False)
        shear = np.eye(n, dtype=int)
        shear[i, j] = rng.choice([-1, 1])
        basis = basis @ shear
    return _exact([[str(entry) for entry in row] for row in basis])
