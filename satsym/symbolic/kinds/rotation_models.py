"""Kinds of models about bodies that turn: gyrostats, motions in other units or fewer states, and closed loops."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic.model import Model, Output, variables_of


@dataclass(frozen=True)
class Motor:
    """A torque between two bodies: ``torque`` turns the body ``drives``, and its opposite the body ``against``."""

    torque: Variable
    drives: str
    against: str


@dataclass(frozen=True, kw_only=True)
class Gyrostat(Model):
    """Bodies that turn about one common axis, such as a satellite and its reaction wheel.

    Parameters
    ----------
    angles
        Each state that is an angle with the state that is its rate of change.
    bodies
        Name -> moment of inertia about the axis, and rate of turn about it as seen from inertial space. The names
        are those of symbols.
    torques
        Name of a body -> torque about the axis from outside; bodies left out feel none.
    motors
        Torques that the bodies exert on each other; they are found, not given.
    drives
        What each control is, in terms of states and of their rates of change (:func:`~satsym.symbolic.rate_of`);
        one equation for each motor.
    quantities
        What is derived along the motion besides, from states, controls, motor torques and the quantities before.
    """

    angles: Mapping[sp.Symbol, sp.Symbol]
    bodies: Mapping[str, tuple[sp.Expr, sp.Expr]]
    torques: Mapping[str, sp.Expr] = field(default_factory=dict)
    motors: tuple[Motor, ...] = ()
    drives: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    quantities: tuple[Output, ...] = ()

    def brings(self) -> tuple[Variable, ...]:
        """The torques of the motors, and the derived quantities."""
        return (*(m.torque for m in self.motors), *(o.variable for o in self.quantities))


@dataclass(frozen=True, kw_only=True)
class Scaled(Model):
    """A motion in plain numbers: new states, controls and time, each a multiple of an old one.

    States of the old motion that nothing else depends on may be left out.

    Parameters
    ----------
    of
        The model whose motion this is; without explicit time.
    units
        What the scaling brings along, such as the largest torque.
    unit_of_time
        The time that counts as one, of parameters and `units`.
    scaled
        Each new state and control, in terms of the old ones.
    where
        Parameters that have special values in this case, such as a moment of inertia equal to another one.
    groups
        Each parameter of this model, in terms of the old parameters and `units`.
    along
        Old states that are left out -> what they are along the motions meant, in terms of the others.
    quantities
        What is carried over besides, in terms of the old states, controls and quantities.
    """

    of: Model
    units: tuple[Variable, ...] = ()
    unit_of_time: sp.Expr
    scaled: Mapping[sp.Symbol, sp.Expr]
    where: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    groups: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    along: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    quantities: tuple[Output, ...] = ()

    def brings(self) -> tuple[Variable, ...]:
        """The units, all that the old motion has, and the derived quantities."""
        return (*self.units, *variables_of(self.of), *(o.variable for o in self.quantities))


@dataclass(frozen=True, kw_only=True)
class Reduced(Model):
    """A motion in some of its states, where the others follow from them, such as a momentum's from its balance.

    States, controls and parameters are those of the motion that are kept.

    Parameters
    ----------
    of
        The model whose motion this is.
    along
        Each state that is left out -> what it is, in terms of the others; proved to stay so.
    where
        Parameters that have special values in this case.
    """

    of: Model
    along: Mapping[sp.Symbol, sp.Expr]
    where: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def brings(self) -> tuple[Variable, ...]:
        """All that the motion has."""
        return variables_of(self.of)


@dataclass(frozen=True, kw_only=True)
class ClosedLoop(Model):
    """Small motions about rest under a linear law that follows a command, critically damped.

    Its controls are none: the law takes their place. Its states are those of the motion.

    Parameters
    ----------
    of
        The model that is controlled by one control; all its states zero is a motion of it.
    follows
        The state that is to follow the command.
    command
        Parameter: the height of the step that is commanded at time 0.
    gains
        Variables K1, K2, which critical damping determines.
    law
        The control, in terms of states, gains, :data:`s` for differentiation, and :data:`COMMAND`.
    damping
        Parameter: the negative of the double pole.
    where
        Parameters that have special values in the closed forms of the answer to a step.
    """

    of: Model
    follows: sp.Symbol
    command: Variable
    gains: tuple[Variable, Variable]
    law: sp.Expr
    damping: Variable
    where: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def brings(self) -> tuple[Variable, ...]:
        """The control that the law takes the place of, and its gains."""
        return (*self.of.controls, *self.gains)


s = sp.Symbol("s")
"""Differentiation with respect to time, or the variable of Laplace transforms."""
COMMAND = sp.Symbol("command", real=True)
"""What a closed loop is told to follow."""
