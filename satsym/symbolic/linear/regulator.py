"""The linear quadratic regulator: from a quadratic cost to Riccati's equation and the gain.

The cost is J = integral of x'Qx + u'Ru, without a factor 1/2. The necessary conditions come from the same steps of
the minimum principle as those of any problem; the factors of 2 that they bring are divided out with lambda = 2 P x.
"""

from __future__ import annotations

import random
from dataclasses import replace
from functools import lru_cache
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.analysis.field import sign_of
from satsym.symbolic.analysis.spectrum import spectrum
from satsym.symbolic.analysis.structure import LinearSystem, controllability
from satsym.symbolic.checks import Point, compare, numeric
from satsym.symbolic.derivation import Check, Derivation, Equation, Step
from satsym.symbolic.factoring import factored
from satsym.symbolic.linear import notation as ln
from satsym.symbolic.linear.matrices import analysable, entries, numeric_matrix, sign_function, system_of
from satsym.symbolic.model import Problem, symbols_of
from satsym.symbolic.principle import pontryagin

MOST_INPUTS = 3
"""Largest number of inputs for which the inverse of R is written out."""
MOST_STATES = 4
"""Largest number of states for which the entries of Riccati's equation are written out."""


def riccati_operator(
    a: sp.MatrixBase, coupling: sp.MatrixBase, q: sp.MatrixBase, p: sp.MatrixBase
) -> sp.ImmutableMatrix:
    """Return A'P + P A - P S P + Q, where S = B R^-1 B'."""
    return sp.ImmutableMatrix(sp.Matrix(a.T * p + p * a - p * coupling * p + q))


def inverse(weights: sp.MatrixBase) -> sp.Matrix:
    """Invert a small matrix of symbols by its adjugate."""
    return sp.Matrix(weights.adjugate()) / weights.det()


def lqr_hamiltonian(so_far: Derivation) -> Step | None:
    """State H for the quadratic cost."""
    if not _applies(so_far):
        return None
    step = pontryagin.hamiltonian(_with_cost(so_far))
    return replace(step, name="lqr_hamiltonian", rule="H of the quadratic cost", follows_from=("first_order",))


def lqr_stationarity(so_far: Derivation) -> Step | None:
    """Derive H_u = 0, and solve it for the control."""
    if not _applies(so_far):
        return None
    return replace(
        pontryagin.stationarity(_with_cost(so_far)), name="lqr_stationarity", follows_from=("lqr_hamiltonian",)
    )


def lqr_costates(so_far: Derivation) -> Step | None:
    """Derive the costate equations for the quadratic cost."""
    if not _applies(so_far):
        return None
    return replace(
        pontryagin.costate_equations(_with_cost(so_far)), name="lqr_costates", follows_from=("lqr_hamiltonian",)
    )


def lqr_hamiltonian_matrix(so_far: Derivation) -> Step | None:
    """Derive S = B R^-1 B' and the Hamiltonian matrix M of the canonical equations for x and lambda/2."""
    if not _applies(so_far):
        return None
    system, states, controls = _parts(so_far)
    coupling, q = _coupling(so_far), ln.symmetric("Q", states)
    named = _named_coupling(so_far)
    matrix = sp.ImmutableMatrix(sp.Matrix(sp.BlockMatrix([[system.a, -named], [-q, -system.a.T]]).as_explicit()))
    lam = [n.costate_of(s) for s in states]
    law = {u: so_far.equation(f"lqr_stationarity.{u.name}_hat").rhs for u in controls}
    rates = [*so_far.rhs("first_order").xreplace(law), *(so_far.rhs("lqr_costates") / 2)]
    whole = matrix.xreplace(_values_of(so_far)) * sp.Matrix([*states, *(costate / 2 for costate in lam)])
    found, expected = numeric_matrix(sp.Matrix(whole)), numeric_matrix(sp.Matrix(rates))
    symbols = {*states, *lam} | whole.free_symbols | sp.Matrix(rates).free_symbols
    check = compare("canonical equations", symbols, lambda point: (entries([found(point)]), entries([expected(point)])))
    return Step(
        "lqr_hamiltonian_matrix",
        "canonical equations as a matrix",
        (Equation("coupling", ln.COUPLING, coupling), Equation("matrix", ln.HAMILTONIAN_MATRIX, matrix)),
        ("first_order", "lqr_stationarity", "lqr_costates"),
        (check,),
    )


