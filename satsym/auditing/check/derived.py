"""Equations of a derivation, prepared for comparison: each time derivative has one name only."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

from satsym.auditing.latex.words import NOT_NUMBERS
from satsym.formula.calculus import derivative, difference, product, total
from satsym.formula.field import BY_TERMS, Point, Undecided, drawn, points_for
from satsym.formula.reading import FUNCTIONS
from satsym.formula.tree import ZERO, Call, Div, Equality, Neg, Node, Sym, calls_in, mapped, substituted, symbols
from satsym.records import record
from satsym.records.record import Record
from satsym.status import BadInput

_GIVEN = ("reference", "reference_condition", "boundary_conditions", "boundary_residual", "deviations", "stationarity")
"""Steps of a derivation whose equations hold at some times only, not along the whole motion."""
_FIRST = ("first_order", "equations_of_motion", "newton", "hamiltonian", "stationarity", "control_law")
"""Steps whose equations are preferred when several steps contain the same equation."""
_COST = ("L", "S")
_DEEPEST = 12


@dataclass(frozen=True)
class Target:
    """An equation of a derivation in which each time derivative has one name only."""

    address: str
    equation: Equality
    always: bool
    """Whether the equation holds at all times and for all values of the controls."""

    @cached_property
    def residual(self) -> Node:
        """The left-hand side minus the right-hand side."""
        return difference(self.equation.lhs, self.equation.rhs)


@dataclass(frozen=True, eq=False)
class Derived:
    """A record of a derivation, with the names and equations that follow from it."""

    record: Record

    @cached_property
    def states(self) -> tuple[str, ...]:
        """Names of the states."""
        return record.variables(self.record, "state")

    @cached_property
    def controls(self) -> tuple[str, ...]:
        """Names of the controls."""
        return record.variables(self.record, "control")

    @cached_property
    def costates(self) -> tuple[str, ...]:
        """Names of the costates in the order of the states; empty if the model has no optimal control problem."""
        return tuple(name for name in (f"lambda_{state}" for state in self.states) if name in self.record.names)

    @cached_property
    def base(self) -> frozenset[str]:
        """Names without a definition: states, controls, parameters and costates."""
        declared = (n for n, entry in self.record.names.items() if entry.kind in ("state", "control", "parameter"))
        return frozenset((*declared, *self.costates))

    @cached_property
    def positive(self) -> frozenset[str]:
        """Names of the quantities that are positive."""
        return frozenset(name for name, entry in self.record.names.items() if entry.positive)

    @cached_property
    def speeds(self) -> Mapping[str, str]:
        """State -> the state that is its time derivative."""
        found = {}
        for step in self.record.steps:
            for equation in step.equations if step.name in ("first_order", "original_equations") else ():
                tree = record.formula(equation.rhs) if isinstance(equation.rhs, str) else ZERO
                if isinstance(tree, Sym) and (tree.name in self.states or tree.name in self.others):
                    found[equation.name] = tree.name
        return found

    @cached_property
    def others(self) -> frozenset[str]:
        """States of the nonlinear or original model that this model was derived from, if there is one."""
        found = (n.removeprefix("d_") for n in self.record.names if n.startswith("d_"))
        return frozenset(n for n in found if n not in self.states and n not in self.costates)

    @cached_property
    def _one_name(self) -> Mapping[str, Node]:
        found: dict[str, Node] = {f"{x}_ddot": Sym(f"d_{v}") for x, v in self.speeds.items()}
        return found | {f"d_{x}": Sym(v) for x, v in self.speeds.items()}

    def rate(self, name: str, times: int = 1) -> Node | None:
        """Return the time derivative of a quantity of the given order, as a name or as a formula."""
        tree: Node = Sym(name)
        for _ in range(times):
            if isinstance(tree, Sym) and (tree.name in (*self.states, *self.costates) or tree.name in self.others):
                known = self.speeds.get(tree.name)
                tree = Sym(known or f"d_{tree.name}")
            else:
                tree = self.along(self.opened(tree))
        return tree

    @cached_property
    def kinematic(self) -> Mapping[str, str]:
        """Address of an equation ``d_x = v`` -> the state x.

        These equations become identities once ``d_x`` is named ``v``.
        """
        return {f"{self.record.name}:first_order.{x}": x for x in self.speeds}

    @cached_property
    def definitions(self) -> dict[str, Node]:
        """Formulas of the defined names that hold along the whole motion."""
        found = {name: record.formula(text) for name, text in self.record.definitions.items() if text}
        for step in self.record.steps:
            for equation in step.equations if step.name not in _GIVEN else ():
                if equation.lhs is None or not isinstance(equation.rhs, str):
                    continue
                name, tree = record.formula(equation.lhs), substituted(record.formula(equation.rhs), self._one_name)
                if isinstance(name, Sym):
                    name = substituted(name, self._one_name)
                if isinstance(name, Sym) and name.name not in self.base and name.name not in symbols(tree):
                    found.setdefault(name.name, tree)
        found |= {name: tree for name, tree in self._declared if name not in found}
        return found

    @cached_property
    def _declared(self) -> list[tuple[str, Node]]:
        """The cost and the outputs that are functions of the states of this model.

        Outputs of a linearised model are left out where they are functions of the states of the original model.
        """
        known = self.base | {name for name, text in self.record.definitions.items() if text} | {"t"}
        found = []
        for name in (*_COST, *record.variables(self.record, "output")):
            text = self.record.declared.get(name)
            tree = record.formula(text) if isinstance(text, str) else None
            if tree is not None and (name in _COST or symbols(tree) <= known):
                found.append((name, tree))
        return found

    @cached_property
    def targets(self) -> list[Target]:
        """All equations of the derivation, with those of the preferred steps first."""
        steps = sorted(
            self.record.steps, key=lambda step: _FIRST.index(step.name) if step.name in _FIRST else len(_FIRST)
        )
        found = []
        for step in steps:
            for equation in step.equations:
                if equation.lhs is None or not isinstance(equation.rhs, str):
                    continue
                sides = [substituted(record.formula(text), self._one_name) for text in (equation.lhs, equation.rhs)]
                if equation.name == "characteristic_polynomial":
                    sides = [sides[1], ZERO]
                address = f"{self.record.name}:{step.name}.{equation.name}"
                found.append(Target(address, Equality(sides[0], sides[1]), step.name not in _GIVEN))
        for name, tree in self._declared:
            if self.definitions[name] == tree:
                found.append(Target(f"{self.record.name}:{record.DECLARED}.{name}", Equality(Sym(name), tree), True))
        return found

    def opened(self, tree: Node, depth: int = _DEEPEST) -> Node:
        """Return the tree with all names replaced by their definitions, except names of time derivatives."""
        inside = {n for n in symbols(tree) if n in self.definitions and not n.startswith("d_")}
        if not inside or not depth:
            return tree
        return self.opened(substituted(tree, {n: self.definitions[n] for n in inside}), depth - 1)

    def along(self, tree: Node) -> Node:
        """Return the time derivative of a formula along the motion.

        Raises
        ------
        BadInput
            If the formula has a part that no rule differentiates.
        """
        terms = [derivative(tree, "t")]
        for name in sorted(symbols(tree) - {"t"}):
            slope = derivative(tree, name)
            if slope == ZERO:
                continue
            if name in (*self.states, *self.costates):
                rate = self.speeds.get(name) or f"d_{name}"
            elif name in self.definitions and name.startswith("d_"):
                terms.append(product([slope, self.along(self.opened(self.definitions[name]))]))
                continue
            elif name in self.controls:
                rate = f"d_{name}"
            else:
                continue
            terms.append(product([slope, Sym(rate)]))
        return total(terms)

    def differentiated(self, tree: Node) -> Node:
        """Return the tree with all derivatives that are written as ``diff`` or ``d`` evaluated."""

        def worked_out(part: Node) -> Node | None:
            if not isinstance(part, Call) or part.function not in ("diff", "d"):
                return None
            inner = self.opened(self.differentiated(part.arguments[0]))
            if part.function == "d":
                return self.along(inner)
            by = part.arguments[1]
            if not isinstance(by, Sym):
                raise BadInput("a derivative is taken with respect to a quantity that is not a symbol of the model")
            return derivative(inner, by.name)

        return mapped(tree, worked_out)


class MotionPoint(Point):
    """A random point at which each defined name has the value of its definition."""

    def __init__(self, seed: str, derived: Derived, besides: Mapping[str, Node], strict: bool) -> None:
        super().__init__(seed, derived.positive, strict)
        self._known = {**derived.definitions, **besides}
        self._asked: set[str] = set()

    def symbol(self, name: str) -> int:
        """Return the value of a name at the random point, modulo a prime."""
        if name not in self._known or name in self._asked:
            return super().symbol(name)
        self._asked.add(name)
        try:
            return self.value(self._known[name])
        finally:
            self._asked.discard(name)

    def value_of_call(self, node: Call) -> int:
        """Return the value of a function, with definitions inserted in its argument first if it is, e.g., a sine."""
        if node.function in BY_TERMS:
            tree: Node = node
            for _ in range(_DEEPEST):
                inside = {n: self._known[n] for n in symbols(tree) if n in self._known}
                if not inside:
                    break
                tree = substituted(tree, inside)
            return super().value_of_call(tree) if isinstance(tree, Call) else self.value(tree)
        return super().value_of_call(node)


def vanishes(tree: Node, derived: Derived, besides: Mapping[str, Node] = MappingProxyType({}), points: int = 3) -> bool:
    """Return whether an expression is zero along the motion, tested at random points.

    `besides` contains additional definitions, e.g. of equations that hold at some times only.
    """
    found = drawn(
        lambda draw, strict: MotionPoint(f"check {draw}", derived, besides, strict),
        lambda point: point.value(tree),
        points,
        draws=40,
    )
    try:
        return not any(point.value(tree) for point in found)
    except Undecided:
        return False


def says_nothing(tree: Node, derived: Derived) -> bool:
    """Return whether an expression is zero for all values of its symbols, independent of the model."""
    try:
        return all(point.value(tree) == 0 for point in points_for((tree,), "identity", derived.positive, 2))
    except Undecided:
        return True


def solved(target: Target, derived: Derived) -> Iterator[Mapping[str, Node]]:
    """Yield the equation solved for one of its names, as a substitution.

    The left-hand side is preferred if it is a name, otherwise a control, costate or state in which the equation is
    linear.
    """
    sides = target.equation
    if isinstance(sides.lhs, Sym) and sides.lhs.name not in symbols(sides.rhs):
        yield {sides.lhs.name: sides.rhs}
        return
    inside = symbols(target.residual)
    for name in (n for n in (*derived.controls, *derived.costates, *derived.states) if n in inside):
        try:
            slope = derivative(target.residual, name)
        except BadInput:
            continue
        if name not in symbols(slope) and slope != ZERO:
            rest = substituted(target.residual, {name: ZERO})
            yield {name: Neg(Div(rest, slope))}
            return


def is_plain(tree: Node) -> bool:
    """Return whether a tree contains only arithmetic operations and elementary functions."""
    return symbols(tree).isdisjoint(NOT_NUMBERS) and all(
        call.function in FUNCTIONS and call.function != "norm" for call in calls_in(tree)
    )
