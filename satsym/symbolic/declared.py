"""What a derivation file may state: misfits, undeclared and misplaced symbols are refused before any step."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.kinds import rotation_declared
from satsym.symbolic.model import FirstOrder, Linearised, Model, Newton, Problem, symbols_of


def refuse_misfits(model: Model, problem: Problem | None) -> None:
    """Refuse declarations that do not fit together: states, rates, references, sizes of vectors.

    Raises
    ------
    DerivationError
        At the first of them.
    """
    states = symbols_of(model.states)
    if isinstance(model, Newton):
        moving = [*model.coordinates, *model.coordinates.values()]
        if len(moving) != len(states) or set(moving) != set(states):
            raise DerivationError(f"{model.name}: the states must be the coordinates and their rates, no more, no less")
        vectors = (model.position, *model.directions.values(), *model.forces.values())
        if {len(vector) for vector in vectors} != {len(model.directions)}:
            raise DerivationError(f"{model.name}: vectors need as many components as there are directions")
    if isinstance(model, FirstOrder) and set(states) != set(model.rates):
        raise DerivationError(f"{model.name}: give one rate for each state, no more, no less")
    if isinstance(model, Linearised):
        _refuse_misfit_of_linearised(model)
    rotation_declared.refuse_misfits(model)
    if model.reference and set(states) != set(model.reference):
        odd = sorted(s.name for s in set(states) ^ set(model.reference))
        raise DerivationError(
            f"{model.name}: the reference must have one curve for each state; look at {', '.join(odd)}"
        )
    if problem and not model.controls:
        raise DerivationError(f"{problem.name}: the model has no controls, so there is nothing to optimise")


def _refuse_misfit_of_linearised(model: Linearised) -> None:
    """Refuse a linearisation whose variables do not replace those of the motion one by one."""
    names, of = f"{model.name}:", model.of
    states, old_states = symbols_of(model.states), symbols_of(of.states)
    controls, old_controls = symbols_of(model.controls), symbols_of(of.controls)
    new = [u for u in controls if u not in old_controls]
    replaced = [u for u in old_controls if u not in controls]
    if len(states) != len(old_states) or len(new) != len(replaced):
        raise DerivationError(f"{names} give as many states and controls as {of.name} has, in place of them")
    if missing := [s.name for s in old_states if s not in model.about]:
        raise DerivationError(f"{names} about which motion? no value for {', '.join(missing)}")
    if kept := [u.name for u in old_controls if u in controls and model.about.get(u, 0) != 0]:
        raise DerivationError(f"{names} {', '.join(kept)} is not zero along the motion; name its deviation otherwise")
    if set(model.deviations) != {*states, *new}:
        raise DerivationError(f"{names} state one deviation for each state and each new control, no more, no less")
    if model.definitions != of.definitions:
        raise DerivationError(f"{names} the definitions must be those of {of.name}, no more, no less")


def refuse_foreign_symbols(derivation: Derivation) -> None:
    """Refuse expressions with symbols that were not declared, or that cannot stand there.

    Raises
    ------
    DerivationError
        At the first of them.
    """
    model, problem = derivation.model, derivation.problem
    parameters = set(symbols_of(model.parameters))
    constants = {n.TIME, *parameters, *definitions_of(model)}
    motion = constants | set(symbols_of(model.states))
    everything = motion | set(symbols_of(model.controls))

    def refuse(what: str, expressions: Iterable[Any], allowed: set[sp.Symbol]) -> None:
        foreign = set().union(*(sp.sympify(e).free_symbols for e in expressions)) - allowed
        if foreign:
            raise DerivationError(f"{derivation.name}: {what} {_complaint(foreign, everything)}")

    for definition in model.definitions:
        refuse(f"the value of {definition.variable.symbol}", [definition.value], parameters)
    if isinstance(model, Linearised):
        old = set(symbols_of((*model.of.states, *model.of.controls)))
        refuse("the motion it is linearised about", model.about.values(), constants)
        refuse("a deviation", model.deviations.values(), constants | old)
        refuse("an output", [o.value for o in model.outputs], constants | old)
        refuse(f"the motion {model.of.name}", _stated(model.of), constants | old)
    else:
        refuse("an output", [o.value for o in model.outputs], everything)
    rotation_declared.refuse_foreign(model, refuse)
    for state, curve in model.reference.items():
        refuse(f"the reference of {state}", [curve], constants)
    if isinstance(model, FirstOrder):
        for state, rate in model.rates.items():
            refuse(f"the rate of {state}", [rate], everything)
    if isinstance(model, Newton):
        placed = constants | set(model.coordinates)
        refuse("the position", model.position, placed)
        for name, direction in model.directions.items():
            refuse(f"the direction {name}", direction, placed)
        for name, force in model.forces.items():
            refuse(f"the force {name!r}", force, everything)
    if problem:
        stated = [*getattr(model, "quantities", ()), *getattr(getattr(model, "of", None), "quantities", ())]
        derived = set(symbols_of(o.variable for o in stated))
        refuse("the running cost", [problem.running_cost], everything | derived)
        refuse("the terminal cost", [problem.terminal_cost], motion)
        refuse("a terminal constraint", problem.terminal_constraints, motion)


def _stated(model: Model) -> list[Any]:
    """The expressions that state a motion."""
    if isinstance(model, Newton):
        return [*model.position, *(c for force in model.forces.values() for c in force)]
    return list(getattr(model, "rates", {}).values())


def _complaint(foreign: set[sp.Symbol], everything: set[sp.Symbol]) -> str:
    """What is wrong with foreign symbols: the worst kind of fault among them."""
    names = {s.name for s in everything}
    if undeclared := sorted(s.name for s in foreign if s.name not in names):
        return f"uses undeclared symbols: {', '.join(undeclared)}"
    if twins := sorted(s.name for s in foreign - everything):
        return f"uses other symbols than the declared ones (take those from symbols_of): {', '.join(twins)}"
    return f"cannot depend on {', '.join(sorted(s.name for s in foreign))}"
