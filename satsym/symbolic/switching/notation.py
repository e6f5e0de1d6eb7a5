"""Symbols of problems whose Hamiltonian is linear in the controls, with their LaTeX."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic.algebra import depends
from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over
from satsym.symbolic.model import Model, Problem, symbols_of
from satsym.symbolic.notation import named

UNSWITCHED = sp.Symbol("H_0", real=True)
"""The part of H that does not contain the controls."""

SMOOTHING = sp.Symbol("smoothing", positive=True)
"""The weight of u^2 / 2 in the regularised problem."""

MAGNITUDE_FACTOR = sp.Symbol("magnitude_share", real=True)
"""The factor of the weights of magnitudes in the regularised problem."""

REGULARISED = (
    Variable(SMOOTHING.name, r"\varepsilon", meaning="weight of u^2 / 2 in the regularised problem", positive=True),
    Variable(MAGNITUDE_FACTOR.name, r"\kappa", meaning="factor of the weights of magnitudes in it"),
)
"""Parameters that follow the bounds of the box in the ``bounds`` argument of the kernels of a switching problem."""

SMOOTHED = sp.Symbol("H_smoothed", real=True)
"""The Hamiltonian of the regularised problem."""

ON_CURVE = sp.Symbol("position_on_switching_curve", real=True)
"""Position coordinate of the switching curve at a given rate."""

BEYOND_CURVE = sp.Symbol("beyond_switching_curve", real=True)
"""Distance of the position beyond the switching curve, with sign."""

SIDE = sp.Symbol("side_of_switching_curve", real=True)
"""The side of the switching curve on which a state lies, or the sign of its arc if it lies on the curve."""

TRANSITION, FIRST_ARC = sp.Symbol("transition_time", positive=True), sp.Symbol("first_arc_time", positive=True)
"""Durations of the fastest change of position from rest to rest, and of its first arc."""
switching_of = named("switching_{}")
"""The switching function of a control, its factor in the Hamiltonian."""


def derivative_of(control: sp.Symbol, order: int, suffix: str = "") -> sp.Symbol:
    """Return the symbol of a time derivative of a switching function."""
    return sp.Symbol(f"switching_{control.name}{suffix}_{order}", real=True)


weight_of = named("magnitude_weight_{}")
"""The weight of a control's magnitude in the cost."""
smoothed = named("{}_smoothed")
"""The symbol for a control of the regularised problem."""


def singular(control: sp.Symbol, suffix: str = "") -> sp.Symbol:
    """Return the symbol of a control on a singular arc."""
    return sp.Symbol(f"{control.name}_singular{suffix}", real=True)


def kelley(control: sp.Symbol, suffix: str = "") -> sp.Symbol:
    """Return the symbol that must not be negative on a singular arc (not positive where H is maximised)."""
    return sp.Symbol(f"kelley_{control.name}{suffix}", real=True)


drift_bracket = named("bracket_H_0_{}")
"""The Poisson bracket of H_0 and the switching function."""


def bracket(by: sp.Symbol, control: sp.Symbol) -> sp.Symbol:
    """Return the symbol of the Poisson bracket of the switching functions of two controls."""
    return sp.Symbol(f"bracket_{by.name}_{control.name}", real=True)


def weight_bracket(by: sp.Symbol, control: sp.Symbol) -> sp.Symbol:
    """Return the symbol of the Poisson bracket of one control's weight and another's switching function."""
    return sp.Symbol(f"bracket_weight_{by.name}_{control.name}", real=True)


def magnitudes(controls: Sequence[sp.Symbol]) -> dict[sp.Expr, sp.Symbol]:
    """Map each |u| to a symbol of its own."""
    return {sp.Abs(u): sp.Dummy(f"magnitude_{u.name}", real=True) for u in controls}


def is_affine(expressions: Sequence[sp.Expr], controls: Sequence[sp.Symbol]) -> bool:
    """Tell whether expressions are affine in the controls and their magnitudes."""
    stands_for = magnitudes(controls)
    entries = [*controls, *stands_for.values()]
    for expression in expressions:
        plain = sp.sympify(expression).xreplace(stands_for)
        slopes = [sp.diff(plain, v) for v in entries]
        if any(depends(slope, entries) for slope in slopes):
            return False
    return True


