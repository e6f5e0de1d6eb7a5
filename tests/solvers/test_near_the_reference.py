"""Returns from next to the reference orbit, down to none at all: the answer of the linearised problem, certified.

States are rounded, so costates that move them by little are known to fewer digits, and costs likewise. What rounding
allows is all that is allowed: an answer is as good as one for ends moved by a few units in the last place.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import msgspec
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from satsym import instance
from satsym.instance import Instance
from satsym.solution import Certificate, Solution
from satsym.solvers import solve
from satsym.solvers.certificate import certify
from satsym.status import Status

Array = NDArray[np.float64]

STATES = ("r", "r_dot", "theta_dot")
SIZES = (0.0, *(10.0**-k for k in range(15, 1, -1)))

ROUNDING = 1e-14
"""Of the ends of the states, relative to their units, all along the way."""

CURVATURE = 2.0
"""Relative change of the cost by what is not linear, in units of the distance: a bound, not a fit."""


@dataclass(frozen=True)
class Form:
    """A return, and its units."""

    name: str
    sigma: float
    omega: float
    final: dict[str, float] | None

    def case(self, state: str, size: float, method: str) -> Instance:
        """Starting next to the reference by that share of the state's unit."""
        shipped = instance.load(self.name)
        start = dict(zip(shipped.model.spec.state_names, (self.sigma, 0.0, 0.0, self.omega), strict=True))
        start[state] += size * {"r": self.sigma, "r_dot": self.sigma * self.omega, "theta_dot": self.omega}[state]
        return replace(
            shipped,
            initial=tuple(start.values()),
            final=dict.fromkeys(start, "reference") if self.final is None else self.final,
            lower=(-np.inf, -np.inf),
            upper=(np.inf, np.inf),
            solver=msgspec.structs.replace(shipped.solver, method=method),
        )

    def units(self) -> Array:
        """Of the states."""
        return np.array([self.sigma, self.sigma * self.omega, 1.0, self.omega])


GEO = instance.load("return-to-geo").parameters[:2]
FORMS = {
    "reference": Form("return-to-orbit", 1.0, 1.0, None),
    "numbers": Form("return-to-orbit", 1.0, 1.0, {"r": 1.0, "r_dot": 0.0, "theta": 2.0 * np.pi, "theta_dot": 1.0}),
    "geo": Form("return-to-geo", *GEO, None),
}


@cache
def quadratic(turn: float) -> Array:
    """The matrix M of the linearised problem's least cost d'Md, from the fundamental matrix and the Gramian.

    Hill's equations for the departures of r, r', theta and theta' from the reference, which has radius and angular
    velocity one. The exponential of [[A, BB'], [0, -A']] has both (Van Loan 1978).
    """
    a = np.array([[0.0, 1.0, 0.0, 0.0], [3.0, 0.0, 0.0, 2.0], [0.0, 0.0, 0.0, 1.0], [0.0, -2.0, 0.0, 0.0]])
    thrust = np.diag([0.0, 1.0, 0.0, 1.0])
    whole = expm(turn * np.block([[a, thrust], [np.zeros((4, 4)), -a.T]]))
    fundamental, gramian = whole[:4, :4], whole[:4, 4:] @ whole[:4, :4].T
    return np.asarray(fundamental.T @ np.linalg.solve(gramian, fundamental) / 2.0)


def certificate(solution: Solution) -> Certificate:
    found = certify(solution)
    assert found is not None
    return found


def failing(found: Certificate) -> list[str]:
    return [check.name for check in found.checks if not check.passed]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("form", "method", "state"),
    [
        pytest.param(form, method, state, marks=pytest.mark.study if (i + j) % len(STATES) else [])
        for i, (form, method) in enumerate([*((form, "collocation") for form in FORMS), ("numbers", "shooting")])
        for j, state in enumerate(STATES)
    ],
)
def test_every_size_is_solved_and_certified(form: str, state: str, method: str) -> None:
    # Each state takes every third decade, beginning with another one.
    for size in SIZES[list(STATES).index(state) :: len(STATES)]:
        case = FORMS[form].case(state, size, method)
        found = solve(case)
        assert found.status is Status.CONVERGED, (size, found.message)
        assert found.certificate is not None
        assert found.certificate.verdict == "certified", (size, failing(found.certificate))
        sigma, omega = FORMS[form].sigma, FORMS[form].omega
        off = (np.array(case.initial) - np.array([sigma, 0.0, 0.0, omega])) / FORMS[form].units()
        assert case.tf is not None
        matrix = quadratic(omega * case.tf)
        expected, cost = off @ matrix @ off, found.objective / (sigma**2 * omega**3)
        # Moving the ends by e moves the root of a quadratic form by at most e times that of its largest eigenvalue.
        rounded = ROUNDING * np.sqrt(np.linalg.eigvalsh(matrix).max())
        assert abs(np.sqrt(cost) - np.sqrt(expected)) <= rounded + CURVATURE / 2.0 * size * np.sqrt(expected), size


@pytest.fixture(
    params=[("reference", "r_dot", 1e-6), ("numbers", "r", 1e-8), ("geo", "theta_dot", 1e-10)], scope="module"
)
def near(request: pytest.FixtureRequest) -> tuple[Solution, float]:
    form, state, size = request.param
    return solve(FORMS[form].case(state, size, "collocation")), size


def test_costates_off_by_more_than_rounding_fail(near: tuple[Solution, float]) -> None:
    solution, size = near
    for component in range(4):
        lam = solution.lam.copy()
        lam[component, 0] += 1e-11 / size * np.abs(lam[component]).max()
        assert certificate(replace(solution, lam=lam)).verdict == "failed", component


def test_an_extremal_that_ends_elsewhere_fails(near: tuple[Solution, float]) -> None:
    """Costates, controls and cost all of another problem, with nothing to see but where it ends."""
    solution, size = near
    factor = 1.0 + 1e-11 / size
    off = replace(solution, lam=factor * solution.lam, u=factor * solution.u, objective=factor**2 * solution.objective)
    assert "boundary residual" in failing(certificate(off))


def test_no_control_at_all_fails(near: tuple[Solution, float]) -> None:
    solution, _ = near
    idle = replace(solution, lam=0.0 * solution.lam, u=0.0 * solution.u, objective=0.0)
    assert "boundary residual" in failing(certificate(idle))


def test_a_control_off_by_a_millionth_fails(near: tuple[Solution, float]) -> None:
    solution, _ = near
    u = solution.u.copy()
    u[1, 500] += 1e-6 * np.abs(u).max()
    assert failing(certificate(replace(solution, u=u))) == ["stationarity"]


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_cost_off_by_more_than_rounding_fails(near: tuple[Solution, float], sign: float) -> None:
    solution, size = near
    off = replace(solution, objective=(1.0 + sign * 1e-11 / size) * solution.objective)
    assert failing(certificate(off)) == ["cost"]
