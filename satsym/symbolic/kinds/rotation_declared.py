"""What gyrostats, scaled and reduced motions, and closed loops may state: misfits are refused before any step."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeAlias

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.kinds.rotation_models import COMMAND, ClosedLoop, Gyrostat, Reduced, Scaled, s
from satsym.symbolic.model import Model, symbols_of

Refuse: TypeAlias = Callable[[str, Iterable[Any], set[sp.Symbol]], None]
"""What is meant, expressions, and the symbols they may have."""


def refuse_misfits(model: Model) -> None:
    """Refuse declarations that do not fit together.

    Raises
    ------
    DerivationError
        At the first of them.
    """
    states, controls = set(symbols_of(model.states)), set(symbols_of(model.controls))

    def require(fits: bool, complaint: str) -> None:
        if not fits:
            raise DerivationError(f"{model.name}: {complaint}")

    if isinstance(model, Gyrostat):
        moved = {*model.angles, *model.angles.values()}
        require(moved <= states, "the angles and their rates must be states")
        named = {*model.torques, *(body for motor in model.motors for body in (motor.drives, motor.against))}
        require(named <= set(model.bodies), "torques and motors must act on the bodies that are stated")
        require(set(model.drives) == controls, "the drives must say what each control is, no more, no less")
    if isinstance(model, Scaled):
        require(
            set(model.scaled) == states | controls, "give a scale for each state and each control, no more, no less"
        )
        require(
            set(model.groups) == set(symbols_of(model.parameters)), "each parameter must be a group, no more, no less"
        )
        require(
            set(model.along) <= set(symbols_of(model.of.states)), f"what is left out must be states of {model.of.name}"
        )
    if isinstance(model, Reduced):
        old = set(symbols_of(model.of.states))
        require(states | set(model.along) == old and not states & set(model.along), "keep or leave out each state once")
        require(model.controls == model.of.controls, f"the controls must be those of {model.of.name}")
    if isinstance(model, ClosedLoop):
        require(model.states == model.of.states, f"the states must be those of {model.of.name}")
        require(len(model.of.controls) == 1, f"{model.of.name} must have one control")
        require(not controls, "the law takes the place of the control, so there are none")
        require(model.follows in states, "what follows the command must be a state")
        require({model.command, model.damping} <= set(model.parameters), "command and damping must be parameters")


def refuse_foreign(model: Model, refuse: Refuse) -> None:
    """Refuse expressions with symbols that cannot stand there."""
    if isinstance(model, Gyrostat):
        known = set(symbols_of((*model.states, *model.parameters))) | {n.TIME}
        rates = {n.rate_of(x) for x in symbols_of(model.states)}
        for name, pair in model.bodies.items():
            refuse(f"the body {name!r}", pair, known)
        for name, torque in model.torques.items():
            refuse(f"the torque on {name!r}", [torque], known)
        refuse("a drive", model.drives.values(), known | rates)
        known |= set(symbols_of((*model.controls, *(m.torque for m in model.motors))))
        for output in model.quantities:
            refuse(f"the quantity {output.variable.symbol!r}", [output.value], known)
            known |= set(symbols_of((output.variable,)))
    if isinstance(model, Scaled | Reduced):
        old = set(symbols_of((*model.of.states, *model.of.controls, *model.of.parameters)))
        refuse("a special value", (*model.where.values(), *model.along.values()), old)
    if isinstance(model, Scaled):
        old |= set(symbols_of(model.units))
        refuse("a scale", model.scaled.values(), old)
        constants = set(symbols_of((*model.of.parameters, *model.units)))
        refuse("the unit of time", [model.unit_of_time], constants)
        refuse("a group", model.groups.values(), constants)
        refuse("a quantity", [o.value for o in model.quantities], old | set(symbols_of(model.of.brings())))
    if isinstance(model, ClosedLoop):
        states = set(symbols_of(model.states))
        refuse("the law", [model.law], states | set(symbols_of((*model.parameters, *model.gains))) | {s, COMMAND})
