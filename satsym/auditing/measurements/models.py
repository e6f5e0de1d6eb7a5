"""Derived models: their equations, and motions of derived or printed rates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from satsym.auditing.measurements import measurement
from satsym.auditing.propositions.values import Record
from satsym.status import BadInput

_POINTS = 2000


@measurement
def rates(model: str) -> list[Any]:
    """The rates of the states of a model, exact."""
    from satsym.symbolic.lookup.library import derivation

    return [e.rhs for e in derivation(model).step("first_order").equations]


@measurement
def variables(model: str) -> list[str]:
    """Names of the states and controls of a model."""
    from satsym.symbolic.lookup.library import derivation

    model_ = derivation(model).model
    return [v.symbol for v in (*model_.states, *model_.controls)]


@measurement
def integrated(rates: Sequence[Any], names: Sequence[str], start: Sequence[float], until: float) -> Record:
    """The motion that exact rates of these states make from a start on: ``t`` and the states by name."""
    from scipy.integrate import solve_ivp

    from satsym.symbolic.lookup import formulas

    unknown = sorted({s.name for rate in rates for s in rate.free_symbols} - {*names})
    if unknown:
        raise BadInput(f"no number for {', '.join(unknown)} in the rates; put one in")
    found = formulas.compiled(rates, [_letter(rates, name) for name in names])
    times = np.linspace(0.0, until, _POINTS + 1)
    path = solve_ivp(
        lambda t, x: found(*x), (0.0, until), start, t_eval=times, rtol=1e-10, atol=1e-12, method="DOP853"
    ).y
    return Record("the motion", {"t": times, **dict(zip(names, path, strict=True))})


def _letter(rates: Sequence[Any], name: str) -> Any:
    from satsym.symbolic.lookup import formulas

    return next((s for rate in rates for s in rate.free_symbols if s.name == name), formulas.symbol(name))
