"""mpmath's own integrator, from the proved costates, meets the end and the cost; its equations are written by hand."""

from __future__ import annotations

import mpmath
import pytest

from satsym import instance, solvers
from satsym.proof.proving import prove
from satsym.proof.record import Outcome


def rates_on_orbit(_: mpmath.mpf, y: list[mpmath.mpf]) -> list[mpmath.mpf]:
    """Polar coordinates with mu = 1, both thrusts free at cost u^2/2: Newton's and Pontryagin's equations, and L."""
    r, v, _theta, w, a, b, c, d, _cost = y
    u1, u2 = -b, -d / r
    return [
        v,
        r * w**2 - 1 / r**2 + u1,
        w,
        (u2 - 2 * v * w) / r,
        -b * (w**2 + 2 / r**3) + d * (u2 - 2 * v * w) / r**2,
        2 * d * w / r - a,
        mpmath.mpf(0),
        -2 * b * r * w - c + 2 * d * v / r,
        (u1**2 + u2**2) / 2,
    ]


@pytest.mark.slow
def test_the_return_to_an_orbit() -> None:
    case = instance.load("return-to-orbit")
    proof = prove(case, lambda: solvers.solve(case))
    assert proof.status is Outcome.PROVED
    with mpmath.workdps(24):
        costates = [mpmath.mpf(v.centre) for v in proof.costate_initial.values()]
        start = [mpmath.mpf(v) for v in ("1.1", "0", "0", "0.9")]
        tf = mpmath.mpf("6.283185307179586")
        end = mpmath.odefun(rates_on_orbit, 0, [*start, *costates, mpmath.mpf(0)], tol=mpmath.mpf(10) ** -21)(tf)
        wanted = [mpmath.mpf(1), mpmath.mpf(0), tf, mpmath.mpf(1)]
        assert max(abs(a - b) for a, b in zip(end[:4], wanted, strict=True)) < 1e-17
        assert proof.objective is not None
        assert abs(end[8] - mpmath.mpf(proof.objective.centre)) < 1e-18
        node = proof.nodes[len(proof.nodes) // 2]
        there = mpmath.odefun(rates_on_orbit, 0, [*start, *costates, mpmath.mpf(0)], tol=mpmath.mpf(10) ** -21)(
            mpmath.mpf(node.t.centre)
        )
        for value, found in zip(there, (*node.x.values(), *node.costates.values()), strict=False):
            assert abs(value - mpmath.mpf(found.centre)) < 1e-17
