"""Controls on which H depends neither linearly nor quadratically: laws against minima on a grid, and two examples."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar, root
from sympy import Expr, Rational, cos, cosh, exp, log, sin, sqrt

from satsym import instance
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers import solve
from satsym.status import BadInput, Status, Verdict
from satsym.symbolic import Angle, Box, DerivationError, FirstOrder, Free, Problem, Variable, derive, symbols_of
from satsym.symbolic.functions.roots import root_of
from tests.support.models import build, k, q, scalar, w

PLACE = tuple(Variable(name, name) for name in ("x", "y"))
x, y = symbols_of(PLACE)
b, size = symbols_of((Variable("b", "b"), Variable("size", "s")))
BOAT = Problem(
    name="boat_in_sector",
    title="A boat in a current that may not head anywhere",
    model=FirstOrder(
        name="boat",
        title="A boat",
        states=PLACE,
        controls=(Variable("b", "b"),),
        parameters=(),
        rates={x: cos(b) - y / 2, y: sin(b)},
    ),
    running_cost=1,
    control_sets={"heading": Box("b")},
)


def catenary() -> float:
    """The integral of y ds: the catenary's three constants follow from the ends and the length."""
    distance, rise, length = 1.0, 2.0, 4.0
    chord = math.sqrt(length**2 - rise**2)
    c = 1.0 / brentq(lambda k: 2.0 * math.sinh(k * distance / 2.0) / k - chord, 1e-3, 50.0, xtol=1e-15)
    lowest = distance / 2.0 - c * math.atanh(rise / length)
    base = 1.0 - c * math.cosh(lowest / c)

    def doubled(at: float) -> float:
        return at / 2.0 + c / 4.0 * math.sinh(2.0 * (at - lowest) / c)

    return c * (doubled(distance) - doubled(0.0)) + base * length


def test_the_chain_hangs_as_a_catenary():
    found = solve(instance.load("chain"))
    assert found.status is Status.CONVERGED
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate
    assert found.objective == pytest.approx(catenary(), rel=1e-9)


@pytest.mark.study
def test_the_shuttle_glides_as_far_as_by_direct_collocation():
    """CasADi and Ipopt, Radau points of degree 5 on 40, 80 and 120 intervals: 34.141184287, ...284321, ...284256."""
    found = solve(instance.load("shuttle"))
    assert found.status is Status.CONVERGED
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate
    assert math.degrees(-found.objective) == pytest.approx(34.14118428, rel=1e-9)
    assert found.times[-1] == pytest.approx(2008.588119, rel=1e-8)


def least_on_a_grid(case: Instance, lam: tuple[float, ...], at: tuple[float, ...], ends: tuple[float, float]) -> float:
    grid = np.linspace(*ends, 20001)
    columns = np.tile(np.array(at)[:, None], len(grid)), np.tile(np.array(lam)[:, None], len(grid))
    h = case.model.hamiltonian_batch(np.zeros(len(grid)), columns[0], grid[None], columns[1], case.parameters)
    return float(np.min(h))


LAWS: dict[str, tuple[Expr, tuple[float, float] | None]] = {
    "one_function_inverted": (exp(w), None),
    "exponential_and_square": (exp(w) + w**2 / 2, None),
    "quartic_in_a_box": (w**4 / 4 + w**2 / 2, (-0.5, 1.0)),
    "flat_quartic": (w**4, None),
    "rest_outside_the_box": (cosh(w) + w**2 / 2, (0.2, 1.0)),
    "length_in_a_box": (sqrt(1 + w**2), (-0.5, 2.0)),
    "exponential_in_a_box": (2 * exp(w), (-1.0, 1.5)),
    "stiff": (exp(20 * w) + w**2 / 2, (-3.0, 3.0)),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LAWS)
