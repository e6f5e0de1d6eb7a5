"""Bodies that turn about one common axis: Euler's equations, the torques of motors, and a first-order system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.spec import Variable
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of, tidy, total_derivative
from satsym.symbolic.checks import Point, compare, identity, numeric
from satsym.symbolic.derivation import Derivation, DerivationError, Equation, Step, resolved
from satsym.symbolic.dimension_algebra import Dimension, over
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.model import Line, MaybeStep, Model, Output, Paragraph, Problem, Requirement, symbols_of
from satsym.symbolic.motion import geometry
from satsym.symbolic.motion import steps as motion


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
        """Return the torques of the motors and the derived quantities."""
        return (*(m.torque for m in self.motors), *(o.variable for o in self.quantities))

    def steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: the motion, its reference and its Jacobians."""
        return (*self.motion_steps(), motion.reference, motion.linearisation)

    def motion_steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: Euler's equations, total angular momentum, first-order form and motor torques."""
        return (momenta, euler, first_order, balance, quantities)

    def carried(self) -> tuple[Output, ...]:
        """Return the derived quantities."""
        return self.quantities

    def picture(self) -> geometry.Picture | None:
        """Draw the bodies about their axis."""
        return geometry.bodies(self, next(iter(self.angles)), tuple(self.bodies)) if self.angles else None

    def misfits(self) -> Iterator[str]:
        """Yield complaints about angles that are no states, torques on no bodies, or drives of no controls."""
        if not {*self.angles, *self.angles.values()} <= set(symbols_of(self.states)):
            yield "the angles and their rates must be states"
        named = {*self.torques, *(body for motor in self.motors for body in (motor.drives, motor.against))}
        if not named <= set(self.bodies):
            yield "torques and motors must act on declared bodies"
        if set(self.drives) != set(symbols_of(self.controls)):
            yield "drives: every control must be defined, and nothing else"

    def stated(self) -> Iterator[tuple[str, Iterable[Any], set[sp.Symbol]]]:
        """Return what is stated: bodies and torques, drives with rates, and quantities."""
        known = set(symbols_of((*self.states, *self.parameters))) | {n.TIME}
        for name, pair in self.bodies.items():
            yield f"the body {name!r}", pair, known
        for name, torque in self.torques.items():
            yield f"the torque on {name!r}", [torque], known
        yield "a drive", self.drives.values(), known | {n.rate_of(x) for x in symbols_of(self.states)}
        known = known | set(symbols_of((*self.controls, *(m.torque for m in self.motors))))
        for output in self.quantities:
            yield f"the quantity {output.variable.symbol!r}", [output.value], known
            known = known | set(symbols_of((output.variable,)))

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Map the names of the angular momenta to LaTeX."""
        found = {_momentum_of(body).name: rf"h_{{\mathrm{{{body}}}}}" for body in self.bodies}
        return found | {n.rate_of(n.ANGULAR_MOMENTUM).name: r"\frac{d\ell}{dt}"}

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of the angular momenta, and from these those of all torques."""
        second, momentum = known[n.TIME.name], None
        for name, (inertia, spin) in self.bodies.items():
            momentum = require(f"the angular momentum of {name}", inertia * spin, momentum)
            known[_momentum_of(name).name] = momentum
        known[n.ANGULAR_MOMENTUM.name] = momentum
        torque = over(momentum, second)
        known[n.rate_of(n.ANGULAR_MOMENTUM).name] = torque
        for name, value in self.torques.items():
            require(f"the torque on {name}", value, torque)
        for motor in self.motors:
            require(f"the torque {motor.torque.symbol}", symbols_of((motor.torque,))[0], torque)
        for angle, rate in self.angles.items():
            require(f"{rate.name}, the rate of {angle.name},", rate, over(known[angle.name], second))
        for control, value in self.drives.items():
            require(f"the control {control.name}", value, known[control.name])
        for output in self.quantities:
            require(f"the quantity {output.variable.symbol}", output.value, known[output.variable.symbol])

    def statement(self) -> tuple[Paragraph, ...]:
        """Return the paragraph that gives the bodies turning about the axis, and the torques on them."""
        bodies, torques = [], []
        for name, (inertia, spin) in self.bodies.items():
            bodies.append(Line("bodies", "I", inertia, f"inertia.{name}", name))
            bodies.append(Line("bodies", r"\omega", spin, f"rate.{name}", name))
            if name in self.torques:
                torques.append(Line("torques", "T", self.torques[name], f"torque.{name}", name))
        return (Paragraph("bodies", lines=(*bodies, *torques)),)


