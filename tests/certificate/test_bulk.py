"""Certificates in bulk confirm what the single ones say, and nothing else."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest

from satsym import instance
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import iteration
from satsym.solvers.certificate import bulk, certify
from satsym.solvers.repeated import Repeated
from satsym.status import Status
from tests.certificate.test_certificate import oscillator

POPULATION = 12


def returns() -> Iterator[Solution]:
    """Returns to the orbit from all around, with other weights and orbits, too."""
    repeated, rng = Repeated(instance.load("return-to-orbit"), False), np.random.default_rng(3)
    case = instance.load("return-to-orbit")
    for _ in range(POPULATION):
        initial = tuple(np.array([1.0, 0.0, 0.0, 1.0]) + 0.1 * rng.uniform(-1.0, 1.0, 4))
        parameters = list(case.parameters)
        parameters[case.model.spec.parameter_names.index("c1")] = 10.0 ** rng.uniform(-1.0, 1.0)
        answer = repeated.solve(initial, parameters)
        assert answer.status.answered
        own = replace(case, initial=initial, parameters=tuple(parameters))
        yield replace(repeated.solution(answer), instance=own)


@pytest.fixture(scope="module")
def population() -> list[Solution]:
    return list(returns())


def test_minima_are_confirmed_with_what_the_single_certificate_measures(population: list[Solution]) -> None:
    together = bulk._confirmed(population)
    assert all(one is not None for one in together), "left to the single certificate"
    for one, solution in zip(together[:2], population[:2], strict=True):
        single = certify(solution, compared=False)
        assert one is not None
        assert single is not None
        assert one.verdict == single.verdict == "local minimum"
        assert one.legendre_clebsch == pytest.approx(single.legendre_clebsch, rel=1e-12)
        theirs = {check.name: check for check in single.checks}
        for check in one.checks:
            assert check.limit == theirs[check.name].limit
            assert abs(check.value - theirs[check.name].value) <= 0.01 * max(check.limit, 1e-10)


@pytest.mark.parametrize("place", ["lam", "u", "objective"])
def test_what_is_wrong_with_one_is_seen_in_that_one_alone(population: list[Solution], place: str) -> None:
    spoilt = list(population[:4])
    if place == "objective":
        spoilt[2] = replace(spoilt[2], objective=spoilt[2].objective * (1.0 + 1e-6))
    else:
        rows = getattr(spoilt[2], place).copy()
        rows[1, 0 if place == "lam" else 500] += 1e-5
        spoilt[2] = replace(spoilt[2], **{place: rows})
    found = bulk.certify_all(spoilt)
    assert [one.verdict.value for one in found if one] == [*["local minimum"] * 2, "failed", "local minimum"]


def certified(solution: Solution) -> str:
    single = certify(solution, compared=False)
    assert single is not None
    return single.verdict.value


def swinging(case: Instance, tf: float, slope: float, t0: float = 0.0) -> Solution:
    """The extremal y = cos t + slope sin t of the oscillator, from another time on."""
    t, steps = np.linspace(0.0, tf, 201), msgspec.structs.replace(case.solver, steps=200)
    x, u = np.cos(t) + slope * np.sin(t), -np.sin(t) + slope * np.cos(t)
    return replace(
        iteration.unsolved(case, "closed form", 0.0),
        instance=replace(case, t0=t0, tf=t0 + tf, final={"y": float(x[-1])}, solver=steps),
        status=Status.CONVERGED,
        objective=float((x[-1] * u[-1] - x[0] * u[0]) / 2),
        times=t + t0,
        x=x[None],
        u=u[None],
        lam=-u[None],
    )


def test_no_extremal_beyond_its_conjugate_time_is_confirmed(tmp_path: Path) -> None:
    """They are k pi: whatever the length, how near and how many of them."""
    case = oscillator(1.0, {}, tmp_path / "oscillator.toml")
    beyond = [np.pi, np.pi + 1e-4, 3.2, 4.0, 6.2, 2 * np.pi, 6.3, 7.0, 9.5, 20.0]
    for tf in (0.01, 1.0, 2.5, 3.0, 3.1, np.pi - 1e-4, *beyond):
        solutions = [swinging(case, tf, 0.3, t0) for t0 in (0.0, 1.25)]
        with np.errstate(all="ignore"):
            clear = bulk._without_conjugate_points(bulk._Together.of(solutions))
        assert not (tf in beyond and clear.any()), tf
        assert clear.all() or tf > 3.1, tf
        if 0.0 < abs(tf - np.pi) < 1e-3:  # where the single certificate decides
            assert [one.verdict.value for one in bulk.certify_all(solutions) if one] == [*map(certified, solutions)]


def test_solutions_of_another_kind_are_certified_one_by_one(population: list[Solution]) -> None:
    sparse = population[0]
    kept = np.r_[0 : len(sparse.times) : 2, len(sparse.times) - 1]
    sparse = replace(
        sparse, times=sparse.times[kept], x=sparse.x[:, kept], u=sparse.u[:, kept], lam=sparse.lam[:, kept]
    )
    assert not bulk.fits(sparse)
    assert not bulk.fits(replace(population[0], switching_times=((1.0,), ())))
    assert not bulk.fits(replace(population[0], instance=replace(population[0].instance, final={"r": 1.0})))
    assert bulk.fits(population[0])
    found = bulk.certify_all([sparse, population[1]])
    assert [one.verdict.value for one in found if one] == ["local minimum"] * 2


def test_a_single_node_that_is_off_is_seen_singly_and_in_bulk(population: list[Solution]) -> None:
    """Whichever it is: one that no station of the flow coincides with, too."""
    for k, (place, row, node) in enumerate((("x", 0, 503), ("x", 3, 977), ("lam", 1, 20), ("x", 1, -2))):
        values = getattr(population[k], place).copy()
        values[row, node] += 1e-5 * np.abs(values[row]).max()
        spoilt = replace(population[k], **{place: values})
        if place == "lam":  # the control as the law has it, so that stationarity does not tell
            law = spoilt.instance.model.control_law_batch
            case = spoilt.instance
            u = law(spoilt.times, spoilt.x, spoilt.lam, case.parameters, case.control_set.arguments)
            spoilt = replace(spoilt, u=np.asarray(u))
        single, together = certify(spoilt, compared=False), bulk.certify_all([population[5], spoilt, population[6]])
        assert single is not None
        failed = [check.name for check in single.checks if not check.passed]
        assert "node defect" in failed, (place, row, node)
        assert [one.verdict.value for one in together if one] == ["local minimum", "failed", "local minimum"]