def test_the_law_is_the_least_of_h_in_both_forms(tmp_path: Path, name: str):
    cost, ends = LAWS[name]
    problem = scalar(name, -q + w, cost + q**2, 0, "box" if ends else "free")
    bounds = f"[control]\nw = [{ends[0]}, {ends[1]}]\n" if ends else ""
    case = build(tmp_path, problem, f"[initial]\nq = 1.0\n[time]\ntf = 1.0\n{bounds}")
    rng, limits, compared = np.random.default_rng(0), case.control_set.arguments, 0
    for lam in [0.0, *rng.normal(0.0, 3.0, 60)]:
        arguments = case.parameters, limits
        batch = case.model.control_law_batch
        with np.errstate(all="ignore"):
            on_arrays = float(batch(np.zeros(1), np.ones((1, 1)), np.array([[lam]]), *arguments)[0, 0])
        try:
            (u,) = case.model.control_law(0.0, (1.0,), (lam,), *arguments)
        except (ValueError, ZeroDivisionError):
            assert not math.isfinite(on_arrays)
            assert name == "one_function_inverted", "where H falls for ever there is no control at all"
            assert lam >= 0.0
            continue
        compared += 1
        assert u == pytest.approx(on_arrays, rel=1e-13, abs=1e-13)
        least = least_on_a_grid(case, (lam,), (1.0,), ends or (-6.0, 6.0))
        assert case.model.hamiltonian(0.0, (1.0,), (u,), (lam,), case.parameters) <= least + 1e-12 * abs(least)
        assert ends is None or ends[0] <= u <= ends[1]
    assert compared > 20


def test_an_angle_between_bounds_takes_the_nearer_end(tmp_path: Path):
    start = "[initial]\nx = 3.66\ny = -1.86\n[final]\nx = 0.0\ny = 0.0\n[time]\ntf = "
    for ends in ((-1.0, 1.0), (0.2, 4.0), (2.0, 7.0), (-6.0, -3.0), (0.0, 20.0)):
        case = build(tmp_path, BOAT, f'{start}"free"\n[control]\nb = [{ends[0]}, {ends[1]}]\n')
        rng = np.random.default_rng(1)
        for lam in map(tuple, rng.normal(size=(60, 2))):
            (u,) = case.model.control_law(0.0, (1.0, 1.0), lam, case.parameters, case.control_set.arguments)
            assert ends[0] <= u <= ends[1]
            h = case.model.hamiltonian(0.0, (1.0, 1.0), (u,), lam, case.parameters)
            assert h <= least_on_a_grid(case, lam, (1.0, 1.0), ends) + 1e-12


@pytest.mark.slow
def test_a_heading_is_held_at_its_bound_from_the_time_it_meets_it(tmp_path: Path):
    """Straight on along the bound after the switch; before it the costates obey the law of the free angle."""
    start = "[initial]\nx = 3.66\ny = -1.86\n[final]\nx = 0.0\ny = 0.0\n[time]\ntf = "
    case = build(tmp_path, BOAT, f'{start}"free"\n[control]\nb = [-6.0, -3.0]\n')
    found = solve(case)
    assert found.status is Status.CONVERGED
    ((switch,),) = found.switching_times
    held = found.times > switch + 1e-9
    assert (found.u[0, held] == -3.0).all()
    free = np.arctan2(-found.lam[1, ~held], -found.lam[0, ~held]) - 2.0 * math.pi
    assert np.abs(np.remainder(found.u[0, ~held] - free + 1.0, 2.0 * math.pi) - 1.0).max() < 1e-9
    elsewhere = solve(build(tmp_path, BOAT, f'{start}"free"\n[control]\nb = [2.0, 7.0]\n'))
    assert elsewhere.switching_times == ((),)
    assert elsewhere.objective < found.objective


def test_lift_on_either_side_is_compared(tmp_path: Path):
    """c(u) + l(u) (a cos b + b sin b): both signs of l, against a grid in both controls."""
    u, bank = symbols_of((Variable("u", "u"), Variable("bank", "bank")))
    problem = Problem(
        name="lifted",
        title="A lift that is turned",
        model=FirstOrder(
            name="lifted_motion",
            title="Two velocities",
            states=PLACE,
            controls=(Variable("u", "u"), Variable("bank", "bank")),
            parameters=(),
            rates={x: (u - 0.3) * cos(bank), y: (u - 0.3) * sin(bank)},
        ),
        running_cost=u**2 / 2 + u / 4,
        control_sets={"attack": Box("u"), "turning": Box("bank")},
    )
    text = "[initial]\nx = 0.0\ny = 0.0\n[time]\ntf = 1.0\n[control]\nu = [-1.0, 2.0]\nbank = [-0.5, 1.5]\n"
    case = build(tmp_path, problem, text)
    rng, signs = np.random.default_rng(0), set()
    first, second = (v.ravel() for v in np.meshgrid(np.linspace(-1.0, 2.0, 301), np.linspace(-0.5, 1.5, 201)))
    for lam in map(tuple, rng.normal(size=(40, 2))):
        law = case.model.control_law(0.0, (0.0, 0.0), lam, case.parameters, case.control_set.arguments)
        signs.add(law[0] > 0.3)
        h = case.model.hamiltonian(0.0, (0.0, 0.0), law, lam, case.parameters)
        turned = (first - 0.3) * (lam[0] * np.cos(second) + lam[1] * np.sin(second))
        assert h <= float(np.min(first**2 / 2 + first / 4 + turned)) + 1e-12
    assert signs == {True, False}
    said = {c.key for c in derive(problem).step("control_law").conclusions}
    assert "least of two minimisers" in said


