"""The certificate accepts minima and refuses the rest: tampered costates, conjugate times, ends at a maximum."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from satsym import instance
from satsym.codegen import module
from satsym.instance import Instance
from satsym.kernels import from_text
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.jacobi import conjugate
from satsym.solvers.certificate.reintegration.segments import segments
from satsym.solvers.simulation.extrapolation import NotFinite, integrate
from satsym.spec import ControlSetKind
from satsym.status import Status
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.derived import derived

STATE, CONTROL = Variable("y", "y"), Variable("v", "v")
(y,), (v,) = symbols_of((STATE,)), symbols_of((CONTROL,))


def oscillator(tf: float, final: dict[str, float], path: Path, control_set: ControlSetKind = "free") -> Instance:
    """Minimise the integral of (v^2 - y^2)/2 with y' = v from y = 1: extremals y'' = -y, conjugate times k pi."""
    model = FirstOrder(name="line", title="Line", states=(STATE,), controls=(CONTROL,), parameters=(), rates={y: v})
    cost = (v**2 - y**2) / 2
    problem = Problem(name="oscillator", title="Oscillator", model=model, running_cost=cost, control_set=control_set)
    kernels = from_text(module.render(derived(problem), "oscillator.py"), "oscillator.py")
    case = instance.load("soft-return")
    return replace(
        case,
        name="oscillator",
        path=path,
        model=kernels,
        parameters=(),
        initial=(1.0,),
        final=final,
        tf=tf,
        lower=(),
        upper=(),
    )


def extremal(case: Instance, slope: float) -> Solution:
    """The extremal y = cos t + slope sin t; its costate is -v."""
    assert case.tf is not None
    t = np.linspace(0.0, case.tf, 101)
    x, u = np.cos(t) + slope * np.sin(t), -np.sin(t) + slope * np.cos(t)
    return Solution(
        instance=case,
        method="closed form",
        status=Status.CONVERGED,
        message="",
        objective=float((x[-1] * u[-1] - x[0] * u[0]) / 2),  # by parts, as u' = -x
        times=t,
        x=x[None],
        u=u[None],
        lam=-u[None],
        switching_times=((),),
        iterations=0,
        history=(),
        wall_s=0.0,
    )


@pytest.fixture(scope="module")
def returned() -> Solution:
    return solve(instance.load("return-to-orbit"))


def test_the_return_to_orbit_is_certified(returned: Solution) -> None:
    certificate = returned.certificate
    assert certificate is not None
    assert certificate.verdict == "certified"
    assert certificate.conjugate_time is None
    assert certificate.boundary_residual < 1e-11
    assert "cheaper by: seeded starts" in {c.name for c in certificate.checks}


@pytest.mark.parametrize("component", range(3))
def test_a_millionth_off_in_a_costate_fails(returned: Solution, component: int) -> None:
    lam = returned.lam.copy()
    lam[component, 0] *= 1.0 + 1e-6
    certificate = certify(replace(returned, lam=lam))
    assert certificate is not None
    assert certificate.verdict == "failed"


def test_a_control_that_does_not_minimise_h_fails(returned: Solution) -> None:
    u = returned.u.copy()
    u[0, 500] += 1e-6
    certificate = certify(replace(returned, u=u))
    assert certificate is not None
    assert not {c.name: c.passed for c in certificate.checks}["stationarity"]


@pytest.mark.parametrize("factor", [0.9, 1.0 + 1e-6])
def test_a_stated_cost_that_is_not_that_of_the_motion_fails(returned: Solution, factor: float) -> None:
    certificate = certify(replace(returned, objective=factor * returned.objective))
    assert certificate is not None
    assert certificate.verdict == "failed"
    assert [c.name for c in certificate.checks if not c.passed] == ["cost"]


def test_what_did_not_converge_has_no_certificate(returned: Solution) -> None:
    assert certify(replace(returned, status=Status.NOT_CONVERGED)) is None


@pytest.mark.slow
@pytest.mark.parametrize(("tf", "first"), [(2.5, None), (4.0, np.pi), (7.0, np.pi)])
def test_the_conjugate_time_of_the_oscillator_is_pi(tf: float, first: float | None, tmp_path: Path) -> None:
    case = oscillator(tf, {"y": float(np.cos(tf) + 0.3 * np.sin(tf))}, tmp_path / "oscillator.toml")
    solution = extremal(case, 0.3)
    found = conjugate(solution, segments(solution)).time
    assert found == (None if first is None else pytest.approx(first, abs=1e-7))
    certificate = certify(solution)
    assert certificate is not None
    assert certificate.verdict == ("certified" if first is None else "extremal only")


@pytest.mark.parametrize(("tf", "minimum"), [(1.0, True), (2.0, False)])
def test_a_free_end_is_a_minimum_only_up_to_a_quarter_turn(tf: float, minimum: bool, tmp_path: Path) -> None:
    """With the end free, v(tf) = 0 and the second variation is positive until tf = pi/2, not until pi."""
    case = oscillator(tf, {}, tmp_path / "oscillator.toml")
    solution = extremal(case, float(np.tan(tf)))
    assert (conjugate(solution, segments(solution)).curvature > 0.0) is minimum
    certificate = certify(solution)
    assert certificate is not None
    assert certificate.verdict == ("certified" if minimum else "extremal only")


def test_extrapolation_follows_a_kepler_ellipse_to_the_last_digits() -> None:
    """One revolution of eccentricity 0.6 in Cartesian coordinates ends where it began."""

    def rates(t: float, z: np.ndarray) -> np.ndarray:
        return np.concatenate([z[2:], -z[:2] / np.hypot(*z[:2]) ** 3])

    start = np.array([0.4, 0.0, 0.0, 2.0])
    (piece,) = integrate(rates, np.array([0.0, 2.0 * np.pi]), start, 1e-14, np.ones(4))
    np.testing.assert_allclose(piece.end, start, atol=2e-12)


def test_extrapolation_meets_its_stops_and_says_where_it_ends() -> None:
    pieces = integrate(lambda t, z: abs(t - 1.0) * z, np.array([0.0, 1.0, 3.0]), np.ones(1), 1e-13, np.ones(1))
    assert [piece.times[-1] for piece in pieces] == [1.0, 3.0]
    np.testing.assert_allclose([piece.end[0] for piece in pieces], np.exp([0.5, 2.5]), rtol=1e-12)
    with pytest.raises(NotFinite, match=r"beyond t = (1|0\.99)"):
        integrate(lambda t, z: z**2, np.array([0.0, 2.0]), np.ones(1), 1e-12, np.ones(1))