def constants(model: Model) -> list[str]:
    """Return the names of factors that are printed before costates and controls."""
    return [SMOOTHING.name, MAGNITUDE_FACTOR.name, *(weight_of(u).name for u in symbols_of(model.controls))]


BRANCHES = ("", "_positive", "_negative")
"""Suffixes of singular arcs: of a control without weight on its magnitude, and of positive and negative values of one
with a weight."""


def names(problem: Problem) -> dict[str, str]:
    """Map the names that the derivation of a switching problem may introduce to LaTeX.

    Empty where the running cost already shows that the Hamiltonian is not linear in the controls.
    """
    model = problem.model
    controls = symbols_of(model.controls)
    if not is_affine([problem.running_cost], controls):
        return {}
    latex = {u: v.latex for u, v in zip(controls, model.controls, strict=True)}
    sigma = {u: rf"\sigma_{{{tex}}}" if len(controls) > 1 else r"\sigma" for u, tex in latex.items()}
    weight = {u: rf"w_{{{tex}}}" if len(controls) > 1 else "w" for u, tex in latex.items()}
    found = {UNSWITCHED.name: "H_0", SMOOTHED.name: r"H_\varepsilon"} | {v.symbol: v.latex for v in REGULARISED}
    found |= {ON_CURVE.name: r"x_{\mathrm{c}}", BEYOND_CURVE.name: r"\Delta", SIDE.name: "s"}
    found |= {TRANSITION.name: "D", FIRST_ARC.name: "D_1"}
    marks = dict(zip(BRANCHES, ("", "+", "-"), strict=True))
    for u in controls:
        found[switching_of(u).name], found[weight_of(u).name] = sigma[u], weight[u]
        found[f"d_{switching_of(u).name}"] = _dotted(sigma[u], 1)
        found[smoothed(u).name] = rf"{latex[u]}^{{\varepsilon}}"
        found[drift_bracket(u).name] = rf"\{{H_0, {sigma[u]}\}}"
        for by in controls:
            found[bracket(by, u).name] = rf"\{{{sigma[by]}, {sigma[u]}\}}"
            found[weight_bracket(by, u).name] = rf"\{{{weight[by]}, {sigma[u]}\}}"
        for branch, mark in marks.items():
            found[singular(u, branch).name] = rf"{latex[u]}^{{\mathrm{{s}}{mark}}}"
            index = f"_{{{latex[u]}}}" if len(controls) > 1 else ""
            found[kelley(u, branch).name] = f"K{index}" + (f"^{mark}" if mark else "")
            for order in range(1, 2 * len(model.states) + 1):
                found[derivative_of(u, order, branch).name] = _dotted(sigma[u], order, mark)
    return found


def _dotted(sigma: str, order: int, mark: str = "") -> str:
    """Return the LaTeX of a time derivative, with dots as long as these are readable."""
    head, _, index = sigma.partition("_")
    index = f"_{index}" if index else ""
    if order <= 2:
        return rf"\{'d' * order}ot{head}{index}" + (f"^{mark}" if mark else "")
    return rf"{head}{index}^{{{mark}({order})}}"


def declare(known: dict[str, Dimension | None], problem: Problem, running: Dimension | None) -> None:
    """Enter the dimensions of switching functions, weights and smoothed or singular controls.

    Parameters
    ----------
    known
        Dimensions of declared variables, which are added to.
    problem
        Anything is entered only where its running cost is affine in the controls.
    running
        Dimension of the running cost.
    """
    if not names(problem):
        return
    controls = symbols_of(problem.model.controls)
    known[MAGNITUDE_FACTOR.name] = PLAIN
    known[UNSWITCHED.name] = known[SMOOTHED.name] = running
    for u in controls:
        known[switching_of(u).name] = known[weight_of(u).name] = over(running, known[u.name])
        known[smoothed(u).name] = known[u.name]
        known.update({singular(u, branch).name: known[u.name] for branch in BRANCHES})
    efforts = [over(over(running, known[u.name]), known[u.name]) for u in controls]
    # one number smooths all controls: where their units differ it has none that would suit them all
    known[SMOOTHING.name] = efforts[0] if all(e == efforts[0] for e in efforts) else None
