"""A derivation as data: named equations in ordered steps, each with its sources and its checks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import sympy as sp

from satsym.symbolic.model import Model, Problem


class DerivationError(Exception):
    """A statement from which nothing can be derived, or a failed machine check; one line says why.

    Parameters
    ----------
    message
        That line.
    named
        Fields of the statement, or symbols, that it is about, by which its line in the file is found.
    """

    def __init__(self, message: str, named: tuple[str, ...] = ()) -> None:
        super().__init__(message)
        self.named = named


@dataclass(frozen=True)
class Equation:
    """An equation ``lhs = rhs`` with a name that is unique within its step; the right-hand side may be a matrix."""

    name: str
    lhs: sp.Expr
    rhs: sp.Expr


@dataclass(frozen=True)
class Check:
    """A measured confirmation of a step by a route other than the one that derived it.

    Attributes
    ----------
    claim
        Key of the sentence that says what was compared.
    error
        Largest deviation found, relative to the size of what was compared.
    limit
        Largest deviation allowed.
    """

    claim: str
    error: float
    limit: float

    @property
    def passed(self) -> bool:
        """Tell whether the deviation is within the limit; NaN is not."""
        return self.error <= self.limit


@dataclass(frozen=True)
class Conclusion:
    """A conclusion that a step draws in words.

    Attributes
    ----------
    key
        Key of the sentence.
    values
        What is filled into it: expressions, or tuples of them.
    after
        Name of the equation after which it is said; empty where it is said after all of them.
    """

    key: str
    values: Mapping[str, sp.Basic]
    after: str = ""


@dataclass(frozen=True)
class Step:
    """One step of a derivation: its equations, the rule and the sources they follow from, and its checks.

    Attributes
    ----------
    name
        Unique within the derivation; the first half of an address.
    rule
        Key of the sentence that says by which rule the equations follow.
    equations
        What the step establishes. A step that finds nothing to say has none and is left out.
    follows_from
        Names of the steps, or of declared things, it uses.
    checks
        At least one.
    conclusions
        Sentences behind the equations.
    kinds
        Keys of the texts of what the rule lists, where it does.
    """

    name: str
    rule: str
    equations: tuple[Equation, ...]
    follows_from: tuple[str, ...]
    checks: tuple[Check, ...]
    conclusions: tuple[Conclusion, ...] = ()
    kinds: tuple[str, ...] = ()


@dataclass(frozen=True)
class Derivation:
    """Everything derived from a problem, or from a model without a cost, in order.

    ``notation`` maps the name of each symbol that occurs to its LaTeX. ``original`` is the derivation of the motion
    that a linear model linearises, as far as its first-order form.
    """

    model: Model
    problem: Problem | None
    notation: Mapping[str, str]
    steps: tuple[Step, ...] = field(default=())
    original: Derivation | None = None

    @property
    def name(self) -> str:
        """Return the name of the problem or model, which begins every address and names the generated files."""
        return self.problem.name if self.problem else self.model.name

    @property
    def title(self) -> str:
        """Return the title of the problem or model."""
        return self.problem.title if self.problem else self.model.title

    def __contains__(self, step: str) -> bool:
        return any(s.name == step for s in self.steps)

    def step(self, name: str) -> Step:
        """Return the step of the given name.

        Raises
        ------
        KeyError
            If the derivation has no such step.
        """
        for step in self.steps:
            if step.name == name:
                return step
        raise KeyError(f"{self.name}: there is no step {name!r}; available are {', '.join(s.name for s in self.steps)}")

    def equation(self, address: str) -> Equation:
        """Return the equation at the address ``step.equation`` or ``model:step.equation``.

        Raises
        ------
        KeyError
            If the address names another model, or nothing in this derivation.
        """
        model, _, rest = address.rpartition(":")
        if model and model != self.name:
            raise KeyError(f"{address}: this is the derivation of {self.name}")
        step_name, _, equation_name = rest.partition(".")
        step = self.step(step_name)
        for equation in step.equations:
            if equation.name == equation_name:
                return equation
        raise KeyError(f"{address}: the step has {', '.join(e.name for e in step.equations)}")

    def rhs(self, step: str) -> sp.Matrix:
        """Return the right-hand sides of a step's equations as a column."""
        return sp.Matrix([e.rhs for e in self.step(step).equations])

    def extended(self, step: Step, *besides: Check) -> Derivation:
        """Return this derivation with one more step, after the checks that every step has to pass.

        Raises
        ------
        DerivationError
            If the step carries no check, or one that failed.
        """
        if not step.checks:
            raise DerivationError(f"{self.name}:{step.name} has no machine check")
        step = replace(step, checks=(*step.checks, *besides))
        for check in step.checks:
            if not check.passed:
                failed = f"{self.name}:{step.name} failed its check {check.claim!r}: "
                if check.error != check.error:
                    raise DerivationError(
                        f"{failed}the expressions are not finite at random points of order one, so they "
                        "could not be compared; give the ranges of the variables: Variable(..., typical=(low, "
                        "high))"
                    )
                raise DerivationError(f"{failed}deviation {check.error:.2g}, allowed {check.limit:.0g}")
        return replace(self, steps=(*self.steps, step))


def resolved(equations: Sequence[Equation]) -> dict[sp.Symbol, sp.Expr]:
    """Return quantities in terms of states, controls and parameters; each may be stated by those before it."""
    found: dict[sp.Symbol, sp.Expr] = {}
    for equation in equations:
        found[equation.lhs] = equation.rhs.xreplace(found)
    return found
