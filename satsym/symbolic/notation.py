"""Which symbols a derivation uses, and how those are typeset that every derivation has."""

from __future__ import annotations

import sympy as sp

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


def component_of_angular_momentum(axis: str) -> sp.Symbol:
    """The symbol for the angular momentum about an inertial axis."""
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
    RESIDUAL_TIME: "B_{t_f}",
    ENERGY: r"\mathcal{E}",
    ANGULAR_MOMENTUM: r"\ell",
    JACOBI_INTEGRAL: r"\mathcal{J}",
    **{component_of_angular_momentum(axis): rf"\ell_{axis}" for axis in AXES},
}


def symbol(name: str, latex: str, notation: dict[str, str]) -> sp.Symbol:
    """A real symbol, entered into the notation."""
    notation[name] = latex
    return sp.Symbol(name, real=True)


def rate_of(state: sp.Symbol) -> sp.Symbol:
    """The symbol for dx/dt."""
    return sp.Symbol(f"d_{state.name}", real=True)


def costate_of(state: sp.Symbol) -> sp.Symbol:
    """The symbol for the costate of a state."""
    return sp.Symbol(f"lambda_{state.name}", real=True)


def acceleration_of(coordinate: sp.Symbol) -> sp.Symbol:
    """The symbol for the second time derivative of a coordinate."""
    return sp.Symbol(f"{coordinate.name}_ddot", real=True)


def optimal(control: sp.Symbol) -> sp.Symbol:
    """The symbol for the value of a control that minimises H."""
    return sp.Symbol(f"{control.name}_star", real=True)


def unconstrained(control: sp.Symbol) -> sp.Symbol:
    """The symbol for the value of a control at which H_u vanishes."""
    return sp.Symbol(f"{control.name}_hat", real=True)


def given(state: sp.Symbol) -> sp.Symbol:
    """One where the final value of a state is given, else zero."""
    return sp.Symbol(f"given_{state.name}", real=True)


def on_reference(state: sp.Symbol) -> sp.Symbol:
    """One where a state ends on its reference, else zero."""
    return sp.Symbol(f"on_reference_{state.name}", real=True)


def target(state: sp.Symbol) -> sp.Symbol:
    """The given final value of a state."""
    return sp.Symbol(f"target_{state.name}", real=True)


def multipliers(problem: Problem) -> tuple[sp.Symbol, ...]:
    """The multipliers of the terminal constraints."""
    return tuple(sp.Symbol(f"nu_{k}", real=True) for k in range(1, len(problem.terminal_constraints) + 1))


def residual_of(symbol: sp.Symbol) -> sp.Symbol:
    """The symbol for the boundary residual of a state, a terminal constraint or the final time."""
    return sp.Symbol(f"residual_{symbol.name}", real=True)


def initial(state: sp.Symbol) -> sp.Symbol:
    """The symbol for the given initial value of a state."""
    return sp.Symbol(f"{state.name}_0", real=True)


def answer_of(variable: sp.Symbol) -> sp.Symbol:
    """The symbol for a state or a control as a function of time."""
    return sp.Symbol(f"{variable.name}_answer", real=True)
