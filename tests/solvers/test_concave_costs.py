"""Costs that are concave in places: the least of several minima, by closed forms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import quad
from scipy.optimize import brentq
from sympy import Float, cos

from satsym.solvers import solve
from satsym.status import BadInput, Status, Verdict
from satsym.symbolic import t
from tests.support.models import build, k, q, scalar, w


@pytest.mark.parametrize(("tilt", "start"), [(0.3, 0.1), (-0.2, -0.3), (0.9, 0.6)])
def test_the_deeper_of_two_wells_at_the_end_is_found_from_beside_the_other(
    tmp_path: Path, tilt: float, start: float
) -> None:
    """Speeds are constant: what is left is a polynomial in the final state."""
    end = Polynomial([0.0, 1.0])
    cost = (end - start) ** 2 / 2.0 + 5.0 * (end**2 - 1.0) ** 2 + tilt * end
    least = min(cost(root.real) for root in cost.deriv().roots() if abs(root.imag) < 1e-9)
    problem = scalar("two_wells_at_the_end", w, w**2 / 2, 5 * (q**2 - 1) ** 2 + k * q, "free")
    text = f"[parameters]\nk = {tilt}\n[initial]\nq = {start}\n[time]\ntf = 1.0\n"
    found = solve(build(tmp_path, problem, text))
    assert found.objective == pytest.approx(least, rel=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
@pytest.mark.parametrize("duration", [3.3, 4.0, 5.0])
def test_beyond_a_conjugate_time_bounds_of_the_control_keep_a_minimum(tmp_path: Path, duration: float) -> None:
    """From zero and back, rewarded for the square of the distance: at full speed, and on an arc of a cosine between."""
    half = duration / 2.0
    left = brentq(lambda s: np.tan(s) * (half - s) - 1.0, 1e-9, min(half, np.pi / 2.0) - 1e-9)
    size, entry = 1.0 / np.sin(left), half - left
    arc = quad(lambda s: (size * np.sin(s)) ** 2 - (size * np.cos(s)) ** 2, 0.0, left)[0]
    cost = entry - entry**3 / 3.0 + arc  # half the integrand, and both halves of the time
    problem = scalar("rewarded_for_distance", w, (w**2 - q**2) / 2, 0, "box")
    text = f"[initial]\nq = 0\n[final]\nq = 0\n[time]\ntf = {duration}\n[control]\nw = [-1, 1]\n"
    found = solve(build(tmp_path, problem, text))
    assert found.objective == pytest.approx(cost, rel=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_of_a_control_whose_square_is_paid_for_the_better_bound_is_taken(tmp_path: Path) -> None:
    """At full speed towards zero; an instance without both bounds has no such law."""
    problem = scalar("paid_for_speed", w, q**2 - w**2, 0, "box")
    text = "[initial]\nq = 1.0\n[time]\ntf = 0.5\n"
    found = solve(build(tmp_path, problem, text + "[control]\nw = [-1.0, 1.0]\n"))
    assert found.objective == pytest.approx((1.0 - 0.5**3) / 3.0 - 0.5, rel=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    with pytest.raises(BadInput, match="need not be convex in this control, so it needs both bounds"):
        solve(build(tmp_path, problem, text))


@pytest.mark.parametrize(("size", "rate", "weight"), [(0.55, 4.59, 0.05), (0.69, 4.68, 0.05), (0.38, 4.61, 0.05)])
def test_the_least_of_several_negative_costs_over_the_duration_is_found(
    tmp_path: Path, size: float, rate: float, weight: float
) -> None:
    """Speeds are constant: a cosine of the final time, its weight, and the effort are left."""
    times = np.linspace(0.02, 30.0, 600_001)
    least = float((0.5 / times + size * np.cos(rate * times) + weight * times).min())
    problem = scalar("waves_of_the_final_time", w, w**2 / 2, Float(size) * cos(Float(rate) * t) + k * t, "free")
    text = f'[parameters]\nk = {weight}\n[initial]\nq = 0\n[final]\nq = 1\n[time]\ntf = "free"\n'
    found = solve(build(tmp_path, problem, text))
    assert found.objective == pytest.approx(least, abs=1e-7)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_where_a_cost_has_no_minimum_without_bounds_that_the_model_has_it_is_said_where_they_are_left_out(
    tmp_path: Path,
) -> None:
    said = {}
    for kind, bounds in (("free", ""), ("box", ""), ("box", "[control]\nw = [-1.0, 1.0]\n")):
        problem = scalar(f"rewarded_{kind}", w, w**2 / 2 - q**4, 0, kind)
        found = solve(build(tmp_path, problem, f"[initial]\nq = 0.0\n[time]\ntf = 2.0\n{bounds}"))
        said[kind, bool(bounds)] = found.status, "[control] gives none" in found.message
    assert said["free", False] == (Status.NO_MINIMISER, False)
    assert said["box", False] == (Status.NO_MINIMISER, True)
    assert said["box", True][0] is Status.CONVERGED
