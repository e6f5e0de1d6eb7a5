"""Symbols of linear models and of the results on them, with their LaTeX."""

from __future__ import annotations

import re
from itertools import combinations_with_replacement
from typing import Any

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic import notation as n
from satsym.symbolic.analysis.spectrum import LAMBDA
from satsym.symbolic.dimension_algebra import (
    PLAIN,
    Dimension,
    Disagreement,
    Known,
    dimension_of,
    over,
    product,
    written,
)
from satsym.symbolic.model import Model, Requirement, symbols_of, variables_of

CHARACTERISTIC = sp.Symbol("characteristic_polynomial")
EIGENVALUES = sp.Symbol("eigenvalues")
DISTINCT = sp.Symbol("distinct_eigenvalues")
ALGEBRAIC, GEOMETRIC = sp.Symbol("algebraic_multiplicities"), sp.Symbol("geometric_multiplicities")
JORDAN, JORDAN_BASIS = sp.Symbol("jordan_form"), sp.Symbol("jordan_basis")
TRANSITION = sp.Symbol("transition_matrix")
ROUTH, SIGN_CHANGES = sp.Symbol("routh_array"), sp.Symbol("sign_changes")
COMPANION_FORM = sp.Symbol("companion_matrix")
COUPLING = sp.Symbol("control_coupling")
GAIN = sp.Symbol("feedback_gain")
HAMILTONIAN_MATRIX = sp.Symbol("hamiltonian_matrix")
RICCATI_RATE, RICCATI_RESIDUAL = sp.Symbol("riccati_rate"), sp.Symbol("riccati_residual")

FIXED = {
    LAMBDA: "s",
    CHARACTERISTIC: r"\det(s I - A)",
    JORDAN: "J",
    JORDAN_BASIS: "V",
    TRANSITION: "e^{At}",
    ROUTH: r"\mathcal{R}",
    SIGN_CHANGES: r"n_{+}",
    COMPANION_FORM: "A_c",
    COUPLING: r"W = B R^{-1} B^{\mathsf{T}}",
    GAIN: r"K = R^{-1} B^{\mathsf{T}} P",
    HAMILTONIAN_MATRIX: "M",
    RICCATI_RATE: r"-\dot P",
    RICCATI_RESIDUAL: "0",
}


def small(k: int) -> sp.Symbol:
    """Return the symbol of the positive number in the k-th vanishing element of a Routh array."""
    return sp.Symbol(f"epsilon_{k}", positive=True)


def weight(letter: str, a: sp.Symbol, b: sp.Symbol) -> sp.Symbol:
    """Return an entry of a symmetric matrix Q, R, P or S; ``a`` is the earlier one of the two names."""
    return sp.Symbol(f"{letter}_{a.name}_{b.name}", real=True)


def symmetric(letter: str, names: tuple[sp.Symbol, ...]) -> sp.ImmutableMatrix:
    """Return the symmetric matrix of symbols with the given letter and names."""
    size = len(names)
    return sp.ImmutableMatrix(size, size, lambda i, j: weight(letter, names[min(i, j)], names[max(i, j)]))


def matrix_symbols(letter: str, rows: int, columns: int) -> sp.ImmutableMatrix:
    """Return a matrix of symbols, in the order in which generated code takes them row by row."""
    return sp.ImmutableMatrix(rows, columns, lambda i, j: sp.Symbol(f"{letter}_{i + 1}_{j + 1}", real=True))


def results(model: Model) -> dict[str, str]:
    """Map the names of the results on linear models to LaTeX; no variable of an analysed model has such a name."""
    notation = {s.name: latex for s, latex in FIXED.items()}
    states, controls = len(model.states), len(model.controls)
    notation[EIGENVALUES.name] = {1: "s_1", 2: "(s_1, s_2)"}.get(states, rf"(s_1, \dots, s_{{{states}}})")
    notation[DISTINCT.name] = r"\mathbf{s}"
    notation[ALGEBRAIC.name] = r"\mathbf{m}_a"
    notation[GEOMETRIC.name] = r"\mathbf{m}_g"
    notation |= {small(k).name: rf"\varepsilon_{{{k}}}" for k in range(1, states + 2)}
    for v in model.states:
        notation[f"lambda_{v.symbol}"] = rf"\lambda_{{{v.latex}}}"
        notation[f"d_lambda_{v.symbol}"] = rf"\dot\lambda_{{{v.latex}}}"
    for letter, rows, columns in (
        ("K", controls, states),
        ("P", states, states),
        ("Q", states, states),
        ("R", controls, controls),
    ):
        entry = entry_letter(letter, model)
        notation |= {s.name: rf"{entry}_{{{s.name[2:]}}}" for s in matrix_symbols(letter, rows, columns)}
    return notation | weights(model) | _of_ports(model)


def entry_letter(matrix: str, model: Model) -> str:
    """Return the letter of a matrix's entries: its own in lower case, unless variables are numbered by that."""
    numbered = (v for v in variables_of(model) if re.search(r"_\{?\d", v.latex))
    return n.free_letter((matrix.lower(), matrix), numbered)


def weights(model: Model) -> dict[str, str]:
    """Map the names of the entries of Q, R, P and S to LaTeX."""
    notation = {}
    for letter, variables in (("Q", model.states), ("R", model.controls), ("P", model.states), ("S", model.states)):
        for (i, a), (j, b) in combinations_with_replacement(list(enumerate(symbols_of(variables), 1)), 2):
            comma = "," if len(variables) > 9 else ""
            entry = entry_letter("W" if letter == "S" else letter, model)
            notation[weight(letter, a, b).name] = rf"{entry}_{{{i}{comma}{j}}}"
    return notation


