"""Ends at which a switching function vanishes with several of its rates: its sign there is that of rounding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

import satsym
from satsym.arrays import Array
from satsym.solution import Certificate
from satsym.solvers.certificate import certify
from satsym.status import Status, Verdict

ENDS = [(2, 1.5, 1), (2, 2.4, 1), (3, 3.0, 1), (3, 4.5, 3), (3, 5.0, 4), (4, 5.0, 2), (4, 6.0, 3)]
"""Orders, final times and numbers of switches, short of those from which on they go on without end."""


def integrators_instance(order: int, tf: float, weight: float = 1.0) -> satsym.Instance:
    """The highest derivative of x in [-1, 1], from x = 1 at rest, for the least integral of its square."""
    names = [f"x{k}" for k in range(order)]
    x, u = sp.symbols(names, real=True), sp.Symbol("u", real=True)
    states, control = (tuple(satsym.Variable(n, n, "1") for n in row) for row in (names, ["u"]))
    rates = dict(zip(x, [*x[1:], u], strict=True))
    chain = satsym.FirstOrder(name="c", title="c", states=states, controls=control, parameters=(), rates=rates)
    problem = satsym.Problem(name="p", title="p", model=chain, running_cost=weight * x[0] ** 2, control_set="box")
    initial = {name: float(k == 0) for k, name in enumerate(names)}
    return satsym.Instance.of(problem, initial=initial, tf=tf, control={"u": (-1, 1)})


def integrators(order: int, tf: float, weight: float = 1.0) -> satsym.Solution:
    """Solved."""
    return satsym.solve(integrators_instance(order, tf, weight))


def cost(order: int, tf: float, times: tuple[float, ...], first: float) -> float:
    """The integral of x^2 by polynomials between switches, exact but for rounding."""
    x, begun, total = np.polynomial.Polynomial([1.0]), 0.0, 0.0
    for end, level in zip((*times, tf), [first * (-1) ** k for k in range(len(times) + 1)], strict=True):
        values = [x.deriv(k)(begun) for k in range(order)]
        powers = [value / sp.factorial(k) for k, value in enumerate(values)] + [level / sp.factorial(order)]
        own = np.polynomial.Polynomial([float(value) for value in powers])
        total += float((own**2).integ()(end - begun))
        x, begun = own(np.polynomial.Polynomial([-begun, 1.0])), end
    return total


def failing(certificate: Certificate | None) -> list[str]:
    assert certificate is not None
    return [check.name for check in certificate.checks if not check.passed]


def moved(solution: satsym.Solution, costates: Array | float = 1.0, last: float = 1.0) -> Certificate | None:
    """The certificate of a solution whose costates or last switching time are stated a little wrongly."""
    found = solution.found
    times = (*found.switching_times[0][:-1], found.switching_times[0][-1] * last)
    nodes = np.where(found.times == found.switching_times[0][-1], times[-1], found.times)
    return certify(replace(found, times=nodes, lam=found.lam * costates, switching_times=(times,)), compared=False)


@pytest.mark.slow
@pytest.mark.parametrize(("order", "tf", "switches"), ENDS)
def test_a_switching_function_that_is_flat_at_the_end_is_no_switch_there(order: int, tf: float, switches: int) -> None:
    found = integrators(order, tf)
    assert found.status is Status.CONVERGED, found.message
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, failing(found.certificate)
    times, first = found.switching_times["u"], float(found.u["u"](0.0))
    assert len(times) == switches
    assert found.objective == pytest.approx(cost(order, tf, times, first), rel=1e-10)
    for k in range(switches):
        for step in (-1e-4, 1e-4):
            there = tuple(t + step * (j == k) for j, t in enumerate(times))
            assert cost(order, tf, there, first) >= found.objective * (1.0 - 1e-13)


def test_the_triple_integrator_is_that_of_the_literature() -> None:
    """Four switching times optimised over cubic arcs by Nelder and Mead's method give the same."""
    found = integrators(3, 5.0)
    assert found.objective == pytest.approx(1.252111741907, rel=1e-12)
    assert found.switching_times["u"] == pytest.approx([0.82428805, 2.56330461, 3.94171753, 4.73289801], abs=1e-6)


def test_what_is_stated_wrongly_at_a_flat_end_fails() -> None:
    found = integrators(3, 5.0)
    assert moved(found) is not None
    assert failing(moved(found)) == []
    for factor in (1.0 - 1e-5, 1.0 + 1e-5):
        wrong = moved(found, last=factor)
        assert wrong is not None
        assert wrong.verdict is Verdict.FAILED
        assert "switching times" in failing(wrong)
        for costate in range(3):
            other = moved(found, costates=np.where(np.arange(3) == costate, factor, 1.0)[:, None])
            assert other is not None
            assert other.verdict is Verdict.FAILED, costate


@pytest.mark.slow
@pytest.mark.parametrize("weight", [1e-6, 1e6])
def test_its_verdict_does_not_depend_on_units_of_the_cost(weight: float) -> None:
    found = integrators(3, 4.5, weight)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, failing(found.certificate)
