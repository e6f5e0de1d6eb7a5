"""Functions of problems whose Hamiltonian is linear in the controls, and of their regularised problem.

The exact law jumps, so the canonical system is generated for the regularised problem, whose law is continuous. Its cost
has ``smoothing / 2`` times the squared controls in addition, and only a fraction of the weights of magnitudes. Both
numbers follow the bounds of the box in ``bounds``; with a vanishing smoothing (1e-200, say) and a fraction of one it is
the problem itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from satsym.spec import names
from satsym.symbolic import notation as n
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.model import symbols_of
from satsym.symbolic.principle.pontryagin import costates
from satsym.symbolic.switching import curve as switching_curve
from satsym.symbolic.switching.functions import parts, written_out
from satsym.symbolic.switching.notation import BEYOND_CURVE, ON_CURVE, SIDE, TRANSITION

STEP = "switching_function"
"""The name of the step that only derivations with a Hamiltonian linear in the controls have."""


def switches(derivation: Derivation) -> bool:
    """Tell whether the Hamiltonian is linear in the controls and their magnitudes."""
    return STEP in derivation


@dataclass(frozen=True)
class Entry:
    """A function of one point in time: name, summary, arguments, value, names of the outputs."""

    name: str
    summary: str
    arguments: str
    value: sp.Matrix
    hints: tuple[str, ...] = ()


def vectors(derivation: Derivation) -> list[Entry]:
    """Return switching functions, their rates, weights of magnitudes and the exact law, by control."""
    found = parts(derivation)
    controls = names(derivation.model.controls)
    rates = [derivation.equation(f"switching_rate.{u}").rhs for u in controls]
    return [
        Entry("switching_function", "The coefficient of each control in H.", "t x lam p", sp.Matrix(found.switching)),
        Entry(
            "switching_rate",
            "Rates of change of the switching functions along an extremal.",
            "t x u lam p",
            sp.Matrix(rates),
        ),
        Entry("magnitude_weight", "The coefficient of each |u| in H.", "t x lam p", sp.Matrix(found.weights)),
        Entry(
            "control_law",
            "The controls that minimise H over the box.",
            "t x lam p bounds",
            sp.Matrix(written_out(derivation, derivation.rhs("control_law"))),
            controls,
        ),
    ]


def curve(derivation: Derivation) -> list[Entry]:
    """Return the functions of a switching curve: the law of the state, and changes of position from rest."""
    steps = (switching_curve.CURVE, switching_curve.FEEDBACK, switching_curve.RESTS)
    if switching_curve.CURVE not in derivation:
        return []
    arguments, (control,) = "t x p bounds final", names(derivation.model.controls)
    stated = {e.name: e.rhs for name in steps for e in derivation.step(name).equations}
    beyond = stated["beyond"].xreplace({ON_CURVE: stated["curve"]})
    law = stated[control].xreplace({SIDE: stated["side"]}).xreplace({BEYOND_CURVE: beyond})
    first = stated["first"].xreplace({TRANSITION: stated["duration"]})
    return [
        Entry(
            "beyond_switching_curve",
            "Distance of the position from the switching curve for minimum time.",
            arguments,
            sp.Matrix([beyond]),
        ),
        Entry(
            "feedback_law",
            "The minimum-time controls, by the side of the switching curve on which the state lies.",
            arguments,
            sp.Matrix([law]),
            (control,),
        ),
        Entry(
            "transition_time",
            "Duration of the change of position from rest to rest.",
            arguments,
            sp.Matrix([stated["duration"]]),
        ),
        Entry("first_arc_time", "Duration of the first arc of this change of position.", arguments, sp.Matrix([first])),
    ]


def extremal_jacobian(derivation: Derivation) -> sp.Matrix:
    """Return derivatives of the rates of states and costates by these, under constant controls."""
    z = [*symbols_of(derivation.model.states), *costates(derivation)]
    return sp.Matrix([*derivation.rhs("first_order"), *derivation.rhs("costate_equations")]).jacobian(z)


@dataclass(frozen=True)
class Regularised:
    """The regularised problem under its law: rates of states and costates, and its Hamiltonian."""

    rates: sp.Matrix
    hamiltonian: sp.Expr


def regularised(derivation: Derivation) -> Regularised:
    """Return the regularised problem of a switching problem."""
    controls = symbols_of(derivation.model.controls)
    stated = {e.name: e.rhs for e in derivation.step("smoothed_law").equations}
    h, *laws = written_out(derivation, [stated["H"], *(stated[u.name] for u in controls)])
    h = h.xreplace({n.HAMILTONIAN: derivation.equation("hamiltonian.H").rhs})
    law = dict(zip(controls, laws, strict=True))
    costate_rates = [-sp.diff(h, x) for x in symbols_of(derivation.model.states)]
    beside = h - derivation.equation("hamiltonian.H").rhs  # of magnitudes in the motion, too, only a share counts
    state_rates = [
        rate + sp.diff(beside, costate)
        for rate, costate in zip(derivation.rhs("first_order"), costates(derivation), strict=True)
    ]
    rates = sp.Matrix([*state_rates, *costate_rates])
    return Regularised(rates.xreplace(law), h.xreplace(law))