CONTROLLABLE, OBSERVABLE = r"\mathcal{C}", r"\mathcal{O}"
"""Letters of the controllability and observability matrices; C and R have other meanings."""


def _of_ports(model: Model) -> dict[str, str]:
    notation = {"controllability": CONTROLLABLE, "observability": OBSERVABLE}
    for kind, letter, ports in (
        ("controllability", CONTROLLABLE, model.controls),
        ("observability", OBSERVABLE, tuple(o.variable for o in model.outputs)),
    ):
        for port in (None, *ports):
            notation |= _of_port(kind, letter, port)
    return notation


def _of_port(kind: str, letter: str, port: Variable | None) -> dict[str, str]:
    """Return the names of results for one input or output, or for all together."""
    suffix = f"_{port.symbol}" if port else ""
    index = f"_{{{port.latex}}}" if port else ""
    matrix, basis = f"{letter}{index}", f"T_{{{letter}{',' if port else ''}{port.latex if port else ''}}}"
    column = rf"\mathbf{{b}}{index}" if port else "B"
    row = rf"\mathbf{{c}}{index}" if port else "C"
    controls = kind == "controllability"
    mode = (r"\chi" if controls else r"\mathbf{v}") + f"_{{{f'{port.latex},' if port else ''}"
    pencil = rf"(s I - A,\; {column})" if controls else rf"(s I - A;\; {row})"
    return {
        f"{kind}{suffix}": matrix,
        f"{kind}_rank{suffix}": rf"\operatorname{{rank}} {matrix}",
        f"{kind}_pbh{suffix}": rf"\operatorname{{rank}} {pencil}",
        f"{kind}_basis{suffix}": basis,
        f"{kind}_state{suffix}": rf"{basis}^{{-1}} A {basis}",
        f"{kind}_port{suffix}": rf"{basis}^{{-1}} {column}" if controls else rf"{row} {basis}",
        f"{kind}_companion_basis{suffix}": f"T_{{c,{port.latex}}}" if port else "T_c",
        **{f"{kind}_mode{suffix}_{k}": f"{mode}{k}}}" for k in range(1, 20)},
    }


COST: Dimension = {"[cost]": sp.Integer(1)}
"""Dimension of a running cost whose weights may have any unit."""


def declare(known: dict[str, Dimension | None], model: Model, require: Requirement) -> None:
    """Enter the dimensions of C and D, and refuse outputs whose variables have other dimensions."""
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    for output in model.outputs:
        name = output.variable.symbol
        require(f"the output {name}", output.value, known[name])
        for letter, columns in (("C", states), ("D", controls)):
            for column in columns:
                known[f"{letter}_{name}_{column.name}"] = over(known[name], known[column.name])


def declare_results(known: dict[str, Dimension | None], model: Model) -> None:
    """Enter the dimensions of eigenvalues, and of weights, costates and Riccati solution for a quadratic cost."""
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    second = known[n.TIME.name]
    for symbol in (LAMBDA, EIGENVALUES, DISTINCT):
        known[symbol.name] = over(PLAIN, second)
    known[n.HAMILTONIAN.name] = COST
    total = product((COST, second))
    for state in states:
        known[n.costate_of(state).name] = over(total, known[state.name])
        known[n.rate_of(n.costate_of(state)).name] = over(COST, known[state.name])
    for letter, value, symbols in (("Q", COST, states), ("R", COST, controls), ("P", total, states)):
        for a in symbols:
            for b in symbols:
                known[weight(letter, a, b).name] = over(over(value, known[a.name]), known[b.name])
    for a in states:
        for b in states:
            speeds = (known[n.rate_of(a).name], known[n.rate_of(b).name])
            known[weight("S", a, b).name] = over(product(speeds), COST)


def require_matrix(matrix: sp.MatrixBase, known: Known) -> None:
    """Refuse a matrix that can map no quantities to quantities.

    Entry (i, j) of one that can has the dimension of the i-th result over that of the j-th argument. A small number
    in a Routh array takes the dimension of its place.

    Raises
    ------
    Disagreement
        If there are no such dimensions.
    """
    links: dict[tuple[str, int], list[tuple[tuple[str, int], Dimension]]] = {}
    for i in range(matrix.rows):
        for j in range(matrix.cols):
            found = _entry(matrix[i, j], known)
            if found is not None:
                links.setdefault(("row", i), []).append((("column", j), over(PLAIN, found) or PLAIN))
                links.setdefault(("column", j), []).append((("row", i), found))
    place: dict[tuple[str, int], Dimension] = {}
    for start in links:
        waiting = [] if start in place else [start]
        place.setdefault(start, PLAIN)
        while waiting:
            here = waiting.pop()
            for there, step in links[here]:
                reached = product((place[here], step)) or PLAIN
                if there not in place:
                    place[there] = reached
                    waiting.append(there)
                elif place[there] != reached:
                    raise Disagreement(f"has entries of dimensions {written(place[there])} and {written(reached)}")


def _entry(entry: Any, known: Known) -> Dimension | None:
    if any(s.name.startswith("epsilon_") for s in entry.free_symbols):
        return None
    return dimension_of(entry, known)
