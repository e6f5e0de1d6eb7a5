"""Steps for linear models with constant coefficients: stability, Jordan form, e^(At), Routh array, ranks, and more."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Any, Literal

import mpmath as mp
import sympy as sp

from satsym.agreement import DIGITS
from satsym.symbolic.analysis.components import companion_form as companion_of
from satsym.symbolic.analysis.components import jordan_form as jordan_of
from satsym.symbolic.analysis.exponential import matrix_exponential as exponential_of
from satsym.symbolic.analysis.routh import RouthArray
from satsym.symbolic.analysis.routh import routh as routh_of
from satsym.symbolic.analysis.spectrum import Spectrum, spectrum
from satsym.symbolic.analysis.stability import Cause, Stability
from satsym.symbolic.analysis.stability import stability as stability_of
from satsym.symbolic.analysis.structure import KalmanForm, Reach
from satsym.symbolic.analysis.structure import controllability as controllability_of
from satsym.symbolic.analysis.structure import observability as observability_of
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
from satsym.symbolic.model import symbols_of, t

EARLY, LATE, LATE_DIGITS = 30, 60, 720
"""Exponents (base ten) of the two times between which growth is measured, and number of digits of the computation.

The number of digits suffices for matrices of eight states.
"""
DECISIVE = 50.0
"""Power of time above which measured growth (or below whose negative, decay) can only be exponential."""
TOLERANCE = 0.4
"""Largest error of a measured power of time, less than one half, so that oscillations have no effect."""


def stability(so_far: Derivation) -> Step | None:
    """Derive the characteristic polynomial, the eigenvalues with multiplicities, and the verdict on stability."""
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
    """Derive the Jordan form J and a basis T with A T = T J."""
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
    """Derive e^(At) in closed form."""
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
    """Derive the Routh array of the characteristic polynomial, and the number of roots that it counts."""
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
    """Check the characteristic polynomial, and the product over the eigenvalues, against numeric determinants."""
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
    """Check numbers of independent eigenvectors against ranks found by singular values."""
    a, size, values = numeric_matrix(of.field.matrix(of.matrix)), of.matrix.shape[0], of.eigenvalues
    roots = numeric([e.value for e in values])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        at = a(point)
        ranks = [numeric_rank(mp.eye(size) * root - at) for root in roots(point)]
        return [size - e.geometric for e in values], ranks

    return [compare("numeric rank", _symbols(of), sides)]


def _growth(of: Spectrum, verdict: Stability) -> Check:
    """Check the growth of the norm of e^(At) between two late times against the verdict on stability.

    The times are late for any eigenvalue that is not zero, so that only the power of time is left where that power
    grows; numbers have as many digits as this takes.
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
    """Return the power of time by which the norm of e^(At) grows at late times."""
    from flint import arb, arb_mat, ctx

    with ctx.workprec(int(LATE_DIGITS * math.log2(10.0))):
        exact, norms = arb_mat(matrix.rows, matrix.cols, [arb(mp.mpf(e)) for e in entries([matrix])]), []
        for digits in (EARLY, LATE):
            found = (exact * arb(10) ** digits).exp().entries()
            norms.append(sum((entry * entry for entry in found), arb(0)).log() / 2)
        return float((norms[1] - norms[0]) / (arb(10) ** (LATE - EARLY)).log())


def _count(of: Spectrum, found: RouthArray) -> Check:
    """Check sign changes in the first column of the Routh array against numeric roots."""
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
    """Return the conclusion of a verdict, with the values that its sentence needs."""
    values: dict[str, sp.Basic] = {"size": sp.Integer(found.block), "power": t ** max(found.block - 1, 0)}
    values |= {"eigenvalues": sp.Tuple(*found.eigenvalues), "conditions": sp.Tuple(*found.conditions)}
    unnamed = found.cause in (Cause.RIGHT, Cause.BLOCK) and not found.eigenvalues
    return Conclusion(f"{found.cause.value}, unnamed" if unnamed else found.cause.value, values)