def lqr_differential_riccati(so_far: Derivation) -> Step | None:
    """Derive the differential equation of P(t) from lambda = 2 P x."""
    if not _applies(so_far):
        return None
    rate = _operator(so_far)
    return Step(
        "lqr_differential_riccati",
        "costates linear in states",
        (Equation("riccati", ln.RICCATI_RATE, rate),),
        ("lqr_hamiltonian_matrix", "lqr_costates"),
        (_along_costates(so_far, rate), _completed_square(so_far, rate)),
    )


def lqr(so_far: Derivation) -> Step | None:
    """Derive the algebraic Riccati equation and the gain for an infinite horizon, if the system is stabilisable."""
    if not _applies(so_far):
        return None
    system, states, controls = _parts(so_far)
    if not stabilisable(system):
        return None
    p, r = ln.symmetric("P", states), ln.symmetric("R", controls)
    gain = sp.ImmutableMatrix((inverse(r) * system.b.T * p).applyfunc(factored))
    residual = so_far.equation("lqr_differential_riccati.riccati").rhs
    return Step(
        "lqr",
        "constant solution",
        (Equation("riccati", ln.RICCATI_RESIDUAL, residual), Equation("gain", ln.GAIN, gain)),
        ("lqr_differential_riccati", "lqr_stationarity"),
        (_invariant_subspace(so_far, residual, gain), _stationary_gain(so_far, gain)),
    )


def stabilisable(system: LinearSystem) -> bool:
    """Tell whether all uncontrollable modes certainly decay."""
    reach = controllability(spectrum(system.a), system.b)
    out_of_reach = system.a.rows - reach.rank
    return len(reach.lost) >= out_of_reach and all(sign_of(sp.re(m.eigenvalue)) == -1 for m in reach.lost)


def _applies(so_far: Derivation) -> bool:
    few = 1 <= len(so_far.model.controls) <= MOST_INPUTS and len(so_far.model.states) <= MOST_STATES
    return few and analysable(so_far) and any(entry != 0 for entry in system_of(so_far).b)


def _parts(so_far: Derivation) -> tuple[LinearSystem, tuple[sp.Symbol, ...], tuple[sp.Symbol, ...]]:
    model = so_far.model
    return system_of(so_far), symbols_of(model.states), symbols_of(model.controls)


def _with_cost(so_far: Derivation) -> Derivation:
    """Return the derivation with the quadratic cost as its problem, for the steps of the minimum principle."""
    _, states, controls = _parts(so_far)
    x, u = sp.Matrix(states), sp.Matrix(controls)
    cost = (x.T * ln.symmetric("Q", states) * x + u.T * ln.symmetric("R", controls) * u)[0]
    problem = Problem(name=so_far.name, title=so_far.title, model=so_far.model, running_cost=sp.expand(cost))
    steps = tuple(replace(s, name="hamiltonian") if s.name == "lqr_hamiltonian" else s for s in so_far.steps)
    return replace(so_far, problem=problem, steps=steps)


def _coupling(so_far: Derivation) -> sp.ImmutableMatrix:
    """Return S = B R^-1 B'."""
    system, _, controls = _parts(so_far)
    return _coupled(system.b, ln.symmetric("R", controls))


