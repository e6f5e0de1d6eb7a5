"""Steps for linear models with constant coefficients: what inputs reach, what outputs show, the companion form."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Literal

import sympy as sp

from satsym.symbolic.analysis.components import companion_form as companion_of
from satsym.symbolic.analysis.spectrum import Spectrum, spectrum
from satsym.symbolic.analysis.structure import KalmanForm, Reach
from satsym.symbolic.analysis.structure import controllability as controllability_of
from satsym.symbolic.analysis.structure import observability as observability_of
from satsym.symbolic.checks import Point, compare
from satsym.symbolic.derivation import Check, Conclusion, Derivation, Equation, Step
from satsym.symbolic.linear import notation as ln
from satsym.symbolic.linear.matrices import analysable, entries, numeric_matrix, numeric_rank, system_of
from satsym.symbolic.model import symbols_of

Kind = Literal["controllability", "observability"]


def controllability(so_far: Derivation) -> Step | None:
    """Controllability matrices, ranks and what is out of reach, for all inputs and for each alone."""
    return _reach_step(so_far, "controllability")


def observability(so_far: Derivation) -> Step | None:
    """Observability matrices, ranks and what is out of sight, for all outputs and for each alone."""
    return _reach_step(so_far, "observability")


def companion_form(so_far: Derivation) -> Step | None:
    """The companion form, for each input that reaches everything alone."""
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
    """What a rank means, for all inputs or outputs or for one."""
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
    """w'A = eigenvalue w' and w'B = 0, or A v = eigenvalue v and C v = 0."""
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
    """A T = T (new A), B = T (new B), and T has an inverse."""
    functions = [numeric_matrix(m) for m in (a, b, basis, state, port)]
    symbols = set().union(*(m.free_symbols for m in (a, b, basis, state, port)))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        old_a, old_b, change, new_a, new_b = (f(point) for f in functions)
        invertible = int(numeric_rank(change) == change.rows)
        return [*entries([old_a * change, old_b]), invertible], [*entries([change * new_a, change * new_b]), 1]

    return compare("change of basis", symbols, sides)
