"""Symbols of derivations, and the LaTeX of those that every derivation has."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic.model import Problem

TIME, FINAL_TIME = sp.Symbol("t", real=True), sp.Symbol("t_f", real=True)
HAMILTONIAN, MINIMISED = sp.Symbol("H", real=True), sp.Symbol("H_star", real=True)
POSITION, VELOCITY, ACCELERATION, FORCE = (sp.Symbol(f"{name}_vector") for name in ("r", "v", "a", "F"))
DISTANCE = sp.Symbol("r_norm", positive=True)
OUTER, IDENTITY = sp.Symbol("r_outer"), sp.Symbol("identity")
JACOBIAN, GRADIENT = sp.Symbol("jacobian_blocks"), sp.Symbol("gravity_gradient")
PULL, SPEED = sp.Symbol("a_norm", positive=True), sp.Symbol("v_norm", positive=True)
ALONG, MOMENTUM = sp.Symbol("r_along_v", real=True), sp.Symbol("angular_momentum_norm", positive=True)
ECCENTRICITY_VECTOR, ECCENTRICITY = sp.Symbol("eccentricity_vector"), sp.Symbol("eccentricity", positive=True)
ECCENTRICITY_ALONG = sp.Symbol("eccentricity_along_r", real=True)
RUNNING_COST, TERMINAL_COST = sp.Symbol("L", real=True), sp.Symbol("S", real=True)
RESIDUAL_TIME = sp.Symbol("residual_t_f", real=True)
ENERGY, ANGULAR_MOMENTUM = sp.Symbol("energy", real=True), sp.Symbol("angular_momentum", real=True)
JACOBI_INTEGRAL = sp.Symbol("jacobi_integral", real=True)
AXES = ("x", "y", "z")
"""Names of inertial components, in the order of the position vector."""


def named(pattern: str) -> Callable[[sp.Symbol], sp.Symbol]:
    """Return a family of symbols, one for each other symbol, with names by a pattern."""
    return lambda of: sp.Symbol(pattern.format(of.name), real=True)


def component_of_angular_momentum(axis: str) -> sp.Symbol:
    """Return the symbol for the angular momentum about an inertial axis."""
    return sp.Symbol(f"angular_momentum_{axis}", real=True)


FIXED = {
    TIME: "t",
    FINAL_TIME: r"t_f",
    HAMILTONIAN: "H",
    MINIMISED: "H^*",
    POSITION: r"\mathbf{r}",
    VELOCITY: r"\mathbf{v}",
    ACCELERATION: r"\mathbf{a}",
    FORCE: r"\mathbf{F}",
    DISTANCE: r"|\mathbf{r}|",
    OUTER: r"\mathbf{r} \mathbf{r}^{\mathsf{T}}",
    IDENTITY: "I",
    JACOBIAN: "A",
    GRADIENT: "G",
    PULL: r"|\mathbf{a}|",
    SPEED: r"|\mathbf{v}|",
    ALONG: r"(\mathbf{r} \cdot \mathbf{v})",
    MOMENTUM: r"|\boldsymbol{\ell}|",
    ECCENTRICITY_VECTOR: r"\mathbf{e}",
    ECCENTRICITY: r"|\mathbf{e}|",
    ECCENTRICITY_ALONG: r"\mathbf{e} \cdot \mathbf{r}",
    RUNNING_COST: "L",
    TERMINAL_COST: "S",
    RESIDUAL_TIME: r"\mathcal{B}_{t_f}",
    ENERGY: r"\mathcal{E}",
    ANGULAR_MOMENTUM: r"\ell",
    JACOBI_INTEGRAL: r"\mathcal{J}",
    **{component_of_angular_momentum(axis): rf"\ell_{axis}" for axis in AXES},
}


_LETTER_AND_INDEX = re.compile(r"(\\[A-Za-z]+|[A-Za-z])_(?:\{([^{}]*)\}|(\w))")


def indexed(latex: str, index: str) -> str:
    """Return LaTeX with one more index, which joins an index that is there: x_{1,0}."""
    found = _LETTER_AND_INDEX.fullmatch(latex)
    return rf"{found[1]}_{{{found[2] or found[3]},{index}}}" if found else rf"{{{latex}}}_{index}"


def accented(accent: str, latex: str) -> str:
    """Return LaTeX with an accent over the letter but not over its index."""
    found = _LETTER_AND_INDEX.fullmatch(latex)
    return rf"\{accent}{{{found[1]}}}_{{{found[2] or found[3]}}}" if found else rf"\{accent}{{{latex}}}"


def barred(latex: str) -> str:
    """Return LaTeX with a bar over the letter."""
    return accented("bar", latex)


_DRESS = re.compile(r"[{}\s]|\\(?:d*dot|bar|hat|tilde|math[a-z]+|boldsymbol)(?![a-z])")
_LETTER = re.compile(r"\\[A-Za-z]+|[A-Za-z]")


def letter_of(latex: str) -> str:
    """Return the letter of a symbol's LaTeX, without accents and indices."""
    found = _LETTER.search(_DRESS.sub(" ", latex))
    return found[0] if found else ""


def free_letter(letters: Iterable[str], variables: Iterable[Variable]) -> str:
    """Return the first of some letters, in order of preference, that no variable has; else the last."""
    taken, letter = {letter_of(v.latex) for v in variables}, ""
    for letter in letters:
        if letter not in taken:
            break
    return letter


rate_of = named("d_{}")
"""The symbol for dx/dt."""
costate_of = named("lambda_{}")
"""The symbol for the costate of a state."""
acceleration_of = named("{}_ddot")
"""The symbol for the second time derivative of a coordinate."""
solved = named("solved_{}")
"""The symbol for the time derivative of a velocity that is given by a linear system instead of a formula."""
optimal = named("{}_star")
"""The symbol for the value of a control that minimises H."""
unconstrained = named("{}_hat")
"""The symbol for the value of a control at which H_u vanishes."""
given = named("given_{}")
"""The number that is one where the final value of a state is given, and zero elsewhere."""
on_reference = named("on_reference_{}")
"""The number that is one where a state ends on its reference, and zero elsewhere."""
target = named("target_{}")
"""The given final value of a state."""


def is_solved(expression: sp.Expr) -> bool:
    """Tell whether an expression is a symbol of the kind that :func:`solved` returns."""
    return bool(expression.is_Symbol) and expression.name.startswith("solved_")


def multipliers(problem: Problem) -> tuple[sp.Symbol, ...]:
    """Return the multipliers of terminal constraints and inequalities."""
    return tuple(sp.Symbol(f"nu_{k}", real=True) for k in range(1, len(problem.end_conditions) + 1))


residual_of = named("residual_{}")
"""The symbol for the boundary residual of a state, a terminal constraint or the final time."""
initial = named("{}_0")
"""The symbol for the given initial value of a state."""
answer_of = named("{}_answer")
"""The symbol for a state or a control as a function of time."""
