"""Controls that are drawn leave no answer certified beside which a far one costs less, where the end is free."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

import satsym
from satsym.status import Status, Verdict

X, U, A, B = sp.symbols("x u a b", real=True)


def solved(
    name: str, running: sp.Expr, terminal: sp.Expr, start: float, tf: float, values: dict[sp.Symbol, float]
) -> satsym.Solution:
    """x' = u from a start, with nothing asked of the end."""
    model = satsym.FirstOrder(
        name=f"{name}_motion",
        title=name,
        states=(satsym.Variable("x", "x", "1"),),
        controls=(satsym.Variable("u", "u", "1"),),
        parameters=tuple(satsym.Variable(str(k), str(k), "1", default=1.0) for k in values),
        rates={X: U},
    )
    problem = satsym.Problem(name=name, title=name, model=model, running_cost=running, terminal_cost=terminal)
    return satsym.solve(satsym.Instance.of(problem, initial={X: start}, parameters=values, tf=tf))


@pytest.mark.parametrize(
    ("running", "terminal"),
    [(U**2 / 2 - X**4, sp.Integer(0)), (U**2 / 2, -(X**3)), (U**2 / 2 - X**6, X**2)],
    ids=["running", "final", "both"],
)
def test_a_minimum_beside_a_cost_without_bound_is_none(running: sp.Expr, terminal: sp.Expr) -> None:
    """Zero is a strict local minimum of each."""
    found = solved("falling", running, terminal, 0.0, 1.0, {})
    assert found.status is Status.NO_MINIMISER
    assert "unbounded below" in found.message


@pytest.mark.parametrize("seed", range(8))
def test_of_many_wells_at_the_end_the_best_is_reached(seed: int) -> None:
    """The best way to an end X is straight, at (X - x0)^2 / (2 tf): the optimum is that of a function of X."""
    rng = np.random.default_rng(seed)
    start, tf, a, b = rng.uniform(-1, 1), rng.uniform(1, 4), rng.uniform(0.5, 2.0), rng.uniform(1.5, 4.0)
    found = solved("wells", U**2 / 2, A * sp.cos(B * X), start, tf, {A: a, B: b})
    ends = np.linspace(-20.0, 20.0, 4_000_001)
    lowest = float(((ends - start) ** 2 / (2 * tf) + a * np.cos(b * ends)).min())
    assert found.objective >= lowest - 1e-9
    assert found.certificate is not None
    assert found.certificate.verdict is not Verdict.CERTIFIED or found.objective <= lowest + 1e-9