def _assumed(expressions: tuple[sp.Expr, ...]) -> tuple[Conclusion, ...]:
    """Return a conclusion that lists the expressions assumed not to vanish, if there are any."""
    return (Conclusion("assumed", {"expressions": sp.Tuple(*expressions)}),) if expressions else ()


Kind = Literal["controllability", "observability"]


def controllability(so_far: Derivation) -> Step | None:
    """Derive controllability matrices, ranks and uncontrollable modes, for all inputs and for each alone."""
    return _reach_step(so_far, "controllability")


def observability(so_far: Derivation) -> Step | None:
    """Derive observability matrices, ranks and unobservable modes, for all outputs and for each alone."""
    return _reach_step(so_far, "observability")


def companion_form(so_far: Derivation) -> Step | None:
    """Derive the companion form for each input that controls all states alone."""
    if not analysable(so_far):
        return None
    system = system_of(so_far)
    of = spectrum(system.a)
    forms = {name: companion_of(of, system.b[:, k]) for k, name in enumerate(system.inputs)}
    found = {name: form for name, form in forms.items() if form}
    if not found:
        return None
    matrix = next(iter(found.values())).matrix
    equations = [Equation("matrix", ln.COMPANION_FORM, matrix)]
    equations += [
        Equation(f"basis_{name}", sp.Symbol(f"controllability_companion_basis_{name}"), form.basis)
        for name, form in found.items()
    ]
    checks = []
    for name, form in found.items():
        column = system.b[:, system.inputs.index(name)]
        last = sp.ImmutableMatrix(sp.Matrix(sp.eye(system.a.rows)[:, -1]))
        checks.append(_same_product(system.a, column, form.basis, matrix, last))
    worst = Check(checks[0].claim, max(c.error for c in checks), checks[0].limit)
    return Step("companion_form", "chain of integrators", tuple(equations), ("controllability", "stability"), (worst,))


def _reach_step(so_far: Derivation, kind: Kind) -> Step | None:
    if not analysable(so_far):
        return None
    system = system_of(so_far)
    of = spectrum(system.a)
    ports = system.inputs if kind == "controllability" else system.outputs
    matrix = system.b if kind == "controllability" else system.c
    if not ports:
        return None
    groups: dict[str, sp.ImmutableMatrix] = {"": matrix}
    if len(ports) > 1:
        groups |= {name: matrix[:, k] if kind == "controllability" else matrix[k, :] for k, name in enumerate(ports)}
    equations: list[Equation] = []
    conclusions: list[Conclusion] = []
    ranks, modes, forms = [], [], []
    for name, port in groups.items():
        found = controllability_of(of, port) if kind == "controllability" else observability_of(of, port)
        equations += _equations(so_far, kind, name, found, of.closed_form)
        said = _conclusions(kind, name or (ports[0] if len(ports) == 1 else ""), found, of)
        conclusions += [replace(one, after=equations[-1].name) for one in said]
        ranks.append((found.matrix, found.rank))
        modes += [(port, mode) for mode in found.lost]
        forms += [(port, found.kalman)] if found.kalman else []
    checks = [_ranks(ranks)]
    if modes:
        checks.append(_modes(kind, system.a, modes))
    if forms:
        checks.append(_kalman(kind, system.a, forms))
    sources = (
        ("linearisation", "stability") if kind == "controllability" else ("linearisation", "output_matrix", "stability")
    )
    rule = "space reached" if kind == "controllability" else "space shown"
    return Step(kind, rule, tuple(equations), sources, tuple(checks), tuple(conclusions))


