"""Common parts of the kinds of models whose motion is derived from that of another model."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic import notation as n
from satsym.symbolic.checks import Point, compare, numeric
from satsym.symbolic.derivation import Check, Derivation, Equation, Step
from satsym.symbolic.dimension_algebra import Dimension, over
from satsym.symbolic.dimensions import AGREEMENT
from satsym.symbolic.model import Model, Paragraph, Problem, Requirement, symbols_of, variables_of

SECOND: Dimension = {"[time]": sp.Integer(1)}


@dataclass(frozen=True, kw_only=True)
class Derived(Model):
    """A motion that is derived from the motion of another model.

    Parameters
    ----------
    of
        The model whose motion this is.
    """

    of: Model

    def origin(self) -> Model:
        """Return the model from whose motion this motion is derived."""
        return self.of

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Map the names of the rates of the original states to LaTeX."""
        return {f"d_{v.symbol}": rf"\frac{{d {v.latex}}}{{dt}}" for v in self.of.states}

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of the old states' rates of change."""
        second = SECOND if self.plain_time else known[n.TIME.name]
        for state in symbols_of(self.of.states):
            known[n.rate_of(state).name] = over(known[state.name], second)

    def statement(self) -> tuple[Paragraph, ...]:
        """Return the paragraph that names the model from whose motion this one is derived."""
        return (Paragraph("motion_of", of=self.of),)


@dataclass(frozen=True, kw_only=True)
class SpecialCase(Derived):
    """A motion that is derived from that of another model in a special case.

    Parameters
    ----------
    where
        Parameters that have special values, such as a moment of inertia equal to another one.
    along
        Old states that are left out -> what they are along the motions meant, in terms of the others.
    """

    where: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    along: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def brings(self) -> tuple[Variable, ...]:
        """Return all variables of the original motion."""
        return variables_of(self.of)

    def stated(self) -> Iterator[tuple[str, Iterable[Any], set[sp.Symbol]]]:
        """Return the special values, stated by the variables of the original motion."""
        old = set(symbols_of((*self.of.states, *self.of.controls, *self.of.parameters)))
        yield "a special value", (*self.where.values(), *self.along.values()), old

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of the old states' rates, and refuse special values of other dimensions."""
        super().enter_dimensions(known, require)
        for symbol, value in {**self.where, **self.along}.items():
            require(f"the special {symbol.name}", value, known[symbol.name])

    def special(self) -> dict[sp.Symbol, sp.Expr]:
        """Return the special values of parameters and states, with the parameters filled into the states."""
        where = {s: sp.sympify(e) for s, e in self.where.items()}
        return {**where, **{s: sp.sympify(e).xreplace(where) for s, e in self.along.items()}}


def original_equations(so_far: Derivation) -> Step:
    """Return the first-order form of the original motion, with the checks that it passed."""
    assert so_far.original is not None
    step = so_far.original.step("first_order")
    checks = tuple(_of_original(c) for c in step.checks if c.claim != AGREEMENT)  # every step gets that one anyway
    return Step("original_equations", "taken over", step.equations, ("motion",), checks)


def _of_original(check: Check) -> Check:
    """Mark a check that is about a statement of the original derivation alone."""
    return replace(check, claim="differentiated twice there") if check.claim == "differentiated twice" else check


def there_and_back(stated: Mapping[sp.Symbol, sp.Expr], solved: Sequence[Equation]) -> Check:
    """Check that new variables, stated by old ones, are solved correctly for the old ones."""
    values = [sp.sympify(e) for e in stated.values()]
    there, back = numeric(values), numeric([e.rhs for e in solved])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        old = dict(zip((e.lhs for e in solved), back(point), strict=True))
        return there({**point, **old}), [point[s] for s in stated]

    return compare("there and back", {*stated}.union(*(e.free_symbols for e in values)), sides)
