"""Functions of linear models: matrices, polynomials, closed forms and residuals, as functions of parameters."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import sympy as sp

from satsym.codegen.functions import Function, symbols
from satsym.symbolic.algebra import definitions_of, simplify, vanishes
from satsym.symbolic.analysis import matrix_exponential, routh, spectrum
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.linear.matrices import analysable, coefficients_of, system_of
from satsym.symbolic.linear.notation import matrix_symbols
from satsym.symbolic.linear.regulator import MOST_INPUTS, MOST_STATES, inverse, riccati_operator


def linear_functions(derivation: Derivation) -> list[Function]:
    """Return the functions of a linear model without a cost; none for any other model."""
    kind = coefficients_of(derivation) if derivation.problem is None else None
    if kind is None:
        return []
    found = _matrices(derivation)
    if "deviations" in derivation:
        found += _deviations(derivation)
    return found + (list(_constant(derivation)) if kind == "constant" and analysable(derivation) else [])


def _matrices(derivation: Derivation) -> list[Function]:
    n, m, o = (len(group) for group in (derivation.model.states, derivation.model.controls, derivation.model.outputs))
    constants = definitions_of(derivation.model)
    entries = [e.rhs.xreplace(constants) for e in derivation.step("linearisation").equations]
    found = [_of_parameters("state_matrix", "A, row by row.", "t p", sp.Matrix(n, n, entries[: n * n]))]
    if m:
        found.append(_of_parameters("input_matrix", "B, row by row.", "t p", sp.Matrix(n, m, entries[n * n :])))
    if o:
        entries = [e.rhs.xreplace(constants) for e in derivation.step("output_matrix").equations]
        found.append(_of_parameters("output_matrix", "C, row by row.", "t p", sp.Matrix(o, n, entries[: o * n])))
        if m:
            rest = sp.Matrix(o, m, entries[o * n :])
            found.append(_of_parameters("feedthrough_matrix", "D, row by row.", "t p", rest))
    return found


def _deviations(derivation: Derivation) -> list[Function]:
    """Return the exact equations in the same variables, and the change of variables in both directions."""
    n = len(derivation.model.states)
    back = sp.Matrix([e.rhs for e in derivation.step("original_states").equations[:n]])
    there = sp.Matrix([e.rhs for e in derivation.step("deviations").equations[:n]])
    exact, summary = derivation.rhs("deviation_equations"), "Exact rates of change of the deviations."
    return [
        Function("deviation_dynamics", summary, ("t", "x", "u", "p"), exact, "vector"),
        Function(
            "original_state", "The original states as functions of the deviations.", ("t", "x", "p"), back, "vector"
        ),
        Function(
            "deviation_state",
            "The deviations as functions of the original states.",
            ("t", "original", "p"),
            there,
            "vector",
        ),
    ]


def _constant(derivation: Derivation) -> list[Function]:
    """Return the functions of a model with constant coefficients."""
    system = system_of(derivation)
    of = spectrum(system.a)
    array = routh(of.coefficients)
    found = [_polynomial("characteristic_polynomial", "det(s I - A), highest power first.", "p", of.coefficients)]
    if not any(s.name.startswith("epsilon_") for e in array.column for s in e.free_symbols):
        summary = "First column of the Routh array of the characteristic polynomial."
        found.append(_polynomial("routh_column", summary, "p", array.column))
    if of.closed_form and not of.assumed:
        values = [e.value for e in of.eigenvalues for _ in range(e.algebraic)]
        parts = [simplify(part) for value in values for part in value.as_real_imag()]
        exponential = matrix_exponential(of)
        assert exponential is not None
        n = len(system.states)
        summary = "Eigenvalues of A: rows of a real and an imaginary part."
        found.append(_of_parameters("eigenvalues", summary, "p", sp.Matrix(n, 2, parts)))
        found.append(_of_parameters("transition_matrix", "e^(At), row by row.", "t p", sp.Matrix(exponential)))
    return found + (_feedback(derivation) if system.inputs and len(system.states) <= MOST_STATES else [])


def _feedback(derivation: Derivation) -> list[Function]:
    """Return functions of a linear feedback u = -K x and of its Riccati equation."""
    system, s = system_of(derivation), symbols(derivation)
    n, m = system.b.shape
    coefficients = _coefficients(system.a - system.b * matrix_symbols("K", m, n))
    found = [_polynomial("closed_loop_polynomial", "det(s I - A + B K), highest power first.", "gain p", coefficients)]
    if column := _regular_column(coefficients):
        summary = (
            "First column of the Routh array of the closed loop; not finite if an element other than the last vanishes."
        )
        found.append(_polynomial("closed_loop_routh", summary, "gain p", column))
    if m <= MOST_INPUTS:
        p, q, r = (sp.Matrix(n, n, s.riccati), sp.Matrix(n, n, s.state_weight), sp.Matrix(m, m, s.control_weight))
        found.append(
            _of_parameters(
                "riccati_residual",
                "A' P + P A - P B R^-1 B' P + Q, row by row.",
                "riccati state_weight control_weight p",
                riccati_operator(system.a, system.b * inverse(r) * system.b.T, q, p),
            )
        )
    return found


@lru_cache(maxsize=16)
def _coefficients(matrix: sp.ImmutableMatrix) -> tuple[sp.Expr, ...]:
    """Return the coefficients of det(s I - M), highest power first, each as a product of few terms."""
    found = sp.Matrix(matrix).charpoly(sp.Dummy("s")).all_coeffs()
    return tuple(sp.factor_terms(sp.expand(c)) for c in found)


def _regular_column(coefficients: Sequence[sp.Expr]) -> list[sp.Expr]:
    """Return the first column of a Routh array without special cases.

    It is empty where an element other than the last vanishes identically.
    """
    above, line = list(coefficients[0::2]), list(coefficients[1::2])
    column = [above[0]]
    while line:
        column.append(line[0])
        if len(column) < len(coefficients) and vanishes(line[0]):
            return []
        padded = [*line, *[sp.Integer(0)] * (len(above) - len(line))]
        below = [above[k] - above[0] * padded[k] / line[0] for k in range(1, len(above))]
        above, line = line, below[: max(len(above) - 1, 0)]
    return column


def _polynomial(name: str, summary: str, arguments: str, coefficients: Sequence[sp.Expr]) -> Function:
    return Function(
        name, summary, tuple(arguments.split()), sp.Matrix(list(coefficients)), "vector", over_parameters=True
    )


def _of_parameters(name: str, summary: str, arguments: str, value: sp.MatrixBase) -> Function:
    return Function(name, summary, tuple(arguments.split()), sp.Matrix(value), "matrix", over_parameters=True)