def _equations(so_far: Derivation, kind: Kind, name: str, found: Reach, closed: bool) -> Iterator[Equation]:
    suffix = f"_{name}" if name else ""
    yield Equation(name or "all", sp.Symbol(f"{kind}{suffix}"), found.matrix)
    yield Equation(f"rank{suffix}", sp.Symbol(f"{kind}_rank{suffix}"), sp.Integer(found.rank))
    if closed:
        row = sp.ImmutableMatrix([[rank for _, rank in found.pbh]])
        yield Equation(f"pbh{suffix}", sp.Symbol(f"{kind}_pbh{suffix}"), row)
    states = sp.Matrix(symbols_of(so_far.model.states))
    for k, mode in enumerate(found.lost, 1):
        value = (mode.vector.T * states)[0] if kind == "controllability" else mode.vector
        yield Equation(f"mode{suffix}_{k}", sp.Symbol(f"{kind}_mode{suffix}_{k}"), value)
    if found.kalman:
        parts = {"basis": found.kalman.basis, "state": found.kalman.state, "port": found.kalman.port}
        for part, matrix in parts.items():
            yield Equation(f"kalman_{part}{suffix}", sp.Symbol(f"{kind}_{part}{suffix}"), matrix)


def _conclusions(kind: Kind, name: str, found: Reach, of: Spectrum) -> Iterator[Conclusion]:
    """Return the conclusions about a rank, for all inputs or outputs or for a single one."""
    who = {"port": sp.Symbol(name, real=True)} if name else {}
    alone = " alone" if name else ""
    if found.full:
        yield Conclusion(f"full {kind}{alone}", who)
    else:
        numbers = {"rank": sp.Integer(found.rank), "size": sp.Integer(of.matrix.shape[0])}
        yield Conclusion(f"partial {kind}{alone}", {**who, **numbers})
        if found.lost:
            eigenvalues = sp.Tuple(*dict.fromkeys(m.eigenvalue for m in found.lost))
            yield Conclusion(f"lost {kind}", {"eigenvalues": eigenvalues})
    if found.assumed:
        yield Conclusion("assumed", {"expressions": sp.Tuple(*found.assumed)})


def _ranks(found: list[tuple[sp.ImmutableMatrix, int]]) -> Check:
    functions = [numeric_matrix(matrix) for matrix, _ in found]
    symbols = set().union(*(matrix.free_symbols for matrix, _ in found))
    expected = [rank for _, rank in found]
    return compare("numeric rank", symbols, lambda point: (expected, [numeric_rank(f(point)) for f in functions]))


def _modes(kind: Kind, a: sp.ImmutableMatrix, found: list[tuple[sp.ImmutableMatrix, Any]]) -> Check:
    """Check that modes satisfy w'A = eigenvalue w' and w'B = 0, or A v = eigenvalue v and C v = 0."""
    products = []
    for port, mode in found:
        state, other = (a.T, port.T) if kind == "controllability" else (a, port)
        products += [*(state * mode.vector - mode.eigenvalue * mode.vector), *(other * mode.vector)]
    values = numeric_matrix(sp.Matrix(products))
    symbols = set().union(*(p.free_symbols for p in products))
    return compare("apart from the rest", symbols, lambda point: (entries([values(point)]), [0] * len(products)))


def _kalman(kind: Kind, a: sp.ImmutableMatrix, found: list[tuple[sp.ImmutableMatrix, KalmanForm]]) -> Check:
    parts = []
    for port, form in found:
        if kind == "controllability":
            parts.append(_same_product(a, port, form.basis, form.state, form.port))
        else:
            back = form.basis
            parts.append(_same_product(a.T, port.T, sp.ImmutableMatrix(back.inv().T), form.state.T, form.port.T))
    return Check(parts[0].claim, max(c.error for c in parts), parts[0].limit)


def _same_product(
    a: sp.MatrixBase, b: sp.MatrixBase, basis: sp.MatrixBase, state: sp.MatrixBase, port: sp.MatrixBase
) -> Check:
    """Check that A T = T (new A) and B = T (new B), and that T has an inverse."""
    functions = [numeric_matrix(m) for m in (a, b, basis, state, port)]
    symbols = set().union(*(m.free_symbols for m in (a, b, basis, state, port)))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        old_a, old_b, change, new_a, new_b = (f(point) for f in functions)
        invertible = int(numeric_rank(change) == change.rows)
        return [*entries([old_a * change, old_b]), invertible], [*entries([change * new_a, change * new_b]), 1]

    return compare("change of basis", symbols, sides)