POLAR = Problem(
    name="polar",
    title="A control that drives and drags",
    model=FirstOrder(
        name="dragging",
        title="Driven and dragged",
        states=PLACE,
        controls=(Variable("w", "w"),),
        parameters=(Variable("k", "k", default=1.0),),
        rates={x: w, y: w**2 / 2},
    ),
    running_cost=0,
    terminal_cost=x / 2 + k * y,
    control_set="box",
)
BOTH_BOUNDS = "[control]\nw = [-1.0, 1.5]\n"


def test_where_h_is_not_convex_in_a_control_the_ends_are_compared(tmp_path: Path):
    case = build(tmp_path, POLAR, f"[initial]\nx = 0.0\ny = 0.0\n[time]\ntf = 1.0\n{BOTH_BOUNDS}")
    law, batch = case.model.control_law, case.model.control_law_batch
    rng, taken = np.random.default_rng(2), set()
    for lam in [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, -1.0), *map(tuple, rng.normal(size=(60, 2)))]:
        (u,) = law(0.0, (1.0, 1.0), lam, case.parameters, case.control_set.arguments)
        on_arrays = batch(
            np.zeros(1), np.ones((2, 1)), np.array(lam)[:, None], case.parameters, case.control_set.arguments
        )
        assert u == float(on_arrays[0, 0])
        h = case.model.hamiltonian(0.0, (1.0, 1.0), (u,), lam, case.parameters)
        assert h <= least_on_a_grid(case, lam, (1.0, 1.0), (-1.0, 1.5)) + 1e-12
        taken.add(u if u in (-1.0, 1.5) else "between")
    assert taken == {-1.0, 1.5, "between"}


@pytest.mark.slow
@pytest.mark.parametrize(("weight", "control"), [(1.0, -0.5), (0.2, -1.0), (-1.0, -1.0), (-3.0, 1.5)])
def test_the_better_end_is_part_of_the_answer(tmp_path: Path, weight: float, control: float):
    text = f"[parameters]\nk = {weight}\n[initial]\nx = 0.0\ny = 0.0\n[time]\ntf = 2.0\n{BOTH_BOUNDS}"
    found = solve(build(tmp_path, POLAR, text))
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(2.0 * (control / 2.0 + weight * control**2 / 2.0), rel=1e-12)


@pytest.mark.study
def test_the_hang_glider_comes_as_far_as_by_direct_collocation(tmp_path: Path):
    """Bulirsch, Nerz, Pesch and von Stryk 1993, with the data of COPS.

    CasADi and Ipopt, Legendre points of degree 5 on 24, 12 and 40 intervals between free switching times:
    1248.03102496 m in 98.436990376 s.
    """
    glider = tuple(
        Variable(name, name, unit, positive=name == "vx", typical=typical)
        for name, unit, typical in (
            ("x", "m", (0.0, 1200.0)),
            ("y", "m", (850.0, 1000.0)),
            ("vx", "m/s", (8.0, 15.0)),
            ("vy", "m/s", (-3.0, 3.0)),
        )
    )
    lift = Variable("cl", "c_L", typical=(0.0, 1.4))
    given = (("c0", "1", 0.034), ("kl", "1", 0.069662), ("mass", "kg", 100.0), ("area", "m**2", 14.0))
    given += (("rho", "kg/m**3", 1.13), ("g", "m/s**2", 9.80665), ("rise", "m/s", 2.5), ("R", "m", 100.0))
    numbers = tuple(Variable(name, name, unit, "", value, positive=True) for name, unit, value in given)
    along, height, vx, vy = symbols_of(glider)
    (cl,), (c0, kl, mass, area, rho, g, rise, R) = symbols_of((lift,)), symbols_of(numbers)
    s = (along / R - 2.5) ** 2
    sinking = vy - rise * (1 - s) * exp(-s)
    per_speed = rho * area * sqrt(vx**2 + sinking**2) / (2 * mass)
    drag = (c0 + kl * cl**2) * per_speed
    motion = FirstOrder(
        name="gliding",
        title="A hang glider in a thermal",
        states=glider,
        controls=(lift,),
        parameters=numbers,
        rates={
            along: vx,
            height: vy,
            vx: -cl * per_speed * sinking - drag * vx,
            vy: cl * per_speed * vx - drag * sinking - g,
        },
    )
    problem = Problem(
        name="hang_glider",
        title="The farthest landing",
        model=motion,
        running_cost=0,
        terminal_cost=along,
        maximise=True,
        control_set="box",
    )
    text = (
        "[initial]\nx = 0.0\ny = 1000.0\nvx = 13.2275675\nvy = -1.28750052\n"
        "[final]\ny = 900.0\nvx = 13.2275675\nvy = -1.28750052\n"
        '[time]\ntf = "free"\ntf_guess = 100.0\n[solver]\nmax_seconds = 300.0\n[control]\ncl = [0.0, 1.4]\n'
    )
    found = solve(build(tmp_path, problem, text))
    assert found.status is Status.CONVERGED
    assert -found.objective == pytest.approx(1248.03102496, rel=1e-9)
    assert found.times[-1] == pytest.approx(98.436990376, rel=1e-8)