def momenta(so_far: Derivation) -> Step:
    """Derive the angular momentum of each body, and the total one."""
    model = stated_as(Gyrostat, so_far)
    of_each = {name: inertia * spin for name, (inertia, spin) in model.bodies.items()}
    equations = [Equation(name, _momentum_of(name), h) for name, h in of_each.items()]
    total = tidy(sp.expand(sp.Add(*of_each.values())))
    equations.append(Equation("angular_momentum", n.ANGULAR_MOMENTUM, total))
    found = numeric([total])
    inertias, spins = (numeric(list(each)) for each in zip(*_bodies(model), strict=True))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Differentiate the kinetic energy by a common turn of all bodies."""
        turning = list(zip(inertias(point), spins(point), strict=True))

        def energy(faster: Any) -> Any:
            return sum(i * (w + faster) ** 2 / 2 for i, w in turning)

        return found(point), [mp.diff(energy, 0)]

    check = compare("energy by a common turn", _symbols(model), sides)
    return Step("momenta", "inertia times rate", tuple(equations), ("bodies",), (check,))


def euler(so_far: Derivation) -> Step:
    """Derive Euler's equation of each body, and state the controls."""
    model = stated_as(Gyrostat, so_far)
    equations = []
    moving = [s for s in symbols_of(model.states) if s not in model.angles]
    rates = {**model.angles, **{s: n.rate_of(s) for s in moving}}
    changes = {name: total_derivative(inertia * spin, rates) for name, (inertia, spin) in model.bodies.items()}
    for name, change in changes.items():
        equations.append(Equation(name, tidy(change), _torque_on(model, name)))
    for control, value in model.drives.items():
        equations.append(Equation(control.name, value, control))
    functions = numeric([e.lhs for e in equations[: len(changes)]])
    values = numeric([i * w for i, w in _bodies(model)])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Differentiate the momenta numerically as the states move at their rates."""

        def later(time: Any) -> list[Any]:
            return values({**point, **{s: point[s] + point.get(r, 0) * time for s, r in rates.items()}})

        return functions(point), [mp.diff(lambda time, k=k: later(time)[k], 0) for k in range(len(changes))]

    symbols = _symbols(model) | {n.rate_of(s) for s in moving}
    check = compare("momenta along a path", symbols, sides)
    return Step("euler", "Euler's equation", tuple(equations), ("momenta", "torques"), (check,))


def first_order(so_far: Derivation) -> Step:
    """Solve Euler's equations for the rates of change of the states."""
    model = stated_as(Gyrostat, so_far)
    found, _ = _solved(so_far)
    equations = tuple(Equation(s.name, n.rate_of(s), found[s]) for s in symbols_of(model.states))
    rates = {e.lhs: e.rhs for e in equations}
    total = sum(e.lhs.xreplace(rates) for e in so_far.step("euler").equations[: len(model.bodies)])
    outside = sp.Add(*model.torques.values())
    driven = [v.xreplace(rates) - u for u, v in model.drives.items()]
    proof = identity("torques from outside alone", [total - outside, *driven])
    return Step("first_order", "solve for rates", equations, ("euler",), (proof,))


def balance(so_far: Derivation) -> Step:
    """Show that the total angular momentum changes by external torques alone, whatever the controls do."""
    model = stated_as(Gyrostat, so_far)
    outside = tidy(sp.Add(*model.torques.values()))
    rates = dict(zip(symbols_of(model.states), so_far.rhs("first_order"), strict=True))
    total = so_far.equation("momenta.angular_momentum").rhs
    proof = identity("changes so along every motion", [total_derivative(total, rates) - outside])
    equations = (Equation("angular_momentum", n.rate_of(n.ANGULAR_MOMENTUM), outside),)
    return Step("balance", "motors cancel", equations, ("momenta", "first_order"), (proof,))


