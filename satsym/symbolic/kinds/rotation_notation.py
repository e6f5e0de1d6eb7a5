"""Names and LaTeX of what gyrostats, scaled motions and closed loops bring."""

from __future__ import annotations

import sympy as sp

from satsym.symbolic.kinds.rotation_models import COMMAND, ClosedLoop, Gyrostat, Reduced, Scaled, s
from satsym.symbolic.model import Model, symbols_of

ORIGINAL_TIME = sp.Symbol("original_t", real=True)
POLYNOMIAL = sp.Symbol("closed_loop_polynomial", real=True)
FIRST_REACHED, HIGHEST_AT = sp.Symbol("first_reached", real=True), sp.Symbol("highest_at", real=True)
OVERSHOOT, TOTAL_IMPULSE = sp.Symbol("overshoot", real=True), sp.Symbol("total_impulse", real=True)
SMOOTH_SQUARE = sp.Symbol("smooth_square", real=True)
POTENTIAL, REDUCED_COST = sp.Symbol("cost_potential", real=True), sp.Symbol("reduced_cost", real=True)
LEAST_COST, COST_FROM_REST = sp.Symbol("least_cost", real=True), sp.Symbol("cost_from_rest", real=True)
_OF_LOOPS = {
    COMMAND: "c",
    s: "s",
    POLYNOMIAL: r"\Delta(s)",
    FIRST_REACHED: "t_1",
    HIGHEST_AT: "t_2",
    OVERSHOOT: "o",
    TOTAL_IMPULSE: r"\mathcal{I}",
    SMOOTH_SQUARE: r"\mathcal{Q}",
}


def momentum_of(body: str) -> sp.Symbol:
    """The symbol for the angular momentum of a body."""
    return sp.Symbol(f"h_{body}", real=True)


def transfer_to(variable: sp.Symbol) -> sp.Symbol:
    """The symbol for the transfer function from the command to a state or the control."""
    return sp.Symbol(f"transfer_{variable.name}", real=True)


def answer_of(variable: sp.Symbol) -> sp.Symbol:
    """The symbol for a state or the control as a function of time after the step."""
    return sp.Symbol(f"{variable.name}_answer", real=True)


def impulse_of(control: sp.Symbol) -> sp.Symbol:
    """The symbol for the time integral of a control at the very moment of the step."""
    return sp.Symbol(f"{control.name}_impulse", real=True)


def final_of(state: sp.Symbol) -> sp.Symbol:
    """The symbol for what a state tends to."""
    return sp.Symbol(f"{state.name}_final", real=True)


def reduced_costate_of(state: sp.Symbol) -> sp.Symbol:
    """The symbol for the costate of a state when the exact part of the cost is left out."""
    return sp.Symbol(f"reduced_lambda_{state.name}", real=True)


def peak_of(control: sp.Symbol) -> sp.Symbol:
    """The symbol for the largest magnitude of a control."""
    return sp.Symbol(f"{control.name}_peak", real=True)


def of_effort(model: Model) -> dict[str, str]:
    """Name -> LaTeX of what costs that are an effort bring."""
    found = {POTENTIAL.name: "V", REDUCED_COST.name: "L_0", LEAST_COST.name: "J_0", COST_FROM_REST.name: "J_0"}
    found |= {f"reduced_lambda_{v.symbol}": rf"\mu_{{{v.latex}}}" for v in model.states}
    for v in model.controls:
        found |= {f"{v.symbol}_peak": rf"|{v.latex}|_{{\max}}", f"{v.symbol}_answer": rf"{v.latex}(t)"}
    return found


def pole(k: int) -> sp.Symbol:
    """The symbol for a pole."""
    return sp.Symbol(f"pole_{k}", real=True)


def zero(k: int) -> sp.Symbol:
    """The symbol for a zero."""
    return sp.Symbol(f"zero_{k}", real=True)


def names(model: Model) -> dict[str, str]:
    """Name -> LaTeX of all that such a model brings."""
    if isinstance(model, Gyrostat):
        return {momentum_of(body).name: rf"h_{{\mathrm{{{body}}}}}" for body in model.bodies} | {
            "d_angular_momentum": r"\frac{d\ell}{dt}"
        }
    if isinstance(model, Scaled):
        latex = {v.symbol: v.latex for v in (*model.of.states, *model.states)}
        rates = {f"d_{v.symbol}": rf"\frac{{d {latex[v.symbol]}}}{{dt}}" for v in model.of.states}
        new = {f"d_{v.symbol}": rf"\frac{{d {v.latex}}}{{d\tau}}" for v in model.states}
        return rates | new | {"t": r"\tau", "t_f": r"\tau_f", ORIGINAL_TIME.name: "t"}
    if isinstance(model, Reduced):
        return {f"d_{v.symbol}": rf"\frac{{d {v.latex}}}{{dt}}" for v in model.of.states}
    if not isinstance(model, ClosedLoop):
        return {}
    found = {symbol.name: latex for symbol, latex in _OF_LOOPS.items()}
    found |= {pole(k).name: f"s_{k}" for k in (1, 2)} | {zero(k).name: f"z_{k}" for k in (1, 2)}
    for v, symbol in zip(
        (*model.states, *model.of.controls), symbols_of((*model.states, *model.of.controls)), strict=True
    ):
        found[transfer_to(symbol).name] = rf"G_{{{v.latex}}}(s)"
        found[answer_of(symbol).name] = rf"{v.latex}(t)"
        found[final_of(symbol).name] = rf"{v.latex}(\infty)"
        found[f"{symbol.name}_0"] = rf"{v.latex}(0^+)"
        found[impulse_of(symbol).name] = rf"\int_{{0^-}}^{{0^+}} {v.latex} \,dt"
    return found