def test_a_control_whose_ends_are_compared_needs_both(tmp_path: Path):
    with pytest.raises(BadInput, match=r"\[control\] w: H need not be convex in this control, so it needs both bounds"):
        build(tmp_path, POLAR, "[initial]\nx = 0.0\ny = 0.0\n[time]\ntf = 1.0\n")
    with pytest.raises(DerivationError, match="not positive definite"):
        derive(replace(POLAR, control_set="free"))


def test_several_local_minima_are_refused_with_the_reason():
    with pytest.raises(DerivationError, match="several local minima"):
        derive(scalar("rippled", -q + w, w**4 + cos(3 * w) + q**2, 0, "box"))


@pytest.mark.slow
def test_an_end_out_of_reach_is_no_answer(tmp_path: Path):
    text = (
        '[initial]\nx = 3.66\ny = -1.86\n[final]\nx = 0.0\ny = 0.0\n[time]\ntf = "free"\n[control]\nb = [-0.5, -0.4]\n'
    )
    found = solve(build(tmp_path, BOAT, text))
    assert found.status is Status.NOT_CONVERGED
    assert "no start of the search" in found.message


def test_slopes_that_differ_by_their_letters_have_one_class():
    """Two classes of one name could not be told apart where they are evaluated."""
    assert root_of(x, x**3 + w * x - q, (w, q)) is root_of(y, y**3 + x * y - b, (x, b))
    assert root_of(x, x**3 + w * x - q, (w, q)) is not root_of(x, x**3 + w * x + q, (w, q))


def test_a_slope_keeps_its_class_however_many_others_there_are():
    found = root_of(x, x**3 + w * x - q, (w, q))
    kept = [root_of(x, x**3 + k * w * x - q, (w, q)) for k in range(2, 400)]
    assert len({*kept, found}) == 399
    assert root_of(x, x**3 + w * x - q, (w, q)) is found


def made(name: str, states: tuple[Variable, ...], controls: tuple[str, ...], rates: dict[Expr, Expr]) -> FirstOrder:
    """A motion without parameters."""
    own = tuple(Variable(u, u) for u in controls)
    return FirstOrder(name=name, title=name.title(), states=states, controls=own, parameters=(), rates=rates)


@pytest.mark.parametrize(
    ("sets", "moved"),
    [
        ({"size": Free("size"), "heading": Angle("b")}, size * sin(b)),
        ({"size": Free("size"), "heading": Box("b")}, size * sin(b)),
        ({"size": Box("size"), "heading": Angle("b")}, (1 + size) * sin(b)),
        ({"size": Box("size"), "heading": Box("b")}, (1 + size) * sin(b)),
    ],
    ids=["no bounds", "no bounds beside an angle that has", "turns something else", "turns something else in bounds"],
)
def test_a_magnitude_that_multiplies_a_direction_has_bounds_and_any_direction(sets: dict[str, Any], moved: Expr):
    motion = made("push", PLACE, ("size", "b"), {x: size * cos(b), y: moved})
    stated = Problem(name="pushed", title="A push that is turned", model=motion, running_cost=1, control_sets=sets)
    with pytest.raises(
        DerivationError,
        match=r'linear in size, the magnitude of a vector whose direction is the angle b; this requires "size": Box',
    ):
        derive(stated)


