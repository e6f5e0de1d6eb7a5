"""Claims about solutions of linear systems and the exponential of a matrix."""

from __future__ import annotations

from collections.abc import Sequence
from math import factorial

import numpy as np
from numpy.typing import ArrayLike

from satsym.arrays import Array
from satsym.auditing.predicates import Finding, Question, exact, predicate
from satsym.auditing.predicates.linear import analysis, numeric
from satsym.status import BadInput
from satsym.wording import shown

_SEED = 7
_TRIES = 20
_EQUAL = 1e-8


def expm(matrix: Array) -> Array:
    """The exponential of a matrix, by scipy."""
    from scipy import linalg

    return np.asarray(linalg.expm(matrix), dtype=float)


def well_conditioned(rng: np.random.Generator, n: int) -> Array:
    """A random basis."""
    return np.asarray(np.linalg.qr(rng.normal(size=(n, n)))[0] @ np.diag(rng.uniform(0.5, 2.0, n)))


@predicate
def solves_system(model: str) -> Finding:
    """Whether e^(At) x0 starts at x0 and moves at the rate A e^(At) x0: by differences, for a linear model."""
    a, rng, worst, h = numeric(analysis(model).system.a, {}), np.random.default_rng(_SEED), 0.0, 1e-5
    for _ in range(_TRIES):
        x0, t = rng.uniform(-1.0, 1.0, len(a)), float(rng.uniform(0.0, 1.0))
        slope = (expm((t + h) * a) @ x0 - expm((t - h) * a) @ x0) / (2.0 * h)
        x = expm(t * a) @ x0
        worst = max(worst, float(np.abs(slope - a @ x).max() / max(1.0, np.abs(x).max())))
        worst = max(worst, float(np.abs(expm(0.0 * a) @ x0 - x0).max()))
    return Finding(worst < 1e-6, f"its rate is A x, but for {worst:.0e}", {"largest difference": worst})


@predicate
def exponential_of(row: Question, system: tuple[str, ...]) -> Finding:
    """Whether a printed matrix is e^(At), exactly."""
    from satsym.symbolic.analysis import analyse
    from satsym.symbolic.analysis.system import linear_system

    found = analyse(linear_system(exact.matrix(system))).exponential
    if found is None:
        raise BadInput("exponential_of: no closed form is found for this matrix")
    derived = [[found[i, j] for j in range(found.cols)] for i in range(found.rows)]
    return Finding(exact.same_entries(exact.matrix(row.printed), derived), exact.written(derived))


@predicate
def equilibria_are_zeros() -> Finding:
    """Whether motions that start where the rates vanish stay there, and others do not: on random linear systems."""
    rng, agree = np.random.default_rng(_SEED), 0
    for _ in range(_TRIES):
        basis = well_conditioned(rng, 3)
        a = basis @ np.diag([0.0, -1.0, 0.5]) @ np.linalg.inv(basis)
        rest, other = basis[:, 0], basis @ rng.uniform(0.5, 1.0, 3)
        stays = [bool(np.allclose(expm(t * a) @ rest, rest)) for t in (0.3, 2.0)]
        moves = bool(np.abs(expm(2.0 * a) @ other - other).max() > 1e-3)
        agree += all(stays) and moves
    return Finding(agree == _TRIES, f"so in {agree} of {_TRIES} systems", {"systems": _TRIES, "agree": agree})


@predicate
def exponential_series() -> Finding:
    """Whether the partial sums of the series tend to e^(At), which is found by scaling and squaring."""
    rng, worst = np.random.default_rng(_SEED), 0.0
    for _ in range(_TRIES):
        at = rng.uniform(-1.0, 1.0, (3, 3))
        total = sum(np.linalg.matrix_power(at, n) / factorial(n) for n in range(1, 30)) + np.eye(3)
        worst = max(worst, float(np.abs(total - expm(at)).max()))
    return Finding(worst < 1e-12, f"29 terms and e^(At) differ by {worst:.0e}", {"largest difference": worst})


@predicate
def exponential_derivative(line: int) -> Finding:
    """Whether a line of the proof that d/dt e^(At) = A e^(At) equals it in the limit.

    The error of a quotient is of first order in h; it is seen to fall tenfold with h.

    Parameters
    ----------
    line
        1: (e^(A(t+h)) - e^(At))/h. 2: e^(At) (e^(Ah) - I)/h. 3: e^(At) (A + A^2 h/2! + A^3 h^2/3! + ...).
        4: A e^(At), against differences.
    """
    rng = np.random.default_rng(_SEED)
    a, t, one = rng.uniform(-1.0, 1.0, (3, 3)), 0.7, np.eye(3)
    at, slope = expm(t * a), a @ expm(t * a)
    errors = []
    for h in (1e-3, 1e-4):
        series = sum(np.linalg.matrix_power(a, n) * h ** (n - 1) / factorial(n) for n in range(1, 20))
        said = {
            1: (expm((t + h) * a) - at) / h,
            2: at @ (expm(h * a) - one) / h,
            3: at @ series,
            4: 2.0 * slope - (expm((t + h) * a) - at) / h,
        }
        if line not in said:
            raise BadInput(f"exponential_derivative: no line {shown(line)}; write 1, 2, 3 or 4")
        errors.append(float(np.abs(said[line] - slope).max()))
    order = float(np.log10(errors[0] / errors[1]))
    return Finding(
        errors[1] < 1e-3 and abs(order - 1.0) < 0.1,
        f"off by {errors[0]:.1e} for h = 1e-3 and {errors[1]:.1e} for h = 1e-4",
        {"order in h": order},
    )


