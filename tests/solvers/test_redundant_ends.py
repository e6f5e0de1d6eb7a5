"""Final states that follow from others, because a function of them is conserved whatever the controls do."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sympy import Expr, Symbol, sympify

from satsym import instance
from satsym.report.said import message, spoken
from satsym.report.terminal.solution import solution_text
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.solvers.conserved import conserved
from satsym.solvers.redundant_ends import _dependent, redundant
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES, CONTROLS = tuple(Variable(name, name) for name in ("x", "y")), (Variable("w", "w"),)
x, y = symbols_of(STATES)
(w,) = symbols_of(CONTROLS)


def eval_at(text: str, a: float, b: float) -> float:
    return float(sympify(text).subs({"x": a, "y": b}))


def solved(folder: Path, rates: dict[Symbol, Expr], start: tuple[float, float], end: tuple[float, float]) -> Solution:
    moving = FirstOrder(name="moving", title="M", states=STATES, controls=CONTROLS, parameters=(), rates=rates)
    problem = Problem(name="tied", title="T", model=moving, running_cost=w**2)
    text = f"[initial]\nx = {start[0]}\ny = {start[1]}\n[final]\nx = {end[0]}\ny = {end[1]}\n[time]\ntf = 2.0\n"
    return solve(build(folder, problem, text))


@pytest.mark.slow
@pytest.mark.parametrize("end", [(0.0, 1.0), (0.0, -1.0), (math.sqrt(0.75), -0.5)])
def test_a_turn_ends_on_its_circle_whichever_way_it_is_asked(tmp_path: Path, end: tuple[float, float]) -> None:
    """The turn by an angle a in two units of time costs a^2 / 2."""
    found = solved(tmp_path, {x: -w * y, y: w * x}, (1.0, 0.0), end)
    assert found.status is Status.CONVERGED, found.message
    assert found.x[:, -1] == pytest.approx(end, abs=1e-9)
    assert found.objective == pytest.approx(math.atan2(end[1], end[0]) ** 2 / 2.0, rel=1e-9)
    assert "because no control changes a certain function of them:" in found.message
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


def test_an_end_that_the_conserved_quantity_does_not_allow_is_told(tmp_path: Path) -> None:
    """The product y e^x is conserved, and is no polynomial: x = -ln 0.7 where y = 0.7."""
    found = solved(tmp_path, {x: w, y: -w * y}, (0.0, 1.0), (0.2, 0.7))
    assert found.status is Status.NOT_CONVERGED
    assert "ties the final" in found.message
    assert "0.356675 instead of 0.2" in found.message or "0.818731 instead of 0.7" in found.message
    assert not math.isfinite(found.objective)


@pytest.mark.parametrize(
    ("rates", "start", "end", "said"),
    [
        ({x: w, y: -w}, (1.0, 0.0), (0.2, 0.7), "no control changes x + y: its initial value is 1, "),
        ({x: -w * y, y: 2 * w * x}, (1.0, 0.0), (0.0, 1.0), "no control changes x**2 + 0.5*y**2: "),
    ],
)
def test_an_end_with_another_value_of_a_conserved_polynomial_is_infeasible(
    tmp_path: Path, rates: dict[Symbol, Expr], start: tuple[float, float], end: tuple[float, float], said: str
) -> None:
    found = solved(tmp_path, rates, start, end)
    assert found.status is Status.INFEASIBLE, found.message
    assert found.message.startswith(said)
    # no time and no bound of the control would help
    explained, shown = found.status.explain(found.message), " ".join(solution_text(found).split())
    assert explained.endswith("leave one of these states free")
    assert "leave one of these states free" in shown
    assert "more time" not in shown
    with spoken("id"):
        assert message(found.message).startswith("tidak ada kontrol yang mengubah ")


@pytest.mark.parametrize(
    ("rates", "known"),
    [
        ({x: w, y: -w}, {"x + y", "x**2 + 2*x*y + y**2"}),
        ({x: -w * y, y: 2 * w * x}, {"x**2 + 0.5*y**2"}),
        ({x: w, y: -w * y}, set()),
        ({x: y, y: w}, set()),
    ],
)
def test_all_conserved_polynomials_are_found_and_no_others(
    tmp_path: Path, rates: dict[Symbol, Expr], known: set[str]
) -> None:
    moving = FirstOrder(name="moving", title="M", states=STATES, controls=CONTROLS, parameters=(), rates=rates)
    problem = Problem(name="tied", title="T", model=moving, running_cost=w**2)
    case = build(tmp_path, problem, "[initial]\nx = 1.0\ny = 0.5\n[final]\nx = 0.3\ny = 0.4\n[time]\ntf = 2.0\n")
    found = conserved(case, [0, 1], np.array([1.0, 0.5]), np.array([0.3, 0.4]))
    assert len(found) == len(known)
    for one in found:  # of the same values as combinations of those known
        at = np.random.default_rng(0).uniform(-1.0, 1.0, (2, 9))
        values = [one.terms(z).sum() for z in at.T]
        columns = np.array([[eval_at(text, *z) for z in at.T] for text in sorted(known)]).T
        assert np.linalg.lstsq(columns, values, rcond=None)[1] == pytest.approx(0.0, abs=1e-20)


def test_what_is_known_of_an_end_on_the_reference_is_known_for_other_starts() -> None:
    case = instance.load("return-to-orbit")
    assert redundant(case) is None
    known = _dependent.cache_info()
    assert redundant(replace(case, initial=(1.05, 0.0, 0.02, 0.95))) is None
    assert _dependent.cache_info().misses == known.misses
    assert redundant(replace(case, final={**case.final, "r_dot": 0.1})) is None  # another end is looked at
    assert _dependent.cache_info().misses == known.misses + 1


def test_a_reorientation_with_all_four_components_leaves_one_out() -> None:
    body = instance.load("reorientation")
    assert redundant(body) is None
    for sign in (1.0, -1.0):
        less = redundant(replace(body, final={**body.final, "q3": sign}))
        assert less is not None
        assert less.state == "q3"
        assert less.instance.final == body.final


@pytest.mark.parametrize("times", [1e2, 1e4, 1e8])
def test_of_a_heavy_body_the_same_is_left_out(times: float) -> None:
    """Torques of size one hardly move it; in other units of mass it is the same body."""
    body = instance.load("reorientation")
    heavy = replace(body, parameters=tuple(times * v for v in body.parameters), final={**body.final, "q3": 1.0})
    less = redundant(heavy)
    assert less is not None
    assert less.state == "q3"


@pytest.mark.slow
def test_a_turn_through_an_obtuse_angle_leaves_out_what_its_side_leaves_open(tmp_path: Path) -> None:
    """From the rate r a turn by a takes (2 m - r) / k with m^2 = k a + r^2 / 2, where torques turn it by k at most.

    The cosine is the larger one of both; the sine alone would leave the acute angle open, which is nearer.
    """
    states = tuple(Variable(name, name) for name in ("c", "s", "r"))
    c, s, r = symbols_of(states)
    rates = {c: -s * r, s: c * r, r: w / 5000}
    turning = FirstOrder(name="turning", title="T", states=states, controls=CONTROLS, parameters=(), rates=rates)
    problem = Problem(name="turn", title="T", model=turning, running_cost=1, control_set="box")
    angle, rate, k = math.radians(150.0), 0.05, 0.01
    end = f"c = {math.cos(angle)!r}\ns = {math.sin(angle)!r}\nr = 0.0"
    text = f'[initial]\nc = 1.0\ns = 0.0\nr = {rate}\n[final]\n{end}\n[time]\ntf = "free"\n[control]\nw = [-50, 50]\n'
    found = solve(build(tmp_path, problem, text))
    most = math.sqrt(k * angle + rate**2 / 2.0)
    assert found.objective == pytest.approx((2.0 * most - rate) / k, rel=1e-9), found.message
    assert found.x[:2, -1] == pytest.approx((math.cos(angle), math.sin(angle)), abs=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.parametrize("name", ["brachistochrone", "cart-pole", "transfer-fuel", "return-to-orbit", "linear-tangent"])
def test_nothing_is_left_out_where_controls_move_every_end(name: str) -> None:
    """Of the bead the energy is conserved, but its final speed is free."""
    assert redundant(instance.load(name)) is None


@pytest.mark.slow
@pytest.mark.parametrize("limited", [False, True])
def test_a_turn_that_ends_at_the_mirrored_place_is_no_competitor(tmp_path: Path, limited: bool) -> None:
    """A turn through -120 degrees on the circle from a rate of 0.3; that through +120 degrees costs 0.44123.

    The angle a(t) is a cubic, and the integral of its squared second derivative over the time 4 is 4 (3 d^2 / 16 - 3 d
    w / 4 + w^2) / 4 with d = -2 pi / 3 and w = 0.3 (rest at the end), for each turn less or more.
    """
    c, s, rate = symbols_of(parts := (Variable("c", "c"), Variable("s", "s"), Variable("v", "v")))
    bound = {"rate": rate**2 - 2.5**2} if limited else {}
    moving = FirstOrder(
        name="turning",
        title="M",
        states=parts,
        controls=CONTROLS,
        parameters=(),
        rates={c: -s * rate, s: c * rate, rate: w},
    )
    problem = Problem(name="turn", title="T", model=moving, running_cost=w**2, path_constraints=bound)
    end = f"[final]\nc = -0.5\ns = {-math.sqrt(0.75)!r}\nv = 0.0\n[time]\ntf = 4.0\n"
    found = solve(build(tmp_path, problem, f"[initial]\nc = 1.0\ns = 0.0\nv = 0.3\n{end}"))
    angle = -2.0 * math.pi / 3.0
    known = 4.0 * (3.0 * angle**2 / 16.0 - 3.0 * angle * 0.3 / 4.0 + 0.3**2) / 4.0
    assert found.objective == pytest.approx(known, rel=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
