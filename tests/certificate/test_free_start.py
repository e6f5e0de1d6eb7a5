"""The second derivative of the minimum cost by free initial states, against closed forms and differences of costs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sympy import sin

import satsym
from satsym import solvers
from satsym.instance.unknowns import Place, Unknown
from satsym.solution import Solution
from satsym.solvers.certificate.free_start import second_derivative
from satsym.solvers.certificate.verdict import certify
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

X, V, U = Variable("x", "x"), Variable("v", "v"), Variable("u", "u")
(x, v), (u,) = symbols_of((X, V)), symbols_of((U,))


def body(name: str, force: Any) -> Problem:
    model = FirstOrder(name=name, title=name, states=(X, V), controls=(U,), parameters=(), rates={x: v, v: u + force})
    return Problem(name=f"{name}_effort", title=name, model=model, running_cost=u**2 / 2)


FLOATING, HANGING = body("floating", 0), body("hanging", -sin(x))
POINT = FirstOrder(name="point", title="A point", states=(X,), controls=(U,), parameters=(), rates={x: u})
REWARDED = Problem(name="rewarded", title="A reward for distance", model=POINT, running_cost=(u**2 - x**2) / 2)
CENTRED = Problem(name="wells", title="Two wells", model=POINT, running_cost=u**2 / 2 - x**2 / 2 + x**4 / 4)


def given(of: Problem, **said: Any) -> Solution:
    return solvers.solve(satsym.Instance.of(of, **said).case, examined=False)


def with_free(solution: Solution, *names: str) -> Solution:
    states = solution.instance.model.spec.state_names
    free = tuple(Unknown(Place.INITIAL, name, states.index(name), False) for name in names)
    return replace(solution, instance=replace(solution.instance, free=free))


def derivative(solution: Solution, *names: str) -> np.ndarray:
    found = second_derivative(with_free(solution, *names))
    assert found is not None
    return found


def test_a_floating_body_has_the_inverse_of_its_gramian() -> None:
    """Its least effort to rest at zero is (6 x^2 / T^2 + 6 x v / T + 2 v^2) / T."""
    tf = 1.7
    found = given(FLOATING, initial={"x": 0.4, "v": 0.3}, final={"x": 0.0, "v": 0.0}, tf=tf)
    expected = np.array([[12.0 / tf**3, 6.0 / tf**2], [6.0 / tf**2, 4.0 / tf]])
    np.testing.assert_allclose(derivative(found, "x", "v"), expected, rtol=1e-8)
    np.testing.assert_allclose(derivative(found, "v"), expected[1:, 1:], rtol=1e-8)


def test_an_end_that_is_free_counts() -> None:
    """With a final velocity that is free the least effort to zero is 3 (x + v T)^2 / (2 T^3)."""
    tf = 1.7
    found = given(FLOATING, initial={"x": 0.4, "v": 0.3}, final={"x": 0.0}, tf=tf)
    np.testing.assert_allclose(derivative(found, "v"), [[3.0 / tf]], rtol=1e-8)


def test_a_pendulum_has_the_differences_of_its_costs() -> None:
    """Least efforts with the initial velocity changed by a thousandth either way tell the same."""
    case = {"final": {"x": 2.0, "v": 0.1}, "tf": 4.0}
    costs = [given(HANGING, initial={"x": 0.5, "v": 0.2 + step}, **case) for step in (-1e-3, 0.0, 1e-3)]
    below, here, above = (one.objective for one in costs)
    assert derivative(costs[1], "v")[0, 0] == pytest.approx((above - 2.0 * here + below) / 1e-6, rel=1e-4)


@pytest.mark.parametrize("tf", [1.0, 2.5])
def test_a_start_is_a_maximum_beyond_the_focal_point(tf: float) -> None:
    """To zero, the reward for distance leaves x^2 cot(T) / 2, which is negative from T = pi / 2 on."""
    found = given(REWARDED, initial={"x": 1.0}, final={"x": 0.0}, tf=tf)
    assert derivative(found, "x")[0, 0] == pytest.approx(1.0 / np.tan(tf), rel=1e-8)


@pytest.mark.parametrize(("tf", "verdict"), [(1.0, Verdict.LOCAL_MINIMUM), (2.5, Verdict.EXTREMAL_ONLY)])
def test_a_certificate_counts_the_curvature_at_a_free_start(tf: float, verdict: Verdict) -> None:
    """At rest between two wells the cost by x is curved by cot(T) as well."""
    resting = with_free(given(CENTRED, initial={"x": 0.0}, final={"x": 0.0}, tf=tf), "x")
    certificate = certify(resting, compared=False)
    assert certificate is not None
    assert certificate.verdict is verdict
    assert any(check.name == "second-order condition at the free initial point" for check in certificate.checks)
