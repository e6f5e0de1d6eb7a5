"""Controls that are drawn leave no answer certified beside which a far one costs less, where the end is free."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import satsym
from satsym.status import Status, Verdict

X, U, A, B = sp.symbols("x u a b", real=True)


Q, V = sp.symbols("q v", real=True)


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


@pytest.mark.slow
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


def test_a_pendulum_stays_in_the_nearer_of_two_wells() -> None:
    """A polynomial of time is a control too: simulated by another integrator, it costs less than falling through."""
    model = satsym.FirstOrder(
        name="hanging",
        title="A pendulum",
        states=(satsym.Variable("q", "q", "1"), satsym.Variable("v", "v", "1")),
        controls=(satsym.Variable("u", "u", "1"),),
        parameters=(),
        rates={Q: V, V: U - sp.sin(Q)},
    )
    problem = satsym.Problem(name="wavy", title="wavy", model=model, running_cost=U**2 + 1 - sp.cos(4 * Q))
    found = satsym.solve(satsym.Instance.of(problem, initial={Q: 1.5, V: 0.0}, tf=2.0))

    def rates(t: float, z: np.ndarray) -> list[float]:
        u = np.polyval([0.122, -0.409, 0.521, -1.103, 1.442], t)
        return [z[1], u - np.sin(z[0]), u**2 + 1 - np.cos(4 * z[0])]

    other = solve_ivp(rates, (0.0, 2.0), [1.5, 0.0, 0.0], rtol=1e-11, atol=1e-12).y[2, -1]
    assert found.objective <= other
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
