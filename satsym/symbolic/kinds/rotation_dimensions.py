"""Dimensions of what gyrostats, scaled motions and closed loops bring."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over, power_of, product
from satsym.symbolic.kinds import rotation_notation as rn
from satsym.symbolic.kinds.rotation_models import COMMAND, ClosedLoop, Gyrostat, Reduced, Scaled, s
from satsym.symbolic.model import Model, symbols_of

Requirement: TypeAlias = Callable[..., Dimension | None]
"""What is meant, an expression, and the dimension it needs (if that is known) -> the dimension it has."""
SECOND: Dimension = {"[time]": sp.Integer(1)}


def declare(known: dict[str, Dimension | None], model: Model, require: Requirement) -> None:
    """Enter the dimensions, and refuse what is stated with others than its variables have."""
    if isinstance(model, Gyrostat):
        _gyrostat(known, model, require)
    if isinstance(model, Scaled):
        _scaled(known, model, require)
    if isinstance(model, Reduced):
        for symbol, value in {**model.where, **model.along}.items():
            require(f"the special {symbol.name}", value, known[symbol.name])
        for state in symbols_of(model.of.states):
            known[n.rate_of(state).name] = over(known[state.name], known[n.TIME.name])
    if isinstance(model, ClosedLoop):
        _closed_loop(known, model, require)


def of_effort(known: dict[str, Dimension | None], model: Model) -> None:
    """Enter the dimensions of what costs that are an effort bring."""
    running = known[n.RUNNING_COST.name]
    total = product((running, known[n.TIME.name]))
    known[rn.REDUCED_COST.name] = running
    known[rn.POTENTIAL.name] = known[rn.LEAST_COST.name] = known[rn.COST_FROM_REST.name] = total
    for state in symbols_of(model.states):
        known[rn.reduced_costate_of(state).name] = known[n.costate_of(state).name]
        known[n.initial(state).name] = known[state.name]
    for control in symbols_of(model.controls):
        known[rn.answer_of(control).name] = known[rn.peak_of(control).name] = known[control.name]


def _gyrostat(known: dict[str, Dimension | None], model: Gyrostat, require: Requirement) -> None:
    second, momentum = known[n.TIME.name], None
    for name, (inertia, spin) in model.bodies.items():
        momentum = require(f"the angular momentum of {name}", inertia * spin, momentum)
        known[rn.momentum_of(name).name] = momentum
    known[n.ANGULAR_MOMENTUM.name] = momentum
    torque = over(momentum, second)
    known[n.rate_of(n.ANGULAR_MOMENTUM).name] = torque
    for name, value in model.torques.items():
        require(f"the torque on {name}", value, torque)
    for motor in model.motors:
        require(f"the torque {motor.torque.symbol}", symbols_of((motor.torque,))[0], torque)
    for angle, rate in model.angles.items():
        require(f"{rate.name}, the rate of {angle.name},", rate, over(known[angle.name], second))
    for control, value in model.drives.items():
        require(f"the control {control.name}", value, known[control.name])
    for output in model.quantities:
        require(f"the quantity {output.variable.symbol}", output.value, known[output.variable.symbol])


def _scaled(known: dict[str, Dimension | None], model: Scaled, require: Requirement) -> None:
    known[rn.ORIGINAL_TIME.name] = SECOND
    require("the unit of time", model.unit_of_time, SECOND)
    for state in symbols_of(model.of.states):
        known[n.rate_of(state).name] = over(known[state.name], SECOND)
    for what, stated in (
        ("scaled", model.scaled),
        ("group", model.groups),
        ("special", {**model.where, **model.along}),
    ):
        for symbol, value in stated.items():
            require(f"the {what} {symbol.name}", value, known[symbol.name])
    for output in model.quantities:
        require(f"the quantity {output.variable.symbol}", output.value, known[output.variable.symbol])


def _closed_loop(known: dict[str, Dimension | None], model: ClosedLoop, require: Requirement) -> None:
    second = known[n.TIME.name]
    (control,) = symbols_of(model.of.controls)
    known[COMMAND.name] = known[model.follows.name]
    known[s.name] = over(PLAIN, second)
    require("the command", symbols_of((model.command,))[0], known[model.follows.name])
    require("the damping", symbols_of((model.damping,))[0], known[s.name])
    require("the law", model.law, known[control.name])
    states = symbols_of(model.states)
    for symbol in (*states, control):
        known[rn.transfer_to(symbol).name] = over(known[symbol.name], known[COMMAND.name])
        known[rn.answer_of(symbol).name] = known[rn.final_of(symbol).name] = known[symbol.name]
        known[n.initial(symbol).name] = known[symbol.name]
    for state in symbols_of(model.of.states):
        known[n.rate_of(state).name] = over(known[state.name], second)
    impulse = product((known[control.name], second))
    known[rn.impulse_of(control).name] = known[rn.TOTAL_IMPULSE.name] = impulse
    known[rn.SMOOTH_SQUARE.name] = product((impulse, known[control.name]))
    known[rn.FIRST_REACHED.name] = known[rn.HIGHEST_AT.name] = second
    known[rn.OVERSHOOT.name] = PLAIN
    known[rn.POLYNOMIAL.name] = power_of(known[s.name], sp.Integer(2))
    for k in (1, 2):
        known[rn.pole(k).name] = known[rn.zero(k).name] = known[s.name]
