"""Rigid bodies with frames and loads of sympy.physics.mechanics: a first-order system by Kane's equations."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import constants_of, simplify
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.dimension_algebra import Dimension, over
from satsym.symbolic.equilibria.rest import Rest
from satsym.symbolic.kinds import kane
from satsym.symbolic.kinds.bodies import Bodies, axes_of
from satsym.symbolic.model import Line, MaybeStep, Paragraph, Problem, Requirement, symbols_of, variables_of
from satsym.symbolic.motion import geometry


@dataclass(frozen=True, kw_only=True)
class Multibody(Bodies):
    """Rigid bodies whose equations of motion are Kane's; see :class:`~satsym.symbolic.kinds.bodies.Bodies`."""

    def steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: the motion, its reference and, where it has a closed form, its Jacobians."""
        return (*self.motion_steps(), kane.reference, kane.invariant_motions, kane.linearisation)

    def motion_steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: kinematics, partial velocities, Kane's equations, and their solution."""
        return (kane.kinematics, kane.partial_velocities, kane.kane, kane.first_order)

    def misfits(self) -> Iterator[str]:
        """Yield complaints about coordinates that are no states, and modes named by unknown states."""
        if not set(self.coordinates) <= set(symbols_of(self.states)):
            yield "the coordinates must be states"
        known, constants = ({v.symbol for v in each} for each in (self.states, self.parameters))
        for group in self.modes:
            if not group.states or not known.issuperset(group.states):
                yield f"the mode {group.name!r}: name states of the model only"
            if group.vanishing and group.vanishing not in constants:
                yield f"the mode {group.name!r}: {group.vanishing} is not a parameter"

    def stated(self) -> Iterator[tuple[str, Iterable[Any], set[sp.Symbol]]]:
        """Return what is stated: named functions, rates of coordinates, and properties of the bodies."""
        constants = constants_of(self)
        yield "a named function", self.named.values(), constants | set(self.coordinates)
        known = constants | set(self.named) | set(symbols_of((*self.states, *self.controls)))
        yield "the rate of a coordinate", self.coordinates.values(), known
        for body in self.bodies:
            yield f"the body {body.name!r}", [*self.spin(body), *self.momentum(body)], known
        for place, load in self.loads:
            yield f"the load on {place.name}", self.along(load, self.inertial), known

    def picture(self) -> geometry.Picture | None:
        """Draw the axes of the body beside those of the orbit."""
        return self.pictured(self.states)

    def pictured(self, angles: Iterable[Variable]) -> geometry.Picture | None:
        """Return the picture of the attitude in which only some of its angles turn."""
        if self.attitude is None:
            return None
        return geometry.attitude(self.attitude.subs(self.named), angles)

    def followed(self) -> str:
        """Return the parameter over which equilibria are followed, if only the attitude moves."""
        return self.varied if self.attitude is not None and len(self.states) == 6 else ""

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Map the names of partial velocities, of Kane's equations, and of their solution to LaTeX."""
        numbers = range(1, len(self.speeds) + 1)
        found: dict[str, str] = {}
        for i, speed in zip(numbers, self.speeds, strict=True):
            comma = "," if len(numbers) > 9 else ""
            found |= {f"mass_{i}_{k}": f"M_{{{i}{comma}{k}}}" for k in numbers}
            found |= {f"bias_{i}": f"b_{{{i}}}", f"force_{i}": f"Q_{{{i}}}"}
            found[n.solved(speed).name] = rf"[M^{{-1}} (\mathbf{{Q}} - \mathbf{{b}})]_{{{i}}}"
        found |= {s.name: _indexed(s.name) for s in self.named}
        for k, body in enumerate(self.bodies, 1):
            found[kane.partial_of(k).name] = f"W^{{{kane.label_of(body)}}}"
        part = n.free_letter("vsde", variables_of(self))
        return found | {f"part_{k}": f"{part}_{{{k}}}" for k in range(1, 400)}

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of named functions and solved rates, and refuse rates of other dimensions."""
        for symbol, value in self.named.items():
            known[symbol.name] = require(f"the function {symbol.name}", value)
        for coordinate, rate in self.coordinates.items():
            require(f"the rate of {coordinate.name}", rate, known[n.rate_of(coordinate).name])
        for speed in self.speeds:
            known[n.solved(speed).name] = over(known[speed.name], known[n.TIME.name])

    def statement(self) -> tuple[Paragraph, ...]:
        """Return the paragraph that gives angular velocity and inertia matrix of each body, along its inertia axes."""
        lines = []
        for body in self.bodies:
            inertia = body.central_inertia.to_matrix(axes_of(body)).applyfunc(self.static)
            label = kane.label_of(body)
            spin = sp.ImmutableMatrix(self.spin(body))
            lines.append(Line("bodies", rf"\boldsymbol{{\omega}}^{{{label}}}", spin, f"{body.name}.rate"))
            lines.append(Line("bodies", rf"\mathbf{{I}}^{{{label}}}", inertia, f"{body.name}.inertia"))
        sentence = "multibody" if len(self.bodies) > 1 else "multibody_one"
        return (Paragraph(sentence, lines=tuple(lines)),)

    def rest(self, derived: Derivation) -> Rest | None:
        """Return the torques on the body where its rates vanish, in direction cosines."""
        if self.attitude is None or not self.followed():
            return None
        known = {e.name: e.rhs for e in derived.step("kane").equations}
        inertia = sp.Matrix(3, 3, lambda i, k: known.get(f"mass_{max(i, k) + 1}_{min(i, k) + 1}", sp.Integer(0)))
        off = dict.fromkeys(symbols_of(self.controls), sp.Integer(0))
        torque = sp.Matrix([known[f"force_{k}"] - known[f"bias_{k}"] for k in (1, 2, 3)]).xreplace(off)
        resting, load = sp.linear_eq_to_matrix(list(self.coordinates.values()), self.speeds)
        turns = dict(zip(self.speeds, map(simplify, resting.LUsolve(load)), strict=True))
        varied = next(s for s in symbols_of(self.parameters) if s.name == self.varied)
        return Rest(inertia, torque, turns, self.attitude, varied)


def _indexed(name: str) -> str:
    head, _, foot = name.partition("_")
    return f"{head}_{{{foot}}}" if foot else head
