"""Rigid bodies as objects of sympy.physics.mechanics, and their vectors in a model's symbols."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import sympy as sp

from satsym.spec import ModeGroup, Variable
from satsym.symbolic import notation as n
from satsym.symbolic.model import Model, symbols_of

if TYPE_CHECKING:  # it takes half a second to import, and only derivations of rigid bodies use it
    from sympy.physics.mechanics import ReferenceFrame, RigidBody, Vector

CLOCK = sp.Symbol("t")
"""The symbol of time in frames of sympy.physics.mechanics."""


def moving(variables: Iterable[Variable | sp.Symbol]) -> tuple[sp.Expr, ...]:
    """Return variables as functions of time, in the form that sympy.physics.mechanics uses."""
    return tuple(sp.Function(v.name if isinstance(v, sp.Symbol) else v.symbol)(CLOCK) for v in variables)


@dataclass(frozen=True, kw_only=True)
class Bodies(Model):
    """Rigid bodies as objects of sympy.physics.mechanics, in which moving variables are functions of time.

    Moving variables stand in these objects as functions of time, see :func:`moving`. A spinning body that is symmetric
    about its axis may have its inertia stated in a frame that does not spin.

    Parameters
    ----------
    inertial
        The inertial frame.
    coordinates
        Each state that is a coordinate with its rate of change, in terms of states and named functions; the other
        states are the speeds.
    bodies
        With frames, centres of mass and central inertias.
    loads
        A frame and the torque on it, or a point and the force.
    named
        Functions of the coordinates that frames and loads use by these names, such as direction cosines.
    attitude
        Names among these, as a matrix: the components of the orbital axes (rows) along the body's. Proved orthogonal.
    vanishing
        States that stay zero where they are zero, and all controls but those that drive the others too; proved.
    varied
        The parameter over which equilibria are followed, such as the momentum of a wheel.
    modes
        What small motions are called, by the states that have the largest part in them.
    """

    inertial: ReferenceFrame
    coordinates: Mapping[sp.Symbol, sp.Expr]
    bodies: tuple[RigidBody, ...]
    loads: tuple[tuple[Any, Vector], ...] = ()
    named: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    attitude: sp.Matrix | None = None
    vanishing: tuple[sp.Symbol, ...] = ()
    varied: str = ""
    modes: tuple[ModeGroup, ...] = ()

    def direction_cosines(self) -> sp.Matrix | None:
        """Return the direction cosines as they were stated."""
        return self.attitude

    def mode_groups(self) -> tuple[ModeGroup, ...]:
        """Return the mode groups as they were stated."""
        return self.modes

    @property
    def speeds(self) -> tuple[sp.Symbol, ...]:
        """Return the states that are not coordinates."""
        return tuple(s for s in symbols_of(self.states) if s not in self.coordinates)

    def along(self, vector: Vector, frame: ReferenceFrame) -> list[sp.Expr]:
        """Return the components of a vector along the axes of a frame, in the model's symbols."""
        return [self.static(c) for c in vector.to_matrix(frame)]

    def static(self, expression: sp.Expr) -> sp.Expr:
        """Replace functions of time in an expression by the model's symbols."""
        known, rates = self._static
        return sp.sympify(expression).xreplace(rates).xreplace(known)

    @cached_property
    def _static(self) -> tuple[dict[sp.Basic, sp.Basic], dict[sp.Basic, sp.Basic]]:
        """Map functions of time, and their rates, to the model's symbols."""
        symbols = (*symbols_of(self.states), *self.named)
        known = dict(zip(moving(symbols), symbols, strict=True)) | {CLOCK: n.TIME}
        return known, {f.diff(CLOCK): n.rate_of(s) for f, s in zip(moving(self.speeds), self.speeds, strict=True)}

    def spin(self, body: RigidBody) -> list[sp.Expr]:
        """Return the components of a body's angular velocity along the axes of its inertia."""
        return self.along(body.frame.ang_vel_in(self.inertial), axes_of(body))

    def momentum(self, body: RigidBody) -> list[sp.Expr]:
        """Return a body's angular momentum about its centre of mass, along the axes of its inertia."""
        return self.along(body.central_inertia.dot(body.frame.ang_vel_in(self.inertial)), axes_of(body))


def axes_of(body: RigidBody) -> ReferenceFrame:
    """Return the frame in which the central inertia of a body is stated."""
    return body.central_inertia.args[0][1].args[0][1]