def _jordan(rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """A matrix with a double eigenvalue and one eigenvector for it, a basis of chains, and the eigenvalues."""
    basis, eigenvalues = well_conditioned(rng, 3), np.array([-0.7, -0.7, 0.4])
    form = np.diag(eigenvalues) + np.diag([1.0, 0.0], 1)
    return basis @ form @ np.linalg.inv(basis), basis, eigenvalues


@predicate
def exponential_form(case: str) -> Finding:
    """Whether a closed form of e^(At) is right, as it is printed, on random matrices of its kind.

    ``real``: P diag(e^(s_j t)) P^-1 with the eigenvectors as columns. ``complex``: blocks of cos(bt), -sin(bt);
    sin(bt), cos(bt) times e^(at), P with the imaginary and the real part of each eigenvector, in this order.
    ``repeated``: P diag(e^(s_j t)) [I + N t + ...] P^-1 with N = A - P diag(s_j) P^-1.
    """
    rng, t, as_printed, outside = np.random.default_rng(_SEED), 0.8, 0.0, 0.0
    for _ in range(_TRIES):
        if case == "real":
            basis, s = well_conditioned(rng, 3), np.array([-1.3, 0.2, 0.9])
            a = basis @ np.diag(s) @ np.linalg.inv(basis)
            said = basis @ np.diag(np.exp(s * t)) @ np.linalg.inv(basis)
        elif case == "complex":
            start, parts = well_conditioned(rng, 4), [(-0.3, 1.1), (0.2, 0.6)]
            a = start @ _blocks([((p, -q), (q, p)) for p, q in parts]) @ np.linalg.inv(start)
            roots, vectors = np.linalg.eig(a)
            upper = [k for k in range(4) if roots[k].imag > 0.0]
            basis = np.column_stack([part for k in upper for part in (vectors[:, k].imag, vectors[:, k].real)])
            turned = [
                np.exp(roots[k].real * t) * np.array([[c, -s], [s, c]])
                for k in upper
                for c, s in [(np.cos(roots[k].imag * t), np.sin(roots[k].imag * t))]
            ]
            said = basis @ _blocks(turned) @ np.linalg.inv(basis)
        elif case == "repeated":
            a, basis, s = _jordan(rng)
            back = np.linalg.inv(basis)
            rest = np.eye(3) + t * (a - basis @ np.diag(s) @ back)
            said = basis @ np.diag(np.exp(s * t)) @ rest @ back
            behind = basis @ np.diag(np.exp(s * t)) @ back @ rest
            outside = max(outside, float(np.abs(behind - expm(t * a)).max()))
        else:
            raise BadInput(f"exponential_form: no case {shown(case)}; write real, complex or repeated")
        as_printed = max(as_printed, float(np.abs(said - expm(t * a)).max()))
    right = as_printed < _EQUAL
    return Finding(
        right,
        f"it and e^(At) differ by {as_printed:.2g}",
        {"largest difference": as_printed},
        remark="" if right or outside > _EQUAL else f"with P^-1 before the bracket they differ by {outside:.0e} only",
    )


def _blocks(parts: Sequence[ArrayLike]) -> Array:
    """Two by two blocks along the diagonal."""
    found = np.zeros((2 * len(parts),) * 2)
    for k, part in enumerate(parts):
        found[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = np.asarray(part)
    return found


@predicate
def nilpotent_rest(of: str) -> Finding:
    """Whether A - S is nilpotent, with S the diagonal matrix of the ``exponentials`` of the eigenvalues, as printed."""
    if of != "exponentials":
        raise BadInput(f"nilpotent_rest: no {shown(of)}; write exponentials")
    a, basis, s = _jordan(np.random.default_rng(_SEED))
    printed = np.linalg.matrix_power(a - np.diag(np.exp(s)), 3)
    right = np.linalg.matrix_power(a - basis @ np.diag(s) @ np.linalg.inv(basis), 2)
    sizes = [float(np.abs(m).max()) for m in (printed, right)]
    return Finding(
        sizes[0] < _EQUAL,
        f"for a matrix with a double eigenvalue N^3 has entries up to {sizes[0]:.2g}",
        {"largest entry of N^3": sizes[0], "of N^2 with S = P diag(lambda_j) P^-1": sizes[1]},
        remark=f"with S = P diag(lambda_j) P^-1, N^2 is zero but for {sizes[1]:.0e}",
    )


@predicate
def blocks_of_pairs(size: int, blocks: str) -> Finding:
    """Whether so many blocks (a share of n) fill a matrix of 2n rows with n pairs of complex eigenvalues."""
    share = float(exact.expression(blocks))
    n, said = size, int(share * size)
    return Finding(
        said == n,
        f"a matrix of {2 * n} rows has {n} pairs of eigenvalues, so {n} blocks; {said} would be counted",
        {"rows": 2 * n, "pairs": n, "counted": said},
        remark="j goes from 1 to n",
    )


@predicate
def cases_cover_all() -> Finding:
    """Whether every real matrix has distinct real eigenvalues, or complex ones alone, or equal ones."""
    mixed = np.zeros((3, 3))
    mixed[0, 0], mixed[1:, 1:] = 1.0, [[0.0, -1.0], [1.0, 0.0]]
    roots = np.linalg.eigvals(mixed)
    real, distinct = np.abs(roots.imag) < _EQUAL, len({complex(np.round(z, 9)) for z in roots}) == len(roots)
    covered = bool(real.all() and distinct) or not real.any() or not distinct
    return Finding(
        covered,
        f"a matrix with the eigenvalues {', '.join(f'{z:.3g}' for z in roots)} is in none of the cases",
        {"real eigenvalues": int(real.sum()), "of": len(roots), "all different": distinct},
        remark="real and complex eigenvalues can occur together, each then with its own block",
    )
