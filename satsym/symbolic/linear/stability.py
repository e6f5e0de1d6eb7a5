"""Steps for linear models with constant coefficients: eigenvalues, Jordan form, e^(At), and the Routh array."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.agreement import DIGITS
from satsym.symbolic.analysis.components import jordan_form as jordan_of
from satsym.symbolic.analysis.exponential import matrix_exponential as exponential_of
from satsym.symbolic.analysis.routh import RouthArray
from satsym.symbolic.analysis.routh import routh as routh_of
from satsym.symbolic.analysis.spectrum import Spectrum, spectrum
from satsym.symbolic.analysis.stability import Cause, Stability
from satsym.symbolic.analysis.stability import stability as stability_of
from satsym.symbolic.checks import POINTS, Point, compare, numeric, points
from satsym.symbolic.derivation import Check, Conclusion, Derivation, Equation, Step
from satsym.symbolic.linear import notation as ln
from satsym.symbolic.linear.matrices import (
    analysable,
    entries,
    numeric_matrix,
    numeric_rank,
    right_half_plane,
    system_of,
)
from satsym.symbolic.model import t

EARLY, LATE, LATE_DIGITS = 30, 60, 720
"""Decimal powers of the times between which growth is measured, and digits that do for matrices of eight states."""
DECISIVE = 50.0
"""A power of time that only exponential growth exceeds."""
TOLERANCE = 0.4
"""By how much measured powers of time may be off: less than half of one, so that oscillations do not matter."""


def stability(so_far: Derivation) -> Step | None:
    """Characteristic polynomial, eigenvalues with multiplicities, and whether deviations decay, stay or grow."""
    if not analysable(so_far):
        return None
    of = _spectrum(so_far)
    equations = [Equation("characteristic_polynomial", ln.CHARACTERISTIC, of.polynomial)]
    if of.closed_form:
        found = of.eigenvalues
        rows = {
            "eigenvalues": (ln.EIGENVALUES, [e.value for e in found for _ in range(e.algebraic)]),
            "distinct": (ln.DISTINCT, [e.value for e in found]),
            "algebraic": (ln.ALGEBRAIC, [e.algebraic for e in found]),
            "geometric": (ln.GEOMETRIC, [e.geometric for e in found]),
        }
        equations += [Equation(name, lhs, sp.ImmutableMatrix([row])) for name, (lhs, row) in rows.items()]
    verdict = stability_of(of)
    checks = [_determinant(of), *(_multiplicities(of) if of.closed_form else ())]
    if verdict.cause is not Cause.PARAMETERS:
        checks.append(_growth(of, verdict))
    conclusions = (_verdict(verdict), *_assumed(of.assumed))
    return Step(
        "stability", "roots of the determinant", tuple(equations), ("linearisation",), tuple(checks), conclusions
    )


def jordan_form(so_far: Derivation) -> Step | None:
    """J and a basis T with A T = T J."""
    if not analysable(so_far) or (found := jordan_of(of := _spectrum(so_far))) is None:
        return None
    a, j, basis = (numeric_matrix(m) for m in (of.field.matrix(of.matrix), found.form, found.basis))
    symbols = _symbols(of) | found.basis.free_symbols

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        at = basis(point)
        return entries([a(point) * at]), entries([at * j(point)])

    def ranks(point: Point) -> tuple[list[Any], list[Any]]:
        return [found.basis.cols], [numeric_rank(basis(point))]

    return Step(
        "jordan_form",
        "generalised eigenvectors",
        (Equation("J", ln.JORDAN, found.form), Equation("T", ln.JORDAN_BASIS, found.basis)),
        ("stability",),
        (compare("similar matrices", symbols, sides), compare("independent columns", symbols, ranks)),
    )


def matrix_exponential(so_far: Derivation) -> Step | None:
    """e^(At) in closed form."""
    if not analysable(so_far) or (found := exponential_of(of := _spectrum(so_far))) is None:
        return None
    a, closed = numeric_matrix(of.field.matrix(of.matrix)), numeric_matrix(found)
    check = compare(
        "series of the exponential",
        _symbols(of) | {t},
        lambda point: (entries([closed(point)]), entries([mp.expm(a(point) * point[t])])),
    )
    equation = Equation("transition", ln.TRANSITION, found)
    return Step("matrix_exponential", "projectors on eigenspaces", (equation,), ("stability",), (check,))


def routh(so_far: Derivation) -> Step | None:
    """The Routh array of the characteristic polynomial, and what it counts."""
    if not analysable(so_far):
        return None
    of = _spectrum(so_far)
    found = routh_of(of.coefficients)
    equations = [Equation("array", ln.ROUTH, sp.ImmutableMatrix(found.rows))]
    if found.sign_changes is not None:
        equations.append(Equation("sign_changes", ln.SIGN_CHANGES, sp.Integer(found.sign_changes)))
    cases = tuple(Conclusion(case, {}) for case in dict.fromkeys(found.special_cases))
    return Step("routh", "Routh", tuple(equations), ("stability",), (_count(of, found),), cases)


def _spectrum(so_far: Derivation) -> Spectrum:
    return spectrum(system_of(so_far).a)


def _symbols(of: Spectrum) -> set[sp.Symbol]:
    return of.field.matrix(of.matrix).free_symbols


def _determinant(of: Spectrum) -> Check:
    """The polynomial, and the product over the eigenvalues, against determinants."""
    a, size = numeric_matrix(of.field.matrix(of.matrix)), of.matrix.shape[0]
    forms = [of.polynomial]
    if of.closed_form:
        forms.append(sp.Mul(*((ln.LAMBDA - e.value) ** e.algebraic for e in of.eigenvalues)))
    values = numeric(forms)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        determinant = mp.det(mp.eye(size) * point[ln.LAMBDA] - a(point))
        return values(point), [determinant] * len(forms)

    return compare("determinant", _symbols(of) | {ln.LAMBDA}, sides)


def _multiplicities(of: Spectrum) -> list[Check]:
    """Numbers of independent eigenvectors, against ranks by singular values."""
    a, size, values = numeric_matrix(of.field.matrix(of.matrix)), of.matrix.shape[0], of.eigenvalues
    roots = numeric([e.value for e in values])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        at = a(point)
        ranks = [numeric_rank(mp.eye(size) * root - at) for root in roots(point)]
        return [size - e.geometric for e in values], ranks

    return [compare("numeric rank", _symbols(of), sides)]


def _growth(of: Spectrum, verdict: Stability) -> Check:
    """How the norm of e^(At) grows between two times, against what the verdict says.

    The times are late for any eigenvalue that is not zero, so that nothing but the power of time is left where it is
    that which grows; numbers have as many digits as this takes.
    """
    a, symbols, errors = numeric_matrix(of.field.matrix(of.matrix)), _symbols(of), []
    for point in points(symbols, "growth", POINTS if symbols else 1):
        with mp.workdps(LATE_DIGITS):
            power = _power(a(point))
        if verdict.cause is Cause.RIGHT:
            errors.append(0.0 if power > DECISIVE else 1.0)
        elif verdict.cause is Cause.LEFT:
            errors.append(0.0 if power < -DECISIVE else 1.0)
        else:
            errors.append(abs(power - (verdict.block - 1)))
    return Check("growth", max(errors), TOLERANCE)


def _power(matrix: Any) -> float:
    """The power of time by which the norm of e^(At) grows late."""
    from flint import arb, arb_mat, ctx

    with ctx.workprec(int(LATE_DIGITS * math.log2(10.0))):
        exact, norms = arb_mat(matrix.rows, matrix.cols, [arb(mp.mpf(e)) for e in entries([matrix])]), []
        for digits in (EARLY, LATE):
            found = (exact * arb(10) ** digits).exp().entries()
            norms.append(sum((entry * entry for entry in found), arb(0)).log() / 2)
        return float((norms[1] - norms[0]) / (arb(10) ** (LATE - EARLY)).log())


def _count(of: Spectrum, found: RouthArray) -> Check:
    """Sign changes of the first column against roots."""
    polynomial, column = numeric(list(of.coefficients)), [row[0] for row in found.rows]
    small = sorted({s for e in column for s in e.free_symbols if s.name.startswith("epsilon_")}, key=lambda s: s.name)
    values = numeric(column)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        with mp.workdps(DIGITS * 4 ** (len(small) + 1)):
            tiny = {s: mp.mpf(10) ** (-DIGITS * 4**k) for k, s in enumerate(small)}
            signs = [mp.sign(value) for value in values({**point, **tiny})]
        changes = sum(a != b for a, b in pairwise(signs))
        with mp.workdps(4 * DIGITS):  # the roots of a multiple factor are worth a fraction of the coefficients' digits
            coefficients = polynomial(point)
        right, axis = right_half_plane(coefficients)
        known = [] if found.right is None else [(found.right, right), (found.axis, axis)]
        return [changes, *(a for a, _ in known)], [right, *(b for _, b in known)]

    return compare("numeric roots", _symbols(of), sides)


def _verdict(found: Stability) -> Conclusion:
    """The sentence of a verdict, with what it speaks of."""
    values: dict[str, sp.Basic] = {"size": sp.Integer(found.block), "power": t ** max(found.block - 1, 0)}
    values |= {"eigenvalues": sp.Tuple(*found.eigenvalues), "conditions": sp.Tuple(*found.conditions)}
    unnamed = found.cause in (Cause.RIGHT, Cause.BLOCK) and not found.eigenvalues
    return Conclusion(f"{found.cause.value}, unnamed" if unnamed else found.cause.value, values)


def _assumed(expressions: tuple[sp.Expr, ...]) -> tuple[Conclusion, ...]:
    """State which expressions are taken not to vanish, if any are."""
    return (Conclusion("assumed", {"expressions": sp.Tuple(*expressions)}),) if expressions else ()
