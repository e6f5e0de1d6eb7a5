"""Polynomials with roots on the axis, by construction; regulators of extreme scales, against fifty digits."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from satsym.analysis.linear.routh import routh
from satsym.analysis.linear.spectrum import (
    ASYMPTOTIC,
    MARGINAL,
    UNSTABLE,
    characteristic,
    companion_matrix,
    spectrum,
    stability,
)
from satsym.analysis.linear.system import system
from satsym.analysis.regulator import many
from satsym.analysis.regulator.lqr import lqr
from satsym.status import BadInput

KINDS = ("simple pairs", "a double pair", "a zero", "two zeros", "three zeros", "a pair next to the axis", "mirrored")


def constructed(kind: str, seed: int) -> np.ndarray:
    """Roots: some on the axis, others at least a fifth away from it."""
    rng = np.random.default_rng(seed)

    def pair(real: float) -> list[complex]:
        w = rng.uniform(0.3, 3.0)
        return [complex(real, w), complex(real, -w)]

    on_axis = pair(0.0)
    roots = {
        "simple pairs": on_axis + pair(0.0),
        "a double pair": on_axis * 2,
        "a zero": [*on_axis, 0.0],
        "two zeros": [*on_axis, 0.0, 0.0],
        "three zeros": [0.0, 0.0, 0.0],
        "a pair next to the axis": pair(rng.choice((-1e-9, 1e-9))),
        "mirrored": [*on_axis, *pair(s := rng.uniform(0.2, 2.0)), -s, s],
    }[kind]
    for _ in range(rng.integers(0, 4)):
        real = rng.choice((-1.0, -1.0, 1.0)) * rng.uniform(0.2, 3.0)
        roots += pair(real) if rng.random() < 0.5 else [real]
    return np.array(roots)


def rate(seed: int) -> float:
    """Of some unit of time."""
    return 10.0 ** (4 * (seed % 3 - 1))


@pytest.mark.parametrize("kind", KINDS)
def test_the_routh_array_and_the_spectrum_both_count_what_was_constructed(kind: str):
    for seed in range(60):
        roots = constructed(kind, seed) * rate(seed)
        right, on_axis = int((roots.real > 0.0).sum()), int((roots.real == 0.0).sum())
        coefficients = np.poly(roots).real
        array = routh(coefficients.tolist())
        assert (array.sign_changes, array.on_axis) == (right, on_axis), seed
        assert len(array.rows) == len(coefficients)
        assert np.isfinite(np.array(array.rows)).all()
        values = spectrum(companion_matrix(coefficients))
        assert sum(e.algebraic for e in values if e.value.real > 0.0) == right, seed
        assert sum(e.algebraic for e in values if e.value.real == 0.0) == on_axis, seed


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_verdict_spectrum_and_routh_array_of_a_matrix_never_contradict_each_other(kind: str):
    """Also in coordinates in which nothing is zero any more."""
    for seed in range(60):
        coefficients = np.poly(constructed(kind, seed)).real
        turned = np.linalg.qr(np.random.default_rng(seed).normal(size=2 * (len(coefficients) - 1,)))[0]
        matrix = turned @ companion_matrix(coefficients) @ turned.T * rate(seed)
        values = spectrum(matrix)
        listed = [e.value for e in values for _ in range(e.algebraic)]
        array, verdict = routh(characteristic(matrix).tolist(), listed), stability(values).verdict
        assert array.sign_changes == sum(v.real > 0.0 for v in listed)
        assert array.on_axis == sum(v.real == 0.0 for v in listed)
        expected = {ASYMPTOTIC} if not array.sign_changes + array.on_axis else {MARGINAL, UNSTABLE}
        assert verdict in ({UNSTABLE} if array.sign_changes else expected)


def extreme(seed: int, weights_in_new_units: bool) -> tuple[np.ndarray, ...]:
    """Q by 1e+-6, R by 1e+-4, states in units of 1e+-4."""
    rng = np.random.default_rng(seed)
    n, m = int(rng.integers(2, 6)), int(rng.integers(1, 3))
    A, B, root, other = (rng.normal(size=shape) for shape in ((n, n), (n, m), (n, n), (m, m)))
    Q = root @ root.T * 10.0 ** rng.uniform(-6, 6)
    R = (other @ other.T + 0.1 * np.eye(m)) * 10.0 ** rng.uniform(-4, 4)
    unit = 10.0 ** rng.uniform(-4, 4, n)
    Q = Q * np.outer(unit, unit) if weights_in_new_units else Q
    return A * unit / unit[:, None], B / unit[:, None], 0.5 * (Q + Q.T), R


def exact(A: np.ndarray, B: np.ndarray, Q: np.ndarray, R: np.ndarray) -> mp.matrix:
    """P by the decaying eigenvectors of the Hamiltonian matrix, with 50 digits."""
    n = len(A)
    a, b, q, r = (mp.matrix(each.tolist()) for each in (A, B, Q, R))
    g, h = b * mp.inverse(r) * b.T, mp.zeros(2 * n)
    for i in range(n):
        for j in range(n):
            h[i, j], h[i, n + j], h[n + i, j], h[n + i, n + j] = a[i, j], -g[i, j], -q[i, j], -a[j, i]
    values, vectors = mp.eig(h)
    decaying = [k for k in range(2 * n) if mp.re(values[k]) < 0]
    assert len(decaying) == n
    x, y = (mp.matrix(n, n) for _ in range(2))
    for column, k in enumerate(decaying):
        for i in range(n):
            x[i, column], y[i, column] = vectors[i, k], vectors[n + i, k]
    return (y * mp.inverse(x)).apply(mp.re)


def error(P: np.ndarray, truth: mp.matrix) -> float:
    """In units in which the diagonal elements of the truth are 1."""
    unit = [mp.sqrt(truth[i, i]) for i in range(len(P))]
    pairs = [(i, j) for i in range(len(P)) for j in range(len(P))]
    off = [(mp.mpf(float(P[i, j])) - truth[i, j]) / (unit[i] * unit[j]) for i, j in pairs]
    return float(mp.norm(off) / mp.norm([truth[i, j] / (unit[i] * unit[j]) for i, j in pairs]))


# of the second kind those first on which accuracy was lost or an answer refused
CASES = [(True, seed) for seed in range(6)] + [(False, seed) for seed in (26, 61, 90, 167, 169, 171, 254, 263, 281)]


@pytest.mark.slow
@pytest.mark.parametrize(("weights_in_new_units", "seed"), CASES)
def test_extreme_regulators_are_right_to_the_last_digits_and_say_so(weights_in_new_units: bool, seed: int):
    A, B, Q, R = extreme(seed, weights_in_new_units)
    found = lqr(system(A, B), Q, R)
    with mp.workdps(50):
        wrong = error(found.P, exact(A, B, Q, R))
    assert wrong < 1e-12
    assert found.error is not None
    assert wrong < 30.0 * found.error
    assert found.routh.sign_changes == found.routh.on_axis == 0


def test_no_extreme_regulator_is_refused():
    """All of these have an answer: every mode is moved and weighed."""
    refused = []
    for seed in range(150):
        for kind in (True, False):
            A, B, Q, R = extreme(seed, kind)
            try:
                found = lqr(system(A, B), Q, R)
            except BadInput:
                refused.append((seed, kind))
                continue
            assert found.error is not None
            assert found.error < 1e-11
            assert found.eigenvalues.real.max() < 0.0
    assert not refused


def test_extreme_regulators_in_a_batch_are_those_one_by_one():
    for seed in (26, 61, 171):
        A, B, Q, R = extreme(seed, weights_in_new_units=False)
        _, P, _ = many.solve(A[None], B, Q, R)
        assert np.allclose(P[0], lqr(system(A, B), Q, R).P, rtol=1e-9, atol=0.0)
