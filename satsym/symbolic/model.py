"""What a derivation file states: physics and a cost. Declaring derives nothing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Literal

import sympy as sp

from satsym.spec import ControlSetKind, Variable

Convention = Literal["minimum", "maximum"]
"""Of Pontryagin's principle: H = lambda' f + L is minimised, or H = lambda' f - L is maximised."""

t = sp.Symbol("t", real=True)
"""Time. In a terminal cost it stands for the final time."""


def symbols_of(variables: Iterable[Variable]) -> tuple[sp.Symbol, ...]:
    """Sympy symbols of declared variables: real, and positive where they are declared so."""
    return tuple(sp.Symbol(v.symbol, real=True, positive=True if v.positive else None) for v in variables)


@dataclass(frozen=True)
class Definition:
    """A constant with a name of its own, given by the parameters: ``variable = value``."""

    variable: Variable
    value: sp.Expr


@dataclass(frozen=True)
class Output:
    """A measured quantity: ``variable = value``, a function g(t, x, u, p)."""

    variable: Variable
    value: sp.Expr


@dataclass(frozen=True, kw_only=True)
class Model:
    """What all models declare.

    Parameters
    ----------
    name
        Name of the model where it is generated without a cost.
    title
        One line for people.
    states, controls, parameters
        Declared variables; arrays everywhere follow this order.
    definitions
        Named constants used in the equations.
    reference
        State -> curve c(t, p); proved to satisfy the equations without control. May be empty.
    outputs
        What is measured. May be empty.
    """

    name: str
    title: str
    states: tuple[Variable, ...]
    controls: tuple[Variable, ...]
    parameters: tuple[Variable, ...]
    definitions: tuple[Definition, ...] = ()
    reference: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    outputs: tuple[Output, ...] = ()

    def brings(self) -> tuple[Variable, ...]:
        """Variables that a kind of model has besides."""
        return ()


@dataclass(frozen=True, kw_only=True)
class Newton(Model):
    """Motion of a point by Newton's law, all forces per unit mass.

    Parameters
    ----------
    coordinates
        Each generalised coordinate with the state that is its rate of change.
    directions
        Name -> unit vector (inertial components) along which vectors are resolved; the name is that of a
        symbol such as ``e_r``. They must be orthonormal, which is checked.
    position
        Position vector, inertial components, in terms of the coordinates.
    forces
        Name -> force vector per unit mass, inertial components.
    """

    coordinates: Mapping[sp.Symbol, sp.Symbol]
    directions: Mapping[str, sp.Matrix]
    position: sp.Matrix
    forces: Mapping[str, sp.Matrix]


@dataclass(frozen=True, kw_only=True)
class FirstOrder(Model):
    """Equations of motion given in first-order form.

    Parameters
    ----------
    rates
        State -> its rate of change f(t, x, u, p).
    """

    rates: Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True, kw_only=True)
class Linearised(Model):
    """Small deviations from a motion, to first order: x' = A x + B u, y = C x + D u.

    The states are the deviations, stated as a change of variables, and so are the controls that the motion needs.
    Everything else is declared as for any model; parameters and definitions are those of the motion, as far as it
    needs them. The outputs are functions of the states and controls of the motion, and stand for their deviations
    from what they are along it.

    Parameters
    ----------
    of
        The model whose motion this is.
    about
        Each of its states, and each control that is not zero, along the motion: functions of time and parameters.
        They must solve its equations, which is proved.
    deviations
        Each state of this model, as a function of time and of the states of ``of``; and each control that is not one
        of ``of``, as a function of these and the controls. They vanish along the motion, and there must be as many as
        they replace.
    """

    of: Model
    about: Mapping[sp.Symbol, sp.Expr]
    deviations: Mapping[sp.Symbol, sp.Expr]


@dataclass(frozen=True, kw_only=True)
class Problem:
    """An optimal control problem: a model, what it costs, and the kind of control set.

    Parameters
    ----------
    name
        Name in instances, and of the generated files.
    title
        One line for people.
    model
        The motion.
    running_cost
        Integrand L(t, x, u, p) (Lagrange term).
    terminal_cost
        S(x, t, p), taken at the final time (Mayer term).
    terminal_constraints
        Expressions psi(x, t, p) that vanish at the final time.
    control_set
        ``"free"``, ``"box"`` (each control between its bounds) or ``"ball"`` (a bound on the norm); the
        numbers belong to the instance.
    convention
        In which of the two conventions of Pontryagin's principle the derivation is printed: ``"minimum"`` or
        ``"maximum"``. The controls are the same, the costates change their sign; kernels always have those of
        the minimum convention.
    """

    name: str
    title: str
    model: Model
    running_cost: sp.Expr
    terminal_cost: sp.Expr = sp.Integer(0)
    terminal_constraints: tuple[sp.Expr, ...] = ()
    control_set: ControlSetKind = "free"
    convention: Convention = "minimum"


def variables_of(model: Model) -> tuple[Variable, ...]:
    """Everything that a model declares, and what the motion has that it linearises, each once."""
    found = [*model.states, *model.controls, *model.parameters, *(d.variable for d in model.definitions)]
    found += [o.variable for o in model.outputs]
    if isinstance(model, Linearised):
        kept = {v.symbol for v in model.controls}
        found += [*model.of.states, *(v for v in model.of.controls if v.symbol not in kept)]
    kept = {v.symbol for v in found}
    found += [v for v in model.brings() if v.symbol not in kept]
    return tuple(found)