def quantities(so_far: Derivation) -> Step | None:
    """Derive the torques that the motors must give, and the other declared quantities."""
    model = stated_as(Gyrostat, so_far)
    if not model.motors:
        return None
    _, torques = _solved(so_far)
    names = symbols_of(o.variable for o in model.quantities)
    stated = {symbol: sp.sympify(o.value) for symbol, o in zip(names, model.quantities, strict=True)}
    equations = [Equation(symbol.name, symbol, value) for symbol, value in (torques | stated).items()]
    rates = dict(zip(symbols_of(model.states), so_far.rhs("first_order"), strict=True))
    gained = total_derivative(_kinetic_energy(model), rates)
    work = sum(torque * model.bodies[name][1] for name, torque in model.torques.items())
    for motor, symbol in zip(model.motors, torques, strict=True):
        faster = model.bodies[motor.drives][1] - model.bodies[motor.against][1]
        work += torques[symbol] * faster
    constants = definitions_of(model)
    checks = [identity("work of all torques", [(gained - work).xreplace(constants)])]
    if stated:
        known = resolved(equations)
        found, definition = numeric(list(known.values())), numeric([e.rhs for e in equations])

        def sides(point: Point) -> tuple[list[Any], list[Any]]:
            """Substitute all quantities at once, and one after the other in numbers."""
            values = dict(point)
            for _ in equations:
                values |= dict(zip(known, definition(values), strict=True))
            return found(point), [values[symbol] for symbol in known]

        symbols = set().union(*(e.rhs.free_symbols for e in equations))
        checks.append(compare("put in one by one", symbols, sides))
    return Step("quantities", "solve for torques", tuple(equations), ("euler", "first_order"), tuple(checks))


def _solved(so_far: Derivation) -> tuple[dict[sp.Symbol, sp.Expr], dict[sp.Symbol, sp.Expr]]:
    """Solve for the rates of change of all states and the torques of the motors."""
    model = stated_as(Gyrostat, so_far)
    states = symbols_of(model.states)
    unknown = [n.rate_of(s) for s in states if s not in model.angles]
    torques = symbols_of(m.torque for m in model.motors)
    wanted = [*unknown, *torques]
    solutions = sp.solve([e.lhs - e.rhs for e in so_far.step("euler").equations], wanted, dict=True)
    if len(solutions) != 1 or set(solutions[0]) != set(wanted):
        names = ", ".join(s.name for s in wanted)
        raise DerivationError(f"{model.name}: Euler's equations and the drives do not determine {names}")
    by = symbols_of(model.controls)
    solution = {s: tidy(value, by) for s, value in solutions[0].items()}
    rates = {s: model.angles[s] if s in model.angles else solution[n.rate_of(s)] for s in states}
    return rates, {s: solution[s] for s in torques}


def _torque_on(model: Gyrostat, body: str) -> sp.Expr:
    total = sp.sympify(model.torques.get(body, 0))
    for motor, symbol in zip(model.motors, symbols_of(m.torque for m in model.motors), strict=True):
        total += symbol * ((body == motor.drives) - (body == motor.against))
    return total


def _kinetic_energy(model: Gyrostat) -> sp.Expr:
    return sp.Add(*(inertia * spin**2 / 2 for inertia, spin in _bodies(model)))


def _bodies(model: Gyrostat) -> list[tuple[sp.Expr, sp.Expr]]:
    return [(sp.sympify(inertia), sp.sympify(spin)) for inertia, spin in model.bodies.values()]


def _symbols(model: Gyrostat) -> set[sp.Symbol]:
    pairs = [e for pair in _bodies(model) for e in pair]
    return {*symbols_of(model.states)}.union(*(e.free_symbols for e in pairs))


def _momentum_of(body: str) -> sp.Symbol:
    """Return the symbol for the angular momentum of a body."""
    return sp.Symbol(f"h_{body}", real=True)
