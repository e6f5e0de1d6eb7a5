"""What is done to exact formulas: derivatives, values, integrals, solutions; matrices made of numbers and blocks."""

from __future__ import annotations

from typing import Any

from satsym.auditing.measurements import measurement
from satsym.auditing.propositions.values import is_exact
from satsym.auditing.quantities import Quantity
from satsym.formula import reading
from satsym.formula.tree import Equality, symbols
from satsym.status import BadInput
from satsym.wording import shown


@measurement
def diff(of: Any, by: Any, times: int = 1) -> Any:
    """The derivative of a formula, or of each entry of a matrix, by a letter."""
    return of.diff(_letter(of, by), times) if is_exact(of) else 0


@measurement
def subs(of: Any, **values: Any) -> Any:
    """A formula with values for some of its letters, all put in at once."""
    places = {s: values[s.name] for s in of.free_symbols if s.name in values} if is_exact(of) else {}
    return of.xreplace({s: _exact(v) for s, v in places.items()}) if places else of


@measurement
def left(equation: str) -> list[str]:
    """The letters on the left-hand side of an equation as it is printed; none where it has but one side."""
    formula = reading.statement(equation)
    return sorted(symbols(formula.lhs)) if isinstance(formula, Equality) else []


@measurement
def solutions(of: Any, by: Any) -> list[Any]:
    """For which real values of a letter a formula is zero."""
    from satsym.symbolic.lookup import formulas

    return formulas.solutions(of, _letter(of, by))


@measurement
def integral(of: Any, by: Any, start: Any, end: Any) -> Any:
    """The integral of a formula over a letter, exactly."""
    return of.integrate((_letter(of, by), _exact(start), _exact(end)))


@measurement
def blocks(rows: Any) -> Any:
    """The matrix that is made up of rows of blocks."""
    lines = [row[0].hstack(*row) for row in rows]
    return lines[0].vstack(*lines)


def _letter(of: Any, by: Any) -> Any:
    if is_exact(by) and not getattr(by, "is_Symbol", False):
        raise BadInput(f"{shown(str(by))} is no letter")
    name = by if isinstance(by, str) else by.name
    from satsym.symbolic.lookup import formulas

    return next((s for s in of.free_symbols if s.name == name), by if is_exact(by) else formulas.symbol(name))


def _exact(value: Any) -> Any:
    from satsym.symbolic.lookup import formulas

    if isinstance(value, Quantity):
        if value.dimension:
            raise BadInput(f"{value} is no plain number; divide it by its unit")
        value = value.value
    return formulas.exact(value)
