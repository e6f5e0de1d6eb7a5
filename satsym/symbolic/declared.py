"""What a derivation file may state: misfits, undeclared and misplaced symbols are refused before any step."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, get_args

import sympy as sp

from satsym.spec import ControlSetKind
from satsym.symbolic.algebra import constants_of
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.model import Model, Problem, symbols_of
from satsym.wording import shown


def refuse_misfits(model: Model, problem: Problem | None) -> None:
    """Refuse declarations that do not fit together: states, rates, references, sizes of vectors.

    Raises
    ------
    DerivationError
        At the first of them.
    """
    for complaint in model.misfits():
        raise DerivationError(f"{model.name}: {complaint}")
    states = symbols_of(model.states)
    if model.reference and set(states) != set(model.reference):
        odd = sorted(s.name for s in set(states) ^ set(model.reference))
        raise DerivationError(
            f"{model.name}: the reference must have one curve for each state; look at {', '.join(odd)}"
        )
    if problem and problem.control_set not in get_args(ControlSetKind):
        kinds = " or ".join(f'"{kind}"' for kind in get_args(ControlSetKind))
        raise DerivationError(f"{problem.name}: control_set: got {shown(problem.control_set)}; write {kinds}")
    if problem and not model.controls:
        raise DerivationError(f"{problem.name}: the model has no controls, so there is nothing to optimise")


def refuse_foreign_symbols(derivation: Derivation) -> None:
    """Refuse expressions with symbols that were not declared, or that cannot stand there.

    Raises
    ------
    DerivationError
        At the first of them.
    """
    model, problem = derivation.model, derivation.problem
    parameters, constants = set(symbols_of(model.parameters)), constants_of(model)
    motion = constants | set(symbols_of(model.states))
    everything = motion | set(symbols_of(model.controls))

    def refuse(what: str, expressions: Iterable[Any], allowed: set[sp.Symbol]) -> None:
        foreign = set().union(*(sp.sympify(e).free_symbols for e in expressions)) - allowed
        if foreign:
            raise DerivationError(f"{derivation.name}: {what} {_complaint(foreign, everything)}")

    for definition in model.definitions:
        refuse(f"the value of {definition.variable.symbol}", [definition.value], parameters)
    for what, expressions, allowed in model.stated():
        refuse(what, expressions, allowed)
    refuse("an output", [o.value for o in model.outputs], constants | set(symbols_of(model.measured())))
    for state, curve in model.reference.items():
        refuse(f"the reference of {state}", [curve], constants)
    if problem:
        derived = set(symbols_of(o.variable for o in model.carried()))
        refuse("the running cost", [problem.running_cost], everything | derived)
        refuse("the terminal cost", [problem.terminal_cost], motion)
        refuse("a terminal constraint", problem.terminal_constraints, motion)


def _complaint(foreign: set[sp.Symbol], everything: set[sp.Symbol]) -> str:
    """What is wrong with foreign symbols: the worst kind of fault among them."""
    names = {s.name for s in everything}
    if undeclared := sorted(s.name for s in foreign if s.name not in names):
        return f"uses undeclared symbols: {', '.join(undeclared)}"
    if twins := {s.name for s in foreign - everything}:
        meant = sorted((s for s in everything if s.name in twins), key=lambda s: s.name)
        written = (f'symbols("{s.name}", {"positive" if s.is_positive else "real"}=True)' for s in meant)
        return f"uses other symbols than the declared ones; take those from symbols_of, or write {', '.join(written)}"
    return f"cannot depend on {', '.join(sorted(s.name for s in foreign))}"
