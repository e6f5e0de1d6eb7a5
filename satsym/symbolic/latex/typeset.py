"""LaTeX of derived expressions in the notation and the order of a derivation; matrices from named entries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.analysis.spectrum import LAMBDA
from satsym.symbolic.derivation import Derivation, Equation, Step
from satsym.symbolic.factoring import factored
from satsym.symbolic.latex.printer import Kind, Printer
from satsym.symbolic.latex.products import Term
from satsym.symbolic.latex.rewriting import readable
from satsym.symbolic.linear import notation as linear_notation
from satsym.symbolic.model import symbols_of, variables_of, with_origins
from satsym.symbolic.switching import notation as switching_notation

LAPLACE = "s"
"""Name of the Laplace variable, which denotes differentiation, unless a variable of the model has this name."""


@dataclass(frozen=True)
class NamedMatrix:
    """A matrix whose entries are equations of a step; a zero entry without an equation is ``None``."""

    prefix: str
    entries: tuple[tuple[Equation | None, ...], ...]

    @property
    def equations(self) -> tuple[Equation, ...]:
        """Return the equations of the entries, row by row."""
        return tuple(e for row in self.entries for e in row if e is not None)

    @property
    def matrix(self) -> sp.Matrix:
        """Return the matrix of the entries' values."""
        return sp.Matrix([[0 if e is None else e.rhs for e in row] for row in self.entries])


class Typesetter:
    """Prints expressions in the notation of one derivation, with a decimal point or a decimal comma."""

    def __init__(self, derivation: Derivation, time: str = "", comma: bool = False) -> None:
        self._derivation, self._comma = derivation, comma
        self._printer = Printer(_notation(derivation, time), _ranks(derivation), comma)

    def at(self, time: str) -> Typesetter:
        """Return a typesetter that prints states, costates and H as functions of ``t_0`` or ``t_f``."""
        return Typesetter(self._derivation, time.replace("t", self.symbol(n.TIME.name)), self._comma)

    def tex(self, expression: Any) -> str:
        """Print an expression on one line."""
        return self._printer.doprint(self._readable(expression))

    def inline(self, expression: Any) -> str:
        """Print an expression within a sentence, without built-up fractions."""
        return self._printer.slashed(self._readable(expression))

    def items(self, value: Any) -> list[str]:
        """Print an expression, or each one of a tuple of them, within a sentence."""
        return [self.inline(item) for item in (value.args if isinstance(value, sp.Tuple) else (value,))]

    def terms(self, expression: Any, *, plus_first: bool = True) -> tuple[Term, ...]:
        """Print an expression as a sum of signed terms.

        Parameters
        ----------
        expression
            Anything but a matrix.
        plus_first
            Whether a term with a plus is moved to the front, if the first one has a minus.
        """
        return tuple(self._printer.terms(self._readable(expression), plus_first=plus_first))

    def by_powers(self, polynomial: Any) -> list[Term]:
        """Print the terms of a polynomial, the highest power first."""
        return [term for (k,), c in sp.Poly(polynomial, LAMBDA).terms() for term in self.terms(c * LAMBDA**k)]

    def in_laplace(self, polynomial: Any) -> list[Term]:
        """Print the terms of a polynomial in s, the variable of Laplace transforms, with factored coefficients."""
        s = sp.Symbol(LAPLACE)
        return [term for (k,), c in sp.Poly(polynomial, s).terms() for term in self.terms(factored(c) * s**k)]

    def ratio_in_laplace(self, ratio: Any) -> tuple[list[Term], list[Term]]:
        """Print numerator and denominator of a ratio of polynomials in s, without fractions in them."""
        above, below = sp.fraction(sp.cancel(sp.together(ratio)))
        return self.in_laplace(above), self.in_laplace(below)

    def _readable(self, expression: Any) -> Any:
        found = sp.sympify(expression)
        return self._printer.normalised(readable(found)) if isinstance(found, sp.Expr) else found

    def symbol(self, name: str) -> str:
        """Return the LaTeX of a name."""
        return self._printer.symbol(name)

    def costate(self, state: str) -> str:
        """Return the LaTeX of the costate of a state."""
        return n.costate_of(sp.Symbol(state)).name

    def is_zero(self, expression: Any) -> bool:
        """Tell whether an expression is literally zero."""
        return bool(sp.sympify(expression).is_zero)


def matrices(derivation: Derivation, step: Step) -> list[NamedMatrix]:
    """Return the matrices whose entries are named by a step, as ``A_row_column`` is."""
    states = [v.symbol for v in derivation.model.states]
    controls = [v.symbol for v in derivation.model.controls]
    outputs = [o.variable.symbol for o in derivation.model.outputs]
    named = {e.lhs.name: e for e in step.equations if isinstance(e.lhs, sp.Symbol)}
    found = []
    for prefix in dict.fromkeys(name.partition("_")[0] for name in named):
        shapes = ((states, states), (states, controls), (controls, controls), (outputs, states), (outputs, controls))
        for rows, columns in shapes:
            entries = tuple(tuple(named.get(f"{prefix}_{row}_{column}") for column in columns) for row in rows)
            matrix = NamedMatrix(prefix, entries)
            if matrix.equations and all(e in matrix.equations or not _has_prefix(e, prefix) for e in step.equations):
                found.append(matrix)
                break
    return found


def _has_prefix(equation: Equation, prefix: str) -> bool:
    return isinstance(equation.lhs, sp.Symbol) and equation.lhs.name.startswith(f"{prefix}_")


def _notation(derivation: Derivation, time: str) -> dict[str, str]:
    origins = {v.symbol: v.latex for model in with_origins(derivation.model)[::-1] for v in variables_of(model)}
    notation = origins | dict(derivation.notation)
    if time:
        states = symbols_of(derivation.model.states)
        for symbol in (*states, *map(n.costate_of, states), n.HAMILTONIAN):
            if symbol.name in notation:
                notation[symbol.name] += f"({time})"
        notation[n.TIME.name] = time
    return notation


def _ranks(derivation: Derivation) -> dict[str, tuple[Kind, int]]:
    """Map each name to its kind and its place in the order of declaration."""
    model = derivation.model
    states = symbols_of(model.states)
    groups = [
        (Kind.CONSTANT, [n.HAMILTONIAN.name]),
        (Kind.CONSTANT, [switch(s).name for switch in (n.given, n.on_reference) for s in states]),
        (Kind.CONSTANT, [m.name for m in n.multipliers(derivation.problem)] if derivation.problem else []),
        (Kind.CONSTANT, [v.symbol for v in (*model.parameters, *(d.variable for d in model.definitions))]),
        (Kind.CONSTANT, [] if derivation.problem else list(linear_notation.weights(model))),
        (Kind.CONSTANT, switching_notation.constants(model)),
        (Kind.COSTATE, [n.costate_of(s).name for s in states]),
        (Kind.MOTION, [*(v.symbol for v in model.replaced_states()), *(s.name for s in states)]),
        (Kind.ACCELERATION, model.accelerations()),
        (Kind.MOTION, [n.TIME.name]),
        (Kind.CONTROL, [v.symbol for v in model.controls]),
        (Kind.DIRECTION, model.unit_vectors()),
    ]
    names = [(kind, name) for kind, group in groups for name in group]
    return {LAPLACE: (Kind.SUM, -1)} | {name: (kind, place) for place, (kind, name) in enumerate(names)}