@lru_cache(maxsize=16)
def _coupled(b: sp.ImmutableMatrix, r: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    return sp.ImmutableMatrix((b * inverse(r) * b.T).applyfunc(factored))


def _named_coupling(so_far: Derivation) -> sp.ImmutableMatrix:
    """Return S with symbols for its entries, and zero where an entry is zero."""
    coupling, names = _coupling(so_far), ln.symmetric("S", symbols_of(so_far.model.states))
    size = coupling.rows
    return sp.ImmutableMatrix(size, size, lambda i, j: names[i, j] if coupling[i, j] != 0 else sp.Integer(0))


def _values_of(so_far: Derivation) -> dict[sp.Symbol, sp.Expr]:
    """Map the symbols of the entries of S to their values."""
    return {
        name: value for name, value in zip(_named_coupling(so_far), _coupling(so_far), strict=True) if name.is_Symbol
    }


def _operator(so_far: Derivation) -> sp.ImmutableMatrix:
    """Return the Riccati operator with symbols for the entries of S."""
    system, states, _ = _parts(so_far)
    q, p = ln.symmetric("Q", states), ln.symmetric("P", states)
    return sp.ImmutableMatrix(riccati_operator(system.a, _named_coupling(so_far), q, p).applyfunc(sp.expand))


def _along_costates(so_far: Derivation, rate: sp.ImmutableMatrix) -> Check:
    """Check d/dt (2 P x) against the costate equations."""
    _, states, controls = _parts(so_far)
    p, x = ln.symmetric("P", states), sp.Matrix(states)
    lam = dict(zip([n.costate_of(s) for s in states], 2 * p * x, strict=True))
    law = {u: so_far.equation(f"lqr_stationarity.{u.name}_hat").rhs.xreplace(lam) for u in controls}
    moving = 2 * (-rate.xreplace(_values_of(so_far)) * x + p * so_far.rhs("first_order").xreplace(law))
    stated = so_far.rhs("lqr_costates").xreplace(lam)
    found, expected = numeric_matrix(moving), numeric_matrix(stated)
    symbols = moving.free_symbols | stated.free_symbols
    return compare("costates along the motion", symbols, lambda at: (entries([found(at)]), entries([expected(at)])))


def _completed_square(so_far: Derivation, rate: sp.ImmutableMatrix) -> Check:
    """Check that x'Qx + u'Ru + d/dt (x'Px) is (u + Kx)'R(u + Kx) for any control.

    This is the Hamilton-Jacobi-Bellman equation.
    """
    system, states, controls = _parts(so_far)
    q, r, p = ln.symmetric("Q", states), ln.symmetric("R", controls), ln.symmetric("P", states)
    functions = [numeric_matrix(m) for m in (system.a, system.b, q, r, p, rate.xreplace(_values_of(so_far)))]
    vectors = [numeric_matrix(sp.Matrix(group)) for group in (states, controls)]

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        a, b, q_, r_, p_, falling = (f(point) for f in functions)
        x, u = (f(point) for f in vectors)
        spent = x.T * q_ * x + u.T * r_ * u - x.T * falling * x + 2 * x.T * p_ * (a * x + b * u)
        excess = u + mp.inverse(r_) * b.T * p_ * x
        return [spent[0]], [(excess.T * r_ * excess)[0]]

    symbols = {*states, *controls}.union(*(m.free_symbols for m in (system.a, system.b, q, r, p, rate)))
    symbols = {s for s in symbols if not s.name.startswith("S_")}
    return compare("completed square", symbols, sides)


def _invariant_subspace(so_far: Derivation, equation: sp.ImmutableMatrix, gain: sp.ImmutableMatrix) -> Check:
    """Check equation and gain at the solution given by the stable invariant subspace of the matrix M.

    Weights are drawn positive definite. The solution must also be symmetric and make A - B K stable.
    """
    system, states, controls = _parts(so_far)
    coupling, named, size = _values_of(so_far), ln.symmetric("P", states), len(states)
    matrix = so_far.equation("lqr_hamiltonian_matrix.matrix").rhs
    residual, whole, stated = (numeric_matrix(m.xreplace(coupling)) for m in (equation, matrix, gain))
    a, b, seed = numeric_matrix(system.a), numeric_matrix(system.b), sp.Dummy("weights", real=True)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        rng = random.Random(float(point[seed]))
        for letter, symbols in (("Q", states), ("R", controls)):
            point = point | _positive_definite(letter, symbols, rng)
        # (sign M + 1) vanishes on the stable subspace, which the columns of (1; P) span
        beyond = sign_function(whole(point)) + mp.eye(2 * size)
        left, right = beyond[:, size:], beyond[:, :size]
        p = -mp.inverse(left.T * left) * left.T * right
        point |= {named[i, j]: p[i, j] for i in range(size) for j in range(i, size)}
        closed = sign_function(a(point) - b(point) * stated(point))
        return entries([residual(point), p, closed]), entries([mp.zeros(size), p.T, -mp.eye(size)])

    return compare("invariant subspace", system.a.free_symbols | system.b.free_symbols | {seed}, sides)


def _stationary_gain(so_far: Derivation, gain: sp.ImmutableMatrix) -> Check:
    """Check -K x against the stationary control at lambda = 2 P x."""
    _, states, controls = _parts(so_far)
    x = sp.Matrix(states)
    lam = dict(zip([n.costate_of(s) for s in states], 2 * ln.symmetric("P", states) * x, strict=True))
    hats = [so_far.equation(f"lqr_stationarity.{u.name}_hat").rhs.xreplace(lam) for u in controls]
    law = -gain * x
    found, expected = numeric(list(law)), numeric(hats)
    symbols = law.free_symbols.union(*(hat.free_symbols for hat in hats))
    return compare("stationary gain", symbols, lambda point: (found(point), expected(point)))


def _positive_definite(letter: str, symbols: tuple[sp.Symbol, ...], rng: random.Random) -> Point:
    """Draw the entries of a random positive definite matrix."""
    size = len(symbols)
    root = mp.matrix([[rng.uniform(-1, 1) for _ in range(size)] for _ in range(size)])
    drawn, named = root * root.T + mp.eye(size), ln.symmetric(letter, symbols)
    return {named[i, j]: drawn[i, j] for i in range(size) for j in range(i, size)}