GROWTH = (("p", "mm**3"), ("q", "mm**3"), ("y", "mg"))


@pytest.mark.slow
@pytest.mark.parametrize("units", [True, False], ids=["with units", "numbers without a unit"])
def test_fractional_powers_of_states_do_not_stop_the_search_of_singular_arcs(units: bool):
    """Growth of a tumour after Hahnfeldt: sympy makes no polynomial of what singular arcs ask for."""

    def declared(name: str, unit: str, positive: bool = True) -> Variable:
        return Variable(name, name, unit if units else "1", positive=positive, typical=(0.5, 2.0))

    states = tuple(declared(name, unit, name != "y") for name, unit in GROWTH)
    dose = declared("u", "mg/day", False)
    rates_of = tuple(
        declared(*one)
        for one in (("xi", "1/day"), ("b", "1/day"), ("d", "1/mm**2/day"), ("G", "1/mg"), ("mu", "1/day"))
    )
    size, room, given = symbols_of(states)
    (u,), (xi, birth, d, kill, mu) = symbols_of((dose,)), symbols_of(rates_of)
    motion = FirstOrder(
        name="growth",
        title="Growth",
        states=states,
        controls=(dose,),
        parameters=rates_of,
        rates={
            size: -xi * size * log(size / room),
            room: birth * size - (mu + d * size ** Rational(2, 3)) * room - kill * u * room,
            given: u,
        },
    )
    found = derive(
        Problem(
            name="treatment", title="Treatment", model=motion, running_cost=0, terminal_cost=size, control_set="box"
        )
    )
    assert "singular_arcs" in found


def test_decimals_are_what_is_written():
    """Multiplied out with 15 digits they differ from themselves, and e to a number is one more of them."""
    rate = -w * exp(-((q / 3 - 2.7) ** 2)) * sqrt(1.1 + (0.3 * q - 0.7) ** 2) + w * (0.1 * q + 0.3) ** 2
    assert "control_law" in derive(scalar("wind", rate, w**2 + q**2, 0, "free"))


def test_a_terminal_cost_may_have_a_term_that_is_constant():
    assert "boundary_residual" in derive(scalar("shifted", -q + w, w**2 + q**2, q**2 + k, "free"))


CLIMB = tuple(Variable(name, name) for name in ("far", "v", "up"))


def soonest_by_quadrature(distance: float, rise: float, widest: float) -> float:
    """Least time of the climb below: costates are known but for two numbers, which the two ends determine.

    That of the distance is constant, that of v falls to zero at the end, that of the rise is constant; the attitude
    maximises H at Gauss's nodes, and both ends are integrals of it.
    """
    nodes, weights = np.polynomial.legendre.leggauss(400)

    def ends(unknown: Array) -> Array:
        tf, share = unknown
        left = tf * (1.0 - nodes) / 2.0
        turned = np.array(
            [
                minimize_scalar(
                    lambda u, own=own: -(own * (math.cos(u) - 2.0 * u**2) + share * (math.sin(u) + u)),
                    bounds=(-widest, widest),
                    method="bounded",
                    options={"xatol": 1e-13},
                ).x
                for own in left
            ]
        )
        pull, lift = np.cos(turned) - 2.0 * turned**2, np.sin(turned) + turned
        return tf / 2.0 * np.array([weights @ (left * pull), weights @ lift]) - (distance, rise)

    found = root(ends, [1.4, 0.05], tol=1e-12)
    assert found.success
    return float(found.x[0])


@pytest.mark.slow
def test_a_law_that_newton_finds_has_no_slope_where_costates_vanish(tmp_path: Path):
    """Thrust along an attitude that costs drag; its scale was zero, and the certificate ended in an error."""
    far, v, up = symbols_of(CLIMB)
    motion = made("climbing", CLIMB, ("w",), {far: v, v: cos(w) - 2 * w**2, up: sin(w) + w})
    problem = Problem(name="climb", title="A climb", model=motion, running_cost=1, control_set="box")
    text = "[initial]\nfar = 0.0\nv = 0.0\nup = 0.0\n[final]\nfar = 1.0\nup = 0.2\n[time]\ntf = 'free'\n"
    found = solve(build(tmp_path, problem, f"{text}[control]\nw = [-0.6, 0.6]\n"))
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(soonest_by_quadrature(1.0, 0.2, 0.6), rel=1e-6)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate
