"""Operations on exact formulas, such as the rates of a model: derivatives, values, integrals, solutions, motions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from satsym.auditing.propositions.values import Record, is_exact
from satsym.auditing.quantities import Quantity
from satsym.formula import reading
from satsym.formula.tree import Equality, symbols
from satsym.records import record, shelf
from satsym.status import BadInput
from satsym.wording import shown

_POINTS = 2000


def diff(of: Any, by: Any, times: int = 1) -> Any:
    """Return the derivative of a formula, or of each entry of a matrix, with respect to a letter."""
    return of.diff(_letter(of, by), times) if is_exact(of) else 0


def subs(of: Any, **values: Any) -> Any:
    """Return a formula with values for some of its letters, all inserted at once."""
    places = {s: values[s.name] for s in of.free_symbols if s.name in values} if is_exact(of) else {}
    return of.xreplace({s: _exact(v) for s, v in places.items()}) if places else of


def left(equation: str) -> list[str]:
    """Return the letters on the left-hand side of a printed equation; empty for an expression."""
    formula = reading.statement(equation)
    return sorted(symbols(formula.lhs)) if isinstance(formula, Equality) else []


def solutions(of: Any, by: Any) -> list[Any]:
    """Return the real values of a letter for which a formula is zero."""
    from satsym.symbolic.lookup import formulas

    return formulas.solutions(of, _letter(of, by))


def integral(of: Any, by: Any, start: Any, end: Any) -> Any:
    """Return the exact integral of a formula over a letter."""
    return of.integrate((_letter(of, by), _exact(start), _exact(end)))


def blocks(rows: Any) -> Any:
    """Return the matrix that consists of rows of blocks."""
    lines = [row[0].hstack(*row) for row in rows]
    return lines[0].vstack(*lines)


def rates(model: str) -> list[Any]:
    """Return the exact time derivatives of the states of a model."""
    from satsym.symbolic.lookup import library

    return library.rates(model)


def variables(model: str) -> list[str]:
    """Return the names of the states and controls of a model."""
    found = shelf.find(model)
    return [*record.variables(found, "state"), *record.variables(found, "control")]


def integrated(rates: Sequence[Any], names: Sequence[str], start: Sequence[float], until: float) -> Record:
    """Return the motion that given exact time derivatives generate from an initial state: ``t``, and states by name."""
    from scipy.integrate import solve_ivp

    from satsym.symbolic.lookup import formulas

    letters = {s.name: s for rate in rates for s in rate.free_symbols}
    if unknown := sorted(letters.keys() - {*names}):
        raise BadInput(f"the rates contain {', '.join(unknown)}, which has no numerical value; replace it by a number")
    found = formulas.compiled(rates, [letters.get(name, formulas.symbol(name)) for name in names])
    times = np.linspace(0.0, until, _POINTS + 1)
    path = solve_ivp(
        lambda t, x: found(*x), (0.0, until), start, t_eval=times, rtol=1e-10, atol=1e-12, method="DOP853"
    ).y
    return Record("the motion", {"t": times, **dict(zip(names, path, strict=True))})


def _letter(of: Any, by: Any) -> Any:
    if is_exact(by) and not getattr(by, "is_Symbol", False):
        raise BadInput(f"{shown(str(by))} is not a symbol")
    name = by if isinstance(by, str) else by.name
    from satsym.symbolic.lookup import formulas

    return next((s for s in of.free_symbols if s.name == name), by if is_exact(by) else formulas.symbol(name))


def _exact(value: Any) -> Any:
    from satsym.symbolic.lookup import formulas

    if isinstance(value, Quantity):
        if value.dimension:
            raise BadInput(f"{value} is not dimensionless; divide it by a unit")
        value = value.value
    return formulas.exact(value)
