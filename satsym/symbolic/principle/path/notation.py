"""Symbols of path constraints, with their LaTeX."""

from __future__ import annotations

import sympy as sp

from satsym.symbolic.dimension_algebra import Dimension, over
from satsym.symbolic.model import Problem, Requirement, symbols_of
from satsym.symbolic.notation import HAMILTONIAN, costate_of
from satsym.symbolic.principle.parts import parts_of


def of_states(problem: Problem) -> dict[str, sp.Expr]:
    """Return the path constraints on states alone."""
    return {name: g for name, g in _declared(problem).items() if not _holds_control(problem, g)}


def mixed(problem: Problem, with_bounds: bool = True) -> dict[str, sp.Expr]:
    """Return the path constraints that contain a control, and bounds of a box beside other constraints."""
    found = {name: g for name, g in _declared(problem).items() if _holds_control(problem, g)}
    return found | ({b.name: h for b, h in _bounds(problem).items()} if with_bounds else {})


def holds_controls(problem: Problem) -> bool:
    """Tell whether a path constraint contains a control, apart from bounds."""
    return any(_holds_control(problem, g) for g in _declared(problem).values())


def _declared(problem: Problem) -> dict[str, sp.Expr]:
    return {name: sp.sympify(g) for name, g in problem.path_constraints.items()}


def _holds_control(problem: Problem, g: sp.Expr) -> bool:
    return bool(g.free_symbols & set(symbols_of(problem.model.controls)))


def _bounds(problem: Problem) -> dict[sp.Symbol, sp.Expr]:
    if not (problem.path_constraints or problem.interior):
        return {}
    found: dict[sp.Symbol, sp.Expr] = {}
    for part in parts_of(problem):
        if part.kind == "box":
            low, high = part.bounds[: len(part.symbols)], part.bounds[len(part.symbols) :]
            found |= {b: b - u for b, u in zip(low, part.symbols, strict=True)}
            found |= {b: u - b for b, u in zip(high, part.symbols, strict=True)}
    return found


HIGHEST = 2
"""Highest order of a constraint that is solved; those of higher order usually have infinitely many junctions."""


def entry(name: str, order: int) -> str:
    """Return the name of the equation for a time derivative of a constraint."""
    return f"{name}_{order}" if order else name


def vanishing_entry(name: str, order: int) -> str:
    """Return the name of the equation for a quantity that vanishes on the boundary."""
    return f"{name}_vanishing_{order}" if order else f"{name}_vanishing"


def rate(name: str, order: int) -> sp.Symbol:
    """Return the symbol for a time derivative of a constraint; of order 0, for the constraint itself."""
    return sp.Symbol(f"constraint_{entry(name, order)}", real=True)


def vanishing(name: str, order: int) -> sp.Symbol:
    """Return the symbol for the last time derivative of a constraint under the law, or for its derivative."""
    return sp.Symbol(f"constraint_{vanishing_entry(name, order)}", real=True)


def multiplier(name: str) -> sp.Symbol:
    """Return the symbol for the multiplier of a constraint."""
    return sp.Symbol(f"eta_{name}", real=True)


def jump(name: str) -> sp.Symbol:
    """Return the symbol for the multiplier of a constraint at a junction."""
    return sp.Symbol(f"zeta_{name}", real=True)


def change(of: sp.Symbol) -> sp.Symbol:
    """Return the symbol for the value of a quantity before a junction less the value after it."""
    return sp.Symbol(f"change_of_{of.name}", real=True)


def boundary_control(name: str, control: sp.Symbol) -> sp.Symbol:
    """Return the symbol for a control on the boundary of a constraint."""
    return sp.Symbol(f"{control.name}_on_{name}", real=True)


def control_rate(name: str, control: sp.Symbol) -> sp.Symbol:
    """Return the symbol for the rate of a control on the boundary of a constraint."""
    return sp.Symbol(f"rate_of_{control.name}_on_{name}", real=True)


def names(problem: Problem, with_bounds: bool = True) -> dict[str, str]:
    """Map the names of all symbols of path constraints to LaTeX, numbered if there are several constraints.

    Bounds that are part of the law are left out.
    """
    if not (every := of_states(problem) | mixed(problem, with_bounds)):
        return {}
    found = {change(HAMILTONIAN).name: r"H(t^-) - H(t^+)"}
    for v in problem.model.states:
        lam = rf"\lambda_{{{v.latex}}}"
        found[change(costate_of(symbols_of((v,))[0])).name] = rf"{lam}(t^-) - {lam}(t^+)"
    for k, name in enumerate(every, start=1):
        several = len(every) > 1
        foot = f"_{{{k}}}" if several else ""
        found |= {rate(name, order).name: rf"{dots}\Gamma{foot}" for order, dots in enumerate(("", r"\dot", r"\ddot"))}
        found |= {vanishing(name, order).name: rf"{dots}\varphi{foot}" for order, dots in enumerate(("", r"\dot"))}
        found |= {multiplier(name).name: rf"\eta{foot}", jump(name).name: rf"\zeta{foot}"}
        for v in problem.model.controls:
            (u,) = symbols_of((v,))
            found[boundary_control(name, u).name] = rf"{v.latex}^{{\mathrm{{b}}{foot}}}"
            found[control_rate(name, u).name] = rf"\frac{{d {v.latex}}}{{dt}}"
    return found


def declare(
    known: dict[str, Dimension | None],
    problem: Problem,
    second: Dimension | None,
    total: Dimension | None,
    require: Requirement,
) -> None:
    """Enter the dimensions of all symbols of path constraints.

    Parameters
    ----------
    second, total
        Of time and of the cost.
    """
    for name, stated in (of_states(problem) | mixed(problem)).items():
        found = require(f"the path constraint {name}", stated)
        known[rate(name, 0).name] = found
        known[rate(name, 1).name] = over(found, second)
        known[rate(name, 2).name] = over(over(found, second), second)
        known[jump(name).name] = over(total, found)
        known[multiplier(name).name] = over(over(total, found), second)
        for control in symbols_of(problem.model.controls):
            known[boundary_control(name, control).name] = known[control.name]
            known[control_rate(name, control).name] = over(known[control.name], second)
    if problem.path_constraints:
        known[change(HAMILTONIAN).name] = known[HAMILTONIAN.name]
        for state in symbols_of(problem.model.states):
            known[change(costate_of(state)).name] = known[costate_of(state).name]
