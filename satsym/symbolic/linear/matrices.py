"""Linear models and their matrices."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal

import mpmath as mp
import sympy as sp

from satsym.spec import MOST_LETTERS
from satsym.symbolic.algebra import definitions_of, vanishes
from satsym.symbolic.analysis.field import NotExact, exact
from satsym.symbolic.analysis.structure import LinearSystem
from satsym.symbolic.checks import numeric
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.linear.notation import results
from satsym.symbolic.model import symbols_of, t, variables_of

Coefficients = Literal["constant", "varying"]


def coefficients_of(derivation: Derivation) -> Coefficients | None:
    """Tell whether x' = A x + B u has constant or time-varying coefficients; ``None`` if it is not linear."""
    if "linearisation" not in derivation:
        return None
    model = derivation.model
    moving = {*symbols_of(model.states), *symbols_of(model.controls)}
    matrices = [
        e.rhs
        for step in ("linearisation", "output_matrix")
        if step in derivation
        for e in derivation.step(step).equations
    ]
    at_rest = derivation.rhs("first_order").xreplace(dict.fromkeys(moving, sp.Integer(0)))
    at_rest = at_rest.xreplace(definitions_of(model))
    if any(e.free_symbols & moving for e in matrices) or not all(vanishes(e) for e in at_rest):
        return None
    return "varying" if any(e.has(t) for e in matrices) else "constant"


def system_of(derivation: Derivation) -> LinearSystem:
    """Return the matrices of a linear model with constant coefficients, with named constants filled in.

    Raises
    ------
    DerivationError
        If the model is not linear, or its coefficients are not constant.
    """
    if coefficients_of(derivation) != "constant":
        raise DerivationError(
            f"{derivation.name}: the system is not linear with constant coefficients; linearise the model "
            "about a motion, as derivations/clohessy_wiltshire.py does"
        )
    model = derivation.model
    outputs = tuple(o.variable.symbol for o in model.outputs)
    n, m, k = len(model.states), len(model.controls), len(outputs)
    constants = definitions_of(model)
    entries = [e.rhs.xreplace(constants) for e in derivation.step("linearisation").equations]
    shown = [e.rhs.xreplace(constants) for e in derivation.step("output_matrix").equations] if outputs else []
    return LinearSystem(
        sp.ImmutableMatrix(n, n, entries[: n * n]),
        sp.ImmutableMatrix(n, m, entries[n * n :]),
        sp.ImmutableMatrix(k, n, shown[: k * n]),
        sp.ImmutableMatrix(k, m, shown[k * n :]),
        tuple(v.symbol for v in model.states),
        tuple(v.symbol for v in model.controls),
        outputs,
    )


def analysable(derivation: Derivation) -> bool:
    """Tell whether the steps of exact analysis apply to a derivation.

    They apply to models without a cost and with constant coefficients, if exact arithmetic can represent the entries,
    these do not have too many letters, and no variable has the name of a result.
    """
    if derivation.problem is not None or coefficients_of(derivation) != "constant":
        return False
    if {v.symbol for v in variables_of(derivation.model)} & set(results(derivation.model)):
        return False
    system = system_of(derivation)
    if too_many_letters(system):
        return False
    try:
        exact(system.a, system.b, system.c)
    except NotExact:
        return False
    return True


def too_many_letters(system: LinearSystem) -> bool:
    """Tell whether a system has so many letters that exact analysis would not end, or have no clear result."""
    return system.a.rows * len(system.a.free_symbols) > MOST_LETTERS


MOST_ITERATIONS = 100
"""Largest number of Newton iterations; near the solution each iteration doubles the number of digits."""


def numeric_matrix(matrix: sp.MatrixBase) -> Callable[[Mapping[sp.Symbol, Any]], Any]:
    """Return a function that evaluates a matrix at a point, in the working precision of mpmath."""
    values, rows, columns = numeric(list(matrix)), matrix.rows, matrix.cols

    def at(point: Mapping[sp.Symbol, Any]) -> Any:
        found = mp.matrix(rows, columns)
        for k, value in enumerate(values(point)):
            found[k // columns, k % columns] = value
        return found

    return at


def entries(matrices: Iterable[Any]) -> list[Any]:
    """Return all entries of some numeric matrices as a list."""
    return [m[i, j] for m in matrices for i in range(m.rows) for j in range(m.cols)]


def numeric_rank(matrix: Any) -> int:
    """Return the rank of a numeric matrix: the number of singular values above rounding, relative to the largest.

    The limit of rounding is two thirds of the working digits.
    """
    if not any(entries([matrix])):
        return 0
    wide = matrix if matrix.rows >= matrix.cols else matrix.T
    decomposed = mp.svd_c if any(mp.im(entry) for entry in entries([wide])) else mp.svd_r
    values = list(decomposed(mp.matrix(wide), compute_uv=False))
    smallest = mp.mpf(10) ** (-2 * mp.mp.dps // 3) * max(values)
    return sum(value > smallest for value in values)


def sign_function(matrix: Any) -> Any:
    """Return the sign of a numeric matrix without imaginary eigenvalues, by Newton's method.

    The result has the same invariant subspaces, with 1 and -1 for eigenvalues with positive and negative real parts.
    """
    sign = matrix
    for _ in range(MOST_ITERATIONS):
        last, sign = sign, (sign + mp.inverse(sign)) / 2
        if mp.mnorm(sign - last, "f") < mp.mpf(10) ** (5 - mp.mp.dps) * mp.mnorm(sign, "f"):
            break
    return sign


def right_half_plane(coefficients: Sequence[Any]) -> tuple[int, int]:
    """Count the roots with positive and with zero real parts of a numeric polynomial, highest power first."""
    trailing = next(k for k, c in enumerate(reversed(coefficients)) if c != 0)
    kept = list(coefficients)[: len(coefficients) - trailing]
    degree = len(kept) - 1
    with mp.workdps(4 * mp.mp.dps):  # multiple roots have but a share of the digits
        companion = mp.matrix(degree, degree)
        for k in range(degree):
            companion[0, k] = -kept[k + 1] / kept[0]
            if k:
                companion[k, k - 1] = mp.mpf(1)
        # mpmath wraps the eigenvalue of a matrix with one entry once more
        roots = mp.eig(companion, left=False, right=False) if degree > 1 else list(companion)
    reals = [mp.re(root) for root in roots]
    tolerance = mp.mpf(10) ** (-mp.mp.dps // 2)
    return sum(x > tolerance for x in reals), trailing + sum(abs(x) <= tolerance for x in reals)
